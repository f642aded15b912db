//! Stick and slip: substeps end at the instants at which a Coulomb contact (friction torque τ_C) stops, reverses or
//! breaks loose. So the result does not depend on the step size.
//!
//! | event | condition | consequence |
//! |---|---|---|
//! | a sliding contact stops | its rate of sliding passes zero | sticks if τ_C can hold it, else slides the other way |
//! | a stuck contact breaks loose | its holding torque exceeds τ_C | it slides |
//!
//! A substep is shortened to end at the first such event; the rest of the step is integrated in the same way. A substep
//! in which a contact reverses twice is halved until the first reversal is found.

use super::simulation::Simulation;
use super::step_control::{Mismatch, Segment, StepState, Substep};
use crate::plant::{Contacts, MAX_CONTACTS, SlipDirections, Slope};

/// Maximum number of parts of one substep.
const MAX_PARTS: usize = 100;

/// Contact event in a substep.
enum Event {
    /// The contact of this index stops or breaks loose at or before the end of the substep.
    Passed(usize),
    /// A contact changes its state and changes back within the substep.
    Between,
}

/// Result of the search for an event.
#[expect(clippy::large_enum_variant, reason = "a step allocates nothing")]
enum Cut {
    /// A substep at whose end the first contact stops or breaks loose.
    Here(Substep),
    /// Another event is earlier: try a substep that ends at this time since the step began, s.
    Sooner(f64),
}

impl Simulation {
    /// Returns the torque reserve of a stuck contact, N m; if negative, the contact breaks loose.
    fn torque_reserve(&self, i: usize, slope: &Slope, stuck_torque: &[f64; MAX_CONTACTS]) -> f64 {
        let contacts = self.body().contacts();
        let limit = contacts.coulomb(i);
        let away = contacts.sliding(i, &slope.qdd) * stuck_torque[i].signum() * self.body().reduced_inertia(i);
        // Zero within rounding.
        let away = if away < 1e-9 * limit { 0.0 } else { away };
        limit - stuck_torque[i].abs() - away
    }

    /// Releases the stuck contacts whose holding torque exceeds τ_C, so that they slide.
    pub(super) fn release(&self, slope: &Slope, slip: &mut SlipDirections, stuck_torque: &[f64; MAX_CONTACTS]) {
        let contacts = self.body().contacts();
        for i in (0..contacts.len()).filter(|i| contacts.can_stick(*i)) {
            if slip[i] == 0 && self.torque_reserve(i, slope, stuck_torque) < -0.5e-9 * contacts.coulomb(i) {
                slip[i] = if stuck_torque[i] > 0.0 { 1 } else { -1 };
            }
        }
    }

    /// Returns the margin until a contact's state ends: the sliding rate in its slip direction, rad/s, or the torque
    /// reserve if stuck, N m. A negative margin means that the state has ended.
    fn margin(&self, i: usize, slip: &SlipDirections, at: &StepState) -> f64 {
        match slip[i] {
            0 => self.torque_reserve(i, &at.slope, &at.stuck_torque),
            way => f64::from(way) * self.body().contacts().sliding(i, &at.slope.qd),
        }
    }

    /// Returns whether a contact's state has ended.
    fn is_over(&self, i: usize, slip: &SlipDirections, at: &StepState) -> bool {
        let tolerance = if slip[i] == 0 { -0.5e-9 * self.body().contacts().coulomb(i) } else { 0.0 };
        self.margin(i, slip, at) < tolerance
    }

    /// Returns whether a contact's state ended clearly before the end of the substep, by more than the tolerance for
    /// simultaneous events.
    fn is_long_over(&self, i: usize, slip: &SlipDirections, at: &StepState) -> bool {
        let tolerance =
            if slip[i] == 0 { -1e-6 * self.body().contacts().coulomb(i) } else { -Contacts::STICTION_SPEED };
        self.margin(i, slip, at) < tolerance
    }

    /// Returns the event in a substep, if any. If several contacts change, linear interpolation estimates the first.
    fn event(&self, from: &StepState, substep: &Substep) -> Option<Event> {
        let contacts = self.body().contacts();
        let able = || (0..contacts.len()).filter(|i| contacts.can_stick(*i));
        let over = able().filter(|i| self.is_over(*i, &from.slip, &substep.end)).map(|i| {
            let (a, b) = (self.margin(i, &from.slip, from).max(0.0), -self.margin(i, &from.slip, &substep.end));
            (i, a / (a + b))
        });
        if let Some((i, _)) = over.min_by(|a, b| a.1.total_cmp(&b.1)) {
            return Some(Event::Passed(i));
        }
        self.turns_back(from, substep).then_some(Event::Between)
    }

    /// Returns whether a contact stops or breaks loose within a substep and returns to its former state.
    fn turns_back(&self, from: &StepState, substep: &Substep) -> bool {
        let contacts = self.body().contacts();
        let h = substep.end.at - from.at;
        (0..contacts.len()).filter(|i| contacts.can_stick(*i)).any(|i| {
            let way = f64::from(from.slip[i]);
            if way == 0.0 {
                let loose = |x: &Slope| {
                    self.body().reduced_inertia(i) * contacts.sliding(i, &x.qdd).abs() > 1e-6 * contacts.coulomb(i)
                };
                return substep.stages.iter().any(loose);
            }
            let rate = |x: &Slope| way * contacts.sliding(i, &x.qd);
            let bend = |x: &Slope| h * way * contacts.sliding(i, &x.qdd);
            dips([rate(&from.slope), rate(&substep.end.slope)], [bend(&from.slope), bend(&substep.end.slope)])
        })
    }

    /// Integrates to a time since the step began, s, in parts that end where contacts stick or slip. Returns the
    /// maximum error estimate.
    pub(super) fn contact(&self, reached: &mut StepState, to: f64, segment: &Segment) -> Mismatch {
        let mut worst = Mismatch::default();
        let mut reach = to - reached.at;
        for _ in 0..MAX_PARTS {
            // The reference may have jumped: update the contacts.
            self.update_contacts(reached, segment);
            let end = if reached.at + reach >= to { to } else { reached.at + reach };
            let substep = self.substep(reached, end, segment);
            let substep = match self.event(reached, &substep) {
                None => substep,
                Some(Event::Between) if reach > 1e-7 * self.dt() => {
                    reach *= 0.5;
                    continue;
                }
                Some(Event::Between) => substep,
                Some(Event::Passed(i)) => match self.first_event(i, reached, substep, segment) {
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
                self.update_contacts(reached, segment);
                return worst;
            }
            reach = to - reached.at;
        }
        // Too many events: the infinite estimate forces finer substeps. If these fail too, reversed contacts are
        // stopped later, and the audits show the energy that this removes.
        *reached = self.substep(reached, to, segment).end;
        Mismatch::INFINITE
    }

    /// Finds the first instant at which any contact stops or breaks loose in a substep, starting from contact i.
    fn first_event(&self, mut i: usize, from: &StepState, mut substep: Substep, segment: &Segment) -> Cut {
        let contacts = self.body().contacts();
        // Each search ends earlier than the one before, so that the first of almost simultaneous events is found.
        for _ in 0..2 * contacts.len() {
            substep = self.shortened(i, from, substep, segment);
            let mut others = (0..contacts.len()).filter(|j| *j != i && contacts.can_stick(*j));
            let h = substep.end.at - from.at;
            match others.find(|j| self.is_long_over(*j, &from.slip, &substep.end)) {
                Some(sooner) => i = sooner,
                None if h > 1e-7 * self.dt() && self.turns_back(from, &substep) => break,
                None => return Cut::Here(substep),
            }
        }
        Cut::Sooner(from.at + 0.5 * (substep.end.at - from.at))
    }

    /// Shortens a substep to the instant at which the state of contact i ends, by bracketing.
    fn shortened(&self, i: usize, from: &StepState, substep: Substep, segment: &Segment) -> Substep {
        let is_stuck = from.slip[i] == 0;
        let scale = if is_stuck { self.body().contacts().coulomb(i) } else { 1.0 };
        let mut low = (from.at, self.margin(i, &from.slip, from).max(0.0));
        let mut high = (substep.end.at, self.margin(i, &from.slip, &substep.end));
        let mut best = substep;
        let (near, width) = if is_stuck { (1e-8, 1e-10) } else { (1e-15, 1e-14) };
        let mut side = 0;
        for n in 0..60 {
            if high.0 - low.0 <= width * self.dt() || high.1.abs() <= near * scale {
                break;
            }
            // Illinois variant of regula falsi. Bisection in every eighth iteration, and until a contact at rest has
            // moved.
            let straight = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let halving = low.1 <= Contacts::STICTION_SPEED * scale || n % 8 == 7;
            let to = if halving { 0.5 * (low.0 + high.0) } else { straight.clamp(low.0, high.0) };
            let there = self.substep(from, to, segment);
            let margin = self.margin(i, &from.slip, &there.end);
            if self.is_over(i, &from.slip, &there.end) {
                best = there;
                high = (to, margin);
                low.1 *= if side == -1 { 0.5 } else { 1.0 };
                side = -1;
            } else {
                low = (to, margin);
                high.1 *= if side == 1 { 0.5 } else { 1.0 };
                side = 1;
                if !is_stuck && margin <= near {
                    best = there;
                    break;
                }
            }
        }
        best
    }

    /// Makes contacts stick if their sliding rate is zero and they do not accelerate in the slip direction.
    /// Contacts that cannot hold then slide the other way. Returns whether any contact stopped.
    fn stick_stopped(&self, reached: &mut StepState, segment: &Segment) -> bool {
        let contacts = self.body().contacts();
        let mut changed = false;
        for i in (0..contacts.len()).filter(|i| contacts.can_stick(*i)) {
            let way = f64::from(reached.slip[i]);
            let (v, a) = (way * contacts.sliding(i, &reached.slope.qd), way * contacts.sliding(i, &reached.slope.qdd));
            let away = a * self.body().reduced_inertia(i) > 1e-10 * contacts.coulomb(i);
            if way != 0.0 && v < Contacts::STICTION_SPEED && !away {
                reached.slip[i] = 0;
                changed = true;
            }
        }
        if changed {
            self.stop_stuck(reached, segment);
        }
        changed
    }

    /// Updates the contacts after a substep: contacts that have stopped stick, and stuck contacts that cannot hold
    /// slide.
    fn update_contacts(&self, reached: &mut StepState, segment: &Segment) {
        if !self.stick_stopped(reached, segment) {
            self.release(&reached.slope, &mut reached.slip, &reached.stuck_torque);
        }
    }

    /// Stops stuck contacts exactly, evaluates the slope again, and releases contacts that cannot hold.
    fn stop_stuck(&self, reached: &mut StepState, segment: &Segment) {
        reached.state = self.body().with_stuck_stopped(reached.state, &reached.slip);
        self.reevaluate(reached, segment);
        self.release(&reached.slope, &mut reached.slip, &reached.stuck_torque);
    }
}

/// Returns whether the cubic with given values and slopes at 0 and 1 is negative in between.
fn dips([a, b]: [f64; 2], [u, v]: [f64; 2]) -> bool {
    if u >= 0.0 || v <= 0.0 {
        return false;
    }
    // a + u x + p x² + r x³
    let (p, r) = (3.0 * (b - a) - 2.0 * u - v, 2.0 * (a - b) + u + v);
    let root = (p * p - 3.0 * r * u).max(0.0).sqrt();
    // The minimum: the root of 3 r x² + 2 p x + u = 0 with positive curvature.
    let x = -u / (p + root);
    let x = x.clamp(0.0, 1.0);
    a + x * (u + x * (p + x * r)) < 0.0
}
