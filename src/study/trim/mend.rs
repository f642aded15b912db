//! [`mend`]: the least change of counterweights that takes away what was measured.

use serde::Serialize;
use thiserror::Error;

use super::taken::Taken;
use super::way::Way;
use crate::mechanics::balance::{
    Body, Condition, Hold, Keep, NotKept, Parameter, Quantity, keep_with, unreachable_by_changes,
};
use crate::mechanics::counterweights::{NoWeights, place_with, unreachable_by_weights};
use crate::mechanics::machine::{Counterweight, Inertia, Machine, MachineError, MachineSpec};
use crate::mechanics::planar::Vector;

/// One number that changes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Its key.
    pub key: String,
    /// What it is; 0 for a counterweight that is new.
    pub from: f64,
    /// What mends it, as a person can set it: to 0.1 g or 0.1 mm.
    pub to: f64,
    /// The same exactly.
    pub exact: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// What mends a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Mended {
    /// Each number that changes.
    pub changes: Vec<Change>,
    /// The nominal machine with them, as a person can set them.
    pub machine: Machine,
    /// What that leaves of each line of (7) and (8), if the machine is what it is taken to be.
    pub left: Vec<Vector>,
    /// What they do to each line of (7) and (8), whatever the machine is.
    pub by: Vec<Vector>,
}

impl Mended {
    /// The machine as it is.
    pub fn not_at_all(machine: &Machine, taken: &Taken) -> Self {
        let left = taken.left();
        Self { changes: Vec::new(), machine: machine.clone(), by: vec![Vector::default(); left.len()], left }
    }
}

/// Why nothing mends a machine.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoMend {
    /// Numbers that may change cannot.
    #[error(transparent)]
    Kept(#[from] NotKept),
    /// No new counterweights do.
    #[error(transparent)]
    Weights(#[from] NoWeights),
    /// The result is no machine.
    #[error("the machine with the changes: {0}")]
    Machine(String),
}

/// Places are set to 0.1 mm and masses to 0.1 g.
const STEP: f64 = 1e-4;
/// New counterweights lighter than this part of the heaviest are left out.
const LIGHT: f64 = 1e-3;

/// The least change with which nothing is left of what a machine is taken to have. What no change on the axes of the
/// links takes away stays, and is in [`Mended::left`].
///
/// # Errors
/// If bounds leave no way.
pub fn mend(machine: &Machine, taken: &Taken, way: &Way) -> Result<Mended, NoMend> {
    let nominal = left(machine);
    let beyond: Vec<Vector> = taken.left().iter().zip(&nominal).map(|(real, nominal)| real - nominal).collect();
    let (exact, rounded) = match way {
        Way::Change(asked) => {
            let stays = unreachable_by_changes(machine, asked, &beyond)?;
            let kept = keep_with(machine, asked, &less(&beyond, &stays))?;
            let parameters: Vec<Parameter> = asked.parameters.iter().map(|one| one.parameter).collect();
            let spec = rounded(machine, kept.machine.spec(), &parameters);
            (kept.machine.spec().clone(), spec)
        }
        Way::Add(asked) => {
            let stays = unreachable_by_weights(machine, asked, &beyond)?;
            let placed = place_with(machine, asked, &less(&beyond, &stays))?;
            let mut spec = placed.machine.spec().clone();
            for weight in &mut spec.counterweights {
                (weight.mass, weight.at) = (set(weight.mass), set(weight.at));
                weight.radius = asked.disc.radius(weight.mass);
            }
            let heaviest = spec.counterweights.iter().map(|weight| weight.mass).fold(0.0, f64::max);
            spec.counterweights.retain(|weight| weight.mass > LIGHT * heaviest);
            (placed.machine.spec().clone(), spec)
        }
    };
    let changes = match way {
        Way::Change(asked) => {
            asked.parameters.iter().filter_map(|one| change(machine, one.parameter, &exact, &rounded)).collect()
        }
        Way::Add(_) => exact.counterweights.iter().filter_map(|weight| added(weight, &rounded)).flatten().collect(),
    };
    let machine = Machine::new(rounded).map_err(|why| NoMend::Machine(why.to_string()))?;
    let now = self::left(&machine);
    let left = now.iter().zip(&beyond).map(|(now, beyond)| now + beyond).collect();
    Ok(Mended { changes, machine, left, by: less(&now, &nominal) })
}

/// A machine whose links have what was measured of balance, by the least change of their centres of mass, along and
/// across, and of D_k, by their inertias: as it stands, before anything mends it. What no such change makes of balance is
/// given by line.
///
/// # Errors
/// If no such machine can be.
pub fn identified(machine: &Machine, taken: &Taken) -> Result<(Machine, Vec<Vector>), NoMend> {
    let links = 0..machine.links().len();
    let mut asked = Keep::default();
    for (link, quantity) in links.flat_map(|j| [(j, Quantity::Along), (j, Quantity::Across)]) {
        asked.hold(machine, Parameter::new(Body::Link(link), quantity), Hold::Free);
    }
    // With minus what was measured, balance is where the machine has as much.
    let wanted: Vec<Vector> = taken.left().iter().map(|left| -left).collect();
    let misses = unreachable_by_changes(machine, &asked, &wanted)?;
    let kept = keep_with(machine, &asked, &less(&wanted, &misses))?;
    let mut spec = kept.machine.spec().clone();
    turned(&mut spec, &kept.machine, &taken.momenta);
    let machine = Machine::new(spec).map_err(|why| NoMend::Machine(why.to_string()))?;
    Ok((machine, misses.iter().map(|miss| -miss).collect()))
}

/// A machine as it was built, with what mends the nominal one: its counterweights, and the changes of its links.
///
/// # Errors
/// If no such machine can be.
pub fn trimmed(built: &Machine, nominal: &Machine, mended: &Mended) -> Result<Machine, MachineError> {
    let mut spec = built.spec().clone();
    spec.counterweights = mended.machine.spec().counterweights.clone();
    let changes = nominal.spec().links.iter().zip(&mended.machine.spec().links);
    for (own, (from, to)) in spec.links.iter_mut().zip(changes) {
        let mass = own.mass + to.mass - from.mass;
        // First moments add up.
        let moment =
            |own_at: f64, from_at: f64, to_at: f64| (own.mass * own_at + to.mass * to_at - from.mass * from_at) / mass;
        let (com, normal) = (moment(own.com, from.com, to.com), moment(own.com_normal, from.com_normal, to.com_normal));
        (own.mass, own.com, own.com_normal) = (mass, com, normal);
    }
    Machine::new(spec)
}

/// Inertias of the links of each drive in proportion, so that it has a momentum; as they are where that would make them
/// negative.
fn turned(spec: &mut MachineSpec, machine: &Machine, momenta: &[Option<f64>]) {
    let inertia = Inertia::of(machine);
    for (k, wanted) in momenta.iter().enumerate() {
        let own = || machine.resolved_links().iter().enumerate().filter(|(_, part)| part.drive == k).map(|(j, _)| j);
        let sum: f64 = own().map(|j| spec.links[j].inertia).sum();
        let more = wanted.map_or(0.0, |wanted| wanted - inertia.momentum(k));
        if sum > 0.0 && sum + more > 0.0 {
            let factor = 1.0 + more / sum;
            own().collect::<Vec<_>>().into_iter().for_each(|j| spec.links[j].inertia *= factor);
        }
    }
}

fn left(machine: &Machine) -> Vec<Vector> {
    let inertia = Inertia::of(machine);
    Condition::all(machine.drives()).map(|condition| condition.left(&inertia)).collect()
}

fn less(all: &[Vector], part: &[Vector]) -> Vec<Vector> {
    all.iter().zip(part).map(|(all, part)| all - part).collect()
}

fn set(value: f64) -> f64 {
    (value / STEP).round() * STEP
}

/// Changed numbers as a person can set them: what changes, in whole steps.
fn rounded(machine: &Machine, exact: &MachineSpec, parameters: &[Parameter]) -> MachineSpec {
    let was = machine.spec();
    let mut spec = exact.clone();
    for parameter in parameters {
        if let Some((from, to)) = parameter.value(was).zip(parameter.value(exact)) {
            let value = from + set(to - from);
            parameter.set(&mut spec, if value > 0.0 || parameter.quantity != Quantity::Mass { value } else { to });
        }
    }
    spec
}

fn change(machine: &Machine, parameter: Parameter, exact: &MachineSpec, rounded: &MachineSpec) -> Option<Change> {
    let unit = if parameter.quantity == Quantity::Mass { "kg" } else { "m" };
    let (from, to) = (parameter.value(machine.spec())?, parameter.value(rounded)?);
    Some(Change { key: parameter.key(machine), unit, from, exact: parameter.value(exact)?, to })
}

/// Mass and place of a counterweight that is new; none if a person cannot set so little.
fn added(weight: &Counterweight, rounded: &MachineSpec) -> Option<[Change; 2]> {
    let place = rounded.counterweights.iter().position(|own| own.link == weight.link)?;
    let own = &rounded.counterweights[place];
    let key = |what: &str| format!("counterweight.{}.{what}, new on link {}", place + 1, weight.link);
    Some([
        Change { key: key("mass"), unit: "kg", from: 0.0, exact: weight.mass, to: own.mass },
        Change { key: key("at"), unit: "m", from: 0.0, exact: weight.at, to: own.at },
    ])
}
