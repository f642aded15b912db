//! Joint space: its axes are the drive angles q_1, q_2, q_3, so the planes b = Σ λ_k q_k, (13), are seen as planes. The
//! limits of a_1 and a_2 cut a parallelogram out of each; all of them together are a prism along (1, 1, 1), because
//! turning all drives alike changes no relative angle.
//!
//! The drive with the greatest λ points up, the others follow it in order (q_2, q_3, q_1 for the paper's machine), so
//! the planes lie nearly level. In the scene a unit is a radian, and the origin is [`JointSpace::origin`].

use std::sync::Arc;

use super::axes::{self, Axis};
use super::camera::{Camera, Orbit};
use super::palette::{Palette, faded, palette};
use super::pointer::{Pointer, dot};
use super::stage::{Handle, ViewOptions, looks, round_up, signed};
use super::views::{Aim, GRIP, Grip};
use super::{Anchor, Label, Line, Marker, Mesh, Model, Scene, Solid};
use crate::planning::pose_constant::Planes;
use crate::planning::reactionless::PlanePoint;
use crate::session::Run;
use crate::simulation::frame::Frame;

/// How much of b is shown, rad, and how near to its ends the present one comes.
const SPAN: f64 = 3.0;
const MARGIN: f64 = 0.4;
/// Where the span lies while the present b is well inside, rad.
const HOME: f64 = 2.5;
/// Neighbouring planes lie at multiples of this, rad.
const NEIGHBOURS: f64 = 0.5;
/// Room around the prism, rad.
const ROOM: f64 = 0.25;

/// Names of the axes, with the unit.
const TITLES: [&str; 3] = ["q₁, rad", "q₂, rad", "q₃, rad"];

/// What stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct JointSpace {
    planes: Arc<Planes>,
    /// The parallelogram of one plane about its middle; the sides of the prism.
    model: Arc<Model>,
    /// The drive shown along each axis of the scene, counted from 0.
    drives: [usize; 3],
    /// (a_1, a_2) of the parallelogram's corners, in order, rad.
    corners: [[f64; 2]; 4],
    /// q of the planned motion, rad.
    course: Vec<[f64; 3]>,
}

impl JointSpace {
    /// Prepares a run for drawing; to be made again when its machine or plan changes.
    pub fn of(run: &Run) -> Option<Self> {
        let planes = run.planes()?.clone();
        let map = planes.map();
        let lambda = map.lambda();
        let up = (0..3).max_by(|i, j| lambda[*i].total_cmp(&lambda[*j]))?;
        let [a1, a2] = map.limits();
        let corners = [[a1.min, a2.min], [a1.max, a2.min], [a1.max, a2.max], [a1.min, a2.max]];
        let course = run.motion().map_or_else(Vec::new, |motion| {
            let at = |s: f64| motion.path.at(s).q;
            looks(motion).map(at).map(|q| [q[0], q[1], q[2]]).collect()
        });
        let mut space =
            Self { model: Arc::default(), drives: [1, 2, 3].map(|i| (up + i) % 3), corners, course, planes };
        let [low, high] = space.window(HOME);
        let ring = |b: f64| corners.map(|a| space.point(space.planes.map().lift(PlanePoint { a, b }), HOME));
        let (own, bottom, top) = (ring(HOME), ring(low), ring(high));
        let sides = (0..4).flat_map(|i| {
            let j = (i + 1) % 4;
            [[bottom[i], bottom[j], top[j]], [bottom[i], top[j], top[i]]]
        });
        let faces = [[own[0], own[1], own[2]], [own[0], own[2], own[3]]];
        let meshes = vec![shell(faces), shell(sides)];
        space.model = Arc::new(Model { meshes });
        Some(space)
    }

    /// The least and the greatest b that are shown, rad.
    pub fn window(&self, b: f64) -> [f64; 2] {
        axes::sliding(b, HOME, SPAN, MARGIN)
    }

    /// For a whole run, whose b lie in a range: the b that are shown, rad.
    pub fn window_over(&self, b: [f64; 2]) -> [f64; 2] {
        axes::covering(b, HOME, SPAN.max(b[1] - b[0] + 2.0 * MARGIN), MARGIN)
    }

    /// The drive shown along each axis of the scene, counted from 0; the last one points up.
    pub fn drives(&self) -> [usize; 3] {
        self.drives
    }

    /// q at the corners of a plane, in order, rad.
    pub fn corners(&self, b: f64) -> [[f64; 3]; 4] {
        self.corners.map(|a| self.planes.map().lift(PlanePoint { a, b }))
    }

    /// q along the planned motion, rad.
    pub fn planned(&self) -> &[[f64; 3]] {
        &self.course
    }

    /// The axes of the box over a window of b, with q itself as coordinates.
    pub fn frame_box(&self, palette: &Palette, window: [f64; 2]) -> [Axis; 3] {
        self.axes_of(palette, self.bounds_of(window, [0.0; 3]), [0.0; 3])
    }

    /// q at the scene's origin while the present pose constant is b, in the order of the drives, rad.
    pub fn origin(&self, b: f64) -> [f64; 3] {
        let [low, high] = self.window(b);
        let map = self.planes.map();
        let [a1, a2] = map.limits();
        map.lift(PlanePoint { a: [a1, a2].map(|l| 0.5 * (l.min + l.max)), b: 0.5 * (low + high) })
    }

    /// Where q lies in the scene while the present pose constant is b.
    pub fn point(&self, q: [f64; 3], b: f64) -> [f64; 3] {
        let origin = self.origin(b);
        self.drives.map(|k| q[k] - origin[k])
    }

    /// q of a point of the scene while the present pose constant is b, rad.
    pub fn angles(&self, point: [f64; 3], b: f64) -> [f64; 3] {
        let mut q = self.origin(b);
        for (k, x) in self.drives.into_iter().zip(point) {
            q[k] += x;
        }
        q
    }

    /// A view of the whole prism.
    pub fn camera(&self) -> Camera {
        let size = self.bounds(HOME).iter().map(|[from, to]| (to - from) * (to - from)).sum::<f64>().sqrt();
        Camera::Orbit(Orbit { centre: [0.0, 0.0, -0.06 * size], distance: 1.85 * size, yaw: 1.85, pitch: 0.66 })
    }

    /// Ends of the box along the scene's axes.
    fn bounds(&self, b: f64) -> [[f64; 2]; 3] {
        self.bounds_of(self.window(b), self.origin(b))
    }

    /// The same for a window of b, seen from an origin.
    fn bounds_of(&self, window: [f64; 2], origin: [f64; 3]) -> [[f64; 2]; 3] {
        let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for edge in window {
            for q in self.corners(edge) {
                let p = self.drives.map(|k| q[k] - origin[k]);
                for (bound, x) in bounds.iter_mut().zip(p) {
                    *bound = [bound[0].min(x - ROOM), bound[1].max(x + ROOM)];
                }
            }
        }
        bounds
    }

    fn normal(&self) -> [f64; 3] {
        let lambda = self.planes.map().lambda();
        self.drives.map(|k| lambda[k])
    }

    /// b of a point of the scene.
    fn b_at(&self, point: [f64; 3], b: f64) -> f64 {
        self.planes.map().project(&self.angles(point, b)).b
    }

    /// The point of the plane b under the pointer.
    fn on_plane(&self, b: f64, pointer: &Pointer) -> Option<[f64; 3]> {
        pointer.ray()?.at_plane(self.normal(), b - self.b_at([0.0; 3], b))
    }

    fn pose(&self, frame: &Frame) -> [f64; 3] {
        self.point([0, 1, 2].map(|k| frame.relative(k)), frame.b_reference)
    }

    /// What the pointer can take hold of: the pose's dot, the plane.
    pub fn pick(&self, frame: &Frame, pointer: &Pointer) -> Option<Grip> {
        let (b, dot) = (frame.b_reference, self.pose(frame));
        if pointer.distance(dot).is_some_and(|d| d < GRIP) {
            return Some(Grip { handle: Handle::Target, at: dot });
        }
        let at = self.on_plane(b, pointer)?;
        let a = self.planes.map().project(&self.angles(at, b)).a;
        let limits = self.planes.map().limits();
        let inside = (0..2).all(|i| limits[i].contains(a[i], 0.0));
        inside.then_some(Grip { handle: Handle::Plane, at })
    }

    /// What pulling at a grip asks for: the dot within its plane, the plane along its normal.
    pub fn aim(&self, grip: &Grip, frame: &Frame, pointer: &Pointer) -> Option<Aim> {
        let (b, map) = (frame.b_reference, self.planes.map());
        match grip.handle {
            Handle::Target => {
                let at = self.on_plane(b, pointer)?;
                let p = map.forward(map.clamp(map.project(&self.angles(at, b)).a), b);
                Some(Aim::Target([p.re, p.im]))
            }
            Handle::Plane => {
                let normal = self.normal();
                let s = pointer.ray()?.along_line(grip.at, normal)?;
                let at = [0, 1, 2].map(|i| grip.at[i] + s * normal[i]);
                let [low, high] = self.window(b);
                Some(Aim::B(self.b_at(at, b).clamp(low, high)))
            }
            Handle::Ring | Handle::Bar | Handle::Tip | Handle::Waypoint(_) => None,
        }
    }

    /// Everything there is to draw.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        let palette = palette(options.theme);
        let b = frame.b_reference;
        let [low, high] = self.window(b);
        // The meshes were made on the plane HOME and about it, each with its origin.
        let along = |b: f64, home: f64| {
            let shift = (self.planes.map().turn(b - home)) as f32;
            [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [shift, shift, shift, 1.0]]
        };
        let hot = options.hot == Some(Handle::Plane);
        let solid =
            |name: &str, mesh, world_from_mesh, colour| Solid { name: name.into(), mesh, world_from_mesh, colour };
        let mut scene = Scene {
            background: palette.background,
            model: self.model.clone(),
            areas: Vec::new(),
            solids: vec![
                solid("prism", 1, along(0.0, 0.0), faded(palette.dim, 0.07)),
                solid("plane", 0, along(b, 0.5 * (low + high)), faded(palette.amber, if hot { 0.42 } else { 0.34 })),
            ],
            lines: Vec::new(),
            markers: Vec::new(),
            labels: Vec::new(),
        };
        let eye = camera.eye_direction().map(f64::from);
        let axes = self.axes(&palette, frame);
        axes::draw(&mut scene, &palette, &axes, eye);
        self.prism(&mut scene, &palette, b);
        self.neighbours(&mut scene, &palette, b);
        self.plane(&mut scene, &palette, frame, hot);
        self.drops(&mut scene, &palette, frame, eye);
        self.course(&mut scene, &palette, b);
        let hot = options.hot == Some(Handle::Target);
        let at = self.pose(frame).map(|x| x as f32);
        let disc = |name: &str, radius, fill, stroke_width| Marker {
            name: name.into(),
            at,
            radius,
            fill,
            stroke: palette.ink,
            stroke_width,
        };
        scene.markers.push(disc("pose", 4.5, palette.ink, 0.0));
        scene.markers.push(disc("target", if hot { 12.0 } else { 10.0 }, faded(palette.ink, 0.0), 2.0));
        scene
    }

    fn axes(&self, palette: &Palette, frame: &Frame) -> [Axis; 3] {
        let (bounds, origin) = (self.bounds(frame.b_reference), self.origin(frame.b_reference));
        let mut axes = self.axes_of(palette, bounds, origin);
        for (axis, k) in axes.iter_mut().zip(self.drives) {
            axis.now = Some((frame.relative(k), palette.drive(k)));
        }
        axes
    }

    fn axes_of(&self, palette: &Palette, bounds: [[f64; 2]; 3], origin: [f64; 3]) -> [Axis; 3] {
        let longest = bounds.iter().map(|[from, to]| to - from).fold(0.0, f64::max);
        [0, 1, 2].map(|i| {
            let (k, [from, to]) = (self.drives[i], bounds[i]);
            Axis {
                title: TITLES[k],
                colour: palette.drive(k),
                ends: [from, to],
                values: [from + origin[k], to + origin[k]],
                step: round_up(longest / 10.0),
                decimals: 0,
                now: None,
            }
        })
    }

    /// Corners of the plane of a pose constant, in the scene of the present one.
    fn polygon(&self, of: f64, b: f64) -> Vec<[f32; 3]> {
        let corner = |a| self.point(self.planes.map().lift(PlanePoint { a, b: of }), b).map(|x| x as f32);
        (0..5).map(|i| corner(self.corners[i % 4])).collect()
    }

    fn prism(&self, scene: &mut Scene, palette: &Palette, b: f64) {
        let [bottom, top] = self.window(b).map(|edge| self.polygon(edge, b));
        for (from, to) in bottom.iter().zip(&top).take(4) {
            scene.lines.push(line("prism/edge", vec![*from, *to], 1.0, faded(palette.dim, 0.6)));
        }
    }

    /// The b of neighbouring planes in a window, rad.
    pub fn neighbours_in(&self, [low, high]: [f64; 2]) -> impl Iterator<Item = f64> + use<> {
        let first = (low / NEIGHBOURS).ceil();
        (0..80).map(move |i| (first + f64::from(i)) * NEIGHBOURS).take_while(move |b| *b <= high)
    }

    fn neighbours(&self, scene: &mut Scene, palette: &Palette, b: f64) {
        for of in self.neighbours_in(self.window(b)) {
            let mut outline = line("neighbour", self.polygon(of, b), 1.0, faded(palette.amber, 0.3));
            outline.on_top = true;
            scene.lines.push(outline);
        }
    }

    fn plane(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, hot: bool) {
        let b = frame.b_reference;
        let polygon = self.polygon(b, b);
        // Outside a corner that the pose leaves free.
        let taken = [0, 1].iter().all(|i| (frame.a[*i] - self.corners[2][*i]).abs() < 0.8);
        let (corner, other) = if taken { (polygon[0], polygon[2]) } else { (polygon[2], polygon[0]) };
        scene.labels.push(Label {
            at: [0, 1, 2].map(|k| corner[k] + 0.1 * (corner[k] - other[k])),
            offset: [0.0; 2],
            text: format!("b = {b:.3} rad"),
            colour: palette.amber,
            size: 12.5,
            anchor: Anchor::Centre,
        });
        self.limits(scene, palette, &polygon);
        let mut outline = line("plane/boundary", polygon, if hot { 3.2 } else { 2.0 }, palette.amber);
        outline.on_top = true;
        scene.lines.push(outline);
    }

    /// Which limit each side of the polygon is.
    fn limits(&self, scene: &mut Scene, palette: &Palette, polygon: &[[f32; 3]]) {
        for (i, ends) in polygon.windows(2).enumerate() {
            // Sides run along a_1 and a_2 in turn, at a limit of the other.
            let fixed = 1 - i % 2;
            scene.labels.push(Label {
                // A little outside.
                at: [0, 1, 2]
                    .map(|k| 0.5 * (1.13 * (ends[0][k] + ends[1][k]) - 0.13 * (polygon[0][k] + polygon[2][k]))),
                offset: [0.0; 2],
                text: format!("{} = {}°", ["a₁", "a₂"][fixed], degrees(self.corners[i][fixed])),
                colour: palette.dim,
                size: 10.5,
                anchor: Anchor::Centre,
            });
        }
    }

    /// From the pose straight to the walls behind it, each in the colour of its drive.
    fn drops(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, eye: [f64; 3]) {
        let (at, bounds) = (self.pose(frame), self.bounds(frame.b_reference));
        for i in 0..3 {
            let mut foot = at;
            foot[i] = bounds[i][usize::from(eye[i] < 0.0)];
            let colour = palette.drive(self.drives[i]);
            let ends = [at, foot].map(|p| p.map(|x| x as f32));
            let mut drop = line("pose/drop", ends.to_vec(), 1.3, faded(colour, 0.75));
            drop.dash = Some([3.0, 3.0]);
            scene.lines.push(drop);
            scene.markers.push(Marker {
                name: "pose/foot".into(),
                at: ends[1],
                radius: 2.5,
                fill: colour,
                stroke: colour,
                stroke_width: 0.0,
            });
        }
    }

    fn course(&self, scene: &mut Scene, palette: &Palette, b: f64) {
        let points: Vec<[f32; 3]> = self.course.iter().map(|q| self.point(*q, b).map(|x| x as f32)).collect();
        let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return };
        let mut path = line("path", points, 2.0, palette.ink);
        (path.dash, path.on_top) = (Some([2.0, 3.5]), true);
        scene.lines.push(path);
        let ends = [("A", first, Anchor::Right, -11.0), ("B", last, Anchor::Left, 11.0)];
        // A closed path has one end.
        let closed = first.iter().zip(last).all(|(s, t)| (s - t).abs() < 1e-3);
        for (name, at, anchor, aside) in ends.into_iter().take(if closed { 1 } else { 2 }) {
            scene.markers.push(Marker {
                name: format!("waypoint/{name}"),
                at,
                radius: 4.5,
                fill: palette.background,
                stroke: palette.ink,
                stroke_width: 1.6,
            });
            scene.labels.push(Label {
                at,
                offset: [aside, -10.0],
                text: name.into(),
                colour: palette.ink,
                size: 13.0,
                anchor,
            });
        }
    }
}

fn line(name: &str, points: Vec<[f32; 3]>, width: f32, colour: super::Rgba) -> Line {
    Line { name: name.into(), points, width, colour, dash: None, on_top: false }
}

/// An angle in whole degrees, or with a digit where it has one.
fn degrees(angle: f64) -> String {
    let text = signed(angle.to_degrees(), 1);
    text.strip_suffix(".0").map_or_else(|| text.clone(), Into::into)
}

/// Triangles as an open shell, each with its own normal.
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
