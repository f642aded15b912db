//! Recordings: runs of scenarios without a window, written to a Rerun file with a layout for the viewer.
//!
//! Others reach this crate as `stillbase::recording`; `stillbase` alone follows semantic versioning.
//!
//! One file holds all cases, each under `/<case>/`, on the common time lines `sim_time` and `step`:
//!
//! | entity | contents |
//! |---|---|
//! | `machine/base`, `machine/link/<name>` | constant meshes; transforms |
//! | `machine/joints` | one mesh, and the position of each pin |
//! | `com`, `end_effector`, `target` | positions; `end_effector/path` is the whole trail |
//! | `plan/path`, `plan/waypoints`, `plan/start` | the planned path; absent while the target is dragged |
//! | `workspace/<b>` | a reactionless workspace and its boundary; b rotates it |
//! | `workspace/<b>/folds`, `…/cusps`, `…/inner_limits`, `…/change_points` | curves inside, if any |
//! | `joint_space` | q as coordinates: the plane of b within the joint limits, the planned path, the pose |
//! | `tower` | all workspaces, b as height: the wall, the present section, and the b that reach the task's points |
//! | `design/machine`, `design/marks` | the machine from above, to scale: links, centres of mass, discs |
//! | `design/state`, `design/links`, `design/balance` | tables of measures, masses, and the residuals of (7) and (8) |
//! | `design/bars`, `design/front` | bar charts of (7) and (8); Pareto front of added mass and inertia |
//! | `reaction/force`, `reaction/moment` | the reaction on the base, with a label of the scale |
//! | `signals/<topic>` | every row of the table of [`signals`](stillbase_simulation::signals) as a series |
//! | `signals/<topic>/limits` | limits of torques and rates near enough to be drawn, at plus and minus, as series |
//! | `events` | events of the run |
//! | `phase`, `refusals` | lanes: the phase of the run, and what the machine is kept from |
//! | `notes` | verdict, notes and bookmarks, and the equations with their numbers, as Markdown |
//! | `view` | offscreen pictures |
//!
//! Of an assembly each block is an entity with a place in space, and its own scene below it; `trail/<block>` is the path of its
//! end effector, and `signals/<group>/<block>` are signals of its drives.
//!
//! Each item of the [`Scene`](stillbase_picture::scene::Scene) that the window opens with is an entity with the name of
//! the item. The plots are the [`charts`](stillbase_picture::charts) of the window. So a new item of the scene, or a
//! new signal in a chart, is recorded without a change here. Options that are off by default in the window are not
//! recorded: snapshots of the arm, and pin forces. Pictures show pin forces with the option `pin_forces`. Hints at what
//! can be dragged are not recorded either.
//!
//! Each change of the machine in a session is a row of the design, at the step at which it was made. Such recordings
//! have a further time line, `edit`.
//!
//! Constant parts of an item are written once. Moving parts have rows at a fixed rate, at least 50 a second and 100 in
//! all; signals, at least 100 a second and 500 in all, or at every step if the options say so. Each row holds the exact
//! numbers of its step. The components `paths` and `units` of an entity of signals name its series. Machine, scenario,
//! version and verdict are properties of the recording. Equal scenarios give equal recordings, independent of the time
//! and the computer.

mod blocks;
mod blueprint;
mod dashes;
mod design;
mod entity;
mod events;
mod eye;
mod hash;
mod markdown;
mod notes;
mod options;
mod pictures;
mod preview;
mod recorder;
mod rerun;
mod rows;
mod space;
mod stop;
mod store;
mod style;
mod ticks;
mod topic;
#[cfg(feature = "stream")]
mod viewer;

pub use options::{Options, Pictures};
#[cfg(feature = "stream")]
pub use viewer::{VIEWER_URL, Viewer, ViewerError};

use std::path::{Path, PathBuf};

use crate::rerun::{EntityPath, RecordingInfo, TextDocument};
use thiserror::Error;

use hash::Hash;
use pictures::PictureSeries;
use preview::Preview;
use recorder::RecordingSetup;
use stillbase_files::{NewFile, WriteError};
use stillbase_session::Refusal;
use stillbase_session::scenario::Scenario;
use stillbase_session::verdict::{Statements, Verdict};
use stop::CaseError;
use store::{Sink, Store, StoreError};

/// A scenario that was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Name of the scenario.
    pub scenario: String,
    /// Path of the file; `None` if it was streamed to a viewer.
    pub file: Option<PathBuf>,
    /// Number of steps; there is one frame more.
    pub steps: u64,
    /// Largest |τ_k|, N m.
    pub peak_torque: Vec<f64>,
    /// Largest dynamic |f_B|, N.
    pub peak_base_force: f64,
    /// Largest |n_B| transmitted by the arm, N m.
    pub peak_base_moment: f64,
    /// Whether the arm transmitted no reaction.
    pub reactionless: bool,
    /// Verdict on the run.
    pub verdict: Verdict,
    /// Statements about machine, plan and run.
    pub statements: Statements,
    /// Notes for the user, such as the reason why there are no pictures.
    pub notes: Vec<String>,
}

/// Progress of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordingProgress<'a> {
    /// Completed steps of all scenarios. Each step counts twice, because each scenario is run for the scales first.
    pub done: u64,
    /// Total number of steps.
    pub total: u64,
    /// Name of the current scenario.
    pub what: &'a str,
}

/// Reasons why nothing was recorded. No file is created or changed in that case.
#[derive(Debug, Error)]
pub enum RecordError {
    /// There is no scenario.
    #[error("no scenario: want at least one")]
    Nothing,
    /// Two scenarios of one recording have the same name.
    #[error("two scenarios are called {0:?}: want different names in one recording")]
    SameName(String),
    /// A scenario cannot start, one of its edits cannot apply, or its state diverges.
    #[error("{scenario}: {refusal}")]
    Refused {
        /// Name of the scenario.
        scenario: String,
        /// Reason.
        #[source]
        refusal: Refusal,
    },
    /// The requested pictures cannot be made.
    #[error("pictures: {0}")]
    Pictures(String),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The viewer cannot be reached.
    #[cfg(feature = "stream")]
    #[error(transparent)]
    Viewer(#[from] ViewerError),
    /// The caller stopped the recording.
    #[error("the recording was stopped before its end: no file is left")]
    Stopped,
    /// Rerun refuses the data.
    #[error("{}: {why}", file.display())]
    Data {
        /// Path of the file.
        file: PathBuf,
        /// Message of Rerun.
        why: String,
    },
}

/// Runs scenarios and records all of them in one file, which appears when it is complete. `progress` is called with the
/// progress and returns whether to continue.
///
/// # Errors
/// Any [`RecordError`], for example if a scenario cannot run, the file exists already, or `progress` returns false.
/// No file is created or changed in these cases.
pub fn record(
    scenarios: &[Scenario],
    file: &Path,
    options: &Options,
    progress: &mut dyn FnMut(RecordingProgress) -> bool,
) -> Result<Vec<Recording>, RecordError> {
    check(scenarios, options)?;
    let to = NewFile::create(file, options.force)?;
    write(scenarios, Sink::File(to), Some(file), options, progress)
}

/// Runs scenarios and streams all of them to a viewer, as [`record`] writes them to a file.
///
/// # Errors
/// Any [`RecordError`]. What the viewer has by then, it keeps.
#[cfg(feature = "stream")]
pub fn stream(
    scenarios: &[Scenario],
    viewer: &Viewer,
    options: &Options,
    progress: &mut dyn FnMut(RecordingProgress) -> bool,
) -> Result<Vec<Recording>, RecordError> {
    check(scenarios, options)?;
    write(scenarios, Sink::Viewer(viewer.clone()), None, options, progress)
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

/// Maximum number of pictures of a recording.
const MAX_PICTURES: f64 = 1e5;
/// Maximum number of pixels of all pictures of a recording.
const MAX_PIXELS: f64 = 1.5e11;

/// Checks the number and size of the pictures.
fn check_pictures(scenarios: &[Scenario], cases: &[Preview], options: &Options) -> Result<(), RecordError> {
    let Some(p) = options.pictures else { return Ok(()) };
    let of_case = |(scenario, case): (&Scenario, &Preview)| {
        let steps = case.steps as f64;
        steps.min(steps * scenario.step * p.fps) + 1.0
    };
    let count: f64 = scenarios.iter().zip(cases).map(of_case).sum();
    let most = MAX_PICTURES.min(MAX_PIXELS / (f64::from(p.width) * f64::from(p.height))).floor();
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

/// Estimates the number of steps of a run.
fn steps(scenario: &Scenario) -> u64 {
    (scenario.duration.unwrap_or(scenario.task.time) / scenario.step).round() as u64
}

/// Returns the hash of all inputs of a recording.
fn digest(scenarios: &[Scenario], options: &Options) -> u128 {
    let mut hash = Hash::default();
    hash.add(env!("CARGO_PKG_VERSION"));
    for scenario in scenarios {
        hash.add(&scenario.to_toml());
        hash.add(&stillbase_mechanics::machine::to_toml(&scenario.machine));
    }
    if options.every_step {
        hash.add("every step");
    }
    if let Some(p) = options.pictures {
        hash.add(&format!("{} {} {} {}", p.fps, p.width, p.height, p.pin_forces));
    }
    hash.number()
}

fn write(
    scenarios: &[Scenario],
    to: Sink,
    file: Option<&Path>,
    options: &Options,
    progress: &mut dyn FnMut(RecordingProgress) -> bool,
) -> Result<Vec<Recording>, RecordError> {
    let name = match &to {
        Sink::File(_) => file.map(PathBuf::from).unwrap_or_default(),
        #[cfg(feature = "stream")]
        Sink::Viewer(viewer) => viewer.url().into(),
    };
    let because = |error| match error {
        StoreError::Write(source) => WriteError::Failed { file: name.clone(), source }.into(),
        #[cfg(feature = "stream")]
        StoreError::Viewer(why) => RecordError::Viewer(why),
        StoreError::Data(why) => RecordError::Data { file: name.clone(), why },
    };
    let total: u64 = scenarios.iter().map(steps).sum();
    let mut before = 0;
    let mut cases = Vec::with_capacity(scenarios.len());
    for scenario in scenarios {
        let mut tick =
            |step| progress(RecordingProgress { done: before + step, total: 2 * total, what: &scenario.name });
        let refused = |refusal| stopped_or(scenario.name.clone(), refusal);
        cases.push(Preview::of(scenario, &mut tick).map_err(refused)?);
        before += steps(scenario);
    }
    // From here on the exact number of steps is known.
    let total: u64 = cases.iter().map(|case| case.steps).sum();
    before = total;
    check_pictures(scenarios, &cases, options)?;
    let mut store = Store::open(to, digest(scenarios, options)).map_err(because)?;
    let mut pictures = PictureSeries::of(options.pictures);
    let pictured = pictures.is_wanted();
    let scale = preview::scale(&cases);
    let mut set = RecordingSetup {
        store: &mut store,
        pictures: &mut pictures,
        scale,
        every_step: options.every_step,
        several: scenarios.len() > 1,
    };
    let mut recordings = Vec::with_capacity(scenarios.len());
    // The layout comes first, so that the viewer does not create a default one.
    let laid_out = blueprint::lay_out(set.store, &cases, pictured).map_err(CaseError::from);
    let done = laid_out.and_then(|()| {
        if preview::machines_differ(&cases) {
            let designs: Vec<_> =
                cases.iter().map(|c| (c.name.as_str(), c.candidate.compared_with(&cases[0].candidate))).collect();
            let table = TextDocument::from_markdown(design::comparison_table(&designs));
            set.store.fixed(&EntityPath::from(preview::DESIGNS_PATH), &table)?;
        }
        let names: Vec<_> = scenarios.iter().map(|s| s.name.as_str()).collect();
        let info = RecordingInfo::update_fields().with_name(names.join(", "));
        set.store.fixed(&EntityPath::properties(), &info)?;
        for (scenario, case) in scenarios.iter().zip(&cases) {
            let mut tick =
                |step| progress(RecordingProgress { done: before + step, total: 2 * total, what: &scenario.name });
            let (peaks, verdict, statements) = recorder::record(&mut set, scenario, case, &mut tick)?;
            before += case.steps;
            recordings.push(Recording {
                scenario: scenario.name.clone(),
                file: file.map(PathBuf::from),
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
            if let Some(written) = store.close().map_err(because)? {
                written.finish()?;
            }
            Ok(recordings)
        }
        Err(stop) => {
            drop(store);
            Err(match stop {
                CaseError::Refused { scenario, refusal } => stopped_or(scenario, refusal),
                CaseError::Pictures(why) => RecordError::Pictures(why),
                CaseError::Store(error) => because(error),
            })
        }
    }
}
