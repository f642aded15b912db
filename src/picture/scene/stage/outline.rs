//! What a machine of other than three drives reaches while b is held: the curve of two, the boundary of more.

use std::sync::Arc;

use super::workspace::held;
use crate::mechanics::planar::{Pose2, Vector, unit};
use crate::picture::scene::exaggeration::Shown;
use crate::picture::scene::linkage::Linkage;
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::{Anchor, Changes, Label, Line, Marker, Mesh, Scene, Solid, Strips, fill, point, posed};
use crate::planning::pose_space::PoseSpace;
use crate::query::{Portion, Query, Shared, Watch};
use crate::simulation::frame::Frame;

/// Chords are as near to the boundary as this, m for an arm of a metre: less than a pixel.
const CHORD: f64 = 5e-4;

/// How much of the colour fills it, as of three drives, and how far below the boundary, as a share of the reach.
const FILL: f32 = 0.13;
const BELOW: f64 = 1e-3;

/// A workspace before it is turned.
#[derive(Clone, Debug)]
pub struct Outlined {
    space: PoseSpace,
    strips: Strips,
    /// What lies inside of it; nothing of a curve.
    fill: Arc<Mesh>,
    /// What it is, and its length or area.
    words: [String; 2],
    /// Where the words stand, m.
    middle: Vector,
    /// Where a curve ends, m, and at which angle.
    ends: Vec<(Vector, String)>,
}

/// The point inside the loops that is farthest from them, m, of those of a coarse grid that the arm's root does not
/// cover.
fn roomiest(loops: &[Vec<[f64; 2]>], [x_min, x_max, y_min, y_max]: [f64; 4], root: f64) -> Vector {
    const GRID: i32 = 16;
    /// Vertices of a loop that are looked at.
    const THINNED: usize = 240;
    let thin = |line: &Vec<[f64; 2]>| -> Vec<[f64; 2]> {
        line.iter().step_by(line.len().div_ceil(THINNED).max(1)).copied().collect()
    };
    let loops: Vec<Vec<[f64; 2]>> = loops.iter().map(thin).collect();
    let at = |i: i32, low: f64, high: f64| low + (high - low) * (f64::from(i) + 0.5) / f64::from(GRID);
    let points = (0..GRID * GRID).map(|k| Vector::new(at(k % GRID, x_min, x_max), at(k / GRID, y_min, y_max)));
    // Edges above or below a point, counted: inside of an odd number.
    let is_inside = |p: &Vector| {
        let crossed = |line: &Vec<[f64; 2]>| {
            let crosses = |i: &usize| {
                let ([ax, ay], [bx, by]) = (line[*i], line[(*i + 1) % line.len()]);
                (ay > p.im) != (by > p.im) && p.re < ax + (p.im - ay) / (by - ay) * (bx - ax)
            };
            (0..line.len()).filter(crosses).count()
        };
        loops.iter().map(crossed).sum::<usize>() % 2 == 1
    };
    let room = |p: &Vector| {
        let all = loops.iter().flatten();
        all.fold(f64::INFINITY, |least, [x, y]| least.min((Vector::new(*x, *y) - p).norm_sqr()))
    };
    let roomy = points.filter(|p| p.norm() > root && is_inside(p)).map(|p| (room(&p), p));
    roomy.max_by(|p, q| p.0.total_cmp(&q.0)).map(|(_, p)| p).unwrap_or_default()
}

/// The outline of what a pose space reaches while b is held.
#[derive(Debug)]
pub struct Outlining(Shared<PoseSpace>);

impl Query for Outlining {
    type Input = Shared<PoseSpace>;
    /// Nothing of a machine that stays on a point.
    type Answer = Option<Arc<Outlined>>;

    fn begin(space: Self::Input) -> Self {
        Self(space)
    }

    fn go_on(&mut self, goes_on: Watch<'_>) -> Portion<Self::Answer> {
        let mut stopped = false;
        let mut watched = |share: f64| {
            stopped = !goes_on(share);
            !stopped
        };
        let outline = Outlined::of(PoseSpace::clone(&self.0.0), &mut watched);
        if stopped { Portion::Stopped } else { Portion::Done(outline.map(Arc::new)) }
    }
}

impl Outlined {
    /// Of a machine with a pose constant; nothing of one that stays on a point, or if, told how much is done, the caller
    /// wants the rest no more.
    pub fn of(space: PoseSpace, goes_on: Watch<'_>) -> Option<Self> {
        let outline = space.outline_within(0.0, CHORD, goes_on)?;
        let vectors =
            |points: &[[f64; 2]]| -> Vec<Vector> { points.iter().map(|[x, y]| Vector::new(*x, *y)).collect() };
        let flat = |points: &[Vector]| -> Vec<[f32; 3]> { points.iter().map(|p| point(*p, 0.0)).collect() };
        let curve = vectors(&outline.curve);
        let (lines, words, middle) = if curve.len() > 1 {
            let words = [held("curve", space.is_reactionless()), format!("{:.3} m", outline.length)];
            (vec![flat(&curve)], words, curve[curve.len() / 2])
        } else {
            let closed = |line: &Vec<[f64; 2]>| {
                let mut points = flat(&vectors(line));
                points.extend(points.first().copied());
                points
            };
            let [x_min, x_max, y_min, y_max] = outline.extent;
            let words = [held("workspace", space.is_reactionless()), format!("{:.3} m²", outline.area)];
            let middle = roomiest(&outline.loops, [x_min, x_max, y_min, y_max], 0.35 * space.farthest());
            (outline.loops.iter().map(closed).collect(), words, middle)
        };
        let named = |(end, at): (usize, &Vector)| {
            let joint = space.joints().first()?;
            let angle = joint.bounds()[end];
            angle.is_finite().then(|| (*at, format!("a₁ = {:.1}°", angle.to_degrees())))
        };
        let ends = [curve.first(), curve.last()].into_iter().flatten().filter(|_| curve.len() > 1);
        let ends = ends.enumerate().filter_map(named).collect();
        let fill = Arc::new(fill::mesh(&outline.loops));
        (!lines.is_empty()).then(|| Self { strips: lines.into(), fill, words, middle, ends, space })
    }

    /// It at b = 0 as closed lines, m: a curve there and back.
    pub fn shape(&self) -> Vec<Vec<Vector>> {
        let flat = |line: &Vec<[f32; 3]>| -> Vec<Vector> {
            line.iter().map(|[x, y, _]| Vector::new(f64::from(*x), f64::from(*y))).collect()
        };
        let mut lines: Vec<_> = self.strips.iter().map(flat).collect();
        if !self.space.reaches_area() {
            for line in &mut lines {
                let back: Vec<_> = line.iter().rev().skip(1).copied().collect();
                line.extend(back);
            }
        }
        lines
    }

    /// What it is of.
    pub fn space(&self) -> &PoseSpace {
        &self.space
    }

    /// What lies inside of it, before it is turned; no triangles of a curve.
    pub fn fill(&self) -> &Mesh {
        &self.fill
    }

    /// How far it is turned in a frame, rad.
    fn turn(&self, shown: &Shown<'_>) -> f64 {
        self.space.turn(shown.frame.b_reference) + shown.base.angle
    }

    /// Its points at a b on the base of a frame, m.
    pub fn points(&self, b: f64, frame: &Frame) -> Vec<Vector> {
        let turn = unit(self.space.turn(b) + frame.base.angle);
        let all = self.strips.iter().flatten();
        all.map(|[x, y, _]| frame.base.at + turn * Vector::new(f64::from(*x), f64::from(*y))).collect()
    }

    /// The same at another b, to compare with.
    pub fn draw_compared(&self, scene: &mut Scene, linkage: &Linkage, palette: &Palette, b: f64, base: Pose2) {
        let turn = unit(self.space.turn(b) + base.angle);
        let z = linkage.floor() - 2.0 * BELOW * linkage.reach();
        let line = Line::new("workspace/compared/boundary", self.strips.clone(), 1.2, faded(palette.dim, 0.55));
        scene.lines.push(line.dashed(5.0, 4.0).moving(posed(base.at, turn, z)));
        let at = point(base.at + self.middle * turn, z);
        let text = format!("b = {:.3} rad", b.rem_euclid(self.space.period()));
        let name = "workspace/compared/label";
        scene.labels.push(Label::new(name, at, [0.0, 0.0], text, palette.dim, 11.5, Anchor::Centre));
    }

    /// Draws it where it is in a frame, filled with a mesh.
    pub fn draw(
        &self,
        scene: &mut Scene,
        (linkage, fill): (&Linkage, Option<usize>),
        palette: &Palette,
        shown: &Shown<'_>,
    ) {
        let (turn, z) = (self.turn(shown), linkage.floor());
        // Under all lines.
        let below = posed(shown.base.at, unit(turn), z - BELOW * linkage.reach());
        scene.solids.extend(fill.map(|mesh| Solid {
            name: "workspace".into(),
            mesh,
            world_from_item: below,
            colour: faded(palette.amber, FILL),
            changes: Changes::Pose,
        }));
        let pose = posed(shown.base.at, unit(turn), z);
        scene.lines.push(Line::new("workspace/boundary", self.strips.clone(), 1.8, palette.amber).moving(pose));
        let there = |p: Vector| point(shown.base.at + p * unit(turn), z);
        for (end, words) in &self.ends {
            scene.markers.push(Marker::disc("workspace/ends", there(*end), 3.5, palette.amber));
            let offset = [0.0, 14.0];
            let label =
                Label::new("workspace/ends/names", there(*end), offset, words, palette.dim, 11.5, Anchor::Centre);
            scene.labels.push(label);
        }
        let within = shown.frame.b_reference.rem_euclid(self.space.period());
        let [what, size] = &self.words;
        let rows = [(what.clone(), palette.amber, 12.5), (format!("b = {within:.3} rad · {size}"), palette.dim, 11.5)];
        for (i, (text, colour, size)) in rows.into_iter().enumerate() {
            let offset = [0.0, -26.0 + 17.0 * i as f32];
            let name = "workspace/label";
            scene.labels.push(Label::new(name, there(self.middle), offset, text, colour, size, Anchor::Centre));
        }
    }
}
