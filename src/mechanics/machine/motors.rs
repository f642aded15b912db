//! [`Motors`]: placement of the stators, and the resulting relations between angles and torques of drives and motors.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | A | A_kk = 1, A_k,on(k) = −1, where drive on(k) carries motor k; motors have the angles A q | |
//! | m | torques of the motors, m = A⁻ᵀ τ; power is m · A q̇ = τ · q̇ | N m |
//! | τ | generalised torques of the absolute angles, as in (4) | N m |

use crate::planar::{MAX_DRIVES, PerDrive};

/// For each motor, the drive on whose links its stator sits. If all sit on the base, A is the identity and is skipped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motors {
    drives: usize,
    /// The drive that carries each stator; [`BASE`] for the base.
    on: [usize; MAX_DRIVES],
    /// Drives, each after the drive that carries its stator.
    order: [usize; MAX_DRIVES],
    in_joints: bool,
}

const BASE: usize = usize::MAX;

impl Motors {
    /// Makes it from the drive that carries each stator, `None` for the base. The drives must not carry each other in a
    /// cycle.
    pub(super) fn new(on: &[Option<usize>]) -> Self {
        let mut motors = Self {
            drives: on.len(),
            on: [BASE; MAX_DRIVES],
            order: std::array::from_fn(|k| k),
            in_joints: on.iter().any(Option::is_some),
        };
        motors.on.iter_mut().zip(on).for_each(|(to, on)| *to = on.unwrap_or(BASE));
        let depth = |k: usize| std::iter::successors(Some(k), |k| on[*k]).take(MAX_DRIVES).count();
        motors.order[..on.len()].sort_by_key(|k| depth(*k));
        motors
    }

    /// Returns the drive on whose links the stator of drive k sits; `None` for the base.
    #[inline]
    pub fn on(&self, k: usize) -> Option<usize> {
        (self.on[k] != BASE).then_some(self.on[k])
    }

    /// Returns whether some stator sits on a link rather than on the base.
    #[inline]
    pub fn in_joints(&self) -> bool {
        self.in_joints
    }

    /// Returns the drives whose stators sit on links, each with the drive that carries it, carriers first.
    #[inline(always)]
    fn carried_stators(&self) -> impl DoubleEndedIterator<Item = (usize, usize)> {
        let drives = if self.in_joints { self.drives } else { 0 };
        self.order[..drives].iter().filter_map(|&k| Some((k, self.on(k)?)))
    }

    /// Returns A x: angles, rates or accelerations of the motors from those of the drives.
    #[inline]
    #[must_use]
    pub fn to_motors(&self, x: &PerDrive) -> PerDrive {
        let mut turns = *x;
        self.transform_to_motors(&mut turns);
        turns
    }

    /// Replaces x by A x; elements beyond the drives stay unchanged.
    #[inline(always)]
    pub fn transform_to_motors(&self, x: &mut [f64]) {
        for (k, on) in self.carried_stators().rev() {
            x[k] -= x[on];
        }
    }

    /// Replaces x by A⁻¹ x: angles, rates or accelerations of the drives from those of the motors.
    #[inline(always)]
    pub fn transform_to_drives(&self, x: &mut [f64]) {
        for (k, on) in self.carried_stators() {
            x[k] += x[on];
        }
    }

    /// Returns A⁻ᵀ τ, N m: torques of the motors from generalised ones.
    #[inline]
    #[must_use]
    pub fn motor_torques(&self, generalised: &PerDrive) -> PerDrive {
        let mut torques = *generalised;
        self.transform_to_motor_torques(&mut torques);
        torques
    }

    /// Replaces τ by A⁻ᵀ τ.
    #[inline(always)]
    pub fn transform_to_motor_torques(&self, torque: &mut [f64]) {
        for (k, on) in self.carried_stators().rev() {
            torque[on] += torque[k];
        }
    }

    /// Returns Aᵀ m, N m: generalised torques from those of the motors. What stators exert on the base is left out.
    #[inline]
    #[must_use]
    pub fn generalised_torques(&self, torques: &PerDrive) -> PerDrive {
        let mut generalised = *torques;
        for (k, on) in self.carried_stators() {
            generalised[on] -= torques[k];
        }
        generalised
    }

    /// Returns whether drive l is drive k, or is carried by drive k directly or through other drives.
    pub fn carries(&self, k: usize, l: usize) -> bool {
        std::iter::successors(Some(l), |l| self.on(*l)).take(MAX_DRIVES).any(|l| l == k)
    }
}
