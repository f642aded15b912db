//! `plan`, `compare` and `import`.

use std::f64::consts::FRAC_PI_2;

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
    fails(&["simulate", &word(folder.file("odd.toml", &case))], 2, &["odd.toml:", "task.time) is not a finite number"]);
}

/// The ways of a task as a table, as JSON, as CSV and as one row that cannot be.
#[test]
fn compare_tells_ways_apart() {
    let got = object(&["compare", "case-3"]);
    let runs = got["runs"].as_array().expect("runs");
    let ways: Vec<&str> = runs.iter().filter_map(|r| r["way"].as_str()).collect();
    assert_eq!(ways, ["reactionless", "straight-line", "other-pose", "wheel", "slowly"]);
    assert!((runs[1]["peak_felt_moment"].as_f64().expect("a number") - 1.0891).abs() < 1e-4);
    assert!(runs[0]["reactionless"] == json!(true) && runs[0]["wheel_rate"].is_null());
    let folder = Folder::new("cli");
    let file = word(folder.path("table.csv"));
    assert!(
        prints(&["compare", "least-reaction", "-o", &file]).contains("reactionless: B (0.550, 0.900) m is outside")
    );
    let table = fs::read_to_string(&file).expect("written");
    assert_eq!(table.lines().count(), 7);
    assert!(
        table
            .lines()
            .next()
            .expect("a head")
            .starts_with("scenario,reactionless,refused,duration s,peak_felt_moment N m,")
    );
    assert!(table.contains("is outside the reactionless workspace"), "{table}");
    fails(&["compare", "least-reaction", "-o", &file], 2, &["table.csv"]);
    fails(&["compare", "case-3", "-o", "table.txt"], 2, &[".csv or .parquet or .rrd"]);
}

/// Machines side by side: what balance costs and brings, and nothing where that makes no sense.
#[test]
fn compare_sets_machines_side_by_side() {
    let got = object(&["compare", "nine-link-bare", "case-1", "two-drive"]);
    let design = |i: usize| &got["runs"][i]["design"];
    let number = |i: usize, key: &str| design(i)[key].as_f64();
    assert_eq!((number(0, "added_mass"), number(0, "beta_force")), (Some(0.0), None));
    assert!(number(0, "force_left").is_some_and(|left| left > 1.0));
    assert!(number(1, "force_left").is_some_and(|left| left < 1e-9), "case 1 is of the balanced machine");
    let mass = number(1, "mass").zip(number(0, "mass")).map(|(own, first)| own - first);
    assert!(mass.zip(number(1, "added_mass")).is_some_and(|(a, b)| (a - b).abs() < 1e-12));
    assert!(number(1, "beta_force").is_some_and(|beta| beta < 1e-9), "no force is left");
    assert!(number(1, "beta_torque").is_some_and(|beta| beta > 0.0));
    assert!(number(2, "mass").is_some() && number(2, "added_mass").is_none());
    assert!(design(2)["apart"].as_str().is_some_and(|why| why.contains("2 drives")));
    let table = prints(&["compare", "nine-link-bare", "case-1", "two-drive"]);
    assert!(table.contains("machine of") && table.contains("β moment") && table.contains("two-drive: it has 2 drives"));
    // One machine needs no table of its own.
    assert!(!prints(&["compare", "case-1", "case-3"]).contains("machine of"));
}

/// Machines on one task: each in a row of its own name, refused ones too, and never a scenario without a machine.
#[test]
fn compare_puts_machines_on_one_task() {
    let folder = Folder::new("cli");
    let file = word(folder.path("after.toml"));
    prints(&["design", "nine-link-bare", "-o", &file]);
    let got = object(&["compare", "nine-link-bare", &file, "two-drive", "--task", "case-3"]);
    let runs = got["runs"].as_array().expect("runs");
    let names: Vec<&str> = runs.iter().filter_map(|run| run["scenario"].as_str()).collect();
    assert_eq!(names, ["nine-link-bare", "after", "two-drive"]);
    assert_eq!((&runs[0]["duration"], &runs[1]["duration"]), (&json!(1.0), &json!(1.0)));
    assert!(runs[2]["refused"].as_str().is_some_and(|why| why.contains("the arms reach only")));
    // One machine beside that of the scenario; files of one name are told apart by theirs.
    let table = prints(&["compare", &file, "--task", "case-3"]);
    assert!(table.contains("\nnine-link ") && table.contains("\nafter "), "{table}");
    let other = word(folder.file("twin.toml", fs::read_to_string(&file).expect("written")));
    let table = prints(&["compare", &file, &other, "--task", "case-3"]);
    assert!(table.contains("\nafter ") && table.contains("\ntwin "), "{table}");
    let heavy = ["--set", "link.9.mass=0.5"];
    let got = object(&[&["compare", "nine-link-bare", &file, "--task", "case-3"], &heavy[..]].concat());
    let mass = |name: &str| object(&[&["check", name], &heavy[..]].concat())["mass"].as_f64();
    let masses = [0, 1].map(|i| got["runs"][i]["design"]["mass"].as_f64());
    assert_eq!(masses, ["nine-link-bare", &file].map(mass), "settings of machines hold for each");
    // Rows say which file they are of.
    let names = |args: &[&str]| -> Vec<String> {
        let got = object(&[&["compare"], args].concat());
        let runs = got["runs"].as_array().expect("runs").iter();
        runs.map(|run| run["scenario"].as_str().expect("a name").to_owned()).collect()
    };
    assert_eq!(names(&["nine-link", "--task", "case-3"]), ["case-3", "nine-link"]);
    assert_eq!(names(&[&file, &other]), ["after", "twin"]);
    let alike = ["a", "b"].map(|inner| {
        fs::create_dir_all(folder.path(inner)).expect("made");
        word(folder.file(&format!("{inner}/arm.toml"), NINE_LINK))
    });
    let told = names(&[&alike[0], &alike[1], "--task", "case-3"]);
    assert!(told[0].ends_with("a/arm") && told[1].ends_with("b/arm"), "{told:?}");
    assert_eq!(names(&["case-3", "case-3"]), ["case-3", "case-3-2"]);
    // Samples of drive angles name no place to go to, so nothing is missed.
    let swing = object(&["compare", "spot-swing", "spot"]);
    assert!(swing["runs"][0]["miss"].is_null() && swing["runs"][1]["miss"].is_number(), "{swing}");
    assert!(object(&["simulate", "spot-swing", "--every", "100000"])["verdict"]["miss"].is_null());
    fails(&["compare", "--task", "case-3"], 2, &["MACHINE"]);
    fails(&["compare", "case-4", "--task", "case-3"], 2, &["case-4"]);
    fails(&["compare", "nine-link", "--task", "case-9"], 2, &["case-9"]);
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
        &["task.b) is -2.3e18", "-1000 to 1000 rad"],
    );
    fails(&["simulate", "change-b", "--set", "task.moment_limit=1e-9", "-o", &out], 1, &["at most 3600 s"]);
    fails(
        &["simulate", "change-b", "--set", "task.moment_limit=1e-308", "-o", &out],
        2,
        &["task.moment_limit) is 1e-308"],
    );
    fails(&["simulate", "circle", "--set", "drive.1.speed_limit=1e-9", "-o", &out], 1, &["at most 3600 s"]);
    fails(&["simulate", "case-3", "--set", "drive.1.torque_limit=1e-300"], 2, &["torque_limit) is 1e-300", "1e-9 to"]);
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

/// A quintic from rest to rest.
fn eased(s: f64) -> f64 {
    s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
}

/// Rows of forty spaces over a second.
fn table(head: &str, row: impl Fn(f64) -> Vec<f64>) -> String {
    let mut text = format!("{head}\n");
    for i in 0..=40 {
        let s = f64::from(i) / 40.0;
        let numbers: Vec<String> = [vec![s], row(eased(s))].concat().iter().map(|x| format!("{x:.9}")).collect();
        text += &(numbers.join(",") + "\n");
    }
    text
}

/// Two drives and four: what keeps the end effector's motion does, what cannot is turned as a whole, and what has no
/// answer says so.
#[test]
fn import_proposes_for_any_number_of_drives() {
    let folder = Folder::new("cli");
    let files = [
        ("tip4.csv", table("t,x,y", |u| vec![0.60 - 0.25 * u, 0.50 + 0.35 * u])),
        ("q4.csv", table("t,q1,q2,q3,q4", |u| vec![1.7 - 0.2 * u, 3.9 + 0.3 * u, 2.6 + 0.4 * u, 2.7 - 0.3 * u])),
        ("q2.csv", table("t,q1,q2", |u| vec![0.5 + 0.3 * u, 1.6 + 0.4 * u])),
        ("tip2.csv", table("t,x,y", |u| vec![0.45 + 0.15 * u, 0.30 - 0.1 * u])),
    ];
    let [tip4, q4, q2, tip2] = files.map(|(name, text)| word(folder.file(name, &text)));
    for (file, machine, way) in [
        (&tip4, "four-drive", "on-plane"),
        (&q4, "four-drive", "same-tip"),
        (&q2, "two-drive", "turned"),
        (&q2, "counter-rotating", "as-given"),
        (&tip2, "counter-rotating", "as-given"),
    ] {
        let quiet = folder.0.join(format!("{machine}-{way}.toml"));
        let quiet = quiet.to_str().expect("UTF-8");
        let got = object(&["import", file, "--machine", machine, "-o", quiet, "--force"]);
        let proposal = &got["proposal"];
        assert_eq!((&got["feasible"], &proposal["way"]), (&json!(true), &json!(way)), "{machine}");
        assert_eq!(proposal["reactionless"], json!(true), "{machine}");
        let moved = proposal["tip_deviation"].as_f64().expect("a distance");
        assert_eq!(moved < 1e-7, way != "turned", "{machine}, {way}: {moved}");
        assert!(machine == "counter-rotating" || got["given"]["peak_base_moment"].as_f64().expect("a moment") > 0.1);
        // What is written does what was said, and the other is what was given.
        let done = object(&["simulate", quiet]);
        assert_eq!(done["verdict"]["reactionless"], json!(true), "{machine}, {way}");
        let given = object(&["simulate", &quiet.replace(".toml", "-given.toml")]);
        assert_eq!(given["verdict"]["reactionless"], json!(machine == "counter-rotating"), "{machine}, {way}");
    }
    for (args, said) in [
        (
            &["import", &tip2, "--machine", "two-drive"][..],
            "b goes from 1.861 to 2.321 rad: want a path along such a curve",
        ),
        (
            &["import", &q2, "--machine", "two-drive", "--keep", "tip"],
            "2 drives held to a b move the end effector along one curve",
        ),
    ] {
        let out = stillbase(args);
        assert!(out.status.code() == Some(1) && text(&out.stderr).contains(said), "{}", text(&out.stderr));
    }
    let bare = stillbase(&["import", &q2, "--machine", "scara", "--json"]);
    let said = text(&bare.stderr);
    assert!(
        bare.status.code() == Some(1)
            && said.contains("no pose constant b")
            && said.contains("design finds centres of mass")
    );
    let bare: Value = serde_json::from_slice(&bare.stdout).expect("an object");
    assert!(bare["given"]["peak_base_moment"].as_f64().expect("a moment") > 1e-3, "what it does to the base: {bare}");
    assert!(bare["reason"].as_str().expect("a reason").contains("no pose constant b"));
    let out = stillbase(&["import", &tip2, "--machine", "two-drive", "--json"]);
    let got: Value = serde_json::from_str(text(&out.stdout)).expect("an object");
    assert!(got["feasible"] == json!(false) && got["given"]["peak_base_moment"].as_f64().expect("a moment") > 0.1);
    // A path of the end effector that lies along the curve of a b.
    let curve = object(&["workspace", "two-drive", "--b", "1.2"]);
    let curve: Vec<Vec<f64>> = curve["curve"].as_array().expect("a curve").iter().map(numbers).collect();
    let along = table("t,x,y", |u| {
        let place = (0.3 + 0.3 * u) * (curve.len() - 1) as f64;
        let (i, part) = (place as usize, place.fract());
        (0..2).map(|j| curve[i][j] + part * (curve[i + 1][j] - curve[i][j])).collect()
    });
    let along = word(folder.file("along.csv", &along));
    let got = object(&["import", &along, "--machine", "two-drive", "--smooth", "8"]);
    assert!(got["proposal"]["tip_deviation"].as_f64().expect("a distance") < 1e-3);
    near(&got["proposal"]["b"], &json!(1.2), 1e-3, "b");
}

/// Kinds of tasks of two drives and of four, as the command has them.
#[test]
fn plan_has_every_kind_for_other_numbers_of_drives() {
    let line = ["four-drive", "0.6,0.5", "0.35,0.85", "--b", "2.9", "--kind"];
    let kinds = ["reactionless", "minimum-norm", "least-reaction", "zero-momentum", "change-b"];
    for kind in kinds {
        let got = object(&[&["plan"], &line[..], &[kind]].concat());
        assert_eq!(got["feasible"], json!(true), "{kind}");
        assert_eq!(got["peak_base_moment"].as_f64().expect("a moment") < 1e-5, kind != "minimum-norm", "{kind}");
    }
    let price =
        object(&["plan", "four-drive", "0.6,0.5", "-0.55,-0.25", "--kind", "change-b", "--b", "2.9", "--base", "40,3"]);
    let (delta, peak) = (price["price"]["delta_b"].as_f64().expect("Δb"), &price["peak_base_moment"]);
    assert!(delta.abs() > 0.1 && price["price"]["base_turn"].as_f64().expect("a turn") != 0.0);
    near(
        &json!(price["price"]["least_peak"].as_f64().expect("a moment") * 10.0 / 3f64.sqrt() / 4.0),
        peak,
        1e-3,
        "n_B",
    );
    fails(
        &["plan", "scara", "0.6,0.1", "0.2,0.55", "--kind", "zero-momentum"],
        1,
        &["along one curve, and B lies 0.413 m beside it: want it at (0.278797726, 0.144864307) m"],
    );
    fails(&["plan", "two-drive", "0.5,0.2", "0.6,0.1", "--kind", "least-reaction"], 2, &["no b to choose"]);
}

/// What cannot hold a b is planned all the same, with what it does to the base.
#[test]
fn plan_has_what_unbalanced_machines_can_do() {
    let folder = Folder::new("cli");
    let file = word(folder.file("bare.toml", include_str!("../../assets/machines/nine-link-bare.toml")));
    let points = ["0.5,0.5", "0.55,0.9"];
    // The scenario of that name, and the machine alone.
    let named = object(&[&["plan", "nine-link-bare"], &points[..]].concat());
    assert_eq!(named["feasible"], json!(true));
    let bare = [&["plan", &file], &points[..]].concat();
    let got = object(&bare);
    assert!(got["feasible"] == json!(true) && got["peak_base_moment"].as_f64().expect("a moment") > 1e-3);
    let said = stillbase(&bare);
    let said = text(&said.stderr).to_owned();
    assert!(said.contains("no pose constant b") && said.contains("planned as minimum-norm"), "{said}");
    for (kind, felt) in [("minimum-norm", true), ("zero-momentum", false)] {
        let got = object(&[&bare[..], &["--kind", kind]].concat());
        let peak = got["peak_base_moment"].as_f64().expect("a moment");
        assert_eq!(peak > 1e-5, felt, "{kind}: {peak}");
    }
    for kind in ["reactionless", "change-b"] {
        fails(&[&bare[..], &["--kind", kind]].concat(), 1, &["no pose constant b"]);
    }
}

/// `check`, `reach` and `plan` say the same of whether there is a b.
#[test]
fn whether_there_is_a_b_is_said_in_the_same_words() {
    for (name, word) in
        [("nine-link", "exact"), ("nine-link-bare", "none"), ("scara", "none"), ("counter-rotating", "unneeded")]
    {
        assert_eq!(object(&["check", name])["pose_constant"], json!(word), "{name}");
        let checked = prints(&["check", name]);
        let reached = stillbase(&["reach", name, "0.4,0.3"]);
        match word {
            "none" => {
                let why = text(&reached.stderr).lines().next().expect("a reason");
                let why = why.trim_start_matches("stillbase: ").to_owned();
                assert!(reached.status.code() == Some(1) && checked.contains(&why), "{name}: {why}\n{checked}");
            }
            "exact" => assert!(reached.status.success() && !text(&reached.stderr).contains("note"), "{name}"),
            _ => {}
        }
    }
    let nearly = ["nine-link", "--set", "link.5.com=-0.012"];
    assert_eq!(object(&[&["check"], &nearly[..]].concat())["pose_constant"], json!("nearly"));
    let said = stillbase(&["reach", "nine-link", "0.5,0.5", "--set", "link.5.com=-0.012"]);
    let note = text(&said.stderr).lines().next().expect("a note").split_once(": b = ").expect("its b").1.to_owned();
    assert!(prints(&[&["check"], &nearly[..]].concat()).contains(&note), "{note}");
}

/// Three drives without limits: no angle, no limit.
#[test]
fn three_drives_without_angles_are_planned() {
    let folder = Folder::new("cli");
    let bare = NINE_LINK.split("[[angle]]").next().expect("a head");
    let file = word(folder.file("free.toml", bare));
    let points = ["0.5,0.5", "0.55,0.9"];
    for extra in [&["--b", "2.4"][..], &["--b", "2.4", "--shape", "line"], &["--kind", "minimum-norm"]] {
        let got = object(&[&["plan", &file], &points[..], extra].concat());
        assert_eq!(got["feasible"], json!(true), "{extra:?}");
        let is_held = !extra.contains(&"minimum-norm");
        assert_eq!(got["peak_base_moment"].as_f64().expect("a moment") < 1e-8, is_held, "{extra:?}");
    }
    let free = object(&["reach", &file, points[0]]);
    assert!(!free["points"][0]["intervals"].as_array().expect("a list").is_empty());
}

/// A b that is typed is never replaced.
#[test]
fn change_b_begins_where_it_is_told() {
    for (name, a, b) in [("nine-link", "0.5,0.5", "-0.6,-0.2"), ("four-drive", "0.6,0.5", "-0.55,-0.25")] {
        let base = ["plan", name, a, b, "--kind", "change-b"];
        let out = stillbase(&[&base[..], &["--b", "0.1"]].concat());
        let said = text(&out.stderr).to_owned();
        assert!(out.status.code() == Some(1) && said.contains("b = 0.100000 rad: want b"), "{name}: {said}");
        let typed = said.split("want b from ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a b").to_owned();
        let got = object(&[&base[..], &["--b", &typed]].concat());
        near(&got["b"], &json!(typed.parse::<f64>().expect("a number")), 1e-9, name);
    }
}

/// A posture counts with the shape that is typed beside it.
#[test]
fn a_posture_counts_with_what_is_typed_beside_it() {
    let folder = Folder::new("cli");
    let file = word(folder.file("four.toml", include_str!("../../assets/machines/four-drive.toml")));
    let line = ["plan", &file, "0.6,0.5", "0.55,0.55", "--b", "2.9", "--set", "task.posture=mid-range"];
    assert_eq!(object(&[&line[..], &["--shape", "line"]].concat())["feasible"], json!(true));
    fails(&line, 2, &["task.posture has no use here", "the shape line"]);
}

/// The ways of a task that a machine has, as many as it has.
#[test]
fn compare_has_the_ways_of_any_number_of_drives() {
    for (name, ways) in [("four-drive", 5), ("two-drive", 4), ("scara", 4)] {
        let got = object(&["compare", name]);
        let runs = got["runs"].as_array().expect("runs");
        assert_eq!(runs.len(), ways, "{name}");
        let refused: Vec<&Value> =
            runs.iter().filter(|run| run.get("refused").is_some()).map(|run| &run["way"]).collect();
        // An arm that nobody has balanced has no reactionless way.
        let want = if name == "scara" { vec![json!("reactionless")] } else { Vec::new() };
        assert_eq!(refused, want.iter().collect::<Vec<_>>(), "{name}");
        let peak =
            |way: &str| runs.iter().find(|run| run["way"] == way).and_then(|run| run["peak_felt_moment"].as_f64());
        assert!(peak("straight-line").expect("it runs") > 0.1, "{name}");
        assert!(name == "scara" || peak("reactionless").expect("it runs") < 1e-6, "{name}");
        assert!(name != "four-drive" || peak("other-pose").expect("it runs") > 0.1);
    }
}

/// A motion of one's own on a base that floats: the quarter turn of the shoulder turns it by −34.921°, whatever the time law.
#[test]
fn a_motion_of_ones_own_turns_a_base_that_floats() {
    let folder = folder("import-afloat");
    let row = |i: u32| {
        let s = f64::from(i) / 60.0;
        let turn = FRAC_PI_2 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        let q = FRAC_PI_2 + turn;
        format!("{},{q},{q},{q}\n", 8.0 * s)
    };
    let rows: String = (0..=60).map(row).collect();
    std::fs::write(folder.join("swing.csv"), format!("t,q1,q2,q3\n{rows}")).expect("a file");
    let import = ["import", "swing.csv", "--machine", "spot", "--json"];
    let held = stillbase_in(&folder, &import);
    assert!(text(&held.stderr).contains("--base spot"), "{}", text(&held.stderr));
    let read = |out: &std::process::Output| -> Value { serde_json::from_slice(&out.stdout).expect("an object") };
    let held = read(&held);
    assert!(held["given"]["base_turn"].is_null(), "{held}");
    let afloat = read(&stillbase_in(&folder, &[&import[..], &["--base", "spot"]].concat()));
    let turn = afloat["given"]["base_turn"].as_f64().expect("a number");
    assert!((turn + 34.921_f64.to_radians()).abs() < 1e-5, "{turn}");
    let moment = |of: &Value| of["given"]["peak_base_moment"].as_f64().expect("a number");
    assert!(moment(&afloat) < 0.7 * moment(&held), "{} {}", moment(&afloat), moment(&held));
    let heavy = [&import[..], &["--base", "spot", "--set", "base.inertia=20"]].concat();
    let heavy = read(&stillbase_in(&folder, &heavy))["given"]["base_turn"].as_f64().expect("a number");
    assert!(heavy < 0.0 && heavy > 0.1 * turn, "{heavy}");
}
