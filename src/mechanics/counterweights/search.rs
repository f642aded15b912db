//! [`search`]: branch and bound over cone programs, for two kinds of problems that are not convex. If discs must stay
//! clear of the pins of their links, directions from the pins must be chosen for each disc. If the objective contains
//! |D_k|, more inertia reduces it where D_k < 0. The subproblem with the lowest bound is split first, so the first
//! solution whose relaxation is exact is the optimum.

use super::cell::{CellSide, DiscPlace, SearchCell};
use super::pin_sector::{PinSector, worst_pin};
use super::problem::CounterweightProblem;
use super::refusal::CounterweightError;
use super::search_node::{BalanceGoal, SearchNode};
use super::solution::MIN_MASS;
use super::spec::CounterweightSpec;
use stillbase_convex::{NoOptimum, Optimum};

/// Maximum number of subproblems from choices of directions from pins.
const MAX_CHOICES: usize = 4000;

/// Maximum number of cells, the ranges of mass and position that are searched.
const MAX_CELLS: usize = 300;

/// Tolerance of the clearance, in the unit of length: the solver's rounding.
const CLEARANCE_TOLERANCE: f64 = 1e-7;

/// Tolerance of the objective, in its unit: a solution worse by at most this is treated as optimal.
const VALUE_TOLERANCE: f64 = 2e-7;

/// Maximum number of linearisations in one descent.
const MAX_LINEARISATIONS: usize = 25;

/// Finds the optimum over all choices of directions from pins and over all cells. If the number of cells exceeds its
/// limit, returns the best solution found, with the remaining gap.
///
/// # Errors
/// Outer: too many choices, or a subproblem fails and momentum has no weight. Inner: no solution, or the first fails.
pub(super) fn search(
    problem: &CounterweightProblem,
    request: &CounterweightSpec,
    node: &SearchNode,
) -> Result<Result<Optimum, NoOptimum>, CounterweightError> {
    let search = Search { problem, request };
    let mut open = match problem.least(request, node) {
        Ok(least) => vec![OpenNode { least, node: node.clone(), failed: None }],
        Err(why) => return Ok(Err(why)),
    };
    let (mut best, mut choices, mut cells): (Option<Optimum>, usize, usize) = (None, 1, 1);
    // The lowest bound of the subproblems that were given up because the solver fails, and why it does.
    let (mut unproven, mut failure) = (f64::INFINITY, None);
    while let Some(next) = (0..open.len()).min_by(|a, b| open[*a].least.value.total_cmp(&open[*b].least.value)) {
        let OpenNode { least, node, failed } = open.swap_remove(next);
        let bound = least.value - least.gap;
        if let Some(best) =
            best.as_ref().filter(|best| best.value <= least.value + VALUE_TOLERANCE || cells > MAX_CELLS)
        {
            return Ok(Ok(Optimum { gap: best.value - bound.min(unproven), ..best.clone() }));
        }
        let proven = |least: Optimum| Optimum { gap: least.gap.max(least.value - unproven), ..least };
        let children = match search.worst_site(&least, &node) {
            // The optimum is that of the parent, whose counterweights need not lie where this node has them.
            _ if failed.is_some() => {
                let halves = if cells > MAX_CELLS { Vec::new() } else { search.halves(&least, &node, best.as_ref()) };
                cells += halves.len();
                if halves.is_empty() {
                    (unproven, failure) = (unproven.min(bound), failed);
                }
                halves
            }
            Some((j, pin)) => {
                let site = &request.sites[j];
                let sectors = PinSector::choices(request, site, search.pins(j), &node.sectors[j], pin);
                choices += sectors.len();
                if choices > MAX_CHOICES {
                    return Err(CounterweightError::TooMany(MAX_CHOICES));
                }
                let enter = |sectors: Vec<PinSector>| {
                    let mut next = node.clone();
                    next.sectors[j] = sectors;
                    next
                };
                sectors.into_iter().map(enter).collect()
            }
            // Exact inertias matter only to an objective with momentum, not to a minimised residual or bound.
            None if request.objective.momentum == 0.0
                || node.least.is_some()
                || node.balance == BalanceGoal::Nearest =>
            {
                return Ok(Ok(proven(least)));
            }
            None => {
                let found = search.with_exact_inertia(&least);
                if found.value <= least.value + VALUE_TOLERANCE {
                    return Ok(Ok(proven(least)));
                }
                // A descent may move a disc without chosen directions onto a pin; such solutions are discarded.
                let descended = search.descend(&found, &node, cells == 1).into_iter();
                for found in descended.filter(|found| search.worst_site(found, &node).is_none()) {
                    if best.as_ref().is_none_or(|best| found.value < best.value) {
                        best = Some(found);
                    }
                }
                let halves = search.halves(&least, &node, best.as_ref());
                cells += halves.len();
                if halves.is_empty() {
                    // All cells are too narrow to be split, so the subproblem is assigned its exact value.
                    open.push(OpenNode { least: found, node, failed: None });
                }
                halves
            }
        };
        for next in children {
            match problem.least(request, &next) {
                Ok(least) => open.push(OpenNode { least, node: next, failed: None }),
                Err(NoOptimum::Contradiction(_)) => {}
                Err(NoOptimum::Failed(why)) if request.objective.momentum == 0.0 => {
                    return Err(CounterweightError::Failed(why));
                }
                // If the solver fails, the parent's bound holds.
                Err(NoOptimum::Failed(why)) => {
                    open.push(OpenNode { least: least.clone(), node: next, failed: Some(why) });
                }
            }
        }
    }
    match (best, failure) {
        (Some(best), _) => Ok(Ok(Optimum { gap: best.gap.max(best.value - unproven), ..best })),
        (None, Some(why)) => Ok(Err(NoOptimum::Failed(why))),
        (None, None) if request.clearance.is_some() => Ok(Err(NoOptimum::Contradiction(Vec::new()))),
        // The first relaxation has a solution, and its cells cover all of it.
        (None, None) => Err(CounterweightError::Failed("no part of the search kept a solution".into())),
    }
}

/// An open subproblem.
struct OpenNode {
    /// The optimum of its relaxation; of its parent's, if the solver has failed.
    least: Optimum,
    node: SearchNode,
    /// Why the solver has failed, if it has.
    failed: Option<String>,
}

struct Search<'a> {
    problem: &'a CounterweightProblem,
    request: &'a CounterweightSpec,
}

impl Search<'_> {
    /// Returns the pins of the link of site j, from its root.
    fn pins(&self, j: usize) -> &[f64] {
        &self.problem.parts[self.request.sites[j].link].pins
    }

    /// Returns the site whose disc violates the clearance of a pin most, and that pin, from the link's root; `None`
    /// if all discs are clear or may cover pins. On an axis, a disc whose directions are chosen is clear.
    fn worst_site(&self, least: &Optimum, node: &SearchNode) -> Option<(usize, f64)> {
        let clearance = self.request.clearance?;
        let missed = |j: usize| {
            let disc = self.problem.disc(self.request, &least.x, j, MIN_MASS)?;
            let settled = |pin: f64| node.sectors[j].iter().any(|sector| sector.settles(pin));
            let pins = self.pins(j).iter().copied().filter(|pin| !settled(*pin));
            let on_axis = self.request.sites[j].across == 0.0;
            let (pin, missed) = worst_pin(pins, clearance, &self.request.stock, disc, on_axis)?;
            Some((j, pin, missed))
        };
        let is_open = |j: &usize| self.request.sites[*j].across > 0.0 || node.sectors[*j].is_empty();
        let open = (0..self.request.sites.len()).filter(is_open);
        let worst = open.filter_map(missed).max_by(|a, b| a.2.total_cmp(&b.2));
        worst.filter(|(_, _, missed)| *missed > CLEARANCE_TOLERANCE).map(|(j, pin, _)| (j, pin))
    }

    /// Returns a solution with every inertia at its exact value.
    fn with_exact_inertia(&self, least: &Optimum) -> Optimum {
        let x = self.problem.with_exact_values(self.request, &least.x);
        Optimum { value: self.problem.value(self.request, &x), x, multipliers: Vec::new(), gap: 0.0 }
    }

    /// Descends from a solution, and also from the bounds of all cells if `from_bounds`. Each iteration solves the cone
    /// program with the inertias linearised about the previous solution. Returns the results, and the given solution
    /// last.
    fn descend(&self, from: &Optimum, node: &SearchNode, from_bounds: bool) -> Vec<Optimum> {
        let about = |least: &Optimum| {
            let far = |[from, to]: [f64; 2]| if from.abs() > to.abs() { from } else { to };
            let one = |j: usize| {
                let none = DiscPlace { at: far(node.cells[j].at), ..DiscPlace::default() };
                self.problem.disc(self.request, &least.x, j, MIN_MASS).unwrap_or(none)
            };
            (0..self.request.sites.len()).map(one).collect::<Vec<_>>()
        };
        let mean = |all: &[DiscPlace]| all.iter().map(|disc| disc.mass).sum::<f64>() / all.len().max(1) as f64;
        let here = about(from);
        let mut starts = vec![here.clone()];
        if from_bounds {
            let heavy = 3.0 * mean(&here) + 1.0;
            let place = |i: usize, mass: f64, cell: &SearchCell| DiscPlace { mass, at: cell.at[i], across: 0.0 };
            let end = |i: usize, mass: f64| node.cells.iter().map(|cell| place(i, mass, cell)).collect::<Vec<_>>();
            starts.extend([end(0, 0.0), end(1, 0.0), end(0, heavy), end(1, heavy)]);
        }
        let down = |mut tangents: Vec<DiscPlace>| {
            let mut best: Option<Optimum> = None;
            for _ in 0..MAX_LINEARISATIONS {
                let node = SearchNode { tangents: Some(tangents), ..node.clone() };
                let Ok(next) = self.problem.least(self.request, &node) else { break };
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
        let excess = self.problem.excess(self.request, &least.x);
        let each = excess.iter().enumerate().flat_map(|(j, [place, own])| [(j, false, *place), (j, true, *own)]);
        let mut order: Vec<(usize, bool, f64)> = each.collect();
        order.sort_by(|a, b| b.2.total_cmp(&a.2));
        // No counterweight is heavier than the best objective divided by the coefficient of mass in the objective.
        let heaviest = best.map(|best| best.value / self.request.objective.mass).filter(|mass| mass.is_finite());
        let halved = order.into_iter().find_map(|(j, by_mass, _)| {
            let disc = self.problem.disc(self.request, &least.x, j, MIN_MASS).unwrap_or_default();
            let mut cell = node.cells[j];
            cell.mass[1] = cell.mass[1].min(heaviest.unwrap_or(f64::INFINITY)).max(cell.mass[0]);
            let side = if by_mass { CellSide::Mass } else { cell.looser_side(&disc) };
            let halves = cell.halves(side, &disc)?;
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
