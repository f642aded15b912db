//! `stillbase headless`

use std::path::{Path, PathBuf};

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use stillbase::scenario::Scenario;

use self::recorder::{Options, Pictures, Progress, RecordError, Recording, record};
use super::failure::Failure;
use super::input::{Settings, scenario};
use super::new_file::may_write;
use super::output::{Format, Table, fixed, say, yes};

/// Simulate scenarios without a window and record them for the Rerun viewer
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase headless -o cases.rrd                             the paper's three cases
  stillbase headless case-1 my.toml -o both.rrd --fps 30      with pictures
  stillbase headless case-3 -o loaded.rrd --set payload.mass=0.1")]
pub struct Headless {
    /// Built-in scenarios (case-1, case-2, case-3) or TOML files; none: the three cases
    #[arg(value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// The recording to write
    #[arg(short, long, value_name = "FILE.rrd")]
    output: PathBuf,
    /// Record offscreen pictures, so many per simulated second, if a graphics adapter exists
    #[arg(long, value_name = "N", value_parser = frames_per_second)]
    fps: Option<f64>,
    /// Width and height of the pictures, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x800", requires = "fps", value_parser = size)]
    size: [u32; 2],
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

fn frames_per_second(text: &str) -> Result<f64, String> {
    let fps = text.parse().ok().filter(|fps| *fps > 0.0 && *fps <= 1000.0);
    fps.ok_or_else(|| "want pictures per simulated second, above 0 and at most 1000".into())
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.parse().ok().filter(|n| (16..=8192).contains(n));
    let both = text.split_once('x').and_then(|(w, h)| Some([side(w)?, side(h)?]));
    both.ok_or_else(|| "want WIDTHxHEIGHT in pixels, 16 to 8192, such as 1280x800".into())
}

#[derive(Serialize)]
struct Answer {
    recordings: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    scenario: String,
    file: String,
    steps: u64,
    peak_torque: Vec<f64>,
    peak_base_force: f64,
    peak_base_moment: f64,
    reactionless: bool,
}

impl From<Recording> for Row {
    fn from(recording: Recording) -> Self {
        let Recording { scenario, file, steps, peak_torque, peak_base_force, peak_base_moment, reactionless } =
            recording;
        let file = file.display().to_string();
        Self { scenario, file, steps, peak_torque, peak_base_force, peak_base_moment, reactionless }
    }
}

impl Headless {
    /// Records and prints the peaks.
    pub fn run(&self) -> Result<(), Failure> {
        let scenarios = self.scenarios()?;
        may_write(&self.output, self.force)?;
        let [width, height] = self.size;
        let pictures = self.fps.map(|fps| Pictures { fps, width, height });
        let recordings = record_with_bar(&scenarios, &self.output, &Options { pictures, force: self.force })?;
        say(format!("wrote {}", self.output.display()));
        let answer = Answer { recordings: recordings.into_iter().map(Row::from).collect() };
        self.format.print(&answer, table)
    }

    fn scenarios(&self) -> Result<Vec<Scenario>, Failure> {
        let builtin = Scenario::builtin_names().map(String::from);
        let names = if self.scenarios.is_empty() { &builtin[..] } else { &self.scenarios };
        let mut scenarios: Vec<Scenario> = Vec::with_capacity(names.len());
        for name in names {
            let next = scenario(name, &self.settings)?;
            if scenarios.iter().any(|s| s.name == next.name) {
                let why = format!("a second scenario called {:?}: want different names in one recording", next.name);
                return Err(Failure::wrong_input(why).of(name));
            }
            scenarios.push(next);
        }
        Ok(scenarios)
    }
}

/// A recording without pictures that replaces nothing.
pub fn unpictured() -> Options {
    Options { pictures: None, force: false }
}

/// Records with a progress bar on standard error, where that is a terminal.
pub fn record_with_bar(scenarios: &[Scenario], file: &Path, options: &Options) -> Result<Vec<Recording>, Failure> {
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{msg:12} {wide_bar} {percent:>3} %  {eta:>4}") {
        bar.set_style(style);
    }
    let recordings = record(scenarios, file, options, &mut |progress: Progress| {
        if bar.message() != progress.what {
            bar.set_message(progress.what.to_owned());
        }
        bar.set_length(progress.of);
        bar.set_position(progress.done);
    });
    bar.finish_and_clear();
    recordings.map_err(Failure::from)
}

impl From<RecordError> for Failure {
    fn from(e: RecordError) -> Self {
        match e {
            RecordError::Refused { scenario, refusal } => Self::from(refusal).of(scenario),
        }
    }
}

fn table(answer: &Answer) -> String {
    let drives = answer.recordings.iter().map(|r| r.peak_torque.len()).max().unwrap_or(0);
    let torques = (1..=drives).map(|k| format!("peak |τ_{k}| N m"));
    let rest = ["peak |f_B| N", "peak |n_B| N m", "reactionless"].map(String::from);
    let mut table = Table::new(["scenario", "steps"].map(String::from).into_iter().chain(torques).chain(rest));
    for r in &answer.recordings {
        let torques = (0..drives).map(|k| r.peak_torque.get(k).map_or_else(String::new, |t| fixed(*t, 6)));
        let rest = [fixed(r.peak_base_force, 6), fixed(r.peak_base_moment, 6), yes(r.reactionless).into()];
        table.row([r.scenario.clone(), r.steps.to_string()].into_iter().chain(torques).chain(rest));
    }
    table.to_string()
}

// MERGE: replace this module by `use stillbase::headless as recorder;`. It runs the scenarios and writes no file.
mod recorder {
    use std::path::{Path, PathBuf};

    use stillbase::scenario::Scenario;
    use stillbase::session::{Refusal, replay};

    pub struct Options {
        pub pictures: Option<Pictures>,
        pub force: bool,
    }

    pub struct Pictures {
        pub fps: f64,
        pub width: u32,
        pub height: u32,
    }

    pub struct Recording {
        pub scenario: String,
        pub file: PathBuf,
        pub steps: u64,
        pub peak_torque: Vec<f64>,
        pub peak_base_force: f64,
        pub peak_base_moment: f64,
        pub reactionless: bool,
    }

    pub struct Progress<'a> {
        pub done: u64,
        pub of: u64,
        pub what: &'a str,
    }

    pub enum RecordError {
        Refused { scenario: String, refusal: Refusal },
    }

    pub fn record(
        scenarios: &[Scenario],
        file: &Path,
        _options: &Options,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Vec<Recording>, RecordError> {
        let of = |s: &Scenario| (s.duration / s.step).round() as u64;
        let total = scenarios.iter().map(of).sum();
        let mut before = 0;
        let mut recordings = Vec::new();
        for s in scenarios {
            let see = |_: &_, f: &stillbase::frame::Frame| {
                progress(Progress { done: before + f.step, of: total, what: &s.name });
            };
            let run = replay(s, see).map_err(|refusal| RecordError::Refused { scenario: s.name.clone(), refusal })?;
            before += of(s);
            let last = run.frame();
            recordings.push(Recording {
                scenario: s.name.clone(),
                file: file.into(),
                steps: last.step,
                peak_torque: last.peaks.torque.to_vec(),
                peak_base_force: last.peaks.force,
                peak_base_moment: last.peaks.moment,
                reactionless: last.peaks.is_reactionless(),
            });
        }
        Ok(recordings)
    }
}
