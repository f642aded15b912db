//! [`place`]: counterweights that balance a machine at the least cost.

use std::f64::consts::PI;
use std::fmt;

use thiserror::Error;

use crate::convex::{Least, NoX, Program, Row, conflict};
use crate::mechanics::balance::{Condition, Equation, Plane};
use crate::mechanics::machine::{Counterweight, Inertia, Machine, MachineError};

/// Where a link may carry a counterweight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sites {
    /// The link, counted from 0.
    pub link: usize,
    /// Furthest back: m from the root along the axis, towards the tip above 0.
    pub from: f64,
    /// Furthest towards the tip, m.
    pub to: f64,
    /// The most it may weigh, kg; infinite for no bound.
    pub most: f64,
}

/// What the counterweights are made of: discs of one plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// ρ, kg/m³.
    pub density: f64,
    /// t, m.
    pub thickness: f64,
}

impl Disc {
    /// Steel, 30 mm thick.
    pub const STEEL: Self = Self { density: 7850.0, thickness: 0.03 };

    /// Radius of a disc of a mass, m.
    pub fn radius(&self, mass: f64) -> f64 {
        (mass / (PI * self.density * self.thickness)).sqrt()
    }

    /// Its inertia for its mass squared, 1/(2 π ρ t), m²/kg.
    fn own(&self) -> f64 {
        1.0 / (2.0 * PI * self.density * self.thickness)
    }
}

/// What is to be least: a sum of these.
#[derive(Clone, Debug, PartialEq)]
pub struct Objective {
    /// For each kilogram added.
    pub mass: f64,
    /// For each kg m² of Σ D_k.
    pub inertia: f64,
    /// For each N m of the greatest torque.
    pub torque: f64,
    /// Greatest |q̈_k| of the motion whose torque counts, rad/s².
    pub accelerations: Vec<f64>,
}

impl Objective {
    /// The least added mass.
    pub fn mass() -> Self {
        Self { mass: 1.0, inertia: 0.0, torque: 0.0, accelerations: Vec::new() }
    }

    /// The least Σ D_k.
    pub fn inertia() -> Self {
        Self { inertia: 1.0, mass: 0.0, ..Self::mass() }
    }
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighing {
    /// Links that may carry a counterweight.
    pub sites: Vec<Sites>,
    /// What these are made of.
    pub disc: Disc,
    /// What is to be least.
    pub objective: Objective,
    /// The most that Σ D_k may be, kg m².
    pub most_inertia: Option<f64>,
}

/// Counterweights, and the machine that carries them.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// It is balanced to rounding.
    pub machine: Machine,
    /// What they weigh, kg.
    pub added_mass: f64,
    /// What was least, as the solver found it.
    pub value: f64,
    /// The most by which the best may lie below that.
    pub gap: f64,
}

/// A bound that may stand in the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Bound {
    /// How far back a link may carry its counterweight.
    From(String),
    /// How far towards its tip.
    To(String),
    /// How much it may weigh.
    Most(String),
    /// Σ D_k.
    Inertia,
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::From(link) => write!(f, "link {link}: no further back"),
            Self::To(link) => write!(f, "link {link}: no further out"),
            Self::Most(link) => write!(f, "link {link}: no heavier"),
            Self::Inertia => write!(f, "Σ D_k: no more"),
        }
    }
}

fn listed(bounds: &[Bound]) -> String {
    bounds.iter().map(Bound::to_string).collect::<Vec<_>>().join("; ")
}

/// Why there are no counterweights.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoWeights {
    /// A number that cannot be.
    #[error("{what} {value}: want {want}")]
    OutOfRange {
        /// What it is of.
        what: String,
        /// What was given.
        value: f64,
        /// What would be right.
        want: &'static str,
    },
    /// One link is named twice.
    #[error("link {0} may carry its counterweight in two ranges: want one a link")]
    Twice(String),
    /// The masses of the links lie off their axes, where nothing on an axis balances them.
    #[error("{condition}, has {left} that no counterweight on an axis takes away: want com_normal 0")]
    OffAxis {
        /// The condition.
        condition: String,
        /// What remains, with unit.
        left: String,
    },
    /// No counterweight on these links changes a condition that is not met.
    #[error("{condition}, stays at {left}: want a counterweight on a link that follows that drive")]
    Untouched {
        /// The condition.
        condition: String,
        /// What remains, with unit.
        left: String,
    },
    /// These bounds, and no fewer of them, leave no way.
    #[error("no counterweights balance this machine within these bounds: {}{}", listed(.bounds), would_do(.relief))]
    Conflict {
        /// The bounds that contradict each other: with any of them away there is a way.
        bounds: Vec<Bound>,
        /// The least bound on every mass, kg, with which there is a way, if bounds on masses are among them.
        relief: Option<f64>,
    },
    /// Whatever they weigh and wherever they sit.
    #[error("no counterweights on these links alone balance this machine: want more links that may carry one")]
    TooFew,
    /// Torque is D_k q̈_k only where each motor turns its drive alone.
    #[error(
        "the torque of a motor in a joint or behind a gear depends on more than its drive: want mass or inertia to be least"
    )]
    Coupled,
    /// The solver gave up.
    #[error("the solver found no answer: {0}")]
    Failed(String),
    /// The result is no machine.
    #[error("the machine with them: {0}")]
    Machine(String),
}

fn would_do(relief: &Option<f64>) -> String {
    relief.map_or(String::new(), |most| format!("; up to {most:.6} kg on every link would do"))
}

/// Weights below these are none, kg.
const NOTHING: f64 = 1e-7;

/// The counterweights that make a machine balanced and invariant, (7) and (8), and an objective least. Those that the
/// machine has already are taken off first.
///
/// # Errors
/// If what is asked for cannot be, or cannot be together.
pub fn place(machine: &Machine, asked: &Weighing) -> Result<Placed, NoWeights> {
    let problem = Problem::new(machine, asked)?;
    if let Some(placed) = problem.unneeded(asked) {
        return Ok(placed);
    }
    let least = problem.solve(asked)?;
    problem.placed(asked, &least)
}

/// Where the unknowns stand: w and s of each site, what its inertia needs if that counts, H_kk of each drive, and the
/// greatest torque.
#[derive(Clone, Copy)]
struct Unknowns {
    sites: usize,
    /// Whether the inertia counts.
    inertia: bool,
}

impl Unknowns {
    fn of(asked: &Weighing) -> Self {
        let inertia = asked.objective.inertia > 0.0 || asked.objective.torque > 0.0 || asked.most_inertia.is_some();
        Self { sites: asked.sites.len(), inertia }
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

    fn torque(self, drives: usize) -> usize {
        if self.inertia { self.h(drives) } else { 2 * self.sites }
    }
}

/// A machine without counterweights, and what they change in it.
pub(super) struct Problem {
    bare: Machine,
    inertia: Inertia,
}

impl Problem {
    pub fn new(machine: &Machine, asked: &Weighing) -> Result<Self, NoWeights> {
        check(machine, asked)?;
        let mut spec = machine.spec().clone();
        spec.counterweights.clear();
        let bare = Machine::new(spec).map_err(of_machine)?;
        let inertia = Inertia::of(&bare);
        if asked.objective.torque > 0.0 && !inertia.is_decoupled() {
            return Err(NoWeights::Coupled);
        }
        Ok(Self { bare, inertia })
    }

    /// The machine as it is, if nothing has to be added: whatever is added makes mass and inertia more.
    fn unneeded(&self, asked: &Weighing) -> Option<Placed> {
        let (inertia, objective) = (&self.inertia, &asked.objective);
        let total: f64 = inertia.momenta().iter().sum();
        if !inertia.is_balanced() || asked.most_inertia.is_some_and(|most| total > most) {
            return None;
        }
        let diagonal = inertia.diagonals();
        let torques = diagonal.iter().zip(&objective.accelerations).map(|(h, acceleration)| h * acceleration);
        let value = objective.inertia * diagonal.iter().sum::<f64>() + objective.torque * torques.fold(0.0, f64::max);
        Some(Placed { machine: self.bare.clone(), added_mass: 0.0, value, gap: 0.0 })
    }

    fn drives(&self) -> usize {
        self.bare.drives()
    }

    /// What is left of each condition, and how a counterweight of w and s at each site changes it.
    fn conditions(&self, sites: &[Sites]) -> Vec<Left> {
        let parts = self.bare.resolved_links();
        let left = |condition: Condition| {
            let changes = sites.iter().map(|site| {
                let part = &parts[site.link];
                [condition.by_mass(part), condition.by_moment(part)]
            });
            let left = condition.left(&self.inertia);
            Left {
                name: condition.name(&self.bare),
                left: [left.re, left.im],
                unit: condition.unit(),
                changes: changes.collect(),
            }
        };
        Condition::all(self.drives()).map(left).collect()
    }

    /// Σ D_k but for what counterweights add to the diagonal of H.
    fn constant(&self) -> f64 {
        (0..self.drives()).map(|k| self.inertia.momentum(k) - self.inertia.diagonal(k)).sum()
    }

    fn program(&self, asked: &Weighing, bounds: &[(Bound, Row)]) -> Result<Program, NoWeights> {
        let (n, sites, unknowns) = (self.drives(), &asked.sites, Unknowns::of(asked));
        let mut program = Program::over(unknowns.torque(n) + usize::from(asked.objective.torque > 0.0));
        for condition in self.conditions(sites) {
            condition.enter(&unknowns, &mut program)?;
        }
        for j in 0..sites.len() {
            program.linear[unknowns.w(j)] += asked.objective.mass;
            program.at_most.push(Row::new([(unknowns.w(j), -1.0)], 0.0));
        }
        if unknowns.inertia {
            self.enter_inertia(asked, &unknowns, &mut program);
        }
        program.at_most.extend(bounds.iter().map(|(_, row)| row.clone()));
        Ok(program)
    }

    /// The diagonal of H, and what it costs.
    fn enter_inertia(&self, asked: &Weighing, unknowns: &Unknowns, program: &mut Program) {
        let (n, parts, objective) = (self.drives(), self.bare.resolved_links(), &asked.objective);
        for j in 0..asked.sites.len() {
            program.above_quotient(unknowns.u(j), unknowns.w(j), unknowns.s(j));
            program.above_square(unknowns.v(j), asked.disc.own(), unknowns.w(j));
        }
        for k in 0..n {
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
            program.linear[unknowns.h(k)] += objective.inertia;
            if objective.torque > 0.0 {
                let acceleration = objective.accelerations.get(k).copied().unwrap_or_default();
                program.at_most.push(Row::new([(unknowns.h(k), acceleration), (unknowns.torque(n), -1.0)], 0.0));
                program.linear[unknowns.torque(n)] = objective.torque;
            }
        }
    }

    /// The bounds that a person has set, with their rows.
    fn bounds(&self, asked: &Weighing) -> Vec<(Bound, Row)> {
        let (mut all, unknowns) = (Vec::new(), Unknowns::of(asked));
        for (j, site) in asked.sites.iter().enumerate() {
            let (w, s, link) = (unknowns.w(j), unknowns.s(j), self.bare.links()[site.link].name.clone());
            all.push((Bound::From(link.clone()), Row::new([(w, site.from), (s, -1.0)], 0.0)));
            all.push((Bound::To(link.clone()), Row::new([(s, 1.0), (w, -site.to)], 0.0)));
            if site.most.is_finite() {
                all.push((Bound::Most(link), Row::new([(w, 1.0)], site.most)));
            }
        }
        if let Some(most) = asked.most_inertia {
            let sum = (0..self.drives()).map(|k| (unknowns.h(k), 1.0)).collect::<Vec<_>>();
            all.push((Bound::Inertia, Row::new(sum, most - self.constant())));
        }
        all
    }

    pub fn solve(&self, asked: &Weighing) -> Result<Least, NoWeights> {
        let bounds = self.bounds(asked);
        match self.program(asked, &bounds)?.solve() {
            Ok(least) => Ok(least),
            Err(NoX::Failed(why)) => Err(NoWeights::Failed(why)),
            Err(NoX::Contradiction(weights)) => Err(self.conflict(asked, bounds, &weights)),
        }
    }

    /// The bounds without any of which there would be a way: those that the solver's proof uses, less all that it can do
    /// without.
    fn conflict(&self, asked: &Weighing, bounds: Vec<(Bound, Row)>, weights: &[f64]) -> NoWeights {
        let any = Weighing { objective: Objective::mass(), ..asked.clone() };
        let contradicts = |bounds: &[(Bound, Row)]| {
            self.program(&any, bounds).is_ok_and(|program| matches!(program.solve(), Err(NoX::Contradiction(_))))
        };
        let of_bounds = &weights[weights.len() - bounds.len()..];
        let bounds = conflict(bounds, of_bounds, contradicts);
        if bounds.is_empty() {
            return NoWeights::TooFew;
        }
        let relief = bounds.iter().any(|bound| matches!(bound, Bound::Most(_))).then(|| self.relief(asked)).flatten();
        NoWeights::Conflict { bounds, relief }
    }

    /// The least bound on all masses alike with which there is a way, kg.
    fn relief(&self, asked: &Weighing) -> Option<f64> {
        let free = Weighing {
            sites: asked.sites.iter().map(|site| Sites { most: f64::INFINITY, ..*site }).collect(),
            objective: Objective { mass: 0.0, ..Objective::mass() },
            ..asked.clone()
        };
        let mut program = self.program(&free, &self.bounds(&free)).ok()?;
        let most = program.linear.len();
        program.linear.push(1.0);
        let unknowns = Unknowns::of(&free);
        let heaviest = (0..asked.sites.len()).map(|j| Row::new([(unknowns.w(j), 1.0), (most, -1.0)], 0.0));
        program.at_most.extend(heaviest);
        program.solve().ok().map(|least| least.value)
    }

    /// The machine with what was found, balanced to rounding.
    pub fn placed(&self, asked: &Weighing, least: &Least) -> Result<Placed, NoWeights> {
        let unknowns = Unknowns::of(asked);
        let mut found: Vec<(Sites, [f64; 2])> = asked
            .sites
            .iter()
            .enumerate()
            .map(|(j, site)| (*site, [least.x[unknowns.w(j)], least.x[unknowns.s(j)]]))
            .filter(|(_, [w, _])| *w > NOTHING)
            .collect();
        // The solver's rounding, and what was too light to count, are made up for by the least change of the others.
        for _ in 0..3 {
            self.refine(&mut found);
        }
        let mut spec = self.bare.spec().clone();
        spec.counterweights = found
            .iter()
            .map(|(site, [w, s])| Counterweight {
                link: self.bare.links()[site.link].name.clone(),
                mass: *w,
                at: s / w,
                radius: asked.disc.radius(*w),
            })
            .collect();
        let machine = Machine::new(spec).map_err(of_machine)?;
        let added_mass = found.iter().map(|(_, [w, _])| w).sum();
        Ok(Placed { machine, added_mass, value: least.value, gap: least.gap })
    }

    fn refine(&self, found: &mut [(Sites, [f64; 2])]) {
        // The links balance each other.
        if found.is_empty() {
            return;
        }
        let sites: Vec<Sites> = found.iter().map(|(site, _)| *site).collect();
        let conditions = self.conditions(&sites);
        let residual = conditions.iter().map(|condition| {
            let changed = condition.changes.iter().zip(found.iter());
            condition.left[0] + changed.map(|(by, (_, [w, s]))| by[0] * w + by[1] * s).sum::<f64>()
        });
        // In proportion to what is there, so that light ones stay where they may sit.
        let equation = |(condition, right): (&Left, f64)| Equation {
            a: (0..2 * sites.len()).map(|j| condition.changes[j / 2][j % 2] * found[j / 2].1[0]).collect(),
            right,
            tolerance: f64::INFINITY,
        };
        let equations: Vec<Equation> = conditions.iter().zip(residual).map(equation).collect();
        let change = Plane::of(&equations, 2 * sites.len()).start;
        for (j, (_, [w, s])) in found.iter_mut().enumerate() {
            let by = *w;
            (*w, *s) = (*w - by * change[2 * j], *s - by * change[2 * j + 1]);
        }
    }
}

fn of_machine(why: MachineError) -> NoWeights {
    NoWeights::Machine(why.to_string())
}

/// One line of (7) or (8).
struct Left {
    name: String,
    /// What the bare machine leaves, along and across the axes.
    left: [f64; 2],
    unit: &'static str,
    /// What w and s of each site add.
    changes: Vec<[f64; 2]>,
}

impl Left {
    fn enter(&self, unknowns: &Unknowns, program: &mut Program) -> Result<(), NoWeights> {
        let [along, across] = self.left;
        let left = |x: f64| format!("{x:.3e} {}", self.unit);
        if across.abs() > 1e-9 {
            return Err(NoWeights::OffAxis { condition: self.name.clone(), left: left(across) });
        }
        let mut terms = Vec::new();
        for (j, change) in self.changes.iter().enumerate() {
            let each = [(unknowns.w(j), change[0]), (unknowns.s(j), change[1])];
            terms.extend(each.into_iter().filter(|(_, by)| *by != 0.0));
        }
        match terms.is_empty() {
            true if along.abs() > 1e-9 => Err(NoWeights::Untouched { condition: self.name.clone(), left: left(along) }),
            true => Ok(()),
            false => {
                program.equal.push(Row::new(terms, -along));
                Ok(())
            }
        }
    }
}

fn check(machine: &Machine, asked: &Weighing) -> Result<(), NoWeights> {
    let positive = |what: &str, value: f64| match value.is_finite() && value > 0.0 {
        true => Ok(()),
        false => Err(NoWeights::OutOfRange { what: what.into(), value, want: "a number above 0" }),
    };
    positive("density, kg/m³,", asked.disc.density)?;
    positive("thickness, m,", asked.disc.thickness)?;
    if let Some(most) = asked.most_inertia {
        positive("the most Σ D_k may be, kg m²,", most)?;
    }
    let objective = &asked.objective;
    for (what, value) in [("mass", objective.mass), ("inertia", objective.inertia), ("torque", objective.torque)] {
        if !(value.is_finite() && value >= 0.0) {
            let what = format!("the weight of {what}");
            return Err(NoWeights::OutOfRange { what, value, want: "a number not below 0" });
        }
    }
    for (j, site) in asked.sites.iter().enumerate() {
        let Some(link) = machine.links().get(site.link) else {
            let (what, value) = ("link number".into(), site.link as f64);
            return Err(NoWeights::OutOfRange { what, value, want: "one of the machine's links, counted from 0" });
        };
        let bad = |what: &str, value: f64, want| {
            Err(NoWeights::OutOfRange { what: format!("link {}: {what}", link.name), value, want })
        };
        if !site.from.is_finite() || !site.to.is_finite() {
            return bad(
                "a range that ends at",
                if site.from.is_finite() { site.to } else { site.from },
                "finite places, m",
            );
        }
        if site.from > site.to {
            return bad("a range up to", site.to, "an end not below its start");
        }
        if site.most.is_nan() || site.most <= 0.0 {
            return bad("at most, kg,", site.most, "a mass above 0");
        }
        if asked.sites[..j].iter().any(|other| other.link == site.link) {
            return Err(NoWeights::Twice(link.name.clone()));
        }
    }
    Ok(())
}
