//! The pose constant of a machine with two drives, even if its mass matrix depends on the pose.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | δ | q_2 − q_1 | rad |
//! | D_1, D_2 | H_11 + Re Z_12 and H_22 + Re Z_12, where Z_12 = C_12 e^{iδ} = R e^{i(δ + φ)} | kg m² |
//! | S | H_11 + H_22; here H_kk is D_k at C_12 = 0, not the entry of the mass matrix; without rotors S > 2R | kg m² |
//!
//! # Source
//! D q̇ = (D_1 + D_2) (q̇_1 + D_2/(D_1 + D_2) δ̇), and D_2/(D_1 + D_2) = ½ + ½ (H_22 − H_11)/(S + 2R cos(δ + φ))
//! depends on δ alone. So b = q_1 + ∫_0^δ D_2/(D_1 + D_2) dδ, and angular momentum is (D_1 + D_2) ḃ.

use crate::curves::{PathPoint, PathTable};
use stillbase_mechanics::machine::Inertia;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, unit};

/// b(q) of a machine with two drives and any couplings: it is constant exactly along motions of zero angular momentum.
///
/// Unlike (13) it is not scaled by D_1: for a constant mass matrix it is (D_1 q_1 + D_2 q_2)/(D_1 + D_2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BIntegral {
    /// ½ (H_22 − H_11)/√(S² − 4R²).
    gain: f64,
    /// √((S − 2R)/(S + 2R)).
    k: f64,
    /// φ, rad.
    phase: f64,
    /// S, kg m².
    sum: f64,
    /// H_22 − H_11, kg m².
    difference: f64,
    /// C_12, kg m².
    coupling: Vector,
}

/// Number of intervals between the nodes of a motion.
const NODE_INTERVALS: usize = 256;

impl BIntegral {
    /// Builds the integral of a machine. Returns `None` unless it has two drives and a positive definite mass matrix.
    pub fn of(model: &Inertia) -> Option<Self> {
        if model.drives() != 2 {
            return None;
        }
        let (first, second, coupling) = (model.momentum(0), model.momentum(1), model.coupling(0, 1));
        let (sum, twice_coupling) = (first + second, 2.0 * coupling.norm());
        // With rotors S is not the trace of the mass matrix, so its positive definiteness does not imply S > 2R.
        let definite = model.diagonal(0) * model.diagonal(1) > coupling.norm_sqr() && sum > twice_coupling;
        definite.then(|| Self {
            gain: 0.5 * (second - first) / ((sum - twice_coupling) * (sum + twice_coupling)).sqrt(),
            k: ((sum - twice_coupling) / (sum + twice_coupling)).sqrt(),
            phase: coupling.im.atan2(coupling.re),
            sum,
            difference: second - first,
            coupling,
        })
    }

    /// Returns b at q, rad, continuous over whole turns.
    pub fn b(&self, q: [f64; 2]) -> f64 {
        let delta = q[1] - q[0];
        q[0] + 0.5 * delta + self.gain * (self.swept(delta + self.phase) - self.swept(self.phase))
    }

    /// Returns D_1 + D_2 at q, kg m²: the inertia of the machine rotated as a whole.
    pub fn inertia(&self, q: [f64; 2]) -> f64 {
        self.sum + 2.0 * (self.coupling * unit(q[1] - q[0])).re
    }

    /// Returns the pose with given b and δ, rad. All poses of one motion of zero momentum have the same b.
    pub fn pose(&self, b: f64, delta: f64) -> DriveAngles {
        let first = -self.b([0.0, delta]);
        DriveAngles::from([b + first, b + first + delta])
    }

    /// Returns the motion of zero momentum from a pose to another δ, rad, with δ linear in s.
    pub fn motion(&self, from: &DriveAngles, to: f64) -> Option<PathTable> {
        let (b, start) = (self.b([from[0], from[1]]), from[1] - from[0]);
        let way = to - start;
        let node = |i: usize| {
            let delta = start + way * i as f64 / NODE_INTERVALS as f64;
            let z = self.coupling * unit(delta);
            let whole = self.sum + 2.0 * z.re;
            // D_2/(D_1 + D_2), and its derivative by δ.
            let share = 0.5 + 0.5 * self.difference / whole;
            let change = self.difference * z.im / (whole * whole);
            let second = -change * way * way;
            PathPoint {
                q: self.pose(b, delta),
                first: PerDrive::from([-share * way, (1.0 - share) * way]),
                second: PerDrive::from([second, second]),
            }
        };
        PathTable::even((0..=NODE_INTERVALS).map(node).collect())
    }

    /// Returns √(S² − 4R²) ∫_0^ψ dψ/(S + 2R cos ψ) = 2 arctan(k tan(ψ/2)), continuous over whole turns.
    fn swept(&self, psi: f64) -> f64 {
        let (e, k) = (unit(psi), self.k);
        psi - 2.0 * f64::atan((1.0 - k) * e.im / ((1.0 + k) + (1.0 - k) * e.re))
    }
}
