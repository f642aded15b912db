//! Numbers of a report in the user's units, as text.

use crate::notation::{Notation, NumberFormat};
use stillbase_settings::number::{fixed, nine_digits};

impl Notation {
    /// Returns a number in the user's unit, and the name of that unit. `decimals` is their number in `unit`.
    pub(super) fn fixed(self, value: f64, decimals: usize, unit: &str) -> (String, &str) {
        let NumberFormat { factor, decimals, unit } = self.format(decimals, unit);
        (fixed(factor * value, decimals), unit)
    }

    /// Returns a number with at most nine digits.
    pub(super) fn nine_digits(self, value: f64, unit: &str) -> String {
        nine_digits(self.shown_unit(unit).map_or(value, |shown| shown.factor * value))
    }

    /// Returns the head of a column with its unit.
    pub(super) fn head(self, name: &str, unit: &str) -> String {
        headed(name, self.unit_name(unit))
    }
}

/// Returns the head of a column with its unit as displayed.
pub(super) fn headed(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") }
}
