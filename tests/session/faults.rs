//! All faults of a scenario file at once, those of the machine in it included.

use stillbase::mechanics::machine::{SMALLEST, parse};
use stillbase::session::scenario::{MachineFile, Scenario, ScenarioError};
use stillbase::settings::fault::Faults;

const CASE: &str = include_str!("../../assets/scenarios/case-3.toml");

fn faults(text: &str) -> Faults {
    let error = Scenario::parse(text, "my.toml", None).expect_err("it has faults");
    let (file, faults) = error.faults().expect("they are told");
    assert_eq!(file, "my.toml");
    faults.clone()
}

/// The line of a text on which a part of it begins, from 1.
fn line(text: &str, part: &str) -> usize {
    text[..text.find(part).expect("it is there")].matches('\n').count() + 1
}

fn keys(faults: &Faults) -> Vec<&str> {
    faults.list.iter().map(|fault| fault.key.as_str()).collect()
}

#[test]
fn all_faults_of_a_scenario_are_told_at_once() {
    let text = format!(
        "tilte = \"x\"\n{}\n[control]\nkp = -1.0\nlaw = \"magic\"\n[base]\nkind = \"free\"\nmass = \"heavy\"\n\
         [[edit]]\nstep = 1\ndo = \"dance\"\n[[edit]]\nstep = 2\ndo = \"slide-b\"\nb = 2.5\n\
         [[edit]]\nstep = 3\ndo = \"slide-b\"\nc = 2.5\n",
        CASE.replace("time = 1.0", "tiem = 1.0")
    );
    let found = faults(&text);
    let want = ["tilte", "task.tiem", "control.kp", "control.law", "base.mass", "edit[1].do", "edit[3].b", "edit[3].c"];
    assert_eq!(keys(&found), want, "{:#?}", found.list);
    let of = |key: &str| found.list.iter().find(|fault| fault.key == key).expect("it is told");
    assert!(of("tilte").text.contains("title (nearest)"));
    assert_eq!(of("task.tiem").example, "time = 1.0");
    assert!(of("control.kp").text.starts_with("position gain (control.kp) is -1: want 0 to"), "{:?}", of("control.kp"));
    assert!(of("base.mass").text.starts_with("mass of the base (base.mass) is the text \"heavy\""));
    assert!(of("edit[3].c").text.starts_with("edit 3 has no key \"c\""), "{:?}", of("edit[3].c"));
    for (key, part) in [("task.tiem", "tiem"), ("control.law", "law = \"magic"), ("edit[3].c", "c = 2.5")] {
        assert_eq!(of(key).line, Some(line(&text, part)), "{key}");
    }
}

/// A machine within a scenario is told as one in its own file, with its lines there.
#[test]
fn faults_of_the_machine_within_are_told_with_their_keys() {
    let own = Scenario::builtin("case-3").expect("built in");
    let machine = own.machine.set("link.5.com", "-0.02").expect("valid");
    let text = Scenario { machine, ..own }.to_toml();
    assert!(text.contains("[[machine.link]]"));
    let wrong = text.replacen("mass = 1.45", "mass = -1.45\ncolour = 1", 1).replacen("time = 1.0", "time = -1.0", 1);
    let found = faults(&wrong);
    let mut keys = keys(&found);
    keys.sort_unstable();
    assert_eq!(keys.len(), 3, "{:#?}", found.list);
    assert!(keys[0].starts_with("machine.link") && keys[0].ends_with(".colour"), "{keys:?}");
    assert!(keys[1].ends_with(".mass") && keys[2] == "task.time", "{keys:?}");
    assert!(found.list.iter().any(|fault| fault.text.starts_with("mass of link 2 (link.2.mass) is -1.45")));
}

#[test]
fn what_is_no_file_of_ours_shows_a_machine() {
    for text in ["", "[package]\nname = \"x\"\n"] {
        let found = faults(text);
        assert_eq!(found.list[0].example, SMALLEST);
    }
    // What has a part of a scenario lacks the others.
    let found = faults("[task]\nkind = \"reactionless\"\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\nb = 2.4\n");
    assert!(keys(&found) == ["machine"] && found.list[0].example == "machine = \"nine-link\"", "{found:?}");
    assert!(parse(SMALLEST, "smallest.toml").is_ok());
}

/// A machine's own file has its own faults.
#[test]
fn faults_of_a_named_machine_are_those_of_its_file() {
    let find = |name: &str| MachineFile::parse("[[drive]]\n[[link]]\n", name);
    let error = Scenario::parse(&CASE.replace("nine-link", "arm.toml"), "my.toml", Some(&find)).expect_err("faulty");
    assert!(matches!(error, ScenarioError::MachineFile(_)));
    let (file, faults) = error.faults().expect("they are told");
    assert!(file == "arm.toml" && faults.count() > 3, "{faults:?}");
    assert!(faults.list.iter().all(|fault| fault.text.contains("missing")), "{faults:?}");
}

/// Edits and tolerances are named plainly, each fault at the line of its key.
#[test]
fn faults_of_edits_and_tolerances_are_named_plainly() {
    let text = format!(
        "{CASE}\n[tolerance]\nsede = 7\nsamples = 0\n\"link.*.com\" = {{ normal = -1 }}\n\
         [[edit]]\nstep = \"a\"\ndo = \"push\"\nx = 1.0\ny = 0.0\n\
         [[edit]]\nstep = 1\ndo = \"push\"\nx = \"left\"\ny = 0.0\n\
         [[edit]]\nstep = 1\ndo = \"shove\"\n\
         [[edit]]\nstep = 0\ndo = \"sketch\"\ndraw = \"lenght\"\nbar = 1\nmetres = 0.3\n\
         [[edit]]\nstep = 0\ndo = \"sketch\"\ndraw = \"length\"\nbar = \"a\"\nmetres = 0.3\n\
         [[edit]]\nstep = 1\ndo = \"slide-b\"\n\
         [[edit]]\nstep = 7\nx = 1.0\ny = 0.0\n"
    );
    let found = faults(&text);
    let wanted = [
        ("tolerance.sede", "sede", "table of tolerances has no key \"sede\": want seed (nearest)", ""),
        ("tolerance.samples", "samples = 0", "how many machines (tolerance.samples) is 0: want a whole number", ""),
        (
            "tolerance.link.*.com",
            "\"link.*.com\"",
            "centre of mass along every link (tolerance.link.*.com) is { normal = -1 }: want { normal = 0.0005 }",
            "\"link.*.com\" = { normal = 0.0005 }",
        ),
        ("edit[1].step", "step = \"a\"", "step of edit 1 (edit[1].step) is \"a\": want a whole number", "step = 0"),
        ("edit[2].x", "x = \"left\"", "x of edit 2 (edit[2].x) is the text \"left\": want a number", "x = 0.5"),
        ("edit[3].do", "do = \"shove\"", "kind of edit 3 (edit[3].do) is \"shove\": want one of drag-target", ""),
        (
            "edit[4].draw",
            "draw = \"lenght\"",
            "step of drawing in edit 4 (edit[4].draw) is \"lenght\": want \"length\" (nearest), or one of new",
            "draw = \"length\"",
        ),
        ("edit[5].bar", "bar = \"a\"", "bar of edit 5 (edit[5].bar) is the text \"a\": want a whole number", "bar = 1"),
        (
            "edit[6].b",
            "[[edit]]\nstep = 1\ndo = \"slide-b\"",
            "pose constant of edit 6 (edit[6].b) is missing",
            "b = 2.4",
        ),
        ("edit[7].do", "[[edit]]\nstep = 7", "kind of edit 7 (edit[7].do) is missing: want one of drag-target", ""),
    ];
    assert_eq!(keys(&found), wanted.map(|(key, ..)| key), "{:#?}", found.list);
    for (fault, (key, part, said, example)) in found.list.iter().zip(wanted) {
        assert_eq!(fault.line, Some(line(&text, part)), "{key}");
        assert!(fault.text.starts_with(said), "{key}: {}", fault.text);
        assert!(example.is_empty() || fault.example == example, "{key}: {}", fault.example);
    }
}
