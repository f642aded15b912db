//! [`MovingBody`]: constants of all moving parts, and their equations of motion.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | n, N | numbers of drives and of rotational coordinates: N = n on a fixed base, n + 1 on a moving one, θ last | |
//! | M_t | m_b + M: base (centre of mass ρ from B in its axes, inertia I_b about that point) and manipulator | kg |
//! | R, P | centre of mass of all moving parts, and their momentum M_t Ṙ | m, kg m/s |
//! | p_B | position of B, R − Σ g_k e_k / M_t | m |
//! | C'_kl | couplings about R: C_kl − ḡ_k g_l / M_t | kg m² |
//! | π_k | momenta H q̇; on a moving base, H is formed from C' | kg m²/s |
//! | L | angular momentum about R, Σ π_k; stored in place of π_θ | kg m²/s |
//!
//! # Method
//! A moving base is treated as one more drive, see [`FreeBody`]. With everything referred to R the kinetic energy is
//! |P|²/2M_t + ½ q̇ᵀ H' q̇, with H' formed from C'. So π̇_k = ∂T/∂q_k + Q_k, and only outer forces change P and L. On a free base without outer forces both are
//! constant to the last digit. Gravity has no lever about R.

use super::{Base, BaseKind, Contacts, Friction, SlipDirections, Slope, State};
use stillbase_mechanics::arm_on_base::FreeBody;
use stillbase_mechanics::dynamics::{BaseWrench, ExternalLoads, assemble, matrix_times};
use stillbase_mechanics::machine::{Inertia, Machine, MachineError};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Pose2, UnitVectors, Vector, cross, dot};

const I: Vector = Vector::new(0.0, 1.0);

/// Support of a moving base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Support {
    /// N/m along x and y, N m/rad.
    stiffness: [f64; 3],
    /// N s/m along x and y, N m s/rad.
    pub(super) damping: [f64; 3],
    /// Force and moment at the start pose, N, N m.
    preload: (Vector, f64),
}

/// Constants of all moving parts.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingBody {
    /// The manipulator with its payload.
    pub(super) arm: Inertia,
    /// Inertia of all rotating parts: about B on a fixed base, about R on a moving one.
    pub(super) rotating: Inertia,
    pub(super) moves: bool,
    /// Whether the base is free, so that it carries no weight.
    is_free: bool,
    /// M_t, kg.
    pub(super) mass: f64,
    /// Position of B relative to R as a chain, m: the coefficients of the unit vectors e_k.
    pub(super) base_chain: [Vector; MAX_DRIVES],
    /// Position of the end effector as a chain, m: relative to B on a fixed base, to R on a moving one.
    pub(super) end_effector_chain: [Vector; MAX_DRIVES],
    pub(super) support: Support,
    pub(super) contacts: Contacts,
    pub(super) around: ExternalLoads,
    /// Mass of the base, kg, and mass times ρ, kg m.
    base: (f64, Vector),
}

impl MovingBody {
    /// Builds the constants of a machine with its payload on its base; `start` is the pose of rest for which a
    /// compliant base is preloaded.
    ///
    /// # Errors
    /// If a moving base exceeds the maximum number of rotational coordinates.
    pub fn of(machine: &Machine, friction: &Friction, base: &Base, start: &DriveAngles) -> Result<Self, MachineError> {
        let n = machine.drives();
        let mut arm = Inertia::of(machine);
        let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
        let real = |chain: &[f64; MAX_DRIVES]| chain.map(|w| Vector::new(w, 0.0));
        let zero = [Vector::default(); MAX_DRIVES];
        if !base.moves() {
            let contacts = Contacts::of(machine, friction, None);
            let end_effector_chain = real(&arm.end_effector);
            let rotating = arm.clone();
            let (mass, support, base) = (arm.mass, Support::default(), (0.0, Vector::default()));
            return Ok(Self {
                arm,
                rotating,
                moves: false,
                is_free: false,
                mass,
                base_chain: zero,
                end_effector_chain,
                support,
                contacts,
                around,
                base,
            });
        }
        if arm.grounded {
            let why = "it has links with drive = \"ground\", which are simulated on a fixed base, or as a block of an \
                       assembly: want base.kind = fixed";
            return Err(MachineError::Syntax(format!("{} on a base that moves: {why}", machine.name())));
        }
        let FreeBody { rotating, mass, base_chain, .. } = FreeBody::of(&arm, &base.body())?;
        arm.turn_base();
        let (rho, g) = (base.body().com, rotating.g);
        let mut end_effector_chain = real(&arm.end_effector);
        end_effector_chain.iter_mut().zip(&base_chain).for_each(|(tip, anchor)| *tip += anchor);
        let support = match base.kind {
            BaseKind::Compliant => {
                let units = start.units();
                let moment = (0..n).map(|k| g[k] * units[k]).sum::<Vector>() + g[n];
                let preload = (-mass * around.gravity, -cross(moment, around.gravity));
                Support { stiffness: base.stiffness, damping: base.damping, preload }
            }
            _ => Support::default(),
        };
        let contacts = Contacts::of(machine, friction, Some(n));
        let (kind, base) = (base.kind, (base.mass, base.mass * rho));
        let is_free = kind == BaseKind::Free;
        Ok(Self {
            arm,
            rotating,
            moves: true,
            is_free,
            mass,
            base_chain,
            end_effector_chain,
            support,
            contacts,
            around,
            base,
        })
    }

    /// Returns the body with another force at the end effector, N.
    #[must_use]
    pub fn with_force(mut self, force: Vector) -> Self {
        self.around.force = force;
        self
    }

    /// Returns the body with the preload of another body's support.
    #[must_use]
    pub fn preloaded_as(mut self, other: &Self) -> Self {
        if self.moves && other.moves {
            self.support.preload = other.support.preload;
        }
        self
    }

    /// Returns the manipulator with its payload.
    pub fn arm(&self) -> &Inertia {
        &self.arm
    }

    /// Returns gravity and the force at the end effector.
    pub fn around(&self) -> &ExternalLoads {
        &self.around
    }

    /// Returns the contacts with friction.
    pub fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    /// Returns whether the base moves.
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// Returns the number N of rotational coordinates: the drives, and a moving base.
    pub(crate) fn turning(&self) -> usize {
        self.rotating.drives
    }

    /// Returns the state for given absolute angles and rates of the drives, and pose and rates of the base.
    pub fn state(&self, q: &DriveAngles, qd: &PerDrive, base: Pose2, velocity: Vector, turning: f64) -> State {
        let n = q.len();
        let turns = |drives: &[f64], last: f64| {
            PerDrive::from_fn(self.rotating.drives, |k| drives.get(k).copied().unwrap_or(last))
        };
        let (q, qd) = (turns(q, base.angle), turns(qd, turning));
        let e = DriveAngles(q).units();
        let (h, _) = stillbase_mechanics::dynamics::mass_matrix(&self.rotating, &e, &qd);
        let mut momenta = h.times(&qd);
        let (mut place, mut momentum) = (Vector::default(), Vector::default());
        if self.moves {
            momenta[n] = momenta.iter().sum();
            let (lever, swing) = self.seen(&self.base_chain, &e, &qd);
            place = base.at - lever;
            momentum = self.mass * (velocity - swing);
        }
        let impulse = (Vector::default(), 0.0);
        State { q, momenta, position: place, momentum, wheel: 0.0, work: 0.0, lost: 0.0, impulse }
    }

    /// Returns the state from which a run begins: for given angles and rates of the drives, seen from a base at the origin.
    /// A free base moves so that all momentum is zero, as if everything had rested before; another base rests.
    pub fn started(&self, q: &DriveAngles, qd: &PerDrive) -> State {
        let turning_at = |rate: f64| {
            let absolute = PerDrive::from_fn(qd.len(), |k| qd[k] + rate);
            self.state(q, &absolute, Pose2::default(), Vector::default(), rate)
        };
        let resting = turning_at(0.0);
        if !self.is_free {
            return resting;
        }
        // The angular momentum of everything, which is linear in the rate of the base.
        let total = |state: &State| state.momenta[q.len()];
        let rate = -total(&resting) / (total(&turning_at(1.0)) - total(&resting));
        State { momentum: Vector::default(), ..turning_at(rate) }
    }

    /// Returns the position and velocity of the point that a chain describes, m and m/s, relative to the chain's
    /// origin.
    #[inline(always)]
    pub(super) fn seen(&self, chain: &[Vector; MAX_DRIVES], e: &UnitVectors, qd: &PerDrive) -> (Vector, Vector) {
        (0..self.rotating.drives).fold(Default::default(), |(p, v), k| {
            let arm = chain[k] * e[k];
            (p + arm, v + I * arm * qd[k])
        })
    }

    /// Returns the static and dynamic parts of the wrench of the manipulator on its base. A free base carries no
    /// weight: the weight then belongs to the dynamic part, where it cancels in free fall.
    pub fn transmitted(&self, x: &Slope) -> BaseWrench {
        let mut wrench = x.wrench;
        if self.is_free {
            let weight = self.arm.mass * self.around.gravity;
            let moment = cross(stillbase_mechanics::dynamics::first_moment(&self.arm, &x.e), self.around.gravity);
            wrench.static_part.force -= weight;
            wrench.dynamic.force += weight;
            wrench.static_part.moment -= moment;
            wrench.dynamic.moment += moment;
        }
        wrench
    }

    /// Returns the moment that turns the base, N m: that of the arm less the torque of a wheel, about the base pin, or about
    /// a free base's own centre of mass. `wrench` is that about the pin, `e` are the unit vectors of all coordinates.
    #[inline]
    pub(crate) fn felt_moment(&self, wrench: &BaseWrench, e: &[Vector], wheel_torque: f64) -> f64 {
        let wrench = wrench.total();
        let pin_moment = wrench.moment - wheel_torque;
        let (mass, moment) = self.base;
        let lever = || moment / mass * e[self.arm.drives];
        if self.is_free { pin_moment - cross(lever(), wrench.force) } else { pin_moment }
    }

    /// Returns the potential energy of weight and springs, J.
    pub fn potential(&self, x: &Slope) -> f64 {
        let weight = |g: Vector| -dot(self.around.gravity, g);
        if !self.moves {
            return weight(stillbase_mechanics::dynamics::first_moment(&self.arm, &x.e));
        }
        let (lever, _) = self.seen(&self.base_chain, &x.e, &x.qd);
        let Support { stiffness: [kx, ky, kt], preload: (force, moment), .. } = self.support;
        let (p, angle) = (x.base.at, x.base.angle);
        weight(self.mass * (p - lever)) - dot(force, p) - moment * angle
            + 0.5 * (kx * p.re * p.re + ky * p.im * p.im + kt * angle * angle)
    }

    /// Returns the momentum of all moving parts, kg m/s, and their angular momentum about the origin, kg m²/s, computed
    /// from rates.
    pub fn momentum(&self, x: &Slope) -> (Vector, f64) {
        let (p, h) = self.arm_momentum(x);
        if !self.moves {
            return (p, h);
        }
        let n = self.arm.drives;
        let ((mass, rho), spin) = (self.base, self.base_spin());
        let arm = rho * x.e[n];
        let own = mass * x.base_velocity + I * arm * x.qd[n];
        let turning = cross(x.base.at, own) + cross(arm, x.base_velocity) + spin * x.qd[n];
        (p + own, h + turning)
    }

    /// Returns the momentum, kg m/s, and the angular momentum about the origin, kg m²/s, of the manipulator with its
    /// payload.
    pub fn arm_momentum(&self, x: &Slope) -> (Vector, f64) {
        let n = self.arm.drives;
        let qd = x.qd.first(n);
        let lever = stillbase_mechanics::dynamics::first_moment(&self.arm, &x.e);
        let p = stillbase_mechanics::dynamics::linear_momentum(&self.arm, &x.e, &qd) + self.arm.mass * x.base_velocity;
        let mut h = stillbase_mechanics::dynamics::angular_momentum(&self.arm, &x.e, &qd);
        if self.moves {
            h += self.arm.excess_rotor_momentum(&x.qd);
        }
        (p, h + cross(x.base.at, p) + cross(lever, x.base_velocity))
    }

    /// Returns the inertia of the base about B, I_b + m_b |ρ|², kg m².
    fn base_spin(&self) -> f64 {
        let n = self.arm.drives;
        let g = -self.base_chain[n] * self.mass;
        self.rotating.c[n][n].re + self.rotating.spin[n] - self.arm.spin[n] + g.norm_sqr() / self.mass
    }

    /// Returns whether the base is free.
    #[inline]
    pub(crate) fn is_free(&self) -> bool {
        self.is_free
    }

    /// Returns the torques, N m, that give the drives commanded accelerations relative to a moving base, rad/s²
    /// (inverse dynamics). Entries beyond the drives are zero. `wheel` returns the torque of a wheel on the base, N m.
    /// Its arguments are the moment that would turn the whole machine without a wheel, N m, and the machine's inertia,
    /// kg m².
    #[inline]
    pub(crate) fn torque_for<const N: usize>(
        &self,
        commanded: &[f64; N],
        e: &[Vector; N],
        rate: &[f64; N],
        base: Pose2,
        velocity: Vector,
        wheel: impl FnOnce(f64, f64) -> f64,
    ) -> [f64; N] {
        let (h, v) = assemble(&self.rotating, e, rate);
        let outer = self.outer::<N, true>(e, self.support_reaction(base, velocity, rate[N - 1]));
        // Torques between drives and base cancel, so the sum of all equations gives the acceleration of the base.
        let sum = |x: &[f64; N]| x.iter().sum::<f64>();
        let all: f64 = (0..N).map(|k| (0..N).map(|l| h[l][k]).sum::<f64>()).sum();
        let moment = sum(&outer) - sum(&matrix_times(&h, commanded)) - sum(&v);
        let turn = (moment - wheel(moment, all)) / all;
        let inertial = matrix_times(&h, &commanded.map(|a| a + turn));
        let mut torque = std::array::from_fn(|k| inertial[k] + v[k] - outer[k]);
        torque[N - 1] = 0.0;
        torque
    }

    /// Returns the generalised forces of weight, of the force at the end effector and of the support, N m. The last
    /// entry is the moment on a moving base. Weight has no lever about R, the reference point on a moving base.
    #[inline(always)]
    pub(super) fn outer<const N: usize, const MOVES: bool>(
        &self,
        e: &[Vector; N],
        (support_force, moment): (Vector, f64),
    ) -> [f64; N] {
        let ExternalLoads { gravity, force } = self.around;
        let mut outer = std::array::from_fn(|k| match MOVES {
            true => cross(self.end_effector_chain[k] * e[k], force) + cross(self.base_chain[k] * e[k], support_force),
            false => cross(self.arm.g[k] * e[k], gravity) + cross(e[k] * self.arm.end_effector[k], force),
        });
        if MOVES {
            outer[N - 1] += moment;
        }
        outer
    }

    /// Returns the force and moment of the support on a moving base, N, N m.
    #[inline(always)]
    pub(super) fn support_reaction(&self, base: Pose2, velocity: Vector, turning: f64) -> (Vector, f64) {
        let Support { stiffness: k, damping: c, preload: (force, moment) } = &self.support;
        let (p, v) = (base.at, velocity);
        let force = force - Vector::new(k[0] * p.re + c[0] * v.re, k[1] * p.im + c[1] * v.im);
        (force, moment - k[2] * base.angle - c[2] * turning)
    }
}

impl MovingBody {
    /// Returns the rates of a state, rad/s.
    pub fn rates(&self, state: &State) -> PerDrive {
        let e = DriveAngles(state.q).units();
        let (h, _) = stillbase_mechanics::dynamics::mass_matrix(&self.rotating, &e, &state.q);
        h.solve(&self.own_momenta(state))
    }

    /// Returns the momenta π_k, kg m²/s; on a moving base the last entry is π_θ instead of L.
    fn own_momenta(&self, state: &State) -> PerDrive {
        let mut momenta = state.momenta;
        if self.moves {
            let n = self.arm.drives;
            momenta[n] -= momenta[..n].iter().sum::<f64>();
        }
        momenta
    }

    /// Returns the approximate reduced inertia of a contact, kg m².
    pub fn reduced_inertia(&self, i: usize) -> f64 {
        let of = |k: usize| self.rotating.c[k][k].re + self.rotating.spin[k];
        // The ground, against which pins of links that keep their orientation turn, does not move.
        self.contacts.reduced_inertia(i, |k| if k < self.rotating.drives { of(k) } else { f64::INFINITY })
    }

    /// Returns a state in which stuck contacts have a sliding rate of zero to rounding.
    /// Internal impulses between the two sides
    /// remove the residual rate; they do not change the total momentum. The residual is rounding and integration error.
    /// The energy removed is not counted as lost, so that the audits show any larger residual.
    #[must_use]
    pub fn with_stuck_stopped(&self, mut state: State, slip: &SlipDirections) -> State {
        let still = |i: &usize| self.contacts.can_stick(*i) && slip[*i] == 0;
        if !(0..self.contacts.len()).any(|i| still(&i)) {
            return state;
        }
        let n = self.arm.drives;
        let e = DriveAngles(state.q).units();
        let (h, _) = stillbase_mechanics::dynamics::mass_matrix(&self.rotating, &e, &state.q);
        for _ in 0..8 {
            let mut fastest: f64 = 0.0;
            for i in (0..self.contacts.len()).filter(still) {
                let v = self.contacts.sliding(i, &h.solve(&self.own_momenta(&state)));
                let mut unit = PerDrive::zeros(self.rotating.drives);
                self.contacts.apply(i, 1.0, &mut unit);
                let give = -self.contacts.sliding(i, &h.solve(&unit));
                for k in 0..n {
                    state.momenta[k] += unit[k] * v / give;
                }
                fastest = fastest.max(v.abs());
            }
            if fastest < 1e-16 {
                break;
            }
        }
        state
    }
}
