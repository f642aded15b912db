//! [`Equation`]: an equation of the paper with its present values.

use stillbase_mechanics::balance::Body;
use stillbase_mechanics::machine::Machine;

/// Body that contributes a part of a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A body, and the index of the link that it is or that carries it.
    Body(Body, usize),
    /// The rotor of the motor of the drive with this index.
    Rotor(usize),
}

impl Origin {
    /// Returns the index of the link that the body is or that carries it; `None` for a rotor.
    pub fn link(self) -> Option<usize> {
        match self {
            Self::Body(_, link) => Some(link),
            Self::Rotor(_) => None,
        }
    }

    /// Returns the name.
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
    /// Symbol in the notation of [`pieces`](super::pieces), without its sign.
    pub symbol: String,
    /// Whether the symbol has a minus sign.
    pub is_negative: bool,
    /// Value, with its sign.
    pub value: f64,
    /// Contributions of bodies, which add up to the value. Empty if no body is involved, such as for an angle.
    pub parts: Vec<(Origin, f64)>,
}

impl Term {
    /// Returns a term without contributions of bodies.
    pub(super) fn plain(symbol: impl Into<String>, value: f64) -> Self {
        Self { symbol: symbol.into(), is_negative: false, value, parts: Vec::new() }
    }

    /// Returns a term whose value is the sum of its parts.
    pub(super) fn sum(symbol: impl Into<String>, parts: Vec<(Origin, f64)>) -> Self {
        let value = parts.iter().map(|(_, part)| part).sum();
        Self { symbol: symbol.into(), is_negative: false, value, parts }
    }

    /// Returns the term with contributions of bodies.
    pub(super) fn from(self, parts: Vec<(Origin, f64)>) -> Self {
        Self { parts, ..self }
    }

    /// Returns the term with a minus sign at its symbol; the value has its sign already.
    pub(super) fn negative(self) -> Self {
        Self { is_negative: true, ..self }
    }

    /// Returns the links that contribute, each once, in ascending order.
    pub fn links(&self) -> Vec<usize> {
        let mut links: Vec<usize> = self.parts.iter().filter_map(|(origin, _)| origin.link()).collect();
        links.sort_unstable();
        links.dedup();
        links
    }
}

/// One equality. Both sides are computed independently, so their agreement is a check.
#[derive(Clone, Debug, PartialEq)]
pub struct Equality {
    /// Axis, drive or pair of drives; empty if the equation has one line.
    pub name: String,
    /// Unit of the values.
    pub unit: &'static str,
    /// Terms of the left side.
    pub left: Vec<Term>,
    /// Terms of the right side; empty for 0.
    pub right: Vec<Term>,
    /// Absolute tolerance on the difference of both sides.
    pub tolerance: f64,
}

/// Relative rounding tolerance: fraction of the sum of all |terms|.
const ROUNDING_TOLERANCE: f64 = 1e-12;

impl Equality {
    /// Returns a line whose sides agree within rounding; `scale` is the sum of the absolute values of all summands.
    pub(super) fn new(
        name: impl Into<String>,
        unit: &'static str,
        left: Vec<Term>,
        right: Vec<Term>,
        scale: f64,
    ) -> Self {
        let terms: f64 = left.iter().chain(&right).map(|term| term.value.abs()).sum();
        Self { name: name.into(), unit, left, right, tolerance: ROUNDING_TOLERANCE * terms.max(scale) }
    }

    /// Returns the values of both sides.
    pub fn sides(&self) -> [f64; 2] {
        [&self.left, &self.right].map(|side| side.iter().map(|term| term.value).sum())
    }

    /// Returns the residual: left side less right side.
    pub fn residual(&self) -> f64 {
        let [left, right] = self.sides();
        left - right
    }

    /// Returns whether both sides agree within the tolerance.
    pub fn holds(&self) -> bool {
        self.residual().abs() <= self.tolerance
    }
}

/// An equation of the paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// Number in the paper: `7`, `A1`.
    pub number: &'static str,
    /// Title in plain words.
    pub title: &'static str,
    /// Meaning, in one sentence.
    pub says: &'static str,
    /// General form in the notation of [`pieces`](super::pieces); empty if the lines are the general form.
    pub form: &'static str,
    /// Notes: deviations from the printed equation, omissions.
    pub notes: Vec<String>,
    /// Lines of the equation, or the reason that it does not apply to this machine.
    pub lines: Result<Vec<Equality>, String>,
}

impl Equation {
    /// Returns whether every line holds; `None` if there are no lines.
    pub fn holds(&self) -> Option<bool> {
        Some(self.lines.as_ref().ok()?.iter().all(Equality::holds))
    }

    /// Returns whether the equation selects the optimum among many solutions, so that a residual is no fault.
    pub fn is_choice(&self) -> bool {
        self.number == "10"
    }

    /// Returns the line with the largest ratio of residual to tolerance.
    pub fn least_accurate(&self) -> Option<&Equality> {
        let far = |line: &Equality| line.residual().abs() / line.tolerance.max(f64::MIN_POSITIVE);
        self.lines.as_ref().ok()?.iter().max_by(|a, b| far(a).total_cmp(&far(b)))
    }
}
