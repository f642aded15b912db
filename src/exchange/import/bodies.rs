//! [`Bodies`]: those of MJCF with one hinge each, in the pose of the file.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Quaternion, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::linkage::{MOST_PARTS, Part};
use super::read::{child, each, inertia, mass, number, numbers, several, vector, word};
use super::refusal::{ImportError, called, wrong};
use crate::settings::range::clipped;

/// A point: the part that has it, none for the base, and where it is on the axes of the base.
pub type End = (Option<usize>, Vector3<f64>);

/// A body on the way down: its element, and what carries it.
type Open<'a> = (Node<'a, 'a>, Option<usize>);

/// Bodies, hinges and sites of a model.
pub struct Bodies<'a> {
    /// The root.
    pub model: Node<'a, 'a>,
    /// A degree or 1, rad.
    unit: f64,
    /// What a joint has that does not say so.
    axis: Vector3<f64>,
    /// Angles of the reference pose, rad, hinge by hinge.
    pose: Vec<f64>,
    /// Depth first.
    pub parts: Vec<Part>,
    bodies: Vec<Node<'a, 'a>>,
    /// The part of each hinge, by name.
    hinges: BTreeMap<&'a str, usize>,
    /// In the reference pose, rad, and the least and greatest that the hinge allows.
    angles: Vec<f64>,
    limits: Vec<Option<[f64; 2]>>,
    /// Sites by name: a part, and where on the axes of the base.
    pub sites: BTreeMap<&'a str, End>,
}

impl<'a> Bodies<'a> {
    /// Of a `<mujoco>`.
    ///
    /// # Errors
    /// What is no body with a hinge or fixed.
    pub fn of(model: Node<'a, 'a>) -> Result<Self, ImportError> {
        let mut bodies = Self::none(model)?;
        bodies.walk()?;
        Ok(bodies)
    }

    /// Before its bodies are read.
    fn none(model: Node<'a, 'a>) -> Result<Self, ImportError> {
        let other = |node: &Node| ["include", "replicate", "attach", "frame"].contains(&node.tag_name().name());
        if let Some(node) = model.descendants().find(other) {
            return Err(wrong(node, "what it brings is not read", "one file, with all bodies in it"));
        }
        let compiler = child(model, "compiler");
        let of = |name| compiler.and_then(|node| node.attribute(name));
        let unit = if of("angle") == Some("radian") { 1.0 } else { 1.0_f64.to_radians() };
        if let Some(node) = compiler.filter(|_| of("eulerseq").is_some_and(|seq| seq != "xyz")) {
            return Err(wrong(node, "another order of angles", "eulerseq=\"xyz\""));
        }
        let defaults = child(model, "default");
        let of_class = |node: &Node| node.has_tag_name("joint") && node.parent() != defaults;
        if let Some(node) = defaults.and_then(|node| node.descendants().find(of_class)) {
            return Err(wrong(node, "defaults of classes are not read", "what they say at each joint"));
        }
        let usual = defaults.and_then(|node| child(node, "joint"));
        if let Some(node) = usual {
            is_plain_hinge(node)?;
        }
        let axis = usual.map(|node| vector(node, "axis")).transpose()?.flatten().unwrap_or(Vector3::z());
        let key = child(model, "keyframe").and_then(|node| child(node, "key"));
        let pose = key.map(|node| numbers(node, "qpos")).transpose()?.flatten().unwrap_or_default();
        Ok(Self {
            model,
            unit,
            axis,
            pose,
            parts: Vec::new(),
            bodies: Vec::new(),
            hinges: BTreeMap::new(),
            angles: Vec::new(),
            limits: Vec::new(),
            sites: BTreeMap::new(),
        })
    }

    /// Bodies depth first, as the angles of a pose are listed.
    fn walk(&mut self) -> Result<(), ImportError> {
        let world = child(self.model, "worldbody");
        let world = world.ok_or_else(|| wrong(self.model, "it has no <worldbody>", "one, with the machine in it"))?;
        let mut open: Vec<Open> = each(world, "body").map(|body| (body, None)).collect();
        open.reverse();
        while let Some((body, parent)) = open.pop() {
            if self.parts.len() == MOST_PARTS {
                return Err(wrong(body, "too many bodies", format!("at most {MOST_PARTS}")));
            }
            self.body(body, parent)?;
            let own = self.parts.len() - 1;
            let children: Vec<Open> = each(body, "body").map(|child| (child, Some(own))).collect();
            open.extend(children.into_iter().rev());
        }
        Ok(())
    }

    fn body(&mut self, body: Node<'a, 'a>, parent: Option<usize>) -> Result<(), ImportError> {
        let on = parent.map_or(Isometry3::identity(), |parent| self.parts[parent].frame);
        let mut frame = on * self.place(body)?;
        let mut hinge = None;
        if let Some(node) = body.children().find(|node| node.has_tag_name("freejoint")) {
            return Err(wrong(node, "a body that floats", "a machine on a base: let the base move in a scenario"));
        }
        let mut joints = each(body, "joint");
        if let Some(joint) = joints.next() {
            if let Some(second) = joints.next() {
                return Err(wrong(second, "a second joint of one body", "one hinge for each"));
            }
            is_plain_hinge(joint)?;
            let axis = Unit::try_new(vector(joint, "axis")?.unwrap_or(self.axis), 1e-6)
                .ok_or_else(|| wrong(joint, "an axis without direction", "three numbers that are not all 0"))?;
            let at = vector(joint, "pos")?.unwrap_or_default();
            let count = self.angles.len();
            let angle = self.pose.get(count).copied().unwrap_or(0.0);
            self.angles.push(angle);
            let turn = UnitQuaternion::from_axis_angle(&axis, angle);
            let about = Translation3::from(at);
            frame = frame * about * turn * about.inverse();
            hinge = Some((frame.rotation * axis, (frame * nalgebra::Point3::from(at)).coords));
            if let Some(name) = joint.attribute("name") {
                self.hinges.insert(name, self.parts.len());
            }
            let limited = joint.attribute("limited") != Some("false");
            let range = several::<2>(joint, "range")?.filter(|_| limited);
            self.limits.push(range.map(|range| range.map(|x| self.unit * x)));
        } else {
            self.limits.push(None);
        }
        let own = self.parts.len();
        for site in each(body, "site") {
            let at = frame * nalgebra::Point3::from(vector(site, "pos")?.unwrap_or_default());
            if let Some(name) = site.attribute("name") {
                self.sites.insert(name, (Some(own), at.coords));
            }
        }
        let carriers = std::iter::successors(parent, |i| self.parts[*i].parent);
        let moves = hinge.is_some() || carriers.into_iter().any(|i| self.parts[i].hinge.is_some());
        let (mass, com, inertia) = self.weight(body, &frame, hinge.is_some(), moves)?;
        let name = body.attribute("name").map_or_else(|| format!("body {}", own + 1), Into::into);
        let at = body.range().start;
        self.parts.push(Part { name, called: called(body), at, parent, frame, hinge, mass, com, inertia });
        self.bodies.push(body);
        Ok(())
    }

    /// Where an element is and how it is turned.
    fn place(&self, node: Node<'_, '_>) -> Result<Isometry3<f64>, ImportError> {
        let at = vector(node, "pos")?.unwrap_or_default();
        if let Some(other) = ["axisangle", "xyaxes", "zaxis"].into_iter().find(|name| node.has_attribute(*name)) {
            return Err(wrong(node, format!("it is turned by {other}"), "quat or euler"));
        }
        let turn = match (several::<4>(node, "quat")?, vector(node, "euler")?) {
            (Some([w, x, y, z]), _) => UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9)
                .ok_or_else(|| wrong(node, "a quat of length 0", "four numbers that are not all 0"))?,
            (None, Some(angles)) => {
                let angles = self.unit * angles;
                let about = |axis, angle| UnitQuaternion::from_axis_angle(&axis, angle);
                about(Vector3::x_axis(), angles.x)
                    * about(Vector3::y_axis(), angles.y)
                    * about(Vector3::z_axis(), angles.z)
            }
            (None, None) => UnitQuaternion::identity(),
        };
        Ok(Isometry3::from_parts(Translation3::from(at), turn))
    }

    fn weight(
        &self,
        body: Node<'_, '_>,
        frame: &Isometry3<f64>,
        turns: bool,
        moves: bool,
    ) -> Result<(f64, Vector3<f64>, nalgebra::Matrix3<f64>), ImportError> {
        let Some(node) = child(body, "inertial") else {
            // A body that is a place only has neither.
            return match turns || (child(body, "geom").is_some() && moves) {
                true => Err(wrong(body, "it has no <inertial>", "its mass and inertia: shapes are not weighed")),
                false => Ok((0.0, frame.translation.vector, nalgebra::Matrix3::zeros())),
            };
        };
        let place = frame * self.place(node)?;
        let mass = mass(node, "mass")?;
        let all = match (several::<3>(node, "diaginertia")?, several::<6>(node, "fullinertia")?) {
            (Some([xx, yy, zz]), _) => [xx, yy, zz, 0.0, 0.0, 0.0],
            (None, Some(all)) => all,
            (None, None) => return Err(wrong(node, "it has no inertia", "diaginertia or fullinertia")),
        };
        Ok((mass, place.translation.vector, inertia(all, &Rotation3::from(place.rotation))))
    }

    /// The part of the hinge that an attribute names.
    ///
    /// # Errors
    /// If there is none.
    pub fn part_of(&self, node: Node<'_, '_>, attribute: &'static str) -> Result<usize, ImportError> {
        let name = word(node, attribute)?;
        let known = self.hinges.get(name).copied();
        known.ok_or_else(|| wrong(node, format!("{attribute} \"{}\" is no hinge", clipped(name)), "the name of one"))
    }

    /// What the angle of a hinge is in the pose of the file, rad.
    pub fn angle(&self, i: usize) -> f64 {
        let before = (0..i).filter(|j| self.parts[*j].hinge.is_some()).count();
        self.angles.get(before).copied().unwrap_or(0.0)
    }

    /// Least and greatest angle of a hinge, rad.
    pub fn range(&self, i: usize) -> Option<[f64; 2]> {
        self.limits.get(i).copied().flatten()
    }

    /// Both ends of a connect.
    ///
    /// # Errors
    /// If a site or body is not there, or the place not told.
    pub fn ends(&self, node: Node<'_, '_>) -> Result<[End; 2], ImportError> {
        if node.has_attribute("site1") {
            let end = |attribute: &'static str| {
                let name = word(node, attribute)?;
                let known = self.sites.get(name).copied();
                known.ok_or_else(|| wrong(node, format!("no site \"{}\"", clipped(name)), "the name of one in a body"))
            };
            return Ok([end("site1")?, end("site2")?]);
        }
        let body = |attribute: &'static str| -> Result<Option<usize>, ImportError> {
            let Some(name) = node.attribute(attribute) else { return Ok(None) };
            let known = self.bodies.iter().position(|body| body.attribute("name") == Some(name));
            known.map(Some).ok_or_else(|| wrong(node, format!("no body \"{}\"", clipped(name)), "the name of one"))
        };
        let (a, b) = (body("body1")?, body("body2")?);
        let anchor = vector(node, "anchor")?.unwrap_or_default();
        // It is given in the first body, and the same point of the other in the pose of the file; here in the keyframe.
        let frame = a.map_or(Isometry3::identity(), |a| self.parts[a].frame);
        let at = (frame * nalgebra::Point3::from(anchor)).coords;
        match self.pose.is_empty() {
            true => Ok([(a, at), (b, at)]),
            false => Err(wrong(node, "an anchor beside a keyframe", "site1 and site2")),
        }
    }
}

/// Refuses what moves otherwise.
fn is_plain_hinge(joint: Node<'_, '_>) -> Result<(), ImportError> {
    if let Some(kind) = joint.attribute("type").filter(|kind| *kind != "hinge") {
        let kind = clipped(kind);
        return Err(wrong(joint, format!("a joint of type \"{kind}\""), "hinges"));
    }
    match number(joint, "armature")? {
        Some(armature) if armature != 0.0 => {
            Err(wrong(joint, "an armature", "a rotor as a body of its own, coupled by an equality"))
        }
        _ => Ok(()),
    }
}
