//! Force transmission of parallelograms, and the distance to the next change point.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | \|sin(q_k − q_l)\| | transmission of a pair of drives: 0 at a change point, where parallelograms lie flat | |
//! | angle | between neighbouring bars of a parallelogram, 0 to π/2 | rad |
//! | distance | least \|q_k − q_l − mπ\| over pairs and integers m: the angle that one drive has to turn | rad |

use std::f64::consts::PI;

use super::pins::Pin;
use super::tree::{CutClosure, TreeLink};
use crate::machine::Inertia;
use crate::planar::{PerDrive, UnitVectors, cross};

/// A parallelogram: a loop whose links follow two drives.
#[derive(Clone, Debug, PartialEq)]
pub struct Parallelogram {
    /// Name of the pin that closes it.
    pub name: String,
    /// Indices of its drives, from 0.
    pub drives: (usize, usize),
}

impl Parallelogram {
    /// Returns the transmission angle between its neighbouring bars, 0 to π/2, rad.
    pub fn angle(&self, q: &[f64]) -> f64 {
        from_multiple_of_pi(q[self.drives.0] - q[self.drives.1]).abs()
    }
}

/// Distance of a pair of drives from a change point, where the two arms are parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangePointDistance {
    /// Indices of the drives, from 0.
    pub drives: (usize, usize),
    /// |q_k − q_l − mπ|, rad.
    pub distance: f64,
    /// Time to the change point at the present rates, s; `None` if the rates are equal or lead away from it.
    pub time: Option<f64>,
}

/// Returns |sin(q_k − q_l)|.
pub fn pair_transmission(e: &UnitVectors, k: usize, l: usize) -> f64 {
    cross(e[k], e[l]).abs()
}

/// Returns an angle minus the nearest multiple of π, −π/2 to π/2, rad.
fn from_multiple_of_pi(angle: f64) -> f64 {
    angle - PI * (angle / PI).round()
}

/// Returns the change point with the smallest distance over all pairs; `None` for a machine with one drive.
pub fn nearest_change_point(q: &[f64], qd: &PerDrive) -> Option<ChangePointDistance> {
    let all = Inertia::pairs(q.len()).map(|(k, l)| {
        let (past, rate) = (from_multiple_of_pi(q[k] - q[l]), qd[k] - qd[l]);
        ChangePointDistance { drives: (k, l), distance: past.abs(), time: arrival(-past, rate) }
    });
    all.min_by(|a, b| a.distance.total_cmp(&b.distance))
}

/// Returns the change point that is reached first at the present rates; its distance is measured in the direction of
/// motion. `None` if all drives turn at the same rate.
pub fn next_change_point(q: &[f64], qd: &PerDrive) -> Option<ChangePointDistance> {
    let all = Inertia::pairs(q.len()).filter_map(|(k, l)| {
        let (past, rate) = (from_multiple_of_pi(q[k] - q[l]), qd[k] - qd[l]);
        // The pair turns towards the nearest multiple of π, or away from it to the next one.
        let way = if past * rate <= 0.0 { -past } else { PI.copysign(rate) - past };
        let time = arrival(way, rate)?;
        Some(ChangePointDistance { drives: (k, l), distance: way.abs(), time: Some(time) })
    });
    all.min_by(|a, b| a.time.unwrap_or(0.0).total_cmp(&b.time.unwrap_or(0.0)))
}

/// Returns the time, s, in which a rate, rad/s, covers the angle `way`, rad; `None` if it never does.
fn arrival(way: f64, rate: f64) -> Option<f64> {
    let time = way / rate;
    (rate != 0.0 && time >= 0.0 && time.is_finite()).then_some(time)
}

/// Returns the closures of loops whose links follow two drives.
pub(super) fn parallelograms(pins: &[Pin], links: &[TreeLink], closures: &[CutClosure]) -> Vec<Parallelogram> {
    let of = |(pin, closure): (&Pin, &CutClosure)| {
        let mut drives: Vec<usize> = closure.levers.iter().map(|(j, _)| links[*j].drive).collect();
        drives.sort_unstable();
        drives.dedup();
        let [k, l] = drives[..] else { return None };
        Some(Parallelogram { name: pin.name.clone(), drives: (k, l) })
    };
    pins.iter().zip(closures).filter_map(of).collect()
}
