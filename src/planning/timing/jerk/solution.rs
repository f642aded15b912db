//! The interior-point method.

use super::band::Band;
use super::program::JerkProgram;
use super::spline::Timing;

/// Steps of the method at most.
const MAX_STEPS: usize = 80;
/// The share of T that the bound and the motion may be apart at its end.
const MAX_GAP_SHARE: f64 = 2e-4;
/// Shares of the curvature that jerk allows, for the timing to begin with.
const CURVATURE_SHARES: [f64; 3] = [1.0, 0.1, 0.01];
/// The least share of what room is worth that a step aims for: less, and steps creep along the limits.
const MIN_CENTRING: f64 = 0.1;
/// How often a step is halved where a limit curves towards it.
const MAX_HALVINGS: usize = 50;
/// The share of the way to the nearest limit that a step may go.
const STEP_SHARE: f64 = 0.99;

impl JerkProgram {
    /// The fastest timing; `None` if there is none that moves. `bound` is a θ̇² that no motion surpasses at a θ,
    /// `before` a timing on other nodes to begin from.
    pub fn solve(mut self, bound: impl Fn(f64) -> f64, before: Option<&Timing>) -> Option<Timing> {
        let count = self.worth.len();
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
        let many = (2 * self.sides.len() + count) as f64;
        if !self.measure(&c, 0.0) {
            return None;
        }
        let mut time = self.time(&c);
        for side in &mut self.sides {
            side.worth = side.room.map(|room| time / many / room);
        }
        self.worth.iter_mut().zip(&c).for_each(|(worth, c)| *worth = time / many / c);
        let mut gap = self.gap(&c);
        let mut band = Band::new(count);
        let (mut step, mut next) = (vec![0.0; count], c.clone());
        for _ in 0..MAX_STEPS {
            self.assemble(&c, &mut band);
            band.factor()?;
            // As if no limit were to push back: how far would that go?
            self.bent.fill(0.0);
            self.sides.iter_mut().for_each(|side| side.bent = [0.0; 2]);
            self.push(&c, 0.0, &mut step);
            band.solve(&mut step);
            let (primal, dual) = self.reach(&c, &step, 0.0, 1.0);
            let left = self.left(&c, &step, primal, dual);
            let centre = (left / gap).powi(3).clamp(MIN_CENTRING, 1.0) * gap / many;
            self.bend(&c, &step);
            self.push(&c, centre, &mut step);
            band.solve(&mut step);
            let (mut primal, dual) = self.reach(&c, &step, centre, STEP_SHARE);
            self.revalue(&c, &step, centre, dual);
            // Where a limit curves towards the step, less of it.
            let mut halved = 0;
            loop {
                next.iter_mut().zip(c.iter().zip(&step)).for_each(|(next, (c, step))| *next = c + primal * step);
                if self.measure(&next, 1.0 - STEP_SHARE) {
                    break;
                }
                halved += 1;
                if halved > MAX_HALVINGS {
                    return None;
                }
                primal *= 0.5;
            }
            self.sides.iter_mut().for_each(|side| side.settle());
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
