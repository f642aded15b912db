//! `stillbase keys`

use std::fmt::Write as _;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_session::scenario::KEYS;
use stillbase_settings::key::Key;

use super::failure::Failure;
use super::output::Format;

/// List the settings with their meaning, unit, range and default, and the condition for an effect
///
/// Each key is the same in a scenario's file, after `--set`, in an edit and in the window. `*` is a placeholder for the
/// name of a link, a length, a drive or a relative angle of the machine. The keys of the design may also stand in a
/// machine file, as the table `[design]`.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase keys friction
  stillbase keys base. --json")]
pub struct KeysArguments {
    /// Only keys with all of these words in their name, such as link.5.com, or in their description, such as Hz
    #[arg(value_name = "WORD")]
    words: Vec<String>,
    /// Print a page of documentation in Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    keys: Vec<Row>,
}

#[derive(JsonSchema, Serialize)]
struct Row {
    key: &'static str,
    holds: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'static str>,
    /// Default; `None` for a key that has to be given.
    #[serde(skip_serializing_if = "Option::is_none")]
    default: Option<&'static str>,
    /// What applies if the key has no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    instead: Option<&'static str>,
    words: &'static str,
    /// Condition for an effect.
    #[serde(skip_serializing_if = "Option::is_none")]
    when: Option<&'static str>,
    #[serde(skip)]
    part: &'static str,
    /// Default as text.
    #[serde(skip)]
    usual: String,
}

impl KeysArguments {
    /// Prints the settings.
    pub fn run(&self) -> Result<(), Failure> {
        let sought: Vec<String> = self.words.iter().flat_map(|w| w.split_whitespace()).map(str::to_lowercase).collect();
        let matches_words = |key: &&Key| {
            let all = format!("{} {} {} {}", key.path, key.meaning, key.value_type, key.when).to_lowercase();
            sought.iter().all(|word| all.contains(word) || key.matches(word))
        };
        let some = |text: &'static str| (!text.is_empty()).then_some(text);
        let of_part = |&(part, tables): &(&'static str, &'static [&'static [Key]])| {
            tables.iter().copied().flatten().filter(matches_words).map(move |key| Row {
                key: key.path,
                holds: key.value_type.to_string(),
                unit: some(key.unit()),
                default: some(key.default),
                instead: some(key.instead),
                words: key.meaning,
                when: some(key.when),
                part,
                usual: key.default_in_words(),
            })
        };
        let keys: Vec<Row> = KEYS.iter().flat_map(of_part).collect();
        if keys.is_empty() {
            let words = stillbase_settings::range::quote_clipped(&sought.join(" "));
            let why = format!("nothing is said of {words:?} in the list of keys: `stillbase keys` prints all of it");
            return Err(Failure::no_answer(why));
        }
        self.format
            .print(&Answer { keys }, |answer| if self.markdown { page(&answer.keys) } else { list(&answer.keys) })
    }
}

/// Formats the keys part by part, each with its meaning below.
fn list(rows: &[Row]) -> String {
    let mut text = String::new();
    for rows in rows.chunk_by(|a, b| a.part == b.part) {
        let Some(first) = rows.first() else { continue };
        let _ = writeln!(text, "{}{}\n", if text.is_empty() { "" } else { "\n" }, first.part);
        for row in rows {
            let _ = writeln!(text, "  {} = {}", row.key, row.default.unwrap_or("(has to be given)"));
            if let Some(instead) = row.instead {
                let _ = writeln!(text, "      Without it: {instead}.");
            }
            let _ = writeln!(text, "      {}\n      Holds {}.", row.words, row.holds);
            if let Some(when) = row.when {
                let _ = writeln!(text, "      Has an effect with {when}.");
            }
        }
    }
    text
}

/// Formats the page of the guide.
fn page(rows: &[Row]) -> String {
    let mut text = String::from(
        "# Every setting\n\nEach key is the same in a scenario's file, after `--set` on the command line, in an edit of a \
         saved session, and in the window under *All settings*. In a key, `*` stands for a name: of a link, a named length, \
         a drive or a relative angle of the machine. The word `default` removes a key, so that its default applies \
         again; `none` does the same where it is the default. A number out of range is refused with its range, and a key without effect is reported. \
         The keys of the design may also stand in a machine file, as the table `[design]`.\n\n\
         `stillbase keys WORD` prints these on the command line. This page is what `stillbase keys --markdown` writes.\n",
    );
    for rows in rows.chunk_by(|a, b| a.part == b.part) {
        let Some(first) = rows.first() else { continue };
        let _ = write!(text, "\n## {}\n\n| key | default | holds | meaning |\n|---|---|---|---|\n", first.part);
        for row in rows {
            let cell = |words: &str| words.replace('|', "\\|");
            let default = cell(&row.usual);
            let when = row.when.map_or_else(String::new, |when| format!(" Has an effect with {}.", cell(when)));
            let _ = writeln!(text, "| `{}` | {default} | {} | {}{when} |", row.key, cell(&row.holds), cell(row.words));
        }
    }
    text
}
