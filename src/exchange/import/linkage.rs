//! [`ImportedLinkage`]: the common result of both readers, with parts in space, their hinges, and the sets of parts
//! that turn together.

use nalgebra::{Isometry3, Matrix3, Unit, Vector3};

use super::refusal::ImportError;

/// Two directions are parallel up to this sine of the angle between them.
pub const PARALLEL_UP_TO_SINE: f64 = 1e-9;
/// Maximum number of parts: files with more are not machines of the family, and would take long to read.
pub const MAX_PARTS: usize = 400;

/// Usual names of an end effector, in lower case without separators; the most specific first.
const ENDS: [&str; 16] = [
    "endeffector",
    "endeffectorsite",
    "ee",
    "eelink",
    "eesite",
    "tcp",
    "tool",
    "tool0",
    "tooltip",
    "toolsite",
    "tip",
    "fingertip",
    "attachmentsite",
    "flange",
    "hand",
    "gripper",
];

/// Returns the rank of a name among the usual names of an end effector, 0 the most specific; `None` if it is not one.
pub fn end_rank(name: &str) -> Option<usize> {
    let bare = name.chars().filter(|c| c.is_alphanumeric()).take(40).flat_map(char::to_lowercase).collect::<String>();
    ENDS.iter().position(|own| *own == bare)
}

/// Parts in a reference pose.
#[derive(Debug)]
pub struct ImportedLinkage {
    /// Its name.
    pub name: String,
    /// Acceleration of gravity in the axes of the base, m/s².
    pub gravity: Vector3<f64>,
    /// Its parts, each after the part that carries it.
    pub parts: Vec<ImportedPart>,
    /// For each part, the index of the set of parts with which it turns; `None` for parts that do not turn.
    pub sets: Vec<Option<usize>>,
    /// The motor that turns each set, in the order of the sets.
    pub motors: Vec<ImportedMotor>,
    /// Limits of angles between sets.
    pub limits: Vec<JointLimit>,
    /// Rotors: the part, the motor that turns it, and its gear ratio.
    pub rotors: Vec<(usize, usize, f64)>,
    /// Closures: two points of different parts that coincide.
    pub loops: Vec<[PartPoint; 2]>,
    /// The end effector: a part, and a position in the axes of the base in the reference pose, m.
    pub end: Option<PartPoint>,
    /// The base without the parts that are fixed to it, if the file has one.
    pub ground: Option<Ground>,
    /// Notes on elements that were omitted.
    pub notes: Vec<String>,
}

/// A rigid part.
#[derive(Debug)]
pub struct ImportedPart {
    /// Its name.
    pub name: String,
    /// Its name in messages.
    pub called: String,
    /// Byte offset of its element in the file.
    pub at: usize,
    /// The part that carries it; `None` for the base.
    pub parent: Option<usize>,
    /// Transformation from its own axes to those of the base, in the reference pose.
    pub frame: Isometry3<f64>,
    /// The axis about which it turns, in the axes of the base, and a point on the axis, m; `None` if it is fixed.
    pub hinge: Option<(Unit<Vector3<f64>>, Vector3<f64>)>,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the axes of the base, m.
    pub com: Vector3<f64>,
    /// Inertia about the centre of mass, in the axes of the base, kg m².
    pub inertia: Matrix3<f64>,
}

/// A motor, which turns a set of parts relative to another.
#[derive(Clone, Debug, Default)]
pub struct ImportedMotor {
    /// Its name.
    pub name: String,
    /// The part whose hinge it turns, if it turns a single hinge.
    pub hinge: Option<usize>,
    /// The set that carries it; `None` for the base.
    pub from: Option<usize>,
    /// Limit of |torque|, N m.
    pub torque_limit: Option<f64>,
    /// Limit of |rate|, rad/s.
    pub speed_limit: Option<f64>,
    /// Limit of |acceleration|, rad/s².
    pub acceleration_limit: Option<f64>,
    /// Limit of |jerk|, rad/s³.
    pub jerk_limit: Option<f64>,
    /// Armature, kg m²: adds to the inertia of the motor's angle but not to the momentum.
    pub armature: f64,
}

/// Limits of the angle of a set relative to another.
#[derive(Clone, Debug)]
pub struct JointLimit {
    /// Name of the angle, if it has one.
    pub name: Option<String>,
    /// The set whose angle counts positive.
    pub to: usize,
    /// The set whose angle counts negative; `None` for the base.
    pub from: Option<usize>,
    /// The angle in the reference pose, rad about the common axis.
    pub now: f64,
    /// Lower and upper limit, rad; `None` if it turns freely.
    pub range: Option<[f64; 2]>,
}

/// A point of a part: index of the part, and position in the axes of the base in the reference pose, m.
pub type PartPoint = (usize, Vector3<f64>);

/// The base on which the machine stands or floats.
#[derive(Clone, Copy, Debug)]
pub struct Ground {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the axes of the base, m.
    pub com: Vector3<f64>,
    /// Inertia about the centre of mass, kg m².
    pub inertia: Matrix3<f64>,
    /// Whether it floats.
    pub floats: bool,
}

impl ImportedPart {
    /// Makes an error of this part.
    pub fn wrong(&self, what: impl Into<String>, want: impl Into<String>) -> ImportError {
        ImportError::of(self.at, &self.called, what, want)
    }
}

/// Returns the common direction of all hinge axes, and for each part the sign of its own axis: 1 along it, −1 against
/// it.
///
/// # Errors
/// If there is no hinge, or if the axes are not parallel.
pub fn common_axis(parts: &[ImportedPart]) -> Result<(Unit<Vector3<f64>>, Vec<f64>), ImportError> {
    let first = parts.iter().find_map(|part| part.hinge).map(|(axis, _)| axis);
    let Some(first) = first else {
        return Err(ImportError::of_file("nothing turns", "links on revolute joints or hinges"));
    };
    // The first of z, y and x with a magnitude above 0.5 becomes positive. So the angle about an axis of the file
    // along +z, +y or +x keeps its sign.
    let up = [first.z, first.y, first.x].into_iter().find(|x| x.abs() > 0.5).unwrap_or(1.0);
    let axis = if up < 0.0 { -first } else { first };
    let mut signs = Vec::with_capacity(parts.len());
    for part in parts {
        let own = part.hinge.map_or(axis, |(own, _)| own);
        if own.cross(&axis).norm() > PARALLEL_UP_TO_SINE {
            let [x, y, z] = [own.x, own.y, own.z].map(|x| stillbase_settings::number::fixed(x, 3));
            return Err(part.wrong(
                format!("it turns about {x} {y} {z}, not parallel to the others"),
                "axes that are all parallel: a machine that moves in a plane",
            ));
        }
        signs.push(own.dot(&axis).signum());
    }
    Ok((axis, signs))
}

/// Returns for each part the turning part with which it moves; `None` if it moves with the base. This is the part
/// itself if it has a hinge, or else that of the part to which it is fixed.
pub fn owners(parts: &[ImportedPart]) -> Vec<Option<usize>> {
    let mut owners: Vec<Option<usize>> = Vec::with_capacity(parts.len());
    for (i, part) in parts.iter().enumerate() {
        let owner = if part.hinge.is_some() { Some(i) } else { part.parent.and_then(|parent| owners[parent]) };
        owners.push(owner);
    }
    owners
}

/// Returns x, y and the normal of the plane, in the axes of the base.
pub fn plane(normal: &Unit<Vector3<f64>>) -> [Vector3<f64>; 3] {
    let n = normal.into_inner();
    // The plane's x is the projection of the base's x, or of its y if x is nearly normal to the plane.
    let x = if n.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let x = (x - n * n.dot(&x)).normalize();
    [x, n.cross(&x), n]
}
