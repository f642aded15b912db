//! Actuators: the motors of a model, and the bodies that they turn.

use roxmltree::Node;

use super::coupled::{CoupledBodies, HingeSum, RelativeSet, unsigned};
use crate::import::defaults::Element;
use crate::import::linkage::{ImportedMotor, MAX_PARTS};
use crate::import::read::{AttributeSource, each, number, numbers, several};
use crate::import::refusal::{ImportError, element_error};
use stillbase_mechanics::planar::MAX_DRIVES;
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::quote_clipped;

impl<'a> CoupledBodies<'a> {
    /// Returns the actuators as motors. Several actuators that turn the same sum of hinges become one motor, with the
    /// sum of their torque limits.
    pub(super) fn actuators(&self) -> Result<Vec<(Element<'a>, ImportedMotor)>, ImportError> {
        let all = each(self.bodies.model, "actuator").flat_map(|node| node.children()).filter(Node::is_element);
        let mut found: Vec<(Element, ImportedMotor)> = Vec::new();
        for (count, node) in all.enumerate() {
            if count == MAX_PARTS {
                return Err(element_error(node, "too many actuators", format!("at most {MAX_PARTS}")));
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
                    return Err(element_error(node, "too many motors", format!("at most {MAX_DRIVES}")));
                }
                None => found.push((element, own)),
            }
        }
        for (_, motor) in &mut found {
            if let Some(hinge) = motor.hinge.and_then(|i| self.bodies.hinge(i)) {
                // The torque limit of the hinge applies too.
                let of_hinge = self.largest(hinge, "actuatorfrcrange", "actuatorfrclimited")?;
                motor.torque_limit = motor.torque_limit.into_iter().chain(of_hinge).reduce(f64::min);
            }
        }
        Ok(found)
    }

    /// Returns the sum of hinges that an actuator turns.
    pub(super) fn moved(&self, element: &Element<'a>) -> Result<HingeSum, ImportError> {
        for attribute in ["joint", "jointinparent"] {
            if element.get(attribute).is_some() {
                return Ok(vec![(self.bodies.part_of(element, attribute)?, 1.0)]);
            }
        }
        match element.get("tendon") {
            Some(_) => self.tendon(element, "tendon"),
            None => {
                Err(element_error(element.node(), "an actuator of no joint or tendon", "joint=\"…\" or tendon=\"…\""))
            }
        }
    }

    /// Returns the motors, each with the set that it turns and the set relative to which that set turns.
    pub(super) fn motors(&self) -> Result<Vec<(ImportedMotor, RelativeSet)>, ImportError> {
        let mut motors = Vec::new();
        for (element, motor) in self.actuators()? {
            let (to, from) = self.turned(element.node(), &self.moved(&element)?)?;
            // The base comes second, because no motor turns it.
            let (to, from) = if to == self.base { (from, to) } else { (to, from) };
            motors.push((motor, (self.set(to), self.set(from))));
        }
        Ok(if motors.is_empty() { self.usual_motors() } else { motors })
    }

    /// Returns a motor in the first hinge of each set, for models without actuators. Hinges of geared parts get none.
    fn usual_motors(&self) -> Vec<(ImportedMotor, RelativeSet)> {
        let (mut seen, mut motors) = (vec![self.base], Vec::new());
        for (i, part) in self.bodies.parts.iter().enumerate().filter(|(_, part)| part.hinge.is_some()) {
            let is_geared = self.geared.iter().any(|geared| geared.part == i);
            if !seen.contains(&self.set(i)) && !is_geared {
                seen.push(self.set(i));
                let of_hinge = self.bodies.hinge(i).and_then(|hinge| hinge.node().attribute("name"));
                let name = of_hinge.map_or_else(|| part.name.clone(), Into::into);
                let motor = ImportedMotor { name, hinge: Some(i), ..ImportedMotor::default() };
                motors.push((motor, (self.set(i), self.set(self.on(i)))));
            }
        }
        motors
    }

    /// Returns the motors, each with the number of the motor whose set carries it.
    ///
    /// # Errors
    /// If two motors turn the same set, or if no motor turns the set that carries one.
    pub(super) fn numbered(&self, motors: &[(ImportedMotor, RelativeSet)]) -> Result<Vec<ImportedMotor>, ImportError> {
        let number_of = |set: usize| motors.iter().position(|(_, (to, _))| *to == set);
        let numbered = |(k, (motor, (to, from))): (usize, &(ImportedMotor, RelativeSet))| {
            let said = |what: &str| format!("\"{}\" {what}", quote_clipped(&motor.name));
            if number_of(*to) != Some(k) || *to == self.base {
                let what = said("turns what another motor turns, or nothing");
                return Err(ImportError::of_file(what, "one motor for each set of parallel bodies"));
            }
            let from = match *from {
                from if from == self.base => None,
                from => Some(number_of(from).ok_or_else(|| {
                    ImportError::of_file(said("sits on what no motor turns"), "a motor for every drive")
                })?),
            };
            Ok(ImportedMotor { from, ..motor.clone() })
        };
        motors.iter().enumerate().map(numbered).collect()
    }

    /// Adds the armatures of hinges, kg m², to the motors that turn them; ignores those of hinges of rotors.
    ///
    /// # Errors
    /// If an armature is negative, or belongs to a hinge without a motor or to a motor with a rotor.
    pub(super) fn armatures(
        &self,
        motors: &mut [ImportedMotor],
        rotors: &[(usize, usize, f64)],
    ) -> Result<(), ImportError> {
        for i in 0..self.base {
            let Some(hinge) = self.bodies.hinge(i) else { continue };
            let armature = number(hinge, "armature")?.filter(|x| *x != 0.0);
            let Some(armature) = armature.filter(|_| !rotors.iter().any(|(rotor, ..)| *rotor == i)) else { continue };
            let k = motors.iter().position(|motor| motor.hinge == Some(i));
            let k = k.filter(|k| armature > 0.0 && !rotors.iter().any(|(_, of, _)| of == k));
            let Some(k) = k else {
                let want = "one that is above 0, of a hinge that a motor without a rotor turns";
                return Err(element_error(
                    hinge.node(),
                    format!("an armature of {} kg m²", ShortNumber(armature)),
                    want,
                ));
            };
            motors[k].armature = armature;
        }
        Ok(())
    }

    /// Reads a motor; without a name, it gets the name of the joint or tendon that it turns.
    fn motor(&self, element: &Element<'a>) -> Result<ImportedMotor, ImportError> {
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
        Ok(ImportedMotor {
            name,
            hinge,
            torque_limit: limit.map(|x| gear * x).filter(|x| *x > 0.0),
            ..ImportedMotor::default()
        })
    }

    /// Returns the largest magnitude in a range; `None` if the range is no limit.
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
