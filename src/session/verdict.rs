//! [`Verdict`]: the assessment of a run in one word, with remarks. Command line, window and recording show the same
//! verdict.
//!
//! | quantity | meaning |
//! |---|---|
//! | n_B, f_B | moment and force that the arm transmits to its base: they decide whether a run is reactionless |
//! | moment past the wheel | n_B less the moment of a wheel: with f_B it decides whether the base is unloaded |
//! | θ | angle of a free base: its peak decides whether the base keeps its attitude |

mod statements;

pub use statements::{Statement, Statements, StatusLight};
pub(crate) use statements::{changes_b, inertia_of};

use crate::scenario::{Scenario, TaskKind};
use stillbase_mechanics::planar::{PerDrive, Vector};
use stillbase_planning::curves::Samples;
use stillbase_planning::timing::limits::{DriveLimit, DriveLimits, LimitedQuantity};
use stillbase_settings::number::{ShortNumber, fixed, significant};
use stillbase_simulation::audit::AuditFigure;
use stillbase_simulation::frame::{Frame, Peaks, Phase, SharedBase};
use stillbase_simulation::plant::BaseKind;

/// Maximum final distance of the end effector from its target, m, at which the target counts as reached.
const TARGET_TOLERANCE: f64 = 1e-4;

/// A joint counts as past its limit if it exceeds the limit by more than this, rad.
pub const LIMIT_TOLERANCE: f64 = 1e-6;

/// A drive is past its limit above this ratio of peak to limit. Feedback adds less than 0.1 % to a motion that just
/// keeps the limit.
const MAX_LIMIT_RATIO: f64 = 1.0 + 1e-3;

/// A free base keeps its attitude if it turns by no more than this, or by no more past a wanted angle, rad: 0.2 seconds of
/// arc.
pub const ATTITUDE_TOLERANCE: f64 = 1e-6;

/// Smaller tilting moments are treated as zero, N m.
const MIN_TILT_N_M: f64 = 1e-9;

/// The arm has moved if the peak rate of a drive is greater than this, rad/s.
const MIN_RATE_RAD_S: f64 = 1e-9;

/// Assessment of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Whether the arm transmits nothing, neither n_B nor dynamic f_B, and no audit has failed.
    pub reactionless: bool,
    /// Whether no reaction acts on the base, after compensation by a reaction wheel if there is one.
    pub is_base_unloaded: bool,
    /// Attitude of a free base; `None` for another base.
    pub attitude: Option<Attitude>,
    /// What a reaction wheel had to give; `None` without a wheel.
    pub wheel: Option<WheelUse>,
    /// The base that the machine shares with other blocks of an assembly, and what all of them did to it.
    pub shared: Option<SharedBase>,
    /// Whether the arm has moved at all.
    pub moved: bool,
    /// Largest |n_B|, N m.
    pub arm_moment: f64,
    /// Largest moment past the wheel, N m; `None` without a wheel.
    pub past_wheel: Option<f64>,
    /// Largest dynamic |f_B|, N.
    pub force: f64,
    /// Largest moment that tilts the base, from heights along the axis, N m; the verdict does not depend on it.
    pub tilt: f64,
    /// Distance of the end effector from its target, m; `None` if the run has none, as samples of drive angles prescribe no
    /// point of the end effector.
    pub target_distance: Option<f64>,
    /// Relative joint angle that exceeded its limit by most, and the largest excess, rad.
    pub past_limit: Option<(String, f64)>,
    /// Torque or speed limit of a drive that was exceeded by the largest factor, and that factor.
    pub exceeded_limit: Option<(DriveLimit, f64)>,
    /// First audit that failed; the other figures cannot be trusted then.
    pub fault: Option<AuditFigure>,
    /// End of the run and the later time at which the payload would be picked up, s; `None` if it is picked up.
    never_held: Option<[f64; 2]>,
    /// Whether the motion has come to rest and the target is not out of reach.
    ended: bool,
}

/// Attitude of a free base over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude {
    /// Largest |θ|, rad.
    pub peak: f64,
    /// θ at the end, rad.
    pub end: f64,
    /// Largest |p_B|, m.
    pub shift: f64,
    /// θ at the end that the task wants, rad, if it is to turn the base.
    pub wanted: Option<f64>,
}

impl Attitude {
    /// Returns whether the base keeps its attitude.
    pub fn is_kept(&self) -> bool {
        self.peak <= ATTITUDE_TOLERANCE
    }

    /// Returns whether the base is as the task wants it: turned by the wanted angle, or kept.
    pub fn is_as_wanted(&self) -> bool {
        self.wanted.map_or(self.is_kept(), |wanted| (self.end - wanted).abs() <= ATTITUDE_TOLERANCE)
    }
}

/// Momentum and torque of a reaction wheel over a run, with its limits if it has any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelUse {
    /// Largest |J Ω|, N m s.
    pub momentum: f64,
    /// J times the limit of Ω, N m s.
    pub momentum_limit: Option<f64>,
    /// Largest |τ_w|, N m.
    pub torque: f64,
    /// Limit of τ_w, N m.
    pub torque_limit: Option<f64>,
    /// Time at which the wheel first could not give the torque that was wanted, s.
    pub saturated: Option<f64>,
}

impl WheelUse {
    /// Returns a sentence: `the wheel takes up 1.9 of 4 N m s, peak 0.3 of 0.5 N m`.
    fn sentence(&self) -> String {
        let of = |x: f64, limit: Option<f64>, unit: &str| match limit {
            Some(limit) => format!("{} of {} {unit}", significant(x), significant(limit)),
            None => format!("{} {unit}", significant(x)),
        };
        let (momentum, torque) =
            (of(self.momentum, self.momentum_limit, "N m s"), of(self.torque, self.torque_limit, "N m"));
        let full = self.saturated.map_or_else(String::new, |at| format!(", saturated from {} s", fixed(at, 3)));
        format!("the wheel takes up {momentum}, peak {torque}{full}")
    }
}

/// Returns the limit on torque, speed or acceleration that the peaks exceed by the largest factor, and that factor.
fn over(limits: &DriveLimits, peaks: &Peaks) -> Option<(DriveLimit, f64)> {
    let of = |quantity, peaks: PerDrive| {
        let factors = PerDrive::from_fn(peaks.len(), |k| peaks[k] / limits.on(quantity)[k]);
        (0..peaks.len()).map(move |drive| (DriveLimit { quantity, drive }, factors[drive]))
    };
    let all = of(LimitedQuantity::Torque, peaks.torque)
        .chain(of(LimitedQuantity::Speed, peaks.rate))
        .chain(of(LimitedQuantity::Acceleration, peaks.acceleration));
    all.filter(|(_, factor)| *factor > MAX_LIMIT_RATIO).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Returns whether samples of drive angles guide the machine and the user does not drag it. The target is then only the
/// end of the samples.
fn gives_drives(scenario: &Scenario, frame: &Frame) -> bool {
    let task = &scenario.task;
    let columns = task.samples.as_ref().map(Samples::columns);
    let of_drives = task.kind == TaskKind::Given && columns == Some(scenario.machine.drives());
    let [x, y] = task.to;
    of_drives && (frame.target.at - Vector::new(x, y)).norm() <= TARGET_TOLERANCE
}

/// Returns the peaks of force and moment that all blocks together put on their base.
pub(crate) fn peaks_of(shared: &SharedBase) -> String {
    let three =
        |first: usize| shared.peaks[first..first + 3].iter().map(|x| significant(*x)).collect::<Vec<_>>().join(", ");
    format!("peak force {} N and moment {} N m of all blocks, along and about x, y, z", three(0), three(3))
}

/// A remark on a verdict, in a few words and in a sentence.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// A few words, for a cell of a table.
    pub short: String,
    /// A sentence, for a line of text.
    pub long: String,
}

impl Verdict {
    /// Assesses a run up to a frame.
    pub fn of(scenario: &Scenario, frame: &Frame) -> Self {
        let peaks = &frame.peaks;
        let (by, angle) = peaks.past_limit;
        let name = |i: usize| scenario.machine.angles().get(i).map_or_else(String::new, |a| a.name.clone());
        let is_silent = |shared: SharedBase| shared.silent() == [true; 6];
        let floating = frame.shared.filter(|shared| shared.moves);
        let of_shared =
            floating.map(|SharedBase { turn: [peak, end], shift, .. }| Attitude { peak, end, shift, wanted: None });
        Self {
            reactionless: frame.was_reactionless() && frame.first_violation().is_none(),
            is_base_unloaded: frame.shared.map_or(peaks.is_base_unloaded(), is_silent),
            attitude: of_shared.or((scenario.base.kind == BaseKind::Free).then_some(Attitude {
                peak: frame.totals.base_angle,
                end: frame.base.angle,
                shift: frame.totals.shift,
                wanted: (scenario.task.kind == TaskKind::TurnBase).then_some(scenario.task.base_turn.to_radians()),
            })),
            shared: frame.shared,
            wheel: scenario.base.wheel.map(|wheel| WheelUse {
                momentum: wheel.inertia * frame.totals.wheel_rate,
                momentum_limit: wheel.speed_limit.map(|limit| wheel.inertia * limit),
                torque: frame.totals.wheel_torque,
                torque_limit: wheel.torque_limit,
                saturated: frame.totals.saturated,
            }),
            moved: peaks.rate.iter().any(|rate| *rate > MIN_RATE_RAD_S),
            exceeded_limit: over(&DriveLimits::of(&scenario.machine), peaks),
            arm_moment: peaks.arm_moment,
            past_wheel: scenario.base.wheel.map(|_| peaks.moment),
            force: peaks.force,
            tilt: peaks.tilt,
            target_distance: (!gives_drives(scenario, frame)).then(|| (frame.end_effector - frame.target.at).norm()),
            past_limit: (by > LIMIT_TOLERANCE).then(|| (name(angle), by)),
            fault: frame.first_violation(),
            never_held: Some([frame.time, scenario.plant.payload.from]).filter(|[end, from]| {
                scenario.plant.payload.is_some() && *from >= end - 0.5 * scenario.step && *from > 0.0
            }),
            // A target out of reach needs no remark: the window marks it at the target itself.
            ended: frame.phase == Phase::Rest && frame.target.reach.waits_at().is_none(),
        }
    }

    /// Returns whether no audit has failed, and the arm transmits no reaction, a wheel compensates all of it, or a free
    /// base keeps its attitude or turns as wanted.
    pub fn spares_base(&self) -> bool {
        let is_spared = self.attitude.map_or(self.is_base_unloaded, |attitude| attitude.is_as_wanted());
        self.fault.is_none() && (self.reactionless || is_spared)
    }

    /// Returns the distance of the end effector from its target, m, if the target does not count as reached.
    pub fn miss(&self) -> Option<f64> {
        self.target_distance.filter(|distance| *distance > TARGET_TOLERANCE || distance.is_nan())
    }

    /// Returns `reactionless`, `not reactionless`, `reactionless past the wheel`, or `untrusted`. Of a free base it tells
    /// whether it `keeps its attitude`, `turns its base as wanted` or `turns its base`.
    pub fn word(&self) -> &'static str {
        match (&self.fault, self.reactionless, self.attitude, self.is_base_unloaded) {
            (Some(_), ..) => "untrusted",
            (None, true, ..) => "reactionless",
            (None, false, Some(attitude), _) if attitude.is_kept() => "keeps its attitude",
            (None, false, Some(attitude), _) if attitude.is_as_wanted() => "turns its base as wanted",
            (None, false, Some(_), _) => "turns its base",
            (None, false, None, true) => "reactionless past the wheel",
            (None, false, None, false) => "not reactionless",
        }
    }

    /// Returns the answer to "reactionless?" for a cell of a table: `yes`, `no`, `untrusted`, with the remarks.
    pub fn answer(&self) -> String {
        let word = match (&self.fault, self.reactionless) {
            (Some(_), _) => "untrusted",
            (None, true) => "yes",
            (None, false) => "no",
        };
        let attitude = self.attitude.filter(|_| !self.reactionless && self.fault.is_none());
        let attitude = attitude.map(|_| self.word().to_owned());
        std::iter::once(word.to_owned())
            .chain(attitude)
            .chain(self.remarks().into_iter().map(|r| r.short))
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// Returns the remarks on a finished run.
    pub fn remarks(&self) -> Vec<Remark> {
        self.remarks_if(true)
    }

    /// Returns the remarks on a run that may still go on. Those that depend on its end come only once it is at rest.
    pub fn so_far(&self) -> Vec<Remark> {
        self.remarks_if(self.ended)
    }

    /// Returns the remarks on limits that were exceeded, and on a target that a finished run has missed.
    pub fn misses(&self) -> Vec<Remark> {
        self.misses_if(true)
    }

    fn remarks_if(&self, finished: bool) -> Vec<Remark> {
        let mut all = Vec::new();
        let mut add = |short: &str, long: String| all.push(Remark { short: short.into(), long });
        if finished && !self.moved {
            add("never moved", "the arm never moved, so this says nothing of how it moves".into());
        }
        if let Some([end, from]) = self.never_held.filter(|_| finished) {
            let long = format!(
                "plant.payload.from is {} s, and the run ends at {} s: nothing is picked up",
                ShortNumber(from),
                fixed(end, 3)
            );
            add("payload never held", long);
        }
        let is_held = self.attitude.is_none();
        if let Some(past_wheel) = self.past_wheel.filter(|_| is_held && self.is_base_unloaded && !self.reactionless) {
            let all = significant(self.arm_moment);
            let long = format!(
                "the arm transmits up to {all} N m; the moment past the wheel is {} N m",
                significant(past_wheel)
            );
            add("the wheel takes it up", long);
        }
        if self.tilt > MIN_TILT_N_M {
            let long = format!(
                "links at different heights tilt the base by up to {} N m, which this verdict leaves out",
                significant(self.tilt)
            );
            add("tilts its base", long);
        }
        all.extend(self.misses_if(finished));
        all
    }

    fn misses_if(&self, finished: bool) -> Vec<Remark> {
        let mut all = Vec::new();
        let mut add = |short: &str, long: String| all.push(Remark { short: short.into(), long });
        if let Some((angle, by)) = &self.past_limit {
            add("past a joint limit", format!("{angle} passes its limit by up to {} rad", significant(*by)));
        }
        if let Some((limit, factor)) = self.exceeded_limit {
            let short = match limit.quantity {
                LimitedQuantity::Torque => "past a torque limit",
                LimitedQuantity::Speed => "past a speed limit",
                _ => "past an acceleration limit",
            };
            add(short, format!("the {limit} goes up to {} times its limit", significant(factor)));
        }
        if let Some(miss) = self.miss().filter(|_| finished) {
            add("off its target", format!("ends {} m from its target", significant(miss)));
        }
        all
    }

    /// Returns one line, such as `reactionless: peak |n_B| 1.2e-15 N m, peak |f_B| 3.1e-14 N; ends 0.0200 m from its
    /// target`. Of a free base it tells the attitude first.
    pub fn sentence(&self) -> String {
        let mut text = format!("{}: ", self.word());
        if let Some(Attitude { peak, end, shift, .. }) = self.attitude {
            let [peak, end, shift] = [peak, end, shift].map(significant);
            text += &format!("peak |θ| {peak} rad, {end} rad at the end, shifted by up to {shift} m; ");
        }
        match &self.shared {
            Some(shared) => text += &peaks_of(shared),
            None => text += &format!("peak |n_B| {} N m", significant(self.arm_moment)),
        }
        if let Some(past_wheel) = self.past_wheel {
            text += &format!(", past the wheel {} N m", significant(past_wheel));
        }
        if self.shared.is_none() {
            text += &format!(", peak |f_B| {} N", significant(self.force));
        }
        if let Some(wheel) = self.wheel {
            text += &format!("; {}", wheel.sentence());
        }
        if let Some(figure) = &self.fault {
            text += &format!("; audit failed: {figure}");
        }
        self.remarks().into_iter().fold(text, |text, remark| format!("{text}; {}", remark.long))
    }
}
