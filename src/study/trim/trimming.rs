//! [`TrimQuery`]: the query that evaluates a measurement of a machine and finds its correction.

use thiserror::Error;

use super::adopted_parameters::{AdoptedParameters, adopt_parameters};
use super::correction_benefit::correction_benefit;
use super::doubt::{Doubt, DoubtSearch, PlateMeasurement};
use super::error::TrimError;
use super::fit::{Fit, fit};
use super::machine_correction::{MachineCorrection, NoCorrection, correct_machine};
use super::next_excitation::{NextMeasurement, next_excitation};
use super::recording::MeasurementSet;
use super::report::TrimReport;
use super::rows::{Regressor, RegressorSource};
use super::trim_method::TrimMethod;
use stillbase_mechanics::machine::Machine;
use stillbase_query::{Portion, ProgressCallback, Query, Shared};

/// A measurement, with the options for its evaluation.
#[derive(Clone, Debug, PartialEq)]
pub struct TrimRequest {
    /// The machine of the file.
    pub machine: Shared<Machine>,
    /// The measured data.
    pub recording: Shared<MeasurementSet>,
    /// Whether to ignore measured rates and accelerations.
    pub angles_only: bool,
    /// Whether to accept the columns as given, even if another sign, order or unit explains them far better.
    pub as_given: bool,
    /// Numbers that may change.
    pub method: TrimMethod,
    /// Maximum acceleration of each drive in a next motion, rad/s²; by default the largest measured.
    pub accelerations: Option<Vec<f64>>,
}

/// Result of the evaluation.
#[derive(Clone, Debug)]
pub struct TrimOutcome {
    /// Relative noise of the accelerations due to noisy angles, if it is so large that results may be inaccurate.
    pub angle_noise: Option<f64>,
    /// Suspected fault of a measurement that was nevertheless accepted as given.
    pub doubt: Option<Doubt>,
    /// The identified machine, or the reason that there is none.
    pub outcome: Result<TrimResult, NoTrim>,
}

/// Identified values of a machine, and their correction.
#[derive(Clone, Debug)]
pub struct TrimResult {
    /// Report for the user.
    pub report: TrimReport,
    /// The machine as identified.
    pub adopted: AdoptedParameters,
    /// Correction, without changes if none is significant; or the reason that there is none.
    pub correction: Result<MachineCorrection, NoCorrection>,
}

/// Reason that a measurement has no result.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoTrim {
    /// The recording cannot be used.
    #[error(transparent)]
    Unusable(TrimError),
    /// A fault in the measurement is suspected.
    #[error("{0}")]
    Doubted(Box<Doubt>),
    /// The unknowns cannot be estimated.
    #[error(transparent)]
    NoFit(TrimError),
}

/// Relative noise of the accelerations above which it is reported.
const MAX_ANGLE_NOISE: f64 = 0.02;

/// Fractions of the work done after rows are built, faults tested, unknowns fitted, and the next motion found.
const MADE_AT: f64 = 0.05;
const TRIED_AT: f64 = 0.8;
const FITTED_AT: f64 = 0.9;
const SEARCHED_AT: f64 = 0.95;

/// Evaluates a measurement: builds its rows, tests for faults (one in each portion), fits the unknowns and finds the
/// correction.
pub struct TrimQuery {
    request: TrimRequest,
    stage: Stage,
    /// As [`TrimOutcome::angle_noise`].
    angle_noise: Option<f64>,
    doubt: Option<Doubt>,
}

/// Stage of the work.
enum Stage {
    Begun,
    /// Rows are built.
    Made(Regressor),
    Doubting(Regressor, Box<DoubtSearch<PlateMeasurement>>),
    /// No fault is suspected, or the measurement is accepted as given.
    Believed(Regressor),
    Fitted(Regressor, Box<Fit>),
    /// The next motion is found.
    Searched(Regressor, Box<Fit>, NextMeasurement),
}

impl Query for TrimQuery {
    type Input = TrimRequest;
    type Answer = TrimOutcome;

    fn begin(request: TrimRequest) -> Self {
        Self { request, stage: Stage::Begun, angle_noise: None, doubt: None }
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<TrimOutcome> {
        let outcome = match self.next() {
            Ok(Portion::More(share)) => return Portion::More(share),
            Ok(Portion::Stopped) => return Portion::Stopped,
            Ok(Portion::Done(trim)) => Ok(trim),
            Err(why) => Err(why),
        };
        Portion::Done(TrimOutcome { angle_noise: self.angle_noise, doubt: self.doubt.take(), outcome })
    }
}

impl TrimQuery {
    fn next(&mut self) -> Result<Portion<TrimResult>, NoTrim> {
        let TrimRequest { machine: Shared(machine), recording: Shared(recording), angles_only, .. } = &self.request;
        let (stage, share) = match std::mem::replace(&mut self.stage, Stage::Begun) {
            Stage::Begun => {
                let rows = Regressor::of(machine, recording, *angles_only).map_err(NoTrim::Unusable)?;
                self.angle_noise = match rows.source {
                    RegressorSource::Windows { noise, .. } if noise > MAX_ANGLE_NOISE => Some(noise),
                    _ => None,
                };
                (Stage::Made(rows), MADE_AT)
            }
            Stage::Made(rows) => match PlateMeasurement::search(machine, recording, *angles_only) {
                Ok(doubting) => (Stage::Doubting(rows, doubting.into()), MADE_AT),
                // The fit reports errors of the recording itself.
                Err(_) => (Stage::Believed(rows), TRIED_AT),
            },
            Stage::Doubting(rows, mut doubting) => match doubting.next(machine) {
                true => {
                    let share = MADE_AT + (TRIED_AT - MADE_AT) * doubting.share();
                    (Stage::Doubting(rows, doubting), share)
                }
                false => {
                    self.doubt = doubting.doubt(machine);
                    if let Some(doubt) = self.doubt.take_if(|_| !self.request.as_given) {
                        return Err(NoTrim::Doubted(doubt.into()));
                    }
                    (Stage::Believed(rows), TRIED_AT)
                }
            },
            Stage::Believed(rows) => {
                let fit = fit(machine, &rows).map_err(NoTrim::NoFit)?;
                (Stage::Fitted(rows, fit.into()), FITTED_AT)
            }
            Stage::Fitted(rows, fit) => {
                let next = next_excitation(machine, recording, &rows, &fit, self.request.accelerations.as_deref());
                (Stage::Searched(rows, fit, next), SEARCHED_AT)
            }
            Stage::Searched(rows, fit, next) => {
                return Ok(Portion::Done(TrimResult::of(&self.request, &rows, &fit, &next)));
            }
        };
        self.stage = stage;
        Ok(Portion::More(share))
    }
}

impl TrimResult {
    /// Returns the result of a fit, with the correction and the proposal for the next motion.
    fn of(request: &TrimRequest, rows: &Regressor, fit: &Fit, next: &NextMeasurement) -> Self {
        let machine = &*request.machine.0;
        let adopted = adopt_parameters(fit);
        let mended = correct_machine(machine, &adopted, &request.method);
        let worth = mended.as_ref().ok().map(|mended| correction_benefit(machine, rows, fit, &adopted, mended));
        let helps = worth.is_some_and(|worth| worth.helps());
        // A change whose effect is not significant is not proposed.
        let correction =
            mended.map(|mended| if helps { mended } else { MachineCorrection::unchanged(machine, &adopted) });
        let report = TrimReport::of(machine, rows, fit, &adopted, correction.as_ref().ok(), worth, next);
        Self { report, adopted, correction }
    }
}
