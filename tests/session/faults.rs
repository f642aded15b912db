//! All faults of a scenario file at once, those of the machine in it included.

use stillbase::mechanics::machine::{SMALLEST, parse};
use stillbase::session::scenario::{Scenario, ScenarioError};
use stillbase::settings::fault::Faults;

const CASE: &str = include_str!("../../assets/scenarios/case-3.toml");

fn faults(text: &str) -> Faults {
    let error = Scenario::parse(text, "my.toml", None).expect_err("it has faults");
    let (file, faults) = error.faults().expect("they are told");
    assert_eq!(file, "my.toml");
    faults.clone()
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
    let want = ["tilte", "task.tiem", "control.kp", "control.law", "base.mass", "edit[1]", "edit[3]"];
    assert_eq!(keys(&found), want, "{:#?}", found.list);
    let of = |key: &str| found.list.iter().find(|fault| fault.key == key).expect("it is told");
    assert!(of("tilte").text.contains("title (nearest)"));
    assert_eq!(of("task.tiem").example, "time = 1.0");
    assert!(of("control.kp").text.starts_with("position gain (control.kp) is -1: want 0 to"), "{:?}", of("control.kp"));
    assert!(of("base.mass").text.starts_with("mass of the base (base.mass) is the text \"heavy\""));
    assert!(of("edit[3]").text.starts_with("edit 3: "), "{:?}", of("edit[3]"));
    let line = |part: &str| text[..text.find(part).expect("it is there")].matches('\n').count() + 1;
    for (key, part) in [("task.tiem", "tiem"), ("control.law", "law = \"magic"), ("edit[3]", "[[edit]]\nstep = 3")] {
        assert_eq!(of(key).line, Some(line(part)), "{key}");
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
    let find = |name: &str| parse("[[drive]]\n[[link]]\n", name);
    let error = Scenario::parse(&CASE.replace("nine-link", "arm.toml"), "my.toml", Some(&find)).expect_err("faulty");
    assert!(matches!(error, ScenarioError::MachineFile(_)));
    let (file, faults) = error.faults().expect("they are told");
    assert!(file == "arm.toml" && faults.count() > 3, "{faults:?}");
    assert!(faults.list.iter().all(|fault| fault.text.contains("missing")), "{faults:?}");
}
