//! [`search`]: discs that stay clear of the pins of their links. Between which pins each sits is a choice, and within one
//! choice the best is a cone program. Choices are made one by one, the most promising first, so the first answer that
//! touches no pin is the best of all.

use super::asked::Weighing;
use super::problem::{NOTHING, Problem, Way};
use super::refusal::NoWeights;
use super::room::Room;
use crate::convex::{Least, NoX};
use crate::mechanics::machine::Machine;

/// The most choices that are looked at.
const CHOICES: usize = 4000;

/// A disc may be so much nearer, m: the solver's rounding.
const ROUNDING: f64 = 1e-7;

/// The best of all ways round the pins.
///
/// # Errors
/// If there is none, or if it is not known.
pub(super) fn search(
    problem: &Problem,
    machine: &Machine,
    asked: &Weighing,
    way: &Way,
) -> Result<Result<Least, NoX>, NoWeights> {
    let rooms: Vec<Vec<Room>> =
        asked.sites.iter().map(|site| Room::all(&problem.bare.resolved_links()[site.link].pins)).collect();
    let mut open = match problem.least(machine, asked, way) {
        Ok(least) => vec![(least, way.clone())],
        Err(why) => return Ok(Err(why)),
    };
    let mut looked_at = 1;
    while let Some(best) = (0..open.len()).min_by(|a, b| open[*a].0.value.total_cmp(&open[*b].0.value)) {
        let (least, way) = open.swap_remove(best);
        let Some(j) = furthest_in(problem, asked, &least, (&rooms, &way)) else { return Ok(Ok(least)) };
        for room in &rooms[j] {
            looked_at += 1;
            if looked_at > CHOICES {
                return Err(NoWeights::TooMany(CHOICES));
            }
            let mut next = way.clone();
            next.rooms[j] = Some(*room);
            match problem.least(machine, asked, &next) {
                Ok(least) => open.push((least, next)),
                Err(NoX::Contradiction(_)) => {}
                Err(NoX::Failed(why)) => return Err(NoWeights::Failed(why)),
            }
        }
    }
    Ok(Err(NoX::Contradiction(Vec::new())))
}

/// The site whose disc reaches furthest over a pin; none if all are clear. One that has its room is.
fn furthest_in(
    problem: &Problem,
    asked: &Weighing,
    least: &Least,
    (rooms, way): (&[Vec<Room>], &Way),
) -> Option<usize> {
    let clearance = asked.clearance.unwrap_or_default();
    let missed = |j: usize| {
        let [w, s] = problem.at(asked, &least.x, j);
        let (radius, at) = (asked.disc.radius(w.max(0.0)), s / w);
        let nearest = rooms[j].iter().map(|room| room.missed(clearance, radius, at)).fold(f64::INFINITY, f64::min);
        if w > NOTHING { nearest } else { 0.0 }
    };
    let free = (0..rooms.len()).filter(|j| way.rooms[*j].is_none());
    let worst = free.map(|j| (j, missed(j))).max_by(|a, b| a.1.total_cmp(&b.1));
    worst.filter(|(_, missed)| *missed > ROUNDING).map(|(j, _)| j)
}
