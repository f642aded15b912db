//! A machine as URDF, the format of ROS and Pinocchio: a tree of links and joints, with axes parallel to z of `base`.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q_k | absolute angle of drive k | rad |
//! | θ_k | angle of joint `drive_k`: that of motor k, q_k − q_l on drive l, or q_k on the base | rad |
//! | N | gear ratio of a rotor: it turns by N θ_k in its stator | |
//!
//! The joints `drive_k` are the only independent ones. The frame of a link has its origin at the link's root and x
//! along e(q_k). A link that runs against its drive lies along −x. With the mimic joints eliminated, mass matrix and
//! gravity torques are those of the machine.
//!
//! # What URDF cannot express
//! URDF has no elements for gravity, for pins that close loops, and for limits of acceleration and jerk. It has none
//! for limits of an angle that is not a motor's. (Mimic joints keep the loops closed.) The element `<stillbase>`
//! contains all these; other programs ignore it, and [`import`](super::import) reads it. Friction, springs and the
//! motion of the base belong to a scenario. Inertias about axes in the plane do not affect a plane motion; their values
//! are made up.

use super::base_body::BaseBody;
use super::cut::{Cut, DrawnSize, DrawnWeight};
use super::look::{BASE_COLOUR, DRAWN_BAR_RADIUS, DRIVE_COLOURS};
use super::tree::{Tree, TreeJoint, TreePart, Turns};
use super::xml::{XmlWriter, quoted, remark};
use stillbase_mechanics::machine::{Machine, Payload, RelativeAngle};

/// Mass of auxiliary links as a fraction of the machine's mass: some programs read a link without mass as one of 1 kg.
const AUXILIARY_MASS_FRACTION: f64 = 1e-13;
/// Limit written for an unlimited torque, N m, or rate, rad/s, because URDF requires one.
const UNLIMITED: f64 = 1e9;

/// Returns the model of a machine as text. A base that floats hangs on a link `world` by a floating joint. `cut` gives the thickness of counterweights, which is for the eye: mass and
/// inertia are those of the machine.
pub fn urdf(machine: &Machine, base: Option<&BaseBody>, cut: &Cut) -> String {
    Model::of(machine, base, cut).text()
}

/// Returns the name of the joint that turns by the angle of motor k.
pub fn joint(machine: &Machine, k: usize) -> String {
    format!("drive_{}", machine.spec().drives[k].name)
}

/// Returns the intersection of two intervals; if it is empty, an interval of one value.
pub(super) fn meet(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let least = a[0].max(b[0]);
    [least, a[1].min(b[1]).max(least)]
}

struct Model<'a> {
    machine: &'a Machine,
    /// The base, if it floats.
    base: Option<&'a BaseBody>,
    cut: &'a Cut,
    tree: Tree<'a>,
    /// Mass, kg, and inertia, kg m², of an auxiliary link.
    least: f64,
    lines: XmlWriter,
}

/// A rigid body in the frame of its link.
struct Body {
    /// Centre of mass, m.
    at: [f64; 3],
    /// Mass, kg.
    mass: f64,
    /// Moment of inertia about the axis through its centre of mass parallel to z, kg m².
    inertia: f64,
}

impl<'a> Model<'a> {
    fn of(machine: &'a Machine, base: Option<&'a BaseBody>, cut: &'a Cut) -> Self {
        Self {
            machine,
            base,
            cut,
            tree: Tree::of(machine),
            least: AUXILIARY_MASS_FRACTION * machine.mass(),
            lines: XmlWriter::default(),
        }
    }

    fn text(mut self) -> String {
        let name = quoted(&self.machine.spec().name);
        self.lines.add(0, format_args!("<?xml version=\"1.0\"?>"));
        self.lines.add(0, format_args!("<robot name=\"{name}\">"));
        self.remark("Axes of all joints are parallel to z of base. Only the joints drive_… move by themselves.");
        self.remark("Links pin_… and shaft_… have no mass to speak of: they add up angles, one joint a motor.");
        for (k, colour) in DRIVE_COLOURS.iter().enumerate().take(self.machine.drives()) {
            let drive = quoted(&self.machine.spec().drives[k].name);
            self.lines.add(1, format_args!("<material name=\"drive_{drive}\"><color rgba=\"{colour}\"/></material>"));
        }
        self.floating();
        let joints = self.tree.joints.clone();
        joints.iter().for_each(|joint| self.part(joint.child));
        joints.iter().for_each(|joint| self.joint(joint));
        self.extension();
        self.lines.add(0, format_args!("</robot>"));
        self.lines.into_text()
    }

    /// Writes the base, and what carries it if it floats.
    fn floating(&mut self) {
        let Some(base) = self.base else { return self.lines.add(1, format_args!("<link name=\"base\"/>")) };
        let (at, side) = ([base.com.re, base.com.im], base.drawn_side());
        self.lines.add(1, format_args!("<material name=\"base\"><color rgba=\"{BASE_COLOUR}\"/></material>"));
        self.lines.add(1, format_args!("<link name=\"world\"/>"));
        self.lines.add(1, format_args!("<link name=\"base\">"));
        self.inertial(&Body { at: [at[0], at[1], 0.0], mass: base.mass, inertia: base.inertia });
        self.visual("base", at, &format!("<box size=\"{side} {side} {DRAWN_BAR_RADIUS}\"/>"));
        self.lines.add(1, format_args!("</link>"));
        self.lines.add(1, format_args!("<joint name=\"base_floats\" type=\"floating\">"));
        self.lines.add(2, format_args!("<parent link=\"world\"/>"));
        self.lines.add(2, format_args!("<child link=\"base\"/>"));
        self.lines.add(1, format_args!("</joint>"));
    }

    fn remark(&mut self, text: &str) {
        self.lines.add(1, format_args!("<!-- {} -->", remark(text)));
    }

    /// Writes the element `<stillbase>` with all that URDF cannot express.
    fn extension(&mut self) {
        let mut all = Vec::new();
        let machine = self.machine;
        let spec = machine.spec();
        if spec.gravity != [0.0; 2] {
            let [x, y] = spec.gravity;
            all.push(format!("<gravity x=\"{x}\" y=\"{y}\"/>"));
        }
        for angle in machine.angles() {
            let (to, from) = (quoted(&spec.drives[angle.to].name), quoted(&spec.drives[angle.from].name));
            let (name, offset) = (quoted(&angle.name), angle.offset);
            let (least, most) = (angle.limits.start(), angle.limits.end());
            let limits = match least.is_finite() && most.is_finite() {
                true => format!(" lower=\"{least}\" upper=\"{most}\""),
                false => String::new(),
            };
            all.push(format!(
                "<angle name=\"{name}\" to=\"drive_{to}\" from=\"drive_{from}\" offset=\"{offset}\"{limits}/>"
            ));
        }
        for drive in &spec.drives {
            let limits = [("acceleration", drive.acceleration_limit), ("jerk", drive.jerk_limit)];
            let said: String =
                limits.iter().filter_map(|(what, limit)| Some(format!(" {what}=\"{}\"", (*limit)?))).collect();
            if !said.is_empty() {
                all.push(format!("<limit joint=\"drive_{}\"{said}/>", quoted(&drive.name)));
            }
        }
        for pin in machine.loops() {
            let name = |j: usize| self.tree.name(TreePart::Link(j));
            let at = |j: usize, at: f64| machine.resolved_links()[j].sign * at;
            let (a, b) = (name(pin.a), name(pin.b));
            let [at_a, at_b] = [at(pin.a, pin.at_a), at(pin.b, pin.at_b)];
            all.push(format!("<pin a=\"{a}\" at_a=\"{at_a}\" b=\"{b}\" at_b=\"{at_b}\"/>"));
        }
        if all.is_empty() {
            return;
        }
        self.lines.add(1, format_args!("<stillbase>"));
        all.iter().for_each(|line| self.lines.add(2, format_args!("{line}")));
        self.lines.add(1, format_args!("</stillbase>"));
    }

    /// Returns the limits of a relative angle as limits of a motor's joint, rad. `None` if there are no limits, or no
    /// motor turns this angle.
    fn limited(&self, angle: &RelativeAngle) -> Option<(usize, [f64; 2])> {
        let motors = self.machine.motors();
        let (least, most) = (angle.limits.start() - angle.offset, angle.limits.end() - angle.offset);
        if !(least.is_finite() && most.is_finite()) {
            return None;
        }
        match () {
            () if motors.on(angle.to) == Some(angle.from) => Some((angle.to, [least, most])),
            () if motors.on(angle.from) == Some(angle.to) => Some((angle.from, [-most, -least])),
            () => None,
        }
    }

    fn joint(&mut self, joint: &TreeJoint) {
        let (name, parent, child) =
            (self.tree.joint_name(joint), self.tree.name(joint.parent), self.tree.name(joint.child));
        let (kind, more) = match joint.turns {
            Turns::Not => ("fixed", String::new()),
            Turns::Motor(k) => self.limits(k, 1.0),
            // Some programs require that a mimic joint has the same type as the joint that it mimics.
            Turns::Follows(k, times) => {
                let drive = quoted(&self.machine.spec().drives[k].name);
                let (kind, limits) = self.limits(k, times);
                (kind, format!("{limits}<mimic joint=\"drive_{drive}\" multiplier=\"{times}\" offset=\"0\"/>"))
            }
        };
        self.lines.add(1, format_args!("<joint name=\"{name}\" type=\"{kind}\">"));
        self.lines.add(2, format_args!("<parent link=\"{parent}\"/>"));
        self.lines.add(2, format_args!("<child link=\"{child}\"/>"));
        self.lines.add(2, format_args!("<origin xyz=\"{} 0 0\"/>", joint.at));
        if joint.turns != Turns::Not {
            self.lines.add(2, format_args!("<axis xyz=\"0 0 1\"/>"));
            self.lines.add(2, format_args!("{more}"));
        }
        self.lines.add(1, format_args!("</joint>"));
    }

    /// Returns type and limits of a joint that turns by `times` times the angle of motor k.
    fn limits(&self, k: usize, times: f64) -> (&'static str, String) {
        let drive = &self.machine.spec().drives[k];
        let ranges = self.machine.angles().iter().filter_map(|angle| self.limited(angle));
        let range = ranges.filter(|(of, _)| *of == k).map(|(_, range)| range).reduce(meet);
        let (effort, velocity) = (drive.torque_limit.unwrap_or(UNLIMITED), drive.speed_limit.unwrap_or(UNLIMITED));
        let kind = if range.is_some() { "revolute" } else { "continuous" };
        let range = range.map_or(String::new(), |range| {
            let [a, b] = range.map(|x| times * x);
            format!(" lower=\"{}\" upper=\"{}\"", a.min(b), a.max(b))
        });
        let velocity = (velocity * times.abs()).min(UNLIMITED);
        (kind, format!("<limit{range} effort=\"{effort}\" velocity=\"{velocity}\"/>"))
    }

    fn part(&mut self, part: TreePart) {
        let machine = self.machine;
        let body = match part {
            TreePart::Link(j) => {
                let (link, sign) = (&machine.links()[j], machine.resolved_links()[j].sign);
                let at = [sign * link.com, sign * link.com_normal, link.axial];
                Body { at, mass: link.mass, inertia: link.inertia }
            }
            // The rotor's mass is part of the link that carries it.
            TreePart::Rotor(k) => {
                let inertia = machine.spec().drives[k].rotor.map_or(self.least, |rotor| rotor.inertia);
                Body { inertia, ..self.auxiliary() }
            }
            TreePart::Payload => {
                let (payload, sign) = (machine.spec().payload, machine.resolved_links()[machine.end_link()].sign);
                let [along, left] = payload.offset.map(|x| sign * x);
                Body { at: [along, left, payload.axial], ..Body::from(payload) }
            }
            TreePart::Base | TreePart::Shaft(_) | TreePart::Between(..) | TreePart::End => self.auxiliary(),
        };
        let name = self.tree.name(part);
        self.lines.add(1, format_args!("<link name=\"{name}\">"));
        self.inertial(&body);
        if let TreePart::Link(j) = part {
            self.shape(j);
        }
        self.lines.add(1, format_args!("</link>"));
    }

    fn inertial(&mut self, body: &Body) {
        let Body { at: [x, y, z], mass, inertia } = body;
        // Any values with ixx + iyy ≥ izz are valid: a plane motion depends only on the inertia about z.
        let other = 0.6 * inertia;
        self.lines.add(2, format_args!("<inertial>"));
        self.lines.add(3, format_args!("<origin xyz=\"{x} {y} {z}\"/>"));
        self.lines.add(3, format_args!("<mass value=\"{mass}\"/>"));
        let rest = format!("ixy=\"0\" ixz=\"0\" iyy=\"{other}\" iyz=\"0\" izz=\"{inertia}\"");
        self.lines.add(3, format_args!("<inertia ixx=\"{other}\" {rest}/>"));
        self.lines.add(2, format_args!("</inertial>"));
    }

    /// Returns the body of an auxiliary link, with negligible mass and inertia.
    fn auxiliary(&self) -> Body {
        Body { at: [0.0; 3], mass: self.least, inertia: self.least }
    }

    /// Writes the visual shape of a link: a bar over all its pins, and its counterweights.
    fn shape(&mut self, j: usize) {
        let machine = self.machine;
        let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
        let ends = part.pins.iter().fold([0.0_f64, part.length], |[least, most], at| [least.min(*at), most.max(*at)]);
        let (middle, length) = (part.sign * 0.5 * (ends[0] + ends[1]), ends[1] - ends[0] + 2.0 * DRAWN_BAR_RADIUS);
        let bar = format!("<box size=\"{length} {} {}\"/>", 2.0 * DRAWN_BAR_RADIUS, 0.5 * DRAWN_BAR_RADIUS);
        let material = format!("drive_{}", quoted(&machine.spec().drives[part.drive].name));
        self.visual(&material, [middle, 0.0], &bar);
        for weight in machine.spec().counterweights.iter().filter(|weight| weight.link == link.name) {
            let DrawnWeight { at, height, size } = self.cut.drawn_weight(weight);
            let solid = match size {
                DrawnSize::Disc(radius) => format!("<cylinder radius=\"{radius}\" length=\"{height}\"/>"),
                DrawnSize::Box([length, width]) => format!("<box size=\"{length} {width} {height}\"/>"),
            };
            self.visual(&material, at.map(|x| part.sign * x), &solid);
        }
    }

    fn visual(&mut self, material: &str, [x, y]: [f64; 2], geometry: &str) {
        self.lines.add(2, format_args!("<visual>"));
        self.lines.add(3, format_args!("<origin xyz=\"{x} {y} 0\"/>"));
        self.lines.add(3, format_args!("<geometry>{geometry}</geometry>"));
        self.lines.add(3, format_args!("<material name=\"{material}\"/>"));
        self.lines.add(2, format_args!("</visual>"));
    }
}

impl From<Payload> for Body {
    fn from(payload: Payload) -> Self {
        Self { at: [0.0; 3], mass: payload.mass, inertia: payload.inertia }
    }
}
