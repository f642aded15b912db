//! A course of b: the pose constant along a motion, and the resulting base moment.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | u | t/T, 0 to 1 | 1 |
//! | b, b′, b″ | pose constant and derivatives by u | rad |
//! | n_B | base moment −D_1 b″/T², (11)–(13), with D_1 in kg m² | N m |

/// b over u = t/T: cubic pieces, b″ continuous.
#[derive(Clone, Debug, PartialEq)]
pub struct BCourse {
    /// b, b′, b″ at evenly spaced u.
    nodes: Vec<[f64; 3]>,
}

/// Peak and root mean square of the base moment over a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseReaction {
    /// Maximum |n_B|, N m.
    pub peak: f64,
    /// Root mean square of n_B over the motion, N m.
    pub rms: f64,
}

impl BCourse {
    /// Returns the course of constant b, rad.
    pub fn constant(b: f64) -> Self {
        Self { nodes: vec![[b, 0.0, 0.0]; 2] }
    }

    /// Integrates b″ at evenly spaced nodes, from rest at `start`, rad. A term linear in u is added to b″ so that the
    /// course ends at rest, and at `end`, rad, if given.
    pub(super) fn integrated(start: f64, mut second: Vec<f64>, end: Option<f64>) -> Self {
        let spaces = second.len() - 1;
        let h = 1.0 / spaces as f64;
        let sum = |second: &[f64]| {
            let (mut at, mut nodes) = ([start, 0.0, second[0]], Vec::with_capacity(spaces + 1));
            nodes.push(at);
            for w in second.windows(2) {
                at = [at[0] + h * at[1] + h * h * (2.0 * w[0] + w[1]) / 6.0, at[1] + h * (w[0] + w[1]) / 2.0, w[1]];
                nodes.push(at);
            }
            (nodes, at)
        };
        let (_, last) = sum(&second);
        // ∫ (α + γ (u − ½)) du = α, and ∫ (1 − u) (α + γ (u − ½)) du = α/2 − γ/12.
        let alpha = -last[1];
        let gamma = end.map_or(0.0, |end| 12.0 * (last[0] - end + alpha / 2.0));
        for (i, x) in second.iter_mut().enumerate() {
            *x += alpha + gamma * (i as f64 * h - 0.5);
        }
        Self { nodes: sum(&second).0 }
    }

    /// Returns b, b′, b″ at evenly spaced u from 0 to 1, rad.
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// Returns b, b′, b″ at u, clamped to 0..1, rad.
    pub fn at(&self, u: f64) -> [f64; 3] {
        let spaces = self.nodes.len() - 1;
        let x = u.clamp(0.0, 1.0) * spaces as f64;
        let i = (x as usize).min(spaces - 1);
        let (h, [b, first, second]) = (1.0 / spaces as f64, self.nodes[i]);
        let (d, third) = (u.clamp(0.0, 1.0) - i as f64 * h, (self.nodes[i + 1][2] - second) / h);
        [
            b + d * (first + d * (second / 2.0 + d * third / 6.0)),
            first + d * (second + d * third / 2.0),
            second + d * third,
        ]
    }

    /// Returns whether b is constant.
    pub fn is_constant(&self) -> bool {
        self.nodes.iter().all(|node| node[1] == 0.0 && node[2] == 0.0)
    }

    /// Returns the base moment for D_1 = `inertia`, kg m², and a motion of `duration`, s. It is exact, because b″ is
    /// linear between nodes.
    pub fn reaction(&self, inertia: f64, duration: f64) -> BaseReaction {
        let spaces = (self.nodes.len() - 1) as f64;
        let peak = self.nodes.iter().fold(0.0_f64, |m, node| m.max(node[2].abs()));
        let squares: f64 =
            self.nodes.windows(2).map(|w| (w[0][2] * w[0][2] + w[0][2] * w[1][2] + w[1][2] * w[1][2]) / 3.0).sum();
        let scale = inertia / (duration * duration);
        BaseReaction { peak: scale * peak, rms: scale * (squares / spaces).sqrt() }
    }
}
