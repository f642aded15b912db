//! The linked views of one run: the machine from above and in space, joint space, and the tower of workspaces. What is
//! pulled at in one of them is asked of the session, so all of them follow.

use std::sync::Arc;

use super::Scene;
use super::camera::Camera;
use super::draft::Draft;
use super::exaggeration::Shown;
use super::framing::Content;
use super::joints::Joints;
use super::options::{Handle, ViewOptions};
use super::pick::{Aim, Grip, NEAR, Pick};
use super::pointer::Pointer;
use super::stage::{Outlining, PULL, Stage, Workspace};
use super::tower::Tower;
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::DriveAngles;
use crate::planning::pose_space::PoseSpace;
use crate::query::{Asking, Queries, Quick, Same, Shared, Whole};
use crate::session::Run;
use crate::settings::number::Short;
use crate::simulation::frame::Frame;

/// How near to a handle the pointer takes hold of it, px: a point of the path or the end of a limit, and a payload.
const NEAR_POINT: f64 = 9.0;
const NEAR_LOAD: f64 = 12.0;

/// How far to the left of a point its name stands, px, and how far above a payload its mass.
const NAME: f64 = 17.0;
const MASS: f64 = 22.0;

/// Radius of the target's ring, px.
const RING: f64 = 14.0;

/// A payload nearer to the end effector than this part of the reach hangs at it.
const AT_TIP: f64 = 0.015;

/// One of the views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ViewKind {
    /// The machine from straight above.
    #[default]
    Flat,
    /// The machine in perspective.
    Space,
    /// Joint space with its planes.
    Joints,
    /// All reactionless workspaces, b as height.
    Tower,
    /// The machine's masses and lengths, to be changed.
    Design,
}

impl ViewKind {
    /// In the order of the switch.
    pub const ALL: [Self; 5] = [Self::Flat, Self::Space, Self::Joints, Self::Tower, Self::Design];

    /// What the switch says.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "2D",
            Self::Space => "3D",
            Self::Joints => "Joints",
            Self::Tower => "Tower",
            Self::Design => "Design",
        }
    }

    /// The next one, around.
    #[must_use]
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()]
    }

    /// What it shows, in a sentence.
    pub fn explanation(self) -> &'static str {
        match self {
            Self::Flat => "The machine and its reactionless workspace from above",
            Self::Space => "The machine and its reactionless workspace in perspective",
            Self::Joints => {
                "Joint space: the drive angles q, and the plane Σ λq = b within the joint limits; a line of two drives"
            }
            Self::Tower => "All reactionless workspaces: b as height over the plane of motion",
            Self::Design => {
                "The machine itself: masses, centres of mass, lengths and counterweights, and what they balance"
            }
        }
    }

    /// What can be done in it with the pointer.
    pub fn invitation(self) -> &'static str {
        match self {
            Self::Flat | Self::Space => "",
            Self::Joints => "drag the dot in its plane  ·  drag the plane to change b",
            Self::Tower => "drag the dot or the slice  ·  click a green bar: its b",
            Self::Design => "drag masses and ends of links",
        }
    }

    /// Whether it shows the machine and its workspace.
    pub fn shows_machine(self) -> bool {
        matches!(self, Self::Flat | Self::Space)
    }
}

/// What stays the same from frame to frame in all views.
#[derive(Clone, Debug)]
pub struct Views {
    stage: Stage,
    joints: Option<Joints>,
    tower: Option<Tower>,
    draft: Draft,
    machine: Machine,
}

/// What views are made of: a run, as far as it stands still in them; in those of a whole run, over a range of b, rad.
#[derive(Clone, Debug)]
pub struct Seen {
    run: Run,
    over: Option<[f64; 2]>,
    /// Where outlines are kept.
    queries: Asking,
}

impl Seen {
    /// A run in the window, or a whole one in a recording.
    pub fn of(run: &Run, over: Option<[f64; 2]>, queries: &Queries) -> Self {
        Self { run: run.clone(), over, queries: queries.asking() }
    }

    /// Whether nothing that stands still differs in another run: machine, plan, and what is built otherwise.
    pub fn is_of(&self, run: &Run) -> bool {
        let (one, other) = (self.run.scenario(), run.scenario());
        one.machine == other.machine
            && one.task == other.task
            && one.step == other.step
            && one.compare_b == other.compare_b
            && one.plant.length == other.plant.length
            && one.plant.link == other.plant.link
            && self.run.motion().is_some() == run.motion().is_some()
            && self.run.waiting() == run.waiting()
    }
}

impl PartialEq for Seen {
    fn eq(&self, other: &Self) -> bool {
        self.over == other.over && self.is_of(&other.run)
    }
}

impl Quick for Views {
    type Input = Seen;
    /// In the window but for an outline of what is reached that takes longer, and its tower.
    type Answer = Self;

    fn answer(seen: &Seen) -> Self {
        match seen.over {
            None => Self::begun(&seen.run),
            Some(b) => Self::over(&seen.run, b, &seen.queries.queries()),
        }
    }
}

/// Views with what changes although they stand still: base and payload, the outline once it is found with the tower over
/// it, and the drives along the axes of joint space.
#[derive(Debug)]
struct Completed;

/// What these depend on.
#[derive(Clone)]
struct Completing {
    made: Same<Views>,
    run: Run,
    outline: Option<Same<Option<Arc<Workspace>>>>,
    /// Of the axes of joint space, counted from 0, where there are more than three.
    drives: Option<[usize; 3]>,
}

impl Completing {
    fn is_of(&self, run: &Run) -> bool {
        let (one, other) = (self.run.scenario(), run.scenario());
        one.base == other.base && one.plant.payload == other.plant.payload
    }
}

impl PartialEq for Completing {
    fn eq(&self, other: &Self) -> bool {
        self.made == other.made
            && self.is_of(&other.run)
            && self.outline == other.outline
            && self.drives == other.drives
    }
}

impl Quick for Completed {
    type Input = Completing;
    type Answer = Views;

    fn answer(Completing { made, run, outline, drives }: &Completing) -> Views {
        let mut views = Views::clone(&made.0);
        if let Some(Same(outline)) = outline {
            views.stage.set_outline(Option::clone(outline));
        }
        views.complete(run);
        if let (Some(joints), Some(drives)) = (&mut views.joints, drives) {
            joints.show(*drives);
        }
        views
    }
}

impl Views {
    /// Prepares a run for drawing.
    pub fn of(run: &Run) -> Self {
        let mut views = Self::with(Stage::of(run), run);
        views.complete(run);
        views
    }

    /// The views of a run but for what changes although they stand still; in those of a whole run, over a range of b, rad.
    pub fn made(queries: &Queries, run: &Run, over: Option<[f64; 2]>) -> Arc<Self> {
        queries.ask_if::<Whole<Self>>(|seen| seen.over == over && seen.is_of(run), || Seen::of(run, over, queries))
    }

    /// The same with all that is known by now, and drives along the axes of joint space, counted from 0, where there are
    /// more than three.
    pub fn completed(made: &Arc<Self>, queries: &Queries, run: &Run, drives: Option<[usize; 3]>) -> Arc<Self> {
        let wanted = made.unoutlined();
        let outline = wanted.and_then(|space| queries.known::<Outlining>(&Shared(space))).map(Same);
        queries.ask_if::<Whole<Completed>>(
            |known| {
                Arc::ptr_eq(&known.made.0, made)
                    && known.is_of(run)
                    && known.outline == outline
                    && known.drives == drives
            },
            || Completing { made: Same(made.clone()), run: run.clone(), outline: outline.clone(), drives },
        )
    }

    /// Takes base and payload of a run, and makes the tower, once what is reached is outlined.
    fn complete(&mut self, run: &Run) {
        self.stage.refresh(run);
        if let (None, Some(reached)) = (&self.tower, self.stage.outlined()) {
            self.tower = Tower::of(run, reached);
        }
    }

    /// For a whole run, whose b lie in a range, rad: joint space and tower show all of them and stand still.
    pub fn over(run: &Run, b: [f64; 2], queries: &Queries) -> Self {
        let mut stage = Stage::begun(run);
        stage.finish(queries);
        let tower = stage.outlined().and_then(|reached| Tower::over(run, reached, b));
        let joints = Joints::over(run, b);
        let machine = run.scenario().machine.clone();
        Self { joints, tower, draft: Draft::of(&machine), stage, machine }
    }

    /// The same but for an outline of what is reached that takes longer, and its tower.
    pub fn begun(run: &Run) -> Self {
        Self::with(Stage::begun(run), run)
    }

    fn with(stage: Stage, run: &Run) -> Self {
        let machine = run.scenario().machine.clone();
        let tower = stage.outlined().and_then(|reached| Tower::of(run, reached));
        Self { stage, joints: Joints::of(run), tower, draft: Draft::of(&machine), machine }
    }

    /// Whether a machine looks like that of other views: its links are the same, wherever its limits are.
    pub fn looks_like(&self, other: &Self) -> bool {
        let (one, other) = (&self.machine, &other.machine);
        one.links() == other.links() && one.resolved_links() == other.resolved_links()
    }

    /// Why a machine has no such view, in words.
    ///
    /// # Errors
    /// If it has none.
    pub fn has(kind: ViewKind, run: &Run) -> Result<(), String> {
        if kind.shows_machine() || kind == ViewKind::Design {
            return Ok(());
        }
        match run.pose_space() {
            Ok(space) if space.joints().is_empty() => Err("one drive alone has no freedom left while b is held".into()),
            Ok(_) => Ok(()),
            Err(why) => Err(why.to_string()),
        }
    }

    /// What is yet to be outlined.
    pub fn unoutlined(&self) -> Option<Arc<PoseSpace>> {
        self.stage.unoutlined()
    }

    /// The width of the grid under the machine, in words.
    pub fn grid(&self, kind: ViewKind) -> String {
        match kind {
            ViewKind::Flat | ViewKind::Space | ViewKind::Design => format!("{} m grid", Short(self.stage.grid_width())),
            ViewKind::Joints | ViewKind::Tower => String::new(),
        }
    }

    /// The machine's view.
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// Joint space, if the machine has a b and more than one drive.
    pub fn joints(&self) -> Option<&Joints> {
        self.joints.as_ref()
    }

    /// Whether there is such a view.
    pub fn shows(&self, kind: ViewKind) -> bool {
        match kind {
            ViewKind::Flat | ViewKind::Space | ViewKind::Design => true,
            ViewKind::Joints => self.joints.is_some(),
            ViewKind::Tower => self.tower.is_some(),
        }
    }

    /// Which axis of (q_1, q_2, q_3) each axis of joint space stands for.
    pub fn joint_axes(&self) -> [usize; 3] {
        self.joints.as_ref().map_or([0, 1, 2], Joints::axes)
    }

    /// The tower, if the machine has a b and its workspace is known.
    pub fn tower(&self) -> Option<&Tower> {
        self.tower.as_ref()
    }

    /// The camera that shows everything.
    pub fn camera(&self, kind: ViewKind) -> Camera {
        let reach = self.stage.linkage().reach();
        match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => joints.camera(),
            (ViewKind::Tower, _, Some(tower)) => tower.camera(),
            (ViewKind::Flat | ViewKind::Design, ..) => Camera::flat(reach),
            _ => Camera::orbit(reach),
        }
    }

    /// What is to be seen of a frame and of other poses of the machine when everything is shown.
    pub fn content(&self, kind: ViewKind, frame: &Frame, poses: &[DriveAngles]) -> Content {
        match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => Content { first: joints.corners(), then: Vec::new() },
            (ViewKind::Tower, _, Some(tower)) => Content { first: tower.hull(), then: Vec::new() },
            (ViewKind::Design, ..) => self.stage.body(frame),
            _ => self.stage.content(frame, poses),
        }
    }

    /// Everything there is to draw.
    pub fn scene(&self, kind: ViewKind, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => joints.scene(frame, options, camera),
            (ViewKind::Tower, _, Some(tower)) => tower.scene(frame, options, camera),
            (ViewKind::Design, ..) => self.stage.drafted(&self.draft, frame, options),
            _ => self.stage.scene(frame, options),
        }
    }

    /// The end effector, if it is under the pointer.
    pub fn pick_tip(&self, shown: &Shown<'_>, pointer: &Pointer) -> Option<Pick> {
        let at = self.stage.handle(Handle::EndEffector, shown)?;
        (pointer.distance(at)? < 1.5 * NEAR).then_some(Pick::of(Handle::EndEffector, at))
    }

    /// The target, where the pointer is on the arm or no farther from it than so many px.
    pub fn pick_arm(&self, shown: &Shown<'_>, pointer: &Pointer, near: f64) -> Option<Pick> {
        let at = self.stage.handle(Handle::Target, shown)?;
        let on = pointer.distance(at)? < near || self.link_at(shown, pointer).is_some();
        on.then(|| Pick::of(Handle::Target, at))
    }

    /// The number of the link under the pointer in the machine's view as it is drawn; the uppermost of several.
    pub fn link_at(&self, shown: &Shown<'_>, pointer: &Pointer) -> Option<usize> {
        self.stage.link_at(shown, pointer)
    }

    /// What is under the pointer, to be pulled at or not, as it is drawn.
    pub fn under(&self, kind: ViewKind, shown: &Shown<'_>, pointer: &Pointer) -> Option<Handle> {
        // What lies on a link comes before it.
        let pulled = self
            .pick(kind, shown, pointer)
            .filter(|pick| !matches!(pick.handle, Handle::Link(_)))
            .map(|pick| pick.handle);
        pulled.or_else(|| match kind {
            ViewKind::Design => self.link_at(&shown.frame.into(), pointer).map(Handle::Link),
            kind => kind.shows_machine().then(|| self.stage.under(shown, pointer)).flatten(),
        })
    }

    /// What is under the pointer and can be pulled at, as it is drawn.
    pub fn pick(&self, kind: ViewKind, shown: &Shown<'_>, pointer: &Pointer) -> Option<Pick> {
        // Only the machine's own views exaggerate.
        let frame = shown.frame;
        match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => joints.pick(frame, pointer),
            (ViewKind::Tower, _, Some(tower)) => tower.pick(frame, pointer),
            (ViewKind::Design, ..) => self.draft.pick(self.stage.linkage(), frame, pointer),
            _ => {
                let picks = [Handle::Target, Handle::Ring].into_iter().filter_map(|handle| {
                    let at = self.stage.handle(handle, shown)?;
                    Some((Pick::of(handle, at), pointer.distance(at)?))
                });
                let near = picks.filter(|(_, d)| *d < NEAR);
                let first = near.min_by(|s, t| s.1.total_cmp(&t.1)).map(|(pick, _)| pick);
                // Where the target covers a point of the path, the point is held by its name, to the left of it.
                let points = self.stage.waypoints().filter_map(|i| {
                    let handle = Handle::Waypoint(i);
                    let at = self.stage.handle(handle, shown)?;
                    let [x, y] = pointer.seen(at)?;
                    let name = (pointer.at[0] - x + NAME).hypot(pointer.at[1] - y);
                    let own = (pointer.at[0] - x).hypot(pointer.at[1] - y);
                    let off = if first.is_some() { name } else { own.min(name) };
                    // Within its ring the target comes first.
                    (off < NEAR_POINT && !(first.is_some() && own < RING)).then_some((Pick::of(handle, at), off))
                });
                let point = points.min_by(|s, t| s.1.total_cmp(&t.1)).map(|(pick, _)| pick);
                // A payload under the target is held by its mass, above it.
                let load = self.stage.handle(Handle::Payload, shown).filter(|at| {
                    let Some([x, y]) = pointer.seen(*at) else { return false };
                    let [px, py] = pointer.at;
                    let on = first.is_none() && (px - x).hypot(py - y) < NEAR_LOAD;
                    on || (px - x).hypot(py - y + MASS) < NEAR_POINT
                });
                let load = load.map(|at| Pick::of(Handle::Payload, at));
                let ends = self.stage.limits(shown).filter_map(|end| {
                    let off = pointer.distance(end.at).filter(|off| *off < NEAR_POINT)?;
                    Some((end, off))
                });
                let end = || ends.min_by(|s, t| s.1.total_cmp(&t.1)).map(|(pick, _)| pick);
                point.or(load).or(first).or_else(end).or_else(|| self.stage.grip(shown, pointer))
            }
        }
    }

    /// What pulling at something asks for; `b` is the pose constant that the machine is sent to, rad.
    pub fn aim(&self, kind: ViewKind, pick: &Pick, shown: &Shown<'_>, pointer: &Pointer, b: f64) -> Option<Aim> {
        let frame = shown.frame;
        if let (Handle::Link(i), Some(Grip::Link(grip))) = (pick.handle, &pick.grip) {
            return self.stage.turned(i, grip, shown, pointer, b).map(Aim::Angles);
        }
        let in_joints = kind == ViewKind::Joints && self.joints.is_some();
        if let (false, Handle::Link(i), Some(Grip::Pull(hook))) = (in_joints, pick.handle, &pick.grip) {
            return self.stage.pulled(i, hook, shown, pointer);
        }
        match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => joints.aim(pick, frame, pointer),
            (ViewKind::Tower, _, Some(tower)) => tower.aim(pick, frame, pointer),
            (ViewKind::Design, ..) => self.draft.aim(pick, self.stage.linkage(), frame, pointer),
            _ => {
                let at = pointer.ray()?.at_height(self.stage.handle_height())?;
                match pick.handle {
                    Handle::Target => Some(Aim::Target(at)),
                    Handle::Ring => self.stage.ring_b(at, b, shown).map(Aim::B),
                    Handle::EndEffector => Some(Aim::Push([
                        PULL * (at[0] - shown.end_effector.re),
                        PULL * (at[1] - shown.end_effector.im),
                    ])),
                    Handle::Waypoint(i) => Some(Aim::Waypoint(i, at)),
                    Handle::Limit(angle, end) => {
                        let Some(Grip::Limit(pivot)) = &pick.grip else { return None };
                        let ends = self.stage.limit_pulled((angle, end), pivot, pointer)?;
                        Some(Aim::Limit { angle, end, ends })
                    }
                    Handle::Payload => {
                        let offset = self.stage.load_offset(shown, at);
                        let far = offset[0].hypot(offset[1]) > AT_TIP * self.stage.linkage().reach();
                        Some(Aim::Payload(if far { offset } else { [0.0; 2] }))
                    }
                    _ => None,
                }
            }
        }
    }
}
