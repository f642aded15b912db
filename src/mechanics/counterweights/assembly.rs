//! [`place_in_assembly`]: counterweights that balance all blocks of an assembly together.
//!
//! A counterweight on a carried block also loads its carriers, as a mass at their end effectors. So the blocks are one cone
//! program, and what is minimised is that of the whole. Block by block, from the outermost inwards, the least mass is the
//! same if the last link of each carrier may have a counterweight of any mass at its end effector: what a heavier wrist
//! would do for its carrier, such a counterweight does, too. Elsewhere a heavier wrist may save its carrier more than it
//! weighs, and for other objectives the blocks have to agree.

use super::front::{Front, FrontWalk};
use super::place::{PlacedCounterweights, is_possible, place};
use super::refusal::CounterweightError;
use super::spec::{CounterweightSite, CounterweightSpec, Objective};
use super::subject::{SpatialGoal, Subject};
use crate::assembly::Assembly;
use stillbase_query::{Portion, ProgressCallback, Query};

/// Finds the counterweights of all blocks that meet (7), (8) and the further `goals` of each block, and minimise an
/// objective of the whole. Existing counterweights are removed first, except fixed ones.
///
/// # Errors
/// As [`place_weights`](super::place_weights), and if a range of payloads is asked for. Links and drives have the name of
/// their block before their own.
pub fn place_in_assembly(
    assembly: &Assembly,
    spec: &CounterweightSpec,
    goals: &[SpatialGoal],
) -> Result<PlacedCounterweights<Assembly>, CounterweightError> {
    place(Subject::assembly(assembly, goals), spec).map_err(|why| match why {
        CounterweightError::TooFew => unbalanced_block(assembly, spec).map_or(why, CounterweightError::TooFewOnBlock),
        why => why,
    })
}

/// Returns the further conditions that counterweights can meet, for each block. If they cannot meet all of them together,
/// each is taken in turn, from the base outwards, that they can meet with those before. No block has any if not even (7)
/// and (8) can be met.
pub fn reachable_goals(assembly: &Assembly, spec: &CounterweightSpec) -> Vec<SpatialGoal> {
    let any = CounterweightSpec { objective: Objective::mass(), ..spec.clone() };
    let is_reached = |goals: &[SpatialGoal]| is_possible(Subject::assembly(assembly, goals), &any);
    let count = assembly.blocks().len();
    let all = vec![SpatialGoal::SILENT; count];
    if is_reached(&all) {
        return all;
    }
    let mut goals = vec![SpatialGoal::PLANAR; count];
    if !is_reached(&goals) {
        return goals;
    }
    for &block in assembly.order() {
        for tilt in [false, true] {
            let before = goals[block];
            goals[block] = if tilt { SpatialGoal { tilt, ..before } } else { SpatialGoal { ground: true, ..before } };
            if !is_reached(&goals) {
                goals[block] = before;
            }
        }
    }
    goals
}

/// Returns the name of the outermost block that no counterweights balance, even apart from its carriers.
fn unbalanced_block(assembly: &Assembly, spec: &CounterweightSpec) -> Option<String> {
    let cannot = |block: &usize| {
        let (branch, blocks) = assembly.branch(*block);
        let own = |site: &CounterweightSite| {
            let (block, link) = assembly.link_at(site.link)?;
            let place = blocks.iter().position(|own| *own == block)?;
            Some(CounterweightSite { link: branch.first_link(place) + link, ..*site })
        };
        let sites = spec.sites.iter().filter_map(own).collect();
        let spec = CounterweightSpec::least(Objective::mass(), sites, spec.stock);
        !is_possible(Subject::assembly(&branch, &vec![SpatialGoal::PLANAR; blocks.len()]), &spec)
    };
    let found = assembly.order().iter().rev().copied().find(cannot);
    found.map(|block| assembly.blocks()[block].name.clone())
}

/// Search for the Pareto front of added mass and Σ D_k of an assembly; each portion of work finds one point.
#[derive(Clone, Debug)]
pub struct AssemblyFrontSearch(FrontWalk);

impl Query for AssemblyFrontSearch {
    type Input = (Assembly, CounterweightSpec, Vec<SpatialGoal>, usize);
    type Answer = Result<Front<Assembly>, CounterweightError>;

    fn begin((assembly, spec, goals, count): Self::Input) -> Self {
        Self(FrontWalk::begin(assembly, Some(goals), spec, count))
    }

    fn go_on(&mut self, _: ProgressCallback<'_>) -> Portion<Self::Answer> {
        self.0.go_on()
    }
}
