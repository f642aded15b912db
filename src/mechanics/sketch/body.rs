//! [`Body`]: mass of a bar, and where it is.

use serde::{Deserialize, Serialize};

use super::drawing::{Bar, Sketch};
use crate::machine::Link;

/// Mass of a bar and where it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about its own centre of mass, kg m².
    pub inertia: f64,
    /// Position of its centre of mass from the root towards the tip, m.
    pub com: f64,
    /// Distance of its centre of mass to the left of the direction root to tip, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub com_normal: f64,
    /// Height of its centre of mass above the reference plane through B, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub axial: f64,
}

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

impl Body {
    /// Returns the body of a link.
    pub(super) fn of(link: &Link) -> Self {
        let Link { mass, inertia, com, com_normal, axial, .. } = *link;
        Self { mass, inertia, com, com_normal, axial }
    }
}

impl Sketch {
    /// Returns the body of a bar: its own, or that of a slender bar between its outermost pins, to four digits.
    pub fn body(&self, bar: &Bar) -> Body {
        if let Some(body) = bar.body {
            return body;
        }
        let places = || bar.all_pins().map(|pin| self.along(bar, pin));
        let (low, high) = (places().fold(0.0, f64::min), places().fold(0.0, f64::max));
        let length = high - low;
        let mass = bar.per_metre * length;
        let inertia = mass * length * length / 12.0;
        let [mass, inertia, com] = [mass, inertia, 0.5 * (low + high)].map(four_digits);
        Body { mass, inertia, com, com_normal: 0.0, axial: 0.0 }
    }
}

/// Rounds a number to four digits, as a person writes it.
fn four_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
