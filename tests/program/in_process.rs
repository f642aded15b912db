//! Commands carried out within another program, held against the same commands of the program.

use std::ffi::OsString;

use stillbase::files::text::with_standard_input;
use stillbase_commands::{InProcessAnswer, StopFlag, answer, answer_until};

use super::{prints, stillbase, text};
use crate::folder::Folder;

fn asked(line: &[&str]) -> InProcessAnswer {
    answer(line.iter().map(OsString::from))
}

/// An answer is that of the program, to the last character; so are notes and errors, without the name of the program.
#[test]
fn answers_are_those_of_the_program() {
    for line in [
        &["check", "spot", "--json"][..],
        &["reach", "nine-link", "0.5,0.5", "0.55,0.9", "--json"],
        &["reach", "nine-link", "-0.6,-0.2", "--json", "--set", "limits.a1=0.4,2.7"],
        &["workspace", "nine-link", "--b", "2.4", "--json"],
        &["design", "nine-link-bare", "--counterweights", "--json"],
        &["plan", "spot", "--json"],
    ] {
        let said = asked(line);
        assert_eq!(said.json.as_deref(), Some(&*prints(line)), "{line:?}");
        assert!(said.status == 0 && said.errors.is_empty() && said.signals.is_none(), "{line:?}: {said:?}");
    }
    for line in [
        &["reach", "nine-link", "5,5", "--json"][..],
        &["check", "nine-lnk"],
        &["check", "nine-link", "--set", "link.5.mass=-1"],
        &["plan", "nine-link", "0.5,0.5", "--kind", "nothing"],
        &["chekc", "nine-link"],
        &["import", "none.csv"],
    ] {
        let (said, out) = (asked(line), stillbase(line));
        let lines = text(&out.stderr).lines().map(|line| line.strip_prefix("stillbase: ").unwrap_or(line));
        assert_eq!(said.errors, lines.collect::<Vec<_>>(), "{line:?}");
        assert_eq!(Some(i32::from(said.status)), out.status.code(), "{line:?}");
        assert!(said.json.is_none(), "a failure is no answer: {said:?}");
    }
    // What one command said is not that of the next.
    assert_eq!(asked(&["check", "spot", "--json"]).errors, Vec::<String>::new());
}

/// A question without an answer may have one beside the reason.
#[test]
fn an_answer_stands_beside_the_reason() {
    let line = ["reach", "nine-link", "0.5,0.5", "-0.9,-0.8", "--json"];
    let (said, out) = (asked(&line), stillbase(&line));
    assert_eq!((said.status, said.json.as_deref()), (1, Some(text(&out.stdout))), "{said:?}");
    assert!(!said.errors.is_empty());
}

/// A file for standard output is the one that the program prints; one with a name is written without a note.
#[test]
fn a_file_for_standard_output_is_returned() {
    for line in [
        &["export-model", "nine-link", "-o", "-", "--format", "svg"][..],
        &["export-model", "spot", "-o", "-"],
        &["plan", "nine-link", "0.5,0.5", "0.55,0.9", "-o", "-"],
    ] {
        let said = asked(line);
        assert_eq!(said.file.as_deref(), Some(prints(line).as_bytes()), "{line:?}");
        assert!(said.status == 0 && said.json.is_none(), "{line:?}: {said:?}");
    }
    let folder = Folder::new("in-process");
    let file = folder.path("arm.xml");
    let said = asked(&["export-model", "nine-link", "-o", file.to_str().expect("UTF-8")]);
    assert!(file.is_file() && said.file.is_none() && said.notes.iter().all(|note| !note.contains("wrote")), "{said:?}");
}

/// Signals are the numbers of the program's CSV, bit by bit.
#[test]
fn signals_are_those_of_the_program() {
    let line = ["simulate", "spot", "--set", "task.time=2", "--signals", "attitude,torque"];
    let said = asked(&[&line[..], &["--json"]].concat());
    let table = said.signals.expect("signals");
    let csv = prints(&[&line[..], &["-o", "-"]].concat());
    let mut rows = csv.lines();
    let heads: Vec<&str> = rows.next().expect("a head").split(',').collect();
    assert_eq!(heads, table.heads());
    let numbers = |row: &str| row.split(',').map(|cell| cell.parse::<f64>().expect("a number")).collect::<Vec<_>>();
    for (i, row) in rows.enumerate() {
        assert_eq!(numbers(row), table.row(i).collect::<Vec<_>>(), "row {i}");
    }
    assert!(table.time.len() > 1000 && said.json.is_some_and(|json| json.contains("\"verdict\"")));
}

/// A machine that is in no file stands in the place of standard input.
#[test]
fn a_machine_may_be_text() {
    let machine = stillbase::mechanics::machine::builtin("spot").expect("built in");
    let toml = stillbase::mechanics::machine::to_toml(machine);
    let ask = || asked(&["check", "-", "--json"]);
    assert_eq!(with_standard_input(toml, ask).json.as_deref(), Some(&*prints(&["check", "spot", "--json"])));
    let wrong = with_standard_input("name = 3".into(), ask);
    assert!(wrong.status == 2 && wrong.errors[0].contains("standard input"), "{wrong:?}");
}

/// A command that is told to stop ends with a failure of its own, and leaves no file; others do not hear of it.
#[test]
fn a_command_stops_when_it_is_told_to() {
    let folder = Folder::new("stopped");
    let file = folder.path("new.csv");
    let file = file.to_str().expect("UTF-8");
    for line in [
        &["tolerance", "case-3", "--samples", "1000000", "-o", file][..],
        &["design", "nine-link-bare", "--counterweights", "--vary", "length.l5=0.3:0.6:99", "--table", file],
        &["design", "nine-link-bare", "--counterweights", "--front", "99"],
        &["simulate", "case-1", "-o", file],
        &["compare", "case-1"],
        &["turn-map", "spot"],
    ] {
        let stop = StopFlag::default();
        stop.stop();
        let said = answer_until(line.iter().map(OsString::from), &stop);
        assert_eq!((said.status, &said.errors[..]), (130, &["stopped before its end".to_owned()][..]), "{line:?}");
        assert!(std::fs::read_dir(&folder.0).expect("a folder").next().is_none(), "{line:?}");
    }
    assert_eq!(asked(&["check", "spot", "--json"]).status, 0);
}
