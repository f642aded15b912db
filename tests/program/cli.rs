//! The command line as scripts see it: JSON keys, known numbers, exit statuses, files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::{Value, json};

use crate::folder::Folder;

fn stillbase_in(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .expect("the program starts")
}

fn stillbase(args: &[&str]) -> Output {
    stillbase_in(Path::new(env!("CARGO_TARGET_TMPDIR")), args)
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// What a command that succeeds prints.
fn prints(args: &[&str]) -> String {
    let out = stillbase(args);
    assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
    text(&out.stdout).to_owned()
}

/// The one object that a command prints.
fn object(args: &[&str]) -> Value {
    let printed = prints(&[args, &["--json"]].concat());
    let value: Value = serde_json::from_str(&printed).unwrap_or_else(|e| panic!("{args:?}: {e}"));
    assert!(value.is_object(), "{args:?}: {printed}");
    value
}

/// A command that fails says why in one line and prints no result.
fn fails(args: &[&str], status: i32, words: &[&str]) {
    let out = stillbase(args);
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(status), "{args:?}: {said}");
    assert!(said.starts_with("stillbase: ") && said.trim_end().lines().count() == 1, "{args:?}: {said}");
    for word in words {
        assert!(said.contains(word), "{args:?}: {said:?} lacks {word:?}");
    }
    assert!(out.stdout.is_empty(), "{args:?}: {}", text(&out.stdout));
}

/// The keys of an object, in alphabetical order.
fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(all) => all.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().expect("a number")],
    }
}

/// Every number within `tolerance` of the largest wanted one.
fn near(got: &Value, want: &Value, tolerance: f64, what: &str) {
    let (got, want) = (numbers(got), numbers(want));
    assert_eq!(got.len(), want.len(), "{what}");
    let scale = want.iter().fold(1e-3, |m: f64, x| m.max(x.abs()));
    for (g, w) in got.iter().zip(&want) {
        assert!((g - w).abs() <= tolerance * scale, "{what}: {g} for {w}");
    }
}

fn planning() -> Value {
    serde_json::from_str(include_str!("../reference/planning.json")).expect("reference")
}

/// `x,y` with every digit.
fn joined(values: &Value) -> String {
    numbers(values).iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// A file as a word of a command line.
fn word(file: std::path::PathBuf) -> String {
    file.display().to_string()
}

const NINE_LINK: &str = include_str!("../../assets/machines/nine-link.toml");

#[test]
fn machines_are_listed() {
    let all = object(&["machines"]);
    assert_eq!(keys(&all), ["machines"]);
    let first = &all["machines"][0];
    assert_eq!(keys(first), ["drives", "links", "name", "summary"]);
    assert_eq!(first["name"], "nine-link");
    assert_eq!((&first["drives"], &first["links"]), (&json!(3), &json!(9)));
    let names: Vec<&str> =
        all["machines"].as_array().expect("list").iter().filter_map(|m| m["name"].as_str()).collect();
    let table = prints(&["machines"]);
    assert!(names.contains(&"nine-link-table-1") && names.iter().all(|n| table.contains(n)));
}

#[test]
fn check_reports_table_1_as_printed_and_re_solved() {
    let (printed, want) = (object(&["check", "nine-link-table-1"]), &planning()["table_1"]);
    assert_eq!(
        keys(&printed),
        [
            "coupling_coefficients",
            "force_balanced",
            "gamma_coefficients",
            "h",
            "integrable",
            "invariant",
            "lambda",
            "mass"
        ]
    );
    for (key, reference) in [
        ("gamma_coefficients", "gamma_coefficients"),
        ("coupling_coefficients", "coupling_coefficients"),
        ("h", "h"),
        ("lambda", "lambda_"),
    ] {
        near(&printed[key], &want[reference], 1e-8, key);
    }
    assert_eq!((&printed["force_balanced"], &printed["invariant"]), (&json!(false), &json!(false)));
    let solved = object(&["check", "nine-link"]);
    assert_eq!((&solved["force_balanced"], &solved["invariant"]), (&json!(true), &json!(true)));
    near(&solved["mass"], &json!(16.05), 1e-14, "mass");
}

#[test]
fn design_gives_the_known_centres_of_mass() {
    let known = planning()["design"].clone();
    for (preset, i) in [("as-printed", 0), ("table-1", 1), ("minimum-norm", 2)] {
        let by_name = object(&["design", "nine-link-table-1", "--preset", preset]);
        assert_eq!(keys(&by_name), ["com", "coupling_coefficients", "gamma_coefficients", "h", "lambda"]);
        near(&by_name["com"], &known[i]["com"], 5e-9, preset);
        let penalty = joined(&known[i]["penalty"]);
        near(&object(&["design", "nine-link-table-1", "--penalty", &penalty])["com"], &known[i]["com"], 5e-9, preset);
    }
    let usual = object(&["design", "nine-link-table-1"]);
    near(&usual["h"], &known[1]["h"], 5e-9, "H");
    near(&usual["lambda"], &known[1]["lambda_"], 5e-9, "λ");
}

#[test]
fn a_designed_machine_can_be_checked_and_is_not_overwritten() {
    let folder = Folder::new("cli");
    let file = word(folder.path("still.toml"));
    prints(&["design", "nine-link-table-1", "--set", "link.9.mass=0.4", "-o", &file]);
    let (made, check) = (fs::read_to_string(&file).expect("file"), object(&["check", &file]));
    assert_eq!((&check["force_balanced"], &check["invariant"]), (&json!(true), &json!(true)));
    assert!(made.contains("name = \"still\""), "a machine of its own name: {made}");
    fails(&["design", "nine-link", "-o", &file], 2, &[&file, "--force"]);
    assert_eq!(fs::read_to_string(&file).expect("file"), made);
    prints(&["design", "nine-link", "-o", &file, "--force"]);
    assert_ne!(fs::read_to_string(&file).expect("file"), made);
    assert_eq!(folder.names(), ["still.toml"]);
}

#[test]
fn dynamics_agrees_with_independent_software() {
    let folder = Folder::new("cli");
    let reference: Value = serde_json::from_str(include_str!("../reference/dynamics.json")).expect("reference");
    for case in reference["cases"].as_array().expect("cases") {
        let mut settings = vec![format!("gravity={}", joined(&case["gravity"]))];
        for (key, field) in [("mass", "mass"), ("inertia", "inertia"), ("com", "com")] {
            settings.extend((0..9).map(|j| format!("link.{}.{key}={}", j + 1, case[field][j])));
        }
        settings.extend([1, 2, 3, 5, 9].map(|i| format!("length.l{i}={}", case["length"][i - 1])));
        settings.push(format!("payload.mass={}", case["payload"]));
        let samples = case["samples"].as_array().expect("samples");
        let state = |s: &Value| json!({"q": s["q"], "qd": s["qd"], "qdd": s["qdd"]});
        let states = word(folder.file("states.json", Value::from_iter(samples.iter().map(state)).to_string()));
        let mut args = vec!["dynamics", "nine-link-table-1", "--states", &states];
        args.extend(settings.iter().flat_map(|s| ["--set", s.as_str()]));
        let results = object(&args)["results"].clone();
        assert_eq!(results.as_array().map(Vec::len), Some(samples.len()));
        for (i, want) in samples.iter().enumerate() {
            for key in ["mass_matrix", "torque", "base_force", "base_moment", "com", "angular_momentum_about_base"] {
                near(&results[i][key], &want[key], 1e-9, &format!("{}: {key}", case["name"]));
            }
        }
    }
}

#[test]
fn states_that_do_not_fit_are_named_by_line() {
    let folder = Folder::new("cli");
    let refused = |content: &str, words: &[&str]| {
        let file = word(folder.file("states.json", content));
        fails(&["dynamics", "nine-link", "--states", &file], 2, words);
    };
    refused(
        "[\n{\"q\": [0, 1, 2], \"qd\": [0, 0, 0], \"qdd\": [0, 0, 0]},\n{\"q\": [0, 1], \"qd\": [0], \"qdd\": [0]}]",
        &["states.json:3", "state 2: q has 2 numbers", "want 3"],
    );
    refused("[\n{\"q\": [0, 1, 2],\n \"qd\": [0, 0, 0]}]", &["states.json:3", "missing field `qdd`", "want"]);
    refused("[{\"q\": [0, 1, NaN]}]", &["states.json:1"]);
    refused("{}", &["states.json:1", "want [{"]);
    refused("[{\"q\": [0, 1, 2], \"qd\": [1e200, 0, 0], \"qdd\": [0, 0, 0]}]", &["not a finite number"]);
    fails(&["dynamics", "nine-link", "--states", &word(folder.path("none.json"))], 2, &["none.json"]);
}

#[test]
fn reach_finds_the_known_intervals() {
    for known in planning()["reach"].as_array().expect("list") {
        let point = joined(&known["point"]);
        let got = object(&["reach", known["machine"].as_str().expect("name"), &point]);
        assert_eq!(keys(&got), ["overlap", "period", "points"]);
        assert_eq!(keys(&got["points"][0]), ["intervals", "point"]);
        near(&got["points"][0]["point"], &known["point"], 0.0, "point");
        near(&got["points"][0]["intervals"], &known["intervals"], 1e-9, &point);
        near(&got["overlap"], &known["intervals"], 1e-9, "overlap of one");
        near(&got["period"], &known["period"], 1e-9, "period");
    }
    let both = object(&["reach", "nine-link", "0.5,0.5", "0.55,0.9"]);
    near(&both["overlap"], &json!([[2.2157496581863496, 2.6610727211193312]]), 1e-9, "overlap");
}

#[test]
fn points_that_share_no_b_have_no_answer_but_a_mend() {
    let out = stillbase(&["reach", "nine-link", "0.5,0.5", "-0.5,-0.5", "--json"]);
    assert_eq!(out.status.code(), Some(1));
    let got: Value = serde_json::from_slice(&out.stdout).expect("JSON");
    assert_eq!(got["overlap"], json!([]));
    assert!(text(&out.stderr).contains("no reactionless path"), "{}", text(&out.stderr));
    // The exact move mends it.
    let mended = |mend: &Value| {
        let to = joined(&mend["to"]);
        let points = if mend["point"] == json!(1) { [&to, "-0.5,-0.5"] } else { ["0.5,0.5", &to] };
        object(&["reach", "nine-link", points[0], points[1]])
    };
    assert_ne!(mended(&got["mend"])["overlap"], json!([]));
    fails(&["reach", "nine-link", "0.5,0.5", "9,9"], 1, &["(9.000, 9.000) m"]);
}

#[test]
fn coordinates_and_b_may_be_negative() {
    // Half a turn of all drives takes p to −p and adds half a period to b.
    let here = object(&["reach", "nine-link", "0.5,0.5"]);
    let there = object(&["reach", "nine-link", "-0.5,-0.5"]);
    let half = here["period"].as_f64().expect("period") / 2.0;
    let shifted: Vec<f64> = numbers(&here["points"][0]["intervals"]).iter().map(|b| b + half).collect();
    near(&there["points"][0]["intervals"], &json!(shifted), 1e-9, "half a turn");
    let pose = |b: &str| object(&["pose", "nine-link", "--b", b, "-.5,-.5"]);
    let (up, down) = (pose(&(2.4 + half).to_string()), pose(&(2.4 - half).to_string()));
    near(&up["poses"][0]["a"], &down["poses"][0]["a"], 1e-9, "the same pose a turn apart");
    fails(&["pose", "nine-link", "-5,-5", "--b", "-2.4"], 1, &["(-5.000, -5.000) m"]);
    fails(&["reach", "nine-link", "-0.5;0.5"], 2, &["'-0.5;0.5'", "want X,Y in m"]);
}

#[test]
fn pose_gives_unwrapped_angles_on_the_plane_as_asked() {
    for known in planning()["plane_ik"].as_array().expect("list") {
        let (machine, b) = (known["machine"].as_str().expect("name"), known["b"].as_f64().expect("b"));
        let point = joined(&known["point"]);
        let got = object(&["pose", machine, &point, "--b", &b.to_string()]);
        let all = ["a", "det", "manipulability", "q", "side", "transmission", "worst_torque_per_force"];
        assert_eq!(keys(&got["poses"][0]), all);
        for pose in got["poses"].as_array().expect("poses") {
            let number = |key: &str| pose[key].as_f64().expect("a number");
            let (a, q) = (numbers(&pose["a"]), numbers(&pose["q"]));
            let sines = [q[1] - q[0], q[2] - q[1], q[2] - q[0]].map(f64::sin);
            near(&json!(sines.map(f64::signum)), &pose["side"], 0.0, "side");
            let least = sines.iter().fold(1.0, |m: f64, s| m.min(s.abs()));
            assert!((number("transmission") - least).abs() < 1e-12 && a.iter().all(|a| a.is_finite()));
            // J of the nine-link machine, arms 0.5, −0.46 and −0.3 m.
            let arms = [0.5, -0.46, -0.3];
            let crossed = |k: usize, l: usize| arms[k] * arms[l] * (q[l] - q[k]).sin();
            let rank: f64 = [crossed(0, 1), crossed(1, 2), crossed(0, 2)].iter().map(|x| x * x).sum();
            assert!((number("manipulability") - rank.sqrt()).abs() < 1e-12);
            let worst = number("worst_torque_per_force");
            let least = number("manipulability") / worst;
            let lengths: f64 = arms.iter().map(|c| c * c).sum();
            assert!((worst * worst + least * least - lengths).abs() < 1e-12 && worst >= least);
            assert!(number("det") > 0.0);
        }
        let row = |p: &Value| [numbers(&p["q"]), numbers(&p["a"])].concat();
        let mut rows: Vec<Vec<f64>> = got["poses"].as_array().expect("poses").iter().map(row).collect();
        rows.sort_by(|x, y| x[0].total_cmp(&y[0]));
        let wanted = known["solutions_q1_q2_q3_a1_a2"].as_array().expect("solutions").iter();
        let mut wanted: Vec<Vec<f64>> = wanted.map(|s| numbers(s)[..5].to_vec()).collect();
        wanted.sort_by(|x, y| x[0].total_cmp(&y[0]));
        near(&json!(rows), &json!(wanted), 1e-9, &point);
    }
    let lambda = numbers(&object(&["check", "nine-link"])["lambda"]);
    let period = object(&["reach", "nine-link", "0.5,0.5"])["period"].as_f64().expect("period");
    let b = 2.4 + 3.0 * period;
    let far = object(&["pose", "nine-link", "0.5,0.5", "--b", &b.to_string()]);
    let held: f64 = lambda.iter().zip(numbers(&far["poses"][0]["q"])).map(|(l, q)| l * q).sum();
    assert!((held - b).abs() < 1e-12, "{held} for {b}");
}

#[test]
fn numbers_that_mean_nothing_are_refused() {
    fails(&["reach", "nine-link", "1e300,0"], 2, &["want X,Y in m"]);
    fails(&["pose", "nine-link", "0.5,nan", "--b", "2.4"], 2, &["want X,Y in m"]);
    for b in ["inf", "1e300", "two", "-"] {
        fails(&["workspace", "nine-link", "--b", b], 2, &["--b"]);
    }
    fails(&["simulate", "--every", "0"], 2, &["whole number of steps"]);
    fails(&["check", "nine-link", "--set", "length.l1=1e300"], 2, &["lengths.l1 is 1e300: want 1e-6 to 1000000 m"]);
}

#[test]
fn a_point_outside_the_plane_is_told_which_b_would_do() {
    fails(&["pose", "nine-link", "0.5,0.5", "--b", "5"], 1, &["b = 5.000000 rad", "want b from 1.6496 to 2.9012 rad"]);
}

#[test]
fn workspace_is_measured() {
    let (got, known) = (object(&["workspace", "nine-link-table-1", "--b", "2.4"]), &planning()["workspace"][0]);
    assert_eq!(
        keys(&got),
        [
            "area",
            "areas_by_poses",
            "areas_by_side",
            "change_point_curves",
            "cusps",
            "fold_curves",
            "inner_limits",
            "interior_singularity",
            "loops",
            "sheet_area",
            "sheets",
            "x_max",
            "x_min",
            "y_max",
            "y_min"
        ]
    );
    near(&got["area"], &known["sheet_area"], 1e-9, "area");
    for key in ["sheet_area", "x_min", "x_max", "y_min", "y_max"] {
        near(&got[key], &known[key], 1e-8, key);
    }
    assert_eq!(got["interior_singularity"], json!(false));
    // The outer loop runs counter-clockwise around that area, less what its chords cut off.
    let ring: Vec<Vec<f64>> = got["loops"][0].as_array().expect("loop").iter().map(numbers).collect();
    let twice: f64 =
        (0..ring.len()).map(|i| (&ring[i], &ring[(i + 1) % ring.len()])).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum();
    near(&json!(twice / 2.0), &known["sheet_area"], 1e-4, "area of the polygon");
}

#[test]
fn workspace_tells_what_lies_inside() {
    let got = object(&["workspace", "nine-link", "--b", "2.4"]);
    assert_eq!((&got["sheets"], &got["fold_curves"], &got["cusps"]), (&json!(1), &json!([]), &json!([])));
    near(&got["areas_by_poses"], &json!([got["area"]]), 1e-12, "one pose everywhere");
    // q_3 = q_1 divides it.
    let parts = got["areas_by_side"].as_array().expect("parts");
    assert_eq!(parts.len(), 2);
    assert!(parts.iter().all(|p| p["pair"] == json!([1, 3])));
    near(&json!([parts[0]["area"], parts[1]["area"]]), &json!([0.467, 0.378]), 2e-3, "areas by side");
    assert_eq!(got["change_point_curves"].as_array().expect("curves").len(), 1);
    let line = &got["change_point_curves"][0]["line"];
    assert!(line.as_array().expect("a line").len() > 50 && numbers(line).iter().all(|x| x.abs() < 1.3));
    let table = prints(&["workspace", "nine-link", "--b", "2.4"]);
    for part in ["q_3 − q_1 from −π to 0", "inside: one pose a point, one curve of change points"] {
        assert!(table.contains(part), "{part} in {table}");
    }

    let turn = "6.283185307179586";
    let wide = [&format!("limits.a1=0,{turn}"), &format!("limits.a2=0,{turn}")];
    let got = object(&["workspace", "nine-link", "--b", "2.4", "--set", wide[0], "--set", wide[1]]);
    assert_eq!(got["sheets"], json!(6));
    let sum: f64 = numbers(&got["areas_by_poses"]).iter().sum();
    near(&json!(sum), &got["sheet_area"], 1e-9, "areas by poses");
    assert_eq!(
        (got["fold_curves"].as_array().map(Vec::len), got["cusps"].as_array().map(Vec::len)),
        (Some(3), Some(2))
    );
}

#[test]
fn workspace_answers_about_points() {
    let base = ["workspace", "nine-link", "--b", "2.4", "--set", "limits.a1=-1,4", "--set", "limits.a2=-2,5"];
    let asked = ["--at", "0.5,0.5", "--at", "-0.5,-0.9", "--at", "-3,0"];
    let got = object(&[&base[..], &asked].concat());
    let points = got["points"].as_array().expect("points");
    assert_eq!(points.len(), 3);
    for (p, text) in points.iter().zip(["0.5,0.5", "-0.5,-0.9"]) {
        assert_eq!(keys(p), ["distance", "point", "poses"]);
        assert_eq!(joined(&p["point"]), text);
        let out = stillbase(&["pose", "nine-link", text, "--b", "2.4", "--set", base[5], "--set", base[7], "--json"]);
        let poses: Value = serde_json::from_slice(&out.stdout).unwrap_or(json!({ "poses": [] }));
        assert_eq!(p["poses"], poses["poses"]);
        assert_eq!(p["distance"].as_f64().expect("a distance") > 0.0, poses["poses"] != json!([]));
    }
    assert_eq!(points[2]["poses"], json!([]));
    assert!(points[2]["distance"].as_f64().expect("a distance") < -1.5);
    let table = prints(&[&base[..], &asked].concat());
    assert!(table.contains("from boundary m") && table.contains("no pose") && table.contains("0.5, 0.5"), "{table}");
    fails(&["workspace", "nine-link", "--b", "2.4", "--at", "here"], 2, &["want X,Y in m"]);
    // Limits that leave a line or a point.
    for limits in ["limits.a1=0,0", "limits.a1=1,1"] {
        let got = object(&["workspace", "nine-link", "--b", "2.4", "--set", limits, "--at", "0.1,0.1"]);
        assert_eq!((&got["area"], &got["sheets"]), (&json!(0.0), &json!(1)));
    }
}

#[test]
fn simulate_prints_every_signal() {
    let got = object(&["simulate", "case-3", "--every", "7"]);
    assert_eq!(keys(&got), ["scenario", "signals", "time", "units", "verdict"]);
    let peaks = ["peak_base_force", "peak_base_moment", "peak_torque"];
    let sums = ["rms_base_force", "rms_base_moment", "steps"];
    let all: Vec<&str> = ["audit", "base_shift", "base_tilt", "miss", "moved"]
        .into_iter()
        .chain(peaks[..2].iter().copied())
        .chain(["peak_tilt", peaks[2], "reactionless", "remarks"])
        .chain(sums.into_iter().take(2))
        .chain(["sentence", "steps"])
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

/// What every pin carries: as the signals of the same run have it.
#[test]
fn joints_tells_peaks_of_every_pin() {
    let run = ["--set", "gravity=0,-9.81", "--set", "link.5.axial=0.02"];
    let got = object(&[&["joints", "case-1"][..], &run].concat());
    assert_eq!(keys(&got), ["pins", "scenario", "steps", "tilt", "transmission", "worst"]);
    let signals = object(&[&["simulate", "case-1"][..], &run].concat());
    let time = numbers(&signals["time"]);
    let pins = got["pins"].as_array().expect("pins");
    assert_eq!(pins.len(), 12);
    assert_eq!(keys(&pins[0]), ["from", "mean", "name", "peak", "time", "to", "undefined_steps"]);
    let mut worst = 0.0_f64;
    for pin in pins {
        let forces = numbers(&signals["signals"][format!("pin/{}", pin["name"].as_str().expect("a name"))]);
        let (at, peak) = forces.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).expect("steps");
        near(&pin["peak"], &json!(peak), 1e-14, "peak");
        near(&pin["time"], &json!(time[at]), 1e-14, "time");
        near(&pin["mean"], &json!(forces.iter().sum::<f64>() / forces.len() as f64), 1e-12, "mean");
        worst = worst.max(*peak);
    }
    let named = pins.iter().find(|p| p["name"] == got["worst"]).expect("the worst");
    near(&named["peak"], &json!(worst), 1e-14, "worst");
    let tilt = numbers(&signals["signals"]["tilt/x"]).into_iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    near(&got["tilt"]["x"]["value"], &json!(tilt), 1e-14, "tilt");
    assert!(got["tilt"]["flat"] == json!(false) && tilt > 0.1);
    // Weight does not tilt what lies at no height.
    let flat = object(&["joints", "case-1", "--set", "gravity=0,-9.81"]);
    assert!(flat["tilt"]["flat"] == json!(true) && flat["tilt"]["x"]["value"] == json!(0.0));
    assert!(prints(&["joints", "case-1"]).contains("all axial offsets are zero"));
    assert!(prints(&[&["joints", "case-1"][..], &run].concat()).contains("about x"));
}

/// Through q_3 = q_1 the least transmission is zero, even if no step lands on it, and that is said.
#[test]
fn joints_tells_that_a_change_point_is_passed() {
    let through = ["joints", "case-3", "--set", "task.to=[0.3,0.3]"];
    let got = object(&through);
    let pair = &got["transmission"][1];
    assert_eq!((&pair["drives"], &pair["closures"]), (&json!(["1", "3"]), &json!(["6-7"])));
    assert_eq!((&pair["least"], &pair["passed"]), (&json!(0.0), &json!(1)));
    assert!(got["pins"].as_array().expect("pins").iter().any(|p| p["peak"].as_f64().expect("a force") > 100.0));
    assert!(prints(&through).contains("1 change point passed between steps"));
    assert_eq!(object(&["joints", "case-3"])["transmission"][1]["passed"], 0);
}

#[test]
fn joints_writes_forces_as_csv_and_says_why_there_are_none() {
    let folder = Folder::new("cli");
    let file = word(folder.path("pins.csv"));
    prints(&["joints", "case-3", "-o", &file]);
    let mut reader = csv::Reader::from_path(&file).expect("a file");
    assert_eq!(reader.headers().expect("a head").len(), 1 + 24 + 2);
    let rows: Vec<Vec<f64>> = reader.deserialize().collect::<Result<_, _>>().expect("numbers");
    assert_eq!(rows.len(), 1001);
    // Nothing reaches the base: its three bearings cancel, though each carries newtons.
    for row in &rows {
        assert!((row[1] + row[3] + row[5]).hypot(row[2] + row[4] + row[6]) < 1e-9);
    }
    assert!(rows.iter().any(|r| r[1].hypot(r[2]) > 1.0));
    fails(&["joints", "case-3", "-o", &file], 2, &["pins.csv exists", "--force"]);
    let open = NINE_LINK.replacen(
        "[[closure]]\na = { link = \"6\", at = \"tip\" }\nb = { link = \"7\", at = \"tip\" }\n",
        "",
        1,
    );
    assert!(open.len() < NINE_LINK.len());
    let machine = word(folder.file("open.toml", &open));
    let scenario =
        fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenarios/case-3.toml")).expect("it");
    let scenario = word(folder.file("open-case.toml", scenario.replace("\"nine-link\"", &format!("{machine:?}"))));
    fails(&["joints", &scenario], 1, &["nothing holds 6", "want 3 closures"]);
    fails(&["joints", "case-9"], 2, &["case-9"]);
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
    let full = || fs::OpenOptions::new().write(true).open("/dev/full");
    if let Ok(full) = full() {
        let out = Command::new(env!("CARGO_BIN_EXE_stillbase")).arg("machines").stdout(full).output().expect("starts");
        let said = text(&out.stderr);
        assert!(out.status.code() == Some(2) && said.starts_with("stillbase: standard output"), "{said}");
        fails(&["simulate", "-o", "/dev/full", "--force"], 2, &["/dev/full is no plain file"]);
    }
    // No file may grow beyond four kilobytes here, and to try is an error and not the end.
    let folder = Folder::new("cli");
    let limited = "trap '' XFSZ; ulimit -f 8; exec \"$0\" simulate -o x.csv";
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

#[test]
fn settings_change_the_machine_before_anything_is_planned() {
    let checked = |set: &[&str]| object(&[&["check", "nine-link"], set].concat());
    near(&checked(&["--set", "payload.mass=0.4"])["mass"], &json!(16.45), 1e-14, "mass");
    let moved = checked(&["--set", "link.5.com=-0.02", "--set", "link.9.mass=0.3"]);
    assert_eq!((&moved["force_balanced"], &moved["invariant"]), (&json!(false), &json!(false)));
    // Two settings that are wrong alone are right together: they are checked once, at the end.
    checked(&["--set", "limits.a1=4,5", "--set", "limits.a1=0.4,2.7"]);
    let run = |set: &[&str]| object(&[&["simulate", "case-3", "--every", "1000"], set].concat());
    // Control knows the payload, so the torques change; and the machine is balanced no longer.
    let loaded = run(&["--set", "payload.mass=0.1"]);
    assert_eq!(loaded["verdict"]["reactionless"], false);
    assert!(loaded["verdict"]["peak_base_force"].as_f64() > Some(0.1), "{}", loaded["verdict"]);
    let narrow = ["simulate", "case-3", "--set", "limits.a1=0.4,2.7"];
    fails(&narrow, 1, &["case-3", "B (0.550, 0.900) m"]);
}

#[test]
fn wrong_settings_say_what_would_be_right() {
    let refused = |set: &str, words: &[&str]| fails(&["check", "nine-link", "--set", set], 2, words);
    refused("link.5.mass=NaN", &["link[5].mass is not a number", "want a finite number, kg"]);
    refused("link.5.mass=-1", &["link[5].mass is -1", "want 1e-15 to 1000000 kg"]);
    refused("link.5.mass=much", &["link.5.mass=\"much\"", "want one number"]);
    refused("link.5.length=0.7", &["l5", "link 8", "parallelogram", "length.l5"]);
    refused("link.99.mass=1", &["\"99\"", "want one of \"1\""]);
    refused("link.5.colour=1", &["link.5.colour", "want one of"]);
    refused("gravity=9.81", &["want two numbers"]);
    refused("limits.a1=2,1", &["max", "not below min"]);
    refused("mass", &["want KEY=VALUE"]);
    fails(&["check", "no-such-machine"], 2, &["no-such-machine", "nine-link-table-1", "TOML"]);
    fails(&["check", "no-such-file.toml"], 2, &["no-such-file.toml"]);
}

/// Damages to the nine-link machine's file, and what is said of each.
#[test]
fn a_damaged_machine_file_is_named_with_its_line() {
    let folder = Folder::new("cli");
    let check = |text: &str, words: &[&str]| {
        fails(&["check", &word(folder.file("arm.toml", text))], 2, words);
    };
    let damage = |from: &str, to: &str, words: &[&str]| {
        let at = NINE_LINK.find(from).unwrap_or_else(|| panic!("{from}"));
        let line = format!("arm.toml:{}:", NINE_LINK[..at].matches('\n').count() + 1);
        check(&NINE_LINK.replacen(from, to, 1), &[&[line.as_str()], words].concat());
    };
    damage("mass = 1.45", "mass = nan", &["link[2].mass is not a number"]);
    damage("mass = 1.45", "mass = -1.45", &["link[2].mass is -1.45", "1e-15 to 1000000 kg"]);
    damage("mass = 1.45", "weight = 1.45", &["unknown field `weight`"]);
    damage("mass = 1.45", "mass = ", &[]);
    damage(
        "[[closure]]\na = { link = \"4\"",
        "[[closure]]\na = { link = \"6\"",
        &["closure[1]", "parallelogram that closes"],
    );
    damage("attach = { link = \"3\"", "attach = { link = \"6\"", &["link[6].attach", "hangs on itself"]);
    damage(
        "drive = \"3\"\nattach = \"base\"",
        "drive = \"4\"\nattach = \"base\"",
        &["drive \"4\"", "\"1\", \"2\", \"3\""],
    );
    let end = NINE_LINK.find("[end_effector]").expect("end effector");
    let angles = NINE_LINK.find("# Relative joint angles").expect("angles");
    check(&[&NINE_LINK[..end], &NINE_LINK[angles..]].concat(), &["arm.toml: no end effector", "want [end_effector]"]);
    check(&NINE_LINK.replacen("com = 0.20158885517910255\n", "", 1), &["arm.toml:", "missing field `com`"]);
    check("\u{0}", &["arm.toml:1:"]);
}

#[cfg(feature = "record")]
#[test]
fn headless_reports_the_three_cases() {
    let folder = Folder::new("cli");
    let file = word(folder.path("cases.rrd"));
    let got = object(&["headless", "-o", &file])["recordings"].clone();
    let rows = got.as_array().expect("list");
    let names: Vec<&str> = rows.iter().filter_map(|r| r["scenario"].as_str()).collect();
    assert_eq!(names, ["case-1", "case-2", "case-3"]);
    for row in rows {
        assert_eq!(
            keys(row),
            [
                "file",
                "peak_base_force",
                "peak_base_moment",
                "peak_torque",
                "reactionless",
                "scenario",
                "steps",
                "verdict"
            ]
        );
        assert_eq!((&row["file"], &row["steps"]), (&json!(file), &json!(1000)));
        assert_eq!(row["reactionless"], json!(row["scenario"] == "case-3"));
    }
    let known = planning()["motion"]["nine-link"].clone();
    near(&rows[0]["peak_base_moment"], &known["case_1_peak_base_moment"], 1e-5, "case 1");
    near(&rows[1]["peak_base_moment"], &json!(0.4853), 1e-4, "case 2");
    near(&rows[2]["peak_torque"], &known["case_3_peak_torque"], 1e-5, "case 3");
    near(&rows[2]["peak_base_moment"], &json!(0.0), 1e-9, "case 3");
}

#[cfg(feature = "record")]
#[test]
fn headless_refuses_wrong_input_before_it_runs() {
    let folder = Folder::new("cli");
    let taken = word(folder.file("taken.rrd", "mine"));
    let free = word(folder.path("free.rrd"));
    fails(&["headless", "-o", &taken], 2, &["taken.rrd", "exists", "--force"]);
    assert_eq!(fs::read_to_string(&taken).expect("file"), "mine");
    fails(&["headless", "/nonexistent.toml", "-o", &free], 2, &["/nonexistent.toml"]);
    fails(&["headless", "case-1", "case-1", "-o", &free], 2, &["case-1", "different names"]);
    fails(&["headless", "-o", &free, "--fps", "0"], 2, &["--fps", "above 0"]);
    fails(&["headless", "-o", &free, "--fps", "30", "--size", "0x800"], 2, &["--size", "16 to 8192"]);
    fails(&["headless", "-o", &word(folder.path("none/x.rrd"))], 2, &["no folder"]);
    fails(&["headless", "case-3", "-o", &free, "--set", "limits.a1=0,0.1"], 1, &["case-3", "A (0.500, 0.500) m"]);
    fails(&["headless"], 2, &["--output <FILE.rrd>"]);
    assert_eq!(folder.names(), ["taken.rrd"]);
}

#[test]
fn a_scenario_file_is_named_with_its_line() {
    let folder = Folder::new("cli");
    let case = include_str!("../../assets/scenarios/case-3.toml");
    let refused = |text: &str, words: &[&str]| fails(&["simulate", &word(folder.file("my.toml", text))], 2, words);
    refused(&case.replace("time = 1.0", "tiem = 1.0"), &["my.toml:12:", "unknown field `tiem`"]);
    refused(&case.replace("time = 1.0", "time = -1.0"), &["my.toml", "task.time is -1"]);
    refused(&case.replace("nine-link", "ten-link"), &["ten-link", "no such machine"]);
    fails(&["simulate", "case-9"], 2, &["case-9", "case-1, case-2, case-3"]);
    fails(&["chek"], 2, &["chek", "--help"]);
}

/// Two drives have no plane of (a1, a2): the questions about planes have no answer, the others do.
#[test]
fn a_machine_of_two_drives_is_checked_but_has_no_planes() {
    let folder = Folder::new("cli");
    let file = word(folder.file("two.toml", TWO_LINK));
    let balance = object(&["check", &file]);
    assert_eq!(balance["coupling_coefficients"].as_array().map(Vec::len), Some(1));
    let designed = object(&["design", &file]);
    assert_eq!(numbers(&designed["com"]).len(), 2);
    fails(&["design", &file, "--preset", "table-1"], 2, &["9 penalties for 2 links"]);
    fails(&["design", &file, "--penalty", "1,-1"], 2, &["'-1'", "1e-6 to 1e6"]);
    fails(&["reach", &file, "0.5,0.5"], 1, &["2 drives", "want three"]);
    fails(&["pose", &file, "0.5,0.5", "--b", "1"], 1, &["2 drives"]);
    fails(&["workspace", &file, "--b", "1"], 1, &["2 drives"]);
}

const TWO_LINK: &str = r#"
name = "two"
[[drive]]
name = "shoulder"
[[drive]]
name = "elbow"
[[link]]
name = "upper"
drive = "shoulder"
attach = "base"
length = 0.4
mass = 2.0
inertia = 0.03
com = 0.2
[[link]]
name = "forearm"
drive = "elbow"
attach = { link = "upper", at = "tip" }
length = 0.3
mass = 1.0
inertia = 0.01
com = 0.15
[end_effector]
link = "forearm"
at = "tip"
"#;

/// Without a display the window gives way to a recording, which replaces nothing.
#[cfg(all(target_os = "linux", feature = "record", feature = "window"))]
#[test]
fn without_a_display_it_records_and_names_the_file() {
    let folder = Folder::new("cli");
    let taken = word(folder.file("case-3.rrd", "mine"));
    let out = Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .current_dir(&folder.0)
        .stdin(Stdio::null())
        .output()
        .expect("starts");
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{said}");
    assert!(said.contains("case-3-1.rrd") && said.contains("display"), "{said}");
    assert_eq!(fs::read_to_string(&taken).expect("file"), "mine");
}

/// With a display but nothing that draws on it, the same, and what is missing is said. Wants Xvfb.
#[cfg(all(target_os = "linux", feature = "record", feature = "window"))]
#[test]
fn without_a_graphics_driver_it_records_and_says_what_is_missing() {
    let Ok(mut display) = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "800x600x24"])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
    else {
        println!("skipped: no Xvfb");
        return;
    };
    let mut number = String::new();
    let out = display.stdout.take().expect("piped");
    std::io::BufRead::read_line(&mut std::io::BufReader::new(out), &mut number).expect("its number");
    let folder = Folder::new("cli");
    let out = Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .env("DISPLAY", format!(":{}", number.trim()))
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("VK_DRIVER_FILES", "/nonexistent")
        .current_dir(&folder.0)
        .stdin(Stdio::null())
        .output();
    let _ = display.kill();
    let _ = display.wait();
    let out = out.expect("starts");
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{said}");
    assert!(said.contains("case-3.rrd"), "{said}");
    assert!(said.contains("graphics driver") || said.contains("libvulkan") || said.contains("window needs"), "{said}");
    assert!(folder.0.join("case-3.rrd").exists());
}

#[test]
fn help_names_every_command_with_units_and_examples() {
    let all = prints(&["--help"]);
    let known = <crate::commands::Subcommand as clap::Subcommand>::augment_subcommands(clap::Command::new("stillbase"));
    let names: Vec<&str> = known.get_subcommands().map(clap::Command::get_name).collect();
    assert!(names.len() > 14, "{names:?}");
    for command in names {
        assert!(all.contains(&format!("\n  {command} ")), "{command}");
        let help = prints(&[command, "--help"]);
        assert!(command == "figures" || help.contains("--set <KEY=VALUE>") && help.contains("--json"), "{command}");
        assert!(command == "machines" || help.contains("Example"), "{command}");
    }
    assert!(prints(&["--version"]).starts_with("stillbase "));
}

#[test]
fn tables_show_units_and_the_same_numbers() {
    let table = prints(&["reach", "nine-link", "0.5,0.5"]);
    assert!(table.contains("b_min rad") && table.contains("0.5, 0.5"), "{table}");
    let check = prints(&["check", "nine-link-table-1"]);
    for part in ["16.050 kg", "1.367816575", "0.127920111", "-0.000105000", "force balanced   no"] {
        assert!(check.contains(part), "{part} in {check}");
    }
    assert!(!prints(&["check", "nine-link"]).contains("-0.000000000"), "zero has no sign");
}

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

/// What the README shows of planning is what is said, and what is proposed there works as printed.
#[test]
fn the_readme_shows_what_plan_says() {
    let readme = include_str!("../../README.md");
    let mut shown = 0;
    for (i, line) in readme.lines().enumerate() {
        let Some(words) = line.strip_prefix("$ stillbase plan nine-link ").filter(|words| !words.contains(" -o "))
        else {
            continue;
        };
        let arguments: Vec<&str> = ["plan", "nine-link"].into_iter().chain(words.split(' ')).collect();
        let said = readme.lines().nth(i + 1).expect("an answer").strip_prefix("stillbase: ");
        let out = stillbase(&arguments);
        assert_eq!(out.status.success(), said.is_none(), "{line}");
        let Some(said) = said else { continue };
        assert_eq!(text(&out.stderr).trim(), format!("stillbase: {said}"), "{line}");
        shown += 1;
    }
    assert_eq!(shown, 2);
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

/// A folder of this test's own, empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Runs in a folder and says what it printed on standard error.
fn said_in(folder: &Path, args: &[&str], status: i32) -> String {
    let out = stillbase_in(folder, args);
    assert_eq!(out.status.code(), Some(status), "{args:?}: {}", text(&out.stderr));
    text(&out.stderr).to_owned()
}

/// Every column of a Parquet file, by rows.
fn parquet_rows(file: &Path) -> (Vec<String>, Vec<String>) {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    let reader = SerializedFileReader::new(fs::File::open(file).expect("there")).expect("Parquet");
    let names = reader.metadata().file_metadata().schema().get_fields().iter().map(|f| f.name().to_owned()).collect();
    // The shortest text of a number that is read back as the same.
    let rows = reader.get_row_iter(None).expect("rows").map(|row| {
        let row = row.expect("a row");
        let value = |(_, field): (&String, &parquet::record::Field)| match field {
            parquet::record::Field::Long(x) => x.to_string(),
            parquet::record::Field::Double(x) => format!("{x:e}"),
            other => panic!("{other}"),
        };
        row.get_column_iter().map(value).collect::<Vec<_>>().join(",")
    });
    (names, rows.collect())
}

#[test]
fn shards_put_together_are_the_whole() {
    let folder = folder("shards");
    let study = |rest: &[&'static str]| {
        let common = ["tolerance", "case-1", "--samples", "1000", "--seed", "11", "--instants", "20"];
        let spreads = ["--spread", "link.*.com=normal:0.0005", "--spread", "link.5.mass=uniform:1%"];
        let args = [&common[..], &spreads, rest].concat();
        said_in(&folder, &args, 0)
    };
    study(&["-o", "whole.csv"]);
    study(&["-o", "whole.parquet"]);
    for (shard, csv, parquet) in
        [("1/3", "1.csv", "1.parquet"), ("2/3", "2.csv", "2.parquet"), ("3/3", "3.csv", "3.parquet")]
    {
        study(&["--shard", shard, "-o", csv]);
        study(&["--shard", shard, "-o", parquet]);
    }
    let merge = |parts: &[&'static str], whole: &'static str, status| {
        said_in(&folder, &[&["tolerance", "--merge"], parts, &["-o", whole]].concat(), status)
    };
    merge(&["3.csv", "1.csv", "2.csv"], "merged.csv", 0);
    assert_eq!(fs::read(folder.join("merged.csv")).expect("there"), fs::read(folder.join("whole.csv")).expect("there"));
    merge(&["2.parquet", "3.parquet", "1.parquet"], "merged.parquet", 0);
    let (names, rows) = parquet_rows(&folder.join("merged.parquet"));
    assert_eq!(
        (&names, &rows),
        (&parquet_rows(&folder.join("whole.parquet")).0, &parquet_rows(&folder.join("whole.parquet")).1)
    );
    assert_eq!((rows.len(), names.len()), (1000, 1 + 10 + 4));
    // The two kinds of file hold the same numbers, and parts of both go together.
    merge(&["2.parquet", "3.csv", "1.parquet"], "mixed.csv", 0);
    assert_eq!(fs::read(folder.join("mixed.csv")).expect("there"), fs::read(folder.join("whole.csv")).expect("there"));
    let csv = fs::read_to_string(folder.join("whole.csv")).expect("there");
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next().expect("a head").split(',').collect();
    assert!(head[0].starts_with("sample of 1000 seed 11 problem ") && head[1..] == names[1..], "{head:?}");
    for (line, row) in lines.zip(&rows) {
        let numbers = |text: &str| text.split(',').map(|x| x.parse().expect("a number")).collect::<Vec<f64>>();
        assert_eq!(numbers(line), numbers(row));
    }
    // What is missing, double or of another study is named, and nothing is written.
    let refused: [(&[&str], &str); 5] = [
        (&["1.csv", "3.csv"], "samples 333 to 665 are in no part"),
        (&["1.csv", "2.csv"], "samples 666 to 999 are in no part"),
        (&["1.csv", "2.csv", "3.csv", "2.parquet"], "sample 333 stands in"),
        (&["1.csv", "whole.csv"], "sample 0 stands in"),
        (&["nowhere.csv"], "nowhere.csv"),
    ];
    for (parts, words) in refused {
        let said = merge(parts, "no.csv", 2);
        assert!(said.contains(words) && said.lines().count() == 1, "{parts:?}: {said}");
        assert!(!folder.join("no.csv").exists());
    }
    for (option, value, words) in [
        ("--seed", "12", "seeds 11 and 12"),
        ("--samples", "999", "of 1000 and of 999"),
        ("--instants", "21", "instants"),
    ] {
        let common =
            ["tolerance", "case-1", "--spread", "link.*.com=normal:0.0005", "--spread", "link.5.mass=uniform:1%"];
        let mut others = vec![("--samples", "1000"), ("--seed", "11"), ("--instants", "20")];
        others.retain(|(key, _)| *key != option);
        others.push((option, value));
        let others: Vec<&str> = others.iter().flat_map(|(key, value)| [*key, *value]).collect();
        said_in(&folder, &[&common[..], &others, &["--shard", "2/3", "-o", "other.csv", "--force"]].concat(), 0);
        let said = said_in(&folder, &["tolerance", "--merge", "other.csv", "1.csv", "3.csv", "-o", "no.csv"], 2);
        let (a, b) = words.split_once(" and ").unwrap_or((words, words));
        assert!(said.contains("other.csv") && said.contains(a) && said.contains(b.trim_start_matches("of ")), "{said}");
    }
    // A row in the wrong place, and a file without a checksum.
    fs::write(folder.join("broken.csv"), csv.replacen("\n5,", "\n6,", 1)).expect("written");
    assert!(merge(&["broken.csv"], "no.csv", 2).contains("it was changed or damaged"));
    fs::write(folder.join("broken.csv"), csv.replacen(" check ", " checked ", 1)).expect("written");
    assert!(merge(&["broken.csv"], "no.csv", 2).contains("broken.csv: want a file that this version"));
    fs::write(folder.join("broken.parquet"), "PAR1").expect("written");
    assert!(merge(&["broken.parquet"], "no.csv", 2).contains("broken.parquet"));
    assert!(merge(&["1.csv"], "1.csv", 2).contains("exists"));
}

#[test]
fn tolerance_counts_what_keeps_within_limits() {
    let args = ["tolerance", "case-3", "--samples", "2000", "--limit-moment", "0.01", "--limit-force", "0.02"];
    let value = object(&args);
    let wanted =
        ["agreement", "bands", "motion_time", "nominal", "parameters", "peak_force", "peak_moment", "rms_force"];
    let more = ["rms_moment", "samples", "scenario", "seed", "shard", "shares", "simulated", "yield"];
    assert_eq!(keys(&value), [wanted, more].concat());
    assert_eq!((&value["samples"], &value["seed"], &value["shard"]), (&json!(2000), &json!(1), &json!([0, 2000])));
    let of = |key: &str| value["yield"][key]["share"].as_f64().expect("a share");
    assert!(of("both") <= of("moment").min(of("force")) && of("both") >= of("moment") + of("force") - 1.0);
    // The yield and the quantiles tell the same story.
    let quantiles = &value["peak_moment"]["quantiles"];
    for (level, at) in numbers(&quantiles["levels"]).into_iter().zip(numbers(&quantiles["values"])) {
        assert!((at <= 0.01) == (level <= of("moment")) || (level - of("moment")).abs() < 1e-3, "{level}: {at}");
    }
    let counts: f64 = numbers(&value["peak_force"]["histogram"]["counts"]).iter().sum();
    assert_eq!(counts, 2000.0);
    // Moments of inertia do not come into the force.
    let shares = value["shares"]["parameters"].as_array().expect("shares");
    let inertia = shares.iter().find(|s| s["key"] == "link.1.inertia").expect("it varies");
    assert!(inertia["force_share"] == 0.0 && inertia["moment_share"].as_f64() > Some(0.2));
    // All the same, simulated: control is good.
    let simulated = object(&["tolerance", "case-3", "--simulate", "--samples", "6"]);
    let ratio = simulated["against_tracking"]["peak_moment_ratio"].as_f64().expect("a ratio");
    assert!(simulated["simulated"] == true && (ratio - 1.0).abs() < 0.1 && ratio != 1.0, "{ratio}");
    let printed = prints(&args);
    for word in ["peak |n_B|", "yield", "95 % between", "what matters", "first order against all", "others"] {
        assert!(printed.contains(word), "{printed}");
    }
    fails(&["tolerance", "case-3", "--spread", "link.1.com"], 2, &["KEY=SPREAD"]);
    fails(&["tolerance", "case-3", "--spread", "link.1.com=normal:x"], 2, &["uniform:1%"]);
    fails(&["tolerance", "case-3", "--spread", "link.x.com=normal:1"], 2, &["link.x.com"]);
    fails(&["tolerance", "case-3", "--shard", "0/3"], 2, &["i from 1"]);
    fails(&["tolerance", "case-3", "--samples", "2", "--shard", "1/3"], 2, &["fewer shards"]);
    fails(&["tolerance", "case-3", "--samples", "1000000000"], 2, &["shards"]);
    fails(&["tolerance", "case-3", "-o", "x.txt"], 2, &[".parquet"]);
    fails(&["tolerance", "case-3", "--set", "task.b=9"], 1, &["case-3"]);
    fails(&["tolerance", "--merge", "a.csv"], 2, &["--output"]);
}

#[test]
fn spectrum_says_what_is_kept() {
    let value = object(&["spectrum", "case-1", "--limit-moment", "1:0.1,10:0.01,100:0.001", "--limit-force", "0.5"]);
    let wanted =
        ["axes", "cumulative_rms", "density", "frequency", "resolution", "samples", "scenario", "step", "window"];
    assert_eq!(keys(&value), wanted);
    let moment = &value["axes"]["moment"];
    assert!(moment["limit"]["within"] == false && value["axes"]["force_x"]["limit"]["within"] == true);
    let (density, rms) = (numbers(&value["density"]["moment"]), numbers(&value["cumulative_rms"]["moment"]));
    assert_eq!((density.len(), rms.len()), (501, 501));
    // The worst frequency is where the density says.
    let frequency = numbers(&value["frequency"]);
    let worst = moment["limit"]["frequency"].as_f64().expect("a frequency");
    let line = frequency.iter().position(|f| *f == worst).expect("a line");
    assert_eq!(Some(density[line]), moment["limit"]["density"].as_f64());
    assert!(rms.is_sorted(), "it only grows");
    // The RMS is that of the samples, whatever the window; with none the lines add up to it.
    let plain = object(&["spectrum", "case-1", "--window", "rectangular"]);
    let whole = numbers(&plain["cumulative_rms"]["moment"]).last().copied().expect("lines");
    assert!((whole - moment["rms"].as_f64().expect("RMS")).abs() < 1e-12);
    assert_eq!(plain["axes"]["moment"]["rms"], moment["rms"]);
    let course = numbers(&object(&["simulate", "case-1"])["signals"]["moment/total"]);
    let square = course.iter().map(|x| x * x).sum::<f64>() / course.len() as f64;
    assert!((plain["axes"]["moment"]["rms"].as_f64().expect("RMS") - square.sqrt()).abs() < 1e-12);
    let folder = folder("spectrum");
    said_in(&folder, &["spectrum", "case-1", "-o", "s.csv"], 0);
    let csv = fs::read_to_string(folder.join("s.csv")).expect("there");
    assert!(csv.starts_with("frequency Hz,f_Bx N/√Hz,f_Bx RMS N,f_By N/√Hz,f_By RMS N,n_B N m/√Hz,n_B RMS N m\n"));
    assert_eq!(csv.lines().count(), 502);
    assert!(said_in(&folder, &["spectrum", "case-1", "-o", "s.csv"], 2).contains("exists"));
    fails(&["spectrum", "case-1", "--limit-moment", "2:1,1:1"], 2, &["rising"]);
    fails(&["spectrum", "case-1", "--limit-moment", "600:1,700:1"], 2, &["600", "499.5"]);
    fails(&["spectrum", "case-1", "--window", "flat"], 2, &["hann"]);
}

/// A window weighs the samples, so the cumulative RMS ends at the weighted one; without a window that is the plain one.
#[test]
fn the_cumulative_rms_ends_at_what_stands_beside_it() {
    for (window, same) in [("hann", false), ("rectangular", true)] {
        let got = object(&["spectrum", "case-1", "--window", window]);
        for axis in ["force_x", "force_y", "moment"] {
            let ends = *numbers(&got["cumulative_rms"][axis]).last().expect("lines");
            let of = |key: &str| got["axes"][axis][key].as_f64().expect("a number");
            assert!((ends - of("weighted_rms")).abs() <= 1e-12 * ends, "{axis}: {ends} {}", of("weighted_rms"));
            let off = (of("rms") - ends).abs() / ends;
            assert_eq!(off < 1e-9, same, "{window} {axis}: {off}");
        }
        let shown = prints(&["spectrum", "case-1", "--window", window]);
        assert!(shown.contains("weighted RMS") && shown.contains("ends at the weighted RMS") != same, "{shown}");
    }
}

/// The machine without deviations goes the way of the others: the same base, control and friction.
#[test]
fn simulated_machines_stand_beside_a_simulated_nominal_one() {
    let settings = ["base.kind=free", "base.com=0.1,0.05", "control.kp=300", "plant.friction.viscous=0.2"];
    let settings: Vec<&str> = settings.iter().flat_map(|s| ["--set", s]).collect();
    let study = object(&[&["tolerance", "case-1", "--simulate", "--samples", "2"][..], &settings].concat());
    let run = object(&[&["simulate", "case-1"][..], &settings].concat());
    let (nominal, verdict) = (&study["nominal"], &run["verdict"]);
    for (a, b) in [("peak_moment", "peak_base_moment"), ("peak_force", "peak_base_force")] {
        near(&nominal[a], &verdict[b], 1e-12, a);
    }
    for (a, b) in [("rms_moment", "rms_base_moment"), ("rms_force", "rms_base_force")] {
        near(&nominal[a], &verdict[b], 1e-9, a);
    }
    // Perfect tracking on a fixed base is another row.
    let tracked = object(&[&["tolerance", "case-1", "--samples", "2"][..], &settings].concat());
    let peak = |of: &Value| of["nominal"]["peak_moment"].as_f64().expect("a number");
    assert!((peak(&tracked) / peak(&study) - 1.0).abs() > 0.01, "{} {}", peak(&tracked), peak(&study));
}

/// Drive angles are absolute, so what a base that moves does belongs to them.
#[test]
fn what_is_simulated_on_a_base_that_moves_has_its_pose() {
    let settings = ["--set", "base.kind=free", "--set", "base.com=0.1,0.05"];
    let got = object(&[&["export", "case-1", "--what", "simulated", "--rate", "100"][..], &settings].concat());
    let columns: Vec<&str> = got["columns"].as_array().expect("a list").iter().filter_map(Value::as_str).collect();
    let run = object(&[&["simulate", "case-1", "--every", "10"][..], &settings].concat());
    let rows: Vec<Vec<f64>> = got["rows"].as_array().expect("rows").iter().map(numbers).collect();
    let pairs = [
        ("base_x", "base/x"),
        ("base_y", "base/y"),
        ("theta", "attitude/base"),
        ("base_xd", "base_velocity/x"),
        ("base_yd", "base_velocity/y"),
        ("thetad", "attitude_rate/base"),
    ];
    for (column, signal) in pairs {
        let place = columns.iter().position(|c| *c == column).unwrap_or_else(|| panic!("no {column} in {columns:?}"));
        let want = numbers(&run["signals"][signal]);
        assert!(rows.iter().map(|row| row[place]).eq(want.iter().copied()), "{column}");
        assert!(want.iter().any(|x| x.abs() > 1e-9), "{column} moves");
    }
    let still = object(&["export", "case-1", "--what", "simulated", "--rate", "100"]);
    assert!(still["columns"].as_array().expect("a list").iter().all(|c| c != "theta"));
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

/// What a verdict leaves out is said in words, in the table, and in JSON.
#[test]
fn verdicts_are_said_in_full() {
    let said = |args: &[&str]| text(&stillbase(args).stderr).to_owned();
    let wheel = ["simulate", "case-1", "--set", "base.wheel.inertia=0.002"];
    let line = said(&wheel);
    assert!(line.contains("peak |n_B| 1.089") && line.contains("past the wheel 0.000000 N m"), "{line}");
    assert!(line.contains("reactionless: no") && line.contains("the wheel takes it up"), "{line}");
    let got = object(&wheel);
    assert!(got["verdict"]["peak_moment_past_wheel"].as_f64() < Some(1e-9), "{}", got["verdict"]);
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
    assert!(got["verdict"]["base_tilt"].as_f64().expect("a number") > 0.01);
    for (pair, word) in [
        ("base.kind=floating", "floating"),
        ("base.mass=-1", "base.mass is -1"),
        ("base.colour=3", "colour"),
        ("plant.payload.mass=-1", "plant.payload.mass is -1"),
        ("plant.link.77.mass=1", "77"),
        ("plant.length.l1=-1", "length"),
        ("plant.friction.coulomb=1,2", "one for each drive"),
        ("control.law=magic", "magic"),
        ("control.rate=333.3", "control.rate is 333.3"),
        ("control.delay=0.0005", "control.delay"),
        ("plant.payload.until=0", "plant.payload.until"),
        ("base.wheel.inertia=0", "base.wheel.inertia"),
        ("task.time=nan", "time is not a finite number"),
        ("plant.payload.offset=[0.1,inf]", "payload.offset is not a finite number"),
    ] {
        fails(&["simulate", "case-1", "--set", pair], 2, &[word]);
    }
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
