//! `stillbase trim`

mod answer;

use std::path::{Path, PathBuf};

use clap::Args;
use stillbase_files::table::{is_table, motions, signals};
use stillbase_files::{finish_all, is_standard, write_temporary};
use stillbase_mechanics::balance::RebalanceRequest;
use stillbase_mechanics::counterweights::{CounterweightSpec, CounterweightStock, Objective};
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;
use stillbase_query::Shared;
use stillbase_session::scenario::MachineFile;
use stillbase_settings::number::counted;
use stillbase_simulation::plant::Base;
use stillbase_study::trim::{
    MeasurementSet, NoTrim, OrbitBase, OrbitMotion, OrbitTrimQuery, OrbitTrimRequest, TrimMethod, TrimQuery,
    TrimRequest, TrimResult as Found, corrected_as_built, free_weights, identified_machine,
};

use super::exit::print_message;
use super::failure::Failure;
use super::holds::{apply_bounds, bound};
use super::input::{self, Settings, floating_scenario};
use super::new_machine::named_after;
use super::output::{Format, say_written};
use super::progress::answered;
use super::sites::{range, sites};
use super::strict::Strict;

/// Identify the unbalance of a built machine from measured base forces, and find the smallest change that corrects it
///
/// Each file is CSV or Parquet with the columns t, the absolute drive angles q1, q2 …, and fx, fy, nz. The last three are force on
/// the base and moment about B, as a sensor under the machine reads them. Units are s, rad, N, N m, or given as
/// "q1 (deg)", "nz (mN m)". Rates qd1 … and accelerations qdd1 … are used if both exist. A column `motion`, a jump in
/// time or a restart of time separates motions, which each have their own sensor offsets. Files that `simulate` and
/// `export --what simulated` write can be read unchanged.
///
/// Least squares estimate every component of Eqs (7) and (8) with its 95 % interval, and offset and drift of each
/// sensor. Components that the data do not determine are named. Wrong signs, exchanged columns, relative angles and
/// wrong units are fitted, too. If one of them explains the data far better, trim says so and stops. Components that
/// differ from the machine's file by more than their interval are corrected, if the data show that this helps. The
/// correction changes mass and place of the counterweights, or adds some if there are none. The last table proposes the
/// next motion: the one that best determines the most uncertain component.
///
/// In orbit no force can be measured: with `--base` the files are of the machine on a base that floats, one motion each, with
/// the columns that `simulate` writes: angle/… and rate/… of every drive, attitude/base, attitude_rate/base, and wheel/rate.
/// Angular momentum stays constant, which tells first moments and couplings relative to the inertia of the base, with
/// their intervals. Usual mistakes of the columns are tested here, too. Nothing is changed.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase trim measured.csv nine-link
  stillbase trim slow.csv fast.csv arm.toml -o trimmed.toml --identified as-built.toml
  stillbase trim measured.csv arm.toml --fix counterweight.2.at --bound counterweight.1.mass=1.9,2.1
  stillbase trim orbit.csv spot --base spot
  stillbase trim orbit.csv spot --base spot --set base.mass=11.5
  stillbase trim measured.csv nine-link --range 1=-0.3,0.1 --range 2=-0.2,0.1 --range 3=-0.2,0.1 \\
    --range 8=-0.3,0.3 --range 9=-0.3,0.3 --json")]
pub struct TrimArguments {
    /// Tables of measured motions, .csv or .parquet, and last a built-in machine (`stillbase machines` lists them) or a TOML file
    #[arg(value_name = "MEASURED... MACHINE", required = true, num_args = 1..)]
    words: Vec<String>,
    #[command(flatten)]
    settings: Settings,
    /// The files are of motions in orbit, on the base of this scenario, which floats
    #[arg(long, value_name = "SCENARIO", conflicts_with_all = [
        "fix", "free", "bound", "range", "across", "angles_only", "accelerations", "output", "identified",
    ])]
    base: Option<String>,
    /// Keep these parameters fixed: counterweight.1.mass, counterweight.2.at, 3.com
    #[arg(long, value_name = "KEY,…", value_delimiter = ',')]
    fix: Vec<String>,
    /// Let these parameters change, too: 4.com, 4.mass; a gram has the same penalty as a millimetre
    #[arg(long, value_name = "KEY,…", value_delimiter = ',')]
    free: Vec<String>,
    /// Let this parameter change within these bounds only, m or kg
    #[arg(long, value_name = "KEY=LO,HI", value_parser = bound, allow_hyphen_values = true)]
    bound: Vec<(String, [f64; 2])>,
    /// On a machine without counterweights: a link that may carry a new one, and the bounds of its place, m. Places
    /// count from the root towards the tip. Default: every link
    #[arg(long, value_name = "LINK=LO,HI", value_parser = range, allow_hyphen_values = true)]
    range: Vec<(String, [f64; 2])>,
    /// On a machine without counterweights: how far off the axis of its link a new one may lie, to either side, m
    #[arg(long, value_name = "METRES", default_value_t = 0.0)]
    across: f64,
    /// Ignore measured rates and accelerations, and compute them from the angles
    #[arg(long)]
    angles_only: bool,
    /// Use the columns as given, even if another sign, order or unit explains them far better
    #[arg(long)]
    as_given: bool,
    /// Maximum acceleration of each drive in the proposed motion, rad/s²; default: the maximum in the files
    #[arg(long, value_name = "A1,A2,…", value_delimiter = ',', value_parser = super::input::above_zero)]
    accelerations: Vec<f64>,
    /// Write the trimmed machine to this file: the measured machine with the changes
    #[arg(short, long, value_name = "NEW.toml")]
    output: Option<PathBuf>,
    /// Write the measured machine without the changes; the centres of mass of its links explain the measurements
    #[arg(long, value_name = "FILE.toml")]
    identified: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    format: Format,
}

impl TrimArguments {
    /// Reads the measurements, prints the identified components, and writes the machines.
    pub fn run(&self) -> Result<(), Failure> {
        if self.output.as_deref().is_some_and(is_standard) && self.identified.as_deref().is_some_and(is_standard) {
            return Err(Failure::wrong_input(
                "-o and --identified both want standard output: want a file for one of them",
            ));
        }
        for file in self.output.iter().chain(&self.identified) {
            self.format.check_output(file, self.force, &["toml"])?;
        }
        let (name, files) = match self.words.as_slice() {
            all if all.last().is_some_and(|word| is_table(Path::new(word))) => {
                return Err(Failure::wrong_input(
                    "no machine: want one after the files, as in trim measured.csv nine-link",
                ));
            }
            [files @ .., name] if !files.is_empty() => (name, files),
            _ => return Err(Failure::wrong_input("want files and a machine, as in trim measured.csv nine-link")),
        };
        let MachineFile { machine, design } = input::machine(name)?;
        // In orbit, settings of the base belong to its scenario.
        let [of_base, own] = self.settings.base_apart(self.base.is_some());
        let machine = own.apply(machine)?;
        let drives = machine.drives();
        if let Some(base) = &self.base {
            let base = floating_scenario(base, &of_base)?.base;
            return self.in_orbit(&machine, &base, files);
        }
        if !(self.accelerations.is_empty() || self.accelerations.len() == drives) {
            return Err(Failure::wrong_input(format!(
                "--accelerations has {}: want {drives}, one for each drive",
                counted(self.accelerations.len(), "number")
            )));
        }
        let method = self.method(&machine)?;
        let mut recording = MeasurementSet::default();
        for file in files {
            recording.motions.extend(motions(&input::table(Path::new(file))?, &machine)?);
        }
        let request = TrimRequest {
            machine: Shared(machine.clone().into()),
            recording: Shared(recording.into()),
            angles_only: self.angles_only,
            as_given: self.as_given,
            method,
            accelerations: Some(self.accelerations.clone()).filter(|all| !all.is_empty()),
        };
        let found = answered::<TrimQuery>(request)?;
        if let Some(noise) = found.angle_noise {
            print_message(format!(
                "note: {:.0} % of the accelerations is noise of the angles, or samples are too far apart: results \
                 may be off; want faster motions or finer encoders",
                100.0 * noise
            ));
        }
        found.doubt.iter().for_each(|doubt| print_message(format!("note: {doubt}")));
        let Found { report, adopted, correction } = found.outcome.map_err(as_failure)?;
        self.format.print(&report, |report| answer::text(report, &machine))?;
        let judged = self.strict.require(
            report
                .numbers
                .iter()
                .filter(|number| number.unknown.off)
                .map(|number| format!("{} is off", number.unknown.name)),
        );
        let mended = correction.map_err(Failure::no_answer)?;
        if self.output.is_none() && self.identified.is_none() {
            return judged;
        }
        let (built, misses) = identified_machine(&machine, &adopted).map_err(Failure::no_answer)?;
        let scale = |miss: &Vector| miss.norm();
        if misses.iter().map(scale).fold(0.0, f64::max) > 1e-6 {
            print_message(
                "note: centres of mass of the links do not explain all that was measured: the file comes close",
            );
        }
        let mut files = Vec::new();
        if let Some(file) = &self.identified {
            let summary = format!("{}, as measured", machine.name());
            files.push((file, named_after(file, &built, &design, summary)?));
        }
        if let Some(file) = &self.output {
            let trimmed = corrected_as_built(&built, &machine, &mended)?;
            let summary = format!("{}, trimmed as measured", machine.name());
            files.push((file, named_after(file, &trimmed, &design, summary)?));
        }
        let written = |(file, text): &(&PathBuf, String)| write_temporary(file, text.as_bytes(), self.force);
        match files.as_slice() {
            [one, other] => finish_all([written(one)?, written(other)?])?,
            [one] => finish_all([written(one)?])?,
            _ => {}
        }
        files.iter().for_each(|(file, _)| say_written(file));
        judged
    }

    /// Prints what motions in orbit tell about the machine.
    fn in_orbit(&self, machine: &Machine, base: &Base, files: &[String]) -> Result<(), Failure> {
        let base = OrbitBase::of(base);
        let motion = |file: &String| -> Result<OrbitMotion, Failure> {
            let table = signals(Path::new(file))?;
            OrbitMotion::of(machine, &table).map_err(|why| Failure::wrong_input(why).with_context(file))
        };
        let motions = files.iter().map(motion).collect::<Result<Vec<_>, _>>()?;
        let found = answered::<OrbitTrimQuery>(OrbitTrimRequest {
            machine: Shared(machine.clone().into()),
            base,
            motions: Shared(motions.into()),
            as_given: self.as_given,
        })?;
        found.doubt.iter().for_each(|doubt| print_message(format!("note: {doubt}")));
        let report = found.outcome.map_err(as_failure)?;
        self.format.print(&report, answer::orbit_text)?;
        let off = report.numbers.iter().filter(|number| number.off);
        self.strict.require(off.map(|number| format!("{} is off", number.name)))
    }

    /// Returns the permitted changes: of the present counterweights and the named parameters, or by new counterweights
    /// if there are neither.
    fn method(&self, machine: &Machine) -> Result<TrimMethod, Failure> {
        let weights = machine.spec().counterweights.len();
        let named = !(self.fix.is_empty() && self.free.is_empty() && self.bound.is_empty());
        if weights == 0 && !named {
            let sites = sites(machine, &self.range, self.across)?;
            return Ok(TrimMethod::Add(CounterweightSpec::least(Objective::mass(), sites, CounterweightStock::STEEL)));
        }
        if !self.range.is_empty() || self.across != 0.0 {
            let why = "--range and --across are for new counterweights on a machine that has none: want --fix, --free or --bound alone";
            return Err(Failure::wrong_input(why));
        }
        // Only counterweights and named parameters may change. Without counterweights, if only fixed parameters are
        // named, all other centres of mass may change.
        let mut request = match weights {
            0 if self.free.is_empty() && self.bound.is_empty() => {
                RebalanceRequest::coms(machine, &vec![1.0; machine.links().len()])
            }
            _ => RebalanceRequest::default(),
        };
        free_weights(&mut request, machine, |weight| !weight.fixed);
        apply_bounds(&mut request, machine, &self.fix, &self.free, &self.bound)?;
        Ok(TrimMethod::Change(request))
    }
}

/// Converts the reason why measurements cannot be used into a failure.
fn as_failure(why: NoTrim) -> Failure {
    match why {
        NoTrim::Unusable(why) => Failure::wrong_input(why),
        NoTrim::Doubted(doubt) => {
            let way_out = "If the columns are right, --as-given takes them as they are.";
            Failure::no_answer(format!("{doubt}\n  {way_out}"))
        }
        NoTrim::NoFit(why) => Failure::no_answer(why),
    }
}
