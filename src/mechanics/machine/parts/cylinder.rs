//! [`Cylinder`]: the shape of a body of which a machine states mass and inertia alone.

use std::f64::consts::PI;

/// A cylinder of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Its radius, m.
    pub radius: f64,
    /// Its height, m.
    pub height: f64,
}

impl Cylinder {
    /// Returns the cylinder of a density, kg/m³, that has a mass, kg, and an inertia about its axis, kg m². With no
    /// inertia it is as high as it is wide. `None` without a mass.
    pub fn of(mass: f64, inertia: f64, density: f64) -> Option<Self> {
        if mass <= 0.0 {
            return None;
        }
        // J = m r² / 2 and m = ρ π r² h; with h = 2 r, r³ = m / (2 π ρ).
        let radius = if inertia > 0.0 { (2.0 * inertia / mass).sqrt() } else { (mass / (2.0 * PI * density)).cbrt() };
        Some(Self { radius, height: mass / (density * PI * radius * radius) })
    }
}
