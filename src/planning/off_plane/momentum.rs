//! The angular momentum of an arm as its base keeps its orientation: about the base pin of a fixed base, about the
//! common centre of mass of a free one.
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | e_k | e^{i q_k} of the absolute drive angle q_k | complex |
//! | D_k | coefficient of q̇_k in the angular momentum, D q̇ | kg m² |
//! | C_kl, g_k, c_k | couplings, first moments, coefficients of the end effector of [`Inertia`] | kg m², kg m, m |
//! | m_b, ρ, M | mass of the base, its centre of mass seen from B, mass of base and arm | kg, m, kg |
//! | C_0k | coupling of drive k with the base, which keeps its orientation | complex, kg m² |
//!
//! # Source
//! A free base at zero linear momentum moves against the first moments: ṙ_B = −Σ i g_k e_k q̇_k / M. The common centre of
//! mass is at (Σ g_k e_k + m_b ρ)/M, seen from B. The angular momentum about it is that about B minus
//! Re[conj(Σ_l g_l e_l + m_b ρ) Σ_k g_k e_k q̇_k]/M. So it is the momentum of an arm with C_kl − conj(g_k) g_l/M in place
//! of C_kl, and with C_0k = −conj(m_b ρ) g_k/M. In space the end effector has the coefficients c_k − g_k/M.
//!
//! A free base that turns by θ as the drive angles q_k between drives and base change has D q̇ + I θ̇ = 0. Here I is the
//! inertia of base and arm about their common centre of mass, turning as one body: that of the arm with its reduced
//! couplings, I_b + |ρ|² m_b (M − m_b)/M, and 2 Σ Re(C_0k e_k).

use stillbase_mechanics::arm_on_base::FloatingBase;
use stillbase_mechanics::dynamics::mass_matrix;
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::machine::{BALANCE_TOLERANCE, Chain, Inertia};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, UnitVectors, Vector, unit};

use stillbase_settings::word::words;

words! {
    /// Where coordinates of the end effector are meant.
    pub enum TipFrame {
        Base = "base", "Seen from the base", "From the base pin, which a free base shifts";
        Space = "space", "In space", "From where the base pin starts";
    }
}

/// The angular momentum of an arm whose base does not turn, h = D(q) q̇, and the position of its end effector.
#[derive(Clone, Debug, PartialEq)]
pub struct MomentumModel {
    /// The arm, with couplings as they are beside the base.
    arm: Inertia,
    /// C_0k, kg m².
    base: [Vector; MAX_DRIVES],
    /// Sizes of the coefficients of the end effector, m.
    tip: Chain,
    /// Their directions.
    directions: [Vector; MAX_DRIVES],
    /// Where the coordinates of the end effector have their origin, m.
    origin: Vector,
    /// A base that floats.
    floating: Option<Floating>,
}

/// A base that floats beside its arm.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Floating {
    /// I_b + |ρ|² m_b (M − m_b)/M, kg m².
    inertia: f64,
    /// m_b ρ/M, m.
    centre: Vector,
    /// Where the end effector is meant.
    frame: TipFrame,
}

/// A free base as it turns: the inertia of base and arm about their common centre of mass, kg m², and the end effector
/// seen from there in the axes of the base, m, if coordinates are meant in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TurningBase {
    pub inertia: f64,
    pub lever: Option<Vector>,
}

/// How a free base turns with its arm at a pose: θ̇ = A q̇, with A = −D/I.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnForm {
    /// A.
    pub coefficients: PerDrive,
    /// ∂A/∂q_m for each m.
    pub slopes: [PerDrive; MAX_DRIVES],
}

impl TurnForm {
    /// Returns ∂A_l/∂q_m − ∂A_m/∂q_l: the turn of the base around a small loop, per area of the loop in that plane.
    pub fn curl(&self, m: usize, l: usize) -> f64 {
        self.slopes[m][l] - self.slopes[l][m]
    }
}

impl From<&Inertia> for MomentumModel {
    /// Returns the angular momentum about the base pin of a fixed base.
    fn from(arm: &Inertia) -> Self {
        let directions = [Vector::new(1.0, 0.0); MAX_DRIVES];
        // Links that keep their orientation are beside the base here, not in the arm.
        let base = std::array::from_fn(|k| if k < arm.drives { arm.ground_coupling(k) } else { Vector::default() });
        let mut arm = arm.clone();
        arm.grounded = false;
        Self { base, tip: arm.end_effector, arm, directions, origin: Vector::default(), floating: None }
    }
}

impl MomentumModel {
    /// Returns the angular momentum of an arm and a free base about their common centre of mass. Linear momentum is zero,
    /// and motions start at the pose `start`.
    pub fn floating(arm: &Inertia, base: &FloatingBase, frame: TipFrame, start: &DriveAngles) -> Self {
        let whole = base.mass + arm.mass;
        let n = arm.drives;
        let (still, still_inertia) = match arm.grounded {
            true => (arm.g[n], arm.c[n][n].re + arm.spin[n]),
            false => (Vector::default(), 0.0),
        };
        let first = base.mass * base.com + still;
        let mut own = Self::from(arm);
        for k in 0..arm.drives {
            for l in 0..arm.drives {
                own.arm.c[k][l] -= arm.g[k].conj() * arm.g[l] / whole;
            }
            own.base[k] -= first.conj() * arm.g[k] / whole;
            if frame == TipFrame::Space {
                let coefficient = arm.end_effector[k] - arm.g[k] / whole;
                own.tip[k] = coefficient.norm();
                if own.tip[k] > 0.0 {
                    own.directions[k] = coefficient / own.tip[k];
                }
            }
        }
        let about_pin = base.inertia + base.mass * base.com.norm_sqr() + still_inertia;
        own.floating = Some(Floating { inertia: about_pin - first.norm_sqr() / whole, centre: first / whole, frame });
        own.origin = end_effector(&arm.end_effector, &start.units()) - own.place(start);
        own
    }

    /// Returns whether arm and base are those of another model, which may start elsewhere.
    pub fn is_same_craft(&self, other: &Self) -> bool {
        self.arm == other.arm && self.floating == other.floating
    }

    /// Returns the arm, with couplings as they are beside the base.
    pub(super) fn arm(&self) -> &Inertia {
        &self.arm
    }

    /// Returns the number of drives.
    pub fn drives(&self) -> usize {
        self.arm.drives
    }

    /// Returns the sizes of the coefficients of the end-effector position, m, to be used with [`Self::tip_units`].
    pub fn tip(&self) -> &Chain {
        &self.tip
    }

    /// Returns the unit vectors of the coefficients of the end effector at a pose.
    pub fn tip_units(&self, e: &UnitVectors) -> UnitVectors {
        std::array::from_fn(|k| self.directions[k] * e[k])
    }

    /// Returns the place of the end effector at a pose, m: seen from the base pin, or in space.
    pub fn place(&self, q: &DriveAngles) -> Vector {
        self.origin + end_effector(&self.tip, &self.tip_units(&q.units()))
    }

    /// Returns the place of the end effector, m, as [`Self::place`] does, with a free base that has turned by `turn`, rad.
    pub fn place_turned(&self, q: &DriveAngles, turn: f64) -> Vector {
        match self.floating {
            Some(Floating { centre, frame: TipFrame::Space, .. }) => {
                let whole = self.origin + centre;
                whole + unit(turn) * (self.place(q) - whole)
            }
            _ => self.place(q),
        }
    }

    /// Returns whether the base floats, so that momentum turns it.
    pub fn floats(&self) -> bool {
        self.floating.is_some()
    }

    /// Returns whether coordinates of the end effector are seen from a base that moves.
    pub fn is_carried(&self) -> bool {
        self.floating.is_some_and(|base| base.frame == TipFrame::Base)
    }

    /// Returns how a free base turns at a pose; `None` if the base is not free.
    pub(super) fn turning(&self, e: &UnitVectors) -> Option<TurningBase> {
        let base = self.floating?;
        let n = self.drives();
        let pairs: f64 = Inertia::pairs(n).map(|(k, l)| self.coupling(e, k, l).re).sum();
        let beside: f64 = (0..n).map(|k| (self.base[k] * e[k]).re).sum();
        let inertia = base.inertia + self.arm.locked() + 2.0 * (pairs + beside);
        let seen = || end_effector(&self.tip, &self.tip_units(e)) - base.centre;
        Some(TurningBase { inertia, lever: (base.frame == TipFrame::Space).then(seen) })
    }

    /// Returns A of θ̇ = A q̇, by which a free base at zero momentum turns with its arm at a pose, A = −D/I; `None` if the
    /// base is not free.
    pub(super) fn turn_coefficients(&self, e: &UnitVectors) -> Option<PerDrive> {
        Some(self.coefficients(e).scaled(-1.0 / self.turning(e)?.inertia))
    }

    /// Returns how a free base at zero momentum turns with its arm at a pose; `None` if the base is not free.
    pub fn turn_form(&self, q: &DriveAngles) -> Option<TurnForm> {
        let e = q.units();
        let inertia = self.turning(&e)?.inertia;
        let n = self.drives();
        let coefficients = self.turn_coefficients(&e)?;
        let slopes = std::array::from_fn(|m| {
            if m >= n {
                return PerDrive::zeros(n);
            }
            let alone = PerDrive::from_fn(n, |k| f64::from(k == m));
            let d_slope = self.coefficient_rates(&e, &alone);
            // ∂I/∂q_m = 2 Σ_l Im Z_ml − 2 Im (C_0m e_m); Z_mm is real.
            let beside = (self.base[m] * e[m]).im;
            let inertia_slope = 2.0 * ((0..n).map(|l| self.coupling(&e, m, l).im).sum::<f64>() - beside);
            d_slope.scaled(-1.0 / inertia).plus(-inertia_slope / inertia, &coefficients)
        });
        Some(TurnForm { coefficients, slopes })
    }

    /// Returns the largest distance of the end effector from the origin of its coordinates, m.
    pub fn reach(&self) -> f64 {
        self.tip.iter().map(|c| c.abs()).sum()
    }

    /// Returns a point from which the end effector is never farther than a distance, m: the base pin, or the centre of mass
    /// of arm and base, if they are seen in space and turn in any way.
    pub fn range(&self) -> (Vector, f64) {
        match self.floating {
            Some(Floating { centre, frame: TipFrame::Space, .. }) => {
                (self.origin + centre, centre.norm() + self.reach())
            }
            _ => (self.origin, self.reach()),
        }
    }

    /// Returns D_k at a pose, kg m², (A3).
    #[inline]
    pub fn coefficients(&self, e: &UnitVectors) -> PerDrive {
        let n = self.drives();
        let (h, _) = mass_matrix(&self.arm, e, &PerDrive::zeros(n));
        PerDrive::from_fn(n, |k| h.momentum_coefficient(k) + (self.base[k] * e[k]).re)
    }

    /// Returns Ḋ_k at a pose for rates q̇, kg m²/s.
    #[inline]
    pub fn coefficient_rates(&self, e: &UnitVectors, qd: &PerDrive) -> PerDrive {
        let n = self.drives();
        // Re Z_kl changes at −Im Z_kl (q̇_l − q̇_k), and Re (C_0k e_k) at −Im (C_0k e_k) q̇_k.
        PerDrive::from_fn(n, |k| {
            let arm: f64 = (0..n).map(|l| -self.coupling(e, k, l).im * (qd[l] - qd[k])).sum();
            arm - (self.base[k] * e[k]).im * qd[k]
        })
    }

    /// Returns Z_kl = C_kl e^{i (q_l − q_k)}, kg m².
    #[inline]
    pub fn coupling(&self, e: &UnitVectors, k: usize, l: usize) -> Vector {
        self.arm.coupling(k, l) * (e[k].conj() * e[l])
    }

    /// Returns whether no motion of the arm has angular momentum.
    pub fn is_zero(&self) -> bool {
        let (n, arm) = (self.drives(), &self.arm);
        let bound = BALANCE_TOLERANCE * arm.diagonals().iter().sum::<f64>();
        arm.momenta().max_abs() <= bound
            && Inertia::pairs(n).all(|(k, l)| arm.coupling(k, l).norm() <= bound)
            && self.base[..n].iter().all(|c| c.norm() <= bound)
    }
}
