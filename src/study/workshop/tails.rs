//! [`TailSearch`]: the lengths of bars with which discs on them balance a machine best.
//!
//! Bars on which discs lie within all bounds need not be as long as they can be, nor all alike. So if none of the first
//! ones are such, those are sought that come nearest to the bounds.

use stillbase_mechanics::balance::Condition;
use stillbase_mechanics::counterweights::{
    BoundKind, BoundRelaxation, CounterweightError, CounterweightSpec, EXTRA_FRACTIONS, PlacedCounterweights,
    RelaxedBounds, over_payloads, place_weights, relaxed_weights_if_any, weights_if_any,
};
use stillbase_mechanics::machine::{BarStock, Inertia, Machine, MachineError};

use super::{NoCut, Unsettled, on_reach};

/// Shares of the greatest tails that are tried first, for all links alike.
const SHARES: [f64; 8] = [1.0, 0.75, 0.55, 0.4, 0.25, 0.12, 0.05, 0.0];
/// Factors by which each tail is then changed by itself, and the number of passes over all.
const FACTORS: [f64; 3] = [0.0, 0.7, 1.3];
const PASSES: usize = 2;
/// Shares of the way from the bars nearest to the bounds to those that are best without bounds.
const BLENDS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];
/// Maximum number of rounds until discs beside their bars agree with their arms, and until nothing is left to trim.
pub(super) const MAX_ROUNDS: usize = 60;
/// Largest change of (7) and (8) by new arms at which bars and discs agree, as a fraction of the tolerance of balance.
const SETTLED: f64 = 1e-4;
/// Weight of the mass of bars, relative to that of the machine, against objectives without mass.
const TIE_BREAK: f64 = 1e-6;
/// Places closer than this, relative to the longest bar, are one.
const SAME_PLACE: f64 = 1e-9;
/// Residuals closer than this part of them are one.
const SAME_RESIDUAL: f64 = 1e-6;
/// Factor on the least value of several bounds that are relaxed together.
const TOGETHER: f64 = 1.001;

/// What is minimised, within which bounds.
#[derive(Clone)]
struct Goal {
    request: CounterweightSpec,
    /// Bounds that are minimised instead of the objective.
    relaxed: Option<RelaxedBounds>,
}

impl Goal {
    fn of(request: &CounterweightSpec, relaxed: impl Into<Option<RelaxedBounds>>) -> Self {
        Self { request: request.clone(), relaxed: relaxed.into() }
    }

    /// Returns the kinds of bounds that hold.
    fn firm(&self) -> Vec<BoundKind> {
        let limited = self.request.limited().into_iter();
        match self.relaxed {
            None => limited.collect(),
            Some(RelaxedBounds::Value(kind)) => limited.filter(|own| *own != kind).collect(),
            Some(RelaxedBounds::Factor) => Vec::new(),
        }
    }
}

/// Ends of the bar of each link, m from its root.
type Reach = Vec<[f64; 2]>;

/// Discs on given bars, if there are any.
type Placement = Result<Option<PlacedCounterweights>, CounterweightError>;

/// Discs on bars of known lengths.
#[derive(Clone)]
pub(super) struct Attempt {
    pub reach: Reach,
    pub placed: PlacedCounterweights,
    /// Largest residual over a range of payloads, kg m; that of (8) counts divided by the reach. 0 without a range.
    residual: f64,
    /// Value of what is minimised, with the mass of the bars.
    value: f64,
}

impl Attempt {
    /// Returns whether it is better than another: of less residual over the payloads, or of the same and less value.
    fn is_better_than(&self, other: &Self) -> bool {
        let [own, others] = [self.residual, other.residual];
        if (own - others).abs() > SAME_RESIDUAL * own.max(others) { own < others } else { self.value < other.value }
    }
}

/// A search for the lengths of bars.
pub(super) struct TailSearch<'a> {
    bare: &'a Machine,
    request: &'a CounterweightSpec,
    stock: &'a BarStock,
    pub tried: usize,
}

impl<'a> TailSearch<'a> {
    pub fn new(bare: &'a Machine, request: &'a CounterweightSpec, stock: &'a BarStock) -> Self {
        Self { bare, request, stock, tried: 0 }
    }

    /// Returns the best bars and the discs on them.
    ///
    /// # Errors
    /// If the stock does not fit, or on none of the bars there are discs within the bounds: with bounds that would do.
    pub fn best(&mut self) -> Result<Attempt, NoCut> {
        let goal = Goal::of(self.request, None);
        let reach = match self.start(&goal) {
            Ok(start) => return Ok(self.refined(&goal, start)),
            Err(reach) => reach,
        };
        let explained = |bars: &Machine, request: &CounterweightSpec| place_weights(bars, request).map(Some);
        match self.placed(&goal, &reach, &explained) {
            Err(NoCut::Weights(
                why @ (CounterweightError::Conflict { .. }
                | CounterweightError::Reaches { .. }
                | CounterweightError::OffAxis { .. }),
            )) => Err(self.refusal(why)),
            Err(why) => Err(why),
            Ok(_) => Err(NoCut::Weights(CounterweightError::TooFew)),
        }
    }

    /// Returns bars with which a goal can be met, the best of the first ones. If there are none, returns those that say
    /// why: the longest, or those that come nearest to the bounds.
    fn start(&mut self, goal: &Goal) -> Result<Attempt, Reach> {
        let mut found = Err(self.reach(SHARES[0]));
        for share in SHARES {
            self.take(&mut found, goal, &self.reach(share));
        }
        let firm = goal.firm();
        if firm.is_empty() {
            return found;
        }
        let free = Goal::of(&goal.request.without_bounds(&firm), goal.relaxed);
        let ideal = self.start(&free).map(|start| self.refined(&free, start).reach).ok();
        if let Some(ideal) = &ideal {
            self.take(&mut found, goal, ideal);
        }
        if found.is_err() {
            let mut request = goal.request.clone();
            if let Some(RelaxedBounds::Value(kind)) = goal.relaxed {
                request = request.without_bounds(&[kind]);
            }
            let single = if firm.len() > 1 { firm } else { Vec::new() };
            let nearest = [RelaxedBounds::Factor].into_iter().chain(single.into_iter().map(RelaxedBounds::Value));
            for relaxed in nearest {
                let near = Goal::of(&request, relaxed);
                let Ok(start) = self.start(&near) else { continue };
                let reach = self.refined(&near, start).reach;
                if let (Err(nearest), RelaxedBounds::Factor) = (&mut found, relaxed) {
                    nearest.clone_from(&reach);
                }
                let mix = |a: f64, b: f64, by: f64| a + by * (b - a);
                for by in BLENDS {
                    let blend = |(own, other): (&[f64; 2], &[f64; 2])| [0, 1].map(|i| mix(own[i], other[i], by));
                    let reach: Reach = reach.iter().zip(ideal.as_ref().unwrap_or(&reach)).map(blend).collect();
                    self.take(&mut found, goal, &reach);
                }
                if found.is_ok() {
                    break;
                }
            }
        }
        found
    }

    /// Returns better bars, from others on: each tail is changed by itself, then what nothing needs is cut off.
    fn refined(&mut self, goal: &Goal, mut best: Attempt) -> Attempt {
        for factor in FACTORS.iter().cycle().take(PASSES * FACTORS.len()) {
            for i in 0..self.request.sites.len() {
                let reach = self.stretched(&best.reach, i, *factor);
                self.improve(goal, &mut best, &reach);
            }
        }
        self.trim(goal, &mut best);
        best
    }

    /// Returns why no bars meet the bounds of the request, with bounds that would do; `why` is that of the bars nearest
    /// to them.
    fn refusal(&mut self, why: CounterweightError) -> NoCut {
        let request = self.request;
        let mut would = Vec::new();
        for kind in request.limited() {
            let goal = Goal::of(request, RelaxedBounds::Value(kind));
            if let Ok(start) = self.start(&goal) {
                let least = self.refined(&goal, start).placed.value;
                would.extend(self.sufficient(&[(kind, least)]));
            }
        }
        // Bounds of places are those of single bars; whether they do on the bars that are tried is seen.
        let of_bars = match &why {
            CounterweightError::Conflict { reliefs, .. }
            | CounterweightError::Reaches { reliefs, .. }
            | CounterweightError::OffAxis { reliefs, .. } => reliefs.clone(),
            _ => Vec::new(),
        };
        for relief in of_bars {
            let is_of_places =
                relief.iter().all(|one| matches!(one, BoundRelaxation::Clearance(_) | BoundRelaxation::Across(_)));
            if is_of_places && self.is_feasible(&relief) {
                would.push(relief);
            }
        }
        if would.is_empty() && !request.limited().is_empty() {
            would.extend(self.all_together());
        }
        let mut why = why;
        if let CounterweightError::Conflict { reliefs, .. }
        | CounterweightError::Reaches { reliefs, .. }
        | CounterweightError::OffAxis { reliefs, .. } = &mut why
        {
            *reliefs = would;
        }
        NoCut::Bounds { tried: self.tried, why }
    }

    /// Returns bounds of all kinds, each relaxed by the same factor.
    fn all_together(&mut self) -> Option<Vec<BoundRelaxation>> {
        let goal = Goal::of(self.request, RelaxedBounds::Factor);
        let start = self.start(&goal).ok()?;
        let factor = TOGETHER * self.refined(&goal, start).placed.value;
        let request = self.request;
        let most = request.sites.iter().map(|site| site.most).filter(|most| most.is_finite()).fold(0.0, f64::max);
        let value = |kind: BoundKind| match kind {
            BoundKind::Most => most,
            BoundKind::Mass => request.max_added_mass.unwrap_or_default(),
            _ => request.max_inertia.unwrap_or_default(),
        };
        let all: Vec<_> = request.limited().into_iter().map(|kind| (kind, factor * value(kind))).collect();
        self.sufficient(&all)
    }

    /// Returns these least bounds, rounded to the feasible side, and a little wider where rounding asks for it.
    fn sufficient(&mut self, least: &[(BoundKind, f64)]) -> Option<Vec<BoundRelaxation>> {
        EXTRA_FRACTIONS.into_iter().find_map(|extra| {
            let relief: Vec<_> = least.iter().map(|(kind, least)| kind.rounded(least * (1.0 + extra))).collect();
            self.is_feasible(&relief).then_some(relief)
        })
    }

    /// Returns whether bars are found if the request has these bounds in place of its own.
    fn is_feasible(&mut self, relief: &[BoundRelaxation]) -> bool {
        let mut request = self.request.clone();
        relief.iter().for_each(|one| one.enter(&mut request));
        let mut search = TailSearch { bare: self.bare, request: &request, stock: self.stock, tried: self.tried };
        let is_feasible = search.start(&Goal::of(&request, None)).is_ok();
        self.tried = search.tried;
        is_feasible
    }

    /// Returns the ends of all bars if each takes a share of the length that the bounds allow beyond its pins.
    fn reach(&self, share: f64) -> Reach {
        let mut reach: Reach = (0..self.bare.links().len()).map(|link| self.bare.least_extent(link)).collect();
        for site in &self.request.sites {
            let Some([from, to]) = reach.get_mut(site.link) else { continue };
            *from += share * (site.from - *from).min(0.0);
            *to += share * (site.to - *to).max(0.0);
        }
        reach
    }

    /// Returns the ends of all bars, with the tail at one site longer by a factor; 0 leaves none.
    fn stretched(&self, reach: &[[f64; 2]], i: usize, factor: f64) -> Reach {
        let site = &self.request.sites[i];
        let [from, to] = self.bare.least_extent(site.link);
        let [low, high] = reach[site.link];
        let mut reach = reach.to_vec();
        reach[site.link] =
            [(from + factor * (low - from)).max(site.from.min(from)), (to + factor * (high - to)).min(site.to.max(to))];
        reach
    }

    /// Places discs on bars with these ends; `None` if there are none.
    fn attempt(&mut self, goal: &Goal, reach: &[[f64; 2]]) -> Option<Attempt> {
        self.tried += 1;
        let place = |bars: &Machine, request: &CounterweightSpec| match goal.relaxed {
            None => weights_if_any(bars, request),
            Some(relaxed) => relaxed_weights_if_any(bars, request, relaxed),
        };
        let placed = self.placed(goal, reach, &place).ok()??;
        let bars: f64 = placed.machine.part_bodies().iter().map(|part| part.body.mass).sum();
        // Mass breaks ties between bars that what is minimised does not tell apart.
        let tie_break = TIE_BREAK * placed.unit / self.bare.mass();
        let by_mass = if goal.relaxed.is_none() { goal.request.objective.mass } else { 0.0 };
        let value = placed.value + by_mass.max(tie_break) * bars;
        Some(Attempt { reach: reach.to_vec(), residual: residual_over_payloads(&placed.machine, goal), placed, value })
    }

    /// Takes bars with these ends if they are the first, or better.
    fn take(&mut self, found: &mut Result<Attempt, Reach>, goal: &Goal, reach: &[[f64; 2]]) {
        let is_worse = |other: &Attempt| found.as_ref().is_ok_and(|best| !other.is_better_than(best));
        if let Some(other) = self.attempt(goal, reach).filter(|other| !is_worse(other)) {
            *found = Ok(other);
        }
    }

    /// Takes bars with these ends if they are better; returns whether they are.
    fn improve(&mut self, goal: &Goal, best: &mut Attempt, reach: &[[f64; 2]]) -> bool {
        let found = if reach == best.reach { None } else { self.attempt(goal, reach) };
        match found.filter(|found| found.is_better_than(best)) {
            Some(found) => {
                *best = found;
                true
            }
            None => false,
        }
    }

    /// Places discs on bars with these ends; the arms of discs beside their bars are weighed. `None` if `place` finds
    /// none.
    fn placed(
        &self,
        goal: &Goal,
        reach: &[[f64; 2]],
        place: &dyn Fn(&Machine, &CounterweightSpec) -> Placement,
    ) -> Result<Option<PlacedCounterweights>, NoCut> {
        let mut request = goal.request.clone();
        on_reach(&mut request.sites, reach);
        let mut bars = self.bare.with_bars(self.stock, reach)?;
        let mut last = None;
        for _ in 0..MAX_ROUNDS {
            let Some(placed) = place(&bars, &request)? else { return Ok(None) };
            let cut = with_arms(&placed.machine, self.stock, reach)?;
            let Some(change) = most_changed(&placed.machine, &cut) else {
                return Ok(Some(PlacedCounterweights { machine: cut, ..placed }));
            };
            (bars, last) = (cut, Some(change));
        }
        Err(last.map_or(NoCut::Weights(CounterweightError::TooFew), NoCut::Unsettled))
    }

    /// Cuts off what reaches beyond pins and discs, as long as discs on the shorter bars are better.
    fn trim(&mut self, goal: &Goal, best: &mut Attempt) {
        for _ in 0..MAX_ROUNDS {
            let needed = |(link, reach): (usize, &[f64; 2])| {
                let [from, to] = best.placed.machine.extent_with(link, |_| true);
                [from.max(reach[0]), to.min(reach[1])]
            };
            let shorter: Reach = best.reach.iter().enumerate().map(needed).collect();
            let cut_off = |(was, is): (&[f64; 2], &[f64; 2])| (is[0] - was[0]).max(was[1] - is[1]);
            let most = best.reach.iter().zip(&shorter).map(cut_off).fold(0.0, f64::max);
            let longest = best.reach.iter().map(|[from, to]| to - from).fold(0.0, f64::max);
            if most <= SAME_PLACE * longest || !self.improve(goal, best, &shorter) {
                return;
            }
        }
    }
}

/// Returns the largest residual of a machine over the range of payloads of a goal, kg m; 0 if there is no range.
fn residual_over_payloads(machine: &Machine, goal: &Goal) -> f64 {
    let Some([low, high]) = goal.request.payload.filter(|[low, high]| low < high) else { return 0.0 };
    let ends = over_payloads(machine, [low, high], 2).unwrap_or_default();
    ends.iter().map(|end| end.force.max(end.coupling / machine.reach())).fold(0.0, f64::max)
}

/// Returns the condition of (7) or (8) whose residual differs most between two machines, and by how much, kg m or kg m²;
/// `None` if all agree to rounding.
fn most_changed(machine: &Machine, other: &Machine) -> Option<Unsettled> {
    let (inertia, new) = (Inertia::of(machine), Inertia::of(other));
    let change = |condition: &Condition| (condition.residual(&new) - condition.residual(&inertia)).norm();
    let relative = |condition: &Condition| change(condition) / condition.tolerance(&new);
    let all = Condition::all_of(machine);
    let most = all.max_by(|a, b| relative(a).total_cmp(&relative(b)))?;
    (relative(&most) > SETTLED).then(|| Unsettled { condition: most, change: change(&most), drives: machine.drives() })
}

/// Returns a machine with arms for the discs beside its bars, which reach over `reach`, m, the feet of their arms, and the
/// walls of half rings.
pub(super) fn with_arms(machine: &Machine, stock: &BarStock, reach: &[[f64; 2]]) -> Result<Machine, MachineError> {
    let armed = machine.with_bars(stock, reach)?.with_arms(stock)?;
    let mut feet = reach.to_vec();
    for weight in &machine.spec().counterweights {
        let Some(link) = machine.spec().link_index(&weight.link) else { continue };
        let at = weight.carried_at();
        // A bar that reaches its centre of mass goes on to its wall.
        if at != weight.at {
            feet[link] = [feet[link][0].min(at), feet[link][1].max(at)];
        }
    }
    for arm in armed.spec().parts.iter().filter(|part| part.is_arm()) {
        let Some(link) = armed.spec().link_index(&arm.link) else { continue };
        for [at, _] in &arm.polygon {
            feet[link] = [feet[link][0].min(*at), feet[link][1].max(*at)];
        }
    }
    if feet == reach { Ok(armed) } else { machine.with_bars(stock, &feet)?.with_arms(stock) }
}
