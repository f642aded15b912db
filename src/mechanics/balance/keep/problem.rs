//! [`rebalance`]: the balanced machine with the least change.

use nalgebra::DVector;

use super::super::breakdown::Body;
use super::super::condition::Condition;
use super::super::parameter::{BodyQuantity, Parameter};
use super::super::plane::{LinearEquation, SolutionSpace};
use super::refusal::{LimitRelaxation, LimitSide, ParameterLimit, RebalanceError};
use super::request::{ListedParameter, MIN_MASS, ParameterBounds, RebalanceRequest};
use super::search::{MassVariable, RebalanceSearch};
use crate::machine::{BALANCE_TOLERANCE, Inertia, Machine, MachineError, MachineSpec};
use crate::planar::Vector;
use stillbase_convex::{LinearRow, Program, infeasible_bounds};

/// A machine balanced by the least change of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct RebalancedMachine {
    /// The machine, balanced to rounding.
    pub machine: Machine,
    /// Value of each parameter, kg or m, in the order of the request.
    pub values: Vec<f64>,
    /// Value of the objective: Σ (p Δ)² over the parameters that are not fixed; p is the penalty, Δ the change.
    pub cost: f64,
    /// Whether the cost is certified as the global minimum within the limits. If a body may change both its mass and a
    /// position, the answer is only the best of several searches.
    pub certified: bool,
}

impl RebalancedMachine {
    /// Returns the keys and values of all settings in which this machine differs from `of`, including the sizes of
    /// counterweights.
    pub fn settings(&self, of: &Machine) -> Vec<(String, f64)> {
        let (now, was) = (self.machine.spec(), of.spec());
        let changed = Parameter::all(&self.machine).into_iter().filter_map(|parameter| {
            let value = parameter.value(now)?;
            (parameter.value(was) != Some(value)).then(|| (parameter.key(of), value))
        });
        let weights = now.counterweights.iter().zip(&was.counterweights).enumerate();
        let sizes = weights.filter_map(|(i, (now, was))| {
            let ((key, now), (_, was)) = (now.free_size(), was.free_size());
            (now != was).then(|| (format!("counterweight.{}.{key}", i + 1), now))
        });
        changed.chain(sizes).collect()
    }
}

/// Returns the balanced, invariant machine, (7) and (8), with the least change of the listed parameters.
///
/// # Errors
/// If the list is not valid, no such machine exists, or the solver fails. If limits contradict each other, the error
/// names them, and relaxed values that are sufficient if any were found.
pub fn rebalance(machine: &Machine, request: &RebalanceRequest) -> Result<RebalancedMachine, RebalanceError> {
    rebalance_with(machine, request, &[])
}

/// As [`rebalance`], but each condition has a known additional residual in `beyond`, kg m or kg m², in the order of
/// [`Condition::all`]. The sums of computed and additional residuals must vanish.
///
/// # Errors
/// As [`rebalance`].
pub fn rebalance_with(
    machine: &Machine,
    request: &RebalanceRequest,
    beyond: &[Vector],
) -> Result<RebalancedMachine, RebalanceError> {
    request.check(machine)?;
    let problem = Problem::of(machine, request, beyond)?;
    let n = request.parameters.len();
    let mut equations = problem.balance.clone();
    equations.extend((0..n).filter_map(|i| problem.fixed(i)));
    let plane = SolutionSpace::of(&equations, n);
    let bounds = problem.bounds(&problem.limits(false));
    match plane.exists.then(|| plane.nearest(&bounds)) {
        Some(Ok(nearest)) => {
            let search = problem.search(&equations, &bounds);
            let is_coupled = search.masses.iter().any(|mass| !mass.places.is_empty());
            let found = if is_coupled { search.least(&plane) } else { Vec::new() };
            let exact = found.iter().find_map(|y| problem.kept(y).ok());
            exact.map_or_else(|| problem.kept(&nearest), Ok)
        }
        Some(Err(_)) | None => Err(problem.conflict()),
    }
}

/// Returns the part of each residual, kg m or kg m², that no values of the listed parameters remove. This is the
/// residual of the least squares solution, with all equations scaled to unit norm. `beyond`: see [`rebalance_with`].
///
/// # Errors
/// If the list is not valid.
pub fn unreachable_by_changes(
    machine: &Machine,
    request: &RebalanceRequest,
    beyond: &[Vector],
) -> Result<Vec<Vector>, RebalanceError> {
    request.check(machine)?;
    let problem = Problem::of(machine, request, beyond)?;
    let n = request.parameters.len();
    let fixed = (0..n).filter_map(|i| problem.fixed(i));
    let equations: Vec<LinearEquation> = problem.balance.iter().cloned().chain(fixed).collect();
    let missed = SolutionSpace::of(&equations, n).residuals;
    let count = problem.conditions.len();
    Ok((0..count).map(|i| Vector::new(missed[i], missed[count + i])).collect())
}

/// The conditions as equations in y, and the limits of y; [`keep`](super) defines y.
struct Problem<'a> {
    machine: &'a Machine,
    request: &'a RebalanceRequest,
    /// The machine with every parameter at its reference value.
    from: MachineSpec,
    conditions: Vec<Condition>,
    /// Additional residual of each condition.
    beyond: Vec<Vector>,
    /// The real parts of all conditions, then the imaginary ones.
    balance: Vec<LinearEquation>,
}

impl<'a> Problem<'a> {
    fn of(machine: &'a Machine, request: &'a RebalanceRequest, beyond: &[Vector]) -> Result<Self, RebalanceError> {
        let mut from = machine.spec().clone();
        for one in &request.parameters {
            one.parameter.set(&mut from, one.from);
        }
        let (start, scale) = (Inertia::of(&Machine::new(from.clone()).map_err(of_machine)?), Inertia::of(machine));
        let conditions: Vec<Condition> = Condition::all_of(machine).collect();
        let more = |i: usize| beyond.get(i).copied().unwrap_or_default();
        let beyond = (0..conditions.len()).map(more).collect();
        let mut problem = Self { machine, request, from, conditions, beyond, balance: Vec::new() };
        for across in [false, true] {
            for (&condition, beyond) in problem.conditions.iter().zip(&problem.beyond) {
                let a = request.parameters.iter().map(|one| problem.by(condition, one.parameter, across) / one.penalty);
                let residual = condition.residual(&start) + beyond;
                // Ten times stricter than the check of the finished machine.
                let tolerance = 0.1 * condition.tolerance(&scale).max(condition.tolerance(&start));
                let equation = LinearEquation {
                    a: a.collect(),
                    right: if across { -residual.im } else { -residual.re },
                    tolerance,
                };
                problem.balance.push(equation);
            }
        }
        Ok(problem)
    }

    /// Returns the derivative of a condition by a parameter, per kg or per m: the imaginary part if `across`, otherwise
    /// the real part.
    fn by(&self, condition: Condition, parameter: Parameter, across: bool) -> f64 {
        let mass = self.mass_from(parameter.body);
        let Some(link) = self.carrier(parameter.body) else { return 0.0 };
        let part = &self.machine.resolved_links()[link];
        let at =
            |quantity: BodyQuantity| Parameter::new(parameter.body, quantity).value(&self.from).unwrap_or_default();
        match (parameter.quantity, across) {
            (BodyQuantity::Mass, false) => {
                condition.by_mass(part) + at(BodyQuantity::Along) * condition.by_moment(part)
            }
            (BodyQuantity::Mass, true) => at(BodyQuantity::Across) * condition.by_cross_moment(part),
            (BodyQuantity::Along, false) => mass * condition.by_moment(part),
            (BodyQuantity::Across, true) => mass * condition.by_cross_moment(part),
            (BodyQuantity::Along, true) | (BodyQuantity::Across, false) => 0.0,
        }
    }

    fn carrier(&self, body: Body) -> Option<usize> {
        match body {
            Body::Link(j) => Some(j),
            Body::Counterweight(i) => self.from.link_index(&self.from.counterweights[i].link),
            Body::Payload => None,
        }
    }

    /// Returns the reference mass m₀ of a body, kg.
    fn mass_from(&self, body: Body) -> f64 {
        Parameter::new(body, BodyQuantity::Mass).value(&self.from).unwrap_or_default()
    }

    fn listed(&self, parameter: Parameter) -> Option<usize> {
        self.request.parameters.iter().position(|one| one.parameter == parameter)
    }

    /// Returns the minimisation problem for bodies whose mass and position may both change.
    fn search<'b>(&self, equations: &'b [LinearEquation], bounds: &'b [LinearRow]) -> RebalanceSearch<'b> {
        let all = || self.request.parameters.iter().enumerate();
        let masses = all().filter(|(_, one)| one.parameter.quantity == BodyQuantity::Mass).map(|(at, one)| {
            let places = all().filter(|(_, other)| {
                other.parameter.body == one.parameter.body
                    && other.parameter.quantity != BodyQuantity::Mass
                    && other.bounds != ParameterBounds::Fixed
            });
            let ends = one.ends(self.machine).unwrap_or([one.from; 2]);
            MassVariable { at, from: one.from, penalty: one.penalty, ends, places: places.map(|(i, _)| i).collect() }
        });
        let counts = all().map(|(_, one)| one.bounds != ParameterBounds::Fixed).collect();
        RebalanceSearch { equations, counts, masses: masses.collect(), bounds }
    }

    /// Returns whether the problem is a convex quadratic program: no body may change both its mass and a position.
    fn is_convex(&self) -> bool {
        let all = || {
            self.request.parameters.iter().filter(|one| one.bounds != ParameterBounds::Fixed).map(|one| one.parameter)
        };
        let mut masses = all().filter(|mass| mass.quantity == BodyQuantity::Mass);
        !masses.any(|mass| all().any(|other| other.body == mass.body && other != mass))
    }

    /// Returns the row a · y = right that gives parameter i the value `value`, kg or m.
    fn row(&self, i: usize, value: f64) -> LinearRow {
        let ListedParameter { parameter, penalty, from, .. } = self.request.parameters[i];
        let mut terms = vec![(i, 1.0)];
        let of_body = self.listed(Parameter::new(parameter.body, BodyQuantity::Mass));
        if let (Some(k), true) = (of_body, parameter.quantity != BodyQuantity::Mass) {
            let by = penalty * (value - from) / self.mass_from(parameter.body);
            terms.push((k, -by / self.request.parameters[k].penalty));
        }
        LinearRow::new(terms, penalty * (value - from))
    }

    /// Returns the equation of parameter i if it is fixed.
    fn fixed(&self, i: usize) -> Option<LinearEquation> {
        let one = &self.request.parameters[i];
        let value = one.parameter.value(self.machine.spec()).filter(|_| one.bounds == ParameterBounds::Fixed)?;
        let row = self.row(i, value);
        let mut a = vec![0.0; self.request.parameters.len()];
        row.terms.iter().for_each(|&(j, by)| a[j] += by);
        // Corresponds to at least 1e-12 m or kg.
        let tolerance = one.penalty * BALANCE_TOLERANCE * (value.abs() + one.from.abs()).max(1e-3);
        Some(LinearEquation { a, right: row.right, tolerance })
    }

    /// Returns the limits with their rows a · y ≤ right; limits of fixed parameters are included only if `fixed`.
    fn limits(&self, fixed: bool) -> Vec<(ParameterLimit, LinearRow)> {
        let mut all = Vec::new();
        for (i, one) in self.request.parameters.iter().enumerate() {
            let ends = one.ends(self.machine).filter(|_| fixed || one.bounds != ParameterBounds::Fixed);
            for (side, value) in [LimitSide::Least, LimitSide::Most].into_iter().zip(ends.into_iter().flatten()) {
                let (key, fixed) = (one.parameter.key(self.machine), one.bounds == ParameterBounds::Fixed);
                let is_default = one.bounds == ParameterBounds::Free;
                let carrier = match one.parameter.body {
                    Body::Counterweight(i) => Some(self.from.counterweights[i].link.clone()),
                    _ => None,
                };
                let limit = ParameterLimit { parameter: one.parameter, key, carrier, side, fixed, is_default, value };
                all.push((limit, self.limit(i, side, value)));
            }
        }
        all
    }

    /// Returns the rows that keep every mass positive, followed by the rows of `limits`.
    fn bounds(&self, limits: &[(ParameterLimit, LinearRow)]) -> Vec<LinearRow> {
        self.floors().chain(limits.iter().map(|(_, row)| row.clone())).collect()
    }

    fn floors(&self) -> impl Iterator<Item = LinearRow> {
        let masses = self.request.parameters.iter().enumerate();
        masses.filter(|(_, one)| one.parameter.quantity == BodyQuantity::Mass).map(|(i, one)| {
            let present = one.parameter.value(self.machine.spec()).unwrap_or(one.from);
            self.limit(i, LimitSide::Least, MIN_MASS * one.from.min(present))
        })
    }

    fn limit(&self, i: usize, side: LimitSide, value: f64) -> LinearRow {
        let mut row = self.row(i, value);
        if side == LimitSide::Least {
            row.terms.iter_mut().for_each(|(_, by)| *by = -*by);
            row.right = -row.right;
        }
        row
    }

    /// Returns the value of parameter i at y, kg or m.
    fn value(&self, i: usize, y: &DVector<f64>) -> f64 {
        let one = &self.request.parameters[i];
        let change = |i: usize| y[i] / self.request.parameters[i].penalty;
        let ratio = match self.listed(Parameter::new(one.parameter.body, BodyQuantity::Mass)) {
            Some(k) if one.parameter.quantity != BodyQuantity::Mass => {
                let mass = self.mass_from(one.parameter.body);
                mass / (mass + change(k))
            }
            _ => 1.0,
        };
        one.from + change(i) * ratio
    }

    fn kept(&self, y: &DVector<f64>) -> Result<RebalancedMachine, RebalanceError> {
        let (mut spec, mut values, mut cost) = (self.machine.spec().clone(), Vec::new(), 0.0);
        for (i, one) in self.request.parameters.iter().enumerate() {
            let value = match (one.bounds, one.ends(self.machine)) {
                (ParameterBounds::Fixed, _) | (_, None) => one.parameter.value(&spec).unwrap_or_default(),
                (_, Some([low, high])) => self.value(i, y).clamp(low, high),
            };
            if one.bounds != ParameterBounds::Fixed {
                one.parameter.set(&mut spec, value);
                cost += (one.penalty * (value - one.from)).powi(2);
            }
            values.push(value);
        }
        let machine = Machine::new(spec).map_err(of_machine)?;
        let inertia = Inertia::of(&machine);
        let conditions = self.conditions.iter().zip(&self.beyond);
        let tolerance = |condition: &Condition| condition.tolerance(&inertia);
        let balanced = |(condition, beyond): (&Condition, &Vector)| {
            (condition.residual(&inertia) + beyond).norm() <= tolerance(condition)
        };
        match conditions.into_iter().all(balanced) {
            true => Ok(RebalancedMachine { machine, values, cost, certified: self.is_convex() }),
            false => Err(RebalanceError::Failed("its result is not balanced within rounding".into())),
        }
    }

    /// Returns the reason why there is no solution.
    fn conflict(&self) -> RebalanceError {
        let plane = SolutionSpace::of(&self.balance, self.request.parameters.len());
        if !plane.exists {
            return self.inconsistent(&plane);
        }
        let limits = self.limits(true);
        let solve = |limits: &[(ParameterLimit, LinearRow)]| plane.nearest(&self.bounds(limits));
        match solve(&limits) {
            Ok(_) => RebalanceError::Failed("limits that contradict each other by no more than rounding".into()),
            Err(multipliers) => {
                let relief = self.relief(&plane, &limits);
                let limits = infeasible_bounds(limits, &multipliers, |some| solve(some).is_err());
                if limits.is_empty() { RebalanceError::NoMass } else { RebalanceError::Conflict { limits, relief } }
            }
        }
    }

    fn inconsistent(&self, plane: &SolutionSpace) -> RebalanceError {
        let n = self.conditions.len();
        let residual = |i: usize| plane.residuals[i].hypot(plane.residuals[n + i]);
        let off: Vec<usize> = (0..n).filter(|i| residual(*i) > self.balance[*i].tolerance).collect();
        let force = off.iter().any(|i| matches!(self.conditions[*i], Condition::Force(_)));
        let of_kind = off.iter().copied().filter(|i| matches!(self.conditions[*i], Condition::Force(_)) == force);
        let worst = of_kind.max_by(|a, b| residual(*a).total_cmp(&residual(*b))).unwrap_or_default();
        let condition = self.conditions[worst];
        let left = format!("{:.3e} {}", residual(worst), condition.unit());
        RebalanceError::Inconsistent { condition: condition.name(self.machine), residual: left }
    }

    /// Returns the relaxed limits with the least Σ p |change| that make the problem feasible. Default bounds are
    /// relaxed only if that is necessary. Empty if the solver finds no solution.
    fn relief(&self, plane: &SolutionSpace, limits: &[(ParameterLimit, LinearRow)]) -> Vec<LimitRelaxation> {
        let mut reliefs = [false, true].into_iter().map(|usual| self.relief_of(plane, limits, usual));
        reliefs.find(|relief| !relief.is_empty()).unwrap_or_default()
    }

    fn relief_of(
        &self,
        plane: &SolutionSpace,
        limits: &[(ParameterLimit, LinearRow)],
        relax_defaults: bool,
    ) -> Vec<LimitRelaxation> {
        let widest = self.request.parameters.iter().enumerate().filter(|_| !relax_defaults).flat_map(|(i, one)| {
            let ends =
                [LimitSide::Least, LimitSide::Most].into_iter().zip(one.widest(self.machine).into_iter().flatten());
            ends.map(move |(side, value)| self.limit(i, side, value))
        });
        let (m, c) = plane.reduced_bounds(&widest.chain(self.bounds(limits)).collect::<Vec<_>>());
        let (k, floors, scale) = (m.ncols(), c.len() - limits.len(), c.amax().max(f64::MIN_POSITIVE));
        let mut program = Program::over(k);
        program.linear.resize(k + limits.len(), 1.0);
        for i in 0..c.len() {
            let mut terms: Vec<(usize, f64)> = (0..k).map(|j| (j, m[(i, j)])).collect();
            if i >= floors {
                let slack = k + i - floors;
                program.at_most.push(LinearRow::new([(slack, -1.0)], 0.0));
                if relax_defaults || !limits[i - floors].0.is_default {
                    terms.push((slack, -1.0));
                }
            }
            program.at_most.push(LinearRow::new(terms, c[i] / scale));
        }
        let Ok(least) = program.solve() else { return Vec::new() };
        let z = DVector::from_fn(k, |j, _| least.x[j] * scale);
        let y = &plane.particular + &plane.null_space * &z;
        // The relaxed limits are rounded outwards to few digits, and to fewer if the rounded limits are infeasible.
        let mut reliefs = [1e-4, 1e-3, 1e-2].into_iter().map(|step| self.relieved(limits, &y, step, scale));
        reliefs.find(|relief| plane.nearest(&self.bounds(&self.relaxed(limits, relief))).is_ok()).unwrap_or_default()
    }

    /// Returns the relaxed limits that admit y. They are rounded outwards to multiples of `step` times the power of ten
    /// above the change.
    fn relieved(
        &self,
        limits: &[(ParameterLimit, LinearRow)],
        y: &DVector<f64>,
        step: f64,
        scale: f64,
    ) -> Vec<LimitRelaxation> {
        let relief = |(limit, row): &(ParameterLimit, LinearRow)| {
            let over = row.terms.iter().map(|&(j, by)| by * y[j]).sum::<f64>() - row.right;
            let i = self.listed(limit.parameter).filter(|_| over > 1e-7 * scale)?;
            let by = (self.value(i, y) - limit.value).abs();
            let digit = step * 10.0_f64.powf(by.log10().ceil());
            let to = match limit.side {
                LimitSide::Least => ((limit.value - by) / digit).floor() - 1.0,
                LimitSide::Most => ((limit.value + by) / digit).ceil() + 1.0,
            };
            Some(LimitRelaxation { limit: limit.clone(), to: to * digit })
        };
        limits.iter().filter_map(relief).collect()
    }

    /// Returns all limits, with the relaxed values of those in `relief`.
    fn relaxed(
        &self,
        limits: &[(ParameterLimit, LinearRow)],
        relief: &[LimitRelaxation],
    ) -> Vec<(ParameterLimit, LinearRow)> {
        let row = |(limit, row): &(ParameterLimit, LinearRow)| {
            let relaxed = relief.iter().find(|relief| relief.limit == *limit).zip(self.listed(limit.parameter));
            relaxed.map_or_else(|| row.clone(), |(relief, i)| self.limit(i, limit.side, relief.to))
        };
        limits.iter().map(|both| (both.0.clone(), row(both))).collect()
    }
}

fn of_machine(why: MachineError) -> RebalanceError {
    RebalanceError::Machine(why.to_string())
}
