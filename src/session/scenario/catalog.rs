//! The scenarios that come with the program.

use std::sync::OnceLock;

use super::definition::Scenario;

/// Number of the paper's cases, which are the first scenarios of the list.
const CASE_COUNT: usize = 3;

/// The built-in scenarios: the paper's three cases, other kinds of tasks, plants and bases that are not ideal.
/// Every built-in machine except `nine-link` and `nine-link-table-1` has a scenario that bears its name.
const BUILTIN: [(&str, &str); 25] = [
    ("case-1", include_str!("../../../assets/scenarios/case-1.toml")),
    ("case-2", include_str!("../../../assets/scenarios/case-2.toml")),
    ("case-3", include_str!("../../../assets/scenarios/case-3.toml")),
    ("circle", include_str!("../../../assets/scenarios/circle.toml")),
    ("change-b", include_str!("../../../assets/scenarios/change-b.toml")),
    ("least-reaction", include_str!("../../../assets/scenarios/least-reaction.toml")),
    ("drift", include_str!("../../../assets/scenarios/drift.toml")),
    ("spacecraft", include_str!("../../../assets/scenarios/spacecraft.toml")),
    ("bench-top", include_str!("../../../assets/scenarios/bench-top.toml")),
    ("pick-up", include_str!("../../../assets/scenarios/pick-up.toml")),
    ("friction", include_str!("../../../assets/scenarios/friction.toml")),
    ("wheel", include_str!("../../../assets/scenarios/wheel.toml")),
    ("two-drive", include_str!("../../../assets/scenarios/two-drive.toml")),
    ("four-drive", include_str!("../../../assets/scenarios/four-drive.toml")),
    ("serial-3r", include_str!("../../../assets/scenarios/serial-3r.toml")),
    ("nine-link-geared", include_str!("../../../assets/scenarios/nine-link-geared.toml")),
    ("counter-rotating", include_str!("../../../assets/scenarios/counter-rotating.toml")),
    ("scara", include_str!("../../../assets/scenarios/scara.toml")),
    ("space-arm", include_str!("../../../assets/scenarios/space-arm.toml")),
    ("spot", include_str!("../../../assets/scenarios/spot.toml")),
    ("spot-swing", include_str!("../../../assets/scenarios/spot-swing.toml")),
    ("spot-turn", include_str!("../../../assets/scenarios/spot-turn.toml")),
    ("ets-vii", include_str!("../../../assets/scenarios/ets-vii.toml")),
    ("ets-vii-silent", include_str!("../../../assets/scenarios/ets-vii-silent.toml")),
    ("nine-link-bare", include_str!("../../../assets/scenarios/nine-link-bare.toml")),
];

/// The parsed scenarios; each is parsed at its first use.
static READ: [OnceLock<Scenario>; BUILTIN.len()] = [const { OnceLock::new() }; BUILTIN.len()];

impl Scenario {
    /// Returns the names of the built-in scenarios, the paper's cases first.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        BUILTIN.iter().map(|(name, _)| *name)
    }

    /// Returns the names of the paper's cases.
    pub fn cases() -> impl Iterator<Item = &'static str> {
        Self::builtin_names().take(CASE_COUNT)
    }

    /// Returns the built-in scenarios, the paper's cases first.
    pub fn builtins() -> impl Iterator<Item = &'static Self> {
        (0..BUILTIN.len()).map(read)
    }

    /// Returns a built-in scenario by its name.
    pub fn builtin(name: &str) -> Option<Self> {
        Self::builtin_names().position(|own| own == name).map(|place| read(place).clone())
    }
}

fn read(place: usize) -> &'static Scenario {
    let (name, text) = BUILTIN[place];
    READ[place].get_or_init(|| Scenario::parse(text, name, None).expect("the scenarios that come along are valid"))
}
