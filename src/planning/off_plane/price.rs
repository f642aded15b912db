//! The price of b: the base moment of a motion that leaves its plane, known before it starts.
//!
//! A machine whose mass matrix is constant transmits n_B = −D_1 b̈ only, whatever its other coordinates do. So the
//! price of a motion from a pose of one b to a pose of another depends on Δb, the duration and the time law alone.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | D_1 | H_11 of the constant mass matrix, (11) | kg m² |
//! | Δb | change of the pose constant, from rest to rest | rad |
//! | T | time it takes | s |
//! | n_B | moment on the base, −D_1 b̈ | N m |
//! | I_b, m_b, ρ | inertia about its own CM, mass and CM (seen from B) of a free base | kg m², kg, m |
//! | μ | m_b M / (m_b + M), M the mass of the manipulator | kg |
//!
//! # Source
//! (11)–(13): angular momentum about B is D q̇ = D_1 ḃ. It holds if C_kl = 0 for k ≠ l, no force acts on the end
//! effector and gravity has no moment about B; the price does not include gravity.

use thiserror::Error;

use crate::curves::PathPoint;
use crate::curves::path::Path;
use crate::curves::table::PathTable;
use crate::pose_space::PoseSpace;
use crate::posed::PoseAngles;
use crate::reactionless::BSet;
use crate::timing::law::TimeLaw;
use stillbase_mechanics::arm_on_base::FloatingBase;
use stillbase_mechanics::machine::Inertia;
use stillbase_mechanics::planar::DriveAngles;
use stillbase_settings::number::counted;

/// Time law of b from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseLaw {
    /// Constant b̈ for half of T, its negative for the rest: the least peak of n_B, and the least time for a given
    /// peak.
    BangBang,
    /// 3 u² − 2 u³: the least ∫ n_B² dt.
    Cubic,
    /// [`TimeLaw::Quintic`](crate::timing::TimeLaw): n_B begins and ends at zero.
    Quintic,
}

impl PoseLaw {
    /// Returns T² max|b̈|/|Δb|: 4, 6, 10/√3.
    pub fn peak(self) -> f64 {
        match self {
            Self::BangBang => 4.0,
            Self::Cubic => 6.0,
            Self::Quintic => TimeLaw::Quintic.peak(),
        }
    }

    /// Returns T ∫|b̈|dt/|Δb|, twice T max|ḃ|/|Δb|: 4, 3, 15/4.
    pub fn impulse(self) -> f64 {
        match self {
            Self::BangBang => 4.0,
            Self::Cubic => 3.0,
            Self::Quintic => 3.75,
        }
    }

    /// Returns T² times the root mean square of b̈, divided by |Δb|: 4, √12, √(120/7).
    pub fn rms(self) -> f64 {
        match self {
            Self::BangBang => 4.0,
            Self::Cubic => 12f64.sqrt(),
            Self::Quintic => (120.0 / 7.0f64).sqrt(),
        }
    }
}

/// Why a change of b has no price.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum PriceError {
    /// H depends on the pose.
    #[error("the mass matrix depends on the pose (|C_kl| up to {residual:.2e} kg m²), so there is no b: want C_kl = 0")]
    NotInvariant {
        /// Maximum |C_kl|, kg m².
        residual: f64,
    },
    /// The centre of mass moves.
    #[error("the centre of mass moves (|g_k| up to {residual:.2e} kg m): the turn of a free base wants g_k = 0")]
    NotBalanced {
        /// Maximum |g_k|, kg m.
        residual: f64,
    },
    /// The number of angles of a pose differs from the machine's number of drives.
    #[error("poses of {from} and {to} angles for a machine of {}: want {drives} each", counted(drives, "drive"))]
    Drives {
        /// Number of angles of the first pose.
        from: usize,
        /// Number of angles of the second pose.
        to: usize,
        /// Number of drives of the machine.
        drives: usize,
    },
    /// Invalid mass, inertia or centre of mass of a base.
    #[error("a free base wants finite numbers, with mass and inertia not below 0 and one of them above")]
    Base,
}

/// Cost of changing b by Δb, from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Price {
    inertia: f64,
    delta_b: f64,
}

impl Price {
    /// Returns the price of Δb, rad, on a machine whose mass matrix is constant.
    ///
    /// # Errors
    /// If the mass matrix is not constant.
    pub fn of(model: &Inertia, delta_b: f64) -> Result<Self, PriceError> {
        if !model.is_invariant() {
            return Err(PriceError::NotInvariant { residual: model.invariance_residual() });
        }
        Ok(Self { inertia: model.pose_inertia(), delta_b })
    }

    /// Returns the price of any motion from one pose to another: Δb = Σ λ_k Δq_k, in absolute drive angles.
    ///
    /// # Errors
    /// If the mass matrix is not constant, or the poses have another number of angles.
    pub fn between(model: &Inertia, from: &DriveAngles, to: &DriveAngles) -> Result<Self, PriceError> {
        let drives = model.drives();
        if from.len() != drives || to.len() != drives {
            return Err(PriceError::Drives { from: from.len(), to: to.len(), drives });
        }
        Self::of(model, model.lambda().dot(&to.0.minus(&from.0)))
    }

    /// Returns D_1, kg m².
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Returns Δb, rad.
    pub fn delta_b(&self) -> f64 {
        self.delta_b
    }

    /// Returns the peak |n_B| of a law that takes `duration`, s: 4, 6 or 5.7735 … times D_1 |Δb|/T², N m.
    pub fn peak(&self, law: PoseLaw, duration: f64) -> f64 {
        law.peak() * self.size() / (duration * duration)
    }

    /// Returns the least peak |n_B| of any motion that takes `duration`, s: 4 D_1 |Δb|/T², bang-bang, N m.
    pub fn least_peak(&self, duration: f64) -> f64 {
        self.peak(PoseLaw::BangBang, duration)
    }

    /// Returns ∫|n_B|dt of a law that takes `duration`, s, in N m s.
    pub fn impulse(&self, law: PoseLaw, duration: f64) -> f64 {
        law.impulse() * self.size() / duration
    }

    /// Returns the root mean square of n_B of a law that takes `duration`, s, in N m.
    pub fn rms(&self, law: PoseLaw, duration: f64) -> f64 {
        law.rms() * self.size() / (duration * duration)
    }

    /// Returns the least T, s, for which a law keeps |n_B| ≤ `limit`, N m; infinite for a limit of zero, unless Δb is
    /// zero.
    pub fn time(&self, law: PoseLaw, limit: f64) -> f64 {
        if self.delta_b == 0.0 { 0.0 } else { (law.peak() * self.size() / limit.max(0.0)).sqrt() }
    }

    /// Returns the final rotation of a free-floating base that starts at rest, whatever the path, law and duration: Δθ
    /// = −D_1 Δb/(I_b + μ|ρ|² + Σ(C_kk + J_k) + ΣJ_rotor), rad. Here b is formed from the angles between drives and
    /// base, q_k − θ.
    ///
    /// # Errors
    /// If the machine's mass matrix is not constant, its centre of mass moves, or the base is invalid.
    pub fn base_turn(&self, model: &Inertia, base: &FloatingBase) -> Result<f64, PriceError> {
        Self::of(model, self.delta_b)?;
        if !model.is_force_balanced() {
            return Err(PriceError::NotBalanced { residual: model.force_residual() });
        }
        let FloatingBase { mass, inertia, com } = *base;
        let sound = mass >= 0.0 && inertia >= 0.0 && mass + inertia > 0.0 && (mass + inertia).is_finite();
        if !(sound && com.is_finite()) {
            return Err(PriceError::Base);
        }
        let reduced = mass * model.mass() / (mass + model.mass());
        let whole = inertia + reduced * com.norm_sqr() + model.locked();
        Ok(-model.pose_inertia() * self.delta_b / whole)
    }

    fn size(&self) -> f64 {
        self.inertia * self.delta_b.abs()
    }
}

/// Returns the two b, one of each set, that are nearest to each other, rad. Whole periods are added so that the first
/// is as near as possible to `near`. If the sets overlap, both are the common b nearest to `near`. Returns `None` if a
/// set is empty.
pub fn nearest_planes(from: &BSet, to: &BSet, near: f64) -> Option<[f64; 2]> {
    let common = BSet::overlap(&[from.clone(), to.clone()]);
    if let Some(b) = common.nearest(near) {
        return Some([b, b]);
    }
    let mut best: Option<[f64; 2]> = None;
    let cost = |pair: &[f64; 2]| ((pair[1] - pair[0]).abs(), (pair[0] - near).abs());
    for start in &from.shifted_near(near).intervals {
        // Either bound of an interval may be the nearest start.
        for b in start {
            let Some(end) = to.nearest(*b) else { continue };
            let pair = [*b, end];
            if best.is_none_or(|least| cost(&pair) < cost(&least)) {
                best = Some(pair);
            }
        }
    }
    best
}

/// Fractions of the way from a bound of an interval of b to its middle, tried in turn if rounding leaves the bound
/// without a pose.
pub const INWARD_SHARES: [f64; 4] = [0.0, 1e-12, 1e-9, 1e-6];

/// Returns the straight joint line between two poses of any b; b then follows the time law. Limits of relative angles
/// form a box, so the line keeps them if both poses do.
pub fn joint_line([from, to]: &[PoseAngles; 2]) -> Path {
    Path::JointLine { from: from.q, to: to.q }
}

/// Returns a motion in which b is bang-bang over the whole of T, while the relative angles follow the quintic law. It
/// has the least peak of n_B, and its relative angles start and stop smoothly. Its parameter is u = t/T, so rates are
/// q′/T and accelerations q″/T².
///
/// b″ jumps at u = 0, ½ and 1. At ½ it has the value of the first half; the second half begins at the next
/// floating-point number.
pub fn bang_bang_in_b(space: &PoseSpace, [from, to]: &[PoseAngles; 2]) -> Option<PathTable> {
    let step = to.a.minus(&from.a);
    let delta_b = to.b - from.b;
    let point = |share: [f64; 3], turn: [f64; 3]| {
        let rates = |i: usize| space.lift_rates(&step.scaled(share[i]), turn[i] * delta_b);
        let q = space.lift(&from.a.plus(share[0], &step), from.b + turn[0] * delta_b);
        PathPoint { q, first: rates(1), second: rates(2) }
    };
    let middle = [0.5, 1.875, 0.0];
    let nodes = vec![
        point([0.0; 3], [0.0, 0.0, 4.0]),
        point(middle, [0.5, 2.0, 4.0]),
        point(middle, [0.5, 2.0, -4.0]),
        point([1.0, 0.0, 0.0], [1.0, 0.0, -4.0]),
    ];
    // No number lies between the two nodes of the jump, so the quintic between them is never evaluated.
    PathTable::new(vec![0.0, 0.5, 0.5f64.next_up(), 1.0], nodes)
}
