//! The linked views of one run: the machine from above and in perspective, joint space, the tower, and the design. A
//! drag in one of them is a request to the session, so all views follow.

use std::sync::Arc;

use super::Scene;
use super::camera::Camera;
use super::draft::DesignDrawing;
use super::exaggeration::DrawnFrame;
use super::framing::ViewContent;
use super::joints::JointSpace;
use super::options::{Handle, ViewOptions};
use super::pick::{DragAction, Grip, PICK_RADIUS, Pick};
use super::pointer::Pointer;
use super::sketching::{self, SketchOptions};
use super::stage::{OutlineQuery, OutlineSubject, Outlined, PULL_STIFFNESS, Stage};
use super::tower::Tower;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_mechanics::sketch::{Resolved, Sketch};
use stillbase_query::{ByIdentity, Queries, QuickQuery, QuickWork, WeakQueries};
use stillbase_session::Run;
use stillbase_session::scenario::Scenario;
use stillbase_settings::number::ShortNumber;
use stillbase_simulation::frame::Frame;

/// Distance within which the pointer picks a point of the path, a label or a joint limit, px.
const POINT_PICK_PX: f64 = 9.0;
/// Distance within which the pointer picks a payload, px.
const PAYLOAD_PICK_PX: f64 = 12.0;

/// A payload that is dragged nearer to the end effector than this fraction of the reach snaps to it.
const TIP_SNAP: f64 = 0.015;

/// The views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
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
    /// The machine's masses and lengths, for editing.
    Design,
}

impl ViewKind {
    /// All views, in the order of the switch.
    pub const ALL: [Self; 5] = [Self::Flat, Self::Space, Self::Joints, Self::Tower, Self::Design];

    /// Name on the switch.
    pub fn name(self) -> &'static str {
        match self {
            Self::Flat => "2D",
            Self::Space => "3D",
            Self::Joints => "Joints",
            Self::Tower => "Tower",
            Self::Design => "Design",
        }
    }

    /// Returns the next view; after the last one, the first.
    #[must_use]
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()]
    }

    /// Explanation in a sentence.
    pub fn explanation(self) -> &'static str {
        match self {
            Self::Flat => "The machine and its reactionless workspace from above",
            Self::Space => "The machine and its reactionless workspace in perspective",
            Self::Joints => {
                "Joint space: the drive angles q, and the plane Σ λq = b within the limits, a line for two drives"
            }
            Self::Tower => "All reactionless workspaces: b as height over the plane of motion",
            Self::Design => {
                "The machine itself: masses, centres of mass, lengths and counterweights, and what they balance"
            }
        }
    }

    /// Hint at what can be dragged in the view.
    pub fn invitation(self) -> &'static str {
        match self {
            Self::Flat | Self::Space => "",
            Self::Joints => "drag the dot in its plane  ·  drag the plane to change b",
            Self::Tower => "drag the dot or the slice  ·  click a green bar: its b",
            Self::Design => "drag masses and ends of links",
        }
    }

    /// Whether the view shows the machine and its workspace.
    pub fn shows_machine(self) -> bool {
        matches!(self, Self::Flat | Self::Space)
    }
}

/// The parts of all views that do not change from frame to frame.
#[derive(Clone, Debug)]
pub struct Views {
    stage: Stage,
    joints: Option<JointSpace>,
    tower: Option<Tower>,
    draft: DesignDrawing,
    machine: Machine,
}

/// Input of [`Views`]: a run, compared only by its constant parts; for a whole run, also the interval of its b, rad.
#[derive(Clone, Debug)]
pub struct ViewSubject {
    run: Run,
    over: Option<[f64; 2]>,
    /// Cache of the outlines.
    queries: WeakQueries,
}

impl ViewSubject {
    /// Returns the input for a run in the window, or with `over` for a whole run in a recording.
    pub fn of(run: &Run, over: Option<[f64; 2]>, queries: &Queries) -> Self {
        Self { run: run.clone(), over, queries: queries.downgrade() }
    }

    /// Whether the constant parts of another run are equal, such as machine, task, and true links and lengths.
    #[doc(hidden)]
    pub fn is_of(&self, run: &Run) -> bool {
        let (one, other) = (self.run.scenario(), run.scenario());
        one.machine == other.machine
            && one.task == other.task
            && one.step == other.step
            && one.compare_b == other.compare_b
            && one.plant.length == other.plant.length
            && one.plant.link == other.plant.link
            && dimensions(one) == dimensions(other)
            // Angles in joint space are relative to a base that moves.
            && one.base.moves() == other.base.moves()
            && self.run.motion().is_some() == run.motion().is_some()
            && self.run.waiting() == run.waiting()
    }
}

/// Returns what a design states of the parts of a machine.
fn dimensions(scenario: &Scenario) -> [f64; 4] {
    let design = &scenario.design;
    [design.bar_width, design.bar_thickness, design.pin_diameter, design.density]
}

impl PartialEq for ViewSubject {
    fn eq(&self, other: &Self) -> bool {
        self.over == other.over && self.is_of(&other.run)
    }
}

impl QuickQuery for Views {
    type Input = ViewSubject;
    /// The views; those for the window lack outline and tower if the outline takes long to compute.
    type Answer = Self;

    fn answer(seen: &ViewSubject) -> Self {
        match seen.over {
            None => Self::begun(&seen.run),
            Some(b) => Self::over(&seen.run, b, &seen.queries.queries()),
        }
    }
}

/// Query for [`Views`] with the parts that change more often. These are base and payload, the drives along the axes of
/// joint space, and, once computed, the outline with its tower.
#[derive(Debug)]
struct Completed;

/// Input of [`Completed`].
#[derive(Clone)]
struct CompletedInput {
    base_views: ByIdentity<Views>,
    run: Run,
    outline: Option<ByIdentity<Option<Outlined>>>,
    /// The last outline, until this one is known.
    kept: Option<ByIdentity<Option<Outlined>>>,
    /// Indices of the drives along the axes of joint space, from 0, if there are more than three drives.
    drives: Option<[usize; 3]>,
}

impl CompletedInput {
    fn is_of(&self, run: &Run) -> bool {
        let (one, other) = (self.run.scenario(), run.scenario());
        one.base == other.base && one.plant.payload == other.plant.payload
    }
}

impl PartialEq for CompletedInput {
    fn eq(&self, other: &Self) -> bool {
        self.base_views == other.base_views
            && self.is_of(&other.run)
            && self.outline == other.outline
            && self.kept == other.kept
            && self.drives == other.drives
    }
}

impl QuickQuery for Completed {
    type Input = CompletedInput;
    type Answer = Views;

    fn answer(CompletedInput { base_views, run, outline, kept, drives }: &CompletedInput) -> Views {
        let mut views = Views::clone(&base_views.0);
        if let Some(ByIdentity(outline)) = outline {
            views.stage.set_outline(Option::clone(outline));
        } else if let Some(kept) = kept.as_ref().and_then(|kept| kept.0.as_ref().as_ref()) {
            views.stage.keep_outline(kept);
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

    /// Returns the views of a run, from the cache if possible, without the parts that [`completed`](Self::completed)
    /// adds. For a whole run, `over` is the interval of its b, rad.
    #[doc(hidden)]
    pub fn base_views(queries: &Queries, run: &Run, over: Option<[f64; 2]>) -> Arc<Self> {
        queries.ask_if::<QuickWork<Self>>(
            |seen| seen.over == over && seen.is_of(run),
            || ViewSubject::of(run, over, queries),
        )
    }

    /// Returns the views completed by base, payload and, once it is computed, the outline with its tower. `drives` are
    /// the indices of the drives along the axes of joint space, from 0, if there are more than three drives.
    #[doc(hidden)]
    pub fn completed(made: &Arc<Self>, queries: &Queries, run: &Run, drives: Option<[usize; 3]>) -> Arc<Self> {
        let wanted = made.unoutlined();
        let outline = wanted.as_ref().and_then(|subject| queries.known::<OutlineQuery>(subject)).map(ByIdentity);
        let kept = wanted.filter(|_| outline.is_none()).and_then(|_| queries.last::<OutlineQuery>()).map(ByIdentity);
        queries.ask_if::<QuickWork<Completed>>(
            |known| {
                Arc::ptr_eq(&known.base_views.0, made)
                    && known.is_of(run)
                    && known.outline == outline
                    && known.kept == kept
                    && known.drives == drives
            },
            || CompletedInput {
                base_views: ByIdentity(made.clone()),
                run: run.clone(),
                outline: outline.clone(),
                kept: kept.clone(),
                drives,
            },
        )
    }

    /// Updates base and payload from a run, and builds the tower once the outline is known.
    fn complete(&mut self, run: &Run) {
        self.stage.refresh(run);
        if let (None, Some(reached)) = (&self.tower, self.stage.outlined()) {
            self.tower = Tower::of(run, reached);
        }
    }

    /// Prepares a whole run whose b lie in an interval, rad. Joint space shows a constant interval of b that
    /// contains it; so does the tower, up to its maximum length.
    #[doc(hidden)]
    pub fn over(run: &Run, b: [f64; 2], queries: &Queries) -> Self {
        let mut stage = Stage::begun(run);
        stage.finish(queries);
        let tower = stage.outlined().and_then(|reached| Tower::over(run, reached, b));
        let joints = JointSpace::over(run, b);
        let machine = run.scenario().machine.clone();
        Self { joints, tower, draft: DesignDrawing::of(&machine), stage, machine }
    }

    /// Prepares a run for drawing, without outline and tower if the outline takes long to compute.
    #[doc(hidden)]
    pub fn begun(run: &Run) -> Self {
        Self::with(Stage::begun(run), run)
    }

    fn with(stage: Stage, run: &Run) -> Self {
        let machine = run.scenario().machine.clone();
        let tower = stage.outlined().and_then(|reached| Tower::of(run, reached));
        Self { stage, joints: JointSpace::of(run), tower, draft: DesignDrawing::of(&machine), machine }
    }

    /// Whether the machine looks like that of other views: equal links, whatever its limits.
    #[doc(hidden)]
    pub fn looks_like(&self, other: &Self) -> bool {
        let (one, other) = (&self.machine, &other.machine);
        one.links() == other.links() && one.resolved_links() == other.resolved_links()
    }

    /// Checks that the machine of a run has a view.
    ///
    /// # Errors
    /// If it does not; the text gives the reason.
    pub fn has(kind: ViewKind, run: &Run) -> Result<(), String> {
        if let (ViewKind::Design, Some(shared)) = (kind, run.shared()) {
            let (name, whole) = (shared.block().name(), &shared.block().scenario.assembly.name);
            return Err(format!(
                "{name} is a block of the assembly {whole}: its machine is changed in the assembly's file"
            ));
        }
        if kind.shows_machine() || kind == ViewKind::Design {
            return Ok(());
        }
        match run.pose_space() {
            Ok(space) if space.joints().is_empty() => Err("one drive alone has no freedom left while b is held".into()),
            Ok(_) => Ok(()),
            Err(why) => Err(why.to_string()),
        }
    }

    /// Returns what is still to be outlined.
    #[doc(hidden)]
    pub fn unoutlined(&self) -> Option<OutlineSubject> {
        self.stage.unoutlined()
    }

    /// Returns the text of the width of the grid under the machine.
    #[doc(hidden)]
    pub fn grid(&self, kind: ViewKind) -> String {
        match kind {
            ViewKind::Flat | ViewKind::Space | ViewKind::Design => {
                format!("{} m grid", ShortNumber(self.stage.grid_width()))
            }
            ViewKind::Joints | ViewKind::Tower => String::new(),
        }
    }

    /// The machine's view.
    #[doc(hidden)]
    pub fn stage(&self) -> &Stage {
        &self.stage
    }

    /// Joint space, if the machine has a b and more than one drive.
    #[doc(hidden)]
    pub fn joints(&self) -> Option<&JointSpace> {
        self.joints.as_ref()
    }

    /// Whether the machine has a view.
    pub fn shows(&self, kind: ViewKind) -> bool {
        match kind {
            ViewKind::Flat | ViewKind::Space | ViewKind::Design => true,
            ViewKind::Joints => self.joints.is_some(),
            ViewKind::Tower => self.tower.is_some(),
        }
    }

    /// Returns the index of the drive along each axis of joint space, if the machine determines the order; otherwise
    /// 0, 1, 2.
    #[doc(hidden)]
    pub fn joint_axes(&self) -> [usize; 3] {
        self.joints.as_ref().map_or([0, 1, 2], JointSpace::axes)
    }

    /// The tower, if the machine has a b and its workspace is known.
    #[doc(hidden)]
    pub fn tower(&self) -> Option<&Tower> {
        self.tower.as_ref()
    }

    /// Returns the default camera of a view.
    pub fn camera(&self, kind: ViewKind) -> Camera {
        let reach = self.stage.linkage().reach();
        match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => joints.camera(),
            (ViewKind::Tower, _, Some(tower)) => tower.camera(),
            (ViewKind::Flat | ViewKind::Design, ..) => Camera::flat(reach),
            _ => Camera::orbit(reach),
        }
    }

    /// Returns the points that the camera has to show for a frame and other poses of the machine.
    #[doc(hidden)]
    pub fn content(&self, kind: ViewKind, frame: &Frame, poses: &[DriveAngles]) -> ViewContent {
        match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => ViewContent { first: joints.corners(), then: Vec::new() },
            (ViewKind::Tower, _, Some(tower)) => ViewContent { first: tower.hull(), then: Vec::new() },
            (ViewKind::Design, ..) => self.stage.body(frame),
            _ => self.stage.content(frame, poses),
        }
    }

    /// Returns the scene of a frame.
    pub fn scene(&self, kind: ViewKind, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        let scene = match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => joints.scene(frame, options, camera),
            (ViewKind::Tower, _, Some(tower)) => tower.scene(frame, options, camera),
            (ViewKind::Design, ..) => self.stage.drafted(&self.draft, frame, options),
            _ => self.stage.scene(frame, options),
        };
        Scene { notation: options.notation, ..scene }
    }

    /// Returns the scene of a drawing.
    #[doc(hidden)]
    pub fn sketched(&self, sketch: &Sketch, resolved: &Resolved, options: &SketchOptions) -> Scene {
        sketching::scene(self.stage.linkage().model.clone(), sketch, resolved, options)
    }

    /// Picks the end effector, if it is under the pointer.
    #[doc(hidden)]
    pub fn pick_tip(&self, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Pick> {
        let at = self.stage.handle(Handle::EndEffector, shown)?;
        (pointer.distance(at)? < 1.5 * PICK_RADIUS).then_some(Pick::of(Handle::EndEffector, at))
    }

    /// Returns where a drag of the target in space asks the end effector to be, in the axes of its block: beside it, in the
    /// plane that faces the eye.
    pub fn aim_in_space(&self, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<DragAction> {
        let [x, y, z] = pointer.beside(self.stage.handle(Handle::Target, shown)?)?;
        // The handle lies above the end effector.
        Some(DragAction::InSpace([x, y, z - self.stage.handle_height()]))
    }

    /// Picks the target, if the pointer is on a link or within `near` px of the target.
    #[doc(hidden)]
    pub fn pick_arm(&self, shown: &DrawnFrame<'_>, pointer: &Pointer, near: f64) -> Option<Pick> {
        let at = self.stage.handle(Handle::Target, shown)?;
        let on = pointer.distance(at)? < near || self.link_at(shown, pointer).is_some();
        on.then(|| Pick::of(Handle::Target, at))
    }

    /// Returns the index of the drawn link under the pointer; the uppermost of several.
    #[doc(hidden)]
    pub fn link_at(&self, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<usize> {
        self.stage.link_at(shown, pointer)
    }

    /// Returns the drawn item under the pointer, whether it can be dragged or not.
    #[doc(hidden)]
    pub fn under(&self, kind: ViewKind, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Handle> {
        // Items on a link take precedence over the link.
        let pulled = self
            .pick(kind, shown, pointer)
            .filter(|pick| !matches!(pick.handle, Handle::Link(_)))
            .map(|pick| pick.handle);
        pulled.or_else(|| match kind {
            ViewKind::Design => self.link_at(&shown.frame.into(), pointer).map(Handle::Link),
            kind => kind.shows_machine().then(|| self.stage.under(shown, pointer)).flatten(),
        })
    }

    /// Returns the drawn item under the pointer that can be dragged.
    #[doc(hidden)]
    pub fn pick(&self, kind: ViewKind, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Pick> {
        // Only the views of the machine exaggerate motion; the others use the true frame.
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
                let near = picks.filter(|(_, d)| *d < PICK_RADIUS);
                let first = near.min_by(|s, t| s.1.total_cmp(&t.1)).map(|(pick, _)| pick);
                // Within its ring the target takes precedence; a point there is taken by its label.
                let points = self.stage.waypoints().filter_map(|i| {
                    let handle = Handle::Waypoint(i);
                    let at = self.stage.handle(handle, shown)?;
                    let off = pointer.distance(at)?;
                    (first.is_none() && off < POINT_PICK_PX).then_some((Pick::of(handle, at), off))
                });
                let point = points.min_by(|s, t| s.1.total_cmp(&t.1)).map(|(pick, _)| pick);
                // Within that ring a payload, too, is taken by its label.
                let load = self
                    .stage
                    .handle(Handle::Payload, shown)
                    .filter(|at| first.is_none() && pointer.distance(*at).is_some_and(|off| off < PAYLOAD_PICK_PX));
                let load = load.map(|at| Pick::of(Handle::Payload, at));
                let ends = self.stage.limits(shown).filter_map(|end| {
                    let off = pointer.distance(end.at).filter(|off| *off < POINT_PICK_PX)?;
                    Some((end, off))
                });
                let end = || ends.min_by(|s, t| s.1.total_cmp(&t.1)).map(|(pick, _)| pick);
                point.or(load).or(first).or_else(end).or_else(|| self.stage.grip(shown, pointer))
            }
        }
    }

    /// Returns the change that dragging an item to the pointer requests; `b` is the commanded pose constant, rad.
    #[doc(hidden)]
    pub fn aim(
        &self,
        kind: ViewKind,
        pick: &Pick,
        shown: &DrawnFrame<'_>,
        pointer: &Pointer,
        b: f64,
    ) -> Option<DragAction> {
        let frame = shown.frame;
        if let (Handle::Link(i), Some(Grip::Link(grip))) = (pick.handle, &pick.grip) {
            return self.stage.turned(i, grip, shown, pointer, b).map(DragAction::Angles);
        }
        let in_joints = kind == ViewKind::Joints && self.joints.is_some();
        if let (false, Handle::Link(i), Some(Grip::Pull(hook))) = (in_joints, pick.handle, &pick.grip) {
            return self.stage.pulled(i, hook, shown, pointer);
        }
        match (kind, &self.joints, &self.tower) {
            (ViewKind::Joints, Some(joints), _) => joints.aim(pick, frame, pointer).map(|aim| aim.in_space(frame)),
            (ViewKind::Tower, _, Some(tower)) => tower.aim(pick, frame, pointer).map(|aim| aim.in_space(frame)),
            (ViewKind::Design, ..) => self.draft.aim(pick, self.stage.linkage(), frame, pointer),
            _ => {
                let at = pointer.ray()?.at_height(self.stage.handle_height())?;
                match pick.handle {
                    Handle::Target => {
                        let at = shown.target_at(Vector::new(at[0], at[1]));
                        Some(DragAction::Target([at.re, at.im]))
                    }
                    Handle::Ring => self.stage.ring_b(at, b, shown).map(DragAction::B),
                    Handle::EndEffector => Some(DragAction::Push([
                        PULL_STIFFNESS * (at[0] - shown.end_effector.re),
                        PULL_STIFFNESS * (at[1] - shown.end_effector.im),
                    ])),
                    Handle::Waypoint(i) => Some(DragAction::Waypoint(i, at)),
                    Handle::Limit(angle, end) => {
                        let Some(Grip::Limit(pivot)) = &pick.grip else { return None };
                        let ends = self.stage.limit_pulled((angle, end), pivot, pointer)?;
                        Some(DragAction::Limit { angle, end, ends })
                    }
                    Handle::Payload => {
                        let offset = self.stage.load_offset(shown, at);
                        let far = offset[0].hypot(offset[1]) > TIP_SNAP * self.stage.linkage().reach();
                        Some(DragAction::Payload(if far { offset } else { [0.0; 2] }))
                    }
                    _ => None,
                }
            }
        }
    }
}
