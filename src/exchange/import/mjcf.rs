//! MJCF: loops, tendons and equalities say what turns together, actuators what turns it.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use roxmltree::Node;

use super::bodies::{Bodies, End};
use super::linkage::{Limit, Linkage, MOST_PARTS, Motor, common_axis, owners, plane};
use super::read::{child, each, number, numbers, several, vector, word};
use super::refusal::{ImportError, wrong};
use crate::mechanics::planar::{MAX_DRIVES, Vector};
use crate::settings::range::clipped;

/// Vectors of a loop whose sum is below this share of the largest cancel.
const CLOSED: f64 = 1e-9;
/// The most parts in one loop.
const MOST_IN_LOOP: usize = 12;
/// Names by which others know the point that works.
const ENDS: [&str; 6] = ["end effector", "end_effector", "ee", "tool", "tcp", "tip"];

/// Of a `<mujoco>`.
///
/// # Errors
/// What is outside of the family.
pub fn linkage(model: Node<'_, '_>) -> Result<Linkage, ImportError> {
    Coupled::of(Bodies::of(model)?)?.linkage()
}

/// Which sets turn together; the last is the base.
struct Together {
    of: Vec<usize>,
}

impl Together {
    fn new(parts: usize) -> Self {
        Self { of: (0..=parts).collect() }
    }

    fn base(&self) -> usize {
        self.of.len() - 1
    }

    fn root(&self, mut i: usize) -> usize {
        while self.of[i] != i {
            i = self.of[i];
        }
        i
    }

    /// Both turn as one; the base, or else the first of them, stands for both.
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (stands, follows) = if b == self.base() { (b, a) } else { (a.min(b), a.max(b)) };
        let (stands, follows) = if a == self.base() { (a, b) } else { (stands, follows) };
        self.of[follows] = stands;
    }
}

/// A set, and one against which it turns.
type Against = (usize, usize);
/// Hinges, each with how much its angle about the common axis counts.
type Sum = Vec<(usize, f64)>;
/// A sum, what it is in the reference pose, and its least and greatest, rad.
type Limited = (Sum, f64, [f64; 2]);

/// A part that is coupled to a sum of hinges, and how often it turns for one turn of that.
struct Geared<'a> {
    part: usize,
    node: Node<'a, 'a>,
    to: Sum,
    ratio: f64,
}

/// Bodies, and what their loops and equalities keep together.
struct Coupled<'a> {
    bodies: Bodies<'a>,
    signs: Vec<f64>,
    /// Two axes of the plane.
    plane: [Vector3<f64>; 3],
    owners: Vec<Option<usize>>,
    /// What stands for the base among the parts.
    base: usize,
    tendons: BTreeMap<&'a str, Sum>,
    together: Together,
    geared: Vec<Geared<'a>>,
    loops: Vec<[End; 2]>,
}

impl<'a> Coupled<'a> {
    fn of(bodies: Bodies<'a>) -> Result<Self, ImportError> {
        let (normal, signs) = common_axis(&bodies.parts)?;
        let (owners, base) = (owners(&bodies.parts), bodies.parts.len());
        let tendons = tendons(&bodies, &signs)?;
        let mut coupled = Self {
            signs,
            plane: plane(&normal),
            owners,
            base,
            tendons,
            together: Together::new(base),
            geared: Vec::new(),
            loops: Vec::new(),
            bodies,
        };
        coupled.couple()?;
        Ok(coupled)
    }

    /// Reads the equalities; loops come last, for they are seen better the more is known to be parallel.
    fn couple(&mut self) -> Result<(), ImportError> {
        let equality = child(self.bodies.model, "equality");
        let all: Vec<Node<'a, 'a>> =
            equality.into_iter().flat_map(|node| node.children()).filter(Node::is_element).collect();
        let (loops, others): (Vec<_>, Vec<_>) = all.into_iter().partition(|node| node.has_tag_name("connect"));
        for node in others {
            match node.tag_name().name() {
                "joint" => self.gear_of_joint(node)?,
                "tendon" => self.tendon_equality(node)?,
                kind => {
                    let what = format!("an equality of kind \"{}\"", clipped(kind));
                    return Err(wrong(node, what, "connect, joint or tendon"));
                }
            }
        }
        for node in loops {
            let ends = self.bodies.ends(node)?;
            self.close(node, &ends)?;
            self.loops.push(ends);
        }
        Ok(())
    }

    fn gear_of_joint(&mut self, node: Node<'a, 'a>) -> Result<(), ImportError> {
        let part = self.bodies.part_of(node, "joint1")?;
        if !node.has_attribute("joint2") {
            return Err(wrong(node, "a joint that is held", "a rotor coupled to a hinge that moves"));
        }
        let of = self.bodies.part_of(node, "joint2")?;
        let ratio = linear(node)? * self.signs[part] * self.signs[of];
        self.geared.push(Geared { part, node, to: vec![(of, 1.0)], ratio });
        Ok(())
    }

    fn tendon_equality(&mut self, node: Node<'a, 'a>) -> Result<(), ImportError> {
        let one = self.tendon(node, "tendon1")?;
        if !node.has_attribute("tendon2") {
            let (to, from) = self.turned(node, &one)?;
            self.together.join(to, from);
            return Ok(());
        }
        let [(part, times)] = one[..] else {
            return Err(wrong(node, "tendon1 is of several hinges", "that of a rotor alone"));
        };
        let ratio = linear(node)? * times;
        self.geared.push(Geared { part, node, to: self.tendon(node, "tendon2")?, ratio });
        Ok(())
    }

    fn tendon(&self, node: Node<'_, '_>, attribute: &'static str) -> Result<Sum, ImportError> {
        let name = word(node, attribute)?;
        let what = || format!("{attribute} \"{}\" is no fixed tendon", clipped(name));
        self.tendons.get(name).cloned().ok_or_else(|| wrong(node, what(), "the name of one"))
    }

    /// What moves with a part: itself or what it is fixed to.
    fn owner(&self, part: Option<usize>) -> usize {
        part.and_then(|part| self.owners[part]).unwrap_or(self.base)
    }

    /// What carries a hinge.
    fn on(&self, part: usize) -> usize {
        self.owner(self.bodies.parts[part].parent)
    }

    fn set(&self, part: usize) -> usize {
        self.together.root(part)
    }

    /// Which part turns against which by a sum of hinges.
    fn against(&self, sum: &[(usize, f64)]) -> Option<Against> {
        let mut turns: BTreeMap<usize, f64> = BTreeMap::new();
        for (part, times) in sum {
            *turns.entry(self.owner(Some(*part))).or_default() += times;
            *turns.entry(self.on(*part)).or_default() -= times;
        }
        turns.retain(|_, times| *times != 0.0);
        let of = |times: f64| turns.iter().find(|(_, own)| **own == times).map(|(part, _)| *part);
        (turns.len() == 2).then(|| Some((of(1.0)?, of(-1.0)?))).flatten()
    }

    fn turned(&self, node: Node<'_, '_>, sum: &[(usize, f64)]) -> Result<Against, ImportError> {
        let want = "a sum of hinges from one body to another";
        self.against(sum).ok_or_else(|| wrong(node, "no body turns against another by its tendon", want))
    }

    /// What a loop keeps parallel: opposite sides of parallelograms.
    fn close(&mut self, node: Node<'_, '_>, ends: &[End; 2]) -> Result<(), ImportError> {
        let sides = self.sides(ends);
        let largest = sides.iter().fold(0.0_f64, |most, (_, v)| most.max(v.norm()));
        let is_none = |v: Vector| v.norm() <= CLOSED * largest;
        // What turns as one is one side.
        let mut merged: Vec<(usize, Vector)> = Vec::new();
        for (i, v) in sides {
            let set = self.together.root(i);
            match merged.iter_mut().find(|(other, _)| *other == set) {
                Some((_, sum)) => *sum += v,
                None => merged.push((set, v)),
            }
        }
        merged.retain(|(_, v)| !is_none(*v));
        let total: Vector = merged.iter().map(|(_, v)| v).sum();
        if !is_none(total) || merged.len() > MOST_IN_LOOP {
            return Err(wrong(
                node,
                "its ends are apart in the pose of the file",
                "a keyframe in which every loop is closed",
            ));
        }
        // Opposite sides first, which neighbours of equal length must not be taken for.
        while !merged.is_empty() {
            let count = merged.len();
            let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
            let pairs = pairs.filter(|(a, b)| is_none(merged[*a].1 + merged[*b].1));
            let apart = |(a, b): &(usize, usize)| (b - a).min(count - (b - a));
            let Some((a, b)) = pairs.max_by_key(apart) else {
                return Err(wrong(node, "a loop that is no parallelogram", "loops whose opposite sides are equal"));
            };
            self.together.join(merged[a].0, merged[b].0);
            merged.remove(b);
            merged.remove(a);
        }
        Ok(())
    }

    /// Each part from its hinge to the next, around the loop.
    fn sides(&self, ends: &[End; 2]) -> Vec<(usize, Vector)> {
        let flat = |p: Vector3<f64>| Vector::new(self.plane[0].dot(&p), self.plane[1].dot(&p));
        let mut sides: Vec<(usize, Vector)> = Vec::new();
        for (direction, (part, at)) in [(1.0, ends[0]), (-1.0, ends[1])] {
            let (mut at, mut part) = (flat(at), part.and_then(|part| self.owners[part]));
            let mut own = Vec::new();
            while let Some(i) = part {
                let root = flat(self.bodies.parts[i].hinge.map_or(Vector3::zeros(), |(_, on)| on));
                own.push((i, direction * (at - root)));
                at = root;
                part = self.bodies.parts[i].parent.and_then(|parent| self.owners[parent]);
            }
            own.push((self.base, direction * at));
            if direction > 0.0 {
                own.reverse();
            }
            sides.extend(own);
        }
        sides
    }

    /// Motors with what they turn, as sets.
    fn motors(&self) -> Result<Vec<(Motor, Against)>, ImportError> {
        let mut motors = Vec::new();
        let actuators = child(self.bodies.model, "actuator");
        for node in actuators.into_iter().flat_map(|node| node.children()).filter(Node::is_element) {
            if motors.len() == MAX_DRIVES {
                return Err(wrong(node, "too many motors", format!("at most {MAX_DRIVES}")));
            }
            let sum = match node.attribute("joint") {
                Some(_) => vec![(self.bodies.part_of(node, "joint")?, 1.0)],
                None => self.tendon(node, "tendon")?,
            };
            let (to, from) = self.turned(node, &sum)?;
            // The base is turned by no motor.
            let (to, from) = if to == self.base { (from, to) } else { (to, from) };
            motors.push((motor(node)?, (self.set(to), self.set(from))));
        }
        Ok(if motors.is_empty() { self.usual_motors() } else { motors })
    }

    /// A motor in the first hinge of each set.
    fn usual_motors(&self) -> Vec<(Motor, Against)> {
        let (mut seen, mut motors) = (vec![self.base], Vec::new());
        for (i, part) in self.bodies.parts.iter().enumerate().filter(|(_, part)| part.hinge.is_some()) {
            let is_geared = self.geared.iter().any(|geared| geared.part == i);
            if !seen.contains(&self.set(i)) && !is_geared {
                seen.push(self.set(i));
                let motor = Motor { name: part.name.clone(), from: None, torque_limit: None, speed_limit: None };
                motors.push((motor, (self.set(i), self.set(self.on(i)))));
            }
        }
        motors
    }

    /// Motors with the number of the set that carries each.
    fn numbered(&self, motors: &[(Motor, Against)]) -> Result<Vec<Motor>, ImportError> {
        let number_of = |set: usize| motors.iter().position(|(_, (to, _))| *to == set);
        let numbered = |(k, (motor, (to, from))): (usize, &(Motor, Against))| {
            let said = |what: &str| format!("\"{}\" {what}", clipped(&motor.name));
            if number_of(*to) != Some(k) || *to == self.base {
                let what = said("turns what another motor turns, or nothing");
                return Err(ImportError::whole(what, "one motor for each set of parallel bodies"));
            }
            let from = match *from {
                from if from == self.base => None,
                from => Some(number_of(from).ok_or_else(|| {
                    ImportError::whole(said("sits on what no motor turns"), "a motor for every drive")
                })?),
            };
            Ok(Motor { from, ..motor.clone() })
        };
        motors.iter().enumerate().map(numbered).collect()
    }

    /// Parts that are rotors, the motor of each, and how often it turns for one turn of that.
    fn rotors(&self, motors: &[(Motor, Against)]) -> Result<Vec<(usize, usize, f64)>, ImportError> {
        let rotor = |geared: &Geared| {
            let turned = self.against(&geared.to).map(|(to, from)| (self.set(to), self.set(from)));
            let k = motors.iter().position(|(_, against)| Some(*against) == turned);
            let is_leaf = !self.bodies.parts.iter().any(|part| part.parent == Some(geared.part));
            let sits = |k: &usize| motors[*k].1.1 == self.set(self.on(geared.part));
            k.filter(|k| is_leaf && sits(k)).map(|k| (geared.part, k, geared.ratio)).ok_or_else(|| {
                let want = "a rotor on what carries its motor, coupled to what the motor turns";
                wrong(geared.node, "it couples what is no rotor and motor", want)
            })
        };
        self.geared.iter().map(rotor).collect()
    }

    /// The motor that turns each part in the end.
    fn sets(
        &self,
        motors: &[(Motor, Against)],
        rotors: &[(usize, usize, f64)],
    ) -> Result<Vec<Option<usize>>, ImportError> {
        let set = |(i, part): (usize, &super::linkage::Part)| {
            let own = self.owner(Some(i));
            let k = motors.iter().position(|(_, (to, _))| own != self.base && *to == self.set(own));
            let is_rotor = rotors.iter().any(|(rotor, ..)| *rotor == i);
            match k.is_some() || own != i || is_rotor || self.set(own) == self.base {
                true => Ok(k),
                false => {
                    let what = "no motor turns it, and nothing keeps it parallel to what one turns";
                    Err(part.wrong(what, "a motor, a loop or an equality"))
                }
            }
        };
        self.bodies.parts.iter().enumerate().map(set).collect()
    }

    /// Limits of hinges and tendons that are those of a drive against another.
    fn limits(&self, motors: &[(Motor, Against)], rotors: &[(usize, usize, f64)]) -> Result<Vec<Limit>, ImportError> {
        let number_of = |set: usize| motors.iter().position(|(_, (to, _))| *to == set);
        let hinges = (0..self.base).filter(|i| !rotors.iter().any(|(rotor, ..)| rotor == i));
        let mut limited: Vec<Limited> = hinges.filter_map(|i| self.limits_of(i)).collect();
        limited.extend(self.limits_of_tendons()?);
        let limit = |(sum, now, range): Limited| {
            let (to, from) = self.against(&sum)?;
            let from = if self.set(from) == self.base { None } else { Some(number_of(self.set(from))?) };
            Some(Limit { to: number_of(self.set(to))?, from, now, range })
        };
        Ok(limited.into_iter().filter_map(limit).collect())
    }

    fn limits_of(&self, i: usize) -> Option<Limited> {
        let (now, [least, most]) = (self.bodies.angle(i), self.bodies.range(i)?);
        Some(match self.signs[i] < 0.0 {
            true => (vec![(i, 1.0)], -now, [-most, -least]),
            false => (vec![(i, 1.0)], now, [least, most]),
        })
    }

    fn limits_of_tendons(&self) -> Result<Vec<Limited>, ImportError> {
        let mut all = Vec::new();
        for node in each(self.bodies.model, "tendon").flat_map(|node| each(node, "fixed")) {
            if let Some(range) = several::<2>(node, "range")? {
                let sum = self.tendon(node, "name")?;
                let now = sum.iter().map(|(i, times)| times * self.signs[*i] * self.bodies.angle(*i)).sum();
                all.push((sum, now, range));
            }
        }
        Ok(all)
    }

    fn linkage(self) -> Result<Linkage, ImportError> {
        let motors = self.motors()?;
        let (numbered, rotors) = (self.numbered(&motors)?, self.rotors(&motors)?);
        let (sets, limits) = (self.sets(&motors, &rotors)?, self.limits(&motors, &rotors)?);
        let model = self.bodies.model;
        let gravity = child(model, "option").map(|node| vector(node, "gravity")).transpose()?.flatten();
        let end = ENDS.iter().find_map(|name| self.bodies.sites.get(name));
        let end = end.and_then(|(part, at)| Some((self.owners[(*part)?]?, *at)));
        let has_meshes = model.descendants().any(|node| node.has_tag_name("mesh"));
        let meshes = "meshes are left out: a machine here is made of bars".to_owned();
        let pins = self.loops.iter().map(|ends| ends.map(|(i, at)| (self.owner(i), at)));
        let loops = pins.filter(|ends| ends.iter().all(|(i, _)| *i != self.base)).collect();
        Ok(Linkage {
            name: model.attribute("model").unwrap_or("model").into(),
            gravity: gravity.unwrap_or(Vector3::new(0.0, 0.0, -9.81)),
            sets,
            motors: numbered,
            limits,
            rotors,
            loops,
            end,
            notes: if has_meshes { vec![meshes] } else { Vec::new() },
            parts: self.bodies.parts,
        })
    }
}

/// Fixed tendons by name.
fn tendons<'a>(bodies: &Bodies<'a>, signs: &[f64]) -> Result<BTreeMap<&'a str, Sum>, ImportError> {
    let mut all = BTreeMap::new();
    for node in each(bodies.model, "tendon").flat_map(|node| each(node, "fixed")) {
        let mut sum = Vec::new();
        for joint in each(node, "joint").take(MOST_PARTS) {
            let part = bodies.part_of(joint, "joint")?;
            sum.push((part, signs[part] * number(joint, "coef")?.unwrap_or(1.0)));
        }
        all.insert(word(node, "name")?, sum);
    }
    Ok(all)
}

fn motor(node: Node<'_, '_>) -> Result<Motor, ImportError> {
    let name = node.attribute("name").unwrap_or("motor").to_owned();
    let gear = numbers(node, "gear")?.and_then(|gear| gear.first().copied()).unwrap_or(1.0);
    let range = several::<2>(node, "ctrlrange")?.filter(|_| node.has_tag_name("motor"));
    let torque = range.map(|[least, most]| gear.abs() * least.abs().max(most.abs()));
    Ok(Motor { name, from: None, torque_limit: torque.filter(|x| *x > 0.0), speed_limit: None })
}

/// N of a coupling that is linear.
fn linear(node: Node<'_, '_>) -> Result<f64, ImportError> {
    let all = numbers(node, "polycoef")?.unwrap_or_else(|| vec![0.0, 1.0]);
    match all[..] {
        [_, ratio, ref rest @ ..] if rest.iter().all(|x| *x == 0.0) => Ok(ratio),
        _ => Err(wrong(node, "a coupling that is not linear", "polycoef=\"0 N 0 0 0\"")),
    }
}
