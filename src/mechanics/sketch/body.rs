//! [`Body`]: numbers of a bar that someone typed, and what a bar weighs.

use serde::{Deserialize, Serialize};

use super::drawing::{Bar, Sketch};
use crate::machine::{Link, LinkNumber, PlaneBody, sum_of};
use stillbase_settings::number::shortest;

/// Typed numbers of a bar. Those that are not given follow from its parts, or without parts from its length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Mass, kg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// Inertia about its own centre of mass, kg m².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<f64>,
    /// Inertia about its own axis, kg m².
    #[serde(default, skip_serializing_if = "is_nought")]
    pub inertia_along: f64,
    /// Inertia about the axis in the plane across it, kg m²; `None` if it equals that about its centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia_across: Option<f64>,
    /// Position of its centre of mass from the root towards the tip, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub com: Option<f64>,
    /// Distance of its centre of mass to the left of the direction root to tip, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub com_normal: Option<f64>,
    /// Height of its centre of mass above the reference plane through B, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub axial: f64,
}

fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

/// Part of a number that a sum of the numbers of a few bodies is off by.
const SUMMED: f64 = 1e-14;

impl Body {
    /// Returns the typed numbers of a link.
    pub(super) fn of(link: &Link) -> Self {
        let typed = |number| Some(link.number(number)).filter(|_| !link.follows(number));
        let [mass, inertia, com, com_normal] = LinkNumber::ALL.map(typed);
        let Link { inertia_along, inertia_across, axial, .. } = *link;
        Self { mass, inertia, inertia_along, inertia_across, com, com_normal, axial }
    }

    /// Returns all numbers of a body as typed; out of its plane it is a thin bar.
    pub(super) fn typed(body: &PlaneBody, axial: f64) -> Self {
        let [mass, at, across, inertia] = [body.mass, body.at, body.across, body.inertia].map(|x| shortest(x, SUMMED));
        let com_normal = Some(across).filter(|across| *across != 0.0);
        Self { mass: Some(mass), inertia: Some(inertia), com: Some(at), com_normal, axial, ..Self::default() }
    }

    /// Returns a number, in SI units, if it is typed.
    pub(super) fn number(&self, number: LinkNumber) -> Option<f64> {
        match number {
            LinkNumber::Mass => self.mass,
            LinkNumber::Inertia => self.inertia,
            LinkNumber::Along => self.com,
            LinkNumber::Across => self.com_normal,
        }
    }

    /// Returns the numbers that are typed.
    pub fn typed_numbers(&self) -> impl Iterator<Item = LinkNumber> {
        LinkNumber::ALL.into_iter().filter(|number| self.number(*number).is_some())
    }

    /// Returns it without its typed numbers, which follow from parts again; `None` if nothing is left. Its height stays, and its
    /// inertia about axes in the plane.
    pub fn freed(&self) -> Option<Self> {
        Some(self.untyped()).filter(|rest| *rest != Self::default())
    }

    /// Returns whether no number is typed that parts can give.
    pub fn follows(&self) -> bool {
        *self == self.untyped()
    }

    /// Returns what no part can give.
    fn untyped(&self) -> Self {
        let Self { inertia_along, inertia_across, axial, .. } = *self;
        Self { inertia_along, inertia_across, axial, ..Self::default() }
    }
}

impl Sketch {
    /// Returns what a bar weighs: its typed numbers, and for the others those of its parts, or of a slender bar.
    pub fn body(&self, bar: &Bar) -> PlaneBody {
        let index = self.bars.iter().position(|own| own.id == bar.id);
        let parts = index.filter(|_| self.has_parts(&bar.name)).and_then(|i| sum_of(&self.part_bodies().ok()?, i));
        self.with_typed(bar, parts)
    }

    /// Returns what each bar weighs, in their order.
    pub fn bodies(&self) -> Vec<PlaneBody> {
        let parts = self.part_bodies().unwrap_or_default();
        let of = |(i, bar): (usize, &Bar)| {
            self.with_typed(bar, self.has_parts(&bar.name).then(|| sum_of(&parts, i)).flatten())
        };
        self.bars.iter().enumerate().map(of).collect()
    }

    /// Returns what a bar weighs whose parts are this body, if it has parts.
    fn with_typed(&self, bar: &Bar, parts: Option<PlaneBody>) -> PlaneBody {
        let stated = self.stated(bar);
        let rest = parts.unwrap_or_else(|| self.slender(bar));
        PlaneBody {
            mass: stated.mass.unwrap_or(rest.mass),
            at: stated.com.unwrap_or(rest.at),
            across: stated.com_normal.unwrap_or(rest.across),
            inertia: stated.inertia.unwrap_or(rest.inertia),
        }
    }

    /// Returns the numbers of a bar that its machine states: those that follow from no parts.
    pub(super) fn stated(&self, bar: &Bar) -> Body {
        let own = bar.body.unwrap_or_default();
        if self.has_parts(&bar.name) {
            return own;
        }
        let PlaneBody { mass, at, inertia, .. } = self.slender(bar);
        let [mass, inertia, com] =
            [(own.mass, mass), (own.inertia, inertia), (own.com, at)].map(|(typed, rest)| typed.or(Some(rest)));
        Body { mass, inertia, com, com_normal: own.com_normal.filter(|across| *across != 0.0), ..own }
    }

    /// Returns the body of a slender bar between its outermost pins, to four digits.
    fn slender(&self, bar: &Bar) -> PlaneBody {
        let [low, high] = self.extent(bar);
        let length = high - low;
        let mass = bar.per_metre * length;
        let inertia = mass * length * length / 12.0;
        let [mass, inertia, at] = [mass, inertia, 0.5 * (low + high)].map(four_digits);
        PlaneBody { mass, at, across: 0.0, inertia }
    }

    /// Returns where the outermost pins of a bar are, m from its root.
    pub(super) fn extent(&self, bar: &Bar) -> [f64; 2] {
        let places = || bar.all_pins().map(|pin| self.along(bar, pin));
        [places().fold(0.0, f64::min), places().fold(0.0, f64::max)]
    }
}

/// Rounds a number to four digits, as a person writes it.
fn four_digits(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}
