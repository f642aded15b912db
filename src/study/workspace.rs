//! [`WorkspaceReport`]: the reactionless workspace of a b: its boundary and area, what lies inside, and points in it.

use serde::Serialize;

use super::pose_measures::PoseMeasures;
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::{Vector, unit};
use crate::planning::pose_space::{Outline, Planes, PoseSpace};
use crate::planning::reactionless::{Boundary, ChangeCurve, PAIRS, PlaneMap};

/// What the end effector reaches while b is held.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorkspaceReport {
    /// m²; 0 of a curve.
    pub area: f64,
    /// ∫|det|, m²: more than the area where several poses reach one point; of three drives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sheet_area: Option<f64>,
    /// Of the curve, m; of other numbers of drives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// m.
    pub x_min: f64,
    /// m.
    pub x_max: f64,
    /// m.
    pub y_min: f64,
    /// m.
    pub y_max: f64,
    /// The boundary, m: outer loops run counter-clockwise.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// The curve of two drives, m; of other numbers of drives than three.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curve: Option<Vec<[f64; 2]>>,
    /// What lies inside; of three drives.
    #[serde(flatten)]
    pub inside: Option<Inside>,
    /// Points that were asked about.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<PointInWorkspace>,
}

/// What lies inside the workspace of three drives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inside {
    /// Whether a fold runs through it.
    pub interior_singularity: bool,
    /// The most poses of a point.
    pub sheets: usize,
    /// Area that so many poses reach, from one on, m².
    pub areas_by_poses: Vec<f64>,
    /// Where two poses meet, m.
    pub fold_curves: Vec<Vec<[f64; 2]>>,
    /// Where folds turn back, m.
    pub cusps: Vec<[f64; 2]>,
    /// Joint limits inside, m.
    pub inner_limits: Vec<Vec<[f64; 2]>>,
    /// Where the linkage goes flat.
    pub change_point_curves: Vec<ChangePointCurve>,
    /// The parts on both sides of these.
    pub areas_by_side: Vec<AreaOfSide>,
}

/// Change points of two drives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChangePointCurve {
    /// The drives, counted from 1.
    pub pair: [usize; 2],
    /// q_l − q_k, in half turns.
    pub half_turns: i32,
    /// m.
    pub line: Vec<[f64; 2]>,
}

/// What poses with `half_turns` π ≤ q_l − q_k ≤ (`half_turns` + 1) π reach.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AreaOfSide {
    /// The drives, counted from 1.
    pub pair: [usize; 2],
    /// From where on.
    pub half_turns: i32,
    /// m².
    pub area: f64,
    /// ∫|det|, m².
    pub sheet_area: f64,
}

/// A point, and how the machine takes it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointInWorkspace {
    /// m.
    pub point: [f64; 2],
    /// From the boundary, negative outside, or from the curve, m.
    pub distance: f64,
    /// Its poses.
    pub poses: Vec<PoseMeasures>,
}

impl WorkspaceReport {
    /// Of a machine with its pose space at b, rad, with points that are asked about, m; none where the joint limits leave
    /// no pose.
    pub fn of(machine: &Machine, space: &PoseSpace, b: f64, points: &[Vector]) -> Option<Self> {
        let located = |distance: &dyn Fn(Vector) -> f64| {
            let one = |p: &Vector| PointInWorkspace {
                point: [p.re, p.im],
                distance: distance(*p),
                poses: PoseMeasures::all(machine, space, *p, b),
            };
            points.iter().map(one).collect()
        };
        match space.planes() {
            Ok(planes) => {
                let boundary = planes.boundary();
                Some(Self::on_planes(planes, b, located(&|p| boundary.distance(p, b))))
            }
            Err(_) => {
                let outline = space.outline(b);
                let points = located(&|p| outline.distance(p));
                let Outline { area, length, extent: [x_min, x_max, y_min, y_max], loops, curve } = outline;
                (!(loops.is_empty() && curve.is_empty())).then_some(Self {
                    area,
                    sheet_area: None,
                    length: Some(length),
                    x_min,
                    x_max,
                    y_min,
                    y_max,
                    loops,
                    curve: Some(curve),
                    inside: None,
                    points,
                })
            }
        }
    }

    fn on_planes(planes: &Planes, b: f64, points: Vec<PointInWorkspace>) -> Self {
        let boundary = planes.boundary();
        let extent = boundary.extent(b);
        Self {
            area: boundary.area(),
            sheet_area: Some(boundary.sheet_area()),
            length: None,
            x_min: extent.x_min,
            x_max: extent.x_max,
            y_min: extent.y_min,
            y_max: extent.y_max,
            loops: boundary.turned(b),
            curve: None,
            inside: Some(Inside::of(planes, b)),
            points,
        }
    }
}

impl Inside {
    fn of(planes: &Planes, b: f64) -> Self {
        let (map, boundary) = (planes.map(), planes.boundary());
        let turn = map.turn(b);
        let changes = boundary.change_curves();
        let cusp = |at: Vector| {
            let p = at * unit(turn);
            [p.re, p.im]
        };
        let change = |c: &ChangeCurve| ChangePointCurve {
            pair: drives(c.pair),
            half_turns: c.half_turns,
            line: c.line.turned(turn),
        };
        Self {
            interior_singularity: boundary.interior_singularity(),
            sheets: boundary.sheets(),
            areas_by_poses: boundary.areas_by_poses(),
            fold_curves: boundary.fold_curves().iter().map(|l| l.turned(turn)).collect(),
            cusps: boundary.cusps().iter().map(|c| cusp(c.at)).collect(),
            inner_limits: boundary.inner_limits().iter().map(|l| l.turned(turn)).collect(),
            areas_by_side: sides(map, boundary, &changes),
            change_point_curves: changes.iter().map(change).collect(),
        }
    }
}

/// Drives as people count them.
fn drives(pair: usize) -> [usize; 2] {
    PAIRS[pair].map(|k| k + 1)
}

/// The parts on the sides of each pair that has change points inside.
fn sides(map: &PlaneMap, boundary: &Boundary, changes: &[ChangeCurve]) -> Vec<AreaOfSide> {
    let divided = (0..PAIRS.len()).filter(|&pair| changes.iter().any(|c| c.pair == pair));
    let part = |(pair, half_turns): (usize, i32)| {
        let mut sides = [None; 3];
        sides[pair] = Some(half_turns);
        let part = Boundary::on_sides(map, sides)?;
        Some(AreaOfSide { pair: drives(pair), half_turns, area: part.area(), sheet_area: part.sheet_area() })
    };
    divided.flat_map(|pair| boundary.sides(pair).map(move |m| (pair, m))).filter_map(part).collect()
}
