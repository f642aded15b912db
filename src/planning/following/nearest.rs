//! The reactionless motion nearest to a given one: the same timing on a plane b = const.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q(t) | the given motion, b(t) = Σ λ_k q_k(t) | rad |
//! | D_k | H_kk of drive k; without rotors the constant inertia of (11) | kg m² |
//! | ‖Δq‖² | ∫ Σ D_k Δq_k² dt / T ΣD: mean square deviation of the joints in the metric of kinetic energy | rad² |
//! | b̄ | mean of b(t) over time | rad |
//!
//! # Source
//! In the metric of kinetic energy the normal of the planes is D⁻¹λ ∝ (1, …, 1). So the nearest pose on a plane is the
//! pose rotated as a whole by (b − b(t))/Σλ. Its distance is |b − b(t)|/Σλ, and the nearest constant b is b̄. This
//! rotates the end effector with the arm. To keep the end effector instead, each pose moves along the null space of
//! its Jacobian onto the plane, by inversion of (16). This takes a b that reaches every point of the path; a search
//! finds the nearest one in the same metric.

use thiserror::Error;

pub use super::closest::NoClosestMotion;
pub use super::deviation::Deviation;
use super::trace::{Blocked, Rule};
use super::{closest, on_plane};
use crate::curves::given::Samples;
use crate::pose_space::PoseSpace;
use stillbase_mechanics::machine::Inertia;
use stillbase_mechanics::planar::PerDrive;
use stillbase_query::ProgressCallback;

/// Why a motion cannot be moved to a b with the same end effector path.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NotMoved {
    /// Its curve cannot be followed on the plane.
    #[error(transparent)]
    Blocked(#[from] Box<Blocked>),
    /// With more than three drives, no feasible pose was found near a given one.
    #[error(transparent)]
    NoneClose(#[from] NoClosestMotion),
}

impl NotMoved {
    /// Returns a b at which the curve can be followed, rad, if one is known.
    pub fn nearest_b(&self) -> Option<f64> {
        match self {
            Self::Blocked(blocked) => blocked.nearest_b,
            Self::NoneClose(_) => None,
        }
    }
}

/// Rotates every sample as a whole onto the plane b, rad: relative angles stay, the end effector rotates with the arm.
pub fn turned_to_plane(lambda: &PerDrive, samples: &Samples, b: f64) -> Option<Samples> {
    let sum: f64 = lambda.iter().sum();
    let row = |i: usize| {
        let q = samples.values(i);
        let turn = (b - lambda.dot(q)) / sum;
        q.iter().map(|q| q + turn).collect()
    };
    samples.with_values((0..samples.count()).map(row))
}

/// Moves every sample to b, rad, with its end effector position unchanged. With three drives it follows one sheet of
/// the plane under a rule, with more it takes the poses closest to the given ones. Returns `None` if the samples define
/// no path.
///
/// # Errors
/// Where a sample cannot be moved.
pub fn same_tip(
    space: &PoseSpace,
    model: &Inertia,
    samples: &Samples,
    b: f64,
    rule: Rule,
) -> Result<Option<Samples>, NotMoved> {
    match space.planes() {
        Ok(planes) => Ok(on_plane::same_tip(planes.map(), &model.end_effector, samples, b, rule)?),
        Err(_) => Ok(Some(closest::same_tip(space, model, samples, b)?)),
    }
}

/// Finds the constant b, rad, whose motion with the same end effector path is nearest to the given one. Also returns
/// the ‖Δq‖, rad, of that motion. Both come from a subset of the samples. Returns `None` if no b was found, or if
/// `goes_on` cancels the search.
pub fn nearest_b(
    space: &PoseSpace,
    model: &Inertia,
    samples: &Samples,
    rule: Rule,
    goes_on: ProgressCallback<'_>,
) -> Option<(f64, f64)> {
    match space.planes() {
        Ok(planes) => on_plane::nearest_b(planes.map(), model, samples, rule, goes_on),
        Err(_) => closest::nearest_b(space, model, samples, goes_on),
    }
}
