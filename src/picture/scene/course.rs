//! The planned motion for drawing: sampling of its path, the points of its task, and the position of the target.

use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::planar::Vector;
use stillbase_planning::Motion;
use stillbase_planning::off_plane::momentum::TipFrame;
use stillbase_session::Run;
use stillbase_session::scenario::PathShape;
use stillbase_simulation::frame::{Frame, Reach};

/// Minimum number of intervals in which a path is drawn.
const MIN_INTERVALS: usize = 256;

/// Number of intervals for each part of a path, if this gives more than [`MIN_INTERVALS`].
const INTERVALS_PER_PART: usize = 48;

/// Maximum number of points of a task that are all drawn; of more points, only the first and last are drawn.
const MAX_NAMED: usize = 24;

/// Returns number, name and position, m, of the points to be drawn.
pub fn waypoints(run: &Run) -> Vec<(usize, String, Vector)> {
    let task = &run.scenario().task;
    if task.samples.is_some() {
        // The samples may have been turned since the task was written, so both ends are taken from the motion.
        return [(0, 0.0), (1, 1.0)].map(|(i, share)| (i, task.name_of(i), run.end_effector_on_path(share))).to_vec();
    }
    // Points that are meant as seen from a free base lie in space where the base has shifted as they are passed.
    let is_carried = run.plan().beside_base.is_some() && task.frame() == TipFrame::Base;
    let points = task.points();
    let shares = if is_carried { passed(run, &points) } else { Vec::new() };
    let place = |i: usize, p| shares.get(i).map_or(p, |share| run.end_effector_on_path(*share));
    let all: Vec<_> = points.iter().enumerate().map(|(i, p)| (i, task.name_of(i), place(i, *p))).collect();
    if all.len() <= MAX_NAMED && task.shape() != PathShape::Freehand {
        all
    } else {
        [&all[..1], &all[all.len() - 1..]].concat()
    }
}

/// Returns the path parameters, from 0 to 1, at which points seen from the base are passed, one after the other.
fn passed(run: &Run, points: &[Vector]) -> Vec<f64> {
    let motion = &run.plan().motion;
    let arm = run.scenario().machine.end_effector();
    let all: Vec<(f64, Vector)> =
        stations(motion).map(|s| (s, end_effector(arm, &motion.path.at(s).q.units()))).collect();
    let (last, mut from) = (all.len() - 1, 0);
    let far = |i: usize, p: &Vector| (all[i].1 - p).norm();
    let pass = |(i, p): (usize, &Vector)| {
        from = match i {
            0 => 0,
            i if i + 1 == points.len() && !run.scenario().task.closed => last,
            _ => (from..=last).min_by(|a, b| far(*a, p).total_cmp(&far(*b, p))).unwrap_or(last),
        };
        all[from].0
    };
    points.iter().enumerate().map(pass).collect()
}

/// Returns the path parameters, from 0 to 1, at which a path is sampled for drawing.
pub fn stations(motion: &Motion) -> impl Iterator<Item = f64> {
    let n = (INTERVALS_PER_PART * motion.path.parts()).clamp(MIN_INTERVALS, 4096);
    (0..=n).map(move |i| i as f64 / n as f64)
}

/// Returns the position of the target's handle, m: the target itself if out of reach, otherwise the end effector. If
/// neither the target moves with the base nor the plan accounts for it, the end effector is shown where it would be on a
/// base at rest.
pub fn target_handle(frame: &Frame) -> Vector {
    match frame.target.reach {
        Reach::Outside { .. } | Reach::Stopped { .. } => frame.target.at,
        Reach::Inside | Reach::Carried if frame.target_rides || frame.base_is_planned => frame.end_effector,
        Reach::Inside | Reach::Carried => frame.in_base(frame.end_effector),
    }
}
