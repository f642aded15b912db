//! `reach`, `pose` and `workspace`.

use super::*;

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

/// Rounded to nearest, half of them would lie outside of their interval.
#[test]
fn ends_that_reach_prints_serve_when_they_are_typed_back() {
    let mut ends = 0;
    for (machine, points) in [
        ("nine-link", ["-0.82,-0.42", "0.5,0.5", "0.31,0.92", "-0.6,0.7", "0.13,-0.77"]),
        ("serial-3r", ["-0.06,-0.88", "0.5,0.5", "0.31,0.72", "-0.6,0.4", "0.13,-0.77"]),
        ("two-drive", ["0.5,0.5", "0.31,0.72", "-0.6,0.4", "0.13,-0.67", "0.4,0.3"]),
    ] {
        for point in points {
            let out = stillbase(&["reach", machine, point]);
            if !out.status.success() {
                continue;
            }
            let rows = text(&out.stdout).lines().skip(1).take_while(|line| !line.starts_with("all"));
            for end in rows.flat_map(|row| row.split_whitespace().rev().take(2).collect::<Vec<_>>()) {
                let posed = stillbase(&["pose", machine, point, "--b", end]);
                assert!(posed.status.success(), "{machine} {point} --b {end}: {}", text(&posed.stderr));
                ends += 1;
            }
        }
    }
    assert!(ends > 20, "{ends} ends were tried");
    // Of one point, what serves all is what serves it.
    let one = object(&["reach", "two-drive", "0.5,0.5"]);
    assert_eq!(one["overlap"], one["points"][0]["intervals"]);
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
    // Each point that has to move is named, and no other moves.
    let out = stillbase(&["reach", "nine-link", "5,5", "0.5,0.5", "-5,-5", "--json"]);
    let got: Value = serde_json::from_slice(&out.stdout).expect("JSON");
    let [way] = &got["proposals"].as_array().expect("proposals")[..] else { panic!("{got}") };
    let [text, command] = ["text", "command"].map(|key| way[key].as_str().expect("text"));
    let typed: Vec<&str> = command.split(' ').filter(|word| word.contains(',')).collect();
    for (i, point) in ["5,5", "0.5,0.5", "-5,-5"].into_iter().enumerate() {
        let place = format!("point {} to ({}) m", i + 1, typed[i].replace(',', ", "));
        assert_eq!(text.contains(&place), typed[i] != point, "{text}: {command}");
    }
    let words: Vec<&str> = command.split(' ').skip(1).filter(|word| *word != "--json").collect();
    assert_ne!(object(&words)["overlap"], json!([]));
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
    fails(&["check", "nine-link", "--set", "length.l1=1e300"], 2, &["length.l1) is 1e300: want 1e-6 to 1000000 m"]);
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
        let answer: Value = serde_json::from_slice(&out.stdout).expect("an answer or a refusal");
        let poses = json!({ "poses": answer.get("poses").cloned().unwrap_or(json!([])) });
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

/// Points of machines of two and four drives: their poses, how far they are from the curve or boundary, and how well the
/// poses do.
#[test]
fn workspace_tells_of_points_for_any_number_of_drives() {
    let four = object(&["workspace", "four-drive", "--b", "2.9", "--at", "0.6,0.5", "--at", "2,2"]);
    let points = four["points"].as_array().expect("points");
    assert!(
        points[0]["distance"].as_f64().expect("a distance") > 0.0
            && points[1]["distance"].as_f64().expect("one") < -1.0
    );
    let pose = &points[0]["poses"][0];
    let own = object(&["pose", "four-drive", "0.6,0.5", "--b", "2.9"]);
    assert_eq!(pose, &own["poses"][0]);
    assert_eq!(points[1]["poses"], json!([]));
    // J by differences: its singular values are what is told.
    let q = numbers(&pose["q"]);
    let arms = [0.5, -0.46, -0.3, -0.15];
    let columns: Vec<[f64; 2]> = (0..4).map(|k| [-arms[k] * q[k].sin(), arms[k] * q[k].cos()]).collect();
    let sum = |i: usize, j: usize| columns.iter().map(|c| c[i] * c[j]).sum::<f64>();
    let (xx, xy, yy) = (sum(0, 0), sum(0, 1), sum(1, 1));
    near(&pose["manipulability"], &json!((xx * yy - xy * xy).sqrt()), 1e-9, "√det(J Jᵀ)");
    let worst = (0.5 * (xx + yy) + (0.25 * (xx - yy).powi(2) + xy * xy).sqrt()).sqrt();
    near(&pose["worst_torque_per_force"], &json!(worst), 1e-9, "its largest singular value");
    let at = "0.24662476548459572,-0.0867203125571595";
    let two = object(&["workspace", "two-drive", "--b", "1.2", "--at", at, "--at", "0.5,0.5"]);
    let distance = |i: usize| two["points"][i]["distance"].as_f64().expect("a distance");
    assert!(distance(0) < 1e-5 && distance(1) > 0.1, "{} {}", distance(0), distance(1));
    assert!(two["points"][0]["poses"] != json!([]) && two["points"][1]["poses"] == json!([]));
    let table = stillbase(&["workspace", "two-drive", "--b", "1.2", "--at", at]);
    assert!(text(&table.stdout).contains("from curve m"));
}
