//! What commands share of their input: machines, scenarios, settings, points.

use std::ffi::OsString;
use std::path::Path;

use clap::Args;
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::mechanics::planar::Vector;
use stillbase::planning::pose_constant::plane_map;
use stillbase::planning::reactionless::PlaneMap;
use stillbase::session::scenario::{Change, PLACE, POSE_CONSTANT, STEP, Scenario};
use stillbase::settings::change;
use stillbase::settings::range::{Range, clipped};
use stillbase::settings::text::MOST_BYTES;

use super::exit::say;
use super::failure::Failure;

/// The scenario of a command that is given none: the paper's reactionless case.
pub const DEFAULT_SCENARIO: &str = "case-3";

/// Changes of the machine.
#[derive(Args, Default)]
pub struct Settings {
    /// Change the machine, as often as needed: link.5.com=-0.02 (m), link.5.axial=0.02 (m), link.9.mass=0.3 (kg),
    /// length.l1=0.6 (m), payload.mass=0.1 (kg, known to control), gravity=0,-9.81 (m/s²), limits.a1=0.4,2.7 (rad),
    /// drive.1.torque_limit=20 (N m), drive.1.speed_limit=3 (rad/s), drive.1.acceleration_limit=40 (rad/s²),
    /// drive.1.jerk_limit=900 (rad/s³), and, where a scenario is asked for and not a machine alone: task.shape=spline,
    /// task.time=2 (s), plant.payload.mass=0.1 (kg, unknown to control), plant.friction.coulomb=0.2 (N m),
    /// plant.link.5.com=-0.02 (m), base.kind=free, base.mass=40 (kg), control.law=pd, control.kp=400,300,300 (s⁻²),
    /// step=0.0005 (s, 0.00001 to 0.01), and every other key of a scenario file
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pairs: Vec<(String, String)>,
}

/// The most parts of a key, joined by dots; none has more than four.
const MOST_PARTS: usize = 16;

fn setting(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("want KEY=VALUE, such as link.5.com=-0.02")?;
    // Keys are taken apart one part after the other, each within the one before.
    if key.split('.').count() > MOST_PARTS {
        return Err(format!("the key has more than {MOST_PARTS} parts: want one such as plant.payload.mass"));
    }
    Ok((key.trim().into(), value.trim().into()))
}

impl Settings {
    /// The machine with all changes made together.
    ///
    /// # Errors
    /// If there is no such setting, or the machine would not be valid.
    pub fn apply(&self, machine: Machine) -> Result<Machine, Failure> {
        if self.pairs.is_empty() {
            return Ok(machine);
        }
        machine
            .set_all(self.pairs.iter().map(|(k, v)| (k.as_str(), v.as_str())))
            .map_err(|e| Failure::wrong_input(e).of("--set"))
    }
}

/// The machine that a command is about.
#[derive(Args)]
pub struct MachineArgument {
    /// A built-in machine (`stillbase machines` lists them) or a TOML file
    #[arg(value_name = "MACHINE")]
    name: String,
    #[command(flatten)]
    settings: Settings,
}

impl MachineArgument {
    /// The machine with its changes.
    ///
    /// # Errors
    /// If there is no such machine, or it is not valid.
    pub fn load(&self) -> Result<Machine, Failure> {
        self.settings.apply(stillbase::files::machine(&self.name, None)?)
    }
}

/// A scenario by name or file, its machine and plant changed before anything is planned.
///
/// # Errors
/// If there is no such scenario, or its machine is not valid.
pub fn scenario(name: &str, settings: &Settings) -> Result<Scenario, Failure> {
    let scenario = set(stillbase::files::scenario(name)?, settings)?;
    tell_unused(&scenario);
    Ok(scenario)
}

/// A scenario with its machine, plant and task changed.
///
/// # Errors
/// If there is no such setting, or its machine is not valid.
pub fn set(mut scenario: Scenario, settings: &Settings) -> Result<Scenario, Failure> {
    let parts = ["task", "plant", "base", "control"];
    let part = |key: &str| parts.iter().position(|part| key.split_once('.').is_some_and(|(head, _)| head == *part));
    let (steps, others): (Vec<_>, Vec<_>) = settings.pairs.iter().cloned().partition(|(key, _)| key == "step");
    for (_, value) in steps {
        let step = value.parse().ok().filter(|step: &f64| step.is_finite());
        let wrong =
            || Failure::wrong_input(format!("step is {:?}: want a step of {STEP}", clipped(&value))).of("--set");
        step_by(&mut scenario, step.ok_or_else(wrong)?);
    }
    let (own, model): (Vec<_>, Vec<_>) = others.into_iter().partition(|(key, _)| part(key).is_some());
    scenario.machine = Settings { pairs: model }.apply(scenario.machine)?;
    let mut changes = std::array::from_fn::<_, 4, _>(|_| Change::new());
    for (key, value) in own {
        let (Some(i), Some((_, rest))) = (part(&key), key.split_once('.')) else { continue };
        changes[i] = change::join(std::mem::take(&mut changes[i]), &change::one(rest, listed(&value)));
    }
    let [task, plant, base, control] = changes;
    let wrong = |of: &str, why: String| Failure::wrong_input(format!("{of}: {why}")).of("--set");
    scenario.plant = change::with(&scenario.plant, &plant).map_err(|why| wrong("plant", why))?;
    scenario.base = change::with(&scenario.base, &base).map_err(|why| wrong("base", why))?;
    scenario.control = change::with(&scenario.control, &control).map_err(|why| wrong("control", why))?;
    change_task(&mut scenario, &task).map_err(|e| e.of("--set"))?;
    scenario.check("--set")?;
    for key in task.keys() {
        if let Some(want) = scenario.task.unused(key) {
            return Err(no_use(&format!("task.{key}"), want).of("--set"));
        }
    }
    for key in base.keys() {
        if let Some(want) = scenario.base.unused(key) {
            return Err(no_use(&format!("base.{key}"), want).of("--set"));
        }
    }
    Ok(scenario)
}

/// The failure of an option that would have no effect here.
pub fn no_use(what: &str, want: &str) -> Failure {
    Failure::wrong_input(format!("{what} has no use here: want {want}"))
}

/// Notes on standard error which keys of a scenario's file have no effect in its task, but for those that every file
/// has.
fn tell_unused(scenario: &Scenario) {
    let standing = ["kind", "from", "to", "b", "time", "law"];
    let keys = Change::try_from(&scenario.task).unwrap_or_default();
    for (key, _) in keys.iter().filter(|(key, _)| !standing.contains(&key.as_str())) {
        if let Some(want) = scenario.task.unused(key) {
            say(format!("note: {}: task.{key} has no use there: want {want}", scenario.name));
        }
    }
}

/// Another step, s; edits stay at their times.
fn step_by(scenario: &mut Scenario, step: f64) {
    let ratio = scenario.step / step;
    scenario.edits.iter_mut().for_each(|edit| edit.step = (edit.step as f64 * ratio).round() as u64);
    scenario.step = step;
}

/// Changes keys of a scenario's task.
///
/// # Errors
/// If there is no such key, or its value is out of range.
pub fn change_task(scenario: &mut Scenario, change: &Change) -> Result<(), Failure> {
    if !change.is_empty() {
        scenario.task = scenario.task.with(change).map_err(|why| Failure::wrong_input(format!("task: {why}")))?;
        scenario.check("task")?;
    }
    Ok(())
}

/// A value as it would stand in a file; several numbers parted by commas are a list.
fn listed(text: &str) -> toml::Value {
    let value = toml_value(text);
    let list = || text.contains(',').then(|| toml_value(&format!("[{text}]"))).filter(toml::Value::is_array);
    if value.is_str() { list().unwrap_or(value) } else { value }
}

/// A value as it would stand in a file: text where it is no other TOML value.
fn toml_value(text: &str) -> toml::Value {
    let read = format!("x = {text}").parse::<Change>().ok().and_then(|mut table| table.remove("x"));
    read.unwrap_or_else(|| toml::Value::String(text.into()))
}

/// The reactionless planes of a machine; says so if b is only nearly constant.
///
/// # Errors
/// If it has none.
pub fn planes_of(machine: &Machine) -> Result<PlaneMap, Failure> {
    let map = plane_map(machine)?;
    let inertia = Inertia::of(machine);
    if !inertia.is_invariant() {
        say(format!(
            "note: couplings of up to {:.1e} kg m² remain in {}, so holding b is not exactly reactionless; \
             `stillbase design` removes them",
            inertia.invariance_residual(),
            machine.name(),
        ));
    }
    Ok(map)
}

/// The command line with a space before negative numbers and points, such as `-0.5,0.25`, so that they are not taken
/// for options; no option begins with a digit.
pub fn words(words: impl Iterator<Item = OsString>) -> impl Iterator<Item = OsString> {
    words.map(|word| match word.to_str().map(str::as_bytes) {
        Some([b'-', b'0'..=b'9' | b'.', .., last]) if !last.is_ascii_alphabetic() => padded(word),
        Some([b'-', b'0'..=b'9']) => padded(word),
        _ => word,
    })
}

fn padded(word: OsString) -> OsString {
    let mut padded = OsString::from(" ");
    padded.push(word);
    padded
}

/// A point X,Y, m.
pub fn point(text: &str) -> Result<Vector, String> {
    let both = text.split_once(',').and_then(|(x, y)| Some(Vector::new(number(x, PLACE)?, number(y, PLACE)?)));
    both.ok_or_else(|| format!("want X,Y in m, such as 0.5,-0.25, each {PLACE}"))
}

/// A pose constant, rad.
pub fn pose_constant(text: &str) -> Result<f64, String> {
    number(text, POSE_CONSTANT).ok_or_else(|| format!("want a number in rad, such as 2.4, {POSE_CONSTANT}"))
}

fn number(text: &str, range: Range) -> Option<f64> {
    text.trim().parse().ok().filter(|x| range.contains(*x))
}

/// A number above 0.
pub fn above_zero(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite()).ok_or_else(|| "want a number above 0".into())
}

/// A text file.
///
/// # Errors
/// If it cannot be read.
pub fn read(file: &Path) -> Result<String, Failure> {
    stillbase::files::text::read(file).map_err(|e| {
        let why = format!("{e}: want a plain file that can be read, of at most {MOST_BYTES} bytes");
        Failure::wrong_input(why).of(file.display())
    })
}
