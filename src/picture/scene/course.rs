//! The planned motion for drawing: sampling of its path, the points of its task, and the position of the target.

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
    // Points that are meant as seen from a free base lie in space where the base has shifted; B does so at the end.
    let end = task.points().len() - 1;
    let is_carried = run.plan().beside_base.is_some() && task.frame() == TipFrame::Base && !task.closed;
    let named = |(i, p)| match i == end && is_carried {
        true => (i, task.name_of(i), run.end_effector_on_path(1.0)),
        false => (i, task.name_of(i), p),
    };
    let all: Vec<_> = task.points().into_iter().enumerate().map(named).collect();
    if all.len() <= MAX_NAMED && task.shape() != PathShape::Freehand {
        all
    } else {
        [&all[..1], &all[all.len() - 1..]].concat()
    }
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
