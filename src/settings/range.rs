//! [`Range`]: where the number of a key may lie. Each key has one, stated once beside it; checks and messages read it.

use std::borrow::Cow;
use std::fmt;

use crate::settings::number::{Short, counted};

/// The numbers from one to another, both included, and their unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    low: f64,
    high: f64,
    unit: &'static str,
}

impl Range {
    /// From `low` to `high`; the unit is only for words.
    pub const fn new(low: f64, high: f64, unit: &'static str) -> Self {
        Self { low, high, unit }
    }

    /// As far either way from zero.
    pub const fn either_way(most: f64, unit: &'static str) -> Self {
        Self::new(-most, most, unit)
    }

    /// Whether a number lies in it; one that is not finite never does.
    pub fn contains(&self, x: f64) -> bool {
        (self.low..=self.high).contains(&x)
    }

    /// Its unit.
    pub const fn unit(&self) -> &'static str {
        self.unit
    }

    /// The least number.
    pub const fn low(&self) -> f64 {
        self.low
    }

    /// The greatest number.
    pub const fn high(&self) -> f64 {
        self.high
    }

    /// The same with ends of nine digits: a quotient of typed numbers is read better so.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let nine = |x: f64| format!("{x:.8e}").parse().unwrap_or(x);
        Self { low: nine(self.low), high: nine(self.high), ..*self }
    }

    /// A number of this key, looked at.
    pub fn check(self, key: impl Into<Cow<'static, str>>, value: f64) -> Check {
        Check { key: key.into(), value, ok: self.contains(value), want: Want::Within(self) }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", Short(self.low), Short(self.high))?;
        if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

/// A number that stands somewhere, and whether it may.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// Its key, as `--set` names it.
    pub key: Cow<'static, str>,
    /// The number.
    pub value: f64,
    /// Whether it may stand there.
    pub ok: bool,
    /// What would be right.
    pub want: Want,
}

impl Check {
    /// A check that no range says.
    pub fn words(key: impl Into<Cow<'static, str>>, value: f64, ok: bool, want: &'static str) -> Self {
        Self { key: key.into(), value, ok, want: Want::Words(want) }
    }

    /// The same in words that depend on other numbers.
    pub fn said(key: impl Into<Cow<'static, str>>, value: f64, ok: bool, want: impl FnOnce() -> String) -> Self {
        let want = if ok { Want::Words("") } else { Want::Said(want()) };
        Self { key: key.into(), value, ok, want }
    }

    /// A list that holds so many of something, which is too many or too few.
    pub fn count(key: impl Into<Cow<'static, str>>, count: usize, of: &'static str, want: String) -> Self {
        Self { key: key.into(), value: count as f64, ok: false, want: Want::Count { of, want } }
    }
}

/// What would be right.
#[derive(Clone, Debug, PartialEq)]
pub enum Want {
    /// A number in a range.
    Within(Range),
    /// What no range can say, in words.
    Words(&'static str),
    /// The same with numbers that others decide.
    Said(String),
    /// Another number of things in a list.
    Count {
        /// What the list holds: `number`, `point`.
        of: &'static str,
        /// How many would be right.
        want: String,
    },
}

/// What is wrong with a number under a key, and what would be right.
pub fn refused(key: &str, value: f64, want: &Want) -> String {
    match want {
        Want::Count { of, want } => format!("{key} has {}: want {want}", counted(value, of)),
        _ => format!("{key} is {}: want {want}", Short(value)),
    }
}

impl fmt::Display for Want {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Within(range) => range.fmt(f),
            Self::Words(words) => f.write_str(words),
            Self::Said(want) | Self::Count { want, .. } => f.write_str(want),
        }
    }
}

/// The most characters of given text that a message repeats.
const MAX_CLIPPED: usize = 80;

/// Given text as a message repeats it: its beginning, on one line, without what a terminal would obey.
pub fn clipped(text: &str) -> String {
    shortened(text, MAX_CLIPPED)
}

/// The most digits in a row that a message repeats: more than any number needs.
const MAX_DIGITS: usize = 20;

/// The first characters of a text, on one line, and dots where there is more, or a number that runs on and on.
pub fn shortened(text: &str, most: usize) -> String {
    let mut short = String::new();
    let (mut count, mut digits) = (0, 0);
    for c in text.chars() {
        digits = if c.is_ascii_digit() { digits + 1 } else { 0 };
        match digits.cmp(&(MAX_DIGITS + 1)) {
            std::cmp::Ordering::Greater => continue,
            _ if count == most => {
                short.push('…');
                break;
            }
            std::cmp::Ordering::Equal => short.push('…'),
            std::cmp::Ordering::Less => short.push(if c.is_control() { ' ' } else { c }),
        }
        count += 1;
    }
    short
}
