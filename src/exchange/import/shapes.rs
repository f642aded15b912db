//! Masses and inertias of shapes of MJCF from their density.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | r, h | radius and half of the length along z (of a capsule: without its caps) | m |
//! | a, b, c | halves of the lengths along x, y and z | m |
//! | V | volume | m³ |
//! | i | principal inertias about the centre, divided by the mass | m² |

use std::f64::consts::PI;

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, Unit, Vector3};

use super::compiler::{Compiler, to_axis};
use super::defaults::Element;
use super::read::{AttributeSource, number, numbers, several};
use super::refusal::{ImportError, element_error};
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::quote_clipped;

/// Density of shapes that give none, kg/m³: that of water.
const DEFAULT_DENSITY: f64 = 1000.0;

/// A rigid body: mass, kg, centre of mass, m, and inertia about it, kg m², in the same axes.
#[derive(Clone, Copy, Debug)]
pub struct MassProperties {
    pub mass: f64,
    pub com: Vector3<f64>,
    pub inertia: Matrix3<f64>,
}

impl MassProperties {
    /// Returns a body without mass at a position.
    pub fn none(com: Vector3<f64>) -> Self {
        Self { mass: 0.0, com, inertia: Matrix3::zeros() }
    }

    /// Returns both bodies combined to one.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return Self { inertia: self.inertia + other.inertia, ..self };
        }
        let com = self.com + (other.mass / mass) * (other.com - self.com);
        let about = |one: &Self| one.inertia + one.mass * of_point(one.com - com);
        Self { mass, com, inertia: about(&self) + about(&other) }
    }
}

/// Returns the inertia of a point mass of 1 kg about the origin.
fn of_point(at: Vector3<f64>) -> Matrix3<f64> {
    Matrix3::identity() * at.norm_squared() - at * at.transpose()
}

/// Returns the mass properties of a shape; `frame` maps coordinates of its body to those of the result. `None` is for
/// a shape without mass, or outside the groups whose shapes have mass.
///
/// # Errors
/// If its mass or inertia cannot be computed.
pub fn solid(
    shape: &Element<'_>,
    compiler: &Compiler,
    frame: &Isometry3<f64>,
) -> Result<Option<MassProperties>, ImportError> {
    let group = number(shape, "group")?.unwrap_or(0.0);
    let [first, last] = compiler.groups;
    let mass = number(shape, "mass")?;
    if mass == Some(0.0) || group < first || group > last {
        return Ok(None);
    }
    let kind = shape.get("type").unwrap_or(if shape.get("mesh").is_some() { "mesh" } else { "sphere" });
    if shape.get("shellinertia") == Some("true") {
        return Err(element_error(shape.node(), "a hollow shape", "<inertial>, or a shape that is solid"));
    }
    let (place, size) = placed(shape, kind, compiler)?;
    let Some((volume, i)) = measured(kind, &size) else {
        let what = format!("a shape of type \"{}\", which is not weighed", quote_clipped(kind));
        return Err(element_error(shape.node(), what, "<inertial> in its body, or mass=\"0\" here"));
    };
    if let Some(bad) = size.iter().find(|x| **x <= 0.0) {
        return Err(element_error(shape.node(), format!("a size of {} m", ShortNumber(*bad)), "sizes above 0"));
    }
    let density = number(shape, "density")?.unwrap_or(DEFAULT_DENSITY);
    let mass = mass.unwrap_or(density * volume);
    if mass < 0.0 {
        return Err(element_error(
            shape.node(),
            format!("a mass of {} kg", ShortNumber(mass)),
            "one that is not below 0",
        ));
    }
    let place = frame * place;
    let axes = Rotation3::from(place.rotation);
    let inertia = axes * Matrix3::from_diagonal(&(mass * i)) * axes.transpose();
    Ok(Some(MassProperties { mass, com: place.translation.vector, inertia }))
}

/// Returns position and orientation of a shape on its body, and the sizes of its kind, m.
fn placed(shape: &Element<'_>, kind: &str, compiler: &Compiler) -> Result<(Isometry3<f64>, Vec<f64>), ImportError> {
    // This call reports words that are not numbers.
    numbers(shape, "size")?;
    let mut size: Vec<f64> = shape.sizes().into_iter().map_while(|word| word.parse().ok()).collect();
    let count = match kind {
        "sphere" => 1,
        "capsule" | "cylinder" => 2,
        "box" | "ellipsoid" => 3,
        _ => return Ok((Isometry3::identity(), Vec::new())),
    };
    let ends = several::<6>(shape, "fromto")?.filter(|_| count > 1);
    let given = if ends.is_some() { 1 } else { count };
    if size.len() < given {
        let what = format!("{kind} with {} sizes", size.len());
        return Err(element_error(shape.node(), what, format!("{given}")));
    }
    let Some(ends) = ends else {
        size.truncate(count);
        return Ok((compiler.place(shape)?, size));
    };
    // The z axis of the shape points from the first point to the second; its widths along x and y are equal.
    let [from, to] = [0, 3].map(|i| Vector3::new(ends[i], ends[i + 1], ends[i + 2]));
    let axis = Unit::try_new(to - from, 1e-12)
        .ok_or_else(|| element_error(shape.node(), "its ends are one point", "fromto with two points"))?;
    let (across, half) = (size[0], 0.5 * (to - from).norm());
    let size = if count == 2 { vec![across, half] } else { vec![across, across, half] };
    Ok((Isometry3::from_parts(Translation3::from(0.5 * (from + to)), to_axis(&axis)), size))
}

/// Returns V and i of a kind of shape; `None` for kinds that are not supported.
fn measured(kind: &str, size: &[f64]) -> Option<(f64, Vector3<f64>)> {
    Some(match (kind, size) {
        ("sphere", [r]) => (4.0 / 3.0 * PI * r.powi(3), Vector3::repeat(0.4 * r * r)),
        ("cylinder", [r, h]) => {
            let across = (3.0 * r * r + 4.0 * h * h) / 12.0;
            (2.0 * PI * r * r * h, Vector3::new(across, across, 0.5 * r * r))
        }
        ("capsule", [r, h]) => {
            let [cylinder, ball] = [2.0 * PI * r * r * h, 4.0 / 3.0 * PI * r.powi(3)];
            let volume = cylinder + ball;
            // The centre of mass of a half ball is 3/8 r from its flat face.
            let across = cylinder * (3.0 * r * r + 4.0 * h * h) / 12.0 + ball * (0.4 * r * r + h * h + 0.75 * h * r);
            let along = cylinder * 0.5 * r * r + ball * 0.4 * r * r;
            (volume, Vector3::new(across, across, along) / volume)
        }
        ("box", [a, b, c]) => (8.0 * a * b * c, squares(*a, *b, *c) / 3.0),
        ("ellipsoid", [a, b, c]) => (4.0 / 3.0 * PI * a * b * c, squares(*a, *b, *c) / 5.0),
        _ => return None,
    })
}

/// Returns b² + c², a² + c², a² + b².
fn squares(a: f64, b: f64, c: f64) -> Vector3<f64> {
    let [a, b, c] = [a, b, c].map(|x| x * x);
    Vector3::new(b + c, a + c, a + b)
}
