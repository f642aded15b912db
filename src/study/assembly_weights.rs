//! [`balance_assembly`]: balances all blocks of an assembly together by counterweights, and reports on it.

use schemars::JsonSchema;
use serde::Serialize;

use super::assembly_check::{AssemblyReport, BlockReport};
use super::balance_constants::BalanceConstants;
use super::counterweights::{ChosenRotor, CounterweightNumbers, NoCounterweights, all_numbers, removed_weights};
use super::front_point::FrontPoint;
use super::measures::Measures;
use stillbase_mechanics::assembly::Assembly;
use stillbase_mechanics::counterweights::{
    AssemblyFrontSearch, CounterweightSpec, PlacedCounterweights, SpatialGoal, place_in_assembly, reachable_goals,
};
use stillbase_mechanics::machine::{Counterweight, Inertia};
use stillbase_query::answer_while;

/// Report on an assembly with counterweights.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct AssemblyWeightReport {
    /// Comparison of all blocks together with those without counterweights.
    #[serde(flatten)]
    pub measures: Measures,
    /// Largest |torque| of a motor in the motion, N m, where each motor turns its drive alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
    /// Upper bound on the difference between the objective's value and its minimum.
    pub gap: f64,
    /// Whether the gap is within rounding.
    pub certified: bool,
    /// Mass, kg, that would be added for the same objective if (7) and (8) alone had to hold, each block in its plane.
    pub added_mass_in_plane: f64,
    /// Whether (7) and (8) hold for every block with what it carries.
    pub is_balanced: bool,
    /// Whether no block reacts, in any of the six components.
    pub silent: bool,
    /// The blocks.
    pub blocks: Vec<BlockWeightReport>,
    /// Pareto front: added mass, kg, and Σ D_k, kg m².
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub front: Vec<[f64; 2]>,
    /// The assemblies of the Pareto front, with further measures.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub front_points: Vec<FrontPoint>,
}

/// Report on a block with counterweights.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct BlockWeightReport {
    /// Name of the block.
    pub block: String,
    /// Name of its machine.
    pub machine: String,
    /// What carries it.
    pub on: String,
    /// Comparison with the block without counterweights; Σ D_k is that with what it carries.
    #[serde(flatten)]
    pub measures: Measures,
    /// Mass that it carries at its end effector, kg.
    pub carried_mass: f64,
    /// New counterweights; fixed ones stay in addition.
    #[serde(serialize_with = "all_numbers")]
    #[schemars(with = "Vec<CounterweightNumbers>")]
    pub weights: Vec<Counterweight>,
    /// Counterweights of the given block that were removed first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub taken_off: Vec<Counterweight>,
    /// Rotors that were chosen.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rotors: Vec<ChosenRotor>,
    /// Whether (7) and (8) hold with what it carries.
    pub is_balanced: bool,
    /// Balance constants with what it carries.
    #[serde(flatten)]
    pub balance: BalanceConstants,
    /// Largest |C_0k|: coupling with what is carried off the end effector, kg m².
    pub ground_left: f64,
    /// Largest first moment of a drive weighted with heights, about the height of the centre of mass, kg m².
    pub tilt_left: f64,
    /// Whether it puts nothing on the base while it holds its b.
    pub silent: bool,
    /// Why it reacts, and what would be right.
    pub reasons: Vec<String>,
}

/// Request for the counterweights of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyWeightRequest {
    /// Sites on the links of all blocks, and the objective of the whole.
    pub spec: CounterweightSpec,
    /// Whether each block is balanced in its plane alone, (7) and (8), although it may tilt the base.
    pub in_plane: bool,
    /// Number of assemblies on the Pareto front from the least mass to the least inertia.
    pub front: Option<usize>,
}

/// Balances all blocks of an assembly together by counterweights, (7) and (8), and so that they do not tilt the base where
/// places and heights allow it. Reports on it.
///
/// # Errors
/// Fails if no counterweights balance the blocks, the request is invalid, or `goes_on` ends the work.
pub fn balance_assembly(
    assembly: &Assembly,
    request: &AssemblyWeightRequest,
    goes_on: &dyn Fn() -> bool,
) -> Result<(Assembly, AssemblyWeightReport), NoCounterweights> {
    let AssemblyWeightRequest { spec, in_plane, front } = request;
    let planar = vec![SpatialGoal::PLANAR; assembly.blocks().len()];
    let least_in_plane = place_in_assembly(assembly, spec, &planar).map_err(NoCounterweights::Weights)?;
    let goals = if *in_plane { planar.clone() } else { reachable_goals(assembly, spec) };
    if !goes_on() {
        return Err(NoCounterweights::Stopped);
    }
    let added_mass_in_plane = least_in_plane.added_mass;
    let placed = match goals == planar {
        true => least_in_plane,
        false => place_in_assembly(assembly, spec, &goals).map_err(NoCounterweights::Weights)?,
    };
    let front_points: Vec<FrontPoint> = match *front {
        Some(count) => {
            let input = (assembly.clone(), spec.clone(), goals, count);
            let front = answer_while::<AssemblyFrontSearch>(input, &mut |_| goes_on());
            let front = front.ok_or(NoCounterweights::Stopped)?.map_err(NoCounterweights::Front)?;
            let of = |placed: &PlacedCounterweights<Assembly>| FrontPoint {
                torque: torque(&placed.machine, spec),
                ..FrontPoint::from(placed)
            };
            front.points.iter().map(of).collect()
        }
        None => Vec::new(),
    };
    let bare = assembly.clone().with_machines(|_, machine| machine.without_counterweights())?;
    let (after, report) = (&placed.machine, AssemblyReport::of(&placed.machine));
    let totals = |whole: &Assembly| [whole.mass(), whole.total_momentum()];
    let blocks: Vec<BlockWeightReport> = report
        .blocks
        .into_iter()
        .enumerate()
        .map(|(i, own)| BlockWeightReport::of([assembly, &bare, after], spec, i, own))
        .collect();
    let report = AssemblyWeightReport {
        measures: Measures::between([totals(&bare), totals(after)]),
        torque: torque(after, spec),
        gap: placed.gap,
        certified: placed.is_certified(),
        added_mass_in_plane,
        is_balanced: blocks.iter().all(|block| block.is_balanced),
        silent: report.silent,
        blocks,
        front: front_points.iter().map(FrontPoint::measures).collect(),
        front_points,
    };
    Ok((placed.machine, report))
}

/// Returns the greatest |H_kk q̈_k|, N m, at the greatest accelerations of a request. Blocks that are balanced need no other
/// torque. `None` without accelerations, or where a motor turns more than its drive.
fn torque(whole: &Assembly, spec: &CounterweightSpec) -> Option<f64> {
    let inertias: Vec<Inertia> = (0..whole.blocks().len()).map(|i| whole.loaded(i).inertia).collect();
    let is_known = !spec.objective.accelerations.is_empty() && inertias.iter().all(Inertia::is_decoupled);
    let diagonal = inertias.iter().flat_map(|own| (0..own.drives()).map(|k| own.diagonal(k)));
    let each = diagonal.zip(&spec.objective.accelerations).map(|(h, acceleration)| h * acceleration);
    is_known.then(|| each.fold(0.0, f64::max))
}

impl BlockWeightReport {
    fn of([given, bare, after]: [&Assembly; 3], spec: &CounterweightSpec, i: usize, own: BlockReport) -> Self {
        let BlockReport { block, machine, on, carried_mass, ground_left, tilt_left, silent, reasons, .. } = own;
        let [was, is] = [bare, after].map(|whole| whole.loaded(i).inertia);
        let of = |whole: &Assembly, inertia: &Inertia| [whole.blocks()[i].inertia.mass(), inertia.total_momentum()];
        let new = &after.blocks()[i].machine;
        let first: usize = given.blocks()[..i].iter().map(|block| block.machine.drives()).sum();
        let drives = new.spec().drives.iter().enumerate();
        let chosen = drives.filter(|(k, _)| spec.rotors.iter().any(|rotor| rotor.drive == first + k));
        Self {
            block,
            machine,
            on,
            measures: Measures::between([of(bare, &was), of(after, &is)]),
            carried_mass,
            weights: removed_weights(new),
            taken_off: removed_weights(&given.blocks()[i].machine),
            rotors: chosen.map(|(_, drive)| ChosenRotor::of(drive)).collect(),
            is_balanced: is.is_balanced(),
            balance: BalanceConstants::of(&is),
            ground_left,
            tilt_left,
            silent,
            reasons,
        }
    }
}
