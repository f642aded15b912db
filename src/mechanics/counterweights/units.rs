//! [`Units`]: the units in which a problem is solved, taken from the machine itself, so that the same machine at another
//! size has the same problem.

use super::refusal::{BoundKind, RelaxedBounds};
use super::residual::BlockCondition;
use super::spec::{CounterweightSite, CounterweightSpec, FreeRotor, Objective, RotorFreedom};
use super::stock::{CounterweightForm, CounterweightStock};
use crate::assembly::Assembly;
use crate::balance::Condition;
use crate::machine::ResolvedLink;

/// Units of length and of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Units {
    /// Length of the longest link, m.
    pub length: f64,
    /// Mass of the heaviest link or payload, kg.
    pub mass: f64,
}

/// Returns the unit of the free ratio of a rotor: its greatest magnitude.
pub(super) fn ratio_unit(rotor: &FreeRotor) -> f64 {
    let RotorFreedom::Ratio([low, high]) = rotor.parameter else { return 1.0 };
    let greatest = low.abs().max(high.abs());
    if greatest > 0.0 { greatest } else { 1.0 }
}

impl Units {
    /// Returns the units of the machines of some blocks.
    pub fn of(whole: &Assembly) -> Self {
        let or_one = |x: f64| if x > 0.0 { x } else { 1.0 };
        let machines = || whole.blocks().iter().map(|block| &block.machine);
        let lengths = machines().flat_map(|machine| machine.resolved_links()).map(|link| link.length.abs());
        let length = lengths.fold(0.0, f64::max);
        let links = machines().flat_map(|machine| machine.links()).map(|link| link.mass);
        let mass = links.chain(machines().map(|machine| machine.spec().payload.mass)).fold(0.0, f64::max);
        Self { length: or_one(length), mass: or_one(mass) }
    }

    /// Returns the unit of moments of inertia, kg m².
    pub fn inertia(self) -> f64 {
        self.mass * self.length * self.length
    }

    /// Returns the unit of the residual of a condition, kg m or kg m².
    pub fn residual(self, condition: BlockCondition) -> f64 {
        match condition {
            BlockCondition::Balance(Condition::Force(_)) | BlockCondition::Ground(_) => self.mass * self.length,
            BlockCondition::Balance(Condition::Coupling(..)) | BlockCondition::Tilt(_) => self.inertia(),
        }
    }

    /// Returns the unit of a bound, kg, kg m² or m.
    pub fn bound(self, kind: BoundKind) -> f64 {
        match kind {
            BoundKind::Most | BoundKind::Mass => self.mass,
            BoundKind::Inertia => self.inertia(),
            BoundKind::Clearance | BoundKind::Across => self.length,
        }
    }

    /// Returns the unit of what is minimised of bounds.
    pub fn of_relaxed(self, relaxed: RelaxedBounds) -> f64 {
        match relaxed {
            RelaxedBounds::Value(kind) => self.bound(kind),
            RelaxedBounds::Factor => 1.0,
        }
    }

    /// Returns the unit of an objective: its greatest term for a machine of unit mass, length and inertia.
    pub fn objective(self, objective: &Objective) -> f64 {
        let Objective { mass, inertia, momentum, torque, accelerations } = objective;
        let fastest = accelerations.iter().copied().fold(0.0, f64::max);
        let terms =
            [mass * self.mass, inertia * self.inertia(), momentum * self.inertia(), torque * fastest * self.inertia()];
        let greatest = terms.into_iter().fold(0.0, f64::max);
        if greatest > 0.0 { greatest } else { 1.0 }
    }

    /// Returns a link in these units.
    pub fn link(self, link: &ResolvedLink) -> ResolvedLink {
        ResolvedLink {
            length: link.length / self.length,
            root: link.root.map(|part| part / self.length),
            at: link.at / self.length,
            pins: link.pins.iter().map(|pin| pin / self.length).collect(),
            ..link.clone()
        }
    }

    /// Returns a request in these units. The payload stays in kg: it only says how conditions are met.
    pub fn request(self, request: &CounterweightSpec) -> CounterweightSpec {
        let Self { length, mass } = self;
        let site = |site: &CounterweightSite| CounterweightSite {
            link: site.link,
            from: site.from / length,
            to: site.to / length,
            across: site.across / length,
            most: site.most / mass,
        };
        let rotor = |rotor: &FreeRotor| FreeRotor {
            parameter: match rotor.parameter {
                RotorFreedom::Inertia(ends) => RotorFreedom::Inertia(ends.map(|end| end / self.inertia())),
                RotorFreedom::Ratio(ends) => RotorFreedom::Ratio(ends.map(|end| end / ratio_unit(rotor))),
            },
            ..*rotor
        };
        let (unit, of) = (self.objective(&request.objective), &request.objective);
        let objective = Objective {
            mass: of.mass * mass / unit,
            inertia: of.inertia * self.inertia() / unit,
            momentum: of.momentum * self.inertia() / unit,
            torque: of.torque * self.inertia() / unit,
            accelerations: of.accelerations.clone(),
        };
        CounterweightSpec {
            sites: request.sites.iter().map(site).collect(),
            stock: self.stock(&request.stock),
            objective,
            max_added_mass: request.max_added_mass.map(|most| most / mass),
            max_inertia: request.max_inertia.map(|most| most / self.inertia()),
            clearance: request.clearance.map(|clearance| clearance / length),
            rotors: request.rotors.iter().map(rotor).collect(),
            payload: request.payload,
        }
    }

    fn stock(self, stock: &CounterweightStock) -> CounterweightStock {
        let of = |x: f64| x / self.length;
        CounterweightStock {
            density: stock.density * self.length.powi(3) / self.mass,
            thickness: of(stock.thickness),
            form: match stock.form {
                CounterweightForm::Disc => CounterweightForm::Disc,
                CounterweightForm::Ring(inner) => CounterweightForm::Ring(of(inner)),
                CounterweightForm::HalfRing(inner) => CounterweightForm::HalfRing(of(inner)),
                CounterweightForm::Box(width) => CounterweightForm::Box(of(width)),
            },
        }
    }
}
