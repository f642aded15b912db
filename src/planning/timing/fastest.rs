//! The fastest motion on a path from rest to rest within the limits of the drives.
//!
//! On a straight joint line with constant mass matrix and no static load, every limit bounds ṡ, s̈ or s⃛, and
//! the optimum has a closed form. Otherwise the motion is a time-optimal path parameterisation, and with limits on jerk
//! a feasible motion near it.

use crate::curves::path::Path;
use crate::timing::keep::{PhaseBound, greatest_of, slow_to_keep};
use crate::timing::law::PathProgress;
use crate::timing::limits::{
    ArmOnPath, ConstraintRow, Constraints, DriveLimit, DriveLimits, LimitedQuantity, Stretches,
};
use crate::timing::outcome::{FastestMotion, TimeError};
use crate::timing::profile::{JerkPhase, Profile, after};
use crate::timing::s_curve::s_curve;
use crate::timing::smooth;
use crate::timing::topp::{NoTiming, PathConstraints, REPAIR_THRESHOLD, TimingSweep, UNLIMITED};
use crate::timing::usage::TimeShares;
use stillbase_mechanics::arm_on_base::ArmOnBase;
use stillbase_mechanics::machine::BALANCE_TOLERANCE;
use stillbase_mechanics::planar::{DriveAngles, PerDrive};

/// Initial number of intervals of the grid on a curve, unless the caller gives stations.
pub const GRID_INTERVALS: usize = 600;

/// Finds the fastest motion of an arm on a path within its limits, including those on jerk if `smooth`. On a curve the
/// grid begins with [`stations`] of [`GRID_INTERVALS`] and the path's own samples of s. It is refined where limited
/// quantities change much. Finally the motion is slowed down until it keeps the limits between stations too.
///
/// # Errors
/// If numbers of drives differ, a needed limit is missing (jerk too if `smooth`), or no motion keeps the limits.
pub fn fastest(path: &Path, arm: &ArmOnBase, limits: &DriveLimits, smooth: bool) -> Result<FastestMotion, TimeError> {
    planned(path, arm, limits, smooth, None)
}

/// Returns stations s = u² (3 − 2 u) at evenly spaced u. They are densest at the ends, where a motion from rest to rest
/// is slow.
pub fn stations(spaces: usize) -> Vec<f64> {
    let at = |i: usize| {
        let u = i as f64 / spaces as f64;
        u * u * (3.0 - 2.0 * u)
    };
    (0..=spaces).map(at).collect()
}

/// Finds the fastest motion as [`fastest`] on a fixed grid of stations that rise from 0 to 1. Limits other than those
/// on jerk are kept at the stations. Between them, the error is of second order in their spacing.
///
/// # Errors
/// As [`fastest`], and if the stations do not rise from 0 to 1.
pub fn fastest_at(
    path: &Path,
    arm: &ArmOnBase,
    limits: &DriveLimits,
    smooth: bool,
    stations: &[f64],
) -> Result<FastestMotion, TimeError> {
    let rising = stations.windows(2).all(|w| w[0] < w[1]);
    if !rising || stations.len() < 2 || stations.first() != Some(&0.0) || stations.last() != Some(&1.0) {
        return Err(TimeError::Stations);
    }
    planned(path, arm, limits, smooth, Some(stations))
}

fn planned(
    path: &Path,
    arm: &ArmOnBase,
    limits: &DriveLimits,
    smooth: bool,
    stations: Option<&[f64]>,
) -> Result<FastestMotion, TimeError> {
    let drives = (path.at(0.0).q.len(), arm.arm().drives(), limits.torque.len());
    let alike = LimitedQuantity::ALL.iter().all(|quantity| limits.on(*quantity).len() == drives.1);
    if drives.0 != drives.1 || !alike {
        return Err(TimeError::Drives { path: drives.0, model: drives.1, limits: drives.2 });
    }
    let constraints = Constraints::new(arm, limits);
    match path {
        Path::Rest(_) => return Ok(nowhere()),
        Path::JointLine { from, to } if from == to => return Ok(nowhere()),
        Path::JointLine { from, to } if arm.is_linear() => {
            return straight(from, &to.0.minus(&from.0), arm, limits, smooth);
        }
        _ if smooth && !(0..drives.1).any(|k| limits.jerk[k].is_finite()) => return Err(TimeError::NoJerkLimit),
        _ => {}
    }
    let nodes = match stations {
        Some(stations) => stations.to_vec(),
        None => dense(path),
    };
    let grid = PathConstraints::new(&ArmOnPath { path, constraints: &constraints }, nodes);
    let (grid, timed, phase_bounds) = match stations {
        Some(_) => {
            let timed = curved(path, &grid, grid.fastest(), &constraints);
            (grid, timed, None)
        }
        None => mended(path, &constraints, grid),
    };
    let bound = timed.map(|Timed { profile, x }| {
        let active_limits = leading(path, &grid, &constraints, &x);
        FastestMotion { profile, gap: None, active_limits }
    });
    if smooth {
        return smooth::smooth(path, arm, &constraints, &grid, bound);
    }
    let found = bound?;
    let Some(phase_bounds) = phase_bounds else { return Ok(found) };
    let factor = greatest_of(phase_bounds, |at: &PathProgress| constraints.stretches(path, at));
    let profile = slow_to_keep(&found.profile, factor).ok_or(TimeError::Stuck { s: 0.0 })?;
    Ok(FastestMotion { profile, ..found })
}

/// Finds the fastest motion on a grid that is refined where limited quantities change much and where limits are
/// exceeded between stations. Also returns samples of each phase.
fn mended(
    path: &Path,
    constraints: &Constraints,
    grid: PathConstraints,
) -> (PathConstraints, Result<Timed, TimeError>, Option<Vec<PhaseBound>>) {
    let stretches = |at: &PathProgress| constraints.stretches(path, at);
    let jumps = jumps(path);
    let on_path = ArmOnPath { path, constraints };
    let (mut grid, mut found) = grid.fastest_refined(&on_path);
    let mut refinements = 0..MAX_REFINEMENTS;
    loop {
        let timed = match curved(path, &grid, found, constraints) {
            Ok(timed) => timed,
            error => return (grid, error, None),
        };
        let phase_bounds = bounds_of_phases(&timed.profile, &grid, &jumps, stretches);
        let enough = 1.0 + REPAIR_THRESHOLD;
        let closer = |phase_bound: &PhaseBound| match phase_bound.bound > enough {
            true => phase_bound.closer(enough, stretches)[0],
            false => phase_bound.seen,
        };
        let past: Vec<f64> = phase_bounds.iter().map(closer).collect();
        let is_kept = past.iter().all(|past| *past <= enough);
        if is_kept || past.len() + 1 != grid.s.len() || refinements.next().is_none() {
            return (grid, Ok(timed), Some(phase_bounds));
        }
        (grid, found) = grid.mended(&on_path, &past);
    }
}

/// Samples each phase. Limited quantities are known at the stations, except where they may jump.
fn bounds_of_phases(
    profile: &Profile,
    grid: &PathConstraints,
    jumps: &[f64],
    stretches: impl Fn(&PathProgress) -> Stretches,
) -> Vec<PhaseBound> {
    let may_jump = |s: f64| {
        jumps[jumps.partition_point(|jump| *jump < s - S_TOLERANCE)..].first().is_some_and(|j| *j <= s + S_TOLERANCE)
    };
    let has_stations = profile.phases().count() + 1 == grid.s.len();
    let phase_bound = |(i, phase): (usize, (PathProgress, f64))| {
        if !has_stations || may_jump(grid.s[i]) || may_jump(grid.s[i + 1]) {
            return PhaseBound::of(phase, &stretches);
        }
        let (from, time) = phase;
        let ends = [grid.stretches(i, &from), grid.stretches(i + 1, &after(&from, time))];
        PhaseBound::between(phase, ends.each_ref(), &stretches)
    };
    profile.phases().enumerate().map(phase_bound).collect()
}

/// Returns the ascending s at which q′ or q″ may jump: none for a table, in which both are continuous.
fn jumps(path: &Path) -> Vec<f64> {
    match path {
        Path::Table(_) => Vec::new(),
        _ => path.joints(),
    }
}

/// Differences of s below this are treated as zero.
const S_TOLERANCE: f64 = 1e-9;

/// Maximum number of refinements of the grid where limits are exceeded between stations.
const MAX_REFINEMENTS: usize = 6;

/// Returns [`stations`] merged with the samples of s of a path, which replace stations close to them.
fn dense(path: &Path) -> Vec<f64> {
    let (own, even) = (path.sample_parameters(), stations(GRID_INTERVALS));
    let mut all = Vec::with_capacity(own.len() + even.len());
    let mut next = 0;
    for (i, s) in even.iter().enumerate() {
        while next < own.len() && own[next] <= *s {
            all.push(own[next]);
            next += 1;
        }
        let room = 0.25 * (even[(i + 1).min(GRID_INTERVALS)] - even[i.saturating_sub(1)]);
        let clear = |near: Option<&f64>| near.is_none_or(|near| (near - s).abs() > room);
        if clear(all.last()) && clear(own.get(next)) {
            all.push(*s);
        }
    }
    all
}

/// Returns the motion on a path of no length.
fn nowhere() -> FastestMotion {
    FastestMotion { profile: Profile::none(), gap: None, active_limits: Vec::new() }
}

/// Returns the fastest motion on a straight joint line in closed form; torques are linear in the accelerations.
fn straight(
    from: &DriveAngles,
    step: &PerDrive,
    arm: &ArmOnBase,
    limits: &DriveLimits,
    smooth: bool,
) -> Result<FastestMotion, TimeError> {
    let motors = arm.arm().motors();
    let torque = motors.motor_torques(&arm.moving_torque(&from.units(), &PerDrive::zeros(step.len()), step));
    let step = motors.to_motors(step);
    let least = |per: &PerDrive, quantity: LimitedQuantity| {
        let limit = |drive: usize| (limits.on(quantity)[drive] / per[drive].abs(), DriveLimit { quantity, drive });
        // Torques of couplings that count as zero are zero.
        let negligible = BALANCE_TOLERANCE * per.max_abs();
        let moving = (0..per.len()).filter(|k| per[*k].abs() > negligible).map(limit);
        moving.fold((f64::INFINITY, DriveLimit { quantity, drive: 0 }), |a, b| if b.0 < a.0 { b } else { a })
    };
    let speed = least(&step, LimitedQuantity::Speed);
    let torque = least(&torque, LimitedQuantity::Torque);
    let wanted = least(&step, LimitedQuantity::Acceleration);
    let acceleration = if torque.0 <= wanted.0 { torque } else { wanted };
    let jerk = least(&step, LimitedQuantity::Jerk);
    let without = s_curve(speed.0, acceleration.0, f64::INFINITY);
    let spans = match (smooth, without) {
        (true, _) if jerk.0.is_infinite() => return Err(TimeError::NoJerkLimit),
        (true, _) => s_curve(speed.0, acceleration.0, jerk.0),
        (false, spans) => spans,
    };
    let Some(spans) = spans else {
        return Err(if speed.0.is_finite() { TimeError::SpeedOnly } else { TimeError::Unlimited { s: 0.0 } });
    };
    let profile = Profile::of_spans(&spans);
    let mut shares = TimeShares::default();
    for (i, span) in spans.iter().enumerate() {
        let leads = [jerk, acceleration, jerk, speed, jerk, acceleration, jerk][i];
        shares.add(leads.1, span.time);
    }
    let time = |spans: [JerkPhase; 7]| spans.iter().map(|s| s.time).sum::<f64>();
    let gap = without.filter(|_| smooth).map(|w| (profile.duration() / time(w) - 1.0).max(0.0));
    Ok(FastestMotion { profile, gap, active_limits: shares.sorted() })
}

/// A timing on a grid.
struct Timed {
    profile: Profile,
    /// ṡ² at each station, 1/s²; empty if no drive moves.
    x: Vec<f64>,
}

fn curved(
    path: &Path,
    grid: &PathConstraints,
    found: Result<TimingSweep, NoTiming>,
    constraints: &Constraints,
) -> Result<Timed, TimeError> {
    let stations = &grid.s;
    if grid.rows.iter().all(|r| r.a == 0.0 && r.c == 0.0) {
        // No drive moves, or no drive that moves has a limit on torque or acceleration.
        let moves = stations.iter().any(|s| path.at(*s).first.max_abs() > 0.0);
        return match (moves, grid.cap.iter().any(|x| x.is_finite() && *x < UNLIMITED)) {
            (false, _) => Ok(Timed { profile: Profile::none(), x: Vec::new() }),
            (true, true) => Err(TimeError::SpeedOnly),
            (true, false) => Err(TimeError::Unlimited { s: 0.0 }),
        };
    }
    let TimingSweep { x, rise } = found.map_err(|blocked| explain(grid, constraints, blocked))?;
    if let Some(i) = x.iter().position(|x| *x >= UNLIMITED) {
        return Err(TimeError::Unlimited { s: stations[i] });
    }
    let profile = Profile::through(stations, &x, &rise).ok_or(TimeError::Stuck { s: 0.0 })?;
    Ok(Timed { profile, x })
}

/// Returns why no motion passes a station.
fn explain(grid: &PathConstraints, constraints: &Constraints, blocked: NoTiming) -> TimeError {
    let (NoTiming::At(i) | NoTiming::Rest(i)) = blocked;
    let near = [i, (i + 1).min(grid.s.len() - 1)];
    for i in near {
        for (row, limit) in grid.rows_at(i).iter().zip(constraints.rows()) {
            if row.g.abs() > 1.0 {
                let limit_value = constraints.limits().on(limit.quantity)[limit.drive];
                return TimeError::Static {
                    drive: limit.drive + 1,
                    s: grid.s[i],
                    torque: row.g * limit_value,
                    limit: limit_value,
                };
            }
        }
    }
    TimeError::Stuck { s: grid.s[i] }
}

/// Returns each limit with the fraction of the duration during which it is used most, the greatest first.
fn leading(path: &Path, grid: &PathConstraints, constraints: &Constraints, x: &[f64]) -> Vec<(DriveLimit, f64)> {
    let mut shares = TimeShares::default();
    for i in 0..x.len().saturating_sub(1) {
        let way = grid.s[i + 1] - grid.s[i];
        let u = (x[i + 1] - x[i]) / (2.0 * way);
        let mut largest: Option<(f64, DriveLimit)> = None;
        let mut take = |part: f64, limit: DriveLimit| {
            if largest.is_none_or(|(m, _)| part > m) {
                largest = Some((part, limit));
            }
        };
        for i in [i, i + 1] {
            for (row, limit) in grid.rows_at(i).iter().zip(constraints.rows()) {
                take(ConstraintRow::value(row, u, x[i]).abs(), *limit);
            }
        }
        let fastest = if x[i] / grid.cap[i] > x[i + 1] / grid.cap[i + 1] { i } else { i + 1 };
        let part = (x[fastest] / grid.cap[fastest]).sqrt();
        if largest.is_none_or(|(m, _)| part > m) {
            let drive = constraints.fastest_drive(&path.at(grid.s[fastest]));
            largest = Some((part, DriveLimit { quantity: LimitedQuantity::Speed, drive }));
        }
        if let Some((_, limit)) = largest {
            shares.add(limit, 2.0 * way / (x[i].sqrt() + x[i + 1].sqrt()));
        }
    }
    shares.sorted()
}
