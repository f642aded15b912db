//! How a free base turns along any path of its arm: θ′ = −D q′/I of [`MomentumModel`], whatever the law of time.

use super::momentum::MomentumModel;
use crate::curves::Path;

/// Minimum number of intervals between samples of a path.
const MIN_INTERVALS: usize = 2048;

/// The turn of a free base along a path of its arm, from rest.
#[derive(Clone, Debug, PartialEq)]
pub struct BaseTurn {
    /// s, 0 to 1, and θ there, rad.
    samples: Vec<[f64; 2]>,
}

impl BaseTurn {
    /// Integrates the turn along a path by the Gauss rule of three points; `None` if the base is not free.
    pub fn along(model: &MomentumModel, path: &Path) -> Option<Self> {
        if !model.floats() {
            return None;
        }
        let slope = |s: f64| {
            let at = path.at(s);
            model.turn_coefficients(&at.q.units()).map_or(0.0, |turn| turn.dot(&at.first))
        };
        let off = 0.6_f64.sqrt();
        let stations = path.sample_parameters();
        let own = (MIN_INTERVALS / stations.len().max(1)).max(1);
        let mut samples = vec![[0.0, 0.0]];
        for ends in stations.windows(2) {
            let h = (ends[1] - ends[0]) / own as f64;
            for i in 0..own {
                let middle = ends[0] + (i as f64 + 0.5) * h;
                let sum = 5.0 * (slope(middle - 0.5 * off * h) + slope(middle + 0.5 * off * h)) + 8.0 * slope(middle);
                let before = samples.last().map_or(0.0, |last| last[1]);
                samples.push([middle + 0.5 * h, before + h / 18.0 * sum]);
            }
        }
        Some(Self { samples })
    }

    /// Returns the turn at s, 0 to 1, rad; linear between samples.
    pub fn at(&self, s: f64) -> f64 {
        let i = self.samples.partition_point(|sample| sample[0] < s).clamp(1, self.samples.len() - 1);
        let [from, to] = [self.samples[i - 1], self.samples[i]];
        let share = if to[0] > from[0] { ((s - from[0]) / (to[0] - from[0])).clamp(0.0, 1.0) } else { 1.0 };
        from[1] + share * (to[1] - from[1])
    }

    /// Returns the largest turn either way, rad.
    pub fn peak(&self) -> f64 {
        self.samples.iter().fold(0.0, |most: f64, sample| most.max(sample[1].abs()))
    }
}
