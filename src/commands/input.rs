//! Input that commands share: machines, scenarios, settings, points.

use std::ffi::OsString;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use stillbase_files::table::{NoTable, TABLE_ENDINGS, Table};
use stillbase_files::text::STANDARD_INPUT;
use stillbase_files::{FoundMachine, scenario_on_free_base};
use stillbase_mechanics::assembly::Assembly;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;
use stillbase_mechanics::sketch::{Missing, resolve};
use stillbase_planning::pose_constant::PoseConstant;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_session::assembly::AssemblyScenario;
use stillbase_session::scenario::{
    DesignBrief, MachineFile, POINT_RANGE, POSE_CONSTANT_RANGE, Scenario, Task, TaskChange, key_of,
};
use stillbase_session::{
    ReachablePoints, Run, proposals_for_machine, proposals_for_settings, proposals_for_values, with_start_edits,
};
use stillbase_settings::change;
use stillbase_settings::key::Key;
use stillbase_settings::number::counted;
use stillbase_settings::range::{Range, shortened};
use stillbase_settings::spelling::nearest_keys;
use stillbase_settings::text::{MAX_TEXT_BYTES, shell_word};
use stillbase_settings::word::Choice;
use stillbase_simulation::plant::BaseKind;

use toml::Value;

use super::exit::print_message;
use super::failure::Failure;
use super::misnamed::Misnamed;

/// Default scenario of a command: the paper's reactionless case.
pub const DEFAULT_SCENARIO: &str = "case-3";

/// Returns a parser of the words of a choice; help lists the meaning of each.
pub fn choice<T: Choice>(all: impl IntoIterator<Item = T>) -> impl TypedValueParser<Value = T> {
    let words = all.into_iter().map(T::words);
    let values = words.map(|words| PossibleValue::new(words.file).help(words.meaning));
    PossibleValuesParser::new(values.collect::<Vec<_>>()).try_map(|word| T::of_word(&word).ok_or("no such choice"))
}

/// Settings of the command line, which override those of a machine or a scenario.
#[derive(Args, Default)]
pub struct Settings {
    /// Set a key of the machine, such as link.5.com=-0.02 (m), or of a scenario, such as task.time=2 (s),
    /// plant.payload.mass=0.1 (kg) or base.kind=free; may be repeated. The word `default` removes a key.
    /// `stillbase keys` lists all keys with units, ranges and defaults
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    pairs: Vec<(String, String)>,
}

/// Maximum number of parts of a key, joined by dots; no key has more than four.
const MAX_KEY_PARTS: usize = 16;

fn setting(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("want KEY=VALUE, such as link.5.com=-0.02")?;
    // Each part of a key is one level of nesting, so the number of parts is bounded.
    if key.split('.').count() > MAX_KEY_PARTS {
        return Err(format!("the key has more than {MAX_KEY_PARTS} parts: want one such as plant.payload.mass"));
    }
    Ok((key.trim().into(), value.trim().into()))
}

impl Settings {
    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Returns the machine with all settings changed together.
    ///
    /// # Errors
    /// If there is no such setting, it has no effect, or the machine would not be valid.
    pub fn apply(&self, machine: Machine) -> Result<Machine, Failure> {
        if self.pairs.is_empty() {
            return Ok(machine);
        }
        let own = machine.clone();
        let machine = machine.set_all(self.pairs.iter().map(|(k, v)| (k.as_str(), v.as_str())));
        let machine = machine.map_err(|e| {
            let wanted = self.change();
            let accepts = |change: &TaskChange| own.with_settings(&change::join(wanted.clone(), change)).is_ok();
            let proposals = proposals_for_values(&wanted, &|path| own.value(path), &accepts);
            Failure::wrong_input(e).with_context("--set").with_proposals(proposals)
        })?;
        match self.pairs.iter().find(|(key, value)| value != change::DEFAULT_WORD && !machine.uses(key, false)) {
            Some((key, _)) => Err(no_use(key, key_of(key).map_or("", |key| key.when)).with_context("--set")),
            None => Ok(machine),
        }
    }

    /// Returns an assembly with settings of its blocks changed, as `wrist.payload.mass`, or its `gravity`. `beside` are first
    /// words of other keys, one of which may be meant.
    ///
    /// # Errors
    /// If a setting is wrong, or names no block.
    fn apply_to_assembly(&self, mut assembly: Assembly, beside: &[&str]) -> Result<Assembly, Failure> {
        let block_of = |key: &str| key.split_once('.').map_or("", |(block, _)| block).to_owned();
        let names: Vec<String> = assembly.blocks().iter().map(|block| block.name.clone()).collect();
        for (key, value) in &self.pairs {
            let wrong = |why: String| Failure::wrong_input(format!("--set {key}: {why}"));
            if key == "gravity" {
                let want = || wrong(format!("{}: want x,y,z of the assembly in m/s²", shortened(value, 80)));
                let three = match change::value(value) {
                    Value::String(word) if word == change::DEFAULT_WORD => Some([0.0; 3]),
                    Value::Array(list) => {
                        let numbers: Option<Vec<f64>> = list.iter().map(change::number).collect();
                        numbers.and_then(|numbers| numbers.try_into().ok())
                    }
                    _ => None,
                };
                assembly.set_gravity(three.ok_or_else(want)?).map_err(|why| wrong(why.to_string()))?;
            } else if !names.contains(&block_of(key)) {
                let (first, all) = (names.first().map_or("BLOCK", String::as_str), names.join(", "));
                let (head, rest) =
                    key.split_once('.').map_or((&key[..], String::new()), |(head, rest)| (head, format!(".{rest}")));
                let known = beside.iter().copied().chain(names.iter().map(String::as_str));
                let nearest = nearest_keys(head, known).into_iter().map(|one| format!("{one}{rest} (nearest) or "));
                let nearest: String = nearest.collect();
                return Err(wrong(format!(
                    "want {nearest}the name of a block before it, one of {all}, as {first}.{key}"
                )));
            } else if key.ends_with(".gravity") {
                return Err(wrong("want gravity=x,y,z of the whole assembly".into()));
            }
        }
        assembly.with_machines(|name, machine| {
            let own = self.pairs.iter().filter(|(key, _)| block_of(key) == name);
            let pairs = own.map(|(key, value)| (key[name.len() + 1..].to_owned(), value.clone())).collect();
            Self { pairs }.apply(machine).map_err(|why| why.with_context(format!("block {name}")))
        })
    }

    /// Refuses settings of tolerances, which have no effect in a command that samples no machines.
    ///
    /// # Errors
    /// If there is such a setting.
    pub fn refuse_tolerances(&self) -> Result<(), Failure> {
        let given = |(key, value): &&(String, String)| {
            key.split('.').next() == Some("tolerance") && ![change::DEFAULT_WORD, Key::NONE].contains(&value.as_str())
        };
        self.pairs.iter().find(given).map_or(Ok(()), |(key, _)| Err(no_use(key, STUDY).with_context("--set")))
    }

    /// Returns the options as a shell takes them, each with a space in front.
    pub fn as_typed(&self) -> String {
        self.pairs.iter().map(|(key, value)| format!(" --set {}", shell_word(&format!("{key}={value}")))).collect()
    }

    /// Returns the keys that are set.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.pairs.iter().map(|(key, _)| key.as_str())
    }

    /// Returns the settings of some keys.
    #[must_use]
    pub fn of_keys(&self, is_wanted: impl Fn(&str) -> bool) -> Self {
        Self { pairs: self.pairs.iter().filter(|(key, _)| is_wanted(key)).cloned().collect() }
    }

    /// Returns the settings of the base and all others. Without a scenario of a base, settings of the base are as all others.
    #[must_use]
    pub fn base_apart(&self, has_base: bool) -> [Self; 2] {
        let is_of_base = |key: &str| key.split('.').next() == Some("base");
        [true, false].map(|wanted| self.of_keys(|key| (has_base && is_of_base(key)) == wanted))
    }

    /// Whether a key is set.
    pub fn sets(&self, key: &str) -> bool {
        self.pairs.iter().any(|(given, _)| given == key)
    }

    /// Returns all settings as a file would state them, with the last value of each key.
    fn change(&self) -> TaskChange {
        let one = |(key, value): &(String, String)| change::single_change(key, change::value(value));
        self.pairs.iter().map(one).fold(TaskChange::new(), |all, one| change::join(all, &one))
    }
}

/// The machine on which a command operates.
#[derive(Args)]
pub struct MachineArgument {
    /// A built-in machine (`stillbase machines` lists them) or a file: TOML, URDF or MJCF
    #[arg(value_name = "MACHINE")]
    name: String,
    #[command(flatten)]
    settings: Settings,
}

impl MachineArgument {
    /// Returns the machine with its settings changed.
    ///
    /// # Errors
    /// If there is no such machine or it is not valid, or as [`Settings::apply`].
    pub fn load(&self) -> Result<Machine, Failure> {
        self.load_file().map(|file| file.machine)
    }

    /// Returns the machine with its settings changed, and the brief that its file holds.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn load_file(&self) -> Result<MachineFile, Failure> {
        let MachineFile { machine, design } = machine(&self.name)?;
        Ok(MachineFile { machine: self.settings.apply(machine)?, design })
    }

    /// Returns the machine with its settings changed, and its base if that floats.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn find(&self) -> Result<FoundMachine, Failure> {
        let found = found_machine(&self.name)?;
        Ok(FoundMachine { machine: self.settings.apply(found.machine)?, ..found })
    }

    /// Returns the assembly that the argument names, with its settings changed; a machine is an assembly of one block.
    ///
    /// # Errors
    /// As [`load`](Self::load), or as [`assembly_file`](Self::assembly_file).
    pub fn load_assembly(&self) -> Result<Assembly, Failure> {
        match self.assembly()? {
            Some(assembly) => Ok(assembly),
            None => self.load().map(Assembly::from),
        }
    }

    /// Returns the assembly that the argument names, or that of its scenario, with its settings changed; `None` for anything
    /// else.
    ///
    /// # Errors
    /// As [`assembly_file`](Self::assembly_file), or as [`assembly_scenario`].
    pub fn assembly(&self) -> Result<Option<Assembly>, Failure> {
        match self.assembly_file()? {
            None => Ok(self.assembly_scenario()?.map(|scenario| scenario.assembly)),
            found => Ok(found),
        }
    }

    /// Returns the assembly that a file holds, with its settings changed; `None` if the argument is no such file. Settings
    /// begin with the name of a block, as `wrist.payload.mass`.
    ///
    /// # Errors
    /// If the file or a setting is wrong, or a setting names no block.
    pub fn assembly_file(&self) -> Result<Option<Assembly>, Failure> {
        let Some(assembly) = stillbase_files::assembly(&self.name)? else { return Ok(None) };
        self.settings.apply_to_assembly(assembly, &[]).map(Some)
    }

    /// Returns the scenario of an assembly that the argument names, with its settings changed; `None` for anything else.
    ///
    /// # Errors
    /// As [`assembly_scenario`].
    pub fn assembly_scenario(&self) -> Result<Option<AssemblyScenario>, Failure> {
        assembly_scenario(&self.name, &self.settings)
    }

    /// Returns the name or file of the machine, as given.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns what the drawing lacks to be a machine, if the argument is a scenario with an incomplete drawing.
    pub fn incomplete_drawing(&self) -> Option<Failure> {
        let scenario = stillbase_files::scenario(&self.name).ok()?.scenario;
        let scenario = with_start_edits(&scenario).map_or(scenario, |(start, _)| start);
        let missing = resolve(scenario.sketch.as_ref()?).missing;
        let says = |one: Missing| match one.mends.into_iter().next() {
            Some(mend) => format!("{} ({})", one.text, mend.label),
            None => one.text,
        };
        let list = missing.into_iter().map(says).collect::<Vec<_>>().join("; ");
        (!list.is_empty()).then(|| Failure::no_answer(format!("the drawing is no machine yet; still missing: {list}")))
    }

    /// Returns whether a setting is given.
    pub fn sets(&self, key: &str) -> bool {
        self.settings.pairs.iter().any(|(own, _)| own == key)
    }

    /// Returns the argument as a shell takes it, with its settings.
    pub fn as_typed(&self) -> String {
        format!("{}{}", shell_word(&self.name), self.settings.as_typed())
    }

    /// Returns the machine and others, each with the same settings changed and with a distinct name, and the brief of
    /// the first one.
    ///
    /// # Errors
    /// As [`load`](Self::load); the error names the machine as the command line does.
    pub fn load_with(&self, others: &[String]) -> Result<(Vec<(String, Machine)>, DesignBrief), Failure> {
        let mut all: Vec<(&str, Machine)> = Vec::new();
        let mut brief = None;
        for called in std::iter::once(&self.name).chain(others) {
            let MachineFile { machine, design } = machine(called)?;
            brief.get_or_insert(design);
            all.push((called, self.settings.apply(machine).map_err(|why| why.with_context(called))?));
        }
        let names = distinct_names(&all.iter().map(|(called, machine)| (*called, machine.name())).collect::<Vec<_>>());
        let machines = all.into_iter().map(|(_, machine)| machine);
        Ok((names.into_iter().zip(machines).collect(), brief.unwrap_or_default()))
    }
}

/// Returns a machine by name or file with the brief of its design, and prints what was left out of the model of another
/// program.
///
/// # Errors
/// If there is no such machine, or it is not valid.
pub fn machine(name: &str) -> Result<MachineFile, Failure> {
    let FoundMachine { machine, design, .. } = found_machine(name)?;
    Ok(MachineFile { machine, design })
}

/// Returns a machine as [`machine`] does, with what else was found.
fn found_machine(name: &str) -> Result<FoundMachine, Failure> {
    let found = stillbase_files::found_machine(name)?;
    report_left_out(name, &found.left_out);
    Ok(found)
}

/// Returns the scenario of an assembly that a file holds, with settings changed; `None` for anything else. For an assembly
/// by itself, makes a motion for each block. Settings are those of the file, as `task.wrist.b`, or of a block, as
/// `wrist.payload.mass`.
///
/// # Errors
/// If the file, its assembly or a setting is wrong.
pub fn assembly_scenario(name: &str, settings: &Settings) -> Result<Option<AssemblyScenario>, Failure> {
    const OF_FILE: [&str; 8] = ["task", "base", "step", "duration", "lead", "scenario", "against", "tip"];
    let checked = |found: AssemblyScenario, of_file: &Settings| {
        refuse_without_effect(of_file, &|path| found.condition_for_effect(path))?;
        for (path, want) in found.ineffective_keys() {
            print_message(format!("note: {}: {path} has no use there: want {want}", found.name));
        }
        Ok(Some(found))
    };
    let is_of_file = |key: &str| OF_FILE.contains(&key.split('.').next().unwrap_or(key));
    let [of_file, of_blocks] = [true, false].map(|wanted| settings.of_keys(|key| is_of_file(key) == wanted));
    let apply = |assembly| of_blocks.apply_to_assembly(assembly, &OF_FILE);
    if let Some(found) = stillbase_files::assembly_scenario(name, &of_file.change(), apply)? {
        return checked(found, &of_file);
    }
    let Some(assembly) = stillbase_files::assembly(name)? else { return Ok(None) };
    let made = AssemblyScenario::for_assembly(apply(assembly)?)?;
    print_message(format!("note: {name}: a motion was made for each block of the assembly"));
    checked(made.with_changes(&of_file.change(), "--set")?, &of_file)
}

/// Returns a scenario by name or file, with settings changed, whose base floats.
///
/// # Errors
/// As [`scenario`], or if its base does not float.
pub fn floating_scenario(name: &str, settings: &Settings) -> Result<Scenario, Failure> {
    let found = scenario(name, settings)?;
    let why = || format!("--base {name}: its base does not float: want a scenario with [base] kind = \"free\"");
    if found.base.kind == BaseKind::Free { Ok(found) } else { Err(Failure::wrong_input(why())) }
}

/// Says which base a machine has that is taken as held, if a built-in scenario of its name has one that floats.
pub fn say_base_is_held(machine: &Machine) {
    if let Some(Scenario { name: afloat, .. }) = scenario_on_free_base(machine) {
        let name = machine.name();
        print_message(format!(
            "note: the base of {name} is held; --base {afloat} gives it the one of the scenario {afloat}, which floats"
        ));
    }
}

/// Prints what was left out of a file.
pub fn report_left_out(name: &str, notes: &[String]) {
    left_out(name, notes).for_each(|note| print_message(format!("note: {note}")));
}

/// Returns what was left out of a file, each with the name of the file.
pub fn left_out<'a>(file: &'a str, notes: &'a [String]) -> impl Iterator<Item = String> + 'a {
    let file = if file == STANDARD_INPUT { "standard input" } else { file };
    notes.iter().map(move |note| format!("{file}: {note}"))
}

/// Returns a distinct name for each of some things, given as the command line calls each and by its own name. Those of one
/// name are told apart by their files, or by the paths of these; the same thing once more has a number.
pub fn distinct_names(all: &[(&str, &str)]) -> Vec<String> {
    let mut names: Vec<String> = all.iter().map(|(_, own)| (*own).to_owned()).collect();
    let stem = |called: &Path| called.file_stem().map(Path::new).unwrap_or(called).to_path_buf();
    let whole = |called: &Path| called.with_file_name(stem(called));
    for telling in [&stem as &dyn Fn(&Path) -> PathBuf, &whole] {
        let before = names.clone();
        for (name, (called, _)) in names.iter_mut().zip(all).filter(|(_, (called, _))| *called != STANDARD_INPUT) {
            // A path does not tell the same file once more.
            if before.iter().zip(all).any(|(other, (elsewhere, _))| other == name && elsewhere != called) {
                *name = telling(Path::new(called)).display().to_string();
            }
        }
    }
    let mut distinct: Vec<String> = Vec::new();
    for name in names {
        let numbered = (2..).map(|count| format!("{name}-{count}"));
        let free = std::iter::once(name.clone()).chain(numbered).find(|name| !distinct.contains(name));
        distinct.push(free.unwrap_or(name));
    }
    distinct
}

/// Returns a scenario by name or file, with settings changed before anything is planned, for a command that samples no
/// machines. Prints a note if the scenario has tolerances.
///
/// # Errors
/// As [`overlay_for_study`], or if a setting is a tolerance.
pub fn scenario(name: &str, settings: &Settings) -> Result<Scenario, Failure> {
    let scenario = overlay_for_study(name, settings)?;
    settings.refuse_tolerances()?;
    report_tolerance(&scenario);
    Ok(scenario)
}

/// Does the same as [`scenario`], and takes assemblies: then the scenario is that of the block which is led.
///
/// # Errors
/// As [`scenario`], and if the scenario of an assembly is wrong.
pub fn scenario_of_any(name: &str, settings: &Settings) -> Result<Scenario, Failure> {
    match assembly_scenario(name, settings)? {
        Some(whole) => Ok(whole.leading(whole.lead)),
        None => scenario(name, settings),
    }
}

/// Returns a run of a scenario, whose motion serves other machines as a task.
///
/// # Errors
/// If the scenario has no plan, or if none of the machines has as many drives as its own.
pub fn task_run(name: &str, machines: &[&Machine]) -> Result<Run, Failure> {
    let run = Run::new(&with_start_edits(&scenario(name, &Settings::default())?)?.0)?;
    let has = run.scenario().machine.drives();
    let mut want: Vec<String> = machines.iter().map(|machine| machine.drives().to_string()).collect();
    want.dedup();
    match machines.iter().any(|machine| machine.drives() == has) {
        true => Ok(run),
        false => Err(Failure::wrong_input(format!(
            "--task {name}: its machine has {}: want one of {}",
            counted(has, "drive"),
            want.join(" or ")
        ))),
    }
}

/// Prints a note if a scenario has tolerances, which have no effect in a command that samples no machines.
pub fn report_tolerance(scenario: &Scenario) {
    if !scenario.tolerance.is_empty() {
        print_message(format!("note: {}: tolerance has no use here: want {STUDY}", scenario.name));
    }
}

/// The uses that tolerances have, for messages.
const STUDY: &str = "the command tolerance, or the window";

/// Returns a scenario by name or file, with settings changed before anything is planned. Refuses settings without an
/// effect.
///
/// # Errors
/// If there is no such scenario or setting, or the result is not valid.
pub fn overlay_for_study(name: &str, settings: &Settings) -> Result<Scenario, Failure> {
    let scenario = overlay_unchecked(name, settings)?;
    refuse_ineffective(&scenario, settings)?;
    report_idle(&scenario);
    Ok(scenario)
}

/// Does the same as [`overlay_for_study`], and takes assemblies: then the scenario is that of the block which is led.
///
/// # Errors
/// As [`overlay_for_study`], and if the scenario of an assembly is wrong.
#[cfg(feature = "ui")]
pub fn overlay_of_any(name: &str, settings: &Settings) -> Result<Scenario, Failure> {
    match assembly_scenario(name, settings)? {
        Some(whole) => Ok(whole.leading(whole.lead)),
        None => overlay_for_study(name, settings),
    }
}

/// Does the same as [`overlay_for_study`], but accepts settings without an effect: other arguments may give them one.
///
/// # Errors
/// As [`overlay_for_study`], except for settings without an effect.
pub fn overlay_unchecked(name: &str, settings: &Settings) -> Result<Scenario, Failure> {
    let found = stillbase_files::scenario(name)?;
    let notes = found.note.iter().cloned().chain(left_out(name, &found.left_out));
    notes.for_each(|note| print_message(format!("note: {note}")));
    overlay_settings(found.scenario, settings)
}

/// Prints which keys of a scenario have no effect, and whether its wheel hardly damps the base.
pub fn report_idle(scenario: &Scenario) {
    let wheel = scenario.base.wheel.filter(|_| scenario.base.kind == BaseKind::Free);
    if let Some(why) = wheel.and_then(|wheel| wheel.poor_gains()) {
        print_message(format!("note: {}: {why}", scenario.name));
    }
    for (path, want) in scenario.ineffective_keys() {
        print_message(format!("note: {}: {path} has no use there: want {want}", scenario.name));
    }
}

/// Returns a scenario with settings changed.
///
/// # Errors
/// If there is no such setting, it has no effect, or the result is not valid.
pub fn overlay_used(scenario: Scenario, settings: &Settings) -> Result<Scenario, Failure> {
    let scenario = overlay_settings(scenario, settings)?;
    refuse_ineffective(&scenario, settings)?;
    Ok(scenario)
}

/// Returns a scenario with settings changed, whether or not they have an effect.
///
/// # Errors
/// If there is no such setting, or the result is not valid.
pub fn overlay_settings(scenario: Scenario, settings: &Settings) -> Result<Scenario, Failure> {
    let wanted = settings.change();
    let refused = |failure: Failure| match wanted.is_empty() {
        true => failure,
        false => failure.with_proposals(proposals_for_settings(&scenario, &wanted)),
    };
    let changed =
        scenario.with_settings(&wanted).map_err(|why| refused(Failure::wrong_input(why).with_context("--set")))?;
    changed.check("--set").map_err(|why| refused(why.into()))?;
    if !settings.sets("task.start") {
        report_start(&scenario.task, &changed.task);
    }
    Ok(changed)
}

/// Refuses settings that have no effect on the scenario.
///
/// # Errors
/// If there is such a setting; the error names the condition for an effect.
pub fn refuse_ineffective(scenario: &Scenario, settings: &Settings) -> Result<(), Failure> {
    refuse_without_effect(settings, &|path| scenario.condition_for_effect(path))
}

/// Refuses settings that have no effect; `condition` returns the condition for an effect of a key that has none.
fn refuse_without_effect(settings: &Settings, condition: &dyn Fn(&str) -> Option<&'static str>) -> Result<(), Failure> {
    for (path, value) in change::leaves(&settings.change()) {
        let freed = value.as_str().is_some_and(|word| [change::DEFAULT_WORD, Key::NONE].contains(&word));
        if let Some(want) = condition(&path).filter(|_| !freed) {
            return Err(no_use(&path, want).with_context("--set"));
        }
    }
    Ok(())
}

/// Returns the failure of an option that has no effect here.
pub fn no_use(what: &str, want: &str) -> Failure {
    Failure::wrong_input(format!("{what} has no use here: want {want}"))
}

/// Changes keys of a scenario's task.
///
/// # Errors
/// If there is no such key, or its value is out of range.
pub fn change_task(scenario: &mut Scenario, change: &TaskChange) -> Result<(), Failure> {
    if !change.is_empty() {
        let task = scenario.task.with_change(change, &scenario.machine);
        let task = task.map_err(|why| Failure::wrong_input(format!("task: {why}")))?;
        scenario.task = task;
        scenario.check("task")?;
    }
    Ok(())
}

/// Prints a note if a change of a task has dropped its start.
fn report_start(before: &Task, after: &Task) {
    if before.start.is_some() && after.start.is_none() {
        print_message("note: another A or b has another pose, so task.start is left out");
    }
}

/// Returns the pose space of a machine. Prints a note if b is only nearly constant.
///
/// # Errors
/// If the machine has none.
pub fn pose_space(machine: &Machine) -> Result<PoseSpace, Failure> {
    let space =
        PoseSpace::of(machine).map_err(|why| Failure::from(why).with_proposals(proposals_for_machine(machine)))?;
    if let nearly @ PoseConstant::Nearly { .. } = PoseConstant::of(machine) {
        print_message(format!("note: {}: {nearly}", machine.name()));
    }
    Ok(space)
}

/// Returns the command line with a space before negative numbers and points, such as `-0.5,0.25`, so that they are not
/// parsed as options. No option begins with a digit. A `--quiet` before the command stands after it, where it is parsed.
pub fn words(words: impl Iterator<Item = OsString>) -> impl Iterator<Item = OsString> {
    let mut words: Vec<OsString> = words.collect();
    if words.len() > 2 && words[1] == "--quiet" {
        words.swap(1, 2);
    }
    words.into_iter().map(|word| match word.to_str().map(str::as_bytes) {
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

/// A word of the command line that is no number in its range.
#[derive(Debug)]
pub struct WrongNumber {
    /// What is expected.
    want: String,
    /// The nearest word that is allowed, if the given one is a number.
    pub nearest: Option<String>,
}

impl fmt::Display for WrongNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.want)
    }
}

impl std::error::Error for WrongNumber {}

/// Parses a point X,Y, m.
pub fn point(text: &str) -> Result<Vector, WrongNumber> {
    let numbers = || text.split_once(',').and_then(|(x, y)| Some([number(x)?, number(y)?]));
    match numbers() {
        Some([x, y]) if POINT_RANGE.contains(x) && POINT_RANGE.contains(y) => Ok(Vector::new(x, y)),
        numbers => Err(WrongNumber {
            want: format!("want X,Y in m, such as 0.5,-0.25, each {POINT_RANGE}"),
            nearest: numbers.map(|both| both.map(|x| within(x, POINT_RANGE).to_string()).join(",")),
        }),
    }
}

/// Returns points, m, as a command line takes them, with those in their new places that `way` moves.
pub fn typed_points(points: &[Vector], way: &ReachablePoints) -> String {
    let typed = |(i, p): (usize, &Vector)| match way.place_of(i) {
        Some([x, y]) => format!("{x},{y}"),
        None => format!("{},{}", p.re, p.im),
    };
    points.iter().enumerate().map(typed).collect::<Vec<_>>().join(" ")
}

/// Parses a pose constant, rad.
pub fn pose_constant(text: &str) -> Result<f64, WrongNumber> {
    match number(text) {
        Some(b) if POSE_CONSTANT_RANGE.contains(b) => Ok(b),
        b => Err(WrongNumber {
            want: format!("want a number in rad, such as 2.4, {POSE_CONSTANT_RANGE}"),
            nearest: b.map(|b| within(b, POSE_CONSTANT_RANGE).to_string()),
        }),
    }
}

/// Parses a number other than NaN.
fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|x: &f64| !x.is_nan())
}

fn within(x: f64, range: Range) -> f64 {
    x.clamp(range.low(), range.high())
}

/// Parses a number above 0.
pub fn above_zero(text: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|x: &f64| *x > 0.0 && x.is_finite()).ok_or_else(|| "want a number above 0".into())
}

/// Reads a text file, whose name ends in one of `endings`.
///
/// # Errors
/// If it cannot be read; the error names the nearest file if there is no such file.
pub fn read(file: &Path, endings: &[&str]) -> Result<String, Failure> {
    stillbase_files::text::read(file).map_err(|e| unread(file, &e, endings))
}

/// Returns the failure to read a file, whose name ends in one of `endings`.
fn unread(file: &Path, error: &io::Error, endings: &[&str]) -> Failure {
    let misnamed = Misnamed::file(file, error, endings);
    let nearest = misnamed.as_ref().map_or_else(String::new, Misnamed::nearest_file);
    let why = format!("{error}: want a plain file that can be read, of at most {MAX_TEXT_BYTES} bytes{nearest}");
    Failure::wrong_input(why).with_context(file.display()).with_misnamed(misnamed)
}

/// Reads a table, CSV or Parquet by its ending, or CSV from standard input.
///
/// # Errors
/// As [`read`], or if it is no Parquet.
pub fn table(file: &Path) -> Result<Table, Failure> {
    Table::open(file).map_err(|why| match why {
        NoTable::Unread { source, .. } => unread(file, &source, TABLE_ENDINGS),
        NoTable::Wrong(why) => why.into(),
    })
}
