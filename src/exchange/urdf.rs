//! A machine as URDF, the format of ROS and Pinocchio: a tree of links and joints, all about the z axis of `base`.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q_k | absolute angle of drive k | rad |
//! | θ_k | angle of joint `drive_k`: that of motor k, q_k − q_on, or q_k for a motor on the base | rad |
//! | N | gear ratio of a rotor: it turns by N θ_k in its stator | |
//!
//! The joints `drive_k` are the only ones that move by themselves. The frame of a link sits at its root with x along
//! e(q_k), so a link that runs against its drive lies along −x. A pin between links of two drives turns by a sum of
//! motor angles; a joint of URDF can follow only one other, so a sum is several joints in series, with links of no
//! account between them. Projected on the drives, mass matrix and gravity are those of the machine.
//!
//! # What URDF cannot say
//! Pins that close loops (the joints in series hold them closed all the same), gravity, limits of an angle between
//! drives whose motors do not turn by it, and limits of acceleration and jerk: these stand as remarks in the file.
//! Friction, springs and the base's own motion belong to a scenario. Inertias about axes that a plane motion does not
//! ask are made up.

use super::look::{COLOURS, RADIUS};
use super::xml::{Lines, quoted, remark};
use crate::mechanics::machine::{Machine, Payload, RelativeAngle};

/// What counts for nothing beside the machine, as a share of its mass: some programs take a link without mass for one
/// of 1 kg.
const NOTHING: f64 = 1e-13;
/// What a joint has to have and the machine does not limit: torque in N m and rate in rad/s.
const UNLIMITED: f64 = 1e9;
/// The model of a machine as text.
pub fn urdf(machine: &Machine) -> String {
    Model::of(machine).text()
}

/// The joint that turns by the angle of motor k.
pub fn joint(machine: &Machine, k: usize) -> String {
    format!("drive_{}", machine.spec().drives[k].name)
}

/// A part of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Base,
    Link(usize),
    /// What motor k turns where no link is pinned to what carries the motor.
    Shaft(usize),
}

/// Where a joint sits: on a part, so far along its x axis, m.
#[derive(Clone, Copy, Debug)]
struct Seat {
    on: Part,
    at: f64,
}

struct Model<'a> {
    machine: &'a Machine,
    /// What the joint of each motor turns.
    turned: Vec<Part>,
    /// Of a body of no account, kg and kg m².
    least: f64,
    lines: Lines,
}

/// A rigid body in the frame of its link.
struct Body {
    /// Centre of mass, m.
    at: [f64; 3],
    /// kg.
    mass: f64,
    /// About its centre of mass, around z, kg m².
    inertia: f64,
}

impl<'a> Model<'a> {
    fn of(machine: &'a Machine) -> Self {
        let parts = machine.resolved_links();
        let turned = |k: usize| {
            let on = machine.motors().on(k);
            let is_turned = |j: &usize| parts[*j].drive == k && parts[*j].parent.map(|p| parts[p].drive) == on;
            (0..parts.len()).find(is_turned).map_or(Part::Shaft(k), Part::Link)
        };
        let turned = (0..machine.drives()).map(turned).collect();
        Self { machine, turned, least: NOTHING * machine.mass(), lines: Lines::default() }
    }

    fn text(mut self) -> String {
        let name = quoted(&self.machine.spec().name);
        self.lines.add(0, format_args!("<?xml version=\"1.0\"?>"));
        self.lines.add(0, format_args!("<robot name=\"{name}\">"));
        self.remarks();
        for (k, colour) in COLOURS.iter().enumerate().take(self.machine.drives()) {
            let drive = quoted(&self.machine.spec().drives[k].name);
            self.lines.add(1, format_args!("<material name=\"drive_{drive}\"><color rgba=\"{colour}\"/></material>"));
        }
        self.lines.add(1, format_args!("<link name=\"base\"/>"));
        for k in 0..self.machine.drives() {
            self.shaft(k);
            self.rotor(k);
        }
        for j in 0..self.machine.links().len() {
            self.link(j);
        }
        self.end_effector();
        self.lines.add(0, format_args!("</robot>"));
        self.lines.into_text()
    }

    fn name(&self, part: Part) -> String {
        match part {
            Part::Base => "base".into(),
            Part::Link(j) => format!("link_{}", quoted(&self.machine.links()[j].name)),
            Part::Shaft(k) => format!("shaft_{}", quoted(&self.machine.spec().drives[k].name)),
        }
    }

    /// The drive that a part follows; none: the base.
    fn drive(&self, part: Part) -> Option<usize> {
        match part {
            Part::Base => None,
            Part::Link(j) => Some(self.machine.resolved_links()[j].drive),
            Part::Shaft(k) => Some(k),
        }
    }

    /// What carries the motor of a drive.
    fn seat(&self, k: usize) -> Seat {
        if let Part::Link(j) = self.turned[k] {
            return self.root(j);
        }
        let on = match self.machine.motors().on(k) {
            None => Part::Base,
            Some(on) => {
                let first = self.machine.resolved_links().iter().position(|part| part.drive == on);
                first.map_or(Part::Shaft(on), Part::Link)
            }
        };
        Seat { on, at: 0.0 }
    }

    /// Where the root of a link is pinned.
    fn root(&self, j: usize) -> Seat {
        let parts = self.machine.resolved_links();
        match parts[j].parent {
            None => Seat { on: Part::Base, at: 0.0 },
            Some(parent) => Seat { on: Part::Link(parent), at: parts[parent].sign * parts[j].at },
        }
    }

    /// q_to − q_from as a sum of motor angles, each with 1 or −1, in an order in which none is far from the next.
    fn turns(&self, from: Option<usize>, to: Option<usize>) -> Vec<(usize, f64)> {
        let motors = self.machine.motors();
        let carriers = |k: Option<usize>| std::iter::successors(k, |k| motors.on(*k)).collect::<Vec<_>>();
        let (up, down) = (carriers(from), carriers(to));
        let shared = down.iter().rev().zip(up.iter().rev()).take_while(|(a, b)| a == b).count();
        let back = up[..up.len() - shared].iter().map(|k| (*k, -1.0));
        back.chain(down[..down.len() - shared].iter().rev().map(|k| (*k, 1.0))).collect()
    }

    fn remarks(&mut self) {
        let machine = self.machine;
        let spec = machine.spec();
        self.remark("Axes of all joints are parallel to z of base. Only the joints drive_… move by themselves.");
        self.remark("Links pin_… have no mass to speak of: they add up angles, for a joint can follow only one other.");
        if spec.gravity != [0.0; 2] {
            let [x, y] = spec.gravity;
            self.remark(&format!("Gravity in m/s² along x and y of base, which URDF has no word for: {x}, {y}"));
        }
        for pin in machine.loops() {
            let (a, b) = (&machine.links()[pin.a].name, &machine.links()[pin.b].name);
            let at = |j: usize, at: f64| machine.resolved_links()[j].sign * at;
            let [at_a, at_b] = [at(pin.a, pin.at_a), at(pin.b, pin.at_b)];
            self.remark(&format!(
                "A pin that closes a loop, left out: x = {at_a} m of link_{a} is x = {at_b} m of link_{b}"
            ));
        }
        for angle in machine.angles() {
            let (least, most) = (angle.limits.start(), angle.limits.end());
            let (to, from) = (&spec.drives[angle.to].name, &spec.drives[angle.from].name);
            if self.limited(angle).is_none() && least.is_finite() && most.is_finite() {
                self.remark(&format!(
                    "A limit that no joint has: {least} to {most} rad for {} = q_{to} less q_{from} plus {}",
                    angle.name, angle.offset
                ));
            }
        }
        for drive in &spec.drives {
            for (limit, what) in [(drive.acceleration_limit, "rad/s²"), (drive.jerk_limit, "rad/s³")] {
                if let Some(most) = limit {
                    self.remark(&format!("drive_{} is asked for at most {most} {what}", drive.name));
                }
            }
        }
    }

    fn remark(&mut self, text: &str) {
        self.lines.add(1, format_args!("<!-- {} -->", remark(text)));
    }

    /// Limits of a relative angle as those of the joint of a motor, rad.
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

    /// The joint that a motor turns.
    fn driven(&mut self, k: usize, seat: Seat, child: &str) {
        let drive = &self.machine.spec().drives[k];
        let (name, parent) = (quoted(&drive.name), self.name(seat.on));
        let ranges = self.machine.angles().iter().filter_map(|angle| self.limited(angle));
        // Two limits of one joint hold both.
        let range = ranges.filter(|(of, _)| *of == k).map(|(_, range)| range).reduce(|a, b| {
            let least = a[0].max(b[0]);
            [least, a[1].min(b[1]).max(least)]
        });
        let kind = if range.is_some() { "revolute" } else { "continuous" };
        self.lines.add(1, format_args!("<joint name=\"drive_{name}\" type=\"{kind}\">"));
        self.frame(&parent, child, seat.at);
        let (effort, velocity) = (drive.torque_limit.unwrap_or(UNLIMITED), drive.speed_limit.unwrap_or(UNLIMITED));
        let range = range.map_or(String::new(), |[least, most]| format!(" lower=\"{least}\" upper=\"{most}\""));
        self.lines.add(2, format_args!("<limit{range} effort=\"{effort}\" velocity=\"{velocity}\"/>"));
        self.lines.add(1, format_args!("</joint>"));
    }

    /// A joint that turns by a multiple of the angle of a motor.
    fn follower(&mut self, k: usize, multiplier: f64, parent: &str, child: &str, at: f64) {
        let drive = quoted(&self.machine.spec().drives[k].name);
        self.lines.add(1, format_args!("<joint name=\"joint_{child}\" type=\"continuous\">"));
        self.frame(parent, child, at);
        self.lines.add(2, format_args!("<mimic joint=\"drive_{drive}\" multiplier=\"{multiplier}\" offset=\"0\"/>"));
        self.lines.add(1, format_args!("</joint>"));
    }

    fn frame(&mut self, parent: &str, child: &str, at: f64) {
        self.lines.add(2, format_args!("<parent link=\"{parent}\"/>"));
        self.lines.add(2, format_args!("<child link=\"{child}\"/>"));
        self.lines.add(2, format_args!("<origin xyz=\"{at} 0 0\"/>"));
        self.lines.add(2, format_args!("<axis xyz=\"0 0 1\"/>"));
    }

    fn fixed(&mut self, parent: &str, child: &str, at: f64) {
        self.lines.add(1, format_args!("<joint name=\"joint_{child}\" type=\"fixed\">"));
        self.lines.add(2, format_args!("<parent link=\"{parent}\"/>"));
        self.lines.add(2, format_args!("<child link=\"{child}\"/>"));
        self.lines.add(2, format_args!("<origin xyz=\"{at} 0 0\"/>"));
        self.lines.add(1, format_args!("</joint>"));
    }

    fn inertial(&mut self, body: &Body) {
        let Body { at: [x, y, z], mass, inertia } = body;
        // Of a thin bar; a plane motion asks for the last one only.
        let other = 0.6 * inertia;
        self.lines.add(2, format_args!("<inertial>"));
        self.lines.add(3, format_args!("<origin xyz=\"{x} {y} {z}\"/>"));
        self.lines.add(3, format_args!("<mass value=\"{mass}\"/>"));
        let rest = format!("ixy=\"0\" ixz=\"0\" iyy=\"{other}\" iyz=\"0\" izz=\"{inertia}\"");
        self.lines.add(3, format_args!("<inertia ixx=\"{other}\" {rest}/>"));
        self.lines.add(2, format_args!("</inertial>"));
    }

    /// A link without shape.
    fn bare(&mut self, name: &str, body: &Body) {
        self.lines.add(1, format_args!("<link name=\"{name}\">"));
        self.inertial(body);
        self.lines.add(1, format_args!("</link>"));
    }

    /// A body of no account.
    fn nothing(&self) -> Body {
        Body { at: [0.0; 3], mass: self.least, inertia: self.least }
    }

    fn shaft(&mut self, k: usize) {
        if self.turned[k] != Part::Shaft(k) {
            return;
        }
        let (name, seat) = (self.name(Part::Shaft(k)), self.seat(k));
        self.bare(&name, &self.nothing());
        self.driven(k, seat, &name);
    }

    fn rotor(&mut self, k: usize) {
        let drive = &self.machine.spec().drives[k];
        let Some(rotor) = drive.rotor else { return };
        let (name, seat) = (format!("rotor_{}", quoted(&drive.name)), self.seat(k));
        // Its mass belongs to what carries it.
        self.bare(&name, &Body { inertia: rotor.inertia, ..self.nothing() });
        let parent = self.name(seat.on);
        self.follower(k, rotor.ratio, &parent, &name, seat.at);
    }

    fn link(&mut self, j: usize) {
        let machine = self.machine;
        let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
        let name = self.name(Part::Link(j));
        self.lines.add(1, format_args!("<link name=\"{name}\">"));
        let at = [part.sign * link.com, part.sign * link.com_normal, link.axial];
        self.inertial(&Body { at, mass: link.mass, inertia: link.inertia });
        self.shape(j);
        self.lines.add(1, format_args!("</link>"));
        self.pin(j, &name);
    }

    /// What is seen of a link: a bar over all its pins, and its counterweights.
    fn shape(&mut self, j: usize) {
        let machine = self.machine;
        let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
        let ends = part.pins.iter().fold([0.0_f64, part.length], |[least, most], at| [least.min(*at), most.max(*at)]);
        let (middle, length) = (part.sign * 0.5 * (ends[0] + ends[1]), ends[1] - ends[0] + 2.0 * RADIUS);
        let bar = format!("<box size=\"{length} {} {}\"/>", 2.0 * RADIUS, 0.5 * RADIUS);
        self.visual(part.drive, middle, &bar);
        for weight in machine.spec().counterweights.iter().filter(|weight| weight.link == link.name) {
            let disc = format!("<cylinder radius=\"{}\" length=\"{RADIUS}\"/>", weight.radius.max(RADIUS));
            self.visual(part.drive, part.sign * weight.at, &disc);
        }
    }

    fn visual(&mut self, drive: usize, at: f64, geometry: &str) {
        let drive = quoted(&self.machine.spec().drives[drive].name);
        self.lines.add(2, format_args!("<visual>"));
        self.lines.add(3, format_args!("<origin xyz=\"{at} 0 0\"/>"));
        self.lines.add(3, format_args!("<geometry>{geometry}</geometry>"));
        self.lines.add(3, format_args!("<material name=\"drive_{drive}\"/>"));
        self.lines.add(2, format_args!("</visual>"));
    }

    /// What joins a link to what its root is pinned to.
    fn pin(&mut self, j: usize, name: &str) {
        let (seat, own) = (self.root(j), Part::Link(j));
        let turns = self.turns(self.drive(seat.on), self.drive(own));
        let Some(((last, sign), first)) = turns.split_last() else {
            return self.fixed(&self.name(seat.on), name, seat.at);
        };
        if self.turned[*last] == own {
            return self.driven(*last, seat, name);
        }
        let (mut parent, mut at) = (self.name(seat.on), seat.at);
        for (number, (k, sign)) in first.iter().enumerate() {
            let between = format!("pin_{}_of_{name}", number + 1);
            self.bare(&between, &self.nothing());
            self.follower(*k, *sign, &parent, &between, at);
            (parent, at) = (between, 0.0);
        }
        self.follower(*last, *sign, &parent, name, at);
    }

    /// The point that works, and what it holds.
    fn end_effector(&mut self) {
        let machine = self.machine;
        let (j, payload) = (machine.end_link(), machine.spec().payload);
        let part = &machine.resolved_links()[j];
        let at = machine.end_effector()[part.drive] - part.root[part.drive];
        self.bare("end_effector", &self.nothing());
        self.fixed(&self.name(Part::Link(j)), "end_effector", at);
        if payload.mass > 0.0 || payload.inertia > 0.0 {
            let [along, left] = payload.offset.map(|x| part.sign * x);
            self.bare("payload", &Body { at: [along, left, payload.axial], ..Body::from(payload) });
            self.fixed("end_effector", "payload", 0.0);
        }
    }
}

impl From<Payload> for Body {
    fn from(payload: Payload) -> Self {
        Self { at: [0.0; 3], mass: payload.mass, inertia: payload.inertia }
    }
}
