//! Conditions under which a curve is followed, and reasons why it stops.

use schemars::JsonSchema;
use serde::ser::{Serialize, Serializer};
use thiserror::Error;

use crate::reactionless::{DRIVE_PAIRS, Decimal, PlaneMap};
use stillbase_mechanics::planar::Vector;

/// Why a curve cannot be followed further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SheetEnd {
    /// A relative angle at its limit.
    Limit {
        /// Index of the angle: 0 for a_1, 1 for a_2.
        angle: usize,
        /// Whether it is at its upper limit, else at its lower.
        upper: bool,
    },
    /// det = 0: two poses meet and vanish.
    Fold,
    /// Two drives parallel, where pins would bear unbounded forces; only if the rule forbids it.
    ChangePoint {
        /// The drives, counted from 0.
        drives: [usize; 2],
    },
    /// The curve's first point has no pose on this plane.
    Start,
}

/// A curve that cannot be followed on its plane.
#[derive(Clone, Debug, PartialEq, Error, JsonSchema, serde::Serialize)]
#[error("{}", self.in_words())]
pub struct Blocked {
    /// b, rad.
    #[serde(skip)]
    pub b: f64,
    /// Place on the whole curve at which it stops, 0 to 1 by length.
    pub s: f64,
    /// The first point that cannot be passed, m.
    #[serde(rename = "point")]
    #[schemars(with = "[f64; 2]")]
    pub at: Vector,
    /// Reason why it stops there.
    #[serde(rename = "reason")]
    #[schemars(with = "String")]
    pub stop: SheetEnd,
    /// Whether no pose of this plane reaches the curve just beyond this point. The curve then leaves the workspace,
    /// not only the sheet.
    pub leaves_workspace: bool,
    /// The pose constant nearest to b at which the whole curve can be followed, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nearest_b: Option<f64>,
    /// `nearest_b` rounded for display, so that the curve can still be followed.
    #[serde(skip)]
    pub displayed_b: Option<Decimal>,
    /// Whether one b reaches every point of the curve, even if the curve cannot be followed at it.
    #[serde(skip)]
    pub some_b_reaches_all: bool,
    /// Interval of the longest part that can be followed on this plane, 0 to 1 by length; a part of less than 0.6 % may
    /// be missed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub longest: Option<[f64; 2]>,
    /// The whole curve, m, to be drawn.
    #[serde(skip)]
    pub curve: Vec<Vector>,
}

impl std::fmt::Display for SheetEnd {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Limit { angle, upper } => {
                write!(f, "a{} at its {} limit", angle + 1, if *upper { "upper" } else { "lower" })
            }
            Self::Fold => f.write_str("a fold, det = 0"),
            Self::ChangePoint { drives: [k, l] } => {
                write!(f, "a change point, drives {} and {} parallel", k + 1, l + 1)
            }
            Self::Start => f.write_str("no pose at its first point"),
        }
    }
}

/// Serialised as its description in words.
impl Serialize for SheetEnd {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Blocked {
    fn in_words(&self) -> String {
        let where_to = if self.leaves_workspace { ", the boundary of the reactionless workspace" } else { "" };
        let remedy = match (self.displayed_b, self.some_b_reaches_all) {
            (Some(b), _) => format!("b = {b} rad would do"),
            (None, false) => "no b reaches all of it".into(),
            (None, true) => "at some b every point of it can be reached, but at no b can it be followed".into(),
        };
        let part = match self.longest {
            Some([from, to]) if to - from > 1e-3 => {
                format!("; on this plane it can be followed from {:.1} to {:.1} %", 100.0 * from, 100.0 * to)
            }
            _ => String::new(),
        };
        format!(
            "the path stops at ({:.3}, {:.3}) m, {:.1} % along, at b = {:.4} rad: {}{where_to}; {remedy}{part}",
            self.at.re,
            self.at.im,
            100.0 * self.s,
            self.b,
            self.stop,
        )
    }
}

/// Additional condition on a followed path, besides its sheet and the limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rule {
    /// Keeps sin(q_k − q_l) from changing sign for every pair of drives.
    pub keep_off_change_points: bool,
}

impl Rule {
    pub(super) fn keeps_side(self, map: &PlaneMap, from: [f64; 2], to: [f64; 2]) -> bool {
        !self.keep_off_change_points || crossed(map, from, to).is_none()
    }
}

/// Returns the pair of drives that becomes parallel between two poses, counted from 0.
pub(super) fn crossed(map: &PlaneMap, from: [f64; 2], to: [f64; 2]) -> Option<[usize; 2]> {
    let (x, y) = (map.sines(from), map.sines(to));
    DRIVE_PAIRS.into_iter().zip(x.into_iter().zip(y)).find(|(_, (x, y))| x * y < 0.0).map(|(pair, _)| pair)
}

/// Where following a curve stops: s, the pose (a_1, a_2), rad, and the reason.
pub type TraceEnd = (f64, [f64; 2], SheetEnd);
