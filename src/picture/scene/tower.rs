//! All reactionless workspaces at once: over the plane of motion, the pose constant b as height. Each slice of the
//! tower is the workspace of its b, turned by b* = b/Σλ, (15); a point's vertical line lies in it where b reaches it.
//!
//! In the scene x and y are metres, and z is b from the lowest that is shown, times [`Tower::rise`].

use std::sync::Arc;

use super::axes::{self, Axis};
use super::camera::{Camera, Orbit};
use super::palette::{Palette, faded, palette};
use super::pointer::Pointer;
use super::stage::{Handle, ViewOptions, looks, target_handle, waypoints};
use super::views::{Aim, GRIP, Grip};
use super::wall::Wall;
use super::{Anchor, Label, Line, Marker, Mesh, Model, Scene, Solid};
use crate::mechanics::machine::place_of;
use crate::mechanics::planar::{Vector, unit};
use crate::planning::pose_constant::Planes;
use crate::planning::reactionless::{AngleLimit, BSet, PlaneMap};
use crate::session::Run;
use crate::simulation::frame::{Frame, Reach};

/// How much of b is shown, rad.
pub const SPAN: f64 = 5.0;
/// The widest, for runs over many b, rad.
pub const MOST: f64 = 4.0 * SPAN;
/// How much coarser a recorded wall is.
const GRAIN: f64 = 2.6;
/// Contours lie at multiples of this, rad.
const CONTOUR: f64 = 0.5;
/// The present b keeps this share of the span from top and bottom.
const MARGIN: f64 = 0.08;
/// Height of the box in radii of the workspace.
const HEIGHT: f64 = 2.1;
/// Cells a side of the slice's fill.
const CELLS: u32 = 64;
/// The most points that have their b shown; of more, the first and the last.
const POSTS: usize = 8;
/// How near to a bar the pointer takes hold of it, px.
const BAR_GRIP: f64 = 9.0;

/// What stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct Tower {
    planes: Arc<Planes>,
    outlines: Vec<Vec<Vector>>,
    wall: Wall,
    model: Arc<Model>,
    /// A, B and what is between them, of a planned motion.
    ends: Option<Vec<Post>>,
    /// The planned motion: p and b.
    course: Vec<(Vector, f64)>,
    radius: f64,
    span: f64,
}

/// A point of the plane and the b that reach it.
#[derive(Clone, Debug)]
pub struct Post {
    /// `A`, `1`, `B`, `target`.
    pub name: String,
    /// m.
    pub at: Vector,
    /// None if no b does.
    pub reach: Option<BSet>,
}

impl Tower {
    /// Prepares a run for drawing, over [`SPAN`]; to be made again when its machine or plan changes.
    pub fn of(run: &Run) -> Option<Self> {
        Self::spanning(run, SPAN)
    }

    /// The same over another span of b, rad, such as a whole period.
    pub fn spanning(run: &Run, span: f64) -> Option<Self> {
        let planes = run.planes()?.clone();
        let loops = planes.boundary().turned(0.0);
        let outlines: Vec<Vec<Vector>> =
            loops.into_iter().map(|l| l.into_iter().map(|[x, y]| Vector::new(x, y)).collect()).collect();
        let radius = outlines.iter().flatten().fold(0.0_f64, |m, p| m.max(p.norm()));
        if !(radius > 0.0 && span.is_finite() && span > 0.0) {
            return None;
        }
        let rise = HEIGHT * radius / span;
        let wall = Wall::of(&outlines, 1.0 / (rise * planes.map().lambda_sum()));
        let model = Arc::new(Model { meshes: vec![sheet(planes.map()), wall.mesh(HEIGHT * radius)] });
        let tip = *run.scenario().machine.tip();
        let course: Vec<(Vector, f64)> = run.motion().map_or_else(Vec::new, |motion| {
            let at = |s: f64| motion.path.at(s).q;
            looks(motion).map(at).map(|q| (place_of(&tip, &q.units()), planes.map().project(&q).b)).collect()
        });
        let ends = run.motion().map(|_| {
            let mut points = waypoints(run);
            if points.len() > POSTS {
                points.drain(1..points.len() - 1);
            }
            points.into_iter().map(|(_, name, at)| Post { name, at, reach: planes.map().reach(at).ok() }).collect()
        });
        Some(Self { planes, outlines, wall, model, ends, course, radius, span })
    }

    /// For a whole run, whose b lie in a range, with the window in which they are shown: [`SPAN`] or more, up to
    /// [`MOST`].
    pub fn over(run: &Run, b: [f64; 2]) -> Option<(Self, [f64; 2])> {
        let span = (b[1] - b[0] + 2.0 * MARGIN * SPAN).clamp(SPAN, MOST);
        Some((Self::spanning(run, span)?, axes::covering(b, 0.5 * span, span, MARGIN * SPAN)))
    }

    /// Its wall in a few thousand triangles, from z = 0, not turned.
    pub fn coarse_wall(&self) -> Mesh {
        let twist = 1.0 / (self.rise() * self.planes.map().lambda_sum());
        Wall::with_grain(&self.outlines, twist, GRAIN).mesh(HEIGHT * self.radius)
    }

    /// The b at which contours lie in a window, rad, and the outlines there, turned, m.
    pub fn levels(&self, window: [f64; 2]) -> impl Iterator<Item = (f64, Vec<Vec<Vector>>)> {
        contours(window).map(|b| (b, self.wall.level(self.planes.map().turn(b))))
    }

    /// p, m, and b, rad, along the planned motion.
    pub fn planned(&self) -> &[(Vector, f64)] {
        &self.course
    }

    /// Greatest distance of the workspace from B, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Height of a radian of b, m.
    pub fn rise(&self) -> f64 {
        HEIGHT * self.radius / self.span
    }

    /// The least and the greatest b that are shown, rad: from 0 while the present one lies well inside, else moved along.
    pub fn window(&self, b: f64) -> [f64; 2] {
        axes::sliding(b, 0.5 * self.span, self.span, MARGIN * self.span)
    }

    /// A view of the whole tower.
    pub fn camera(&self) -> Camera {
        let height = HEIGHT * self.radius;
        Camera::Orbit(Orbit { centre: [0.0, 0.0, 0.46 * height], distance: 5.9 * self.radius, yaw: 0.5, pitch: 0.36 })
    }

    /// The points whose b are shown, with these as intervals within a window.
    pub fn posts(&self, frame: &Frame) -> Vec<(Post, Vec<[f64; 2]>)> {
        let window = self.window(frame.b_reference);
        if self.ends.is_some() {
            return self.planned_posts(window);
        }
        let at = frame.target.at;
        vec![barred(&Post { name: "target".into(), at, reach: self.planes.map().reach(at).ok() }, window)]
    }

    /// The points of a planned motion, with the b that reach them as intervals within a window.
    pub fn planned_posts(&self, window: [f64; 2]) -> Vec<(Post, Vec<[f64; 2]>)> {
        self.ends.iter().flatten().map(|post| barred(post, window)).collect()
    }

    /// What the pointer can take hold of: the end effector's dot, a bar, the slice.
    pub fn pick(&self, frame: &Frame, pointer: &Pointer) -> Option<Grip> {
        let [low, _] = self.window(frame.b_reference);
        let height = |b: f64| (b - low) * self.rise();
        let tip = target_handle(frame);
        let dot = [tip.re, tip.im, height(frame.b_reference)];
        if pointer.distance(dot).is_some_and(|d| d < GRIP) {
            return Some(Grip { handle: Handle::Target, at: dot });
        }
        let ray = pointer.ray()?;
        for (post, bars) in self.posts(frame) {
            for [from, to] in bars {
                let ends = [from, to].map(|b| [post.at.re, post.at.im, height(b)]);
                if pointer.distance_to_segment(ends).is_some_and(|d| d < BAR_GRIP) {
                    return Some(Grip { handle: Handle::Bar, at: ends[0] });
                }
            }
        }
        let [x, y] = ray.at_height(dot[2])?;
        let inside = self.planes.boundary().contains(Vector::new(x, y), frame.b_reference);
        inside.then_some(Grip { handle: Handle::Plane, at: [x, y, dot[2]] })
    }

    /// What pulling at a grip asks for.
    pub fn aim(&self, grip: &Grip, frame: &Frame, pointer: &Pointer) -> Option<Aim> {
        let [low, high] = self.window(frame.b_reference);
        let ray = pointer.ray()?;
        let [x, y, _] = grip.at;
        // A little past the ends, so that the window can be moved along.
        let slack = 0.05 * self.span;
        let b = || Some(low + ray.along_line([x, y, 0.0], [0.0, 0.0, 1.0])? / self.rise());
        match grip.handle {
            Handle::Target => ray.at_height((frame.b_reference - low) * self.rise()).map(Aim::Target),
            Handle::Plane => Some(Aim::B(b()?.clamp(low - slack, high + slack))),
            Handle::Bar => {
                let b = b()?;
                // The nearest b that reaches the post that was taken hold of.
                let away = |post: &Post| (post.at - Vector::new(x, y)).norm();
                let posts = self.posts(frame).into_iter();
                let (_, bars) = posts.min_by(|s, t| away(&s.0).total_cmp(&away(&t.0)))?;
                let near = bars.iter().map(|[from, to]| b.clamp(*from, *to));
                near.min_by(|s, t| (s - b).abs().total_cmp(&(t - b).abs())).map(Aim::B)
            }
            Handle::Ring | Handle::Tip | Handle::Waypoint(_) => None,
        }
    }

    /// Everything there is to draw.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        let palette = palette(options.theme);
        let b = frame.b_reference;
        let [low, high] = self.window(b);
        let z = |b: f64| (b - low) * self.rise();
        let hot = options.hot == Some(Handle::Plane);
        let turned = |name: &str, mesh, b: f64, z: f64, colour| {
            let turn = unit(self.planes.map().turn(b));
            let (c, s) = (turn.re as f32, turn.im as f32);
            Solid {
                name: name.into(),
                mesh,
                world_from_mesh: [[c, s, 0.0, 0.0], [-s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, z as f32, 1.0]],
                colour,
            }
        };
        let mut scene = Scene {
            background: palette.background,
            model: self.model.clone(),
            areas: Vec::new(),
            solids: vec![
                turned("slice", 0, b, z(b), faded(palette.amber, if hot { 0.42 } else { 0.34 })),
                turned("tower", 1, low, 0.0, faded(palette.amber, 0.1)),
            ],
            lines: Vec::new(),
            markers: Vec::new(),
            labels: Vec::new(),
        };
        let eye = camera.eye_direction().map(f64::from);
        axes::draw(&mut scene, &palette, &self.axes(&palette, frame), eye);
        self.contours(&mut scene, &palette, [low, high], eye);
        self.slice(&mut scene, &palette, frame, options, z(b));
        self.bars(&mut scene, &palette, frame, [z(low), z(high)], z);
        self.course(&mut scene, &palette, z);
        self.target(&mut scene, &palette, frame, options, z(b));
        scene
    }

    fn axes(&self, palette: &Palette, frame: &Frame) -> [Axis; 3] {
        let [x, y, up] = self.frame_box(palette, self.window(frame.b_reference));
        [x, y, Axis { now: Some((frame.b_reference, palette.amber)), ..up }]
    }

    /// The axes of the box about it, over a window of b.
    pub fn frame_box(&self, palette: &Palette, [low, high]: [f64; 2]) -> [Axis; 3] {
        let across = |title| Axis {
            title,
            colour: palette.dim,
            ends: [-self.radius, self.radius],
            values: [-self.radius, self.radius],
            step: super::stage::round_up(self.radius / 3.0),
            decimals: 1,
            now: None,
        };
        let up = Axis {
            title: "b, rad",
            colour: palette.amber,
            ends: [0.0, HEIGHT * self.radius],
            values: [low, high],
            step: super::stage::round_up(self.span / 6.0),
            decimals: 0,
            now: None,
        };
        [across("x, m"), across("y, m"), up]
    }

    fn contours(&self, scene: &mut Scene, palette: &Palette, [low, high]: [f64; 2], eye: [f64; 3]) {
        for b in contours([low, high]) {
            let z = (b - low) * self.rise();
            for (piece, near) in self.wall.contour(self.planes.map().turn(b), eye) {
                scene.lines.push(Line {
                    name: "contour".into(),
                    points: piece.into_iter().map(|p| point(p, z)).collect(),
                    width: 1.0,
                    // What the wall hides from the eye is fainter: that tells its sides apart.
                    colour: faded(palette.amber, if near { 0.55 } else { 0.2 }),
                    dash: None,
                    on_top: true,
                });
            }
        }
    }

    fn slice(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, options: &ViewOptions, z: f64) {
        let turn = unit(self.planes.map().turn(frame.b_reference));
        let hot = options.hot == Some(Handle::Plane);
        for outline in &self.outlines {
            let mut points: Vec<_> = outline.iter().map(|p| point(p * turn, z)).collect();
            points.extend(points.first().copied().filter(|_| points.len() > 2));
            scene.lines.push(Line {
                name: "slice/boundary".into(),
                points,
                width: if hot { 3.4 } else { 2.2 },
                colour: palette.amber,
                dash: None,
                on_top: true,
            });
        }
    }

    /// Over A and B, or the target: its vertical line, and where b reaches it.
    fn bars(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        frame: &Frame,
        [floor, top]: [f64; 2],
        z: impl Fn(f64) -> f64,
    ) {
        for (post, bars) in self.posts(frame) {
            let head = top + 0.05 * self.radius;
            scene.lines.push(Line {
                name: format!("post/{}", post.name),
                points: vec![point(post.at, floor), point(post.at, head)],
                width: 1.3,
                colour: faded(palette.ink, 0.6),
                dash: Some([1.5, 3.5]),
                on_top: true,
            });
            for [from, to] in bars {
                scene.lines.push(Line {
                    name: format!("reach/{}", post.name),
                    points: vec![point(post.at, z(from)), point(post.at, z(to))],
                    width: 6.0,
                    colour: faded(palette.zero, 0.85),
                    dash: None,
                    on_top: true,
                });
            }
            scene.labels.push(Label {
                at: point(post.at, head),
                offset: [0.0, -11.0],
                text: post.name.clone(),
                colour: palette.ink,
                size: 13.0,
                anchor: Anchor::Centre,
            });
        }
    }

    fn course(&self, scene: &mut Scene, palette: &Palette, z: impl Fn(f64) -> f64) {
        if self.course.len() < 2 {
            return;
        }
        scene.lines.push(Line {
            name: "path".into(),
            points: self.course.iter().map(|(p, b)| point(*p, z(*b))).collect(),
            width: 2.0,
            colour: palette.ink,
            dash: Some([2.0, 3.5]),
            on_top: true,
        });
    }

    fn target(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, options: &ViewOptions, z: f64) {
        let outside = matches!(frame.target.reach, Reach::Outside { .. });
        let held = options.held.filter(|_| outside).map(|[x, y]| Vector::new(x, y));
        let at = held.unwrap_or_else(|| target_handle(frame));
        if outside {
            scene.lines.push(Line {
                name: "target/gap".into(),
                points: vec![point(frame.in_base(frame.tip), z), point(at, z)],
                width: 1.4,
                colour: palette.dim,
                dash: Some([4.0, 4.0]),
                on_top: true,
            });
        }
        let hot = options.hot == Some(Handle::Target);
        let disc = |name: &str, at, radius, fill, stroke_width| Marker {
            name: name.into(),
            at: point(at, z),
            radius,
            fill,
            stroke: palette.ink,
            stroke_width,
        };
        let inside = faded(palette.ink, if hot && !outside { 0.12 } else { 0.0 });
        scene.markers.push(disc("end-effector", frame.in_base(frame.tip), 4.0, palette.ink, 0.0));
        scene.markers.push(disc("target", at, if hot { 12.0 } else { 10.0 }, inside, 2.0));
    }
}

/// A workspace before it is turned, over a grid of (a_1, a_2). A shell lies over the grid of the walls, an area under it.
fn sheet(map: &PlaneMap) -> Mesh {
    let [l1, l2] = map.limits();
    let share = |l: AngleLimit, i: u32| l.min + f64::from(i) / f64::from(CELLS) * (l.max - l.min);
    let mut mesh = Mesh { shell: true, ..Mesh::default() };
    for (i, j) in (0..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| (i, j))) {
        mesh.positions.push(point(map.forward_unturned([share(l1, i), share(l2, j)]), 0.0));
        mesh.normals.push([0.0, 0.0, 1.0]);
    }
    for (i, j) in (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (i, j))) {
        let [a, b] = [i * (CELLS + 1) + j, (i + 1) * (CELLS + 1) + j];
        mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
    }
    mesh
}

/// A post with its bars.
fn barred(post: &Post, window: [f64; 2]) -> (Post, Vec<[f64; 2]>) {
    let bars = post.reach.as_ref().map_or_else(Vec::new, |set| within(set, window));
    (post.clone(), bars)
}

/// The b of contours: round ones, and both ends.
fn contours([low, high]: [f64; 2]) -> impl Iterator<Item = f64> {
    let first = (low / CONTOUR).ceil();
    let inner = (0..200).map(move |i| (first + f64::from(i)) * CONTOUR).take_while(move |b| *b <= high);
    inner.chain([low, high])
}

/// The intervals of a set on the circle, wherever they show in a window of the real line, in order.
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

fn point(p: Vector, z: f64) -> [f32; 3] {
    [p.re as f32, p.im as f32, z as f32]
}
