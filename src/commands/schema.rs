//! `stillbase schema`

use std::io::{self, Write};

use clap::Args;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value, json};
use stillbase_settings::range::quote_clipped;
use stillbase_settings::results::find;
use stillbase_settings::spelling::nearest_words;

use super::exit::FailureReport;
use super::failure::Failure;

/// Print the JSON Schema of what a command prints with `--json`, or of all commands
///
/// The schema follows draft 2020-12. Meaning, unit, sign and frame of each property are those of `stillbase results`.
/// The name `refusal` gives the schema of what every command prints with `--json` if it has no answer.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase schema check
  stillbase schema > stillbase.schema.json")]
pub struct SchemaArguments {
    /// A command, or `refusal`
    #[arg(value_name = "COMMAND")]
    command: Option<String>,
}

const DRAFT: &str = "https://json-schema.org/draft/2020-12/schema";
/// Name of the schema of a refusal.
const REFUSAL: &str = "refusal";

/// Returns the schema of what a type prints.
pub fn of<T: JsonSchema>() -> Schema {
    let settings = SchemaSettings::draft2020_12().for_serialize().with(|settings| {
        settings.inline_subschemas = true;
        settings.meta_schema = None;
    });
    settings.into_generator().into_root_schema_for::<T>()
}

/// Returns the schema of each command that prints JSON, and of a refusal, by name.
fn schemas() -> Vec<(String, Value)> {
    let answers = super::names().into_iter().zip(super::answers());
    let all = answers.chain([(REFUSAL.to_owned(), vec![of::<FailureReport<'static>>()])]);
    let all = all.filter(|(_, answers)| !answers.is_empty());
    all.map(|(command, answers)| {
        let mut answers: Vec<Value> = answers.into_iter().map(Schema::to_value).collect();
        answers.iter_mut().for_each(|answer| describe(answer, &mut vec![command.clone()]));
        let mut schema = match answers.len() {
            1 => answers.remove(0),
            _ => json!({ "anyOf": answers }),
        };
        if let Some(object) = schema.as_object_mut() {
            let title =
                if command == REFUSAL { "stillbase: a refusal".into() } else { format!("stillbase {command} --json") };
            // That of a type says nothing of the whole.
            object.remove("description");
            object.insert("title".into(), title.into());
        }
        (command, schema)
    })
    .collect()
}

/// Describes the properties of a schema from the dictionary of results, and takes out what JSON never holds here: no
/// answer has a null. `path` leads to what the schema is of: the command, then properties.
fn describe(schema: &mut Value, path: &mut Vec<String>) {
    let Some(object) = schema.as_object_mut() else { return };
    object.remove("format");
    object.remove("title");
    without_null(object);
    if let Some(properties) = object.get_mut("properties").and_then(Value::as_object_mut) {
        for (name, property) in properties {
            path.push(name.clone());
            describe(property, path);
            let words: Vec<&str> = path.iter().map(String::as_str).collect();
            let row = find(&words);
            path.pop();
            let Some(row) = row else { continue };
            if let Some(property) = property.as_object_mut() {
                property.insert("description".into(), row.in_words().into());
                if !row.unit.is_empty() {
                    property.insert("unit".into(), row.unit.into());
                }
                if !row.newer.is_empty() {
                    property.insert("deprecated".into(), true.into());
                }
            }
        }
    }
    for part in ["items", "additionalProperties"] {
        object.get_mut(part).into_iter().for_each(|part| describe(part, path));
    }
    for parts in ["anyOf", "oneOf", "allOf", "prefixItems"] {
        let parts = object.get_mut(parts).and_then(Value::as_array_mut);
        parts.into_iter().flatten().for_each(|part| describe(part, path));
    }
}

/// Takes the alternative null out of a schema.
fn without_null(object: &mut Map<String, Value>) {
    if let Some(types) = object.get_mut("type").and_then(Value::as_array_mut) {
        types.retain(|one| one != "null");
        if let [one] = &types[..] {
            let one = one.clone();
            object.insert("type".into(), one);
        }
    }
    let Some(all) = object.get_mut("anyOf").and_then(Value::as_array_mut) else { return };
    let count = all.len();
    all.retain(|one| one.get("type").is_none_or(|kind| kind != "null"));
    if all.len() < count
        && let [Value::Object(only)] = &all[..]
    {
        let only = only.clone();
        object.remove("anyOf");
        object.extend(only);
    }
}

impl SchemaArguments {
    /// Prints the schema.
    pub fn run(&self) -> Result<(), Failure> {
        let all = schemas();
        let mut schema = match &self.command {
            Some(command) => match all.iter().find(|(name, _)| name == command) {
                Some((_, schema)) => schema.clone(),
                None => return Err(unknown(command, &all)),
            },
            None => {
                let parts: Vec<Value> =
                    all.iter().map(|(name, _)| json!({ "$ref": format!("#/$defs/{name}") })).collect();
                json!({ "title": "stillbase --json", "anyOf": parts, "$defs": all.into_iter().collect::<Map<_, _>>() })
            }
        };
        if let Some(object) = schema.as_object_mut() {
            object.insert("$schema".into(), DRAFT.into());
        }
        let text = serde_json::to_string_pretty(&schema).map_err(Failure::wrong_input)? + "\n";
        let mut out = io::stdout().lock();
        out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| Failure::standard_output(&e))
    }
}

/// Returns the failure that a command prints no JSON, with the nearest that does.
fn unknown(command: &str, all: &[(String, Value)]) -> Failure {
    let names: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
    let nearest = nearest_words(command, names.iter().copied());
    let list = if nearest.is_empty() { names.join(", ") } else { format!("{} (nearest)", nearest.join(" or ")) };
    let command = quote_clipped(command);
    Failure::wrong_input(format!("{command:?}: no command of this name prints JSON: want {list}"))
}
