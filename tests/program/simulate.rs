//! `simulate`: what it prints, what it writes, what is set by key.

use super::*;

#[test]
fn simulate_prints_every_signal() {
    let got = object(&["simulate", "case-3", "--every", "7"]);
    assert_eq!(keys(&got), ["scenario", "signals", "time", "units", "verdict"]);
    let peaks = ["peak_base_force", "peak_base_moment", "peak_torque"];
    let sums = ["rms_base_force", "rms_base_moment", "steps"];
    let all: Vec<&str> = ["audit", "base_angle", "base_shift", "base_tilt", "miss", "moved"]
        .into_iter()
        .chain(peaks[..2].iter().copied())
        .chain(["peak_tilt", peaks[2], "reactionless", "remarks"])
        .chain(sums.into_iter().take(2))
        .chain(["sentence", "statements", "steps"])
        .collect();
    assert_eq!(keys(&got["verdict"]), all);
    assert_eq!(keys(&got["verdict"]["audit"]), ["angular", "energy", "loops", "momentum", "plane", "step"]);
    assert_eq!(keys(&got["signals"]), keys(&got["units"]));
    let time = numbers(&got["time"]);
    // Steps 0, 7 … 994 and the last, 1000.
    assert_eq!((time.len(), time[1], time[143]), (144, 0.007, 1.0));
    assert!(got["signals"].as_object().expect("signals").values().all(|s| numbers(s).len() == time.len()));
    assert_eq!(got["units"]["moment/total"], "N m");
    assert_eq!(got["verdict"]["reactionless"], true);
    near(&got["verdict"]["peak_torque"], &planning()["motion"]["nine-link"]["case_3_peak_torque"], 1e-5, "torque");

    let csv = prints(&["simulate", "case-3", "--every", "7"]);
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let head: Vec<String> = reader.headers().expect("head").iter().map(String::from).collect();
    assert_eq!(&head[..2], ["time s", "torque/1 N m"]);
    let rows: Vec<Vec<f64>> = reader.deserialize().collect::<Result<_, _>>().expect("numbers");
    assert_eq!(rows.len(), time.len());
    for (path, unit) in got["units"].as_object().expect("units") {
        let name = format!("{path} {}", unit.as_str().expect("unit"));
        let column = head.iter().position(|h| *h == name).unwrap_or_else(|| panic!("no column {name}"));
        let values: Vec<f64> = rows.iter().map(|r| r[column]).collect();
        // The same to the last digit; JSON is read with an error of one.
        near(&json!(values), &got["signals"][path], 1e-15, &name);
    }
}

#[test]
fn simulate_writes_a_whole_file_or_none() {
    let folder = Folder::new("cli");
    let file = word(folder.path("case.csv"));
    let with_json = object(&["simulate", "case-1", "-o", &file]);
    let written = fs::read_to_string(&file).expect("file");
    assert_eq!(written.lines().count(), 1 + numbers(&with_json["time"]).len());
    fails(&["simulate", "case-3", "-o", &file], 2, &["case.csv exists", "--force"]);
    assert_eq!(fs::read_to_string(&file).expect("file"), written);
    // Nothing is left of a run that is refused half-way.
    fails(&["simulate", "case-1", "--set", "limits.a1=0,0.1", "-o", &word(folder.path("new.csv"))], 1, &["case-1"]);
    fails(&["simulate", "-o", &word(folder.path("no/folder.csv"))], 2, &["no folder"]);
    fails(&["simulate", "-o", &word(folder.path("."))], 2, &["is a folder"]);
    assert_eq!(folder.names(), ["case.csv"]);
    prints(&["simulate", "case-3", "--every", "500", "-o", &file, "--force"]);
    assert_eq!(fs::read_to_string(&file).expect("file").lines().count(), 4);
    assert_eq!(folder.names(), ["case.csv"]);
}

#[cfg(unix)]
#[test]
fn a_link_is_written_through() {
    let folder = Folder::new("cli");
    let real = word(folder.file("real.csv", "old"));
    let (link, dangling) = (word(folder.path("link.csv")), word(folder.path("dangling.csv")));
    std::os::unix::fs::symlink(&real, &link).expect("a link");
    std::os::unix::fs::symlink(word(folder.path("nothing")), &dangling).expect("a link");
    fails(&["simulate", "-o", &link], 2, &["link.csv exists"]);
    fails(&["simulate", "-o", &dangling], 2, &["dangling.csv exists"]);
    prints(&["simulate", "-o", &link, "--force"]);
    assert!(fs::symlink_metadata(&link).expect("link").is_symlink());
    assert!(fs::read_to_string(&real).expect("file").starts_with("time s,"));
    assert_eq!(folder.names(), ["dangling.csv", "link.csv", "real.csv"]);
}

#[cfg(unix)]
#[test]
fn a_full_disk_and_a_closed_pipe_are_no_panic() {
    let full_disk = || fs::OpenOptions::new().write(true).open("/dev/full");
    if let Ok(full) = full_disk() {
        let out = Command::new(env!("CARGO_BIN_EXE_stillbase")).arg("machines").stdout(full).output().expect("starts");
        let said = text(&out.stderr);
        assert!(out.status.code() == Some(2) && said.starts_with("stillbase: standard output"), "{said}");
        for help in [&["--help"][..], &["plan", "--help"], &["--version"]] {
            let full = full_disk().expect("it was there");
            let out = Command::new(env!("CARGO_BIN_EXE_stillbase")).args(help).stdout(full).output().expect("starts");
            let said = text(&out.stderr);
            assert!(out.status.code() == Some(2) && said.starts_with("stillbase: standard output"), "{help:?}: {said}");
        }
        fails(&["simulate", "-o", "/dev/full", "--force"], 2, &["/dev/full is no plain file"]);
    }
    // No file may grow beyond four kilobytes here, and to try is an error and not the end.
    let folder = Folder::new("cli");
    let limited = "ulimit -f 8; exec \"$0\" simulate -o x.csv";
    let mut shell = Command::new("sh");
    let out = shell.args(["-c", limited, env!("CARGO_BIN_EXE_stillbase")]).current_dir(&folder.0).output().expect("sh");
    let said = text(&out.stderr);
    assert!(out.status.code() == Some(2) && said.starts_with("stillbase: x.csv: "), "{said}");
    assert!(folder.names().is_empty(), "{:?}", folder.names());
    let mut child = Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .arg("simulate")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts");
    drop(child.stdout.take());
    let out = child.wait_with_output().expect("ends");
    assert_eq!((out.status.code(), text(&out.stderr)), (Some(0), ""));
}

/// What a verdict leaves out is said in words, in the table, and in JSON.
#[test]
fn verdicts_are_said_in_full() {
    let said = |args: &[&str]| text(&stillbase(args).stderr).to_owned();
    let wheel = ["simulate", "case-1", "--set", "base.wheel.inertia=0.002"];
    let line = said(&wheel);
    assert!(line.contains("peak |n_B| 1.089") && line.contains("past the wheel 0.000000 N m"), "{line}");
    assert!(line.contains("reactionless: no") && line.contains("the wheel takes it up"), "{line}");
    let got = object(&wheel);
    // Machine, plan and run are told apart, in words and in JSON.
    assert!(line.contains("machine: balanced · plan: changes b by 0.0"), "{line}");
    let statements = &got["verdict"]["statements"];
    assert_eq!(["machine", "plan", "run"].map(|of| statements[of]["lamp"].clone()), ["good", "bad", "good"]);
    assert!(got["verdict"]["peak_felt_moment"].as_f64() < Some(1e-9), "{}", got["verdict"]);
    assert!(got["verdict"]["peak_base_moment"].as_f64() > Some(1.0), "{}", got["verdict"]);
    let fall = object(&["simulate", "case-3", "--set", "base.kind=free", "--set", "gravity=0,-9.81"]);
    assert_eq!(fall["verdict"]["reactionless"], true);
    assert!(fall["verdict"]["peak_base_force"].as_f64() < Some(1e-9), "{}", fall["verdict"]);
    let tilted = said(&["simulate", "case-3", "--set", "link.5.axial=0.02"]);
    assert!(tilted.contains("reactionless: yes") && tilted.contains("different heights tilt the base"), "{tilted}");
    let held = said(&["simulate", "case-3", "--set", "plant.friction.coulomb=1e4"]);
    assert!(held.contains("never moved") && held.contains("from its target"), "{held}");
    let table = prints(&["compare", "case-3", "--set", "base.wheel.inertia=0.002"]);
    assert!(table.contains("no, the wheel takes it up") && table.contains("peak n_B N m"), "{table}");
}

/// A failed audit is loud: the figures stand there, the message says what is off, and the status is 1.
#[test]
fn a_failed_audit_is_no_answer() {
    // So much friction that no number of parts of such a step can follow it.
    let rough = ["--set", "step=0.01", "--set", "plant.friction.viscous=2500"];
    for (command, key) in [
        (&["simulate", "case-3", "--json"][..], "audit_failed"),
        (&["joints", "case-3", "--json"], "audit_failed"),
        (&["spectrum", "case-3", "--json"], "audit_failed"),
        (&["export", "case-3", "--what", "simulated", "--rate", "100", "--json"], "audit_failed"),
        (&["compare", "case-3", "case-1", "--json"], "\"audit\""),
        (&["tolerance", "case-3", "--simulate", "--samples", "2"], ""),
    ] {
        let out = stillbase(&[command, &rough[..]].concat());
        assert_eq!(out.status.code(), Some(1), "{command:?}: {}", text(&out.stderr));
        assert!(text(&out.stderr).contains("audit failed: step: "), "{command:?}: {}", text(&out.stderr));
        assert!(text(&out.stdout).contains(key), "{command:?}");
        // The same by a smaller step is an answer.
        let fine = ["--set", "step=0.001", "--set", "plant.friction.viscous=2500"];
        let out = stillbase(&[command, &fine[..]].concat());
        assert!(!text(&out.stderr).contains("audit failed"), "{command:?}: {}", text(&out.stderr));
    }
    // Stiff gains that once were off by a third are followed, and say so everywhere.
    let stiff = ["--set", "control.kp=478004", "--set", "control.kd=1514", "--set", "plant.friction.viscous=15.7"];
    for command in [&["simulate", "case-1"][..], &["joints", "case-1"], &["export", "case-1", "--what", "simulated"]] {
        assert_eq!(stillbase(&[command, &stiff[..]].concat()).status.code(), Some(0), "{command:?}");
    }
}

/// The step is set as any other key; edits stay at their times.
#[test]
fn the_step_is_set_by_key() {
    let steps =
        |step: &str| object(&["simulate", "case-3", "--set", step, "--every", "100000"])["verdict"]["steps"].as_u64();
    assert_eq!((steps("step=0.0005"), steps("step=0.01")), (Some(2000), Some(100)));
    for (pair, word) in [("step=0.02", "step is 0.02: want 0.00001 to 0.01 s"), ("step=fast", "0.00001 to 0.01 s")] {
        fails(&["simulate", "case-3", "--set", pair], 2, &[word]);
    }
    let folder = Folder::new("cli");
    let case = include_str!("../../assets/scenarios/case-3.toml");
    let edit = "[[edit]]\nstep = 300\ndo = \"push\"\nx = 5.0\ny = 0.0\n";
    let file = word(folder.file("pushed.toml", format!("{case}\n{edit}")));
    let miss =
        |step: &str| object(&["simulate", &file, "--set", step, "--every", "100000"])["verdict"]["miss"].as_f64();
    let (a, b) = (miss("step=0.001").expect("a number"), miss("step=0.0005").expect("a number"));
    assert!(a > 1e-3 && (a - b).abs() < 1e-6, "{a} {b}");
}

/// What differs in plant, base and control is set by the keys of a file, and refused in words.
#[test]
fn plants_bases_and_control_are_set_by_key() {
    let good =
        ["base.kind=free", "base.com=0.1,0.05", "control.kp=400,300,200", "plant.friction.viscous=0.01,0.02,0.03"];
    let settings: Vec<&str> = good.iter().flat_map(|s| ["--set", s]).collect();
    let got = object(&[&["simulate", "case-1", "--every", "1000"][..], &settings].concat());
    assert!(got["verdict"]["base_angle"].as_f64().expect("a number") > 0.01);
    for (pair, word) in [
        ("base.kind=floating", "floating"),
        ("base.mass=-1", "base.mass) is -1"),
        ("base.colour=3", "colour"),
        ("plant.payload.mass=-1", "plant.payload.mass) is -1"),
        ("plant.link.77.mass=1", "77"),
        ("plant.length.l1=-1", "length"),
        ("plant.friction.coulomb=1,2", "has 2 numbers: want one for all drives, or 3, one for each"),
        ("control.law=magic", "magic"),
        ("control.rate=333.3", "control.rate) is 333.3"),
        ("control.delay=0.0005", "control.delay"),
        ("plant.payload.until=0", "plant.payload.until"),
        ("base.wheel.inertia=0", "base.wheel.inertia"),
        ("task.time=nan", "time is not a finite number"),
        ("plant.payload.offset=[0.1,inf]", "payload.offset is not a finite number"),
    ] {
        fails(&["simulate", "case-1", "--set", pair], 2, &[word]);
    }
}

/// A scenario whose first edit draws a machine of fewer drives than that of its file.
#[test]
fn a_machine_drawn_by_the_first_edit_is_the_one_that_runs() {
    let folder = Folder::new("drawn-first");
    let file = "machine = \"nine-link\"\n[task]\nkind = \"reactionless\"\nb = 2.4\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\n\
                time = 1.0\n[[edit]]\nstep = 0\ndo = \"sketch\"\ndraw = \"new\"\ntemplate = \"serial-of-two\"\n";
    fs::write(folder.0.join("drawn.toml"), file).expect("writable");
    let refused = folder.run(&["simulate", "drawn.toml"]);
    assert!(!refused.status.success());
    let lines = text(&refused.stderr).lines().filter_map(|line| line.split_once(": --set ")).map(|(_, rest)| rest);
    let ways: Vec<Vec<&str>> = lines.map(|rest| rest.split(" --set ").collect()).collect();
    assert!(!ways.is_empty(), "{}", text(&refused.stderr));
    for way in ways {
        for command in [&["simulate", "drawn.toml"][..], &["export", "drawn.toml", "--what", "simulated"]] {
            let typed: Vec<&str> = command.iter().copied().chain(way.iter().flat_map(|set| ["--set", set])).collect();
            let done = folder.run(&typed);
            assert!(done.status.success(), "{typed:?}: {}", text(&done.stderr));
            let head = text(&done.stdout).lines().next().expect("a head").to_owned();
            let third = ["torque/3", "q3", "q_3"].iter().any(|name| head.contains(name));
            assert!(head.contains(',') && !third, "{head}");
        }
    }
}
