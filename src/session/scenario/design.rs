//! [`DesignBrief`]: requirements on a machine whose masses and lengths are changed in the design view, as `[design]` states
//! them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Deref;

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use stillbase_mechanics::balance::{ParameterBounds, Preset};
use stillbase_mechanics::counterweights::{
    ACROSS_RANGE, BOX_WIDTH_RANGE, CounterweightForm, CounterweightKind, CounterweightStock, DENSITY_RANGE,
    INNER_RADIUS_RANGE, THICKNESS_RANGE,
};
use stillbase_mechanics::machine::{Drive, Machine, ranges};
use stillbase_settings::change;
use stillbase_settings::key::{self, HOLD_WORDS, Key, KeyType};
use stillbase_settings::keyed::{HasKeyType, keyed};
use stillbase_settings::range::{Range, RangeCheck, quote_clipped};

const LINK: &str = "a link of this name";
const SOUGHT: &str = "a length that is sought";
const RINGS: &str = "counterweights are rings or half rings";
const BOXES: &str = "counterweights are boxes";
const AS_CUT: &str = "bars are weighed as they are cut";
/// Range of the dimensions of bars and holes.
const BAR_RANGE: Range = Range::new(1e-4, 10.0, "m");
const COUNTERWEIGHT: &str = "a counterweight of this number";

keyed! {
    /// The `[design]` of a scenario: requirements on changes in the design view. No motion depends on it.
    ///
    /// ```toml
    /// [design]
    /// keep_balanced = true
    /// clearance = 0.005                       # m
    /// fixed = { 9 = true }                    # a link
    /// hold.link.5 = { mass = [0.4, 0.8] }     # kg
    /// ```
    #[derive(Clone, Debug, PartialEq)]
    pub struct DesignBrief at "design" {
        /// Whether each change in the design view also adjusts the free numbers, as little as possible, so that (7) and
        /// (8) hold; fixed links stay.
        keep_balanced: bool = "false";
        /// Penalty on moving each centre of mass while the balance is kept, Eq. (10).
        penalties: Preset = "minimum-norm", when: "nine links and no counterweights";
        // The defaults of density and thickness are those of `CounterweightStock::STEEL`.
        /// Density of the plate from which counterweights are cut.
        density: f64 = "7850", range: DENSITY_RANGE;
        /// Thickness of the plate from which counterweights are cut.
        thickness: f64 = "0.03", range: THICKNESS_RANGE;
        /// Shape of the counterweights.
        shape: CounterweightKind = "disc";
        /// Inner radius of rings and half rings.
        inner_radius: f64 = "0.01", range: INNER_RADIUS_RANGE, when: RINGS;
        /// Width of boxes across their links; their mass gives their length.
        box_width: f64 = "0.04", range: BOX_WIDTH_RANGE, when: BOXES;
        /// Maximum distance of a counterweight behind the root of its link.
        behind_root: Option<f64> = Key::NONE, range: Range::new(0.0, 100.0, "m"),
            instead: "as far as the link is long";
        /// Maximum distance of a counterweight from the axis of its link, to either side.
        across: f64 = "0", range: ACROSS_RANGE;
        /// Maximum mass of a counterweight.
        heaviest: Option<f64> = Key::NONE, range: Range::new(1e-3, 1e5, "kg"), instead: "any mass";
        /// Minimum distance between the edge of a counterweight and the centre of every pin of its link.
        clearance: Option<f64> = Key::NONE, range: Range::new(0.0, 1.0, "m"), instead: "they may cover pins";
        /// Whether links are cut from flat bars: tails, arms and holes are weighed with the counterweights that they
        /// carry. Links with parts of their own keep these.
        as_cut: bool = "false";
        // The defaults are those of `BarStock`.
        /// Width of the bars.
        bar_width: f64 = "0.03", range: BAR_RANGE, when: AS_CUT;
        /// Thickness of the bars.
        bar_thickness: f64 = "0.006", range: BAR_RANGE, when: AS_CUT;
        /// Density of the bars.
        bar_density: f64 = "2700", range: DENSITY_RANGE, when: AS_CUT;
        /// Diameter of the holes for pins.
        pin_diameter: f64 = "0.008", range: BAR_RANGE, when: AS_CUT;
        /// Counterweights minimise the largest residual over all payloads from the first to the second mass; to balance
        /// one payload exactly, set `payload.mass` and omit this key.
        payload: Option<[f64; 2]> = Key::NONE, range: ranges::LOAD, instead: "what the end effector holds";
        /// Minimum reach of the arms together, Σ |L_k|, if lengths are sought.
        reach: Option<f64> = Key::NONE, range: Range::new(0.0, 1e6, "m"), instead: "any reach", when: SOUGHT;
        /// Minimum area of the reactionless workspace, if lengths are sought.
        workspace: Option<f64> = Key::NONE, range: Range::new(0.0, 1e12, "m²"), instead: "any workspace", when: SOUGHT;
        named:
        /// Bounds of a length that is optimised with the counterweights: a name under `[lengths]`, or a link that
        /// shares its length with no other.
        length: BTreeMap<String, [f64; 2]> = Key::NONE, range: ranges::LENGTH, instead: "it stays",
            when: "a length of this name, or such a link";
        /// Bounds of the rotor's ratio, if it may be chosen; below 0 the rotor turns the other way.
        ratio: BTreeMap<String, [f64; 2]> = Key::NONE, range: ranges::RATIO, instead: "it stays",
            when: "a drive of this name whose rotor has inertia";
        /// Whether a link stays unchanged, both when the balance is kept and when counterweights are placed.
        fixed: NameSet = "false", when: LINK;
        tables:
        /// Bounds on single numbers by key, such as `link.5.mass`: fixed, free, or within an interval. They override
        /// `fixed`.
        hold: BoundsByKey;
    }
}

/// Keys of the bounds on single numbers.
pub const BOUND_KEYS: [Key; 6] = [
    held("design.hold.link.*.mass", ranges::LOAD, "How a link's mass is held while the balance is kept.").when(LINK),
    held("design.hold.link.*.com", ranges::PLACE, "How a link's centre of mass along it is held.").when(LINK),
    held("design.hold.link.*.com_normal", ranges::PLACE, "How a link's centre of mass across it is held.").when(LINK),
    held("design.hold.counterweight.*.mass", ranges::LOAD, "How the mass of a counterweight is held.")
        .when(COUNTERWEIGHT),
    held("design.hold.counterweight.*.at", ranges::PLACE, "How the place of a counterweight is held.")
        .when(COUNTERWEIGHT),
    held("design.hold.counterweight.*.across", ranges::PLACE, "How the place of a counterweight off its link is held.")
        .when(COUNTERWEIGHT),
];

const fn held(path: &'static str, range: Range, words: &'static str) -> Key {
    Key::new(path, KeyType::Bounds(range), Key::NONE, words).instead("it is adjusted if numbers of its kind are")
}

/// Returns the key of the bounds on a number without its prefix `design.hold.`.
fn bare(key: &Key) -> &'static str {
    key.path.trim_start_matches("design.hold.")
}

impl DesignBrief {
    /// Returns the plate of the counterweights, and what is cut from it.
    pub fn plate(&self) -> CounterweightStock {
        let form = CounterweightForm::of(self.shape, self.inner_radius, self.box_width);
        CounterweightStock { density: self.density, thickness: self.thickness, form }
    }

    /// Returns whether a key of this part has an effect in the design view of a machine.
    pub(super) fn has_effect(&self, key: &str, machine: &Machine) -> bool {
        let spec = machine.spec();
        let is_link = |name: &str| spec.links.iter().any(|link| link.name == name);
        let is_geared = |drive: &Drive| drive.rotor.is_some_and(|rotor| rotor.inertia > 0.0);
        if let Some(name) = key.strip_prefix("fixed.") {
            return is_link(name);
        }
        if let Some(name) = key.strip_prefix("length.") {
            return spec.own_lengths().any(|(own, _)| own == name);
        }
        if let Some(name) = key.strip_prefix("ratio.") {
            return spec.drives.iter().any(|drive| drive.name == name && is_geared(drive));
        }
        if !self.uses(key) {
            return false;
        }
        match key.strip_prefix("hold.").and_then(body_of) {
            Some(("link", name)) => is_link(name),
            Some((_, number)) => number.parse().is_ok_and(|n: usize| (1..=spec.counterweights.len()).contains(&n)),
            None if ["reach", "workspace"].contains(&key) => !self.length.is_empty(),
            None => key != "penalties" || (spec.links.len() == 9 && spec.counterweights.is_empty()),
        }
    }

    /// Checks that no lower bound is above its upper bound.
    pub(super) fn range_checks(&self) -> Vec<RangeCheck> {
        let holds = self.hold.iter().filter_map(|(key, hold)| match hold {
            ParameterBounds::Within(ends) => Some((format!("design.hold.{key}"), *ends)),
            ParameterBounds::Fixed | ParameterBounds::Free => None,
        });
        let ratios = self.ratio.iter().map(|(drive, ends)| (format!("design.ratio.{drive}"), *ends));
        let lengths = self.length.iter().map(|(name, ends)| (format!("design.length.{name}"), *ends));
        let payload = self.payload.map(|ends| ("design.payload".to_owned(), ends));
        let want = "the least value first, then the greatest";
        let all = holds.chain(ratios).chain(lengths).chain(payload);
        all.map(|(key, [low, high])| RangeCheck::words(key, low, low <= high, want)).collect()
    }
}

/// Returns kind and name of the body to which a bounded number belongs, or `None` if the number cannot be bounded.
fn body_of(key: &str) -> Option<(&str, &str)> {
    let (kind, rest) = key.split_once('.')?;
    let (name, what) = rest.rsplit_once('.')?;
    let known = BOUND_KEYS.iter().any(|held| bare(held).split_once(".*.") == Some((kind, what)));
    known.then_some((kind, name))
}

/// Returns whether a part has its default value.
pub(super) fn is_default<T: Default + PartialEq>(part: &T) -> bool {
    *part == T::default()
}

/// A set of names; a file states each one as a key with the value `true`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "BTreeMap<String, bool>", into = "BTreeMap<String, bool>")]
pub struct NameSet(pub BTreeSet<String>);

impl HasKeyType for NameSet {
    const HOLDS: KeyType = bool::HOLDS;
}

impl Deref for NameSet {
    type Target = BTreeSet<String>;
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl From<BTreeMap<String, bool>> for NameSet {
    fn from(switches: BTreeMap<String, bool>) -> Self {
        Self(switches.into_iter().filter_map(|(name, is_in)| is_in.then_some(name)).collect())
    }
}

impl From<NameSet> for BTreeMap<String, bool> {
    fn from(NameSet(names): NameSet) -> Self {
        names.into_iter().map(|name| (name, true)).collect()
    }
}

/// Bounds on numbers by key, such as `link.5.mass`; in a file they are nested tables.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Table", into = "Table")]
pub struct BoundsByKey(pub BTreeMap<String, ParameterBounds>);

impl Deref for BoundsByKey {
    type Target = BTreeMap<String, ParameterBounds>;
    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl From<BoundsByKey> for Table {
    fn from(BoundsByKey(holds): BoundsByKey) -> Self {
        let one = |(key, hold): (&String, &ParameterBounds)| change::single_change(key, to_value(*hold));
        holds.iter().map(one).fold(Self::new(), |all, one| change::join(all, &one))
    }
}

impl TryFrom<Table> for BoundsByKey {
    type Error = String;

    fn try_from(table: Table) -> Result<Self, String> {
        let read = |(key, value): (String, &Value)| match (body_of(&key), of_value(value)) {
            (None, _) => {
                let known = key::in_words(BOUND_KEYS.iter().map(bare)).join(" or ");
                Err(format!("design.hold.{}: want {known}", quote_clipped(&key)))
            }
            (Some(_), Some(hold)) => Ok((key, hold)),
            (Some(_), None) => Err(format!(
                "design.hold.{} is {}: want {}, or the least and the greatest value",
                quote_clipped(&key),
                quote_clipped(&change::typed(value)),
                HOLD_WORDS.join(", ")
            )),
        };
        change::leaves(&table).into_iter().map(read).collect::<Result<_, _>>().map(Self)
    }
}

/// Returns the bounds on a number as a file states them.
pub fn to_value(hold: ParameterBounds) -> Value {
    match hold {
        ParameterBounds::Fixed => HOLD_WORDS[0].into(),
        ParameterBounds::Free => HOLD_WORDS[1].into(),
        ParameterBounds::Within(ends) => ends.to_vec().into(),
    }
}

fn of_value(value: &Value) -> Option<ParameterBounds> {
    match value {
        Value::String(word) if word == HOLD_WORDS[0] => Some(ParameterBounds::Fixed),
        Value::String(word) if word == HOLD_WORDS[1] => Some(ParameterBounds::Free),
        Value::Array(ends) => match ends.iter().map(change::number).collect::<Option<Vec<_>>>()?[..] {
            [low, high] => Some(ParameterBounds::Within([low, high])),
            _ => None,
        },
        _ => None,
    }
}
