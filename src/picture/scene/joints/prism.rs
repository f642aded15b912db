//! [`Prism`]: joint space of a machine with planes. Its axes are the drive angles q_1, q_2, q_3, so the planes
//! b = Σ λ_k q_k, (13), appear as planes. The limits of a_1 and a_2 bound a parallelogram in each plane. All
//! parallelograms together form a prism along (1, 1, 1), because equal rotations of all drives change no relative
//! angle.
//!
//! The axis of the drive with the largest λ points up, so the planes are nearly horizontal. The other drives follow in
//! order (q_2, q_3, q_1 for the paper's machine). The unit of the scene is the radian, and the origin is
//! [`Prism::origin`].

use std::sync::Arc;

use super::items;
use super::range::ShownRange;
use crate::numbers::degrees;
use crate::scene::camera::{Camera, Orbit};
use crate::scene::course::stations;
use crate::scene::options::{Handle, ViewOptions};
use crate::scene::palette::{Palette, faded, palette};
use crate::scene::pick::{DragAction, PICK_RADIUS, Pick};
use crate::scene::pointer::{Pointer, dot};
use crate::scene::{
    Anchor, IN_PLACE, ItemChanges, Label, Marker, Mesh, MeshSet, Polyline, Scene, Solid, Strips, Transform, axes, place,
};
use stillbase_planning::pose_space::Planes;
use stillbase_planning::reactionless::PlanePoint;
use stillbase_session::Run;
use stillbase_simulation::frame::Frame;

/// Centre of the shown interval of b while the present b is well inside, rad.
const HOME_B_RAD: f64 = 2.5;
/// Minimum variation of b over a run for which the camera looks across the prism, rad.
const LARGE_B_CHANGE_RAD: f64 = 0.3;
/// Margin around the prism, rad.
const MARGIN_RAD: f64 = 0.25;

/// The parts of joint space that do not change from frame to frame.
#[derive(Clone, Debug)]
pub(super) struct Prism {
    planes: Arc<Planes>,
    /// Meshes of the parallelogram of one plane and of the sides of the prism.
    model: Arc<MeshSet>,
    /// Index of the drive along each axis of the scene, from 0.
    drives: [usize; 3],
    /// Outline of the parallelogram.
    outline: Strips,
    /// (a_1, a_2) at the corners of the parallelogram, in order, rad.
    corners: [[f64; 2]; 4],
    /// The planned motion along the axes of the scene, with origin q = 0; empty without a plan.
    course: Strips,
    /// Symbols of the angles.
    symbols: &'static [&'static str; 8],
    /// Interval of b that is shown.
    range: ShownRange,
    /// Whether b changes so much that the camera looks across the prism.
    b_varies: bool,
}

impl Prism {
    /// Prepares a run with planes. With an interval `all` of b, rad, the shown interval is constant and contains it,
    /// and coordinates of the scene are q itself.
    pub fn of(run: &Run, all: Option<[f64; 2]>) -> Option<Self> {
        let range = all.map_or_else(|| ShownRange::sliding(HOME_B_RAD), |all| ShownRange::over(all, HOME_B_RAD));
        let planes = run.planes()?.clone();
        let map = planes.map();
        let lambda = map.lambda();
        let up = (0..3).max_by(|i, j| lambda[*i].total_cmp(&lambda[*j]))?;
        let [a1, a2] = map.limits();
        let corners = [[a1.min, a2.min], [a1.max, a2.min], [a1.max, a2.max], [a1.min, a2.max]];
        let drives = [1, 2, 3].map(|i| (up + i) % 3);
        let course = run.motion().map(|motion| {
            let at = |s: f64| motion.path.at(s).q;
            stations(motion).map(at).map(|q| drives.map(|k| q[k] as f32)).collect()
        });
        let course = course.into_iter().collect();
        let mut space = Self {
            model: Arc::default(),
            outline: Strips::default(),
            b_varies: all.is_some_and(|[low, high]| high - low > LARGE_B_CHANGE_RAD),
            drives,
            corners,
            course,
            symbols: items::symbols(run),
            planes,
            range,
        };
        let [low, high] = range.about(HOME_B_RAD);
        let ring = |b: f64| space.surface(b, HOME_B_RAD);
        let (own, bottom, top) = (ring(HOME_B_RAD), ring(low), ring(high));
        let sides = (0..4).flat_map(|i| {
            let j = (i + 1) % 4;
            [[bottom[i], bottom[j], top[j]], [bottom[i], top[j], top[i]]]
        });
        let faces = [[own[0], own[1], own[2]], [own[0], own[2], own[3]]];
        let meshes = vec![shell(faces), shell(sides)];
        space.model = Arc::new(MeshSet { meshes });
        space.outline = [space.polygon(HOME_B_RAD, HOME_B_RAD)].into();
        Some(space)
    }

    /// Index of the drive along each axis of the scene, from 0; the last axis points up.
    pub fn drives(&self) -> &[usize; 3] {
        &self.drives
    }

    /// Returns q at the corners of a plane, in order, rad.
    fn corners(&self, b: f64) -> [[f64; 3]; 4] {
        self.corners.map(|a| self.planes.map().lift(PlanePoint { a, b }))
    }

    /// Returns q at the origin of the scene, in the order of the drives, rad; `b` is the present pose constant.
    fn origin(&self, b: f64) -> [f64; 3] {
        if self.range.is_fixed() {
            return [0.0; 3];
        }
        let [low, high] = self.range.about(b);
        self.middle(0.5 * (low + high))
    }

    /// Converts q to a point of the scene; `b` is the present pose constant.
    pub fn point(&self, q: &[f64], b: f64) -> [f64; 3] {
        let origin = self.origin(b);
        self.drives.map(|k| q[k] - origin[k])
    }

    /// Returns the corners, in order, of the plane of the pose constant `of`; `b` is the present pose constant.
    pub fn surface(&self, of: f64, b: f64) -> [[f64; 3]; 4] {
        self.corners(of).map(|q| self.point(&q, b))
    }

    /// Converts a point of the scene to q, rad; `b` is the present pose constant.
    pub fn angles(&self, point: [f64; 3], b: f64) -> [f64; 3] {
        let mut q = self.origin(b);
        for (k, x) in self.drives.into_iter().zip(point) {
            q[k] += x;
        }
        q
    }

    /// Returns a camera that shows the whole prism.
    pub fn camera(&self) -> Camera {
        if self.range.is_fixed() {
            return self.camera_over();
        }
        let size = self.bounds(HOME_B_RAD).iter().map(|[from, to]| (to - from) * (to - from)).sum::<f64>().sqrt();
        Camera::Orbit(Orbit { centre: [0.0, 0.0, -0.06 * size], distance: 1.85 * size, yaw: 1.85, pitch: 0.66 })
    }

    /// Returns the camera for a fixed interval. If b changes much, the path runs along (1, 1, 1) and is viewed from the
    /// side.
    fn camera_over(&self) -> Camera {
        let ends = self.bounds(HOME_B_RAD);
        let size = ends.iter().map(|[from, to]| (to - from) * (to - from)).sum::<f64>().sqrt();
        let [x, y, z] = ends.map(|[from, to]| 0.5 * (from + to));
        let (yaw, distance) = if self.b_varies { (-0.45, 1.2 * size) } else { (1.85, 1.05 * size) };
        Camera::Orbit(Orbit { centre: [x, y, z - 0.05 * size], distance, yaw, pitch: 0.66 })
    }

    /// Bounds of the box around the prism in its usual position, along the axes of the scene.
    pub fn bounds_at_home(&self) -> [[f64; 2]; 3] {
        self.bounds(HOME_B_RAD)
    }

    /// Bounds of the box along the axes of the scene; `b` is the present pose constant.
    fn bounds(&self, b: f64) -> [[f64; 2]; 3] {
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for edge in self.range.about(b) {
            for p in self.surface(edge, b) {
                for (bound, x) in bounds.iter_mut().zip(p) {
                    *bound = [bound[0].min(x - MARGIN_RAD), bound[1].max(x + MARGIN_RAD)];
                }
            }
        }
        bounds
    }

    fn normal(&self) -> [f64; 3] {
        let lambda = self.planes.map().lambda();
        self.drives.map(|k| lambda[k])
    }

    /// Returns the pose constant of a point of the scene; `b` is the present one.
    fn b_at(&self, point: [f64; 3], b: f64) -> f64 {
        self.planes.map().project(&self.angles(point, b)).b
    }

    /// Returns the point of the plane b under the pointer.
    fn on_plane(&self, b: f64, pointer: &Pointer) -> Option<[f64; 3]> {
        pointer.ray()?.at_plane(self.normal(), b - self.b_at([0.0; 3], b))
    }

    fn pose(&self, frame: &Frame) -> [f64; 3] {
        self.point(&[0, 1, 2].map(|k| frame.relative(k)), frame.b_reference)
    }

    /// Returns the item under the pointer that can be dragged: the dot of the pose, or the plane.
    pub fn pick(&self, frame: &Frame, pointer: &Pointer) -> Option<Pick> {
        let (b, dot) = (frame.b_reference, self.pose(frame));
        if pointer.distance(dot).is_some_and(|d| d < PICK_RADIUS) {
            return Some(Pick::of(Handle::Target, dot));
        }
        let at = self.on_plane(b, pointer)?;
        let a = self.planes.map().project(&self.angles(at, b)).a;
        let limits = self.planes.map().limits();
        let inside = (0..2).all(|i| limits[i].contains(a[i], 0.0));
        inside.then_some(Pick::of(Handle::Plane, at))
    }

    /// Returns the change that dragging an item requests: the dot moves in its plane, the plane along its normal.
    pub fn aim(&self, pick: &Pick, frame: &Frame, pointer: &Pointer) -> Option<DragAction> {
        let (b, map) = (frame.b_reference, self.planes.map());
        match pick.handle {
            Handle::Target => {
                let at = self.on_plane(b, pointer)?;
                let p = map.forward(map.clamp(map.project(&self.angles(at, b)).a), b);
                Some(DragAction::Target([p.re, p.im]))
            }
            Handle::Plane => {
                let normal = self.normal();
                let s = pointer.ray()?.along_line(pick.at, normal)?;
                let at = [0, 1, 2].map(|i| pick.at[i] + s * normal[i]);
                let [low, high] = self.range.about(b);
                Some(DragAction::B(self.b_at(at, b).clamp(low, high)))
            }
            _ => None,
        }
    }

    /// Returns the scene of a frame.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        let palette = palette(options.theme);
        let b = frame.b_reference;
        let hot = options.highlighted == Some(Handle::Plane);
        let solid = |name: &'static str, mesh, world_from_item, colour, changes| Solid {
            name: name.into(),
            mesh,
            world_from_item,
            colour,
            changes,
        };
        let mut scene = Scene::new(palette.background, self.model.clone());
        // The meshes have the coordinates of the scene for b = HOME_B_RAD.
        let plane = shifted(self.point(&self.middle(b), b), self.point(&self.middle(HOME_B_RAD), HOME_B_RAD));
        scene.solids = vec![
            solid("prism", 1, IN_PLACE, faded(palette.dim, 0.07), ItemChanges::Nothing),
            solid("plane", 0, plane, faded(palette.amber, if hot { 0.42 } else { 0.34 }), ItemChanges::Pose),
        ];
        let eye = camera.eye_direction().map(f64::from);
        let axes = items::axes(
            &palette,
            frame,
            (self.drives, self.symbols),
            self.bounds(b),
            &self.origin(b),
            options.notation,
        );
        axes::draw(&mut scene, &palette, &axes, eye, self.range.changes());
        self.prism(&mut scene, &palette, b);
        self.neighbours(&mut scene, &palette, b);
        self.plane(&mut scene, &palette, frame, plane, hot);
        self.drops(&mut scene, &palette, frame, eye);
        self.course(&mut scene, &palette, b);
        items::draw_pose(&mut scene, &palette, self.pose(frame), options.highlighted == Some(Handle::Target));
        scene
    }

    /// Returns the closed outline of the plane of the pose constant `of`; `b` is the present pose constant.
    fn polygon(&self, of: f64, b: f64) -> Vec<[f32; 3]> {
        let corners = self.surface(of, b).map(|p| p.map(|x| x as f32));
        (0..5).map(|i| corners[i % 4]).collect()
    }

    fn prism(&self, scene: &mut Scene, palette: &Palette, b: f64) {
        let [bottom, top] = self.range.about(b).map(|edge| self.polygon(edge, b));
        let edges: Vec<_> = bottom.iter().zip(&top).take(4).map(|(from, to)| vec![*from, *to]).collect();
        let line = Polyline::new("limits", edges, 1.0, faded(palette.dim, 0.6));
        scene.lines.push(Polyline { changes: self.range.changes(), ..line });
    }

    fn neighbours(&self, scene: &mut Scene, palette: &Palette, b: f64) {
        let outlines: Vec<_> = self.range.neighbours(b).map(|of| self.polygon(of, b)).collect();
        let line = Polyline::new("planes", outlines, 1.0, faded(palette.amber, 0.3)).on_top();
        scene.lines.push(Polyline { changes: self.range.changes(), ..line });
    }

    fn plane(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, pose: Transform, hot: bool) {
        let b = frame.b_reference;
        let polygon = self.polygon(b, b);
        // The label is outside a corner that is not near the pose.
        let taken = [0, 1].iter().all(|i| (frame.a[*i] - self.corners[2][*i]).abs() < 0.8);
        let (corner, other) = if taken { (polygon[0], polygon[2]) } else { (polygon[2], polygon[0]) };
        let at = [0, 1, 2].map(|k| corner[k] + 0.1 * (corner[k] - other[k]));
        let text = items::named(b, self.planes.is_reactionless());
        scene.labels.push(Label::new("plane/label", at, [0.0; 2], text, palette.amber, 12.5, Anchor::Centre));
        self.limits(scene, palette, &polygon);
        let outline = Polyline::new("plane/boundary", self.outline.clone(), if hot { 3.2 } else { 2.0 }, palette.amber);
        scene.lines.push(outline.on_top().moving(pose));
    }

    /// Labels each side of the polygon with its joint limit.
    fn limits(&self, scene: &mut Scene, palette: &Palette, polygon: &[[f32; 3]]) {
        for (i, ends) in polygon.windows(2).enumerate() {
            // Sides run alternately along a_1 and a_2; the other angle is at a limit.
            let fixed = 1 - i % 2;
            // The label is slightly outside the side.
            let at =
                [0, 1, 2].map(|k| 0.5 * (1.13 * (ends[0][k] + ends[1][k]) - 0.13 * (polygon[0][k] + polygon[2][k])));
            let text = format!("{} = {}°", ["a₁", "a₂"][fixed], degrees(self.corners[i][fixed]));
            scene.labels.push(Label::new("plane/limits", at, [0.0; 2], text, palette.dim, 10.5, Anchor::Centre));
        }
    }

    /// Draws lines from the pose perpendicular to the rear walls, each in the colour of its drive.
    fn drops(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, eye: [f64; 3]) {
        const NAMES: [&str; 3] = ["pose/drop/1", "pose/drop/2", "pose/drop/3"];
        let (at, bounds) = (self.pose(frame), self.bounds(frame.b_reference));
        for i in 0..3 {
            let mut foot = at;
            foot[i] = bounds[i][usize::from(eye[i] < 0.0)];
            let colour = palette.drive(self.drives[i]);
            let ends = [at, foot].map(|p| p.map(|x| x as f32));
            let drop = Polyline::new(NAMES[i], [ends.to_vec()], 1.3, faded(colour, 0.75));
            scene.lines.push(drop.dashed(3.0, 3.0));
            scene.markers.push(Marker::disc("pose/feet", ends[1], 2.5, colour));
        }
    }

    fn course(&self, scene: &mut Scene, palette: &Palette, b: f64) {
        let Some(points) = self.course.first().filter(|points| points.len() > 1) else { return };
        let pose = shifted(self.point(&[0.0; 3], b), [0.0; 3]);
        let path = Polyline::new("path", self.course.clone(), 2.0, palette.ink).dashed(2.0, 3.5).on_top();
        let changes = if self.range.is_fixed() { ItemChanges::Nothing } else { ItemChanges::Pose };
        scene.lines.push(Polyline { world_from_item: pose, changes, ..path });
        let [first, last] = [points[0], points[points.len() - 1]].map(|p| place(&pose, p));
        items::draw_ends(scene, palette, [first, last]);
    }

    /// Returns q at the centre of a plane, rad.
    fn middle(&self, b: f64) -> [f64; 3] {
        let [a1, a2] = self.planes.map().limits();
        self.planes.map().lift(PlanePoint { a: [a1, a2].map(|l| 0.5 * (l.min + l.max)), b })
    }
}

/// Returns the translation from one point of the scene to another.
fn shifted(to: [f64; 3], from: [f64; 3]) -> Transform {
    let mut pose = IN_PLACE;
    for i in 0..3 {
        pose[3][i] = (to[i] - from[i]) as f32;
    }
    pose
}

/// Returns triangles as an open shell, each with its own normal.
fn shell(triangles: impl IntoIterator<Item = [[f64; 3]; 3]>) -> Mesh {
    let mut mesh = Mesh { shell: true, ..Mesh::default() };
    for [a, b, c] in triangles {
        let (u, v) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let length = dot(n, n).sqrt().max(1e-300);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([a, b, c].map(|p| p.map(|x| x as f32)));
        mesh.normals.extend([n.map(|x| (x / length) as f32); 3]);
        mesh.triangles.push([first, first + 1, first + 2]);
    }
    mesh
}
