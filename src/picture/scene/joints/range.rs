//! [`Range`]: which b joint space shows.

use crate::picture::scene::{Changes, axes};

/// How much of b is shown at least, rad, and how near to its ends the present one comes.
const SPAN: f64 = 3.0;
const MARGIN: f64 = 0.4;
/// Neighbouring surfaces lie at multiples of this, rad; so many of them are shown at most.
const APART: f64 = 0.5;
const MOST: i32 = 80;

/// The b that are shown: all of a run, or those about the present one, along with which they slide.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    /// Where they lie while the present b is well inside, rad.
    home: f64,
    /// Those of a whole run, rad.
    fixed: Option<[f64; 2]>,
}

impl Range {
    /// About the present b.
    pub fn sliding(home: f64) -> Self {
        Self { home, fixed: None }
    }

    /// All of a run, whose b lie in a range, rad.
    pub fn over([low, high]: [f64; 2], home: f64) -> Self {
        let width = SPAN.max(high - low + 2.0 * MARGIN);
        Self { home, fixed: Some(axes::covering([low, high], home, width, MARGIN)) }
    }

    /// Whether it stands still, whatever the present b is.
    pub fn is_fixed(&self) -> bool {
        self.fixed.is_some()
    }

    /// The least and the greatest b that are shown while a b is the present one, rad.
    pub fn about(&self, b: f64) -> [f64; 2] {
        self.fixed.unwrap_or_else(|| axes::sliding(b, self.home, SPAN, MARGIN))
    }

    /// The b of neighbouring surfaces, rad.
    pub fn neighbours(&self, b: f64) -> impl Iterator<Item = f64> {
        let [low, high] = self.about(b);
        let first = (low / APART).ceil();
        (0..MOST).map(move |i| (first + f64::from(i)) * APART).take_while(move |of| *of <= high)
    }

    /// What may change of what stands about the present surface.
    pub fn changes(&self) -> Changes {
        if self.is_fixed() { Changes::Nothing } else { Changes::Shape }
    }
}
