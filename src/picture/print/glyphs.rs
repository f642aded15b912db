//! Lettering as paths, in the font of the program.

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, GlyphId, MetadataProvider};

use super::shape::{Paint, PathStep, Shape, ShapeWords};
use crate::charts::figure::FigureText;
use crate::paint::FONT_FILES;

/// Distance of the baseline below the top of a line, and height of a line, as fractions of the font size: as egui has
/// them.
const BASELINE: f32 = 0.93;
const LINE_HEIGHT: f32 = 1.16;

/// The fonts in which a letter is sought, the first first.
fn fonts(bold: bool) -> impl Iterator<Item = FontRef<'static>> {
    let [regular, semi_bold, _, signs] = FONT_FILES;
    let own = if bold { semi_bold } else { regular };
    [own, signs].into_iter().filter_map(|(_, bytes)| FontRef::new(bytes).ok())
}

/// Size of the letters of an index, and their distance below the line, as fractions of the font size. What follows a
/// letter and `_`, as in n_B, is its index.
pub const INDEX_SIZE: f32 = 0.68;
const INDEX_DROP: f32 = 0.2;

/// A letter at its place.
struct Glyph {
    font: FontRef<'static>,
    id: GlyphId,
    size: f32,
    /// Distances from the start of the text and below its line, points.
    at: [f32; 2],
}

/// Returns the letters of a text, and its width, points.
fn laid_out(text: &str, size: f32, bold: bool) -> (Vec<Glyph>, f32) {
    let fonts: Vec<FontRef<'static>> = fonts(bold).collect();
    let (mut glyphs, mut x) = (Vec::new(), 0.0);
    let pieces = pieces(text).into_iter();
    for (letter, is_index) in
        pieces.flat_map(|(piece, is_index)| piece.chars().map(move |c| (c, is_index)).collect::<Vec<_>>())
    {
        let found = fonts.iter().find_map(|font| Some((font, font.charmap().map(letter)?)));
        // The first glyph of a font stands for all letters that it lacks.
        let Some((font, id)) = found.or_else(|| Some((fonts.first()?, GlyphId::NOTDEF))) else { continue };
        let (size, down) = if is_index { (INDEX_SIZE * size, INDEX_DROP * size) } else { (size, 0.0) };
        glyphs.push(Glyph { font: font.clone(), id, size, at: [x, down] });
        let metrics = font.glyph_metrics(Size::new(size), LocationRef::default());
        x += metrics.advance_width(id).unwrap_or(0.5 * size);
    }
    (glyphs, x)
}

/// Returns the pieces of a text in order, each with whether it is an index.
pub fn pieces(text: &str) -> Vec<(String, bool)> {
    let letters: Vec<char> = text.chars().collect();
    let (mut pieces, mut is_index): (Vec<(String, bool)>, bool) = (Vec::new(), false);
    for (i, letter) in letters.iter().enumerate() {
        is_index &= letter.is_alphanumeric();
        if begins_index(&letters, i) {
            is_index = true;
            continue;
        }
        match pieces.last_mut().filter(|(_, of)| *of == is_index) {
            Some((piece, _)) => piece.push(*letter),
            None => pieces.push((letter.to_string(), is_index)),
        }
    }
    pieces
}

/// Whether the letter at a place is the `_` of a symbol: behind one letter alone, before one or two.
fn begins_index(letters: &[char], i: usize) -> bool {
    let is_word = |place: Option<usize>| place.and_then(|i| letters.get(i)).is_some_and(|c| c.is_alphanumeric());
    let is_symbol = is_word(i.checked_sub(1)) && !is_word(i.checked_sub(2));
    let is_short = is_word(Some(i + 1)) && !(is_word(Some(i + 2)) && is_word(Some(i + 3)));
    letters[i] == '_' && is_symbol && is_short
}

/// Returns the width of a text, points.
pub fn width(text: &str, size: f32, bold: bool) -> f32 {
    laid_out(text, size, bold).1
}

/// Returns the letters of a text that no font has.
pub fn missing(text: &str, bold: bool) -> Vec<char> {
    let fonts: Vec<FontRef<'static>> = fonts(bold).collect();
    let has = |letter: char| fonts.iter().any(|font| font.charmap().map(letter).is_some());
    text.chars().filter(|letter| !has(*letter)).collect()
}

/// Returns the shapes of a line of text; `anchor` is the position of the point `at` within it, as in a figure.
pub fn text(words: &[FigureText], at: [f32; 2], anchor: [f32; 2]) -> Vec<Shape> {
    let size = words.iter().fold(0.0_f32, |most, w| most.max(w.size));
    let whole: f32 = words.iter().map(|w| width(&w.text, w.size, w.bold)).sum();
    let [mut x, y] = [at[0] - anchor[0] * whole, at[1] + size * (BASELINE - LINE_HEIGHT * anchor[1])];
    let mut shapes = Vec::new();
    for own in words {
        let (glyphs, along) = laid_out(&own.text, own.size, own.bold);
        let mut pen = Pen { origin: [x, y], now: [0.0; 2], steps: Vec::new() };
        for Glyph { font, id, size, at: [along, down] } in glyphs {
            pen.origin = [x + along, y + down];
            let settings = DrawSettings::unhinted(Size::new(size), LocationRef::default());
            if let Some(outline) = font.outline_glyphs().get(id) {
                // A letter that the font cannot draw leaves its space.
                let _ = outline.draw(settings, &mut pen);
            }
        }
        if !pen.steps.is_empty() {
            let words = ShapeWords { text: own.text.clone(), at: [x, y], size: own.size, width: along };
            shapes.push(Shape { steps: pen.steps, paint: Paint::Fill(own.colour), clip: None, words: Some(words) });
        }
        x += along;
    }
    shapes
}

/// Collects the outlines of letters; those of a font are upwards.
struct Pen {
    origin: [f32; 2],
    now: [f32; 2],
    steps: Vec<PathStep>,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> [f32; 2] {
        [self.origin[0] + x, self.origin[1] - y]
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.now = [x, y];
        self.steps.push(PathStep::Move(self.at(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.now = [x, y];
        self.steps.push(PathStep::Line(self.at(x, y)));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        // The same curve, written as a cubic one.
        let control = |[px, py]: [f32; 2]| (px + 2.0 / 3.0 * (cx - px), py + 2.0 / 3.0 * (cy - py));
        let ((ax, ay), (bx, by)) = (control(self.now), control([x, y]));
        self.curve_to(ax, ay, bx, by, x, y);
    }

    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.now = [x, y];
        self.steps.push(PathStep::Cubic(self.at(ax, ay), self.at(bx, by), self.at(x, y)));
    }

    fn close(&mut self) {
        self.steps.push(PathStep::Close);
    }
}
