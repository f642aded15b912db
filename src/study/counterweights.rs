//! [`balanced`]: a machine balanced by counterweights, with other lengths if these are sought, and what that comes to.

use serde::Serialize;
use thiserror::Error;

use super::balance_constants::BalanceConstants;
use super::front_point::FrontPoint;
use super::lengths::{Found, LengthSearch, NoLengths, Progress, search};
use super::measures::Measures;
use crate::mechanics::counterweights::{
    FreeRotor, NoWeights, Placed, Residual, Sites, Weighing, front, over_payloads, place,
};
use crate::mechanics::machine::{Counterweight, Inertia, Machine, MachineError};
use crate::planning::Motion;

/// Payloads at which the residual is given.
const PAYLOADS: usize = 11;

/// What counterweights are asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct CounterweightRequest {
    /// Where they may be, and what is to be least; of a search for lengths its own counts.
    pub weighing: Weighing,
    /// Lengths that are sought with them.
    pub lengths: Option<LengthSearch>,
    /// In how many machines the front from the least mass to the least inertia is shown.
    pub front: Option<usize>,
}

/// Why there are none.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoCounterweights {
    /// No lengths are found.
    #[error(transparent)]
    Lengths(NoLengths),
    /// No counterweights balance the machine.
    #[error(transparent)]
    Weights(NoWeights),
    /// There is no front.
    #[error(transparent)]
    Front(NoWeights),
    /// What comes out is no machine.
    #[error(transparent)]
    Machine(#[from] MachineError),
}

/// What counterweights come to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CounterweightReport {
    /// Beside the machine without counterweights.
    #[serde(flatten)]
    pub measures: Measures,
    /// The greatest |torque| of a motor in a motion, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
    /// Those that were found; those that are fixed stay beside them.
    pub weights: Vec<Counterweight>,
    /// Those that the machine had and that were taken off.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub taken_off: Vec<Counterweight>,
    /// The most by which the best may lie below what was found.
    pub gap: f64,
    /// Whether that is no more than rounding.
    pub certified: bool,
    /// Added mass, kg, and Σ D_k, kg m².
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub front: Vec<[f64; 2]>,
    /// The same machines, and what else they come to.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub front_points: Vec<FrontPoint>,
    /// Lengths that were sought.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sought: Option<SoughtLengths>,
    /// Rotors that were chosen.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub rotors: Vec<ChosenRotor>,
    /// What is left of balance over the payloads.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub payload: Vec<Residual>,
    /// Whether (7) and (8) hold: over a range of payloads they may not within bounds.
    pub is_balanced: bool,
    /// Those constants.
    #[serde(flatten)]
    pub balance: BalanceConstants,
}

/// Lengths, and how sure they are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SoughtLengths {
    /// Name and length, m.
    pub lengths: Vec<(String, f64)>,
    /// A search proves nothing.
    pub certified: bool,
    /// From how many places it started.
    pub starts: usize,
    /// Starts that ended within a thousandth of the best.
    pub agreeing: usize,
    /// Machines that were looked at.
    pub machines: usize,
    /// How far the arms reach together, m.
    pub reach: f64,
    /// The reactionless workspace, m², of a machine that has one b of three drives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workspace: Option<f64>,
}

/// A rotor that was chosen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChosenRotor {
    /// Name of its drive.
    pub drive: String,
    /// kg m².
    pub inertia: f64,
    /// Below 0 it counter-rotates.
    pub ratio: f64,
}

/// The counterweights of a machine that are taken off before others are sought: all but those that are fixed.
pub fn taken_off(machine: &Machine) -> Vec<Counterweight> {
    machine.spec().counterweights.iter().filter(|weight| !weight.fixed).cloned().collect()
}

/// A machine balanced by the counterweights that are asked for, and what they come to, in a motion if one is given.
/// `go_on` is asked after every machine of a search for lengths; the best so far is the answer where it says no.
///
/// # Errors
/// If there are none, or what is asked for cannot be.
pub fn balanced(
    machine: &Machine,
    asked: &CounterweightRequest,
    motion: Option<&Motion>,
    go_on: &mut dyn FnMut(Progress) -> bool,
) -> Result<(Machine, CounterweightReport), NoCounterweights> {
    let mut weighing = asked.weighing.clone();
    let (placed, sought) = match &asked.lengths {
        None => (place(machine, &weighing).map_err(NoCounterweights::Weights)?, None),
        Some(lengths) => {
            let found = search(machine, lengths, go_on).map_err(NoCounterweights::Lengths)?;
            if lengths.anywhere {
                weighing.sites = Sites::anywhere(&found.placed.machine);
            }
            let sought = SoughtLengths::of(lengths, &found);
            (found.placed, Some(sought))
        }
    };
    // With other lengths the links are others, too.
    let base = if sought.is_some() { &placed.machine } else { machine };
    let front = match asked.front {
        Some(count) => front(base, &weighing, count).map_err(NoCounterweights::Front)?.points,
        None => Vec::new(),
    };
    let front = front.iter().map(|placed| FrontPoint::of(placed, motion, true)).collect();
    let mut report = CounterweightReport::of(&placed, front, motion, &weighing)?;
    report.sought = sought;
    report.taken_off = taken_off(machine);
    Ok((placed.machine, report))
}

impl SoughtLengths {
    fn of(asked: &LengthSearch, found: &Found) -> Self {
        let names = asked.lengths.iter().map(|free| free.name.clone());
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
        placed: &Placed,
        front_points: Vec<FrontPoint>,
        motion: Option<&Motion>,
        asked: &Weighing,
    ) -> Result<Self, MachineError> {
        // With what it holds now, which is no part of what was added.
        let bare = placed.machine.without_counterweights()?;
        let (machine, inertia) = (&placed.machine, Inertia::of(&placed.machine));
        let chosen = |rotor: &FreeRotor| {
            let drive = &machine.spec().drives[rotor.drive];
            let found = drive.rotor.unwrap_or_default();
            ChosenRotor { drive: drive.name.clone(), inertia: found.inertia, ratio: found.ratio }
        };
        let payload = asked.payload.map(|ends| over_payloads(machine, ends, PAYLOADS)).transpose()?;
        Ok(Self {
            measures: Measures::of(&bare, machine, motion),
            torque: motion.and_then(|motion| FrontPoint::of(placed, Some(motion), false).torque),
            weights: taken_off(machine),
            taken_off: Vec::new(),
            gap: placed.gap,
            certified: placed.is_certified(),
            front: front_points.iter().map(FrontPoint::measures).collect(),
            front_points,
            sought: None,
            rotors: asked.rotors.iter().map(chosen).collect(),
            payload: payload.unwrap_or_default(),
            is_balanced: inertia.is_balanced(),
            balance: BalanceConstants::of(&inertia),
        })
    }
}
