//! Which keys of a scenario of an assembly have no effect.

use super::base::AssemblyBase;
use super::file::{AssemblyScenario, BLOCK_KEYS};
use super::keys::assembly_key_of;
use super::stated_base::StatedBase;
use stillbase_simulation::plant::BaseKind;

impl AssemblyBase {
    /// Returns the word by which files state how it is held.
    fn kind(&self) -> BaseKind {
        match self {
            Self::Fixed => BaseKind::Fixed,
            Self::Free(_) => BaseKind::Free,
            Self::Compliant(_) => BaseKind::Compliant,
        }
    }
}

impl AssemblyScenario {
    /// Returns the condition for a key, such as `base.mass` or `task.arm.b_to`, to have an effect, if it has none now.
    pub fn condition_for_effect(&self, path: &str) -> Option<&'static str> {
        let (part, key) = path.split_once('.')?;
        if part == "base" {
            let base = StatedBase { kind: self.base.kind(), ..StatedBase::default() };
            return if base.uses(key) { None } else { assembly_key_of(path).map(|key| key.when) };
        }
        if part == "tip" {
            let path = &self.tip.as_ref()?.path;
            return if path.uses(key) { None } else { assembly_key_of(&format!("tip.{key}")).map(|key| key.when) };
        }
        let (block, key) = key.split_once('.')?;
        let scenario = &self.tasks[self.assembly.blocks().iter().position(|own| own.name == block)?].scenario;
        match part {
            "task" => scenario.condition_for_effect(&format!("task.{key}")),
            "scenario" => scenario.condition_for_effect(key),
            _ => None,
        }
    }

    /// Returns the stated keys that have no effect, each with the condition for one.
    pub fn ineffective_keys(&self) -> Vec<(String, &'static str)> {
        let of_base = self.idle.keys().map(|key| format!("base.{key}"));
        let of_base = of_base.filter_map(|path| self.condition_for_effect(&path).map(|when| (path, when)));
        let is_led = |i: usize| self.tip.as_ref().is_some_and(|tip| tip.blocks.contains(&i));
        let blocks = self.assembly.blocks().iter().zip(&self.tasks).enumerate();
        let of_blocks = blocks.filter(|(i, (_, task))| !task.rests && !is_led(*i)).flat_map(|(_, (block, task))| {
            task.scenario.ineffective_keys().into_iter().filter_map(|(path, when)| {
                let (part, rest) = path.split_once('.').unwrap_or((&path, ""));
                match part {
                    "task" => Some((format!("task.{}.{rest}", block.name), when)),
                    part if BLOCK_KEYS.contains(&part) => Some((format!("scenario.{}.{path}", block.name), when)),
                    _ => None,
                }
            })
        });
        let of_tip = self.tip.iter().filter(|tip| tip.path.time.is_some()).map(|_| "tip.time".to_owned());
        let of_tip = of_tip.filter_map(|path| self.condition_for_effect(&path).map(|when| (path, when)));
        of_base.chain(of_tip).chain(of_blocks).collect()
    }
}
