//! `dynamics` against independent software.

use super::*;

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
