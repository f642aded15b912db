//! [`Heights`]: where the links lie above each other.

use stillbase_mechanics::machine::{Counterweight, Machine};

/// Height of a bar and gap between bars, as fractions of the reach of the machine.
const BAR_HEIGHT: f64 = 0.016;
pub(super) const GAP: f64 = 0.004;
/// Height of a bar and gap, as fractions of the least distance between two layers of a machine with heights.
const BAR_SHARE: f64 = 0.857;
const GAP_SHARE: f64 = 0.1;
/// Least height of a bar, as a fraction of the reach: heights closer than that count as one.
const THINNEST: f64 = 1e-3;
/// Density of discs, kg/m³, which gives each its thickness: that of steel.
const DISC_DENSITY: f64 = 7850.0;

/// The heights of the links of a machine.
pub(super) struct Heights {
    /// Height of a bar from its lower to its upper face, m.
    pub height: f64,
    /// Gap between bars, by which pins stand out, m.
    pub gap: f64,
    /// Height of the lower face of each link, m.
    pub z: Vec<f64>,
    /// Height of the uppermost face, m.
    pub top: f64,
    /// Whether they are those of the machine; else each drive has a layer.
    are_own: bool,
}

impl Heights {
    /// Returns the heights of a machine, or a layer for each drive if it has none.
    pub fn of(machine: &Machine, reach: f64) -> Self {
        let axial: Vec<f64> = machine.spec().links.iter().map(|link| link.axial).collect();
        let (height, gap) = (BAR_HEIGHT * reach, GAP * reach);
        if axial.iter().all(|z| *z == axial[0]) {
            let z = machine.resolved_links().iter().map(|part| part.drive as f64 * (height + gap)).collect();
            let top = (machine.drives() - 1) as f64 * (height + gap) + height;
            return Self { height, gap, z, top, are_own: false };
        }
        let mut levels = axial.clone();
        levels.sort_by(f64::total_cmp);
        let steps = levels.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > THINNEST * reach);
        let step = steps.fold(f64::INFINITY, f64::min);
        let (height, gap) = (height.min(BAR_SHARE * step), gap.min(GAP_SHARE * step));
        let z: Vec<f64> = axial.iter().map(|z| z - levels[0]).collect();
        let top = levels[levels.len() - 1] - levels[0] + height;
        Self { height, gap, z, top, are_own: true }
    }

    /// Returns the thickness of a disc, m; `None` if it is drawn as all others are.
    pub fn thickness(&self, weight: &Counterweight) -> Option<f64> {
        weight.thickness(DISC_DENSITY).filter(|_| self.are_own)
    }

    /// Returns the heights of the ends of the spacers on a pin, m: from the upper face of each link that it joins to the
    /// lower face of the next one. Links without heights of their own have none.
    pub fn spacers(&self, links: &[usize]) -> impl Iterator<Item = [f64; 2]> {
        let mut faces: Vec<f64> = links.iter().filter(|_| self.are_own).map(|link| self.z[*link]).collect();
        faces.sort_by(f64::total_cmp);
        let gaps: Vec<[f64; 2]> = faces.windows(2).map(|pair| [pair[0] + self.height, pair[1]]).collect();
        gaps.into_iter().filter(|[low, high]| high > low)
    }

    /// Returns the lower face of the link that carries a motor, m.
    pub fn carrier(&self, machine: &Machine, motor: usize) -> f64 {
        let parts = machine.resolved_links();
        let Some(on) = machine.motors().on(motor) else { return 0.0 };
        let turned = parts.iter().filter(|part| part.drive == motor);
        let carrier = turned.filter_map(|part| part.parent).find(|parent| parts[*parent].drive == on);
        // A motor without such a link is drawn below the first link of its carrier.
        let first = || parts.iter().position(|part| part.drive == on);
        carrier.or_else(first).map_or(0.0, |link| self.z[link])
    }
}
