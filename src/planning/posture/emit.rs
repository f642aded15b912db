//! A path through the poses at all stations, with its derivatives, its errors and its objective values.

use super::goal::{WeightMatrix, times};
use super::refine::AngleBound;
use super::rows::PoseConstraint;
use super::stations::{GAUSS_NODES, PathLeg, Stations, weights};
use crate::curves::{PathPoint, PathTable};
use stillbase_mechanics::planar::{PerDrive, Vector};

/// Number of samples per interval at which limits are checked.
const LIMIT_SAMPLES: usize = 4;
/// Number of Newton steps from a sample to the extremum beside it.
const PEAK_STEPS: usize = 4;

/// Returns a table for each leg of a path; `None` if the constraint rows are linearly dependent at a pose.
pub(super) fn tables(held: &PoseConstraint<'_>, stations: &Stations, q: &[PerDrive]) -> Option<Vec<PathTable>> {
    stations.legs.iter().map(|leg| table(held, leg, &q[leg.first..=leg.last()])).collect()
}

fn table(held: &PoseConstraint<'_>, leg: &PathLeg, q: &[PerDrive]) -> Option<PathTable> {
    let count = q.len();
    let stencil = count.min(5);
    let nodes = (0..count).map(|i| {
        let from = i.saturating_sub(2).min(count - stencil);
        let w = weights(&leg.s[from..from + stencil], leg.s[i]);
        let sum = |order: usize| {
            (0..stencil).fold(PerDrive::zeros(q[i].len()), |sum, j| sum.plus(w[order][j], &q[from + j].minus(&q[i])))
        };
        let way = &leg.points[i];
        let (first, second) = held.along(&q[i], (&sum(1), &sum(2)), [way.first, way.second])?;
        Some(PathPoint { q: stillbase_mechanics::planar::DriveAngles(q[i]), first, second })
    });
    PathTable::new(leg.s.clone(), nodes.collect::<Option<_>>()?)
}

/// Returns the distance of paths from their curves between stations, m, by leg and interval.
pub(super) fn curve_error(held: &PoseConstraint<'_>, stations: &Stations, tables: &[PathTable]) -> Vec<Vec<f64>> {
    let off = |table: &PathTable, (s, p): &(f64, Vector)| (held.space.end_effector(&table.at(*s).q) - p).norm();
    let legs = stations.legs.iter().zip(tables);
    legs.map(|(leg, table)| leg.between.iter().map(|between| off(table, between)).collect()).collect()
}

/// Returns the pose where a relative angle has an extremum in an interval of s, by Newton's method on its derivative.
fn peak(table: &PathTable, bound: &AngleBound, [from, place, to]: [f64; 3]) -> PerDrive {
    let mut s = place;
    for _ in 0..PEAK_STEPS {
        let point = table.at(s);
        let change = bound.row.dot(&point.first) / bound.row.dot(&point.second);
        if change.is_finite() {
            s = (s - change).clamp(from, to);
        }
    }
    table.at(s).q.0
}

/// Returns for each limited angle the maximum distance beyond its limits, rad; negative inside.
pub(super) fn limit_excess(bounds: &[AngleBound], stations: &Stations, tables: &[PathTable]) -> Vec<f64> {
    let mut largest = vec![f64::NEG_INFINITY; bounds.len()];
    for (leg, table) in stations.legs.iter().zip(tables) {
        let within = |w: &[f64], k: usize| w[0] + k as f64 / LIMIT_SAMPLES as f64 * (w[1] - w[0]);
        let places = leg.s.windows(2).flat_map(|w| (0..LIMIT_SAMPLES).map(move |k| within(w, k)));
        let samples: Vec<(f64, PerDrive)> = places.chain(leg.s.last().copied()).map(|s| (s, table.at(s).q.0)).collect();
        for (largest, bound) in largest.iter_mut().zip(bounds) {
            let past: Vec<f64> = samples.iter().map(|(_, q)| bound.past(q)).collect();
            *largest = past.iter().copied().fold(*largest, f64::max);
            for (i, w) in past.windows(3).enumerate() {
                // A peak exceeds the sample beside it by less than half of the difference to the neighbours.
                let may = w[1] + 0.5 * (w[1] - w[0].min(w[2]));
                if w[1] >= w[0] && w[1] >= w[2] && may > *largest {
                    let q = peak(table, bound, [samples[i].0, samples[i + 1].0, samples[i + 2].0]);
                    *largest = largest.max(bound.past(&q));
                }
            }
        }
    }
    largest
}

/// Returns ∫ q′ᵀ S q′ ds along all legs, with s proportional to their length.
pub(super) fn rates(stations: &Stations, tables: &[PathTable], weight: &WeightMatrix) -> f64 {
    along(stations, tables, |point| point.first.dot(&times(weight, &point.first)), |share| 1.0 / share)
}

/// Returns the integral of `what` over s along all legs, with s proportional to their length.
pub(super) fn places(stations: &Stations, tables: &[PathTable], what: impl Fn(&PerDrive) -> f64) -> f64 {
    along(stations, tables, |point| what(&point.q.0), |share| share)
}

fn along(
    stations: &Stations,
    tables: &[PathTable],
    what: impl Fn(&PathPoint) -> f64,
    counted: impl Fn(f64) -> f64,
) -> f64 {
    let leg = |(leg, table): (&PathLeg, &PathTable)| {
        let space = |w: &[f64]| {
            let at = |[share, weight]: [f64; 2]| weight * (w[1] - w[0]) * what(&table.at(w[0] + share * (w[1] - w[0])));
            GAUSS_NODES.into_iter().map(at).sum::<f64>()
        };
        counted(leg.share) * leg.s.windows(2).map(space).sum::<f64>()
    };
    stations.legs.iter().zip(tables).map(leg).sum()
}

/// Returns ∫ q̈ᵀ S q̈ dt along all legs for a duration of 1.
pub(super) fn accelerations(stations: &Stations, tables: &[PathTable], weight: &WeightMatrix) -> f64 {
    let leg = |(leg, table): (&PathLeg, &PathTable)| {
        let at = |(_, [s, rate, acceleration, time]): (usize, [f64; 4])| {
            let point = table.at(s);
            let turned = point.second.scaled(rate * rate).plus(acceleration, &point.first);
            time * turned.dot(&times(weight, &turned))
        };
        leg.instants().into_iter().map(at).sum::<f64>()
    };
    stations.legs.iter().zip(tables).map(leg).sum()
}
