//! Following curves, or the reason why not.

use super::remedy::blocked;
use super::rule::{Blocked, Rule, SheetEnd, TraceEnd};
use super::walk::{starting_poses, tables};
use crate::curves::{Curve, PathTable};
use crate::reactionless::PlaneMap;

/// Follows curves that join end to end on the plane b, rad, and returns a table of nodes for each. Of several poses at
/// the start it takes the one nearest to `prefer`, rad, from which all curves can be followed.
///
/// # Errors
/// Where the farthest attempt stops, why, and which b or part of the curves is feasible.
pub fn follow(
    map: &PlaneMap,
    curves: &[Curve],
    b: f64,
    prefer: Option<[f64; 2]>,
    rule: Rule,
) -> Result<Vec<PathTable>, Box<Blocked>> {
    let Some(first) = curves.first() else { return Ok(Vec::new()) };
    let mut farthest: Option<TraceEnd> = None;
    for start in starting_poses(map, first.at(0.0).p, b, prefer) {
        match tables(map, curves, b, start, rule) {
            Ok(tables) => return Ok(tables),
            Err(stopped) => {
                if farthest.is_none_or(|f| stopped.0 > f.0) {
                    farthest = Some(stopped);
                }
            }
        }
    }
    let (s, _, stop) = farthest.unwrap_or((0.0, [0.0; 2], SheetEnd::Start));
    Err(Box::new(blocked(map, curves, b, rule, s, stop)))
}
