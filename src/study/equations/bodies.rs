//! [`Bodies`]: a machine link by link, with symbols. The equations compare sums over links, counterweights and payload
//! with the closed forms of [`Inertia`](stillbase_mechanics::machine::Inertia).
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m_j, l_cj, I_j | mass, distance of the centre of mass along the link, and inertia of link j alone | kg, m, kg m² |
//! | w_j, x_j | mass and place of a counterweight of link j | kg, m |
//! | m_p, x_p | mass of the payload, and its distance beyond the end effector | kg, m |
//! | r_cj | Σ_k a_jk e(q_k) | m |

use super::equation::Origin;
use super::state::DriveState;
use super::symbol::{indexed_symbol, symbol_of_name};
use stillbase_mechanics::balance::Body;
use stillbase_mechanics::machine::{Attach, Length, LinkPoint, Machine, PlaceOnLink};
use stillbase_mechanics::planar::{MAX_DRIVES, Vector, cross, dot};

/// One step along a link, on the way from the base to a point.
#[derive(Clone, Debug)]
pub(super) struct Arm {
    pub drive: usize,
    /// Direction, ±1.
    pub sign: f64,
    pub symbol: String,
    /// Length of the step, m.
    pub value: f64,
    /// Whether the length is the body's own l_c rather than a length of a link.
    pub is_own: bool,
}

/// A body with mass: a link, a counterweight or the payload.
#[derive(Clone, Debug)]
pub(super) struct BodyMass {
    pub origin: Origin,
    /// The drive that determines its orientation.
    pub drive: usize,
    pub kilograms: f64,
    /// Moment of inertia, kg m².
    pub inertia: f64,
    pub mass_symbol: String,
    /// Empty if the moment of inertia is zero.
    pub inertia_symbol: String,
    pub arms: Vec<Arm>,
    /// Distance of the centre of mass from its link's axis, m, positive to the left.
    pub normal: f64,
    /// Coefficients a_k, m.
    pub a: [Vector; MAX_DRIVES],
}

/// A rotor: its drive, its inertia J, kg m², and the derivatives of its rate with respect to the rates of all drives.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyRotor {
    pub drive: usize,
    pub inertia: f64,
    pub rates: [f64; MAX_DRIVES],
}

/// All bodies of a machine.
pub(super) struct Bodies {
    pub masses: Vec<BodyMass>,
    pub rotors: Vec<BodyRotor>,
    /// Steps from the base to the end effector.
    pub tip: Vec<Arm>,
}

impl Bodies {
    pub fn of(machine: &Machine) -> Self {
        let (spec, walk) = (machine.spec(), Walk { machine });
        let links = spec.links.iter().enumerate().map(|(j, link)| {
            let symbols = [
                indexed_symbol("m", &link.name),
                indexed_symbol("I", &link.name),
                indexed_symbol("l", format!("c{}", link.name)),
            ];
            let origin = Origin::Body(Body::Link(j), j);
            mass(machine, origin, j, [link.mass, link.inertia, link.com, link.com_normal], symbols, &walk.root(j))
        });
        let weights = spec.counterweights.iter().enumerate().filter_map(|(i, weight)| {
            let j = spec.link_index(&weight.link)?;
            let before = spec.counterweights[..i].iter().filter(|other| other.link == weight.link).count();
            let name = format!("{}{}", weight.link, "′".repeat(before));
            let symbols =
                [indexed_symbol("w", &name), indexed_symbol("I", format!("w{name}")), indexed_symbol("x", &name)];
            let origin = Origin::Body(Body::Counterweight(i), j);
            let figures = [weight.mass, weight.inertia(), weight.at, weight.across];
            Some(mass(machine, origin, j, figures, symbols, &walk.root(j)))
        });
        let end = machine.end_link();
        let tip = spec.end_effector.as_ref().map_or_else(Vec::new, |point| walk.point(point, end));
        let payload = (spec.payload.mass > 0.0).then(|| {
            let held = spec.payload;
            let symbols = [indexed_symbol("m", "p"), indexed_symbol("I", "p"), indexed_symbol("x", "p")];
            let figures = [held.mass, held.inertia, held.offset[0], held.offset[1]];
            let mut payload = mass(machine, Origin::Body(Body::Payload, end), end, figures, symbols, &tip);
            if held.offset[0] == 0.0 {
                payload.arms.pop();
            }
            payload
        });
        let rotors = spec.drives.iter().enumerate().filter_map(|(k, drive)| {
            let rotor = drive.rotor.filter(|rotor| rotor.inertia > 0.0)?;
            let mut rates = [0.0; MAX_DRIVES];
            rates[k] = rotor.ratio;
            if let Some(on) = drive.on.as_ref().and_then(|on| spec.drives.iter().position(|d| d.name == *on)) {
                rates[on] += 1.0 - rotor.ratio;
            }
            Some(BodyRotor { drive: k, inertia: rotor.inertia, rates })
        });
        Self { masses: links.chain(weights).chain(payload).collect(), rotors: rotors.collect(), tip }
    }

    /// Returns a value for each body with mass.
    pub fn each(&self, value: impl Fn(&BodyMass) -> f64) -> Vec<(Origin, f64)> {
        self.masses.iter().map(|mass| (mass.origin, value(mass))).collect()
    }

    /// Returns J times a value for each rotor.
    pub fn each_rotor(&self, value: impl Fn(&BodyRotor) -> f64) -> Vec<(Origin, f64)> {
        self.rotors.iter().map(|rotor| (Origin::Rotor(rotor.drive), rotor.inertia * value(rotor))).collect()
    }

    /// Returns whether a mass lies off the axis of its link.
    pub fn has_normals(&self) -> bool {
        self.masses.iter().any(|mass| mass.normal != 0.0)
    }
}

fn mass(
    machine: &Machine,
    origin: Origin,
    link: usize,
    [kilograms, inertia, along, normal]: [f64; 4],
    [mass_symbol, inertia_symbol, com_symbol]: [String; 3],
    root: &[Arm],
) -> BodyMass {
    let part = &machine.resolved_links()[link];
    let mut arms = root.to_vec();
    arms.push(Arm { drive: part.drive, sign: part.sign, symbol: com_symbol, value: along, is_own: true });
    let mut a = [Vector::default(); MAX_DRIVES];
    for arm in &arms {
        a[arm.drive] += arm.sign * arm.value;
    }
    a[part.drive] += Vector::new(0.0, part.sign * normal);
    let inertia_symbol = if inertia == 0.0 { String::new() } else { inertia_symbol };
    BodyMass { origin, drive: part.drive, kilograms, inertia, mass_symbol, inertia_symbol, arms, normal, a }
}

/// Finds the steps from the base to points on links, with the symbols of the lengths.
struct Walk<'a> {
    machine: &'a Machine,
}

impl Walk<'_> {
    /// Returns the steps to the root of a link.
    fn root(&self, link: usize) -> Vec<Arm> {
        let (spec, part) = (self.machine.spec(), &self.machine.resolved_links()[link]);
        match (part.parent, &spec.links[link].attach) {
            (Some(parent), Attach::On(point)) => self.point(point, parent),
            _ => Vec::new(),
        }
    }

    /// Returns the steps to a point of a link.
    fn point(&self, point: &LinkPoint, link: usize) -> Vec<Arm> {
        let (spec, part) = (self.machine.spec(), &self.machine.resolved_links()[link]);
        let mut arms = self.root(link);
        let own = &spec.links[link];
        let length = || match &own.length {
            Length::Named(name) => symbol_of_name(name),
            Length::Metres(_) => indexed_symbol("l", &own.name),
        };
        let (sign, symbol, value) = match &point.at {
            PlaceOnLink::Named(word) if word == "root" => return arms,
            PlaceOnLink::Named(word) if word == "tip" => (1.0, length(), part.length),
            PlaceOnLink::Named(word) => {
                let (sign, name) = word.strip_prefix('-').map_or((1.0, word.as_str()), |name| (-1.0, name));
                (sign, symbol_of_name(name), spec.lengths.get(name).copied().unwrap_or_default())
            }
            PlaceOnLink::Metres(at) => (1.0, indexed_symbol("s", &own.name), *at),
        };
        arms.push(Arm { drive: part.drive, sign: sign * part.sign, symbol, value, is_own: false });
        arms
    }
}

/// Kinematics of the bodies at an instant.
pub(super) struct BodyMotion {
    n: usize,
    e: [Vector; MAX_DRIVES],
    qd: [f64; MAX_DRIVES],
    qdd: [f64; MAX_DRIVES],
}

const I: Vector = Vector::new(0.0, 1.0);

impl BodyMotion {
    pub fn of(state: &DriveState) -> Self {
        let mut e = [Vector::default(); MAX_DRIVES];
        // Computed here rather than taken from the closed forms, so that the two sides are independent.
        e.iter_mut().zip(state.q.iter()).for_each(|(e, q)| *e = Vector::new(q.cos(), q.sin()));
        Self { n: state.q.len(), e, qd: *state.qd.padded(), qdd: *state.qdd.padded() }
    }

    fn sum(&self, of: impl Fn(usize) -> Vector) -> Vector {
        (0..self.n).map(of).sum()
    }

    /// Returns the unit vector e(q_k).
    pub fn unit(&self, k: usize) -> Vector {
        self.e[k]
    }

    /// Returns the position r_c, m.
    pub fn place(&self, mass: &BodyMass) -> Vector {
        self.sum(|k| mass.a[k] * self.e[k])
    }

    /// Returns ∂r_c/∂q_k, m.
    pub fn column(&self, mass: &BodyMass, k: usize) -> Vector {
        I * mass.a[k] * self.e[k]
    }

    /// Returns the velocity ṙ_c, m/s.
    pub fn velocity(&self, mass: &BodyMass) -> Vector {
        self.sum(|k| self.column(mass, k) * self.qd[k])
    }

    /// Returns the acceleration r̈_c, m/s².
    pub fn acceleration(&self, mass: &BodyMass) -> Vector {
        self.sum(|k| self.column(mass, k) * self.qdd[k]) + self.turning(mass)
    }

    /// Returns the part of r̈_c that depends on rates only, m/s².
    pub fn turning(&self, mass: &BodyMass) -> Vector {
        -self.sum(|k| mass.a[k] * self.e[k] * self.qd[k] * self.qd[k])
    }

    /// Returns the rate of a rotor, rad/s.
    pub fn rotor_rate(&self, rotor: &BodyRotor) -> f64 {
        (0..self.n).map(|k| rotor.rates[k] * self.qd[k]).sum()
    }

    /// Returns the acceleration of a rotor, rad/s².
    pub fn rotor_acceleration(&self, rotor: &BodyRotor) -> f64 {
        (0..self.n).map(|k| rotor.rates[k] * self.qdd[k]).sum()
    }

    /// Returns τ_k, N m, by virtual work: the work of all bodies per radian that drive k alone turns.
    pub fn torque(&self, bodies: &Bodies, k: usize, gravity: Vector) -> f64 {
        let body = |mass: &BodyMass| {
            let turns = if mass.drive == k { mass.inertia * self.qdd[k] } else { 0.0 };
            mass.kilograms * dot(self.acceleration(mass) - gravity, self.column(mass, k)) + turns
        };
        let rotor = |rotor: &BodyRotor| rotor.inertia * rotor.rates[k] * self.rotor_acceleration(rotor);
        bodies.masses.iter().map(body).sum::<f64>() + bodies.rotors.iter().map(rotor).sum::<f64>()
    }

    /// Returns a body's contribution to D_k, kg m².
    pub fn momentum(&self, mass: &BodyMass, k: usize) -> f64 {
        let turns = if mass.drive == k { mass.inertia } else { 0.0 };
        mass.kilograms * cross(self.place(mass), self.column(mass, k)) + turns
    }
}
