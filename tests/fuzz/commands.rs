//! The same for what only commands read: settings, samples as CSV, states as JSON, parts of a study.

use clap::Parser;
use stillbase::files::row_file::RowForm;
use stillbase::files::shards::{ShardHeader, StudyId, Writer, merge};
use stillbase::files::table::{Table, motions, samples};
use stillbase::mechanics::assembly::{Assembly, parse as parse_assembly};
use stillbase::mechanics::machine::{builtin, named};
use stillbase::session::scenario::Scenario;
use stillbase::study::trim::{MeasurementSet, Regressor, adopt_parameters, fit, identified_machine, next_excitation};

use crate::fuzz::{bytes, fuzz, is_short};
use stillbase_commands::dynamics;
use stillbase_commands::failure::Failure;
use stillbase_commands::input::{Settings, overlay_used};

fn said(failure: &Failure) -> Result<(), String> {
    match failure {
        Failure::ReaderGone | Failure::Told | Failure::Stopped => Ok(()),
        Failure::NoAnswer(why) | Failure::WrongInput(why) => is_short(why),
        Failure::Refused(refused) => said(&refused.failure),
    }
}

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    settings: Settings,
}

#[test]
fn settings() {
    const GOOD: [&str; 3] = [
        "link.5.com=-0.02\nlink.9.mass=0.3\nlength.l1=0.6\npayload.mass=0.1\ngravity=0,-9.81\nlimits.a1=0.4,2.7",
        "task.shape=spline\ntask.time=2\ntask.b=2.5\nplant.payload.mass=0.1\nplant.friction.coulomb=0.2,0.1,0.1\nbase.kind=free",
        "drive.1.torque_limit=20\ndrive.2.jerk_limit=900\ncontrol.kp=400,300,300\nbase.kind=compliant\nbase.mass=40\ncontrol.law=pd",
    ];
    fuzz("settings", &bytes(&GOOD), 300, |bytes, dice| {
        let text = String::from_utf8_lossy(bytes);
        let words = text.lines().flat_map(|line| ["--set", line]);
        let line = match Line::try_parse_from(std::iter::once("stillbase").chain(words)) {
            Ok(line) => line,
            // The reader of command lines repeats what it was given, and the program says it in one line.
            Err(_) => return Ok(()),
        };
        let name = ["case-1", "case-3", "circle", "change-b"][dice.below(4)];
        match overlay_used(Scenario::builtin(name).expect("built in"), &line.settings) {
            Ok(scenario) => match Scenario::parse(&scenario.to_toml(), "again.toml", None) {
                Ok(again) if again == scenario => Ok(()),
                Ok(_) => Err("read back as another".into()),
                Err(error) => Err(format!("not read back: {error}")),
            },
            Err(failure) => said(&failure),
        }
    });
}

/// What is made to take memory: rows of more columns than any table has end before a cell is kept, wherever they are.
#[test]
fn a_row_of_too_many_columns_is_refused() {
    let machine = builtin("nine-link").expect("built in");
    let commas = ",".repeat(2_000_000);
    let quoted = "\"a,\n\",".repeat(2000);
    for (text, line) in [
        (commas.clone(), 1),
        (commas.replace(',', ";"), 1),
        (format!("t,q1,q2,q3\n0,1,2,3\n0.1,1,2,3{commas}\n"), 3),
        (format!("t,q1,q2,q3\n0,1,2,3\n\"a\"\"b\n\"{commas}"), 4),
        (format!("t,q1,q2,q3\n# it's \"\n0,1,2,3{commas}"), 3),
        (format!("t,q1,q2,q3\n0,a\"b,2,3{commas}"), 2),
        (quoted, 1001),
    ] {
        let table = Table::of_csv(text, "wide.csv");
        let why = samples(&table, machine, None, false).expect_err("too wide");
        assert_eq!(why.to_string(), format!("wide.csv:{line}: more than 1000 columns: want at most 1000"));
        assert_eq!(motions(&table, machine).expect_err("too wide"), why);
    }
    // As many are read.
    let head = format!("t,q1,q2,q3{}", ",u".repeat(996));
    let rows: String = (0..20).map(|i| format!("\n{i},1,2,3{}", ",\",\"".repeat(996))).collect();
    assert!(samples(&Table::of_csv(head + &rows, "wide.csv"), machine, None, false).is_ok());
}

/// Found by chance: keys within keys once went as deep as the stack.
#[test]
fn a_key_of_many_parts_is_refused() {
    let key = format!("plant.{}x=1", "a.".repeat(50_000));
    let refused = Line::try_parse_from(["stillbase", "--set", &key]).err().expect("too many parts").to_string();
    assert!(refused.contains("more than 16 parts"), "{}", &refused[refused.len() - 200..]);
}

#[test]
fn samples_as_csv() {
    let table = |head: &str, row: &dyn Fn(f64) -> String| {
        let rows: String = (0..40).map(|i| row(0.025 * f64::from(i)) + "\n").collect();
        format!("{head}\n{rows}").into_bytes()
    };
    let good = [
        table("t,q1,q2,q3", &|t| format!("{t},{},{},{}", 1.7 - 0.2 * t * t, 3.7 + 0.5 * t * t, 2.2 + 0.9 * t * t)),
        table("t (ms),x (mm),y (mm)", &|t| format!("{},{},{}", 1e3 * t, 500.0 + 50.0 * t * t, 500.0 + 400.0 * t * t)),
        table("time;q1 (deg);q2 (deg);q3 (deg)", &|t| format!("{t};{};{};{}", 97.0 - t, 210.0 + t, 120.0 + 3.0 * t)),
    ];
    let machine = builtin("nine-link").expect("built in");
    fuzz("csv", &good, 300, |bytes, dice| {
        let text = String::from_utf8_lossy(bytes);
        match samples(&Table::of_csv(text, "in.csv"), machine, None, dice.one_in(2)) {
            Ok(read) => match read.samples.rows().flatten().all(|x| x.is_finite()) {
                true => Ok(()),
                false => Err("a sample that is not finite".into()),
            },
            Err(why) => is_short(&why.to_string()),
        }
    });
}

/// What was measured: whatever can be read is fitted, mended and asked on, or refused.
#[test]
fn measurements_as_csv() {
    let table = |head: &str, row: &dyn Fn(f64) -> String| {
        let rows: String = (0..60).map(|i| row(0.02 * f64::from(i)) + "\n").collect();
        format!("{head}\n{rows}").into_bytes()
    };
    let force = |t: f64| (0.3 * (5.0 * t).sin(), 0.2 * (7.0 * t).cos(), 0.1 * (6.0 * t).sin());
    let row = |t: f64| {
        let (fx, fy, nz) = force(t);
        format!("{t},{},{},{fx},{fy},{nz}", 0.5 * (5.0 * t).sin(), 1.0 + 0.4 * (7.0 * t).cos())
    };
    let rates = |t: f64| {
        let (a, b) = (5.0 * t, 7.0 * t);
        let q = format!("{};{};{};{}", 0.5 * a.sin(), 0.4 * b.cos(), 2.5 * a.cos(), -2.8 * b.sin());
        format!("{t};{q};{};{};{};{};{}", -12.5 * a.sin(), -19.6 * b.cos(), force(t).0, force(t).1, force(t).2)
    };
    let good = [
        table("t,q1,q2,fx,fy,nz", &row),
        table("t;q1;q2;qd1;qd2;qdd1;qdd2;fx (mN);fy [kN];nz N m", &rates),
        table("t (ms),q1 (deg),q2,fx,fy,nz,motion", &|t| format!("{},{}", row(t), if t < 0.6 { "a" } else { "b" })),
    ];
    let machine = builtin("two-drive").expect("built in");
    fuzz("measured", &good, 200, |bytes, dice| {
        let text = String::from_utf8_lossy(bytes);
        let recording = match motions(&Table::of_csv(text, "in.csv"), machine) {
            Ok(motions) => MeasurementSet { motions },
            Err(why) => return is_short(&why.to_string()),
        };
        let rows = match Regressor::of(machine, &recording, dice.one_in(2)) {
            Ok(rows) => rows,
            Err(why) => return is_short(&why.to_string()),
        };
        let fit = match fit(machine, &rows) {
            Ok(fit) => fit,
            Err(why) => return is_short(&why.to_string()),
        };
        if !fit.numbers.measured.iter().all(|x| x.is_finite())
            || !(0..fit.numbers.unknowns.count()).all(|i| fit.numbers.half_width(i) >= 0.0)
        {
            return Err("a number that is none".into());
        }
        let taken = adopt_parameters(&fit);
        if let Err(why) = identified_machine(machine, &taken) {
            is_short(&why.to_string())?;
        }
        let told = next_excitation(machine, &recording, &rows, &fit, None);
        if told.candidates.is_empty() { Err("no next motion".into()) } else { Ok(()) }
    });
}

#[test]
fn states() {
    const GOOD: &str = "[{\"q\": [1.7, 3.7, 2.2], \"qd\": [0.1, -0.2, 0.3], \"qdd\": [0, 1e-3, -2]},\n\
                        {\"q\": [0, 1, 2], \"qd\": [0, 0, 0], \"qdd\": [0, 0, 0]}]\n";
    const BLOCKS: &str =
        "[{\"a\": [[1.7, 3.7, 2.2], [0.1, -0.2, 0.3], [0, 1e-3, -2]], \"b\": [[1, 2], [0, 0], [0, 0]]}]\n";
    let alone = Assembly::from(builtin("nine-link").expect("built in").clone());
    let text = "kind = \"assembly\"\nname = \"two\"\n[[block]]\nname = \"a\"\nmachine = \"nine-link\"\n[[block]]\n\
                name = \"b\"\nmachine = \"two-drive\"\n";
    let two = parse_assembly(text, "two", &named).expect("an assembly");
    for (name, good, assembly) in [("states", GOOD, &alone), ("blocks", BLOCKS, &two)] {
        fuzz(name, &bytes(&[good]), 300, |bytes, _| {
            match dynamics::states_in(&String::from_utf8_lossy(bytes), "in.json", assembly) {
                Ok(states) => {
                    let all = states.iter().flatten().flat_map(|s| [&*s.q.0, &*s.qd, &*s.qdd].concat());
                    if all.into_iter().all(f64::is_finite) { Ok(()) } else { Err("a state that is not finite".into()) }
                }
                Err(failure) => said(&failure),
            }
        });
    }
}

#[test]
fn parts() {
    let folder = std::path::Path::new(option_env!("CARGO_TARGET_TMPDIR").unwrap_or("/tmp"));
    let named = |name: &str, ending: &str| folder.join(format!("fuzz-{name}-{}.{ending}", std::process::id()));
    for (target, form) in [("parquet", RowForm::Parquet), ("parts", RowForm::Csv)] {
        let ending = form.ending();
        let (part, whole) = (named("part", ending), named("whole", ending));
        let study = StudyId { samples: 40, seed: 1, problem: 7 };
        let head = ShardHeader::new(study, ["a".to_owned()]);
        let mut writer = Writer::create((&part, form), true, &head).expect("begun");
        for i in 0..40 {
            let x = 0.1 + 1e-3 * i as f64;
            writer.row(i, &[x, x, 2.0 * x, 0.5 * x, x]).expect("written");
        }
        writer.finish().expect("written");
        let good = std::fs::read(&part).expect("readable");
        fuzz(target, &[good], 150, |bytes, _| {
            std::fs::write(&part, bytes).expect("a place to write");
            match merge(std::slice::from_ref(&part), (&whole, form), true, &|| true) {
                Ok(Some((study, outcomes))) if outcomes.len() as u64 == study.samples => Ok(()),
                Ok(_) => Err("another number of machines than it says".into()),
                Err(why) => is_short(&why.to_string()),
            }
        });
        let _ = std::fs::remove_file(&part);
        let _ = std::fs::remove_file(&whole);
    }
}
