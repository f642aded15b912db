//! [`Facts`]: what panels say of a run that has to be found first, asked for each picture of them.

use std::sync::Arc;

use crate::mechanics::machine::{Inertia, Machine, builtins};
use crate::mechanics::planar::Vector;
use crate::planning::pose_space::Planes;
use crate::query::{Queries, Quick, Same, Shared, Whole};
use crate::session::Session;
use crate::session::scenario::{Scenario, Value};
use crate::settings::change::{self, DEFAULT};
use crate::settings::key::{Holds, Key};

/// A setting and what can be said of it.
pub(super) struct Setting {
    pub path: String,
    pub key: &'static Key,
    /// As it would be typed; empty if it is not set.
    pub typed: String,
    /// Whether it is as usual.
    pub usual: bool,
    /// What it takes to have an effect, if it has none.
    pub wants: Option<&'static str>,
    /// Path and explanation in small letters, to be searched.
    pub text: String,
}

/// How well a machine is balanced.
pub(super) struct Balance {
    /// Largest |g_k|, kg m, and whether that is as good as none.
    pub force: (f64, bool),
    /// Largest |C_kl|, kg m², and whether that is as good as none.
    pub coupling: (f64, bool),
    /// Of each drive, kg m².
    pub inertia: Vec<f64>,
    /// What a change of b accelerates, kg m².
    pose_inertia: f64,
}

impl Quick for Balance {
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

/// What of a scenario differs from what is built in under the same names.
struct Differs {
    machine: bool,
    work: bool,
}

impl Quick for Differs {
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

/// How many poses of the plane b put the end effector on a point, m, and how far that is from the boundary of the
/// workspace, m, positive inside.
struct Standing;

impl Quick for Standing {
    type Input = (Same<Planes>, Vector, f64);
    type Answer = (usize, f64);

    fn answer((Same(planes), at, b): &Self::Input) -> (usize, f64) {
        let boundary = planes.boundary();
        (boundary.pose_count(*at, *b), boundary.distance(*at, *b))
    }
}

/// All settings of a scenario but rows from files.
struct Settings;

impl Quick for Settings {
    type Input = Shared<Scenario>;
    type Answer = Vec<Setting>;

    fn answer(Shared(scenario): &Self::Input) -> Vec<Setting> {
        // Rows come from files alone.
        let shown = scenario.settings().into_iter().filter(|(_, key, _)| key.holds != Holds::Rows);
        let setting = |(path, key, value): (String, &'static Key, Value)| {
            let typed = Some(change::typed(&value)).filter(|typed| typed != DEFAULT).unwrap_or_default();
            let normal = || change::same(&change::value(key.default), &value);
            Setting {
                usual: typed.is_empty() || key.default.is_empty() || normal(),
                wants: scenario.idle(&path),
                text: format!("{path}\n{}", key.words).to_lowercase(),
                typed,
                key,
                path,
            }
        };
        shown.map(setting).collect()
    }
}

/// Of a scenario, and of the instant on display.
pub(super) struct Facts<'a> {
    queries: &'a Queries,
    scenario: Shared<Scenario>,
    /// Whether the machine differs from the built-in one of its name.
    pub machine_differs: bool,
    /// Whether the work differs from that of the built-in scenario of its name.
    pub work_differs: bool,
    pub balance: Arc<Balance>,
    /// The moment that a change of b in motion takes, N m.
    pub price: f64,
    /// How many poses put the end effector where it is, and how far it is from the boundary of the workspace, m; none
    /// of a machine without planes.
    pub standing: Option<(usize, f64)>,
}

impl<'a> Facts<'a> {
    /// What has to be said of a session.
    pub fn of(queries: &'a Queries, session: &Session) -> Self {
        let (run, frame) = (session.run(), session.frame());
        let scenario = run.shared_scenario();
        let differs = queries.ask::<Whole<Differs>>(&scenario);
        let balance = queries.ask::<Whole<Balance>>(&scenario.0.machine);
        let at = frame.in_base(frame.end_effector);
        let stands = |planes: &Arc<Planes>| *queries.ask::<Whole<Standing>>(&(Same(planes.clone()), at, frame.b));
        Self {
            machine_differs: differs.machine,
            work_differs: differs.work,
            price: balance.pose_inertia * scenario.0.pose_acceleration,
            balance,
            standing: run.planes().map(stands),
            queries,
            scenario,
        }
    }

    /// All settings but rows from files.
    pub fn settings(&self) -> Arc<Vec<Setting>> {
        self.queries.ask::<Whole<Settings>>(&self.scenario)
    }
}

/// Whether two scenarios ask for the same, whatever the machine.
fn same_work(a: &Scenario, b: &Scenario) -> bool {
    a.task == b.task && a.plant == b.plant && a.base == b.base && a.control == b.control
}
