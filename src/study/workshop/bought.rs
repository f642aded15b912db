//! [`as_bought`]: a machine whose discs are rounded as they are sold and bored, and what rounding leaves of its certificate.

use stillbase_mechanics::counterweights::{BrokenBound, CounterweightSpec, PlacedCounterweights};
use stillbase_mechanics::machine::{BarStock, Inertia, Machine, MachineError};

use super::tails::with_arms;
use super::{CutMachine, longest_tail, residual};

/// Steps of radii and places of discs as they are bought and bored, m.
const STEP_M: f64 = 1e-4;

/// What rounding changes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    /// Value of the objective before, which is certified for these bars.
    pub exact_value: f64,
    /// Upper bound of the difference between this and the optimum on these bars.
    pub exact_gap: f64,
    /// Bounds of the request that the rounded discs break.
    pub broken: Vec<BrokenBound>,
}

/// Returns the machine with counterweights as they are bought: radii, lengths and places in steps of 0.1 mm, and the
/// masses that follow from their plate. Its bars are cut for these; what is left of (7) and (8) is its residual. Its
/// value is that of the rounded machine, and no longer certified.
///
/// # Errors
/// If the machine is not valid.
pub fn as_bought(
    machine: &CutMachine,
    request: &CounterweightSpec,
    stock: &BarStock,
) -> Result<CutMachine, MachineError> {
    let exact = &machine.placed;
    let placed = rounded(exact, request, stock, &[])?;
    let (residual, tail) = (residual(&placed.machine), longest_tail(&placed.machine));
    let broken = request.broken_by(&placed.machine);
    let rounding = Some(Rounding { exact_value: exact.value, exact_gap: exact.gap, broken });
    Ok(CutMachine { placed, residual, tail, rounding, ..machine.clone() })
}

/// Returns the machine with rounded counterweights, on bars that reach at least over `reach`, m. Nothing is certified of
/// it, so its gap is infinite.
///
/// # Errors
/// If the machine is not valid.
pub fn rounded(
    exact: &PlacedCounterweights,
    request: &CounterweightSpec,
    stock: &BarStock,
    reach: &[[f64; 2]],
) -> Result<PlacedCounterweights, MachineError> {
    let (mut spec, plate) = (exact.machine.spec().clone(), &request.stock);
    let round = |x: f64| (x / STEP_M).round() * STEP_M;
    for weight in spec.counterweights.iter_mut().filter(|weight| !weight.fixed) {
        let (circle, outward) = (round(weight.circle_at()), weight.outward());
        let shape = plate.shape(weight.mass).rounded(STEP_M);
        (weight.at, weight.across) = (circle + outward * shape.from_circle(), round(weight.across));
        weight.mass = plate.mass(shape);
        weight.set_shape(shape);
    }
    let machine = Machine::new(spec)?;
    let ends = |link: usize| {
        let [from, to] = machine.extent_with(link, |_| true);
        reach.get(link).map_or([from, to], |[low, high]| [from.min(*low), to.max(*high)])
    };
    let reach: Vec<[f64; 2]> = (0..machine.links().len()).map(ends).collect();
    let machine = with_arms(&machine, stock, &reach)?;
    let added_mass =
        machine.spec().counterweights.iter().filter(|weight| !weight.fixed).map(|weight| weight.mass).sum();
    let value = request.objective.of(added_mass, &Inertia::of(&machine));
    Ok(PlacedCounterweights { machine, added_mass, value, gap: f64::INFINITY, unit: exact.unit })
}
