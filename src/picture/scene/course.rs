//! The planned motion as it is seen: where its path is looked at, the points of its task, and where the target is.

use crate::mechanics::planar::Vector;
use crate::planning::Motion;
use crate::session::Run;
use crate::session::scenario::Shape;
use crate::simulation::frame::{Frame, Reach};

/// Parts of a path that is drawn.
const PARTS: usize = 256;

/// Parts that each of many paths end to end is drawn in.
const A_PART: usize = 48;

/// The most points of a task that are drawn one by one; more are a curve drawn by hand.
const NAMED: usize = 24;

/// Numbers, names and places of the points that are drawn, m.
pub fn waypoints(run: &Run) -> Vec<(usize, String, Vector)> {
    let task = &run.scenario().task;
    if task.samples.is_some() {
        // They may have been turned since the file was written.
        return [(0, 0.0), (1, 1.0)].map(|(i, share)| (i, task.name_of(i), run.on_path(share))).to_vec();
    }
    let named = |(i, p)| (i, task.name_of(i), p);
    let all: Vec<_> = task.points().into_iter().enumerate().map(named).collect();
    if all.len() <= NAMED && task.shape() != Shape::Freehand {
        all
    } else {
        [&all[..1], &all[all.len() - 1..]].concat()
    }
}

/// The shares of a path at which it is looked at to be drawn.
pub fn stations(motion: &Motion) -> impl Iterator<Item = f64> {
    let n = (A_PART * motion.path.parts()).clamp(PARTS, 4096);
    (0..=n).map(move |i| i as f64 / n as f64)
}

/// Where the target's handle is: out of reach it stays where it was sent, else it goes with the end effector. It is in
/// the axes of the base at the start, as if the base had not moved.
pub fn target_handle(frame: &Frame) -> Vector {
    match frame.target.reach {
        Reach::Outside { .. } => frame.target.at,
        Reach::Inside | Reach::Carried => frame.in_base(frame.end_effector),
    }
}
