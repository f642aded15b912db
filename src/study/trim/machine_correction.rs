//! [`correct_machine`]: finds the least change of counterweights or links that removes the measured imbalance.

use schemars::JsonSchema;
use serde::Serialize;
use thiserror::Error;

use super::adopted_parameters::AdoptedParameters;
use super::trim_method::TrimMethod;
use stillbase_mechanics::balance::{
    Body, BodyQuantity, Condition, Parameter, ParameterBounds, RebalanceError, RebalanceRequest, rebalance_with,
    unreachable_by_changes,
};
use stillbase_mechanics::counterweights::{CounterweightError, place_weights_with, unreachable_by_weights};
use stillbase_mechanics::machine::{Counterweight, Inertia, Machine, MachineError, MachineSpec};
use stillbase_mechanics::planar::Vector;

/// Change of one number.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct ParameterChange {
    /// Key of the number.
    pub key: String,
    /// Present value; 0 for a new counterweight.
    pub from: f64,
    /// New value; its change is rounded to 0.1 g or 0.1 mm, unless a mass would then not be positive.
    pub to: f64,
    /// New value before rounding.
    pub exact: f64,
    /// Unit of the number.
    pub unit: &'static str,
}

/// Correction of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineCorrection {
    /// Changes, by number.
    pub changes: Vec<ParameterChange>,
    /// The nominal machine with the rounded changes.
    pub machine: Machine,
    /// Residual of each line of (7) and (8) after the change, if the machine is as identified.
    pub residuals: Vec<Vector>,
    /// Effect of the changes on each line of (7) and (8), independent of the identified machine.
    pub effects: Vec<Vector>,
}

impl MachineCorrection {
    /// Returns a correction without any change.
    pub fn unchanged(machine: &Machine, taken: &AdoptedParameters) -> Self {
        let residuals = taken.residuals();
        Self {
            changes: Vec::new(),
            machine: machine.clone(),
            effects: vec![Vector::default(); residuals.len()],
            residuals,
        }
    }
}

/// Reason that a machine cannot be corrected.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoCorrection {
    /// The numbers that may change do not suffice.
    #[error(transparent)]
    Kept(#[from] RebalanceError),
    /// No new counterweights correct the machine.
    #[error(transparent)]
    Weights(#[from] CounterweightError),
    /// The result is no valid machine.
    #[error("the machine with the changes: {0}")]
    Machine(String),
}

/// Resolution to which masses, kg, and positions, m, can be set: 0.1 g and 0.1 mm.
const SETTING_STEP: f64 = 1e-4;
/// New counterweights lighter than this fraction of the heaviest are omitted.
const NEGLIGIBLE_MASS: f64 = 1e-3;

/// Finds the least change that removes the identified imbalance. `way` states which numbers may change. The imbalance
/// that no values of these numbers can remove is included in [`MachineCorrection::residuals`].
///
/// # Errors
/// Fails if the parameters are not valid, if the bounds permit no solution, or if the result is no valid machine.
pub fn correct_machine(
    machine: &Machine,
    taken: &AdoptedParameters,
    way: &TrimMethod,
) -> Result<MachineCorrection, NoCorrection> {
    let nominal = balance_residuals(machine);
    let deviation: Vec<Vector> = taken.residuals().iter().zip(&nominal).map(|(real, nominal)| real - nominal).collect();
    let (exact, rounded) = match way {
        TrimMethod::Change(request) => {
            let unreachable = unreachable_by_changes(machine, request, &deviation)?;
            let rebalanced = rebalance_with(machine, request, &difference(&deviation, &unreachable))?;
            let parameters: Vec<Parameter> = request.parameters.iter().map(|one| one.parameter).collect();
            let spec = rounded(machine, rebalanced.machine.spec(), &parameters);
            (rebalanced.machine.spec().clone(), spec)
        }
        TrimMethod::Add(request) => {
            let unreachable = unreachable_by_weights(machine, request, &deviation)?;
            let placed = place_weights_with(machine, request, &difference(&deviation, &unreachable))?;
            let mut spec = placed.machine.spec().clone();
            for weight in &mut spec.counterweights {
                for value in [&mut weight.mass, &mut weight.at, &mut weight.across] {
                    *value = to_step(*value);
                }
                weight.set_shape(request.stock.shape(weight.mass));
            }
            let heaviest = spec.counterweights.iter().map(|weight| weight.mass).fold(0.0, f64::max);
            spec.counterweights.retain(|weight| weight.mass > NEGLIGIBLE_MASS * heaviest);
            (placed.machine.spec().clone(), spec)
        }
    };
    let changes = match way {
        TrimMethod::Change(request) => {
            request.parameters.iter().filter_map(|one| change(machine, one.parameter, &exact, &rounded)).collect()
        }
        TrimMethod::Add(_) => {
            exact.counterweights.iter().filter_map(|weight| added(weight, &rounded)).flatten().collect()
        }
    };
    let machine = Machine::new(rounded).map_err(|why| NoCorrection::Machine(why.to_string()))?;
    let now = balance_residuals(&machine);
    let left = now.iter().zip(&deviation).map(|(now, deviation)| now + deviation).collect();
    Ok(MachineCorrection { changes, machine, residuals: left, effects: difference(&now, &nominal) })
}

/// Returns the machine as built, before any correction, and the residuals of (7) and (8), by line, that it does not
/// reproduce. The least change of the links' centres of mass, along and across, gives the identified balance; the
/// links' inertias give the identified D_k.
///
/// # Errors
/// Fails if there is no such machine.
pub fn identified_machine(
    machine: &Machine,
    taken: &AdoptedParameters,
) -> Result<(Machine, Vec<Vector>), NoCorrection> {
    let links = 0..machine.links().len();
    let mut request = RebalanceRequest::default();
    for (link, quantity) in links.flat_map(|j| [(j, BodyQuantity::Along), (j, BodyQuantity::Across)]) {
        request.set_bounds(machine, Parameter::new(Body::Link(link), quantity), ParameterBounds::Free);
    }
    // With the negative of the identified imbalance as offset, the balance conditions hold for a machine with that
    // imbalance.
    let wanted: Vec<Vector> = taken.residuals().iter().map(|left| -left).collect();
    let misses = unreachable_by_changes(machine, &request, &wanted)?;
    let rebalanced = rebalance_with(machine, &request, &difference(&wanted, &misses))?;
    let mut spec = rebalanced.machine.spec().clone();
    set_momenta(&mut spec, &rebalanced.machine, &taken.momenta);
    let machine = Machine::new(spec).map_err(|why| NoCorrection::Machine(why.to_string()))?;
    Ok((machine, misses.iter().map(|miss| -miss).collect()))
}

/// Applies the correction of the nominal machine to the machine as built. Its counterweights become those of the
/// corrected nominal machine, and its links get the same changes.
///
/// # Errors
/// Fails if there is no such machine.
pub fn corrected_as_built(
    built: &Machine,
    nominal: &Machine,
    mended: &MachineCorrection,
) -> Result<Machine, MachineError> {
    let mut spec = built.spec().clone();
    spec.counterweights = mended.machine.spec().counterweights.clone();
    let changes = nominal.spec().links.iter().zip(&mended.machine.spec().links);
    for (own, (from, to)) in spec.links.iter_mut().zip(changes) {
        let mass = own.mass + to.mass - from.mass;
        // First moments are additive.
        let moment =
            |own_at: f64, from_at: f64, to_at: f64| (own.mass * own_at + to.mass * to_at - from.mass * from_at) / mass;
        let (com, normal) = (moment(own.com, from.com, to.com), moment(own.com_normal, from.com_normal, to.com_normal));
        (own.mass, own.com, own.com_normal) = (mass, com, normal);
    }
    Machine::new(spec)
}

/// Scales the inertias of each drive's links so that D_k has the given value. Inertias that would become negative are
/// not changed.
fn set_momenta(spec: &mut MachineSpec, machine: &Machine, momenta: &[Option<f64>]) {
    let inertia = Inertia::of(machine);
    for (k, wanted) in momenta.iter().enumerate() {
        let own = || machine.resolved_links().iter().enumerate().filter(|(_, part)| part.drive == k).map(|(j, _)| j);
        let sum: f64 = own().map(|j| spec.links[j].inertia).sum();
        let more = wanted.map_or(0.0, |wanted| wanted - inertia.momentum(k));
        if sum > 0.0 && sum + more > 0.0 {
            let factor = 1.0 + more / sum;
            own().collect::<Vec<_>>().into_iter().for_each(|j| spec.links[j].scale_inertia(factor));
        }
    }
}

fn balance_residuals(machine: &Machine) -> Vec<Vector> {
    let inertia = Inertia::of(machine);
    Condition::all(machine.drives()).map(|condition| condition.residual(&inertia)).collect()
}

fn difference(all: &[Vector], part: &[Vector]) -> Vec<Vector> {
    all.iter().zip(part).map(|(all, part)| all - part).collect()
}

fn to_step(value: f64) -> f64 {
    (value / SETTING_STEP).round() * SETTING_STEP
}

/// Rounds the changes of the parameters to steps that can be set.
fn rounded(machine: &Machine, exact: &MachineSpec, parameters: &[Parameter]) -> MachineSpec {
    let was = machine.spec();
    let mut spec = exact.clone();
    for parameter in parameters {
        if let Some((from, to)) = parameter.value(was).zip(parameter.value(exact)) {
            let value = from + to_step(to - from);
            parameter.set(&mut spec, if value > 0.0 || parameter.quantity != BodyQuantity::Mass { value } else { to });
        }
    }
    spec
}

fn change(
    machine: &Machine,
    parameter: Parameter,
    exact: &MachineSpec,
    rounded: &MachineSpec,
) -> Option<ParameterChange> {
    let unit = if parameter.quantity == BodyQuantity::Mass { "kg" } else { "m" };
    let (from, to) = (parameter.value(machine.spec())?, parameter.value(rounded)?);
    Some(ParameterChange { key: parameter.key(machine), unit, from, exact: parameter.value(exact)?, to })
}

/// Returns the mass and position of a new counterweight, the distance from the axis only if it is not 0; `None` if the
/// counterweight was omitted as too light.
fn added(weight: &Counterweight, rounded: &MachineSpec) -> Option<Vec<ParameterChange>> {
    let place = rounded.counterweights.iter().position(|own| own.link == weight.link)?;
    let own = &rounded.counterweights[place];
    let key = |what: &str| format!("counterweight.{}.{what}, new on link {}", place + 1, weight.link);
    let mut changes = vec![
        ParameterChange { key: key("mass"), unit: "kg", from: 0.0, exact: weight.mass, to: own.mass },
        ParameterChange { key: key("at"), unit: "m", from: 0.0, exact: weight.at, to: own.at },
    ];
    if weight.across != 0.0 {
        changes.push(ParameterChange {
            key: key("across"),
            unit: "m",
            from: 0.0,
            exact: weight.across,
            to: own.across,
        });
    }
    Some(changes)
}
