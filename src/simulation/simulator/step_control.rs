//! What a step is made of, and how finely it is taken.

use crate::planning::Reference;
use crate::simulation::frame::{Peaks, Totals};
use crate::simulation::plant::{MAX_CONTACTS, SlipDirections, Slope, State};

/// Where a step has come to.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepState {
    /// Since the step began, s.
    pub at: f64,
    pub state: State,
    pub slope: Slope,
    /// What control aims at.
    pub aim: Reference,
    pub slip: SlipDirections,
    /// Torques of stuck contacts, N m.
    pub stuck_torque: [f64; MAX_CONTACTS],
}

/// The part of a step in which the reference is smooth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) from: f64,
    pub to: f64,
    /// Times of the motion that belong to it, s.
    pub(super) window: [f64; 2],
}

/// How far two answers are apart, or how far they may be: the moment that the base feels, N m, dynamic f_B, N, motor
/// torques, N m, the end effector, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Mismatch(pub(super) [f64; 4]);

impl Mismatch {
    /// Larger than any tolerance.
    pub const BEYOND: Self = Self([f64::INFINITY; 4]);

    #[inline]
    pub fn worse(self, other: Self) -> Self {
        Self(std::array::from_fn(
            |i| if other.0[i] > self.0[i] || other.0[i].is_nan() { other.0[i] } else { self.0[i] },
        ))
    }

    /// The largest share of a measure; what is no number is more than any.
    pub fn share(self, measure: &Self) -> f64 {
        let share = |i: usize| if self.0[i].is_nan() { f64::INFINITY } else { self.0[i] / measure.0[i] };
        (0..4).map(share).fold(0.0, f64::max)
    }

    /// What errors are shares of: peaks, or what must be small beside the torques, the pull and the arm to count as
    /// none.
    pub fn measure(peaks: &Peaks, reach: f64) -> Self {
        let (torque, pull) = (peaks.torque_sum.max(LEAST), peaks.inertial_pull.max(LEAST));
        let scale = |peak: f64, all: f64| peak.max(LEAST_SHARE * all);
        Self([scale(peaks.moment, torque), scale(peaks.force, pull), torque, TIP * reach.max(LEAST)])
    }
}

/// Moments and forces below this share of torques and pull are judged as if they were as large.
pub(super) const LEAST_SHARE: f64 = 1e-4;

/// Errors of the end effector are shares of this part of the arm.
pub(super) const TIP: f64 = 1e-2;

/// Values below this count as zero: N m, N, m.
pub(super) const LEAST: f64 = 1e-6;

/// How far things may have strayed from where they should be: the end effector and B, m, and the base, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Stray {
    pub(super) tip: f64,
    pub(super) shift: f64,
    pub(super) angle: f64,
}

/// What errors have come to so far, and how many substeps steps are taken in.
#[derive(Clone, Debug)]
pub(super) struct StepControl {
    pub(super) substeps: u32,
    /// The most by which two answers have differed.
    pub(super) worst: Mismatch,
    /// What halving has found, added up.
    pub(super) drift: Stray,
    /// What the reference asks for, before the run has shown its own peaks.
    pub(super) expected: Peaks,
    /// Until when that counts, s.
    pub(super) until: f64,
    /// When the reference jumps or bends, in times of the motion, s.
    pub(super) kinks: Vec<f64>,
    /// Where q̈ of the reference changes by less, it only bends, rad/s².
    pub(super) level: f64,
}

impl StepControl {
    pub fn new(drives: usize) -> Self {
        let (worst, drift) = Default::default();
        Self { substeps: 1, worst, drift, expected: Peaks::zero(drives), until: 0.0, kinks: Vec::new(), level: 0.0 }
    }

    /// Goes on where another was: errors made before stay.
    pub fn resume(&mut self, other: &Self) {
        (self.substeps, self.worst, self.drift) = (other.substeps, other.worst, other.drift);
    }

    /// The error of what is shown, as a share of a measure.
    pub fn error(&self, measure: &Mismatch, totals: &Totals, reach: f64) -> f64 {
        let Stray { tip, shift, angle } = self.drift;
        let least = LEAST_SHARE * reach.max(LEAST);
        let drift = (tip / (TIP * reach.max(LEAST)))
            .max(shift / totals.shift.max(least))
            .max(angle / totals.base_angle.max(LEAST_SHARE));
        let worst = self.worst.share(measure);
        if drift > worst || drift.is_nan() { drift } else { worst }
    }
}

/// A substep by classical fourth-order Runge–Kutta.
pub(super) struct Substep {
    pub end: StepState,
    /// The slopes between and of the last stage, where contacts can stick.
    pub stages: [Slope; 3],
    /// How far apart the last stage and the end are.
    pub off: Mismatch,
}
