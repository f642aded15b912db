//! All reactionless workspaces at once, with the pose constant b as height over the plane of motion. Each horizontal
//! section of the tower is the workspace of its b, rotated by b* = b/Σλ, (15). A point is reachable at those b at
//! which its vertical line is inside the tower.
//!
//! With two drives a section is a curve; with four or more drives the tower is shown by the outlines of its sections.
//!
//! In the scene x and y are metres, and z is b minus the lowest shown b, times [`Tower::rise`].

use std::sync::Arc;

use super::axes::{self, Axis};
use super::camera::{Camera, Orbit};
use super::course::{stations, target_handle, waypoints};
use super::options::{Handle, ViewOptions};
use super::palette::{Palette, faded, palette};
use super::pick::{DragAction, PICK_RADIUS, Pick};
use super::pointer::Pointer;
use super::stage::Workspace;
use super::wall::Wall;
use super::{Anchor, ItemChanges, Label, Marker, Mesh, MeshSet, Polyline, Scene, Solid, Strips, point, posed};
use crate::notation::Notation;
use crate::numbers::round_up;
use stillbase_mechanics::machine::place_of;
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::{AngleLimit, BSet, PlaneMap};
use stillbase_session::Run;
use stillbase_simulation::frame::{Frame, Reach};

/// Length of the interval of b that is shown, rad.
pub const TOWER_SPAN: f64 = 5.0;
/// Maximum length of the interval of b, for runs over many b, rad.
pub const MAX_TOWER_SPAN: f64 = 4.0 * TOWER_SPAN;
/// Factor of the mesh size of the wall in a recording.
const RECORDED_GRAIN: f64 = 2.6;
/// Spacing of contours, rad; contours are at multiples of this, and at both ends of the interval.
const CONTOUR_STEP_RAD: f64 = 0.5;
/// Minimum distance of b from top and bottom, as a fraction of [`TOWER_SPAN`].
const MARGIN_FRACTION: f64 = 0.08;
/// Height of the box, as a multiple of the radius of the workspace.
const HEIGHT_PER_RADIUS: f64 = 2.1;
/// Cells per side of the fill of a section.
const CELLS: u32 = 64;
/// Cells per side of the fill of a section in a recording.
const RECORDED_CELLS: u32 = 40;
/// Maximum number of points whose sets of b are all shown; of more points, only the first and last are shown.
const MAX_POSTS: usize = 8;
/// Distance within which the pointer picks a bar, px.
const BAR_PICK_PX: f64 = 9.0;

/// The parts of the tower that do not change from frame to frame.
#[derive(Clone, Debug)]
pub struct Tower {
    space: Arc<PoseSpace>,
    /// Boundary of the workspace at b = 0.
    outline: Strips,
    wall: Wall,
    model: Arc<MeshSet>,
    /// The points of a planned motion, from A to B.
    ends: Option<Vec<TowerPost>>,
    /// The planned motion: position, m, and b, rad.
    course: Vec<(Vector, f64)>,
    /// Maximum distance of the workspace from the axis of the base, x = y = 0, m.
    radius: f64,
    /// Length of the interval of b that is shown, rad.
    span: f64,
    /// The interval of b that is shown, rad, if it does not follow the present b.
    fixed: Option<[f64; 2]>,
    /// Outlines at the b of the contours, if the interval is fixed.
    contours: Strips,
}

/// A point of the plane and the set of b at which it is reachable.
#[derive(Clone, Debug)]
pub struct TowerPost {
    /// Name: `A`, `1`, `B`, `target`.
    pub name: String,
    /// Position, m.
    pub at: Vector,
    /// Values of b at which the point is reachable; `None` if there are none.
    pub reach: Option<BSet>,
}

impl Tower {
    /// Prepares a run for drawing, over an interval of b of length [`TOWER_SPAN`]; to be repeated when its machine or
    /// plan changes.
    pub fn of(run: &Run, reached: &Workspace) -> Option<Self> {
        Self::rising(run, reached.shape(), TOWER_SPAN, None)
    }

    /// Prepares a whole run whose b lie in the given interval, rad. The tower shows a constant interval of length
    /// [`TOWER_SPAN`] to [`MAX_TOWER_SPAN`]. Its wall has a few thousand triangles.
    pub fn over(run: &Run, reached: &Workspace, b: [f64; 2]) -> Option<Self> {
        let span = (b[1] - b[0] + 2.0 * MARGIN_FRACTION * TOWER_SPAN).clamp(TOWER_SPAN, MAX_TOWER_SPAN);
        let fixed = Some(axes::covering_range(b, 0.5 * span, span, MARGIN_FRACTION * TOWER_SPAN));
        Self::rising(run, reached.shape(), span, fixed)
    }

    /// Builds the tower above closed outlines at b = 0, with the inside on their left.
    fn rising(run: &Run, outlines: &[Vec<Vector>], span: f64, fixed: Option<[f64; 2]>) -> Option<Self> {
        let space = run.pose_space().ok()?.clone();
        let radius = outlines.iter().flatten().fold(0.0_f64, |m, p| m.max(p.norm()));
        if !(radius > 0.0 && span.is_finite() && span > 0.0) {
            return None;
        }
        let rise = HEIGHT_PER_RADIUS * radius / span;
        let grain = if fixed.is_some() { RECORDED_GRAIN } else { 1.0 };
        let wall = Wall::with_grain(outlines, space.turn(1.0) / rise, grain);
        // Only machines with planes have a filled section.
        let slice = match space.planes() {
            Ok(planes) => sheet(planes.map(), if fixed.is_some() { RECORDED_CELLS } else { CELLS }),
            Err(_) => Mesh { shell: true, ..Mesh::default() },
        };
        let model = Arc::new(MeshSet { meshes: vec![slice, wall.mesh(HEIGHT_PER_RADIUS * radius)] });
        let tip = *run.scenario().machine.end_effector();
        let course: Vec<(Vector, f64)> = run.motion().map_or_else(Vec::new, |motion| {
            let at = |s: f64| motion.path.at(s).q;
            stations(motion).map(at).map(|q| (place_of(&tip, &q.units()), space.b(&q))).collect()
        });
        let ends = run.motion().map(|_| {
            let mut points = waypoints(run);
            if points.len() > MAX_POSTS {
                points.drain(1..points.len() - 1);
            }
            points.into_iter().map(|(_, name, at)| TowerPost { name, at, reach: space.reach(at).ok() }).collect()
        });
        let closed = |outline: &Vec<Vector>| {
            let mut points: Vec<_> = outline.iter().map(|p| point(*p, 0.0)).collect();
            points.extend(points.first().copied().filter(|_| points.len() > 2));
            points
        };
        let outline = outlines.iter().map(closed).collect();
        let mut tower = Self { space, outline, wall, model, ends, course, radius, span, fixed, contours: [].into() };
        if let Some([low, high]) = fixed {
            let level = |b: f64| {
                let z = (b - low) * tower.rise();
                let pieces = tower.wall.level(tower.space.turn(b));
                pieces.into_iter().map(move |piece| piece.into_iter().map(|p| point(p, z)).collect::<Vec<_>>())
            };
            tower.contours = contours([low, high]).flat_map(level).collect();
        }
        Some(tower)
    }

    /// Height per radian of b, m/rad.
    pub fn rise(&self) -> f64 {
        HEIGHT_PER_RADIUS * self.radius / self.span
    }

    /// Returns the interval of b that is shown, rad: a fixed one, or from 0, shifted if `b` is not well inside.
    pub fn window(&self, b: f64) -> [f64; 2] {
        self.fixed.unwrap_or_else(|| axes::sliding_range(b, 0.5 * self.span, self.span, MARGIN_FRACTION * self.span))
    }

    /// Returns a camera that shows the whole tower.
    pub fn camera(&self) -> Camera {
        let height = HEIGHT_PER_RADIUS * self.radius;
        // A tower with a fixed interval is viewed from a smaller distance.
        let (middle, near) = if self.fixed.is_some() { (0.93, 0.66) } else { (1.0, 1.0) };
        let centre = [0.0, 0.0, middle * 0.46 * height];
        Camera::Orbit(Orbit { centre, distance: near * 5.9 * self.radius, yaw: 0.5, pitch: 0.36 })
    }

    /// Corners of the bounding box of the tower and its axes.
    pub fn hull(&self) -> Vec<[f64; 3]> {
        let (side, height) = (1.05 * self.radius, HEIGHT_PER_RADIUS * self.radius);
        let corner = |i: u32| [0, 1].map(|k| if (i >> k) & 1 == 0 { -side } else { side });
        (0..8).map(|i| [corner(i)[0], corner(i)[1], if i < 4 { 0.0 } else { height }]).collect()
    }

    /// Returns the points whose sets of b are shown, each with the parts of its set inside the shown interval.
    pub fn posts(&self, frame: &Frame) -> Vec<(TowerPost, Vec<[f64; 2]>)> {
        let window = self.window(frame.b_reference);
        if let Some(ends) = &self.ends {
            return ends.iter().map(|post| barred(post, window)).collect();
        }
        let at = frame.target_in_base();
        vec![barred(&TowerPost { name: "target".into(), at, reach: self.space.reach(at).ok() }, window)]
    }

    /// Returns the item under the pointer that can be dragged: the target, a bar, or the section.
    pub fn pick(&self, frame: &Frame, pointer: &Pointer) -> Option<Pick> {
        let [low, _] = self.window(frame.b_reference);
        let height = |b: f64| (b - low) * self.rise();
        let tip = self::tip(frame);
        let dot = [tip.re, tip.im, height(frame.b_reference)];
        if pointer.distance(dot).is_some_and(|d| d < PICK_RADIUS) {
            return Some(Pick::of(Handle::Target, dot));
        }
        let ray = pointer.ray()?;
        for (post, bars) in self.posts(frame) {
            for [from, to] in bars {
                let ends = [from, to].map(|b| [post.at.re, post.at.im, height(b)]);
                if pointer.distance_to_segment(ends).is_some_and(|d| d < BAR_PICK_PX) {
                    return Some(Pick::of(Handle::Bar, ends[0]));
                }
            }
        }
        let [x, y] = ray.at_height(dot[2])?;
        let at = Vector::new(x, y);
        let inside = match self.space.reaches_area() {
            true => self.space.contains(at, frame.b_reference),
            false => self.is_on_curve(frame, pointer, dot[2]),
        };
        inside.then_some(Pick::of(Handle::Plane, [x, y, dot[2]]))
    }

    /// Whether the pointer is on the present section, which is a curve at the given height.
    fn is_on_curve(&self, frame: &Frame, pointer: &Pointer, height: f64) -> bool {
        let pose = posed(Vector::default(), unit(self.space.turn(frame.b_reference)), height);
        let seen = |p: &[f32; 3]| super::place(&pose, *p).map(f64::from);
        let near =
            |w: &[[f32; 3]]| pointer.distance_to_segment([seen(&w[0]), seen(&w[1])]).is_some_and(|d| d < BAR_PICK_PX);
        self.outline.iter().any(|line| line.windows(2).any(near))
    }

    /// Returns the change that dragging an item to the pointer requests.
    pub fn aim(&self, pick: &Pick, frame: &Frame, pointer: &Pointer) -> Option<DragAction> {
        let [low, high] = self.window(frame.b_reference);
        let ray = pointer.ray()?;
        let [x, y, _] = pick.at;
        // b can be dragged slightly beyond the shown interval, so that this interval shifts.
        let slack = 0.05 * self.span;
        let b = || Some(low + ray.along_line([x, y, 0.0], [0.0, 0.0, 1.0])? / self.rise());
        match pick.handle {
            Handle::Target => ray.at_height((frame.b_reference - low) * self.rise()).map(DragAction::Target),
            Handle::Plane => Some(DragAction::B(b()?.clamp(low - slack, high + slack))),
            Handle::Bar => {
                let b = b()?;
                // The nearest b at which the point of the picked bar is reachable.
                let away = |post: &TowerPost| (post.at - Vector::new(x, y)).norm();
                let posts = self.posts(frame).into_iter();
                let (_, bars) = posts.min_by(|s, t| away(&s.0).total_cmp(&away(&t.0)))?;
                let near = bars.iter().map(|[from, to]| b.clamp(*from, *to));
                near.min_by(|s, t| (s - b).abs().total_cmp(&(t - b).abs())).map(DragAction::B)
            }
            _ => None,
        }
    }

    /// Returns the scene of a frame.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        let palette = palette(options.theme);
        let b = frame.b_reference;
        let [low, high] = self.window(b);
        let z = |b: f64| (b - low) * self.rise();
        let hot = options.highlighted == Some(Handle::Plane);
        let turned = |b: f64| posed(Vector::default(), unit(self.space.turn(b)), z(b));
        let item_changes = if self.fixed.is_some() { ItemChanges::Nothing } else { ItemChanges::Shape };
        let solid = |name: &'static str, mesh, b, colour, changes| Solid {
            name: name.into(),
            mesh,
            world_from_item: turned(b),
            colour,
            changes,
        };
        let mut scene = Scene::new(palette.background, self.model.clone());
        scene.solids = vec![
            solid("slice", 0, b, faded(palette.amber, if hot { 0.42 } else { 0.34 }), ItemChanges::Pose),
            solid("wall", 1, low, faded(palette.amber, 0.1), item_changes),
        ];
        let eye = camera.eye_direction().map(f64::from);
        axes::draw(&mut scene, &palette, &self.axes(&palette, frame, options.notation), eye, item_changes);
        self.contours(&mut scene, &palette, [low, high], eye);
        let outline = Polyline::new("slice/boundary", self.outline.clone(), if hot { 3.4 } else { 2.2 }, palette.amber);
        scene.lines.push(outline.on_top().moving(turned(b)));
        let first = scene.lines.len();
        self.bars(&mut scene, &palette, frame, [z(low), z(high)], z);
        self.course(&mut scene, &palette, z);
        if self.ends.is_some() {
            scene.lines[first..].iter_mut().for_each(|line| line.changes = item_changes);
        }
        self.target(&mut scene, &palette, frame, options, z(b));
        scene
    }

    fn axes(&self, palette: &Palette, frame: &Frame, notation: Notation) -> [Axis; 3] {
        let across = |symbol| Axis {
            symbol,
            unit: "m",
            colour: palette.dim,
            ends: [-self.radius, self.radius],
            values: [-self.radius, self.radius],
            step: round_up(self.radius / 3.0),
            decimals: 1,
            now: None,
            now_decimals: 3,
        };
        let up = Axis {
            symbol: "b",
            unit: "rad",
            colour: palette.amber,
            ends: [0.0, HEIGHT_PER_RADIUS * self.radius],
            values: self.window(frame.b_reference),
            step: round_up(self.span / 6.0),
            decimals: 0,
            now: Some((frame.b_reference, palette.amber)),
            now_decimals: 3,
        };
        [across("x"), across("y"), up].map(|axis| axis.shown_in(notation))
    }

    /// Draws the contours; those on the far side of the wall are fainter. A fixed tower is recorded for all directions
    /// of view, so all its contours are alike.
    fn contours(&self, scene: &mut Scene, palette: &Palette, [low, high]: [f64; 2], eye: [f64; 3]) {
        let line = |name: &'static str, strips: Strips, strength| {
            Polyline::new(name, strips, 1.0, faded(palette.amber, strength)).on_top()
        };
        if self.fixed.is_some() {
            scene.lines.push(line("contours", self.contours.clone(), 0.55).constant());
            return;
        }
        let (mut near_ones, mut far_ones) = (Vec::new(), Vec::new());
        for b in contours([low, high]) {
            let z = (b - low) * self.rise();
            for (piece, near) in self.wall.contour(self.space.turn(b), eye) {
                let side = if near { &mut near_ones } else { &mut far_ones };
                side.push(piece.into_iter().map(|p| point(p, z)).collect());
            }
        }
        scene.lines.push(line("contours", near_ones.into(), 0.55));
        scene.lines.push(line("contours/hidden", far_ones.into(), 0.2));
    }

    /// Draws the vertical lines of the task's points, or of the target, and the intervals of b for which they are
    /// reachable.
    fn bars(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        frame: &Frame,
        [floor, top]: [f64; 2],
        z: impl Fn(f64) -> f64,
    ) {
        let head = top + 0.05 * self.radius;
        let posts = self.posts(frame);
        let uprights: Vec<_> =
            posts.iter().map(|(post, _)| vec![point(post.at, floor), point(post.at, head)]).collect();
        scene.lines.push(Polyline::new("points", uprights, 1.3, faded(palette.ink, 0.6)).dashed(1.5, 3.5).on_top());
        for (post, bars) in posts {
            // An interval of nearly zero length is drawn as a dot.
            for [from, to] in bars.iter().filter(|[from, to]| (to - from) * self.rise() < 1e-3 * self.radius) {
                let at = point(post.at, z(0.5 * (from + to)));
                scene.markers.push(Marker::disc("reach/alone", at, 5.0, palette.zero));
            }
            let bars: Vec<_> = bars.iter().map(|ends| ends.map(|b| point(post.at, z(b))).to_vec()).collect();
            let name = format!("reach/{}", post.name);
            scene.lines.push(Polyline::new(name, bars, 6.0, faded(palette.zero, 0.85)).on_top());
            let (at, offset) = (point(post.at, head), [0.0, -11.0]);
            let label = Label::new("points/names", at, offset, post.name, palette.ink, 13.0, Anchor::Centre);
            scene.labels.push(label);
        }
    }

    fn course(&self, scene: &mut Scene, palette: &Palette, z: impl Fn(f64) -> f64) {
        if self.course.len() < 2 {
            return;
        }
        let points = self.course.iter().map(|(p, b)| point(*p, z(*b))).collect();
        scene.lines.push(Polyline::new("path", [points], 2.0, palette.ink).dashed(2.0, 3.5).on_top());
    }

    fn target(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, options: &ViewOptions, z: f64) {
        let outside = matches!(frame.target.reach, Reach::Outside { .. });
        let held = options.drag_position.filter(|_| outside).map(|[x, y]| Vector::new(x, y));
        let at = held.unwrap_or_else(|| tip(frame));
        let end = point(frame.in_base(frame.end_effector), z);
        if outside {
            let gap = Polyline::new("target/gap", [vec![end, point(at, z)]], 1.4, palette.dim);
            scene.lines.push(gap.dashed(4.0, 4.0).on_top());
        }
        let hot = options.highlighted == Some(Handle::Target);
        let inside = faded(palette.ink, if hot && !outside { 0.12 } else { 0.0 });
        scene.markers.push(Marker::disc("end_effector", end, 4.0, palette.ink));
        let ring = Marker::disc("target", point(at, z), if hot { 12.0 } else { 10.0 }, inside);
        scene.markers.push(ring.edged(palette.ink, 2.0));
    }
}

/// Returns the workspace at b = 0 as a mesh over a grid of (a_1, a_2). It is a shell and not an [`Area`](super::Area),
/// because areas are drawn under lines and the grid of the axes would cover them.
fn sheet(map: &PlaneMap, cells: u32) -> Mesh {
    let [l1, l2] = map.limits();
    let share = |l: AngleLimit, i: u32| l.min + f64::from(i) / f64::from(cells) * (l.max - l.min);
    let mut mesh = Mesh { shell: true, ..Mesh::default() };
    for (i, j) in (0..=cells).flat_map(|i| (0..=cells).map(move |j| (i, j))) {
        mesh.positions.push(point(map.forward_unturned([share(l1, i), share(l2, j)]), 0.0));
        mesh.normals.push([0.0, 0.0, 1.0]);
    }
    for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
        let [a, b] = [i * (cells + 1) + j, (i + 1) * (cells + 1) + j];
        mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
    }
    mesh
}

/// Returns the position of the target's handle in the axes of the base, m.
fn tip(frame: &Frame) -> Vector {
    if frame.target_rides { frame.in_base(target_handle(frame)) } else { target_handle(frame) }
}

/// Returns a post with its intervals of b within a window, rad.
fn barred(post: &TowerPost, window: [f64; 2]) -> (TowerPost, Vec<[f64; 2]>) {
    let bars = post.reach.as_ref().map_or_else(Vec::new, |set| within(set, window));
    (post.clone(), bars)
}

/// Returns the b of contours: multiples of [`CONTOUR_STEP_RAD`], and both ends.
fn contours([low, high]: [f64; 2]) -> impl Iterator<Item = f64> {
    let first = (low / CONTOUR_STEP_RAD).ceil();
    let inner = (0..200).map(move |i| (first + f64::from(i)) * CONTOUR_STEP_RAD).take_while(move |b| *b <= high);
    inner.chain([low, high])
}

/// Returns the intervals of a periodic set within a window of the real line, in ascending order.
fn within(set: &BSet, [low, high]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut shown = Vec::new();
    for [from, to] in &set.intervals {
        let first = ((low - to) / set.period).ceil();
        for turn in (0..8).map(|i| (first + f64::from(i)) * set.period).take_while(|turn| from + turn <= high) {
            shown.push([(from + turn).max(low), (to + turn).min(high)]);
        }
    }
    shown.sort_by(|s, t| s[0].total_cmp(&t[0]));
    shown
}
