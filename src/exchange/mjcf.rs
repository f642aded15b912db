//! A machine as MJCF, the format of MuJoCo. Links are bodies in the plane z = 0, pins are hinges, and pins that close
//! loops are equalities. The model has motors with gears and rotors. Sensors at the base measure the force and moment
//! of the base on the machine; f_B and n_B have the opposite sign. The frame of a link has x along e(q_k) of its drive,
//! so a link that runs against its drive lies along −x. Bodies and hinges have the same names as in URDF.
//!
//! A base that floats is a body with two slides and a hinge, at the base pin; the body `mount` on it carries the machine,
//! so that the sensors read what acts between the two, along the axes of the base.
//!
//! Every rotor is a separate body. Behind a gear, it adds different amounts to the momentum (D) and to the inertia (H),
//! whereas an armature would add to the inertia only. Inertias about axes in the plane do not affect a plane motion;
//! their values are made up.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use super::base_body::BaseBody;
use super::cut::{Cut, DrawnSize, DrawnWeight};
use super::look::{BASE_COLOUR, DRAWN_BAR_RADIUS, DRIVE_COLOURS};
use super::tree::{Tree, TreePart};
use super::turn::PinAngleSum;
use super::xml::quoted;
use stillbase_mechanics::machine::Machine;

/// Error of an export to MJCF.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MjcfError {
    /// A link without mass or inertia, which MuJoCo cannot simulate.
    #[error("link {link:?} has {what} 0: MuJoCo moves only what has mass and inertia; want both above 1e-12")]
    Massless {
        /// The link.
        link: String,
        /// The quantity that is zero: mass or inertia.
        what: &'static str,
    },
    /// A pose whose number of angles is not that of the drives.
    #[error("a pose of {given} angles: want {wanted}, one for each drive")]
    Pose {
        /// Number of angles that were given.
        given: usize,
        /// Number of drives.
        wanted: usize,
    },
    /// No link follows a drive.
    #[error("no link has the orientation of drive {drive:?}: MuJoCo has nothing to turn; want a link of it")]
    Idle {
        /// The drive.
        drive: String,
    },
}

/// MuJoCo treats masses, kg, and inertias, kg m², below this as zero.
pub(super) const MIN_MASS_OR_INERTIA: f64 = 1e-12;
/// Mass of a rotor's body, kg: the rotor's real mass belongs to the link that carries it.
const ROTOR_MASS_KG: f64 = 1e-11;

/// The joints of a base that floats, with their axes.
const BASE_JOINTS: [&str; 3] = [
    "name=\"base_x\" type=\"slide\" axis=\"1 0 0\"",
    "name=\"base_y\" type=\"slide\" axis=\"0 1 0\"",
    "name=\"base_turn\"",
];

/// Returns the model of a machine as text; its keyframe `start` is the pose `q`, rad, with motors at rest. The machine
/// stands on the world, or on a base that floats if there is one. `cut` gives the thickness of counterweights, which is
/// for the eye: mass and inertia are those of the machine.
///
/// # Errors
/// If MuJoCo cannot simulate the machine, or if the pose does not have one angle for each drive.
pub fn mjcf(machine: &Machine, base: Option<&BaseBody>, q: &[f64], cut: &Cut) -> Result<String, MjcfError> {
    let model = Model::of(machine, base, q)?;
    let massless = |link: &str, what| MjcfError::Massless { link: link.into(), what };
    for link in machine.links() {
        if link.mass < MIN_MASS_OR_INERTIA {
            return Err(massless(&link.name, "mass"));
        }
        if link.inertia < MIN_MASS_OR_INERTIA {
            return Err(massless(&link.name, "inertia"));
        }
    }
    Ok(model.text(q, cut))
}

/// Returns the angles of all hinges of the machine in a pose, rad, in the order of `qpos`: links and rotors, depth first.
/// The joints of a base that floats come before them.
///
/// # Errors
/// If the pose does not have one angle for each drive, or if no link follows a drive.
pub fn hinges(machine: &Machine, q: &[f64]) -> Result<Vec<f64>, MjcfError> {
    Ok(Model::of(machine, None, q)?.qpos(q))
}

/// Returns `qpos` of the model in a pose, m and rad: the joints of a base that floats, at 0, then all hinges.
///
/// # Errors
/// As [`hinges`].
pub fn qpos(machine: &Machine, base: Option<&BaseBody>, q: &[f64]) -> Result<Vec<f64>, MjcfError> {
    Ok(Model::of(machine, base, q)?.qpos(q))
}

struct Model<'a> {
    machine: &'a Machine,
    /// The base, if it floats.
    base: Option<&'a BaseBody>,
    /// Names of bodies and hinges.
    tree: Tree<'a>,
    /// The angle of each motor.
    motors: Vec<PinAngleSum>,
    /// Relative angles with limits: name, sum of pin angles, and limits, rad.
    limited: Vec<(String, PinAngleSum, [f64; 2])>,
    /// Links that need an equality to stay parallel to the first link of their drive, with the angle between the two.
    parallel: Vec<(usize, PinAngleSum)>,
    out: String,
}

/// Writes a line; writing to a `String` never fails.
macro_rules! line {
    ($model:expr, $depth:expr, $($text:tt)*) => {{
        let _ = write!($model.out, "{:1$}", "", 2 * $depth);
        let _ = writeln!($model.out, $($text)*);
    }};
}

impl<'a> Model<'a> {
    fn of(machine: &'a Machine, base: Option<&'a BaseBody>, q: &[f64]) -> Result<Self, MjcfError> {
        if q.len() != machine.drives() {
            return Err(MjcfError::Pose { given: q.len(), wanted: machine.drives() });
        }
        let motor = |k: usize| {
            let idle = || MjcfError::Idle { drive: machine.spec().drives[k].name.clone() };
            PinAngleSum::of_drives(machine, machine.motors().on(k), k).ok_or_else(idle)
        };
        let motors = (0..machine.drives()).map(motor).collect::<Result<_, _>>()?;
        Ok(Self {
            machine,
            base,
            tree: Tree::of(machine),
            motors,
            limited: limited(machine),
            parallel: parallel(machine),
            out: String::new(),
        })
    }

    fn text(mut self, q: &[f64], cut: &Cut) -> String {
        let spec = self.machine.spec();
        let [gx, gy] = spec.gravity;
        line!(self, 0, "<mujoco model=\"{}\">", quoted(&spec.name));
        line!(self, 1, "<compiler angle=\"radian\" autolimits=\"true\" inertiafromgeom=\"false\"/>");
        line!(self, 1, "<option gravity=\"{gx} {gy} 0\" timestep=\"0.0005\" integrator=\"implicitfast\"/>");
        line!(self, 1, "<default>");
        line!(
            self,
            2,
            "<geom type=\"capsule\" size=\"{DRAWN_BAR_RADIUS}\" contype=\"0\" conaffinity=\"0\" mass=\"0\"/>"
        );
        line!(self, 2, "<joint type=\"hinge\" axis=\"0 0 1\"/>");
        line!(self, 2, "<equality solref=\"0.002 1\" solimp=\"0.99 0.9999 0.001\"/>");
        line!(self, 1, "</default>");
        line!(self, 1, "<worldbody>");
        line!(self, 2, "<light pos=\"0 0 3\" dir=\"0 0 -1\"/>");
        line!(self, 2, "<body name=\"base\">");
        match self.base {
            None => self.machine(3, cut),
            Some(base) => {
                self.floating(3, base);
                line!(self, 3, "<body name=\"mount\">");
                self.machine(4, cut);
                line!(self, 3, "</body>");
            }
        }
        line!(self, 2, "</body>");
        line!(self, 1, "</worldbody>");
        self.tendons();
        self.equalities();
        self.actuators();
        line!(self, 1, "<sensor>");
        line!(self, 2, "<force name=\"base force\" site=\"base\"/>");
        line!(self, 2, "<torque name=\"base moment\" site=\"base\"/>");
        line!(self, 2, "<framepos name=\"end effector\" objtype=\"site\" objname=\"end_effector\"/>");
        line!(self, 1, "</sensor>");
        line!(self, 1, "<keyframe>");
        let pose = self.qpos(q).iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        line!(self, 2, "<key name=\"start\" qpos=\"{pose}\"/>");
        line!(self, 1, "</keyframe>");
        line!(self, 0, "</mujoco>");
        self.out
    }

    /// Writes all that the base carries.
    fn machine(&mut self, depth: usize, cut: &Cut) {
        line!(self, depth, "<site name=\"base\" size=\"0.02\"/>");
        self.rotors(depth, None);
        for j in self.children(None) {
            self.body(depth, j, cut);
        }
    }

    /// Writes joints, mass and shape of a base that floats.
    fn floating(&mut self, depth: usize, base: &BaseBody) {
        for joint in BASE_JOINTS {
            line!(self, depth, "<joint {joint}/>");
        }
        let (com, half) = (base.com, 0.5 * base.drawn_side());
        self.inertial(depth, [com.re, com.im, 0.0], base.mass, base.inertia);
        let (x, y, thin) = (com.re, com.im, 0.5 * DRAWN_BAR_RADIUS);
        line!(
            self,
            depth,
            "<geom type=\"box\" pos=\"{x} {y} 0\" size=\"{half} {half} {thin}\" rgba=\"{BASE_COLOUR}\"/>"
        );
    }

    fn children(&self, parent: Option<usize>) -> Vec<usize> {
        let parts = self.machine.resolved_links();
        (0..parts.len()).filter(|j| parts[*j].parent == parent).collect()
    }

    /// Writes a link with all links that it carries.
    fn body(&mut self, depth: usize, j: usize, cut: &Cut) {
        let (link, part) = (&self.machine.links()[j], &self.machine.resolved_links()[j]);
        let (name, colour) = (self.tree.name(TreePart::Link(j)), DRIVE_COLOURS[part.drive % DRIVE_COLOURS.len()]);
        let on = part.parent.map_or(1.0, |on| self.machine.resolved_links()[on].sign);
        line!(self, depth, "<body name=\"{name}\" pos=\"{} 0 0\">", on * part.at);
        let limits = self.limited.iter().find(|(_, turn, _)| turn.pin() == Some(j));
        let range = limits.map_or(String::new(), |(.., [least, most])| format!(" range=\"{least} {most}\""));
        line!(self, depth + 1, "<joint name=\"{}\"{range}/>", self.hinge(j));
        let (com, normal, axial) = (part.sign * link.com, part.sign * link.com_normal, link.axial);
        self.inertial(depth + 1, [com, normal, axial], link.mass, link.inertia);
        let (from, to) = reach(part.length, &part.pins);
        if to > from {
            let (from, to) = (part.sign * from, part.sign * to);
            line!(self, depth + 1, "<geom fromto=\"{from} 0 0 {to} 0 0\" rgba=\"{colour}\"/>");
        }
        for weight in self.machine.spec().counterweights.iter().filter(|weight| weight.link == link.name) {
            let DrawnWeight { at, height, size } = cut.drawn_weight(weight);
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
        for (number, pinned) in self.machine.loops().iter().enumerate() {
            for (side, of, at) in [("a", pinned.a, pinned.at_a), ("b", pinned.b, pinned.at_b)] {
                if of == j {
                    let at = part.sign * at;
                    line!(self, depth + 1, "<site name=\"loop {} {side}\" pos=\"{at} 0 0\"/>", number + 1);
                }
            }
        }
        if self.machine.end_link() == j {
            self.end_effector(depth + 1, j);
        }
        self.rotors(depth + 1, Some(j));
        for child in self.children(Some(j)) {
            self.body(depth + 1, child, cut);
        }
        line!(self, depth, "</body>");
    }

    fn inertial(&mut self, depth: usize, [x, y, z]: [f64; 3], mass: f64, inertia: f64) {
        // Any value of at least half the inertia is valid; a plane motion depends only on the inertia about z.
        let other = 0.6 * inertia;
        line!(self, depth, "<inertial pos=\"{x} {y} {z}\" mass=\"{mass}\" diaginertia=\"{other} {other} {inertia}\"/>");
    }

    /// Writes the end effector, and the payload that it holds.
    fn end_effector(&mut self, depth: usize, j: usize) {
        let part = &self.machine.resolved_links()[j];
        let at = self.machine.end_effector()[part.drive] - part.root[part.drive];
        line!(self, depth, "<site name=\"end_effector\" pos=\"{at} 0 0\"/>");
        let payload = self.machine.spec().payload;
        if payload.mass > 0.0 || payload.inertia > 0.0 {
            let [along, left] = payload.offset.map(|x| part.sign * x);
            line!(self, depth, "<body name=\"payload\" pos=\"{at} 0 0\">");
            self.inertial(depth + 1, [along, left, payload.axial], payload.mass, payload.inertia);
            line!(self, depth, "</body>");
        }
    }

    /// Returns the name of a link's hinge.
    fn hinge(&self, j: usize) -> String {
        self.tree.holder(TreePart::Link(j))
    }

    /// Returns the link that carries the motor of a drive; `None` for the base.
    fn carrier(&self, k: usize) -> Option<usize> {
        let parts = self.machine.resolved_links();
        let on = self.machine.motors().on(k)?;
        let pin = self.motors[k].pin().and_then(|j| parts[j].parent);
        pin.or_else(|| parts.iter().position(|part| part.drive == on))
    }

    /// Writes the rotors of the motors that a link carries; `None` for the base.
    fn rotors(&mut self, depth: usize, on: Option<usize>) {
        for k in 0..self.machine.drives() {
            let drive = &self.machine.spec().drives[k];
            let Some(rotor) = drive.rotor.filter(|_| self.has_rotor(k) && self.carrier(k) == on) else { continue };
            let parts = self.machine.resolved_links();
            let sign = on.map_or(1.0, |on| parts[on].sign);
            let at = self.motors[k].pin().map_or(0.0, |j| sign * parts[j].at);
            let (name, hinge) = (self.tree.name(TreePart::Rotor(k)), self.rotor_hinge(k));
            line!(self, depth, "<body name=\"{name}\" pos=\"{at} 0 0\">");
            line!(self, depth + 1, "<joint name=\"{hinge}\"/>");
            self.inertial(depth + 1, [0.0; 3], ROTOR_MASS_KG, rotor.inertia);
            line!(self, depth, "</body>");
        }
    }

    fn rotor_hinge(&self, k: usize) -> String {
        self.tree.holder(TreePart::Rotor(k))
    }

    /// Returns whether the rotor of a drive is a body of the model.
    fn has_rotor(&self, k: usize) -> bool {
        self.machine.spec().drives[k].rotor.is_some_and(|rotor| rotor.inertia >= MIN_MASS_OR_INERTIA)
    }

    /// Writes sums of hinge angles as fixed tendons.
    fn tendons(&mut self) {
        let drives = &self.machine.spec().drives;
        let mut all: Vec<(String, PinAngleSum)> = Vec::new();
        for (k, turn) in self.motors.iter().enumerate().filter(|(_, turn)| turn.pin().is_none()) {
            all.push((format!("drive_{}", quoted(&drives[k].name)), turn.clone()));
        }
        // A hinge can have only one range.
        let on_hinge = |i: usize| {
            let pin = self.limited[i].1.pin();
            pin.is_some() && self.limited[..i].iter().all(|(_, turn, _)| turn.pin() != pin)
        };
        let limited: Vec<_> = (0..self.limited.len()).filter(|i| !on_hinge(*i)).collect();
        let limited: Vec<_> = limited.into_iter().map(|i| self.limited[i].clone()).collect();
        let parallel = self.parallel.clone();
        if all.is_empty() && limited.is_empty() && parallel.is_empty() {
            return;
        }
        line!(self, 1, "<tendon>");
        for (name, turn) in all {
            self.tendon(&name, "", &turn);
        }
        for (k, drive) in drives.iter().enumerate() {
            if !self.has_rotor(k) || self.motors[k].pin().is_some() {
                continue;
            }
            let (name, hinge) = (quoted(&drive.name), self.rotor_hinge(k));
            line!(self, 2, "<fixed name=\"rotor_{name}\">");
            line!(self, 3, "<joint joint=\"{hinge}\" coef=\"1\"/>");
            line!(self, 2, "</fixed>");
        }
        for (name, turn, [least, most]) in limited {
            self.tendon(&name, &format!(" range=\"{least} {most}\""), &turn);
        }
        for (j, turn) in parallel {
            let name = format!("direction of link_{}", quoted(&self.machine.links()[j].name));
            self.tendon(&name, "", &turn);
        }
        line!(self, 1, "</tendon>");
    }

    fn tendon(&mut self, name: &str, more: &str, turn: &PinAngleSum) {
        line!(self, 2, "<fixed name=\"{name}\"{more}>");
        for (j, coefficient) in &turn.pins {
            let hinge = self.hinge(*j);
            line!(self, 3, "<joint joint=\"{hinge}\" coef=\"{coefficient}\"/>");
        }
        line!(self, 2, "</fixed>");
    }

    fn equalities(&mut self) {
        let drives = &self.machine.spec().drives;
        let (parallel, loops) = (self.parallel.clone(), self.machine.loops().len());
        let geared: Vec<usize> = (0..drives.len()).filter(|k| self.has_rotor(*k)).collect();
        if parallel.is_empty() && loops == 0 && geared.is_empty() {
            return;
        }
        line!(self, 1, "<equality>");
        // If each link is kept parallel, the loops stay closed without further equalities.
        if parallel.is_empty() {
            for number in 1..=loops {
                line!(self, 2, "<connect name=\"loop {number}\" site1=\"loop {number} a\" site2=\"loop {number} b\"/>");
            }
        }
        for (j, _) in parallel {
            let name = self.tree.name(TreePart::Link(j));
            line!(self, 2, "<tendon tendon1=\"direction of {name}\" polycoef=\"0 0 0 0 0\"/>");
        }
        for k in geared {
            let (name, ratio) = (quoted(&drives[k].name), drives[k].rotor.map_or(1.0, |rotor| rotor.ratio));
            let pair = match self.motors[k].pin() {
                Some(j) => {
                    let (rotor, hinge) = (self.rotor_hinge(k), self.hinge(j));
                    format!("<joint name=\"gear_{name}\" joint1=\"{rotor}\" joint2=\"{hinge}\"")
                }
                None => format!("<tendon name=\"gear_{name}\" tendon1=\"rotor_{name}\" tendon2=\"drive_{name}\""),
            };
            line!(self, 2, "{pair} polycoef=\"0 {ratio} 0 0 0\"/>");
        }
        line!(self, 1, "</equality>");
    }

    fn actuators(&mut self) {
        line!(self, 1, "<actuator>");
        for (k, drive) in self.machine.spec().drives.iter().enumerate() {
            let name = quoted(&drive.name);
            let on = match self.motors[k].pin() {
                Some(j) => format!("joint=\"{}\"", self.hinge(j)),
                None => format!("tendon=\"drive_{name}\""),
            };
            let range = drive.torque_limit.map_or(String::new(), |most| format!(" ctrlrange=\"{} {most}\"", -most));
            line!(self, 2, "<motor name=\"drive_{name}\" {on}{range}/>");
        }
        line!(self, 1, "</actuator>");
    }

    /// Returns the numbers of all joints, those of the base first and at 0, the angles of hinges in rad in the order of
    /// the bodies.
    fn qpos(&self, q: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; if self.base.is_some() { BASE_JOINTS.len() } else { 0 }];
        self.pose_of(None, q, &mut all);
        all
    }

    fn direction(&self, j: Option<usize>, q: &[f64]) -> f64 {
        j.map_or(0.0, |j| q[self.machine.resolved_links()[j].drive])
    }

    fn pose_of(&self, parent: Option<usize>, q: &[f64], all: &mut Vec<f64>) {
        let spec = self.machine.spec();
        for k in (0..self.machine.drives()).filter(|k| self.has_rotor(*k) && self.carrier(*k) == parent) {
            let on = self.machine.motors().on(k).map_or(0.0, |on| q[on]);
            let ratio = spec.drives[k].rotor.map_or(1.0, |rotor| rotor.ratio);
            all.push(ratio * (q[k] - on));
        }
        for j in self.children(parent) {
            all.push(self.direction(Some(j), q) - self.direction(parent, q));
            self.pose_of(Some(j), q, all);
        }
    }
}

/// Returns the relative angles with limits: name, sum of pin angles, and limits, rad.
fn limited(machine: &Machine) -> Vec<(String, PinAngleSum, [f64; 2])> {
    let angles = machine.angles().iter().filter(|a| a.limits.start().is_finite() && a.limits.end().is_finite());
    angles
        .filter_map(|a| {
            let turn = PinAngleSum::of_drives(machine, Some(a.from), a.to)?;
            Some((format!("angle_{}", quoted(&a.name)), turn, [a.limits.start() - a.offset, a.limits.end() - a.offset]))
        })
        .collect()
}

/// Returns the links that need an equality to stay parallel to the first link of their drive, with the angle between
/// the two. Empty if the loops keep all links parallel.
pub(super) fn parallel(machine: &Machine) -> Vec<(usize, PinAngleSum)> {
    let parts = machine.resolved_links();
    if parts.len() == machine.drives() + 2 * machine.loops().len() {
        return Vec::new();
    }
    let first = |k: usize| parts.iter().position(|part| part.drive == k);
    let of = |j: usize| {
        let first = first(parts[j].drive).filter(|first| *first != j)?;
        Some((j, PinAngleSum::between(machine, Some(first), j)))
    };
    (0..parts.len()).filter_map(of).collect()
}

/// Returns the drive angles, rad, in which a machine is shown if nobody says otherwise: those of its drawing, or else those
/// in the middle of its limits.
pub fn usual_pose(machine: &Machine) -> Vec<f64> {
    let drawn = machine.spec().pose.as_ref().filter(|pose| pose.len() == machine.drives());
    drawn.cloned().unwrap_or_else(|| middle(machine))
}

/// Returns drive angles, rad, with each relative angle in the middle of its limits, or at 0 without limits. A drive
/// that no relative angle determines points along y.
pub fn middle(machine: &Machine) -> Vec<f64> {
    let mut q = vec![TAU / 4.0; machine.drives()];
    for angle in machine.angles() {
        let (least, most) = (angle.limits.start(), angle.limits.end());
        let middle = if least.is_finite() && most.is_finite() { 0.5 * (least + most) } else { 0.0 };
        q[angle.to] = q[angle.from] + middle - angle.offset;
    }
    q
}

/// Returns the interval that a bar covers along its axis, m: its length and all its pins.
fn reach(length: f64, pins: &[f64]) -> (f64, f64) {
    pins.iter().fold((0.0_f64.min(length), 0.0_f64.max(length)), |(least, most), at| (least.min(*at), most.max(*at)))
}
