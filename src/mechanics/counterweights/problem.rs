//! [`CounterweightProblem`]: blocks without counterweights, except fixed ones, and the conditions that counterweights must
//! satisfy. A machine by itself is one block.

use super::link_part::LinkPart;
use super::refusal::CounterweightError;
use super::residual::{ConditionResidual, conditions};
use super::spec::CounterweightSpec;
use super::subject::Subject;
use super::units::{Units, ratio_unit};
use crate::assembly::Assembly;
use crate::balance::{LinearEquation, SolutionSpace};
use crate::machine::{Inertia, Machine, Rotor};
use crate::planar::Vector;

/// Blocks without counterweights, except fixed ones, and without the rotors that have a free parameter.
pub(super) struct CounterweightProblem {
    pub bare: Assembly,
    /// Constants of each block with what it carries.
    pub inertias: Vec<Inertia>,
    /// Block of each drive, and its number there. Drives are counted through all blocks.
    drives: Vec<(usize, usize)>,
    /// The rotors of all drives, also those with a free parameter.
    pub rotors: Vec<Rotor>,
    /// Units of the free ratios of rotors.
    pub ratio_units: Vec<f64>,
    /// Units of all that follows, and of the requests that are solved.
    pub units: Units,
    pub conditions: Vec<ConditionResidual>,
    /// The links of all blocks.
    pub parts: Vec<LinkPart>,
    /// Their names.
    pub names: Vec<String>,
    /// Upper bound of an end effector's distance from its base point B.
    pub reach: f64,
}

impl CounterweightProblem {
    /// Derives the problem of a request.
    ///
    /// # Errors
    /// If the request is not valid.
    pub fn new(subject: &Subject, request: &CounterweightSpec) -> Result<Self, CounterweightError> {
        request.check(subject)?;
        let blocks = subject.whole.blocks();
        let drives: Vec<(usize, usize)> = (0..blocks.len())
            .flat_map(|block| (0..blocks[block].machine.drives()).map(move |drive| (block, drive)))
            .collect();
        let bare = subject.whole.clone().with_machines(|name, machine| -> Result<Machine, CounterweightError> {
            let mut spec = machine.without_counterweights()?.spec().clone();
            for (block, drive) in request.rotors.iter().map(|rotor| drives[rotor.drive]) {
                if blocks[block].name == name {
                    spec.drives[drive].rotor = None;
                }
            }
            if let Some([low, high]) = request.payload {
                spec.payload.mass = 0.5 * (low + high);
            }
            Ok(Machine::new(spec)?)
        })?;
        let inertias: Vec<Inertia> = (0..blocks.len()).map(|block| bare.loaded(block).inertia).collect();
        let in_joint = |(block, drive): (usize, usize)| blocks[block].machine.motors().on(drive).is_some();
        let of_rotors = request.rotors.iter().any(|rotor| in_joint(drives[rotor.drive]));
        if request.objective.torque > 0.0 && (inertias.iter().any(|inertia| !inertia.is_decoupled()) || of_rotors) {
            return Err(CounterweightError::Coupled);
        }
        let rotors = blocks.iter().flat_map(|block| &block.machine.spec().drives);
        let rotors = rotors.map(|drive| drive.rotor.unwrap_or_default()).collect();
        let ratio_units = request.rotors.iter().map(ratio_unit).collect();
        let units = Units::of(&bare);
        let parts = LinkPart::all(&bare, units);
        let names = (0..parts.len()).map(|link| subject.link_name(link)).collect();
        let conditions = conditions(subject, &bare, units, &parts, request)?;
        let reach = bare.blocks().iter().map(|block| block.machine.reach()).fold(0.0, f64::max) / units.length;
        Ok(Self { bare, inertias, drives, rotors, ratio_units, units, conditions, parts, names, reach })
    }

    /// Checks that counterweights at the sites can change every condition that is not satisfied.
    ///
    /// # Errors
    /// If they cannot change one of these conditions.
    pub fn check(&self, subject: &Subject) -> Result<(), CounterweightError> {
        let one_of = |changes: &dyn Fn(&LinkPart) -> bool| {
            let would = self.parts.iter().zip(&self.names).filter(|(part, _)| changes(part));
            format!("one of {}", would.map(|(_, name)| name.as_str()).collect::<Vec<_>>().join(", "))
        };
        for one in &self.conditions {
            let (condition, unit) = (one.condition.name(subject, one.block), self.units.residual(one.condition));
            let (residual, most) = (one.residual * unit, one.condition.tolerance(&self.inertias[one.block]));
            let stays = |residual: f64| format!("{residual:.3e} {}", one.condition.unit());
            let changes = |part: &LinkPart| one.condition.changes(one.block, part);
            if !one.is_touched_across() && residual.im.abs() > most {
                let want = one_of(&|part| changes(part)[2] != 0.0);
                return Err(CounterweightError::OffAxis {
                    condition,
                    residual: stays(residual.im),
                    want,
                    reliefs: Vec::new(),
                });
            }
            if !one.is_touched() && residual.re.abs() > most {
                let want = one_of(&|part| changes(part)[..2].iter().any(|by| *by != 0.0));
                return Err(CounterweightError::Untouched { condition, residual: stays(residual.re), want });
            }
        }
        Ok(())
    }

    /// Returns the part of each residual, kg m or kg m², that no masses at the sites remove, even negative ones. This
    /// is the residual of the least squares solution, with all equations scaled to unit norm.
    pub fn unreachable(&self, sites: usize) -> Vec<Vector> {
        let along = |condition: &ConditionResidual| LinearEquation {
            a: condition.changes.iter().flat_map(|[by_w, by_s, _]| [*by_w, *by_s]).collect(),
            right: -condition.residual.re,
            tolerance: f64::INFINITY,
        };
        let across = |condition: &ConditionResidual| LinearEquation {
            a: condition.changes.iter().map(|[_, _, by_t]| *by_t).collect(),
            right: -condition.residual.im,
            tolerance: f64::INFINITY,
        };
        let along = SolutionSpace::of(&self.conditions.iter().map(along).collect::<Vec<_>>(), 2 * sites).residuals;
        let across = SolutionSpace::of(&self.conditions.iter().map(across).collect::<Vec<_>>(), sites).residuals;
        let each = self.conditions.iter().zip(along.iter().zip(&across));
        let physical = |(of, (along, across)): (&ConditionResidual, (&f64, &f64))| {
            self.units.residual(of.condition) * Vector::new(*along, *across)
        };
        each.map(physical).collect()
    }

    /// Returns whether no counterweights are needed. Counterweights only add mass and inertia, so the optimum then has
    /// none.
    pub fn needs_nothing(&self, request: &CounterweightSpec) -> bool {
        let total: f64 = self.inertias.iter().map(Inertia::total_momentum).sum();
        request.rotors.is_empty()
            && request.objective.momentum == 0.0
            && self.conditions.iter().all(|of| {
                let most = of.condition.tolerance(&self.inertias[of.block]);
                self.units.residual(of.condition) * of.residual.norm() <= most
            })
            && request.max_inertia.is_none_or(|most| total <= most)
    }

    /// Returns the constants of the block of a drive, and the number of the drive there.
    fn of_drive(&self, k: usize) -> (&Inertia, usize) {
        let (block, own) = self.drives[k];
        (&self.inertias[block], own)
    }

    /// Returns H_kk without counterweights and free rotors, in the unit of inertia.
    pub fn diagonal(&self, k: usize) -> f64 {
        let (inertia, own) = self.of_drive(k);
        inertia.diagonal(own) / self.units.inertia()
    }

    /// Returns D_k − H_kk without counterweights and free rotors, in the unit of inertia.
    pub fn constant(&self, k: usize) -> f64 {
        let (inertia, own) = self.of_drive(k);
        (inertia.momentum(own) - inertia.diagonal(own)) / self.units.inertia()
    }

    /// Returns the drive on whose links the stator of a motor sits; `None` for the base.
    pub fn stator(&self, drive: usize) -> Option<usize> {
        let (inertia, own) = self.of_drive(drive);
        inertia.motors().on(own).map(|on| drive - own + on)
    }

    /// Returns the block of a drive, and its number there.
    pub fn drive_at(&self, drive: usize) -> (usize, usize) {
        self.drives[drive]
    }

    /// Returns the inertia of the rotor of a drive, in the unit of inertia.
    pub fn rotor_inertia(&self, drive: usize) -> f64 {
        self.rotors[drive].inertia / self.units.inertia()
    }

    /// Number of drives of all blocks.
    pub fn drives(&self) -> usize {
        self.drives.len()
    }
}
