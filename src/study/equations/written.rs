//! [`EquationCell`]: layout of an equation's line, with each value below its symbol.

use super::equation::{Equality, Term};
use stillbase_settings::number::fixed;

/// A term, the equals sign, or the 0 of an empty right side.
#[derive(Clone, Debug, PartialEq)]
pub struct EquationCell<'a> {
    /// Sign before the symbol: `+`, `−`, `=` or empty.
    pub sign: &'static str,
    /// Symbol in the notation of [`pieces`](super::pieces).
    pub symbol: &'a str,
    /// Sign before the value.
    pub number_sign: &'static str,
    /// Value without its sign.
    pub number: String,
    /// The term; `None` for the equals sign and for 0.
    pub term: Option<&'a Term>,
}

/// Lays out a line with a number of decimals: terms of the left side, `=`, terms of the right side. If the right side
/// is 0, the value of the left side is written below the 0.
pub fn cells(line: &Equality, decimals: usize) -> Vec<EquationCell<'_>> {
    let left = line.left.iter().enumerate().map(|(i, term)| of_term(term, i == 0, decimals));
    let mut all: Vec<EquationCell<'_>> = left.collect();
    all.push(EquationCell { sign: "=", symbol: "", number_sign: "=", number: String::new(), term: None });
    all.extend(line.right.iter().enumerate().map(|(i, term)| of_term(term, i == 0, decimals)));
    if line.right.is_empty() {
        let [left, _] = line.sides();
        let (number_sign, number) = signed(left, true, decimals);
        all.push(EquationCell { sign: "", symbol: "0", number_sign, number, term: None });
    }
    all
}

fn of_term(term: &Term, is_first: bool, decimals: usize) -> EquationCell<'_> {
    let sign = sign(term.is_negative, is_first);
    let (number_sign, number) = signed(term.value, is_first, decimals);
    EquationCell { sign, symbol: &term.symbol, number_sign, number, term: Some(term) }
}

fn sign(is_negative: bool, is_first: bool) -> &'static str {
    match (is_negative, is_first) {
        (true, _) => "−",
        (false, true) => "",
        (false, false) => "+",
    }
}

/// Returns the sign and the absolute value of a number; a value that rounds to zero has no minus sign.
fn signed(value: f64, is_first: bool, decimals: usize) -> (&'static str, String) {
    let number = fixed(value.abs(), decimals);
    let is_zero = number.bytes().all(|b| matches!(b, b'0' | b'.'));
    (sign(value < 0.0 && !is_zero, is_first), number)
}
