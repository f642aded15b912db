//! The keys of assembly files in words.

use crate::machine::KeyPath;
use stillbase_settings::mending::{Meant, Vocabulary};
use stillbase_settings::word_row::{MeantRow, WordRow, WordTable, row};

const DIRECTION: &str = "a direction in space, three numbers";

const ROWS: &[WordRow] = &[
    row("kind", "kind of the file", "\"assembly\"", "\"assembly\""),
    row("name", "name of the assembly", "a text in quotes", "\"two-arms\""),
    row("summary", "summary", "a text in quotes", "\"two arms\""),
    row("gravity", "gravity", "three numbers, m/s²", "[0.0, 0.0, -9.81]"),
    row("block", "list of blocks", "one [[block]] for each machine", "[{ name = \"arm\", machine = \"nine-link\" }]"),
    row("block.*", "block *", "", ""),
    row("block.*.name", "name of block *", "a text in quotes, a name of its own", "\"arm\""),
    row("block.*.machine", "machine of block *", "the name or file of a machine", "\"nine-link\""),
    row("block.*.set", "settings of the machine of block *", "a list of KEY=VALUE", "[\"payload.mass=0.5\"]"),
    row("block.*.on", "what carries block *", "\"base\", or the name of a block", "\"base\""),
    row("block.*.at", "place of block *", "three numbers, m, in axes of the base", "[0.0, 0.0, 0.0]"),
    row("block.*.x", "direction x of block *", DIRECTION, "[1, 0, 0]"),
    row("block.*.y", "direction y of block *", DIRECTION, "[0, 1, 0]"),
];

const MEANT: &[MeantRow] = &[
    ("", &["blocks", "machine", "machines", "arm", "arms", "part", "module"], Meant::Key("block")),
    ("block.*", &["parent", "carrier", "carried_by", "base", "mount"], Meant::Key("on")),
    ("block.*", &["place", "position", "origin", "offset", "pos"], Meant::Key("at")),
    ("block.*", &["file", "model"], Meant::Key("machine")),
];

/// The words of assembly files.
pub struct AssemblyWords;

const WORDS: WordTable = WordTable { rows: ROWS, meant: MEANT };

impl Vocabulary for AssemblyWords {
    fn name(&self, path: &KeyPath) -> Option<String> {
        WORDS.name(path)
    }

    fn want(&self, path: &KeyPath) -> Option<String> {
        WORDS.want(path)
    }

    fn example(&self, path: &KeyPath) -> Option<&'static str> {
        WORDS.example(path)
    }

    fn meant(&self, path: &KeyPath) -> Option<Meant> {
        WORDS.meant(path)
    }
}
