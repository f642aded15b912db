//! The interior-point method.

use super::band::Band;
use super::program::JerkProgram;
use super::spline::Timing;

/// Maximum number of steps.
const MAX_STEPS: usize = 80;
/// Tolerance of the complementarity gap and of the change of T, as a fraction of T.
const MAX_GAP_SHARE: f64 = 2e-4;
/// Fractions of the curvature that jerk allows, tried for the initial timing.
const CURVATURE_SHARES: [f64; 3] = [1.0, 0.1, 0.01];
/// Minimum centring parameter: with less, steps become short along the limits.
const MIN_CENTRING: f64 = 0.1;
/// Maximum number of halvings of a step that leaves the feasible set because limits are nonlinear.
const MAX_HALVINGS: usize = 50;
/// Maximum fraction of the distance to the nearest limit that a step may use.
const STEP_SHARE: f64 = 0.99;

impl JerkProgram {
    /// Finds the fastest timing; `None` if no feasible start is found or a step fails. `bound` returns an upper bound
    /// of θ̇² at a θ; `before` is a timing on other nodes to start from.
    pub fn solve(mut self, bound: impl Fn(f64) -> f64, before: Option<&Timing>) -> Option<Timing> {
        let count = self.multiplier.len();
        let mut best: Option<(f64, Vec<f64>)> = None;
        let last = self.nodes.len() - 1;
        let place = |j: usize| 0.5 * (self.nodes[j.saturating_sub(1)] + self.nodes[j.min(last)]);
        let begun = before.map(|before| (0..count).map(|j| before.at(place(j))).collect());
        let made = if begun.is_some() { &[][..] } else { &CURVATURE_SHARES };
        for start in begun.into_iter().chain(made.iter().filter_map(|share| self.start(&bound, *share))) {
            let Some(start) = self.within(start) else { continue };
            let time = self.time(&start);
            if best.as_ref().is_none_or(|(least, _)| time < *least) {
                best = Some((time, start));
            }
        }
        let mut c = best?.1;
        let limit_count = (2 * self.sides.len() + count) as f64;
        if !self.compute_slacks(&c, 0.0) {
            return None;
        }
        let mut time = self.time(&c);
        for side in &mut self.sides {
            side.multiplier = side.slack.map(|slack| time / limit_count / slack);
        }
        self.multiplier.iter_mut().zip(&c).for_each(|(multiplier, c)| *multiplier = time / limit_count / c);
        let mut gap = self.gap(&c);
        let mut band = Band::new(count);
        let (mut step, mut next) = (vec![0.0; count], c.clone());
        for _ in 0..MAX_STEPS {
            self.assemble(&c, &mut band);
            band.factor()?;
            // Predictor: step towards zero complementarity.
            self.correction.fill(0.0);
            self.sides.iter_mut().for_each(|side| side.correction = [0.0; 2]);
            self.right_side(&c, 0.0, &mut step);
            band.solve(&mut step);
            let (primal, dual) = self.step_lengths(&c, &step, 0.0, 1.0);
            let predicted = self.predicted_gap(&c, &step, primal, dual);
            let centre = (predicted / gap).powi(3).clamp(MIN_CENTRING, 1.0) * gap / limit_count;
            self.set_corrections(&c, &step);
            self.right_side(&c, centre, &mut step);
            band.solve(&mut step);
            let (mut primal, dual) = self.step_lengths(&c, &step, centre, STEP_SHARE);
            self.update_multipliers(&c, &step, centre, dual);
            // Halve the step while nonlinear limits are violated.
            let mut halved = 0;
            loop {
                next.iter_mut().zip(c.iter().zip(&step)).for_each(|(next, (c, step))| *next = c + primal * step);
                if self.compute_slacks(&next, 1.0 - STEP_SHARE) {
                    break;
                }
                halved += 1;
                if halved > MAX_HALVINGS {
                    return None;
                }
                primal *= 0.5;
            }
            self.sides.iter_mut().for_each(|side| side.accept());
            c.copy_from_slice(&next);
            let last = time;
            (time, gap) = (self.time(&c), self.gap(&c));
            if !time.is_finite() {
                return None;
            }
            if gap < MAX_GAP_SHARE * time && (last - time).abs() < MAX_GAP_SHARE * time {
                break;
            }
        }
        Some(Timing { nodes: self.nodes, c })
    }
}
