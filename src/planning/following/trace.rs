//! Curves of the end effector followed on a plane b = const, continuously and on one sheet, or the reason why not.
//!
//! Source: (15), (16). On a sheet, where det ∂(x, y)/∂(a_1, a_2) keeps its sign, each point has one pose that continues
//! the last one; a curve is reactionless if and only if it can be followed so.

mod remedy;
mod track;

use thiserror::Error;

use crate::mechanics::planar::{Vector, unit};
use crate::planning::curves::curve::Curve;
use crate::planning::curves::table::Table;
use crate::planning::reactionless::{BSet, Decimal, PAIRS, PlaneMap};
use remedy::blocked;
use track::Track;

/// What ends a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// A relative angle at its limit.
    Limit {
        /// Which angle: 0 for a_1, 1 for a_2.
        angle: usize,
        /// At its greatest value, else at its least.
        upper: bool,
    },
    /// det = 0: two poses meet and vanish.
    Fold,
    /// Two drives parallel, where pins would bear unbounded forces; only if the path is to keep off it.
    ChangePoint {
        /// The drives, counted from 0.
        drives: [usize; 2],
    },
    /// The curve's first point has no pose on this plane.
    Start,
}

/// A curve that cannot be followed on its plane.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}", self.in_words())]
pub struct Blocked {
    /// b, rad.
    pub b: f64,
    /// How far along the whole curve, 0 to 1 by length.
    pub s: f64,
    /// The first point that cannot be passed, m.
    pub at: Vector,
    /// What stops it there.
    pub stop: Stop,
    /// Whether no pose of this plane reaches the curve just beyond: it leaves the workspace, not only the sheet.
    pub leaves_workspace: bool,
    /// The pose constant nearest to b at which the whole curve can be followed, rad.
    pub nearest_b: Option<f64>,
    /// The same as it is shown: rounded to where the curve can still be followed.
    pub shown_b: Option<Decimal>,
    /// Whether some b reaches each single point of the curve, if not the curve as a whole.
    pub some_b_reaches_all: bool,
    /// From where to where the longest part runs that can be followed on this plane, 0 to 1 by length; one of less than
    /// 0.6 % may be missed.
    pub longest: Option<[f64; 2]>,
    /// The whole curve, m, to be drawn.
    pub curve: Vec<Vector>,
}

impl std::fmt::Display for Stop {
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

impl Blocked {
    fn in_words(&self) -> String {
        let where_to = if self.leaves_workspace { ", the boundary of the reactionless workspace" } else { "" };
        let remedy = match (self.shown_b, self.some_b_reaches_all) {
            (Some(b), _) => format!("b = {b} rad would do"),
            (None, false) => "no b reaches all of it".into(),
            (None, true) => "each point has a b in common with the others, but no b lets it be followed".into(),
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

/// What a followed path must keep to besides its sheet and the limits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rule {
    /// Keeps sin(q_k − q_l) from changing sign for every pair of drives.
    pub keep_off_change_points: bool,
}

impl Rule {
    fn keeps_side(self, map: &PlaneMap, from: [f64; 2], to: [f64; 2]) -> bool {
        !self.keep_off_change_points || crossed(map, from, to).is_none()
    }
}

/// The pair of drives that becomes parallel between two poses, counted from 0.
fn crossed(map: &PlaneMap, from: [f64; 2], to: [f64; 2]) -> Option<[usize; 2]> {
    let (x, y) = (map.sines(from), map.sines(to));
    PAIRS.into_iter().zip(x.into_iter().zip(y)).find(|(_, (x, y))| x * y < 0.0).map(|(pair, _)| pair)
}

/// Stations at which a curve is tried for other b, or for its longest part.
const STATIONS: usize = 96;

/// How far a curve can be followed: to which s, to which pose, and what stops it there.
pub type Halt = (f64, [f64; 2], Stop);

/// Poses on a plane along a curve, from a pose at its start.
///
/// # Errors
/// How far it gets, the last pose, and what stops it.
pub fn walk(
    map: &PlaneMap,
    curve: &Curve,
    b: f64,
    start: [f64; 2],
    rule: Rule,
    stations: usize,
) -> Result<[f64; 2], Halt> {
    let track = Track { map, b, turn: unit(-map.turn(b)), curve, rule };
    let mut a = start;
    for i in 0..stations {
        let s = |i: usize| i as f64 / stations as f64;
        a = track.advance(a, s(i), s(i + 1))?;
    }
    Ok(a)
}

/// Follows curves that join end to end on the plane b: a table of nodes for each. Of several poses at the start, the one
/// that can, nearest to `prefer`.
///
/// # Errors
/// Where it is stopped and by what, and what would help.
pub fn follow(
    map: &PlaneMap,
    curves: &[Curve],
    b: f64,
    prefer: Option<[f64; 2]>,
    rule: Rule,
) -> Result<Vec<Table>, Box<Blocked>> {
    let Some(first) = curves.first() else { return Ok(Vec::new()) };
    let mut farthest: Option<Halt> = None;
    for start in starts(map, first.at(0.0).p, b, prefer) {
        match tables(map, curves, b, start, rule) {
            Ok(tables) => return Ok(tables),
            Err(stopped) => {
                if farthest.is_none_or(|f| stopped.0 > f.0) {
                    farthest = Some(stopped);
                }
            }
        }
    }
    let (s, _, stop) = farthest.unwrap_or((0.0, [0.0; 2], Stop::Start));
    Err(Box::new(blocked(map, curves, b, rule, s, stop)))
}

/// The poses of a point on a plane, those nearest to a wish first.
fn starts(map: &PlaneMap, p: Vector, b: f64, prefer: Option<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut starts: Vec<[f64; 2]> = map.poses(p, b).iter().map(|x| x.a).collect();
    if let Some(wish) = prefer {
        let far = |a: &[f64; 2]| (a[0] - wish[0]).hypot(a[1] - wish[1]);
        starts.sort_by(|x, y| far(x).total_cmp(&far(y)));
    }
    starts
}

fn tables(map: &PlaneMap, curves: &[Curve], b: f64, start: [f64; 2], rule: Rule) -> Result<Vec<Table>, Halt> {
    let turn = unit(-map.turn(b));
    let mut a = start;
    let mut tables = Vec::with_capacity(curves.len());
    for (i, curve) in curves.iter().enumerate() {
        let track = Track { map, b, turn, curve, rule };
        let table = track.table(a).map_err(|(s, a, stop)| (whole(curves, i, s), a, stop))?;
        a = table.nodes().last().map_or(a, |last| map.project(&last.q).a);
        tables.push(table);
    }
    Ok(tables)
}

/// s over all curves, by length, of a place on one of them.
fn whole(curves: &[Curve], i: usize, s: f64) -> f64 {
    let length = |c: &Curve| c.length();
    let before: f64 = curves[..i].iter().map(length).sum();
    (before + s * curves[i].length()) / curves.iter().map(length).sum::<f64>()
}

/// The curve and its s, of an s over all of them.
pub fn part(curves: &[Curve], s: f64) -> (usize, f64) {
    let total: f64 = curves.iter().map(Curve::length).sum();
    let mut left = s * total;
    for (i, curve) in curves.iter().enumerate() {
        if left <= curve.length() || i + 1 == curves.len() {
            return (i, (left / curve.length()).clamp(0.0, 1.0));
        }
        left -= curve.length();
    }
    (0, 0.0)
}

fn at(curves: &[Curve], s: f64) -> Vector {
    let (i, s) = part(curves, s);
    curves[i].at(s).p
}

/// Whether curves can be followed on a plane from any pose at their start.
pub fn is_feasible(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule) -> bool {
    let Some(first) = curves.first() else { return true };
    let stations = (STATIONS / curves.len()).max(8);
    starts(map, first.at(0.0).p, b, None)
        .into_iter()
        .any(|start| curves.iter().try_fold(start, |a, curve| walk(map, curve, b, a, rule, stations).ok()).is_some())
}

/// The b that reach every single one of evenly spaced points of the curves.
pub fn common_b(map: &PlaneMap, curves: &[Curve], points: usize) -> BSet {
    let n = points.max(2) - 1;
    let sets: Option<Vec<BSet>> = (0..=n).map(|i| map.reach(at(curves, i as f64 / n as f64)).ok()).collect();
    sets.map_or(BSet { intervals: Vec::new(), period: map.period() }, |sets| BSet::overlap(&sets))
}
