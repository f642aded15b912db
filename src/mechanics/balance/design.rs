//! Balance as a linear problem for the positions of the links' centres of mass, (7)–(10).
//!
//! The conditions are linear in the l_cj, so for n drives they are A l_c = k with n + n(n−1)/2 rows. [`design`]
//! finds the solution that minimises Σ (p_j l_cj)².
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | l_c | position of each link's CM along the link | links, m |
//! | A, k | A l_c = k; rows g_1..g_n, then C_kl by pairs | (n + n(n−1)/2) × links |
//! | p | penalty on each l_cj | links |
//!
//! # Source
//! (9), (10). The weight that gives Table I is not the printed W but W^(−1/2): see [`Preset`].

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use super::condition::Condition;
use super::plane::{LinearEquation, SolutionSpace};
use crate::machine::{Inertia, Machine, MachineError};
use stillbase_settings::number::counted;
use stillbase_settings::word::{Choice, words};

words! {
    /// Named penalties. All but the minimum norm are for machines of nine links.
    pub enum Preset {
        /// They are W^(−1/2), with the W printed beside (10).
        Table1 = "table-1", "those of Table I", "Those that give Table I to its last digit";
        /// The resulting l_c differ from Table I by up to 0.17 m.
        AsPrinted = "as-printed", "as printed", "Those printed beside (10), W";
        MinimumNorm = "minimum-norm", "all alike", "1 for every link";
    }
}

/// The weights printed beside (10).
const W: [f64; 9] = [1.0, 0.2, 1.0, 1.2, 1.0, 1.0, 1.0, 1.2, 1.0];

impl Preset {
    /// Returns its name in files and commands.
    pub fn name(self) -> &'static str {
        self.words().file
    }

    /// Returns the penalty on each of `links` links.
    ///
    /// # Errors
    /// If the preset is for nine links and the machine has another number.
    pub fn penalty(self, links: usize) -> Result<Vec<f64>, DesignError> {
        match self {
            Self::MinimumNorm => Ok(vec![1.0; links]),
            _ if links != W.len() => Err(DesignError::Penalties { count: W.len(), links }),
            Self::AsPrinted => Ok(W.to_vec()),
            Self::Table1 => Ok(W.map(|w| 1.0 / w.sqrt()).to_vec()),
        }
    }
}

/// Reason why there is no balanced design.
#[derive(Debug, Error)]
pub enum DesignError {
    /// The number of penalties is not the number of links.
    #[error("{count} penalties for {}: want one a link", counted(links, "link"))]
    Penalties {
        /// Number of penalties that were given.
        count: usize,
        /// Number of links of the machine.
        links: usize,
    },
    /// A penalty that is not positive.
    #[error("penalty {value} of link {link}: want a number above 0")]
    Penalty {
        /// The penalty.
        value: f64,
        /// The link.
        link: String,
    },
    /// The conditions contradict each other, or an unsatisfied condition does not depend on any l_c.
    #[error(
        "no centres of mass along the links balance this machine: {residual} remain at best in {condition}; \
             counterweights need a link that follows a drive of this condition and is attached to the base"
    )]
    Inconsistent {
        /// The condition with the largest residual.
        condition: String,
        /// Its residual, with unit.
        residual: String,
    },
    /// The result is not a valid machine.
    #[error(transparent)]
    Machine(#[from] MachineError),
}

/// Returns A and k of (9).
pub fn conditions(machine: &Machine) -> (DMatrix<f64>, DVector<f64>) {
    let (all, links) = (Condition::all_of(machine).collect::<Vec<_>>(), machine.links());
    let parts = machine.resolved_links();
    let a = DMatrix::from_fn(all.len(), links.len(), |row, j| links[j].mass * all[row].by_moment(&parts[j]));
    // The residual at the present l_c is A l_c − k.
    let inertia = Inertia::of(machine);
    let com = DVector::from_iterator(links.len(), links.iter().map(|l| l.com));
    let k = &a * com - DVector::from_iterator(all.len(), all.iter().map(|condition| condition.residual(&inertia).re));
    (a, k)
}

/// Returns the balanced, invariant machine with the least Σ (p_j l_cj)², (10).
///
/// # Errors
/// If a penalty is not positive or missing, if no l_c satisfies (7) and (8), or if the result is no valid machine.
pub fn design(machine: &Machine, penalty: &[f64]) -> Result<Machine, DesignError> {
    let links = machine.links();
    if penalty.len() != links.len() {
        return Err(DesignError::Penalties { count: penalty.len(), links: links.len() });
    }
    if let Some(j) = penalty.iter().position(|p| !(p.is_finite() && *p > 0.0)) {
        return Err(DesignError::Penalty { value: penalty[j], link: links[j].name.clone() });
    }
    let (a, k) = conditions(machine);
    // The tolerance is infinite, because the residual of the finished machine is checked instead.
    let equation = |row: usize| LinearEquation {
        a: penalty.iter().enumerate().map(|(j, p)| a[(row, j)] / p).collect(),
        right: k[row],
        tolerance: f64::INFINITY,
    };
    let x = SolutionSpace::of(&(0..a.nrows()).map(equation).collect::<Vec<_>>(), penalty.len()).particular;
    let mut spec = machine.spec().clone();
    for (j, link) in spec.links.iter_mut().enumerate() {
        let (body, com) = (&links[j], x[j] / penalty[j]);
        // If a link carries counterweights, only the link's own centre of mass is shifted.
        link.com = match body.mass > link.mass {
            true => link.com + body.mass * (com - body.com) / link.mass,
            false => com,
        };
    }
    let designed = Machine::new(spec)?;
    let inertia = Inertia::of(&designed);
    if inertia.is_balanced() {
        return Ok(designed);
    }
    let (condition, left) = largest_residual(&designed);
    Err(DesignError::Inconsistent { condition, residual: left })
}

/// Returns the name of the condition with the largest residual, and the residual with its unit. Conditions (8) are
/// considered only if all of (7) are satisfied.
fn largest_residual(machine: &Machine) -> (String, String) {
    let inertia = Inertia::of(machine);
    let force = !inertia.is_force_balanced();
    let of_kind = Condition::all_of(machine).filter(|condition| matches!(condition, Condition::Force(_)) == force);
    let size = |condition: &Condition| condition.residual(&inertia).norm();
    let worst = of_kind.max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(Condition::Force(0));
    (worst.name(machine), format!("{:.3e} {}", size(&worst), worst.unit()))
}
