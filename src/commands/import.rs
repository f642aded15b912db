//! `stillbase import`

mod table;

use std::f64::consts::TAU;
use std::path::{Path as FilePath, PathBuf};

use clap::{Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_files::table::{SampleTable, samples};
use stillbase_files::{finish_all, is_standard, write_temporary};
use stillbase_planning::curves::Coordinates;
use stillbase_query::Shared;
use stillbase_session::scenario::{MachineFile, Scenario};
use stillbase_study::import::{GivenMotion, ImportQuery, ImportedMotion, MotionImportError, PreservedPath, Request};

use super::exit::print_message;
use super::failure::Failure;
use super::input::{self, DEFAULT_SCENARIO, Settings, above_zero, floating_scenario, pose_constant, say_base_is_held};
use super::output::{Format, check_output};
use super::progress::answered;
use super::remedy::option;
use super::strict::Strict;
use table::table;

/// Read your own motion from CSV or Parquet, report its reactions on the base, and propose the nearest reactionless motion
///
/// Its columns are called t,q1,q2,q3 for absolute drive angles, or t,x,y for the end effector, in any order. Names
/// may have units: "t (ms)", "q1 (deg)", "x (mm)"; default: s, rad, m. Other columns are ignored. A quintic spline
/// interpolates the samples. The proposal keeps the timing, and b is constant. It keeps the path of the end effector if
/// some plane reaches all of it. Otherwise it keeps the relative angles and turns the arm as a whole. A simulation
/// checks the proposal before it is called reactionless. A machine that has no b moves its end effector without angular
/// momentum: that turns no base, but a force remains.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase import motion.csv
  stillbase import motion.csv --smooth 20 -o quiet.toml     also writes quiet-given.toml
  stillbase import motion.csv --machine spot --base spot    on a base that floats
  stillbase headless quiet.toml quiet-given.toml -o both.rrd
  stillbase export quiet.toml --rate 500 -o quiet.csv")]
pub struct ImportArguments {
    /// A table with named columns, .csv or .parquet; `-` is CSV from standard input
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// A built-in machine or a TOML file
    #[arg(long, value_name = "MACHINE", default_value = "nine-link")]
    machine: String,
    /// The machine stands on the base of this scenario, which floats; --set base.… changes it. x and y are seen from it
    #[arg(long, value_name = "SCENARIO")]
    base: Option<String>,
    /// Pose constant of the proposal, rad; default: the one that moves the drives least, or for x and y the middle of
    /// the feasible interval
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: Option<f64>,
    /// Smooth the samples without delay; this is the frequency, Hz, at which the amplitude is halved
    #[arg(long, value_name = "HZ", value_parser = above_zero)]
    smooth: Option<f64>,
    /// Columns to use if a file has both kinds; default: the drives
    #[arg(long, value_enum)]
    columns: Option<Columns>,
    /// Motion that the proposal keeps if drive angles are given: that of the end effector, or that of the relative
    /// joint angles. Default: that of the end effector, if some plane reaches all of it
    #[arg(long, value_enum)]
    keep: Option<Kept>,
    /// Let the spline bridge gaps in time
    #[arg(long)]
    gaps: bool,
    /// Write the proposal as a scenario, and the given motion beside it as FILE-given.toml
    #[arg(short, long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    format: Format,
}

/// Kind of coordinates in the columns.
#[derive(Clone, Copy, ValueEnum)]
enum Columns {
    /// Absolute drive angles q1, q2 …
    Drives,
    /// x and y of the end effector
    Tip,
}

/// Motion that the proposal keeps if drive angles are given.
#[derive(Clone, Copy, ValueEnum)]
enum Kept {
    Tip,
    Joints,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer<'a> {
    file: &'a str,
    #[serde(flatten)]
    imported: &'a ImportedMotion,
}

impl From<MotionImportError> for Failure {
    fn from(why: MotionImportError) -> Self {
        match why {
            MotionImportError::NoPoses(_) => Self::no_answer(why),
            MotionImportError::NoJoints => Self::wrong_input(why).with_context("--keep joints has no use here"),
            MotionImportError::TooDense => Self::wrong_input(why),
        }
    }
}

impl ImportArguments {
    /// Reads the samples, prints the base reactions of their motion, and writes the proposal if requested.
    pub fn run(&self) -> Result<(), Failure> {
        let files = self.output.as_deref().map(|file| [file.to_owned(), given_path(file)]);
        if self.output.as_deref().is_some_and(is_standard) {
            let why = "-o - is for one file, and import writes two, the proposal and the given motion: want -o FILE.toml; \
                       then `stillbase export FILE.toml -o -` writes one of them as rows";
            return Err(Failure::wrong_input(why));
        }
        for file in files.iter().flatten() {
            check_output(file, self.force, &["toml"])?;
        }
        let MachineFile { machine, design } = input::machine(&self.machine)?;
        let [of_base, own] = self.settings.base_apart(self.base.is_some());
        let machine = own.apply(machine)?;
        let afloat = self.base.as_ref().map(|base| floating_scenario(base, &of_base)).transpose()?;
        if afloat.is_none() {
            say_base_is_held(&machine);
        }
        let name = self.file.display().to_string();
        let wanted = self.columns.map(|columns| match columns {
            Columns::Drives => Coordinates::Drives,
            Columns::Tip => Coordinates::EndEffector,
        });
        let SampleTable { coordinates, samples, names, unwrapped } =
            samples(&input::table(&self.file)?, &machine, wanted, self.gaps)?;
        for (column, turns) in names.iter().zip(&unwrapped).filter(|(_, turns)| **turns > 0) {
            print_message(format!("note: {column} was wrapped: a whole turn taken out at {turns} places"));
        }
        let motion = GivenMotion::new(&machine, coordinates, names, samples);
        for (k, lift) in motion.lifted.iter().enumerate().filter(|(_, lift)| **lift != 0.0) {
            let turns = lift / TAU;
            print_message(format!(
                "note: q{} lifted by {turns:+.0} turns, so that the relative angles begin within their limits",
                k + 1
            ));
        }
        let motion = match self.smooth {
            Some(cut_off) => motion.smoothed(cut_off).map_err(|e| Failure::wrong_input(e).with_context("--smooth"))?,
            None => motion,
        };
        let usual = Scenario::builtin(DEFAULT_SCENARIO)
            .ok_or_else(|| Failure::wrong_input("the built-in scenarios are gone: want a whole installation"))?;
        let stem = files.as_ref().map_or_else(|| "import".to_owned(), |[file, _]| stem(file));
        let title = self.file.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let keep = self.keep.map(|keep| match keep {
            Kept::Tip => PreservedPath::Tip,
            Kept::Joints => PreservedPath::Joints,
        });
        let floats = afloat.is_some();
        let base = afloat.map_or(usual.base, |afloat| afloat.base);
        let own = Scenario { name: stem, title, summary: String::new(), machine, design, base, ..usual };
        let scenario = Shared(own.into());
        let request = Request { scenario, motion: Shared(motion.into()), b: self.b, keep };
        let found = answered::<ImportQuery>(request)??;
        found.notes.iter().for_each(|note| print_message(format!("note: {}", note.worded(option))));
        let imported = ImportedMotion { reason: found.reason.map(|reason| reason.worded(option)), ..found };
        self.format.print(&Answer { file: &name, imported: &imported }, |answer| table(answer.imported))?;
        let Some([proposed, given]) = &imported.scenarios else {
            if let Some(([_, file], given)) = files.as_ref().zip(imported.as_given.as_ref()) {
                finish_all([write_temporary(file, given.to_toml().as_bytes(), self.force)?])?;
                print_message(format!("wrote {}, the motion as given", file.display()));
            }
            return Err(Failure::no_answer(imported.reason.unwrap_or_default()));
        };
        if let Some([file, given_file]) = &files {
            // The given motion is written first, so that it exists whenever the proposal does.
            let given_first = [(given_file, given.to_toml()), (file, proposed.to_toml())];
            let [given_made, made] = given_first.map(|(file, text)| write_temporary(file, text.as_bytes(), self.force));
            finish_all([given_made?, made?])?;
            print_message(format!("wrote {} and {}", file.display(), given_file.display()));
        }
        self.strict.require(imported.proposal.as_ref().into_iter().flat_map(|proposal| {
            let effects = &proposal.account;
            // A base that floats is to keep its attitude.
            let is_quiet = proposal.reactionless || floats && proposal.turns_no_base;
            let found = [
                (is_quiet, "not reactionless"),
                (effects.over.is_none(), "past a limit of a drive"),
                (effects.past_limits <= 0.0, "past the limit of an angle"),
            ];
            let faults = found.into_iter().filter(|(is_good, _)| !is_good);
            faults.map(|(_, what)| format!("the proposal is {what}"))
        }))
    }
}

/// Returns the file of the given motion: `quiet-given.toml` for `quiet.toml`.
fn given_path(file: &FilePath) -> PathBuf {
    file.with_file_name(format!("{}-given.toml", stem(file)))
}

fn stem(file: &FilePath) -> String {
    file.file_stem().map_or_else(|| "import".into(), |stem| stem.to_string_lossy().into_owned())
}
