//! [`LinkSolid`] and [`Axle`]: bars, discs and pins of a machine as they are cut, seen from above.

use super::cut::{Cut, SAME_PIN_DISTANCE, bar_extent};
use stillbase_mechanics::machine::{Chain, Machine};
use stillbase_mechanics::planar::{MAX_DRIVES, Vector};

/// A solid of a link: a bar with round ends, or a disc, whose two ends coincide.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkSolid {
    /// The link that it belongs to, counted from 0.
    pub link: usize,
    /// What it is.
    pub kind: SolidKind,
    /// Centres of its round ends, m: along the link from its root, and to the left of its axis.
    pub ends: [Vector; 2],
    /// Radius of its ends, m.
    pub radius: f64,
    /// Its thickness, m; its middle is at the height of the link.
    pub thickness: f64,
}

/// What a solid of a link is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidKind {
    /// The bar of the link.
    Bar,
    /// The bar across that joins a disc beside the link to it; the counterweight, counted from 0.
    Arm(usize),
    /// The disc of a counterweight, counted from 0.
    Disc(usize),
}

/// A pin that joins links: points of these that coincide in every pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Axle {
    /// Its position, m.
    pub at: Chain,
    /// The links that it joins and the position along each, m from its root.
    pub links: Vec<(usize, f64)>,
}

impl LinkSolid {
    /// Returns its name in words.
    pub fn name(&self, machine: &Machine) -> String {
        let link = &machine.spec().links[self.link].name;
        match self.kind {
            SolidKind::Bar => format!("link {link}"),
            SolidKind::Arm(i) => format!("arm of counterweight {} on link {link}", i + 1),
            SolidKind::Disc(i) => format!("counterweight {} on link {link}", i + 1),
        }
    }
}

impl Axle {
    /// Returns whether it is the axis of the drives on the base, which begins at the base plate.
    pub fn is_on_base(&self) -> bool {
        self.at == [0.0; MAX_DRIVES]
    }

    /// Returns whether it joins a link to another or to the base; else it is a hole that nothing passes.
    pub fn is_pin(&self) -> bool {
        self.links.len() > 1 || self.is_on_base()
    }

    /// Returns the heights of its lower and upper end, m; `None` if it joins links of one height.
    pub fn faces(&self, machine: &Machine, cut: &Cut) -> Option<[f64; 2]> {
        let heights = self.links.iter().map(|(j, _)| machine.spec().links[*j].axial);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        let half = 0.5 * cut.plate_thickness;
        let faces =
            if self.is_on_base() { [base_height(machine, cut), high + half] } else { [low - half, high + half] };
        (high > low || self.links.len() == 1).then_some(faces)
    }

    /// Returns whether it passes through a link.
    pub fn joins(&self, link: usize) -> bool {
        self.links.iter().any(|(own, _)| *own == link)
    }

    /// Returns its name in words.
    pub fn name(&self, machine: &Machine) -> String {
        if self.is_on_base() {
            return "axis of the base".into();
        }
        let names: Vec<&str> = self.links.iter().map(|(j, _)| machine.spec().links[*j].name.as_str()).collect();
        match names.as_slice() {
            [one] => format!("pin of link {one}"),
            [first @ .., last] => format!("pin of links {} and {last}", first.join(", ")),
            [] => "pin".into(),
        }
    }
}

/// Returns the height of the base plate, m: a spacer below the lowest solid.
pub fn base_height(machine: &Machine, cut: &Cut) -> f64 {
    let low = |solid: LinkSolid| machine.spec().links[solid.link].axial - 0.5 * solid.thickness;
    link_solids(machine, cut).into_iter().map(low).fold(f64::INFINITY, f64::min) - cut.spacer
}

/// Returns the solids of all links, in the order of the links: the bar first, then its discs. A counterweight that is
/// a point has no solid.
pub fn link_solids(machine: &Machine, cut: &Cut) -> Vec<LinkSolid> {
    let mut solids = Vec::new();
    for (link, own) in machine.spec().links.iter().enumerate() {
        let [from, to] = bar_extent(machine, link).map(|along| Vector::new(along, 0.0));
        let [width, thickness] = bar_section(machine, link).unwrap_or([cut.bar_width, cut.plate_thickness]);
        let radius = 0.5 * width;
        let bar = |kind, ends| LinkSolid { link, kind, ends, radius, thickness };
        solids.push(bar(SolidKind::Bar, [from, to]));
        for (i, weight) in machine.spec().counterweights.iter().enumerate().filter(|(_, w)| w.link == own.name) {
            let Some(thickness) = cut.thickness_of(weight) else { continue };
            let at = Vector::new(weight.at, weight.across);
            if weight.across.abs() > radius {
                solids.push(bar(SolidKind::Arm(i), [Vector::new(weight.at, 0.0), at]));
            }
            let kind = SolidKind::Disc(i);
            solids.push(LinkSolid { link, kind, ends: [at; 2], radius: weight.radius, thickness });
        }
    }
    solids
}

/// Returns width in the plane of the motion and height normal to it of the bar of a link, m; `None` if no part is one.
fn bar_section(machine: &Machine, link: usize) -> Option<[f64; 2]> {
    let part = &machine.spec().parts[machine.spine(link)?];
    let width = part.breadth()?;
    Some([width, part.thickness.or(part.height).unwrap_or(width)])
}

/// Returns the pins of a machine, that at the base first.
pub fn axles(machine: &Machine) -> Vec<Axle> {
    let mut axles: Vec<Axle> = Vec::new();
    for (j, part) in machine.resolved_links().iter().enumerate() {
        for &along in &part.pins {
            let at = part.point(along).map(|weight| if weight.abs() <= SAME_PIN_DISTANCE { 0.0 } else { weight });
            let is_same = |axle: &&mut Axle| axle.at.iter().zip(&at).all(|(a, b)| (a - b).abs() <= SAME_PIN_DISTANCE);
            match axles.iter_mut().find(is_same) {
                Some(axle) if axle.joins(j) => {}
                Some(axle) => axle.links.push((j, along)),
                None => axles.push(Axle { at, links: vec![(j, along)] }),
            }
        }
    }
    axles.sort_by_key(|axle| !axle.is_on_base());
    axles
}
