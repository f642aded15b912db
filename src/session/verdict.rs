//! [`Verdict`]: what a run comes to, in a word, with what a person should know beside it. Command line, window and
//! recording show this one.
//!
//! | quantity | is |
//! |---|---|
//! | n_B, f_B | what the arm transmits to its base: by these it is called reactionless |
//! | moment past the wheel | what a reaction wheel leaves of n_B for the base: by this the base feels nothing |

mod statements;

pub use statements::{Lamp, Statement, Statements};

use crate::mechanics::planar::{PerDrive, Vector};
use crate::planning::curves::Samples;
use crate::planning::timing::limits::{DriveLimit, LimitedQuantity, Limits};
use crate::session::scenario::{Scenario, TaskKind};
use crate::settings::number::{Short, fixed, significant};
use crate::simulation::audit::AuditFigure;
use crate::simulation::frame::{Frame, Peaks, Phase, Reach};

/// Farther than this from its target an end effector misses it, m.
pub const MISS: f64 = 1e-4;

/// By more than this a joint passes its limit, rad.
pub const PAST: f64 = 1e-6;

/// By more than this factor a drive passes its limit: less is what control adds to a motion that just keeps it.
const OVER: f64 = 1.0 + 1e-3;

/// A smaller tilting moment is none, N m.
const TILT: f64 = 1e-9;

/// Slower than this the arm does not move, rad/s.
const STILL: f64 = 1e-9;

/// What a run comes to.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Whether the arm transmits nothing, neither n_B nor dynamic f_B, and no audit has failed.
    pub reactionless: bool,
    /// Whether the base feels nothing, past a reaction wheel if it has one.
    pub base_feels_nothing: bool,
    /// Whether the arm has moved at all.
    pub moved: bool,
    /// Largest |n_B|, N m.
    pub arm_moment: f64,
    /// Largest moment past the wheel, N m; `None` without a wheel.
    pub past_wheel: Option<f64>,
    /// Largest dynamic |f_B|, N.
    pub force: f64,
    /// Largest moment that tilts the base, from heights along the axis, N m: outside of the verdict.
    pub tilt: f64,
    /// How far the end effector is from its target, m; from where the samples end, if these say where the drives go.
    pub miss: f64,
    /// Whether it has a target: samples of drive angles say of no point that the end effector is to be there.
    pub has_target: bool,
    /// A relative joint angle that passed its limit, and by how much at most, rad.
    pub past_limit: Option<(String, f64)>,
    /// The limit of a drive on torque or speed that was passed by most, and by what factor.
    pub over: Option<(DriveLimit, f64)>,
    /// The first audit that failed: then nothing of this can be trusted.
    pub fault: Option<AuditFigure>,
    /// The end of the run and when the payload would be picked up, s, where that is not before.
    never_held: Option<[f64; 2]>,
    /// Whether the guide has come to its end, where it can.
    ended: bool,
}

/// The limit on torque or speed that peaks pass by most.
fn over(limits: &Limits, peaks: &Peaks) -> Option<(DriveLimit, f64)> {
    let of = |quantity, peaks: PerDrive| {
        let factors = PerDrive::from_fn(peaks.len(), |k| peaks[k] / limits.on(quantity)[k]);
        (0..peaks.len()).map(move |drive| (DriveLimit { quantity, drive }, factors[drive]))
    };
    let all = of(LimitedQuantity::Torque, peaks.torque).chain(of(LimitedQuantity::Speed, peaks.rate));
    all.filter(|(_, factor)| *factor > OVER).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Whether samples of drive angles lead, not a hand: then the target is only where they end.
fn gives_drives(scenario: &Scenario, frame: &Frame) -> bool {
    let task = &scenario.task;
    let columns = task.samples.as_ref().map(Samples::columns);
    let of_drives = task.kind == TaskKind::Given && columns == Some(scenario.machine.drives());
    let [x, y] = task.to;
    of_drives && (frame.target.at - Vector::new(x, y)).norm() <= MISS
}

/// Something to know beside a verdict: in two or three words, and in a sentence.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// For a cell of a table.
    pub short: String,
    /// For a line.
    pub long: String,
}

impl Verdict {
    /// Of a run up to a frame.
    pub fn of(scenario: &Scenario, frame: &Frame) -> Self {
        let peaks = &frame.peaks;
        let (by, angle) = peaks.past_limit;
        let name = |i: usize| scenario.machine.angles().get(i).map_or_else(String::new, |a| a.name.clone());
        Self {
            reactionless: peaks.is_reactionless() && frame.fault().is_none(),
            base_feels_nothing: peaks.base_feels_nothing(),
            moved: peaks.rate.iter().any(|rate| *rate > STILL),
            over: over(&Limits::of(&scenario.machine), peaks),
            arm_moment: peaks.arm_moment,
            past_wheel: scenario.base.wheel.map(|_| peaks.moment),
            force: peaks.force,
            tilt: peaks.tilt,
            miss: (frame.end_effector - frame.target.at).norm(),
            has_target: !gives_drives(scenario, frame),
            past_limit: (by > PAST).then(|| (name(angle), by)),
            fault: frame.fault(),
            never_held: Some([frame.time, scenario.plant.payload.from]).filter(|[end, from]| {
                scenario.plant.payload.is_some() && *from >= end - 0.5 * scenario.step && *from > 0.0
            }),
            // For a target that cannot be reached, the window says so at the target.
            ended: frame.phase == Phase::Rest && !matches!(frame.target.reach, Reach::Outside { .. }),
        }
    }

    /// Whether the base was left alone, by the arm or by a wheel.
    pub fn is_good(&self) -> bool {
        self.fault.is_none() && (self.reactionless || self.base_feels_nothing)
    }

    /// `reactionless`, `not reactionless`, `reactionless past the wheel`, or `untrusted`.
    pub fn word(&self) -> &'static str {
        match (&self.fault, self.reactionless, self.base_feels_nothing) {
            (Some(_), ..) => "untrusted",
            (None, true, _) => "reactionless",
            (None, false, true) => "reactionless past the wheel",
            (None, false, false) => "not reactionless",
        }
    }

    /// The answer to "reactionless?" for a cell of a table: `yes`, `no`, `untrusted`, with the remarks.
    pub fn answer(&self) -> String {
        let word = match (&self.fault, self.reactionless) {
            (Some(_), _) => "untrusted",
            (None, true) => "yes",
            (None, false) => "no",
        };
        std::iter::once(word.to_owned())
            .chain(self.remarks().into_iter().map(|r| r.short))
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// What should be known of a run that is over.
    pub fn remarks(&self) -> Vec<Remark> {
        self.known(true)
    }

    /// What should be known of a run that may still go on: what only its end can tell is left out until then.
    pub fn so_far(&self) -> Vec<Remark> {
        self.known(self.ended)
    }

    fn known(&self, over: bool) -> Vec<Remark> {
        let mut all = Vec::new();
        let mut add = |short: &str, long: String| all.push(Remark { short: short.into(), long });
        if over && !self.moved {
            add("never moved", "the arm never moved, so this says nothing of how it moves".into());
        }
        if let Some([end, from]) = self.never_held.filter(|_| over) {
            let long = format!(
                "plant.payload.from is {} s, and the run ends at {} s: nothing is picked up",
                Short(from),
                fixed(end, 3)
            );
            add("payload never held", long);
        }
        if let Some(left) = self.past_wheel.filter(|_| self.base_feels_nothing && !self.reactionless) {
            let all = significant(self.arm_moment);
            let long = format!(
                "the arm transmits up to {all} N m; the wheel takes it up and leaves {} N m",
                significant(left)
            );
            add("the wheel takes it up", long);
        }
        if self.tilt > TILT {
            let long = format!(
                "links at different heights tilt the base by up to {} N m, which this verdict leaves out",
                significant(self.tilt)
            );
            add("tilts its base", long);
        }
        if let Some((angle, by)) = &self.past_limit {
            add("past a joint limit", format!("{angle} passes its limit by up to {} rad", significant(*by)));
        }
        if let Some((limit, factor)) = self.over {
            let short = match limit.quantity {
                LimitedQuantity::Torque => "past a torque limit",
                _ => "past a speed limit",
            };
            add(short, format!("the {limit} goes up to {} times its limit", significant(factor)));
        }
        if over && self.has_target && (self.miss > MISS || self.miss.is_nan()) {
            add("off its target", format!("ends {} m from its target", significant(self.miss)));
        }
        all
    }

    /// `reactionless: peak |n_B| 1.2e-15 N m, peak |f_B| 3.1e-14 N; ends 0.0200 m from its target`.
    pub fn sentence(&self) -> String {
        let mut text = format!("{}: peak |n_B| {} N m", self.word(), significant(self.arm_moment));
        if let Some(left) = self.past_wheel {
            text += &format!(", past the wheel {} N m", significant(left));
        }
        text += &format!(", peak |f_B| {} N", significant(self.force));
        if let Some(figure) = &self.fault {
            text += &format!("; audit failed: {figure}");
        }
        self.remarks().into_iter().fold(text, |text, remark| format!("{text}; {}", remark.long))
    }
}
