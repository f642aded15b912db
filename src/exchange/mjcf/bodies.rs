//! The bodies of a model: base, links, rotors, payloads and platforms, each in the one that carries it.

use nalgebra::Matrix3;

use super::Model;
use crate::cut::{Cut, DrawnSize, DrawnWeight};
use crate::look::{BASE_COLOUR, DRIVE_COLOURS};
use crate::placed::FloatingBase;
use crate::tree::TreePart;
use crate::xml::XmlWriter;

/// Mass, kg, of a body whose real mass belongs to others: rotors, which weigh with the links that carry them, and
/// platforms.
const NO_MASS_KG: f64 = 1e-11;
/// Inertia of a platform about its hinge, kg m².
const NO_INERTIA: f64 = 1e-11;

/// The joints of a base that floats in the plane, with their axes.
const BASE_JOINTS: [&str; 3] = [
    "name=\"base_x\" type=\"slide\" axis=\"1 0 0\"",
    "name=\"base_y\" type=\"slide\" axis=\"0 1 0\"",
    "name=\"base_turn\"",
];

/// Writes the bodies of a model.
pub(super) struct Bodies<'a> {
    pub(super) model: &'a Model<'a>,
    pub(super) cut: &'a Cut,
    pub(super) out: XmlWriter,
}

/// Writes a line.
macro_rules! line {
    ($self:expr, $depth:expr, $($text:tt)*) => { $self.out.add($depth, format_args!($($text)*)) };
}

impl Bodies<'_> {
    /// Writes the world with all that is in it; returns the text so far.
    pub(super) fn world(mut self) -> XmlWriter {
        line!(self, 1, "<worldbody>");
        line!(self, 2, "<light pos=\"0 0 3\" dir=\"0 0 -1\"/>");
        line!(self, 2, "<body name=\"base\">");
        match &self.model.of.base {
            None => self.on_base(3),
            Some(base) => {
                self.floating(3, base);
                line!(self, 3, "<body name=\"mount\">");
                self.on_base(4);
                line!(self, 3, "</body>");
            }
        }
        line!(self, 2, "</body>");
        line!(self, 1, "</worldbody>");
        self.out
    }

    /// Writes all that the base carries.
    fn on_base(&mut self, depth: usize) {
        line!(self, depth, "<site name=\"base\" size=\"0.02\"/>");
        self.model.of.on_base().collect::<Vec<_>>().into_iter().for_each(|i| self.machine(depth, i));
    }

    /// Writes a machine, a block in a body of its own at its mount.
    fn machine(&mut self, depth: usize, i: usize) {
        let placed = &self.model.of.machines[i];
        let (tree, mount) = (&placed.tree, placed.mount());
        let depth = match mount {
            None => depth,
            Some(mount) => {
                let (at, axes) = self.model.of.seat(mount);
                let (name, at) = (tree.name(TreePart::Base), numbers(at.as_slice()));
                // The first two columns, one after the other.
                let axes = numbers(&axes.as_slice()[..6]);
                line!(self, depth, "<body name=\"{name}\" pos=\"{at}\" xyaxes=\"{axes}\">");
                depth + 1
            }
        };
        self.rotors(depth, i, None);
        for j in self.model.children(i, None) {
            self.body(depth, i, j);
        }
        if mount.is_some() {
            line!(self, depth - 1, "</body>");
        }
    }

    /// Writes joints, mass and shape of a base that floats.
    fn floating(&mut self, depth: usize, base: &FloatingBase<'_>) {
        match base {
            FloatingBase::Planar(base) => {
                for joint in BASE_JOINTS {
                    line!(self, depth, "<joint {joint}/>");
                }
                let (com, inertia) = (base.com, base.inertia);
                self.inertial(
                    depth,
                    [com.re, com.im, 0.0],
                    base.mass,
                    &diagonal([0.6 * inertia, 0.6 * inertia, inertia]),
                );
            }
            FloatingBase::Spatial(base) => {
                line!(self, depth, "<freejoint name=\"base_floats\"/>");
                self.full_inertial(depth, base.com.into(), base.mass, &base.inertia);
            }
        }
        let ([x, y, z], [a, b, c]) = base.drawn();
        line!(
            self,
            depth,
            "<geom type=\"box\" pos=\"{x} {y} {z}\" size=\"{} {} {}\" rgba=\"{BASE_COLOUR}\"/>",
            0.5 * a,
            0.5 * b,
            0.5 * c
        );
    }

    /// Writes a link with all links that it carries.
    fn body(&mut self, depth: usize, i: usize, j: usize) {
        let (placed, joins) = (&self.model.of.machines[i], &self.model.joins[i]);
        let machine = placed.machine;
        let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
        let (name, colour) = (placed.tree.name(TreePart::Link(j)), DRIVE_COLOURS[part.drive % DRIVE_COLOURS.len()]);
        let on = part.parent.map_or(1.0, |on| machine.resolved_links()[on].sign);
        line!(self, depth, "<body name=\"{name}\" pos=\"{} 0 0\">", on * part.at);
        let limits = joins.limited.iter().find(|(_, turn, _)| turn.pin() == Some(j));
        let range = limits.map_or(String::new(), |(.., [least, most])| format!(" range=\"{least} {most}\""));
        line!(self, depth + 1, "<joint name=\"{}\"{range}/>", self.model.hinge(i, j));
        let (com, normal, axial) = (part.sign * link.com, part.sign * link.com_normal, link.axial);
        self.inertial(depth + 1, [com, normal, axial], link.mass, &placed.of_link(j));
        let (from, to) = reach(part.length, &part.pins);
        if to > from {
            let (from, to) = (part.sign * from, part.sign * to);
            line!(self, depth + 1, "<geom fromto=\"{from} 0 0 {to} 0 0\" rgba=\"{colour}\"/>");
        }
        for weight in machine.spec().counterweights.iter().filter(|weight| weight.link == link.name) {
            let DrawnWeight { at, height, size } = self.cut.drawn_weight(weight);
            let [x, y] = at.map(|x| part.sign * x);
            // MuJoCo wants half of each size but the radius.
            let (kind, size) = match size {
                DrawnSize::Disc(radius) => ("cylinder", format!("{radius} {}", 0.5 * height)),
                DrawnSize::Box([length, width]) => {
                    ("box", format!("{} {} {}", 0.5 * length, 0.5 * width, 0.5 * height))
                }
            };
            line!(self, depth + 1, "<geom type=\"{kind}\" pos=\"{x} {y} 0\" size=\"{size}\" rgba=\"{colour}\"/>");
        }
        for (number, pinned) in machine.loops().iter().enumerate() {
            for (side, of, at) in [("a", pinned.a, pinned.at_a), ("b", pinned.b, pinned.at_b)] {
                if of == j {
                    let at = part.sign * at;
                    let name = placed.tree.own(format_args!("loop {} {side}", number + 1));
                    line!(self, depth + 1, "<site name=\"{name}\" pos=\"{at} 0 0\"/>");
                }
            }
        }
        if machine.end_link() == j {
            self.end_effector(depth + 1, i);
        }
        self.rotors(depth + 1, i, Some(j));
        for child in self.model.children(i, Some(j)) {
            self.body(depth + 1, i, child);
        }
        if machine.end_link() == j && !placed.carries.is_empty() {
            self.platform(depth + 1, i);
        }
        line!(self, depth, "</body>");
    }

    /// Writes the mass properties of a body, with its inertia as three numbers if its axes are principal.
    fn inertial(&mut self, depth: usize, at: [f64; 3], mass: f64, inertia: &Matrix3<f64>) {
        let diagonal = inertia.diagonal();
        if *inertia != Matrix3::from_diagonal(&diagonal) {
            return self.full_inertial(depth, at, mass, inertia);
        }
        let ([x, y, z], [xx, yy, zz]) = (at, diagonal.into());
        line!(self, depth, "<inertial pos=\"{x} {y} {z}\" mass=\"{mass}\" diaginertia=\"{xx} {yy} {zz}\"/>");
    }

    fn full_inertial(&mut self, depth: usize, at: [f64; 3], mass: f64, all: &Matrix3<f64>) {
        let order = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        let (at, inertia) = (numbers(&at), numbers(&order.map(|place| all[place])));
        line!(self, depth, "<inertial pos=\"{at}\" mass=\"{mass}\" fullinertia=\"{inertia}\"/>");
    }

    /// Writes the end effector, and the payload that it holds.
    fn end_effector(&mut self, depth: usize, i: usize) {
        let placed = &self.model.of.machines[i];
        let ([at, height], payload) = (placed.end(), placed.machine.spec().payload);
        line!(self, depth, "<site name=\"{}\" pos=\"{at} 0 {height}\"/>", placed.tree.name(TreePart::End));
        if payload.mass > 0.0 || payload.inertia > 0.0 {
            let sign = placed.machine.resolved_links()[placed.machine.end_link()].sign;
            let [along, left] = payload.offset.map(|x| sign * x);
            line!(self, depth, "<body name=\"{}\" pos=\"{at} 0 0\">", placed.tree.name(TreePart::Payload));
            self.inertial(depth + 1, [along, left, payload.axial], payload.mass, &placed.of_payload());
            line!(self, depth, "</body>");
        }
    }

    /// Writes what moves with the end effector and keeps its orientation, and all blocks on it.
    fn platform(&mut self, depth: usize, i: usize) {
        let placed = &self.model.of.machines[i];
        let [at, height] = placed.end();
        let (name, hinge) = (placed.tree.name(TreePart::Platform), placed.tree.holder(TreePart::Platform));
        line!(self, depth, "<body name=\"{name}\" pos=\"{at} 0 {height}\">");
        line!(self, depth + 1, "<joint name=\"{hinge}\"/>");
        self.inertial(depth + 1, [0.0; 3], NO_MASS_KG, &diagonal([NO_INERTIA; 3]));
        placed.carries.iter().for_each(|carried| self.machine(depth + 1, *carried));
        line!(self, depth, "</body>");
    }

    /// Writes the rotors of the motors that a link carries; `None` for the base.
    fn rotors(&mut self, depth: usize, i: usize, on: Option<usize>) {
        let placed = &self.model.of.machines[i];
        let parts = placed.machine.resolved_links();
        let sign = on.map_or(1.0, |on| parts[on].sign);
        for k in self.model.rotors_on(i, on) {
            let inertia = placed.machine.spec().drives[k].rotor.map_or(0.0, |rotor| rotor.inertia);
            let at = self.model.joins[i].motors[k].pin().map_or(0.0, |j| sign * parts[j].at);
            let (name, hinge) = (placed.tree.name(TreePart::Rotor(k)), self.model.rotor_hinge(i, k));
            line!(self, depth, "<body name=\"{name}\" pos=\"{at} 0 0\">");
            line!(self, depth + 1, "<joint name=\"{hinge}\"/>");
            self.inertial(depth + 1, [0.0; 3], NO_MASS_KG, &diagonal(placed.of_rotor(inertia)));
            line!(self, depth, "</body>");
        }
    }
}

fn diagonal(moments: [f64; 3]) -> Matrix3<f64> {
    Matrix3::from_diagonal(&moments.into())
}

fn numbers(all: &[f64]) -> String {
    all.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
}

/// Returns the interval that a bar covers along its axis, m: its length and all its pins.
fn reach(length: f64, pins: &[f64]) -> (f64, f64) {
    pins.iter().fold((0.0_f64.min(length), 0.0_f64.max(length)), |(least, most), at| (least.min(*at), most.max(*at)))
}
