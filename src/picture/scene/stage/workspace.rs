//! The reactionless workspaces, and what runs inside them.

use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

use crate::mechanics::planar::{Pose2, Vector, unit};
use crate::picture::scene::exaggeration::Shown;
use crate::picture::scene::linkage::Linkage;
use crate::picture::scene::options::{Handle, ViewOptions};
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::{
    Anchor, Area, Label, Line, Marker, Measure, Name, Rgba, Scene, Shade, Strips, dexterity, point, posed,
};
use crate::planning::pose_space::Planes;
use crate::planning::reactionless::{self, AngleLimit, PlaneMap};

/// The workspaces of a run before they are turned: that of its b, one to compare with, and one that is looked at.
#[derive(Clone, Debug)]
pub struct Workspace {
    planes: Arc<Planes>,
    /// Where words about it have the most room.
    middle: Option<Vector>,
    compared: Option<f64>,
    boundary: Strips,
    folds: Strips,
    limits: Strips,
    change_points: Strips,
    /// Where folds turn back, m.
    cusps: Vec<Vector>,
    /// Least and greatest of each measure of dexterity within the limits, found when first shown.
    dexterity: [OnceLock<[f64; 2]>; 3],
}

/// What is reached while b is held, in words that promise no more than is true.
pub(super) fn held(noun: &str, is_reactionless: bool) -> String {
    format!("{}reactionless {noun}", if is_reactionless { "" } else { "nearly " })
}

impl Workspace {
    /// Of planes, with a b to compare with.
    pub fn of(planes: &Arc<Planes>, compared: Option<f64>) -> Self {
        let boundary = planes.boundary();
        let loops: Vec<Vec<Vector>> = boundary.turned(0.0).into_iter().map(vectors).collect();
        let drawn = |lines: &mut dyn Iterator<Item = &reactionless::BoundaryLine>| -> Strips {
            lines
                .map(|line| {
                    let mut points = vectors(line.turned(0.0));
                    points.extend(points.first().copied().filter(|_| line.is_closed()));
                    flat(&points)
                })
                .collect()
        };
        let closed = |outline: &Vec<Vector>| {
            let mut points = flat(outline);
            points.extend(points.first().copied().filter(|first| points.len() > 2 && points.last() != Some(first)));
            points
        };
        Self {
            middle: roomiest(planes, &loops),
            compared,
            boundary: loops.iter().map(closed).collect(),
            folds: drawn(&mut boundary.fold_curves().iter()),
            limits: drawn(&mut boundary.inner_limits().iter()),
            change_points: drawn(&mut boundary.change_curves().iter().map(|curve| &curve.line)),
            cusps: boundary.cusps().iter().map(|v| v.at).collect(),
            dexterity: Default::default(),
            planes: planes.clone(),
        }
    }

    /// The planes it is of.
    pub fn planes(&self) -> &Planes {
        &self.planes
    }

    /// Its boundary at a height, m, where it is in a frame.
    pub fn edge(&self, shown: &Shown<'_>, z: f64) -> Line {
        let turn = self.planes.map().turn(shown.frame.b_reference) + shown.base.angle;
        let line = Line::new("workspace/boundary", self.boundary.clone(), 1.8, [0.0; 4]);
        line.moving(posed(shown.base.at, unit(turn), z))
    }

    /// From where to where a measure of dexterity is shaded.
    pub fn shaded(&self, measure: Measure) -> [f64; 2] {
        *self.dexterity[measure as usize].get_or_init(|| measure.range(self.planes.map()))
    }

    /// The b of the workspace to compare with, rad.
    pub fn compared_b(&self) -> Option<f64> {
        self.compared
    }

    /// The workspace to compare with, the own one, and the one that is looked at.
    pub fn draw(
        &self,
        scene: &mut Scene,
        linkage: &Linkage,
        palette: &Palette,
        shown: &Shown<'_>,
        options: &ViewOptions,
    ) {
        let (floor, map) = (linkage.floor(), self.planes.map());
        if let Some(b) = self.compared.filter(|_| options.compares) {
            self.compared(scene, palette, b, shown.base, floor - 0.002 * linkage.reach());
        }
        self.own(scene, palette, shown, options, floor);
        if let Some(b) = options.preview_b {
            let pose = posed(Vector::default(), unit(map.turn(b)), floor);
            let outline = Line::new("workspace/preview", self.boundary.clone(), 1.2, faded(palette.amber, 0.8));
            scene.lines.push(Line { world_from_item: pose, ..outline.dashed(5.0, 4.0) });
        }
    }

    fn compared(&self, scene: &mut Scene, palette: &Palette, b: f64, base: Pose2, z: f64) {
        let turn = self.planes.map().turn(b) + base.angle;
        let colour = faded(palette.dim, 0.08);
        scene.areas.push(area(self.planes.map(), (turn, base.at), "workspace/compared", z, colour));
        let name = "workspace/compared/boundary";
        let edge = Line::new(name, self.boundary.clone(), 1.2, faded(palette.dim, 0.55)).dashed(5.0, 4.0);
        scene.lines.push(edge.moving(posed(base.at, unit(turn), z)));
        if let Some(middle) = self.middle {
            let at = point(base.at + middle * unit(turn), z);
            let text = format!("b = {:.3} rad", b.rem_euclid(self.planes.map().period()));
            let name = "workspace/compared/label";
            scene.labels.push(Label::new(name, at, [0.0, 0.0], text, palette.dim, 11.5, Anchor::Centre));
        }
    }

    fn own(&self, scene: &mut Scene, palette: &Palette, shown: &Shown<'_>, options: &ViewOptions, z: f64) {
        let (map, b, base) = (self.planes.map(), shown.frame.b_reference, shown.base);
        let turn = map.turn(b) + base.angle;
        let mut area = area(map, (turn, base.at), "workspace", z, faded(palette.amber, 0.13));
        if let Some(measure) = options.dexterity {
            // By a measure, from its least to its greatest.
            let [low, high] = dexterity::colours(palette);
            let [empty, full] = self.shaded(measure).map(|x| x as f32);
            (area.colour, area.shade) = (low, Some(Shade { measure, colour: high, empty, full }));
        }
        scene.areas.push(area);
        let pose = posed(base.at, unit(turn), z);
        let mut line = |name: &'static str, strips: &Strips, width, colour, dash: Option<[f32; 2]>| {
            if !strips.is_empty() {
                scene.lines.push(Line { dash, ..Line::new(name, strips.clone(), width, colour).moving(pose) });
            }
        };
        let width = if options.hot == Some(Handle::Boundary) { 3.0 } else { 1.8 };
        line("workspace/boundary", &self.boundary, width, palette.amber, None);
        line("workspace/folds", &self.folds, 1.2, palette.amber, None);
        line("workspace/inner_limits", &self.limits, 1.2, faded(palette.amber, 0.55), None);
        line("workspace/change_points", &self.change_points, 1.2, faded(palette.dim, 0.8), Some([2.0, 4.0]));
        let there = |p: Vector| point(base.at + p * unit(turn), z);
        let cusps = self.cusps.iter().map(|cusp| Marker::disc("workspace/cusps", there(*cusp), 2.5, palette.amber));
        scene.markers.extend(cusps);
        let Some(middle) = self.middle else { return };
        // Whole turns of the machine make no other workspace.
        let within = b.rem_euclid(map.period());
        let rows = [
            (held("workspace", self.planes.is_reactionless()), palette.amber, 12.5),
            (format!("b = {within:.3} rad · {:.3} m²", self.planes.boundary().area()), palette.dim, 11.5),
        ];
        for (i, (text, colour, size)) in rows.into_iter().enumerate() {
            let offset = [0.0, 17.0 * i as f32];
            let name = "workspace/label";
            scene.labels.push(Label::new(name, there(middle), offset, text, colour, size, Anchor::Centre));
        }
    }
}

fn vectors(points: Vec<[f64; 2]>) -> Vec<Vector> {
    points.into_iter().map(|[x, y]| Vector::new(x, y)).collect()
}

fn flat(points: &[Vector]) -> Vec<[f32; 3]> {
    points.iter().map(|p| point(*p, 0.0)).collect()
}

/// The workspace of a map turned and shifted, at a height, m.
fn area(map: &PlaneMap, (turn, at): (f64, Vector), name: impl Into<Name>, z: f64, colour: Rgba) -> Area {
    let limits = map.limits();
    Area {
        name: name.into(),
        c: map.c().map(|x| x as f32),
        u: map.u().map(|u| u.map(|x| x as f32)),
        v: map.v().map(|x| x as f32),
        a_min: limits.map(|l| l.min as f32),
        a_max: limits.map(|l| l.max as f32),
        // Whole turns are taken off in f64, where they cost nothing.
        turn: turn.rem_euclid(TAU) as f32,
        at: [at.re as f32, at.im as f32],
        z: z as f32,
        colour,
        shade: None,
    }
}

/// The point of the workspace that is farthest from its boundary, of those that the arm's root does not cover.
fn roomiest(planes: &Planes, boundary: &[Vec<Vector>]) -> Option<Vector> {
    let map = planes.map();
    let [l1, l2] = map.limits();
    let at = |l: AngleLimit, i: i32| l.min + (f64::from(i) + 0.5) / 20.0 * (l.max - l.min);
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
