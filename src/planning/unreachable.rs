//! Why points cannot be reached at a pose constant b, or have no b in common, and a correction.

use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use thiserror::Error;

use crate::reactionless::{Decimal, NoReach, metres};
use stillbase_mechanics::planar::Vector;

/// Why points cannot be reached at a given b, and which b would be feasible.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Unreachable {
    /// The point cannot be reached at any b.
    #[error("({}, {}) m: {reason}", metres(*.x, 3), metres(*.y, 3))]
    Anywhere {
        /// x of the point, m.
        x: f64,
        /// y of the point, m.
        y: f64,
        /// Why the point cannot be reached.
        #[source]
        reason: NoReach,
    },
    /// The point can be reached, but not at this b.
    #[error("({}, {}) m is outside the reactionless workspace of b = {b:.6} rad: want {feasible}", metres(*.x, 3), metres(*.y, 3))]
    OnThisPlane {
        /// x of the point, m.
        x: f64,
        /// y of the point, m.
        y: f64,
        /// The given b, rad.
        b: f64,
        /// The feasible b, in words.
        feasible: String,
        /// The feasible b nearest to the given one, rad.
        nearest_b: Option<f64>,
        /// `nearest_b` as displayed: rounded to a value that is still feasible.
        displayed_b: Option<Decimal>,
    },
    /// Each point can be reached at some b, but no single b reaches all of them.
    #[error("{}", .0.in_words(&|i| format!("point {}", i + 1)))]
    NoCommonPlane(NoCommonB),
}

/// Why points have no b in common, and a correction. Points are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoCommonB {
    /// The first two points that share no b; `None` if each pair shares one, but not all points at once.
    pub pair: Option<[usize; 2]>,
    /// The shortest move of one point after which all points share a b.
    pub correction: Option<PointCorrection>,
}

impl NoCommonB {
    /// Describes the reason and the correction in words; `name` returns the name of a point.
    pub fn in_words(&self, name: &dyn Fn(usize) -> String) -> String {
        let who = match self.pair {
            Some([i, j]) => format!("no b serves both {} and {}", name(i), name(j)),
            None => "each two points share some b, but no b serves all".into(),
        };
        let remedy = match self.correction {
            Some(PointCorrection { point, shown: Some(shown), .. }) => {
                let (point, RoundedCorrection { to: [x, y], b, .. }) = (name(point), shown);
                let distance = shown.distance();
                if shown.path_feasible {
                    format!("moving {point} by {distance} m to ({x}, {y}) m would do, at b = {b} rad")
                } else {
                    format!(
                        "moved by {distance} m to ({x}, {y}) m, {point} shares b = {b} rad with the others, but this path \
                         could still not be followed there: want another one"
                    )
                }
            }
            _ => "want points nearer to each other".into(),
        };
        format!("{who}, so no reactionless path joins them; {remedy}")
    }
}

/// A [`PointCorrection`] as displayed: rounded to numbers at which all points can still be reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundedCorrection {
    /// New place of the point, m.
    pub to: [Decimal; 2],
    /// The b that all points then share, rad.
    pub b: Decimal,
    /// Length of the move, m.
    pub length: f64,
    /// Whether the planned path is then feasible too.
    pub path_feasible: bool,
}

impl RoundedCorrection {
    /// Returns the new place of the point, m.
    pub fn point(&self) -> Vector {
        Vector::new(self.to[0].value(), self.to[1].value())
    }

    fn distance(&self) -> Decimal {
        Decimal::nearest(self.length, self.to[0].decimals())
    }
}

/// A move of one point after which all points have a b in common.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PointCorrection {
    /// Index of the point, counted from 0; serialised from 1.
    #[serde(serialize_with = "from_one")]
    pub point: usize,
    /// New place of the point, m.
    #[schemars(with = "[f64; 2]")]
    pub to: Vector,
    /// Length of the move, m.
    pub distance: f64,
    /// The b that all points then share, rad.
    pub b: f64,
    /// The move as displayed.
    #[serde(skip)]
    pub shown: Option<RoundedCorrection>,
}

fn from_one<S: Serializer>(point: &usize, serializer: S) -> Result<S::Ok, S::Error> {
    (point + 1).serialize(serializer)
}
