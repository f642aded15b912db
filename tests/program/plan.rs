//! `plan`, `compare` and `import`.

use super::*;

/// A plan says what it takes, its scenario does just that, and the fastest straight line is the closed form.
#[test]
fn plan_says_what_its_scenario_then_does() {
    let folder = Folder::new("cli");
    let file = folder.0.join("plan.toml");
    let name = file.to_str().expect("UTF-8");
    let arguments = ["plan", "nine-link", "0.5,0.5", "0.6,0.7", "0.55,0.9", "--shape", "spline", "--b", "2.4"];
    let plan = object(&[&arguments[..], &["--time", "0.8", "-o", name]].concat());
    assert_eq!((&plan["feasible"], &plan["duration"]), (&json!(true), &json!(0.8)));
    let done = object(&["simulate", name]);
    assert_eq!(done["verdict"]["reactionless"], json!(true));
    near(&plan["peak_torque"], &done["verdict"]["peak_torque"], 5e-3, "peak torque");
    fails(&[&arguments[..], &["-o", name]].concat(), 2, &["exists"]);

    let straight = object(&["plan", "nine-link", "0.5,0.5", "0.55,0.9", "--b", "2.4", "--law", "fastest"]);
    let (start, end) = (numbers(&straight["q_start"]), numbers(&straight["q_end"]));
    let h = numbers(&object(&["check", "nine-link"])["h"]);
    let limits = [20.0, 5.0, 5.0];
    let pace = (0..3).map(|k| limits[k] / (h[k] * (end[k] - start[k]).abs())).fold(f64::INFINITY, f64::min);
    near(&straight["duration"], &json!(2.0 / pace.sqrt()), 1e-12, "2/√s̈");
    assert_eq!(straight["limiting"], json!("torque of drive 3"));

    // No b given: the middle of what serves all.
    let free = object(&["plan", "nine-link", "0.5,0.5", "0.55,0.9"]);
    let common = numbers(&free["b_common"]);
    near(&free["b"], &json!(0.5 * (common[0] + common[1])), 1e-12, "b");
}

#[test]
fn plan_refuses_with_where_why_and_what_would_do() {
    let arguments = ["plan", "nine-link", "0.42,1.12", "0,0.5", "--shape", "line", "--b", "2.4"];
    let said = ["the path stops at (0.418, 1.116) m", "a1 at its upper limit", "b = 2.5257 rad would do", "68.1"];
    fails(&arguments, 1, &said);
    let out = stillbase(&[&arguments[..], &["--json"]].concat());
    assert_eq!(out.status.code(), Some(1));
    let answer: Value = serde_json::from_slice(&out.stdout).expect("JSON");
    assert_eq!(answer["feasible"], json!(false));
    assert_eq!(answer["blocked"]["leaves_workspace"], json!(true));
    // What is said to do, does.
    let b = answer["blocked"]["nearest_b"].as_f64().expect("a b").to_string();
    let line = ["plan", "nine-link", "0.42,1.12", "0,0.5", "--shape", "line", "--b", &b];
    assert_eq!(object(&line)["feasible"], json!(true));
    fails(&["plan", "nine-link", "0.5,0.5", "-0.6,-0.2"], 1, &["no b serves both A and B", "moving B by 0.309 m"]);
    let apart = stillbase(&["plan", "nine-link", "0.5,0.5", "-0.6,-0.2", "--json"]);
    let apart: Value = serde_json::from_slice(&apart.stdout).expect("JSON");
    let b = apart["mend"]["b"].to_string();
    assert_eq!(
        object(&["plan", "nine-link", "0.5,0.5", &joined(&apart["mend"]["to"]), "--b", &b])["feasible"],
        json!(true)
    );
    fails(&["plan", "nine-link"], 2, &["want points"]);
    fails(&["plan", "nine-link", "0.5,0.5"], 2, &["at least two"]);
    fails(&["plan", "case-3", "--set", "task.shape=square"], 2, &["square", "spline"]);
    fails(&["plan", "case-3", "--set", "task.blend=-1"], 2, &["task.blend", "0 to 1"]);
    for (option, value, want) in [
        ("--b-to", "2.5", "change-b or least-reaction"),
        ("--moment-limit", "2", "change-b"),
        ("--base", "40,3", "change-b"),
        ("--cycles", "3", "zero-momentum"),
    ] {
        fails(&["plan", "case-3", option, value], 2, &[option, "no use here", want]);
    }
    fails(&["plan", "case-3", "--law", "fastest", "--time", "2"], 2, &["--time", "find the time"]);
    fails(&["plan", "circle", "--blend", "0.1"], 2, &["--blend", "no corners"]);
    fails(&["plan", "case-3", "--time", "-1"], 2, &["want a number above 0"]);
}

/// The spline goes beyond its samples: what is said of them is what they hold.
#[test]
fn import_tells_the_b_of_samples_from_that_of_the_spline() {
    let folder = Folder::new("cli");
    let lambda = numbers(&object(&["check", "nine-link"])["lambda"]);
    // A motion with few samples, from rest to rest.
    let q = |s: f64| [1.7 - 0.3 * s, 3.7 + 0.4 * s, 2.2 + 0.5 * s];
    let mut csv = String::from("t,q1,q2,q3\n");
    let mut all = Vec::new();
    for i in 0..9 {
        let t = f64::from(i) / 8.0;
        let s = if i < 4 {
            0.0
        } else if i > 4 {
            1.0
        } else {
            0.5
        };
        all.push((0..3).map(|k| lambda[k] * q(s)[k]).sum::<f64>());
        csv += &format!("{t},{},{},{}\n", q(s)[0], q(s)[1], q(s)[2]);
    }
    let file = word(folder.file("few.csv", &csv));
    let out = stillbase(&["import", &file, "--json"]);
    let got: Value = serde_json::from_str(text(&out.stdout)).expect("an object");
    let (low, high) = all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), b| (l.min(*b), h.max(*b)));
    near(&got["b_samples"], &json!([low, high]), 1e-12, "b of the samples");
    let way = numbers(&got["given"]["b_range"]);
    assert!(way[0] < low - 1e-4 && way[1] > high + 1e-4, "the spline swings: {way:?} {low} {high}");
    let shown = text(&stillbase(&["import", &file]).stdout).to_owned();
    assert!(shown.contains("least b of the samples") && shown.contains("least b on the way"), "{shown}");
}

/// A number that is none is refused where it stands.
#[test]
fn a_time_that_is_no_number_is_refused() {
    let folder = Folder::new("cli");
    let case = include_str!("../../assets/scenarios/case-3.toml").replace("time = 1.0", "time = nan");
    fails(&["simulate", &word(folder.file("odd.toml", &case))], 2, &["odd.toml:", "task.time is not a finite number"]);
}

/// The ways of a task as a table, as JSON, as CSV and as one row that cannot be.
#[test]
fn compare_tells_ways_apart() {
    let got = object(&["compare", "case-3"]);
    let runs = got["runs"].as_array().expect("runs");
    let ways: Vec<&str> = runs.iter().filter_map(|r| r["way"].as_str()).collect();
    assert_eq!(ways, ["reactionless", "straight-line", "other-pose", "wheel", "slowly"]);
    assert!((runs[1]["peak_moment"].as_f64().expect("a number") - 1.0891).abs() < 1e-4);
    assert!(runs[0]["reactionless"] == json!(true) && runs[0]["wheel_rate"].is_null());
    let folder = Folder::new("cli");
    let file = word(folder.path("table.csv"));
    assert!(
        prints(&["compare", "least-reaction", "-o", &file]).contains("reactionless: B (0.550, 0.900) m is outside")
    );
    let table = fs::read_to_string(&file).expect("written");
    assert_eq!(table.lines().count(), 7);
    assert!(table.lines().next().expect("a head").starts_with("scenario,time s,peak_moment N m,"));
    assert!(table.contains("is outside the reactionless workspace"), "{table}");
    fails(&["compare", "least-reaction", "-o", &file], 2, &["table.csv"]);
    fails(&["compare", "case-3", "-o", "table.txt"], 2, &[".csv or .rrd"]);
}

/// What a kind of task or base passes over is refused where it is asked for, and told where it stands in a file.
#[test]
fn what_a_kind_ignores_is_refused_or_told() {
    for (args, words) in [
        (vec!["plan", "change-b", "--shape", "arc"], ["--shape has no use here", "the kind reactionless"]),
        (vec!["plan", "case-3", "--cycles", "2"], ["--cycles has no use here", "the kind zero-momentum"]),
        (vec!["plan", "circle", "--time", "2"], ["--time has no use here", "another law"]),
        (vec!["plan", "case-3", "--base", "40,3"], ["--base has no use here", "change-b"]),
        (
            vec!["simulate", "change-b", "--set", "task.shape=arc"],
            ["task.shape has no use here", "the kind reactionless"],
        ),
        (
            vec!["simulate", "case-1", "--set", "task.b_to=2.5"],
            ["task.b_to has no use here", "change-b or least-reaction"],
        ),
        (vec!["simulate", "case-1", "--set", "task.first_drive_to=1"], ["task.first_drive_to has no use", "same-tip"]),
        (vec!["simulate", "case-1", "--set", "task.blend=0.1"], ["task.blend has no use here", "corners = blend"]),
        (vec!["simulate", "circle", "--set", "task.least=peak"], ["task.least has no use here", "least-reaction"]),
        (vec!["simulate", "circle", "--set", "task.time=3"], ["task.time has no use here", "another law"]),
        (vec!["simulate", "case-1", "--set", "base.mass=50"], ["base.mass has no use here", "free or compliant"]),
        (vec!["simulate", "spacecraft", "--set", "base.stiffness=[1,1,1]"], ["base.stiffness has no use", "compliant"]),
    ] {
        fails(&args, 2, &words);
    }
    prints(&["simulate", "case-1", "--set", "base.mass=50", "--set", "base.kind=free", "--every", "1000"]);
    let folder = Folder::new("cli");
    let case = include_str!("../../assets/scenarios/case-3.toml");
    let file = word(folder.file("own.toml", case.replace("time = 1.0", "cycles = 3\ntime = 1.0")));
    let out = stillbase(&["simulate", &file, "--every", "1000"]);
    let said = text(&out.stderr);
    assert!(out.status.code() == Some(0) && said.contains("note: case-3: task.cycles has no use there"), "{said}");
    assert!(!text(&stillbase(&["simulate", "case-3", "--every", "1000"]).stderr).contains("note"));
}

/// What would never end, or fill the disk, is refused with the number, at once.
#[test]
fn what_would_never_end_is_refused() {
    let folder = Folder::new("cli");
    let began = std::time::Instant::now();
    let out = word(folder.path("x.csv"));
    fails(
        &["simulate", "circle", "--set", "task.b=-2.3e18", "-o", &out],
        2,
        &["task.b is -2.3e18", "-1000 to 1000 rad"],
    );
    fails(&["simulate", "change-b", "--set", "task.moment_limit=1e-9", "-o", &out], 1, &["at most 3600 s"]);
    fails(
        &["simulate", "change-b", "--set", "task.moment_limit=1e-308", "-o", &out],
        2,
        &["task.moment_limit is 1e-308"],
    );
    fails(&["simulate", "circle", "--set", "drive.1.speed_limit=1e-9", "-o", &out], 1, &["at most 3600 s"]);
    fails(&["simulate", "case-3", "--set", "drive.1.torque_limit=1e-300"], 2, &["torque_limit is 1e-300", "1e-9 to"]);
    let case = include_str!("../../assets/scenarios/case-3.toml");
    let long = word(folder.file("long.toml", case.replace("[task]", "duration = 3600\n[task]")));
    fails(&["simulate", &long, "-o", &out], 2, &["GB: want at most 4 GB"]);
    fails(&["simulate", &long, "--json", "--every", "4"], 2, &["GB: want at most 1 GB"]);
    let fine = word(folder.file("fine.toml", case.replace("[task]", "duration = 3600\nstep = 1e-5\n[task]")));
    fails(&["compare", &fine], 1, &["360000000 steps: want at most 4000000"]);
    for command in ["simulate", "joints", "spectrum"] {
        fails(&[command, &fine], 2, &["360000000 steps: want at most 4000000"]);
    }
    fails(&["export", &fine, "--what", "simulated", "--rate", "100"], 2, &["360000000 steps: want at most 4000000"]);
    assert_eq!(folder.names(), ["fine.toml", "long.toml"]);
    assert!(began.elapsed().as_secs() < 60, "{:?}", began.elapsed());
}
