//! [`Pattern`]: which joints stand at which limit, and what of the search for stationary poses that decides, whatever the
//! point.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::{Arc, OnceLock};

use super::joint::Joint;
use crate::mechanics::planar::{MAX_DRIVES, Vector, unit};

/// Spaces in which a change of sign is looked for.
pub(super) const SPACES: usize = 24;

/// Where it is looked for: t from 0 to π/2, ν = ν_most sin t.
pub(super) fn place(i: usize) -> f64 {
    FRAC_PI_2 * i as f64 / SPACES as f64
}

/// Where the slope at a place is taken: beside both ends, where it is nothing, or nothing by nothing.
fn slope_place(i: usize) -> f64 {
    const BESIDE: f64 = 1e-6;
    place(i).clamp(BESIDE, FRAC_PI_2 - BESIDE)
}

/// Turns are found to this, in t.
const TURN_TOLERANCE: f64 = 1e-13;

/// Joints that miss their limits by this much are looked at, rad.
const LOOKED_AT_MISS: f64 = 1e-6;

/// What of a joint is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum At {
    Free,
    Least,
    Greatest,
}

/// The drives as compounds, with some joints held at a limit.
#[derive(Debug)]
pub(super) struct Pattern {
    /// Of each joint.
    pub at: [At; MAX_DRIVES],
    /// How many compounds.
    pub count: usize,
    /// The compound of each drive, and how far the drive is turned within it, rad.
    pub of: [usize; MAX_DRIVES],
    pub delta: [f64; MAX_DRIVES],
    /// The angle of each compound's arm while its first drive is at 0, rad.
    pub lean: [f64; MAX_DRIVES],
    /// |L|, m.
    pub length: [f64; MAX_DRIVES],
    /// Λ.
    pub lambda: [f64; MAX_DRIVES],
    /// The angle of each free joint while the compounds that it joins are turned alike, rad.
    pub shift: [f64; MAX_DRIVES],
    /// Whether a joint is held that could leave its limit.
    pub held: bool,
    /// Three compounds and more: the greatest ν, m, and the compound that stands across there.
    pub most: f64,
    pub across: usize,
    /// For each choice of signs of the cosines.
    pub signs: Vec<Signs>,
}

/// |p|² of the stationary poses of a choice of signs, over t.
#[derive(Debug)]
pub(super) struct Signs {
    /// Bit i − 1: whether the cosine of compound i is negative.
    pub bits: u32,
    /// Bit i: whether the joints may be within their limits between place i and the next.
    pub cells: u32,
    /// |p|² at each place, and the least and greatest within the cells, m².
    pub values: [f64; SPACES + 1],
    pub least: f64,
    pub greatest: f64,
    /// Where it turns back, in order: from one to the next it rises or falls. Within the cells exactly.
    pub turns: Vec<Turn>,
}

/// Where |p|² turns back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Between this place and the next.
    pub cell: usize,
    pub t: f64,
    /// m².
    pub value: f64,
}

/// All that signs make |p|² and its slope of at a place: as [`Pattern::stretched`], and beside it.
#[derive(Clone, Copy)]
struct Place {
    at: (f64, [f64; MAX_DRIVES], Vector),
    rates: Rates,
}

/// |L_i| cos α_i and ν ΣΛ, m, and how they change with t, m.
#[derive(Clone, Copy)]
struct Rates {
    cos: [f64; MAX_DRIVES],
    sum: f64,
    changes: [f64; MAX_DRIVES],
    across: f64,
}

/// The patterns of a machine. They follow from the space that holds them alone, so they are made once, when they are first
/// asked for; copies of it share them.
#[derive(Clone, Debug, Default)]
pub(super) struct Patterns(Arc<OnceLock<Vec<Pattern>>>);

/// They follow from what else is compared.
impl PartialEq for Patterns {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Patterns {
    pub fn of(&self, tip: &[f64], lambda: &[f64], joints: &[Joint]) -> &[Pattern] {
        self.0.get_or_init(|| all(tip, lambda, joints))
    }
}

fn all(tip: &[f64], lambda: &[f64], joints: &[Joint]) -> Vec<Pattern> {
    let mut patterns = Vec::new();
    let mut at = [At::Free; MAX_DRIVES];
    loop {
        patterns.extend(Pattern::new(tip, lambda, joints, at));
        // The next one, counting in threes.
        let Some(i) = (0..joints.len()).find(|i| at[*i] != At::Greatest) else { return patterns };
        at[..i].fill(At::Free);
        at[i] = if at[i] == At::Free { At::Least } else { At::Greatest };
    }
}

impl Pattern {
    /// None where b cannot be stationary, or another pattern is the same.
    fn new(tip: &[f64], lambda: &[f64], joints: &[Joint], at: [At; MAX_DRIVES]) -> Option<Self> {
        let twice = |(at, joint): (&At, &Joint)| *at == At::Greatest && joint.limits[0] == joint.limits[1];
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
                At::Free => {
                    c.of[far] = c.count;
                    c.count += 1;
                    continue;
                }
                At::Least => joint.limits[0],
                At::Greatest => joint.limits[1],
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
        // Where nothing bounds ν, no drive has a λ; where an arm is nothing, b never ends but at limits.
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

    /// Between which places, of which these are the angles with all cosines above 0, all joints may be within their
    /// limits: what is not there is not for certain.
    fn within(&self, joints: &[Joint], bits: u32, alpha: &[[f64; MAX_DRIVES]; SPACES + 1]) -> u32 {
        let at = |i: usize, place: usize| {
            let own = alpha[place][i];
            if i > 0 && bits >> (i - 1) & 1 == 1 { PI - own } else { own }
        };
        let free = || joints.iter().zip(self.at).enumerate().filter(|(_, (_, at))| *at == At::Free);
        let may = |place: usize, side: f64| {
            free().all(|(i, (joint, _))| {
                let [near, far] = joint.ends.map(|k| self.of[k]);
                // Each angle rises or falls from one place to the next, so their difference lies between these.
                let [n, f] = [near, far].map(|k| [at(k, place), at(k, place + 1)]);
                let [least, greatest] =
                    [f[0].min(f[1]) - n[0].max(n[1]), f[0].max(f[1]) - n[0].min(n[1])].map(|d| joint.sense * side * d);
                let shift = self.shift[i] - joint.sense * (self.lean[far] - self.lean[near]);
                let [low, high] =
                    [least.min(greatest) + shift - LOOKED_AT_MISS, least.max(greatest) + shift + LOOKED_AT_MISS];
                // The least of its values above the lower limit.
                let first = high - TAU * ((high - joint.limits[0]) / TAU).floor();
                first - (high - low) <= joint.limits[1]
            })
        };
        (0..SPACES).filter(|i| may(*i, 1.0) || may(*i, -1.0)).fold(0, |cells, i| cells | 1 << i)
    }

    fn scanned(&self, bits: u32, cells: u32, places: &[Place; SPACES + 1]) -> Signs {
        let sign = |i: usize| if i > 0 && bits >> (i - 1) & 1 == 1 { -1.0 } else { 1.0 };
        let signed = |of: &[f64; MAX_DRIVES]| (0..self.count).map(|i| sign(i) * of[i]).sum::<f64>();
        let values: [f64; SPACES + 1] = std::array::from_fn(|i| {
            let (_, cos, sum) = &places[i].at;
            Vector::new(signed(cos), sum.im).norm_sqr()
        });
        let slopes: [f64; SPACES + 1] = std::array::from_fn(|i| {
            let Rates { cos, sum, changes, across } = &places[i].rates;
            2.0 * (signed(cos) * signed(changes) + sum * across)
        });
        let alive = |i: usize| cells >> i & 1 == 1;
        let mut turns = Vec::new();
        for cell in 0..SPACES {
            let ends = [cell, cell + 1];
            let [from, to] = ends.map(slope_place);
            let [rise, fall] = ends.map(|i| slopes[i]);
            // Two turns between two places: where a cubic through both has them.
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
                    turns.push(Turn { cell, t, value: self.square(bits, t).0 });
                }
            }
        }
        let within = |i: &usize| alive(*i) && *i < SPACES || (*i > 0 && alive(*i - 1));
        let ends = (0..=SPACES).filter(within).map(|i| values[i]);
        let within = || ends.clone().chain(turns.iter().filter(|turn| alive(turn.cell)).map(|turn| turn.value));
        let least = within().fold(f64::INFINITY, f64::min);
        let greatest = within().fold(f64::NEG_INFINITY, f64::max);
        Signs { bits, cells, values, least, greatest, turns }
    }

    /// Where |p|² turns back between two t with slopes of opposite sign: by false position, each time with half of what an
    /// end keeps.
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

    /// How |p|² changes with t, for all cosines above 0.
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

    /// ν, |L_i| cos α_i of all compounds, and (Σ |L_i| cos α_i, ν ΣΛ) at t.
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

    /// |p|² at t, and how fast it changes.
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
