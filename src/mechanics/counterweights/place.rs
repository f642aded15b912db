//! [`place_weights`]: counterweights that balance a machine and minimise an objective.

use super::problem::CounterweightProblem;
use super::program::SOLVER_ROUNDING;
use super::refusal::CounterweightError;
use super::relief::{across_relief, sufficient_reliefs};
use super::search_node::BalanceGoal;
use super::spec::{CounterweightSpec, Objective};
use super::subject::{SpatialGoal, Subject};
use super::task::CounterweightTask;
use crate::assembly::{Assembly, Reacting};
use crate::machine::{Inertia, Machine};
use crate::planar::Vector;
use stillbase_convex::{NoOptimum, Optimum};

/// Counterweights, and what carries them: a machine, or an assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedCounterweights<Carrier = Machine> {
    /// The machine, or the assembly, balanced to rounding. Over a range of payloads, its largest residual is minimal, and it carries the
    /// mean payload.
    pub machine: Carrier,
    /// Total mass of the counterweights, kg.
    pub added_mass: f64,
    /// Value of the objective.
    pub value: f64,
    /// Upper bound of the difference between this value and the optimum.
    pub gap: f64,
    /// Value of the objective for the machine's own unit of mass and length: gaps are small compared with this.
    pub unit: f64,
}

impl PlacedCounterweights<Assembly> {
    /// Returns the counterweights of a machine by itself.
    pub(super) fn of_machine(self) -> PlacedCounterweights {
        let Self { machine: whole, added_mass, value, gap, unit } = self;
        PlacedCounterweights { machine: whole.blocks()[0].machine.clone(), added_mass, value, gap, unit }
    }
}

impl<Carrier> PlacedCounterweights<Carrier> {
    /// Returns the gap as a share of the value, or of the unit of the objective if that is larger.
    pub fn relative_gap(&self) -> f64 {
        self.gap / self.value.abs().max(self.unit)
    }

    /// Returns whether the value is certified as the optimum, to rounding. A search may stop before it has proved
    /// optimality.
    pub fn is_certified(&self) -> bool {
        self.relative_gap() <= 2.0 * MAX_GAP
    }
}

/// Ratio of the weight of inertia to the weight of mass, in the units of the machine. It breaks ties between solutions of equal mass.
const TIE_BREAK_WEIGHT: f64 = 1e-7;

/// A counterweight lighter than this fraction of the added mass is omitted if balance is possible without it.
const NEGLIGIBLE_MASS_FRACTION: f64 = 1e-4;

/// Largest gap to the optimum, in the unit of the objective, that is accepted for a simpler answer.
const MAX_GAP: f64 = 5e-7;

/// Finds the counterweights that make a machine balanced and invariant, (7) and (8), and minimise an objective.
/// Existing counterweights are removed first, except fixed ones.
///
/// Over a range of payloads the largest residual, |g_k| or |C_kl| divided by the reach, is minimised first, then the
/// objective. Exact balance with the mean payload attains this minimum, but other solutions may attain it as well.
///
/// # Errors
/// If the request is not valid or contradicts itself, the search or the solver gives up, or the result is invalid.
pub fn place_weights(
    machine: &Machine,
    request: &CounterweightSpec,
) -> Result<PlacedCounterweights, CounterweightError> {
    place_weights_with(machine, request, &[])
}

/// As [`place_weights`], but each condition has a known additional residual in `beyond`, kg m or kg m², in the order of
/// (7) and (8). The sums of computed and additional residuals must vanish. `beyond` has no share of the present
/// counterweights.
///
/// # Errors
/// As [`place_weights`].
pub fn place_weights_with(
    machine: &Machine,
    spec: &CounterweightSpec,
    beyond: &[Vector],
) -> Result<PlacedCounterweights, CounterweightError> {
    let whole = Assembly::from(machine.clone());
    place(Subject::machine(&whole, beyond), spec).map(PlacedCounterweights::of_machine)
}

/// Finds the counterweights of a machine, or of all blocks of an assembly together.
///
/// # Errors
/// As [`place_weights`].
pub(super) fn place(
    subject: Subject,
    spec: &CounterweightSpec,
) -> Result<PlacedCounterweights<Assembly>, CounterweightError> {
    let problem = CounterweightProblem::new(&subject, spec)?;
    let one = CounterweightTask::new(&problem, subject, spec);
    problem.check(&subject).map_err(|why| one.with_reliefs(why))?;
    one.found()?.map_err(|multipliers| one.refusal(&multipliers))
}

/// Returns whether counterweights can balance the subject; false if the solver fails.
pub(super) fn is_possible(subject: Subject, spec: &CounterweightSpec) -> bool {
    let found = |problem: &CounterweightProblem| CounterweightTask::new(problem, subject, spec).is_possible();
    CounterweightProblem::new(&subject, spec).is_ok_and(|problem| problem.check(&subject).is_ok() && found(&problem))
}

/// As [`place_weights`], but `None` where there are no counterweights: the reason, which takes longer, is not sought.
///
/// # Errors
/// If the request is not valid, a condition cannot be changed, the search or the solver gives up, or the result is
/// invalid.
pub fn weights_if_any(
    machine: &Machine,
    spec: &CounterweightSpec,
) -> Result<Option<PlacedCounterweights>, CounterweightError> {
    let whole = Assembly::from(machine.clone());
    let subject = Subject::machine(&whole, &[]);
    let problem = CounterweightProblem::new(&subject, spec)?;
    problem.check(&subject)?;
    let found = CounterweightTask::new(&problem, subject, spec).found()?.ok();
    Ok(found.map(PlacedCounterweights::of_machine))
}

/// Returns the part of each residual of (7) and (8), kg m or kg m², that no counterweights on the listed links remove,
/// even of negative mass. This is the residual of the least squares solution, with all equations scaled to unit norm.
/// Residuals across the axes of the links always remain.
///
/// # Errors
/// If the request is not valid.
pub fn unreachable_by_weights(
    machine: &Machine,
    request: &CounterweightSpec,
    beyond: &[Vector],
) -> Result<Vec<Vector>, CounterweightError> {
    let whole = Assembly::from(machine.clone());
    let problem = CounterweightProblem::new(&Subject::machine(&whole, beyond), request)?;
    Ok(problem.unreachable(request.sites.len()))
}

/// Counterweights of all blocks.
type Placed = PlacedCounterweights<Assembly>;

/// Returns the constants of each block with what it carries.
fn inertias(whole: &Assembly) -> Vec<Inertia> {
    (0..whole.blocks().len()).map(|block| whole.loaded(block).inertia).collect()
}

impl CounterweightTask<'_> {
    /// Finds the counterweights. If there are none, returns the multipliers of the bounds that prove the problem
    /// without clearance infeasible. The list is empty if only the clearance makes the problem infeasible.
    fn found(&self) -> Result<Result<Placed, Vec<f64>>, CounterweightError> {
        if self.problem.needs_nothing(self.spec) {
            let (machine, unit) = (self.problem.bare.clone(), self.unit());
            let value = self.spec.objective.of_all(0.0, &self.problem.inertias);
            return Ok(Ok(PlacedCounterweights { machine, added_mass: 0.0, value, gap: 0.0, unit }));
        }
        if self.balance() == BalanceGoal::Nearest {
            return self.nearest();
        }
        match self.least(BalanceGoal::Exact)? {
            Ok(least) => {
                let best = self.placed(&least, BalanceGoal::Exact)?;
                Ok(Ok(self.simpler(self.least_inertia(best, &least))))
            }
            Err(NoOptimum::Failed(why)) => Err(CounterweightError::Failed(why)),
            Err(NoOptimum::Contradiction(_)) if self.spec.payload.is_some() => self.nearest(),
            Err(NoOptimum::Contradiction(multipliers)) => Ok(Err(multipliers)),
        }
    }

    /// Returns the solution of least inertia among those of equal mass, if only mass is minimised and Σ D_k is free.
    fn least_inertia(&self, best: Placed, least: &Optimum) -> Placed {
        let CounterweightSpec { objective, max_inertia, .. } = self.spec;
        if objective.depends_on_inertia() || objective.mass == 0.0 || max_inertia.is_some() {
            return best;
        }
        let objective = Objective { inertia: self.tie_break() * objective.mass, ..objective.clone() };
        let tied = CounterweightSpec { objective, ..self.spec.clone() };
        let one = self.with(&tied);
        let found = one.least(BalanceGoal::Exact).ok().and_then(Result::ok);
        let found = found.and_then(|tied| one.placed(&tied, BalanceGoal::Exact).ok());
        found.and_then(|found| self.within_max_gap(found, self.bound(least))).unwrap_or(best)
    }

    /// Returns a solution without the counterweights of negligible mass, if one is optimal within [`MAX_GAP`].
    fn simpler(&self, best: Placed) -> Placed {
        let masses = self.subject.masses(self.spec, &best.machine);
        // Of several blocks each has its own measure of what is light.
        let block = |j: usize| self.subject.whole.link_at(self.spec.sites[j].link).map(|(block, _)| block);
        let of_block = |j: usize| -> f64 {
            let own = masses.iter().enumerate().filter(|(i, _)| block(*i) == block(j));
            own.map(|(_, mass)| mass).sum()
        };
        let carries = |j: usize| masses[j] > 0.0 && masses[j] >= NEGLIGIBLE_MASS_FRACTION * of_block(j);
        if !(0..masses.len()).any(|j| masses[j] > 0.0 && !carries(j)) {
            return best;
        }
        let sites = (0..masses.len()).filter(|j| carries(*j)).map(|j| self.spec.sites[j]).collect();
        let fewer = CounterweightSpec { sites, ..self.spec.clone() };
        self.exact(&fewer).and_then(|found| self.within_max_gap(found, best.value - best.gap)).unwrap_or(best)
    }

    /// Returns the optimum of another request with exact balance, if there is one.
    fn exact(&self, spec: &CounterweightSpec) -> Option<Placed> {
        let problem = CounterweightProblem::new(&self.subject, spec).ok()?;
        problem.check(&self.subject).ok()?;
        let one = CounterweightTask::new(&problem, self.subject, spec);
        let least = one.least(BalanceGoal::Exact).ok()?.ok()?;
        let best = one.placed(&least, BalanceGoal::Exact).ok()?;
        Some(one.least_inertia(best, &least))
    }

    /// Returns a solution with its gap to `bound`, a lower bound of the objective; `None` if the gap is too large.
    fn within_max_gap(&self, found: Placed, bound: f64) -> Option<Placed> {
        let value = self.spec.objective.of_all(found.added_mass, &inertias(&found.machine));
        let gap = (value - bound).max(found.gap);
        (gap < MAX_GAP * self.unit()).then_some(PlacedCounterweights { value, gap, unit: self.unit(), ..found })
    }

    /// Minimises the largest residual over all payloads, then the objective. Prefers exact balance with the mean
    /// payload if its objective is no larger, within [`MAX_GAP`].
    fn nearest(&self) -> Result<Result<Placed, Vec<f64>>, CounterweightError> {
        let found = |balance| match self.least(balance)? {
            Ok(least) => Ok(Ok(least)),
            Err(NoOptimum::Contradiction(multipliers)) => Ok(Err(multipliers)),
            Err(NoOptimum::Failed(why)) => Err(CounterweightError::Failed(why)),
        };
        let worst = match found(BalanceGoal::Nearest)? {
            Ok(least) => least.value,
            Err(multipliers) => return Ok(Err(multipliers)),
        };
        let balance = BalanceGoal::Within(worst * (1.0 + SOLVER_ROUNDING[0]) + SOLVER_ROUNDING[1]);
        let least = match found(balance)? {
            Ok(least) => least,
            Err(multipliers) => return Ok(Err(multipliers)),
        };
        if let Ok(Ok(exact)) = self.least(BalanceGoal::Exact)
            && exact.value <= least.value + MAX_GAP
        {
            return Ok(Ok(self.placed(&exact, BalanceGoal::Exact)?));
        }
        Ok(Ok(self.placed(&least, balance)?))
    }

    /// Returns the unit of the objective.
    fn unit(&self) -> f64 {
        self.problem.units.objective(&self.spec.objective)
    }

    /// Returns the lower bound of the objective that an optimum proves.
    fn bound(&self, least: &Optimum) -> f64 {
        self.unit() * (least.value - least.gap)
    }

    /// Returns the weight of inertia per weight of mass that breaks ties, 1/m².
    fn tie_break(&self) -> f64 {
        TIE_BREAK_WEIGHT / self.problem.units.length.powi(2)
    }

    fn placed(&self, least: &Optimum, balance: BalanceGoal) -> Result<Placed, CounterweightError> {
        let (added_mass, machine) = self.machine(least, balance)?;
        let value = self.spec.objective.of_all(added_mass, &inertias(&machine));
        // The gap is that of the finished machine: the dual value is a lower bound of the objective.
        let gap = (value - self.bound(least)).max(self.unit() * least.gap);
        Ok(PlacedCounterweights { machine, added_mass, value, gap, unit: self.unit() })
    }

    /// Returns the added mass, kg, and the blocks of a solution.
    pub(super) fn machine(&self, least: &Optimum, balance: BalanceGoal) -> Result<(f64, Assembly), CounterweightError> {
        let (added_mass, whole) = self.problem.machine(self.spec, &self.scaled, &least.x, balance)?;
        let is_free = balance != BalanceGoal::Exact || !self.subject.beyond.is_empty();
        match is_free || (0..whole.blocks().len()).all(|block| self.is_settled(&whole, block)) {
            true => Ok((added_mass, whole)),
            false => Err(CounterweightError::Failed("rounding leaves more than balance tolerates".into())),
        }
    }

    /// Returns whether a block meets its conditions.
    fn is_settled(&self, whole: &Assembly, block: usize) -> bool {
        let (SpatialGoal { ground, tilt }, of) = (self.subject.goal(block), whole.conditions(block));
        let reacts = |why: Reacting| of.reasons().any(|own| own == why);
        of.inertia.is_balanced() && !(ground && reacts(Reacting::Ground)) && !(tilt && reacts(Reacting::Tilt))
    }

    /// Returns whether there are counterweights for another request.
    fn is_feasible(&self, spec: &CounterweightSpec) -> bool {
        let found = |problem: &CounterweightProblem| CounterweightTask::new(problem, self.subject, spec).found();
        CounterweightProblem::new(&self.subject, spec).is_ok_and(|problem| {
            problem.check(&self.subject).is_ok() && found(&problem).is_ok_and(|found| found.is_ok())
        })
    }

    /// Adds the least sufficient distance from the axes to an error about imbalance across them.
    fn with_reliefs(&self, why: CounterweightError) -> CounterweightError {
        match why {
            CounterweightError::OffAxis { condition, residual, want, .. } => {
                let reliefs = across_relief(self, &|spec| self.is_feasible(spec));
                CounterweightError::OffAxis { condition, residual, want, reliefs }
            }
            why => why,
        }
    }

    /// Returns the reason why there are no counterweights; `multipliers` come from [`found`](Self::found).
    fn refusal(&self, multipliers: &[f64]) -> CounterweightError {
        let would = || sufficient_reliefs(self, &|spec| self.is_feasible(spec));
        match self.spec.clearance {
            Some(clearance) if multipliers.is_empty() => CounterweightError::Reaches { clearance, reliefs: would() },
            _ => {
                let bounds = self.problem.conflict(&self.scaled, self.balance(), multipliers);
                match bounds.is_empty() {
                    true => CounterweightError::TooFew,
                    false => CounterweightError::Conflict { bounds, reliefs: would() },
                }
            }
        }
    }
}

impl Objective {
    /// Returns its value for an added mass, kg, and the inertia of the finished machine.
    pub fn of(&self, added_mass: f64, inertia: &Inertia) -> f64 {
        self.of_all(added_mass, std::slice::from_ref(inertia))
    }

    /// Returns its value for an added mass, kg, and the inertia of each finished block with what it carries.
    pub fn of_all(&self, added_mass: f64, inertias: &[Inertia]) -> f64 {
        let diagonal = || inertias.iter().flat_map(|own| (0..own.drives()).map(|k| own.diagonal(k)));
        let momenta = inertias.iter().flat_map(|own| (0..own.drives()).map(|k| own.momentum(k).abs()));
        let torques = diagonal().zip(&self.accelerations).map(|(h, acceleration)| h * acceleration);
        self.mass * added_mass
            + self.inertia * diagonal().sum::<f64>()
            + self.momentum * momenta.sum::<f64>()
            + self.torque * torques.fold(0.0, f64::max)
    }
}
