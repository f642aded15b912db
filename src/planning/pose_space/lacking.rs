//! [`NoPoseSpace`]: why a machine has no pose constant, and what little of it few drives have.

use thiserror::Error;

use crate::mechanics::machine::{Inertia, Machine};
use crate::planning::reactionless::WIDEST;
use crate::settings::number::{Short, counted, significant};

/// Why a machine has no pose constant, in words.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoPoseSpace {
    /// D depends on the pose.
    #[error(
        "this machine has no pose constant b: its angular momentum depends on the pose, because drives {} and {} are \
         coupled by {} kg m², most of it through link {link}; `stillbase design` finds centres of mass that undo it{}",
        .pair[0], .pair[1], significant(*residual), if *.only { ONLY_TWO } else { "" }
    )]
    Varies {
        /// The drives that are coupled most, counted from 1.
        pair: [usize; 2],
        /// |C_kl|, kg m².
        residual: f64,
        /// The link that contributes most.
        link: String,
        /// Whether there are only these two drives.
        only: bool,
    },
    /// Every D_k is 0.
    #[error("every motion of this machine is reactionless, as no drive turns the base: there is no b to hold")]
    Free,
    /// Turning the machine as a whole changes b the wrong way, or not at all.
    #[error(
        "turned as a whole, this machine changes b by Σλ = {}: want it above 0, with rotors that turn the other way less \
         fast or lighter", Short(*sum)
    )]
    Sum {
        /// Σλ.
        sum: f64,
    },
    /// The relative angles bind each other.
    #[error(
        "angle {angle:?} joins drives that the angles before it join already: want at most one way between two drives \
         for reactionless planes"
    )]
    Loop {
        /// The angle.
        angle: String,
    },
    /// Limits too far apart to count windings one by one.
    #[error("angle {angle:?} may turn by {width:.2} rad: want limits at most eight turns apart, {WIDEST} rad")]
    TooWide {
        /// The angle.
        angle: String,
        /// max − min, rad.
        width: f64,
    },
    /// An arm that is nothing, or all of them.
    #[error("the arms reach {} m: want a reach of 1e-9 to 1e9 m", Short(*reach))]
    Size {
        /// Σ |c_k|, m.
        reach: f64,
    },
}

/// Why no curve of the end effector can be followed while b is held, in words.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("while b is held the end effector of a machine with {} has its own way", counted(*.drives, "drive"))]
pub struct OwnWay {
    /// Drives of the machine.
    pub drives: usize,
}

/// Two drives keep something even so: see [`b_integral`](crate::planning::off_plane::b_integral).
const ONLY_TWO: &str = "; without a moment its two drives keep q₁ plus an integral over q₂ − q₁, which is not offered as \
                        b, because its λ changes with the pose";

/// Up to this share λ changes so little that to hold b keeps most of the moment from the base.
const NEARLY: f64 = 0.1;

/// Whether holding Σ λ_k q_k keeps every moment from the base.
pub(crate) fn is_reactionless(machine: &Machine) -> bool {
    Inertia::of(machine).is_invariant()
}

/// The inertia of a machine with λ that are constant, or nearly.
///
/// # Errors
/// Why it has none.
pub(crate) fn held(machine: &Machine) -> Result<Inertia, NoPoseSpace> {
    let inertia = Inertia::of(machine);
    if inertia.pose_dependence() > NEARLY {
        return Err(varies(machine, &inertia));
    }
    if inertia.pose_inertia() == 0.0 {
        return Err(NoPoseSpace::Free);
    }
    Ok(inertia)
}

/// The drives that are coupled most, and the link that contributes most to that.
fn varies(machine: &Machine, inertia: &Inertia) -> NoPoseSpace {
    let n = machine.drives();
    let coupled = |(k, l): &(usize, usize)| inertia.coupling(*k, *l).norm();
    let (k, l) = Inertia::pairs(n).max_by(|x, y| coupled(x).total_cmp(&coupled(y))).unwrap_or((0, 0));
    let whole = inertia.coupling(k, l);
    let part = |j: &usize| {
        let a = machine.com_chain(*j);
        // As far as it adds to the sum, rather than taking from it.
        (machine.links()[*j].mass * a[k].conj() * a[l] * whole.conj()).re
    };
    let most = (0..machine.links().len()).max_by(|i, j| part(i).total_cmp(&part(j))).unwrap_or(0);
    let link = machine.links()[most].name.clone();
    NoPoseSpace::Varies { pair: [k + 1, l + 1], residual: whole.norm(), link, only: n == 2 }
}
