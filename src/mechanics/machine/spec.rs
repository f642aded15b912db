//! A machine as a file states it: plain data, not yet checked.

use serde::{Deserialize, Serialize};

/// The content of a machine file. [`Machine::new`](super::Machine::new) checks it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineSpec {
    /// Short name, as used on the command line.
    pub name: String,
    /// One line about it.
    #[serde(default)]
    pub summary: String,
    /// Acceleration of gravity in base axes, m/s².
    #[serde(default, skip_serializing_if = "is_zero")]
    pub gravity: [f64; 2],
    /// Named lengths, m: bars that must stay equal share one.
    #[serde(default)]
    pub lengths: std::collections::BTreeMap<String, f64>,
    /// A mass held at the end effector.
    #[serde(default, skip_serializing_if = "Payload::is_none")]
    pub payload: Payload,
    /// The actuators: on the base, all at B on one axis, or in the joints.
    #[serde(default, rename = "drive")]
    pub drives: Vec<Drive>,
    /// The bars.
    #[serde(default, rename = "link")]
    pub links: Vec<Link>,
    /// Discs on links, which balance them.
    #[serde(default, rename = "counterweight", skip_serializing_if = "Vec::is_empty")]
    pub counterweights: Vec<Counterweight>,
    /// Pins that close loops.
    #[serde(default, rename = "closure", skip_serializing_if = "Vec::is_empty")]
    pub closures: Vec<Closure>,
    /// The point that works.
    pub end_effector: Option<Point>,
    /// Relative joint angles, which carry the joint limits.
    #[serde(default, rename = "angle", skip_serializing_if = "Vec::is_empty")]
    pub angles: Vec<Angle>,
}

fn is_zero(v: &[f64; 2]) -> bool {
    *v == [0.0; 2]
}

/// A rigid mass held at the end effector, turning with its link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// kg.
    #[serde(default)]
    pub mass: f64,
    /// About its own centre of mass, kg m².
    #[serde(default)]
    pub inertia: f64,
    /// Its centre of mass seen from the end effector: along the link that holds it, and to its left, m.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub offset: [f64; 2],
    /// Height of its centre of mass, and of a force on the end effector, along the drives' axis from the plane of
    /// reference, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub axial: f64,
}

impl Payload {
    fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Both held together as one: its mass, its common centre of mass, and its inertia about that.
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
        Self { mass, inertia, offset, axial: mean(self.axial, other.axial) }
    }
}

/// An actuator. Its limits are of the motor's own angle: that between what it turns and what its stator sits on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// Its name.
    pub name: String,
    /// The drive on whose links its stator sits; none: on the base.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// What turns in the motor, behind its gear; none: nothing that counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor: Option<Rotor>,
    /// The greatest torque it gives either way, N m; none: unlimited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque_limit: Option<f64>,
    /// The greatest |q̇| it turns at, rad/s; none: unlimited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_limit: Option<f64>,
    /// The greatest |q̈| asked of it, rad/s²; none: unlimited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acceleration_limit: Option<f64>,
    /// The greatest |q⃛| asked of it, rad/s³, by laws that keep jerk in bounds; none: unlimited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jerk_limit: Option<f64>,
}

/// What turns in a motor. Its mass belongs to the link that carries it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotor {
    /// About its axis, kg m².
    pub inertia: f64,
    /// How often it turns, seen from its stator, for one turn of the drive; below 0 the other way round.
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

/// A rigid bar, always parallel to the arm of one drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Link {
    /// Its name.
    pub name: String,
    /// The drive whose orientation it has.
    pub drive: String,
    /// Where its root is pinned.
    pub attach: Attach,
    /// 1: it runs along e(q); −1: along −e(q).
    #[serde(default = "forwards", skip_serializing_if = "is_forwards")]
    pub direction: i8,
    /// From root to tip, m.
    pub length: Length,
    /// kg.
    pub mass: f64,
    /// About its own centre of mass, kg m².
    pub inertia: f64,
    /// l_c: centre of mass along the link, from the root towards the tip, m.
    pub com: f64,
    /// Centre of mass off the link's axis, to the left of the direction root to tip, m.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub com_normal: f64,
    /// Height of its centre of mass along the drives' axis, from the plane of reference at B, m. The motion stays
    /// plane; the offsets decide which moments tilt the base.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub axial: f64,
}

/// A disc on a link's axis, in the plane of the link's own centre of mass. It moves with the link, and its mass is not
/// in that of the link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counterweight {
    /// The link that carries it.
    pub link: String,
    /// kg.
    pub mass: f64,
    /// Its centre along the link, from the root towards the tip, m.
    pub at: f64,
    /// m; 0: a point. Its inertia about its own centre is half of mass times radius squared.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub radius: f64,
    /// Whether it is part of the machine for other reasons than its balance, as a motor is: then it is neither taken off
    /// nor changed for the sake of balance.
    #[serde(default, skip_serializing_if = "is_false")]
    pub fixed: bool,
}

fn is_false(fixed: &bool) -> bool {
    !fixed
}

impl Counterweight {
    /// About its own centre, kg m².
    pub fn inertia(&self) -> f64 {
        0.5 * self.mass * self.radius * self.radius
    }
}

impl Link {
    /// The link and something fixed to its axis as one body: masses together, about their common centre.
    #[must_use]
    pub(super) fn with(&self, weight: &Counterweight) -> Self {
        let mass = self.mass + weight.mass;
        let com = (self.mass * self.com + weight.mass * weight.at) / mass;
        let com_normal = self.mass * self.com_normal / mass;
        let away = |x: f64, y: f64| (x - com).powi(2) + (y - com_normal).powi(2);
        let inertia = self.inertia
            + weight.inertia()
            + self.mass * away(self.com, self.com_normal)
            + weight.mass * away(weight.at, 0.0);
        Self { mass, com, com_normal, inertia, ..self.clone() }
    }
}

fn forwards() -> i8 {
    1
}
fn is_forwards(d: &i8) -> bool {
    *d == 1
}
fn is_nought(x: &f64) -> bool {
    *x == 0.0
}

/// Where a link hangs: at B, or on a point of another link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "want \"base\", or a point of another link: { link = \"…\", at = \"tip\" }")]
pub enum Attach {
    /// A point of another link.
    On(Point),
    /// `"base"`.
    Base(String),
}

/// A point of a link.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Point {
    /// The link's name.
    pub link: String,
    /// How far from its root.
    #[serde(default)]
    pub at: PlaceOnLink,
}

/// A place along a link, from its root towards its tip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "want a place along the link: \"tip\", \"root\", a number in m, or a named length")]
pub enum PlaceOnLink {
    /// m.
    Metres(f64),
    /// `"tip"`, `"root"`, a named length, or `"-name"` for backwards.
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
    /// m.
    Metres(f64),
    /// A shared length.
    Named(String),
}

/// Two descriptions of one point: a pin that closes a loop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Closure {
    /// The point as one link has it.
    pub a: Point,
    /// The same point as another has it.
    pub b: Point,
}

/// A relative joint angle a = q_to − q_from + offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Angle {
    /// Its name.
    pub name: String,
    /// A drive's name.
    pub to: String,
    /// A drive's name.
    pub from: String,
    /// rad.
    #[serde(default, skip_serializing_if = "is_nought")]
    pub offset: f64,
    /// Least value, rad; none: one turn from a half turn below 0, as without limits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Greatest value, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}
