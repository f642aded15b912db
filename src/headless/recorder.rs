//! One case: from the frames of a run to the entities of a recording.

use std::f64::consts::FRAC_PI_2;
use std::io::Write;
use std::sync::Arc;

use rerun::components::{Scalar, Text};
use rerun::external::re_log_types::EntityPathPart;
use rerun::{
    AnyValues, Clear, Color, EntityPath, LineStrips3D, Mesh3D, Points3D, Radius, Scalars, SerializedComponentColumn,
    SeriesLines, StateChange, StateConfiguration, TextLog, TextLogLevel, Transform3D, ViewCoordinates,
};

use super::film::Film;
use super::reaction::{Drawing, Scale};
use super::rehearsal::Rehearsal;
use super::store::{Clock, Instant, Store, StoreError};
use crate::frame::{Frame, Peaks, Phase, Reach};
use crate::planar::{Vector, unit};
use crate::pose_constant::Planes;
use crate::scenario::Scenario;
use crate::scene::linkage::{Linkage, mix};
use crate::scene::palette::{Palette, Theme, faded, palette};
use crate::scene::stage::Stage;
use crate::scene::{Mesh, Rgba};
use crate::session::{Edit, Refusal, Run, replay};
use crate::signals::Signal;

/// Rows that are gathered before they are written.
const BATCH: usize = 8192;

/// Bodies and points have a row this often, s; a screen shows no more.
const BODY_TIME: f64 = 0.005;

/// Reactions are drawn this often, s.
const REACTION_TIME: f64 = 0.01;

/// Points of a trail, at most; a longer one has every other taken out.
const TRAIL: usize = 16_384;

/// Cells of a workspace along each angle.
const CELLS: u32 = 40;

/// Why a case was not recorded.
#[derive(Debug)]
pub enum Stop {
    /// It cannot run.
    Refused { scenario: String, refusal: Refusal },
    /// The pictures asked for cannot be.
    Pictures(String),
    /// It cannot be written.
    Store(StoreError),
}

impl<E: Into<StoreError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Store(error.into())
    }
}

/// The path of an entity under another; slashes in the name are part of the path.
pub fn under(root: &EntityPath, path: &str) -> EntityPath {
    let parts = path.split('/').map(EntityPathPart::new);
    EntityPath::new(root.iter().cloned().chain(parts).collect())
}

/// The same, with the last part as it is.
fn named(root: &EntityPath, path: &str, name: &str) -> EntityPath {
    let parts = path.split('/').chain([name]).map(EntityPathPart::new);
    EntityPath::new(root.iter().cloned().chain(parts).collect())
}

/// A colour of the palette.
pub fn colour(rgba: Rgba) -> Color {
    let [r, g, b, a] = rgba.map(|x| (255.0 * x.clamp(0.0, 1.0)).round() as u8);
    Color::from_unmultiplied_rgba(r, g, b, a)
}

/// The colour that a signal has in every plot.
pub fn signal_colour(signal: &Signal, palette: &Palette) -> Rgba {
    let paler = |rgba| mix(rgba, palette.dim, 0.6);
    match (signal.drive, signal.path.as_str()) {
        (Some(k), path) if path.starts_with("reference/") => paler(palette.drive(k)),
        (Some(k), _) => palette.drive(k),
        (None, "pose/b") => palette.amber,
        (None, "pose/b_reference") => paler(palette.amber),
        (None, "moment/total" | "force/dynamic") => palette.reaction,
        (None, path) if path.starts_with("moment/") || path.starts_with("force/") => paler(palette.reaction),
        (None, "reactionless/now") => palette.zero,
        (None, _) => palette.ink,
    }
}

/// `τ₁ N m`: Rerun has no label on the axis.
pub fn series_name(signal: &Signal) -> String {
    match signal.unit {
        "1" => signal.symbol.clone(),
        unit => format!("{} {unit}", signal.symbol),
    }
}

/// A number with the digits that matter: tiny ones in powers of ten.
fn brief(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if a < 1e-3 => format!("{x:.1e}"),
        _ => format!("{x:.4}"),
    }
}

/// Rows of something that changes rarely: equal ones are left out.
#[derive(Debug)]
pub struct Track<T> {
    clock: Clock,
    rows: Vec<T>,
    last: Option<T>,
}

impl<T: Clone + PartialEq> Track<T> {
    /// No row.
    pub fn new() -> Self {
        Self { clock: Clock::default(), rows: Vec::new(), last: None }
    }

    /// From an instant on.
    pub fn push(&mut self, at: Instant, row: T) {
        if self.last.as_ref() != Some(&row) {
            self.clock.push(at);
            self.rows.push(row.clone());
            self.last = Some(row);
        }
    }

    /// The rows since the last time.
    pub fn take(&mut self) -> (Clock, Vec<T>) {
        (std::mem::take(&mut self.clock), std::mem::take(&mut self.rows))
    }
}

/// Every so many items, and never more than so many: past that, every other goes.
#[derive(Debug)]
struct Thinned<T> {
    items: Vec<T>,
    every: u64,
    seen: u64,
    most: usize,
}

impl<T> Thinned<T> {
    fn new(every: u64, most: usize) -> Self {
        Self { items: Vec::new(), every: every.max(1), seen: 0, most }
    }

    fn push(&mut self, item: impl FnOnce() -> T, last: bool) {
        if self.seen.is_multiple_of(self.every) || last {
            self.items.push(item());
            if self.items.len() > self.most && !last {
                let mut keep = false;
                self.items.retain(|_| {
                    keep = !keep;
                    keep
                });
                self.every *= 2;
            }
        }
        self.seen += 1;
    }
}

/// A point of the scene, where `f64` turns into `f32`.
pub fn point(p: Vector, z: f64) -> [f32; 3] {
    [p.re as f32, p.im as f32, z as f32]
}

/// A turn about z by the angle of a unit vector.
fn turned(along: Vector) -> rerun::Quaternion {
    let half = 0.5 * along.arg();
    rerun::Quaternion::from_xyzw([0.0, 0.0, half.sin() as f32, half.cos() as f32])
}

fn mesh_of(mesh: &Mesh, rgba: Rgba) -> Mesh3D {
    Mesh3D::new(mesh.positions.iter().copied())
        .with_vertex_normals(mesh.normals.iter().copied())
        .with_triangle_indices(mesh.triangles.iter().copied())
        .with_albedo_factor(colour(rgba).0)
}

/// A workspace on show.
#[derive(Debug)]
struct Area {
    path: EntityPath,
    b: f64,
    turn: Track<f64>,
    label: Track<String>,
}

/// The machine's body as it is now.
#[derive(Debug)]
struct Body {
    linkage: Linkage,
    planes: Option<Arc<Planes>>,
}

struct Recorder<'a, W: Write> {
    store: &'a mut Store<W>,
    film: &'a mut Film,
    scenario: &'a Scenario,
    root: EntityPath,
    /// Tells the events of several cases apart.
    prefix: String,
    palette: Palette,
    last: u64,
    table: &'a [Signal],
    /// Machine and workspaces stay what they are: their geometry is static.
    lasting: bool,
    body: Option<Body>,
    area: Option<Area>,
    compared: Option<Area>,
    edits: usize,
    steps: Clock,
    series: Vec<Vec<f64>>,
    body_every: u64,
    bodies: Clock,
    links: Vec<(EntityPath, Vec<[f32; 3]>, Vec<rerun::Quaternion>)>,
    joints: Vec<[f32; 3]>,
    com: Vec<[f32; 3]>,
    tip: Vec<[f32; 3]>,
    base: Track<([f32; 3], [f32; 4])>,
    target: Track<[f32; 3]>,
    gap: Track<Option<[f32; 3]>>,
    trail: Thinned<[f32; 3]>,
    reaction_every: u64,
    reactions: Drawing,
    events: Vec<(Instant, String, &'static str, Rgba)>,
    reach: Option<&'static str>,
    phases: Track<Phase>,
    moment_peak: (Instant, f64),
    stage: Option<Stage>,
}

/// What the cases of one recording share.
pub struct Set<'a, W: Write> {
    /// Where everything goes.
    pub store: &'a mut Store<W>,
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
pub fn record<W: Write>(
    set: &mut Set<'_, W>,
    scenario: &Scenario,
    rehearsal: &Rehearsal,
    tick: &mut dyn FnMut(u64),
) -> Result<Peaks, Stop> {
    let mut recorder = Recorder::new(set, scenario, rehearsal)?;
    let mut failure = None;
    let run = replay(scenario, |run, frame| {
        if failure.is_none() {
            failure = recorder.see(run, frame).err();
            if frame.step.is_multiple_of(64) || frame.step == recorder.last {
                tick(frame.step);
            }
        }
    });
    let run = run.map_err(|refusal| Stop::Refused { scenario: scenario.name.clone(), refusal })?;
    match failure {
        Some(stop) => Err(stop),
        None => recorder.finish(&run.frame()),
    }
}

impl<'a, W: Write> Recorder<'a, W> {
    fn new(set: &'a mut Set<'_, W>, scenario: &'a Scenario, rehearsal: &'a Rehearsal) -> Result<Self, Stop> {
        let palette = palette(Theme::Dark);
        let Set { store, film, scale, several } = set;
        let (root, table) = (rehearsal.root.clone(), rehearsal.signals.as_slice());
        let every = |time: f64| (time / scenario.step).round().max(1.0) as u64;
        let live = |e: &crate::session::TimedEdit| {
            e.step > 0 && matches!(e.edit, Edit::SetMachine { .. } | Edit::CompareB { .. })
        };
        store.fixed(&root, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        for signal in table {
            let style = SeriesLines::new()
                .with_names([series_name(signal)])
                .with_colors([colour(signal_colour(signal, &palette))])
                .with_widths([if signal.path.contains("reference") { 0.8 } else { 1.6 }]);
            store.fixed(&under(&root, &format!("signals/{}", signal.path)), &style)?;
        }
        let dot = |radius: f32, rgba| {
            Points3D::update_fields().with_radii([Radius::new_ui_points(radius)]).with_colors([colour(rgba)])
        };
        store.fixed(&under(&root, "machine/joints"), &dot(2.2, palette.background))?;
        store.fixed(&under(&root, "com"), &dot(4.0, palette.ink).with_labels(["CM"]).with_show_labels(false))?;
        store.fixed(&under(&root, "end_effector"), &dot(4.5, palette.ink))?;
        let states = [Phase::Motion, Phase::Follow, Phase::Rest];
        let lanes = StateConfiguration::new()
            .with_values(states.map(Phase::name))
            .with_labels(states.map(Phase::name))
            .with_colors([palette.amber, palette.drive(0), palette.line].map(colour));
        store.fixed(&under(&root, "phase"), &lanes)?;
        let reactions = Drawing::new(*scale, palette);
        reactions.style(store, &root)?;
        Ok(Self {
            series: vec![Vec::new(); table.len()],
            last: rehearsal.steps,
            lasting: !scenario.edits.iter().any(live),
            body_every: every(BODY_TIME),
            trail: Thinned::new(every(BODY_TIME), TRAIL),
            reaction_every: every(REACTION_TIME),
            reactions,
            store,
            film,
            scenario,
            prefix: if *several { format!("{} · ", scenario.name) } else { String::new() },
            root,
            palette,
            table,
            body: None,
            area: None,
            compared: None,
            edits: 0,
            steps: Clock::default(),
            bodies: Clock::default(),
            links: Vec::new(),
            joints: Vec::new(),
            com: Vec::new(),
            tip: Vec::new(),
            base: Track::new(),
            target: Track::new(),
            gap: Track::new(),
            events: Vec::new(),
            reach: None,
            phases: Track::new(),
            moment_peak: (Instant { step: 0, nanos: 0 }, 0.0),
            stage: None,
        })
    }

    /// One instant.
    fn see(&mut self, run: &Run, frame: &Frame) -> Result<(), Stop> {
        let at = Instant { step: frame.step, nanos: (1e9 * frame.time).round() as i64 };
        let edited = self.note_edits(at, frame);
        if edited || self.body.is_none() {
            self.show(at, run, frame)?;
        }
        self.note(at, frame);
        self.steps.push(at);
        for (series, signal) in self.series.iter_mut().zip(self.table) {
            series.push(signal.value(frame));
        }
        if frame.step.is_multiple_of(self.body_every) || frame.step == self.last {
            self.place(at, frame);
        }
        self.take_picture(at, run, frame, edited)?;
        if self.steps.len() >= BATCH {
            self.flush()?;
        }
        Ok(())
    }

    /// The edits that have just applied.
    fn note_edits(&mut self, at: Instant, frame: &Frame) -> bool {
        if frame.step == 0 {
            let machine = self.scenario.machine.name();
            let title = if self.scenario.title.is_empty() { &self.scenario.name } else { &self.scenario.title };
            let text = format!("start: {title}, machine {machine}");
            self.events.push((at, text, TextLogLevel::INFO, self.palette.ink));
        }
        let before = self.edits;
        while let Some(timed) = self.scenario.edits.get(self.edits).filter(|e| e.step <= frame.step) {
            self.events.push((at, timed.edit.title(), TextLogLevel::INFO, self.palette.drive(0)));
            self.edits += 1;
        }
        self.edits > before
    }

    /// Machine and workspaces, where they have changed.
    fn show(&mut self, at: Instant, run: &Run, frame: &Frame) -> Result<(), Stop> {
        let planes = run.planes().cloned();
        let same = |body: &Body| match (&body.planes, &planes) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (None, None) => true,
            _ => false,
        };
        // A run keeps its planes as long as it keeps its machine.
        let fresh = !self.body.as_ref().is_some_and(same);
        if fresh {
            self.show_machine(at, &Linkage::of(&run.scenario().machine), frame)?;
        }
        let Some(linkage) = self.body.as_ref().map(|b| b.linkage.clone()) else { return Ok(()) };
        let Some(planes) = planes else { return Ok(()) };
        if fresh {
            let b = self.area.as_ref().map_or(frame.b_reference, |a| a.b);
            let area = self.area.take().unwrap_or_else(|| Area::new(&self.root, b, None));
            self.show_area(at, &area, &planes, &linkage, false)?;
            self.area = Some(area);
        }
        let compare = run.scenario().compare_b;
        if fresh || compare != self.compared.as_ref().map(|a| a.b) {
            if let Some(mut old) = self.compared.take() {
                old.write(self.store)?;
                self.store.since(at, &old.path, &Clear::recursive())?;
            }
            if let Some(b) = compare {
                let mut area = Area::new(&self.root, b, self.area.as_ref());
                self.show_area(at, &area, &planes, &linkage, true)?;
                area.turn.push(at, planes.map().turn(b));
                area.label.push(at, format!("b = {b:.3} rad"));
                self.compared = Some(area);
            }
        }
        Ok(())
    }

    fn log(&mut self, at: Instant, path: &EntityPath, what: &dyn rerun::AsComponents) -> Result<(), Stop> {
        match self.lasting {
            true => self.store.fixed(path, what)?,
            false => self.store.since(at, path, what)?,
        }
        Ok(())
    }

    fn show_machine(&mut self, at: Instant, linkage: &Linkage, frame: &Frame) -> Result<(), Stop> {
        self.flush()?;
        let (palette, e) = (self.palette, frame.q.units());
        for solid in linkage.solids(&e, &palette) {
            let mesh = mesh_of(&linkage.model.meshes[solid.mesh], solid.colour);
            if let Some(name) = solid.name.strip_prefix("base/") {
                let path = under(&self.root, &format!("machine/base/{name}"));
                let [.., [x, y, z, _]] = solid.world_from_mesh;
                self.log(at, &path, &mesh)?;
                self.log(at, &path, &Transform3D::from_translation([x, y, z]))?;
            }
        }
        self.links.clear();
        for bar in linkage.bars() {
            let path = named(&self.root, "machine/link", &bar.name);
            let mesh = mesh_of(&linkage.model.meshes[bar.mesh], palette.drive(bar.drive));
            self.log(at, &path, &mesh)?;
            self.links.push((path, Vec::new(), Vec::new()));
        }
        let ring: Vec<_> =
            (0..=48).map(|i| point(unit(f64::from(i) * FRAC_PI_2 / 12.0) * (0.019 * linkage.reach()), 0.0)).collect();
        let line = |points: Vec<[f32; 3]>, width: f32, rgba| {
            LineStrips3D::new([points]).with_radii([Radius::new_ui_points(width)]).with_colors([colour(rgba)])
        };
        self.log(at, &under(&self.root, "target"), &line(ring, 1.1, palette.ink))?;
        self.body = Some(Body { linkage: linkage.clone(), planes: None });
        Ok(())
    }

    fn show_area(
        &mut self,
        at: Instant,
        area: &Area,
        planes: &Arc<Planes>,
        linkage: &Linkage,
        compared: bool,
    ) -> Result<(), Stop> {
        let palette = self.palette;
        let (fill, edge, width, lift) = match compared {
            false => (faded(palette.amber, 0.14), palette.amber, 0.9, 0.0),
            true => (faded(palette.dim, 0.09), faded(palette.dim, 0.6), 0.6, -0.004),
        };
        let z = linkage.floor() + lift * linkage.reach();
        let map = planes.map();
        let [first, second] = map.limits();
        let angle = |l: crate::reactionless::Limit, i: u32| l.min + (l.max - l.min) * f64::from(i) / f64::from(CELLS);
        let corners = (0..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| (i, j)));
        let positions = corners.map(|(i, j)| point(map.forward_unturned([angle(first, i), angle(second, j)]), z));
        let cells = (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| i * (CELLS + 1) + j));
        let triangles = cells.flat_map(|c| [[c, c + CELLS + 1, c + 1], [c + 1, c + CELLS + 1, c + CELLS + 2]]);
        let mesh = Mesh3D::new(positions).with_triangle_indices(triangles).with_albedo_factor(colour(fill).0);
        let loops = planes.boundary().turned(0.0).into_iter().map(|mut outline| {
            outline.extend(outline.first().copied());
            outline.into_iter().map(|[x, y]| point(Vector::new(x, y), z)).collect::<Vec<_>>()
        });
        let boundary = LineStrips3D::new(loops).with_radii([Radius::new_ui_points(width)]).with_colors([colour(edge)]);
        self.log(at, &area.path, &mesh)?;
        self.log(at, &under(&area.path, "boundary"), &boundary)?;
        let mid = |l: crate::reactionless::Limit, s: f64| l.min + s * (l.max - l.min);
        let label_at = point(map.forward_unturned([mid(first, 0.86), mid(second, 0.88)]), z);
        let words = Points3D::new([label_at])
            .with_radii([Radius::new_ui_points(0.5)])
            .with_colors([colour(if compared { palette.dim } else { palette.amber })])
            .with_show_labels(true);
        self.log(at, &under(&area.path, "label"), &words)?;
        if let Some(body) = &mut self.body {
            body.planes = Some(planes.clone());
        }
        Ok(())
    }

    /// Where everything is.
    fn place(&mut self, at: Instant, frame: &Frame) {
        let Some(Body { linkage, planes }) = &self.body else { return };
        let (e, b) = (frame.q.units(), frame.base.at);
        self.bodies.push(at);
        for (bar, (_, places, turns)) in linkage.bars().iter().zip(&mut self.links) {
            let (root, along, z) = bar.pose(&e);
            places.push(point(b + root, z));
            turns.push(turned(along));
        }
        self.joints.extend(linkage.pins(&e).map(|(p, z)| point(b + p, z)));
        let z = linkage.top();
        self.com.push(point(frame.com, z));
        self.tip.push(point(frame.tip, z));
        let turn = turned(unit(frame.base.angle));
        self.base.push(at, (point(b, 0.0), turn.0));
        let outside = match frame.target.reach {
            Reach::Outside { nearest, .. } => Some(nearest - frame.target.at),
            Reach::Inside | Reach::Carried => None,
        };
        self.target.push(at, point(frame.target.at, z));
        self.gap.push(at, outside.map(|d| point(d, 0.0)));
        if let (Some(planes), Some(area)) = (planes, &mut self.area) {
            area.turn.push(at, planes.map().turn(frame.b_reference));
            area.label.push(at, format!("b = {:.3} rad", frame.b_reference));
        }
    }

    /// What has happened.
    fn note(&mut self, at: Instant, frame: &Frame) {
        let ending = frame.step == self.last;
        let (reach, z) = self.body.as_ref().map_or((1.0, 0.0), |b| (b.linkage.reach(), b.linkage.top()));
        self.trail.push(|| point(frame.tip, z), ending);
        if ending || frame.step.is_multiple_of(self.reaction_every) {
            self.reactions.draw(at, frame, reach, z);
        }
        if frame.peaks.moment > self.moment_peak.1 {
            self.moment_peak = (at, frame.peaks.moment);
        }
        let was = self.phases.last;
        if was.is_some_and(|phase| phase != frame.phase) && frame.phase == Phase::Rest {
            let text = if was == Some(Phase::Motion) { "end of motion" } else { "at rest" };
            self.events.push((at, text.into(), TextLogLevel::INFO, self.palette.ink));
        }
        self.phases.push(at, frame.phase);
        let (kind, text) = match frame.target.reach {
            Reach::Inside => ("inside", "the target is inside the reactionless workspace".into()),
            Reach::Carried => ("carried", "the target turns with the workspace".into()),
            Reach::Outside { mending_b, .. } => {
                let mend = mending_b.map_or("no b reaches it".into(), |b| format!("b = {b:.3} rad would reach it"));
                ("outside", format!("the target is outside the reactionless workspace: {mend}"))
            }
        };
        if self.reach.replace(kind).is_some_and(|was| was != kind) {
            let level = if kind == "outside" { TextLogLevel::WARN } else { TextLogLevel::INFO };
            self.events.push((at, text, level, self.palette.amber));
        }
    }

    /// Writes what has gathered.
    fn flush(&mut self) -> Result<(), Stop> {
        let times = self.steps.columns();
        self.steps.clear();
        for (series, signal) in self.series.iter_mut().zip(self.table) {
            let columns = Scalars::new(std::mem::take(series)).columns_of_unit_batches()?;
            self.store.columns(&times, &under(&self.root, &format!("signals/{}", signal.path)), columns)?;
        }
        let times = self.bodies.columns();
        let rows = self.bodies.len();
        self.bodies.clear();
        for (path, places, turns) in &mut self.links {
            let pose = Transform3D::update_fields()
                .with_many_translation(std::mem::take(places))
                .with_many_quaternion(std::mem::take(turns));
            self.store.columns(&times, path, pose.columns_of_unit_batches()?)?;
        }
        let joints = std::mem::take(&mut self.joints);
        if let Some(pins) = joints.len().checked_div(rows) {
            let columns = Points3D::update_fields().with_positions(joints).columns(std::iter::repeat_n(pins, rows))?;
            self.store.columns(&times, &under(&self.root, "machine/joints"), columns)?;
        }
        for (name, points) in [("com", &mut self.com), ("end_effector", &mut self.tip)] {
            let columns = Points3D::update_fields().with_positions(std::mem::take(points)).columns_of_unit_batches()?;
            self.store.columns(&times, &under(&self.root, name), columns)?;
        }
        let (clock, poses) = self.base.take();
        let (places, turns): (Vec<_>, Vec<_>) = poses.into_iter().unzip();
        let pose = Transform3D::update_fields()
            .with_many_translation(places)
            .with_many_quaternion(turns.into_iter().map(rerun::Quaternion));
        self.write(&clock, "machine/base", pose.columns_of_unit_batches()?)?;
        let (clock, places) = self.target.take();
        let pose = Transform3D::update_fields().with_many_translation(places);
        self.write(&clock, "target", pose.columns_of_unit_batches()?)?;
        let (clock, gaps) = self.gap.take();
        let lengths: Vec<usize> = gaps.iter().map(|g| usize::from(g.is_some())).collect();
        let lines = LineStrips3D::new(gaps.into_iter().flatten().map(|d| [[0.0; 3], d]));
        self.write(&clock, "target/gap", lines.columns(lengths)?)?;
        for area in [&mut self.area, &mut self.compared].into_iter().flatten() {
            area.write(self.store)?;
        }
        self.reactions.write(self.store, &self.root)?;
        self.film.write(self.store, &under(&self.root, "view"))
    }

    fn write(
        &mut self,
        clock: &Clock,
        path: &str,
        columns: impl IntoIterator<Item = SerializedComponentColumn>,
    ) -> Result<(), Stop> {
        Ok(self.store.columns(&clock.columns(), &under(&self.root, path), columns)?)
    }

    /// A picture, when one is due.
    fn take_picture(&mut self, at: Instant, run: &Run, frame: &Frame, edited: bool) -> Result<(), Stop> {
        if !self.film.is_due(frame, self.scenario.step) {
            return Ok(());
        }
        if edited {
            self.stage = None;
        }
        let stage = self.stage.get_or_insert_with(|| Stage::of(run));
        self.film.take(at, stage, frame)?;
        if self.film.is_full() {
            self.film.write(self.store, &under(&self.root, "view"))?;
        }
        Ok(())
    }

    /// What is known only at the end.
    fn finish(mut self, frame: &Frame) -> Result<Peaks, Stop> {
        self.flush()?;
        let trail = std::mem::take(&mut self.trail.items);
        let path = LineStrips3D::new([trail]).with_radii([Radius::new_ui_points(0.9)]).with_colors([colour(mix(
            self.palette.ink,
            self.palette.dim,
            0.5,
        ))]);
        self.store.fixed(&under(&self.root, "end_effector/path"), &path)?;
        let (clock, phases) = self.phases.take();
        let states = StateChange::new().with_state(phases.into_iter().map(Phase::name));
        self.write(&clock, "phase", states.columns_of_unit_batches()?)?;
        self.write_events(frame)?;
        self.write_properties(frame)?;
        Ok(frame.peaks)
    }

    fn write_events(&mut self, frame: &Frame) -> Result<(), Stop> {
        let (palette, peaks) = (self.palette, frame.peaks);
        let (at, moment) = self.moment_peak;
        let quiet = peaks.is_reactionless();
        if !quiet {
            let text = format!("peak |n_B| {} N m", brief(moment));
            self.events.push((at, text, TextLogLevel::WARN, palette.reaction));
        }
        let end = Instant { step: frame.step, nanos: (1e9 * frame.time).round() as i64 };
        let torques: Vec<String> = peaks.torque.iter().map(|t| brief(*t)).collect();
        self.events.push((end, format!("peak |τ| {} N m", torques.join(", ")), TextLogLevel::INFO, palette.ink));
        let (level, rgba) =
            if quiet { (TextLogLevel::INFO, palette.zero) } else { (TextLogLevel::WARN, palette.reaction) };
        self.events.push((end, verdict(&peaks), level, rgba));
        let mut events = std::mem::take(&mut self.events);
        events.sort_by_key(|(at, ..)| at.step);
        let mut clock = Clock::default();
        events.iter().for_each(|(at, ..)| clock.push(*at));
        let columns = TextLog::update_fields()
            .with_many_text(events.iter().map(|e| format!("{}{}", self.prefix, e.1)))
            .with_many_level(events.iter().map(|e| e.2))
            .with_many_color(events.iter().map(|e| colour(e.3)));
        self.write(&clock, "events", columns.columns_of_unit_batches()?)
    }

    fn write_properties(&mut self, frame: &Frame) -> Result<(), Stop> {
        let (scenario, peaks) = (self.scenario, frame.peaks);
        let words = |text: String| [Text::from(text)];
        let numbers = |values: &[f64]| values.iter().copied().map(Scalar::from).collect::<Vec<_>>();
        let properties = AnyValues::default()
            .with_component::<Text>("title", words(scenario.title.clone()))
            .with_component::<Text>("version", words(env!("CARGO_PKG_VERSION").into()))
            .with_component::<Text>("verdict", words(verdict(&peaks)))
            .with_component::<Text>("scenario", words(scenario.to_toml()))
            .with_component::<Text>("machine", words(crate::machine::to_toml(&scenario.machine)))
            .with_component::<Scalar>("peak_torque", numbers(&peaks.torque))
            .with_component::<Scalar>("peak_base_force", numbers(&[peaks.force]))
            .with_component::<Scalar>("peak_base_moment", numbers(&[peaks.moment]));
        let path = EntityPath::properties() / EntityPathPart::new(scenario.name.as_str());
        Ok(self.store.fixed(&path, &properties)?)
    }
}

/// `reactionless: peak |n_B| 1.2e-15 N m, peak |f_B| 3.1e-14 N`.
fn verdict(peaks: &Peaks) -> String {
    let word = if peaks.is_reactionless() { "reactionless" } else { "not reactionless" };
    format!("{word}: peak |n_B| {} N m, peak |f_B| {} N", brief(peaks.moment), brief(peaks.force))
}

impl Area {
    /// Named by its b; a second one of the same b by another name.
    fn new(root: &EntityPath, b: f64, other: Option<&Self>) -> Self {
        let mut path = named(root, "workspace", &format!("{b:.3}"));
        if other.is_some_and(|other| other.path == path) {
            path = named(root, "workspace", &format!("{b:.3} compared"));
        }
        Self { path, b, turn: Track::new(), label: Track::new() }
    }

    fn write<W: Write>(&mut self, store: &mut Store<W>) -> Result<(), StoreError> {
        let (clock, turns) = self.turn.take();
        let turns = turns.into_iter().map(|turn| turned(unit(turn)));
        let pose = Transform3D::update_fields().with_many_quaternion(turns);
        store.columns(&clock.columns(), &self.path, pose.columns_of_unit_batches()?)?;
        let (clock, labels) = self.label.take();
        let words = Points3D::update_fields().with_labels(labels.iter().map(String::as_str));
        store.columns(&clock.columns(), &under(&self.path, "label"), words.columns_of_unit_batches()?)
    }
}
