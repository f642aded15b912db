//! `trim`: from CSV to the change that mends a machine.

use super::*;

/// What `export` and `simulate` write is read as it is, and says what was hidden in the plant.
#[test]
fn what_the_program_writes_is_measured_data() {
    let folder = folder("trim-loop");
    let hidden = ["--set", "plant.link.5.com=-0.03", "--set", "plant.link.9.mass=0.35"];
    let exported = ["export", "case-1", "--what", "simulated", "--rate", "250", "-o", "a.csv"];
    said_in(&folder, &[&exported[..], &hidden].concat(), 0);
    said_in(&folder, &[&["simulate", "case-2", "--every", "4", "-o", "b.csv"][..], &hidden].concat(), 0);
    let truth = object(&["check", "nine-link", "--set", "link.5.com=-0.03", "--set", "link.9.mass=0.35"]);
    for ways in [&["a.csv"][..], &["b.csv"], &["a.csv", "b.csv"], &["b.csv", "--angles-only"]] {
        let out = stillbase_in(&folder, &[&["trim"][..], &ways[..1], &ways[1..], &["nine-link", "--json"]].concat());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let got: Value = serde_json::from_slice(&out.stdout).expect("an object");
        let along = |letter: &str| -> Value {
            let all = got["numbers"].as_array().expect("numbers").iter();
            let own = all.filter(|x| {
                let name = x["name"].as_str().expect("a name");
                name.starts_with(letter) && name.ends_with(" along")
            });
            own.map(|x| x["measured"].clone()).collect()
        };
        near(&along("g"), &truth["gamma_coefficients"], 1e-3, "g");
        near(&along("C"), &truth["coupling_coefficients"], 1e-3, "C");
        assert!(!got["changes"].as_array().expect("changes").is_empty());
    }
    let written = ["trim", "a.csv", "b.csv", "nine-link", "-o", "new.toml", "--identified", "now.toml"];
    said_in(&folder, &written, 0);
    let check = |file: &str| -> f64 {
        let out = stillbase_in(&folder, &["check", file, "--json"]);
        let value: Value = serde_json::from_slice(&out.stdout).expect("an object");
        numbers(&value["gamma_coefficients"]).iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    assert!(check("now.toml") > 0.04 && check("new.toml") < 1e-4);
    assert!(said_in(&folder, &written, 2).contains("--force"));
}

/// In orbit, settings of the base are those of its scenario: a base of another mass is named once the right one is set.
#[test]
fn settings_of_the_base_are_taken_in_orbit() {
    let folder = folder("trim-orbit");
    let start = ["--set", "task.start=1.2,0.4,-0.6", "--set", "task.to=0.34,0.45"];
    let heavy = ["--set", "base.inertia=0.21"];
    let fly = |more: &[&str], file: &str| {
        said_in(&folder, &[&["simulate", "spot", "--every", "20", "-o", file][..], &heavy, more].concat(), 0);
    };
    fly(&[], "a.csv");
    fly(&start, "b.csv");
    said_in(&folder, &[&["simulate", "spot-swing", "--every", "20", "-o", "c.csv"][..], &heavy].concat(), 0);
    let off = |more: &[&str]| -> f64 {
        let all = [&["trim", "a.csv", "b.csv", "c.csv", "spot", "--base", "spot", "--json"], more].concat();
        let out = stillbase_in(&folder, &all);
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let got: Value = serde_json::from_slice(&out.stdout).expect("an object");
        got["rate_off"].as_f64().expect("a number")
    };
    assert!(off(&[]) > 1e-4 && off(&heavy) < 1e-8, "{} {}", off(&[]), off(&heavy));
    let held = ["trim", "a.csv", "spot", "--base", "spot", "--set", "base.kind=fixed"];
    assert!(said_in(&folder, &held, 2).contains("does not float"));
    assert!(
        said_in(&folder, &["trim", "a.csv", "spot", "--set", "base.mass=12"], 2).contains("no setting \"base.mass\"")
    );
}

/// Units, other separators, named motions: the same numbers.
#[test]
fn units_and_separators_change_nothing() {
    let folder = folder("trim-units");
    let row = |t: f64| {
        let q = [0.5 * (5.0 * t).sin(), 1.0 + 0.4 * (7.0 * t).cos()];
        let f = [3.0 * (5.0 * t).sin() + (9.0 * t).cos(), 2.0 * (7.0 * t).cos(), (6.0 * t).sin()];
        (q, f)
    };
    let times = || (0..300).map(|i| 0.01 * f64::from(i));
    let plain: String = times()
        .map(|t| {
            let (q, f) = row(t);
            format!("{t},{},{},{},{},{}\n", q[0], q[1], f[0], f[1], f[2])
        })
        .collect();
    let other: String = times()
        .map(|t| {
            let (q, f) = row(t);
            let degrees = q.map(f64::to_degrees);
            let motion = if t < 10.0 { "first" } else { "second" };
            format!(
                "{motion};{};{};{};{};{};{}\n",
                1e3 * f[2],
                f[1],
                1e-3 * f[0],
                degrees[1],
                degrees[0],
                1e3 * (t + 5.0)
            )
        })
        .collect();
    fs::write(folder.join("plain.csv"), format!("t,q1,q2,fx,fy,nz\n{plain}")).expect("written");
    let head = "motion;nz (mN m);Fy [N];fx kN;q2 (deg);q1 deg;t (ms)";
    fs::write(folder.join("other.csv"), format!("\u{feff}# a stranger's\n{head}\n{other}")).expect("written");
    let measured = |file: &str| -> Value {
        // These forces are of no machine.
        let out = stillbase_in(&folder, &["trim", file, "two-drive", "--as-given", "--json"]);
        let said = text(&out.stderr);
        let value: Value = serde_json::from_slice(&out.stdout).unwrap_or_else(|e| panic!("{e}: {said}"));
        value["numbers"].as_array().expect("numbers").iter().map(|x| x["measured"].clone()).collect()
    };
    near(&measured("other.csv"), &measured("plain.csv"), 1e-6, "units");
}

/// What is wrong is named with its row and column.
#[test]
fn what_is_wrong_is_named_by_row_and_column() {
    let folder = Folder::new("trim");
    let head = "t,q1,q2,fx,fy,nz\n";
    let good = |n: u32| -> String { (0..n).map(|i| format!("{},0.{i},1,0,0,0\n", 0.01 * f64::from(i))).collect() };
    let refused = |text: &str, status: i32, words: &[&str]| {
        let file = word(folder.file("m.csv", text));
        fails(&["trim", &file, "two-drive"], status, words);
    };
    refused("", 2, &["nothing here", "t,q1,q2,fx,fy,nz"]);
    refused("1,2,3,4,5,6\n", 2, &["no header"]);
    refused("t,q1,fx,fy,nz\n", 2, &["no column q2"]);
    refused("t,q1,q2,fx,fy\n", 2, &["no column nz"]);
    refused("t,q1,q2,fx,fx,fy,nz\n", 2, &["columns 4 and 5 are both fx"]);
    refused("t,q1,q2,fx (lb),fy,nz\n", 2, &["column fx: unit \"lb\"", "n, mn, kn"]);
    refused(&format!("{head}0,0,0,0,0,nan\n"), 2, &["m.csv:2: column nz: \"nan\": want a finite number"]);
    refused(&format!("{head}0,0,0,0,0\n"), 2, &["m.csv:2: column nz: nothing there"]);
    refused(&format!("{head}{}0.02,0,0,0,0,0\n", good(4)), 2, &["m.csv:6: column t", "want times that rise"]);
    refused(&format!("{head}0.01,0,0,0,0,0\n0.01,0,0,0,0,0\n"), 2, &["m.csv:3: column t"]);
    refused(&format!("{head}0,0,0,0,0,0\n1,9,0,0,0,0\n"), 2, &["m.csv:3: column q1: a jump"]);
    refused(&format!("{head}0,90,0,0,0,0\n1,91,0,0,0,0\n"), 2, &["two turns", "(deg)"]);
    refused(&format!("{head}{}", good(3)), 2, &["3 rows", "want at least 51"]);
    let moving = "t,q1,q2,fx,fy,nz,base_x\n0,0,0,0,0,0,0\n1,0,0,0,0,0,0.1\n";
    refused(moving, 2, &["m.csv:3: column base_x: the base moves", "stands still"]);
    let still: String = (0..80).map(|i| format!("{},1,1,0,0,0\n", 0.01 * f64::from(i))).collect();
    refused(&format!("{head}{still}"), 2, &["no drive moves"]);
    let file = word(folder.file("m.csv", format!("{head}{}", good(60))));
    fails(&["trim", &file, "two-drive", "--accelerations", "3"], 2, &["want 2, one for each drive"]);
    fails(&["trim", &file, "two-drive", "--fix", "7.com"], 2, &["no parameter", "7.com"]);
    fails(&["trim", &file, "two-drive", "--range", "9=0,1"], 2, &["no link 9"]);
    fails(
        &["trim", &file, "two-drive", "--fix", "1.com", "--range", "1=0,1"],
        2,
        &["--range and --across are for new"],
    );
}

/// A reversed moment is refused, what is said to be right is, and who insists has their way.
#[test]
fn a_reversed_sensor_is_refused_and_what_it_asks_for_works() {
    let folder = folder("trim-reversed");
    let hidden = ["--set", "plant.link.5.com=-0.03"];
    let exported = ["export", "case-2", "--what", "simulated", "--rate", "250", "-o", "good.csv"];
    said_in(&folder, &[&exported[..], &hidden].concat(), 0);
    let good = fs::read_to_string(folder.join("good.csv")).expect("written");
    let mut lines = good.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let head = lines.find(|cells| cells.len() > 3).expect("a header");
    let moment = head.iter().position(|cell| cell.starts_with("moment/total") || cell.starts_with("nz")).expect("one");
    let reversed = |cells: Vec<String>| -> String {
        let turned = |(i, cell): (usize, &String)| {
            if i == moment { (-cell.parse::<f64>().expect("a number")).to_string() } else { cell.clone() }
        };
        cells.iter().enumerate().map(turned).collect::<Vec<_>>().join(",") + "\n"
    };
    let bad: String = lines.map(reversed).collect();
    fs::write(folder.join("bad.csv"), head.join(",") + "\n" + &bad).expect("written");
    let said = said_in(&folder, &["trim", "bad.csv", "nine-link"], 1);
    assert!(said.contains("nz has the wrong sign: want nz times −1"), "{said}");
    assert!(said.contains("which no positive masses can give") && said.contains("--as-given"), "{said}");
    assert!(said_in(&folder, &["trim", "bad.csv", "nine-link", "--as-given"], 0).contains("note: nz"), "insisted");
    said_in(&folder, &["trim", "good.csv", "nine-link"], 0);
}
