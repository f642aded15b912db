//! The plant under control, advanced by a fixed step with the classical fourth-order rule.
//!
//! The simulation reads no clock. Control is evaluated in every stage. The base wrench is taken from the plant's own
//! accelerations, never from the planned motion, so that a zero is found and not assumed.

use crate::control::{Gains, computed_torque};
use crate::dynamics::{self, BaseWrench, Surroundings, angular_momentum, centre_of_mass, energy, linear_momentum};
use crate::frame::{Frame, Peaks, Phase, Reach, Target};
use crate::joint_forces::Watch;
use crate::kinematics::{end_effector, transmission};
use crate::machine::{Inertia, Machine, RelativeAngle};
use crate::plan::{Follower, Motion, Reference};
use crate::planar::{DriveAngles, MAX_DRIVES, PerDrive, Pose2, Units, Vector};
use crate::pose_constant::plane_map;
use crate::reactionless::PlaneMap;

/// What leads the machine.
#[derive(Clone, Debug)]
pub enum Guide {
    /// A planned motion that began at a time, s.
    Motion {
        /// The plan.
        motion: Motion,
        /// s.
        start: f64,
    },
    /// The pointer and the slider.
    Follow(Follower),
}

impl Guide {
    /// The reference at a time, s; `dt` is the time since the present step began, s.
    #[inline]
    fn at(&self, time: f64, dt: f64) -> Reference {
        match self {
            Self::Motion { motion, start } => motion.at(time + dt - start),
            Self::Follow(follower) => follower.reference(dt),
        }
    }
}

/// A machine as something that moves: its constants, and what surrounds it.
#[derive(Clone, Debug)]
struct Body {
    inertia: Inertia,
    around: Surroundings,
}

impl Body {
    fn of(machine: &Machine) -> Self {
        let around = Surroundings { gravity: machine.gravity(), force: Vector::default() };
        Self { inertia: Inertia::of(machine), around }
    }
}

/// State and rates of the plant.
#[derive(Clone, Copy, Debug)]
struct State {
    q: DriveAngles,
    qd: PerDrive,
    work: f64,
}

/// What the state leads to: its derivative and the torques.
#[derive(Clone, Copy, Debug)]
struct Slope {
    qd: PerDrive,
    qdd: PerDrive,
    power: f64,
    torque: PerDrive,
    reference: Reference,
    e: Units,
}

/// As much of a slope as the stages within a step need.
#[derive(Clone, Copy)]
struct Rates {
    qd: PerDrive,
    qdd: PerDrive,
    power: f64,
}

/// A run in progress.
#[derive(Clone, Debug)]
pub struct Simulation {
    model: Body,
    plant: Body,
    /// m_j a_jk of each link and of the payload, `drives` after `drives`, kg m.
    link_moments: Vec<Vector>,
    inside: Watch,
    lambda: PerDrive,
    map: Option<PlaneMap>,
    angles: Vec<RelativeAngle>,
    gains: Gains,
    dt: f64,
    step: u64,
    guide: Guide,
    state: State,
    slope: Slope,
    wrench: BaseWrench,
    start_energy: f64,
    peaks: Peaks,
}

impl Simulation {
    /// At rest at the start of its guide. Control believes in `model`; `plant` is what moves.
    ///
    /// # Panics
    /// If the machines differ in their number of drives.
    pub fn new(model: &Machine, plant: &Machine, gains: Gains, dt: f64, guide: Guide) -> Self {
        assert_eq!(model.drives(), plant.drives(), "model and plant have the same drives");
        let (model_body, body) = (Body::of(model), Body::of(plant));
        let reference = guide.at(0.0, 0.0);
        let state = State { q: reference.q, qd: reference.qd, work: 0.0 };
        let n = plant.drives();
        let payload = (plant.spec().payload.mass, plant.tip().map(|w| Vector::new(w, 0.0)));
        let links = plant.links().iter().enumerate().map(|(j, l)| (l.mass, plant.com_chain(j)));
        let link_moments = links
            .chain([payload])
            .filter(|(m, _)| *m > 0.0)
            .flat_map(|(m, a)| a.into_iter().take(n).map(move |a| m * a))
            .collect();
        let mut sim = Self {
            lambda: model_body.inertia.lambda(),
            map: plane_map(model).ok(),
            model: model_body,
            plant: body,
            link_moments,
            inside: Watch::of(plant),
            angles: model.angles().to_vec(),
            gains,
            dt,
            step: 0,
            guide,
            state,
            slope: Slope {
                qd: state.qd,
                qdd: state.qd,
                power: 0.0,
                torque: PerDrive::zeros(n),
                reference,
                e: state.q.units(),
            },
            wrench: BaseWrench::default(),
            start_energy: 0.0,
            peaks: Peaks::zero(n),
        };
        sim.begin();
        sim
    }

    fn begin(&mut self) {
        self.look();
        let (kinetic, potential) =
            energy(&self.plant.inertia, &self.slope.e, &self.state.qd, self.plant.around.gravity);
        self.start_energy = kinetic + potential - self.state.work;
    }

    /// Steps done.
    pub fn step_count(&self) -> u64 {
        self.step
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    /// The fixed step, s.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// What leads it.
    pub fn guide(&self) -> &Guide {
        &self.guide
    }

    /// The reference at the present instant.
    pub fn reference(&self) -> &Reference {
        &self.slope.reference
    }

    /// Lets something else lead from now on. The machine keeps its state and control takes up the difference.
    pub fn lead(&mut self, guide: Guide) {
        self.guide = guide;
        self.look();
    }

    /// Changes what moves and what control believes, in motion: positions and rates stay.
    pub fn change(&mut self, model: &Machine, plant: &Machine, gains: Gains) {
        let fresh = Self::new(model, plant, gains, self.dt, self.guide.clone());
        let Self { step, guide, state, peaks, .. } = self.clone();
        *self = Self { step, guide, state, peaks, ..fresh };
        self.begin();
    }

    /// Puts the machine at the reference, at rest or in motion as the reference is, without passing between.
    pub fn place(&mut self, guide: Guide) {
        self.guide = guide;
        let reference = self.guide.at(self.time(), 0.0);
        self.state = State { q: reference.q, qd: reference.qd, work: self.state.work };
        self.begin();
    }

    /// Whether nothing will change any more: the guide has arrived and the machine stands still on it.
    pub fn is_settled(&self) -> bool {
        let arrived = match &self.guide {
            Guide::Motion { motion, start } => self.time() >= start + motion.duration() - 0.5 * self.dt,
            Guide::Follow(follower) => follower.is_at_rest(),
        };
        let e = PerDrive::from_fn(self.state.q.len(), |k| self.state.q[k] - self.slope.reference.q[k]);
        arrived && self.state.qd.max_abs() < 1e-7 && (e.max_abs() < 1e-7 || self.slope.qdd.max_abs() < 1e-7)
    }

    /// Whether the guide has come to its end, even if the machine still moves.
    pub fn has_arrived(&self) -> bool {
        match &self.guide {
            Guide::Motion { motion, start } => self.time() >= start + motion.duration() - 0.5 * self.dt,
            Guide::Follow(follower) => follower.is_at_rest(),
        }
    }

    /// Unit vectors, reference and motor torques of a state, `dt` after the present step began, s.
    #[inline(always)]
    fn control(&self, state: &State, dt: f64) -> (Units, Reference, PerDrive) {
        let e = state.q.units();
        let reference = self.guide.at(self.time(), dt);
        let torque =
            computed_torque(&self.model.inertia, self.gains, &reference, &state.q, &e, &state.qd, &self.model.around);
        (e, reference, torque)
    }

    #[inline(always)]
    fn rates(&self, state: &State, dt: f64) -> Rates {
        let (e, _, torque) = self.control(state, dt);
        let qdd = dynamics::forward(&self.plant.inertia, &e, &state.qd, &torque, &self.plant.around);
        Rates { qd: state.qd, qdd, power: torque.dot(&state.qd) }
    }

    /// Advances by one step.
    pub fn advance(&mut self) {
        let h = self.dt;
        let from = self.state;
        let along = |s: &Rates, dt: f64| State {
            q: DriveAngles(from.q.0.plus(dt, &s.qd)),
            qd: from.qd.plus(dt, &s.qdd),
            work: from.work,
        };
        let k1 = Rates { qd: self.slope.qd, qdd: self.slope.qdd, power: self.slope.power };
        let k2 = self.rates(&along(&k1, h / 2.0), h / 2.0);
        let k3 = self.rates(&along(&k2, h / 2.0), h / 2.0);
        let k4 = self.rates(&along(&k3, h), h);
        let sum = |a: &PerDrive, f: fn(&Rates) -> &PerDrive| {
            a.plus(h / 6.0, &f(&k1).plus(2.0, &f(&k2).plus(1.0, f(&k3))).plus(1.0, f(&k4)))
        };
        self.state = State {
            q: DriveAngles(sum(&from.q.0, |s| &s.qd)),
            qd: sum(&from.qd, |s| &s.qdd),
            work: from.work + h / 6.0 * (k1.power + 2.0 * k2.power + 2.0 * k3.power + k4.power),
        };
        self.step += 1;
        if let Guide::Follow(follower) = &mut self.guide {
            follower.advance();
        }
        self.look();
    }

    /// Takes in the present instant: slope, wrench of the plant's own motion, and peaks.
    fn look(&mut self) {
        let state = &self.state;
        let (e, reference, torque) = self.control(state, 0.0);
        let (qdd, wrench) =
            dynamics::forward_with_wrench(&self.plant.inertia, &e, &state.qd, &torque, &self.plant.around);
        self.slope = Slope { qd: state.qd, qdd, power: torque.dot(&state.qd), torque, reference, e };
        self.wrench = wrench;
        let pull = dynamics::inertial_pull(&self.link_moments, &e, &state.qd, &qdd);
        self.peaks.include(&self.slope.torque, &self.wrench, pull);
    }

    /// Everything that is true now.
    pub fn frame(&self) -> Frame {
        let (State { q, qd, work }, s) = (self.state, &self.slope);
        let inertia = &self.plant.inertia;
        let tip = end_effector(&inertia.tip, &s.e);
        let (kinetic, potential) = energy(inertia, &s.e, &qd, self.plant.around.gravity);
        let (phase, target, b_reference) = match &self.guide {
            Guide::Motion { motion, .. } => {
                let end = end_effector(&inertia.tip, &motion.path.at(1.0).q.units());
                let phase = if self.has_arrived() { Phase::Rest } else { Phase::Motion };
                (phase, Target { at: end, reach: Reach::Inside }, self.lambda.dot(&s.reference.q))
            }
            Guide::Follow(follower) => {
                let phase = if follower.is_at_rest() { Phase::Rest } else { Phase::Follow };
                (phase, follower.target(), follower.b())
            }
        };
        Frame {
            step: self.step,
            time: self.time(),
            q,
            qd,
            qdd: s.qdd,
            torque: s.torque,
            q_reference: s.reference.q,
            b: self.lambda.dot(&q),
            b_reference,
            a: PerDrive::from_fn(self.angles.len().min(MAX_DRIVES), |i| {
                let a = &self.angles[i];
                q[a.to] - q[a.from] + a.offset
            }),
            base: Pose2::default(),
            wrench: self.wrench,
            momentum: linear_momentum(inertia, &s.e, &qd),
            angular_momentum: angular_momentum(inertia, &s.e, &qd),
            com: centre_of_mass(inertia, &s.e),
            tip,
            target,
            kinetic,
            energy_balance: kinetic + potential - work - self.start_energy,
            dexterity: self.map.map_or_else(Default::default, |map| map.dexterity_at(&s.e)),
            transmission: transmission(&s.e, q.len()),
            inside: self.inside.at(&s.e, &qd, &s.qdd, &self.plant.around),
            phase,
            peaks: self.peaks,
        }
    }
}
