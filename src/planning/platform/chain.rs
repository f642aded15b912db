//! [`PlatformChain`]: blocks that carry each other, each at a fixed b.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Matrix3xX, Vector3};

use crate::pose_space::PoseSpace;
use stillbase_mechanics::assembly::Block;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, unit};

/// A block of a chain.
#[derive(Clone, Debug)]
pub struct ChainBlock {
    space: Arc<PoseSpace>,
    b: f64,
    /// Its mount from what carries it, with the height of its platform, m, in axes of the base.
    offset: Vector3<f64>,
    /// Directions x and y of its plane.
    axes: [Vector3<f64>; 2],
    /// Rates of all drives for a rate of 1 of each relative angle, b held.
    lifts: Vec<PerDrive>,
}

impl ChainBlock {
    /// Returns a block of an assembly at `b`, rad.
    pub fn of(block: &Block, space: Arc<PoseSpace>, b: f64) -> Self {
        let axis = |column: usize| block.mount.axes.column(column).into_owned();
        let (offset, axes) = (block.mount.at + axis(2) * block.platform_height(), [axis(0), axis(1)]);
        let count = space.joints().len();
        let one = |of: usize| PerDrive::from_fn(count, |i| f64::from(u8::from(i == of)));
        let lifts = (0..count).map(|of| space.lift_rates(&one(of), 0.0)).collect();
        Self { space, b, offset, axes, lifts }
    }

    /// Returns its pose space.
    pub fn space(&self) -> &Arc<PoseSpace> {
        &self.space
    }

    fn in_space(&self, v: Vector) -> Vector3<f64> {
        self.axes[0] * v.re + self.axes[1] * v.im
    }

    /// Returns c_k e^{i q_k} of each drive, m.
    fn arms(&self, a: &[f64]) -> Vec<Vector> {
        let q = self.space.lift(a, self.b);
        self.space.arms().iter().zip(q.iter()).map(|(c, q)| *c * unit(*q)).collect()
    }
}

/// Blocks that carry each other, from the one on the base to the last.
#[derive(Clone, Debug)]
pub struct PlatformChain {
    blocks: Vec<ChainBlock>,
    ranges: Vec<Range<usize>>,
    freedoms: usize,
}

impl PlatformChain {
    /// Returns the chain of some blocks, the one on the base first.
    pub fn new(blocks: Vec<ChainBlock>) -> Self {
        let mut freedoms = 0;
        let range = |block: &ChainBlock| {
            let from = freedoms;
            freedoms += block.lifts.len();
            from..freedoms
        };
        let ranges = blocks.iter().map(range).collect();
        Self { blocks, ranges, freedoms }
    }

    /// Returns its blocks.
    pub fn blocks(&self) -> &[ChainBlock] {
        &self.blocks
    }

    /// Returns the number of relative angles of all blocks.
    pub fn freedoms(&self) -> usize {
        self.freedoms
    }

    /// Returns the places of the angles of a block among all.
    pub fn range(&self, block: usize) -> Range<usize> {
        self.ranges[block].clone()
    }

    fn parts<'a>(&'a self, a: &'a [f64]) -> impl Iterator<Item = (&'a ChainBlock, &'a [f64])> {
        self.blocks.iter().zip(&self.ranges).map(|(block, range)| (block, &a[range.clone()]))
    }

    /// Returns the drive angles of each block, rad.
    pub fn lift(&self, a: &[f64]) -> Vec<DriveAngles> {
        self.parts(a).map(|(block, a)| block.space.lift(a, block.b)).collect()
    }

    /// Returns the relative angles of drive angles of each block, rad.
    pub fn angles(&self, q: &[DriveAngles]) -> Vec<f64> {
        let own = self.blocks.iter().zip(q).map(|(block, q)| block.space.angles(q));
        own.flat_map(|a| a.to_vec()).collect()
    }

    /// Returns p, m.
    pub fn place(&self, a: &[f64]) -> Vector3<f64> {
        let of = |(block, a): (&ChainBlock, &[f64])| block.offset + block.in_space(block.space.forward(a, block.b));
        self.parts(a).map(of).sum()
    }

    /// Returns the end effector of each block in its plane, m from its base pin.
    pub fn ends(&self, a: &[f64]) -> Vec<Vector> {
        self.parts(a).map(|(block, a)| block.space.forward(a, block.b)).collect()
    }

    /// Returns J = ∂p/∂a, m.
    pub fn jacobian(&self, a: &[f64]) -> Matrix3xX<f64> {
        let mut all = Matrix3xX::zeros(self.freedoms);
        for ((block, a), range) in self.parts(a).zip(&self.ranges) {
            let arms = block.arms(a);
            for (lift, column) in block.lifts.iter().zip(range.clone()) {
                let rate: Vector = arms.iter().zip(lift.iter()).map(|(arm, rate)| *arm * Vector::i() * *rate).sum();
                all.set_column(column, &block.in_space(rate));
            }
        }
        all
    }

    /// Returns ∂²(μ · p)/∂a², for a vector μ, in m times the unit of μ.
    pub fn curvature(&self, a: &[f64], mu: &Vector3<f64>) -> DMatrix<f64> {
        let mut all = DMatrix::zeros(self.freedoms, self.freedoms);
        for ((block, a), range) in self.parts(a).zip(&self.ranges) {
            let arms = block.arms(a);
            let along = Vector::new(block.axes[0].dot(mu), block.axes[1].dot(mu));
            for (i, one) in block.lifts.iter().enumerate() {
                for (j, other) in block.lifts.iter().enumerate() {
                    let terms = arms.iter().zip(one.iter().zip(other.iter()));
                    let sum: f64 = terms.map(|(arm, (x, y))| -(arm.re * along.re + arm.im * along.im) * x * y).sum();
                    all[(range.start + i, range.start + j)] = sum;
                }
            }
        }
        all
    }

    /// Returns W, block by block.
    pub fn metric(&self) -> DMatrix<f64> {
        let mut all = DMatrix::zeros(self.freedoms, self.freedoms);
        for (block, range) in self.blocks.iter().zip(&self.ranges) {
            for (i, one) in block.lifts.iter().enumerate() {
                for (j, other) in block.lifts.iter().enumerate() {
                    all[(range.start + i, range.start + j)] = one.dot(other);
                }
            }
        }
        all
    }

    /// Returns the bounds of each angle, rad; infinite if it turns freely.
    pub fn bounds(&self) -> Vec<[f64; 2]> {
        self.blocks.iter().flat_map(|block| (0..block.lifts.len()).map(|i| block.space.limits(i))).collect()
    }

    /// Returns m and h, rad; an angle that turns freely has the range of a turn.
    pub fn middles(&self) -> (DVector<f64>, DVector<f64>) {
        let limits = self.blocks.iter().flat_map(|block| block.space.joints()).map(|joint| joint.limits());
        let (m, h): (Vec<f64>, Vec<f64>) = limits.map(|[low, high]| (0.5 * (low + high), 0.5 * (high - low))).unzip();
        (DVector::from_vec(m), DVector::from_vec(h))
    }

    /// Returns a length by which errors of the place are measured, m: the sum of all arms.
    pub fn reach(&self) -> f64 {
        self.blocks.iter().map(|block| block.space.farthest()).sum()
    }
}
