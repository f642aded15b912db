//! State within a step, error measures and the number of substeps.

use crate::frame::{Peaks, Totals};
use crate::plant::{MAX_CONTACTS, SlipDirections, Slope, State};
use stillbase_planning::Reference;

/// State at an instant within a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepState {
    /// Time since the step began, s.
    pub at: f64,
    pub state: State,
    pub slope: Slope,
    /// Reference of the controller.
    pub aim: Reference,
    pub slip: SlipDirections,
    /// Torques of stuck contacts, N m.
    pub stuck_torque: [f64; MAX_CONTACTS],
}

/// A part of a step in which the reference is smooth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// Its start, s since the step began.
    pub(super) from: f64,
    /// Its end, s since the step began.
    pub to: f64,
    /// Interval of motion time in which the reference is evaluated, s; outside, it is extrapolated.
    pub(super) window: [f64; 2],
}

/// Difference between two numerical solutions, or a scale for it. Entries: net moment on the base (N m), dynamic f_B
/// (N), motor torques (N m), end effector (m).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Mismatch(pub(super) [f64; 4]);

impl Mismatch {
    /// Larger than any tolerance.
    pub const INFINITE: Self = Self([f64::INFINITY; 4]);

    /// Returns the larger of each pair of entries; NaN counts as larger.
    #[inline]
    pub fn worse(self, other: Self) -> Self {
        Self(std::array::from_fn(
            |i| if other.0[i] > self.0[i] || other.0[i].is_nan() { other.0[i] } else { self.0[i] },
        ))
    }

    /// Returns the maximum ratio of the entries to those of `measure`; infinite if an entry is NaN.
    pub fn share(self, measure: &Self) -> f64 {
        let share = |i: usize| if self.0[i].is_nan() { f64::INFINITY } else { self.0[i] / measure.0[i] };
        (0..4).map(share).fold(0.0, f64::max)
    }

    /// Returns the scales of errors: peaks, bounded from below, and for the end effector a fraction of the arm
    /// length.
    pub fn measure(peaks: &Peaks, reach: f64) -> Self {
        let (torque, pull) = (peaks.torque_sum.max(MIN_SCALE), peaks.inertial_pull.max(MIN_SCALE));
        let scale = |peak: f64, all: f64| peak.max(MIN_SCALE_SHARE * all);
        Self([scale(peaks.moment, torque), scale(peaks.force, pull), torque, TIP_SCALE_SHARE * reach.max(MIN_SCALE)])
    }
}

/// Lower bound of the scales of moment, force and base shift, as fractions of torques, inertial forces and reach.
/// It also bounds the scale of the base angle, rad.
pub(super) const MIN_SCALE_SHARE: f64 = 1e-4;

/// Scale of end effector errors, as a fraction of the arm length.
pub(super) const TIP_SCALE_SHARE: f64 = 1e-2;

/// Lower bound of torques, inertial forces and arm length in the scales: N m, N, m.
pub(super) const MIN_SCALE: f64 = 1e-6;

/// Accumulated position errors: of the end effector and of B, m, and of the base angle, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Stray {
    pub(super) tip: f64,
    pub(super) shift: f64,
    pub(super) angle: f64,
}

/// Errors of a run so far, and the number of substeps of a step.
#[derive(Clone, Debug)]
pub(super) struct StepControl {
    /// Number of substeps of a step.
    pub(super) substeps: u32,
    /// Maximum difference between two numerical solutions.
    pub(super) worst: Mismatch,
    /// Sum of the differences that step halving has found.
    pub(super) drift: Stray,
    /// Estimated peaks of the reference motion, used until the run has reached its own peaks.
    pub(super) expected: Peaks,
    /// Time until which the expected peaks are used, s.
    pub(super) until: f64,
    /// Times of the motion at which the reference or its derivatives jump, s.
    pub(super) kinks: Vec<f64>,
    /// Largest jump of the reference's q̈ that is ignored, rad/s².
    pub(super) level: f64,
}

impl StepControl {
    pub fn new(drives: usize) -> Self {
        let (worst, drift) = Default::default();
        Self { substeps: 1, worst, drift, expected: Peaks::zero(drives), until: 0.0, kinks: Vec::new(), level: 0.0 }
    }

    /// Takes over the number of substeps and the errors of another step control.
    pub fn resume(&mut self, other: &Self) {
        (self.substeps, self.worst, self.drift) = (other.substeps, other.worst, other.drift);
    }

    /// Returns the error of the displayed quantities relative to their scales.
    pub fn error(&self, measure: &Mismatch, totals: &Totals, reach: f64) -> f64 {
        let Stray { tip, shift, angle } = self.drift;
        let least = MIN_SCALE_SHARE * reach.max(MIN_SCALE);
        let drift = (tip / (TIP_SCALE_SHARE * reach.max(MIN_SCALE)))
            .max(shift / totals.shift.max(least))
            .max(angle / totals.base_angle.max(MIN_SCALE_SHARE));
        let worst = self.worst.share(measure);
        if drift > worst || drift.is_nan() { drift } else { worst }
    }
}

/// A substep by the classical fourth-order Runge–Kutta method.
pub(super) struct Substep {
    /// State at its end.
    pub end: StepState,
    /// Slopes of the second, third and fourth stage.
    pub stages: [Slope; 3],
    /// Difference between the last stage and the final state.
    pub off: Mismatch,
}
