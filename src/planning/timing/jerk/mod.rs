//! The fastest timing of a path within limits on torque, speed, acceleration and jerk, as one smooth program.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | θ | parameter in place of s, s = 10 θ³ − 15 θ⁴ + 6 θ⁵: at rest at both ends of its own | |
//! | y, y′, y″ | θ̇³ and its derivatives by θ | 1/s³ |
//! | q′, q″, q‴ | derivatives of q by θ | rad |
//! | c_i | coefficients of y, a quadratic spline over the nodes θ_i | 1/s³ |
//!
//! # Method
//! With θ̇ = y^⅓, θ̈ = y′/(3 y^⅓) and θ⃛ = y″/3 − y′²/(9 y), T = ∫ y^−⅓ dθ is convex in y. A limit on a u + c x + g is
//! |a y′/3 + c y + g y^⅓| ≤ y^⅓, convex, and so is one on speed. Jerk is q′ y″/3 + q″ y′ + q‴ y − q′ y′²/(9 y): linear
//! but for its last term, which makes one of its two sides not convex. With θ as parameter, rest at both ends is no
//! singularity: y stays above 0 there.
//!
//! An interior-point method goes from a slow motion within all limits to the fastest, never leaving them (predictor and
//! corrector of Mehrotra; where a side is not convex its curvature is left out). Rows touch three neighbouring
//! coefficients each, so a step costs time in proportion to the nodes. It finds a local optimum.

mod band;
mod easing;
mod program;
mod room;
mod solution;
mod spline;
mod start;

pub(super) use easing::{eased, uneased};
pub(super) use program::JerkProgram;
