//! What blocks in motion do to their base, to each other, and to their motors.

use nalgebra::Vector3;

use super::block::Block;
use super::model::{Assembly, MAX_BLOCKS};
use super::moving_base::{MovingBase, mount_acceleration, moved_loads, turning_torque};
use crate::dynamics::{ExternalLoads, angular_momentum, inverse, inverse_with_wrench};
use crate::planar::{DriveAngles, MAX_DRIVES, PerDrive, UnitVectors, Vector};

/// State of motion of one block: absolute angles in its plane, rad, rates, rad/s, and accelerations, rad/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockState {
    /// q.
    pub q: DriveAngles,
    /// q̇.
    pub qd: PerDrive,
    /// q̈.
    pub qdd: PerDrive,
}

/// A force, N, and a moment about the origin of the base, N m, in axes of the base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpatialWrench {
    /// Force.
    pub force: Vector3<f64>,
    /// Moment.
    pub moment: Vector3<f64>,
}

impl SpatialWrench {
    fn add(&mut self, other: &Self) {
        self.force += other.force;
        self.moment += other.moment;
    }

    /// Returns all six components: force, then moment.
    pub fn components(&self) -> [f64; 6] {
        let [f, n] = [self.force, self.moment];
        [f.x, f.y, f.z, n.x, n.y, n.z]
    }
}

/// Wrench on the base, in two parts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpatialLoads {
    /// From motion: −d/dt of linear and angular momentum.
    pub motion: SpatialWrench,
    /// From weight.
    pub weight: SpatialWrench,
}

impl SpatialLoads {
    /// Returns the sum of both parts.
    pub fn total(&self) -> SpatialWrench {
        let mut sum = self.motion;
        sum.add(&self.weight);
        sum
    }

    fn add(&mut self, other: &Self) {
        self.motion.add(&other.motion);
        self.weight.add(&other.weight);
    }
}

/// Loads of one block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockLoads {
    /// Torques of its motors, N m, with what it carries.
    pub torque: PerDrive,
    /// What its own bodies put on the base, without those that it carries.
    pub on_base: SpatialLoads,
}

/// Linear momentum, kg m/s, and angular momentum, kg m²/s. Of blocks as seen from the base it is about the origin of the
/// base; of all in space it is about the common centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Momentum {
    /// Linear momentum.
    pub linear: Vector3<f64>,
    /// Angular momentum.
    pub angular: Vector3<f64>,
}

/// A vector of a plane that moves, with its first and second time derivative.
type Moving = [Vector; 3];

/// Returns Σ_k c_k e(q_k), with its time derivatives.
#[inline]
fn moving_sum(c: impl Fn(usize) -> Vector, e: &UnitVectors, state: &BlockState) -> Moving {
    let mut sum = [Vector::default(); 3];
    for (k, (e, (rate, acceleration))) in e.iter().zip(state.qd.iter().zip(state.qdd.iter())).enumerate() {
        let at = c(k) * e;
        sum[0] += at;
        sum[1] += at * Vector::new(0.0, *rate);
        sum[2] += at * Vector::new(-rate * rate, *acceleration);
    }
    sum
}

/// A quarter turn counter-clockwise.
const QUARTER: Vector = Vector { re: 0.0, im: 1.0 };

/// A block in motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingBlock {
    pub(super) e: UnitVectors,
    /// Σ g_k e_k, kg m.
    pub(super) first: Moving,
    /// Σ s_k e_k, kg m².
    pub(super) weighted: Moving,
    /// Place, velocity and acceleration of the mount, in axes of the base.
    pub(super) mount: [Vector3<f64>; 3],
    /// The same of the end effector.
    pub(super) platform: [Vector3<f64>; 3],
}

impl MovingBlock {
    const AT_REST: Self = Self {
        e: [Vector { re: 0.0, im: 0.0 }; MAX_DRIVES],
        first: [Vector { re: 0.0, im: 0.0 }; 3],
        weighted: [Vector { re: 0.0, im: 0.0 }; 3],
        mount: [Vector3::new(0.0, 0.0, 0.0); 3],
        platform: [Vector3::new(0.0, 0.0, 0.0); 3],
    };

    fn of(block: &Block, state: &BlockState, below: [Vector3<f64>; 3]) -> Self {
        let e = state.q.units();
        let mut mount = below;
        mount[0] += block.mount.at;
        let tip = moving_sum(|k| Vector::new(block.inertia.end_effector[k], 0.0), &e, state);
        let heights = [block.platform_height(), 0.0, 0.0];
        let mut first = moving_sum(|k| block.inertia.g[k], &e, state);
        let mut weighted = moving_sum(|k| block.axial.weighted()[k], &e, state);
        if block.inertia.grounded {
            let ground = block.inertia.drives;
            first[0] += block.inertia.g[ground];
            weighted[0] += block.axial.weighted()[ground];
        }
        Self {
            first,
            weighted,
            platform: std::array::from_fn(|i| mount[i] + block.mount.in_space(tip[i], heights[i])),
            e,
            mount,
        }
    }

    /// Σ m r + z Σ m h, the first moment about the mount in space, kg m.
    pub(super) fn first_moment(&self, block: &Block) -> Vector3<f64> {
        block.mount.in_space(self.first[0], block.axial.total())
    }

    /// Returns what the block's own bodies put on the base.
    pub(super) fn loads(&self, block: &Block, state: &BlockState, gravity: &Vector3<f64>) -> SpatialLoads {
        let (mass, moment) = (block.inertia.mass(), self.first_moment(block));
        let [place, _, pull] = self.mount;
        let alone = inverse_with_wrench(&block.inertia, &self.e, &state.qd, &state.qdd, &ExternalLoads::default());
        let force = -mass * pull - block.mount.in_space(self.first[2], 0.0);
        let tilt = -QUARTER * self.weighted[2];
        let about_mount = block.mount.in_space(tilt, alone.1.dynamic.moment) - moment.cross(&pull);
        let weight = mass * gravity;
        SpatialLoads {
            motion: SpatialWrench { force, moment: about_mount + place.cross(&force) },
            weight: SpatialWrench { force: weight, moment: moment.cross(gravity) + place.cross(&weight) },
        }
    }

    /// Returns the momentum of the block's own bodies.
    pub(super) fn momentum(&self, block: &Block, state: &BlockState) -> Momentum {
        let (mass, moment) = (block.inertia.mass(), self.first_moment(block));
        let [place, velocity, _] = self.mount;
        let linear = mass * velocity + block.mount.in_space(self.first[1], 0.0);
        let spin = angular_momentum(&block.inertia, &self.e, &state.qd);
        let about_mount = block.mount.in_space(QUARTER * self.weighted[1], spin) + moment.cross(&velocity);
        Momentum { linear, angular: about_mount + place.cross(&linear) }
    }
}

impl Assembly {
    /// Returns the blocks in motion on a base at rest, in their order.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub(super) fn moving(&self, states: &[BlockState]) -> [MovingBlock; MAX_BLOCKS] {
        let mut all = [MovingBlock::AT_REST; MAX_BLOCKS];
        for i in self.order() {
            let block = &self.blocks()[*i];
            let below = block.mount.on.map_or([Vector3::zeros(); 3], |carrier| all[carrier].platform);
            all[*i] = MovingBlock::of(block, &states[*i], below);
        }
        all
    }

    /// Returns the end effectors of the blocks, m from the origin of the base.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn end_effectors(&self, states: &[BlockState]) -> [Vector3<f64>; MAX_BLOCKS] {
        self.moving(states).map(|block| block.platform[0])
    }

    /// Returns the mounts of the blocks, m from the origin of the base.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn mounts(&self, states: &[BlockState]) -> [Vector3<f64>; MAX_BLOCKS] {
        self.moving(states).map(|block| block.mount[0])
    }

    /// Returns what blocks in motion put on a base at rest. Gives `see` the loads of each block, carried ones first.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn loads(&self, states: &[BlockState], see: impl FnMut(usize, &BlockLoads)) -> SpatialLoads {
        self.loads_with(None, &self.gravity, states, see)
    }

    /// Returns the same on a base that may move.
    pub(super) fn loads_with(
        &self,
        base: Option<&MovingBase>,
        gravity: &Vector3<f64>,
        states: &[BlockState],
        mut see: impl FnMut(usize, &BlockLoads),
    ) -> SpatialLoads {
        let moving = self.moving(states);
        let (mut carried, mut sum) = ([Vector3::zeros(); MAX_BLOCKS], SpatialLoads::default());
        for i in self.order().iter().rev() {
            let (block, state) = (&self.blocks()[*i], &states[*i]);
            let mut on_base = moving[*i].loads(block, state, gravity);
            let mut pull = gravity - moving[*i].mount[2];
            if let Some(base) = base {
                on_base.motion = moved_loads(block, &moving[*i], state, base);
                pull -= mount_acceleration(&moving[*i], base);
            }
            let around =
                ExternalLoads { gravity: block.mount.in_plane(&pull), force: block.mount.in_plane(&carried[*i]) };
            let mut torque = inverse(&block.inertia, &moving[*i].e, &state.qd, &state.qdd, &around);
            if let Some(base) = base {
                torque = torque.plus(1.0, &turning_torque(block, &moving[*i], state, base));
            }
            see(*i, &BlockLoads { torque: block.inertia.motors().motor_torques(&torque), on_base });
            sum.add(&on_base);
            if let Some(carrier) = block.mount.on {
                carried[carrier] += on_base.total().force + carried[*i];
            }
        }
        sum
    }

    /// Returns Σ m |a| over the bodies of all blocks, N: what forces on the base are compared with.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn inertial_forces(&self, states: &[BlockState]) -> f64 {
        let moving = self.moving(states);
        let of = |((block, moving), state): ((&Block, &MovingBlock), &BlockState)| {
            let machine = &block.machine;
            let [_, _, pull] = moving.mount;
            let body = |mass: f64, chain: &[Vector; MAX_DRIVES]| {
                let [_, _, a] = moving_sum(|k| chain[k], &moving.e, state);
                mass * (pull + block.mount.in_space(a, 0.0)).norm()
            };
            let links = machine.links().iter().enumerate().map(|(j, link)| body(link.mass, &machine.com_chain(j)));
            links.sum::<f64>() + body(machine.spec().payload.mass, &machine.payload_chain())
        };
        self.blocks().iter().zip(&moving).zip(states).map(of).sum()
    }

    /// Returns the momentum of all blocks, as seen from the base.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn momentum(&self, states: &[BlockState]) -> Momentum {
        let moving = self.moving(states);
        let mut sum = Momentum::default();
        for ((block, moving), state) in self.blocks().iter().zip(&moving).zip(states) {
            let Momentum { linear, angular } = moving.momentum(block, state);
            sum.linear += linear;
            sum.angular += angular;
        }
        sum
    }
}
