//! [`Linkage`]: what both formats come to: parts in space with their hinges, and which of them turn together.

use nalgebra::{Isometry3, Matrix3, Unit, Vector3};

use super::refusal::ImportError;

/// Directions whose sine is below this are parallel.
const PARALLEL: f64 = 1e-9;
/// The most parts: more are no machine of the family, and take long.
pub const MOST_PARTS: usize = 400;

/// Names by which others know the point that works, in small letters without what joins words; the surest first.
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

/// How sure a name is one of the point that works, 0 the surest; none: it is not.
pub fn end_rank(name: &str) -> Option<usize> {
    let bare = name.chars().filter(|c| c.is_alphanumeric()).take(40).flat_map(char::to_lowercase).collect::<String>();
    ENDS.iter().position(|own| *own == bare)
}

/// Parts in a reference pose.
#[derive(Debug)]
pub struct Linkage {
    /// What it is called.
    pub name: String,
    /// In the axes of the base, m/s².
    pub gravity: Vector3<f64>,
    /// None before the one that carries it.
    pub parts: Vec<Part>,
    /// For each part the set of those that turn together with it; none: those that do not turn.
    pub sets: Vec<Option<usize>>,
    /// What turns each set, in their order.
    pub motors: Vec<Motor>,
    /// What is allowed between sets.
    pub limits: Vec<Limit>,
    /// Parts that are rotors, the motor that turns each, and how often it turns for one turn of that.
    pub rotors: Vec<(usize, usize, f64)>,
    /// Points of two parts that are one.
    pub loops: Vec<[Point; 2]>,
    /// The point that works: a part, and where on the base's axes it is in the reference pose, m.
    pub end: Option<Point>,
    /// What the base weighs, where the file says so.
    pub ground: Option<Ground>,
    /// What was left out.
    pub notes: Vec<String>,
}

/// A rigid part.
#[derive(Debug)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// As messages call it.
    pub called: String,
    /// Where the file has it, bytes.
    pub at: usize,
    /// What carries it; none: the base.
    pub parent: Option<usize>,
    /// From its own axes to those of the base, in the reference pose.
    pub frame: Isometry3<f64>,
    /// The axis about which it turns, in the axes of the base, and a point on it; none: it is fixed.
    pub hinge: Option<(Unit<Vector3<f64>>, Vector3<f64>)>,
    /// kg.
    pub mass: f64,
    /// Centre of mass in the axes of the base, m.
    pub com: Vector3<f64>,
    /// About it, in the axes of the base, kg m².
    pub inertia: Matrix3<f64>,
}

/// What turns a set of parts against another.
#[derive(Clone, Debug, Default)]
pub struct Motor {
    /// Its name.
    pub name: String,
    /// The part whose hinge it turns, if it is one.
    pub hinge: Option<usize>,
    /// The set that carries it; none: the base.
    pub from: Option<usize>,
    /// N m.
    pub torque_limit: Option<f64>,
    /// rad/s.
    pub speed_limit: Option<f64>,
    /// rad/s².
    pub acceleration_limit: Option<f64>,
    /// rad/s³.
    pub jerk_limit: Option<f64>,
    /// What it adds to the inertia of its angle, and nothing to the momentum, kg m².
    pub armature: f64,
}

/// How far a set may turn against another.
#[derive(Clone, Debug)]
pub struct Limit {
    /// What the angle is called, if it has a name.
    pub name: Option<String>,
    /// A set.
    pub to: usize,
    /// Another; none: the base.
    pub from: Option<usize>,
    /// What the angle is in the reference pose, rad about the common axis.
    pub now: f64,
    /// Least and greatest, rad; none: it turns freely.
    pub range: Option<[f64; 2]>,
}

/// A point of a part: where it is on the axes of the base in the reference pose, m.
pub type Point = (usize, Vector3<f64>);

/// What all stands on, with all that is fixed to it.
#[derive(Clone, Copy, Debug)]
pub struct Ground {
    /// kg.
    pub mass: f64,
    /// Centre of mass in the axes of the base, m.
    pub com: Vector3<f64>,
    /// About it, kg m².
    pub inertia: Matrix3<f64>,
}

impl Part {
    /// What is wrong with it.
    pub fn wrong(&self, what: impl Into<String>, want: impl Into<String>) -> ImportError {
        ImportError::of(self.at, &self.called, what, want)
    }
}

/// The axis that all hinges are parallel to, and for each part 1 where its own runs along it, −1 against it.
pub fn common_axis(parts: &[Part]) -> Result<(Unit<Vector3<f64>>, Vec<f64>), ImportError> {
    let first = parts.iter().find_map(|part| part.hinge).map(|(axis, _)| axis);
    let Some(first) = first else {
        return Err(ImportError::whole("nothing turns", "links on revolute joints or hinges"));
    };
    // Upwards, as far as there is such: angles then turn as they do in the file.
    let up = [first.z, first.y, first.x].into_iter().find(|x| x.abs() > 0.5).unwrap_or(1.0);
    let axis = if up < 0.0 { -first } else { first };
    let mut signs = Vec::with_capacity(parts.len());
    for part in parts {
        let own = part.hinge.map_or(axis, |(own, _)| own);
        if own.cross(&axis).norm() > PARALLEL {
            let [x, y, z] = [own.x, own.y, own.z].map(|x| crate::settings::number::fixed(x, 3));
            return Err(part.wrong(
                format!("it turns about {x} {y} {z}, not parallel to the others"),
                "axes that are all parallel: a machine that moves in a plane",
            ));
        }
        signs.push(own.dot(&axis).signum());
    }
    Ok((axis, signs))
}

/// For each part the one that it moves with: itself where it turns, else what it is fixed to; none: the base.
pub fn owners(parts: &[Part]) -> Vec<Option<usize>> {
    let mut owners: Vec<Option<usize>> = Vec::with_capacity(parts.len());
    for (i, part) in parts.iter().enumerate() {
        let owner = if part.hinge.is_some() { Some(i) } else { part.parent.and_then(|parent| owners[parent]) };
        owners.push(owner);
    }
    owners
}

/// x, y and the normal of the plane, in the axes of the base.
pub fn plane(normal: &Unit<Vector3<f64>>) -> [Vector3<f64>; 3] {
    let n = normal.into_inner();
    // The plane's x is the base's, where that lies in it or near it; else its y.
    let x = if n.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let x = (x - n * n.dot(&x)).normalize();
    [x, n.cross(&x), n]
}
