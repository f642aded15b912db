//! [`BaseSpectrum`]: spectra of the force and moment on the base over a run, and their comparison with jitter limits.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use std::borrow::Cow;
use thiserror::Error;

use super::spectrum::{JitterLimit, JitterVerdict, Spectrum, SpectrumError, WindowFunction};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Refusal, base_loads};
use stillbase_settings::number::fixed;

/// One value for each component of the base wrench.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PerAxis<T> {
    /// Value for the dynamic f_Bx.
    pub force_x: T,
    /// Value for the dynamic f_By.
    pub force_y: T,
    /// Value for the net moment on the base: n_B less the torque of a reaction wheel.
    pub moment: T,
}

impl<T> PerAxis<T> {
    /// Applies a function to each component.
    pub fn map<'a, U>(&'a self, f: impl Fn(&'a T) -> U) -> PerAxis<U> {
        PerAxis { force_x: f(&self.force_x), force_y: f(&self.force_y), moment: f(&self.moment) }
    }

    /// Returns each component with its symbol and unit.
    pub fn named(&self) -> [(&'static str, &'static str, &T); 3] {
        [("f_Bx", "N", &self.force_x), ("f_By", "N", &self.force_y), ("n_B", "N m", &self.moment)]
    }
}

/// RMS values of one component, and its comparison with a limit.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct AxisStatistics {
    /// Unit of the samples and of both RMS values.
    pub unit: &'static str,
    /// RMS of the samples, unweighted.
    pub rms: f64,
    /// RMS of the samples weighted by the window: the final value of the cumulative RMS.
    pub weighted_rms: f64,
    /// Comparison with the limit, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit: Option<JitterVerdict>,
}

/// Spectra of the base wrench over a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "StatedSpectrum")]
pub struct BaseSpectrum {
    /// Name of the scenario.
    pub scenario: String,
    /// Window function of the spectra.
    pub window: WindowFunction,
    /// Number of samples.
    pub samples: usize,
    /// Time between two samples, s.
    pub step: f64,
    /// RMS values of each component, and their comparison with limits.
    pub axes: PerAxis<AxisStatistics>,
    /// Spectra of each component; all have the same frequencies.
    pub spectra: PerAxis<Spectrum>,
    /// The first audit that failed, in words.
    pub fault: Option<String>,
}

/// Reason for a missing spectrum or a missing comparison with a limit.
#[derive(Debug, Error)]
pub enum NoBaseSpectrum {
    /// The scenario cannot be run.
    #[error(transparent)]
    Run(#[from] Refusal),
    /// The samples have no spectrum.
    #[error(transparent)]
    Spectrum(#[from] SpectrumError),
    /// No frequency of the spectrum lies where the limit is defined.
    #[error(
        "a limit from {} to {} Hz contains no line of the spectrum, {} to {} Hz in steps of {}: want one that does",
        limit[0], limit[1], fixed(lines[0], 3), fixed(lines[1], 3), fixed(lines[0], 3)
    )]
    Beyond {
        /// Lowest and highest frequency of the limit, Hz.
        limit: [f64; 2],
        /// Lowest frequency of the spectrum above 0 Hz, and highest, Hz.
        lines: [f64; 2],
    },
}

impl BaseSpectrum {
    /// Runs a scenario to its end and returns the spectra of its base wrench, as long as `goes_on` returns `true`.
    ///
    /// # Errors
    /// Fails if the scenario cannot be run or `goes_on` ends it, or its samples have no spectrum.
    pub fn of(scenario: &Scenario, window: WindowFunction, goes_on: impl Fn() -> bool) -> Result<Self, NoBaseSpectrum> {
        let (course, fault) = base_loads(scenario, goes_on)?;
        let [force_x, force_y, moment] = &course;
        let of = |samples: &[f64]| Spectrum::of(samples, scenario.step, window);
        let spectra = PerAxis { force_x: of(force_x)?, force_y: of(force_y)?, moment: of(moment)? };
        // Unweighted, as a window emphasises the middle of the run.
        let rms = |samples: &[f64]| (samples.iter().map(|x| x * x).sum::<f64>() / samples.len() as f64).sqrt();
        let axis = |unit, samples: &[f64], spectrum: &Spectrum| AxisStatistics {
            unit,
            rms: rms(samples),
            weighted_rms: spectrum.rms(),
            limit: None,
        };
        Ok(Self {
            scenario: scenario.name.clone(),
            window,
            samples: moment.len(),
            step: scenario.step,
            axes: PerAxis {
                force_x: axis("N", force_x, &spectra.force_x),
                force_y: axis("N", force_y, &spectra.force_y),
                moment: axis("N m", moment, &spectra.moment),
            },
            spectra,
            fault: fault.map(|figure| figure.to_string()),
        })
    }

    /// Compares the spectra with limits on both forces, N/√Hz, and on the moment, N m/√Hz.
    ///
    /// # Errors
    /// Fails if no frequency of the spectrum lies where a limit is defined.
    pub fn judge(&mut self, force: Option<&JitterLimit>, moment: Option<&JitterLimit>) -> Result<(), NoBaseSpectrum> {
        let Self { axes, spectra, .. } = self;
        for (axis, spectrum, limit) in [
            (&mut axes.force_x, &spectra.force_x, force),
            (&mut axes.force_y, &spectra.force_y, force),
            (&mut axes.moment, &spectra.moment, moment),
        ] {
            let verdict = limit.map(|limit| spectrum.against(limit).ok_or_else(|| beyond(limit, spectrum)));
            axis.limit = verdict.transpose()?;
        }
        Ok(())
    }

    /// Returns all frequencies, Hz.
    pub fn frequency(&self) -> &[f64] {
        &self.spectra.moment.frequency
    }

    /// Returns the distance between two frequencies, Hz.
    pub fn resolution(&self) -> f64 {
        self.frequency().get(1).copied().unwrap_or(0.0)
    }
}

fn beyond(limit: &JitterLimit, spectrum: &Spectrum) -> NoBaseSpectrum {
    NoBaseSpectrum::Beyond {
        limit: [limit.points().first(), limit.points().last()].map(|point| point.map_or(0.0, |point| point.0)),
        lines: [spectrum.frequency.get(1), spectrum.frequency.last()].map(|f| f.copied().unwrap_or(0.0)),
    }
}

/// How a spectrum is serialised.
#[derive(JsonSchema, Serialize)]
struct StatedSpectrum {
    scenario: String,
    window: WindowFunction,
    samples: usize,
    step: f64,
    resolution: f64,
    axes: PerAxis<AxisStatistics>,
    frequency: Vec<f64>,
    density: PerAxis<Vec<f64>>,
    cumulative_rms: PerAxis<Vec<f64>>,
}

impl From<BaseSpectrum> for StatedSpectrum {
    fn from(of: BaseSpectrum) -> Self {
        Self {
            resolution: of.resolution(),
            frequency: of.frequency().to_vec(),
            density: of.spectra.map(|spectrum| spectrum.density.clone()),
            cumulative_rms: of.spectra.map(|spectrum| spectrum.cumulative_rms.clone()),
            scenario: of.scenario,
            window: of.window,
            samples: of.samples,
            step: of.step,
            axes: of.axes,
        }
    }
}

impl JsonSchema for BaseSpectrum {
    fn schema_name() -> Cow<'static, str> {
        StatedSpectrum::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        StatedSpectrum::json_schema(generator)
    }
}
