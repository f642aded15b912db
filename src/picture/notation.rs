//! [`Notation`]: how the window and its reports write angles, lengths and terms. Other files, settings, recordings
//! and the command line stay in SI units.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::numbers::signed;
use super::scene::reaction::moment_symbol;

/// Unit in which the window shows angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AngleUnit {
    /// Radians.
    #[default]
    Radians,
    /// Degrees.
    Degrees,
}

/// Unit in which the window shows lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LengthUnit {
    /// Metres.
    #[default]
    Metres,
    /// Millimetres.
    Millimetres,
}

/// Which of the two names of a quantity comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NameOrder {
    /// The plain term, then the symbol.
    #[default]
    Terms,
    /// The paper's symbol, then the plain term.
    Symbols,
}

/// The user's choice of units and names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Notation {
    /// Unit of angles.
    pub angle: AngleUnit,
    /// Unit of lengths.
    pub length: LengthUnit,
    /// Order of a term and its symbol.
    pub names: NameOrder,
}

/// A unit in which a quantity is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownUnit {
    /// Name of the unit.
    pub name: &'static str,
    /// Factor from values in the original unit.
    pub factor: f64,
    /// Decimals to add to those of values in the original unit, for about the same resolution.
    pub decimals: i32,
}

/// How the values of a quantity are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NumberFormat<'a> {
    /// Factor from values in the original unit.
    pub factor: f64,
    /// Number of decimals.
    pub decimals: usize,
    /// Name of the unit on display.
    pub unit: &'a str,
}

impl AngleUnit {
    /// Returns the other unit.
    #[must_use]
    pub fn other(self) -> Self {
        if self == Self::Radians { Self::Degrees } else { Self::Radians }
    }
}

impl LengthUnit {
    /// Returns the other unit.
    #[must_use]
    pub fn other(self) -> Self {
        if self == Self::Metres { Self::Millimetres } else { Self::Metres }
    }
}

impl NameOrder {
    /// Returns the other order.
    #[must_use]
    pub fn other(self) -> Self {
        if self == Self::Terms { Self::Symbols } else { Self::Terms }
    }
}

impl ShownUnit {
    const fn of(name: &'static str, factor: f64, decimals: i32) -> Self {
        Self { name, factor, decimals }
    }

    /// Returns the number of decimals for values that have `decimals` in the original unit.
    pub fn decimals(&self, decimals: usize) -> usize {
        decimals.saturating_add_signed(self.decimals as isize)
    }
}

const DEGREES_PER_RADIAN: f64 = 180.0 / std::f64::consts::PI;

impl Notation {
    /// Returns this notation in the units of a drawing of a machine: millimetres and degrees.
    #[must_use]
    pub fn of_drawings(self) -> Self {
        Self { angle: AngleUnit::Degrees, length: LengthUnit::Millimetres, ..self }
    }

    /// Returns the unit in which values with the unit `unit` are shown; `None` if they are shown as they are.
    pub fn shown_unit(self, unit: &str) -> Option<ShownUnit> {
        let angle = match (self.angle, unit) {
            (AngleUnit::Degrees, "rad") => Some(ShownUnit::of("°", DEGREES_PER_RADIAN, -1)),
            (AngleUnit::Degrees, "mrad") => Some(ShownUnit::of("°", 1e-3 * DEGREES_PER_RADIAN, 2)),
            (AngleUnit::Degrees, "rad/s") => Some(ShownUnit::of("°/s", DEGREES_PER_RADIAN, -1)),
            (AngleUnit::Degrees, "rad/s²") => Some(ShownUnit::of("°/s²", DEGREES_PER_RADIAN, -1)),
            (AngleUnit::Radians, "°") => Some(ShownUnit::of("rad", 1.0 / DEGREES_PER_RADIAN, 2)),
            (AngleUnit::Radians, "°/s") => Some(ShownUnit::of("rad/s", 1.0 / DEGREES_PER_RADIAN, 2)),
            _ => None,
        };
        angle.or(match (self.length, unit) {
            (LengthUnit::Millimetres, "m") => Some(ShownUnit::of("mm", 1e3, -3)),
            (LengthUnit::Millimetres, "m²") => Some(ShownUnit::of("mm²", 1e6, -6)),
            (LengthUnit::Millimetres, "m/s") => Some(ShownUnit::of("mm/s", 1e3, -3)),
            _ => None,
        })
    }

    /// Returns the name of the unit in which values with the unit `unit` are shown.
    pub fn unit_name(self, unit: &str) -> &str {
        self.shown_unit(unit).map_or(unit, |shown| shown.name)
    }

    /// Returns how values with the unit `unit` are written; `decimals` belong to that unit.
    pub fn format(self, decimals: usize, unit: &str) -> NumberFormat<'_> {
        match self.shown_unit(unit) {
            Some(shown) => NumberFormat { factor: shown.factor, decimals: shown.decimals(decimals), unit: shown.name },
            None => NumberFormat { factor: 1.0, decimals, unit },
        }
    }

    /// Writes a value with its unit; `decimals` belong to `unit`.
    pub fn write(self, value: f64, decimals: usize, unit: &str) -> String {
        let NumberFormat { factor, decimals, unit } = self.format(decimals, unit);
        with_unit(&signed(factor * value, decimals), unit)
    }

    /// Returns both names of a quantity in the user's order: `turning moment on the base, n_B`.
    pub fn name(self, term: &str, symbol: &str) -> String {
        match (self.names, symbol) {
            (_, "") => term.to_owned(),
            (NameOrder::Terms, _) => format!("{term}, {symbol}"),
            (NameOrder::Symbols, _) => format!("{symbol}, {term}"),
        }
    }

    /// Returns both names of the moment that turns the base; `feels_more` says whether it may differ from n_B.
    pub fn base_moment(self, feels_more: bool) -> String {
        let term = if feels_more { "turning moment that the base feels" } else { "turning moment on the base" };
        self.name(term, moment_symbol(feels_more))
    }

    /// Returns a sentence with its angles and lengths in the user's units. A unit applies to the number before it, and
    /// to numbers joined to it that have as many decimals, at least one: `1.20 to 1.35 rad`, `0.550, 0.900 m`.
    pub fn sentence(self, text: &str) -> Cow<'_, str> {
        let mut written: Option<String> = None;
        let mut copied = 0;
        let mut at = 0;
        while let Some(first) = next_number(text, at) {
            let chain = Chain::read(text, first);
            at = chain.end;
            let Some(shown) = self.shown_unit(chain.unit) else { continue };
            let text_so_far = written.get_or_insert_default();
            for number in &chain.numbers {
                text_so_far.push_str(&text[copied..number.start]);
                text_so_far.push_str(&number.converted(text, &shown));
                copied = number.end;
            }
            let end = if shown.name.starts_with('°') { "" } else { " " };
            text_so_far.push_str(end);
            text_so_far.push_str(shown.name);
            copied = chain.end;
        }
        match written {
            Some(mut written) => {
                written.push_str(&text[copied..]);
                Cow::Owned(written)
            }
            None => Cow::Borrowed(text),
        }
    }
}

/// A number in a text, by the bytes that it occupies, with its sign.
#[derive(Clone, Copy, Debug)]
struct Number {
    start: usize,
    end: usize,
    decimals: usize,
}

impl Number {
    /// Reads a number that starts at a byte: sign, digits, decimals. Returns `None` if an exponent follows.
    fn read(text: &str, start: usize) -> Option<Self> {
        let rest = &text[start..];
        let unsigned = rest.trim_start_matches(['-', '−', '+']);
        let sign = rest.len() - unsigned.len();
        if !unsigned.starts_with(|c: char| c.is_ascii_digit()) || rest[..sign].chars().count() > 1 {
            return None;
        }
        let count = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let whole = count(unsigned);
        let part = unsigned[whole..].strip_prefix('.').map_or(0, count);
        let length = sign + whole + if part > 0 { 1 + part } else { 0 };
        let after = &text[start + length..];
        if after.starts_with(['e', 'E']) {
            return None;
        }
        Some(Self { start, end: start + length, decimals: part })
    }

    fn converted(&self, text: &str, shown: &ShownUnit) -> String {
        let written = text[self.start..self.end].replace('−', "-");
        let decimals = shown.decimals(self.decimals);
        // A round number such as 2° stays readable in the other unit.
        let decimals = if self.decimals == 0 && shown.factor < 1.0 { decimals.max(3) } else { decimals };
        written.parse().map_or_else(|_| written.clone(), |value: f64| signed(shown.factor * value, decimals))
    }
}

/// Returns the next number of a text from a byte on that does not belong to a word, such as the 2 of `q2`.
fn next_number(text: &str, from: usize) -> Option<Number> {
    let starts = text[from..].char_indices().map(|(i, c)| (from + i, c));
    let mut before = text[..from].chars().next_back();
    let mut in_word = false;
    for (i, c) in starts {
        let signed = matches!(c, '-' | '−' | '+');
        let follows_word = before.is_some_and(|b| b.is_alphanumeric() || matches!(b, '_' | '.'));
        // A sign within a word, such as that of an exponent, begins no number.
        in_word = follows_word || in_word && before.is_some_and(|b| matches!(b, '-' | '−' | '+'));
        let is_free = !in_word;
        if is_free
            && (c.is_ascii_digit() || signed)
            && let Some(number) = Number::read(text, i)
        {
            return Some(number);
        }
        before = Some(c);
    }
    None
}

/// Words and signs that join numbers of the same unit.
const JOINTS: [&str; 10] = [", ", " to ", " or ", " and ", " … ", "…", "–", " × ", " ± ", "  "];

/// Numbers that share the unit after the last of them.
struct Chain<'a> {
    numbers: Vec<Number>,
    /// Unit; empty if there is none.
    unit: &'a str,
    /// End of the unit, or of the last number.
    end: usize,
}

impl<'a> Chain<'a> {
    fn read(text: &'a str, first: Number) -> Self {
        let mut numbers = vec![first];
        let mut last = first;
        while let Some(next) = joined(text, &last) {
            numbers.push(next);
            last = next;
        }
        let after = &text[last.end..];
        let spaced = after.strip_prefix([' ', '\u{a0}']).unwrap_or(after);
        let ends = |c: char| !(c.is_alphanumeric() || matches!(c, '/' | '°' | '²' | '³' | '^' | '·' | '_'));
        let unit = &spaced[..spaced.find(ends).unwrap_or(spaced.len())];
        let end = if unit.is_empty() { last.end } else { last.end + (after.len() - spaced.len()) + unit.len() };
        Self { numbers, unit, end }
    }
}

/// Returns the number joined to `last`, if both have the same number of decimals, not 0.
fn joined(text: &str, last: &Number) -> Option<Number> {
    let after = &text[last.end..];
    let joint = JOINTS.into_iter().find(|joint| after.starts_with(joint))?;
    let next = Number::read(text, last.end + joint.len())?;
    (next.decimals == last.decimals && next.decimals > 0).then_some(next)
}

fn with_unit(number: &str, unit: &str) -> String {
    match unit {
        "" | "1" => number.to_owned(),
        _ if unit.starts_with('°') => format!("{number}{unit}"),
        _ => format!("{number} {unit}"),
    }
}
