//! [`place`]: counterweights that balance a machine at the least cost.

use super::asked::{Objective, Sites, Weighing};
use super::problem::Problem;
use super::program::SOLVER_ROUNDING;
use super::question::One;
use super::refusal::NoWeights;
use super::relief::would_do;
use super::way::Balance;
use crate::convex::{Least, NoX};
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::Vector;

/// Counterweights, and the machine that carries them.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// It is balanced to rounding; over a range of payloads as nearly as can be, holding its middle.
    pub machine: Machine,
    /// What they weigh, kg.
    pub added_mass: f64,
    /// What was least.
    pub value: f64,
    /// The most by which the best may lie below that.
    pub gap: f64,
}

impl Placed {
    /// Whether nothing better can be, but for rounding. A search may end before that is proved.
    pub fn is_certified(&self) -> bool {
        self.gap <= 2.0 * CERTIFIED * self.value.abs().max(1.0)
    }
}

/// What a kg m² counts beside a kilogram where only mass is to be least: enough to choose among equals.
const TIE: f64 = 1e-7;

/// A counterweight that is lighter than this part of all together is done without, if that can be.
const LIGHT: f64 = 1e-4;

/// As far from the best as this an answer may be for the sake of simplicity, in what is least.
const CERTIFIED: f64 = 5e-7;

/// The counterweights that make a machine balanced and invariant, (7) and (8), and an objective least. Those that the
/// machine has already are taken off first, but for fixed ones.
///
/// Over a range of payloads the worst residual, |g_k| or |C_kl| divided by the reach, is made as small as it can be, and then
/// the objective. Balance in the middle has the least worst residual, but is not alone in that.
///
/// # Errors
/// If what is asked for cannot be, or cannot be together.
pub fn place(machine: &Machine, asked: &Weighing) -> Result<Placed, NoWeights> {
    place_with(machine, asked, &[])
}

/// The same for a machine that is known to have more of each line of (7) and (8), in their order, than its numbers say:
/// balance is where both together are nothing. What a counterweight that it has already adds is not in it.
///
/// # Errors
/// As [`place`].
pub fn place_with(machine: &Machine, asked: &Weighing, beyond: &[Vector]) -> Result<Placed, NoWeights> {
    let problem = Problem::new(machine, asked, beyond)?;
    problem.check()?;
    if problem.needs_nothing(asked) {
        let inertia = Inertia::of(&problem.bare);
        let value = asked.objective.of(0.0, &inertia);
        return Ok(Placed { machine: problem.bare, added_mass: 0.0, value, gap: 0.0 });
    }
    let one = One { problem: &problem, machine, asked, beyond };
    one.found()?.map_err(|weights| one.refusal(&weights))
}

/// What is left of each line of (7) and (8), whatever counterweights of any sign sit on the links that may carry one:
/// as little as can be, with all lines of one size. What lies across the axes is always left.
///
/// # Errors
/// If what is asked for cannot be.
pub fn unreachable_by_weights(
    machine: &Machine,
    asked: &Weighing,
    beyond: &[Vector],
) -> Result<Vec<Vector>, NoWeights> {
    Ok(Problem::new(machine, asked, beyond)?.unreachable(asked.sites.len()))
}

impl One<'_> {
    /// The answer, or the weights of the proof that there is none past all pins, empty if it is the pins.
    fn found(&self) -> Result<Result<Placed, Vec<f64>>, NoWeights> {
        if self.balance() == Balance::Nearest {
            return self.nearest();
        }
        match self.least(Balance::Exact)? {
            Ok(least) => {
                let best = self.placed(&least, Balance::Exact)?;
                Ok(Ok(self.simpler(self.quicker(best, &least))))
            }
            Err(NoX::Failed(why)) => Err(NoWeights::Failed(why)),
            Err(NoX::Contradiction(_)) if self.asked.payload.is_some() => self.nearest(),
            Err(NoX::Contradiction(weights)) => Ok(Err(weights)),
        }
    }

    /// Of all that weigh the same the one that turns least.
    fn quicker(&self, best: Placed, least: &Least) -> Placed {
        let Weighing { objective, most_inertia, .. } = self.asked;
        if objective.turns() || objective.mass == 0.0 || most_inertia.is_some() {
            return best;
        }
        let objective = Objective { inertia: TIE * objective.mass, ..objective.clone() };
        let tied = Weighing { objective, ..self.asked.clone() };
        let one = One { asked: &tied, ..*self };
        let found = one.least(Balance::Exact).ok().and_then(Result::ok);
        let found = found.and_then(|tied| one.placed(&tied, Balance::Exact).ok());
        found.and_then(|found| self.as_good(found, least.value - least.gap)).unwrap_or(best)
    }

    /// The same without counterweights that weigh next to nothing, if it does without them.
    fn simpler(&self, best: Placed) -> Placed {
        let weights = || best.machine.spec().counterweights.iter().filter(|weight| !weight.fixed);
        let is_light = |mass: f64| mass < LIGHT * best.added_mass;
        if !weights().any(|weight| is_light(weight.mass)) {
            return best;
        }
        let carries = |site: &Sites| {
            let link = &self.machine.links()[site.link].name;
            weights().any(|weight| weight.link == *link && !is_light(weight.mass))
        };
        let sites: Vec<Sites> = self.asked.sites.iter().copied().filter(carries).collect();
        let fewer = Weighing { sites, ..self.asked.clone() };
        self.exact(&fewer).and_then(|found| self.as_good(found, best.value - best.gap)).unwrap_or(best)
    }

    /// What balances the machine and nothing less, if there is any.
    fn exact(&self, asked: &Weighing) -> Option<Placed> {
        let problem = Problem::new(self.machine, asked, self.beyond).ok()?;
        problem.check().ok()?;
        let one = One { problem: &problem, asked, ..*self };
        let least = one.least(Balance::Exact).ok()?.ok()?;
        let best = one.placed(&least, Balance::Exact).ok()?;
        Some(one.quicker(best, &least))
    }

    /// A machine that is certified as well: nothing has less than `bound`.
    fn as_good(&self, found: Placed, bound: f64) -> Option<Placed> {
        let value = self.asked.objective.of(found.added_mass, &Inertia::of(&found.machine));
        let gap = (value - bound).max(found.gap);
        (gap < CERTIFIED).then_some(Placed { value, gap, ..found })
    }

    /// As near to balance as the bounds allow over all payloads, and of those the least. Where the middle can be balanced
    /// as cheaply, it is.
    fn nearest(&self) -> Result<Result<Placed, Vec<f64>>, NoWeights> {
        let found = |balance| match self.least(balance)? {
            Ok(least) => Ok(Ok(least)),
            Err(NoX::Contradiction(weights)) => Ok(Err(weights)),
            Err(NoX::Failed(why)) => Err(NoWeights::Failed(why)),
        };
        let worst = match found(Balance::Nearest)? {
            Ok(least) => least.value,
            Err(weights) => return Ok(Err(weights)),
        };
        let balance = Balance::Within(worst * (1.0 + SOLVER_ROUNDING[0]) + SOLVER_ROUNDING[1]);
        let least = match found(balance)? {
            Ok(least) => least,
            Err(weights) => return Ok(Err(weights)),
        };
        if let Ok(Ok(exact)) = self.least(Balance::Exact)
            && exact.value <= least.value + CERTIFIED
        {
            return Ok(Ok(self.placed(&exact, Balance::Exact)?));
        }
        Ok(Ok(self.placed(&least, balance)?))
    }

    fn placed(&self, least: &Least, balance: Balance) -> Result<Placed, NoWeights> {
        let (added_mass, machine) = self.problem.machine(self.machine, self.asked, &least.x, balance)?;
        let value = self.asked.objective.of(added_mass, &Inertia::of(&machine));
        // Of what was made of it, and not only of what the solver has: the dual says what nothing goes below.
        Ok(Placed { machine, added_mass, value, gap: (value - (least.value - least.gap)).max(least.gap) })
    }

    /// Why there is none; weights are of the proof past all pins, empty if it is the pins.
    fn refusal(&self, weights: &[f64]) -> NoWeights {
        let does = |asked: &Weighing| One { asked, ..*self }.found().is_ok_and(|found| found.is_ok());
        let would = || would_do(self, &does);
        match self.asked.clearance {
            Some(asked) if weights.is_empty() => NoWeights::Reaches { asked, would: would() },
            _ => {
                let bounds = self.problem.conflict(self.machine, self.asked, self.balance(), weights);
                match bounds.is_empty() {
                    true => NoWeights::TooFew,
                    false => NoWeights::Conflict { bounds, would: would() },
                }
            }
        }
    }
}

impl Objective {
    /// What it comes to.
    fn of(&self, added_mass: f64, inertia: &Inertia) -> f64 {
        let diagonal = inertia.diagonals();
        let torques = diagonal.iter().zip(&self.accelerations).map(|(h, acceleration)| h * acceleration);
        self.mass * added_mass
            + self.inertia * diagonal.iter().sum::<f64>()
            + self.momentum * inertia.momenta().iter().map(|d| d.abs()).sum::<f64>()
            + self.torque * torques.fold(0.0, f64::max)
    }
}
