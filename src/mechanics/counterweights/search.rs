//! [`search`]: branch and bound over cone programs, for two kinds of problems that are not convex. If discs must stay
//! clear of the pins of their links, an interval between pins must be chosen for each disc. If D_k is negative, more
//! inertia reduces |D_k|. The subproblem with the lowest bound is split first, so the first solution whose relaxation
//! is exact is the optimum.

use super::cell::SearchCell;
use super::free_span::FreeSpan;
use super::problem::CounterweightProblem;
use super::refusal::CounterweightError;
use super::search_node::{BalanceGoal, SearchNode};
use super::solution::MIN_MASS_KG;
use super::spec::CounterweightSpec;
use crate::machine::Machine;
use stillbase_convex::{NoOptimum, Optimum};

/// Maximum number of subproblems from choices of intervals between pins.
const MAX_CHOICES: usize = 4000;

/// Maximum number of cells, the ranges of mass and position that are searched.
const MAX_CELLS: usize = 300;

/// Tolerance of the clearance, m: the solver's rounding.
const CLEARANCE_TOLERANCE_M: f64 = 1e-7;

/// Tolerance of the objective: a solution worse by at most this is treated as optimal.
const VALUE_TOLERANCE: f64 = 2e-7;

/// Maximum number of linearisations in one descent.
const MAX_LINEARISATIONS: usize = 25;

/// Finds the optimum over all choices of intervals between pins and over all cells. If the number of cells exceeds its
/// limit, returns the best solution found, with the remaining gap.
///
/// # Errors
/// If there are too many choices, or a child fails and momentum has no weight. Inner: no solution, or a failed root.
pub(super) fn search(
    problem: &CounterweightProblem,
    machine: &Machine,
    request: &CounterweightSpec,
    node: &SearchNode,
) -> Result<Result<Optimum, NoOptimum>, CounterweightError> {
    let search = Search { problem, machine, request };
    let rooms: Vec<Vec<FreeSpan>> =
        request.sites.iter().map(|site| FreeSpan::all(&problem.bare.resolved_links()[site.link].pins)).collect();
    // Open subproblems, each with the optimum of its relaxation.
    let mut open = match problem.least(machine, request, node) {
        Ok(least) => vec![(least, node.clone())],
        Err(why) => return Ok(Err(why)),
    };
    let (mut best, mut choices, mut cells): (Option<Optimum>, usize, usize) = (None, 1, 1);
    while let Some(next) = (0..open.len()).min_by(|a, b| open[*a].0.value.total_cmp(&open[*b].0.value)) {
        let (least, node) = open.swap_remove(next);
        let bound = least.value - least.gap;
        if let Some(best) =
            best.as_ref().filter(|best| best.value <= least.value + VALUE_TOLERANCE || cells > MAX_CELLS)
        {
            return Ok(Ok(Optimum { gap: best.value - bound, ..best.clone() }));
        }
        let children = match search.worst_site(&least, &rooms, &node) {
            Some(j) => {
                choices += rooms[j].len();
                if choices > MAX_CHOICES {
                    return Err(CounterweightError::TooMany(MAX_CHOICES));
                }
                let enter = |room: &FreeSpan| {
                    let mut next = node.clone();
                    next.rooms[j] = Some(*room);
                    next
                };
                rooms[j].iter().map(enter).collect()
            }
            // Only the objective depends on the exact inertias: a residual or a bound that is minimised does not.
            None if request.objective.momentum == 0.0
                || node.least.is_some()
                || node.balance == BalanceGoal::Nearest =>
            {
                return Ok(Ok(least));
            }
            None => {
                let found = search.with_exact_inertia(&least);
                if found.value <= least.value + VALUE_TOLERANCE {
                    return Ok(Ok(least));
                }
                // A descent may move a disc without a chosen interval onto a pin; such solutions are discarded.
                let descended = search.descend(&found, &node, cells == 1).into_iter();
                for found in descended.filter(|found| search.worst_site(found, &rooms, &node).is_none()) {
                    if best.as_ref().is_none_or(|best| found.value < best.value) {
                        best = Some(found);
                    }
                }
                let halves = search.halves(&least, &node, best.as_ref());
                cells += halves.len();
                if halves.is_empty() {
                    // All cells are too narrow to be split, so the subproblem is assigned its exact value.
                    open.push((Optimum { value: found.value, ..found }, node));
                }
                halves
            }
        };
        for next in children {
            match problem.least(machine, request, &next) {
                Ok(least) => open.push((least, next)),
                Err(NoOptimum::Contradiction(_)) => {}
                Err(NoOptimum::Failed(why)) if request.objective.momentum == 0.0 => {
                    return Err(CounterweightError::Failed(why));
                }
                // If the solver fails, the parent's bound holds.
                Err(NoOptimum::Failed(_)) => open.push((least.clone(), next)),
            }
        }
    }
    Ok(best.ok_or(NoOptimum::Contradiction(Vec::new())))
}

struct Search<'a> {
    problem: &'a CounterweightProblem,
    machine: &'a Machine,
    request: &'a CounterweightSpec,
}

impl Search<'_> {
    /// Returns the site whose disc violates the clearance of a pin most; `None` if all discs are clear or may cover
    /// pins. A disc whose interval is chosen is clear.
    fn worst_site(&self, least: &Optimum, rooms: &[Vec<FreeSpan>], node: &SearchNode) -> Option<usize> {
        let clearance = self.request.clearance?;
        let missed = |j: usize| {
            let [w, s] = self.problem.at(self.request, &least.x, j);
            let (radius, at) = (self.request.disc.radius(w.max(0.0)), s / w);
            let nearest =
                rooms[j].iter().map(|room| room.violation(clearance, radius, at)).fold(f64::INFINITY, f64::min);
            if w > MIN_MASS_KG { nearest } else { 0.0 }
        };
        let free = (0..rooms.len()).filter(|j| node.rooms[*j].is_none());
        let worst = free.map(|j| (j, missed(j))).max_by(|a, b| a.1.total_cmp(&b.1));
        worst.filter(|(_, missed)| *missed > CLEARANCE_TOLERANCE_M).map(|(j, _)| j)
    }

    /// Returns a solution with every inertia at its exact value.
    fn with_exact_inertia(&self, least: &Optimum) -> Optimum {
        let x = self.problem.with_exact_values(self.machine, self.request, &least.x);
        Optimum { value: self.problem.value(self.machine, self.request, &x), x, gap: 0.0 }
    }

    /// Descends from a solution, and also from the bounds of all cells if `from_bounds`. Each iteration solves the cone
    /// program with the inertias linearised about the previous solution. Returns the results, and the given solution
    /// last.
    fn descend(&self, from: &Optimum, node: &SearchNode, from_bounds: bool) -> Vec<Optimum> {
        let about = |least: &Optimum| {
            let one = |j: usize| {
                let ([w, s], [from, to]) = (self.problem.at(self.request, &least.x, j), node.cells[j].at);
                let far = if from.abs() > to.abs() { from } else { to };
                if w > MIN_MASS_KG { [w, s / w] } else { [0.0, far] }
            };
            (0..self.request.sites.len()).map(one).collect::<Vec<_>>()
        };
        let mean = |all: &[[f64; 2]]| all.iter().map(|[w, _]| w).sum::<f64>() / all.len().max(1) as f64;
        let here = about(from);
        let mut starts = vec![here.clone()];
        if from_bounds {
            let heavy = 3.0 * mean(&here) + 1.0;
            let end = |i: usize, mass: f64| node.cells.iter().map(|cell| [mass, cell.at[i]]).collect::<Vec<_>>();
            starts.extend([end(0, 0.0), end(1, 0.0), end(0, heavy), end(1, heavy)]);
        }
        let down = |mut tangents: Vec<[f64; 2]>| {
            let mut best: Option<Optimum> = None;
            for _ in 0..MAX_LINEARISATIONS {
                let node = SearchNode { tangents: Some(tangents), ..node.clone() };
                let Ok(next) = self.problem.least(self.machine, self.request, &node) else { break };
                let next = self.with_exact_inertia(&next);
                tangents = about(&next);
                let gain = best.as_ref().map_or(f64::INFINITY, |best| best.value - next.value);
                if gain > 0.0 {
                    best = Some(next);
                }
                if gain < 0.1 * VALUE_TOLERANCE {
                    break;
                }
            }
            best
        };
        starts.into_iter().filter_map(down).chain([from.clone()]).collect()
    }

    /// Splits the cell in which an inertia differs most from its exact value; empty if all cells are too narrow.
    fn halves(&self, least: &Optimum, node: &SearchNode, best: Option<&Optimum>) -> Vec<SearchNode> {
        let excess = self.problem.excess(self.machine, self.request, &least.x);
        let each = excess.iter().enumerate().flat_map(|(j, [place, own])| [(j, true, *place), (j, false, *own)]);
        let mut order: Vec<(usize, bool, f64)> = each.collect();
        order.sort_by(|a, b| b.2.total_cmp(&a.2));
        // No counterweight is heavier than the best objective divided by the coefficient of mass in the objective.
        let heaviest = best.map(|best| best.value / self.request.objective.mass).filter(|mass| mass.is_finite());
        let halved = order.into_iter().find_map(|(j, by_place, _)| {
            let [w, s] = self.problem.at(self.request, &least.x, j);
            let mut cell = node.cells[j];
            cell.mass[1] = cell.mass[1].min(heaviest.unwrap_or(f64::INFINITY)).max(cell.mass[0]);
            let halves = cell.halves(by_place, [w.max(0.0), if w > MIN_MASS_KG { s / w } else { 0.0 }])?;
            Some((j, halves))
        });
        let Some((j, halves)) = halved else { return Vec::new() };
        let with = |cell: SearchCell| {
            let mut next = node.clone();
            next.cells[j] = cell;
            next
        };
        halves.map(with).into()
    }
}
