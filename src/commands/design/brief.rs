//! The brief that the file of a machine holds, and what the command line overrules of it.

use stillbase_session::scenario::{DesignBrief, TaskChange, Value, key_of};
use stillbase_settings::change;

use super::super::exit::print_message;

/// Prints which requirements of the brief of a file apply, and which the command line overrules. `own` is the brief of
/// the file, `now` the one that applies; `concerns` tells which keys, without `design.`, the command asks for.
pub fn report_brief(file: &str, own: &DesignBrief, now: &DesignBrief, concerns: impl Fn(&str) -> bool) {
    let [own, now] = [own, now].map(|brief| TaskChange::try_from(brief).unwrap_or_default());
    let now: Vec<(String, &Value)> = change::leaves(&now);
    let stated = change::leaves(&own).into_iter().filter(|(key, _)| concerns(key));
    let value_now = |key: &str| now.iter().find(|(known, _)| known == key).map(|(_, value)| *value);
    let (kept, overruled): (Vec<_>, Vec<_>) =
        stated.partition(|(key, value)| value_now(key).is_some_and(|now| change::same_value(now, value)));
    let said = |key: &str, value: &Value| format!("design.{key}={}", change::typed(value));
    if !kept.is_empty() {
        let all: Vec<String> = kept.iter().map(|(key, value)| said(key, value)).collect();
        print_message(format!("note: the brief of {file} applies: {}", all.join(" ")));
    }
    for (key, value) in overruled {
        let usual = || key_of(&format!("design.{key}")).map_or("", |key| key.default).to_owned();
        let now = value_now(&key).map_or_else(usual, change::typed);
        print_message(format!("note: the command line overrules {} of {file}: it is {now}", said(&key, value)));
    }
}
