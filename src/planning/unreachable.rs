//! Why points are not on a plane, or have no b in common, and what would mend it.

use serde::{Serialize, Serializer};
use thiserror::Error;

use crate::mechanics::planar::Vector;
use crate::planning::reactionless::{Decimal, NoReach, metres};

/// Why a point is not on a plane, and what would do.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Unreachable {
    /// Not on any plane.
    #[error("({}, {}) m: {reason}", metres(*.x, 3), metres(*.y, 3))]
    Anywhere {
        /// m.
        x: f64,
        /// m.
        y: f64,
        /// Why no b reaches it.
        reason: NoReach,
    },
    /// Not on this plane.
    #[error("({}, {}) m is outside the reactionless workspace of b = {b:.6} rad: want {would_do}", metres(*.x, 3), metres(*.y, 3))]
    OnThisPlane {
        /// m.
        x: f64,
        /// m.
        y: f64,
        /// rad.
        b: f64,
        /// The b that would do, in words.
        would_do: String,
        /// The nearest of them to b, rad.
        nearest_b: Option<f64>,
        /// The same as it is shown: rounded to where it still does.
        shown_b: Option<Decimal>,
    },
    /// Each point on some plane, but no plane serves all.
    #[error("{}", .0.in_words(&|i| format!("point {}", i + 1)))]
    NoCommonPlane(NoCommon),
}

/// Why points have no b in common, and what would mend it. Points are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoCommon {
    /// The first two that share no b; none if all do in pairs, but not all at once.
    pub pair: Option<[usize; 2]>,
    /// The least move of one point that would mend it.
    pub mend: Option<Mend>,
}

impl NoCommon {
    /// In words, with a name for each point.
    pub fn in_words(&self, name: &dyn Fn(usize) -> String) -> String {
        let who = match self.pair {
            Some([i, j]) => format!("no b serves both {} and {}", name(i), name(j)),
            None => "each two points share some b, but no b serves all".into(),
        };
        let remedy = match self.mend {
            Some(Mend { point, shown: Some(shown), .. }) => {
                let (point, ShownMend { to: [x, y], b, .. }) = (name(point), shown);
                let distance = shown.distance();
                if shown.does {
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

/// A [`Mend`] as it is printed: rounded to numbers that still serve all points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownMend {
    /// Where the point would go, m.
    pub to: [Decimal; 2],
    /// The b that then serves all, rad.
    pub b: Decimal,
    /// How far the point would go, m.
    pub far: f64,
    /// Whether what is planned can then be done too.
    pub does: bool,
}

impl ShownMend {
    /// Where the point would go, m.
    pub fn point(&self) -> Vector {
        Vector::new(self.to[0].value(), self.to[1].value())
    }

    fn distance(&self) -> Decimal {
        Decimal::nearest(self.far, self.to[0].decimals())
    }
}

/// A move of one point after which all points have a b in common.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Mend {
    /// Number of the point, counted from 0; serialised from 1, as people count.
    #[serde(serialize_with = "from_one")]
    pub point: usize,
    /// Where it would go, m.
    pub to: Vector,
    /// How far, m.
    pub distance: f64,
    /// The b that then serves all, rad.
    pub b: f64,
    /// The same as it is printed.
    #[serde(skip)]
    pub shown: Option<ShownMend>,
}

fn from_one<S: Serializer>(point: &usize, serializer: S) -> Result<S::Ok, S::Error> {
    (point + 1).serialize(serializer)
}
