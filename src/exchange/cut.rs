//! [`Cut`]: dimensions of bars and holes, and the material of discs.

use super::look::DRAWN_BAR_RADIUS;
use stillbase_mechanics::machine::{Counterweight, CounterweightShape, Machine};
use stillbase_settings::number::{ShortNumber, fixed};

/// Dimensions of bars, holes and discs, and the density of discs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Width of a bar, m; its ends are round.
    pub bar_width: f64,
    /// Diameter of a hole for a pin, m.
    pub pin_diameter: f64,
    /// Density of the discs, kg/m³.
    pub density: f64,
    /// Thickness of the discs, m; `None`: the thickness that gives each disc its mass.
    pub thickness: Option<f64>,
    /// Thickness of the bars, m.
    pub plate_thickness: f64,
    /// Gap between the bars of neighbouring layers, m, which spacers on the pins keep.
    pub spacer: f64,
}

/// Error of dimensions with which parts cannot be cut.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CutError {
    /// A dimension or density that is out of range.
    #[error("{what} {}: want a number from {} to {}", stated(*value, unit), ShortNumber(*MEASURES.start()), ShortNumber(*MEASURES.end()))]
    Measure {
        /// Name of the quantity.
        what: &'static str,
        /// Its value.
        value: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Holes are not narrower than bars.
    #[error(
        "holes of {} mm in bars {} mm wide: want bars wider than their holes",
        fixed(1e3 * diameter, 3),
        fixed(1e3 * width, 3)
    )]
    Narrow {
        /// Width of the bar, m.
        width: f64,
        /// Diameter of the hole, m.
        diameter: f64,
    },
    /// Two holes overlap.
    #[error(
        "two holes of link {link:?} are {} mm apart, {} mm across: want pins thinner than that",
        fixed(1e3 * apart, 3),
        fixed(1e3 * diameter, 3)
    )]
    Holes {
        /// The link.
        link: String,
        /// Distance between their centres, m.
        apart: f64,
        /// Diameter of the holes, m.
        diameter: f64,
    },
}

fn stated(value: f64, unit: &str) -> String {
    if value.is_nan() { "is not a number".into() } else { format!("{} {unit}", ShortNumber(value)) }
}

impl Default for Cut {
    /// Bars of 30 mm × 6 mm, pins of 8 mm, spacers of 1 mm, discs of steel.
    fn default() -> Self {
        Self {
            bar_width: 0.030,
            pin_diameter: 0.008,
            density: 7850.0,
            thickness: None,
            plate_thickness: 0.006,
            spacer: 0.001,
        }
    }
}

impl Cut {
    /// Returns the dimensions with those of the parts of a machine: the widest and the thickest bar, and the widest hole.
    #[must_use]
    pub fn fitting(self, machine: &Machine) -> Self {
        let bars: Vec<usize> = (0..machine.links().len()).filter_map(|link| machine.spine(link)).collect();
        let greatest =
            |of: &dyn Fn(usize) -> Option<f64>| bars.iter().filter_map(|bar| of(*bar)).max_by(f64::total_cmp);
        let part = |bar: usize| &machine.spec().parts[bar];
        let width = greatest(&|bar| part(bar).breadth());
        let thickness = greatest(&|bar| part(bar).thickness.or(part(bar).height).or(part(bar).diameter));
        let hole =
            greatest(&|bar| machine.part_holes(bar).into_iter().map(|(_, diameter)| diameter).max_by(f64::total_cmp));
        Self {
            bar_width: width.unwrap_or(self.bar_width),
            plate_thickness: thickness.unwrap_or(self.plate_thickness),
            pin_diameter: hole.unwrap_or(self.pin_diameter),
            ..self
        }
    }

    /// Checks the range of each dimension and of the density.
    ///
    /// # Errors
    /// If one is out of range.
    pub fn check_ranges(&self) -> Result<(), CutError> {
        measure("material", Some(self.density), "kg/m³")?;
        measure("thickness", self.thickness, "m")?;
        measure("bar width", Some(self.bar_width), "m")?;
        measure("pin diameter", Some(self.pin_diameter), "m")?;
        measure("plate thickness", Some(self.plate_thickness), "m")?;
        measure("spacer", Some(self.spacer), "m")
    }

    /// Checks that the links of a machine can be cut.
    ///
    /// # Errors
    /// If a dimension is out of range, or if holes overlap or are too wide.
    pub fn check(&self, machine: &Machine) -> Result<(), CutError> {
        self.check_ranges()?;
        let (width, diameter) = (self.bar_width, self.pin_diameter);
        if diameter >= width {
            return Err(CutError::Narrow { width, diameter });
        }
        for (j, (link, part)) in machine.links().iter().zip(machine.resolved_links()).enumerate() {
            // Parts have holes of their own, which the machine has checked.
            if machine.parts_of_link(j).is_some() {
                continue;
            }
            let apart = part.pins.windows(2).map(|pins| pins[1] - pins[0]);
            // Several positions of one pin differ by rounding.
            if let Some(apart) = apart.filter(|apart| *apart > SAME_PIN_DISTANCE).find(|apart| *apart <= diameter) {
                return Err(CutError::Holes { link: link.name.clone(), apart, diameter });
            }
        }
        Ok(())
    }

    /// Returns the distance between the middles of neighbouring layers, m.
    pub fn layer_pitch(&self) -> f64 {
        self.plate_thickness + self.spacer
    }

    /// Returns the radius of the spacers on a pin, m: rings whose wall is a quarter of the pin, but no wider than a bar.
    pub fn spacer_radius(&self) -> f64 {
        (0.75 * self.pin_diameter).min(0.5 * self.bar_width)
    }

    /// Returns the layer of each link, counted from 0 next to the base plate, or from the lowest link if it lies at no
    /// height of a layer; `None` if the links do not lie in layers of these dimensions, or all in one.
    pub fn layers_of(&self, machine: &Machine) -> Option<Vec<usize>> {
        let heights = machine.spec().links.iter().map(|link| link.axial);
        let least = heights.clone().fold(f64::INFINITY, f64::min);
        let below = least / self.layer_pitch();
        let is_layer = below >= 0.0 && (below - below.round()).abs() < LAYER_TOLERANCE;
        let lowest = if is_layer { 0.0 } else { least };
        let layer = |height: f64| {
            let layers = (height - lowest) / self.layer_pitch();
            ((layers - layers.round()).abs() < LAYER_TOLERANCE && layers < MAX_LAYER).then_some(layers.round() as usize)
        };
        let layers: Vec<usize> = heights.map(layer).collect::<Option<_>>()?;
        layers.iter().any(|layer| Some(layer) != layers.first()).then_some(layers)
    }

    /// Returns the thickness of a counterweight, m; `None` for a point. Drawings, lists and models have it from here.
    pub fn thickness_of(&self, weight: &Counterweight) -> Option<f64> {
        weight.thickness(self.density).map(|own| self.thickness.unwrap_or(own))
    }

    /// Returns the solid as which a counterweight is drawn in a model. A point is drawn as wide as a bar, half a ring as
    /// the box around it.
    pub(super) fn drawn_weight(&self, weight: &Counterweight) -> DrawnWeight {
        let height = self.thickness_of(weight).unwrap_or(2.0 * DRAWN_BAR_RADIUS);
        let at = [weight.at, weight.across];
        match weight.shape() {
            CounterweightShape::Point => DrawnWeight { at, height, size: DrawnSize::Disc(DRAWN_BAR_RADIUS) },
            CounterweightShape::Disc { radius } | CounterweightShape::Ring { radius, .. } => {
                DrawnWeight { at, height, size: DrawnSize::Disc(radius) }
            }
            CounterweightShape::HalfRing { radius, .. } => DrawnWeight {
                at: [weight.circle_at() + 0.5 * weight.outward() * radius, weight.across],
                height,
                size: DrawnSize::Box([radius, 2.0 * radius]),
            },
            CounterweightShape::Box { length, width } => {
                DrawnWeight { at, height, size: DrawnSize::Box([length, width]) }
            }
        }
    }

    /// Returns the mass of a counterweight, kg, for its shape and thickness, m.
    pub fn mass_of(&self, weight: &Counterweight, thickness: f64) -> f64 {
        weight.shape().body().mass * thickness * self.density
    }
}

/// Range of dimensions and densities, in SI units.
const MEASURES: std::ops::RangeInclusive<f64> = 1e-6..=1e6;
/// A height this far from a layer, as a fraction of the distance between layers, lies in it.
const LAYER_TOLERANCE: f64 = 1e-3;
/// Greatest number of a layer.
const MAX_LAYER: f64 = 1e4;
/// Pins closer than this are treated as one, m.
pub const SAME_PIN_DISTANCE: f64 = 1e-9;

fn measure(what: &'static str, value: Option<f64>, unit: &'static str) -> Result<(), CutError> {
    match value {
        Some(value) if !(MEASURES.contains(&value)) => Err(CutError::Measure { what, value, unit }),
        _ => Ok(()),
    }
}

/// The solid as which a counterweight is drawn in a model, in the axes of its link, m.
pub(super) struct DrawnWeight {
    /// Its middle.
    pub at: [f64; 2],
    /// Its height, normal to the plane of the motion.
    pub height: f64,
    /// Its size in this plane.
    pub size: DrawnSize,
}

/// Size of a solid in the plane of the motion, m.
pub(super) enum DrawnSize {
    /// A disc of this radius.
    Disc(f64),
    /// A box of this length along its link and width across it.
    Box([f64; 2]),
}

/// Returns the greatest length by which drawn bars reach beyond the pins of their links, m, although the masses of these
/// links do not count it: links that are made of parts do.
pub fn unweighed_tail(machine: &Machine) -> f64 {
    let bare = (0..machine.links().len()).filter(|j| machine.parts_of_link(*j).is_none());
    let beyond = bare.map(|j| {
        let ([first, last], [from, to]) = (machine.extent_with(j, |_| false), bar_extent(machine, j));
        (first - from).max(to - last)
    });
    beyond.fold(0.0, f64::max)
}

/// Returns the interval that a bar covers, m from its root: that of its part, or else its length, all its pins, and the
/// centres of its discs.
pub fn bar_extent(machine: &Machine, j: usize) -> [f64; 2] {
    let part = machine.spine(j).and_then(|bar| machine.part_ends(bar));
    part.unwrap_or_else(|| machine.extent_with(j, |_| true))
}
