//! [`ShownRange`]: the interval of b that joint space shows.

use crate::scene::{ItemChanges, axes};

/// Minimum length of the interval, rad.
const MIN_LENGTH_RAD: f64 = 3.0;
/// Minimum distance of the present b from the bounds of the interval, rad.
const MARGIN_RAD: f64 = 0.4;
/// Spacing of neighbouring surfaces, rad; they are at multiples of this.
const SPACING_RAD: f64 = 0.5;
/// Maximum number of neighbouring surfaces.
const MAX_SURFACES: i32 = 80;

/// The interval of b that is shown: constant for a whole run, or following the present b.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShownRange {
    /// Centre of the interval while the present b is well inside, rad.
    home: f64,
    /// Constant interval of a whole run, rad.
    fixed: Option<[f64; 2]>,
}

impl ShownRange {
    /// Returns an interval that follows the present b.
    pub fn sliding(home: f64) -> Self {
        Self { home, fixed: None }
    }

    /// Returns the constant interval for a run whose b lie between `low` and `high`, rad.
    pub fn over([low, high]: [f64; 2], home: f64) -> Self {
        let width = MIN_LENGTH_RAD.max(high - low + 2.0 * MARGIN_RAD);
        Self { home, fixed: Some(axes::covering_range([low, high], home, width, MARGIN_RAD)) }
    }

    /// Whether the interval is constant.
    pub fn is_fixed(&self) -> bool {
        self.fixed.is_some()
    }

    /// Returns the interval that is shown, rad; `b` is the present pose constant.
    pub fn about(&self, b: f64) -> [f64; 2] {
        self.fixed.unwrap_or_else(|| axes::sliding_range(b, self.home, MIN_LENGTH_RAD, MARGIN_RAD))
    }

    /// Returns the pose constants of neighbouring surfaces, rad; `b` is the present pose constant.
    pub fn neighbours(&self, b: f64) -> impl Iterator<Item = f64> {
        let [low, high] = self.about(b);
        let first = (low / SPACING_RAD).ceil();
        (0..MAX_SURFACES).map(move |i| (first + f64::from(i)) * SPACING_RAD).take_while(move |of| *of <= high)
    }

    /// Returns the parts of the items around the present surface that may change.
    pub fn changes(&self) -> ItemChanges {
        if self.is_fixed() { ItemChanges::Nothing } else { ItemChanges::Shape }
    }
}
