//! Stick and slip: within a step, the instants at which a Coulomb contact stops, reverses or comes loose are found and
//! stepped to, so that the result does not depend on where steps happen to end.
//!
//! | event | is where | then |
//! |---|---|---|
//! | a sliding contact stops | its rate of sliding passes zero | sticks if τ_C can hold it, else slides the other way |
//! | a stuck contact comes loose | what holds it passes τ_C | it slides |
//!
//! A substep that holds such an instant is cut there, as often as there are instants; a substep on whose way a
//! contact turned and turned back is halved until the first of the two is found.

use super::simulation::Simulation;
use super::step_control::{Mismatch, Segment, StepState, Substep};
use crate::simulation::plant::{Contacts, MAX_CONTACTS, SlipDirections, Slope};

/// The most cuts of one substep.
const MOST: usize = 100;

/// What may happen on a substep.
enum Event {
    /// At or before its end a contact stops, or comes loose.
    Passed(usize),
    /// On its way something happens and is undone.
    Between,
}

/// How far a substep may go.
#[expect(clippy::large_enum_variant, reason = "a step allocates nothing")]
enum Cut {
    /// To its end, where the contact that was looked for stops or comes loose.
    Here(Substep),
    /// Not so far: something else is sooner, at this time since the step began at the latest, s.
    Sooner(f64),
}

impl Simulation {
    /// How much a stuck contact could hold beyond what it does, N m; below zero it comes loose, by what is missing.
    fn spare(&self, i: usize, slope: &Slope, stuck_torque: &[f64; MAX_CONTACTS]) -> f64 {
        let contacts = self.body().contacts();
        let most = contacts.coulomb(i);
        let away = contacts.sliding(i, &slope.qdd) * stuck_torque[i].signum() * self.body().resists(i);
        // Held to rounding.
        let away = if away < 1e-9 * most { 0.0 } else { away };
        most - stuck_torque[i].abs() - away
    }

    /// Slides contacts that cannot hold.
    pub(super) fn release(&self, slope: &Slope, slip: &mut SlipDirections, stuck_torque: &[f64; MAX_CONTACTS]) {
        let contacts = self.body().contacts();
        for i in (0..contacts.len()).filter(|i| contacts.sticks(*i)) {
            if slip[i] == 0 && self.spare(i, slope, stuck_torque) < -0.5e-9 * contacts.coulomb(i) {
                slip[i] = if stuck_torque[i] > 0.0 { 1 } else { -1 };
            }
        }
    }

    /// What is left until a contact's state ends: its rate along the way it slides, rad/s, or what a stuck one could
    /// still hold, N m; below zero it has ended.
    fn left(&self, i: usize, slip: &SlipDirections, at: &StepState) -> f64 {
        match slip[i] {
            0 => self.spare(i, &at.slope, &at.stuck_torque),
            way => f64::from(way) * self.body().contacts().sliding(i, &at.slope.qd),
        }
    }

    fn is_over(&self, i: usize, slip: &SlipDirections, at: &StepState) -> bool {
        let least = if slip[i] == 0 { -0.5e-9 * self.body().contacts().coulomb(i) } else { 0.0 };
        self.left(i, slip, at) < least
    }

    /// Whether it has ended by more than two that end together may differ by.
    fn is_long_over(&self, i: usize, slip: &SlipDirections, at: &StepState) -> bool {
        let least = if slip[i] == 0 { -1e-6 * self.body().contacts().coulomb(i) } else { -Contacts::STILL };
        self.left(i, slip, at) < least
    }

    /// What happens on a substep, if anything: the contact that seems to be first.
    fn event(&self, from: &StepState, substep: &Substep) -> Option<Event> {
        let contacts = self.body().contacts();
        let able = || (0..contacts.len()).filter(|i| contacts.sticks(*i));
        let over = able().filter(|i| self.is_over(*i, &from.slip, &substep.end)).map(|i| {
            let (a, b) = (self.left(i, &from.slip, from).max(0.0), -self.left(i, &from.slip, &substep.end));
            (i, a / (a + b))
        });
        if let Some((i, _)) = over.min_by(|a, b| a.1.total_cmp(&b.1)) {
            return Some(Event::Passed(i));
        }
        self.turns_back(from, substep).then_some(Event::Between)
    }

    /// Whether a contact stops, or comes loose, on the way of a substep and goes back to what it did.
    fn turns_back(&self, from: &StepState, substep: &Substep) -> bool {
        let contacts = self.body().contacts();
        let h = substep.end.at - from.at;
        (0..contacts.len()).filter(|i| contacts.sticks(*i)).any(|i| {
            let way = f64::from(from.slip[i]);
            if way == 0.0 {
                let loose =
                    |x: &Slope| self.body().resists(i) * contacts.sliding(i, &x.qdd).abs() > 1e-6 * contacts.coulomb(i);
                return substep.stages.iter().any(loose);
            }
            let rate = |x: &Slope| way * contacts.sliding(i, &x.qd);
            let bend = |x: &Slope| h * way * contacts.sliding(i, &x.qdd);
            dips([rate(&from.slope), rate(&substep.end.slope)], [bend(&from.slope), bend(&substep.end.slope)])
        })
    }

    /// Goes on to a time since the step began, s, cut where contacts stick or slip; the most by which two answers
    /// differ.
    pub(super) fn contact(&self, reached: &mut StepState, to: f64, segment: &Segment) -> Mismatch {
        let mut worst = Mismatch::default();
        let mut reach = to - reached.at;
        for _ in 0..MOST {
            // The reference may have jumped.
            self.turn(reached, segment);
            let end = if reached.at + reach >= to { to } else { reached.at + reach };
            let substep = self.substep(reached, end, segment);
            let substep = match self.event(reached, &substep) {
                None => substep,
                Some(Event::Between) if reach > 1e-7 * self.dt() => {
                    reach *= 0.5;
                    continue;
                }
                Some(Event::Between) => substep,
                Some(Event::Passed(i)) => match self.found(i, reached, substep, segment) {
                    Cut::Here(substep) => substep,
                    Cut::Sooner(at) => {
                        reach = at - reached.at;
                        continue;
                    }
                },
            };
            worst = worst.worse(substep.off);
            *reached = substep.end;
            if reached.at >= to {
                self.turn(reached, segment);
                return worst;
            }
            reach = to - reached.at;
        }
        // More than can be followed: finer substeps are tried, and if they fail the audits see what is taken out here.
        *reached = self.substep(reached, to, segment).end;
        Mismatch::BEYOND
    }

    /// Where the first of all contacts stops or comes loose on a substep on which one does, unless something else is
    /// sooner.
    fn found(&self, mut i: usize, from: &StepState, mut substep: Substep, segment: &Segment) -> Cut {
        let contacts = self.body().contacts();
        // Each search ends before the one it began with, so that of contacts that end almost together the first is
        // found.
        for _ in 0..2 * contacts.len() {
            substep = self.cut(i, from, substep, segment);
            let mut others = (0..contacts.len()).filter(|j| *j != i && contacts.sticks(*j));
            let h = substep.end.at - from.at;
            match others.find(|j| self.is_long_over(*j, &from.slip, &substep.end)) {
                Some(sooner) => i = sooner,
                None if h > 1e-7 * self.dt() && self.turns_back(from, &substep) => break,
                None => return Cut::Here(substep),
            }
        }
        Cut::Sooner(from.at + 0.5 * (substep.end.at - from.at))
    }

    /// A substep cut at the instant at which a contact's state ends.
    fn cut(&self, i: usize, from: &StepState, substep: Substep, segment: &Segment) -> Substep {
        let holds = from.slip[i] == 0;
        let scale = if holds { self.body().contacts().coulomb(i) } else { 1.0 };
        let mut low = (from.at, self.left(i, &from.slip, from).max(0.0));
        let mut high = (substep.end.at, self.left(i, &from.slip, &substep.end));
        let mut best = substep;
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
            let there = self.substep(from, to, segment);
            let left = self.left(i, &from.slip, &there.end);
            if self.is_over(i, &from.slip, &there.end) {
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

    /// A contact that does not slide, and would not go the way it is said to slide, is stuck or goes the other way.
    /// True if there was one.
    fn settle(&self, reached: &mut StepState, segment: &Segment) -> bool {
        let contacts = self.body().contacts();
        let mut changed = false;
        for i in (0..contacts.len()).filter(|i| contacts.sticks(*i)) {
            let way = f64::from(reached.slip[i]);
            let (v, a) = (way * contacts.sliding(i, &reached.slope.qd), way * contacts.sliding(i, &reached.slope.qdd));
            let away = a * self.body().resists(i) > 1e-10 * contacts.coulomb(i);
            if way != 0.0 && v < Contacts::STILL && !away {
                reached.slip[i] = 0;
                changed = true;
            }
        }
        if changed {
            self.hold(reached, segment);
        }
        changed
    }

    /// After a substep: contacts that have stopped stick, and those that cannot hold slide.
    fn turn(&self, reached: &mut StepState, segment: &Segment) {
        if !self.settle(reached, segment) {
            self.release(&reached.slope, &mut reached.slip, &reached.stuck_torque);
        }
    }

    /// Holds what is stuck, as far as its law allows.
    fn hold(&self, reached: &mut StepState, segment: &Segment) {
        reached.state = self.body().stuck(reached.state, &reached.slip);
        self.look_again(reached, segment);
        self.release(&reached.slope, &mut reached.slip, &reached.stuck_torque);
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
