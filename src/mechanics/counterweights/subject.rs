//! [`Subject`]: what counterweights balance: a machine by itself, or all blocks of an assembly together.

use super::spec::CounterweightSpec;
use crate::assembly::Assembly;
use crate::planar::Vector;

/// Conditions of a block beside (7) and (8), which counterweights meet only where places and heights allow it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpatialGoal {
    /// Whether what it carries is to have its centre of mass on the axis of its end effector: C_0k = 0.
    pub ground: bool,
    /// Whether it is not to tilt the base: Σ m h a_k = 0 for each drive.
    pub tilt: bool,
}

impl SpatialGoal {
    /// Both conditions.
    pub const SILENT: Self = Self { ground: true, tilt: true };
    /// Neither.
    pub const PLANAR: Self = Self { ground: false, tilt: false };
}

/// What counterweights balance.
#[derive(Clone, Copy)]
pub(super) struct Subject<'a> {
    /// The blocks; of a machine by itself, one.
    pub whole: &'a Assembly,
    /// Further conditions of each block; `None` for a machine by itself, whose links have plain names.
    pub goals: Option<&'a [SpatialGoal]>,
    /// Known additional residuals of (7), then of (8), of a machine by itself, kg m or kg m².
    pub beyond: &'a [Vector],
}

impl<'a> Subject<'a> {
    /// A machine by itself, made an assembly of one block.
    pub const fn machine(whole: &'a Assembly, beyond: &'a [Vector]) -> Self {
        Self { whole, goals: None, beyond }
    }

    /// The blocks of an assembly, with the further conditions of each.
    pub const fn assembly(whole: &'a Assembly, goals: &'a [SpatialGoal]) -> Self {
        Self { whole, goals: Some(goals), beyond: &[] }
    }

    /// Returns the further conditions of a block.
    pub fn goal(&self, block: usize) -> SpatialGoal {
        self.goals.and_then(|goals| goals.get(block)).copied().unwrap_or(SpatialGoal::PLANAR)
    }

    /// Returns the name of a drive or a link of a block: with the name of the block before it, as settings have it.
    pub fn name(&self, block: usize, own: &str) -> String {
        match self.goals {
            Some(_) => format!("{}.{own}", self.whole.blocks()[block].name),
            None => own.to_owned(),
        }
    }

    /// Returns the name of a link that is counted through all blocks.
    pub fn link_name(&self, number: usize) -> String {
        let Some((block, link)) = self.whole.link_at(number) else { return number.to_string() };
        self.name(block, &self.whole.blocks()[block].machine.links()[link].name)
    }

    /// Returns the name of a drive that is counted through all blocks; empty if there is no such drive.
    pub fn drive_name(&self, number: usize) -> String {
        let blocks = self.whole.blocks().iter().enumerate();
        let mut all = blocks.flat_map(|(i, own)| own.machine.spec().drives.iter().map(move |drive| (i, &drive.name)));
        all.nth(number).map_or_else(String::new, |(block, own)| self.name(block, own))
    }

    /// Returns the mass of the counterweight, kg, that each site of a request has in another state of the same subject.
    pub fn masses(&self, spec: &CounterweightSpec, placed: &Assembly) -> Vec<f64> {
        let mass = |(block, link): (usize, usize)| {
            let machine = &placed.blocks()[block].machine;
            let own = machine.spec().counterweights.iter();
            own.filter(|weight| !weight.fixed && weight.link == machine.links()[link].name)
                .map(|weight| weight.mass)
                .sum()
        };
        spec.sites.iter().map(|site| self.whole.link_at(site.link).map_or(0.0, mass)).collect()
    }
}
