//! `stillbase results`

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_settings::results::{OLD_NAMES_END, RESULTS, ResultRow, SIGNALS};

use super::failure::Failure;
use super::lookup::{DictionaryRow, Lookup, Page, cell};

/// List the results with their meaning, unit, sign and frame: keys of `--json`, signals, columns
///
/// A name means the same wherever it stands: in `--json`, in the head of a column, in a recording. Where it would not,
/// what holds it is before it, with a dot. In signals and columns `*` is a
/// placeholder for the name of a drive, an angle or a pin.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase results base_moment
  stillbase results tilt --json")]
pub struct ResultsArguments {
    #[command(flatten)]
    lookup: Lookup,
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
}

impl DictionaryRow for Row {
    fn part(&self) -> &'static str {
        self.part
    }

    fn matches(&self, word: &str) -> bool {
        let all = [self.result, &self.meaning, self.symbol.unwrap_or_default(), self.unit.unwrap_or_default()];
        all.iter().any(|text| text.to_lowercase().contains(word))
    }

    fn lines(&self) -> Vec<String> {
        let symbol = self.symbol.map_or_else(String::new, |symbol| format!(" ({symbol})"));
        let unit = self.unit.map_or_else(String::new, |unit| format!("  [{unit}]"));
        let head = format!("{}{symbol}{unit}", self.result);
        let sign = self.sign.map(|sign| format!("Positive: {sign}."));
        let frame = self.frame.map(|frame| format!("Frame: {frame}."));
        [head, self.meaning.clone()].into_iter().chain(sign).chain(frame).collect()
    }

    fn cells(&self) -> Vec<String> {
        let symbol = self.symbol.map_or_else(String::new, |symbol| format!(" {}", cell(symbol)));
        let sign = self.sign.map_or_else(String::new, |sign| format!(" Positive: {sign}."));
        let frame = self.frame.map_or_else(String::new, |frame| format!(" Frame: {frame}."));
        let (unit, meaning) = (self.unit.unwrap_or_default().to_owned(), cell(&self.meaning));
        vec![format!("`{}`{symbol}", self.result), unit, format!("{meaning}{sign}{frame}")]
    }
}

impl ResultsArguments {
    /// Prints the results.
    pub fn run(&self) -> Result<(), Failure> {
        let parts = RESULTS.iter().copied().chain([("Signals over time", SIGNALS)]);
        let all = parts.flat_map(|(part, rows)| rows.iter().map(move |row| Row::of(part, row)));
        let results = self.lookup.found(all, ("result", "results"))?;
        let text = format!(
            "# Every result\n\nA name means the same wherever it stands: in `--json`, in the head of a column, in a \
             recording. Where it would not, what holds it is before it, with a dot: `mend.point` is the `point` of \
             `mend`, `trim.rows` the `rows` of `stillbase trim`. In signals and columns `*` stands for the name of a \
             drive, an angle or a pin. A unit `1` marks a pure number; `of unit` says that the unit is beside it. Older \
             names stay beside newer ones until version {OLD_NAMES_END}.\n\n`stillbase results WORD` prints these on the \
             command line, and `stillbase schema COMMAND` the JSON Schema of an answer. This page is what `stillbase \
             results --markdown` writes.\n",
        );
        let page = Page { text, heads: &["result", "unit", "meaning"] };
        self.lookup.print(&Answer { results }, |answer| &answer.results, &page)
    }
}
