//! Everything that can be wrong with a machine: what, where, and what would be right.

use std::fmt;

use thiserror::Error;

use super::spec::MachineSpec;
use crate::settings::number::Short;
use crate::settings::range::{Want, clipped};

/// A place in a machine file: a path of keys and positions. It is shown as one types it, such as `link.5.mass`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place(pub Vec<PlaceStep>);

/// One step of a [`Place`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlaceStep {
    /// A key of a table.
    Key(String),
    /// A position in an array, counted from 0.
    At(usize),
    /// The same of what has a name, by which keys call it.
    Named(usize, String),
}

impl Place {
    /// A place from its keys; numbers become positions.
    pub fn new(path: &[&dyn AsStep]) -> Self {
        Self(path.iter().map(|s| s.step()).collect())
    }

    /// The place of a key as `--set` names it, its parts joined by dots, positions in brackets: `task.via[3]`.
    pub fn of_key(key: &str) -> Self {
        let steps = key.split('.').flat_map(|part| {
            let (name, position) = part.split_once('[').unwrap_or((part, ""));
            let position = position.trim_end_matches(']').parse().ok().and_then(|i: usize| i.checked_sub(1));
            std::iter::once(PlaceStep::Key(name.into())).chain(position.map(PlaceStep::At))
        });
        Self(steps.collect())
    }

    /// The same place in a table that holds this one under a key.
    #[must_use]
    pub fn under(self, key: &str) -> Self {
        Self(std::iter::once(PlaceStep::Key(key.into())).chain(self.0).collect())
    }
}

/// What can be a step of a place.
pub trait AsStep {
    /// The step.
    fn step(&self) -> PlaceStep;
}
impl AsStep for &str {
    fn step(&self) -> PlaceStep {
        PlaceStep::Key((*self).into())
    }
}
impl AsStep for String {
    fn step(&self) -> PlaceStep {
        PlaceStep::Key(self.clone())
    }
}
impl AsStep for usize {
    fn step(&self) -> PlaceStep {
        PlaceStep::At(*self)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [PlaceStep::Key(angle), PlaceStep::Named(_, name), PlaceStep::Key(end)] = &self.0[..]
            && angle == "angle"
            && ["min", "max"].contains(&end.as_str())
        {
            return write!(f, "limits.{} ({end})", clipped(name));
        }
        for (i, step) in self.0.iter().enumerate() {
            match step {
                // A file has a table of them, and a key is of one.
                PlaceStep::Key(k) if i == 0 && k == "lengths" => f.write_str("length")?,
                PlaceStep::Key(k) if i == 0 => f.write_str(&clipped(k))?,
                PlaceStep::Key(name) | PlaceStep::Named(_, name) => write!(f, ".{}", clipped(name))?,
                PlaceStep::At(i) => write!(f, "[{}]", i + 1)?,
            }
        }
        Ok(())
    }
}

/// Why a description is not a machine.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MachineError {
    /// Not a number where one is needed.
    #[error("{place} is {}: want a finite number, {unit}", Short(*value))]
    NotFinite {
        /// Where in the machine file.
        place: Place,
        /// What stands there.
        value: f64,
        /// In which unit it is wanted.
        unit: &'static str,
    },
    /// A number of the wrong sign or size.
    #[error("{place} is {}: want {want}", Short(*value))]
    OutOfRange {
        /// Where in the machine file.
        place: Place,
        /// What stands there.
        value: f64,
        /// What would be right.
        want: Want,
    },
    /// A name that nothing has.
    #[error("{place} names the {what} {:?}, which does not exist: want one of {known}", clipped(name))]
    Unknown {
        /// Where in the machine file.
        place: Place,
        /// Drive, link, length …
        what: &'static str,
        /// The name.
        name: String,
        /// What there is.
        known: String,
    },
    /// Two of the same name.
    #[error("{place} is {:?}, which is taken: want a name of its own", clipped(name))]
    Duplicate {
        /// Where in the machine file.
        place: Place,
        /// The name.
        name: String,
    },
    /// A name with a character that steers terminals.
    #[error("{place} holds the control character U+{:04X}: want a name of printable characters", u32::from(*character))]
    Unprintable {
        /// Where in the machine file.
        place: Place,
        /// The first such character.
        character: char,
    },
    /// The number of things.
    #[error("{count} {what}: want {want}")]
    Count {
        /// Drives, links …
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many would be right.
        want: String,
    },
    /// A text that goes on and on.
    #[error("{place} is {:?}: want at most {most} characters", clipped(text))]
    TooLong {
        /// Where in the machine file.
        place: Place,
        /// The text.
        text: String,
        /// The most characters.
        most: usize,
    },
    /// Links that hang on each other in a circle.
    #[error("{place}: link {link:?} hangs on itself ({chain}): want a chain that ends at \"base\"")]
    Cycle {
        /// Where in the machine file.
        place: Place,
        /// A link of the circle.
        link: String,
        /// The links of the circle, in order.
        chain: String,
    },
    /// A closure whose two points are not one.
    #[error(
        "{place}: {a} and {b} are not one point in every pose, they differ by {gap}: want a parallelogram that closes"
    )]
    OpenLoop {
        /// Where in the machine file.
        place: Place,
        /// The point as one link has it.
        a: String,
        /// The point as the other has it.
        b: String,
        /// The difference, as a sum of the drives' unit vectors.
        gap: String,
    },
    /// A relative angle with one limit.
    #[error("angle {:?} has only one limit: want both min and max, or neither to let it turn freely", clipped(angle))]
    HalfLimited {
        /// The angle.
        angle: String,
    },
    /// Motors whose stators sit on each other in a circle.
    #[error(
        "{place}: the motor of drive {drive:?} sits on itself ({chain}): want a chain that ends on the base, without \"on\""
    )]
    StatorCycle {
        /// Where in the machine file.
        place: Place,
        /// A drive of the circle.
        drive: String,
        /// The drives of the circle, in order.
        chain: String,
    },
    /// More than one end effector.
    #[error("{count} end effectors: want one, [end_effector]; machines with several hands are not there yet")]
    SeveralEndEffectors {
        /// How many there are.
        count: usize,
    },
    /// No end effector.
    #[error("no end effector: want [end_effector] with link = \"…\", at = \"tip\"")]
    NoEndEffector,
    /// A drive that moves nothing.
    #[error("drive {:?} moves no mass: want a link with inertia on it", clipped(drive))]
    Massless {
        /// The drive.
        drive: String,
    },
    /// One bar of a shared length.
    #[error(
        "link {link} shares its length {length} with {sharers}: changing it alone would break a parallelogram; set length.{length} instead"
    )]
    SharedLength {
        /// The link.
        link: String,
        /// The name of the length.
        length: String,
        /// The other links that share it.
        sharers: String,
    },
    /// A key of `--set` or of an edit that nothing answers to.
    #[error("no setting {:?}: want one of {known}", clipped(key))]
    UnknownKey {
        /// The key.
        key: String,
        /// What there is.
        known: String,
    },
    /// A value of `--set` that cannot be read.
    #[error("{}={:?}: want {want}", clipped(key), clipped(value))]
    BadValue {
        /// The key.
        key: String,
        /// What was given.
        value: String,
        /// What would be right.
        want: &'static str,
    },
    /// Not TOML, or not the TOML of a machine.
    #[error("{0}")]
    Syntax(String),
}

impl MachineError {
    /// The same with links, drives and angles by their names, as keys have them; what shares its name keeps its place.
    pub(super) fn named(mut self, spec: &MachineSpec) -> Self {
        let (Self::NotFinite { place, .. }
        | Self::OutOfRange { place, .. }
        | Self::Unknown { place, .. }
        | Self::Cycle { place, .. }) = &mut self
        else {
            return self;
        };
        if let [PlaceStep::Key(list), step, ..] = &mut place.0[..]
            && let PlaceStep::At(i) = *step
        {
            let names: Vec<&str> = match list.as_str() {
                "link" => spec.links.iter().map(|link| link.name.as_str()).collect(),
                "drive" => spec.drives.iter().map(|drive| drive.name.as_str()).collect(),
                "angle" => spec.angles.iter().map(|angle| angle.name.as_str()).collect(),
                _ => Vec::new(),
            };
            let own = names.get(i).filter(|own| names.iter().filter(|name| name == own).count() == 1);
            if let Some(name) = own {
                *step = PlaceStep::Named(i, (*name).to_owned());
            }
        }
        self
    }

    /// Where in the file, if it has a place.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::NotFinite { place, .. }
            | Self::OutOfRange { place, .. }
            | Self::Unknown { place, .. }
            | Self::Duplicate { place, .. }
            | Self::Unprintable { place, .. }
            | Self::TooLong { place, .. }
            | Self::Cycle { place, .. }
            | Self::StatorCycle { place, .. }
            | Self::OpenLoop { place, .. } => Some(place),
            _ => None,
        }
    }
}

/// Names as a message lists them.
pub(super) fn quoted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut known: Vec<String> = names.take(21).map(|n| format!("{:?}", clipped(n))).collect();
    if known.len() > 20 {
        known[20] = "…".into();
    }
    known.join(", ")
}
