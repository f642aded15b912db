//! [`Template`]: drawings from which a person starts.

use serde::{Deserialize, Serialize};

use super::drawing::{PinId, Sketch};
use super::step::{BarEnd, SketchStep};
use crate::machine::builtin;
use crate::planar::{Vector, unit};

/// Direction of the first arm, rad.
const UP: f64 = 1.9;
/// Direction of the second arm, rad.
const ACROSS: f64 = 0.6;
/// Direction of the third arm, rad.
const DOWN: f64 = -0.5;

/// A drawing from which a person starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Template {
    /// The pin B and nothing else.
    Blank,
    /// Two bars in a row, a motor in each joint.
    SerialOfTwo,
    /// Three bars in a row, a motor in each joint.
    SerialOfThree,
    /// Two drives on the base, the second one acts through a parallelogram.
    ParallelogramArm,
    /// A parallelogram of which one pin repeats the motion of another, larger.
    Pantograph,
    /// Two bars in a row, both motors on the base; a belt turns the second one.
    ScaraWithBelts,
    /// The paper's machine of nine links.
    NineLinks,
}

impl Template {
    /// All of them, in the order of a gallery.
    pub const ALL: [Self; 7] = [
        Self::Blank,
        Self::SerialOfTwo,
        Self::SerialOfThree,
        Self::ParallelogramArm,
        Self::Pantograph,
        Self::ScaraWithBelts,
        Self::NineLinks,
    ];

    /// Its name in files and on the command line.
    pub fn word(self) -> &'static str {
        match self {
            Self::Blank => "blank",
            Self::SerialOfTwo => "serial-of-two",
            Self::SerialOfThree => "serial-of-three",
            Self::ParallelogramArm => "parallelogram-arm",
            Self::Pantograph => "pantograph",
            Self::ScaraWithBelts => "scara-with-belts",
            Self::NineLinks => "nine-links",
        }
    }

    /// Returns the template with a name in files.
    pub fn of_word(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|template| template.word() == word)
    }

    /// Its name for people.
    pub fn title(self) -> &'static str {
        match self {
            Self::Blank => "blank",
            Self::SerialOfTwo => "serial arm of two bars",
            Self::SerialOfThree => "serial arm of three bars",
            Self::ParallelogramArm => "parallelogram arm",
            Self::Pantograph => "pantograph",
            Self::ScaraWithBelts => "SCARA with belts",
            Self::NineLinks => "nine links of the paper",
        }
    }

    /// Says in a sentence what it is.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Blank => "The pin B on the base, and nothing else yet.",
            Self::SerialOfTwo => "Two bars in a row, a motor in each joint.",
            Self::SerialOfThree => "Three bars in a row, a motor in each joint.",
            Self::ParallelogramArm => "Both motors on the base; a parallelogram turns the forearm.",
            Self::Pantograph => "A parallelogram repeats the motion of a pin, larger.",
            Self::ScaraWithBelts => "Both motors on the base; a belt turns the forearm.",
            Self::NineLinks => "The machine of the paper, as a person draws it.",
        }
    }

    /// Returns the drawing.
    pub fn sketch(self) -> Sketch {
        let mut pen = Pen { sketch: Sketch { name: self.title().into(), ..Sketch::blank() } };
        match self {
            Self::Blank => return Sketch::blank(),
            Self::SerialOfTwo | Self::SerialOfThree => {
                let lengths: &[(f64, f64)] = &[(0.4, UP), (0.35, ACROSS), (0.2, DOWN)];
                let count = if self == Self::SerialOfTwo { 2 } else { 3 };
                let mut at = pen.sketch.base;
                for (length, angle) in &lengths[..count] {
                    let tip = pen.bar(at, *length, *angle);
                    pen.motor(at);
                    at = tip;
                }
                pen.end(at);
                (1..count).for_each(|k| pen.limits(k, [-2.6, -0.2]));
            }
            Self::ParallelogramArm => {
                let base = pen.sketch.base;
                let elbow = pen.bar(base, 0.4, UP);
                pen.motor(base);
                let crank = pen.bar(base, 0.15, ACROSS);
                pen.motor(base);
                let wrist = pen.bar(elbow, 0.35, ACROSS + std::f64::consts::PI);
                pen.close(crank, 2, -0.15);
                pen.end(wrist);
                pen.limits(1, [-2.9, -0.2]);
            }
            Self::Pantograph => {
                let apex = pen.bar(pen.sketch.base, 0.5, UP);
                pen.motor(pen.sketch.base);
                let end = pen.bar(apex, 0.5, DOWN);
                pen.motor(apex);
                let crank = pen.branch(0, 0.25, 0.25, DOWN);
                pen.close(crank, 1, 0.25);
                pen.end(end);
                pen.limits(1, [-2.8, -0.2]);
            }
            Self::ScaraWithBelts => {
                let base = pen.sketch.base;
                let elbow = pen.bar(base, 0.4, UP);
                pen.motor(base);
                let end = pen.bar(elbow, 0.35, ACROSS);
                pen.belt();
                pen.end(end);
                pen.limits(1, [-2.6, -0.2]);
            }
            Self::NineLinks => {
                let Some(machine) = builtin("nine-link") else { return Sketch::blank() };
                let mut sketch = Sketch { name: self.title().into(), ..Sketch::of(machine, None) };
                // As a person draws it: the arms at B say their drives, parallelograms say the rest.
                let base = sketch.base;
                for bar in sketch.bars.iter_mut().filter(|bar| bar.root != base) {
                    (bar.drive, bar.against) = (None, false);
                }
                return sketch;
            }
        }
        pen.sketch
    }
}

/// Draws bars one after another; a step that does not fit is left out, and a test sees that none is.
struct Pen {
    sketch: Sketch,
}

impl Pen {
    fn step(&mut self, step: SketchStep) {
        if let Ok(next) = self.sketch.with(&step) {
            self.sketch = next;
        }
    }

    /// Draws a bar from a pin, m and rad. Returns the pin at its end.
    fn bar(&mut self, from: PinId, length: f64, angle: f64) -> PinId {
        let to = self.sketch.at(from) + unit(angle).scale(length);
        self.draw(BarEnd::pin(from), to)
    }

    /// Draws a bar from a place on another, by its position in the list.
    fn branch(&mut self, bar: usize, along: f64, length: f64, angle: f64) -> PinId {
        let own = self.sketch.bars[bar].clone();
        let start = self.sketch.at(own.root) + self.sketch.direction(&own).scale(along);
        self.draw(BarEnd::on(own.id, along), start + unit(angle).scale(length))
    }

    fn draw(&mut self, from: BarEnd, to: Vector) -> PinId {
        self.step(SketchStep::Bar { from, to: BarEnd::At([to.re, to.im]), name: None });
        self.sketch.bars.last().map_or(self.sketch.base, |bar| bar.tip)
    }

    /// Draws a bar from a pin to a place on another bar, which closes a loop.
    fn close(&mut self, from: PinId, bar: usize, along: f64) {
        let to = BarEnd::on(self.sketch.bars[bar].id, along);
        self.step(SketchStep::Bar { from: BarEnd::pin(from), to, name: None });
    }

    /// Hangs a motor on a pin that turns the last bar: on the base, or on the bar before.
    fn motor(&mut self, pin: PinId) {
        let bars = &self.sketch.bars;
        let stator = (pin != self.sketch.base).then(|| bars[bars.len() - 2].id);
        let turns = bars.last().map(|bar| bar.id);
        self.step(SketchStep::Motor { pin, stator, drive: None, rotor: None, turns });
    }

    /// Hangs a motor on the base that turns the last bar through a belt.
    fn belt(&mut self) {
        let turns = self.sketch.bars.last().map(|bar| bar.id);
        self.step(SketchStep::Motor { pin: self.sketch.base, stator: None, drive: None, rotor: None, turns });
    }

    fn end(&mut self, pin: PinId) {
        self.step(SketchStep::EndEffector { pin, bar: None });
    }

    /// Limits the angle of a drive, counted from 0, from the one before.
    fn limits(&mut self, k: usize, range: [f64; 2]) {
        let name = |k: usize| self.sketch.motors[k].drive.name.clone();
        let (to, from) = (name(k), name(k - 1));
        self.step(SketchStep::Limits { to, from, offset: 0.0, range: Some(range) });
    }
}
