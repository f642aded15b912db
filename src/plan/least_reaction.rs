//! Leaving the plane, and transmitting as little as possible: the redundant mode.
//!
//! The end effector's motion p(u), u = t/T, is given; on one sheet q = q(x, y, b), so that b(u) within its
//! [`Corridor`] is all that is left to choose, and n_B = −D_1 b̈. The least ∫ n_B² dt is a quadratic program, the least
//! peak of |n_B| a linear one. Where a constant b serves, it is the answer, and the base feels nothing.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | u | t/T, 0 to 1 | 1 |
//! | b, b′, b″ | pose constant and derivatives by u | rad |
//! | n_B | −D_1 b″/T² | N m |
//!
//! b″ is continuous, linear between even nodes, so that n_B has no jumps between start and end; b′ = 0 at both.

use thiserror::Error;

use super::convex::Program;
use super::corridor::{Corridor, CorridorError};
use super::curve::CurvePoint;
use super::inverse::pose_along;
use super::path::{PathError, minimum_norm_path};
use super::price::PriceError;
use super::table::Table;
use crate::machine::{Chain, Inertia};
use crate::planar::DriveAngles;
use crate::reactionless::{PlaneMap, PlanePoint, SLACK};

/// Pieces of b″ unless more are asked for.
pub const SPACES: usize = 96;
/// The most pieces.
pub const MAX_SPACES: usize = 512;
/// Stations of the corridor in each piece; the program keeps every second one, and all are checked.
const STATIONS: usize = 8;
/// Between two stations that the program keeps.
const KEPT: usize = 2;
/// b keeps this far from the corridor's ends, rad, or a tenth of its width: at a fold the joints would be infinitely fast.
const MARGIN: f64 = 1e-3;
/// Where the start pose is nearer to an end than that, the margin grows over this part of the motion.
const GROWING: f64 = 0.1;
/// How often the margin is widened where the course passes the corridor's end between kept stations.
const ROUNDS: usize = 4;

/// What is to be least.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// ∫ n_B² dt.
    Rms,
    /// The peak of |n_B|, and of all motions with that peak the least ∫ n_B² dt.
    Peak,
}

/// b over u = t/T: cubic pieces, b″ continuous.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseCourse {
    /// b, b′, b″ at even u.
    nodes: Vec<[f64; 3]>,
}

/// What the base feels of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reaction {
    /// Largest |n_B|, N m.
    pub peak: f64,
    /// Root of the mean of n_B², N m.
    pub rms: f64,
}

/// A motion of the end effector with the least reaction.
#[derive(Clone, Debug)]
pub struct LeastReaction {
    corridor: Corridor,
    course: PoseCourse,
    path: Table,
    inertia: f64,
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LeastReactionError {
    /// b has no corridor.
    #[error(transparent)]
    Corridor(#[from] CorridorError),
    /// No b, or another machine.
    #[error(transparent)]
    Price(#[from] PriceError),
    /// The end effector does not rest.
    #[error("the end effector moves at u = {u}: want a motion from rest to rest, dp/du = 0 at both ends")]
    NotAtRest {
        /// 0 or 1.
        u: f64,
    },
    /// The wanted end.
    #[error("b = {b:.3} rad at the end is outside of its corridor there: want b from {low:.3} to {high:.3} rad")]
    EndOutside {
        /// rad.
        b: f64,
        /// rad.
        low: f64,
        /// rad.
        high: f64,
    },
    /// The program has no answer.
    #[error("no smooth course of b stays within its corridor ({solver}): want a shorter motion, or wider joint limits")]
    NoCourse {
        /// The solver's word.
        solver: String,
    },
    /// Not followed.
    #[error("the drives cannot follow the course of b at u = {u:.3}: it comes too near a fold")]
    NotFollowed {
        /// t/T.
        u: f64,
    },
}

impl PoseCourse {
    /// The same b throughout.
    pub fn constant(b: f64) -> Self {
        Self { nodes: vec![[b, 0.0, 0.0]; 2] }
    }

    /// From b″ at even nodes, from rest; changed by what is linear in u so that it ends at rest, and at `end` if given.
    fn integrated(start: f64, mut second: Vec<f64>, end: Option<f64>) -> Self {
        let spaces = second.len() - 1;
        let h = 1.0 / spaces as f64;
        let sum = |second: &[f64]| {
            let (mut at, mut nodes) = ([start, 0.0, second[0]], Vec::with_capacity(spaces + 1));
            nodes.push(at);
            for w in second.windows(2) {
                at = [at[0] + h * at[1] + h * h * (2.0 * w[0] + w[1]) / 6.0, at[1] + h * (w[0] + w[1]) / 2.0, w[1]];
                nodes.push(at);
            }
            (nodes, at)
        };
        let (_, last) = sum(&second);
        // ∫ (α + γ (u − ½)) du = α, and ∫ (1 − u) (α + γ (u − ½)) du = α/2 − γ/12.
        let alpha = -last[1];
        let gamma = end.map_or(0.0, |end| 12.0 * (last[0] - end + alpha / 2.0));
        for (i, x) in second.iter_mut().enumerate() {
            *x += alpha + gamma * (i as f64 * h - 0.5);
        }
        Self { nodes: sum(&second).0 }
    }

    /// b, b′, b″ at even u from 0 to 1.
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// b, b′, b″ at u, 0..1.
    pub fn at(&self, u: f64) -> [f64; 3] {
        let spaces = self.nodes.len() - 1;
        let x = u.clamp(0.0, 1.0) * spaces as f64;
        let i = (x as usize).min(spaces - 1);
        let (h, [b, first, second]) = (1.0 / spaces as f64, self.nodes[i]);
        let (d, third) = (u.clamp(0.0, 1.0) - i as f64 * h, (self.nodes[i + 1][2] - second) / h);
        [
            b + d * (first + d * (second / 2.0 + d * third / 6.0)),
            first + d * (second + d * third / 2.0),
            second + d * third,
        ]
    }

    /// Whether b never changes.
    pub fn is_constant(&self) -> bool {
        self.nodes.iter().all(|node| node[1] == 0.0 && node[2] == 0.0)
    }

    /// What the base feels of it on a machine of D_1, kg m², in a motion of `duration`, s: exact, as b″ is linear
    /// between nodes.
    pub fn reaction(&self, inertia: f64, duration: f64) -> Reaction {
        let spaces = (self.nodes.len() - 1) as f64;
        let peak = self.nodes.iter().fold(0.0_f64, |m, node| m.max(node[2].abs()));
        let squares: f64 =
            self.nodes.windows(2).map(|w| (w[0][2] * w[0][2] + w[0][2] * w[1][2] + w[1][2] * w[1][2]) / 3.0).sum();
        let scale = inertia / (duration * duration);
        Reaction { peak: scale * peak, rms: scale * (squares / spaces).sqrt() }
    }
}

impl LeastReaction {
    /// Plans b along a motion of the end effector p(u), u = t/T, that starts from a pose and rests at both ends; `end` is
    /// b at the end, rad, if it is not free.
    ///
    /// # Errors
    /// If the machine has no b, the sheet of the pose does not reach along the motion, or no smooth course fits.
    pub fn plan(
        map: &PlaneMap,
        model: &Inertia,
        curve: impl Fn(f64) -> CurvePoint,
        start: PlanePoint,
        end: Option<f64>,
        goal: Goal,
    ) -> Result<Self, LeastReactionError> {
        Self::plan_in(map, model, curve, start, end, goal, SPACES)
    }

    /// The same with b″ in that many pieces, 2 to [`MAX_SPACES`]: the answer's error falls with their square.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn plan_in(
        map: &PlaneMap,
        model: &Inertia,
        curve: impl Fn(f64) -> CurvePoint,
        start: PlanePoint,
        end: Option<f64>,
        goal: Goal,
        spaces: usize,
    ) -> Result<Self, LeastReactionError> {
        let inertia = super::price::Price::of(model, 0.0)?.inertia();
        let spaces = spaces.clamp(2, MAX_SPACES);
        let corridor = Corridor::along(map, curve, start, spaces * STATIONS)?;
        let stations = corridor.stations();
        let size: f64 = map.c().iter().map(|c| c.abs()).sum();
        for station in [&stations[0], &stations[stations.len() - 1]] {
            if station.point.first.norm() > 1e-9 * size {
                return Err(LeastReactionError::NotAtRest { u: station.u });
            }
            let given = end.filter(|_| station.u == 1.0);
            if let Some(b) = given.filter(|b| !(station.low - SLACK <= *b && *b <= station.high + SLACK)) {
                return Err(LeastReactionError::EndOutside { b, low: station.low, high: station.high });
            }
        }
        let stays = end.is_none_or(|end| end == start.b) && corridor.leaves(start.b).is_none();
        if stays {
            let course = PoseCourse::constant(start.b);
            if let Ok(path) = followed(&corridor, &course) {
                return Ok(Self { corridor, course, path, inertia });
            }
        }
        let course = planned(&corridor, end, goal, spaces)?;
        let path = followed(&corridor, &course)?;
        Ok(Self { corridor, course, path, inertia })
    }

    /// b over u.
    pub fn course(&self) -> &PoseCourse {
        &self.course
    }

    /// The drives over u = t/T; rates are q′/T, accelerations q″/T².
    pub fn path(&self) -> &Table {
        &self.path
    }

    /// Between which b it could choose.
    pub fn corridor(&self) -> &Corridor {
        &self.corridor
    }

    /// What the base feels when it takes `duration`, s.
    pub fn reaction(&self, duration: f64) -> Reaction {
        self.course.reaction(self.inertia, duration)
    }

    /// The three ways to make the same motion of the end effector in `duration`, s, and what each does to the base.
    /// `tip` and `curve` are those of the plan.
    pub fn compare(&self, tip: &Chain, curve: impl Fn(f64) -> CurvePoint, duration: f64) -> Verdicts {
        let start = self.corridor.start();
        let fixed = match self.corridor.leaves(start.b) {
            None => FixedB::Serves,
            Some(station) => FixedB::Leaves { u: station.u, low: station.low, high: station.high },
        };
        let from = DriveAngles::from(self.corridor.map().lift(start));
        let minimum_norm = minimum_norm_path(tip, from, curve).map(|path| self.judge(&path, duration));
        Verdicts { fixed, minimum_norm, least: self.reaction(duration) }
    }

    fn judge(&self, path: &Table, duration: f64) -> MinimumNorm {
        let map = self.corridor.map();
        let scale = self.inertia / (duration * duration);
        let n_b = |u: f64| scale * map.project_rates(&path.at(u).second).1.abs();
        let n = 2048;
        let (mut peak, mut squares) = (0.0_f64, 0.0);
        // Simpson's rule.
        for i in 0..=n {
            let x = n_b(f64::from(i) / f64::from(n));
            let weight = [1.0, 2.0, 4.0][if i == 0 || i == n { 0 } else { 1 + (i % 2) as usize }];
            peak = peak.max(x);
            squares += weight * x * x / (3.0 * f64::from(n));
        }
        let kept = path.nodes().iter().all(|node| {
            let a = map.project(&node.q).a;
            map.limits().iter().zip(a).all(|(limit, a)| limit.contains(a, SLACK))
        });
        let end_b = path.nodes().last().map_or(f64::NAN, |node| map.project(&node.q).b);
        MinimumNorm { reaction: Reaction { peak, rms: squares.sqrt() }, end_b, keeps_limits: kept }
    }
}

/// Three ways to make one motion of the end effector, from one pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdicts {
    /// b kept: no reaction at all, where it can be done.
    pub fixed: FixedB,
    /// Minimum-norm rates, q′ = J⁺ p′, as in case 1.
    pub minimum_norm: Result<MinimumNorm, PathError>,
    /// The least reaction.
    pub least: Reaction,
}

/// Whether the start pose's own b serves the whole motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FixedB {
    /// It does, and n_B = 0.
    Serves,
    /// From here on it does not.
    Leaves {
        /// t/T.
        u: f64,
        /// b that would serve there, rad.
        low: f64,
        /// rad.
        high: f64,
    },
}

/// The motion with minimum-norm rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MinimumNorm {
    /// What the base feels.
    pub reaction: Reaction,
    /// b at its end, rad.
    pub end_b: f64,
    /// Whether the joint limits are kept all the way.
    pub keeps_limits: bool,
}

/// The drives along a course of b, by nodes.
fn followed(corridor: &Corridor, course: &PoseCourse) -> Result<Table, LeastReactionError> {
    let map = corridor.map();
    let mut from = corridor.start().a;
    let mut nodes = Vec::with_capacity(corridor.stations().len() / KEPT + 1);
    for station in corridor.stations().iter().step_by(KEPT) {
        let b = course.at(station.u);
        let missing = LeastReactionError::NotFollowed { u: station.u };
        let on = pose_along(map, &station.point, b, from)
            .or_else(|| pose_along(map, &station.point, b, station.pose(map, b[0])?.a));
        let (at, node) = on.ok_or(missing)?;
        from = at.a;
        nodes.push(node);
    }
    Table::even(nodes).ok_or(LeastReactionError::NotFollowed { u: 0.0 })
}

/// The program, with the margin widened until the course stays within the corridor at every station.
fn planned(corridor: &Corridor, end: Option<f64>, goal: Goal, spaces: usize) -> Result<PoseCourse, LeastReactionError> {
    let mut margin = MARGIN;
    let mut rounds = 0;
    loop {
        let course = solved(corridor, end, goal, spaces, margin)?;
        let past = corridor.stations().iter().fold(0.0_f64, |most, station| {
            let b = course.at(station.u)[0];
            most.max(station.low - b).max(b - station.high)
        });
        // At the ends b is given, and may lie on the corridor's own end.
        if past <= SLACK {
            return Ok(course);
        }
        rounds += 1;
        if rounds > ROUNDS {
            return Err(LeastReactionError::NoCourse { solver: format!("{past:.1e} rad past its end between nodes") });
        }
        margin += 2.0 * past;
    }
}

/// Unknowns b − b_0, b′, b″ of each node, side by side, so that every row has few of them.
fn solved(
    corridor: &Corridor,
    end: Option<f64>,
    goal: Goal,
    spaces: usize,
    margin: f64,
) -> Result<PoseCourse, LeastReactionError> {
    let none = |solver: String| LeastReactionError::NoCourse { solver };
    let start = corridor.start().b;
    let rows = |more: usize| program(corridor, end, spaces, margin, more);
    let second = |x: &[f64]| (0..=spaces).map(|i| x[3 * i + 2]).collect::<Vec<f64>>();
    let x = match goal {
        Goal::Rms => squared(rows(0), spaces).solve().map_err(none)?,
        Goal::Peak => {
            let top = 3 * (spaces + 1);
            let mut linear = rows(1);
            linear.add_linear(top, 1.0);
            for i in 0..=spaces {
                linear.at_most([(3 * i + 2, 1.0), (top, -1.0)], 0.0);
                linear.at_most([(3 * i + 2, -1.0), (top, -1.0)], 0.0);
            }
            let peak = linear.solve().map_err(none)?[top];
            let bound = peak * (1.0 + 1e-7);
            let mut bounded = rows(0);
            for i in 0..=spaces {
                bounded.at_most([(3 * i + 2, 1.0)], bound);
                bounded.at_most([(3 * i + 2, -1.0)], bound);
            }
            squared(bounded, spaces).solve().map_err(none)?
        }
    };
    Ok(PoseCourse::integrated(start, second(&x), end))
}

/// ∫ b″² du.
fn squared(mut program: Program, spaces: usize) -> Program {
    let third = 1.0 / (3.0 * spaces as f64);
    for i in 0..spaces {
        let (x, y) = (3 * i + 2, 3 * i + 5);
        program.add_product(x, x, third);
        program.add_product(x, y, third);
        program.add_product(y, y, third);
    }
    program
}

/// What holds of every course, with room for more unknowns behind.
fn program(corridor: &Corridor, end: Option<f64>, spaces: usize, margin: f64, more: usize) -> Program {
    let start = corridor.start().b;
    let h = 1.0 / spaces as f64;
    let mut program = Program::over(3 * (spaces + 1) + more);
    program.equal([(0, 1.0)], 0.0);
    program.equal([(1, 1.0)], 0.0);
    program.equal([(3 * spaces + 1, 1.0)], 0.0);
    if let Some(end) = end {
        program.equal([(3 * spaces, 1.0)], end - start);
    }
    for i in 0..spaces {
        let [b, v, w] = [3 * i, 3 * i + 1, 3 * i + 2];
        program.equal([(v + 3, 1.0), (v, -1.0), (w, -h / 2.0), (w + 3, -h / 2.0)], 0.0);
        program.equal([(b + 3, 1.0), (b, -1.0), (v, -h), (w, -h * h / 3.0), (w + 3, -h * h / 6.0)], 0.0);
    }
    for (k, station) in corridor.stations().iter().enumerate().skip(KEPT).step_by(KEPT) {
        let i = (k / STATIONS).min(spaces - 1);
        let d = (k - i * STATIONS) as f64 / STATIONS as f64 * h;
        let cubic = d * d * d / (6.0 * h);
        let [b, v, w] = [3 * i, 3 * i + 1, 3 * i + 2];
        let row = |s: f64| [(b, s), (v, s * d), (w, s * (d * d / 2.0 - cubic)), (w + 3, s * cubic)];
        let [low, high] = narrowed(corridor, k, end, margin);
        if station.u < 1.0 || end.is_none() {
            program.at_most(row(1.0), high - start);
            program.at_most(row(-1.0), start - low);
        }
    }
    program
}

/// The corridor at a station less the margin. Where a given end of the course lies within the margin, it grows from there.
fn narrowed(corridor: &Corridor, k: usize, end: Option<f64>, margin: f64) -> [f64; 2] {
    let stations = corridor.stations();
    let (station, last) = (&stations[k], &stations[stations.len() - 1]);
    let from = |gap: f64, u: f64| margin.min(gap.max(0.0) + margin * (u / GROWING).powi(3));
    let inner = |gap: [f64; 2]| {
        let tail = if end.is_some() { from(gap[1], 1.0 - station.u) } else { margin };
        from(gap[0], station.u).min(tail).min(0.1 * (station.high - station.low))
    };
    let (b_0, b_1) = (corridor.start().b, end.unwrap_or(0.0));
    [
        station.low + inner([b_0 - stations[0].low, b_1 - last.low]),
        station.high - inner([stations[0].high - b_0, last.high - b_1]),
    ]
}
