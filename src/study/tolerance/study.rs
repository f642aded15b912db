//! [`Study`]: effects of tolerances on a run, and its spectra, as plain data.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{
    Agreement, Bands, CHUNK, Ensemble, Histogram, Quantiles, SampleOutcome, Share, Shares, ToleranceError, Yield,
};
use crate::base_spectrum::{BaseSpectrum, PerAxis};
use crate::spectrum::{Spectrum, WindowFunction};
use stillbase_query::{Portion, ProgressCallback, Query};
use stillbase_session::Run;
use stillbase_session::scenario::{Scenario, Spread, Tolerance};
use stillbase_simulation::control::Control;
use stillbase_simulation::plant::PlantDifferences;

/// Number of instants at which a motion is evaluated.
pub const STUDY_INSTANTS: usize = 200;

/// Number of machines, unless the scenario states it.
const DEFAULT_SAMPLES: u64 = 20_000;

/// Maximum number of machines: the outcomes of all of them are stored.
const MAX_SAMPLES: u64 = 1_000_000;

/// Effects of tolerances on a run.
#[derive(Clone, Debug)]
pub struct Study {
    /// Tolerances of the scenario.
    pub tolerance: Tolerance,
    /// Spreads by key, with the defaults if none are stated.
    pub spreads: BTreeMap<String, Spread>,
    /// Number of machines drawn.
    pub samples: u64,
    /// Number of parameters that vary.
    pub parameters: usize,
    /// n_B and |f_B| over time.
    pub bands: Bands,
    /// Agreement of first-order results with exact and sampled ones.
    pub agreement: Agreement,
    /// Quantiles of the peak |n_B|, N m: at 5, 50, 95, 99 %.
    pub moment: Quantiles,
    /// Quantiles of the peak |f_B|, N, at the same levels.
    pub force: Quantiles,
    /// Histogram of the peak |n_B|, N m.
    pub moment_histogram: Histogram,
    /// Yield within the given limits.
    pub yields: Option<Yield>,
    /// Contribution of each tolerance, the largest for |n_B| first.
    pub shares: Vec<Share>,
    /// Spectra of f_Bx, f_By and the moment on the base, over the run.
    pub spectra: Option<[Spectrum; 3]>,
    /// Features of the scenario that perfect tracking on a fixed base omits; with any of them, only full simulation is
    /// exact.
    pub left_out: Vec<&'static str>,
}

/// Query for the study of a run; a portion draws about two thousand machines.
#[derive(Debug)]
pub struct StudyQuery {
    run: Run,
    drawing: Option<Drawing>,
}

/// Machines being drawn.
#[derive(Debug)]
struct Drawing {
    tolerance: Tolerance,
    spreads: BTreeMap<String, Spread>,
    ensemble: Ensemble,
    samples: u64,
    outcomes: Vec<SampleOutcome>,
    /// Number of chunks drawn.
    drawn: u64,
}

/// Number of chunks in a portion, which takes a few milliseconds.
const CHUNKS_PER_PORTION: u64 = 8;

/// A run as the input of a study; two runs are equal if their scenarios are.
#[derive(Clone, Debug)]
pub struct StudiedRun(pub Arc<Run>);

impl PartialEq for StudiedRun {
    fn eq(&self, other: &Self) -> bool {
        self.0.shared_scenario() == other.0.shared_scenario()
    }
}

impl Query for StudyQuery {
    type Input = StudiedRun;
    type Answer = Result<Study, String>;

    fn begin(StudiedRun(run): StudiedRun) -> Self {
        Self { run: Run::clone(&run), drawing: None }
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<Self::Answer> {
        if let Some(waiting) = self.run.waiting() {
            return Portion::Done(Err(waiting.why.to_string()));
        }
        let Some(drawing) = &mut self.drawing else {
            return match Drawing::of(&self.run) {
                Ok(drawing) => {
                    self.drawing = Some(drawing);
                    Portion::More(0.0)
                }
                Err(why) => Portion::Done(Err(why.to_string())),
            };
        };
        drawing.draw(CHUNKS_PER_PORTION);
        match drawing.share() {
            share if share < 1.0 => Portion::More(share),
            _ => Portion::Done(Ok(Study::of(&self.run, drawing))),
        }
    }
}

impl Drawing {
    /// Prepares the machines for a run's planned motion.
    ///
    /// # Errors
    /// Fails if nothing varies, a key or spread is wrong, or a length cannot vary alone.
    fn of(run: &Run) -> Result<Self, ToleranceError> {
        let scenario = run.scenario();
        let plant = scenario.plant_machine().map_err(ToleranceError::Machine)?;
        let tolerance = scenario.tolerance.clone();
        let (seed, samples) =
            (tolerance.seed.unwrap_or(1), tolerance.samples.unwrap_or(DEFAULT_SAMPLES).clamp(1, MAX_SAMPLES));
        let spreads = tolerance.spreads_or_default(&plant);
        let ensemble = Ensemble::new(&plant, &run.plan().motion, STUDY_INSTANTS, &spreads, seed)?;
        let outcomes = Vec::with_capacity(samples as usize + CHUNK);
        Ok(Self { tolerance, spreads, ensemble, samples, outcomes, drawn: 0 })
    }

    fn chunks(&self) -> u64 {
        self.samples.div_ceil(CHUNK as u64)
    }

    /// Returns the fraction drawn, from 0 to 1.
    fn share(&self) -> f64 {
        self.drawn as f64 / self.chunks() as f64
    }

    /// Draws a number of further chunks, or all that remain.
    fn draw(&mut self, chunks: u64) {
        let until = self.chunks().min(self.drawn + chunks);
        let mut sampler = self.ensemble.sampler();
        for chunk in self.drawn..until {
            self.outcomes.extend(sampler.outcomes(chunk));
        }
        self.drawn = until;
        self.outcomes.truncate(self.samples as usize);
    }
}

impl Study {
    /// Returns the study of a run from the machines drawn.
    fn of(run: &Run, drawing: &Drawing) -> Self {
        let Drawing { tolerance, spreads, ensemble, outcomes, .. } = drawing;
        let (scenario, samples) = (run.scenario(), drawing.samples);
        let sorted = |value: fn(&SampleOutcome) -> f64| {
            let mut values: Vec<f64> = outcomes.iter().map(value).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        };
        let (moments, forces) = (sorted(|o| o.peak_moment), sorted(|o| o.peak_force));
        let empty = || Quantiles { levels: Vec::new(), values: Vec::new() };
        let levels = [0.05, 0.5, 0.95, 0.99];
        let quantiles = |sorted: &[f64]| Quantiles::of_sorted(sorted, &levels).unwrap_or_else(empty);
        let within = |limit: Option<f64>, x: f64| limit.is_none_or(|limit| x <= limit);
        let limited = tolerance.moment_limit.is_some() || tolerance.force_limit.is_some();
        let yields = limited.then(|| {
            let good = outcomes.iter().filter(|o| {
                within(tolerance.moment_limit, o.peak_moment) && within(tolerance.force_limit, o.peak_force)
            });
            Yield::new(good.count() as u64, samples)
        });
        let bands = Bands::of(ensemble, samples);
        let mut shares = Shares::of(ensemble).parameters;
        shares.sort_by(|a, b| b.moment_share.total_cmp(&a.moment_share));
        Self {
            samples,
            parameters: ensemble.parameters().len(),
            agreement: Agreement::of(&bands),
            bands,
            moment: quantiles(&moments),
            force: quantiles(&forces),
            moment_histogram: Histogram::of_sorted(&moments, 40)
                .unwrap_or(Histogram { edges: vec![0.0, 1.0], counts: vec![0] }),
            yields,
            shares,
            spectra: spectra(run),
            left_out: neglected_effects(scenario),
            tolerance: tolerance.clone(),
            spreads: spreads.clone(),
        }
    }
}

/// Returns the features of a scenario that perfect tracking on a fixed base omits.
pub fn neglected_effects(scenario: &Scenario) -> Vec<&'static str> {
    let PlantDifferences { torque_limits, force, payload, friction, length, link } = &scenario.plant;
    let known = Control { kp: scenario.control.kp, kd: scenario.control.kd, ..Control::default() };
    let always = payload.is_held(0.0, 0.5 * scenario.step) && payload.until.is_none();
    let all = [
        (scenario.base.moves(), "a base that moves"),
        (scenario.base.wheel.is_some(), "a reaction wheel"),
        (payload.is_some() && !always, "a payload that comes or goes"),
        (
            payload.is_some() && always || !length.is_empty() || !link.is_empty(),
            "errors of a control that believes the model",
        ),
        (*friction != Default::default(), "friction"),
        (*force != [0.0; 2], "a force at the end effector"),
        (*torque_limits, "torque limits"),
        (scenario.control != known, "control other than computed torque at all times"),
    ];
    all.into_iter().filter(|(has, _)| *has).map(|(_, what)| what).collect()
}

/// Returns the spectra of the whole run; `None` if it cannot be run, fails an audit or is too short.
fn spectra(run: &Run) -> Option<[Spectrum; 3]> {
    let found = BaseSpectrum::of(run.scenario(), WindowFunction::Hann, || true).ok()?;
    // Spectra of a run that failed an audit are not shown.
    let PerAxis { force_x, force_y, moment } = found.fault.is_none().then_some(found.spectra)?;
    Some([force_x, force_y, moment])
}
