//! [`Typed`]: length and angle of a bar as they are typed while it is drawn.

use egui::{Event, InputState, Key};

/// Most characters of a number.
const MOST_CHARS: usize = 12;

/// Length, mm, and angle, °, as typed so far; an empty text leaves the number to the pointer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Typed {
    length: String,
    angle: String,
    /// Whether the keys go to the angle.
    is_at_angle: bool,
}

impl Typed {
    /// Takes the keys of a pass; returns whether Enter ends the bar.
    pub fn take(&mut self, input: &InputState) -> bool {
        let mut ends = false;
        for event in &input.events {
            let is_at_angle = self.is_at_angle;
            let field = if is_at_angle { &mut self.angle } else { &mut self.length };
            match event {
                Event::Text(text) => {
                    let fits = |c: &char| c.is_ascii_digit() || *c == '.' || (*c == '-' && is_at_angle);
                    let chars = text.chars().map(|c| match c {
                        ',' => '.',
                        '−' => '-',
                        c => c,
                    });
                    field.extend(chars.filter(fits));
                    field.truncate(MOST_CHARS);
                }
                Event::Key { key: Key::Backspace, pressed: true, .. } => _ = field.pop(),
                Event::Key { key: Key::Tab, pressed: true, .. } => self.is_at_angle = !is_at_angle,
                Event::Key { key: Key::Enter, pressed: true, .. } => ends = true,
                _ => {}
            }
        }
        ends
    }

    /// Returns the typed length, m.
    pub fn metres(&self) -> Option<f64> {
        self.length.parse::<f64>().ok().map(|mm| 1e-3 * mm).filter(|metres| *metres > 0.0)
    }

    /// Returns the typed angle, rad.
    pub fn radians(&self) -> Option<f64> {
        self.angle.parse::<f64>().ok().map(f64::to_radians)
    }

    /// Returns length and angle in words, with what is typed and a cursor where the next digit goes.
    pub fn words(&self, metres: f64, radians: f64) -> String {
        let shown = |typed: &str, value: f64, is_here: bool| match (typed, is_here) {
            ("", _) => format!("{value:.1}").replace('-', "−"),
            (typed, true) => format!("{}|", typed.replace('-', "−")),
            (typed, false) => typed.replace('-', "−"),
        };
        let length = shown(&self.length, 1e3 * metres, !self.is_at_angle);
        let angle = shown(&self.angle, radians.to_degrees(), self.is_at_angle);
        let next = if self.is_at_angle { "length: Tab" } else { "angle: Tab" };
        format!("{length} mm   ∠ {angle}°   {next}")
    }
}
