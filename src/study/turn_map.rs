//! [`TurnMap`]: what the end effector reaches along straight rays from a pose at zero angular momentum, and as a free base
//! turns by at most given angles.
//!
//! Another path to a point may lead farther, or less far: with zero momentum the pose at a point depends on the path. Of
//! all motions along a ray the map takes the one of least momentum at every point.

use std::collections::BTreeMap;
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
/// Number of places between two directions that every map has, and of all places where a ray may be.
const FINEST: usize = 1 << HALVINGS;
const PLACES: usize = DIRECTIONS * FINEST;

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
    /// Indices of the rays that each limit needs.
    #[serde(skip)]
    own: Vec<Vec<usize>>,
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
        let direction = |place: usize| TAU * place as f64 / PLACES as f64;
        let gap = GAP * rays.model().reach();
        let mut found: BTreeMap<usize, Vec<RayEnd>> = BTreeMap::new();
        // The rays of each limit do not depend on which others are listed.
        let mut own: Vec<Vec<usize>> = vec![Vec::new(); limits.len()];
        let mut reach = |limit: usize, place: usize| {
            let place = place % PLACES;
            found.entry(place).or_insert_with(|| rays.ends(unit(direction(place)), &turns))[limit].distance
        };
        for i in 0..DIRECTIONS {
            if !goes_on((i + 1) as f64 / DIRECTIONS as f64) {
                return None;
            }
            for (limit, own) in own.iter_mut().enumerate() {
                // Places still to come, the nearest last.
                let (mut last, mut ahead) = (i * FINEST, vec![(i + 1) * FINEST]);
                own.push(last);
                while let Some(next) = ahead.pop() {
                    let apart = (reach(limit, last) - reach(limit, next)).abs() > gap;
                    if apart && next - last > 1 {
                        ahead.extend([next, usize::midpoint(last, next)]);
                        continue;
                    }
                    if !ahead.is_empty() {
                        own.push(next);
                    }
                    last = next;
                }
            }
        }
        let places: Vec<usize> = found.keys().copied().collect();
        let index = |place: &usize| places.binary_search(place).unwrap_or_default();
        let q = rays.start();
        let from = rays.model().place(q);
        let ray = |(place, ends): (&usize, &Vec<RayEnd>)| TurnRay {
            direction: direction(*place),
            reaches: ends.iter().map(|end| end.distance).collect(),
            stops: ends.iter().map(|end| in_words(end.stop, rays.angles())).collect(),
        };
        let mut map = Self {
            q_start: q.to_vec(),
            tip_start: [from.re, from.im],
            turn_limits: limits.to_vec(),
            areas: Vec::new(),
            rays: found.iter().map(ray).collect(),
            own: own.iter().map(|own| own.iter().map(index).collect()).collect(),
        };
        map.areas = (0..limits.len()).map(|i| area(&map.outline(i))).collect();
        Some(map)
    }

    /// Returns the curves where rays meet dynamic singularities at zero momentum, m: arcs of the outline of what it reaches.
    pub fn singular_curves(&self) -> Vec<Vec<Vector>> {
        let outline = self.outline(0);
        let is_singular: Vec<bool> =
            self.rays_of(0).map(|ray| ray.stops.first().is_some_and(|stop| stop == DYNAMIC)).collect();
        let Some(first) = is_singular.iter().position(|is_singular| !is_singular) else {
            return vec![outline.iter().chain(outline.first()).copied().collect()];
        };
        // From a ray that ends otherwise, once around.
        let n = outline.len();
        let around: Vec<usize> = (first..=first + n).map(|i| i % n).collect();
        let arcs = around.split(|i| !is_singular[*i]).filter(|arc| arc.len() > 1);
        arcs.map(|arc| arc.iter().map(|i| outline[*i]).collect()).collect()
    }

    /// Returns the outline of what is reached within turn limit `i`, m.
    pub fn outline(&self, i: usize) -> Vec<Vector> {
        self.rays_of(i).map(|ray| self.end(i, ray)).collect()
    }

    /// Returns where a ray ends within turn limit `i`, m.
    pub fn end(&self, i: usize, ray: &TurnRay) -> Vector {
        let [x, y] = self.tip_start;
        Vector::new(x, y) + ray.reaches[i] * unit(ray.direction)
    }

    /// Returns the rays that turn limit `i` needs: more where its ends lie far apart.
    pub fn rays_of(&self, i: usize) -> impl Iterator<Item = &TurnRay> {
        self.own[i].iter().map(|ray| &self.rays[*ray])
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
