//! The command that runs what is on display.

use stillbase::mechanics::machine::Machine;
use stillbase::session::scenario::Scenario;
use stillbase::session::{row_options, simulate_command};
use stillbase::settings::change::{join, single_change, value};
use stillbase::simulation::signals::{Signal, is_name_of, signals};
use toml::Table;

/// Splits a command into words as a shell does, quotes included.
fn words(command: &str) -> Vec<String> {
    let (mut words, mut quoted) = (vec![String::new()], false);
    for c in command.chars() {
        match c {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            c => words.last_mut().expect("a word").push(c),
        }
    }
    words
}

/// Reads the command back: the scenario that it simulates.
fn read_back(command: &str) -> Scenario {
    let words = words(command);
    let [program, simulate, name, settings @ ..] = &words[..] else { panic!("{command}") };
    assert_eq!([program.as_str(), simulate.as_str()], ["stillbase", "simulate"]);
    let change = settings.chunks(2).fold(Table::new(), |all, pair| {
        let [set, setting] = pair else { panic!("{command}") };
        let (key, text) = setting.split_once('=').expect("KEY=VALUE");
        assert_eq!(set, "--set");
        join(all, &single_change(key, value(text)))
    });
    Scenario::builtin(name).expect("built in").with_settings(&change).expect("settings")
}

#[test]
fn what_differs_from_the_built_in_scenario_is_stated_and_reads_back() {
    for name in Scenario::builtin_names() {
        let scenario = Scenario::builtin(name).expect("built in").without_edits();
        assert_eq!(simulate_command(&scenario).as_deref(), Some(format!("stillbase simulate {name}").as_str()));
    }
    let settings = [
        ("task.to", "0.5,0.95"),
        ("task.via", "[[0.6,0.7]]"),
        ("task.law", "septic"),
        ("plant.payload.mass", "0.3"),
        ("link.5.com", "-0.02"),
        ("base.kind", "free"),
        ("limits.a1", "0.4,2.9"),
        ("drive.2.torque_limit", "3"),
    ];
    let change = settings.iter().fold(Table::new(), |all, (key, text)| join(all, &single_change(key, value(text))));
    let scenario =
        Scenario::builtin("case-3").expect("built in").without_edits().with_settings(&change).expect("settings");
    let command = simulate_command(&scenario).expect("settings lead there");
    assert_eq!(read_back(&command), scenario, "{command}");
    assert!(command.contains("--set task.law=septic") && !command.contains("task.from"), "{command}");
}

/// A machine of another name needs a file.
#[test]
fn what_settings_do_not_lead_to_has_no_command() {
    let case = Scenario::builtin("case-3").expect("built in");
    let other = Scenario::builtin("space-arm").expect("built in");
    assert_eq!(simulate_command(&Scenario { machine: other.machine, ..case.clone() }), None);
    assert_eq!(simulate_command(&Scenario { name: "mine".into(), ..case }), None);
}

/// Options name whole groups where they can, and every one of them means the signals that were chosen.
#[test]
fn options_of_rows_mean_the_chosen_signals() {
    let machine = &Scenario::builtin("case-1").expect("built in").machine;
    let table = signals(machine);
    let named = |paths: &[&str]| -> Vec<Signal> {
        table.iter().filter(|signal| paths.contains(&signal.path.as_str())).cloned().collect()
    };
    assert_eq!(row_options(&table, &table, None).as_deref(), Some(""));
    let some = named(&["torque/1", "torque/2", "torque/3", "angle/2"]);
    let options = row_options(&table, &some, Some([0.1 + 0.2, 0.5])).expect("nameable");
    assert_eq!(options, " --signals torque,angle/2 --from 0.3 --to 0.5");
    let is_named = |signal: &&Signal| ["torque", "angle/2"].iter().any(|name| is_name_of(name, &signal.path));
    assert_eq!(table.iter().filter(is_named).cloned().collect::<Vec<_>>(), some);
    assert!(!is_name_of("torqu", "torque/1") && !is_name_of("torque/", "torque/1") && !is_name_of("1", "torque/1"));
    let machine = machine.spec().clone();
    let mut comma = machine.clone();
    comma.drives[1].name = "a, b".into();
    comma.links.iter_mut().filter(|link| link.drive == machine.drives[1].name).for_each(|l| l.drive = "a, b".into());
    comma.angles.clear();
    let table = signals(&Machine::new(comma).expect("a machine"));
    let one: Vec<Signal> = table.iter().filter(|signal| signal.path == "torque/a, b").cloned().collect();
    assert_eq!((one.len(), row_options(&table, &one, None)), (1, None), "a comma separates names");
}
