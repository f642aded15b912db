//! What commands print with `--json` is what `stillbase schema` says, and the dictionary of results knows every
//! property of it.

use std::collections::BTreeSet;

use stillbase::settings::results::{RESULTS, SIGNALS, column, find, signal};

use super::net::{asked, each_line, lines};
use super::*;

/// Keywords that say nothing on what is valid.
const NOTES: [&str; 8] =
    ["unevaluatedProperties", "$schema", "$defs", "title", "description", "unit", "deprecated", "default"];

/// Faults of a value, each with its place. A property that the schema does not name is a fault.
fn faults(value: &Value, schema: &Value, place: &str) -> Vec<String> {
    let Some(schema) = schema.as_object() else {
        return if *schema == json!(true) { Vec::new() } else { vec![format!("{place}: no schema")] };
    };
    // An object of which nothing is said may hold anything.
    let named = names(&Value::Object(schema.clone()));
    let mut all = within(value, schema, place);
    if let (Some(object), Some(named)) = (value.as_object(), named) {
        all.extend(object.keys().filter(|key| !named.contains(*key)).map(|key| format!("{place}.{key}: not named")));
    }
    all
}

/// The properties that a schema names; `None` if it leaves them open.
fn names(schema: &Value) -> Option<BTreeSet<String>> {
    if schema.get("additionalProperties").is_some_and(|more| *more != json!(false)) {
        return None;
    }
    let own = schema.get("properties").and_then(Value::as_object);
    let mut all: BTreeSet<String> = own.into_iter().flat_map(|own| own.keys().cloned()).collect();
    let mut says = own.is_some();
    for parts in ["anyOf", "oneOf", "allOf"] {
        for part in schema.get(parts).and_then(Value::as_array).into_iter().flatten() {
            if let Some(more) = names(part) {
                says = true;
                all.extend(more);
            }
        }
    }
    says.then_some(all)
}

/// Faults of a value by the keywords of a schema.
fn within(value: &Value, schema: &serde_json::Map<String, Value>, place: &str) -> Vec<String> {
    let mut all = Vec::new();
    for (keyword, says) in schema {
        match keyword.as_str() {
            "type" => {
                let is = |kind: &Value| match kind.as_str() {
                    Some("object") => value.is_object(),
                    Some("array") => value.is_array(),
                    Some("string") => value.is_string(),
                    Some("boolean") => value.is_boolean(),
                    Some("number") => value.is_number(),
                    Some("integer") => value.as_f64().is_some_and(|x| x.fract() == 0.0),
                    other => panic!("{place}: type {other:?}"),
                };
                let kinds = says.as_array().cloned().unwrap_or_else(|| vec![says.clone()]);
                if !kinds.iter().any(is) {
                    all.push(format!("{place}: {value} is no {says}"));
                }
            }
            "properties" => {
                for (name, schema) in says.as_object().expect("properties") {
                    all.extend(
                        value.get(name).map(|own| faults(own, schema, &format!("{place}.{name}"))).unwrap_or_default(),
                    );
                }
            }
            "required" => {
                let lacks = |name: &&Value| value.get(name.as_str().expect("a name")).is_none();
                all.extend(
                    says.as_array().expect("names").iter().filter(lacks).map(|name| format!("{place}: lacks {name}")),
                );
            }
            "additionalProperties" => {
                let known = schema.get("properties").and_then(Value::as_object);
                let is_other = |name: &String| known.is_none_or(|known| !known.contains_key(name));
                for (name, own) in value.as_object().into_iter().flatten().filter(|(name, _)| is_other(name)) {
                    all.extend(faults(own, says, &format!("{place}.{name}")));
                }
            }
            "items" => {
                let first = schema.get("prefixItems").and_then(Value::as_array).map_or(0, Vec::len);
                for own in value.as_array().into_iter().flatten().skip(first) {
                    all.extend(faults(own, says, &format!("{place}[]")));
                }
            }
            "prefixItems" => {
                let pairs = value.as_array().into_iter().flatten().zip(says.as_array().expect("schemas"));
                pairs.for_each(|(own, schema)| all.extend(faults(own, schema, &format!("{place}[]"))));
            }
            "minItems" | "maxItems" => {
                let (count, bound) = (value.as_array().map_or(0, Vec::len) as u64, says.as_u64().expect("a number"));
                if (keyword == "minItems" && count < bound) || (keyword == "maxItems" && count > bound) {
                    all.push(format!("{place}: {count} items, {keyword} {bound}"));
                }
            }
            "minimum" | "maximum" => {
                let (x, bound) = (value.as_f64().unwrap_or(f64::NAN), says.as_f64().expect("a number"));
                let fits = if keyword == "minimum" { x >= bound } else { x <= bound };
                all.extend((!fits).then(|| format!("{place}: {x}, {keyword} {bound}")));
            }
            "anyOf" | "oneOf" => {
                let parts = says.as_array().expect("schemas");
                let whole: Vec<Vec<String>> = parts.iter().map(|part| inner(value, part, place)).collect();
                if !whole.iter().any(Vec::is_empty) {
                    all.extend(whole.into_iter().flatten().take(5));
                }
            }
            "allOf" => says.as_array().expect("schemas").iter().for_each(|part| all.extend(inner(value, part, place))),
            "enum" => {
                all.extend((!says.as_array().expect("values").contains(value)).then(|| format!("{place}: {value}")))
            }
            "const" => all.extend((says != value).then(|| format!("{place}: {value} is not {says}"))),
            word => assert!(NOTES.contains(&word), "{place}: the keyword {word}"),
        }
    }
    all
}

/// Faults by a part of a schema, of which other parts may name further properties.
fn inner(value: &Value, schema: &Value, place: &str) -> Vec<String> {
    schema.as_object().map_or_else(Vec::new, |schema| within(value, schema, place))
}

/// The schemas of all commands, by name.
fn schemas() -> serde_json::Map<String, Value> {
    let whole: Value = serde_json::from_str(&prints(&["schema"])).expect("JSON");
    assert_eq!(whole["$schema"], "https://json-schema.org/draft/2020-12/schema");
    whole["$defs"].as_object().expect("schemas").clone()
}

#[test]
fn a_value_that_does_not_fit_is_found() {
    let schema = json!({
        "type": "object", "required": ["a"],
        "properties": { "a": { "type": "array", "items": { "type": "number" }, "minItems": 2 }, "b": { "type": "string" } },
    });
    assert!(faults(&json!({ "a": [1, 2.5] }), &schema, "").is_empty());
    for wrong in [json!({}), json!({ "a": [1] }), json!({ "a": [1, "x"] }), json!({ "a": [1, 2], "c": 1 }), json!([])] {
        assert!(!faults(&wrong, &schema, "").is_empty(), "{wrong}");
    }
    let either = json!({ "anyOf": [schema, { "type": "object", "properties": { "d": { "type": "integer" } }, "required": ["d"] }] });
    assert!(
        faults(&json!({ "d": 3 }), &either, "").is_empty() && !faults(&json!({ "d": 0.5 }), &either, "").is_empty()
    );
}

#[test]
fn what_commands_print_is_what_their_schema_says() {
    let schemas = schemas();
    let home = folder("schema");
    // Beside those whose answers are kept.
    let more = "machines --json\nkeys friction\nresults moment\nlearn case-3\nrender two-drive -o two.png\n\
        report two-drive -o two.html\nexport two-drive\nreplay a.rrd\ncompare case-1 case-3 -o both.parquet\n\
        headless wheel case-1 -o two.rrd --json ; replay two.rrd ; diff two.rrd:wheel two.rrd:case-1\n\
        dynamics nine-link --states states.json\ndesign nine-link-bare two-drive --counterweights --front 3\n\
        design nine-link-bare --counterweights --vary payload.mass=0,400\n\
        export wheel --rate 500 --what simulated -o wheel.csv\nlayers scara\ncheck nothing.toml\n\
        export case-1 --what simulated --rate 250 -o a.csv --set plant.link.5.com=-0.03 ; trim a.csv nine-link\n\
        diff case-1 case-3";
    let line_count = lines().len();
    let all = lines().into_iter().chain(more.lines().map(str::trim)).collect();
    let answers = each_line(all, |i, line| {
        let here = home.join(i.to_string());
        fs::create_dir_all(&here).expect("a folder");
        fs::write(here.join("states.json"), r#"[{"q": [0.1, 0.2, 0.3], "qd": [0, 0, 1], "qdd": [0, 1, 0]}]"#)
            .expect("states");
        asked(Path::new(env!("CARGO_BIN_EXE_stillbase")), &line.replace(" --json", ""), &here)
    });
    assert!(answers.len() > line_count);
    let (mut wrong, mut tried) = (Vec::new(), BTreeSet::new());
    for (line, answers) in &answers {
        for (line, answer) in line.split(" ; ").zip(answers) {
            // `asked` adds --json to all but two.
            let command = line.split(' ').next().expect("a command");
            let Ok(value) = serde_json::from_str::<Value>(&answer.printed) else { continue };
            let refused =
                value.get("proposals").is_some() && value.get("reason").is_some() && value.get("scenario").is_none();
            let name = if refused { "refusal" } else { command };
            tried.insert(name.to_owned());
            let found = faults(&value, &schemas[name], name);
            wrong.extend(found.into_iter().take(6).map(|fault| format!("{line}: {fault}")));
        }
    }
    assert!(wrong.is_empty(), "{} faults:\n{}", wrong.len(), wrong.join("\n"));
    for name in ["machines", "headless"] {
        let file = word(home.join(format!("{name}.rrd")));
        let args: &[&str] =
            if name == "headless" { &["headless", "wheel", "-o", &file, "--force"] } else { &["machines"] };
        let value = object(args);
        let found = faults(&value, &schemas[name], name);
        assert!(found.is_empty(), "{}", found.join("\n"));
        tried.insert(name.to_owned());
    }
    // Pictures need an adapter.
    let without: Vec<&String> =
        schemas.keys().filter(|name| !tried.contains(*name) && name.as_str() != "render").collect();
    assert!(without.is_empty(), "no output was held against the schema of {without:?}");
}

/// Each property of a schema that the dictionary does not know, or knows without a unit though it is a number, with its path.
fn unknown<'a>(schema: &'a Value, path: &mut Vec<&'a str>, all: &mut BTreeSet<String>) {
    let Some(object) = schema.as_object() else { return };
    for (name, property) in object.get("properties").and_then(Value::as_object).into_iter().flatten() {
        path.push(name);
        let full = path.join(".");
        match find(path) {
            Some(row) => {
                assert_eq!(property["description"], row.in_words(), "{full}");
                let kind = property["type"].as_str().unwrap_or_default();
                // A number has a unit, if only that of a pure one.
                if ["number", "integer"].contains(&kind) && row.unit.is_empty() {
                    all.insert(format!("{full}: {kind} without a unit, taken for {}", row.name));
                }
            }
            None => drop(all.insert(full)),
        }
        unknown(property, path, all);
        path.pop();
    }
    for part in ["items", "additionalProperties"] {
        object.get(part).into_iter().for_each(|part| unknown(part, path, all));
    }
    for parts in ["anyOf", "oneOf", "allOf", "prefixItems"] {
        object.get(parts).and_then(Value::as_array).into_iter().flatten().for_each(|part| unknown(part, path, all));
    }
}

#[test]
fn the_dictionary_knows_every_property() {
    let mut all = BTreeSet::new();
    for (command, schema) in schemas() {
        unknown(&schema, &mut vec![&command], &mut all);
    }
    assert!(all.is_empty(), "{} properties without meaning or unit: {all:#?}", all.len());
    for command in ["joints", "refusal"] {
        let one: Value = serde_json::from_str(&prints(&["schema", command])).expect("JSON");
        assert!(one["title"].is_string() && one["properties"].is_object(), "{command}");
    }
    fails(&["schema", "chek"], 2, &["chek", "want check (nearest)"]);
    fails(&["schema", "figures"], 2, &["prints JSON"]);
}

#[test]
fn the_dictionary_has_each_name_once_with_unit_and_meaning() {
    let mut names = BTreeSet::new();
    for row in RESULTS.iter().flat_map(|(_, rows)| *rows).chain(SIGNALS) {
        assert!(names.insert(row.name), "{} twice", row.name);
        let is_old = !row.newer.is_empty();
        assert_eq!(row.meaning.is_empty(), is_old, "{}", row.name);
        assert!(row.in_words().split_whitespace().count() <= 40, "{}", row.in_words());
        if is_old {
            let now = find(&[row.newer]).or_else(|| signal(row.newer));
            let now = now.unwrap_or_else(|| panic!("no result {}", row.newer));
            assert_eq!((now.unit, now.newer), (row.unit, ""), "{}", row.name);
        }
    }
    // What is shown in windows and tables is of the dictionary.
    for column in stillbase::study::comparison::SUMMARY_COLUMNS {
        assert_eq!(find(&["runs", column.key]).map(|row| row.unit), Some(column.unit), "{}", column.key);
    }
    for column in stillbase::study::comparison::DESIGN_COLUMNS {
        assert_eq!(find(&["design", column.key]).map(|row| row.unit), Some(column.unit), "{}", column.key);
    }
    let machine = stillbase::mechanics::machine::builtin("nine-link").expect("it comes along");
    for signal in stillbase::simulation::signals::signals(machine) {
        assert!(
            !signal.label.is_empty() && !signal.label.contains('*') || signal.path.starts_with("dexterity/"),
            "{}",
            signal.path
        );
    }
}

/// The heads of the columns of a CSV file, without the lines about it.
fn heads(file: &Path) -> Vec<String> {
    let text = fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let head = text.lines().find(|line| !line.starts_with('#')).expect("a head").trim_end();
    head.split(',').map(|cell| cell.trim_matches('"').to_owned()).collect()
}

#[test]
fn the_dictionary_knows_every_column() {
    let folder = Folder::new("columns");
    let base = ["--set", "base.kind=free", "--set", "base.mass=30", "--set", "base.inertia=2"];
    let mut tables: Vec<(&str, Vec<&str>)> = vec![
        ("simulate", vec!["case-3", "--every", "1000"]),
        ("simulate", vec!["four-drive", "--every", "1000"]),
        ("export", vec!["case-3", "--rate", "10"]),
        ("export", [&["case-1", "--rate", "10", "--what", "simulated"][..], &base].concat()),
        ("joints", vec!["case-1"]),
        ("spectrum", vec!["case-1"]),
        ("compare", vec!["case-1", "two-drive"]),
        ("export-model", vec!["nine-link"]),
        ("export-model", vec!["scara"]),
    ];
    if cfg!(feature = "ui") {
        tables.push(("figures", vec!["case-1", "--what", "torque,moment"]));
    }
    let mut unknown = BTreeSet::new();
    for (i, (command, args)) in tables.iter().enumerate() {
        let ending = if *command == "figures" { "svg" } else { "csv" };
        let file = folder.path(&format!("{i}.{ending}"));
        let name = word(file.clone());
        let out = stillbase(&[&[*command][..], args, &["-o", &name]].concat());
        assert_eq!(out.status.code(), Some(0), "{command}: {}", text(&out.stderr));
        for head in heads(&file.with_extension("csv")) {
            // A comparison has results of runs and of machines.
            let holders: &[&str] = if *command == "compare" { &["runs", "design"] } else { &[command] };
            if !holders.iter().any(|holder| column(holder, &head).is_some()) {
                unknown.insert(format!("{command}: {head}"));
            }
        }
    }
    // A study has a column for each number that varies, named by its key, and the outcome.
    let file = word(folder.path("study.parquet"));
    prints(&["tolerance", "case-1", "--samples", "4", "--spread", "link.5.com=normal:0.001", "-o", &file]);
    let reader = parquet::file::reader::SerializedFileReader::new(fs::File::open(&file).expect("a file"));
    let reader = reader.expect("Parquet");
    let schema = parquet::file::reader::FileReader::metadata(&reader).file_metadata().schema_descr_ptr();
    let names: Vec<&str> =
        schema.columns().iter().map(|c| c.name()).filter(|name| !name.starts_with("link.")).collect();
    assert_eq!(names.len(), 5, "{names:?}");
    unknown.extend(
        names.iter().filter(|name| column("tolerance", name).is_none()).map(|name| format!("tolerance: {name}")),
    );
    assert!(unknown.is_empty(), "{} columns without meaning: {unknown:?}", unknown.len());
    assert!(
        column("joints", "tilt/z N m").is_none()
            && column("export", "qx").is_none()
            && column("simulate", "torque/1 N").is_none()
    );
}

#[cfg(feature = "record")]
#[test]
fn the_dictionary_knows_every_property_of_a_recording() {
    let folder = Folder::new("properties");
    let file = folder.path("all.rrd");
    let scenarios = ["case-1", "change-b", "circle", "drift", "wheel"];
    prints(&[&["headless"][..], &scenarios, &["-o", &word(file.clone())]].concat());
    let smooth = folder.path("smooth.rrd");
    let jerk = ["drive.1.jerk_limit=900", "drive.2.jerk_limit=900", "drive.3.jerk_limit=900"];
    let set: Vec<&str> = jerk.iter().chain(&["task.law=fastest-smooth"]).flat_map(|set| ["--set", set]).collect();
    prints(&[&["headless", "case-1", "-o", &word(smooth.clone())][..], &set].concat());
    let mut seen = BTreeSet::new();
    for file in [file, smooth] {
        let opened = std::io::BufReader::new(fs::File::open(&file).expect("a file"));
        for message in re_log_encoding::DecoderApp::decode_lazy(opened) {
            let re_log_types::LogMsg::ArrowMsg(_, message) = message.expect("whole") else { continue };
            let chunk = re_chunk::Chunk::from_arrow_msg(&message).expect("a chunk");
            if scenarios.iter().any(|name| chunk.entity_path().to_string() == format!("/__properties/{name}")) {
                seen.extend(chunk.components().values().map(|own| own.descriptor.component.to_string()));
            }
        }
    }
    assert!(["forecast_duration", "gap", "drift_3"].iter().all(|name| seen.contains(*name)), "{seen:?}");
    let unknown: Vec<&String> = seen.iter().filter(|name| column("recording", name).is_none()).collect();
    assert!(unknown.is_empty(), "{} properties without meaning: {unknown:?}", unknown.len());
    // What has an older name in a recording has both.
    for row in RESULTS.iter().flat_map(|(_, rows)| *rows).filter(|row| !row.newer.is_empty()) {
        if let Some(older) = row.name.strip_prefix("recording.") {
            let newer = row.newer.strip_prefix("recording.").unwrap_or(row.newer);
            assert!(seen.contains(older) && seen.contains(newer), "{older} and {newer}");
        }
    }
}

#[test]
fn results_are_listed_with_unit_and_meaning() {
    let list = prints(&["results", "peak_base_moment"]);
    assert!(list.contains("peak_base_moment  [N m]") && list.contains("Largest moment |n_B|"), "{list}");
    let page = prints(&["results", "--markdown"]);
    assert_eq!(
        page,
        include_str!("../../src/guide/results.md"),
        "`stillbase results --markdown > src/guide/results.md`"
    );
    fails(&["results", "no-such-word"], 1, &["no result has"]);
}
