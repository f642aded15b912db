//! Control: the commanded motor torques, computed from a model that may differ from the plant.
//!
//! | law | τ |
//! |---|---|
//! | computed torque | Ĥ (q̈_r + K_d ė + K_p e) + V̂ − γ̂ᵀ g |
//! | with payload compensation | computed torque, with the plant's payload in the model |
//! | PD | D̂_k (K_d ė_k + K_p e_k), D̂_k the inertia that the motor drives |
//!
//! All angles are relative to the base, q_k − θ, as encoders read them. Gains and torques refer to the motors; a motor
//! in a joint uses the angle relative to its stator, q_k − q_on. With equal gains on all drives and an exact model, Σ
//! D_k e_k decays independently of other errors. So errors that start on the plane stay on it and transmit no moment.
//! With unequal gains they leave the plane.

use crate::plant::{DriveValues, MovingBody};
use stillbase_mechanics::dynamics::{by_drives, leading_entries, torques};
use stillbase_mechanics::machine::Inertia;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Pose2, UnitVectors, Vector};
use stillbase_planning::Reference;
use stillbase_settings::keyed::keyed;
use stillbase_settings::number::{ShortNumber, nine_digits};
use stillbase_settings::range::{Range, RangeCheck};
use stillbase_settings::word::words;

keyed! {
    /// Settings of control.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Control at "control" {
        /// Computation of the torques: from the model, from the model with the payload while it is held, or PD from the
        /// errors alone.
        law: ControlLaw = "computed-torque";
        /// Position gain K_p, at most 1/step², 1e6 at 1 ms; if equal on all drives, it keeps errors on the plane.
        kp: DriveValues = "400", range: Range::new(0.0, 1e10, "s⁻²"), saved: always;
        /// Velocity gain K_d, at most 2/step, 2000 at 1 ms; if equal on all drives, it keeps errors on the plane.
        kd: DriveValues = "40", range: Range::new(0.0, 2e5, "s⁻¹"), saved: always;
        // A wheel in the base is not part of the model.
        /// Whether the model of control includes the base that moves; otherwise control takes the base to be fixed.
        knows_base: bool = "true", when: "base.kind = free or compliant: a fixed base does not move";
        /// Rate at which torques are computed, a whole number of steps apart; they stay constant in between, and 0
        /// means continuous control.
        rate: f64 = "0", range: Range::new(0.0, 1e5, "Hz");
        // Encoders are sampled at every step if no rate is given. Until the first torque arrives, the motors hold the
        // start pose.
        /// Delay from reading the encoders to the torque, a whole number of steps.
        delay: f64 = "0", range: DELAY_RANGE;
        // Control reads drive angles only in whole counts; the motion of the base is measured exactly.
        /// Encoder counts in a turn, 16 or more; rates are differences of counts, and 0 means exact angles.
        encoder: f64 = "0", range: Range::new(0.0, 1e12, "counts");
    }
}

const DELAY_RANGE: Range = Range::new(0.0, 1.0, "s");

words! {
    /// Control law.
    pub enum ControlLaw {
        ComputedTorque = "computed-torque", "Computed torque", "From the whole model";
        PayloadCompensation =
            "payload-compensation", "… with the payload", "From the whole model, with the payload in it while it is held";
        Pd = "pd", "PD", "From the errors alone";
    }
}

impl Control {
    /// Returns whether torques are held between samples.
    pub fn is_sampled(&self) -> bool {
        self.rate > 0.0 || self.delay > 0.0 || self.encoder > 0.0
    }

    /// Returns the number of steps between samples, of `step` s each.
    pub fn period(&self, step: f64) -> u64 {
        if self.rate > 0.0 { ((1.0 / (self.rate * step)).round() as u64).max(1) } else { 1 }
    }

    /// Returns the checks that depend on the step, s, and on the number `n` of drives.
    pub fn range_checks(&self, n: usize, step: f64) -> Vec<RangeCheck> {
        let mut list = Vec::new();
        let at_step = |range: Range| format!("{range} at a step of {} s", ShortNumber(step));
        for (key, gain, most) in [
            ("control.kp", self.kp, Range::new(0.0, 1.0 / (step * step), "s⁻²")),
            ("control.kd", self.kd, Range::new(0.0, 2.0 / step, "s⁻¹")),
        ] {
            let all = gain.values().into_iter();
            list.extend(all.map(|x| RangeCheck::depending(key, x, most.contains(x), || at_step(most.rounded()))));
            list.extend(gain.misfit(n, key));
        }
        let (delay, encoder) = (self.delay, self.encoder);
        let counts = encoder == 0.0 || encoder >= 16.0;
        list.extend([
            sampling_check("control.rate", self.rate, step),
            RangeCheck::depending("control.delay", delay, is_whole(delay / step), || delays(delay, step)),
            RangeCheck::words("control.encoder", encoder, counts, "0, or 16 to 1e12 counts in a turn"),
        ]);
        list
    }
}

/// Returns whether a number of steps is whole.
fn is_whole(steps: f64) -> bool {
    (steps - steps.round()).abs() < 1e-6 * steps.max(1.0)
}

/// Checks that samples at a rate, Hz, are a whole number of steps of `step` s apart; 0 means no samples.
pub fn sampling_check(key: &'static str, rate: f64, step: f64) -> RangeCheck {
    let steps = if rate > 0.0 { 1.0 / (rate * step) } else { 1.0 };
    let is_valid = (1.0 - 1e-9..1e9).contains(&steps) && is_whole(steps);
    RangeCheck::depending(key, rate, is_valid, || rates(steps, step))
}

/// Describes the permitted sampling rates, Hz, nearest to one sample every `steps` steps of `step` s.
fn rates(steps: f64, step: f64) -> String {
    let every = |steps: f64| nine_digits(1.0 / (steps * step));
    let near = match steps {
        steps if steps < 1.0 => format!("at most {} Hz, once in every step", every(1.0)),
        steps if steps < 1e9 => format!("{} or {} Hz, whole steps apart", every(steps.ceil()), every(steps.floor())),
        _ => format!("{} Hz or more", every(1e9)),
    };
    format!("0, or {near}, at a step of {} s", ShortNumber(step))
}

/// Describes the delays, s, of whole steps nearest to a given one.
fn delays(delay: f64, step: f64) -> String {
    let near = [(delay / step).floor(), (delay / step).ceil()].map(|steps| steps * step);
    let near = near.into_iter().filter(|x| DELAY_RANGE.contains(*x)).map(nine_digits).collect::<Vec<_>>();
    match near.is_empty() {
        true => DELAY_RANGE.to_string(),
        false => format!("{} s, whole steps of {} s", near.join(" or "), ShortNumber(step)),
    }
}

/// Measurements for a controller.
#[derive(Clone, Copy, Debug)]
pub struct Reading<'a> {
    /// Drive angles relative to the base, q_k − θ, rad.
    pub q: DriveAngles,
    /// Drive rates relative to the base, q̇_k − θ̇, rad/s.
    pub qd: PerDrive,
    /// Unit vectors e(q) of all rotational coordinates, in inertial axes.
    pub e: &'a UnitVectors,
    /// Absolute rates q̇ of all rotational coordinates, rad/s.
    pub rates: &'a PerDrive,
    /// Position p_B of B, m, and angle θ of the base, rad.
    pub base: Pose2,
    /// Velocity ṗ_B of B, m/s.
    pub velocity: Vector,
}

/// A control law with its gains and its model.
#[derive(Clone, Debug, PartialEq)]
pub struct Controller {
    law: ControlLaw,
    kp: PerDrive,
    kd: PerDrive,
    /// The model without and with the payload.
    models: Box<[MovingBody; 2]>,
}

/// State of the machine from which the torques are computed, with arrays of compile-time size.
pub(crate) struct ControlledState<'a, const N: usize> {
    /// Angles of the drives relative to the base, rad.
    pub q: &'a [f64; N],
    /// Rates of the drives relative to the base, rad/s.
    pub qd: &'a [f64; N],
    /// Absolute unit vectors of the rotational coordinates.
    pub e: &'a [Vector; N],
    /// Absolute rates of the rotational coordinates, rad/s.
    pub rate: &'a [f64; N],
    /// Pose of the base.
    pub base: Pose2,
    /// Velocity of B, m/s.
    pub velocity: Vector,
}

impl Controller {
    /// Builds a controller for a machine of `n` drives.
    pub fn new(control: &Control, n: usize, models: [MovingBody; 2]) -> Self {
        Self { law: control.law, kp: control.kp.of(n), kd: control.kd.of(n), models: Box::new(models) }
    }

    /// Copies the preload of a compliant base from another controller.
    pub(crate) fn preload_as(&mut self, other: &Self) {
        for model in self.models.iter_mut() {
            *model = model.clone().preloaded_as(&other.models[0]);
        }
    }

    /// Returns whether control computes the torque of a wheel that keeps the attitude of a free base from its model.
    #[inline]
    pub(crate) fn models_attitude(&self) -> bool {
        self.law != ControlLaw::Pd && self.models[0].is_free()
    }

    /// Returns the torques that hold the pose of a reading at rest according to the model, N m.
    pub fn holding(&self, reading: &Reading, loaded: bool) -> PerDrive {
        let still = PerDrive::zeros(reading.q.len());
        let rates = PerDrive::zeros(reading.rates.len());
        let at_rest = Reading { qd: still, rates: &rates, velocity: Vector::default(), ..*reading };
        self.torque(&Reference::at_rest(reading.q), &at_rest, loaded, |_, _| 0.0)
    }

    /// Returns the manipulator of the model, without the payload.
    #[inline]
    pub(crate) fn arm(&self) -> &Inertia {
        self.models[0].arm()
    }

    /// Returns the motor torques, N m; `loaded` says whether the plant holds its payload. If control knows the model of a
    /// free base, it asks `wheel` for the torque of a wheel in the base, N m. The arguments are the moment on the whole
    /// machine without the wheel, N m, and the machine's inertia, kg m².
    pub fn torque(
        &self,
        reference: &Reference,
        reading: &Reading,
        loaded: bool,
        wheel: impl FnOnce(f64, f64) -> f64,
    ) -> PerDrive {
        let size = reading.rates.len();
        by_drives!(size, size > reading.q.len(), torque_of(self, reference, reading, loaded, wheel))
    }

    /// Returns the motor torques, N m, for a compile-time size `N`; `MOVES` says whether the base moves. Entries
    /// beyond the drives are zero. If control [models the attitude](Self::models_attitude), it asks `wheel` for the
    /// torque of a wheel in the base, N m. The arguments are the moment on the whole machine without the wheel, N m, and
    /// the machine's inertia, kg m².
    #[inline(always)]
    pub(crate) fn torque_at<const N: usize, const MOVES: bool>(
        &self,
        reference: &Reference,
        state: &ControlledState<'_, N>,
        loaded: bool,
        wheel: impl FnOnce(f64, f64) -> f64,
    ) -> [f64; N] {
        let ControlledState { q, qd, e, rate, base, velocity } = *state;
        let n = if MOVES { N - 1 } else { N };
        let (aim, aim_rate) = (reference.q.0.array::<N>(), reference.qd.array::<N>());
        let (kp, kd) = (self.kp.array::<N>(), self.kd.array::<N>());
        let mut wanted = [0.0; N];
        for k in 0..n {
            wanted[k] = kd[k] * (aim_rate[k] - qd[k]) + kp[k] * (aim[k] - q[k]);
        }
        let model = &self.models[usize::from(loaded && self.law == ControlLaw::PayloadCompensation)];
        let motors = model.arm().motors();
        if motors.in_joints() {
            self.by_motors::<N>(n, aim, aim_rate, q, qd, &mut wanted);
        }
        if self.law == ControlLaw::Pd {
            return std::array::from_fn(|k| if k < n { model.arm().inertia_at_motor(k) * wanted[k] } else { 0.0 });
        }
        motors.transform_to_drives(&mut wanted);
        let acceleration = reference.qdd.array::<N>();
        (0..n).for_each(|k| wanted[k] += acceleration[k]);
        let mut torque = if !MOVES {
            torques(model.arm(), e, qd, &wanted, model.around())
        } else if model.moves() {
            let wheel = |moment, inertia| if self.models_attitude() { wheel(moment, inertia) } else { 0.0 };
            model.torque_for(&wanted, e, rate, base, velocity, wheel)
        } else {
            // The model assumes a fixed base, so vectors are expressed in the axes of the base.
            let turn = e[N - 1].conj();
            let mut torque = torques(model.arm(), &e.map(|e| e * turn), qd, &wanted, model.around());
            torque[N - 1] = 0.0;
            torque
        };
        motors.transform_to_motor_torques(&mut torque);
        torque
    }

    /// Computes the feedback from the errors of the motor angles.
    #[inline(never)]
    fn by_motors<const N: usize>(
        &self,
        n: usize,
        aim: &[f64; N],
        aim_rate: &[f64; N],
        q: &[f64; N],
        qd: &[f64; N],
        wanted: &mut [f64; N],
    ) {
        let motors = self.arm().motors();
        let mut error: [f64; N] = std::array::from_fn(|k| aim[k] - q[k]);
        let mut rate: [f64; N] = std::array::from_fn(|k| aim_rate[k] - qd[k]);
        motors.transform_to_motors(&mut error);
        motors.transform_to_motors(&mut rate);
        let (kp, kd) = (self.kp.array::<N>(), self.kd.array::<N>());
        (0..n).for_each(|k| wanted[k] = kd[k] * rate[k] + kp[k] * error[k]);
    }
}

#[inline(never)]
fn torque_of<const N: usize, const MOVES: bool>(
    control: &Controller,
    reference: &Reference,
    reading: &Reading,
    loaded: bool,
    wheel: impl FnOnce(f64, f64) -> f64,
) -> PerDrive {
    let state = ControlledState {
        q: reading.q.0.array(),
        qd: reading.qd.array(),
        e: leading_entries(reading.e),
        rate: reading.rates.array(),
        base: reading.base,
        velocity: reading.velocity,
    };
    PerDrive::of_array(reading.q.len(), control.torque_at::<N, MOVES>(reference, &state, loaded, wheel))
}
