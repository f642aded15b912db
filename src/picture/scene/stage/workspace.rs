//! The workspace for constant b: the reactionless workspace for any number of drives, and the curves inside it.

use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

use super::turn_areas::TurnAreas;
use crate::scene::exaggeration::DrawnFrame;
use crate::scene::linkage::LinkageModel;
use crate::scene::options::{Handle, ViewOptions};
use crate::scene::palette::{Palette, faded};
use crate::scene::platform_reach::slices::Lines;
use crate::scene::{
    Anchor, Area, IN_PLACE, ItemChanges, Label, Marker, Measure, Mesh, Name, Polyline, Rgba, Scene, Shade, Solid,
    Strips, dexterity, fill, point, posed,
};
use stillbase_mechanics::planar::{Pose2, Vector, unit};
use stillbase_planning::off_plane::rays::Rays;
use stillbase_planning::pose_space::{Planes, PoseSpace};
use stillbase_planning::reactionless::{AngleLimit, BoundaryLine, PlaneMap};
use stillbase_query::{Portion, ProgressCallback, Query, Shared};
use stillbase_simulation::frame::Frame;

/// Maximum distance of chords from the boundary, m: less than a pixel for an arm of 1 m.
const CHORD_TOLERANCE: f64 = 5e-4;

/// Opacity of the fill.
const FILL_OPACITY: f32 = 0.13;
/// Distance of the filling triangles below the boundary, as a fraction of the reach.
const FILL_DEPTH: f64 = 1e-3;

/// Vertical offsets of the label, points, for machines with planes and without.
const LABEL_OFFSETS_PT: [f32; 2] = [0.0, -26.0];

/// A workspace at b = 0: a region, or the curve of two drives.
#[derive(Clone, Debug)]
pub struct Workspace {
    space: Arc<PoseSpace>,
    boundary: Strips,
    /// Boundary as closed lines, m; a curve is traversed forwards and backwards.
    shape: Vec<Vec<Vector>>,
    /// Name, and length or area.
    words: [String; 2],
    /// Point with the most space for labels, m.
    middle: Option<Vector>,
    /// End points of a curve, m, and the labels of their angles.
    ends: Vec<(Vector, String)>,
    inside: Inside,
}

/// The inside of a workspace.
#[derive(Clone, Debug)]
enum Inside {
    /// Sheets of Eq. (16), for machines with planes.
    Sheets(Sheets),
    /// Triangles; empty for a curve.
    Filled(Arc<Mesh>),
}

/// The sheets of a machine with planes, and the curves inside them.
#[derive(Clone, Debug)]
struct Sheets {
    planes: Arc<Planes>,
    folds: Strips,
    limits: Strips,
    change_points: Strips,
    /// Cusps of the folds, m.
    cusps: Vec<Vector>,
    /// Ends of the colour scale of each measure of dexterity within the joint limits; computed once, on first use.
    dexterity: [OnceLock<[f64; 2]>; 3],
}

/// Returns the name of a workspace or curve: `noun` with "reactionless" or "nearly reactionless" before it.
fn title(noun: &str, is_reactionless: bool) -> String {
    format!("{}reactionless {noun}", if is_reactionless { "" } else { "nearly " })
}

/// What is to be outlined.
#[derive(Clone, Debug, PartialEq)]
pub enum OutlineSubject {
    /// The workspace of a pose space for constant b.
    Held(Shared<PoseSpace>),
    /// What rays reach at zero momentum, and beyond if the base floats.
    Turns(Shared<Rays>, bool),
}

/// An outline.
#[derive(Clone, Debug)]
pub enum Outlined {
    /// The workspace for constant b.
    Held(Arc<Workspace>),
    /// What rays reach at zero momentum and beyond.
    Turns(Arc<TurnAreas>),
}

/// Query for the outline of what the end effector reaches.
#[derive(Debug)]
pub struct OutlineQuery(OutlineSubject);

impl Query for OutlineQuery {
    type Input = OutlineSubject;
    /// `None` if the workspace is a single point.
    type Answer = Option<Outlined>;

    fn begin(subject: Self::Input) -> Self {
        Self(subject)
    }

    fn go_on(&mut self, goes_on: ProgressCallback<'_>) -> Portion<Self::Answer> {
        let mut stopped = false;
        let mut watched = |share: f64| {
            stopped = !goes_on(share);
            !stopped
        };
        let outline = match &self.0 {
            OutlineSubject::Held(space) => {
                Workspace::outlined(&space.0, &mut watched).map(|known| Outlined::Held(Arc::new(known)))
            }
            OutlineSubject::Turns(rays, floats) => {
                TurnAreas::of(&rays.0, *floats, &mut watched).map(|known| Outlined::Turns(Arc::new(known)))
            }
        };
        if stopped { Portion::Stopped } else { Portion::Done(outline) }
    }
}

/// Parts of the stage that a drawing of the workspace needs.
#[derive(Clone, Copy, Debug)]
pub struct WorkspaceParts {
    /// Index of the mesh that fills the workspace.
    pub fill: Option<usize>,
    /// Pose constant b of the workspace for comparison, rad.
    pub compared_b: Option<f64>,
}

impl Workspace {
    /// Returns the workspace of a machine with planes, which is known in closed form; `None` for other machines.
    pub fn known(space: &Arc<PoseSpace>) -> Option<Self> {
        let planes = space.planes().ok()?;
        let boundary = planes.boundary();
        let shape: Vec<Vec<Vector>> = boundary.turned(0.0).iter().map(|line| vectors(line)).collect();
        let drawn = |lines: &mut dyn Iterator<Item = &BoundaryLine>| -> Strips {
            lines
                .map(|line| {
                    let mut points = vectors(&line.turned(0.0));
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
        Some(Self {
            boundary: shape.iter().map(closed).collect(),
            words: [title("workspace", space.is_reactionless()), format!("{:.3} m²", boundary.area())],
            middle: roomiest_of_planes(planes, &shape),
            ends: Vec::new(),
            inside: Inside::Sheets(Sheets {
                folds: drawn(&mut boundary.fold_curves().iter()),
                limits: drawn(&mut boundary.inner_limits().iter()),
                change_points: drawn(&mut boundary.change_curves().iter().map(|curve| &curve.line)),
                cusps: boundary.cusps().iter().map(|v| v.at).collect(),
                dexterity: Default::default(),
                planes: planes.clone(),
            }),
            shape,
            space: space.clone(),
        })
    }

    /// Computes the workspace of any other machine with a pose constant. `goes_on` is called with the completed
    /// fraction. Returns `None` if the workspace is a single point, or if `goes_on` returns false.
    fn outlined(space: &Arc<PoseSpace>, goes_on: ProgressCallback<'_>) -> Option<Self> {
        let outline = space.outline_within(0.0, CHORD_TOLERANCE, goes_on)?;
        let curve = vectors(&outline.curve);
        let (lines, words, middle) = if curve.len() > 1 {
            let words = [title("curve", space.is_reactionless()), format!("{:.3} m", outline.length)];
            (vec![flat(&curve)], words, curve[curve.len() / 2])
        } else {
            let closed = |line: &Vec<[f64; 2]>| {
                let mut points = flat(&vectors(line));
                points.extend(points.first().copied());
                points
            };
            let words = [title("workspace", space.is_reactionless()), format!("{:.3} m²", outline.area)];
            let middle = roomiest(&outline.loops, outline.extent, 0.35 * space.farthest());
            (outline.loops.iter().map(closed).collect(), words, middle)
        };
        let named = |(end, at): (usize, &Vector)| {
            let angle = space.joints().first()?.bounds()[end];
            angle.is_finite().then(|| (*at, format!("a₁ = {:.1}°", angle.to_degrees())))
        };
        let ends = [curve.first(), curve.last()].into_iter().flatten().filter(|_| curve.len() > 1);
        let ends = ends.enumerate().filter_map(named).collect();
        let there_and_back = |line: &Vec<[f32; 3]>| {
            let mut line: Vec<Vector> =
                line.iter().map(|[x, y, _]| Vector::new(f64::from(*x), f64::from(*y))).collect();
            if curve.len() > 1 {
                let back: Vec<_> = line.iter().rev().skip(1).copied().collect();
                line.extend(back);
            }
            line
        };
        (!lines.is_empty()).then(|| Self {
            shape: lines.iter().map(there_and_back).collect(),
            boundary: lines.into(),
            words,
            middle: Some(middle),
            ends,
            inside: Inside::Filled(Arc::new(fill::mesh(&outline.loops))),
            space: space.clone(),
        })
    }

    /// Pose space of the workspace.
    pub fn space(&self) -> &PoseSpace {
        &self.space
    }

    /// Boundary at b = 0 as closed lines, m; a curve is traversed forwards and backwards.
    pub fn shape(&self) -> &[Vec<Vector>] {
        &self.shape
    }

    /// Returns what it is at b = 0: the boundary of a region, or a curve, m.
    pub fn lines(&self) -> Lines {
        let bounds = self.sheets().is_some() || self.fill().is_some();
        let line = |line: &Vec<Vector>| match bounds {
            true => line.iter().chain(line.first()).copied().collect(),
            // A curve is traversed forwards and backwards.
            false => line[..line.len().div_ceil(2)].to_vec(),
        };
        Lines { lines: self.shape.iter().map(line).collect(), bounds }
    }

    /// Returns the triangles that fill it at b = 0; `None` for sheets and curves.
    pub fn fill(&self) -> Option<&Mesh> {
        match &self.inside {
            Inside::Filled(mesh) if !mesh.triangles.is_empty() => Some(mesh),
            _ => None,
        }
    }

    /// Returns the planes, if the machine has any.
    pub fn planes(&self) -> Option<&Planes> {
        self.sheets().map(|sheets| &*sheets.planes)
    }

    fn sheets(&self) -> Option<&Sheets> {
        match &self.inside {
            Inside::Sheets(sheets) => Some(sheets),
            Inside::Filled(_) => None,
        }
    }

    /// Rotation of the workspace for a b and a pose of the base, rad.
    fn turn(&self, b: f64, base: Pose2) -> f64 {
        self.space.turn(b) + base.angle
    }

    /// Returns its drawn boundary at height `z`, m.
    pub fn edge(&self, shown: &DrawnFrame<'_>, z: f64) -> Polyline {
        let line = Polyline::new("workspace/boundary", self.boundary.clone(), 1.8, [0.0; 4]);
        line.moving(posed(shown.base.at, unit(self.turn(shown.frame.b_reference, shown.base)), z))
    }

    /// Returns the ends of the colour scale of a measure of dexterity; `None` for machines without planes.
    pub fn shaded(&self, measure: Measure) -> Option<[f64; 2]> {
        let sheets = self.sheets()?;
        Some(*sheets.dexterity[measure as usize].get_or_init(|| measure.range(sheets.planes.map())))
    }

    /// Returns points of its boundary for a b and the base of a frame, m.
    pub fn points(&self, b: f64, frame: &Frame) -> Vec<Vector> {
        if let Some(sheets) = self.sheets() {
            let on_base = |[x, y]: [f64; 2]| frame.base.at + unit(frame.base.angle) * Vector::new(x, y);
            return sheets.planes.boundary().turned(b).into_iter().flatten().step_by(4).map(on_base).collect();
        }
        let turn = unit(self.turn(b, frame.base));
        let all = self.boundary.iter().flatten();
        all.map(|[x, y, _]| frame.base.at + turn * Vector::new(f64::from(*x), f64::from(*y))).collect()
    }

    /// Draws the workspace for comparison, the workspace of the frame with its fill, and the previewed one.
    pub fn draw(
        &self,
        scene: &mut Scene,
        linkage: &LinkageModel,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        options: &ViewOptions,
        parts: WorkspaceParts,
    ) {
        let WorkspaceParts { fill, compared_b } = parts;
        let floor = linkage.floor();
        if let Some(b) = compared_b.filter(|_| options.compares) {
            self.compared(scene, palette, b, shown.base, floor - 2.0 * FILL_DEPTH * linkage.reach());
        }
        self.fill_own(scene, linkage, fill, palette, shown, options);
        self.own(scene, palette, shown, options, floor);
        if let (Some(b), Some(_)) = (options.preview_b, self.sheets()) {
            let pose = posed(Vector::default(), unit(self.space.turn(b)), floor);
            let outline = Polyline::new("workspace/preview", self.boundary.clone(), 1.2, faded(palette.amber, 0.8));
            scene.lines.push(Polyline { world_from_item: pose, ..outline.dashed(5.0, 4.0) });
        }
    }

    fn compared(&self, scene: &mut Scene, palette: &Palette, b: f64, base: Pose2, z: f64) {
        let turn = self.turn(b, base);
        if let Some(sheets) = self.sheets() {
            let colour = faded(palette.dim, 0.08);
            scene.areas.push(area(sheets.planes.map(), turn, base.at, "workspace/compared", z, colour));
        }
        let name = "workspace/compared/boundary";
        let edge = Polyline::new(name, self.boundary.clone(), 1.2, faded(palette.dim, 0.55)).dashed(5.0, 4.0);
        scene.lines.push(edge.moving(posed(base.at, unit(turn), z)));
        if let Some(middle) = self.middle {
            let at = point(base.at + middle * unit(turn), z);
            let text = format!("b = {b:.3} rad");
            let name = "workspace/compared/label";
            scene.labels.push(Label::new(name, at, [0.0, 0.0], text, palette.dim, 11.5, Anchor::Centre));
        }
    }

    fn fill_own(
        &self,
        scene: &mut Scene,
        linkage: &LinkageModel,
        fill: Option<usize>,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        options: &ViewOptions,
    ) {
        let (turn, z) = (self.turn(shown.frame.b_reference, shown.base), linkage.floor());
        let Some(sheets) = self.sheets() else {
            // The fill is below all lines.
            let below = posed(shown.base.at, unit(turn), z - FILL_DEPTH * linkage.reach());
            scene.solids.extend(fill.map(|mesh| Solid {
                name: "workspace".into(),
                mesh,
                world_from_item: below,
                colour: faded(palette.amber, FILL_OPACITY),
                changes: ItemChanges::Pose,
            }));
            return;
        };
        let mut area =
            area(sheets.planes.map(), turn, shown.base.at, "workspace", z, faded(palette.amber, FILL_OPACITY));
        if let Some((measure, [low, high])) = options.dexterity.and_then(|m| Some((m, self.shaded(m)?))) {
            // Colour scale from the minimum to the maximum of the measure.
            let [least, most] = dexterity::colours(palette);
            let (empty, full) = (low as f32, high as f32);
            (area.colour, area.shade) = (least, Some(Shade { measure, colour: most, empty, full }));
        }
        scene.areas.push(area);
    }

    fn own(&self, scene: &mut Scene, palette: &Palette, shown: &DrawnFrame<'_>, options: &ViewOptions, z: f64) {
        let (b, base) = (shown.frame.b_reference, shown.base);
        let turn = unit(self.turn(b, base));
        let pose = posed(base.at, turn, z);
        let mut line = |name: &'static str, strips: &Strips, width, colour, dash: Option<[f32; 2]>| {
            if !strips.is_empty() {
                scene.lines.push(Polyline { dash, ..Polyline::new(name, strips.clone(), width, colour).moving(pose) });
            }
        };
        let width = if options.highlighted == Some(Handle::Boundary) { 3.0 } else { 1.8 };
        line("workspace/boundary", &self.boundary, width, palette.amber, None);
        let there = |p: Vector| point(base.at + p * turn, z);
        if let Some(sheets) = self.sheets() {
            line("workspace/folds", &sheets.folds, 1.2, palette.amber, None);
            line("workspace/inner_limits", &sheets.limits, 1.2, faded(palette.amber, 0.55), None);
            line("workspace/change_points", &sheets.change_points, 1.2, faded(palette.dim, 0.8), Some([2.0, 4.0]));
            let cusps = sheets.cusps.iter();
            let cusps = cusps.map(|cusp| Marker::disc("workspace/cusps", there(*cusp), 2.5, palette.amber));
            scene.markers.extend(cusps);
        }
        for (end, words) in &self.ends {
            scene.markers.push(Marker::disc("workspace/ends", there(*end), 3.5, palette.amber));
            let (name, offset) = ("workspace/ends/names", [0.0, 14.0]);
            scene.labels.push(Label::new(name, there(*end), offset, words, palette.dim, 11.5, Anchor::Centre));
        }
        let Some(middle) = self.middle else { return };
        let [what, size] = &self.words;
        let rows = [(what.clone(), palette.amber, 12.5), (format!("b = {b:.3} rad · {size}"), palette.dim, 11.5)];
        let raised = LABEL_OFFSETS_PT[usize::from(self.sheets().is_none())];
        for (i, (text, colour, size)) in rows.into_iter().enumerate() {
            let offset = [0.0, raised + 17.0 * i as f32];
            let name = "workspace/label";
            scene.labels.push(Label::new(name, there(middle), offset, text, colour, size, Anchor::Centre));
        }
    }
}

fn vectors(points: &[[f64; 2]]) -> Vec<Vector> {
    points.iter().map(|[x, y]| Vector::new(*x, *y)).collect()
}

fn flat(points: &[Vector]) -> Vec<[f32; 3]> {
    points.iter().map(|p| point(*p, 0.0)).collect()
}

/// Returns the workspace of a map, rotated by `turn`, rad, shifted to `at`, m, at height `z`, m.
fn area(map: &PlaneMap, turn: f64, at: Vector, name: impl Into<Name>, z: f64, colour: Rgba) -> Area {
    let limits = map.limits();
    Area {
        name: name.into(),
        c: map.c().map(|x| x as f32),
        u: map.u().map(|u| u.map(|x| x as f32)),
        v: map.v().map(|x| x as f32),
        a_min: limits.map(|l| l.min as f32),
        a_max: limits.map(|l| l.max as f32),
        // Whole turns are subtracted in f64, before precision is lost in f32.
        turn: turn.rem_euclid(TAU) as f32,
        at: [at.re as f32, at.im as f32],
        z: z as f32,
        world_from_plane: IN_PLACE,
        colour,
        shade: None,
    }
}

/// Returns the point of a grid in the workspace that is farthest from its boundary, m, outside a circle about the base.
fn roomiest_of_planes(planes: &Planes, boundary: &[Vec<Vector>]) -> Option<Vector> {
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

/// Returns the point of a coarse grid inside the loops that is farthest from them, m, outside the circle of radius
/// `root` about the base.
fn roomiest(loops: &[Vec<[f64; 2]>], [x_min, x_max, y_min, y_max]: [f64; 4], root: f64) -> Vector {
    const GRID_CELLS: i32 = 16;
    /// Maximum number of vertices of a loop that are used.
    const MAX_VERTICES: usize = 240;
    let thin = |line: &Vec<[f64; 2]>| -> Vec<[f64; 2]> {
        line.iter().step_by(line.len().div_ceil(MAX_VERTICES).max(1)).copied().collect()
    };
    let loops: Vec<Vec<[f64; 2]>> = loops.iter().map(thin).collect();
    let at = |i: i32, low: f64, high: f64| low + (high - low) * (f64::from(i) + 0.5) / f64::from(GRID_CELLS);
    let points = (0..GRID_CELLS * GRID_CELLS)
        .map(|k| Vector::new(at(k % GRID_CELLS, x_min, x_max), at(k / GRID_CELLS, y_min, y_max)));
    // Even-odd rule.
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
