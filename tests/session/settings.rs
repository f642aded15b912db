//! The table of keys against what files take: every key of a file is in it, and what it says is so.

use std::collections::BTreeSet;

use proptest::prelude::*;
use stillbase::session::scenario::{Scenario, key_of, keys};
use stillbase::session::{Edit, Session, TimedEdit};
use stillbase::settings::change::{self, DEFAULT_WORD};
use stillbase::settings::key::{Effect, HOLD_WORDS, Key, KeyType};
use toml::{Table, Value};

fn case_3() -> Scenario {
    Scenario::builtin("case-3").expect("built in")
}

/// The names of keys in the words of whoever reads a file and finds another.
fn expected(message: &str) -> BTreeSet<String> {
    let listed = message.split_once("one of ").map_or("", |(_, list)| list);
    listed.split(" (").next().unwrap_or_default().split(", ").map(str::to_owned).collect()
}

/// The next parts of all keys that begin with a path.
fn parts_below(path: &str) -> BTreeSet<String> {
    let below = keys().filter_map(|key| key.path.strip_prefix(path)?.strip_prefix('.'));
    below.map(|rest| rest.split('.').next().unwrap_or_default().to_owned()).collect()
}

#[test]
fn every_key_of_a_file_is_in_the_table() {
    for path in
        ["task", "control", "plant", "base", "base.wheel", "plant.payload", "plant.friction", "plant.link.5", "design"]
    {
        let change = change::single_change(&format!("{path}.nonsense"), 1);
        let message = case_3().with_settings(&change).expect_err("there is no such key").to_string();
        let mut known = expected(&message);
        known.retain(|key| key != "nonsense");
        let mut table = parts_below(&path.replace(".5", ".*"));
        if path == "base" {
            table.insert("wheel".into());
        }
        assert_eq!(known, table, "{path}: {message}");
    }
    // At the top, what is no setting: a name, a title, the machine as a whole, what was done and what is kept beside it.
    let text = "machine = \"nine-link\"\nnonsense = 1";
    let message = Scenario::parse(text, "a.toml", None).expect_err("there is no such key").to_string();
    let listed = message.split_once("want one of ").and_then(|(_, list)| list.split(" (").next()).expect("a list");
    let mut known: BTreeSet<String> = listed.split(", ").map(Into::into).collect();
    for other in ["name", "title", "summary", "machine", "set", "sketch", "edit", "bookmark", "note", "branch"] {
        assert!(known.remove(other), "{other}: {message}");
    }
    let machine =
        ["link", "material", "part", "lump", "counterweight", "length", "payload", "gravity", "limits", "drive"];
    let table: BTreeSet<String> = keys()
        .filter_map(|key| key.path.split('.').next())
        .filter(|part| !machine.contains(part))
        .map(str::to_owned)
        .collect();
    assert_eq!(known, table);
}

#[test]
fn every_word_of_a_choice_is_in_the_table() {
    for key in keys() {
        let KeyType::Choice(words) = key.value_type else { continue };
        // Files are read by types that do not know the table.
        let file: Table = case_3().to_toml().parse().expect("TOML");
        let file = change::join(file, &change::single_change(key.path, "nonsense")).to_string();
        let message = Scenario::parse(&file, "a.toml", None).expect_err("no such word").to_string();
        let mut known: BTreeSet<String> = expected(&message);
        // What files of earlier versions call the minimum norm.
        known.remove("tip-line");
        assert_eq!(known, words.iter().map(|word| (*word).to_owned()).collect(), "{}: {message}", key.path);
    }
}

/// What a key is set to if its default is typed is what stands there if nothing is.
#[test]
fn every_default_is_as_it_is_said() {
    let scenario = case_3().with_settings(
        &"base = { wheel = { inertia = 0.02 } }\nplant = { payload = { mass = 0.1 } }".parse().expect("TOML"),
    );
    let scenario = scenario.expect("a wheel and a payload");
    for (path, key, _) in scenario.settings() {
        let parts: Vec<&str> = path.split('.').collect();
        let without = scenario.with_settings(&change::at(&parts, DEFAULT_WORD));
        match key.default {
            Key::REQUIRED => assert!(without.is_err(), "{path} can be left out"),
            Key::NONE => {
                let without = without.expect("it may be left out");
                assert_eq!(without.value(&path), Some(DEFAULT_WORD.into()), "{path}");
            }
            default => {
                let without = without.expect("it may be left out");
                let typed =
                    scenario.with_settings(&change::at(&parts, change::value(default))).expect("its own default");
                assert_eq!(typed, without, "{path} = {default}");
            }
        }
    }
}

/// One range from everywhere: inside it a value is taken, outside it is refused with that range.
#[test]
fn every_range_is_as_it_is_said() {
    // Nothing else that a number has to fit: a base that moves, a wheel, short steps, a long payload.
    let scenario = case_3();
    for (path, key, _) in scenario.settings() {
        let Some(range) = key.range() else { continue };
        let beyond = |x: f64| if x == 0.0 { -1e-3 } else { x + 0.001 * x.abs() * x.signum() };
        let below = |x: f64| if x > 0.0 { 0.5 * x } else { beyond(x) };
        for outside in [below(range.low()), beyond(range.high())] {
            if outside > 9e18 {
                continue;
            }
            let value = match key.value_type {
                KeyType::List(count, _) => vec![outside; count].into(),
                KeyType::Bounds(_) => vec![outside; 2].into(),
                KeyType::Points(..) => Value::Array(vec![vec![outside, 0.0].into()]),
                KeyType::Whole(_) if outside > range.high() => Value::Integer(outside.ceil() as i64),
                KeyType::Whole(_) => Value::Integer(outside.floor() as i64),
                _ => outside.into(),
            };
            let parts: Vec<&str> = path.split('.').collect();
            let laid = scenario.with_settings(&change::at(&parts, value)).map_err(|e| e.to_string());
            let refused = laid.and_then(|laid| laid.check("--set").map_err(|e| e.to_string()));
            let message = refused.expect_err(&path);
            assert!(message.contains("want") || message.contains("instead"), "{path} = {outside}: {message}");
        }
    }
}

#[test]
fn every_key_says_what_it_means() {
    let mut seen = BTreeSet::new();
    for key in keys() {
        assert!(seen.insert(key.path), "{} stands twice", key.path);
        assert!(key.meaning.ends_with('.') && key.meaning.len() > 10, "{}: {}", key.path, key.meaning);
        assert!(key.meaning.chars().next().is_some_and(char::is_uppercase), "{}: {}", key.path, key.meaning);
        assert_eq!(key_of(key.path).map(|key| key.path), Some(key.path));
    }
    assert!(seen.len() > 70, "{}", seen.len());
}

/// A key without an effect says what it wants; in the case of the paper none is given that has none.
#[test]
fn what_has_no_effect_says_what_it_wants() {
    let scenario = case_3();
    assert_eq!(scenario.ineffective_keys(), []);
    for (path, _, _) in scenario.settings() {
        if let Some(wants) = scenario.condition_for_effect(&path) {
            assert!(!wants.is_empty(), "{path}");
        }
    }
    assert!(scenario.condition_for_effect("base.mass").is_some_and(|wants| wants.contains("base.kind")));
    assert!(scenario.condition_for_effect("task.blend").is_some_and(|wants| wants.contains("corners = blend")));
    assert_eq!(scenario.condition_for_effect("task.b"), None);
}

/// Sessions of earlier versions have an edit for each part.
#[test]
fn older_sessions_still_open() {
    let entries = [
        ("do = \"set-plant\"\nchange = { payload = { mass = 0.3 } }", "plant.payload.mass", "0.3"),
        ("do = \"set-base\"\nchange = { kind = \"free\" }", "base.kind", "free"),
        ("do = \"set-control\"\nchange = { kp = 300.0 }", "control.kp", "300.0"),
        ("do = \"set-tolerance\"\nchange = { moment_limit = 0.5 }", "tolerance.moment_limit", "0.5"),
        ("do = \"set-task\"\nchange = { shape = \"line\" }", "task.shape", "line"),
        ("do = \"set-machine\"\nkey = \"limits.a1\"\nvalue = \"0.4,2.7\"", "limits.a1", "0.4,2.7"),
        ("do = \"set-machine\"\nkey = \"gravity\"\nvalue = \"0,-9.81\"", "gravity", "0.0,-9.81"),
        ("do = \"set-time\"\ntime = 2.0", "task.time", "2.0"),
        ("do = \"compare-b\"\nb = 1.5", "compare_b", "1.5"),
    ];
    for (entry, path, value) in entries {
        let text = format!("{}\n[[edit]]\nstep = 0\n{entry}\n", case_3().to_toml());
        let scenario = Scenario::parse(&text, "old.toml", None).expect(entry);
        let session = Session::open(scenario).expect(entry);
        assert_eq!(
            session.scenario().value(path).map(|value| change::typed(&value)).as_deref(),
            Some(value),
            "{entry}"
        );
    }
    let hidden = "step = 0\ndo = \"compare-b\"".parse::<Table>().expect("TOML");
    let hidden = TimedEdit::from_table(hidden).expect("an edit").edit;
    assert_eq!(hidden, Edit::set("compare_b", DEFAULT_WORD));
    for (entry, words) in [
        ("do = \"set-plant\"", "change is missing"),
        ("do = \"set-plant\"\nchange = 3", "want a table"),
        ("do = \"set-machine\"\nkey = 3\nvalue = \"1\"", "key: want a text"),
        ("do = \"set-time\"\ntime = 1.0\nmore = 2", "has no key \"more\""),
    ] {
        let table: Table = format!("step = 0\n{entry}").parse().expect("TOML");
        let message = TimedEdit::from_table(table).expect_err(entry);
        assert!(message.contains(words), "{entry}: {message}");
    }
}

/// A key that says that no frame depends on it changes none, whether it is set at the start or while the machine moves;
/// it is undone and brought back without the run being made again.
#[test]
fn what_changes_no_frame_says_so() {
    let aside = |path: &str| key_of(path).map(|key| key.effect) == Some(Effect::NoFrame);
    assert!(aside("design.clearance") && aside("design.hold.link.5.mass") && aside("tolerance.seed"));
    assert!(!aside("task.time") && !aside("plant.force") && !aside("link.5.mass"));
    let mut session = Session::open(case_3()).expect("it opens");
    session.seek(0.2);
    let set: Vec<Edit> = [
        ("design.keep_balanced", Value::from(true)),
        ("design.clearance", 0.004.into()),
        ("design.fixed.9", true.into()),
        ("design.hold.link.5.mass", vec![0.4, 0.9].into()),
        ("design.ratio.2", vec![-4.0, -1.0].into()),
        ("design.penalties", "table-1".into()),
        ("tolerance.moment_limit", 0.5.into()),
    ]
    .map(|(path, value)| Edit::set(path, value))
    .into();
    let frames = session.frames().to_vec();
    let known = session.frames().revision().mark();
    for edit in &set {
        assert!(edit.affects_no_frame(), "{}", edit.title());
        session.apply(edit.clone()).expect("it is set");
        session.end_gesture();
    }
    let scenario = session.scenario().clone();
    assert_eq!(scenario.design.hold.len() + scenario.design.fixed.len() + scenario.design.ratio.len(), 3);
    let text = session.to_scenario().to_toml();
    let again = Session::open(Scenario::parse(&text, "again.toml", None).expect("its own file")).expect("it opens");
    assert_eq!(again.scenario().design, scenario.design);
    // Frames that have come since stay.
    session.seek(0.3);
    let later = session.frames().to_vec();
    for _ in &set {
        session.undo().expect("it is undone");
    }
    assert_eq!((&session.scenario().design, &session.scenario().tolerance), (&case_3().design, &case_3().tolerance));
    assert!(session.script().is_empty());
    for _ in &set {
        session.redo().expect("it is brought back");
    }
    assert_eq!(*session.scenario(), scenario);
    assert_eq!((&later[..frames.len()], session.frames().to_vec()), (&frames[..], later.clone()));
    assert!(session.frames().revision().unchanged_since(&known) >= frames.len(), "the frames were made again");
}

fn any_change() -> impl Strategy<Value = (String, Value)> {
    let all: Vec<(String, KeyType)> =
        case_3().settings().into_iter().map(|(path, key, _)| (path, key.value_type)).collect();
    (prop::sample::select(all), 0.0..1.0_f64, any::<bool>()).prop_map(|((path, holds), u, back)| {
        let within = |low: f64, high: f64| -> f64 { low.max(-5.0) + u * (high.min(5.0) - low.max(-5.0)) };
        let value = match holds {
            _ if back => DEFAULT_WORD.into(),
            KeyType::Number(range) | KeyType::PerDrive(range) => within(range.low(), range.high()).into(),
            KeyType::Whole(range) => Value::Integer(within(range.low(), range.high()).round() as i64),
            KeyType::List(count, range) => vec![within(range.low(), range.high()); count].into(),
            KeyType::Points(..) => Value::Array(vec![vec![0.5, 0.4 + 0.1 * u].into()]),
            KeyType::Choice(words) => words[(u * words.len() as f64) as usize % words.len()].into(),
            KeyType::Switch => (u > 0.5).into(),
            KeyType::Bounds(_) if u > 0.5 => HOLD_WORDS[(u * 8.0) as usize % 2].into(),
            KeyType::Bounds(range) => vec![within(range.low(), range.high()); 2].into(),
            KeyType::Spread(_) => format!("normal:{}", 0.01 * u).into(),
            KeyType::Rows | KeyType::EitherList(..) | KeyType::Names(_) => DEFAULT_WORD.into(),
        };
        (path, value)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]
    /// A setting that is laid over a scenario is what the scenario holds, is found again in its file, and what it
    /// replaced brings the scenario back.
    #[test]
    fn settings_are_laid_read_and_taken_back(changes in prop::collection::vec(any_change(), 1..6)) {
        let mut now = case_3();
        for (path, value) in changes {
            let parts: Vec<&str> = path.split('.').collect();
            let change = change::at(&parts, value.clone());
            let Ok(next) = now.with_settings(&change) else { continue };
            let back = now.present_values(&change).expect("every key is there");
            prop_assert_eq!(&next.with_settings(&back).expect("as it was"), &now, "{} = {}", path, value);
            if next.check("it").is_ok() {
                let again = Scenario::parse(&next.to_toml(), "again.toml", None).expect("its own file");
                prop_assert_eq!(again.value(&path), next.value(&path));
                now = next;
            }
        }
    }
}
