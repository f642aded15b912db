//! [`Heights`]: where the links lie above each other.

use stillbase_exchange::solids::{LinkSolid, SolidKind, has_heights};
use stillbase_mechanics::machine::Machine;

/// Height of a bar and gap between bars, as fractions of the reach of the machine.
const BAR_HEIGHT: f64 = 0.016;
pub(super) const GAP: f64 = 0.004;

/// The heights of the links of a machine.
pub(super) struct Heights {
    /// Height of a bar without parts from its lower to its upper face, m.
    pub height: f64,
    /// Gap between bars, by which pins stand out, m.
    pub gap: f64,
    /// Height of the middle of each link, m.
    pub middle: Vec<f64>,
    /// Height of the uppermost face, m.
    pub top: f64,
    /// Height of the base of the heights that the machine states for its links, m; `None` if it states none, and each
    /// drive has a layer.
    pub lowest: Option<f64>,
}

impl Heights {
    /// Returns the heights of a machine, or a layer for each drive if it has none. `solids` are those of the links that
    /// are drawn as they are cut.
    pub fn of(machine: &Machine, reach: f64, solids: &[LinkSolid]) -> Self {
        let (height, gap) = (BAR_HEIGHT * reach, GAP * reach);
        if !has_heights(machine) {
            // A thick bar needs a thick layer.
            let is_flat = |solid: &&LinkSolid| matches!(solid.kind, SolidKind::Bar | SolidKind::Part);
            let layer = solids.iter().filter(is_flat).fold(height, |most, solid| most.max(solid.thickness));
            let middle = |drive: usize| drive as f64 * (layer + gap) + 0.5 * layer;
            return Self {
                height,
                gap,
                middle: machine.resolved_links().iter().map(|part| middle(part.drive)).collect(),
                top: middle(machine.drives() - 1) + 0.5 * layer,
                lowest: None,
            };
        }
        let faces = solids.iter().flat_map(|solid| solid.faces(machine));
        let [low, high] =
            faces.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], face| [low.min(face), high.max(face)]);
        let middle = machine.spec().links.iter().map(|link| link.axial - low).collect();
        Self { height, gap, middle, top: high - low, lowest: Some(low) }
    }
}
