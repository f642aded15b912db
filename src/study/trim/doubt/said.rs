//! [`Doubt`]: why a measurement is not believed, in numbers and in words.

use std::fmt;

use super::odds::{KEPT, LEFT};
use crate::settings::number::shown;

/// Why a measurement is not believed.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// What is wrong with it, the likeliest first; none where no fault that is known explains it.
    pub causes: Vec<Cause>,
    /// Numbers that no machine has.
    pub impossible: Vec<Said>,
    /// The number that is furthest from the file.
    pub furthest: Option<Said>,
    /// What is not explained of force, N, and of moment, N m, as given.
    pub noise: [f64; 2],
    /// The same as shares of what was measured.
    pub shares: [f64; 2],
    /// By how much angles leave their limits as given, rad.
    pub leaves: f64,
}

/// What may be wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// What is.
    pub what: String,
    /// What would be right.
    pub want: String,
    /// log₁₀ of how much better it explains the measurement.
    pub odds: f64,
    /// What is not explained of force, N, and of moment, N m, without it.
    pub noise: [f64; 2],
    /// The same as shares of what would then be measured.
    pub shares: [f64; 2],
    /// The furthest number without it.
    pub furthest: Option<f64>,
    /// By how much angles leave their limits without it, rad.
    pub leaves: f64,
}

/// A number as the measurement as given has it.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// Which.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// As measured.
    pub value: f64,
    /// Half its interval of 95 %.
    pub half_width: f64,
    /// In the machine's file.
    pub file: f64,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |x: f64| shown(x, 4);
        match self.causes.as_slice() {
            [] => {
                write!(f, "this measurement is of no machine: want the columns, their signs and their units checked")?
            }
            [first, rest @ ..] => {
                write!(f, "{}: want {}", first.what, first.want)?;
                for cause in rest {
                    write!(f, "\n  or {}: want {}", cause.what, cause.want)?;
                }
                let it = if rest.is_empty() { "It" } else { "The first" };
                write!(f, "\n  {it} explains the data 10^{:.0} times as well.", first.odds.min(99.0))?;
            }
        }
        let then = self.causes.first();
        for Said { name, unit, value, half_width, file } in &self.impossible {
            write!(f, "\n  As given, {name} = {} ± {} {unit}", number(*value), number(*half_width))?;
            write!(f, " (file: {}), which no masses above zero make.", number(*file))?;
        }
        if let Some(Said { name, unit, value, half_width, file }) = &self.furthest {
            if !self.impossible.iter().any(|said| said.name == *name) {
                write!(f, "\n  As given, {name} = {} ± {} {unit}", number(*value), number(*half_width))?;
                write!(f, " (file: {}).", number(*file))?;
            }
            if let Some(now) =
                then.and_then(|then| then.furthest).filter(|now| (now - value).abs() > 0.01 * value.abs())
            {
                write!(f, " Without the fault, {name} = {}.", number(now))?;
            }
        }
        if let Some(then) = then {
            for (i, unit) in ["N", "N m"].into_iter().enumerate() {
                // In another unit the same is no evidence.
                if self.shares[i] > 1.1 * then.shares[i] {
                    write!(f, "\n  As given, {} {unit} are not explained;", number(self.noise[i]))?;
                    write!(f, " without the fault {}.", number(then.noise[i]))?;
                }
            }
            if self.leaves > LEFT && then.leaves < KEPT {
                write!(f, "\n  As given, angles leave their limits by {} rad;", number(self.leaves))?;
                write!(f, " without the fault they keep them.")?;
            }
        }
        Ok(())
    }
}
