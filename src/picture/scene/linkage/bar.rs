//! [`Bar`]: a link with what it carries, and where it lies in a pose.

use super::cover::Cover;
use super::flat::FlatLink;
use super::shape::Shape;
use crate::scene::{ItemChanges, Name, Polyline, Rgba, Solid, posed};
use stillbase_mechanics::machine::{Chain, place_of};
use stillbase_mechanics::planar::{UnitVectors, Vector};

/// A link with what it carries.
#[derive(Clone, Debug)]
pub struct Bar {
    /// Name of the link.
    pub name: String,
    pub(super) item: Name,
    /// Index of the mesh, which extends along x over the drawn interval; the root of the link is at x = 0.
    pub mesh: usize,
    /// Index of the drive that it follows, from 0.
    pub drive: usize,
    /// Whether it lies on the chain from the base to the end effector.
    pub carries_tip: bool,
    pub(super) root: Chain,
    pub(super) sign: f64,
    /// Length from root to tip, m.
    pub(super) length: f64,
    /// Interval along the link in which it is drawn, m.
    pub(super) span: [f64; 2],
    /// Half the width of its bar, m; 0 if it is made of plates alone.
    pub(super) radius: f64,
    /// Its height from its lower to its upper face, m.
    pub(super) height: f64,
    /// A line along a bar that is too narrow to be seen from afar.
    pub(super) thread: Option<Polyline>,
    /// What it carries, and its plates.
    pub(super) covers: Vec<Cover>,
    /// Height of its lower face, m.
    pub(super) z: f64,
}

/// Bars of less than this half width, as a fraction of the reach, have a line along them of this width, px.
const SLENDER: f64 = 0.003;
const THREAD_PX: f32 = 2.0;

/// Returns the line along a bar at the height of its upper face, m, if it is slender: about two pixels in a view of the
/// whole machine.
pub(super) fn thread(name: &str, shape: &Shape, reach: f64) -> Option<Polyline> {
    let is_slender = shape.radius > 0.0 && shape.radius < SLENDER * reach;
    let line = shape.span.map(|along| [along as f32, 0.0, shape.height as f32]).to_vec();
    is_slender.then(|| Polyline::new(format!("machine/link/{name}/axis"), [line], THREAD_PX, [0.0; 4]))
}

impl Bar {
    /// Name of its item in a scene.
    pub fn item(&self) -> &Name {
        &self.item
    }

    /// 1 if it points in the direction of its drive, −1 if opposite.
    pub fn sign(&self) -> f64 {
        self.sign
    }

    /// Returns its drawn end points for a fixed base, m.
    pub fn ends(&self, e: &UnitVectors) -> [[f64; 3]; 2] {
        let (root, along, z) = self.pose(e);
        self.span.map(|s| {
            let p = root + along * s;
            [p.re, p.im, z]
        })
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the position of its root, m, its direction, a unit vector, and its height, m.
    pub fn pose(&self, e: &UnitVectors) -> (Vector, Vector, f64) {
        (place_of(&self.root, e), e[self.drive] * self.sign, self.z)
    }

    pub(super) fn solid(&self, e: &UnitVectors, base: Vector, colour: Rgba) -> Solid {
        let (at, along, z) = self.pose(e);
        Solid {
            name: self.item.clone(),
            mesh: self.mesh,
            world_from_item: posed(base + at, along, z),
            colour,
            changes: ItemChanges::Pose,
        }
    }

    /// Returns the line along it, if it is slender.
    pub(super) fn line(&self, e: &UnitVectors, base: Vector, colour: Rgba) -> Option<Polyline> {
        let (at, along, z) = self.pose(e);
        let line = self.thread.clone()?.moving(posed(base + at, along, z));
        Some(Polyline { colour, ..line })
    }

    /// Returns it seen from straight above.
    pub(super) fn flat(&self, e: &UnitVectors) -> FlatLink {
        let (root, along, _) = self.pose(e);
        FlatLink {
            name: self.name.clone(),
            ends: self.span.map(|s| root + along * s),
            radius: self.radius,
            covers: self.covers.iter().map(|cover| cover.flat(root, along)).collect(),
            drive: self.drive,
        }
    }
}
