//! A link without parts, in a machine without heights: a bar as wide as shows it well, with its counterweights to scale.

use super::cover::Cover;
use super::shape::Shape;
use crate::scene::Mesh;
use crate::scene::mesh::{SEGMENTS, bar, cylinder, ribbon, ring};
use stillbase_mechanics::machine::{Counterweight, Machine};
use stillbase_mechanics::planar::Vector;

/// Half the width of a bar, as a fraction of the reach: on the way to the end effector, and of all others.
const BAR_RADIUS: f64 = 0.0135;
pub const THIN_BAR_RADIUS: f64 = 0.0085;
/// Radius of the disc that stands for the counterweight of the heaviest link, as a fraction of the reach.
const WEIGHT_RADIUS: f64 = 0.05;
/// Height of a disc relative to that of its bar.
const DISC_HEIGHT: f64 = 1.6;

/// Returns the shape of a link, counted from 0, for the reach of the machine, m, and the height of bars, m.
pub fn schematic(machine: &Machine, j: usize, carries: bool, reach: f64, height: f64) -> Shape {
    let link = &machine.links()[j];
    let heaviest = machine.links().iter().fold(0.0_f64, |m, l| m.max(l.mass));
    let radius = reach * if carries { BAR_RADIUS } else { THIN_BAR_RADIUS };
    let [from, to] = machine.extent_with(j, |_| false);
    let weights = machine.spec().counterweights.iter().filter(|weight| weight.link == link.name);
    let mut discs: Vec<Disc> = weights.map(|weight| Disc::of(weight, radius)).collect();
    if discs.is_empty() && (link.com < from || link.com > to) {
        // If the centre of mass is beyond the ends, a disc there suggests a counterweight; area ∝ mass of the link.
        let size = reach * WEIGHT_RADIUS * (link.mass / heaviest).sqrt();
        discs.push(Disc::round(Vector::new(link.com, link.com_normal), size, radius));
    }
    let span = discs.iter().fold([from, to], |[from, to], disc| [from.min(disc.at.re), to.max(disc.at.re)]);
    let mut mesh = bar(span[0], span[1], radius, height, 0.2 * height);
    for disc in &discs {
        disc.add_to(&mut mesh, height);
        if disc.at.im.abs() > disc.radius {
            // An arm across joins a disc beside the bar to it.
            let arm = bar(disc.at.im.min(0.0), disc.at.im.max(0.0), radius, height, 0.2 * height);
            append(&mut mesh, &quarter_turned(arm), [disc.at.re, 0.0, 0.0]);
        }
    }
    Shape { mesh, span, radius, height, rise: 0.0, covers: discs.into_iter().map(|disc| disc.cover(height)).collect() }
}

/// A counterweight.
struct Disc {
    at: Vector,
    /// Ends of a segment about which it lies, m; equal for a round one.
    ends: [Vector; 2],
    /// Distance from the segment within which it lies, m: the radius of a round one.
    radius: f64,
    /// Pairs of opposite points of its long sides, m; empty for a round one.
    rails: Vec<[Vector; 2]>,
    /// Radius of its bore, m.
    inner_radius: f64,
}

impl Disc {
    fn round(at: Vector, size: f64, bar_radius: f64) -> Self {
        Self { at, ends: [at; 2], radius: size.max(1.5 * bar_radius), rails: Vec::new(), inner_radius: 0.0 }
    }

    fn of(weight: &Counterweight, bar_radius: f64) -> Self {
        let (ends, size) = weight.around();
        let round = Self::round(Vector::new(weight.at, weight.across), size, bar_radius);
        match weight.rails(SEGMENTS) {
            rails if rails.is_empty() => Self { inner_radius: weight.inner_radius, ..round },
            rails => Self { ends, radius: size, rails, ..round },
        }
    }

    /// Adds it to the mesh of its link, whose bar has a height, m.
    fn add_to(&self, mesh: &mut Mesh, bar_height: f64) {
        let height = DISC_HEIGHT * bar_height;
        let at = [self.at.re, self.at.im, 0.5 * (bar_height - height)];
        match self.rails.is_empty() {
            true if self.inner_radius > 0.0 => append(mesh, &ring(self.radius, self.inner_radius, height), at),
            true => append(mesh, &cylinder(self.radius, height, 0.2 * bar_height), at),
            false => {
                let rails = self.rails.iter().map(|pair| pair.map(|p| [p.re, p.im]));
                append(mesh, &ribbon(&rails.collect::<Vec<_>>(), height), [0.0, 0.0, at[2]]);
            }
        }
    }

    fn cover(self, bar_height: f64) -> Cover {
        let height = DISC_HEIGHT * bar_height;
        let quad = |pair: &[[Vector; 2]]| vec![pair[0][0], pair[1][0], pair[1][1], pair[0][1]];
        Cover {
            at: self.at,
            ends: self.ends,
            radius: self.radius,
            areas: self.rails.windows(2).map(quad).collect(),
            z: 0.5 * (bar_height - height),
            height,
        }
    }
}

/// Turns a mesh by a quarter turn counter-clockwise about z, x to y.
fn quarter_turned(mut mesh: Mesh) -> Mesh {
    for [x, y, _] in mesh.positions.iter_mut().chain(&mut mesh.normals) {
        (*x, *y) = (-*y, *x);
    }
    mesh.coarse = mesh.coarse.map(|coarse| Box::new(quarter_turned(*coarse)));
    mesh
}

/// Adds the mesh `other`, shifted by `shift`, m, to the mesh `to`. A coarse mesh of `to` receives that of `other`.
fn append(to: &mut Mesh, other: &Mesh, shift: [f64; 3]) {
    if let Some(coarse) = &mut to.coarse {
        append(coarse, other.coarse.as_deref().unwrap_or(other), shift);
    }
    let first = to.positions.len() as u32;
    to.positions.extend(other.positions.iter().map(|p| [0, 1, 2].map(|i| p[i] + shift[i] as f32)));
    to.normals.extend(&other.normals);
    to.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + first)));
}
