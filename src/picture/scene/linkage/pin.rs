//! [`Pin`]: a pin of a machine, with the spacers around it.

use super::added;
use super::heights::Heights;
use super::schematic::THIN_BAR_RADIUS;
use crate::scene::Mesh;
use crate::scene::mesh::{cylinder, ring};
use stillbase_exchange::cut::Cut;
use stillbase_exchange::solids::{Axle, LinkSolid, axles};
use stillbase_mechanics::machine::{Chain, Machine};

/// Radius of the dot on a thin pin, as a fraction of the reach.
const LEAST_DOT: f64 = 0.0028;

/// A pin.
#[derive(Clone, Debug)]
pub struct Pin {
    pub at: Chain,
    /// Indices of the links that it connects.
    pub links: Vec<usize>,
    pub size: PinSize,
    /// Heights of its lower and upper end, m.
    pub z: [f64; 2],
    /// Heights of the lower and the upper end of each spacer around it, m.
    pub spacers: Vec<[f64; 2]>,
}

/// The meshes of pins of one size; each pin and spacer is stretched to its length.
#[derive(Clone, Copy, Debug)]
pub struct PinSize {
    pub pin: usize,
    pub spacer: usize,
    /// Mesh of the hole or dot drawn on the top.
    pub hole: usize,
    /// Length of the meshes, m.
    pub length: f64,
}

impl PinSize {
    /// Pins that are drawn so that they are seen well, with the gap by which they stand out, m.
    fn usual(meshes: &mut Vec<Mesh>, reach: f64, length: f64, gap: f64) -> Self {
        let radius = 0.62 * THIN_BAR_RADIUS * reach;
        let pin = added(meshes, cylinder(1.25 * radius, length, 0.15 * radius));
        let spacer = added(meshes, ring(1.9 * radius, 1.25 * radius, length));
        let hole = added(meshes, cylinder(0.7 * radius, 0.2 * gap, 0.0));
        Self { pin, spacer, hole, length }
    }

    /// Pins as they are cut, with a dot that shows them where they are thin.
    fn real(meshes: &mut Vec<Mesh>, cut: &Cut, reach: f64, gap: f64) -> Self {
        let (radius, length) = (0.5 * cut.pin_diameter, cut.plate_thickness);
        let pin = added(meshes, cylinder(radius, length, 0.0));
        let spacer = added(meshes, ring(cut.spacer_radius(), radius, length));
        let hole = added(meshes, cylinder(radius.max(LEAST_DOT * reach), 0.2 * gap, 0.0));
        Self { pin, spacer, hole, length }
    }

    /// Returns the ratio of a length between two heights, m, to that of the mesh.
    pub fn stretch(&self, [low, high]: [f64; 2]) -> f64 {
        (high - low) / self.length
    }
}

/// Returns the pins of a machine, first that at its base, which is drawn if the machine has heights of its own. `solids`
/// are those of the links that are drawn as they are cut, `faces` the heights of the lower and the upper face of the bar
/// of each link, m.
pub fn pins(
    machine: &Machine,
    (cut, reach): (&Cut, f64),
    heights: &Heights,
    (solids, faces): (&[LinkSolid], &[[f64; 2]]),
    meshes: &mut Vec<Mesh>,
) -> (Option<Pin>, Vec<Pin>) {
    let is_cut = |axle: &Axle| axle.links.iter().all(|(j, _)| solids.iter().any(|solid| solid.link == *j));
    let (base, others): (Vec<Axle>, Vec<Axle>) = axles(machine).into_iter().partition(Axle::is_on_base);
    // All pins of a machine have one size, so that they are one item.
    let size = match others.iter().chain(&base).all(is_cut) {
        true => PinSize::real(meshes, cut, reach, heights.gap),
        false => PinSize::usual(meshes, reach, heights.height + 2.0 * heights.gap, heights.gap),
    };
    let made = |axle: Axle| {
        let (z, spacers) = match heights.lowest {
            Some(lowest) => {
                let above = |faces: [f64; 2]| faces.map(|z| z - lowest);
                let z = axle.faces(machine, cut).unwrap_or_else(|| axle.span(machine, cut));
                let spacers = axle.spacers(machine, cut, solids);
                (above(z), spacers.into_iter().map(|spacer| above(spacer.faces)).collect())
            }
            None => {
                let own = axle.links.iter().map(|(j, _)| faces[*j]);
                let ends = own
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], own| [low.min(own[0]), high.max(own[1])]);
                ([ends[0] - heights.gap, ends[1] + heights.gap], Vec::new())
            }
        };
        Pin { at: axle.at, links: axle.links.into_iter().map(|(j, _)| j).collect(), size, z, spacers }
    };
    let base = base.into_iter().next().filter(|_| heights.lowest.is_some()).map(made);
    (base, others.into_iter().map(made).collect())
}
