//! Rules of vertical axes: which begin at zero, and how short they may be.

use crate::numbers::round_up;
use stillbase_simulation::signals::Signal;

/// How a vertical axis lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisKind {
    /// Symmetric about zero.
    Centred,
    /// From zero upwards, as long as no value is negative.
    FromZero,
    /// Around the values.
    Free,
}

/// Least length of an axis for signals of each SI unit. Shorter ranges are rounding noise in every machine that a
/// person can see, and must not look like a signal.
const FLOORS: [(&str, f64); 16] = [
    ("N m", 1e-3),
    ("N", 1e-2),
    ("m", 1e-5),
    ("rad", 1e-4),
    ("m/s", 1e-4),
    ("rad/s", 1e-4),
    ("rad/s²", 1e-3),
    ("kg m/s", 1e-4),
    ("kg m²/s", 1e-4),
    ("N s", 1e-4),
    ("N m s", 1e-4),
    ("J", 1e-4),
    ("m²", 1e-4),
    ("N m/N", 1e-3),
    ("s", 1e-4),
    ("1", 1e-2),
];

/// Factor on the least length for audits: checks of the computation are judged far below what a person can see.
const AUDIT_SHARE: f64 = 1e-5;

/// Returns the least length of an axis for a signal, in its own unit.
pub fn floor(signal: &Signal) -> f64 {
    let of_unit = FLOORS.iter().find(|(unit, _)| *unit == signal.unit).map_or(0.0, |(_, floor)| *floor);
    if signal.group().starts_with("audit") { AUDIT_SHARE * of_unit } else { of_unit }
}

impl AxisKind {
    /// Returns the axis of a plot that shows these signals and nothing else.
    pub fn of<'a>(mut signals: impl Iterator<Item = &'a Signal>) -> Self {
        if signals.all(Signal::is_magnitude) { Self::FromZero } else { Self::Free }
    }

    /// Returns the shortest axis that contains the values from `low` to `high` and is at least as long as
    /// [`bounds`](Self::bounds) wants, without rounding: for runs that are complete.
    pub fn span(self, [low, high]: [f64; 2], floor: f64) -> [f64; 2] {
        if self == Self::Centred {
            let most = low.abs().max(high.abs());
            let most = if most.is_finite() { most.max(floor) } else { floor };
            return [-most, most];
        }
        if !(low.is_finite() && high.is_finite()) {
            return [0.0, 1.0];
        }
        let low = self.bottom(low, floor);
        match self {
            Self::FromZero => [low, high.max(low + floor)],
            _ => {
                let missing = 0.5 * (floor - (high - low)).max(0.0);
                [low - missing, high + missing]
            }
        }
    }

    /// Returns the value at which an axis begins whose least value is `low`.
    fn bottom(self, low: f64, floor: f64) -> f64 {
        // What is negative by rounding only is zero.
        if self == Self::FromZero && low > -floor { 0.0 } else { low }
    }

    /// Returns bounds of an axis that contain the values from `low` to `high`, rounded outwards. Rounded bounds seldom
    /// change as values arrive. The length is at least `floor`, or twice `floor` if the axis is centred.
    pub fn bounds(self, [low, high]: [f64; 2], floor: f64) -> [f64; 2] {
        if self == Self::Centred {
            let most = round_up(low.abs().max(high.abs()).max(floor));
            let most = if most.is_finite() { most } else { floor };
            return [-most, most];
        }
        if !(low.is_finite() && high.is_finite()) {
            return [0.0, 1.0];
        }
        let low = self.bottom(low, floor);
        let step = round_up((high - low).max(floor) / 2.0);
        let bottom = (low / step).floor() * step;
        let count = ((high - bottom) / step).ceil().max((floor / step).ceil()).max(1.0);
        [bottom, bottom + count * step]
    }
}
