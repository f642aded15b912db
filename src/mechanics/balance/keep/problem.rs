//! [`keep`]: the machine with the least change that is balanced.

use nalgebra::DVector;

use super::super::breakdown::Body;
use super::super::condition::Condition;
use super::super::parameter::{Parameter, Quantity};
use super::super::plane::{Equation, Plane};
use super::asked::{Adjusted, Hold, Keep, MIN_MASS};
use super::refusal::{Limit, NotKept, Relief, Side};
use super::search::{Mass, Search};
use crate::convex::{Program, Row, conflict};
use crate::mechanics::machine::{BALANCED, Inertia, Machine, MachineError, MachineSpec};
use crate::mechanics::planar::Vector;

/// A machine that is kept balanced.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// It is balanced to rounding.
    pub machine: Machine,
    /// What each parameter has become, in the order in which they are listed.
    pub values: Vec<f64>,
    /// What was least: Σ (p Δ)² of those that are not fixed.
    pub cost: f64,
    /// Whether nothing else that is balanced within the limits has less. Where a body may change its mass and its place
    /// the answer is the best of several searches.
    pub certified: bool,
}

impl Kept {
    /// What it takes to make this machine of the other, by key: what has changed, radii of discs included.
    pub fn settings(&self, of: &Machine) -> Vec<(String, f64)> {
        let (now, was) = (self.machine.spec(), of.spec());
        let changed = Parameter::all(&self.machine).into_iter().filter_map(|parameter| {
            let value = parameter.value(now)?;
            (parameter.value(was) != Some(value)).then(|| (parameter.key(of), value))
        });
        let discs = now.counterweights.iter().zip(&was.counterweights).enumerate();
        let discs = discs.filter(|(_, (now, was))| now.radius != was.radius);
        changed.chain(discs.map(|(i, (now, _))| (format!("counterweight.{}.radius", i + 1), now.radius))).collect()
    }
}

/// The machine with the least change of what may change that is balanced and invariant, (7) and (8).
///
/// # Errors
/// If what is asked for cannot be, or there is no such machine: then which limits leave no way, and how far they would
/// have to give.
pub fn keep(machine: &Machine, asked: &Keep) -> Result<Kept, NotKept> {
    keep_with(machine, asked, &[])
}

/// The same for a machine that is known to have more of each condition, in their order, than its numbers say: balance is
/// where both together are nothing.
///
/// # Errors
/// As [`keep`].
pub fn keep_with(machine: &Machine, asked: &Keep, beyond: &[Vector]) -> Result<Kept, NotKept> {
    asked.check(machine)?;
    let problem = Problem::of(machine, asked, beyond)?;
    let n = asked.parameters.len();
    let mut equations = problem.balance.clone();
    equations.extend((0..n).filter_map(|i| problem.fixed(i)));
    let plane = Plane::of(&equations, n);
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

/// What is left of each condition, however far all that may change goes, of a machine that has more of them than its
/// numbers say: as little as can be, with all of them of one size.
///
/// # Errors
/// If what is asked for cannot be.
pub fn unreachable_by_changes(machine: &Machine, asked: &Keep, beyond: &[Vector]) -> Result<Vec<Vector>, NotKept> {
    asked.check(machine)?;
    let problem = Problem::of(machine, asked, beyond)?;
    let n = asked.parameters.len();
    let fixed = (0..n).filter_map(|i| problem.fixed(i));
    let equations: Vec<Equation> = problem.balance.iter().cloned().chain(fixed).collect();
    let missed = Plane::of(&equations, n).missed;
    let count = problem.conditions.len();
    Ok((0..count).map(|i| Vector::new(missed[i], missed[count + i])).collect())
}

/// The conditions over y, and what limits it.
struct Problem<'a> {
    machine: &'a Machine,
    asked: &'a Keep,
    /// The machine with every parameter where its change is measured from.
    from: MachineSpec,
    conditions: Vec<Condition>,
    /// What the machine has of each condition beyond what its numbers say.
    beyond: Vec<Vector>,
    /// The real parts of all conditions, then the imaginary ones.
    balance: Vec<Equation>,
}

impl<'a> Problem<'a> {
    fn of(machine: &'a Machine, asked: &'a Keep, beyond: &[Vector]) -> Result<Self, NotKept> {
        let mut from = machine.spec().clone();
        for one in &asked.parameters {
            one.parameter.set(&mut from, one.from);
        }
        let (start, scale) = (Inertia::of(&Machine::new(from.clone()).map_err(of_machine)?), Inertia::of(machine));
        let conditions: Vec<Condition> = Condition::all(machine.drives()).collect();
        let more = |i: usize| beyond.get(i).copied().unwrap_or_default();
        let beyond = (0..conditions.len()).map(more).collect();
        let mut problem = Self { machine, asked, from, conditions, beyond, balance: Vec::new() };
        for across in [false, true] {
            for (&condition, beyond) in problem.conditions.iter().zip(&problem.beyond) {
                let a = asked.parameters.iter().map(|one| problem.by(condition, one.parameter, across) / one.penalty);
                let left = condition.left(&start) + beyond;
                // A tenth of what counts as none.
                let tolerance = 0.1 * condition.nothing(&scale).max(condition.nothing(&start));
                let equation = Equation { a: a.collect(), right: if across { -left.im } else { -left.re }, tolerance };
                problem.balance.push(equation);
            }
        }
        Ok(problem)
    }

    /// What a change by 1 kg or 1 m brings to a condition.
    fn by(&self, condition: Condition, parameter: Parameter, across: bool) -> f64 {
        let mass = self.mass_from(parameter.body);
        let Some(link) = self.carrier(parameter.body) else { return 0.0 };
        let part = &self.machine.resolved_links()[link];
        let at = |quantity: Quantity| Parameter::new(parameter.body, quantity).value(&self.from).unwrap_or_default();
        match (parameter.quantity, across) {
            (Quantity::Mass, false) => condition.by_mass(part) + at(Quantity::Along) * condition.by_moment(part),
            (Quantity::Mass, true) => at(Quantity::Across) * condition.by_cross_moment(part),
            (Quantity::Along, false) => mass * condition.by_moment(part),
            (Quantity::Across, true) => mass * condition.by_cross_moment(part),
            (Quantity::Along, true) | (Quantity::Across, false) => 0.0,
        }
    }

    fn carrier(&self, body: Body) -> Option<usize> {
        match body {
            Body::Link(j) => Some(j),
            Body::Counterweight(i) => {
                let name = &self.from.counterweights[i].link;
                self.from.links.iter().position(|link| link.name == *name)
            }
            Body::Payload => None,
        }
    }

    /// m₀ of a body.
    fn mass_from(&self, body: Body) -> f64 {
        Parameter::new(body, Quantity::Mass).value(&self.from).unwrap_or_default()
    }

    fn listed(&self, parameter: Parameter) -> Option<usize> {
        self.asked.parameters.iter().position(|one| one.parameter == parameter)
    }

    /// What is looked for where masses and places of one body may change.
    fn search<'b>(&self, equations: &'b [Equation], bounds: &'b [Row]) -> Search<'b> {
        let all = || self.asked.parameters.iter().enumerate();
        let masses = all().filter(|(_, one)| one.parameter.quantity == Quantity::Mass).map(|(at, one)| {
            let places = all().filter(|(_, other)| {
                other.parameter.body == one.parameter.body
                    && other.parameter.quantity != Quantity::Mass
                    && other.hold != Hold::Fixed
            });
            let ends = one.ends(self.machine).unwrap_or([one.from; 2]);
            Mass { at, from: one.from, penalty: one.penalty, ends, places: places.map(|(i, _)| i).collect() }
        });
        let counts = all().map(|(_, one)| one.hold != Hold::Fixed).collect();
        Search { equations, counts, masses: masses.collect(), bounds }
    }

    /// Whether no body may change both its mass and a place: then all is linear but for distances.
    fn is_convex(&self) -> bool {
        let all = || self.asked.parameters.iter().filter(|one| one.hold != Hold::Fixed).map(|one| one.parameter);
        let mut masses = all().filter(|mass| mass.quantity == Quantity::Mass);
        !masses.any(|mass| all().any(|other| other.body == mass.body && other != mass))
    }

    /// The row that is its right side where a parameter has a value.
    fn row(&self, i: usize, value: f64) -> Row {
        let Adjusted { parameter, penalty, from, .. } = self.asked.parameters[i];
        let mut terms = vec![(i, 1.0)];
        let of_body = self.listed(Parameter::new(parameter.body, Quantity::Mass));
        if let (Some(k), true) = (of_body, parameter.quantity != Quantity::Mass) {
            let by = penalty * (value - from) / self.mass_from(parameter.body);
            terms.push((k, -by / self.asked.parameters[k].penalty));
        }
        Row::new(terms, penalty * (value - from))
    }

    /// The equation of one that is fixed.
    fn fixed(&self, i: usize) -> Option<Equation> {
        let one = &self.asked.parameters[i];
        let value = one.parameter.value(self.machine.spec()).filter(|_| one.hold == Hold::Fixed)?;
        let row = self.row(i, value);
        let mut a = vec![0.0; self.asked.parameters.len()];
        row.terms.iter().for_each(|&(j, by)| a[j] += by);
        // A picometre is nothing, whatever it is of.
        let tolerance = one.penalty * BALANCED * (value.abs() + one.from.abs()).max(1e-3);
        Some(Equation { a, right: row.right, tolerance })
    }

    /// The limits with their rows: a · y ≤ right. Those that are fixed are among them if asked for.
    fn limits(&self, fixed: bool) -> Vec<(Limit, Row)> {
        let mut all = Vec::new();
        for (i, one) in self.asked.parameters.iter().enumerate() {
            let ends = one.ends(self.machine).filter(|_| fixed || one.hold != Hold::Fixed);
            for (side, value) in [Side::Least, Side::Most].into_iter().zip(ends.into_iter().flatten()) {
                let (key, fixed) = (one.parameter.key(self.machine), one.hold == Hold::Fixed);
                let usual = one.hold == Hold::Free;
                let carrier = match one.parameter.body {
                    Body::Counterweight(i) => Some(self.from.counterweights[i].link.clone()),
                    _ => None,
                };
                let limit = Limit { parameter: one.parameter, key, carrier, side, fixed, usual, value };
                all.push((limit, self.limit(i, side, value)));
            }
        }
        all
    }

    /// The rows of limits, after those with which every mass stays one.
    fn bounds(&self, limits: &[(Limit, Row)]) -> Vec<Row> {
        self.floors().chain(limits.iter().map(|(_, row)| row.clone())).collect()
    }

    fn floors(&self) -> impl Iterator<Item = Row> {
        let masses = self.asked.parameters.iter().enumerate();
        masses.filter(|(_, one)| one.parameter.quantity == Quantity::Mass).map(|(i, one)| {
            let present = one.parameter.value(self.machine.spec()).unwrap_or(one.from);
            self.limit(i, Side::Least, MIN_MASS * one.from.min(present))
        })
    }

    fn limit(&self, i: usize, side: Side, value: f64) -> Row {
        let mut row = self.row(i, value);
        if side == Side::Least {
            row.terms.iter_mut().for_each(|(_, by)| *by = -*by);
            row.right = -row.right;
        }
        row
    }

    /// What a parameter is at a y.
    fn value(&self, i: usize, y: &DVector<f64>) -> f64 {
        let one = &self.asked.parameters[i];
        let change = |i: usize| y[i] / self.asked.parameters[i].penalty;
        let heavier = match self.listed(Parameter::new(one.parameter.body, Quantity::Mass)) {
            Some(k) if one.parameter.quantity != Quantity::Mass => {
                let mass = self.mass_from(one.parameter.body);
                mass / (mass + change(k))
            }
            _ => 1.0,
        };
        one.from + change(i) * heavier
    }

    fn kept(&self, y: &DVector<f64>) -> Result<Kept, NotKept> {
        let (mut spec, mut values, mut cost) = (self.machine.spec().clone(), Vec::new(), 0.0);
        for (i, one) in self.asked.parameters.iter().enumerate() {
            let value = match (one.hold, one.ends(self.machine)) {
                (Hold::Fixed, _) | (_, None) => one.parameter.value(&spec).unwrap_or_default(),
                (_, Some([low, high])) => self.value(i, y).clamp(low, high),
            };
            if one.hold != Hold::Fixed {
                one.parameter.set(&mut spec, value);
                cost += (one.penalty * (value - one.from)).powi(2);
            }
            values.push(value);
        }
        let machine = Machine::new(spec).map_err(of_machine)?;
        let inertia = Inertia::of(&machine);
        let left = self.conditions.iter().zip(&self.beyond);
        let nothing = |condition: &Condition| condition.nothing(&inertia);
        let balanced = |(condition, beyond): (&Condition, &Vector)| {
            (condition.left(&inertia) + beyond).norm() <= nothing(condition)
        };
        match left.into_iter().all(balanced) {
            true => Ok(Kept { machine, values, cost, certified: self.is_convex() }),
            false => Err(NotKept::Failed("what it found is not balanced to rounding".into())),
        }
    }

    /// Why there is no way.
    fn conflict(&self) -> NotKept {
        let plane = Plane::of(&self.balance, self.asked.parameters.len());
        if !plane.exists {
            return self.inconsistent(&plane);
        }
        let limits = self.limits(true);
        let solve = |limits: &[(Limit, Row)]| plane.nearest(&self.bounds(limits));
        match solve(&limits) {
            Ok(_) => NotKept::Failed("limits that contradict each other by no more than rounding".into()),
            Err(weights) => {
                let relief = self.relief(&plane, &limits);
                let weights = &weights[weights.len() - limits.len()..];
                let limits = conflict(limits, weights, |some| solve(some).is_err());
                if limits.is_empty() { NotKept::NoMass } else { NotKept::Conflict { limits, relief } }
            }
        }
    }

    fn inconsistent(&self, plane: &Plane) -> NotKept {
        let n = self.conditions.len();
        let left = |i: usize| plane.missed[i].hypot(plane.missed[n + i]);
        let off: Vec<usize> = (0..n).filter(|i| left(*i) > self.balance[*i].tolerance).collect();
        let force = off.iter().any(|i| matches!(self.conditions[*i], Condition::Force(_)));
        let of_kind = off.iter().copied().filter(|i| matches!(self.conditions[*i], Condition::Force(_)) == force);
        let worst = of_kind.max_by(|a, b| left(*a).total_cmp(&left(*b))).unwrap_or_default();
        let condition = self.conditions[worst];
        let left = format!("{:.3e} {}", left(worst), condition.unit());
        NotKept::Inconsistent { condition: condition.name(self.machine), left }
    }

    /// The least Σ p times how far limits give way with which there is a way: as far as is usual, or any way if that is not
    /// enough. Empty if the solver finds none.
    fn relief(&self, plane: &Plane, limits: &[(Limit, Row)]) -> Vec<Relief> {
        let mut reliefs = [false, true].into_iter().map(|usual| self.relief_of(plane, limits, usual));
        reliefs.find(|relief| !relief.is_empty()).unwrap_or_default()
    }

    fn relief_of(&self, plane: &Plane, limits: &[(Limit, Row)], usual: bool) -> Vec<Relief> {
        let widest = self.asked.parameters.iter().enumerate().filter(|_| !usual).flat_map(|(i, one)| {
            let ends = [Side::Least, Side::Most].into_iter().zip(one.widest(self.machine).into_iter().flatten());
            ends.map(move |(side, value)| self.limit(i, side, value))
        });
        let (m, c) = plane.cut(&widest.chain(self.bounds(limits)).collect::<Vec<_>>());
        let (k, floors, scale) = (m.ncols(), c.len() - limits.len(), c.amax().max(f64::MIN_POSITIVE));
        let mut program = Program::over(k);
        program.linear.resize(k + limits.len(), 1.0);
        for i in 0..c.len() {
            let mut terms: Vec<(usize, f64)> = (0..k).map(|j| (j, m[(i, j)])).collect();
            if i >= floors {
                let gives = k + i - floors;
                program.at_most.push(Row::new([(gives, -1.0)], 0.0));
                if usual || !limits[i - floors].0.usual {
                    terms.push((gives, -1.0));
                }
            }
            program.at_most.push(Row::new(terms, c[i] / scale));
        }
        let Ok(least) = program.solve() else { return Vec::new() };
        let z = DVector::from_fn(k, |j, _| least.x[j] * scale);
        let y = &plane.start + &plane.free * &z;
        // Rounded outwards in steps that a person may type, coarser where rounding leaves no way.
        let mut reliefs = [1e-4, 1e-3, 1e-2].into_iter().map(|step| self.relieved(limits, &y, step, scale));
        reliefs.find(|relief| plane.nearest(&self.bounds(&self.given(limits, relief))).is_ok()).unwrap_or_default()
    }

    /// What limits have to give for a y, in steps of a part of how far.
    fn relieved(&self, limits: &[(Limit, Row)], y: &DVector<f64>, step: f64, scale: f64) -> Vec<Relief> {
        let relief = |(limit, row): &(Limit, Row)| {
            let over = row.terms.iter().map(|&(j, by)| by * y[j]).sum::<f64>() - row.right;
            let i = self.listed(limit.parameter).filter(|_| over > 1e-7 * scale)?;
            let by = (self.value(i, y) - limit.value).abs();
            let digit = step * 10.0_f64.powf(by.log10().ceil());
            let to = match limit.side {
                Side::Least => ((limit.value - by) / digit).floor() - 1.0,
                Side::Most => ((limit.value + by) / digit).ceil() + 1.0,
            };
            Some(Relief { limit: limit.clone(), to: to * digit })
        };
        limits.iter().filter_map(relief).collect()
    }

    /// Limits that have given way.
    fn given(&self, limits: &[(Limit, Row)], relief: &[Relief]) -> Vec<(Limit, Row)> {
        let row = |(limit, row): &(Limit, Row)| {
            let given = relief.iter().find(|relief| relief.limit == *limit).zip(self.listed(limit.parameter));
            given.map_or_else(|| row.clone(), |(relief, i)| self.limit(i, limit.side, relief.to))
        };
        limits.iter().map(|both| (both.0.clone(), row(both))).collect()
    }
}

fn of_machine(why: MachineError) -> NotKept {
    NotKept::Machine(why.to_string())
}
