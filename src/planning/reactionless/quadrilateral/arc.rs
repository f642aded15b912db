//! [`MonotoneArc`]: a part of the curve along which b is monotone.

use std::f64::consts::PI;

/// A point of the curve. Along an arc α, β and b, in rad, are continuous and not wrapped.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    pub alpha: f64,
    pub beta: f64,
    pub b: f64,
}

/// A part of the curve along which b is monotone; a single point if both ends are equal.
#[derive(Clone, Copy, Debug)]
pub struct MonotoneArc {
    pub from: Site,
    pub to: Site,
    /// Parameter at the two ends, in [0, π].
    pub s: [f64; 2],
    pub(super) path: ArcSource,
}

/// The curve that an arc is part of.
#[derive(Clone, Copy, Debug)]
pub(super) enum ArcSource {
    /// A graph, and the whole turns, rad, that are added to its β.
    Graph(Graph, f64),
    /// A straight line: α, β and b are linear in s between the ends.
    Line,
}

/// One elbow over one interval of feasible α. The parameter s in [0, π] gives α = mid − half cos s, so that γ is smooth
/// in s where the curve turns back.
#[derive(Clone, Copy, Debug)]
pub(super) struct Graph {
    pub sigma: f64,
    pub piece: FeasibleInterval,
}

/// An interval of α in which the quadrilateral closes.
#[derive(Clone, Copy, Debug)]
pub(super) struct FeasibleInterval {
    pub ends: [f64; 2],
    /// cos γ = ±1 at the ends, where the curve turns back to the other elbow; `None` if it does not turn back.
    pub turning: Option<[f64; 2]>,
}

impl FeasibleInterval {
    /// Returns α of a parameter s.
    pub fn alpha(&self, s: f64) -> f64 {
        let [from, to] = self.ends;
        let (sin, cos) = (0.5 * s).sin_cos();
        if s < 0.5 * PI { from + (to - from) * sin * sin } else { to - (to - from) * cos * cos }
    }

    /// Returns the parameter s of an α.
    pub fn s(&self, alpha: f64) -> f64 {
        let [from, to] = self.ends;
        2.0 * (alpha - from).max(0.0).sqrt().atan2((to - alpha).max(0.0).sqrt())
    }

    /// Returns cos γ at an α that is a turning end, else `None`.
    pub fn turning_at(&self, alpha: f64) -> Option<f64> {
        let turning = self.turning?;
        (0..2).find(|&i| alpha == self.ends[i]).map(|i| turning[i])
    }
}
