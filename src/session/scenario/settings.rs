//! The settings of a scenario as one tree: a file without name, title, summary, edits, bookmarks, notes and branches.

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};

use super::bounds::STEP_RANGE;
use super::choices::TaskKind;
use super::definition::Scenario;
use super::keys::{SCENARIO_TABLES, key_of, keys};
use super::names::with_name;
use super::own::ScenarioSettings;
use super::task::Task;
use super::tolerance::Tolerance;
use super::words::ScenarioWords;
use stillbase_mechanics::machine::{self, KeyPath, MACHINE_TABLES, is_of_machine};
use stillbase_planning::curves::Samples;
use stillbase_settings::change::{self, DEFAULT_WORD};
use stillbase_settings::key::{self, Effect, Key, KeyType};
use stillbase_settings::mending::Problem;
use stillbase_settings::range::{RangeCheck, quote_clipped};
use stillbase_simulation::control::sampling_check;
use stillbase_simulation::plant::BaseKind;

/// Reason why settings cannot be applied to a scenario.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SettingError {
    /// A part of the scenario is not valid.
    #[error("{part}: {why}")]
    Part {
        /// Name of the part, such as `plant`.
        part: String,
        /// Description of the error, and of valid values.
        why: String,
    },
    /// A message that names the key.
    #[error("{0}")]
    Said(String),
    /// A value that a key does not accept.
    #[error("{} is {value:?}: want {want}", with_name(path))]
    Value {
        /// The key.
        path: String,
        /// The value that was given.
        value: String,
        /// Allowed values.
        want: String,
    },
    /// The machine would not be valid.
    #[error(transparent)]
    Machine(#[from] machine::MachineError),
    /// There is no such key.
    #[error("there is no setting {key}: want one of {}, {}", ScenarioSettings::KEYS.iter().map(|key| key.path).collect::<Vec<_>>().join(", "), SCENARIO_TABLES.iter().chain(&MACHINE_TABLES).map(|part| format!("{part}…")).collect::<Vec<_>>().join(", "))]
    Unknown {
        /// The key.
        key: String,
    },
}

impl Scenario {
    /// Returns the scenario with settings changed, as a file states them. The word `default` removes a key, and so does
    /// `none` if that is its default. [`check`](Self::check) tests whether all settings fit together. If the step size
    /// changes, edits keep their times.
    ///
    /// # Errors
    /// If a key or value is wrong; the error names it and states what is valid.
    pub fn with_settings(&self, change: &Table) -> Result<Self, SettingError> {
        let mut scenario = self.clone();
        let none = |value: &Value| value.as_str() == Some(Key::NONE);
        match change::leaves(change).into_iter().any(|(_, value)| none(value)) {
            true => scenario.apply_change(&none_as_default("", change))?,
            false => scenario.apply_change(change)?,
        }
        Ok(scenario)
    }

    fn apply_change(&mut self, change: &Table) -> Result<(), SettingError> {
        let (of_machine, own): (Table, Table) = change.clone().into_iter().partition(|(key, _)| is_of_machine(key));
        if !of_machine.is_empty() {
            let machine = self.machine.with_settings(&of_machine)?;
            self.sketch = self.sketch.as_ref().map(|sketch| sketch.following_machine(&self.machine, &machine));
            self.machine = machine;
            if let Some(task) = self.task.at_its_start(&self.machine) {
                self.task = task;
            }
        }
        for (part, value) in &own {
            let wrong = |why: String| {
                first_value_error(part, value).unwrap_or_else(|| match why {
                    // The part has said so with the names of its keys.
                    why if why.contains(&format!("{part}.")) => SettingError::Said(why),
                    why if why.starts_with("unknown field") => {
                        SettingError::Said(Problem::said(table_of(part, value, &why), &why).text(&ScenarioWords))
                    }
                    why => SettingError::Part { part: part.clone(), why },
                })
            };
            match (part.as_str(), value) {
                ("task", Value::Table(change)) => {
                    self.task = self.task.with_change(change, &self.machine).map_err(wrong)?
                }
                ("task", Value::String(word)) if word == DEFAULT_WORD => {
                    let why = "a task as a whole has no usual value: want that of a key, such as task.time=default";
                    return Err(SettingError::Part { part: part.clone(), why: why.into() });
                }
                ("task", _) => return Err(wrong("want its keys with their values".into())),
                ("control", _) => self.control = part_with_change(&self.control, value).map_err(wrong)?,
                ("plant", _) => self.plant = part_with_change(&self.plant, value).map_err(wrong)?,
                ("base", _) => self.base = part_with_change(&self.base, value).map_err(wrong)?,
                ("tolerance", Value::Table(change)) => {
                    self.tolerance = change::with_changes(&self.tolerance, &Tolerance::flat(change)).map_err(wrong)?;
                }
                ("design", _) => self.design = part_with_change(&self.design, value).map_err(wrong)?,
                ("tolerance", _) => self.tolerance = part_with_change(&self.tolerance, value).map_err(wrong)?,
                _ => {
                    let unknown = || SettingError::Unknown { key: quote_clipped(part) };
                    let key = ScenarioSettings::KEYS.iter().find(|key| key.path == part).ok_or_else(unknown)?;
                    let given = number(value, key).map_err(wrong)?;
                    self.lay_own(part, given).map_err(wrong)?;
                }
            }
        }
        Ok(())
    }

    /// Returns the keys that belong to no part.
    fn own(&self) -> ScenarioSettings {
        let Self { step, duration, pose_acceleration, compare_b, .. } = *self;
        ScenarioSettings { step, duration, pose_acceleration, compare_b }
    }

    /// Sets a key that belongs to no part to a number, or to its default if no number is given.
    fn lay_own(&mut self, part: &str, given: Option<f64>) -> Result<(), String> {
        let mut stated = Table::try_from(self.own()).map_err(|why| why.to_string())?;
        match given {
            Some(x) => drop(stated.insert(part.to_owned(), x.into())),
            None => drop(stated.remove(part)),
        }
        let ScenarioSettings { step, duration, pose_acceleration, compare_b } = change::read(&stated)?;
        if part == "step" {
            self.step_by(step);
        }
        (self.duration, self.pose_acceleration, self.compare_b) = (duration, pose_acceleration, compare_b);
        Ok(())
    }

    /// Sets the step size, s; edits keep their times.
    fn step_by(&mut self, step: f64) {
        // Step numbers of edits refer to the last step size that an edit sets.
        let own = self.edits.iter().rev().find_map(|timed| timed.edit.own_number("step")).unwrap_or(self.step);
        self.edits.retain_mut(|timed| timed.edit.take_key("step").is_none() || !timed.edit.sets_nothing());
        let ratio = own / step;
        if ratio != 1.0 {
            self.edits.iter_mut().for_each(|edit| edit.step = (edit.step as f64 * ratio).round() as u64);
        }
        self.step = step;
    }

    /// Returns the present values of the keys of a change, with which [`with_settings`](Self::with_settings) undoes it.
    /// Returns `None` if a part, or a key of the machine, does not exist.
    pub fn present_values(&self, change: &Table) -> Option<Table> {
        let (of_machine, mut own): (Table, Table) = change.clone().into_iter().partition(|(key, _)| is_of_machine(key));
        let known = |part: &String| {
            SCENARIO_TABLES.contains(&part.as_str()) || ScenarioSettings::KEYS.iter().any(|key| key.path == part)
        };
        if !own.keys().all(known) {
            return None;
        }
        if let Some(Value::Table(tolerance)) = own.get_mut("tolerance") {
            *tolerance = Tolerance::flat(tolerance);
        }
        if let Some(Value::Table(task)) = own.get_mut("task") {
            self.task.name_linked_keys(task);
        }
        let mut stated = self.stated();
        // Samples may be long, so they are added only if they change.
        if change::leaves(&own).iter().any(|(path, _)| path == "task.samples") {
            stated.insert("task".into(), Table::try_from(&self.task).ok()?.into());
        }
        let mut now = change::present_values(&stated, &own);
        for path in self.machine.settings_to_undo(&of_machine) {
            now = change::join(now, &change::single_change(&path, self.machine.value(&path)?));
        }
        Some(now)
    }

    /// Returns the scenario's settings as a file states them, without machine, samples and edits.
    fn stated(&self) -> Table {
        let task = if self.task.samples.is_some() {
            Table::try_from(&Task { samples: None, ..self.task.clone() })
        } else {
            Table::try_from(&self.task)
        };
        let parts = [
            ("task", task),
            ("control", Table::try_from(self.control)),
            ("plant", Table::try_from(&self.plant)),
            ("base", Table::try_from(self.base)),
            ("tolerance", Table::try_from(&self.tolerance)),
            ("design", Table::try_from(&self.design)),
        ];
        let mut all: Table =
            parts.into_iter().filter_map(|(part, table)| Some((part.to_owned(), Value::Table(table.ok()?)))).collect();
        all.extend(Table::try_from(self.own()).unwrap_or_default());
        all
    }

    /// Returns the present value of a setting, or the word `default` if it has none. Returns `None` if there is no such
    /// key.
    pub fn value(&self, path: &str) -> Option<Value> {
        self.value_in(&self.stated(), path)
    }

    fn value_in(&self, stated: &Table, path: &str) -> Option<Value> {
        if is_of_machine(path) {
            return self.machine.value(path);
        }
        let key = key_of(path)?;
        let found = match path.strip_prefix("tolerance.") {
            // A key of this part is a single word with dots.
            Some(key) => stated.get("tolerance").and_then(|part| part.get(key)),
            None => {
                let (first, rest) = path.split_once('.').unwrap_or((path, ""));
                let rest = rest.split('.').filter(|part| !part.is_empty());
                rest.fold(stated.get(first), |now, part| now.and_then(|now| now.get(part)))
            }
        };
        Some(match found {
            Some(value) => value.clone(),
            None if [Key::NONE, Key::REQUIRED].contains(&key.default) => DEFAULT_WORD.into(),
            None => change::value(key.default),
        })
    }

    /// Returns every setting of this scenario with its key and its value; each matching name of the machine replaces
    /// `*`.
    pub fn settings(&self) -> Vec<(String, &'static Key, Value)> {
        let spec = self.machine.spec();
        let names = |pattern: &str| -> Vec<String> {
            match pattern.split(".*").next().unwrap_or_default() {
                "link" | "plant.link" | "design.fixed" | "design.hold.link" => {
                    spec.links.iter().map(|link| link.name.clone()).collect()
                }
                "counterweight" | "design.hold.counterweight" => {
                    (1..=spec.counterweights.len()).map(|number| number.to_string()).collect()
                }
                "part" => (1..=spec.parts.len()).map(|number| number.to_string()).collect(),
                "lump" => (1..=spec.lumps.len()).map(|number| number.to_string()).collect(),
                "material" => spec.materials.iter().map(|material| material.name.clone()).collect(),
                "length" | "plant.length" => spec.lengths.keys().cloned().collect(),
                "limits" => spec.angles.iter().map(|angle| angle.name.clone()).collect(),
                "design.length" => spec.own_lengths().map(|(name, _)| name.to_owned()).collect(),
                "drive" | "design.ratio" => spec.drives.iter().map(|drive| drive.name.clone()).collect(),
                _ => vec!["*".into()],
            }
        };
        let stated = self.stated();
        let paths = keys().flat_map(|key| match key.path.contains('*') {
            true => names(key.path).into_iter().map(|name| (key.path.replacen('*', &name, 1), key)).collect(),
            false => vec![(key.path.to_owned(), key)],
        });
        paths.filter_map(|(path, key)| Some((path.clone(), key, self.value_in(&stated, &path)?))).collect()
    }

    /// Returns the condition for a key to have an effect, if it has no effect now.
    pub fn condition_for_effect(&self, path: &str) -> Option<&'static str> {
        let used = match path.split_once('.') {
            Some(("task", key @ ("posture" | "orientation"))) => self.machine.redundancy() > 1 && self.task.uses(key),
            Some(("task", key @ ("b" | "turn"))) if self.gives_two_drives() => key == "turn",
            Some(("task", key @ "turn_limit")) => {
                (2..=3).contains(&self.machine.drives()) && self.base.floats() && self.task.uses(key)
            }
            Some(("task", key)) => self.task.uses(key),
            Some(("base", key)) => match key.strip_prefix("wheel.") {
                Some("kp" | "kd" | "dead_band" | "rate") => self.base.kind == BaseKind::Free,
                _ => self.base.uses(key),
            },
            Some(("control", "knows_base")) => self.base.moves(),
            Some(("plant", key)) => key.strip_prefix("payload.").is_none_or(|key| self.plant.payload.uses(key)),
            Some(("design", key)) => self.design.has_effect(key, &self.machine),
            _ => self.machine.uses(path, self.is_pushed()),
        };
        if used { None } else { key_of(path).map(|key| key.when) }
    }

    /// Returns whether samples of two values are the angles of two drives.
    fn gives_two_drives(&self) -> bool {
        let samples = self.task.samples.as_ref().map(Samples::columns);
        samples == Some(2) && samples == Some(self.machine.drives()) && self.task.kind == TaskKind::Given
    }

    /// Returns whether a force is held at the end effector at any time.
    fn is_pushed(&self) -> bool {
        self.plant.force != [0.0; 2] || self.edits.iter().any(|timed| timed.edit.pushes())
    }

    /// Returns the given keys that have no effect, each with the condition for an effect. Keys that files always state
    /// are omitted.
    pub fn ineffective_keys(&self) -> Vec<(String, &'static str)> {
        const ALWAYS_STATED: [&str; 7] =
            ["task.kind", "task.from", "task.to", "task.b", "task.time", "task.law", "control.knows_base"];
        let stated = self.stated();
        let of_machine = self.machine.ineffective_keys(self.is_pushed()).map(str::to_owned);
        let given = change::leaves(&stated).into_iter().map(|(path, _)| path);
        let is_elsewhere = self.task.kind == TaskKind::TurnBase && !self.task.returns_to_a();
        of_machine
            .chain(given)
            .filter(|path| !ALWAYS_STATED.contains(&path.as_str()) || (path == "task.to" && is_elsewhere))
            .filter_map(|path| self.condition_for_effect(&path).map(|want| (path, want)))
            .collect()
    }

    /// Checks every number against its range and against related numbers.
    pub(super) fn checks(&self) -> Vec<RangeCheck> {
        let n = self.machine.drives();
        let stated = self.stated();
        // A valid step size bounds some numbers more narrowly than their ranges do.
        let mut list = vec![STEP_RANGE.check("step", self.step)];
        if STEP_RANGE.contains(self.step) {
            list.extend(self.task.range_checks(self.step, self.machine.drives()));
            list.extend(self.control.range_checks(n, self.step));
            list.extend(self.base.wheel.map(|wheel| sampling_check("base.wheel.rate", wheel.rate, self.step)));
        }
        list.extend(key::checks(key_of, &stated));
        list.extend(self.plant.range_checks(n));
        list.extend(self.design.range_checks());
        list
    }

    /// Returns the scenario with those settings of another one on which no frame depends.
    ///
    /// # Errors
    /// If these settings cannot be applied.
    pub(crate) fn with_asides_of(&self, other: &Self) -> Result<Self, SettingError> {
        let asides = || keys().filter(|key| key.effect == Effect::NoFrame).map(|key| key.part().to_owned());
        let none: Table = asides().map(|part| (part, DEFAULT_WORD.into())).collect();
        let mut stated = other.stated();
        stated.retain(|part, _| asides().any(|aside| aside == *part));
        self.with_settings(&none)?.with_settings(&stated)
    }
}

/// Returns a part with settings changed; the word `default` removes all of its keys.
fn part_with_change<T: Serialize + DeserializeOwned + Default>(now: &T, value: &Value) -> Result<T, String> {
    match value {
        Value::Table(change) => change::with_changes(now, change),
        Value::String(word) if word == DEFAULT_WORD => Ok(T::default()),
        _ => Err(format!(
            "it is {}: want its keys with their values, or {DEFAULT_WORD}",
            quote_clipped(&value.to_string())
        )),
    }
}

/// Replaces `none` in a change by `default`, for keys whose default is `none`.
fn none_as_default(at: &str, change: &Table) -> Table {
    let none_as_default = |(key, value): (&String, &Value)| {
        let path = if at.is_empty() { key.clone() } else { format!("{at}.{key}") };
        let none = || key_of(&path).is_some_and(|key| key.default == Key::NONE);
        let value = match value {
            Value::Table(inner) => Value::Table(self::none_as_default(&path, inner)),
            Value::String(word) if word == Key::NONE && none() => DEFAULT_WORD.into(),
            value => value.clone(),
        };
        (key.clone(), value)
    };
    change.iter().map(none_as_default).collect()
}

/// Returns the table of a part that has a key which a reader does not know: the reader names the key alone.
fn table_of(part: &str, value: &Value, why: &str) -> KeyPath {
    let unknown = why.split('`').nth(1).unwrap_or_default();
    let leaves = change::single_change(part, value.clone());
    let mut above = change::leaves(&leaves).into_iter().filter_map(|(path, _)| {
        let words: Vec<&str> = path.split('.').collect();
        let at = words.iter().position(|word| *word == unknown).filter(|at| *at > 0)?;
        Some(KeyPath::of_key(&words[..at].join(".")))
    });
    above.next().unwrap_or_else(|| KeyPath::of(Some(part)))
}

/// Returns an error for the first value in a part that its key does not accept.
fn first_value_error(part: &str, value: &Value) -> Option<SettingError> {
    let whole = change::single_change(part, value.clone());
    change::leaves(&whole).into_iter().find_map(|(path, value)| {
        let said = |want: String| {
            let value = quote_clipped(&change::typed(value));
            Some(SettingError::Value { path: quote_clipped(&path), value, want })
        };
        match key_of(&path) {
            Some(key) if key.value_type.accepts(value) => None,
            Some(key) if key.unit().is_empty() || matches!(key.value_type, KeyType::Spread(_)) => {
                said(key.value_type.to_string())
            }
            Some(key) => said(format!("{} (a number without its unit)", key.value_type)),
            None => {
                let below = |key: &&Key| key.path.starts_with(&format!("{path}."));
                let below: Vec<&str> = keys().filter(below).map(|key| key.path).collect();
                if below.is_empty() { None } else { said(format!("a value for {}", below.join(", "))) }
            }
        }
    })
}

/// Reads a number of a key that belongs to no part; `None` for the word `default`.
fn number(value: &Value, key: &Key) -> Result<Option<f64>, String> {
    match value {
        Value::String(word) if word == DEFAULT_WORD => Ok(None),
        _ => change::number(value).map(Some).ok_or_else(|| {
            format!("it is {}: want a number, {}", quote_clipped(&change::typed(value)), key.value_type)
        }),
    }
}
