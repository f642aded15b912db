//! [`MeasurementSet`]: the measured data.

use super::error::TrimError;
use stillbase_mechanics::planar::{PerDrive, Vector};

/// Samples of one motion. All lists have one entry per time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredMotion {
    /// Times, s, ascending.
    pub t: Vec<f64>,
    /// Absolute drive angles, unwrapped, rad.
    pub q: Vec<PerDrive>,
    /// Rates, rad/s; empty if not measured.
    pub qd: Vec<PerDrive>,
    /// Accelerations, rad/s²; empty if not measured.
    pub qdd: Vec<PerDrive>,
    /// Force on the base, N.
    pub force: Vec<Vector>,
    /// Moment on the base about B, N m.
    pub moment: Vec<f64>,
}

impl MeasuredMotion {
    /// Returns the time from the first sample to the last, s.
    pub fn duration(&self) -> f64 {
        self.t.last().unwrap_or(&0.0) - self.t.first().unwrap_or(&0.0)
    }

    fn inconsistency(&self, drives: usize) -> Option<&'static str> {
        let n = self.t.len();
        let optional = |list: &[PerDrive]| list.is_empty() || list.len() == n;
        let lengths = [self.q.len(), self.force.len(), self.moment.len()].iter().all(|own| *own == n);
        if n == 0 || !lengths || !optional(&self.qd) || !optional(&self.qdd) {
            return Some("lists of different lengths, or none: want one entry for each time");
        }
        let lists = || self.q.iter().chain(&self.qd).chain(&self.qdd);
        if lists().any(|x| x.len() != drives) {
            return Some("angles of another number of drives: want one for each drive of the machine");
        }
        let numbers = lists().flat_map(|x| x.iter()).chain(&self.t).chain(&self.moment);
        if !numbers.chain(self.force.iter().flat_map(|f| [&f.re, &f.im])).all(|x| x.is_finite()) {
            return Some("what is no finite number: want numbers throughout");
        }
        let rising = self.t.windows(2).all(|w| w[1] > w[0]);
        (!rising).then_some("times that do not rise: want each later than the one before")
    }
}

/// Measured motions of one machine on a fixed base.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasurementSet {
    /// Motions, each with its own offset and drift of the sensors.
    pub motions: Vec<MeasuredMotion>,
}

impl MeasurementSet {
    /// Returns whether every motion has rates and accelerations.
    pub fn has_accelerations(&self) -> bool {
        self.motions.iter().all(|motion| !motion.qdd.is_empty() && !motion.qd.is_empty())
    }

    /// Checks that the recording can be used for a machine with a number of drives.
    ///
    /// # Errors
    /// Fails with the first inconsistency found.
    pub fn check(&self, drives: usize) -> Result<(), TrimError> {
        for (motion, of) in self.motions.iter().enumerate() {
            if let Some(got) = of.q.first().map(|q| q.len()).filter(|got| *got != drives) {
                return Err(TrimError::Drives { got, want: drives });
            }
            if let Some(what) = of.inconsistency(drives) {
                return Err(TrimError::Motion { motion, what });
            }
        }
        match self.motions.is_empty() {
            true => Err(TrimError::TooFew { rows: 0, unknowns: Self::unknowns(drives) }),
            false => Ok(()),
        }
    }

    /// Returns the number of unknowns of a machine with n drives: 2n of first moments, n(n − 1) of couplings, n
    /// momenta.
    fn unknowns(drives: usize) -> usize {
        drives * (drives + 2)
    }
}
