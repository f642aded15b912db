//! [`PoseRange`]: the poses within the joint limits, as bounds on the differences of drive angles.

use std::f64::consts::{PI, TAU};

use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::MAX_DRIVES;

/// All poses of a machine within its joint limits. Turning the machine as a whole changes nothing.
#[derive(Clone, Debug)]
pub struct PoseRange {
    drives: usize,
    /// Greatest q_l − q_k, rad, by k and l.
    most: [[f64; MAX_DRIVES]; MAX_DRIVES],
}

/// Angles of a drive relative to another.
#[derive(Clone, Copy, Debug)]
pub struct AngleRange {
    /// Middle of the range, rad.
    pub middle: f64,
    /// Half its width, rad; at most half a turn.
    pub half: f64,
    /// Whether the limits leave a full turn or more, so that whole turns may be added.
    pub wraps: bool,
}

impl PoseRange {
    /// Returns the range of a machine.
    pub fn of(machine: &Machine) -> Self {
        let n = machine.drives();
        let mut most = [[f64::INFINITY; MAX_DRIVES]; MAX_DRIVES];
        for (k, row) in most.iter_mut().enumerate() {
            row[k] = 0.0;
        }
        for angle in machine.angles() {
            let ends = [*angle.limits.start(), *angle.limits.end()].map(|end| end - angle.offset);
            most[angle.from][angle.to] = most[angle.from][angle.to].min(ends[1]);
            most[angle.to][angle.from] = most[angle.to][angle.from].min(-ends[0]);
        }
        // The shortest paths through other drives.
        for via in 0..n {
            for from in 0..n {
                for to in 0..n {
                    most[from][to] = most[from][to].min(most[from][via] + most[via][to]);
                }
            }
        }
        Self { drives: n, most }
    }

    /// Returns the range of q_to − q_from.
    pub fn difference(&self, from: usize, to: usize) -> AngleRange {
        let (low, high) = (-self.most[to][from], self.most[from][to]);
        match high - low < TAU {
            true => AngleRange { middle: 0.5 * (low + high), half: 0.5 * (high - low), wraps: false },
            false if low.is_finite() && high.is_finite() => {
                AngleRange { middle: 0.5 * (low + high), half: PI, wraps: true }
            }
            false => AngleRange { middle: 0.0, half: PI, wraps: true },
        }
    }

    /// Returns the angles of all drives, rad, for those of some drives; the others lie in the middle of what the
    /// limits leave. `known` has each drive once, its angle up to whole turns.
    pub fn completed(&self, known: &[(usize, f64)]) -> Vec<f64> {
        let mut q = vec![None; self.drives];
        let others = (0..self.drives).filter(|k| known.iter().all(|(own, _)| own != k)).map(|k| (k, None));
        for (k, angle) in known.iter().map(|(k, angle)| (*k, Some(*angle))).chain(others) {
            let set = q.iter().enumerate().filter_map(|(f, q): (usize, &Option<f64>)| Some((f, (*q)?)));
            let (low, high) = set.fold((f64::NEG_INFINITY, f64::INFINITY), |(low, high), (f, q)| {
                (low.max(q - self.most[k][f]), high.min(q + self.most[f][k]))
            });
            let middle = match (low.is_finite(), high.is_finite()) {
                (true, true) => 0.5 * (low + high),
                (true, false) => low + PI,
                (false, true) => high - PI,
                (false, false) => angle.or(q[0]).unwrap_or(0.25 * TAU),
            };
            // Whole turns bring the angle near the middle of its range.
            q[k] = Some(angle.map_or(middle, |angle| angle + TAU * ((middle - angle) / TAU).round()));
        }
        q.into_iter().map(Option::unwrap_or_default).collect()
    }
}
