//! Query for how the planned motion of a run turns and shifts its free base.

use crate::Run;
use stillbase_mechanics::machine::Machine;
use stillbase_planning::Motion;
use stillbase_query::{ByIdentity, QuickQuery, QuickWork};
use stillbase_simulation::plant::{Base, BaseForecast, Friction, MovingBody};

struct PlannedBase;

impl QuickQuery for PlannedBase {
    type Input = (Machine, Base, ByIdentity<Motion>);
    type Answer = Option<BaseForecast>;

    fn answer((machine, base, motion): &Self::Input) -> Option<BaseForecast> {
        // A machine of too many drives for a base that moves is refused before a run begins.
        let body = MovingBody::of(machine, &Friction::default(), base, &motion.0.at(0.0).q).ok()?;
        BaseForecast::of(&body, &motion.0)
    }
}

/// Returns how the planned motion of a run turns and shifts its base, from the run's cache of queries; `None` unless the
/// base is free.
pub fn base_forecast(run: &Run) -> Option<BaseForecast> {
    let (scenario, motion) = (run.scenario(), ByIdentity(run.plan().motion.clone()));
    *run.queries().ask_if::<QuickWork<PlannedBase>>(
        |(machine, base, known)| *known == motion && *base == scenario.base && *machine == scenario.machine,
        || (scenario.machine.clone(), scenario.base, motion.clone()),
    )
}
