//! [`Asked`]: the path of a posture, of all paths that are found.

use thiserror::Error;

use super::Posture;
use super::emit;
use super::goal::{Goal, Term, Weight, even, scaled};
use super::hand::Postures;
use super::layers::{Detail, Layers};
use super::refine::{Bound, Refining};
use super::rows::{Held, lifted};
use super::stations::Stations;
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::{DriveAngles, PerDrive, Vector};
use crate::planning::curves::{Curve, PathTable};
use crate::planning::pose_space::PoseSpace;
use crate::planning::timing::TimeLaw;

/// How finely is looked, the next where the one before finds no way: layers, how far poses are apart beside what
/// [`POSE_SPACING`] says, and how many there are.
const DETAILS: [(usize, f64, usize); 3] = [(24, 1.0, 200), (48, 0.5, 500), (96, 0.25, 1200)];
/// How far poses are apart with one, two … freedoms, rad.
const POSE_SPACING: [f64; 5] = [0.2, 0.35, 0.5, 0.7, 0.9];
/// Spaces between stations, at first and for the paths that are taken, and when steps of their refinement are done, rad.
const ROUGH: (usize, f64) = (48, 1e-5);
const FINE: (usize, f64) = (192, 1e-10);
/// How often spaces are parted in which a fine path misses its curve, and how many stations there are at most.
const MAX_PARTINGS: usize = 5;
const MAX_STATIONS: usize = 2400;
/// Rough paths are made fine if they cost at most this share more than the least.
const MAX_DEARER_SHARE: f64 = 0.15;
/// And no more of them than this.
const MAX_MADE_FINE: usize = 4;
/// A path misses its curve by less than this share of the reach.
const ON_CURVE: f64 = 1e-9;
/// A rough one by less than this.
const NEAR_CURVE: f64 = 1e-2;
/// Limits are missed by less than this, rad.
const KEPT: f64 = 1e-7;
const MAX_MARGINS: usize = 5;
/// What a limit may be passed by where there is no room to keep off it, rad.
const AT_LIMIT: f64 = 8e-7;
/// Nearness of paths that are one, rad.
const SAME_PATH: f64 = 0.02;
/// What rates count beside the middle of ranges, one after another.
const BESIDE_MIDDLE: [f64; 3] = [1e-2, 1e-4, 1e-6];
/// What smoothness counts beside torques.
const SMOOTHNESS_WEIGHT: f64 = 120.0;
/// What every drive's rate counts beside its torque, so that light drives count, too.
const LIGHT_DRIVE_WEIGHT: f64 = 1e-4;
/// What rates count beside torques.
const BESIDE_TORQUE: f64 = 1e-6;
/// Starts that are tried for paths that keep an orientation.
const ORIENTATIONS: usize = 80;

/// What is wanted: the end effector along curves from rest to rest, with b held.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// The machine.
    pub machine: &'a Machine,
    /// Its poses.
    pub space: &'a PoseSpace,
    /// b, rad.
    pub b: f64,
    /// Curves of the end effector, m, one after another.
    pub curves: &'a [Curve],
    /// The law by which each is passed in its share of the time; quintic where the law is to be the fastest. None where the
    /// curves are passed evenly.
    pub law: Option<TimeLaw>,
    /// Whether the curves end where they begin, and the drives should.
    pub closed: bool,
    /// For the posture `orientation`: the drive of the last link, and its angle, rad, up to whole turns, if it is given.
    pub hand: (usize, Option<f64>),
}

/// A path for each curve.
#[derive(Clone, Debug)]
pub struct Found {
    /// The paths.
    pub tables: Vec<PathTable>,
}

/// Why there is no path.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NoWay {
    /// Poses end on the way.
    #[error("no way of the joints within their limits goes farther than {:.1} % along", 100.0 * .share)]
    Ends {
        /// How far the poses go that can be reached from the start, a share of the way.
        share: f64,
    },
    /// No pose that keeps the orientation goes all the way.
    #[error("no way of the joints keeps the last link's orientation all along")]
    Turns,
    /// There are ways, but none that a path follows closely enough.
    #[error("the joints would have to turn too abruptly on the way")]
    Abrupt,
}

impl NoWay {
    /// How near it came to a path.
    fn rank(&self) -> f64 {
        match self {
            Self::Ends { share } => *share,
            Self::Turns => 2.0,
            Self::Abrupt => 3.0,
        }
    }
}

/// Why a way makes no path.
#[derive(Clone, Debug)]
enum Missed {
    /// It misses its curve in the spaces that are marked, by leg.
    Between(Vec<Vec<bool>>),
    /// It does not come to an end, or passes limits.
    Elsewhere,
}

/// A path with what it has of each goal.
#[derive(Clone, Debug)]
struct Way {
    q: Vec<PerDrive>,
    tables: Vec<PathTable>,
    /// Whether it was made to end where it begins.
    closed: bool,
    /// The drive that keeps its angle, rad.
    hand: Option<(usize, f64)>,
    values: [f64; GOALS.len()],
}

/// What can be least.
const GOALS: [Posture; 3] = [Posture::LeastRates, Posture::LeastTorque, Posture::MidRange];

/// Everything that is the same for all ways.
struct Search<'a> {
    asked: &'a Asked<'a>,
    stations: Stations,
    weights: Postures<'a>,
    bounds: Vec<Bound>,
    goals: [Vec<Goal>; GOALS.len()],
    /// When steps are done, rad.
    done: f64,
}

impl Asked<'_> {
    /// The path with the least of what a posture wants.
    ///
    /// # Errors
    /// How far a way goes.
    pub fn path(&self, posture: Posture) -> Result<Found, NoWay> {
        self.looked(&DETAILS, posture, |ways, turned| match posture {
            Posture::Orientation => Some(self.finest(turned, posture)?.1),
            _ => self.least_of_all(ways, turned, posture),
        })
    }

    /// The same after a quick look. Where that finds a path, [`path`](Self::path) finds one, too.
    ///
    /// # Errors
    /// As [`path`](Self::path).
    pub fn quick_path(&self, posture: Posture) -> Result<Found, NoWay> {
        self.looked(&DETAILS[..1], posture, |ways, turned| {
            Some(self.finest(if posture == Posture::Orientation { turned } else { ways }, posture)?.1)
        })
    }

    fn looked(
        &self,
        details: &[(usize, f64, usize)],
        posture: Posture,
        best: impl Fn(&[Way], &[Way]) -> Option<Way>,
    ) -> Result<Found, NoWay> {
        let rough = Search::on(self, Stations::of(self.curves, self.law, ROUGH.0), ROUGH.1);
        let starts = self.space.sheets(rough.stations.places[0], self.b);
        let mut refused = NoWay::Ends { share: 0.0 };
        for detail in details {
            let why = match rough.layers(&starts, *detail) {
                Err(at) => NoWay::Ends { share: rough.stations.done(at) },
                Ok(layers) => {
                    let is_held = posture == Posture::Orientation;
                    let turned = rough.oriented(&layers, self.hand.1.filter(|_| is_held));
                    let ways = if is_held { Vec::new() } else { rough.ways(&layers, turned.first()) };
                    if let Some(way) = best(&ways, &turned) {
                        return Ok(Found { tables: way.tables });
                    }
                    if is_held && turned.is_empty() { NoWay::Turns } else { NoWay::Abrupt }
                }
            };
            refused = if why.rank() > refused.rank() { why } else { refused };
        }
        Err(refused)
    }

    /// The one with the least of what a posture wants among the best ways by every goal, those that keep the orientation,
    /// and what every goal makes of them: whichever posture is wanted, the same ways are compared.
    fn least_of_all(&self, ways: &[Way], turned: &[Way], posture: Posture) -> Option<Way> {
        let closes = ways.iter().any(|way| way.closed);
        let turned: Vec<Way> = turned.iter().filter(|way| way.closed || !closes).cloned().collect();
        let mut all: Vec<Way> = Vec::new();
        for own in [Posture::LeastRates, Posture::LeastTorque, Posture::MidRange, Posture::Orientation] {
            let Some((fine, way)) = self.finest(if own == Posture::Orientation { &turned } else { ways }, own) else {
                continue;
            };
            let others = (0..GOALS.len()).filter(|goal| GOALS[*goal] != own);
            all.extend(others.filter_map(|goal| fine.refined(&fine.held(), goal, &way.q, way.closed).ok()));
            all.push(way);
        }
        let goal = goal_of(posture);
        all.into_iter().min_by(|x, y| x.values[goal].total_cmp(&y.values[goal]))
    }

    /// The best of rough ways, made fine, and on which stations; with more of them where they turn sharply.
    fn finest(&self, ways: &[Way], posture: Posture) -> Option<(Search<'_>, Way)> {
        let mut fine = Search::on(self, Stations::of(self.curves, self.law, FINE.0), FINE.1);
        for _ in 0..=MAX_PARTINGS {
            match fine.finest(ways, goal_of(posture), posture == Posture::Orientation) {
                Ok(way) => return Some((fine, way)),
                Err(Missed::Between(marked)) if fine.stations.places.len() < MAX_STATIONS => {
                    fine = Search::on(self, fine.stations.parted(self.curves, self.law, &marked), FINE.1);
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
    fn on(asked: &'a Asked<'a>, stations: Stations, done: f64) -> Self {
        let (space, n) = (asked.space, asked.space.drives());
        let weights = Postures::of(asked.machine, space);
        let one = |k: usize| PerDrive::from_fn(n, |l| f64::from(u8::from(k == l)));
        let none = PerDrive::zeros(n);
        let bounds = space.joints().iter().filter(|joint| joint.bounds()[0].is_finite()).map(|joint| {
            let offset = joint.of(&none);
            Bound { row: PerDrive::from_fn(n, |k| joint.of(&one(k)) - offset), offset, limits: joint.limits() }
        });
        let bounds = bounds.collect();
        let centre = lifted(space, &space.middle(), asked.b);
        let goal = |terms: Vec<Term>| Goal { terms, centre };
        let all = even(n);
        let rates = goal(vec![Term::rates(&stations, all), Term::smooth(&stations, all, 1.0)]);
        let torque = weights.torque;
        let slow: Weight =
            std::array::from_fn(|k| std::array::from_fn(|l| torque[k][l] + LIGHT_DRIVE_WEIGHT * all[k][l]));
        let torques = goal(vec![
            Term::accelerations(&stations, torque),
            Term::rates(&stations, scaled(&all, BESIDE_TORQUE)),
            Term::smooth(&stations, slow, SMOOTHNESS_WEIGHT),
        ]);
        let middle = BESIDE_MIDDLE.map(|beside| {
            let own = scaled(&all, beside);
            goal(vec![
                Term::places(&stations, weights.ranges()),
                Term::rates(&stations, own),
                Term::smooth(&stations, own, 1.0),
            ])
        });
        let goals = [vec![rates], vec![torques], middle.to_vec()];
        Self { asked, stations, weights, bounds, goals, done }
    }

    fn held(&self) -> Held<'a> {
        Held { space: self.asked.space, b: self.asked.b, hand: None }
    }

    fn layers(&self, starts: &[PerDrive], (layers, finer, most): (usize, f64, usize)) -> Result<Layers<'a>, usize> {
        let freedoms = self.held().freedoms();
        let apart = finer * POSE_SPACING[freedoms.clamp(1, POSE_SPACING.len()) - 1];
        Layers::of((self.asked.space, self.asked.b), &self.stations, starts, Detail { layers, apart, most })
    }

    /// Ways over the layers, refined, and from one that keeps the orientation; those of closed curves that close, if there
    /// are any.
    fn ways(&self, layers: &Layers<'_>, turned: Option<&Way>) -> Vec<Way> {
        let closings: &[bool] = if self.asked.closed { &[true, false] } else { &[false] };
        for closed in closings {
            let mut ways: Vec<Way> = Vec::new();
            for goal in 0..GOALS.len() {
                let route = self.route(layers, goal, *closed);
                ways.extend(route.and_then(|route| self.refined(&self.held(), goal, &route, *closed).ok()));
            }
            if ways.is_empty() {
                continue;
            }
            ways.extend(turned.filter(|way| !closed || way.closed).cloned());
            self.crossed(&mut ways, *closed);
            return ways;
        }
        Vec::new()
    }

    /// Adds what each goal makes of the best way of every other one, until none gains.
    fn crossed(&self, ways: &mut Vec<Way>, closed: bool) {
        let mut tried: Vec<(usize, usize)> = Vec::new();
        for _ in 0..3 {
            let before = ways.len();
            for i in 0..GOALS.len() {
                for from in 0..before {
                    let Some(best) = least(ways, i) else { return };
                    if tried.contains(&(i, from)) || apart(&ways[best].q, &ways[from].q) < SAME_PATH {
                        continue;
                    }
                    // Only what is the best of something is worth it, at first whatever there is.
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

    /// The best of the rough ways that are worth it, on these stations; `turned` where they keep the orientation that
    /// they have.
    fn finest(&self, ways: &[Way], goal: usize, turned: bool) -> Result<Way, Missed> {
        let mut order: Vec<&Way> = ways.iter().collect();
        order.sort_by(|x, y| x.values[goal].total_cmp(&y.values[goal]));
        let mut best: Option<Way> = None;
        let mut missed = Missed::Elsewhere;
        let (mut dearest, mut count) = (f64::INFINITY, 0);
        let mut before: Vec<&Way> = Vec::new();
        for way in order {
            if way.values[goal] > dearest || count >= MAX_MADE_FINE {
                break;
            }
            if before.iter().any(|other| apart(&other.q, &way.q) < SAME_PATH) {
                continue;
            }
            before.push(way);
            let held = Held { hand: way.hand, ..self.held() };
            let Some(start) = self.placed(way, &held) else { continue };
            match self.refined(&if turned { held } else { self.held() }, goal, &start, way.closed) {
                Ok(made) => {
                    dearest = dearest.min((1.0 + MAX_DEARER_SHARE) * way.values[goal]);
                    count += 1;
                    let better = best.as_ref().is_none_or(|best| made.values[goal] < best.values[goal]);
                    best = if better { Some(made) } else { best };
                }
                // The spaces of the cheapest such way.
                Err(why) => {
                    let is_first = matches!((&missed, &why), (Missed::Elsewhere, Missed::Between(_)));
                    count += usize::from(matches!(why, Missed::Between(_)));
                    missed = if is_first { why } else { missed };
                }
            }
        }
        best.ok_or(missed)
    }

    /// The poses of a rough way at these stations.
    fn placed(&self, way: &Way, held: &Held<'_>) -> Option<Vec<PerDrive>> {
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
        // By layer that is left: how far s goes, and for how long.
        let spans: Vec<[f64; 2]> = layers
            .all
            .windows(2)
            .map(|w| {
                let leg = leg_of(w[0].at);
                let s = [w[0].at, w[1].at].map(|at| leg.s[at - leg.first]);
                let t = s.map(|s| leg.profile.when(s));
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

    /// The best way beside another one by a goal.
    fn refined(&self, held: &Held<'_>, goal: usize, start: &[PerDrive], closed: bool) -> Result<Way, Missed> {
        let mut best: Result<Way, Missed> = Err(Missed::Elsewhere);
        let mut q = start.to_vec();
        for goal in &self.goals[goal] {
            match self.kept(held, goal, &q, closed) {
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

    /// The same within the limits between stations as well, but where only a rough path is wanted.
    fn kept(&self, held: &Held<'_>, goal: &Goal, start: &[PerDrive], closed: bool) -> Result<Way, Missed> {
        let mut bounds = self.bounds.clone();
        let mut q = start.to_vec();
        let rough = self.done >= ROUGH.1;
        let on_curve = held.space.farthest() * if rough { NEAR_CURVE } else { ON_CURVE };
        for i in 0..MAX_MARGINS {
            let refining = Refining { held, stations: &self.stations, bounds: &bounds, closed, done: self.done };
            q = refining.refined(goal, &q).ok_or(Missed::Elsewhere)?;
            let tables = emit::tables(held, &self.stations, &q).ok_or(Missed::Elsewhere)?;
            let off = emit::off_curve(held, &self.stations, &tables);
            if off.iter().flatten().any(|off| off.is_nan()) {
                return Err(Missed::Elsewhere);
            }
            if off.iter().flatten().any(|off| *off > on_curve) {
                let marks = off.iter().map(|leg| leg.iter().map(|off| *off > on_curve).collect());
                return Err(Missed::Between(marks.collect()));
            }
            let past = emit::past(&self.bounds, &self.stations, &tables);
            let worst = past.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            if rough || worst <= KEPT || (i + 1 == MAX_MARGINS && worst <= AT_LIMIT) {
                let values = self.values(&tables);
                let closed = closed || gap(&q) < KEPT;
                return Ok(Way { q, tables, closed, hand: held.hand, values });
            }
            for (bound, past) in bounds.iter_mut().zip(&past) {
                if *past > KEPT {
                    let [low, high] = bound.limits;
                    let margin = (1.5 * past).min(0.25 * (high - low));
                    bound.limits = [low + margin, high - margin];
                }
            }
        }
        Err(Missed::Elsewhere)
    }

    fn values(&self, tables: &[PathTable]) -> [f64; GOALS.len()] {
        let (stations, weights) = (&self.stations, &self.weights);
        [
            emit::rates(stations, tables, &even(self.asked.space.drives())),
            emit::accelerations(stations, tables, &weights.torque),
            emit::places(stations, tables, |q| weights.off_middle(&DriveAngles(*q))),
        ]
    }

    /// The ways that keep the orientation of the last link, at any angle or a given one, those of the least rates first.
    fn oriented(&self, layers: &Layers<'_>, angle: Option<f64>) -> Vec<Way> {
        let (asked, places) = (self.asked, &self.stations.places);
        let drive = asked.hand.0;
        let starts: Vec<PerDrive> = match angle {
            Some(angle) => {
                let all = asked.space.facing(places[0], asked.b, (drive, angle), &asked.space.middle());
                all.into_iter().map(|q| q.0).collect()
            }
            None => {
                let all = &layers.all[0].poses;
                all.iter().step_by(all.len().div_ceil(ORIENTATIONS)).copied().collect()
            }
        };
        let held = |q: &PerDrive| Held { hand: Some((drive, q[drive])), ..self.held() };
        let mut found: Vec<(f64, Vec<PerDrive>)> = Vec::new();
        for q in starts {
            let Some(path) = followed(&held(&q), &q, places) else { continue };
            let cost = path.windows(2).map(|w| w[1].minus(&w[0])).map(|step| step.dot(&step)).sum();
            let is_free = held(&q).freedoms() > 0;
            if is_free || path.iter().all(|q| self.bounds.iter().all(|bound| bound.past(q) <= AT_LIMIT)) {
                found.push((cost, path));
            }
        }
        found.sort_by(|x, y| x.0.total_cmp(&y.0));
        let ways = found.into_iter().filter_map(|(_, path)| {
            self.refined(&held(&path[0]), 0, &path, false).ok().filter(|way| self.is_kept(way))
        });
        let mut ways: Vec<Way> = ways.take(2 * MAX_MADE_FINE).collect();
        ways.sort_by(|x, y| x.values[0].total_cmp(&y.values[0]));
        ways
    }

    /// Whether limits are kept at all stations, as nearly as a rough path keeps them.
    fn is_kept(&self, way: &Way) -> bool {
        way.q.iter().all(|q| self.bounds.iter().all(|bound| bound.past(q) <= 1e-3))
    }
}

/// Poses along places, each the one beside the one before.
fn followed(held: &Held<'_>, start: &PerDrive, places: &[Vector]) -> Option<Vec<PerDrive>> {
    let mut path: Vec<PerDrive> = vec![*start];
    for p in &places[1..] {
        let last = path[path.len() - 1];
        // As it went on so far.
        let guess = match path.len() {
            1 => last,
            many => last.plus(1.0, &last.minus(&path[many - 2])),
        };
        path.push(held.onto(&guess, *p).filter(|q| q.minus(&last).max_abs() < 0.5)?);
    }
    Some(path)
}

/// The way with the least of a goal.
fn least(ways: &[Way], goal: usize) -> Option<usize> {
    (0..ways.len()).min_by(|x, y| ways[*x].values[goal].total_cmp(&ways[*y].values[goal]))
}

/// By how much two paths differ at most, rad.
fn apart(p: &[PerDrive], q: &[PerDrive]) -> f64 {
    p.iter().zip(q).map(|(p, q)| p.minus(q).max_abs()).fold(0.0, f64::max)
}

/// By how much the end of a path differs from its start, rad.
fn gap(q: &[PerDrive]) -> f64 {
    q[q.len() - 1].minus(&q[0]).max_abs()
}
