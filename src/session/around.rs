//! [`around`]: a scenario around a machine that comes without one.

use std::f64::consts::{FRAC_PI_3, PI, TAU};

use super::run::Run;
use super::scenario::{Scenario, ScenarioError};
use crate::mechanics::kinematics::end_effector;
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::{DriveAngles, PerDrive, unit};

/// Where in its limits each relative angle is in the middle of the motion: beside their middle, where parallelograms go
/// flat.
const SHARE: f64 = 0.6;
/// How much of its limits an angle passes, the first that can be, and how far it turns at most, rad.
const SPANS: [f64; 4] = [0.3, 0.2, 0.1, 0.04];
const FARTHEST: f64 = 0.8;
/// Where the end effector is seen from the base pin, rad.
const TOWARDS: f64 = 0.3 * PI;
/// How long the motion takes, s: the first of these in which no limit of a drive is passed.
const TIMES: [f64; 4] = [2.0, 4.0, 8.0, 16.0];

/// A gentle motion about the middle of the joint limits: reactionless where the machine can do that, else along a
/// straight line. Where none is found, what was tried last, which the planner refuses in words.
///
/// # Errors
/// If no task at all can be stated of it.
pub fn around(machine: &Machine) -> Result<Scenario, ScenarioError> {
    let (mut slow, mut refused) = (None, None);
    for kind in ["reactionless", "minimum-norm"] {
        for span in SPANS {
            for is_round in [true, false] {
                let task = task(machine, kind, span, is_round);
                for time in TIMES {
                    let scenario = stated(machine, &format!("{task}time = {time:?}\n"))?;
                    let plan = Run::new(&scenario).map(|run| run.plan().forecast.over.is_none());
                    match plan {
                        Ok(true) => return Ok(scenario),
                        Ok(false) => slow = Some(scenario),
                        Err(_) => {
                            refused = Some(scenario);
                            break;
                        }
                    }
                }
            }
        }
    }
    // The limits of the drives are passed, which the run tells; or else the planner says what is in the way.
    slow.or(refused).map_or_else(|| stated(machine, &task(machine, "minimum-norm", 0.0, false)), Ok)
}

/// A machine with a task as a file has it.
fn stated(machine: &Machine, task: &str) -> Result<Scenario, ScenarioError> {
    let text = format!("machine = \"own\"\n[task]\n{task}");
    let scenario = Scenario::parse(&text, machine.name(), Some(&|_| Ok(machine.clone())))?;
    let title = format!("{} · a task made for it", machine.name());
    Ok(Scenario { name: machine.name().to_owned(), title, ..scenario })
}

/// The task but for its time.
fn task(machine: &Machine, kind: &str, span: f64, is_round: bool) -> String {
    let lambda = Inertia::of(machine).lambda();
    let (middle, step) = (middle(machine), step(machine, &lambda, span));
    let tip = |share: f64| {
        let q = PerDrive::from_fn(middle.len(), |k| middle[k] + share * step[k]);
        end_effector(machine.end_effector(), &DriveAngles(q).units())
    };
    // So that the arm points where a picture has room for it.
    let turn = TOWARDS - tip(0.0).arg();
    let b: f64 = middle.iter().zip(lambda.iter()).map(|(q, lambda)| lambda * (q + turn)).sum();
    let round = |x: f64| if is_round { (1e3 * x).round() / 1e3 } else { x };
    let place = |share: f64| {
        let p = tip(share) * unit(turn);
        [p.re, p.im].map(round)
    };
    let (from, to, b) = (place(-0.5), place(0.5), round(b));
    format!("kind = \"{kind}\"\nfrom = {from:?}\nto = {to:?}\nb = {b:?}\n")
}

/// Every drive angle, rad, with relative angles beside the middle of their limits.
fn middle(machine: &Machine) -> PerDrive {
    let beside = |i: usize| {
        let angle = &machine.angles()[i];
        let (low, width) = (angle.limits.start(), angle.limits.end() - angle.limits.start());
        // What may turn without end is bent a little.
        let at = if width >= TAU - 1e-9 { FRAC_PI_3 } else { low + SHARE * width };
        at - angle.offset
    };
    spread(machine, beside, FRAC_PI_3)
}

/// What the drive angles change by, rad, while relative angles turn against each other and b stays.
fn step(machine: &Machine, lambda: &PerDrive, span: f64) -> PerDrive {
    let turned = |i: usize| {
        let limits = &machine.angles()[i].limits;
        let size = (span * (limits.end() - limits.start())).min(FARTHEST);
        if i.is_multiple_of(2) { size } else { -size }
    };
    let way = spread(machine, turned, span);
    let (sum, all) = way.iter().zip(lambda.iter()).fold((0.0, 0.0), |(sum, all), (q, l)| (sum + q * l, all + l));
    match machine.drives() {
        // Alone it has no b to hold.
        1 => PerDrive::from([span]),
        n if all == 0.0 => PerDrive::from_fn(n, |k| way[k]),
        n => PerDrive::from_fn(n, |k| way[k] - sum / all),
    }
}

/// Drive angles that give every relative angle i the difference `of(i)`, rad; a drive that none of them reaches is
/// `loose` from the one before it.
fn spread(machine: &Machine, of: impl Fn(usize) -> f64, loose: f64) -> PerDrive {
    let n = machine.drives();
    let mut known: Vec<Option<f64>> = vec![None; n];
    known[0] = Some(0.0);
    for next in 1..=n {
        for _ in 0..n {
            for (i, angle) in machine.angles().iter().enumerate() {
                match (known[angle.from], known[angle.to]) {
                    (Some(from), None) => known[angle.to] = Some(from + of(i)),
                    (None, Some(to)) => known[angle.from] = Some(to - of(i)),
                    _ => {}
                }
            }
        }
        if next < n && known[next].is_none() {
            known[next] = known[next - 1].map(|before| before + loose);
        }
    }
    PerDrive::from_fn(n, |k| known[k].unwrap_or_default())
}
