//! [`Facts`]: what panels say of a run that has to be found first. It is found when the run changes, not whenever a panel
//! is drawn.

use std::cell::OnceCell;
use std::sync::Arc;

use crate::mechanics::machine::{Inertia, builtins};
use crate::picture::scene::views::Views;
use crate::planning::pose_constant::Planes;
use crate::session::Session;
use crate::session::scenario::{Scenario, Value};
use crate::settings::change::{self, DEFAULT};
use crate::settings::key::{Holds, Key};
use crate::simulation::frame::Frame;

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
#[derive(Default)]
pub(super) struct Balance {
    /// Largest |g_k|, kg m, and whether that is as good as none.
    pub force: (f64, bool),
    /// Largest |C_kl|, kg m², and whether that is as good as none.
    pub coupling: (f64, bool),
    /// Of each drive, kg m².
    pub inertia: Vec<f64>,
}

/// Of a scenario, and of the instant on display.
#[derive(Default)]
pub(super) struct Facts {
    of: Option<Scenario>,
    /// Whether the machine differs from the built-in one of its name.
    pub machine_differs: bool,
    /// Whether the work differs from that of the built-in scenario of its name.
    pub work_differs: bool,
    pub balance: Balance,
    /// The moment that a change of b in motion takes, N m.
    pub price: f64,
    settings: OnceCell<Vec<Setting>>,
    /// The instant, its planes, and what [`Facts::standing`] says of it.
    stood: Option<(Instant, Option<(usize, f64)>)>,
}

/// What of an instant tells how the machine stands.
struct Instant {
    planes: Option<Arc<Planes>>,
    at: [f64; 3],
}

impl Instant {
    fn is(&self, other: &Self) -> bool {
        let same = match (&self.planes, &other.planes) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            (None, None) => true,
            _ => false,
        };
        same && self.at == other.at
    }
}

impl Facts {
    /// Finds what has to be said of a session, if its scenario has changed.
    pub fn of(&mut self, session: &Session) {
        let scenario = session.scenario();
        if self.of.as_ref() == Some(scenario) {
            return;
        }
        let (machine, inertia) = (&scenario.machine, Inertia::of(&scenario.machine));
        self.machine_differs = builtins().iter().any(|m| m.name() == machine.name() && m != machine);
        self.work_differs = Scenario::builtin(&scenario.name).is_some_and(|builtin| !same_work(&builtin, scenario));
        self.balance = Balance {
            force: (inertia.force_residual(), inertia.is_force_balanced()),
            coupling: (inertia.invariance_residual(), inertia.is_invariant()),
            inertia: (0..machine.drives()).map(|k| inertia.momentum(k)).collect(),
        };
        self.price = inertia.pose_inertia() * scenario.pose_acceleration;
        self.settings = OnceCell::new();
        self.of = Some(scenario.clone());
    }

    /// Finds how the machine stands at the instant on display.
    pub fn stand(&mut self, session: &Session, views: &Views) {
        let frame: &Frame = session.frame();
        let at = frame.in_base(frame.end_effector);
        let now = Instant { planes: session.run().planes().cloned(), at: [at.re, at.im, frame.b] };
        if self.stood.as_ref().is_none_or(|(then, _)| !then.is(&now)) {
            self.stood = Some((now, views.stage().standing(frame)));
        }
    }

    /// How many poses put the end effector where it is, and how far it is from the boundary of the workspace, m.
    pub fn standing(&self) -> Option<(usize, f64)> {
        self.stood.as_ref()?.1
    }

    /// All settings but rows from files; found when they are first asked for.
    pub fn settings(&self) -> &[Setting] {
        self.settings.get_or_init(|| {
            let Some(scenario) = &self.of else { return Vec::new() };
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
        })
    }
}

/// Whether two scenarios ask for the same, whatever the machine.
fn same_work(a: &Scenario, b: &Scenario) -> bool {
    a.task == b.task && a.plant == b.plant && a.base == b.base && a.control == b.control
}
