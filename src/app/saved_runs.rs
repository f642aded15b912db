//! [`SavedRuns`]: what a session file and a closed table keep of the table of runs: added rows, ticks and order.

use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use stillbase_query::{ByIdentity, ProgressCallback};
use stillbase_session::scenario::Scenario;
use stillbase_study::comparison::{ComparedRun, Comparison};

/// The user's part of a table of runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SavedRuns {
    /// Titles of the alternatives that are laid over.
    pub ticked: Vec<String>,
    /// Key of the column by which the table is sorted; empty for none.
    pub sorted_by: String,
    /// Whether the greatest value comes first.
    pub descending: bool,
    /// Rows that the user added, in their order.
    pub added: Vec<AddedRun>,
}

/// A row that the user added.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AddedRun {
    /// Whether it is laid over.
    pub shown: bool,
    /// The run.
    pub run: SavedRun,
}

/// A run of a row; in a file, its scenario as text.
#[derive(Clone, Debug, PartialEq)]
pub enum SavedRun {
    /// It has been made.
    Made(ByIdentity<ComparedRun>),
    /// It has been read from a file, and is still to be made.
    Text(Arc<str>),
}

impl Serialize for SavedRun {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Made(ByIdentity(run)) => serializer.serialize_str(&run.scenario.to_toml()),
            Self::Text(text) => serializer.serialize_str(text),
        }
    }
}

impl<'de> Deserialize<'de> for SavedRun {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        String::deserialize(from).map(|text| Self::Text(text.into()))
    }
}

impl SavedRun {
    /// Makes the run.
    ///
    /// # Errors
    /// If its text is no scenario, if the scenario cannot be run, or if `watch` stops it.
    pub fn make(&self, watch: ProgressCallback<'_>) -> Result<Arc<ComparedRun>, String> {
        match self {
            Self::Made(ByIdentity(run)) => Ok(run.clone()),
            Self::Text(text) => {
                let scenario = Scenario::parse(text, "a run side by side", None).map_err(|why| why.to_string())?;
                let name = scenario.name.clone();
                let run = ComparedRun::of_while(scenario, watch);
                run.map(Arc::new).map_err(|why| format!("the run {name} is not side by side again: {why}"))
            }
        }
    }
}

impl SavedRuns {
    /// Returns what the user has added to a table, ticked and sorted.
    fn of(table: &Comparison) -> Self {
        let own = table.entries().iter().filter(|entry| entry.added_by_user);
        let added = own.filter_map(|entry| {
            let run = entry.outcome.as_ref().ok()?;
            Some(AddedRun { shown: entry.shown, run: SavedRun::Made(ByIdentity(run.clone())) })
        });
        let (sorted_by, descending) = table.sorted_key().unwrap_or_default();
        Self { ticked: table.ticked(), sorted_by: sorted_by.into(), descending, added: added.collect() }
    }

    /// Returns what the user has added to a table, if it is open, and the `rest` that it does not hold yet.
    pub fn all(table: Option<&Comparison>, rest: &Self) -> Self {
        let Some(table) = table else { return rest.clone() };
        let mut all = Self::of(table);
        all.added.extend(rest.added.iter().cloned());
        all
    }

    /// Whether there is nothing to keep.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
