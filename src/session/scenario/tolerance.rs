//! Tolerances of a machine, as a scenario's `[tolerance]` or the command line states them.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::words::ScenarioWords;
use stillbase_mechanics::machine::{KeyPath, Machine, MachineSpec};
use stillbase_settings::change;
use stillbase_settings::key::{Key, KeyType, names};
use stillbase_settings::keyed::ANY_NUMBER;
use stillbase_settings::mending::{Problem, Wrong};
use stillbase_settings::range::{Range, quote_clipped};

/// Maximum number of samples of one study.
pub const MAX_SAMPLES: u64 = 1_000_000_000_000;

/// The `[tolerance]` of a scenario: spreads by key of a setting, and the numbers of a study.
///
/// ```toml
/// [tolerance]
/// seed = 7
/// samples = 100000
/// moment_limit = 0.02                     # N m
/// force_limit = 0.5                       # N
/// "link.*.com" = { normal = 0.0005 }      # standard deviation, m
/// "link.*.mass" = { uniform = "1%" }      # half-width, of the nominal mass
/// "link.5.mass" = { uniform = 0.01 }      # a name takes precedence over *
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "BTreeMap<String, toml::Value>", into = "BTreeMap<String, toml::Value>")]
pub struct Tolerance {
    /// Seed of the random machines.
    pub seed: Option<u64>,
    /// Number of machines that are drawn.
    pub samples: Option<u64>,
    /// Upper limit on |n_B| for the yield, N m.
    pub moment_limit: Option<f64>,
    /// Upper limit on the dynamic |f_B| for the yield, N.
    pub force_limit: Option<f64>,
    /// Spreads by key; see `UncertainParameter` of the studies.
    pub spreads: BTreeMap<String, Spread>,
}

/// Key of a number of the study, and access to its field.
struct Row {
    key: Key,
    at: At,
}

/// Access to a field: a function that reads it, and one that returns it for writing.
enum At {
    Whole(fn(&Tolerance) -> Option<u64>, fn(&mut Tolerance) -> &mut Option<u64>),
    Number(fn(&Tolerance) -> Option<f64>, fn(&mut Tolerance) -> &mut Option<f64>),
}

/// Makes the access to a field.
macro_rules! at {
    ($kind:ident, $field:ident) => {
        At::$kind(|tolerance| tolerance.$field, |tolerance| &mut tolerance.$field)
    };
}

/// All keys of numbers of the study.
const ROWS: [Row; 4] = [
    Row {
        key: Key::new("tolerance.seed", KeyType::Whole(SEED), Key::NONE, "Which random machines.").instead("1"),
        at: at!(Whole, seed),
    },
    Row {
        key: Key::new("tolerance.samples", KeyType::Whole(SAMPLES), Key::NONE, "How many random machines.")
            .instead("100000, or 1000 that are simulated"),
        at: at!(Whole, samples),
    },
    Row {
        key: Key::number("tolerance.moment_limit", LIMIT_MOMENT, Key::NONE, "The greatest |n_B| that will do.")
            .instead("no yield is counted by it"),
        at: at!(Number, moment_limit),
    },
    Row {
        key: Key::number("tolerance.force_limit", LIMIT_FORCE, Key::NONE, "The greatest dynamic |f_B| that will do.")
            .instead("no yield is counted by it"),
        at: at!(Number, force_limit),
    },
];

/// Key of a spread, and its default if no spread at all is given.
struct Varies {
    key: Key,
    /// Default spread as it is typed; `None` if the number does not vary by default.
    usual: Option<&'static str>,
    /// Whether a machine has such a number.
    has: fn(&MachineSpec) -> bool,
}

/// Makes a row from path, unit and meaning of a key. A default spread may follow, with a function that returns whether
/// a machine has such a number.
macro_rules! varies {
    ($path:literal, $unit:literal, $words:literal) => {
        Varies { key: spread($path, $unit, $words).instead("it does not"), usual: None, has: |_| true }
    };
    ($path:literal, $unit:literal, $words:literal, $usual:literal, $has:expr) => {
        Varies {
            key: spread($path, $unit, $words).instead(concat!($usual, " if no spread is given at all")),
            usual: Some($usual),
            has: $has,
        }
    };
}

/// All keys of spreads.
const SPREADS: [Varies; 7] = [
    varies!("tolerance.link.*.com", "m", "How a link's centre of mass varies along the link.", "normal:0.0005", |_| {
        true
    }),
    varies!(
        "tolerance.link.*.com_normal",
        "m",
        "How a link's centre of mass varies across the link.",
        "normal:0.0005",
        |_| true
    ),
    varies!("tolerance.link.*.mass", "kg", "How a link's mass varies.", "normal:0.5%", |spec| {
        spec.links.iter().any(|link| link.mass != 0.0)
    }),
    varies!("tolerance.link.*.inertia", "kg m²", "How a link's inertia varies.", "normal:2%", |spec| {
        spec.links.iter().any(|link| link.inertia != 0.0)
    }),
    varies!(
        "tolerance.length.*",
        "m",
        "How a named length varies, in all bars that share it.",
        "normal:0.00005",
        |spec| !spec.lengths.is_empty()
    ),
    varies!("tolerance.payload.mass", "kg", "How the payload's mass varies."),
    varies!("tolerance.payload.inertia", "kg m²", "How the payload's inertia varies."),
];

/// Prefix of every key of the table.
const PREFIX: &str = "tolerance.";

/// Every key of `[tolerance]`; in a file a key of a spread is one word in quotes, such as `"link.*.com"`.
pub(super) const KEYS: [Key; ROWS.len() + SPREADS.len()] = {
    let mut all = [ROWS[0].key; ROWS.len() + SPREADS.len()];
    let mut i = 0;
    while i < all.len() {
        all[i] = if i < ROWS.len() { ROWS[i].key } else { SPREADS[i - ROWS.len()].key };
        i += 1;
    }
    all
};

const fn spread(path: &'static str, unit: &'static str, words: &'static str) -> Key {
    Key::new(path, KeyType::Spread(unit), Key::NONE, words)
}

const SEED: Range = Range::new(0.0, i64::MAX as f64, "");
const SAMPLES: Range = Range::new(1.0, MAX_SAMPLES as f64, "");
const LIMIT_MOMENT: Range = Range::new(1e-12, 1e12, "N m");
const LIMIT_FORCE: Range = Range::new(1e-12, 1e12, "N");

impl Tolerance {
    /// Flattens a change, because the key of a spread is one word in `[tolerance]`: `{ link = { 5 = { mass = … } } }`
    /// becomes `{ "link.5.mass" = … }`.
    pub(super) fn flat(change: &toml::Table) -> toml::Table {
        let mut flat = toml::Table::new();
        for (key, value) in change {
            match value {
                toml::Value::Table(inner) if !inner.contains_key("normal") && !inner.contains_key("uniform") => {
                    flat.extend(Self::flat(inner).into_iter().map(|(rest, value)| (format!("{key}.{rest}"), value)));
                }
                value => drop(flat.insert(key.clone(), value.clone())),
            }
        }
        flat
    }

    /// Returns whether nothing is set.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Returns the spreads, or [`default_spreads`] of a machine if none is given.
    pub fn spreads_or_default(&self, machine: &Machine) -> BTreeMap<String, Spread> {
        if self.spreads.is_empty() { default_spreads(machine) } else { self.spreads.clone() }
    }
}

/// Returns the spreads that apply if none is given, those of careful workshop practice. Centres of mass vary by 0.5 mm
/// in both directions, masses by 0.5 %, inertias by 2 %, lengths with a name by 0.05 mm. All are normal, with these
/// standard deviations. Numbers that a machine does not have get no spread.
pub fn default_spreads(machine: &Machine) -> BTreeMap<String, Spread> {
    let usual = |Varies { key, usual, has }: &Varies| {
        let typed = usual.filter(|_| has(machine.spec()))?;
        Some((key.path.trim_start_matches(PREFIX).to_owned(), typed.parse().ok()?))
    };
    SPREADS.iter().filter_map(usual).collect()
}

/// Distribution of a parameter about its nominal value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// Normal, with this standard deviation.
    Normal(Amount),
    /// Uniform, with this half-width.
    Uniform(Amount),
}

/// Size of a spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// In the parameter's own unit.
    Absolute(f64),
    /// In percent of the nominal value's magnitude.
    Percent(f64),
}

const WANT: &str = "normal:0.0005 (standard deviation) or uniform:1% (half-width), 0 or more";

impl FromStr for Spread {
    type Err = String;

    /// Reads a spread as on the command line: `normal:0.0005`, `uniform:1%`.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("want {WANT}");
        let (word, amount) = text.trim().split_once(':').ok_or_else(wrong)?;
        Self::of(word.trim(), amount.parse().map_err(|()| wrong())?).ok_or_else(wrong)
    }
}

impl Spread {
    fn of(word: &str, amount: Amount) -> Option<Self> {
        match word {
            "normal" => Some(Self::Normal(amount)),
            "uniform" => Some(Self::Uniform(amount)),
            _ => None,
        }
    }

    fn word(&self) -> &'static str {
        match self {
            Self::Normal(_) => "normal",
            Self::Uniform(_) => "uniform",
        }
    }

    /// Returns the spread as a file states it.
    pub fn to_value(&self) -> toml::Value {
        let amount = match self.amount() {
            Amount::Absolute(x) => x.into(),
            percent @ Amount::Percent(_) => toml::Value::String(percent.to_string()),
        };
        toml::Value::Table(toml::Table::from_iter([(self.word().to_owned(), amount)]))
    }

    /// Returns the same kind of spread with another amount.
    #[must_use]
    pub fn with_amount(&self, amount: Amount) -> Self {
        match self {
            Self::Normal(_) => Self::Normal(amount),
            Self::Uniform(_) => Self::Uniform(amount),
        }
    }

    /// Returns the standard deviation or the half-width.
    pub fn amount(&self) -> Amount {
        match self {
            Self::Normal(amount) | Self::Uniform(amount) => *amount,
        }
    }
}

impl fmt::Display for Spread {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.word(), self.amount())
    }
}

impl FromStr for Amount {
    type Err = ();
    fn from_str(text: &str) -> Result<Self, ()> {
        let (digits, percent) = match text.trim().strip_suffix('%') {
            Some(digits) => (digits, true),
            None => (text, false),
        };
        let value = digits.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0).ok_or(())?;
        Ok(if percent { Self::Percent(value) } else { Self::Absolute(value) })
    }
}

impl fmt::Display for Amount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absolute(x) => write!(f, "{x}"),
            Self::Percent(x) => write!(f, "{x}%"),
        }
    }
}

type Section = BTreeMap<String, toml::Value>;

/// Returns the row of a key of a file.
fn row(name: &str) -> Option<&'static Row> {
    ROWS.iter().find(|row| row.key.path.strip_prefix(PREFIX) == Some(name))
}

impl TryFrom<Section> for Tolerance {
    type Error = String;

    fn try_from(section: Section) -> Result<Self, String> {
        Self::try_from_stated(section).map_err(|problem| problem.text(&ScenarioWords))
    }
}

impl Tolerance {
    /// Reads the table of a file.
    ///
    /// # Errors
    /// The problem of the first key that is wrong, in its place in the scenario.
    pub(super) fn try_from_stated(section: Section) -> Result<Self, Problem> {
        let mut tolerance = Self::default();
        for (key, value) in section {
            let wrong = |wrong| Problem { path: KeyPath::new(&[&"tolerance", &key]), wrong };
            match row(&key) {
                Some(Row { key, at: At::Whole(_, of) }) => {
                    *of(&mut tolerance) = Some(whole(key, &value).map_err(|said| wrong(Wrong::Value(said)))?);
                }
                Some(Row { key, at: At::Number(_, of) }) => {
                    *of(&mut tolerance) = Some(number(key, &value).map_err(|said| wrong(Wrong::Value(said)))?);
                }
                None => {
                    let spread = in_words(&value).and_then(|text| text.parse().ok());
                    let spread = spread.ok_or_else(|| wrong(no_spread(&key, &value)))?;
                    tolerance.spreads.insert(key, spread);
                }
            }
        }
        Ok(tolerance)
    }
}

/// Returns what is wrong with a key whose value is no spread: the value, or the key, if no setting varies by it.
fn no_spread(key: &str, value: &toml::Value) -> Wrong {
    let known = || KEYS.iter().map(|key| key.path.trim_start_matches(PREFIX));
    let is_known = known().any(|pattern| names(pattern, key)) || key.split('.').count() > 2;
    match is_known {
        true => Wrong::Value(format!("is {}: {WANT_IN_FILE}", quote_clipped(&change::typed(value)))),
        false => Wrong::UnknownKey(known().map(Into::into).collect()),
    }
}

const WANT_IN_FILE: &str =
    "want { normal = 0.0005 }, a standard deviation, or { uniform = \"1%\" }, a half-width, 0 or more";

/// Returns a spread of a file as it is written on the command line: `normal:0.0005`.
fn in_words(value: &toml::Value) -> Option<String> {
    if let toml::Value::String(text) = value {
        return Some(text.clone());
    }
    let table = value.as_table().filter(|table| table.len() == 1)?;
    let (word, amount) = table.iter().next()?;
    let amount = match amount {
        toml::Value::String(text) => text.clone(),
        toml::Value::Float(x) => x.to_string(),
        toml::Value::Integer(x) => x.to_string(),
        _ => return None,
    };
    Some(format!("{word}:{amount}"))
}

/// Reads a whole number in the range of its key.
fn whole(key: &Key, value: &toml::Value) -> Result<u64, String> {
    let range = key.range().unwrap_or(ANY_NUMBER);
    let whole = value.as_integer().and_then(|x| u64::try_from(x).ok()).filter(|x| range.contains(*x as f64));
    let ends = || match range.high() < i64::MAX as f64 {
        true => format!(" from {} to {}", range.low(), range.high()),
        false => format!(", {} or more", range.low()),
    };
    whole.ok_or_else(|| format!("is {}: want a whole number{}", quote_clipped(&change::typed(value)), ends()))
}

/// Reads a number in the range of its key.
fn number(key: &Key, value: &toml::Value) -> Result<f64, String> {
    let range = key.range().unwrap_or(ANY_NUMBER);
    change::number(value)
        .filter(|x| range.contains(*x))
        .ok_or_else(|| format!("is {}: want a number, {range}", quote_clipped(&change::typed(value))))
}

impl From<Tolerance> for Section {
    fn from(tolerance: Tolerance) -> Self {
        let stated = |Row { key, at }: &Row| {
            let value = match at {
                // A seed beyond what TOML can hold comes from the command line and is never saved.
                At::Whole(of, _) => i64::try_from(of(&tolerance)?).ok()?.into(),
                At::Number(of, _) => of(&tolerance)?.into(),
            };
            Some((key.path.trim_start_matches(PREFIX).to_owned(), value))
        };
        let spreads = tolerance.spreads.iter().map(|(key, spread)| (key.clone(), spread.to_value()));
        ROWS.iter().filter_map(stated).chain(spreads).collect()
    }
}
