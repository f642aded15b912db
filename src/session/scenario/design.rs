//! [`Brief`]: what a designer asks of a machine whose masses and lengths are changed by hand, as `[design]` states it.

use std::collections::{BTreeMap, BTreeSet};

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use toml::{Table, Value};

use crate::mechanics::balance::{Hold, Preset};
use crate::mechanics::counterweights::{DENSITY, Disc, THICKNESS};
use crate::mechanics::machine::{Drive, Machine, ranges};
use crate::settings::change;
use crate::settings::key::{BOUNDS, Holds, Key};
use crate::settings::range::{Check, Range, clipped};

/// The `[design]` of a scenario: no motion depends on it, but what is changed in the design view does.
///
/// ```toml
/// [design]
/// keep_balanced = true
/// clearance = 0.005                       # m
/// fixed = { 9 = true }                    # a link
/// hold.link.5 = { mass = [0.4, 0.8] }     # kg
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Brief {
    /// Whatever is changed, the rest follows so that the machine is balanced, (7) and (8).
    #[serde(skip_serializing_if = "is_default")]
    pub keep_balanced: bool,
    /// How dear it is to move the centre of mass of each link, (10), where these follow.
    #[serde(
        serialize_with = "write_penalties",
        deserialize_with = "read_penalties",
        skip_serializing_if = "is_minimum_norm"
    )]
    pub penalties: Preset,
    /// Density of what counterweights are made of, kg/m³.
    #[serde(skip_serializing_if = "is_of_steel")]
    pub density: f64,
    /// Thickness of the plate that they are cut from, m.
    #[serde(skip_serializing_if = "is_of_usual_plate")]
    pub thickness: f64,
    /// How far behind the root of its link a counterweight may sit at most, m; none: as far as the link is long.
    #[serde(skip_serializing_if = "is_default")]
    pub behind_root: Option<f64>,
    /// How heavy one may be, kg; none: any mass.
    #[serde(skip_serializing_if = "is_default")]
    pub heaviest: Option<f64>,
    /// How far the edge of a disc stays from the middle of every pin of its link, m; none: discs may cover pins.
    #[serde(skip_serializing_if = "is_default")]
    pub clearance: Option<f64>,
    /// The least and the greatest mass that the end effector will hold, kg; none: it holds what it holds.
    #[serde(skip_serializing_if = "is_default")]
    pub payload: Option<[f64; 2]>,
    /// Between which ratios the rotors of drives may be chosen, by the drive's name, where the least momentum is wanted.
    #[serde(skip_serializing_if = "is_default")]
    pub ratio: BTreeMap<String, [f64; 2]>,
    /// Names of links that stay as they are, with their counterweights.
    #[serde(serialize_with = "write_names", deserialize_with = "read_names", skip_serializing_if = "is_default")]
    pub fixed: BTreeSet<String>,
    /// Single numbers that stay, may change, or may change so far, by key: `link.5.mass`. They come before what is said of
    /// their links.
    #[serde(serialize_with = "write_holds", deserialize_with = "read_holds", skip_serializing_if = "is_default")]
    pub hold: BTreeMap<String, Hold>,
}

/// Every key of `[design]`.
pub const KEYS: [Key; 15] = [
    Key::new(
        "design.keep_balanced",
        Holds::Switch,
        "false",
        "Whether, whatever is changed in the design view, what is free follows so that (7) and (8) hold, each as little \
         as it can; a fixed link stays.",
    ),
    Key::new(
        "design.penalties",
        Holds::Choice(&Preset::NAMES),
        "minimum-norm",
        "How dear it is to move each centre of mass while the balance is kept, Eq. (10).",
    )
    .when("nine links and no counterweights"),
    Key::number("design.density", DENSITY, "7850", "Density of what counterweights are made of, discs of one plate."),
    Key::number("design.thickness", THICKNESS, "0.03", "Thickness of the plate that the discs are cut from."),
    Key::number(
        "design.behind_root",
        Range::new(0.0, 100.0, "m"),
        Key::NONE,
        "How far behind the root of its link a counterweight may sit.",
    )
    .instead("as far as the link is long"),
    Key::number("design.heaviest", Range::new(1e-3, 1e5, "kg"), Key::NONE, "How heavy a counterweight may be.")
        .instead("any mass"),
    Key::number(
        "design.clearance",
        Range::new(0.0, 1.0, "m"),
        Key::NONE,
        "How far the edge of a disc stays from the middle of every pin of its link.",
    )
    .instead("discs may cover pins"),
    Key::new(
        "design.payload",
        Holds::List(2, ranges::LOAD),
        Key::NONE,
        "Counterweights leave the least worst residual over all that the end effector may hold, from the first to the \
         second; to balance one payload exactly, hold it and leave this out.",
    )
    .instead("what the end effector holds"),
    Key::new(
        "design.ratio.*",
        Holds::List(2, ranges::RATIO),
        Key::NONE,
        "The rotor's ratio may be chosen from the first to the second; below 0 it turns the other way.",
    )
    .instead("it stays")
    .when("a drive of this name whose rotor has inertia"),
    Key::new(
        "design.fixed.*",
        Holds::Switch,
        "false",
        "Whether a link stays as it is: neither what keeps the balance nor new counterweights change it.",
    )
    .when(LINK),
    held("design.hold.link.*.mass", ranges::LOAD, "How a link's mass is held while the balance is kept.").when(LINK),
    held("design.hold.link.*.com", ranges::PLACE, "How a link's centre of mass along it is held.").when(LINK),
    held("design.hold.link.*.com_normal", ranges::PLACE, "How a link's centre of mass across it is held.").when(LINK),
    held("design.hold.counterweight.*.mass", ranges::LOAD, "How the mass of a counterweight is held.")
        .when(COUNTERWEIGHT),
    held("design.hold.counterweight.*.at", ranges::PLACE, "How the place of a counterweight is held.")
        .when(COUNTERWEIGHT),
];

const LINK: &str = "a link of this name";
const COUNTERWEIGHT: &str = "a counterweight of this number";

const fn held(path: &'static str, range: Range, words: &'static str) -> Key {
    Key::new(path, Holds::Bounds(range), Key::NONE, words).instead("it follows if its kind does")
}

impl Default for Brief {
    fn default() -> Self {
        let Disc { density, thickness } = Disc::STEEL;
        Self {
            keep_balanced: false,
            penalties: Preset::MinimumNorm,
            density,
            thickness,
            behind_root: None,
            heaviest: None,
            clearance: None,
            payload: None,
            ratio: BTreeMap::new(),
            fixed: BTreeSet::new(),
            hold: BTreeMap::new(),
        }
    }
}

impl Brief {
    /// What counterweights are made of.
    pub fn disc(&self) -> Disc {
        Disc { density: self.density, thickness: self.thickness }
    }

    /// Whether a key of this part has an effect in the design view of a machine.
    pub(super) fn uses(&self, key: &str, machine: &Machine) -> bool {
        let spec = machine.spec();
        let is_link = |name: &str| spec.links.iter().any(|link| link.name == name);
        let is_geared = |drive: &Drive| drive.rotor.is_some_and(|rotor| rotor.inertia > 0.0);
        if let Some(name) = key.strip_prefix("fixed.") {
            return is_link(name);
        }
        if let Some(name) = key.strip_prefix("ratio.") {
            return spec.drives.iter().any(|drive| drive.name == name && is_geared(drive));
        }
        match key.strip_prefix("hold.").and_then(body_of) {
            Some(("link", name)) => is_link(name),
            Some((_, number)) => number.parse().is_ok_and(|n: usize| (1..=spec.counterweights.len()).contains(&n)),
            None => key != "penalties" || (spec.links.len() == 9 && spec.counterweights.is_empty()),
        }
    }

    /// What no range says: that no least value is above its greatest.
    pub(super) fn fits(&self) -> Vec<Check> {
        let holds = self.hold.iter().filter_map(|(key, hold)| match hold {
            Hold::Within(ends) => Some((format!("design.hold.{key}"), *ends)),
            Hold::Fixed | Hold::Free => None,
        });
        let ratios = self.ratio.iter().map(|(drive, ends)| (format!("design.ratio.{drive}"), *ends));
        let payload = self.payload.map(|ends| ("design.payload".to_owned(), ends));
        let want = "the least value first, then the greatest";
        let all = holds.chain(ratios).chain(payload);
        all.map(|(key, [low, high])| Check::words(key, low, low <= high, want)).collect()
    }
}

/// The kind and the name of the body that a held number is of; `None` if no such number can be held.
fn body_of(key: &str) -> Option<(&str, &str)> {
    let ((kind, rest), (_, what)) = (key.split_once('.')?, key.rsplit_once('.')?);
    let name = rest.strip_suffix(what)?.strip_suffix('.')?;
    let known = match kind {
        "link" => ["mass", "com", "com_normal"].contains(&what),
        "counterweight" => ["mass", "at"].contains(&what),
        _ => false,
    };
    known.then_some((kind, name))
}

/// Whether a part is as it is where a file leaves it out.
pub(super) fn is_default<T: Default + PartialEq>(part: &T) -> bool {
    *part == T::default()
}

fn is_minimum_norm(preset: &Preset) -> bool {
    *preset == Preset::MinimumNorm
}

fn is_of_steel(density: &f64) -> bool {
    *density == Disc::STEEL.density
}

fn is_of_usual_plate(thickness: &f64) -> bool {
    *thickness == Disc::STEEL.thickness
}

/// Penalties by name.
fn write_penalties<S: Serializer>(preset: &Preset, to: S) -> Result<S::Ok, S::Error> {
    preset.name().serialize(to)
}

fn read_penalties<'de, D: Deserializer<'de>>(from: D) -> Result<Preset, D::Error> {
    let word = String::deserialize(from)?;
    let known = Preset::ALL.into_iter().find(|(_, name)| *name == word);
    known.map(|(preset, _)| preset).ok_or_else(|| D::Error::unknown_variant(&clipped(&word), &Preset::NAMES))
}

/// A set of names as a switch for each.
fn write_names<S: Serializer>(names: &BTreeSet<String>, to: S) -> Result<S::Ok, S::Error> {
    names.iter().map(|name| (name, true)).collect::<BTreeMap<_, _>>().serialize(to)
}

fn read_names<'de, D: Deserializer<'de>>(from: D) -> Result<BTreeSet<String>, D::Error> {
    let switches = BTreeMap::<String, bool>::deserialize(from)?;
    Ok(switches.into_iter().filter_map(|(name, is_in)| is_in.then_some(name)).collect())
}

/// Holds by key, as tables in each other: `link.5.mass`.
fn write_holds<S: Serializer>(holds: &BTreeMap<String, Hold>, to: S) -> Result<S::Ok, S::Error> {
    let one = |(key, hold): (&String, &Hold)| change::one(key, to_value(*hold));
    holds.iter().map(one).fold(Table::new(), |all, one| change::join(all, &one)).serialize(to)
}

fn read_holds<'de, D: Deserializer<'de>>(from: D) -> Result<BTreeMap<String, Hold>, D::Error> {
    let table = Table::deserialize(from)?;
    let read = |(key, value): (String, &Value)| match (body_of(&key), of_value(value)) {
        (None, _) => Err(D::Error::custom(format!(
            "design.hold.{}: want link.NAME.(mass|com|com_normal) or counterweight.NUMBER.(mass|at)",
            clipped(&key)
        ))),
        (Some(_), Some(hold)) => Ok((key, hold)),
        (Some(_), None) => Err(D::Error::custom(format!(
            "design.hold.{} is {}: want {}, or the least and the greatest value",
            clipped(&key),
            clipped(&change::typed(value)),
            BOUNDS.join(", ")
        ))),
    };
    change::leaves(&table).into_iter().map(read).collect()
}

/// A hold as a file states it.
pub fn to_value(hold: Hold) -> Value {
    match hold {
        Hold::Fixed => BOUNDS[0].into(),
        Hold::Free => BOUNDS[1].into(),
        Hold::Within(ends) => ends.to_vec().into(),
    }
}

fn of_value(value: &Value) -> Option<Hold> {
    match value {
        Value::String(word) if word == BOUNDS[0] => Some(Hold::Fixed),
        Value::String(word) if word == BOUNDS[1] => Some(Hold::Free),
        Value::Array(ends) => match ends.iter().map(change::number).collect::<Option<Vec<_>>>()?[..] {
            [low, high] => Some(Hold::Within([low, high])),
            _ => None,
        },
        _ => None,
    }
}
