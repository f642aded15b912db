//! The user's choice of plots and curves ([`PlotChoice`], plain data), and the resulting [`Plot`]s.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::axis::AxisKind;
use super::{Chart, EMPTY_CHART, charts};
use crate::notation::{NameOrder, Notation, ShownUnit};
use stillbase_session::scenario::Scenario;
use stillbase_settings::number::without_subscript;
use stillbase_settings::text::capitalised;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::signals::Signal;

/// Maximum number of plots that the user can add, and of curves added to one plot.
const MAX_ADDED: usize = 24;
/// Maximum number of names in the order of plots.
const MAX_ORDERED: usize = 200;
/// Smallest and largest side of the window of a plot, points.
const WINDOW_SIDE_PT: [f32; 2] = [80.0, 8000.0];
/// Farthest place of a window from the corner of the desktop, pixels.
const MAX_DESKTOP_PX: u32 = 65_536;

/// The user's choice of plots and curves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PlotChoice {
    /// Time interval that all plots show, s; `None` follows the run.
    pub range: Option<[f64; 2]>,
    /// Whether statistics of the curves in that interval are shown below each plot.
    pub statistics: bool,
    /// Names of the plots that the user added.
    pub own: Vec<String>,
    /// Names of plots in the user's order. A plot that is not among them follows its predecessor of the usual order.
    pub order: Vec<String>,
    /// Changes of plots, by name of the plot.
    pub changes: BTreeMap<String, PlotSettings>,
    /// Whether of the runs on display some have a reaction wheel and some have none; follows from the runs.
    #[serde(skip)]
    pub wheels_differ: bool,
}

/// The user's changes of one plot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PlotSettings {
    /// Paths of signals that were added.
    pub added: Vec<String>,
    /// Paths of curves that are switched off.
    pub off: BTreeSet<String>,
    /// Path of the signal on the horizontal axis; `None` for time.
    pub against: Option<String>,
    /// Bounds of the vertical axis; `None` shows all values.
    pub values: Option<[f64; 2]>,
    /// Whether the plot is closed.
    pub closed: bool,
    /// Left, top, width and height of the plot's own window, points; `None` while it is among the others. Left and top
    /// count from the corner of the main window.
    pub window: Option<[f32; 4]>,
    /// Left and top of that window on the desktop, pixels; `None` as long as it had no place there.
    pub desktop: Option<[i32; 2]>,
}

/// A change of the choice.
#[derive(Clone, Debug, PartialEq)]
pub enum PlotChange {
    /// Switches a plot's curve on or off.
    Show(String, String, bool),
    /// Adds a plot for a signal.
    Plot(String),
    /// Adds a curve to a plot.
    Add(String, String),
    /// Removes an added curve from its plot.
    Remove(String, String),
    /// Sets the signal on the horizontal axis of a plot; `None` for time.
    Against(String, Option<String>),
    /// Sets the bounds of the vertical axis of a plot; `None` shows all values.
    Values(String, Option<[f64; 2]>),
    /// Closes a plot; a plot that the user added is deleted.
    Close(String),
    /// Reopens all closed plots.
    Reopen,
    /// Puts the plots on display into this order, by name.
    Order(Vec<String>),
    /// Gives a plot a window of its own: left, top, width and height, points. `None` puts it back among the others.
    Window(String, Option<[f32; 4]>),
    /// Keeps where the desktop shows a plot's own window: left and top, pixels, if the system tells them; width and
    /// height, points.
    Desktop(String, Option<[i32; 2]>, [f32; 2]),
    /// Sets the time interval, s; `None` follows the run.
    Range(Option<[f64; 2]>),
    /// Shows or hides the statistics of the curves.
    Statistics(bool),
}

impl PlotChoice {
    /// Applies a change.
    pub fn change(&mut self, change: PlotChange) {
        match change {
            PlotChange::Show(plot, path, on) => {
                let off = &mut self.changes.entry(plot).or_default().off;
                if on {
                    off.remove(&path);
                } else {
                    off.insert(path);
                }
            }
            PlotChange::Plot(path) => {
                let free = |name: &String| !self.own.contains(name);
                let name = (1..=MAX_ADDED).map(|i| format!("plot {i}")).find(free);
                if let Some(name) = name {
                    self.changes.insert(name.clone(), PlotSettings { added: vec![path], ..PlotSettings::default() });
                    self.own.push(name);
                }
            }
            PlotChange::Add(plot, path) => {
                let changes = self.changes.entry(plot).or_default();
                changes.off.remove(&path);
                if !changes.added.contains(&path) && changes.added.len() < MAX_ADDED {
                    changes.added.push(path);
                }
            }
            PlotChange::Remove(plot, path) => {
                let changes = self.changes.entry(plot).or_default();
                changes.added.retain(|known| *known != path);
                changes.off.remove(&path);
            }
            PlotChange::Against(plot, path) => self.changes.entry(plot).or_default().against = path,
            PlotChange::Values(plot, values) => {
                let sound = values.filter(|[low, high]| low.is_finite() && high.is_finite() && low < high);
                self.changes.entry(plot).or_default().values = sound;
            }
            PlotChange::Close(plot) => {
                let own = self.own.iter().position(|name| *name == plot);
                match own {
                    Some(i) => {
                        self.own.remove(i);
                        self.order.retain(|name| *name != plot);
                        self.changes.remove(&plot);
                    }
                    None => self.changes.entry(plot).or_default().closed = true,
                }
            }
            PlotChange::Reopen => self.changes.values_mut().for_each(|changes| changes.closed = false),
            PlotChange::Order(shown) => self.put_in_order(shown),
            PlotChange::Window(plot, window) => {
                let changes = self.changes.entry(plot).or_default();
                // A new place is one in the main window, from which its place on the desktop follows.
                (changes.window, changes.desktop) = (window.filter(is_window), None);
            }
            PlotChange::Desktop(plot, at, [width, height]) => {
                if let Some(changes) = self.changes.get_mut(&plot)
                    && let Some([left, top, ..]) = changes.window
                {
                    changes.window = Some([left, top, width, height]).filter(is_window).or(changes.window);
                    changes.desktop = at.filter(is_on_desktop).or(changes.desktop);
                }
            }
            PlotChange::Range(range) => {
                self.range = range.filter(|[from, to]| from.is_finite() && to.is_finite() && from < to)
            }
            PlotChange::Statistics(shown) => self.statistics = shown,
        }
        // Entries without any change are dropped.
        self.changes.retain(|_, changes| *changes != PlotSettings::default());
    }

    /// Puts the plots on display into an order. Plots that are not on display stay behind their predecessors.
    fn put_in_order(&mut self, shown: Vec<String>) {
        let before = std::mem::replace(&mut self.order, shown);
        let mut at = 0;
        for name in before {
            match self.order.iter().position(|known| *known == name) {
                Some(i) => at = i + 1,
                None => {
                    self.order.insert(at, name);
                    at += 1;
                }
            }
        }
        self.order.truncate(MAX_ORDERED);
    }

    /// Sorts plots by the user's order.
    fn sort(&self, plots: &mut [Plot<'_>]) {
        let mut last = 0;
        let mut places: BTreeMap<String, usize> = BTreeMap::new();
        for plot in &*plots {
            // A plot that the user has just added comes last.
            let follows = if plot.added_by_user { usize::MAX } else { last };
            let place = self.order.iter().position(|name| *name == plot.name).unwrap_or(follows);
            last = if plot.added_by_user { last } else { place };
            places.insert(plot.name.clone(), place);
        }
        // Plots of equal place keep the usual order.
        plots.sort_by_key(|plot| places[&plot.name]);
    }

    /// Returns the plots of a scenario in order of display, in the user's units; `pins` says whether pin forces are
    /// switched on.
    pub fn plots<'a>(
        &self,
        scenario: &Scenario,
        signals: &'a [Signal],
        pins: bool,
        notation: Notation,
    ) -> Vec<Plot<'a>> {
        let none = PlotSettings::default();
        let of = |name: &str| self.changes.get(name).unwrap_or(&none);
        let table = charts(scenario, self.wheels_differ).into_iter().filter(|chart| chart.in_window(pins));
        let open = table.filter(|chart| !of(chart.title).closed);
        let known = open.map(|chart| Plot::of(chart.title, chart, false, of(chart.title), (signals, notation)));
        let own = self.own.iter().map(|name| {
            let chart = Chart { axis: AxisKind::Free, min_range: 0.0, ..EMPTY_CHART };
            Plot::of(name, chart, true, of(name), (signals, notation))
        });
        // An added plot is omitted if the machine has none of its signals.
        let mut plots: Vec<Plot<'a>> = known.chain(own.filter(|plot| !plot.curves.is_empty())).collect();
        self.sort(&mut plots);
        plots
    }

    /// Shows all values of every plot.
    pub fn forget_values(&mut self) {
        self.changes.values_mut().for_each(|changes| changes.values = None);
        self.changes.retain(|_, changes| *changes != PlotSettings::default());
    }

    /// Number of closed plots.
    pub fn closed(&self) -> usize {
        self.changes.values().filter(|changes| changes.closed).count()
    }
}

/// A plot to be drawn.
#[derive(Clone, Debug)]
pub struct Plot<'a> {
    /// Name in the [`PlotChoice`].
    pub name: String,
    /// Title.
    pub title: String,
    /// Chart from the table of charts; a chart without signals if the user added the plot.
    pub chart: Chart,
    /// Order of the title and the symbol of its curves.
    pub names: NameOrder,
    /// Whether the user added the plot.
    pub added_by_user: bool,
    /// All curves, including those that are switched off.
    pub curves: Vec<PlotCurve<'a>>,
    /// Signal on the horizontal axis; `None` for time.
    pub against: Option<PlotCurve<'a>>,
    /// Bounds of the vertical axis; `None` shows all values.
    pub values: Option<[f64; 2]>,
    /// Left, top, width and height of the plot's own window, points; `None` while it is among the others.
    pub window: Option<[f32; 4]>,
    /// Left and top of that window on the desktop, pixels; `None` as long as it had no place there.
    pub desktop: Option<[i32; 2]>,
}

/// A curve of a plot.
#[derive(Clone, Copy, Debug)]
pub struct PlotCurve<'a> {
    /// Signal on the vertical axis.
    pub signal: &'a Signal,
    /// Whether the curve is switched on.
    pub on: bool,
    /// Whether the user added the curve.
    pub added: bool,
    /// Factor from SI values to displayed values.
    pub scale: f64,
    /// Unit of the displayed values; empty if dimensionless.
    pub unit: &'static str,
    /// Decimals of the displayed values.
    pub decimals: usize,
}

impl<'a> PlotCurve<'a> {
    /// Returns a curve in the user's units; `in_thousandths` says whether its plot shows lengths and angles in
    /// thousandths of their SI units.
    fn of(signal: &'a Signal, added: bool, on: bool, in_thousandths: bool, notation: Notation) -> Self {
        let (unit, scale, decimals) = match (in_thousandths, signal.unit) {
            (true, "m") => ("mm", 1e3, 2),
            (true, "rad") => ("mrad", 1e3, 2),
            (_, "1") => ("", 1.0, 3),
            (_, unit) => (unit, 1.0, 3),
        };
        let shown = notation.shown_unit(unit).unwrap_or(ShownUnit { name: unit, factor: 1.0, decimals: 0 });
        // Fewer than one decimal would hide the motion of a curve.
        let decimals = shown.decimals(decimals).max(1);
        Self { signal, on, added, scale: scale * shown.factor, unit: shown.name, decimals }
    }

    /// Returns the displayed value at one instant.
    pub fn value(&self, frame: &Frame) -> f64 {
        self.scale * self.signal.value(frame)
    }
}

impl<'a> Plot<'a> {
    fn of(
        name: &str,
        chart: Chart,
        added_by_user: bool,
        changes: &PlotSettings,
        (signals, notation): (&'a [Signal], Notation),
    ) -> Self {
        let find = |path: &String| signals.iter().find(|signal| signal.path == *path);
        let held = signals.iter().filter(|signal| chart.contains(signal)).map(|signal| (signal, false));
        let added = changes.added.iter().filter_map(find).filter(|signal| !chart.contains(signal));
        let curves: Vec<PlotCurve<'a>> = held
            .chain(added.map(|signal| (signal, true)))
            .map(|(signal, added)| {
                PlotCurve::of(signal, added, !changes.off.contains(&signal.path), chart.scale != 1.0, notation)
            })
            .collect();
        let against =
            changes.against.as_ref().and_then(find).map(|signal| PlotCurve::of(signal, true, true, false, notation));
        let mut title = match curves.first() {
            Some(first) if added_by_user => capitalised(&first.signal.label),
            _ => chart.title.to_owned(),
        };
        if added_by_user && curves.len() > 1 {
            title += " …";
        }
        let in_units = match (chart.scale == 1.0, notation.shown_unit(chart.unit)) {
            // In a plot with several units, each curve has its own unit.
            (true, Some(shown)) => Chart { unit: shown.name, min_range: shown.factor * chart.min_range, ..chart },
            _ => chart,
        };
        let names = notation.names;
        let (values, window) = (changes.values, changes.window.filter(is_window));
        let (chart, desktop) = (in_units, changes.desktop.filter(is_on_desktop));
        Self { name: name.into(), title, chart, names, added_by_user, curves, against, values, window, desktop }
    }

    /// Returns the title, with the symbol of the horizontal axis unless that is time. If symbols come first, that of the
    /// curves precedes the title.
    pub fn heading(&self) -> String {
        let [symbol, words] = self.heading_parts();
        symbol + &words
    }

    /// Returns the heading in two parts: the symbol before the title with a gap, if symbols come first, and the rest.
    pub fn heading_parts(&self) -> [String; 2] {
        let symbol = match (self.names, self.symbol()) {
            (NameOrder::Symbols, Some(symbol)) => format!("{symbol}  "),
            _ => String::new(),
        };
        let words = match &self.against {
            Some(across) => format!("{} against {}", self.title, across.signal.symbol),
            None => self.title.clone(),
        };
        [symbol, words]
    }

    /// Returns the symbol that the curves share but for their indices.
    fn symbol(&self) -> Option<&str> {
        let mut symbols = self.shown().map(|curve| without_subscript(&curve.signal.symbol));
        let first = symbols.next()?;
        symbols.all(|other| other == first).then_some(first)
    }

    /// The curves that are switched on.
    pub fn shown(&self) -> impl Iterator<Item = &PlotCurve<'a>> {
        self.curves.iter().filter(|curve| curve.on)
    }

    /// Returns the units of the values, each once, separated by commas.
    pub fn unit(&self) -> String {
        // The units of a chart with several units follow from its curves.
        if !self.added_by_user && self.chart.scale == 1.0 && !self.curves.iter().any(|curve| curve.added) {
            return self.chart.unit.into();
        }
        let mut units: Vec<&str> = Vec::new();
        for unit in self.curves.iter().map(|curve| curve.unit) {
            if !units.contains(&unit) && !unit.is_empty() {
                units.push(unit);
            }
        }
        units.join(", ")
    }
}

/// Whether left, top, width and height (points) are within the bounds of a window.
fn is_window([left, top, width, height]: &[f32; 4]) -> bool {
    let [least, most] = WINDOW_SIDE_PT;
    [left, top].iter().all(|x| x.abs() <= most) && [width, height].iter().all(|side| (least..=most).contains(*side))
}

/// Whether left and top (pixels) can be a place on a desktop.
fn is_on_desktop(place: &[i32; 2]) -> bool {
    place.iter().all(|x| x.unsigned_abs() <= MAX_DESKTOP_PX)
}
