//! The table of charts: the signals of each plot, its title, unit and range, and the colours of its lines. Both the
//! window and recordings use this table.

pub mod axis;
pub mod choice;
pub mod drawn;
#[cfg(feature = "ui")]
pub mod figure;
#[cfg(feature = "ui")]
pub mod legend;
#[cfg(feature = "ui")]
mod limit_names;
pub mod range;
pub mod search;

use self::axis::AxisKind;
use super::scene::Rgba;
use super::scene::palette::{Palette, mix};
use stillbase_mechanics::machine::Inertia;
use stillbase_planning::pose_space::constant_inertia;
use stillbase_session::assembly::AssemblyScenario;
use stillbase_session::scenario::Scenario;
use stillbase_simulation::frame::Peaks;
use stillbase_simulation::signals::Signal;

/// A plot of signals over time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart {
    /// Title.
    pub title: &'static str,
    /// Unit of the values as the window shows them.
    pub unit: &'static str,
    /// Paths of signals, or of groups of signals.
    pub signals: &'static [&'static str],
    /// Smallest length of the range, or half of it if the range is centred on zero, in the unit of the values given to
    /// [`Chart::range`].
    pub min_range: f64,
    /// How the vertical axis lies.
    pub axis: AxisKind,
    /// Factor from SI values to the unit of the window.
    pub scale: f64,
    /// Place of the chart.
    pub place: ChartPlace,
    /// Whether a recording overlays all its cases in this chart.
    pub is_overlaid: bool,
}

/// Place of a chart in the window and in recordings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChartPlace {
    /// Beside the scene, in the window and in recordings.
    Beside,
    /// In the window if pin forces are switched on; in recordings, on the page of internal signals.
    Pins,
    /// In recordings only, on the page of internal signals.
    Inside,
    /// In recordings of several cases only, where these are overlaid.
    Compared,
}

/// A chart without signals; the base of all others.
pub const EMPTY_CHART: Chart = Chart {
    title: "",
    unit: "",
    signals: &[],
    min_range: 0.1,
    axis: AxisKind::Centred,
    scale: 1.0,
    place: ChartPlace::Beside,
    is_overlaid: false,
};

const TORQUE: Chart = Chart { title: "Torque", unit: "N m", signals: &["torque"], ..EMPTY_CHART };
const MOMENT: Chart = Chart {
    title: "Turning moment on the base",
    unit: "N m",
    signals: &["moment/total"],
    min_range: 0.5,
    ..EMPTY_CHART
};
/// The moment that the machine transmits, and the moment that turns the base past its reaction wheel, or about its own
/// centre of mass.
const MOMENT_OF_BOTH: Chart = Chart { signals: &["moment/total", "moment/felt"], ..MOMENT };
/// The moment on the base alone, for runs with and without a wheel beside each other. Without one it is n_B.
const MOMENT_FELT: Chart = Chart { signals: &["moment/felt"], ..MOMENT };
/// Cases are compared by what turns the base: past a wheel, or on a base that floats, it is not n_B.
const MOMENT_COMPARED: Chart = Chart {
    title: "Turning moment that the base feels",
    place: ChartPlace::Compared,
    is_overlaid: true,
    ..MOMENT_FELT
};
const FORCE: Chart = Chart {
    title: "Force on the base",
    unit: "N, from motion",
    signals: &["force/dynamic"],
    min_range: 0.5,
    axis: AxisKind::FromZero,
    ..EMPTY_CHART
};
const BASE: Chart = Chart {
    title: "Motion of the base",
    unit: "mm, mrad",
    signals: &["base", "attitude"],
    min_range: 0.01,
    scale: 1e3,
    ..EMPTY_CHART
};
/// A motion that leaves the attitude of a base that floats may well shift it, so its turn is compared by itself.
const TURN: Chart = Chart {
    title: "Turn of the base",
    unit: "mrad",
    signals: &["attitude/base"],
    min_range: 0.01,
    scale: 1e3,
    place: ChartPlace::Compared,
    is_overlaid: true,
    ..EMPTY_CHART
};
const FRICTION: Chart =
    Chart { title: "Friction", unit: "N m", signals: &["friction"], min_range: 0.01, ..EMPTY_CHART };
const PINS: Chart = Chart {
    title: "Pin forces",
    unit: "N",
    signals: &["pin/worst"],
    min_range: 1.0,
    axis: AxisKind::FromZero,
    place: ChartPlace::Pins,
    ..EMPTY_CHART
};
const ANGLES: Chart = Chart {
    title: "Drive angles",
    unit: "rad",
    signals: &["angle"],
    min_range: 0.5,
    axis: AxisKind::Free,
    ..EMPTY_CHART
};
const INERTIAL_ANGLES: Chart = Chart { title: "Drive angles, inertial", ..ANGLES };
const POSE: Chart = Chart {
    title: "Pose constant",
    unit: "rad",
    signals: &["pose/b"],
    axis: AxisKind::Free,
    is_overlaid: true,
    ..EMPTY_CHART
};
/// Of internal signals, all but one are magnitudes.
const INSIDE: Chart = Chart { place: ChartPlace::Inside, axis: AxisKind::FromZero, ..EMPTY_CHART };
const EACH_PIN: Chart = Chart { title: "Force of each pin", unit: "N", signals: &["pin"], min_range: 1.0, ..INSIDE };
const TILT: Chart =
    Chart { title: "Tilting moment", unit: "N m", signals: &["tilt"], axis: AxisKind::Centred, ..INSIDE };
const TRANSMISSION: Chart =
    Chart { title: "Transmission |sin(q_k − q_l)|", unit: "1", signals: &["transmission"], ..INSIDE };
const CHANGE_POINT: Chart =
    Chart { title: "To the nearest change point", unit: "rad", signals: &["change_point/distance"], ..INSIDE };

/// Returns the charts that apply to a scenario, in order of display. `wheels_differ` says that of the runs on display
/// some have a reaction wheel and some have none.
pub fn charts(scenario: &Scenario, wheels_differ: bool) -> Vec<Chart> {
    if let Some(block) = &scenario.assembly {
        return charts_of_block(scenario, &block.scenario);
    }
    let feels_more = scenario.base.feels_more_than_n_b();
    let has_friction = scenario.plant.friction != Default::default();
    let moment = match (wheels_differ, feels_more) {
        (true, _) => MOMENT_FELT,
        (false, true) => MOMENT_OF_BOTH,
        (false, false) => MOMENT,
    };
    let mut list = vec![TORQUE, moment, MOMENT_COMPARED, FORCE];
    list.extend(Some(BASE).filter(|_| scenario.base.moves()));
    list.extend(Some(FRICTION).filter(|_| has_friction));
    // The angles of the drives are those of their links in space; on a fixed base both are the same.
    list.extend([PINS, if scenario.base.moves() { INERTIAL_ANGLES } else { ANGLES }]);
    // There is no pose constant b if no drive exerts a moment on the base, or if λ depends strongly on the pose.
    list.extend(Some(POSE).filter(|_| constant_inertia(&scenario.machine).is_ok()));
    list.extend([EACH_PIN, TILT, TRANSMISSION, CHANGE_POINT]);
    list.extend(Some(TURN).filter(|_| scenario.base.moves()));
    let size = load_scale(scenario);
    for chart in list.iter_mut().filter(|chart| chart.unit.starts_with('N')) {
        chart.min_range *= size;
    }
    list
}

/// Force and moment on the base that the blocks of an assembly share.
const SHARED_FORCE: Chart = Chart {
    title: "Base force",
    unit: "N",
    signals: &["force/dynamic_x", "force/dynamic_y", "force/dynamic_z"],
    min_range: 2e-3,
    ..EMPTY_CHART
};
const SHARED_MOMENT: Chart = Chart {
    title: "Base moment",
    unit: "N m",
    signals: &["moment/dynamic_x", "moment/dynamic_y", "moment/dynamic_z"],
    ..SHARED_FORCE
};
const SHARED_ATTITUDE: Chart = Chart {
    title: "Base attitude",
    unit: "",
    signals: &["attitude/base_x", "attitude/base_y", "attitude/base_z"],
    min_range: 1e-4,
    ..EMPTY_CHART
};
const SHARED_PLACE: Chart =
    Chart { title: "Base place", unit: "mm", signals: &["base"], min_range: 0.01, scale: 1e3, ..EMPTY_CHART };

/// Returns the charts of a block of an assembly: its own, and those of the base that all blocks share.
fn charts_of_block(scenario: &Scenario, whole: &AssemblyScenario) -> Vec<Chart> {
    let floats = whole.base.moves();
    let mut list = vec![TORQUE, SHARED_MOMENT, SHARED_FORCE];
    list.extend([SHARED_ATTITUDE, SHARED_PLACE].into_iter().filter(|_| floats));
    list.extend([PINS, ANGLES]);
    list.extend(Some(POSE).filter(|_| constant_inertia(&scenario.machine).is_ok()));
    list.extend([EACH_PIN, TRANSMISSION, CHANGE_POINT]);
    // The base is that of all blocks, whichever is led.
    let of_all = whole.tasks.iter().map(|task| load_scale(&task.scenario)).fold(MIN_LOAD_SCALE, f64::max);
    let own = load_scale(scenario);
    for chart in list.iter_mut().filter(|chart| chart.unit.starts_with('N')) {
        chart.min_range *= if [SHARED_FORCE.title, SHARED_MOMENT.title].contains(&chart.title) { of_all } else { own };
    }
    list
}

/// Smallest factor on the least range of forces and moments; rounding errors are far below it.
const MIN_LOAD_SCALE: f64 = 1e-6;

/// Returns a factor on the least range of forces and moments, at most 1: the inertia of all drives in kg m² over the
/// square of the task's time in s. So light machines and slow motions show what they do.
fn load_scale(scenario: &Scenario) -> f64 {
    let inertia: f64 = Inertia::of(&scenario.machine).diagonals().iter().sum();
    let load = inertia / (scenario.task.time * scenario.task.time);
    if load.is_finite() { load.clamp(MIN_LOAD_SCALE, 1.0) } else { 1.0 }
}

impl Chart {
    /// Whether the window shows the chart; `pins` says whether pin forces are switched on.
    pub fn in_window(&self, pins: bool) -> bool {
        match self.place {
            ChartPlace::Beside => true,
            ChartPlace::Pins => pins,
            ChartPlace::Inside | ChartPlace::Compared => false,
        }
    }

    /// Whether the chart contains a signal.
    pub fn contains(&self, signal: &Signal) -> bool {
        self.signals.iter().any(|of| signal.path == *of || signal.group() == *of)
    }

    /// Returns the SI unit of the values; empty if dimensionless.
    pub fn si_unit(&self) -> String {
        match (self.scale == 1.0, self.unit) {
            (_, "1") => String::new(),
            (true, unit) => unit.into(),
            // The units of every scaled chart have the prefix milli.
            (false, unit) => unit.split(", ").map(|u| u.strip_prefix('m').unwrap_or(u)).collect::<Vec<_>>().join(", "),
        }
    }

    /// Returns bounds of the axis for the values from `low` to `high`, as [`AxisKind::bounds`]. The range is never smaller
    /// than `min_range`, so that rounding noise does not look like a signal.
    pub fn range(&self, low: f64, high: f64) -> [f64; 2] {
        self.axis.bounds([low, high], self.min_range)
    }

    /// Returns the axis of a run that is complete, for SI values from `low` to `high`, as [`AxisKind::span`].
    pub fn si_span(&self, low: f64, high: f64) -> [f64; 2] {
        self.axis.span([low, high], self.min_range / self.scale)
    }
}

/// Returns the axis of a component in space of a base that blocks share, from 0; `None` for other signals.
fn in_space(signal: &Signal) -> Option<usize> {
    "xyz".find(signal.path.chars().last()?).filter(|_| signal.is_of_shared_base())
}

/// Returns the colour of a signal in every chart. Reactions are red if their peak counts as nonzero, otherwise green.
pub fn colour(signal: &Signal, palette: &Palette, peaks: &Peaks) -> Rgba {
    let paler = |rgba| mix(rgba, palette.dim, 0.6);
    let reaction = |real: bool| if real { palette.reaction } else { palette.zero };
    let (turns, pulls) = (peaks.counts_as_moment(peaks.moment), peaks.counts_as_force(peaks.force));
    match (signal.drive, signal.group(), signal.path.as_str()) {
        (Some(k), "reference", _) => paler(palette.drive(k)),
        (Some(k), ..) => palette.drive(k),
        (None, _, "pose/b_reference") => paler(palette.amber),
        (None, "pose", _) => palette.amber,
        (None, ..) if in_space(signal).is_some() => palette.drive(in_space(signal).unwrap_or_default()),
        (None, "base", "base/y") => palette.dim,
        (None, "attitude", _) => palette.reaction,
        (None, _, "moment/total") => reaction(turns),
        (None, _, "moment/felt") if turns => palette.ink,
        (None, _, "moment/felt") => palette.zero,
        (None, "moment", _) => paler(palette.reaction),
        (None, _, "force/dynamic") => reaction(pulls),
        (None, "force", _) => paler(palette.reaction),
        (None, _, "reactionless/now") => palette.zero,
        _ => palette.ink,
    }
}
