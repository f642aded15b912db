//! Motions from A at one b to B at another, along a straight line in joint space or with a bang-bang b̈.

use super::along::{slow_to_limits, timed};
use super::plan::{Plan, PlannerSpace, arm_on_base, keeps_rules};
use super::poses::{no_b_refusal, poses_at_b, refusal, stated};
use crate::refusal::Refusal;
use crate::scenario::{Scenario, Task};
use stillbase_mechanics::planar::Vector;
use stillbase_planning::common::unreachable_reason;
use stillbase_planning::curves::Path;
use stillbase_planning::off_plane::Price;
use stillbase_planning::off_plane::price::{INWARD_SHARES, bang_bang_in_b, joint_line, nearest_planes};
use stillbase_planning::pose_space::{NoPoseSpace, PoseSpace};
use stillbase_planning::posed::{PoseAngles, nearest_poses};
use stillbase_planning::timing::{DriveLimits, Profile, TimeLaw};
use stillbase_planning::{Forecast, Motion};

/// Plans a motion from A at the b of the task to B at another b; a limit on |n_B| sets a minimum duration.
pub(super) fn change_b(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    goes_straight(&scenario.task)?;
    let space = match space {
        Err(NoPoseSpace::Free) => {
            let why =
                "no change of b costs a moment on the base, as no drive turns it: want reactionless or minimum-norm";
            return Err(Refusal::Task(why.into()));
        }
        space => space.map_err(Clone::clone)?,
    };
    changed(scenario, space, &ends(&scenario.task, space)?)
}

/// Refuses points between A and B, and closed paths.
fn goes_straight(task: &Task) -> Result<(), Refusal> {
    if task.via.is_empty() && !task.closed {
        return Ok(());
    }
    Err(Refusal::Task("change-b goes straight from A to B: want no points between and an open path".into()))
}

/// Plans the motion along the joint line between two poses. The fastest law with a limit on |n_B| uses a bang-bang b̈
/// instead.
fn changed(scenario: &Scenario, space: &PoseSpace, ends: &[PoseAngles; 2]) -> Result<Plan, Refusal> {
    let (task, line) = (&scenario.task, joint_line(ends));
    let arm = arm_on_base(scenario);
    let price = Price::of(arm.arm(), ends[1].b - ends[0].b)?;
    // If b changes, the peak of |n_B| equals its limit at T² = `square` · (peak |s̈| for T = 1 s).
    let moves = price.delta_b().abs() > 1e-9;
    let square = task.moment_limit.filter(|_| moves).map(|limit| price.inertia() * price.delta_b().abs() / limit);
    let limits = DriveLimits::of(&scenario.machine);
    let motion = match (task.law, square) {
        (TimeLaw::Fastest, Some(square)) => {
            let table = bang_bang_in_b(space, ends);
            let table = table.ok_or_else(|| Refusal::NoWay("A and B are too far apart".into()))?;
            let motion = Motion { path: Path::Table(table), profile: Profile::even(2.0 * square.sqrt()) };
            // The time that a small change of b takes may be too short for the joints.
            slow_to_limits(motion, &arm, &limits)?
        }
        (law, Some(square)) if !law.is_fastest() => Motion::new(line, law, (law.peak() * square).sqrt().max(task.time)),
        (_, square) => {
            let (motion, _) = timed(scenario, vec![(line, 1.0)])?;
            let stretch = square.map_or(0.0, |square| {
                let peak = Forecast::of(&motion, &arm, &limits).moment;
                let sampled = peak * square / (price.inertia() * price.delta_b().abs());
                // Along a straight line b̈ = Δb s̈, whose greatest value is known.
                sampled.max(motion.profile.peak_acceleration() * square).sqrt()
            });
            Motion { profile: if stretch > 1.0 { motion.profile.stretched(stretch) } else { motion.profile }, ..motion }
        }
    };
    keeps_rules(scenario, &motion)?;
    Ok(Plan { price: Some(price), ..Plan::of(scenario, motion) })
}

/// Returns poses of A and B, each at its b.
fn ends(task: &Task, space: &PoseSpace) -> Result<[PoseAngles; 2], Refusal> {
    let points = task.points();
    let last = points.len() - 1;
    let (a, b) = (points[0], points[last]);
    let nearest = |b_of: [f64; 2]| match stated(task, space.drives(), 0) {
        None => nearest_poses(space, [a, b], b_of),
        Some(start) => {
            let from = PoseAngles::of(space, start);
            let to = *space.poses(b, b_of[1], &from.a).first()?;
            Some([from, PoseAngles::of(space, to)])
        }
    };
    let unreached = |i: usize, b: f64| refusal(task, i, unreachable_reason(space, &points[i..=i], 0, b));
    if let Some(b_to) = task.b_to {
        poses_at_b(task, space, &points[..1])?;
        return nearest([task.b, b_to]).ok_or_else(|| unreached(last, b_to));
    }
    let b_set = |i: usize, p: Vector| space.reach(p).map_err(|reason| no_b_refusal(task, i, p, reason));
    let own = b_set(0, a)?;
    let a_reached = space.reaches(a, task.b);
    // If each point has a single b and the task omits b (which is then 0), the b of A is used.
    if !a_reached && (space.reaches_area() || task.b != 0.0) {
        return Err(unreached(0, task.b));
    }
    let other = b_set(last, b)?;
    // If the b of the task reaches A, take the nearest b that reaches B; otherwise the pair with the least change of b.
    let pair =
        if a_reached { other.nearest(task.b).map(|b| [task.b, b]) } else { nearest_planes(&own, &other, task.b) };
    let inwards = |[from, to]: [f64; 2], share: f64| match a_reached {
        true => [from, other.moved_inside(to, share)],
        false => [own.moved_inside(from, share), other.moved_inside(to, share)],
    };
    pair.and_then(|pair| INWARD_SHARES.into_iter().find_map(|share| nearest(inwards(pair, share)))).ok_or_else(|| {
        Refusal::NoWay("no poses of A and B were found to go straight between: want other points".into())
    })
}
