//! The pose nearest to a point out of reach, for four and more drives.
//!
//! # Method
//! The distance from the point has many local minima. Turning one relative angle at constant b moves the end effector
//! along a known curve, and two angles span a grid of known points. From samples of all joint ranges, each angle in turn
//! is set to the best of a grid over its whole range. From this pose and from the sample, Newton's iteration
//! converges to local minima. Beside the nearest minimum not yet tried, grids over pairs of angles give new starts.
//! This is repeated until all minima that are kept have been tried, at most `MAX_JUMPS` times.

use std::array::from_fn;

use super::space::PoseSpace;
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, Vector, unit};

/// Number of samples of all joint ranges.
const SAMPLES: usize = 24;
/// Maximum number of sweeps over all angles from a sample.
const MAX_SWEEPS: usize = 4;
/// Number of grid points over the range of an angle, alone and in a pair.
const GRID: usize = 24;
const PAIR_GRID: usize = 12;
/// Number of local minima that are kept.
const MINIMA: usize = 4;
/// Number of pairs of angles from which Newton's iteration starts beside a minimum.
const DESCENTS: usize = 10;
/// Maximum number of minima beside which others are sought.
const MAX_JUMPS: usize = 6;
/// Poses that differ by less are one, rad.
const SAME_POSE_RAD: f64 = 0.05;
/// Another pose is preferred if it is nearer by at least this fraction of the reach.
const MIN_IMPROVEMENT: f64 = 1e-4;
/// Factors by which the arms c_k e^{iq_k} of a pose are multiplied if one angle moves to each place of its grid.
type Turns<const COUNT: usize> = [[Vector; MAX_DRIVES]; COUNT];

/// Different poses and their distances from a point, m; the nearest ones first.
struct NearestFew<const COUNT: usize> {
    all: [(PerDrive, f64); COUNT],
}

impl<const COUNT: usize> NearestFew<COUNT> {
    fn none(n: usize) -> Self {
        Self { all: from_fn(|_| (PerDrive::zeros(n), f64::INFINITY)) }
    }

    /// Adds a pose if it is among the nearest. Of poses that hardly differ, the nearest one is kept.
    fn add(&mut self, a: PerDrive, off: f64) {
        let same = |(other, far): &(PerDrive, f64)| far.is_finite() && other.minus(&a).max_abs() < SAME_POSE_RAD;
        let last = match self.all.iter().position(same) {
            Some(i) if self.all[i].1 <= off => return,
            Some(i) => i,
            None => COUNT - 1,
        };
        if off < self.all[last].1 {
            let place = self.all.partition_point(|(_, other)| *other <= off);
            self.all[place..=last].rotate_right(1);
            self.all[place] = (a, off);
        }
    }

    fn found(&self) -> impl Iterator<Item = &(PerDrive, f64)> {
        self.all.iter().filter(|(_, off)| off.is_finite())
    }
}

impl PoseSpace {
    /// Returns the pose nearest to p, m, and its distance, m; the given pose unless another is clearly nearer.
    pub(super) fn nearest_of_all(&self, p: Vector, b: f64, a: PerDrive, off: f64) -> (PerDrive, f64) {
        let reach = self.farthest();
        let mut minima = NearestFew::<MINIMA>::none(self.joints.len());
        minima.add(a, off);
        for i in 0..SAMPLES {
            let sample = self.sample(i);
            for start in [self.swept(p, b, sample), sample] {
                let (a, off) = self.drag_to(p, b, &start);
                minima.add(a, off);
            }
        }
        let mut tried = NearestFew::<{ MINIMA * MAX_JUMPS }>::none(self.joints.len());
        for _ in 0..MAX_JUMPS {
            let is_new = |(a, _): &&(PerDrive, f64)| tried.found().all(|(b, _)| a.minus(b).max_abs() >= SAME_POSE_RAD);
            let Some((from, off)) = minima.found().find(is_new).copied() else { break };
            tried.add(from, off);
            for (start, _) in self.beside_in_pairs(p, b, &from).found() {
                let (a, off) = self.drag_to(p, b, start);
                minima.add(a, off);
            }
        }
        let best = minima.all[0];
        if best.1 < off - MIN_IMPROVEMENT * reach { best } else { (a, off) }
    }

    /// Sets each angle in turn to the place of its grid that brings the end effector nearest to p, if that is nearer.
    fn swept(&self, p: Vector, b: f64, mut a: PerDrive) -> PerDrive {
        let mut off = (self.end_effector(&self.lift(&a, b)) - p).norm();
        for _ in 0..MAX_SWEEPS {
            let before = off;
            for i in 0..a.len() {
                let arms = self.placed_arms(&a, b);
                let turns = self.turns::<GRID>(i, &a);
                for (j, turn) in turns.iter().enumerate() {
                    let there = arms.iter().zip(turn).map(|(arm, turn)| arm * turn).sum::<Vector>();
                    if (there - p).norm() < off {
                        off = (there - p).norm();
                        a[i] = self.grid_angle::<GRID>(i, j);
                    }
                }
            }
            if off >= before {
                break;
            }
        }
        a
    }

    /// Returns for each pair of angles the nearest pose of its grid, if that is among the nearest of all pairs.
    fn beside_in_pairs(&self, p: Vector, b: f64, a: &PerDrive) -> NearestFew<DESCENTS> {
        let n = self.joints.len();
        let arms = self.placed_arms(a, b);
        let turns: [Turns<PAIR_GRID>; MAX_DRIVES] =
            from_fn(|i| if i < n { self.turns(i, a) } else { [[Vector::default(); MAX_DRIVES]; PAIR_GRID] });
        let mut few = NearestFew::none(n);
        // Beside the pose itself, Newton's iteration leads back to it.
        let is_far = |i: usize, k: usize| {
            let [low, high] = self.joints[i].limits;
            (self.grid_angle::<PAIR_GRID>(i, k) - a[i]).abs() > 1.5 * (high - low) / (PAIR_GRID - 1) as f64
        };
        let is_wide = |i: &usize| self.joints[*i].limits[1] - self.joints[*i].limits[0] > SAME_POSE_RAD;
        for i in (0..n).filter(is_wide) {
            for j in (i + 1..n).filter(is_wide) {
                let mut best = ([0; 2], f64::INFINITY);
                for (k, first) in turns[i].iter().enumerate() {
                    let first: [Vector; MAX_DRIVES] = from_fn(|m| arms[m] * first[m]);
                    for (l, second) in turns[j].iter().enumerate() {
                        let there = first.iter().zip(second).map(|(first, second)| first * second).sum::<Vector>();
                        let square = (there - p).norm_sqr();
                        if square < best.1 && (is_far(i, k) || is_far(j, l)) {
                            best = ([k, l], square);
                        }
                    }
                }
                let ([k, l], square) = best;
                let mut there = *a;
                (there[i], there[j]) = (self.grid_angle::<PAIR_GRID>(i, k), self.grid_angle::<PAIR_GRID>(j, l));
                few.add(there, square.sqrt());
            }
        }
        few
    }

    /// Returns the arms c_k e^{iq_k} of a pose, m; zero beyond the last drive.
    fn placed_arms(&self, a: &PerDrive, b: f64) -> [Vector; MAX_DRIVES] {
        let q = self.lift(a, b);
        from_fn(|k| if k < self.drives() { self.arms[k] * unit(q[k]) } else { Vector::default() })
    }

    /// Returns the factors of all arms when an angle turns from that of a pose to each place of its grid.
    fn turns<const COUNT: usize>(&self, i: usize, a: &PerDrive) -> Turns<COUNT> {
        let n = self.joints.len();
        let rates = self.lift_rates(&PerDrive::from_fn(n, |j| f64::from(u8::from(i == j))), 0.0);
        // All drives on one side of the joint turn alike.
        let [near, far] = self.joints[i].ends.map(|end| rates[end]);
        from_fn(|j| {
            let by = self.grid_angle::<COUNT>(i, j) - a[i];
            let [first, second] = [near, far].map(|rate| unit(by * rate));
            from_fn(|k| match () {
                () if k > n => Vector::default(),
                () if (rates[k] - near).abs() < (rates[k] - far).abs() => first,
                () => second,
            })
        })
    }

    /// Returns the angle at a place of the grid over a whole joint range, rad.
    fn grid_angle<const COUNT: usize>(&self, i: usize, j: usize) -> f64 {
        let [low, high] = self.joints[i].limits;
        low + (high - low) * j as f64 / (COUNT - 1) as f64
    }
}
