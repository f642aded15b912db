//! [`NoPoseSpace`]: why a machine has no pose constant. [`NotFollowable`]: why its end effector cannot follow curves.

use thiserror::Error;

use crate::reactionless::MAX_LIMIT_RANGE;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_settings::number::{ShortNumber, counted, significant};

/// Why a machine has no pose constant, in words.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoPoseSpace {
    /// The inertia matrix D depends on the pose.
    #[error(
        "this machine has no pose constant b: its angular momentum depends on the pose, because drives {} and {} are \
         coupled by {} kg m², most of it through link {link}; design finds centres of mass that undo it{}",
        .pair[0], .pair[1], significant(*residual), if *.only { ONLY_TWO } else { "" }
    )]
    Varies {
        /// The pair of drives with the largest coupling, counted from 1.
        pair: [usize; 2],
        /// Size of the coupling |C_kl|, kg m².
        residual: f64,
        /// The link that contributes most.
        link: String,
        /// Whether the machine has only these two drives.
        only: bool,
    },
    /// Every inertia D_k is 0.
    #[error("every motion of this machine is reactionless, as no drive turns the base: there is no b to hold")]
    Free,
    /// Turning the machine as a whole decreases b, or leaves it unchanged.
    #[error(
        "turned as a whole, this machine changes b by Σλ = {}: want it above 0, with rotors that turn the other way less \
         fast or lighter", ShortNumber(*sum)
    )]
    Sum {
        /// Σλ.
        sum: f64,
    },
    /// A relative angle joins drives that are already connected: a closed loop.
    #[error(
        "angle {angle:?} joins drives that the angles before it join already: want at most one way between two drives \
         for reactionless planes"
    )]
    Loop {
        /// Name of the angle.
        angle: String,
    },
    /// Limits too far apart for windings to be counted one by one.
    #[error("angle {angle:?} may turn by {width:.2} rad: want limits at most eight turns apart, {MAX_LIMIT_RANGE} rad")]
    TooWide {
        /// Name of the angle.
        angle: String,
        /// max − min, rad.
        width: f64,
    },
    /// The reach is 0 or otherwise outside the numerical range.
    #[error("the arms reach {} m: want a reach of 1e-9 to 1e9 m", ShortNumber(*reach))]
    Size {
        /// Reach Σ |c_k|, m.
        reach: f64,
    },
}

/// Why the end effector cannot follow prescribed curves while b is held, in words.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("while b is held, the end effector of a machine with {} moves on one curve at most", counted(*.drives, "drive"))]
pub struct NotFollowable {
    /// Number of drives of the machine.
    pub drives: usize,
}

/// Added for two drives, which conserve an integral in any case: see [`b_integral`](crate::off_plane::b_integral).
const ONLY_TWO: &str = "; without a moment its two drives keep q₁ plus an integral over q₂ − q₁, which is not offered as \
                        b, because its λ changes with the pose";

/// Maximum relative variation of λ with the pose at which holding b still removes most of the base moment.
const MAX_POSE_DEPENDENCE: f64 = 0.1;

/// Whether holding Σ λ_k q_k keeps the base free of moments.
pub fn is_reactionless(machine: &Machine) -> bool {
    Inertia::of(machine).is_invariant()
}

/// Returns the inertia of a machine whose λ are constant, or nearly so.
///
/// # Errors
/// If the machine has no pose constant: the reason.
pub fn constant_inertia(machine: &Machine) -> Result<Inertia, NoPoseSpace> {
    let inertia = Inertia::of(machine);
    if inertia.pose_dependence() > MAX_POSE_DEPENDENCE {
        return Err(varies(machine, &inertia));
    }
    if inertia.pose_inertia() == 0.0 {
        return Err(NoPoseSpace::Free);
    }
    Ok(inertia)
}

/// Finds the pair of drives with the largest coupling, and the link that contributes most to it.
fn varies(machine: &Machine, inertia: &Inertia) -> NoPoseSpace {
    let n = machine.drives();
    let coupled = |(k, l): &(usize, usize)| inertia.coupling(*k, *l).norm();
    let (k, l) = Inertia::pairs(n).max_by(|x, y| coupled(x).total_cmp(&coupled(y))).unwrap_or((0, 0));
    let whole = inertia.coupling(k, l);
    let part = |j: &usize| {
        let a = machine.com_chain(*j);
        // Component in the direction of the sum.
        (machine.links()[*j].mass * a[k].conj() * a[l] * whole.conj()).re
    };
    let most = (0..machine.links().len()).max_by(|i, j| part(i).total_cmp(&part(j))).unwrap_or(0);
    let link = machine.links()[most].name.clone();
    NoPoseSpace::Varies { pair: [k + 1, l + 1], residual: whole.norm(), link, only: n == 2 }
}
