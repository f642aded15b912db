//! Change points: two drives are parallel, sin(q_k − q_l) = 0, and the linkage is flat.
//!
//! q_l − q_k = n · a + δ with components of n in {−1, 0, 1}, independent of b. In (a_1, a_2) the change points of a
//! pair are therefore straight lines, half a turn of q_l − q_k apart. The number of half turns identifies the side of a
//! pose. Pin forces grow without bound towards change points; the torques do not.

use std::f64::consts::PI;

use super::plane::{AngleLimit, PlaneMap};

/// The pairs (k, l) of drives, counted from 0, in the order of [`PlaneMap::sides`] and [`PlaneMap::sines`].
pub const DRIVE_PAIRS: [[usize; 2]; 3] = [[0, 1], [1, 2], [0, 2]];

/// Poses at most this far from a change point are treated as on it, rad.
pub(super) const CHANGE_POINT_MARGIN: f64 = 1e-9;

/// The difference q_l − q_k = n · a + δ of a pair of drives.
#[derive(Clone, Copy, Debug)]
pub(super) struct AngleDifference {
    pub n: [f64; 2],
    delta: f64,
}

impl AngleDifference {
    pub fn of(map: &PlaneMap, pair: usize) -> Self {
        let [k, l] = DRIVE_PAIRS[pair];
        let (u, v) = (map.u(), map.v());
        Self { n: [0, 1].map(|j| (u[l][j] - u[k][j]).round()), delta: v[l] - v[k] }
    }

    pub fn at(&self, a: [f64; 2]) -> f64 {
        self.n[0] * a[0] + self.n[1] * a[1] + self.delta
    }

    /// Returns n · a where the difference is a given number of half turns, rad.
    pub fn level(&self, half_turns: f64) -> f64 {
        half_turns * PI - self.delta
    }

    /// Returns the least and greatest difference within limits, rad.
    pub fn range(&self, limits: [AngleLimit; 2]) -> [f64; 2] {
        let ends = |j: usize| [self.n[j] * limits[j].min, self.n[j] * limits[j].max];
        let [first, second] = [ends(0), ends(1)];
        [
            self.delta + first[0].min(first[1]) + second[0].min(second[1]),
            self.delta + first[0].max(first[1]) + second[0].max(second[1]),
        ]
    }

    /// Returns the ends of the line at a number of half turns, within limits; `None` if it is oblique and outside.
    pub fn segment(&self, limits: [AngleLimit; 2], half_turns: f64) -> Option<[[f64; 2]; 2]> {
        let level = self.level(half_turns);
        // The coordinate that parametrises the line: a_2 if a_1 is constant, else a_1.
        let run = usize::from(self.n[1] == 0.0);
        let (slope, other) = (self.n[run], 1 - run);
        let point = |y: f64| {
            let mut a = [y; 2];
            a[other] = (level - slope * y) / self.n[other];
            a[other] = a[other].clamp(limits[other].min, limits[other].max);
            a
        };
        let (mut low, mut high) = (limits[run].min, limits[run].max);
        if slope != 0.0 {
            let ends = [limits[other].min, limits[other].max].map(|x| (level - self.n[other] * x) / slope);
            (low, high) = (low.max(ends[0].min(ends[1])), high.min(ends[0].max(ends[1])));
        }
        (high > low).then(|| [point(low), point(high)])
    }
}

impl PlaneMap {
    /// Returns sin(q_l − q_k) of each pair of [`DRIVE_PAIRS`], the same for every b: 0 at a change point, with opposite
    /// signs on its two sides.
    #[inline]
    pub fn sines(&self, a: [f64; 2]) -> [f64; 3] {
        [0, 1, 2].map(|pair| AngleDifference::of(self, pair).at(a).sin())
    }

    /// Returns min |sin(q_k − q_l)|, which measures how well the parallelograms transmit forces: 0 at a change point.
    pub fn least_transmission(&self, a: [f64; 2]) -> f64 {
        self.sines(a).iter().fold(1.0, |least: f64, s| least.min(s.abs()))
    }

    /// Returns the side of a pose for each pair of [`DRIVE_PAIRS`]: m with mπ ≤ q_l − q_k < (m + 1)π. The straight line
    /// in (a_1, a_2) between two poses with equal sides crosses no change point.
    pub fn sides(&self, a: [f64; 2]) -> [i32; 3] {
        [0, 1, 2].map(|pair| (AngleDifference::of(self, pair).at(a) / PI).floor() as i32)
    }
}
