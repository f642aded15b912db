//! From A at one b to B at another, along a straight joint line.

use super::along::{slowed, timed};
use super::plan::{Plan, Space, dynamics_of, keeps_rules};
use super::poses::{off, refusal, serve};
use crate::mechanics::planar::Vector;
use crate::planning::common::why_not;
use crate::planning::curves::Path;
use crate::planning::off_plane::Price;
use crate::planning::off_plane::price::{INWARDS, bang_bang_in_b, joint_line, nearest_planes};
use crate::planning::pose_space::{NoPoseSpace, PoseSpace};
use crate::planning::posed::{Posed, nearest_poses};
use crate::planning::timing::{Limits, Profile, TimeLaw};
use crate::planning::{Forecast, Motion};
use crate::session::refusal::Refusal;
use crate::session::scenario::{Scenario, Task};

/// From A at the b of the task to B at another; a limit on |n_B| sets the time.
pub(super) fn change_b(scenario: &Scenario, space: Space<'_>) -> Result<Plan, Refusal> {
    goes_straight(&scenario.task)?;
    let space = match space {
        Err(NoPoseSpace::Free) => {
            let why =
                "no motion of this machine has a price, as no drive turns the base: want reactionless or minimum-norm";
            return Err(Refusal::Task(why.into()));
        }
        space => space.map_err(Clone::clone)?,
    };
    changed(scenario, space, &ends(&scenario.task, space)?)
}

/// Refuses points between A and B.
fn goes_straight(task: &Task) -> Result<(), Refusal> {
    if task.via.is_empty() && !task.closed {
        return Ok(());
    }
    Err(Refusal::Task("change-b goes straight from A to B: want no points between and an open path".into()))
}

/// Along the line between two poses, or where a limit on |n_B| is to be met as fast as can be, with a b that is bang-bang.
fn changed(scenario: &Scenario, space: &PoseSpace, ends: &[Posed; 2]) -> Result<Plan, Refusal> {
    let (task, line) = (&scenario.task, joint_line(ends));
    let (model, around) = dynamics_of(scenario);
    let price = Price::of(&model, ends[1].b - ends[0].b)?;
    // T² times the peak of n_B over |s̈|'s, for a b that moves.
    let moves = price.delta_b().abs() > 1e-9;
    let square = task.moment_limit.filter(|_| moves).map(|limit| price.inertia() * price.delta_b().abs() / limit);
    let limits = Limits::of(&scenario.machine);
    let motion = match (task.law, square) {
        (TimeLaw::Fastest, Some(square)) => {
            let table = bang_bang_in_b(space, ends);
            let table = table.ok_or_else(|| Refusal::NoWay("A and B are too far apart".into()))?;
            let motion = Motion { path: Path::Table(table), profile: Profile::even(2.0 * square.sqrt()) };
            // A short change of b leaves the joints little time.
            slowed(motion, &model, &around, &limits)?
        }
        (law, Some(square)) if !law.is_fastest() => Motion::new(line, law, (law.peak() * square).sqrt().max(task.time)),
        (_, square) => {
            let (motion, _) = timed(scenario, vec![(line, 1.0)])?;
            let fast = square.map_or(0.0, |square| {
                let peak = Forecast::of(&motion, &model, &around, &limits).moment;
                let sampled = peak * square / (price.inertia() * price.delta_b().abs());
                // Along a straight line b̈ = Δb s̈, whose greatest value is known.
                sampled.max(motion.profile.peak_acceleration() * square).sqrt()
            });
            Motion { profile: if fast > 1.0 { motion.profile.stretched(fast) } else { motion.profile }, ..motion }
        }
    };
    keeps_rules(scenario, &motion)?;
    Ok(Plan { price: Some(price), ..Plan::of(scenario, motion) })
}

/// Poses of A and B, each at its b.
fn ends(task: &Task, space: &PoseSpace) -> Result<[Posed; 2], Refusal> {
    let points = task.points();
    let last = points.len() - 1;
    let (a, b) = (points[0], points[last]);
    let nearest = |b_of: [f64; 2]| nearest_poses(space, [a, b], b_of);
    let beside = |i: usize, b: f64| refusal(task, i, why_not(space, &points[i..=i], 0, b));
    if let Some(b_to) = task.b_to {
        serve(task, space, &points[..1])?;
        return nearest([task.b, b_to]).ok_or_else(|| beside(last, b_to));
    }
    let set = |i: usize, p: Vector| space.reach(p).map_err(|reason| off(task, i, p, reason));
    let own = set(0, a)?;
    let on = space.reaches(a, task.b);
    // Where a point has one b alone it says which, if the task leaves it out, which stands as 0.
    if !on && (space.reaches_area() || task.b != 0.0) {
        return Err(beside(0, task.b));
    }
    let other = set(last, b)?;
    // B's own b nearest to that of A, if A is at its own; else the pair with the least change.
    let pair = if on { other.nearest(task.b).map(|b| [task.b, b]) } else { nearest_planes(&own, &other, task.b) };
    let inwards = |[from, to]: [f64; 2], share: f64| match on {
        true => [from, other.inwards(to, share)],
        false => [own.inwards(from, share), other.inwards(to, share)],
    };
    pair.and_then(|pair| INWARDS.into_iter().find_map(|share| nearest(inwards(pair, share)))).ok_or_else(|| {
        Refusal::NoWay("no poses of A and B were found to go straight between: want other points".into())
    })
}
