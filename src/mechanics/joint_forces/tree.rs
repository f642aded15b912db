//! The tree of links that remains when every closure is cut, and the action of closure forces on it.

use crate::machine::RotorCoupling;
use crate::planar::Vector;

/// A link of the tree; the link at the end effector includes the payload.
#[derive(Clone, Debug)]
pub struct TreeLink {
    /// Index of the link in the machine, and of the pin that attaches it.
    pub link: usize,
    /// Index of its parent in the tree; `None` for the base.
    pub parent: Option<usize>,
    /// Drive whose orientation the link has.
    pub drive: usize,
    /// Drive of its parent, and the signed distance of its root along the parent, m.
    pub arm: (usize, f64),
    /// Mass Σ m, kg.
    pub mass: f64,
    /// First moment Σ m c about the root, kg m, with complex c relative to the drive's direction.
    pub first: Vector,
    /// Moment of inertia Σ (I + m |c|²) about the root, kg m².
    pub second: f64,
    /// Signed distance of the end effector along the link, m; `None` if another link carries it.
    pub end_effector: Option<f64>,
    /// Whether a drive turns it.
    pub driven: bool,
}

/// A motor that has a rotor, or whose stator sits on a link.
#[derive(Clone, Debug)]
pub struct Stator {
    /// The drive it turns.
    pub drive: usize,
    /// The link that carries it; `None` for the base.
    pub link: Option<usize>,
    /// Its rotor, with inertia, kg m², and rate ratios.
    pub rotor: RotorCoupling,
    /// Whether the moment of its drive is known before the closures are solved.
    pub before: bool,
}

/// A closure that is cut: its force λ acts on the second link, −λ on the first.
#[derive(Clone, Debug)]
pub struct CutClosure {
    /// Index of its pin.
    pub pin: usize,
    /// Links about whose roots λ has a moment, each with the lever w of λ, m.
    pub levers: Vec<(usize, f64)>,
    /// Links whose roots carry λ or −λ, with the sign.
    pub carried: Vec<(usize, f64)>,
    /// Pins whose forces depend on λ, one bit each.
    pub reaches: u32,
}

/// One step of the solution: closures that are solved simultaneously.
#[derive(Clone, Debug)]
pub enum SolveStep {
    /// One closure from the equations of two links.
    Pair {
        /// The closure.
        closure: usize,
        /// The links, each with its lever, m.
        rows: [(usize, f64); 2],
    },
    /// Coupled closures from the equations of twice as many links.
    Together {
        /// The closures.
        closures: Vec<usize>,
        /// The links.
        rows: Vec<usize>,
    },
}

/// Returns the lever of a closure's force about the root of a link, m.
pub fn lever(closure: &CutClosure, link: usize) -> f64 {
    closure.levers.iter().find(|(j, _)| *j == link).map_or(0.0, |(_, w)| *w)
}
