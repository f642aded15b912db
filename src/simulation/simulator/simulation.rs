//! [`Simulation`]: a run in progress and its present instant.

use crate::control::{Controller, Reading};
use crate::frame::{Audit, Frame, Peaks, Phase, Reach, Target, Totals};
use crate::plant::{Base, Friction, Load, MAX_CONTACTS, MovingBody, ReducedState, SlipDirections, Slope, State};
use stillbase_mechanics::dynamics::{self, BaseWrench, ExternalLoads, by_drives};
use stillbase_mechanics::joint_forces::{InternalLoads, PinLoads};
use stillbase_mechanics::kinematics::{end_effector, least_transmission};
use stillbase_mechanics::machine::{Inertia, Machine, MachineError, RelativeAngle};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, length, with_ground};
use stillbase_planning::Reference;
use stillbase_planning::pose_space::plane_map;
use stillbase_planning::reactionless::PlaneMap;

use super::control_loop::ControlLoop;
use super::guide::{Guide, Setup};
use super::step_control::{StepControl, StepState};

/// A run in progress.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The moving bodies without and with the temporary payload.
    pub(super) bodies: Box<[MovingBody; 2]>,
    pub(super) load: Load,
    pub(super) loaded: bool,
    pub(super) control_loop: ControlLoop,
    /// m_j a_jk of each link and payload, `drives` entries for each, kg m: without and with the temporary payload.
    pub(super) link_moments: [Vec<Vector>; 2],
    /// Pin loads without and with the payload.
    pub(super) inside: [PinLoads; 2],
    /// Difference of the two points of each loop closure, as a chain.
    pub(super) closures: Vec<[f64; MAX_DRIVES]>,
    pub(super) lambda: PerDrive,
    pub(super) map: Option<PlaneMap>,
    pub(super) angles: Vec<RelativeAngle>,
    pub(super) drives: usize,
    pub(super) dt: f64,
    /// Whether the base [floats](Base::floats).
    floats: bool,
    pub(super) step: u64,
    pub(super) guide: Guide,
    pub(super) state: State,
    pub(super) slip: SlipDirections,
    /// Torques of stuck contacts, N m.
    pub(super) stuck_torque: [f64; MAX_CONTACTS],
    pub(super) now: Slope,
    pub(super) reference: Reference,
    /// Energy and momenta at the start, less their sources.
    baseline: Baseline,
    pub(super) peaks: Peaks,
    pub(super) totals: Totals,
    /// Number of substeps, and errors so far.
    pub(super) step_control: StepControl,
}

/// Energy and momenta that audits subtract: J, kg m/s, kg m²/s.
#[derive(Clone, Copy, Debug, Default)]
struct Baseline {
    energy: f64,
    momentum: Vector,
    angular: f64,
}

impl Baseline {
    fn less(self, other: &Self) -> Self {
        Self {
            energy: self.energy - other.energy,
            momentum: self.momentum - other.momentum,
            angular: self.angular - other.angular,
        }
    }
}

impl Simulation {
    /// Builds a simulation at the start of its guide, with the guide's rates, on a base at the origin. A free base moves so
    /// that all momentum is zero; another rests.
    ///
    /// # Errors
    /// If the plant is not a valid machine, or if a moving base exceeds the maximum number of rotational coordinates.
    pub fn new(setup: &Setup, guide: Guide) -> Result<Self, MachineError> {
        Self::of_machine(setup, setup.plant.machine(setup.model)?, guide)
    }

    /// Builds a simulation with a given machine as plant, in place of the one that the setup derives from the model.
    ///
    /// # Errors
    /// If the machine cannot hold the plant's payload, or if a moving base exceeds the maximum number of rotational
    /// coordinates.
    pub fn of_machine(setup: &Setup, machine: Machine, guide: Guide) -> Result<Self, MachineError> {
        let reference = guide.at(0.0);
        let (plant, load) = (setup.plant, setup.plant.payload);
        let force = Vector::new(plant.force[0], plant.force[1]);
        let start = &reference.q;
        let holding = load.held_by(&machine)?;
        let body = |m: &Machine| MovingBody::of(m, &plant.friction, setup.base, start).map(|b| b.with_force(force));
        let empty = body(&machine)?;
        let first = load.is_held(0.0, 0.5 * setup.step);
        // The springs are preloaded for the payload that is held at the start.
        let with = body(&holding)?;
        let bodies = if first { [empty.preloaded_as(&with), with] } else { [empty.clone(), with.preloaded_as(&empty)] };
        let fixed = Base::default();
        let known = if setup.control.knows_base { setup.base } else { &fixed };
        let model = |m: &Machine| MovingBody::of(m, &Friction::default(), known, start);
        let models = [model(setup.model)?, model(&load.held_by(setup.model)?)?];
        let models = match (first, models) {
            (true, [empty, with]) => [empty.preloaded_as(&with), with],
            (false, [empty, with]) => [empty.clone(), with.preloaded_as(&empty)],
        };
        let n = machine.drives();
        // Of the model on a fixed base: b is formed from the angles between drives and base.
        let lambda = Inertia::of(setup.model).lambda();
        let limits = plant
            .torque_limits
            .then(|| PerDrive::from_fn(n, |k| setup.model.spec().drives[k].torque_limit.unwrap_or(f64::INFINITY)));
        let controller = Controller::new(setup.control, n, models);
        let control_loop = ControlLoop::new(controller, setup.control, setup.step, limits, setup.base);
        let loaded = usize::from(first);
        let state = bodies[loaded].started(&reference.q, &reference.qd);
        let now = bodies[loaded].slope_without_torque(&state);
        let mut sim = Self {
            bodies: Box::new(bodies),
            load,
            loaded: first,
            control_loop,
            link_moments: [&machine, &holding].map(link_moments),
            inside: [&machine, &holding].map(PinLoads::of),
            closures: machine.closure_gaps(),
            lambda,
            map: plane_map(setup.model).ok(),
            angles: setup.model.angles().to_vec(),
            drives: n,
            dt: setup.step,
            floats: setup.base.floats(),
            step: 0,
            guide,
            state,
            slip: [0; MAX_CONTACTS],
            stuck_torque: [0.0; MAX_CONTACTS],
            now,
            reference,
            baseline: Baseline::default(),
            peaks: Peaks::zero(n),
            totals: Totals::default(),
            step_control: StepControl::new(n),
        };
        sim.begin();
        Ok(sim)
    }

    /// Makes the present instant the start of the audits.
    fn begin(&mut self) {
        self.prepare();
        self.slip = self.body().contacts().slips(&self.body().rates(&self.state));
        self.evaluate();
        self.baseline = self.sources(self.body(), &self.now);
        self.include();
    }

    /// Returns energy and momenta of a body less their sources: conserved quantities.
    fn sources(&self, body: &MovingBody, x: &Slope) -> Baseline {
        let (p, h) = body.arm_momentum(x);
        let energy = x.kinetic + body.potential(x) - self.state.work + self.state.lost;
        Baseline { energy, momentum: p + self.state.impulse.0, angular: h + self.state.impulse.1 }
    }

    /// Returns the present moving body.
    pub(crate) fn body(&self) -> &MovingBody {
        &self.bodies[usize::from(self.loaded)]
    }

    /// Returns the number of steps done.
    pub fn step_count(&self) -> u64 {
        self.step
    }

    /// Returns the time since the start, s.
    pub fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// Returns the fixed step, s.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Returns the source of the reference.
    pub fn guide(&self) -> &Guide {
        &self.guide
    }

    /// Returns the reference at the present instant.
    pub fn reference(&self) -> &Reference {
        &self.reference
    }

    /// Changes the source of the reference. The machine keeps its state, and control corrects the tracking error.
    pub fn set_guide(&mut self, guide: Guide) {
        self.guide = guide;
        self.prepare();
        self.evaluate();
        self.include();
    }

    /// Changes plant, base and control in motion; positions and rates stay.
    ///
    /// # Errors
    /// As [`new`](Self::new); then the simulation is unchanged.
    pub fn reconfigure(&mut self, setup: &Setup) -> Result<(), MachineError> {
        let fresh = Self::new(setup, self.guide.clone())?;
        let old = std::mem::replace(self, fresh);
        let Self { step, guide, state, peaks, totals, step_control, baseline, now, control_loop, bodies, .. } = old;
        (self.step, self.guide, self.peaks, self.totals) = (step, guide, peaks, totals);
        self.step_control.resume(&step_control);
        self.control_loop.resume(&control_loop, step, &now.torque, now.spin.torque);
        for body in self.bodies.iter_mut() {
            *body = body.clone().preloaded_as(&bodies[0]);
        }
        self.loaded = self.load.is_held(self.time(), 0.5 * self.dt);
        (self.state, self.now, self.baseline) = (state, now, baseline);
        self.carry_over(&now, &bodies[usize::from(old.loaded)]);
        Ok(())
    }

    /// Transfers positions and rates to the present body. The audits continue without a jump.
    fn carry_over(&mut self, before: &Slope, body: &MovingBody) {
        let n = self.drives;
        let off = self.sources(body, before).less(&self.baseline);
        let (q, qd) = (self.state.drives(n), before.qd.first(n));
        let turning = before.qd.get(n).copied().unwrap_or(0.0);
        let (pose, velocity) = (before.base, before.base_velocity);
        let state = self.body().state(&q, &qd, pose, velocity, turning);
        self.state = state.with_sums_of(&self.state);
        self.slip = self.body().contacts().slips(&self.body().rates(&self.state));
        self.evaluate();
        self.baseline = self.sources(self.body(), &self.now).less(&off);
        self.include();
    }

    /// Places the machine at the pose and rates of the reference, without simulating a motion to it.
    pub fn move_to_reference(&mut self, guide: Guide) {
        self.guide = guide;
        let reference = self.guide.at(self.time());
        let (base, velocity) = (self.now.base, self.now.base_velocity);
        let turning = self.now.qd.get(self.drives).copied().unwrap_or(0.0);
        let n = self.drives;
        let q = DriveAngles(PerDrive::from_fn(n, |k| reference.q[k] + base.angle));
        let qd = PerDrive::from_fn(n, |k| reference.qd[k] + turning);
        let state = self.body().state(&q, &qd, base, velocity, turning);
        self.state = state.with_sums_of(&self.state);
        self.control_loop.forget();
        self.begin();
    }

    /// Returns whether the run is at its end: the guide has arrived, the machine is at rest, and no change of the
    /// payload is pending.
    pub fn is_settled(&self) -> bool {
        let e = PerDrive::from_fn(self.drives, |k| self.relative(k) - self.reference.q[k]);
        let still = self.now.qd.max_abs() < 1e-7 && self.now.base_velocity.norm() < 1e-7;
        let coming = self.load.is_some() && self.time() < self.load.until.unwrap_or(self.load.from);
        self.has_arrived() && still && !coming && {
            // A machine with zero rates that accelerates is not at rest; at the reference, a small acceleration is
            // allowed.
            let pull = self.now.qdd.max_abs();
            pull < 1e-7 || (e.max_abs() < 1e-7 && pull < 1e-3)
        }
    }

    /// Returns q_k − θ, rad.
    pub(super) fn relative(&self, k: usize) -> f64 {
        self.state.q[k] - self.now.base.angle
    }

    /// Returns whether the guide has come to its end, even if the machine still moves.
    pub fn has_arrived(&self) -> bool {
        match &self.guide {
            Guide::Motion { motion, start, .. } => self.time() >= start + motion.duration() - 0.5 * self.dt,
            Guide::Follow(follower) => follower.is_at_rest(),
            Guide::Lead(follower) => follower.is_at_rest(),
        }
    }

    /// Advances by one step.
    pub fn advance(&mut self) {
        let mut reached = self.here();
        let goes_on = self.take_step(&mut reached);
        (self.state, self.slip, self.stuck_torque) = (reached.state, reached.slip, reached.stuck_torque);
        self.step += 1;
        match &mut self.guide {
            Guide::Follow(follower) => follower.advance(),
            Guide::Lead(follower) => follower.advance(),
            Guide::Motion { .. } => {}
        }
        if goes_on && self.control_loop.is_steady() && matches!(self.guide, Guide::Motion { .. }) {
            // The end of the step has been evaluated already.
            (self.now, self.reference) = (reached.slope, reached.aim);
        } else {
            self.evaluate();
        }
        let held = self.load.is_held(self.time(), 0.5 * self.dt);
        if held != self.loaded {
            let (before, old) = (self.now, usize::from(self.loaded));
            self.loaded = held;
            let body = self.bodies[old].clone();
            self.carry_over(&before, &body);
        } else {
            self.include();
        }
    }

    /// Returns the state at the beginning of a step.
    pub(super) fn here(&self) -> StepState {
        StepState {
            at: 0.0,
            state: self.state,
            slope: self.now,
            aim: self.reference,
            slip: self.slip,
            stuck_torque: self.stuck_torque,
        }
    }

    /// Evaluates the present instant: control, slope, wrench of the plant's own motion.
    fn evaluate(&mut self) {
        self.reference = self.aim_now();
        let size = self.body().turning();
        by_drives!(size, self.body().moves(), evaluate_of(self));
        let stuck_torque = self.stuck_torque;
        let mut slip = self.slip;
        self.release(&self.now, &mut slip, &stuck_torque);
        self.slip = slip;
    }

    /// Includes the present instant in peaks and totals.
    fn include(&mut self) {
        let x = &self.now;
        let (qd, qdd) = (x.qd.first(self.drives), x.qdd.first(self.drives));
        let turning = x.qd.get(self.drives).copied().unwrap_or(0.0);
        let wrench = self.body().transmitted(x);
        let (total, felt) = (wrench.total().moment, self.felt_moment(&wrench));
        let loaded = usize::from(self.loaded);
        let past = |(i, angle): (usize, &RelativeAngle)| (angle.past_limit(&self.state.q), i);
        let arm = self.body().arm();
        let at_motors =
            |x: &PerDrive, base: f64| arm.motors().to_motors(&PerDrive::from_fn(self.drives, |k| x[k] - base));
        let base_acceleration = x.qdd.get(self.drives).copied().unwrap_or(0.0);
        let now = Peaks {
            torque: x.torque,
            torque_sum: x.torque.iter().map(|t| t.abs()).sum(),
            force: wrench.dynamic.force.norm(),
            arm_moment: total.abs(),
            moment: felt.abs(),
            inertial_pull: dynamics::inertial_pull(&self.link_moments[loaded], &x.e, &qd, &qdd),
            weight: length(x.wrench.static_part.force),
            rate: at_motors(&qd, turning),
            acceleration: at_motors(&qdd, base_acceleration),
            tilt: self.inside[loaded].tilt(&x.e, &qd, &qdd, &self.field()),
            past_limit: self.angles.iter().enumerate().map(past).fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a }),
        };
        let time = self.time();
        self.peaks.include(&now);
        self.totals.include(x, [total, felt], now.force, time);
    }

    /// Returns the moment that turns the base, N m, of a wrench.
    fn felt_moment(&self, wrench: &BaseWrench) -> f64 {
        let x = &self.now;
        self.body().felt_moment(wrench, &x.e, x.spin.torque)
    }

    /// Returns gravity and outer force in axes that move with the base: the acceleration of the base is subtracted from
    /// gravity.
    pub(super) fn field(&self) -> ExternalLoads {
        let around = *self.body().around();
        ExternalLoads { gravity: around.gravity - self.now.base_acceleration, ..around }
    }

    /// Returns the present audit figures, which should be zero; `plane` is b − b_ref, rad.
    fn audited(&self, plane: f64) -> Audit {
        let off = self.sources(self.body(), &self.now).less(&self.baseline);
        let gap = |chain: &[f64; MAX_DRIVES]| stillbase_mechanics::machine::place_of(chain, &self.now.e).norm();
        Audit {
            momentum: off.momentum.norm(),
            angular: off.angular,
            energy: off.energy,
            closure: self.closures.iter().map(gap).fold(0.0, f64::max),
            step: self.step_control.error(&self.measure(), &self.totals, self.reach()),
            plane,
        }
    }

    /// Returns the present pin forces; the acceleration of a moving base acts as gravity.
    fn inside(&self) -> InternalLoads {
        let (x, n) = (&self.now, self.drives);
        let around = self.field();
        let contacts = self.body().contacts();
        let couple = |from, to| contacts.pin_torque(from, to, &x.qd, &self.slip, &self.stuck_torque);
        self.inside[usize::from(self.loaded)].at(&x.e, &x.qd.first(n), &x.qdd.first(n), &around, couple)
    }

    /// Returns all quantities at the present instant.
    pub fn frame(&self) -> Frame {
        let (x, n) = (&self.now, self.drives);
        let arm = self.body().arm();
        let q = self.state.drives(n);
        let relative = PerDrive::from_fn(n, |k| self.relative(k));
        let target_rides = self.floats && matches!(self.guide, Guide::Follow(_));
        let base_is_planned = match &self.guide {
            Guide::Motion { base_end, .. } => base_end.is_some(),
            Guide::Lead(_) => self.body().is_free(),
            Guide::Follow(_) => false,
        };
        let (phase, target, b_reference) = match &self.guide {
            Guide::Motion { motion, base_end, .. } => {
                let seen = end_effector(&arm.end_effector, &motion.path.at(1.0).q.units());
                let end = base_end.map_or(seen, |base| base.place(seen));
                let phase = if self.has_arrived() { Phase::Rest } else { Phase::Motion };
                (phase, Target { at: end, reach: Reach::Inside }, self.lambda.dot(&self.reference.q))
            }
            Guide::Follow(follower) => {
                let phase = if follower.is_at_rest() { Phase::Rest } else { Phase::Follow };
                let target = follower.target();
                (phase, if target_rides { target.on(x.base) } else { target }, follower.b())
            }
            Guide::Lead(follower) => {
                let phase = if follower.is_at_rest() { Phase::Rest } else { Phase::Follow };
                (phase, follower.target(), self.lambda.dot(&self.reference.q))
            }
        };
        let (momentum, angular_momentum) = self.body().momentum(x);
        let b = self.lambda.dot(&relative);
        let wrench = self.body().transmitted(x);
        Frame {
            step: self.step,
            time: self.time(),
            q,
            qd: x.qd.first(n),
            qdd: x.qdd.first(n),
            torque: x.torque,
            friction: x.friction,
            q_reference: self.reference.q,
            b,
            b_reference,
            a: PerDrive::from_fn(self.angles.len().min(MAX_DRIVES), |i| self.angles[i].value(&q)),
            base: x.base,
            floats: self.floats,
            base_velocity: x.base_velocity,
            base_rate: x.qd.get(n).copied().unwrap_or(0.0),
            base_angular_acceleration: x.qdd.get(n).copied().unwrap_or(0.0),
            wrench,
            felt_moment: self.felt_moment(&wrench),
            wheel: x.spin,
            momentum,
            angular_momentum,
            com: x.base.at + dynamics::centre_of_mass(arm, &x.e),
            end_effector: x.base.at + end_effector(&arm.end_effector, &x.e),
            target,
            target_rides,
            base_is_planned,
            loaded: self.loaded,
            kinetic: x.kinetic,
            dexterity: self.map.map_or_else(Default::default, |map| map.dexterity_at(&x.e)),
            transmission: least_transmission(&x.e, n),
            inside: self.inside(),
            phase,
            peaks: self.peaks,
            totals: self.totals,
            audit: self.audited(b - b_reference),
            shared: None,
        }
    }
}

/// Computes the present slope. Sampled control first takes a reading of the exact angles and rates.
#[inline(never)]
fn evaluate_of<const N: usize, const MOVES: bool>(simulation: &mut Simulation) {
    let Simulation { bodies, control_loop, reference, state, slip, stuck_torque, loaded, step, .. } = simulation;
    let body = &bodies[usize::from(*loaded)];
    let (at, n) = (ReducedState::<N>::of(state), reference.q.len());
    let stage = body.stage::<N, MOVES>(&at, slip, stuck_torque, |e, rate, base, velocity| {
        let units = with_ground(e);
        let turning = if MOVES { rate[N - 1] } else { 0.0 };
        let reading = Reading {
            q: DriveAngles(PerDrive::from_fn(n, |k| at.q[k] - base.angle)),
            qd: PerDrive::from_fn(n, |k| rate[k] - turning),
            e: &units,
            rates: &PerDrive::from(*rate),
            base,
            velocity,
        };
        control_loop.sample(*step, reference, &reading, *loaded, at.wheel);
        control_loop.command::<N, MOVES>(reference, &at, (e, rate), (base, velocity), *loaded)
    });
    simulation.now = stage.slope(n);
}

/// Returns m_j a_jk of every link and of the machine's own payload, kg m.
fn link_moments(machine: &Machine) -> Vec<Vector> {
    let n = machine.drives();
    let payload = (machine.spec().payload.mass, machine.payload_chain());
    let links = machine.links().iter().enumerate().map(|(j, l)| (l.mass, machine.com_chain(j)));
    let all = links.chain([payload]).filter(|(m, _)| *m > 0.0);
    all.flat_map(|(m, a)| a.into_iter().take(n).map(move |a| m * a)).collect()
}
