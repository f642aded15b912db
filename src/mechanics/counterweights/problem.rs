//! [`Problem`]: a machine without counterweights but for fixed ones, what they change in it, and the cone program that follows.

use super::asked::{Free, Objective, Sites, Weighing};
use super::refusal::{Bound, NoWeights};
use super::room::Room;
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
}

impl Way {
    /// Past all pins.
    pub fn free(asked: &Weighing, balance: Balance) -> Self {
        Self { rooms: vec![None; asked.sites.len()], balance, most: None }
    }
}

/// Where the unknowns stand: w and s of each site, what its inertia needs if that counts, H_kk of each drive but for
/// free rotors, two of each free rotor, |D_k| of each drive if it counts, and the greatest torque.
#[derive(Clone, Copy)]
struct Unknowns {
    sites: usize,
    /// Whether the inertia counts.
    inertia: bool,
    drives: usize,
    rotors: usize,
    /// Whether |D_k| counts.
    momentum: bool,
}

impl Unknowns {
    fn of(asked: &Weighing, drives: usize) -> Self {
        let inertia = asked.objective.turns() || asked.most_inertia.is_some();
        let (rotors, momentum) = (asked.rotors.len(), asked.objective.momentum > 0.0);
        Self { sites: asked.sites.len(), inertia, drives, rotors, momentum }
    }

    fn w(self, j: usize) -> usize {
        2 * j
    }

    fn s(self, j: usize) -> usize {
        2 * j + 1
    }

    /// At least s²/w.
    fn u(self, j: usize) -> usize {
        2 * (self.sites + j)
    }

    /// At least the disc's own inertia.
    fn v(self, j: usize) -> usize {
        2 * (self.sites + j) + 1
    }

    fn h(self, k: usize) -> usize {
        4 * self.sites + k
    }

    /// Inertia or ratio of a free rotor.
    fn rotor(self, i: usize) -> usize {
        let before = if self.inertia { 4 * self.sites + self.drives } else { 2 * self.sites };
        before + 2 * i
    }

    /// At least J N² of one whose ratio is free.
    fn turned(self, i: usize) -> usize {
        self.rotor(i) + 1
    }

    /// At least |D_k|.
    fn momentum(self, k: usize) -> usize {
        self.rotor(self.rotors) + k
    }

    fn torque(self) -> usize {
        if self.momentum { self.momentum(self.drives) } else { self.rotor(self.rotors) }
    }
}

/// Linear in the unknowns.
struct Sum {
    terms: Vec<(usize, f64)>,
    constant: f64,
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
            self.enter_motion(machine, asked, &unknowns, &mut program);
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
        program.at_most.extend(bounds.iter().map(|(_, row)| row.clone()));
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
    fn enter_motion(&self, machine: &Machine, asked: &Weighing, unknowns: &Unknowns, program: &mut Program) {
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
                    let mut terms = with(&momentum, sign);
                    terms.push((unknowns.momentum(k), -1.0));
                    program.at_most.push(Row::new(terms, -sign * constant));
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
        self.program(machine, asked, &self.bounds(machine, asked), way).solve()
    }

    /// Why there is none past all pins: the bounds without any of which there would be a way, which are those that the
    /// solver's proof uses, less all that it can do without. Empty if there is none without bounds either.
    pub fn conflict(&self, machine: &Machine, asked: &Weighing, weights: &[f64]) -> Vec<Bound> {
        let (bounds, way) = (self.bounds(machine, asked), Way::free(asked, Balance::Exact));
        let any = Weighing { objective: Objective::mass(), ..asked.clone() };
        let contradicts = |bounds: &[(Bound, Row)]| {
            matches!(self.program(machine, &any, bounds, &way).solve(), Err(NoX::Contradiction(_)))
        };
        let of_bounds = &weights[weights.len() - bounds.len()..];
        conflict(bounds, of_bounds, contradicts)
    }

    /// The least bound on the masses of counterweights that have one with which there is a way past all pins, kg.
    pub fn least_most(&self, machine: &Machine, asked: &Weighing) -> Option<f64> {
        let sites = asked.sites.iter().map(|site| Sites { most: f64::INFINITY, ..*site }).collect();
        let objective = Objective { mass: 0.0, ..Objective::mass() };
        let free = Weighing { sites, objective, ..asked.clone() };
        let way = Way::free(&free, Balance::Exact);
        let mut program = self.program(machine, &free, &self.bounds(machine, &free), &way);
        let (most, unknowns) = (program.linear.len(), Unknowns::of(&free, self.drives()));
        program.linear.push(1.0);
        let bounded = (0..asked.sites.len()).filter(|j| asked.sites[*j].most.is_finite());
        let heaviest = bounded.map(|j| Row::new([(unknowns.w(j), 1.0), (most, -1.0)], 0.0));
        program.at_most.extend(heaviest);
        program.solve().ok().map(|least| least.value)
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

/// A rotor that stands still is no gear's.
fn other_than_zero(ratio: f64) -> f64 {
    if ratio.abs() < LEAST_RATIO { LEAST_RATIO.copysign(ratio) } else { ratio }
}

/// One line of (7) or (8).
struct Left {
    of: Condition,
    /// What the bare machine leaves along and across the axes, kg m or kg m²; with the middle of what it may hold.
    left: Vector,
    /// Along them, with the least and with the most that it may hold.
    ends: [f64; 2],
    /// What w and s of each site add.
    changes: Vec<[f64; 2]>,
}

impl Left {
    fn is_touched(&self) -> bool {
        self.changes.iter().flatten().any(|by| *by != 0.0)
    }
}

/// What is left of each condition, and how a counterweight of w and s at each site changes it.
fn conditions(bare: &Machine, inertia: &Inertia, asked: &Weighing, beyond: &[Vector]) -> Result<Vec<Left>, NoWeights> {
    let parts = bare.resolved_links();
    let holding = |mass: f64| -> Result<Inertia, NoWeights> {
        let mut spec = bare.spec().clone();
        spec.payload.mass = mass;
        Ok(Inertia::of(&Machine::new(spec)?))
    };
    let ends = match asked.payload {
        Some([low, high]) => [holding(low)?, holding(high)?],
        None => [inertia.clone(), inertia.clone()],
    };
    let of = |(i, condition): (usize, Condition)| {
        let change = |site: &Sites| [condition.by_mass(&parts[site.link]), condition.by_moment(&parts[site.link])];
        let more = beyond.get(i).copied().unwrap_or_default();
        Left {
            of: condition,
            left: condition.left(inertia) + more,
            ends: [0, 1].map(|i| (condition.left(&ends[i]) + more).re),
            changes: asked.sites.iter().map(change).collect(),
        }
    };
    Ok(Condition::all(bare.drives()).enumerate().map(of).collect())
}
