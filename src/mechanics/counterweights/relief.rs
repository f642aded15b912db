//! [`sufficient_reliefs`]: relaxed bounds that make a request for counterweights feasible, with all other bounds
//! unchanged.

use super::problem::CounterweightProblem;
use super::refusal::{BoundKind, BoundRelaxation};
use super::search_node::SearchNode;
use super::spec::CounterweightSpec;
use super::task::CounterweightTask;

/// Factor by which all but the last of several bounds are relaxed beyond their minimum, so that the last needs less
/// relaxation.
const FIRST_BOUND_FACTOR: f64 = 1.1;

/// Fractions by which a relaxed bound is relaxed further, against the solver's rounding, until there is a solution.
const EXTRA_FRACTIONS: [f64; 6] = [0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// Number of bisection steps for a clearance or a distance from the axes.
const BISECTIONS: usize = 20;

/// Relaxed clearances and distances from the axes are multiples of 1/this, m.
const STEPS_PER_M: f64 = 1e4;
/// Other relaxed bounds are multiples of 1/this, kg or kg m².
const STEPS_PER_UNIT: f64 = 1e6;

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
    let (links, payload) = (one.problem.bare.links(), one.problem.bare.spec().payload);
    let held = if payload.mass > 0.0 { payload.offset[1].abs() } else { 0.0 };
    let masses = links.iter().map(|link| link.com_normal.abs()).fold(held, f64::max);
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
            BoundKind::Across => least_across(one, &loosened(&request, &kinds[i + 1..]))?,
            _ => least_bound(one, &request, *kind, &kinds[i + 1..])?,
        };
        let relief = kind.rounded(FIRST_BOUND_FACTOR * least);
        relief.set(&mut request);
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
        relief.set(&mut request);
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
    let one = CounterweightTask { spec, ..*one };
    let way = SearchNode { loose: loose.to_vec(), least: Some(kind), ..SearchNode::unconstrained(spec, one.balance()) };
    one.on(&way).ok()?.ok().map(|least| least.value.max(0.0))
}

/// Returns the greatest feasible clearance of discs from pins, m, by bisection; `None` if even 0 is infeasible.
fn greatest_clearance(one: &CounterweightTask, request: &CounterweightSpec) -> Option<f64> {
    let is_clear = |clearance: f64| {
        let request = CounterweightSpec { clearance: Some(clearance), ..request.clone() };
        CounterweightTask { spec: &request, ..*one }.is_possible()
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

/// Returns the request without the bounds of these kinds.
fn loosened(request: &CounterweightSpec, kinds: &[BoundKind]) -> CounterweightSpec {
    let mut request = request.clone();
    for kind in kinds {
        match kind {
            BoundKind::Most => request.sites.iter_mut().for_each(|site| site.most = f64::INFINITY),
            BoundKind::Mass => request.max_added_mass = None,
            BoundKind::Inertia => request.max_inertia = None,
            BoundKind::Clearance => request.clearance = None,
            BoundKind::Across => {}
        }
    }
    request
}

/// Returns the least sufficient distance of counterweights from the axes of their links, m, by bisection; `None` if even
/// the reach of the machine is not sufficient.
fn least_across(one: &CounterweightTask, request: &CounterweightSpec) -> Option<f64> {
    let is_enough = |across: f64| {
        let mut request = request.clone();
        BoundRelaxation::Across(across).set(&mut request);
        let problem = CounterweightProblem::new(one.machine, &request, one.beyond).ok();
        let is_possible = |problem: &CounterweightProblem| {
            problem.check().is_ok() && CounterweightTask { problem, spec: &request, ..*one }.is_possible()
        };
        problem.is_some_and(|problem| is_possible(&problem))
    };
    let reach = one.problem.reach;
    if !is_enough(reach) {
        return None;
    }
    let bisected = |[low, high]: [f64; 2], _| {
        let middle = 0.5 * (low + high);
        if is_enough(middle) { [low, middle] } else { [middle, high] }
    };
    Some((0..BISECTIONS).fold([0.0, reach], bisected)[1])
}

/// Returns the value of a number printed with `decimals` decimals.
fn rounded_as_printed(x: f64, decimals: usize) -> f64 {
    format!("{x:.decimals$}").parse().unwrap_or(x)
}

impl BoundKind {
    /// Returns the kinds of bounds that are set, the clearance last.
    fn of(request: &CounterweightSpec) -> Vec<Self> {
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
    fn rounded(self, bound: f64) -> BoundRelaxation {
        let up = rounded_as_printed((bound * STEPS_PER_UNIT).ceil().max(1.0) / STEPS_PER_UNIT, 6);
        match self {
            Self::Most => BoundRelaxation::Most(up),
            Self::Mass => BoundRelaxation::Mass(up),
            Self::Inertia => BoundRelaxation::Inertia(up),
            Self::Clearance => {
                BoundRelaxation::Clearance(rounded_as_printed((bound * STEPS_PER_M).floor() / STEPS_PER_M, 4))
            }
            Self::Across => BoundRelaxation::Across(rounded_as_printed((bound * STEPS_PER_M).ceil() / STEPS_PER_M, 4)),
        }
    }
}

impl BoundRelaxation {
    fn set(self, request: &mut CounterweightSpec) {
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
