//! Assemblies on the command line: `check`, `dynamics` and `simulate`, and files that are wrong.

use super::*;

#[test]
fn check_says_which_block_reacts_and_what_would_be_right() {
    let silent = object(&["check", "carrier-and-wrist", "--strict"]);
    assert_eq!(silent["silent"], true);
    let names: Vec<&str> =
        silent["blocks"].as_array().expect("a list").iter().filter_map(|of| of["block"].as_str()).collect();
    assert_eq!(names, ["carrier", "wrist"]);
    near(&silent["blocks"][0]["carried_mass"], &silent["blocks"][1]["mass"], 1e-12, "carried mass");
    let wrong = object(&["check", "wrist-off-its-pin"]);
    assert_eq!((&wrong["silent"], &wrong["blocks"][1]["silent"]), (&json!(false), &json!(true)));
    let out = stillbase(&["check", "wrist-off-its-pin", "--strict"]);
    assert!(out.status.code() == Some(1) && text(&out.stderr).contains("want block wrist at = [0, 0, 0.02]"));
    // What it wants is right, typed in: on the pin it only tilts, in the plane of the carrier it is silent.
    let whole = prints(&["machines", "wrist-off-its-pin"]);
    let folder = Folder::new("assemblies");
    let mended = |at: &str| {
        let file = folder.file("mended.toml", whole.replace("at = [0.03, 0, 0.02]", &format!("at = {at}")));
        object(&["check", &word(file)])
    };
    let [on_pin, level] = ["[0, 0, 0.02]", "[0, 0, 0]"].map(mended);
    let reasons = on_pin["blocks"][0]["reasons"].as_array().expect("a list");
    assert!(reasons.len() == 1 && reasons[0].as_str().is_some_and(|why| why.contains("tilts the base")));
    assert_eq!(level["silent"], true);
    // Arms with parallel planes may change their b together.
    assert_eq!(object(&["check", "two-arms"])["parallel"], json!([["left", "right"]]));
    // A carrier that holds more than it was balanced for says for what it wants to be balanced.
    let heavy = object(&["check", "carrier-and-wrist", "--set", "wrist.payload.mass=0.1"]);
    let reasons = heavy["blocks"][0]["reasons"].as_array().expect("a list");
    assert!(reasons[0].as_str().is_some_and(|why| why.contains("payload.mass = 0.52")), "{reasons:?}");
}

#[test]
fn states_of_blocks_have_a_wrench_in_space() {
    let folder = Folder::new("assemblies");
    let states = word(folder.file(
        "states.json",
        r#"[{"carrier": [[0.4, 1.1, 2.0], [0.3, -0.2, 0.5], [1, 2, -3]], "wrist": [[0.2, 1.5], [1, -1], [2, 1]]}]"#,
    ));
    let found = object(&["dynamics", "carrier-and-wrist", "--states", &states, "--set", "gravity=0,0,-9.81"]);
    let result = &found["results"][0];
    // Both hang from their pins, so weight is that of the mass at the base.
    near(
        &result["force"][2],
        &json!(-9.81 * object(&["check", "carrier-and-wrist"])["mass"].as_f64().expect("kg")),
        1e-9,
        "weight",
    );
    let sum: f64 = (0..2).map(|i| result["blocks"][i]["moment"][2].as_f64().expect("a number")).sum();
    assert!((sum - result["moment"][2].as_f64().expect("a number")).abs() < 1e-12);
    // A machine by itself answers in the same keys.
    let alone =
        word(folder.file("alone.json", r#"[{"q": [0.4, 1.1, 2.0], "qd": [0.3, -0.2, 0.5], "qdd": [1, 2, -3]}]"#));
    let alone = object(&["dynamics", "nine-link-table-1", "--states", &alone]);
    let result = &alone["results"][0];
    assert_eq!((&result["force"][0], &result["moment"][2]), (&result["base_force"][0], &result["base_moment"]));
    for (text, words) in [
        (r#"[{"carrier": [[1, 2, 3], [0, 0, 0], [0, 0, 0]]}]"#, "state 1: block wrist: missing"),
        (r#"[{"elbow": [[1], [0], [0]]}]"#, "no block \"elbow\": want one of carrier, wrist"),
        (
            r#"[{"carrier": [[1, 2], [0, 0], [0, 0]], "wrist": [[1, 2], [0, 0], [0, 0]]}]"#,
            "block carrier: q has 2 numbers: want 3",
        ),
        (r#"[{"carrier": [[1, 2, 3], [0, 0, 0]]}]"#, "want [{\"carrier\": [[rad], [rad/s], [rad/s²]]"),
    ] {
        let file = word(folder.file("wrong.json", text));
        fails(&["dynamics", "carrier-and-wrist", "--states", &file], 2, &[words]);
    }
    for (setting, words) in [
        ("payload.mass=1", "one of carrier, wrist, as carrier.payload.mass"),
        ("wrist.gravity=0,1", "want gravity=x,y,z of the whole assembly"),
        ("gravity=0,1", "want x,y,z of the assembly"),
        ("gravity=[0,-9.81]", "want x,y,z of the assembly"),
        ("wrst.payload.mass=1", "want wrist.payload.mass (nearest) or the name of a block"),
        ("gravity=0,0,inf", "want three numbers"),
        ("wrist.payload.mass=-1", "block wrist"),
    ] {
        fails(&["check", "carrier-and-wrist", "--set", setting], 2, &[words]);
    }
}

#[test]
fn blocks_follow_tasks_of_their_own() {
    let silent = object(&["simulate", "wrist-across", "--signals", "torque,pose", "--every", "1000", "--strict"]);
    assert_eq!(silent["verdict"]["silent_force"], json!([true, true, true]));
    assert_eq!(silent["time"], json!([0.0, 1.0, 2.0]));
    assert_eq!(silent["units"]["torque/wrist.1"], "N m");
    let b = silent["signals"]["pose/carrier.b"].as_array().expect("a list");
    b.iter().for_each(|b| near(b, &json!(3.279), 1e-9, "b is held"));
    let loud = object(&["simulate", "off-its-pin", "--signals", "moment"]);
    assert_eq!(loud["verdict"]["silent_moment"], json!([false, false, false]));
    let out = stillbase(&["simulate", "off-its-pin", "--signals", "moment", "--strict"]);
    assert!(out.status.code() == Some(1) && text(&out.stderr).contains("--strict: off-its-pin: reacts: n_x up to"));
    // The other arm's b is what keeps the base at rest.
    let [both, one] = [&[][..], &["--set", "task.right.b_to=1.9"]].map(|more| {
        object(&[&["simulate", "arm-against-arm", "--signals", "attitude"], more].concat())["verdict"]["base_angle"]
            .clone()
    });
    assert!(both.as_f64().is_some_and(|turn| turn < 1e-9) && one.as_f64().is_some_and(|turn| turn > 0.02), "{one}");
    // A refusal names its block, and its ways out work as they are printed.
    let refused = ["simulate", "wrist-across", "--signals", "moment", "--set", "task.carrier.b=2"];
    fails(&refused, 1, &["block carrier: ", "--set task.carrier.b="]);
    let out = stillbase(&refused);
    let typed = text(&out.stderr).lines().find(|line| line.contains("take b =")).expect("a way out");
    let (_, setting) = typed.rsplit_once("--set ").expect("a setting");
    assert_eq!(
        object(&["simulate", "wrist-across", "--signals", "moment", "--set", setting])["verdict"]["silent_moment"][2],
        true
    );
    for (args, words) in [
        (&["design", "carrier-and-wrist"][..], "want --counterweights"),
        (&["spectrum", "wrist-across"], "render and export-model take this one"),
        (&["headless", "case-1", "wrist-across", "-o", "x.rrd"], "recorded by itself"),
        (&["simulate", "wrist-across", "--signals", "nothing"], "no signal \"nothing\""),
        (&["simulate", "wrist-across", "--set", "task.elbow.b=1"], "has no key \"elbow\": want one of carrier, wrist"),
        (&["simulate", "wrist-across", "--set", "step=0"], "want 0.00001 to 0.01 s"),
        (&["machines", "two-arms", "-o", "x.toml"], "is an assembly"),
    ] {
        fails(args, 2, &[words]);
    }
}

#[test]
fn assemblies_go_out_as_models() {
    let folder = Folder::new("assemblies");
    let [xml, urdf, svg] = ["four.xml", "four.urdf", "wrist.svg"].map(|name| word(folder.path(name)));
    let said = object(&["export-model", "wrist-across", "-o", &xml]);
    // It starts where its scenario does.
    let start = object(&["simulate", "wrist-across", "--signals", "angle", "--every", "1000"]);
    let q = |path: &str| &start["signals"][format!("angle/{path}")][0];
    let pose = said["pose"].as_array().expect("a list").clone();
    assert_eq!(pose.len(), 5);
    assert_eq!((&pose[0], &pose[4]), (q("carrier.1"), q("wrist.2")));
    // Nine links and four, and the hinge of the platform.
    assert_eq!(numbers(&said["qpos"]).len(), 14);
    let model = fs::read_to_string(&xml).expect("a model");
    for words in [
        "<body name=\"carrier/base\" pos=\"0 0 0\" xyaxes=\"1 0 0 0 1 0\">",
        "<body name=\"wrist/base\" pos=\"0 0 0\" xyaxes=\"0 0 1 1 0 0\">",
        "<joint name=\"carrier/joint_platform\"/>",
        "<tendon tendon1=\"direction of carrier/platform\" polycoef=\"0 0 0 0 0\"/>",
        "<motor name=\"wrist/drive_2\"",
        "objname=\"wrist/end_effector\"",
    ] {
        assert!(model.contains(words), "{words}");
    }
    let said = object(&["export-model", "carrier-and-wrist", "-o", &urdf]);
    assert_eq!(said["joints"][3], "wrist/drive_1");
    let model = fs::read_to_string(&urdf).expect("a model");
    assert!(model.contains("<joint name=\"carrier/joint_platform\" type=\"continuous\">"), "{model}");
    assert!(model.contains("<mimic joint=\"carrier/drive_3\" multiplier=\"-1\" offset=\"0\"/>"));
    // The base of a scenario floats along.
    let afloat = word(folder.path("afloat.xml"));
    for args in [&["two-arms", "--base", "arm-against-arm"][..], &["arm-against-arm"]] {
        let said = object(&[&["export-model"], args, &["-o", &afloat, "--force"]].concat());
        assert_eq!((&said["base"]["mass"], &said["base"]["inertia"][2][2]), (&json!(60.0), &json!(6.0)));
        assert_eq!(numbers(&said["qpos"])[..7], [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        assert!(fs::read_to_string(&afloat).expect("a model").contains("<freejoint name=\"base_floats\"/>"));
    }
    let words = prints(&["export-model", "two-arms", "-o", &afloat, "--force", "--pose", "1,1,1,2,2,2"]);
    assert!(words.contains("right.3") && words.contains("2.000000"), "{words}");
    // A block by itself goes where any machine does.
    assert_eq!(object(&["export-model", "carrier-and-wrist", "--block", "wrist", "-o", &svg])["links"], 4);
    for (args, words) in [
        (&["carrier-and-wrist", "-o", "x.stl"][..], "shows one machine: want .xml or .urdf for an assembly"),
        (&["carrier-and-wrist", "-o", "x.svg"], "or one of its blocks, as --block carrier"),
        (&["carrier-and-wrist", "-o", "x.xml", "--block", "elbow"], "no such block: want one of carrier, wrist"),
        (&["nine-link", "-o", "x.xml", "--block", "arm"], "--block arm has no use here: want it with an assembly"),
        (&["carrier-and-wrist", "-o", "x.xml", "--pose", "1,2"], "a pose of 2 angles: want 5"),
        (&["carrier-and-wrist", "-o", "x.xml", "--pose", "1,2,3,4,inf"], "want finite angles"),
        (&["two-arms", "-o", "x.xml", "--base", "wrist-across"], "whose base floats"),
        (&["carrier-and-wrist", "-o", "x.urdf", "--pose", "1,2,3,4,5"], "--pose has no effect on such a file"),
        (&["carrier-and-wrist", "-o", "x.xml", "--set", "wrist.link.1.inertia=0"], "link \"wrist/1\" has inertia 0"),
    ] {
        fails(&[&["export-model"], args].concat(), 2, &[words]);
    }
}

fn refuses(words: &[&str], said: &str) {
    fails(words, 2, &[said]);
}

/// An assembly by itself does a small motion; keys are removed with `default`, and two blocks bound on the command line.
#[test]
fn assemblies_are_simulated_alone_and_with_settings() {
    for name in ["carrier-and-wrist", "two-arms"] {
        let found = object(&["simulate", name]);
        assert_eq!(found["verdict"]["silent_moment"], json!([true, true, true]), "{name}");
    }
    let longer = object(&["simulate", "two-arms", "--set", "duration=3"]);
    let time = longer["time"].as_array().expect("a list");
    assert_eq!(time.last(), Some(&json!(3.0)));
    // One arm does not change its b: the base turns; then bound to the other, it follows.
    let alone = ["--set", "task.right.b_to=1.9"];
    let turn = |more: &[&str]| {
        let found = object(&[&["simulate", "arm-against-arm"], more].concat());
        found["verdict"]["base_angle"].as_f64().expect("a number")
    };
    assert!(turn(&alone) > 1e-3 && turn(&[&alone[..], &["--set", "against=left,right"]].concat()) < 1e-9);
    assert!(turn(&["--set", "task.left.b_to=2.0", "--set", "against=left,right"]) < 1e-9);
    let free = ["--set", "task.right.kind=reactionless", "--set", "task.right.b_to=default"];
    assert!(turn(&free) > 1e-3);
    for (words, said) in [
        (["--set", "against=left"], "want the names of two blocks"),
        (["--set", "against=left,middle"], "no block \"middle\""),
        (["--set", "against=left,left"], "left stands there twice"),
        (["--set", "lead=3"], "the name of a block"),
        (["--set", "lead=lft"], "want \"left\" (nearest)"),
        (["--set", "task.lft.b=2"], "table of tasks has no key \"lft\": want left (nearest)"),
        (["--set", "task.left.bb=2"], "task of block left has no key \"bb\": want b (nearest)"),
        (["--set", "bse.mass=2"], "want base.mass (nearest)"),
        (["--set", "base.stifness=2"], "want stiffness (nearest)"),
        (["--set", "base.stiffness=1,1,1,1,1,1"], "base.stiffness has no use here: want base.kind = compliant"),
        (["--set", "task.left.moment_limit=1e-99"], "(task.left.moment_limit) is 1e-99: want 1e-9 to 1e9 N m"),
    ] {
        refuses(&[&["simulate", "arm-against-arm"], &words[..]].concat(), said);
    }
    // What has no use in the file is a note, with which the run goes on.
    let folder = Folder::new("idle-base");
    let task = "kind = \"reactionless\"\nb = 2.2\nfrom = [0.5, 0.5]\nto = [0.4, 0.6]\n";
    let idle = format!("machine = \"two-arms\"\n[base]\nmass = 3\n[task.left]\n{task}[task.right]\n{task}");
    let file = word(folder.file("idle.toml", idle));
    let out = stillbase(&["simulate", &file, "--json"]);
    let notes = text(&out.stderr);
    assert!(
        out.status.success() && notes.contains("note: idle: base.mass has no use there: want base.kind = free"),
        "{notes}"
    );
}

/// What takes one machine says that it got several.
#[test]
fn commands_for_one_machine_say_that_there_are_several() {
    let folder = Folder::new("assemblies");
    let own = word(folder.file("own.toml", prints(&["machines", "two-arms"])));
    let led = folder.file(
        "led.toml",
        "machine = \"own.toml\"\n[task.left]\nkind = \"reactionless\"\nb = 2.2\nfrom = [0.5, 0.5]\nto = [0.4, 0.6]\n\
         [task.right]\nkind = \"reactionless\"\nb = 2.2\nfrom = [0.5, 0.5]\nto = [0.4, 0.6]\n",
    );
    let led = word(led);
    assert_eq!(object(&["simulate", &led])["verdict"]["silent_force"], json!([true, true, true]));
    for command in ["joints", "spectrum", "plan"] {
        refuses(&[command, "carrier-and-wrist"], "this is an assembly of several machines");
        refuses(&[command, "wrist-across"], "this is a scenario of an assembly");
        refuses(&[command, &led], "this is a scenario of an assembly");
    }
    refuses(&["layers", &own], "this is an assembly of several machines");
    refuses(
        &["design", "nine-link", &own, "--counterweights", "--front", "3"],
        "this is an assembly of several machines",
    );
    for command in ["design", "layers"] {
        refuses(&[command, "wrist-across"], "this is a scenario of an assembly");
    }
    refuses(&["simulate", "nowhere"], "arm-against-arm");
}

/// All blocks are balanced together: the file is silent, and what a wrist weighs more its carrier is balanced for.
#[test]
fn design_balances_all_blocks_together() {
    let folder = Folder::new("assemblies");
    let file = word(folder.path("heavier.toml"));
    let ask = ["design", "carrier-and-wrist", "--set", "wrist.link.2.com=0.02", "--counterweights"];
    let found = object(&[&ask[..], &["-o", &file]].concat());
    assert_eq!(
        (&found["certified"], &found["silent"], &found["is_balanced"]),
        (&json!(true), &json!(true), &json!(true))
    );
    let blocks = found["blocks"].as_array().expect("a list");
    let added: f64 = blocks.iter().map(|block| block["added_mass"].as_f64().expect("kg")).sum();
    near(&found["added_mass"], &json!(added), 1e-9, "added mass");
    assert!(blocks[1]["weights"].as_array().is_some_and(|weights| !weights.is_empty()));
    let wrist = blocks[1]["added_mass"].as_f64().expect("kg");
    near(&blocks[0]["carried_mass"], &json!(0.42 + wrist), 1e-9, "what the carrier carries");
    let checked = object(&["check", &file, "--strict"]);
    assert_eq!(checked["silent"], json!(true));
    near(&checked["mass"], &json!(0.42 + 3.68 + added), 1e-9, "mass");
    near(&checked["blocks"][0]["d"], &blocks[0]["d"], 1e-9, "D_k of the carrier");
    let text = fs::read_to_string(&file).expect("a file");
    assert!(text.contains("name = \"heavier\"") && text.contains("carrier-and-wrist, balanced by counterweights"));
    // It is simulated by itself, and puts nothing on the base.
    assert_eq!(object(&["simulate", &file])["verdict"]["silent_moment"], json!([true, true, true]));
    let out = stillbase(&[&ask[..], &["-o", &file]].concat());
    assert_eq!(out.status.code(), Some(2), "a file that exists stays");
    // What is minimised is that of the whole.
    let inertia = |of: &Value| -> f64 {
        let blocks = of["blocks"].as_array().expect("a list");
        blocks.iter().flat_map(|block| numbers(&block["d"])).sum()
    };
    let quick = object(&[&ask[..], &["--objective", "inertia"]].concat());
    assert!(inertia(&quick) < inertia(&found) - 1e-3 && quick["added_mass"].as_f64() > found["added_mass"].as_f64());
    let front = object(&[&ask[..], &["--front", "4"]].concat());
    let points: Vec<Vec<f64>> = front["front"].as_array().expect("a list").iter().map(numbers).collect();
    assert_eq!((points.len(), front["front_points"][1]["certified"].clone()), (4, json!(true)));
    near(&json!(points[0][0]), &found["added_mass"], 2e-6, "the lightest");
    near(&json!(points[3][1]), &json!(inertia(&quick)), 2e-6, "the one of least inertia");
    // Torques are those of the task; the blocks of another do not fit.
    let torque = object(&[&ask[..], &["--objective", "torque", "--task", "wrist-across"]].concat());
    let light = object(&[&ask[..], &["--task", "wrist-across"]].concat());
    assert!(torque["torque"].as_f64() < light["torque"].as_f64());
    let said = prints(&ask);
    for words in ["block wrist · wrist", "silent: nothing reaches the base", "counterweight on link", "within"] {
        assert!(said.contains(words), "{words}: {said}");
    }
}

/// What counterweights cannot mend is said, with the mount that would be right; typed in, it is.
#[test]
fn design_says_which_block_still_reacts() {
    let ask = ["design", "wrist-off-its-pin", "--counterweights"];
    let found = object(&ask);
    assert_eq!((&found["is_balanced"], &found["silent"]), (&json!(true), &json!(false)));
    let reasons = found["blocks"][0]["reasons"].as_array().expect("a list");
    assert_eq!(reasons.len(), 2, "{reasons:?}");
    let strict = stillbase(&[&ask[..], &["--strict"]].concat());
    assert!(strict.status.code() == Some(1) && text(&strict.stderr).contains("want block wrist at = [0, 0, 0.02]"));
    let whole = prints(&["machines", "wrist-off-its-pin"]);
    let folder = Folder::new("assemblies");
    let at = |at: &str| {
        let file = folder.file("mended.toml", whole.replace("at = [0.03, 0, 0.02]", &format!("at = {at}")));
        object(&["design", &word(file), "--counterweights"])
    };
    let on_pin = at("[0, 0, 0.02]");
    let reason = on_pin["blocks"][0]["reasons"][0].as_str().expect("a reason");
    assert!(reason.contains("as with block wrist at = [0, 0, 0]"), "{reason}");
    assert_eq!(at("[0, 0, 0]")["silent"], json!(true));
    for (args, status, words) in [
        (&["carrier-and-wrist", "--counterweights", "--max-mass", "2"][..], 1, "link carrier.1: no heavier"),
        (&["carrier-and-wrist", "--counterweights", "--range", "carrier.2=-0.1,0.1"], 1, "block carrier: the force"),
        (&["carrier-and-wrist", "--counterweights", "--range", "elbow.2=-0.1,0.1"], 2, "want one of carrier.1"),
        (&["carrier-and-wrist", "--counterweights", "--payload", "0,1"], 2, "want payload.mass of a block"),
        (&["carrier-and-wrist", "--counterweights", "--length", "l1=0.1,0.2"], 2, "--length: carrier-and-wrist is"),
        (&["carrier-and-wrist", "--counterweights", "--bars", "0.03,0.006"], 2, "--bars: carrier-and-wrist is"),
        (&["carrier-and-wrist", "--counterweights", "--objective", "torque"], 2, "want --task SCENARIO"),
        (&["carrier-and-wrist", "--counterweights", "--task", "case-3"], 2, "want the scenario of an assembly"),
        (&["carrier-and-wrist", "--counterweights", "--task", "arm-against-arm"], 2, "want carrier (3 drives)"),
        (&["nine-link", "--counterweights", "--in-plane"], 2, "want it with an assembly"),
    ] {
        fails_first(&[&["design"], args].concat(), status, words);
    }
}

/// As [`fails`], after notes of counterweights that are taken off.
fn fails_first(args: &[&str], status: i32, words: &str) {
    let out = stillbase(args);
    assert_eq!(out.status.code(), Some(status), "{args:?}: {}", text(&out.stderr));
    assert!(text(&out.stderr).contains(words) && out.stdout.is_empty(), "{args:?}: {}", text(&out.stderr));
}
