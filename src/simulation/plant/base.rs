//! [`Base`]: what the machine stands on.

use serde::{Deserialize, Serialize};

use super::{Wheel, is_default};
use crate::settings::key::{Holds, Key};
use crate::settings::range::Range;

/// Every key of `[base]`; those of `[base.wheel]` follow in [`Wheel`]'s.
pub const KEYS: [Key; 6] = [
    Key::new(
        "base.kind",
        Holds::Choice(&["fixed", "compliant", "free"]),
        "fixed",
        "How the base is held: it cannot move, it stands on springs and dampers, or it floats as a spacecraft does.",
    ),
    Key::number("base.mass", Range::new(1e-9, 1e6, "kg"), "40", "Mass m_b of the base.").when(MOVES),
    Key::number(
        "base.inertia",
        Range::new(1e-9, 1e6, "kg m²"),
        "3",
        "Inertia I_b of the base about its own centre of mass.",
    )
    .when(MOVES),
    Key::new(
        "base.com",
        Holds::List(2, Range::either_way(1e3, "m")),
        "0,0",
        "Centre of mass ρ of the base, seen from the base pin along the base's own axes.",
    )
    .when(MOVES),
    Key::new(
        "base.stiffness",
        Holds::List(3, Range::new(0.0, 1e9, "N/m, N m/rad")),
        "20000,20000,2000",
        "Springs under the base: along x and y, and against turning.",
    )
    .when(COMPLIANT),
    Key::new(
        "base.damping",
        Holds::List(3, Range::new(0.0, 1e9, "N s/m, N m s")),
        "200,200,10",
        "Dampers under the base: along x and y, and against turning.",
    )
    .when(COMPLIANT),
];

const MOVES: &str = "base.kind = free or compliant: a fixed base does not move";
const COMPLIANT: &str = "base.kind = compliant";

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

    /// Whether a key of this part has an effect as things are.
    pub fn uses(&self, key: &str) -> bool {
        match key {
            "mass" | "inertia" | "com" => self.moves(),
            "stiffness" | "damping" => self.kind == BaseKind::Compliant,
            _ => true,
        }
    }
}
