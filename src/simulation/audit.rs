//! [`Audit`]: what should be zero in every run, measured all the time.
//!
//! | figure | what is compared |
//! |---|---|
//! | momentum | that of the manipulator, from its rates, with −∫ f_B dt, from its accelerations |
//! | angular | its angular momentum about the origin with −∫ (n_B + p_B × f_B) dt |
//! | energy | what is there with what motors, wheel and outer force brought and friction took |
//! | closure | the two points of every pin that closes a loop |
//! | step | moment that the base feels, f_B, torques and end effector, from two ways to take a step, by their peaks |
//! | plane | b with the b that was aimed at |

use super::peaks::Peaks;
use super::totals::Totals;

/// What should be zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Audit {
    /// kg m/s.
    pub momentum: f64,
    /// kg m²/s.
    pub angular: f64,
    /// J.
    pub energy: f64,
    /// m.
    pub closure: f64,
    /// Error of what is shown, as a share of its peak.
    pub step: f64,
    /// b − b_ref, rad: the plant's own, not an error of the simulation.
    pub plane: f64,
}

/// One figure of an audit beside what it may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuditFigure {
    /// One or two words.
    pub name: &'static str,
    /// What it compares.
    pub meaning: &'static str,
    /// How far it is from zero.
    pub value: f64,
    /// How far it may be; `None` for a figure that only tells.
    pub limit: Option<f64>,
    /// SI unit.
    pub unit: &'static str,
}

impl AuditFigure {
    /// Whether the figure is where it should be; one that is no number never is.
    pub fn is_good(&self) -> bool {
        self.limit.is_none_or(|limit| self.value <= limit)
    }
}

/// How much of what has moved may be missing.
const SHARE: f64 = 1e-5;

/// How far what is shown may be off, as a share of its peak.
const STEP: f64 = 1e-3;

impl Audit {
    /// Every figure beside what it may be, by the measure of what the run has moved.
    pub fn figures(&self, peaks: &Peaks, totals: &Totals) -> [AuditFigure; 6] {
        let time = totals.time.max(1e-3);
        let pull = (peaks.inertial_pull * time).max(1e-6);
        let turn = (peaks.torque_sum * time).max(1e-6);
        let energy = totals.energy.max(1e-3);
        let lamp =
            |name, meaning, value: f64, limit, unit| AuditFigure { name, meaning, value: value.abs(), limit, unit };
        [
            lamp("momentum", "momentum + ∫ f_B dt", self.momentum, Some(SHARE * pull), "kg m/s"),
            lamp("angular", "angular momentum + ∫ n_B dt", self.angular, Some(SHARE * turn), "kg m²/s"),
            lamp("energy", "energy − work + losses", self.energy, Some(SHARE * energy), "J"),
            lamp("loops", "pins that close loops", self.closure, Some(1e-8), "m"),
            lamp("step", "error of moment, force, torques, end effector", self.step, Some(STEP), "of the peak"),
            lamp("plane", "b − b aimed at", self.plane, None, "rad"),
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
