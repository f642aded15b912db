//! [`Base`]: what the machine stands on.

use serde::{Deserialize, Serialize};

use super::{Wheel, is_default};
use crate::settings::range::{Check, Range};

const MASS: Range = Range::new(1e-9, 1e6, "kg");
const INERTIA: Range = Range::new(1e-9, 1e6, "kg m²");
const COM: Range = Range::either_way(1e3, "m");
const STIFFNESS: Range = Range::new(0.0, 1e9, "N/m, N m/rad");
const DAMPING: Range = Range::new(0.0, 1e9, "N s/m, N m s");

/// What the machine stands on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Base {
    /// Whether it moves, and what holds it.
    #[serde(default)]
    pub kind: BaseKind,
    /// m_b, kg.
    #[serde(default = "forty", skip_serializing_if = "is_forty")]
    pub mass: f64,
    /// I_b, about its own centre of mass, kg m².
    #[serde(default = "three", skip_serializing_if = "is_three")]
    pub inertia: f64,
    /// ρ: its centre of mass seen from B, in its own axes, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub com: [f64; 2],
    /// Springs of a compliant base: along x and y, N/m, and against rotation, N m/rad.
    #[serde(default = "springs", skip_serializing_if = "is_springs")]
    pub stiffness: [f64; 3],
    /// Dampers of a compliant base: along x and y, N s/m, and against rotation, N m s.
    #[serde(default = "dampers", skip_serializing_if = "is_dampers")]
    pub damping: [f64; 3],
    /// A reaction wheel in it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wheel: Option<Wheel>,
}

/// How the base is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BaseKind {
    /// It cannot move.
    #[default]
    Fixed,
    /// On springs and dampers, preloaded so that the start pose is an equilibrium.
    Compliant,
    /// It floats, as a spacecraft does.
    Free,
}

fn forty() -> f64 {
    40.0
}
fn is_forty(x: &f64) -> bool {
    *x == forty()
}
fn three() -> f64 {
    3.0
}
fn is_three(x: &f64) -> bool {
    *x == three()
}
fn springs() -> [f64; 3] {
    [2e4, 2e4, 2e3]
}
fn is_springs(x: &[f64; 3]) -> bool {
    *x == springs()
}
fn dampers() -> [f64; 3] {
    [200.0, 200.0, 10.0]
}
fn is_dampers(x: &[f64; 3]) -> bool {
    *x == dampers()
}

impl Default for Base {
    fn default() -> Self {
        Self {
            kind: BaseKind::Fixed,
            mass: forty(),
            inertia: three(),
            com: [0.0; 2],
            stiffness: springs(),
            damping: dampers(),
            wheel: None,
        }
    }
}

impl Base {
    /// Whether it can move.
    pub fn moves(&self) -> bool {
        self.kind != BaseKind::Fixed
    }

    /// What a key would want to have a say, if it has none as things are.
    pub fn unused(&self, key: &str) -> Option<&'static str> {
        let (used, want) = match key {
            "mass" | "inertia" | "com" => (self.moves(), "base.kind = free or compliant: a fixed base does not move"),
            "stiffness" | "damping" => (self.kind == BaseKind::Compliant, "base.kind = compliant"),
            _ => return None,
        };
        (!used).then_some(want)
    }

    /// Every number with its key, what it should be, and whether it is.
    pub(crate) fn checks(&self) -> Vec<Check> {
        let mut list = vec![MASS.check("base.mass", self.mass), INERTIA.check("base.inertia", self.inertia)];
        list.extend(self.com.map(|x| COM.check("base.com", x)));
        list.extend(self.stiffness.map(|x| STIFFNESS.check("base.stiffness", x)));
        list.extend(self.damping.map(|x| DAMPING.check("base.damping", x)));
        list.extend(self.wheel.iter().flat_map(Wheel::checks));
        list
    }
}
