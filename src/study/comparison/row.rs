//! [`ComparisonTable`]: results of several runs, without their frames.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::summary::{OLD_NAMES, SummaryColumn};
use super::{ComparedRun, DesignCandidate, DesignMeasures, SUMMARY_COLUMNS, Summary};
use stillbase_session::ProgressCallback;
use stillbase_session::scenario::Scenario;

/// Results of a run, or why it failed.
#[derive(Clone, Debug)]
pub struct ComparisonRow {
    /// Name of the scenario.
    pub name: String,
    /// Name of the alternative, if alternatives for one task are compared.
    pub alternative: Option<&'static str>,
    /// Results, or why there are none.
    pub outcome: Result<Summary, String>,
    /// Comparison of the run's machine with the machine of the first run.
    pub design: Option<DesignMeasures>,
}

/// Results of several runs, in order.
#[derive(Clone, Debug, Default)]
pub struct ComparisonTable {
    rows: Vec<ComparisonRow>,
    baseline: BaselineMachines,
}

/// Compares machines with the first of them.
#[derive(Clone, Debug, Default)]
pub struct BaselineMachines {
    first: Option<DesignCandidate>,
    differ: bool,
}

impl BaselineMachines {
    /// Compares the next machine with the first; the first is compared with itself.
    pub fn set(&mut self, next: &DesignCandidate) -> DesignMeasures {
        let first = self.first.get_or_insert_with(|| next.clone());
        self.differ |= !next.is_alike(first);
        next.compared_with(first)
    }

    /// Returns whether any machine differs from the first, so that there are designs to compare.
    pub fn differ(&self) -> bool {
        self.differ
    }
}

impl ComparisonTable {
    /// Runs a scenario to its end, or as long as `watch` returns `true`, and adds it as a row.
    pub fn run(&mut self, alternative: Option<&'static str>, scenario: &Scenario, watch: ProgressCallback<'_>) {
        let outcome = ComparedRun::of_while(scenario.clone(), watch).map_err(|why| why.to_string());
        let design = outcome.as_ref().ok().map(|run| self.baseline.set(&run.candidate));
        let outcome = outcome.map(|run| run.summary);
        self.rows.push(ComparisonRow { name: scenario.name.clone(), alternative, outcome, design });
    }

    /// Returns all rows.
    pub fn rows(&self) -> &[ComparisonRow] {
        &self.rows
    }

    /// Returns whether the machines of the runs differ.
    pub fn have_designs(&self) -> bool {
        self.baseline.differ()
    }
}

impl ComparisonRow {
    /// Returns the title: the alternative, or else the scenario's name.
    pub fn title(&self) -> &str {
        self.alternative.unwrap_or(&self.name)
    }
}

impl Serialize for ComparisonTable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.rows.serialize(serializer)
    }
}

/// Serialised as the columns that have a value.
impl Serialize for ComparisonRow {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("scenario", &self.name)?;
        if let Some(way) = self.alternative {
            map.serialize_entry("way", way)?;
        }
        match &self.outcome {
            Ok(summary) => {
                for column in SUMMARY_COLUMNS {
                    if let Some(value) = (column.value)(summary) {
                        for name in names(&column) {
                            map.serialize_entry(name, &value)?;
                        }
                    }
                }
                map.serialize_entry("reactionless", &summary.reactionless)?;
                map.serialize_entry("verdict", &summary.verdict.sentence())?;
                if let Some(design) = &self.design {
                    map.serialize_entry("design", design)?;
                }
                if let Some(fault) = &summary.fault {
                    map.serialize_entry("audit_failed", fault)?;
                    map.serialize_entry("audit", fault)?;
                }
            }
            Err(why) => map.serialize_entry("refused", why)?,
        }
        map.end()
    }
}

/// Returns the name of a result, and the one it had before, if any.
fn names(column: &SummaryColumn) -> impl Iterator<Item = &'static str> {
    let old = OLD_NAMES.iter().filter(move |(name, _)| *name == column.key).map(|(_, old)| *old);
    std::iter::once(column.key).chain(old)
}

impl JsonSchema for ComparisonTable {
    fn schema_name() -> Cow<'static, str> {
        "ComparisonTable".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        <Vec<ComparisonRow>>::json_schema(generator)
    }
}

impl JsonSchema for ComparisonRow {
    fn schema_name() -> Cow<'static, str> {
        "ComparisonRow".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({
            "type": "object",
            "properties": {
                "scenario": { "type": "string" },
                "way": { "type": "string" },
                "reactionless": { "type": "boolean" },
                "verdict": { "type": "string" },
                "design": generator.subschema_for::<DesignMeasures>(),
                "audit_failed": { "type": "string" },
                "audit": { "type": "string" },
                "refused": { "type": "string" },
            },
            "required": ["scenario"],
        });
        let properties = schema.get_mut("properties").and_then(|properties| properties.as_object_mut());
        properties.into_iter().for_each(|properties| {
            let number = || json_schema!({ "type": "number" }).to_value();
            properties.extend(SUMMARY_COLUMNS.iter().flat_map(names).map(|name| (name.to_owned(), number())));
        });
        schema
    }
}
