//! For scripts: judgements as exit statuses, standard input and output, quiet runs, completions and manual pages.

use std::io::Write;

use super::*;
use stillbase::files::row_file::RowFile;

/// What the program answers to a text on standard input.
fn given(input: &str, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_stillbase"));
    command.args(args).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("it reads");
    child.wait_with_output().expect("it ends")
}

#[test]
fn strict_ends_with_one_where_something_is_not_good() {
    for (args, good) in [
        (&["check", "nine-link"][..], true),
        (&["check", "nine-link-table-1"], false),
        (&["simulate", "case-3", "--every", "1000"], true),
        (&["simulate", "case-1", "--every", "1000"], false),
        (&["simulate", "case-3", "--every", "1000", "--set", "drive.1.torque_limit=0.5"], false),
        (&["simulate", "case-3", "--json"], true),
        (&["joints", "case-3"], true),
        (&["joints", "case-1"], false),
        (&["compare", "case-3", "change-b"], false),
        (&["spectrum", "case-1", "--limit-moment", "1000"], true),
        (&["spectrum", "case-1", "--limit-moment", "1e-9"], false),
        (&["tolerance", "case-3", "--samples", "50", "--limit-moment", "1000"], true),
        (&["tolerance", "case-3", "--samples", "50", "--limit-moment", "1e-9"], false),
        (&["plan", "nine-link", "0.5,0.5", "0.55,0.9"], true),
        (&["plan", "nine-link-bare", "0.5,0.5", "0.55,0.9"], false),
        (&["export", "case-1", "--what", "simulated", "--rate", "10"], false),
        (&["learn", "nine-link-table-1", "--equation", "7"], false),
    ] {
        let plain = stillbase(args);
        let strict = stillbase(&[args, &["--strict"]].concat());
        assert_eq!(plain.status.code(), Some(0), "{args:?}: {}", text(&plain.stderr));
        assert_eq!(strict.status.code(), Some(i32::from(!good)), "{args:?}: {}", text(&strict.stderr));
        assert_eq!(strict.stdout, plain.stdout, "{args:?}: the same answer");
        let more = text(&strict.stderr).strip_prefix(text(&plain.stderr)).expect("the same notes");
        assert_eq!(more.starts_with("stillbase: --strict: ") && more.lines().count() == 1, !good, "{args:?}: {more}");
    }
    fails(&["keys", "friction", "--strict"], 2, &["--strict"]);
}

#[test]
fn strict_says_what_is_not_good() {
    let folder = Folder::new("strict");
    let missed = folder.file(
        "missed.toml",
        "machine = \"nine-link\"\nduration = 0.5\n[task]\nkind = \"reactionless\"\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\nb = 2.4\n",
    );
    let missed = word(missed);
    for (args, words) in [
        (&["check", "nine-link-table-1"][..], "nine-link-table-1: not force balanced"),
        (&["check", "nine-link-table-1"], "nine-link-table-1: not invariant"),
        (&["simulate", "case-1", "--every", "1000"], "case-1: not reactionless"),
        (
            &["simulate", "case-1", "--every", "1000", "--set", "plant.force=-60,60"],
            "past the limit of the angle a1 by ",
        ),
        (&["simulate", "case-3", "--every", "1000", "--set", "drive.1.torque_limit=0.5"], "past a limit of a drive"),
        (&["simulate", &missed, "--every", "100"], "missed: off its target by "),
        (&["plan", "nine-link-bare", "0.5,0.5", "0.55,0.9"], "machine: off balance by "),
        (&["learn", "nine-link-table-1", "--equation", "7"], "Eq. (7) does not hold"),
        (&["spectrum", "case-1", "--limit-moment", "1:1e-9,100:1e-9"], "case-1: n_B past its limit"),
        (
            &["tolerance", "case-3", "--samples", "20", "--limit-moment", "1e-9"],
            "20 of 20 machines past the limit of the moment",
        ),
        (&["compare", "case-1", "case-3"], "case-1: not reactionless"),
    ] {
        for more in [&["--strict"][..], &["--strict", "--quiet"], &["--strict", "--json"]] {
            let out = stillbase(&[args, more].concat());
            let said = text(&out.stderr);
            assert_eq!(out.status.code(), Some(1), "{args:?}: {said}");
            let last = said.lines().last().unwrap_or_default();
            assert!(last.starts_with("stillbase: --strict: ") && last.contains(words), "{args:?}: {said}");
            assert!(more != ["--strict", "--quiet"] || said.lines().count() == 1, "{said}");
        }
    }
    // What cannot be trusted ends with 1 in any case.
    let rough = ["simulate", "case-3", "--every", "100", "--set", "step=0.01", "--set", "plant.friction.viscous=2500"];
    for more in [&[][..], &["--strict"], &["--quiet"]] {
        let out = stillbase(&[&rough, more].concat());
        assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
        assert!(text(&out.stderr).contains("audit failed: step: "), "{}", text(&out.stderr));
    }
}

/// What bash completes after words, the last of which is begun.
fn completed(script: &Path, words: &[&str]) -> Vec<String> {
    let line = "source \"$1\"; shift; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); \
                _stillbase stillbase \"${COMP_WORDS[COMP_CWORD]}\" \"${COMP_WORDS[COMP_CWORD - 1]}\"; \
                printf '%s\\n' \"${COMPREPLY[@]}\"";
    let out = Command::new("bash").args(["--norc", "-c", line, "bash"]).arg(script).args(words).output();
    let out = out.expect("bash");
    assert!(out.stderr.is_empty(), "{}", text(&out.stderr));
    text(&out.stdout).lines().map(str::to_owned).collect()
}

#[cfg(unix)]
#[test]
fn bash_completes_commands_options_and_their_words() {
    if Command::new("bash").arg("--version").output().is_err() {
        return;
    }
    let folder = Folder::new("completions");
    let script = folder.file("stillbase.bash", prints(&["completions", "bash"]));
    let of = |words: &[&str]| completed(&script, words);
    assert_eq!(of(&["stillbase", "sim"]), ["simulate"]);
    assert_eq!(of(&["stillbase", "export-model", "--fo"]), ["--force", "--format"]);
    assert_eq!(of(&["stillbase", "diff", "--tol"]), ["--tolerance"]);
    assert!(of(&["stillbase", "export", "case-1", "--what", ""]).contains(&"simulated".to_owned()));
    assert!(of(&["stillbase", ""]).contains(&"workspace".to_owned()));
    assert!(of(&["stillbase", "simulate", "--"]).contains(&"--signals".to_owned()));
}

#[test]
fn a_dash_is_a_table_or_a_scenario_of_a_comparison() {
    let csv = prints(&["simulate", "case-3", "--set", "task.time=0.3"]);
    let same = given(&csv, &["diff", "case-3", "-", "--set", "task.time=0.3"]);
    assert_eq!(same.status.code(), Some(0), "{}{}", text(&same.stdout), text(&same.stderr));
    let other = given(&csv, &["diff", "-", "case-3"]);
    assert_eq!(other.status.code(), Some(1), "{}", text(&other.stdout));
    let scenario =
        "machine = \"nine-link\"\n[task]\nkind = \"reactionless\"\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\nb = 2.4\n";
    let same = given(scenario, &["diff", "-", "case-3"]);
    assert_eq!(same.status.code(), Some(0), "{}{}", text(&same.stdout), text(&same.stderr));
    let part = given(&csv, &["table", "-", "--signals", "torque/1", "-o", "-"]);
    assert!(text(&part.stdout).starts_with("time s,torque/1 N m\n"), "{}", text(&part.stderr));
    fails(&["table", "-"], 2, &["want a recording or a table"]);
}

#[test]
fn a_dash_is_standard_input_and_output() {
    let scenario =
        "machine = \"nine-link\"\n[task]\nkind = \"reactionless\"\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\nb = 2.4\n";
    let run = given(scenario, &["simulate", "-", "--json", "--every", "1000"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let run: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    assert_eq!(run["verdict"]["reactionless"], true);
    // A machine, also as a scenario whose machine is meant.
    for input in [NINE_LINK, scenario] {
        let checked = given(input, &["check", "-", "--json"]);
        let checked: Value = serde_json::from_slice(&checked.stdout).expect("JSON");
        assert_eq!(checked["force_balanced"], true);
    }
    // Out and in again.
    let planned = stillbase(&["plan", "nine-link", "0.5,0.5", "0.55,0.9", "-o", "-"]);
    assert!(text(&planned.stderr).contains("peak"), "{}", text(&planned.stderr));
    let again = given(text(&planned.stdout), &["simulate", "-", "--every", "1000"]);
    assert_eq!(again.status.code(), Some(0), "{}", text(&again.stderr));
    let designed = stillbase(&["design", "nine-link-table-1", "-o", "-", "--quiet"]);
    assert!(designed.stderr.is_empty(), "{}", text(&designed.stderr));
    let checked = given(text(&designed.stdout), &["check", "-", "--strict"]);
    assert_eq!(checked.status.code(), Some(0), "{}", text(&checked.stderr));
    for args in
        [&["simulate", "case-1", "-o", "-"][..], &["joints", "case-1", "-o", "-"], &["spectrum", "case-1", "-o", "-"]]
    {
        let out = stillbase(args);
        let head = text(&out.stdout).lines().next().expect("a head").to_owned();
        assert!(["time s,", "frequency Hz,"].iter().any(|start| head.starts_with(start)), "{head}");
    }
    // A model goes out as the first of its formats, and comes in again.
    let model = stillbase(&["export-model", "two-drive", "-o", "-"]);
    assert!(text(&model.stdout).contains("<mujoco"), "{}", text(&model.stderr));
    let back = given(text(&model.stdout), &["import-model", "-", "-o", "-"]);
    assert_eq!(back.status.code(), Some(0), "{}", text(&back.stderr));
    let checked = given(text(&back.stdout), &["check", "-", "--json"]);
    assert_eq!(checked.status.code(), Some(0), "{}", text(&checked.stderr));
    // Samples, states and measured forces come in.
    let samples = prints(&["export", "case-1", "--what", "simulated", "--rate", "250"]);
    let states = r#"[{"q": [0.1, 0.2, 0.3], "qd": [0, 0, 1], "qdd": [0, 1, 0]}]"#;
    for (input, args) in [
        (&samples[..], &["import", "-", "--json"][..]),
        (&samples, &["trim", "-", "nine-link", "--json"]),
        (states, &["dynamics", "nine-link", "--states", "-", "--json"]),
    ] {
        let out = given(input, args);
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        assert!(serde_json::from_slice::<Value>(&out.stdout).is_ok_and(|value| value.is_object()), "{args:?}");
    }
    let table = prints(&["compare", "case-1", "case-3", "-o", "-"]);
    assert!(table.starts_with("scenario,reactionless,refused,duration s,peak_felt_moment N m,"), "{table}");
    // What is wrong there is told by its line; what cannot be read is refused.
    let wrong = given("machine = \"nine-link\"\n[task]\nkind = 3\n", &["simulate", "-"]);
    assert!(
        wrong.status.code() == Some(2) && text(&wrong.stderr).contains("standard input:3"),
        "{}",
        text(&wrong.stderr)
    );
    fails(&["simulate", "case-1", "--json", "-o", "-"], 2, &["both want standard output"]);
}

/// What goes to standard output is the file, and nothing else; the rest goes to standard error.
#[test]
fn a_file_goes_to_standard_output_whole() {
    let folder = Folder::new("standard");
    let line = |line: &str| line.split(' ').map(str::to_owned).collect::<Vec<_>>();
    for (command, file, format) in [
        ("report case-3", "report.html", ""),
        ("render case-1 --at 0.5", "view.svg", "svg"),
        ("render case-1 --at 0.5", "view.pdf", "pdf"),
        ("figures case-1 --what torque,linkage --force", "drawn.svg", ""),
        ("figures case-1 --what torque,linkage --force", "drawn.pdf", "PDF"),
        ("figures --paper fig-3", "fig-3.svg", ""),
        ("figures --paper table-1", "table-1.pdf", ".pdf"),
        ("tolerance case-3 --samples 50", "study.csv", ""),
        ("tolerance case-3 --samples 50", "study.parquet", "parquet"),
        ("simulate case-3 --every 100", "run.csv", "csv"),
        ("simulate case-3 --every 100", "run.parquet", "parquet"),
        ("export case-3 --rate 100", "rows.parquet", "parquet"),
        ("compare case-3 case-1", "runs.parquet", "parquet"),
        ("spectrum case-1", "spectrum.parquet", "parquet"),
        ("joints case-1", "pins.parquet", "parquet"),
        ("table run.parquet", "table.csv", ""),
        ("table run.parquet", "table.parquet", "parquet"),
        ("export-model scara", "parts.parquet", "parquet"),
        ("export-model scara", "arm.urdf", "urdf"),
    ] {
        let output = if command.contains("--paper") { "." } else { file };
        let mut to_file = line(command);
        to_file.extend(["-o", output].map(String::from));
        let out = folder.run(&to_file.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(out.status.code(), Some(0), "{command}: {}", text(&out.stderr));
        let mut written = fs::read(folder.path(file)).expect("the file");
        let mut standard = line(command);
        standard.extend(["-o", "-"].map(String::from));
        standard.extend((!format.is_empty()).then(|| ["--format", format].map(String::from)).into_iter().flatten());
        let out = folder.run(&standard.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(out.status.code(), Some(0), "{standard:?}: {}", text(&out.stderr));
        // What says how it was made names the output.
        if let Ok(text) = String::from_utf8(written.clone()) {
            written = text.replace(&format!("-o {file}"), "-o -").into_bytes();
        }
        if file == "drawn.pdf" {
            // There it is packed.
            assert!(out.stdout.starts_with(b"%PDF-1.7") && out.stdout.ends_with(b"%%EOF"), "{standard:?}");
        } else {
            assert!(out.stdout == written, "{standard:?}: {} bytes, {} in the file", out.stdout.len(), written.len());
        }
        assert!(!text(&out.stderr).contains("wrote"), "{}", text(&out.stderr));
    }
    let reported = folder.run(&["report", "case-3", "-o", "-"]);
    assert!(text(&reported.stderr).contains("5 plots"), "{}", text(&reported.stderr));
    let merged = folder.run(&["tolerance", "--merge", "study.csv", "-o", "-"]);
    assert_eq!(merged.stdout, fs::read(folder.path("study.csv")).expect("the file"));
    // Measured forces make a new machine.
    fs::write(folder.path("plate.csv"), prints(&["export", "case-1", "--what", "simulated"])).expect("written");
    let trimmed = folder.run(&["trim", "plate.csv", "nine-link", "--identified", "-"]);
    let checked = given(text(&trimmed.stdout), &["check", "-", "--strict"]);
    assert_eq!(checked.status.code(), Some(0), "{}{}", text(&trimmed.stderr), text(&checked.stderr));
    // What fails leaves standard output empty.
    let failed = folder.run(&["report", "case-3", "-o", "-", "--set", "task.b=2.9"]);
    assert!(failed.status.code() == Some(1) && failed.stdout.is_empty(), "{}", text(&failed.stderr));
    for (args, want) in [
        (&["figures", "--paper", "all", "-o", "-"][..], "one figure, as --paper fig-3 -o -"),
        (&["figures", "-o", "-"], "one figure, as --paper fig-3 -o -"),
        (&["figures", "case-1", "--what", "torque", "-o", "-", "--numbers", "csv"], "--numbers has no use here"),
        (&["figures", "case-1", "--what", "torque", "-o", "-", "--format", "png"], "want svg or pdf"),
        (&["man", "-o", "-"], "`stillbase man` without -o"),
        (&["import", "plate.csv", "-o", "-"], "import writes two"),
        (&["trim", "plate.csv", "nine-link", "-o", "-", "--identified", "-"], "both want standard output"),
        (&["render", "case-3", "-o", "-", "--film", "--format", "svg"], "want gif or png or webp or mp4"),
        (&["render", "case-3", "-o", "a.svg", "--format", "png"], "the ending of a.svg chooses"),
        (&["report", "case-3", "-o", "-", "--json"], "both want standard output"),
        (&["joints", "case-3", "--format", "csv"], "want -o - as well"),
        (&["simulate", "case-3", "--format", "xlsx"], "--format xlsx: want csv or parquet"),
        (&["report", "case-3", "-o", "-", "--format", "md"], "--format md: want html or htm"),
    ] {
        let out = folder.run(args);
        assert_eq!(out.status.code(), Some(2), "{args:?}");
        assert!(
            text(&out.stderr).contains(want) && !text(&out.stdout).contains('<'),
            "{args:?}: {}",
            text(&out.stderr)
        );
    }
}

/// A recording goes to standard output, and comes in as a file.
#[cfg(feature = "record")]
#[test]
fn a_recording_goes_to_standard_output() {
    let folder = Folder::new("standard");
    let out = folder.run(&["headless", "case-3", "-o", "-"]);
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    folder.file("run.rrd", &out.stdout);
    let same = folder.run(&["replay", "run.rrd"]);
    assert_eq!(same.status.code(), Some(0), "{}", text(&same.stderr));
}

/// Every cell of a table is the same in both formats, whatever the columns hold.
#[test]
fn every_cell_of_parquet_is_that_of_csv() {
    let folder = Folder::new("cells");
    for (csv, parquet, args) in [
        ("parts.csv", "parts.parquet", &["export-model", "nine-link", "-o"][..]),
        (
            "run.csv",
            "run.parquet",
            &["figures", "case-1", "--what", "moment,workspace", "-o", "run.svg", "--force", "--numbers"],
        ),
        ("fig-4.csv", "fig-4.parquet", &["figures", "--paper", "fig-4", "--force", "--numbers"]),
        ("table-1.csv", "table-1.parquet", &["figures", "--paper", "table-1", "--force", "--numbers"]),
    ] {
        for file in [csv, parquet] {
            let last = if args.ends_with(&["--numbers"]) { file.split_once('.').expect("an ending").1 } else { file };
            let out = folder.run(&[args, &[last]].concat());
            assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        }
        let written = fs::read_to_string(folder.path(csv)).expect("CSV");
        let is_about = |line: &&str| line.starts_with("# ");
        let about: Vec<&str> = written.lines().take_while(is_about).map(|line| &line[2..]).collect();
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(written.as_bytes());
        let head: Vec<String> = reader.headers().expect("a head").iter().map(str::to_owned).collect();
        let opened = fs::File::open(folder.path(parquet)).expect("a file");
        let columns = parquet::file::reader::SerializedFileReader::new(opened).expect("Parquet");
        let metadata = parquet::file::reader::FileReader::metadata(&columns).file_metadata().clone();
        let names: Vec<&str> = metadata.schema_descr().columns().iter().map(|c| c.name()).collect();
        assert_eq!(head, names, "{csv}");
        let note = metadata.key_value_metadata().and_then(|all| all.iter().find(|own| own.key == "stillbase.about"));
        let note = note.and_then(|own| own.value.clone()).unwrap_or_default();
        let numbers = if args[0] == "figures" { note.replace(" --numbers parquet", "") } else { note };
        let about = about.join("\n").replace(" --numbers csv", "");
        assert_eq!(numbers, about, "{csv}");
        let rows = parquet::file::reader::FileReader::get_row_iter(&columns, None).expect("rows");
        let (mut count, mut figures) = (0, 0);
        for (cells, row) in reader.records().zip(rows) {
            let (cells, row) = (cells.expect("a row"), row.expect("a row"));
            for (cell, (name, field)) in cells.iter().zip(row.get_column_iter()) {
                match field {
                    parquet::record::Field::Str(text) => assert_eq!(cell, text, "{csv}: {name}"),
                    parquet::record::Field::Double(x) if cell.is_empty() => assert!(x.is_nan(), "{csv}: {name}"),
                    parquet::record::Field::Double(x) => {
                        assert_eq!(cell.parse::<f64>().expect("a number").to_bits(), x.to_bits(), "{csv}: {name}");
                        figures += 1;
                    }
                    other => panic!("{csv}: {name} is {other}"),
                }
            }
            count += 1;
        }
        assert!(count > 9 && figures > 20, "{csv}: {count} rows, {figures} numbers");
        assert_eq!(metadata.num_rows(), count, "{csv}");
    }
}

/// A motion and a measurement give the same answer from both formats; what is wrong is told by its row.
#[test]
fn tables_come_in_as_parquet() {
    let folder = Folder::new("in-parquet");
    let answer = |args: &[&str]| {
        let out = folder.run(args);
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        let mut value: Value = serde_json::from_slice(&out.stdout).expect("JSON");
        value.as_object_mut().expect("an object").remove("file");
        value
    };
    for file in ["plate.csv", "plate.parquet"] {
        let out = folder.run(&["export", "case-1", "--what", "simulated", "--rate", "250", "-o", file]);
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    }
    let import = |file: &str| answer(&["import", file, "--json"]);
    assert_eq!(import("plate.csv"), import("plate.parquet"));
    let trim = |file: &str| answer(&["trim", file, "nine-link", "--json"]);
    assert_eq!(trim("plate.csv"), trim("plate.parquet"));
    for (args, want) in [
        (&["import", "plate.parquet", "--machine", "four-drive"][..], "plate.parquet: no column q4 among"),
        (&["import", "none.parquet"], "none.parquet: No such file"),
        (&["trim", "plate.parquet"], "no machine: want one after the files"),
        (&["import", "torn.parquet"], "torn.parquet: "),
        (&["import", "back.parquet"], "back.parquet: row 3: column t: 0 s after 0.004 s: want times that rise"),
    ] {
        let bytes = fs::read(folder.path("plate.parquet")).expect("the file");
        folder.file("torn.parquet", &bytes[..bytes.len() / 2]);
        let mut rows =
            RowFile::create(&folder.path("back.parquet"), true, "instant", &["t", "x", "y"].map(String::from))
                .expect("begun");
        for t in [0.0, 0.004, 0.0, 0.008] {
            rows.row(&[Some(t), Some(0.5), Some(0.5)]).expect("a row");
        }
        rows.finish().expect("written");
        let out = folder.run(args);
        assert_eq!(out.status.code(), Some(2), "{args:?}");
        assert!(text(&out.stderr).contains(want), "{args:?}: {}", text(&out.stderr));
    }
}

#[test]
fn tables_are_parquet_where_they_are_csv() {
    let folder = Folder::new("parquet");
    for args in [
        &["compare", "case-1", "case-3"][..],
        &["joints", "case-1"],
        &["spectrum", "case-1"],
        &["export", "case-3"],
        &["simulate", "case-3"],
    ] {
        let [csv, parquet] = ["table.csv", "table.parquet"].map(|name| folder.path(&format!("{}-{name}", args[0])));
        for file in [&csv, &parquet] {
            let out = stillbase(&[args, &["-o", &file.display().to_string()]].concat());
            assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        }
        let csv = fs::read_to_string(csv).expect("CSV");
        let reader = parquet::file::reader::SerializedFileReader::new(fs::File::open(&parquet).expect("a file"))
            .expect("Parquet");
        let metadata = parquet::file::reader::FileReader::metadata(&reader).clone();
        assert_eq!(metadata.file_metadata().num_rows() as usize + 1, csv.lines().count(), "{args:?}");
        let names: Vec<&str> = metadata.file_metadata().schema_descr().columns().iter().map(|c| c.name()).collect();
        assert_eq!(csv.lines().next().expect("a head"), names.join(","), "{args:?}");
        // The first number of the last row.
        let rows = parquet::file::reader::FileReader::get_row_iter(&reader, None).expect("rows");
        let last = rows.last().expect("a row").expect("a row");
        let first = last.get_column_iter().find_map(|(name, field)| match field {
            parquet::record::Field::Double(x) => Some((name.clone(), *x)),
            _ => None,
        });
        let (name, x) = first.expect("a number");
        let at = names.iter().position(|own| *own == name).expect("a column");
        let cell: f64 =
            csv.lines().last().expect("a row").split(',').nth(at).expect("a cell").parse().expect("a number");
        assert_eq!(cell, x, "{args:?}: {name}");
    }
    fails(&["joints", "case-1", "-o", "pins.txt"], 2, &[".csv or .parquet"]);
}

#[test]
fn quiet_says_nothing_but_errors() {
    let out = stillbase(&["simulate", "case-1", "--every", "1000", "--quiet"]);
    assert!(out.status.success() && out.stderr.is_empty() && !out.stdout.is_empty(), "{}", text(&out.stderr));
    let loud = stillbase(&["simulate", "case-1", "--every", "1000"]);
    assert!(!loud.stderr.is_empty() && loud.stdout == out.stdout);
    fails(&["simulate", "no-such", "--quiet"], 2, &["no such scenario"]);
}

#[test]
fn completions_know_every_command() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = prints(&["completions", shell]);
        assert!(script.contains("workspace") && script.contains("counterweights"), "{shell}");
    }
    fails(&["completions", "tcl"], 2, &["bash"]);
}

#[test]
fn manual_pages_are_printed_or_written() {
    let page = prints(&["man"]);
    assert!(page.starts_with(".ie") && page.contains("Zero reaction manipulators"), "{page}");
    let folder = Folder::new("man");
    let place = folder.0.display().to_string();
    prints(&["man", "-o", &place]);
    let check = fs::read_to_string(folder.path("stillbase-check.1")).expect("a page");
    assert!(check.contains("stillbase\\-check") && check.contains("force balanced"), "{check}");
    for name in ["stillbase.1", "stillbase-check.1", "stillbase-diff.1"] {
        let page = fs::read_to_string(folder.path(name)).expect("a page");
        let title = page.lines().find(|line| line.starts_with(".TH")).expect("a title");
        assert!(title.contains(env!("CARGO_PKG_VERSION")), "{name}: {title}");
    }
    fails(&["man", "-o", &place], 2, &["exists", "--force"]);
    prints(&["man", "-o", &place, "--force"]);
    fails(&["man", "-o", &word(folder.path("no"))], 2, &["no folder"]);
}

#[test]
fn the_version_names_commit_and_profile() {
    let version = prints(&["--version"]);
    assert!(version.starts_with(concat!("stillbase ", env!("CARGO_PKG_VERSION"), " (")), "{version}");
    assert!(version.contains("profile dev)") || version.contains("profile release)"), "{version}");
    // The commit is that of the checkout, or the one that the build was told.
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let head = Command::new("git").args(["rev-parse", "HEAD"]).current_dir(root).output();
    let head = head.ok().filter(|out| out.status.success() && root.join(".git").exists());
    match option_env!("STILLBASE_COMMIT") {
        Some(commit) => {
            assert!(version.contains(&format!("(commit {commit}, ")), "{version}");
            let is_told = std::env::var_os("STILLBASE_COMMIT").is_some();
            assert!(is_told || head.is_none_or(|head| text(&head.stdout).starts_with(commit)), "{version}");
        }
        None => assert!(head.is_none() && !version.contains("commit"), "{version}"),
    }
}

#[test]
fn a_misspelt_command_is_answered_with_the_nearest_even_with_arguments() {
    for args in [
        &["chek", "nine-link"][..],
        &["chek", "nine-link", "--json"],
        &["chek", "nine-link", "--set", "payload.mass=0.1"],
        &["chek"],
    ] {
        fails(args, 2, &["chek", "stillbase check"]);
    }
}

/// With --json every refusal is one object on standard output, with the reason that standard error gives.
#[test]
fn every_refusal_is_an_object() {
    let folder = Folder::new("refusals");
    let wrong = word(folder.path("x.jpg"));
    for (args, status) in [
        (&["replay", "none.rrd"][..], 2),
        (&["diff", "none.rrd", "case-1"], 2),
        (&["diff", "case-3", "case-3", "--tolerance", "foo=1"], 2),
        (&["compare", "case-3", "--set", "task.b=0.2"], 1),
        (&["headless", "case-1", "-o", &wrong], 2),
        (&["simulate", "case-9"], 2),
        (&["check", "nine-link-table-1", "--strict"], 1),
    ] {
        let out = stillbase(&[args, &["--json"]].concat());
        assert_eq!(out.status.code(), Some(status), "{args:?}");
        let values: Vec<Value> = serde_json::Deserializer::from_slice(&out.stdout)
            .into_iter()
            .map(|value| value.unwrap_or_else(|why| panic!("{args:?}: {why}")))
            .collect();
        let [value] = &values[..] else { panic!("{args:?}: {} objects", values.len()) };
        // A judgement follows the answer itself.
        if !args.contains(&"--strict") {
            let reason = value["reason"].as_str().unwrap_or_else(|| panic!("{args:?}: {value}"));
            assert!(text(&out.stderr).contains(reason.split(':').next().unwrap_or_default()), "{args:?}: {reason}");
        }
    }
}

/// A word that a command begins with names it, however long the rest is.
#[test]
fn the_beginning_of_a_command_names_it() {
    for (given, meant) in [("complet", "completions"), ("tol", "tolerance"), ("chek", "check"), ("simulat", "simulate")]
    {
        let out = stillbase(&[given, "nine-link"]);
        assert_eq!(out.status.code(), Some(2), "{given}");
        let all = text(&out.stderr);
        assert!(all.contains(meant), "{given}: {all}");
    }
}

#[test]
fn quiet_stands_before_or_after_the_command() {
    for args in
        [&["--quiet", "check", "nine-link"][..], &["check", "--quiet", "nine-link"], &["check", "nine-link", "--quiet"]]
    {
        let out = stillbase(args);
        assert!(out.status.success() && out.stderr.is_empty() && !out.stdout.is_empty(), "{args:?}");
    }
}
