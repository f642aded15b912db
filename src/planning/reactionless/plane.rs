//! Plane coordinates (a_1, a_2, b) of joint space, the map to the end effector, and its inverse on a plane.

use std::f64::consts::TAU;

use nalgebra::{Complex, Matrix3, Vector3};
use thiserror::Error;

use stillbase_mechanics::planar::{Vector, cross, unit};

/// Bounds of a relative joint angle, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleLimit {
    /// Least angle.
    pub min: f64,
    /// Greatest angle.
    pub max: f64,
}

impl AngleLimit {
    /// Whether an angle lies within the bounds widened by `slack`, rad.
    pub fn contains(&self, angle: f64, slack: f64) -> bool {
        angle >= self.min - slack && angle <= self.max + slack
    }
}

/// Definition of a relative angle: a = q_to − q_from + offset, with drives counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleDefinition {
    /// The drive whose angle is added.
    pub to: usize,
    /// The drive whose angle is subtracted.
    pub from: usize,
    /// Constant offset, rad.
    pub offset: f64,
}

/// A point of joint space in plane coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanePoint {
    /// (a_1, a_2), rad.
    pub a: [f64; 2],
    /// b, rad.
    pub b: f64,
}

/// The coordinate map of a machine, Eqs (13)–(16).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneMap {
    c: [f64; 3],
    lambda: [f64; 3],
    angles: [AngleDefinition; 2],
    limits: [AngleLimit; 2],
    lambda_sum: f64,
    u: [[f64; 2]; 3],
    v: [f64; 3],
    unit: f64,
}

/// Why a machine has no plane coordinates.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NotAPlaneMap {
    /// The two relative angles do not determine the differences of all three drives.
    #[error(
        "the relative joint angles do not determine the pose on a plane: want two angles that join all three drives"
    )]
    Dependent,
    /// A number is not finite, Σλ is not above 0, or limits are not in order.
    #[error("λ, lengths, offsets and limits must be finite, with Σλ above 0 and min ≤ max")]
    OutOfRange,
    /// The range of an angle contains too many whole turns, which are counted one by one.
    #[error("a{} may turn by {width:.2} rad: want limits at most eight turns apart, {} rad", .angle + 1, MAX_LIMIT_RANGE)]
    TooWide {
        /// Which angle: 0 for a_1, 1 for a_2.
        angle: usize,
        /// max − min, rad.
        width: f64,
    },
    /// The reach is too small or too large for its squares and cubes in floating point.
    #[error("the arms reach {reach:.3e} m: want a reach of 1e-9 to 1e9 m")]
    Size {
        /// Reach Σ |c_k|, m.
        reach: f64,
    },
    /// Rounding errors of the longest arm would exceed the effect of the shorter ones.
    #[error(
        "the arms are {:.3e}, {:.3e} and {:.3e} m long, with λ {:.3e}, {:.3e} and {:.3e}: a reactionless workspace \
         so much narrower than its radius is lost in rounding; want arms of more equal length",
        .arms[0], .arms[1], .arms[2], .lambda[0], .lambda[1], .lambda[2]
    )]
    Uneven {
        /// Arm lengths |c_k|, m.
        arms: [f64; 3],
        /// λ_k.
        lambda: [f64; 3],
    },
}

/// Below this fraction of the squared reach, |det| is too small for curves to be distinguished.
const MIN_DET: f64 = 1e-5;
/// Below this fraction, |det| is treated as zero.
const ZERO_DET: f64 = 1e-15;

/// Maximum distance between the limits of an angle, rad: slightly more than eight turns, so that ±4 turns are allowed.
pub const MAX_LIMIT_RANGE: f64 = 50.4;

impl PlaneMap {
    /// Checks these numbers and returns their map.
    ///
    /// # Errors
    /// If a number is out of range, the arms are too uneven, or (a_1, a_2, b) does not determine q.
    pub fn new(
        c: [f64; 3],
        lambda: [f64; 3],
        angles: [AngleDefinition; 2],
        limits: [AngleLimit; 2],
    ) -> Result<Self, NotAPlaneMap> {
        let lambda_sum: f64 = lambda.iter().sum();
        let finite = c.iter().chain(&lambda).all(|x| x.is_finite())
            && angles.iter().all(|a| a.offset.is_finite() && a.to < 3 && a.from < 3)
            && limits.iter().all(|l| l.min.is_finite() && l.max.is_finite() && l.min <= l.max);
        if !finite || lambda_sum.partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater) {
            return Err(NotAPlaneMap::OutOfRange);
        }
        let mut rows = Matrix3::zeros();
        for (i, a) in angles.iter().enumerate() {
            rows[(i, a.to)] += 1.0;
            rows[(i, a.from)] -= 1.0;
        }
        rows.set_row(2, &nalgebra::RowVector3::from_row_slice(&lambda));
        let inverse = rows.try_inverse().ok_or(NotAPlaneMap::Dependent)?;
        if inverse.iter().any(|x| !x.is_finite()) {
            return Err(NotAPlaneMap::Dependent);
        }
        let offset = inverse * Vector3::new(angles[0].offset, angles[1].offset, 0.0);
        let u = [0, 1, 2].map(|k| [inverse[(k, 0)], inverse[(k, 1)]]);
        let v = [0, 1, 2].map(|k| -offset[k]);
        let reach: f64 = c.iter().map(|c| c.abs()).sum();
        if reach != 0.0 && !(1e-9..=1e9).contains(&reach) {
            return Err(NotAPlaneMap::Size { reach });
        }
        let unit = if reach > 0.0 { reach.log2().floor().exp2() } else { 1.0 };
        // Maximum of |det| as a fraction of the squared reach; 0 within rounding if arms turn as one.
        let pair = |[k, l]: [usize; 2]| (c[k] * c[l] * (u[k][0] * u[l][1] - u[k][1] * u[l][0])).abs();
        let most = [[0, 1], [1, 2], [0, 2]].map(pair).into_iter().fold(0.0, f64::max) / (reach * reach);
        if (ZERO_DET..MIN_DET).contains(&most) {
            return Err(NotAPlaneMap::Uneven { arms: c.map(f64::abs), lambda });
        }
        Self { c, lambda, angles, limits, lambda_sum, u, v, unit }.with_limits(limits)
    }

    /// Returns the arms c_k, m.
    pub fn c(&self) -> [f64; 3] {
        self.c
    }

    /// Returns the weights λ_k of b = Σ_k λ_k q_k, (13).
    pub fn lambda(&self) -> [f64; 3] {
        self.lambda
    }

    /// Returns Σλ.
    pub fn lambda_sum(&self) -> f64 {
        self.lambda_sum
    }

    /// Returns u_k of q_k = b* + u_k · a + v_k.
    pub fn u(&self) -> [[f64; 2]; 3] {
        self.u
    }

    /// Returns v_k of the same equation, rad.
    pub fn v(&self) -> [f64; 3] {
        self.v
    }

    /// Returns the definitions of a_1 and a_2.
    pub fn angles(&self) -> [AngleDefinition; 2] {
        self.angles
    }

    /// Returns the bounds of a_1 and a_2.
    pub fn limits(&self) -> [AngleLimit; 2] {
        self.limits
    }

    /// Returns the same map with other bounds.
    ///
    /// # Errors
    /// If they are not finite and ordered, or more than [`MAX_LIMIT_RANGE`] apart.
    pub fn with_limits(mut self, limits: [AngleLimit; 2]) -> Result<Self, NotAPlaneMap> {
        for (angle, AngleLimit { min, max }) in limits.into_iter().enumerate() {
            if !(min.is_finite() && max.is_finite() && min <= max) {
                return Err(NotAPlaneMap::OutOfRange);
            }
            if max - min > MAX_LIMIT_RANGE {
                return Err(NotAPlaneMap::TooWide { angle, width: max - min });
            }
        }
        self.limits = limits;
        Ok(self)
    }

    /// Returns a power of two near the reach of the arms, m: the unit of tolerances.
    pub(crate) fn unit(&self) -> f64 {
        self.unit
    }

    /// Returns the period of b, 2π Σλ, rad: one turn of all drives adds it to b and changes nothing else.
    pub fn period(&self) -> f64 {
        TAU * self.lambda_sum
    }

    /// Returns b* = b/Σλ, the angle of the workspace, rad, (15).
    pub fn turn(&self, b: f64) -> f64 {
        b / self.lambda_sum
    }

    /// Returns the drive angles of a point, rad: q_k = b* + u_k · a + v_k, (15). Never wrapped.
    #[inline]
    pub fn lift(&self, at: PlanePoint) -> [f64; 3] {
        let turn = self.turn(at.b);
        [0, 1, 2].map(|k| turn + self.local(k, at.a))
    }

    /// Returns the drive rates for rates (ȧ_1, ȧ_2) and ḃ, in their unit.
    #[inline]
    pub fn lift_rates(&self, ad: [f64; 2], bd: f64) -> [f64; 3] {
        let turn = self.turn(bd);
        [0, 1, 2].map(|k| turn + self.u[k][0] * ad[0] + self.u[k][1] * ad[1])
    }

    /// Returns the plane coordinates of drive angles; the inverse of [`lift`](Self::lift).
    #[inline]
    pub fn project(&self, q: &[f64]) -> PlanePoint {
        PlanePoint {
            a: self.angles.map(|a| q[a.to] - q[a.from] + a.offset),
            b: self.lambda.iter().zip(q).map(|(l, q)| l * q).sum(),
        }
    }

    /// Returns (ȧ_1, ȧ_2) and ḃ for drive rates, in their unit.
    pub fn project_rates(&self, qd: &[f64]) -> ([f64; 2], f64) {
        let ad = self.angles.map(|a| qd[a.to] - qd[a.from]);
        (ad, self.lambda.iter().zip(qd).map(|(l, q)| l * q).sum())
    }

    #[inline]
    fn local(&self, k: usize, a: [f64; 2]) -> f64 {
        self.u[k][0] * a[0] + self.u[k][1] * a[1] + self.v[k]
    }

    /// Returns c_k e^{i (u_k · a + v_k)}, m: the arms at b = 0.
    #[inline]
    pub fn arms(&self, a: [f64; 2]) -> [Vector; 3] {
        [0, 1, 2].map(|k| self.c[k] * unit(self.local(k, a)))
    }

    /// Returns the position of the end effector from B at b = 0, m, (16).
    #[inline]
    pub fn forward_unturned(&self, a: [f64; 2]) -> Vector {
        self.arms(a).iter().sum()
    }

    /// Returns the position of the end effector from B, m, (16).
    #[inline]
    pub fn forward(&self, a: [f64; 2], b: f64) -> Vector {
        self.forward_unturned(a) * unit(self.turn(b))
    }

    /// Returns ∂p/∂a_1 and ∂p/∂a_2 at b = 0, m, for arms at b = 0.
    #[inline]
    pub fn columns(&self, arms: &[Vector; 3]) -> [Vector; 2] {
        let i = Complex::new(0.0, 1.0);
        [0, 1].map(|j| i * (0..3).map(|k| arms[k] * self.u[k][j]).sum::<Vector>())
    }

    /// Returns det ∂(x, y)/∂(a_1, a_2), m²: a sum of sines of the angles between the arms, the same for every b.
    #[inline]
    pub fn det(&self, a: [f64; 2]) -> f64 {
        let [first, second] = self.columns(&self.arms(a));
        cross(first, second)
    }

    /// Returns the pose on the plane b that puts the end effector on p, m, continuously from the pose `from`. Newton's
    /// iteration in (a_1, a_2) must stay on one sheet, where det keeps its sign, and end within the limits; otherwise
    /// the result is `None`.
    pub fn follow(&self, p: Vector, b: f64, from: [f64; 2]) -> Option<[f64; 2]> {
        let goal = p * unit(-self.turn(b));
        let mut a = from;
        let sheet = self.det(from);
        for _ in 0..24 {
            let arms = self.arms(a);
            let gap = goal - arms.iter().sum::<Vector>();
            let [first, second] = self.columns(&arms);
            let det = cross(first, second);
            if det * sheet < 0.0 {
                return None;
            }
            let step = [cross(gap, second) / det, cross(first, gap) / det];
            let length = step[0].hypot(step[1]);
            if !length.is_finite() {
                return None;
            }
            // Steps are limited to 0.5 rad, so that they do not skip to another sheet.
            let scale = (0.5 / length).min(1.0);
            a = [a[0] + scale * step[0], a[1] + scale * step[1]];
            if length < 1e-14 || (length < 1e-9 && gap.norm_sqr() < 1e-28 * self.unit * self.unit) {
                break;
            }
        }
        let miss = (goal - self.forward_unturned(a)).norm();
        let inside = (0..2).all(|i| self.limits[i].contains(a[i], LIMIT_SLACK));
        (miss < 1e-11 * self.unit && inside && self.det(a) * sheet >= 0.0).then(|| self.clamp(a))
    }

    /// Returns the nearest pose within the limits.
    pub fn clamp(&self, a: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| a[i].clamp(self.limits[i].min, self.limits[i].max))
    }
}

/// Tolerance of joint limits, rad: the rounding error of the inverse kinematics at the boundary.
pub const LIMIT_SLACK: f64 = 1e-9;
