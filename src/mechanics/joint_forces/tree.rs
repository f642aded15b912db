//! The tree of links that is left when every closure is cut, and what the closures do to it.

use crate::mechanics::machine::Turning;
use crate::mechanics::planar::Vector;

/// A link with whatever it holds, parents before children.
#[derive(Clone, Debug)]
pub struct TreeLink {
    /// Which link of the machine; the pin of the same number attaches it.
    pub link: usize,
    /// Place of its parent among the links; none: the base.
    pub parent: Option<usize>,
    /// Drive whose orientation it has.
    pub drive: usize,
    /// Drive of its parent, and how far along that its root is, signed, m.
    pub arm: (usize, f64),
    /// Σ m, kg.
    pub mass: f64,
    /// Σ m c about the root, kg m, c complex along the link.
    pub first: Vector,
    /// Σ I + m |c|² about the root, kg m².
    pub second: f64,
    /// How far along the link the end effector is, signed, m; none where it is on another.
    pub end_effector: Option<f64>,
    /// Whether a drive turns it.
    pub driven: bool,
}

/// A motor that has a rotor, or whose stator sits on a link.
#[derive(Clone, Debug)]
pub struct Stator {
    /// The drive it turns.
    pub drive: usize,
    /// The link that carries it; none: the base.
    pub link: Option<usize>,
    /// Its rotor: inertia, kg m², and how it turns with the drives.
    pub rotor: Turning,
    /// Whether what its drive asks is known before the closures are.
    pub before: bool,
}

/// A closure as forces see it: λ acts on the second link, −λ on the first.
#[derive(Clone, Debug)]
pub struct CutClosure {
    /// The pin it is.
    pub pin: usize,
    /// Links on whose roots λ has a moment, and its lever w, m.
    pub levers: Vec<(usize, f64)>,
    /// Links whose roots carry ±λ.
    pub carried: Vec<(usize, f64)>,
    /// Pins that depend on it, one bit each.
    pub reaches: u32,
}

/// What is solved at once.
#[derive(Clone, Debug)]
pub enum SolveStep {
    /// One closure from two links, each with its lever.
    Pair {
        /// The closure.
        closure: usize,
        /// The links.
        rows: [(usize, f64); 2],
    },
    /// Closures that do not come apart, from twice as many links.
    Together {
        /// The closures.
        closures: Vec<usize>,
        /// The links.
        rows: Vec<usize>,
    },
}

/// Lever of a closure's force about the root of a link, m.
pub fn lever(closure: &CutClosure, link: usize) -> f64 {
    closure.levers.iter().find(|(j, _)| *j == link).map_or(0.0, |(_, w)| *w)
}
