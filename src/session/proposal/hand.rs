//! Ways out for a machine that a hand leads: a target out of reach, a b that does not serve the points, and joint limits
//! that leave out the present pose.

use toml::Value;

use super::Proposal;
use super::floating::{BaseMotion, Led};
use super::value::{numbers, taking};
use crate::edit::Edit;
use crate::interactive::Session;
use crate::scenario::{POSE_CONSTANT_RANGE, name_of};
use crate::verdict::LIMIT_TOLERANCE;
use stillbase_mechanics::planar::{Pose2, Vector};
use stillbase_planning::common::nearest_place;
use stillbase_planning::pose_space::{PoseSpace, Reach};
use stillbase_planning::reactionless::Decimal;
use stillbase_query::{ByIdentity, QuickQuery};

/// Number of decimals of a place to which the machine is led, m.
const PLACE_DECIMALS: usize = 6;
/// Number of decimals of a limit that is proposed, rad.
const LIMIT_DECIMALS: usize = 3;

/// Query for the ways out of a target that is out of reach at the present b.
pub struct TargetProposals;

/// A target that is out of reach.
#[derive(Clone, Debug, PartialEq)]
pub struct MissedTarget {
    space: ByIdentity<PoseSpace>,
    /// The target, m, in the axes of the base, as is the nearest point in `reach`.
    at: Vector,
    /// The pose of a base that floats; otherwise at the origin.
    pose: Pose2,
    /// The present b, rad.
    b: f64,
    reach: Reach,
    base: BaseMotion,
}

impl QuickQuery for TargetProposals {
    type Input = MissedTarget;
    type Answer = Vec<Proposal>;

    fn answer(missed: &Self::Input) -> Self::Answer {
        let Reach::Outside { nearest, feasible_b, displayed_b, .. } = missed.reach else { return Vec::new() };
        let at_b = feasible_b.zip(displayed_b).and_then(|found| missed.at_another_b(found));
        // The machine waits on the boundary of what it reaches, so the place proposed is a little inside.
        let space = &*missed.space.0;
        let waits = |to: &[Decimal; 2]| {
            let off = (Vector::new(to[0].value(), to[1].value()) - nearest).norm();
            off <= 1e-2 * space.farthest()
        };
        let inside = nearest_place(space, missed.at, Some(missed.b)).filter(waits);
        let rounded = inside.and_then(|[x, y]| missed.in_space(Vector::new(x.value(), y.value())));
        let there = missed.pose.place(nearest);
        let [x, y] = rounded.map_or([there.re, there.im], |to| to.map(|x| x.value()));
        let shown = rounded.unwrap_or_else(|| [x, y].map(|x| Decimal::nearest(x, 3)));
        let text = format!("go to the nearest point, ({}, {}) m", shown[0], shown[1]);
        let to_nearest = Proposal::of_edit(text, Edit::DragTarget { x, y });
        at_b.into_iter().chain([to_nearest]).collect()
    }
}

impl MissedTarget {
    /// Proposes a b at which the end effector comes to the target; `b` reaches it in the axes of the base, in rad and as
    /// printed.
    fn at_another_b(&self, (b, shown): (f64, Decimal)) -> Option<Proposal> {
        let space = &*self.space.0;
        let drag = |[x, y]: [Decimal; 2]| Edit::DragTarget { x: x.value(), y: y.value() };
        let at = self.pose.place(self.at);
        match &self.base {
            BaseMotion::Stays => Some(Proposal::of_edit(format!("go to b = {shown} rad"), Edit::SlideB { b })),
            BaseMotion::Turns(body) => {
                let Led { to, b } = body.led_to(space, at, self.b)?;
                let text = format!("go to ({}, {}) m, b = {b} rad", to[0], to[1]);
                Some(Proposal::of_edits(text, vec![drag(to), Edit::SlideB { b: b.value() }]))
            }
            // How the base would turn cannot be told, so the machine is put there, not led.
            BaseMotion::Untold => {
                let to = [at.re, at.im].map(|x| Decimal::nearest(x, PLACE_DECIMALS));
                let set = space.reach(self.pose.seen(Vector::new(to[0].value(), to[1].value()))).ok()?;
                let b = set.decimal(set.moved_inside(set.nearest(self.b)?, 1e-6), 3)?;
                let text = format!("put it at b = {b} rad, base as it is");
                Some(Proposal::of_edits(text, vec![drag(to), Edit::PoseB { b: b.value() }]))
            }
        }
    }

    /// Returns a place in the axes of the base, m, in space, with the fewest decimals at which the machine reaches it.
    fn in_space(&self, place: Vector) -> Option<[Decimal; 2]> {
        let at = self.pose.place(place);
        (3..=12)
            .map(|decimals| [at.re, at.im].map(|x| Decimal::nearest(x, decimals)))
            .find(|[x, y]| self.space.0.reaches(self.pose.seen(Vector::new(x.value(), y.value())), self.b))
    }
}

/// Joint limits that leave out the present pose of a machine that a hand leads.
#[derive(Clone, Debug, PartialEq)]
pub struct OutsideLimits {
    /// What is wrong, in a sentence.
    pub why: String,
    /// Ways out.
    pub proposals: Vec<Proposal>,
}

impl Session {
    /// Returns the target on display for [`TargetProposals`]; `None` if it is reached or there is no pose space.
    pub fn missed_target(&self) -> Option<MissedTarget> {
        let frame = self.frame();
        let Reach::Outside { nearest, feasible_b, displayed_b, other_sheet } = frame.target.reach else { return None };
        let pose = if frame.target_rides { frame.base } else { Pose2::default() };
        Some(MissedTarget {
            space: ByIdentity(self.run().pose_space().ok()?.clone()),
            at: pose.seen(frame.target.at),
            pose,
            b: self.b_aim(),
            reach: Reach::Outside { nearest: pose.seen(nearest), feasible_b, displayed_b, other_sheet },
            base: BaseMotion::of(self),
        })
    }

    /// Returns a b, rad, less whole periods, so that it is as near as can be to the present b. Every period, the machine
    /// reaches the same.
    pub fn in_this_period(&self, b: f64) -> f64 {
        let Ok(space) = self.run().pose_space() else { return b };
        b - ((b - self.b_aim()) / space.period()).round() * space.period()
    }

    /// Returns what leads out of a b, rad, that does not serve all points of the task: the b that does and is nearest in
    /// the present period, the nearest of all, and the same b with the points turned.
    pub fn proposals_for_b(&self, b: f64) -> Vec<Proposal> {
        let asked = b.clamp(POSE_CONSTANT_RANGE.low(), POSE_CONSTANT_RANGE.high());
        let pose = |text: String, b: f64| Proposal::of_edit(text, Edit::PoseB { b });
        let nearest = |wanted: f64| {
            let b = self.nearest_feasible_b(wanted).filter(|nearest| *nearest != asked)?;
            let shown = self.run().feasible_b()?.decimal(b, 4)?;
            Some(pose(format!("take b = {shown} rad"), shown.value()))
        };
        let mut found: Vec<Proposal> = [self.in_this_period(asked), asked].into_iter().filter_map(nearest).collect();
        found.dedup();
        found.push(pose(format!("take b = {asked:.4} rad, and turn the points with it"), asked));
        found
    }

    /// Returns a question about a b, rad, to which the machine would move through whole turns, with its answers; `None`
    /// if it is in the present period.
    pub fn question_of_turns(&self, b: f64) -> Option<(String, Vec<Proposal>)> {
        let near = self.in_this_period(b);
        let period = self.run().pose_space().ok()?.period();
        let turns = ((b - near) / period).round().abs();
        let to = |text: String, b: f64| Proposal::of_edit(text, Edit::SlideB { b });
        let times = if turns == 1.0 { "once".into() } else { format!("{turns} times") };
        let why = format!(
            "on the way to b = {b:.3} rad the whole arm turns round {times}, so it waits: b = {near:.3} rad reaches the \
             same"
        );
        let shown = (near * 1e3).round() / 1e3;
        let answers =
            vec![to(format!("go to b = {shown:.3} rad"), shown), to(format!("turn to b = {b:.3} rad all the same"), b)];
        (turns > 0.0).then_some((why, answers))
    }

    /// Returns the joint limits that leave out the present pose of a machine that a hand leads, with ways out: the
    /// limits before their last change, and the present limits widened to the pose. `None` if no limit is exceeded.
    pub fn outside_limits(&self) -> Option<OutsideLimits> {
        if !self.is_dragged() {
            return None;
        }
        let q = &self.frame().q;
        let past = self.scenario().machine.angles().iter().find_map(|angle| {
            let now = angle.value(q);
            let (low, high) = (*angle.limits.start(), *angle.limits.end());
            (now < low - LIMIT_TOLERANCE || now > high + LIMIT_TOLERANCE).then_some((angle, now, [low, high]))
        });
        let (angle, now, [low, high]) = past?;
        let key = format!("limits.{}", angle.name);
        let pair = |[low, high]: [f64; 2]| Value::Array(vec![low.into(), high.into()]);
        // Rounded outwards, so that the limits contain the pose.
        let scale = 10f64.powi(LIMIT_DECIMALS as i32);
        let tightest =
            if now < low { [(now * scale).floor() / scale, high] } else { [low, (now * scale).ceil() / scale] };
        let before = self.limits_before(&angle.name).filter(|before| *before != pair([low, high]));
        let back = before.map(|before| {
            let bounds = numbers(&before).unwrap_or_default();
            let words: Vec<String> = bounds.iter().map(|x| format!("{x:.3}")).collect();
            let text = format!("put the {} back to {} rad", name_of(&key), words.join(" to "));
            Proposal { text, ..taking(&key, before) }
        });
        let why = format!("{} is at {now:.3} rad, outside its limits of {low:.3} to {high:.3} rad", angle.name);
        Some(OutsideLimits { why, proposals: back.into_iter().chain([taking(&key, pair(tightest))]).collect() })
    }
}
