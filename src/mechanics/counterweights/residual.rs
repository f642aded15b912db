//! [`ConditionResidual`]: residual of each condition of balance, and its change with counterweights.
//!
//! All that a block carries counts as a mass at its end effector, so a counterweight enters the conditions of every
//! block that carries its own by its mass alone, and linearly.

use super::link_part::LinkPart;
use super::refusal::CounterweightError;
use super::spec::{CounterweightSite, CounterweightSpec};
use super::subject::Subject;
use super::units::Units;
use crate::assembly::{Assembly, LoadedBlock};
use crate::balance::Condition;
use crate::machine::{Inertia, Machine};
use crate::planar::Vector;

/// A condition of one block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum BlockCondition {
    /// (7) or (8), with what the block carries at its end effector.
    Balance(Condition),
    /// C_0k = 0: the first moment of what it carries, from its end effector along x (0) or y (1) of its plane, vanishes.
    Ground(usize),
    /// The first moment of a drive weighted with heights vanishes. With (7) it does not matter from where heights count.
    Tilt(usize),
}

impl BlockCondition {
    /// Returns its name in words, with the names of the drives of its block.
    pub fn name(self, subject: &Subject, block: usize) -> String {
        let machine = &subject.whole.blocks()[block].machine;
        let words = match self {
            Self::Balance(condition) => condition.name(machine),
            Self::Ground(_) => "the centre of mass of what it carries, C_0k".to_owned(),
            Self::Tilt(k) => format!("the heights on drive {}", machine.spec().drives[k].name),
        };
        match subject.goals {
            Some(_) => format!("block {}: {words}", subject.whole.blocks()[block].name),
            None => words,
        }
    }

    /// Returns the unit of its residual.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Balance(condition) => condition.unit(),
            Self::Ground(_) => "kg m",
            Self::Tilt(_) => "kg m²",
        }
    }

    /// Returns whether it is one of (7).
    pub const fn is_force(self) -> bool {
        matches!(self, Self::Balance(Condition::Force(_)))
    }

    /// Returns the tolerance, kg m or kg m²: a residual up to this is treated as zero.
    pub fn tolerance(self, inertia: &Inertia) -> f64 {
        match self {
            Self::Balance(condition) => condition.tolerance(inertia),
            Self::Ground(_) => inertia.coupling_tolerance() / reach(inertia).max(f64::MIN_POSITIVE),
            Self::Tilt(_) => inertia.coupling_tolerance(),
        }
    }

    /// Returns the residual of a block with what it carries, kg m or kg m².
    fn residual(self, of: &LoadedBlock) -> Vector {
        match self {
            Self::Balance(condition) => condition.residual(&of.inertia),
            Self::Ground(0) => Vector::new(of.beside.re, 0.0),
            Self::Ground(_) => Vector::new(of.beside.im, 0.0),
            Self::Tilt(k) => of.weighted[k],
        }
    }

    /// Returns the derivatives of the condition of a block with respect to a counterweight on a link: of its real part
    /// by the mass w and by s = w x, and of its imaginary part by t = w y. All numbers are in the units of the problem.
    pub fn changes(self, block: usize, part: &LinkPart) -> [f64; 3] {
        let of = |condition: Condition| {
            let own = &part.own;
            [condition.by_mass(own), condition.by_moment(own), condition.by_cross_moment(own)]
        };
        if part.block == block {
            return match self {
                Self::Balance(condition) => of(condition),
                Self::Ground(_) => [0.0; 3],
                Self::Tilt(k) => of(Condition::Force(k)).map(|by| part.height * by),
            };
        }
        let Some(carrier) = part.carriers.iter().find(|carrier| carrier.block == block) else { return [0.0; 3] };
        let end = carrier.end.map(|x| Vector::new(x, 0.0));
        let by_mass = match self {
            Self::Balance(condition) => condition.of(1.0, &end).re,
            Self::Ground(axis) => carrier.beside[axis],
            Self::Tilt(k) => carrier.height * carrier.end[k],
        };
        [by_mass, 0.0, 0.0]
    }
}

/// Returns the greatest coefficient of the end effector, m.
fn reach(inertia: &Inertia) -> f64 {
    inertia.end_effector[..inertia.drives].iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// The residual of one condition.
pub(super) struct ConditionResidual {
    pub block: usize,
    pub condition: BlockCondition,
    /// Residual of the bare blocks with the mean payload: the real part along the axes, the imaginary part across
    /// them. All numbers are in the units of the problem.
    pub residual: Vector,
    /// Residual with the smallest and with the largest payload.
    pub ends: [Vector; 2],
    /// Derivatives with respect to each site's counterweight: of the real part by its mass w and by s = w x;
    /// of the imaginary part by t = w y, which are 0 where the counterweight must lie on the axis.
    pub changes: Vec<[f64; 3]>,
}

impl ConditionResidual {
    /// Returns whether a counterweight at any site changes the real part.
    pub fn is_touched(&self) -> bool {
        self.changes.iter().any(|[by_w, by_s, _]| *by_w != 0.0 || *by_s != 0.0)
    }

    /// Returns whether a counterweight at any site changes the imaginary part.
    pub fn is_touched_across(&self) -> bool {
        self.changes.iter().any(|[_, _, by_t]| *by_t != 0.0)
    }
}

/// Returns the residual of each condition of the bare blocks, and its derivatives by w, s and t at each site, in the units
/// of the problem: (7), (8), then the further goals of each block.
pub(super) fn conditions(
    subject: &Subject,
    bare: &Assembly,
    units: Units,
    parts: &[LinkPart],
    request: &CounterweightSpec,
) -> Result<Vec<ConditionResidual>, CounterweightError> {
    let mut all = Vec::new();
    for (block, own) in bare.blocks().iter().enumerate() {
        let loaded = bare.loaded(block);
        let holding = |mass: f64| -> Result<LoadedBlock, CounterweightError> {
            let mut spec = own.machine.spec().clone();
            spec.payload.mass = mass;
            Ok(Assembly::from(Machine::new(spec)?).loaded(0))
        };
        let ends = match request.payload {
            Some([low, high]) => [holding(low)?, holding(high)?],
            None => [loaded.clone(), loaded.clone()],
        };
        let (n, goal) = (own.machine.drives(), subject.goal(block));
        let reaches = goal.ground && reach(&loaded.inertia) > 0.0;
        let ground = (0..if reaches { 2 } else { 0 }).map(BlockCondition::Ground);
        let tilt = (0..if goal.tilt { n } else { 0 }).map(BlockCondition::Tilt);
        let own = Condition::all_of(&own.machine).map(BlockCondition::Balance).chain(ground).chain(tilt);
        all.extend(own.enumerate().map(|(i, condition)| {
            let change = |site: &CounterweightSite| {
                let [by_w, by_s, by_t] = condition.changes(block, &parts[site.link]);
                [by_w, by_s, if site.across > 0.0 { by_t } else { 0.0 }]
            };
            let (more, unit) = (subject.beyond.get(i).copied().unwrap_or_default(), units.residual(condition));
            ConditionResidual {
                block,
                condition,
                residual: (condition.residual(&loaded) + more) / unit,
                ends: [0, 1].map(|i| (condition.residual(&ends[i]) + more) / unit),
                changes: request.sites.iter().map(change).collect(),
            }
        }));
    }
    Ok(all)
}
