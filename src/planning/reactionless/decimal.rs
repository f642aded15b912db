//! Numbers with few decimals that still do what the exact number does: what is proposed must work as printed.

use std::fmt;

use super::b_set::BSet;

/// Beyond so many decimals nobody types a number.
pub const MOST_DECIMALS: usize = 12;

/// The number that its printed form reads as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decimal {
    value: f64,
    decimals: usize,
}

impl Decimal {
    /// The nearest number with so many decimals.
    pub fn nearest(x: f64, decimals: usize) -> Self {
        let decimals = decimals.min(MOST_DECIMALS);
        // Adding 0 takes the sign from −0.
        Self { value: format!("{x:.decimals$}").parse().unwrap_or(x) + 0.0, decimals }
    }

    /// The next number with as many decimals, so many steps on.
    #[must_use]
    pub fn stepped(self, steps: i32) -> Self {
        Self::nearest(self.value + f64::from(steps) * 10f64.powi(-(self.decimals as i32)), self.decimals)
    }

    /// The number with the fewest decimals, `least` at least, near x that passes a test: the nearest one, or one
    /// beside it. `None` if none with up to `MOST_DECIMALS` does.
    pub fn that(x: f64, least: usize, passes: impl Fn(f64) -> bool) -> Option<Self> {
        (least..=MOST_DECIMALS).find_map(|decimals| {
            let nearest = Self::nearest(x, decimals);
            let sense = if nearest.value > x { -1 } else { 1 };
            [nearest, nearest.stepped(sense), nearest.stepped(-sense)].into_iter().find(|x| passes(x.value))
        })
    }

    /// What a reader of its printed form gets.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// How many decimals are printed.
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
    /// A b of the set, or an end of it, with the fewest decimals, `least` at least, that keep it in the set.
    pub fn decimal(&self, b: f64, least: usize) -> Option<Decimal> {
        let inside = |[low, high]: [f64; 2], b: f64| low <= b && b <= high;
        let sets = self.near(b).intervals;
        Decimal::that(b, least, |x| sets.iter().any(|s| inside(*s, x)))
    }

    /// `b from 2.2158 to 2.6610 rad`: ends rounded inwards, so that they themselves will do.
    pub fn in_words(&self) -> String {
        let ranges: Vec<String> = self.intervals.iter().map(|[low, high]| between(*low, *high)).collect();
        format!("b {} rad", ranges.join(" or "))
    }
}

/// `from 2.216 to 2.661`: the ends of a range rounded inwards, with as many decimals as leave something of it.
pub fn between(low: f64, high: f64) -> String {
    let ends = (4..=MOST_DECIMALS).find_map(|decimals| {
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
        None => format!("= {}", Decimal::nearest(0.5 * (low + high), MOST_DECIMALS)),
    }
}

/// A length, m, as it is said: with the decimals that are asked for, in powers of ten where these show
/// less than two digits of it.
pub fn metres(x: f64, decimals: usize) -> String {
    match x.abs() {
        small if small != 0.0 && small < 10f64.powi(1 - decimals as i32) => format!("{x:.3e}"),
        large if large >= 1e9 => format!("{x:.3e}"),
        _ => format!("{x:.decimals$}"),
    }
}

/// Two lengths that differ, m, with as many decimals as show it.
pub fn metres_apart(x: f64, y: f64) -> [String; 2] {
    let differ = |decimals: usize| {
        let both = [x, y].map(|x| metres(x, decimals));
        (both[0] != both[1]).then_some(both)
    };
    (4..=MOST_DECIMALS).find_map(differ).unwrap_or_else(|| [x, y].map(|x| format!("{x:e}")))
}
