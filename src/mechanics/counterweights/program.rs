//! The cone program of a [`CounterweightProblem`]: its rows, and its optimum.

use super::pin_sector::PinSector;
use super::problem::CounterweightProblem;
use super::refusal::{Bound, BoundKind, RelaxedBounds};
use super::residual::ConditionResidual;
use super::search_node::{BalanceGoal, SearchNode};
use super::spec::{CounterweightSpec, Objective, RotorFreedom};
use super::unknowns::{AffineForm, UnknownIndices};
use crate::planar::Vector;
use stillbase_convex::{LinearRow, NoOptimum, Optimum, Program, infeasible_bounds};

/// Relative and absolute amount by which the first of two objectives may exceed its minimum while the second is
/// minimised: the solver's rounding.
pub(super) const SOLVER_ROUNDING: [f64; 2] = [1e-7, 1e-10];

/// Maximum number of times that tangents are added.
const MAX_TANGENTS: usize = 12;

/// An own inertia this close to its bound is exact, in the unit of inertia.
const TANGENT_TOLERANCE: f64 = 1e-11;

impl CounterweightProblem {
    /// Solves the cone program of one subproblem.
    pub fn least(&self, request: &CounterweightSpec, node: &SearchNode) -> Result<Optimum, NoOptimum> {
        let solve = |node: &SearchNode| self.with_tangents(request, node);
        let first = solve(node)?;
        if request.objective.momentum == 0.0 || node.balance == BalanceGoal::Nearest || node.least.is_some() {
            return Ok(first);
        }
        // The relaxation may overestimate inertia, so that a rotor seems to cancel more momentum than there is.
        // So of all optima, the one with the least mass plus Σ H_kk is taken: its inertias are exact where possible.
        let most = first.value + SOLVER_ROUNDING[0] * first.value.abs() + SOLVER_ROUNDING[1];
        let second = solve(&SearchNode { most: Some(most), ..node.clone() });
        Ok(second.map_or(first.clone(), |second| Optimum { x: second.x, ..first }))
    }

    /// Solves the cone program, and adds tangents of own inertias until they are exact.
    fn with_tangents(&self, request: &CounterweightSpec, node: &SearchNode) -> Result<Optimum, NoOptimum> {
        let (bounds, unknowns) = (self.bounds(request), UnknownIndices::of(request, self.drives()));
        let mut found = self.program(request, &bounds, node).solve()?;
        if !(request.stock.has_remainder() && unknowns.inertia) {
            return Ok(found);
        }
        let mut node = node.clone();
        for _ in 0..MAX_TANGENTS {
            let mut is_exact = true;
            for (j, masses) in node.own_tangents.iter_mut().enumerate() {
                let mass = found.x[unknowns.w(j)].max(0.0);
                if request.stock.own(mass) - request.stock.own_above_tangents(mass, masses) > TANGENT_TOLERANCE {
                    masses.push(mass);
                    is_exact = false;
                }
            }
            if is_exact {
                break;
            }
            found = self.program(request, &bounds, &node).solve()?;
        }
        Ok(found)
    }

    /// Returns a minimal set of bounds that contradict each other even if clearances are ignored. It is a
    /// subset of the bounds in
    /// the solver's certificate of infeasibility. Empty if the problem is infeasible even without bounds.
    pub fn conflict(&self, request: &CounterweightSpec, balance: BalanceGoal, multipliers: &[f64]) -> Vec<Bound> {
        let (bounds, node) = (self.bounds(request), SearchNode::unconstrained(request, balance));
        let any = CounterweightSpec { objective: Objective::mass(), ..request.clone() };
        let contradicts = |bounds: &[(Bound, LinearRow)]| {
            matches!(self.program(&any, bounds, &node).solve(), Err(NoOptimum::Contradiction(_)))
        };
        infeasible_bounds(bounds, multipliers, contradicts)
    }

    /// Returns the cone program of a subproblem: its unknowns, its objective, and its rows.
    pub fn program(&self, request: &CounterweightSpec, bounds: &[(Bound, LinearRow)], node: &SearchNode) -> Program {
        let unknowns = UnknownIndices::of(request, self.drives());
        let mut program = Program::over(unknowns.torque() + usize::from(request.objective.torque > 0.0));
        for j in 0..request.sites.len() {
            program.linear[unknowns.w(j)] += request.objective.mass;
            program.at_most.push(LinearRow::new([(unknowns.w(j), -1.0)], 0.0));
        }
        self.enter_rotors(request, &unknowns, &mut program);
        if unknowns.inertia {
            self.enter_inertia(request, &unknowns, node, &mut program);
            self.cost(request, &unknowns, &mut program);
            self.enter_motion(request, &unknowns, node, &mut program);
        }
        if unknowns.momentum {
            for (j, cell) in node.cells.iter().enumerate() {
                cell.enter(request, &unknowns, j, &mut program);
            }
        }
        if let Some(most) = node.most {
            let terms: Vec<_> = program.linear.iter().copied().enumerate().filter(|(_, by)| *by != 0.0).collect();
            program.at_most.push(LinearRow::new(terms, most));
            program.linear.fill(0.0);
            let tie_break = CounterweightSpec { objective: Objective::inertia(), ..request.clone() };
            (0..request.sites.len()).for_each(|j| program.linear[unknowns.w(j)] = 1.0);
            self.cost(&tie_break, &unknowns, &mut program);
        }
        self.enter_balance(&unknowns, node.balance, &mut program);
        for (j, sectors) in node.sectors.iter().enumerate() {
            PinSector::enter(sectors, request, j, &unknowns, &mut program);
        }
        let firm = bounds.iter().filter(|(bound, _)| !bound.kind().is_some_and(|kind| node.loose.contains(&kind)));
        program.at_most.extend(firm.clone().map(|(_, row)| row.clone()));
        if let Some(relaxed) = node.least {
            // The value of the bounds becomes an unknown, which is minimised, or the factor by which they grow.
            program.linear.fill(0.0);
            let (most, start) = (program.linear.len(), program.at_most.len() - firm.clone().count());
            program.linear.push(1.0);
            for ((bound, _), row) in firm.zip(&mut program.at_most[start..]) {
                let value = request.value_of(bound, &self.names);
                let growth = match (relaxed, bound.kind()) {
                    (RelaxedBounds::Value(kind), Some(own)) if own == kind => 1.0,
                    (RelaxedBounds::Factor, Some(_)) => value,
                    _ => continue,
                };
                row.right -= value;
                row.terms.push((most, -growth));
            }
        }
        program
    }

    /// Adds the conditions of balance.
    fn enter_balance(&self, unknowns: &UnknownIndices, balance: BalanceGoal, program: &mut Program) {
        let terms = |condition: &ConditionResidual, sign: f64| {
            let each = condition.changes.iter().enumerate();
            let both = each.flat_map(|(j, by)| [(unknowns.w(j), sign * by[0]), (unknowns.s(j), sign * by[1])]);
            both.filter(|(_, by)| *by != 0.0).collect::<Vec<_>>()
        };
        let terms_across = |condition: &ConditionResidual| {
            let each = condition.changes.iter().enumerate();
            let all = each.filter_map(|(j, by)| Some((unknowns.t(j)?, by[2])));
            all.filter(|(_, by)| *by != 0.0).collect::<Vec<_>>()
        };
        if balance == BalanceGoal::Exact {
            let touched = self.conditions.iter().filter(|condition| condition.is_touched());
            program
                .equal
                .extend(touched.map(|condition| LinearRow::new(terms(condition, 1.0), -condition.residual.re)));
            let touched = self.conditions.iter().filter(|condition| condition.is_touched_across());
            program
                .equal
                .extend(touched.map(|condition| LinearRow::new(terms_across(condition), -condition.residual.im)));
            return;
        }
        let worst = program.linear.len();
        if balance == BalanceGoal::Nearest {
            program.linear.fill(0.0);
        }
        program.linear.push(if balance == BalanceGoal::Nearest { 1.0 } else { 0.0 });
        for condition in &self.conditions {
            let per = if condition.condition.is_force() { 1.0 } else { self.reach };
            if condition.is_touched_across() || condition.ends.iter().any(|end| end.im != 0.0) {
                let magnitude = |end: Vector| {
                    let (along, across) = (terms(condition, 1.0), terms_across(condition));
                    vec![
                        LinearRow::new([(worst, per)], 0.0),
                        LinearRow::new(along, end.re),
                        LinearRow::new(across, end.im),
                    ]
                };
                program.cones.extend(condition.ends.map(magnitude));
                continue;
            }
            for (sign, end) in [-1.0, 1.0].into_iter().flat_map(|sign| condition.ends.map(|end| (sign, end))) {
                let mut terms = terms(condition, sign);
                terms.push((worst, -per));
                program.at_most.push(LinearRow::new(terms, -sign * end.re));
            }
        }
        if let BalanceGoal::Within(most) = balance {
            program.at_most.push(LinearRow::new([(worst, 1.0)], most));
        }
    }

    fn enter_rotors(&self, request: &CounterweightSpec, unknowns: &UnknownIndices, program: &mut Program) {
        for (i, rotor) in request.rotors.iter().enumerate() {
            let (x, turned) = (unknowns.rotor(i), unknowns.turned(i));
            let ends = match rotor.parameter {
                RotorFreedom::Inertia(ends) => {
                    program.equal.push(LinearRow::new([(turned, 1.0)], 0.0));
                    ends
                }
                RotorFreedom::Ratio(ends) => {
                    let inertia = self.rotor_inertia(rotor.drive) * self.ratio_units[i].powi(2);
                    program.above_square(turned, inertia, x);
                    ends
                }
            };
            program.at_most.push(LinearRow::new([(x, -1.0)], -ends[0]));
            program.at_most.push(LinearRow::new([(x, 1.0)], ends[1]));
        }
    }

    /// Adds the equations for the diagonal H_kk of the mass matrix without free rotors.
    fn enter_inertia(
        &self,
        request: &CounterweightSpec,
        unknowns: &UnknownIndices,
        node: &SearchNode,
        program: &mut Program,
    ) {
        for j in 0..request.sites.len() {
            let moments = std::iter::once(unknowns.s(j)).chain(unknowns.t(j));
            program.add_rotated_cone(unknowns.u(j), unknowns.w(j), moments);
            request.stock.enter_own(unknowns.w(j), unknowns.v(j), &node.own_tangents[j], program);
        }
        for k in 0..self.drives() {
            let mut terms = vec![(unknowns.h(k), 1.0)];
            for (j, site) in request.sites.iter().enumerate() {
                let (root, part) = (self.parts[site.link].root[k], &self.parts[site.link]);
                terms.push((unknowns.w(j), -root * root));
                if part.drive == k {
                    terms.push((unknowns.s(j), -2.0 * part.sign * root));
                    terms.extend([(unknowns.u(j), -1.0), (unknowns.v(j), -1.0)]);
                }
            }
            terms.retain(|(_, value)| *value != 0.0);
            program.equal.push(LinearRow::new(terms, self.diagonal(k)));
        }
    }

    /// Adds Σ H_kk, multiplied by its weight in the objective, to the objective.
    fn cost(&self, request: &CounterweightSpec, unknowns: &UnknownIndices, program: &mut Program) {
        for k in 0..self.drives() {
            let [_, turned] = self.of_rotors(request, k);
            for (x, by) in std::iter::once((unknowns.h(k), 1.0)).chain(turned.terms) {
                program.linear[x] += request.objective.inertia * by;
            }
        }
    }

    /// Adds |D_k| and the greatest torque, with their weights in the objective.
    fn enter_motion(
        &self,
        request: &CounterweightSpec,
        unknowns: &UnknownIndices,
        node: &SearchNode,
        program: &mut Program,
    ) {
        let objective = &request.objective;
        for k in 0..self.drives() {
            let [momentum, turned] = self.of_rotors(request, k);
            let with = |sum: &AffineForm, sign: f64| {
                let mut terms = vec![(unknowns.h(k), sign)];
                terms.extend(sum.terms.iter().map(|(x, by)| (*x, sign * by)));
                terms
            };
            if unknowns.momentum {
                program.linear[unknowns.momentum(k)] = objective.momentum;
                let constant = self.constant(k) + momentum.constant;
                for sign in [1.0, -1.0] {
                    let mut row = LinearRow::new(with(&momentum, sign), -sign * constant);
                    row.terms.push((unknowns.momentum(k), -1.0));
                    if let (true, Some(tangents)) = (sign < 0.0, &node.tangents) {
                        let linear = self.linear_diagonal(request, unknowns, k, tangents);
                        row.terms.retain(|(x, _)| *x != unknowns.h(k));
                        row.terms.extend(linear.terms.iter().map(|(x, by)| (*x, -by)));
                        row.right += linear.constant;
                    }
                    program.at_most.push(row);
                }
            }
            if objective.torque > 0.0 {
                let acceleration = objective.accelerations.get(k).copied().unwrap_or_default();
                let mut terms: Vec<_> = with(&turned, acceleration);
                terms.push((unknowns.torque(), -1.0));
                program.at_most.push(LinearRow::new(terms, -acceleration * turned.constant));
                program.linear[unknowns.torque()] = objective.torque;
            }
        }
    }

    /// Returns the bounds of the request, with their rows.
    fn bounds(&self, request: &CounterweightSpec) -> Vec<(Bound, LinearRow)> {
        let (mut all, unknowns) = (Vec::new(), UnknownIndices::of(request, self.drives()));
        for (j, site) in request.sites.iter().enumerate() {
            let (w, s, link) = (unknowns.w(j), unknowns.s(j), self.names[site.link].clone());
            all.push((Bound::From(link.clone()), LinearRow::new([(w, site.from), (s, -1.0)], 0.0)));
            all.push((Bound::To(link.clone()), LinearRow::new([(s, 1.0), (w, -site.to)], 0.0)));
            if let Some(t) = unknowns.t(j) {
                all.push((Bound::Left(link.clone()), LinearRow::new([(t, 1.0), (w, -site.across)], 0.0)));
                all.push((Bound::Right(link.clone()), LinearRow::new([(t, -1.0), (w, -site.across)], 0.0)));
            }
            if site.most.is_finite() {
                all.push((Bound::Most(link), LinearRow::new([(w, 1.0)], site.most)));
            }
        }
        if let Some(most) = request.max_added_mass {
            let sum = (0..request.sites.len()).map(|j| (unknowns.w(j), 1.0)).collect::<Vec<_>>();
            all.push((Bound::Mass, LinearRow::new(sum, most)));
        }
        if let Some(most) = request.max_inertia {
            let mut row = LinearRow::new([], most);
            for k in 0..self.drives() {
                let [momentum, _] = self.of_rotors(request, k);
                row.terms.push((unknowns.h(k), 1.0));
                row.terms.extend(momentum.terms);
                row.right -= self.constant(k) + momentum.constant;
            }
            all.push((Bound::Inertia, row));
        }
        all
    }
}

impl Bound {
    /// Returns its kind; `None` for bounds of positions, which may not be relaxed.
    fn kind(&self) -> Option<BoundKind> {
        match self {
            Self::From(_) | Self::To(_) | Self::Left(_) | Self::Right(_) => None,
            Self::Most(_) => Some(BoundKind::Most),
            Self::Mass => Some(BoundKind::Mass),
            Self::Inertia => Some(BoundKind::Inertia),
        }
    }
}

impl CounterweightSpec {
    /// Returns the value of a bound that may be relaxed.
    fn value_of(&self, bound: &Bound, names: &[String]) -> f64 {
        match bound {
            Bound::Most(link) => {
                let own = self.sites.iter().find(|site| names[site.link] == *link);
                own.map_or(0.0, |site| site.most)
            }
            Bound::Mass => self.max_added_mass.unwrap_or_default(),
            Bound::Inertia => self.max_inertia.unwrap_or_default(),
            Bound::From(_) | Bound::To(_) | Bound::Left(_) | Bound::Right(_) => 0.0,
        }
    }
}
