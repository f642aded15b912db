//! Why the blocks of an assembly react, and where.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m_c, o, h_c | mass that a block carries, its centre of mass from the end effector: in the plane, and along z | kg, m |
//! | p_k | weights of the end effector: it is at Σ p_k e(q_k) | m |
//! | C_0k | coupling of bodies that keep their orientation: own links of the block, and m_c conj(o) p_k | kg m² |
//!
//! # Conditions
//! A block that holds its b puts nothing on the base if, with the carried mass at its end effector, g_k = 0 (7), C_kl = 0
//! (8), C_0k = 0, and for the moments that tilt the base Σ m h a_k = 0 for each drive.

use nalgebra::Vector3;

use super::model::Assembly;
use crate::machine::{BALANCE_TOLERANCE, Inertia};
use crate::planar::{MAX_DRIVES, Vector};

/// Mass that is carried off the end effector of its carrier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedOffset {
    /// m_c, kg.
    pub mass: f64,
    /// o, m, in the plane of the carrier.
    pub beside: Vector,
    /// Height above the end effector, along z of the carrier, m.
    pub above: f64,
}

/// Moments of a block with what it carries, a point mass at its end effector.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedBlock {
    /// m_c, kg.
    pub mass: f64,
    /// First moment of what it carries beside the end effector, kg m, in the plane of the block.
    pub beside: Vector,
    /// The same along its axis z, from the end effector, kg m.
    pub along: f64,
    /// First moment of all bodies along z, from the mount, kg m.
    pub height: f64,
    /// First moments Σ m h a_k of its drives weighted with heights, kg m².
    pub weighted: [Vector; MAX_DRIVES],
    /// The machine with the carried mass at its end effector.
    pub inertia: Inertia,
}

/// What keeps a block from being silent.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockConditions {
    /// What it carries.
    pub carried: CarriedOffset,
    /// The machine with the carried mass at its end effector.
    pub inertia: Inertia,
    /// Largest |g_k|, kg m.
    pub force: f64,
    /// Largest |C_kl|, k ≠ l, kg m².
    pub coupling: f64,
    /// Largest |C_0k|, kg m².
    pub ground: f64,
    /// The same of its own links that keep their orientation alone, kg m².
    pub own_ground: f64,
    /// Largest |Σ m h a_k| about the height of the centre of mass, kg m².
    pub tilt: f64,
}

/// A reason why a block reacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reacting {
    /// Its centre of mass moves.
    Force,
    /// Its mass matrix depends on the pose.
    Coupling,
    /// What it carries is off its end effector, or its own links that keep their orientation are not balanced.
    Ground,
    /// Its bodies are at different heights.
    Tilt,
}

impl BlockConditions {
    /// Returns why the block reacts although it holds its b; nothing if it is silent.
    pub fn reasons(&self) -> impl Iterator<Item = Reacting> {
        let Inertia { mass, .. } = self.inertia;
        let squared = BALANCE_TOLERANCE * self.inertia.diagonals().iter().sum::<f64>();
        let first = (BALANCE_TOLERANCE * squared * mass).sqrt();
        [
            (Reacting::Force, self.force > first),
            (Reacting::Coupling, self.coupling > squared),
            (Reacting::Ground, self.ground > squared),
            (Reacting::Tilt, self.tilt > squared),
        ]
        .into_iter()
        .filter_map(|(why, is_so)| is_so.then_some(why))
    }
}

impl Assembly {
    /// Returns the first moment of all that sits on the platform of a block, about its end effector, kg m, in axes of the
    /// base. It does not move if all that is carried is force balanced.
    fn moment_above(&self, block: usize) -> Vector3<f64> {
        let of = |i: usize| {
            let own = &self.blocks()[i];
            let above = own.platform_height() * (self.mass_above(i) - own.inertia.mass());
            // Links that keep their orientation hold their centre of mass off the base pin.
            let ground = if own.inertia.grounded { Some(own.inertia.drives) } else { None };
            let carried = self.mass_above(i) - own.inertia.mass();
            let fixed =
                ground.map_or_else(Vector::default, |n| own.inertia.g[n] + carried * own.inertia.end_effector[n]);
            let beside = own.mount.in_space(fixed, own.axial.total() + above);
            self.mass_above(i) * own.mount.at + beside + self.moment_above(i)
        };
        self.carried_by(Some(block)).map(of).sum()
    }

    /// Returns the moments of a block and of what it carries, which move with its drives.
    pub fn loaded(&self, block: usize) -> LoadedBlock {
        let own = &self.blocks()[block];
        let mass = self.mass_above(block) - own.inertia.mass();
        let moment = self.moment_above(block);
        let mut inertia = own.inertia.clone();
        let tip = inertia.end_effector.map(|p| Vector::new(p, 0.0));
        let held_by = own.machine.resolved_links()[own.machine.end_link()].drive;
        inertia.add(mass, 0.0, held_by, &tip);
        let (beside, along) = (own.mount.in_plane(&moment), own.mount.axes.column(2).dot(&moment));
        let height = own.platform_height() * mass + along;
        let weighted = std::array::from_fn(|k| own.axial.weighted()[k] + height * tip[k]);
        LoadedBlock { mass, beside, along, height: own.axial.total() + height, weighted, inertia }
    }

    /// Returns what keeps a block from being silent.
    pub fn conditions(&self, block: usize) -> BlockConditions {
        let LoadedBlock { mass, beside, along, height, weighted, inertia } = self.loaded(block);
        let tip = &inertia.end_effector;
        let mean = height / inertia.mass.max(f64::MIN_POSITIVE);
        let most = |of: &dyn Fn(usize) -> f64| (0..inertia.drives).map(of).fold(0.0, f64::max);
        BlockConditions {
            carried: CarriedOffset {
                mass,
                beside: if mass > 0.0 { beside / mass } else { Vector::default() },
                above: if mass > 0.0 { along / mass } else { 0.0 },
            },
            force: inertia.force_residual(),
            coupling: Inertia::pairs(inertia.drives).fold(0.0, |most, (k, l)| most.max(inertia.c[k][l].norm())),
            ground: most(&|k| (inertia.ground_coupling(k) + beside.conj() * tip[k]).norm()),
            own_ground: inertia.ground_residual(),
            tilt: most(&|k| (weighted[k] - mean * inertia.g[k]).norm()),
            inertia,
        }
    }

    /// Σ D_k of all blocks, each with what it carries, where all C_kl vanish, kg m².
    pub fn total_momentum(&self) -> f64 {
        (0..self.blocks().len()).map(|block| self.loaded(block).inertia.total_momentum()).sum()
    }
}
