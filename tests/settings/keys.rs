//! Keys in words, and machines by their keys: each key is one row.

use stillbase::mechanics::machine::{KEYS, MachineError, builtin};
use stillbase::session::scenario::{Scenario, keys, name_of, part_of};
use stillbase::settings::change::{DEFAULT_WORD, typed};
use stillbase::settings::key::{Key, KeyType, in_words};

#[test]
fn keys_of_one_thing_stand_together() {
    let paths = ["link.*.com", "drive.*.rotor.ratio", "link.*.mass", "gravity", "drive.*.a_limit", "drive.*.b_limit"];
    let words = ["link.NAME.(com|mass)", "drive.NAME.(a|b)_limit", "drive.NAME.rotor.ratio", "gravity"];
    assert_eq!(in_words(paths), words);
    assert_eq!(in_words(["length.*", "limits.*"]), ["length.NAME", "limits.ANGLE"]);
    assert_eq!(in_words(["counterweight.*.at", "counterweight.*.mass"]), ["counterweight.NUMBER.(at|mass)"]);
    assert!(in_words([]).is_empty());
}

/// Every key has a plain name, which no other key of its part has.
#[test]
fn keys_have_plain_names() {
    assert_eq!(name_of("link.3.mass"), "mass of link 3");
    assert_eq!(name_of("tolerance.link.3.com_normal"), "centre of mass off link 3");
    assert_eq!(name_of("link.*.mass"), "mass of every link");
    assert_eq!(name_of("length.*"), "every length");
    assert_eq!(name_of("drive.2.rotor.ratio"), "gear ratio of drive 2");
    assert_eq!(name_of("task.keep_off_change_points"), "keep off change points");
    let mut known: Vec<(&str, String)> = Vec::new();
    for key in keys() {
        let called = (part_of(key), name_of(&key.path.replace('*', "5")));
        assert!(!called.1.contains(['_', '.', '*']) && !called.1.is_empty(), "{}: {}", key.path, called.1);
        assert!(!known.contains(&called), "{}: {} is the name of two", key.path, called.1);
        known.push(called);
    }
}

/// What every key of a machine holds can be set again, and what none is called is refused with all that there are.
#[test]
fn what_a_key_holds_sets_it() {
    let machine = builtin("nine-link").expect("built in");
    let with = machine.set_all([("payload.mass", "0.2"), ("drive.1.rotor.inertia", "0.01")]).expect("valid");
    let scenario = Scenario { machine: with.clone(), ..Scenario::builtin("case-3").expect("built in").clone() };
    let mut seen = Vec::new();
    for (path, key, value) in scenario.settings().into_iter().filter(|(_, key, _)| KEYS.contains(key)) {
        assert_eq!(with.value(&path), Some(value.clone()), "{path}");
        match with.set(&path, &typed(&value)) {
            Ok(same) => assert_eq!(same.value(&path), Some(value), "{path}"),
            // Bars that share a length are set by its name.
            Err(why) => assert!(matches!(why, MachineError::SharedLength { .. }), "{path}: {why}"),
        }
        // What has no default has to be given.
        let freed = with.set(&path, DEFAULT_WORD);
        let is_required = key.default == Key::REQUIRED;
        assert_eq!(freed.is_err(), is_required, "{path}: {freed:?}");
        let KeyType::Number(range) = key.value_type else { continue };
        if !is_required && key.default != Key::NONE {
            let usual: f64 = key.default.parse().expect("a number");
            assert!(range.contains(usual), "{path}");
        }
        seen.push(key.path);
    }
    seen.dedup();
    assert!(seen.len() > 12, "{seen:?}");
    let unknown = with.set("link.5.colour", "1").expect_err("no such key").to_string();
    assert!(unknown.ends_with(&in_words(KEYS.map(|key| key.path)).join(", ")), "{unknown}");
}
