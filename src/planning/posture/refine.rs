//! A path made better until it is the best beside it: Newton's iteration over all its poses at once.
//!
//! # Method
//! The poses q_i keep (p_i, b), so a step is Z_i z_i with the free directions Z_i of each. On them the curvature is
//! Zᵀ (∇²f + diag(ν·c_k e^{iq_k})) Z, as ∂²p/∂q_k² = −c_k e^{iq_k} with the multipliers ν of p; a banded matrix. Limits
//! are kept by multipliers that grow until no limit is passed (augmented Lagrangian). Every step comes back onto (p, b).

use super::envelope::Envelope;
use super::goal::{Goal, times};
use super::rows::{Held, Rows, arms};
use super::stations::Stations;
use crate::mechanics::planar::{PerDrive, dot};

/// Steps of Newton's iteration, and how often multipliers of limits are raised.
const MAX_STEPS: usize = 25;
const MAX_ROUNDS: usize = 10;
/// The longest step, rad.
const LONGEST: f64 = 0.3;
/// How often a step is halved.
const MAX_HALVINGS: usize = 8;
/// A limit may be passed by this much, rad.
const KEPT: f64 = 1e-9;
/// How hard limits push, as a multiple of how hard the goal does.
const PUSH: f64 = 30.0;
/// What a value may rise by rounding, a share of it.
const ROUNDING: f64 = 1e-9;

/// A relative angle and its limits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// ∂a/∂q.
    pub row: PerDrive,
    /// a at q = 0, rad.
    pub offset: f64,
    /// rad.
    pub limits: [f64; 2],
}

impl Bound {
    /// The angle, rad.
    pub fn of(&self, q: &PerDrive) -> f64 {
        self.row.dot(q) + self.offset
    }

    /// By how much a pose passes a limit, rad.
    pub fn past(&self, q: &PerDrive) -> f64 {
        let a = self.of(q);
        (self.limits[0] - a).max(a - self.limits[1])
    }
}

/// What is refined.
#[derive(Clone, Copy, Debug)]
pub(super) struct Refining<'a> {
    pub held: &'a Held<'a>,
    pub stations: &'a Stations,
    pub bounds: &'a [Bound],
    /// Whether the last pose is the first one.
    pub closed: bool,
    /// Steps below this length, rad, are the last.
    pub done: f64,
}

/// What a pose keeps, and the directions that this leaves free.
struct Frame {
    rows: Rows,
    free: Vec<PerDrive>,
}

impl Frame {
    fn of(rows: Rows) -> Self {
        Self { free: rows.free(), rows }
    }
}

/// A limit that pushes: which pose, how stiffly, and in which direction.
type Pushing = (usize, f64, PerDrive);

/// Forces of the limits on each pose.
struct Forces {
    /// For each pose and limit.
    multipliers: Vec<f64>,
    push: f64,
}

impl Refining<'_> {
    /// The path of the least goal beside another path.
    pub fn refined(&self, goal: &Goal, start: &[PerDrive]) -> Option<Vec<PerDrive>> {
        let mut q = start.to_vec();
        let d = self.held.freedoms();
        if d == 0 || q.len() < 3 {
            return Some(q);
        }
        let mut forces =
            Forces { multipliers: vec![0.0; 2 * self.bounds.len() * q.len()], push: PUSH * goal.stiffness() };
        let mut matrix = Envelope::zeros(self.profile(d, q.len()));
        for round in 0..MAX_ROUNDS {
            let done = self.done.max(1e-4 * 0.1f64.powi(2 * round as i32));
            for _ in 0..MAX_STEPS {
                let (next, moved) = self.step(goal, &q, &forces, &mut matrix)?;
                q = next;
                if moved < done {
                    break;
                }
            }
            let worst = self.raise(&q, &mut forces);
            if worst <= KEPT.max(self.done) && done <= self.done {
                break;
            }
        }
        Some(q)
    }

    /// Where the rows of the matrix begin.
    fn profile(&self, d: usize, count: usize) -> Vec<usize> {
        let rows = self.places(d, count);
        let mut first = vec![0; rows.1];
        for i in 0..count {
            let mine = rows.0(i);
            let least = (i.saturating_sub(3)..=(i + 3).min(count - 1)).map(&rows.0).min().unwrap_or(mine).min(mine);
            for k in 0..d {
                let row = mine + k;
                let least = if self.closed && (i == 0 || i == count - 1) { 0 } else { least };
                first[row] = least.min(row);
            }
        }
        first
    }

    /// Which row each pose begins with, and how many rows there are; the first pose of closed paths comes last.
    fn places(&self, d: usize, count: usize) -> (impl Fn(usize) -> usize + use<>, usize) {
        let closed = self.closed;
        let at = move |i: usize| match closed {
            true if i == 0 || i == count - 1 => (count - 2) * d,
            true => (i - 1) * d,
            false => i * d,
        };
        (at, if closed { (count - 1) * d } else { count * d })
    }

    /// What limits add to the goal.
    fn pushed(&self, q: &[PerDrive], forces: &Forces) -> f64 {
        let mut sum = 0.0;
        self.each_limit(q, |i, past, _, _| {
            let own = forces.multipliers[i];
            sum += ((own + forces.push * past).max(0.0).powi(2) - own * own) / (2.0 * forces.push);
        });
        sum
    }

    /// Each limit of each pose: its place, by how much it is passed, the pose, and the direction in which it is.
    fn each_limit(&self, q: &[PerDrive], mut what: impl FnMut(usize, f64, usize, (f64, &PerDrive))) {
        let count = self.bounds.len();
        for (i, q) in q.iter().enumerate() {
            for (j, bound) in self.bounds.iter().enumerate() {
                let a = bound.of(q);
                what(2 * (i * count + j), bound.limits[0] - a, i, (-1.0, &bound.row));
                what(2 * (i * count + j) + 1, a - bound.limits[1], i, (1.0, &bound.row));
            }
        }
    }

    /// Raises the multipliers; the answer is by how much the limits are passed at most, rad.
    fn raise(&self, q: &[PerDrive], forces: &mut Forces) -> f64 {
        let mut worst = 0.0_f64;
        let push = forces.push;
        let multipliers = &mut forces.multipliers;
        self.each_limit(q, |i, past, _, _| {
            worst = worst.max(past);
            multipliers[i] = (multipliers[i] + push * past).max(0.0);
        });
        worst
    }

    /// A step, and how long it is, rad.
    fn step(
        &self,
        goal: &Goal,
        q: &[PerDrive],
        forces: &Forces,
        matrix: &mut Envelope,
    ) -> Option<(Vec<PerDrive>, f64)> {
        let d = self.held.freedoms();
        let frames: Vec<Frame> = q.iter().map(|q| self.held.rows(q).map(Frame::of)).collect::<Option<_>>()?;
        let mut gradient = goal.gradient(q);
        let now = goal.value(q, &gradient) + self.pushed(q, forces);
        let mut stiff: Vec<Pushing> = Vec::new();
        self.each_limit(q, |i, past, at, (sign, row)| {
            let force = forces.multipliers[i] + forces.push * past;
            if force > 0.0 {
                gradient[at] = gradient[at].plus(sign * force, row);
                stiff.push((at, forces.push, *row));
            }
        });
        let (place, rows) = self.places(d, q.len());
        let mut side = vec![0.0; rows];
        for (i, (frame, gradient)) in frames.iter().zip(&gradient).enumerate() {
            (0..d).for_each(|k| side[place(i) + k] -= frame.free[k].dot(gradient));
        }
        let solved = [true, false].into_iter().find_map(|bent| {
            self.assemble(goal, q, (&frames, &gradient, &stiff), bent, matrix);
            if !matrix.factor() {
                return None;
            }
            let mut x = side.clone();
            matrix.solve(&mut x);
            let falls = x.iter().zip(&side).map(|(x, s)| x * s).sum::<f64>() >= 0.0;
            (falls && x.iter().all(|x| x.is_finite())).then_some(x)
        })?;
        let way: Vec<PerDrive> = frames
            .iter()
            .enumerate()
            .map(|(i, frame)| {
                let start = PerDrive::zeros(q[i].len());
                (0..d).fold(start, |way, k| way.plus(solved[place(i) + k], &frame.free[k]))
            })
            .collect();
        let size = way.iter().map(PerDrive::max_abs).fold(0.0, f64::max);
        let mut share = (LONGEST / size.max(1e-300)).min(1.0);
        for _ in 0..MAX_HALVINGS {
            let moved = q.iter().zip(&way).zip(&self.stations.places);
            let next: Option<Vec<PerDrive>> =
                moved.map(|((q, way), p)| self.held.onto(&q.plus(share, way), *p)).collect();
            if let Some(mut next) = next {
                if self.closed {
                    let last = next.len() - 1;
                    next[last] = next[0];
                }
                let there = goal.value(&next, &goal.gradient(&next)) + self.pushed(&next, forces);
                if there <= now + ROUNDING * now.abs() {
                    return Some((next, share * size));
                }
            }
            share *= 0.5;
        }
        Some((q.to_vec(), 0.0))
    }

    /// The curvature on the free directions; without what p bends, where that is not to count against it.
    fn assemble(
        &self,
        goal: &Goal,
        q: &[PerDrive],
        (frames, gradient, stiff): (&[Frame], &[PerDrive], &[Pushing]),
        bent: bool,
        matrix: &mut Envelope,
    ) {
        let (d, n) = (self.held.freedoms(), self.held.space.drives());
        let (place, _) = self.places(d, q.len());
        matrix.clear();
        for term in &goal.terms {
            let turned: Vec<Vec<PerDrive>> =
                frames.iter().map(|frame| frame.free.iter().map(|z| times(&term.weight, z)).collect()).collect();
            for (i, row) in term.kappa.iter().enumerate() {
                for (j, kappa) in row.iter().enumerate().filter(|(_, kappa)| **kappa != 0.0) {
                    let other = i + j;
                    for k in 0..d {
                        for (l, turned) in turned[other].iter().enumerate() {
                            let (x, y) = (place(i) + k, place(other) + l);
                            let own = kappa * frames[i].free[k].dot(turned);
                            if x >= y || (j > 0 && place(i) != place(other)) {
                                *matrix.entry(x.max(y), x.min(y)) += own;
                            }
                        }
                    }
                }
            }
        }
        for (i, frame) in frames.iter().enumerate() {
            let (nu, arm) = (frame.rows.multipliers(&gradient[i]), arms(self.held.space, &q[i]));
            let bend = PerDrive::from_fn(n, |k| {
                let own = dot(nu, arm[k]);
                if bent { own } else { own.max(0.0) }
            });
            for k in 0..d {
                for l in 0..=k {
                    let own: f64 = (0..n).map(|m| bend[m] * frame.free[k][m] * frame.free[l][m]).sum();
                    *matrix.entry(place(i) + k, place(i) + l) += own;
                }
            }
        }
        for (i, push, row) in stiff {
            for k in 0..d {
                for l in 0..=k {
                    *matrix.entry(place(*i) + k, place(*i) + l) +=
                        push * frames[*i].free[k].dot(row) * frames[*i].free[l].dot(row);
                }
            }
        }
    }
}
