//! The corridor of b along a motion of the end effector. At each point it is the interval from b_min to b_max in which
//! the sheet of the start pose reaches that point within the joint limits.
//!
//! On one sheet q = q(x, y, b): once the end effector's motion is given, b is the only free coordinate. The bounds
//! are joint limits or folds; they follow exactly from the self-motion of each point, divided where b reverses.

use thiserror::Error;

use crate::curves::curve::CurvePoint;
use crate::reactionless::{LIMIT_SLACK, NoReach, PlaneMap, PlanePoint, describe_interval, metres};
use stillbase_mechanics::planar::Vector;

/// Number of samples of each branch of a self-motion.
const SAMPLES: usize = 25;
/// Maximum change of a pose between neighbouring stations, rad; a pose further away is on another branch.
const MAX_POSE_CHANGE_RAD: f64 = 0.2;
/// The result of Newton's method is accepted if it is closer than this to the guess, rad.
const MAX_NEWTON_MOVE_RAD: f64 = 0.05;
/// Differences of b below this are rounding errors, rad.
const B_ROUNDING_RAD: f64 = 1e-11;
/// A bound jumps between two stations if it changes by more than this factor times its change in the neighbouring
/// intervals, plus [`MIN_JUMP_RAD`].
const JUMP_FACTOR: f64 = 4.0;
/// Minimum size of a jump, rad.
const MIN_JUMP_RAD: f64 = 1e-6;
/// Number of bisections that locate a jump.
const HALVINGS: usize = 24;
/// Number of stations between a jump and the next evenly spaced station; each is twice as far from the jump as the
/// one before.
const GRADES: i32 = 10;
/// Maximum number of jumps at which stations are added.
const MAX_JUMPS: usize = 32;

/// Corridor of b at one instant.
#[derive(Clone, Debug)]
pub struct Station {
    /// u = t/T.
    pub u: f64,
    /// Position of the end effector and its derivatives by u, m.
    pub point: CurvePoint,
    /// b_min, rad; −∞ if b is unbounded.
    pub low: f64,
    /// b_max, rad; ∞ if b is unbounded.
    pub high: f64,
    /// Poses from b_min to b_max; at least one.
    line: Vec<PlanePoint>,
    /// A number with the sign of det ∂(x, y)/∂(a_1, a_2) on the sheet.
    det: f64,
}

/// The corridor along a motion, at stations spaced evenly in u = t/T from 0 to 1.
#[derive(Clone, Debug)]
pub struct Corridor {
    map: PlaneMap,
    start: PlanePoint,
    stations: Vec<Station>,
    /// Additional stations between the evenly spaced ones, where a bound of the corridor jumps.
    extra_stations: Vec<Station>,
}

/// Why a corridor does not exist.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CorridorError {
    /// The start pose does not reach the first point of the motion.
    #[error("the start pose has the end effector {miss:.2e} m off the motion's first point: want it there")]
    Start {
        /// Distance of its end effector from that point, m.
        miss: f64,
    },
    /// The first point of the motion is not finite.
    #[error("the motion's first point is no point, or too far away to count: want finite coordinates")]
    Nowhere,
    /// The start pose is beyond a joint limit.
    #[error("the start pose has a_{number} = {angle:.3} rad: want it {}", describe_interval(*.min, *.max))]
    Limit {
        /// Number of the relative angle, 1 or 2.
        number: usize,
        /// The angle, rad.
        angle: f64,
        /// Its lower limit, rad.
        min: f64,
        /// Its upper limit, rad.
        max: f64,
    },
    /// det = 0 at the start pose.
    #[error("the start pose lies on a fold, where two sheets meet: want det ∂(x, y)/∂(a_1, a_2) ≠ 0")]
    Fold,
    /// No b reaches a point of the motion.
    #[error("at u = {u:.3} of the motion, ({}, {}) m: {reason}", metres(*.x, 3), metres(*.y, 3))]
    Unreachable {
        /// t/T.
        u: f64,
        /// x of the point, m.
        x: f64,
        /// y of the point, m.
        y: f64,
        /// Why no b reaches the point.
        #[source]
        reason: NoReach,
    },
    /// A point of the motion can be reached on other sheets only.
    #[error(
        "at u = {u:.3} the sheet of the start pose ends: the rest of the motion wants another elbow, or wider joint limits"
    )]
    Ends {
        /// t/T.
        u: f64,
    },
    /// The motion is not finite.
    #[error("the motion is not finite at u = {u:.3}")]
    NotFinite {
        /// t/T.
        u: f64,
    },
}

impl Station {
    /// Finds the pose at this instant and b, rad, on the corridor's sheet; `None` if b is outside the corridor.
    pub fn pose(&self, map: &PlaneMap, b: f64) -> Option<PlanePoint> {
        let (first, last) = (self.line.first()?, self.line.last()?);
        let turns = if self.low.is_finite() { 0.0 } else { map.period() * ((b - first.b) / map.period()).floor() };
        let on = (b - turns).clamp(first.b, last.b);
        if (on - (b - turns)).abs() > B_ROUNDING_RAD {
            return None;
        }
        let i = self.line.partition_point(|at| at.b < on).clamp(1, self.line.len().max(2) - 1);
        let [from, to] = [self.line[i - 1], *self.line.get(i).unwrap_or(last)];
        if let Some(end) = [from, to].into_iter().find(|end| (end.b - on).abs() <= B_ROUNDING_RAD) {
            return Some(PlanePoint { a: end.a, b });
        }
        let share = (on - from.b) / (to.b - from.b);
        let guess = [0, 1].map(|i| from.a[i] + share * (to.a[i] - from.a[i]));
        if map.det(guess) * self.det > 0.0
            && let Some(a) = map.follow(self.point.p, on, guess)
            && (a[0] - guess[0]).hypot(a[1] - guess[1]) < MAX_NEWTON_MOVE_RAD
        {
            return Some(PlanePoint { a, b });
        }
        let far = |x: &PlanePoint| (x.a[0] - guess[0]).hypot(x.a[1] - guess[1]);
        let poses = map.poses(self.point.p, on);
        let own = poses.iter().filter(|x| map.det(x.a) * self.det > 0.0);
        own.min_by(|x, y| far(x).total_cmp(&far(y))).map(|x| PlanePoint { a: x.a, b })
    }

    /// Returns b_min for side 0, b_max for side 1, rad.
    fn bound(&self, side: usize) -> f64 {
        [self.low, self.high][side]
    }

    /// Returns the middle of the corridor, rad, or `b` itself if it is unbounded.
    fn middle(&self, b: f64) -> f64 {
        if self.low.is_finite() { 0.5 * (self.low + self.high) } else { b }
    }
}

/// Returns the distance between two b modulo the period, rad.
fn off(x: f64, b: f64, map: &PlaneMap) -> f64 {
    let gap = (x - b).abs();
    (gap - map.period() * (gap / map.period()).round()).abs()
}

/// Returns the distance between two bounds, rad; 0 if they are equal, also if both are infinite.
fn gap(x: f64, y: f64) -> f64 {
    if x == y { 0.0 } else { (x - y).abs() }
}

impl Corridor {
    /// Follows the sheet of a start pose along a motion p(u), u = t/T from 0 to 1, with `count` + 1 stations. Where
    /// joint limits divide the corridor, it takes the part nearest to the middle of the corridor at the station before.
    ///
    /// # Errors
    /// If the start pose is unsuitable, or where the motion is not finite or the sheet ends.
    pub fn along(
        map: &PlaneMap,
        curve: impl Fn(f64) -> CurvePoint,
        start: PlanePoint,
        count: usize,
    ) -> Result<Self, CorridorError> {
        let first = curve(0.0).p;
        let miss = (map.forward(start.a, start.b) - first).norm();
        let reach: f64 = map.c().iter().map(|c| c.abs()).sum();
        if !miss.is_finite() {
            return Err(CorridorError::Nowhere);
        }
        if miss > 1e-8 * reach {
            return Err(CorridorError::Start { miss });
        }
        for (i, limit) in map.limits().iter().enumerate() {
            if !limit.contains(start.a[i], LIMIT_SLACK) {
                let (min, max) = (limit.min, limit.max);
                return Err(CorridorError::Limit { number: i + 1, angle: start.a[i], min, max });
            }
        }
        let det = map.det(start.a);
        if det.abs() <= 1e-9 * reach * reach {
            return Err(CorridorError::Fold);
        }
        let count = count.max(1);
        let mut stations: Vec<Station> = Vec::with_capacity(count + 1);
        let mut at = start;
        for i in 0..=count {
            let u = i as f64 / count as f64;
            let point = curve(u);
            let station = station(map, u, point, at, det)?;
            let b = station.middle(at.b);
            at = station.pose(map, b).ok_or(CorridorError::Ends { u })?;
            stations.push(station);
        }
        let mut corridor = Self { map: *map, start, stations, extra_stations: Vec::new() };
        corridor.extra_stations =
            corridor.jumps().into_iter().flat_map(|jump| corridor.stations_near_jump(&curve, jump)).collect();
        Ok(corridor)
    }

    /// Returns where a bound of the corridor jumps, for example because a fold begins. Each jump has the index of the
    /// station before it, and the side of the bound.
    fn jumps(&self) -> Vec<(usize, usize)> {
        let step = |k: usize, side: usize| gap(self.stations[k].bound(side), self.stations[k + 1].bound(side));
        let last = self.stations.len() - 2;
        let sudden = |&(k, side): &(usize, usize)| {
            let beside = [k.checked_sub(1), (k < last).then_some(k + 1)];
            let max_beside = beside.into_iter().flatten().map(|k| step(k, side)).fold(0.0, f64::max);
            step(k, side) > JUMP_FACTOR * max_beside + MIN_JUMP_RAD
        };
        (0..=last).flat_map(|k| [(k, 0), (k, 1)]).filter(sudden).take(MAX_JUMPS).collect()
    }

    /// Returns stations on the narrower side of a jump, at distances that halve towards it. They resolve the corner
    /// of the corridor that the evenly spaced stations miss.
    fn stations_near_jump(&self, curve: impl Fn(f64) -> CurvePoint, (k, side): (usize, usize)) -> Vec<Station> {
        let [before, after] = [&self.stations[k], &self.stations[k + 1]];
        let bounds = [before.bound(side), after.bound(side)];
        let (mut low, mut high) = (before.u, after.u);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let Some(station) = self.at(&curve, middle) else { break };
            let [to_before, to_after] = bounds.map(|bound| gap(station.bound(side), bound));
            if to_before <= to_after {
                low = middle;
            } else {
                high = middle;
            }
        }
        let narrows = if side == 0 { bounds[1] > bounds[0] } else { bounds[1] < bounds[0] };
        let (corner, even) = if narrows { (high, after.u) } else { (low, before.u) };
        if corner == even {
            return Vec::new();
        }
        let graded = (1..=GRADES).map(|j| corner + (even - corner) * 0.5_f64.powi(j));
        graded.chain([corner]).filter_map(|u| self.at(&curve, u)).collect()
    }

    /// Returns the corridor at any u; `None` if the sheet does not extend there.
    pub(super) fn at(&self, curve: impl Fn(f64) -> CurvePoint, u: f64) -> Option<Station> {
        let count = self.stations.len() - 1;
        let det = self.map.det(self.start.a);
        let k = ((u * count as f64) as usize).min(count - 1);
        [k, k + 1].into_iter().find_map(|k| {
            let near = &self.stations[k];
            let pose = near.pose(&self.map, near.middle(self.start.b))?;
            station(&self.map, u, curve(u), pose, det).ok()
        })
    }

    /// Adds a station between the evenly spaced ones.
    pub(super) fn add_station(&mut self, station: Station) {
        self.extra_stations.push(station);
    }

    /// Returns the stations between the evenly spaced ones, unordered.
    pub(super) fn extra_stations(&self) -> &[Station] {
        &self.extra_stations
    }

    /// Returns the evenly spaced stations, from u = 0 to 1.
    pub fn stations(&self) -> &[Station] {
        &self.stations
    }

    /// Returns the start pose.
    pub fn start(&self) -> PlanePoint {
        self.start
    }

    /// Returns the plane map, Eqs (13)–(16), of the machine.
    pub fn map(&self) -> &PlaneMap {
        &self.map
    }

    /// Returns the first station at which a b, rad, is outside the corridor; `None` if b can stay constant throughout.
    pub fn first_station_outside(&self, b: f64) -> Option<&Station> {
        let outside = |s: &&Station| !(s.low - LIMIT_SLACK <= b && b <= s.high + LIMIT_SLACK);
        let all = self.stations.iter().chain(&self.extra_stations);
        all.filter(outside).min_by(|x, y| x.u.total_cmp(&y.u))
    }
}

/// Finds the corridor at a point, on the branch of the self-motion that passes nearest to a pose.
fn station(map: &PlaneMap, u: f64, point: CurvePoint, near: PlanePoint, det: f64) -> Result<Station, CorridorError> {
    let p: Vector = point.p;
    let finite = [p, point.first, point.second].iter().all(|x| x.re.is_finite() && x.im.is_finite());
    if !finite {
        return Err(CorridorError::NotFinite { u });
    }
    let mut best: Option<(f64, Station)> = None;
    for branch in map.self_motion(p, SAMPLES) {
        for mut line in monotone_parts(map, branch) {
            let (low, high) = (line[0].b, line[line.len() - 1].b);
            // Folds bound a part, so that det has one sign inside it. If the sheet has shrunk to a point, the sign is
            // arbitrary.
            let own = map.det(inside(&line));
            if own * det < 0.0 && high - low > B_ROUNDING_RAD {
                continue;
            }
            let endless = high - low >= map.period() - 1e-9;
            let turns = map.period() * ((near.b - 0.5 * (low + high)) / map.period()).round();
            line.iter_mut().for_each(|at| at.b += turns);
            let (low, high) = if endless { (f64::NEG_INFINITY, f64::INFINITY) } else { (low + turns, high + turns) };
            let candidate = Station { u, point, low, high, line, det: own };
            let Some(at) = candidate.pose(map, near.b.clamp(low, high)) else { continue };
            let moved = (at.a[0] - near.a[0]).hypot(at.a[1] - near.a[1]);
            if moved < MAX_POSE_CHANGE_RAD && best.as_ref().is_none_or(|(least, _)| moved < *least) {
                best = Some((moved, candidate));
            }
        }
    }
    if let Some((_, station)) = best {
        return Ok(station);
    }
    Err(match map.reach(p) {
        Err(reason) => CorridorError::Unreachable { u, x: p.re, y: p.im, reason },
        Ok(_) => CorridorError::Ends { u },
    })
}

/// Returns the relative angles of a pose inside a part.
fn inside(line: &[PlanePoint]) -> [f64; 2] {
    match line {
        [from, to] => [0, 1].map(|i| 0.5 * (from.a[i] + to.a[i])),
        line => line[line.len() / 2].a,
    }
}

/// Divides a branch of a self-motion where b reverses; in each part b rises.
fn monotone_parts(map: &PlaneMap, branch: Vec<PlanePoint>) -> Vec<Vec<PlanePoint>> {
    let closes = match (branch.first(), branch.last()) {
        (Some(x), Some(y)) if branch.len() > 2 => {
            (x.a[0] - y.a[0]).abs() < 1e-9 && (x.a[1] - y.a[1]).abs() < 1e-9 && off(x.b, y.b, map) < 1e-9
        }
        _ => false,
    };
    let mut parts: Vec<(f64, Vec<PlanePoint>)> = Vec::new();
    for at in branch {
        let Some((way, part)) = parts.last_mut() else {
            parts.push((0.0, vec![at]));
            continue;
        };
        let last = part[part.len() - 1];
        let step = at.b - last.b;
        if step.abs() > B_ROUNDING_RAD && *way * step < 0.0 {
            parts.push((step.signum(), vec![last, at]));
        } else {
            if step.abs() > B_ROUNDING_RAD {
                *way = step.signum();
            }
            part.push(at);
        }
    }
    // On a closed branch the last part continues as the first.
    if closes && parts.len() > 1 && parts[0].0 == parts[parts.len() - 1].0 {
        let (_, first) = parts.remove(0);
        if let Some((_, last)) = parts.last_mut() {
            let lift = last[last.len() - 1].b - first[0].b;
            last.extend(first.into_iter().skip(1).map(|at| PlanePoint { b: at.b + lift, ..at }));
        }
    }
    let rising = |(way, mut part): (f64, Vec<PlanePoint>)| {
        if way < 0.0 {
            part.reverse();
        }
        part
    };
    parts.into_iter().map(rising).collect()
}
