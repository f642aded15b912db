//! [`FrontPoint`]: measures of one machine of a Pareto front, beyond its mass and inertia.

use schemars::JsonSchema;
use serde::Serialize;

use stillbase_mechanics::assembly::Assembly;
use stillbase_mechanics::counterweights::{
    PlacedCounterweights, PlacementTolerance, worst_residual, worst_residual_in_assembly,
};
use stillbase_mechanics::dynamics::{ExternalLoads, inverse_with_wrench};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::Vector;
use stillbase_planning::Motion;
use stillbase_planning::pose_space::plane_area;

use super::measures::instants;

/// Measures of one machine of a Pareto front.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct FrontPoint {
    /// Added mass, kg.
    pub added_mass: f64,
    /// Σ D_k, kg m².
    pub inertia: f64,
    /// Largest |torque| of a motor in a motion, weight included, N m; `None` without a motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque: Option<f64>,
    /// Area of the reactionless workspace, m²; `None` if not requested, or unless the machine has three drives, two
    /// relative angles with limits, and a b.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub workspace: Option<f64>,
    /// Largest |g_k| if every counterweight deviates by the usual tolerance ([`PlacementTolerance::DEFAULT`]), kg m.
    #[serde(rename = "off_by")]
    pub residual_if_misplaced: f64,
    /// Upper bound of how far the measure that was minimised, mass or Σ D_k, lies above its minimum, as a share of it;
    /// `None` for discs as they are bought. At the ends of the front the other measure is not minimised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relative_gap: Option<f64>,
    /// Whether this gap is within rounding.
    pub certified: bool,
}

/// Further measures of the machines of a Pareto front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrontMeasure {
    /// Largest torque in the motion.
    Torque,
    /// Area of the reactionless workspace.
    Workspace,
    /// Largest |g_k| if the counterweights deviate by the usual tolerance.
    OffBy,
}

impl FrontMeasure {
    /// All measures.
    pub const ALL: [Self; 3] = [Self::Torque, Self::Workspace, Self::OffBy];

    /// Returns the measure in words, and its unit.
    pub const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Torque => ["greatest torque", "N m"],
            Self::Workspace => ["workspace", "m²"],
            Self::OffBy => ["greatest |g_k| if 1 % and 0.5 mm off", "kg m"],
        }
    }

    /// Returns the measure of one machine; `None` where it is not defined. The motion must have as many drives as the
    /// machine.
    pub fn of(self, placed: &PlacedCounterweights, motion: Option<&Motion>) -> Option<f64> {
        let point = FrontPoint::of(placed, motion.filter(|_| self == Self::Torque), self == Self::Workspace);
        match self {
            Self::Torque => point.torque,
            Self::Workspace => point.workspace,
            Self::OffBy => Some(point.residual_if_misplaced),
        }
    }
}

impl FrontPoint {
    /// Returns the added mass, kg, and Σ D_k, kg m².
    pub fn measures(&self) -> [f64; 2] {
        [self.added_mass, self.inertia]
    }

    /// Returns the measures of one machine. The motion must have as many drives as the machine. The workspace is
    /// computed only if requested, because it takes longer than all other measures.
    pub fn of(placed: &PlacedCounterweights, motion: Option<&Motion>, workspace: bool) -> Self {
        let machine = &placed.machine;
        Self {
            added_mass: placed.added_mass,
            inertia: Inertia::of(machine).total_momentum(),
            torque: motion.map(|motion| greatest_torque(machine, motion)),
            workspace: workspace.then(|| plane_area(machine)).flatten(),
            residual_if_misplaced: worst_residual(machine, &PlacementTolerance::DEFAULT).force,
            relative_gap: Some(placed.relative_gap()).filter(|gap| gap.is_finite()),
            certified: placed.is_certified(),
        }
    }
}

impl From<&PlacedCounterweights<Assembly>> for FrontPoint {
    /// The measures of an assembly: of all its blocks together, without torque and workspace.
    fn from(placed: &PlacedCounterweights<Assembly>) -> Self {
        Self {
            added_mass: placed.added_mass,
            inertia: placed.machine.total_momentum(),
            torque: None,
            workspace: None,
            residual_if_misplaced: worst_residual_in_assembly(&placed.machine, &PlacementTolerance::DEFAULT).force,
            relative_gap: Some(placed.relative_gap()).filter(|gap| gap.is_finite()),
            certified: placed.is_certified(),
        }
    }
}

/// Returns the largest |torque| over all motors, N m.
fn greatest_torque(machine: &Machine, motion: &Motion) -> f64 {
    let inertia = Inertia::of(machine);
    let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
    let at = |r: stillbase_planning::Reference| {
        let (torque, _) = inverse_with_wrench(&inertia, &r.q.units(), &r.qd, &r.qdd, &around);
        inertia.motors().motor_torques(&torque).iter().fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    instants(motion).map(at).fold(0.0, f64::max)
}
