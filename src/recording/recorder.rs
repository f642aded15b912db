//! Records one case: writes the frames of a run as entities.

use std::sync::Arc;

use crate::rerun::EntityPathPart;
use crate::rerun::components::{Scalar, Text};
use crate::rerun::{AnyValues, EntityPath, TextDocument, ViewCoordinates};

use super::blocks::RecordedBlocks;
use super::events::{Events, RecordedRun};
use super::eye::Eye;
use super::notes;
use super::pictures::PictureSeries;
use super::preview::Preview;
use super::rows::Thinned;
use super::space::RecordingSpace;
use super::stop::CaseError;
use super::store::{Instant, RowTimes, Store};
use super::style::{lines, under};
use super::topic::Topic;
use stillbase_mechanics::planar::MAX_DRIVES;
use stillbase_picture::scene::camera::Camera;
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::{Palette, Theme, mix, palette};
use stillbase_picture::scene::reaction::Scale;
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_picture::scene::{Scene, point};
use stillbase_session::scenario::Scenario;
use stillbase_session::verdict::{Statements, Verdict};
use stillbase_session::{Edit, Plan, Run, WholeFrame, replay_while};
use stillbase_simulation::frame::{Frame, Peaks};

/// Number of buffered rows above which they are written.
const MAX_BUFFERED_ROWS: usize = 8192;

/// How often something has a row: a screen shows no more.
struct RowRate {
    /// Longest interval between rows, s.
    longest_s: f64,
    /// Number of rows of a run so short that more of them would not be told apart.
    rows: f64,
}

impl RowRate {
    const MOVING: Self = Self { longest_s: 0.04, rows: 100.0 };
    const SIGNALS: Self = Self { longest_s: 0.01, rows: 500.0 };

    /// Returns the number of steps from one row to the next, in a run of a number of steps of a length, s.
    fn every(&self, steps: u64, step: f64) -> u64 {
        let interval = (steps as f64 * step / self.rows).min(self.longest_s);
        (interval / step).round().max(1.0) as u64
    }
}

/// Maximum number of points of a trail.
const MAX_TRAIL_POINTS: usize = 16_384;

/// Common parts of the cases of one recording.
pub struct RecordingSetup<'a> {
    /// Store of all rows.
    pub store: &'a mut Store,
    /// Offscreen pictures.
    pub pictures: &'a mut PictureSeries,
    /// Scale of reactions.
    pub scale: Scale,
    /// Whether signals have a row at every step.
    pub every_step: bool,
    /// Whether there is more than one case; the texts of events then name the case.
    pub several: bool,
}

/// Runs a scenario, writes its entities, and returns its peaks, verdict and statements. `tick` is called with the
/// number of completed steps and returns whether to continue.
///
/// # Errors
/// If the scenario cannot run, be drawn or be written, or if `tick` returns false.
pub fn record(
    set: &mut RecordingSetup<'_>,
    scenario: &Scenario,
    forecast: &Preview,
    tick: &mut dyn FnMut(u64) -> bool,
) -> Result<(Peaks, Verdict, Statements), CaseError> {
    let mut recorder = Recorder::new(set, scenario, forecast)?;
    let mut failure = None;
    let run = replay_while(scenario, |run, frame| {
        failure = recorder.see(run, frame).err();
        let reports = frame.step.is_multiple_of(64) || frame.step == forecast.steps;
        failure.is_none() && (!reports || tick(frame.step))
    });
    match (failure, run) {
        (Some(stop), _) => Err(stop),
        (None, Ok(run)) => recorder.finish(&run),
        (None, Err(refusal)) => Err(CaseError::Refused { scenario: scenario.name.clone(), refusal }),
    }
}

struct Recorder<'a> {
    store: &'a mut Store,
    pictures: &'a mut PictureSeries,
    scenario: &'a Scenario,
    forecast: &'a Preview,
    root: &'a EntityPath,
    palette: Palette,
    options: ViewOptions,
    /// Whether the constant parts of the views stay valid during the whole run.
    constant_views: bool,
    /// Number of edits that have been applied.
    edits: usize,
    clock: RowTimes,
    topics: Vec<Topic>,
    row_every: u64,
    /// Number of steps from one row of signals to the next.
    signals_every: u64,
    drawn: Option<Drawn>,
    /// Pose constant b at the start, rad.
    first_b: f64,
    machine: RecordingSpace,
    /// In place of the machine, the blocks of an assembly.
    blocks: Option<RecordedBlocks>,
    joints: Option<RecordingSpace>,
    tower: Option<RecordingSpace>,
    trail: Thinned<[f32; 3]>,
    events: Events,
}

/// Views of the run: `base_views` without, `views` with the present base and payload.
struct Drawn {
    base_views: Arc<Views>,
    views: Arc<Views>,
}

impl Instant {
    fn of(frame: &Frame) -> Self {
        Self::at(frame.step, frame.time)
    }
}

impl<'a> Recorder<'a> {
    fn new(set: &'a mut RecordingSetup<'_>, scenario: &'a Scenario, forecast: &'a Preview) -> Result<Self, CaseError> {
        let RecordingSetup { store, pictures, scale, every_step, several } = set;
        let (palette, root) = (palette(Theme::Dark), &forecast.root);
        store.fixed(root, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        let of_block = scenario.assembly.as_ref();
        if of_block.is_none() {
            forecast.design.write(store, root)?;
        }
        for topic in &forecast.topics {
            topic.style(store, root, &palette, &forecast.peaks)?;
            topic.style_limits(store, root, &palette, &forecast.peaks)?;
        }
        let changes = |edit: &Edit| match edit {
            Edit::PoseB { .. } => true,
            edit => {
                let plant = edit.part("plant");
                let bars = plant.is_some_and(|plant| ["length", "link"].iter().any(|key| plant.contains_key(*key)));
                bars || edit.sets_machine() || edit.sets(&["compare_b"]) || edit.is_drag()
            }
        };
        let prefix = if *several { format!("{} · ", scenario.name) } else { String::new() };
        let space = |path: &str, eye| RecordingSpace::new(under(root, path), eye, palette.background);
        Ok(Self {
            machine: RecordingSpace::new(root.clone(), forecast.scene, palette.background),
            blocks: of_block.map(|of| RecordedBlocks::of(of, root, forecast.scene, palette)),
            joints: forecast.joints.map(|eye| space("joint_space", eye)),
            tower: forecast.tower.map(|eye| space("tower", eye)),
            trail: Thinned::new(1, MAX_TRAIL_POINTS),
            events: Events::new(prefix, palette),
            options: ViewOptions {
                show_hints: false,
                scale: Some(*scale),
                notes: scenario.notes.clone(),
                ..ViewOptions::default()
            },
            store,
            pictures,
            scenario,
            forecast,
            root,
            palette,
            constant_views: !scenario.edits.iter().any(|e| e.step > 0 && changes(&e.edit)),
            edits: 0,
            clock: RowTimes::default(),
            topics: forecast.topics.clone(),
            signals_every: match *every_step {
                true => 1,
                false => RowRate::SIGNALS.every(forecast.steps, scenario.step),
            },
            row_every: RowRate::MOVING.every(forecast.steps, scenario.step),
            drawn: None,
            first_b: 0.0,
        })
    }

    /// Records one instant.
    fn see(&mut self, run: &Run, frame: &Frame) -> Result<(), CaseError> {
        let (at, last) = (Instant::of(frame), frame.step == self.forecast.steps);
        if frame.step == 0 {
            self.events.start(at, &self.forecast.title, run.scenario().machine.name());
            self.events.plan(at, &run.scenario().task, run.planned_time());
        }
        let edited = self.edited(at);
        let redrawn = (edited || self.drawn.is_none()) && self.prepare(run, frame);
        self.events.note(at, frame, run.scenario());
        if last || edited || frame.step.is_multiple_of(self.signals_every) {
            self.clock.push(at);
            let whole = WholeFrame::of(run, frame);
            self.topics.iter_mut().for_each(|topic| topic.push(&whole));
        }
        // After a change of the views, the scene is drawn at once.
        if last || redrawn || frame.step.is_multiple_of(self.row_every) {
            self.draw(at, run, frame, last)?;
        }
        if let Some(drawn) = self.drawn.as_ref().filter(|_| self.pictures.is_due(frame, self.scenario.step)) {
            let (stage, options) = (drawn.views.stage(), self.pictures.options(&self.options));
            let (scene, camera) = match &self.blocks {
                Some(blocks) => (blocks.scene((run, frame, stage), &options), self.forecast.scene.camera()),
                None => (stage.scene(frame, &options), Camera::flat(stage.linkage().reach())),
            };
            self.pictures.take((at, frame.time), scene, &camera)?;
        }
        if self.clock.len() >= MAX_BUFFERED_ROWS || self.pictures.is_full() {
            self.flush()?;
        }
        Ok(())
    }

    /// Counts the edits applied up to an instant; returns whether there are new ones.
    fn edited(&mut self, at: Instant) -> bool {
        let before = self.edits;
        self.edits += self.scenario.edits[before..].iter().take_while(|timed| timed.step <= at.step).count();
        self.edits > before
    }

    /// Updates the views; returns whether their constant parts have changed.
    fn prepare(&mut self, run: &Run, frame: &Frame) -> bool {
        let force = run.scenario().plant.force;
        self.options.external_force = Some(force).filter(|force| *force != [0.0; 2]);
        let queries = &self.forecast.queries;
        let made = Views::base_views(queries, run, Some(self.forecast.b));
        let views = Views::completed(&made, queries, run, None);
        let drawn = self.drawn.replace(Drawn { base_views: made.clone(), views });
        match drawn {
            Some(before) if Arc::ptr_eq(&before.base_views, &made) => return false,
            Some(_) => {}
            // Workspaces are named by their b at the start.
            None => self.first_b = frame.b_reference,
        }
        let named = |b: f64| format!("workspace/{b:.3}");
        let own = named(self.first_b);
        let other = run.scenario().compare_b.map(named);
        let other = other.map(|other| if other == own { format!("{other} compared") } else { other });
        let names = other.map(|other| ("workspace/compared", other)).into_iter().chain([("workspace", own)]);
        self.machine.rename(names.collect());
        true
    }

    /// Draws all scenes of an instant.
    fn draw(&mut self, at: Instant, run: &Run, frame: &Frame, last: bool) -> Result<(), CaseError> {
        let Some(Drawn { views, .. }) = &self.drawn else { return Ok(()) };
        let when = (at, if self.constant_views { None } else { Some(at) });
        if let Some(blocks) = &mut self.blocks {
            return Ok(blocks.draw(self.store, when, (run, frame, views.stage()), &self.options, last)?);
        }
        let tip = point(frame.end_effector, views.stage().handle_height());
        self.trail.push(|| tip, last);
        self.machine.draw(self.store, when, &views.stage().scene(frame, &self.options))?;
        let scene = |kind: ViewKind, eye: &Eye| match views.shows(kind) {
            true => views.scene(kind, frame, &self.options, &eye.camera()),
            false => Scene::new(self.palette.background, Arc::default()),
        };
        if let (Some(space), Some(eye)) = (&mut self.joints, self.forecast.joints) {
            space.draw(self.store, when, &scene(ViewKind::Joints, &eye))?;
        }
        if let (Some(space), Some(eye)) = (&mut self.tower, self.forecast.tower) {
            space.draw(self.store, when, &scene(ViewKind::Tower, &eye))?;
        }
        Ok(())
    }

    /// Writes all buffered rows.
    fn flush(&mut self) -> Result<(), CaseError> {
        for topic in &mut self.topics {
            topic.write(self.store, self.root, &self.clock)?;
        }
        self.clock.clear();
        for space in [Some(&mut self.machine), self.joints.as_mut(), self.tower.as_mut()].into_iter().flatten() {
            space.write(self.store)?;
        }
        if let Some(blocks) = &mut self.blocks {
            blocks.write(self.store)?;
        }
        self.pictures.write(self.store, &under(self.root, "view"))
    }

    /// Writes the rest: trail, events and properties.
    fn finish(mut self, run: &Run) -> Result<(Peaks, Verdict, Statements), CaseError> {
        let frame = &run.frame();
        self.flush()?;
        let mut ends = RowTimes::default();
        ends.push(Instant::at(0, 0.0));
        ends.push(Instant::of(frame));
        for topic in &self.topics {
            topic.write_limits(self.store, self.root, &ends)?;
        }
        match &mut self.blocks {
            Some(blocks) => blocks.finish(self.store)?,
            None => {
                let trail = lines([self.trail.take()], 1.8, mix(self.palette.ink, self.palette.dim, 0.5));
                self.store.fixed(&under(self.root, "end_effector/path"), &trail)?;
            }
        }
        let (verdict, statements) = (Verdict::of(run.scenario(), frame), Statements::of(run, frame));
        let recorded = RecordedRun {
            scenario: self.scenario,
            dt: run.simulation().dt(),
            end: Instant::of(frame),
            peaks: &frame.peaks,
            verdict: &verdict,
        };
        self.events.write(self.store, self.root, &recorded)?;
        let document = TextDocument::from_markdown(notes::document(self.scenario, (run, frame), &verdict, &statements));
        self.store.fixed(&under(self.root, notes::NOTES_PATH), &document)?;
        let path = EntityPath::properties() / EntityPathPart::new(self.scenario.name.as_str());
        self.store.fixed(&path, &properties(self.scenario, (&frame.peaks, &verdict, &statements), run.plan()))?;
        Ok((frame.peaks, verdict, statements))
    }
}

/// Names of the properties of the drift of each drive.
const DRIFTS: [&str; MAX_DRIVES] =
    ["drift_1", "drift_2", "drift_3", "drift_4", "drift_5", "drift_6", "drift_7", "drift_8"];

/// Returns the properties of a case: the inputs that reproduce the run, its forecast, and its results.
fn properties(
    scenario: &Scenario,
    (peaks, verdict, statements): (&Peaks, &Verdict, &Statements),
    plan: &Plan,
) -> AnyValues {
    let words = |text: &str| [Text::from(text)];
    let numbers = |values: &[f64]| values.iter().copied().map(Scalar::from).collect::<Vec<_>>();
    let number = |x: f64| [Scalar::from(x)];
    let Plan { forecast, pace, price, cycles, .. } = plan;
    let machine = match &scenario.assembly {
        Some(of) => of.scenario.assembly.to_toml(),
        None => stillbase_mechanics::machine::to_toml(&scenario.machine),
    };
    let mut all = AnyValues::default()
        .with_component::<Text>("title", words(&scenario.title))
        .with_component::<Text>("version", words(env!("CARGO_PKG_VERSION")))
        .with_component::<Text>("verdict", words(&verdict.sentence()))
        .with_component::<Text>("scenario", words(&scenario.to_toml()))
        .with_component::<Text>("machine", words(&machine))
        .with_component::<Scalar>("peak_torque", numbers(&peaks.torque))
        .with_component::<Scalar>("peak_base_force", number(peaks.force))
        .with_component::<Scalar>("peak_base_moment", number(peaks.arm_moment))
        .with_component::<Scalar>("forecast_duration", number(forecast.time))
        .with_component::<Scalar>("forecast_peak_base_moment", number(forecast.moment))
        .with_component::<Scalar>("forecast_moment_impulse", number(forecast.impulse));
    // Older names stay beside newer ones until version 0.3.
    all = all.with_component::<Scalar>("forecast_time", number(forecast.time));
    let Statements { machine, plan: held, run } = statements;
    for (name, statement) in [("statement_machine", machine), ("statement_plan", held), ("statement_run", run)] {
        let text = format!("{} ({})", statement.words, statement.why);
        all = all.with_component::<Text>(name, words(&text));
    }
    if let Some(moment) = verdict.past_wheel {
        for name in ["peak_felt_moment", "peak_moment_past_wheel"] {
            all = all.with_component::<Scalar>(name, number(moment));
        }
    }
    if let Some(price) = price {
        all = all
            .with_component::<Scalar>("delta_b", number(price.delta_b()))
            .with_component::<Scalar>("least_peak", number(price.least_peak(forecast.time)))
            .with_component::<Scalar>("least_peak_base_moment", number(price.least_peak(forecast.time)));
    }
    if let Some(pace) = pace {
        if let Some(limit) = pace.leading {
            for name in ["limiting", "limit"] {
                all = all.with_component::<Text>(name, words(&limit.to_string()));
            }
        }
        if let Some(gap) = pace.gap() {
            all = all.with_component::<Scalar>("gap", number(gap));
        }
    }
    // For each drive, the cumulative drift after each cycle.
    if let [start, ends @ ..] = &cycles[..] {
        for (k, name) in DRIFTS.into_iter().enumerate().take(start.len()) {
            let drift: Vec<f64> = ends.iter().map(|end| end[k] - start[k]).collect();
            all = all.with_component::<Scalar>(name, numbers(&drift));
        }
    }
    all
}
