//! Two blocks of which one changes its b against the other's.
//!
//! A block with invariant mass matrix has the angular momentum D_1 ḃ about the axis z of its plane. Two blocks with
//! parallel axes put no moment on their base while Σ D_1 ḃ z is zero: each change of one b asks for one of the other, by
//! the factor −(z · z′) D_1 / D_1′.

use super::file::AssemblyScenario;
use crate::changes::{in_order, opening};
use crate::edit::{Edit, TimedEdit};
use crate::run::Run;
use crate::scenario::{Scenario, TaskKind};
use crate::with_start_edits;
use stillbase_mechanics::machine::Inertia;

impl AssemblyScenario {
    /// Binds the b of two blocks: the second follows the first, and later whichever is not led.
    ///
    /// # Errors
    /// If their planes are not parallel, or one has no pose constant.
    pub fn bind(&mut self, [one, other]: [usize; 2]) -> Result<(), String> {
        self.factor(one, other)?;
        self.against = Some([one, other]);
        self.follow(one);
        Ok(())
    }

    /// Returns the change of the b of block `to` for a change of that of block `from` by one.
    ///
    /// # Errors
    /// If their planes are not parallel, or one has no pose constant.
    pub fn factor(&self, from: usize, to: usize) -> Result<f64, String> {
        let along = self.assembly.parallel([from, to])?;
        let [name, other] = [from, to].map(|i| &self.assembly.blocks()[i].name);
        let momentum = |i: usize| {
            let inertia = Inertia::of(&self.tasks[i].scenario.machine);
            (inertia.is_invariant() && inertia.pose_inertia() != 0.0).then(|| inertia.momenta()[0])
        };
        let [one, all] = [from, to].map(momentum);
        let lacks = if one.is_none() { name } else { other };
        let (one, all) =
            one.zip(all).ok_or_else(|| format!("{lacks} has no pose constant b: want a block that has one"))?;
        Ok(-along * one / all)
    }

    /// Returns the block whose b follows that of a block, with the factor.
    pub fn follower_of(&self, led: usize) -> Option<(usize, f64)> {
        let pair = self.against.filter(|pair| pair.contains(&led))?;
        let other = if pair[0] == led { pair[1] } else { pair[0] };
        Some((other, self.factor(led, other).ok()?))
    }

    /// Has the b of the bound block follow that of the block that is led: as planned, and as it is slid later.
    pub(super) fn follow(&mut self, led: usize) {
        let Some((other, factor)) = self.follower_of(led) else { return };
        let own = self.tasks[led].scenario.clone();
        let of = &mut self.tasks[other].scenario;
        let start = with_start_edits(&own).map_or_else(|_| own.without_edits(), |(start, _)| start);
        let (of_led, task) = (&start.task, &mut of.task);
        if [of_led.kind, task.kind] == [TaskKind::ChangeB; 2] {
            let to = |scenario_b: f64| scenario_b + factor * (of_led.b_to.unwrap_or(of_led.b) - of_led.b);
            (task.b_to, task.time, task.law) = (Some(to(task.b)), of_led.time, of_led.law);
            self.tasks[other].rests = false;
        }
        let of = &mut self.tasks[other].scenario;
        of.pose_acceleration = factor.abs() * pose_bound(&start);
        of.edits = in_order(&of.edits);
        let relation = of.task.b - factor * start.task.b;
        let kept = opening(&of.edits);
        let mut place = 0..of.edits.len();
        of.edits.retain(|timed| place.next().is_some_and(|i| i < kept) || against(&timed.edit, 0.0, 1.0).is_none());
        let script = in_order(&own.edits);
        let bound = script[opening(&script)..].iter().filter_map(|TimedEdit { step, edit }| {
            Some(TimedEdit { step: *step, edit: against(edit, relation, factor)? })
        });
        of.edits.extend(bound);
        of.edits.sort_by_key(|timed| timed.step);
    }
}

impl AssemblyScenario {
    /// Gives the block that is led the hand-overs of all: they concern two blocks.
    pub(super) fn gather_hand_overs(&mut self, led: usize) {
        let mut all = Vec::new();
        for (_, task) in self.tasks.iter_mut().enumerate().filter(|(i, _)| *i != led) {
            let edits = &mut task.scenario.edits;
            all.extend(edits.extract_if(.., |timed| matches!(timed.edit, Edit::HandOver { .. })));
        }
        // In the order of the file, by which refusals count them.
        self.tasks[led].scenario.edits.extend(all);
    }

    /// Gives each block its part of the drags in space of one that was led.
    pub(super) fn share_drags(&mut self, led: usize) {
        let names: Vec<String> = self.assembly.blocks().iter().map(|block| block.name.clone()).collect();
        let all = std::mem::take(&mut self.tasks[led].scenario.edits);
        let mut kept = Vec::with_capacity(all.len());
        for timed in all {
            let Edit::DragBlocks { targets } = &timed.edit else {
                kept.push(timed);
                continue;
            };
            for (i, name) in names.iter().enumerate() {
                let Some([x, y]) = targets.get(name) else { continue };
                let own = TimedEdit { step: timed.step, edit: Edit::DragTarget { x: *x, y: *y } };
                match i == led {
                    true => kept.push(own),
                    false => self.tasks[i].scenario.edits.push(own),
                }
            }
        }
        self.tasks[led].scenario.edits = kept;
        for task in &mut self.tasks {
            task.scenario.edits.sort_by_key(|timed| timed.step);
            task.rests &= task.scenario.edits.is_empty();
        }
    }
}

/// Returns the edit of a bound block for one of the block that is led: `relation` + `factor` b in place of b.
pub(super) fn against(edit: &Edit, relation: f64, factor: f64) -> Option<Edit> {
    match edit {
        Edit::SlideB { b } => Some(Edit::SlideB { b: relation + factor * b }),
        Edit::PoseB { b } => Some(Edit::PoseB { b: relation + factor * b }),
        _ => None,
    }
}

/// Returns the bound on |b̈| of a scenario while b is slid, rad/s²: its own, or where its torques end.
fn pose_bound(scenario: &Scenario) -> f64 {
    Run::or_waiting(scenario).ok().and_then(|run| run.pose_bound()).unwrap_or(scenario.pose_acceleration)
}
