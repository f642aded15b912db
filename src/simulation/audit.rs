//! [`Audit`]: conservation and error figures that should be zero, computed at every instant of a run.
//!
//! | figure | compared quantities |
//! |---|---|
//! | momentum | linear momentum of the manipulator, from its rates, with −∫ f_B dt, from its accelerations |
//! | angular | its angular momentum about the origin with −∫ (n_B + p_B × f_B) dt |
//! | energy | energy of the plant with the work of motors, wheel and outer force less the losses |
//! | closure | positions of the two points of every pin that closes a loop |
//! | step | moment on the base, f_B, torques and end effector of two integrations of a step, relative to scales |
//! | plane | b with the reference of b |

use super::peaks::Peaks;
use super::totals::Totals;

/// Figures that should be zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Audit {
    /// Imbalance of linear momentum, kg m/s.
    pub momentum: f64,
    /// Imbalance of angular momentum, kg m²/s.
    pub angular: f64,
    /// Imbalance of energy, J.
    pub energy: f64,
    /// Maximum gap of a pin that closes a loop, m.
    pub closure: f64,
    /// Integration error of the displayed quantities, relative to their peaks; positions, to 1 % of the arm length.
    pub step: f64,
    /// b − b_ref, rad: a deviation of the plant, not an error of the simulation.
    pub plane: f64,
}

/// A figure of an audit with its tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuditFigure {
    /// Name, one or two words.
    pub name: &'static str,
    /// Compared quantities, in words.
    pub meaning: &'static str,
    /// Magnitude of the figure.
    pub value: f64,
    /// Tolerance of the figure; `None` if the figure is only informative.
    pub limit: Option<f64>,
    /// SI unit.
    pub unit: &'static str,
}

impl AuditFigure {
    /// Returns whether the figure is within its tolerance, or has none. NaN is never within a tolerance.
    pub fn is_within_tolerance(&self) -> bool {
        self.limit.is_none_or(|limit| self.value <= limit)
    }
}

/// Tolerance of the imbalances, as a fraction of the exchanged momentum or energy.
const IMBALANCE_TOLERANCE: f64 = 1e-5;

/// Tolerance of the integration error, as a fraction of the peaks.
const STEP_TOLERANCE: f64 = 1e-3;

impl Audit {
    /// Returns every figure with its tolerance. Tolerances of imbalances scale with the peaks and totals of the run.
    pub fn figures(&self, peaks: &Peaks, totals: &Totals) -> [AuditFigure; 6] {
        let time = totals.time.max(1e-3);
        let pull = (peaks.inertial_pull * time).max(1e-6);
        let turn = (peaks.torque_sum * time).max(1e-6);
        let energy = totals.energy.max(1e-3);
        let figure =
            |name, meaning, value: f64, limit, unit| AuditFigure { name, meaning, value: value.abs(), limit, unit };
        [
            figure("momentum", "momentum + ∫ f_B dt", self.momentum, Some(IMBALANCE_TOLERANCE * pull), "kg m/s"),
            figure("angular", "angular momentum + ∫ n_B dt", self.angular, Some(IMBALANCE_TOLERANCE * turn), "kg m²/s"),
            figure("energy", "energy − work + losses", self.energy, Some(IMBALANCE_TOLERANCE * energy), "J"),
            figure("loops", "pins that close loops", self.closure, Some(1e-8), "m"),
            figure(
                "step",
                "error of moment, force, torques, end effector",
                self.step,
                Some(STEP_TOLERANCE),
                "of the peak",
            ),
            figure("plane", "b − b aimed at", self.plane, None, "rad"),
        ]
    }
}

impl std::fmt::Display for AuditFigure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {} is {:.1e} {}", self.name, self.meaning, self.value, self.unit)?;
        match self.limit {
            Some(limit) => write!(f, ", want at most {limit:.1e}"),
            None => Ok(()),
        }
    }
}
