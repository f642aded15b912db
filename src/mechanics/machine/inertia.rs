//! A machine collapsed into a few constants: cost does not grow with the number of links.
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | a_jk | CM of link j is Σ_k a_jk e^{i q_k} | complex, m |
//! | g_k | first moment Σ_j m_j a_jk; γ_k = i g_k e^{i q_k}, (3), (A1) | complex, kg m |
//! | C_kl | coupling Σ_j m_j conj(a_jk) a_jl | Hermitian, kg m² |
//! | J_k | spin: inertia of all links that follow drive k | kg m² |
//! | r | a rotor of inertia J turns at r·q̇: r = N e_k on the base, N e_k + (1 − N) e_on on links of a drive | |
//! | H | mass matrix: C, J_k on its diagonal, and J r rᵀ of every rotor | kg m² |
//! | D | angular momentum about B is D q̇: C_kk + J_k + J r_k where all C_kl vanish | kg m² |

use super::{Chain, Machine, Motors};
use crate::mechanics::planar::{MAX_DRIVES, PerDrive, Vector};

/// The constants g, C, J of a machine with its payload and its motors.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    pub(crate) motors: Motors,
    pub(crate) drives: usize,
    pub(crate) mass: f64,
    pub(crate) g: [Vector; MAX_DRIVES],
    pub(crate) c: [[Vector; MAX_DRIVES]; MAX_DRIVES],
    /// J_k with what the rotors add to H_kk.
    pub(crate) spin: [f64; MAX_DRIVES],
    /// What the rotors add to H_kl, k ≠ l.
    pub(crate) gears: [[f64; MAX_DRIVES]; MAX_DRIVES],
    /// D_k − Σ_l H_lk, which rotors on the base leave: their stators take up what gears make of it.
    pub(crate) taken_up: [f64; MAX_DRIVES],
    pub(crate) rotors: [Turning; MAX_DRIVES],
    pub(crate) end_effector: Chain,
}

/// A rotor: how it turns with the drives, and a base that turns behind them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Turning {
    /// J, kg m².
    pub inertia: f64,
    /// r.
    pub rates: [f64; MAX_DRIVES],
}

impl Inertia {
    /// Sums over the links and the payload.
    pub fn of(machine: &Machine) -> Self {
        let mut sum = Self::nothing(machine.drives(), *machine.motors(), *machine.end_effector());
        for (j, (link, part)) in machine.links().iter().zip(machine.resolved_links()).enumerate() {
            sum.add(link.mass, link.inertia, part.drive, &machine.com_chain(j));
        }
        let payload = machine.spec().payload;
        let held_by = machine.resolved_links()[machine.end_link()].drive;
        sum.add(payload.mass, payload.inertia, held_by, &machine.payload_chain());
        for (k, drive) in machine.spec().drives.iter().enumerate() {
            if let Some(rotor) = drive.rotor {
                sum.add_rotor(k, rotor.inertia, rotor.ratio);
            }
        }
        sum
    }

    /// What has no mass.
    pub(crate) fn nothing(drives: usize, motors: Motors, end_effector: Chain) -> Self {
        let zero = Vector::new(0.0, 0.0);
        Self {
            drives,
            mass: 0.0,
            g: [zero; MAX_DRIVES],
            c: [[zero; MAX_DRIVES]; MAX_DRIVES],
            spin: [0.0; MAX_DRIVES],
            gears: [[0.0; MAX_DRIVES]; MAX_DRIVES],
            taken_up: [0.0; MAX_DRIVES],
            rotors: [Turning::default(); MAX_DRIVES],
            motors,
            end_effector,
        }
    }

    /// A rotor of a ratio behind the gear of drive k.
    fn add_rotor(&mut self, k: usize, inertia: f64, ratio: f64) {
        let mut rates = [0.0; MAX_DRIVES];
        rates[k] = ratio;
        if let Some(on) = self.motors.on(k) {
            rates[on] += 1.0 - ratio;
        }
        self.rotors[k] = Turning { inertia, rates };
        self.gear(inertia, &rates, self.drives);
    }

    /// Adds J r rᵀ to the mass matrix of the first `n`, and what of J r its rows lack.
    fn gear(&mut self, inertia: f64, r: &[f64; MAX_DRIVES], n: usize) {
        let all: f64 = r[..n].iter().sum();
        for i in 0..n {
            self.spin[i] += inertia * r[i] * r[i];
            self.taken_up[i] += inertia * r[i] * (1.0 - all);
            for j in (0..n).filter(|j| *j != i) {
                self.gears[i][j] += inertia * r[i] * r[j];
            }
        }
    }

    /// The same with a base that turns behind the drives, on which every stator sits in the end: rows of the mass
    /// matrix are the momentum then.
    pub(crate) fn turn_base(&mut self) {
        let n = self.drives;
        self.taken_up = [0.0; MAX_DRIVES];
        for i in 0..n {
            let Turning { inertia, mut rates } = self.rotors[i];
            if inertia == 0.0 || n >= MAX_DRIVES {
                continue;
            }
            rates[n] = 1.0 - rates[..n].iter().sum::<f64>();
            self.spin[n] += inertia * rates[n] * rates[n];
            for k in 0..n {
                self.gears[n][k] += inertia * rates[n] * rates[k];
                self.gears[k][n] += inertia * rates[n] * rates[k];
            }
            self.rotors[i].rates = rates;
        }
    }

    pub(crate) fn add(&mut self, mass: f64, inertia: f64, drive: usize, a: &[Vector; MAX_DRIVES]) {
        self.mass += mass;
        self.spin[drive] += inertia;
        for k in 0..self.drives {
            self.g[k] += mass * a[k];
            for l in 0..self.drives {
                self.c[k][l] += mass * a[k].conj() * a[l];
            }
        }
    }

    /// Number of drives.
    pub fn drives(&self) -> usize {
        self.drives
    }

    /// Total mass M, kg.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// First moment g_k, kg m; the bracket of (A1).
    pub fn first_moment(&self, k: usize) -> Vector {
        self.g[k]
    }

    /// Coupling C_kl, kg m²; for k ≠ l the bracket of (8).
    pub fn coupling(&self, k: usize, l: usize) -> Vector {
        self.c[k][l]
    }

    /// H_kk = C_kk + J_k, kg m²: the same in every pose.
    pub fn diagonal(&self, k: usize) -> f64 {
        self.c[k][k].re + self.spin[k]
    }

    /// H_kl where all C_kl, k ≠ l, vanish, kg m².
    pub fn constant(&self, k: usize, l: usize) -> f64 {
        if k == l { self.diagonal(k) } else { self.gears[k][l] }
    }

    /// Every H_kk; where all C_kl vanish and there are no rotors these are D_k, (11).
    pub fn diagonals(&self) -> PerDrive {
        PerDrive::from_fn(self.drives, |k| self.diagonal(k))
    }

    /// D_k where all C_kl vanish, kg m²: what the angular momentum about B has of q̇_k. Of a rotor only its own turning
    /// counts: a gear makes H_kk greater, not D_k, and a rotor that turns the other way makes D_k smaller.
    pub fn momentum(&self, k: usize) -> f64 {
        let gears: f64 = (0..self.drives).map(|l| self.gears[k][l]).sum();
        let own = self.diagonal(k) + gears + self.taken_up[k];
        // Of gears that cancel only rounding is left.
        if own.abs() <= BALANCED * self.diagonal(k) { 0.0 } else { own }
    }

    /// Every D_k where all C_kl vanish, kg m².
    pub fn momenta(&self) -> PerDrive {
        PerDrive::from_fn(self.drives, |k| self.momentum(k))
    }

    /// Σ D_k where all C_kl vanish, kg m².
    pub fn total_momentum(&self) -> f64 {
        (0..self.drives).map(|k| self.momentum(k)).sum()
    }

    /// D_1, or of the first drive that has one, kg m²: n_B is −b̈ times it. 0 where every motion is reactionless.
    pub fn pose_inertia(&self) -> f64 {
        (0..self.drives).map(|k| self.momentum(k)).find(|d| *d != 0.0).unwrap_or(0.0)
    }

    /// λ_k = D_k / D_1 of an invariant machine, (12); D_1 is that of the first drive that has one, and where none has,
    /// every λ_k is 0.
    pub fn lambda(&self) -> PerDrive {
        let first = self.pose_inertia();
        PerDrive::from_fn(self.drives, |k| if first == 0.0 { 0.0 } else { self.momentum(k) / first })
    }

    /// Inertia of all that turns if drives and base turn as one, kg m², where all C_kl vanish: gears do not count.
    pub fn locked(&self) -> f64 {
        let gears = |t: &Turning| {
            let turn = t.rates[..self.drives].iter().sum::<f64>();
            t.inertia * (1.0 - turn * turn)
        };
        let all: f64 = (0..self.drives).map(|k| (0..self.drives).map(|l| self.gears[k][l]).sum::<f64>()).sum();
        self.diagonals().iter().sum::<f64>() + all + self.rotors.iter().map(gears).sum::<f64>()
    }

    /// Angular momentum of the rotors for rates of the drives and a base that turns behind them, less what the mass
    /// matrix of the drives alone has of it, kg m²/s.
    pub(crate) fn of_base(&self, qd: &[f64]) -> f64 {
        let of = |t: &Turning| {
            let turn = |n: usize| t.rates.iter().zip(&qd[..n]).map(|(r, qd)| r * qd).sum::<f64>();
            let own: f64 = t.rates[..self.drives].iter().sum();
            t.inertia * (turn(qd.len()) - own * turn(self.drives))
        };
        self.rotors.iter().filter(|t| t.inertia > 0.0).map(of).sum()
    }

    /// Where the motors sit.
    pub fn motors(&self) -> &Motors {
        &self.motors
    }

    /// What motor k turns alone, kg m², where all C_kl vanish: all that its drive carries, held to it.
    pub fn carried(&self, k: usize) -> f64 {
        if !self.motors.in_joints() {
            return self.diagonal(k);
        }
        let all = || (0..self.drives).filter(|l| self.motors.carries(k, *l));
        all().map(|i| all().map(|j| self.constant(i, j)).sum::<f64>()).sum()
    }

    /// Whether H is its diagonal where all C_kl vanish, and every motor turns its drive alone: τ_k = H_kk q̈_k.
    pub fn is_decoupled(&self) -> bool {
        !self.motors.in_joints() && self.gears.iter().flatten().all(|g| *g == 0.0)
    }

    /// The pairs k < l in the paper's order (1,2), (1,3), (2,3) …, counted from 0.
    pub fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
        (0..n).flat_map(move |k| (k + 1..n).map(move |l| (k, l)))
    }

    /// Largest |g_k|, kg m: 0 is force balance, (7).
    pub fn force_residual(&self) -> f64 {
        self.g[..self.drives].iter().fold(0.0, |m, g| m.max(g.norm()))
    }

    /// Largest |C_kl|, k ≠ l, kg m²: 0 is an invariant mass matrix, (8).
    pub fn invariance_residual(&self) -> f64 {
        Self::pairs(self.drives).fold(0.0, |m, (k, l)| m.max(self.c[k][l].norm()))
    }

    /// How far the mass matrix and D depend on the pose: the largest |C_kl| as a share of Σ H_kk.
    pub fn pose_dependence(&self) -> f64 {
        self.invariance_residual() / self.diagonals().iter().sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// Whether no force reaches the base: every |g_k| below 1e-9 of what the mass and size make possible.
    pub fn is_force_balanced(&self) -> bool {
        self.force_residual() <= self.least_first_moment()
    }

    /// Whether the mass matrix is the same in every pose.
    pub fn is_invariant(&self) -> bool {
        self.invariance_residual() <= self.least_coupling()
    }

    /// Whether neither force nor coupling is left, (7) and (8).
    pub fn is_balanced(&self) -> bool {
        self.is_force_balanced() && self.is_invariant()
    }

    /// A |g_k| up to this counts as none, kg m.
    pub(crate) fn least_first_moment(&self) -> f64 {
        BALANCED * self.mass * self.size()
    }

    /// A |C_kl| up to this counts as none, kg m².
    pub(crate) fn least_coupling(&self) -> f64 {
        BALANCED * self.mass * self.size().powi(2)
    }

    fn size(&self) -> f64 {
        (0..self.drives).map(|k| self.diagonal(k)).sum::<f64>().max(0.0).sqrt() / self.mass.sqrt()
    }
}

/// Residuals below this part of the machine's own scale count as zero.
pub const BALANCED: f64 = 1e-9;
