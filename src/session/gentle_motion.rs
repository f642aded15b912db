//! [`gentle_motion`]: makes a scenario for a machine that comes without one.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

use toml::{Table, Value};

use super::edit::Edit;
use super::run::Run;
use super::scenario::{Scenario, ScenarioError, TaskKind};
use super::shared_task::straightened;
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, unit};
use stillbase_mechanics::sketch::Template;
use stillbase_settings::change::DEFAULT_WORD;
use stillbase_simulation::plant::{Base, BaseKind};

/// Each relative angle in the middle of the motion, as a fraction of the range between its limits. At a fraction of one
/// half, parallelograms go flat.
const MID_POSE_FRACTION: f64 = 0.6;
/// Turn of each relative angle, as a fraction of the range between its limits, in the order of the trials.
const SPAN_FRACTIONS: [f64; 4] = [0.3, 0.2, 0.1, 0.04];
/// Maximum turn of a relative angle, rad.
const MAX_SPAN_RAD: f64 = 0.8;
/// Direction of the end effector from the base pin in the middle of the motion, rad.
const DIRECTION_RAD: f64 = 0.3 * PI;
/// Directions of a line at zero momentum from the direction of the end effector, rad, in the order of the trials: inwards
/// and across. Not every direction can be held, for there is one silent rate at each pose.
const WAYS_RAD: [f64; 3] = [PI, FRAC_PI_2, -FRAC_PI_2];
/// Number of intervals between the samples of a motion of the drives.
const SWEEP_ROWS: u32 = 40;
/// Durations of the motion, s. The first one that exceeds no limit of a drive is used.
const DURATIONS_S: [f64; 4] = [2.0, 4.0, 8.0, 16.0];

/// Returns a scenario with a small motion near the middle of the joint limits. The motion is reactionless if possible,
/// otherwise along a straight line, or else prescribed as drive angles over time. If all trials fail, returns one of
/// them; the planner or the run then reports the reason.
///
/// # Errors
/// If no task can be stated for the machine.
pub fn gentle_motion(machine: &Machine) -> Result<Scenario, ScenarioError> {
    let (mut slow, mut refused) = (None, None);
    for kind in ["reactionless", "minimum-norm"] {
        for span in SPAN_FRACTIONS {
            for is_round in [true, false] {
                let task = task(machine, kind, span, is_round);
                for time in DURATIONS_S {
                    let scenario = stated(machine, &format!("{task}time = {time:?}\n"))?;
                    let plan = Run::new(&scenario).map(|run| run.plan().forecast.exceeded_limit.is_none());
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
    // If limits of the drives are exceeded, the run reports it.
    if let Some(slow) = slow {
        return Ok(slow);
    }
    let swept = stated(machine, &swept(machine))?;
    match Run::new(&swept) {
        Ok(_) => Ok(swept),
        // The planner says what prevents the motion.
        Err(_) => Ok(refused.unwrap_or(swept)),
    }
}

/// Returns a scenario with a small motion of a machine on a base that floats: that of [`gentle_motion`] if it is
/// reactionless, otherwise a straight line without angular momentum if the planner finds one.
///
/// # Errors
/// As [`gentle_motion`].
pub fn gentle_motion_afloat(machine: &Machine, base: Base) -> Result<Scenario, ScenarioError> {
    let usual = Scenario { base, ..gentle_motion(machine)? };
    if usual.task.kind == TaskKind::Reactionless {
        return Ok(usual);
    }
    for (span, way) in SPAN_FRACTIONS.iter().flat_map(|span| WAYS_RAD.map(|way| (*span, way))) {
        let task = task_from_start(machine, span, way);
        for time in DURATIONS_S {
            let scenario = Scenario { base, ..stated(machine, &format!("{task}time = {time:?}\n"))? };
            match Run::new(&scenario).map(|run| run.plan().forecast.exceeded_limit.is_none()) {
                Ok(true) => return Ok(scenario),
                Ok(false) => {}
                Err(_) => break,
            }
        }
    }
    Ok(usual)
}

/// Returns a scenario with a small motion of the machine of another one, on its base if that floats.
///
/// # Errors
/// As [`gentle_motion`].
pub(super) fn made_for(present: &Scenario) -> Result<Scenario, ScenarioError> {
    match present.base.kind {
        BaseKind::Free => gentle_motion_afloat(&present.machine, present.base),
        BaseKind::Fixed | BaseKind::Compliant => gentle_motion(&present.machine),
    }
}

/// Returns the scenario to open for another machine: its built-in one, else the present one if the machine can do its
/// task, straight if need be, else the first built-in one of the same machine, else one made for it.
pub fn for_machine(present: &Scenario, machine: &Machine) -> Scenario {
    if let Some(own) = Scenario::builtin(machine.name()) {
        return own;
    }
    let alike = present.on_machine(machine);
    if Run::new(&alike).is_ok() {
        return alike;
    }
    if let Some((straight, _)) = straightened(&alike) {
        return straight.scenario;
    }
    let known = Scenario::builtins().find(|scenario| scenario.machine == *machine).cloned();
    known.or_else(|| gentle_motion(machine).ok()).unwrap_or(alike)
}

/// Returns the scenario to open for a new drawing. A template that is a machine gets a task made for it; until a drawing
/// is complete, the machine and the task are those of the present scenario.
pub fn for_template(present: &Scenario, template: Template) -> Scenario {
    let mut sketch = template.sketch();
    // A drawing of this name may be open, so the new one is told apart.
    let taken = |name: &str| {
        present.machine.name() == name
            || present.name == name
            || present.sketch.as_ref().is_some_and(|own| own.name == name)
    };
    let plain = sketch.name.clone();
    if let Some(free) = (2..).map(|i| format!("{plain} {i}")).find(|name| !taken(name)).filter(|_| taken(&plain)) {
        sketch.name = free;
    }
    let made = sketch.machine().and_then(|machine| gentle_motion(&machine).ok());
    let name = sketch.name.clone();
    let scenario = made.unwrap_or_else(|| Scenario {
        name: name.clone(),
        title: name,
        summary: template.summary().to_owned(),
        ..present.without_edits()
    });
    Scenario { sketch: Some(sketch), ..scenario }
}

/// Returns the scenario with a task made for its machine, if one can be stated.
pub fn with_own_task(present: &Scenario) -> Option<Scenario> {
    let made = made_for(present).ok()?;
    Some(Scenario { sketch: present.sketch.clone(), design: present.design.clone(), ..made })
}

/// Returns the edit that gives a drawn machine a task made for it in place of one that it cannot do; `None` if the task
/// is already so, or the one that is made cannot be done either.
pub(super) fn own_task(present: &Scenario) -> Option<Edit> {
    let made = made_for(present).ok()?.task;
    Run::new(&Scenario { task: made.clone(), ..present.without_edits() }).ok()?;
    let [now, made] = [Table::try_from(&present.task).ok()?, Table::try_from(&made).ok()?];
    let dropped = now.keys().filter(|key| !made.contains_key(*key));
    let dropped = dropped.map(|key| (key.clone(), Value::from(DEFAULT_WORD)));
    let set = made.iter().filter(|(key, value)| now.get(*key) != Some(*value));
    let change: Table = set.map(|(key, value)| (key.clone(), value.clone())).chain(dropped).collect();
    (!change.is_empty()).then(|| Edit::of("task", change))
}

/// Whether the task of a scenario is the one that is made for its machine.
pub(super) fn has_made_task(scenario: &Scenario) -> bool {
    made_for(scenario).is_ok_and(|made| made.task == scenario.task)
}

/// Returns a motion of the drives over time, as TOML. It needs no inverse kinematics and no path between points.
fn swept(machine: &Machine) -> String {
    let (middle, step) = (middle(machine), step(machine, &Inertia::of(machine).lambda(), SPAN_FRACTIONS[2]));
    let rows: Vec<String> = (0..=SWEEP_ROWS)
        .map(|i| {
            let u = f64::from(i) / f64::from(SWEEP_ROWS);
            let share = u * u * u * (10.0 + u * (6.0 * u - 15.0)) - 0.5;
            let row = std::iter::once(u * DURATIONS_S[0]).chain((0..middle.len()).map(|k| middle[k] + share * step[k]));
            let row: Vec<String> = row.map(|x| format!("{:?}", (1e6 * x).round() / 1e6)).collect();
            format!("[{}]", row.join(", "))
        })
        .collect();
    format!("kind = \"given\"\nsamples = [{}]\n", rows.join(", "))
}

/// Returns a scenario of a machine with a task, given as TOML.
fn stated(machine: &Machine, task: &str) -> Result<Scenario, ScenarioError> {
    let text = format!("machine = \"own\"\n[task]\n{task}");
    let scenario = Scenario::parse(&text, machine.name(), Some(&|_| Ok(machine.clone().into())))?;
    let title = format!("{} · a task made for it", machine.name());
    Ok(Scenario { name: machine.name().to_owned(), title, ..scenario })
}

/// Returns the task as TOML, without its time.
fn task(machine: &Machine, kind: &str, span: f64, is_round: bool) -> String {
    let lambda = Inertia::of(machine).lambda();
    let (middle, step) = (middle(machine), step(machine, &lambda, span));
    let tip = |share: f64| {
        let q = PerDrive::from_fn(middle.len(), |k| middle[k] + share * step[k]);
        end_effector(machine.end_effector(), &DriveAngles(q).units())
    };
    // Turns the arm to where a picture has room for it.
    let turn = DIRECTION_RAD - tip(0.0).arg();
    let b: f64 = middle.iter().zip(lambda.iter()).map(|(q, lambda)| lambda * (q + turn)).sum();
    let round = |x: f64| if is_round { (1e3 * x).round() / 1e3 } else { x };
    let place = |share: f64| {
        let p = tip(share) * unit(turn);
        [p.re, p.im].map(round)
    };
    let (from, to, b) = (place(-0.5), place(0.5), round(b));
    format!("kind = \"{kind}\"\nfrom = {from:?}\nto = {to:?}\nb = {b:?}\n")
}

/// Returns a task at zero momentum as TOML, without its time: its pose at A, and a line at an angle `way`, rad, to the
/// direction of the end effector from the base pin.
fn task_from_start(machine: &Machine, span: f64, way: f64) -> String {
    let round = |x: f64| (1e3 * x).round() / 1e3;
    let tip = |q: &PerDrive| end_effector(machine.end_effector(), &DriveAngles(*q).units());
    let bent = middle(machine);
    let turn = DIRECTION_RAD - tip(&bent).arg();
    let start = PerDrive::from_fn(bent.len(), |k| round(bent[k] + turn));
    let from = tip(&start);
    let to = from + 0.5 * span * from.norm() * unit(from.arg() + way);
    let (start, to) = (&start[..bent.len()], [to.re, to.im].map(round));
    format!("kind = \"zero-momentum\"\nshape = \"line\"\nstart = {start:?}\nto = {to:?}\n")
}

/// Returns all drive angles, rad, with relative angles near the middle of their limits.
fn middle(machine: &Machine) -> PerDrive {
    let beside = |i: usize| {
        let angle = &machine.angles()[i];
        let (low, width) = (angle.limits.start(), angle.limits.end() - angle.limits.start());
        // An angle without limits is set to a fixed bend.
        let at = if width >= TAU - 1e-9 { FRAC_PI_3 } else { low + MID_POSE_FRACTION * width };
        at - angle.offset
    };
    spread(machine, beside, FRAC_PI_3)
}

/// Returns changes of the drive angles, rad, by which relative angles turn in alternating directions while b stays
/// constant.
fn step(machine: &Machine, lambda: &PerDrive, span: f64) -> PerDrive {
    let turned = |i: usize| {
        let limits = &machine.angles()[i].limits;
        let size = (span * (limits.end() - limits.start())).min(MAX_SPAN_RAD);
        if i.is_multiple_of(2) { size } else { -size }
    };
    let way = spread(machine, turned, span);
    let (sum, all) = way.iter().zip(lambda.iter()).fold((0.0, 0.0), |(sum, all), (q, l)| (sum + q * l, all + l));
    match machine.drives() {
        // A single drive has no b to hold.
        1 => PerDrive::from([span]),
        n if all == 0.0 => PerDrive::from_fn(n, |k| way[k]),
        n => PerDrive::from_fn(n, |k| way[k] - sum / all),
    }
}

/// Returns drive angles that give every relative angle i the difference `of(i)`, rad. A drive in no relative angle
/// differs by `loose`, rad, from the drive before it.
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
