//! Remarks on counterweights that are too thin to be made.

use super::cut::Cut;
use stillbase_mechanics::machine::{Counterweight, CounterweightShape};
use stillbase_settings::number::fixed;

/// Walls and plates thinner than this, m, are hard to cut, and bend in use.
const LEAST: f64 = 1e-3;

/// Returns a remark on a counterweight whose wall, length or width is too thin to be made.
pub fn thin_wall(weight: &Counterweight) -> Option<String> {
    let (what, metres) = match weight.shape() {
        CounterweightShape::Ring { radius, inner_radius } | CounterweightShape::HalfRing { radius, inner_radius } => {
            ("wall", radius - inner_radius)
        }
        CounterweightShape::Box { length, width } if width < length => ("width", width),
        CounterweightShape::Box { length, .. } => ("length", length),
        CounterweightShape::Disc { .. } | CounterweightShape::Point => return None,
    };
    remark(weight, what, metres)
}

/// Returns remarks on counterweights that are too thin to be made: in their wall, or in the thickness that gives them
/// their mass.
pub fn too_thin(weights: &[Counterweight], cut: &Cut) -> Vec<String> {
    let thickness = |weight: &Counterweight| remark(weight, "thickness", cut.thickness_of(weight)?);
    weights.iter().flat_map(|weight| [thin_wall(weight), thickness(weight)]).flatten().collect()
}

fn remark(weight: &Counterweight, what: &str, metres: f64) -> Option<String> {
    (metres < LEAST).then(|| {
        let [own, least] = [metres, LEAST].map(|metres| fixed(1e3 * metres, 2));
        format!(
            "the {} of {} kg on link {} has a {what} of {own} mm: under {least} mm it is hard to make",
            weight.shape().name(),
            fixed(weight.mass, 3),
            weight.link,
        )
    })
}
