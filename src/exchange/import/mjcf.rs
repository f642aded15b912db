//! MJCF: loops, tendons and equalities say what turns together, actuators what turns it.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use roxmltree::Node;

use super::bodies::{Bodies, End, is_active, polynomial};
use super::defaults::Element;
use super::linkage::{Limit, Linkage, MOST_PARTS, Motor, common_axis, owners, plane};
use super::read::{Source, child, each, number, numbers, several, vector, word};
use super::refusal::{ImportError, wrong};
use crate::mechanics::planar::{MAX_DRIVES, Vector};
use crate::settings::number::Short;
use crate::settings::range::clipped;

/// Vectors of a loop whose sum is below this share of the largest cancel.
const CLOSED: f64 = 1e-9;
/// The most parts in one loop.
const MOST_IN_LOOP: usize = 12;
/// A tendon is where an equality wants it if it is off by less, rad.
const HELD: f64 = 1e-6;
/// A centre of mass is on an axis if it is off by less than this share of the distance, or of a metre.
const ON_AXIS: f64 = 1e-9;

/// What couplings may do.
const PARALLEL_WANTED: &str = "a rotor on what carries its motor, coupled to what that turns, or hinges whose coupling by \
                               1 or -1 keeps two bodies parallel";

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

/// Two sums of hinges, one so many times the other.
struct Coupling<'a> {
    node: Node<'a, 'a>,
    one: Sum,
    other: Sum,
    ratio: f64,
}

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
        let all = each(self.bodies.model, "equality").flat_map(|node| node.children()).filter(Node::is_element);
        let (mut loops, mut couplings) = (Vec::new(), Vec::new());
        for (count, node) in all.enumerate() {
            if count == MOST_PARTS {
                return Err(wrong(node, "too many equalities", format!("at most {MOST_PARTS}")));
            }
            let element = self.bodies.element(node)?;
            if !is_active(&element) {
                continue;
            }
            match node.tag_name().name() {
                "connect" => loops.push(node),
                "joint" => couplings.extend(self.joint_equality(&element)?),
                "tendon" => couplings.extend(self.tendon_equality(&element)?),
                kind => {
                    let what = format!("an equality of kind \"{}\"", clipped(kind));
                    return Err(wrong(node, what, "connect, joint or tendon"));
                }
            }
        }
        let driven = self.driven()?;
        let (rotors, mut others): (Vec<_>, Vec<_>) =
            couplings.into_iter().partition(|coupling| self.is_rotor(coupling, &driven));
        self.join_parallel(&mut others);
        for node in loops {
            let ends = self.bodies.ends(node)?;
            self.close(node, &ends)?;
            self.loops.push(ends);
        }
        self.join_parallel(&mut others);
        for Coupling { node, one, other, ratio } in rotors.into_iter().chain(others) {
            let [(part, times)] = one[..] else {
                return Err(wrong(node, "it couples sums of hinges that keep no bodies parallel", PARALLEL_WANTED));
            };
            self.geared.push(Geared { part, node, to: other, ratio: ratio * times });
        }
        Ok(())
    }

    /// Joins what couplings keep parallel, and drops these: of A − B = ±(C − D), one side of which is among the other.
    fn join_parallel(&mut self, couplings: &mut Vec<Coupling<'a>>) {
        let mut count = usize::MAX;
        while couplings.len() < count {
            count = couplings.len();
            couplings.retain(|coupling| !self.is_parallel(coupling));
        }
    }

    fn is_parallel(&mut self, coupling: &Coupling<'a>) -> bool {
        let (Some((a, b)), Some((c, d))) = (self.against(&coupling.one), self.against(&coupling.other)) else {
            return false;
        };
        let (more, less) = match coupling.ratio {
            1.0 => ([a, d], [b, c]),
            -1.0 => ([a, c], [b, d]),
            _ => return false,
        };
        let pairs = (0..4).map(|i| (i / 2, i % 2));
        let same = pairs.into_iter().find(|(i, j)| self.set(more[*i]) == self.set(less[*j]));
        if let Some((i, j)) = same {
            self.together.join(more[1 - i], less[1 - j]);
        }
        same.is_some()
    }

    /// Whether it is of a rotor: a body that carries nothing, balanced about its hinge, coupled to what a motor turns.
    fn is_rotor(&self, coupling: &Coupling<'a>, driven: &[Sum]) -> bool {
        let [(part, _)] = coupling.one[..] else { return false };
        let parts = &self.bodies.parts;
        let carries = parts.iter().any(|other| other.parent == Some(part))
            || self.bodies.sites.iter().any(|(_, (own, _))| *own == Some(part));
        let off = parts[part].hinge.map_or(0.0, |(axis, on)| {
            let away = parts[part].com - on;
            (away - axis.into_inner() * axis.dot(&away)).norm() / away.norm().max(1.0)
        });
        !carries && off <= ON_AXIS && driven.contains(&unsigned(&coupling.other))
    }

    /// Sums that motors turn.
    fn driven(&self) -> Result<Vec<Sum>, ImportError> {
        self.actuators()?.into_iter().map(|(element, _)| Ok(unsigned(&self.moved(&element)?))).collect()
    }

    fn joint_equality(&mut self, element: &Element<'a>) -> Result<Option<Coupling<'a>>, ImportError> {
        let node = element.node();
        let part = self.bodies.part_of(node, "joint1")?;
        if !node.has_attribute("joint2") {
            self.together.join(self.owner(Some(part)), self.on(part));
            return Ok(None);
        }
        let of = self.bodies.part_of(node, "joint2")?;
        let ratio = linear(element)? * self.signs[part] * self.signs[of];
        Ok(Some(Coupling { node, one: vec![(part, 1.0)], other: vec![(of, 1.0)], ratio }))
    }

    fn tendon_equality(&mut self, element: &Element<'a>) -> Result<Option<Coupling<'a>>, ImportError> {
        let node = element.node();
        let one = self.tendon(node, "tendon1")?;
        let factors = polynomial(element)?;
        let other = node.has_attribute("tendon2").then(|| self.tendon(node, "tendon2")).transpose()?;
        let x = other.as_ref().map_or(0.0, |other| self.stretch(other));
        let off = self.stretch(&one) - factors.iter().rev().fold(0.0, |sum, factor| sum * x + factor);
        match other {
            // A gear may have any angle.
            None if off.abs() > HELD => {
                let what = format!("its tendon is off by {} rad in the pose of the file", Short(off));
                Err(wrong(node, what, "a keyframe in which every equality holds"))
            }
            None => {
                let (to, from) = self.turned(node, &one)?;
                self.together.join(to, from);
                Ok(None)
            }
            Some(other) => Ok(Some(Coupling { node, one, other, ratio: linear(element)? })),
        }
    }

    /// How far a sum of hinges is from where it is drawn, rad.
    fn stretch(&self, sum: &[(usize, f64)]) -> f64 {
        sum.iter()
            .map(|(i, times)| times * self.signs[*i] * (self.bodies.angle(*i) - self.bodies.drawn_angle(*i)))
            .sum()
    }

    fn tendon(&self, element: impl Source<'a>, attribute: &'static str) -> Result<Sum, ImportError> {
        let name = word(&element, attribute)?;
        let what = || format!("{attribute} \"{}\" is no fixed tendon", clipped(name));
        self.tendons.get(name).cloned().ok_or_else(|| wrong(element.node(), what(), "the name of one"))
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

    /// Actuators with their names; of several that turn the same the first, with all their torques.
    fn actuators(&self) -> Result<Vec<(Element<'a>, Motor)>, ImportError> {
        let all = each(self.bodies.model, "actuator").flat_map(|node| node.children()).filter(Node::is_element);
        let mut found: Vec<(Element, Motor)> = Vec::new();
        for (count, node) in all.enumerate() {
            if count == MOST_PARTS {
                return Err(wrong(node, "too many actuators", format!("at most {MOST_PARTS}")));
            }
            let element = self.bodies.element(node)?;
            let (own, sum) = (self.motor(&element)?, unsigned(&self.moved(&element)?));
            let mut known = None;
            for (i, (element, _)) in found.iter().enumerate() {
                if unsigned(&self.moved(element)?) == sum {
                    known = Some(i);
                }
            }
            match known {
                Some(i) => {
                    let motor = &mut found[i].1;
                    motor.torque_limit = motor.torque_limit.zip(own.torque_limit).map(|(a, b)| a + b);
                }
                None if found.len() == MAX_DRIVES => {
                    return Err(wrong(node, "too many motors", format!("at most {MAX_DRIVES}")));
                }
                None => found.push((element, own)),
            }
        }
        for (_, motor) in &mut found {
            if let Some(hinge) = motor.hinge.and_then(|i| self.bodies.hinge(i)) {
                // What the hinge bears at most is a limit, too.
                let bears = self.largest(hinge, "actuatorfrcrange", "actuatorfrclimited")?;
                motor.torque_limit = motor.torque_limit.into_iter().chain(bears).reduce(f64::min);
            }
        }
        Ok(found)
    }

    /// The hinges that an actuator turns.
    fn moved(&self, element: &Element<'a>) -> Result<Sum, ImportError> {
        for attribute in ["joint", "jointinparent"] {
            if element.get(attribute).is_some() {
                return Ok(vec![(self.bodies.part_of(element, attribute)?, 1.0)]);
            }
        }
        match element.get("tendon") {
            Some(_) => self.tendon(element, "tendon"),
            None => Err(wrong(element.node(), "an actuator of no joint or tendon", "joint=\"…\" or tendon=\"…\"")),
        }
    }

    /// Motors with what they turn, as sets.
    fn motors(&self) -> Result<Vec<(Motor, Against)>, ImportError> {
        let mut motors = Vec::new();
        for (element, motor) in self.actuators()? {
            let (to, from) = self.turned(element.node(), &self.moved(&element)?)?;
            // The base is turned by no motor.
            let (to, from) = if to == self.base { (from, to) } else { (to, from) };
            motors.push((motor, (self.set(to), self.set(from))));
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
                let of_hinge = self.bodies.hinge(i).and_then(|hinge| hinge.node().attribute("name"));
                let name = of_hinge.map_or_else(|| part.name.clone(), Into::into);
                let motor = Motor { name, hinge: Some(i), ..Motor::default() };
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
            k.filter(|k| is_leaf && sits(k))
                .map(|k| (geared.part, k, geared.ratio))
                .ok_or_else(|| wrong(geared.node, "it couples what is no rotor and motor", PARALLEL_WANTED))
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
            Some(Limit { name: None, to: number_of(self.set(to))?, from, now, range: Some(range) })
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
            let element = self.bodies.element(node)?;
            if let Some(range) = several::<2>(&element, "range")?.filter(|_| self.bodies.is_limit(&element, "limited"))
            {
                let sum = self.tendon(node, "name")?;
                let now = sum.iter().map(|(i, times)| times * self.signs[*i] * self.bodies.angle(*i)).sum();
                all.push((sum, now, range));
            }
        }
        Ok(all)
    }

    /// What of a model belongs elsewhere or is left out.
    fn notes(&self) -> Result<Vec<String>, ImportError> {
        let model = self.bodies.model;
        let mut notes = Vec::new();
        if model.descendants().any(|node| node.has_tag_name("mesh")) {
            notes.push("meshes are left out: a machine here is made of bars".to_owned());
        }
        for (name, what) in [("damping", "damping"), ("frictionloss", "friction"), ("stiffness", "stiffness")] {
            let hinges = (0..self.base).filter_map(|i| self.bodies.hinge(i));
            let mut values = hinges.map(|hinge| Ok(numbers(hinge, name)?.unwrap_or_default()));
            if values.try_fold(false, |any, all: Result<Vec<f64>, ImportError>| {
                Ok::<_, ImportError>(any || all?.iter().any(|x| *x != 0.0))
            })? {
                notes.push(format!("{what} of joints is left out: friction belongs into the plant of a scenario"));
            }
        }
        Ok(notes)
    }

    /// What hinges add to the inertia of their angles, kg m²: that of a motor is taken along.
    fn armatures(&self, motors: &mut [Motor], rotors: &[(usize, usize, f64)]) -> Result<(), ImportError> {
        for i in 0..self.base {
            let Some(hinge) = self.bodies.hinge(i) else { continue };
            let armature = number(hinge, "armature")?.filter(|x| *x != 0.0);
            let Some(armature) = armature.filter(|_| !rotors.iter().any(|(rotor, ..)| *rotor == i)) else { continue };
            let k = motors.iter().position(|motor| motor.hinge == Some(i));
            let k = k.filter(|k| armature > 0.0 && !rotors.iter().any(|(_, of, _)| of == k));
            let Some(k) = k else {
                let want = "one that is above 0, of a hinge that a motor without a rotor turns";
                return Err(wrong(hinge.node(), format!("an armature of {} kg m²", Short(armature)), want));
            };
            motors[k].armature = armature;
        }
        Ok(())
    }

    fn linkage(mut self) -> Result<Linkage, ImportError> {
        let motors = self.motors()?;
        let (mut numbered, rotors) = (self.numbered(&motors)?, self.rotors(&motors)?);
        self.armatures(&mut numbered, &rotors)?;
        let (sets, limits) = (self.sets(&motors, &rotors)?, self.limits(&motors, &rotors)?);
        let model = self.bodies.model;
        let gravity = child(model, "option").map(|node| vector(node, "gravity")).transpose()?.flatten();
        let mut notes = self.notes()?;
        let end = self.bodies.end().and_then(|(part, at)| Some((self.owners[part?]?, at)));
        notes.append(&mut self.bodies.notes);
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
            ground: None,
            notes,
            parts: self.bodies.parts,
        })
    }

    /// A motor by its own name, else by that of what it turns.
    fn motor(&self, element: &Element<'a>) -> Result<Motor, ImportError> {
        let own = ["name", "joint", "jointinparent", "tendon"].into_iter().find_map(|name| element.get(name));
        let name = own.unwrap_or("motor").to_owned();
        let gear = numbers(element, "gear")?.and_then(|gear| gear.first().copied()).unwrap_or(1.0).abs();
        let is_motor = element.node().has_tag_name("motor");
        let of_control = if is_motor { self.largest(element, "ctrlrange", "ctrllimited")? } else { None };
        let of_force = self.largest(element, "forcerange", "forcelimited")?;
        let limit = of_control.into_iter().chain(of_force).reduce(f64::min);
        let hinge = match self.moved(element)?[..] {
            [(part, _)] => Some(part),
            _ => None,
        };
        Ok(Motor { name, hinge, torque_limit: limit.map(|x| gear * x).filter(|x| *x > 0.0), ..Motor::default() })
    }

    /// The largest number of a range that is a limit, either way.
    fn largest(
        &self,
        element: &Element<'a>,
        range: &'static str,
        limited: &'static str,
    ) -> Result<Option<f64>, ImportError> {
        let range = several::<2>(element, range)?.filter(|_| self.bodies.is_limit(element, limited));
        Ok(range.map(|[least, most]| least.abs().max(most.abs())).filter(|most| *most > 0.0))
    }
}

/// A sum whose first hinge counts once or more, in the order of its hinges.
fn unsigned(sum: &[(usize, f64)]) -> Sum {
    let mut sum = sum.to_vec();
    sum.sort_by_key(|(part, _)| *part);
    if sum.first().is_some_and(|(_, times)| *times < 0.0) {
        sum.iter_mut().for_each(|(_, times)| *times = -*times);
    }
    sum
}

/// Fixed tendons by name.
fn tendons<'a>(bodies: &Bodies<'a>, signs: &[f64]) -> Result<BTreeMap<&'a str, Sum>, ImportError> {
    let mut all = BTreeMap::new();
    let fixed = each(bodies.model, "tendon").flat_map(|node| each(node, "fixed"));
    for (count, node) in fixed.enumerate() {
        if count == MOST_PARTS || each(node, "joint").nth(MOST_PARTS).is_some() {
            return Err(wrong(node, "too many tendons, or hinges of one", format!("at most {MOST_PARTS}")));
        }
        let mut sum = Vec::new();
        for joint in each(node, "joint") {
            let part = bodies.part_of(joint, "joint")?;
            sum.push((part, signs[part] * number(joint, "coef")?.unwrap_or(1.0)));
        }
        all.insert(word(node, "name")?, sum);
    }
    Ok(all)
}

/// N of a coupling that is linear.
fn linear(element: &Element<'_>) -> Result<f64, ImportError> {
    match polynomial(element)?[..] {
        [_, ratio, ref rest @ ..] if rest.iter().all(|x| *x == 0.0) => Ok(ratio),
        _ => Err(wrong(element.node(), "a coupling that is not linear", "polycoef=\"0 N 0 0 0\"")),
    }
}
