//! Spectra of the base wrench: amplitude spectral density, cumulative RMS, jitter limits.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | x_n, h | samples, and the time between two | unit of the signal; s |
//! | w_n | window; Hann: ½ (1 − cos(2π n/N)) | 1 |
//! | X_m | Σ_n w_n x_n e^{−2πi nm/N} | unit of the signal |
//! | f_m | m/(N h), m = 0 … N/2 | Hz |
//! | P_m | one-sided power spectral density, c_m h \|X_m\|² / Σ w_n²; c = 1 at 0 and at N/2, else 2 | unit²/Hz |
//! | A_m | amplitude spectral density √P_m | unit/√Hz |
//! | r_m | cumulative RMS, √(Σ_{i ≤ m} P_i / (N h)) | unit |
//!
//! By Parseval's theorem the last r is the window-weighted RMS, √(Σ (w x)² / Σ w²). Without a window it is the RMS of
//! the samples; with the Hann window, the middle of the record has the largest weight. The mean is not removed: it
//! appears at f = 0 and, with the Hann window, at the next frequency too. A single motion is not a stationary signal:
//! its density falls as the record grows longer. So densities are comparable only between records of one length.
//!
//! # Source
//! P. D. Welch, *The use of fast Fourier transform for the estimation of power spectra* (1967), with one segment;
//! F. J. Harris, *On the use of windows for harmonic analysis with the discrete Fourier transform* (1978).

use std::str::FromStr;

use realfft::RealFftPlanner;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_settings::number::counted;
use thiserror::Error;

/// Window function of the samples before the transform.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WindowFunction {
    /// Hann window ½ (1 − cos(2π n/N)), periodic: little leakage to distant frequencies.
    #[default]
    Hann,
    /// No window: all samples have the same weight. Suits a motion from rest to rest that lies entirely within the
    /// record.
    Rectangular,
}

impl WindowFunction {
    fn weight(self, n: usize, count: usize) -> f64 {
        match self {
            Self::Hann => 0.5 * (1.0 - (std::f64::consts::TAU * n as f64 / count as f64).cos()),
            Self::Rectangular => 1.0,
        }
    }
}

impl FromStr for WindowFunction {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "hann" => Ok(Self::Hann),
            "rectangular" => Ok(Self::Rectangular),
            _ => Err("want hann or rectangular".into()),
        }
    }
}

/// Reason that there is no spectrum.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SpectrumError {
    /// Too few samples to resolve frequencies.
    #[error(
        "no spectrum comes of {}: want at least {least}, with a longer record or a smaller step",
        counted(count, "sample")
    )]
    TooFew {
        /// Number of samples given.
        count: usize,
        /// Minimum number of samples.
        least: usize,
    },
    /// A sample is not finite.
    #[error("sample {index} is not finite: want a run that does not diverge")]
    NotFinite {
        /// Index of the sample, from 0.
        index: usize,
    },
    /// The time between two samples is not above 0.
    #[error("a step of {step} s: want one above 0 s")]
    Step {
        /// Time between two samples, s.
        step: f64,
    },
}

/// Minimum number of samples of a spectrum.
pub const MIN_SPECTRUM_SAMPLES: usize = 8;

/// A one-sided spectrum of one signal.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Spectrum {
    /// f_m, Hz.
    pub frequency: Vec<f64>,
    /// A_m, unit of the signal/√Hz.
    pub density: Vec<f64>,
    /// r_m, unit of the signal.
    pub cumulative_rms: Vec<f64>,
}

impl Spectrum {
    /// Returns the spectrum of samples that are `step` seconds apart.
    ///
    /// # Errors
    /// Fails if there are fewer than [`MIN_SPECTRUM_SAMPLES`] samples, one is not finite, or the step is not above 0.
    pub fn of(samples: &[f64], step: f64, window: WindowFunction) -> Result<Self, SpectrumError> {
        let count = samples.len();
        if count < MIN_SPECTRUM_SAMPLES {
            return Err(SpectrumError::TooFew { count, least: MIN_SPECTRUM_SAMPLES });
        }
        if let Some(index) = samples.iter().position(|x| !x.is_finite()) {
            return Err(SpectrumError::NotFinite { index });
        }
        if !(step > 0.0 && step.is_finite()) {
            return Err(SpectrumError::Step { step });
        }
        let weights: Vec<f64> = (0..count).map(|n| window.weight(n, count)).collect();
        let mut weighted: Vec<f64> = samples.iter().zip(&weights).map(|(x, w)| x * w).collect();
        let transform = RealFftPlanner::new().plan_fft_forward(count);
        let mut lines = transform.make_output_vec();
        // Unreachable: both arrays have the lengths that the transform needs.
        if transform.process(&mut weighted, &mut lines).is_err() {
            return Err(SpectrumError::TooFew { count, least: MIN_SPECTRUM_SAMPLES });
        }
        let power: f64 = weights.iter().map(|w| w * w).sum();
        let resolution = 1.0 / (count as f64 * step);
        let mut sum = 0.0;
        let mut spectrum = Self { frequency: Vec::new(), density: Vec::new(), cumulative_rms: Vec::new() };
        for (m, line) in lines.iter().enumerate() {
            let both_sides = if m == 0 || 2 * m == count { 1.0 } else { 2.0 };
            let p = both_sides * step * line.norm_sqr() / power;
            sum += p * resolution;
            spectrum.frequency.push(m as f64 * resolution);
            spectrum.density.push(p.sqrt());
            spectrum.cumulative_rms.push(sum.sqrt());
        }
        Ok(spectrum)
    }

    /// Returns the window-weighted RMS of the whole signal.
    pub fn rms(&self) -> f64 {
        self.cumulative_rms.last().copied().unwrap_or(0.0)
    }

    /// Returns the frequency below which a fraction of the power lies, Hz.
    pub fn below(&self, share: f64) -> f64 {
        let wanted = share.sqrt() * self.rms();
        let at = self.cumulative_rms.iter().position(|r| *r >= wanted).unwrap_or(0);
        self.frequency.get(at).copied().unwrap_or(0.0)
    }

    /// Returns the frequency with the largest density, Hz, and that density, unit of the signal/√Hz.
    pub fn greatest(&self) -> [f64; 2] {
        let lines = self.frequency.iter().zip(&self.density);
        lines.max_by(|a, b| a.1.total_cmp(b.1)).map_or([0.0; 2], |(frequency, density)| [*frequency, *density])
    }

    /// Compares the density with a limit; `None` if no frequency above 0 Hz lies where the limit is defined.
    pub fn against(&self, limit: &JitterLimit) -> Option<JitterVerdict> {
        let lines = self.frequency.iter().zip(&self.density).skip(1);
        let ratios = lines.filter_map(|(f, density)| {
            let limit = limit.at(*f)?;
            Some(JitterVerdict {
                frequency: *f,
                density: *density,
                limit,
                ratio: density / limit,
                within: *density <= limit,
            })
        });
        ratios.max_by(|a, b| a.ratio.total_cmp(&b.ratio))
    }
}

/// Comparison of a spectrum with its limit, at the frequency with the largest ratio.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct JitterVerdict {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Density A at this frequency, unit/√Hz.
    pub density: f64,
    /// Limit at this frequency, unit/√Hz.
    pub limit: f64,
    /// Density divided by limit.
    pub ratio: f64,
    /// Whether the density is within the limit at every frequency above 0 Hz where the limit is defined.
    pub within: bool,
}

/// A jitter limit: upper bound on the amplitude spectral density, by frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct JitterLimit {
    /// Frequency, Hz, ascending, and limit, unit/√Hz.
    points: Vec<(f64, f64)>,
}

impl JitterLimit {
    /// Returns the limit at a frequency, Hz, interpolated linearly in the logarithms of both. One point is a limit at
    /// every frequency; several points set no limit below the first or above the last.
    pub fn at(&self, frequency: f64) -> Option<f64> {
        if let [(_, only)] = self.points[..] {
            return Some(only);
        }
        let next = self.points.partition_point(|(f, _)| *f < frequency);
        let &(f1, v1) = self.points.get(next)?;
        if f1 == frequency {
            return Some(v1);
        }
        let &(f0, v0) = self.points.get(next.checked_sub(1)?)?;
        let share = (frequency / f0).ln() / (f1 / f0).ln();
        Some(v0 * (v1 / v0).powf(share))
    }

    /// Returns frequencies, Hz, and limits, unit/√Hz, of the points; a single point applies at every frequency.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }
}

impl FromStr for JitterLimit {
    type Err = String;

    /// Reads one number for all frequencies, or pairs `f:v,f:v` with ascending f.
    fn from_str(text: &str) -> Result<Self, String> {
        const WANT: &str = "want one number above 0, or pairs FREQUENCY:LIMIT with rising frequencies in Hz, all above \
                            0, such as 1:0.01,10:0.001";
        let positive = |t: &str| t.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0).ok_or(WANT);
        if !text.contains(':') {
            return Ok(Self { points: vec![(1.0, positive(text)?)] });
        }
        let pair = |pair: &str| {
            let (f, v) = pair.split_once(':').ok_or(WANT)?;
            Ok::<_, &str>((positive(f)?, positive(v)?))
        };
        let points = text.split(',').map(pair).collect::<Result<Vec<_>, _>>()?;
        match points.windows(2).all(|w| w[0].0 < w[1].0) && points.len() > 1 {
            true => Ok(Self { points }),
            false => Err(WANT.into()),
        }
    }
}
