//! Machine files: what is written is read back equal, and whatever is wrong is named with its line.

use proptest::prelude::*;
use proptest::sample::select;
use stillbase::mechanics::machine::{FileError, Machine, MachineError, builtins, parse, to_toml};

const NINE_LINK: &str = include_str!("../../assets/machines/nine-link.toml");

/// A setting and a value that leaves every machine of nine links valid.
fn setting() -> impl Strategy<Value = (String, String)> {
    let link = || (1..=9).prop_map(|j| format!("link.{j}"));
    let number = |range: std::ops::Range<f64>| range.prop_map(|x| x.to_string());
    prop_oneof![
        (link(), number(1e-6..1e3)).prop_map(|(l, v)| (format!("{l}.mass"), v)),
        (link(), number(0.0..10.0)).prop_map(|(l, v)| (format!("{l}.inertia"), v)),
        (link(), select(vec!["com", "com_normal", "axial"]), number(-1.0..1.0))
            .prop_map(|(l, f, v)| (format!("{l}.{f}"), v)),
        (select(vec!["l1", "l2", "l3", "l5", "l9"]), number(1e-3..10.0)).prop_map(|(l, v)| (format!("length.{l}"), v)),
        number(0.0..100.0).prop_map(|v| ("payload.mass".into(), v)),
        number(0.0..1.0).prop_map(|v| ("payload.inertia".into(), v)),
        number(-1.0..1.0).prop_map(|v| ("payload.axial".into(), v)),
        (-20.0..20.0, -20.0..20.0).prop_map(|(x, y): (f64, f64)| ("gravity".into(), format!("{x},{y}"))),
        (select(vec!["a1", "a2"]), -7.0..0.0, 0.0..7.0)
            .prop_map(|(a, min, max): (&str, f64, f64)| (format!("limits.{a}"), format!("{min},{max}"))),
        (1..=3, select(vec!["torque", "speed", "acceleration", "jerk"]), number(1e-3..1e3))
            .prop_map(|(k, what, v)| (format!("drive.{k}.{what}_limit"), v)),
    ]
}

proptest! {
    #[test]
    fn a_machine_written_and_read_is_the_same(
        which in 0..2_usize,
        settings in prop::collection::vec(setting(), 0..12),
    ) {
        let pairs = settings.iter().map(|(k, v)| (k.as_str(), v.as_str()));
        let machine = builtins()[which].set_all(pairs).expect("valid settings");
        let text = to_toml(&machine);
        prop_assert_eq!(parse(&text, "again").expect("its own file"), machine, "{}", text);
    }

    #[test]
    fn a_setting_is_read_back_as_it_was_made((key, value) in setting()) {
        let machine = builtins()[0].set(&key, &value).expect("valid setting");
        let now = stillbase::settings::change::typed(&machine.value(&key).expect("known key"));
        let numbers = |text: &str| text.split(',').map(|x| x.parse().expect("a number")).collect::<Vec<f64>>();
        prop_assert_eq!(numbers(&now), numbers(&value));
        // Made again, it changes nothing.
        let again = machine.set(&key, &now).expect("valid setting");
        prop_assert_eq!(again, machine);
    }

    /// Whatever a file holds, reading it ends with a machine or with an error.
    #[test]
    fn a_file_cut_anywhere_is_an_error_or_a_machine(cut in 0..NINE_LINK.len(), end in 0..NINE_LINK.len()) {
        let text: String = NINE_LINK.char_indices().filter(|(i, _)| *i < cut || *i >= end).map(|(_, c)| c).collect();
        if let Err(error) = parse(&text, "cut.toml") {
            prop_assert!(error.to_string().starts_with("cut.toml"), "{}", error);
        }
    }
}

/// The error and the line it names.
fn wrong(text: &str) -> (MachineError, Option<usize>) {
    match parse(text, "arm.toml") {
        Err(FileError::Wrong { file, line, error, .. }) => {
            assert_eq!(file, "arm.toml");
            (error, line)
        }
        other => panic!("{other:?}\n{text}"),
    }
}

/// Replaces the first `from` and expects an error in the line where its last line begins.
fn damaged(from: &str, to: &str) -> MachineError {
    let at = NINE_LINK.find(from).unwrap_or_else(|| panic!("no {from:?}"));
    let line = NINE_LINK[..at + from.len()].matches('\n').count() + 1;
    let (error, found) = wrong(&NINE_LINK.replacen(from, to, 1));
    assert_eq!(found, Some(line), "{error}");
    error
}

#[test]
fn a_number_that_is_none_is_named() {
    for (from, to) in [
        ("l9 = 0.30", "l9 = nan"),
        ("mass = 1.45", "mass = inf"),
        ("inertia = 0.0025", "inertia = nan"),
        ("com = -0.11113242634709285", "com = -inf"),
        ("com = -0.11113242634709285", "com = 0.0\ncom_normal = nan"),
        ("com = -0.11113242634709285", "com = 0.0\naxial = nan"),
        ("[end_effector]", "[payload]\naxial = inf\n[end_effector]"),
        ("torque_limit = 20.0", "torque_limit = inf"),
        ("torque_limit = 20.0", "speed_limit = inf"),
        ("torque_limit = 20.0", "acceleration_limit = nan"),
        ("torque_limit = 20.0", "jerk_limit = inf"),
        ("offset = 3.141592653589793", "offset = nan"),
    ] {
        // A key added below its line is not where the text was.
        if ["com_normal", "axial"].iter().any(|key| to.contains(key)) {
            assert!(matches!(wrong(&NINE_LINK.replacen(from, to, 1)).0, MachineError::NotFinite { .. }));
            continue;
        }
        assert!(matches!(damaged(from, to), MachineError::NotFinite { .. }), "{to}");
    }
}

#[test]
fn a_number_out_of_range_is_named() {
    for (from, to) in [
        ("l9 = 0.30", "l9 = 0.0"),
        ("mass = 1.45", "mass = -1.45"),
        ("mass = 1.45", "mass = 0"),
        ("com = -0.11113242634709285", "axial = 2e6\ncom = 0"),
        ("inertia = 0.0025", "inertia = -0.0025"),
        ("direction = -1", "direction = 2"),
        ("torque_limit = 5.0", "torque_limit = -5.0"),
        ("torque_limit = 5.0", "speed_limit = 0.0"),
        ("torque_limit = 5.0", "acceleration_limit = -1.0"),
        ("torque_limit = 5.0", "jerk_limit = -5e3"),
        ("max = 3.141592653589793", "max = -1.0"),
        ("length = \"l9\"", "length = -0.3"),
    ] {
        let error = damaged(from, to);
        assert!(matches!(error, MachineError::OutOfRange { .. }), "{to}: {error}");
        assert!(error.to_string().contains("want"), "{error}");
    }
}

#[test]
fn a_name_that_nothing_has_is_named() {
    for (from, to) in [
        ("name = \"4\"\ndrive = \"1\"", "name = \"4\"\ndrive = \"one\""),
        ("attach = { link = \"2\", at = \"tip\" }", "attach = { link = \"20\", at = \"tip\" }"),
        ("attach = { link = \"2\", at = \"tip\" }", "attach = { link = \"2\", at = \"top\" }"),
        ("attach = \"base\"", "attach = \"wall\""),
        ("length = \"l9\"", "length = \"l8\""),
        ("b = { link = \"5\", at = \"-l2\" }", "b = { link = \"5\", at = \"-l4\" }"),
        ("to = \"2\"", "to = \"4\""),
        ("from = \"1\"", "from = \"0\""),
        ("[end_effector]\nlink = \"9\"", "[end_effector]\nlink = \"10\""),
    ] {
        let error = damaged(from, to);
        assert!(matches!(error, MachineError::Unknown { .. }), "{to}: {error}");
        assert!(error.to_string().contains("want one of"), "{error}");
    }
}

#[test]
fn a_name_that_steers_a_terminal_is_refused() {
    for (from, to) in [
        ("[[drive]]\nname = \"2\"", "[[drive]]\nname = \"2\u{9b}31m\""),
        ("[[link]]\nname = \"7\"", "[[link]]\nname = \"\u{202e}7\""),
        ("[[link]]\nname = \"7\"", "[[link]]\nname = \"7\\u2066\""),
        ("name = \"a2\"", "name = \"a\\u001b2\""),
        ("name = \"nine-link\"", "name = \"nine\u{2069}link\""),
    ] {
        let error = damaged(from, to);
        assert!(matches!(error, MachineError::Unprintable { .. }), "{to}: {error}");
        let said = error.to_string();
        assert!(said.contains("U+") && said.contains("want"), "{said}");
        assert_eq!(stillbase::settings::text::control_character(&said), None);
    }
}

#[test]
fn a_name_taken_twice_is_named() {
    for (from, to) in [
        ("[[drive]]\nname = \"2\"", "[[drive]]\nname = \"1\""),
        ("[[link]]\nname = \"7\"", "[[link]]\nname = \"6\""),
        ("name = \"a2\"", "name = \"a1\""),
    ] {
        assert!(matches!(damaged(from, to), MachineError::Duplicate { .. }), "{to}");
    }
}

#[test]
fn links_that_hang_on_each_other_are_named() {
    let error = damaged("attach = { link = \"2\", at = \"tip\" }", "attach = { link = \"4\", at = \"tip\" }");
    assert!(matches!(&error, MachineError::Cycle { link, .. } if link == "4"), "{error}");
    // 7 on 8 and 8 on 7: the first of them in the file is named.
    let from = "attach = { link = \"1\", at = \"tip\" }\nlength = \"l3\"";
    let at = NINE_LINK.find(from).expect("link 7");
    let (error, line) = wrong(&NINE_LINK.replacen(from, "attach = { link = \"8\", at = \"tip\" }\nlength = \"l3\"", 1));
    assert_eq!(line, Some(NINE_LINK[..at].matches('\n').count() + 1), "{error}");
    assert!(matches!(&error, MachineError::Cycle { link, .. } if link == "7"), "{error}");
}

#[test]
fn a_loop_that_does_not_close_is_named() {
    let second = NINE_LINK.match_indices("[[closure]]").nth(1).expect("closure").0;
    let line_of_second = Some(NINE_LINK[..second].matches('\n').count() + 1);
    let (error, line) = wrong(&NINE_LINK.replacen("a = { link = \"6\"", "a = { link = \"4\"", 1));
    assert!(matches!(error, MachineError::OpenLoop { .. }), "{error}");
    assert_eq!(line, line_of_second, "{error}");
    // One bar that no longer has the shared length opens its parallelogram.
    let link = NINE_LINK.find("name = \"6\"").expect("link 6");
    let text = format!("{}{}", &NINE_LINK[..link], NINE_LINK[link..].replacen("length = \"l1\"", "length = 0.55", 1));
    let (error, line) = wrong(&text);
    assert_eq!(line, line_of_second, "{error}");
    assert!(error.to_string().contains("0.050000 m along drive 1"), "{error}");
}

#[test]
fn what_is_missing_altogether_has_no_line() {
    let between = |from: &str, to: &str| {
        let (a, b) = (NINE_LINK.find(from).expect(from), NINE_LINK.find(to).expect(to));
        wrong(&[&NINE_LINK[..a], &NINE_LINK[b..]].concat())
    };
    assert_eq!(between("[end_effector]", "# Relative joint angles"), (MachineError::NoEndEffector, None));
    let (error, line) = between("[[drive]]", "# attach:");
    assert!(matches!(error, MachineError::Count { what: "drives", count: 0, .. }) && line.is_none(), "{error}");
    let (error, line) = between("[[link]]", "# The pins");
    assert!(matches!(error, MachineError::Count { what: "links", count: 0, .. }) && line.is_none(), "{error}");
}

#[test]
fn a_drive_that_moves_nothing_is_named() {
    let idle = NINE_LINK.replacen("[[link]]", "[[drive]]\nname = \"idle\"\n\n[[link]]", 1);
    assert_eq!(wrong(&idle), (MachineError::Massless { drive: "idle".into() }, None));
}

#[test]
fn more_drives_than_can_be_are_refused() {
    let drives: String = (4..=9).map(|k| format!("[[drive]]\nname = \"{k}\"\n\n")).collect();
    let (error, _) = wrong(&NINE_LINK.replacen("[[link]]", &format!("{drives}[[link]]"), 1));
    assert!(matches!(error, MachineError::Count { what: "drives", count: 9, .. }), "{error}");
}

/// Work on a machine grows with what it holds, so that each list has an end, and the message says which.
#[test]
fn what_a_machine_holds_too_many_of_is_refused() {
    let refused = |text: &str| match wrong(text) {
        (MachineError::Count { what, count, want }, _) => (what, count, want),
        (error, _) => panic!("{error}"),
    };
    let appended = |one: &dyn Fn(usize) -> String, count: usize| {
        NINE_LINK.to_owned() + &(0..count).map(one).collect::<Vec<_>>().concat()
    };
    let weight = |_: usize| "[[counterweight]]\nlink = \"1\"\nmass = 0.1\nat = -0.1\n".to_owned();
    assert!(parse(&appended(&weight, 200), "m.toml").is_ok(), "so many are right");
    for count in [201, 20_000] {
        assert_eq!(refused(&appended(&weight, count)), ("counterweights", count, "at most 200".into()));
    }
    let link = |i: usize| {
        let attach = "attach = \"base\"\nlength = 0.1\nmass = 0.1\ninertia = 0.001\ncom = 0.05\n";
        format!("[[link]]\nname = \"x{i}\"\ndrive = \"1\"\n{attach}")
    };
    assert!(parse(&appended(&link, 191), "m.toml").is_ok(), "so many are right");
    assert_eq!(refused(&appended(&link, 192)), ("links", 201, "1 to 200".into()));
    assert_eq!(refused(&appended(&link, 30_000)), ("links", 30_009, "1 to 200".into()));
    let in_a_row = |i: usize| {
        let on = if i == 0 { "\"base\"".to_owned() } else { format!("{{ link = \"x{}\", at = \"tip\" }}", i - 1) };
        link(i).replace("\"base\"", &on)
    };
    assert!(parse(&appended(&in_a_row, 32), "m.toml").is_ok(), "so many are right");
    assert_eq!(refused(&appended(&in_a_row, 33)), ("links in a row, each on the one before", 33, "at most 32".into()));
    let angle = |i: usize| format!("[[angle]]\nname = \"x{i}\"\nto = \"1\"\nfrom = \"2\"\n");
    assert_eq!(refused(&appended(&angle, 70)).0, "angles");
    let closure = |_: usize| "[[closure]]\na = { link = \"1\" }\nb = { link = \"1\" }\n".to_owned();
    assert_eq!(refused(&appended(&closure, 400)).0, "closures");
    let length = |i: usize| format!("x{i} = 0.3\n");
    let lengths = "[lengths]\n".to_owned() + &(0..400).map(length).collect::<Vec<_>>().concat();
    assert_eq!(refused(&NINE_LINK.replacen("[lengths]\n", &lengths, 1)).0, "named lengths");
    let long = NINE_LINK.replace("link = \"9\"", &format!("link = \"{}\"", "9x".repeat(60)));
    let long = long.replace("[[link]]\nname = \"9\"", &format!("[[link]]\nname = \"{}\"", "9x".repeat(60)));
    let (error, line) = wrong(&long);
    assert!(matches!(error, MachineError::TooLong { most: 100, .. }) && line.is_some(), "{error}");
    assert!(error.to_string().contains("want at most 100 characters"), "{error}");
}

#[test]
fn what_is_no_machine_file_is_named() {
    for (from, to) in [
        ("mass = 1.45", "mass ="),
        ("mass = 1.45", "mass = \"heavy\""),
        ("mass = 1.45", "weight = 1.45"),
        ("[lengths]", "[length]"),
        ("at = \"-l2\" }", "at = [1] }"),
    ] {
        let error = damaged(from, to);
        assert!(matches!(error, MachineError::Syntax(_)), "{to}: {error}");
    }
    // A key that is missing is missed in its table.
    let (error, line) = wrong(&NINE_LINK.replacen("mass = 1.45\n", "", 1));
    let table = NINE_LINK.match_indices("[[link]]").nth(1).expect("link 2").0;
    assert_eq!(line, Some(NINE_LINK[..table].matches('\n').count() + 1), "{error}");
    assert!(error.to_string().contains("mass of link 2 (link.2.mass) is missing"), "{error}");
}

#[test]
fn settings_that_no_file_can_hold_are_refused() {
    let set = |key: &str, value: &str| builtins()[0].set(key, value).expect_err("wrong");
    let shared = set("link.4.length", "0.6");
    assert!(matches!(&shared, MachineError::SharedLength { length, .. } if length == "l1"), "{shared}");
    assert!(shared.to_string().contains("links 1, 6"), "{shared}");
    assert!(matches!(set("link.4.size", "1"), MachineError::UnknownKey { .. }));
    assert!(matches!(set("link.4.mass", "1,2"), MachineError::BadValue { .. }));
    assert!(matches!(set("limits.a1", "1"), MachineError::BadValue { .. }));
    assert!(matches!(set("length.l4", "1"), MachineError::Unknown { .. }));
    assert!(matches!(set("payload.mass", "-1"), MachineError::OutOfRange { .. }));
    // A length with one bar may be set through it.
    let longer: Machine = builtins()[0].set("link.9.length", "0.4").expect("its own length");
    assert_eq!(longer.value("length.l9"), Some(0.4.into()));
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let missing = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("no-such-machine.toml");
    let error = stillbase::files::machine(&missing.display().to_string(), None).expect_err("no file");
    assert!(matches!(error, FileError::Unreadable { .. }) && error.to_string().contains("no-such-machine.toml"));
}
