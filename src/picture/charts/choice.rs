//! What a person chose to see in plots: [`Choice`], plain data; and the [`Plot`]s that come of it.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use super::{Chart, PLAIN, charts};
use crate::session::scenario::Scenario;
use crate::simulation::signals::Signal;

/// The most plots that a person adds, and the most curves added to one.
const MOST: usize = 24;

/// What a person chose to see in plots.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Choice {
    /// The time that all plots show, s; none follows the run.
    pub range: Option<[f64; 2]>,
    /// What the curves come to in that time stands below each plot.
    pub statistics: bool,
    /// Plots of one's own, by name.
    pub own: Vec<String>,
    /// What was changed about a plot, by its name.
    pub changes: BTreeMap<String, Changes>,
}

/// What was changed about one plot.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Changes {
    /// Paths of signals that were added.
    pub added: Vec<String>,
    /// Paths of curves that are switched off.
    pub off: BTreeSet<String>,
    /// The path of the signal that it is drawn over in place of time.
    pub against: Option<String>,
    /// The values that it shows; none shows all of them.
    pub values: Option<[f64; 2]>,
    /// It is put away.
    pub closed: bool,
}

/// What can be changed.
#[derive(Clone, Debug, PartialEq)]
pub enum Change {
    /// Switches a plot's curve on or off.
    Show(String, String, bool),
    /// A plot of its own for a signal.
    Plot(String),
    /// One more curve in a plot.
    Add(String, String),
    /// Takes a curve that was added out of its plot.
    Remove(String, String),
    /// Draws a plot over a signal, or over time.
    Against(String, Option<String>),
    /// The values that a plot shows; none shows all of them.
    Values(String, Option<[f64; 2]>),
    /// Puts a plot away: one of one's own for good.
    Close(String),
    /// Brings all plots back that were put away.
    Reopen,
    /// The time to show, s; none follows the run.
    Range(Option<[f64; 2]>),
    /// Shows or hides what curves come to.
    Statistics(bool),
}

impl Choice {
    /// Changes it.
    pub fn change(&mut self, change: Change) {
        match change {
            Change::Show(plot, path, on) => {
                let off = &mut self.changes.entry(plot).or_default().off;
                if on {
                    off.remove(&path);
                } else {
                    off.insert(path);
                }
            }
            Change::Plot(path) => {
                let free = |name: &String| !self.own.contains(name);
                let name = (1..=MOST).map(|i| format!("plot {i}")).find(free);
                if let Some(name) = name {
                    self.changes.insert(name.clone(), Changes { added: vec![path], ..Changes::default() });
                    self.own.push(name);
                }
            }
            Change::Add(plot, path) => {
                let changes = self.changes.entry(plot).or_default();
                changes.off.remove(&path);
                if !changes.added.contains(&path) && changes.added.len() < MOST {
                    changes.added.push(path);
                }
            }
            Change::Remove(plot, path) => {
                let changes = self.changes.entry(plot).or_default();
                changes.added.retain(|known| *known != path);
                changes.off.remove(&path);
            }
            Change::Against(plot, path) => self.changes.entry(plot).or_default().against = path,
            Change::Values(plot, values) => {
                let sound = values.filter(|[low, high]| low.is_finite() && high.is_finite() && low < high);
                self.changes.entry(plot).or_default().values = sound;
            }
            Change::Close(plot) => {
                let own = self.own.iter().position(|name| *name == plot);
                match own {
                    Some(i) => {
                        self.own.remove(i);
                        self.changes.remove(&plot);
                    }
                    None => self.changes.entry(plot).or_default().closed = true,
                }
            }
            Change::Reopen => self.changes.values_mut().for_each(|changes| changes.closed = false),
            Change::Range(range) => {
                self.range = range.filter(|[from, to]| from.is_finite() && to.is_finite() && from < to)
            }
            Change::Statistics(shown) => self.statistics = shown,
        }
        // What is as it was need not be remembered.
        self.changes.retain(|_, changes| *changes != Changes::default());
    }

    /// The plots of a scenario, in the order in which they stand; `pins` where the forces of pins are switched on.
    pub fn plots<'a>(&self, scenario: &Scenario, signals: &'a [Signal], pins: bool) -> Vec<Plot<'a>> {
        let none = Changes::default();
        let of = |name: &str| self.changes.get(name).unwrap_or(&none);
        let table = charts(scenario).into_iter().filter(|chart| chart.in_window(pins));
        let open = table.filter(|chart| !of(chart.title).closed);
        let known = open.map(|chart| Plot::of(chart.title, chart, false, of(chart.title), signals));
        let own = self.own.iter().map(|name| {
            let chart = Chart { centred: false, least: 0.0, ..PLAIN };
            Plot::of(name, chart, true, of(name), signals)
        });
        // Of a plot of one's own nothing is left where the machine has none of its signals.
        known.chain(own.filter(|plot| !plot.curves.is_empty())).collect()
    }

    /// How many plots are put away.
    pub fn closed(&self) -> usize {
        self.changes.values().filter(|changes| changes.closed).count()
    }
}

/// A plot as it is to be drawn.
#[derive(Clone, Debug)]
pub struct Plot<'a> {
    /// What the choice calls it.
    pub name: String,
    /// What it shows.
    pub title: String,
    /// The chart that it is, or one that holds nothing.
    pub chart: Chart,
    /// A person made it.
    pub own: bool,
    /// Its curves, those that are off too.
    pub curves: Vec<Curve<'a>>,
    /// What it is drawn over in place of time.
    pub against: Option<&'a Signal>,
    /// The values that it shows; none shows all of them.
    pub values: Option<[f64; 2]>,
}

/// A curve of a plot.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// What it shows.
    pub signal: &'a Signal,
    /// It is switched on.
    pub on: bool,
    /// A person added it.
    pub added: bool,
    /// What its SI values are multiplied by.
    pub times: f64,
}

impl Curve<'_> {
    /// The unit of its values.
    pub fn unit(&self) -> String {
        match (self.times == 1.0, self.signal.unit) {
            (_, "1") => String::new(),
            (true, unit) => unit.into(),
            (false, unit) => format!("m{unit}"),
        }
    }
}

impl<'a> Plot<'a> {
    fn of(name: &str, chart: Chart, own: bool, changes: &Changes, signals: &'a [Signal]) -> Self {
        let find = |path: &String| signals.iter().find(|signal| signal.path == *path);
        let held = signals.iter().filter(|signal| chart.holds(signal)).map(|signal| (signal, false));
        let added = changes.added.iter().filter_map(find).filter(|signal| !chart.holds(signal));
        let curves: Vec<Curve<'a>> = held
            .chain(added.map(|signal| (signal, true)))
            .map(|(signal, added)| Curve {
                signal,
                on: !changes.off.contains(&signal.path),
                added,
                times: if !added || matches!(signal.unit, "m" | "rad") { chart.times } else { 1.0 },
            })
            .collect();
        let against = changes.against.as_ref().and_then(find);
        let mut title = match curves.first() {
            Some(first) if own => capital(&first.signal.label),
            _ => chart.title.to_owned(),
        };
        if own && curves.len() > 1 {
            title += " …";
        }
        Self { name: name.into(), title, chart, own, curves, against, values: changes.values }
    }

    /// What stands above it.
    pub fn heading(&self) -> String {
        match self.against {
            Some(across) => format!("{} against {}", self.title, across.symbol),
            None => self.title.clone(),
        }
    }

    /// The curves that are switched on.
    pub fn shown(&self) -> impl Iterator<Item = &Curve<'a>> {
        self.curves.iter().filter(|curve| curve.on)
    }

    /// The units of its values, each once.
    pub fn unit(&self) -> String {
        if !self.own && !self.curves.iter().any(|curve| curve.added) {
            return self.chart.unit.into();
        }
        let mut units: Vec<String> = Vec::new();
        for unit in self.curves.iter().map(Curve::unit) {
            if !units.contains(&unit) && !unit.is_empty() {
                units.push(unit);
            }
        }
        units.join(", ")
    }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
