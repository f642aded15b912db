//! [`Clearance`]: how near solids of the same height come to each other along a task.

use serde::Serialize;
use stillbase_exchange::cut::Cut;
use stillbase_mechanics::machine::Machine;

use super::contact::Solids;
use super::overlap::Pair;
use super::way::TaskPoses;

/// Heights closer than this are one, m.
const SAME_HEIGHT: f64 = 1e-9;

/// The least distance in plan between solids whose heights overlap.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Clearance {
    /// Name of the first: a bar or a disc.
    pub a: String,
    /// Name of the second: a bar, a disc or a pin.
    pub b: String,
    /// The distance, m; below 0 if they overlap.
    pub distance: f64,
    /// Time of the least distance, s.
    pub time: f64,
    /// A point between the two, m.
    #[serde(rename = "where")]
    pub at: [f64; 2],
}

impl Clearance {
    /// Returns the least clearance of a machine at its present heights along a task; `None` if no two solids of
    /// different links share a height.
    pub fn least(machine: &Machine, cut: &Cut, task: &TaskPoses) -> Option<Self> {
        let solids = Solids::of(machine, cut);
        let height = |link: usize| machine.spec().links[link].axial;
        let mut least: Option<Self> = None;
        let mut include = |pair: &Pair<'_>, names: &dyn Fn() -> [String; 2]| {
            let Some((pose, near)) = task.nearest(pair) else { return };
            if least.as_ref().is_none_or(|least| near.gap < least.distance) {
                let [a, b] = names();
                let at = [near.at.re, near.at.im];
                least = Some(Self { a, b, distance: near.gap, time: pose.time, at });
            }
        };
        for (i, a) in solids.links.iter().enumerate() {
            let (own, half) = (height(a.link), 0.5 * a.thickness);
            for (j, b) in solids.links.iter().enumerate().skip(i + 1).filter(|(_, b)| b.link != a.link) {
                if (own - height(b.link)).abs() < half + 0.5 * b.thickness - SAME_HEIGHT {
                    let pair = Pair::of(&solids.plans[i], &solids.plans[j]);
                    include(&pair, &|| [a.name(machine), b.name(machine)]);
                }
            }
            for (axle, plan) in
                solids.axles.iter().zip(&solids.pins).filter(|(axle, _)| axle.is_pin() && !axle.joins(a.link))
            {
                let ends = axle.links.iter().map(|(j, _)| height(*j));
                let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
                let low = if axle.is_on_base() { f64::NEG_INFINITY } else { low };
                let reach = half + 0.5 * cut.plate_thickness - SAME_HEIGHT;
                if own > low - reach && own < high + reach {
                    include(&Pair::of(&solids.plans[i], plan), &|| [a.name(machine), axle.name(machine)]);
                }
            }
        }
        least
    }
}
