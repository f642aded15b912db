//! Every key of a scenario of an assembly that is none of a block.

use super::stated_base::StatedBase;
use super::tip::TipPath;
use crate::scenario::{MAX_TIME, STEP_RANGE};
use stillbase_settings::key::{Effect, Key, KeyType};
use stillbase_settings::range::Range;

/// Range of the duration.
const DURATION: Range = Range::new(1e-3, MAX_TIME, "s");

/// Step where none is stated, s.
pub(super) const USUAL_STEP: f64 = 1e-3;

const OWN: [Key; 4] = [
    Key::number("step", STEP_RANGE, "0.001", "Fixed step of the simulation, of all blocks."),
    Key::number("duration", DURATION, Key::NONE, "Time that a run covers.").instead("that of the longest task"),
    Key::new("lead", KeyType::Names(1), Key::NONE, "Block that the window leads first, by its name.")
        .instead("the first block"),
    Key::new(
        "against",
        KeyType::Names(2),
        Key::NONE,
        "Two blocks with parallel planes: the second changes its b against the first's, so that no moment is left.",
    )
    .instead("each block holds or changes its own b"),
];

// All keys change the plan.
const ALL: [Key; OWN.len()] = Key::all_reaching(Effect::Plan, &OWN);
const TIP: [Key; TipPath::KEYS.len()] = Key::all_reaching(Effect::Plan, TipPath::KEYS);
const BASE: [Key; StatedBase::KEYS.len()] = Key::all_reaching(Effect::Plan, StatedBase::KEYS);

/// Every key of a scenario of an assembly, part by part, but for those of blocks: `task.BLOCK.KEY` is the key `task.KEY` of
/// a scenario of one machine, and `scenario.BLOCK.KEY` another of its keys.
pub const ASSEMBLY_KEYS: [(&str, &[&[Key]]); 3] = [
    ("Scenario of an assembly", &[&ALL]),
    ("Path in space, of an assembly", &[&TIP]),
    ("Base of an assembly", &[&BASE]),
];

/// Returns the key of a path, such as `tip.b.arm`, in a scenario of an assembly.
pub fn assembly_key_of(path: &str) -> Option<&'static Key> {
    ASSEMBLY_KEYS.iter().flat_map(|(_, keys)| keys.iter().copied().flatten()).find(|key| key.matches(path))
}
