//! [`Stated`]: equations with their numbers as plain data, without what draws symbols: what JSON has of them.

use serde::Serialize;

use super::equation::{Equation, Line, Origin, Term};
use super::state::{State, When};
use super::symbol::plain;
use crate::mechanics::machine::Machine;

/// Equations of a machine at an instant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stated {
    /// Name of the machine.
    pub machine: String,
    /// Instant of the run, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Instant of the planned motion, s, where the run rests.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planned_time: Option<f64>,
    /// Angles of the drives as seen from the base, rad.
    pub q: Vec<f64>,
    /// Their rates, rad/s.
    pub qd: Vec<f64>,
    /// Their accelerations, rad/s².
    pub qdd: Vec<f64>,
    /// The b that is to be held, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub b: Option<f64>,
    /// The equations that were asked for.
    pub equations: Vec<StatedEquation>,
}

/// An equation in words and numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatedEquation {
    /// As the paper counts: `7`, `A1`.
    pub number: &'static str,
    /// In plain words.
    pub title: &'static str,
    /// What it says, in one sentence.
    pub says: String,
    /// Its general form; empty where its lines are that.
    pub form: String,
    /// What else is to be known.
    pub notes: Vec<String>,
    /// Why it has no meaning for this machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<String>,
    /// Whether every line holds; none where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub holds: Option<bool>,
    /// What is equal.
    pub lines: Vec<StatedLine>,
}

/// One equality.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatedLine {
    /// What it is of: an axis, a drive, a pair of drives; empty where the equation has one line.
    pub name: String,
    /// Of its numbers.
    pub unit: &'static str,
    /// The left side.
    pub left: f64,
    /// The right side.
    pub right: f64,
    /// Whether both are equal but for rounding.
    pub holds: bool,
    /// Terms of the left side.
    pub left_terms: Vec<StatedTerm>,
    /// Terms of the right side; none is 0.
    pub right_terms: Vec<StatedTerm>,
}

/// A term of a sum.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatedTerm {
    /// With its sign.
    pub symbol: String,
    /// With its sign.
    pub value: f64,
    /// What makes it up, without what brings nothing.
    pub parts: Vec<StatedPart>,
}

/// What one body brings to a term.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatedPart {
    /// What the body is called.
    pub from: String,
    /// In the unit of the line.
    pub value: f64,
}

impl Stated {
    /// Equations of a machine in a state.
    pub fn of<'a>(machine: &Machine, state: &State, equations: impl IntoIterator<Item = &'a Equation>) -> Self {
        let (time, planned_time) = match state.when {
            When::Run(time) => (Some(time), None),
            When::Plan(time) => (None, Some(time)),
            When::Given => (None, None),
        };
        Self {
            machine: machine.name().into(),
            time,
            planned_time,
            q: state.q.to_vec(),
            qd: state.qd.to_vec(),
            qdd: state.qdd.to_vec(),
            b: state.b,
            equations: equations.into_iter().map(|equation| StatedEquation::of(machine, equation)).collect(),
        }
    }
}

impl StatedEquation {
    /// Of an equation of a machine.
    pub fn of(machine: &Machine, equation: &Equation) -> Self {
        Self {
            number: equation.number,
            title: equation.title,
            says: plain(equation.says),
            form: plain(equation.form),
            notes: equation.notes.iter().map(|note| plain(note)).collect(),
            why_not: equation.lines.as_ref().err().cloned(),
            holds: equation.holds(),
            lines: equation.lines.iter().flatten().map(|line| StatedLine::of(machine, line)).collect(),
        }
    }
}

impl StatedLine {
    fn of(machine: &Machine, line: &Line) -> Self {
        let [left, right] = line.sides();
        let terms = |terms: &[Term]| terms.iter().map(|term| StatedTerm::of(machine, term)).collect();
        Self {
            name: line.name.clone(),
            unit: line.unit,
            left,
            right,
            holds: line.holds(),
            left_terms: terms(&line.left),
            right_terms: terms(&line.right),
        }
    }
}

impl StatedTerm {
    fn of(machine: &Machine, term: &Term) -> Self {
        let sign = if term.is_negative { "−" } else { "" };
        let parts = term.parts.iter().filter(|(_, value)| *value != 0.0);
        let part = |(origin, value): &(Origin, f64)| StatedPart { from: origin.words(machine), value: *value };
        Self { symbol: format!("{sign}{}", plain(&term.symbol)), value: term.value, parts: parts.map(part).collect() }
    }
}
