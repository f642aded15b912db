//! [`PinSector`]: the directions from a pin of a link in which a counterweight lies clear of it.
//!
//! A disc of mass w at (x, y) on its link has the radius κ √w. Clear by c of a pin at p, its centre keeps the distance
//! R = c + κ √w from the pin. Within an angle h to either side of a unit vector n, such centres satisfy
//! n · (x − p, y) ≥ R cos h, which is exact for h = 0. With s = w x and t = w y this reads
//! n · (s − p w, t) ≥ (c w + κ w^1.5) cos h, which is convex. Other shapes have another reach than κ √w.
//!
//! A ring may also have the pin in its bore. Half a ring and a box count as the rectangles around them, so their n are
//! along and across the link. Of half a ring, the side of the root on which it lies is chosen too.

use std::f64::consts::FRAC_PI_4;

use super::cell::DiscPlace;
use super::spec::{CounterweightSite, CounterweightSpec};
use super::stock::{CounterweightForm, CounterweightStock};
use super::unknowns::UnknownIndices;
use crate::machine::{Counterweight, behind_half_ring};
use stillbase_convex::{LinearRow, Program};

/// Half a ring keeps this distance from the root, m, so that rounding does not turn it round.
const SIDE_M: f64 = 1e-6;

/// Directions from a pin to the centre of mass of a counterweight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PinSector {
    /// Position of the pin along the link, m from the root.
    pin: f64,
    /// Unit vector in the middle: along the link, and to its left.
    middle: [f64; 2],
    /// Angle from the middle to either edge, rad, below π/2; 0 for the middle direction alone.
    half: f64,
    /// Whether the pin lies in the bore instead.
    in_bore: bool,
    /// Side of the root on which half a ring lies: 1 towards the tip, −1 from it; 0 for other shapes.
    side: f64,
}

impl PinSector {
    /// Returns the choices that keep the counterweight of a site clear of a pin, or of all pins of a link if it lies on
    /// the axis. `chosen` are the choices so far. The pins are in ascending order, m from the root.
    pub fn choices(
        request: &CounterweightSpec,
        site: &CounterweightSite,
        pins: &[f64],
        chosen: &[Self],
        pin: f64,
    ) -> Vec<Vec<Self>> {
        let stock = &request.stock;
        let bore = stock.inner_radius() - request.clearance.unwrap_or_default();
        let has_bore = bore > 0.0 && matches!(stock.form, CounterweightForm::Ring(_));
        let mut choices = match (site.across > 0.0, stock.is_round()) {
            (false, _) => Self::intervals(pins),
            (true, true) => Self::refined(chosen, pin),
            (true, false) => Self::quarters(pin).iter().map(|one| Self { half: 0.0, ..*one }.beside(chosen)).collect(),
        };
        if has_bore && site.across > 0.0 {
            choices.extend((!chosen.iter().any(|one| one.pin == pin)).then(|| Self::bore(pin).beside(chosen)));
        } else if has_bore {
            choices.extend(Self::intervals_around(pins));
        }
        match stock.form {
            CounterweightForm::HalfRing(_) => {
                let sides = match chosen.first() {
                    Some(one) => vec![one.side],
                    None => vec![-1.0, 1.0],
                };
                let with = |side: f64| {
                    let turned = move |all: &Vec<Self>| all.iter().map(|one| Self { side, ..*one }).collect();
                    choices.iter().map(turned).collect::<Vec<_>>()
                };
                sides.into_iter().flat_map(with).collect()
            }
            _ => choices,
        }
    }

    const fn new(pin: f64, middle: [f64; 2], half: f64) -> Self {
        Self { pin, middle, half, in_bore: false, side: 0.0 }
    }

    const fn bore(pin: f64) -> Self {
        Self { in_bore: true, ..Self::new(pin, [1.0, 0.0], 0.0) }
    }

    /// Returns whether it settles a pin: narrower choices do not exist.
    pub fn settles(&self, pin: f64) -> bool {
        self.pin == pin && self.half == 0.0
    }

    /// Returns, for each interval between neighbouring pins and beyond the outermost, the directions that keep a
    /// counterweight on the axis inside it. The pins are in ascending order, m from the root.
    fn intervals(pins: &[f64]) -> Vec<Vec<Self>> {
        (0..=pins.len()).map(|i| Self::between(pins, i, i)).collect()
    }

    /// Returns, for each run of neighbouring pins, the choices that have it in the bore and no other pin.
    fn intervals_around(pins: &[f64]) -> Vec<Vec<Self>> {
        let runs = (0..pins.len()).flat_map(|i| (i + 1..=pins.len()).map(move |end| (i, end)));
        let ends = |(i, end): (usize, usize)| {
            let mut all = Self::between(pins, i, end);
            all.extend([Self::bore(pins[i]), Self::bore(pins[end - 1])]);
            all
        };
        runs.map(ends).collect()
    }

    /// Returns the directions that keep a counterweight on the axis beyond pin i − 1 and before pin `end`.
    fn between(pins: &[f64], i: usize, end: usize) -> Vec<Self> {
        let beside = |pin: f64, along: f64| Self::new(pin, [along, 0.0], 0.0);
        let ahead = pins.get(end).map(|pin| beside(*pin, -1.0));
        let behind = i.checked_sub(1).map(|i| beside(pins[i], 1.0));
        behind.into_iter().chain(ahead).collect()
    }

    /// Returns the four quarters of all directions from a pin.
    fn quarters(pin: f64) -> [Self; 4] {
        [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(|middle| Self::new(pin, middle, FRAC_PI_4))
    }

    /// Returns both halves.
    fn halves(&self) -> [Self; 2] {
        let half = 0.5 * self.half;
        [half, -half].map(|by| Self { middle: self.turned(by), half, ..*self })
    }

    /// Returns the unit vector at an angle, rad, from the middle.
    fn turned(&self, by: f64) -> [f64; 2] {
        let ([x, y], (sin, cos)) = (self.middle, by.sin_cos());
        [x * cos - y * sin, x * sin + y * cos]
    }

    /// Returns it with the choices for other pins.
    fn beside(self, chosen: &[Self]) -> Vec<Self> {
        let others = chosen.iter().copied().filter(|sector| sector.pin != self.pin);
        others.chain([self]).collect()
    }

    /// Returns a finer choice of directions from `pin`: its quarters, or both halves of the sector already chosen.
    fn refined(chosen: &[Self], pin: f64) -> Vec<Vec<Self>> {
        match chosen.iter().find(|sector| sector.pin == pin) {
            Some(sector) => sector.halves().map(|half| half.beside(chosen)).into(),
            None => Self::quarters(pin).map(|quarter| quarter.beside(chosen)).into(),
        }
    }

    /// Adds constraints that keep the counterweight of site j within all sectors chosen, and clear of their pins.
    pub fn enter(
        chosen: &[Self],
        request: &CounterweightSpec,
        j: usize,
        unknowns: &UnknownIndices,
        into: &mut Program,
    ) {
        if chosen.is_empty() {
            return;
        }
        let (w, s, t) = (unknowns.w(j), unknowns.s(j), unknowns.t(j));
        let (clearance, bore) = (request.clearance.unwrap_or_default(), request.stock.inner_radius());
        let reach = request.stock.enter_reach(w, into);
        for sector in chosen {
            // Terms of −n · (s − p w, t).
            let against = |[along, left]: [f64; 2]| {
                let terms = [(w, along * sector.pin), (s, -along)].into_iter();
                terms.chain(t.map(|t| (t, -left))).collect::<Vec<_>>()
            };
            if sector.in_bore {
                let mut cone = vec![LinearRow::new([(w, bore - clearance)], 0.0)];
                cone.extend([[1.0, 0.0], [0.0, 1.0]].map(|n| LinearRow::new(against(n), 0.0)));
                into.cones.push(cone);
                continue;
            }
            let mut away = clearance;
            let of_side = match request.stock.form {
                CounterweightForm::HalfRing(_) => {
                    into.at_most.push(LinearRow::new([(s, -sector.side), (w, SIDE_M)], 0.0));
                    // The centre of mass lies in direction n from the pin, so the pin is on the side −n.
                    match sector.middle[0] * sector.side {
                        1.0 => {
                            if request.sites[j].across == 0.0 {
                                away = behind_half_ring(bore, clearance);
                            }
                            0
                        }
                        -1.0 => 1,
                        _ => 2,
                    }
                }
                _ if sector.middle[0] == 0.0 => 2,
                _ => 0,
            };
            let mut beyond = against(sector.middle);
            let cos = sector.half.cos();
            beyond.push((w, cos * away));
            beyond.extend(reach[of_side].terms.iter().map(|(x, by)| (*x, cos * by)));
            into.at_most.push(LinearRow::new(beyond, -cos * reach[of_side].constant));
            if sector.half > 0.0 {
                // The part across the middle is tan h times an unknown between minus and plus the part along it. So
                // narrow sectors have rows of the same size as wide ones.
                let share = into.linear.len();
                into.linear.push(0.0);
                let [x, y] = sector.middle;
                let mut across = against([-y, x]);
                across.push((share, sector.half.tan()));
                into.equal.push(LinearRow::new(across, 0.0));
                for sign in [1.0, -1.0] {
                    let mut within = against(sector.middle);
                    within.push((share, sign));
                    into.at_most.push(LinearRow::new(within, 0.0));
                }
            }
        }
    }
}

/// Returns the pin whose clearance, m, a counterweight violates most, and by how much, m: zero or negative if it is clear
/// of all. Whether it must lie on its link's axis is `on_axis`.
pub(super) fn worst_pin(
    pins: impl Iterator<Item = f64>,
    clearance: f64,
    stock: &CounterweightStock,
    place: DiscPlace,
    on_axis: bool,
) -> Option<(f64, f64)> {
    let across = if on_axis { 0.0 } else { place.across };
    let weight = Counterweight::new("", place.mass, [place.at, across], stock.shape(place.mass));
    pins.map(|pin| (pin, weight.overlap(pin, clearance))).max_by(|a, b| a.1.total_cmp(&b.1))
}
