//! Every numbered equation of the paper with its present values: its meaning, its terms, their values, and the links
//! that contribute.
//!
//! The two sides of an equation are computed independently: one as a sum over links, the other by the program's closed
//! forms. So their agreement is a check.
//!
//! # Source
//! Papadopoulos and Abu-Abed. The sign of gravity in (4) and the weight of (10) are corrected; notes state the
//! corrections.

mod balance;
mod bodies;
mod equation;
mod planes;
mod printed;
mod products;
mod reactions;
mod state;
mod stated;
mod symbol;
mod written;

use stillbase_mechanics::balance::Preset;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_planning::pose_space::constant_inertia;
use stillbase_settings::number::ShortNumber;

pub use equation::{Equality, Equation, Origin, Term};
pub use printed::{equation_text, state_text};
pub use state::{DriveState, InstantKind, NoInstant};
pub use stated::{StatedEquation, StatedEquations, StatedLine, StatedPart, StatedTerm};
pub use symbol::{Level, pieces, plain};
pub use written::{EquationCell, cells};

/// Numbers of all equations, in the order of the paper.
pub const EQUATION_NUMBERS: [&str; 19] =
    ["1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16", "A1", "A2", "A3"];

/// Returns all equations for a machine at an instant, in the order of [`EQUATION_NUMBERS`]. The state must have as many
/// drives as the machine. `penalties` are those of (10); if they do not fit the machine, all are 1.
pub fn equations(machine: &Machine, state: &DriveState, penalties: Preset) -> Vec<Equation> {
    let inertia = Inertia::of(machine);
    let bodies = bodies::Bodies::of(machine);
    let instant = reactions::Reactions::of(machine, &inertia, &bodies, state);
    let balance = balance::BalanceEquations { machine, inertia: &inertia, bodies: &bodies };
    let lambda = constant_inertia(machine).map(|inertia| inertia.lambda().to_vec()).map_err(|why| why.to_string());
    let plane = planes::PlaneEquations { instant: &instant, lambda };
    vec![
        instant.force(),
        instant.centre(),
        instant.momentum(),
        instant.torque(),
        instant.moment(),
        instant.angular_momentum(),
        balance.force(),
        balance.invariance(),
        balance.linear(),
        balance.least(penalties),
        instant.decoupled(not_constant(&inertia)),
        plane.rates(),
        plane.pose_constant(),
        plane.end_effector(),
        plane.drive_angle(),
        plane.workspace(),
        balance.columns(&instant),
        balance.directions(&instant),
        balance.momenta(&instant),
    ]
}

/// Couplings up to this fraction of Σ H_kk are taken as rounding of printed data, such as the paper's tables.
const COUPLING_TOLERANCE: f64 = 1e-3;

/// Returns the reason if the mass matrix is not constant, else `None`.
fn not_constant(inertia: &Inertia) -> Option<String> {
    (inertia.pose_dependence() > COUPLING_TOLERANCE).then(|| {
        let left = ShortNumber((inertia.invariance_residual() * 1e4).round() * 1e-4);
        format!("the mass matrix of this machine changes with its pose: (8) has a residual of up to {left} kg m²")
    })
}
