//! [`MachineSpec`]: the content of a machine file as plain data, not yet checked.

use serde::{Deserialize, Serialize};

use super::counterweight::Counterweight;
use super::parts::{DerivedNumbers, LinkInFile, Lump, Material, Part};

/// The word by which a link follows no drive but keeps its orientation, along x of the base.
pub const GROUND: &str = "ground";

/// The content of a machine file. [`Machine::new`](super::Machine::new) checks it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineSpec {
    /// Short name, as used on the command line.
    pub name: String,
    /// Summary in one line.
    #[serde(default)]
    pub summary: String,
    /// Acceleration of gravity in base axes, m/s².
    #[serde(default, skip_serializing_if = "is_zero")]
    pub gravity: [f64; 2],
    /// Drive angles of the pose in which the machine is drawn, rad; no motion depends on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<Vec<f64>>,
    /// Named lengths, m; links that must have equal lengths share one.
    #[serde(default)]
    pub lengths: std::collections::BTreeMap<String, f64>,
    /// The payload at the end effector.
    #[serde(default, skip_serializing_if = "Payload::is_none")]
    pub payload: Payload,
    /// The actuators: those on the base share one axis at B, all others sit in joints.
    #[serde(default, rename = "drive")]
    pub drives: Vec<Drive>,
    /// The links, rigid bars.
    #[serde(default, rename = "link")]
    pub links: Vec<Link>,
    /// Materials beside the built-in ones.
    #[serde(default, rename = "material", skip_serializing_if = "Vec::is_empty")]
    pub materials: Vec<Material>,
    /// Bars and plates of which links are made.
    #[serde(default, rename = "part", skip_serializing_if = "Vec::is_empty")]
    pub parts: Vec<Part>,
    /// Bodies on links whose mass is known, such as motors.
    #[serde(default, rename = "lump", skip_serializing_if = "Vec::is_empty")]
    pub lumps: Vec<Lump>,
    /// Discs on links, which balance the machine.
    #[serde(default, rename = "counterweight", skip_serializing_if = "Vec::is_empty")]
    pub counterweights: Vec<Counterweight>,
    /// Pins that close loops.
    #[serde(default, rename = "closure", skip_serializing_if = "Vec::is_empty")]
    pub closures: Vec<Closure>,
    /// The end effector, a point of a link.
    pub end_effector: Option<LinkPoint>,
    /// Relative joint angles, which carry the joint limits.
    #[serde(default, rename = "angle", skip_serializing_if = "Vec::is_empty")]
    pub angles: Vec<Angle>,
}

impl MachineSpec {
    /// Returns the index of a link by its name.
    pub fn link_index(&self, name: &str) -> Option<usize> {
        self.links.iter().position(|link| link.name == name)
    }

    /// Returns whether a link has parts or lumps, from which its mass, centre of mass and inertia can follow.
    pub fn has_parts(&self, link: &str) -> bool {
        self.parts.iter().any(|part| part.link == link) || self.lumps.iter().any(|lump| lump.link == link)
    }
}

fn is_zero(v: &[f64; 2]) -> bool {
    *v == [0.0; 2]
}

/// A rigid mass held at the end effector, turning with its link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// Mass, kg.
    #[serde(default)]
    pub mass: f64,
    /// Inertia about its own centre of mass, kg m².
    #[serde(default)]
    pub inertia: f64,
    /// Inertia about the axis along the link that holds it, kg m²; no plane motion depends on it.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub inertia_along: f64,
    /// Inertia about the axis in the plane across that link, kg m²; `None` if it equals `inertia`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia_across: Option<f64>,
    /// Its centre of mass relative to the end effector: along the link that holds it, and to the left of that link's
    /// axis, m.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset: [f64; 2],
    /// Height of its centre of mass, and of a force on the end effector, above the reference plane through B, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub axial: f64,
}

impl Payload {
    fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Returns both payloads combined to one body: their total mass, common centre of mass, and inertia about that.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        let mean = |own: f64, others: f64| match other.mass > 0.0 {
            true => (self.mass * own + other.mass * others) / mass,
            false => own,
        };
        let offset = [0, 1].map(|i| mean(self.offset[i], other.offset[i]));
        let away = |p: &Self| p.mass * ((p.offset[0] - offset[0]).powi(2) + (p.offset[1] - offset[1]).powi(2));
        let inertia = self.inertia + other.inertia + away(&self) + away(&other);
        let axial = mean(self.axial, other.axial);
        let both = Self { mass, inertia, offset, axial, ..Self::default() };
        if !self.states_transverse() && !other.states_transverse() {
            return both;
        }
        let squared = |p: &Self, i: usize| p.mass * (p.offset[i] - offset[i]).powi(2);
        let [own, others] = [self.transverse(), other.transverse()];
        Self {
            inertia_along: own.along + others.along + squared(&self, 1) + squared(&other, 1),
            inertia_across: Some(own.across + others.across + squared(&self, 0) + squared(&other, 0)),
            ..both
        }
    }
}

/// An actuator. Its limits apply to the motor's torque and to the motion of the links that it turns relative to the
/// stator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// Its name.
    pub name: String,
    /// The drive on whose links its stator sits; `None` for the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// The motor's rotor, before the gear; `None` if its inertia is negligible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor: Option<Rotor>,
    /// Limit of |torque|, N m; `None` if unlimited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque_limit: Option<f64>,
    /// Limit of the speed relative to the stator, |q̇| on the base, rad/s; `None` if unlimited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_limit: Option<f64>,
    /// Limit of the planned acceleration relative to the stator, rad/s²; `None` if unlimited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration_limit: Option<f64>,
    /// Limit of the planned jerk relative to the stator, rad/s³, for time laws that bound jerk; `None` if unlimited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jerk_limit: Option<f64>,
}

/// The rotor of a motor. The mass of the rotor is included in the link that carries the motor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotor {
    /// Inertia about its axis, kg m².
    pub inertia: f64,
    /// Gear ratio: turns of the rotor relative to the stator for one turn of the drive; negative if the gear reverses.
    #[serde(default = "direct")]
    pub ratio: f64,
}

fn direct() -> f64 {
    1.0
}

impl Default for Rotor {
    fn default() -> Self {
        Self { inertia: 0.0, ratio: direct() }
    }
}

/// A rigid bar, always parallel to the arm of one drive. Those of its mass, centre of mass and inertia that nobody
/// types follow from its parts.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(from = "LinkInFile", into = "LinkInFile")]
pub struct Link {
    /// Its name.
    pub name: String,
    /// The drive whose orientation it has; [`GROUND`] for a link that is carried along and never turns.
    pub drive: String,
    /// The point to which its root is pinned.
    pub attach: Attach,
    /// Direction of the link: 1 along e(q), −1 along −e(q).
    pub direction: i8,
    /// Length from root to tip, m.
    pub length: Length,
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about its own centre of mass, kg m².
    pub inertia: f64,
    /// Inertia about its own axis, kg m²; no plane motion depends on it.
    pub inertia_along: f64,
    /// Inertia about the axis in the plane across it, kg m²; `None` if it equals `inertia`.
    pub inertia_across: Option<f64>,
    /// Position l_c of its centre of mass along the link, from the root towards the tip, m.
    pub com: f64,
    /// Distance of its centre of mass from the link's axis, to the left of the direction root to tip, m.
    pub com_normal: f64,
    /// Height of its centre of mass above the reference plane through B, m. The motion stays planar; the heights
    /// determine the moments that tilt the base.
    pub axial: f64,
    /// Which of its numbers follow from its parts.
    pub derived: DerivedNumbers,
}

pub(super) fn forwards() -> i8 {
    1
}

pub(super) fn is_forwards(d: &i8) -> bool {
    *d == 1
}

pub(super) fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

/// Attachment of a link's root: at B, or on a point of another link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "want \"base\", or a point of another link: { link = \"…\", at = \"tip\" }")]
pub enum Attach {
    /// A point of another link.
    On(LinkPoint),
    /// At B: the word `"base"`.
    Base(String),
}

/// A point of a link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkPoint {
    /// The link's name.
    pub link: String,
    /// Position along the link, from its root.
    #[serde(default)]
    pub at: PlaceOnLink,
}

/// A place along a link, from its root towards its tip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "want a place along the link: \"tip\", \"root\", a number in m, or a named length")]
pub enum PlaceOnLink {
    /// Distance from the root, m.
    Metres(f64),
    /// `"tip"`, `"root"`, a named length, or `"-name"` for a named length in the opposite direction.
    Named(String),
}

impl Default for PlaceOnLink {
    fn default() -> Self {
        Self::Named("tip".into())
    }
}

/// A length: a number or a name under `[lengths]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "want a length: a number in m, or a name under [lengths]")]
pub enum Length {
    /// A length, m.
    Metres(f64),
    /// The name of a shared length.
    Named(String),
}

/// A pin that closes a loop: two points that coincide in every pose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Closure {
    /// The point on the first link.
    pub a: LinkPoint,
    /// The point on the second link.
    pub b: LinkPoint,
}

/// A relative joint angle a = q_to − q_from + offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Angle {
    /// Its name.
    pub name: String,
    /// Name of the drive whose angle is added.
    pub to: String,
    /// Name of the drive whose angle is subtracted.
    pub from: String,
    /// Offset, rad.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub offset: f64,
    /// Lower limit, rad; `None` if there are no limits; poses are then searched in one turn, −π to π.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Upper limit, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}
