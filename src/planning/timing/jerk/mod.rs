//! The fastest timing of a path within limits on torque, speed, acceleration and jerk, as one smooth nonlinear program.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | θ | parameter in place of s, s = 10 θ³ − 15 θ⁴ + 6 θ⁵: ds/dθ = 0 at both ends | |
//! | y, y′, y″ | θ̇³ and its derivatives with respect to θ | 1/s³ |
//! | q′, q″, q‴ | derivatives of q with respect to θ | rad |
//! | c_i | coefficients of y, a quadratic spline over the nodes θ_i | 1/s³ |
//!
//! # Method
//! With θ̇ = y^⅓, θ̈ = y′/(3 y^⅓) and θ⃛ = y″/3 − y′²/(9 y), T = ∫ y^−⅓ dθ is convex in y. A limit
//! |a θ̈ + c θ̇² + g| ≤ 1 is
//! |a y′/3 + c y + g y^⅓| ≤ y^⅓. This is convex, and so is a limit on speed. Jerk is q′ y″/3 + q″ y′ + q‴ y − q′ y′²/(9
//! y): linear except for its last term, which makes one of its two sides non-convex. With θ as parameter, rest at both
//! ends is not a singularity: y stays above 0 there.
//!
//! A primal-dual interior-point method (Mehrotra's predictor and corrector) improves a slow feasible motion through
//! feasible ones to the fastest. It omits the curvature of non-convex sides. Each limit has three neighbouring
//! coefficients, so the cost of a step is proportional to the number of nodes. It finds a local optimum.

mod band;
mod easing;
mod interior_point;
mod program;
mod solution;
mod spline;
mod start;

pub(super) use easing::{eased, uneased};
pub(super) use program::JerkProgram;
