//! [`Form`]: in which a machine goes elsewhere, by the ending of a file's name. Each stands once, in [`FORMS`].

use super::cut::{Cut, CutError};
use super::drawing::{Sheet, dxf, svg};
use super::mjcf::{MjcfError, mjcf};
use super::parts::Parts;
use super::urdf::urdf;
use crate::mechanics::machine::Machine;

/// In which a machine goes elsewhere.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// How names of its files end.
    pub ending: &'static str,
    /// What it shows of a machine.
    pub shows: Shows,
    write: fn(&Machine, &[f64], &Cut) -> Result<String, ExchangeError>,
}

/// What a file shows of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// A model of it with a pose to begin in.
    Pose,
    /// A model of it with the joints of its motors.
    Joints,
    /// Its links, drawn as they are cut.
    Links,
    /// A list of its parts.
    Parts,
}

/// All of them.
pub const FORMS: [Form; 6] = [
    // For MuJoCo.
    Form { ending: "xml", shows: Shows::Pose, write: |machine, pose, _| Ok(mjcf(machine, pose)?) },
    // For ROS, Pinocchio and others.
    Form { ending: "urdf", shows: Shows::Joints, write: |machine, _, _| Ok(urdf(machine)) },
    // To look at.
    Form { ending: "svg", shows: Shows::Links, write: |machine, _, cut| Ok(svg(&Sheet::of(machine, cut)?)) },
    // To cut by.
    Form { ending: "dxf", shows: Shows::Links, write: |machine, _, cut| Ok(dxf(&Sheet::of(machine, cut)?)) },
    // For a spreadsheet.
    Form { ending: "csv", shows: Shows::Parts, write: |machine, _, cut| Ok(Parts::of(machine, cut)?.csv()) },
    // To read.
    Form { ending: "md", shows: Shows::Parts, write: |machine, _, cut| Ok(Parts::of(machine, cut)?.markdown()) },
];

/// The ending where nobody says another.
pub const USUAL_ENDING: &str = "urdf";

/// Why a machine stays.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExchangeError {
    /// MuJoCo could not move it.
    #[error(transparent)]
    Mjcf(#[from] MjcfError),
    /// It cannot be cut so.
    #[error(transparent)]
    Cut(#[from] CutError),
    /// Nothing is written under such a name.
    #[error("a name that ends in {ending:?}: want one that ends in {}", listed(|_| true))]
    Ending {
        /// As given.
        ending: String,
    },
}

/// The endings of all forms.
pub fn endings() -> [&'static str; FORMS.len()] {
    FORMS.map(|form| form.ending)
}

/// The endings of some forms as a sentence has them: `.svg, .dxf or .csv`.
pub fn listed(of: impl Fn(Shows) -> bool) -> String {
    let endings: Vec<String> =
        FORMS.iter().filter(|form| of(form.shows)).map(|form| format!(".{}", form.ending)).collect();
    match endings.as_slice() {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        _ => endings.concat(),
    }
}

impl Form {
    /// By how a name ends.
    ///
    /// # Errors
    /// If it ends in nothing that is written.
    pub fn of(ending: &str) -> Result<Self, ExchangeError> {
        let own = FORMS.into_iter().find(|form| form.ending.eq_ignore_ascii_case(ending));
        own.ok_or_else(|| ExchangeError::Ending { ending: ending.chars().take(40).collect() })
    }

    /// The file's text; the pose, rad, is that of a keyframe.
    ///
    /// # Errors
    /// What stands in the way.
    pub fn written(&self, machine: &Machine, pose: &[f64], cut: &Cut) -> Result<String, ExchangeError> {
        (self.write)(machine, pose, cut)
    }
}
