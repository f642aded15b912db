//! [`CounterweightStock`]: the plate or bar of which counterweights are made. It gives each mass one shape.
//!
//! Half a ring has an inner radius a and an outer one r. Its mass w gives r² = a² + 2 w/(π ρ d). With β = 16/(9 π²), its
//! inertia about its own centre of mass is
//! (π ρ d/2) ((1/2 − β) r⁴ − β a² r² + 2 β a³ r − (1/2 + β) a⁴ + 2 β a⁵/(r + a)).
//! Its second derivative by w increases with w, so the inertia is a square of w plus a convex remainder.

use std::f64::consts::PI;

use super::refusal::CounterweightError;
use super::unknowns::AffineForm;
use crate::machine::{CounterweightShape, ranges};
use stillbase_convex::{LinearRow, Program};
use stillbase_settings::range::Range;
use stillbase_settings::word::words;

/// Material and section of counterweights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CounterweightStock {
    /// Density ρ, kg/m³.
    pub density: f64,
    /// Thickness d, m.
    pub thickness: f64,
    /// What is cut from it.
    pub form: CounterweightForm,
}

/// What is cut from a plate, and the length that all counterweights have in common, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CounterweightForm {
    /// Discs.
    #[default]
    Disc,
    /// Rings of this inner radius.
    Ring(f64),
    /// Halves of rings of this inner radius; of discs, if it is 0.
    HalfRing(f64),
    /// Boxes of this width across the link.
    Box(f64),
}

words! {
    /// Kinds of counterweights, by the names in files and commands.
    pub enum CounterweightKind {
        Disc = "disc", "discs", "Discs about their centres of mass";
        Ring = "ring", "rings", "Rings with an inner radius";
        HalfRing = "half-ring", "half rings", "Halves of rings, round away from the root of their link";
        Box = "box", "boxes", "Boxes with a width across their link, as long as their mass takes";
    }
}

impl CounterweightForm {
    /// Returns its kind.
    pub const fn kind(self) -> CounterweightKind {
        match self {
            Self::Disc => CounterweightKind::Disc,
            Self::Ring(_) => CounterweightKind::Ring,
            Self::HalfRing(_) => CounterweightKind::HalfRing,
            Self::Box(_) => CounterweightKind::Box,
        }
    }

    /// Returns the form of a kind, with the inner radius of rings and the width of boxes, m.
    pub const fn of(kind: CounterweightKind, inner_radius: f64, width: f64) -> Self {
        match kind {
            CounterweightKind::Disc => Self::Disc,
            CounterweightKind::Ring => Self::Ring(inner_radius),
            CounterweightKind::HalfRing => Self::HalfRing(inner_radius),
            CounterweightKind::Box => Self::Box(width),
        }
    }
}

/// Range of the thickness of a plate.
pub const THICKNESS_RANGE: Range = Range::new(1e-4, 1.0, "m");
/// Range of the inner radius of rings.
pub const INNER_RADIUS_RANGE: Range = Range::new(0.0, 10.0, "m");
/// Range of the width of boxes.
pub const BOX_WIDTH_RANGE: Range = Range::new(1e-4, 10.0, "m");

/// β = (4/(3 π))²: the square of the distance of a half disc's centre of mass from its circle's centre, per r².
const BETA: f64 = 16.0 / (9.0 * PI * PI);

impl CounterweightStock {
    /// Discs of steel, 30 mm thick.
    pub const STEEL: Self = Self::discs(7850.0, 0.03);

    /// Returns a plate of a density, kg/m³, and a thickness, m, of which discs are cut.
    pub const fn discs(density: f64, thickness: f64) -> Self {
        Self { density, thickness, form: CounterweightForm::Disc }
    }

    /// Returns the shape of a counterweight of a mass, kg.
    pub fn shape(&self, mass: f64) -> CounterweightShape {
        self.outline().with_area(mass * self.area_per_mass())
    }

    /// Returns the mass, kg, of a counterweight of a shape.
    pub fn mass(&self, shape: CounterweightShape) -> f64 {
        shape.body().mass / self.area_per_mass()
    }

    /// Returns the mass, kg, of a disc or ring of an outer radius, m; `None` for boxes, which have no radius, and if the
    /// radius does not exceed the inner one.
    pub fn mass_of_radius(&self, radius: f64) -> Option<f64> {
        let shape = match self.form {
            CounterweightForm::Disc => CounterweightShape::Disc { radius },
            CounterweightForm::Ring(inner_radius) => CounterweightShape::Ring { radius, inner_radius },
            CounterweightForm::HalfRing(inner_radius) => CounterweightShape::HalfRing { radius, inner_radius },
            CounterweightForm::Box(_) => return None,
        };
        Some(self.mass(shape)).filter(|mass| *mass > 0.0 && radius > self.inner_radius())
    }

    /// Returns the inner radius, m; 0 for a disc or a box.
    pub fn inner_radius(&self) -> f64 {
        match self.form {
            CounterweightForm::Ring(inner) | CounterweightForm::HalfRing(inner) => inner,
            CounterweightForm::Disc | CounterweightForm::Box(_) => 0.0,
        }
    }

    /// Returns 1/(ρ d), m²/kg.
    pub(super) fn area_per_mass(&self) -> f64 {
        1.0 / (self.density * self.thickness)
    }

    /// Returns the shape without material.
    fn outline(&self) -> CounterweightShape {
        match self.form {
            CounterweightForm::Disc | CounterweightForm::Ring(0.0) => CounterweightShape::Disc { radius: 0.0 },
            CounterweightForm::Ring(inner_radius) => CounterweightShape::Ring { radius: inner_radius, inner_radius },
            CounterweightForm::HalfRing(inner_radius) => {
                CounterweightShape::HalfRing { radius: inner_radius, inner_radius }
            }
            CounterweightForm::Box(width) => CounterweightShape::Box { length: 0.0, width },
        }
    }

    /// Returns the inertia, kg m², of a counterweight of a mass, kg, about its own centre of mass.
    pub(super) fn own(&self, mass: f64) -> f64 {
        let [linear, square, cube] = self.powers();
        match self.form {
            CounterweightForm::HalfRing(inner) if inner > 0.0 => mass * self.shape(mass).gyration_squared(),
            _ => mass * (linear + mass * (square + mass * cube)),
        }
    }

    /// Returns the derivative of [`own`](Self::own) by the mass, m².
    pub(super) fn own_slope(&self, mass: f64) -> f64 {
        let [linear, square, cube] = self.powers();
        match self.form {
            CounterweightForm::HalfRing(a) if a > 0.0 => {
                let r = (a * a + 2.0 * mass * self.area_per_mass() / PI).sqrt();
                r * r * (1.0 - 2.0 * BETA) - BETA * a * a + BETA * a.powi(3) * (r + 2.0 * a) / (r + a).powi(2)
            }
            _ => linear + mass * (2.0 * square + 3.0 * mass * cube),
        }
    }

    /// Returns whether the inertia has a remainder beyond its powers of the mass.
    pub(super) fn has_remainder(&self) -> bool {
        matches!(self.form, CounterweightForm::HalfRing(inner) if inner > 0.0)
    }

    /// Returns factors of the mass, of its square and of its cube in the inertia. Of half a ring, the square is a lower
    /// bound of half the second derivative.
    fn powers(&self) -> [f64; 3] {
        let by = self.area_per_mass();
        match self.form {
            CounterweightForm::Disc => [0.0, by / (2.0 * PI), 0.0],
            CounterweightForm::Ring(inner) => [inner * inner, by / (2.0 * PI), 0.0],
            CounterweightForm::HalfRing(inner) => {
                [0.0, by / PI * (1.0 - BETA * if inner > 0.0 { 2.25 } else { 2.0 }), 0.0]
            }
            CounterweightForm::Box(width) => [width * width / 12.0, 0.0, by * by / (12.0 * width * width)],
        }
    }

    /// Adds rows that keep unknown v at or above the inertia of mass w. A remainder is bounded by its tangents at
    /// `masses`, kg.
    pub(super) fn enter_own(&self, w: usize, v: usize, masses: &[f64], program: &mut Program) {
        let [linear, square, cube] = self.powers();
        if linear == 0.0 && cube == 0.0 && !self.has_remainder() {
            program.above_square(v, square, w);
            return;
        }
        let power = program.linear.len();
        program.linear.push(0.0);
        if cube > 0.0 {
            // y ≥ w² and z w ≥ y², so z ≥ w³.
            let y = program.linear.len();
            program.linear.push(0.0);
            program.above_square(y, 1.0, w);
            program.add_rotated_cone(power, w, [y]);
        } else {
            program.above_square(power, square, w);
        }
        let factor = if cube > 0.0 { cube } else { 1.0 };
        let mut above = |slope: f64, constant: f64| {
            program.at_most.push(LinearRow::new([(power, factor), (w, slope), (v, -1.0)], -constant));
        };
        if !self.has_remainder() {
            above(linear, 0.0);
            return;
        }
        for &mass in masses {
            let slope = self.own_slope(mass) - 2.0 * square * mass;
            above(slope, self.own(mass) - square * mass * mass - slope * mass);
        }
    }

    /// Returns the lower bound of the inertia, kg m², that tangents of its remainder at `masses`, kg, give.
    pub(super) fn own_above_tangents(&self, mass: f64, masses: &[f64]) -> f64 {
        let [_, square, _] = self.powers();
        let tangent = |&at: &f64| {
            let off = mass - at;
            self.own(at) + off * (self.own_slope(at) + square * off)
        };
        masses.iter().map(tangent).fold(0.0, f64::max)
    }

    /// Adds unknowns, and returns how far a counterweight reaches from its centre of mass, times its unknown mass w, kg m.
    /// The three reaches are towards its flat side, towards its round side, and across its link. Each is convex in w.
    pub(super) fn enter_reach(&self, w: usize, into: &mut Program) -> [AffineForm; 3] {
        let n = into.linear.len();
        let mut unknowns = |count: usize| into.linear.resize(n + count, 0.0);
        let (by, a) = (self.area_per_mass(), self.inner_radius());
        let of = |terms: &[(usize, f64)], constant: f64| AffineForm { terms: terms.to_vec(), constant };
        match self.form {
            CounterweightForm::Disc | CounterweightForm::Ring(0.0) => {
                // y ≤ √w and z ≥ w²/y, so z ≥ w^1.5.
                unknowns(2);
                let (y, z) = (n, n + 1);
                into.above_square(w, 1.0, y);
                into.add_rotated_cone(z, y, [w]);
                [(); 3].map(|()| of(&[(z, (by / PI).sqrt())], 0.0))
            }
            CounterweightForm::Ring(_) => {
                // r² = a² + b w. With p ≥ y²/w, q ≥ y² and a² p + b q ≤ w, y ≤ w/r; then z ≥ w²/y ≥ w r. All lengths
                // in units of the radius at 1 kg.
                unknowns(4);
                let (y, z, p, q) = (n, n + 1, n + 2, n + 3);
                let unit = a * a + by / PI;
                into.add_rotated_cone(p, w, [y]);
                into.above_square(q, 1.0, y);
                into.at_most.push(LinearRow::new([(p, a * a / unit), (q, by / PI / unit), (w, -1.0)], 0.0));
                into.add_rotated_cone(z, y, [w]);
                [(); 3].map(|()| of(&[(z, unit.sqrt())], 0.0))
            }
            CounterweightForm::HalfRing(_) => {
                // u = r² = a² + b w, y ≤ √u, z ≥ u²/y, so z ≥ r³. The reach times w is affine in z and −y. All lengths
                // in units of the radius at 1 kg.
                unknowns(3);
                let (u, y, z) = (n, n + 1, n + 2);
                let unit = (a * a + 2.0 * by / PI).sqrt();
                let a = a / unit;
                into.equal.push(LinearRow::new([(u, 1.0), (w, a * a - 1.0)], a * a));
                into.above_square(u, 1.0, y);
                into.add_rotated_cone(z, y, [u]);
                let per = PI / (2.0 * by) * unit.powi(3);
                let centre = 4.0 / (3.0 * PI);
                [
                    of(&[(z, per * centre)], -per * centre * a.powi(3)),
                    of(&[(z, per * (1.0 - centre)), (y, -per * a * a)], per * centre * a.powi(3)),
                    of(&[(z, per), (y, -per * a * a)], 0.0),
                ]
            }
            CounterweightForm::Box(width) => {
                unknowns(1);
                into.above_square(n, 1.0, w);
                let along = [(n, 0.5 * by / width)];
                [of(&along, 0.0), of(&along, 0.0), of(&[(w, 0.5 * width)], 0.0)]
            }
        }
    }

    /// Returns whether the edge has the same distance from the centre of mass in all directions.
    pub(super) fn is_round(&self) -> bool {
        matches!(self.form, CounterweightForm::Disc | CounterweightForm::Ring(_))
    }

    /// Checks the numbers.
    pub(super) fn check(&self) -> Result<(), CounterweightError> {
        let own = match self.form {
            CounterweightForm::Disc => None,
            CounterweightForm::Ring(inner) | CounterweightForm::HalfRing(inner) => {
                Some(("inner radius", inner, INNER_RADIUS_RANGE))
            }
            CounterweightForm::Box(width) => Some(("width of the boxes", width, BOX_WIDTH_RANGE)),
        };
        let all = [("density", self.density, ranges::DENSITY), ("thickness", self.thickness, THICKNESS_RANGE)];
        match all.into_iter().chain(own).find(|(_, value, range)| !range.contains(*value)) {
            Some((what, value, range)) => Err(CounterweightError::out(what, value, range)),
            None => Ok(()),
        }
    }
}
