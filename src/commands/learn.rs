//! `stillbase learn`

use clap::Args;
use stillbase_exchange::mjcf::middle;
use stillbase_mechanics::balance::Preset;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::Reference;
use stillbase_session::Session;
use stillbase_session::scenario::Scenario;
use stillbase_study::equations::{
    DriveState, EQUATION_NUMBERS, Equation, NoInstant, StatedEquations, equation_text, equations, state_text,
};

use super::failure::Failure;
use super::input::{DEFAULT_SCENARIO, Settings, machine, no_use, overlay_used, report_left_out};
use super::output::Format;
use super::progress::goes_on;
use super::strict::Strict;
use stillbase_settings::number::counted;

/// Print every equation of the paper, and below it the same equation with the numbers of a machine
///
/// Both sides of an equation are computed independently: one link by link, the other by the closed forms that the
/// program uses. The numbers belong to an instant of the run, by default a quarter of its planned time, or to a pose.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase learn --equation 7
  stillbase learn case-1 --at 0.3 --equation 5 --equation 12
  stillbase learn serial-3r --set link.2.com=-0.1 --json
  stillbase learn nine-link-table-1 --pose 1.7,3.7,2.2 --rates 0.1,0,-0.5")]
pub struct LearnArguments {
    /// A built-in scenario or machine (case-1, four-drive …), or a TOML file of either
    #[arg(value_name = "SCENARIO|MACHINE", default_value = DEFAULT_SCENARIO)]
    what: String,
    /// Only this equation, 1 to 16 or A1 to A3; may be repeated
    #[arg(long, value_name = "N", value_parser = number)]
    equation: Vec<&'static str>,
    /// Time of the run, s
    #[arg(long, value_name = "T", value_parser = instant)]
    at: Option<f64>,
    /// Angles of all drives instead of a run, rad
    #[arg(long, value_name = "Q1,Q2,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = figure, conflicts_with = "at")]
    pose: Vec<f64>,
    /// Rates of all drives, rad/s; default: 0
    #[arg(long, value_name = "QD1,QD2,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = figure, requires = "pose")]
    rates: Vec<f64>,
    /// Accelerations of all drives, rad/s²; default: 0
    #[arg(long, value_name = "QDD1,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = figure, requires = "pose")]
    accelerations: Vec<f64>,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    format: Format,
}

fn number(text: &str) -> Result<&'static str, String> {
    let bare = text.trim().trim_start_matches('(').trim_end_matches(')');
    let known = EQUATION_NUMBERS.into_iter().find(|known| known.eq_ignore_ascii_case(bare));
    known.ok_or_else(|| "want the number of an equation, 1 to 16 or A1 to A3".into())
}

fn instant(text: &str) -> Result<f64, String> {
    text.trim()
        .parse()
        .ok()
        .filter(|t: &f64| *t >= 0.0 && t.is_finite())
        .ok_or_else(|| "want a time in s, 0 or more".into())
}

fn figure(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "want numbers, such as 1.7,-0.5,2.2".into())
}

/// Subject of the equations.
enum Subject {
    Scenario(Box<Scenario>),
    Machine(Box<Machine>),
}

impl LearnArguments {
    /// Prints the equations.
    pub fn run(&self) -> Result<(), Failure> {
        let (machine, state) = self.machine_and_state()?;
        let all = equations(&machine, &state, Preset::Table1);
        let is_chosen = |equation: &&Equation| self.equation.is_empty() || self.equation.contains(&equation.number);
        let chosen: Vec<&Equation> = all.iter().filter(is_chosen).collect();
        let answer = StatedEquations::of(&machine, &state, chosen.iter().copied());
        self.format.print(&answer, |_| {
            let texts: Vec<String> = chosen.iter().map(|equation| equation_text(equation, MAX_WIDTH)).collect();
            format!("{}\n\n{}", state_text(&machine, &state), texts.join("\n"))
        })?;
        let broken = answer.equations.iter().filter(|equation| equation.holds == Some(false));
        self.strict.require(broken.map(|equation| format!("Eq. ({}) does not hold", equation.number)))
    }

    /// Returns the machine and its state at the instant.
    fn machine_and_state(&self) -> Result<(Machine, DriveState), Failure> {
        let machine = match self.find()? {
            Subject::Scenario(scenario) if self.pose.is_empty() => {
                let state = self.state(&scenario)?;
                return Ok((scenario.machine, state));
            }
            Subject::Machine(_) if self.at.is_some() => return Err(no_use("--at", "a scenario, or --pose")),
            Subject::Scenario(scenario) => scenario.machine,
            Subject::Machine(machine) => *machine,
        };
        let n = machine.drives();
        let pose = if self.pose.is_empty() { middle(&machine) } else { self.pose.clone() };
        let given = |option: &str, values: &[f64]| {
            let all = if values.is_empty() { vec![0.0; n] } else { values.to_vec() };
            let fits = all.len() == n && all.iter().all(|x| x.is_finite() && x.abs() <= MAX_MAGNITUDE);
            let wrong = || {
                let drives = counted(n, "drive");
                Failure::wrong_input(format!(
                    "{option}: want a number from −{MAX_MAGNITUDE} to {MAX_MAGNITUDE} for each of {drives}"
                ))
            };
            PerDrive::from_slice(&all).filter(|_| fits).ok_or_else(wrong)
        };
        let q = DriveAngles(given("--pose", &pose)?);
        let (qd, qdd) = (given("--rates", &self.rates)?, given("--accelerations", &self.accelerations)?);
        Ok((machine, DriveState::of_reference(Reference { q, qd, qdd })))
    }

    /// Returns the scenario or the machine that the command line names.
    fn find(&self) -> Result<Subject, Failure> {
        let machine = || self.settings.apply(machine(&self.what)?.machine);
        match stillbase_files::scenario(&self.what) {
            // For the name of a machine, the scenario made for it is not used.
            Ok(found) if found.note.is_some() => Ok(Subject::Machine(Box::new(machine()?))),
            Ok(found) => {
                report_left_out(&self.what, &found.left_out);
                let scenario = overlay_used(found.scenario, &self.settings)?;
                self.settings.refuse_tolerances()?;
                Ok(Subject::Scenario(Box::new(scenario)))
            }
            // A machine for which no task can be made is accepted, too.
            Err(why) => Ok(Subject::Machine(Box::new(machine().map_err(|_| why)?))),
        }
    }

    fn state(&self, scenario: &Scenario) -> Result<DriveState, Failure> {
        let Some(at) = self.at else {
            let session = Session::open(scenario.clone()).map_err(|why| Failure::refused(scenario, why))?;
            return Ok(DriveState::of(session.run(), session.frame()));
        };
        DriveState::at(scenario, at, goes_on).map_err(|why| match why {
            NoInstant::Refused(why) => Failure::refused(scenario, why),
            later => Failure::wrong_input(format!("--at {at}: {later}")),
        })
    }
}

/// Maximum magnitude of a given angle, rate or acceleration, rad, rad/s or rad/s².
const MAX_MAGNITUDE: f64 = 1e6;

/// Maximum width of a line of terms, characters.
const MAX_WIDTH: usize = 100;
