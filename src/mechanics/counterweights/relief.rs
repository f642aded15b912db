//! [`sufficient_reliefs`]: relaxed bounds that make a request for counterweights feasible, with all other bounds
//! unchanged.

use super::problem::CounterweightProblem;
use super::refusal::{BoundKind, BoundRelaxation, RelaxedBounds};
use super::search_node::SearchNode;
use super::spec::CounterweightSpec;
use super::task::CounterweightTask;
use crate::machine::Machine;

/// Factor by which all but the last of several bounds are relaxed beyond their minimum, so that the last needs less
/// relaxation.
const FIRST_BOUND_FACTOR: f64 = 1.1;

/// Fractions by which a relaxed bound is relaxed further, against the solver's rounding, until there is a solution.
pub const EXTRA_FRACTIONS: [f64; 6] = [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// Number of bisection steps for a clearance or a distance from the axes.
const BISECTIONS: usize = 20;

/// Returns each kind of bound whose relaxation alone is sufficient, with its relaxed value. If there is none, returns
/// the sufficient sets of the smallest size. `is_feasible` returns whether another request has a solution.
pub(super) fn sufficient_reliefs(
    one: &CounterweightTask,
    is_feasible: &dyn Fn(&CounterweightSpec) -> bool,
) -> Vec<Vec<BoundRelaxation>> {
    let kinds = BoundKind::of(one.spec);
    let some = |bits: usize| (0..kinds.len()).filter(move |i| bits >> i & 1 == 1).map(|i| kinds[i]).collect::<Vec<_>>();
    let of_size = |size: usize| {
        let sets = (1..1_usize << kinds.len()).map(some).filter(move |set| set.len() == size);
        sets.filter_map(|set| together(one, &set, is_feasible)).collect::<Vec<_>>()
    };
    (1..=kinds.len()).map(of_size).find(|found| !found.is_empty()).unwrap_or_default()
}

/// Returns a distance from the axes that is sufficient, with all other bounds unchanged; empty if there is none. It is at
/// least the greatest distance of a mass from its axis: counterweights nearer to the axes than that grow heavy.
pub(super) fn across_relief(
    one: &CounterweightTask,
    is_feasible: &dyn Fn(&CounterweightSpec) -> bool,
) -> Vec<Vec<BoundRelaxation>> {
    let Some(least) = together(one, &[BoundKind::Across], is_feasible) else { return Vec::new() };
    let off_axis = |machine: &Machine| {
        let payload = machine.spec().payload;
        let held = if payload.mass > 0.0 { payload.offset[1].abs() } else { 0.0 };
        machine.links().iter().map(|link| link.com_normal.abs()).fold(held, f64::max)
    };
    let blocks = one.problem.bare.blocks().iter();
    let masses = blocks.map(|block| off_axis(&block.machine)).fold(0.0, f64::max);
    let ample = BoundKind::Across.rounded(masses);
    let enough = |one: BoundRelaxation| match (one, ample) {
        (BoundRelaxation::Across(least), BoundRelaxation::Across(ample)) if ample > least => {
            BoundRelaxation::Across(ample)
        }
        (one, _) => one,
    };
    vec![least.into_iter().map(enough).collect()]
}

/// Returns the values to which these kinds of bounds have to be relaxed together; `None` if that is not enough.
fn together(
    one: &CounterweightTask,
    kinds: &[BoundKind],
    is_feasible: &dyn Fn(&CounterweightSpec) -> bool,
) -> Option<Vec<BoundRelaxation>> {
    let (last, first) = kinds.split_last()?;
    let (mut request, mut reliefs) = (one.spec.clone(), Vec::new());
    for (i, kind) in first.iter().enumerate() {
        let least = match kind {
            BoundKind::Across => least_across(one, &request.without_bounds(&kinds[i + 1..]))?,
            _ => least_bound(one, &request, *kind, &kinds[i + 1..])?,
        };
        let relief = kind.rounded(FIRST_BOUND_FACTOR * least);
        relief.enter(&mut request);
        reliefs.push(relief);
    }
    let least = match last {
        BoundKind::Clearance => greatest_clearance(one, &request)?,
        BoundKind::Across => least_across(one, &request)?,
        _ => least_bound(one, &request, *last, &[])?,
    };
    let nudged = EXTRA_FRACTIONS
        .map(|by| last.rounded(if *last == BoundKind::Clearance { least * (1.0 - by) } else { least * (1.0 + by) }));
    let enough = |relief: &BoundRelaxation| {
        relief.enter(&mut request);
        is_feasible(&request)
    };
    reliefs.push(nudged.into_iter().find(enough)?);
    Some(reliefs)
}

/// Returns the smallest feasible value of a kind of bound without the bounds of the kinds `loose`; `None` if there is
/// none.
fn least_bound(
    one: &CounterweightTask,
    request: &CounterweightSpec,
    kind: BoundKind,
    loose: &[BoundKind],
) -> Option<f64> {
    let without_clearance = CounterweightSpec { clearance: request.clearance.map(|_| 0.0), ..request.clone() };
    let spec = if loose.contains(&BoundKind::Clearance) { &without_clearance } else { request };
    let one = one.with(spec);
    let (least, all) = (Some(RelaxedBounds::Value(kind)), SearchNode::unconstrained(&one.scaled, one.balance()));
    let way = SearchNode { loose: loose.to_vec(), least, ..all };
    one.on(&way).ok()?.ok().map(|least| one.problem.units.bound(kind) * least.value.max(0.0))
}

/// Returns the greatest feasible clearance of discs from pins, m, by bisection; `None` if even 0 is infeasible.
fn greatest_clearance(one: &CounterweightTask, request: &CounterweightSpec) -> Option<f64> {
    let is_clear = |clearance: f64| {
        let request = CounterweightSpec { clearance: Some(clearance), ..request.clone() };
        one.with(&request).is_possible()
    };
    if !is_clear(0.0) {
        return None;
    }
    let bisected = |[low, high]: [f64; 2], _| {
        let middle = 0.5 * (low + high);
        if is_clear(middle) { [middle, high] } else { [low, middle] }
    };
    Some((0..BISECTIONS).fold([0.0, request.clearance?], bisected)[0])
}

/// Returns the least sufficient distance of counterweights from the axes of their links, m, by bisection; `None` if even
/// the reach of the machine is not sufficient.
fn least_across(one: &CounterweightTask, request: &CounterweightSpec) -> Option<f64> {
    let is_enough = |across: f64| {
        let mut request = request.clone();
        BoundRelaxation::Across(across).enter(&mut request);
        let problem = CounterweightProblem::new(&one.subject, &request).ok();
        let is_possible = |problem: &CounterweightProblem| {
            problem.check(&one.subject).is_ok() && CounterweightTask::new(problem, one.subject, &request).is_possible()
        };
        problem.is_some_and(|problem| is_possible(&problem))
    };
    let reach = one.problem.reach * one.problem.units.length;
    if !is_enough(reach) {
        return None;
    }
    let bisected = |[low, high]: [f64; 2], _| {
        let middle = 0.5 * (low + high);
        if is_enough(middle) { [low, middle] } else { [middle, high] }
    };
    Some((0..BISECTIONS).fold([0.0, reach], bisected)[1])
}

impl BoundKind {
    /// Returns the kinds of bounds that are set, the clearance last.
    pub(super) fn of(request: &CounterweightSpec) -> Vec<Self> {
        let set = [
            (Self::Most, request.sites.iter().any(|site| site.most.is_finite())),
            (Self::Mass, request.max_added_mass.is_some()),
            (Self::Inertia, request.max_inertia.is_some()),
            (Self::Across, request.sites.iter().any(|site| site.across > 0.0)),
            // The last one: `together` bisects a clearance only after all others are relaxed.
            (Self::Clearance, request.clearance.is_some()),
        ];
        set.into_iter().filter(|(_, set)| *set).map(|(kind, _)| kind).collect()
    }

    /// Rounds a relaxed bound to few digits, away from the infeasible side.
    pub fn rounded(self, bound: f64) -> BoundRelaxation {
        let decimals = self.decimals(bound);
        let steps = 10_f64.powi(decimals as i32);
        // The value that the printed number has.
        let printed = |steps_of: f64| format!("{:.decimals$}", steps_of / steps).parse().unwrap_or(bound);
        let up = |least: f64| printed((bound * steps).ceil().max(least));
        match self {
            Self::Most => BoundRelaxation::Most(up(1.0)),
            Self::Mass => BoundRelaxation::Mass(up(1.0)),
            Self::Inertia => BoundRelaxation::Inertia(up(1.0)),
            Self::Clearance => BoundRelaxation::Clearance(printed((bound * steps).floor())),
            Self::Across => BoundRelaxation::Across(up(0.0)),
        }
    }
}

impl BoundRelaxation {
    /// Enters the relaxed bound into a request, in place of those that it has.
    pub fn enter(self, request: &mut CounterweightSpec) {
        match self {
            Self::Most(most) => {
                let bounded = request.sites.iter_mut().filter(|site| site.most.is_finite());
                bounded.for_each(|site| site.most = most);
            }
            Self::Mass(most) => request.max_added_mass = Some(most),
            Self::Inertia(most) => request.max_inertia = Some(most),
            Self::Clearance(clearance) => request.clearance = Some(clearance),
            Self::Across(across) => request.sites.iter_mut().for_each(|site| site.across = site.across.max(across)),
        }
    }
}
