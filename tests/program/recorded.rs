//! `replay`, `diff` and `table`: recordings, and what is done with them afterwards.

use super::*;

/// A scenario with everything that may be hard to repeat: a payload and a force, friction, a free base with a wheel, and
/// edits during the run.
const BUSY: &str = r#"
machine = "nine-link"
title = "everything at once"

[task]
kind = "reactionless"
from = [0.5, 0.5]
to = [0.55, 0.9]
b = 2.4
time = 0.6

[base]
kind = "free"
mass = 30.0
inertia = 2.0

[plant]
payload = { mass = 0.1 }
friction = { coulomb = [0.02, 0.02, 0.02] }

[[edit]]
step = 200
do = "set"
change = { plant = { force = [1.0, -0.5] } }

[[edit]]
step = 400
do = "set"
change = { plant = { force = [0.0, 0.0] } }
"#;

/// What a command prints, which ends with a status.
fn ends(args: &[&str], status: i32) -> String {
    let out = stillbase(args);
    assert_eq!(out.status.code(), Some(status), "{args:?}: {}{}", text(&out.stdout), text(&out.stderr));
    text(&out.stdout).to_owned()
}

#[test]
fn a_recording_replays_to_the_same_numbers() {
    let folder = Folder::new("recorded");
    let busy = word(folder.file("busy.toml", BUSY));
    let file = word(folder.path("all.rrd"));
    prints(&["headless", "case-1", "case-3", "spacecraft", &busy, "-o", &file]);
    let got = object(&["replay", &file]);
    assert_eq!((&got["equal"], &got["within"]), (&json!(true), &json!(true)));
    let cases = got["cases"].as_array().expect("a list");
    let names: Vec<&str> = cases.iter().filter_map(|case| case["case"].as_str()).collect();
    assert_eq!(names, ["case-1", "case-3", "spacecraft", "busy"]);
    for case in cases {
        assert!(case["signals"].as_array().expect("a list").len() > 60, "{case}");
        assert!(case["instants"].as_u64() > Some(300), "{case}");
        assert_eq!(case["interpolated"], json!(0));
    }
    let one = ends(&["replay", &format!("{file}:busy")], 0);
    assert!(one.starts_with("busy: equal: "), "{one}");
}

/// Another machine that the first edit draws is recorded, and found again.
#[test]
fn a_recorded_drawing_replays_too() {
    let folder = Folder::new("recorded");
    let task = "machine = 'nine-link'\n[task]\nkind = 'minimum-norm'\nb = 1.539\nfrom = [0.364, 0.405]\n\
                to = [0.344, 0.599]\ntime = 0.5\n";
    let edit = "[[edit]]\nstep = 0\ndo = 'sketch'\ndraw = 'new'\ntemplate = 'serial-of-two'\n";
    let session = word(folder.file("drawn.toml", [task, edit].concat()));
    let file = word(folder.path("drawn.rrd"));
    prints(&["headless", &session, "-o", &file]);
    assert_eq!(object(&["replay", &file])["equal"], json!(true));
    ends(&["diff", &file, &session], 0);
}

#[test]
fn a_change_of_the_plant_is_found_with_its_instant() {
    let folder = Folder::new("recorded");
    let [before, after] = ["before.rrd", "after.rrd"].map(|name| word(folder.path(name)));
    prints(&["headless", "case-1", "-o", &before]);
    prints(&["headless", "case-1", "-o", &after, "--set", "plant.payload.mass=0.05"]);
    let got = ends(&["diff", &before, &after], 1);
    assert!(
        got.starts_with("case-1: ") && got.contains("signals differ") && got.contains("the first is com/x"),
        "{got}"
    );
    // Rounding stands below what differs, however small the signal is.
    let place = |signal: &str| got.find(&format!("\n{signal} "));
    assert!(place("com/y").is_some() && place("com/y") < place("audit_angular/about_o").or(Some(usize::MAX)), "{got}");
    // Within a tolerance of the size of the difference, it is none.
    ends(&["diff", &before, &after, "--tolerance", "100"], 0);
    ends(&["diff", &before, &before], 0);
    // A recording, the table made of it, and the scenario itself are the same.
    let csv = word(folder.path("before.csv"));
    prints(&["table", &before, "-o", &csv]);
    ends(&["diff", &before, &csv], 0);
    ends(&["diff", "case-1", &csv, "--tolerance", "0"], 0);
}

#[test]
fn a_table_of_a_recording_is_that_of_the_run() {
    let folder = Folder::new("recorded");
    let [file, run, recorded] = ["run.rrd", "run.csv", "recorded.csv"].map(|name| word(folder.path(name)));
    let set = ["--set", "task.time=0.3"];
    prints(&[&["headless", "case-2", "-o", &file][..], &set].concat());
    prints(&[&["simulate", "case-2", "-o", &run][..], &set].concat());
    prints(&["table", &file, "-o", &recorded]);
    let rows = |file: &str| -> Vec<Vec<String>> {
        let text = fs::read_to_string(file).expect("a table");
        let mut columns: Vec<Vec<String>> = Vec::new();
        for line in text.lines() {
            for (i, cell) in line.split(',').enumerate() {
                if columns.len() <= i {
                    columns.push(Vec::new());
                }
                columns[i].push(cell.to_owned());
            }
        }
        // A recording counts nanoseconds.
        columns.remove(0);
        columns.sort();
        columns
    };
    assert!(rows(&run) == rows(&recorded), "the columns are the same");
    let part = prints(&["table", &file, "--signals", "torque/1,moment"]);
    assert!(part.starts_with("time s,torque/1 N m,moment/"), "{part}");
    fails(&["table", &file, "--signals", "torqe"], 2, &["torqe", "torque"]);
}

#[test]
fn a_long_run_has_rows_at_a_fixed_rate_and_a_row_at_every_step_on_request() {
    let folder = Folder::new("recorded");
    let [thin, whole] = ["thin.rrd", "whole.rrd"].map(|name| word(folder.path(name)));
    let set = ["--set", "task.time=8"];
    prints(&[&["headless", "case-3", "-o", &thin][..], &set].concat());
    prints(&[&["headless", "case-3", "--every-step", "-o", &whole][..], &set].concat());
    let instants = |file: &str| object(&["replay", file])["cases"][0]["instants"].as_u64();
    assert_eq!((instants(&thin), instants(&whole)), (Some(801), Some(8001)));
    // The rows that both have are the same.
    ends(&["diff", &thin, &whole], 0);
    let size = |file: &str| fs::metadata(file).expect("a file").len();
    assert!(3 * size(&thin) < 2 * size(&whole), "{} and {} bytes", size(&thin), size(&whole));
}

#[test]
fn a_run_is_compared_with_its_table_in_any_form() {
    let folder = Folder::new("recorded");
    let [csv, parquet, again] = ["run.csv", "run.parquet", "again.csv"].map(|name| word(folder.path(name)));
    let set = ["--set", "plant.payload.mass=0.1", "--set", "task.time=0.3"];
    for file in [&csv, &parquet] {
        prints(&[&["simulate", "case-3", "-o", file][..], &set].concat());
        // The settings are those of the scenario, on either side.
        ends(&[&["diff", "case-3", file][..], &set].concat(), 0);
        ends(&[&["diff", file, "case-3"][..], &set].concat(), 0);
        let got = ends(&["diff", file, "case-3", "--set", "task.time=0.3"], 1);
        assert!(got.starts_with("case-3: ") && got.contains("signals differ"), "{got}");
        fails(&["diff", file, file, "--set", "task.time=0.3"], 2, &["--set: neither of both is a scenario"]);
    }
    ends(&[&["diff", "case-3", "case-3"][..], &set].concat(), 0);
    ends(&["diff", &csv, &parquet, "--tolerance", "0"], 0);
    fails(&["diff", &csv, "case-3", "--set", "payload.mas=1"], 2, &["payload.mas"]);
    // A table becomes one of another form, as it is.
    prints(&["table", &parquet, "-o", &again]);
    assert!(fs::read(&again).expect("a table") == fs::read(&csv).expect("a table"));
    let part = prints(&["table", &parquet, "--signals", "torque/1", "--from", "0.1", "--to", "0.102"]);
    assert_eq!(part.lines().count(), 4, "{part}");
    fails(&["table", "case-3"], 2, &["want a recording or a table", "stillbase simulate"]);
    fails(&["table", &csv, "--from", "5"], 2, &["no step from 5 to inf s", "0 to 0.300 s"]);
    // What only one of both has is a difference, unless it is left out.
    let short = word(folder.file("short.csv", &part));
    let got = ends(&[&["diff", "case-3", &short][..], &set].concat(), 1);
    assert!(
        got.contains("the first starts at 0 s, the second at 0.1 s; the first ends at 0.3 s, the second at 0.102 s"),
        "{got}"
    );
    assert!(got.contains("only the first has "), "{got}");
    let chosen = ["--signals", "torque/1", "--from", "0.1", "--to", "0.102"];
    ends(&[&["diff", "case-3", &short][..], &set, &chosen].concat(), 0);
    let late = word(folder.file("late.csv", "torque/1 N m,t\n0,7\n0,8\n"));
    let got = ends(&["diff", &short, &late], 1);
    assert!(got.contains("no instant that both have: the first has 0.1 to 0.102 s, the second 7 to 8 s"), "{got}");
    // No number equals no number, in both forms.
    let [a, b] = [("a.csv", "t,x m\n0,\n1,2\n"), ("b.csv", "time s,x m\n0,NaN\n1,2\n")]
        .map(|(name, text)| word(folder.file(name, text)));
    ends(&["diff", &a, &b], 0);
    let of_b = word(folder.path("b.parquet"));
    prints(&["table", &b, "-o", &of_b]);
    ends(&["diff", &a, &of_b], 0);
}

#[test]
fn a_recorded_session_is_a_scenario_like_any_other() {
    let folder = Folder::new("recorded");
    let file = word(folder.path("both.rrd"));
    prints(&["headless", "case-1", "case-3", "-o", &file]);
    let out = stillbase(&["simulate", &file, "--json", "--every", "1000"]);
    assert!(text(&out.stderr).contains("taken is case-1"), "{}", text(&out.stderr));
    let named = object(&["simulate", &format!("{file}:case-3"), "--every", "1000"]);
    assert_eq!(named["scenario"], json!("case-3"));
    fails(&["simulate", &format!("{file}:case-2")], 2, &["no case \"case-2\"", "case-1, case-3"]);
}

#[test]
fn what_is_no_recording_and_no_table_is_refused() {
    let folder = Folder::new("recorded");
    let whole = folder.path("whole.rrd");
    prints(&["headless", "case-3", "-o", &word(whole.clone()), "--set", "task.time=0.2"]);
    let bytes = fs::read(&whole).expect("a recording");
    let lines = word(folder.file("lines.rrd", "time s,torque/1 N m\n0,1\n"));
    let empty = word(folder.file("empty.rrd", ""));
    // Of several cases the first would be whole where the file is cut.
    let several = folder.path("several.rrd");
    prints(&["headless", "case-1", "case-3", "-o", &word(several.clone()), "--set", "task.time=0.2"]);
    let several = fs::read(several).expect("a recording");
    let cuts: Vec<String> = [(&bytes, 0.3), (&bytes, 0.9), (&several, 0.6), (&several, 0.99)]
        .iter()
        .enumerate()
        .map(|(i, (bytes, share))| {
            word(folder.file(&format!("cut-{i}.rrd"), &bytes[..(bytes.len() as f64 * share) as usize]))
        })
        .collect();
    for file in [&lines, &empty].into_iter().chain(&cuts) {
        fails(&["replay", file], 2, &[file, "want a whole recording"]);
        fails(&["diff", file, "case-3"], 2, &[file]);
        fails(&["table", file], 2, &[file]);
    }
    fails(&["replay", "case-3"], 2, &["want a recording, FILE.rrd"]);
    fails(&["replay", &word(folder.path("none.rrd"))], 2, &["none.rrd"]);
    let tables = [
        ("torque/1 N m,x m\n0,1\n", "no column for the time among torque/1, x"),
        ("time (h),x m\n0,1\n", "want the time in s, ms"),
        ("time s,torque/1 N m\n0,1\n0,1\n", ":3: column time"),
        ("time s,torque/1 N m\n0,one\n", ":2: column torque/1: \"one\""),
        ("time s,torque/1 N m\n0\n", ":2: column torque/1: nothing there"),
        ("time s,a m,a m\n0,1,1\n", "two columns \"a\""),
        ("time s,torque/1 N m\n", "no row"),
        ("", "nothing here"),
    ];
    for (table, words) in tables {
        let file = word(folder.file("table.csv", table));
        fails(&["diff", &file, "case-3"], 2, &["table.csv", words]);
    }
    fails(&["diff", "case-3", "case-3", "--tolerance", "torqe=1"], 2, &["torqe", "torque"]);
    fails(&["diff", "case-3", "case-3", "--tolerance", "torque=-1"], 2, &["torque=-1"]);
}

/// A recording of another version may differ by rounding, and by no more.
#[test]
fn a_recording_of_another_version_replays_within_its_tolerance() {
    let folder = Folder::new("recorded");
    let file = folder.path("run.rrd");
    prints(&["headless", "case-3", "-o", &word(file.clone()), "--set", "task.time=0.3"]);
    let case = stillbase::files::recorded::cases(&file).expect("a recording").remove(0);
    let scenario = case.scenario().expect("its session");
    let replayed = |version: &str, factor: f64| {
        let mut case = case.clone();
        case.version = version.into();
        case.table.columns.iter_mut().flat_map(|column| &mut column.values).for_each(|x| *x *= factor);
        let difference = case.simulated_again(&scenario, &case.tolerances(), || true).expect("it runs");
        (difference.is_equal(), difference.is_within())
    };
    assert_eq!(replayed(env!("CARGO_PKG_VERSION"), 1.0), (true, true));
    assert_eq!(replayed("0.1.0", 1.0), (true, true));
    assert_eq!(replayed("0.1.0", 1.0 + 1e-10), (false, true));
    assert_eq!(replayed("0.1.0", 1.0 + 1e-8), (false, false));
    assert_eq!(replayed(env!("CARGO_PKG_VERSION"), 1.0 + 1e-10), (false, false));
}
