//! [`TurnMap`]: what the end effector reaches along straight rays from a pose at zero angular momentum, and as a free base
//! turns by at most given angles.
//!
//! Another path to a point may lead farther, or less far: with zero momentum the pose at a point depends on the path. Of
//! all motions along a ray the map takes the one of least momentum at every point.

use std::f64::consts::TAU;

use schemars::JsonSchema;
use serde::Serialize;

use stillbase_mechanics::machine::RelativeAngle;
use stillbase_mechanics::planar::{Vector, cross, unit};
use stillbase_planning::off_plane::drift::Singularity;
use stillbase_planning::off_plane::rays::{RayEnd, RayStop, Rays};
use stillbase_query::ProgressCallback;

/// Turns of the base, °, that a map has if none are given.
const TURN_LIMITS: [f64; 5] = [0.0, 0.5, 1.0, 2.0, 5.0];

/// Returns the turns of a map for a base that floats, or does not, °.
pub fn turn_limits(floats: bool) -> &'static [f64] {
    if floats { &TURN_LIMITS } else { &TURN_LIMITS[..1] }
}

/// Number of directions that every map has.
const DIRECTIONS: usize = 180;
/// Neighbouring rays of lengths that differ by more than this fraction of the reach have another one between them.
const GAP: f64 = 0.02;
/// Maximum number of times that the angle between two directions is halved.
const HALVINGS: u32 = 5;

/// Areas that the end effector reaches along straight rays from a pose.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct TurnMap {
    /// Drive angles at the start, rad.
    pub q_start: Vec<f64>,
    /// The end effector there, m.
    pub tip_start: [f64; 2],
    /// Angles by which the base may turn, °, rising.
    pub turn_limits: Vec<f64>,
    /// Area within each, m².
    pub areas: Vec<f64>,
    /// Rays counter-clockwise, from the x axis.
    pub rays: Vec<TurnRay>,
}

/// A ray of a [`TurnMap`].
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct TurnRay {
    /// Its direction, rad.
    pub direction: f64,
    /// How far it leads within each turn limit, m.
    pub reaches: Vec<f64>,
    /// Why it leads no farther.
    pub stops: Vec<String>,
}

/// Word for the end of a ray at a dynamic singularity.
const DYNAMIC: &str = "dynamic singularity";

impl TurnMap {
    /// Follows rays within turn limits, °, in rising order. `goes_on` is called with the completed fraction; returns
    /// `None` if it returns false.
    pub fn of(rays: &Rays, limits: &[f64], goes_on: ProgressCallback<'_>) -> Option<Self> {
        let turns: Vec<f64> = limits.iter().map(|limit| limit.to_radians()).collect();
        let ends = |direction: f64| rays.ends(unit(direction), &turns);
        let gap = GAP * rays.model().reach();
        let mut found: Vec<(f64, Vec<RayEnd>)> = Vec::with_capacity(2 * DIRECTIONS);
        let mut last = (0.0, ends(0.0));
        for i in 1..=DIRECTIONS {
            if !goes_on(i as f64 / DIRECTIONS as f64) {
                return None;
            }
            let direction = TAU * i as f64 / DIRECTIONS as f64;
            let next = (direction, if i == DIRECTIONS { found[0].1.clone() } else { ends(direction) });
            // Directions still to come, the nearest last, each with the number of halvings before it.
            let mut ahead = vec![(next, 0)];
            found.push(last.clone());
            while let Some((next, halvings)) = ahead.pop() {
                let apart = last.1.iter().zip(&next.1).any(|(a, b)| (a.distance - b.distance).abs() > gap);
                if apart && halvings < HALVINGS {
                    let middle = 0.5 * (last.0 + next.0);
                    ahead.push((next, halvings + 1));
                    ahead.push(((middle, ends(middle)), halvings + 1));
                    continue;
                }
                if !ahead.is_empty() {
                    found.push(next.clone());
                }
                last = next;
            }
        }
        let q = rays.start();
        let from = rays.model().place(q);
        let ray = |(direction, ends): &(f64, Vec<RayEnd>)| TurnRay {
            direction: *direction,
            reaches: ends.iter().map(|end| end.distance).collect(),
            stops: ends.iter().map(|end| in_words(end.stop, rays.angles())).collect(),
        };
        let mut map = Self {
            q_start: q.to_vec(),
            tip_start: [from.re, from.im],
            turn_limits: limits.to_vec(),
            areas: Vec::new(),
            rays: found.iter().map(ray).collect(),
        };
        map.areas = (0..limits.len()).map(|i| area(&map.outline(i))).collect();
        Some(map)
    }

    /// Returns the curves where rays meet dynamic singularities at zero momentum, m: arcs of the outline of what it reaches.
    pub fn singular_curves(&self) -> Vec<Vec<Vector>> {
        let outline = self.outline(0);
        let is_singular = |ray: &TurnRay| ray.stops.first().is_some_and(|stop| stop == DYNAMIC);
        let Some(first) = self.rays.iter().position(|ray| !is_singular(ray)) else {
            return vec![outline.iter().chain(outline.first()).copied().collect()];
        };
        // From a ray that ends otherwise, once around.
        let n = self.rays.len();
        let around: Vec<usize> = (first..=first + n).map(|i| i % n).collect();
        let arcs = around.split(|i| !is_singular(&self.rays[*i])).filter(|arc| arc.len() > 1);
        arcs.map(|arc| arc.iter().map(|i| outline[*i]).collect()).collect()
    }

    /// Returns the outline of what is reached within turn limit `i`, m.
    pub fn outline(&self, i: usize) -> Vec<Vector> {
        let from = Vector::new(self.tip_start[0], self.tip_start[1]);
        self.rays.iter().map(|ray| from + ray.reaches[i] * unit(ray.direction)).collect()
    }
}

/// Returns the area that a closed line encloses, m², counter-clockwise.
fn area(outline: &[Vector]) -> f64 {
    let Some(first) = outline.first() else { return 0.0 };
    let ends = outline.iter().zip(outline.iter().skip(1).chain([first]));
    ends.map(|(a, b)| 0.5 * cross(a - first, b - first)).sum()
}

/// Returns the words for the end of a ray.
fn in_words(stop: RayStop, angles: &[RelativeAngle]) -> String {
    match stop {
        RayStop::Singular(Singularity::Kinematic) => "outstretched or folded".into(),
        RayStop::Singular(Singularity::Dynamic) => DYNAMIC.into(),
        RayStop::Singular(Singularity::Joint) => "singularity of base and arm".into(),
        RayStop::Limit { angle, upper } => {
            let name = angles.get(angle).map_or("angle", |angle| &angle.name);
            format!("{} limit of {name}", if upper { "upper" } else { "lower" })
        }
        RayStop::Turn => "turn of the base".into(),
        RayStop::Winding => "drives turn on and on".into(),
    }
}
