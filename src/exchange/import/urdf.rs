//! URDF reader: a tree of links; mimic joints determine which parts turn together.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::linkage::{
    Ground, ImportedLinkage, ImportedMotor, ImportedPart, JointLimit, PartPoint, common_axis, end_rank, owners,
};
use super::read::{child, each, inertia, mass, number, required_number, vector, word};
use super::refusal::{ImportError, element_error, element_name};
use crate::urdf::meet;
use stillbase_mechanics::planar::MAX_DRIVES;
use stillbase_settings::number::{ShortNumber, fixed};
use stillbase_settings::range::{quote_clipped, shortened};

/// Tolerance within which rate ratios are equal; also the relative tolerance of limits.
const RATE_TOLERANCE: f64 = 1e-9;
/// A limit of torque, N m, or speed, rad/s, of at least this, or not above 0, is treated as no limit.
const UNLIMITED: f64 = 1e9;

/// Maximum number of joints: the export of the largest machine has fewer.
const MAX_JOINTS: usize = 4000;

/// Maximum number of joints in a chain in which each mimics the next.
const MAX_FOLLOWED: usize = 100;

/// Reads the linkage of a `<robot>`.
pub fn linkage(robot: Node<'_, '_>) -> Result<ImportedLinkage, ImportError> {
    let file = File::of(robot)?;
    let mut parts = Vec::new();
    let mut joints = Vec::new();
    file.walk(&mut parts, &mut joints)?;
    let (_, signs) = common_axis(&parts)?;
    let (free, rates) = file.rates(&parts, &joints, &signs)?;
    let (sets, mut motors, rotors) = turning(&parts, &joints, &free, &rates)?;
    let mut limits = Vec::new();
    for (k, i) in free.iter().enumerate() {
        if let Some(range) = range(joints[*i], signs[*i])? {
            limits.push(JointLimit { name: None, to: k, from: motors[k].from, now: 0.0, range: Some(range) });
        }
    }
    let extension = Extension { robot, joints: free.iter().map(|i| joints[*i]).collect(), links: file.numbers(&parts) };
    extension.limits(&mut limits)?;
    extension.motors(&mut motors)?;
    let end = end(&parts, &owners(&parts));
    let meshes = robot.descendants().any(|node| node.has_tag_name("mesh"));
    let mut notes = Vec::new();
    if meshes {
        notes.push("meshes are left out: a machine here is made of bars".to_owned());
    }
    notes.extend(left_out(robot));
    let root = file.links[file.root];
    let ground = child(root, "inertial").map(|_| body(root, &Isometry3::identity(), false)).transpose()?;
    let ground = ground.or(Some((0.0, Vector3::zeros(), Matrix3::zeros())));
    Ok(ImportedLinkage {
        name: robot.attribute("name").unwrap_or("robot").into(),
        gravity: extension.gravity()?,
        loops: extension.loops(&parts)?,
        parts,
        sets,
        motors,
        limits,
        rotors,
        end,
        ground: ground.map(|(mass, com, inertia)| Ground { mass, com, inertia, floats: file.floats }),
        notes,
    })
}

/// Numbers of attributes, by the names of elements, and how many of them an attribute has.
const VALUES: [(&str, &[&str], usize); 6] = [
    ("origin", &["xyz", "rpy"], 3),
    ("axis", &["xyz"], 3),
    ("mass", &["value"], 1),
    ("inertia", &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], 1),
    ("limit", &["lower", "upper", "effort", "velocity"], 1),
    ("mimic", &["multiplier", "offset"], 1),
];

/// Returns what is wrong with the values of links and joints, wherever these belong.
pub fn wrong_values(robot: Node<'_, '_>) -> Vec<ImportError> {
    let own = |node: &Node| {
        node.is_element() && !node.ancestors().any(|node| node.has_tag_name("visual") || node.has_tag_name("collision"))
    };
    robot.descendants().filter(own).flat_map(wrong_values_of).collect()
}

fn wrong_values_of(node: Node<'_, '_>) -> Vec<ImportError> {
    let is_end = node.has_tag_name("parent") || node.has_tag_name("child");
    let lacks = is_end.then(|| word(node, "link").err()).flatten();
    let of_tag = VALUES.into_iter().filter(|(tag, ..)| node.has_tag_name(*tag));
    let values = of_tag.flat_map(|(_, names, count)| names.iter().map(move |name| (*name, count)));
    let wrong = values.filter_map(|(name, count)| match count {
        1 if name == "value" => node.attribute(name).and_then(|_| mass(node, name).err()),
        1 => number(node, name).err(),
        _ => vector(node, name).err(),
    });
    wrong.chain(lacks).collect()
}

/// Returns notes on elements of the file that are omitted or belong to a scenario.
fn left_out(robot: Node<'_, '_>) -> Vec<String> {
    let is_other = |node: &Node, name: &str, usual: f64| {
        node.attribute(name).and_then(|x| x.trim().parse::<f64>().ok()).is_some_and(|x| x != usual)
    };
    let mut notes = Vec::new();
    let mut dynamics = robot.descendants().filter(|node| node.has_tag_name("dynamics"));
    if dynamics.any(|node| is_other(&node, "damping", 0.0) || is_other(&node, "friction", 0.0)) {
        notes.push("damping and friction of joints are left out: friction belongs into the plant of a scenario".into());
    }
    let mut reductions = robot.descendants().filter(|node| node.has_tag_name("mechanicalReduction"));
    if reductions.any(|node| node.text().and_then(|x| x.trim().parse::<f64>().ok()).is_some_and(|x| x != 1.0)) {
        let words = "reductions of transmissions are left out: the ratio of a gear or belt is that of its motor, \
                     --set drive.NAME.rotor.ratio with drive.NAME.rotor.inertia";
        notes.push(words.into());
    }
    notes
}

/// The element `<stillbase>`, which this program adds to URDF.
struct Extension<'a> {
    robot: Node<'a, 'a>,
    /// Independent joints, in the order of the motors.
    joints: Vec<Node<'a, 'a>>,
    /// Parts by the names of their links.
    links: BTreeMap<&'a str, usize>,
}

impl<'a> Extension<'a> {
    fn each(&self, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> + use<'a> {
        each(self.robot, "stillbase").flat_map(move |node| each(node, name))
    }

    /// Returns the motor of the joint that an attribute names.
    fn motor(&self, node: Node<'a, 'a>, attribute: &'static str) -> Result<usize, ImportError> {
        let name = word(node, attribute)?;
        let known = self.joints.iter().position(|joint| joint.attribute("name") == Some(name));
        let what = || format!("no joint \"{}\" moves by itself", quote_clipped(name));
        known.ok_or_else(|| element_error(node, what(), "the name of one that does"))
    }

    fn gravity(&self) -> Result<Vector3<f64>, ImportError> {
        let Some(node) = self.each("gravity").next() else { return Ok(Vector3::zeros()) };
        Ok(Vector3::new(number(node, "x")?.unwrap_or(0.0), number(node, "y")?.unwrap_or(0.0), 0.0))
    }

    /// Adds the limits of relative angles, and removes limits of joints that these already imply.
    fn limits(&self, limits: &mut Vec<JointLimit>) -> Result<(), ImportError> {
        let mut own = Vec::new();
        for node in self.each("angle").take(MAX_JOINTS) {
            let (to, from) = (self.motor(node, "to")?, self.motor(node, "from")?);
            let now = number(node, "offset")?.unwrap_or(0.0);
            let range = number(node, "lower")?.zip(number(node, "upper")?).map(|(least, most)| [least, most]);
            let name = node.attribute("name").map(Into::into);
            own.push(JointLimit { name, to, from: Some(from), now, range });
        }
        // The intersection of the limits of all angles between the same two drives, with the sign of the joint.
        let intersection = |joint: &JointLimit| {
            let of = |own: &JointLimit| {
                let [least, most] = own.range?.map(|x| x - own.now);
                match (own.to, own.from) {
                    (to, from) if to == joint.to && from == joint.from => Some([least, most]),
                    (to, from) if Some(to) == joint.from && from == Some(joint.to) => Some([-most, -least]),
                    _ => None,
                }
            };
            own.iter().filter_map(of).reduce(meet)
        };
        let is_near = |a: f64, b: f64| (a - b).abs() <= RATE_TOLERANCE * (1.0 + b.abs());
        let is_implied = |joint: &JointLimit| {
            let (implied, own) = (intersection(joint), joint.range);
            implied.zip(own).is_some_and(|(implied, own)| (0..2).all(|i| is_near(implied[i], own[i])))
        };
        limits.retain(|joint| !is_implied(joint));
        own.append(limits);
        *limits = own;
        Ok(())
    }

    /// Adds limits that URDF cannot express.
    fn motors(&self, motors: &mut [ImportedMotor]) -> Result<(), ImportError> {
        for node in self.each("limit").take(MAX_JOINTS) {
            let k = self.motor(node, "joint")?;
            motors[k].acceleration_limit = number(node, "acceleration")?;
            motors[k].jerk_limit = number(node, "jerk")?;
        }
        Ok(())
    }

    /// Returns the pins that close loops.
    fn loops(&self, parts: &[ImportedPart]) -> Result<Vec<[PartPoint; 2]>, ImportError> {
        let owners = owners(parts);
        let end = |node: Node<'a, 'a>, link: &'static str, at: &'static str| {
            let name = word(node, link)?;
            let known = self.links.get(name).copied();
            let i = known.ok_or_else(|| {
                element_error(node, format!("no link \"{}\"", quote_clipped(name)), "the name of one")
            })?;
            let at = parts[i].frame * nalgebra::Point3::new(required_number(node, at)?, 0.0, 0.0);
            let owner = owners[i]
                .ok_or_else(|| element_error(node, "a pin on what does not turn", "pins on links that turn"))?;
            Ok::<_, ImportError>((owner, at.coords))
        };
        let pin = |node| Ok([end(node, "a", "at_a")?, end(node, "b", "at_b")?]);
        self.each("pin").take(MAX_JOINTS).map(pin).collect()
    }
}

/// Links and joints by name.
struct File<'a> {
    links: BTreeMap<&'a str, Node<'a, 'a>>,
    /// Joints, each with the names of its parent link and its child link.
    joints: Vec<(Node<'a, 'a>, &'a str, &'a str)>,
    /// The base.
    root: &'a str,
    /// Whether the base floats.
    floats: bool,
}

impl<'a> File<'a> {
    fn of(robot: Node<'a, 'a>) -> Result<Self, ImportError> {
        if let Some(other) = robot.descendants().find(|node| node.is_element() && node.tag_name().namespace().is_some())
        {
            return Err(element_error(
                other,
                "an element of xacro or another language",
                "plain URDF, as xacro makes it",
            ));
        }
        if let Some(node) = robot.children().filter(|node| node.has_tag_name("joint")).nth(MAX_JOINTS) {
            return Err(element_error(node, "too many joints", format!("at most {MAX_JOINTS}")));
        }
        let mut links = BTreeMap::new();
        for link in each(robot, "link") {
            let name = word(link, "name")?;
            if links.insert(name, link).is_some() {
                return Err(element_error(link, "a second link of this name", "each name once"));
            }
        }
        let mut joints = Vec::new();
        for joint in each(robot, "joint") {
            let end = |what: &'static str| {
                let node =
                    child(joint, what).ok_or_else(|| element_error(joint, format!("it has no <{what}>"), "one"))?;
                let name = word(node, "link")?;
                match links.contains_key(name) {
                    true => Ok(name),
                    false => Err(element_error(
                        node,
                        format!("no link \"{}\"", quote_clipped(name)),
                        "the name of a link of this file",
                    )),
                }
            };
            joints.push((joint, end("parent")?, end("child")?));
        }
        let mut held = BTreeSet::new();
        for (joint, _, child) in &joints {
            if !held.insert(*child) {
                let what = format!("a second joint that carries \"{}\"", quote_clipped(child));
                return Err(element_error(*joint, what, "a tree: one for each link"));
            }
        }
        let roots: Vec<&str> = links.keys().copied().filter(|name| !held.contains(name)).collect();
        let carriers: BTreeSet<&str> = joints.iter().map(|(_, parent, _)| *parent).collect();
        let root = roots.iter().find(|name| carriers.contains(*name));
        let root = *root.ok_or_else(|| element_error(robot, "no link is the base", "a tree of links"))?;
        if let Some(other) = roots.iter().find(|other| **other != root) {
            let what = format!("no joint carries it, nor \"{}\"", quote_clipped(root));
            return Err(element_error(links[other], what, "one link that is the base"));
        }
        // A floating joint in the world carries the base; it is no joint of the arm.
        let in_world: Vec<usize> = (0..joints.len()).filter(|i| joints[*i].1 == root).collect();
        match in_world[..] {
            [only] if joints[only].0.attribute("type") == Some("floating") => {
                let (_, _, base) = joints.remove(only);
                Ok(Self { links, joints, root: base, floats: true })
            }
            _ => Ok(Self { links, joints, root, floats: false }),
        }
    }

    /// Collects the parts from the base on, each with its joint.
    fn walk(&self, parts: &mut Vec<ImportedPart>, joints: &mut Vec<Node<'a, 'a>>) -> Result<(), ImportError> {
        let mut below: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (i, (_, parent, _)) in self.joints.iter().enumerate() {
            below.entry(parent).or_default().push(i);
        }
        let mut open = vec![(self.root, None, Isometry3::identity())];
        let mut next = 0;
        while next < open.len() {
            let (name, place, frame) = open[next];
            next += 1;
            for i in below.remove(name).unwrap_or_default() {
                let (joint, _, link) = self.joints[i];
                parts.push(part(joint, self.links[link], place, &frame)?);
                joints.push(joint);
                let own = parts.len() - 1;
                open.push((link, Some(own), parts[own].frame));
            }
        }
        // Links that carry each other in a cycle are not connected to the base.
        match below.into_values().flatten().next() {
            Some(i) => {
                Err(element_error(self.joints[i].0, "links that carry each other", "a tree that begins at the base"))
            }
            None => Ok(()),
        }
    }

    /// Returns the indices of the parts by the names of their links.
    fn numbers(&self, parts: &[ImportedPart]) -> BTreeMap<&'a str, usize> {
        let by_name: BTreeMap<&str, usize> =
            parts.iter().enumerate().map(|(i, part)| (part.name.as_str(), i)).collect();
        self.links.keys().filter_map(|name| Some((*name, *by_name.get(name)?))).collect()
    }

    /// Returns the independent joints, and for each part the ratios of its rate to theirs, about the common axis.
    fn rates(
        &self,
        parts: &[ImportedPart],
        joints: &[Node<'a, 'a>],
        signs: &[f64],
    ) -> Result<(Vec<usize>, Vec<Vec<f64>>), ImportError> {
        let turns = |i: usize| parts[i].hinge.is_some();
        let is_free = |i: &usize| turns(*i) && child(joints[*i], "mimic").is_none();
        let mut free: Vec<usize> = (0..parts.len()).filter(is_free).collect();
        if free.len() > MAX_DRIVES {
            let want = format!("at most {MAX_DRIVES}");
            return Err(ImportError::of_file(format!("{} joints that move by themselves", free.len()), want));
        }
        // The independent joints have the order of the file.
        free.sort_by_key(|i| joints[*i].range().start);
        let named = joints.iter().enumerate().rev();
        let named = named.filter_map(|(i, joint)| Some((joint.attribute("name")?, i))).collect();
        let mut rates: Vec<Vec<f64>> = Vec::with_capacity(parts.len());
        for (i, part) in parts.iter().enumerate() {
            let mut own = part.parent.map_or_else(|| vec![0.0; free.len()], |parent| rates[parent].clone());
            if turns(i) {
                let (driver, times) = followed(joints, &named, i)?;
                let k = free.iter().position(|k| *k == driver).ok_or_else(|| {
                    element_error(joints[i], "it mimics a joint that does not turn", "a revolute or continuous joint")
                })?;
                own[k] += signs[i] * times * signs[driver];
            }
            rates.push(own);
        }
        Ok((free, rates))
    }
}

/// Returns the independent joint that joint `i` mimics, directly or through others, and the factor of its angle; joint
/// `i` itself if it mimics none.
fn followed(joints: &[Node<'_, '_>], named: &BTreeMap<&str, usize>, i: usize) -> Result<(usize, f64), ImportError> {
    let (mut at, mut times) = (i, 1.0);
    // The number of joints followed is bounded, so that a cycle ends.
    for _ in 0..=joints.len().min(MAX_FOLLOWED) {
        let Some(mimic) = child(joints[at], "mimic") else { return Ok((at, times)) };
        times *= number(mimic, "multiplier")?.unwrap_or(1.0);
        let name = word(mimic, "joint")?;
        at = named.get(name).copied().ok_or_else(|| {
            element_error(
                joints[i],
                format!("it mimics \"{}\", which is no joint", quote_clipped(name)),
                "the name of one",
            )
        })?;
    }
    Err(element_error(joints[i], "joints that mimic each other", "a chain that ends at a joint without mimic"))
}

fn origin(node: Node<'_, '_>) -> Result<Isometry3<f64>, ImportError> {
    let Some(origin) = child(node, "origin") else { return Ok(Isometry3::identity()) };
    let place = vector(origin, "xyz")?.unwrap_or_default();
    let turn = vector(origin, "rpy")?.unwrap_or_default();
    let turn = UnitQuaternion::from_euler_angles(turn.x, turn.y, turn.z);
    Ok(Isometry3::from_parts(Translation3::from(place), turn))
}

/// Reads a link with the joint that carries it.
fn part(
    joint: Node<'_, '_>,
    link: Node<'_, '_>,
    parent: Option<usize>,
    on: &Isometry3<f64>,
) -> Result<ImportedPart, ImportError> {
    let turns = match word(joint, "type")? {
        "revolute" | "continuous" => true,
        "fixed" => false,
        kind => {
            let kind = quote_clipped(kind);
            return Err(element_error(
                joint,
                format!("a joint of type \"{kind}\""),
                "revolute, continuous or fixed joints; only the base may float, by the only joint of the world",
            ));
        }
    };
    let mut frame = on * origin(joint)?;
    let mut hinge = None;
    if turns {
        let axis = child(joint, "axis").map(|axis| vector(axis, "xyz")).transpose()?.flatten();
        let axis = Unit::try_new(axis.unwrap_or(Vector3::x()), 1e-6)
            .ok_or_else(|| element_error(joint, "an axis without direction", "three numbers that are not all 0"))?;
        // A mimic joint may have an offset angle.
        let offset = child(joint, "mimic").map(|mimic| number(mimic, "offset")).transpose()?.flatten().unwrap_or(0.0);
        frame *= UnitQuaternion::from_axis_angle(&axis, offset);
        hinge = Some((frame.rotation * axis, frame.translation.vector));
    }
    let (mass, com, inertia) = body(link, &frame, turns)?;
    let name = word(link, "name")?.to_owned();
    Ok(ImportedPart {
        name,
        called: element_name(link),
        at: link.range().start,
        parent,
        frame,
        hinge,
        mass,
        com,
        inertia,
    })
}

/// Reads mass, kg, centre of mass, m, and inertia, kg m², in the axes of the base.
fn body(
    link: Node<'_, '_>,
    frame: &Isometry3<f64>,
    turns: bool,
) -> Result<(f64, Vector3<f64>, Matrix3<f64>), ImportError> {
    let Some(inertial) = child(link, "inertial") else {
        return match turns {
            true => Err(element_error(link, "it turns and has no <inertial>", "its mass, centre of mass and inertia")),
            false => Ok((0.0, frame.translation.vector, Matrix3::zeros())),
        };
    };
    let place = frame * origin(inertial)?;
    let part = |name| {
        child(inertial, name).ok_or_else(|| element_error(link, format!("its <inertial> has no <{name}>"), "one"))
    };
    let mass = mass(part("mass")?, "value")?;
    let node = part("inertia")?;
    let [xx, yy, zz] = [required_number(node, "ixx")?, required_number(node, "iyy")?, required_number(node, "izz")?];
    let pair = |name| number(node, name).map(|x| x.unwrap_or(0.0));
    let all = [xx, yy, zz, pair("ixy")?, pair("ixz")?, pair("iyz")?];
    Ok((mass, place.translation.vector, inertia(all, &Rotation3::from(place.rotation))))
}

type Turning = (Vec<Option<usize>>, Vec<ImportedMotor>, Vec<(usize, usize, f64)>);

/// Returns the sets of parts that turn together, the motors that turn them, and the rotors.
fn turning(
    parts: &[ImportedPart],
    joints: &[Node<'_, '_>],
    free: &[usize],
    rates: &[Vec<f64>],
) -> Result<Turning, ImportError> {
    let is_same = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= RATE_TOLERANCE);
    let none = vec![0.0; free.len()];
    let is_still = |a: &[f64]| is_same(a, &none);
    // Set k consists of the parts that motor k turns.
    let set = |own: &[f64]| free.iter().position(|i| is_same(&rates[*i], own));
    let of_parent = |i: usize| parts[i].parent.map_or(&none, |parent| &rates[parent]);
    let mut motors = Vec::new();
    for (k, i) in free.iter().enumerate() {
        let (joint, from) = (joints[*i], of_parent(*i));
        let from = match is_still(from) {
            true => None,
            false => Some(set(from).ok_or_else(|| {
                element_error(joint, "its parent turns as no driven joint does", "motors on the base or on links")
            })?),
        };
        if set(&rates[*i]) != Some(k) {
            return Err(element_error(
                joint,
                "it turns as another joint does",
                "joints that move by themselves or mimic",
            ));
        }
        motors.push(motor(joint, from)?);
    }
    let carriers: BTreeSet<usize> = parts.iter().filter_map(|part| part.parent).collect();
    let (mut rotors, mut sets) = (Vec::new(), Vec::new());
    let negligible_mass = negligible_mass(parts);
    for (i, part) in parts.iter().enumerate() {
        let own = if is_still(&rates[i]) { None } else { set(&rates[i]) };
        if !carriers.contains(&i) && part.hinge.is_some() && child(joints[i], "mimic").is_some() {
            let relative: Vec<f64> = rates[i].iter().zip(of_parent(i)).map(|(a, b)| a - b).collect();
            let only = relative.iter().position(|x| x.abs() > RATE_TOLERANCE);
            let k = only.filter(|k| relative.iter().enumerate().all(|(l, x)| l == *k || x.abs() <= RATE_TOLERANCE));
            // A rotor sits on the same body as its motor.
            let k = k.filter(|k| is_same(of_parent(i), of_parent(free[*k])));
            if let Some(k) = k.filter(|_| own.is_none() || part.mass <= negligible_mass) {
                rotors.push((i, k, relative[k]));
            }
        }
        sets.push(own);
    }
    for (i, part) in parts.iter().enumerate() {
        let is_rotor = || rotors.iter().any(|(rotor, ..)| *rotor == i);
        if sets[i].is_none() && !is_still(&rates[i]) && !is_rotor() && part.mass > negligible_mass {
            let all: Vec<String> = rates[i].iter().map(|x| fixed(*x, 3)).collect();
            let what = format!("it turns by {} times the driven joints", shortened(&all.join(", "), 100));
            let want = "links that each turn as one motor's drive does; a belt from the base keeps its link at the \
                        angle of a joint that moves by itself, by mimic with multiplier 1 or -1";
            return Err(part.wrong(what, want));
        }
    }
    Ok((sets, motors, rotors))
}

/// Returns the mass, kg, up to which a part is treated as massless.
fn negligible_mass(parts: &[ImportedPart]) -> f64 {
    super::family::NEGLIGIBLE_MASS * parts.iter().map(|part| part.mass).sum::<f64>()
}

fn motor(joint: Node<'_, '_>, from: Option<usize>) -> Result<ImportedMotor, ImportError> {
    let limit = child(joint, "limit");
    let bound = |name: &'static str| -> Result<Option<f64>, ImportError> {
        let most = limit.map(|limit| number(limit, name)).transpose()?.flatten();
        Ok(most.filter(|most| *most > 0.0 && *most < UNLIMITED))
    };
    let name = joint.attribute("name").unwrap_or("joint").into();
    Ok(ImportedMotor {
        name,
        from,
        torque_limit: bound("effort")?,
        speed_limit: bound("velocity")?,
        ..ImportedMotor::default()
    })
}

/// Reads the limits of a joint, rad about the common axis.
fn range(joint: Node<'_, '_>, sign: f64) -> Result<Option<[f64; 2]>, ImportError> {
    let Some(limit) = child(joint, "limit").filter(|_| joint.attribute("type") == Some("revolute")) else {
        return Ok(None);
    };
    match (number(limit, "lower")?, number(limit, "upper")?) {
        (None, None) => Ok(None),
        (least, most) => {
            let (least, most) = (least.unwrap_or(0.0), most.unwrap_or(0.0));
            match least > most {
                true => Err(element_error(
                    joint,
                    format!("limits from {} to {}", ShortNumber(least), ShortNumber(most)),
                    "lower not above upper",
                )),
                false if sign < 0.0 => Ok(Some([-most, -least])),
                false => Ok(Some([least, most])),
            }
        }
    }
}

/// Finds the end effector: a part with a usual name of end effectors, or else the only fixed part without mass and
/// children.
fn end(parts: &[ImportedPart], owners: &[Option<usize>]) -> Option<(usize, Vector3<f64>)> {
    let ranked = parts.iter().enumerate().filter_map(|(i, part)| Some((end_rank(&part.name)?, i)));
    let named = ranked.min().map(|(_, i)| i);
    let is_leaf = |i: usize| !parts.iter().any(|other| other.parent == Some(i));
    let mut bare = (0..parts.len()).filter(|i| parts[*i].hinge.is_none() && parts[*i].mass == 0.0 && is_leaf(*i));
    let only = bare.next().filter(|_| bare.next().is_none());
    let end = named.or(only)?;
    Some((owners[end]?, parts[end].frame.translation.vector))
}
