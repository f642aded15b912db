//! [`read`]: numbers as a person types them, with units and arithmetic: `30 deg`, `0.5/2`, `1 cm + 2 mm`, `2*pi/3`.
//!
//! A unit is a quantity like any other, and multiplies the number before it: `3 N m` is 3 · N · m, from left to right.
//! A number without a unit is in the requested unit.

use std::f64::consts::{PI, TAU};
use std::fmt;

use super::range::shortened;

/// Exponents of metre, kilogram, second and radian.
type Dimension = [i32; 4];

const DIMENSIONLESS: Dimension = [0; 4];

/// A number and its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Quantity {
    /// Value in metres, kilograms, seconds, radians.
    value: f64,
    dimension: Dimension,
    /// Whether a unit was typed, even one without a dimension.
    has_unit: bool,
}

impl Quantity {
    fn plain(value: f64) -> Self {
        Self { value, dimension: DIMENSIONLESS, has_unit: false }
    }

    fn times(self, other: Self, sign: i32) -> Self {
        let value = if sign > 0 { self.value * other.value } else { self.value / other.value };
        let dimension = [0, 1, 2, 3].map(|i| self.dimension[i] + sign * other.dimension[i]);
        Self { value, dimension, has_unit: self.has_unit || other.has_unit }
    }

    fn to_the(self, power: i32) -> Self {
        Self { value: self.value.powi(power), dimension: self.dimension.map(|of| of * power), ..self }
    }
}

/// Reason why a typed text is not a number in the requested unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum QuantityError {
    /// A character or word without a meaning here.
    Unknown(String),
    /// The text ends too early.
    Unfinished,
    /// Another dimension than requested: the text, and the requested unit.
    OtherKind(String, String),
    /// A sum of different dimensions, such as metres plus seconds.
    Mixed,
    /// No finite value, such as 1/0.
    NotFinite,
}

impl fmt::Display for QuantityError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(what) if what == "," => f.write_str("a comma is not understood: want a point, such as 0.5"),
            Self::Unknown(what) => {
                write!(f, "\"{}\" is not understood: want numbers, units, + − * / ( ) and pi", shortened(what, 24))
            }
            Self::Unfinished => f.write_str("something is missing at its end: want such as 0.5/2 or 30 deg"),
            Self::OtherKind(typed, unit) if unit.is_empty() => write!(f, "{typed} has a unit: want a plain number"),
            Self::OtherKind(typed, unit) => write!(f, "{typed} is of another kind: want a number in {unit}"),
            Self::Mixed => f.write_str("it adds different kinds, such as metres and degrees: want one kind"),
            Self::NotFinite => f.write_str("it has no value, as 1/0 has none: want a number"),
        }
    }
}

impl std::error::Error for QuantityError {}

/// Returns the number that a text states, in a unit; the unit is written as in keys and panels, such as `N m/rad` or
/// `°`.
///
/// # Errors
/// Says what was not understood, and what is accepted.
pub fn read(text: &str, unit: &str) -> Result<f64, QuantityError> {
    let typed = parse(text)?;
    if !typed.value.is_finite() {
        return Err(QuantityError::NotFinite);
    }
    if !typed.has_unit {
        return Ok(typed.value);
    }
    // If several units are listed, `m, rad`, any of them is accepted. For a unit that is only a word, such as counts,
    // only dimensionless values are accepted, such as 50 %.
    let mut wanted: Vec<Quantity> = unit.split(',').filter_map(|unit| parse(unit).ok()).collect();
    if wanted.is_empty() {
        wanted.push(Quantity::plain(1.0));
    }
    // Radians may be omitted where there is mass, as in torques: N m/rad is N m.
    let same = |one: Dimension, other: Dimension| one == other || (one[1] != 0 && one[..3] == other[..3]);
    let found = wanted.into_iter().find(|wanted| same(typed.dimension, wanted.dimension));
    match found.map(|wanted| typed.value / wanted.value) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(QuantityError::NotFinite),
        None => Err(QuantityError::OtherKind(shortened(text.trim(), 24), unit.to_owned())),
    }
}

fn parse(text: &str) -> Result<Quantity, QuantityError> {
    let mut reader = Reader { rest: text.trim(), depth: 0 };
    let value = reader.sum()?;
    match reader.rest.chars().next() {
        None => Ok(value),
        Some(c) => Err(QuantityError::Unknown(c.to_string())),
    }
}

struct Reader<'a> {
    rest: &'a str,
    /// Present depth of nested parentheses.
    depth: usize,
}

/// Maximum depth of nested parentheses.
const MAX_DEPTH: usize = 32;

impl Reader<'_> {
    fn peek(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    fn takes(&mut self, signs: &[char]) -> bool {
        let found = self.peek().filter(|c| signs.contains(c));
        if let Some(c) = found {
            self.rest = &self.rest[c.len_utf8()..];
        }
        found.is_some()
    }

    fn sum(&mut self) -> Result<Quantity, QuantityError> {
        let mut sum = self.product()?;
        loop {
            let sign = match () {
                () if self.takes(&['+']) => 1.0,
                () if self.takes(&['-', '−']) => -1.0,
                () => return Ok(sum),
            };
            let next = self.product()?;
            if next.dimension != sum.dimension || next.has_unit != sum.has_unit {
                return Err(QuantityError::Mixed);
            }
            sum.value += sign * next.value;
        }
    }

    fn product(&mut self) -> Result<Quantity, QuantityError> {
        let mut product = self.signed()?;
        loop {
            product = match () {
                () if self.takes(&['*', '·', '×']) => product.times(self.signed()?, 1),
                () if self.takes(&['/', '÷']) => product.times(self.signed()?, -1),
                // Juxtaposition multiplies: a unit, pi, or an expression in parentheses.
                () if self.peek().is_some_and(|c| c == '(' || is_of_word(c)) => product.times(self.power()?, 1),
                () => return Ok(product),
            };
        }
    }

    fn signed(&mut self) -> Result<Quantity, QuantityError> {
        let mut negative = false;
        loop {
            match () {
                () if self.takes(&['-', '−']) => negative = !negative,
                () if self.takes(&['+']) => {}
                () => break,
            }
        }
        let value = self.power()?;
        Ok(if negative { Quantity { value: -value.value, ..value } } else { value })
    }

    fn power(&mut self) -> Result<Quantity, QuantityError> {
        let base = self.one()?;
        let raised = self.superscript();
        if let Some(power) = raised {
            return Ok(base.to_the(power));
        }
        if !self.takes(&['^']) {
            return Ok(base);
        }
        let negative = self.takes(&['-', '−']);
        self.peek();
        let end = self.rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(self.rest.len());
        let (digits, rest) = self.rest.split_at(end);
        let power: i32 = digits.parse().ok().filter(|power| *power <= 99).ok_or(QuantityError::Unfinished)?;
        self.rest = rest;
        Ok(base.to_the(if negative { -power } else { power }))
    }

    fn superscript(&mut self) -> Option<i32> {
        let digit = |c: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|d| d == c);
        let negative = self.rest.starts_with('⁻');
        let rest = self.rest.strip_prefix('⁻').unwrap_or(self.rest);
        let c = rest.chars().next()?;
        let power = digit(c)? as i32;
        self.rest = &rest[c.len_utf8()..];
        Some(if negative { -power } else { power })
    }

    fn one(&mut self) -> Result<Quantity, QuantityError> {
        match self.peek() {
            None => Err(QuantityError::Unfinished),
            Some('(') => {
                self.takes(&['(']);
                self.depth += 1;
                if self.depth > MAX_DEPTH {
                    return Err(QuantityError::Unknown("(((".into()));
                }
                let inside = self.sum()?;
                self.depth -= 1;
                if self.takes(&[')']) { Ok(inside) } else { self.unexpected() }
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if is_of_word(c) => self.word(),
            Some(_) => self.unexpected(),
        }
    }

    fn unexpected<T>(&mut self) -> Result<T, QuantityError> {
        Err(self.peek().map_or(QuantityError::Unfinished, |c| QuantityError::Unknown(c.to_string())))
    }

    fn number(&mut self) -> Result<Quantity, QuantityError> {
        let bytes = self.rest.as_bytes();
        let digits = |mut i: usize| {
            while bytes.get(i).is_some_and(u8::is_ascii_digit) {
                i += 1;
            }
            i
        };
        let mut end = digits(0);
        if bytes.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        // A power of ten, only if digits follow: 3e is no number.
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let after = digits(end + 1 + sign);
            if after > end + 1 + sign {
                end = after;
            }
        }
        let (number, rest) = self.rest.split_at(end);
        let value = number.parse().map_err(|_| QuantityError::Unknown(number.into()))?;
        self.rest = rest;
        Ok(Quantity::plain(value))
    }

    fn word(&mut self) -> Result<Quantity, QuantityError> {
        let end = self.rest.find(|c| !is_of_word(c)).unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        meaning(word).ok_or_else(|| QuantityError::Unknown(word.into()))
    }
}

fn is_of_word(c: char) -> bool {
    (c.is_alphabetic() && !"⁰¹²³⁴⁵⁶⁷⁸⁹".contains(c)) || matches!(c, '°' | '%' | '′')
}

/// Returns the quantity that a word denotes.
fn meaning(word: &str) -> Option<Quantity> {
    let (m, kg, s, rad) = ([1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]);
    let (newton, joule, per_s) = ([1, 1, -2, 0], [2, 1, -2, 0], [0, 0, -1, 0]);
    let degree = PI / 180.0;
    let (value, dimension) = match word {
        "pi" | "π" | "Pi" | "PI" => return Some(Quantity::plain(PI)),
        "tau" | "τ" => return Some(Quantity::plain(TAU)),
        "m" => (1.0, m),
        "km" => (1e3, m),
        "dm" => (0.1, m),
        "cm" => (0.01, m),
        "mm" => (1e-3, m),
        "um" | "µm" | "μm" => (1e-6, m),
        "in" | "inch" => (0.0254, m),
        "kg" => (1.0, kg),
        "g" => (1e-3, kg),
        "t" => (1e3, kg),
        "lb" => (0.453_592_37, kg),
        "s" | "sec" => (1.0, s),
        "ms" => (1e-3, s),
        "us" | "µs" | "μs" => (1e-6, s),
        "min" => (60.0, s),
        "h" => (3600.0, s),
        "rad" => (1.0, rad),
        "mrad" => (1e-3, rad),
        "deg" | "degree" | "degrees" | "°" => (degree, rad),
        "rev" | "turn" | "turns" => (TAU, rad),
        "N" => (1.0, newton),
        "mN" => (1e-3, newton),
        "kN" => (1e3, newton),
        "Nm" => (1.0, joule),
        "J" => (1.0, joule),
        "W" => (1.0, [2, 1, -3, 0]),
        "Hz" => (1.0, per_s),
        "kHz" => (1e3, per_s),
        "rpm" => (TAU / 60.0, [0, 0, -1, 1]),
        "%" => (0.01, DIMENSIONLESS),
        _ => return None,
    };
    Some(Quantity { value, dimension, has_unit: true })
}
