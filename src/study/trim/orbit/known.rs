//! [`KnownValue`]: masses and inertias that [`orbit_trim`](super::orbit_trim()) takes as known, and how far it depends on them.
//!
//! Without a wheel the fit takes up any error of these values: it turns into wrong coefficients, and nothing of it is left
//! in the rates. So a fit of all unknowns cannot tell it. But if one known value alone explains the rates as well as
//! all unknowns together, it is the simpler explanation.

use schemars::JsonSchema;
use serde::Serialize;

use super::craft::Craft;
use super::motion::{OrbitBase, OrbitMotion};
use nalgebra::DVector;
use stillbase_mechanics::machine::{Inertia, Machine};

/// A known value is explained as changed by at most this factor, either way.
const MAX_FACTOR: f64 = 2.0;
/// Relative change of a known value for derivatives, and the one at which the iteration ends.
const SMALL_CHANGE: f64 = 1e-5;
const LAST_CHANGE: f64 = 1e-9;
/// Maximum number of Gauss–Newton steps.
const MAX_STEPS: usize = 20;

/// A value that is taken as known, and another value of it that alone explains the rates of the base.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct KnownValue {
    /// Its key, such as `link.2.mass` or `base.inertia`.
    pub key: String,
    /// Unit of the value.
    pub unit: &'static str,
    /// Value of the file.
    pub file: f64,
    /// Value that explains the rates.
    pub explains: f64,
    /// Standard deviation of the base rate that is then not explained, rad/s.
    pub rate_left: f64,
}

/// Rows by which explanations are compared.
pub(super) struct Explained<'a> {
    machine: &'a Machine,
    base: &'a OrbitBase,
    motions: Vec<OrbitMotion>,
}

impl<'a> Explained<'a> {
    pub fn of(machine: &'a Machine, base: &'a OrbitBase, motions: &[OrbitMotion]) -> Self {
        Self { machine, base, motions: OrbitMotion::thinned(motions) }
    }

    /// Returns the known values that alone explain the rates up to `most`, rad/s: the best first.
    pub fn by_one_value(&self, most: f64) -> Vec<KnownValue> {
        let mut found: Vec<KnownValue> = self.values().into_iter().filter_map(|known| self.explains(known)).collect();
        found.retain(|known| known.rate_left <= most);
        found.sort_by(|a, b| a.rate_left.total_cmp(&b.rate_left));
        found
    }

    /// Returns all known values of machine and base.
    fn values(&self) -> Vec<KnownValue> {
        let known = |key: String, unit, file| KnownValue { key, unit, file, explains: file, rate_left: f64::INFINITY };
        let links = self.machine.spec().links.iter();
        let mut all: Vec<KnownValue> =
            links.map(|link| known(format!("link.{}.mass", link.name), "kg", link.mass)).collect();
        all.push(known("payload.mass".into(), "kg", self.machine.spec().payload.mass));
        all.push(known("base.mass".into(), "kg", self.base.body.mass));
        all.push(known("base.inertia".into(), "kg m²", self.base.body.inertia));
        all.push(known("base.wheel.inertia".into(), "kg m²", self.base.wheel));
        all.retain(|known| known.file > 0.0);
        all
    }

    /// Returns machine and base with a known value changed by a factor.
    fn changed(&self, known: &KnownValue, factor: f64) -> Option<(Machine, OrbitBase)> {
        let (mut base, value) = (*self.base, factor * known.file);
        match known.key.as_str() {
            "base.mass" => base.body.mass = value,
            "base.inertia" => base.body.inertia = value,
            "base.wheel.inertia" => base.wheel = value,
            key => return Some((self.machine.set(key, &value.to_string()).ok()?, base)),
        }
        Some((self.machine.clone(), base))
    }

    /// Finds the value of one known quantity that explains the rates best.
    fn explains(&self, known: KnownValue) -> Option<KnownValue> {
        let errors = |factor: f64| {
            let (machine, base) = self.changed(&known, factor)?;
            let craft = Craft::of(&machine, &base);
            let x = DVector::from_vec(craft.unknowns.nominal(&Inertia::of(&machine)));
            Some(self.errors(&craft, &x))
        };
        let mut factor = 1.0;
        let mut now = errors(factor)?;
        for _ in 0..MAX_STEPS {
            let slope = (errors(factor + SMALL_CHANGE)? - &now) / SMALL_CHANGE;
            let size = slope.norm_squared();
            if size == 0.0 {
                return None;
            }
            let step = (-slope.dot(&now) / size).clamp(-0.3 * factor, 0.3 * factor);
            factor = (factor + step).clamp(1.0 / MAX_FACTOR, MAX_FACTOR);
            now = errors(factor)?;
            if step.abs() < LAST_CHANGE {
                break;
            }
        }
        let rate_left = (now.norm_squared() / now.len() as f64).sqrt();
        Some(KnownValue { explains: factor * known.file, rate_left, ..known })
    }

    /// Returns measured less predicted rates of the base, rad/s, with the momentum of each motion that fits best.
    fn errors(&self, craft: &Craft, x: &DVector<f64>) -> DVector<f64> {
        let of = craft.coefficients(x);
        let mut errors = Vec::new();
        for motion in &self.motions {
            let rows: Vec<[f64; 2]> = (0..motion.rows())
                .map(|row| {
                    let [still, turning] = craft.row(&of, &motion.angles[row], &motion.rates[row], None, &mut []);
                    let wheel = craft.wheel * motion.wheel_rate[row];
                    [motion.base_rate[row] + (still + wheel) / turning, 1.0 / turning]
                })
                .collect();
            let [along, size] = rows.iter().fold([0.0; 2], |[a, s], [at, per]| [a + at * per, s + per * per]);
            errors.extend(rows.iter().map(|[at, per]| at - along / size * per));
        }
        DVector::from_vec(errors)
    }
}

/// Returns machine mass and base as they are with each known value 1 % larger: mass and inertia of the base, mass of the
/// machine, and inertia of a wheel.
pub(super) fn one_percent_off(machine: &Machine, base: &OrbitBase) -> Vec<Craft> {
    const FACTOR: f64 = 1.01;
    let with = |change: fn(&mut OrbitBase)| {
        let mut base = *base;
        change(&mut base);
        Craft::of(machine, &base)
    };
    let mut all = vec![
        with(|base| base.body.mass *= FACTOR),
        with(|base| base.body.inertia *= FACTOR),
        Craft::with_mass(machine, base, FACTOR * machine.mass()),
    ];
    if base.wheel > 0.0 {
        all.push(with(|base| base.wheel *= FACTOR));
    }
    all
}
