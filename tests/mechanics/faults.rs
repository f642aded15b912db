//! All faults of a machine file at once: each with its line, its name and an example, and none that follows from another.

use stillbase::mechanics::machine::{Machine, SMALLEST, builtins, parse, to_toml};
use stillbase::settings::fault::{Fault, Faults, MAX_FAULTS};

const NINE_LINK: &str = include_str!("../../assets/machines/nine-link.toml");

fn faults(text: &str) -> Faults {
    parse(text, "arm.toml").expect_err("it has faults").faults().expect("they are told").clone()
}

/// The line in which a text stands, from 1.
fn line_of(text: &str, part: &str) -> usize {
    text[..text.find(part).unwrap_or_else(|| panic!("no {part}"))].matches('\n').count() + 1
}

/// Every fault stands in its line, with its key, words of it and of its example; there are no others.
#[track_caller]
fn all_are(text: &str, want: &[(&str, &str, &str, &str)]) {
    let found = faults(text);
    assert_eq!(found.count(), want.len(), "{:#?}", found.list);
    for (part, key, words, example) in want {
        let line = if part.is_empty() { None } else { Some(line_of(text, part)) };
        let is_it = |fault: &&Fault| fault.line == line && fault.key == *key;
        let fault = found.list.iter().find(is_it).unwrap_or_else(|| panic!("{key} in {line:?}: {:#?}", found.list));
        assert!(fault.text.contains(words), "{fault:?}");
        assert!(fault.example == *example, "{fault:?}");
        assert!(fault.column.is_some() == line.is_some());
    }
}

#[test]
fn all_faults_are_told_at_once() {
    let text = "\
name = \"bad\"
belt = 2
[[drive]]
name = \"1\"
gear = 50
[[drive]]
name = \"2\"
torqe_limit = 20.0
[[link]]
name = \"a\"
drive = \"1\"
attach = \"base\"
length = \"l1\"
weight = 2.0
com = \"middle\"
[[link]]
name = \"b\"
drive = \"3\"
attach = { link = \"c\", at = \"tip\" }
length = 0.3
mass = -0.4
inertia = nan
com = 0.0
colour = \"red\"
[[angle]]
name = \"a1\"
to = \"2\"
from = \"1\"
min = 0.2
";
    all_are(
        text,
        &[
            (
                "belt = 2",
                "belt",
                "a belt from the base is a drive of its own",
                "[[drive]]\nname = \"2\"\nrotor = { inertia = 1e-4, ratio = 3 }",
            ),
            ("gear = 50", "drive.1.gear", "rotor = { inertia", "rotor = { inertia = 1e-4, ratio = 50 }"),
            ("torqe", "drive.2.torqe_limit", "torque_limit (nearest)", "torque_limit = 20.0"),
            (
                "[[link]]",
                "link.a.inertia",
                "inertia of link a (link.a.inertia) is missing: want 0 to",
                "inertia = 0.02",
            ),
            ("length = \"l1\"", "link.a.length", "does not exist: want a number in m", "length = 0.5"),
            ("weight", "link.a.weight", "want mass of link a (link.a.mass)", "mass = 2.0"),
            ("com = \"middle\"", "link.a.com", "is the text \"middle\": want a number", "com = 0.25"),
            ("drive = \"3\"", "link.b.drive", "want one of \"1\", \"2\"", "drive = \"1\""),
            ("attach = {", "link.b.attach.link", "want one of \"a\", \"b\"", "link = \"a\""),
            ("mass = -0.4", "link.b.mass", "mass of link b (link.b.mass) is -0.4: want 1e-15 to", "mass = 1.2"),
            ("inertia = nan", "link.b.inertia", "is not a number", "inertia = 0.02"),
            ("colour", "link.b.colour", "want one of name, drive, attach", ""),
            ("[[angle]]", "limits.a1 (max)", "upper limit of angle a1 (limits.a1, max) is missing", "max = 2.9"),
            ("", "end_effector", "is missing", "[end_effector]\nat = \"tip\"\nlink = \"a\""),
        ],
    );
}

/// What follows from the whole is told if nothing was made up for it.
#[test]
fn what_follows_from_made_up_numbers_is_no_fault() {
    let open = NINE_LINK.replacen("l2 = 0.", "l2 = 1.", 1);
    assert_ne!(open, NINE_LINK);
    let of_parts = NINE_LINK.replacen("[[closure]]\na = { link = \"4\"", "[[closure]]\na = { link = \"6\"", 1);
    let loops = faults(&of_parts);
    assert!(loops.count() == 1 && loops.list[0].text.contains("parallelogram that closes"), "{loops:?}");
    let both = faults(&of_parts.replacen("mass = 1.45", "mass = 1.45\ncolour = 1", 1));
    assert_eq!(both.count(), 2, "a key that is left out makes nothing up: {both:?}");
    let hidden = faults(&NINE_LINK.replacen("length = \"l9\"", "length = \"l99\"", 1));
    assert!(hidden.count() == 1 && hidden.list[0].key == "link.9.length", "{hidden:?}");
}

#[test]
fn a_file_of_nothing_shows_a_smallest_machine() {
    let smallest = parse(SMALLEST, "smallest.toml").expect("it is a machine");
    assert_eq!((smallest.drives(), smallest.links().len()), (1, 1));
    for text in ["", "# nothing\n", "[package]\nname = \"x\"\n"] {
        let found = faults(text);
        assert!(found.count() == 1 && found.list[0].line.is_none(), "{found:?}");
        assert_eq!(found.list[0].example, SMALLEST);
        assert!(found.list[0].text.contains("want [[drive]], [[link]] and [end_effector]"), "{found:?}");
    }
}

/// The first are told, the others counted; what is no TOML is told in all places.
#[test]
fn many_faults_are_counted() {
    let many: String = (0..60).map(|i| format!("x{i} = 1\n")).collect::<String>() + NINE_LINK;
    let found = faults(&many);
    assert_eq!((found.list.len(), found.more, found.is_cut), (MAX_FAULTS, 60 - MAX_FAULTS, false));
    assert_eq!(found.list.iter().map(|fault| fault.line).collect::<Vec<_>>(), (1..=20).map(Some).collect::<Vec<_>>());
    assert_eq!(found.rest().expect("there are more"), "and 40 more");
    let far: String = (0..3000).map(|i| format!("x{i} = 1\n")).collect::<String>() + NINE_LINK;
    let found = faults(&far);
    assert!(found.is_cut && found.count() >= 100, "{} of 3000", found.count());
    let broken = faults("a = \nb = 1\nc = = 2\n");
    assert!(broken.count() >= 2 && broken.list.iter().all(|fault| fault.text.contains("not TOML")), "{broken:?}");
    assert_eq!((broken.list[0].line, broken.list.last().and_then(|fault| fault.line)), (Some(1), Some(3)));
}

/// Whatever single line is missing from a machine, each fault that is told is real: with all keys missing at once, each
/// is told once, and the example of each mends it.
#[test]
fn examples_mend_what_they_are_of() {
    for key in ["drive", "attach", "length", "mass", "inertia", "com", "name"] {
        let without: String =
            SMALLEST.lines().filter(|line| !line.starts_with(&format!("{key} ="))).map(|l| format!("{l}\n")).collect();
        let found = faults(&without);
        assert!(!found.list.is_empty());
        let mut lines: Vec<String> = without.lines().map(Into::into).collect();
        // From the last line on, so that those above stay where they are; keys of the whole file come first of all.
        let mut faults = found.list.clone();
        faults.sort_by_key(|fault| std::cmp::Reverse(fault.line.unwrap_or(0)));
        for fault in faults.iter().filter(|fault| !fault.example.is_empty()) {
            lines.insert(fault.line.unwrap_or(0), fault.example.clone());
        }
        let mended = lines.join("\n");
        parse(&mended, "mended.toml").unwrap_or_else(|why| panic!("{key}: {why}\n{mended}"));
    }
}

/// Every key that a machine's file holds has a plain name, and an example that is TOML.
#[test]
fn every_key_has_a_name() {
    use stillbase::mechanics::machine::{KeyPath, KeyStep, MachineWords};
    use stillbase::settings::mending::Vocabulary as _;
    fn named(value: &toml::Value, path: &KeyPath, count: &mut usize) {
        match value {
            toml::Value::Table(table) => table.iter().for_each(|(key, value)| {
                let path = path.key(key);
                assert!(MachineWords.name(&path).is_some(), "{path}");
                let example = MachineWords.example(&path);
                let is_toml = |text: &str| format!("x = {text}").parse::<toml::Table>().is_ok();
                assert!(example.is_none_or(is_toml), "{path}: {example:?}");
                *count += 1;
                named(value, &path, count);
            }),
            toml::Value::Array(list) if list.iter().all(toml::Value::is_table) => {
                for (i, one) in list.iter().enumerate() {
                    named(one, &KeyPath(path.0.iter().cloned().chain([KeyStep::At(i)]).collect()), count);
                }
            }
            _ => {}
        }
    }
    let mut count = 0;
    let with_parts = include_str!("parts.toml");
    let texts = builtins().iter().map(|machine: &Machine| to_toml(machine)).chain([with_parts.to_owned()]);
    for text in texts {
        named(&toml::Value::Table(text.parse().expect("TOML")), &KeyPath::default(), &mut count);
    }
    assert!(count > 500, "{count}");
}
