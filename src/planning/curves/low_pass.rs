//! Smoothing of samples without delay: a penalised least-squares fit (Whittaker's graduation).
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | y, f | samples, and smoothed values | any |
//! | D | third derivative by divided differences: 3! f[t_j, …, t_{j+3}] | s⁻³ |
//! | w_i, H_j | quadrature weights of sample i and of difference j | s |
//! | Ω | 2 sin(π f_c h)/h, cut-off f_c as seen by differences at the mean spacing h | rad/s |
//!
//! # Source
//! Whittaker's graduation with third differences: min Σ w (y − f)² + Ω⁻⁶ Σ H (D f)². With c = H D f the minimum
//! satisfies (H⁻¹ + Ω⁻⁶ D w⁻¹ Dᵀ) c = D y and f = y − Ω⁻⁶ w⁻¹ Dᵀ c. The matrix has seven diagonals. This form
//! subtracts a small correction from y and so avoids cancellation of large numbers. With even spacing, the gain at the
//! frequency ν is 1/(1 + (sin(πνh)/sin(πf_c h))⁶): one half at f_c. No phase is shifted. Parabolas pass unchanged.

/// Number of diagonals of the matrix on either side of the main one.
const HALF_BANDWIDTH: usize = 3;

/// Smoothing operator for given times and cut-off frequency.
#[derive(Clone, Debug)]
pub struct LowPass {
    /// Rows of D.
    d: Vec<[f64; 4]>,
    /// Ω⁻⁶ / w.
    share: Vec<f64>,
    /// LDLᵀ factorisation by rows: the pivot, then the entries of L, nearest diagonal first.
    factor: Vec<[f64; HALF_BANDWIDTH + 1]>,
}

impl LowPass {
    /// Factorises the system for rising times, s, and a cut-off, Hz. Returns `None` for fewer than four times, times
    /// that do not rise, or a cut-off not between 0 and half of the mean rate.
    pub fn new(t: &[f64], cut_off: f64) -> Option<Self> {
        let n = t.len();
        if n < HALF_BANDWIDTH + 1 || !t.windows(2).all(|w| w[1] - w[0] > 0.0) {
            return None;
        }
        let h = (t[n - 1] - t[0]) / (n - 1) as f64;
        if !(cut_off > 0.0 && cut_off < 0.5 / h) {
            return None;
        }
        let omega = 2.0 * (std::f64::consts::PI * cut_off * h).sin() / h;
        let weight = |i: usize| 0.5 * (t[(i + 1).min(n - 1)] - t[i.max(1) - 1]);
        let share: Vec<f64> = (0..n).map(|i| 1.0 / (weight(i) * omega.powi(6))).collect();
        let row = |j: usize| {
            std::array::from_fn(|k| {
                let others = (0..4).filter(|m| *m != k);
                6.0 / others.map(|m| t[j + k] - t[j + m]).product::<f64>()
            })
        };
        let d: Vec<[f64; 4]> = (0..n - HALF_BANDWIDTH).map(row).collect();
        let mut factor: Vec<[f64; HALF_BANDWIDTH + 1]> = Vec::with_capacity(d.len());
        for j in 0..d.len() {
            let mut own = [0.0; HALF_BANDWIDTH + 1];
            for back in 0..=HALF_BANDWIDTH.min(j) {
                let i = j - back;
                own[back] = (back..4).map(|k| d[i][k] * share[i + k] * d[j][k - back]).sum();
            }
            own[0] += 3.0 / (t[j + HALF_BANDWIDTH] - t[j]);
            // Row j of L, from the outermost diagonal inwards.
            for back in (1..=HALF_BANDWIDTH.min(j)).rev() {
                let i = j - back;
                for further in back + 1..=HALF_BANDWIDTH.min(j) {
                    own[back] -= own[further] * factor[j - further][0] * factor[i][further - back];
                }
                own[back] /= factor[i][0];
            }
            for back in 1..=HALF_BANDWIDTH.min(j) {
                own[0] -= own[back] * own[back] * factor[j - back][0];
            }
            factor.push(own);
        }
        factor.iter().all(|row| row[0] > 0.0 && row.iter().all(|x| x.is_finite())).then_some(Self { d, share, factor })
    }

    /// Returns the smoothed values, one for each time.
    pub fn smooth(&self, y: &[f64]) -> Vec<f64> {
        let m = self.d.len();
        let mut c: Vec<f64> = self.d.iter().zip(y.windows(4)).map(|(d, y)| (0..4).map(|k| d[k] * y[k]).sum()).collect();
        for j in 0..m {
            for back in 1..=HALF_BANDWIDTH.min(j) {
                c[j] -= self.factor[j][back] * c[j - back];
            }
        }
        for (c, factor) in c.iter_mut().zip(&self.factor) {
            *c /= factor[0];
        }
        for j in (0..m).rev() {
            for back in 1..=HALF_BANDWIDTH.min(j) {
                c[j - back] -= self.factor[j][back] * c[j];
            }
        }
        let mut f = y.to_vec();
        for (j, (d, c)) in self.d.iter().zip(&c).enumerate() {
            for k in 0..4 {
                f[j + k] -= self.share[j + k] * d[k] * c;
            }
        }
        f
    }
}
