//! Every numbered equation of the paper with today's numbers in it: what it says, its terms, their values, and which
//! links they come from.
//!
//! Both sides of an equation are found on ways of their own, one link by link and the other by the closed forms that all
//! else in the program uses, so that they agree is something found.
//!
//! # Source
//! Papadopoulos and Abu-Abed; the sign of gravity in (4) and the weight of (10) are put right, and said to be.

mod balance;
mod bodies;
mod equation;
mod planes;
mod products;
mod reactions;
mod state;
mod stated;
mod symbol;
mod written;

use crate::mechanics::balance::Preset;
use crate::mechanics::machine::{Inertia, Machine};
use crate::planning::pose_space::held;
use crate::settings::number::Short;

pub use equation::{Equation, Line, Origin, Term};
pub use state::{NoInstant, State, When};
pub use stated::{Stated, StatedEquation, StatedLine, StatedPart, StatedTerm};
pub use symbol::{Level, pieces, plain};
pub use written::{Cell, cells};

/// Numbers of all equations, in the order of the paper.
pub const NUMBERS: [&str; 19] =
    ["1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16", "A1", "A2", "A3"];

/// All of them for a machine at an instant, in the order of [`NUMBERS`]. The state has as many drives as the machine.
/// Penalties are those of (10); where they do not fit the machine, all are 1.
pub fn equations(machine: &Machine, state: &State, penalties: Preset) -> Vec<Equation> {
    let inertia = Inertia::of(machine);
    let bodies = bodies::Bodies::of(machine);
    let instant = reactions::Reactions::of(machine, &inertia, &bodies, state);
    let balance = balance::Balance { machine, inertia: &inertia, bodies: &bodies };
    let lambda = held(machine).map(|inertia| inertia.lambda().to_vec()).map_err(|why| why.to_string());
    let plane = planes::Plane { instant: &instant, lambda };
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

/// Couplings up to this share of the inertia of all are rounding of a table.
const ROUNDED: f64 = 1e-3;

/// Why the mass matrix is not constant.
fn not_constant(inertia: &Inertia) -> Option<String> {
    (inertia.pose_dependence() > ROUNDED).then(|| {
        let left = Short((inertia.invariance_residual() * 1e4).round() * 1e-4);
        format!("the mass matrix of this machine changes with its pose: (8) leaves up to {left} kg m²")
    })
}
