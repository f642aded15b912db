//! [`LayersReport`]: the layers of a machine, their heights, and the tilt that is left.

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::machine::Machine;

use super::clash::Clash;
use super::clearance::Clearance;
use super::contact::Contact;

/// Layer of a link.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct LinkLayer {
    /// Name of the link.
    pub link: String,
    /// Its layer, counted from 0 next to the base plate.
    pub layer: usize,
    /// Height of its middle above the middle of layer 0, m: its `axial`.
    pub height: f64,
}

/// A quantity before and after a change of heights.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Change {
    /// At the heights of the given machine.
    pub before: f64,
    /// At the heights of the layers.
    pub after: f64,
}

/// An order of the links of a machine in layers.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct LayersReport {
    /// The layer of each link, in the order of the links.
    pub layers: Vec<LinkLayer>,
    /// Number of layers.
    pub count: usize,
    /// Height from the lowest face to the uppermost, m.
    pub height: f64,
    /// Largest tilting moment of the task, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tilt: Option<Change>,
    /// Σ_k |s_k − z̄ g_k|, kg m².
    pub tilt_coefficient: Change,
    /// Whether it is proven that no order has fewer layers.
    pub minimal: bool,
    /// Whether it is proven that no order with as many layers tilts the base less.
    pub least_tilt: bool,
    /// Solids that overlap in plan, so that they need different layers.
    pub meetings: Vec<Contact>,
    /// Solids that meet at the heights of the given machine; empty if it states none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub clashes: Vec<Clash>,
    /// Least distance in plan of solids that share a height, along the task.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clearance: Option<Clearance>,
    /// The machine at the heights of the layers.
    #[serde(skip)]
    pub machine: Machine,
}

impl LayersReport {
    /// Returns whether each overlap is certain, so that no layer is used in vain.
    pub fn is_decided(&self) -> bool {
        self.meetings.iter().all(|contact| contact.decided)
    }

    /// Returns whether the given machine has these heights already.
    pub fn is_used_by(&self, machine: &Machine) -> bool {
        let links = machine.spec().links.iter().zip(&self.layers);
        links.into_iter().all(|(link, own)| (link.axial - own.height).abs() <= 1e-9)
    }
}
