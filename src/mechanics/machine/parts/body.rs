//! [`PlaneBody`]: mass, centre of mass and inertia of a body, and the closed forms of plain shapes.

use std::f64::consts::PI;

/// A body in the axes of a link. A body of density 1 has its area or volume as its mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneBody {
    /// Mass, kg.
    pub mass: f64,
    /// Position of its centre of mass along the link, from the root towards the tip, m.
    pub at: f64,
    /// Distance of its centre of mass from the link's axis, to the left of the direction root to tip, m.
    pub across: f64,
    /// Inertia about its own centre of mass, kg m².
    pub inertia: f64,
}

impl PlaneBody {
    /// Returns both bodies combined to one, with its inertia about the common centre of mass.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        let share = other.mass / mass;
        let (dx, dy) = (other.at - self.at, other.across - self.across);
        Self {
            mass,
            at: self.at + share * dx,
            across: self.across + share * dy,
            inertia: self.inertia + other.inertia + self.mass * share * (dx * dx + dy * dy),
        }
    }

    /// Returns the body without a part of it.
    #[must_use]
    pub fn without(self, part: Self) -> Self {
        self.and(Self { mass: -part.mass, inertia: -part.inertia, ..part })
    }

    /// Returns the body with its mass and inertia multiplied by a factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { mass: factor * self.mass, inertia: factor * self.inertia, ..self }
    }

    /// Returns the body moved, m.
    #[must_use]
    pub fn moved(self, at: f64, across: f64) -> Self {
        Self { at: self.at + at, across: self.across + across, ..self }
    }

    fn centred(mass: f64, inertia: f64) -> Self {
        Self { mass, inertia, ..Self::default() }
    }

    /// Returns a disc of a radius, m.
    pub fn disc(radius: f64) -> Self {
        let area = PI * radius * radius;
        Self::centred(area, 0.5 * area * radius * radius)
    }

    /// Returns a ring between two radii, m.
    pub fn ring(radius: f64, inner: f64) -> Self {
        let area = PI * (radius - inner) * (radius + inner);
        Self::centred(area, 0.5 * area * (radius * radius + inner * inner))
    }

    /// Returns half a ring between two radii, m, about its centre of mass.
    pub fn half_ring(radius: f64, inner: f64) -> Self {
        let area = 0.5 * PI * (radius - inner) * (radius + inner);
        let away = Self::from_half_ring(radius, inner);
        Self::centred(area, area * (0.5 * (radius * radius + inner * inner) - away * away))
    }

    /// Returns the distance of the centre of mass of half a ring from the centre of its circles, m.
    pub fn from_half_ring(radius: f64, inner: f64) -> f64 {
        let sum = radius + inner;
        if sum > 0.0 { 4.0 / (3.0 * PI) * (sum - radius * inner / sum) } else { 0.0 }
    }

    /// Returns a rectangle of a length along the link and a width across it, m.
    pub fn rectangle(length: f64, width: f64) -> Self {
        let area = length * width;
        Self::centred(area, area * (length * length + width * width) / 12.0)
    }

    /// Returns a rectangle with half discs at both ends, of a distance between the centres of these and a width, m.
    pub fn stadium(length: f64, width: f64) -> Self {
        let (disc, r) = (Self::disc(0.5 * width), 0.5 * width);
        // Each half disc has its centre of mass 4 r / (3 π) beyond the end of the rectangle.
        let half = length / 2.0;
        let ends = disc.inertia + disc.mass * half * (half + 8.0 * r / (3.0 * PI));
        let rectangle = Self::rectangle(length, width);
        Self::centred(rectangle.mass + disc.mass, rectangle.inertia + ends)
    }

    /// Returns a tube along the link, of a length, an outer diameter and a wall, m.
    pub fn tube(length: f64, diameter: f64, wall: f64) -> Self {
        let (outer, inner) = (0.5 * diameter, 0.5 * diameter - wall);
        let volume = PI * wall * (outer + inner) * length;
        Self::centred(volume, volume * ((outer * outer + inner * inner) / 4.0 + length * length / 12.0))
    }

    /// Returns a hollow rectangular profile along the link, of a length, a width in the plane of the motion, a height
    /// normal to it, and a wall, m.
    pub fn profile(length: f64, width: f64, height: f64, wall: f64) -> Self {
        let [outer, inner] = [0.0, 2.0 * wall].map(|less| (width - less) * (height - less));
        let second = |less: f64| (width - less).powi(3) * (height - less) / 12.0;
        let volume = length * (outer - inner);
        Self::centred(volume, length * (second(0.0) - second(2.0 * wall)) + volume * length * length / 12.0)
    }
}
