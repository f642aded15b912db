//! How far the end effector of three drives goes along straight rays from a pose: at zero angular momentum, and on from
//! there with least momentum, until a free base has turned by given angles. What is reached depends on the path.
//!
//! # Source
//! The poses of zero momentum along a ray of direction u have (q′, s′) with J q′ = u s′, D q′ = 0: by Cramer's rule s′ =
//! det[J; D] and q′ = u_x (J_y × D) + u_y (D × J_x). This field is smooth where the determinant vanishes; s then has its
//! maximum, and the ray ends.

use nalgebra::Vector3;
use thiserror::Error;

use super::drift::Singularity;
use super::flow::Flow;
use super::least_momentum::least_rates;
use super::momentum::MomentumModel;
use stillbase_mechanics::kinematics::column;
use stillbase_mechanics::machine::RelativeAngle;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase_settings::number::counted;

/// Why a ray ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RayStop {
    /// No rates lead on.
    Singular(Singularity),
    /// A relative angle is at its limit.
    Limit {
        /// Its index, from 0.
        angle: usize,
        /// Whether the limit is the upper one.
        upper: bool,
    },
    /// The base has turned as far as it may.
    Turn,
    /// The drives turn on and on, and the end effector comes no farther.
    Winding,
}

/// End of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayEnd {
    /// Distance from the start, m.
    pub distance: f64,
    /// Why it ends there.
    pub stop: RayStop,
    /// Drive angles there, seen from the base, rad.
    pub pose: DriveAngles,
}

/// Drives may turn by this much along a ray, rad.
const MAX_WINDING: f64 = 200.0;
/// Relative angles may exceed their limits by this much, rad.
const LIMIT_TOLERANCE: f64 = 1e-9;
/// The arm counts as outstretched if √det(J Jᵀ) is below this fraction of its squared length.
const STRETCHED: f64 = 1e-6;

/// Rays of the end effector from a pose of three drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Rays {
    model: MomentumModel,
    angles: Vec<RelativeAngle>,
    start: DriveAngles,
}

/// Why there are no rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NoRays {
    /// The machine has another number of drives.
    #[error("{}: three drives have one motion of least momentum along a ray; want a machine of three", counted(*.0, "drive"))]
    Drives(usize),
    /// No motion of the machine has angular momentum.
    #[error(
        "no motion of this machine has angular momentum, so it reaches all that its joints permit: want another one"
    )]
    Silent,
}

impl Rays {
    /// Returns the rays of a machine with these relative angles from a pose.
    ///
    /// # Errors
    /// Unless the machine has three drives, and motions with angular momentum.
    pub fn new(model: MomentumModel, angles: &[RelativeAngle], start: DriveAngles) -> Result<Self, NoRays> {
        match model.drives() {
            3 if model.is_zero() => Err(NoRays::Silent),
            3 => Ok(Self { model, angles: angles.to_vec(), start }),
            drives => Err(NoRays::Drives(drives)),
        }
    }

    /// Returns the arm and its base.
    pub fn model(&self) -> &MomentumModel {
        &self.model
    }

    /// Returns the relative angles of the machine.
    pub fn angles(&self) -> &[RelativeAngle] {
        &self.angles
    }

    /// Returns the pose from which they go.
    pub fn start(&self) -> &DriveAngles {
        &self.start
    }

    /// Returns where rays in direction u, of length 1, end: at each turn of the base, rad, in rising order.
    pub fn ends(&self, u: Vector, turns: &[f64]) -> Vec<RayEnd> {
        let silent = self.silent(u);
        let crosses = turns.last().is_some_and(|most| *most > 0.0) && self.model.floats();
        let beyond = if crosses { self.crossing(u, turns) } else { Vec::new() };
        // A crossing lets momentum in somewhat before the singularity, to which silent rates lead too.
        let farther = |i: usize| beyond.get(i).copied().flatten().filter(|end| end.distance > silent.distance);
        (0..turns.len()).map(|i| farther(i).unwrap_or(silent)).collect()
    }

    /// Returns how far relative angles exceed their limits at most, rad, with the limit.
    fn excess(&self, q: &PerDrive) -> (f64, RayStop) {
        let past = self.angles.iter().enumerate().flat_map(|(angle, a)| {
            let at = a.value(q);
            [(a.limits.start() - at, false), (at - a.limits.end(), true)]
                .map(|(by, upper)| (by - LIMIT_TOLERANCE, RayStop::Limit { angle, upper }))
        });
        past.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((-1.0, RayStop::Winding))
    }

    /// Returns where silent rates lead no farther.
    fn silent(&self, u: Vector) -> RayEnd {
        let (model, reach) = (&self.model, self.model.reach());
        let field = |x: &[f64; 4]| {
            let e = pose(x).units();
            let (d, tip) = (model.coefficients(&e), model.tip_units(&e));
            let j = [0, 1, 2].map(|k| column(model.tip(), &tip, k) / reach);
            let (rx, ry) = (Vector3::from(j.map(|j| j.re)), Vector3::from(j.map(|j| j.im)));
            let d = Vector3::new(d[0], d[1], d[2]).normalize();
            let (q, s) = (u.re * ry.cross(&d) + u.im * d.cross(&rx), rx.cross(&ry).dot(&d));
            // Angles in rad and fractions of the reach count alike.
            let size = (q.norm_squared() + s * s).sqrt();
            (size > 0.0).then(|| [q.x / size, q.y / size, q.z / size, s * reach / size])
        };
        let start = [self.start[0], self.start[1], self.start[2], 0.0];
        let nowhere =
            RayEnd { distance: 0.0, stop: RayStop::Singular(Singularity::near(model, &self.start)), pose: self.start };
        let Some(begin) = field(&start).filter(|begin| begin[3] != 0.0) else { return nowhere };
        let sense = begin[3].signum();
        let flow = Flow { field: |x: &[f64; 4]| field(x).map(|f| f.map(|f| sense * f)), scale: [1.0, 1.0, 1.0, reach] };
        let back = |x: &[f64; 4]| field(x).map_or(1.0, |f| -sense * f[3]);
        let (mut x, mut h, mut gone) = (start, 0.05, 0.0);
        while gone < MAX_WINDING {
            let singular = |x: &[f64; 4]| RayStop::Singular(Singularity::near(model, &pose(x)));
            let Some(step) = flow.step(&x, f64::min(h, 0.1)) else {
                return ray_end(&x, x[3], singular(&x));
            };
            let at_limit = flow.event(&x, &step, |x| self.excess(&pose(x).0).0);
            let at_fold = flow.event(&x, &step, back);
            let ends = [
                at_limit.map(|at| ray_end(&at, at[3], self.excess(&pose(&at).0).1)),
                at_fold.map(|at| ray_end(&at, at[3], singular(&at))),
            ];
            if let Some(end) = ends.into_iter().flatten().min_by(|a, b| a.distance.total_cmp(&b.distance)) {
                return end;
            }
            (x, h) = (step.end, step.next);
            gone += step.length;
        }
        ray_end(&x, x[3], RayStop::Winding)
    }

    /// Returns where rates of least momentum have turned the base by each of given angles, or lead no farther; `None` for
    /// an angle of 0.
    fn crossing(&self, u: Vector, turns: &[f64]) -> Vec<Option<RayEnd>> {
        let (model, reach) = (&self.model, self.model.reach());
        // Rates grow without bound as the arm becomes straight; those per unit of this parameter do not.
        let slow = |x: &[f64; 5]| {
            let rates = least_rates(model, &pose(x), x[3], u)?;
            let by = rates.dexterity / (reach * reach);
            let q = rates.rates.scaled(by * reach);
            Some([q[0], q[1], q[2], rates.turn * by * reach, by * reach])
        };
        let flow = Flow { field: slow, scale: [1.0, 1.0, 1.0, 1.0, reach] };
        let straight = |x: &[f64; 5]| {
            let rates = least_rates(model, &pose(x), x[3], u);
            rates.map_or(1.0, |rates| STRETCHED - rates.dexterity / (reach * reach))
        };
        let mut ends: Vec<Option<RayEnd>> = vec![None; turns.len()];
        let (mut x, mut h, mut gone) = ([self.start[0], self.start[1], self.start[2], 0.0, 0.0], 0.05, 0.0);
        let mut rest = |from: usize, end: RayEnd| ends[from..].iter_mut().for_each(|e| *e = Some(end));
        let mut next = turns.iter().take_while(|turn| **turn <= 0.0).count();
        while next < turns.len() {
            let singular = |x: &[f64; 5]| RayStop::Singular(Singularity::near(model, &pose(x)).with_base());
            if gone >= MAX_WINDING {
                rest(next, ray_end(&x, x[4], RayStop::Winding));
                break;
            }
            let Some(step) = flow.step(&x, f64::min(h, 0.2)) else {
                rest(next, ray_end(&x, x[4], singular(&x)));
                break;
            };
            let at_limit = flow.event(&x, &step, |x| self.excess(&pose(x).0).0);
            let at_straight = flow.event(&x, &step, straight);
            let last = [
                at_limit.map(|at| ray_end(&at, at[4], self.excess(&pose(&at).0).1)),
                at_straight.map(|at| ray_end(&at, at[4], singular(&at))),
            ];
            let last = last.into_iter().flatten().min_by(|a, b| a.distance.total_cmp(&b.distance));
            while let Some(turn) = turns.get(next) {
                let Some(at) = flow.event(&x, &step, |x| x[3].abs() - turn) else { break };
                if last.is_some_and(|last| at[4] > last.distance) {
                    break;
                }
                rest(next, ray_end(&at, at[4], RayStop::Turn));
                next += 1;
            }
            if let Some(last) = last {
                rest(next, last);
                break;
            }
            gone += pose(&step.end).0.minus(&pose(&x).0).max_abs();
            (x, h) = (step.end, step.next);
        }
        ends
    }
}

fn ray_end<const N: usize>(x: &[f64; N], distance: f64, stop: RayStop) -> RayEnd {
    RayEnd { distance, stop, pose: pose(x) }
}

/// Returns the pose in a state.
fn pose<const N: usize>(x: &[f64; N]) -> DriveAngles {
    DriveAngles::from([x[0], x[1], x[2]])
}
