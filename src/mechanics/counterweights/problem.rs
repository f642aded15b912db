//! [`Problem`]: a machine without counterweights but for fixed ones, what they change in it, and the cone program that follows.

use super::asked::{Free, Objective, Sites, Weighing};
use super::cell::Cell;
use super::left::{Left, conditions};
use super::refusal::{Bound, Kind, NoWeights};
use super::room::Room;
use super::unknowns::{Sum, Unknowns};
use crate::convex::{Least, NoX, Program, Row, conflict};
use crate::mechanics::balance::{Condition, Equation, Plane};
use crate::mechanics::machine::{Counterweight, Inertia, Machine, Rotor};
use crate::mechanics::planar::Vector;

/// Whether (7) and (8) hold, or how near they come over a range of payloads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Balance {
    /// They hold.
    Exact,
    /// Their worst residual is to be least, and nothing else.
    Nearest,
    /// It is no more than this, kg m.
    Within(f64),
}

/// One way to look for counterweights: in which room between pins each site has to stay, if it is known, how near balance
/// comes, and the most that the objective may be, where the least added mass and Σ H_kk
/// are wanted and no longer the objective.
#[derive(Clone, Debug)]
pub(super) struct Way {
    pub rooms: Vec<Option<Room>>,
    pub balance: Balance,
    pub most: Option<f64>,
    /// Bounds that are not there.
    pub loose: Vec<Kind>,
    /// A kind of bound that is to be least instead of the objective.
    pub least: Option<Kind>,
    /// Within what each counterweight is sought, where momenta below zero count.
    pub cells: Vec<Cell>,
    /// Masses, kg, and places, m, about which inertias are taken to be linear where they take from momenta below zero:
    /// then these come out no nearer to zero than they are.
    pub tangents: Option<Vec<[f64; 2]>>,
}

impl Way {
    /// Past all pins.
    pub fn free(asked: &Weighing, balance: Balance) -> Self {
        Self {
            rooms: vec![None; asked.sites.len()],
            balance,
            most: None,
            loose: Vec::new(),
            least: None,
            cells: asked.sites.iter().map(|site| Cell::of(asked, site)).collect(),
            tangents: None,
        }
    }
}

/// A machine without counterweights, but for fixed ones, and without what is free of its rotors.
pub(super) struct Problem {
    pub bare: Machine,
    inertia: Inertia,
    conditions: Vec<Left>,
    /// The furthest that the end effector can be from B, m.
    reach: f64,
}

/// What is found at every site, or at those that are left.
type Found = Vec<(Sites, [f64; 2])>;

/// Weights below these are none, kg.
pub(super) const NOTHING: f64 = 1e-7;

const LEAST_RATIO: f64 = 1e-9;

/// How much worse than the least the first of two wishes may be for the sake of the second, of itself and in its unit:
/// the solver's rounding.
pub(super) const ROUNDING: [f64; 2] = [1e-7, 1e-10];

impl Problem {
    /// `beyond` is what the machine has of each line of (7) and (8), in their order, beyond what its numbers say.
    pub fn new(machine: &Machine, asked: &Weighing, beyond: &[Vector]) -> Result<Self, NoWeights> {
        asked.check(machine)?;
        let mut spec = machine.without_counterweights()?.spec().clone();
        asked.rotors.iter().for_each(|rotor| spec.drives[rotor.drive].rotor = None);
        if let Some([low, high]) = asked.payload {
            spec.payload.mass = 0.5 * (low + high);
        }
        let bare = Machine::new(spec)?;
        let inertia = Inertia::of(&bare);
        let of_rotors = asked.rotors.iter().any(|rotor| bare.motors().on(rotor.drive).is_some());
        if asked.objective.torque > 0.0 && (!inertia.is_decoupled() || of_rotors) {
            return Err(NoWeights::Coupled);
        }
        let reach = bare.reach();
        let conditions = conditions(&bare, &inertia, asked, beyond)?;
        Ok(Self { bare, inertia, conditions, reach })
    }

    /// Whether counterweights on the axes of these links can do anything about every condition that is not met.
    ///
    /// # Errors
    /// If not.
    pub fn check(&self) -> Result<(), NoWeights> {
        for Left { of, left, .. } in &self.conditions {
            if left.im.abs() > 1e-9 {
                let left = format!("{:.3e} {}", left.im, of.unit());
                return Err(NoWeights::OffAxis { condition: of.name(&self.bare), left });
            }
        }
        for condition in self.conditions.iter().filter(|condition| !condition.is_touched()) {
            if condition.left.re.abs() > 1e-9 {
                let left = format!("{:.3e} {}", condition.left.re, condition.of.unit());
                let parts = self.bare.links().iter().zip(self.bare.resolved_links());
                let of = |part| condition.of.by_mass(part) != 0.0 || condition.of.by_moment(part) != 0.0;
                let would: Vec<&str> = parts.filter(|(_, part)| of(part)).map(|(link, _)| link.name.as_str()).collect();
                let want = format!("one of {}", would.join(", "));
                return Err(NoWeights::Untouched { condition: condition.of.name(&self.bare), left, want });
            }
        }
        Ok(())
    }

    /// What is left of each condition, whatever stands at the sites, of any sign: as little as can be, with all of them of
    /// one size.
    pub fn unreachable(&self, sites: usize) -> Vec<Vector> {
        let equation = |condition: &Left| Equation {
            a: condition.changes.iter().flatten().copied().collect(),
            right: -condition.left.re,
            tolerance: f64::INFINITY,
        };
        let equations: Vec<Equation> = self.conditions.iter().map(equation).collect();
        let along = Plane::of(&equations, 2 * sites).missed;
        along.iter().zip(&self.conditions).map(|(along, of)| Vector::new(*along, of.left.im)).collect()
    }

    /// Counterweights of no mass, if nothing has to be added: whatever is added makes mass and inertia more.
    pub fn needs_nothing(&self, asked: &Weighing) -> bool {
        let total: f64 = self.inertia.total_momentum();
        asked.rotors.is_empty()
            && asked.objective.momentum == 0.0
            && self.conditions.iter().all(|condition| condition.left.norm() <= condition.of.nothing(&self.inertia))
            && asked.most_inertia.is_none_or(|most| total <= most)
    }

    fn drives(&self) -> usize {
        self.bare.drives()
    }

    /// How a free rotor turns with drive k for one turn of the drive that it is of: what its ratio N adds to, and N's
    /// factor.
    fn rates(&self, drive: usize, k: usize) -> [f64; 2] {
        match self.bare.motors().on(drive) {
            _ if k == drive => [0.0, 1.0],
            Some(on) if k == on => [1.0, -1.0],
            _ => [0.0, 0.0],
        }
    }

    /// What free rotors bring to D_k and to H_kk.
    fn of_rotors(&self, asked: &Weighing, machine: &Machine, k: usize) -> [Sum; 2] {
        let unknowns = Unknowns::of(asked, self.drives());
        let mut sums = [(); 2].map(|()| Sum { terms: Vec::new(), constant: 0.0 });
        for (i, rotor) in asked.rotors.iter().enumerate() {
            let [plain, by_ratio] = self.rates(rotor.drive, k);
            let present = machine.spec().drives[rotor.drive].rotor.unwrap_or_default();
            let (x, turned, inertia) = (unknowns.rotor(i), unknowns.turned(i), present.inertia);
            match rotor.free {
                Free::Inertia(_) => {
                    let rate = plain + by_ratio * present.ratio;
                    sums[0].terms.push((x, rate));
                    sums[1].terms.push((x, rate * rate));
                }
                Free::Ratio(_) => {
                    sums[0].terms.push((x, by_ratio * inertia));
                    sums[0].constant += plain * inertia;
                    sums[1].terms.extend([(x, 2.0 * plain * by_ratio * inertia), (turned, by_ratio * by_ratio)]);
                    sums[1].constant += plain * plain * inertia;
                }
            }
        }
        sums
    }

    /// D_k but for what counterweights add to the diagonal of H, and for free rotors.
    fn constant(&self, k: usize) -> f64 {
        self.inertia.momentum(k) - self.inertia.diagonal(k)
    }

    fn program(&self, machine: &Machine, asked: &Weighing, bounds: &[(Bound, Row)], way: &Way) -> Program {
        let unknowns = Unknowns::of(asked, self.drives());
        let mut program = Program::over(unknowns.torque() + usize::from(asked.objective.torque > 0.0));
        for j in 0..asked.sites.len() {
            program.linear[unknowns.w(j)] += asked.objective.mass;
            program.at_most.push(Row::new([(unknowns.w(j), -1.0)], 0.0));
        }
        self.enter_rotors(machine, asked, &unknowns, &mut program);
        if unknowns.inertia {
            self.enter_inertia(asked, &unknowns, &mut program);
            self.cost(machine, asked, &unknowns, &mut program);
            self.enter_motion(machine, asked, &unknowns, way, &mut program);
        }
        if unknowns.momentum {
            for (j, cell) in way.cells.iter().enumerate() {
                let [w, s, u, v] = [unknowns.w(j), unknowns.s(j), unknowns.u(j), unknowns.v(j)];
                cell.enter(asked, [w, s, u, v], &mut program);
            }
        }
        if let Some(most) = way.most {
            let terms: Vec<_> = program.linear.iter().copied().enumerate().filter(|(_, by)| *by != 0.0).collect();
            program.at_most.push(Row::new(terms, most));
            program.linear.fill(0.0);
            let turned = Weighing { objective: Objective::inertia(), ..asked.clone() };
            (0..asked.sites.len()).for_each(|j| program.linear[unknowns.w(j)] = 1.0);
            self.cost(machine, &turned, &unknowns, &mut program);
        }
        self.enter_balance(&unknowns, way.balance, &mut program);
        for (j, room) in way.rooms.iter().enumerate() {
            if let Some(room) = room {
                room.enter(asked, [unknowns.w(j), unknowns.s(j)], &mut program);
            }
        }
        let firm = bounds.iter().filter(|(bound, _)| !bound.kind().is_some_and(|kind| way.loose.contains(&kind)));
        program.at_most.extend(firm.clone().map(|(_, row)| row.clone()));
        if let Some(kind) = way.least {
            // Instead of its own value the bound has one that is unknown.
            program.linear.fill(0.0);
            let (most, start) = (program.linear.len(), program.at_most.len() - firm.clone().count());
            program.linear.push(1.0);
            for ((bound, _), row) in firm.zip(&mut program.at_most[start..]).filter(|(b, _)| b.0.kind() == Some(kind)) {
                row.right -= asked.value_of(bound, &self.bare);
                row.terms.push((most, -1.0));
            }
        }
        program
    }

    /// (7) and (8).
    fn enter_balance(&self, unknowns: &Unknowns, balance: Balance, program: &mut Program) {
        let terms = |condition: &Left, sign: f64| {
            let each = condition.changes.iter().enumerate();
            let both = each.flat_map(|(j, by)| [(unknowns.w(j), sign * by[0]), (unknowns.s(j), sign * by[1])]);
            both.filter(|(_, by)| *by != 0.0).collect::<Vec<_>>()
        };
        if balance == Balance::Exact {
            let touched = self.conditions.iter().filter(|condition| condition.is_touched());
            program.equal.extend(touched.map(|condition| Row::new(terms(condition, 1.0), -condition.left.re)));
            return;
        }
        let worst = program.linear.len();
        if balance == Balance::Nearest {
            program.linear.fill(0.0);
        }
        program.linear.push(if balance == Balance::Nearest { 1.0 } else { 0.0 });
        for condition in &self.conditions {
            let per = if matches!(condition.of, Condition::Force(_)) { 1.0 } else { self.reach };
            for (sign, end) in [-1.0, 1.0].into_iter().flat_map(|sign| condition.ends.map(|end| (sign, end))) {
                let mut terms = terms(condition, sign);
                terms.push((worst, -per));
                program.at_most.push(Row::new(terms, -sign * end));
            }
        }
        if let Balance::Within(most) = balance {
            program.at_most.push(Row::new([(worst, 1.0)], most));
        }
    }

    fn enter_rotors(&self, machine: &Machine, asked: &Weighing, unknowns: &Unknowns, program: &mut Program) {
        for (i, rotor) in asked.rotors.iter().enumerate() {
            let (x, turned) = (unknowns.rotor(i), unknowns.turned(i));
            let ends = match rotor.free {
                Free::Inertia(ends) => {
                    program.equal.push(Row::new([(turned, 1.0)], 0.0));
                    ends
                }
                Free::Ratio(ends) => {
                    let inertia = machine.spec().drives[rotor.drive].rotor.unwrap_or_default().inertia;
                    program.above_square(turned, inertia, x);
                    ends
                }
            };
            program.at_most.push(Row::new([(x, -1.0)], -ends[0]));
            program.at_most.push(Row::new([(x, 1.0)], ends[1]));
        }
    }

    /// The diagonal of H but for free rotors.
    fn enter_inertia(&self, asked: &Weighing, unknowns: &Unknowns, program: &mut Program) {
        let parts = self.bare.resolved_links();
        for j in 0..asked.sites.len() {
            program.above_quotient(unknowns.u(j), unknowns.w(j), unknowns.s(j));
            program.above_square(unknowns.v(j), asked.disc.own(), unknowns.w(j));
        }
        for k in 0..self.drives() {
            let mut terms = vec![(unknowns.h(k), 1.0)];
            for (j, site) in asked.sites.iter().enumerate() {
                let (root, part) = (parts[site.link].root[k], &parts[site.link]);
                terms.push((unknowns.w(j), -root * root));
                if part.drive == k {
                    terms.push((unknowns.s(j), -2.0 * part.sign * root));
                    terms.extend([(unknowns.u(j), -1.0), (unknowns.v(j), -1.0)]);
                }
            }
            terms.retain(|(_, value)| *value != 0.0);
            program.equal.push(Row::new(terms, self.inertia.diagonal(k)));
        }
    }

    /// What it costs to turn the drives.
    fn cost(&self, machine: &Machine, asked: &Weighing, unknowns: &Unknowns, program: &mut Program) {
        for k in 0..self.drives() {
            let [_, turned] = self.of_rotors(asked, machine, k);
            for (x, by) in std::iter::once((unknowns.h(k), 1.0)).chain(turned.terms) {
                program.linear[x] += asked.objective.inertia * by;
            }
        }
    }

    /// What the drives give to the base, the greatest torque, and what these cost.
    fn enter_motion(&self, machine: &Machine, asked: &Weighing, unknowns: &Unknowns, way: &Way, program: &mut Program) {
        let objective = &asked.objective;
        for k in 0..self.drives() {
            let [momentum, turned] = self.of_rotors(asked, machine, k);
            let with = |sum: &Sum, sign: f64| {
                let mut terms = vec![(unknowns.h(k), sign)];
                terms.extend(sum.terms.iter().map(|(x, by)| (*x, sign * by)));
                terms
            };
            if unknowns.momentum {
                program.linear[unknowns.momentum(k)] = objective.momentum;
                let constant = self.constant(k) + momentum.constant;
                for sign in [1.0, -1.0] {
                    let mut row = Row::new(with(&momentum, sign), -sign * constant);
                    row.terms.push((unknowns.momentum(k), -1.0));
                    if let (true, Some(tangents)) = (sign < 0.0, &way.tangents) {
                        let linear = self.linear_diagonal(asked, unknowns, k, tangents);
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
                program.at_most.push(Row::new(terms, -acceleration * turned.constant));
                program.linear[unknowns.torque()] = objective.torque;
            }
        }
    }

    /// No more than H_kk but for free rotors: that of masses and places near those given, where it is the same.
    fn linear_diagonal(&self, asked: &Weighing, unknowns: &Unknowns, k: usize, tangents: &[[f64; 2]]) -> Sum {
        let parts = self.bare.resolved_links();
        let mut sum = Sum { terms: Vec::new(), constant: self.inertia.diagonal(k) };
        for (j, (site, [mass, at])) in asked.sites.iter().zip(tangents).enumerate() {
            let (part, own) = (&parts[site.link], asked.disc.own());
            let (root, (w, s)) = (part.root[k], (unknowns.w(j), unknowns.s(j)));
            sum.terms.push((w, root * root));
            if part.drive == k {
                sum.terms.push((s, 2.0 * part.sign * root + 2.0 * at));
                sum.terms.push((w, 2.0 * own * mass - at * at));
                sum.constant -= own * mass * mass;
            }
        }
        sum
    }

    /// What was found with every inertia what it is, and not more.
    pub fn settled(&self, machine: &Machine, asked: &Weighing, x: &[f64]) -> Vec<f64> {
        let unknowns = Unknowns::of(asked, self.drives());
        let mut x = x.to_vec();
        for (i, rotor) in asked.rotors.iter().enumerate() {
            let inertia = machine.spec().drives[rotor.drive].rotor.unwrap_or_default().inertia;
            x[unknowns.turned(i)] = match rotor.free {
                Free::Inertia(_) => 0.0,
                Free::Ratio(_) => inertia * x[unknowns.rotor(i)].powi(2),
            };
        }
        if !unknowns.inertia {
            return x;
        }
        let places = (0..asked.sites.len()).map(|j| {
            let [w, s] = self.at(asked, &x, j);
            if w > 0.0 { [w, s / w] } else { [0.0; 2] }
        });
        let places: Vec<[f64; 2]> = places.collect();
        for (j, [w, at]) in places.iter().enumerate() {
            x[unknowns.u(j)] = w * at * at;
            x[unknowns.v(j)] = asked.disc.own() * w * w;
        }
        let of = |sum: &Sum, x: &[f64]| sum.constant + sum.terms.iter().map(|(i, by)| by * x[*i]).sum::<f64>();
        let mut torque = 0.0_f64;
        for k in 0..self.drives() {
            let h = of(&self.linear_diagonal(asked, &unknowns, k, &places), &x);
            x[unknowns.h(k)] = h;
            let [momentum, turned] = self.of_rotors(asked, machine, k);
            let (momentum, turned) = (h + self.constant(k) + of(&momentum, &x), h + of(&turned, &x));
            if unknowns.momentum {
                x[unknowns.momentum(k)] = momentum.abs();
            }
            torque = torque.max(asked.objective.accelerations.get(k).copied().unwrap_or_default() * turned);
        }
        if asked.objective.torque > 0.0 {
            x[unknowns.torque()] = torque;
        }
        x
    }

    /// What the objective comes to.
    pub fn value(&self, machine: &Machine, asked: &Weighing, x: &[f64]) -> f64 {
        let costs = self.program(machine, asked, &[], &Way::free(asked, Balance::Exact)).linear;
        costs.iter().zip(x).map(|(cost, x)| cost * x).sum()
    }

    /// How far the inertias that were found are from what they are: of the place and of the disc itself of each site.
    pub fn excess(&self, machine: &Machine, asked: &Weighing, x: &[f64]) -> Vec<[f64; 2]> {
        let (unknowns, settled) = (Unknowns::of(asked, self.drives()), self.settled(machine, asked, x));
        let excess = |i: usize| x[i] - settled[i];
        (0..asked.sites.len()).map(|j| [excess(unknowns.u(j)), excess(unknowns.v(j))]).collect()
    }

    /// The bounds that a person has set, with their rows.
    fn bounds(&self, machine: &Machine, asked: &Weighing) -> Vec<(Bound, Row)> {
        let (mut all, unknowns) = (Vec::new(), Unknowns::of(asked, self.drives()));
        for (j, site) in asked.sites.iter().enumerate() {
            let (w, s, link) = (unknowns.w(j), unknowns.s(j), self.bare.links()[site.link].name.clone());
            all.push((Bound::From(link.clone()), Row::new([(w, site.from), (s, -1.0)], 0.0)));
            all.push((Bound::To(link.clone()), Row::new([(s, 1.0), (w, -site.to)], 0.0)));
            if site.most.is_finite() {
                all.push((Bound::Most(link), Row::new([(w, 1.0)], site.most)));
            }
        }
        if let Some(most) = asked.most_mass {
            let sum = (0..asked.sites.len()).map(|j| (unknowns.w(j), 1.0)).collect::<Vec<_>>();
            all.push((Bound::Mass, Row::new(sum, most)));
        }
        if let Some(most) = asked.most_inertia {
            let mut row = Row::new([], most);
            for k in 0..self.drives() {
                let [momentum, _] = self.of_rotors(asked, machine, k);
                row.terms.push((unknowns.h(k), 1.0));
                row.terms.extend(momentum.terms);
                row.right -= self.constant(k) + momentum.constant;
            }
            all.push((Bound::Inertia, row));
        }
        all
    }

    /// The least of what is asked for on one way.
    pub fn least(&self, machine: &Machine, asked: &Weighing, way: &Way) -> Result<Least, NoX> {
        let solve = |way: &Way| self.program(machine, asked, &self.bounds(machine, asked), way).solve();
        let first = solve(way)?;
        if asked.objective.momentum == 0.0 || way.balance == Balance::Nearest || way.least.is_some() {
            return Ok(first);
        }
        // A rotor may take more from the base than there is, if what there is counts as more: so of all that are as good
        // the one that turns least is taken, which counts everything as what it is where that can be.
        let most = first.value + ROUNDING[0] * first.value.abs() + ROUNDING[1];
        let second = solve(&Way { most: Some(most), ..way.clone() });
        Ok(second.map_or(first.clone(), |second| Least { x: second.x, ..first }))
    }

    /// Why there is none past all pins: the bounds without any of which there would be a way, which are those that the
    /// solver's proof uses, less all that it can do without. Empty if there is none without bounds either.
    pub fn conflict(&self, machine: &Machine, asked: &Weighing, balance: Balance, weights: &[f64]) -> Vec<Bound> {
        let (bounds, way) = (self.bounds(machine, asked), Way::free(asked, balance));
        let any = Weighing { objective: Objective::mass(), ..asked.clone() };
        let contradicts = |bounds: &[(Bound, Row)]| {
            matches!(self.program(machine, &any, bounds, &way).solve(), Err(NoX::Contradiction(_)))
        };
        let of_bounds = &weights[weights.len() - bounds.len()..];
        conflict(bounds, of_bounds, contradicts)
    }

    /// What stands at a site: its mass, kg, and mass times place, kg m.
    pub fn at(&self, asked: &Weighing, x: &[f64], j: usize) -> [f64; 2] {
        let unknowns = Unknowns::of(asked, self.drives());
        [x[unknowns.w(j)], x[unknowns.s(j)]]
    }

    /// The mass that is added, kg, and the machine with what was found: balanced to rounding, if that is asked for.
    pub fn machine(
        &self,
        machine: &Machine,
        asked: &Weighing,
        x: &[f64],
        balance: Balance,
    ) -> Result<(f64, Machine), NoWeights> {
        let unknowns = Unknowns::of(asked, self.drives());
        let sites = asked.sites.iter().enumerate();
        let all = sites.map(|(j, site)| (*site, self.at(asked, x, j)));
        let mut found: Found = all.filter(|(_, [w, _])| *w > NOTHING).collect();
        // The solver's rounding, and what was too light to count, are made up for by the least change of the others.
        for _ in 0..if balance == Balance::Exact { 3 } else { 0 } {
            self.refine(asked, &mut found);
        }
        let mut spec = self.bare.spec().clone();
        let weight = |(site, [w, s]): &(Sites, [f64; 2])| Counterweight {
            link: self.bare.links()[site.link].name.clone(),
            mass: *w,
            at: s / w,
            radius: asked.disc.radius(*w),
            fixed: false,
        };
        spec.counterweights.extend(found.iter().map(weight));
        for (i, rotor) in asked.rotors.iter().enumerate() {
            let (present, value) = (machine.spec().drives[rotor.drive].rotor.unwrap_or_default(), x[unknowns.rotor(i)]);
            let found = match rotor.free {
                Free::Inertia([low, high]) => Rotor { inertia: value.clamp(low, high), ..present },
                Free::Ratio([low, high]) => Rotor { ratio: other_than_zero(value.clamp(low, high)), ..present },
            };
            spec.drives[rotor.drive].rotor = (found.inertia > 0.0).then_some(found);
        }
        Ok((found.iter().map(|(_, [w, _])| w).sum(), Machine::new(spec)?))
    }

    fn refine(&self, asked: &Weighing, found: &mut Found) {
        // The links balance each other.
        if found.is_empty() {
            return;
        }
        let place = |site: &Sites| asked.sites.iter().position(|other| other.link == site.link).unwrap_or_default();
        let sites: Vec<usize> = found.iter().map(|(site, _)| place(site)).collect();
        let residual = self.conditions.iter().map(|condition| {
            let changed = sites.iter().zip(found.iter()).map(|(j, (_, [w, s]))| {
                let [by_w, by_s] = condition.changes[*j];
                by_w * w + by_s * s
            });
            condition.left.re + changed.sum::<f64>()
        });
        // In proportion to what is there, so that light ones stay where they may sit.
        let equation = |(condition, right): (&Left, f64)| Equation {
            a: (0..2 * sites.len()).map(|j| condition.changes[sites[j / 2]][j % 2] * found[j / 2].1[0]).collect(),
            right,
            tolerance: f64::INFINITY,
        };
        let equations: Vec<Equation> = self.conditions.iter().zip(residual).map(equation).collect();
        let change = Plane::of(&equations, 2 * sites.len()).start;
        for (j, (_, [w, s])) in found.iter_mut().enumerate() {
            let by = *w;
            (*w, *s) = (*w - by * change[2 * j], *s - by * change[2 * j + 1]);
        }
    }
}

impl Bound {
    /// What of its kind may give way; places may not.
    fn kind(&self) -> Option<Kind> {
        match self {
            Self::From(_) | Self::To(_) => None,
            Self::Most(_) => Some(Kind::Most),
            Self::Mass => Some(Kind::Mass),
            Self::Inertia => Some(Kind::Inertia),
        }
    }
}

impl Weighing {
    /// What a bound is that may give way.
    fn value_of(&self, bound: &Bound, machine: &Machine) -> f64 {
        match bound {
            Bound::Most(link) => {
                let own = self.sites.iter().find(|site| machine.links()[site.link].name == *link);
                own.map_or(0.0, |site| site.most)
            }
            Bound::Mass => self.most_mass.unwrap_or_default(),
            Bound::Inertia => self.most_inertia.unwrap_or_default(),
            Bound::From(_) | Bound::To(_) => 0.0,
        }
    }
}

/// A rotor that stands still is no gear's.
fn other_than_zero(ratio: f64) -> f64 {
    if ratio.abs() < LEAST_RATIO { LEAST_RATIO.copysign(ratio) } else { ratio }
}
