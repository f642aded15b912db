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
//! Each block of an assembly has a base at its mount, and names that begin with that of the block. A platform turns back by
//! what its end effector turned, with mimic joints too. In space inertias about all axes count: links are thin bars
//! unless their file states more.
//!
//! # What URDF cannot express
//! URDF has no elements for gravity, for pins that close loops, and for limits of acceleration and jerk. It has none
//! for limits of an angle that is not a motor's. (Mimic joints keep the loops closed.) The element `<stillbase>`
//! contains all these; other programs ignore it, and [`import`](super::import) reads it. Friction, springs and the
//! motion of the base belong to a scenario. Inertias about axes in the plane do not affect a plane motion; of a machine by
//! itself their values are made up.

use nalgebra::{Matrix3, Vector3};

use super::base_body::BaseBody;
use super::cut::{Cut, DrawnSize, DrawnWeight};
use super::look::{BASE_COLOUR, DRAWN_BAR_RADIUS, DRIVE_COLOURS};
use super::placed::{FloatingBase, Modelled, Placed};
use super::tree::{TreeJoint, TreePart, Turns};
use super::xml::{XmlWriter, quoted, remark};
use stillbase_mechanics::assembly::{Assembly, SpatialBase};
use stillbase_mechanics::machine::{Machine, RelativeAngle};

/// Mass of auxiliary links as a fraction of the machine's mass: some programs read a link without mass as one of 1 kg.
const AUXILIARY_MASS_FRACTION: f64 = 1e-13;
/// Limit written for an unlimited torque, N m, or rate, rad/s, because URDF requires one.
const UNLIMITED: f64 = 1e9;

/// Returns the model of a machine as text. A base that floats hangs on a link `world` by a floating joint. `cut` gives the
/// thickness of counterweights, which is for the eye: mass and inertia are those of the machine.
pub fn urdf(machine: &Machine, base: Option<&BaseBody>, cut: &Cut) -> String {
    Model::of(Modelled::machine(machine, base), cut).text()
}

/// Returns the model of an assembly as text, as [`urdf`] does that of a machine.
pub fn urdf_of_assembly(assembly: &Assembly, base: Option<&SpatialBase>, cut: &Cut) -> String {
    Model::of(Modelled::assembly(assembly, base), cut).text()
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
    of: Modelled<'a>,
    cut: &'a Cut,
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
    /// Inertia about its centre of mass, kg m².
    inertia: Matrix3<f64>,
}

impl Body {
    /// Returns a body whose principal axes are those of its link.
    fn new(at: [f64; 3], mass: f64, inertia: [f64; 3]) -> Self {
        Self { at, mass, inertia: Matrix3::from_diagonal(&Vector3::from(inertia)) }
    }
}

impl<'a> Model<'a> {
    fn of(of: Modelled<'a>, cut: &'a Cut) -> Self {
        let least = AUXILIARY_MASS_FRACTION * of.mass();
        Self { of, cut, least, lines: XmlWriter::default() }
    }

    fn text(mut self) -> String {
        let name = quoted(self.of.name);
        self.lines.add(0, format_args!("<?xml version=\"1.0\"?>"));
        self.lines.add(0, format_args!("<robot name=\"{name}\">"));
        match self.of.machines.first() {
            Some(Placed { block: None, .. }) => {
                self.remark(
                    "Axes of all joints are parallel to z of base. Only the joints drive_… move by themselves.",
                );
            }
            _ => self.remark(
                "Axes of a block's joints are parallel to z of its base. Only the joints …/drive_… move by themselves.",
            ),
        }
        self.remark("Links pin_… and shaft_… have no mass to speak of: they add up angles, one joint a motor.");
        for i in self.of.order.clone() {
            self.materials(i);
        }
        self.floating();
        for i in self.of.order.clone() {
            self.seat_link(i);
            let parts: Vec<TreePart> = self.of.machines[i].tree.joints.iter().map(|joint| joint.child).collect();
            parts.into_iter().for_each(|part| self.part(i, part));
        }
        for i in self.of.order.clone() {
            self.seat_joint(i);
            let joints = self.of.machines[i].tree.joints.clone();
            joints.iter().for_each(|joint| self.joint(i, joint));
        }
        self.extension();
        self.lines.add(0, format_args!("</robot>"));
        self.lines.into_text()
    }

    fn materials(&mut self, i: usize) {
        let Placed { machine, tree, .. } = &self.of.machines[i];
        for (k, colour) in DRIVE_COLOURS.iter().enumerate().take(machine.drives()) {
            let name = tree.of_drive("drive", k);
            self.lines.add(1, format_args!("<material name=\"{name}\"><color rgba=\"{colour}\"/></material>"));
        }
    }

    /// Writes the base, and what carries it if it floats.
    fn floating(&mut self) {
        let Some(base) = &self.of.base else { return self.lines.add(1, format_args!("<link name=\"base\"/>")) };
        let (at, [a, b, c]) = base.drawn();
        let body = match base {
            FloatingBase::Planar(base) => {
                Body::new(at, base.mass, [0.6 * base.inertia, 0.6 * base.inertia, base.inertia])
            }
            FloatingBase::Spatial(base) => Body { at, mass: base.mass, inertia: base.inertia },
        };
        self.lines.add(1, format_args!("<material name=\"base\"><color rgba=\"{BASE_COLOUR}\"/></material>"));
        self.lines.add(1, format_args!("<link name=\"world\"/>"));
        self.lines.add(1, format_args!("<link name=\"base\">"));
        self.inertial(&body);
        self.visual("base", at, &format!("<box size=\"{a} {b} {c}\"/>"));
        self.lines.add(1, format_args!("</link>"));
        self.lines.add(1, format_args!("<joint name=\"base_floats\" type=\"floating\">"));
        self.lines.add(2, format_args!("<parent link=\"world\"/>"));
        self.lines.add(2, format_args!("<child link=\"base\"/>"));
        self.lines.add(1, format_args!("</joint>"));
    }

    /// Writes the base of a block.
    fn seat_link(&mut self, i: usize) {
        if self.of.machines[i].block.is_some() {
            self.part(i, TreePart::Base);
        }
    }

    /// Writes the joint that holds the base of a block at its mount.
    fn seat_joint(&mut self, i: usize) {
        let placed = &self.of.machines[i];
        let (tree, Some(mount)) = (&placed.tree, placed.mount()) else { return };
        let parent = match mount.on {
            Some(on) => self.of.machines[on].tree.name(TreePart::Platform),
            None => "base".to_owned(),
        };
        let (name, child) = (tree.holder(TreePart::Base), tree.name(TreePart::Base));
        let (at, axes) = self.of.seat(mount);
        let ([x, y, z], [roll, pitch, yaw]) = (at.into(), angles(&axes));
        self.lines.add(1, format_args!("<joint name=\"{name}\" type=\"fixed\">"));
        self.lines.add(2, format_args!("<parent link=\"{parent}\"/>"));
        self.lines.add(2, format_args!("<child link=\"{child}\"/>"));
        self.lines.add(2, format_args!("<origin xyz=\"{x} {y} {z}\" rpy=\"{roll} {pitch} {yaw}\"/>"));
        self.lines.add(1, format_args!("</joint>"));
    }

    fn remark(&mut self, text: &str) {
        self.lines.add(1, format_args!("<!-- {} -->", remark(text)));
    }

    /// Writes the element `<stillbase>` with all that URDF cannot express.
    fn extension(&mut self) {
        let mut all = Vec::new();
        let [x, y, z] = self.of.gravity;
        if self.of.gravity != [0.0; 3] {
            let is_flat = self.of.machines.iter().all(|of| of.block.is_none());
            let out_of_plane = if is_flat { String::new() } else { format!(" z=\"{z}\"") };
            all.push(format!("<gravity x=\"{x}\" y=\"{y}\"{out_of_plane}/>"));
        }
        self.of.order.iter().for_each(|i| all.extend(extended(&self.of.machines[*i])));
        if all.is_empty() {
            return;
        }
        self.lines.add(1, format_args!("<stillbase>"));
        all.iter().for_each(|line| self.lines.add(2, format_args!("{line}")));
        self.lines.add(1, format_args!("</stillbase>"));
    }

    fn joint(&mut self, i: usize, joint: &TreeJoint) {
        let placed = &self.of.machines[i];
        let tree = &placed.tree;
        let (name, parent, child) = (tree.joint_name(joint), tree.name(joint.parent), tree.name(joint.child));
        let (kind, more) = match joint.turns {
            Turns::Not => ("fixed", String::new()),
            Turns::Motor(k) => limits(placed.machine, k, 1.0),
            // Some programs require that a mimic joint has the same type as the joint that it mimics.
            Turns::Follows(k, times) => {
                let drive = tree.of_drive("drive", k);
                let (kind, limits) = limits(placed.machine, k, times);
                (kind, format!("{limits}<mimic joint=\"{drive}\" multiplier=\"{times}\" offset=\"0\"/>"))
            }
        };
        let [_, height] = if joint.child == TreePart::End { placed.end() } else { [0.0; 2] };
        self.lines.add(1, format_args!("<joint name=\"{name}\" type=\"{kind}\">"));
        self.lines.add(2, format_args!("<parent link=\"{parent}\"/>"));
        self.lines.add(2, format_args!("<child link=\"{child}\"/>"));
        self.lines.add(2, format_args!("<origin xyz=\"{} 0 {height}\"/>", joint.at));
        if joint.turns != Turns::Not {
            self.lines.add(2, format_args!("<axis xyz=\"0 0 1\"/>"));
            self.lines.add(2, format_args!("{more}"));
        }
        self.lines.add(1, format_args!("</joint>"));
    }

    fn part(&mut self, i: usize, part: TreePart) {
        let placed = &self.of.machines[i];
        let (machine, least) = (placed.machine, self.least);
        let body = match part {
            TreePart::Link(j) => {
                let (link, sign) = (&machine.links()[j], machine.resolved_links()[j].sign);
                let at = [sign * link.com, sign * link.com_normal, link.axial];
                Body { at, mass: link.mass, inertia: placed.of_link(j) }
            }
            // The rotor's mass is part of the link that carries it.
            TreePart::Rotor(k) => {
                let inertia = machine.spec().drives[k].rotor.map_or(least, |rotor| rotor.inertia);
                Body::new([0.0; 3], least, placed.of_rotor(inertia))
            }
            TreePart::Payload => {
                let (payload, sign) = (machine.spec().payload, machine.resolved_links()[machine.end_link()].sign);
                let [along, left] = payload.offset.map(|x| sign * x);
                // The end effector of a block has the height of its payload.
                let height = payload.axial - placed.end()[1];
                Body { at: [along, left, height], mass: payload.mass, inertia: placed.of_payload() }
            }
            TreePart::Base
            | TreePart::Shaft(_)
            | TreePart::Between(..)
            | TreePart::End
            | TreePart::Under(_)
            | TreePart::Platform => Body::new([0.0; 3], least, [0.6 * least, 0.6 * least, least]),
        };
        let name = placed.tree.name(part);
        self.lines.add(1, format_args!("<link name=\"{name}\">"));
        self.inertial(&body);
        if let TreePart::Link(j) = part {
            self.shape(i, j);
        }
        self.lines.add(1, format_args!("</link>"));
    }

    fn inertial(&mut self, body: &Body) {
        let Body { at: [x, y, z], mass, inertia } = body;
        let [[xx, xy, xz], [_, yy, yz], [.., zz]] = inertia.transpose().data.0;
        self.lines.add(2, format_args!("<inertial>"));
        self.lines.add(3, format_args!("<origin xyz=\"{x} {y} {z}\"/>"));
        self.lines.add(3, format_args!("<mass value=\"{mass}\"/>"));
        let rest = format!("ixy=\"{xy}\" ixz=\"{xz}\" iyy=\"{yy}\" iyz=\"{yz}\" izz=\"{zz}\"");
        self.lines.add(3, format_args!("<inertia ixx=\"{xx}\" {rest}/>"));
        self.lines.add(2, format_args!("</inertial>"));
    }

    /// Writes the visual shape of a link: a bar over all its pins, and its counterweights.
    fn shape(&mut self, i: usize, j: usize) {
        let Placed { machine, tree, .. } = &self.of.machines[i];
        let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
        let ends = part.pins.iter().fold([0.0_f64, part.length], |[least, most], at| [least.min(*at), most.max(*at)]);
        let (middle, length) = (part.sign * 0.5 * (ends[0] + ends[1]), ends[1] - ends[0] + 2.0 * DRAWN_BAR_RADIUS);
        let bar = format!("<box size=\"{length} {} {}\"/>", 2.0 * DRAWN_BAR_RADIUS, 0.5 * DRAWN_BAR_RADIUS);
        let material = tree.of_drive("drive", part.drive.min(machine.drives() - 1));
        let mut solids = vec![([middle, 0.0, 0.0], bar)];
        for weight in machine.spec().counterweights.iter().filter(|weight| weight.link == link.name) {
            let DrawnWeight { at, height, size } = self.cut.drawn_weight(weight);
            let solid = match size {
                DrawnSize::Disc(radius) => format!("<cylinder radius=\"{radius}\" length=\"{height}\"/>"),
                DrawnSize::Box([length, width]) => format!("<box size=\"{length} {width} {height}\"/>"),
            };
            let [x, y] = at.map(|x| part.sign * x);
            solids.push(([x, y, 0.0], solid));
        }
        solids.into_iter().for_each(|(at, solid)| self.visual(&material, at, &solid));
    }

    fn visual(&mut self, material: &str, [x, y, z]: [f64; 3], geometry: &str) {
        self.lines.add(2, format_args!("<visual>"));
        self.lines.add(3, format_args!("<origin xyz=\"{x} {y} {z}\"/>"));
        self.lines.add(3, format_args!("<geometry>{geometry}</geometry>"));
        self.lines.add(3, format_args!("<material name=\"{material}\"/>"));
        self.lines.add(2, format_args!("</visual>"));
    }
}

/// Returns roll, pitch and yaw of axes, given as columns, rad: R = R_z R_y R_x.
fn angles(axes: &Matrix3<f64>) -> [f64; 3] {
    let yaw = axes[(1, 0)].atan2(axes[(0, 0)]);
    let pitch = (0.0 - axes[(2, 0)]).atan2(axes[(0, 0)].hypot(axes[(1, 0)]));
    // Taken back by the yaw, so that rounding cancels where x is upright and the yaw could be any.
    let (sin, cos) = yaw.sin_cos();
    let roll = (sin * axes[(0, 2)] - cos * axes[(1, 2)]).atan2(cos * axes[(1, 1)] - sin * axes[(0, 1)]);
    [roll, pitch, yaw]
}

/// Returns what URDF cannot express of a machine, as elements.
fn extended(of: &Placed<'_>) -> Vec<String> {
    let (Placed { machine, tree, .. }, spec) = (of, of.machine.spec());
    let mut all = Vec::new();
    for angle in machine.angles() {
        let [to, from] = [angle.to, angle.from].map(|k| tree.of_drive("drive", k));
        let (name, offset) = (tree.own(quoted(&angle.name)), angle.offset);
        let (least, most) = (angle.limits.start(), angle.limits.end());
        let limits = match least.is_finite() && most.is_finite() {
            true => format!(" lower=\"{least}\" upper=\"{most}\""),
            false => String::new(),
        };
        all.push(format!("<angle name=\"{name}\" to=\"{to}\" from=\"{from}\" offset=\"{offset}\"{limits}/>"));
    }
    for (k, drive) in spec.drives.iter().enumerate() {
        let limits = [("acceleration", drive.acceleration_limit), ("jerk", drive.jerk_limit)];
        let said: String =
            limits.iter().filter_map(|(what, limit)| Some(format!(" {what}=\"{}\"", (*limit)?))).collect();
        if !said.is_empty() {
            all.push(format!("<limit joint=\"{}\"{said}/>", tree.of_drive("drive", k)));
        }
    }
    for pin in machine.loops() {
        let name = |j: usize| tree.name(TreePart::Link(j));
        let at = |j: usize, at: f64| machine.resolved_links()[j].sign * at;
        let (a, b) = (name(pin.a), name(pin.b));
        let [at_a, at_b] = [at(pin.a, pin.at_a), at(pin.b, pin.at_b)];
        all.push(format!("<pin a=\"{a}\" at_a=\"{at_a}\" b=\"{b}\" at_b=\"{at_b}\"/>"));
    }
    all
}

/// Returns the limits of a relative angle as limits of a motor's joint, rad. `None` if there are no limits, or no motor
/// turns this angle.
fn limited(machine: &Machine, angle: &RelativeAngle) -> Option<(usize, [f64; 2])> {
    let motors = machine.motors();
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

/// Returns type and limits of a joint that turns by `times` times the angle of motor k.
fn limits(machine: &Machine, k: usize, times: f64) -> (&'static str, String) {
    let drive = &machine.spec().drives[k];
    let ranges = machine.angles().iter().filter_map(|angle| limited(machine, angle));
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
