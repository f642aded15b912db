//! Counterweights as discs: finds those of least mass or least inertia that balance a machine, with a certificate.
//!
//! A disc of mass w on a link, at x along its axis and y to the left of it, enters balance (7), (8) linearly: the real
//! parts through w and s = w x, the imaginary parts through t = w y. Bounds lo and hi of x are lo w ≤ s ≤ hi w. To the
//! inertia about the root it adds (s² + t²)/w from its position and w²/(2 π ρ d) about its centre; both are convex. So the problem is a cone program with one optimum, which the solver
//! certifies. A clearance of pins, or Σ |D_k| in the objective, can make it nonconvex; it is then solved by branch
//! and bound.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | w, s, t | mass of a counterweight; w x; w y | kg, kg m, kg m |
//! | ρ, d | density and thickness of the discs | kg/m³, m |
//! | D_k | coefficient of q̇_k in the angular momentum about B, (6) | kg m² |

mod assembly;
mod broken;
mod cell;
mod front;
mod link_part;
mod payload;
mod pin_sector;
mod place;
mod problem;
mod program;
mod refusal;
mod relaxed;
mod relief;
mod residual;
mod search;
mod search_node;
mod solution;
mod spec;
mod stock;
mod subject;
mod task;
mod tolerance;
mod units;
mod unknowns;

pub use crate::machine::MATERIALS;
pub use crate::machine::ranges::DENSITY as DENSITY_RANGE;
pub use assembly::{AssemblyFrontSearch, place_in_assembly, reachable_goals};
pub use broken::BrokenBound;
pub use front::{END_TOLERANCE, Front, FrontSearch, front, front_while};
pub use payload::{PayloadResidual, over_payloads};
pub use place::{PlacedCounterweights, place_weights, place_weights_with, unreachable_by_weights, weights_if_any};
pub use refusal::{Bound, BoundKind, BoundRelaxation, CounterweightError, RelaxedBounds};
pub use relaxed::relaxed_weights_if_any;
pub use relief::EXTRA_FRACTIONS;
pub use spec::{ACROSS_RANGE, CounterweightSite, CounterweightSpec, FreeRotor, Objective, RotorFreedom};
pub use stock::{
    BOX_WIDTH_RANGE, CounterweightForm, CounterweightKind, CounterweightStock, INNER_RADIUS_RANGE, THICKNESS_RANGE,
};
pub use subject::SpatialGoal;
pub use tolerance::{PlacementTolerance, WorstResidual, worst_residual, worst_residual_in_assembly};
