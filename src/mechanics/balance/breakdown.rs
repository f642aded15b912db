//! [`Breakdown`]: every term of (7) and (8), and what each part of a machine brings to it.

use super::condition::Condition;
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::{MAX_DRIVES, Vector};

/// A part of a machine that has a mass of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Body {
    /// A link without what it carries, counted from 0.
    Link(usize),
    /// An entry of the machine's counterweights, counted from 0.
    Counterweight(usize),
    /// What the end effector holds.
    Payload,
}

/// A body, and what it rides on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// The body.
    pub body: Body,
    /// The link that it is, or that carries it.
    pub link: usize,
}

/// One line of (7) or (8).
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Which.
    pub condition: Condition,
    /// What is left of it, as [`Inertia`] has it: kg m of (7), kg m² of (8).
    pub left: Vector,
    /// What each source brings; the sum is what is left.
    pub parts: Vec<Vector>,
    /// Whether what is left is nothing but rounding.
    pub balanced: bool,
}

impl Term {
    /// Σ of the sizes of what the sources bring: what would be left if they all pulled one way.
    pub fn gross(&self) -> f64 {
        self.parts.iter().map(|part| part.norm()).sum()
    }
}

/// What of its balance a machine lacks, and where that comes from. Rotors are not in it: they are balanced about their
/// axes, and their masses are in the links that carry them.
#[derive(Clone, Debug, PartialEq)]
pub struct Breakdown {
    /// The links, the counterweights, and the payload if there is one.
    pub sources: Vec<Source>,
    /// First (7) by drives, then (8) by pairs of them.
    pub terms: Vec<Term>,
}

impl Breakdown {
    /// Of a machine.
    pub fn of(machine: &Machine) -> Self {
        let masses = masses(machine);
        let inertia = Inertia::of(machine);
        let terms = Condition::all(machine.drives()).map(|condition| {
            let left = condition.left(&inertia);
            let balanced = left.norm() <= condition.nothing(&inertia);
            let parts = masses.iter().map(|(_, mass, a)| condition.of(*mass, a)).collect();
            Term { condition, left, parts, balanced }
        });
        Self { terms: terms.collect(), sources: masses.iter().map(|(source, ..)| *source).collect() }
    }

    /// What a link brings to a term with all that it carries.
    pub fn of_link(&self, term: &Term, link: usize) -> Vector {
        let both = self.sources.iter().zip(&term.parts);
        both.filter(|(source, _)| source.link == link).map(|(_, part)| *part).sum()
    }
}

type Mass = (Source, f64, [Vector; MAX_DRIVES]);

/// Each body, its mass, and where that sits as a sum of unit vectors.
fn masses(machine: &Machine) -> Vec<Mass> {
    let (spec, parts) = (machine.spec(), machine.resolved_links());
    let on = |link: usize, along: f64, across: f64| {
        let mut a = parts[link].root.map(|w| Vector::new(w, 0.0));
        a[parts[link].drive] += parts[link].sign * Vector::new(along, across);
        a
    };
    let links = spec.links.iter().enumerate().map(|(link, body)| {
        let source = Source { body: Body::Link(link), link };
        (source, body.mass, on(link, body.com, body.com_normal))
    });
    let weights = spec.counterweights.iter().enumerate().filter_map(|(i, weight)| {
        let link = spec.links.iter().position(|link| link.name == weight.link)?;
        Some((Source { body: Body::Counterweight(i), link }, weight.mass, on(link, weight.at, 0.0)))
    });
    let payload = (spec.payload.mass > 0.0).then(|| {
        let source = Source { body: Body::Payload, link: machine.end_link() };
        (source, spec.payload.mass, machine.payload_chain())
    });
    links.chain(weights).chain(payload).collect()
}
