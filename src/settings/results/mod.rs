//! The dictionary of results: [`ResultRow`], with name, unit, meaning, sign and frame of everything that is answered,
//! recorded or written as a column. `--json`, JSON Schema, signals, help and the guide take them from here.

mod chance;
mod columns;
mod design;
mod machine;
mod motion;
mod places;
mod records;
mod signals;

pub use signals::SIGNALS;

/// A result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ResultRow {
    /// Name; where the same name means another thing, the property or the command that holds it is before it, with a
    /// dot. Of a signal it is the path, in which `*` stands for the name of a drive, an angle or a pin.
    pub name: &'static str,
    /// Symbol in the paper's notation, with `*` for an index; empty if there is none.
    pub symbol: &'static str,
    /// SI unit: `1` for a pure number, empty for what is no number.
    pub unit: &'static str,
    /// Meaning, in words.
    pub meaning: &'static str,
    /// What a positive value means; empty if that is plain.
    pub sign: &'static str,
    /// Axes and origin to which it refers; empty if it refers to none.
    pub frame: &'static str,
    /// Name that replaces this one; empty if this one stays.
    pub newer: &'static str,
}

/// Axes of the base.
const BASE: &str = "axes of the base at the start, origin B";
/// Axes of a link.
const LINK: &str = "the link: along it from root to tip";
/// Sense of angles and moments.
const TURN: &str = "counter-clockwise";

/// Version in which older names end.
pub const OLD_NAMES_END: &str = "0.3";

/// Returns a result.
const fn row(name: &'static str, unit: &'static str, meaning: &'static str) -> ResultRow {
    ResultRow { name, symbol: "", unit, meaning, sign: "", frame: "", newer: "" }
}

/// Returns an older name of a result.
const fn old(name: &'static str, unit: &'static str, newer: &'static str) -> ResultRow {
    ResultRow { newer, ..row(name, unit, "") }
}

impl ResultRow {
    const fn sign(self, sign: &'static str) -> Self {
        Self { sign, ..self }
    }

    const fn frame(self, frame: &'static str) -> Self {
        Self { frame, ..self }
    }

    /// Returns meaning, unit, sign and frame in sentences.
    pub fn in_words(&self) -> String {
        if !self.newer.is_empty() {
            return format!("Older name of {}, until version {OLD_NAMES_END}.", self.newer);
        }
        let unit = match self.unit {
            "" | "1" => String::new(),
            unit => format!(" Unit: {unit}."),
        };
        let sign = if self.sign.is_empty() { String::new() } else { format!(" Positive: {}.", self.sign) };
        let frame = if self.frame.is_empty() { String::new() } else { format!(" Frame: {}.", self.frame) };
        format!("{}{unit}{sign}{frame}", self.meaning)
    }
}

/// All results but signals, part by part.
pub const RESULTS: &[(&str, &[ResultRow])] = &[
    ("Runs and motions", motion::ROWS),
    ("Machines", machine::ROWS),
    ("Design", design::ROWS),
    ("Poses and workspaces", places::ROWS),
    ("Tolerances, spectra, trim", chance::ROWS),
    ("Files and messages", records::ROWS),
    ("Columns of tables, properties of recordings", columns::ROWS),
];

/// Returns a result by its path: the command, the properties that hold it, and its name. Of several rows the one counts
/// that agrees with the longest end of the path.
pub fn find(path: &[&str]) -> Option<&'static ResultRow> {
    let all = || RESULTS.iter().flat_map(|(_, rows)| rows.iter());
    (0..path.len()).find_map(|start| {
        let name = path[start..].join(".");
        all().find(|row| row.name == name)
    })
}

/// Returns what a column of a table of a command holds, by its head: the name, then the unit if there is one. Properties
/// of a recording are those of the command `recording`.
pub fn column(command: &str, head: &str) -> Option<&'static ResultRow> {
    let is_it = |name: &str, row: &ResultRow| {
        let name_of = |head| is_named(name, head);
        // A `*` does not stand for a name and the unit after it.
        let is_alone = !(name.contains('*') && head.contains(' '));
        (is_alone && name_of(head))
            || (head.strip_suffix(row.unit).and_then(|rest| rest.strip_suffix(' ')).is_some_and(name_of))
    };
    let all = || RESULTS.iter().flat_map(|(_, rows)| rows.iter());
    let own = |row: &&ResultRow| row.name.split_once('.').is_some_and(|(of, name)| of == command && is_it(name, row));
    all().find(own).or_else(|| all().chain(SIGNALS).find(|row| is_it(row.name, row)))
}

/// Returns whether a name is one, or is one with `*` in the place of some part of it.
fn is_named(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        Some((before, after)) => {
            let part = name.strip_prefix(before).and_then(|rest| rest.strip_suffix(after));
            // Drives are counted where no stroke separates the name: q1.
            part.is_some_and(|part| match before.is_empty() || before.ends_with('/') {
                true => !part.is_empty(),
                false => part.parse::<usize>().is_ok(),
            })
        }
        None => pattern == name,
    }
}

/// Returns the path of the signal that had an older name; the name itself if none had it.
pub fn newest_path(name: &str) -> &str {
    let rows = RESULTS.iter().flat_map(|(_, rows)| rows.iter()).filter(|row| signal(row.newer).is_some());
    let own = |row: &&ResultRow| row.name.split_once('.').map_or(row.name, |(_, name)| name) == name;
    rows.into_iter().find(own).map_or(name, |row| row.newer)
}

/// Returns a signal by its path, in which `*` stands for the name of a drive, an angle or a pin.
pub fn signal(path: &str) -> Option<&'static ResultRow> {
    SIGNALS.iter().find(|row| row.name == path)
}
