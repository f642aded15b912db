//! [`Proposal`]: a way out of a refusal, or an improvement of a run. Each has been tried.
//!
//! Some refusals have none, because nothing that is changed leads out of them:
//!
//! | refusal | reason |
//! |---|---|
//! | stopped | the user has stopped the work |
//! | a session is full | it goes on from an earlier instant, which is chosen on the time line |
//! | too much output | what to leave out, rows or signals, only the user knows |
//! | a motion would leave new limits | the session applies such limits from the start of the motion |
//! | an unknown name of a key or a part, or one that is near no other | the message lists the names; which one was meant is open |
//! | the length of a link that others share | the message names its own key; a second setting cannot take back the first |

mod floating;
mod hand;
mod improve;
mod points;
mod refused;
mod task;
mod value;
mod wider;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Serialize, Serializer};
use toml::Table;

use crate::design::balancing_change;
use crate::edit::Edit;
use crate::replay::with_start_edits;
use crate::run::Run;
use crate::scenario::Scenario;
use stillbase_mechanics::machine::{Machine, is_of_machine};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_settings::change::{join, leaves, single_change, typed};

pub use hand::{OutsideLimits, TargetProposals};
pub use improve::{improvements, is_improvable};
pub use points::ReachablePoints;
pub use refused::{ProposalsQuery, RefusedChange, proposals, proposals_for_settings, proposals_while};
pub use value::proposals_for_values;

/// A way out: after it, what was refused can be done.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Proposal {
    /// What it does, as the label of a button: `take b = 2.2158 rad`.
    pub text: String,
    /// How it is done.
    #[serde(flatten)]
    pub way: WayOut,
}

/// How a proposal is carried out.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub enum WayOut {
    /// By settings, as files and edits state them; serialised as `--set` takes them: `task.b=2.2158`.
    #[serde(rename = "set", serialize_with = "as_typed")]
    Set(#[schemars(with = "Vec<String>")] Table),
    /// By edits of a session that change no setting, such as a drag; one after the other.
    #[serde(rename = "edits")]
    Edits(#[schemars(schema_with = "edits_schema")] Vec<Edit>),
    /// By another command line in place of the refused one, as a shell takes it.
    #[serde(rename = "command")]
    Command(String),
}

/// Edits are as a scenario file states them.
fn edits_schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": { "type": "object" } })
}

fn as_typed<S: Serializer>(change: &Table, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(typed_settings(change))
}

fn typed_settings(change: &Table) -> impl Iterator<Item = String> {
    leaves(change).into_iter().map(|(key, value)| format!("{key}={}", typed(value)))
}

impl Proposal {
    /// Returns a proposal of settings.
    pub(crate) fn new(text: impl Into<String>, change: Table) -> Self {
        Self { text: text.into(), way: WayOut::Set(change) }
    }

    /// Returns a proposal of an edit that changes no setting.
    fn of_edit(text: impl Into<String>, edit: Edit) -> Self {
        Self::of_edits(text, vec![edit])
    }

    /// Returns a proposal of edits that change no setting.
    fn of_edits(text: impl Into<String>, edits: Vec<Edit>) -> Self {
        Self { text: text.into(), way: WayOut::Edits(edits) }
    }

    /// Returns a proposal of another command line.
    pub fn of_command(text: impl Into<String>, command: impl Into<String>) -> Self {
        Self { text: text.into(), way: WayOut::Command(command.into()) }
    }

    fn of_task(text: impl Into<String>, change: Table) -> Self {
        Self::new(text, Table::from_iter([("task".to_owned(), change.into())]))
    }

    /// Returns the settings as files state them, if the proposal consists of settings.
    pub fn change(&self) -> Option<&Table> {
        match &self.way {
            WayOut::Set(change) => Some(change),
            WayOut::Edits(_) | WayOut::Command(_) => None,
        }
    }

    /// Returns the settings, each as `--set` takes it: `task.b=2.2158`; none if the proposal is no change of settings.
    pub fn settings(&self) -> Vec<String> {
        self.change().map_or_else(Vec::new, |change| typed_settings(change).collect())
    }

    /// Describes how the proposal is carried out: its settings, its edit or its command line.
    pub fn how(&self) -> String {
        match &self.way {
            WayOut::Set(_) => self.settings().join("\n"),
            WayOut::Edits(edits) => edits.iter().map(Edit::title).collect::<Vec<_>>().join("\n"),
            WayOut::Command(command) => command.clone(),
        }
    }

    /// Returns whether the proposal changes the machine.
    pub fn is_of_machine(&self) -> bool {
        self.change().is_some_and(|change| change.keys().any(|key| is_of_machine(key)))
    }

    /// Returns the proposal as edits, to be made one after the other; none for a command line.
    pub fn edits(&self) -> Vec<Edit> {
        match &self.way {
            WayOut::Set(change) => vec![Edit::Set { change: change.clone() }],
            WayOut::Edits(edits) => edits.clone(),
            WayOut::Command(_) => Vec::new(),
        }
    }

    /// Returns the edits of the proposal; if both it and a refused edit consist of settings, one edit with the settings
    /// of the refused one and then its own.
    pub fn edits_after(&self, edit: &Edit) -> Vec<Edit> {
        match (edit, self.change()) {
            (Edit::Set { change }, Some(own)) => vec![Edit::Set { change: join(change.clone(), own) }],
            _ => self.edits(),
        }
    }

    /// Returns the proposal without settings that change nothing.
    fn reduced(self, scenario: &Scenario) -> Self {
        let Some((changed, all)) = self.applied(scenario).zip(self.change()) else { return self };
        let all: Vec<Table> =
            leaves(all).into_iter().map(|(path, value)| single_change(&path, value.clone())).collect();
        let without = |kept: &[bool]| {
            let kept = all.iter().zip(kept).filter(|(_, kept)| **kept);
            Self::new(self.text.clone(), kept.fold(Table::new(), |all, (one, _)| join(all, one)))
        };
        let mut kept = vec![true; all.len()];
        for i in 0..all.len() {
            kept[i] = false;
            kept[i] = without(&kept).applied(scenario).is_none_or(|other| other != changed);
        }
        without(&kept)
    }

    /// Returns the scenario with the settings as they are typed: its edits come after them.
    fn typed(&self, scenario: &Scenario) -> Option<Scenario> {
        let changed = scenario.with_settings(self.change()?).ok()?;
        changed.check("").ok().map(|()| changed)
    }

    /// Returns the scenario that starts after the settings, with its edits before the first step.
    fn applied(&self, scenario: &Scenario) -> Option<Scenario> {
        Some(with_start_edits(&self.typed(scenario)?).ok()?.0)
    }

    /// Returns the run after the change, at rest at its start; `None` if it is refused.
    fn tried(&self, scenario: &Scenario) -> Option<Run> {
        Run::new(&self.applied(scenario)?).ok()
    }
}

/// Returns the proposal to balance a machine, if that gives it a pose constant.
pub fn proposals_for_machine(machine: &Machine) -> Vec<Proposal> {
    let Some(known) = Scenario::builtin("case-3") else { return Vec::new() };
    let scenario = Scenario { machine: machine.clone(), ..known };
    let balanced = balancing_change(&scenario).map(|change| Proposal::new("balance the machine", change));
    let works = |proposal: &Proposal| {
        let changed = proposal.change().and_then(|change| machine.with_settings(change).ok());
        changed.is_some_and(|machine| PoseSpace::of(&machine).is_ok())
    };
    balanced.filter(works).into_iter().collect()
}

/// Returns the next larger number of two significant digits.
pub(crate) fn round_up(x: f64) -> f64 {
    let unit = 10f64.powf(x.abs().log10().floor() - 1.0);
    let rounded = (x / unit).ceil() * unit;
    format!("{rounded:.1e}").parse().unwrap_or(rounded)
}
