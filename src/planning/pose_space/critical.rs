//! The values at which b of a point can end: where it is stationary within what the limits leave free.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{DMatrix, SymmetricEigen};

use super::space::PoseSpace;
use crate::mechanics::planar::{MAX_DRIVES, PerDrive, Vector, dot, unit};

/// A pose at which b is stationary, and where it may go from there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Critical {
    /// b for the point on the x axis, rad.
    pub b: f64,
    /// Whether b can rise from here while the end effector stays.
    pub up: bool,
    /// Whether it can fall.
    pub down: bool,
}

/// What of a joint is free.
#[derive(Clone, Copy, PartialEq)]
enum At {
    Free,
    Least,
    Greatest,
}

/// Angles may miss their limits by this much, rad: rounding of an inverse.
const SLACK: f64 = 1e-9;
/// Spaces in which a change of sign is looked for.
const SPACES: usize = 24;

/// |p|² of what stationary poses reach, for each choice of limits and signs, at every place where a change of sign is
/// looked for: the same for all distances, so that many are asked for at the cost of few.
#[derive(Default)]
pub(super) struct Scan {
    values: Vec<[f64; SPACES + 1]>,
    next: usize,
}

impl Scan {
    fn next(&mut self, square: impl Fn(f64) -> f64) -> [f64; SPACES + 1] {
        if self.next == self.values.len() {
            self.values.push(std::array::from_fn(|i| square(place(i))));
        }
        self.next += 1;
        self.values[self.next - 1]
    }
}

fn place(i: usize) -> f64 {
    FRAC_PI_2 * i as f64 / SPACES as f64
}

/// The drives as compounds, with some joints held at a limit.
struct Compounds {
    count: usize,
    of: [usize; MAX_DRIVES],
    delta: [f64; MAX_DRIVES],
    arm: [Vector; MAX_DRIVES],
    length: [f64; MAX_DRIVES],
    lambda: [f64; MAX_DRIVES],
}

impl PoseSpace {
    /// Every critical value of b for points at a distance from B, m, above 0; whether all of them can be told apart.
    pub(super) fn criticals(&self, distance: f64, scan: &mut Scan, mut found: impl FnMut(Critical)) -> bool {
        scan.next = 0;
        let mut at = [At::Free; MAX_DRIVES];
        let mut regular = true;
        loop {
            regular &= self.of_pattern(&at[..self.joints.len()], distance, scan, &mut found);
            // The next pattern, counting in threes.
            let Some(i) = (0..self.joints.len()).find(|i| at[*i] != At::Greatest) else {
                return regular;
            };
            at[..i].fill(At::Free);
            at[i] = if at[i] == At::Free { At::Least } else { At::Greatest };
        }
    }

    fn compounds(&self, at: &[At]) -> Compounds {
        let mut c = Compounds {
            count: 1,
            of: [0; MAX_DRIVES],
            delta: [0.0; MAX_DRIVES],
            arm: [Vector::default(); MAX_DRIVES],
            length: [0.0; MAX_DRIVES],
            lambda: [0.0; MAX_DRIVES],
        };
        for (joint, at) in self.joints.iter().zip(at) {
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
        }
        for k in 0..self.drives() {
            c.arm[c.of[k]] += self.tip[k] * unit(c.delta[k]);
            c.lambda[c.of[k]] += self.lambda[k];
        }
        (0..c.count).for_each(|i| c.length[i] = c.arm[i].norm());
        c
    }

    fn of_pattern(&self, at: &[At], distance: f64, scan: &mut Scan, found: &mut impl FnMut(Critical)) -> bool {
        let twice = |(at, joint): (&At, &super::Joint)| *at == At::Greatest && joint.limits[0] == joint.limits[1];
        if at.iter().zip(&self.joints).any(twice) {
            return true;
        }
        let c = self.compounds(at);
        match c.count {
            1 => true,
            2 => {
                self.triangle(at, &c, distance, found);
                true
            }
            _ => self.stationary(at, &c, distance, scan, found),
        }
    }

    /// Two compounds: the point leaves no freedom, so b is where it is.
    fn triangle(&self, at: &[At], c: &Compounds, r: f64, found: &mut impl FnMut(Critical)) {
        let [l, m] = [c.length[0], c.length[1]];
        if l <= 0.0 {
            return;
        }
        let cos = (r * r + l * l - m * m) / (2.0 * r * l);
        if cos.abs() > 1.0 + 1e-12 {
            return;
        }
        let bend = cos.clamp(-1.0, 1.0).acos();
        for sign in [1.0, -1.0] {
            let first = l * unit(sign * bend);
            let psi = [sign * bend, (r - first).arg()];
            // μ with Λ = Re(μ̄ i L e^{iψ}) for both.
            let [j, k] = [first, r - first].map(|arm| Vector::new(-arm.im, arm.re));
            let det = j.re * k.im - j.im * k.re;
            let mu = (det.abs() > 1e-9 * l * m).then(|| {
                Vector::new(c.lambda[0] * k.im - c.lambda[1] * j.im, j.re * c.lambda[1] - k.re * c.lambda[0]) / det
            });
            let turn = |i: usize| psi[i] - c.arm[i].arg();
            self.poses_of(at, c, turn, mu, [false; 2], found);
            if bend == 0.0 {
                break;
            }
        }
    }

    /// Three compounds and more: one equation in ν for each choice of signs. False where a solution is at ν = 0, all
    /// arms on one line, to rounding.
    fn stationary(&self, at: &[At], c: &Compounds, r: f64, scan: &mut Scan, found: &mut impl FnMut(Critical)) -> bool {
        let n = c.count;
        let most = (0..n).map(|i| c.length[i] / c.lambda[i].abs()).fold(f64::INFINITY, f64::min);
        let all: f64 = c.lambda[..n].iter().sum();
        // Where nothing bounds ν, no drive has a λ; where an arm is nothing, b never ends but at limits.
        if !(most.is_finite() && most > 0.0) {
            return true;
        }
        let mut regular = true;
        for signs in 0..1_u32 << (n - 1) {
            let sign = |i: usize| if i > 0 && signs >> (i - 1) & 1 == 1 { -1.0 } else { 1.0 };
            let x = |nu: f64| -> f64 {
                (0..n).map(|i| sign(i) * (c.length[i].powi(2) - (nu * c.lambda[i]).powi(2)).max(0.0).sqrt()).sum()
            };
            let square = |t: f64| {
                let nu = most * t.sin();
                let (x, y) = (x(nu), nu * all);
                x * x + y * y
            };
            let miss = |t: f64| square(t) - r * r;
            let values = scan.next(square).map(|square| square - r * r);
            regular &= values[0].abs() > 1e-11 * r * r;
            roots(&miss, &values, |t| {
                let nu = most * t.sin();
                if nu < 1e-9 * most {
                    return;
                }
                for nu in [nu, -nu] {
                    let cos = |i: usize| sign(i) * (c.length[i].powi(2) - (nu * c.lambda[i]).powi(2)).max(0.0).sqrt();
                    let chi = Vector::new(x(nu), nu * all).arg();
                    let alpha = |i: usize| (nu * c.lambda[i]).atan2(cos(i));
                    let ways = ways(n, nu, &cos, &c.lambda);
                    let mu = unit(std::f64::consts::PI - chi) / nu;
                    let turn = |i: usize| alpha(i) - chi - c.arm[i].arg();
                    self.poses_of(at, c, turn, Some(mu), ways, found);
                }
            });
        }
        regular
    }

    /// The poses of compounds that are turned so, in every winding that the limits allow.
    fn poses_of(
        &self,
        at: &[At],
        c: &Compounds,
        turn: impl Fn(usize) -> f64,
        mu: Option<Vector>,
        [mut up, mut down]: [bool; 2],
        found: &mut impl FnMut(Critical),
    ) {
        let n = self.drives();
        let q = PerDrive::from_fn(n, |k| turn(c.of[k]) + c.delta[k]);
        if let Some(mu) = mu {
            // What b gains from each drive beyond what keeps the point, and of each joint from all that it turns.
            let mut gain =
                PerDrive::from_fn(n, |k| self.lambda[k] - self.tip[k] * dot(mu, Vector::new(0.0, 1.0) * unit(q[k])));
            let scale = self.lambda.max_abs();
            for (joint, at) in self.joints.iter().zip(at).rev() {
                let [near, far] = joint.ends;
                let own = joint.sense * gain[far];
                if *at == At::Free {
                    continue;
                }
                gain[near] += gain[far];
                if own.abs() > 1e-9 * scale && joint.limits[0] < joint.limits[1] {
                    let rises = (own > 0.0) == (*at == At::Least);
                    up |= rises;
                    down |= !rises;
                }
            }
        }
        let mut a = PerDrive::zeros(self.joints.len());
        self.wound(0, at, &q, &mut a, &mut |a| {
            let mut unturned = self.unturned(a);
            // Drive 1 as it is; b counts the windings.
            unturned.iter_mut().for_each(|x| *x += q[0]);
            found(Critical { b: self.b(&unturned), up, down });
        });
    }

    /// Each choice of whole turns that puts all free angles within their limits.
    fn wound(&self, i: usize, at: &[At], q: &[f64], a: &mut PerDrive, take: &mut impl FnMut(&PerDrive)) {
        let Some(joint) = self.joints.get(i) else { return take(a) };
        let [low, high] = joint.limits;
        match at[i] {
            At::Least => a[i] = low,
            At::Greatest => a[i] = high,
            At::Free => {
                let own = joint.of(q);
                let mut angle = own - TAU * ((own - low + SLACK) / TAU).floor();
                while angle <= high + SLACK {
                    a[i] = angle.clamp(low, high);
                    self.wound(i + 1, at, q, a, take);
                    angle += TAU;
                }
                return;
            }
        }
        self.wound(i + 1, at, q, a, take);
    }
}

/// Whether b rises, and whether it falls, from a stationary pose in some direction that keeps the point: the form
/// −Σ C x²/ν on Σ C x = Σ Λ x = 0, with C = |L| cos α.
fn ways(n: usize, nu: f64, cos: &impl Fn(usize) -> f64, lambda: &[f64; MAX_DRIVES]) -> [bool; 2] {
    let c: [f64; MAX_DRIVES] = std::array::from_fn(|i| if i < n { cos(i) } else { 0.0 });
    if n == 3 {
        let x = [
            c[1] * lambda[2] - c[2] * lambda[1],
            c[2] * lambda[0] - c[0] * lambda[2],
            c[0] * lambda[1] - c[1] * lambda[0],
        ];
        let form = -(0..3).map(|i| c[i] * x[i] * x[i]).sum::<f64>() / nu;
        return [form > 0.0, form < 0.0];
    }
    // A basis of what is normal to both, by orthogonalisation.
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
    let candidates = [c[..n].to_vec(), lambda[..n].to_vec()].into_iter();
    let axes = (0..n).map(|i| (0..n).map(|j| if i == j { 1.0 } else { 0.0 }).collect::<Vec<f64>>());
    let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    for mut v in candidates.chain(axes) {
        let before = size(&v);
        for _ in 0..2 {
            for row in &rows {
                let along: f64 = row.iter().zip(&v).map(|(a, b)| a * b).sum();
                v.iter_mut().zip(row).for_each(|(v, row)| *v -= along * row);
            }
        }
        let left = size(&v);
        if left > 1e-9 * before.max(1e-300) && rows.len() < n {
            rows.push(v.into_iter().map(|x| x / left).collect());
        }
    }
    let basis = rows.get(2..).unwrap_or_default();
    let form = DMatrix::from_fn(basis.len(), basis.len(), |i, j| {
        -(0..n).map(|k| c[k] * basis[i][k] * basis[j][k]).sum::<f64>() / nu
    });
    let values = SymmetricEigen::new(form).eigenvalues;
    let least = 1e-9 * values.amax();
    [values.iter().any(|v| *v > least), values.iter().any(|v| *v < -least)]
}

/// Zeros of a function of t from 0 to π/2, each once, by its values at the places where it is looked at.
fn roots(f: &impl Fn(f64) -> f64, values: &[f64; SPACES + 1], mut found: impl FnMut(f64)) {
    for i in 0..SPACES {
        let (from, to) = (place(i), place(i + 1));
        if values[i] == 0.0 {
            found(from);
        } else if values[i] * values[i + 1] < 0.0 {
            found(bracketed(f, [from, to], [values[i], values[i + 1]]));
        }
        // Two zeros may hide where the function turns back.
        if i > 0 && values[i - 1] * values[i] > 0.0 && values[i] * values[i + 1] > 0.0 {
            let [a, b, c] = [values[i - 1], values[i], values[i + 1]].map(f64::abs);
            let bend = a - 2.0 * b + c;
            if b <= a && b <= c && bend > 0.0 && b - 0.125 * (a - c).powi(2) / bend < 0.05 * b {
                let (low, value) = lowest(f, [place(i - 1), to], values[i].signum());
                if value * values[i] < 0.0 {
                    found(bracketed(f, [place(i - 1), low], [values[i - 1], value]));
                    found(bracketed(f, [low, to], [value, values[i + 1]]));
                }
            }
        }
    }
    if values[SPACES] == 0.0 {
        found(FRAC_PI_2);
    }
}

/// The place nearest to 0 from one side, by golden sections.
fn lowest(f: &impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2], side: f64) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut x, mut y) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut fx, mut fy) = (side * f(x), side * f(y));
    for _ in 0..40 {
        if fx < fy {
            (high, y, fy) = (y, x, fx);
            x = high - GOLDEN * (high - low);
            fx = side * f(x);
        } else {
            (low, x, fx) = (x, y, fy);
            y = low + GOLDEN * (high - low);
            fy = side * f(y);
        }
        if fx.min(fy) < 0.0 {
            break;
        }
    }
    if fx < fy { (x, side * fx) } else { (y, side * fy) }
}

/// A zero between places of opposite sign: false position, the end that stays twice counting half (Illinois).
fn bracketed(f: &impl Fn(f64) -> f64, [mut a, mut b]: [f64; 2], [mut fa, mut fb]: [f64; 2]) -> f64 {
    let (mut last, mut x) = (0.0, 0.5 * (a + b));
    for _ in 0..60 {
        let before = x;
        x = (a * fb - b * fa) / (fb - fa);
        if !(x > a.min(b) && x < a.max(b)) {
            x = 0.5 * (a + b);
        }
        let fx = f(x);
        if fx == 0.0 || (x - before).abs() <= 2.0 * f64::EPSILON {
            break;
        }
        if fx * fa < 0.0 {
            (b, fb) = (x, fx);
            fa *= if last == 1.0 { 0.5 } else { 1.0 };
            last = 1.0;
        } else {
            (a, fa) = (x, fx);
            fb *= if last == -1.0 { 0.5 } else { 1.0 };
            last = -1.0;
        }
    }
    x
}
