//! [`AssemblyBase`]: what holds the base of an assembly, and [`MovingSupport`], how it moves step by step.

use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::refusal::Refusal;
use stillbase_mechanics::assembly::{
    Assembly, Attitude, BaseState, BlockState, Compliance, MAX_BLOCKS, Momentum, MovingBase, SpatialBase,
};
use stillbase_settings::number::ShortNumber;

/// The base of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub enum AssemblyBase {
    /// It does not move.
    Fixed,
    /// It floats.
    Free(FreeBase),
    /// Springs and dampers hold it.
    Compliant(Box<SpringBase>),
}

/// A base that floats.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeBase {
    /// Its mass, centre of mass and inertia.
    pub body: SpatialBase,
    /// Momenta of base and blocks, which are kept: kg m/s, and kg m²/s about the common centre of mass, in axes of space.
    pub kept: Momentum,
}

/// A base on springs and dampers, at rest at first, preloaded so that it carries the weight where it begins.
#[derive(Clone, Debug, PartialEq)]
pub struct SpringBase {
    /// Its mass, centre of mass and inertia.
    pub body: SpatialBase,
    /// Stiffness along and about x, y, z at the origin of the base, N/m, N and N m/rad.
    pub stiffness: Matrix6<f64>,
    /// Damping, in the same order, N s/m, N s and N m s.
    pub damping: Matrix6<f64>,
}

impl AssemblyBase {
    /// Returns mass, centre of mass and inertia of a base that moves.
    pub fn body(&self) -> Option<&SpatialBase> {
        match self {
            Self::Fixed => None,
            Self::Free(base) => Some(&base.body),
            Self::Compliant(base) => Some(&base.body),
        }
    }

    /// Whether the base can move.
    pub fn moves(&self) -> bool {
        self.body().is_some()
    }
}

/// Largest product of the step and of how fast a base swings on its springs: above it the explicit method diverges.
const MAX_STEP_ANGLE: f64 = 2.5;

/// Largest turn of a floating base in a step, rad.
const MAX_TURN: f64 = 0.3;

/// Shortest step of a scenario, s.
const LEAST_STEP_S: f64 = 1e-5;

/// How a base moves.
#[derive(Clone, Debug)]
pub(super) enum MovingSupport {
    Fixed,
    Free {
        base: FreeBase,
        /// Common centre of mass at the start, m.
        com: Vector3<f64>,
        /// Mass of base and blocks, kg.
        mass: f64,
        attitude: Attitude,
        place: Vector3<f64>,
    },
    Compliant {
        body: SpatialBase,
        held: Box<Compliance>,
        state: BaseState,
    },
}

impl MovingSupport {
    /// Returns a base at its start, with the blocks in some states.
    ///
    /// # Errors
    /// If a step of `step` seconds is too long for its springs.
    pub fn of(base: &AssemblyBase, assembly: &Assembly, states: &[BlockState], step: f64) -> Result<Self, Refusal> {
        Ok(match base {
            AssemblyBase::Fixed => Self::Fixed,
            AssemblyBase::Free(base) => {
                let rate = assembly.base_motion(&base.body, states, &base.kept.angular).rate.norm();
                if step * rate > MAX_TURN {
                    let want = match shorter(MAX_TURN / rate) {
                        most if most >= LEAST_STEP_S => {
                            format!("want less, or step of at most {} s", ShortNumber(most))
                        }
                        _ => "want less".to_owned(),
                    };
                    return Err(Refusal::OfAssembly(format!(
                        "with this angular_momentum the base turns at {} rad/s: {want}",
                        ShortNumber(rate.ceil()),
                    )));
                }
                Self::Free {
                    com: assembly.base_motion(&base.body, states, &Vector3::zeros()).com,
                    mass: base.body.mass + assembly.mass(),
                    attitude: Attitude::level(),
                    place: Vector3::zeros(),
                    base: base.clone(),
                }
            }
            AssemblyBase::Compliant(base) => {
                let SpringBase { body, stiffness, damping } = &**base;
                let mut held =
                    Compliance::new(stiffness, damping).map_err(|why| Refusal::OfAssembly(format!("base: {why}")))?;
                held.preload = assembly.preload(body, states);
                let fastest = assembly.fastest(body, &held, states);
                if step * fastest > MAX_STEP_ANGLE {
                    let want = match shorter(MAX_STEP_ANGLE / fastest) {
                        most if most >= LEAST_STEP_S => format!("want step of at most {} s", ShortNumber(most)),
                        _ => "want softer springs and dampers".to_owned(),
                    };
                    return Err(Refusal::OfAssembly(format!(
                        "the base swings or settles at {} rad/s on its springs and dampers: {want}",
                        ShortNumber(fastest.ceil()),
                    )));
                }
                Self::Compliant { body: body.clone(), held: Box::new(held), state: BaseState::at_rest() }
            }
        })
    }

    /// Advances by a step of h seconds that ends at `time`, s; `states` returns those of the blocks at a share of it.
    pub fn advance(
        &mut self,
        assembly: &Assembly,
        (h, time): (f64, f64),
        mut states: impl FnMut(f64) -> [BlockState; MAX_BLOCKS],
    ) {
        match self {
            Self::Fixed => {}
            Self::Free { base, com, mass, attitude, place } => {
                *attitude = attitude.after(h, |share, attitude| {
                    let angular = attitude.0.inverse() * base.kept.angular;
                    assembly.base_motion(&base.body, &states(share), &angular).rate
                });
                let own = assembly.base_motion(&base.body, &states(1.0), &Vector3::zeros()).com;
                *place = *com + (time / *mass) * base.kept.linear - attitude.0 * own;
            }
            Self::Compliant { body, held, state } => {
                *state = assembly.compliant_after(body, held, state, h, states);
            }
        }
    }

    /// Returns how the base moves now, in its axes, with gravity in the same axes, m/s²; `None` for one that cannot move.
    pub fn motion(&self, assembly: &Assembly, states: &[BlockState]) -> Option<(MovingBase, Vector3<f64>)> {
        match self {
            Self::Fixed => None,
            Self::Free { base, attitude, .. } => {
                let seen = attitude.0.inverse();
                let kept = Momentum { linear: seen * base.kept.linear, angular: seen * base.kept.angular };
                Some((assembly.floating_motion(&base.body, states, &kept), Vector3::zeros()))
            }
            Self::Compliant { body, held, state } => {
                let gravity = state.attitude.0.inverse() * assembly.gravity;
                Some((assembly.compliant_motion(body, held, state, states), gravity))
            }
        }
    }

    /// Returns attitude and origin of the base in space, m.
    pub fn place(&self) -> (Attitude, Vector3<f64>) {
        match self {
            Self::Fixed => (Attitude::level(), Vector3::zeros()),
            Self::Free { attitude, place, .. } => (*attitude, *place),
            Self::Compliant { state, .. } => (state.attitude, state.place),
        }
    }
}

/// Returns a number rounded to two digits, a little smaller.
fn shorter(x: f64) -> f64 {
    format!("{:.1e}", 0.94 * x).parse().unwrap_or(x)
}

/// Returns an inertia from three moments or nine numbers, row by row.
pub(super) fn inertia_of(numbers: &[f64]) -> Option<Matrix3<f64>> {
    match numbers {
        [x, y, z] => Some(Matrix3::from_diagonal(&Vector3::new(*x, *y, *z))),
        nine if nine.len() == 9 => Some(Matrix3::from_row_slice(nine)),
        _ => None,
    }
}

/// Returns a matrix from its six diagonal numbers or all 36, row by row.
pub(super) fn six_by_six(numbers: &[f64]) -> Option<Matrix6<f64>> {
    match numbers.len() {
        6 => Some(Matrix6::from_diagonal(&nalgebra::Vector6::from_column_slice(numbers))),
        36 => Some(Matrix6::from_row_slice(numbers)),
        _ => None,
    }
}
