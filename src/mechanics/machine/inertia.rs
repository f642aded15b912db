//! [`Inertia`]: a machine reduced to a few constants, so that the cost of dynamics does not grow with the number of
//! links.
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | a_jk | CM of link j is Σ_k a_jk e^{i q_k} | complex, m |
//! | g_k | first moment Σ_j m_j a_jk; γ_k = i g_k e^{i q_k}, (3), (A1) | complex, kg m |
//! | C_kl | coupling Σ_j m_j conj(a_jk) a_jl | Hermitian, kg m² |
//! | J_k | spin: inertia of all links that follow drive k | kg m² |
//! | r | a rotor of inertia J turns at r·q̇: r_k = N, and r_l = 1 − N if its stator is on links of drive l | |
//! | H | mass matrix: C, J_k on its diagonal, and J r rᵀ of every rotor | kg m² |
//! | D | angular momentum about B is D q̇: C_kk + J_k + J r_k where all C_kl vanish | kg m² |
//! | 0 | the ground, a drive that never turns: index n of g, C and J, if links keep their orientation | |
//!
//! # Links that keep their orientation
//! They follow a drive 0 with e = 1. Their constant g_0 moves nothing. C_0k e_k adds Re C_0k e_k to D_k, but nothing to H,
//! since drive 0 has no rate. So C_0k = 0 is a condition of a constant D, as C_kl = 0 is.

use super::{Chain, Machine, Motors};
use crate::planar::{MAX_DRIVES, PerDrive, Vector};

/// The constants g, C, J of a machine with its payload and its motors.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    /// The motors that drive it.
    pub motors: Motors,
    /// Number of drives n.
    pub drives: usize,
    /// Whether links keep their orientation. Index n then stands for the ground in g, C and J.
    pub grounded: bool,
    /// Total mass with the payload, kg.
    pub mass: f64,
    /// First moments g_k of the drives, kg m.
    pub g: [Vector; MAX_DRIVES],
    /// Couplings C_kl of the drives, kg m²; the real part of C_kk is a moment of inertia.
    pub c: [[Vector; MAX_DRIVES]; MAX_DRIVES],
    /// J_k plus the contribution J r_k² of the rotors to H_kk, kg m².
    pub spin: [f64; MAX_DRIVES],
    /// Contribution J r_k r_l of the rotors to H_kl, k ≠ l, kg m².
    pub rotor_coupling: [[f64; MAX_DRIVES]; MAX_DRIVES],
    /// D_k − Σ_l H_lk, kg m²: J r_k (1 − Σ_l r_l) of the rotors, from the reaction of gears on stators on the base.
    pub stator_reaction: [f64; MAX_DRIVES],
    /// The rotor of each drive.
    pub rotors: [RotorCoupling; MAX_DRIVES],
    /// Coefficients of the end-effector position, m.
    pub end_effector: Chain,
}

/// A rotor with its rate ratios: those for the drives, then that for a base that turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RotorCoupling {
    /// Inertia J about its axis, kg m².
    pub inertia: f64,
    /// Ratios r: the rotor turns at r·q̇.
    pub rates: [f64; MAX_DRIVES],
}

impl Inertia {
    /// Computes the constants of a machine: sums over the links, the payload and the rotors.
    pub fn of(machine: &Machine) -> Self {
        let mut sum = Self::massless(machine.drives(), *machine.motors(), *machine.end_effector());
        sum.grounded = machine.ground().is_some();
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

    /// Returns the constants of a machine without mass, to which bodies are added.
    pub fn massless(drives: usize, motors: Motors, end_effector: Chain) -> Self {
        let zero = Vector::new(0.0, 0.0);
        Self {
            drives,
            grounded: false,
            mass: 0.0,
            g: [zero; MAX_DRIVES],
            c: [[zero; MAX_DRIVES]; MAX_DRIVES],
            spin: [0.0; MAX_DRIVES],
            rotor_coupling: [[0.0; MAX_DRIVES]; MAX_DRIVES],
            stator_reaction: [0.0; MAX_DRIVES],
            rotors: [RotorCoupling::default(); MAX_DRIVES],
            motors,
            end_effector,
        }
    }

    /// Adds the rotor of drive k, with its inertia, kg m², and gear ratio.
    fn add_rotor(&mut self, k: usize, inertia: f64, ratio: f64) {
        let mut rates = [0.0; MAX_DRIVES];
        rates[k] = ratio;
        if let Some(on) = self.motors.on(k) {
            rates[on] += 1.0 - ratio;
        }
        self.rotors[k] = RotorCoupling { inertia, rates };
        self.add_rotor_inertia(inertia, &rates, self.drives);
    }

    /// Adds J r rᵀ to the mass matrix of the first `n` drives, and J r (1 − Σ r) to `stator_reaction`.
    fn add_rotor_inertia(&mut self, inertia: f64, r: &[f64; MAX_DRIVES], n: usize) {
        let all: f64 = r[..n].iter().sum();
        for i in 0..n {
            self.spin[i] += inertia * r[i] * r[i];
            self.stator_reaction[i] += inertia * r[i] * (1.0 - all);
            for j in (0..n).filter(|j| *j != i) {
                self.rotor_coupling[i][j] += inertia * r[i] * r[j];
            }
        }
    }

    /// Adds the rotors' inertia for a base that turns; the base is treated as one more drive after the others. The
    /// ratios of each rotor then sum to 1, so that the columns of the mass matrix sum to D.
    pub fn turn_base(&mut self) {
        let n = self.drives;
        self.stator_reaction = [0.0; MAX_DRIVES];
        for i in 0..n {
            let RotorCoupling { inertia, mut rates } = self.rotors[i];
            if inertia == 0.0 || n >= MAX_DRIVES {
                continue;
            }
            rates[n] = 1.0 - rates[..n].iter().sum::<f64>();
            self.spin[n] += inertia * rates[n] * rates[n];
            for k in 0..n {
                self.rotor_coupling[n][k] += inertia * rates[n] * rates[k];
                self.rotor_coupling[k][n] += inertia * rates[n] * rates[k];
            }
            self.rotors[i].rates = rates;
        }
    }

    /// Adds a body that follows a drive: its mass, kg, its inertia about its CM, kg m², and the coefficients a_k, m, of
    /// its CM Σ_k a_k e^{i q_k}.
    pub fn add(&mut self, mass: f64, inertia: f64, drive: usize, a: &[Vector; MAX_DRIVES]) {
        self.mass += mass;
        self.spin[drive] += inertia;
        for k in 0..self.indices() {
            self.g[k] += mass * a[k];
            for l in 0..self.indices() {
                self.c[k][l] += mass * a[k].conj() * a[l];
            }
        }
    }

    /// Number of drives.
    pub fn drives(&self) -> usize {
        self.drives
    }

    /// Number of drives, and of the ground if links keep their orientation.
    pub(crate) fn indices(&self) -> usize {
        self.drives + usize::from(self.grounded)
    }

    /// Coupling C_0k with links that keep their orientation, kg m²; 0 if there are none.
    pub fn ground_coupling(&self, k: usize) -> Vector {
        if self.grounded { self.c[self.drives][k] } else { Vector::default() }
    }

    /// Returns the largest |C_0k|, kg m²: 0 for an angular momentum D q̇ with constant D.
    pub fn ground_residual(&self) -> f64 {
        (0..self.drives).fold(0.0, |m, k| m.max(self.ground_coupling(k).norm()))
    }

    /// Total mass M, kg.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// First moment g_k, kg m: the expression in brackets in (A1).
    pub fn first_moment(&self, k: usize) -> Vector {
        self.g[k]
    }

    /// Coupling C_kl, kg m²; for k ≠ l the expression in brackets in (8).
    pub fn coupling(&self, k: usize, l: usize) -> Vector {
        self.c[k][l]
    }

    /// H_kk, kg m²: C_kk + J_k plus J r_k² of the rotors, the same in every pose.
    pub fn diagonal(&self, k: usize) -> f64 {
        self.c[k][k].re + self.spin[k]
    }

    /// H_kl, kg m², of a machine in which all C_kl, k ≠ l, vanish.
    pub fn constant(&self, k: usize, l: usize) -> f64 {
        if k == l { self.diagonal(k) } else { self.rotor_coupling[k][l] }
    }

    /// Every H_kk, kg m². If all C_kl vanish and there are no rotors, these are D_k, (11).
    pub fn diagonals(&self) -> PerDrive {
        PerDrive::from_fn(self.drives, |k| self.diagonal(k))
    }

    /// Returns D_k where all C_kl vanish, kg m²: the coefficient of q̇_k in the angular momentum about B. A rotor adds
    /// J r_k² to H_kk but J r_k to D_k, so a rotor that turns against its drive reduces D_k.
    pub fn momentum(&self, k: usize) -> f64 {
        let gears: f64 = (0..self.drives).map(|l| self.rotor_coupling[k][l]).sum();
        let own = self.diagonal(k) + gears + self.stator_reaction[k];
        // If the rotors cancel D_k, only rounding error remains.
        if own.abs() <= BALANCE_TOLERANCE * self.diagonal(k) { 0.0 } else { own }
    }

    /// Every D_k where all C_kl vanish, kg m².
    pub fn momenta(&self) -> PerDrive {
        PerDrive::from_fn(self.drives, |k| self.momentum(k))
    }

    /// Σ D_k where all C_kl vanish, kg m².
    pub fn total_momentum(&self) -> f64 {
        (0..self.drives).map(|k| self.momentum(k)).sum()
    }

    /// Returns the first D_k that is not 0, usually D_1, kg m²: n_B is −b̈ times this. 0 if every motion is
    /// reactionless.
    pub fn pose_inertia(&self) -> f64 {
        (0..self.drives).map(|k| self.momentum(k)).find(|d| *d != 0.0).unwrap_or(0.0)
    }

    /// Returns λ_k = D_k / D_1 of an invariant machine, (12). If D_1 is 0, the first D_k that is not 0 replaces it; if
    /// all are 0, every λ_k is 0.
    pub fn lambda(&self) -> PerDrive {
        let first = self.pose_inertia();
        PerDrive::from_fn(self.drives, |k| if first == 0.0 { 0.0 } else { self.momentum(k) / first })
    }

    /// Returns the inertia of the machine when drives and base turn together as one body, kg m², where all C_kl vanish.
    /// Gear ratios then have no effect.
    pub fn locked(&self) -> f64 {
        let gears = |t: &RotorCoupling| {
            let turn = t.rates[..self.drives].iter().sum::<f64>();
            t.inertia * (1.0 - turn * turn)
        };
        let all: f64 = (0..self.drives).map(|k| (0..self.drives).map(|l| self.rotor_coupling[k][l]).sum::<f64>()).sum();
        self.diagonals().iter().sum::<f64>() + all + self.rotors.iter().map(gears).sum::<f64>()
    }

    /// Returns the angular momentum of the rotors, kg m²/s, minus the part that the mass matrix of the drives contains.
    /// `qd` holds the rates of the drives, rad/s, followed by the rate of a base that turns.
    pub fn excess_rotor_momentum(&self, qd: &[f64]) -> f64 {
        let of = |t: &RotorCoupling| {
            let turn = |n: usize| t.rates.iter().zip(&qd[..n]).map(|(r, qd)| r * qd).sum::<f64>();
            let own: f64 = t.rates[..self.drives].iter().sum();
            t.inertia * (turn(qd.len()) - own * turn(self.drives))
        };
        self.rotors.iter().filter(|t| t.inertia > 0.0).map(of).sum()
    }

    /// Returns the placement of the motors.
    pub fn motors(&self) -> &Motors {
        &self.motors
    }

    /// Returns the inertia that motor k turns if no other motor turns, kg m², where all C_kl vanish. It includes all
    /// drives that drive k carries.
    pub fn inertia_at_motor(&self, k: usize) -> f64 {
        if !self.motors.in_joints() {
            return self.diagonal(k);
        }
        let all = || (0..self.drives).filter(|l| self.motors.carries(k, *l));
        all().map(|i| all().map(|j| self.constant(i, j)).sum::<f64>()).sum()
    }

    /// Returns whether all motors sit on the base and no rotor couples drives. If all C_kl vanish, τ_k = H_kk q̈_k.
    pub fn is_decoupled(&self) -> bool {
        !self.motors.in_joints() && self.rotor_coupling.iter().flatten().all(|g| *g == 0.0)
    }

    /// Returns the pairs k < l, counted from 0, in the order (1,2), (1,3) … (2,3) … of the paper.
    pub fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
        (0..n).flat_map(move |k| (k + 1..n).map(move |l| (k, l)))
    }

    /// Returns the largest |g_k|, kg m: 0 for a force balanced machine, (7).
    pub fn force_residual(&self) -> f64 {
        self.g[..self.drives].iter().fold(0.0, |m, g| m.max(g.norm()))
    }

    /// Returns the largest |C_kl|, k ≠ l, kg m², those with the ground included: 0 for an invariant mass matrix and a
    /// constant D, (8).
    pub fn invariance_residual(&self) -> f64 {
        Self::pairs(self.indices()).fold(0.0, |m, (k, l)| m.max(self.c[k][l].norm()))
    }

    /// Returns the largest |C_kl|, k ≠ l, as a fraction of Σ H_kk: a measure of how the mass matrix depends on the
    /// pose.
    pub fn pose_dependence(&self) -> f64 {
        self.invariance_residual() / self.diagonals().iter().sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// Returns whether motion exerts no force on the base: every |g_k| is at most [`BALANCE_TOLERANCE`] M √(Σ H_kk /
    /// M).
    pub fn is_force_balanced(&self) -> bool {
        self.force_residual() <= self.first_moment_tolerance()
    }

    /// Returns whether mass matrix and D are the same in every pose: every |C_kl|, k ≠ l, is at most [`BALANCE_TOLERANCE`]
    /// Σ H_kk.
    pub fn is_invariant(&self) -> bool {
        self.invariance_residual() <= self.coupling_tolerance()
    }

    /// Returns whether the machine is force balanced and its mass matrix invariant, (7) and (8).
    pub fn is_balanced(&self) -> bool {
        self.is_force_balanced() && self.is_invariant()
    }

    /// Tolerance of |g_k|, kg m: up to this it is treated as zero.
    pub(crate) fn first_moment_tolerance(&self) -> f64 {
        BALANCE_TOLERANCE * self.mass * self.size()
    }

    /// Tolerance of |C_kl|, kg m²: up to this it is treated as zero.
    pub(crate) fn coupling_tolerance(&self) -> f64 {
        BALANCE_TOLERANCE * self.mass * self.size().powi(2)
    }

    /// Length scale √(Σ H_kk / M), m.
    fn size(&self) -> f64 {
        (0..self.drives).map(|k| self.diagonal(k)).sum::<f64>().max(0.0).sqrt() / self.mass.sqrt()
    }
}

/// Relative tolerance of balance: residuals up to this fraction of the machine's scale are treated as zero.
pub const BALANCE_TOLERANCE: f64 = 1e-9;
