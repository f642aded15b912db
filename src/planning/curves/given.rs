//! A motion given by samples over time: of the drive angles, or of the end effector.
//!
//! A quintic [spline](crate::curves::spline) with four continuous derivatives passes through every sample. It
//! assumes nothing about the ends: the motion need not be at rest there. Its parameter is s = t/T, so a motion uses it
//! with [`Profile::running`](crate::timing::Profile::running). As a spline is linear in its samples, angles
//! that lie on a plane b = const stay on it between the samples.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::curves::PathPoint;
use crate::curves::curve::{Curve, CurvePoint};
use crate::curves::low_pass::LowPass;
use crate::curves::spline::{Knots, MIN_SPLINE_SAMPLES};
use crate::curves::table::PathTable;
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector};
use stillbase_settings::key::KeyType;
use stillbase_settings::keyed::HasKeyType;
use stillbase_settings::number::{ShortNumber, counted};
use stillbase_settings::range::Range;

/// Maximum number of samples.
pub const MAX_SAMPLES: usize = 20_000;

/// Permitted range of a time, which may count from a distant epoch.
const TIME_RANGE: Range = Range::either_way(1e11, "s");
/// Permitted range of an angle or a coordinate.
const VALUE_RANGE: Range = Range::either_way(1e6, "rad or m");

/// Minimum time between two samples, as a fraction of the whole duration.
const MIN_TIME_STEP: f64 = 1e-9;

/// Meaning of the values of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// Absolute drive angles, rad.
    Drives,
    /// x and y of the end effector, m.
    EndEffector,
}

impl Coordinates {
    /// Returns the short name used in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Drives => "drives",
            Self::EndEffector => "tip",
        }
    }
}

/// Rows of time, s, and values: drive angles, rad, or x and y of the end effector, m. Times rise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Vec<f64>>", into = "Vec<Vec<f64>>")]
pub struct Samples {
    /// Number of entries of a row: the time and the values.
    width: usize,
    values: Arc<[f64]>,
}

/// Why rows are not valid samples. Rows and columns are counted from 0; column 0 is the time.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SamplesError {
    /// Fewer samples than the spline needs.
    #[error("{}: want at least {MIN_SPLINE_SAMPLES}, because each end of the spline needs six", counted(got, "sample"))]
    TooFew {
        /// Number of samples.
        got: usize,
    },
    /// More samples than [`MAX_SAMPLES`].
    #[error("{got} samples: want at most {MAX_SAMPLES}, such as every second one")]
    TooMany {
        /// Number of samples.
        got: usize,
    },
    /// A row whose length differs from that of the first.
    #[error("sample {} has {}: want {want}, a time and the values, at most {MAX_DRIVES}", row + 1, counted(got, "number"))]
    Ragged {
        /// Row, counted from 0.
        row: usize,
        /// Number of its entries.
        got: usize,
        /// Number of entries of the first row, or the nearest permitted number.
        want: usize,
    },
    /// An entry that is not finite.
    #[error("sample {}, number {}: want a finite number", row + 1, column + 1)]
    NotFinite {
        /// Row, counted from 0.
        row: usize,
        /// Column, counted from 0.
        column: usize,
    },
    /// A number outside its permitted range.
    #[error("sample {}, number {} is {}: want {range}", row + 1, column + 1, ShortNumber(*value))]
    OutOfRange {
        /// Row, counted from 0.
        row: usize,
        /// Column, counted from 0.
        column: usize,
        /// The number.
        value: f64,
        /// The permitted range.
        range: Range,
    },
    /// Times that do not rise.
    #[error(
        "sample {} is at {} s, the one before at {} s: want times that rise", row + 1, ShortNumber(*time), ShortNumber(*before)
    )]
    NotRising {
        /// Row, counted from 0.
        row: usize,
        /// Time of this sample, s.
        time: f64,
        /// Time of the sample before, s.
        before: f64,
    },
    /// A cut-off frequency that is not between 0 and the Nyquist frequency.
    #[error("a cut-off of {} Hz: want one above 0 and below {nyquist:.6} Hz, half of the mean rate", ShortNumber(*cut_off))]
    CutOff {
        /// Cut-off frequency, Hz.
        cut_off: f64,
        /// Nyquist frequency at the mean sampling rate, Hz.
        nyquist: f64,
    },
}

impl TryFrom<Vec<Vec<f64>>> for Samples {
    type Error = SamplesError;
    fn try_from(rows: Vec<Vec<f64>>) -> Result<Self, SamplesError> {
        Self::new(&rows)
    }
}

impl From<Samples> for Vec<Vec<f64>> {
    fn from(samples: Samples) -> Self {
        samples.rows().map(<[f64]>::to_vec).collect()
    }
}

impl HasKeyType for Samples {
    const HOLDS: KeyType = KeyType::Rows;
}

impl Samples {
    /// Checks rows of a time, s, and one to eight values.
    ///
    /// # Errors
    /// If there are too few or too many rows, lengths differ, a number is not finite or out of range, or times do not
    /// rise.
    pub fn new(rows: &[Vec<f64>]) -> Result<Self, SamplesError> {
        let got = rows.len();
        if got < MIN_SPLINE_SAMPLES {
            return Err(SamplesError::TooFew { got });
        }
        if got > MAX_SAMPLES {
            return Err(SamplesError::TooMany { got });
        }
        let want = rows[0].len().clamp(2, MAX_DRIVES + 1);
        if let Some((row, of)) = rows.iter().enumerate().find(|(_, of)| of.len() != want) {
            return Err(SamplesError::Ragged { row, got: of.len(), want });
        }
        for (row, of) in rows.iter().enumerate() {
            if let Some(column) = of.iter().position(|x| !x.is_finite()) {
                return Err(SamplesError::NotFinite { row, column });
            }
            let range = |column: usize| if column == 0 { TIME_RANGE } else { VALUE_RANGE };
            if let Some(column) = (0..of.len()).find(|column| !range(*column).contains(of[*column])) {
                let (value, range) = (of[column], range(column));
                return Err(SamplesError::OutOfRange { row, column, value, range });
            }
        }
        let least = MIN_TIME_STEP * (rows[got - 1][0] - rows[0][0]).abs();
        for (row, w) in rows.windows(2).enumerate() {
            let (before, time) = (w[0][0], w[1][0]);
            if time.partial_cmp(&(before + least)) != Some(std::cmp::Ordering::Greater) {
                return Err(SamplesError::NotRising { row: row + 1, time, before });
            }
        }
        Ok(Self { width: want, values: rows.iter().flatten().copied().collect() })
    }

    /// Returns the rows: a time, s, and the values.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.values.chunks_exact(self.width)
    }

    /// Returns the number of samples.
    pub fn count(&self) -> usize {
        self.values.len() / self.width
    }

    /// Returns the number of values of a sample, without its time.
    pub fn columns(&self) -> usize {
        self.width - 1
    }

    /// Returns the values of sample i.
    pub fn values(&self, i: usize) -> &[f64] {
        &self.values[i * self.width + 1..(i + 1) * self.width]
    }

    /// Returns the time of sample i, s.
    pub fn time(&self, i: usize) -> f64 {
        self.values[i * self.width]
    }

    /// Returns the duration T from the first sample to the last, s.
    pub fn duration(&self) -> f64 {
        self.time(self.count() - 1) - self.time(0)
    }

    /// Returns the mean time between samples, s.
    pub fn spacing(&self) -> f64 {
        self.duration() / (self.count() - 1) as f64
    }

    /// Returns the times of the samples, s.
    pub fn times(&self) -> Vec<f64> {
        self.rows().map(|row| row[0]).collect()
    }

    /// Returns t/T of each sample, from 0 to 1.
    pub fn stations(&self) -> Vec<f64> {
        let (start, whole) = (self.time(0), self.duration());
        self.rows().map(|row| (row[0] - start) / whole).collect()
    }

    /// Returns samples of other values at the same times; `None` if there are fewer rows, or they are not valid
    /// samples.
    pub fn with_values(&self, values: impl IntoIterator<Item = Vec<f64>>) -> Option<Self> {
        let rows: Vec<Vec<f64>> = self.rows().zip(values).map(|(row, values)| [&row[..1], &values].concat()).collect();
        (rows.len() == self.count()).then(|| Self::new(&rows).ok()).flatten()
    }

    /// Returns about `count` of the samples, at least six, at nearly even index steps and including the first and the
    /// last.
    #[must_use]
    pub fn thinned(&self, count: usize) -> Self {
        let last = self.count() - 1;
        let spaces = last.min(count.max(MIN_SPLINE_SAMPLES) - 1);
        let rows: Vec<Vec<f64>> = (0..=spaces)
            .map(|i| {
                let i = i * last / spaces;
                self.values[i * self.width..(i + 1) * self.width].to_vec()
            })
            .collect();
        Self::new(&rows).unwrap_or_else(|_| self.clone())
    }

    /// Returns the samples smoothed without delay: the amplitude at the cut-off, Hz, is halved; see
    /// [`crate::curves::low_pass`].
    ///
    /// # Errors
    /// If the cut-off is not above 0 and below half of the mean rate.
    pub fn smoothed(&self, cut_off: f64) -> Result<Self, SamplesError> {
        let wrong = || SamplesError::CutOff { cut_off, nyquist: 0.5 / self.spacing() };
        let pass = LowPass::new(&self.times(), cut_off).ok_or_else(wrong)?;
        let column = |k: usize| pass.smooth(&self.rows().map(|row| row[k + 1]).collect::<Vec<_>>());
        let columns: Vec<Vec<f64>> = (0..self.columns()).map(column).collect();
        let row = |i: usize| columns.iter().map(|column| column[i]).collect();
        self.with_values((0..self.count()).map(row)).ok_or_else(wrong)
    }

    /// Returns the uncertainty of a column's second derivative, in its unit/s². It is estimated from the sixth
    /// differences of the samples, which grow with noise and coarse sampling.
    pub fn uncertainty(&self, column: usize) -> f64 {
        const BINOMIAL: [f64; 7] = [1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0];
        let y: Vec<f64> = self.rows().map(|row| row[column + 1]).collect();
        let sixth = |w: &[f64]| w.iter().zip(BINOMIAL).map(|(y, c)| c * y).sum::<f64>().abs();
        let mut sizes: Vec<f64> = y.windows(7).map(sixth).collect();
        sizes.sort_by(f64::total_cmp);
        // The median of |x| is 0.6745 σ, and 924 is the sum of the squared binomial coefficients.
        let sigma = sizes.get(sizes.len() / 2).map_or(0.0, |median| median / (0.6745 * 924f64.sqrt()));
        crate::curves::spline::NOISE_GAIN * sigma / (self.spacing() * self.spacing())
    }

    /// Returns the first and second derivatives by s = t/T at each sample, for each column.
    fn rates(&self) -> Vec<Vec<[f64; 2]>> {
        let whole = self.duration();
        let Some(knots) = Knots::new(&self.times()) else { return Vec::new() };
        let column = |k: usize| {
            let rates = knots.rates(|i| self.values(i)[k]);
            rates.into_iter().map(|[first, second]| [first * whole, second * whole * whole]).collect()
        };
        (0..self.columns()).map(column).collect()
    }

    /// Returns the path of the drives over s = t/T: each column is a drive angle, rad, to which `turn`, rad, is added.
    pub fn path(&self, turn: f64) -> Option<PathTable> {
        let rates = self.rates();
        let node = |i: usize| {
            let n = self.columns();
            let q = DriveAngles(PerDrive::from_fn(n, |k| self.values(i)[k] + turn));
            let [first, second] = [0, 1].map(|j| PerDrive::from_fn(n, |k| rates[k][i][j]));
            PathPoint { q, first, second }
        };
        (!rates.is_empty()).then(|| PathTable::new(self.stations(), (0..self.count()).map(node).collect())).flatten()
    }

    /// Returns the curve of the end effector over s = t/T from the two columns x and y, m.
    pub fn curve(&self) -> Option<Curve> {
        let rates = self.rates();
        let [x, y] = rates.as_slice() else { return None };
        let node = |i: usize| CurvePoint {
            p: self.point(i),
            first: Vector::new(x[i][0], y[i][0]),
            second: Vector::new(x[i][1], y[i][1]),
        };
        Curve::through(&self.stations(), &(0..self.count()).map(node).collect::<Vec<_>>())
    }

    /// Returns sample i as x + iy, m.
    pub fn point(&self, i: usize) -> Vector {
        let v = self.values(i);
        Vector::new(v[0], v.get(1).copied().unwrap_or(0.0))
    }
}
