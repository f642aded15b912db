//! `stillbase spectrum`

use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use stillbase::files::{NewFile, WriteError};
use stillbase::session::felt;
use stillbase::study::spectrum::{JitterLimit, JitterVerdict, Spectrum, SpectrumError, Window};

use super::exit::say;
use super::failure::Failure;
use super::input::{DEFAULT_SCENARIO, Settings, scenario};
use super::output::{Format, Table, check_output, yes};
use super::simulate::trusted;
use stillbase::settings::number::{counted, fixed, shown};

/// Say at which frequencies a run shakes its base, and whether that keeps within jitter limits
///
/// The scenario is simulated; dynamic f_Bx and f_By and the whole n_B of every step are transformed. Amplitude spectral
/// densities are one-sided; the cumulative RMS adds them up from 0 Hz. It ends at the RMS of the samples without a
/// window; with one at the weighted RMS, in which samples count as the window weighs them: Hann counts the middle of
/// the record most.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase spectrum case-1
  stillbase spectrum case-1 --limit-moment 0.01                       N m/√Hz, at every frequency above 0
  stillbase spectrum case-1 --limit-moment 1:0.1,10:0.01,100:0.001    straight in log-log, none beyond its ends
  stillbase spectrum case-1 --window rectangular -o case-1.csv

The exit status is 0 whether limits are kept or not.

JSON keys: scenario, window, samples, step, resolution (Hz); axes {force_x, force_y, moment: {unit, rms, weighted_rms, limit?: {frequency,
density, limit, ratio, within}}}; frequency[]; density and cumulative_rms {force_x[], force_y[], moment[]}; file with -o.")]
pub struct SpectrumOf {
    /// A built-in scenario (case-1, spacecraft …; an unknown name lists them all) or a TOML file
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// The greatest density of n_B that will do, N m/√Hz: one number, or pairs FREQUENCY:LIMIT
    #[arg(long, value_name = "f:v,…")]
    limit_moment: Option<JitterLimit>,
    /// The greatest density of f_Bx and of f_By that will do, N/√Hz: one number, or pairs FREQUENCY:LIMIT
    #[arg(long, value_name = "f:v,…")]
    limit_force: Option<JitterLimit>,
    /// How samples are weighted: hann, or rectangular
    #[arg(long, value_name = "WINDOW", default_value = "hann")]
    window: Window,
    /// Write the spectra to this CSV file
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

/// One value for each axis.
#[derive(Serialize)]
struct Axes<T> {
    force_x: T,
    force_y: T,
    moment: T,
}

impl<T> Axes<T> {
    fn map<U>(&self, f: impl Fn(&T) -> U) -> Axes<U> {
        Axes { force_x: f(&self.force_x), force_y: f(&self.force_y), moment: f(&self.moment) }
    }

    fn named(&self) -> [(&'static str, &'static str, &T); 3] {
        [("f_Bx", "N", &self.force_x), ("f_By", "N", &self.force_y), ("n_B", "N m", &self.moment)]
    }
}

#[derive(Serialize)]
struct Axis {
    unit: &'static str,
    /// Of the samples, all alike.
    rms: f64,
    /// As the window weighs the samples: where the cumulative RMS ends.
    weighted_rms: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<JitterVerdict>,
}

#[derive(Serialize)]
struct Answer {
    scenario: String,
    window: Window,
    samples: usize,
    step: f64,
    resolution: f64,
    axes: Axes<Axis>,
    frequency: Vec<f64>,
    density: Axes<Vec<f64>>,
    cumulative_rms: Axes<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_failed: Option<String>,
}

impl From<SpectrumError> for Failure {
    fn from(e: SpectrumError) -> Self {
        Self::no_answer(e)
    }
}

impl SpectrumOf {
    /// Prints the spectra, and how they stand against limits.
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = scenario(&self.scenario, &self.settings)?;
        if let Some(file) = &self.output {
            check_output(file, self.force, &["csv"])?;
        }
        if scenario.base.wheel.is_some() {
            say(format!("note: {}: n_B is what the reaction wheel leaves of it for the base", scenario.name));
        }
        let ([force_x, force_y, moment], fault) = felt(&scenario).map_err(|e| Failure::from(e).of(&scenario.name))?;
        let course = Axes { force_x, force_y, moment };
        let of = |samples: &[f64]| Spectrum::of(samples, scenario.step, self.window);
        let spectra =
            Axes { force_x: of(&course.force_x)?, force_y: of(&course.force_y)?, moment: of(&course.moment)? };
        // Of the run itself: a window weighs its middle.
        let rms = |samples: &[f64]| (samples.iter().map(|x| x * x).sum::<f64>() / samples.len() as f64).sqrt();
        let axis = |unit, samples: &[f64], spectrum: &Spectrum, limit: &Option<JitterLimit>| {
            let verdict = limit.as_ref().map(|limit| spectrum.against(limit).ok_or_else(|| beyond(limit, spectrum)));
            let (rms, weighted_rms) = (rms(samples), spectrum.rms());
            Ok::<_, Failure>(Axis { unit, rms, weighted_rms, limit: verdict.transpose()? })
        };
        if let Some(file) = &self.output {
            write(file, self.force, &spectra)?;
            say(format!("wrote {}", file.display()));
        }
        let frequency = spectra.moment.frequency.clone();
        let answer = Answer {
            scenario: scenario.name.clone(),
            window: self.window,
            samples: course.moment.len(),
            step: scenario.step,
            resolution: frequency.get(1).copied().unwrap_or(0.0),
            axes: Axes {
                force_x: axis("N", &course.force_x, &spectra.force_x, &self.limit_force)?,
                force_y: axis("N", &course.force_y, &spectra.force_y, &self.limit_force)?,
                moment: axis("N m", &course.moment, &spectra.moment, &self.limit_moment)?,
            },
            frequency,
            density: spectra.map(|s| s.density.clone()),
            cumulative_rms: spectra.map(|s| s.cumulative_rms.clone()),
            file: self.output.as_ref().map(|file| file.display().to_string()),
            audit_failed: fault.map(|lamp| lamp.to_string()),
        };
        self.format.print(&answer, |answer| text(answer, &spectra))?;
        trusted(&answer.scenario, answer.audit_failed)
    }
}

fn beyond(limit: &JitterLimit, spectrum: &Spectrum) -> Failure {
    let ends = [limit.points().first(), limit.points().last()].map(|p| p.map_or(0.0, |p| p.0));
    let [first, last] = [spectrum.frequency.get(1), spectrum.frequency.last()].map(|f| f.copied().unwrap_or(0.0));
    Failure::wrong_input(format!(
        "a limit from {} to {} Hz holds at no line of the spectrum, {} to {} Hz by {}: want one that does",
        ends[0],
        ends[1],
        fixed(first, 3),
        fixed(last, 3),
        fixed(first, 3),
    ))
}

/// The frequency below which a share of the power lies, Hz.
fn below(spectrum: &Spectrum, share: f64) -> f64 {
    let wanted = share.sqrt() * spectrum.rms();
    let at = spectrum.cumulative_rms.iter().position(|r| *r >= wanted).unwrap_or(0);
    spectrum.frequency.get(at).copied().unwrap_or(0.0)
}

fn text(answer: &Answer, spectra: &Axes<Spectrum>) -> String {
    let window = match answer.window {
        Window::Hann => "Hann window",
        Window::Rectangular => "no window",
    };
    let mut table = Table::new([
        "axis",
        "unit",
        "RMS",
        "weighted RMS",
        "greatest density /√Hz",
        "at Hz",
        "half the power below Hz",
        "99 % below Hz",
    ])
    .with_words(1);
    for ((name, unit, spectrum), (_, _, axis)) in spectra.named().into_iter().zip(answer.axes.named()) {
        let lines = spectrum.frequency.iter().zip(&spectrum.density);
        let (at, most) = lines.max_by(|a, b| a.1.total_cmp(b.1)).map_or((0.0, 0.0), |(f, d)| (*f, *d));
        let frequencies = [at, below(spectrum, 0.5), below(spectrum, 0.99)].map(|f| fixed(f, 3));
        let sizes = [axis.rms, axis.weighted_rms, most].map(|x| shown(x, 6));
        let row = [name.to_owned(), unit.to_owned()].into_iter().chain(sizes);
        table.row(row.chain(frequencies));
    }
    let (samples, step, resolution) = (counted(answer.samples, "sample"), answer.step, fixed(answer.resolution, 3));
    let head = format!("{} · {samples} by {step} s, {window}, lines by {resolution} Hz", answer.scenario);
    let mut verdicts =
        Table::new(["limit", "unit", "kept", "worst at Hz", "density", "limit", "density/limit"]).with_words(1);
    let mut any = false;
    for (name, unit, axis) in answer.axes.named() {
        let Some(v) = &axis.limit else { continue };
        let numbers = [fixed(v.frequency, 3), shown(v.density, 6), shown(v.limit, 6), shown(v.ratio, 3)];
        let row = [name.to_owned(), format!("{unit}/√Hz"), yes(v.within).to_owned()];
        verdicts.row(row.into_iter().chain(numbers));
        any = true;
    }
    let why = match answer.window {
        Window::Hann => {
            "Frequencies and the cumulative RMS are of the samples as the window weighs them, its middle most: it ends at the \
             weighted RMS. --window rectangular weighs all alike.\n"
        }
        Window::Rectangular => "",
    };
    if any { format!("{head}\n\n{table}{why}\n{verdicts}") } else { format!("{head}\n\n{table}{why}") }
}

fn write(file: &Path, force: bool, spectra: &Axes<Spectrum>) -> Result<(), Failure> {
    let failed = |e: csv::Error| match e.into_kind() {
        csv::ErrorKind::Io(source) => WriteError::Failed { file: file.into(), source }.into(),
        other => Failure::wrong_input(format!("{}: {other:?}", file.display())),
    };
    let mut csv = csv::Writer::from_writer(NewFile::create(file, force)?);
    let heads = spectra.named().map(|(name, unit, _)| [format!("{name} {unit}/√Hz"), format!("{name} RMS {unit}")]);
    let head = ["frequency Hz".to_owned()].into_iter().chain(heads.into_iter().flatten());
    csv.write_record(head).map_err(failed)?;
    for (m, frequency) in spectra.moment.frequency.iter().enumerate() {
        let columns = spectra.named().map(|(_, _, s)| [s.density[m], s.cumulative_rms[m]]);
        csv.serialize((frequency, columns)).map_err(failed)?;
    }
    let out = csv.into_inner().map_err(|e| failed(e.into_error().into()))?;
    Ok(out.finish()?)
}
