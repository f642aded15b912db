//! [`Trimming`]: the query for what a measurement says of a machine, and for what mends it.

use thiserror::Error;

use super::doubt::{Doubt, doubt};
use super::error::TrimError;
use super::fit::fit;
use super::mend::{Mended, NoMend, mend};
use super::next::next;
use super::recording::Recording;
use super::report::TrimReport;
use super::rows::{Made, Rows};
use super::taken::{Taken, taken};
use super::way::Way;
use super::worth::worth;
use crate::mechanics::machine::Machine;
use crate::query::{Portion, Query, Shared, Watch};

/// A measurement, and what is asked of it.
#[derive(Clone, Debug, PartialEq)]
pub struct TrimRequest {
    /// As its file has it.
    pub machine: Shared<Machine>,
    /// What was measured.
    pub recording: Shared<Recording>,
    /// Leaves measured rates and accelerations alone.
    pub angles_only: bool,
    /// Takes the columns as they are, even where another sign, order or unit explains them far better.
    pub as_given: bool,
    /// What may change.
    pub way: Way,
    /// How fast a next motion may accelerate each drive, rad/s²; by default as fast as was seen.
    pub accelerations: Option<Vec<f64>>,
}

/// What a measurement comes to.
#[derive(Clone, Debug)]
pub struct Trimmed {
    /// Noise of the angles as a fraction of their accelerations, where it is so large that results may be off.
    pub angle_noise: Option<f64>,
    /// Why it might not be believed, where it is taken as given all the same.
    pub doubt: Option<Doubt>,
    /// What it says, or why it says nothing.
    pub outcome: Result<Trim, NoTrim>,
}

/// What a measurement says of a machine.
#[derive(Clone, Debug)]
pub struct Trim {
    /// What a person wants to know.
    pub report: TrimReport,
    /// What the machine is taken to be.
    pub taken: Taken,
    /// What mends it: nothing where no change is shown to help; or why nothing can.
    pub mended: Result<Mended, NoMend>,
}

/// Why a measurement says nothing.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoTrim {
    /// It cannot be used.
    #[error(transparent)]
    Unusable(TrimError),
    /// It is not what it says it is.
    #[error("{0}")]
    Doubted(Box<Doubt>),
    /// Nothing can be found from it.
    #[error(transparent)]
    NoFit(TrimError),
}

/// Noise of the angles beyond this fraction of their accelerations is worth a word.
const MAX_ANGLE_NOISE: f64 = 0.02;

/// Reads a measurement: first its rows, then what speaks against it, then what it says.
pub struct Trimming {
    request: TrimRequest,
    rows: Option<Rows>,
    doubted: Option<Option<Doubt>>,
}

impl Query for Trimming {
    type Input = TrimRequest;
    type Answer = Trimmed;

    fn begin(request: TrimRequest) -> Self {
        Self { request, rows: None, doubted: None }
    }

    fn go_on(&mut self, _: Watch<'_>) -> Portion<Trimmed> {
        let TrimRequest { machine, recording, angles_only, as_given, .. } = &self.request;
        let Some(rows) = &self.rows else {
            return match Rows::of(&machine.0, &recording.0, *angles_only) {
                Ok(rows) => {
                    self.rows = Some(rows);
                    Portion::More(0.05)
                }
                Err(why) => {
                    Portion::Done(Trimmed { angle_noise: None, doubt: None, outcome: Err(NoTrim::Unusable(why)) })
                }
            };
        };
        let angle_noise = match rows.made {
            Made::Windows { noise, .. } if noise > MAX_ANGLE_NOISE => Some(noise),
            _ => None,
        };
        let Some(doubted) = &mut self.doubted else {
            // What is wrong with the recording itself is said by the fit.
            let found = doubt(&machine.0, &recording.0, *angles_only).ok().flatten();
            if let Some(doubt) = found.clone().filter(|_| !as_given) {
                let outcome = Err(NoTrim::Doubted(doubt.into()));
                return Portion::Done(Trimmed { angle_noise, doubt: None, outcome });
            }
            self.doubted = Some(found);
            return Portion::More(0.8);
        };
        let outcome = Trim::of(&self.request, rows).map_err(NoTrim::NoFit);
        Portion::Done(Trimmed { angle_noise, doubt: doubted.take(), outcome })
    }
}

impl Trim {
    fn of(request: &TrimRequest, rows: &Rows) -> Result<Self, TrimError> {
        let machine = &*request.machine.0;
        let fit = fit(machine, rows)?;
        let taken = taken(&fit);
        let next = next(machine, &request.recording.0, rows, &fit, request.accelerations.as_deref());
        let mended = mend(machine, &taken, &request.way);
        let worth = mended.as_ref().ok().map(|mended| worth(machine, rows, &fit, &taken, mended));
        let helps = worth.is_some_and(|worth| worth.helps());
        // What is not shown to help is not proposed.
        let mended = mended.map(|mended| if helps { mended } else { Mended::not_at_all(machine, &taken) });
        let report = TrimReport::of(machine, rows, (&fit, &taken), (mended.as_ref().ok(), worth), &next);
        Ok(Self { report, taken, mended })
    }
}
