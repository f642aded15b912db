//! [`Range`]: the interval in which a key's number has to lie. Each key states it once; checks and messages read it.

use std::borrow::Cow;
use std::fmt;

use crate::number::{ShortNumber, counted};

/// A closed interval and its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    low: f64,
    high: f64,
    unit: &'static str,
}

impl Range {
    /// Returns the interval from `low` to `high`; the unit only serves messages.
    pub const fn new(low: f64, high: f64, unit: &'static str) -> Self {
        Self { low, high, unit }
    }

    /// Returns the interval from −`most` to `most`.
    pub const fn either_way(most: f64, unit: &'static str) -> Self {
        Self::new(-most, most, unit)
    }

    /// Returns whether a number lies in the interval; one that is not finite never does.
    pub fn contains(&self, x: f64) -> bool {
        (self.low..=self.high).contains(&x)
    }

    /// Returns the unit.
    pub const fn unit(&self) -> &'static str {
        self.unit
    }

    /// Returns the lower bound.
    pub const fn low(&self) -> f64 {
        self.low
    }

    /// Returns the upper bound.
    pub const fn high(&self) -> f64 {
        self.high
    }

    /// Returns the interval with bounds rounded to nine digits. A bound that is a quotient of typed numbers is then
    /// easier to read.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let nine = |x: f64| format!("{x:.8e}").parse().unwrap_or(x);
        Self { low: nine(self.low), high: nine(self.high), ..*self }
    }

    /// Checks a number of a key against the interval.
    pub fn check(self, key: impl Into<Cow<'static, str>>, value: f64) -> RangeCheck {
        RangeCheck { key: key.into(), value, ok: self.contains(value), want: Requirement::Within(self) }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", ShortNumber(self.low), ShortNumber(self.high))?;
        if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

/// A number of a key, and whether it is accepted.
#[derive(Clone, Debug, PartialEq)]
pub struct RangeCheck {
    /// Key, as `--set` names it.
    pub key: Cow<'static, str>,
    /// The number.
    pub value: f64,
    /// Whether the number is accepted.
    pub ok: bool,
    /// Condition under which the number is accepted.
    pub want: Requirement,
}

impl RangeCheck {
    /// Returns a check whose condition is not an interval, with the condition in words.
    pub fn words(key: impl Into<Cow<'static, str>>, value: f64, ok: bool, want: &'static str) -> Self {
        Self { key: key.into(), value, ok, want: Requirement::Words(want) }
    }

    /// Returns a check whose condition depends on other numbers, with the condition in words.
    pub fn depending(key: impl Into<Cow<'static, str>>, value: f64, ok: bool, want: impl FnOnce() -> String) -> Self {
        let want = if ok { Requirement::Words("") } else { Requirement::Said(want()) };
        Self { key: key.into(), value, ok, want }
    }

    /// Returns a failed check of a list with too many or too few items.
    pub fn count(key: impl Into<Cow<'static, str>>, count: usize, of: &'static str, want: String) -> Self {
        Self { key: key.into(), value: count as f64, ok: false, want: Requirement::Count { of, want } }
    }
}

/// Condition under which a number is accepted.
#[derive(Clone, Debug, PartialEq)]
pub enum Requirement {
    /// A number in an interval.
    Within(Range),
    /// A condition that is not an interval, in words.
    Words(&'static str),
    /// A condition that depends on other numbers, in words.
    Said(String),
    /// A condition on the number of items in a list.
    Count {
        /// Noun for an item of the list: `number`, `point`.
        of: &'static str,
        /// Accepted number of items.
        want: String,
    },
}

/// Returns the message for a number that is not accepted: its key, its value, and the accepted values.
pub fn range_error(key: &str, value: f64, want: &Requirement) -> String {
    match want {
        Requirement::Count { of, want } => format!("{key} has {}: want {want}", counted(value, of)),
        _ => format!("{key} is {}: want {want}", ShortNumber(value)),
    }
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Within(range) => range.fmt(f),
            Self::Words(words) => f.write_str(words),
            Self::Said(want) | Self::Count { want, .. } => f.write_str(want),
        }
    }
}

/// Maximum length of a text from a file or a reader within a message, characters: it holds the names of all keys of a
/// part.
pub const MAX_SAID: usize = 400;

/// Maximum number of characters of given text that a message repeats.
const MAX_CLIPPED: usize = 80;

/// Returns given text as a message repeats it: its beginning, on one line, without control characters.
pub fn quote_clipped(text: &str) -> String {
    shortened(text, MAX_CLIPPED)
}

/// Maximum number of consecutive digits that a message repeats: more than any number needs.
const MAX_DIGITS: usize = 20;

/// Returns the first `most` characters of a text, on one line. An ellipsis marks omitted text and omitted digits of a
/// long number.
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
