//! [`SketchStep`]: everything that a person does to a drawing.

use serde::{Deserialize, Serialize};

use super::body::Body;
use super::drawing::{BarId, PinId, Sketch, mm, tenths};
use super::template::Template;
use crate::machine::{Lump, Part, PlaceOnLink, Rotor};
use stillbase_settings::number::{plain, shortest};

/// Where an end of a new bar is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "want { pin = … }, { bar = …, along = … }, or [x, y] in m")]
pub enum BarEnd {
    /// At a pin.
    Pin(AtPin),
    /// On the axis of a bar, where a pin is made if there is none.
    On(OnBar),
    /// At a new pin, m.
    At([f64; 2]),
}

/// At a pin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtPin {
    /// The pin.
    pub pin: PinId,
}

/// On a bar.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnBar {
    /// The bar.
    pub bar: BarId,
    /// Distance from its root, m.
    pub along: f64,
}

impl BarEnd {
    /// Returns an end at a pin.
    pub fn pin(pin: PinId) -> Self {
        Self::Pin(AtPin { pin })
    }

    /// Returns an end on a bar, `along` m from its root.
    pub fn on(bar: BarId, along: f64) -> Self {
        Self::On(OnBar { bar, along })
    }
}

/// One step of drawing. It can be saved, replayed and undone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "draw", rename_all = "kebab-case", deny_unknown_fields)]
pub enum SketchStep {
    /// Begins a new drawing.
    New {
        /// From which it starts.
        template: Template,
    },
    /// Draws a bar from one place to another. An end that is connected to the base becomes its root.
    Bar {
        /// One end.
        from: BarEnd,
        /// The other end.
        to: BarEnd,
        /// Its name; by default the first free number.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    /// Moves a pin, and what hangs on it.
    MovePin {
        /// The pin.
        pin: PinId,
        /// Where it goes, m.
        to: [f64; 2],
    },
    /// Cuts a bar in two, which a pin joins.
    Split {
        /// The bar.
        bar: BarId,
        /// Distance from its root, m.
        along: f64,
    },
    /// Makes one bar of two that share a pin and a line.
    Join {
        /// The bar that stays.
        bar: BarId,
        /// The bar that becomes part of it.
        with: BarId,
    },
    /// Makes one pin of two.
    Weld {
        /// The pin that moves and goes.
        pin: PinId,
        /// The pin that stays.
        onto: PinId,
    },
    /// Joins a pin to a bar that it lies on. The pin moves onto the axis of the bar.
    Attach {
        /// The pin.
        pin: PinId,
        /// The bar.
        bar: BarId,
    },
    /// Removes a bar, and what is then on nothing.
    DeleteBar {
        /// The bar.
        bar: BarId,
    },
    /// Removes a pin. Bars that it ends become shorter, or go if they have no other two pins.
    DeletePin {
        /// The pin.
        pin: PinId,
    },
    /// Hangs a motor on a pin.
    Motor {
        /// The pin.
        pin: PinId,
        /// The bar that carries its stator; the base if it is not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stator: Option<BarId>,
        /// Name of the drive; by default the first free number.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        drive: Option<String>,
        /// Its rotor.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        rotor: Option<Rotor>,
        /// A bar that it turns.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        turns: Option<BarId>,
    },
    /// Moves a motor to another pin or stator.
    MoveMotor {
        /// Name of the drive.
        drive: String,
        /// The pin.
        pin: PinId,
        /// The bar that carries its stator; the base if it is not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stator: Option<BarId>,
    },
    /// Changes rotor and gear of a motor.
    Gear {
        /// Name of the drive.
        drive: String,
        /// Inertia of the rotor about its axis, kg m².
        inertia: f64,
        /// Turns of the rotor for one turn of the drive.
        ratio: f64,
    },
    /// Removes a motor. Bars that follow it follow no drive then.
    DeleteMotor {
        /// Name of the drive.
        drive: String,
    },
    /// Says which drive a bar follows, and with it those that must follow the same.
    Follow {
        /// The bar.
        bar: BarId,
        /// Name of the drive; no drive if it is not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        drive: Option<String>,
    },
    /// Puts the end effector on a pin.
    EndEffector {
        /// The pin.
        pin: PinId,
        /// The bar with which a payload turns; by default the last one that ends at the pin.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        bar: Option<BarId>,
    },
    /// Sets the limits of the angle between two drives, q_to − q_from + offset.
    Limits {
        /// Name of the drive whose angle is added.
        to: String,
        /// Name of the drive whose angle is subtracted.
        from: String,
        /// Offset, rad, of an angle that is new.
        #[serde(default, skip_serializing_if = "is_nought")]
        offset: f64,
        /// Least and greatest value, rad; no limits if they are not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        range: Option<[f64; 2]>,
    },
    /// Names the machine.
    Name {
        /// The name.
        name: String,
    },
    /// Names a bar.
    NameBar {
        /// The bar.
        bar: BarId,
        /// The name.
        name: String,
    },
    /// Names a drive.
    NameDrive {
        /// Its name so far.
        drive: String,
        /// The name.
        name: String,
    },
    /// Sets the length of a bar from root to tip; the end away from the base moves.
    Length {
        /// The bar.
        bar: BarId,
        /// Length, m.
        metres: f64,
    },
    /// Turns a bar about its pin next to the base.
    Angle {
        /// The bar.
        bar: BarId,
        /// Direction from root to tip, rad, from the x axis.
        radians: f64,
    },
    /// Makes a parallelogram of four pins by moving one of them.
    Parallelogram {
        /// The corners in order around it.
        corners: [PinId; 4],
        /// The corner that moves.
        moves: PinId,
    },
    /// Says what a bar is made of.
    Parts {
        /// The bar.
        bar: BarId,
        /// Its bars and plates; places along it are its `root`, its `tip`, or metres from its root.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        parts: Vec<Part>,
        /// Bodies on it whose mass is known.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        lumps: Vec<Lump>,
    },
    /// Puts a lump on a bar, changes it, or takes it away.
    Lump {
        /// The bar.
        bar: BarId,
        /// Which of its lumps, counted from 1; one more if it is not given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        number: Option<usize>,
        /// What it is; if it is not given, the lump goes.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        lump: Option<Lump>,
    },
    /// Sets the mass of a bar.
    Mass {
        /// The bar.
        bar: BarId,
        /// Its typed numbers; if they are not given, they follow from its parts, or it is slender.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        body: Option<Body>,
        /// Mass per metre of a slender bar, kg/m.
        #[serde(default = "super::drawing::one")]
        per_metre: f64,
    },
}

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

/// Returns a place along a bar for a message.
fn along(place: &PlaceOnLink) -> String {
    match place {
        PlaceOnLink::Metres(metres) => mm(*metres),
        PlaceOnLink::Named(word) => format!("its {word}"),
    }
}

impl SketchStep {
    /// Describes the step, for menus and the event log.
    pub fn title(&self) -> String {
        match self {
            Self::New { template } => format!("new drawing: {}", template.title()),
            Self::Bar { name: Some(name), .. } => format!("draw bar {name}"),
            Self::Bar { .. } => "draw a bar".into(),
            Self::MovePin { to: [x, y], .. } => format!("move pin to {}, {}", tenths(*x), mm(*y)),
            Self::Split { along, .. } => format!("split bar at {}", mm(*along)),
            Self::Join { .. } => "make two bars one".into(),
            Self::Weld { .. } => "make two pins one".into(),
            Self::Attach { .. } => "join a pin to a bar".into(),
            Self::DeleteBar { .. } => "delete bar".into(),
            Self::DeletePin { .. } => "delete pin".into(),
            Self::Motor { drive: Some(drive), .. } => format!("hang motor of drive {drive}"),
            Self::Motor { .. } => "hang a motor".into(),
            Self::MoveMotor { drive, .. } => format!("move motor of drive {drive}"),
            Self::Gear { drive, ratio, .. } => format!("gear of drive {drive} to {ratio}"),
            Self::DeleteMotor { drive } => format!("remove motor of drive {drive}"),
            Self::Follow { drive: Some(drive), .. } => format!("bar follows drive {drive}"),
            Self::Follow { drive: None, .. } => "bar follows no drive".into(),
            Self::EndEffector { .. } => "place end effector".into(),
            Self::Limits { to, from, range: Some([low, high]), .. } => {
                let [low, high] = [low, high].map(|x| x.to_degrees());
                format!("limits of drive {to} from drive {from}: {low:.1} to {high:.1}°")
            }
            Self::Limits { to, from, .. } => format!("no limits of drive {to} from drive {from}"),
            Self::Name { name } => format!("name machine {name}"),
            Self::NameBar { name, .. } => format!("name bar {name}"),
            Self::NameDrive { name, .. } => format!("name drive {name}"),
            Self::Length { metres, .. } => format!("length of bar to {}", mm(*metres)),
            Self::Angle { radians, .. } => format!("turn bar to {:.1}°", radians.to_degrees()),
            Self::Parallelogram { .. } => "make it a parallelogram".into(),
            Self::Parts { parts, lumps, .. } => match (parts.as_slice(), lumps.as_slice()) {
                ([], []) => "bar of no parts".into(),
                ([one], []) => format!("bar of {}", one.title()),
                _ => format!("bar of {} parts", parts.len() + lumps.len()),
            },
            Self::Lump { number: None, lump: Some(lump), .. } => {
                format!("put {} of {} kg on bar", lump.title(), lump.mass)
            }
            Self::Lump { lump: Some(lump), .. } => {
                format!("{} of {} kg at {}", lump.title(), lump.mass, along(&lump.at))
            }
            Self::Lump { lump: None, .. } => "take lump away".into(),
            Self::Mass { body: Some(Body { mass: Some(mass), .. }), .. } => format!("mass of bar to {mass} kg"),
            Self::Mass { body: Some(_), .. } => "numbers of bar".into(),
            Self::Mass { per_metre, .. } => format!("mass of bar to {per_metre} kg/m"),
        }
    }

    /// Returns the step with its numbers written as a person would: lengths without the rounding of sums, angles to
    /// 1e-12 of them.
    #[must_use]
    pub fn plainly(self) -> Self {
        let end = |end: BarEnd| match end {
            BarEnd::At(at) => BarEnd::At(at.map(plain)),
            BarEnd::On(on) => BarEnd::on(on.bar, plain(on.along)),
            BarEnd::Pin(_) => end,
        };
        let angle = |radians: f64| shortest(radians, 1e-12);
        match self {
            Self::Bar { from, to, name } => Self::Bar { from: end(from), to: end(to), name },
            Self::MovePin { pin, to } => Self::MovePin { pin, to: to.map(plain) },
            Self::Split { bar, along } => Self::Split { bar, along: plain(along) },
            Self::Length { bar, metres } => Self::Length { bar, metres: plain(metres) },
            Self::Angle { bar, radians } => Self::Angle { bar, radians: angle(radians) },
            Self::Limits { to, from, offset, range } => {
                Self::Limits { to, from, offset, range: range.map(|ends| ends.map(angle)) }
            }
            step => step,
        }
    }

    /// Describes the step with the names of a drawing, for buttons.
    pub fn title_in(&self, sketch: &Sketch) -> String {
        let name = |id: BarId| sketch.bar(id).map_or("?", |bar| bar.name.as_str());
        match self {
            Self::DeleteBar { bar } => format!("delete bar {}", name(*bar)),
            Self::Attach { bar, .. } => format!("join it to bar {}", name(*bar)),
            Self::Follow { bar, drive: Some(drive) } => format!("bar {} follows drive {drive}", name(*bar)),
            Self::Length { bar, metres } => format!("bar {} becomes {}", name(*bar), mm(*metres)),
            Self::Angle { bar, radians } => format!("turn bar {} to {:.1}°", name(*bar), radians.to_degrees()),
            Self::Motor { turns: Some(bar), .. } => format!("hang a motor that turns bar {}", name(*bar)),
            step => step.title(),
        }
    }
}
