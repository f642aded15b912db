//! [`Facts`]: what the panels say of a machine, asked for each picture of them.

use std::sync::Arc;

use super::lengths::Sought;
use super::lesson::Lesson;
use crate::mechanics::balance::{Breakdown, Condition};
use crate::mechanics::counterweights::{Front, FrontSearch, NoWeights, Placed, Residual, over_payloads};
use crate::mechanics::machine::{Inertia, Machine};
use crate::picture::scene::options::Offered;
use crate::planning::Motion;
use crate::query::{Asked, Portion, Queries, Query, Quick, Same, State, Watch, Whole};
use crate::session::Session;
use crate::session::design::Brief;
use crate::settings::number::subscript;
use crate::study::front_point::FrontMeasure;
use crate::study::fronts::{FrontOf, Fronts, FrontsRequest, MachineFront};
use crate::study::lengths::Seeking;
use crate::study::measures::Measures;

/// How many machines the front has.
const POINTS: usize = 25;
/// Payloads at which the balance is looked at.
const PAYLOADS: usize = 41;

/// Of the machine on display.
pub struct Facts {
    /// One of each line of (7) and (8).
    pub(super) terms: Arc<Vec<Term>>,
    sums: Arc<Sums>,
    /// What balance has cost beside the machine without its counterweights.
    pub(super) measures: Option<Arc<Measures>>,
    /// What is left of balance over the payloads that are asked for.
    pub(super) payloads: Option<Arc<Vec<Residual>>>,
    /// What less inertia costs in mass; none while the equations are on display.
    front: Option<Asked<Points>>,
    /// A search for lengths of this machine, if there is one.
    pub(super) sought: Option<Sought>,
    /// Fronts of other machines; none while the equations are on display.
    beside: Option<Asked<Vec<MachineFront>>>,
    /// What tells the machines of the front apart, of each of them.
    pub(super) told: Option<Arc<Told>>,
    /// Its equations; none while the front is on display.
    pub(super) lesson: Option<Arc<Lesson>>,
}

/// The machines of a front, from light to quick, or why there are none.
type Points = Result<Vec<Point>, String>;

/// What a machine adds up to.
struct Sums {
    /// λ of the drives.
    lambda: Vec<f64>,
    /// What the counterweights weigh together, kg, and Σ D_k, kg m².
    now: [f64; 2],
    /// It without its counterweights.
    bare: Option<Machine>,
}

impl Quick for Sums {
    type Input = Machine;
    type Answer = Self;

    fn answer(machine: &Machine) -> Self {
        let inertia = Inertia::of(machine);
        let added = machine.spec().counterweights.iter().map(|weight| weight.mass).sum();
        Self {
            lambda: inertia.lambda().to_vec(),
            now: [added, inertia.total_momentum()],
            bare: machine.without_counterweights().ok(),
        }
    }
}

/// The lines of (7) and (8) of a machine.
struct Terms;

impl Quick for Terms {
    type Input = Machine;
    type Answer = Vec<Term>;

    fn answer(machine: &Machine) -> Vec<Term> {
        terms(machine)
    }
}

/// What balance has cost a machine beside the bare one, in a motion of both.
struct Cost;

impl Quick for Cost {
    type Input = (Machine, Machine, Option<Same<Motion>>);
    type Answer = Measures;

    fn answer((bare, machine, motion): &Self::Input) -> Measures {
        Measures::of(bare, machine, motion.as_ref().map(|motion| &*motion.0))
    }
}

/// What is left of a machine's balance over payloads, kg, from one to another.
struct OverPayloads;

impl Quick for OverPayloads {
    type Input = (Machine, [f64; 2]);
    type Answer = Vec<Residual>;

    fn answer((machine, ends): &Self::Input) -> Vec<Residual> {
        over_payloads(machine, *ends, PAYLOADS).unwrap_or_default()
    }
}

/// A front with what its machines add up to.
struct FrontPoints;

impl Quick for FrontPoints {
    type Input = Same<Result<Front, NoWeights>>;
    type Answer = Points;

    fn answer(front: &Self::Input) -> Points {
        let front = front.0.as_ref().as_ref().map_err(ToString::to_string)?;
        let measures = front.measures().into_iter();
        let point = |(placed, [_, inertia]): (&Placed, [f64; 2])| Point { placed: placed.clone(), inertia };
        Ok(front.points.iter().zip(measures).map(point).collect())
    }
}

/// What tells the machines of a front apart.
pub(super) struct Told {
    pub by: FrontMeasure,
    /// Of each machine; none where it has none.
    pub values: Vec<Option<f64>>,
}

/// The search for it, one machine in a portion.
struct Telling {
    of: <Self as Query>::Input,
    told: Vec<Option<f64>>,
}

impl Query for Telling {
    /// The front, by what, and in which motion.
    type Input = (Same<Points>, FrontMeasure, Option<Same<Motion>>);
    type Answer = Told;

    fn begin(of: Self::Input) -> Self {
        Self { of, told: Vec::new() }
    }

    fn go_on(&mut self, _: Watch<'_>) -> Portion<Self::Answer> {
        let (front, by, motion) = &self.of;
        let points = front.0.as_deref().unwrap_or_default();
        match points.get(self.told.len()) {
            Some(point) => {
                self.told.push(by.of(&point.placed, motion.as_ref().map(|motion| &*motion.0)));
                Portion::More(self.told.len() as f64 / points.len() as f64)
            }
            None => Portion::Done(Told { by: *by, values: std::mem::take(&mut self.told) }),
        }
    }
}

/// A machine of the front.
pub(super) struct Point {
    /// With its counterweights.
    pub placed: Placed,
    /// Σ D_k, kg m².
    pub inertia: f64,
}

/// One line of (7) or (8), as bars.
pub(super) struct Term {
    /// Its symbol.
    pub symbol: String,
    /// What it means that nothing is left of it.
    pub meaning: &'static str,
    pub unit: &'static str,
    /// What is left of it along the axes, and across them.
    pub left: [f64; 2],
    pub is_balanced: bool,
    /// What the links bring with all that they carry, by number, the largest first; nothing of those that bring nothing.
    pub parts: Vec<(usize, f64)>,
}

impl Term {
    /// The larger of the two sums of what pulls one way.
    pub fn greatest(&self) -> f64 {
        let sum = |sign: f64| self.parts.iter().map(|(_, part)| (sign * part).max(0.0)).sum::<f64>();
        sum(1.0).max(sum(-1.0))
    }
}

/// Below this share of a line's largest part a link brings nothing to it.
const NOTHING: f64 = 1e-9;

impl Facts {
    /// Of the machine on display, with its front, and with those of others beside it.
    pub fn weighed(queries: &Queries, session: &Session, by: Option<FrontMeasure>, others: &[FrontOf]) -> Self {
        let mut facts = Self::of(queries, session);
        facts.beside = (!others.is_empty()).then(|| {
            let machines = others.to_vec();
            let request = FrontsRequest { machines, count: POINTS, motion: None, workspace: false };
            queries.ask_beside::<Fronts>(&request)
        });
        let Some(bare) = &facts.sums.bare else { return facts };
        let front = queries.ask_beside::<FrontSearch>(&asked(bare, &session.scenario().design));
        let points = front.last.map(|front| queries.ask::<Whole<FrontPoints>>(&Same(front)));
        // One that waits does not move.
        let motion = session.run().shared_motion().filter(|_| session.run().waiting().is_none());
        facts.told = by.zip(points.clone()).and_then(|(by, points)| {
            let told = queries.ask_beside::<Telling>(&(Same(points.clone()), by, motion)).last?;
            // Those of another front tell nothing of this one.
            (told.by == by && told.values.len() == points.as_deref().map_or(0, <[Point]>::len)).then_some(told)
        });
        facts.front = Some(Asked { last: points, state: front.state });
        facts
    }

    /// The same with its equations.
    pub fn learned(queries: &Queries, session: &Session) -> Self {
        let lesson = Lesson::of(queries, session, session.scenario().design.penalties);
        Self { lesson, ..Self::of(queries, session) }
    }

    fn of(queries: &Queries, session: &Session) -> Self {
        let (machine, run) = (&session.scenario().machine, session.run());
        let sums = queries.ask::<Whole<Sums>>(machine);
        let cost = |bare: &Machine| {
            queries.ask_beside::<Whole<Cost>>(&(bare.clone(), machine.clone(), run.shared_motion())).last
        };
        let over = |ends| queries.ask_beside::<Whole<OverPayloads>>(&(machine.clone(), ends)).last;
        Self {
            terms: queries.ask::<Whole<Terms>>(machine),
            measures: sums.bare.as_ref().and_then(cost),
            payloads: session.scenario().design.payload.and_then(over),
            sums,
            front: None,
            sought: queries.newest::<Seeking>(),
            beside: None,
            told: None,
            lesson: None,
        }
    }

    /// λ of the drives.
    pub(super) fn lambda(&self) -> &[f64] {
        &self.sums.lambda
    }

    /// What the counterweights weigh together, kg, and Σ D_k, kg m².
    pub(super) fn now(&self) -> [f64; 2] {
        self.sums.now
    }

    /// The machines of the front, from light to quick; none before the first front is found.
    pub(super) fn front(&self) -> Result<&[Point], &str> {
        match self.front.as_ref().and_then(|front| front.last.as_deref()) {
            Some(Ok(points)) => Ok(points),
            Some(Err(why)) => Err(why),
            None => Ok(&[]),
        }
    }

    /// The fronts of other machines, as far as they are known.
    pub(super) fn beside(&self) -> &[MachineFront] {
        self.beside.as_ref().and_then(|beside| beside.last.as_deref()).map_or(&[], Vec::as_slice)
    }

    /// How much of them is found, while that is under way.
    pub(super) fn beside_under_way(&self) -> Option<f64> {
        match self.beside.as_ref()?.state {
            State::UnderWay(share) => Some(share),
            _ => None,
        }
    }

    /// How much of the front of the machine on display is found, while that is under way.
    pub(super) fn front_under_way(&self) -> Option<f64> {
        match self.front.as_ref()?.state {
            State::UnderWay(share) => Some(share),
            _ => None,
        }
    }

    /// The counterweights of one of them.
    pub fn weights(&self, i: usize) -> Vec<Offered> {
        let point = self.front().ok().and_then(|points| points.get(i));
        let spec = point.map(|point| point.placed.machine.spec());
        let weights = spec.iter().flat_map(|spec| {
            spec.counterweights.iter().filter_map(|weight| {
                let link = spec.links.iter().position(|link| link.name == weight.link)?;
                Some(Offered { link, at: weight.at, radius: weight.radius })
            })
        });
        weights.collect()
    }
}

/// One machine of the front that is on display; of the machine and the brief as they are.
pub fn of_front(queries: &Queries, session: &Session, i: usize) -> Option<Machine> {
    let sums = queries.ask::<Whole<Sums>>(&session.scenario().machine);
    let front = queries.ask::<FrontSearch>(&asked(sums.bare.as_ref()?, &session.scenario().design));
    Some(front.as_ref().as_ref().ok()?.points.get(i)?.machine.clone())
}

/// Stops what is being found for a view that is left.
pub fn leave(queries: &Queries) {
    queries.give_up::<FrontSearch>();
    queries.give_up::<Fronts>();
    queries.give_up::<Telling>();
}

/// What a front is asked for with.
fn asked(bare: &Machine, brief: &Brief) -> <FrontSearch as Query>::Input {
    (bare.clone(), brief.weighing(bare), POINTS)
}

fn terms(machine: &Machine) -> Vec<Term> {
    let breakdown = Breakdown::of(machine);
    let term = |term: &crate::mechanics::balance::Term| {
        let links = (0..machine.links().len()).map(|link| (link, breakdown.of_link(term, link).re));
        let mut parts: Vec<(usize, f64)> = links.collect();
        let most = parts.iter().fold(0.0_f64, |most, (_, part)| most.max(part.abs()));
        parts.retain(|(_, part)| part.abs() > NOTHING * most);
        parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        let (symbol, meaning, unit) = match term.condition {
            Condition::Force(k) => (format!("g{}", subscript(k + 1)), "no force", "kg m"),
            Condition::Coupling(k, l) => (format!("C{}{}", subscript(k + 1), subscript(l + 1)), "no coupling", "kg m²"),
        };
        let left = [term.left.re, term.left.im];
        Term { symbol, meaning, unit, left, is_balanced: term.balanced, parts }
    };
    let mut terms: Vec<Term> = breakdown.terms.iter().map(term).collect();
    // What is rounding beside the other lines is no bar.
    for unit in ["kg m", "kg m²"] {
        let alike = || terms.iter().filter(|term| term.unit == unit);
        let most = alike().map(Term::greatest).fold(0.0, f64::max);
        for term in terms.iter_mut().filter(|term| term.unit == unit && term.greatest() < NOTHING * most) {
            term.parts.clear();
        }
    }
    terms
}
