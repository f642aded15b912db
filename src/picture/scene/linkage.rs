//! The body of a machine: bars, pins, counterweights and drives, as meshes that do not change while it moves.
//!
//! Links that share a pin follow different drives, so each drive has its own layer and links do not intersect. A machine
//! with heights shows its links at these, as they are cut; so does a link with parts.

mod bar;
mod bodies;
mod cover;
mod flat;
mod heights;
mod motor;
mod pin;
mod real;
mod schematic;
mod shadow;
mod shape;
mod solids;

use std::sync::Arc;

use super::mesh::{self, cylinder};
use super::{Mesh, MeshSet};
use heights::Heights;
use motor::{DRIVE_HEIGHT, Motor};
use pin::Pin;
use stillbase_exchange::cut::Cut;
use stillbase_exchange::solids::{LinkSolid, has_heights, link_solids};
use stillbase_mechanics::machine::{Machine, place_of};
use stillbase_mechanics::planar::{UnitVectors, Vector};

pub use bar::Bar;
pub use flat::{FlatCover, FlatLink};

/// The meshes of a machine, and their placement in a pose.
#[derive(Clone, Debug)]
pub struct LinkageModel {
    /// Meshes that the solids refer to.
    pub model: Arc<MeshSet>,
    bars: Vec<Bar>,
    pins: Vec<Pin>,
    /// The pin at the base of a machine with heights.
    axis: Option<Pin>,
    motors: Vec<Motor>,
    plate: Disc,
    /// Plate of a moving base.
    body: Slab,
    /// The cover of the pin at the base.
    cap: Disc,
    top: f64,
    reach: f64,
}

/// A mesh around a vertical axis.
#[derive(Clone, Copy, Debug)]
struct Disc {
    mesh: usize,
    /// Radius, m.
    radius: f64,
    /// Height, m.
    height: f64,
}

impl Disc {
    fn of(meshes: &mut Vec<Mesh>, radius: f64, height: f64, bevel: f64) -> Self {
        Self { mesh: added(meshes, cylinder(radius, height, bevel)), radius, height }
    }
}

/// A plate with round ends.
#[derive(Clone, Copy, Debug)]
struct Slab {
    mesh: usize,
    /// Distance of the centres of its ends from its own, m.
    half_length: f64,
    /// Half its width, m.
    radius: f64,
    /// Height, m.
    height: f64,
}

/// Half length and half width of the plate of a moving base, as fractions of the reach.
pub const PLATE_HALF_SIZE: [f64; 2] = [0.2, 0.105];

/// Radius of the drives as a fraction of the reach of the machine.
const DRIVE_RADIUS: f64 = 0.042;

impl LinkageModel {
    /// Builds the body of a machine, with the dimensions of its parts, or else the usual ones.
    pub fn of(machine: &Machine) -> Self {
        Self::cut(machine, &Cut::default().fitting(machine))
    }

    /// Builds the body of a machine whose bars, pins and discs have these dimensions where it states none.
    pub fn cut(machine: &Machine, cut: &Cut) -> Self {
        let reach = reach_of(machine);
        let solids = drawn_solids(machine, cut);
        let heights = Heights::of(machine, reach, &solids);
        let gap = heights.gap;
        let carries = carriers(machine);
        let mut meshes = Vec::new();
        let mut bars = Vec::new();
        for (j, (link, part)) in machine.links().iter().zip(machine.resolved_links()).enumerate() {
            let shape = match solids.iter().any(|solid| solid.link == j) {
                true => real::real(machine, j, &solids),
                false => schematic::schematic(machine, j, carries[j], reach, heights.height),
            };
            bars.push(Bar {
                name: link.name.clone(),
                item: format!("machine/link/{}", link.name).into(),
                drive: part.drive,
                carries_tip: carries[j],
                root: part.root,
                sign: part.sign,
                length: part.length,
                span: shape.span,
                radius: shape.radius,
                height: shape.height,
                thread: bar::thread(&link.name, &shape, reach),
                covers: shape.covers,
                mesh: added(&mut meshes, shape.mesh),
                z: heights.middle[j] + shape.rise - 0.5 * shape.height,
            });
        }
        let faces: Vec<[f64; 2]> = bars.iter().map(|bar| [bar.z, bar.z + bar.height]).collect();
        let (axis, pins) = pin::pins(machine, (cut, reach), &heights, (&solids, &faces), &mut meshes);
        let motors = motor::motors(machine, (&heights, &faces), reach, &mut meshes);
        let (drive_height, drive_radius) = (DRIVE_HEIGHT * reach, DRIVE_RADIUS * reach);
        let (plate_height, plate_bevel) = (0.3 * drive_height, 0.05 * drive_height);
        let plate = Disc::of(&mut meshes, 2.0 * drive_radius, plate_height, plate_bevel);
        let [length, width] = PLATE_HALF_SIZE.map(|part| part * reach);
        let half_length = length - width;
        let mesh = added(&mut meshes, mesh::bar(-half_length, half_length, width, plate_height, plate_bevel));
        let body = Slab { mesh, half_length, radius: width, height: plate_height };
        let top = heights.top + 2.0 * gap;
        let cap = Disc::of(&mut meshes, 0.6 * drive_radius, top, 0.2 * gap);
        Self { model: Arc::new(MeshSet { meshes }), bars, pins, axis, motors, plate, body, cap, top, reach }
    }

    /// Upper bound of the end effector's distance from B, m.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Height of the plane just below the lowest links, m.
    pub fn floor(&self) -> f64 {
        -heights::GAP * self.reach
    }

    /// Height above every link, m.
    pub fn top(&self) -> f64 {
        self.top
    }

    /// Height of the plate under the drives, m; negative, because it lies below the links.
    pub fn bottom(&self) -> f64 {
        let on_base = self.motors.iter().filter(|motor| motor.at.is_none());
        on_base.fold(0.0_f64, |m, motor| m.min(motor.z)) - self.plate.height
    }

    /// Radius of the plate under the drives, m.
    pub fn foot(&self) -> f64 {
        self.plate.radius
    }

    /// Adds a mesh and returns its index.
    pub fn add(&mut self, mesh: Mesh) -> usize {
        added(&mut Arc::make_mut(&mut self.model).meshes, mesh)
    }

    /// The links.
    pub fn bars(&self) -> &[Bar] {
        &self.bars
    }

    /// Returns the position of each pin for a fixed base, m, and the links that it connects.
    pub fn joints(&self, e: &UnitVectors) -> impl Iterator<Item = ([f64; 3], &[usize])> {
        let e = *e;
        self.pins.iter().map(move |pin| {
            let at = place_of(&pin.at, &e);
            ([at.re, at.im, pin.z[1]], pin.links.as_slice())
        })
    }

    /// Returns the indices of the links that each pin joins, in the order of [`joints`](Self::joints).
    pub fn pins(&self) -> impl Iterator<Item = &[usize]> {
        self.pins.iter().map(|pin| pin.links.as_slice())
    }

    /// Returns the links seen from above for a fixed base, the lowest first.
    pub fn flat(&self, e: &UnitVectors) -> Vec<FlatLink> {
        let mut bars: Vec<&Bar> = self.bars.iter().collect();
        bars.sort_by(|a, b| a.z.total_cmp(&b.z));
        bars.into_iter().map(|bar| bar.flat(e)).collect()
    }

    /// Returns drive and end points, m, for a fixed base, of the links up to the end effector, in the file's order.
    pub fn skeleton(&self, e: &UnitVectors) -> Vec<(usize, [Vector; 2])> {
        let carriers = self.bars.iter().filter(|b| b.carries_tip);
        carriers
            .map(|bar| {
                let (root, along, _) = bar.pose(e);
                (bar.drive, [root, root + along * bar.length])
            })
            .collect()
    }

    /// Returns the end points, m, of the links between base and end effector, for a fixed base.
    pub fn outlines(&self, e: &UnitVectors) -> impl Iterator<Item = [Vector; 2]> {
        let e = *e;
        self.bars.iter().filter(|b| b.carries_tip).map(move |bar| {
            let (at, along, _) = bar.pose(&e);
            [at, at + along * bar.length]
        })
    }
}

/// Returns for each link whether it lies between base and end effector.
fn carriers(machine: &Machine) -> Vec<bool> {
    let mut carries = vec![false; machine.links().len()];
    let mut at = Some(machine.end_link());
    while let Some(j) = at {
        carries[j] = true;
        at = machine.resolved_links()[j].parent;
    }
    carries
}

/// Returns the solids of the links that are drawn as they are cut: all links of a machine with heights, and links with
/// parts.
fn drawn_solids(machine: &Machine, cut: &Cut) -> Vec<LinkSolid> {
    let all = has_heights(machine);
    if !all && machine.part_bodies().is_empty() {
        return Vec::new();
    }
    let mut solids = link_solids(machine, cut);
    solids.retain(|solid| all || machine.parts_of_link(solid.link).is_some());
    solids
}

/// Adds a mesh and returns its index.
fn added(meshes: &mut Vec<Mesh>, mesh: Mesh) -> usize {
    meshes.push(mesh);
    meshes.len() - 1
}

fn reach_of(machine: &Machine) -> f64 {
    machine.reach().max(1e-6)
}
