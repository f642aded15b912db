//! [`StatedEquations`]: equations with their values as plain data for JSON, with symbols as plain text.

use schemars::JsonSchema;
use serde::Serialize;

use super::equation::{Equality, Equation, Origin, Term};
use super::state::{DriveState, InstantKind};
use super::symbol::plain;
use stillbase_mechanics::machine::Machine;

/// Equations of a machine at an instant.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct StatedEquations {
    /// Name of the machine.
    pub machine: String,
    /// Instant of the run, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<f64>,
    /// Instant of the planned motion, s, if the run is at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planned_time: Option<f64>,
    /// Drive angles relative to the base, rad.
    pub q: Vec<f64>,
    /// Drive rates, rad/s.
    pub qd: Vec<f64>,
    /// Drive accelerations, rad/s².
    pub qdd: Vec<f64>,
    /// The required b, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub b: Option<f64>,
    /// The requested equations.
    pub equations: Vec<StatedEquation>,
}

/// An equation in words and numbers.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct StatedEquation {
    /// Number in the paper: `7`, `A1`.
    pub number: &'static str,
    /// Title in plain words.
    pub title: &'static str,
    /// Meaning, in one sentence.
    pub says: String,
    /// General form; empty if the lines are the general form.
    pub form: String,
    /// Notes: deviations from the printed equation, omissions.
    pub notes: Vec<String>,
    /// Reason that the equation does not apply to this machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<String>,
    /// Whether every line holds; `None` if there are no lines.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub holds: Option<bool>,
    /// Lines of the equation.
    pub lines: Vec<StatedLine>,
}

/// One equality.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct StatedLine {
    /// Axis, drive or pair of drives; empty if the equation has one line.
    pub name: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// Value of the left side.
    pub left: f64,
    /// Value of the right side.
    pub right: f64,
    /// Whether both sides agree within the tolerance.
    pub holds: bool,
    /// Terms of the left side.
    pub left_terms: Vec<StatedTerm>,
    /// Terms of the right side; empty for 0.
    pub right_terms: Vec<StatedTerm>,
}

/// A term of a sum.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct StatedTerm {
    /// Symbol, with its sign.
    pub symbol: String,
    /// Value, with its sign.
    pub value: f64,
    /// Non-zero contributions of bodies.
    pub parts: Vec<StatedPart>,
}

/// Contribution of one body to a term.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct StatedPart {
    /// Name of the body.
    pub from: String,
    /// Value, in the unit of the line.
    pub value: f64,
}

impl StatedEquations {
    /// Converts equations of a machine in a state.
    pub fn of<'a>(machine: &Machine, state: &DriveState, equations: impl IntoIterator<Item = &'a Equation>) -> Self {
        let (time, planned_time) = match state.when {
            InstantKind::Run(time) => (Some(time), None),
            InstantKind::Plan(time) => (None, Some(time)),
            InstantKind::Given => (None, None),
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
    /// Converts an equation of a machine.
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
    fn of(machine: &Machine, line: &Equality) -> Self {
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
