//! One case: from the frames of a run to the entities of a recording.

use std::sync::Arc;

use rerun::components::{Scalar, Text};
use rerun::external::re_log_types::EntityPathPart;
use rerun::{AnyValues, EntityPath, Scalars, SeriesLines, ViewCoordinates};

use super::areas::Areas;
use super::body::Body;
use super::film::Film;
use super::joints::Joints;
use super::planned;
use super::reaction::{Drawing, Scale};
use super::rehearsal::Rehearsal;
use super::store::{Clock, Instant, Store, StoreError};
use super::story::Story;
use super::style::{colour, series_name, signal_colour, under};
use super::tip::Tip;
use super::tower::Tower;
use crate::picture::scene::palette::{Palette, Theme, palette};
use crate::planning::pose_constant::Planes;
use crate::session::scenario::Scenario;
use crate::session::verdict::Verdict;
use crate::session::{Edit, Plan, Refusal, Run, replay};
use crate::simulation::frame::{Frame, Peaks};
use crate::simulation::signals::Signal;

/// Rows that gather before they are written.
const BATCH: usize = 8192;

/// Bodies and points have a row this often, s; a screen shows no more.
const BODY_TIME: f64 = 0.005;

/// Reactions are drawn this often, s.
const REACTION_TIME: f64 = 0.01;

/// Why a case was not recorded.
#[derive(Debug)]
pub enum Stop {
    /// It cannot run.
    Refused {
        /// Which.
        scenario: String,
        /// Why.
        refusal: Refusal,
    },
    /// The pictures asked for cannot be.
    #[cfg_attr(not(feature = "render"), expect(dead_code, reason = "nothing to draw them with"))]
    Pictures(String),
    /// It cannot be written.
    Store(StoreError),
}

impl<E: Into<StoreError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Store(error.into())
    }
}

/// What the cases of one recording share.
pub struct Set<'a> {
    /// Where everything goes.
    pub store: &'a mut Store,
    /// Pictures on the way.
    pub film: &'a mut Film,
    /// Of reactions.
    pub scale: Scale,
    /// More than one case: events say of which they are.
    pub several: bool,
}

/// Runs a scenario and writes its entities; its peaks.
///
/// # Errors
/// If it cannot run, be drawn or be written.
pub fn record(
    set: &mut Set<'_>,
    scenario: &Scenario,
    rehearsal: &Rehearsal,
    tick: &mut dyn FnMut(u64),
) -> Result<(Peaks, Verdict), Stop> {
    let mut recorder = Recorder::new(set, scenario, rehearsal)?;
    let mut failure = None;
    let run = replay(scenario, |run, frame| {
        if failure.is_none() {
            failure = recorder.see(run, frame).err();
            if frame.step.is_multiple_of(64) || frame.step == rehearsal.steps {
                tick(frame.step);
            }
        }
    });
    let run = run.map_err(|refusal| Stop::Refused { scenario: scenario.name.clone(), refusal })?;
    match failure {
        Some(stop) => Err(stop),
        None => recorder.finish(&run),
    }
}

struct Recorder<'a> {
    store: &'a mut Store,
    film: &'a mut Film,
    scenario: &'a Scenario,
    rehearsal: &'a Rehearsal,
    root: &'a EntityPath,
    palette: Palette,
    /// Machine and workspaces stay what they are: their geometry holds for good.
    lasting: bool,
    /// Edits that have applied.
    edits: usize,
    clock: Clock,
    series: Vec<Vec<f64>>,
    body_every: u64,
    reaction_every: u64,
    body: Option<Body>,
    areas: Areas,
    /// The plan stays what it is.
    planned: bool,
    /// Whose drawings joint space and tower are: the planes, and whether a planned motion leads.
    drawn: Option<(Arc<Planes>, bool)>,
    joints: Option<Joints>,
    tower: Option<Tower>,
    tip: Tip,
    reactions: Drawing,
    story: Story,
}

impl Instant {
    fn of(frame: &Frame) -> Self {
        Self { step: frame.step, nanos: (1e9 * frame.time).round() as i64 }
    }
}

impl<'a> Recorder<'a> {
    fn new(set: &'a mut Set<'_>, scenario: &'a Scenario, rehearsal: &'a Rehearsal) -> Result<Self, Stop> {
        let Set { store, film, scale, several } = set;
        let (palette, root) = (palette(Theme::Dark), &rehearsal.root);
        store.fixed(root, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        for signal in &rehearsal.signals {
            let style = SeriesLines::new()
                .with_names([series_name(signal)])
                .with_colors([colour(signal_colour(signal, &palette))])
                .with_widths([if signal.path.contains("reference") { 0.8 } else { 1.6 }]);
            store.fixed(&path_of(root, signal), &style)?;
        }
        let every = |time: f64| (time / scenario.step).round().max(1.0) as u64;
        let reshapes = |edit: &Edit| match edit {
            Edit::SetMachine { .. } | Edit::CompareB { .. } => true,
            Edit::SetPlant { change } => ["length", "link"].iter().any(|key| change.contains_key(*key)),
            _ => false,
        };
        let leads = |edit: &Edit| edit.leads() || matches!(edit, Edit::PoseB { .. } | Edit::SetMachine { .. });
        let later = |which: &dyn Fn(&Edit) -> bool| scenario.edits.iter().any(|e| e.step > 0 && which(&e.edit));
        let prefix = if *several { format!("{} · ", scenario.name) } else { String::new() };
        Ok(Self {
            tip: Tip::show(store, root, rehearsal.reach, &palette)?,
            reactions: Drawing::show(store, root, *scale, palette, besides(scenario))?,
            story: Story::new(prefix, palette),
            store,
            film,
            scenario,
            rehearsal,
            root,
            palette,
            lasting: !later(&reshapes),
            planned: !later(&leads),
            drawn: None,
            joints: None,
            tower: None,
            edits: 0,
            clock: Clock::default(),
            series: vec![Vec::new(); rehearsal.signals.len()],
            body_every: every(BODY_TIME),
            reaction_every: every(REACTION_TIME),
            body: None,
            areas: Areas::new(root, palette),
        })
    }

    /// One instant.
    fn see(&mut self, run: &Run, frame: &Frame) -> Result<(), Stop> {
        let (at, last) = (Instant::of(frame), frame.step == self.rehearsal.steps);
        if frame.step == 0 {
            self.story.start(at, &self.rehearsal.title, self.scenario.machine.name());
            self.story.plan(at, &run.scenario().task, run.planned_time());
        }
        let redrawn = (self.edited(at) || self.body.is_none()) && self.show(at, run, frame)?;
        self.story.note(at, frame);
        self.clock.push(at);
        for (series, signal) in self.series.iter_mut().zip(&self.rehearsal.signals) {
            series.push(signal.value(frame));
        }
        if let Some(body) = &mut self.body {
            let (reach, top) = (body.linkage().reach(), body.linkage().top());
            if last || frame.step.is_multiple_of(self.body_every) {
                body.place(at, frame);
                self.areas.place(at, frame);
                self.tip.place(at, frame, top, last);
            }
            // What is drawn anew stands in its place from then on.
            if last || redrawn || frame.step.is_multiple_of(self.body_every) {
                if let Some(joints) = &mut self.joints {
                    joints.place(at, frame);
                }
                if let Some(tower) = &mut self.tower {
                    tower.place(at, frame);
                }
            }
            if last || frame.step.is_multiple_of(self.reaction_every) {
                self.reactions.place(at, frame, reach, top);
            }
        }
        if self.film.is_due(frame, self.scenario.step) {
            self.film.take(at, run, frame)?;
        }
        if self.clock.len() >= BATCH || self.film.is_full() {
            self.flush()?;
        }
        Ok(())
    }

    /// Whether edits have applied just now.
    fn edited(&mut self, at: Instant) -> bool {
        let before = self.edits;
        while let Some(timed) = self.scenario.edits.get(self.edits).filter(|e| e.step <= at.step) {
            self.story.edit(at, &timed.edit);
            self.edits += 1;
        }
        self.edits > before
    }

    /// Machine and workspaces, as far as they have changed; whether joint space and tower have.
    fn show(&mut self, at: Instant, run: &Run, frame: &Frame) -> Result<bool, Stop> {
        let since = if self.lasting { None } else { Some(at) };
        let Scenario { machine: model, plant, base, .. } = run.scenario();
        // A machine with other lengths is drawn as it is.
        let machine = &plant.machine(model).unwrap_or_else(|_| model.clone());
        let (store, root, palette) = (&mut *self.store, self.root, &self.palette);
        let same = |body: &Body| body.shows(machine);
        let body = match self.body.take().filter(same) {
            Some(body) => body,
            None => Body::show(store, root, since, (machine, base.moves()), frame, palette)?,
        };
        if let Some(planes) = run.planes() {
            let compare = run.scenario().compare_b;
            let path = planned::points(run);
            self.areas.show(
                store,
                (at, since),
                planes,
                body.linkage(),
                (frame.b_reference, compare, frame.base),
                &path,
            )?;
        }
        let above = [body.linkage().reach(), body.linkage().top()];
        self.body = Some(body);
        self.film.cut();
        self.show_plan(at, run, frame, above)
    }

    /// The plan, joint space and tower, if they have changed; above a machine of a reach and a height, m.
    fn show_plan(&mut self, at: Instant, run: &Run, frame: &Frame, above: [f64; 2]) -> Result<bool, Stop> {
        let leads = run.motion().is_some();
        let known = |(planes, led): &(Arc<Planes>, bool)| {
            *led == leads && run.planes().is_some_and(|now| Arc::ptr_eq(planes, now))
        };
        if self.drawn.as_ref().is_some_and(known) {
            return Ok(false);
        }
        self.drawn = run.planes().map(|planes| (planes.clone(), leads));
        let since = if self.planned { None } else { Some(at) };
        let (store, root, palette) = (&mut *self.store, self.root, &self.palette);
        planned::show(store, root, since, run, above, palette)?;
        // What has gathered of the last drawing belongs before this one.
        if let Some(joints) = &mut self.joints {
            joints.write(store)?;
        }
        if let Some(tower) = &mut self.tower {
            tower.write(store)?;
        }
        let range = self.rehearsal.b;
        self.joints = match &self.rehearsal.joints {
            Some(eye) => Joints::show(store, root, since, (run, frame.b_reference, range), eye, palette)?,
            None => None,
        };
        self.tower = match &self.rehearsal.tower {
            Some(eye) => Tower::show(store, root, since, (run, range), eye, palette)?,
            None => None,
        };
        Ok(true)
    }

    /// Writes what has gathered.
    fn flush(&mut self) -> Result<(), Stop> {
        let clock = self.clock.columns();
        self.clock.clear();
        for (series, signal) in self.series.iter_mut().zip(&self.rehearsal.signals) {
            let values = Scalars::new(std::mem::take(series)).columns_of_unit_batches()?;
            self.store.columns(&clock, &path_of(self.root, signal), values)?;
        }
        if let Some(body) = &mut self.body {
            body.write(self.store, self.root)?;
        }
        self.areas.write(self.store)?;
        if let Some(joints) = &mut self.joints {
            joints.write(self.store)?;
        }
        if let Some(tower) = &mut self.tower {
            tower.write(self.store)?;
        }
        self.tip.write(self.store, self.root)?;
        self.reactions.write(self.store, self.root)?;
        self.film.write(self.store, &under(self.root, "view"))
    }

    /// What is known only at the end.
    fn finish(mut self, run: &Run) -> Result<(Peaks, Verdict), Stop> {
        let frame = &run.frame();
        self.flush()?;
        self.tip.write_trail(self.store, self.root, &self.palette)?;
        let verdict = Verdict::of(run.scenario(), frame);
        self.story.write(self.store, self.root, (Instant::of(frame), &frame.peaks, &verdict))?;
        let path = EntityPath::properties() / EntityPathPart::new(self.scenario.name.as_str());
        self.store.fixed(&path, &properties(self.scenario, (&frame.peaks, &verdict), run.plan()))?;
        Ok((frame.peaks, verdict))
    }
}

fn path_of(root: &EntityPath, signal: &Signal) -> EntityPath {
    under(root, &format!("signals/{}", signal.path))
}

/// All that the run can be made of again, what was foreseen, and what came of it.
fn properties(scenario: &Scenario, (peaks, verdict): (&Peaks, &Verdict), plan: &Plan) -> AnyValues {
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
        for (k, name) in ["drift_1", "drift_2", "drift_3"].into_iter().enumerate() {
            let drift: Vec<f64> = ends.iter().map(|end| end[k] - start[k]).collect();
            all = all.with_component::<Scalar>(name, numbers(&drift));
        }
    }
    all
}

/// What the base carries besides what comes of motion.
fn besides(scenario: &Scenario) -> &'static str {
    let pushes = |edit: &Edit| match edit {
        Edit::Push { .. } => true,
        Edit::SetPlant { change } => change.contains_key("force"),
        _ => false,
    };
    let pushed = scenario.plant.force != [0.0; 2] || scenario.edits.iter().any(|timed| pushes(&timed.edit));
    if pushed { "its weight and pushes" } else { "its weight" }
}
