//! Numbers rounded to few decimals that remain feasible: a proposed value must work as printed.

use std::fmt;

use super::b_set::BSet;

/// Maximum number of decimals that are printed.
pub const MAX_DECIMALS: usize = 12;

/// A number equal to its printed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decimal {
    value: f64,
    decimals: usize,
}

impl Decimal {
    /// Returns the nearest number with this number of decimals.
    pub fn nearest(x: f64, decimals: usize) -> Self {
        let decimals = decimals.min(MAX_DECIMALS);
        // Adding 0 turns −0 into 0.
        Self { value: format!("{x:.decimals$}").parse().unwrap_or(x) + 0.0, decimals }
    }

    /// Returns this number plus `steps` units of its last decimal.
    #[must_use]
    pub fn stepped(self, steps: i32) -> Self {
        Self::nearest(self.value + f64::from(steps) * 10f64.powi(-(self.decimals as i32)), self.decimals)
    }

    /// Returns a number near x that passes a test, with the fewest decimals, but at least `least`: the nearest one or
    /// one of its neighbours. `None` if none with up to `MAX_DECIMALS` passes.
    pub fn shortest_passing(x: f64, least: usize, passes: impl Fn(f64) -> bool) -> Option<Self> {
        (least..=MAX_DECIMALS).find_map(|decimals| {
            let nearest = Self::nearest(x, decimals);
            let sense = if nearest.value > x { -1 } else { 1 };
            [nearest, nearest.stepped(sense), nearest.stepped(-sense)].into_iter().find(|x| passes(x.value))
        })
    }

    /// Returns the value of the printed form.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Returns the number of printed decimals.
    pub fn decimals(&self) -> usize {
        self.decimals
    }
}

impl fmt::Display for Decimal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let decimals = self.decimals;
        write!(f, "{:.decimals$}", self.value)
    }
}

impl BSet {
    /// Returns a number near b, with the fewest decimals, but at least `least`, that the set contains.
    pub fn decimal(&self, b: f64, least: usize) -> Option<Decimal> {
        let inside = |[low, high]: [f64; 2], b: f64| low <= b && b <= high;
        let sets = self.shifted_near(b).intervals;
        Decimal::shortest_passing(b, least, |x| sets.iter().any(|s| inside(*s, x)))
    }

    /// Describes the set: `b from 2.2158 to 2.6610 rad`, with the bounds rounded inwards, so that they are in the set.
    pub fn in_words(&self) -> String {
        let ranges: Vec<String> = self.intervals.iter().map(|[low, high]| describe_interval(*low, *high)).collect();
        format!("b {} rad", ranges.join(" or "))
    }
}

/// Describes an interval: `from 2.2160 to 2.6610`, with its bounds rounded inwards to as many decimals as keep it
/// non-empty.
pub fn describe_interval(low: f64, high: f64) -> String {
    let ends = (4..=MAX_DECIMALS).find_map(|decimals| {
        let [mut from, mut to] = [low, high].map(|x| Decimal::nearest(x, decimals));
        if from.value < low {
            from = from.stepped(1);
        }
        if to.value > high {
            to = to.stepped(-1);
        }
        (from.value <= to.value).then_some([from, to])
    });
    match ends {
        Some([from, to]) if from == to => format!("= {from}"),
        Some([from, to]) => format!("from {from} to {to}"),
        None => format!("= {}", Decimal::nearest(0.5 * (low + high), MAX_DECIMALS)),
    }
}

/// Formats a length, m, with this number of decimals, or in scientific notation if these would show fewer than two
/// digits, or if the length is 1e9 m or more.
pub fn metres(x: f64, decimals: usize) -> String {
    match x.abs() {
        small if small != 0.0 && small < 10f64.powi(1 - decimals as i32) => format!("{x:.3e}"),
        large if large >= 1e9 => format!("{x:.3e}"),
        _ => format!("{x:.decimals$}"),
    }
}

/// Formats two lengths, m, with as many decimals as distinguish them.
pub fn metres_apart(x: f64, y: f64) -> [String; 2] {
    let differ = |decimals: usize| {
        let both = [x, y].map(|x| metres(x, decimals));
        (both[0] != both[1]).then_some(both)
    };
    (4..=MAX_DECIMALS).find_map(differ).unwrap_or_else(|| [x, y].map(|x| format!("{x:e}")))
}
