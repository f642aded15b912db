//! Recordings: scenarios run without a window and written to a Rerun file, with the layout to look at them.
//!
//! One file holds all cases, each under `/<case>/`, on the shared time lines `sim_time` and `step`:
//!
//! | entity | what |
//! |---|---|
//! | `machine/base`, `machine/link/<name>` | meshes that never change; transforms |
//! | `machine/joints` | one mesh, and where each pin is |
//! | `com`, `end_effector`, `target` | where they are; `end_effector/path` is the whole trail |
//! | `plan/path`, `plan/waypoints`, `plan/start` | where the end effector is to go; gone while the pointer leads |
//! | `workspace/<b>` | a reactionless workspace and its boundary; b turns it |
//! | `workspace/<b>/folds`, `…/cusps`, `…/inner_limits`, `…/change_points` | curves inside, where there are any |
//! | `joint_space` | q as coordinates: the plane of b within the limits, the planned path, the pose |
//! | `tower` | all workspaces, b as height: the wall, the present slice, and which b reach the task's points |
//! | `design/machine`, `design/marks` | the machine from above, to scale: links, centres of mass, discs |
//! | `design/state`, `design/links`, `design/balance` | what it comes to, weighs, and leaves of (7) and (8), as tables |
//! | `design/bars`, `design/front` | (7) and (8) as bars; of counterweights, what less inertia costs in mass |
//! | `reaction/force`, `reaction/moment` | what reaches the base, in proportion; the scale stands beside it |
//! | `signals/<topic>` | every row of the table of [`signals`](crate::simulation::signals), at every step, as a series |
//! | `events`, `phase` | what happened |
//! | `view` | offscreen pictures |
//!
//! Each item of the [`Scene`](crate::picture::scene::Scene) that the window opens with is an entity, by its own name; the
//! plots are the window's [`charts`](crate::picture::charts). So a new item of the scene, or a new signal in a chart, is
//! recorded without a change here. What a person first has to switch on in the window is not recorded: snapshots of the
//! arm, and the forces of the pins, of which pictures can show the latter (`pin_forces`). Nor are the marks that invite a
//! person to drag something.
//!
//! Each change of the machine that a session holds is a row of the design, on the time line `edit`, which only such
//! recordings have, and at the step at which it was made.
//!
//! What an item says never changes is written once; what moves has at most 200 rows a second, and a signal has a row at
//! every step. Machine, scenario, version and verdict are properties of the recording. The same scenarios give the same
//! recording, whenever and wherever it is made.

mod blueprint;
mod dashes;
mod design;
mod entity;
mod events;
mod eye;
mod hash;
mod options;
mod pictures;
mod preview;
mod recorder;
mod rows;
mod space;
mod stop;
mod store;
mod style;
mod topic;

pub use options::{Options, Pictures};

use std::path::{Path, PathBuf};

use rerun::{EntityPath, RecordingInfo, TextDocument};
use thiserror::Error;

use crate::files::{NewFile, WriteError};
use crate::session::Refusal;
use crate::session::scenario::Scenario;
use crate::session::verdict::{Statements, Verdict};
use hash::Hash;
use pictures::Series;
use preview::Preview;
use recorder::Set;
use stop::Stop;
use store::{Store, StoreError};

/// A scenario that was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Its name.
    pub scenario: String,
    /// Where it is.
    pub file: PathBuf,
    /// Steps done; there is one more frame.
    pub steps: u64,
    /// Largest |τ_k|, N m.
    pub peak_torque: Vec<f64>,
    /// Largest dynamic |f_B|, N.
    pub peak_base_force: f64,
    /// Largest |n_B|, what the arm transmits, N m.
    pub peak_base_moment: f64,
    /// Whether the arm transmitted nothing.
    pub reactionless: bool,
    /// What is to be said of it.
    pub verdict: Verdict,
    /// What can be said of machine, plan and run.
    pub statements: Statements,
    /// What somebody should know: why there are no pictures.
    pub notes: Vec<String>,
}

/// How far the recording has got.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress<'a> {
    /// Steps done, of all scenarios. Each counts twice: it is run for the scales, and recorded.
    pub done: u64,
    /// Steps to do.
    pub of: u64,
    /// The scenario at hand.
    pub what: &'a str,
}

/// Why nothing was recorded. No file is left then, and none was touched.
#[derive(Debug, Error)]
pub enum RecordError {
    /// Nothing to record.
    #[error("no scenario: want at least one")]
    Nothing,
    /// Cases of one recording go by their names.
    #[error("two scenarios are called {0:?}: want different names in one recording")]
    SameName(String),
    /// A scenario cannot start, or one of its edits cannot apply.
    #[error("{scenario}: {refusal}")]
    Refused {
        /// Which.
        scenario: String,
        /// Why.
        refusal: Refusal,
    },
    /// The pictures asked for cannot be.
    #[error("pictures: {0}")]
    Pictures(String),
    /// The file.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Whoever asked for it wants it no more.
    #[error("the recording was stopped before its end: no file is left")]
    Stopped,
    /// Rerun refuses the data.
    #[error("{}: {why}", file.display())]
    Data {
        /// The file.
        file: PathBuf,
        /// What it says.
        why: String,
    },
}

/// Runs scenarios and records all of them in one file, which appears when it is complete. `progress` hears how far it is
/// and says whether the rest is still wanted.
///
/// # Errors
/// If a scenario cannot run, or the file exists and is not to be replaced, or cannot be written, or is not wanted any
/// more; no file is left then.
pub fn record(
    scenarios: &[Scenario],
    file: &Path,
    options: &Options,
    progress: &mut dyn FnMut(Progress) -> bool,
) -> Result<Vec<Recording>, RecordError> {
    check(scenarios, options)?;
    let to = NewFile::create(file, options.force)?;
    write(scenarios, to, file, options, progress)
}

fn check(scenarios: &[Scenario], options: &Options) -> Result<(), RecordError> {
    if scenarios.is_empty() {
        return Err(RecordError::Nothing);
    }
    for (i, scenario) in scenarios.iter().enumerate() {
        if scenarios[..i].iter().any(|s| s.name == scenario.name) {
            return Err(RecordError::SameName(scenario.name.clone()));
        }
    }
    match options.pictures {
        Some(p) if !(p.fps > 0.0 && p.fps.is_finite()) => {
            Err(RecordError::Pictures(format!("{} a second: want a number above 0", p.fps)))
        }
        Some(p) if p.width == 0 || p.height == 0 => {
            Err(RecordError::Pictures(format!("{} x {} pixels: want at least 1 x 1", p.width, p.height)))
        }
        _ => Ok(()),
    }
}

/// The most pictures of a recording, and the most pixels of all of them.
const MOST_PICTURES: f64 = 1e5;
const MOST_PIXELS: f64 = 1.5e11;

/// Refuses more pictures than anybody would wait for.
fn check_pictures(scenarios: &[Scenario], cases: &[Preview], options: &Options) -> Result<(), RecordError> {
    let Some(p) = options.pictures else { return Ok(()) };
    let of_case = |(scenario, case): (&Scenario, &Preview)| {
        let steps = case.steps as f64;
        steps.min(steps * scenario.step * p.fps) + 1.0
    };
    let count: f64 = scenarios.iter().zip(cases).map(of_case).sum();
    let most = MOST_PICTURES.min(MOST_PIXELS / (f64::from(p.width) * f64::from(p.height))).floor();
    match count <= most {
        true => Ok(()),
        false => Err(RecordError::Pictures(format!(
            "{count:.0} of {} x {} pixels: want at most {most:.0}, fewer a second, smaller, or of a shorter run",
            p.width, p.height
        ))),
    }
}

fn stopped_or(scenario: String, refusal: Refusal) -> RecordError {
    match refusal {
        Refusal::Stopped => RecordError::Stopped,
        refusal => RecordError::Refused { scenario, refusal },
    }
}

/// About how many steps a run has.
fn steps(scenario: &Scenario) -> u64 {
    (scenario.duration.unwrap_or(scenario.task.time) / scenario.step).round() as u64
}

/// What tells this recording from others: everything that goes into it.
fn digest(scenarios: &[Scenario], options: &Options) -> u128 {
    let mut hash = Hash::default();
    hash.add(env!("CARGO_PKG_VERSION"));
    for scenario in scenarios {
        hash.add(&scenario.to_toml());
        hash.add(&crate::mechanics::machine::to_toml(&scenario.machine));
    }
    if let Some(p) = options.pictures {
        hash.add(&format!("{} {} {} {}", p.fps, p.width, p.height, p.pin_forces));
    }
    hash.number()
}

fn write(
    scenarios: &[Scenario],
    to: NewFile,
    file: &Path,
    options: &Options,
    progress: &mut dyn FnMut(Progress) -> bool,
) -> Result<Vec<Recording>, RecordError> {
    let because = |error| match error {
        StoreError::Write(source) => WriteError::Failed { file: file.into(), source }.into(),
        StoreError::Data(why) => RecordError::Data { file: file.into(), why },
    };
    let total: u64 = scenarios.iter().map(steps).sum();
    let mut before = 0;
    let mut cases = Vec::with_capacity(scenarios.len());
    for scenario in scenarios {
        let mut tick = |step| progress(Progress { done: before + step, of: 2 * total, what: &scenario.name });
        let refused = |refusal| stopped_or(scenario.name.clone(), refusal);
        cases.push(Preview::of(scenario, &mut tick).map_err(refused)?);
        before += steps(scenario);
    }
    // Now it is known.
    let total: u64 = cases.iter().map(|case| case.steps).sum();
    before = total;
    check_pictures(scenarios, &cases, options)?;
    let mut store = Store::open(to, digest(scenarios, options)).map_err(because)?;
    let mut pictures = Series::of(options.pictures);
    let pictured = pictures.is_wanted();
    let scale = preview::scale(&cases);
    let mut set = Set { store: &mut store, pictures: &mut pictures, scale, several: scenarios.len() > 1 };
    let mut recordings = Vec::with_capacity(scenarios.len());
    // The layout stands first, so that no viewer begins with one of its own.
    let laid_out = blueprint::lay_out(set.store, &cases, pictured).map_err(Stop::from);
    let done = laid_out.and_then(|()| {
        if preview::have_designs(&cases) {
            let designs: Vec<_> =
                cases.iter().map(|c| (c.name.as_str(), c.candidate.beside(&cases[0].candidate))).collect();
            let table = TextDocument::from_markdown(design::beside(&designs));
            set.store.fixed(&EntityPath::from(preview::DESIGNS), &table)?;
        }
        let names: Vec<_> = scenarios.iter().map(|s| s.name.as_str()).collect();
        let info = RecordingInfo::update_fields().with_name(names.join(", "));
        set.store.fixed(&EntityPath::properties(), &info)?;
        for (scenario, case) in scenarios.iter().zip(&cases) {
            let mut tick = |step| progress(Progress { done: before + step, of: 2 * total, what: &scenario.name });
            let (peaks, verdict, statements) = recorder::record(&mut set, scenario, case, &mut tick)?;
            before += case.steps;
            recordings.push(Recording {
                scenario: scenario.name.clone(),
                file: file.into(),
                steps: case.steps,
                peak_torque: peaks.torque.to_vec(),
                peak_base_force: peaks.force,
                peak_base_moment: verdict.arm_moment,
                reactionless: verdict.reactionless,
                verdict,
                statements,
                notes: set.pictures.notes(),
            });
        }
        Ok(())
    });
    match done {
        Ok(()) => {
            store.close().map_err(because)?.finish()?;
            Ok(recordings)
        }
        Err(stop) => {
            store.abandon();
            Err(match stop {
                Stop::Refused { scenario, refusal } => stopped_or(scenario, refusal),
                Stop::Pictures(why) => RecordError::Pictures(why),
                Stop::Store(error) => because(error),
            })
        }
    }
}
