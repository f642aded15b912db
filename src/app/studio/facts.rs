//! [`Facts`]: what the panels say of a machine that has to be found first. It is found when the machine changes.

use super::lesson::Lesson;
use crate::mechanics::balance::{Breakdown, Condition};
use crate::mechanics::counterweights::{Placed, Residual, Weighing, over_payloads};
use crate::mechanics::machine::{Inertia, Machine};
use crate::picture::scene::options::Offered;
use crate::planning::forecast::Forecast;
use crate::session::Session;
use crate::session::design::Brief;
use crate::settings::number::subscript;
use crate::study::front_point::FrontMeasure;
use crate::study::measures::Measures;

/// How many machines the front has.
const POINTS: usize = 25;

/// Of the machine on display.
#[derive(Default)]
pub struct Facts {
    of: Option<Machine>,
    /// One of each line of (7) and (8).
    pub(super) terms: Vec<Term>,
    /// λ of the drives, or why there are none.
    pub(super) lambda: Vec<f64>,
    /// What the counterweights weigh together, kg, and Σ D_k, kg m².
    pub(super) now: [f64; 2],
    /// What balance has cost beside the machine without its counterweights, with the forecast of the task that it is of.
    pub(super) measures: Option<(Forecast, Measures)>,
    /// It without its counterweights.
    bare: Option<Machine>,
    weighed: Option<(Machine, Weighing)>,
    front: Option<Result<Vec<Point>, String>>,
    /// What tells the machines of the front apart, of each of them, with the forecast of the task that it is of.
    pub(super) told: Option<(FrontMeasure, Forecast, Vec<Option<f64>>)>,
    /// What is left of balance over the payloads that are asked for.
    pub(super) payloads: Vec<Residual>,
    held: Option<[f64; 2]>,
    /// Its equations, as far as they were asked for.
    pub(super) lesson: Lesson,
}

/// Payloads at which that is looked at.
const PAYLOADS: usize = 41;

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
    /// Finds the equations, if what they depend on has changed.
    pub fn learn(&mut self, session: &Session, brief: &Brief) {
        self.follow(session, brief);
        self.lesson.follow(session, brief.preset);
    }

    /// Finds what has to be said, if the machine or what is asked for has changed.
    fn follow(&mut self, session: &Session, brief: &Brief) {
        let (machine, plan) = (&session.scenario().machine, session.run().plan());
        let is_new = self.of.as_ref() != Some(machine);
        if is_new {
            self.terms = terms(machine);
            let inertia = Inertia::of(machine);
            self.lambda = inertia.lambda().to_vec();
            let added = machine.spec().counterweights.iter().map(|weight| weight.mass).sum();
            self.now = [added, inertia.total_momentum()];
            self.bare = machine.without_counterweights().ok();
            self.of = Some(machine.clone());
        }
        let is_measured = || self.measures.as_ref().is_some_and(|(forecast, _)| *forecast == plan.forecast);
        if is_new || !is_measured() {
            let of = |bare| (plan.forecast, Measures::of(bare, machine, session.run().motion()));
            self.measures = self.bare.as_ref().map(of);
        }
        if is_new || self.held != brief.payload {
            let payloads = brief.payload.and_then(|ends| over_payloads(machine, ends, PAYLOADS).ok());
            (self.payloads, self.held) = (payloads.unwrap_or_default(), brief.payload);
        }
    }

    /// Finds the front, too, and what tells its machines apart.
    pub fn weigh(&mut self, session: &Session, brief: &Brief, by: Option<FrontMeasure>) {
        self.follow(session, brief);
        let Some(bare) = &self.bare else { return };
        let asked = brief.weighing(bare);
        if !self.weighed.as_ref().is_some_and(|(known, what)| known == bare && *what == asked) {
            let found = brief.front(bare, POINTS).map_err(|why| why.to_string());
            self.front = Some(found.map(|front| {
                let measures = front.measures();
                let both = front.points.into_iter().zip(measures);
                both.map(|(placed, [_, inertia])| Point { placed, inertia }).collect()
            }));
            self.weighed = Some((bare.clone(), asked));
            self.told = None;
        }
        self.tell(session, by);
    }

    /// Finds what tells the machines of the front apart.
    fn tell(&mut self, session: &Session, by: Option<FrontMeasure>) {
        let run = session.run();
        let forecast = run.plan().forecast;
        if by == self.told.as_ref().map(|(known, ..)| *known)
            && self.told.as_ref().is_none_or(|(_, known, _)| *known == forecast)
        {
            return;
        }
        // One that waits does not move.
        let motion = run.motion().filter(|_| run.waiting().is_none());
        let of = |by: FrontMeasure| {
            let points = self.front().unwrap_or_default().iter();
            (by, forecast, points.map(|point| by.of(&point.placed, motion)).collect())
        };
        self.told = by.map(of);
    }

    /// The machines of the front, from light to quick.
    pub(super) fn front(&self) -> Result<&[Point], &str> {
        match &self.front {
            Some(Ok(points)) => Ok(points),
            Some(Err(why)) => Err(why),
            None => Ok(&[]),
        }
    }

    /// The counterweights of one of them.
    pub fn weights(&self, i: usize) -> Vec<Offered> {
        let spec = self.of_front(i).map(Machine::spec);
        let weights = spec.iter().flat_map(|spec| {
            spec.counterweights.iter().filter_map(|weight| {
                let link = spec.links.iter().position(|link| link.name == weight.link)?;
                Some(Offered { link, at: weight.at, radius: weight.radius })
            })
        });
        weights.collect()
    }

    /// One of them.
    pub fn of_front(&self, i: usize) -> Option<&Machine> {
        Some(&self.front().ok()?.get(i)?.placed.machine)
    }
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
