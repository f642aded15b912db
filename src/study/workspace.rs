//! [`WorkspaceReport`]: boundary, area and interior curves of the reactionless workspace at a b, and given points.

use schemars::JsonSchema;
use serde::Serialize;

use super::pose_measures::PoseMeasures;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_planning::pose_space::{Outline, Planes, PoseSpace};
use stillbase_planning::reactionless::{Boundary, ChangeCurve, DRIVE_PAIRS, PlaneMap};

/// Region that the end effector reaches at constant b.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct WorkspaceReport {
    /// Area, m²; 0 if the workspace is a curve.
    pub area: f64,
    /// ∫|det|, m²: larger than the area if several poses reach one point. Only for three drives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sheet_area: Option<f64>,
    /// Length of the curve, m. Only for machines without closed-form planes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Smallest x, m.
    pub x_min: f64,
    /// Largest x, m.
    pub x_max: f64,
    /// Smallest y, m.
    pub y_min: f64,
    /// Largest y, m.
    pub y_max: f64,
    /// Boundary loops, m: outer loops run counter-clockwise.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// The curve that two drives reach, m. Only for machines without closed-form planes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curve: Option<Vec<[f64; 2]>>,
    /// Curves and areas inside the workspace. Only for three drives.
    #[serde(flatten)]
    pub inside: Option<WorkspaceInterior>,
    /// Points of the request.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<PointInWorkspace>,
}

/// Curves and areas inside the workspace of three drives.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct WorkspaceInterior {
    /// Whether a fold runs through the interior.
    pub interior_singularity: bool,
    /// Maximum number of poses at one point.
    pub sheets: usize,
    /// Areas reached by at least 1, 2, 3, … poses, m².
    pub areas_by_poses: Vec<f64>,
    /// Folds, where two poses meet, m.
    pub fold_curves: Vec<Vec<[f64; 2]>>,
    /// Cusps, where folds turn back, m.
    pub cusps: Vec<[f64; 2]>,
    /// Joint limits in the interior, m.
    pub inner_limits: Vec<Vec<[f64; 2]>>,
    /// Change points, where the linkage becomes flat.
    pub change_point_curves: Vec<ChangePointCurve>,
    /// Parts of the workspace on both sides of the change points.
    pub areas_by_side: Vec<AreaOfSide>,
}

/// Curve of change points of two drives.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct ChangePointCurve {
    /// The two drives, from 1.
    pub pair: [usize; 2],
    /// q_l − q_k, in multiples of π.
    pub half_turns: i32,
    /// Points of the curve, m.
    pub line: Vec<[f64; 2]>,
}

/// Part of the workspace that poses with `half_turns` π ≤ q_l − q_k ≤ (`half_turns` + 1) π reach.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct AreaOfSide {
    /// The two drives, from 1.
    pub pair: [usize; 2],
    /// Lower bound of q_l − q_k, in multiples of π.
    pub half_turns: i32,
    /// Area, m².
    pub area: f64,
    /// ∫|det|, m².
    pub sheet_area: f64,
}

/// A point, and the poses that reach it.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PointInWorkspace {
    /// The point, m.
    pub point: [f64; 2],
    /// Distance from the boundary, negative outside, or from the curve, m.
    pub distance: f64,
    /// Poses that reach the point.
    pub poses: Vec<PoseMeasures>,
}

impl WorkspaceReport {
    /// Returns the workspace of a machine at b, rad, with an entry for each of the given points, m; `None` if the joint
    /// limits permit no pose.
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
            inside: Some(WorkspaceInterior::of(planes, b)),
            points,
        }
    }
}

impl WorkspaceInterior {
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
            sheets: boundary.max_pose_count(),
            areas_by_poses: boundary.areas_by_poses(),
            fold_curves: boundary.fold_curves().iter().map(|l| l.turned(turn)).collect(),
            cusps: boundary.cusps().iter().map(|c| cusp(c.at)).collect(),
            inner_limits: boundary.inner_limits().iter().map(|l| l.turned(turn)).collect(),
            areas_by_side: sides(map, boundary, &changes),
            change_point_curves: changes.iter().map(change).collect(),
        }
    }
}

/// Returns the two drives of a pair, counted from 1.
fn drives(pair: usize) -> [usize; 2] {
    DRIVE_PAIRS[pair].map(|k| k + 1)
}

/// Returns the parts into which change points divide the workspace, for each pair of drives that has any inside.
fn sides(map: &PlaneMap, boundary: &Boundary, changes: &[ChangeCurve]) -> Vec<AreaOfSide> {
    let divided = (0..DRIVE_PAIRS.len()).filter(|&pair| changes.iter().any(|c| c.pair == pair));
    let part = |(pair, half_turns): (usize, i32)| {
        let mut sides = [None; 3];
        sides[pair] = Some(half_turns);
        let part = Boundary::on_sides(map, sides)?;
        Some(AreaOfSide { pair: drives(pair), half_turns, area: part.area(), sheet_area: part.sheet_area() })
    };
    divided.flat_map(|pair| boundary.sides(pair).map(move |m| (pair, m))).filter_map(part).collect()
}
