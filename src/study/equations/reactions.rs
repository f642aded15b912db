//! Section 2 of the paper: force, moment and torque, (1)–(6), and the equations of motion (11).

use super::bodies::{Bodies, BodyMass, BodyMotion};
use super::equation::{Equality, Equation, Origin, Term};
use super::state::DriveState;
use super::symbol::indexed_symbol;
use stillbase_mechanics::dynamics::{self, ExternalLoads, MassMatrix};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{PerDrive, UnitVectors, Vector, cross, dot};

/// A machine at an instant: its bodies, and its closed forms.
pub(super) struct Reactions<'a> {
    pub machine: &'a Machine,
    pub inertia: &'a Inertia,
    pub bodies: &'a Bodies,
    pub motion: BodyMotion,
    pub e: UnitVectors,
    pub state: &'a DriveState,
    h: MassMatrix,
    v: PerDrive,
}

type Parts = Vec<(Origin, f64)>;

/// The two axes of the base, with the function that picks the component along each.
pub(super) const AXES: [VectorComponent; 2] = [("x", |v| v.re), ("y", |v| v.im)];
pub(super) type VectorComponent = (&'static str, fn(Vector) -> f64);

impl<'a> Reactions<'a> {
    pub fn of(machine: &'a Machine, inertia: &'a Inertia, bodies: &'a Bodies, state: &'a DriveState) -> Self {
        let e = state.q.units();
        let (h, v) = dynamics::mass_matrix(inertia, &e, &state.qd);
        Self { machine, inertia, bodies, motion: BodyMotion::of(state), e, state, h, v }
    }

    fn around(&self) -> ExternalLoads {
        ExternalLoads { gravity: self.machine.gravity(), force: Vector::default() }
    }

    fn drive(&self, k: usize) -> String {
        format!("drive {}", self.machine.spec().drives[k].name)
    }

    fn name(&self, k: usize) -> &str {
        &self.machine.spec().drives[k].name
    }

    fn several(&self) -> bool {
        self.machine.drives() > 1
    }

    pub fn force(&self) -> Equation {
        let (around, state) = (self.around(), self.state);
        let wrench = dynamics::base_wrench(self.inertia, &self.e, &state.qd, &state.qdd, &around).total();
        let line = |(axis, on): VectorComponent| {
            let letter = if axis == "x" { "ẍ" } else { "ÿ" };
            let moves = self.bodies.each(|mass| -mass.kilograms * on(self.motion.acceleration(mass)));
            let weighs = self.bodies.each(|mass| mass.kilograms * on(around.gravity));
            let right = vec![
                Term::sum(format!("Σ m_{{j}} {letter}_{{cj}}"), moves).negative(),
                Term::sum(format!("M g_{{{axis}}}"), weighs),
            ];
            let pull = self.bodies.each(|mass| mass.kilograms * self.motion.acceleration(mass).norm());
            let left = vec![Term::plain(indexed_symbol("f", format!("B{axis}")), on(wrench.force))];
            Equality::new(axis, "N", left, right, total(&pull))
        };
        Equation {
            number: "1",
            title: "Force on the base",
            says: "The base is pushed by whatever moves the centre of mass of all links, and by their weight.",
            form: "f_{B} = −d/dt (M ṙ_{CM}) + M g",
            notes: Vec::new(),
            lines: Ok(AXES.into_iter().map(line).collect()),
        }
    }

    pub fn centre(&self) -> Equation {
        let first = dynamics::first_moment(self.inertia, &self.e);
        let line = |(axis, on): VectorComponent| {
            let right: Vec<Term> = self
                .bodies
                .masses
                .iter()
                .map(|mass| {
                    let index = mass.mass_symbol.split_once("_{").map_or("", |(_, index)| index.trim_end_matches('}'));
                    let index =
                        if mass.mass_symbol.starts_with('w') { format!("w{index}") } else { format!("c{index}") };
                    let symbol = format!("{} {}", mass.mass_symbol, indexed_symbol(axis, index));
                    Term::sum(symbol, vec![(mass.origin, mass.kilograms * on(self.motion.place(mass)))])
                })
                .collect();
            let reach = self.bodies.each(|mass| mass.kilograms * self.motion.place(mass).norm());
            Equality::new(axis, "kg m", vec![Term::plain(format!("M {axis}_{{CM}}"), on(first))], right, total(&reach))
        };
        Equation {
            number: "2",
            title: "Centre of mass",
            says: "The centre of mass of the machine is the average of the links' centres of mass, weighted by their masses.",
            form: "r_{CM} = (1/M) Σ m_{j} r_{cj}",
            notes: vec!["Here times the mass M of all.".into()],
            lines: Ok(AXES.into_iter().map(line).collect()),
        }
    }

    pub fn momentum(&self) -> Equation {
        let momentum = self.bodies.each(|mass| mass.kilograms * self.motion.velocity(mass).norm());
        let line = |(axis, on): VectorComponent| {
            let letter = if axis == "x" { "ẋ" } else { "ẏ" };
            let own = self.bodies.each(|mass| mass.kilograms * on(self.motion.velocity(mass)));
            let right = (0..self.state.q.len()).map(|k| {
                let qd = self.state.qd[k];
                let gamma = on(Vector::new(0.0, qd) * self.inertia.first_moment(k) * self.e[k]);
                let parts = self.bodies.each(|mass| mass.kilograms * on(self.motion.column(mass, k)) * qd);
                Term::plain(format!("γ_{{{}{axis}}} q\u{307}_{{{}}}", self.name(k), self.name(k)), gamma).from(parts)
            });
            let left = vec![Term::sum(format!("M {letter}_{{CM}}"), own)];
            Equality::new(axis, "kg m/s", left, right.collect(), total(&momentum))
        };
        Equation {
            number: "3",
            title: "Momentum",
            says: "Each drive moves the centre of mass along its own γ; where all γ are zero, nothing moves it.",
            form: "ṙ_{CM} = (1/M) Σ γ_{i} q\u{307}_{i}",
            notes: vec!["Here times the mass M of all.".into()],
            lines: Ok(AXES.into_iter().map(line).collect()),
        }
    }

    /// Returns the contributions of bodies to H_kl q̈_l.
    fn inertial_parts(&self, k: usize, l: usize) -> Parts {
        let body = |mass: &BodyMass| {
            let turns = if k == l && mass.drive == k { mass.inertia } else { 0.0 };
            let moves = dot(self.motion.column(mass, k), self.motion.column(mass, l));
            (mass.kilograms * moves + turns) * self.state.qdd[l]
        };
        let mut parts = self.bodies.each(body);
        parts.extend(self.bodies.each_rotor(|rotor| rotor.rates[k] * rotor.rates[l] * self.state.qdd[l]));
        parts
    }

    pub fn torque(&self) -> Equation {
        let n = self.state.q.len();
        let gravity = self.machine.gravity();
        let holding = dynamics::holding_torque(self.inertia, &self.e, &self.around());
        let line = |k: usize| {
            let mut right: Vec<Term> = (0..n)
                .map(|l| {
                    let symbol = format!("H_{{{}{}}} q\u{308}_{{{}}}", self.name(k), self.name(l), self.name(l));
                    Term::plain(symbol, self.h.get(k, l) * self.state.qdd[l]).from(self.inertial_parts(k, l))
                })
                .collect();
            let turning =
                |mass: &BodyMass| mass.kilograms * dot(self.motion.turning(mass), self.motion.column(mass, k));
            right.push(Term::plain(indexed_symbol("V", self.name(k)), self.v[k]).from(self.bodies.each(turning)));
            let weight = |mass: &BodyMass| -mass.kilograms * dot(gravity, self.motion.column(mass, k));
            let held = Term::plain(format!("γ_{{{}}}·g", self.name(k)), holding[k]);
            right.push(held.from(self.bodies.each(weight)).negative());
            let own = self.motion.torque(self.bodies, k, gravity);
            let scale = total(&self.scale_of_torque(k));
            Equality::new(self.drive(k), "N m", vec![Term::plain(indexed_symbol("τ", self.name(k)), own)], right, scale)
        };
        let mut notes =
            vec!["The paper prints the last term with +; with g the acceleration of (1) it is −.".to_owned()];
        if self.machine.motors().in_joints() {
            notes.push("τ belongs to absolute angles; a motor in a joint gives the sum of the τ of the drives that it carries.".into());
        }
        Equation {
            number: "4",
            title: "Torques",
            says: "The torques accelerate the inertia (H), balance the velocity terms (V), and hold the weight.",
            form: "τ = H(q) q\u{308} + V(q, q\u{307}) − γ\u{1d40} g",
            notes,
            lines: Ok((0..n).map(line).collect()),
        }
    }

    /// Returns the absolute values that are summed in (4), as a scale for rounding.
    fn scale_of_torque(&self, k: usize) -> Parts {
        let gravity = self.machine.gravity();
        let size = |mass: &BodyMass| {
            let column = self.motion.column(mass, k).norm();
            mass.kilograms * column * (self.motion.acceleration(mass).norm() + gravity.norm())
        };
        let mut parts = self.bodies.each(size);
        parts.extend(self.bodies.each_rotor(|rotor| (rotor.rates[k] * self.motion.rotor_acceleration(rotor)).abs()));
        parts
    }

    pub fn moment(&self) -> Equation {
        let (around, state) = (self.around(), self.state);
        let wrench = dynamics::base_wrench(self.inertia, &self.e, &state.qd, &state.qdd, &around).total();
        let bodies = self.bodies;
        let weight = bodies.each(|mass| mass.kilograms * cross(self.motion.place(mass), around.gravity));
        let spin = bodies.each(|mass| -mass.inertia * self.state.qdd.get(mass.drive).copied().unwrap_or(0.0));
        let path = bodies.each(|mass| -mass.kilograms * cross(self.motion.place(mass), self.motion.acceleration(mass)));
        let size = |mass: &BodyMass| {
            let moves = self.motion.acceleration(mass).norm() + around.gravity.norm();
            mass.kilograms * self.motion.place(mass).norm() * moves
        };
        let scale = total(&bodies.each(size)) + total(&spin);
        let mut right = vec![
            Term::sum("r_{CM} × M g", weight),
            Term::sum("Σ I_{j} ω\u{307}_{j}", spin).negative(),
            Term::sum("Σ m_{j} r_{cj} × r\u{308}_{cj}", path).negative(),
        ];
        if !bodies.rotors.is_empty() {
            let rotors = bodies.each_rotor(|rotor| -self.motion.rotor_acceleration(rotor));
            right.push(Term::sum("Σ J ω\u{307}_{rotor}", rotors).negative());
        }
        Equation {
            number: "5",
            title: "Moment on the base",
            says: "The base is turned by weight that lies off B and by every change of angular momentum.",
            form: "n_{B} = r_{CM} × M g − d/dt Σ (I_{j} ω_{j} + m_{j} r_{cj} × ṙ_{cj})",
            notes: Vec::new(),
            lines: Ok(vec![Equality::new("", "N m", vec![Term::plain("n_{B}", wrench.moment)], right, scale)]),
        }
    }

    pub fn angular_momentum(&self) -> Equation {
        let bodies = self.bodies;
        let spin = bodies.each(|mass| mass.inertia * self.state.qd.get(mass.drive).copied().unwrap_or(0.0));
        let path = bodies.each(|mass| mass.kilograms * cross(self.motion.place(mass), self.motion.velocity(mass)));
        let size =
            |mass: &BodyMass| mass.kilograms * self.motion.place(mass).norm() * self.motion.velocity(mass).norm();
        let scale = total(&bodies.each(size)) + total(&spin);
        let mut left = vec![Term::sum("Σ I_{j} ω_{j}", spin), Term::sum("Σ m_{j} r_{cj} × ṙ_{cj}", path)];
        if !bodies.rotors.is_empty() {
            let rotors = bodies.each_rotor(|rotor| self.motion.rotor_rate(rotor));
            left.push(Term::sum("Σ J ω_{rotor}", rotors));
        }
        let right = (0..self.state.q.len()).map(|k| {
            let qd = self.state.qd[k];
            let mut parts = bodies.each(|mass| self.motion.momentum(mass, k) * qd);
            parts.extend(bodies.each_rotor(|rotor| rotor.rates[k] * qd));
            let symbol = format!("D_{{{}}} q\u{307}_{{{}}}", self.name(k), self.name(k));
            Term::plain(symbol, self.h.momentum_coefficient(k) * qd).from(parts)
        });
        Equation {
            number: "6",
            title: "Angular momentum",
            says: "The angular momentum of all bodies about B is D times the rates of the drives.",
            form: "Σ (I_{j} ω_{j} + m_{j} r_{cj} × ṙ_{cj}) = D(q) q\u{307}",
            notes: Vec::new(),
            lines: Ok(vec![Equality::new("", "kg m²/s", left, right.collect(), scale)]),
        }
    }

    /// Returns D_k at this instant, kg m², (A3).
    pub fn momentum_row(&self, k: usize) -> f64 {
        self.h.momentum_coefficient(k)
    }

    pub fn decoupled(&self, why_not: Option<String>) -> Equation {
        let n = self.state.q.len();
        let line = |k: usize| {
            let own = self.motion.torque(self.bodies, k, self.machine.gravity());
            let counts = |l: &usize| *l == k || !self.inertia.is_decoupled();
            let right = (0..n).filter(counts).map(|l| {
                let h = self.inertia.constant(k, l);
                let symbol = format!("h_{{{}{}}} q\u{308}_{{{}}}", self.name(k), self.name(l), self.name(l));
                Term::plain(symbol, h * self.state.qdd[l]).from(self.inertial_parts(k, l))
            });
            let left = vec![Term::plain(indexed_symbol("τ", self.name(k)), own)];
            Equality::new(self.drive(k), "N m", left, right.collect(), total(&self.scale_of_torque(k)))
        };
        let mut notes = Vec::new();
        if !self.inertia.is_decoupled() && self.several() {
            notes.push("Gears of rotors couple the drives: the matrix is constant, but not diagonal.".to_owned());
        }
        Equation {
            number: "11",
            title: "Motion of a balanced machine",
            says: if self.several() {
                "With (7) and (8) met, every drive turns a constant inertia, the same in every pose."
            } else {
                "With (7) met, the drive turns a constant inertia, the same in every pose."
            },
            form: "τ = diag(h_{11}, h_{22}, …) q\u{308}",
            notes,
            lines: why_not.map_or_else(|| Ok((0..n).map(line).collect()), Err),
        }
    }
}

/// Returns the sum of absolute values.
pub(super) fn total(parts: &[(Origin, f64)]) -> f64 {
    parts.iter().map(|(_, part)| part.abs()).sum()
}
