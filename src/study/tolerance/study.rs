//! [`Study`]: everything that there is to say of a run's tolerances, and of its frequencies, as plain data.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Agreement, Bands, CHUNK, Ensemble, Histogram, Outcome, Quantiles, Share, Shares, ToleranceError, Yield};
use crate::query::{Portion, Query, Watch};
use crate::session::Run;
use crate::session::scenario::{Scenario, Spread, Tolerance};
use crate::simulation::control::Control;
use crate::simulation::plant::PlantDifferences;
use crate::study::base_spectrum::{Axes, BaseSpectrum};
use crate::study::spectrum::{Spectrum, Window};

/// Instants at which a motion is looked at.
pub const INSTANTS: usize = 200;

/// Machines, if the scenario does not say how many.
const SAMPLES: u64 = 20_000;

/// The most machines: the peaks of all of them are kept.
const MOST: u64 = 1_000_000;

/// What tolerances do to a run.
#[derive(Clone, Debug)]
pub struct Study {
    /// What varies, and by how much.
    pub tolerance: Tolerance,
    /// The same by key, with what is taken where none is given.
    pub spreads: BTreeMap<String, Spread>,
    /// Machines drawn.
    pub samples: u64,
    /// Numbers that vary in each.
    pub parameters: usize,
    /// n_B and |f_B| over time.
    pub bands: Bands,
    /// Where first order agrees with sampling, and where not.
    pub agreement: Agreement,
    /// Peaks |n_B|, N m: at 5, 50, 95, 99 %.
    pub moment: Quantiles,
    /// Peaks |f_B|, N, at the same levels.
    pub force: Quantiles,
    /// Peaks |n_B|, N m.
    pub moment_histogram: Histogram,
    /// Machines within the limits that are given.
    pub yields: Option<Yield>,
    /// Which tolerance matters, the one that matters most for |n_B| first.
    pub shares: Vec<Share>,
    /// Frequencies of f_Bx, f_By and of what moment the base feels, as run.
    pub spectra: Option<[Spectrum; 3]>,
    /// What this scenario has that perfect tracking on a fixed base does not: only full simulation is exact then.
    pub left_out: Vec<&'static str>,
}

/// The study of a run: a portion draws some hundred machines.
#[derive(Debug)]
pub struct Studying {
    run: Run,
    drawing: Option<Drawing>,
}

/// Machines that are being drawn.
#[derive(Debug)]
struct Drawing {
    tolerance: Tolerance,
    spreads: BTreeMap<String, Spread>,
    ensemble: Ensemble,
    samples: u64,
    outcomes: Vec<Outcome>,
    /// Chunks that are drawn.
    drawn: u64,
}

/// Chunks of a portion: together a few milliseconds.
const PORTION: u64 = 8;

/// A run that is studied: as long as its scenario is the same, so is its study.
#[derive(Clone, Debug)]
pub struct Studied(pub Arc<Run>);

impl PartialEq for Studied {
    fn eq(&self, other: &Self) -> bool {
        self.0.shared_scenario() == other.0.shared_scenario()
    }
}

impl Query for Studying {
    type Input = Studied;
    type Answer = Result<Study, String>;

    fn begin(Studied(run): Studied) -> Self {
        Self { run: Run::clone(&run), drawing: None }
    }

    fn go_on(&mut self, _: Watch<'_>) -> Portion<Self::Answer> {
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
        drawing.draw(PORTION);
        match drawing.share() {
            share if share < 1.0 => Portion::More(share),
            _ => Portion::Done(Ok(Study::of(&self.run, drawing))),
        }
    }
}

impl Drawing {
    /// Of a run's planned motion.
    ///
    /// # Errors
    /// If nothing varies, a key or spread is wrong, or a length cannot vary alone.
    fn of(run: &Run) -> Result<Self, ToleranceError> {
        let scenario = run.scenario();
        let plant = scenario.plant_machine().map_err(ToleranceError::Machine)?;
        let tolerance = scenario.tolerance.clone();
        let (seed, samples) = (tolerance.seed.unwrap_or(1), tolerance.samples.unwrap_or(SAMPLES).clamp(1, MOST));
        let spreads = tolerance.spreads_or_default(&plant);
        let ensemble = Ensemble::new(&plant, &run.plan().motion, INSTANTS, &spreads, seed)?;
        let outcomes = Vec::with_capacity(samples as usize + CHUNK);
        Ok(Self { tolerance, spreads, ensemble, samples, outcomes, drawn: 0 })
    }

    fn chunks(&self) -> u64 {
        self.samples.div_ceil(CHUNK as u64)
    }

    /// How much is drawn, from 0 to 1.
    fn share(&self) -> f64 {
        self.drawn as f64 / self.chunks() as f64
    }

    /// Draws so many chunks more, as far as there are any.
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
    /// Of a run and the machines that were drawn of its tolerances.
    fn of(run: &Run, drawing: &Drawing) -> Self {
        let Drawing { tolerance, spreads, ensemble, outcomes, .. } = drawing;
        let (scenario, samples) = (run.scenario(), drawing.samples);
        let sorted = |value: fn(&Outcome) -> f64| {
            let mut values: Vec<f64> = outcomes.iter().map(value).collect();
            values.sort_unstable_by(f64::total_cmp);
            values
        };
        let (moments, forces) = (sorted(|o| o.peak_moment), sorted(|o| o.peak_force));
        let nothing = || Quantiles { levels: Vec::new(), values: Vec::new() };
        let levels = [0.05, 0.5, 0.95, 0.99];
        let quantiles = |sorted: &[f64]| Quantiles::of_sorted(sorted, &levels).unwrap_or_else(nothing);
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
            left_out: left_out(scenario),
            tolerance: tolerance.clone(),
            spreads: spreads.clone(),
        }
    }
}

/// What a scenario has that perfect tracking on a fixed base leaves out.
pub fn left_out(scenario: &Scenario) -> Vec<&'static str> {
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

/// Of the whole run, at every step; none where it cannot be run, fails an audit or is too short.
fn spectra(run: &Run) -> Option<[Spectrum; 3]> {
    let found = BaseSpectrum::of(run.scenario(), Window::Hann).ok()?;
    // What no audit vouches for is not shown.
    let Axes { force_x, force_y, moment } = found.fault.is_none().then_some(found.spectra)?;
    Some([force_x, force_y, moment])
}
