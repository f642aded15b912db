//! [`Trimming`]: the query for what a measurement says of a machine, and for what mends it.

use thiserror::Error;

use super::doubt::{Doubt, Doubting};
use super::error::TrimError;
use super::fit::{Fit, fit};
use super::mend::{Mended, NoMend, mend};
use super::next::{Next, next};
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

/// Up to these shares of the work rows are made, faults are tried, numbers are fitted, and a next motion is searched for.
const MADE: f64 = 0.05;
const TRIED: f64 = 0.8;
const FITTED: f64 = 0.9;
const SEARCHED: f64 = 0.95;

/// Reads a measurement: first its rows, then what speaks against it, a fault in a portion, then what it says.
pub struct Trimming {
    request: TrimRequest,
    stage: Stage,
    /// As in [`Trimmed`].
    angle_noise: Option<f64>,
    doubt: Option<Doubt>,
}

/// How far it is.
enum Stage {
    Begun,
    /// Rows are made.
    Made(Rows),
    Doubting(Rows, Box<Doubting>),
    /// It is believed.
    Believed(Rows),
    Fitted(Rows, Box<Fit>),
    /// A next motion is found.
    Searched(Rows, Box<Fit>, Next),
}

impl Query for Trimming {
    type Input = TrimRequest;
    type Answer = Trimmed;

    fn begin(request: TrimRequest) -> Self {
        Self { request, stage: Stage::Begun, angle_noise: None, doubt: None }
    }

    fn go_on(&mut self, _: Watch<'_>) -> Portion<Trimmed> {
        let outcome = match self.next() {
            Ok(Portion::More(share)) => return Portion::More(share),
            Ok(Portion::Stopped) => return Portion::Stopped,
            Ok(Portion::Done(trim)) => Ok(trim),
            Err(why) => Err(why),
        };
        Portion::Done(Trimmed { angle_noise: self.angle_noise, doubt: self.doubt.take(), outcome })
    }
}

impl Trimming {
    fn next(&mut self) -> Result<Portion<Trim>, NoTrim> {
        let TrimRequest { machine: Shared(machine), recording: Shared(recording), angles_only, .. } = &self.request;
        let (stage, share) = match std::mem::replace(&mut self.stage, Stage::Begun) {
            Stage::Begun => {
                let rows = Rows::of(machine, recording, *angles_only).map_err(NoTrim::Unusable)?;
                self.angle_noise = match rows.made {
                    Made::Windows { noise, .. } if noise > MAX_ANGLE_NOISE => Some(noise),
                    _ => None,
                };
                (Stage::Made(rows), MADE)
            }
            Stage::Made(rows) => match Doubting::begin(machine, recording, *angles_only) {
                Ok(doubting) => (Stage::Doubting(rows, doubting.into()), MADE),
                // What is wrong with the recording itself is said by the fit.
                Err(_) => (Stage::Believed(rows), TRIED),
            },
            Stage::Doubting(rows, mut doubting) => match doubting.next(machine) {
                true => {
                    let share = MADE + (TRIED - MADE) * doubting.share();
                    (Stage::Doubting(rows, doubting), share)
                }
                false => {
                    self.doubt = doubting.doubt(machine);
                    if let Some(doubt) = self.doubt.take_if(|_| !self.request.as_given) {
                        return Err(NoTrim::Doubted(doubt.into()));
                    }
                    (Stage::Believed(rows), TRIED)
                }
            },
            Stage::Believed(rows) => {
                let fit = fit(machine, &rows).map_err(NoTrim::NoFit)?;
                (Stage::Fitted(rows, fit.into()), FITTED)
            }
            Stage::Fitted(rows, fit) => {
                let next = next(machine, recording, &rows, &fit, self.request.accelerations.as_deref());
                (Stage::Searched(rows, fit, next), SEARCHED)
            }
            Stage::Searched(rows, fit, next) => {
                return Ok(Portion::Done(Trim::of(&self.request, &rows, &fit, &next)));
            }
        };
        self.stage = stage;
        Ok(Portion::More(share))
    }
}

impl Trim {
    /// What a fit says, with what would tell more.
    fn of(request: &TrimRequest, rows: &Rows, fit: &Fit, next: &Next) -> Self {
        let machine = &*request.machine.0;
        let taken = taken(fit);
        let mended = mend(machine, &taken, &request.way);
        let worth = mended.as_ref().ok().map(|mended| worth(machine, rows, fit, &taken, mended));
        let helps = worth.is_some_and(|worth| worth.helps());
        // What is not shown to help is not proposed.
        let mended = mended.map(|mended| if helps { mended } else { Mended::not_at_all(machine, &taken) });
        let report = TrimReport::of(machine, rows, (fit, &taken), (mended.as_ref().ok(), worth), next);
        Self { report, taken, mended }
    }
}
