//! [`Breakdown`]: every condition of (7) and (8), with the contribution of each body of a machine.

use super::condition::Condition;
use crate::machine::{Inertia, Machine, PartBody, PlaneBody};
use crate::planar::{MAX_DRIVES, Vector};

/// A body with mass: a link, a counterweight or the payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Body {
    /// A link, counted from 0, without the counterweights on it.
    Link(usize),
    /// A counterweight of the machine, counted from 0.
    Counterweight(usize),
    /// The payload at the end effector.
    Payload,
}

/// A body, and the link that carries it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CarriedBody {
    /// The body.
    pub body: Body,
    /// The link itself, or the link that carries the body.
    pub link: usize,
}

/// One condition of (7) or (8), with its residual.
#[derive(Clone, Debug, PartialEq)]
pub struct BalanceTerm {
    /// The condition.
    pub condition: Condition,
    /// Residual of the condition, computed from [`Inertia`]: kg m for (7), kg m² for (8).
    pub residual: Vector,
    /// Contributions of the bodies in [`Breakdown::sources`], kg m or kg m²; their sum is the residual.
    pub parts: Vec<Vector>,
    /// Whether the residual is within the tolerance, that is, zero to rounding.
    pub balanced: bool,
}

impl BalanceTerm {
    /// Returns the sum of the magnitudes of all contributions, kg m or kg m², against which the residual can be
    /// compared.
    pub fn gross(&self) -> f64 {
        self.parts.iter().map(|part| part.norm()).sum()
    }
}

/// Residuals of the balance conditions of a machine, and the bodies that contribute to them. Rotors are omitted: they
/// are balanced about their axes, and the mass of a link includes the rotors on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Breakdown {
    /// The links, the counterweights, and the payload if there is one.
    pub sources: Vec<CarriedBody>,
    /// The conditions: (7) of each drive, then (8) of each pair of drives.
    pub terms: Vec<BalanceTerm>,
}

impl Breakdown {
    /// Computes the breakdown of a machine.
    pub fn of(machine: &Machine) -> Self {
        let masses = masses(machine);
        let inertia = Inertia::of(machine);
        let terms = Condition::all_of(machine).map(|condition| {
            let residual = condition.residual(&inertia);
            let balanced = residual.norm() <= condition.tolerance(&inertia);
            let parts = masses.iter().map(|(_, mass, a)| condition.of(*mass, a)).collect();
            BalanceTerm { condition, residual, parts, balanced }
        });
        Self { terms: terms.collect(), sources: masses.iter().map(|(source, ..)| *source).collect() }
    }

    /// Returns what a link and all bodies on it contribute to a term, kg m or kg m².
    pub fn of_link(&self, term: &BalanceTerm, link: usize) -> Vector {
        let both = self.sources.iter().zip(&term.parts);
        both.filter(|(source, _)| source.link == link).map(|(_, part)| *part).sum()
    }
}

impl BalanceTerm {
    /// Returns what a part or a lump contributes to the term, kg m or kg m². It is part of what its link contributes,
    /// unless typed numbers of the link overrule it.
    pub fn of_part(&self, machine: &Machine, part: &PartBody) -> Vector {
        let PlaneBody { mass, at, across, .. } = part.body;
        self.condition.of(mass, &coefficients(machine, part.link, at, across))
    }
}

/// Returns the coefficients a_k, m, of a point of a link, Σ_k a_k e(q_k).
fn coefficients(machine: &Machine, link: usize, along: f64, across: f64) -> [Vector; MAX_DRIVES] {
    let own = &machine.resolved_links()[link];
    let mut a = own.root.map(|w| Vector::new(w, 0.0));
    a[own.drive] += own.sign * Vector::new(along, across);
    a
}

type Mass = (CarriedBody, f64, [Vector; MAX_DRIVES]);

/// Returns each body, its mass, kg, and the coefficients a_k, m, of its CM Σ_k a_k e(q_k).
fn masses(machine: &Machine) -> Vec<Mass> {
    let spec = machine.spec();
    let on = |link: usize, along: f64, across: f64| coefficients(machine, link, along, across);
    let links = spec.links.iter().enumerate().map(|(link, body)| {
        let source = CarriedBody { body: Body::Link(link), link };
        (source, body.mass, on(link, body.com, body.com_normal))
    });
    let weights = spec.counterweights.iter().enumerate().filter_map(|(i, weight)| {
        let link = spec.link_index(&weight.link)?;
        Some((CarriedBody { body: Body::Counterweight(i), link }, weight.mass, on(link, weight.at, weight.across)))
    });
    let payload = (spec.payload.mass > 0.0).then(|| {
        let source = CarriedBody { body: Body::Payload, link: machine.end_link() };
        (source, spec.payload.mass, machine.payload_chain())
    });
    links.chain(weights).chain(payload).collect()
}
