//! `machines`, `check` and `design`, and machines from files and settings.

use super::*;

#[test]
fn machines_are_listed() {
    let all = object(&["machines"]);
    assert_eq!(keys(&all), ["assemblies", "machines", "templates"]);
    let first = &all["machines"][0];
    assert_eq!(keys(first), ["drives", "links", "name", "summary"]);
    assert_eq!(first["name"], "nine-link");
    assert_eq!((&first["drives"], &first["links"]), (&json!(3), &json!(9)));
    let names: Vec<&str> =
        all["machines"].as_array().expect("list").iter().filter_map(|m| m["name"].as_str()).collect();
    let table = prints(&["machines"]);
    assert!(names.contains(&"nine-link-table-1") && names.iter().all(|n| table.contains(n)));
    // Of one to eight drives each has two sentences and a task of its own, under its name.
    assert!(names.len() >= 9, "{names:?}");
    for machine in all["machines"].as_array().expect("list").iter().skip(2) {
        let said = machine["summary"].as_str().expect("words");
        assert!(said.matches(". ").count() == 1 && said.ends_with('.'), "{said}");
        let name = machine["name"].as_str().expect("a name");
        let task = stillbase::session::scenario::Scenario::builtin(name).expect("a task of its own");
        assert_eq!(task.machine.name(), name);
    }
}

#[test]
fn check_reports_table_1_as_printed_and_re_solved() {
    let (printed, want) = (object(&["check", "nine-link-table-1"]), &planning()["table_1"]);
    assert_eq!(
        keys(&printed),
        [
            "coupling_coefficients",
            "d",
            "force_balanced",
            "gamma_coefficients",
            "h",
            "integrable",
            "invariant",
            "lambda",
            "machine",
            "mass",
            "pose_constant"
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
        let measures = ["added_inertia", "added_mass", "mass_inertia_factor"];
        let mut all =
            [&["com", "coupling_coefficients", "d", "gamma_coefficients", "h", "lambda"], &measures[..]].concat();
        all.sort_unstable();
        assert_eq!(keys(&by_name), all);
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
    refused("link.5.mass=NaN", &["mass of link 5 (link.5.mass) is not a number", "want a finite number, kg"]);
    refused("link.5.mass=-1", &["link.5.mass) is -1", "want 1e-15 to 1000000 kg"]);
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
    damage("mass = 1.45", "mass = nan", &["mass of link 2 (link.2.mass) is not a number"]);
    damage("mass = 1.45", "mass = -1.45", &["(link.2.mass) is -1.45", "1e-15 to 1000000 kg"]);
    damage("mass = 1.45", "weight = 1.45", &["link 2 has no key \"weight\": want mass of link 2"]);
    damage("mass = 1.45", "mass = ", &[]);
    damage(
        "[[closure]]\na = { link = \"4\"",
        "[[closure]]\na = { link = \"6\"",
        &["closure 1: ", "parallelogram that closes"],
    );
    damage("attach = { link = \"3\"", "attach = { link = \"6\"", &["link.6.attach", "hangs on itself"]);
    damage(
        "drive = \"3\"\nattach = \"base\"",
        "drive = \"4\"\nattach = \"base\"",
        &["drive \"4\"", "\"1\", \"2\", \"3\""],
    );
    let end = NINE_LINK.find("[end_effector]").expect("end effector");
    let angles = NINE_LINK.find("# Relative joint angles").expect("angles");
    check(&[&NINE_LINK[..end], &NINE_LINK[angles..]].concat(), &["arm.toml: no end effector", "want [end_effector]"]);
    check(&NINE_LINK.replacen("com = 0.20158885517910255\n", "", 1), &["arm.toml:", "(link.4.com) is missing"]);
    check("\u{0}", &["arm.toml:1:"]);
}

/// All faults of a file are told, in words and as JSON, by every command that reads the file.
#[test]
fn all_faults_of_a_file_are_told() {
    let folder = Folder::new("cli");
    let wrong = NINE_LINK.replacen("mass = 1.45", "mass = -1.45", 1).replacen("[lengths]", "colour = 1\n[lengths]", 1);
    let file = word(folder.file("arm.toml", &wrong));
    for command in [&["check"][..], &["simulate"], &["design"], &["workspace", "--b", "2.4"]] {
        let args = [&command[..1], &[file.as_str()], &command[1..]].concat();
        fails(&args, 2, &["arm.toml: 2 faults", "the file has no key \"colour\"", "mass = 1.2"]);
    }
    let out = stillbase(&["check", &file, "--json"]);
    let got: Value = serde_json::from_slice(&out.stdout).expect("JSON");
    assert!(got["reason"].as_str().is_some_and(|why| why.contains("(one of 2 faults)")), "{got}");
    let fault = &got["faults"][1];
    assert!(fault["key"] == "link.2.mass" && fault["example"] == "mass = 1.2" && fault["column"] == 1, "{got}");
    assert_eq!(
        fault["line"].as_u64(),
        wrong.find("mass = -1.45").map(|at| wrong[..at].matches('\n').count() as u64 + 1)
    );
    // What a file of nothing shows is a machine.
    let empty = word(folder.file("empty.toml", ""));
    let out = stillbase(&["check", &empty, "--json"]);
    let got: Value = serde_json::from_slice(&out.stdout).expect("JSON");
    let example = got["faults"][0]["example"].as_str().expect("an example").to_owned();
    prints(&["check", &word(folder.file("smallest.toml", example))]);
}

/// A model of another program is a machine for every command, and what it leaves out is told.
#[test]
fn models_of_other_programs_are_machines() {
    let folder = Folder::new("cli");
    for ending in ["urdf", "xml"] {
        let file = word(folder.path(&format!("arm.{ending}")));
        let out = stillbase(&["export-model", "scara", "-o", &file, "--json"]);
        let got: Value = serde_json::from_slice(&out.stdout).expect("JSON");
        let left_out = got["left_out"].as_array().expect("a list").clone();
        assert!(!left_out.is_empty());
        for what in left_out {
            assert!(text(&out.stderr).contains(what.as_str().expect("words")), "{what}");
        }
        let own: Value = serde_json::from_slice(&stillbase(&["check", "scara", "--json"]).stdout).expect("JSON");
        let got: Value = serde_json::from_slice(&stillbase(&["check", &file, "--json"]).stdout).expect("JSON");
        let mass = |of: &Value| of["mass"].as_f64().expect("a mass");
        assert!((mass(&own) - mass(&got)).abs() < 1e-9 * mass(&own), "{ending}");
    }
    let bad = word(folder.file("bad.urdf", "<robot name=\"x\"><link name=\"a\"/></robot>"));
    fails(&["check", &bad], 2, &["bad.urdf"]);
}

/// A scenario whose machine is being drawn says what is missing, and what would mend it.
#[test]
fn an_incomplete_drawing_lists_what_is_missing() {
    let folder = Folder::new("cli");
    let scenario = "machine = \"nine-link\"\n[task]\nkind = \"reactionless\"\nfrom = [0.50, 0.50]\nto = [0.55, 0.90]\n\
                    b = 2.4\ntime = 1.0\n";
    let blank = "[[edit]]\nstep = 0\ndo = \"sketch\"\ndraw = \"new\"\ntemplate = \"blank\"\n\
                 [[edit]]\nstep = 0\ndo = \"sketch\"\ndraw = \"bar\"\nfrom = { pin = 0 }\nto = [0.3, 0.1]\n";
    let drawn = word(folder.file("drawn.toml", format!("{scenario}{blank}")));
    let words = [
        "the drawing is no machine yet; still missing: no motor turns bar 1 yet (hang a motor that turns bar 1)",
        "no end effector yet (place",
    ];
    fails(&["check", &drawn], 1, &words);
    // Nothing is said of the machine before.
    let words = ["the drawing \"my arm\" is no machine yet: no motor turns bar 1 yet, and 1 more"];
    fails(&["simulate", &drawn], 1, &words);
    fails(&["headless", &drawn, "-o", &word(folder.path("drawn.rrd"))], 1, &words);
    // One that is complete is checked as the machine that it is.
    let template = "[[edit]]\nstep = 0\ndo = \"sketch\"\ndraw = \"new\"\ntemplate = \"pantograph\"\n";
    let whole = word(folder.file("whole.toml", format!("{scenario}{template}")));
    assert_eq!(object(&["check", &whole])["mass"], object(&["check", "pantograph"])["mass"]);
}

/// Every template is a machine that a file can hold, and `machines` writes it.
#[test]
fn a_template_is_a_machine_to_begin_with() {
    let folder = Folder::new("templates");
    let listed = object(&["machines"])["templates"].clone();
    let names: Vec<&str> = listed.as_array().expect("a list").iter().filter_map(|row| row["name"].as_str()).collect();
    assert_eq!(names.len(), 6, "all but the blank one: {names:?}");
    for name in names {
        let file = word(folder.path(&format!("{name}.toml")));
        prints(&["machines", name, "-o", &file]);
        assert_eq!(object(&["check", &file])["mass"], object(&["check", name])["mass"]);
        assert_eq!(prints(&["machines", &file]), fs::read_to_string(&file).expect("a file"));
    }
    fails(&["machines", "pantograf"], 2, &["pantograph (nearest)"]);
    fails(&["machines", "-o", &word(folder.path("x.toml"))], 2, &["want the name of a machine"]);
}

/// Everything that a part lacks is told at once, with examples in the names of the file.
#[test]
fn parts_tell_all_that_they_lack() {
    let folder = Folder::new("parts");
    let file = folder.file(
        "arm.toml",
        r#"
name = "arm"
drive = [{ name = "q1" }]
link = [{ name = "upper", drive = "q1", attach = "base", length = 0.5 }]
end_effector = { link = "upper", at = "tip" }
part = [
    { link = "upper", material = "steel", shape = "flat" },
    { link = "upper", material = "steel", shape = "pipe" },
    { link = "upper", material = "steel", shape = "profile" },
    { link = "upper", material = "steel", shape = "plate" },
    { link = "upper", material = "steel", shape = "plate", thickness = 0.006, polygon = [[0, 0], [1, 0], [1, 1], [0, 0]] },
]
lump = [{ mass = 0.3, at = "end" }]
counterweight = [{ mass = 0.3, at = -0.1 }]
"#,
    );
    let out = stillbase(&["check", &word(file)]);
    let said = text(&out.stderr);
    for lacks in [
        "width of part 1",
        "thickness of part 1",
        r#"is "pipe": want one of flat, tube, profile, plate"#,
        "width of part 3",
        "height of part 3",
        "wall of part 3",
        "thickness of part 4",
        "corners of part 4",
        "corners 1 and 4 are one point",
        "link that carries lump 1",
        r#"names the length "end", which does not exist: want "tip", "root", or a number in m"#,
        "link that carries counterweight 1",
        r#"link = "upper""#,
    ] {
        assert!(said.contains(lacks), "{lacks:?} in {said}");
    }
    assert!(said.contains("12 faults") && !said.contains(r#"link = "1""#) && !said.contains("part 2 is"), "{said}");
}

/// Two drives have no plane of (a1, a2): the questions about planes have no answer, the others do.
#[test]
fn a_machine_of_two_drives_has_a_curve_once_it_is_balanced() {
    let folder = Folder::new("cli");
    let file = word(folder.file("two.toml", TWO_LINK));
    let balance = object(&["check", &file]);
    assert_eq!(balance["coupling_coefficients"].as_array().map(Vec::len), Some(1));
    let designed = object(&["design", &file]);
    assert_eq!(numbers(&designed["com"]).len(), 2);
    fails(&["design", &file, "--preset", "table-1"], 2, &["9 penalties for 2 links"]);
    fails(&["design", &file, "--penalty", "1,-1"], 2, &["'-1'", "1e-6 to 1e6"]);
    let why = ["no pose constant b", "drives 1 and 2", "0.0600 kg m²", "link forearm", "design finds"];
    fails(&["reach", &file, "0.5,0.5"], 1, &why);
    fails(&["pose", &file, "0.5,0.5", "--b", "1"], 1, &why);
    fails(&["workspace", &file, "--b", "1"], 1, &why);
    let balanced = word(folder.file("balanced.toml", ""));
    prints(&["design", &file, "-o", &balanced, "--force"]);
    // A point has a b for each elbow, and there a pose of its own; between them there is none.
    let reach = object(&["reach", &balanced, "0.3,0.4"]);
    let intervals = reach["points"][0]["intervals"].as_array().expect("a list");
    assert_eq!(intervals.len(), 2);
    for interval in intervals {
        let [low, high] = [0, 1].map(|i| interval[i].as_f64().expect("a number"));
        assert_eq!(low, high);
        let poses = object(&["pose", &balanced, "0.3,0.4", "--b", &low.to_string()]);
        assert_eq!(poses["poses"].as_array().map(Vec::len), Some(1));
    }
    fails(&["pose", &balanced, "0.3,0.4", "--b", "1"], 1, &["outside the reactionless workspace"]);
    let workspace = object(&["workspace", &balanced, "--b", "1"]);
    let curve = workspace["curve"].as_array().expect("points");
    let length: f64 = curve
        .windows(2)
        .map(|w| {
            let [a, b] = [&w[0], &w[1]].map(numbers);
            (b[0] - a[0]).hypot(b[1] - a[1])
        })
        .sum();
    near(&workspace["length"], &json!(length), 1e-4, "length");
    assert_eq!(workspace["area"], json!(0.0));
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

const BARE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reference/family/nine-link-bare.toml");

/// Every link from 0.30 m behind its root to its tip.
fn anywhere() -> Vec<String> {
    let tips = [0.5, 0.18, 0.2, 0.5, 0.46, 0.5, 0.2, 0.46, 0.3];
    tips.iter().enumerate().map(|(j, tip)| format!("--range={}=-0.3,{tip}", j + 1)).collect()
}

#[test]
fn counterweights_are_placed_written_and_counted_in() {
    let (folder, ranges) = (Folder::new("counterweights"), anywhere());
    let file = word(folder.path("balanced.toml"));
    let mut args = vec!["design", BARE, "--counterweights", "-o", &file];
    args.extend(ranges.iter().map(String::as_str));
    let light = object(&args);
    assert!((light["added_mass"].as_f64().expect("kg") - 9.572_666_7).abs() < 1e-6);
    assert!(light["gap"].as_f64().expect("a gap") < 1e-6);
    let weights = light["weights"].as_array().expect("a list");
    let mass: f64 = weights.iter().map(|w| w["mass"].as_f64().expect("kg")).sum();
    assert!((mass - 9.572_666_7).abs() < 1e-6);
    // Another command reads the file and finds the same, in balance.
    let checked = object(&["check", &file]);
    assert_eq!((&checked["force_balanced"], &checked["invariant"]), (&true.into(), &true.into()));
    assert_eq!(numbers(&checked["d"]), numbers(&light["d"]));
    let mut words = vec!["design", BARE, "--counterweights", "--objective", "inertia", "--front", "3"];
    words.extend(ranges.iter().map(String::as_str));
    let quick = object(&words);
    assert!((numbers(&quick["d"]).iter().sum::<f64>() - 1.798_401_1).abs() < 1e-6);
    assert_eq!(quick["front"].as_array().expect("a front").len(), 3);
}

/// Each design of a study is the one that is found alone, parts are the whole, and the best are those that no other beats.
#[test]
fn designs_of_a_study_are_those_found_alone() {
    let folder = Folder::new("designs");
    let study = ["design", BARE, "--counterweights", "--max-mass", "9"];
    let vary =
        ["--vary", "length.l5=0.3:0.6:4", "--vary", "material=steel,tungsten", "--vary", "payload.mass=0,0.4,40"];
    let named = |name: &str| word(folder.path(name));
    let [csv, parquet] = [named("all.csv"), named("all.parquet")];
    let all = object(&[&study[..], &vary, &["--table", &csv]].concat());
    assert_eq!((&all["points"], &all["shard"]), (&json!(24), &json!([0, 24])));
    // The heaviest payload cannot be balanced by 9 kg a link.
    assert_eq!((&all["found"], &all["refused"]), (&json!(16), &json!(8)));
    assert!(all["reasons"][0]["point"] == 2 && all["reasons"][0]["why"].as_str().is_some_and(|why| why.contains("9")));
    for best in all["best"].as_array().expect("a list") {
        let options: Vec<&str> = best["options"].as_str().expect("options").split(' ').collect();
        let alone = object(&[&study[..], &options].concat());
        near(&best["added_mass"], &alone["added_mass"], 1e-12, "added mass");
        assert_eq!(best["certified"], alone["certified"]);
        assert!(best["relative_gap"].as_f64().is_some_and(|gap| gap < 1e-6));
    }
    let text = std::fs::read_to_string(&csv).expect("there");
    let rows: Vec<Vec<String>> = text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
    assert!(rows[0].starts_with(&["outcome", "material", "point", "length.l5", "payload.mass"].map(String::from)));
    assert_eq!(rows.len(), 25);
    // No design in the table is better in both than one that is told.
    let measures = |row: &Vec<String>| Some([row.get(5)?.parse::<f64>().ok()?, row.get(6)?.parse::<f64>().ok()?]);
    let designs: Vec<[f64; 2]> = rows.iter().filter(|row| row[0] == "found").filter_map(measures).collect();
    assert_eq!(designs.len(), 16);
    for best in all["best"].as_array().expect("a list") {
        let [mass, inertia] = ["added_mass", "inertia"].map(|key| best[key].as_f64().expect("a number"));
        assert!(designs.iter().all(|[m, d]| *m > mass * (1.0 - 1e-9) && *d >= inertia || *m > mass || *d > inertia));
        assert!(!designs.iter().any(|[m, d]| *m < mass * (1.0 - 1e-9) && *d < inertia));
    }
    // Parts stand one below the other.
    let parts: Vec<String> = (["1/2", "2/2"].iter().zip(["1.csv", "2.csv"]))
        .map(|(shard, name)| {
            let file = named(name);
            object(&[&study[..], &vary, &["--shard", shard, "--table", &file]].concat());
            std::fs::read_to_string(&file).expect("there")
        })
        .collect();
    let below = parts[1].split_once('\n').expect("a head").1;
    assert!(format!("{}{below}", parts[0]) == text);
    // Points that fill ranges, in Parquet, with the front of each.
    let fronts = ["--vary", "length.l5=0.3:0.6", "--vary", "thickness=0.01:0.04", "--points", "5", "--front", "3"];
    let filled = object(&[&study[..], &fronts, &["--table", &parquet]].concat());
    assert!(filled["found"] == 5 && filled["best"].as_array().is_some_and(|all| all.len() > 3));
    assert!(filled["best"].as_array().expect("a list").iter().all(|best| best["certified"] == true));
    // Options of the search vary, too; each design is found alone by what is said.
    let [study, vary] = [
        &["design", BARE, "--counterweights"][..],
        &["--vary", "clearance=0,0.01", "--vary", "max-mass=2,4,9", "--vary", "objective=mass,inertia"],
    ];
    let options = object(&[study, vary].concat());
    assert_eq!((&options["points"], &options["found"], &options["refused"]), (&json!(12), &json!(8), &json!(4)));
    for best in options["best"].as_array().expect("a list") {
        let typed: Vec<&str> = best["options"].as_str().expect("options").split(' ').collect();
        let alone = object(&[study, &typed].concat());
        near(&best["added_mass"], &alone["added_mass"], 1e-12, "added mass");
        assert_eq!((&best["certified"], &alone["certified"]), (&json!(true), &json!(true)));
    }
    for (more, status, words) in [
        (&["--vary", "max-mass=2,x"][..], 2, "max-mass: want a number"),
        (&["--vary", "max-mass=2,3", "--max-mass", "1=4"], 2, "by another option"),
        (&["--vary", "objective=price"], 2, "objective"),
        (&["--vary", "objective=mass=1,inertia=5"], 2, "a weighted sum cannot vary"),
        (&["--vary", "objective=1:2", "--points", "3"], 2, "objective"),
        (&["--vary", "objective=mass,inertia", "--front", "3"], 2, "want no --front"),
        (&["--vary", "design.clearance=0.01,0.02"], 2, "design.clearance: no setting"),
        (&["--vary", "clearance=0.01:0.02:2", "--clearance", "0.1"], 2, "by another option"),
    ] {
        fails(&[study, more].concat(), status, &[words]);
    }
    let study = ["design", BARE, "--counterweights", "--max-mass", "9"];
    for (more, status, words) in [
        (&["--vary", "length.l5=0.3:0.6"][..], 2, "--points"),
        (&["--vary", "length.l5=0.6:0.3:4"], 2, "LO:HI"),
        (&["--vary", "length.nowhere=1,2"], 2, "length.nowhere"),
        (&["--vary", "payload.mass=400,500", "--table", &named("none.csv")], 1, "none of 2 points has a design"),
        (&["--vary", "material=cheese"], 2, "want a density"),
        (&["--vary", "lenght.l5=0.3,0.4"], 2, "lenght.l5: no setting"),
        (&["--vary", "material=steel", "--material", "lead"], 2, "by another option"),
        (&["--vary", "payload.mass=0,0.1", "--set", "payload.mass=0.1"], 2, "by another option"),
        (&["--vary", "payload.mass=0,0.1", "--length", "l5=0.3,0.4"], 2, "--length"),
        (&["--vary", "payload.mass=0,0.1", "--vary", "payload.mass=0.2"], 2, "varies twice"),
    ] {
        fails(&[&study[..], more].concat(), status, &[words]);
    }
    // Why there is none is kept, so that this part is complete.
    assert_eq!(std::fs::read_to_string(folder.path("none.csv")).expect("there").lines().count(), 3);
}

#[test]
fn fronts_of_several_machines_are_those_of_each_alone() {
    let bounds = ["--counterweights", "--max-mass", "9", "--task", "case-3", "--front", "4"];
    let called = [BARE, "two-drive", "serial-3r", BARE];
    let all = object(&[&["design"], &called[..], &bounds[..]].concat());
    assert_eq!(keys(&all), ["fronts"]);
    let fronts = all["fronts"].as_array().expect("a list");
    let names: Vec<&str> = fronts.iter().filter_map(|front| front["machine"].as_str()).collect();
    assert_eq!(names, ["nine-link-bare", "two-drive", "serial-3r", "nine-link-bare-2"]);
    for (front, name) in fronts.iter().zip(called) {
        // Of another number of drives the task says nothing.
        let bounds =
            if name == "two-drive" { &["--counterweights", "--max-mass", "9", "--front", "4"] } else { &bounds[..] };
        let alone = object(&[&["design", name], bounds].concat());
        assert_eq!((&front["front"], &front["front_points"]), (&alone["front"], &alone["front_points"]), "{name}");
        assert_eq!(keys(front), ["front", "front_points", "machine"]);
    }
    let table = prints(&[&["design", BARE, "two-drive"], &bounds[..]].concat());
    assert!(table.starts_with("machine") && table.matches("\nnine-link-bare ").count() == 4, "{table}");
    // It is balanced as it is: there is nothing to choose.
    assert_eq!(table.matches("\ntwo-drive ").count(), 1, "{table}");
}

#[test]
fn a_machine_without_a_front_says_why_beside_the_others() {
    let line = ["design", BARE, "two-drive", "--counterweights", "--max-mass", "2", "--front", "3"];
    let all = object(&line);
    assert_eq!(keys(&all["fronts"][0]), ["machine", "refused"]);
    assert!(all["fronts"][0]["refused"].as_str().expect("why").contains("no heavier"), "{all}");
    assert_eq!(all["fronts"][1]["front"].as_array().map(Vec::len), Some(1));
    assert!(prints(&line).contains("\nnine-link-bare: no counterweights balance these links"));
    let ask = |more: &[&str], status: i32, words: &[&str]| {
        fails(&[&["design", BARE, "two-drive", "--counterweights"], more].concat(), status, words);
    };
    let none = ["design", BARE, BARE, "--counterweights", "--front", "3", "--max-mass", "0.01"];
    fails(&none, 1, &["none of these can be balanced", "nine-link-bare: no counterw"]);
    ask(&["--front", "3", "--thickness", "0"], 2, &["nine-link-bare: thickness 0: want 0.0001 to 1 m"]);
    ask(&["--front", "3", "--range", "9=-0.3,0"], 2, &["two-drive: no link 9"]);
    ask(&["--front", "3", "--set", "link.9.mass=0.3"], 2, &["two-drive: --set"]);
    ask(&["--front", "3", "--task", "four-drive"], 2, &["its machine has 4 drives: want one of 3 or 2"]);
    ask(&["--front", "3", "--objective", "mass"], 2, &["--objective"]);
    ask(&["--front", "3", "-o", "a.toml"], 2, &["--output"]);
    ask(&[], 2, &["--front"]);
}

#[test]
fn counterweights_that_cannot_be_are_refused() {
    let ask = |more: &[&str], status: i32, words: &[&str]| {
        fails(&[&["design", BARE, "--counterweights"], more].concat(), status, words);
    };
    ask(&["--max-mass", "1"], 1, &["no heavier", "kg on each link that is bounded would do"]);
    ask(&["--range", "10=-0.3,0"], 2, &["no link 10", "want one of 1, 2"]);
    ask(&["--range", "1=-0.3"], 2, &["NAME=LO,HI"]);
    ask(&["--range", "1=0.3,-0.3"], 2, &["link 1", "an end not below its start"]);
    ask(&["--range", "1=-0.3,0", "--range", "1=-0.2,0"], 2, &["link 1", "want one a link"]);
    ask(&["--max-mass", "1=-2"], 2, &["--max-mass 1=-2", "want a mass above 0"]);
    ask(&["--thickness", "0"], 2, &["thickness 0: want 0.0001 to 1 m"]);
    ask(&["--max-inertia", "1.5"], 1, &["Σ D_k up to 1.681167 kg m² would do"]);
    // As printed it does.
    object(&["design", BARE, "--counterweights", "--max-inertia", "1.681167"]);
    ask(&["--max-added", "5"], 1, &["kg in all would do"]);
    ask(&["--clearance", "0.25"], 1, &["0.25 m clear of every pin", "m would do"]);
    ask(&["--clearance=-1"], 2, &["clearance -1: want 0 to 1000 m"]);
    ask(&["--material", "cheese"], 2, &["want a density in kg/m³, or aluminium, steel"]);
    ask(&["--material", "-1"], 2, &["density -1: want 1 to 100000 kg/m³"]);
    let weights =
        |material: &str| object(&["design", BARE, "--counterweights", "--material", material])["weights"].clone();
    assert_eq!(weights("Lead"), weights("11340"));
    ask(&["--length", "l9=0.2,0.4", "--seconds", "0"], 2, &["--seconds 0: want a time above 0"]);
    ask(&["--length", "l0=0.2,0.4"], 2, &["no length l0: want one of l1, l2, l3, l5, l9"]);
    let sought = object(&[
        "design",
        BARE,
        "--counterweights",
        "--length",
        "l9=0.2,0.4",
        "--min-reach",
        "1.2",
        "--seconds",
        "0.2",
        "--starts",
        "1000",
    ]);
    assert!(sought["sought"]["starts"].as_u64().expect("a number") < 1000 && sought["sought"]["certified"] == false);
    ask(&["--max-radius", "0"], 2, &["want a radius above 0"]);
    ask(&["--payload", "0.3,0.1"], 2, &["a payload up to 0.1", "not below its start"]);
    ask(&["--rotor-ratio", "1=-30,0"], 2, &["drive 1 has no rotor", "drive.1.rotor.inertia"]);
    ask(&["--rotor-inertia", "7=0,1"], 2, &["no drive 7: want one of 1, 2, 3"]);
    ask(&["--objective", "speed"], 2, &["want mass, inertia"]);
    ask(&["--objective", "torque"], 2, &["the torque depends on the motion", "--task"]);
    ask(&["--objective", "torque", "--task", "nowhere"], 2, &["nowhere"]);
    ask(&["--task", "two-drive"], 2, &["--task two-drive: its machine has 2 drives: want one of 3"]);
    ask(&["--objective", "mass=0"], 2, &["want mass, inertia"]);
    fails(&["design", BARE, "--range", "1=-0.3,0"], 2, &["--counterweights"]);
}

/// What is taken off is said, by link; what is fixed stays, and the rest is balanced beside it.
#[test]
fn counterweights_that_are_fixed_stay_and_others_are_named() {
    let folder = Folder::new("fixed");
    let bare = fs::read_to_string(BARE).expect("a file");
    let two = "[[counterweight]]\nlink = \"2\"\nmass = 0.8\nat = -0.1\n\
               [[counterweight]]\nlink = \"4\"\nmass = 0.6\nat = 0.0\nradius = 0.04\nfixed = true\n";
    let (file, out) = (word(folder.file("motor.toml", bare + two)), word(folder.path("out.toml")));
    let run = stillbase(&["design", &file, "--counterweights", "-o", &out, "--json"]);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(
        run.status.success() && said.contains("taken off") && said.contains("0.8 kg at -0.1 m of link 2"),
        "{said}"
    );
    assert!(!said.contains("link 4"), "{said}");
    let answer: Value = serde_json::from_slice(&run.stdout).expect("an object");
    assert_eq!(answer["taken_off"], json!([{ "link": "2", "mass": 0.8, "at": -0.1 }]));
    let added: f64 =
        answer["weights"].as_array().expect("a list").iter().map(|w| w["mass"].as_f64().expect("kg")).sum();
    assert!((answer["added_mass"].as_f64().expect("kg") - added).abs() < 1e-9, "what is fixed was there before");
    let made = stillbase::files::machine(&out, None).expect("a machine");
    let fixed: Vec<_> = made.spec().counterweights.iter().filter(|weight| weight.fixed).collect();
    assert_eq!(fixed.len(), 1);
    assert_eq!((fixed[0].link.as_str(), fixed[0].mass, fixed[0].at, fixed[0].radius), ("4", 0.6, 0.0, 0.04));
    assert_eq!(object(&["check", &out])["invariant"], true);
    // Nothing is taken off where nothing may be.
    let again = stillbase(&["design", &file, "--set", "counterweight.1.fixed=true", "--counterweights", "--json"]);
    assert!(!String::from_utf8_lossy(&again.stderr).contains("taken off"));
    assert!(serde_json::from_slice::<Value>(&again.stdout).expect("an object").get("taken_off").is_none());
}

/// What would do with bounds of two kinds does, typed back as it is printed.
#[test]
fn what_would_do_with_two_bounds_does_as_printed() {
    let refused = stillbase(&["design", BARE, "--counterweights", "--max-mass", "0.8", "--max-added", "5"]);
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    let number = |before: &str, after: &str| {
        let end = said.find(after).unwrap_or_else(|| panic!("{said}"));
        let start = said[..end].rfind(before).unwrap_or_else(|| panic!("{said}")) + before.len();
        said[start..end].to_owned()
    };
    let (most, all) = (number("up to ", " kg on each link"), number("up to ", " kg in all would do together"));
    object(&["design", BARE, "--counterweights", "--max-mass", &most, "--max-added", &all]);
}

/// Least torque of a task is less than with the least mass, and as the solver says; β measures both beside bare links.
#[test]
fn torque_of_a_task_is_least_and_beta_says_what_is_left() {
    let ranges = anywhere();
    let ask = |objective: &str| {
        let mut words = vec!["design", BARE, "--counterweights", "--objective", objective, "--task", "case-3"];
        words.extend(ranges.iter().map(String::as_str));
        object(&words)
    };
    let (light, quick) = (ask("mass"), ask("torque"));
    // Quintic along a straight joint line in 1 s: |q̈_k| = 5.7735 |Δq_k|, and H_kk = D_k without gears.
    let turned =
        [1.507_474_369_2 - 1.687_518_217_9, 4.217_709_207_3 - 3.714_622_368_2, 3.128_747_376_0 - 2.180_176_989_7];
    let torque = |of: &Value| {
        let all = numbers(&of["h"]).into_iter().zip(turned).map(|(h, turn): (f64, f64)| h * 5.773_502_692 * turn.abs());
        all.fold(0.0_f64, f64::max)
    };
    assert!(torque(&quick) < 0.99 * torque(&light), "{} {}", torque(&quick), torque(&light));
    for of in [&light, &quick] {
        let beta = &of["beta"];
        let [force, moment] = ["force", "moment"].map(|what| beta[what].as_f64().expect("a ratio"));
        assert!(force < 1e-9 && moment > 0.0 && beta["torque"].as_f64().expect("a ratio") > 0.0, "{beta}");
        // M/M_bare + ΣD/ΣD_bare, with 3.68 kg bare.
        let (mass, inertia) = (of["added_mass"].as_f64().expect("kg"), of["added_inertia"].as_f64().expect("kg m²"));
        let now: f64 = numbers(&of["d"]).iter().sum();
        let want = (3.68 + mass) / 3.68 + now / (now - inertia);
        assert!((of["mass_inertia_factor"].as_f64().expect("a number") - want).abs() < 1e-9);
    }
    let same = object(&["design", "nine-link", "--keep", "--task", "case-3"]);
    let factor = same["mass_inertia_factor"].as_f64().expect("a number");
    assert!((factor - 2.0).abs() < 1e-9 && (same["beta"]["torque"].as_f64().expect("a ratio") - 1.0).abs() < 1e-9);
}

#[test]
fn a_machine_is_kept_balanced_and_written() {
    let folder = Folder::new("kept");
    let file = word(folder.path("kept.toml"));
    let mut words = vec!["design", "nine-link", "--set", "link.5.com=-0.05", "--keep", "--fix", "5.com"];
    words.extend(["--bound", "2.com=-0.3,0.1", "--free", "link.2.mass", "-o", &file]);
    let kept = object(&words);
    let checked = object(&["check", &file]);
    assert_eq!((&checked["force_balanced"], &checked["invariant"]), (&true.into(), &true.into()));
    assert_eq!(numbers(&checked["d"]), numbers(&kept["d"]));
    let changes = kept["changes"].as_array().expect("a list");
    let of = |key: &str| changes.iter().find(|c| c["key"] == key).unwrap_or_else(|| panic!("no {key}: {kept}"));
    assert_eq!((of("link.5.com")["to"].as_f64(), changes.len()), (Some(-0.05), 10));
    assert!((-0.3..=0.1).contains(&of("link.2.com")["to"].as_f64().expect("m")));
    assert!(of("link.2.mass")["unit"] == "kg" && kept["cost"].as_f64().expect("a number") > 0.0);
    let text = prints(&words[..words.len() - 2]);
    assert!(text.contains("the least change, preset table-1") && text.contains("link.2.mass"), "{text}");
    // A counterweight takes part by its number.
    let carried =
        fs::read_to_string(&file).expect("a file") + "[[counterweight]]\nlink = \"1\"\nmass = 0.5\nat = -0.2\n";
    let heavy = word(folder.path("carried.toml"));
    fs::write(&heavy, carried).expect("written");
    let kept = object(&["design", &heavy, "--keep", "--free", "counterweight.1.mass,counterweight.1.at"]);
    assert_eq!(kept["changes"].as_array().expect("a list").len(), 11);
    let ask = |more: &[&str], status: i32, words: &[&str]| {
        fails(&[&["design", "nine-link", "--set", "payload.mass=0.3"], more].concat(), status, words);
    };
    ask(
        &["--keep", "--fix", "2.com,4.com,5.com,8.com"],
        1,
        &["no balance within these limits: link.2.com stays", "would do"],
    );
    ask(
        &["--keep", "--bound", "8.com=-0.1,0.1", "--bound", "9.com=-0.02,0.1"],
        1,
        &["link.8.com at most 0.1; link.9.com"],
    );
    ask(&["--keep", "--fix", "10.com"], 2, &["\"10.com\"", "want mass, com"]);
    ask(&["--keep", "--fix", "1.com", "--free", "1.com"], 2, &["1.com is held in two ways"]);
    ask(&["--keep", "--bound", "1.com=0.3,0.2"], 2, &["link.1.com", "no less than 0.3"]);
    ask(&["--keep", "--bound", "1.com=0.3"], 2, &["KEY=LO,HI"]);
    ask(&["--fix", "1.com"], 2, &["--keep"]);
}

#[test]
fn a_model_is_written_and_not_overwritten() {
    let folder = Folder::new("model");
    let file = word(folder.path("arm.xml"));
    let answer = object(&["export-model", "serial-3r", "--pose", "1.2,0.1,-0.8", "-o", &file]);
    assert_eq!(keys(&answer), ["file", "left_out", "pose", "qpos"]);
    assert_eq!(numbers(&answer["pose"]), [1.2, 0.1, -0.8]);
    assert_eq!(numbers(&answer["qpos"]).len(), 6, "three links, three rotors");
    let model = fs::read_to_string(&file).expect("a file");
    assert!(model.starts_with("<mujoco model=\"serial-3r\">") && model.trim_end().ends_with("</mujoco>"));
    fails(&["export-model", "serial-3r", "-o", &file], 2, &[&file, "--force"]);
    assert!(prints(&["export-model", "nine-link", "-o", &file, "--force"]).contains("9 hinges"));
    fails(&["export-model", "nine-link", "--pose", "1,2", "-o", &file, "--force"], 2, &["want 3"]);
    fails(&["export-model", "nine-link", "--pose", "1,2,nan", "-o", &file, "--force"], 2, &["finite"]);
    fails(&["export-model", "nine-link", "-o", "arm.mjcf"], 2, &[".xml"]);
}

/// A model begins where its scenario does; one of a machine alone says which base is left out.
#[test]
fn a_model_begins_as_its_scenario() {
    let folder = Folder::new("model-start");
    let file = word(folder.path("craft.xml"));
    let pose = |args: &[&str]| numbers(&object(&[args, &["-o", &file, "--force"]].concat())["pose"]);
    let start = pose(&["export-model", "ets-vii-silent"]);
    let stated = [0.740892645732, 1.082952357468, -0.942477796077];
    assert_eq!(start, stated);
    assert_eq!(pose(&["export-model", "spot", "--base", "spot"]), [1.9, 2.6, 3.4]);
    // Another start of the same machine.
    assert_ne!(pose(&["export-model", "spot", "--base", "spot-swing"]), [1.9, 2.6, 3.4]);
    // A plan without a stated start begins somewhere, too: on case 3, where a plan finds it.
    let answer = object(&["plan", "case-3"]);
    let planned = numbers(&answer["q_start"]);
    assert!(pose(&["export-model", "case-3"]).iter().zip(&planned).all(|(a, b)| (a - b).abs() < 1e-12));
    let said = |args: &[&str]| text(&stillbase(args).stderr).to_owned();
    let note = said(&["export-model", "spot", "-o", &file, "--force"]);
    assert!(note.contains("--base spot gives it the one of the scenario spot, which floats"), "{note}");
    assert!(!said(&["export-model", "nine-link", "-o", &file, "--force"]).contains("floats"));
    // A model whose base floats is planned on a base that is held.
    object(&["export-model", "spot", "--base", "spot", "-o", &file, "--force"]);
    let note = said(&["plan", &file, "0.3,0.5", "0.35,0.5"]);
    assert!(note.contains("planned on a base that is held"), "{note}");
}

/// A plan from a stated pose states no b, which such a machine may not have, and comes back.
#[test]
fn a_plan_from_a_pose_states_no_b() {
    let folder = Folder::new("plan-pose");
    let file = word(folder.path("own.toml"));
    let answer = object(&["plan", "spot", "-o", &file]);
    let written = fs::read_to_string(&file).expect("a file");
    assert!(!written.contains("\nb = ") && !written.contains("from = ") && written.contains("start = "), "{written}");
    assert_eq!(object(&["plan", &file])["q_end"], answer["q_end"]);
    // On a base that floats, balance is not asked for.
    prints(&["check", "spot-swing", "--strict"]);
    let out = stillbase(&["check", "spot", "--strict"]);
    assert!(out.status.code() == Some(1) && text(&out.stderr).contains("not force balanced"));
}

#[test]
fn a_machine_comes_from_elsewhere() {
    let folder = Folder::new("from-elsewhere");
    let file = |name: &str| word(folder.path(name));
    for model in ["arm.urdf", "arm.xml"] {
        prints(&["export-model", "serial-3r", "-o", &file(model)]);
        let out = file("arm.toml");
        let answer = object(&["import-model", &file(model), "-o", &out, "--force"]);
        let known = ["drives", "file", "force_balanced", "invariant", "links", "mass", "notes", "pose"];
        assert_eq!(keys(&answer), known, "{model}");
        assert_eq!(answer["drives"], serde_json::json!(["1", "2", "3"]));
        assert_eq!(answer["invariant"], true, "{model}: balance survives the way there and back");
        let [own, other] = ["serial-3r", &out].map(|machine| numbers(&object(&["check", machine])["lambda"]));
        assert!(own.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-9), "{own:?} {other:?}");
    }
    let table = prints(&["import-model", &file("arm.xml"), "--set", "link.2.mass=2.5"]);
    assert!(table.contains("3 drives · 3 links") && table.contains("force balanced: no"), "{table}");
    fails(&["import-model", &file("arm.xml"), "-o", &file("arm.toml")], 2, &["arm.toml", "--force"]);
    fails(&["import-model", &file("arm.xml"), "-o", &file("b.txt")], 2, &[".toml"]);
    let (one, same) = (file("both.toml"), file("./both.toml"));
    fails(&["import-model", &file("arm.xml"), "-o", &one, "--scenario", &same], 2, &["name one file"]);
    fails(&["import-model", &file("nowhere.urdf")], 2, &["nowhere.urdf", "can be read"]);
    let broken = fs::read_to_string(file("arm.urdf")).expect("a file").replacen("continuous", "prismatic", 1);
    fs::write(file("broken.urdf"), broken).expect("written");
    fails(
        &["import-model", &file("broken.urdf")],
        2,
        &["broken.urdf:", ": joint \"drive_1\"", "prismatic", "want revolute"],
    );
}

/// A base that weighs something is no part of a machine: it is said, and goes into a scenario that runs.
#[test]
fn a_base_from_elsewhere_goes_into_a_scenario() {
    let folder = Folder::new("base-from-elsewhere");
    let file = |name: &str| word(folder.path(name));
    prints(&["export-model", "serial-3r", "-o", &file("arm.urdf")]);
    let inertia = "<inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"3.5\"/>";
    let base = format!(
        "<link name=\"base\"><inertial><origin xyz=\"0.2 -0.1 0\"/><mass value=\"75\"/>{inertia}</inertial></link>"
    );
    let text = fs::read_to_string(file("arm.urdf")).expect("a file").replacen("<link name=\"base\"/>", &base, 1);
    fs::write(file("afloat.urdf"), text).expect("written");
    let answer = object(&["import-model", &file("afloat.urdf")]);
    assert_eq!(answer["base"], json!({ "mass": 75.0, "inertia": 3.5, "com": [0.2, -0.1], "floats": false }));
    let notes = answer["notes"].as_array().expect("a list");
    let offered = |note: &Value| note.as_str().is_some_and(|note| note.contains("75") && note.contains("--scenario"));
    assert!(notes.iter().any(offered), "{notes:?}");
    let (machine, scenario) = (file("arm.toml"), file("afloat.toml"));
    let answer = object(&["import-model", &file("afloat.urdf"), "-o", &machine, "--scenario", &scenario]);
    assert_eq!((&answer["scenario"], answer["notes"].as_array().map(Vec::len)), (&json!(scenario), Some(0)));
    let written = fs::read_to_string(&scenario).expect("a file");
    let want = "[base]\nkind = \"free\"\nmass = 75.0\ninertia = 3.5\ncom = [0.2, -0.1]\n";
    assert!(written.contains(want), "{written}");
    prints(&["simulate", &scenario, "--every", "500"]);
    // Out again with the base, of which a model has no wheel.
    let wheel = format!("{written}\n[base.wheel]\ninertia = 0.02\n");
    fs::write(file("wheel.toml"), wheel).expect("written");
    for (model, left_out) in [(&scenario, 0), (&file("wheel.toml"), 1)] {
        let answer = object(&["export-model", &machine, "--base", model, "-o", &file("out.urdf"), "--force"]);
        assert_eq!(answer["base"], json!({ "mass": 75.0, "inertia": 3.5, "com": [0.2, -0.1], "floats": true }));
        let list = answer["left_out"].as_array().map_or(0, |list| {
            list.iter().filter(|what| what.as_str().is_some_and(|what| what.contains("reaction wheel"))).count()
        });
        assert_eq!(list, left_out, "{answer}");
    }
    assert_eq!(object(&["import-model", &file("out.urdf")])["base"]["floats"], true);
    fails(&["export-model", &machine, "--base", "case-3", "-o", &file("no.xml")], 2, &["does not float", "free"]);
    fails(&["export-model", &machine, "--base", &scenario, "-o", &file("no.svg")], 2, &["--base has no effect"]);
    fails(&["import-model", &file("afloat.urdf"), "--scenario", &scenario], 2, &["afloat.toml", "--force"]);
    fails(&["import-model", &file("afloat.urdf"), "-o", &file("x.toml"), "--scenario", &file("x.toml")], 2, &["two"]);
}

#[test]
fn a_machine_goes_elsewhere_by_the_ending_of_the_file() {
    let folder = Folder::new("elsewhere");
    let file = |name: &str| word(folder.path(name));
    let read = |name: &str| fs::read_to_string(file(name)).expect("a file");
    let answer = object(&["export-model", "nine-link", "-o", &file("arm.urdf")]);
    assert_eq!(answer["joints"], serde_json::json!(["drive_1", "drive_2", "drive_3"]));
    assert!(read("arm.urdf").contains("<robot name=\"nine-link\">"));
    let wide = ["--bar-width", "0.04", "--pin-diameter", "0.01"];
    let answer = object(&[&["export-model", "nine-link", "-o", &file("arm.svg")], &wide[..]].concat());
    assert_eq!((keys(&answer), answer["links"].as_u64()), (vec!["file", "left_out", "links", "size"], Some(9)));
    assert!(read("arm.svg").contains("bars 40.0 wide with round ends · holes Ø 10.0"));
    assert!(prints(&["export-model", "nine-link", "-o", &file("arm.dxf")]).contains("9 links on a sheet"));
    assert!(read("arm.dxf").contains("AC1009"));
    let answer = object(&["export-model", "scara", "-o", &file("arm.csv")]);
    assert_eq!(keys(&answer), ["counterweights", "file", "links", "mass"]);
    assert!(read("arm.csv").starts_with("part,name,drive,length m,mass kg,"));
    assert!(prints(&["export-model", "scara", "-o", &file("arm.md")]).contains("10.000 kg in all"));
    fails(&["export-model", "scara", "-o", &file("arm.md")], 2, &["arm.md", "--force"]);
    for (name, option) in
        [("b.urdf", ["--pose", "1,2"]), ("b.xml", ["--bar-width", "0.04"]), ("b.csv", ["--pose", "1,2"])]
    {
        fails(&[&["export-model", "scara", "-o", &file(name)], &option[..]].concat(), 2, &[option[0], "has no effect"]);
    }
    for name in ["b.urdf", "b.xml"] {
        let command = ["export-model", "serial-3r", "-o", &file(name)];
        fails(&[&command[..], &["--material", "0"]].concat(), 2, &["material 0 kg/m³"]);
        prints(&[&command[..], &["--thickness", "0.03"]].concat());
        std::fs::remove_file(folder.path(name)).expect("it was written");
    }
    for (option, words) in [
        (["--bar-width", "0.008"], "want bars wider"),
        (["--pin-diameter", "nan"], "pin diameter"),
        (["--material", "0"], "material 0 kg/m³"),
        (["--thickness", "-1"], "thickness"),
    ] {
        let command = ["export-model", "scara", "-o", &file("b.svg")];
        fails(&[&command[..], &[&option.join("=")]].concat(), 2, &[words]);
    }
    assert!(!folder.path("b.svg").exists());
}

#[test]
fn check_lists_what_parts_bring() {
    let folder = Folder::new("check-parts");
    let arm = word(folder.file("arm.toml", include_str!("../mechanics/parts.toml")));
    let answer = object(&["check", &arm]);
    let parts = answer["parts"].as_array().expect("a list");
    assert_eq!((parts.len(), keys(&parts[0])), (7, vec!["across", "at", "inertia", "link", "mass", "name"]));
    assert_eq!((&parts[3]["name"], &parts[3]["mass"]), (&json!("elbow motor"), &json!(0.42)));
    let sum: f64 = parts.iter().filter_map(|part| part["mass"].as_f64()).sum();
    near(&answer["mass"], &json!(sum), 1e-14, "mass");
    let table = prints(&["check", &arm]);
    for words in
        ["flat bar 30 × 6 mm, aluminium   0.155623", "tube Ø 20 × 2 mm", "profile 30 × 20 × 2 mm, steel", "together"]
    {
        assert!(table.contains(words), "{words} in {table}");
    }
    assert!(!table.contains("overrule"), "{table}");
    let typed = prints(&["check", &arm, "--set", "link.upper.mass=2", "--set", "link.upper.com=0.1"]);
    assert!(typed.contains("link upper: mass and centre of mass along are typed and overrule its parts"), "{typed}");
    // A machine without parts has no such table.
    assert!(
        !prints(&["check", "two-drive"]).contains("together") && object(&["check", "two-drive"])["parts"].is_null()
    );
}

#[test]
fn layers_are_told_written_and_refused() {
    let folder = Folder::new("layers");
    let file = |name: &str| word(folder.path(name));
    let answer = object(&["layers", "two-drive", "-o", &file("stacked.toml")]);
    let wanted = ["count", "height", "layers", "least_tilt", "meetings", "minimal", "tilt_coefficient"];
    assert_eq!(keys(&answer), wanted);
    assert_eq!((answer["count"].as_u64(), answer["minimal"].as_bool()), (Some(3), Some(true)));
    assert_eq!(keys(&answer["layers"][0]), ["height", "layer", "link"]);
    assert_eq!(keys(&answer["meetings"][0]), ["a", "apart", "b", "decided", "q", "where"]);
    // What is written has these heights, and makes solids.
    let again = object(&["layers", &file("stacked.toml")]);
    let coefficient = &answer["tilt_coefficient"]["after"];
    assert_eq!((&again["layers"], &again["tilt_coefficient"]["before"]), (&answer["layers"], coefficient));
    let solids = object(&["export-model", &file("stacked.toml"), "-o", &file("arm.stl")]);
    assert_eq!(keys(&solids), ["file", "left_out", "pose", "solids", "volume"]);
    fails(&["export-model", "two-drive", "-o", &file("flat.stl")], 2, &["share a pin and a height", "layers"]);
    fails(&["layers", "two-drive", "-o", &file("stacked.toml")], 2, &["stacked.toml", "--force"]);
    fails(&["layers", "nine-link"], 1, &["no order of links 2, 3, 4 and 6", "link 4 meets axis of the base at"]);
    let task = ["--task", "case-3", "--along-task"];
    let answer = object(&[&["layers", "nine-link"], &task[..]].concat());
    assert_eq!(keys(&answer["clearance"]), ["a", "b", "distance", "time", "where"]);
    assert!(answer["clearance"]["distance"].as_f64().expect("a distance") > 0.0);
    assert_eq!((keys(&answer["tilt"]), answer["count"].as_u64()), (vec!["after", "before"], Some(4)));
    fails(&["layers", "two-drive", "--task", "case-3"], 2, &["--task case-3", "3 drives"]);
    fails(&["layers", "two-drive", "--along-task"], 2, &["--task"]);
    fails(&["layers", "two-drive", "--spacer", "0"], 2, &["spacer 0 m"]);
}

/// The tilting moment of a stacked machine is what `joints` finds in a run of the task.
#[test]
fn the_tilting_moment_of_layers_is_that_of_the_run() {
    let stacked = object(&["layers", "nine-link", "--task", "case-3", "--along-task"]);
    let heights = stacked["layers"].as_array().expect("links");
    let mut command = vec!["joints".to_owned(), "case-3".to_owned()];
    for link in heights {
        let height = link["height"].as_f64().expect("a height");
        command.extend(["--set".to_owned(), format!("link.{}.axial={height}", link["link"].as_str().expect("a name"))]);
    }
    let command: Vec<&str> = command.iter().map(String::as_str).collect();
    let run = object(&command)["tilt"]["motion"]["value"].as_f64().expect("a moment");
    let own = stacked["tilt"]["after"].as_f64().expect("a moment");
    assert!((run - own).abs() < 1e-3 * own, "{run} {own}");
}

/// The brief in the file of a machine applies, the command line overrules it and says so, and the new file has both.
#[test]
fn design_takes_the_brief_of_the_file() {
    let folder = Folder::new("brief");
    let bare = fs::read_to_string(BARE).expect("a file");
    let design =
        "[design]\nshape = \"ring\"\ninner_radius = 0.012\nthickness = 0.02\nclearance = 0.006\nheaviest = 9.0\n";
    let (file, out) = (word(folder.file("own.toml", bare + design)), word(folder.path("out.toml")));
    let run = stillbase(&["design", &file, "--counterweights", "--json"]);
    let said = text(&run.stderr).to_owned();
    assert!(said.contains("the brief of ") && said.contains("design.shape=ring"), "{said}");
    assert!(said.contains("design.clearance=0.006") && !said.contains("overrules"), "{said}");
    let asked = ["--shape", "ring,0.012", "--thickness", "0.02", "--clearance", "0.006", "--max-mass", "9"];
    let stated: Vec<&str> = ["design", BARE, "--counterweights"].into_iter().chain(asked).collect();
    let (of_file, of_flags): (Value, Value) =
        (serde_json::from_slice(&run.stdout).expect("an object"), object(&stated));
    assert_eq!(of_file["weights"], of_flags["weights"]);
    let run = stillbase(&["design", &file, "--counterweights", "--thickness", "0.03", "-o", &out]);
    let said = text(&run.stderr);
    assert!(run.status.success() && said.contains("overrules design.thickness=0.02 of "), "{said}");
    assert!(said.contains("own.toml: it is 0.03"), "{said}");
    let made = fs::read_to_string(&out).expect("written");
    assert!(made.contains("[design]") && made.contains("inner_radius = 0.012\nheaviest"), "{made}");
    assert!(!made[made.find("[design]").expect("a brief")..].contains("thickness"), "it is the usual one: {made}");
    // Flags are the brief of a machine that had none, and other commands read its file.
    let out = word(folder.path("flags.toml"));
    let stated: Vec<&str> = stated.into_iter().chain(["-o", &out]).collect();
    assert!(stillbase(&stated).status.success());
    let made = fs::read_to_string(&out).expect("written");
    assert!(made.ends_with("heaviest = 9.0\nclearance = 0.006\n"), "{made}");
    assert_eq!(object(&["check", &out])["invariant"], true);
    let said = prints(&["check", &out]);
    assert!(said.contains("counterweight on link   shape") && said.contains("radius mm   inner radius mm"), "{said}");
    assert_eq!(object(&["check", &out])["counterweights"], of_flags["weights"]);
}

/// What stays or may change with `--keep` is taken from the brief of the file, too.
#[test]
fn design_keep_takes_the_brief_of_the_file() {
    let folder = Folder::new("kept");
    let design = "[design]\nfixed = { 3 = true }\nhold.link.2 = { com = [-0.3, 0.1] }\n";
    let whole = stillbase::mechanics::machine::to_toml(
        &stillbase::mechanics::machine::builtin("nine-link").expect("built in").set("link.9.mass", "0.4").expect("set"),
    );
    let (file, out) = (word(folder.file("own.toml", format!("{whole}\n{design}"))), word(folder.path("out.toml")));
    let of_file = object(&["design", &file, "--keep"]);
    let flags = ["--set", "link.9.mass=0.4", "--keep", "--fix", "3.com", "--bound", "2.com=-0.3,0.1"];
    let of_flags = object(&["design", "nine-link"].into_iter().chain(flags).collect::<Vec<_>>());
    assert_eq!(of_file["changes"], of_flags["changes"]);
    let run = stillbase(&["design", &file, "--keep", "--free", "3.com", "-o", &out]);
    let said = text(&run.stderr);
    assert!(run.status.success() && said.contains("design.fixed.3=true") && said.contains("hold.link.2.com"), "{said}");
    // What the options ask of this change alone is not asked of the next one.
    let made = fs::read_to_string(&out).expect("written");
    assert!(made.contains("[design.hold.link.2]") && !made.contains("\"free\""), "{made}");
}
