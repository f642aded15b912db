//! Curves of the end effector followed on a plane b = const, continuously and on one sheet, or the reason why not.
//!
//! Source: (15), (16). On a sheet, where det ∂(x, y)/∂(a_1, a_2) keeps its sign, each point has one pose that continues
//! the last one; a curve is reactionless if and only if it can be followed so.

use thiserror::Error;

use super::curve::{Curve, CurvePoint};
use super::path::PathPoint;
use super::table::Table;
use crate::planar::{DriveAngles, PerDrive, Vector, cross, unit};
use crate::reactionless::{BSet, PlaneMap, PlanePoint, SLACK};

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
    /// Whether some b reaches each single point of the curve, if not the curve as a whole.
    pub some_b_reaches_all: bool,
    /// From where to where the longest part runs that can be followed on this plane, 0 to 1 by length.
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
        let remedy = match (self.nearest_b, self.some_b_reaches_all) {
            (Some(b), _) => format!("b = {b:.4} rad would do"),
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

/// The smallest advance along a curve before it counts as stopped.
const LEAST_STEP: f64 = 1e-11;
/// How far the pose may lie from where the tangent leads, rad: farther, the step is halved.
const ASTRAY: f64 = 0.02;
/// The nodes are dense enough when the quintics between them miss by no more than this, rad.
const MISS: f64 = 2e-11;
/// The most spaces between nodes on a piece of a curve.
const MOST_SPACES: usize = 512;
/// Stations at which a curve is tried for other b, or for its longest part.
const STATIONS: usize = 96;

/// Parts of a curve that is drawn.
const DRAWN: i32 = 160;

/// How far a curve can be followed: to which s, to which pose, and what stops it there.
pub type Halt = (f64, [f64; 2], Stop);

/// A curve on a plane.
#[derive(Clone, Copy)]
struct Track<'a> {
    map: &'a PlaneMap,
    b: f64,
    turn: Vector,
    curve: &'a Curve,
    rule: Rule,
}

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

impl Track<'_> {
    /// From the pose at one s to that at another.
    fn advance(&self, mut a: [f64; 2], from: f64, to: f64) -> Result<[f64; 2], Halt> {
        let (mut s, mut step) = (from, to - from);
        let mut tangent = self.jet(a, s).first;
        while s < to {
            let next = if s + step >= to { to } else { s + step };
            let ahead = [0, 1].map(|i| a[i] + (next - s) * tangent[i]);
            let found = self.map.follow(self.curve.at(next).p, self.b, a).filter(|x| self.keeps_side(a, *x));
            let near = |x: &[f64; 2]| {
                let step = (x[0] - a[0]).hypot(x[1] - a[1]);
                (x[0] - ahead[0]).hypot(x[1] - ahead[1]) <= ASTRAY + 0.25 * step
            };
            match found.filter(near) {
                Some(x) => {
                    (a, s) = (x, next);
                    tangent = self.jet(a, s).first;
                    step *= 2.0;
                }
                None if step > LEAST_STEP => step *= 0.5,
                None => return Err((s, a, self.stop(a, tangent))),
            }
        }
        Ok(a)
    }

    /// (a_1, a_2) with derivatives by s, for the pose at s: J a′ = p′, J a″ = p″ + Σ_k arm_k (u_k · a′)².
    fn jet(&self, a: [f64; 2], s: f64) -> Jet {
        let CurvePoint { first, second, .. } = self.curve.at(s);
        let arms = self.map.arms(a);
        let [c1, c2] = self.map.columns(&arms);
        let det = cross(c1, c2);
        let solve = |v: Vector| [cross(v, c2) / det, cross(c1, v) / det];
        let rate = solve(first * self.turn);
        let u = self.map.u();
        let bend: Vector = (0..3).map(|k| arms[k] * (u[k][0] * rate[0] + u[k][1] * rate[1]).powi(2)).sum();
        Jet { a, first: rate, second: solve(second * self.turn + bend) }
    }

    fn keeps_side(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        !self.rule.keep_off_change_points || self.crossed(from, to).is_none()
    }

    /// The pair of drives that becomes parallel between two poses.
    fn crossed(&self, from: [f64; 2], to: [f64; 2]) -> Option<[usize; 2]> {
        let q = [from, to].map(|a| self.map.lift(PlanePoint { a, b: 0.0 }));
        let side = |q: &[f64; 3], [k, l]: [usize; 2]| (q[k] - q[l]).sin();
        [[0, 1], [0, 2], [1, 2]].into_iter().find(|pair| side(&q[0], *pair) * side(&q[1], *pair) < 0.0)
    }

    /// What lies ahead of a pose that cannot be left along a tangent.
    fn stop(&self, a: [f64; 2], tangent: [f64; 2]) -> Stop {
        let length = tangent[0].hypot(tangent[1]);
        let ahead = [0, 1].map(|i| a[i] + 1e-5 * tangent[i] / length);
        if let (true, Some(drives)) = (self.rule.keep_off_change_points, self.crossed(a, ahead)) {
            return Stop::ChangePoint { drives };
        }
        let limits = self.map.limits();
        for (angle, limit) in limits.iter().enumerate() {
            let out = [(a[angle] - limit.min, false, -tangent[angle]), (limit.max - a[angle], true, tangent[angle])];
            for (room, upper, outwards) in out {
                if room < 1e-6 && outwards > 0.0 {
                    return Stop::Limit { angle, upper };
                }
            }
        }
        Stop::Fold
    }

    /// Nodes along the curve, dense enough for the quintics between them.
    fn table(&self, start: [f64; 2]) -> Result<Table, Halt> {
        let (mut stations, mut nodes) = (vec![0.0], vec![self.jet(start, 0.0)]);
        let joints: Vec<f64> = self.curve.joints().collect();
        for ends in joints.windows(2) {
            let mut spaces = 8;
            loop {
                let piece = self.piece([ends[0], ends[1]], nodes[nodes.len() - 1].a, spaces)?;
                if spaces >= MOST_SPACES || self.is_dense(&piece) {
                    piece.windows(2).try_for_each(|w| self.keeps_limits(w[0], w[1]))?;
                    stations.extend(piece.iter().skip(1).map(|(s, _)| *s));
                    nodes.extend(piece.into_iter().skip(1).map(|(_, jet)| jet));
                    break;
                }
                spaces *= 2;
            }
        }
        let lifted = nodes.iter().map(|jet| self.lifted(jet)).collect();
        let last = stations.len() - 1;
        stations[last] = 1.0;
        Table::new(stations, lifted).ok_or((0.0, start, Stop::Start))
    }

    /// Nodes on one piece of the curve, both ends included.
    fn piece(&self, [from, to]: [f64; 2], start: [f64; 2], spaces: usize) -> Result<Vec<(f64, Jet)>, Halt> {
        let station = |i: usize| if i == spaces { to } else { from + (to - from) * i as f64 / spaces as f64 };
        let mut nodes = Vec::with_capacity(spaces + 1);
        nodes.push((from, self.jet(start, from)));
        for i in 1..=spaces {
            let a = self.advance(nodes[i - 1].1.a, station(i - 1), station(i))?;
            nodes.push((station(i), self.jet(a, station(i))));
        }
        Ok(nodes)
    }

    /// Whether a point halfway between nodes lies where their quintic has it.
    fn is_dense(&self, piece: &[(f64, Jet)]) -> bool {
        piece.windows(2).all(|w| {
            let [(s, x), (t, y)] = [w[0], w[1]];
            let h = t - s;
            let middle = [0, 1].map(|i| {
                0.5 * (x.a[i] + y.a[i])
                    + 5.0 / 32.0 * h * (x.first[i] - y.first[i])
                    + h * h / 64.0 * (x.second[i] + y.second[i])
            });
            match self.map.follow(self.curve.at(0.5 * (s + t)).p, self.b, x.a) {
                Some(a) => (a[0] - middle[0]).abs().max((a[1] - middle[1]).abs()) < MISS,
                None => false,
            }
        })
    }

    /// Between two nodes an angle may turn back beyond its limit.
    fn keeps_limits(&self, (s, x): (f64, Jet), (t, y): (f64, Jet)) -> Result<(), Halt> {
        const LOOKS: i32 = 16;
        let limits = self.map.limits();
        for (i, limit) in limits.iter().enumerate() {
            if x.first[i] * y.first[i] >= 0.0 {
                continue;
            }
            let at = |u: f64| hermite([x.a[i], x.first[i], x.second[i]], [y.a[i], y.first[i], y.second[i]], t - s, u);
            let past = |u: f64| (at(u) - limit.max).max(limit.min - at(u));
            let looks = (1..LOOKS).map(|k| f64::from(k) / f64::from(LOOKS));
            let Some(mut bad) = looks.max_by(|u, v| past(*u).total_cmp(&past(*v))) else { continue };
            // The peak between the looks, to second order.
            let d = 1.0 / f64::from(LOOKS);
            let [before, here, after] = [past(bad - d), past(bad), past(bad + d)];
            let shift = 0.5 * d * (before - after) / (before - 2.0 * here + after);
            if shift.is_finite() && past(bad + shift) > here {
                bad += shift;
            }
            if past(bad) <= SLACK {
                continue;
            }
            let upper = at(bad) > limit.max;
            let mut good = 0.0;
            for _ in 0..50 {
                let middle = 0.5 * (good + bad);
                if past(middle) <= 0.0 { good = middle } else { bad = middle }
            }
            let end = s + (t - s) * good;
            let a = self.map.follow(self.curve.at(end).p, self.b, x.a).unwrap_or(x.a);
            return Err((end, a, Stop::Limit { angle: i, upper }));
        }
        Ok(())
    }

    fn lifted(&self, jet: &Jet) -> PathPoint {
        PathPoint {
            q: DriveAngles::from(self.map.lift(PlanePoint { a: jet.a, b: self.b })),
            first: PerDrive::from(self.map.lift_rates(jet.first, 0.0)),
            second: PerDrive::from(self.map.lift_rates(jet.second, 0.0)),
        }
    }
}

/// Plane coordinates with derivatives by s.
#[derive(Clone, Copy)]
struct Jet {
    a: [f64; 2],
    first: [f64; 2],
    second: [f64; 2],
}

/// The quintic through value and two derivatives at both ends of a space h, at the share u.
fn hermite(from: [f64; 3], to: [f64; 3], h: f64, u: f64) -> f64 {
    let (c1, c2) = (from[1] * h, 0.5 * from[2] * h * h);
    let (v, v1, v2) = (to[0] - from[0] - c1 - c2, to[1] * h - c1 - 2.0 * c2, to[2] * h * h - 2.0 * c2);
    let (c3, c4, c5) = (10.0 * v - 4.0 * v1 + 0.5 * v2, -15.0 * v + 7.0 * v1 - v2, 6.0 * v - 3.0 * v1 + 0.5 * v2);
    from[0] + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))))
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
fn part(curves: &[Curve], s: f64) -> (usize, f64) {
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

fn blocked(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule, s: f64, stop: Stop) -> Blocked {
    let common = common_b(map, curves, 2 * STATIONS + 1);
    let beyond = at(curves, if stop == Stop::Start { 0.0 } else { (s + 1e-6).min(1.0) });
    Blocked {
        b,
        s,
        at: at(curves, s),
        stop,
        leaves_workspace: map.poses(beyond, b).is_empty(),
        nearest_b: nearest_b(map, curves, b, rule, &common),
        some_b_reaches_all: !common.is_empty(),
        longest: longest(map, curves, b, rule),
        curve: (0..=DRAWN).map(|i| at(curves, f64::from(i) / f64::from(DRAWN))).collect(),
    }
}

/// The b nearest to a given one at which curves can be followed, among those that reach each point.
fn nearest_b(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule, common: &BSet) -> Option<f64> {
    const TRIES: usize = 24;
    let can = |b: f64| is_feasible(map, curves, b, rule);
    let mut tries: Vec<f64> = Vec::new();
    for [low, high] in common.near(b).intervals {
        // A hair inside, where rounding does not matter.
        let inset = (1e-7_f64).min(0.25 * (high - low));
        let (low, high) = (low + inset, high - inset);
        tries.extend((0..=TRIES).map(|i| low + (high - low) * i as f64 / TRIES as f64));
        tries.push(b.clamp(low, high));
    }
    tries.sort_by(|x, y| (x - b).abs().total_cmp(&(y - b).abs()));
    let found = tries.iter().position(|x| can(*x))?;
    let first = tries[found];
    let mut good = first;
    // Between it and the nearest one on the same side that does not do.
    let beside = tries[..found].iter().rev().copied().find(|x| (x - b) * (good - b) >= 0.0);
    if let Some(mut bad) = beside {
        for _ in 0..16 {
            let middle = 0.5 * (good + bad);
            if can(middle) { good = middle } else { bad = middle }
        }
    }
    // Between the stations the curve may still leave the workspace by a little: then a little further in.
    let start = curves.first().map(|curve| curve.at(0.0).p)?;
    let follows = |b: f64| starts(map, start, b, None).into_iter().any(|a| tables(map, curves, b, a, rule).is_ok());
    if follows(good) {
        return Some(good);
    }
    let mut inner = [first, common.inwards(first, 0.5)].into_iter().find(|b| follows(*b))?;
    for _ in 0..10 {
        let middle = 0.5 * (good + inner);
        if follows(middle) { inner = middle } else { good = middle }
    }
    Some(inner)
}

/// The longest part of curves that can be followed on a plane, as s over all of them.
fn longest(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule) -> Option<[f64; 2]> {
    let turn = unit(-map.turn(b));
    let mut best: Option<[f64; 2]> = None;
    let mut better = |from: f64, to: f64| {
        if best.is_none_or(|[low, high]| to - from > high - low) {
            best = Some([from, to]);
        }
    };
    // Runs that are under way: where they began, and their pose at the present station.
    let mut runs: Vec<(f64, [f64; 2])> = Vec::new();
    let n = 2 * STATIONS;
    for i in 0..n {
        let (s, t) = (i as f64 / n as f64, (i + 1) as f64 / n as f64);
        let (which, from) = part(curves, s);
        for pose in map.poses(at(curves, s), b).iter() {
            let known = |r: &(f64, [f64; 2])| (r.1[0] - pose.a[0]).hypot(r.1[1] - pose.a[1]) < 1e-6;
            if !runs.iter().any(known) {
                // It began between the last station and here.
                runs.push((begin(map, curves, b, rule, s, pose.a, n), pose.a));
            }
        }
        runs.retain_mut(|(began, a)| {
            let track = |curve| Track { map, b, turn, curve, rule };
            let (next, to) = part(curves, t);
            let end = if next == which { to } else { 1.0 };
            let stepped = track(&curves[which]).advance(*a, from, end);
            let stepped = match stepped {
                Ok(x) if next != which => {
                    track(&curves[next]).advance(x, 0.0, to).map_err(|(s, ..)| whole(curves, next, s))
                }
                Ok(x) => Ok(x),
                Err((s, ..)) => Err(whole(curves, which, s)),
            };
            match stepped {
                Ok(x) => {
                    *a = x;
                    true
                }
                Err(s) => {
                    better(*began, s);
                    false
                }
            }
        });
    }
    runs.iter().for_each(|(began, _)| better(*began, 1.0));
    best
}

/// How far back from a pose at s a curve can be followed, at most one station.
fn begin(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule, s: f64, a: [f64; 2], n: usize) -> f64 {
    let back = (s - 1.0 / n as f64).max(0.0);
    let (mut good, mut bad) = (s, back);
    if s == 0.0 {
        return 0.0;
    }
    for _ in 0..24 {
        let middle = 0.5 * (good + bad);
        let on_sheet = map.follow(at(curves, middle), b, a).is_some_and(|x| {
            let track = Track { map, b, turn: unit(-map.turn(b)), curve: &curves[0], rule };
            track.keeps_side(a, x)
        });
        if on_sheet { good = middle } else { bad = middle }
    }
    good
}
