//! `stillbase results`

use std::fmt::Write as _;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_settings::range::quote_clipped;
use stillbase_settings::results::{OLD_NAMES_END, RESULTS, ResultRow, SIGNALS};

use super::failure::Failure;
use super::output::Format;

/// List the results with their meaning, unit, sign and frame: keys of `--json`, signals, columns
///
/// A name means the same wherever it stands: in `--json`, in the head of a column, in a recording. Where it would not,
/// what holds it is before it, with a dot. In signals `*` is a placeholder for the name of a drive, an angle or a pin.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase results base_moment
  stillbase results tilt --json")]
pub struct ResultsArguments {
    /// Only results with all of these words in their name or meaning
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
    results: Vec<Row>,
}

#[derive(JsonSchema, Serialize)]
struct Row {
    result: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    symbol: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'static str>,
    meaning: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    sign: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    frame: Option<&'static str>,
    /// The name that replaces an older one.
    #[serde(skip_serializing_if = "Option::is_none")]
    newer: Option<&'static str>,
    #[serde(skip)]
    part: &'static str,
}

impl Row {
    fn of(part: &'static str, row: &ResultRow) -> Self {
        let some = |text: &'static str| (!text.is_empty()).then_some(text);
        let meaning = if row.newer.is_empty() { row.meaning.into() } else { row.in_words() };
        let (result, symbol, unit) = (row.name, some(row.symbol), some(row.unit));
        Self {
            result,
            symbol,
            unit,
            meaning,
            sign: some(row.sign),
            frame: some(row.frame),
            newer: some(row.newer),
            part,
        }
    }

    fn matches(&self, word: &str) -> bool {
        let all = [self.result, &self.meaning, self.symbol.unwrap_or_default(), self.unit.unwrap_or_default()];
        all.iter().any(|text| text.to_lowercase().contains(word))
    }
}

impl ResultsArguments {
    /// Prints the results.
    pub fn run(&self) -> Result<(), Failure> {
        let sought: Vec<String> = self.words.iter().flat_map(|w| w.split_whitespace()).map(str::to_lowercase).collect();
        let parts = RESULTS.iter().copied().chain([("Signals over time", SIGNALS)]);
        let all = parts.flat_map(|(part, rows)| rows.iter().map(move |row| Row::of(part, row)));
        let results: Vec<Row> = all.filter(|row| sought.iter().all(|word| row.matches(word))).collect();
        if results.is_empty() {
            let words = quote_clipped(&sought.join(" "));
            let why = format!("no result has {words:?} in name or meaning: `stillbase results` prints all");
            return Err(Failure::no_answer(why));
        }
        let answer = Answer { results };
        self.format.print(&answer, |answer| if self.markdown { page(&answer.results) } else { list(&answer.results) })
    }
}

/// Formats the results part by part, each with its meaning below.
fn list(rows: &[Row]) -> String {
    let mut text = String::new();
    for rows in rows.chunk_by(|a, b| a.part == b.part) {
        let Some(first) = rows.first() else { continue };
        let _ = writeln!(text, "{}{}\n", if text.is_empty() { "" } else { "\n" }, first.part);
        for row in rows {
            let symbol = row.symbol.map_or_else(String::new, |symbol| format!(" ({symbol})"));
            let unit = row.unit.map_or_else(String::new, |unit| format!("  [{unit}]"));
            let _ = writeln!(text, "  {}{symbol}{unit}\n      {}", row.result, row.meaning);
            if let Some(sign) = row.sign {
                let _ = writeln!(text, "      Positive: {sign}.");
            }
            if let Some(frame) = row.frame {
                let _ = writeln!(text, "      Frame: {frame}.");
            }
        }
    }
    text
}

/// Formats the page of the guide.
fn page(rows: &[Row]) -> String {
    let mut text = format!(
        "# Every result\n\nA name means the same wherever it stands: in `--json`, in the head of a column, in a \
         recording. Where it would not, what holds it is before it, with a dot: `mend.point` is the `point` of `mend`, \
         `trim.rows` the `rows` of `stillbase trim`. In signals `*` stands for the name of a drive, an angle or a pin. \
         A unit `1` marks a pure number; `of unit` says that the unit is beside it. Older names stay in `--json` until \
         version {OLD_NAMES_END}.\n\n`stillbase results WORD` prints these on the command line, and `stillbase schema \
         COMMAND` the JSON Schema of an answer. This page is what `stillbase results --markdown` writes.\n",
    );
    for rows in rows.chunk_by(|a, b| a.part == b.part) {
        let Some(first) = rows.first() else { continue };
        let _ = write!(text, "\n## {}\n\n| result | unit | meaning |\n|---|---|---|\n", first.part);
        for row in rows {
            let cell = |words: &str| words.replace('|', "\\|");
            let symbol = row.symbol.map_or_else(String::new, |symbol| format!(" {}", cell(symbol)));
            let sign = row.sign.map_or_else(String::new, |sign| format!(" Positive: {sign}."));
            let frame = row.frame.map_or_else(String::new, |frame| format!(" Frame: {frame}."));
            let (unit, meaning) = (row.unit.unwrap_or_default(), cell(&row.meaning));
            let _ = writeln!(text, "| `{}`{symbol} | {unit} | {meaning}{sign}{frame} |", row.result);
        }
    }
    text
}
