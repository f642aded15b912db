//! `stillbase spectrum`

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_session::scenario::Scenario;
use stillbase_study::base_spectrum::{BaseSpectrum, NoBaseSpectrum};
use stillbase_study::spectrum::{JitterLimit, WindowFunction};

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::input::{DEFAULT_SCENARIO, Settings, scenario};
use super::output::{Format, TextTable, yes};
use super::progress::goes_on;
use super::rows::{RowTarget, Rows};
use super::simulate::require_audit;
use super::strict::Strict;
use stillbase_settings::number::{counted, fixed, fixed_or_scientific};
use stillbase_simulation::plant::BaseKind;

/// Compute the spectra of the base reactions of a run, and compare them with jitter limits
///
/// The scenario is simulated; dynamic f_Bx and f_By and the total n_B of every step are transformed. Amplitude spectral
/// densities are one-sided; the cumulative RMS adds up their power from 0 Hz. With a rectangular window, its last value
/// is the RMS of the samples. With a Hann window, it is the RMS weighted by the window, which emphasises the middle of
/// the record.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase spectrum case-1
  stillbase spectrum case-1 --limit-moment 0.01                       N m/√Hz, at every frequency above 0
  stillbase spectrum case-1 --limit-moment 1:0.1,10:0.01,100:0.001    straight in log-log, none beyond its ends
  stillbase spectrum case-1 --window rectangular -o case-1.csv

The exit status is 0 whether limits are kept or not, unless --strict is given.

JSON keys: scenario, window, samples, step, resolution (Hz); axes {force_x, force_y, moment: {unit, rms, weighted_rms, limit?: {frequency,
density, limit, ratio, within}}}; frequency[]; density and cumulative_rms {force_x[], force_y[], moment[]}; file with -o.")]
pub struct SpectrumArguments {
    /// A built-in scenario (case-1, spacecraft …; an unknown name lists them all) or a TOML file
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// Maximum permitted density of n_B, N m/√Hz: one number, or pairs FREQUENCY:LIMIT
    #[arg(long, value_name = "f:v,…")]
    limit_moment: Option<JitterLimit>,
    /// Maximum permitted density of f_Bx and of f_By, N/√Hz: one number, or pairs FREQUENCY:LIMIT
    #[arg(long, value_name = "f:v,…")]
    limit_force: Option<JitterLimit>,
    /// Window that weights the samples: hann or rectangular
    #[arg(long, value_name = "WINDOW", default_value = "hann")]
    window: WindowFunction,
    /// Write the spectra to this file, .csv or .parquet
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    form: FileForm,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    #[serde(flatten)]
    of: BaseSpectrum,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_failed: Option<String>,
}

/// Converts an error into a failure; the failure of a run names its scenario.
fn failed(why: NoBaseSpectrum, scenario: &Scenario) -> Failure {
    match why {
        NoBaseSpectrum::Run(why) => Failure::refused(scenario, why),
        NoBaseSpectrum::Spectrum(why) => Failure::no_answer(why),
        beyond @ NoBaseSpectrum::Beyond { .. } => Failure::wrong_input(beyond),
    }
}

impl SpectrumArguments {
    /// Prints the spectra and their comparison with the limits.
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = scenario(&self.scenario, &self.settings)?;
        let to = RowTarget::wanted(&self.format, &self.form, self.output.as_deref(), self.force)?;
        if scenario.base.wheel.is_some() {
            print_message(format!("note: {}: n_B is the moment minus that of the reaction wheel", scenario.name));
        }
        if scenario.base.kind == BaseKind::Free {
            print_message(format!(
                "note: {}: n_B is the moment that turns the free base, about its own centre of mass",
                scenario.name
            ));
        }
        let failed = |why| failed(why, &scenario);
        let mut of = BaseSpectrum::of(&scenario, self.window, goes_on).map_err(failed)?;
        if let Some(to) = &to {
            write(to, &of)?;
        }
        of.judge(self.limit_force.as_ref(), self.limit_moment.as_ref()).map_err(failed)?;
        let file = self.output.as_ref().map(|file| file.display().to_string());
        let answer = Answer { file, audit_failed: of.fault.clone(), of };
        self.format.print(&answer, |answer| text(&answer.of))?;
        let limits =
            answer.of.axes.named().into_iter().filter_map(|(name, _, axis)| Some((name, axis.limit.as_ref()?)));
        let past = limits.filter(|(_, limit)| !limit.within);
        let faults: Vec<String> =
            past.map(|(name, _)| format!("{}: {name} past its limit", answer.of.scenario)).collect();
        require_audit(&answer.of.scenario, answer.audit_failed)?;
        self.strict.require(faults)
    }
}

fn text(answer: &BaseSpectrum) -> String {
    let window = match answer.window {
        WindowFunction::Hann => "Hann window",
        WindowFunction::Rectangular => "no window",
    };
    let mut table = TextTable::new([
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
    for ((name, unit, spectrum), (_, _, axis)) in answer.spectra.named().into_iter().zip(answer.axes.named()) {
        let [at, most] = spectrum.greatest();
        let frequencies = [at, spectrum.below(0.5), spectrum.below(0.99)].map(|f| fixed(f, 3));
        let sizes = [axis.rms, axis.weighted_rms, most].map(|x| fixed_or_scientific(x, 6));
        let row = [name.to_owned(), unit.to_owned()].into_iter().chain(sizes);
        table.row(row.chain(frequencies));
    }
    let (samples, step, resolution) = (counted(answer.samples, "sample"), answer.step, fixed(answer.resolution(), 3));
    let head = format!("{} · {samples} by {step} s, {window}, lines by {resolution} Hz", answer.scenario);
    let mut verdicts =
        TextTable::new(["limit", "unit", "kept", "worst at Hz", "density", "limit", "density/limit"]).with_words(1);
    let mut any = false;
    for (name, unit, axis) in answer.axes.named() {
        let Some(v) = &axis.limit else { continue };
        let numbers = [
            fixed(v.frequency, 3),
            fixed_or_scientific(v.density, 6),
            fixed_or_scientific(v.limit, 6),
            fixed_or_scientific(v.ratio, 3),
        ];
        let row = [name.to_owned(), format!("{unit}/√Hz"), yes(v.within).to_owned()];
        verdicts.row(row.into_iter().chain(numbers));
        any = true;
    }
    let why = match answer.window {
        WindowFunction::Hann => {
            "Frequencies and the cumulative RMS are those of the windowed samples; the latter ends at the \
             weighted RMS. --window rectangular weights all samples equally.\n"
        }
        WindowFunction::Rectangular => "",
    };
    if any { format!("{head}\n\n{table}{why}\n{verdicts}") } else { format!("{head}\n\n{table}{why}") }
}

fn write(to: &RowTarget, of: &BaseSpectrum) -> Result<(), Failure> {
    let names = ["force_x", "force_y", "moment"];
    let named = of.spectra.named();
    let heads = names
        .iter()
        .zip(&named)
        .flat_map(|(name, (_, unit, _))| [format!("{name} {unit}/√Hz"), format!("{name} cumulative_rms {unit}")]);
    // Older names stay beside newer ones until version 0.3.
    let older = named.iter().flat_map(|(name, unit, _)| [format!("{name} {unit}/√Hz"), format!("{name} RMS {unit}")]);
    let head: Vec<String> = ["frequency Hz".to_owned()].into_iter().chain(heads).chain(older).collect();
    let mut rows = Rows::begin(to, &head)?;
    for (m, frequency) in of.frequency().iter().enumerate() {
        let columns = named.map(|(_, _, s)| [s.density[m], s.cumulative_rms[m]]);
        let columns = columns.into_iter().flatten();
        rows.row([*frequency].into_iter().chain(columns.clone()).chain(columns))?;
    }
    rows.finish()
}
