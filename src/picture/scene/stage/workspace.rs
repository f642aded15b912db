//! The reactionless workspaces, what runs inside them, and the ring that turns them.

use std::f64::consts::TAU;

use super::{Handle, Stage, ViewOptions, label, point};
use crate::mechanics::planar::{Pose2, Vector, unit};
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::{Anchor, Area, Line, Marker, Measure, Rgba, Scene, Shade, dexterity};
use crate::planning::pose_constant::Planes;
use crate::planning::reactionless::PlaneMap;
use crate::simulation::frame::Frame;

/// What a curve in the workspace is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Inside {
    /// det = 0: two poses meet.
    Fold,
    /// A limit that some pose meets there.
    Limit,
    /// Two drives are parallel.
    Change,
}

impl Inside {
    pub fn name(self) -> &'static str {
        match self {
            Self::Fold => "fold",
            Self::Limit => "inner-limit",
            Self::Change => "change-point",
        }
    }
}

pub(super) fn inside(planes: &Planes) -> Vec<(Inside, Vec<Vector>)> {
    let b = planes.boundary();
    let drawn = |line: &crate::planning::reactionless::Line| -> Vec<Vector> {
        let mut points: Vec<Vector> = line.turned(0.0).iter().map(|[x, y]| Vector::new(*x, *y)).collect();
        points.extend(points.first().copied().filter(|_| line.is_closed()));
        points
    };
    let folds = b.fold_curves().iter().map(|line| (Inside::Fold, drawn(line))).collect::<Vec<_>>();
    let limits = b.inner_limits().iter().map(|line| (Inside::Limit, drawn(line))).collect::<Vec<_>>();
    let changes = b.change_curves().iter().map(|curve| (Inside::Change, drawn(&curve.line))).collect::<Vec<_>>();
    [folds, limits, changes].concat()
}

/// The workspace of a pose constant at a height, m.
pub(super) fn area_of(map: &PlaneMap, b: f64, name: &str, z: f64, colour: Rgba) -> Area {
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
        at: [0.0; 2],
        z: z as f32,
        colour,
        shade: None,
    }
}

/// The point of the workspace that is farthest from its boundary, of those that the arm's root does not cover.
pub(super) fn roomiest(planes: &Planes, boundary: &[Vec<Vector>]) -> Option<Vector> {
    let map = planes.map();
    let [l1, l2] = map.limits();
    let at =
        |l: crate::planning::reactionless::AngleLimit, i: i32| l.min + (f64::from(i) + 0.5) / 20.0 * (l.max - l.min);
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

impl Stage {
    /// The workspace of b in the axes of a base.
    pub(super) fn workspace(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        planes: &Planes,
        b: f64,
        base: Pose2,
        compared: bool,
    ) {
        let (colour, edge, dash, lift) = match compared {
            false => (faded(palette.amber, 0.13), palette.amber, None, 0.0),
            true => (faded(palette.dim, 0.08), faded(palette.dim, 0.55), Some([5.0, 4.0]), -0.002),
        };
        let z = self.linkage.floor() + lift * self.linkage.reach();
        let name = if compared { "workspace/compared" } else { "workspace" };
        let mut area = area_of(planes.map(), b, name, z, colour);
        area.turn = (planes.map().turn(b) + base.angle).rem_euclid(TAU) as f32;
        area.at = [base.at.re as f32, base.at.im as f32];
        scene.areas.push(area);
        let r = unit(planes.map().turn(b) + base.angle);
        let there = |p: Vector| base.at + p * r;
        for outline in &self.boundary {
            let mut points: Vec<_> = outline.iter().map(|p| point(there(*p), z)).collect();
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
                points: line.iter().map(|p| point(there(*p), z)).collect(),
                width: 1.2,
                colour,
                dash,
                on_top: false,
            });
        }
        for cusp in self.cusps.iter().filter(|_| !compared) {
            scene.markers.push(Marker {
                name: "workspace/cusp".into(),
                at: point(there(*cusp), z),
                radius: 2.5,
                fill: palette.amber,
                stroke: palette.amber,
                stroke_width: 0.0,
            });
        }
        // Whole turns of the machine make no other workspace.
        let within = b.rem_euclid(planes.map().period());
        let rows = match compared {
            true => vec![(format!("b = {within:.3} rad"), palette.dim, 11.5)],
            false => vec![
                ("reactionless workspace".into(), palette.amber, 12.5),
                (format!("b = {within:.3} rad · {:.3} m²", planes.boundary().area()), palette.dim, 11.5),
            ],
        };
        for (i, (text, colour, size)) in rows.into_iter().enumerate().filter(|_| self.middle.is_some()) {
            let at = there(self.middle.unwrap_or_default());
            scene.labels.push(label(at, z, [0.0, 17.0 * i as f32], &text, colour, size, Anchor::Centre));
        }
    }

    /// By a measure, from its least to its greatest.
    pub(super) fn shade(&self, area: &mut Area, palette: &Palette, measure: Measure) {
        let [low, high] = dexterity::colours(palette);
        let [empty, full] = self.shaded(measure).map(|x| x as f32);
        (area.colour, area.shade) = (low, Some(Shade { measure, colour: high, empty, full }));
    }

    /// The outline of the workspace of a b that is only looked at.
    pub(super) fn preview(&self, scene: &mut Scene, palette: &Palette, planes: &Planes, b: f64) {
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

    pub(super) fn ring(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        planes: &Planes,
        frame: &Frame,
        options: &ViewOptions,
    ) {
        let (radius, z) = (self.ring_radius(), self.handle_height());
        let turn = planes.map().turn(frame.b_reference) + frame.base.angle;
        let b = frame.base.at;
        let circle = |from: f64, to: f64| -> Vec<[f32; 3]> {
            let n = (((to - from).abs() / TAU * 96.0).ceil() as usize).max(2);
            (0..=n).map(|i| point(b + unit(from + (to - from) * i as f64 / n as f64) * radius, z)).collect()
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
        let shown = (turn - frame.base.angle).rem_euclid(TAU);
        scene.lines.push(line("ring/b", circle(frame.base.angle, frame.base.angle + shown), 3.5, palette.amber));
        let knob = b + unit(turn) * radius;
        let hot = options.hot == Some(Handle::Ring);
        scene.markers.push(Marker {
            name: "ring/knob".into(),
            at: point(knob, z),
            radius: if hot { 9.0 } else { 7.0 },
            fill: palette.amber,
            stroke: palette.background,
            stroke_width: 2.0,
        });
        let beside = b + unit(turn) * (radius * 1.28);
        scene.labels.push(label(beside, z, [0.0, 0.0], "b", palette.amber, 14.0, Anchor::Centre));
    }
}
