//! MJCF reader: loops, tendons and equalities determine which bodies turn together; actuators determine the motors.

mod actuators;
mod coupled;
mod equalities;
mod limits;
mod loops;
mod sets;
mod together;

use coupled::CoupledBodies;
use nalgebra::{Matrix3, Vector3};
use roxmltree::Node;

use super::bodies::MjcfBodies;
use super::floating::FloatingBase;
use super::linkage::{Ground, ImportedLinkage};
use super::read::{child, numbers, vector};
use super::refusal::ImportError;
use stillbase_settings::range::quote_clipped;

/// Reads the linkage of a `<mujoco>`.
///
/// # Errors
/// If the model is outside the family of machines.
pub fn linkage(model: Node<'_, '_>) -> Result<ImportedLinkage, ImportError> {
    let mut coupled = CoupledBodies::of(MjcfBodies::of(model)?)?;
    coupled.couple()?;
    coupled.linkage()
}

impl CoupledBodies<'_> {
    fn linkage(mut self) -> Result<ImportedLinkage, ImportError> {
        let motors = self.motors()?;
        let (mut numbered, rotors) = (self.numbered(&motors)?, self.rotors(&motors)?);
        self.armatures(&mut numbered, &rotors)?;
        let (sets, limits) = (self.sets(&motors, &rotors)?, self.limits(&motors, &rotors)?);
        let model = self.bodies.model;
        let gravity = child(model, "option").map(|node| vector(node, "gravity")).transpose()?.flatten();
        let gravity = gravity.unwrap_or(Vector3::new(0.0, 0.0, -9.81));
        let base = self.bodies.floating();
        let gravity = base.map_or(gravity, |base| base.attitude.inverse() * gravity);
        let floats = Ground { mass: 0.0, com: Vector3::zeros(), inertia: Matrix3::zeros(), floats: true };
        let ground = base.map(|_| floats);
        let mut notes = self.notes()?;
        let end = self.bodies.end().and_then(|(part, at)| Some((self.owners[part?]?, at)));
        notes.append(&mut self.bodies.notes);
        let pins = self.loops.iter().map(|ends| ends.map(|(i, at)| (self.owner(i), at)));
        let loops = pins.filter(|ends| ends.iter().all(|(i, _)| *i != self.base)).collect();
        Ok(ImportedLinkage {
            name: model.attribute("model").unwrap_or("model").into(),
            gravity,
            sets,
            motors: numbered,
            limits,
            rotors,
            loops,
            end,
            ground,
            notes,
            parts: self.bodies.parts,
        })
    }

    /// Returns notes on elements of the model that are omitted or belong to a scenario.
    fn notes(&self) -> Result<Vec<String>, ImportError> {
        let model = self.bodies.model;
        let mut notes = Vec::new();
        if let Some(base) = self.bodies.fixed_base() {
            notes.push(format!(
                "the body \"{}\" has no joint, so the base is fixed there, and its mass is left out; if it floats: want a free \
                 joint in it, or two joints of type slide and a hinge",
                quote_clipped(&base.name)
            ));
        }
        if model.descendants().any(|node| node.has_tag_name("mesh")) {
            notes.push("meshes are left out: a machine here is made of bars".to_owned());
        }
        if model.descendants().any(|node| node.has_tag_name("spatial")) {
            notes.push(
                "spatial tendons are left out: of belts and cables, fixed tendons and equalities are read".into(),
            );
        }
        for (name, what) in [("damping", "damping"), ("frictionloss", "friction"), ("stiffness", "stiffness")] {
            let of_base = self.bodies.floating().into_iter().flat_map(FloatingBase::joints);
            let hinges = (0..self.base).filter_map(|i| self.bodies.hinge(i)).chain(of_base);
            let mut values = hinges.map(|hinge| Ok(numbers(hinge, name)?.unwrap_or_default()));
            if values.try_fold(false, |any, all: Result<Vec<f64>, ImportError>| {
                Ok::<_, ImportError>(any || all?.iter().any(|x| *x != 0.0))
            })? {
                notes.push(format!("{what} of joints is left out: friction belongs into the plant of a scenario"));
            }
        }
        Ok(notes)
    }
}
