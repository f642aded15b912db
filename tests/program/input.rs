//! What a person gives: what is taken, what is refused in which words, and what is told to have no use.

use super::*;

/// A machine where a scenario is wanted gets a task, and it is said so; a scenario where a machine is wanted is called
/// one; by file and by name.
#[test]
fn machines_and_scenarios_are_told_apart() {
    let folder = Folder::new("cli");
    let machine = word(folder.file("arm.toml", NINE_LINK));
    let case = include_str!("../../assets/scenarios/case-3.toml");
    let scenario = word(folder.file("task.toml", case));
    for name in [machine.as_str(), "nine-link"] {
        let output = stillbase(&["simulate", name, "--every", "1000"]);
        let said = text(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(said.contains(&format!("{name} is a machine, so a task was made for it: reactionless from")), "{said}");
        assert!(said.contains("reactionless: yes"), "{said}");
        let got = object(&["simulate", name, "--every", "1000", "--set", "task.time=1.5"]);
        let last = got["time"].as_array().and_then(|time| time.last()?.as_f64());
        assert!(got["scenario"] == json!("nine-link") && last == Some(1.5), "{last:?}");
    }
    // The scenario of that name comes first.
    let out = stillbase(&["simulate", "scara", "--every", "1000"]);
    assert!(out.status.success() && !text(&out.stderr).contains("was made for it"));
    // Where a machine is wanted, a scenario gives its own, and says so.
    for command in [&["check"][..], &["design"], &["reach", "0.5,0.5"], &["workspace", "--b", "2.4"]] {
        for name in [scenario.as_str(), "case-3"] {
            let of = |name: &str| stillbase(&[&command[..1], &[name], &command[1..]].concat());
            let (of_scenario, of_machine) = (of(name), of("nine-link"));
            assert_eq!(of_scenario.stdout, of_machine.stdout, "{command:?}");
            let said = text(&of_scenario.stderr);
            assert!(said.contains(&format!("{name}: it is a scenario, taken is its machine nine-link")), "{said}");
        }
    }
    // A file that names a scenario as its machine.
    let odd = word(folder.file("odd.toml", case.replace("machine = \"nine-link\"", "machine = \"task.toml\"")));
    fails(&["simulate", &odd], 2, &["task.toml", "this is a scenario, not a machine"]);
    // What is wrong within one is still said, also by the command that takes both.
    let broken = word(folder.file("broken.toml", NINE_LINK.replacen("mass = 1.45", "mass = -1.45", 1)));
    for args in [&["check", &broken][..], &["plan", &broken, "0.5,0.5", "0.55,0.9"], &["simulate", &broken]] {
        fails(args, 2, &["broken.toml:", "(link.2.mass) is -1.45"]);
    }
    fails(&["plan", "nine-link"], 2, &["a machine alone is no task"]);
    // What is neither is said to lack what a scenario has.
    let neither = word(folder.file("neither.toml", "name = \"x\"\n"));
    fails(&["simulate", &neither], 2, &["neither.toml", "neither.toml: this is no file of ours"]);
    fails(&["simulate", &neither.replace(".toml", "")], 2, &["no such scenario: want case-1"]);
}

/// A bound that the step decides is said as a number, and what is said to be right is taken.
#[test]
fn bounds_of_this_step_are_numbers() {
    let refused = |settings: &[&str], words: &[&str]| {
        let sets: Vec<&str> = settings.iter().flat_map(|pair| ["--set", pair]).collect();
        fails(&[&["simulate", "case-3", "--every", "1000"][..], &sets].concat(), 2, words);
    };
    let taken = |settings: &[&str]| {
        let sets: Vec<&str> = settings.iter().flat_map(|pair| ["--set", pair]).collect();
        prints(&[&["simulate", "case-3", "--every", "1000", "--set", "duration=0.01"][..], &sets].concat());
    };
    refused(&["control.kp=2e6"], &["control.kp) is 2000000: want 0 to 1000000 s⁻² at a step of 0.001 s"]);
    refused(&["control.kp=2e6", "step=0.005"], &["want 0 to 40000 s⁻² at a step of 0.005 s"]);
    refused(&["control.kd=400,2500,1"], &["control.kd) is 2500: want 0 to 2000 s⁻¹ at a step of 0.001 s"]);
    refused(&["control.kp=-1"], &["control.kp) is -1: want 0 to 1000000 s⁻²"]);
    refused(&["control.rate=300"], &["control.rate) is 300: want 0, or 250 or 333.333333 Hz", "at a step of 0.001 s"]);
    refused(&["control.rate=5000"], &["control.rate) is 5000: want 0, or at most 1000 Hz"]);
    refused(&["control.delay=0.0015"], &["control.delay) is 0.0015: want 0.001 or 0.002 s, whole steps of 0.001 s"]);
    refused(&["task.time=0.0001"], &["task.time) is 0.0001: want one step or more, 0.001 to 3600 s"]);
    refused(
        &["plant.payload.mass=1", "plant.payload.from=0.3", "plant.payload.until=0.2"],
        &["want more than", "0.3 s"],
    );
    // A step that is none bounds nothing.
    refused(&["step=1", "control.kp=400"], &["step is 1: want 0.00001 to 0.01 s"]);
    for pair in
        ["control.rate=333.333333", "control.rate=250", "control.rate=1000", "control.delay=0.002", "control.kd=2000"]
    {
        taken(&[pair]);
    }
}

/// A list of the wrong length says its length, and how long it should be.
#[test]
fn lists_say_how_long_they_are() {
    for key in ["plant.friction.coulomb", "plant.friction.viscous", "control.kp", "control.kd"] {
        let (two, one) = (format!("{key}=1,2"), format!("{key}=[1]"));
        let want = "want one for all drives, or 3, one for each";
        fails(&["simulate", "--set", &two], 2, &[&format!("{key}) has 2 numbers: {want}")]);
        fails(&["simulate", "--set", &one], 2, &[&format!("{key}) has 1 number: {want}")]);
    }
}

/// Places in a machine are called as one types them.
#[test]
fn keys_are_called_as_they_are_typed() {
    for (pair, words) in [
        ("link.5.com=1e9", "link.5.com) is 1e9"),
        ("drive.2.speed_limit=-1", "drive.2.speed_limit) is -1"),
        ("length.l1=0", "length.l1) is 0"),
        ("limits.a1=2,1", "(limits.a1, max) is 1: want a limit not below min"),
        ("payload.mass=-1", "payload.mass) is -1"),
    ] {
        fails(&["check", "nine-link", "--set", pair], 2, &[words]);
        fails(&["simulate", "case-3", "--set", pair], 2, &[words]);
    }
}

/// What is shown as a default can be typed.
#[test]
fn what_is_shown_as_a_default_is_taken() {
    let all = object(&["keys"]);
    let case = "case-3";
    for key in all["keys"].as_array().expect("keys") {
        let (path, default) = (key["key"].as_str().expect("a key"), key["default"].as_str());
        let Some("none") = default else { continue };
        assert!(key["instead"].as_str().is_some_and(|words| !words.is_empty()), "{path} says what counts then");
        let name = |part: &str| path.starts_with(part);
        let own = match path {
            _ if name("plant.length") => path.replace('*', "l1"),
            _ if name("plant.link") || name("link") || name("drive") => path.replace('*', "1"),
            _ if name("limits") => path.replace('*', "a1"),
            _ => path.to_owned(),
        };
        let pair = format!("{}=none", own.replace('*', "arm"));
        let case = if key["of"] == "assembly" { "four-freedoms" } else { case };
        prints(&["simulate", case, "--every", "1000", "--set", &pair]);
        if name("drive") || name("limits") || name("link") {
            prints(&["check", "nine-link", "--set", &pair]);
        }
    }
    // Where something stands by default, nothing is no value.
    fails(&["simulate", case, "--set", "control.kp=none"], 2, &["(control.kp) is \"none\""]);
    assert!(prints(&["keys", "tolerance.samples"]).contains("Without it: 100000, or 1000 that are simulated."));
    assert!(prints(&["keys", "wheel.inertia"]).contains("Without it: 0.02 if another key of the wheel is given"));
    assert!(prints(&["keys", "tolerance.link.*.mass"]).contains("Without it: normal:0.5%"));
}

/// What a part is called is said once.
#[test]
fn parts_are_named_once() {
    for (pair, words) in [
        ("tolerance.samples=0", "--set: how many machines (tolerance.samples) is 0: want a whole number from 1"),
        (
            "tolerance.moment_limit=-1",
            "--set: moment on the base that will do (tolerance.moment_limit) is -1: want a number",
        ),
        ("tolerance.link.5.com=normal:-1", "centre of mass along link 5 (tolerance.link.5.com) is "),
    ] {
        let out = stillbase(&["tolerance", "case-3", "--set", pair]);
        let said = text(&out.stderr).lines().next().expect("the reason, before ways out");
        assert_eq!(out.status.code(), Some(2), "{said}");
        assert!(said.contains(words) && said.matches("tolerance").count() == 1, "{said}");
    }
    fails(
        &["simulate", "--set", "task=default"],
        2,
        &["task: a task as a whole has no usual value", "task.time=default"],
    );
}

/// A name whose ending promises something else than what is written is refused, and nothing is written.
#[test]
fn endings_say_what_is_written() {
    let folder = Folder::new("cli");
    let motion = "t,x,y\n0,0.5,0.5\n1,0.5,0.5\n";
    let motion = word(folder.file("motion.csv", motion));
    for (args, endings) in [
        (&["simulate", "case-3"][..], ".csv"),
        (&["joints", "case-3"], ".csv"),
        (&["export", "case-3"], ".csv"),
        (&["spectrum", "case-3"], ".csv"),
        (&["compare", "case-3"], ".csv or .parquet or .rrd"),
        (&["headless", "case-3"], ".rrd"),
        (&["design", "nine-link"], ".toml"),
        (&["plan", "case-3"], ".toml"),
        (&["import", &motion], ".toml"),
        (&["tolerance", "case-3"], ".csv or .parquet"),
        (&["tolerance", "--merge", "a.csv"], ".csv or .parquet"),
    ] {
        for name in ["q.json", "q", "q.csv.gz"] {
            let file = word(folder.path(name));
            fails(&[args, &["-o", &file]].concat(), 2, &[name, "want a name that ends in", endings]);
        }
    }
    assert_eq!(folder.names(), ["motion.csv"]);
    prints(&["simulate", "case-3", "--every", "1000", "-o", &word(folder.path("Q.CSV"))]);
    assert_eq!(folder.names(), ["Q.CSV", "motion.csv"]);
}

/// What has not been asked rightly ends with 2, what cannot be done with 1.
#[test]
fn wrong_input_and_no_answer_are_told_apart() {
    let smooth = ["plan", "case-3", "--law", "fastest-smooth"];
    fails(&smooth, 2, &["no drive that moves has a limit on its jerk"]);
    let unlimited: Vec<String> = (1..=3).map(|k| format!("drive.{k}.torque_limit=none")).collect();
    let sets: Vec<&str> = unlimited.iter().flat_map(|pair| ["--set", pair]).collect();
    fails(&[&["simulate", "case-3", "--set", "task.law=fastest"][..], &sets].concat(), 2, &["no limit acts"]);
    // On the way drives 1 and 3 become parallel: there is no such motion that keeps off.
    let folder = Folder::new("cli");
    for (from, to, kind, shape) in
        [("0.56,0.65", "-0.46,0.19", "minimum-norm", "line"), ("0.43,0.84", "-0.21,0.60", "reactionless", "joint-line")]
    {
        let file = word(folder.path(&format!("{kind}.toml")));
        prints(&["plan", "nine-link", from, to, "--kind", kind, "--shape", shape, "-o", &file]);
        for command in ["joints", "simulate", "plan"] {
            let off = [command, &file, "--set", "task.keep_off_change_points=true"];
            fails(&off, 1, &["drives 1 and 3 become parallel", "keep_off_change_points = false"]);
        }
    }
}

/// Keys that are given without effect are refused after `--set` and told of a file, each with what it wants.
#[test]
fn what_has_no_effect_is_told() {
    for (args, words) in [
        (&["simulate", "case-3", "--set", "payload.offset=0.1,0"][..], ["payload.offset has no use", "payload.mass"]),
        (&["simulate", "case-3", "--set", "payload.axial=0.1"], ["payload.axial has no use", "payload.mass"]),
        (&["check", "nine-link", "--set", "payload.offset=0.1,0"], ["payload.offset has no use", "payload.mass"]),
        (&["simulate", "case-1", "--set", "task.corners=blend"], ["task.corners has no use", "three points"]),
        (
            &["simulate", "spot-turn", "--set", "task.to=0.1,0.2"],
            ["task.to has no use", "turn-base, which returns to A"],
        ),
        (&["plan", "case-3", "--blend", "0.05"], ["--blend has no use", "three points"]),
        (&["simulate", "case-3", "--set", "tolerance.seed=3"], ["tolerance.seed has no use", "command tolerance"]),
        (&["plan", "case-3", "--set", "tolerance.link.*.com=normal:0.1"], ["has no use", "command tolerance"]),
    ] {
        fails(args, 2, &words);
    }
    let every = ["--every", "1000"];
    for pairs in [
        ["payload.offset=0.1,0", "payload.mass=0.1"],
        ["payload.axial=0.1", "payload.mass=0.1"],
        ["payload.axial=0.1", "plant.force=1,0"],
        ["task.corners=blend", "task.via=[[0.55,0.7]]"],
        ["plant.payload.mass=0.1", "plant.payload.from=0.5"],
    ] {
        let out = stillbase(&[&["simulate", "case-3", "--set", pairs[0], "--set", pairs[1]][..], &every].concat());
        let said = text(&out.stderr);
        assert!(out.status.code() == Some(0) && !said.contains("no use"), "{pairs:?}: {said}");
        assert!(!said.contains("nothing is picked up"), "{said}");
    }
    let folder = Folder::new("cli");
    let case = include_str!("../../assets/scenarios/case-3.toml");
    let told = |extra: &str, words: &str| {
        let file = word(folder.file("own.toml", format!("{case}\n{extra}\n")));
        let out = stillbase(&[&["simulate", &file][..], &every].concat());
        let said = text(&out.stderr);
        assert!(out.status.code() == Some(0) && said.contains(words), "{extra}: {said}");
    };
    told("[tolerance]\nseed = 3", "note: case-3: tolerance has no use here: want the command tolerance");
    let late = "[plant.payload]\nmass = 0.1\nfrom = 2.0";
    told(late, "plant.payload.from is 2 s, and the run ends at 1.000 s: nothing is picked up");
    told(late, "reactionless: yes, payload never held");
    // A loop returns to A, wherever it begins: another B is told, the same is not.
    let turn = include_str!("../../assets/scenarios/spot-turn.toml");
    let said = |text: String, more: &[&str]| {
        let file = word(folder.file("turn.toml", text));
        let out = stillbase(&[&["plan", &file][..], more].concat());
        assert_eq!(out.status.code(), Some(0), "{}", self::text(&out.stderr));
        self::text(&out.stderr).contains("task.to has no use")
    };
    assert!(said(turn.replace("time = 10.0", "time = 10.0\nto = [0.1, 0.2]"), &[]));
    assert!(!said(turn.into(), &["--set", "task.start=1.5,2.2,3.2"]));
    // A plan that is written keeps its tolerances.
    let out = word(folder.path("new.toml"));
    prints(&["plan", "case-3", "--set", "tolerance.seed=3", "-o", &out]);
    assert!(fs::read_to_string(&out).expect("written").contains("seed = 3"));
}

/// What is refused says what would be right: how a part is made that does not exist yet, and which numbers count.
#[test]
fn what_is_refused_says_what_would_be_right() {
    let whole = "(task.cycles) is \"-2\": want a whole number, 1 to 100";
    for (args, words) in [
        (
            &["plan", "spot", "--set", "limits.elbow=0,1"][..],
            ["want one that exists", "angle = [{ name = \"elbow\", to = \"elbow\", from = \"shoulder\" }]"],
        ),
        (
            &["plan", "case-3", "--set", "material.bronze.density=3"],
            ["(material.bronze.density)", "material = [{ name = \"bronze\", density = 8800.0 }]"],
        ),
        (&["plan", "spot", "--set", "length.arm=1"], ["the length \"arm\"", "lengths = { arm = 0.5 }"]),
        (&["plan", "spot", "--set", "part.1.width=1"], ["width of part 1", "part = [{ link = \"1\", shape = "]),
        (&["simulate", "spot-turn", "--set", "task.cycles=-2"], [whole, "--set task.cycles=1"]),
        (&["plan", "spot-turn", "--set", "task.cycles=99999999999"], ["a whole number, 1 to 100", "task.cycles=100"]),
    ] {
        fails(args, 2, &words);
    }
    let folder = Folder::new("cli");
    let turn = include_str!("../../assets/scenarios/spot-turn.toml");
    let file =
        |cycles: &str| word(folder.file("turn.toml", turn.replace("[base]", &format!("cycles = {cycles}\n[base]"))));
    for cycles in ["-2", "1.5"] {
        let said = format!("(task.cycles) is the number {cycles}: want a whole number, 1 to 100");
        fails(&["plan", &file(cycles)], 2, &[&said]);
    }
    // What is said to be right is right.
    let spot = include_str!("../../assets/machines/spot.toml");
    let angle = "angle = [{ name = \"elbow\", to = \"elbow\", from = \"shoulder\" }]\n";
    let arm = word(folder.file("arm.toml", format!("{angle}{spot}")));
    prints(&["check", &arm, "--set", "limits.elbow=0,1"]);
}

/// Limits of drives that are passed in a run are told wherever a run is: in words, in tables and in JSON.
#[test]
fn drive_limits_that_are_passed_are_told() {
    let weak = ["--set", "drive.2.torque_limit=0.5"];
    let run = [&["simulate", "case-1", "--every", "1000"][..], &weak].concat();
    let said = text(&stillbase(&run).stderr).to_owned();
    assert!(said.contains("past a torque limit") && said.contains("the torque of drive 2 goes up to"), "{said}");
    let got = object(&run)["verdict"].clone();
    let factor = got["peak_torque"][1].as_f64().expect("a peak") / 0.5;
    assert!(factor > 1.4, "{got}");
    assert_eq!(got["over"][0], "torque of drive 2");
    assert!((got["over"][1].as_f64().expect("a factor") - factor).abs() < 1e-12, "{got}");
    // As the plan of the same.
    let plan = object(&[&["plan", "case-1"][..], &weak].concat());
    assert_eq!(plan["over"][0], got["over"][0]);
    assert!((plan["over"][1].as_f64().expect("a factor") / factor - 1.0).abs() < 1e-2, "{plan}");
    let slow = object(&["simulate", "case-1", "--every", "1000", "--set", "drive.1.speed_limit=0.1"]);
    assert_eq!(slow["verdict"]["over"][0], "speed of drive 1");
    let kept = object(&["simulate", "case-1", "--every", "1000"]);
    assert!(kept["verdict"]["over"].is_null() && kept["verdict"]["remarks"] == json!([]), "{}", kept["verdict"]);
    // Motors that give no more than they have pass nothing.
    let limited = [&run[..], &["--set", "plant.torque_limits=true"]].concat();
    assert!(object(&limited)["verdict"]["over"].is_null());
    // A fastest motion keeps its limits in the run too.
    let fastest = object(&["simulate", "case-3", "--every", "1000", "--set", "task.law=fastest"]);
    assert!(fastest["verdict"]["over"].is_null(), "{}", fastest["verdict"]);
    let folder = Folder::new("cli");
    let file = word(folder.path("case.rrd"));
    let record = [&["headless", "case-1", "--force", "-o", &file][..], &weak].concat();
    assert_eq!(object(&record)["recordings"][0]["over"][0], "torque of drive 2");
    assert!(prints(&record).contains("past a torque limit"));
}

/// One is not many.
#[test]
fn one_of_a_kind_is_in_the_singular() {
    let said = text(&stillbase(&["simulate", "case-3", "--set", "duration=0.001"]).stderr).to_owned();
    assert!(said.contains(": 1 step,"), "{said}");
    assert!(prints(&["joints", "case-3", "--set", "duration=0.001"]).contains(", 1 step;"));
    assert!(prints(&["tolerance", "case-3", "--samples", "1"]).contains(" 1 machine,"));
    fails(&["spectrum", "case-3", "--set", "duration=0"], 1, &["1 sample:"]);
}

/// A table for others names each column with its unit, and no number runs on.
#[test]
fn a_table_of_runs_is_short_of_digits() {
    let folder = Folder::new("cli");
    let file = word(folder.path("table.csv"));
    prints(&["compare", "case-3", "--set", "base.kind=free", "-o", &file]);
    let table = fs::read_to_string(&file).expect("written");
    let mut lines = table.lines();
    let head = lines.next().expect("a head");
    assert!(head.contains(",base_shift m,base_angle rad,base_angle_end rad,miss m,"), "{head}");
    // Older names are last.
    assert!(head.ends_with(",base_tilt rad,peak_arm_moment N m"), "{head}");
    for cell in lines.flat_map(|line| line.split(',')).filter(|cell| cell.parse::<f64>().is_ok()) {
        assert!(cell.len() <= 16, "{cell}");
        let x: f64 = cell.parse().expect("a number");
        assert!(x == 0.0 || x.abs() >= 1e-12, "{cell} is what rounding leaves");
    }
}
