//! [`Doubt`]: the reason for rejecting a measurement, in numbers and in words.

use std::fmt;

use super::odds::{LIMIT_KEPT_WITHIN, LIMIT_LEFT_BEYOND};
use stillbase_settings::number::fixed_or_scientific;

/// Reason for rejecting a measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// Possible faults, the most likely first; empty if no known fault explains the measurement.
    pub causes: Vec<Cause>,
    /// Values that no machine can have.
    pub impossible: Vec<MeasuredValue>,
    /// The unknown that deviates most from its value after the likeliest correction, or else from the file.
    pub furthest: Option<MeasuredValue>,
    /// Root mean square residuals of force, N, and of moment, N m, as given.
    pub noise: [f64; 2],
    /// These residuals as fractions of the measured values.
    pub shares: [f64; 2],
    /// Violation of the limits of relative angles as given, rad; 0 if there is none.
    pub limit_violation: f64,
}

/// A possible fault.
#[derive(Clone, Debug, PartialEq)]
pub struct Cause {
    /// Description of the fault.
    pub what: String,
    /// Remedy.
    pub want: String,
    /// log₁₀ of the likelihood ratio to the measurement as given.
    pub odds: f64,
    /// Root mean square residuals of force, N, and of moment, N m, after correction.
    pub noise: [f64; 2],
    /// These residuals as fractions of the corrected measured values.
    pub shares: [f64; 2],
    /// Value, after correction, of the unknown in [`Doubt::furthest`].
    pub furthest: Option<f64>,
    /// Violation of the limits of relative angles after correction, rad; 0 if there is none.
    pub limit_violation: f64,
}

/// Value of an unknown by the measurement as given.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredValue {
    /// Name of the unknown.
    pub name: String,
    /// Unit of the value.
    pub unit: &'static str,
    /// Measured value.
    pub value: f64,
    /// Half width of the 95 % interval.
    pub half_width: f64,
    /// Value in the machine's file.
    pub file: f64,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |x: f64| fixed_or_scientific(x, 4);
        match self.causes.as_slice() {
            [] => write!(
                f,
                "no machine can give this measurement: want the columns, their signs and their units checked"
            )?,
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
        for MeasuredValue { name, unit, value, half_width, file } in &self.impossible {
            write!(f, "\n  As given, {name} = {} ± {} {unit}", number(*value), number(*half_width))?;
            write!(f, " (file: {}), which no positive masses can give.", number(*file))?;
        }
        if let Some(MeasuredValue { name, unit, value, half_width, file }) = &self.furthest {
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
                // A residual that changed only because its unit changed is no evidence.
                if self.shares[i] > 1.1 * then.shares[i] {
                    write!(f, "\n  As given, {} {unit} are not explained;", number(self.noise[i]))?;
                    write!(f, " without the fault {}.", number(then.noise[i]))?;
                }
            }
            if self.limit_violation > LIMIT_LEFT_BEYOND && then.limit_violation < LIMIT_KEPT_WITHIN {
                write!(f, "\n  As given, angles leave their limits by {} rad;", number(self.limit_violation))?;
                write!(f, " without the fault they keep them.")?;
            }
        }
        Ok(())
    }
}
