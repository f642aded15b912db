//! The keys of machine files in words: plain names, what would be right, examples, and what people write instead.

use super::error::{KeyPath, KeyStep};
use super::keys::KeyRow;
use stillbase_settings::mending::{Meant, Vocabulary, called, with_key};
use stillbase_settings::stated::StatedFile;
use stillbase_settings::word_row::{MeantRow, WordRow, WordTable, row};

const OF_DRIVE: &str = "the name of a drive";
const OF_LINK: &str = "the name of a link";
const POINT: &str = "a point of a link: { link = \"…\", at = \"tip\" }";
const ALONG: &str = "a place along the link: \"tip\", \"root\", a number in m, or a named length";
const OWN_NAME: &str = "a text in quotes, a name of its own";

const ROWS: &[WordRow] = &[
    row("name", "name of the machine", "a text in quotes", "\"my-arm\""),
    row("summary", "summary", "a text in quotes", "\"two links\""),
    row("gravity", "gravity", "", "[0.0, -9.81]"),
    row("pose", "pose of the drawing", "the angle of each drive, rad", "[1.9, 0.6]"),
    row("pose.*", "angle of drive * in the drawing", "-25.2 to 25.2 rad", "1.9"),
    row("lengths", "named lengths", "a table of lengths in m", "{ l1 = 0.5 }"),
    row("lengths.*", "length *", "1e-6 to 1000000 m", "0.5"),
    row("length.*", "length *", "", "0.5"),
    row("payload", "payload", "a table", "{ mass = 0.5 }"),
    row("payload.mass", "mass of the payload", "", "0.5"),
    row("payload.inertia", "inertia of the payload", "", "0.001"),
    row("payload.inertia_along", "inertia of the payload along its link", "", "0.0005"),
    row("payload.inertia_across", "inertia of the payload across its link", "", "0.001"),
    row("payload.offset", "centre of mass of the payload", "", "[0.0, 0.0]"),
    row("payload.axial", "height of the payload", "", "0.0"),
    row("drive", "list of drives", "one [[drive]] for each drive", "[{ name = \"1\" }]"),
    row("drive.*", "drive *", "", ""),
    row("drive.*.name", "name of drive *", OWN_NAME, "\"1\""),
    row("drive.*.on", "drive that carries the motor of drive *", OF_DRIVE, "\"1\""),
    row(
        "drive.*.rotor",
        "rotor of drive *",
        "a table: { inertia = 1e-4, ratio = 50 }",
        "{ inertia = 1e-4, ratio = 50 }",
    ),
    row("drive.*.rotor.inertia", "rotor inertia of drive *", "", "1e-4"),
    row("drive.*.rotor.ratio", "gear ratio of drive *", "", "50"),
    row("drive.*.torque_limit", "torque limit of drive *", "", "20.0"),
    row("drive.*.speed_limit", "rate limit of drive *", "", "6.0"),
    row("drive.*.acceleration_limit", "acceleration limit of drive *", "", "50.0"),
    row("drive.*.jerk_limit", "jerk limit of drive *", "", "1000.0"),
    row("link", "list of links", "one [[link]] for each link", LINK),
    row("link.*", "link *", "", ""),
    row("link.*.name", "name of link *", OWN_NAME, "\"1\""),
    row("link.*.drive", "drive that link * follows", OF_DRIVE, "\"1\""),
    row(
        "link.*.attach",
        "where link * is pinned",
        "\"base\", or a point of another link: { link = \"…\", at = \"tip\" }",
        "\"base\"",
    ),
    row("link.*.attach.link", "link to which link * is pinned", OF_LINK, "\"1\""),
    row("link.*.attach.at", "where link * is pinned", ALONG, "\"tip\""),
    row("link.*.direction", "direction of link *", "1 or -1", "1"),
    row("link.*.length", "length of link *", "a number in m, or a name under [lengths]", "0.5"),
    row("link.*.mass", "mass of link *", "", "1.2"),
    row("link.*.inertia", "inertia of link *", "", "0.02"),
    row("link.*.inertia_along", "inertia along link *", "", "0.001"),
    row("link.*.inertia_across", "inertia across link *", "", "0.02"),
    row("link.*.com", "centre of mass along link *", "", "0.25"),
    row("link.*.com_normal", "centre of mass off link *", "", "0.0"),
    row("link.*.axial", "height of link *", "", "0.0"),
    row("material", "list of materials", "one [[material]] for each", "[{ name = \"bronze\", density = 8800.0 }]"),
    row("material.*", "material *", "", ""),
    row("material.*.name", "name of material *", OWN_NAME, "\"bronze\""),
    row("material.*.density", "density of *", "", "8800.0"),
    row("part", "list of parts", "one [[part]] for each", PART),
    row("part.*", "part *", "", ""),
    row("part.*.link", "link of part *", OF_LINK, "\"1\""),
    row("part.*.name", "name of part *", "a text in quotes", "\"bar\""),
    row("part.*.shape", "shape of part *", "\"flat\", \"tube\", \"profile\" or \"plate\"", "\"flat\""),
    row("part.*.material", "material of part *", "the name of a material", "\"steel\""),
    row("part.*.from", "beginning of part *", ALONG, "\"root\""),
    row("part.*.to", "end of part *", ALONG, "\"tip\""),
    row("part.*.across", "distance of part * off its link", "", "0.0"),
    row("part.*.width", "width of part *", "", "0.03"),
    row("part.*.thickness", "thickness of part *", "", "0.006"),
    row("part.*.diameter", "diameter of part *", "", "0.03"),
    row("part.*.height", "height of part *", "", "0.02"),
    row("part.*.wall", "wall of part *", "", "0.002"),
    row("part.*.ends", "ends of part *", "\"round\" or \"square\"", "\"round\""),
    row(
        "part.*.polygon",
        "corners of part *",
        "a list of corners [x, y] in m",
        "[[0.0, -0.02], [0.3, -0.02], [0.3, 0.02]]",
    ),
    row("part.*.holes", "holes of part *", "a list of holes", "[{ at = \"tip\", diameter = 0.008 }]"),
    row("part.*.holes.*", "hole of part *", "", ""),
    row("part.*.holes.*.at", "place of a hole of part *", ALONG, "\"tip\""),
    row("part.*.holes.*.across", "distance of a hole of part * off its line", "", "0.0"),
    row("part.*.holes.*.diameter", "diameter of a hole of part *", "a number in m", "0.008"),
    row("lump", "list of lumps", "one [[lump]] for each", "[{ link = \"1\", mass = 0.3, at = \"tip\" }]"),
    row("lump.*", "lump *", "", ""),
    row("lump.*.link", "link that carries lump *", OF_LINK, "\"1\""),
    row("lump.*.name", "name of lump *", "a text in quotes", "\"motor\""),
    row("lump.*.mass", "mass of lump *", "", "0.3"),
    row("lump.*.at", "place of lump *", ALONG, "\"tip\""),
    row("lump.*.across", "distance of lump * off its link", "", "0.0"),
    row("lump.*.inertia", "inertia of lump *", "", "0.001"),
    row(
        "counterweight",
        "list of counterweights",
        "one [[counterweight]] for each",
        "[{ link = \"1\", mass = 0.5, at = -0.1 }]",
    ),
    row("counterweight.*", "counterweight *", "", ""),
    row("counterweight.*.link", "link that carries counterweight *", OF_LINK, "\"1\""),
    row("counterweight.*.mass", "mass of counterweight *", "", "0.5"),
    row("counterweight.*.at", "place of counterweight *", "", "-0.1"),
    row("counterweight.*.across", "distance of counterweight * off its link", "", "0.0"),
    row("counterweight.*.radius", "radius of counterweight *", "", "0.03"),
    row("counterweight.*.inner_radius", "inner radius of counterweight *", "", "0.01"),
    row("counterweight.*.half", "counterweight * is half a ring", "", "true"),
    row("counterweight.*.turned", "counterweight * is turned round", "", "true"),
    row("counterweight.*.length", "length of counterweight *", "", "0.08"),
    row("counterweight.*.width", "width of counterweight *", "", "0.04"),
    row("counterweight.*.fixed", "counterweight * stays", "", "true"),
    row("closure", "list of closures", "one [[closure]] for each", "[{ a = { link = \"1\" }, b = { link = \"2\" } }]"),
    row("closure.*", "closure *", "", ""),
    row("closure.*.a", "first point of closure *", POINT, "{ link = \"1\", at = \"tip\" }"),
    row("closure.*.b", "second point of closure *", POINT, "{ link = \"2\", at = \"tip\" }"),
    row("closure.*.a.link", "first link of closure *", OF_LINK, "\"1\""),
    row("closure.*.b.link", "second link of closure *", OF_LINK, "\"2\""),
    row("closure.*.a.at", "first point of closure *", ALONG, "\"tip\""),
    row("closure.*.b.at", "second point of closure *", ALONG, "\"tip\""),
    row("end_effector", "end effector", POINT, "{ link = \"1\", at = \"tip\" }"),
    row("end_effector.link", "link of the end effector", OF_LINK, "\"1\""),
    row("end_effector.at", "place of the end effector", ALONG, "\"tip\""),
    row("angle", "list of angles", "one [[angle]] for each", "[{ name = \"a1\", to = \"2\", from = \"1\" }]"),
    row("angle.*", "angle *", "", ""),
    row("angle.*.name", "name of angle *", OWN_NAME, "\"a1\""),
    row("angle.*.to", "drive whose angle counts positive in angle *", OF_DRIVE, "\"2\""),
    row("angle.*.from", "drive whose angle counts negative in angle *", OF_DRIVE, "\"1\""),
    row("angle.*.offset", "offset of angle *", "-25.2 to 25.2 rad, four turns", "0.0"),
    row("angle.*.min", "lower limit of angle *", "-25.2 to 25.2 rad, four turns", "0.2"),
    row("angle.*.max", "upper limit of angle *", "-25.2 to 25.2 rad, four turns", "2.9"),
    row("limits.*", "limits of angle *", "", "[0.2, 2.9]"),
];

const PART: &str = "[{ link = \"1\", shape = \"flat\", width = 0.03, thickness = 0.006 }]";

const LINK: &str = "[{ name = \"1\", drive = \"1\", attach = \"base\", length = 0.5, mass = 1.2, inertia = 0.02, \
                    com = 0.25 }]";

/// A smallest machine, complete.
pub const SMALLEST: &str = "\
name = \"my-arm\"

[[drive]]
name = \"1\"

[[link]]
name = \"1\"
drive = \"1\"
attach = \"base\"
length = 0.5
mass = 1.2
inertia = 0.02
com = 0.25

[end_effector]
link = \"1\"
at = \"tip\"";

const BELT: &str = "a belt from the base is a drive of its own: want a [[drive]] without \"on\", named in drive by the \
                    link that the belt turns; its ratio is the motor's, rotor = { inertia = 1e-4, ratio = 3 } there";

const BELT_LINES: &str = "[[drive]]\nname = \"2\"\nrotor = { inertia = 1e-4, ratio = 3 }";

const MEANT: &[MeantRow] = &[
    (
        "",
        &["belts", "belt", "pulley", "pulleys", "transmission", "transmissions", "gear", "gears"],
        Meant::Else(BELT, BELT_LINES),
    ),
    ("", &["drives", "motor", "motors", "actuator", "actuators"], Meant::Key("drive")),
    ("", &["links", "body", "bodies", "bar", "bars"], Meant::Key("link")),
    ("", &["length"], Meant::Key("lengths")),
    ("", &["angles", "limits", "limit"], Meant::Key("angle")),
    ("", &["closures", "loop", "loops", "pin", "pins"], Meant::Key("closure")),
    ("", &["counterweights", "weight", "weights"], Meant::Key("counterweight")),
    ("", &["tip", "tool", "tcp", "ee", "end"], Meant::Key("end_effector")),
    ("", &["load"], Meant::Key("payload")),
    (
        "",
        &["joint", "joints"],
        Meant::Else(
            "pins are stated where links meet: attach of a [[link]], and [[closure]] where a loop closes",
            "attach = { link = \"1\", at = \"tip\" }",
        ),
    ),
    ("link.*", &["belt", "pulley", "transmission", "gear", "ratio"], Meant::Else(BELT, BELT_LINES)),
    ("link.*", &["weight", "m"], Meant::Key("mass")),
    ("link.*", &["moi", "moment_of_inertia", "izz", "i"], Meant::Key("inertia")),
    ("link.*", &["ixx", "inertia_x", "inertia_axial"], Meant::Key("inertia_along")),
    ("link.*", &["iyy", "inertia_y", "inertia_normal"], Meant::Key("inertia_across")),
    ("link.*", &["cm", "cog", "centre_of_mass", "center_of_mass", "com_x", "lc", "l_c"], Meant::Key("com")),
    ("link.*", &["com_y", "com_across", "across"], Meant::Key("com_normal")),
    ("link.*", &["on", "parent", "pinned", "attached"], Meant::Key("attach")),
    ("link.*", &["motor", "actuator"], Meant::Key("drive")),
    ("link.*", &["sign"], Meant::Key("direction")),
    ("link.*", &["l"], Meant::Key("length")),
    ("link.*", &["height", "z"], Meant::Key("axial")),
    ("drive.*", &["belt", "pulley", "transmission"], Meant::Else(BELT, BELT_LINES)),
    (
        "drive.*",
        &["gear", "ratio", "gear_ratio", "reduction", "inertia", "rotor_inertia"],
        Meant::Else(
            "gear and rotor of a motor are stated together: rotor = { inertia = 1e-4, ratio = 50 }",
            "rotor = { inertia = 1e-4, ratio = 50 }",
        ),
    ),
    ("drive.*", &["parent", "stator", "carrier", "attach"], Meant::Key("on")),
    ("drive.*", &["torque", "max_torque", "effort"], Meant::Key("torque_limit")),
    ("drive.*", &["speed", "max_speed", "velocity", "velocity_limit", "rate_limit"], Meant::Key("speed_limit")),
    ("drive.*", &["acceleration", "max_acceleration"], Meant::Key("acceleration_limit")),
    ("drive.*", &["jerk", "max_jerk"], Meant::Key("jerk_limit")),
    ("drive.*.rotor", &["gear", "gear_ratio", "reduction", "belt", "transmission"], Meant::Key("ratio")),
];

/// The words of machine files.
pub struct MachineWords;

/// Returns an example with links and drives "1" and "2" as the first two of some names.
pub(super) fn with_names(example: String, links: &[&str], drives: &[&str]) -> String {
    let own = |names: &[&str], keys: &[&str], text: String| {
        let pairs = ["1", "2"].into_iter().zip(names.iter().chain(names.last()));
        pairs.filter(|(made_up, _)| !names.contains(made_up)).fold(text, |text, (made_up, name)| {
            keys.iter()
                .fold(text, |text, key| text.replace(&format!("{key} = {made_up:?}"), &format!("{key} = {name:?}")))
        })
    };
    own(drives, &["drive", "to", "from"], own(links, &["link"], example))
}

const WORDS: WordTable = WordTable { rows: ROWS, meant: MEANT };

impl Vocabulary for MachineWords {
    fn name(&self, path: &KeyPath) -> Option<String> {
        WORDS.name(path)
    }

    fn want(&self, path: &KeyPath) -> Option<String> {
        let of_key = || KeyRow::of(WORDS.row(path)?.path).map(|row| row.key.value_type.to_string());
        WORDS.want(path).or_else(of_key)
    }

    fn example(&self, path: &KeyPath) -> Option<&'static str> {
        WORDS.example(path)
    }

    /// Examples are about the links and drives "1" and "2": these become the first two that the file names.
    fn with_own_names(&self, example: String, file: &StatedFile) -> String {
        // A whole table states its own names.
        if example.contains("[[") { example } else { with_names(example, &file.names("link"), &file.names("drive")) }
    }

    fn meant(&self, path: &KeyPath) -> Option<Meant> {
        WORDS.meant(path)
    }
}

/// Returns whether a word is one that people write at the top of a machine file.
pub fn is_meant(word: &str) -> bool {
    MachineWords.meant(&KeyPath::new(&[&word])).is_some()
}

/// Returns the plain name of a place in a machine file, with its key: `mass of link 2 (link.2.mass)`.
pub fn named(place: &KeyPath) -> String {
    match &place.0[..] {
        // A key of `--set` is one word.
        [KeyStep::Key(key)] if key.contains('.') => {
            let path = KeyPath(key.split('.').map(|part| KeyStep::Key(part.into())).collect());
            MachineWords.name(&path).map_or_else(|| place.to_string(), |name| with_key(&name, &place.to_string()))
        }
        _ => called(place, &MachineWords),
    }
}

/// Returns the plain name of a key in the syntax of `--set`, such as `link.5.mass`; `None` for one that no machine has.
/// The key may hold `*` for every link or length.
pub fn pattern_of(path: &str) -> Option<(&'static str, &'static str)> {
    let path = KeyPath(path.split('.').map(|part| KeyStep::Key(part.into())).collect());
    WORDS.row(&path).map(|row| (row.path, row.name))
}
