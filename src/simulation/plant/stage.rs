//! [`RungeKuttaStage`]: evaluation of the equations of motion at a state, with arrays of compile-time size. Integration
//! steps have several stages; in each, padding to [`MAX_DRIVES`] and copying would cost more than the arithmetic.
//!
//! Unit vectors and mass matrix are computed once and used for rates, torques, accelerations and base wrench. A
//! compile-time parameter says whether the base moves.

use super::{FrictionTorques, MAX_CONTACTS, MovingBody, SlipDirections, Slope, State, WheelState};
use stillbase_mechanics::dynamics::{
    BaseWrench, Factors, angular_rate, assemble, by_drives, leading_entries, matrix_times, wrench_with,
};
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive, Pose2, Vector, cross, dot, unit, with_ground};

/// The part of a [`State`] on which the equations of motion depend.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReducedState<const N: usize> {
    pub q: [f64; N],
    pub momenta: [f64; N],
    pub position: Vector,
    pub momentum: Vector,
    pub wheel: f64,
}

/// The rate of each part of a [`State`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct StateRates<const N: usize> {
    /// q̇, rad/s.
    pub q: [f64; N],
    pub momenta: [f64; N],
    pub position: Vector,
    pub momentum: Vector,
    pub wheel: f64,
    /// Power of motors, wheel and outer force, W.
    pub work: f64,
    /// Power lost in friction and dampers, W.
    pub lost: f64,
    /// Dynamic f_B, N, and the dynamic moment about the origin, N m.
    pub impulse: (Vector, f64),
}

/// Commands of motors and wheel.
pub(crate) struct Actuation<const N: usize> {
    /// Motor torques, zero beyond the drives, N m.
    pub torque: [f64; N],
    /// State of the wheel.
    pub spin: WheelState,
    /// Inertia of the wheel's rotor, kg m².
    pub rotor: f64,
}

/// The quantities of a [`Slope`], with arrays of size `N`.
pub(crate) struct RungeKuttaStage<const N: usize> {
    pub e: [Vector; N],
    pub acceleration: [f64; N],
    pub torque: [f64; N],
    pub friction: [f64; N],
    pub spin: WheelState,
    pub base: Pose2,
    pub base_velocity: Vector,
    pub base_acceleration: Vector,
    pub wrench: BaseWrench,
    pub kinetic: f64,
    pub rates: StateRates<N>,
}

impl<const N: usize> ReducedState<N> {
    #[inline(always)]
    pub fn of(state: &State) -> Self {
        let State { position, momentum, wheel, .. } = *state;
        Self { q: *state.q.array(), momenta: *state.momenta.array(), position, momentum, wheel }
    }

    /// Returns the state that follows a state after `h` seconds at constant rates; `MOVES` says whether the base moves.
    #[inline(always)]
    pub fn along<const MOVES: bool>(from: &State, x: &StateRates<N>, h: f64) -> Self {
        let (q, momenta) = (from.q.array::<N>(), from.momenta.array::<N>());
        Self {
            q: std::array::from_fn(|k| q[k] + h * x.q[k]),
            momenta: std::array::from_fn(|k| momenta[k] + h * x.momenta[k]),
            position: if MOVES { from.position + h * x.position } else { from.position },
            momentum: if MOVES { from.momentum + h * x.momentum } else { from.momentum },
            wheel: from.wheel + h * x.wheel,
        }
    }
}

impl<const N: usize> StateRates<N> {
    #[inline(always)]
    pub fn of(x: &Slope) -> Self {
        Self {
            q: *x.qd.array(),
            momenta: *x.momenta_rate.array(),
            position: x.place_rate,
            momentum: x.momentum_rate,
            wheel: x.wheel_rate,
            work: x.power,
            lost: x.loss,
            impulse: impulse(&x.wrench, x.base.at),
        }
    }

    /// Makes a classical fourth-order Runge–Kutta step of `h` seconds from the rates at its start. `stage` evaluates a
    /// state; its second argument says whether that is at the end of the step, or half-way. Also returns the three
    /// stages.
    #[inline(always)]
    pub fn runge_kutta<const MOVES: bool>(
        from: &State,
        k1: &Self,
        h: f64,
        mut stage: impl FnMut(&ReducedState<N>, bool) -> RungeKuttaStage<N>,
    ) -> (State, [RungeKuttaStage<N>; 3]) {
        let k2 = stage(&ReducedState::along::<MOVES>(from, k1, 0.5 * h), false);
        let k3 = stage(&ReducedState::along::<MOVES>(from, &k2.rates, 0.5 * h), false);
        let k4 = stage(&ReducedState::along::<MOVES>(from, &k3.rates, h), true);
        let state = Self::stepped::<MOVES>(from, [k1, &k2.rates, &k3.rates, &k4.rates], h);
        (state, [k2, k3, k4])
    }

    /// Returns the state after `h` seconds from the rates at the start, twice half-way, and at the end.
    #[inline(always)]
    fn stepped<const MOVES: bool>(from: &State, k: [&Self; 4], h: f64) -> State {
        let w = [h / 6.0, h / 3.0, h / 3.0, h / 6.0];
        let mut state = *from;
        let (q, momenta) = (state.q.array_mut::<N>(), state.momenta.array_mut::<N>());
        for (x, w) in k.into_iter().zip(w) {
            (0..N).for_each(|k| q[k] += w * x.q[k]);
            (0..N).for_each(|k| momenta[k] += w * x.momenta[k]);
            if MOVES {
                state.position += w * x.position;
                state.momentum += w * x.momentum;
            }
            state.wheel += w * x.wheel;
            state.work += w * x.work;
            state.lost += w * x.lost;
            state.impulse = (state.impulse.0 + w * x.impulse.0, state.impulse.1 + w * x.impulse.1);
        }
        state
    }
}

#[inline(always)]
fn impulse(wrench: &BaseWrench, at: Vector) -> (Vector, f64) {
    let force = wrench.dynamic.force;
    (force, wrench.dynamic.moment + cross(at, force))
}

/// Returns i v, the vector turned counter-clockwise by 90°.
#[inline(always)]
fn turned(v: Vector) -> Vector {
    Vector::new(-v.im, v.re)
}

/// Returns the velocity terms of the momentum rates, ∂T/∂q, and those of the accelerations, V(q, q̇). `im` contains the
/// imaginary parts of the couplings.
#[inline(always)]
fn velocity_terms<const N: usize>(im: &[[f64; N]; N], rate: &[f64; N]) -> ([f64; N], [f64; N]) {
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
    (gain, v)
}

/// Motion of the base; zero if the base is fixed.
struct BaseMotion<const N: usize> {
    base: Pose2,
    /// Velocity of B, m/s.
    velocity: Vector,
    /// Rate of the base, rad/s.
    turning: f64,
    /// Velocity of the common centre of mass, m/s.
    drift: Vector,
    /// Terms of the position of B relative to the common centre of mass, m.
    base_chain: [Vector; N],
}

impl<const N: usize> Default for BaseMotion<N> {
    #[inline(always)]
    fn default() -> Self {
        let still = Vector::default();
        Self { base: Pose2::default(), velocity: still, turning: 0.0, drift: still, base_chain: [still; N] }
    }
}

impl<const N: usize> RungeKuttaStage<N> {
    /// Returns the stage as a slope, padded to the maximum size.
    #[inline(always)]
    pub fn slope(&self, drives: usize) -> Slope {
        let StateRates { q, momenta, position, momentum, wheel, work, lost, .. } = self.rates;
        Slope {
            e: with_ground(&self.e),
            qd: PerDrive::from(q),
            qdd: PerDrive::from(self.acceleration),
            torque: PerDrive::of_array(drives, self.torque),
            friction: PerDrive::of_array(drives, self.friction),
            spin: self.spin,
            base: self.base,
            base_velocity: self.base_velocity,
            base_acceleration: self.base_acceleration,
            wrench: self.wrench,
            kinetic: self.kinetic,
            power: work,
            loss: lost,
            momenta_rate: PerDrive::from(momenta),
            place_rate: position,
            momentum_rate: momentum,
            wheel_rate: wheel,
        }
    }
}

impl MovingBody {
    /// Returns the slope of a state without torques.
    pub fn slope_without_torque(&self, state: &State) -> Slope {
        by_drives!(self.rotating.drives, self.moves, still_of(self, state))
    }

    /// Computes rates, torques, accelerations and base wrench of a state; `MOVES` says whether the base moves.
    /// `control` returns the torques. Its arguments are the unit vectors and rates of all rotational coordinates, the
    /// pose of the base, and the velocity of B.
    #[inline]
    pub(crate) fn stage<const N: usize, const MOVES: bool>(
        &self,
        at: &ReducedState<N>,
        slip: &SlipDirections,
        stuck_torque: &mut [f64; MAX_CONTACTS],
        control: impl FnOnce(&[Vector; N], &[f64; N], Pose2, Vector) -> Actuation<N>,
    ) -> RungeKuttaStage<N> {
        let n = if MOVES { N - 1 } else { N };
        let mut e = [Vector::default(); N];
        e.iter_mut().zip(at.q).for_each(|(e, q)| *e = unit(q));
        let (h, im) = self.couplings(&e);
        let factors = Factors::of(&h);
        let mut momenta = at.momenta;
        if MOVES {
            momenta[N - 1] -= momenta[..N - 1].iter().sum::<f64>();
        }
        let rate = factors.solve(momenta);
        let (gain, v) = velocity_terms(&im, &rate);
        let BaseMotion { base, velocity, turning, drift, base_chain } = match MOVES {
            true => self.base_motion(at, &e, &rate),
            false => BaseMotion::default(),
        };
        let Actuation { torque, spin, rotor } = control(&e, &rate, base, velocity);

        // Generalised forces: outer forces, whose sum changes the angular momentum,
        // and torques between the drives and the base.
        let tip = |k: usize| if MOVES { self.end_effector_chain[k] * e[k] } else { e[k] * self.arm.end_effector[k] };
        let (mut support_force, mut moment) = Default::default();
        if MOVES {
            (support_force, moment) = self.support_reaction(base, velocity, turning);
            moment -= spin.torque;
        }
        let mut force = self.outer::<N, MOVES>(&e, (support_force, moment));
        let external: f64 = force.iter().sum();
        let tip_velocity: Vector = (0..N).map(|k| turned(tip(k)) * rate[k]).sum();
        let mut power = dot(self.around.force, tip_velocity + drift) + spin.torque * (spin.rate - turning);
        for k in 0..n {
            force[k] += torque[k];
            power += torque[k] * (rate[k] - turning);
        }
        if self.arm.motors.in_joints() {
            power += self.react::<N, MOVES>(&torque, &rate, &mut force);
        }
        let mut friction = [0.0; N];
        let (mut loss, mut momentum_rate) = (0.0, Vector::default());
        if MOVES {
            force[N - 1] -= torque[..N - 1].iter().sum::<f64>();
            let c = &self.support.damping;
            loss += c[0] * velocity.re.powi(2) + c[1] * velocity.im.powi(2) + c[2] * turning * turning;
            momentum_rate = self.mass * self.around.gravity + self.around.force + support_force;
        }
        if !self.contacts.is_empty() {
            loss += {
                let torques = FrictionTorques { force: &mut force, bearing: &mut friction, stuck_torque };
                self.add_friction(slip, &rate, &v, &factors, torques)
            };
        }
        let acceleration = factors.solve(std::array::from_fn(|k| force[k] - v[k]));
        let mut momenta_rate: [f64; N] = std::array::from_fn(|k| gain[k] + force[k]);
        // The wrench follows from the accelerations, not from the torques, so that a zero is a result, not an
        // assumption.
        let mut base_acceleration = Vector::default();
        let wrench = if MOVES {
            momenta_rate[N - 1] = external;
            let pull: Vector = (0..N).map(|k| base_chain[k] * Vector::new(-rate[k] * rate[k], acceleration[k])).sum();
            base_acceleration = momentum_rate / self.mass + pull;
            // The constants of the arm are zero at the index of the base.
            let (h, v) = assemble(&self.arm, &e, &rate);
            let mut wrench = self.wrench(&h, &v, &e, &rate, &acceleration);
            let lever: Vector = (0..N).map(|k| self.arm.g[k] * e[k]).sum();
            wrench.dynamic.force -= self.arm.mass * base_acceleration;
            wrench.dynamic.moment -= cross(lever, base_acceleration);
            wrench
        } else {
            self.wrench(&h, &v, &e, &rate, &acceleration)
        };
        let kinetic = 0.5 * (0..N).map(|k| momenta[k] * rate[k]).sum::<f64>()
            + 0.5 * dot(at.momentum, drift)
            + 0.5 * rotor * spin.rate * spin.rate;
        RungeKuttaStage {
            e,
            acceleration,
            torque,
            friction,
            spin,
            base,
            base_velocity: velocity,
            base_acceleration,
            wrench,
            kinetic,
            rates: StateRates {
                q: rate,
                momenta: momenta_rate,
                position: drift,
                momentum: momentum_rate,
                wheel: if rotor > 0.0 { spin.torque / rotor } else { 0.0 },
                work: power,
                lost: loss,
                impulse: impulse(&wrench, base.at),
            },
        }
    }

    /// Returns the mass matrix and the imaginary parts of the couplings, which give the velocity terms.
    #[inline(always)]
    fn couplings<const N: usize>(&self, e: &[Vector; N]) -> ([[f64; N]; N], [[f64; N]; N]) {
        let (mut h, mut im) = ([[0.0; N]; N], [[0.0; N]; N]);
        for k in 0..N {
            h[k][k] = self.rotating.c[k][k].re + self.rotating.spin[k];
            for l in k + 1..N {
                let z = self.rotating.c[k][l] * (e[k].conj() * e[l]);
                let coupled = z.re + self.rotating.rotor_coupling[k][l];
                h[k][l] = coupled;
                h[l][k] = coupled;
                im[k][l] = z.im;
            }
        }
        (h, im)
    }

    /// Returns the motion of a moving base.
    #[inline(always)]
    fn base_motion<const N: usize>(&self, at: &ReducedState<N>, e: &[Vector; N], rate: &[f64; N]) -> BaseMotion<N> {
        let drift = at.momentum / self.mass;
        let base_chain: [Vector; N] = std::array::from_fn(|k| self.base_chain[k] * e[k]);
        let lever: Vector = base_chain.iter().sum();
        let swing: Vector = (0..N).map(|k| turned(base_chain[k]) * rate[k]).sum();
        BaseMotion {
            base: Pose2 { at: at.position + lever, angle: at.q[N - 1] },
            velocity: drift + swing,
            turning: rate[N - 1],
            drift,
            base_chain,
        }
    }

    /// Returns the wrench of the arm on the base about B, without B's acceleration, from its mass matrix and v.
    #[inline(always)]
    fn wrench<const N: usize>(
        &self,
        h: &[[f64; N]; N],
        v: &[f64; N],
        e: &[Vector; N],
        rate: &[f64; N],
        acceleration: &[f64; N],
    ) -> BaseWrench {
        let inertial = matrix_times(h, acceleration);
        let change = angular_rate(&self.arm, &inertial, v, acceleration);
        wrench_with(&self.arm, e, rate, acceleration, &self.around, change)
    }

    /// Applies the reactions of motors in joints to the links that carry them instead of the base. Returns the change
    /// of motor power, W.
    #[inline(never)]
    fn react<const N: usize, const MOVES: bool>(
        &self,
        torque: &[f64; N],
        rate: &[f64; N],
        force: &mut [f64; N],
    ) -> f64 {
        let n = if MOVES { N - 1 } else { N };
        let mut power = 0.0;
        let turning = if MOVES { rate[N - 1] } else { 0.0 };
        for (k, torque) in torque.iter().enumerate().take(n) {
            if let Some(on) = self.arm.motors.on(k) {
                force[on] -= torque;
                power -= torque * (rate[on] - turning);
                if MOVES {
                    // The caller subtracts all torques from the base; this compensates for a motor that is not on it.
                    force[N - 1] += torque;
                }
            }
        }
        power
    }

    /// Adds the friction at rates `rate`, rad/s, to `torques`; `v` are the velocity terms, N m. Returns the dissipated
    /// power, W.
    #[inline(never)]
    fn add_friction<const N: usize>(
        &self,
        slip: &SlipDirections,
        rate: &[f64; N],
        v: &[f64; N],
        factors: &Factors<N>,
        torques: FrictionTorques<'_>,
    ) -> f64 {
        let loss = self.contacts.slide(slip, rate, torques.force, torques.bearing);
        let free = factors.solve(std::array::from_fn(|k| torques.force[k] - v[k]));
        let solve = |x: &[f64; MAX_DRIVES]| {
            let mut padded = [0.0; MAX_DRIVES];
            padded[..N].copy_from_slice(&factors.solve(*leading_entries::<N, _>(x)));
            padded
        };
        loss + self.contacts.solve_stuck(slip, rate, &free, solve, torques)
    }
}

#[inline(never)]
fn still_of<const N: usize, const MOVES: bool>(body: &MovingBody, state: &State) -> Slope {
    let mut stuck_torque = [0.0; MAX_CONTACTS];
    let none = |_: &_, _: &_, _, _| Actuation { torque: [0.0; N], spin: WheelState::default(), rotor: 0.0 };
    body.stage::<N, MOVES>(&ReducedState::of(state), &[0; MAX_CONTACTS], &mut stuck_torque, none).slope(body.arm.drives)
}
