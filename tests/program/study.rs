//! `tolerance` and `spectrum`.

use super::*;

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

/// What is taken where no spread is given names only what a machine has.
#[test]
fn tolerances_of_every_machine_are_studied_without_a_spread() {
    for machine in ["scara", "serial-3r", "space-arm", "nine-link"] {
        let got = object(&["tolerance", machine, "--samples", "200"]);
        assert!(got["parameters"].as_array().is_some_and(|all| !all.is_empty()), "{machine}: {got}");
    }
    fails(&["tolerance", "scara", "--spread", "length.*=0.001"], 2, &["length.*"]);
}

#[test]
fn tolerance_counts_what_keeps_within_limits() {
    let args = ["tolerance", "case-3", "--samples", "2000", "--limit-moment", "0.01", "--limit-force", "0.02"];
    let value = object(&args);
    let wanted = [
        "agreement",
        "bands",
        "duration",
        "motion_time",
        "nominal",
        "parameters",
        "peak_base_force",
        "peak_base_moment",
    ];
    let older = ["peak_force", "peak_moment", "rms_base_force", "rms_base_moment", "rms_force"];
    let more = ["rms_moment", "samples", "scenario", "seed", "shard", "shares", "simulated", "yield"];
    assert_eq!(keys(&value), [&wanted[..], &older, &more].concat());
    assert_eq!((&value["samples"], &value["seed"], &value["shard"]), (&json!(2000), &json!(1), &json!([0, 2000])));
    let of = |key: &str| value["yield"][key]["share"].as_f64().expect("a share");
    assert!(of("both") <= of("moment").min(of("force")) && of("both") >= of("moment") + of("force") - 1.0);
    // The yield and the quantiles tell the same story.
    let quantiles = &value["peak_base_moment"]["quantiles"];
    for (level, at) in numbers(&quantiles["levels"]).into_iter().zip(numbers(&quantiles["values"])) {
        assert!((at <= 0.01) == (level <= of("moment")) || (level - of("moment")).abs() < 1e-3, "{level}: {at}");
    }
    let counts: f64 = numbers(&value["peak_base_force"]["histogram"]["counts"]).iter().sum();
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
    for word in ["peak |n_B|", "yield", "95 % between", "what matters", "first order, compared", "others"] {
        assert!(printed.contains(word), "{printed}");
    }
    fails(&["tolerance", "case-3", "--spread", "link.1.com"], 2, &["KEY=SPREAD"]);
    fails(&["tolerance", "case-3", "--spread", "link.1.com=normal:x"], 2, &["uniform:1%"]);
    fails(&["tolerance", "case-3", "--spread", "link.x.com=normal:1"], 2, &["link.x.com"]);
    fails(&["tolerance", "case-3", "--shard", "0/3"], 2, &["i from 1"]);
    fails(&["tolerance", "case-3", "--samples", "2", "--shard", "1/3"], 2, &["fewer shards"]);
    fails(&["tolerance", "case-3", "--samples", "1000000000"], 2, &["shards", "--summary"]);
    fails(&["tolerance", "case-3", "-o", "x.txt"], 2, &[".parquet"]);
    fails(&["tolerance", "case-3", "--set", "task.b=9"], 1, &["case-3"]);
    fails(&["tolerance", "--merge", "a.csv"], 2, &["--output"]);
}

/// Summaries say what every machine says, add up in any order, and are made exact by drawing the machines again.
#[test]
fn summaries_say_what_every_machine_says() {
    let folder = folder("summaries");
    let json = |args: &[&str]| {
        let done = stillbase_in(&folder, &[args, &["--json"]].concat());
        assert!(done.status.success(), "{}", text(&done.stderr));
        serde_json::from_slice::<Value>(&done.stdout).expect("JSON")
    };
    let study = ["tolerance", "case-3", "--samples", "5000"];
    let limits = ["--limit-moment", "0.01", "--limit-force", "0.02"];
    let full = json(&[&study[..], &limits].concat());
    let part = |i: &str, file: &str| json(&[&study[..], &limits, &["--summary", "--shard", i, "-o", file]].concat());
    let (first, _) = (part("1/2", "a.parquet"), part("2/2", "b.parquet"));
    assert_eq!(first["shard"], json!([0, 2500]));
    let whole = json(&[&study[..], &limits, &["--summary", "-o", "whole.parquet"]].concat());
    let merged = json(&["tolerance", "--merge", "b.parquet", "a.parquet", "-o", "merged.parquet"]);
    let read = |file: &str| fs::read(folder.join(file)).expect("there");
    assert!(read("merged.parquet") == read("whole.parquet"));
    let exact = json(&[&study[..], &["--exact", "merged.parquet"]].concat());
    for name in ["peak_base_moment", "peak_base_force", "rms_base_moment", "rms_base_force"] {
        for of in [&whole, &merged] {
            near(&of[name]["mean"], &full[name]["mean"], 1e-13, name);
            near(&of[name]["deviation"], &full[name]["deviation"], 1e-11, name);
            // Where the quantiles happen to be extremes of their bins they are exact.
            assert!(of[name].get("quantile_error").is_none_or(|error| *error == 0.0009765625));
            for (got, want) in
                numbers(&of[name]["quantiles"]["values"]).iter().zip(numbers(&full[name]["quantiles"]["values"]))
            {
                assert!((got / want - 1.0).abs() < 0.001, "{name}: {got} {want}");
            }
        }
        assert_eq!(exact[name]["quantiles"], full[name]["quantiles"]);
        assert!(exact[name].get("quantile_error").is_none() && full[name].get("quantile_error").is_none());
    }
    assert!(whole["yield"] == full["yield"] && merged["yield"] == full["yield"] && exact["yield"] == full["yield"]);
    assert_eq!(whole["peak_base_moment"]["quantile_error"], merged["peak_base_moment"]["quantile_error"]);
    // Other limits are counted, too.
    let other = ["--limit-moment", "0.004", "--limit-force", "0.03"];
    let (anew, want) =
        (json(&[&study[..], &other, &["--exact", "merged.parquet"]].concat()), [&study[..], &other].concat());
    assert_eq!(anew["yield"], json(&want)["yield"]);
    let [least, greatest] =
        [0, 1].map(|i| whole["peak_base_moment"]["extreme_machines"][i].as_u64().expect("a machine"));
    for (machine, level) in [(least, 0), (greatest, 8)] {
        // A machine by itself is a shard of its own.
        let alone = json(&[&study[..], &["--shard", &format!("{}/5000", machine + 1)]].concat());
        assert_eq!(alone["peak_base_moment"]["mean"], whole["peak_base_moment"]["quantiles"]["values"][level]);
    }
    // With gaps, too, it says what is missing.
    let (gap, _) = (part("1/3", "first.parquet"), part("3/3", "last.parquet"));
    assert_eq!(gap["shard"], json!([0, 1666]));
    json(&["tolerance", "--merge", "first.parquet", "last.parquet", "-o", "gap.parquet"]);
    let said = said_in(&folder, &[&study[..], &["--exact", "gap.parquet"]].concat(), 0);
    assert!(said.contains("machines 1666 to 3332 are in no part"), "{said}");
    let found = json(&[&study[..], &["--exact", "gap.parquet"]].concat());
    assert_eq!(found["missing"], json!([[1666, 3333]]));
    let said = said_in(&folder, &[&study[..], &["--exact", "gap.parquet", "--strict"]].concat(), 1);
    assert!(said.contains("1667 of 5000 machines in no part"), "{said}");
    // Some parts are merged as they are, and what is missing is said.
    let some = json(&["tolerance", "--merge", "b.parquet", "-o", "some.parquet"]);
    let said = said_in(&folder, &["tolerance", "--merge", "b.parquet", "-o", "strict.parquet", "--strict"], 1);
    assert!(said.contains("2500 of 5000 machines in no part"), "{said}");
    assert_eq!((&some["missing"], merged.get("missing")), (&json!([[0, 2500]]), None));
    for (args, status, words) in [
        (&["--merge", "a.parquet", "a.parquet", "-o", "x.parquet"][..], 2, "machines 0 to 2499 are counted twice"),
        (
            &["--merge", "a.parquet", "-o", "x.parquet", "--limit-moment", "0.011"],
            2,
            "want --limit-moment with every part",
        ),
        (&["case-3", "--samples", "4000", "--exact", "a.parquet"], 2, "of another study"),
        (&["case-3", "--samples", "50", "--summary", "-o", "x.csv"], 2, ".parquet"),
        (&["case-3", "--exact", "nowhere.parquet"], 2, "nowhere.parquet"),
        (&["case-3", "--samples", "50", "--summary", "-o", "-", "--format", "parquet"], 2, "a summary is a file"),
    ] {
        let said = said_in(&folder, &[&["tolerance"], args].concat(), status);
        assert!(said.contains(words), "{said}");
    }
    // Every machine and a summary are different things.
    json(&[&study[..], &["--shard", "1/2", "-o", "rows.parquet"]].concat());
    let said = said_in(&folder, &["tolerance", "--merge", "rows.parquet", "b.parquet", "-o", "x.parquet"], 2);
    assert!(said.contains("want one kind"), "{said}");
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
    let newer = "force_x N/√Hz,force_x cumulative_rms N,force_y N/√Hz,force_y cumulative_rms N,moment N m/√Hz,\
                 moment cumulative_rms N m";
    let older = "f_Bx N/√Hz,f_Bx RMS N,f_By N/√Hz,f_By RMS N,n_B N m/√Hz,n_B RMS N m";
    assert!(csv.starts_with(&format!("frequency Hz,{newer},{older}\n")), "{csv:.300}");
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
    for name in ["peak_base_moment", "peak_base_force"] {
        near(&nominal[name], &verdict[name], 1e-12, name);
    }
    for name in ["rms_base_moment", "rms_base_force"] {
        near(&nominal[name], &verdict[name], 1e-9, name);
    }
    // Perfect tracking on a fixed base is another row.
    let tracked = object(&[&["tolerance", "case-1", "--samples", "2"][..], &settings].concat());
    let peak = |of: &Value| of["nominal"]["peak_base_moment"].as_f64().expect("a number");
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
