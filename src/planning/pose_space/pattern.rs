//! [`Pattern`]: a choice of joints held at their limits. It stores what the search for stationary poses needs
//! and what is the same for all points. Symbols: see [`pose_space`](super).

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::{Arc, OnceLock};

use super::joint::RelativeJoint;
use stillbase_mechanics::planar::{MAX_DRIVES, Vector, unit};

/// Number of cells: equal intervals of t, in each of which a sign change of |p|² less its wanted value is sought.
pub(super) const SIGN_INTERVALS: usize = 24;

/// Returns t at a cell boundary, from 0 to π/2; ν = ν_max sin t.
pub(super) fn place(i: usize) -> f64 {
    FRAC_PI_2 * i as f64 / SIGN_INTERVALS as f64
}

/// Returns t at which the slope of a cell boundary is evaluated. It is slightly inside at t = 0 and π/2, where the
/// slope is 0 or 0/0.
fn slope_place(i: usize) -> f64 {
    const END_OFFSET: f64 = 1e-6;
    place(i).clamp(END_OFFSET, FRAC_PI_2 - END_OFFSET)
}

/// Tolerance of t of a turning point.
const TURN_TOLERANCE: f64 = 1e-13;

/// Tolerance of the joint limits in the preselection of cells, rad.
const PRESELECTION_TOLERANCE_RAD: f64 = 1e-6;

/// State of a joint: free, or held at its least or greatest angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LimitState {
    Free,
    Least,
    Greatest,
}

/// The drives grouped into compounds: groups that turn as one because the joints within them are held at a limit.
#[derive(Debug)]
pub(super) struct Pattern {
    /// State of each joint.
    pub at: [LimitState; MAX_DRIVES],
    /// Number of compounds.
    pub count: usize,
    /// The compound of each drive, and the angle of the drive within it, rad.
    pub of: [usize; MAX_DRIVES],
    pub delta: [f64; MAX_DRIVES],
    /// The angle of each compound's arm with its first drive at 0, rad.
    pub lean: [f64; MAX_DRIVES],
    /// Arm |L| of each compound, m.
    pub length: [f64; MAX_DRIVES],
    /// Λ of each compound.
    pub lambda: [f64; MAX_DRIVES],
    /// The angle of each free joint when its two compounds have equal angles, rad.
    pub shift: [f64; MAX_DRIVES],
    /// Whether some held joint has two different limits, so that it can leave the active one.
    pub held: bool,
    /// With three and more compounds: the greatest ν, m, and the compound whose cosine is 0 there.
    pub most: f64,
    pub across: usize,
    /// The feasible choices of signs of the cosines.
    pub signs: Vec<Signs>,
}

/// |p|² of the stationary poses over t, for one choice of signs.
#[derive(Debug)]
pub(super) struct Signs {
    /// Bit i − 1 is set if the cosine of compound i is negative.
    pub bits: u32,
    /// Bit i is set if the joints may be within their limits in cell i.
    pub cells: u32,
    /// |p|² at each cell boundary, and its least and greatest value within the feasible cells, m².
    pub values: [f64; SIGN_INTERVALS + 1],
    pub least: f64,
    pub greatest: f64,
    /// Turning points of |p|², ascending in t; between them it is monotone. Exact in feasible cells only.
    pub turns: Vec<TurningPoint>,
}

/// A turning point of |p|².
#[derive(Clone, Copy, Debug)]
pub(super) struct TurningPoint {
    /// The cell that contains it.
    pub cell: usize,
    pub t: f64,
    /// |p|² there, m².
    pub value: f64,
}

/// Values at a cell boundary that serve all choices of signs: [`Pattern::stretched`] there, and the rates nearby.
#[derive(Clone, Copy)]
struct Place {
    at: (f64, [f64; MAX_DRIVES], Vector),
    rates: Rates,
}

/// |L_i| cos α_i and ν ΣΛ, m, and their derivatives with respect to t, m.
#[derive(Clone, Copy)]
struct Rates {
    cos: [f64; MAX_DRIVES],
    sum: f64,
    changes: [f64; MAX_DRIVES],
    across: f64,
}

/// Cache of the patterns of a pose space, computed at the first use. Copies of the space share it.
#[derive(Clone, Debug, Default)]
pub(super) struct Patterns(Arc<OnceLock<Vec<Pattern>>>);

/// Always equal: patterns follow from other fields of the space, which are compared.
impl PartialEq for Patterns {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Patterns {
    pub fn of(&self, tip: &[f64], lambda: &[f64], joints: &[RelativeJoint]) -> &[Pattern] {
        self.0.get_or_init(|| all(tip, lambda, joints))
    }
}

fn all(tip: &[f64], lambda: &[f64], joints: &[RelativeJoint]) -> Vec<Pattern> {
    let mut patterns = Vec::new();
    let mut at = [LimitState::Free; MAX_DRIVES];
    loop {
        patterns.extend(Pattern::new(tip, lambda, joints, at));
        // Next combination, counting in base 3.
        let Some(i) = (0..joints.len()).find(|i| at[*i] != LimitState::Greatest) else { return patterns };
        at[..i].fill(LimitState::Free);
        at[i] = if at[i] == LimitState::Free { LimitState::Least } else { LimitState::Greatest };
    }
}

impl Pattern {
    /// Returns `None` if b cannot be stationary, or if another pattern is equal.
    fn new(tip: &[f64], lambda: &[f64], joints: &[RelativeJoint], at: [LimitState; MAX_DRIVES]) -> Option<Self> {
        let twice = |(at, joint): (&LimitState, &RelativeJoint)| {
            *at == LimitState::Greatest && joint.limits[0] == joint.limits[1]
        };
        if at.iter().zip(joints).any(twice) {
            return None;
        }
        let none = [0.0; MAX_DRIVES];
        let mut c = Self {
            at,
            count: 1,
            of: [0; MAX_DRIVES],
            delta: none,
            lean: none,
            length: none,
            lambda: none,
            shift: none,
            held: false,
            most: 0.0,
            across: 0,
            signs: Vec::new(),
        };
        let mut arm = [Vector::default(); MAX_DRIVES];
        for (joint, at) in joints.iter().zip(at) {
            let [near, far] = joint.ends;
            let held = match at {
                LimitState::Free => {
                    c.of[far] = c.count;
                    c.count += 1;
                    continue;
                }
                LimitState::Least => joint.limits[0],
                LimitState::Greatest => joint.limits[1],
            };
            c.of[far] = c.of[near];
            c.delta[far] = c.delta[near] + joint.sense * (held - joint.offset);
            c.held |= joint.limits[0] < joint.limits[1];
        }
        for k in 0..tip.len() {
            arm[c.of[k]] += tip[k] * unit(c.delta[k]);
            c.lambda[c.of[k]] += lambda[k];
        }
        for (i, arm) in arm[..c.count].iter().enumerate() {
            (c.length[i], c.lean[i]) = (arm.norm(), arm.arg());
        }
        for (i, joint) in joints.iter().enumerate() {
            let [near, far] = joint.ends;
            c.shift[i] = joint.offset + joint.sense * (c.delta[far] - c.delta[near]);
        }
        match c.count {
            1 => return None,
            2 => return (c.length[0] > 0.0).then_some(c),
            _ => {}
        }
        let most = |i: &usize| c.length[*i] / c.lambda[*i].abs();
        c.across = (0..c.count).min_by(|x, y| most(x).total_cmp(&most(y)))?;
        c.most = most(&c.across);
        // If ν is unbounded, every Λ is 0; if ν_max is 0, an arm is 0 and b is extreme only at limits.
        if !(c.most.is_finite() && c.most > 0.0) {
            return None;
        }
        let places = std::array::from_fn(|i| Place { at: c.stretched(0, place(i)), rates: c.rates(slope_place(i)) });
        let alpha =
            places.map(|Place { at: (nu, cos, _), .. }| std::array::from_fn(|i| (nu * c.lambda[i]).atan2(cos[i])));
        let signs = |bits: u32| {
            let cells = c.within(joints, bits, &alpha);
            (cells != 0).then(|| c.scanned(bits, cells, &places))
        };
        c.signs = (0..1_u32 << (c.count - 1)).filter_map(signs).collect();
        (!c.signs.is_empty()).then_some(c)
    }

    /// Returns the cells in which all joints may be within their limits, given the angles α at the cell boundaries for
    /// positive cosines. A cell that is not returned is certainly infeasible.
    fn within(&self, joints: &[RelativeJoint], bits: u32, alpha: &[[f64; MAX_DRIVES]; SIGN_INTERVALS + 1]) -> u32 {
        let at = |i: usize, place: usize| {
            let own = alpha[place][i];
            if i > 0 && bits >> (i - 1) & 1 == 1 { PI - own } else { own }
        };
        let free = || joints.iter().zip(self.at).enumerate().filter(|(_, (_, at))| *at == LimitState::Free);
        let may = |place: usize, side: f64| {
            free().all(|(i, (joint, _))| {
                let [near, far] = joint.ends.map(|k| self.of[k]);
                // α is monotone within a cell, so the difference of two α lies between these bounds.
                let [n, f] = [near, far].map(|k| [at(k, place), at(k, place + 1)]);
                let [least, greatest] =
                    [f[0].min(f[1]) - n[0].max(n[1]), f[0].max(f[1]) - n[0].min(n[1])].map(|d| joint.sense * side * d);
                let shift = self.shift[i] - joint.sense * (self.lean[far] - self.lean[near]);
                let [low, high] = [
                    least.min(greatest) + shift - PRESELECTION_TOLERANCE_RAD,
                    least.max(greatest) + shift + PRESELECTION_TOLERANCE_RAD,
                ];
                // The upper bound minus whole turns, so that it lies less than one turn above the lower limit.
                let first = high - TAU * ((high - joint.limits[0]) / TAU).floor();
                first - (high - low) <= joint.limits[1]
            })
        };
        (0..SIGN_INTERVALS).filter(|i| may(*i, 1.0) || may(*i, -1.0)).fold(0, |cells, i| cells | 1 << i)
    }

    fn scanned(&self, bits: u32, cells: u32, places: &[Place; SIGN_INTERVALS + 1]) -> Signs {
        let sign = |i: usize| if i > 0 && bits >> (i - 1) & 1 == 1 { -1.0 } else { 1.0 };
        let signed = |of: &[f64; MAX_DRIVES]| (0..self.count).map(|i| sign(i) * of[i]).sum::<f64>();
        let values: [f64; SIGN_INTERVALS + 1] = std::array::from_fn(|i| {
            let (_, cos, sum) = &places[i].at;
            Vector::new(signed(cos), sum.im).norm_sqr()
        });
        let slopes: [f64; SIGN_INTERVALS + 1] = std::array::from_fn(|i| {
            let Rates { cos, sum, changes, across } = &places[i].rates;
            2.0 * (signed(cos) * signed(changes) + sum * across)
        });
        let alive = |i: usize| cells >> i & 1 == 1;
        let mut turns = Vec::new();
        for cell in 0..SIGN_INTERVALS {
            let ends = [cell, cell + 1];
            let [from, to] = ends.map(slope_place);
            let [rise, fall] = ends.map(|i| slopes[i]);
            // A cell may contain two turning points. It is halved if the cubic through both values and slopes has an
            // opposite slope at the middle.
            let flat = 1.5 * (values[cell + 1] - values[cell]) / (to - from) - 0.25 * (rise + fall);
            let mut parts = [[(from, rise), (to, fall)]; 2];
            if rise * fall > 0.0 && flat * rise < 0.0 {
                let middle = 0.5 * (from + to);
                let slope = self.square(bits, middle).1;
                parts = [[(from, rise), (middle, slope)], [(middle, slope), (to, fall)]];
            }
            for [from, to] in &parts[..if parts[0] == parts[1] { 1 } else { 2 }] {
                if from.1 * to.1 < 0.0 {
                    let t = if alive(cell) { self.turn(bits, [*from, *to]) } else { 0.5 * (from.0 + to.0) };
                    turns.push(TurningPoint { cell, t, value: self.square(bits, t).0 });
                }
            }
        }
        let within = |i: &usize| alive(*i) && *i < SIGN_INTERVALS || (*i > 0 && alive(*i - 1));
        let ends = (0..=SIGN_INTERVALS).filter(within).map(|i| values[i]);
        let within = || ends.clone().chain(turns.iter().filter(|turn| alive(turn.cell)).map(|turn| turn.value));
        let least = within().fold(f64::INFINITY, f64::min);
        let greatest = within().fold(f64::NEG_INFINITY, f64::max);
        Signs { bits, cells, values, least, greatest, turns }
    }

    /// Returns a turning point of |p|² between two t with slopes of opposite sign, by false position with the Illinois
    /// modification.
    fn turn(&self, bits: u32, [mut from, mut to]: [(f64, f64); 2]) -> f64 {
        let mut kept = 0.0;
        for _ in 0..60 {
            let t = (from.0 * to.1 - to.0 * from.1) / (to.1 - from.1);
            let slope = self.square(bits, t).1;
            let is_first = slope * from.1 > 0.0;
            let (near, other) = if is_first { (&mut from, &mut to) } else { (&mut to, &mut from) };
            let step = (t - near.0).abs();
            *near = (t, slope);
            let side = if is_first { 1.0 } else { -1.0 };
            if kept == side {
                other.1 *= 0.5;
            }
            kept = side;
            if slope == 0.0 || step < TURN_TOLERANCE || (to.0 - from.0) < TURN_TOLERANCE {
                return t;
            }
        }
        0.5 * (from.0 + to.0)
    }

    /// Returns the derivatives that make up the slope of |p|², with all cosines positive.
    fn rates(&self, t: f64) -> Rates {
        let (nu, cos, sum) = self.stretched(0, t);
        let turn = unit(t);
        let mut changes = [0.0; MAX_DRIVES];
        for (i, change) in changes[..self.count].iter_mut().enumerate() {
            let speed = self.most * turn.re * self.lambda[i];
            *change = if i == self.across { -self.length[i] * turn.im } else { -nu * self.lambda[i] * speed / cos[i] };
        }
        let across = (0..self.count).map(|i| self.most * turn.re * self.lambda[i]).sum();
        Rates { cos, sum: sum.im, changes, across }
    }

    /// Returns ν, |L_i| cos α_i of all compounds, and (Σ |L_i| cos α_i, ν ΣΛ) at t, all in m.
    pub fn stretched(&self, bits: u32, t: f64) -> (f64, [f64; MAX_DRIVES], Vector) {
        let turn = unit(t);
        let nu = self.most * turn.im;
        let mut cos = [0.0; MAX_DRIVES];
        let mut sum = Vector::default();
        for (i, cos) in cos[..self.count].iter_mut().enumerate() {
            let [l, across] = [self.length[i], nu * self.lambda[i]];
            let size = if i == self.across { l * turn.re } else { ((l - across) * (l + across)).max(0.0).sqrt() };
            *cos = if i > 0 && bits >> (i - 1) & 1 == 1 { -size } else { size };
            sum += Vector::new(*cos, across);
        }
        (nu, cos, sum)
    }

    /// Returns |p|² at t and its derivative, m².
    pub fn square(&self, bits: u32, t: f64) -> (f64, f64) {
        let turn = unit(t);
        let nu = self.most * turn.im;
        let (mut sum, mut rate) = (Vector::default(), Vector::default());
        for i in 0..self.count {
            let [l, across, speed] = [self.length[i], nu * self.lambda[i], self.most * turn.re * self.lambda[i]];
            let (size, change) = if i == self.across {
                (l * turn.re, -l * turn.im)
            } else {
                let size = ((l - across) * (l + across)).max(0.0).sqrt();
                (size, -across * speed / size)
            };
            let sign = if i > 0 && bits >> (i - 1) & 1 == 1 { -1.0 } else { 1.0 };
            sum += Vector::new(sign * size, across);
            rate += Vector::new(sign * change, speed);
        }
        (sum.norm_sqr(), 2.0 * (sum.re * rate.re + sum.im * rate.im))
    }
}
