//! [`LinkSolid`] and [`Axle`]: bars, plates, discs, lumps and pins of a machine as they are built, seen from above.
//!
//! A link with parts has the shapes of its parts; another one is a bar over its pins. The arm to a counterweight is the
//! part that carries it, or else a bar across. A lump and the payload state no shape: they are cylinders of the material
//! of the discs, as wide as gives them their inertia, and without inertia as high as wide.

mod axle;
mod body;
mod plan;

pub use super::mesh::SolidMesh;
pub use axle::{Axle, Spacer, axles};
pub use plan::{Plan, encloses, foot};

use super::cut::{Cut, bar_extent};
use stillbase_mechanics::machine::{Cylinder, Ends, Machine, Part, PartBody, PartSource, Shape};
use stillbase_mechanics::planar::Vector;

/// A solid of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkSolid {
    /// The link that it belongs to, counted from 0.
    pub link: usize,
    /// What it is.
    pub kind: SolidKind,
    /// The part that it is, counted from 0; `None` for what is no part.
    pub part: Option<usize>,
    /// The area that it covers: along the link from its root, and to the left of its axis, m.
    pub plan: Plan,
    /// Centre, m, and diameter, m, of each hole through it.
    pub holes: Vec<(Vector, f64)>,
    /// Its thickness, m.
    pub thickness: f64,
    /// Height of its middle above that of its link, m.
    pub rise: f64,
}

/// What a solid of a link is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidKind {
    /// The bar of the link.
    Bar,
    /// Another bar or a plate.
    Part,
    /// The bar across that joins a disc beside the link to it; the counterweight, counted from 0.
    Arm(usize),
    /// The disc of a counterweight, counted from 0.
    Disc(usize),
    /// A lump, counted from 0.
    Lump(usize),
    /// The payload.
    Payload,
}

impl LinkSolid {
    /// Returns its name in words.
    pub fn name(&self, machine: &Machine) -> String {
        let spec = machine.spec();
        let link = &spec.links[self.link].name;
        match self.kind {
            SolidKind::Bar => format!("link {link}"),
            SolidKind::Part => {
                let title = self.part.and_then(|i| spec.parts.get(i)).map_or_else(|| "part".into(), Part::title);
                format!("{title} on link {link}")
            }
            SolidKind::Arm(i) => format!("arm to counterweight {} on link {link}", i + 1),
            SolidKind::Disc(i) => format!("counterweight {} on link {link}", i + 1),
            SolidKind::Lump(i) if spec.lumps[i].name.is_empty() => format!("lump {} on link {link}", i + 1),
            SolidKind::Lump(i) => format!("{} on link {link}", spec.lumps[i].name),
            SolidKind::Payload => format!("payload on link {link}"),
        }
    }

    /// Returns the heights of its lower and upper face, m.
    pub fn faces(&self, machine: &Machine) -> [f64; 2] {
        let middle = machine.spec().links[self.link].axial + self.rise;
        [middle - 0.5 * self.thickness, middle + 0.5 * self.thickness]
    }

    fn drilled(mut self, holes: Vec<(Vector, f64)>) -> Self {
        self.holes = holes;
        self
    }
}

/// Returns whether a machine states heights of its links, which differ; else all links lie at one.
pub fn has_heights(machine: &Machine) -> bool {
    machine.spec().links.windows(2).any(|pair| pair[0].axial != pair[1].axial)
}

/// Returns the height of the base plate, m: a spacer below the lowest solid.
pub fn base_height(machine: &Machine, cut: &Cut) -> f64 {
    let low = |solid: LinkSolid| solid.faces(machine)[0];
    link_solids(machine, cut).into_iter().map(low).fold(f64::INFINITY, f64::min) - cut.spacer
}

/// Returns the solids of all links, in the order of the links: bar, other parts, arms and discs of counterweights,
/// lumps, the payload. A counterweight that is a point has no solid.
pub fn link_solids(machine: &Machine, cut: &Cut) -> Vec<LinkSolid> {
    (0..machine.links().len()).flat_map(|link| LinkSolids { machine, cut, link }.all()).collect()
}

/// The solids of one link.
struct LinkSolids<'a> {
    machine: &'a Machine,
    cut: &'a Cut,
    link: usize,
}

impl LinkSolids<'_> {
    fn all(&self) -> Vec<LinkSolid> {
        let own = |body: &&PartBody| body.link == self.link;
        let bodies: Vec<&PartBody> = self.machine.part_bodies().iter().filter(own).collect();
        let spine = self.machine.spine(self.link);
        let mut solids: Vec<LinkSolid> = bodies.iter().filter_map(|body| self.part(body, spine)).collect();
        solids.sort_by_key(|solid| solid.kind != SolidKind::Bar);
        if solids.is_empty() {
            solids.push(self.drawn_bar());
        }
        self.add_counterweights(&mut solids);
        let density = self.cut.density;
        for PartBody { source, body, .. } in bodies {
            if let (PartSource::Lump(i), Some(own)) = (source, Cylinder::of(body.mass, body.inertia, density)) {
                let at = Vector::new(body.at, body.across);
                solids.push(self.solid(SolidKind::Lump(*i), Plan::disc(at, own.radius), own.height));
            }
        }
        solids.extend(self.payload());
        solids
    }

    fn solid(&self, kind: SolidKind, plan: Plan, thickness: f64) -> LinkSolid {
        LinkSolid { link: self.link, kind, part: None, plan, holes: Vec::new(), thickness, rise: 0.0 }
    }

    /// Returns the bar of a link without parts: over all its pins and counterweights, with a hole for each pin.
    fn drawn_bar(&self) -> LinkSolid {
        let ends = bar_extent(self.machine, self.link).map(|along| Vector::new(along, 0.0));
        let pins = self.machine.pin_places(self.link).into_iter();
        let holes = pins.map(|along| (Vector::new(along, 0.0), self.cut.pin_diameter)).collect();
        let bar = Plan::bar(ends, 0.5 * self.cut.bar_width);
        self.solid(SolidKind::Bar, bar, self.cut.plate_thickness).drilled(holes)
    }

    fn part(&self, body: &PartBody, spine: Option<usize>) -> Option<LinkSolid> {
        let PartSource::Part(i) = body.source else { return None };
        let part = &self.machine.spec().parts[i];
        let [from, to] = self.machine.part_ends(i)?;
        let (across, half) = (part.across, 0.5 * part.breadth().unwrap_or_default());
        let is_round = part.shape == Shape::Flat && part.ends.unwrap_or_default() == Ends::Round;
        let plan = match part.shape {
            Shape::Plate => Plan::polygon(part.polygon.iter().map(|[x, y]| Vector::new(*x, y + across))),
            _ if is_round => Plan::bar([from, to].map(|along| Vector::new(along, across)), half),
            _ => {
                let corners = [[from, across - half], [to, across - half], [to, across + half], [from, across + half]];
                Plan::polygon(corners.map(|[x, y]| Vector::new(x, y)))
            }
        };
        let thickness = part.thickness.or(part.height).or(part.diameter).unwrap_or(self.cut.plate_thickness);
        let kind = if spine == Some(i) { SolidKind::Bar } else { SolidKind::Part };
        let holes = self.machine.part_holes(i).into_iter();
        let holes = holes.map(|([x, y], diameter)| (Vector::new(x, y + across), diameter)).collect();
        Some(LinkSolid { part: Some(i), ..self.solid(kind, plan, thickness).drilled(holes) })
    }

    fn add_counterweights(&self, solids: &mut Vec<LinkSolid>) {
        let name = &self.machine.spec().links[self.link].name;
        let weights = self.machine.spec().counterweights.iter().enumerate().filter(|(_, weight)| weight.link == *name);
        for (i, weight) in weights {
            let Some(thickness) = self.cut.thickness_of(weight) else { continue };
            let at = Vector::new(weight.at, weight.across);
            let [width, own] = self.bar_section(solids);
            let is_carried = solids.iter().any(|solid| solid.plan.distance(at) <= CARRIED);
            if weight.across.abs() > 0.5 * width && !is_carried {
                let arm = Plan::bar([Vector::new(weight.at, 0.0), at], 0.5 * width);
                solids.push(self.solid(SolidKind::Arm(i), arm, own));
            }
            let plan = match weight.polygon(CURVE_SIDES) {
                corners if weight.half || weight.length > 0.0 => Plan::polygon(corners),
                _ => Plan::disc(at, weight.radius),
            };
            let is_ring = weight.inner_radius > 0.0 && !weight.half;
            let bore = is_ring.then_some((at, 2.0 * weight.inner_radius));
            // An edge that a hole would cut through stays whole.
            let (_, size) = weight.around();
            let is_within = |(pin, diameter): &(Vector, f64)| {
                let half = 0.5 * diameter;
                plan.distance(*pin) + half < -EDGE_SHARE * size
                    && bore.is_none_or(|(_, bore)| (pin - at).norm() - half > 0.5 * bore)
            };
            let holes = solids.first().map_or_else(Vec::new, |bar| bar.holes.clone());
            let holes = holes.into_iter().filter(is_within).chain(bore).collect();
            solids.push(self.solid(SolidKind::Disc(i), plan.clone(), thickness).drilled(holes));
        }
    }

    /// Returns width and thickness of the bar of the link, m, or else of the bars that are cut.
    fn bar_section(&self, solids: &[LinkSolid]) -> [f64; 2] {
        let bar = solids.first().filter(|solid| solid.kind == SolidKind::Bar && !solid.plan.is_polygon());
        bar.map_or([self.cut.bar_width, self.cut.plate_thickness], |bar| [2.0 * bar.plan.radius, bar.thickness])
    }

    fn payload(&self) -> Option<LinkSolid> {
        let (machine, payload) = (self.machine, self.machine.spec().payload);
        let own = Cylinder::of(payload.mass, payload.inertia, self.cut.density)?;
        if machine.end_link() != self.link {
            return None;
        }
        let part = &machine.resolved_links()[self.link];
        let end = part.sign * (machine.end_effector()[part.drive] - part.root[part.drive]);
        let [along, left] = payload.offset;
        let plan = Plan::disc(Vector::new(end + along, left), own.radius);
        let rise = payload.axial - machine.spec().links[self.link].axial;
        Some(LinkSolid { rise, ..self.solid(SolidKind::Payload, plan, own.height) })
    }
}

/// A counterweight whose centre lies on a solid, or as near to it as this, m, is carried by it.
const CARRIED: f64 = 1e-9;
/// Width of the edge of a counterweight that is not drilled, as a fraction of its radius.
const EDGE_SHARE: f64 = 0.02;
/// Number of straight sides of a whole circle, in the outline of half a ring.
const CURVE_SIDES: usize = 64;
