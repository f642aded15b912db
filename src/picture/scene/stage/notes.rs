//! Notes of the instant: texts at the ends of short lines.

use super::Stage;
use crate::scene::exaggeration::DrawnFrame;
use crate::scene::options::ViewOptions;
use crate::scene::palette::Palette;
use crate::scene::{Anchor, Label, Marker, NOTES, Polyline, Scene, point};
use stillbase_mechanics::planar::unit;
use stillbase_session::scenario::{Note, SnapPoint};

/// Length of the line from the point to the text, as a fraction of the reach.
const LEADER: f64 = 0.075;
/// Directions of the lines of several notes at one point, in turn, rad.
const DIRECTIONS: [f64; 6] = [0.9, 2.2, -0.9, -2.2, 0.2, 2.9];
/// Maximum length of a line of text, characters.
const LINE_CHARS: usize = 30;

impl Stage {
    /// Draws the notes of the instant that stick to a point.
    pub(super) fn draw_notes(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        options: &ViewOptions,
    ) {
        let (z, length) = (self.handle_height(), LEADER * self.linkage.reach());
        let mut before: Vec<&SnapPoint> = Vec::new();
        for (i, Note { text, point: stuck, .. }) in options.notes.iter().enumerate() {
            let Some(stuck) = stuck.as_ref().filter(|_| options.notes[i].is_shown_at(shown.frame.time)) else {
                continue;
            };
            let Some(at) = self.position(stuck, shown) else { continue };
            let turn = before.iter().filter(|other| **other == stuck).count();
            before.push(stuck);
            let along = unit(DIRECTIONS[turn % DIRECTIONS.len()]);
            let (from, to) = (point(at, z), point(at + along * length, z));
            let name = |part: &str| format!("{NOTES}/{}{part}", i + 1);
            let line = Polyline::new(name("/leader"), [vec![from, to]], 1.2, palette.amber);
            scene.lines.push(line.on_top());
            scene.markers.push(Marker::disc(name("/point"), from, 3.0, palette.amber));
            let (right, anchor) = if along.re >= 0.0 { (5.0, Anchor::Left) } else { (-5.0, Anchor::Right) };
            scene.labels.push(Label::new(name(""), to, [right, 0.0], in_lines(text), palette.ink, 12.5, anchor));
        }
    }
}

/// Returns a text broken at spaces into lines; a longer word stays whole.
fn in_lines(text: &str) -> String {
    let (mut broken, mut length) = (String::with_capacity(text.len()), 0);
    for word in text.split_whitespace() {
        let letters = word.chars().count();
        if length > 0 && length + 1 + letters > LINE_CHARS {
            broken.push('\n');
            length = 0;
        } else if length > 0 {
            broken.push(' ');
            length += 1;
        }
        broken.push_str(word);
        length += letters;
    }
    broken
}
