//! [`CounterweightProblem`]: a machine without counterweights, except fixed ones, and the conditions that
//! counterweights must satisfy.

use super::refusal::CounterweightError;
use super::residual::{ConditionResidual, conditions};
use super::spec::CounterweightSpec;
use super::units::{Units, ratio_unit};
use crate::balance::{LinearEquation, SolutionSpace};
use crate::machine::{Inertia, Machine, ResolvedLink, Rotor};
use crate::planar::Vector;

/// A machine without counterweights, except fixed ones, and without the rotors that have a free parameter.
pub(super) struct CounterweightProblem {
    pub bare: Machine,
    pub inertia: Inertia,
    /// The rotors of all drives, also those with a free parameter.
    pub rotors: Vec<Rotor>,
    /// Units of the free ratios of rotors.
    pub ratio_units: Vec<f64>,
    /// Units of all that follows, and of the requests that are solved.
    pub units: Units,
    pub conditions: Vec<ConditionResidual>,
    pub parts: Vec<ResolvedLink>,
    /// Upper bound of the end effector's distance from the base point B.
    pub reach: f64,
}

impl CounterweightProblem {
    /// Derives the problem of a request. `beyond` lists known additional residuals of (7), then of (8).
    ///
    /// # Errors
    /// If the request is not valid.
    pub fn new(machine: &Machine, request: &CounterweightSpec, beyond: &[Vector]) -> Result<Self, CounterweightError> {
        request.check(machine)?;
        let mut spec = machine.without_counterweights()?.spec().clone();
        request.rotors.iter().for_each(|rotor| spec.drives[rotor.drive].rotor = None);
        if let Some([low, high]) = request.payload {
            spec.payload.mass = 0.5 * (low + high);
        }
        let bare = Machine::new(spec)?;
        let inertia = Inertia::of(&bare);
        let of_rotors = request.rotors.iter().any(|rotor| bare.motors().on(rotor.drive).is_some());
        if request.objective.torque > 0.0 && (!inertia.is_decoupled() || of_rotors) {
            return Err(CounterweightError::Coupled);
        }
        let rotors = machine.spec().drives.iter().map(|drive| drive.rotor.unwrap_or_default()).collect();
        let ratio_units = request.rotors.iter().map(ratio_unit).collect();
        let units = Units::of(&bare);
        let parts = bare.resolved_links().iter().map(|link| units.link(link)).collect::<Vec<_>>();
        let conditions = conditions(&bare, &inertia, units, &parts, request, beyond)?;
        let reach = bare.reach() / units.length;
        Ok(Self { bare, inertia, rotors, ratio_units, units, conditions, parts, reach })
    }

    /// Checks that counterweights at the sites can change every condition that is not satisfied.
    ///
    /// # Errors
    /// If they cannot change one of these conditions.
    pub fn check(&self) -> Result<(), CounterweightError> {
        let one_of = |changes: &dyn Fn(&ResolvedLink) -> bool| {
            let parts = self.bare.links().iter().zip(self.bare.resolved_links());
            let would: Vec<&str> =
                parts.filter(|(_, part)| changes(part)).map(|(link, _)| link.name.as_str()).collect();
            format!("one of {}", would.join(", "))
        };
        for one in &self.conditions {
            let (condition, unit) = (one.condition.name(&self.bare), self.units.residual(one.condition));
            let (residual, most) = (one.residual * unit, one.condition.tolerance(&self.inertia));
            let stays = |residual: f64| format!("{residual:.3e} {}", one.condition.unit());
            if !one.is_touched_across() && residual.im.abs() > most {
                let want = one_of(&|part| one.condition.by_cross_moment(part) != 0.0);
                return Err(CounterweightError::OffAxis {
                    condition,
                    residual: stays(residual.im),
                    want,
                    reliefs: Vec::new(),
                });
            }
            if !one.is_touched() && residual.re.abs() > most {
                let want = one_of(&|part| one.condition.by_mass(part) != 0.0 || one.condition.by_moment(part) != 0.0);
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
        let total: f64 = self.inertia.total_momentum();
        request.rotors.is_empty()
            && request.objective.momentum == 0.0
            && self.conditions.iter().all(|of| {
                self.units.residual(of.condition) * of.residual.norm() <= of.condition.tolerance(&self.inertia)
            })
            && request.max_inertia.is_none_or(|most| total <= most)
    }

    /// Returns H_kk without counterweights and free rotors, in the unit of inertia.
    pub fn diagonal(&self, k: usize) -> f64 {
        self.inertia.diagonal(k) / self.units.inertia()
    }

    /// Returns D_k − H_kk without counterweights and free rotors, in the unit of inertia.
    pub fn constant(&self, k: usize) -> f64 {
        (self.inertia.momentum(k) - self.inertia.diagonal(k)) / self.units.inertia()
    }

    /// Returns the inertia of the rotor of a drive, in the unit of inertia.
    pub fn rotor_inertia(&self, drive: usize) -> f64 {
        self.rotors[drive].inertia / self.units.inertia()
    }

    pub fn drives(&self) -> usize {
        self.bare.drives()
    }
}
