//! Query for how the planned motion of a run turns and shifts its free base.

use std::sync::Arc;

use crate::Run;
use crate::planner::carried;
use stillbase_mechanics::machine::Machine;
use stillbase_planning::Motion;
use stillbase_planning::off_plane::base_forecast::BaseForecast;
use stillbase_query::{ByIdentity, QuickQuery, QuickWork};
use stillbase_simulation::plant::Base;

struct PlannedBase;

impl QuickQuery for PlannedBase {
    type Input = (Machine, Base, ByIdentity<Motion>);
    type Answer = Option<Arc<BaseForecast>>;

    fn answer((machine, base, motion): &Self::Input) -> Self::Answer {
        BaseForecast::of(&carried(machine, base), &motion.0).map(Arc::new)
    }
}

/// Returns how the planned motion of a run turns and shifts its base, from the run's cache of queries; `None` unless the
/// base is free.
pub fn base_forecast(run: &Run) -> Option<Arc<BaseForecast>> {
    let (scenario, motion) = (run.scenario(), ByIdentity(run.plan().motion.clone()));
    let found = run.queries().ask_if::<QuickWork<PlannedBase>>(
        |(machine, base, known)| *known == motion && *base == scenario.base && *machine == scenario.machine,
        || (scenario.machine.clone(), scenario.base, motion.clone()),
    );
    (*found).clone()
}
