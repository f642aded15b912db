//! [`PoseCurves`]: q_1 against the pose constant b at which points are reached, Fig. 3 of the paper.

use stillbase_mechanics::planar::Vector;
use stillbase_planning::common::common_b_set;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::{PlaneMap, PlanePoint};

/// Points of a curve of q_1 against b.
const SAMPLES: usize = 400;

/// q_1 against b of points.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseCurves {
    /// For each point the branches of its self-motion, each a line of b and q_1, rad.
    pub of_points: Vec<Vec<Vec<[f64; 2]>>>,
    /// Intervals of b at which all points are reached, rad.
    pub common: Vec<[f64; 2]>,
}

impl PoseCurves {
    /// Returns the curves of points, m, shifted by whole periods to be nearest to b, rad.
    ///
    /// # Errors
    /// If the machine has no planes of three drives; the text gives the reason.
    pub fn of(space: &PoseSpace, points: &[Vector], near: f64) -> Result<Self, String> {
        let planes = space.planes().map_err(ToString::to_string)?;
        let map = planes.map();
        let branches = |p: &Vector| map.self_motion(*p, SAMPLES).iter().map(|line| lifted(map, line, near)).collect();
        let common = common_b_set(space, points).map_or_else(Vec::new, |set| set.shifted_near(near).intervals);
        Ok(Self { of_points: points.iter().map(branches).collect(), common })
    }
}

/// Returns b and q_1, rad, along a branch of a self-motion, shifted by whole periods so that its middle is nearest to a
/// b, rad.
pub fn lifted(map: &PlaneMap, branch: &[PlanePoint], near: f64) -> Vec<[f64; 2]> {
    let middle = branch.get(branch.len() / 2).map_or(0.0, |x| x.b);
    let lift = map.period() * ((near - middle) / map.period()).round();
    let point = |x: &PlanePoint| {
        let x = PlanePoint { b: x.b + lift, ..*x };
        [x.b, map.lift(x)[0]]
    };
    branch.iter().map(point).collect()
}
