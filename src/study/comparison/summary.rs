//! [`Summary`]: results of a run, as one row of a table.

use stillbase_session::scenario::Scenario;
use stillbase_session::verdict::Verdict;
use stillbase_simulation::frame::Frame;

/// Results of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Name of the scenario.
    pub name: String,
    /// Title of the scenario.
    pub title: String,
    /// Duration, s.
    pub time: f64,
    /// Largest dynamic |f_B|, N.
    pub peak_force: f64,
    /// Root mean square of the dynamic |f_B|, N.
    pub rms_force: f64,
    /// ∫ |f_B| dt, N s.
    pub force_impulse: f64,
    /// Largest |n_B| that the arm transmits, before a reaction wheel, N m.
    pub peak_arm_moment: f64,
    /// Largest |moment| on the base, after the reaction wheel, N m.
    pub peak_moment: f64,
    /// Root mean square of the moment on the base, N m.
    pub rms_moment: f64,
    /// Impulse of the moment on the base, ∫ |n| dt, N m s.
    pub moment_impulse: f64,
    /// Largest |p_B|, m.
    pub base_shift: f64,
    /// Largest |θ|, rad.
    pub base_tilt: f64,
    /// θ at the end of a free base, rad.
    pub base_angle_end: Option<f64>,
    /// Distance of the end effector from its target at the end, m; `None` for samples of drive angles, which have none.
    pub miss: Option<f64>,
    /// Largest |τ_k| of any drive, N m.
    pub peak_torque: f64,
    /// Energy of the motors without recuperation, ∫ Σ |τ_k (q̇_k − θ̇)| dt including the wheel, J.
    pub energy: f64,
    /// Largest rate of a reaction wheel, rad/s.
    pub wheel_rate: Option<f64>,
    /// Largest momentum of a reaction wheel, N m s.
    pub wheel_momentum: Option<f64>,
    /// Largest torque of a reaction wheel, N m.
    pub peak_wheel_torque: Option<f64>,
    /// Time at which a reaction wheel first could not deliver the requested torque, s.
    pub saturated_at: Option<f64>,
    /// Whether the arm transmitted no reactions.
    pub reactionless: bool,
    /// The first audit that failed, in words.
    pub fault: Option<String>,
    /// Verdict on the run.
    pub verdict: Verdict,
}

/// A column of a table.
#[derive(Clone, Copy, Debug)]
pub struct SummaryColumn<T = Summary> {
    /// Name of the result.
    pub key: &'static str,
    /// Header of the column, in words.
    pub term: &'static str,
    /// Header of the column, in symbols; short, for a table of text.
    pub head: &'static str,
    /// Meaning, in words.
    pub meaning: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// Number of decimals shown.
    pub decimals: usize,
    /// Columns with lower priority give way first where space is short.
    pub priority: u8,
    /// Returns the value; `None` if the row has none.
    pub value: fn(&T) -> Option<f64>,
}

/// Columns of the table, in order.
pub const SUMMARY_COLUMNS: [SummaryColumn; 18] = [
    column(["duration", "time", "T", "time of the motion"], "s", 3, 14, |s| Some(s.time)),
    column(["peak_felt_moment", "peak moment", "peak n", "largest moment that the base feels"], "N m", 4, 24, |s| {
        Some(s.peak_moment)
    }),
    column(["rms_felt_moment", "RMS moment", "rms n", "its root mean square"], "N m", 4, 10, |s| Some(s.rms_moment)),
    column(["felt_moment_impulse", "moment impulse", "∫|n|dt", "its impulse"], "N m s", 4, 8, |s| {
        Some(s.moment_impulse)
    }),
    column(["peak_base_force", "peak force", "peak f", "largest force on the base, from motion"], "N", 4, 23, |s| {
        Some(s.peak_force)
    }),
    column(["rms_base_force", "RMS force", "rms f", "its root mean square"], "N", 4, 6, |s| Some(s.rms_force)),
    column(["force_impulse", "force impulse", "∫|f|dt", "its impulse"], "N s", 4, 5, |s| Some(s.force_impulse)),
    column(["base_shift", "base shift", "shift", "largest displacement of the base"], "m", 5, 19, |s| {
        Some(s.base_shift)
    }),
    column(["base_angle", "base angle", "angle", "largest angle of the base"], "rad", 5, 18, |s| Some(s.base_tilt)),
    column(["base_angle_end", "base angle, end", "angle end", "angle of a free base at the end"], "rad", 5, 17, |s| {
        s.base_angle_end
    }),
    column(["miss", "miss", "miss", "distance of the end effector from its target at the end"], "m", 5, 15, |s| s.miss),
    column(["peak_torque", "peak torque", "peak τ", "largest torque of any drive"], "N m", 4, 22, |s| {
        Some(s.peak_torque)
    }),
    column(["energy", "energy", "energy", "energy that motors took, none given back"], "J", 4, 20, |s| Some(s.energy)),
    column(["wheel_rate", "wheel rate", "wheel", "largest rate of the reaction wheel"], "rad/s", 1, 12, |s| {
        s.wheel_rate
    }),
    column(
        ["wheel_momentum", "wheel momentum", "h wheel", "largest momentum of the reaction wheel"],
        "N m s",
        4,
        16,
        |s| s.wheel_momentum,
    ),
    column(
        ["peak_wheel_torque", "wheel torque", "peak τ_w", "largest torque of the reaction wheel"],
        "N m",
        4,
        11,
        |s| s.peak_wheel_torque,
    ),
    column(["saturated_at", "saturates at", "saturates", "when the wheel could give no more"], "s", 3, 7, |s| {
        s.saturated_at
    }),
    column(
        ["peak_base_moment", "peak arm moment", "peak n_B", "largest moment of the arm, before the wheel"],
        "N m",
        4,
        13,
        |s| Some(s.peak_arm_moment),
    ),
];

/// Results that JSON and tables still have under an older name, until version 0.3: the name, and the older one.
pub const OLD_NAMES: [(&str, &str); 8] = [
    ("duration", "time"),
    ("peak_felt_moment", "peak_moment"),
    ("rms_felt_moment", "rms_moment"),
    ("felt_moment_impulse", "moment_impulse"),
    ("peak_base_force", "peak_force"),
    ("rms_base_force", "rms_force"),
    ("base_angle", "base_tilt"),
    ("peak_base_moment", "peak_arm_moment"),
];

pub(super) const fn column<T>(
    [key, term, head, meaning]: [&'static str; 4],
    unit: &'static str,
    decimals: usize,
    priority: u8,
    value: fn(&T) -> Option<f64>,
) -> SummaryColumn<T> {
    SummaryColumn { key, term, head, meaning, unit, decimals, priority, value }
}

impl Summary {
    /// Returns the results of a run from its last frame.
    pub fn of(scenario: &Scenario, last: &Frame) -> Self {
        let (peaks, totals, verdict) = (&last.peaks, &last.totals, Verdict::of(scenario, last));
        Self {
            name: scenario.name.clone(),
            title: scenario.title.clone(),
            time: last.time,
            peak_force: peaks.force,
            rms_force: totals.force_rms(),
            force_impulse: totals.force_impulse,
            peak_arm_moment: verdict.arm_moment,
            peak_moment: peaks.moment,
            rms_moment: totals.moment_rms(),
            moment_impulse: totals.moment_impulse,
            base_shift: totals.shift,
            base_tilt: totals.base_angle,
            base_angle_end: verdict.attitude.map(|attitude| attitude.end),
            wheel_momentum: verdict.wheel.map(|wheel| wheel.momentum),
            peak_wheel_torque: verdict.wheel.map(|wheel| wheel.torque),
            miss: verdict.target_distance,
            peak_torque: peaks.torque.max_abs(),
            energy: totals.energy,
            wheel_rate: scenario.base.wheel.map(|_| totals.wheel_rate),
            saturated_at: totals.saturated,
            reactionless: verdict.reactionless,
            fault: verdict.fault.map(|figure| figure.to_string()),
            verdict,
        }
    }
}
