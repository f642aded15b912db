//! [`Sketch`]: the drawing of a machine in one pose, as plain data.

use serde::{Deserialize, Serialize};

use super::body::Body;
use crate::machine::{Angle, Counterweight, Drive, Lump, Material, Part, Payload};
use crate::planar::{Vector, dot};
use stillbase_settings::number::plain;

/// Least distance of two pins of one bar, m.
pub(super) const MIN_DISTANCE: f64 = 1e-4;

/// Identity of a pin, which no step changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct PinId(pub u32);

/// Identity of a bar, which no step changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct BarId(pub u32);

/// A part of a drawing, for messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A pin.
    Pin(PinId),
    /// A bar.
    Bar(BarId),
    /// A drive, by its name.
    Drive(String),
    /// The drawing as a whole.
    Whole,
}

/// A joint of bars.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pin {
    /// Its identity.
    pub id: PinId,
    /// Its place in the pose of the drawing, m, in base axes.
    pub at: [f64; 2],
}

/// A straight bar with pins on its axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bar {
    /// Its identity.
    pub id: BarId,
    /// Its name, that of the link.
    pub name: String,
    /// The pin from which it is measured.
    pub root: PinId,
    /// The pin at its other end.
    pub tip: PinId,
    /// More pins on its axis: between root and tip, or beyond them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<PinId>,
    /// Name of its length under `[lengths]`; by default that of the first bar which shares it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub length: Option<String>,
    /// The drive that it follows, by name; `None` if it follows from loops, or is not known yet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive: Option<String>,
    /// Whether it points against the arm of its drive. Among the bars of a drive, the first decides.
    #[serde(default, skip_serializing_if = "is_false")]
    pub against: bool,
    /// Mass per metre of a bar without parts and without typed numbers, kg/m.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub per_metre: f64,
    /// Numbers that someone typed; `None` for a bar whose numbers follow from its parts, or without parts from
    /// `per_metre`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<Body>,
}

fn is_false(x: &bool) -> bool {
    !x
}

pub(super) fn one() -> f64 {
    1.0
}

fn is_one(x: &f64) -> bool {
    *x == one()
}

fn is_nought(v: &[f64; 2]) -> bool {
    *v == [0.0; 2]
}

impl Bar {
    /// Returns all of its pins: root, tip, and the others.
    pub fn all_pins(&self) -> impl Iterator<Item = PinId> + '_ {
        [self.root, self.tip].into_iter().chain(self.pins.iter().copied())
    }

    /// Returns whether a pin is on it.
    pub fn has(&self, pin: PinId) -> bool {
        self.all_pins().any(|own| own == pin)
    }
}

/// A motor at a pin: a drive and its stator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Motor {
    /// The pin at which it sits.
    pub pin: PinId,
    /// The bar that carries its stator; `None` for the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stator: Option<BarId>,
    /// Name, rotor and limits of its drive. What carries the stator is not stated here.
    pub drive: Drive,
}

/// The end effector: a pin, and the bar with which a payload turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EndEffector {
    /// The pin.
    pub pin: PinId,
    /// The bar.
    pub bar: BarId,
}

/// A machine as it is drawn. It may be incomplete.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sketch {
    /// Name of the machine.
    pub name: String,
    /// Its summary in one line.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub summary: String,
    /// Acceleration of gravity, m/s².
    #[serde(default, skip_serializing_if = "is_nought")]
    pub gravity: [f64; 2],
    /// The next free identity of a pin or bar.
    pub next: u32,
    /// The pin B on the base.
    pub base: PinId,
    /// The end effector.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub end_effector: Option<EndEffector>,
    /// The payload at the end effector.
    #[serde(default, skip_serializing_if = "is_usual")]
    pub payload: Payload,
    /// The pins.
    #[serde(default, rename = "pin")]
    pub pins: Vec<Pin>,
    /// The bars.
    #[serde(default, rename = "bar", skip_serializing_if = "Vec::is_empty")]
    pub bars: Vec<Bar>,
    /// The motors, one for each drive.
    #[serde(default, rename = "motor", skip_serializing_if = "Vec::is_empty")]
    pub motors: Vec<Motor>,
    /// Relative angles with their limits.
    #[serde(default, rename = "angle", skip_serializing_if = "Vec::is_empty")]
    pub angles: Vec<Angle>,
    /// Discs on bars; places are measured from the root of the bar.
    #[serde(default, rename = "counterweight", skip_serializing_if = "Vec::is_empty")]
    pub counterweights: Vec<Counterweight>,
    /// Materials beside the built-in ones.
    #[serde(default, rename = "material", skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<Material>,
    /// What bars are made of. Places along a bar are its `root`, its `tip`, or metres from its root.
    #[serde(default, rename = "part", skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Part>,
    /// Bodies on bars whose mass is known.
    #[serde(default, rename = "lump", skip_serializing_if = "Vec::is_empty")]
    pub lumps: Vec<Lump>,
}

fn is_usual(payload: &Payload) -> bool {
    *payload == Payload::default()
}

impl Sketch {
    /// Returns an empty drawing: the pin B at the origin.
    pub fn blank() -> Self {
        let base = Pin { id: PinId(0), at: [0.0; 2] };
        Self {
            name: "my arm".into(),
            summary: String::new(),
            gravity: [0.0; 2],
            next: 1,
            base: base.id,
            end_effector: None,
            payload: Payload::default(),
            pins: vec![base],
            bars: Vec::new(),
            motors: Vec::new(),
            angles: Vec::new(),
            counterweights: Vec::new(),
            materials: Vec::new(),
            parts: Vec::new(),
            lumps: Vec::new(),
        }
    }

    /// Returns a pin.
    pub fn pin(&self, id: PinId) -> Option<&Pin> {
        self.pins.iter().find(|pin| pin.id == id)
    }

    /// Returns a bar.
    pub fn bar(&self, id: BarId) -> Option<&Bar> {
        self.bars.iter().find(|bar| bar.id == id)
    }

    /// Returns a motor by the name of its drive.
    pub fn motor(&self, drive: &str) -> Option<&Motor> {
        self.motors.iter().find(|motor| motor.drive.name == drive)
    }

    /// Returns where a pin is, m; B for a pin that does not exist.
    pub fn at(&self, id: PinId) -> Vector {
        self.pin(id).map_or_else(Vector::default, |pin| Vector::new(pin.at[0], pin.at[1]))
    }

    /// Returns the vector from the root of a bar to its tip, m.
    pub fn span(&self, bar: &Bar) -> Vector {
        self.at(bar.tip) - self.at(bar.root)
    }

    /// Returns the length of a bar from root to tip, m.
    pub fn length(&self, bar: &Bar) -> f64 {
        self.span(bar).norm()
    }

    /// Returns the unit vector of a bar, from root to tip.
    pub(super) fn direction(&self, bar: &Bar) -> Vector {
        let span = self.span(bar);
        let length = span.norm();
        if length > 0.0 { span / length } else { Vector::new(1.0, 0.0) }
    }

    /// Returns the distance of a pin from the root of a bar along its axis, m.
    pub fn along(&self, bar: &Bar, pin: PinId) -> f64 {
        dot(self.at(pin) - self.at(bar.root), self.direction(bar))
    }

    /// Returns the bars on which a pin is.
    pub fn bars_at(&self, pin: PinId) -> impl Iterator<Item = &Bar> {
        self.bars.iter().filter(move |bar| bar.has(pin))
    }

    pub(super) fn pin_mut(&mut self, id: PinId) -> Option<&mut Pin> {
        self.pins.iter_mut().find(|pin| pin.id == id)
    }

    pub(super) fn bar_mut(&mut self, id: BarId) -> Option<&mut Bar> {
        self.bars.iter_mut().find(|bar| bar.id == id)
    }

    /// Puts a pin at a place, m.
    pub(super) fn put(&mut self, id: PinId, to: Vector) {
        if let Some(pin) = self.pin_mut(id) {
            pin.at = [to.re, to.im].map(plain);
        }
    }

    /// Adds a pin at a place, m.
    pub(super) fn add_pin(&mut self, at: Vector) -> PinId {
        let id = PinId(self.next_id());
        self.pins.push(Pin { id, at: [at.re, at.im].map(plain) });
        id
    }

    /// Returns an identity that nothing has had.
    pub(super) fn next_id(&mut self) -> u32 {
        let id = self.next;
        self.next = self.next.saturating_add(1);
        id
    }

    /// Returns the first number that names no bar.
    pub(super) fn free_bar_name(&self) -> String {
        free_name(|name| self.bars.iter().any(|bar| bar.name == name))
    }

    /// Returns the first number that names no drive.
    pub(super) fn free_drive_name(&self) -> String {
        free_name(|name| self.motor(name).is_some())
    }
}

fn free_name(is_taken: impl Fn(&str) -> bool) -> String {
    let mut number = 1_u32;
    while is_taken(&number.to_string()) {
        number += 1;
    }
    number.to_string()
}

/// Returns a length for a message: millimetres to a tenth.
pub(super) fn mm(metres: f64) -> String {
    format!("{} mm", tenths(metres))
}

/// Returns a length in whole tenths of a millimetre, mm.
pub(super) fn tenths(metres: f64) -> f64 {
    // Adding zero makes a negative zero positive.
    (metres * 1e4).round() / 10.0 + 0.0
}
