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

/// Joints that miss their limits by this much are looked at, rad.
const SPARE: f64 = 1e-6;

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
    /// |p|² at each place, and the least and greatest of these, m².
    pub values: [f64; SPACES + 1],
    pub least: f64,
    pub greatest: f64,
    /// Places at which it turns back, and how far beyond its value there it may go, m².
    pub turns: Vec<(usize, f64)>,
}

/// The patterns of a machine, made when they are first asked for; copies of it share them.
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
        let places = std::array::from_fn(|i| c.stretched(0, place(i)));
        let alpha = places.map(|(nu, cos, _)| std::array::from_fn(|i| (nu * c.lambda[i]).atan2(cos[i])));
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
                let [low, high] = [least.min(greatest) + shift - SPARE, least.max(greatest) + shift + SPARE];
                // The least of its values above the lower limit.
                let first = high - TAU * ((high - joint.limits[0]) / TAU).floor();
                first - (high - low) <= joint.limits[1]
            })
        };
        (0..SPACES).filter(|i| may(*i, 1.0) || may(*i, -1.0)).fold(0, |cells, i| cells | 1 << i)
    }

    fn scanned(&self, bits: u32, cells: u32, places: &[(f64, [f64; MAX_DRIVES], Vector); SPACES + 1]) -> Signs {
        let values = std::array::from_fn(|i| {
            let (_, cos, sum) = &places[i];
            let along: f64 =
                (0..self.count).map(|i| if i > 0 && bits >> (i - 1) & 1 == 1 { -cos[i] } else { cos[i] }).sum();
            Vector::new(along, sum.im).norm_sqr()
        });
        let mut turns = Vec::new();
        for i in 1..SPACES {
            let [a, b, c]: [f64; 3] = [values[i - 1], values[i], values[i + 1]];
            let bend = a - 2.0 * b + c;
            // Two solutions may hide where it turns back: by a parabola through three places, and a little more.
            if (b <= a && b <= c && bend > 0.0) || (b >= a && b >= c && bend < 0.0) {
                turns.push((i, 0.125 * (a - c).powi(2) / bend.abs() / 0.95));
            }
        }
        let within = |i: &usize| cells >> i & 1 == 1 || (*i > 0 && cells >> (i - 1) & 1 == 1);
        let within = || (0..=SPACES).filter(within).map(|i| values[i]);
        let least = within().fold(f64::INFINITY, f64::min);
        let greatest = within().fold(f64::NEG_INFINITY, f64::max);
        Signs { bits, cells, values, least, greatest, turns }
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
