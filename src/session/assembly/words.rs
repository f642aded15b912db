//! The keys of scenario files of assemblies in words.

use super::keys::assembly_key_of;
use crate::scenario::words::ScenarioWords;
use stillbase_mechanics::machine::{KeyPath, KeyStep};
use stillbase_settings::mending::{Meant, Vocabulary};
use stillbase_settings::range::quote_clipped;
use stillbase_settings::stated::StatedFile;
use stillbase_settings::word_row::{MeantRow, WordRow, WordTable, row};

const TEXT: &str = "a text in quotes";
const A_BLOCK: &str = "a text in quotes, the name of a block";
const PLACE: &str = "three numbers, m, in axes of the base";

const ROWS: &[WordRow] = &[
    row("name", "name of the scenario", TEXT, "\"my-task\""),
    row("title", "title", TEXT, "\"My task\""),
    row("summary", "summary", TEXT, "\"Two arms on one base\""),
    row("machine", "assembly", "the name or file of an assembly", "\"two-arms\""),
    row("lead", "block that is led", A_BLOCK, "\"BLOCK\""),
    row("against", "blocks that change b against each other", "the names of two blocks", "[\"BLOCK\", \"OTHER\"]"),
    row("step", "step", "", "0.001"),
    row("duration", "duration", "", "2.0"),
    row("task", "table of tasks", "a table [task.BLOCK] for each block that moves", ""),
    row("task.*", "task of block *", "a table", TASK),
    row("scenario", "table of settings of blocks", "a table [scenario.BLOCK] for each block that has some", ""),
    row("scenario.*", "table of settings of block *", "a table", "{ compare_b = 2.4 }"),
    row("tip", "path in space", "a table", "{ to = [0.45, 0.55, 0.1] }"),
    row("tip.block", "block of the path", A_BLOCK, "\"BLOCK\""),
    row("tip.from", "begin of the path", PLACE, "[0.45, 0.35, 0.09]"),
    row("tip.via", "points of the path", "points [[x, y, z], …], m, in axes of the base", "[[0.4, 0.52, 0.14]]"),
    row("tip.via.*", "point * of the path", PLACE, ""),
    row("tip.to", "end of the path", PLACE, "[0.45, 0.55, 0.1]"),
    row("tip.closed", "back to the begin", "true or false", "true"),
    row("tip.time", "duration of the path", "", "2.0"),
    row("tip.law", "time law of the path", "", "\"quintic\""),
    row("tip.choice", "choice for freedoms that are left", "", "\"least-rates\""),
    row("tip.b", "table of b on the path", "a table, as { BLOCK = 2.4 }", "{ BLOCK = 2.4 }"),
    row("tip.b.*", "b of block * on the path", "", "2.4"),
    row("base", "base", "a table", "{ kind = \"free\", mass = 60.0, inertia = [4.0, 5.0, 6.0] }"),
    row("base.kind", "how the base is held", "", "\"free\""),
    row("base.mass", "mass of the base", "", "60.0"),
    row(
        "base.inertia",
        "inertia of the base",
        "[x, y, z] about the centre of mass of the base, kg m², or nine numbers row by row, symmetric",
        "[4.0, 5.0, 6.0]",
    ),
    row("base.com", "centre of mass of the base", "three numbers, m", "[0.0, 0.0, -0.3]"),
    row("base.momentum", "momentum", "three numbers, kg m/s", "[0.0, 0.0, 0.0]"),
    row(
        "base.angular_momentum",
        "angular momentum",
        "three numbers, kg m²/s, about the common centre of mass",
        "[0.0, 0.0, 0.0]",
    ),
    row(
        "base.stiffness",
        "stiffness of the springs",
        "six numbers, along and about x, y, z, N/m and N m/rad, or all 36 row by row",
        "[2e4, 2e4, 2e4, 2e3, 2e3, 2e3]",
    ),
    row(
        "base.damping",
        "damping of the dampers",
        "six numbers, along and about x, y, z, N s/m and N m s, or all 36 row by row",
        "[200, 200, 200, 10, 10, 10]",
    ),
];

const TASK: &str = "{ kind = \"reactionless\", from = [0.5, 0.5], to = [0.55, 0.9], b = 2.4, time = 1.0 }";

const MEANT: &[MeantRow] = &[
    ("", &["blocks", "motion", "motions"], Meant::Key("task")),
    ("", &["path", "end_effector", "tool", "tcp"], Meant::Key("tip")),
    ("", &["assembly"], Meant::Key("machine")),
    ("", &["spacecraft", "satellite", "support", "mount"], Meant::Key("base")),
    ("", &["time"], Meant::Key("duration")),
    ("", &["dt", "timestep"], Meant::Key("step")),
    ("tip", &["target", "goal", "end", "b_point"], Meant::Key("to")),
    ("tip", &["start", "begin"], Meant::Key("from")),
    ("tip", &["points", "waypoints", "through"], Meant::Key("via")),
    ("tip", &["duration", "t"], Meant::Key("time")),
    ("tip", &["loop", "back"], Meant::Key("closed")),
    ("base", &["m", "weight"], Meant::Key("mass")),
    ("base", &["i", "moments", "moment_of_inertia"], Meant::Key("inertia")),
    ("base", &["cm", "cog", "centre_of_mass", "center_of_mass"], Meant::Key("com")),
    ("base", &["k", "spring", "springs"], Meant::Key("stiffness")),
    ("base", &["d", "damper", "dampers"], Meant::Key("damping")),
    ("base", &["p", "linear_momentum"], Meant::Key("momentum")),
    ("base", &["l", "spin"], Meant::Key("angular_momentum")),
];

const WORDS: WordTable = WordTable { rows: ROWS, meant: MEANT };

/// The words of scenario files of an assembly whose blocks have these names.
pub(super) struct AssemblyScenarioWords<'a> {
    pub blocks: &'a [String],
}

/// Returns the block that a place in the file belongs to, and the place in the scenario of its machine.
fn in_block(path: &KeyPath) -> Option<(&str, KeyPath)> {
    match &path.0[..] {
        [KeyStep::Key(part), KeyStep::Key(block), rest @ ..] if !rest.is_empty() => {
            let inner = KeyPath(rest.to_vec());
            match part.as_str() {
                "task" => Some((block, inner.under("task"))),
                "scenario" => Some((block, inner)),
                _ => None,
            }
        }
        _ => None,
    }
}

impl Vocabulary for AssemblyScenarioWords<'_> {
    fn name(&self, path: &KeyPath) -> Option<String> {
        match in_block(path) {
            Some((block, inner)) => {
                let of_table = || inner.last_key().filter(|_| inner.0.len() == 1).map(str::to_owned);
                let name = ScenarioWords.name(&inner).or_else(of_table);
                name.map(|name| format!("{name} of block {}", quote_clipped(block)))
            }
            None => WORDS.name(path),
        }
    }

    fn want(&self, path: &KeyPath) -> Option<String> {
        match in_block(path) {
            Some((_, inner)) => ScenarioWords.want(&inner),
            None => {
                let of_key = || assembly_key_of(&path.to_string()).map(|key| key.value_type.to_string());
                WORDS.want(path).or_else(of_key)
            }
        }
    }

    fn example(&self, path: &KeyPath) -> Option<&'static str> {
        match in_block(path) {
            Some((_, inner)) => ScenarioWords.example(&inner),
            None => WORDS.example(path),
        }
    }

    fn meant(&self, path: &KeyPath) -> Option<Meant> {
        match in_block(path) {
            Some((_, inner)) => ScenarioWords.meant(&inner),
            None => WORDS.meant(path),
        }
    }

    /// Examples are about blocks BLOCK and OTHER: these become blocks of the assembly.
    fn with_own_names(&self, example: String, _: &StatedFile) -> String {
        let names = ["BLOCK", "OTHER"].into_iter().zip(self.blocks.iter().chain(self.blocks.last()));
        names.fold(example, |text, (made_up, name)| text.replace(made_up, name))
    }
}
