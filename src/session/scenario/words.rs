//! The keys of scenario files in words: plain names, what would be right, and examples.

use super::keys::key_of;
use super::names::name_of;
use stillbase_mechanics::machine::{KeyPath, KeyStep, MachineWords};
use stillbase_settings::key::{Key, KeyType};
use stillbase_settings::mending::{Meant, Vocabulary};

/// The words of scenario files.
pub(super) struct ScenarioWords;

/// Plain names and examples of what is no setting, or is a setting that a file has to state.
const STATED: &[(&str, &str, &str)] = &[
    ("name", "name of the scenario", "\"my-task\""),
    ("title", "title", "\"My task\""),
    ("summary", "summary", "\"From A to B\""),
    ("machine", "machine", "\"nine-link\""),
    ("set", "settings of the machine", "[\"payload.mass=0.5\"]"),
    ("set.*", "setting of the machine", ""),
    ("task", "task", "{ kind = \"reactionless\", from = [0.5, 0.5], to = [0.55, 0.9], b = 2.4, time = 1.0 }"),
    ("task.kind", "kind of motion", "\"reactionless\""),
    ("task.from", "point A", "[0.5, 0.5]"),
    ("task.to", "point B", "[0.55, 0.9]"),
    ("task.b", "pose constant at A", "2.4"),
    ("plant", "plant", "{ force = [0.0, 0.0] }"),
    ("sketch", "drawing", ""),
];

/// Lists of a session, each with the word for one entry.
const ENTRIES: [&str; 4] = ["edit", "bookmark", "note", "branch"];

fn stated(path: &KeyPath) -> Option<&'static (&'static str, &'static str, &'static str)> {
    STATED.iter().find(|(pattern, ..)| path.fits(pattern))
}

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
        let listed = stated(path).map(|(_, name, _)| (*name).to_owned());
        listed.or_else(|| setting(path).map(|(key, _)| name_of(&key)))
    }

    fn want(&self, path: &KeyPath) -> Option<String> {
        if let Some(inner) = in_machine(path) {
            return MachineWords.want(&inner);
        }
        setting(path).map(|(_, key)| key.value_type.to_string())
    }

    fn example(&self, path: &KeyPath) -> Option<&'static str> {
        if let Some(inner) = in_machine(path) {
            return MachineWords.example(&inner);
        }
        if let Some((.., example)) = stated(path).filter(|(.., example)| !example.is_empty()) {
            return Some(example);
        }
        let (_, key) = setting(path)?;
        match key.value_type {
            KeyType::Number(_) | KeyType::Whole(_) | KeyType::Switch => {
                Some(key.default).filter(|default| ![Key::REQUIRED, Key::NONE].contains(default))
            }
            _ => None,
        }
    }

    fn meant(&self, path: &KeyPath) -> Option<Meant> {
        in_machine(path).and_then(|inner| MachineWords.meant(&inner))
    }
}
