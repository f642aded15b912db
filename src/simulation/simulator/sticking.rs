//! Stick and slip: within a step, the instants at which Coulomb friction changes its mind are found and stepped to, so
//! that the result does not depend on where steps happen to end.
//!
//! | event | is where | then |
//! |---|---|---|
//! | a sliding contact stops | its rate of sliding passes zero | stuck, if no more than τ_C is needed to hold it, else it slides on the other way |
//! | a stuck contact comes loose | what holds it passes τ_C | it slides |
//!
//! A part of a step that holds such an instant is cut there, as often as there are instants; a part on whose way a
//! contact turned and turned back is halved until the first of the two is found.

use super::pace::{Mismatch, Segment, StepState, Substep};
use super::simulation::Simulation;
use crate::simulation::plant::{ContactStates, Contacts, MAX_CONTACTS, Slope};

/// The most cuts of one part of a step.
const MOST: usize = 100;

/// What may happen on a part of a step.
enum Event {
    /// At or before its end a contact stops, or comes loose.
    Passed(usize),
    /// On its way something happens and is undone.
    Between,
}

/// How far a part may go.
#[expect(clippy::large_enum_variant, reason = "a step allocates nothing")]
enum Cut {
    /// To its end, where the contact that was looked for stops or comes loose.
    Here(Substep),
    /// Not so far: something else is sooner, at this time since the step began at the latest, s.
    Sooner(f64),
}

impl Simulation {
    /// How much a stuck contact could hold beyond what it does, N m; below zero it comes loose, by what is missing.
    fn spare(&self, i: usize, slope: &Slope, taken: &[f64; MAX_CONTACTS]) -> f64 {
        let contacts = self.body().contacts();
        let most = contacts.coulomb(i);
        let away = contacts.sliding(i, &slope.qdd) * taken[i].signum() * self.body().resists(i);
        // Held to rounding.
        let away = if away < 1e-9 * most { 0.0 } else { away };
        most - taken[i].abs() - away
    }

    /// Slides contacts that cannot hold.
    pub(super) fn release(&self, slope: &Slope, grip: &mut ContactStates, taken: &[f64; MAX_CONTACTS]) {
        let contacts = self.body().contacts();
        for i in (0..contacts.len()).filter(|i| contacts.sticks(*i)) {
            if grip[i] == 0 && self.spare(i, slope, taken) < -0.5e-9 * contacts.coulomb(i) {
                grip[i] = if taken[i] > 0.0 { 1 } else { -1 };
            }
        }
    }

    /// Rate of a contact along the way it slides, rad/s, or what a stuck one has to spare, N m: below zero that is over.
    fn left(&self, i: usize, grip: &ContactStates, at: &StepState) -> f64 {
        match grip[i] {
            0 => self.spare(i, &at.slope, &at.taken),
            way => f64::from(way) * self.body().contacts().sliding(i, &at.slope.qd),
        }
    }

    fn is_over(&self, i: usize, grip: &ContactStates, at: &StepState) -> bool {
        let least = if grip[i] == 0 { -0.5e-9 * self.body().contacts().coulomb(i) } else { 0.0 };
        self.left(i, grip, at) < least
    }

    /// The same by more than what two that end together may differ by.
    fn is_long_over(&self, i: usize, grip: &ContactStates, at: &StepState) -> bool {
        let least = if grip[i] == 0 { -1e-6 * self.body().contacts().coulomb(i) } else { -Contacts::STILL };
        self.left(i, grip, at) < least
    }

    /// What happens on a part, if anything: the contact that seems to be first.
    fn event(&self, from: &StepState, part: &Substep) -> Option<Event> {
        let contacts = self.body().contacts();
        let able = || (0..contacts.len()).filter(|i| contacts.sticks(*i));
        let over = able().filter(|i| self.is_over(*i, &from.grip, &part.end)).map(|i| {
            let (a, b) = (self.left(i, &from.grip, from).max(0.0), -self.left(i, &from.grip, &part.end));
            (i, a / (a + b))
        });
        if let Some((i, _)) = over.min_by(|a, b| a.1.total_cmp(&b.1)) {
            return Some(Event::Passed(i));
        }
        self.turns_back(from, part).then_some(Event::Between)
    }

    /// Whether a contact stops, or comes loose, on the way of a part and goes back to what it did.
    fn turns_back(&self, from: &StepState, part: &Substep) -> bool {
        let contacts = self.body().contacts();
        let h = part.end.at - from.at;
        (0..contacts.len()).filter(|i| contacts.sticks(*i)).any(|i| {
            let way = f64::from(from.grip[i]);
            if way == 0.0 {
                let loose =
                    |x: &Slope| self.body().resists(i) * contacts.sliding(i, &x.qdd).abs() > 1e-6 * contacts.coulomb(i);
                return part.between.iter().chain([&part.last]).any(loose);
            }
            let rate = |x: &Slope| way * contacts.sliding(i, &x.qd);
            let bend = |x: &Slope| h * way * contacts.sliding(i, &x.qdd);
            dips([rate(&from.slope), rate(&part.end.slope)], [bend(&from.slope), bend(&part.end.slope)])
        })
    }

    /// Goes on to a time since the step began, s, cut where contacts stick or slip; the most by which two answers differ.
    pub(super) fn contact(&self, leg: &mut StepState, to: f64, piece: &Segment) -> Mismatch {
        let mut worst = Mismatch::default();
        let mut reach = to - leg.at;
        for _ in 0..MOST {
            // The reference may have jumped.
            self.turn(leg, piece);
            let end = if leg.at + reach >= to { to } else { leg.at + reach };
            let part = self.part(leg, end, piece);
            let part = match self.event(leg, &part) {
                None => part,
                Some(Event::Between) if reach > 1e-7 * self.dt() => {
                    reach *= 0.5;
                    continue;
                }
                Some(Event::Between) => part,
                Some(Event::Passed(i)) => match self.found(i, leg, part, piece) {
                    Cut::Here(part) => part,
                    Cut::Sooner(at) => {
                        reach = at - leg.at;
                        continue;
                    }
                },
            };
            worst = worst.worse(self.apart(&part.last, &part.end.slope));
            *leg = part.end;
            if leg.at >= to {
                self.turn(leg, piece);
                return worst;
            }
            reach = to - leg.at;
        }
        // More than can be followed: finer parts are tried, and if they fail the audits see what is taken out here.
        *leg = self.part(leg, to, piece).end;
        Mismatch::BEYOND
    }

    /// Where the first of all contacts stops or comes loose on a part on which one does, unless something else is sooner.
    fn found(&self, mut i: usize, from: &StepState, mut part: Substep, piece: &Segment) -> Cut {
        let contacts = self.body().contacts();
        // Each search ends before the one it began with, so that of contacts that end almost together the first is found.
        for _ in 0..2 * contacts.len() {
            part = self.cut(i, from, part, piece);
            let mut others = (0..contacts.len()).filter(|j| *j != i && contacts.sticks(*j));
            let h = part.end.at - from.at;
            match others.find(|j| self.is_long_over(*j, &from.grip, &part.end)) {
                Some(sooner) => i = sooner,
                None if h > 1e-7 * self.dt() && self.turns_back(from, &part) => break,
                None => return Cut::Here(part),
            }
        }
        Cut::Sooner(from.at + 0.5 * (part.end.at - from.at))
    }

    /// A part cut where a contact that is over at its end just is.
    fn cut(&self, i: usize, from: &StepState, part: Substep, piece: &Segment) -> Substep {
        let holds = from.grip[i] == 0;
        let scale = if holds { self.body().contacts().coulomb(i) } else { 1.0 };
        let mut low = (from.at, self.left(i, &from.grip, from).max(0.0));
        let mut high = (part.end.at, self.left(i, &from.grip, &part.end));
        let mut best = part;
        let (near, width) = if holds { (1e-8, 1e-10) } else { (1e-15, 1e-14) };
        let mut side = 0;
        for n in 0..60 {
            if high.0 - low.0 <= width * self.dt() || high.1.abs() <= near * scale {
                break;
            }
            // The Illinois rule; from a start at rest, halving until it has moved.
            let straight = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let halving = low.1 <= Contacts::STILL * scale || n % 8 == 7;
            let to = if halving { 0.5 * (low.0 + high.0) } else { straight.clamp(low.0, high.0) };
            let there = self.part(from, to, piece);
            let left = self.left(i, &from.grip, &there.end);
            if self.is_over(i, &from.grip, &there.end) {
                best = there;
                high = (to, left);
                low.1 *= if side == -1 { 0.5 } else { 1.0 };
                side = -1;
            } else {
                low = (to, left);
                high.1 *= if side == 1 { 0.5 } else { 1.0 };
                side = 1;
                if !holds && left <= near {
                    best = there;
                    break;
                }
            }
        }
        best
    }

    /// A contact that does not slide, and would not go the way it is said to slide, is stuck or goes the other way. True
    /// if there was one.
    fn settle(&self, leg: &mut StepState, piece: &Segment) -> bool {
        let contacts = self.body().contacts();
        let mut changed = false;
        for i in (0..contacts.len()).filter(|i| contacts.sticks(*i)) {
            let way = f64::from(leg.grip[i]);
            let (v, a) = (way * contacts.sliding(i, &leg.slope.qd), way * contacts.sliding(i, &leg.slope.qdd));
            let away = a * self.body().resists(i) > 1e-10 * contacts.coulomb(i);
            if way != 0.0 && v < Contacts::STILL && !away {
                leg.grip[i] = 0;
                changed = true;
            }
        }
        if changed {
            self.hold(leg, piece);
        }
        changed
    }

    /// After a part: contacts that have stopped stick, and those that cannot hold slide.
    fn turn(&self, leg: &mut StepState, piece: &Segment) {
        if !self.settle(leg, piece) {
            self.release(&leg.slope, &mut leg.grip, &leg.taken);
        }
    }

    /// Holds what is stuck, as far as its law allows.
    fn hold(&self, leg: &mut StepState, piece: &Segment) {
        leg.state = self.body().stuck(leg.state, &leg.grip);
        leg.slope = self.slope(&leg.state, leg.at, piece, &leg.grip, &mut leg.taken);
        self.release(&leg.slope, &mut leg.grip, &leg.taken);
    }
}

/// Whether the cubic with these values and slopes at 0 and 1 goes below zero between.
fn dips([a, b]: [f64; 2], [u, v]: [f64; 2]) -> bool {
    if u >= 0.0 || v <= 0.0 {
        return false;
    }
    // a + u x + p x² + r x³
    let (p, r) = (3.0 * (b - a) - 2.0 * u - v, 2.0 * (a - b) + u + v);
    let root = (p * p - 3.0 * r * u).max(0.0).sqrt();
    // The minimum: 3 r x² + 2 p x + u = 0, rising.
    let x = -u / (p + root);
    let x = x.clamp(0.0, 1.0);
    a + x * (u + x * (p + x * r)) < 0.0
}
