//! Counterweights as discs: those of least mass or least inertia that balance a machine, with a certificate.
//!
//! A disc of mass w on link j at x along its axis enters balance (7), (8) linearly through w and s = w x; bounds on its
//! position are lo w ≤ s ≤ hi w. It adds s²/w to the inertia about the root, and w²/(2 π ρ t) of its own: both are
//! convex. So the problem is a cone program with one optimum, which the solver certifies.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | w, s | mass of a counterweight; w x | kg, kg m |
//! | ρ, t | density and thickness of the discs | kg/m³, m |
//! | D_k | momentum of a drive, (6) | kg m² |

mod cell;
mod free_span;
mod front;
mod payload;
mod place;
mod problem;
mod program;
mod question;
mod refusal;
mod relief;
mod residual;
mod search;
mod search_node;
mod solution;
mod spec;
mod tolerance;
mod unknowns;

pub use front::{Front, FrontSearch, front};
pub use payload::{Residual, over_payloads};
pub use place::{Placed, place_weights, place_weights_with, unreachable_by_weights};
pub use refusal::{Bound, BoundRelaxation, CounterweightError};
pub use spec::{
    CounterweightSpec, DENSITY_RANGE, Disc, FreeRotor, MATERIALS, Objective, RotorFreedom, Sites, THICKNESS_RANGE,
};
pub use tolerance::{PlacementTolerance, WorstResidual, worst_residual};
