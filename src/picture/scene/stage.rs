//! Makes the [`Scene`] of a run and a frame. A [`Stage`] holds the parts that do not change from frame to frame.

mod base;
mod limits;
mod measurements;
mod notes;
mod path;
mod pins;
mod reaction;
mod ring;
mod snap;
mod snapshots;
mod target;
mod turn_areas;
mod turning;
mod under;
mod workspace;

pub use base::PULL_STIFFNESS;
use turn_areas::TurnAreas;
pub use turn_areas::limit_words;
use workspace::WorkspaceParts;
pub use workspace::{OutlineQuery, OutlineSubject, Outlined, Workspace};

use std::sync::Arc;

use super::draft::DesignDrawing;
use super::exaggeration::DrawnFrame;
use super::framing::ViewContent;
use super::grid::Grid;
use super::linkage::LinkageModel;
use super::options::{Handle, ViewOptions};
use super::palette::{Palette, palette};
use super::pick::{DragAction, GrabPoint, LinkHold, Pick, Pivot};
use super::pointer::Pointer;
use super::{Measure, Mesh, Scene};
use base::BaseStage;
use limits::LimitArcs;
use path::PlannedPath;
use pins::Pins;
use ring::BaseRing;
use stillbase_mechanics::planar::{DriveAngles, UnitVectors, Vector, unit};
use stillbase_planning::pose_space::Planes;
use stillbase_query::{Queries, Shared};
use stillbase_session::Run;
use stillbase_session::scenario::TaskKind;
use stillbase_simulation::frame::Frame;
use stillbase_study::workshop::cut_of;

/// The parts of the machine's view that do not change from frame to frame.
#[derive(Clone, Debug)]
pub struct Stage {
    linkage: LinkageModel,
    base: BaseStage,
    reached: Reached,
    /// Indices of the meshes that fill the workspace.
    fills: Vec<usize>,
    /// Pose constant b of the workspace for comparison, rad.
    compared: Option<f64>,
    /// The ring that sets b, if the machine has a b and more than one drive.
    ring: Option<BaseRing>,
    plan: Option<PlannedPath>,
    /// Whether the run waits because its task is infeasible.
    waits: bool,
    /// Whether the target can be dragged.
    target_draggable: bool,
    /// Whether links can be dragged while the end effector stays.
    links_draggable: bool,
    pins: Pins,
    limits: LimitArcs,
    grid: Grid,
}

/// Opacity of areas that are those of another start.
const KEPT_OPACITY: f32 = 0.4;

/// What the end effector reaches.
#[derive(Clone, Debug)]
enum Reached {
    /// Nothing is drawn.
    None,
    /// Its outline is not yet computed; areas of another start are shown until then, dimmed.
    Wanted(OutlineSubject, Option<Arc<TurnAreas>>),
    /// Its outline is known.
    Done(Outlined),
}

impl Reached {
    /// Returns the workspace at once for a machine with planes; otherwise its outline is still to be computed. Without a
    /// b, this is what zero momentum reaches, if the task asks for that.
    fn of(run: &Run) -> Self {
        let Ok(space) = run.pose_space() else {
            let scenario = run.scenario();
            let rays = (scenario.task.kind == TaskKind::ZeroMomentum).then(|| run.rays().ok()).flatten();
            let subject = |rays| OutlineSubject::Turns(Shared(Arc::new(rays)), scenario.base.floats());
            return rays.map_or(Self::None, |rays| Self::Wanted(subject(rays), None));
        };
        match Workspace::known(space) {
            Some(known) => Self::Done(Outlined::Held(Arc::new(known))),
            None => Self::Wanted(OutlineSubject::Held(Shared(space.clone())), None),
        }
    }
}

impl Stage {
    /// Prepares a run for drawing; to be repeated when its machine or plan changes.
    pub fn of(run: &Run) -> Self {
        let mut stage = Self::begun(run);
        stage.finish(run.queries());
        stage
    }

    /// Computes the outline of the workspace, if it is not yet known.
    pub fn finish(&mut self, queries: &Queries) {
        if let Some(subject) = self.unoutlined() {
            self.set_outline(Option::clone(&queries.ask::<OutlineQuery>(&subject)));
        }
    }

    /// Prepares a run for drawing. It leaves a workspace outline that takes long to compute to
    /// [`finish`](Self::finish).
    pub fn begun(run: &Run) -> Self {
        let model = &run.scenario().machine;
        // If the plant has other lengths than the model, the plant is drawn.
        let plant = run.scenario().plant.machine(model).unwrap_or_else(|_| model.clone());
        let linkage = LinkageModel::cut(&plant, &cut_of(&run.scenario().design, &plant));
        let (compared, space) = (run.scenario().compare_b, run.pose_space().ok());
        Self {
            base: BaseStage::of(run, &plant, &linkage),
            reached: Reached::of(run),
            fills: Vec::new(),
            compared,
            ring: space
                .filter(|space| !space.joints().is_empty())
                .map(|space| BaseRing::of(space, ring_radius(&linkage))),
            plan: PlannedPath::of(run, linkage.top()),
            waits: run.waiting().is_some(),
            target_draggable: run.can_be_led(),
            links_draggable: run.waiting().is_none() && space.is_some_and(|space| space.leaves_freedoms()),
            pins: Pins::of(&plant),
            limits: LimitArcs::of(model, &linkage),
            grid: Grid::of(&linkage),
            linkage,
        }
    }

    /// Returns the stage without workspace and ring, for a run that does not follow a target.
    #[must_use]
    pub fn without_workspace(self) -> Self {
        Self { ring: None, reached: Reached::None, ..self }
    }

    /// Returns the workspace for constant b, once its outline is known.
    pub fn outlined(&self) -> Option<&Workspace> {
        match &self.reached {
            Reached::Done(Outlined::Held(workspace)) => Some(workspace),
            _ => None,
        }
    }

    /// Returns what is still to be outlined.
    pub fn unoutlined(&self) -> Option<OutlineSubject> {
        match &self.reached {
            Reached::Wanted(subject, _) => Some(subject.clone()),
            _ => None,
        }
    }

    /// Returns whether it shows what is reached as the base turns a little.
    pub fn has_turn_areas(&self) -> bool {
        matches!(self.reached, Reached::Done(Outlined::Turns(_)))
    }

    /// Sets the outline of what the end effector reaches; `None` if there is none.
    pub fn set_outline(&mut self, outline: Option<Outlined>) {
        let mut add = |mesh: &Mesh| self.linkage.add(mesh.clone());
        self.fills = match &outline {
            Some(Outlined::Held(workspace)) => workspace.fill().map(&mut add).into_iter().collect(),
            Some(Outlined::Turns(areas)) => areas.fills().map(&mut add).collect(),
            None => Vec::new(),
        };
        self.reached = outline.map_or(Reached::None, Reached::Done);
    }

    /// Shows the last areas of the same craft until those of this start are known, as while a point is dragged.
    pub(super) fn keep_outline(&mut self, last: &Outlined) {
        let Outlined::Turns(areas) = last else { return };
        if let Reached::Wanted(OutlineSubject::Turns(rays, _), kept) = &mut self.reached
            && areas.is_of(rays.0.model())
        {
            *kept = Some(areas.clone());
            self.fills = areas.fills().map(|mesh| self.linkage.add(mesh.clone())).collect();
        }
    }

    fn planes(&self) -> Option<&Planes> {
        self.outlined()?.planes()
    }

    /// Updates base and payload from a run.
    pub fn refresh(&mut self, run: &Run) {
        self.base.refresh(run);
    }

    /// Width of the grid under the machine, m.
    pub fn grid_width(&self) -> f64 {
        self.grid.width()
    }

    /// Returns the meshes of the machine, and their placement in a pose.
    pub fn linkage(&self) -> &LinkageModel {
        &self.linkage
    }

    /// Values of a measure of dexterity at both ends of its colour scale.
    pub fn shaded(&self, measure: Measure) -> [f64; 2] {
        self.outlined().and_then(|workspace| workspace.shaded(measure)).unwrap_or([0.0, 1.0])
    }

    /// Radius of the b ring, m.
    pub fn ring_radius(&self) -> f64 {
        ring_radius(&self.linkage)
    }

    /// Height of the plane in which handles lie, m.
    pub fn handle_height(&self) -> f64 {
        self.linkage.top()
    }

    /// Returns the drawn position of a handle, m; `None` if it is not shown.
    pub fn handle(&self, handle: Handle, shown: &DrawnFrame<'_>) -> Option<[f64; 3]> {
        let z = self.handle_height();
        match handle {
            Handle::EndEffector if self.waits => None,
            // The point of the path below it is picked instead.
            Handle::Target if !self.target_draggable => None,
            Handle::Target => Some([shown.target.re, shown.target.im, z]),
            Handle::Ring => {
                let p = self.ring.as_ref()?.knob(shown);
                Some([p.re, p.im, z])
            }
            Handle::EndEffector => Some([shown.end_effector.re, shown.end_effector.im, z]),
            Handle::Waypoint(i) => {
                let (.., p) = self.plan.as_ref()?.waypoints.iter().find(|(number, ..)| *number == i)?;
                Some([p.re, p.im, z])
            }
            Handle::Payload => self.payload(shown).map(|p| [p.re, p.im, z]),
            _ => None,
        }
    }

    /// Returns the picks of all joint limits at their drawn positions.
    pub fn limits<'a>(&'a self, shown: &'a DrawnFrame<'a>) -> impl Iterator<Item = Pick> + 'a {
        self.limits.ends(&self.linkage, shown)
    }

    /// Returns both limits of a relative angle, rad, with the lower (0) or upper (1) one dragged to the pointer.
    pub fn limit_pulled(&self, limit: (usize, usize), pivot: &Pivot, pointer: &Pointer) -> Option<[f64; 2]> {
        self.limits.pulled(limit, pivot, self.handle_height(), pointer)
    }

    /// Converts a drawn position of the centre of mass of the payload, m, to offsets along and across the link that
    /// holds it, m.
    pub fn load_offset(&self, shown: &DrawnFrame<'_>, at: [f64; 2]) -> [f64; 2] {
        self.base.offset_at(shown, Vector::new(at[0], at[1]))
    }

    /// Returns the drawn position of the payload, m, while the machine holds it.
    pub fn payload(&self, shown: &DrawnFrame<'_>) -> Option<Vector> {
        self.base.load_at(shown)
    }

    /// Returns the index of the link under the pointer; the uppermost of several.
    pub fn link_at(&self, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<usize> {
        under::link(&self.linkage, shown, pointer)
    }

    /// Picks the link under the pointer, if it can be rotated on a plane, or dragged while the end effector stays.
    pub fn grip(&self, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Pick> {
        if self.links_draggable {
            let i = self.link_at(shown, pointer)?;
            return turning::hook(i, self.linkage.bars().get(i)?, shown, pointer);
        }
        let planes = self.planes().filter(|_| self.target_draggable)?;
        let (i, map) = (self.link_at(shown, pointer)?, planes.map());
        turning::grip(i, self.linkage.bars().get(i)?, map, shown, pointer)
    }

    /// Returns the angles (a_1, a_2), rad, on the plane b for which the link follows the pointer, as far as the joint
    /// limits allow.
    pub fn turned(
        &self,
        link: usize,
        grip: &LinkHold,
        shown: &DrawnFrame<'_>,
        pointer: &Pointer,
        b: f64,
    ) -> Option<[f64; 2]> {
        let map = self.planes()?.map();
        turning::turned(self.linkage.bars().get(link)?, grip, map, shown, pointer, b)
    }

    /// Returns the change requested by dragging a link while the end effector stays.
    pub fn pulled(
        &self,
        link: usize,
        hook: &GrabPoint,
        shown: &DrawnFrame<'_>,
        pointer: &Pointer,
    ) -> Option<DragAction> {
        turning::pulled(link, self.linkage.bars().get(link)?, hook, shown, pointer)
    }

    /// Returns the item under the pointer that gives information; the uppermost of several.
    pub fn under(&self, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Handle> {
        let load = || self.base.load_at(shown).filter(|at| under::payload(*at, &self.linkage, pointer));
        let known = || self.outlined().filter(|workspace| workspace.planes().is_some());
        let edge = || known().filter(|w| under::line(&w.edge(shown, self.linkage.floor()), pointer));
        load()
            .map(|_| Handle::Payload)
            .or_else(|| under::reaction(&self.linkage, shown, pointer))
            .or_else(|| under::joint(&self.linkage, shown, pointer).map(Handle::Joint))
            .or_else(|| self.link_at(shown, pointer).map(Handle::Link))
            .or_else(|| under::base(&self.linkage, self.base.moves(), shown, pointer).then_some(Handle::Base))
            .or_else(|| edge().map(|_| Handle::Boundary))
    }

    /// Returns the b, rad, of a drawn position of the knob, m; of all b that differ by full turns, the nearest to
    /// `near`.
    pub fn ring_b(&self, at: [f64; 2], near: f64, shown: &DrawnFrame<'_>) -> Option<f64> {
        Some(self.ring.as_ref()?.b(Vector::new(at[0], at[1]), near, shown))
    }

    /// Returns the drawn ends of all links, and the target, m.
    pub fn outline<'a>(&'a self, shown: &'a DrawnFrame<'a>) -> impl Iterator<Item = [f64; 3]> + 'a {
        let (units, at, target) = (shown.q.units(), shown.base.at, shown.target);
        let ends = self.linkage.bars().iter().flat_map(move |bar| bar.ends(&units));
        let target = [target.re, target.im, self.handle_height()];
        ends.map(move |[x, y, z]| [at.re + x, at.im + y, z]).chain([target])
    }

    /// Returns the indices of the points of the planned path that can be dragged, A first.
    pub fn waypoints(&self) -> impl Iterator<Item = usize> + '_ {
        self.plan.iter().flat_map(|plan| plan.waypoints.iter().map(|(i, ..)| *i))
    }

    /// Returns the points that the camera has to show: the machine in its present and in other poses, its workspace
    /// and its task. Optional points are those of the workspace for comparison.
    pub fn content(&self, frame: &Frame, poses: &[DriveAngles]) -> ViewContent {
        let (base, z) = (frame.base, self.handle_height());
        let on_base = |p: Vector| base.at + unit(base.angle) * p;
        let links = poses.iter().chain([&frame.q]).flat_map(|q| {
            let e = q.units();
            self.linkage.bars().iter().flat_map(move |bar| bar.ends(&e))
        });
        let links = links.map(|[x, y, z]| (on_base(Vector::new(x, y)), z));
        let discs = poses.iter().chain([&frame.q]).flat_map(|q| self.discs(&q.units()));
        let discs = discs.map(|p| (on_base(p), z));
        let workspace = |b: f64| {
            let points = match &self.reached {
                Reached::Done(Outlined::Held(workspace)) => workspace.points(b, frame),
                Reached::Done(Outlined::Turns(areas)) => areas.points(base),
                Reached::None | Reached::Wanted(..) => Vec::new(),
            };
            points.into_iter().map(|p| (p, self.linkage.floor()))
        };
        let waypoints = self.plan.iter().flat_map(|plan| plan.waypoints.iter().map(|(_, _, p)| (*p, z)));
        let plate = self.base.corners(&self.linkage).into_iter().map(|p| (on_base(p), 0.0));
        let target = [(DrawnFrame::from(frame).target, z), (base.at, 0.0)];
        let points = |(p, z): (Vector, f64)| [p.re, p.im, z];
        ViewContent {
            first: links
                .chain(discs)
                .chain(workspace(frame.b_reference))
                .chain(waypoints)
                .chain(target)
                .map(points)
                .collect(),
            then: self.compared.into_iter().flat_map(workspace).chain(plate).map(points).collect(),
        }
    }

    /// Returns the outermost points of the discs of counterweights on both axes, at the units of the drives.
    fn discs(&self, units: &UnitVectors) -> impl Iterator<Item = Vector> + use<> {
        let discs = self.linkage.flat(units).into_iter().flat_map(|flat| flat.covers);
        let discs = discs.flat_map(|weight| weight.ends.map(|end| (end, weight.radius)));
        discs.flat_map(|(p, r)| [[r, 0.0], [-r, 0.0], [0.0, r], [0.0, -r]].map(|[x, y]| p + Vector::new(x, y)))
    }

    /// Returns the points that the camera has to show for the machine alone.
    pub fn body(&self, frame: &Frame) -> ViewContent {
        let (e, at) = (frame.q.units(), frame.base.at);
        let ends = self.linkage.bars().iter().flat_map(|bar| bar.ends(&e));
        let ends = ends.map(|[x, y, z]| [x + at.re, y + at.im, z]);
        let discs = self.discs(&e).map(|p| [p.re + at.re, p.im + at.im, 0.0]);
        ViewContent { first: ends.chain(discs).collect(), then: Vec::new() }
    }

    /// Returns the scene of a frame.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions) -> Scene {
        let palette = palette(options.theme);
        let shown = &DrawnFrame::of(frame, options.exaggeration);
        let (linkage, z) = (&self.linkage, self.handle_height());
        let mut scene = Scene::new(palette.background, linkage.model.clone());
        scene.notation = options.notation;
        self.bodies(&mut scene, &palette, shown, options);
        self.grid.draw(&mut scene, &palette);
        self.base.unmoved(&mut scene, linkage, &palette, shown, options.exaggeration.factor());
        self.base.draw(&mut scene, linkage, &palette, shown);
        match &self.reached {
            Reached::Done(Outlined::Held(workspace)) => {
                let parts = WorkspaceParts { fill: self.fills.first().copied(), compared_b: self.compared };
                workspace.draw(&mut scene, linkage, &palette, shown, options, parts);
            }
            Reached::Done(Outlined::Turns(areas)) => {
                areas.draw(&mut scene, linkage, &palette, shown, (&self.fills, 1.0))
            }
            Reached::Wanted(_, Some(areas)) => {
                areas.draw(&mut scene, linkage, &palette, shown, (&self.fills, KEPT_OPACITY));
            }
            Reached::None | Reached::Wanted(_, None) => {}
        }
        if let Some(ring) = &self.ring {
            ring.draw(&mut scene, &palette, shown, options, z);
        }
        if let Some(plan) = &self.plan {
            plan.draw(&mut scene, &palette, options);
        }
        snapshots::snapshots(&mut scene, linkage, &palette, options);
        snapshots::others(&mut scene, linkage, &palette, options);
        let blocked = self.plan.as_ref().and_then(PlannedPath::blocked);
        path::draw_user_curves(&mut scene, &palette, options, blocked, z);
        reaction::draw(
            &mut scene,
            linkage,
            &palette,
            shown,
            options,
            (self.base.static_force_name(options), self.base.feels_more_than_n_b()),
        );
        if options.pin_forces {
            self.pins.draw(&mut scene, linkage, &palette, shown);
        }
        if options.limits {
            self.limits.draw(&mut scene, linkage, &palette, shown, options.highlighted);
        }
        target::draw(&mut scene, &palette, shown, options, z);
        self.base.load(&mut scene, linkage, &palette, shown, options);
        self.draw_measurements(&mut scene, &palette, shown, options);
        self.draw_notes(&mut scene, &palette, shown, options);
        scene
    }

    /// Draws the machine, and as translucent links its pose at the start and its poses on a previewed plane.
    fn bodies(&self, scene: &mut Scene, palette: &Palette, shown: &DrawnFrame<'_>, options: &ViewOptions) {
        if let Some(plan) = self.plan.as_ref().filter(|plan| !plan.waits()) {
            scene.solids.extend(self.linkage.ghost("plan/start", &plan.start, palette, 0.16));
        }
        if let (Some(b), Some(planes)) = (options.preview_b, self.planes()) {
            let map = planes.map();
            let p =
                self.plan.as_ref().and_then(|plan| plan.start_point).unwrap_or_else(|| shown.frame.target_in_base());
            for pose in map.poses(p, b).iter() {
                let q = DriveAngles::from(map.lift(*pose));
                scene.solids.extend(self.linkage.ghost("preview", &q.units(), palette, 0.34));
            }
        }
        let units = shown.q.units();
        scene.bodies.extend(self.linkage.bodies(&units, shown.base, self.base.moves()));
        let mut solids = self.linkage.solids(&units, shown.base, self.base.moves(), palette);
        under::light(&mut solids, &self.linkage, options.highlighted, palette);
        scene.solids.extend(solids);
        scene.lines.extend(self.linkage.threads(&units, shown.base.at, palette));
        if options.shadows {
            scene.shadows.extend(self.linkage.shadows(&units, shown.base.at));
        }
    }

    /// Returns the scene of the design view.
    pub fn drafted(&self, draft: &DesignDrawing, frame: &Frame, options: &ViewOptions) -> Scene {
        draft.scene((&self.linkage, &self.grid), frame, options)
    }
}

/// Radius of the b ring, m.
fn ring_radius(linkage: &LinkageModel) -> f64 {
    0.118 * linkage.reach()
}
