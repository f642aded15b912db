//! A base that springs and dampers hold in all six directions, driven by the motion of its blocks.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | r, φ | place of the origin of the base from where it rests, and rotation vector of its attitude | m, rad |
//! | x | (r, φ), in axes of space, which are those of the base at rest | |
//! | v, ω | velocity of the origin in axes of space, rate of the base in its own | m/s, rad/s |
//! | K, D | stiffness and damping, six by six | N/m, N, N m/rad; N s/m, N s, N m s |
//! | x_0 | preload: what the springs exert at x = 0 | N, N m |
//! | T(φ) | φ̇ = T(φ) ω in axes of space | |
//!
//! # Closed form
//! The springs have the energy ½ xᵀ K x − x_0ᵀ x. So at the origin they exert the force (x_0 − K x)_r and the moment
//! T(φ)ᵀ (x_0 − K x)_φ, exactly, however far the base turns. The dampers exert −D (v, ω). With the weight these change the
//! momenta of base and blocks, see [`MovingBase`].
//!
//! # Assumptions
//! The base turns by less than half a turn from where it rests.

use nalgebra::{Matrix3, Matrix6, SVector, Vector3, Vector6};

use super::free_base::{Attitude, SpatialBase};
use super::model::{Assembly, MAX_BLOCKS};
use super::motion::{BlockState, SpatialWrench};
use super::moving_base::MovingBase;
use super::stepping;
use stillbase_settings::number::ShortNumber;

/// Largest difference of two entries that should be equal, as a fraction of the largest entry.
const ROUNDING: f64 = 1e-9;

/// Below this angle, rad, the series of T(φ) is exact to rounding.
const SMALL_ANGLE: f64 = 1e-3;

/// Springs and dampers between base and ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Compliance {
    stiffness: Matrix6<f64>,
    damping: Matrix6<f64>,
    /// x_0, N and N m, in axes of space: what the springs exert where x = 0.
    pub preload: Vector6<f64>,
}

/// Why numbers are no stiffness or damping.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ComplianceError {
    /// A number is not finite.
    #[error("{what} holds {}: want finite numbers", ShortNumber(*value))]
    NotFinite {
        /// Stiffness or damping.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// The matrix is not symmetric.
    #[error(
        "{what} has {} in row {row}, column {column}, but {} the other way round: want a symmetric matrix",
        ShortNumber(*value),
        ShortNumber(*other)
    )]
    NotSymmetric {
        /// Stiffness or damping.
        what: &'static str,
        /// Row, from 1.
        row: usize,
        /// Column, from 1.
        column: usize,
        /// The number there.
        value: f64,
        /// The number of the other place.
        other: f64,
    },
    /// The matrix has a negative eigenvalue.
    #[error("{what} has the eigenvalue {}: want none below 0", ShortNumber(*eigenvalue))]
    Negative {
        /// Stiffness or damping.
        what: &'static str,
        /// The least eigenvalue.
        eigenvalue: f64,
    },
}

impl Compliance {
    /// Returns springs and dampers without preload. Rows and columns are x, y, z of translation, then of rotation, in
    /// axes of the base at rest and at its origin.
    ///
    /// # Errors
    /// If a matrix is not finite, not symmetric, or has a negative eigenvalue.
    pub fn new(stiffness: &Matrix6<f64>, damping: &Matrix6<f64>) -> Result<Self, ComplianceError> {
        let [stiffness, damping] = [checked("stiffness", stiffness)?, checked("damping", damping)?];
        Ok(Self { stiffness, damping, preload: Vector6::zeros() })
    }

    /// Returns springs and dampers that each act along or about one axis: three numbers for translation, then three for
    /// rotation.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn diagonal(stiffness: [f64; 6], damping: [f64; 6]) -> Result<Self, ComplianceError> {
        let [stiffness, damping] = [stiffness, damping].map(|of| Matrix6::from_diagonal(&of.into()));
        Self::new(&stiffness, &damping)
    }

    /// Returns what springs and dampers exert on the base at its origin, in axes of space, N and N m.
    pub fn wrench(&self, state: &BaseState) -> SpatialWrench {
        let (x, turn) = state.coordinates();
        let [force, moment] = halves(&(self.preload - self.stiffness * x));
        let [drag, dragging] = halves(&(self.damping * state.twist()));
        SpatialWrench { force: force - drag, moment: turning(&turn).tr_mul(&moment) - dragging }
    }

    /// Returns the energy of the springs, J, 0 where the base rests without motion.
    pub fn energy(&self, state: &BaseState) -> f64 {
        let (x, _) = state.coordinates();
        x.dot(&(0.5 * self.stiffness * x - self.preload))
    }

    /// Returns the power that the dampers take, W, never negative.
    pub fn dissipation(&self, state: &BaseState) -> f64 {
        let twist = state.twist();
        twist.dot(&(self.damping * twist))
    }
}

/// Returns the first and the last three of six numbers.
fn halves(six: &Vector6<f64>) -> [Vector3<f64>; 2] {
    [six.fixed_rows::<3>(0).into_owned(), six.fixed_rows::<3>(3).into_owned()]
}

/// Returns six numbers from three and three.
fn joined(first: &Vector3<f64>, last: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(first.x, first.y, first.z, last.x, last.y, last.z)
}

/// Returns T(φ), the inverse of the left Jacobian of rotations.
fn turning(turn: &Vector3<f64>) -> Matrix3<f64> {
    let (angle, cross) = (turn.norm(), turn.cross_matrix());
    // (1 − ½ φ cot ½ φ) / φ², and its series.
    let squared = match angle < SMALL_ANGLE {
        true => (1.0 + angle * angle / 60.0) / 12.0,
        false => (1.0 - 0.5 * angle / (0.5 * angle).tan()) / (angle * angle),
    };
    Matrix3::identity() - 0.5 * cross + squared * cross * cross
}

/// Returns a matrix made symmetric to the last bit.
fn checked(what: &'static str, of: &Matrix6<f64>) -> Result<Matrix6<f64>, ComplianceError> {
    if let Some(value) = of.iter().copied().find(|x| !x.is_finite()) {
        return Err(ComplianceError::NotFinite { what, value });
    }
    let slack = ROUNDING * of.amax();
    for row in 0..6 {
        for column in 0..row {
            let (value, other) = (of[(row, column)], of[(column, row)]);
            if (value - other).abs() > slack {
                return Err(ComplianceError::NotSymmetric { what, row: row + 1, column: column + 1, value, other });
            }
        }
    }
    let symmetric = 0.5 * (of + of.transpose());
    match symmetric.symmetric_eigenvalues().min() {
        least if least < -slack => Err(ComplianceError::Negative { what, eigenvalue: least }),
        _ => Ok(symmetric),
    }
}

/// Where a base is in space, and how it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseState {
    /// r, m, in axes of space.
    pub place: Vector3<f64>,
    /// Orientation in space.
    pub attitude: Attitude,
    /// v, m/s, in axes of space.
    pub velocity: Vector3<f64>,
    /// ω, rad/s, in axes of the base.
    pub rate: Vector3<f64>,
}

impl BaseState {
    /// A base at rest at the origin of space, with its axes along those of space.
    pub fn at_rest() -> Self {
        let still = Vector3::zeros();
        Self { place: still, attitude: Attitude::level(), velocity: still, rate: still }
    }

    /// Returns x, and φ by itself.
    fn coordinates(&self) -> (Vector6<f64>, Vector3<f64>) {
        let turn = self.attitude.0.scaled_axis();
        (joined(&self.place, &turn), turn)
    }

    /// Returns v and ω in axes of space.
    fn twist(&self) -> Vector6<f64> {
        joined(&self.velocity, &(self.attitude.0 * self.rate))
    }

    /// Returns how it moves in its own axes, without accelerations.
    pub fn moving(&self) -> MovingBase {
        let velocity = self.attitude.0.inverse() * self.velocity;
        MovingBase { velocity, rate: self.rate, ..MovingBase::default() }
    }

    /// Returns it moved by a rotation vector in its own axes, a way, a change of velocity and one of its rate.
    fn moved(&self, by: &SVector<f64, 12>) -> Self {
        let part = |from: usize| Vector3::new(by[from], by[from + 1], by[from + 2]);
        Self {
            place: self.place + part(3),
            attitude: self.attitude.turned(&part(0)),
            velocity: self.velocity + part(6),
            rate: self.rate + part(9),
        }
    }
}

impl Assembly {
    /// Returns the preload that holds base and blocks at x = 0 against their weight, N and N m.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn preload(&self, base: &SpatialBase, states: &[BlockState]) -> Vector6<f64> {
        let all = self.sums(base, states);
        -joined(&(all.mass * self.gravity), &all.first[0].cross(&self.gravity))
    }

    /// Returns how a compliant base moves while its blocks do: velocity, rate, and accelerations, in its axes. The
    /// assembly's gravity is in axes of space. [`loads_on`](Self::loads_on) gives torques and loads for it.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn compliant_motion(
        &self,
        base: &SpatialBase,
        held: &Compliance,
        at: &BaseState,
        states: &[BlockState],
    ) -> MovingBase {
        let (all, moving, seen) = (self.sums(base, states), at.moving(), at.attitude.0.inverse());
        let (held, gravity) = (held.wrench(at), seen * self.gravity);
        let acting = SpatialWrench {
            force: seen * held.force + all.mass * gravity,
            moment: seen * held.moment + all.first[0].cross(&gravity),
        };
        let [acceleration, angular_acceleration] = all.accelerations(&moving, &acting);
        MovingBase { acceleration, angular_acceleration, ..moving }
    }

    /// Returns a compliant base after a step of h seconds. `states` returns the states of the blocks at a fraction of the
    /// step: 0, a half and 1. The method is explicit, of fourth order: h times [`fastest`](Self::fastest) has to stay
    /// below 2.7.
    #[must_use]
    pub fn compliant_after(
        &self,
        base: &SpatialBase,
        held: &Compliance,
        at: &BaseState,
        h: f64,
        mut states: impl FnMut(f64) -> [BlockState; MAX_BLOCKS],
    ) -> BaseState {
        let slope = |fraction: f64, at: &BaseState| {
            let moving = self.compliant_motion(base, held, at, &states(fraction));
            let pull = at.attitude.0 * moving.acceleration;
            let parts = [at.rate, at.velocity, pull, moving.angular_acceleration];
            SVector::<f64, 12>::from_fn(|i, _| parts[i / 3][i % 3])
        };
        let mut end = stepping::after(at, h, slope, BaseState::moved);
        end.attitude.0.renormalize_fast();
        end
    }

    /// Returns a bound on how fast the base can swing or settle on its springs and dampers, rad/s or 1/s, with its blocks
    /// as one body.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn fastest(&self, base: &SpatialBase, held: &Compliance, states: &[BlockState]) -> f64 {
        let all = self.sums(base, states);
        let mut mass = Matrix6::zeros();
        let cross = all.first[0].cross_matrix();
        mass.fixed_view_mut::<3, 3>(0, 0).copy_from(&(all.mass * Matrix3::identity()));
        mass.fixed_view_mut::<3, 3>(3, 3).copy_from(&all.inertia[0]);
        mass.fixed_view_mut::<3, 3>(3, 0).copy_from(&cross);
        mass.fixed_view_mut::<3, 3>(0, 3).copy_from(&cross.transpose());
        let Some(factors) = mass.cholesky() else { return f64::INFINITY };
        let most = |of: &Matrix6<f64>| {
            // L⁻¹ of L⁻ᵀ has the eigenvalues of the mass matrix against it.
            let half = factors.l_dirty().solve_lower_triangular(of).unwrap_or_else(Matrix6::zeros);
            let both = factors.l_dirty().solve_lower_triangular(&half.transpose()).unwrap_or_else(Matrix6::zeros);
            both.symmetric_eigenvalues().max().max(0.0)
        };
        let (swing, settle) = (most(&held.stiffness), 0.5 * most(&held.damping));
        settle + (settle * settle + swing).sqrt()
    }
}
