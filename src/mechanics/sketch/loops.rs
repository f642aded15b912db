//! [`LoopState`]: whether a loop of bars keeps its bars parallel to the arms of drives.

use super::drawing::{Bar, BarId, PinId, Sketch};
use super::graph::{Graph, Loop};
use super::refusal::FAMILY;
use crate::planar::{Vector, cross};

/// Largest sum of sides that must cancel, m. A machine's closures must close within 1e-9 m.
const CLOSED: f64 = 1e-10;
/// Largest sine of the angle between sides that count as parallel.
const PARALLEL: f64 = 1e-7;
/// A loop of four bars is nearly a parallelogram up to this distance of a corner from its place, m …
const NEAR: f64 = 0.01;
/// … or up to this fraction of its longest side.
const NEAR_FRACTION: f64 = 0.05;

/// What a loop is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LoopShape {
    /// Its bars can stay parallel to arms of drives: a parallelogram, or a sum of them.
    Closed,
    /// Four bars that are nearly a parallelogram.
    Nearly {
        /// Distance of a corner from its place in the parallelogram, m.
        off: f64,
    },
    /// It lies outside the family.
    Outside,
}

/// A loop of bars.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopState {
    /// Its bars in order around it.
    pub bars: Vec<BarId>,
    /// Its pins in order: each joins the bar of the same position and the next.
    pub pins: Vec<PinId>,
    /// What it is.
    pub shape: LoopShape,
}

/// A loop with the bars in it that must follow one drive.
pub(super) struct Recognised {
    pub state: LoopState,
    /// Positions in the list of the loop's bars, grouped by drive. Empty unless the loop is closed.
    pub groups: Vec<Vec<usize>>,
}

impl Sketch {
    /// Returns loops of the fewest bars from which all others follow.
    pub(super) fn recognised(&self, graph: &Graph) -> Vec<Recognised> {
        graph.loops().iter().map(|found| self.recognise(found)).collect()
    }

    fn recognise(&self, found: &Loop) -> Recognised {
        let bars: Vec<&Bar> = found.bars.iter().map(|i| &self.bars[*i]).collect();
        let pins: Vec<PinId> = found.pins.iter().map(|i| self.pins[*i].id).collect();
        let n = bars.len();
        let sides: Vec<Vector> = (0..n).map(|i| self.at(pins[i]) - self.at(pins[(i + n - 1) % n])).collect();
        let mut groups: Vec<Vec<usize>> = match n {
            2 => vec![vec![0, 1]],
            4 if (sides[0] + sides[2]).norm() <= CLOSED => vec![vec![0, 2], vec![1, 3]],
            _ => self.grouped(&bars, &sides),
        };
        let cancels = |group: &Vec<usize>| group.iter().map(|i| sides[*i]).sum::<Vector>().norm() <= CLOSED;
        let shape = match groups.iter().all(cancels) {
            true => LoopShape::Closed,
            false => {
                groups.clear();
                nearly(&sides).map_or(LoopShape::Outside, |off| LoopShape::Nearly { off })
            }
        };
        Recognised { state: LoopState { bars: bars.iter().map(|bar| bar.id).collect(), pins, shape }, groups }
    }

    /// Groups the sides of a loop that are parallel. Where every bar states its drive, groups them by drive instead.
    fn grouped(&self, bars: &[&Bar], sides: &[Vector]) -> Vec<Vec<usize>> {
        let is_stated = bars.iter().all(|bar| bar.drive.is_some());
        let is_alike = |i: usize, j: usize| match is_stated {
            true => bars[i].drive == bars[j].drive,
            false => cross(sides[i], sides[j]).abs() <= PARALLEL * sides[i].norm() * sides[j].norm(),
        };
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for i in 0..sides.len() {
            match groups.iter_mut().find(|group| is_alike(group[0], i)) {
                Some(group) => group.push(i),
                None => groups.push(vec![i]),
            }
        }
        groups
    }

    /// Returns why a loop lies outside the family.
    pub(super) fn outside_reason(&self, state: &LoopState) -> String {
        let names: Vec<&str> = state.bars.iter().filter_map(|id| self.bar(*id)).map(|bar| bar.name.as_str()).collect();
        let names = match names.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
            _ => names.join(", "),
        };
        match state.bars.len() {
            3 => format!("bars {names} are a triangle, in which no bar can turn"),
            4 => format!("bars {names} are a loop, but no parallelogram: its bars turn by different angles"),
            n => format!("bars {names} are a loop of {n}, which leaves each bar its own angle"),
        }
    }

    /// Returns what would be right instead of a loop outside the family.
    pub(super) fn wanted_loop(state: &LoopState) -> String {
        match state.bars.len() {
            4 => format!("{FAMILY}; opposite bars as long as each other would do"),
            _ => format!("{FAMILY}; a bar that ends free would do"),
        }
    }
}

/// Returns the distance of a corner from its place if four sides are nearly a parallelogram, m.
fn nearly(sides: &[Vector]) -> Option<f64> {
    let [a, b, c, d] = sides else { return None };
    let off = (a + c).norm();
    let side = [a, b, c, d].into_iter().map(|side| side.norm()).fold(0.0, f64::max);
    // Folded over, two corners would be one.
    let is_plain = (a + b).norm() > off && (b + c).norm() > off;
    (is_plain && (off <= NEAR || off <= NEAR_FRACTION * side)).then_some(off)
}
