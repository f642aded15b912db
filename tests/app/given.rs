//! Tables of numbers that are opened: a motion of a person's own, and a machine that was measured.

use std::fmt::Write as _;

use egui::Key;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{SessionCommand, TableAction, TableOptions, ViewChange, WindowCommand};
use stillbase::files::row_file::RowFile;
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::mechanics::planar::PerDrive;
use stillbase::picture::numbers::signed;
use stillbase::picture::scene::palette::Theme;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, replay};
use stillbase::settings::change::{join, single_change};
use stillbase::simulation::signal_table::SignalTable;
use stillbase::simulation::signals::signals;
use stillbase::study::trim::{OrbitBase, OrbitMotion, OrbitReport, orbit_trim};
use toml::Table;

use super::{Window, session, window};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    a_motion_of_ones_own_becomes_one_without_reactions,
    a_measured_machine_is_taken_as_it_is_and_mended,
    a_table_that_cannot_be_read_says_why_and_a_choice_mends_it,
    where_no_table_was_opened_one_is_asked_for,
    every_machine_takes_tables_of_its_own,
    momentum_tells_what_is_off_in_orbit,
];

/// Angles of the drives in a run of a scenario, and what its base feels, as a table.
fn table(scenario: &Scenario, measures: bool, every: u64) -> String {
    let drives = scenario.machine.drives();
    let all = |word: &str| (1..=drives).map(|k| format!(",{word}{k}")).collect::<String>();
    let mut text = match measures {
        true => format!("t{}{}{},fx,fy,nz\n", all("q"), all("qd"), all("qdd")),
        false => format!("t{}\n", all("q")),
    };
    let mut row = |frame: &stillbase::simulation::frame::Frame| {
        write!(text, "{}", frame.time).expect("text");
        let rates: &[_] = if measures { &[frame.qd, frame.qdd] } else { &[] };
        for k in 0..drives {
            write!(text, ",{}", frame.q.0[k]).expect("text");
        }
        for (of, k) in rates.iter().flat_map(|of| (0..drives).map(move |k| (of, k))) {
            write!(text, ",{}", of[k]).expect("text");
        }
        if measures {
            let wrench = frame.wrench.total();
            write!(text, ",{},{},{}", wrench.force.re, wrench.force.im, wrench.moment).expect("text");
        }
        text.push('\n');
    };
    let mut row = |frame: &stillbase::simulation::frame::Frame| {
        if frame.step.is_multiple_of(every) {
            row(frame);
        }
    };
    replay(scenario, |_, frame| row(frame)).expect("it runs");
    text
}

/// The same angles as columns.
fn replayed(scenario: &Scenario) -> (Vec<String>, Vec<Vec<Option<f64>>>) {
    let text = table(scenario, false, 1);
    let mut lines = text.lines();
    let head = lines.next().expect("a head").split(',').map(str::to_owned).collect();
    (head, lines.map(|line| line.split(',').map(|cell| cell.parse().ok()).collect()).collect())
}

fn open(h: &mut Window, file: impl AsRef<std::path::Path>) {
    h.state_mut().app_state_mut().carry_out(SessionCommand::OpenFile(file.as_ref().to_owned()));
    h.run_steps(4);
}

fn a_motion_of_ones_own_becomes_one_without_reactions() {
    let (folder, case) = (Folder::new("given"), Scenario::builtin("case-1").expect("built in"));
    let mut h = window("case-3", Theme::Dark);
    let before = session(&h).scenario().clone();
    open(&mut h, folder.file("mine.csv", table(&case, false, 1)));
    assert!(h.query_by_label("Given motion").is_some() && h.query_by_label("Proposed: no reactions").is_some());
    assert_eq!(*session(&h).scenario(), before, "it changes nothing until it is taken");
    for (button, is_clean) in [("Take as given", false), ("Take the proposal", true)] {
        h.get_by_label(button).click();
        h.run_steps(3);
        let task = session(&h).scenario().task.clone();
        assert_eq!(task.samples.as_ref().map(|samples| samples.count()), Some(1001), "{button}");
        let run = replay(session(&h).scenario(), |_, _| {}).expect("it runs");
        assert_eq!(run.frame().peaks.is_reactionless(), is_clean, "{button}");
        assert!(h.query_by_label("Given motion").is_some(), "it stays on display");
    }
    for _ in 0..2 {
        h.state_mut().app_state_mut().carry_out(SessionCommand::Undo);
    }
    h.run_steps(2);
    assert_eq!(*session(&h).scenario(), before, "each is one step to undo");
    // The same as Parquet.
    let samples = replayed(&case);
    let mut rows = RowFile::create(&folder.path("mine.parquet"), false, "instant", &samples.0).expect("begun");
    samples.1.iter().for_each(|row| rows.row(row).expect("a row"));
    rows.finish().expect("written");
    open(&mut h, folder.path("mine.parquet"));
    h.get_by_label("Take the proposal").click();
    h.run_steps(3);
    let task = session(&h).scenario().task.clone();
    assert_eq!(task.samples.as_ref().map(|samples| samples.count()), Some(1001));
    assert!(replay(session(&h).scenario(), |_, _| {}).expect("it runs").frame().peaks.is_reactionless());
    h.state_mut().app_state_mut().carry_out(SessionCommand::Undo);
    h.run_steps(3);
    // Both beside each other.
    h.get_by_label("Compare both").click();
    h.run_steps(8);
    let rows = h.state().app_state().comparison().expect("side by side").entries().len();
    assert!(rows >= 3 && h.query_by_label("Given motion").is_none(), "{rows} rows");
    h.key_press(Key::W);
    h.run_steps(3);
    assert!(h.query_by_label("Given motion").is_some(), "the table is still there");
    h.get_by_label("Close").click();
    h.run_steps(2);
    assert!(h.query_by_label("Given motion").is_none());
}

fn a_measured_machine_is_taken_as_it_is_and_mended() {
    let folder = Folder::new("given");
    let case = Scenario::builtin("case-1").expect("built in");
    let built = case.with_settings(&single_change("link.5.com", -0.02)).expect("a machine");
    let file = folder.file("plate.csv", table(&built, true, 1));
    let mut h = window("case-3", Theme::Dark);
    open(&mut h, file);
    assert!(h.query_by_label("Measured machine").is_some() && h.query_by_label("g 2 along is off").is_some());
    let residual = |h: &Window| Inertia::of(&session(h).scenario().machine).force_residual();
    assert!(residual(&h) < 1e-12);
    h.get_by_label("Take as measured").click();
    h.run_steps(4);
    let all = Inertia::of(&built.machine).force_residual();
    assert!((residual(&h) - all).abs() < 1e-6, "{} of {all}", residual(&h));
    // The measurement is of the machine as it was: what mends it is still offered, and is taken once.
    assert!(h.query_by_label("g 2 along is off").is_some());
    for _ in 0..2 {
        h.get_by_label("Take the change").click();
        h.run_steps(4);
        assert!(residual(&h) < 1e-4, "{}", residual(&h));
    }
    assert!(!session(&h).scenario().machine.spec().counterweights.is_empty());
    for _ in 0..2 {
        h.state_mut().app_state_mut().carry_out(SessionCommand::Undo);
    }
    h.run_steps(2);
    assert!(residual(&h) < 1e-12 && session(&h).scenario().machine.spec().counterweights.is_empty());
}

fn a_table_that_cannot_be_read_says_why_and_a_choice_mends_it() {
    let (folder, case) = (Folder::new("given"), Scenario::builtin("case-1").expect("built in"));
    let text = table(&case, false, 1);
    let gap: String =
        text.lines().enumerate().filter(|(i, _)| !(400..440).contains(i)).fold(String::new(), |mut all, (_, line)| {
            all += line;
            all.push('\n');
            all
        });
    let mut h = window("case-3", Theme::Dark);
    let before = session(&h).scenario().clone();
    for (name, text, words) in [
        ("gap.csv", gap.as_str(), "a gap"),
        ("none.csv", "a,b,c\n1,2,3\n", "no column"),
        ("nan.csv", "t,q1,q2,q3\n0,1,2,NaN\n", "NaN"),
        ("empty.csv", "", "want"),
    ] {
        open(&mut h, folder.file(name, text));
        assert!(h.query_by_label_contains(words).is_some(), "{name}");
        assert!(h.query_by_label("Take the proposal").is_none(), "{name}");
    }
    assert_eq!(*session(&h).scenario(), before);
    open(&mut h, folder.path("gap.csv"));
    h.get_by_label("bridge gaps").click();
    h.run_steps(4);
    assert!(h.query_by_label("Take the proposal").is_some(), "the spline bridges it");
    // What the table does not say cannot be taken.
    let app_state = h.state_mut().app_state_mut();
    app_state.carry_out(SessionCommand::TakeGiven(TableAction::Measured));
    assert!(app_state.view_state().status.message.as_ref().is_some_and(|message| message.is_problem));
    app_state.carry_out(WindowCommand::Ask(TableOptions { b: Some(9e5), ..TableOptions::default() }));
    h.run_steps(3);
    assert!(h.query_by_label("Take the proposal").is_none());
}

/// Whatever a machine can do: a motion of it is assessed with a proposal or a reason, and a measurement is read.
fn every_machine_takes_tables_of_its_own() {
    let folder = Folder::new("given");
    for scenario in Scenario::builtins() {
        let scenario = Scenario { edits: Vec::new(), ..scenario.clone() };
        let mut h = super::window_of(scenario.clone(), Theme::Dark, 800.0);
        for (name, text) in [("motion.csv", table(&scenario, false, 10)), ("plate.csv", table(&scenario, true, 10))] {
            open(&mut h, folder.file(name, text));
            h.run_steps(2);
            let titles = [
                "Proposed: no reactions",
                "Proposed: the base does not turn",
                "No proposal",
                "Least change",
                "No change",
                "Nothing mends it",
            ];
            let is_answered = titles.iter().any(|title| h.query_by_label(title).is_some());
            let is_refused = [": want ", "; want "].iter().any(|want| h.query_by_label_contains(want).is_some());
            assert!(is_answered || is_refused, "{} {name}", scenario.name);
            assert!(
                is_answered || scenario.base.moves() || name == "motion.csv",
                "{} {name}: a measurement on a base at rest",
                scenario.name
            );
        }
        drop(h);
        for name in ["motion.csv", "plate.csv"] {
            std::fs::remove_file(folder.path(name)).expect("it was written");
        }
    }
}

/// A motion in orbit as a table.
fn orbit_table(machine: &Machine, motion: &OrbitMotion) -> String {
    let names = |what: &str| machine.spec().drives.iter().map(|d| format!(",{what}/{}", d.name)).collect::<String>();
    let mut text = format!("t{}{},attitude/base,attitude_rate/base\n", names("angle"), names("rate"));
    for row in 0..motion.rows() {
        let (turn, rate) = (motion.attitude[row], motion.base_rate[row]);
        let all = |of: &PerDrive, base: f64| (0..of.len()).map(|k| format!(",{}", of[k] + base)).collect::<String>();
        let [angles, rates] = [all(&motion.angles[row], turn), all(&motion.rates[row], rate)];
        writeln!(text, "{}{angles}{rates},{turn},{rate}", motion.t[row]).expect("text");
    }
    text
}

/// Files of three motions on a base that floats are one measurement, with the numbers of `trim --base`.
fn momentum_tells_what_is_off_in_orbit() {
    let folder = Folder::new("given");
    let other = join(single_change("task.start", vec![1.2, 0.4, -0.6]), &single_change("task.to", vec![0.34, 0.45]));
    let flights = [("spot", Table::new()), ("spot", other), ("spot-swing", Table::new())];
    let mut h = window("spot", Theme::Dark);
    let scenario = session(&h).scenario().clone();
    let mut motions = Vec::new();
    for (i, (name, change)) in flights.into_iter().enumerate() {
        let change = join(change, &single_change("plant.link.2.com", 0.22));
        let flown = Scenario::builtin(name).expect("built in").with_settings(&change).expect("valid");
        let all = signals(&flown.machine);
        let mut measured = SignalTable::of(&all);
        replay(&flown, |_, frame| {
            if frame.step.is_multiple_of(5) {
                measured.push(frame.time, all.iter().map(|signal| signal.value(frame)));
            }
        })
        .expect("it runs");
        let mut text = measured.heads().join(",") + "\n";
        for row in 0..measured.time.len() {
            text += &(measured.row(row).map(|x| x.to_string()).collect::<Vec<_>>().join(",") + "\n");
        }
        motions.push(OrbitMotion::of(&flown.machine, &measured).expect("signals"));
        let file = folder.file(&format!("{i}.csv"), text);
        if i == 0 {
            open(&mut h, file);
            assert!(h.query_by_label("Measured machine").is_some());
            assert!(h.query_by_label("g elbow along is off").is_none(), "one motion tells little");
            h.get_by_label("Add…").click();
            h.run_steps(4);
            assert!(h.query_by_label("File name").is_some(), "it asks for a file");
            h.state_mut().app_state_mut().carry_out(ViewChange::Dialog(None));
        } else {
            h.state_mut().app_state_mut().carry_out(SessionCommand::AddFile(file));
        }
        h.run_steps(4);
    }
    let report = orbit_trim(&scenario.machine, &OrbitBase::of(&scenario.base), &motions).expect("a fit");
    assert!(
        h.query_by_label_contains(&report.rate_words()).is_some() && h.query_by_label_contains("3 motions").is_some()
    );
    let of = |name: &str| report.numbers.iter().find(|number| number.name == name).expect("a number");
    let elbow = of("g elbow along");
    assert!(elbow.off && h.query_by_label("g elbow along is off").is_some(), "{elbow:?}");
    assert!(h.query_by_label(&signed(elbow.measured.expect("told"), 5)).is_some());
    assert!(h.query_by_label(OrbitReport::KNOWN_WORDS).is_some());
    assert_eq!(*session(&h).scenario(), scenario, "nothing is changed");
    // A file that is no table is refused, and nothing is lost.
    h.state_mut().app_state_mut().carry_out(SessionCommand::AddFile("machine.toml".into()));
    h.run_steps(2);
    assert!(h.query_by_label_contains("machine.toml: want a table").is_some());
    assert!(h.query_by_label("g elbow along is off").is_some());
    // The same table is no measurement of a base that is held, and says so.
    let base = Edit::of("base", single_change("kind", "fixed"));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(base));
    h.run_steps(4);
    assert!(h.query_by_label_contains("or a base that is free").is_some());
    h.state_mut().app_state_mut().carry_out(SessionCommand::Undo);
    // Drives measured relative to the base are doubted, and taken where the reader insists.
    let mut spoilt = motions[2].clone();
    let seen = |of: &PerDrive, base: f64| PerDrive::from_fn(of.len(), |k| of[k] - base);
    for row in 0..spoilt.rows() {
        spoilt.angles[row] = seen(&spoilt.angles[row], spoilt.attitude[row]);
        spoilt.rates[row] = seen(&spoilt.rates[row], spoilt.base_rate[row]);
    }
    open(&mut h, folder.file("spoilt.csv", orbit_table(&scenario.machine, &spoilt)));
    let mends = "the drives are measured relative to the base, not to space: want attitude/base added";
    assert!(h.query_by_label_contains(mends).is_some());
    h.get_by_label("Take the columns as they are").click();
    h.run_steps(6);
    assert!(h.query_by_label("Take the columns as they are").is_none());
    assert!(h.query_by_label_contains("the drives are measured relative to the base").is_some(), "the doubt stays");
}

fn where_no_table_was_opened_one_is_asked_for() {
    let mut h = window("case-3", Theme::Light);
    h.key_press(Key::W);
    h.run_steps(2);
    assert!(h.query_by_label("File name").is_some());
}
