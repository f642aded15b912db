//! Steps along a vector field by the method of Dormand and Prince, of order 5 with an error estimate of order 4.

/// Slopes of the seven stages from those before them.
const STAGES: [[f64; 6]; 7] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// Difference of the weights of order 5 and 4.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

/// Maximum estimated error of a step, as a fraction of the scale of each coordinate.
const STEP_TOLERANCE: f64 = 1e-12;
/// Maximum number of trials of the size of a step, and of the place of an event in it.
const MAX_TRIALS: usize = 60;

/// A vector field x′ = f(x) of N coordinates; `None` where it is not defined.
pub(super) struct Flow<const N: usize, F: Fn(&[f64; N]) -> Option<[f64; N]>> {
    /// The field.
    pub field: F,
    /// Unit in which the error of each coordinate counts.
    pub scale: [f64; N],
}

/// A step along a field.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlowStep<const N: usize> {
    /// Where it ends.
    pub end: [f64; N],
    /// How long it is.
    pub length: f64,
    /// Proposed length of the next one.
    pub next: f64,
}

impl<const N: usize, F: Fn(&[f64; N]) -> Option<[f64; N]>> Flow<N, F> {
    /// Makes a step of a given length; returns its end and its error as a multiple of the tolerance.
    fn trial(&self, x: &[f64; N], h: f64) -> Option<([f64; N], f64)> {
        let mut slopes = [[0.0; N]; 7];
        let mut end = *x;
        for i in 0..7 {
            for k in 0..N {
                let sum: f64 = (0..i.min(6)).map(|j| STAGES[i][j] * slopes[j][k]).sum();
                end[k] = x[k] + h * sum;
            }
            slopes[i] = (self.field)(&end)?;
        }
        let error = |k: usize| h * (0..7).map(|i| ERROR[i] * slopes[i][k]).sum::<f64>() / self.scale[k];
        let error = (0..N).fold(0.0, |most: f64, k| most.max(error(k).abs()));
        (error.is_finite() && end.iter().all(|x| x.is_finite())).then_some((end, error / STEP_TOLERANCE))
    }

    /// Makes a step of at most a given length, as long as the tolerance permits. Returns `None` if no step does.
    pub fn step(&self, x: &[f64; N], most: f64) -> Option<FlowStep<N>> {
        let mut h = most;
        for _ in 0..MAX_TRIALS {
            match self.trial(x, h) {
                Some((end, error)) => {
                    let growth = (0.9 * error.max(1e-10).powf(-0.2)).clamp(0.2, 4.0);
                    if error <= 1.0 {
                        return Some(FlowStep { end, length: h, next: h * growth });
                    }
                    h *= growth.min(0.9);
                }
                None => h *= 0.2,
            }
        }
        None
    }

    /// Goes a given length along the field, in as many steps as it takes.
    pub fn go(&self, x: &[f64; N], length: f64) -> Option<[f64; N]> {
        let (mut at, mut left, mut h) = (*x, length, length);
        for _ in 0..100_000 {
            let step = self.step(&at, h.min(left))?;
            at = step.end;
            left -= step.length;
            if left <= 1e-15 * length {
                return Some(at);
            }
            h = step.next;
        }
        None
    }

    /// Returns where in a step from x a function first turns positive, if it does so at the end of the step but not at
    /// x: by bisection and secants in turn.
    pub fn event(&self, x: &[f64; N], step: &FlowStep<N>, g: impl Fn(&[f64; N]) -> f64) -> Option<[f64; N]> {
        let (mut low, mut high) = ((0.0, g(x), *x), (step.length, g(&step.end), step.end));
        if high.1 <= 0.0 {
            return None;
        }
        if low.1 > 0.0 {
            return Some(*x);
        }
        for i in 0..MAX_TRIALS {
            let share = if i % 3 == 2 { 0.5 } else { (low.1 / (low.1 - high.1)).clamp(1e-3, 1.0 - 1e-3) };
            let h = low.0 + share * (high.0 - low.0);
            let Some((at, _)) = self.trial(x, h) else { break };
            let value = g(&at);
            if value > 0.0 {
                high = (h, value, at);
            } else {
                low = (h, value, at);
            }
            if high.0 - low.0 <= 1e-14 * step.length {
                break;
            }
        }
        Some(low.2)
    }
}
