//! [`Machines`]: which machine a run had from which step on, as edits may change it in motion.

use std::sync::Arc;

use crate::mechanics::machine::Machine;

/// The machines of a run, each from its first step on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Machines(Arc<Vec<(u64, Machine)>>);

impl Machines {
    /// From a step on it is this one, whatever was said of that step and later ones.
    pub fn hold(&mut self, step: u64, machine: &Machine) {
        let earlier = self.0.partition_point(|(from, _)| *from < step);
        let is_same = earlier.checked_sub(1).is_some_and(|i| self.0[i].1 == *machine);
        if earlier == self.0.len() && is_same {
            return;
        }
        let all = Arc::make_mut(&mut self.0);
        all.truncate(earlier);
        all.extend((!is_same).then(|| (step, machine.clone())));
    }

    /// That of a step; none before the first.
    pub fn at(&self, step: u64) -> Option<&Machine> {
        let until = self.0.partition_point(|(from, _)| *from <= step);
        Some(&self.0.get(until.checked_sub(1)?)?.1)
    }

    /// The first step at which it may be another one than elsewhere.
    pub fn differ_from(&self, other: &Self) -> u64 {
        if Arc::ptr_eq(&self.0, &other.0) {
            return u64::MAX;
        }
        let same = self.0.iter().zip(&*other.0).take_while(|(one, other)| one == other).count();
        let next = [self, other].into_iter().filter_map(|all| all.0.get(same)).map(|(from, _)| *from);
        next.min().unwrap_or(u64::MAX)
    }
}
