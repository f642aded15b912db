//! [`Doubt`]: the reason for rejecting a measurement, in numbers and in words.

use std::fmt;

use super::odds::{LIMIT_KEPT_WITHIN, LIMIT_LEFT_BEYOND};
use stillbase_settings::number::{fixed, fixed_or_scientific};

/// Reason for rejecting a measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// Index of the motion that is doubted alone; `None` if all are.
    pub motion: Option<usize>,
    /// Possible faults, the most likely first; empty if no known fault explains the measurement.
    pub causes: Vec<Cause>,
    /// Values that no machine can have.
    pub impossible: Vec<MeasuredValue>,
    /// The unknown that deviates most from its value after the likeliest correction, or else from the file.
    pub furthest: Option<MeasuredValue>,
    /// What is not explained of each measured quantity as given.
    pub residuals: Vec<Residual>,
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
    /// What is not explained of each measured quantity after correction.
    pub residuals: Vec<Residual>,
    /// Value, after correction, of the unknown in [`Doubt::furthest`].
    pub furthest: Option<f64>,
    /// Violation of the limits of relative angles after correction, rad; 0 if there is none.
    pub limit_violation: f64,
}

/// What a fit leaves unexplained of a measured quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// Unit of the quantity, and what it is of if there are several with this unit: N, N m, rad/s of rate/1.
    pub unit: String,
    /// Root mean square residual.
    pub noise: f64,
    /// What counts of it, as a fraction of the root mean square of the measured values.
    pub share: f64,
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
        if let Some(motion) = self.motion {
            write!(f, "motion {}: ", motion + 1)?;
        }
        match self.causes.as_slice() {
            [] if self.impossible.is_empty() => {
                write!(f, "no machine explains this measurement, with none of the usual mistakes undone, either")?;
                for left in &self.residuals {
                    let percent = fixed(100.0 * left.share, 1);
                    write!(f, ": {} {} are left, {percent} % of it", number(left.noise), left.unit)?;
                }
                write!(
                    f,
                    ", and vary slowly, unlike noise.\n  Want angles and rates checked for two mistakes at once, each file \
                     alone, known masses and inertias weighed, thrusters off"
                )?;
            }
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
            for (was, now) in self.residuals.iter().zip(&then.residuals) {
                // A residual that changed only because its unit changed is no evidence.
                if was.share > 1.1 * now.share {
                    write!(f, "\n  As given, {} {} are not explained;", number(was.noise), was.unit)?;
                    write!(f, " without the fault {}.", number(now.noise))?;
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
