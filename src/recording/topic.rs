//! Topics: signals that share an entity. Each row of an entity has an identifier and two times, which take 18 bytes in
//! the file, while a value takes 8. The signals of one entity share identifier and times.

use crate::rerun::components::Text;
use crate::rerun::{AnyValues, EntityPath, Scalars, SeriesLines};

use super::store::{RowTimes, Store, StoreError};
use super::style::{CombinedArchetypes, colour, series_name, under};
use stillbase_files::recorded::{PATHS, UNITS};
use stillbase_picture::charts::{self, Chart};
use stillbase_picture::scene::palette::{Palette, faded};
use stillbase_session::WholeFrame;
use stillbase_simulation::frame::Peaks;
use stillbase_simulation::signals::Signal;

/// Entities of several groups of signals. Any other group is a separate entity with its own name. A signal that is
/// compared between cases is a separate entity too, because a legend names all series of an entity, even hidden ones.
const TOPICS: [(&str, &[&str]); 4] = [
    ("drives", &["torque", "friction", "angle", "reference", "error", "rate", "acceleration", "joint", "pose"]),
    (
        "reaction",
        &["moment", "force", "tilt", "momentum", "angular_momentum", "impulse", "angular_impulse", "reactionless"],
    ),
    (
        "motion",
        &[
            "com",
            "tip",
            "target",
            "base",
            "base_velocity",
            "attitude",
            "attitude_rate",
            "wheel",
            "wheel_saturated",
            "payload",
        ],
    ),
    ("inside", &["pin", "transmission", "change_point", "dexterity", "torque_per_force", "energy", "audit"]),
];

/// Width of the line of a limit, points.
const LIMIT_WIDTH: f32 = 0.8;

/// Signals of one entity, and their values at the steps that are not yet written.
#[derive(Clone, Debug)]
pub struct Topic {
    /// Name of the entity under `signals`.
    pub name: String,
    /// Signals of the entity, in the order of the table of signals.
    pub signals: Vec<Signal>,
    /// Limits that are recorded beside the signals: the index of the signal, and the largest permitted absolute value.
    pub limits: Vec<(usize, f64)>,
    /// Buffered values, row by row.
    values: Vec<f64>,
}

/// Returns the path of a signal of an assembly without the name of its drive or axis.
fn without_last(path: &str) -> &str {
    let cut = |at: char| path.rsplit_once(at).map(|(kind, _)| kind);
    cut('.').or_else(|| cut('_')).or_else(|| cut('/')).unwrap_or(path)
}

impl Topic {
    /// Groups all signals by topic. Of an assembly, signals of one block and kind are a topic: each has a plot of its own.
    pub fn all(signals: Vec<Signal>, charts: &[Chart], is_of_assembly: bool) -> Vec<Self> {
        let mut topics: Vec<Self> = Vec::new();
        for signal in signals {
            let group = signal.group();
            let group = if group.starts_with("audit_") { "audit" } else { group };
            let of = TOPICS.iter().find(|(_, groups)| groups.contains(&group));
            let is_compared = charts.iter().any(|chart| chart.is_overlaid && chart.signals[0] == signal.path);
            let name = match is_of_assembly {
                true => without_last(&signal.path),
                false if is_compared => &signal.path,
                false => of.map_or(group, |(name, _)| name),
            };
            let name = name.to_owned();
            match topics.iter_mut().find(|topic| topic.name == name) {
                Some(topic) => topic.signals.push(signal),
                None => topics.push(Self { name, signals: vec![signal], limits: Vec::new(), values: Vec::new() }),
            }
        }
        topics
    }

    /// Returns the path of the entity in the recording.
    pub fn path(&self, root: &EntityPath) -> EntityPath {
        under(root, &format!("signals/{}", self.name))
    }

    /// Writes names, colours and widths of the series.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn style(
        &self,
        store: &mut Store,
        root: &EntityPath,
        palette: &Palette,
        peaks: &Peaks,
    ) -> Result<(), StoreError> {
        let words =
            |of: fn(&Signal) -> &str| self.signals.iter().map(|signal| Text::from(of(signal))).collect::<Vec<_>>();
        let names = AnyValues::default()
            .with_component::<Text>(PATHS, words(|signal| &signal.path))
            .with_component::<Text>(UNITS, words(|signal| signal.unit));
        let is_reference = |signal: &Signal| signal.group() == "reference" || signal.path == "pose/b_reference";
        let width = |signal: &Signal| if is_reference(signal) { 0.8 } else { 1.6 };
        let style = SeriesLines::new()
            .with_names(self.signals.iter().map(series_name))
            .with_colors(self.signals.iter().map(|signal| colour(charts::colour(signal, palette, peaks))))
            .with_widths(self.signals.iter().map(width));
        store.fixed(&self.path(root), &CombinedArchetypes(&[&names, &style]))
    }

    /// Returns the path of the entity of the limits in the recording.
    pub fn limits_path(&self, root: &EntityPath) -> EntityPath {
        under(&self.path(root), "limits")
    }

    /// Writes names, colours and widths of the limits, two series each: at plus and at minus the limit.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn style_limits(
        &self,
        store: &mut Store,
        root: &EntityPath,
        palette: &Palette,
        peaks: &Peaks,
    ) -> Result<(), StoreError> {
        if self.limits.is_empty() {
            return Ok(());
        }
        let twice = || self.limits.iter().flat_map(|(i, _)| [&self.signals[*i]; 2]);
        let style = SeriesLines::new()
            .with_names(twice().map(|signal| format!("limit of {}", series_name(signal))))
            .with_colors(twice().map(|signal| colour(faded(charts::colour(signal, palette, peaks), 0.6))))
            .with_widths(twice().map(|_| LIMIT_WIDTH));
        store.fixed(&self.limits_path(root), &style)
    }

    /// Writes the limits at the instants of a clock: the first and the last of the run.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write_limits(&self, store: &mut Store, root: &EntityPath, clock: &RowTimes) -> Result<(), StoreError> {
        if self.limits.is_empty() {
            return Ok(());
        }
        let row = || self.limits.iter().flat_map(|(_, limit)| [*limit, -limit]);
        let rows = Scalars::new((0..clock.len()).flat_map(|_| row()));
        let rows = rows.columns(std::iter::repeat_n(2 * self.limits.len(), clock.len()))?;
        store.columns(&clock.columns(), &self.limits_path(root), rows)
    }

    /// Adds a row with the values of an instant.
    pub fn push(&mut self, whole: &WholeFrame<'_>) {
        self.values.extend(self.signals.iter().map(|signal| whole.value(signal)));
    }

    /// Writes the buffered rows at the instants of a clock.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, store: &mut Store, root: &EntityPath, clock: &RowTimes) -> Result<(), StoreError> {
        let rows = Scalars::new(std::mem::take(&mut self.values));
        let rows = rows.columns(std::iter::repeat_n(self.signals.len(), clock.len()))?;
        store.columns(&clock.columns(), &self.path(root), rows)
    }
}
