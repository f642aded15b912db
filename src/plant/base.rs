//! [`Base`]: what the machine stands on.

use serde::{Deserialize, Serialize};

use super::{Wheel, is_default};

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
    /// Springs of a compliant base: along x and y, N/m, and against tilt, N m/rad.
    #[serde(default = "springs", skip_serializing_if = "is_springs")]
    pub stiffness: [f64; 3],
    /// Dampers of a compliant base: along x and y, N s/m, and against tilt, N m s.
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

    /// Every number with its key, what it should be, and whether it is.
    pub(crate) fn checks(&self) -> Vec<(&'static str, f64, &'static str, bool)> {
        let mut list = vec![
            ("base.mass", self.mass, "above 0, up to 1e6 kg", self.mass > 0.0 && self.mass <= 1e6),
            ("base.inertia", self.inertia, "above 0, up to 1e6 kg m²", self.inertia > 0.0 && self.inertia <= 1e6),
        ];
        let place = |x: f64| x.abs() <= 1e3;
        list.extend(self.com.map(|x| ("base.com", x, "-1000 to 1000 m", place(x))));
        let hold = |x: f64| (0.0..=1e9).contains(&x);
        list.extend(self.stiffness.map(|x| ("base.stiffness", x, "0 to 1e9 N/m, N m/rad", hold(x))));
        list.extend(self.damping.map(|x| ("base.damping", x, "0 to 1e9 N s/m, N m s", hold(x))));
        list.extend(self.wheel.iter().flat_map(Wheel::checks));
        list
    }
}
