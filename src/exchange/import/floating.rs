//! [`BodyJoints`]: the joints of an MJCF body, and [`FloatingBase`], the body on which a machine floats.

use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::defaults::{Class, Defaults, Element};
use super::linkage::PARALLEL_UP_TO_SINE;
use super::read::{AttributeSource, number, vector};
use super::refusal::{ImportError, element_error};
use stillbase_settings::range::quote_clipped;

/// The joints that are supported, for messages.
const JOINTS_WANTED: &str = "hinges; a base that floats has a free joint, or two joints of type slide and a hinge";

/// The joints of a body.
pub enum BodyJoints<'a> {
    /// It is fixed to what carries it.
    None,
    /// It turns.
    Hinge(Element<'a>),
    /// It floats.
    Floating(FloatingJoints<'a>),
}

/// The joints with which a body floats: one free joint, or two slides and a hinge in any order.
pub struct FloatingJoints<'a>(Vec<Element<'a>>);

/// The body on which a machine floats.
pub struct FloatingBase<'a> {
    /// Its index.
    pub body: usize,
    /// Its joints.
    joints: FloatingJoints<'a>,
    /// Rotation from its axes to those of the world in the pose of the file.
    pub attitude: UnitQuaternion<f64>,
}

impl<'a> BodyJoints<'a> {
    /// Reads the joints of a body.
    ///
    /// # Errors
    /// If they are neither one hinge nor those of a base that floats.
    pub fn of(body: Node<'a, 'a>, class: &Class<'a>, defaults: &Defaults<'a>) -> Result<Self, ImportError> {
        let nodes = body.children().filter(|node| node.has_tag_name("joint") || node.has_tag_name("freejoint"));
        // A fourth joint is too many in any case.
        let joints = nodes.take(4).map(|node| defaults.element(node, class)).collect::<Result<Vec<_>, _>>()?;
        let kinds: Vec<&str> = joints.iter().map(kind).collect();
        match kinds[..] {
            [] => Ok(Self::None),
            ["free"] | ["slide", "slide", "hinge"] | ["slide", "hinge", "slide"] | ["hinge", "slide", "slide"] => {
                Ok(Self::Floating(FloatingJoints(joints)))
            }
            _ => match (joints.iter().find(|joint| kind(joint) != "hinge"), &joints[..]) {
                (Some(other), _) => {
                    let what = format!("a joint of type \"{}\"", quote_clipped(kind(other)));
                    Err(element_error(other.node(), what, JOINTS_WANTED))
                }
                (None, [_, second, ..]) => {
                    Err(element_error(second.node(), "a second joint of one body", "one hinge for each"))
                }
                (None, joints) => Ok(joints.first().map_or(Self::None, |hinge| Self::Hinge(hinge.clone()))),
            },
        }
    }
}

/// Returns the type of a joint.
fn kind<'a>(joint: &Element<'a>) -> &'a str {
    match joint.node().has_tag_name("freejoint") {
        true => "free",
        false => joint.get("type").unwrap_or("hinge"),
    }
}

/// Returns the direction of a joint's axis.
///
/// # Errors
/// If it has none.
pub fn axis(joint: &Element<'_>) -> Result<Unit<Vector3<f64>>, ImportError> {
    Unit::try_new(vector(joint, "axis")?.unwrap_or(Vector3::z()), 1e-6)
        .ok_or_else(|| element_error(joint.node(), "an axis without direction", "three numbers that are not all 0"))
}

impl<'a> FloatingJoints<'a> {
    /// Returns how many numbers a pose has for them.
    pub fn coordinates(&self) -> usize {
        if self.0.len() == 1 { 7 } else { 3 }
    }

    /// Returns their first element.
    pub fn node(&self) -> Node<'a, 'a> {
        self.0[0].node()
    }

    /// Makes a base that floats by these joints. `drawn` is its orientation as its element states it, `pose` its numbers
    /// in a keyframe, and `unit` the unit of angles in the file, rad.
    ///
    /// # Errors
    /// If a number or an axis is wrong.
    pub fn base(
        self,
        body: usize,
        drawn: UnitQuaternion<f64>,
        pose: Option<&[f64]>,
        unit: f64,
    ) -> Result<FloatingBase<'a>, ImportError> {
        let Some(pose) = pose else { return Ok(FloatingBase { body, joints: self, attitude: drawn }) };
        let attitude = match *pose {
            [_, _, _, w, x, y, z] => UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9).ok_or_else(|| {
                element_error(self.node(), "the keyframe turns it by a quaternion of 0", "one that is not 0")
            })?,
            _ => {
                let mut attitude = drawn;
                for (joint, at) in self.0.iter().zip(pose).filter(|(joint, _)| kind(joint) == "hinge") {
                    let from = number(joint, "ref")?.unwrap_or(0.0) * unit;
                    attitude *= UnitQuaternion::from_axis_angle(&axis(joint)?, at - from);
                }
                attitude
            }
        };
        Ok(FloatingBase { body, joints: self, attitude })
    }
}

impl<'a> FloatingBase<'a> {
    /// Makes an error of its joints.
    pub fn wrong(&self, what: &str, want: &str) -> ImportError {
        element_error(self.joints.node(), what, want)
    }

    /// Returns its joints.
    pub fn joints(&self) -> &[Element<'a>] {
        &self.joints.0
    }

    /// Checks that it moves and turns freely in the plane of the machine.
    ///
    /// # Errors
    /// If one of its joints prevents that.
    pub fn check_plane(&self, normal: &Vector3<f64>) -> Result<(), ImportError> {
        let mut along: Option<Vector3<f64>> = None;
        for joint in self.joints().iter().filter(|joint| kind(joint) != "free") {
            let own = axis(joint)?.into_inner();
            let wrong = |what| element_error(joint.node(), what, "two slides in the plane in which the arm moves");
            if kind(joint) == "hinge" {
                if own.cross(normal).norm() > PARALLEL_UP_TO_SINE {
                    let want = "an axis parallel to those of the arm";
                    return Err(element_error(joint.node(), "the base turns about another axis than the arm", want));
                }
            } else if own.dot(normal).abs() > PARALLEL_UP_TO_SINE {
                return Err(wrong("it slides out of the plane in which the arm moves"));
            } else if along.replace(own).is_some_and(|other| own.cross(&other).norm() <= PARALLEL_UP_TO_SINE) {
                return Err(wrong("it slides along the same line as the other slide"));
            }
        }
        Ok(())
    }
}
