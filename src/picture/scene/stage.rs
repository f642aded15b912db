//! From a run and a frame to a [`Scene`]. A [`Stage`] holds what does not change from frame to frame.

mod base;
mod limits;
mod path;
mod pins;
mod reaction;
mod ring;
mod snapshots;
mod target;
mod turning;
mod under;
mod workspace;

pub use base::PULL;
pub use workspace::{Outlining, Workspace};

use std::sync::Arc;

use super::draft::Draft;
use super::exaggeration::Shown;
use super::framing::Content;
use super::grid::Grid;
use super::linkage::Linkage;
use super::options::{Handle, ViewOptions};
use super::palette::{Palette, palette};
use super::pick::{Aim, Hold, Hook, Pick, Pivot};
use super::pointer::Pointer;
use super::{Measure, Scene, point};
use crate::mechanics::planar::{DriveAngles, Vector, unit};
use crate::planning::pose_space::{Planes, PoseSpace};
use crate::query::{Queries, Shared};
use crate::session::Run;
use crate::simulation::frame::Frame;
use base::BaseStage;
use limits::Limits;
use path::Plan;
use pins::Pins;
use ring::Ring;

/// What stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct Stage {
    linkage: Linkage,
    base: BaseStage,
    reached: Reached,
    /// The mesh that fills it.
    fill: Option<usize>,
    /// The b to compare with, rad.
    compared: Option<f64>,
    /// Of a machine with a b to turn.
    ring: Option<Ring>,
    plan: Option<Plan>,
    /// Whether the run waits, and whether a hand can lead the machine.
    waits: bool,
    follows: bool,
    /// Whether links are pulled while the end effector stays.
    holds: bool,
    pins: Pins,
    limits: Limits,
    grid: Grid,
}

/// What is reached while b is held.
#[derive(Clone, Debug)]
enum Reached {
    /// There is none.
    None,
    /// Its outline is yet to be found.
    Wanted(Arc<PoseSpace>),
    /// Here it is.
    Done(Arc<Workspace>),
}

impl Reached {
    /// Of a pose space: planes know it at once.
    fn of(space: &Arc<PoseSpace>) -> Self {
        Workspace::known(space).map_or_else(|| Self::Wanted(space.clone()), |known| Self::Done(Arc::new(known)))
    }
}

impl Stage {
    /// Prepares a run for drawing; to be made again when its machine or plan changes.
    pub fn of(run: &Run) -> Self {
        let mut stage = Self::begun(run);
        stage.finish(run.queries());
        stage
    }

    /// Finds the outline, where it is still wanted.
    pub fn finish(&mut self, queries: &Queries) {
        if let Some(space) = self.unoutlined() {
            self.set_outline(Option::clone(&queries.ask::<Outlining>(&Shared(space))));
        }
    }

    /// The same but for an outline of what is reached that takes longer.
    pub fn begun(run: &Run) -> Self {
        let model = &run.scenario().machine;
        // A machine with other lengths is drawn as it is.
        let plant = run.scenario().plant.machine(model).unwrap_or_else(|_| model.clone());
        let linkage = Linkage::of(&plant);
        let (compared, space) = (run.scenario().compare_b, run.pose_space().ok());
        Self {
            base: BaseStage::of(run, &plant, &linkage),
            reached: space.map_or(Reached::None, Reached::of),
            fill: None,
            compared,
            ring: space.filter(|space| !space.joints().is_empty()).map(|space| Ring::of(space, ring_radius(&linkage))),
            plan: Plan::of(run, linkage.top()),
            waits: run.waiting().is_some(),
            follows: run.waiting().is_none() && space.is_some(),
            holds: run.waiting().is_none() && space.is_some_and(|space| space.leaves_freedoms()),
            pins: Pins::of(&plant),
            limits: Limits::of(model, &linkage),
            grid: Grid::of(&linkage),
            linkage,
        }
    }

    /// The same without a workspace, for a run that is led otherwise.
    #[must_use]
    pub fn without_workspace(self) -> Self {
        Self { ring: None, reached: Reached::None, ..self }
    }

    /// What is reached while b is held, once it is found.
    pub fn outlined(&self) -> Option<&Workspace> {
        match &self.reached {
            Reached::Done(workspace) => Some(workspace),
            _ => None,
        }
    }

    /// What is yet to be outlined.
    pub fn unoutlined(&self) -> Option<Arc<PoseSpace>> {
        match &self.reached {
            Reached::Wanted(space) => Some(space.clone()),
            _ => None,
        }
    }

    /// Takes the outline of what was yet to be outlined.
    pub fn set_outline(&mut self, outline: Option<Arc<Workspace>>) {
        let fill = outline.as_ref().and_then(|outline| outline.fill());
        self.fill = fill.map(|mesh| self.linkage.add(mesh.clone()));
        self.reached = outline.map_or(Reached::None, Reached::Done);
    }

    fn planes(&self) -> Option<&Planes> {
        self.outlined()?.planes()
    }

    /// Takes over what has changed of base and payload.
    pub fn refresh(&mut self, run: &Run) {
        self.base.refresh(run);
    }

    /// Width of the grid under the machine, m.
    pub fn grid_width(&self) -> f64 {
        self.grid.width()
    }

    /// The machine's body.
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// From where to where a measure of dexterity is shaded.
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

    /// Where a handle is drawn, m.
    pub fn handle(&self, handle: Handle, shown: &Shown<'_>) -> Option<[f64; 3]> {
        let z = self.handle_height();
        match handle {
            Handle::EndEffector if self.waits => None,
            // The point of the path under it is held instead.
            Handle::Target if !self.follows => None,
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

    /// The ends of the joint limits as they are drawn, to be taken hold of.
    pub fn limits<'a>(&'a self, shown: &'a Shown<'a>) -> impl Iterator<Item = Pick> + 'a {
        self.limits.ends(&self.linkage, shown)
    }

    /// Both limits of a relative angle, rad, with one end (0 or 1) pulled to the pointer.
    pub fn limit_pulled(&self, limit: (usize, usize), pivot: &Pivot, pointer: &Pointer) -> Option<[f64; 2]> {
        self.limits.pulled(limit, pivot, self.handle_height(), pointer)
    }

    /// Where the payload's centre of mass is, seen along and across the link that holds it, m, if it is brought to a
    /// place.
    pub fn load_offset(&self, shown: &Shown<'_>, at: [f64; 2]) -> [f64; 2] {
        self.base.offset_at(shown, Vector::new(at[0], at[1]))
    }

    /// Where the payload is drawn, m, while it is held.
    pub fn payload(&self, shown: &Shown<'_>) -> Option<Vector> {
        self.base.load_at(shown)
    }

    /// The number of the link under the pointer; the uppermost of several.
    pub fn link_at(&self, shown: &Shown<'_>, pointer: &Pointer) -> Option<usize> {
        under::link(&self.linkage, shown, pointer)
    }

    /// The link under the pointer, taken hold of, on a machine that has planes to turn it on, or freedoms to pull it in.
    pub fn grip(&self, shown: &Shown<'_>, pointer: &Pointer) -> Option<Pick> {
        if self.holds {
            let i = self.link_at(shown, pointer)?;
            return turning::hook(i, self.linkage.bars().get(i)?, shown, pointer);
        }
        let planes = self.planes().filter(|_| self.follows)?;
        let (i, map) = (self.link_at(shown, pointer)?, planes.map());
        turning::grip(i, self.linkage.bars().get(i)?, map, shown, pointer)
    }

    /// The angles (a_1, a_2), rad, at which a link points where the pointer pulls it, on the plane b; as near to that as
    /// the joint limits let it.
    pub fn turned(&self, link: usize, grip: &Hold, shown: &Shown<'_>, pointer: &Pointer, b: f64) -> Option<[f64; 2]> {
        let map = self.planes()?.map();
        turning::turned(self.linkage.bars().get(link)?, grip, map, shown, pointer, b)
    }

    /// Where the pointer pulls a link while the end effector stays.
    pub fn pulled(&self, link: usize, hook: &Hook, shown: &Shown<'_>, pointer: &Pointer) -> Option<Aim> {
        turning::pulled(link, self.linkage.bars().get(link)?, hook, shown, pointer)
    }

    /// What is under the pointer that cannot be pulled at; the uppermost of several.
    pub fn under(&self, shown: &Shown<'_>, pointer: &Pointer) -> Option<Handle> {
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

    /// The b that a place of the ring's knob as it is drawn stands for, nearest to the present one, rad.
    pub fn ring_b(&self, at: [f64; 2], near: f64, shown: &Shown<'_>) -> Option<f64> {
        Some(self.ring.as_ref()?.b(Vector::new(at[0], at[1]), near, shown))
    }

    /// The ends of all links as they are drawn, and the target: what a hand wants to see.
    pub fn outline<'a>(&'a self, shown: &'a Shown<'a>) -> impl Iterator<Item = [f64; 3]> + 'a {
        let (units, at, target) = (shown.q.units(), shown.base.at, shown.target);
        let ends = self.linkage.bars().iter().flat_map(move |bar| bar.ends(&units));
        let target = [target.re, target.im, self.handle_height()];
        ends.map(move |[x, y, z]| [at.re + x, at.im + y, z]).chain([target])
    }

    /// Points of the planned path that can be dragged: their numbers, A first.
    pub fn waypoints(&self) -> impl Iterator<Item = usize> + '_ {
        self.plan.iter().flat_map(|plan| plan.waypoints.iter().map(|(i, ..)| *i))
    }

    /// What is to be seen when everything is shown: the machine as it stands and in other poses, its workspace, its
    /// task; and the workspace to compare with.
    pub fn content(&self, frame: &Frame, poses: &[DriveAngles]) -> Content {
        let (base, z) = (frame.base, self.handle_height());
        let on_base = |p: Vector| base.at + unit(base.angle) * p;
        let links = poses.iter().chain([&frame.q]).flat_map(|q| {
            let e = q.units();
            self.linkage.bars().iter().flat_map(move |bar| bar.ends(&e))
        });
        let links = links.map(|[x, y, z]| (on_base(Vector::new(x, y)), z));
        let workspace = |b: f64| {
            let points = self.outlined().map_or_else(Vec::new, |workspace| workspace.points(b, frame));
            points.into_iter().map(|p| (p, self.linkage.floor()))
        };
        let waypoints = self.plan.iter().flat_map(|plan| plan.waypoints.iter().map(|(_, _, p)| (*p, z)));
        let target = [(Shown::from(frame).target, z), (base.at, 0.0)];
        let points = |(p, z): (Vector, f64)| [p.re, p.im, z];
        Content {
            first: links.chain(workspace(frame.b_reference)).chain(waypoints).chain(target).map(points).collect(),
            then: self.compared.into_iter().flat_map(workspace).map(points).collect(),
        }
    }

    /// What is to be seen of the machine alone.
    pub fn body(&self, frame: &Frame) -> Content {
        let (e, at) = (frame.q.units(), frame.base.at);
        let ends = self.linkage.bars().iter().flat_map(|bar| bar.ends(&e));
        let ends = ends.map(|[x, y, z]| [x + at.re, y + at.im, z]);
        let discs = self.linkage.flat(&e).into_iter().flat_map(|flat| flat.weights);
        let discs = discs.flat_map(|(p, radius)| [1.0, -1.0].map(|s| (p + at, s * radius)));
        let discs = discs.flat_map(|(p, r)| [[p.re + r, p.im, 0.0], [p.re, p.im + r, 0.0]]);
        Content { first: ends.chain(discs).collect(), then: Vec::new() }
    }

    /// Everything there is to draw.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions) -> Scene {
        let palette = palette(options.theme);
        let shown = &Shown::of(frame, options.exaggeration);
        let (linkage, z) = (&self.linkage, self.handle_height());
        let mut scene = Scene::new(palette.background, linkage.model.clone());
        self.bodies(&mut scene, &palette, shown, options);
        self.grid.draw(&mut scene, &palette);
        self.base.unmoved(&mut scene, linkage, &palette, shown, options.exaggeration.times());
        self.base.draw(&mut scene, linkage, &palette, shown);
        if let Some(workspace) = self.outlined() {
            workspace.draw(&mut scene, (linkage, self.fill), &palette, shown, (options, self.compared));
        }
        if let Some(ring) = &self.ring {
            ring.draw(&mut scene, &palette, shown, options, z);
        }
        if let Some(plan) = &self.plan {
            plan.draw(&mut scene, &palette, options);
        }
        snapshots::snapshots(&mut scene, linkage, &palette, options);
        snapshots::others(&mut scene, linkage, &palette, options);
        let blocked = self.plan.as_ref().and_then(Plan::blocked);
        path::by_hand(&mut scene, &palette, options, blocked, z);
        reaction::draw(&mut scene, linkage, &palette, shown, options, self.base.rest(options));
        if options.pin_forces {
            self.pins.draw(&mut scene, linkage, &palette, shown);
        }
        if options.limits {
            self.limits.draw(&mut scene, linkage, &palette, shown, options.hot);
        }
        target::draw(&mut scene, &palette, shown, options, z);
        self.base.load(&mut scene, linkage, &palette, shown, options);
        scene
    }

    /// The machine, and pale where it begins and where it would be on another plane.
    fn bodies(&self, scene: &mut Scene, palette: &Palette, shown: &Shown<'_>, options: &ViewOptions) {
        if let Some(plan) = self.plan.as_ref().filter(|plan| !plan.waits()) {
            scene.solids.extend(self.linkage.ghost("plan/start", &plan.start, palette, 0.16));
        }
        if let (Some(b), Some(planes)) = (options.preview_b, self.planes()) {
            let map = planes.map();
            let p = self.plan.as_ref().and_then(|plan| plan.begins).unwrap_or(shown.frame.target.at);
            for pose in map.poses(p, b).iter() {
                let q = DriveAngles::from(map.lift(*pose));
                scene.solids.extend(self.linkage.ghost("preview", &q.units(), palette, 0.34));
            }
        }
        let units = shown.q.units();
        let seen = |[x, y, z]: [f64; 3]| point(shown.base.at + Vector::new(x, y), z);
        scene.bars.extend(self.linkage.bars().iter().map(|bar| bar.ends(&units).map(seen)));
        let mut solids = self.linkage.solids(&units, shown.base, self.base.moves(), palette);
        under::light(&mut solids, &self.linkage, options.hot, palette);
        scene.solids.extend(solids);
        if options.shadows {
            scene.shadows.extend(self.linkage.shadows(&units, shown.base.at));
        }
    }

    /// The machine as it is designed.
    pub fn drafted(&self, draft: &Draft, frame: &Frame, options: &ViewOptions) -> Scene {
        draft.scene((&self.linkage, &self.grid), frame, options)
    }
}

/// Radius of the b ring, m.
fn ring_radius(linkage: &Linkage) -> f64 {
    0.118 * linkage.reach()
}
