//! [`Counterweight`]: a body on a link that balances it, and its shape.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parts::PlaneBody;
use super::spec::{Link, is_nought};
use crate::planar::{Vector, circle, equal_area, unit};

/// A body on a link, in the plane of the link's own centre of mass. It moves with the link; the mass of the link
/// excludes it.
///
/// Its sizes give its shape: a disc has a radius, a ring an inner radius too, half a ring `half = true`, a box a length
/// and a width. Without sizes it is a point.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counterweight {
    /// The link that carries it.
    pub link: String,
    /// Mass, kg.
    pub mass: f64,
    /// Position of its centre of mass along the link, from the root towards the tip, m.
    pub at: f64,
    /// Distance of its centre of mass from the link's axis, to the left of the direction root to tip, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub across: f64,
    /// Radius of a disc, or outer radius of a ring, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub radius: f64,
    /// Inner radius of a ring, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub inner_radius: f64,
    /// Whether it is half a ring, or half a disc. Its flat side faces the link's root, and its round side away from it.
    #[serde(default, skip_serializing_if = "is_false")]
    pub half: bool,
    /// Whether half a ring is turned round: its round side faces the link's root, and its flat side away from it.
    #[serde(default, skip_serializing_if = "is_false")]
    pub turned: bool,
    /// Length of a box along the link, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub length: f64,
    /// Width of a box across the link, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub width: f64,
    /// Whether it serves another purpose than balance, as a motor does. A fixed counterweight is neither removed nor
    /// changed to balance the machine.
    #[serde(default, skip_serializing_if = "is_false")]
    pub fixed: bool,
}

/// Distance from the root within which a counterweight is at the root, m.
const AT_ROOT: f64 = 1e-9;

/// Shape of a counterweight in the plane of its link. All lengths in m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum CounterweightShape {
    /// A point.
    #[default]
    Point,
    /// A disc.
    Disc {
        /// Radius.
        radius: f64,
    },
    /// A ring.
    Ring {
        /// Outer radius.
        radius: f64,
        /// Inner radius.
        inner_radius: f64,
    },
    /// Half of a ring; of a disc, if the inner radius is 0.
    HalfRing {
        /// Outer radius.
        radius: f64,
        /// Inner radius.
        inner_radius: f64,
    },
    /// A box.
    Box {
        /// Length along the link.
        length: f64,
        /// Width across the link.
        width: f64,
    },
}

fn is_false(yes: &bool) -> bool {
    !yes
}

impl CounterweightShape {
    /// Returns the body of this shape with density and thickness 1, about its centre of mass: its mass is its area, m².
    pub fn body(self) -> PlaneBody {
        match self {
            Self::Point => PlaneBody::default(),
            Self::Disc { radius } => PlaneBody::disc(radius),
            Self::Ring { radius, inner_radius } => PlaneBody::ring(radius, inner_radius),
            Self::HalfRing { radius, inner_radius } => PlaneBody::half_ring(radius, inner_radius),
            Self::Box { length, width } => PlaneBody::rectangle(length, width),
        }
    }

    /// Returns the inertia about its centre of mass per mass, m².
    pub fn gyration_squared(self) -> f64 {
        match self {
            Self::Disc { radius } => 0.5 * radius * radius,
            shape => {
                let body = shape.body();
                if body.mass > 0.0 { body.inertia / body.mass } else { 0.0 }
            }
        }
    }

    /// Returns the shape with another area, m², and the same inner radius or width.
    #[must_use]
    pub fn with_area(self, area: f64) -> Self {
        let outer = |inner: f64, turn: f64| (inner * inner + 2.0 * area / turn).sqrt();
        let (half, whole) = (std::f64::consts::PI, 2.0 * std::f64::consts::PI);
        match self {
            Self::Point => Self::Point,
            Self::Disc { .. } => Self::Disc { radius: outer(0.0, whole) },
            Self::Ring { inner_radius, .. } => Self::Ring { radius: outer(inner_radius, whole), inner_radius },
            Self::HalfRing { inner_radius, .. } => Self::HalfRing { radius: outer(inner_radius, half), inner_radius },
            Self::Box { width, .. } => Self::Box { length: area / width, width },
        }
    }

    /// Returns the distance of the centre of mass from the centre of the circles, m: 0 but for half a ring.
    pub fn from_circle(self) -> f64 {
        match self {
            Self::HalfRing { radius, inner_radius } => PlaneBody::from_half_ring(radius, inner_radius),
            _ => 0.0,
        }
    }

    /// Returns how far it reaches from its centre of mass, m: towards its flat side, towards its round side, and to
    /// either side across the link. Only of half a ring the first two differ.
    pub fn reach(self) -> [f64; 3] {
        match self {
            Self::Point => [0.0; 3],
            Self::Disc { radius } | Self::Ring { radius, .. } => [radius; 3],
            Self::HalfRing { radius, .. } => {
                let from_circle = self.from_circle();
                [from_circle, radius - from_circle, radius]
            }
            Self::Box { length, width } => [0.5 * length, 0.5 * length, 0.5 * width],
        }
    }

    /// Returns the shape with its outer radius, or its length, rounded to a multiple of a step, m, of at least one step
    /// of material.
    #[must_use]
    pub fn rounded(self, step: f64) -> Self {
        let round = |x: f64, least: f64| (x / step).round().max((least / step).floor() + 1.0) * step;
        match self {
            Self::Point => Self::Point,
            Self::Disc { radius } => Self::Disc { radius: round(radius, 0.0) },
            Self::Ring { radius, inner_radius } => Self::Ring { radius: round(radius, inner_radius), inner_radius },
            Self::HalfRing { radius, inner_radius } => {
                Self::HalfRing { radius: round(radius, inner_radius), inner_radius }
            }
            Self::Box { length, width } => Self::Box { length: round(length, 0.0), width },
        }
    }

    /// Returns its name: *disc*, *ring*, *half ring*, *half disc*, *box* or *point*.
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Disc { .. } => "disc",
            Self::Ring { .. } => "ring",
            Self::HalfRing { inner_radius: 0.0, .. } => "half disc",
            Self::HalfRing { .. } => "half ring",
            Self::Box { .. } => "box",
        }
    }
}

impl Counterweight {
    /// Returns a counterweight of a mass, kg, with its centre of mass at a place along and across a link, m.
    pub fn new(link: impl Into<String>, mass: f64, [at, across]: [f64; 2], shape: CounterweightShape) -> Self {
        let mut weight = Self { link: link.into(), mass, at, across, ..Self::default() };
        weight.set_shape(shape);
        weight
    }

    /// Returns its shape.
    pub fn shape(&self) -> CounterweightShape {
        let Self { radius, inner_radius, length, width, .. } = *self;
        match self.half {
            _ if length > 0.0 => CounterweightShape::Box { length, width },
            true => CounterweightShape::HalfRing { radius, inner_radius },
            false if inner_radius > 0.0 => CounterweightShape::Ring { radius, inner_radius },
            false if radius > 0.0 => CounterweightShape::Disc { radius },
            false => CounterweightShape::Point,
        }
    }

    /// Sets its sizes to those of a shape.
    pub fn set_shape(&mut self, shape: CounterweightShape) {
        let [radius, inner_radius, length, width] = match shape {
            CounterweightShape::Point => [0.0; 4],
            CounterweightShape::Disc { radius } => [radius, 0.0, 0.0, 0.0],
            CounterweightShape::Ring { radius, inner_radius }
            | CounterweightShape::HalfRing { radius, inner_radius } => [radius, inner_radius, 0.0, 0.0],
            CounterweightShape::Box { length, width } => [0.0, 0.0, length, width],
        };
        let half = matches!(shape, CounterweightShape::HalfRing { .. });
        (self.radius, self.inner_radius, self.half) = (radius, inner_radius, half);
        self.turned &= half;
        (self.length, self.width) = (length, width);
    }

    /// Returns it with another mass, kg. It keeps its thickness and material, so its radius or length follows.
    #[must_use]
    pub fn with_mass(&self, mass: f64) -> Self {
        let mut resized = Self { mass, ..self.clone() };
        let shape = self.shape();
        resized.set_shape(shape.with_area(shape.body().mass * mass / self.mass));
        resized
    }

    /// Returns its inertia about its own centre of mass, kg m².
    pub fn inertia(&self) -> f64 {
        self.mass * self.shape().gyration_squared()
    }

    /// Returns the key and the value, m, of the size that follows its mass: the length of a box, otherwise the radius.
    pub fn free_size(&self) -> (&'static str, f64) {
        match self.shape() {
            CounterweightShape::Box { length, .. } => ("length", length),
            _ => ("radius", self.radius),
        }
    }

    /// Returns its sizes that are not 0, m, by [names](Self::SIZES).
    pub fn sizes(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let sizes = [self.radius, self.inner_radius, self.length, self.width];
        Self::SIZES.into_iter().zip(sizes).filter(|(_, size)| *size > 0.0)
    }

    /// Names of sizes.
    pub const SIZES: [&'static str; 4] = ["radius", "inner radius", "length", "width"];

    /// Returns the names of the sizes that at least one of some counterweights has.
    pub fn sizes_of(weights: &[Self]) -> Vec<&'static str> {
        let has = |name: &&str| weights.iter().any(|weight| weight.sizes().any(|(own, _)| own == *name));
        Self::SIZES.into_iter().filter(has).collect()
    }

    /// Returns the thickness, m, that gives it its mass in a material of this density, kg/m³; `None` for a point.
    pub fn thickness(&self, density: f64) -> Option<f64> {
        let area = self.shape().body().mass;
        (area > 0.0).then(|| self.mass / (density * area))
    }

    /// Returns the direction along the link in which half a ring has its round side: 1 towards the tip, −1 from it.
    pub fn outward(&self) -> f64 {
        // At the root itself, away from the root is towards the tip.
        let away = if self.at < -AT_ROOT { -1.0 } else { 1.0 };
        if self.turned { -away } else { away }
    }

    /// Returns the place along its link, m, to which a bar must reach to carry it: its centre of mass, or the middle of
    /// the wall of half a ring whose centre of mass lies in the bore.
    pub fn carried_at(&self) -> f64 {
        match self.shape() {
            CounterweightShape::HalfRing { radius, inner_radius } => {
                let wall = 0.5 * (radius + inner_radius);
                self.circle_at() + self.outward() * wall.max(self.shape().from_circle())
            }
            _ => self.at,
        }
    }

    /// Returns how far a pin of its link, m from the root, lies within a clearance, m, from its edge: zero or negative if
    /// the pin is clear of it.
    ///
    /// Half a ring and a box count as the rectangle around them. A ring may have the pin in its bore; half a ring may on
    /// the axis of its link.
    pub fn overlap(&self, pin: f64, clearance: f64) -> f64 {
        let (shape, ahead, across) = (self.shape(), pin - self.at, self.across.abs());
        match shape {
            CounterweightShape::HalfRing { .. } | CounterweightShape::Box { .. } => {
                let [flat, round, wide] = shape.reach();
                let away = if across == 0.0 { behind_half_ring(self.inner_radius, clearance) } else { clearance };
                let outward = self.outward() * ahead;
                let along = (flat + away + outward).min(round + clearance - outward);
                along.min(wide + clearance - across)
            }
            _ => {
                let (away, bore) = (ahead.hypot(across), self.inner_radius);
                let beyond = clearance + self.radius - away;
                if bore > 0.0 { beyond.min(clearance + away - bore) } else { beyond }
            }
        }
    }

    /// Returns the least distances along the link at which it keeps a clearance from pins, all in m. They go from its
    /// centre of mass to a pin nearer to the root, and to one nearer to the tip.
    ///
    /// The rule is that of [`overlap`](Self::overlap), but no pin lies in the bore of a ring.
    pub fn clear_along(&self, clearance: f64) -> [f64; 2] {
        let (shape, across) = (self.shape(), self.across.abs());
        match shape {
            CounterweightShape::HalfRing { inner_radius, .. } if across < self.radius + clearance => {
                let [flat, round, _] = shape.reach();
                let behind = if across == 0.0 { behind_half_ring(inner_radius, clearance) } else { clearance };
                let away = [flat + behind, round + clearance];
                if self.outward() < 0.0 { [away[1], away[0]] } else { away }
            }
            CounterweightShape::Box { length, width } if across < 0.5 * width + clearance => {
                [0.5 * length + clearance; 2]
            }
            CounterweightShape::HalfRing { .. } | CounterweightShape::Box { .. } => [0.0; 2],
            _ => {
                let away = self.radius + clearance;
                [(away * away - across * across).max(0.0).sqrt(); 2]
            }
        }
    }

    /// Returns the place of the centre of its circles along the link, m from the root.
    pub fn circle_at(&self) -> f64 {
        self.at - self.outward() * self.shape().from_circle()
    }
}

/// Returns the least distance, m, of a pin on the axis behind the flat side of half a ring, at which its edge keeps a
/// clearance, m. It is negative where the pin may lie in the bore. Behind the flat side, the inner corners are nearest.
pub(crate) fn behind_half_ring(inner_radius: f64, clearance: f64) -> f64 {
    match clearance <= inner_radius {
        true => clearance - inner_radius,
        false => ((clearance - inner_radius) * (clearance + inner_radius)).sqrt(),
    }
}

impl Counterweight {
    /// Returns pairs of opposite points of the long sides of half a ring or a box, in the axes of its link, m; the first
    /// side runs counter-clockwise. Empty for other shapes. A whole circle would have `sides` chords, and its area.
    pub fn rails(&self, sides: usize) -> Vec<[Vector; 2]> {
        match self.shape() {
            CounterweightShape::HalfRing { radius, inner_radius } => {
                let (centre, chords) = (Vector::new(self.circle_at(), self.across), (sides / 2).max(1));
                let [radius, inner_radius] = [radius, inner_radius].map(|r| r * equal_area(sides));
                let way = |k: usize| unit(std::f64::consts::PI * (k as f64 / chords as f64 - 0.5)) * self.outward();
                (0..=chords).map(|k| [radius, inner_radius].map(|r| centre + way(k) * r)).collect()
            }
            CounterweightShape::Box { length, width } => {
                let (at, [x, y]) = (Vector::new(self.at, self.across), [0.5 * length, 0.5 * width]);
                [-x, x].map(|x| [-y, y].map(|y| at + Vector::new(x, y))).into()
            }
            _ => Vec::new(),
        }
    }

    /// Returns its outer outline, counter-clockwise in the axes of its link, m; empty for a point. A whole circle has
    /// `sides` chords, and its area.
    pub fn polygon(&self, sides: usize) -> Vec<Vector> {
        match self.shape() {
            CounterweightShape::Point => Vec::new(),
            CounterweightShape::Disc { .. } | CounterweightShape::Ring { .. } => {
                circle(Vector::new(self.at, self.across), self.radius, sides)
            }
            CounterweightShape::HalfRing { .. } | CounterweightShape::Box { .. } => {
                let rails = self.rails(sides);
                let back = rails.iter().rev().map(|[_, inner]| *inner);
                let mut all: Vec<Vector> = rails.iter().map(|[outer, _]| *outer).chain(back).collect();
                all.dedup();
                all
            }
        }
    }

    /// Returns its outer outline and, of a ring, that of its bore, as [`polygon`](Self::polygon) does; none for a point.
    pub fn outlines(&self, sides: usize) -> Vec<Vec<Vector>> {
        let inner = CounterweightShape::Disc { radius: self.inner_radius };
        let bore = Self::new("", 1.0, [self.at, self.across], inner);
        let is_ring = !self.half && self.inner_radius > 0.0;
        let all = std::iter::once(self.polygon(sides)).chain(is_ring.then(|| bore.polygon(sides)));
        all.filter(|outline| !outline.is_empty()).collect()
    }

    /// Returns whether a point in the axes of its link, m, lies in its material.
    pub fn covers(&self, p: Vector) -> bool {
        let from = p - Vector::new(self.at, self.across);
        let is_between = |away: f64, inner: f64, outer: f64| inner < away && away < outer;
        match self.shape() {
            CounterweightShape::Point => false,
            CounterweightShape::Disc { radius } => from.norm() < radius,
            CounterweightShape::Ring { radius, inner_radius } => is_between(from.norm(), inner_radius, radius),
            CounterweightShape::HalfRing { radius, inner_radius } => {
                let from = p - Vector::new(self.circle_at(), self.across);
                self.outward() * from.re > 0.0 && is_between(from.norm(), inner_radius, radius)
            }
            CounterweightShape::Box { length, width } => from.re.abs() < 0.5 * length && from.im.abs() < 0.5 * width,
        }
    }

    /// Returns the ends of a segment in the axes of its link, and a distance from it, m, within which it lies.
    pub fn around(&self) -> ([Vector; 2], f64) {
        let at = Vector::new(self.at, self.across);
        match self.shape() {
            CounterweightShape::HalfRing { radius, .. } => ([Vector::new(self.circle_at(), self.across); 2], radius),
            CounterweightShape::Box { length, width } => {
                let [x, y] = [length - width, width - length].map(|d| 0.5 * d.max(0.0));
                let end = Vector::new(x, y);
                ([at - end, at + end], std::f64::consts::FRAC_1_SQRT_2 * length.min(width))
            }
            _ => ([at; 2], self.radius),
        }
    }
}

impl Link {
    /// Returns the link and a counterweight combined to one body, with its inertia about the common centre of mass.
    #[must_use]
    pub(super) fn with(&self, weight: &Counterweight) -> Self {
        let mass = self.mass + weight.mass;
        let com = (self.mass * self.com + weight.mass * weight.at) / mass;
        let com_normal = (self.mass * self.com_normal + weight.mass * weight.across) / mass;
        let away = |x: f64, y: f64| (x - com).powi(2) + (y - com_normal).powi(2);
        let inertia = self.inertia
            + weight.inertia()
            + self.mass * away(self.com, self.com_normal)
            + weight.mass * away(weight.at, weight.across);
        Self { mass, com, com_normal, inertia, ..self.clone() }
    }
}
