//! The cheapest route from pose to pose over the layers.

use std::collections::HashSet;

use super::layers::{FEW_POSES, Layer, Layers, bounds, near, nearest};
use super::rows::lifted;
use super::stations::Stations;
use stillbase_mechanics::planar::PerDrive;

/// A continued pose is connected to the poses within this multiple of `spacing`.
const NEXT_POSE_FACTOR: f64 = 1.25;
/// Maximum number of routes that are tried before the search fails.
const MAX_TRIES: usize = 40;
/// Maximum number of start poses that are tried for closed paths.
const MAX_STARTS: usize = 60;
/// Maximum step of a path between stations, as a multiple of the mean step of the route there.
const STRETCH_FACTOR: f64 = 4.0;
/// Amount added to this maximum, rad.
const STRETCH_SLACK_RAD: f64 = 0.02;

/// Cost of a step of a route, given the index of the layer that it leaves, its start pose and its end pose.
pub(super) type StepCost<'a> = &'a dyn Fn(usize, &PerDrive, &PerDrive) -> f64;

/// Steps between layers, by layer and pose: index of the next pose, and the cost.
type Steps = Vec<Vec<Vec<(usize, f64)>>>;

impl Layers<'_> {
    /// Returns the poses at all stations along the cheapest route; if `closed`, along the cheapest that ends where it
    /// began.
    pub fn route(&self, stations: &Stations, cost: StepCost<'_>, closed: bool) -> Option<Vec<PerDrive>> {
        let mut steps = self.steps(cost);
        if closed {
            self.closing(&mut steps, cost);
        }
        let mut banned: HashSet<(usize, usize, usize)> = HashSet::new();
        for _ in 0..MAX_TRIES {
            let way = if closed { self.cheapest_round(&steps, &banned) } else { self.cheapest(&steps, &banned, None) };
            let (way, _) = way?;
            match self.expanded(stations, &way, closed) {
                Ok(path) => return Some(path),
                Err(step) => {
                    banned.insert((step, way[step], way[step + 1]));
                }
            }
        }
        None
    }

    /// Replaces the steps to the last layer by steps to the first, for closed paths.
    fn closing(&self, steps: &mut Steps, cost: StepCost<'_>) {
        let last = self.all.len() - 1;
        steps[last - 1] = self.leaving(last - 1, &self.all[0], cost);
    }

    fn steps(&self, cost: StepCost<'_>) -> Steps {
        (0..self.all.len() - 1).map(|i| self.leaving(i, &self.all[i + 1], cost)).collect()
    }

    /// Returns the steps from layer i to the layer `onto`.
    fn leaving(&self, i: usize, onto: &Layer, cost: StepCost<'_>) -> Vec<Vec<(usize, f64)>> {
        let (layer, square) = (&self.all[i], (NEXT_POSE_FACTOR * self.spacing).powi(2));
        let each = |(k, there): (usize, &Option<PerDrive>)| {
            let Some(there) = there else { return Vec::new() };
            let beside = onto.angles.iter().enumerate().filter(|(_, a)| near(a, there, square));
            beside.map(|(l, _)| (l, cost(i, &layer.poses[k], &onto.poses[l]))).collect()
        };
        layer.next.iter().enumerate().map(each).collect()
    }

    /// Finds the index of the pose in each layer along the cheapest route, from the given start or from any,
    /// and its cost. Routes
    /// from a given start also end there.
    fn cheapest(
        &self,
        steps: &Steps,
        banned: &HashSet<(usize, usize, usize)>,
        start: Option<usize>,
    ) -> Option<(Vec<usize>, f64)> {
        let first = self.all[0].poses.len();
        let mut costs: Vec<f64> =
            (0..first).map(|k| if start.is_none_or(|s| s == k) { 0.0 } else { f64::INFINITY }).collect();
        let mut from: Vec<Vec<usize>> = Vec::with_capacity(steps.len());
        for (i, layer) in steps.iter().enumerate() {
            let count = match start {
                Some(_) if i + 1 == steps.len() => first,
                _ => self.all[i + 1].poses.len(),
            };
            let (mut next, mut own) = (vec![f64::INFINITY; count], vec![usize::MAX; count]);
            for (k, ways) in layer.iter().enumerate().filter(|(k, _)| costs[*k].is_finite()) {
                for (l, cost) in ways {
                    let whole = costs[k] + cost;
                    if whole < next[*l] && (banned.is_empty() || !banned.contains(&(i, k, *l))) {
                        (next[*l], own[*l]) = (whole, k);
                    }
                }
            }
            costs = next;
            from.push(own);
        }
        let end = match start {
            Some(start) => start,
            None => (0..costs.len()).min_by(|x, y| costs[*x].total_cmp(&costs[*y]))?,
        };
        if !costs[end].is_finite() {
            return None;
        }
        let mut way = vec![end];
        for own in from.iter().rev() {
            way.push(own[*way.last()?]);
        }
        way.reverse();
        Some((way, costs[end]))
    }

    /// Finds the cheapest closed route, in the form returned by [`cheapest`](Self::cheapest).
    fn cheapest_round(&self, steps: &Steps, banned: &HashSet<(usize, usize, usize)>) -> Option<(Vec<usize>, f64)> {
        let count = self.all[0].poses.len();
        let every = count.div_ceil(MAX_STARTS);
        let rounds = (0..count).step_by(every).filter_map(|start| self.cheapest(steps, banned, Some(start)));
        rounds.min_by(|x, y| x.1.total_cmp(&y.1))
    }

    /// Returns the poses at all stations, or the index of the step of the route that is infeasible.
    fn expanded(&self, stations: &Stations, way: &[usize], closed: bool) -> Result<Vec<PerDrive>, usize> {
        let windows = bounds(self.space);
        let last = self.all.len() - 1;
        let angles = |i: usize| &self.all[if closed && i == last { 0 } else { i }].angles[way[i]];
        let mut path = vec![*angles(0)];
        for i in 0..last {
            let (from, to) = (angles(i), angles(i + 1));
            let [first, end] = [self.all[i].at, self.all[i + 1].at];
            let step = to.minus(from);
            let allowed = STRETCH_FACTOR * step.max_abs() / (end - first) as f64 + STRETCH_SLACK_RAD;
            for k in first + 1..=end {
                let share = (k - first) as f64 / (end - first) as f64;
                let guess = from.plus(share, &step);
                let before = path[path.len() - 1];
                let beside = |a: &PerDrive| a.minus(&before).max_abs() <= allowed;
                let p = stations.places[k];
                let a = match k == end {
                    true => Some(*to).filter(beside),
                    false => self.space.solved(p, self.b, &guess, &windows).filter(beside).or_else(|| {
                        let few = self.all[i].poses.len() < FEW_POSES || self.all[i + 1].poses.len() < FEW_POSES;
                        few.then(|| nearest(&self.space.representative_poses(p, self.b), &guess, allowed))
                            .flatten()
                            .filter(beside)
                    }),
                };
                path.push(a.ok_or(i)?);
            }
        }
        Ok(path.iter().map(|a| lifted(self.space, a, self.b)).collect())
    }
}
