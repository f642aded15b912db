//! [`AssemblyBlock`]: the machine of a scenario as a block of an assembly.

use std::sync::Arc;

use super::file::AssemblyScenario;
use crate::edit::Edit;
use crate::refusal::Refusal;
use crate::scenario::Scenario;

/// The assembly of which the machine of a scenario is a block, with what the other blocks do.
#[derive(Clone, Debug)]
pub struct AssemblyBlock {
    /// The whole. Its task of this block is that of the file; the scenario overrules it.
    pub scenario: Arc<AssemblyScenario>,
    /// Place of the block in the assembly.
    pub block: usize,
}

impl PartialEq for AssemblyBlock {
    fn eq(&self, other: &Self) -> bool {
        self.block == other.block && (Arc::ptr_eq(&self.scenario, &other.scenario) || self.scenario == other.scenario)
    }
}

/// Settings of a block that change neither its machine nor the base.
const OWN_KEYS: [&str; 5] = ["task", "control", "compare_b", "pose_acceleration", "duration"];

impl AssemblyBlock {
    /// Returns the name of the block.
    pub fn name(&self) -> &str {
        &self.scenario.assembly.blocks()[self.block].name
    }

    /// Returns what another block does, as a scenario of its machine by itself.
    pub fn task(&self, block: &str) -> Option<&Scenario> {
        let place = self.scenario.assembly.blocks().iter().position(|own| own.name == block)?;
        Some(&self.scenario.tasks[place].scenario)
    }

    /// Returns the scenario of the whole assembly, in which this block does what `own` states.
    pub fn whole(&self, own: &Scenario) -> AssemblyScenario {
        let mut whole = AssemblyScenario::clone(&self.scenario);
        let task = &mut whole.tasks[self.block];
        let (name, title, summary) = (self.name().to_owned(), String::new(), String::new());
        let scenario = Scenario { name, title, summary, duration: None, assembly: None, ..own.clone() };
        // A task of its own takes the place of the path that led the block.
        let is_led = scenario.task == task.scenario.task;
        whole.tip = whole.tip.filter(|tip| is_led || !tip.blocks.contains(&self.block));
        let task = &mut whole.tasks[self.block];
        task.rests &= scenario.task == task.scenario.task && scenario.edits.is_empty();
        task.scenario = scenario;
        whole.share_drags(self.block);
        if let Some(duration) = own.duration {
            // What comes after the end of the session has not happened.
            let end = (duration / whole.step).round() as u64;
            whole.tasks.iter_mut().for_each(|task| task.scenario.edits.retain(|timed| timed.step <= end));
        }
        (whole.name, whole.title, whole.summary) = (own.name.clone(), own.title.clone(), own.summary.clone());
        (whole.duration, whole.lead) = (own.duration, self.block);
        whole.follow(self.block);
        whole
    }

    /// Returns this block of an assembly in which the bound block, if there is one, follows what `own` plans.
    pub(crate) fn followed(self: &Arc<Self>, own: &Scenario) -> Arc<Self> {
        match self.scenario.follower_of(self.block) {
            Some(_) => Arc::new(Self { scenario: Arc::new(self.whole(own)), block: self.block }),
            None => self.clone(),
        }
    }

    /// Checks that an edit concerns what the block does: its machine and the base belong to the assembly.
    pub(crate) fn check(&self, edit: &Edit) -> Result<(), Refusal> {
        let foreign = match edit {
            Edit::Set { change } => change.keys().find(|key| !OWN_KEYS.contains(&key.as_str())).cloned(),
            Edit::Sketch(_) => Some("the drawing".into()),
            Edit::Push { .. } => Some("a force at the end effector".into()),
            _ => None,
        };
        foreign.map_or(Ok(()), |what| {
            let (name, assembly) = (self.name(), &self.scenario.assembly.name);
            Err(Refusal::Task(format!(
                "{what}: {name} is a block of the assembly {assembly}, whose file holds machines and base: want it changed \
                 there, or one of {} changed here",
                OWN_KEYS.join(", ")
            )))
        })
    }
}

impl AssemblyScenario {
    /// Returns the scenario of a block; the others do in it what they do in this one.
    ///
    /// # Panics
    /// If there is no such block.
    pub fn leading(&self, block: usize) -> Scenario {
        let mut whole = self.clone();
        whole.gather_hand_overs(block);
        let own = whole.tasks[block].scenario.clone();
        let assembly = Some(Arc::new(AssemblyBlock { scenario: Arc::new(whole), block }));
        let (name, title, summary) = (self.name.clone(), self.title.clone(), self.summary.clone());
        Scenario { name, title, summary, duration: self.duration, assembly, ..own }
    }

    /// Returns the scenario of the whole, if the machine of a scenario is a block of an assembly.
    pub fn of(scenario: &Scenario) -> Option<Self> {
        Some(scenario.assembly.as_ref()?.whole(scenario))
    }
}
