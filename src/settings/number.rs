//! Formatting of numbers.

use std::fmt;

/// A number that is formatted with as many digits as it needs, and with a power of ten below 1e-5 and from 1e7 on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShortNumber(pub f64);

impl fmt::Display for ShortNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(x) = *self;
        match x.abs() {
            _ if x.is_nan() => f.write_str("not a number"),
            f64::INFINITY => f.write_str(if x > 0.0 { "infinite" } else { "-infinite" }),
            size if size == 0.0 || (1e-5..1e7).contains(&size) => write!(f, "{x}"),
            _ => write!(f, "{x:e}"),
        }
    }
}

/// Formats a number with fixed decimals, without a sign on zero; with powers of ten from 1e9 on.
pub fn fixed(x: f64, decimals: usize) -> String {
    if x.abs() >= 1e9 {
        return format!("{x:.3e}");
    }
    let text = format!("{x:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.into(),
        _ => text,
    }
}

/// Formats a number with fixed decimals, or with a power of ten if those would show only zeros. Below 1e-12 it is
/// treated as zero.
pub fn fixed_or_scientific(x: f64, decimals: usize) -> String {
    let text = fixed(x, decimals);
    match x.abs() >= 1e-12 && text.bytes().all(|b| matches!(b, b'0' | b'.')) {
        true => format!("{x:.1e}"),
        false => text,
    }
}

/// Formats a number with fixed decimals, or with four digits if those would show only one or none. Below 1e-16 it is
/// treated as zero.
pub fn fixed_or_finer(x: f64, decimals: usize) -> String {
    let shown = x.abs() * 10_f64.powi(decimals as i32);
    match x.abs() >= 1e-16 && shown < 10.0 {
        true => fixed(x, 3 + (-x.abs().log10()).ceil().max(0.0) as usize),
        false => fixed(x, decimals),
    }
}

/// Formats a number with four decimals, or with a power of ten below 1e-3 and from 1e6 on.
pub fn significant(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if !(1e-3..1e6).contains(&a) => format!("{x:.1e}"),
        _ => format!("{x:.4}"),
    }
}

/// Returns a count with its noun: `1 step`, `2 steps`.
pub fn counted(count: impl fmt::Display, one: &str) -> String {
    let count = count.to_string();
    let plural = if count == "1" { "" } else { "s" };
    format!("{count} {one}{plural}")
}

/// Formats a number with at most nine significant digits; below 1e-12 it is treated as zero.
pub fn nine_digits(x: f64) -> String {
    at_most_digits(x, 9)
}

/// Formats a number with at most so many significant digits; below 1e-12 it is treated as zero.
pub fn at_most_digits(x: f64, digits: usize) -> String {
    if x.abs() < 1e-12 {
        return "0".into();
    }
    let decimals = digits.saturating_sub(1);
    let rounded = format!("{x:.decimals$e}").parse().unwrap_or(x);
    ShortNumber(rounded).to_string()
}

/// Returns the shortest decimal for a length, m, as a person would write it: 0.2 for the 0.19999999999999996 that is left
/// of 0.7 less 0.5. The rounding of such a sum is that of its largest length, so that a part of 1e-16 of 1 m counts.
pub fn plain(metres: f64) -> f64 {
    shortest_within(metres, PLAIN_M * (1.0 + metres.abs()))
}

/// Returns the shortest decimal that differs from a number by no more than a part `within` of it.
pub fn shortest(x: f64, within: f64) -> f64 {
    shortest_within(x, within * x.abs())
}

fn shortest_within(x: f64, most: f64) -> f64 {
    if x.abs() <= most {
        return 0.0;
    }
    let decimals = (0..MOST_DECIMALS).map(|n| format!("{x:.n$e}").parse().unwrap_or(x));
    decimals.into_iter().find(|short: &f64| (short - x).abs() <= most).unwrap_or(x)
}

/// Rounding of a sum of lengths of about 1 m.
const PLAIN_M: f64 = 3e-16;
/// Decimals behind the first digit with which a number is no other one.
const MOST_DECIMALS: usize = 17;

/// Returns a symbol without subscript digits at its end: τ₁₂ as τ.
pub fn without_subscript(symbol: &str) -> &str {
    symbol.trim_end_matches(|c| ('₀'..='₉').contains(&c))
}

/// Returns a number in subscript digits: 12 as ₁₂.
pub fn subscript(number: usize) -> String {
    number.to_string().chars().filter_map(|c| char::from_u32(c as u32 - '0' as u32 + '₀' as u32)).collect()
}
