//! [`Motors`]: where the stators sit, and what follows of angles and torques.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | A | A_kk = 1, A_k,on(k) = −1: motor k turns by A q | |
//! | m | torques of the motors, m = A⁻ᵀ τ; power is m · A q̇ = τ · q̇ | N m |
//! | τ | generalised torques of the absolute angles, as in (4) | N m |

use crate::mechanics::planar::{MAX_DRIVES, PerDrive};

/// Which motor's stator sits on which drive's links. All on the base: A is the identity, and nothing is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motors {
    drives: usize,
    /// The drive that carries each stator; [`BASE`] for the base.
    on: [usize; MAX_DRIVES],
    /// Drives in an order in which none comes before the one that carries it.
    order: [usize; MAX_DRIVES],
    in_joints: bool,
}

const BASE: usize = usize::MAX;

impl Motors {
    /// From the drive that carries each stator, none for the base; they run in no circle.
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

    /// The drive on whose links the stator of drive k sits; none: on the base.
    #[inline]
    pub fn on(&self, k: usize) -> Option<usize> {
        (self.on[k] != BASE).then_some(self.on[k])
    }

    /// Whether some stator does not sit on the base.
    #[inline]
    pub fn in_joints(&self) -> bool {
        self.in_joints
    }

    /// Drives whose stators others carry, each with its carrier, carriers first.
    #[inline(always)]
    fn carried(&self) -> impl DoubleEndedIterator<Item = (usize, usize)> {
        let drives = if self.in_joints { self.drives } else { 0 };
        self.order[..drives].iter().filter_map(|&k| Some((k, self.on(k)?)))
    }

    /// A x: angles, rates or accelerations of the motors from those of the drives. What lies beyond the drives stays.
    #[inline]
    #[must_use]
    pub fn turns(&self, x: &PerDrive) -> PerDrive {
        let mut turns = *x;
        self.turn(&mut turns);
        turns
    }

    /// The same in place.
    #[inline(always)]
    pub(crate) fn turn(&self, x: &mut [f64]) {
        for (k, on) in self.carried().rev() {
            x[k] -= x[on];
        }
    }

    /// A⁻¹ x in place: of the drives from those of the motors.
    #[inline(always)]
    pub(crate) fn drive(&self, x: &mut [f64]) {
        for (k, on) in self.carried() {
            x[k] += x[on];
        }
    }

    /// A⁻ᵀ τ: torques of the motors from generalised ones.
    #[inline]
    #[must_use]
    pub fn torques(&self, generalised: &PerDrive) -> PerDrive {
        let mut torques = *generalised;
        self.give(&mut torques);
        torques
    }

    /// The same in place.
    #[inline(always)]
    pub(crate) fn give(&self, torque: &mut [f64]) {
        for (k, on) in self.carried().rev() {
            torque[on] += torque[k];
        }
    }

    /// Aᵀ m: generalised torques from those of the motors, with what comes back to the base left out.
    #[inline]
    #[must_use]
    pub fn generalised(&self, torques: &PerDrive) -> PerDrive {
        let mut generalised = *torques;
        for (k, on) in self.carried() {
            generalised[on] -= torques[k];
        }
        generalised
    }

    /// Whether drive l is k or carried by it.
    pub fn carries(&self, k: usize, l: usize) -> bool {
        std::iter::successors(Some(l), |l| self.on(*l)).take(MAX_DRIVES).any(|l| l == k)
    }
}
