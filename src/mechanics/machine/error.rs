//! [`MachineError`]: an error in a machine specification, with its place and the allowed values.

use std::fmt;

use thiserror::Error;

use super::spec::MachineSpec;
use stillbase_settings::number::{ShortNumber, fixed};
use stillbase_settings::range::{Requirement, quote_clipped};

/// A place in a machine file: a path of keys and positions. It is printed in the syntax of `--set`, such as
/// `link.5.mass`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KeyPath(pub Vec<KeyStep>);

/// One step of a [`KeyPath`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KeyStep {
    /// A key of a table.
    Key(String),
    /// A position in an array, counted from 0.
    At(usize),
    /// A position in an array, counted from 0, with the name of the element, which is printed instead.
    Named(usize, String),
}

impl KeyPath {
    /// Makes a place from its steps; numbers become positions.
    pub fn new(path: &[&dyn AsKeyStep]) -> Self {
        Self(path.iter().map(|s| s.step()).collect())
    }

    /// Makes a place from a key in the syntax of `--set`: parts joined by dots, positions in brackets, such as
    /// `task.via[3]`. Positions in brackets count from 1.
    pub fn of_key(key: &str) -> Self {
        let steps = key.split('.').flat_map(|part| {
            let (name, position) = part.split_once('[').unwrap_or((part, ""));
            let position = position.trim_end_matches(']').parse().ok().and_then(|i: usize| i.checked_sub(1));
            std::iter::once(KeyStep::Key(name.into())).chain(position.map(KeyStep::At))
        });
        Self(steps.collect())
    }

    /// Returns the same place relative to an outer table, in which the present table has the key `key`.
    #[must_use]
    pub fn under(self, key: &str) -> Self {
        Self(std::iter::once(KeyStep::Key(key.into())).chain(self.0).collect())
    }
}

/// Types that can be a step of a place.
pub trait AsKeyStep {
    /// Returns the step.
    fn step(&self) -> KeyStep;
}

impl AsKeyStep for &str {
    fn step(&self) -> KeyStep {
        KeyStep::Key((*self).into())
    }
}

impl AsKeyStep for String {
    fn step(&self) -> KeyStep {
        KeyStep::Key(self.clone())
    }
}

impl AsKeyStep for usize {
    fn step(&self) -> KeyStep {
        KeyStep::At(*self)
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [KeyStep::Key(angle), KeyStep::Named(_, name), KeyStep::Key(end)] = &self.0[..]
            && angle == "angle"
            && ["min", "max"].contains(&end.as_str())
        {
            return write!(f, "limits.{} ({end})", quote_clipped(name));
        }
        for (i, step) in self.0.iter().enumerate() {
            match step {
                // The table is `lengths`, the key of one length begins with `length`.
                KeyStep::Key(k) if i == 0 && k == "lengths" => f.write_str("length")?,
                KeyStep::Key(k) if i == 0 => f.write_str(&quote_clipped(k))?,
                KeyStep::Key(name) | KeyStep::Named(_, name) => write!(f, ".{}", quote_clipped(name))?,
                KeyStep::At(i) => write!(f, "[{}]", i + 1)?,
            }
        }
        Ok(())
    }
}

/// Error of a specification that is not a valid machine.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MachineError {
    /// A number that is not finite.
    #[error("{place} is {}: want a finite number, {unit}", ShortNumber(*value))]
    NotFinite {
        /// Place in the machine file.
        place: KeyPath,
        /// The number.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A number that is out of its range.
    #[error("{place} is {}: want {want}", ShortNumber(*value))]
    OutOfRange {
        /// Place in the machine file.
        place: KeyPath,
        /// The number.
        value: f64,
        /// The allowed values.
        want: Requirement,
    },
    /// A name that does not exist.
    #[error("{place} names the {what} {:?}, which does not exist: want one of {known}", quote_clipped(name))]
    Unknown {
        /// Place in the machine file.
        place: KeyPath,
        /// Kind of the part: drive, link, length …
        what: &'static str,
        /// The name.
        name: String,
        /// The names that exist.
        known: String,
    },
    /// Two parts have the same name.
    #[error("{place} is {:?}, which is taken: want a name of its own", quote_clipped(name))]
    Duplicate {
        /// Place in the machine file.
        place: KeyPath,
        /// The name.
        name: String,
    },
    /// A name with a control character, which could change a terminal's state.
    #[error("{place} holds the control character U+{:04X}: want a name of printable characters", u32::from(*character))]
    Unprintable {
        /// Place in the machine file.
        place: KeyPath,
        /// The first such character.
        character: char,
    },
    /// Too few or too many parts of a kind.
    #[error("{count} {what}: want {want}")]
    Count {
        /// Kind of the parts: drives, links …
        what: &'static str,
        /// Their number.
        count: usize,
        /// The allowed number, in words.
        want: String,
    },
    /// A text that is too long.
    #[error("{place} is {:?}: want at most {most} characters", quote_clipped(text))]
    TooLong {
        /// Place in the machine file.
        place: KeyPath,
        /// The text.
        text: String,
        /// Maximum number of characters.
        most: usize,
    },
    /// Links that are attached to each other in a cycle.
    #[error("{place}: link {link:?} hangs on itself ({chain}): want a chain that ends at \"base\"")]
    Cycle {
        /// Place in the machine file.
        place: KeyPath,
        /// A link that belongs to the cycle or leads to it.
        link: String,
        /// The links from this one into the cycle, in order; links of the cycle may repeat.
        chain: String,
    },
    /// A closure whose two points do not coincide in every pose.
    #[error(
        "{place}: {a} and {b} are not one point in every pose, they differ by {gap}: want a parallelogram that closes"
    )]
    OpenLoop {
        /// Place in the machine file.
        place: KeyPath,
        /// The point on the first link.
        a: String,
        /// The point on the second link.
        b: String,
        /// The difference, as a sum of the drives' unit vectors.
        gap: String,
    },
    /// A relative angle with only one limit.
    #[error(
        "angle {:?} has only one limit: want both min and max, or neither to let it turn freely",
        quote_clipped(angle)
    )]
    HalfLimited {
        /// The angle.
        angle: String,
    },
    /// Motors whose stators sit on each other in a cycle.
    #[error(
        "{place}: the motor of drive {drive:?} sits on itself ({chain}): want a chain that ends on the base, without \"on\""
    )]
    StatorCycle {
        /// Place in the machine file.
        place: KeyPath,
        /// A drive that belongs to the cycle or leads to it.
        drive: String,
        /// The drives from this one into the cycle, in order, up to the first that repeats.
        chain: String,
    },
    /// A part of a link that cannot be as it is stated.
    #[error("{place}: {why}")]
    Part {
        /// Place in the machine file.
        place: KeyPath,
        /// Description of the error, and of what would do.
        why: String,
    },
    /// A number of a link that is neither stated nor follows from parts.
    #[error(
        "{place}: missing field `{key}`: want a number, or a [[part]] or [[lump]] of link {:?} from which it follows",
        quote_clipped(link)
    )]
    NoParts {
        /// Place in the machine file.
        place: KeyPath,
        /// The key of the number.
        key: &'static str,
        /// The link.
        link: String,
    },
    /// A counterweight lies beyond the parts of its link.
    #[error(
        "counterweight {weight} lies at {} mm along link {:?} and {} mm to the left of its axis, beyond all its parts: \
         want a bar from root to tip, which is cut as long as needed, or a plate that reaches there",
        fixed(1e3 * at[0], 1),
        quote_clipped(link),
        fixed(1e3 * at[1], 1)
    )]
    NotCarried {
        /// The counterweight, counted from 1.
        weight: usize,
        /// The link.
        link: String,
        /// Its place along the link and to the left of its axis, m.
        at: [f64; 2],
    },
    /// More than one end effector.
    #[error("{count} end effectors: want one, [end_effector]; several are not supported")]
    SeveralEndEffectors {
        /// Their number.
        count: usize,
    },
    /// No end effector.
    #[error("no end effector: want [end_effector] with link = \"…\", at = \"tip\"")]
    NoEndEffector,
    /// A drive that moves no mass.
    #[error("drive {:?} moves no mass: want a link with inertia on it", quote_clipped(drive))]
    Massless {
        /// The drive.
        drive: String,
    },
    /// A new length for one of several links that share their length.
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
    /// A key of `--set` or of an edit that does not exist.
    #[error("no setting {:?}: want one of {known}", quote_clipped(key))]
    UnknownKey {
        /// The key.
        key: String,
        /// The keys that exist.
        known: String,
    },
    /// A value of `--set` that cannot be read.
    #[error("{}={:?}: want {want}", quote_clipped(key), quote_clipped(value))]
    BadValue {
        /// The key.
        key: String,
        /// The value that was given.
        value: String,
        /// The allowed values.
        want: &'static str,
    },
    /// The text is not TOML, or not the TOML of a machine.
    #[error("{0}")]
    Syntax(String),
}

impl MachineError {
    /// Returns the error with links, drives and angles named instead of numbered. A part whose name is not unique keeps
    /// its number.
    pub(super) fn named(mut self, spec: &MachineSpec) -> Self {
        let (Self::NotFinite { place, .. }
        | Self::OutOfRange { place, .. }
        | Self::Unknown { place, .. }
        | Self::NoParts { place, .. }
        | Self::Cycle { place, .. }) = &mut self
        else {
            return self;
        };
        if let [KeyStep::Key(list), step, ..] = &mut place.0[..]
            && let KeyStep::At(i) = *step
        {
            let names: Vec<&str> = match list.as_str() {
                "link" => spec.links.iter().map(|link| link.name.as_str()).collect(),
                "drive" => spec.drives.iter().map(|drive| drive.name.as_str()).collect(),
                "angle" => spec.angles.iter().map(|angle| angle.name.as_str()).collect(),
                _ => Vec::new(),
            };
            let own = names.get(i).filter(|own| names.iter().filter(|name| name == own).count() == 1);
            if let Some(name) = own {
                *step = KeyStep::Named(i, (*name).to_owned());
            }
        }
        self
    }

    /// Returns the place in the file, if the error has one.
    pub fn place(&self) -> Option<&KeyPath> {
        match self {
            Self::NotFinite { place, .. }
            | Self::OutOfRange { place, .. }
            | Self::Unknown { place, .. }
            | Self::Duplicate { place, .. }
            | Self::Unprintable { place, .. }
            | Self::TooLong { place, .. }
            | Self::Cycle { place, .. }
            | Self::StatorCycle { place, .. }
            | Self::OpenLoop { place, .. }
            | Self::Part { place, .. }
            | Self::NoParts { place, .. } => Some(place),
            _ => None,
        }
    }
}

/// Returns a list of names for messages: quoted, at most 20.
pub(super) fn quoted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut known: Vec<String> = names.take(21).map(|n| format!("{:?}", quote_clipped(n))).collect();
    if known.len() > 20 {
        known[20] = "…".into();
    }
    known.join(", ")
}
