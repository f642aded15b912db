//! Smoothing of samples without delay: the smoothest values that stay near the samples.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | y, f | samples, and what they are smoothed to | any |
//! | D | third derivative by divided differences: 3! f[t_j, …, t_{j+3}] | s⁻³ |
//! | w_i, H_j | time that sample i, and that difference j, stands for | s |
//! | Ω | 2 sin(π f_c h)/h, the cut-off f_c as differences at the mean spacing h see it | rad/s |
//!
//! # Source
//! Whittaker's graduation with third differences: min Σ w (y − f)² + Ω⁻⁶ Σ H (D f)². With c = H D f it is
//! (H⁻¹ + Ω⁻⁶ D w⁻¹ Dᵀ) c = D y and f = y − Ω⁻⁶ w⁻¹ Dᵀ c, seven diagonals; this form takes a small correction away from
//! y instead of finding f among large numbers. For even spacing a wave of frequency f keeps
//! 1/(1 + (sin(πfh)/sin(πf_c h))⁶) of its amplitude, half of it at f_c, and no phase is shifted. Parabolas pass
//! unchanged.

/// How many diagonals the matrix has on either side.
const BAND: usize = 3;

/// What smooths, for given times and cut-off.
#[derive(Clone, Debug)]
pub struct LowPass {
    /// Rows of D.
    d: Vec<[f64; 4]>,
    /// Ω⁻⁶ / w.
    share: Vec<f64>,
    /// L D Lᵀ: the diagonal, then how the rows before enter.
    factor: Vec<[f64; BAND + 1]>,
}

impl LowPass {
    /// For times that rise, at least four, and a cut-off, Hz, below half of the mean rate; `None` for others.
    pub fn new(t: &[f64], cut_off: f64) -> Option<Self> {
        let n = t.len();
        if n < BAND + 1 || !t.windows(2).all(|w| w[1] - w[0] > 0.0) {
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
        let d: Vec<[f64; 4]> = (0..n - BAND).map(row).collect();
        let mut factor: Vec<[f64; BAND + 1]> = Vec::with_capacity(d.len());
        for j in 0..d.len() {
            let mut own = [0.0; BAND + 1];
            for back in 0..=BAND.min(j) {
                let i = j - back;
                own[back] = (back..4).map(|k| d[i][k] * share[i + k] * d[j][k - back]).sum();
            }
            own[0] += 3.0 / (t[j + BAND] - t[j]);
            // Row j of L, from the far diagonal inwards.
            for back in (1..=BAND.min(j)).rev() {
                let i = j - back;
                for further in back + 1..=BAND.min(j) {
                    own[back] -= own[further] * factor[j - further][0] * factor[i][further - back];
                }
                own[back] /= factor[i][0];
            }
            for back in 1..=BAND.min(j) {
                own[0] -= own[back] * own[back] * factor[j - back][0];
            }
            factor.push(own);
        }
        factor.iter().all(|row| row[0] > 0.0 && row.iter().all(|x| x.is_finite())).then_some(Self { d, share, factor })
    }

    /// The values smoothed.
    pub fn smooth(&self, y: &[f64]) -> Vec<f64> {
        let m = self.d.len();
        let mut c: Vec<f64> = self.d.iter().zip(y.windows(4)).map(|(d, y)| (0..4).map(|k| d[k] * y[k]).sum()).collect();
        for j in 0..m {
            for back in 1..=BAND.min(j) {
                c[j] -= self.factor[j][back] * c[j - back];
            }
        }
        for (c, factor) in c.iter_mut().zip(&self.factor) {
            *c /= factor[0];
        }
        for j in (0..m).rev() {
            for back in 1..=BAND.min(j) {
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
