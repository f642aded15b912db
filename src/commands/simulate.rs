//! `stillbase simulate`

use std::io::{self, StdoutLock, Write};
use std::num::NonZeroU64;
use std::path::PathBuf;

use clap::Args;
use serde::{Serialize, Serializer};
use stillbase::frame::Frame;
use stillbase::session::replay;
use stillbase::signals::{Signal, signals};

use super::failure::Failure;
use super::input::{DEFAULT_SCENARIO, Settings, scenario};
use super::new_file::NewFile;
use super::output::{Format, fixed, say, yes};

/// Run a scenario and print every signal over time as CSV
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase simulate case-1 -o case-1.csv
  stillbase simulate --every 10 --set payload.mass=0.1 | head
  stillbase simulate case-3 --json")]
pub struct Simulate {
    /// A built-in scenario (case-1, case-2, case-3) or a TOML file
    #[arg(value_name = "SCENARIO", default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// Write the CSV to this file instead of standard output
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    /// Print every N-th step only, and the last
    #[arg(long, value_name = "N", default_value = "1")]
    every: NonZeroU64,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

/// What a run comes to.
#[derive(Serialize)]
struct Verdict {
    steps: u64,
    peak_torque: Vec<f64>,
    peak_base_force: f64,
    peak_base_moment: f64,
    reactionless: bool,
}

impl Verdict {
    fn of(last: &Frame) -> Self {
        Self {
            steps: last.step,
            peak_torque: last.peaks.torque.to_vec(),
            peak_base_force: last.peaks.force,
            peak_base_moment: last.peaks.moment,
            reactionless: last.peaks.is_reactionless(),
        }
    }
}

#[derive(Serialize)]
struct Answer {
    scenario: String,
    units: Columns<&'static str>,
    time: Vec<f64>,
    signals: Columns<Vec<f64>>,
    verdict: Verdict,
}

/// A JSON object whose keys keep their order.
struct Columns<T>(Vec<(String, T)>);

impl<T: Serialize> Serialize for Columns<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(path, value)| (path, value)))
    }
}

impl Simulate {
    /// Runs it.
    pub fn run(&self) -> Result<(), Failure> {
        let scenario = scenario(&self.scenario, &self.settings)?;
        let table = signals(&scenario.machine);
        let mut csv = self.csv(&table)?;
        let (mut time, mut columns) = (Vec::new(), vec![Vec::new(); table.len()]);
        let last = (scenario.duration / scenario.step).round() as u64;
        // A run cannot be left half-way; after a failure nothing more is written.
        let mut written = Ok(());
        let run = replay(&scenario, |_, frame| {
            if frame.step % self.every != 0 && frame.step != last {
                return;
            }
            if let (Some(csv), Ok(())) = (&mut csv, &written) {
                written = csv.row(&table, frame);
            }
            if self.format.json {
                time.push(frame.time);
                columns.iter_mut().zip(&table).for_each(|(column, signal)| column.push(value(signal, frame)));
            }
        })
        .map_err(|e| Failure::from(e).of(&scenario.name))?;
        written?;
        if let Some(csv) = csv {
            csv.finish()?;
        }
        let verdict = Verdict::of(&run.frame());
        if !self.format.json {
            say(format!(
                "{}: {} steps, peak |n_B| {} N m, peak |f_B| {} N, reactionless: {}",
                scenario.name,
                verdict.steps,
                fixed(verdict.peak_base_moment, 6),
                fixed(verdict.peak_base_force, 6),
                yes(verdict.reactionless),
            ));
            return Ok(());
        }
        let answer = Answer {
            scenario: scenario.name,
            units: Columns(table.iter().map(|s| (s.path.clone(), s.unit)).collect()),
            time,
            signals: Columns(table.iter().map(|s| s.path.clone()).zip(columns).collect()),
            verdict,
        };
        self.format.print(&answer, |_| String::new())
    }

    /// Where rows go, if anywhere.
    fn csv(&self, table: &[Signal]) -> Result<Option<Csv>, Failure> {
        let sink = match &self.output {
            Some(file) => Sink::File(NewFile::create(file, self.force)?, file.clone()),
            None if self.format.json => return Ok(None),
            None => Sink::Standard(io::stdout().lock()),
        };
        let mut csv = Csv { writer: csv::Writer::from_writer(sink), row: Vec::with_capacity(table.len() + 1) };
        let head = table.iter().map(|s| format!("{} {}", s.path, s.unit));
        let done = csv.writer.write_record(["time s".to_string()].into_iter().chain(head));
        csv.checked(done)?;
        Ok(Some(csv))
    }
}

/// The value of a signal, zero without a sign.
fn value(signal: &Signal, frame: &Frame) -> f64 {
    signal.value(frame) + 0.0
}

struct Csv {
    writer: csv::Writer<Sink>,
    row: Vec<f64>,
}

impl Csv {
    fn row(&mut self, table: &[Signal], frame: &Frame) -> Result<(), Failure> {
        self.row.clear();
        self.row.push(frame.time);
        self.row.extend(table.iter().map(|s| value(s, frame)));
        let done = self.writer.serialize(&self.row);
        self.checked(done)
    }

    fn checked(&self, done: Result<(), csv::Error>) -> Result<(), Failure> {
        done.map_err(|e| match e.into_kind() {
            csv::ErrorKind::Io(e) => self.writer.get_ref().failure(&e),
            other => Failure::WrongInput(format!("CSV: {other:?}")),
        })
    }

    fn finish(mut self) -> Result<(), Failure> {
        let done = self.writer.flush();
        done.map_err(|e| self.writer.get_ref().failure(&e))?;
        match self.writer.into_inner() {
            Ok(Sink::File(file, name)) => {
                file.finish()?;
                say(format!("wrote {}", name.display()));
            }
            Ok(Sink::Standard(_)) => {}
            Err(e) => return Err(Failure::writing("CSV", e.error())),
        }
        Ok(())
    }
}

enum Sink {
    File(NewFile, PathBuf),
    Standard(StdoutLock<'static>),
}

impl Sink {
    fn failure(&self, error: &io::Error) -> Failure {
        match self {
            Self::File(_, name) => Failure::writing(name.display(), error),
            Self::Standard(_) => Failure::standard_output(error),
        }
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File(file, _) => file.write(bytes),
            Self::Standard(out) => out.write(bytes),
        }
    }
    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File(file, _) => file.flush(),
            Self::Standard(out) => out.flush(),
        }
    }
}
