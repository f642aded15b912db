//! `joints`: what the pins carry.

use super::*;

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

/// Where no loop lies flat there is no change point, though links in series line up.
#[test]
fn joints_speaks_of_change_points_of_loops_alone() {
    for arm in ["serial-3r", "space-arm", "scara"] {
        assert_eq!(object(&["joints", arm])["transmission"], json!([]), "{arm}");
        let said = prints(&["joints", arm]);
        assert!(!said.contains("change point") && !said.contains("|sin|"), "{said}");
    }
    assert_eq!(object(&["joints", "case-3"])["transmission"].as_array().map(Vec::len), Some(3));
}

#[test]
fn joints_writes_forces_as_csv_and_says_why_there_are_none() {
    let folder = Folder::new("cli");
    let file = word(folder.path("pins.csv"));
    prints(&["joints", "case-3", "-o", &file]);
    let mut reader = csv::Reader::from_path(&file).expect("a file");
    let head: Vec<String> = reader.headers().expect("a head").iter().map(String::from).collect();
    assert_eq!(head.len(), 1 + 24 + 4);
    assert_eq!(head[25..], ["tilt/x N m", "tilt/y N m", "tilt x N m", "tilt y N m"], "older names beside newer ones");
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
