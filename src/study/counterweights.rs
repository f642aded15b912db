//! [`balance_by_weights`]: balances a machine by counterweights, optionally with optimised link lengths, and reports on
//! it.

use schemars::JsonSchema;
use serde::{Serialize, Serializer};
use thiserror::Error;

use super::balance_constants::BalanceConstants;
use super::front_point::FrontPoint;
use super::lengths::{FoundLengths, LengthSearch, NoLengths, SearchProgress, search, stretched};
use super::measures::Measures;
use super::workshop::{BarsReport, CutRequest, NoCut};
use stillbase_mechanics::counterweights::{
    CounterweightError, CounterweightSpec, FreeRotor, PayloadResidual, PlacedCounterweights, front_while,
    over_payloads, place_weights,
};
use stillbase_mechanics::machine::{Counterweight, Drive, Inertia, Machine, MachineError, Rotor};
use stillbase_planning::Motion;

/// Number of payloads, across their range, at which the residual is reported.
const PAYLOAD_SAMPLES: usize = 11;

/// Request for counterweights.
#[derive(Clone, Debug, PartialEq)]
pub struct CounterweightRequest {
    /// Sites of the counterweights, and the objective. A search for lengths uses its own sites and objective instead.
    pub spec: CounterweightSpec,
    /// Link lengths to optimise together with the counterweights.
    pub lengths: Option<LengthSearch>,
    /// Number of machines on the Pareto front from the least mass to the least inertia.
    pub front: Option<usize>,
    /// Bars of which the links are cut. Neither lengths nor a front are found with these.
    pub bars: Option<CutRequest>,
}

/// Reason that there are no counterweights.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoCounterweights {
    /// The search for lengths failed.
    #[error(transparent)]
    Lengths(NoLengths),
    /// No counterweights balance the machine.
    #[error(transparent)]
    Weights(CounterweightError),
    /// There is no Pareto front.
    #[error(transparent)]
    Front(CounterweightError),
    /// No machine can be cut so that it is balanced.
    #[error(transparent)]
    Cut(NoCut),
    /// The result is no valid machine.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The caller has cancelled the work.
    #[error("stopped before its end")]
    Stopped,
}

/// Report on a machine with counterweights.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct CounterweightReport {
    /// Comparison with the machine without counterweights.
    #[serde(flatten)]
    pub measures: Measures,
    /// Largest |torque| of a motor in the motion, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
    /// New counterweights; fixed ones stay in addition.
    #[serde(serialize_with = "all_numbers")]
    #[schemars(with = "Vec<CounterweightNumbers>")]
    pub weights: Vec<Counterweight>,
    /// Counterweights of the given machine that were removed first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub taken_off: Vec<Counterweight>,
    /// Upper bound on the difference between the objective's value and its minimum. Of discs as they are bought nothing
    /// is certified: their value less that of the exact discs, which can be below 0.
    pub gap: f64,
    /// The gap as a share of the value; `None` of discs as they are bought.
    #[serde(skip)]
    pub relative_gap: Option<f64>,
    /// Whether the gap is within rounding.
    pub certified: bool,
    /// Pareto front: added mass, kg, and Σ D_k, kg m².
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub front: Vec<[f64; 2]>,
    /// The machines of the Pareto front, with further measures.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub front_points: Vec<FrontPoint>,
    /// Lengths that were optimised.
    #[serde(rename = "sought", skip_serializing_if = "Option::is_none")]
    pub optimised_lengths: Option<LengthsReport>,
    /// The bars as they are cut.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bars: Option<BarsReport>,
    /// Rotors that were chosen.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rotors: Vec<ChosenRotor>,
    /// Residuals of balance over the range of payloads.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub payload: Vec<PayloadResidual>,
    /// Whether (7) and (8) hold. With a range of payloads they need not hold: see [`payload`](Self::payload).
    pub is_balanced: bool,
    /// Balance constants of the new machine.
    #[serde(flatten)]
    pub balance: BalanceConstants,
}

/// The numbers of a counterweight.
#[derive(JsonSchema, Serialize)]
pub struct CounterweightNumbers<'a> {
    /// The link that carries it.
    pub link: &'a str,
    /// Mass, kg.
    pub mass: f64,
    /// Place along the link, m.
    pub at: f64,
    /// Place across the link, m.
    pub across: f64,
    /// Radius of a disc or a ring, m; 0 for a point.
    pub radius: f64,
    /// Inner radius of a ring, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inner_radius: Option<f64>,
    /// Whether it is half of a ring.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half: Option<bool>,
    /// Length of a box, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<f64>,
    /// Width of a box, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
}

/// Serialises counterweights with every number, also those that a machine file omits where they are 0.
///
/// # Errors
/// If the serializer fails.
pub fn all_numbers<S: Serializer>(weights: &[Counterweight], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(weights.iter().map(|weight| {
        let Counterweight { mass, at, across, radius, inner_radius, half, length, width, .. } = *weight;
        let some = |size: f64| (size > 0.0).then_some(size);
        CounterweightNumbers {
            link: &weight.link,
            mass,
            at,
            across,
            radius,
            inner_radius: some(inner_radius),
            half: half.then_some(true),
            length: some(length),
            width: some(width),
        }
    }))
}

/// Optimised lengths, and the reliability of the result.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct LengthsReport {
    /// Name and length, m.
    pub lengths: Vec<(String, f64)>,
    /// Always `false`: the search proves no minimum.
    pub certified: bool,
    /// Number of starting points.
    pub starts: usize,
    /// Number of starts that ended within a thousandth of the best.
    pub agreeing: usize,
    /// Number of machines evaluated.
    pub machines: usize,
    /// Reach of the arm, Σ |L_k|, m.
    pub reach: f64,
    /// Area of the reactionless workspace, m²; only for a machine with three drives and a b.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workspace: Option<f64>,
}

/// A rotor whose inertia or gear ratio was optimised; the other value is that of the machine.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct ChosenRotor {
    /// Name of the drive.
    pub drive: String,
    /// Rotor inertia, kg m².
    pub inertia: f64,
    /// Gear ratio; negative if the rotor counter-rotates.
    pub ratio: f64,
}

impl ChosenRotor {
    /// Returns the rotor of a drive.
    pub fn of(drive: &Drive) -> Self {
        let Rotor { inertia, ratio } = drive.rotor.unwrap_or_default();
        Self { drive: drive.name.clone(), inertia, ratio }
    }
}

/// Returns the counterweights of a machine that are removed before others are placed: all but the fixed ones.
pub fn removed_weights(machine: &Machine) -> Vec<Counterweight> {
    machine.spec().counterweights.iter().filter(|weight| !weight.fixed).cloned().collect()
}

/// Balances a machine by counterweights and reports on it, with torques if a motion is given. Calls `seek_on` after
/// every machine of a search for lengths; once it returns `false`, the best machine so far is the result. Once
/// `goes_on` returns `false`, there is none.
///
/// # Errors
/// Fails if no counterweights balance the machine, the request is invalid, or `goes_on` ends the work.
pub fn balance_by_weights(
    machine: &Machine,
    request: &CounterweightRequest,
    motion: Option<&Motion>,
    seek_on: &mut dyn FnMut(SearchProgress) -> bool,
    goes_on: &dyn Fn() -> bool,
) -> Result<(Machine, CounterweightReport), NoCounterweights> {
    let mut weighing = request.spec.clone();
    let (mut bars, mut on_bars, mut as_cut) = (None, None, None);
    let (placed, sought) = match &request.lengths {
        None if let Some(cut) = &request.bars => {
            let found = cut.balance(machine, &weighing).map_err(NoCounterweights::Cut)?;
            bars = Some(BarsReport::of(&found));
            on_bars = Some((found.on_bars(&weighing), found.bars.clone()));
            let placed = found.placed.clone();
            as_cut = Some((found, &cut.stock));
            (placed, None)
        }
        None => (place_weights(machine, &weighing).map_err(NoCounterweights::Weights)?, None),
        Some(lengths) => {
            let found = search(machine, lengths, &mut |progress| goes_on() && seek_on(progress));
            if !goes_on() {
                return Err(NoCounterweights::Stopped);
            }
            let found = found.map_err(NoCounterweights::Lengths)?;
            if lengths.anywhere {
                weighing.sites = stretched(&weighing.sites, machine, &found.placed.machine);
            }
            let sought = LengthsReport::of(lengths, &found);
            (found.placed, Some(sought))
        }
    };
    // If lengths were optimised, the front is that of the machine with these lengths, and on bars that of these bars.
    let (spec, base) = match &on_bars {
        Some((spec, bars)) => (spec, bars),
        None => (&weighing, if sought.is_some() { &placed.machine } else { machine }),
    };
    let front = match request.front {
        Some(count) => {
            let front = front_while(base, spec, count, &mut |_| goes_on()).ok_or(NoCounterweights::Stopped)?;
            front.map_err(NoCounterweights::Front)?.points
        }
        None => Vec::new(),
    };
    let built = |placed: PlacedCounterweights| match &as_cut {
        Some((found, stock)) => found.as_built(placed, spec, stock),
        None => Ok(placed),
    };
    let measured = |placed| match goes_on() {
        true => Ok(FrontPoint::of(&built(placed)?, motion, true)),
        false => Err(NoCounterweights::Stopped),
    };
    let front = front.into_iter().map(measured).collect::<Result<Vec<_>, _>>()?;
    let mut report = CounterweightReport::of(&placed, front, motion, &weighing)?;
    (report.optimised_lengths, report.bars) = (sought, bars);
    if let Some(exact) = report.bars.as_ref().and_then(|bars| bars.exact_value) {
        (report.gap, report.relative_gap) = (placed.value - exact, None);
    }
    report.taken_off = removed_weights(machine);
    Ok((placed.machine, report))
}

impl LengthsReport {
    fn of(request: &LengthSearch, found: &FoundLengths) -> Self {
        let names = request.lengths.iter().map(|free| free.name.clone());
        let [starts, agreeing] = found.starts;
        Self {
            lengths: names.zip(found.lengths.iter().copied()).collect(),
            certified: false,
            starts,
            agreeing,
            machines: found.machines,
            reach: found.placed.machine.reach(),
            workspace: FrontPoint::of(&found.placed, None, true).workspace,
        }
    }
}

impl CounterweightReport {
    fn of(
        placed: &PlacedCounterweights,
        front_points: Vec<FrontPoint>,
        motion: Option<&Motion>,
        request: &CounterweightSpec,
    ) -> Result<Self, MachineError> {
        // The bare machine includes the present payload, so that it does not count as added mass.
        let bare = placed.machine.without_counterweights()?;
        let (machine, inertia) = (&placed.machine, Inertia::of(&placed.machine));
        let chosen = |rotor: &FreeRotor| ChosenRotor::of(&machine.spec().drives[rotor.drive]);
        let payload = request.payload.map(|ends| over_payloads(machine, ends, PAYLOAD_SAMPLES)).transpose()?;
        Ok(Self {
            measures: Measures::of(&bare, machine, motion),
            torque: motion.and_then(|motion| FrontPoint::of(placed, Some(motion), false).torque),
            weights: removed_weights(machine),
            taken_off: Vec::new(),
            gap: placed.gap,
            relative_gap: Some(placed.relative_gap()).filter(|gap| gap.is_finite()),
            certified: placed.is_certified(),
            front: front_points.iter().map(FrontPoint::measures).collect(),
            front_points,
            optimised_lengths: None,
            bars: None,
            rotors: request.rotors.iter().map(chosen).collect(),
            payload: payload.unwrap_or_default(),
            is_balanced: inertia.is_balanced(),
            balance: BalanceConstants::of(&inertia),
        })
    }
}
