//! [`place`]: counterweights that balance a machine at the least cost.

use super::asked::{Objective, Sites, Weighing};
use super::problem::{Balance, Problem, Way};
use super::refusal::{Bound, NoWeights, Relief};
use super::search::search;
use crate::convex::{Least, NoX};
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::Vector;

/// Counterweights, and the machine that carries them.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// It is balanced to rounding; over a range of payloads in its middle, or as nearly as can be.
    pub machine: Machine,
    /// What they weigh, kg.
    pub added_mass: f64,
    /// What was least.
    pub value: f64,
    /// The most by which the best may lie below that.
    pub gap: f64,
}

/// What a kg m² counts beside a kilogram where only mass is to be least: enough to choose among equals.
const TIE: f64 = 1e-7;

/// A counterweight that is lighter than this part of all together is done without, if that can be.
const LIGHT: f64 = 1e-4;

/// As far from the best as this an answer may be for the sake of simplicity, in what is least.
const CERTIFIED: f64 = 5e-7;

/// Bounds on masses that are tried, each a tenth above the one before.
const TRIES: i32 = 24;

/// Steps in which a clearance that would do is looked for.
const STEPS: usize = 20;

/// How much worse than the least the first of two wishes may be for the sake of the second, of itself and in its unit:
/// the solver's rounding.
const ROUNDING: [f64; 2] = [1e-7, 1e-10];

/// The counterweights that make a machine balanced and invariant, (7) and (8), and an objective least. Those that the
/// machine has already are taken off first.
///
/// Over a range of payloads the worst residual is least where the middle is balanced; where that cannot be within the
/// bounds, the worst residual is made as small as it can be, and then the objective.
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
    match one.least(Balance::Exact)? {
        Ok(least) => {
            let best = one.placed(&least, Balance::Exact)?;
            Ok(one.simpler(one.quicker(best, &least)))
        }
        Err(NoX::Failed(why)) => Err(NoWeights::Failed(why)),
        Err(NoX::Contradiction(_)) if asked.payload.is_some() => one.nearest(),
        Err(NoX::Contradiction(weights)) => Err(one.refusal(&weights)),
    }
}

struct One<'a> {
    problem: &'a Problem,
    machine: &'a Machine,
    asked: &'a Weighing,
    beyond: &'a [Vector],
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
    fn least(&self, balance: Balance) -> Result<Result<Least, NoX>, NoWeights> {
        let way = Way::free(self.asked, balance);
        let first = self.on(&way)?;
        // A rotor may take more from the base than there is, if what there is counts as more: so of all that are as good
        // the one that turns least is taken, which counts everything as what it is.
        match first {
            Ok(least) if self.asked.objective.momentum > 0.0 && balance != Balance::Nearest => {
                let most = least.value + ROUNDING[0] * least.value.abs() + ROUNDING[1];
                let second = self.on(&Way { most: Some(most), ..way })?;
                Ok(second.map(|second| Least { x: second.x, ..least }))
            }
            first => Ok(first),
        }
    }

    fn on(&self, way: &Way) -> Result<Result<Least, NoX>, NoWeights> {
        match self.asked.clearance {
            Some(_) => search(self.problem, self.machine, self.asked, way),
            None => Ok(self.problem.least(self.machine, self.asked, way)),
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
        let weights = &best.machine.spec().counterweights;
        let is_light = |mass: f64| mass < LIGHT * best.added_mass;
        if !weights.iter().any(|weight| is_light(weight.mass)) {
            return best;
        }
        let carries = |site: &Sites| {
            let link = &self.machine.links()[site.link].name;
            weights.iter().any(|weight| weight.link == *link && !is_light(weight.mass))
        };
        let sites: Vec<Sites> = self.asked.sites.iter().copied().filter(carries).collect();
        let fewer = Weighing { sites, ..self.asked.clone() };
        let found = place_with(self.machine, &fewer, self.beyond).ok();
        found.and_then(|found| self.as_good(found, best.value - best.gap)).unwrap_or(best)
    }

    /// A machine that is certified as well: nothing has less than `bound`.
    fn as_good(&self, found: Placed, bound: f64) -> Option<Placed> {
        let value = self.asked.objective.of(found.added_mass, &Inertia::of(&found.machine));
        let gap = (value - bound).max(found.gap);
        (gap < CERTIFIED).then_some(Placed { value, gap, ..found })
    }

    /// As near to balance as the bounds allow over all payloads, and of those the least.
    fn nearest(&self) -> Result<Placed, NoWeights> {
        let found = |balance| {
            self.least(balance)?.map_err(|why| match why {
                NoX::Contradiction(weights) => self.refusal(&weights),
                NoX::Failed(why) => NoWeights::Failed(why),
            })
        };
        let worst = found(Balance::Nearest)?.value;
        let balance = Balance::Within(worst * (1.0 + ROUNDING[0]) + ROUNDING[1]);
        self.placed(&found(balance)?, balance)
    }

    fn placed(&self, least: &Least, balance: Balance) -> Result<Placed, NoWeights> {
        let (added_mass, machine) = self.problem.machine(self.machine, self.asked, &least.x, balance)?;
        let value = self.asked.objective.of(added_mass, &Inertia::of(&machine));
        // Of what was made of it, and not only of what the solver has: the dual says what nothing goes below.
        Ok(Placed { machine, added_mass, value, gap: (value - (least.value - least.gap)).max(least.gap) })
    }

    /// Why there is none; weights are of the proof past all pins, empty if it is the pins.
    fn refusal(&self, weights: &[f64]) -> NoWeights {
        match self.asked.clearance {
            Some(asked) if weights.is_empty() => NoWeights::Reaches { asked, would: self.would_clear(asked) },
            _ => {
                let bounds = self.problem.conflict(self.machine, self.asked, weights);
                if bounds.is_empty() {
                    return NoWeights::TooFew;
                }
                match self.relief(&bounds) {
                    Ok(relief) => NoWeights::Conflict { bounds, relief },
                    Err(deeper) => deeper,
                }
            }
        }
    }

    /// What would do instead of one kind of the bounds that contradict each other.
    ///
    /// # Errors
    /// If the other bounds leave no way either, and why.
    fn relief(&self, bounds: &[Bound]) -> Result<Option<Relief>, NoWeights> {
        let with = |asked: Weighing| place_with(self.machine, &asked, self.beyond);
        if bounds.contains(&Bound::Inertia) {
            let free = Weighing { most_inertia: None, objective: Objective::inertia(), ..self.asked.clone() };
            let total = |placed: Placed| Inertia::of(&placed.machine).total_momentum();
            return Ok(Some(Relief::Inertia(total(with(free)?))));
        }
        if bounds.contains(&Bound::Mass) {
            let free = Weighing { most_mass: None, objective: Objective::mass(), ..self.asked.clone() };
            return Ok(Some(Relief::Mass(with(free)?.added_mass)));
        }
        if !bounds.iter().any(|bound| matches!(bound, Bound::Most(_))) {
            return Ok(None);
        }
        // Round the pins it may take more.
        let does = |most: &f64| {
            let up = |most: f64| most * (1.0 + 1e-6);
            let raised =
                |site: &Sites| Sites { most: if site.most.is_finite() { up(*most) } else { site.most }, ..*site };
            let sites = self.asked.sites.iter().map(raised).collect();
            self.asked.clearance.is_none() || with(Weighing { sites, ..self.asked.clone() }).is_ok()
        };
        let least = self.problem.least_most(self.machine, self.asked);
        Ok(least.and_then(|least| (0..TRIES).map(|i| least * 1.1_f64.powi(i)).find(does)).map(Relief::Most))
    }

    /// The furthest from all pins with which there is a way, m.
    fn would_clear(&self, asked: f64) -> Option<f64> {
        let is_clear = |clearance: f64| {
            let nearer = Weighing { clearance: Some(clearance), ..self.asked.clone() };
            let way = Way::free(&nearer, Balance::Exact);
            matches!(search(self.problem, self.machine, &nearer, &way), Ok(Ok(_)))
        };
        if !is_clear(0.0) {
            return None;
        }
        let halved = |[low, high]: [f64; 2], _| {
            let middle = 0.5 * (low + high);
            if is_clear(middle) { [middle, high] } else { [low, middle] }
        };
        Some((0..STEPS).fold([0.0, asked], halved)[0])
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
