//! Folds of the self-motion: where det = 0 and b turns back.

use super::Quadrilateral;
use super::few::SmallList;
use stillbase_mechanics::planar::{Vector, cross, unit};

impl Quadrilateral {
    /// Returns the coefficients (A, B, C) of det ∝ A sin α + B sin β + C sin(α − β).
    fn sines(&self) -> [f64; 3] {
        let Self { m, x, y, lambda, .. } = *self;
        [-lambda[2] * m * x, lambda[1] * m * y, lambda[0] * x * y]
    }

    /// Finds the points of the curve with det = 0, where b turns back. β is `None` if only an approximate α is known.
    pub(super) fn folds(&self, mut push: impl FnMut(f64, Option<f64>)) {
        // The conditions |w| = r and det = 0 are linear in (cos β, sin β). Solving them and requiring a unit vector
        // gives, after the fourth powers cancel, a cubic in cos α:
        //     P² + sin²α L² = D²,   cos β = P/D,   sin β = sin α L/D.
        let Self { m, x, y, r, .. } = *self;
        let (xx, yy, t) = (m * x, m * y, x * y);
        let k = 0.5 * (r * r - m * m - x * x - y * y);
        let [a, b, c] = self.sines();
        let p = [k * b + a * t, -k * c - xx * b, xx * c - a * t];
        let l = [-a * yy - c * k, p[2]];
        let d = [yy * b - t * c, t * b - yy * c];
        let cubic = [
            p[0] * p[0] + l[0] * l[0] - d[0] * d[0],
            2.0 * (p[0] * p[1] + l[0] * l[1] - d[0] * d[1]),
            p[1] * p[1] + 2.0 * p[0] * p[2] - l[0] * l[0] + l[1] * l[1] - d[1] * d[1],
            2.0 * p[2] * (p[1] - l[0]),
        ];
        let scale = p.iter().chain(&l).chain(&d).fold(0.0, |m: f64, v| m.max(v.abs()));
        for cos in cubic_roots(cubic, 1e-9 * scale * scale).as_slice() {
            let (alpha, sin) = (cos.acos(), (1.0 - cos * cos).max(0.0).sqrt());
            let denominator = d[0] + d[1] * cos;
            let e = [p[0] + cos * (p[1] + cos * p[2]), sin * (l[0] + l[1] * cos)].map(|v| v * denominator.signum());
            let starts = if denominator.abs() > 1e-4 * scale {
                [Some(e[1].atan2(e[0])), None]
            } else {
                // The two conditions are linearly dependent: either elbow may have the fold.
                [1.0, -1.0].map(|sigma| Some(self.at(alpha, sigma, None).beta))
            };
            for start in starts.into_iter().flatten() {
                match self.polished_fold(alpha, start) {
                    Some([alpha, beta]) => {
                        push(alpha, Some(beta));
                        push(-alpha, Some(-beta));
                    }
                    None => {
                        push(alpha, None);
                        push(-alpha, None);
                    }
                }
            }
        }
    }

    /// Refines a fold by Newton's iteration on |w| = r and det = 0; `None` if it does not converge near the start.
    fn polished_fold(&self, mut alpha: f64, mut beta: f64) -> Option<[f64; 2]> {
        let Self { m, x, y, r, .. } = *self;
        let [a, b, c] = self.sines();
        let level = [m * x, m * y, x * y];
        let k = 0.5 * (r * r - m * m - x * x - y * y);
        let start = [alpha, beta];
        for _ in 0..8 {
            let (e, f) = (unit(alpha), unit(beta));
            let g = e * f.conj();
            let miss =
                Vector::new(level[0] * e.re + level[1] * f.re + level[2] * g.re - k, a * e.im + b * f.im + c * g.im);
            let by_alpha = Vector::new(-level[0] * e.im - level[2] * g.im, a * e.re + c * g.re);
            let by_beta = Vector::new(-level[1] * f.im + level[2] * g.im, b * f.re - c * g.re);
            let det = cross(by_alpha, by_beta);
            let step = [cross(miss, by_beta) / det, cross(by_alpha, miss) / det];
            let length = step[0].hypot(step[1]);
            if !length.is_finite() {
                return None;
            }
            alpha -= step[0];
            beta -= step[1];
            if (alpha - start[0]).hypot(beta - start[1]) > 0.1 {
                return None;
            }
            if length < 1e-9 {
                return Some([alpha, beta]);
            }
        }
        None
    }
}

/// Returns the roots in [−1, 1] of Σ c_i x^i, and those extrema and ends of the interval at which |value| ≤ `near`.
/// There two roots may have merged.
fn cubic_roots(c: [f64; 4], near: f64) -> SmallList<f64, 7> {
    let value = |x: f64| c[0] + x * (c[1] + x * (c[2] + x * c[3]));
    let slope = |x: f64| c[1] + x * (2.0 * c[2] + x * 3.0 * c[3]);
    let mut nodes = SmallList::<f64, 4>::new(1.0);
    nodes.push(-1.0);
    let root = (c[2] * c[2] - 3.0 * c[3] * c[1]).max(0.0).sqrt();
    let sum = -(c[2] + root.copysign(c[2]));
    let mut extrema = [sum / (3.0 * c[3]), c[1] / sum];
    extrema.sort_unstable_by(f64::total_cmp);
    extrema.into_iter().filter(|x| x.abs() < 1.0).for_each(|x| nodes.push(x));
    nodes.push(1.0);

    let mut roots = SmallList::new(0.0);
    for x in nodes.as_slice() {
        if value(*x).abs() <= near {
            roots.push(*x);
        }
    }
    for pair in nodes.as_slice().windows(2) {
        let [mut low, mut high] = [pair[0], pair[1]];
        let rising = value(high) > 0.0;
        if (value(low) > 0.0) == rising {
            continue;
        }
        let mut x = 0.5 * (low + high);
        for _ in 0..60 {
            let v = value(x);
            if (v > 0.0) == rising {
                high = x
            } else {
                low = x
            }
            let newton = x - v / slope(x);
            let inside = newton > low && newton < high;
            let next = if inside { newton } else { 0.5 * (low + high) };
            // The error after a Newton step is of the order of its square.
            let there = (next - x).abs() <= if inside { 1e-9 } else { 1e-15 };
            x = next;
            if there {
                break;
            }
        }
        roots.push(x);
    }
    roots
}
