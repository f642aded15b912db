//! [`Machines`]: the machine of a run at each step, as edits may change it in motion.

use std::sync::Arc;

use stillbase_mechanics::machine::Machine;

/// The machines of a run, each with its first step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Machines(Arc<Vec<(u64, Machine)>>);

impl Machines {
    /// Sets the machine from a step on, replacing all entries for that step and later ones.
    pub fn set_from(&mut self, step: u64, machine: &Machine) {
        let earlier = self.0.partition_point(|(from, _)| *from < step);
        let is_same = earlier.checked_sub(1).is_some_and(|i| self.0[i].1 == *machine);
        if earlier == self.0.len() && is_same {
            return;
        }
        let all = Arc::make_mut(&mut self.0);
        all.truncate(earlier);
        all.extend((!is_same).then(|| (step, machine.clone())));
    }

    /// Returns the machine at a step, or `None` before the first one.
    pub fn at(&self, step: u64) -> Option<&Machine> {
        let until = self.0.partition_point(|(from, _)| *from <= step);
        Some(&self.0.get(until.checked_sub(1)?)?.1)
    }

    /// Returns the first step at which the machine may differ from that of `other`.
    pub fn differ_from(&self, other: &Self) -> u64 {
        if Arc::ptr_eq(&self.0, &other.0) {
            return u64::MAX;
        }
        let same = self.0.iter().zip(&*other.0).take_while(|(one, other)| one == other).count();
        let next = [self, other].into_iter().filter_map(|all| all.0.get(same)).map(|(from, _)| *from);
        next.min().unwrap_or(u64::MAX)
    }
}
