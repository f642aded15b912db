//! Machine files with the brief of a design: written, read again, opened, named by scenarios, and what is wrong in them.

use stillbase::mechanics::balance::ParameterBounds;
use stillbase::mechanics::counterweights::CounterweightKind;
use stillbase::mechanics::machine::{FileError, builtins, to_toml};
use stillbase::session::scenario::{DesignBrief, MachineFile, Scenario};
use stillbase::session::{Edit, Session};

use crate::folder::Folder;
use crate::support::family_machine;

/// A brief in which something of every kind is asked for.
fn brief() -> DesignBrief {
    let mut brief = DesignBrief {
        shape: CounterweightKind::HalfRing,
        inner_radius: 0.012,
        box_width: 0.05,
        thickness: 0.02,
        across: 0.1,
        clearance: Some(0.006),
        heaviest: Some(9.0),
        payload: Some([0.0, 0.2]),
        as_cut: true,
        ..DesignBrief::default()
    };
    brief.length.insert("l5".into(), [0.3, 0.6]);
    brief.fixed.0.insert("9".into());
    brief.hold.0.insert("link.5.mass".into(), ParameterBounds::Within([0.4, 0.8]));
    brief.hold.0.insert("counterweight.1.at".into(), ParameterBounds::Fixed);
    brief
}

#[test]
fn a_machine_keeps_its_brief_in_its_file() {
    for machine in builtins() {
        let file = MachineFile { machine: machine.clone(), design: brief() };
        assert_eq!(MachineFile::parse(&file.to_toml(), "own.toml").expect("its own file"), file);
        // A brief that asks for nothing leaves no trace.
        assert_eq!(MachineFile::from(machine.clone()).to_toml(), to_toml(machine));
    }
}

#[test]
fn a_file_is_opened_with_its_brief_and_named_with_it() {
    let folder = Folder::new("briefs");
    let machine = family_machine("nine-link-bare");
    let file = MachineFile { machine: machine.clone(), design: brief() };
    let path = folder.path("own.toml");
    std::fs::write(&path, file.to_toml()).expect("written");
    let opened = stillbase::files::scenario(&path.display().to_string()).expect("it is a machine").scenario;
    assert_eq!((&opened.machine, &opened.design), (&machine, &brief()));
    let found = stillbase::files::found_machine(&path.display().to_string()).expect("it is a machine");
    assert_eq!((found.machine, found.design), (machine, brief()));
    // A scenario that names the file overrules single keys of its brief.
    let task = "[task]\nkind = \"reactionless\"\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\nb = 2.4\ntime = 1.0\n";
    let of = |design: &str| {
        let path = folder.path("task.toml");
        std::fs::write(&path, format!("machine = \"own.toml\"\n{task}{design}")).expect("written");
        stillbase::files::scenario(&path.display().to_string()).expect("it is a scenario").scenario.design
    };
    assert_eq!(of(""), brief());
    let other = DesignBrief { clearance: Some(0.01), thickness: 0.03, ..brief() };
    assert_eq!(of("[design]\nclearance = 0.01\nthickness = 0.03\n"), other);
}

#[test]
fn changes_of_the_brief_are_in_the_file_of_the_machine() {
    let mut session = Session::open(Scenario::builtin("nine-link-bare").expect("built in")).expect("it opens");
    session.apply(Edit::set("design.clearance", 0.005)).expect("it is set");
    session.end_gesture();
    assert!(session.changes_machine_only());
    session.apply(Edit::set("control.kp", 300.0)).expect("it is set");
    session.end_gesture();
    assert!(!session.changes_machine_only());
}

#[test]
fn what_is_wrong_in_a_brief_is_told_with_its_line() {
    let text = |design: &str| format!("{}\n[design]\n{design}\n", to_toml(&family_machine("two-drive")));
    let faults = |design: &str| {
        let text = text(design);
        let why = MachineFile::parse(&text, "own.toml").expect_err("it is wrong");
        let FileError::Wrong { line, faults, .. } = &why else { panic!("{why}") };
        assert!(line.is_some_and(|line| line + 2 >= text.lines().count()), "{why}");
        let keys: Vec<String> = faults.list.iter().map(|fault| fault.key.clone()).collect();
        (keys.join(" "), why.to_string())
    };
    for (design, key, said) in [
        (
            "clearance = -0.1",
            "design.clearance",
            "distance of counterweights from pins (design.clearance) is -0.1: want",
        ),
        ("clearence = 0.1", "design.clearence", "clearance (nearest)"),
        ("shape = \"ball\"", "design.shape", "want one of disc, ring"),
        ("thickness = \"thick\"", "design.thickness", "is the text \"thick\": want"),
        ("payload = [0.3, 0.1]", "design.payload", "the least value first"),
        ("hold.link.5.colour = \"fixed\"", "design.hold", "design.hold.link.5.colour: want"),
    ] {
        let (keys, why) = faults(design);
        assert!(keys == key && why.contains(said), "{design}: {keys}: {why}");
    }
    // Faults of both are told together, and a key of neither names both.
    let both =
        text("clearance = -0.1").replacen("mass = ", "mass = -", 1).replacen("name = ", "sumary = 1\nname = ", 1);
    let why = MachineFile::parse(&both, "own.toml").expect_err("it is wrong");
    let faults = why.faults().expect("they are told");
    assert_eq!(faults.count(), 3, "{faults:?}");
    let whole = text("").replace("[design]", "desing = 1").replacen("name = ", "desing = 1\nname = ", 1);
    let whole = whole.rsplit_once("\ndesing").expect("the last line").0;
    let why = MachineFile::parse(whole, "own.toml").expect_err("it is wrong").to_string();
    assert!(why.contains("design (nearest)"), "{why}");
    let why = MachineFile::parse("design = 3\n", "own.toml").expect_err("it is wrong").to_string();
    assert!(why.contains("the file states no machine"), "{why}");
}
