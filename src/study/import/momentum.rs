//! A motion of a machine without a pose constant: the same path of the end effector without angular momentum.

use super::judge::{MotionCandidate, MotionEvaluator};
use super::request::{MotionImportError, PreservedPath, Request};
use super::ways::{MotionProposals, unchanged_motion};
use crate::advice::{Advice, Remedy};
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase_planning::curves::{Coordinates, Samples};
use stillbase_planning::off_plane::momentum::TipFrame;
use stillbase_planning::pose_space::NoPoseSpace;
use stillbase_query::ProgressCallback;
use stillbase_session::scenario::{Task, TaskKind};
use stillbase_simulation::plant::DriveValues;

/// Returns the given motion, and the candidate that moves the end effector alike without angular momentum. `why` says why
/// the machine has no pose constant.
pub(super) fn without_momentum(
    request: &Request,
    judge: &MotionEvaluator,
    why: &NoPoseSpace,
    goes_on: ProgressCallback<'_>,
) -> Result<MotionProposals, MotionImportError> {
    let motion = &*request.motion.0;
    let is_of_drives = motion.coordinates == Coordinates::Drives;
    let given = unchanged_motion(judge, &motion.samples, is_of_drives, goes_on)?.given;
    let candidates = if request.keep == Some(PreservedPath::Joints) {
        Err(Advice::from(format!("{why}. Only the end effector's motion can be kept without angular momentum")))
    } else if judge.machine.drives() < MIN_DRIVES {
        Err(why.to_string().into())
    } else if request.b.is_some() {
        Err(Advice::from(format!("{why}. Without "))
            .name(Remedy::PoseConstant)
            .then(" it is moved without angular momentum"))
    } else {
        let start = given.as_ref().map(|given| given.motion.at(0.0).q);
        let task = start.and_then(|start| task(judge, &motion.samples, is_of_drives, &start));
        let why = "this machine has no b to hold; without angular momentum it turns no base".into();
        match task {
            Some(task) => Ok(vec![MotionCandidate { method: ZERO_MOMENTUM, why, task }]),
            None => Err("the path is not within reach: want another".into()),
        }
    };
    Ok(MotionProposals { given, candidates })
}

/// Fewer drives than coordinates and momentum can follow no path.
const MIN_DRIVES: usize = 3;

/// Name of the method.
pub(super) const ZERO_MOMENTUM: &str = "zero-momentum";

/// Returns the task that moves the end effector as the samples do, seen from the base, from a start pose.
fn task(judge: &MotionEvaluator, samples: &Samples, is_of_drives: bool, start: &DriveAngles) -> Option<Task> {
    let (tip, drives) = (judge.machine.end_effector(), judge.machine.drives());
    let place = |values: &[f64]| match is_of_drives {
        true => end_effector(tip, &DriveAngles(PerDrive::from_fn(drives, |k| values[k])).units()),
        false => Vector::new(values[0], values[1]),
    };
    let row = |(i, t): (usize, f64)| {
        let at = place(samples.values(i));
        vec![t, at.re, at.im]
    };
    let rows: Vec<Vec<f64>> = samples.times().into_iter().enumerate().map(row).collect();
    let task = Task::sampled(TaskKind::ZeroMomentum, Samples::new(&rows).ok()?, Some(0.0), &judge.machine).ok()?;
    Some(Task { start: Some(DriveValues::Own(start.0)), frame: Some(TipFrame::Base), ..task })
}
