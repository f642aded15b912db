//! [`MachineError`]: an error in a machine specification, with its place and the allowed values.

use std::borrow::Cow;

use thiserror::Error;

use super::spec::MachineSpec;
use super::words::named;
pub use stillbase_settings::key_path::{KeyPath, KeyStep};
use stillbase_settings::number::{ShortNumber, fixed};
use stillbase_settings::range::{Requirement, quote_clipped};

/// Error of a specification that is not a valid machine.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MachineError {
    /// A number that is not finite.
    #[error("{} is {}: want a finite number, {unit}", named(place), ShortNumber(*value))]
    NotFinite {
        /// Place in the machine file.
        place: KeyPath,
        /// The number.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A number that is out of its range.
    #[error("{} is {}: want {want}", named(place), ShortNumber(*value))]
    OutOfRange {
        /// Place in the machine file.
        place: KeyPath,
        /// The number.
        value: f64,
        /// The allowed values.
        want: Requirement,
    },
    /// A name that does not exist.
    #[error(
        "{} names the {what} {:?}, which does not exist: want {}",
        named(place),
        quote_clipped(name),
        one_of(known, more)
    )]
    Unknown {
        /// Place in the machine file.
        place: KeyPath,
        /// Kind of the part: drive, link, length …
        what: &'static str,
        /// The name.
        name: String,
        /// The names that exist.
        known: Vec<String>,
        /// Words that follow the names: what else would do.
        more: Cow<'static, str>,
    },
    /// Two parts have the same name.
    #[error("{} is {:?}, which is taken: want a name of its own", named(place), quote_clipped(name))]
    Duplicate {
        /// Place in the machine file.
        place: KeyPath,
        /// The name.
        name: String,
    },
    /// A name with a control character, which could change a terminal's state.
    #[error(
        "{} holds the control character U+{:04X}: want a name of printable characters",
        named(place),
        u32::from(*character)
    )]
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
    #[error("{} is {:?}: want at most {most} characters", named(place), quote_clipped(text))]
    TooLong {
        /// Place in the machine file.
        place: KeyPath,
        /// The text.
        text: String,
        /// Maximum number of characters.
        most: usize,
    },
    /// Links that are attached to each other in a cycle.
    #[error("{}: link {link:?} hangs on itself ({chain}): want a chain that ends at \"base\"", named(place))]
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
        "{}: {a} and {b} are not one point in every pose, they differ by {gap}: want a parallelogram that closes",
        named(place)
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
        /// Place in the machine file.
        place: KeyPath,
        /// The angle.
        angle: String,
    },
    /// Motors whose stators sit on each other in a cycle.
    #[error(
        "{}: the motor of drive {drive:?} sits on itself ({chain}): want a chain that ends on the base, without \"on\"",
        named(place)
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
    #[error("{}: {why}", named(place))]
    Part {
        /// Place in the machine file.
        place: KeyPath,
        /// Description of the error, and of what would do.
        why: String,
    },
    /// Moments of inertia that no body has.
    #[error("{} {why}", named(place))]
    Transverse {
        /// Place in the machine file.
        place: KeyPath,
        /// The moments, and which would do.
        why: String,
    },
    /// A machine with links that keep their orientation, where only others are taken.
    #[error(
        "link {:?} keeps its orientation (drive = \"ground\"): want a machine all of whose links follow drives, as {what} \
         take no other",
        quote_clipped(link)
    )]
    Ground {
        /// The first such link.
        link: String,
        /// What takes no such machine, in the plural.
        what: &'static str,
    },
    /// A number of a link that is neither stated nor follows from parts.
    #[error(
        "{} is missing: want a number, or a [[part]] or [[lump]] of link {:?} from which it follows",
        named(place),
        quote_clipped(link)
    )]
    NoParts {
        /// Place in the machine file.
        place: KeyPath,
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

/// The pattern of every error that has a place.
macro_rules! every_place {
    ($place:ident) => {
        Self::NotFinite { $place, .. }
            | Self::OutOfRange { $place, .. }
            | Self::Unknown { $place, .. }
            | Self::Duplicate { $place, .. }
            | Self::Unprintable { $place, .. }
            | Self::TooLong { $place, .. }
            | Self::Cycle { $place, .. }
            | Self::StatorCycle { $place, .. }
            | Self::OpenLoop { $place, .. }
            | Self::Part { $place, .. }
            | Self::Transverse { $place, .. }
            | Self::HalfLimited { $place, .. }
            | Self::NoParts { $place, .. }
    };
}

impl MachineError {
    /// Returns the error with links, drives and angles named instead of numbered. A part whose name is wrong itself, or
    /// is not unique, keeps its number.
    pub(super) fn named(mut self, spec: &MachineSpec) -> Self {
        let Some(place) = self.place_mut().filter(|place| place.last_key() != Some("name")) else { return self };
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
            every_place!(place) => Some(place),
            _ => None,
        }
    }

    fn place_mut(&mut self) -> Option<&mut KeyPath> {
        match self {
            every_place!(place) => Some(place),
            _ => None,
        }
    }
}

/// Returns the names that exist, for messages that say what would be right.
fn one_of(known: &[String], more: &str) -> String {
    match known {
        [] if more.is_empty() => "one that exists; there is none yet".into(),
        [] => more.trim_start_matches(", ").trim_start_matches("or ").into(),
        known => format!("one of {}{more}", quoted(known.iter().map(String::as_str))),
    }
}

/// Returns a list of names for messages: quoted, at most 20.
fn quoted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut known: Vec<String> = names.take(21).map(|n| format!("{:?}", quote_clipped(n))).collect();
    if known.len() > 20 {
        known[20] = "…".into();
    }
    known.join(", ")
}
