//! `stillbase headless`

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_recording::{Options, Pictures, RecordError, Recording, RecordingProgress, record};
#[cfg(feature = "stream")]
use stillbase_recording::{VIEWER_URL, Viewer, stream};
use stillbase_session::scenario::Scenario;
use stillbase_session::verdict::Statements;
use stillbase_settings::text::plain;

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::in_process::is_in_process;
use super::input::{Settings, no_use, scenario_of_any};
use super::output::{Format, TextTable, say_written};
use super::progress::Progress;
use super::simulate::require_audit;
use super::simulate_assembly::SharedOutcome;
use super::size::size;
use super::strict::{Strict, run_faults};
use stillbase_settings::number::fixed;

/// Examples for the help, the second part where there is a viewer to stream to.
const EXAMPLES: [&str; 2] = [
    "\
Examples:
  stillbase headless -o cases.rrd                             the paper's three cases
  stillbase headless case-1 my.toml -o both.rrd --fps 30      with pictures
  stillbase headless case-3 -o loaded.rrd --set payload.mass=0.1",
    "
  stillbase headless case-3 --spawn                           opens the viewer",
];

/// Simulate scenarios without a window and record them for the Rerun viewer
#[derive(Args)]
#[command(after_help = EXAMPLES[..1 + usize::from(cfg!(feature = "stream"))].concat())]
pub struct HeadlessArguments {
    /// Built-in scenarios (case-1, spacecraft …; an unknown name lists them all) or TOML files; default: the three
    /// cases
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// The recording to write; `-` is standard output
    #[arg(short, long, value_name = "FILE.rrd")]
    #[cfg_attr(feature = "stream", arg(required_unless_present_any = ["connect", "spawn"]))]
    #[cfg_attr(not(feature = "stream"), arg(required = true))]
    output: Option<PathBuf>,
    /// Stream to a viewer that runs, instead of writing a file; default: the one on this computer
    #[cfg(feature = "stream")]
    #[arg(
        long,
        value_name = "URL",
        num_args = 0..=1,
        default_missing_value = VIEWER_URL,
        conflicts_with_all = ["output", "spawn"],
    )]
    connect: Option<String>,
    /// Start the viewer, the program `rerun` on the path, and stream to it
    #[cfg(feature = "stream")]
    #[arg(long, conflicts_with = "output")]
    spawn: bool,
    /// Record N offscreen pictures per simulated second, if a graphics adapter exists
    #[arg(long, value_name = "N", value_parser = frames_per_second)]
    fps: Option<f64>,
    /// Width and height of the pictures, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x800", requires = "fps", value_parser = size)]
    size: [u32; 2],
    /// Show the forces on the pins in the pictures
    #[arg(long, requires = "fps")]
    pin_forces: bool,
    /// Record the signals at every step, not at a fixed rate: at least 100 rows a second and 500 in all
    #[arg(long)]
    every_step: bool,
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

fn frames_per_second(text: &str) -> Result<f64, String> {
    let fps = text.parse().ok().filter(|fps| *fps > 0.0 && *fps <= 1000.0);
    fps.ok_or_else(|| "want pictures per simulated second, above 0 and at most 1000".into())
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    recordings: Vec<Row>,
}

#[derive(JsonSchema, Serialize)]
struct Row {
    scenario: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    /// Address of the viewer, if it was streamed.
    #[serde(skip_serializing_if = "Option::is_none")]
    viewer: Option<String>,
    steps: u64,
    peak_torque: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_base_force: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_base_moment: Option<f64>,
    /// Of an assembly, what all its blocks did to their base.
    #[serde(flatten)]
    shared: Option<SharedOutcome>,
    /// Peak moment that reaches the base after the reaction wheel, N m, if there is a wheel.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_felt_moment: Option<f64>,
    /// The same, under an older name that version 0.3 drops.
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_moment_past_wheel: Option<f64>,
    reactionless: bool,
    /// Whether a free base keeps its attitude.
    #[serde(skip_serializing_if = "Option::is_none")]
    keeps_attitude: Option<bool>,
    /// Drive limit exceeded by the largest factor, and this factor, if any limit is exceeded.
    #[serde(skip_serializing_if = "Option::is_none")]
    over: Option<(String, f64)>,
    #[serde(skip_serializing_if = "Option::is_none")]
    audit_failed: Option<String>,
    verdict: String,
    /// Statements on machine, plan and run.
    statements: Statements,
    #[serde(skip)]
    faults: Vec<String>,
    #[serde(skip)]
    answer: String,
    #[serde(skip)]
    remarks: Vec<String>,
}

impl From<Recording> for Row {
    fn from(recording: Recording) -> Self {
        let shared = recording.verdict.shared.as_ref().map(|shared| SharedOutcome::of(recording.steps, shared));
        let faults = match &shared {
            Some(shared) => shared.fault().map(|why| format!("{}: {why}", recording.scenario)).into_iter().collect(),
            None => run_faults(&recording.scenario, &recording.verdict),
        };
        // What one block does alone, the others may cancel.
        let own = |peak: f64| shared.is_none().then_some(peak);
        Self {
            faults,
            scenario: recording.scenario,
            file: recording.file.map(|file| file.display().to_string()),
            viewer: None,
            steps: recording.steps,
            peak_torque: recording.peak_torque,
            peak_base_force: own(recording.peak_base_force),
            peak_base_moment: own(recording.peak_base_moment),
            peak_felt_moment: recording.verdict.past_wheel,
            peak_moment_past_wheel: recording.verdict.past_wheel,
            reactionless: recording.reactionless,
            keeps_attitude: recording.verdict.attitude.map(|attitude| attitude.is_kept()),
            over: recording.verdict.exceeded_limit.map(|(limit, factor)| (limit.to_string(), factor)),
            audit_failed: recording.verdict.fault.as_ref().map(ToString::to_string),
            verdict: match &shared {
                Some(shared) => shared.sentence.clone(),
                None => recording.verdict.sentence(),
            },
            shared,
            statements: recording.statements,
            answer: recording.verdict.answer(),
            remarks: recording.verdict.remarks().into_iter().map(|r| r.long).collect(),
        }
    }
}

impl HeadlessArguments {
    /// Records the scenarios and prints the peaks of each.
    pub fn run(&self) -> Result<(), Failure> {
        let scenarios = self.scenarios()?;
        let to = self.target()?;
        let [width, height] = self.size;
        let pictures = self.fps.map(|fps| Pictures { fps, width, height, pin_forces: self.pin_forces });
        let options = Options { pictures, every_step: self.every_step, force: self.force };
        let recordings = record_with_bar(&scenarios, &to, &options)?;
        let viewer = to.viewer_url();
        let row = |recording| Row { viewer: viewer.clone(), ..Row::from(recording) };
        let answer = Answer { recordings: recordings.into_iter().map(row).collect() };
        match &to {
            Target::File(file) => say_written(file),
            #[cfg(feature = "stream")]
            Target::Viewer(viewer) => print_message(format!("sent to the viewer at {}", viewer.url())),
        }
        // A program that asks gets this in the answer.
        for row in answer.recordings.iter().filter(|_| !is_in_process()) {
            let said = if row.shared.is_some() { row.verdict.clone() } else { row.statements.line() };
            print_message(format!("{}: {said}", row.scenario));
            row.remarks.iter().for_each(|remark| print_message(format!("{}: {remark}", row.scenario)));
        }
        self.format.print(&answer, table)?;
        answer.recordings.iter().try_for_each(|row| require_audit(&row.scenario, row.audit_failed.clone()))?;
        self.strict.require(answer.recordings.into_iter().flat_map(|row| row.faults))
    }

    /// Returns where the recording goes.
    fn target(&self) -> Result<Target, Failure> {
        match &self.output {
            Some(file) => {
                self.form.check(&self.format, Some(file), self.force, &["rrd"])?;
                Ok(Target::File(file.clone()))
            }
            None if self.form.is_given() => Err(no_use("--format", "-o - as well")),
            None => self.viewer(),
        }
    }

    /// Returns the viewer to stream to.
    #[cfg(feature = "stream")]
    fn viewer(&self) -> Result<Target, Failure> {
        let viewer = self.connect.as_deref().map_or_else(Viewer::started, Viewer::at);
        viewer.map(Target::Viewer).map_err(Failure::wrong_input)
    }

    /// Refuses to go on without a file.
    #[cfg(not(feature = "stream"))]
    fn viewer(&self) -> Result<Target, Failure> {
        Err(Failure::wrong_input("no file: want -o FILE.rrd"))
    }

    fn scenarios(&self) -> Result<Vec<Scenario>, Failure> {
        let builtin = Scenario::cases().map(String::from).collect::<Vec<_>>();
        let names = if self.scenarios.is_empty() { &builtin[..] } else { &self.scenarios };
        let mut scenarios: Vec<Scenario> = Vec::with_capacity(names.len());
        for name in names {
            let next = scenario_of_any(name, &self.settings)?;
            if next.assembly.is_some() && names.len() > 1 {
                return Err(Failure::wrong_input(format!("{name} is of an assembly: want it recorded by itself")));
            }
            if scenarios.iter().any(|s| s.name == next.name) {
                let why = format!("a second scenario called {:?}: want different names in one recording", next.name);
                return Err(Failure::wrong_input(why).with_context(name));
            }
            scenarios.push(next);
        }
        Ok(scenarios)
    }
}

/// Where a recording goes.
pub enum Target {
    /// To a file.
    File(PathBuf),
    /// To a viewer.
    #[cfg(feature = "stream")]
    Viewer(Viewer),
}

impl Target {
    /// Returns the address of the viewer, if it is one.
    fn viewer_url(&self) -> Option<String> {
        match self {
            Self::File(_) => None,
            #[cfg(feature = "stream")]
            Self::Viewer(viewer) => Some(viewer.url()),
        }
    }
}

/// Returns options of a recording without pictures that replaces no file.
pub fn unpictured() -> Options {
    Options::default()
}

/// Records with a progress bar on standard error, if that is a terminal.
pub fn record_with_bar(scenarios: &[Scenario], to: &Target, options: &Options) -> Result<Vec<Recording>, Failure> {
    let progress = Progress::of_length(0);
    let bar = progress.bar();
    let mut report = |done: RecordingProgress| {
        let what = plain(done.what);
        if bar.message() != what {
            bar.set_message(what.into_owned());
        }
        bar.set_length(done.total);
        bar.set_position(done.done);
        progress.goes_on()
    };
    let recordings = match to {
        Target::File(file) => record(scenarios, file, options, &mut report),
        #[cfg(feature = "stream")]
        Target::Viewer(viewer) => stream(scenarios, viewer, options, &mut report),
    };
    progress.finish();
    let recordings = recordings.map_err(|error| failed(error, scenarios))?;
    let notes: Vec<&String> = recordings.iter().flat_map(|r| &r.notes).collect();
    let is_first = |i: &usize| !notes[..*i].contains(&notes[*i]);
    (0..notes.len()).filter(is_first).for_each(|i| print_message(notes[i]));
    Ok(recordings)
}

/// Returns the failure of a recording of scenarios.
fn failed(error: RecordError, scenarios: &[Scenario]) -> Failure {
    match error {
        RecordError::Refused { scenario, refusal } => match scenarios.iter().find(|own| own.name == scenario) {
            Some(scenario) => Failure::refused(scenario, refusal),
            None => Failure::from(refusal).with_context(scenario),
        },
        RecordError::Write(e) => e.into(),
        RecordError::Stopped => Failure::Stopped,
        other => Failure::wrong_input(other),
    }
}

fn table(answer: &Answer) -> String {
    let drives = answer.recordings.iter().map(|r| r.peak_torque.len()).max().unwrap_or(0);
    let torques = (1..=drives).map(|k| format!("peak |τ_{k}| N m"));
    // The moment after a reaction wheel is a different quantity from the moment that the arm transmits.
    let wheels = answer.recordings.iter().any(|r| r.peak_felt_moment.is_some());
    let past = wheels.then(|| "peak past the wheel N m".to_owned());
    let rest = ["peak |f_B| N", "peak |n_B| N m"].map(String::from).into_iter().chain(past);
    let heads = ["scenario", "steps"].map(String::from).into_iter().chain(torques).chain(rest);
    let mut table = TextTable::new(heads.chain(["reactionless".into()]));
    let of_machines: Vec<&Row> = answer.recordings.iter().filter(|row| row.shared.is_none()).collect();
    if of_machines.is_empty() {
        return String::new();
    }
    for r in of_machines {
        let torques = (0..drives).map(|k| r.peak_torque.get(k).map_or_else(String::new, |t| fixed(*t, 6)));
        let past = wheels.then(|| r.peak_felt_moment.map_or_else(|| "–".into(), |n| fixed(n, 6)));
        let loads = [r.peak_base_force, r.peak_base_moment].map(|peak| peak.map_or_else(String::new, |x| fixed(x, 6)));
        let rest = loads.into_iter().chain(past);
        let cells = [r.scenario.clone(), r.steps.to_string()].into_iter().chain(torques).chain(rest);
        table.row(cells.chain([r.answer.clone()]));
    }
    table.to_string()
}
