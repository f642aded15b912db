//! From a run and a frame to a [`Scene`]. A [`Stage`] holds what does not change from frame to frame.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::linkage::Linkage;
use super::palette::{Palette, Theme, faded, palette};
use super::{Anchor, Area, Label, Line, Marker, Rgba, Scene, Shade, dexterity};
use crate::frame::{Frame, REACTIONLESS, Reach};
use crate::machine::Chain;
use crate::planar::{DriveAngles, Units, Vector, unit};
use crate::pose_constant::Planes;
use crate::reactionless::PlaneMap;
use crate::scenario::{Shape, Task};
use crate::session::Run;
use std::sync::Arc;

/// What a person has chosen to see.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewOptions {
    /// Light or dark.
    pub theme: Theme,
    /// The workspace is shaded by |det ∂(x, y)/∂(a_1, a_2)|.
    pub dexterity: bool,
    /// The pointer is on this handle, or drags it.
    pub hot: Option<Handle>,
    /// Where the pointer holds what it drags, m.
    pub held: Option<[f64; 2]>,
    /// A pose constant to show A, or the target, on, rad.
    pub preview_b: Option<f64>,
    /// What the pointer has drawn so far, m.
    pub stroke: Vec<[f64; 2]>,
    /// What was asked for last and refused.
    pub refused: Option<Arc<Refused>>,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self {
            theme: Theme::Dark,
            dexterity: false,
            hot: None,
            held: None,
            preview_b: None,
            stroke: Vec::new(),
            refused: None,
        }
    }
}

/// What the target's label says while it can be dragged; a picture that nobody can touch goes without.
pub const INVITATION: &str = "drag me";

/// What can be dragged in the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// The end effector's target.
    Target,
    /// The knob of the b ring.
    Ring,
    /// The plane b = const, in joint space or as a slice of the tower.
    Plane,
    /// A bar of the tower: the b that reach a point.
    Bar,
    /// A point of the planned path, counted from A.
    Waypoint(usize),
}

/// What somebody asked for and did not get: a curve, m, and where it cannot be followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    /// m.
    pub curve: Vec<Vector>,
    /// m.
    pub at: Vector,
    /// Why, in a few words.
    pub why: String,
}

/// What stays the same from frame to frame.
#[derive(Clone, Debug)]
pub struct Stage {
    linkage: Linkage,
    planes: Option<Arc<Planes>>,
    boundary: Vec<Vec<Vector>>,
    /// Where words about the workspace have the most room, before it is turned.
    middle: Option<Vector>,
    compare_b: Option<f64>,
    motion: Option<Course>,
    /// The greatest |det| within the limits, m².
    most_det: f64,
    /// Curves in the workspace, and where folds turn back, before it is turned, m.
    inside: Vec<(Inside, Vec<Vector>)>,
    cusps: Vec<Vector>,
}

/// What a curve in the workspace is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Inside {
    /// det = 0: two poses meet.
    Fold,
    /// A limit that some pose meets there.
    Limit,
    /// Two drives are parallel.
    Change,
}

impl Inside {
    fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::Limit => "inner-limit",
            Self::Change => "change-point",
        }
    }
}

fn inside(planes: &Planes) -> Vec<(Inside, Vec<Vector>)> {
    let b = planes.boundary();
    let drawn = |line: &crate::reactionless::Line| -> Vec<Vector> {
        let mut points: Vec<Vector> = line.turned(0.0).iter().map(|[x, y]| Vector::new(*x, *y)).collect();
        points.extend(points.first().copied().filter(|_| line.is_closed()));
        points
    };
    let folds = b.fold_curves().iter().map(|line| (Inside::Fold, drawn(line))).collect::<Vec<_>>();
    let limits = b.inner_limits().iter().map(|line| (Inside::Limit, drawn(line))).collect::<Vec<_>>();
    let changes = b.change_curves().iter().map(|curve| (Inside::Change, drawn(&curve.line))).collect::<Vec<_>>();
    [folds, limits, changes].concat()
}

/// A planned motion as seen.
#[derive(Clone, Debug)]
struct Course {
    points: Vec<Vector>,
    start: Units,
    /// Points of the task: their numbers, names and places, m.
    waypoints: Vec<(usize, String, Vector)>,
}

/// Parts of a path that is drawn.
const LOOKS: i32 = 256;

/// The most points of a task that are drawn one by one; more are a curve drawn by hand.
const NAMED: usize = 24;

/// Numbers, names and places of the points that are drawn, m.
pub(crate) fn waypoints(task: &Task) -> Vec<(usize, String, Vector)> {
    let named = |(i, p)| (i, task.name_of(i), p);
    let all: Vec<_> = task.points().into_iter().enumerate().map(named).collect();
    if all.len() <= NAMED && task.shape() != Shape::Freehand {
        all
    } else {
        [&all[..1], &all[all.len() - 1..]].concat()
    }
}

impl Stage {
    /// Prepares a run for drawing; to be made again when its machine or plan changes.
    pub fn of(run: &Run) -> Self {
        let machine = &run.scenario().machine;
        let planes = run.planes().cloned();
        let boundary = planes.as_ref().map_or_else(Vec::new, |p| {
            let loops = p.boundary().turned(0.0);
            loops.into_iter().map(|l| l.into_iter().map(|[x, y]| Vector::new(x, y)).collect()).collect()
        });
        let tip = *machine.tip();
        let motion = run.motion().map(|motion| Course {
            points: (0..=LOOKS).map(|i| place(&tip, &motion.path.at(f64::from(i) / f64::from(LOOKS)).q)).collect(),
            start: motion.path.at(0.0).q.units(),
            waypoints: waypoints(&run.scenario().task),
        });
        Self {
            linkage: Linkage::of(machine),
            middle: planes.as_ref().and_then(|p| roomiest(p, &boundary)),
            inside: planes.as_ref().map_or_else(Vec::new, |p| inside(p)),
            cusps: planes.as_ref().map_or_else(Vec::new, |p| p.boundary().cusps().iter().map(|v| v.at).collect()),
            most_det: planes.as_ref().map_or(0.0, |p| dexterity::greatest(p.map())),
            planes,
            boundary,
            compare_b: run.scenario().compare_b,
            motion,
        }
    }

    /// The machine's body.
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// The greatest |det ∂(x, y)/∂(a_1, a_2)| within the limits, m².
    pub fn greatest_det(&self) -> f64 {
        self.most_det
    }

    /// How many poses of the present plane put the end effector where it is, and how far it is from the boundary of
    /// the workspace, m, positive inside. `None` for a machine without planes.
    pub fn standing(&self, frame: &Frame) -> Option<(usize, f64)> {
        let boundary = self.planes.as_ref()?.boundary();
        Some((boundary.pose_count(frame.tip, frame.b), boundary.distance(frame.tip, frame.b)))
    }

    /// Radius of the b ring, m.
    pub fn ring_radius(&self) -> f64 {
        0.118 * self.linkage.reach()
    }

    /// Height of the plane in which handles lie, m.
    pub fn handle_height(&self) -> f64 {
        self.linkage.top()
    }

    /// Where a handle is, m.
    pub fn handle(&self, handle: Handle, frame: &Frame) -> Option<[f64; 3]> {
        let z = self.handle_height();
        match handle {
            Handle::Target => {
                let p = target_handle(frame);
                Some([p.re, p.im, z])
            }
            Handle::Ring => {
                let p = unit(self.planes.as_ref()?.map().turn(frame.b_reference)) * self.ring_radius();
                Some([p.re, p.im, z])
            }
            Handle::Waypoint(i) => {
                let course = self.motion.as_ref()?;
                let (.., p) = course.waypoints.iter().find(|(number, ..)| *number == i)?;
                Some([p.re, p.im, z])
            }
            Handle::Plane | Handle::Bar => None,
        }
    }

    /// The b that a place of the ring's knob stands for, nearest to the present one, rad.
    pub fn ring_b(&self, at: [f64; 2], near: f64) -> Option<f64> {
        let map = self.planes.as_ref()?.map();
        let turn = crate::kinematics::closest_turn(at[1].atan2(at[0]), map.turn(near));
        Some(turn * map.lambda_sum())
    }

    /// Everything there is to draw.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions) -> Scene {
        let palette = palette(options.theme);
        let e = frame.q.units();
        let mut solids = Vec::new();
        if let Some(course) = &self.motion {
            solids.extend(self.linkage.ghost(&course.start, &palette, 0.16));
        }
        if let (Some(b), Some(planes)) = (options.preview_b, &self.planes) {
            let p = self.motion.as_ref().and_then(|c| c.points.first().copied()).unwrap_or(frame.target.at);
            for pose in planes.map().poses(p, b).iter() {
                let q = DriveAngles::from(planes.map().lift(*pose));
                solids.extend(self.linkage.ghost(&q.units(), &palette, 0.34));
            }
        }
        solids.extend(self.linkage.solids(&e, &palette));
        let mut scene = Scene {
            background: palette.background,
            model: self.linkage.model.clone(),
            areas: Vec::new(),
            solids,
            lines: Vec::new(),
            markers: Vec::new(),
            labels: Vec::new(),
        };
        self.grid(&mut scene, &palette);
        if let Some(planes) = &self.planes {
            if let Some(b) = self.compare_b {
                self.workspace(&mut scene, &palette, planes, b, true);
            }
            self.workspace(&mut scene, &palette, planes, frame.b_reference, false);
            if let Some(b) = options.preview_b {
                self.preview(&mut scene, &palette, planes, b);
            }
            scene
                .areas
                .iter_mut()
                .rev()
                .take(1)
                .filter(|_| options.dexterity)
                .for_each(|area| self.shade(area, &palette));
            self.ring(&mut scene, &palette, planes, frame, options);
        }
        self.course(&mut scene, &palette, options);
        self.wishes(&mut scene, &palette, options);
        self.reaction(&mut scene, &palette, frame);
        self.target(&mut scene, &palette, frame, options);
        scene
    }

    fn grid(&self, scene: &mut Scene, palette: &Palette) {
        let (step, z) = (0.1, self.linkage.floor() - 0.004 * self.linkage.reach());
        let n = (1.7 * self.linkage.reach() / step).ceil().min(60.0) as i32;
        let far = f64::from(n) * step;
        let colour = faded(palette.line, 0.55);
        for i in -n..=n {
            let at = f64::from(i) * step;
            let strong = if i == 0 { palette.line } else { colour };
            for ends in [[[at, -far], [at, far]], [[-far, at], [far, at]]] {
                scene.lines.push(Line {
                    name: "grid".into(),
                    points: ends.map(|[x, y]| point(Vector::new(x, y), z)).to_vec(),
                    width: 1.0,
                    colour: strong,
                    dash: None,
                    on_top: false,
                });
            }
        }
    }

    fn workspace(&self, scene: &mut Scene, palette: &Palette, planes: &Planes, b: f64, compared: bool) {
        let (colour, edge, dash, lift) = match compared {
            false => (faded(palette.amber, 0.13), palette.amber, None, 0.0),
            true => (faded(palette.dim, 0.08), faded(palette.dim, 0.55), Some([5.0, 4.0]), -0.002),
        };
        let z = self.linkage.floor() + lift * self.linkage.reach();
        let name = if compared { "workspace/compared" } else { "workspace" };
        scene.areas.push(area_of(planes.map(), b, name, z, colour));
        let r = unit(planes.map().turn(b));
        for outline in &self.boundary {
            let mut points: Vec<_> = outline.iter().map(|p| point(p * r, z)).collect();
            if points.len() > 2 && points.first() != points.last() {
                points.push(points[0]);
            }
            scene.lines.push(Line {
                name: format!("{name}/boundary"),
                points,
                width: if compared { 1.2 } else { 1.8 },
                colour: edge,
                dash,
                on_top: false,
            });
        }
        for (kind, line) in self.inside.iter().filter(|_| !compared) {
            let (colour, dash) = match kind {
                Inside::Fold => (palette.amber, None),
                Inside::Limit => (faded(palette.amber, 0.55), None),
                Inside::Change => (faded(palette.dim, 0.8), Some([2.0, 4.0])),
            };
            scene.lines.push(Line {
                name: format!("workspace/{}", kind.name()),
                points: line.iter().map(|p| point(p * r, z)).collect(),
                width: 1.2,
                colour,
                dash,
                on_top: false,
            });
        }
        for cusp in self.cusps.iter().filter(|_| !compared) {
            scene.markers.push(Marker {
                name: "workspace/cusp".into(),
                at: point(cusp * r, z),
                radius: 2.5,
                fill: palette.amber,
                stroke: palette.amber,
                stroke_width: 0.0,
            });
        }
        let rows = match compared {
            true => vec![(format!("b = {b:.3} rad"), palette.dim, 11.5)],
            false => vec![
                ("reactionless workspace".into(), palette.amber, 12.5),
                (format!("b = {b:.3} rad · {:.3} m²", planes.boundary().area()), palette.dim, 11.5),
            ],
        };
        for (i, (text, colour, size)) in rows.into_iter().enumerate().filter(|_| self.middle.is_some()) {
            let at = self.middle.unwrap_or_default() * r;
            scene.labels.push(label(at, z, [0.0, 17.0 * i as f32], &text, colour, size, Anchor::Centre));
        }
    }

    /// By |det|, from 0 to its greatest.
    fn shade(&self, area: &mut Area, palette: &Palette) {
        let [low, high] = dexterity::colours(palette);
        (area.colour, area.shade) = (low, Some(Shade { colour: high, full: self.most_det as f32 }));
    }

    /// The outline of the workspace of a b that is only looked at.
    fn preview(&self, scene: &mut Scene, palette: &Palette, planes: &Planes, b: f64) {
        let (r, z) = (unit(planes.map().turn(b)), self.linkage.floor());
        for outline in &self.boundary {
            let mut points: Vec<_> = outline.iter().map(|p| point(p * r, z)).collect();
            points.extend(points.first().copied());
            scene.lines.push(Line {
                name: "workspace/preview".into(),
                points,
                width: 1.2,
                colour: faded(palette.amber, 0.8),
                dash: Some([5.0, 4.0]),
                on_top: false,
            });
        }
    }

    fn ring(&self, scene: &mut Scene, palette: &Palette, planes: &Planes, frame: &Frame, options: &ViewOptions) {
        let (radius, z) = (self.ring_radius(), self.handle_height());
        let turn = planes.map().turn(frame.b_reference);
        let circle = |from: f64, to: f64| -> Vec<[f32; 3]> {
            let n = (((to - from).abs() / TAU * 96.0).ceil() as usize).max(2);
            (0..=n).map(|i| point(unit(from + (to - from) * i as f64 / n as f64) * radius, z)).collect()
        };
        let line = |name: &str, points, width, colour| Line {
            name: name.into(),
            points,
            width,
            colour,
            dash: None,
            on_top: true,
        };
        scene.lines.push(line("ring", circle(0.0, TAU), 3.0, faded(palette.line, 0.9)));
        let shown = turn.rem_euclid(TAU);
        scene.lines.push(line("ring/b", circle(0.0, shown), 3.5, palette.amber));
        let knob = unit(turn) * radius;
        let hot = options.hot == Some(Handle::Ring);
        scene.markers.push(Marker {
            name: "ring/knob".into(),
            at: point(knob, z),
            radius: if hot { 9.0 } else { 7.0 },
            fill: palette.amber,
            stroke: palette.background,
            stroke_width: 2.0,
        });
        let beside = unit(turn) * (radius * 1.28);
        scene.labels.push(label(beside, z, [0.0, 0.0], "b", palette.amber, 14.0, Anchor::Centre));
    }

    fn course(&self, scene: &mut Scene, palette: &Palette, options: &ViewOptions) {
        let Some(course) = &self.motion else { return };
        let z = self.handle_height();
        scene.lines.push(Line {
            name: "path".into(),
            points: course.points.iter().map(|p| point(*p, z)).collect(),
            width: 1.6,
            colour: faded(palette.ink, 0.75),
            dash: Some([2.0, 4.0]),
            on_top: true,
        });
        for (i, name, at) in &course.waypoints {
            let hot = options.hot == Some(Handle::Waypoint(*i));
            let at = match (hot, options.held) {
                (true, Some([x, y])) => Vector::new(x, y),
                _ => *at,
            };
            scene.markers.push(Marker {
                name: format!("waypoint/{name}"),
                at: point(at, z),
                radius: if hot { 6.5 } else { 4.5 },
                fill: palette.background,
                stroke: palette.ink,
                stroke_width: if hot { 2.2 } else { 1.6 },
            });
            scene.labels.push(label(at, z, [-12.0, 0.0], name, palette.ink, 13.0, Anchor::Right));
        }
    }

    /// What is being drawn by hand, and what was refused.
    fn wishes(&self, scene: &mut Scene, palette: &Palette, options: &ViewOptions) {
        let z = self.handle_height();
        let line = |name: &str, points: &[Vector], colour, dash| Line {
            name: name.into(),
            points: points.iter().map(|p| point(*p, z)).collect(),
            width: 1.8,
            colour,
            dash,
            on_top: true,
        };
        if options.stroke.len() > 1 {
            let drawn: Vec<Vector> = options.stroke.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
            scene.lines.push(line("stroke", &drawn, palette.ink, None));
        }
        if let Some(refused) = &options.refused {
            scene.lines.push(line("refused", &refused.curve, palette.reaction, Some([4.0, 4.0])));
            scene.markers.push(Marker {
                name: "refused/at".into(),
                at: point(refused.at, z),
                radius: 5.5,
                fill: palette.background,
                stroke: palette.reaction,
                stroke_width: 2.2,
            });
            scene.labels.push(label(
                refused.at,
                z,
                [12.0, 0.0],
                &format!("stops here: {}", refused.why),
                palette.reaction,
                12.0,
                Anchor::Left,
            ));
        }
    }

    /// Points of the planned path that can be dragged: their numbers, A first.
    pub fn waypoints(&self) -> impl Iterator<Item = usize> + '_ {
        self.motion.iter().flat_map(|course| course.waypoints.iter().map(|(i, ..)| *i))
    }

    /// A force arrow and a moment arc at B, in proportion, with their scale in words.
    fn reaction(&self, scene: &mut Scene, palette: &Palette, frame: &Frame) {
        let (z, reach) = (self.handle_height(), self.linkage.reach());
        let (force, moment) = (frame.wrench.dynamic.force, frame.base_moment());
        let weight = frame.wrench.statical.force.norm();
        let tone = |still: bool| if still { palette.zero } else { palette.reaction };
        let pulls = frame.wrench.dynamic.force.norm() > REACTIONLESS * frame.peaks.inertial_pull.max(1e-9);
        let turns = moment.abs() > REACTIONLESS * frame.peaks.torque_sum.max(1e-9);
        let line = |name: &str, points: Vec<[f32; 3]>| Line {
            name: name.into(),
            points,
            width: 3.0,
            colour: palette.reaction,
            dash: None,
            on_top: true,
        };
        let per_newton = 0.25 * reach / round_up(frame.peaks.force.max(force.norm()).max(1e-3));
        let arrow = force * per_newton;
        if arrow.norm() > 0.004 * reach {
            scene.lines.push(line("reaction/force", vec![point(Vector::default(), z), point(arrow, z)]));
            scene.lines.push(line("reaction/force", head(arrow, force / force.norm(), 0.025 * reach, z)));
        }
        let full = round_up(frame.peaks.moment.max(1e-3));
        let sweep = moment / full * 1.5 * FRAC_PI_2;
        let radius = 0.17 * reach;
        if sweep.abs() > 0.02 {
            let n = ((sweep.abs() * 24.0).ceil() as usize).max(2);
            let from = -FRAC_PI_2;
            let arc: Vec<_> = (0..=n).map(|i| point(unit(from + sweep * i as f64 / n as f64) * radius, z)).collect();
            scene.lines.push(line("reaction/moment", arc));
            let end = unit(from + sweep);
            let along = end * Vector::new(0.0, sweep.signum());
            scene.lines.push(line("reaction/moment", head(end * radius, along, 0.025 * reach, z)));
        }
        let com = frame.com;
        let arm = 0.014 * reach;
        for d in [Vector::new(arm, 0.0), Vector::new(0.0, arm)] {
            scene.lines.push(Line {
                name: "com".into(),
                points: vec![point(com - d, z), point(com + d, z)],
                width: 1.8,
                colour: palette.ink,
                dash: None,
                on_top: true,
            });
        }
        let at = Vector::new(0.2 * reach, -0.11 * reach);
        let still = com.norm() < 1e-6 * reach;
        let com_words = if still {
            "centre of mass at rest in B".into()
        } else {
            format!("centre of mass {:.2} mm off B", 1e3 * com.norm())
        };
        let scale = match (arrow.norm() > 0.004 * reach, sweep.abs() > 0.02) {
            (false, false) => String::new(),
            (true, false) => format!("arrow: {:.3} m = {} N", 0.25 * reach, brief(0.25 * reach / per_newton)),
            (false, true) => format!("arc: 135° = {} N m", brief(full)),
            (true, true) => {
                format!(
                    "arrow: {:.3} m = {} N · arc: 135° = {} N m",
                    0.25 * reach,
                    brief(0.25 * reach / per_newton),
                    brief(full)
                )
            }
        };
        let rows = [
            (format!("f_B {} N", reading(force.norm(), pulls)), tone(!pulls), 13.0),
            (format!("n_B {} N m", reading(moment, turns)), tone(!turns), 13.0),
            (if weight > 0.0 { format!("and its weight, {weight:.1} N") } else { String::new() }, palette.dim, 11.5),
            (com_words, palette.dim, 11.5),
            (scale, palette.dim, 11.5),
        ];
        let mut down = 0.0;
        for (text, colour, size) in rows.into_iter().filter(|(t, ..)| !t.is_empty()) {
            scene.labels.push(label(at, z, [0.0, down], &text, colour, size, Anchor::Left));
            down += 17.0;
        }
    }

    fn target(&self, scene: &mut Scene, palette: &Palette, frame: &Frame, options: &ViewOptions) {
        let z = self.handle_height();
        let tip = frame.tip;
        let hot = options.hot == Some(Handle::Target);
        let outside = matches!(frame.target.reach, Reach::Outside { .. });
        let held = options.held.filter(|_| outside).map(|[x, y]| Vector::new(x, y));
        let at = held.unwrap_or_else(|| target_handle(frame));
        scene.markers.push(Marker {
            name: "end-effector".into(),
            at: point(tip, z),
            radius: 4.0,
            fill: palette.ink,
            stroke: palette.ink,
            stroke_width: 0.0,
        });
        scene.markers.push(Marker {
            name: "target".into(),
            at: point(at, z),
            radius: if hot { 15.0 } else { 12.5 },
            fill: faded(palette.ink, if hot && !outside { 0.12 } else { 0.0 }),
            stroke: palette.ink,
            stroke_width: 2.2,
        });
        let ink = palette.ink;
        match frame.target.reach {
            Reach::Outside { nearest, mending_b, other_sheet } => {
                scene.lines.push(Line {
                    name: "target/gap".into(),
                    points: vec![point(nearest, z), point(at, z)],
                    width: 1.4,
                    colour: palette.dim,
                    dash: Some([4.0, 4.0]),
                    on_top: true,
                });
                scene.markers.push(Marker {
                    name: "target/nearest".into(),
                    at: point(nearest, z),
                    radius: 4.5,
                    fill: palette.background,
                    stroke: palette.amber,
                    stroke_width: 2.0,
                });
                let would = match mending_b {
                    Some(b) => format!("b = {b:.3} rad would reach it"),
                    None if other_sheet => "drag it round, or change b".into(),
                    None => "no b reaches it".into(),
                };
                let title = match other_sheet {
                    true => "beyond a fold or a change point",
                    false => "outside the reactionless workspace",
                };
                let rows = [
                    (title.into(), ink, 13.0),
                    (format!("nearest point {} m", brief_point(nearest)), palette.dim, 11.5),
                    (would, palette.dim, 11.5),
                ];
                for (i, (text, colour, size)) in rows.into_iter().enumerate() {
                    let down = 26.0 + 16.0 * i as f32;
                    scene.labels.push(label(at, z, [0.0, down], &text, colour, size, Anchor::Centre));
                }
            }
            reach => {
                let words = if reach == Reach::Carried { "turns with its workspace" } else { INVITATION };
                let text = format!("{} m", brief_point(tip));
                scene.labels.push(label(at, z, [20.0, -7.0], &text, ink, 13.0, Anchor::Left));
                scene.labels.push(label(at, z, [20.0, 9.0], words, palette.dim, 11.5, Anchor::Left));
            }
        }
    }
}

/// The workspace of a pose constant at a height, m.
fn area_of(map: &PlaneMap, b: f64, name: &str, z: f64, colour: Rgba) -> Area {
    let limits = map.limits();
    Area {
        name: name.into(),
        c: map.c().map(|x| x as f32),
        u: map.u().map(|u| u.map(|x| x as f32)),
        v: map.v().map(|x| x as f32),
        a_min: limits.map(|l| l.min as f32),
        a_max: limits.map(|l| l.max as f32),
        // Whole turns are taken off in f64, where they cost nothing.
        turn: map.turn(b).rem_euclid(TAU) as f32,
        z: z as f32,
        colour,
        shade: None,
    }
}

/// Where the target's handle is: out of reach it stays where it was sent, else it goes with the end effector.
pub(super) fn target_handle(frame: &Frame) -> Vector {
    match frame.target.reach {
        Reach::Outside { .. } => frame.target.at,
        Reach::Inside | Reach::Carried => frame.tip,
    }
}

/// The point of the workspace that is farthest from its boundary, of those that the arm's root does not cover.
fn roomiest(planes: &Planes, boundary: &[Vec<Vector>]) -> Option<Vector> {
    let map = planes.map();
    let [l1, l2] = map.limits();
    let at = |l: crate::reactionless::Limit, i: i32| l.min + (f64::from(i) + 0.5) / 20.0 * (l.max - l.min);
    let far = 0.35 * map.c().iter().map(|c| c.abs()).sum::<f64>();
    let outline: Vec<Vector> = boundary.iter().flat_map(|l| l.iter().step_by(4).copied()).collect();
    let room = |p: &Vector| outline.iter().fold(f64::INFINITY, |m, q| m.min((p - q).norm_sqr()));
    (0..400)
        .map(|i| map.forward_unturned([at(l1, i / 20), at(l2, i % 20)]))
        .filter(|p| p.norm() > far)
        .map(|p| (room(&p), p))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, p)| p)
}

fn place(tip: &Chain, q: &DriveAngles) -> Vector {
    crate::machine::place_of(tip, &q.units())
}

fn point(p: Vector, z: f64) -> [f32; 3] {
    [p.re as f32, p.im as f32, z as f32]
}

fn label(at: Vector, z: f64, offset: [f32; 2], text: &str, colour: Rgba, size: f32, anchor: Anchor) -> Label {
    Label { at: point(at, z), offset, text: text.into(), colour, size, anchor }
}

/// The two barbs of an arrow head at a point, along a unit vector.
fn head(at: Vector, along: Vector, size: f64, z: f64) -> Vec<[f32; 3]> {
    let barb = |turn: f64| at - along * unit(turn) * size;
    vec![point(barb(0.5), z), point(at, z), point(barb(-0.5), z)]
}

/// The next of 1, 2, 5 times a power of ten.
pub fn round_up(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * decade).find(|v| *v >= x * (1.0 - 1e-12)).unwrap_or(10.0 * decade)
}

/// A reaction: three decimals, or its order of magnitude where they would hide it.
fn reading(x: f64, real: bool) -> String {
    if real && x.abs() < 5e-4 { format!("{x:.1e}").replace('-', "−") } else { signed(x, 3) }
}

fn brief(x: f64) -> String {
    format!("{x:.6}").trim_end_matches('0').trim_end_matches('.').into()
}

fn brief_point(p: Vector) -> String {
    format!("{}, {}", signed(p.re, 3), signed(p.im, 3))
}

/// Fixed decimals with a real minus sign, and no minus on zero.
pub fn signed(x: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", x.abs());
    let zero = text.chars().all(|c| c == '0' || c == '.');
    if x < 0.0 && !zero { format!("−{text}") } else { text }
}
