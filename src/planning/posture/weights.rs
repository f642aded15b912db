//! [`PostureWeights`]: weights of motor torques and of joint ranges.

use nalgebra::SMatrix;

use super::goal::WeightMatrix;
use crate::pose_space::PoseSpace;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive};

/// Weight added to each drive, as a fraction of the trace, so that rates stay finite for a drive without inertia.
const MIN_DRIVE_WEIGHT: f64 = 1e-9;

/// Weights of a machine's drives.
#[derive(Clone, Debug)]
pub struct PostureWeights<'a> {
    space: &'a PoseSpace,
    /// TᵀT divided by its trace, plus `MIN_DRIVE_WEIGHT` on the diagonal; T q̈ is the motor torque at rest, g = 0.
    pub(super) torque: WeightMatrix,
    /// ∂x_i/∂q_k, 1/rad; [`off_middle`](Self::off_middle) defines x_i.
    shares: Vec<PerDrive>,
}

impl<'a> PostureWeights<'a> {
    /// Returns the weights of a machine with its pose space.
    pub fn of(machine: &Machine, space: &'a PoseSpace) -> Self {
        let n = machine.drives();
        let inertia = Inertia::of(machine);
        let one = |k: usize| PerDrive::from_fn(n, |l| f64::from(u8::from(k == l)));
        let torques: Vec<PerDrive> =
            (0..n).map(|l| inertia.motors().motor_torques(&PerDrive::from_fn(n, |k| inertia.constant(k, l)))).collect();
        let trace: f64 = torques.iter().map(|column| column.dot(column)).sum();
        let mut torque = [[0.0; MAX_DRIVES]; MAX_DRIVES];
        for (k, row) in torque.iter_mut().enumerate().take(n) {
            (0..n).for_each(|l| row[l] = torques[k].dot(&torques[l]) / trace);
            row[k] += MIN_DRIVE_WEIGHT;
        }
        let turned: Vec<PerDrive> = (0..n).map(|k| space.angle_rates(&one(k))).collect();
        let half = |i: usize| half_range(space, i);
        let shares = (0..space.joints().len()).map(|i| PerDrive::from_fn(n, |k| turned[k][i] / half(i))).collect();
        Self { space, torque, shares }
    }

    /// Returns the inverse of the matrix `torque`; `None` if that is singular.
    pub fn least_torque(&self) -> Option<[[f64; MAX_DRIVES]; MAX_DRIVES]> {
        let n = self.space.drives();
        let weigh = |k: usize, l: usize| if k < n && l < n { self.torque[k][l] } else { f64::from(u8::from(k == l)) };
        let inverse = SMatrix::<f64, MAX_DRIVES, MAX_DRIVES>::from_fn(weigh).try_inverse()?;
        let sound = inverse.iter().all(|x| x.is_finite());
        sound.then(|| {
            std::array::from_fn(|k| std::array::from_fn(|l| if k < n && l < n { inverse[(k, l)] } else { 0.0 }))
        })
    }

    /// Returns ½ Σ x_i², where x_i is the deviation of a relative angle from its midpoint, as a fraction of half its
    /// range.
    pub fn off_middle(&self, q: &DriveAngles) -> f64 {
        let (a, middle) = (self.space.angles(q), self.space.middle());
        (0..a.len()).map(|i| 0.5 * ((a[i] - middle[i]) / half_range(self.space, i)).powi(2)).sum()
    }

    /// Returns the Hessian ∂²/∂q_k∂q_l of ½ Σ x².
    pub(super) fn ranges(&self) -> WeightMatrix {
        std::array::from_fn(|k| {
            std::array::from_fn(|l| {
                let inside = k < self.space.drives() && l < self.space.drives();
                if inside { self.shares.iter().map(|share| share[k] * share[l]).sum() } else { 0.0 }
            })
        })
    }
}

/// Returns half the range of relative angle i, rad; infinite if it has no limits.
fn half_range(space: &PoseSpace, i: usize) -> f64 {
    let [low, high] = space.joints()[i].bounds();
    if low.is_finite() { 0.5 * (high - low).max(1e-6) } else { f64::INFINITY }
}
