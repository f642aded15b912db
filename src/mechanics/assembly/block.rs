//! [`Block`]: a machine in a plane in space.

use nalgebra::{Matrix3, Vector3};

use super::free_base::OutOfPlane;
use crate::joint_forces::AxialMoments;
use crate::machine::{Inertia, Machine};
use crate::planar::Vector;

/// Where a block is, and how its plane lies.
#[derive(Clone, Debug, PartialEq)]
pub struct Mount {
    /// The block on whose platform it sits; `None` for the base.
    pub on: Option<usize>,
    /// Its place from the origin of the base, or from the end effector of the block that carries it, m, in axes of the
    /// base.
    pub at: Vector3<f64>,
    /// Directions x, y, z of its plane, as columns, in axes of the base.
    pub axes: Matrix3<f64>,
}

impl Mount {
    /// The plane of the base: where a machine by itself is.
    pub fn on_base() -> Self {
        Self { on: None, at: Vector3::zeros(), axes: Matrix3::identity() }
    }

    /// Returns a vector of the plane, with a height along z, in axes of the base.
    #[inline]
    pub fn in_space(&self, v: Vector, height: f64) -> Vector3<f64> {
        self.axes * Vector3::new(v.re, v.im, height)
    }

    /// Returns what a vector in axes of the base has in the plane.
    #[inline]
    pub fn in_plane(&self, v: &Vector3<f64>) -> Vector {
        Vector::new(self.axes.column(0).dot(v), self.axes.column(1).dot(v))
    }
}

/// A machine with its mount, and the constants of its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Its name.
    pub name: String,
    /// The machine.
    pub machine: Machine,
    /// Where it is.
    pub mount: Mount,
    /// Constants of the machine.
    pub inertia: Inertia,
    /// Constants of its moments out of the plane.
    pub axial: AxialMoments,
    /// Constants of its inertia out of the plane.
    pub(super) out_of_plane: OutOfPlane,
}

impl Block {
    /// Returns a machine as a block.
    pub fn new(name: impl Into<String>, machine: Machine, mount: Mount) -> Self {
        let (inertia, axial, out_of_plane) =
            (Inertia::of(&machine), AxialMoments::of(&machine), OutOfPlane::of(&machine));
        Self { name: name.into(), machine, mount, inertia, axial, out_of_plane }
    }

    /// Height of the end effector along z, m.
    pub fn platform_height(&self) -> f64 {
        self.machine.spec().payload.axial
    }
}
