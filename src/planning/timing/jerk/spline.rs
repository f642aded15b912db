//! [`Timing`]: y = θ̇³ as a quadratic spline over the nodes.

use super::easing::eased;
use crate::timing::law::PathProgress;
use crate::timing::profile::Profile;

/// Points and weights of Gaussian quadrature, for the time that an interval takes.
const GAUSS_TIMES: [(f64, f64); 4] = [
    (0.069_431_844_202_973_7, 0.173_927_422_568_726_9),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_1),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_9),
];

/// A timing law, given by y = θ̇³ as a function of θ.
pub struct Timing {
    /// Nodes θ_i.
    pub nodes: Vec<f64>,
    /// Coefficients c_i, 1/s³.
    pub(super) c: Vec<f64>,
}

impl Timing {
    /// Returns the Bernstein coefficients of y on interval i: y at its start, c_(i+1), and y at its end.
    fn interval(&self, i: usize) -> [f64; 3] {
        let (c, ends) = (&self.c[i..i + 3], [share(&self.nodes, i), share(&self.nodes, i + 1)]);
        [(1.0 - ends[0]) * c[0] + ends[0] * c[1], c[1], (1.0 - ends[1]) * c[1] + ends[1] * c[2]]
    }

    /// Returns y at a θ.
    pub fn at(&self, theta: f64) -> f64 {
        let i = self.nodes.partition_point(|node| *node <= theta).clamp(1, self.nodes.len() - 1) - 1;
        let u = (theta - self.nodes[i]) / (self.nodes[i + 1] - self.nodes[i]);
        curved(self.interval(i), u)
    }

    /// Converts the timing to a profile with three phases for each interval.
    pub fn profile(&self) -> Profile {
        let spaces = self.nodes.len() - 1;
        let mut jets = Vec::with_capacity(spaces + 1);
        let mut t = 0.0;
        for i in 0..spaces {
            let (h, y) = (self.nodes[i + 1] - self.nodes[i], self.interval(i));
            // At the node, y′ = 2 (y[1] − y[0]) / h.
            let [s, first, second, _] = eased(self.nodes[i]);
            let rate = y[0].cbrt();
            let turn = 2.0 * (y[1] - y[0]) / (3.0 * h * rate);
            let jet =
                PathProgress { s, rate: first * rate, acceleration: second * rate * rate + first * turn, jerk: 0.0 };
            jets.push((t, jet));
            t += h * GAUSS_TIMES.map(|(at, weight)| weight / curved(y, at).cbrt()).iter().sum::<f64>();
        }
        jets.push((t, PathProgress::at_rest(1.0)));
        Profile::through_jets(&jets)
    }
}

/// Evaluates the quadratic with Bernstein coefficients `y` at the fraction u.
#[inline]
fn curved(y: [f64; 3], u: f64) -> f64 {
    let v = 1.0 - u;
    y[0] * v * v + 2.0 * y[1] * u * v + y[2] * u * u
}

/// Returns the weight of the later of the two coefficients that determine y at node i.
pub(super) fn share(nodes: &[f64], i: usize) -> f64 {
    let before = if i == 0 { 0.0 } else { nodes[i] - nodes[i - 1] };
    let after = nodes.get(i + 1).map_or(0.0, |next| next - nodes[i]);
    before / (before + after)
}
