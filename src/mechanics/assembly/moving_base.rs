//! What blocks in motion do to a base that moves in space, and to their motors.
//!
//! # Symbols
//! All vectors are in axes of the base, all moments about its origin O; a dot is a rate as seen from the base.
//!
//! | letter | meaning | unit |
//! |---|---|---|
//! | A, ω, α | acceleration of O in space, rate of the base, and its rate of change | m/s², rad/s, rad/s² |
//! | M, G, P = Ġ | mass of some bodies, their first moment, their momentum as seen from the base | kg, kg m, kg m/s |
//! | I, ℓ | their inertia as one body, their angular momentum as seen from the base | kg m², kg m²/s |
//! | w, ω_z, β, α_z | ω and α in the plane of a block, as complex numbers, and along its axis | rad/s, rad/s² |
//! | Z_kl | C_kl e^{i (q_l − q_k)} | kg m² |
//! | R_k | Σ_l Σ m a_k a_l e_k e_l, and Σ (I_c − I_a + 2 i I_xy) e_k² of the bodies of drive k | kg m² |
//!
//! # Closed form
//! Momenta are M v + ω × G + P and G × v + I ω + ℓ, v the velocity of O. Their rates of change in space are
//! M A + α × G + ω × (ω × G + 2 P) + Ṗ and G × A + I α + İ ω + ℓ̇ + ω × (I ω + ℓ).
//!
//! To the torque of drive k on a base at rest, with the acceleration of the mount in space, the rotation adds
//! D_k α_z − Σ_l Im Z_kl (2 ω_z q̇_l + ω_z² + ½ |w|²) + ½ Im(conj(R_k) w²) + Re(conj(i s_k e_k) (w ω_z − i β)).
//!
//! # Source
//! Rates of change of momentum, body by body, as in [`assembly`](super); the torque is the power of the same
//! accelerations in the motion of one drive.

use nalgebra::{Matrix3, Vector3};

use super::block::Block;
use super::free_base::{SpatialBase, of_mass};
use super::model::Assembly;
use super::motion::{BlockLoads, BlockState, Momentum, MovingBlock, SpatialLoads, SpatialWrench};
use crate::dynamics::energy;
use crate::planar::{PerDrive, Vector};

/// How a base moves in space at an instant, in its own axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MovingBase {
    /// Velocity of its origin in space, m/s.
    pub velocity: Vector3<f64>,
    /// ω, rad/s.
    pub rate: Vector3<f64>,
    /// A, m/s².
    pub acceleration: Vector3<f64>,
    /// α, rad/s².
    pub angular_acceleration: Vector3<f64>,
}

impl MovingBase {
    /// Returns the acceleration in space of a point at a place, m, with a velocity as seen from the base, m/s, but for its
    /// acceleration as seen from there.
    fn acceleration_of(&self, place: &Vector3<f64>, velocity: &Vector3<f64>) -> Vector3<f64> {
        let turning = self.rate.cross(&(self.rate.cross(place) + 2.0 * velocity));
        self.acceleration + self.angular_acceleration.cross(place) + turning
    }
}

/// Sums over bodies in motion, about the origin of the base and as seen from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct BodySums {
    pub(super) mass: f64,
    /// G, P and Ṗ.
    pub(super) first: [Vector3<f64>; 3],
    /// I and İ.
    pub(super) inertia: [Matrix3<f64>; 2],
    /// ℓ and ℓ̇.
    pub(super) angular: [Vector3<f64>; 2],
    /// Kinetic energy as seen from the base, J.
    pub(super) energy: f64,
}

impl BodySums {
    /// Returns those of the base itself.
    fn of_base(base: &SpatialBase) -> Self {
        let mut sums = Self { mass: base.mass, ..Self::default() };
        sums.first[0] = base.mass * base.com;
        sums.inertia[0] = base.inertia + of_mass(base.mass, &base.com);
        sums
    }

    /// Returns those of a block's own bodies.
    fn of_block(block: &Block, moving: &MovingBlock, state: &BlockState) -> Self {
        let own = moving.momentum(block, state);
        let rates = moving.loads(block, state, &Vector3::zeros()).motion;
        let (mass, [place, velocity, _]) = (block.inertia.mass(), moving.mount);
        let moment = moving.first_moment(block);
        let relative = block.mount.in_space(moving.first[1], 0.0);
        let (kinetic, _) = energy(&block.inertia, &moving.e, &state.qd, Vector::default());
        Self {
            mass,
            first: [mass * place + moment, own.linear, -rates.force],
            inertia: moving.inertia(block, state),
            angular: [own.angular, -rates.moment],
            energy: kinetic + velocity.dot(&(0.5 * mass * velocity + relative)),
        }
    }

    fn add(&mut self, other: &Self) {
        self.mass += other.mass;
        self.first.iter_mut().zip(&other.first).for_each(|(own, other)| *own += other);
        self.inertia.iter_mut().zip(&other.inertia).for_each(|(own, other)| *own += other);
        self.angular.iter_mut().zip(&other.angular).for_each(|(own, other)| *own += other);
        self.energy += other.energy;
    }

    /// Returns what changes the momenta so on a base that moves: force and moment about the origin.
    pub(super) fn needed(&self, base: &MovingBase) -> SpatialWrench {
        let MovingBase { rate, acceleration, angular_acceleration, .. } = base;
        let [first, linear, linear_rate] = &self.first;
        let turning = rate.cross(&(rate.cross(first) + 2.0 * linear));
        let [inertia, change] = &self.inertia;
        let [angular, angular_rate] = &self.angular;
        SpatialWrench {
            force: self.mass * acceleration + angular_acceleration.cross(first) + turning + linear_rate,
            moment: first.cross(acceleration)
                + inertia * angular_acceleration
                + change * rate
                + angular_rate
                + rate.cross(&(inertia * rate + angular)),
        }
    }

    /// Centre of mass, m.
    pub(super) fn com(&self) -> Vector3<f64> {
        self.first[0] / self.mass
    }

    /// Inertia as one body about the centre of mass, kg m².
    pub(super) fn central(&self) -> Matrix3<f64> {
        self.inertia[0] - of_mass(self.mass, &self.com())
    }

    /// Returns accelerations of the origin in space and of the rate, if a force and a moment about the origin act on all.
    pub(super) fn accelerations(&self, base: &MovingBase, acting: &SpatialWrench) -> [Vector3<f64>; 2] {
        let still = MovingBase { acceleration: Vector3::zeros(), angular_acceleration: Vector3::zeros(), ..*base };
        let needed = self.needed(&still);
        let (force, moment) = (acting.force - needed.force, acting.moment - needed.moment);
        let turning = solved(&self.central(), &(moment - self.com().cross(&force)));
        [force / self.mass - turning.cross(&self.com()), turning]
    }

    /// Returns the kinetic energy in space, J.
    pub(super) fn kinetic(&self, base: &MovingBase) -> f64 {
        let MovingBase { velocity, rate, .. } = base;
        let [first, linear, _] = &self.first;
        let moving = velocity.dot(&(0.5 * self.mass * velocity + rate.cross(first) + linear));
        moving + rate.dot(&(0.5 * self.inertia[0] * rate + self.angular[0])) + self.energy
    }
}

/// Returns the solution of a positive definite system, as inertias of bodies with mass are; zero for others.
fn solved(matrix: &Matrix3<f64>, right: &Vector3<f64>) -> Vector3<f64> {
    matrix.cholesky().map_or_else(Vector3::zeros, |factors| factors.solve(right))
}

/// Returns what the rotation of a base adds to the torques of a block's drives, N m, beside the acceleration of its mount.
pub(super) fn turning_torque(block: &Block, moving: &MovingBlock, state: &BlockState, base: &MovingBase) -> PerDrive {
    let (inertia, e) = (&block.inertia, &moving.e);
    let along_axes = |v: &Vector3<f64>| (block.mount.in_plane(v), block.mount.axes.column(2).dot(v));
    let ((w, about), (tilting, spinning)) = (along_axes(&base.rate), along_axes(&base.angular_acceleration));
    let shared = about * about + 0.5 * w.norm_sqr();
    let heights = w * about - Vector::i() * tilting;
    let leaning = block.out_of_plane.leaning(e);
    let qd = state.qd.padded();
    PerDrive::from_fn(inertia.drives, |k| {
        // D_k, from H whatever the pose.
        let (mut momentum, mut turned) = (inertia.spin[k] + inertia.stator_reaction[k], 0.0);
        for l in 0..inertia.indices() {
            let z = inertia.c[k][l] * (e[k].conj() * e[l]);
            momentum += z.re + inertia.rotor_coupling[k][l];
            turned += z.im * (2.0 * about * qd[l] + shared);
        }
        let arm = Vector::i() * block.axial.weighted()[k] * e[k];
        momentum * spinning - turned + 0.5 * (leaning[k].conj() * w * w).im + (arm.conj() * heights).re
    })
}

impl Assembly {
    /// Returns the sums over the base and all blocks.
    pub(super) fn sums(&self, base: &SpatialBase, states: &[BlockState]) -> BodySums {
        let moving = self.moving(states);
        let mut all = BodySums::of_base(base);
        for ((block, moving), state) in self.blocks().iter().zip(&moving).zip(states) {
            all.add(&BodySums::of_block(block, moving, state));
        }
        all
    }

    /// Returns how a base that floats moves while its blocks do. `kept` are the momenta of base and blocks, kg m/s, and
    /// about the common centre of mass, kg m²/s, in axes of the base; both stay constant in space. Gravity accelerates
    /// all parts alike and is left out.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn floating_motion(&self, base: &SpatialBase, states: &[BlockState], kept: &Momentum) -> MovingBase {
        let all = self.sums(base, states);
        let com = all.com();
        let own = all.angular[0] - com.cross(&all.first[1]);
        let rate = solved(&all.central(), &(kept.angular - own));
        let velocity = (kept.linear - all.first[1]) / all.mass - rate.cross(&com);
        let moving = MovingBase { velocity, rate, ..MovingBase::default() };
        let [acceleration, angular_acceleration] = all.accelerations(&moving, &SpatialWrench::default());
        MovingBase { acceleration, angular_acceleration, ..moving }
    }

    /// Returns what blocks in motion put on a base that moves, about its origin and in its axes, with `gravity` in the
    /// same axes, m/s². Gives `see` torques and loads of each block, carried ones first, as [`loads`](Self::loads) does
    /// for a base at rest. On a base that floats, gravity is zero.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn loads_on(
        &self,
        base: &MovingBase,
        gravity: &Vector3<f64>,
        states: &[BlockState],
        see: impl FnMut(usize, &BlockLoads),
    ) -> SpatialLoads {
        self.loads_with(Some(base), gravity, states, see)
    }

    /// Returns the momenta of base and blocks in space: the linear one, and the angular one about the common centre of
    /// mass, in axes of the base. Of how the base moves only velocity and rate count.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn momentum_in_space(&self, base: &SpatialBase, moving: &MovingBase, states: &[BlockState]) -> Momentum {
        let all = self.sums(base, states);
        let [first, linear, _] = &all.first;
        Momentum {
            linear: all.mass * moving.velocity + moving.rate.cross(first) + linear,
            angular: all.central() * moving.rate + all.angular[0] - all.com().cross(linear),
        }
    }

    /// Returns the kinetic energy of base and blocks in space, J, rotors included. Of how the base moves only velocity
    /// and rate count.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn kinetic_energy(&self, base: &SpatialBase, moving: &MovingBase, states: &[BlockState]) -> f64 {
        self.sums(base, states).kinetic(moving)
    }
}

/// Returns the loads of a block's own bodies on a base that moves.
pub(super) fn moved_loads(block: &Block, moving: &MovingBlock, state: &BlockState, base: &MovingBase) -> SpatialWrench {
    let SpatialWrench { force, moment } = BodySums::of_block(block, moving, state).needed(base);
    SpatialWrench { force: -force, moment: -moment }
}

/// Returns the acceleration of a block's mount in space that a base at rest would not give it, m/s².
pub(super) fn mount_acceleration(moving: &MovingBlock, base: &MovingBase) -> Vector3<f64> {
    let [place, velocity, _] = &moving.mount;
    base.acceleration_of(place, velocity)
}
