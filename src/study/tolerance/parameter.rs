//! [`UncertainParameter`]: one number of the machine that varies, named by the key of its setting.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | δ | deviation of the parameter from its nominal value | unit of the parameter |
//! | σ, h | standard deviation of a normal spread, half-width of a uniform one | unit of the parameter |
//! | α | lower bound of the truncated distribution, in standard deviations | 1 |
//! | μ_k | E[δᵏ], raw moments about the nominal value | (unit of the parameter)ᵏ |
//!
//! # Source
//! Moments of the normal distribution truncated at α: E[zᵏ] = (k − 1) E[zᵏ⁻²] + αᵏ⁻¹ φ(α)/(1 − Φ(α)), by parts.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::f64::consts::{PI, SQRT_2};

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;

use super::ToleranceError;
use super::deviate::inverse_normal;
use stillbase_mechanics::machine::{Machine, MachineError, MachineSpec};
use stillbase_session::scenario::{Amount, Spread};
use stillbase_settings::key::names;

/// The number of a machine that a parameter varies, with the index of its link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VariedQuantity {
    Com(usize),
    ComNormal(usize),
    Mass(usize),
    Inertia(usize),
    /// Named length, by its index in the order of names.
    Length(usize),
    PayloadMass,
    PayloadInertia,
}

impl VariedQuantity {
    fn unit(self) -> &'static str {
        match self {
            Self::Com(_) | Self::ComNormal(_) | Self::Length(_) => "m",
            Self::Mass(_) | Self::PayloadMass => "kg",
            Self::Inertia(_) | Self::PayloadInertia => "kg m²",
        }
    }

    /// Returns whether negative values are impossible.
    fn is_bounded(self) -> bool {
        !matches!(self, Self::Com(_) | Self::ComNormal(_))
    }

    /// Returns whether zero is impossible too.
    fn is_positive(self) -> bool {
        matches!(self, Self::Mass(_) | Self::Length(_))
    }
}

/// One number of the machine that varies.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "StatedParameter")]
pub struct UncertainParameter {
    /// Key of the setting: `link.5.com`.
    pub key: String,
    /// SI unit.
    pub unit: &'static str,
    /// Nominal value.
    pub nominal: f64,
    /// Spread as stated in the scenario.
    pub spread: Spread,
    /// Standard deviation of the drawn values.
    pub deviation: f64,
    /// Fraction of the stated distribution that is impossible, such as a mass below zero. Values are drawn from the
    /// truncated distribution, to which mean and deviation refer.
    pub cut: f64,
    pub(super) quantity: VariedQuantity,
    /// Number of the random stream, counted over all numbers that could vary, so that draws of one parameter do not
    /// depend on which others vary.
    pub(super) stream: u64,
    /// Parameter of the distribution, σ or h, in the parameter's unit.
    scale: f64,
    /// E[δᵏ], k = 0..=4.
    pub(super) moments: [f64; 5],
}

/// Returns every number of a machine that can vary, in a fixed order.
fn everything(spec: &MachineSpec) -> Vec<(VariedQuantity, String, f64)> {
    let mut all = Vec::new();
    for (j, link) in spec.links.iter().enumerate() {
        all.extend([
            (VariedQuantity::Com(j), format!("link.{}.com", link.name), link.com),
            (VariedQuantity::ComNormal(j), format!("link.{}.com_normal", link.name), link.com_normal),
            (VariedQuantity::Mass(j), format!("link.{}.mass", link.name), link.mass),
            (VariedQuantity::Inertia(j), format!("link.{}.inertia", link.name), link.inertia),
        ]);
    }
    for (i, (name, metres)) in spec.lengths.iter().enumerate() {
        all.push((VariedQuantity::Length(i), format!("length.{name}"), *metres));
    }
    all.push((VariedQuantity::PayloadMass, "payload.mass".into(), spec.payload.mass));
    all.push((VariedQuantity::PayloadInertia, "payload.inertia".into(), spec.payload.inertia));
    all
}

/// Returns the parameters of a machine that vary; if several keys match one, the key with the fewest `*` applies.
///
/// # Errors
/// Fails if a key matches no number, a percentage refers to zero, nothing varies, a spread is too wide, or too much
/// of a distribution is impossible.
pub(super) fn parameters(
    machine: &Machine,
    spreads: &BTreeMap<String, Spread>,
) -> Result<Vec<UncertainParameter>, ToleranceError> {
    let all = everything(machine.spec());
    for (key, spread) in spreads {
        let named: Vec<_> = all.iter().filter(|(_, k, _)| names(key, k)).collect();
        if named.is_empty() {
            return Err(ToleranceError::UnknownKey { key: key.clone() });
        }
        let is_relative = matches!(spread.amount(), Amount::Percent(p) if p > 0.0);
        if is_relative && named.iter().all(|(_, _, nominal)| *nominal == 0.0) {
            return Err(ToleranceError::PercentOfZero { key: key.clone() });
        }
    }
    let mut found = Vec::new();
    for (stream, (quantity, key, nominal)) in all.into_iter().enumerate() {
        let stars = |pattern: &str| pattern.matches('*').count();
        let spread = spreads.iter().filter(|(p, _)| names(p, &key)).min_by_key(|(p, _)| stars(p));
        let Some((_, &spread)) = spread else { continue };
        let scale = match spread.amount() {
            Amount::Absolute(x) => x,
            Amount::Percent(x) => x / 100.0 * nominal.abs(),
        };
        if scale > 0.0 {
            found.push(UncertainParameter::new(quantity, key, nominal, spread, scale, stream as u64)?);
        }
    }
    match found.is_empty() {
        true => Err(ToleranceError::NothingVaries),
        false => Ok(found),
    }
}

/// Maximum fraction of a distribution that may be impossible.
const MAX_TRUNCATED: f64 = 0.1;

/// Maximum of |nominal value| plus nine times the scale, in the unit of the parameter.
const MAX_VALUE: f64 = 1e6;

/// Serialised as key, unit, nominal value, spread, and the statistics of the drawn values.
#[derive(JsonSchema, Serialize)]
struct StatedParameter {
    key: String,
    unit: &'static str,
    nominal: f64,
    spread: String,
    deviation: f64,
    mean_deviation: f64,
    cut: f64,
}

impl From<UncertainParameter> for StatedParameter {
    fn from(of: UncertainParameter) -> Self {
        Self {
            mean_deviation: of.mean_deviation(),
            key: of.key,
            unit: of.unit,
            nominal: of.nominal,
            spread: of.spread.to_string(),
            deviation: of.deviation,
            cut: of.cut,
        }
    }
}

impl JsonSchema for UncertainParameter {
    fn schema_name() -> Cow<'static, str> {
        StatedParameter::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        StatedParameter::json_schema(generator)
    }
}

impl UncertainParameter {
    fn new(
        quantity: VariedQuantity,
        key: String,
        nominal: f64,
        spread: Spread,
        scale: f64,
        stream: u64,
    ) -> Result<Self, ToleranceError> {
        if nominal.abs() + 9.0 * scale > MAX_VALUE {
            return Err(ToleranceError::TooWide { key, scale, unit: quantity.unit() });
        }
        let bound = quantity.is_bounded().then_some(-nominal);
        let (cut, moments) = match spread {
            Spread::Normal(_) => normal_moments(scale, bound),
            Spread::Uniform(_) => uniform_moments(scale, bound),
        };
        if cut > MAX_TRUNCATED {
            return Err(ToleranceError::Impossible { key, nominal, unit: quantity.unit(), cut });
        }
        let deviation = (moments[2] - moments[1] * moments[1]).max(0.0).sqrt();
        let unit = quantity.unit();
        Ok(Self { key, unit, nominal, spread, deviation, cut, quantity, stream, scale, moments })
    }

    /// Returns the mean deviation from the nominal value: zero unless the distribution is truncated.
    pub fn mean_deviation(&self) -> f64 {
        self.moments[1]
    }

    /// Replaces uniform numbers in (0, 1) by deviations.
    pub(super) fn deviate(&self, u: &mut [f64]) {
        match self.spread {
            Spread::Normal(_) => {
                // Sample the upper fraction 1 − cut of the distribution: draw quantiles from (0, 1 − cut) and negate
                // them.
                let (keep, scale) = (1.0 - self.cut, -self.scale);
                u.iter_mut().for_each(|u| *u *= keep);
                inverse_normal(u);
                u.iter_mut().for_each(|z| *z *= scale);
            }
            Spread::Uniform(_) => {
                let low = self.scale * (2.0 * self.cut - 1.0);
                let width = self.scale - low;
                u.iter_mut().for_each(|u| *u = low + width * *u);
            }
        }
        if self.cut > 0.0 {
            // Only rounding can violate this bound.
            let least = if self.quantity.is_positive() { -self.nominal * (1.0 - 1e-9) } else { -self.nominal };
            u.iter_mut().for_each(|d| *d = d.max(least));
        }
    }

    /// Sets this number of a machine.
    pub(super) fn set(&self, spec: &mut MachineSpec, value: f64) {
        match self.quantity {
            VariedQuantity::Com(j) => spec.links[j].com = value,
            VariedQuantity::ComNormal(j) => spec.links[j].com_normal = value,
            VariedQuantity::Mass(j) => spec.links[j].mass = value,
            VariedQuantity::Inertia(j) => {
                // The other moments follow in proportion, so that they remain those of a body.
                let link = &mut spec.links[j];
                let was = link.inertia;
                link.scale_inertia(if was > 0.0 { value / was } else { 1.0 });
                link.inertia = value;
            }
            VariedQuantity::Length(i) => {
                if let Some(metres) = spec.lengths.values_mut().nth(i) {
                    *metres = value;
                }
            }
            VariedQuantity::PayloadMass => spec.payload.mass = value,
            VariedQuantity::PayloadInertia => {
                let was = spec.payload.inertia;
                spec.payload.scale_inertia(if was > 0.0 { value / was } else { 1.0 });
                spec.payload.inertia = value;
            }
        }
    }

    /// Returns a machine with this number changed.
    ///
    /// # Errors
    /// Fails if the changed machine is not valid.
    pub(super) fn changed(&self, machine: &Machine, value: f64) -> Result<Machine, MachineError> {
        let mut spec = machine.spec().clone();
        self.set(&mut spec, value);
        Machine::new(spec)
    }
}

/// Returns the probability below a bound, and E[δᵏ] of the normal distribution truncated there.
fn normal_moments(sigma: f64, bound: Option<f64>) -> (f64, [f64; 5]) {
    let alpha = bound.map_or(f64::NEG_INFINITY, |b| b / sigma);
    let (cut, density) = match alpha.is_finite() {
        true => (0.5 * libm::erfc(-alpha / SQRT_2), (-0.5 * alpha * alpha).exp() / (2.0 * PI).sqrt()),
        false => (0.0, 0.0),
    };
    let ratio = density / (1.0 - cut);
    // If the density at α is 0, the terms with α vanish.
    let alpha = if ratio > 0.0 { alpha } else { 0.0 };
    let mut z = [1.0, ratio, 0.0, 0.0, 0.0];
    for k in 2..5 {
        z[k] = (k - 1) as f64 * z[k - 2] + alpha.powi(k as i32 - 1) * ratio;
    }
    (cut, std::array::from_fn(|k| z[k] * sigma.powi(k as i32)))
}

/// Returns the probability below a bound, and E[δᵏ] of the uniform distribution truncated there.
fn uniform_moments(half: f64, bound: Option<f64>) -> (f64, [f64; 5]) {
    let low = bound.map_or(-half, |b| b.max(-half));
    let power = |x: f64, k: usize| x.powi(k as i32 + 1);
    let moment = |k: usize| (power(half, k) - power(low, k)) / ((k + 1) as f64 * (half - low));
    ((low + half) / (2.0 * half), std::array::from_fn(moment))
}
