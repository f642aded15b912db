//! [`Axle`]: a pin of a machine.

use crate::cut::{Cut, SAME_PIN_DISTANCE};
use crate::solids::{LinkSolid, base_height};
use stillbase_mechanics::machine::{Chain, Machine};
use stillbase_mechanics::planar::{MAX_DRIVES, Vector};

/// A pin that joins links: points of these that coincide in every pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Axle {
    /// Its position, m.
    pub at: Chain,
    /// The links that it joins and the position along each, m from its root.
    pub links: Vec<(usize, f64)>,
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

    /// Returns the heights of the lower face of its lowest link and of the upper face of its uppermost one, m.
    pub fn span(&self, machine: &Machine, cut: &Cut) -> [f64; 2] {
        let heights = self.links.iter().map(|(j, _)| machine.spec().links[*j].axial);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        let half = 0.5 * cut.plate_thickness;
        [low - half, high + half]
    }

    /// Returns the heights of its lower and upper end, m; `None` if it joins links of one height.
    pub fn faces(&self, machine: &Machine, cut: &Cut) -> Option<[f64; 2]> {
        let height = |(j, _): &(usize, f64)| machine.spec().links[*j].axial;
        let is_of_one_height = self.links.windows(2).all(|pair| height(&pair[0]) == height(&pair[1]));
        let [low, high] = self.span(machine, cut);
        let low = if self.is_on_base() { base_height(machine, cut) } else { low };
        (!is_of_one_height || self.links.len() == 1).then_some([low, high])
    }

    /// Returns the links that it joins, the lowest first.
    pub(crate) fn upwards(&self, machine: &Machine) -> Vec<usize> {
        let height = |j: usize| machine.spec().links[j].axial;
        let mut joined: Vec<usize> = self.links.iter().map(|(j, _)| *j).collect();
        joined.sort_by(|i, j| height(*i).total_cmp(&height(*j)));
        joined
    }

    /// Returns the spacers around it, the lowest first: each from one link to the next, or from the base plate to the
    /// lowest link. `solids` are those of all links.
    pub fn spacers(&self, machine: &Machine, cut: &Cut, solids: &[LinkSolid]) -> Vec<Spacer> {
        let Some([base, _]) = self.faces(machine, cut) else { return Vec::new() };
        // A disc or a lump that reaches under a spacer is thicker than its bar.
        let around = |j: usize| {
            let along = self.links.iter().find(|(own, _)| *own == j).map_or(0.0, |(_, along)| *along);
            let own = solids.iter().filter(|solid| solid.link == j);
            let covering = own.filter(|solid| solid.plan.distance(Vector::new(along, 0.0)) < cut.spacer_radius());
            let height = machine.spec().links[j].axial;
            covering
                .map(|solid| solid.faces(machine))
                .fold([height; 2], |[low, high], own| [low.min(own[0]), high.max(own[1])])
        };
        let (mut below, mut spacers) = (self.is_on_base().then_some(base), Vec::new());
        for (i, j) in self.upwards(machine).into_iter().enumerate() {
            let [bottom, top] = around(j);
            if let Some(below) = below.filter(|below| bottom - below > SAME_PIN_DISTANCE) {
                spacers.push(Spacer { number: i + 1, faces: [below, bottom] });
            }
            below = Some(top);
        }
        spacers
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

/// A spacer on a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spacer {
    /// Number of the link above it on the pin, from 1 for the lowest.
    pub number: usize,
    /// Heights of its lower and upper face, m.
    pub faces: [f64; 2],
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
