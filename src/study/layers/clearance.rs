//! [`Clearance`]: how near solids of the same height come to each other along a task.

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_exchange::cut::Cut;
use stillbase_exchange::solids::Axle;
use stillbase_mechanics::machine::Machine;

use super::contact::Solids;
use super::overlap::Pair;
use super::way::TaskPoses;

/// Heights closer than this are one, m.
const SAME_HEIGHT: f64 = 1e-9;

/// The least distance in plan between solids whose heights overlap.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Clearance {
    /// Name of the first: a solid of a link.
    pub a: String,
    /// Name of the second: a solid of a link, or a pin.
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
        let mut least: Option<Self> = None;
        let mut include = |pair: &Pair<'_>, names: &dyn Fn() -> [String; 2]| {
            let limit = least.as_ref().map_or(f64::INFINITY, |least| least.distance);
            let Some((pose, near)) = task.nearest(pair, limit) else { return };
            let [a, b] = names();
            least = Some(Self { a, b, distance: near.gap, time: pose.time, at: [near.at.re, near.at.im] });
        };
        let shares = |[low, high]: [f64; 2], [from, to]: [f64; 2]| high > from + SAME_HEIGHT && low < to - SAME_HEIGHT;
        for (i, a) in solids.links.iter().enumerate() {
            for (j, b) in solids.links.iter().enumerate().skip(i + 1).filter(|(_, b)| b.link != a.link) {
                if shares(a.faces(machine), b.faces(machine)) {
                    include(&Pair::of(&solids.plans[i], &solids.plans[j]), &|| [a, b].map(|x| x.name(machine)));
                }
            }
            for (axle, plan) in solids.axles.iter().zip(&solids.pins).filter(|(axle, _)| !axle.joins(a.link)) {
                if axle.is_pin() && shares(a.faces(machine), pin_faces(machine, cut, axle)) {
                    include(&Pair::of(&solids.plans[i], plan), &|| [a.name(machine), axle.name(machine)]);
                }
            }
        }
        least
    }
}

/// Returns the heights of the ends of a pin, m, without end below if it stands on the base.
pub(super) fn pin_faces(machine: &Machine, cut: &Cut, axle: &Axle) -> [f64; 2] {
    let [low, high] = axle.span(machine, cut);
    [if axle.is_on_base() { f64::NEG_INFINITY } else { low }, high]
}
