//! [`Equation`]: what an equation says, and today's numbers in it.

use crate::mechanics::balance::Body;
use crate::mechanics::machine::Machine;

/// What a part of a term comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A body, and the link that it is or rides on, counted from 0.
    Body(Body, usize),
    /// The rotor of the motor of a drive, counted from 0.
    Rotor(usize),
}

impl Origin {
    /// The link that it is or rides on.
    pub fn link(self) -> Option<usize> {
        match self {
            Self::Body(_, link) => Some(link),
            Self::Rotor(_) => None,
        }
    }

    /// What it is called.
    pub fn words(self, machine: &Machine) -> String {
        let spec = machine.spec();
        match self {
            Self::Body(Body::Link(j), _) => format!("link {}", spec.links[j].name),
            Self::Body(Body::Counterweight(_), link) => format!("counterweight of link {}", spec.links[link].name),
            Self::Body(Body::Payload, _) => "payload".into(),
            Self::Rotor(k) => format!("rotor of drive {}", spec.drives[k].name),
        }
    }
}

/// A term of a sum.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// As [`pieces`](super::pieces) reads it, without its sign.
    pub symbol: String,
    /// Whether the symbol is taken away.
    pub is_negative: bool,
    /// With its sign.
    pub value: f64,
    /// What makes it up; the sum is the value. Empty where no body is in it, such as an angle.
    pub parts: Vec<(Origin, f64)>,
}

impl Term {
    /// A term that no body is in.
    pub(super) fn plain(symbol: impl Into<String>, value: f64) -> Self {
        Self { symbol: symbol.into(), is_negative: false, value, parts: Vec::new() }
    }

    /// A term that is the sum of its parts.
    pub(super) fn sum(symbol: impl Into<String>, parts: Vec<(Origin, f64)>) -> Self {
        let value = parts.iter().map(|(_, part)| part).sum();
        Self { symbol: symbol.into(), is_negative: false, value, parts }
    }

    /// The same with what is in it.
    pub(super) fn from(self, parts: Vec<(Origin, f64)>) -> Self {
        Self { parts, ..self }
    }

    /// The same with its symbol taken away; its value has its sign already.
    pub(super) fn negative(self) -> Self {
        Self { is_negative: true, ..self }
    }

    /// The links that it comes from, each once, in rising order.
    pub fn links(&self) -> Vec<usize> {
        let mut links: Vec<usize> = self.parts.iter().filter_map(|(origin, _)| origin.link()).collect();
        links.sort_unstable();
        links.dedup();
        links
    }
}

/// One equality: both sides are found on ways of their own, so that they agree is something found.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it is of: an axis, a drive, a pair of drives; empty where the equation has one line.
    pub name: String,
    /// Of its numbers.
    pub unit: &'static str,
    /// Terms of the left side.
    pub left: Vec<Term>,
    /// Terms of the right side; none is 0.
    pub right: Vec<Term>,
    /// The sides count as equal up to this.
    pub tolerance: f64,
}

/// The part of all terms together that rounding may take.
const ROUNDING: f64 = 1e-12;

impl Line {
    /// One whose sides agree but for rounding; `scale` is as large as what was added up to its terms.
    pub(super) fn new(
        name: impl Into<String>,
        unit: &'static str,
        left: Vec<Term>,
        right: Vec<Term>,
        scale: f64,
    ) -> Self {
        let terms: f64 = left.iter().chain(&right).map(|term| term.value.abs()).sum();
        Self { name: name.into(), unit, left, right, tolerance: ROUNDING * terms.max(scale) }
    }

    /// Both sides.
    pub fn sides(&self) -> [f64; 2] {
        [&self.left, &self.right].map(|side| side.iter().map(|term| term.value).sum())
    }

    /// Left side less right side.
    pub fn off(&self) -> f64 {
        let [left, right] = self.sides();
        left - right
    }

    /// Whether it holds.
    pub fn holds(&self) -> bool {
        self.off().abs() <= self.tolerance
    }
}

/// An equation of the paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// As the paper counts: `7`, `A1`.
    pub number: &'static str,
    /// In plain words.
    pub title: &'static str,
    /// What it says, in one sentence.
    pub says: &'static str,
    /// Its general form, as [`pieces`](super::pieces) reads it; empty where its lines are that.
    pub form: &'static str,
    /// What else is to be known: where the paper prints it differently, what is left out.
    pub notes: Vec<String>,
    /// What is equal; or why it has no meaning for this machine.
    pub lines: Result<Vec<Line>, String>,
}

impl Equation {
    /// Whether every line holds; none where there are none.
    pub fn holds(&self) -> Option<bool> {
        Some(self.lines.as_ref().ok()?.iter().all(Line::holds))
    }

    /// Whether it asks for the best of many that will do: not to be that is no fault.
    pub fn is_choice(&self) -> bool {
        self.number == "10"
    }

    /// The line that is furthest off, measured by what counts as equal.
    pub fn worst(&self) -> Option<&Line> {
        let far = |line: &Line| line.off().abs() / line.tolerance.max(f64::MIN_POSITIVE);
        self.lines.as_ref().ok()?.iter().max_by(|a, b| far(a).total_cmp(&far(b)))
    }
}
