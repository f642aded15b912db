//! Materials of parts and counterweights.

use serde::{Deserialize, Serialize};

use super::super::error::{KeyPath, MachineError};
use super::super::spec::MachineSpec;

/// Densities of common materials, kg/m³.
pub const MATERIALS: [(&str, f64); 5] =
    [("aluminium", 2700.0), ("steel", 7850.0), ("brass", 8500.0), ("lead", 11_340.0), ("tungsten", 19_300.0)];

/// The material of a part whose file names none.
pub(super) const USUAL: &str = MATERIALS[0].0;

/// A material that a machine adds to [`MATERIALS`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Density, kg/m³.
    pub density: f64,
}

/// Checks that no material has the name of another, built-in ones included.
pub(super) fn check(spec: &MachineSpec) -> Result<(), MachineError> {
    for (i, material) in spec.materials.iter().enumerate() {
        let before = spec.materials[..i].iter().map(|other| other.name.as_str());
        if MATERIALS.iter().map(|(name, _)| *name).chain(before).any(|name| name == material.name) {
            let place = KeyPath::new(&[&"material", &i, &"name"]);
            return Err(MachineError::Duplicate { place, name: material.name.clone() });
        }
    }
    Ok(())
}

impl MachineSpec {
    /// Returns the names and densities, kg/m³, of all materials: of [`MATERIALS`], then of those of the machine.
    pub fn known_materials(&self) -> impl Iterator<Item = (&str, f64)> {
        let own = self.materials.iter().map(|material| (material.name.as_str(), material.density));
        MATERIALS.into_iter().chain(own)
    }

    /// Returns the density of a material by its name, kg/m³.
    pub fn density_of(&self, name: &str) -> Option<f64> {
        self.known_materials().find(|(known, _)| *known == name).map(|(_, density)| density)
    }
}

/// Returns the density of a material, kg/m³.
pub(super) fn density(spec: &MachineSpec, name: &str, place: impl Fn() -> KeyPath) -> Result<f64, MachineError> {
    spec.density_of(name).ok_or_else(|| MachineError::Unknown {
        place: place(),
        what: "material",
        name: name.into(),
        known: spec.known_materials().map(|(name, _)| name.into()).collect(),
        more: ", or a [[material]] of this name with its density".into(),
    })
}
