//! Every key of a scenario, and the effect of a change of it.

use toml::{Table, Value};

use super::design::{self, DesignBrief};
use super::own::ScenarioSettings;
use super::task::Task;
use super::tolerance;
use stillbase_mechanics::machine;
use stillbase_settings::change;
use stillbase_settings::key::{Effect, Key};
use stillbase_simulation::control::Control;
use stillbase_simulation::plant::{Base, Friction, LENGTH_KEYS, LinkDifference, Load, PlantDifferences, Wheel};

// Parts whose keys all change the plan, and parts on whose keys no frame depends.
const TASK: [Key; Task::KEYS.len()] = Key::all_reaching(Effect::Plan, Task::KEYS);
const BASE: [Key; Base::KEYS.len()] = Key::all_reaching(Effect::Plan, Base::KEYS);
const WHEEL: [Key; Wheel::KEYS.len()] = Key::all_reaching(Effect::Plan, Wheel::KEYS);
const TOLERANCE: [Key; tolerance::KEYS.len()] = Key::all_reaching(Effect::NoFrame, &tolerance::KEYS);
const DESIGN: [Key; DesignBrief::KEYS.len()] = Key::all_reaching(Effect::NoFrame, DesignBrief::KEYS);
const HELD: [Key; design::BOUND_KEYS.len()] = Key::all_reaching(Effect::NoFrame, &design::BOUND_KEYS);

/// Every key, part by part: the scenario's own, task, control, plant, base and wheel, machine, tolerance, design.
pub const KEYS: [(&str, &[&[Key]]); 9] = [
    ("The scenario itself", &[ScenarioSettings::KEYS]),
    ("Task", &[&TASK]),
    ("Control", &[Control::KEYS]),
    (
        "Plant: what differs in the machine that moves",
        &[PlantDifferences::KEYS, Load::KEYS, Friction::KEYS, LENGTH_KEYS, LinkDifference::KEYS],
    ),
    ("Base", &[&BASE]),
    ("Reaction wheel", &[&WHEEL]),
    ("Machine", &[&machine::KEYS]),
    ("Tolerances", &[&TOLERANCE]),
    ("Design: what is asked of a machine that is changed by hand", &[&DESIGN, &HELD]),
];

/// Returns every key.
pub fn keys() -> impl Iterator<Item = &'static Key> {
    KEYS.iter().flat_map(|(_, keys)| keys.iter().copied().flatten())
}

/// Returns the title of the part to which a key belongs.
pub fn part_of(key: &Key) -> &'static str {
    let of = KEYS.iter().find(|(_, tables)| tables.iter().any(|keys| keys.contains(key)));
    of.map_or("", |(part, _)| *part)
}

/// Returns the key of a path, such as `plant.link.5.com`.
pub fn key_of(path: &str) -> Option<&'static Key> {
    keys().find(|key| key.matches(path))
}

/// The parts of a scenario, other than its machine, that are separate tables in its file.
pub(super) const SCENARIO_TABLES: [&str; 6] = ["task", "control", "plant", "base", "tolerance", "design"];

/// Returns the effect of a change of settings: the largest effect of its keys.
pub fn effect_of(change: &Table) -> Effect {
    change.iter().map(|(part, value)| effect_in(part, value)).max().unwrap_or(Effect::NoFrame)
}

/// Returns the effect of a change of one part.
pub fn effect_in(part: &str, value: &Value) -> Effect {
    let of_part = || keys().filter(|key| key.part() == part).map(|key| key.effect);
    let most = of_part().max().unwrap_or(Effect::Motion);
    // If all keys of a part have the same effect, single keys need not be looked up.
    if of_part().all(|effect| effect == most) {
        return most;
    }
    let whole = change::single_change(part, value.clone());
    let effects = change::leaves(&whole).into_iter().map(|(path, _)| key_of(&path).map_or(most, |key| key.effect));
    effects.max().unwrap_or(most)
}
