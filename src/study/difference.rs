//! [`TableDifference`]: two tables of signals, compared signal by signal.
//!
//! The tables are compared at the instants of the one with fewer rows, within the time that both cover. An instant that
//! the other table has, to a nanosecond, is compared number by number; at another one its values are interpolated
//! linearly, and a signal that is only 0 or 1 has both values of the step in which it switches. Two values that are no
//! number are equal. Tables that cover different times differ; where a tolerance is given, up to a row of the coarser one
//! may be missing at the start and at the end.

use stillbase_settings::number::{at_most_digits, counted};
use stillbase_simulation::signal_table::{SignalColumn, SignalTable};
use stillbase_simulation::signals::is_name_of;

/// Instants within this time of each other are the same, s: recordings count nanoseconds.
pub const SAME_INSTANT_S: f64 = 1.5e-9;

/// Largest difference that is told in units in the last place: beyond it the numbers themselves say more.
const MAX_UNITS: u64 = 1_000_000;

/// Largest permitted differences.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tolerances {
    /// For all signals without one of their own, absolute, in the signal's unit.
    pub all: f64,
    /// For all signals besides, relative to the largest absolute value of the signal in either table.
    pub relative: f64,
    /// For signals by path, or by the first part of their path; absolute. The last that fits counts.
    pub named: Vec<(String, f64)>,
}

impl Tolerances {
    /// Returns whether any difference is permitted.
    fn permit_any(&self) -> bool {
        self.all > 0.0 || self.relative > 0.0 || self.named.iter().any(|(_, tolerance)| *tolerance > 0.0)
    }

    /// Returns the largest permitted difference of a signal, in its unit, if its largest absolute value is `size`.
    fn of(&self, path: &str, size: f64) -> f64 {
        let own = self.named.iter().rev().find(|(name, _)| is_name_of(name, path));
        own.map_or_else(|| self.all.max(self.relative * size), |(_, tolerance)| *tolerance)
    }
}

/// The difference between two tables of signals, the first and the second.
#[derive(Clone, Debug, PartialEq)]
pub struct TableDifference {
    /// First time of each table, s.
    pub starts: [f64; 2],
    /// Last time of each table, s.
    pub ends: [f64; 2],
    /// Largest permitted difference of the starts, and of the ends, s.
    pub time_tolerance: f64,
    /// Number of rows of each table.
    pub rows: [usize; 2],
    /// Interval of time in which both have values, s; `None` if there is none.
    pub overlap: Option<[f64; 2]>,
    /// Number of compared instants.
    pub instants: usize,
    /// Number of these at which the values of one table are interpolated.
    pub interpolated: usize,
    /// The signals that both have, in the order of the first table.
    pub signals: Vec<SignalDifference>,
    /// Paths of the signals that only the first or only the second table has.
    pub unmatched: [Vec<String>; 2],
    /// Signals whose units differ: path, and the two units. Their values are not compared.
    pub units: Vec<(String, [String; 2])>,
}

/// The difference of one signal.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalDifference {
    /// Path of the signal.
    pub path: String,
    /// Its unit.
    pub unit: String,
    /// Largest absolute value in either table, in the signal's unit.
    pub size: f64,
    /// Largest permitted difference, in the signal's unit.
    pub tolerance: f64,
    /// Where the difference is largest.
    pub largest: Departure,
    /// Where it exceeds the tolerance first; `None` if it never does.
    pub first: Option<Departure>,
}

/// The values of a signal at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    /// The instant, s.
    pub time: f64,
    /// The values in the first and the second table, in the signal's unit.
    pub values: [f64; 2],
}

impl Departure {
    /// Returns the absolute difference of the values; 0 if both are equal or neither is a number, and infinite if just one
    /// of them is a number.
    pub fn size(&self) -> f64 {
        let [a, b] = self.values;
        match (a.is_nan(), b.is_nan()) {
            (true, true) => 0.0,
            (false, false) if a == b => 0.0,
            (false, false) => (a - b).abs(),
            _ => f64::INFINITY,
        }
    }

    /// Returns by how many units in the last place the values differ: the number of floating-point numbers from one to
    /// the other; `None` if one of them is no number.
    pub fn units_in_the_last_place(&self) -> Option<u64> {
        let [a, b] = self.values;
        (!a.is_nan() && !b.is_nan()).then(|| rank(a).abs_diff(rank(b)))
    }
}

/// Returns the place of a number among all floating-point numbers, from 0; both zeros have one place.
fn rank(x: f64) -> i64 {
    let bits = (x + 0.0).to_bits() as i64;
    if bits < 0 { i64::MIN - bits } else { bits }
}

impl TableDifference {
    /// Compares two tables.
    pub fn between(first: &SignalTable, second: &SignalTable, tolerances: &Tolerances) -> Self {
        let tables = [first, second];
        let starts = tables.map(|table| table.time.first().copied().unwrap_or(f64::NAN));
        let ends = tables.map(|table| table.time.last().copied().unwrap_or(f64::NAN));
        let instants = Instants::of(tables);
        let interpolated = instants.rows.iter().filter(|[a, b]| !(a.is_exact() && b.is_exact())).count();
        let (mut signals, mut units) = (Vec::new(), Vec::new());
        for a in &first.columns {
            let Some(b) = second.column(&a.path) else { continue };
            // A table may leave out a unit.
            match a.unit == b.unit || a.unit.is_empty() || b.unit.is_empty() {
                true => signals.extend(instants.compare([a, b], tolerances)),
                false => units.push((a.path.clone(), [a.unit.clone(), b.unit.clone()])),
            }
        }
        let only = |own: &SignalTable, other: &SignalTable| {
            let missing = own.columns.iter().filter(|column| other.column(&column.path).is_none());
            missing.map(|column| column.path.clone()).collect()
        };
        let unmatched = [only(first, second), only(second, first)];
        let (overlap, count) = (instants.overlap, instants.rows.len());
        let rows = tables.map(|table| table.time.len());
        let row = |table: &SignalTable| table.time.windows(2).map(|two| two[1] - two[0]).fold(0.0, f64::max);
        let time_tolerance = match tolerances.permit_any() {
            true => SAME_INSTANT_S + tables.map(row).into_iter().fold(0.0, f64::max),
            false => SAME_INSTANT_S,
        };
        let instants = count;
        Self { starts, ends, time_tolerance, rows, overlap, instants, interpolated, signals, unmatched, units }
    }

    /// Returns whether the tables have the same signals over the same time, with no difference beyond its tolerance.
    pub fn is_within(&self) -> bool {
        self.has_same_ends() == [true; 2]
            && self.overlap.is_some()
            && self.unmatched.iter().all(Vec::is_empty)
            && self.units.is_empty()
            && self.signals.iter().all(|signal| signal.first.is_none())
    }

    /// Returns whether both tables start, and whether both end, at the same instant within the tolerance.
    pub fn has_same_ends(&self) -> [bool; 2] {
        [self.starts, self.ends].map(|[a, b]| (a - b).abs() <= self.time_tolerance)
    }

    /// Returns whether both cover the same time, and every number that was compared is equal.
    pub fn is_equal(&self) -> bool {
        [self.starts, self.ends].into_iter().all(is_same)
            && self.is_within()
            && self.signals.iter().all(|signal| signal.largest.size() == 0.0)
    }

    /// Returns the signal that exceeds its tolerance first; of several, the one that comes first in the tables.
    pub fn first(&self) -> Option<(&SignalDifference, &Departure)> {
        let all = self.signals.iter().filter_map(|signal| signal.first.as_ref().map(|first| (signal, first)));
        all.reduce(|before, next| if next.1.time < before.1.time { next } else { before })
    }

    /// Returns what the comparison found, in words that begin with a name, if there is one.
    pub fn sentence(&self, name: &str) -> String {
        let of = if name.is_empty() { String::new() } else { format!("{name}: ") };
        if self.overlap.is_none() {
            let [[a, b], [c, d]] = [self.starts, self.ends].map(|both| both.map(|t| at_most_digits(t, 9)));
            return format!("{of}no instant that both have: the first has {a} to {c} s, the second {b} to {d} s");
        }
        let (signals, instants) = (counted(self.signals.len(), "signal"), counted(self.instants, "instant"));
        let between = match self.interpolated {
            0 => String::new(),
            count => format!(", {count} of them interpolated"),
        };
        let mut found = Vec::new();
        if let Some((signal, first)) = self.first() {
            let count = self.signals.iter().filter(|signal| signal.first.is_some()).count();
            let ulps = match first.units_in_the_last_place() {
                Some(ulps) if ulps <= MAX_UNITS => format!(", by {}", counted(ulps, "unit")) + " in the last place",
                _ => String::new(),
            };
            let [a, b] = first.values;
            let unit = if signal.unit == "1" { String::new() } else { format!(" {}", signal.unit) };
            found.push(format!(
                "{count} of {signals} differ at {instants}{between}; the first is {} at {} s: {a:?} and {b:?}{unit}{ulps}",
                signal.path,
                at_most_digits(first.time, 9),
            ));
        }
        for ((word, both), is_same) in
            [("starts", self.starts), ("ends", self.ends)].into_iter().zip(self.has_same_ends())
        {
            if !is_same {
                let [a, b] = both.map(|t| at_most_digits(t, 9));
                found.push(format!("the first {word} at {a} s, the second at {b} s"));
            }
        }
        for (place, paths) in ["first", "second"].iter().zip(&self.unmatched) {
            if let Some(path) = paths.first() {
                found.push(format!("only the {place} has {path}{}", others(paths.len())));
            }
        }
        if let Some((path, [a, b])) = self.units.first() {
            found.push(format!("{path} is in {a} and in {b}{}", others(self.units.len())));
        }
        let how = if self.is_equal() { "equal" } else { "within tolerance" };
        let [a, b] = self.rows;
        let rows = if a == b { String::new() } else { format!(", of {a} and {b} rows") };
        match found.is_empty() {
            true => format!("{of}{how}: {signals} at {instants}{between}{rows}"),
            false => format!("{of}{}", found.join("; ")),
        }
    }
}

fn others(count: usize) -> String {
    match count {
        0 | 1 => String::new(),
        count => format!(" and {} more", count - 1),
    }
}

/// Returns whether two instants are the same.
fn is_same([a, b]: [f64; 2]) -> bool {
    (a - b).abs() <= SAME_INSTANT_S
}

/// A place between the rows of a table.
#[derive(Clone, Copy, Debug)]
struct Between {
    /// The row before it.
    row: usize,
    /// The share of the next row, from 0 to 1.
    share: f64,
}

impl Between {
    fn is_exact(self) -> bool {
        self.share == 0.0
    }

    fn value(self, values: &[f64]) -> f64 {
        let from = values[self.row];
        match self.is_exact() {
            true => from,
            false => from + self.share * (values[self.row + 1] - from),
        }
    }
}

/// The instants at which two tables are compared.
struct Instants {
    overlap: Option<[f64; 2]>,
    /// Time of each instant, s.
    time: Vec<f64>,
    /// Its place in each table.
    rows: Vec<[Between; 2]>,
}

impl Instants {
    fn of(tables: [&SignalTable; 2]) -> Self {
        let none = Self { overlap: None, time: Vec::new(), rows: Vec::new() };
        let [Some([a, b]), Some([c, d])] = tables.map(|t| Some([*t.time.first()?, *t.time.last()?])) else {
            return none;
        };
        let overlap = [a.max(c), b.min(d)];
        if overlap[0] > overlap[1] + SAME_INSTANT_S {
            return none;
        }
        let inside = |time: f64| time >= overlap[0] - SAME_INSTANT_S && time <= overlap[1] + SAME_INSTANT_S;
        let counts = tables.map(|table| table.time.iter().filter(|time| inside(**time)).count());
        let coarse = usize::from(counts[1] < counts[0]);
        let other = &tables[1 - coarse].time;
        let (mut time, mut rows, mut next) = (Vec::new(), Vec::new(), 0);
        for (row, t) in tables[coarse].time.iter().enumerate().filter(|(_, t)| inside(**t)) {
            while next + 1 < other.len() && other[next + 1] <= t + SAME_INSTANT_S {
                next += 1;
            }
            let step = other.get(next + 1).map_or(0.0, |after| after - other[next]);
            let since = t - other[next];
            let share = if since.abs() <= SAME_INSTANT_S || step <= 0.0 { 0.0 } else { (since / step).clamp(0.0, 1.0) };
            let (own, there) = (Between { row, share: 0.0 }, Between { row: next, share });
            time.push(*t);
            rows.push(if coarse == 0 { [own, there] } else { [there, own] });
        }
        Self { overlap: Some(overlap), time, rows }
    }

    /// Compares a signal; `None` if there is no instant.
    fn compare(&self, columns: [&SignalColumn; 2], tolerances: &Tolerances) -> Option<SignalDifference> {
        let values = || columns.iter().flat_map(|column| &column.values);
        let size = values().filter(|x| x.is_finite()).fold(0.0_f64, |most, x| most.max(x.abs()));
        let is_switch = values().all(|x| [0.0, 1.0].contains(x));
        let tolerance = tolerances.of(&columns[0].path, size);
        let departures = self.time.iter().zip(&self.rows).map(|(time, places)| {
            let [a, b] = places;
            let mut both = [a.value(&columns[0].values), b.value(&columns[1].values)];
            if is_switch {
                for (i, place) in places.iter().enumerate().filter(|(_, place)| !place.is_exact()) {
                    let [from, to] = [0, 1].map(|after| columns[i].values[place.row + after]);
                    both[i] = if to == both[1 - i] { to } else { from };
                }
            }
            Departure { time: *time, values: both }
        });
        let (mut largest, mut first) = (None::<Departure>, None);
        for departure in departures {
            if largest.is_none_or(|largest| departure.size() > largest.size()) {
                largest = Some(departure);
            }
            if first.is_none() && departure.size() > tolerance {
                first = Some(departure);
            }
        }
        let (path, unit) = (columns[0].path.clone(), columns[0].unit.clone());
        Some(SignalDifference { path, unit, size, tolerance, largest: largest?, first })
    }
}
