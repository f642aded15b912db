//! Scenarios of assemblies: against independent software, and with faults in their places.

use serde_json::Value;
use stillbase::mechanics::assembly::{Assembly, parse};
use stillbase::mechanics::machine::{FileError, Machine, named};
use stillbase::session::assembly::{AssemblyFrame, AssemblyScenario, builtin_assembly_scenarios};

use crate::support::{array, close, family_machine, numbers};

fn reference(text: &str) -> Value {
    serde_json::from_str(text).expect("valid JSON")
}

/// A machine of the reference without limits, which its motions do not keep.
fn find(name: &str) -> Result<Machine, FileError> {
    let file = reference(include_str!("../reference/assembly.json"));
    let own = match name {
        "carrier" => "nine-link-geared-balanced",
        "wrist" => "two-drive-balanced",
        "second" => "serial-3r-balanced",
        name => return named(name),
    };
    let mut spec = family_machine(own).spec().clone();
    if name == "carrier" {
        spec.links.iter_mut().for_each(|link| link.com = file["carrier_com"][&link.name].as_f64().expect("a number"));
    }
    spec.angles.iter_mut().for_each(|angle| (angle.min, angle.max) = (None, None));
    for drive in &mut spec.drives {
        (drive.torque_limit, drive.speed_limit, drive.acceleration_limit) = (None, None, None);
    }
    Ok(Machine::new(spec).expect("a machine"))
}

fn assembly() -> Assembly {
    let mounts = &reference(include_str!("../reference/assembly.json"))["mounts"];
    let block = |name: &str| {
        let [at, x, y]: [[f64; 3]; 3] = ["at", "x", "y"].map(|key| array(&mounts[name][key]));
        let on = &mounts[name]["on"];
        format!("[[block]]\nname = {name:?}\nmachine = {name:?}\non = {on}\nat = {at:?}\nx = {x:?}\ny = {y:?}\n")
    };
    let text = format!("kind = \"assembly\"\nname = \"three\"\n{}", ["carrier", "wrist", "second"].map(block).concat());
    parse(&text, "three", &find).expect("an assembly")
}

/// A scenario that leads every block as a run of the reference does, by samples.
fn sampled(run: &Value, time: f64, base: &str) -> String {
    let mut text = format!("name = \"led\"\nmachine = \"three\"\nstep = 0.001\n{base}");
    for name in ["carrier", "wrist", "second"] {
        let [from, to] = ["start", "end"].map(|end| numbers(&run[end][name]));
        let row = |i: u32| {
            let u = f64::from(i) / 200.0;
            let s = u.powi(3) * (10.0 + u * (-15.0 + 6.0 * u));
            let q: Vec<f64> = from.iter().zip(&to).map(|(a, b)| a + s * (b - a)).collect();
            format!("{:?}", [vec![time * u], q].concat())
        };
        let rows: Vec<String> = (0..=200).map(row).collect();
        text += &format!("[task.{name}]\nkind = \"given\"\nsamples = [{}]\n", rows.join(", "));
    }
    text
}

/// A floating base ends where independent software says; held, it feels just what the momenta lose.
#[test]
fn a_floating_base_ends_as_in_the_reference() {
    let file = reference(include_str!("../reference/assembly_free.json"));
    let [com, inertia] = ["com", "inertia"].map(|key| numbers(&file["base"][key]));
    let base =
        format!("[base]\nkind = \"free\"\nmass = {}\ncom = {com:?}\ninertia = {inertia:?}\n", file["base"]["mass"]);
    let time = file["T"].as_f64().expect("a time");
    for run in file["runs"].as_array().expect("runs") {
        let scenario = AssemblyScenario::parse(&sampled(run, time, &base), "led", assembly()).expect("a scenario");
        let mut last = None;
        let see = |frame: &AssemblyFrame| {
            last = Some(frame.clone());
            true
        };
        let verdict = scenario.run(see).expect("a run");
        let last = last.expect("a frame");
        close("attitude", &last.attitude.components(), &numbers(&run["attitude"]), 1e-9);
        close("origin", last.origin.as_slice(), &numbers(&run["origin"]), 1e-9);
        assert_eq!(verdict.steps, 2000);
        let silent = run["kind"].as_str().is_some_and(|kind| kind.contains("plane"));
        assert_eq!(silent, verdict.turn[0] < 1e-9, "{verdict:?}");
        let held = AssemblyScenario::parse(&sampled(run, time, ""), "led", assembly()).expect("a scenario");
        let held = held.run(|_| true).expect("a run");
        assert_eq!(held.silent() == [true; 6], silent, "{held:?}");
        let mut falling = assembly();
        falling.set_gravity([0.0, 0.0, -9.81]).expect("in range");
        let why = AssemblyScenario::parse(&sampled(run, time, &base), "led", falling).expect_err("gravity in orbit");
        assert!(why.to_string().contains("want gravity = [0, 0, 0]"), "{why}");
    }
}

#[test]
fn built_in_scenarios_show_their_point() {
    let mut seen = Vec::new();
    for name in builtin_assembly_scenarios() {
        let keep = |assembly| Ok::<_, stillbase::session::scenario::ScenarioError>(assembly);
        let scenario = stillbase::files::assembly_scenario(name, &toml::Table::new(), keep).expect("valid");
        let scenario = scenario.expect("an assembly");
        assert_eq!(scenario.name, name);
        let verdict = scenario.run(|_| true).expect("a run");
        seen.push((name, verdict.silent(), verdict.turn[0] < 1e-9));
    }
    let [f, t] = [false, true];
    // The free base of the second is measured by its turn.
    assert_eq!(seen[0], ("four-freedoms", [t; 6], t));
    assert_eq!(seen[1], ("wrist-across", [t; 6], t));
    assert_eq!((seen[2].0, seen[2].2), ("arm-against-arm", t));
    assert_eq!((seen[3].0, seen[3].2), ("hand-over", t));
    assert_eq!(seen[4], ("off-its-pin", [t, t, t, f, f, f], t));
}

#[test]
fn faults_are_told_in_their_lines() {
    let two = "kind = \"assembly\"\nname = \"two\"\n[[block]]\nname = \"a\"\nmachine = \"nine-link\"\n\
               [[block]]\nname = \"b\"\nmachine = \"two-drive\"\non = \"a\"\n";
    let good = "machine = \"two\"\n[task.a]\nkind = \"reactionless\"\nb = 2.2\nfrom = [0.5, 0.5]\nto = [0.4, 0.6]\n\
                [task.b]\nkind = \"reactionless\"\nb = 1.2\nfrom = [0.2, 0]\nto = [0.3, 0]\n";
    let free = "[base]\nkind = \"free\"\nmass = 3\ninertia = [1, 1, 1]\n";
    let told = |text: &str| {
        let assembly = parse(two, "two", &named).expect("an assembly");
        AssemblyScenario::parse(text, "led.toml", assembly).map(|_| String::new()).unwrap_or_else(|why| why.to_string())
    };
    assert_eq!(told(good), "");
    assert_eq!(told(&format!("{good}{free}")), "");
    for (text, words) in [
        (
            good.replace("b = 1.2", "b = 1e99"),
            "led.toml:9: pose constant at A of block b (task.b.b) is 1e99: want -1000 to 1000 rad",
        ),
        (
            good.replace("kind = \"reactionless\"\nb = 1.2", "kind = \"quick\"\nb = 1.2"),
            "led.toml:8: kind of motion of block b (task.b.kind) is \"quick\": want ",
        ),
        (good.replace("[task.b]", "[task.c]"), "led.toml:7: table of tasks has no key \"c\": want one of a, b"),
        (good.replace("[0.3, 0]", "[0.3]"), "led.toml:11: point B of block b (task.b.to) has 1 value instead of 2"),
        (good.split("[task.b]").next().expect("text").to_owned(), "block b has no task"),
        (
            format!("{good}step = 3\n").replace("[task.b]", "[task.b]\nlaw = \"x\""),
            "time law of block b (task.b.law) is \"x\": want one of quintic",
        ),
        (format!("step = 3\n{good}"), "led.toml:1: step is 3: want 0.00001 to 0.01 s"),
        (
            format!("{good}{}", free.replace("mass = 3", "mass = -3")),
            "led.toml:14: mass of the base (base.mass) is -3: want 1e-9 to 1e9 kg",
        ),
        (format!("{good}{}", free.replace("[1, 1, 1]", "[1, 1]")), "(base.inertia) has 2 numbers: want [x, y, z]"),
        (format!("{good}{}", free.replace("[1, 1, 1]", "[1, 1, 5]")), "none more than the two others together"),
        (format!("{good}{}", free.replace("[1, 1, 1]", "[1, 2, 0, 0, 1, 0, 0, 0, 1]")), "symmetric"),
        (format!("{good}{}", free.replace("kind = \"free\"", "kind = \"afloat\"")), "led.toml:13: "),
        (format!("color = 3\n{good}"), "led.toml:1: the file has no key \"color\": want one of name, "),
        ("machine = ".to_owned(), "led.toml:1: this is not TOML: "),
    ] {
        let said = told(&text);
        assert!(said.contains(words), "{words}: {said}");
    }
}
