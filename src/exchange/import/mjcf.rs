//! MJCF: loops, tendons and equalities say what turns together, actuators what turns it.

mod actuators;
mod coupled;
mod loops;

use nalgebra::Vector3;
use roxmltree::Node;

use super::bodies::{Bodies, is_active, polynomial};
use super::defaults::Element;
use super::linkage::{Limit, Linkage, MOST_PARTS, Motor};
use super::read::{Source, child, each, numbers, several, vector};
use super::refusal::{ImportError, wrong};
use crate::settings::number::Short;
use crate::settings::range::clipped;
use coupled::{Against, Coupled, Geared, Sum, unsigned};

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
    let mut coupled = Coupled::of(Bodies::of(model)?)?;
    coupled.couple()?;
    coupled.linkage()
}

/// A sum, what it is in the reference pose, and its least and greatest, rad.
type Limited = (Sum, f64, [f64; 2]);

/// Two sums of hinges, one so many times the other.
struct Coupling<'a> {
    node: Node<'a, 'a>,
    one: Sum,
    other: Sum,
    ratio: f64,
}

impl<'a> Coupled<'a> {
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
}

/// N of a coupling that is linear.
fn linear(element: &Element<'_>) -> Result<f64, ImportError> {
    match polynomial(element)?[..] {
        [_, ratio, ref rest @ ..] if rest.iter().all(|x| *x == 0.0) => Ok(ratio),
        _ => Err(wrong(element.node(), "a coupling that is not linear", "polycoef=\"0 N 0 0 0\"")),
    }
}
