//! The fastest timing of a path within limits on torque, speed, acceleration and jerk, as one smooth program.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | θ | parameter in place of s, s = 10 θ³ − 15 θ⁴ + 6 θ⁵: at rest at both ends of its own | |
//! | y, y′, y″ | θ̇³ and its derivatives by θ | 1/s³ |
//! | q′, q″, q‴ | derivatives of q by θ | rad |
//! | c_i | coefficients of y, a quadratic spline over the nodes θ_i | 1/s³ |
//!
//! # Method
//! With θ̇ = y^⅓, θ̈ = y′/(3 y^⅓) and θ⃛ = y″/3 − y′²/(9 y), T = ∫ y^−⅓ dθ is convex in y. A limit on a u + c x + g is
//! |a y′/3 + c y + g y^⅓| ≤ y^⅓, convex, and so is one on speed. Jerk is q′ y″/3 + q″ y′ + q‴ y − q′ y′²/(9 y): linear
//! but for its last term, which makes one of its two sides not convex. With θ as parameter, rest at both ends is no
//! singularity: y stays above 0 there.
//!
//! An interior-point method goes from a slow motion within all limits to the fastest, never leaving them (predictor and
//! corrector of Mehrotra; where a side is not convex its curvature is left out). Rows touch three neighbouring
//! coefficients each, so a step costs time in proportion to the nodes. It finds a local optimum.

use crate::mechanics::planar::{MAX_DRIVES, PerDrive};
use crate::planning::curves::PathPoint;
use crate::planning::curves::path::Path;
use crate::planning::timing::law::Progress;
use crate::planning::timing::limits::{ConstraintRow, Constraints, MAX_ROWS};
use crate::planning::timing::profile::Profile;

/// Where limits are kept in every space, as shares of it, each with half of its weight: two points of Gauss.
const SHARES: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];
/// Near both ends, where all changes fast, at more places, which count for no time.
const MORE: [(f64, f64); 5] = [(0.01, 0.0), (SHARES[0], 0.5), (0.5, 0.0), (SHARES[1], 0.5), (0.99, 0.0)];
const ENDS: usize = 4;
/// Points and weights of Gauss over one space, for its time.
const TIMES: [(f64, f64); 4] = [
    (0.069_431_844_202_973_7, 0.173_927_422_568_726_9),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_1),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_9),
];
/// Steps of the method, and the share of T that the bound and the motion may be apart at its end.
const STEPS: usize = 80;
const APART: f64 = 2e-4;
/// Shares of the curvature that jerk allows, for the timing to begin with.
const CURVED: [f64; 3] = [1.0, 0.1, 0.01];
/// The least share of what room is worth that a step aims for: less, and steps creep along the limits.
const CENTRE: f64 = 0.1;
/// How often a step is halved where a limit curves towards it.
const HALVED: usize = 50;
/// How near to a limit a step may go.
const SHORT: f64 = 0.99;

/// s and its derivatives by θ.
pub(super) fn eased(theta: f64) -> [f64; 4] {
    let (v, w) = (theta, 1.0 - theta);
    let s = v * v * v * (10.0 + v * (-15.0 + 6.0 * v));
    [s, 30.0 * v * v * w * w, 60.0 * v * w * (1.0 - 2.0 * v), 60.0 * (1.0 - 6.0 * v * w)]
}

/// θ of an s.
pub(super) fn uneased(s: f64) -> f64 {
    if s > 0.5 {
        return 1.0 - uneased(1.0 - s);
    }
    // Convex below the middle: from above, Newton's method falls to it.
    let mut theta = (s / 5.0).cbrt().min(0.5);
    for _ in 0..60 {
        let [at, slope, ..] = eased(theta);
        let step = (at - s) / slope;
        if step.is_nan() || step.abs() <= 1e-16 * theta {
            break;
        }
        theta -= step;
    }
    theta
}

/// A two-sided limit at a place: |v · c + g y^⅓| ≤ y^⅓, or |v · c − k y′²/y| ≤ 1 for speed and jerk; c the three
/// coefficients from the place's first.
#[derive(Clone, Copy, Default)]
struct Side {
    v: [f64; 3],
    /// g or k.
    g: f64,
    /// How far from the limit it is above and below, and what that is worth.
    room: [f64; 2],
    worth: [f64; 2],
    /// How room changes with the coefficients.
    slope: [[f64; 3]; 2],
    /// The product of both changes, as the predictor has them.
    bent: [f64; 2],
    /// Room after a step that is tried.
    next: [f64; 2],
}

impl Side {
    fn settle(&mut self) {
        self.room = self.next;
    }
}

/// A place in a space at which limits are kept.
#[derive(Clone, Copy)]
struct Place {
    theta: f64,
    first: usize,
    /// y and y′ as sums of coefficients.
    y: [f64; 3],
    slope: [f64; 3],
    /// Of the space's time.
    weight: f64,
}

/// The program on given nodes.
pub(super) struct JerkProgram {
    nodes: Vec<f64>,
    places: Vec<Place>,
    sides: Vec<Side>,
    /// Sides of a place, and how many of them are of torque and acceleration; one of speed and those of jerk follow.
    each: usize,
    linear: usize,
    /// Room of each coefficient above 0 is itself; its worth, and as for the sides.
    worth: Vec<f64>,
    bent: Vec<f64>,
}

impl JerkProgram {
    /// Of a path on nodes θ that rise from 0 to 1; θ̇² is to stay below `most`.
    pub(super) fn new(path: &Path, constraints: &Constraints, nodes: Vec<f64>, most: f64) -> Self {
        let limits = constraints.limits();
        let jerked: Vec<usize> = (0..limits.jerk.len()).filter(|k| limits.jerk[*k].is_finite()).collect();
        let linear = constraints.rows().len();
        let (each, spaces) = (linear + 1 + jerked.len(), nodes.len() - 1);
        let mut places = Vec::with_capacity(2 * spaces);
        let mut sides = Vec::with_capacity(2 * spaces * each);
        let mut rows = [ConstraintRow::default(); MAX_ROWS];
        let rows = &mut rows[..linear];
        let mut speeds = [0.0; MAX_DRIVES];
        let speeds = &mut speeds[..constraints.speeds()];
        for i in 0..spaces {
            let (h, shares) = (nodes[i + 1] - nodes[i], [share(&nodes, i), share(&nodes, i + 1)]);
            let near_end = i < ENDS || i + ENDS >= spaces;
            let own = if near_end { &MORE[..] } else { &SHARES.map(|at| (at, 0.5)) };
            for &(at, weight) in own {
                let back = 1.0 - at;
                let by = |w: [f64; 3]| spread(w, shares);
                let y = by([back * back, 2.0 * at * back, at * at]);
                let slope = by([-back, back - at, at].map(|w| 2.0 / h * w));
                let bend = by([1.0, -2.0, 1.0].map(|w| 2.0 / (h * h) * w));
                let theta = nodes[i] + at * h;
                let (point, third) = reckoned(path, theta);
                let cap = constraints.at(&point, rows, speeds).min(most);
                let sum = |p: f64, q: f64, r: f64| [0, 1, 2].map(|k| p * bend[k] + q * slope[k] + r * y[k]);
                let side = |v, g| Side { v, g, ..Side::default() };
                sides.extend(rows.iter().map(|row| side(sum(0.0, row.a / 3.0, row.c), row.g)));
                sides.push(side(y.map(|y| y / cap.powf(1.5)), 0.0));
                let motors = constraints.motors();
                let [first, second, third] = [&point.first, &point.second, &third].map(|x| motors.turns(x));
                sides.extend(jerked.iter().map(|k| {
                    let per = 1.0 / limits.jerk[*k];
                    let (a, b, c) = (per * first[*k], per * second[*k], per * third[*k]);
                    side(sum(a / 3.0, b, c), a / 9.0)
                }));
                places.push(Place { theta, first: i, y, slope, weight: weight * h });
            }
        }
        let count = nodes.len() + 1;
        Self { nodes, places, sides, each, linear, worth: vec![0.0; count], bent: vec![0.0; count] }
    }

    /// The fastest timing; `None` if there is none that moves. `bound` is a θ̇² that no motion surpasses at a θ,
    /// `before` a timing on other nodes to begin from.
    pub(super) fn solve(mut self, bound: impl Fn(f64) -> f64, before: Option<&Timing>) -> Option<Timing> {
        let count = self.worth.len();
        let mut best: Option<(f64, Vec<f64>)> = None;
        let last = self.nodes.len() - 1;
        let place = |j: usize| 0.5 * (self.nodes[j.saturating_sub(1)] + self.nodes[j.min(last)]);
        let begun = before.map(|before| (0..count).map(|j| before.at(place(j))).collect());
        let made = if begun.is_some() { &[][..] } else { &CURVED };
        for start in begun.into_iter().chain(made.iter().filter_map(|share| self.start(&bound, *share))) {
            let Some(start) = self.within(start) else { continue };
            let time = self.time(&start);
            if best.as_ref().is_none_or(|(least, _)| time < *least) {
                best = Some((time, start));
            }
        }
        let mut c = best?.1;
        let many = (2 * self.sides.len() + count) as f64;
        if !self.measure(&c, 0.0) {
            return None;
        }
        let mut time = self.time(&c);
        for side in &mut self.sides {
            side.worth = side.room.map(|room| time / many / room);
        }
        self.worth.iter_mut().zip(&c).for_each(|(worth, c)| *worth = time / many / c);
        let mut gap = self.gap(&c);
        let mut band = Band::new(count);
        let (mut step, mut next) = (vec![0.0; count], c.clone());
        for _ in 0..STEPS {
            self.assemble(&c, &mut band);
            band.factor()?;
            // As if no limit were to push back: how far would that go?
            self.bent.fill(0.0);
            self.sides.iter_mut().for_each(|side| side.bent = [0.0; 2]);
            self.push(&c, 0.0, &mut step);
            band.solve(&mut step);
            let (primal, dual) = self.reach(&c, &step, 0.0, 1.0);
            let left = self.left(&c, &step, primal, dual);
            let centre = (left / gap).powi(3).clamp(CENTRE, 1.0) * gap / many;
            self.bend(&c, &step);
            self.push(&c, centre, &mut step);
            band.solve(&mut step);
            let (mut primal, dual) = self.reach(&c, &step, centre, SHORT);
            self.revalue(&c, &step, centre, dual);
            // Where a limit curves towards the step, less of it.
            let mut halved = 0;
            loop {
                next.iter_mut().zip(c.iter().zip(&step)).for_each(|(next, (c, step))| *next = c + primal * step);
                if self.measure(&next, 1.0 - SHORT) {
                    break;
                }
                halved += 1;
                if halved > HALVED {
                    return None;
                }
                primal *= 0.5;
            }
            self.sides.iter_mut().for_each(|side| side.settle());
            c.copy_from_slice(&next);
            let last = time;
            (time, gap) = (self.time(&c), self.gap(&c));
            if !time.is_finite() {
                return None;
            }
            if gap < APART * time && (last - time).abs() < APART * time {
                break;
            }
        }
        Some(Timing { nodes: self.nodes, c })
    }

    /// A timing within all limits, to begin with: below what each place bears by itself, with no more than a curvature
    /// that jerk allows, of which a share is taken.
    fn start(&self, bound: &impl Fn(f64) -> f64, share: f64) -> Option<Vec<f64>> {
        let mut bend = f64::INFINITY;
        let mut alone = Vec::with_capacity(self.places.len());
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let theta = place.theta;
            let mut least = bound(theta).powf(1.5);
            for (i, side) in sides.iter().enumerate() {
                let v = side.v.iter().sum::<f64>().abs();
                if i < self.linear {
                    least = least.min(((1.0 - side.g.abs()) / v).powf(1.5));
                } else {
                    least = least.min(1.0 / v);
                    // θ⃛ of y = m + bend θ² is at most 2/3 of the bend.
                    bend = bend.min(if side.g == 0.0 { f64::INFINITY } else { 1.0 / (6.0 * side.g.abs()) });
                }
            }
            alone.push((theta, least));
        }
        if bend.is_nan() || bend <= 0.0 {
            return None;
        }
        // From below by parabolas that open upwards, then from inside by ones that open downwards: what is left has no
        // more curvature than they have (Lasry and Lions).
        let bend = share * bend;
        let low = |theta: f64| {
            alone.iter().map(|(at, most)| most + 0.5 * bend * (theta - at) * (theta - at)).fold(f64::INFINITY, f64::min)
        };
        let lows: Vec<(f64, f64)> = alone.iter().map(|(at, _)| (*at, low(*at))).collect();
        let high = |theta: f64| {
            lows.iter().map(|(at, low)| low - bend * (theta - at) * (theta - at)).fold(f64::NEG_INFINITY, f64::max)
        };
        let last = self.nodes.len() - 1;
        let place = |j: usize| 0.5 * (self.nodes[j.saturating_sub(1)] + self.nodes[j.min(last)]);
        let c: Vec<f64> = (0..self.worth.len()).map(|j| high(place(j))).collect();
        c.iter().all(|c| *c > 0.0 && c.is_finite()).then_some(c)
    }

    /// A timing as slow as it must be to keep well within all limits.
    fn within(&self, mut c: Vec<f64>) -> Option<Vec<f64>> {
        let mut factor: f64 = f64::INFINITY;
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let c = &c[place.first..];
            let (y, slope) = (dot(&place.y, c), dot(&place.slope, c));
            for (i, side) in sides.iter().enumerate() {
                let value = dot(&side.v, c);
                factor = factor.min(if i < self.linear {
                    ((1.0 - side.g.abs()) * y.cbrt() / value.abs()).powf(1.5)
                } else {
                    1.0 / (value - side.g * slope * slope / y).abs()
                });
            }
        }
        c.iter_mut().for_each(|c| *c *= 0.7 * factor);
        (factor > 0.0 && factor.is_finite()).then_some(c)
    }

    /// T of a timing, s.
    fn time(&self, c: &[f64]) -> f64 {
        self.places.iter().map(|p| p.weight / dot(&p.y, &c[p.first..]).cbrt()).sum()
    }

    /// What all room is worth.
    fn gap(&self, c: &[f64]) -> f64 {
        let own: f64 = self.worth.iter().zip(c).map(|(worth, c)| worth * c).sum();
        own + self.sides.iter().map(|s| s.worth[0] * s.room[0] + s.worth[1] * s.room[1]).sum::<f64>()
    }

    /// Takes new room on every side from coefficients; whether at least a share of all is left.
    fn measure(&mut self, c: &[f64], share: f64) -> bool {
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact_mut(self.each)) {
            let c = &c[place.first..];
            let (y, slope) = (dot(&place.y, c), dot(&place.slope, c));
            if y.is_nan() || y <= 0.0 {
                return false;
            }
            let (root, squares) = (y.cbrt(), slope * slope / y);
            for (i, side) in sides.iter_mut().enumerate() {
                let value = dot(&side.v, c);
                let new = if i < self.linear {
                    [(1.0 - side.g) * root - value, (1.0 + side.g) * root + value]
                } else {
                    let value = value - side.g * squares;
                    [1.0 - value, 1.0 + value]
                };
                if !(new[0] > share * side.room[0] && new[1] > share * side.room[1]) {
                    return false;
                }
                side.next = new;
            }
        }
        if share == 0.0 {
            self.sides.iter_mut().for_each(Side::settle);
        }
        true
    }

    /// The matrix of a step, and the slopes of all room.
    fn assemble(&mut self, c: &[f64], band: &mut Band) {
        band.clear();
        for (i, (worth, c)) in self.worth.iter().zip(c).enumerate() {
            band.rows[i][0] = worth / c;
        }
        let linear = self.linear;
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact_mut(self.each)) {
            let c = &c[place.first..];
            let (y, rate) = (dot(&place.y, c), dot(&place.slope, c));
            let (root, r) = (y.cbrt(), rate / y);
            let steep = 1.0 / (3.0 * root * root);
            let mut sum = [0.0; 6];
            let (mut bow, mut curl) = (4.0 / 9.0 * place.weight / (y * y * root), 0.0);
            for (i, side) in sides.iter_mut().enumerate() {
                let v = side.v;
                if i < linear {
                    let by = [(1.0 - side.g) * steep, (1.0 + side.g) * steep];
                    side.slope =
                        [[0, 1, 2].map(|k| by[0] * place.y[k] - v[k]), [0, 1, 2].map(|k| by[1] * place.y[k] + v[k])];
                    bow += 2.0 / 3.0 / y * (side.worth[0] * by[0] + side.worth[1] * by[1]);
                } else {
                    let g = side.g;
                    let up = [0, 1, 2].map(|k| v[k] - g * r * (2.0 * place.slope[k] - r * place.y[k]));
                    side.slope = [up.map(|x| -x), up];
                    // Of the two sides one is convex.
                    curl += 2.0 / y * if g > 0.0 { g * side.worth[1] } else { -g * side.worth[0] };
                }
                add(&mut sum, side.worth[0] / side.room[0], &side.slope[0]);
                add(&mut sum, side.worth[1] / side.room[1], &side.slope[1]);
            }
            add(&mut sum, bow, &place.y);
            add(&mut sum, curl, &[0, 1, 2].map(|k| place.slope[k] - r * place.y[k]));
            band.add(place.first, &sum);
        }
    }

    /// Where the objective and the limits push the coefficients.
    fn push(&self, c: &[f64], centre: f64, push: &mut [f64]) {
        for (push, (bent, c)) in push.iter_mut().zip(self.bent.iter().zip(c)) {
            *push = (centre - bent) / c;
        }
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let y = dot(&place.y, &c[place.first..]);
            let gain = place.weight / (3.0 * y * y.cbrt());
            let mut sum = place.y.map(|w| gain * w);
            for side in sides {
                for n in [0, 1] {
                    let by = (centre - side.bent[n]) / side.room[n];
                    (0..3).for_each(|k| sum[k] += by * side.slope[n][k]);
                }
            }
            (0..3).for_each(|k| push[place.first + k] += sum[k]);
        }
    }

    /// Calls with room, its change, worth and its change, for every limit.
    #[inline]
    fn each(&self, c: &[f64], step: &[f64], centre: f64, mut call: impl FnMut([f64; 4])) {
        for ((room, change), (worth, bent)) in c.iter().zip(step).zip(self.worth.iter().zip(&self.bent)) {
            call([*room, *change, *worth, (centre - bent - worth * change) / room - worth]);
        }
        for (place, sides) in self.places.iter().zip(self.sides.chunks_exact(self.each)) {
            let step = &step[place.first..];
            for side in sides {
                for n in [0, 1] {
                    let (room, worth, change) = (side.room[n], side.worth[n], dot(&side.slope[n], step));
                    call([room, change, worth, (centre - side.bent[n] - worth * change) / room - worth]);
                }
            }
        }
    }

    /// How far the step may be gone, and how far the worths', so that a share of all room is left.
    fn reach(&self, c: &[f64], step: &[f64], centre: f64, short: f64) -> (f64, f64) {
        let (mut primal, mut dual) = (1.0_f64 / short, 1.0_f64 / short);
        self.each(c, step, centre, |[room, change, worth, other]| {
            if change < 0.0 {
                primal = primal.min(-room / change);
            }
            if other < 0.0 {
                dual = dual.min(-worth / other);
            }
        });
        ((short * primal).min(1.0), (short * dual).min(1.0))
    }

    /// What all room would be worth after it.
    fn left(&self, c: &[f64], step: &[f64], primal: f64, dual: f64) -> f64 {
        let mut left = 0.0;
        self.each(c, step, 0.0, |[room, change, worth, other]| {
            left += (room + primal * change) * (worth + dual * other);
        });
        left
    }

    /// Keeps the products of the predicted changes.
    fn bend(&mut self, c: &[f64], step: &[f64]) {
        let mut products = Vec::with_capacity(2 * self.sides.len() + c.len());
        self.each(c, step, 0.0, |[_, change, _, other]| products.push(change * other));
        let (own, sides) = products.split_at(c.len());
        self.bent.copy_from_slice(own);
        for (side, bent) in self.sides.iter_mut().zip(sides.chunks_exact(2)) {
            side.bent = [bent[0], bent[1]];
        }
    }

    /// Moves the worths by a share of their step.
    fn revalue(&mut self, c: &[f64], step: &[f64], centre: f64, dual: f64) {
        let mut worths = Vec::with_capacity(2 * self.sides.len() + c.len());
        self.each(c, step, centre, |[_, _, worth, change]| worths.push(worth + dual * change));
        let (own, sides) = worths.split_at(c.len());
        self.worth.copy_from_slice(own);
        for (side, worth) in self.sides.iter_mut().zip(sides.chunks_exact(2)) {
            side.worth = [worth[0], worth[1]];
        }
    }
}

/// A timing: y as a spline.
pub(super) struct Timing {
    /// θ.
    pub(super) nodes: Vec<f64>,
    c: Vec<f64>,
}

impl Timing {
    /// y at both ends of a space, and the coefficient between.
    fn space(&self, i: usize) -> [f64; 3] {
        let (c, ends) = (&self.c[i..i + 3], [share(&self.nodes, i), share(&self.nodes, i + 1)]);
        [(1.0 - ends[0]) * c[0] + ends[0] * c[1], c[1], (1.0 - ends[1]) * c[1] + ends[1] * c[2]]
    }

    /// y at a θ.
    fn at(&self, theta: f64) -> f64 {
        let i = self.nodes.partition_point(|node| *node <= theta).clamp(1, self.nodes.len() - 1) - 1;
        let u = (theta - self.nodes[i]) / (self.nodes[i + 1] - self.nodes[i]);
        curved(self.space(i), u)
    }

    /// As phases, three for each space.
    pub(super) fn profile(&self) -> Profile {
        let spaces = self.nodes.len() - 1;
        let mut jets = Vec::with_capacity(spaces + 1);
        let mut t = 0.0;
        for i in 0..spaces {
            let (h, y) = (self.nodes[i + 1] - self.nodes[i], self.space(i));
            // y′ at the node is twice the slope to the coefficient.
            let [s, first, second, _] = eased(self.nodes[i]);
            let rate = y[0].cbrt();
            let turn = 2.0 * (y[1] - y[0]) / (3.0 * h * rate);
            let jet = Progress { s, rate: first * rate, acceleration: second * rate * rate + first * turn, jerk: 0.0 };
            jets.push((t, jet));
            t += h * TIMES.map(|(at, weight)| weight / curved(y, at).cbrt()).iter().sum::<f64>();
        }
        jets.push((t, Progress::still(1.0)));
        Profile::through_jets(&jets)
    }
}

/// The quadratic with given ends and a coefficient between, at a share u.
#[inline]
fn curved(y: [f64; 3], u: f64) -> f64 {
    let v = 1.0 - u;
    y[0] * v * v + 2.0 * y[1] * u * v + y[2] * u * u
}

/// The path reckoned by θ, and its third derivative.
fn reckoned(path: &Path, theta: f64) -> (PathPoint, PerDrive) {
    let [s, a, b, c] = eased(theta);
    let (point, third) = (path.at(s), path.third(s));
    let PathPoint { q, first, second } = point;
    let third = third.scaled(a * a * a).plus(3.0 * a * b, &second).plus(c, &first);
    (PathPoint { q, first: first.scaled(a), second: second.scaled(a * a).plus(b, &first) }, third)
}

/// The share of the later one of the two coefficients that make y at a node.
fn share(nodes: &[f64], i: usize) -> f64 {
    let before = if i == 0 { 0.0 } else { nodes[i] - nodes[i - 1] };
    let after = nodes.get(i + 1).map_or(0.0, |next| next - nodes[i]);
    before / (before + after)
}

/// What counts by the values at both ends of a space and the coefficient between, by coefficients.
fn spread(w: [f64; 3], [from, to]: [f64; 2]) -> [f64; 3] {
    [w[0] * (1.0 - from), w[0] * from + w[1] + w[2] * (1.0 - to), w[2] * to]
}

#[inline]
fn dot(v: &[f64; 3], c: &[f64]) -> f64 {
    v[0] * c[0] + v[1] * c[1] + v[2] * c[2]
}

/// Adds weight · v vᵀ: above and on the diagonal.
#[inline]
fn add(sum: &mut [f64; 6], weight: f64, v: &[f64; 3]) {
    let w = v.map(|v| weight * v);
    sum[0] += w[0] * v[0];
    sum[1] += w[0] * v[1];
    sum[2] += w[0] * v[2];
    sum[3] += w[1] * v[1];
    sum[4] += w[1] * v[2];
    sum[5] += w[2] * v[2];
}

/// A symmetric matrix with two bands beside its diagonal, and its factors L D Lᵀ in the same place.
struct Band {
    /// Of each row the diagonal and the two right of it.
    rows: Vec<[f64; 3]>,
}

impl Band {
    fn new(n: usize) -> Self {
        Self { rows: vec![[0.0; 3]; n] }
    }

    fn clear(&mut self) {
        self.rows.fill([0.0; 3]);
    }

    fn add(&mut self, first: usize, sum: &[f64; 6]) {
        let [a, b, c] = &mut self.rows[first..first + 3] else { return };
        (0..3).for_each(|k| a[k] += sum[k]);
        (0..2).for_each(|k| b[k] += sum[3 + k]);
        c[0] += sum[5];
    }

    /// `None` if it is not positive definite.
    fn factor(&mut self) -> Option<()> {
        for i in 0..self.rows.len() {
            let [d, p, q] = self.rows[i];
            if !(d > 0.0 && d.is_finite()) {
                return None;
            }
            let (l, m) = (p / d, q / d);
            self.rows[i] = [d, l, m];
            if let Some(next) = self.rows.get_mut(i + 1) {
                next[0] -= l * p;
                next[1] -= l * q;
            }
            if let Some(next) = self.rows.get_mut(i + 2) {
                next[0] -= m * q;
            }
        }
        Some(())
    }

    fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        for i in 0..n {
            let [_, l, m] = self.rows[i];
            if i + 1 < n {
                x[i + 1] -= l * x[i];
            }
            if i + 2 < n {
                x[i + 2] -= m * x[i];
            }
        }
        for i in (0..n).rev() {
            let [d, l, m] = self.rows[i];
            let mut sum = x[i] / d;
            if i + 1 < n {
                sum -= l * x[i + 1];
            }
            if i + 2 < n {
                sum -= m * x[i + 2];
            }
            x[i] = sum;
        }
    }
}
