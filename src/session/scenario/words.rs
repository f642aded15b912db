//! The keys of scenario files in words: plain names, what would be right, and examples.

use super::keys::key_of;
use super::names::name_of;
use stillbase_mechanics::machine::{KeyPath, KeyStep, MachineWords};
use stillbase_settings::key::{Key, KeyType};
use stillbase_settings::mending::{Meant, Vocabulary};
use stillbase_settings::word_row::{WordRow, WordTable, row};

/// The words of scenario files.
pub(crate) struct ScenarioWords;

const A_BAR: &str = "the number of a bar in the drawing";
const A_PIN: &str = "the number of a pin in the drawing";
const A_DRIVE: &str = "the name of a drive in quotes";
const AN_END: &str = "{ pin = 3 }, { bar = 2, along = 0.1 } or [0.3, 0.1], in m; of a hand-over, the name of a block";

/// What is no setting, or is a setting that a file has to state; `*` in an edit is its number.
const STATED: &[WordRow] = &[
    row("name", "name of the scenario", "", "\"my-task\""),
    row("title", "title", "", "\"My task\""),
    row("summary", "summary", "", "\"From A to B\""),
    row("machine", "machine", "", "\"nine-link\""),
    row("set", "settings of the machine", "", "[\"payload.mass=0.5\"]"),
    row("set.*", "setting of the machine", "", ""),
    row("task", "task", "", "{ kind = \"reactionless\", from = [0.5, 0.5], to = [0.55, 0.9], b = 2.4, time = 1.0 }"),
    row("task.kind", "kind of motion", "", "\"reactionless\""),
    row("task.from", "point A", "", "[0.5, 0.5]"),
    row("task.to", "point B", "", "[0.55, 0.9]"),
    row("task.b", "pose constant at A", "", "2.4"),
    row("plant", "plant", "", "{ force = [0.0, 0.0] }"),
    row("sketch", "drawing", "", ""),
    row("tolerance", "table of tolerances", "", ""),
    row("design", "brief of the design", "a table of settings", "{ clearance = 0.005 }"),
    row("edit.*.step", "step of edit *", "a whole number of steps since the start, 0 to 4000000", "0"),
    row("edit.*.do", "kind of edit *", "", "\"slide-b\""),
    row("edit.*.x", "x of edit *", "a number in m, or in N for a push", "0.5"),
    row("edit.*.y", "y of edit *", "a number in m, or in N for a push", "0.5"),
    row("edit.*.a1", "first joint angle of edit *", "an angle in rad", "1.2"),
    row("edit.*.a2", "second joint angle of edit *", "an angle in rad", "1.2"),
    row("edit.*.b", "pose constant of edit *", "an angle in rad", "2.4"),
    row("edit.*.link", "link of edit *", "the name of a link in quotes", "\"5\""),
    row("edit.*.along", "distance from the root in edit *", "a number in m", "0.1"),
    row("edit.*.change", "settings of edit *", "a table of settings", "{ plant = { payload = { mass = 0.3 } } }"),
    row("edit.*.draw", "step of drawing in edit *", "", "\"length\""),
    row("edit.*.template", "drawing that edit * begins with", "", "\"blank\""),
    row("edit.*.bar", "bar of edit *", A_BAR, "1"),
    row("edit.*.with", "other bar of edit *", A_BAR, "2"),
    row("edit.*.turns", "bar that the motor of edit * turns", A_BAR, "1"),
    row("edit.*.stator", "bar that carries the motor of edit *", A_BAR, "1"),
    row("edit.*.pin", "pin of edit *", A_PIN, "1"),
    row("edit.*.onto", "pin that stays in edit *", A_PIN, "1"),
    row("edit.*.moves", "pin that moves in edit *", A_PIN, "1"),
    row("edit.*.corners", "corners of edit *", "the numbers of four pins", "[1, 2, 3, 4]"),
    row("edit.*.drive", "drive of edit *", A_DRIVE, "\"1\""),
    row("edit.*.metres", "length of edit *", "a number in m", "0.3"),
    row("edit.*.radians", "angle of edit *", "an angle in rad", "1.57"),
    row("edit.*.inertia", "rotor inertia of edit *", "a number in kg m²", "1e-4"),
    row("edit.*.ratio", "gear ratio of edit *", "a number", "50"),
    row("edit.*.offset", "offset of edit *", "an angle in rad", "0.0"),
    row("edit.*.range", "limits of edit *", "two angles in rad", "[0.2, 2.9]"),
    row("edit.*.name", "name in edit *", "a text in quotes", "\"arm\""),
    row("edit.*.parts", "parts of edit *", "a list of parts", ""),
    row("edit.*.lumps", "lumps of edit *", "a list of lumps", ""),
    row("edit.*.body", "mass of edit *", "a table", "{ mass = 1.2 }"),
    row("edit.*.per_metre", "mass per metre of edit *", "a number in kg/m", "1.0"),
    // A new bar and a moved pin have an end and a place, limits have drives.
    row("edit.*.from", "beginning of edit *", AN_END, ""),
    row("edit.*.to", "end of edit *", AN_END, ""),
];

/// Lists of a session, each with the word for one entry.
const ENTRIES: [&str; 4] = ["edit", "bookmark", "note", "branch"];

const WORDS: WordTable = WordTable { rows: STATED, meant: &[] };

/// Returns the place within the machine that the scenario holds.
fn in_machine(path: &KeyPath) -> Option<KeyPath> {
    match path.0.split_first()? {
        (KeyStep::Key(key), rest) if key == "machine" && !rest.is_empty() => Some(KeyPath(rest.to_vec())),
        _ => None,
    }
}

/// Returns the setting at a place; positions in lists belong to their setting.
fn setting(path: &KeyPath) -> Option<(String, &'static Key)> {
    let word = |step: &KeyStep| match step {
        KeyStep::Key(key) => Some(key.clone()),
        KeyStep::At(_) | KeyStep::Named(..) => None,
    };
    let key = path.0.iter().map(word).collect::<Option<Vec<_>>>()?.join(".");
    key_of(&key).map(|known| (key, known))
}

impl Vocabulary for ScenarioWords {
    fn name(&self, path: &KeyPath) -> Option<String> {
        if let Some(inner) = in_machine(path) {
            return MachineWords.name(&inner);
        }
        if let [KeyStep::Key(list), KeyStep::At(i)] = &path.0[..]
            && ENTRIES.contains(&list.as_str())
        {
            return Some(format!("{list} {}", i + 1));
        }
        WORDS.name(path).or_else(|| setting(path).map(|(key, _)| name_of(&key)))
    }

    fn want(&self, path: &KeyPath) -> Option<String> {
        if let Some(inner) = in_machine(path) {
            return MachineWords.want(&inner);
        }
        WORDS.want(path).or_else(|| setting(path).map(|(_, key)| key.value_type.to_string()))
    }

    fn example(&self, path: &KeyPath) -> Option<&'static str> {
        if let Some(inner) = in_machine(path) {
            return MachineWords.example(&inner);
        }
        if let Some(example) = WORDS.example(path) {
            return Some(example);
        }
        let (_, key) = setting(path)?;
        match key.value_type {
            KeyType::Number(_) | KeyType::Whole(_) | KeyType::Switch => {
                Some(key.default).filter(|default| ![Key::REQUIRED, Key::NONE].contains(default))
            }
            KeyType::Spread(_) => Some("{ normal = 0.0005 }"),
            _ => None,
        }
    }

    fn meant(&self, path: &KeyPath) -> Option<Meant> {
        in_machine(path).and_then(|inner| MachineWords.meant(&inner))
    }
}
