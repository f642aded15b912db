//! `stillbase keys`

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_session::assembly::ASSEMBLY_KEYS;
use stillbase_session::scenario::KEYS;
use stillbase_settings::key::Key;

use super::failure::Failure;
use super::lookup::{DictionaryRow, Lookup, Page, cell};

/// List the settings with their meaning, unit, range and default, and the condition for an effect
///
/// Each key is the same in a scenario's file, after `--set`, in an edit and in the window. `*` is a placeholder for the
/// name of a link, a length, a drive or a relative angle of the machine. The keys of the design may also stand in a
/// machine file, as the table `[design]`. Keys of assemblies are those of a scenario of several machines on one base.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase keys friction
  stillbase keys base. --json")]
pub struct KeysArguments {
    #[command(flatten)]
    lookup: Lookup,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    keys: Vec<Row>,
}

#[derive(JsonSchema, Serialize)]
struct Row {
    key: &'static str,
    /// Kind of scenario that has the key; `None` for one of a machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    of: Option<&'static str>,
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
    #[serde(skip)]
    own: &'static Key,
}

impl Row {
    fn of(of: Option<&'static str>, part: &'static str, key: &'static Key) -> Self {
        let some = |text: &'static str| (!text.is_empty()).then_some(text);
        Self {
            key: key.path,
            of,
            holds: key.value_type.to_string(),
            unit: some(key.unit()),
            default: some(key.default),
            instead: some(key.instead),
            words: key.meaning,
            when: some(key.when),
            part,
            own: key,
        }
    }
}

impl DictionaryRow for Row {
    fn part(&self) -> &'static str {
        self.part
    }

    fn matches(&self, word: &str) -> bool {
        let Key { path, meaning, value_type, when, .. } = self.own;
        format!("{path} {meaning} {value_type} {when}").to_lowercase().contains(word) || self.own.matches(word)
    }

    fn lines(&self) -> Vec<String> {
        let head = format!("{} = {}", self.key, self.default.unwrap_or("(has to be given)"));
        let instead = self.instead.map(|instead| format!("Without it: {instead}."));
        let when = self.when.map(|when| format!("Has an effect with {when}."));
        let holds = format!("Holds {}.", self.holds);
        [head].into_iter().chain(instead).chain([self.words.into(), holds]).chain(when).collect()
    }

    fn cells(&self) -> Vec<String> {
        let when = self.when.map_or_else(String::new, |when| format!(" Has an effect with {}.", cell(when)));
        let default = cell(&self.own.default_in_words());
        vec![format!("`{}`", self.key), default, cell(&self.holds), format!("{}{when}", cell(self.words))]
    }
}

impl KeysArguments {
    /// Prints the settings.
    pub fn run(&self) -> Result<(), Failure> {
        let rows = |of: Option<&'static str>, all: &'static [(&'static str, &'static [&'static [Key]])]| {
            let of_part = move |(part, tables): &'static (&'static str, &'static [&'static [Key]])| {
                tables.iter().copied().flatten().map(move |key| Row::of(of, part, key))
            };
            all.iter().flat_map(of_part)
        };
        let keys = rows(None, &KEYS).chain(rows(Some("assembly"), &ASSEMBLY_KEYS));
        let keys = self.lookup.found(keys, ("key", "keys"))?;
        let text = "# Every setting\n\nEach key is the same in a scenario's file, after `--set` on the command line, in an edit of a \
         saved session, and in the window under *All settings*. In a key, `*` stands for a name: of a link, a named length, \
         a drive or a relative angle of the machine. The word `default` removes a key, so that its default applies \
         again; `none` does the same where it is the default. A number out of range is refused with its range, and a key without effect is reported. \
         The keys of the design may also stand in a machine file, as the table `[design]`. \
         Keys of an assembly are those of a scenario of several machines on one base: in it, `task.BLOCK.KEY` is `task.KEY` of the \
         block's machine, `scenario.BLOCK.KEY` any of its keys of control and the like, and `BLOCK.KEY` after `--set` a key of the \
         machine itself.\n\n\
         `stillbase keys WORD` prints these on the command line. This page is what `stillbase keys --markdown` writes.\n";
        let page = Page { text: text.into(), heads: &["key", "default", "holds", "meaning"] };
        self.lookup.print(&Answer { keys }, |answer| &answer.keys, &page)
    }
}
