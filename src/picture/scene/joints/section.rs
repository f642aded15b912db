//! [`JointSection`]: joint space of a machine without closed-form [planes](PoseSpace::planes). With two drives it is a
//! plane, in which b = const is a line. With more, three drives have axes, and the others are held at their present
//! angles. In this section, b = const is a plane.
//!
//! The unit of the scene is the radian, and the chosen drives are along x, y and z. The origin moves with b, unless
//! the shown interval of b is constant.

use std::sync::Arc;

use super::items;
use super::range::ShownRange;
use crate::notation::Notation;
use crate::numbers::{degrees, round_up, signed};
use crate::scene::camera::{Camera, FlatCamera, Orbit};
use crate::scene::course::stations;
use crate::scene::options::{Handle, ViewOptions};
use crate::scene::palette::{Palette, faded, palette};
use crate::scene::pick::{DragAction, PICK_RADIUS, Pick};
use crate::scene::pointer::{Pointer, dot};
use crate::scene::{Anchor, IN_PLACE, ItemChanges, Label, Mesh, MeshSet, Polyline, Scene, Solid, axes};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::pose_space::{PoseSpace, RelativeJoint};
use stillbase_session::Run;
use stillbase_simulation::frame::Frame;

/// Centre of the shown interval of b while the present b is well inside, rad.
const HOME_B_RAD: f64 = 1.5;
/// Margin around all poses, rad.
const MARGIN_RAD: f64 = 0.2;

/// The parts of joint space that do not change from frame to frame.
#[derive(Clone, Debug)]
pub(super) struct JointSection {
    space: Arc<PoseSpace>,
    /// Indices of the two or three drives along the axes, from 0.
    shown: Vec<usize>,
    /// The planned motion; empty without a plan.
    course: Vec<DriveAngles>,
    /// Bounds of the box along the axes of the scene.
    bounds: [[f64; 2]; 3],
    /// Symbols of the angles.
    symbols: &'static [&'static str; 8],
    /// Interval of b that is shown.
    range: ShownRange,
}

impl JointSection {
    /// Prepares the joint space of a run; `None` with one drive only. If an interval `all` of b is given, rad, the
    /// shown interval is constant and contains it, and the coordinates of the scene are q itself.
    pub fn of(run: &Run, space: &Arc<PoseSpace>, all: Option<[f64; 2]>) -> Option<Self> {
        let range = all.map_or_else(|| ShownRange::sliding(HOME_B_RAD), |all| ShownRange::over(all, HOME_B_RAD));
        let n = space.drives();
        let course = run.motion().map(|motion| stations(motion).map(|s| motion.path.at(s).q).collect());
        let shown = (0..n.min(3)).collect();
        let (space, course, bounds) = (space.clone(), course.unwrap_or_default(), [[0.0; 2]; 3]);
        let symbols = items::symbols(run);
        (n > 1).then(|| Self { space, shown, course, bounds, symbols, range }.bounded())
    }

    /// Sets the drives along the axes, indices from 0; has no effect if the machine lacks one of them.
    pub fn show(&mut self, drives: [usize; 3]) {
        let fits = drives.iter().all(|k| *k < self.space.drives());
        if !self.is_flat() && fits && self.shown != drives {
            self.shown = drives.to_vec();
            *self = self.clone().bounded();
        }
    }

    /// Indices of the drives along the axes, from 0.
    pub fn drives(&self) -> &[usize] {
        &self.shown
    }

    /// Whether there are drives without an axis.
    pub fn has_choice(&self) -> bool {
        self.shown.len() < self.space.drives()
    }

    fn is_flat(&self) -> bool {
        self.shown.len() < 3
    }

    /// Returns q at the origin of the scene, rad; `b` is the present pose constant.
    fn origin(&self, b: f64) -> DriveAngles {
        if self.range.is_fixed() {
            return DriveAngles(PerDrive::zeros(self.space.drives()));
        }
        let [low, high] = self.range.about(b);
        self.space.lift(&self.space.middle(), 0.5 * (low + high))
    }

    /// Converts q to a point of the scene; `b` is the present pose constant.
    pub fn point(&self, q: &[f64], b: f64) -> [f64; 3] {
        let origin = self.origin(b);
        let mut at = [0.0; 3];
        for (x, k) in at.iter_mut().zip(&self.shown) {
            *x = q[*k] - origin[*k];
        }
        at
    }

    /// Converts a point of the scene to q, rad; drives without an axis have the same angles as in `frame`.
    pub fn angles(&self, point: [f64; 3], frame: &Frame) -> Vec<f64> {
        let origin = self.origin(frame.b_reference);
        let mut q = now(frame);
        for (x, k) in point.iter().zip(&self.shown) {
            q[*k] = origin[*k] + x;
        }
        q
    }

    /// Sets the box to the bounding box of all poses within the joint limits and the shown interval of b.
    fn bounded(self) -> Self {
        let joints = self.space.joints();
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for i in 0..1_usize << joints.len() {
            let a: Vec<f64> = joints.iter().enumerate().map(|(j, joint)| joint.limits()[(i >> j) & 1]).collect();
            for b in self.range.about(HOME_B_RAD) {
                let at = self.point(&self.space.lift(&a, b), HOME_B_RAD);
                for (bound, x) in bounds.iter_mut().zip(at) {
                    *bound = [bound[0].min(x - MARGIN_RAD), bound[1].max(x + MARGIN_RAD)];
                }
            }
        }
        if self.is_flat() {
            bounds[2] = [0.0, 0.0];
        }
        Self { bounds, ..self }
    }

    /// Bounds of the box along the axes of the scene.
    pub fn bounds(&self) -> [[f64; 2]; 3] {
        self.bounds
    }

    /// Returns the camera: from straight above for two axes, in perspective for three.
    pub fn camera(&self) -> Camera {
        let ends = self.bounds;
        let size = ends.iter().map(|[from, to]| (to - from) * (to - from)).sum::<f64>().sqrt();
        let [x, y, z] = ends.map(|[from, to]| if self.range.is_fixed() { 0.5 * (from + to) } else { 0.0 });
        if self.is_flat() {
            return Camera::Flat(FlatCamera { centre: [x, y], half_height: 0.5 * size });
        }
        // With a fixed interval, the camera is nearer.
        let near = if self.range.is_fixed() { 1.05 } else { 1.85 };
        Camera::Orbit(Orbit { centre: [x, y, z - 0.06 * size], distance: near * size, yaw: 1.85, pitch: 0.5 })
    }

    /// Components of λ along the axes.
    fn normal(&self) -> [f64; 3] {
        let mut normal = [0.0; 3];
        normal.iter_mut().zip(&self.shown).for_each(|(x, k)| *x = self.space.lambda()[*k]);
        normal
    }

    /// Returns the ends or corners, in order, of the line or plane of constant b within the joint limits and the box.
    /// Drives without an axis have the same angles as in `frame`.
    pub fn surface(&self, b: f64, frame: &Frame) -> Vec<[f64; 3]> {
        let normal = self.normal();
        let size = dot(normal, normal);
        if size < 1e-12 {
            return Vec::new();
        }
        let bounds = self.bounds;
        let far = bounds.iter().map(|[from, to]| to - from).sum::<f64>();
        // Starts with a segment or square about the foot of the perpendicular from the origin, larger than the box.
        let off = (b - self.space.b(&self.angles([0.0; 3], frame))) / size;
        let foot = normal.map(|x| off * x);
        let mut part: Vec<[f64; 3]> = if self.is_flat() {
            let along = [-normal[1], normal[0], 0.0].map(|x| far * x / size.sqrt());
            [1.0, -1.0].map(|s| [0, 1, 2].map(|i| foot[i] + s * along[i])).to_vec()
        } else {
            let least = (0..3).min_by(|i, j| normal[*i].abs().total_cmp(&normal[*j].abs())).unwrap_or(0);
            let mut other = [0.0; 3];
            other[least] = 1.0;
            let [u, v] = {
                let u = unit(cross(normal, other));
                [u, unit(cross(normal, u))]
            };
            let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
            corners.map(|[s, t]| [0, 1, 2].map(|i| foot[i] + far * (s * u[i] + t * v[i]))).to_vec()
        };
        for (i, [from, to]) in bounds.iter().enumerate().take(self.shown.len()) {
            part = clipped(&part, |p| p[i] - from);
            part = clipped(&part, |p| to - p[i]);
        }
        for joint in self.space.joints() {
            let [low, high] = joint.bounds();
            if low.is_finite() && high.is_finite() {
                part = clipped(&part, |p| joint.of(&self.angles(*p, frame)) - low);
                part = clipped(&part, |p| high - joint.of(&self.angles(*p, frame)));
            }
        }
        part.dedup_by(|p, q| distance(*p, *q) < 1e-9);
        part
    }

    fn pose(&self, frame: &Frame) -> [f64; 3] {
        self.point(&now(frame), frame.b_reference)
    }

    /// Returns the point under the pointer, on the plane of constant b, or on the plane of two drives.
    fn under(&self, frame: &Frame, pointer: &Pointer) -> Option<[f64; 3]> {
        if self.is_flat() {
            let [x, y] = pointer.ray()?.at_height(0.0)?;
            return Some([x, y, 0.0]);
        }
        let off = frame.b_reference - self.space.b(&self.angles([0.0; 3], frame));
        pointer.ray()?.at_plane(self.normal(), off)
    }

    /// Returns the item under the pointer that can be dragged: the dot of the pose, or the line or plane.
    pub fn pick(&self, frame: &Frame, pointer: &Pointer) -> Option<Pick> {
        let dot = self.pose(frame);
        if pointer.distance(dot).is_some_and(|d| d < PICK_RADIUS) {
            return Some(Pick::of(Handle::Target, dot));
        }
        let at = self.under(frame, pointer)?;
        let part = self.surface(frame.b_reference, frame);
        let on = match (self.is_flat(), part.as_slice()) {
            (true, [from, to, ..]) => pointer.distance_to_segment([*from, *to]).is_some_and(|d| d < 0.5 * PICK_RADIUS),
            (true, _) => false,
            _ => {
                let within = |joint: &RelativeJoint| {
                    let ([low, high], a) = (joint.bounds(), joint.of(&self.angles(at, frame)));
                    (low..=high).contains(&a)
                };
                let bounds = self.bounds;
                self.space.joints().iter().all(within) && (0..3).all(|i| (bounds[i][0]..=bounds[i][1]).contains(&at[i]))
            }
        };
        on.then_some(Pick::of(Handle::Plane, at))
    }

    /// Returns the change that dragging an item requests: the dot moves at constant b, the line or plane changes b.
    pub fn aim(&self, pick: &Pick, frame: &Frame, pointer: &Pointer) -> Option<DragAction> {
        let (b, space) = (frame.b_reference, &self.space);
        match pick.handle {
            Handle::Target => {
                let a = space.clamped(&space.angles(&self.angles(self.under(frame, pointer)?, frame)));
                let p = space.end_effector(&space.lift(&a, b));
                Some(DragAction::Target([p.re, p.im]))
            }
            Handle::Plane => {
                let at = if self.is_flat() {
                    self.under(frame, pointer)?
                } else {
                    let normal = self.normal();
                    let s = pointer.ray()?.along_line(pick.at, normal)?;
                    [0, 1, 2].map(|i| pick.at[i] + s * normal[i])
                };
                let [low, high] = self.range.about(b);
                Some(DragAction::B(space.b(&self.angles(at, frame)).clamp(low, high)))
            }
            _ => None,
        }
    }

    /// Returns the scene of a frame.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        let palette = palette(options.theme);
        let b = frame.b_reference;
        let hot = options.highlighted == Some(Handle::Plane);
        let part = self.surface(b, frame);
        let mut scene = Scene::new(palette.background, Arc::new(MeshSet { meshes: vec![fan(&part)] }));
        if self.is_flat() {
            self.grid(&mut scene, &palette, frame, options.notation);
            self.limits(&mut scene, &palette, frame);
        } else {
            let colour = faded(palette.amber, if hot { 0.42 } else { 0.34 });
            let (name, changes) = ("plane".into(), ItemChanges::Shape);
            scene.solids.push(Solid { name, mesh: 0, world_from_item: IN_PLACE, colour, changes });
            let eye = camera.eye_direction().map(f64::from);
            let drives = [0, 1, 2].map(|i| self.shown[i]);
            let axes =
                items::axes(&palette, frame, (drives, self.symbols), self.bounds, &self.origin(b), options.notation);
            axes::draw(&mut scene, &palette, &axes, eye, self.range.changes());
        }
        self.neighbours(&mut scene, &palette, frame);
        let width = if hot { 3.4 } else { 2.2 };
        scene.lines.push(Polyline::new("plane/boundary", [closed(&part)], width, palette.amber).on_top());
        if let Some(at) = self.label(&part, self.pose(frame)) {
            let text = items::named(b, self.space.is_reactionless());
            let label = Label::new("plane/label", at, [0.0, -14.0], text, palette.amber, 12.5, Anchor::Centre);
            scene.labels.push(label);
        }
        self.course(&mut scene, &palette, b);
        items::draw_pose(&mut scene, &palette, self.pose(frame), options.highlighted == Some(Handle::Target));
        scene
    }

    /// Returns the position of the label: beyond the end or corner that is farthest from the pose.
    fn label(&self, part: &[[f64; 3]], pose: [f64; 3]) -> Option<[f32; 3]> {
        let far = part.iter().max_by(|p, q| distance(**p, pose).total_cmp(&distance(**q, pose)))?;
        let middle = [0, 1, 2].map(|i| part.iter().map(|p| p[i]).sum::<f64>() / part.len() as f64);
        Some([0, 1, 2].map(|i| (far[i] + 0.06 * (far[i] - middle[i])) as f32))
    }

    /// Draws the grid of the plane of two drives at angles that are round in the user's unit, with the current angles
    /// at its edges.
    fn grid(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, notation: Notation) {
        let (bounds, origin, pose) = (self.bounds, self.origin(frame.b_reference), self.pose(frame));
        let longest = (0..2).map(|i| bounds[i][1] - bounds[i][0]).fold(0.0, f64::max);
        let unit = notation.shown_unit("rad");
        let factor = unit.map_or(1.0, |unit| unit.factor);
        let step = round_up(factor * longest / 8.0);
        let (decimals, step) = (usize::from(step < 1.0), step / factor);
        let at = |i: usize, x: f64, y: f64| if i == 0 { [x, y] } else { [y, x] }.map(|x| x as f32);
        let flat = |[x, y]: [f32; 2]| [x, y, 0.0_f32];
        let mut lines = Vec::new();
        for i in 0..2 {
            let (k, [from, to], [low, high]) = (self.shown[i], bounds[i], bounds[1 - i]);
            let offset = if i == 0 { [0.0, 13.0] } else { [-8.0, 0.0] };
            let anchor = if i == 0 { Anchor::Centre } else { Anchor::Right };
            let mut value = ((from + origin[k]) / step).ceil() * step;
            while value <= to + origin[k] {
                let x = value - origin[k];
                lines.push([low, high].map(|y| flat(at(i, x, y))).to_vec());
                // The label of the current value replaces a nearby tick label.
                if (x - pose[i]).abs() > 0.05 * (to - from) {
                    let text = signed(factor * value + 0.0, decimals);
                    let label = Label::new("axes/words", flat(at(i, x, low)), offset, text, palette.dim, 11.5, anchor);
                    scene.labels.push(label);
                }
                value += step;
            }
            let tone = palette.drive(k);
            let text = signed(factor * frame.relative(k), unit.map_or(3, |unit| unit.decimals(3)));
            let foot = flat(at(i, pose[i], low));
            let label = Label::new("axes/now/words", foot, offset, text, tone, 12.5, anchor);
            scene.labels.push(label);
            let drop = vec![pose.map(|x| x as f32), foot];
            let name = ["pose/drop/1", "pose/drop/2"][i];
            scene.lines.push(Polyline::new(name, [drop], 1.3, faded(tone, 0.75)).dashed(3.0, 3.0));
            let end = flat(at(i, to, low));
            let offset = if i == 0 { [12.0, 13.0] } else { [-8.0, -14.0] };
            let anchor = if i == 0 { Anchor::Left } else { Anchor::Right };
            let title = format!("{}, {}", self.symbols[k], notation.unit_name("rad"));
            scene.labels.push(Label::new("axes/titles", end, offset, title, tone, 12.5, anchor));
        }
        scene.lines.insert(0, Polyline::new("axes/grid", lines, 1.0, faded(palette.line, 0.7)));
    }

    /// Draws, for two drives, the lines on which the relative angle is at a limit.
    fn limits(&self, scene: &mut Scene, palette: &Palette, frame: &Frame) {
        let Some(joint) = self.space.joints().first().filter(|joint| joint.bounds()[0].is_finite()) else { return };
        let bounds = self.bounds;
        for limit in joint.limits() {
            // The line has the direction (1, 1) and ends at edges of the grid.
            let off = limit - joint.of(&self.angles([0.0; 3], frame));
            let rise = joint.of(&self.angles([0.0, 1.0, 0.0], frame)) - joint.of(&self.angles([0.0; 3], frame));
            let lift = off / rise;
            let from = bounds[0][0].max(bounds[1][0] - lift);
            let to = bounds[0][1].min(bounds[1][1] - lift);
            if from >= to {
                continue;
            }
            let ends = [from, to].map(|x| [x as f32, (x + lift) as f32, 0.0]);
            scene.lines.push(Polyline::new("limits", [ends.to_vec()], 1.2, faded(palette.dim, 0.8)));
            let (text, offset) = (format!("a₁ = {}°", degrees(limit)), [10.0, 0.0]);
            let label = Label::new("plane/limits", ends[1], offset, text, palette.dim, 10.5, Anchor::Left);
            scene.labels.push(label);
        }
    }

    fn neighbours(&self, scene: &mut Scene, palette: &Palette, frame: &Frame) {
        let others = self.range.neighbours(frame.b_reference);
        let outlines: Vec<_> = others.map(|of| closed(&self.surface(of, frame))).filter(|o| o.len() > 1).collect();
        scene.lines.push(Polyline::new("planes", outlines, 1.0, faded(palette.amber, 0.3)).on_top());
    }

    /// Draws the planned motion along the shown drives.
    fn course(&self, scene: &mut Scene, palette: &Palette, b: f64) {
        let points: Vec<_> = self.course.iter().map(|q| self.point(q, b).map(|x| x as f32)).collect();
        let [first, .., last] = points[..] else { return };
        let path = Polyline::new("path", [points.clone()], 2.0, palette.ink).dashed(2.0, 3.5).on_top();
        scene.lines.push(if self.range.is_fixed() { path.constant() } else { path });
        items::draw_ends(scene, palette, [first, last]);
    }
}

/// Drive angles relative to the base, rad.
fn now(frame: &Frame) -> Vec<f64> {
    (0..frame.q.len()).map(|k| frame.relative(k)).collect()
}

/// Clips a convex polygon, or a segment, to the half space in which a linear function is non-negative.
fn clipped(part: &[[f64; 3]], of: impl Fn(&[f64; 3]) -> f64) -> Vec<[f64; 3]> {
    let mut kept = Vec::with_capacity(part.len() + 1);
    for (i, p) in part.iter().enumerate() {
        let q = &part[(i + 1) % part.len()];
        let (here, there) = (of(p), of(q));
        if here >= 0.0 {
            kept.push(*p);
        }
        if (here >= 0.0) != (there >= 0.0) {
            let share = here / (here - there);
            kept.push([0, 1, 2].map(|k| p[k] + share * (q[k] - p[k])));
        }
    }
    kept.dedup_by(|p, q| distance(*p, *q) < 1e-12);
    if kept.len() > 2 && distance(kept[0], kept[kept.len() - 1]) < 1e-12 {
        kept.pop();
    }
    kept
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    let d = [0, 1, 2].map(|i| p[i] - q[i]);
    dot(d, d).sqrt()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let size = dot(a, a).sqrt().max(1e-300);
    a.map(|x| x / size)
}

/// Returns the outline of a polygon as a closed line.
fn closed(part: &[[f64; 3]]) -> Vec<[f32; 3]> {
    part.iter().chain(part.first()).map(|p| p.map(|x| x as f32)).collect()
}

/// Returns a convex polygon as an open shell.
fn fan(part: &[[f64; 3]]) -> Mesh {
    let mut mesh = Mesh { shell: true, ..Mesh::default() };
    let [a, b, c, ..] = *part else { return mesh };
    let normal = unit(cross([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i])));
    mesh.positions.extend(part.iter().map(|p| p.map(|x| x as f32)));
    mesh.normals.extend(part.iter().map(|_| normal.map(|x| x as f32)));
    mesh.triangles.extend((1..part.len() as u32 - 1).map(|i| [0, i, i + 1]));
    mesh
}
