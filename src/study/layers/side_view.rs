//! [`SideView`]: links in their layers as seen along the plane of motion, across x.

use stillbase_exchange::cut::Cut;
use stillbase_exchange::solids::SolidKind;
use stillbase_mechanics::machine::{Machine, place_of};
use stillbase_mechanics::planar::UnitVectors;

use super::contact::Solids;

/// A link seen from the side.
#[derive(Clone, Debug, PartialEq)]
pub struct SideRow {
    /// The link, counted from 0.
    pub link: usize,
    /// The drive that it follows, counted from 0.
    pub drive: usize,
    /// Its layer, counted from 0.
    pub layer: usize,
    /// Interval along x that its bars and plates cover, m.
    pub bar: [f64; 2],
    /// Intervals along x that its counterweights, its lumps and the payload cover, m.
    pub discs: Vec<[f64; 2]>,
}

/// A pin seen from the side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SidePin {
    /// Its place along x, m.
    pub x: f64,
    /// The rows of the uppermost and of the lowest link that it joins; `None` for the base plate.
    pub rows: [Option<usize>; 2],
}

/// A machine seen from the side.
#[derive(Clone, Debug, PartialEq)]
pub struct SideView {
    /// Its links, the uppermost first.
    pub rows: Vec<SideRow>,
    /// Its pins.
    pub pins: Vec<SidePin>,
    /// Interval along x that all links cover, m.
    pub extent: [f64; 2],
}

impl SideView {
    /// Returns the view of a machine in a pose on a fixed base, with its links in layers.
    pub fn of(machine: &Machine, cut: &Cut, layers: &[usize], e: &UnitVectors) -> Self {
        let solids = Solids::of(machine, cut);
        let mut rows: Vec<SideRow> = Vec::with_capacity(layers.len());
        for (solid, plan) in solids.links.iter().zip(&solids.plans) {
            let covered = plan.plan.extent(plan.placed(e));
            let (link, drive) = (solid.link, plan.drive);
            let layer = layers.get(link).copied().unwrap_or_default();
            let is_disc = matches!(solid.kind, SolidKind::Disc(_) | SolidKind::Lump(_) | SolidKind::Payload);
            match rows.last_mut().filter(|row| row.link == link) {
                Some(row) if is_disc => row.discs.push(covered),
                Some(row) => row.bar = [row.bar[0].min(covered[0]), row.bar[1].max(covered[1])],
                None => rows.push(SideRow { link, drive, layer, bar: covered, discs: Vec::new() }),
            }
        }
        let all = rows.iter().flat_map(|row| row.discs.iter().chain([&row.bar]));
        let extent = all.fold([0.0_f64, 0.0_f64], |[from, to], [a, b]| [from.min(*a), to.max(*b)]);
        rows.sort_by_key(|row| (std::cmp::Reverse(row.layer), row.link));
        let row_of = |link: usize| rows.iter().position(|row| row.link == link);
        let pin = |axle: &stillbase_exchange::solids::Axle| {
            let own = axle.links.iter().filter_map(|(link, _)| row_of(*link));
            let (top, bottom) = (own.clone().min(), own.max());
            let rows = [top, if axle.is_on_base() { None } else { bottom }];
            axle.is_pin().then(|| SidePin { x: place_of(&axle.at, e).re, rows })
        };
        let pins = solids.axles.iter().filter_map(pin).collect();
        Self { rows, pins, extent }
    }
}
