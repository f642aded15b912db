//! The allowed values nearest to values that settings cannot have.

use toml::{Table, Value};

use super::Proposal;
use crate::scenario::{key_of, name_of};
use stillbase_planning::reactionless::Decimal;
use stillbase_settings::change::{DEFAULT_WORD, join, leaves, number, single_change, typed};
use stillbase_settings::key::{Key, KeyType};
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::Range;
use stillbase_settings::spelling::nearest_words;

/// Number of bisections between the present value and the wanted one.
const BISECTIONS: usize = 40;
/// Rounding may move a value back by this fraction of the way from the present value to the wanted one.
const ROUNDING: f64 = 2e-3;

impl Proposal {
    /// Returns the proposal to give keys values; `verb` says what that is: `take duration from A to B = 0.8 s`.
    pub(super) fn of_values(verb: &str, values: &[(String, Value)]) -> Self {
        let text: Vec<String> =
            values.iter().map(|(path, value)| format!("{} = {}", name_of(path), shown(path, value))).collect();
        let change = values.iter().map(|(path, value)| single_change(path, value.clone()));
        Self::new(format!("{verb} {}", text.join(", ")), change.fold(Table::new(), |all, one| join(all, &one)))
    }
}

/// Returns the proposal to give a key a value.
pub(super) fn taking(path: &str, value: impl Into<Value>) -> Proposal {
    Proposal::of_values("take", &[(path.to_owned(), value.into())])
}

/// Returns a value for reading, in few digits, with the unit of its key.
fn shown(path: &str, value: &Value) -> String {
    let unit = key_of(path).map_or("", Key::unit_of_each);
    let with_unit = |number: &str| if unit.is_empty() { number.to_owned() } else { format!("{number} {unit}") };
    let Some(all) = numbers(value) else { return typed(value) };
    let short: Vec<String> = all.iter().map(|x| ShortNumber(*x).to_string()).collect();
    match &short[..] {
        [] => "none".into(),
        [one] => with_unit(one),
        several if several.iter().any(|x| x.contains('e')) => {
            several.iter().map(|x| with_unit(x)).collect::<Vec<_>>().join(", ")
        }
        several => {
            // Numbers with equally many decimals, not 0, share the unit after the last of them.
            let count = |x: &String| x.split_once('.').map_or(0, |(_, decimals)| decimals.len());
            let decimals = several.iter().map(count).fold(1, usize::max);
            with_unit(&all.iter().map(|x| format!("{x:.decimals$}")).collect::<Vec<_>>().join(", "))
        }
    }
}

/// Returns a proposal for settings that are refused: the nearest allowed values or, without any, the present ones.
/// It is applied on top of the wanted settings. `present` returns the present value of a key, and `accepts` whether
/// settings are allowed on top of the wanted ones.
pub fn proposals_for_values(
    wanted: &Table,
    present: &dyn Fn(&str) -> Option<Value>,
    accepts: &dyn Fn(&Table) -> bool,
) -> Vec<Proposal> {
    let kept = || taking_back(wanted, present).filter(|kept| kept.change().is_some_and(accepts));
    nearest_values(wanted, present, accepts).or_else(kept).into_iter().collect()
}

/// Returns the proposal of the nearest allowed values, or `None` if there are none between the present and the wanted
/// ones.
pub(super) fn nearest_values(
    wanted: &Table,
    present: &dyn Fn(&str) -> Option<Value>,
    accepts: &dyn Fn(&Table) -> bool,
) -> Option<Proposal> {
    let all: Vec<(String, &Value)> = leaves(wanted);
    let of = |changed: &[(String, Value)]| (!changed.is_empty()).then(|| Proposal::of_values("take", changed));
    // First every value is brought into the range of its key.
    let ranged: Vec<(String, Value)> = all
        .iter()
        .filter_map(|(path, value)| {
            let near = within_key(&key_of(path)?.value_type, value)?;
            (near != **value).then(|| (path.clone(), near))
        })
        .collect();
    if let Some(found) = of(&ranged).filter(|found| found.change().is_some_and(accepts)) {
        return Some(found);
    }
    // Then one value is moved towards the present one, as far as it has to be.
    all.iter().find_map(|(path, value)| {
        let known = ranged.iter().find(|(known, _)| known == path).map(|(_, value)| value);
        let to = numbers(known.unwrap_or(value))?;
        let is_whole = key_of(path).is_some_and(|key| matches!(key.value_type, KeyType::Whole(_)));
        let from = numbers(&present(path)?).filter(|from| from.len() == to.len() && !is_whole)?;
        let with = |x: &[f64]| -> Vec<(String, Value)> {
            let others = ranged.iter().filter(|(other, _)| other != path).cloned();
            others.chain([(path.clone(), value_of(x, value))]).collect()
        };
        let allowed = |x: &[f64]| of(&with(x)).is_some_and(|found| found.change().is_some_and(accepts));
        of(&with(&between(&from, &to, &allowed)?))
    })
}

/// Returns the proposal to keep the present values in place of the wanted ones.
pub(super) fn taking_back(wanted: &Table, present: &dyn Fn(&str) -> Option<Value>) -> Option<Proposal> {
    let kept: Vec<(String, Value)> =
        leaves(wanted).into_iter().filter_map(|(path, _)| Some((path.clone(), present(&path)?))).collect();
    (!kept.is_empty()).then(|| Proposal::of_values("keep", &kept))
}

/// Returns the value nearest to `value` among those that a key accepts by its type and range; `None` if none is near.
fn within_key(of: &KeyType, value: &Value) -> Option<Value> {
    let clamped = |range: &Range, value: &Value| match value {
        Value::Integer(x) if range.contains(*x as f64) => Some(Value::Integer(*x)),
        value => number(value).filter(|x| !x.is_nan()).map(|x| Value::Float(x.clamp(range.low(), range.high()))),
    };
    let list =
        |range: &Range, all: &Vec<Value>| -> Option<Vec<Value>> { all.iter().map(|x| clamped(range, x)).collect() };
    match (of, value) {
        (KeyType::Whole(range), value) => {
            let x = number(value)?.clamp(range.low(), range.high()).round();
            (x.abs() < 1e15).then_some(Value::Integer(x as i64))
        }
        (KeyType::Number(range) | KeyType::PerDrive(range), value) if number(value).is_some() => clamped(range, value),
        (KeyType::PerDrive(range) | KeyType::List(_, range), Value::Array(all)) => list(range, all).map(Value::Array),
        (KeyType::Points(_, range), Value::Array(points)) => {
            let point = |point: &Value| list(range, point.as_array()?).map(Value::Array);
            points.iter().map(point).collect::<Option<Vec<_>>>().map(Value::Array)
        }
        (KeyType::Bounds(range), Value::Array(all)) => list(range, all).map(Value::Array),
        (KeyType::Choice(words), Value::String(word)) if word != DEFAULT_WORD => {
            nearest_words(word, words.iter().copied()).first().map(|nearest| Value::from(*nearest))
        }
        (KeyType::Switch, Value::String(word)) => match word.to_ascii_lowercase().as_str() {
            "yes" | "on" | "1" => Some(true.into()),
            "no" | "off" | "0" => Some(false.into()),
            _ => None,
        },
        _ => None,
    }
}

/// Returns the number or the list of numbers of a value.
pub(super) fn numbers(value: &Value) -> Option<Vec<f64>> {
    let all: Vec<f64> = match value {
        Value::Array(all) => all.iter().map(number).collect::<Option<_>>()?,
        value => vec![number(value)?],
    };
    all.iter().all(|x| x.is_finite()).then_some(all)
}

/// Returns numbers in the form of another value: alone, or as a list.
fn value_of(x: &[f64], like: &Value) -> Value {
    match (like, x) {
        (Value::Array(_), x) => Value::Array(x.iter().copied().map(Value::Float).collect()),
        (_, [x, ..]) => Value::Float(*x),
        (like, []) => like.clone(),
    }
}

/// Returns the allowed numbers nearest to `to` on the way from `from`, rounded to few decimals; `None` if `from` is not
/// allowed.
fn between(from: &[f64], to: &[f64], allowed: &dyn Fn(&[f64]) -> bool) -> Option<Vec<f64>> {
    if !allowed(from) {
        return None;
    }
    // Two bounds in the wrong order are exchanged.
    if let [low, high] = to
        && low > high
        && allowed(&[*high, *low])
    {
        return Some(vec![*high, *low]);
    }
    let at = |share: f64| -> Vec<f64> { from.iter().zip(to).map(|(from, to)| from + share * (to - from)).collect() };
    let (mut good, mut bad) = (0.0, 1.0);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (good + bad);
        if allowed(&at(middle)) { good = middle } else { bad = middle }
    }
    let exact = at(good);
    let rounded = (0..=9).find_map(|decimals| {
        let near = [0.0, 0.5, 1.0].into_iter().map(|back| at((good - back * ROUNDING).max(0.0)));
        near.map(|x| x.iter().map(|x| Decimal::nearest(*x, decimals).value()).collect::<Vec<f64>>()).find(|x| {
            let off = |i: usize| (x[i] - exact[i]).abs() <= ROUNDING * (to[i] - from[i]).abs();
            (0..x.len()).all(off) && allowed(x)
        })
    });
    Some(rounded.unwrap_or(exact))
}
