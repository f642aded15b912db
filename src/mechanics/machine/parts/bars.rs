//! [`BarStock`]: bars of one section, cut to the lengths that pins and counterweights of a machine ask for.

use super::super::counterweight::Counterweight;
use super::super::error::MachineError;
use super::super::model::Machine;
use super::super::spec::PlaceOnLink;
use super::derived::LinkNumber;
use super::part::{Hole, Part, Shape};
use super::weigh::{PartBody, PartSource};

/// Places closer than this are one, m.
const SAME_PLACE: f64 = 1e-9;
/// A counterweight beyond the end of a part by at most this still lies on it, m: places of light ones have an error of
/// the solver.
const CARRIED: f64 = 1e-6;
/// Name of a bar that is cut anew with every design.
const CUT_BAR: &str = "cut bar";
/// Name of the bar of a drawing, which keeps its section and follows its pins.
const DRAWN_BAR: &str = "drawn bar";
/// How the name of an arm begins, which carries a counterweight off the axis of its link.
const ARM: &str = "arm to counterweight";

/// A flat bar as it is bought, and the holes that its pins need.
#[derive(Clone, Debug, PartialEq)]
pub struct BarStock {
    /// Width in the plane of the motion, m.
    pub width: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Name of the material: one of [`MATERIALS`](super::MATERIALS) or of the machine.
    pub material: String,
    /// Diameter of the hole for each pin, m.
    pub pin_diameter: f64,
}

impl Default for BarStock {
    /// Aluminium, 30 mm by 6 mm, with pins of 8 mm.
    fn default() -> Self {
        Self { width: 0.03, thickness: 0.006, material: super::material::USUAL.into(), pin_diameter: 0.008 }
    }
}

impl BarStock {
    /// Returns a bar of this stock from one place on a link to another, with holes at places.
    fn bar(&self, link: &str, [from, to]: [PlaceOnLink; 2], holes: impl IntoIterator<Item = PlaceOnLink>) -> Part {
        let hole = |at| Hole { at, across: 0.0, diameter: self.pin_diameter };
        Part {
            from,
            to,
            holes: holes.into_iter().map(hole).collect(),
            width: Some(self.width),
            material: self.material.clone(),
            ..Part::flat(link, self.thickness)
        }
    }
}

impl Part {
    /// Returns the bar of the usual stock that a drawn link is: from root to tip, with a hole for each of both pins.
    pub fn drawn(link: &str) -> Self {
        let ends = || ["root", "tip"].map(|word| PlaceOnLink::Named(word.into()));
        Self { name: DRAWN_BAR.into(), ..BarStock::default().bar(link, ends(), ends()) }
    }

    /// Returns whether it is the bar of a drawing, which follows the pins of its link.
    pub fn is_drawn(&self) -> bool {
        self.name == DRAWN_BAR && self.shape != Shape::Plate
    }

    /// Returns whether it is an arm that [`Machine::with_bars`] added to carry a counterweight.
    pub fn is_arm(&self) -> bool {
        self.name.starts_with(ARM)
    }

    /// Returns whether [`Machine::with_bars`] cuts it anew, or takes it off.
    pub fn is_cut(&self) -> bool {
        self.is_arm() || self.name == CUT_BAR
    }

    /// Returns the part once someone has changed it. A bar that is cut anew loses its name: it is a part of its own from
    /// now on, and no design replaces it.
    #[must_use]
    pub fn changed_by_hand(self) -> Self {
        if self.is_cut() { Self { name: String::new(), ..self } } else { self }
    }

    /// Returns whether it has a name of its own; a bar that is drawn or cut anew is named after its section.
    pub(super) fn has_own_name(&self) -> bool {
        !["", CUT_BAR, DRAWN_BAR].contains(&self.name.as_str())
    }
}

impl Machine {
    /// Returns the machine with its links as they are cut: a bar of every link reaches from `reach[j][0]` to
    /// `reach[j][1]`, m from its root, and at least over root, tip, pins and fixed counterweights. A link without parts
    /// becomes a bar of the stock, whose numbers replace those of the link; so does one whose bar was cut before. Lumps
    /// and parts of other names stay; arms go.
    ///
    /// # Errors
    /// If the stock does not fit the machine.
    pub fn with_bars(&self, stock: &BarStock, reach: &[[f64; 2]]) -> Result<Self, MachineError> {
        let mut spec = self.spec().clone();
        let spines: Vec<Option<usize>> = (0..spec.links.len()).map(|j| self.spine(j)).collect();
        let ends = |j: usize| {
            let [from, to] = self.least_extent(j);
            let [low, high] = reach.get(j).copied().unwrap_or([from, to]);
            [from.min(low), to.max(high)].map(|at| place(at, self.resolved_links()[j].length))
        };
        let kept = self.spec().parts.iter().enumerate().filter(|(_, part)| !part.is_cut());
        let kept = kept.map(|(i, part)| match spines.iter().position(|spine| *spine == Some(i)) {
            Some(j) => {
                let [from, to] = ends(j);
                Part { from, to, ..part.clone() }
            }
            None => part.clone(),
        });
        spec.parts = kept.collect();
        for j in 0..spec.links.len() {
            if spec.parts.iter().all(|part| part.link != spec.links[j].name) {
                spec.parts.push(self.bar(j, stock, ends(j)));
                LinkNumber::ALL.iter().for_each(|number| spec.links[j].type_number(*number, None));
            }
        }
        Self::new(spec)
    }

    /// Returns the shortest interval that the bar of a link covers, m from its root: root, tip, pins and fixed
    /// counterweights.
    pub fn least_extent(&self, j: usize) -> [f64; 2] {
        self.extent_with(j, |weight| weight.fixed)
    }

    /// Returns the places of the pins of a link, m from its root, in ascending order; pins that differ by rounding are one.
    pub fn pin_places(&self, j: usize) -> Vec<f64> {
        let mut pins = self.resolved_links()[j].pins.clone();
        pins.dedup_by(|b, a| *b - *a <= SAME_PLACE);
        pins
    }

    /// Returns the interval that covers root, tip, pins and some counterweights of a link, m from its root.
    pub fn extent_with(&self, j: usize, is_carried: impl Fn(&Counterweight) -> bool) -> [f64; 2] {
        let (link, resolved) = (&self.links()[j], &self.resolved_links()[j]);
        let carried = self.spec().counterweights.iter().filter(|weight| weight.link == link.name && is_carried(weight));
        let all = resolved.pins.iter().copied().chain(carried.map(Counterweight::carried_at));
        all.fold([0.0, resolved.length], |[from, to], at| [from.min(at), to.max(at)])
    }

    /// Returns the bar of a link, with a hole for each pin.
    fn bar(&self, j: usize, stock: &BarStock, ends: [PlaceOnLink; 2]) -> Part {
        let (link, length) = (&self.links()[j], self.resolved_links()[j].length);
        let pins = self.pin_places(j).into_iter().map(|at| place(at, length));
        Part { name: CUT_BAR.into(), ..stock.bar(&link.name, ends, pins) }
    }

    /// Returns the bar along the axis of a link that reaches from its root to its tip, as index of the part; it is cut
    /// to length.
    pub fn spine(&self, j: usize) -> Option<usize> {
        let length = self.resolved_links()[j].length;
        self.part_bodies().iter().find_map(|PartBody { link, source, ends, .. }| match source {
            PartSource::Part(i) if *link == j => {
                let part = &self.spec().parts[*i];
                let spans = ends[0].min(ends[1]) <= SAME_PLACE && ends[0].max(ends[1]) >= length - SAME_PLACE;
                (part.shape != Shape::Plate && part.across == 0.0 && spans).then_some(*i)
            }
            _ => None,
        })
    }

    /// Returns the machine with an arm of its bar's plate for every counterweight beside a bar.
    ///
    /// # Errors
    /// If a counterweight lies beyond all parts of its link, or the machine is not valid.
    pub fn with_arms(&self, stock: &BarStock) -> Result<Self, MachineError> {
        let mut spec = self.spec().clone();
        spec.parts.retain(|part| !part.is_arm());
        let mut arms = Vec::new();
        for (k, weight) in spec.counterweights.iter().enumerate() {
            let Some(j) = self.spec().link_index(&weight.link) else { continue };
            let not_carried = || MachineError::NotCarried {
                weight: k + 1,
                link: weight.link.clone(),
                at: [weight.at, weight.across],
            };
            let Some(spine) = self.spine(j).map(|i| (&self.spec().parts[i], self.part_ends(i).unwrap_or_default()))
            else {
                if self.is_carried(j, weight) {
                    continue;
                }
                return Err(not_carried());
            };
            let (bar, [from, to]) = spine;
            if weight.at < from - CARRIED || weight.at > to + CARRIED {
                return Err(not_carried());
            }
            let half = 0.5 * bar.breadth().unwrap_or(stock.width);
            if weight.across.abs() > half {
                let [left, right] = [weight.at - 0.5 * stock.width, weight.at + 0.5 * stock.width];
                let foot = half.copysign(weight.across);
                arms.push(Part {
                    name: format!("{ARM} {}", k + 1),
                    shape: Shape::Plate,
                    material: bar.material.clone(),
                    polygon: vec![[left, foot], [right, foot], [right, weight.across], [left, weight.across]],
                    ..Part::flat(&weight.link, bar.thickness.unwrap_or(stock.thickness))
                });
            }
        }
        spec.parts.extend(arms);
        Self::new(spec)
    }

    /// Returns whether a part of a link lies under the centre of a counterweight.
    pub fn is_carried(&self, j: usize, weight: &Counterweight) -> bool {
        self.part_bodies().iter().any(|body| match body.source {
            PartSource::Part(i) if body.link == j => {
                let part = &self.spec().parts[i];
                part.depth([weight.at, weight.across - part.across], body.ends) >= -CARRIED
            }
            _ => false,
        })
    }
}

/// Returns a place on a link of a length, m, by the word that a person would write.
fn place(at: f64, length: f64) -> PlaceOnLink {
    match at {
        _ if at.abs() <= SAME_PLACE => PlaceOnLink::Named("root".into()),
        _ if (at - length).abs() <= SAME_PLACE => PlaceOnLink::Named("tip".into()),
        at => PlaceOnLink::Metres(at),
    }
}
