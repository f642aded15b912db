//! [`MovingBody`]: everything that moves, collapsed into constants, and its equations of motion.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | n, N | drives; what turns: N = n on a fixed base, n + 1 on one that moves, the last being θ | |
//! | M_t | mass of all that moves, m_b + M | kg |
//! | R, P | centre of mass of all that moves, its momentum M_t Ṙ | m, kg m/s |
//! | p_B | position of B, R − Σ g_k e_k / M_t | m |
//! | C'_kl | couplings about R: C_kl − ḡ_k g_l / M_t | kg m² |
//! | π_k | momenta H q̇, with C' on a base that moves | kg m²/s |
//! | L | angular momentum about R, Σ π_k; stands in the place of π_θ | kg m²/s |
//!
//! # Method
//! A base is one more drive, with g_0 = m_b ρ, C_00 = m_b |ρ|², J_0 = I_b. Its translation leaves the equations when
//! everything is referred to R: the kinetic energy is |P|²/2M_t + ½ q̇ᵀ H' q̇ with H' made of C', so
//! π̇_k = ∂T/∂q_k + Q_k, and P and L change by outer forces only: a free base keeps both to the last digit. Gravity
//! has no lever about R.

use super::{Base, BaseKind, Contacts, Friction, MAX_CONTACTS, MotorCommand, SlipDirections, Slope, State, WheelState};
use crate::mechanics::dynamics::{BaseWrench, Factors, Surroundings, base_wrench, by_drives, first};
use crate::mechanics::machine::{Inertia, Machine, MachineError};
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Pose2, Units, Vector, cross, dot};

const I: Vector = Vector::new(0.0, 1.0);

/// What holds a base that moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Support {
    stiffness: [f64; 3],
    damping: [f64; 3],
    /// What it gives at the start pose, N, N m.
    preload: (Vector, f64),
}

/// Everything that moves.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingBody {
    /// The manipulator with what it holds.
    arm: Inertia,
    /// All that turns: about B on a fixed base, about R on one that moves.
    whole: Inertia,
    moves: bool,
    /// Whether nothing holds the base, so that weight is not carried.
    falls: bool,
    /// M_t, kg.
    mass: f64,
    /// Lever of gravity about what the coordinates refer to: g_k on a fixed base, none on one that moves.
    lever: [Vector; MAX_DRIVES],
    /// B seen from R.
    anchor: [Vector; MAX_DRIVES],
    /// The end effector seen from B on a fixed base, from R on one that moves.
    tip: [Vector; MAX_DRIVES],
    support: Support,
    contacts: Contacts,
    around: Surroundings,
    /// Base mass times ρ, and base mass: for its own momentum.
    base: (f64, Vector),
}

impl MovingBody {
    /// Constants of a machine with what it holds, on its base; `start` is the pose of rest that a compliant base is
    /// preloaded for.
    ///
    /// # Errors
    /// If a base that moves is one too many to turn.
    pub fn of(machine: &Machine, friction: &Friction, base: &Base, start: &DriveAngles) -> Result<Self, MachineError> {
        let n = machine.drives();
        let arm = Inertia::of(machine);
        let around = Surroundings { gravity: machine.gravity(), force: Vector::default() };
        let real = |chain: &[f64; MAX_DRIVES]| chain.map(|w| Vector::new(w, 0.0));
        let nothing = [Vector::default(); MAX_DRIVES];
        if !base.moves() {
            let contacts = Contacts::of(machine, friction, None);
            let (lever, tip) = (arm.g, real(&arm.end_effector));
            let whole = arm.clone();
            let (mass, support, base) = (arm.mass, Support::default(), (0.0, Vector::default()));
            return Ok(Self {
                arm,
                whole,
                moves: false,
                falls: false,
                mass,
                lever,
                anchor: nothing,
                tip,
                support,
                contacts,
                around,
                base,
            });
        }
        if n >= MAX_DRIVES {
            let want = format!("at most {} on a base that moves", MAX_DRIVES - 1);
            return Err(MachineError::Count { what: "drives", count: n, want });
        }
        let rho = Vector::new(base.com[0], base.com[1]);
        let mut whole = arm.clone();
        whole.drives = n + 1;
        let mut of_base = nothing;
        of_base[n] = rho;
        whole.add(base.mass, base.inertia, n, &of_base);
        let g = whole.g;
        let mass = whole.mass;
        for k in 0..=n {
            for l in 0..=n {
                whole.c[k][l] -= g[k].conj() * g[l] / mass;
            }
        }
        let anchor = g.map(|g| -g / mass);
        let mut tip = real(&arm.end_effector);
        tip.iter_mut().zip(&anchor).for_each(|(tip, anchor)| *tip += anchor);
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
        let falls = kind == BaseKind::Free;
        Ok(Self { arm, whole, moves: true, falls, mass, lever: nothing, anchor, tip, support, contacts, around, base })
    }

    /// The same with another force at the end effector, N.
    #[must_use]
    pub fn pushed(mut self, force: Vector) -> Self {
        self.around.force = force;
        self
    }

    /// The same, preloaded as another.
    #[must_use]
    pub fn preloaded_as(mut self, other: &Self) -> Self {
        if self.moves && other.moves {
            self.support.preload = other.support.preload;
        }
        self
    }

    /// The manipulator with what it holds.
    pub fn arm(&self) -> &Inertia {
        &self.arm
    }

    /// Gravity and the force at the end effector.
    pub fn around(&self) -> &Surroundings {
        &self.around
    }

    /// The contacts with friction.
    pub fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    /// Whether the base moves.
    pub fn moves(&self) -> bool {
        self.moves
    }

    /// The state of given angles and rates of the drives, pose and rates of the base.
    pub fn state(&self, q: &DriveAngles, qd: &PerDrive, base: Pose2, velocity: Vector, turning: f64) -> State {
        let n = q.len();
        let turns = |drives: &[f64], last: f64| {
            PerDrive::from_fn(self.whole.drives, |k| drives.get(k).copied().unwrap_or(last))
        };
        let (q, qd) = (turns(q, base.angle), turns(qd, turning));
        let e = DriveAngles(q).units();
        let (h, _) = crate::mechanics::dynamics::mass_matrix(&self.whole, &e, &qd);
        let mut momenta = h.times(&qd);
        let (mut place, mut momentum) = (Vector::default(), Vector::default());
        if self.moves {
            momenta[n] = momenta.iter().sum();
            let (lever, swing) = self.seen(&self.anchor, &e, &qd);
            place = base.at - lever;
            momentum = self.mass * (velocity - swing);
        }
        let impulse = (Vector::default(), 0.0);
        State { q, momenta, place, momentum, wheel: 0.0, work: 0.0, lost: 0.0, impulse }
    }

    /// A point given as a sum of unit vectors, and its rate.
    #[inline(always)]
    fn seen(&self, chain: &[Vector; MAX_DRIVES], e: &Units, qd: &PerDrive) -> (Vector, Vector) {
        (0..self.whole.drives).fold(Default::default(), |(p, v), k| {
            let arm = chain[k] * e[k];
            (p + arm, v + I * arm * qd[k])
        })
    }

    /// Rates, torques, accelerations and base wrench of a state. `control` is asked for the torques, given unit
    /// vectors and rates of all that turns, and pose and velocity of B.
    #[inline]
    pub fn instant(
        &self,
        state: &State,
        slip: &SlipDirections,
        stuck_torque: &mut [f64; MAX_CONTACTS],
        control: impl FnOnce(&Units, &PerDrive, Pose2, Vector) -> MotorCommand,
    ) -> Slope {
        by_drives!(self.whole.drives, instant_of(self, state, slip, stuck_torque, control))
    }

    /// What the manipulator transmits to its base, in its two parts. On a base that nothing holds weight is not
    /// carried: what it and the fall leave of each other is motion.
    pub fn transmitted(&self, x: &Slope) -> BaseWrench {
        let mut wrench = x.wrench;
        if self.falls {
            let weight = self.arm.mass * self.around.gravity;
            let moment = cross(crate::mechanics::dynamics::first_moment(&self.arm, &x.e), self.around.gravity);
            wrench.statical.force -= weight;
            wrench.dynamic.force += weight;
            wrench.statical.moment -= moment;
            wrench.dynamic.moment += moment;
        }
        wrench
    }

    /// Potential energy of weight and springs, J.
    pub fn potential(&self, x: &Slope) -> f64 {
        let n = self.arm.drives;
        let weight = |g: Vector| -dot(self.around.gravity, g);
        if !self.moves {
            return weight((0..n).map(|k| self.arm.g[k] * x.e[k]).sum());
        }
        let (lever, _) = self.seen(&self.anchor, &x.e, &x.qd);
        let Support { stiffness: [kx, ky, kt], preload: (force, moment), .. } = self.support;
        let (p, angle) = (x.base.at, x.base.angle);
        weight(self.mass * (p - lever)) - dot(force, p) - moment * angle
            + 0.5 * (kx * p.re * p.re + ky * p.im * p.im + kt * angle * angle)
    }

    /// Momentum of all that moves, kg m/s, and its angular momentum about the origin, kg m²/s, from rates.
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

    /// The same of the manipulator with what it holds.
    pub fn arm_momentum(&self, x: &Slope) -> (Vector, f64) {
        let n = self.arm.drives;
        let qd = x.qd.first(n);
        let lever = crate::mechanics::dynamics::first_moment(&self.arm, &x.e);
        let p = crate::mechanics::dynamics::linear_momentum(&self.arm, &x.e, &qd) + self.arm.mass * x.base_velocity;
        let h = crate::mechanics::dynamics::angular_momentum(&self.arm, &x.e, &qd);
        (p, h + cross(x.base.at, p) + cross(lever, x.base_velocity))
    }

    /// I_b + m_b |ρ|², kg m².
    fn base_spin(&self) -> f64 {
        let n = self.arm.drives;
        let g = -self.anchor[n] * self.mass;
        self.whole.c[n][n].re + self.whole.spin[n] + g.norm_sqr() / self.mass
    }

    /// The torques that would give the drives these accelerations relative to the base, rad/s², in this state of
    /// motion: what a controller that knows everything computes.
    pub fn torque_for(
        &self,
        commanded: &PerDrive,
        e: &Units,
        qd: &PerDrive,
        base: Pose2,
        velocity: Vector,
    ) -> PerDrive {
        let n = commanded.len();
        let (h, v) = crate::mechanics::dynamics::mass_matrix(&self.whole, e, qd);
        let hold = self.held(base, velocity, qd.get(n).copied().unwrap_or(0.0));
        let outer = by_drives!(self.whole.drives, outer_padded(self, e, hold));
        let mut qdd = PerDrive::from_fn(self.whole.drives, |k| commanded.get(k).copied().unwrap_or(0.0));
        if self.moves {
            // Torques between drives and base cancel, so the base turns by what outer forces leave.
            let sum = |x: &PerDrive| x.iter().sum::<f64>();
            let all: f64 = (0..=n).map(|k| h.momentum_row(k)).sum();
            let turn = (sum(&outer) - sum(&h.times(&qdd)) - sum(&v)) / all;
            qdd.iter_mut().for_each(|a| *a += turn);
        }
        let inertial = h.times(&qdd);
        PerDrive::from_fn(n, |k| inertial[k] + v[k] - outer[k])
    }

    /// Generalised forces of weight, of the force at the end effector and of the support, N m, the moment on the base
    /// last.
    #[inline(always)]
    fn outer<const N: usize>(&self, e: &Units, (hold, moment): (Vector, f64)) -> [f64; N] {
        let mut outer = std::array::from_fn(|k| {
            cross(self.lever[k] * e[k], self.around.gravity)
                + cross(self.tip[k] * e[k], self.around.force)
                + cross(self.anchor[k] * e[k], hold)
        });
        if self.moves {
            outer[N - 1] += moment;
        }
        outer
    }

    /// Force and moment of the support on a base that moves, N, N m.
    #[inline(always)]
    fn held(&self, base: Pose2, velocity: Vector, turning: f64) -> (Vector, f64) {
        let Support { stiffness: k, damping: c, preload: (force, moment) } = &self.support;
        let (p, v) = (base.at, velocity);
        let force = force - Vector::new(k[0] * p.re + c[0] * v.re, k[1] * p.im + c[1] * v.im);
        (force, moment - k[2] * base.angle - c[2] * turning)
    }
}

fn outer_padded<const N: usize>(body: &MovingBody, e: &Units, hold: (Vector, f64)) -> PerDrive {
    body.outer::<N>(e, hold).into()
}

#[inline]
fn instant_of<const N: usize>(
    body: &MovingBody,
    state: &State,
    slip: &SlipDirections,
    stuck_torque: &mut [f64; MAX_CONTACTS],
    control: impl FnOnce(&Units, &PerDrive, Pose2, Vector) -> MotorCommand,
) -> Slope {
    let n = body.arm.drives;
    let e = DriveAngles(state.q).units();
    // Mass matrix and the part of the couplings that rates act through.
    let (mut h, mut im) = ([[0.0; N]; N], [[0.0; N]; N]);
    for k in 0..N {
        h[k][k] = body.whole.c[k][k].re + body.whole.spin[k];
        for l in k + 1..N {
            let z = body.whole.c[k][l] * (e[k].conj() * e[l]);
            h[k][l] = z.re;
            h[l][k] = z.re;
            im[k][l] = z.im;
        }
    }
    let factors = Factors::of(&h);
    let mut momenta = *first::<N, _>(state.momenta.padded());
    if body.moves {
        momenta[N - 1] -= momenta[..N - 1].iter().sum::<f64>();
    }
    let rate = factors.solve(momenta);
    let (mut gain, mut v) = ([0.0; N], [0.0; N]);
    for k in 0..N {
        for l in k + 1..N {
            let x = im[k][l] * rate[k] * rate[l];
            gain[k] += x;
            gain[l] -= x;
            v[k] -= im[k][l] * (rate[l] * rate[l]);
            v[l] += im[k][l] * (rate[k] * rate[k]);
        }
    }
    let qd = PerDrive::from(rate);
    let (mut base, mut velocity, mut turning) = (Pose2::default(), Vector::default(), 0.0);
    let mut drift = Vector::default();
    if body.moves {
        drift = state.momentum / body.mass;
        let (lever, swing) = body.seen(&body.anchor, &e, &qd);
        base = Pose2 { at: state.place + lever, angle: state.q[N - 1] };
        velocity = drift + swing;
        turning = rate[N - 1];
    }
    let MotorCommand { torque, spin, rotor } = control(&e, &qd, base, velocity);

    // Generalised forces: outer ones, whose sum changes L, and torques between the drives and the base.
    let (hold, moment) = body.held(base, velocity, turning);
    let mut force = body.outer::<N>(&e, (hold, moment - spin.torque));
    let external: f64 = force.iter().sum();
    let (_, tip_velocity) = body.seen(&body.tip, &e, &qd);
    let mut power = dot(body.around.force, tip_velocity + drift) + spin.torque * (spin.rate - turning);
    for k in 0..n.min(N) {
        force[k] += torque[k];
        power += torque[k] * (rate[k] - turning);
    }
    let mut friction = PerDrive::zeros(n);
    let (mut loss, mut momentum_rate) = (0.0, Vector::default());
    if body.moves {
        force[N - 1] -= torque.iter().sum::<f64>();
        let c = &body.support.damping;
        loss += c[0] * velocity.re.powi(2) + c[1] * velocity.im.powi(2) + c[2] * turning * turning;
        momentum_rate = body.mass * body.around.gravity + body.around.force + hold;
    }
    if !body.contacts.is_empty() {
        loss += body.contacts.slide(slip, &rate, &mut force, &mut friction);
        let free = factors.solve(std::array::from_fn(|k| force[k] - v[k]));
        let solve = |x: &[f64; MAX_DRIVES]| {
            let mut padded = [0.0; MAX_DRIVES];
            padded[..N].copy_from_slice(&factors.solve(*first::<N, _>(x)));
            padded
        };
        loss += body.contacts.hold(slip, (&rate, &free), solve, &mut force, &mut friction, stuck_torque);
    }
    let acceleration = factors.solve(std::array::from_fn(|k| force[k] - v[k]));
    let qdd = PerDrive::from(acceleration);
    let mut momenta_rate = PerDrive::from(std::array::from_fn::<_, N, _>(|k| gain[k] + force[k]));
    if body.moves {
        momenta_rate[N - 1] = external;
    }
    // The wrench from the accelerations and not from the torques, so that a zero is found and not assumed.
    let mut base_acceleration = Vector::default();
    let wrench = if body.moves {
        let pull: Vector =
            (0..N).map(|k| body.anchor[k] * e[k] * Vector::new(-rate[k] * rate[k], acceleration[k])).sum();
        base_acceleration = momentum_rate / body.mass + pull;
        let mut wrench = base_wrench(&body.arm, &e, &qd.first(n), &qdd.first(n), &body.around);
        let lever = crate::mechanics::dynamics::first_moment(&body.arm, &e);
        wrench.dynamic.force -= body.arm.mass * base_acceleration;
        wrench.dynamic.moment -= cross(lever, base_acceleration);
        wrench
    } else {
        let rate_of: f64 = (0..N).map(|k| (0..N).map(|l| h[k][l] * acceleration[l]).sum::<f64>() + v[k]).sum();
        crate::mechanics::dynamics::wrench_with(
            &body.arm,
            first::<N, _>(&e),
            &rate,
            &acceleration,
            &body.around,
            rate_of,
        )
    };
    let kinetic = 0.5 * (0..N).map(|k| momenta[k] * rate[k]).sum::<f64>()
        + 0.5 * dot(state.momentum, drift)
        + 0.5 * rotor * spin.rate * spin.rate;
    Slope {
        e,
        qd,
        qdd,
        torque,
        friction,
        spin,
        base,
        base_velocity: velocity,
        base_acceleration,
        wrench,
        kinetic,
        power,
        loss,
        momenta_rate,
        place_rate: drift,
        momentum_rate,
        wheel_rate: if rotor > 0.0 { spin.torque / rotor } else { 0.0 },
    }
}

impl MovingBody {
    /// Rates of a state, rad/s.
    pub fn rates(&self, state: &State) -> PerDrive {
        let e = DriveAngles(state.q).units();
        let (h, _) = crate::mechanics::dynamics::mass_matrix(&self.whole, &e, &state.q);
        h.solve(&self.own_momenta(state))
    }

    /// π_k, with that of the base in its place, kg m²/s.
    fn own_momenta(&self, state: &State) -> PerDrive {
        let mut momenta = state.momenta;
        if self.moves {
            let n = self.arm.drives;
            momenta[n] -= momenta[..n].iter().sum::<f64>();
        }
        momenta
    }

    /// About what a contact's two sides resist a torque between them with, kg m².
    pub fn resists(&self, i: usize) -> f64 {
        self.contacts.resists(i, |k| self.whole.c[k][k].re + self.whole.spin[k])
    }

    /// A state in which what is stuck stands still to the last digit: what is left of its motion is taken out by
    /// torques between the two sides, which change no momentum of the whole. That is rounding, and the error of a step;
    /// it is booked nowhere, so that audits see it if it is more.
    #[must_use]
    pub fn stuck(&self, mut state: State, slip: &SlipDirections) -> State {
        let still = |i: &usize| self.contacts.sticks(*i) && slip[*i] == 0;
        if !(0..self.contacts.len()).any(|i| still(&i)) {
            return state;
        }
        let n = self.arm.drives;
        let e = DriveAngles(state.q).units();
        let (h, _) = crate::mechanics::dynamics::mass_matrix(&self.whole, &e, &state.q);
        for _ in 0..8 {
            let mut most: f64 = 0.0;
            for i in (0..self.contacts.len()).filter(still) {
                let v = self.contacts.sliding(i, &h.solve(&self.own_momenta(&state)));
                let mut unit = PerDrive::zeros(self.whole.drives);
                self.contacts.apply(i, 1.0, &mut unit);
                let give = -self.contacts.sliding(i, &h.solve(&unit));
                for k in 0..n {
                    state.momenta[k] += unit[k] * v / give;
                }
                most = most.max(v.abs());
            }
            if most < 1e-16 {
                break;
            }
        }
        state
    }
}

impl MovingBody {
    /// A state without torques.
    pub fn still(&self, state: &State) -> Slope {
        let n = self.arm.drives;
        self.instant(state, &[0; MAX_CONTACTS], &mut [0.0; MAX_CONTACTS], |_, _, _, _| MotorCommand {
            torque: PerDrive::zeros(n),
            spin: WheelState::default(),
            rotor: 0.0,
        })
    }
}
