//! A machine as MJCF, the format of MuJoCo. Links are bodies in the plane z = 0, pins are hinges, and pins that close
//! loops are equalities. The model has motors with gears and rotors. Sensors at the base measure the force and moment
//! of the base on the machine; f_B and n_B have the opposite sign. The frame of a link has x along e(q_k) of its drive,
//! so a link that runs against its drive lies along −x. Bodies and hinges have the same names as in URDF.
//!
//! A base that floats is a body with two slides and a hinge, at the base pin; the body `mount` on it carries the machine,
//! so that the sensors read what acts between the two, along the axes of the base.
//!
//! Of an assembly each block is a body at its mount, whose plane is that of its axes x and y; names begin with that of the
//! block. A platform is a body without mass on the end effector. A hinge turns it, and an equality keeps its orientation.
//! A base that floats has a free joint. In space inertias about all axes count: links are thin bars
//! unless their file states more.
//!
//! Every rotor is a separate body. Behind a gear, it adds different amounts to the momentum (D) and to the inertia (H),
//! whereas an armature would add to the inertia only. Inertias about axes in the plane do not affect a plane motion;
//! of a machine by itself their values are made up.

mod bodies;
mod joins;

use std::f64::consts::TAU;

use super::base_body::BaseBody;
use super::cut::Cut;
use super::look::DRAWN_BAR_RADIUS;
use super::placed::{FloatingBase, Modelled, Placed};
use super::tree::TreePart;
use super::turn::PinAngleSum;
use super::xml::{XmlWriter, quoted};
use bodies::Bodies;
use stillbase_mechanics::assembly::{Assembly, SpatialBase};
use stillbase_mechanics::machine::Machine;

pub(super) use joins::parallel;

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
/// Returns the model of a machine as text; its keyframe `start` is the pose `q`, rad, with motors at rest. The machine
/// stands on the world, or on a base that floats if there is one. `cut` gives the thickness of counterweights, which is
/// for the eye: mass and inertia are those of the machine.
///
/// # Errors
/// If MuJoCo cannot simulate the machine, or if the pose does not have one angle for each drive.
pub fn mjcf(machine: &Machine, base: Option<&BaseBody>, q: &[f64], cut: &Cut) -> Result<String, MjcfError> {
    Model::of(Modelled::machine(machine, base), &[q])?.checked_text(&[q], cut)
}

/// Returns the model of an assembly as text, as [`mjcf`] does that of a machine; `poses` has the angles of each block.
///
/// # Errors
/// As [`mjcf`].
pub fn mjcf_of_assembly(
    assembly: &Assembly,
    base: Option<&SpatialBase>,
    poses: &[&[f64]],
    cut: &Cut,
) -> Result<String, MjcfError> {
    Model::of(Modelled::assembly(assembly, base), poses)?.checked_text(poses, cut)
}

/// Returns the angles of all hinges of the machine in a pose, rad, in the order of `qpos`: links and rotors, depth first.
/// The joints of a base that floats come before them.
///
/// # Errors
/// If the pose does not have one angle for each drive, or if no link follows a drive.
pub fn hinges(machine: &Machine, q: &[f64]) -> Result<Vec<f64>, MjcfError> {
    qpos(machine, None, q)
}

/// Returns `qpos` of the model in a pose, m and rad: the joints of a base that floats, at 0, then all hinges.
///
/// # Errors
/// As [`hinges`].
pub fn qpos(machine: &Machine, base: Option<&BaseBody>, q: &[f64]) -> Result<Vec<f64>, MjcfError> {
    Ok(Model::of(Modelled::machine(machine, base), &[q])?.qpos(&[q]))
}

/// Returns `qpos` of the model of an assembly: place and unit quaternion of a base that floats, then all hinges, those of
/// platforms too.
///
/// # Errors
/// As [`hinges`].
pub fn qpos_of_assembly(
    assembly: &Assembly,
    base: Option<&SpatialBase>,
    poses: &[&[f64]],
) -> Result<Vec<f64>, MjcfError> {
    Ok(Model::of(Modelled::assembly(assembly, base), poses)?.qpos(poses))
}

/// The machines of a model, with what MuJoCo needs to join them.
struct Model<'a> {
    of: Modelled<'a>,
    joins: Vec<Joins>,
}

/// Angles of one machine as sums of the angles of its pins.
struct Joins {
    /// The angle of each motor.
    motors: Vec<PinAngleSum>,
    /// Relative angles with limits: name, sum of pin angles, and limits, rad.
    limited: Vec<(String, PinAngleSum, [f64; 2])>,
    /// Links that need an equality to stay parallel to the first link of their drive, with the angle between the two.
    parallel: Vec<(usize, PinAngleSum)>,
}

impl<'a> Model<'a> {
    fn of(of: Modelled<'a>, poses: &[&[f64]]) -> Result<Self, MjcfError> {
        let drives = of.machines.iter().map(|of| of.machine.drives());
        let [given, wanted] = [poses.iter().map(|q| q.len()).sum(), drives.clone().sum()];
        if !drives.eq(poses.iter().map(|q| q.len())) {
            return Err(MjcfError::Pose { given, wanted });
        }
        let joins = of.machines.iter().map(Joins::of).collect::<Result<_, _>>()?;
        Ok(Self { of, joins })
    }

    /// Returns the text, if MuJoCo can simulate all links.
    fn checked_text(&self, poses: &[&[f64]], cut: &Cut) -> Result<String, MjcfError> {
        for placed in &self.of.machines {
            let massless = |link: &str, what| MjcfError::Massless { link: placed.told(link), what };
            for link in placed.machine.links() {
                if link.mass < MIN_MASS_OR_INERTIA {
                    return Err(massless(&link.name, "mass"));
                }
                if link.inertia < MIN_MASS_OR_INERTIA {
                    return Err(massless(&link.name, "inertia"));
                }
            }
        }
        Ok(self.text(poses, cut))
    }

    fn text(&self, poses: &[&[f64]], cut: &Cut) -> String {
        let [gx, gy, gz] = self.of.gravity;
        let mut out = XmlWriter::default();
        out.add(0, format_args!("<mujoco model=\"{}\">", quoted(self.of.name)));
        out.add(1, format_args!("<compiler angle=\"radian\" autolimits=\"true\" inertiafromgeom=\"false\"/>"));
        let option = format!("<option gravity=\"{gx} {gy} {gz}\" timestep=\"0.0005\" integrator=\"implicitfast\"/>");
        out.add(1, format_args!("{option}"));
        out.add(1, format_args!("<default>"));
        let shape = "type=\"capsule\" size=";
        out.add(2, format_args!("<geom {shape}\"{DRAWN_BAR_RADIUS}\" contype=\"0\" conaffinity=\"0\" mass=\"0\"/>"));
        out.add(2, format_args!("<joint type=\"hinge\" axis=\"0 0 1\"/>"));
        out.add(2, format_args!("<equality solref=\"0.002 1\" solimp=\"0.99 0.9999 0.001\"/>"));
        out.add(1, format_args!("</default>"));
        out = Bodies { model: self, cut, out }.world();
        self.section(&mut out, "tendon", Self::tendons);
        self.section(&mut out, "equality", Self::equalities);
        self.section(&mut out, "actuator", Self::actuators);
        out.add(1, format_args!("<sensor>"));
        out.add(2, format_args!("<force name=\"base force\" site=\"base\"/>"));
        out.add(2, format_args!("<torque name=\"base moment\" site=\"base\"/>"));
        for Placed { tree, .. } in &self.of.machines {
            let [name, site] = [tree.own("end effector"), tree.name(TreePart::End)];
            out.add(2, format_args!("<framepos name=\"{name}\" objtype=\"site\" objname=\"{site}\"/>"));
        }
        out.add(1, format_args!("</sensor>"));
        out.add(1, format_args!("<keyframe>"));
        let pose = self.qpos(poses).iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        out.add(2, format_args!("<key name=\"start\" qpos=\"{pose}\"/>"));
        out.add(1, format_args!("</keyframe>"));
        out.add(0, format_args!("</mujoco>"));
        out.into_text()
    }

    /// Writes the elements of all machines in a section, if there are any.
    fn section(&self, out: &mut XmlWriter, name: &str, lines: fn(&Self, usize) -> Vec<String>) {
        let all: Vec<String> = (0..self.joins.len()).flat_map(|i| lines(self, i)).collect();
        if all.is_empty() {
            return;
        }
        out.add(1, format_args!("<{name}>"));
        all.iter().for_each(|line| out.add(2, format_args!("{line}")));
        out.add(1, format_args!("</{name}>"));
    }

    fn children(&self, i: usize, parent: Option<usize>) -> Vec<usize> {
        let parts = self.of.machines[i].machine.resolved_links();
        (0..parts.len()).filter(|j| parts[*j].parent == parent).collect()
    }

    /// Returns the name of a link's hinge.
    fn hinge(&self, i: usize, j: usize) -> String {
        self.of.machines[i].tree.holder(TreePart::Link(j))
    }

    fn rotor_hinge(&self, i: usize, k: usize) -> String {
        self.of.machines[i].tree.holder(TreePart::Rotor(k))
    }

    /// Returns whether the rotor of a drive is a body of the model.
    fn has_rotor(&self, i: usize, k: usize) -> bool {
        let rotor = self.of.machines[i].machine.spec().drives[k].rotor;
        rotor.is_some_and(|rotor| rotor.inertia >= MIN_MASS_OR_INERTIA)
    }

    /// Returns the link that carries the motor of a drive; `None` for the base.
    fn carrier(&self, i: usize, k: usize) -> Option<usize> {
        let machine = self.of.machines[i].machine;
        let parts = machine.resolved_links();
        let on = machine.motors().on(k)?;
        let pin = self.joins[i].motors[k].pin().and_then(|j| parts[j].parent);
        pin.or_else(|| parts.iter().position(|part| part.drive == on))
    }

    /// Returns the rotors that a link carries; without a link, the base.
    fn rotors_on(&self, i: usize, on: Option<usize>) -> Vec<usize> {
        let drives = self.of.machines[i].machine.drives();
        (0..drives).filter(|k| self.has_rotor(i, *k) && self.carrier(i, *k) == on).collect()
    }

    /// Returns the numbers of all joints, those of the base first and at rest, the angles of hinges in rad in the order of
    /// the bodies.
    fn qpos(&self, poses: &[&[f64]]) -> Vec<f64> {
        let mut all = match self.of.base {
            None => Vec::new(),
            Some(FloatingBase::Planar(_)) => vec![0.0; 3],
            Some(FloatingBase::Spatial(_)) => vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        };
        self.of.on_base().for_each(|i| self.pose_of(i, None, poses, &mut all));
        all
    }

    fn pose_of(&self, i: usize, parent: Option<usize>, poses: &[&[f64]], all: &mut Vec<f64>) {
        let (Placed { machine, carries, .. }, q) = (&self.of.machines[i], poses[i]);
        let direction = |j: Option<usize>| j.and_then(|j| machine.drive_of_link(j)).map_or(0.0, |k| q[k]);
        for k in self.rotors_on(i, parent) {
            let on = machine.motors().on(k).map_or(0.0, |on| q[on]);
            let ratio = machine.spec().drives[k].rotor.map_or(1.0, |rotor| rotor.ratio);
            all.push(ratio * (q[k] - on));
        }
        for j in self.children(i, parent) {
            all.push(direction(Some(j)) - direction(parent));
            self.pose_of(i, Some(j), poses, all);
        }
        if parent == Some(machine.end_link()) && !carries.is_empty() {
            all.push(-direction(parent));
            carries.iter().for_each(|on| self.pose_of(*on, None, poses, all));
        }
    }
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
