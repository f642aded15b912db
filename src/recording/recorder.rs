//! One case: from the frames of a run to the entities of a recording.

use std::sync::Arc;

use rerun::components::{Scalar, Text};
use rerun::external::re_log_types::EntityPathPart;
use rerun::{AnyValues, EntityPath, ViewCoordinates};

use super::events::Events;
use super::eye::Eye;
use super::pictures::Series;
use super::preview::Preview;
use super::rows::Thinned;
use super::space::Space;
use super::stop::Stop;
use super::store::{Clock, Instant, Store};
use super::style::{lines, under};
use super::topic::Topic;
use crate::mechanics::planar::MAX_DRIVES;
use crate::picture::scene::options::ViewOptions;
use crate::picture::scene::palette::{Palette, Theme, mix, palette};
use crate::picture::scene::reaction::Scale;
use crate::picture::scene::views::{ViewKind, Views};
use crate::picture::scene::{Scene, point};
use crate::session::scenario::Scenario;
use crate::session::verdict::{Statements, Verdict};
use crate::session::{Edit, Plan, Run, replay_while};
use crate::simulation::frame::{Frame, Peaks};

/// Rows that gather before they are written.
const BATCH: usize = 8192;

/// What moves has a row this often, s; a screen shows no more.
const ROW_TIME: f64 = 0.005;

/// Points of a trail, at most.
const TRAIL: usize = 16_384;

/// What the cases of one recording share.
pub struct Set<'a> {
    /// Where everything goes.
    pub store: &'a mut Store,
    /// Pictures on the way.
    pub pictures: &'a mut Series,
    /// Of reactions.
    pub scale: Scale,
    /// More than one case: events say of which they are.
    pub several: bool,
}

/// Runs a scenario and writes its entities; its peaks. `tick` hears of steps that are done, and says whether the rest is
/// still wanted.
///
/// # Errors
/// If it cannot run, be drawn or be written, or is not wanted any more.
pub fn record(
    set: &mut Set<'_>,
    scenario: &Scenario,
    forecast: &Preview,
    tick: &mut dyn FnMut(u64) -> bool,
) -> Result<(Peaks, Verdict, Statements), Stop> {
    let mut recorder = Recorder::new(set, scenario, forecast)?;
    let mut failure = None;
    let run = replay_while(scenario, |run, frame| {
        failure = recorder.see(run, frame).err();
        let told = frame.step.is_multiple_of(64) || frame.step == forecast.steps;
        failure.is_none() && (!told || tick(frame.step))
    });
    match (failure, run) {
        (Some(stop), _) => Err(stop),
        (None, Ok(run)) => recorder.finish(&run),
        (None, Err(refusal)) => Err(Stop::Refused { scenario: scenario.name.clone(), refusal }),
    }
}

struct Recorder<'a> {
    store: &'a mut Store,
    pictures: &'a mut Series,
    scenario: &'a Scenario,
    forecast: &'a Preview,
    root: &'a EntityPath,
    palette: Palette,
    options: ViewOptions,
    /// Nothing that the views show for good changes on the way.
    lasting: bool,
    /// Edits that have applied.
    edits: usize,
    clock: Clock,
    topics: Vec<Topic>,
    row_every: u64,
    drawn: Option<Drawn>,
    /// The b that the run begins with, rad.
    first_b: f64,
    machine: Space,
    joints: Option<Space>,
    tower: Option<Space>,
    trail: Thinned<[f32; 3]>,
    events: Events,
}

/// What is drawn from: views as they were made, and as base and payload are now.
struct Drawn {
    made: Arc<Views>,
    views: Arc<Views>,
}

impl Instant {
    fn of(frame: &Frame) -> Self {
        Self::at(frame.step, frame.time)
    }
}

impl<'a> Recorder<'a> {
    fn new(set: &'a mut Set<'_>, scenario: &'a Scenario, forecast: &'a Preview) -> Result<Self, Stop> {
        let Set { store, pictures, scale, several } = set;
        let (palette, root) = (palette(Theme::Dark), &forecast.root);
        store.fixed(root, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        forecast.design.write(store, root)?;
        for topic in &forecast.topics {
            topic.style(store, root, &palette, &forecast.peaks)?;
        }
        let changes = |edit: &Edit| match edit {
            Edit::PoseB { .. } => true,
            edit => {
                let plant = edit.part("plant");
                let bars = plant.is_some_and(|plant| ["length", "link"].iter().any(|key| plant.contains_key(*key)));
                bars || edit.sets_machine() || edit.sets(&["compare_b"]) || edit.leads()
            }
        };
        let prefix = if *several { format!("{} · ", scenario.name) } else { String::new() };
        let space = |path: &str, eye| Space::new(under(root, path), eye, palette.background);
        Ok(Self {
            machine: Space::new(root.clone(), forecast.scene, palette.background),
            joints: forecast.joints.map(|eye| space("joint_space", eye)),
            tower: forecast.tower.map(|eye| space("tower", eye)),
            trail: Thinned::new(1, TRAIL),
            events: Events::new(prefix, palette),
            options: ViewOptions { invites: false, scale: Some(*scale), ..ViewOptions::default() },
            store,
            pictures,
            scenario,
            forecast,
            root,
            palette,
            lasting: !scenario.edits.iter().any(|e| e.step > 0 && changes(&e.edit)),
            edits: 0,
            clock: Clock::default(),
            topics: forecast.topics.clone(),
            row_every: (ROW_TIME / scenario.step).round().max(1.0) as u64,
            drawn: None,
            first_b: 0.0,
        })
    }

    /// One instant.
    fn see(&mut self, run: &Run, frame: &Frame) -> Result<(), Stop> {
        let (at, last) = (Instant::of(frame), frame.step == self.forecast.steps);
        if frame.step == 0 {
            self.events.start(at, &self.forecast.title, self.scenario.machine.name());
            self.events.plan(at, &run.scenario().task, run.planned_time());
        }
        let redrawn = (self.edited(at) || self.drawn.is_none()) && self.prepare(run, frame);
        self.events.note(at, frame, run.scenario());
        self.clock.push(at);
        self.topics.iter_mut().for_each(|topic| topic.push(frame));
        // What is drawn anew stands in its place from then on.
        if last || redrawn || frame.step.is_multiple_of(self.row_every) {
            self.draw(at, frame, last)?;
        }
        if let Some(drawn) = self.drawn.as_ref().filter(|_| self.pictures.is_due(frame, self.scenario.step)) {
            self.pictures.take(at, drawn.views.stage(), frame, &self.options)?;
        }
        if self.clock.len() >= BATCH || self.pictures.is_full() {
            self.flush()?;
        }
        Ok(())
    }

    /// Whether edits have applied just now.
    fn edited(&mut self, at: Instant) -> bool {
        let before = self.edits;
        self.edits += self.scenario.edits[before..].iter().take_while(|timed| timed.step <= at.step).count();
        self.edits > before
    }

    /// Makes the views again if what they show has changed; whether it has.
    fn prepare(&mut self, run: &Run, frame: &Frame) -> bool {
        let force = run.scenario().plant.force;
        self.options.push = Some(force).filter(|force| *force != [0.0; 2]);
        let queries = &self.forecast.queries;
        let made = Views::made(queries, run, Some(self.forecast.b));
        let views = Views::completed(&made, queries, run, None);
        let drawn = self.drawn.replace(Drawn { made: made.clone(), views });
        match drawn {
            Some(before) if Arc::ptr_eq(&before.made, &made) => return false,
            Some(_) => {}
            // Workspaces go by the b that they begin with.
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

    /// Everything that is to be seen at an instant.
    fn draw(&mut self, at: Instant, frame: &Frame, last: bool) -> Result<(), Stop> {
        let Some(Drawn { views, .. }) = &self.drawn else { return Ok(()) };
        let when = (at, if self.lasting { None } else { Some(at) });
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

    /// Writes what has gathered.
    fn flush(&mut self) -> Result<(), Stop> {
        for topic in &mut self.topics {
            topic.write(self.store, self.root, &self.clock)?;
        }
        self.clock.clear();
        for space in [Some(&mut self.machine), self.joints.as_mut(), self.tower.as_mut()].into_iter().flatten() {
            space.write(self.store)?;
        }
        self.pictures.write(self.store, &under(self.root, "view"))
    }

    /// What is known only at the end.
    fn finish(mut self, run: &Run) -> Result<(Peaks, Verdict, Statements), Stop> {
        let frame = &run.frame();
        self.flush()?;
        let trail = lines([self.trail.take()], 1.8, mix(self.palette.ink, self.palette.dim, 0.5));
        self.store.fixed(&under(self.root, "end_effector/path"), &trail)?;
        let (verdict, statements) = (Verdict::of(run.scenario(), frame), Statements::of(run, frame));
        let (of, end) = ((self.scenario, run.simulation().dt()), (Instant::of(frame), &frame.peaks, &verdict));
        self.events.write(self.store, self.root, of, end)?;
        let path = EntityPath::properties() / EntityPathPart::new(self.scenario.name.as_str());
        self.store.fixed(&path, &properties(self.scenario, (&frame.peaks, &verdict, &statements), run.plan()))?;
        Ok((frame.peaks, verdict, statements))
    }
}

/// Properties that hold the drift of each drive.
const DRIFTS: [&str; MAX_DRIVES] =
    ["drift_1", "drift_2", "drift_3", "drift_4", "drift_5", "drift_6", "drift_7", "drift_8"];

/// All that the run can be made of again, what was foreseen, and what came of it.
fn properties(
    scenario: &Scenario,
    (peaks, verdict, statements): (&Peaks, &Verdict, &Statements),
    plan: &Plan,
) -> AnyValues {
    let words = |text: &str| [Text::from(text)];
    let numbers = |values: &[f64]| values.iter().copied().map(Scalar::from).collect::<Vec<_>>();
    let number = |x: f64| [Scalar::from(x)];
    let Plan { forecast, pace, price, cycles, .. } = plan;
    let mut all = AnyValues::default()
        .with_component::<Text>("title", words(&scenario.title))
        .with_component::<Text>("version", words(env!("CARGO_PKG_VERSION")))
        .with_component::<Text>("verdict", words(&verdict.sentence()))
        .with_component::<Text>("scenario", words(&scenario.to_toml()))
        .with_component::<Text>("machine", words(&crate::mechanics::machine::to_toml(&scenario.machine)))
        .with_component::<Scalar>("peak_torque", numbers(&peaks.torque))
        .with_component::<Scalar>("peak_base_force", number(peaks.force))
        .with_component::<Scalar>("peak_base_moment", number(peaks.arm_moment))
        .with_component::<Scalar>("forecast_time", number(forecast.time))
        .with_component::<Scalar>("forecast_peak_base_moment", number(forecast.moment))
        .with_component::<Scalar>("forecast_moment_impulse", number(forecast.impulse));
    let Statements { machine, plan: held, run } = statements;
    for (name, statement) in [("statement_machine", machine), ("statement_plan", held), ("statement_run", run)] {
        let text = format!("{} ({})", statement.words, statement.why);
        all = all.with_component::<Text>(name, words(&text));
    }
    if let Some(left) = verdict.past_wheel {
        all = all.with_component::<Scalar>("peak_moment_past_wheel", number(left));
    }
    if let Some(price) = price {
        all = all
            .with_component::<Scalar>("delta_b", number(price.delta_b()))
            .with_component::<Scalar>("least_peak_base_moment", number(price.least_peak(forecast.time)));
    }
    if let Some(pace) = pace {
        if let Some(limit) = pace.leading {
            all = all.with_component::<Text>("limit", words(&limit.to_string()));
        }
        if let Some(gap) = pace.gap() {
            all = all.with_component::<Scalar>("gap", number(gap));
        }
    }
    // By drive, a number for each cycle: so far it has drifted in all.
    if let [start, ends @ ..] = &cycles[..] {
        for (k, name) in DRIFTS.into_iter().enumerate().take(start.len()) {
            let drift: Vec<f64> = ends.iter().map(|end| end[k] - start[k]).collect();
            all = all.with_component::<Scalar>(name, numbers(&drift));
        }
    }
    all
}
