//! Records a scenario of an assembly: each block is a space of its own, as that of a machine by itself, whose entity turns
//! and shifts it to where the block is.

use std::path::Path;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use thiserror::Error;

use crate::rerun::components::{Scalar, Text};
use crate::rerun::{
    AnyValues, EntityPath, EntityPathPart, Quaternion, RecordingInfo, Scalars, SeriesLines, TextDocument, Transform3D,
    ViewCoordinates,
};

use super::blueprint::{self, AssemblyLayout, AssemblyPlot};
use super::eye::Eye;
use super::hash::Hash;
use super::rows::{SparseRows, Thinned};
use super::space::RecordingSpace;
use super::store::{Instant, RowTimes, Sink, Store, StoreError};
use super::style::{CombinedArchetypes, colour, lines, under};
use stillbase_files::recorded::{PATHS, UNITS};
use stillbase_files::{NewFile, WriteError};
use stillbase_picture::scene::camera::Orbit;
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::{Palette, Theme, mix, palette};
use stillbase_picture::scene::stage::Stage;
use stillbase_session::assembly::{
    AssemblyBase, AssemblyFrame, AssemblyRun, AssemblySignal, AssemblyVerdict, assembly_signals,
};
use stillbase_session::{Refusal, replay_while};
use stillbase_study::assembly_check::AssemblyReport;

/// Longest interval between rows of what moves, and of signals, s.
const MOVING_S: f64 = 0.04;
const SIGNALS_S: f64 = 0.01;

/// Part of the reach of a machine around its base that the eye sees.
const SEEN_REACH: f64 = 0.5;

/// Maximum number of points of a trail.
const MAX_TRAIL_POINTS: usize = 16_384;

/// Why an assembly was not recorded. No file is created or changed in that case.
#[derive(Debug, Error)]
pub enum AssemblyRecordError {
    /// The task of a block cannot be drawn.
    #[error("block {block}: {refusal}")]
    Refused {
        /// Name of the block.
        block: String,
        /// Reason.
        #[source]
        refusal: Refusal,
    },
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The caller stopped the recording.
    #[error("the recording was stopped before its end: no file is left")]
    Stopped,
    /// Rerun refuses the data.
    #[error("{file}: {why}")]
    Data {
        /// The file.
        file: String,
        /// Message of Rerun.
        why: String,
    },
}

/// Signals that share an entity and a plot, with their values.
struct Group {
    /// Path under `signals`, such as `torque/wrist`.
    name: String,
    signals: Vec<usize>,
    values: Vec<f64>,
    range: [f64; 2],
}

/// Returns the signals by entity: all of a path up to the name of a drive or an axis.
fn groups(signals: &[AssemblySignal]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (i, signal) in signals.iter().enumerate() {
        let name = signal.path.rsplit_once(['.', '_']).or_else(|| signal.path.rsplit_once('/'));
        let name = name.map_or(signal.path.as_str(), |(name, _)| name);
        match groups.iter_mut().find(|group| group.name == name) {
            Some(group) => group.signals.push(i),
            None => groups.push(Group {
                name: name.into(),
                signals: vec![i],
                values: Vec::new(),
                range: [f64::INFINITY, f64::NEG_INFINITY],
            }),
        }
    }
    groups
}

/// Runs a scenario of an assembly and records it in a file, which appears when it is complete, with what its check and
/// the run say beside the scene. `goes_on` says whether to continue.
///
/// # Errors
/// If a block cannot be drawn, the file exists already or cannot be written, or `goes_on` returns false.
pub fn record_assembly(
    run: &AssemblyRun,
    (file, force): (&Path, bool),
    goes_on: &dyn Fn() -> bool,
) -> Result<AssemblyVerdict, AssemblyRecordError> {
    let to = NewFile::create(file, force)?;
    let because = |error: StoreError| match error {
        StoreError::Write(source) => WriteError::Failed { file: file.into(), source }.into(),
        other => AssemblyRecordError::Data { file: file.display().to_string(), why: other.to_string() },
    };
    let scenario = run.scenario();
    let mut hash = Hash::default();
    for word in [env!("CARGO_PKG_VERSION"), &scenario.name, &format!("{:?} {}", scenario.base, scenario.step)] {
        hash.add(word);
    }
    for (block, task) in scenario.assembly.blocks().iter().zip(&scenario.tasks) {
        hash.add(&stillbase_mechanics::machine::to_toml(&block.machine));
        hash.add(&format!("{} {:?}", block.name, block.mount));
        hash.add(&task.scenario.to_toml());
    }
    let root = EntityPath::new(vec![EntityPathPart::new(scenario.name.as_str())]);
    let mut recorder = AssemblyRecorder::of(run, root);
    let verdict = recorder.see_all(goes_on).ok_or(AssemblyRecordError::Stopped)?;
    let mut store = Store::open(Sink::File(to), hash.number()).map_err(because)?;
    recorder.write_head(&mut store).map_err(because)?;
    recorder.write_blocks(&mut store, goes_on, &because)?;
    recorder.write_signals(&mut store).map_err(because)?;
    let run = verdict.sentence(scenario.base == AssemblyBase::Fixed);
    let note = AssemblyReport::of(&scenario.assembly).markdown(&scenario.title, &run);
    recorder.write_notes(&mut store, &note).map_err(because)?;
    if let Some(written) = store.close().map_err(because)? {
        written.finish()?;
    }
    Ok(verdict)
}

/// Where a block is: a rotation and the place of its mount, in space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    turn: [f32; 4],
    at: [f32; 3],
}

struct AssemblyRecorder<'a> {
    run: &'a AssemblyRun,
    root: EntityPath,
    palette: Palette,
    signals: Vec<AssemblySignal>,
    groups: Vec<Group>,
    clock: RowTimes,
    /// Rows of the places of each block.
    places: Vec<SparseRows<Placed>>,
    trails: Vec<Thinned<[f32; 3]>>,
    /// Points by which the eye is placed, m.
    extent: Vec<[f64; 3]>,
}

impl<'a> AssemblyRecorder<'a> {
    fn of(run: &'a AssemblyRun, root: EntityPath) -> Self {
        let signals = assembly_signals(run);
        let count = run.scenario().assembly.blocks().len();
        Self {
            run,
            root,
            palette: palette(Theme::Dark),
            groups: groups(&signals),
            signals,
            clock: RowTimes::default(),
            places: (0..count).map(|_| SparseRows::new()).collect(),
            trails: (0..count).map(|_| Thinned::new(1, MAX_TRAIL_POINTS)).collect(),
            extent: Vec::new(),
        }
    }

    fn every(&self, longest: f64) -> u64 {
        (longest / self.run.scenario().step).round().max(1.0) as u64
    }

    /// Runs the scenario, and keeps what moves and the signals; `None` if it was stopped.
    fn see_all(&mut self, goes_on: &dyn Fn() -> bool) -> Option<AssemblyVerdict> {
        let last = self.run.steps().unwrap_or_default();
        let (moving, sampled) = (self.every(MOVING_S), self.every(SIGNALS_S));
        let verdict = self.run.run(|frame| {
            if frame.step.is_multiple_of(moving) || frame.step == last {
                self.place(frame, frame.step == last);
            }
            if frame.step.is_multiple_of(sampled) || frame.step == last {
                self.clock.push(Instant::at(frame.step, frame.time));
                for group in &mut self.groups {
                    for i in &group.signals {
                        let x = self.signals[*i].value(frame);
                        group.values.push(x);
                        group.range = [group.range[0].min(x), group.range[1].max(x)];
                    }
                }
            }
            goes_on()
        });
        goes_on().then_some(verdict)
    }

    fn place(&mut self, frame: &AssemblyFrame, is_last: bool) {
        let at = Instant::at(frame.step, frame.time);
        let assembly = &self.run.scenario().assembly;
        for (i, block) in assembly.blocks().iter().enumerate() {
            let below = block.mount.on.map_or_else(Vector3::zeros, |carrier| frame.tips[carrier]);
            let mount = frame.in_space(&(below + block.mount.at));
            let turn: Matrix3<f64> = frame.attitude.0.to_rotation_matrix().into_inner() * block.mount.axes;
            let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
            let quaternion = [q.i, q.j, q.k, q.w].map(|x| x as f32);
            self.places[i].push(at, Placed { turn: quaternion, at: mount.map(|x| x as f32).into() });
            let tip = frame.in_space(&frame.tips[i]);
            self.trails[i].push(|| tip.map(|x| x as f32).into(), is_last);
            self.extent.push(tip.into());
            // An arm reaches about as far to every side.
            let reach = SEEN_REACH * block.machine.reach();
            for [x, y] in [[reach, 0.0], [-reach, 0.0], [0.0, reach], [0.0, -reach]] {
                self.extent.push((mount + turn * Vector3::new(x, y, 0.0)).into());
            }
        }
    }

    fn eye(&self) -> Eye {
        let orbit = Orbit { centre: [0.0; 3], distance: 3.0, yaw: 0.5, pitch: 0.55 };
        Eye::upright(orbit).filled(&self.extent, 1.3)
    }

    fn write_head(&self, store: &mut Store) -> Result<(), StoreError> {
        let scenario = self.run.scenario();
        let title = if scenario.title.is_empty() { &scenario.name } else { &scenario.title };
        let plot = |group: &Group| {
            let (word, of) = group.name.split_once('/').unwrap_or((&group.name, ""));
            let title = match (word, of) {
                ("torque", of) => format!("Torques of {of}  N m"),
                ("pose", of) => format!("Pose constant b of {of}  rad"),
                ("force", "dynamic") => "Force on the base, from motion: x, y, z  N".into(),
                ("moment", "dynamic") => "Moment on the base, from motion: x, y, z  N m".into(),
                ("attitude", _) => "Attitude of the base: quaternion w, x, y, z".into(),
                ("base", _) => "Place of the base: x, y, z  m".into(),
                _ => return None,
            };
            Some(AssemblyPlot {
                title,
                path: under(&self.root, &format!("signals/{}", group.name)),
                range: group.range,
            })
        };
        let mut shown: Vec<&Group> = self.groups.iter().collect();
        // What the base feels comes first.
        shown.sort_by_key(|group| !["force", "moment", "attitude", "base"].iter().any(|of| group.name.starts_with(of)));
        let plots = shown.into_iter().filter_map(plot).collect();
        blueprint::lay_out_assembly(
            store,
            &AssemblyLayout { title: title.clone(), root: self.root.clone(), eye: self.eye(), plots },
        )?;
        let info = RecordingInfo::update_fields().with_name(scenario.name.as_str());
        store.fixed(&EntityPath::properties(), &info)?;
        store.fixed(&self.root, &ViewCoordinates::RIGHT_HAND_Z_UP())
    }

    /// Writes the blocks: where they are, and each in its own plane as its task leads it.
    fn write_blocks(
        &mut self,
        store: &mut Store,
        goes_on: &dyn Fn() -> bool,
        because: &dyn Fn(StoreError) -> AssemblyRecordError,
    ) -> Result<(), AssemblyRecordError> {
        let (scenario, eye) = (self.run.scenario(), self.eye());
        for (i, task) in scenario.tasks.iter().enumerate() {
            let name = &scenario.assembly.blocks()[i].name;
            let path = under(&self.root, name);
            let (clock, rows) = self.places[i].take();
            let rows = Transform3D::update_fields()
                .with_many_translation(rows.iter().map(|row| row.at).collect::<Vec<_>>())
                .with_many_quaternion(rows.iter().map(|row| Quaternion::from_xyzw(row.turn)).collect::<Vec<_>>());
            let columns = rows.columns_of_unit_batches().map_err(|why| because(why.into()))?;
            store.columns(&clock.columns(), &path, columns).map_err(because)?;
            let trail = lines([self.trails[i].take()], 1.8, mix(self.palette.ink, self.palette.dim, 0.5));
            store.fixed(&under(&self.root, &format!("trail/{name}")), &trail).map_err(because)?;
            let task = &task.scenario;
            let mut space = RecordingSpace::new(path, eye, self.palette.background);
            let options = ViewOptions { show_hints: false, ..ViewOptions::default() };
            let (mut stage, mut failed) = (None::<Stage>, Ok(()));
            let every = (MOVING_S / task.step).round().max(1.0) as u64;
            let end = (self.run.duration() / task.step).round() as u64;
            let played = replay_while(task, |run, frame| {
                if frame.step.is_multiple_of(every) {
                    let stage = stage.get_or_insert_with(|| Stage::of(run));
                    let at = Instant::at(frame.step, frame.time);
                    let mut scene = stage.scene(frame, &options);
                    // Labels and grids of several planes would cover each other.
                    scene.labels.clear();
                    scene.lines.retain(|line| !line.name.starts_with("grid"));
                    failed = space.draw(store, (at, None), &scene);
                }
                failed.is_ok() && frame.step < end && goes_on()
            });
            failed.map_err(because)?;
            match played {
                Ok(_) => {}
                Err(Refusal::Stopped) if goes_on() => {}
                Err(Refusal::Stopped) => return Err(AssemblyRecordError::Stopped),
                Err(refusal) => return Err(AssemblyRecordError::Refused { block: name.clone(), refusal }),
            }
            space.write(store).map_err(because)?;
        }
        Ok(())
    }

    fn write_signals(&mut self, store: &mut Store) -> Result<(), StoreError> {
        let clock = self.clock.columns();
        for group in &mut self.groups {
            let path = under(&self.root, &format!("signals/{}", group.name));
            let own = || group.signals.iter().map(|i| &self.signals[*i]);
            let words =
                |of: fn(&AssemblySignal) -> &str| own().map(|signal| Text::from(of(signal))).collect::<Vec<_>>();
            let names = AnyValues::default()
                .with_component::<Text>(PATHS, words(|signal| &signal.path))
                .with_component::<Text>(UNITS, words(|signal| signal.unit));
            let last =
                |signal: &AssemblySignal| signal.path.rsplit(['.', '_', '/']).next().unwrap_or_default().to_owned();
            let style = SeriesLines::new()
                .with_names(own().map(|signal| format!("{} {}", last(signal), signal.unit)))
                .with_colors((0..group.signals.len()).map(|k| colour(self.palette.drive(k))))
                .with_widths(own().map(|_| 1.6_f32));
            store.fixed(&path, &CombinedArchetypes(&[&names, &style]))?;
            let rows = Scalars::new(std::mem::take(&mut group.values));
            let rows = rows.columns(std::iter::repeat_n(group.signals.len(), self.clock.len()))?;
            store.columns(&clock, &path, rows)?;
        }
        Ok(())
    }

    fn write_notes(&self, store: &mut Store, note: &str) -> Result<(), StoreError> {
        let scenario = self.run.scenario();
        store.fixed(&under(&self.root, "notes"), &TextDocument::from_markdown(note))?;
        let path = EntityPath::properties() / EntityPathPart::new(scenario.name.as_str());
        let words = |text: &str| [Text::from(text)];
        let properties = AnyValues::default()
            .with_component::<Text>("title", words(&scenario.title))
            .with_component::<Text>("version", words(env!("CARGO_PKG_VERSION")))
            .with_component::<Scalar>("mass", [Scalar::from(scenario.assembly.mass())]);
        store.fixed(&path, &properties)
    }
}
