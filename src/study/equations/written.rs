//! [`Cell`]: a line of an equation as it is written, each number below its symbol.

use super::equation::{Line, Term};
use crate::settings::number::fixed;

/// A term, or the sign between the sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell<'a> {
    /// Before the symbol: `+`, `−`, `=` or nothing.
    pub sign: &'static str,
    /// As [`pieces`](super::pieces) reads it.
    pub symbol: &'a str,
    /// Before the number.
    pub number_sign: &'static str,
    /// Without its sign.
    pub number: String,
    /// What it is of.
    pub term: Option<&'a Term>,
}

/// A line with so many decimals: terms of the left side, `=`, terms of the right side. Where that is 0, what the left side
/// comes to stands below it.
pub fn cells(line: &Line, decimals: usize) -> Vec<Cell<'_>> {
    let left = line.left.iter().enumerate().map(|(i, term)| of_term(term, i == 0, decimals));
    let mut all: Vec<Cell<'_>> = left.collect();
    all.push(Cell { sign: "=", symbol: "", number_sign: "=", number: String::new(), term: None });
    all.extend(line.right.iter().enumerate().map(|(i, term)| of_term(term, i == 0, decimals)));
    if line.right.is_empty() {
        let [left, _] = line.sides();
        let (number_sign, number) = signed(left, true, decimals);
        all.push(Cell { sign: "", symbol: "0", number_sign, number, term: None });
    }
    all
}

fn of_term(term: &Term, is_first: bool, decimals: usize) -> Cell<'_> {
    let sign = sign(term.is_negative, is_first);
    let (number_sign, number) = signed(term.value, is_first, decimals);
    Cell { sign, symbol: &term.symbol, number_sign, number, term: Some(term) }
}

fn sign(is_negative: bool, is_first: bool) -> &'static str {
    match (is_negative, is_first) {
        (true, _) => "−",
        (false, true) => "",
        (false, false) => "+",
    }
}

/// A number with its sign apart; what rounds to zero has none of its own.
fn signed(value: f64, is_first: bool, decimals: usize) -> (&'static str, String) {
    let number = fixed(value.abs(), decimals);
    let is_zero = number.bytes().all(|b| matches!(b, b'0' | b'.'));
    (sign(value < 0.0 && !is_zero, is_first), number)
}
