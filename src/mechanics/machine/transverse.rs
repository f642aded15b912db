//! [`TransverseInertia`]: inertia of a body about axes in the plane of its motion.
//!
//! A plane motion does not feel it. A base that turns in space does, and so do models for other programs.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | x, y | place in the body from its centre of mass: along the link, and to the left of it | m |
//! | I_a, I_c | moments of inertia about the axis along the link, and about the axis across it in the plane | kg m² |
//! | I | moment of inertia about the axis normal to the plane, `inertia` in a file | kg m² |
//! | I_xy | product Σ m x y | kg m² |
//!
//! # Assumptions
//! Of a link itself I_xy = 0: its axis and those across it are principal. A counterweight is flat: I_a = Σ m y² and
//! I_c = Σ m x². So a link whose file states neither I_a nor I_c is a thin bar, with flat bodies on it.

use super::counterweight::{Counterweight, CounterweightShape};
use super::error::{KeyPath, MachineError};
use super::model::Machine;
use super::spec::{Link, MachineSpec, Payload};
use stillbase_settings::key_path::AsKeyStep;
use stillbase_settings::number::ShortNumber;

/// Part of the sum of all three moments by which rounding may break the triangle inequality.
const ROUNDING: f64 = 1e-12;

/// Moments of inertia of a body about axes in its plane through its centre of mass, kg m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TransverseInertia {
    /// I_a, about the axis along the link.
    pub along: f64,
    /// I_c, about the axis across the link.
    pub across: f64,
    /// Product Σ m x y.
    pub product: f64,
}

impl TransverseInertia {
    /// Returns those of a point mass, kg, at x, y, m.
    fn of_point(mass: f64, [x, y]: [f64; 2]) -> Self {
        Self { along: mass * y * y, across: mass * x * x, product: mass * x * y }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            along: self.along + other.along,
            across: self.across + other.across,
            product: self.product + other.product,
        }
    }
}

impl Counterweight {
    /// Returns its moments about axes in its plane, as a flat body.
    fn transverse(&self) -> TransverseInertia {
        let (all, shape) = (self.inertia(), self.shape());
        let about_length = match shape {
            CounterweightShape::Box { width, .. } => self.mass * width * width / 12.0,
            // Of half a circle the moment about its axis of symmetry is half that of the whole about its centre.
            CounterweightShape::HalfRing { radius, inner_radius } => {
                0.25 * self.mass * (radius * radius + inner_radius * inner_radius)
            }
            _ => 0.5 * all,
        };
        TransverseInertia { along: about_length, across: all - about_length, product: 0.0 }
    }
}

impl Link {
    /// Returns whether its file states an inertia about an axis in the plane.
    pub fn states_transverse(&self) -> bool {
        self.inertia_along != 0.0 || self.inertia_across.is_some()
    }

    /// Multiplies all its moments of inertia by a factor.
    pub fn scale_inertia(&mut self, factor: f64) {
        self.inertia *= factor;
        self.inertia_along *= factor;
        self.inertia_across = self.inertia_across.map(|across| factor * across);
    }
}

impl Payload {
    /// Returns whether its file states an inertia about an axis in the plane.
    pub fn states_transverse(&self) -> bool {
        self.inertia_along != 0.0 || self.inertia_across.is_some()
    }

    /// Multiplies all its moments of inertia by a factor.
    pub fn scale_inertia(&mut self, factor: f64) {
        self.inertia *= factor;
        self.inertia_along *= factor;
        self.inertia_across = self.inertia_across.map(|across| factor * across);
    }

    /// Returns its moments about axes in the plane.
    pub fn transverse(&self) -> TransverseInertia {
        let across = self.inertia_across.unwrap_or(self.inertia);
        TransverseInertia { along: self.inertia_along, across, product: 0.0 }
    }
}

impl Machine {
    /// Returns the moments of a link with its counterweights about axes in the plane, through their common centre of
    /// mass.
    pub fn link_transverse(&self, j: usize) -> TransverseInertia {
        let (own, with) = (&self.spec().links[j], &self.links()[j]);
        let away = |at: f64, across: f64| [at - with.com, across - with.com_normal];
        let bare = TransverseInertia {
            along: own.inertia_along,
            across: own.inertia_across.unwrap_or(own.inertia),
            product: 0.0,
        };
        let carried = self.spec().counterweights.iter().filter(|weight| weight.link == own.name);
        let start = bare.plus(TransverseInertia::of_point(own.mass, away(own.com, own.com_normal)));
        carried.fold(start, |sum, weight| {
            let moved = TransverseInertia::of_point(weight.mass, away(weight.at, weight.across));
            sum.plus(weight.transverse()).plus(moved)
        })
    }
}

/// Checks that no stated moment of inertia of a link or of the payload exceeds the sum of its other two.
pub(super) fn check(spec: &MachineSpec) -> Result<(), MachineError> {
    for (i, link) in spec.links.iter().enumerate().filter(|(_, link)| link.states_transverse()) {
        let across = link.inertia_across.unwrap_or(link.inertia);
        triangle([link.inertia_along, across, link.inertia], &[&"link", &i, &"inertia_along"])?;
    }
    let payload = &spec.payload;
    let across = payload.inertia_across.unwrap_or(payload.inertia);
    triangle([payload.inertia_along, across, payload.inertia], &[&"payload", &"inertia_along"])
}

fn triangle([along, across, inertia]: [f64; 3], place: &[&dyn AsKeyStep]) -> Result<(), MachineError> {
    let (least, most) = ((across - inertia).abs(), across + inertia);
    let slack = ROUNDING * (along + across + inertia);
    if along >= least - slack && along <= most + slack {
        return Ok(());
    }
    let why = format!(
        "is {} kg m², beside inertia_across = {} and inertia = {}: want {} to {} kg m², as no moment of inertia of a body \
         exceeds the sum of its other two",
        ShortNumber(along),
        ShortNumber(across),
        ShortNumber(inertia),
        ShortNumber(least),
        ShortNumber(most)
    );
    Err(MachineError::Transverse { place: KeyPath::new(place), why })
}
