//! [`ScenarioFacts`]: computed values that the panels show, requested from the query cache at each repaint.

use std::sync::Arc;

use super::guide::{Section, Sections};
use stillbase_mechanics::machine::{Inertia, Machine, builtins};
use stillbase_mechanics::planar::Vector;
use stillbase_planning::pose_space::Planes;
use stillbase_query::{ByIdentity, Queries, QuickQuery, QuickWork, Shared};
use stillbase_session::scenario::{Scenario, Value, name_of, search_words};
use stillbase_session::{Proposal, Session, TargetProposals};
use stillbase_settings::change::{self, DEFAULT_WORD};
use stillbase_settings::key::{Key, KeyType};

/// A setting and its state.
pub(super) struct Setting {
    pub path: String,
    pub key: &'static Key,
    /// Its value as the user would type it; empty if it is not set.
    pub typed: String,
    /// Whether its value is the default. Also true if it is not set, or if the key has no default.
    pub is_default: bool,
    /// If the setting has no effect now: the condition under which it has one.
    pub unmet_condition: Option<&'static str>,
    /// Its plain name.
    pub name: String,
    /// Explanation, and further words by which it is looked for.
    pub also: String,
    /// Path, name, explanation and further words in lower case, to be searched.
    text: String,
}

impl Setting {
    /// Whether path, name, explanation or further words contain every word of a search text in lower case.
    pub fn contains(&self, sought: &str) -> bool {
        sought.split_whitespace().all(|word| self.text.contains(word))
    }

    /// Returns plain name and path; only the name if both are the same.
    pub fn name_and_path(&self) -> String {
        if self.name == self.path { self.name.clone() } else { format!("{} ({})", self.name, self.path) }
    }
}

/// Residuals of the balance of a machine.
pub(super) struct BalanceSummary {
    /// Largest |g_k|, kg m, and whether it is within the tolerance of zero.
    pub force: (f64, bool),
    /// Largest |C_kl|, kg m², and whether it is within the tolerance of zero.
    pub coupling: (f64, bool),
    /// D_k of each drive, kg m².
    pub inertia: Vec<f64>,
    /// Inertia that a change of b accelerates, kg m².
    pose_inertia: f64,
}

impl QuickQuery for BalanceSummary {
    type Input = Machine;
    type Answer = Self;

    fn answer(machine: &Machine) -> Self {
        let inertia = Inertia::of(machine);
        Self {
            force: (inertia.force_residual(), inertia.is_force_balanced()),
            coupling: (inertia.invariance_residual(), inertia.is_invariant()),
            inertia: (0..machine.drives()).map(|k| inertia.momentum(k)).collect(),
            pose_inertia: inertia.pose_inertia(),
        }
    }
}

/// Differences of the machine and the task setup of a scenario from the built-in ones of the same names.
struct Differs {
    machine: bool,
    work: bool,
}

impl QuickQuery for Differs {
    type Input = Shared<Scenario>;
    type Answer = Self;

    fn answer(Shared(scenario): &Self::Input) -> Self {
        let machine = &scenario.machine;
        Self {
            machine: builtins().iter().any(|m| m.name() == machine.name() && m != machine),
            work: Scenario::builtin(&scenario.name).is_some_and(|builtin| !same_work(&builtin, scenario)),
        }
    }
}

/// Query about a position of the end effector, m, on the plane b, rad. Returns its number of poses and its distance
/// from the boundary of the workspace, m, positive inside.
struct Standing;

impl QuickQuery for Standing {
    type Input = (ByIdentity<Planes>, Vector, f64);
    type Answer = (usize, f64);

    fn answer((ByIdentity(planes), at, b): &Self::Input) -> (usize, f64) {
        let boundary = planes.boundary();
        (boundary.pose_count(*at, *b), boundary.distance(*at, *b))
    }
}

/// Query for all settings of a scenario except tables of samples.
struct Settings;

impl QuickQuery for Settings {
    type Input = Shared<Scenario>;
    type Answer = Vec<Setting>;

    fn answer(Shared(scenario): &Self::Input) -> Vec<Setting> {
        // Tables of samples cannot be typed: they come from files.
        let shown = scenario.settings().into_iter().filter(|(_, key, _)| key.value_type != KeyType::Rows);
        let setting = |(path, key, value): (String, &'static Key, Value)| {
            let typed = Some(change::typed(&value)).filter(|typed| typed != DEFAULT_WORD).unwrap_or_default();
            let (name, also) = (name_of(&path), format!("{} {}", key.meaning, search_words(&path)));
            let is_default = || change::same_value(&change::value(key.default), &value);
            Setting {
                is_default: typed.is_empty() || key.default.is_empty() || is_default(),
                unmet_condition: scenario.condition_for_effect(&path),
                text: format!("{path}\n{name}\n{also}").to_lowercase(),
                name,
                also,
                typed,
                key,
                path,
            }
        };
        shown.map(setting).collect()
    }
}

/// Values of a scenario and of the instant on display.
pub(super) struct ScenarioFacts<'a> {
    pub queries: &'a Queries,
    scenario: Shared<Scenario>,
    /// Whether the machine differs from that of the session's file; without a file, from the built-in one of its name.
    pub machine_differs: bool,
    /// Whether task, plant, base or control differ from those of the session's file. They must differ from those of the
    /// built-in scenario of its name, too.
    pub work_differs: bool,
    pub balance: Arc<BalanceSummary>,
    /// Base moment that a change of b causes while time runs, N m.
    pub price: f64,
    /// Number of poses that put the end effector at its present point, and the point's distance from the workspace
    /// boundary, m, positive inside. `None` for a machine without planes.
    pub standing: Option<(usize, f64)>,
    /// Proposals for a target that is out of reach; none while it is being dragged, and until they are known.
    pub target_proposals: Arc<Vec<Proposal>>,
}

impl<'a> ScenarioFacts<'a> {
    /// Queries the values of a session; `stated` is the scenario as the file of the session states it.
    pub fn of(queries: &'a Queries, session: &Session, stated: Option<&Scenario>) -> Self {
        let (run, frame) = (session.run(), session.frame());
        let scenario = run.shared_scenario();
        let differs = queries.ask::<QuickWork<Differs>>(&scenario);
        let balance = queries.ask::<QuickWork<BalanceSummary>>(&scenario.0.machine);
        let at = frame.in_base(frame.end_effector);
        let stands =
            |planes: &Arc<Planes>| *queries.ask::<QuickWork<Standing>>(&(ByIdentity(planes.clone()), at, frame.b));
        let missed = session.missed_target().filter(|_| !session.is_in_gesture());
        // With several shapes for each point the search takes longer than a repaint.
        let ways_out = |missed| queries.ask_in_background::<QuickWork<TargetProposals>>(&missed).known().cloned();
        Self {
            machine_differs: scenario.0.assembly.is_none()
                && stated.map_or(differs.machine, |stated| stated.machine != scenario.0.machine),
            work_differs: differs.work && stated.is_none_or(|stated| !same_work(stated, &scenario.0)),
            price: balance.pose_inertia * scenario.0.pose_acceleration,
            balance,
            standing: run.planes().map(stands),
            target_proposals: missed.and_then(ways_out).unwrap_or_default(),
            queries,
            scenario,
        }
    }

    /// Queries the sections of the guide.
    pub fn guide(&self) -> Arc<Vec<Section>> {
        self.queries.ask::<QuickWork<Sections>>(&())
    }

    /// Queries all settings except tables of samples.
    pub fn settings(&self) -> Arc<Vec<Setting>> {
        self.queries.ask::<QuickWork<Settings>>(&self.scenario)
    }
}

/// Whether two scenarios agree in task, plant, base and control.
fn same_work(a: &Scenario, b: &Scenario) -> bool {
    a.task == b.task && a.plant == b.plant && a.base == b.base && a.control == b.control
}
