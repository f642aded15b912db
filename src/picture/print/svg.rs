//! Writes a page as SVG, with its size in millimetres.

use std::fmt::Write as _;

use flate2::Crc;

use super::page::Page;
use super::shape::{Paint, PathStep, ShapeWords};
use crate::report::markup::escaped;
use crate::scene::Rgba;
use stillbase_settings::number::fixed;

/// Returns the text of the SVG file. Letters are outlines with their words as labels, so no font is needed.
pub fn svg(page: &Page) -> String {
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}", written(page, &label))
}

/// Returns the element of a drawing within a page of the web. Its words lie over their outlines as text without a
/// colour, so that they can be found and copied.
pub fn svg_element(page: &Page) -> String {
    written(page, &unseen_text)
}

/// Writes a page; `worded` returns the attributes of the outline of words, and what follows it.
fn written(page: &Page, worded: &dyn Fn(&ShapeWords) -> (String, String)) -> String {
    let [width, height] = page.size;
    let mm = |points: f32| n(points * page.point_mm);
    let mut text = String::new();
    let _ = writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" height=\"{}mm\" viewBox=\"0 0 {} {}\" \
         role=\"group\">",
        mm(width),
        mm(height),
        n(width),
        n(height)
    );
    let _ = writeln!(text, "<title>{}</title>", escaped(&page.title));
    if !page.made.is_empty() {
        let _ = writeln!(text, "<desc>{}</desc>", escaped(&page.made));
    }
    let shapes = page.shapes();
    let mut clips: Vec<[f32; 4]> = Vec::new();
    for clip in shapes.iter().filter_map(|shape| shape.clip) {
        if !clips.contains(&clip) {
            clips.push(clip);
        }
    }
    let paths: Vec<String> = shapes.iter().map(|shape| path(&shape.steps)).collect();
    // Names of one drawing differ from those of others, with which it may stand in one page.
    let mut sum = Crc::new();
    [&page.title].into_iter().chain(&paths).for_each(|text| sum.update(text.as_bytes()));
    let name = |i: usize| format!("axes-{:08x}-{}", sum.sum(), i + 1);
    for (i, [left, top, right, bottom]) in clips.iter().enumerate() {
        let [x, y, w, h] = [*left, *top, right - left, bottom - top].map(n);
        let rect = format!("<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/>");
        let _ = writeln!(text, "<clipPath id=\"{}\">{rect}</clipPath>", name(i));
    }
    for (shape, path) in shapes.iter().zip(&paths) {
        let clip = shape.clip.and_then(|clip| clips.iter().position(|known| *known == clip));
        let clip = clip.map_or_else(String::new, |i| format!(" clip-path=\"url(#{})\"", name(i)));
        let (named, after) = shape.words.as_ref().map(worded).unwrap_or_default();
        let _ = writeln!(text, "<path d=\"{path}\"{}{clip}{named}/>{after}", paint(shape.paint));
    }
    text + "</svg>\n"
}

/// Returns the words as a label of their outline.
fn label(words: &ShapeWords) -> (String, String) {
    (format!(" role=\"img\" aria-label=\"{}\"", escaped(words.text.trim())), String::new())
}

/// Returns the words as text without a colour over their outline.
fn unseen_text(words: &ShapeWords) -> (String, String) {
    let ShapeWords { text, at, size, width } = words;
    let [x, y] = at.map(|x| short(x, 2));
    let text = format!(
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" textLength=\"{}\" lengthAdjust=\"spacingAndGlyphs\" \
         fill=\"none\" xml:space=\"preserve\">{}</text>",
        n(*size),
        n(*width),
        escaped(text)
    );
    (" aria-hidden=\"true\"".into(), text)
}

/// Writes a place in points with two decimals: to 4 µm.
fn place([x, y]: [f32; 2]) -> String {
    let [x, y] = [x, y].map(|x| short(x, 2));
    format!("{x} {y}")
}

/// Writes a length with three decimals.
fn n(x: f32) -> String {
    short(x, 3)
}

/// Writes a number without trailing zeros.
fn short(x: f32, decimals: usize) -> String {
    let text = fixed(f64::from(x), decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

fn path(steps: &[PathStep]) -> String {
    let mut path = String::new();
    for step in steps {
        let _ = match step {
            PathStep::Move(p) => write!(path, "M{}", place(*p)),
            PathStep::Line(p) => write!(path, "L{}", place(*p)),
            PathStep::Cubic(a, b, p) => write!(path, "C{} {} {}", place(*a), place(*b), place(*p)),
            PathStep::Close => write!(path, "Z"),
        };
    }
    path
}

fn paint(paint: Paint) -> String {
    match paint {
        Paint::Fill(colour) => tone("fill", colour),
        Paint::FillEvenOdd(colour) => format!("{} fill-rule=\"evenodd\"", tone("fill", colour)),
        Paint::Stroke { colour, width, dash } => {
            let dash = dash.map_or_else(String::new, |lengths| {
                let [on, off] = lengths.map(n);
                format!(" stroke-dasharray=\"{on} {off}\"")
            });
            let stroke = tone("stroke", colour);
            format!(" fill=\"none\"{stroke} stroke-width=\"{}\" stroke-linejoin=\"round\"{dash}", n(width))
        }
    }
}

/// Returns the attributes of a colour; `what` is `fill` or `stroke`.
fn tone(what: &str, [r, g, b, a]: Rgba) -> String {
    let [r, g, b] = [r, g, b].map(|x| (255.0 * x).round() as u8);
    let opacity = if a < 1.0 { format!(" {what}-opacity=\"{}\"", n(a)) } else { String::new() };
    format!(" {what}=\"#{r:02x}{g:02x}{b:02x}\"{opacity}")
}
