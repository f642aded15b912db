//! [`Tree`]: a machine as a tree of parts and joints, as URDF requires it, and their names in URDF and MJCF.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | θ_k | angle of motor k: q_k − q_l if drive l carries the motor, q_k if the base carries it | rad |
//!
//! A pin between links of two drives turns by a sum of motor angles, but a joint of URDF can mimic only one other
//! joint. So a sum becomes several joints in series, with auxiliary parts of negligible mass between them. Programs
//! that read a tree from its root need a joint before the joints that mimic it. Motors turn links directly if that
//! gives this order, as in a serial arm. Otherwise each motor turns a shaft, and all links follow
//! shafts. A platform turns back by all that its end effector turned, in the same way.

use std::collections::BTreeMap;
use std::fmt::Display;

use super::xml::quoted;
use stillbase_mechanics::machine::Machine;

/// A part of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TreePart {
    Base,
    /// A link of the machine, by its index.
    Link(usize),
    /// An auxiliary part that motor k turns, if it turns no link directly.
    Shaft(usize),
    /// The rotor of motor k.
    Rotor(usize),
    /// An auxiliary part between joints in series: the link after them, and the number of the joint, from 1.
    Between(usize, usize),
    /// The end effector.
    End,
    Payload,
    /// An auxiliary part between the end effector and the platform, by its number, from 1.
    Under(usize),
    /// What moves with the end effector, keeps its orientation and carries other machines.
    Platform,
}

/// Motion of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turns {
    /// Turns by θ_k: the joint of motor k.
    Motor(usize),
    /// Mimics motor k: turns by θ_k times this factor.
    Follows(usize, f64),
    Not,
}

/// A joint between two parts, at position `at` along the parent's x axis, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeJoint {
    pub parent: TreePart,
    pub at: f64,
    pub child: TreePart,
    pub turns: Turns,
}

/// All joints: those of motors first, in the order of the drives.
pub struct Tree<'a> {
    machine: &'a Machine,
    /// What all names begin with: nothing for a machine by itself, or else its block, as `wrist/`.
    prefix: String,
    pub joints: Vec<TreeJoint>,
}

impl<'a> Tree<'a> {
    /// Makes the tree of a machine, whose names begin with `prefix`. With `carries` it has a platform.
    pub fn of(machine: &'a Machine, prefix: String, carries: bool) -> Self {
        let parts = machine.resolved_links();
        let turned = |k: usize| {
            let on = machine.motors().on(k);
            let is_turned =
                |j: &usize| parts[*j].drive == k && parts[*j].parent.and_then(|p| machine.drive_of_link(p)) == on;
            (0..parts.len()).find(is_turned)
        };
        let links = (0..machine.drives()).map(turned).collect::<Vec<_>>();
        let direct = Self { machine, prefix, joints: joints(machine, &links, carries) };
        match direct.is_readable() {
            true => direct,
            false => Self { joints: joints(machine, &vec![None; machine.drives()], carries), ..direct },
        }
    }

    /// Returns a name of its own, which no other machine of the model has.
    pub fn own(&self, name: impl Display) -> String {
        format!("{}{name}", self.prefix)
    }

    /// Returns the name of what has to do with a drive, as `gear_1`.
    pub fn of_drive(&self, what: &str, k: usize) -> String {
        self.own(format_args!("{what}_{}", quoted(&self.machine.spec().drives[k].name)))
    }

    /// Returns the name of a part.
    pub fn name(&self, part: TreePart) -> String {
        let link = |j: usize| quoted(&self.machine.links()[j].name);
        match part {
            TreePart::Base => self.own("base"),
            TreePart::Link(j) => self.own(format_args!("link_{}", link(j))),
            TreePart::Shaft(k) => self.of_drive("shaft", k),
            TreePart::Rotor(k) => self.of_drive("rotor", k),
            TreePart::Between(j, number) => self.own(format_args!("pin_{number}_of_link_{}", link(j))),
            TreePart::End => self.own("end_effector"),
            TreePart::Payload => self.own("payload"),
            TreePart::Under(number) => self.own(format_args!("pin_{number}_of_platform")),
            TreePart::Platform => self.own("platform"),
        }
    }

    /// Returns the name of a joint.
    pub fn joint_name(&self, joint: &TreeJoint) -> String {
        match joint.turns {
            Turns::Motor(k) => self.of_drive("drive", k),
            _ => self.joint_to(joint.child),
        }
    }

    fn joint_to(&self, part: TreePart) -> String {
        let name = self.name(part);
        self.own(format_args!("joint_{}", &name[self.prefix.len()..]))
    }

    /// Returns the name of the joint that carries a part.
    pub fn holder(&self, part: TreePart) -> String {
        let joint = self.joints.iter().find(|joint| joint.child == part);
        joint.map_or_else(|| self.joint_to(part), |joint| self.joint_name(joint))
    }

    /// Returns whether each joint comes after the joint that it mimics, from the root to the tips. This must hold in
    /// the order of the file and in that of the joints' names, by which some programs sort them.
    fn is_readable(&self) -> bool {
        let mut by_name: Vec<(String, &TreeJoint)> =
            self.joints.iter().map(|joint| (self.joint_name(joint), joint)).collect();
        by_name.sort_by(|(a, _), (b, _)| a.cmp(b));
        let by_name: Vec<&TreeJoint> = by_name.into_iter().map(|(_, joint)| joint).collect();
        is_ordered(&self.joints.iter().collect::<Vec<_>>()) && is_ordered(&by_name)
    }
}

/// Returns whether each joint comes after the joint that it mimics, depth first.
fn is_ordered(joints: &[&TreeJoint]) -> bool {
    let mut below: BTreeMap<TreePart, Vec<&TreeJoint>> = BTreeMap::new();
    for joint in joints.iter().rev() {
        below.entry(joint.parent).or_default().push(joint);
    }
    let (mut open, mut seen) = (below.remove(&TreePart::Base).unwrap_or_default(), Vec::new());
    while let Some(joint) = open.pop() {
        match joint.turns {
            Turns::Motor(k) => seen.push(k),
            Turns::Follows(k, _) if !seen.contains(&k) => return false,
            Turns::Follows(..) | Turns::Not => {}
        }
        open.extend(below.remove(&joint.child).unwrap_or_default());
    }
    true
}

/// Returns the joints of a machine; `turned` holds the link that each motor turns, `None` for a shaft.
fn joints(machine: &Machine, turned: &[Option<usize>], carries: bool) -> Vec<TreeJoint> {
    let parts = machine.resolved_links();
    let motors = machine.motors();
    let root = |j: usize| match parts[j].parent {
        None => (TreePart::Base, 0.0),
        Some(parent) => (TreePart::Link(parent), parts[parent].sign * parts[j].at),
    };
    let driven = |k: usize| turned[k].map_or(TreePart::Shaft(k), TreePart::Link);
    // A shaft sits at the root of the part that turns with the drive carrying its motor.
    let seat = |k: usize| match (turned[k], motors.on(k)) {
        (Some(j), _) => root(j),
        (None, Some(on)) => (driven(on), 0.0),
        (None, None) => (TreePart::Base, 0.0),
    };
    let mut joints = Vec::new();
    for k in 0..machine.drives() {
        let (parent, at) = seat(k);
        joints.push(TreeJoint { parent, at, child: driven(k), turns: Turns::Motor(k) });
    }
    for (k, drive) in machine.spec().drives.iter().enumerate() {
        if let Some(rotor) = drive.rotor {
            let (parent, at) = seat(k);
            joints.push(TreeJoint { parent, at, child: TreePart::Rotor(k), turns: Turns::Follows(k, rotor.ratio) });
        }
    }
    // Adds a part with the joints in series that turn it from one drive to another; `between` are the parts between them.
    let series = |joints: &mut Vec<TreeJoint>,
                  (mut parent, mut at),
                  [from, to]: [Option<usize>; 2],
                  between: &dyn Fn(usize) -> TreePart,
                  part| {
        let turns = turns(machine, from, to);
        let (last, first) = match turns.split_last() {
            Some((last, first)) => (Turns::Follows(last.0, last.1), first),
            None => (Turns::Not, &[][..]),
        };
        for (number, (k, sign)) in first.iter().enumerate() {
            let child = between(number + 1);
            joints.push(TreeJoint { parent, at, child, turns: Turns::Follows(*k, *sign) });
            (parent, at) = (child, 0.0);
        }
        joints.push(TreeJoint { parent, at, child: part, turns: last });
    };
    for j in (0..parts.len()).filter(|j| !turned.contains(&Some(*j))) {
        let drives = [parts[j].parent.and_then(|p| machine.drive_of_link(p)), machine.drive_of_link(j)];
        series(&mut joints, root(j), drives, &|number| TreePart::Between(j, number), TreePart::Link(j));
    }
    let (j, payload) = (machine.end_link(), machine.spec().payload);
    let at = machine.end_effector()[parts[j].drive] - parts[j].root[parts[j].drive];
    joints.push(TreeJoint { parent: TreePart::Link(j), at, child: TreePart::End, turns: Turns::Not });
    if payload.mass > 0.0 || payload.inertia > 0.0 {
        joints.push(TreeJoint { parent: TreePart::End, at: 0.0, child: TreePart::Payload, turns: Turns::Not });
    }
    if carries {
        series(&mut joints, (TreePart::End, 0.0), [Some(parts[j].drive), None], &TreePart::Under, TreePart::Platform);
    }
    joints
}

/// Returns q_to − q_from as a sum of motor angles, each with sign 1 or −1. The sum goes from drive `from` along its
/// carriers to the common carrier, then from there to drive `to`.
fn turns(machine: &Machine, from: Option<usize>, to: Option<usize>) -> Vec<(usize, f64)> {
    let motors = machine.motors();
    let carriers = |k: Option<usize>| std::iter::successors(k, |k| motors.on(*k)).collect::<Vec<_>>();
    let (up, down) = (carriers(from), carriers(to));
    let shared = down.iter().rev().zip(up.iter().rev()).take_while(|(a, b)| a == b).count();
    let back = up[..up.len() - shared].iter().map(|k| (*k, -1.0));
    back.chain(down[..down.len() - shared].iter().rev().map(|k| (*k, 1.0))).collect()
}
