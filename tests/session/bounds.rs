//! Every number has a range, every run an end, and every message names what is wrong: file, line, key and range.

use std::time::{Duration, Instant};

use proptest::prelude::*;
use stillbase::mechanics::machine::builtin;
use stillbase::session::scenario::{MAX_STEPS, MAX_TIME, Scenario};
use stillbase::session::{Edit, Refusal, Run, Session, TimedEdit, replay, replay_if};
use stillbase::settings::number::ShortNumber;

const CASE_3: &str = include_str!("../../assets/scenarios/case-3.toml");

/// Numeric keys of a scenario, what stands before each in a file, and the least and greatest that it takes.
const KEYS: [(&str, &str, f64, f64); 24] = [
    ("step", "", 1e-5, 0.01),
    ("duration", "", 0.0, 3600.0),
    ("pose_acceleration", "", 1e-6, 1e6),
    ("compare_b", "", -1e3, 1e3),
    ("b", "task", -1e3, 1e3),
    ("b_to", "task", -1e3, 1e3),
    ("time", "task", 1e-5, 3600.0),
    ("blend", "task", 0.0, 1.0),
    ("turn", "task", -1e3, 1e3),
    ("moment_limit", "task", 1e-9, 1e9),
    ("first_drive_to", "task", -1e3, 1e3),
    ("delay", "control", 0.0, 1.0),
    ("mass", "plant.payload", 0.0, 1e4),
    ("inertia", "plant.payload", 0.0, 1e4),
    ("axial", "plant.payload", -1e3, 1e3),
    ("from", "plant.payload", 0.0, 1e6),
    ("until", "plant.payload", 0.0, 1e6),
    ("pin_viscous", "plant.friction", 0.0, 1e4),
    ("pin_coulomb", "plant.friction", 0.0, 1e4),
    ("mass", "base", 1e-9, 1e6),
    ("inertia", "base", 1e-9, 1e6),
    ("inertia", "base.wheel", 1e-9, 1e6),
    ("torque_limit", "base.wheel", 1e-9, 1e6),
    ("speed_limit", "base.wheel", 1e-9, 1e6),
];

/// Case 3 with a key set to a text, and the line where that stands.
fn with(key: &str, table: &str, value: &str) -> (String, usize) {
    let own = |line: &&str| line.split('=').next().is_some_and(|k| k.trim() == key);
    let mut lines: Vec<String> = CASE_3.lines().map(String::from).collect();
    let task = lines.iter().position(|line| line == "[task]").expect("a task");
    let entry = format!("{key} = {value}");
    match table {
        "task" | "" => {
            let (from, to) = if table.is_empty() { (0, task) } else { (task, lines.len()) };
            lines = lines
                .iter()
                .enumerate()
                .filter(|(i, l)| *i < from || *i >= to || !own(&l.as_str()))
                .map(|(_, l)| l.clone())
                .collect();
            let head = lines.iter().position(|line| line == "[task]").expect("a task");
            lines.insert(if table.is_empty() { head } else { head + 1 }, entry.clone());
        }
        table => lines.extend([format!("[{table}]"), entry.clone()]),
    }
    let line = lines.iter().position(|line| *line == entry).expect("there") + 1;
    (lines.join("\n") + "\n", line)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    /// A number beyond its range is refused with the file, the line, the key, and in few words.
    #[test]
    fn a_number_out_of_range_is_named_with_its_line(which in 0..KEYS.len(), over in any::<bool>(), by in -12.0..290.0f64) {
        let (key, table, low, high) = KEYS[which];
        let away = 10f64.powf(by) + 1e-9;
        let value = if over { high + away.max(1e-9 * high) } else { low - away.max(1e-9 * low.abs()) };
        prop_assume!(value < low || value > high);
        let (text, line) = with(key, table, &format!("{value:e}"));
        let error = Scenario::parse(&text, "own.toml", None).expect_err("out of range").to_string();
        let named = if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") };
        let plain = stillbase::session::scenario::name_of(&named);
        let called = if plain == named { named } else { format!("{plain} ({named})") };
        let head = format!("own.toml:{line}: {called} is {}: want ", ShortNumber(value));
        prop_assert!(error.starts_with(&head), "{error}, not {head}");
        prop_assert!(error.len() < 200 && !error.contains("NaN"), "{error}");
    }

    /// A number in its range is taken, or what is said against it is said of something else.
    #[test]
    fn a_number_in_range_is_read_back(which in 0..KEYS.len(), share in 0.0..=1.0f64) {
        let (key, table, low, high) = KEYS[which];
        let value = low + share * (high - low);
        match Scenario::parse(&with(key, table, &format!("{value:e}")).0, "own.toml", None) {
            Ok(read) => {
                let again = Scenario::parse(&read.to_toml(), "own.toml", None).expect("its own file");
                prop_assert_eq!(again, read);
            }
            // A whole number of steps, later than another time, as long as a step.
            Err(error) => prop_assert!(["delay", "until", "time"].contains(&key), "{}", error),
        }
    }

    /// A bad entry among good ones is named: its line, and which it is, wherever it stands.
    #[test]
    fn a_bad_edit_is_named_with_its_line_and_place(
        place in 0..12usize,
        steps in prop::collection::vec(0..200u64, 12),
        bad in 0..10usize,
    ) {
        let (bad, words) = [
            ("do = \"slide-b\"\nb = 1e300", "b is 1e300: want -1000 to 1000 rad"),
            ("do = \"slide-b\"\nb = nan", "b is not a number: want -1000 to 1000 rad"),
            ("do = \"drag-target\"\nx = -2e7\ny = 0.0", "x is -2e7: want -1000000 to 1000000 m"),
            ("do = \"slide-c\"\nb = 1.0", "is \"slide-c\": want \"slide-b\" (nearest)"),
            ("do = \"slide-b\"\nc = 1.0", "has no key \"c\""),
            ("do = \"set-plant\"\nchange = { payload = { mass = -1.0 } }", "plant.payload.mass) is -1: want 0 to 10000 kg"),
            ("do = \"set-plant\"\nchange = { payload = { weight = 1.0 } }", "weight"),
            ("do = \"set-control\"\nchange = { kp = 1e99 }", "control.kp) is 1e99"),
            ("do = \"set-machine\"\nkey = \"link.5.mass\"\nvalue = \"-1\"", "link.5.mass) is -1: want 1e-15 to 1000000 kg"),
            ("do = \"set-time\"\ntime = 1e9", "time) is 1e9: want"),
        ][bad];
        let mut text = CASE_3.to_owned();
        let mut line = 0;
        for (i, step) in steps.iter().enumerate() {
            if i == place {
                line = text.lines().count() + 1;
            }
            let entry = if i == place { bad } else { "do = \"slide-b\"\nb = 2.45" };
            text.push_str(&format!("[[edit]]\nstep = {step}\n{entry}\n"));
        }
        let error = Scenario::parse(&text, "saved.toml", None).expect_err("a bad entry").to_string();
        let ending = ["st", "nd", "rd"].get(place).copied().unwrap_or("th");
        // What the entry cannot hold is named at its key, what the scenario cannot, by the entry.
        let n = place + 1;
        let head = match bad.lines().next() {
            Some("do = \"slide-c\"") => format!("saved.toml:{}: kind of edit {n} (edit[{n}].do) ", line + 2),
            _ if bad.contains("\nc = ") => format!("saved.toml:{}: edit {n} ", line + 3),
            _ => format!("saved.toml:{line}: the {n}{ending} [[edit]]: "),
        };
        prop_assert!(error.starts_with(&head) && error.contains(words), "{error}, not {head}{words}");
        prop_assert!(error.len() < 400, "{error}");
    }
}

/// What differs in a plant, the machine of a file and its settings are named with their lines too.
#[test]
fn machines_inside_a_scenario_are_named_with_their_lines() {
    let said = |text: &str| Scenario::parse(text, "own.toml", None).expect_err("wrong").to_string();
    let lines = CASE_3.lines().count();
    let error = said(&format!("{CASE_3}[plant.link.5]\ncom = 0.0\nmass = -3.0\n"));
    assert!(error.starts_with(&format!("own.toml:{}: mass of link 5 (plant.link.5.mass) is -3", lines + 3)), "{error}");
    let error = said(&format!("{CASE_3}[plant.length]\nl1 = 0.5\nl2 = 1e300\n"));
    assert!(error.starts_with(&format!("own.toml:{}: length l2 (plant.length.l2) is 1e300", lines + 3)), "{error}");
    let error = said(&format!("{CASE_3}[plant.link.55]\nmass = 3.0\n"));
    assert!(error.starts_with(&format!("own.toml:{}: ", lines + 2)) && error.contains("\"55\""), "{error}");
    let error = said(&CASE_3.replace("[task]", "set = [\"link.5.mass=-1\"]\n[task]"));
    let line = CASE_3.lines().position(|line| line == "[task]").expect("there") + 1;
    assert!(error.starts_with(&format!("own.toml:{line}: machine: mass of link 5 (link.5.mass) is -1")), "{error}");
    let machine = stillbase::mechanics::machine::to_toml(builtin("nine-link").expect("built in"));
    let inline = Scenario {
        machine: builtin("nine-link").expect("it").set("payload.mass", "0.1").expect("valid"),
        ..Scenario::builtin("case-3").expect("it")
    };
    let text = inline.to_toml();
    assert!(text.contains("[[machine.link]]") && !machine.is_empty());
    let bad = text.replacen("mass = 1.45", "mass = -1.45", 1);
    let line = bad.lines().position(|line| line == "mass = -1.45").expect("there") + 1;
    let error = said(&bad);
    assert!(error.starts_with(&format!("own.toml:{line}: machine: mass of link 2 (link.2.mass) is -1.45")), "{error}");
}

/// Nothing that is asked for within the ranges takes for ever: what would is refused at once.
#[test]
fn what_would_take_too_long_is_refused_at_once() {
    let began = Instant::now();
    let case = |name: &str| Scenario::builtin(name).expect("built in");
    let mut slow = case("change-b");
    slow.task.moment_limit = Some(1e-9);
    let mut crawling = case("circle");
    crawling.machine = crawling.machine.set("drive.1.speed_limit", "1e-9").expect("in range");
    for scenario in [slow, crawling] {
        let refusal = Run::new(&scenario).expect_err("an hour and more");
        assert!(matches!(refusal, Refusal::TooLong { time } if time > MAX_TIME), "{refusal}");
        assert!(refusal.to_string().contains("want at most 3600 s"), "{refusal}");
        assert!(matches!(replay(&scenario, |_, _| {}), Err(Refusal::TooLong { .. })));
        assert!(Session::open(scenario).is_err());
    }
    let long = Scenario { duration: Some(3600.0), step: 1e-5, ..case("case-3") };
    let refusal = replay(&long, |_, _| {}).expect_err("too many steps");
    assert!(matches!(refusal, Refusal::TooManySteps { steps: 360_000_000, .. }), "{refusal}");
    assert!(refusal.to_string().contains(&MAX_STEPS.to_string()), "{refusal}");
    let refused = replay_if(&case("case-3"), |last| Err(Refusal::Task(format!("{last}"))), |_, _| panic!("it ran"));
    assert_eq!(refused.err(), Some(Refusal::Task("1000".into())));
    for value in ["1e-308", "1e-12", "-1", "0"] {
        assert!(builtin("nine-link").expect("it").set("drive.1.speed_limit", value).is_err(), "{value}");
    }
    assert!(began.elapsed() < Duration::from_secs(20), "{:?}", began.elapsed());
}

/// Turns that a pose constant is off by cost nothing, however many: a sum of them stood still beyond 2⁵³.
#[test]
fn poses_of_a_huge_pose_constant_end() {
    let planes = crate::support::planes(builtin("nine-link").expect("built in"));
    let period = planes.map().period();
    let p = stillbase::mechanics::planar::Vector::new(0.5, 0.5);
    for b in [-2.3e18, 2.3e18, 1e300, -9.1e15] {
        // No digits are left that could tell poses; only that it ends.
        assert!(planes.map().poses(p, b).iter().count() <= 64);
    }
    let near = planes.map().poses(p, 2.4).iter().count();
    assert_eq!(planes.map().poses(p, 2.4 - 100.0 * period).iter().count(), near);
}

/// An edit among eight thousand costs about what one among five hundred does, by hand and from a file; and is undone.
#[test]
fn edits_cost_the_same_however_many_there_are() {
    let scenario = || Scenario { step: 0.01, duration: Some(5.0), ..Scenario::builtin("case-3").expect("built in") };
    let steer = |i: usize| Edit::SlideB { b: 2.4 + 1e-3 * (i % 7) as f64 };
    let by_hand = |count: usize| {
        let mut session = Session::open(scenario()).expect("it starts");
        let began = Instant::now();
        for i in 0..count {
            session.end_gesture();
            session.apply(steer(i)).expect("in range");
            if i % 1000 == 0 {
                session.tick(1);
            }
        }
        (session, began.elapsed().as_secs_f64() / count as f64)
    };
    let (_, few) = by_hand(500);
    let (mut session, many) = by_hand(8000);
    assert_eq!(session.script().len(), 8000);
    // Quadratic, it would be sixteen times as much.
    assert!(many < 5.0 * few + 1e-4, "{many:.6} s an edit among 8000, {few:.6} s among 500");
    let saved = session.to_scenario();
    let began = Instant::now();
    let mut frames = 0;
    replay(&saved, |_, _| frames += 1).expect("it replays");
    assert_eq!(frames, session.frames().len());
    let again = began.elapsed().as_secs_f64() / 8000.0;
    assert!(again < 5.0 * few + 1e-4, "{again:.6} s an edit in a replay");
    session.pause();
    for left in (0..20).rev() {
        session.undo().expect("it was so before");
        assert_eq!(session.script().len(), 7980 + left);
    }
}

/// Where a session is full, what could no longer have an effect is refused, and says how much it keeps.
#[test]
fn a_full_session_says_so() {
    let mut session =
        Session::open(Scenario { step: 0.01, ..Scenario::builtin("case-3").expect("it") }).expect("it starts");
    session.apply(Edit::SlideB { b: 2.41 }).expect("in range");
    session.end_gesture();
    session.play();
    session.step_by(10_000_000);
    assert!(session.is_full() && session.is_at_end());
    let (script, frames) = (session.script().len(), session.frames().len());
    for edit in [Edit::SlideB { b: 2.5 }, Edit::DragTarget { x: 0.5, y: 0.6 }, Edit::Push { x: 1.0, y: 0.0 }] {
        let refusal = session.apply(edit).expect_err("full");
        assert!(matches!(refusal, Refusal::Full { .. }) && refusal.to_string().contains("180000"), "{refusal}");
    }
    assert_eq!((session.script().len(), session.frames().len()), (script, frames));
    // From an earlier instant it goes on.
    session.seek(1.0);
    session.apply(Edit::SlideB { b: 2.5 }).expect("there is room again");
    session.tick(10);
    assert!(!session.is_full() && session.frames().len() < 200);
    // A file that needs more room than a session has is not opened in part.
    let edits = vec![TimedEdit { step: 200_000, edit: Edit::SlideB { b: 2.5 } }];
    let long = Scenario { duration: Some(250.0), edits, ..Scenario::builtin("case-3").expect("it") };
    let refusal = Session::open(long).expect_err("too long").to_string();
    assert!(
        refusal.starts_with("the 1st [[edit]], slide b to 2.500 rad at step 200000: a session keeps 180000"),
        "{refusal}"
    );
}
