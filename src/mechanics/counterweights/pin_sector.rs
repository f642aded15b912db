//! [`PinSector`]: the directions from a pin of a link in which a disc lies clear of it.
//!
//! A disc of mass w at (x, y) on its link has the radius κ √w. Clear by c of a pin at p, its centre keeps the distance
//! R = c + κ √w from the pin. Within an angle h to either side of a unit vector n, such centres satisfy
//! n · (x − p, y) ≥ R cos h, which is exact for h = 0. With s = w x and t = w y this reads
//! n · (s − p w, t) ≥ (c w + κ w^1.5) cos h, which is convex.

use std::f64::consts::FRAC_PI_4;

use super::cell::DiscPlace;
use super::spec::CounterweightSpec;
use stillbase_convex::{LinearRow, Program};

/// Directions from a pin to the centre of a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PinSector {
    /// Position of the pin along the link, m from the root.
    pin: f64,
    /// Unit vector in the middle: along the link, and to its left.
    middle: [f64; 2],
    /// Angle from the middle to either edge, rad, below π/2; 0 for the middle direction alone.
    half: f64,
}

impl PinSector {
    /// Returns, for each interval between neighbouring pins and beyond the outermost, the directions that keep a disc
    /// on the axis inside it. The pins are in ascending order, m from the root.
    pub fn intervals(pins: &[f64]) -> Vec<Vec<Self>> {
        let beside = |pin: f64, along: f64| Self { pin, middle: [along, 0.0], half: 0.0 };
        let ahead = |i: usize| pins.get(i).map(|pin| beside(*pin, -1.0));
        let behind = |i: usize| i.checked_sub(1).map(|i| beside(pins[i], 1.0));
        (0..=pins.len()).map(|i| behind(i).into_iter().chain(ahead(i)).collect()).collect()
    }

    /// Returns the four quarters of all directions from a pin.
    fn quarters(pin: f64) -> [Self; 4] {
        [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].map(|middle| Self { pin, middle, half: FRAC_PI_4 })
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

    /// Returns a finer choice of directions from `pin`: its quarters, or both halves of the sector already chosen.
    pub fn refined(chosen: &[Self], pin: f64) -> Vec<Vec<Self>> {
        let with = |new: &Self| {
            let others = chosen.iter().copied().filter(|sector| sector.pin != pin);
            others.chain([*new]).collect::<Vec<_>>()
        };
        match chosen.iter().find(|sector| sector.pin == pin) {
            Some(sector) => sector.halves().iter().map(with).collect(),
            None => Self::quarters(pin).iter().map(with).collect(),
        }
    }

    /// Adds constraints that keep the disc with unknowns w, s and t within all sectors chosen, and clear of their pins.
    pub fn enter(
        chosen: &[Self],
        request: &CounterweightSpec,
        [w, s]: [usize; 2],
        t: Option<usize>,
        into: &mut Program,
    ) {
        if chosen.is_empty() {
            return;
        }
        let (clearance, spread) = (request.clearance.unwrap_or_default(), request.disc.spread());
        // y ≤ √w and z ≥ w²/y, so z ≥ w^1.5.
        let (y, z) = (into.linear.len(), into.linear.len() + 1);
        into.linear.extend([0.0, 0.0]);
        into.above_square(w, 1.0, y);
        into.add_rotated_cone(z, y, [w]);
        for sector in chosen {
            // Terms of −n · (s − p w, t).
            let against = |[along, left]: [f64; 2]| {
                let terms = [(w, along * sector.pin), (s, -along)].into_iter();
                terms.chain(t.map(|t| (t, -left))).collect::<Vec<_>>()
            };
            let mut beyond = against(sector.middle);
            let cos = sector.half.cos();
            beyond.extend([(w, cos * clearance), (z, cos * spread)]);
            into.at_most.push(LinearRow::new(beyond, 0.0));
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

/// Returns the pin of a link whose clearance a disc of this radius, m, violates most, and by how much, m: zero or
/// negative if it is clear of all.
pub(super) fn worst_pin(pins: &[f64], clearance: f64, radius: f64, disc: DiscPlace) -> Option<(f64, f64)> {
    let violation = |pin: f64| clearance + radius - (disc.at - pin).hypot(disc.across);
    pins.iter().map(|pin| (*pin, violation(*pin))).max_by(|a, b| a.1.total_cmp(&b.1))
}
