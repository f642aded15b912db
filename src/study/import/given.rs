//! [`GivenMotion`]: a motion given by samples, adapted to a machine.

use std::f64::consts::TAU;

use stillbase_mechanics::machine::Machine;
use stillbase_planning::curves::given::SamplesError;
use stillbase_planning::curves::{Coordinates, Samples};

/// A motion given by samples.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenMotion {
    /// Coordinates that the samples give.
    pub coordinates: Coordinates,
    /// Names of the columns, without the time.
    pub names: Vec<String>,
    /// Times, s, and drive angles, rad, or coordinates of the end effector, m.
    pub samples: Samples,
    /// Whole turns added to each drive, so that the relative angles start within their limits, rad.
    pub lifted: Vec<f64>,
    /// Cut-off frequency of smoothing, Hz, and largest change of a sample by it, rad or m.
    pub smoothing: Option<[f64; 2]>,
}

impl GivenMotion {
    /// Builds a motion from samples of a machine's drive angles or end effector. Angles may have been wrapped: whole
    /// turns are added to a drive if they bring the first pose within the joint limits.
    pub fn new(machine: &Machine, coordinates: Coordinates, names: Vec<String>, samples: Samples) -> Self {
        let mut lifted = vec![0.0; samples.columns()];
        let first = samples.values(0);
        let angles = if coordinates == Coordinates::Drives { machine.angles() } else { &[] };
        for angle in angles {
            let a = first[angle.to] + lifted[angle.to] - first[angle.from] - lifted[angle.from] + angle.offset;
            let (low, high) = (*angle.limits.start(), *angle.limits.end());
            let turns = ((low - a) / TAU).ceil() * TAU;
            if !(low..=high).contains(&a) && a + turns <= high {
                lifted[angle.to] += turns;
            }
        }
        let row = |i: usize| samples.values(i).iter().zip(&lifted).map(|(q, lift)| q + lift).collect();
        let samples = match lifted.iter().all(|lift| *lift == 0.0) {
            true => samples,
            false => samples.with_values((0..samples.count()).map(row)).unwrap_or(samples),
        };
        Self { coordinates, names, samples, lifted, smoothing: None }
    }

    /// Returns the motion smoothed without delay; at the cut-off frequency, Hz, half of the amplitude remains.
    ///
    /// # Errors
    /// Fails if the cut-off frequency is not above 0 and below half of the mean sampling rate.
    pub fn smoothed(self, cut_off: f64) -> Result<Self, SamplesError> {
        let samples = self.samples.smoothed(cut_off)?;
        let all = |samples: &Samples| samples.rows().flat_map(|row| row[1..].to_vec()).collect::<Vec<_>>();
        let changes = all(&samples).into_iter().zip(all(&self.samples)).map(|(now, before)| (now - before).abs());
        let smoothing = Some([cut_off, changes.fold(0.0, f64::max)]);
        Ok(Self { samples, smoothing, ..self })
    }

    /// Returns the largest second derivative of each column at the samples, in its unit/s²; `None` if times are too
    /// close for a spline.
    pub(super) fn second_derivatives(&self) -> Option<Vec<f64>> {
        let path = self.samples.path(0.0)?;
        let per = self.samples.duration().powi(-2);
        let peak = |k: usize| path.nodes().iter().fold(0.0, |m: f64, node| m.max((node.second[k] * per).abs()));
        Some((0..self.samples.columns()).map(peak).collect())
    }
}
