//! Motions that leave their plane knowingly: a change of b, the least reaction, and zero momentum on any machine.

use super::along::{Parts, curves, refusal, serve, slowed, timed};
use super::plan::{Plan, dynamics_of, keeps_rules};
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::Motion;
use crate::planning::curves::path::Chained;
use crate::planning::curves::{Curve, CurvePoint, Path, PathTable};
use crate::planning::following::trace;
use crate::planning::forecast::Forecast;
use crate::planning::off_plane::drift::zero_momentum_curve;
use crate::planning::off_plane::least_reaction::Goal;
use crate::planning::off_plane::price::{INWARDS, bang_bang_in_b, joint_line, nearest_poses};
use crate::planning::off_plane::{LeastReaction, Price};
use crate::planning::pose_constant::{Planes, Unreachable};
use crate::planning::reactionless::PlanePoint;
use crate::planning::timing::{Limits, Profile, TimeLaw};
use crate::session::refusal::Refusal;
use crate::session::scenario::{Least, Scenario, Task};

/// From A on the plane of the task to B on another, along a straight joint line; a limit on |n_B| sets the time.
pub fn change_b(scenario: &Scenario, planes: &Planes) -> Result<Plan, Refusal> {
    goes_straight(&scenario.task)?;
    let ends = ends(scenario, planes)?;
    let line = joint_line(planes.map(), ends);
    changed(scenario, line, ends[1].b - ends[0].b, &|| bang_bang_in_b(planes.map(), ends))
}

/// Refuses points between A and B.
pub(super) fn goes_straight(task: &Task) -> Result<(), Refusal> {
    if task.via.is_empty() && !task.closed {
        return Ok(());
    }
    Err(Refusal::Task("change-b goes straight from A to B: want no points between and an open path".into()))
}

/// Along a line by which b changes so much, rad, or where a limit on |n_B| is to be met as fast as can be, by a table in
/// which b is bang-bang.
pub(super) fn changed(
    scenario: &Scenario,
    line: Path,
    delta_b: f64,
    bang_bang: &dyn Fn() -> Option<PathTable>,
) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let (model, around) = dynamics_of(scenario);
    let price = Price::of(&model, delta_b)?;
    // T² times the peak of n_B over |s̈|'s, for a b that moves.
    let moves = price.delta_b().abs() > 1e-9;
    let square = task.moment_limit.filter(|_| moves).map(|limit| price.inertia() * price.delta_b().abs() / limit);
    let limits = Limits::of(&scenario.machine);
    let motion = match (task.law, square) {
        (TimeLaw::Fastest, Some(square)) => {
            let table = bang_bang();
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

/// A and B, each on its plane.
fn ends(scenario: &Scenario, planes: &Planes) -> Result<[PlanePoint; 2], Refusal> {
    let (task, map) = (&scenario.task, planes.map());
    let points = [task.from, task.to].map(|p| Vector::new(p[0], p[1]));
    let nearest = |b: [f64; 2]| nearest_poses(map, points, b);
    if let Some(b_to) = task.b_to {
        return match nearest([task.b, b_to]) {
            Some(pair) => Ok(pair),
            None => {
                let point = usize::from(!map.poses(points[0], task.b).is_empty());
                let why = planes.serve(&points[point..=point], [task.b, b_to][point]);
                Err(why.err().map_or_else(
                    || Refusal::NoWay("A and B have no pose on their planes".into()),
                    |(_, unreachable)| refusal(task, if point == 0 { 0 } else { task.via.len() + 1 }, unreachable),
                ))
            }
        };
    }
    // A at the b of the task, B at its own that is nearest to it.
    serve(task, planes, &points[..1])?;
    let last = task.via.len() + 1;
    let set = map.reach(points[1]).map_err(|reason| {
        let (x, y) = (points[1].re, points[1].im);
        refusal(task, last, Unreachable::Anywhere { x, y, reason })
    })?;
    let mut ends = INWARDS.into_iter().filter_map(|share| Some(set.inwards(set.nearest(task.b)?, share)));
    ends.find_map(|b| nearest([task.b, b])).ok_or_else(|| {
        Refusal::NoWay("no poses of A and B were found to go straight between: want other points".into())
    })
}

/// The end effector's curves with b changing as little as its corridor allows.
pub fn least_reaction(scenario: &Scenario, planes: &Planes) -> Result<Plan, Refusal> {
    let (task, map) = (&scenario.task, planes.map());
    let law = smooth(task)?;
    let curves = curves(task, &task.points())?;
    let curve = whole(&curves, law);
    let goal = match task.least {
        Least::MeanSquare => Goal::Rms,
        Least::Peak => Goal::Peak,
    };
    let (model, _) = dynamics_of(scenario);
    let mut refused = None;
    for start in map.poses(task.points()[0], task.b).iter() {
        match LeastReaction::plan(map, &model, &curve, *start, task.b_to, goal) {
            Ok(plan) => {
                let motion = Motion { path: Path::Table(plan.path().clone()), profile: Profile::even(task.time) };
                keeps_rules(scenario, &motion)?;
                let verdicts = plan.compare(scenario.machine.end_effector(), &curve, task.time);
                return Ok(Plan { verdicts: Some(verdicts), ..Plan::of(scenario, motion) });
            }
            Err(why) => refused = Some(refused.unwrap_or(why)),
        }
    }
    match refused {
        Some(why) => Err(Refusal::LeastReaction(why)),
        None => {
            let refusal = serve(task, planes, &task.points()[..1]).err();
            Err(refusal.unwrap_or_else(|| Refusal::NoWay("A has no pose".into())))
        }
    }
}

/// The law of a motion whose moment is to be least.
pub(super) fn smooth(task: &Task) -> Result<TimeLaw, Refusal> {
    match task.law {
        TimeLaw::Fastest | TimeLaw::FastestSmooth => {
            Err(Refusal::Task("least-reaction wants a law over a given time: quintic or septic".into()))
        }
        TimeLaw::Trapezoidal => Err(Refusal::Task("least-reaction wants a smooth law: quintic or septic".into())),
        law @ (TimeLaw::Quintic | TimeLaw::Septic) => Ok(law),
    }
}

/// All curves one after another over u = t/T, each by the law in its share of the time.
fn whole(curves: &[Curve], law: TimeLaw) -> impl Fn(f64) -> CurvePoint {
    let total: f64 = curves.iter().map(Curve::length).sum();
    let profile =
        Profile::sequence(curves.iter().map(|c| (Profile::of(law, c.length() / total), c.length())).collect());
    move |u: f64| {
        let at = profile.at(u);
        let (i, s) = trace::part(curves, at.s);
        let scale = total / curves[i].length();
        let local = curves[i].at(s);
        let (rate, acceleration) = (at.rate * scale, at.acceleration * scale);
        CurvePoint {
            p: local.p,
            first: local.first * rate,
            second: local.second * rate * rate + local.first * acceleration,
        }
    }
}

/// The end effector's curves at zero momentum, a closed path as often as asked.
pub fn zero_momentum(scenario: &Scenario, planes: &Planes) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let start = serve(task, planes, &task.points()[..1])?;
    followed(scenario, DriveAngles::from(planes.map().lift(start[0])))
}

/// The end effector's curves at zero momentum from a pose of A.
pub(super) fn followed(scenario: &Scenario, start: DriveAngles) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let (model, _) = dynamics_of(scenario);
    let curves = curves(task, &task.points())?;
    in_rounds(scenario, start, &|mut q, cycle| {
        let mut parts = Vec::new();
        for curve in &curves {
            let table = zero_momentum_curve(&model, q, curve, cycle)?;
            q = table.nodes().last().map_or(q, |last| last.q);
            parts.push((Path::Table(table), curve.length()));
        }
        Ok((parts, q))
    })
}

/// A closed path as often as asked, an open one once; `round` gives what it is made of, from a pose in a cycle, and where
/// it ends.
pub(super) fn in_rounds(
    scenario: &Scenario,
    start: DriveAngles,
    round: &dyn Fn(DriveAngles, usize) -> Result<(Parts, DriveAngles), Refusal>,
) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    if task.cycles > 1 && !task.closed {
        return Err(Refusal::Task("an open path is run through once: want closed = true, or cycles = 1".into()));
    }
    let mut q = start;
    let mut cycles = vec![q];
    let mut legs = Vec::with_capacity(task.cycles as usize);
    for cycle in 1..=task.cycles as usize {
        let (parts, end) = round(q, cycle)?;
        // Each cycle takes the whole time of the task.
        legs.push(timed(scenario, parts)?.0);
        q = end;
        cycles.push(q);
    }
    let motion = match legs.len() {
        1 => legs.remove(0),
        _ => {
            let profile = Profile::sequence(legs.iter().map(|m| (m.profile.clone(), 1.0)).collect());
            let path = Chained::new(legs.into_iter().map(|m| (m.path, 1.0)).collect());
            Motion { path: Path::Chain(path.ok_or_else(|| Refusal::Task("want a path".into()))?), profile }
        }
    };
    keeps_rules(scenario, &motion)?;
    Ok(Plan { cycles, ..Plan::of(scenario, motion) })
}
