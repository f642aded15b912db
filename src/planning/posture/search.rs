//! [`PostureRequest`]: the search for the best path of a posture.

use thiserror::Error;

use super::Posture;
use super::emit;
use super::goal::{CostTerm, PostureCost, WeightMatrix, even, scaled};
use super::layers::{Detail, Layers};
use super::refine::{AngleBound, RefinementProblem};
use super::rows::{PoseConstraint, lifted};
use super::stations::Stations;
use super::weights::PostureWeights;
use crate::curves::{Curve, PathTable};
use crate::pose_space::PoseSpace;
use crate::timing::TimeLaw;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector};

/// Resolutions of the search, each tried if the one before finds no path. Each gives the number of layers, the factor
/// on [`POSE_SPACING_RAD`], and the maximum number of poses of a layer.
const RESOLUTIONS: [(usize, f64, usize); 3] = [(24, 1.0, 200), (48, 0.5, 500), (96, 0.25, 1200)];
/// Distance between neighbouring poses with one, two … degrees of freedom, rad.
const POSE_SPACING_RAD: [f64; 5] = [0.2, 0.35, 0.5, 0.7, 0.9];
/// Number of intervals between stations of rough paths.
const ROUGH_INTERVALS: usize = 48;
/// Step tolerance of the refinement of rough paths, rad.
const ROUGH_STEP_TOLERANCE_RAD: f64 = 1e-5;
/// Initial number of intervals between stations of final paths.
const FINE_INTERVALS: usize = 192;
/// Step tolerance of the refinement of final paths, rad.
const FINE_STEP_TOLERANCE_RAD: f64 = 1e-10;
/// Maximum number of times that intervals are divided because a final path misses its curve there.
const MAX_DIVISIONS: usize = 5;
/// Intervals are not divided any further with this number of stations or more.
const MAX_STATIONS: usize = 2400;
/// A rough path is refined finely if its cost exceeds the least by at most this fraction.
const MAX_COST_EXCESS: f64 = 0.15;
/// Maximum number of rough paths that are refined finely.
const MAX_REFINED: usize = 4;
/// Tolerance of a final path on its curve, as a fraction of the reach.
const CURVE_TOLERANCE: f64 = 1e-9;
/// Tolerance of a rough path on its curve, as a fraction of the reach.
const ROUGH_CURVE_TOLERANCE: f64 = 1e-2;
/// Tolerance of limits, and of the closure of closed paths, rad.
const LIMIT_TOLERANCE_RAD: f64 = 1e-7;
/// Maximum number of refinements with growing margins to the limits.
const MAX_MARGINS: usize = 5;
/// Tolerance of limits where margins do not suffice, rad.
const FINAL_LIMIT_TOLERANCE_RAD: f64 = 8e-7;
/// Paths whose poses differ by less than this are treated as equal, rad.
const SAME_PATH_BELOW_RAD: f64 = 0.02;
/// Weights of rates in the mid-range objective, used one after another.
const RATE_WEIGHTS_IN_MID_RANGE: [f64; 3] = [1e-2, 1e-4, 1e-6];
/// Weight of smoothness in the torque objective.
const SMOOTHNESS_WEIGHT: f64 = 120.0;
/// Weight of every drive in the smoothness term of the torque objective, so that light drives are smoothed too.
const LIGHT_DRIVE_WEIGHT: f64 = 1e-4;
/// Weight of rates in the torque objective.
const RATE_WEIGHT_IN_TORQUE: f64 = 1e-6;
/// Approximate number of start poses that are tried for paths of constant orientation.
const MAX_ORIENTATION_STARTS: usize = 80;

/// Task of the search: the end effector follows curves from rest to rest, with b constant.
#[derive(Clone, Copy, Debug)]
pub struct PostureRequest<'a> {
    /// The machine.
    pub machine: &'a Machine,
    /// Its pose space.
    pub space: &'a PoseSpace,
    /// Pose constant b, rad.
    pub b: f64,
    /// Curves of the end effector, m, one after another.
    pub curves: &'a [Curve],
    /// Time law of each curve in its share of the duration; the quintic stands in for the fastest law. `None` for
    /// constant speed.
    pub law: Option<TimeLaw>,
    /// Whether the curves are closed and the path of the drives should be closed, too.
    pub closed: bool,
    /// For the posture `orientation`: the drive of the last link, and its angle, rad, modulo whole turns, if given.
    pub hand: (usize, Option<f64>),
}

/// Result of the search.
#[derive(Clone, Debug)]
pub struct PosturePaths {
    /// Path of the drives for each curve.
    pub tables: Vec<PathTable>,
}

/// Why the search found no path.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NoPosturePath {
    /// No continuous motion of the joints from the start reaches the end of the path.
    #[error("no way of the joints within their limits goes farther than {:.1} % along", 100.0 * .share)]
    Ends {
        /// Fraction of the path that can be reached, 0 to 1.
        share: f64,
    },
    /// No path of constant orientation exists.
    #[error("no way of the joints keeps the last link's orientation all along")]
    Turns,
    /// Routes exist, but none can be refined to a path that follows the curves closely enough.
    #[error("the joints would have to turn too abruptly on the way")]
    Abrupt,
}

impl NoPosturePath {
    /// Returns a number that is greater the nearer the search came to a path.
    fn rank(&self) -> f64 {
        match self {
            Self::Ends { share } => *share,
            Self::Turns => 2.0,
            Self::Abrupt => 3.0,
        }
    }
}

/// Why a route cannot be refined to a path.
#[derive(Clone, Debug)]
enum Missed {
    /// It misses its curve in the marked intervals, by leg.
    Between(Vec<Vec<bool>>),
    /// The refinement fails, or exceeds limits.
    Elsewhere,
}

/// A path with its value of each objective.
#[derive(Clone, Debug)]
struct Way {
    q: Vec<PerDrive>,
    tables: Vec<PathTable>,
    /// Whether it ends where it begins.
    closed: bool,
    /// A drive of constant angle, and this angle, rad.
    hand: Option<(usize, f64)>,
    /// Values of the objectives [`GOALS`].
    values: [f64; GOALS.len()],
}

/// The objectives.
const GOALS: [Posture; 3] = [Posture::LeastRates, Posture::LeastTorque, Posture::MidRange];

/// Data that all paths of a search share.
struct Search<'a> {
    request: &'a PostureRequest<'a>,
    stations: Stations,
    weights: PostureWeights<'a>,
    bounds: Vec<AngleBound>,
    goals: [Vec<PostureCost>; GOALS.len()],
    /// Step tolerance of the refinement, rad.
    done: f64,
}

impl PostureRequest<'_> {
    /// Finds the path with the least objective of a posture.
    ///
    /// # Errors
    /// Why no path was found; if the poses end early, also the fraction of the path that they cover.
    pub fn path(&self, posture: Posture) -> Result<PosturePaths, NoPosturePath> {
        self.searched(&RESOLUTIONS, posture, |ways, oriented| match posture {
            Posture::Orientation => Some(self.finest(oriented, posture)?.1),
            _ => self.least_of_all(ways, oriented, posture),
        })
    }

    /// Finds a good path with a coarse search. If this search finds a path, [`path`](Self::path) finds one, too.
    ///
    /// # Errors
    /// As [`path`](Self::path).
    pub fn quick_path(&self, posture: Posture) -> Result<PosturePaths, NoPosturePath> {
        self.searched(&RESOLUTIONS[..1], posture, |ways, oriented| {
            Some(self.finest(if posture == Posture::Orientation { oriented } else { ways }, posture)?.1)
        })
    }

    /// Searches at several resolutions and returns the path that `best` selects from the unrestricted paths and those
    /// of constant orientation.
    fn searched(
        &self,
        details: &[(usize, f64, usize)],
        posture: Posture,
        best: impl Fn(&[Way], &[Way]) -> Option<Way>,
    ) -> Result<PosturePaths, NoPosturePath> {
        let rough = Search::on(self, Stations::of(self.curves, self.law, ROUGH_INTERVALS), ROUGH_STEP_TOLERANCE_RAD);
        let starts = self.space.representative_poses(rough.stations.places[0], self.b);
        let mut refused = NoPosturePath::Ends { share: 0.0 };
        for detail in details {
            let why = match rough.layers(&starts, *detail) {
                Err(at) => NoPosturePath::Ends { share: rough.stations.done(at) },
                Ok(layers) => {
                    let is_held = posture == Posture::Orientation;
                    let oriented = rough.oriented(&layers, self.hand.1.filter(|_| is_held));
                    let ways = if is_held { Vec::new() } else { rough.ways(&layers, oriented.first()) };
                    if let Some(way) = best(&ways, &oriented) {
                        return Ok(PosturePaths { tables: way.tables });
                    }
                    if is_held && oriented.is_empty() { NoPosturePath::Turns } else { NoPosturePath::Abrupt }
                }
            };
            refused = if why.rank() > refused.rank() { why } else { refused };
        }
        Err(refused)
    }

    /// Returns the path with the least objective of a posture. The candidates are the best paths by every objective,
    /// those of constant orientation, and their refinements by the other objectives. They are the same for every
    /// posture.
    fn least_of_all(&self, ways: &[Way], oriented: &[Way], posture: Posture) -> Option<Way> {
        let closes = ways.iter().any(|way| way.closed);
        let oriented: Vec<Way> = oriented.iter().filter(|way| way.closed || !closes).cloned().collect();
        let mut all: Vec<Way> = Vec::new();
        for own in [Posture::LeastRates, Posture::LeastTorque, Posture::MidRange, Posture::Orientation] {
            let Some((fine, way)) = self.finest(if own == Posture::Orientation { &oriented } else { ways }, own) else {
                continue;
            };
            let others = (0..GOALS.len()).filter(|goal| GOALS[*goal] != own);
            all.extend(others.filter_map(|goal| fine.refined(&fine.held(), goal, &way.q, way.closed).ok()));
            all.push(way);
        }
        let goal = goal_of(posture);
        all.into_iter().min_by(|x, y| x.values[goal].total_cmp(&y.values[goal]))
    }

    /// Refines the best rough paths finely and returns the search with the final stations, and the best path. Adds
    /// stations where a path misses its curve.
    fn finest(&self, ways: &[Way], posture: Posture) -> Option<(Search<'_>, Way)> {
        let mut fine = Search::on(self, Stations::of(self.curves, self.law, FINE_INTERVALS), FINE_STEP_TOLERANCE_RAD);
        for _ in 0..=MAX_DIVISIONS {
            match fine.finest(ways, goal_of(posture), posture == Posture::Orientation) {
                Ok(way) => return Some((fine, way)),
                Err(Missed::Between(marked)) if fine.stations.places.len() < MAX_STATIONS => {
                    fine =
                        Search::on(self, fine.stations.parted(self.curves, self.law, &marked), FINE_STEP_TOLERANCE_RAD);
                }
                Err(_) => return None,
            }
        }
        None
    }
}

fn goal_of(posture: Posture) -> usize {
    GOALS.iter().position(|goal| *goal == posture).unwrap_or(0)
}

impl<'a> Search<'a> {
    fn on(request: &'a PostureRequest<'a>, stations: Stations, done: f64) -> Self {
        let (space, n) = (request.space, request.space.drives());
        let weights = PostureWeights::of(request.machine, space);
        let one = |k: usize| PerDrive::from_fn(n, |l| f64::from(u8::from(k == l)));
        let none = PerDrive::zeros(n);
        let bounds = space.joints().iter().filter(|joint| joint.bounds()[0].is_finite()).map(|joint| {
            let offset = joint.of(&none);
            AngleBound { row: PerDrive::from_fn(n, |k| joint.of(&one(k)) - offset), offset, limits: joint.limits() }
        });
        let bounds = bounds.collect();
        let centre = lifted(space, &space.middle(), request.b);
        let goal = |terms: Vec<CostTerm>| PostureCost { terms, centre };
        let all = even(n);
        let rates = goal(vec![CostTerm::rates(&stations, all), CostTerm::smooth(&stations, all, 1.0)]);
        let torque = weights.torque;
        let smoothness: WeightMatrix =
            std::array::from_fn(|k| std::array::from_fn(|l| torque[k][l] + LIGHT_DRIVE_WEIGHT * all[k][l]));
        let torques = goal(vec![
            CostTerm::accelerations(&stations, torque),
            CostTerm::rates(&stations, scaled(&all, RATE_WEIGHT_IN_TORQUE)),
            CostTerm::smooth(&stations, smoothness, SMOOTHNESS_WEIGHT),
        ]);
        let middle = RATE_WEIGHTS_IN_MID_RANGE.map(|rate_weight| {
            let own = scaled(&all, rate_weight);
            goal(vec![
                CostTerm::places(&stations, weights.ranges()),
                CostTerm::rates(&stations, own),
                CostTerm::smooth(&stations, own, 1.0),
            ])
        });
        let goals = [vec![rates], vec![torques], middle.to_vec()];
        Self { request, stations, weights, bounds, goals, done }
    }

    fn held(&self) -> PoseConstraint<'a> {
        PoseConstraint { space: self.request.space, b: self.request.b, hand: None }
    }

    fn layers(
        &self,
        starts: &[PerDrive],
        (layers, finer, max_poses): (usize, f64, usize),
    ) -> Result<Layers<'a>, usize> {
        let freedoms = self.held().freedoms();
        let spacing = finer * POSE_SPACING_RAD[freedoms.clamp(1, POSE_SPACING_RAD.len()) - 1];
        Layers::of((self.request.space, self.request.b), &self.stations, starts, Detail { layers, spacing, max_poses })
    }

    /// Returns refined paths over the layers, and those refined from one of constant orientation. For closed curves
    /// these are closed paths, if there are any.
    fn ways(&self, layers: &Layers<'_>, oriented: Option<&Way>) -> Vec<Way> {
        let closings: &[bool] = if self.request.closed { &[true, false] } else { &[false] };
        for closed in closings {
            let mut ways: Vec<Way> = Vec::new();
            for goal in 0..GOALS.len() {
                let route = self.route(layers, goal, *closed);
                ways.extend(route.and_then(|route| self.refined(&self.held(), goal, &route, *closed).ok()));
            }
            if ways.is_empty() {
                continue;
            }
            ways.extend(oriented.filter(|way| !closed || way.closed).cloned());
            self.crossed(&mut ways, *closed);
            return ways;
        }
        Vec::new()
    }

    /// Refines each path by every objective unless it is close to the best by that objective, and adds the results.
    /// Repeats this up to three times, until no path is added.
    fn crossed(&self, ways: &mut Vec<Way>, closed: bool) {
        let mut tried: Vec<(usize, usize)> = Vec::new();
        for _ in 0..3 {
            let before = ways.len();
            for i in 0..GOALS.len() {
                for from in 0..before {
                    let Some(best) = least(ways, i) else { return };
                    if tried.contains(&(i, from)) || apart(&ways[best].q, &ways[from].q) < SAME_PATH_BELOW_RAD {
                        continue;
                    }
                    // With more than eight paths, start only from those that are best by some objective.
                    if before > 8 && !(0..GOALS.len()).any(|goal| least(ways, goal) == Some(from)) {
                        continue;
                    }
                    tried.push((i, from));
                    let start = ways[from].q.clone();
                    ways.extend(self.refined(&self.held(), i, &start, closed));
                }
            }
            if ways.len() == before {
                break;
            }
        }
    }

    /// Refines the cheapest rough paths on these stations and returns the best. If `oriented`, each keeps its
    /// orientation.
    fn finest(&self, ways: &[Way], goal: usize, oriented: bool) -> Result<Way, Missed> {
        let mut order: Vec<&Way> = ways.iter().collect();
        order.sort_by(|x, y| x.values[goal].total_cmp(&y.values[goal]));
        let mut best: Option<Way> = None;
        let mut missed = Missed::Elsewhere;
        let (mut max_cost, mut count) = (f64::INFINITY, 0);
        let mut before: Vec<&Way> = Vec::new();
        for way in order {
            if way.values[goal] > max_cost || count >= MAX_REFINED {
                break;
            }
            if before.iter().any(|other| apart(&other.q, &way.q) < SAME_PATH_BELOW_RAD) {
                continue;
            }
            before.push(way);
            let held = PoseConstraint { hand: way.hand, ..self.held() };
            let Some(start) = self.placed(way, &held) else { continue };
            match self.refined(&if oriented { held } else { self.held() }, goal, &start, way.closed) {
                Ok(made) => {
                    max_cost = max_cost.min((1.0 + MAX_COST_EXCESS) * way.values[goal]);
                    count += 1;
                    let better = best.as_ref().is_none_or(|best| made.values[goal] < best.values[goal]);
                    best = if better { Some(made) } else { best };
                }
                // Keep the marked intervals of the cheapest path that fails.
                Err(why) => {
                    let is_first = matches!((&missed, &why), (Missed::Elsewhere, Missed::Between(_)));
                    count += usize::from(matches!(why, Missed::Between(_)));
                    missed = if is_first { why } else { missed };
                }
            }
        }
        best.ok_or(missed)
    }

    /// Returns the poses of a rough path at these stations.
    fn placed(&self, way: &Way, held: &PoseConstraint<'_>) -> Option<Vec<PerDrive>> {
        let mut q: Vec<PerDrive> = Vec::with_capacity(self.stations.places.len());
        for (leg, table) in self.stations.legs.iter().zip(&way.tables) {
            for (s, point) in leg.s.iter().zip(&leg.points).skip(usize::from(!q.is_empty())) {
                q.push(held.onto(&table.at(*s).q.0, point.p)?);
            }
        }
        Some(q)
    }

    fn route(&self, layers: &Layers<'_>, goal: usize, closed: bool) -> Option<Vec<PerDrive>> {
        let leg_of = |station: usize| {
            let legs = &self.stations.legs;
            legs.iter().rev().find(|leg| leg.first <= station && station < leg.last()).unwrap_or(&legs[0])
        };
        // For each layer: difference in s and in time to the next layer.
        let spans: Vec<[f64; 2]> = layers
            .all
            .windows(2)
            .map(|w| {
                let leg = leg_of(w[0].at);
                let s = [w[0].at, w[1].at].map(|at| leg.s[at - leg.first]);
                let t = s.map(|s| leg.profile.time_at(s));
                [leg.share * (s[1] - s[0]), (t[1] - t[0]).max(1e-9)]
            })
            .collect();
        let cost = |i: usize, from: &PerDrive, to: &PerDrive| {
            let (step, [run, time]) = (to.minus(from), spans[i]);
            let rates = step.dot(&step) / run.max(1e-12);
            match GOALS[goal] {
                Posture::LeastTorque => step.dot(&super::goal::times(&self.weights.torque, &step)) / time,
                Posture::MidRange => {
                    let middle = |q: &PerDrive| self.weights.off_middle(&DriveAngles(*q));
                    0.5 * run * (middle(from) + middle(to)) + 1e-3 * rates
                }
                _ => rates,
            }
        };
        layers.route(&self.stations, &cost, closed)
    }

    /// Refines a path by an objective, through its stages of weights.
    fn refined(&self, held: &PoseConstraint<'_>, goal: usize, start: &[PerDrive], closed: bool) -> Result<Way, Missed> {
        let mut best: Result<Way, Missed> = Err(Missed::Elsewhere);
        let mut q = start.to_vec();
        for goal in &self.goals[goal] {
            match self.within_limits(held, goal, &q, closed) {
                Ok(way) => {
                    q.clone_from(&way.q);
                    best = Ok(way);
                }
                Err(_) if best.is_ok() => break,
                Err(why) => return Err(why),
            }
        }
        best
    }

    /// Refines a path by one quadratic objective. Final paths also keep the limits between stations, by margins.
    fn within_limits(
        &self,
        held: &PoseConstraint<'_>,
        goal: &PostureCost,
        start: &[PerDrive],
        closed: bool,
    ) -> Result<Way, Missed> {
        let mut bounds = self.bounds.clone();
        let mut q = start.to_vec();
        let rough = self.done >= ROUGH_STEP_TOLERANCE_RAD;
        let curve_tolerance = held.space.farthest() * if rough { ROUGH_CURVE_TOLERANCE } else { CURVE_TOLERANCE };
        for i in 0..MAX_MARGINS {
            let refining =
                RefinementProblem { held, stations: &self.stations, bounds: &bounds, closed, done: self.done };
            q = refining.refined(goal, &q).ok_or(Missed::Elsewhere)?;
            let tables = emit::tables(held, &self.stations, &q).ok_or(Missed::Elsewhere)?;
            let off = emit::curve_error(held, &self.stations, &tables);
            if off.iter().flatten().any(|off| off.is_nan()) {
                return Err(Missed::Elsewhere);
            }
            if off.iter().flatten().any(|off| *off > curve_tolerance) {
                let marks = off.iter().map(|leg| leg.iter().map(|off| *off > curve_tolerance).collect());
                return Err(Missed::Between(marks.collect()));
            }
            let past = emit::limit_excess(&self.bounds, &self.stations, &tables);
            let worst = past.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if rough || worst <= LIMIT_TOLERANCE_RAD || (i + 1 == MAX_MARGINS && worst <= FINAL_LIMIT_TOLERANCE_RAD) {
                let values = self.values(&tables);
                let closed = closed || gap(&q) < LIMIT_TOLERANCE_RAD;
                return Ok(Way { q, tables, closed, hand: held.hand, values });
            }
            for (bound, past) in bounds.iter_mut().zip(&past) {
                if *past > LIMIT_TOLERANCE_RAD {
                    let [low, high] = bound.limits;
                    let margin = (1.5 * past).min(0.25 * (high - low));
                    bound.limits = [low + margin, high - margin];
                }
            }
        }
        Err(Missed::Elsewhere)
    }

    /// Returns the values of the objectives [`GOALS`].
    fn values(&self, tables: &[PathTable]) -> [f64; GOALS.len()] {
        let (stations, weights) = (&self.stations, &self.weights);
        [
            emit::rates(stations, tables, &even(self.request.space.drives())),
            emit::accelerations(stations, tables, &weights.torque),
            emit::places(stations, tables, |q| weights.off_middle(&DriveAngles(*q))),
        ]
    }

    /// Returns paths of constant orientation of the last link, at any angle or a given one, those of the least rates
    /// first.
    fn oriented(&self, layers: &Layers<'_>, angle: Option<f64>) -> Vec<Way> {
        let (request, places) = (self.request, &self.stations.places);
        let drive = request.hand.0;
        let starts: Vec<PerDrive> = match angle {
            Some(angle) => {
                let all =
                    request.space.poses_with_drive_angle(places[0], request.b, drive, angle, &request.space.middle());
                all.into_iter().map(|q| q.0).collect()
            }
            None => {
                let all = &layers.all[0].poses;
                all.iter().step_by(all.len().div_ceil(MAX_ORIENTATION_STARTS)).copied().collect()
            }
        };
        let held = |q: &PerDrive| PoseConstraint { hand: Some((drive, q[drive])), ..self.held() };
        let mut found: Vec<(f64, Vec<PerDrive>)> = Vec::new();
        for q in starts {
            let Some(path) = followed(&held(&q), &q, places) else { continue };
            let cost = path.windows(2).map(|w| w[1].minus(&w[0])).map(|step| step.dot(&step)).sum();
            let is_free = held(&q).freedoms() > 0;
            if is_free
                || path.iter().all(|q| self.bounds.iter().all(|bound| bound.past(q) <= FINAL_LIMIT_TOLERANCE_RAD))
            {
                found.push((cost, path));
            }
        }
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        let ways = found.into_iter().filter_map(|(_, path)| {
            self.refined(&held(&path[0]), 0, &path, false).ok().filter(|way| self.is_kept(way))
        });
        let mut ways: Vec<Way> = ways.take(2 * MAX_REFINED).collect();
        ways.sort_by(|x, y| x.values[0].total_cmp(&y.values[0]));
        ways
    }

    /// Returns whether limits are kept at all stations, within the tolerance of a rough path.
    fn is_kept(&self, way: &Way) -> bool {
        way.q.iter().all(|q| self.bounds.iter().all(|bound| bound.past(q) <= 1e-3))
    }
}

/// Continues a pose along places; `None` if it jumps.
fn followed(held: &PoseConstraint<'_>, start: &PerDrive, places: &[Vector]) -> Option<Vec<PerDrive>> {
    let mut path: Vec<PerDrive> = vec![*start];
    for p in &places[1..] {
        let last = path[path.len() - 1];
        // Linear extrapolation.
        let guess = match path.len() {
            1 => last,
            many => last.plus(1.0, &last.minus(&path[many - 2])),
        };
        path.push(held.onto(&guess, *p).filter(|q| q.minus(&last).max_abs() < 0.5)?);
    }
    Some(path)
}

/// Returns the index of the path with the least value of an objective.
fn least(ways: &[Way], goal: usize) -> Option<usize> {
    (0..ways.len()).min_by(|x, y| ways[*x].values[goal].total_cmp(&ways[*y].values[goal]))
}

/// Returns the maximum difference between two paths, rad.
fn apart(p: &[PerDrive], q: &[PerDrive]) -> f64 {
    p.iter().zip(q).map(|(p, q)| p.minus(q).max_abs()).fold(0.0, f64::max)
}

/// Returns the difference between the end of a path and its start, rad.
fn gap(q: &[PerDrive]) -> f64 {
    q[q.len() - 1].minus(&q[0]).max_abs()
}
