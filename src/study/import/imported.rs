//! [`ImportedMotion`]: the reactions of a given motion, and the motion proposed in its place.

use schemars::JsonSchema;
use serde::Serialize;

use super::given::GivenMotion;
use super::judge::{MotionEffects, MotionEvaluator, Proposal};
use crate::advice::{Advice, Remedy};
use stillbase_planning::curves::Coordinates;
use stillbase_session::scenario::Scenario;
use stillbase_settings::number::fixed;

/// The reactions of a given motion, and the motion proposed in its place.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct ImportedMotion {
    /// Name of the machine.
    pub machine: String,
    /// Coordinates that the samples give: `drives` or `tip`.
    pub content: &'static str,
    /// Number of samples.
    pub samples: usize,
    /// Time of the first sample, s.
    pub start: f64,
    /// Time from the first to the last sample, s.
    pub duration: f64,
    /// Cut-off frequency of smoothing, Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothed_at: Option<f64>,
    /// Largest change of a sample by smoothing, rad or m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub smoothed_by: Option<f64>,
    /// Uncertainty of the second derivative of each column, rad/s² or m/s².
    pub uncertainty: Vec<f64>,
    /// Smallest and largest b at the samples, rad; the spline between the samples may exceed these. `None` for samples
    /// of the end effector.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub b_samples: Option<[f64; 2]>,
    /// Assessment of the given motion; for samples of the end effector, of minimum-norm rates. `None` if these cannot
    /// follow the samples.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub given: Option<MotionEffects>,
    /// Whether there is a proposal.
    pub feasible: bool,
    /// Reason that there is no proposal.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<String>")]
    pub reason: Option<Advice>,
    /// The nearest motion without reactions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub proposal: Option<Proposal>,
    /// Whether the machine has a pose constant b.
    #[serde(skip)]
    pub has_b: bool,
    /// Remarks on the motions, one sentence each.
    #[serde(skip)]
    pub notes: Vec<Advice>,
    /// Scenarios that run the proposal and the given motion.
    #[serde(skip)]
    pub scenarios: Option<[Scenario; 2]>,
    /// Scenario that runs the given motion, whether there is a proposal or not.
    #[serde(skip)]
    pub as_given: Option<Scenario>,
}

/// A note is made if the uncertainty of a second derivative exceeds this fraction of its peak.
const MAX_UNCERTAINTY: f64 = 0.05;
/// Peaks of a second derivative below this, rad/s² or m/s², count as rest.
const MIN_PEAK: f64 = 1e-9;
/// Final rate, as a fraction of the largest rate, up to which a motion counts as ending at rest.
const MAX_END_SPEED: f64 = 1e-3;

impl ImportedMotion {
    /// Returns the report on a given motion, without a proposal; `given` is its assessment.
    pub(super) fn of(motion: &GivenMotion, judge: &MotionEvaluator, given: Option<MotionEffects>) -> Self {
        let samples = &motion.samples;
        let lambda = judge.arm.arm().lambda();
        let b = (0..samples.count()).map(|i| lambda.dot(samples.values(i)));
        let is_of_drives = motion.coordinates == Coordinates::Drives;
        let mut imported = Self {
            machine: judge.machine.name().to_owned(),
            content: motion.coordinates.name(),
            samples: samples.count(),
            start: samples.time(0),
            duration: samples.duration(),
            smoothed_at: motion.smoothing.map(|[cut_off, _]| cut_off),
            smoothed_by: motion.smoothing.map(|[_, change]| change),
            uncertainty: (0..samples.columns()).map(|k| samples.uncertainty(k)).collect(),
            b_samples: is_of_drives
                .then(|| b.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], b| [low.min(b), high.max(b)])),
            given,
            feasible: false,
            reason: None,
            proposal: None,
            has_b: judge.space.is_ok(),
            notes: Vec::new(),
            scenarios: None,
            as_given: None,
        };
        imported.notes = imported.notes_of(motion);
        imported
    }

    fn notes_of(&self, motion: &GivenMotion) -> Vec<Advice> {
        // Without a spline there are no second derivatives, and no motion that a note could be about.
        let Some(peaks) = motion.second_derivatives() else { return Vec::new() };
        let is_of_drives = motion.coordinates == Coordinates::Drives;
        let unit = if is_of_drives { "rad/s²" } else { "m/s²" };
        let mut notes: Vec<Advice> = Vec::new();
        for ((name, uncertainty), peak) in motion.names.iter().zip(&self.uncertainty).zip(peaks) {
            if *uncertainty > MAX_UNCERTAINTY * peak && peak > MIN_PEAK {
                let note = Advice::from(format!(
                    "the second derivative of {name} is uncertain by some {} {unit}, of a peak of {}: noise, or too few \
                     digits or samples",
                    fixed(*uncertainty, 4),
                    fixed(peak, 4),
                ));
                notes.push(match motion.smoothing {
                    Some(_) => note,
                    None => note.then("; ").name(Remedy::CutOff).then(" removes higher frequencies"),
                });
            }
        }
        let Some(given) = &self.given else { return notes };
        if given.past_limits > 0.0 {
            let what = if is_of_drives { "the motion as given" } else { "minimum-norm rates" };
            let past = fixed(given.past_limits, 4);
            notes.push(format!("{what}: relative angles pass their limits by up to {past} rad").into());
        }
        if given.speed_end > MAX_END_SPEED * given.peak_speed.iter().fold(0.0, |m: f64, x| m.max(*x)) {
            let speed = fixed(given.speed_end, 4);
            notes.push(format!("the motion does not end at rest ({speed} rad/s): after it control brakes").into());
        }
        notes
    }

    /// Adds a proposal, with the scenarios that run it and the given motion.
    pub(super) fn propose(&mut self, proposal: Proposal, scenarios: [Scenario; 2]) {
        if let Some((limit, factor)) = &proposal.account.over {
            let times = fixed(*factor, 2);
            let note =
                Advice::from(format!("the proposal needs {times} × the {limit}: want slower samples or another "));
            self.notes.push(note.name(Remedy::PoseConstant));
        }
        self.feasible = true;
        self.reason = None;
        self.proposal = Some(proposal);
        self.as_given = Some(scenarios[1].clone());
        self.scenarios = Some(scenarios);
    }
}
