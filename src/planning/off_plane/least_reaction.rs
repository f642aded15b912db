//! Leaving the plane with the least base moment: the redundant mode.
//!
//! The end effector's motion p(u), u = t/T, is given. On one sheet q = q(x, y, b), so that only b(u) within its
//! [`Corridor`] is free, and n_B = −D_1 b̈. Minimising ∫ n_B² dt is a quadratic program, minimising the peak of |n_B| a
//! linear one. If a constant b is feasible, it is the solution, and the base moment is zero.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | u | t/T, 0 to 1 | 1 |
//! | b, b′, b″ | pose constant and derivatives by u | rad |
//! | n_B | base moment −D_1 b″/T², with D_1, kg m², from [`Price::inertia`] | N m |
//!
//! b′ = 0 at both ends. In between, n_B is continuous, and linear between equally spaced nodes.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Serialize;
use std::borrow::Cow;
use thiserror::Error;

use crate::curves::curve::CurvePoint;
use crate::curves::path::{PathError, minimum_norm_path};
use crate::curves::table::PathTable;
use crate::off_plane::b_course::{BCourse, BaseReaction};
use crate::off_plane::b_program::{PIECE_STATIONS, least_course};
use crate::off_plane::corridor::{Corridor, CorridorError};
use crate::off_plane::inverse::pose_along;
use crate::off_plane::price::{Price, PriceError};
use crate::reactionless::{LIMIT_SLACK, PlaneMap, PlanePoint, describe_interval};
use stillbase_mechanics::machine::{Chain, Inertia};
use stillbase_mechanics::planar::{DriveAngles, Vector};

/// Default number of pieces of b″.
pub const DEFAULT_PIECES: usize = 96;
/// Maximum number of pieces.
pub const MAX_PIECES: usize = 512;
/// Tolerance of the end effector on its curve between nodes, as a fraction of the arm length.
const CURVE_TOLERANCE: f64 = 1e-10;
/// The same tolerance near a fold, where intervals between nodes are halved to meet it.
const CURVE_TOLERANCE_NEAR_FOLD: f64 = 1e-8;
/// Maximum number of such halvings.
const MAX_HALVINGS: usize = 12;
/// Maximum number of nodes per station.
const MAX_NODES_PER_STATION: usize = 16;
/// Maximum deviation from the curve, as a fraction of the arm length; beyond it the curve counts as not followed.
const MAX_DEVIATION: f64 = 1e-6;

/// Maximum number of solutions b(u) with one margin. If the drives cannot follow one, a station is added to the
/// corridor where b leaves it. After the last solution, or if b does not leave the corridor, the margin grows.
const MAX_CORRIDOR_REFINEMENTS: usize = 4;

/// The objective.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReactionNorm {
    /// Minimises ∫ n_B² dt.
    Rms,
    /// Minimises the peak of |n_B| and, among all motions with that peak, ∫ n_B² dt.
    Peak,
}

/// A motion of the end effector with the least reaction.
#[derive(Clone, Debug)]
pub struct LeastReaction {
    corridor: Corridor,
    course: BCourse,
    path: PathTable,
    inertia: f64,
}

/// Why no motion of least reaction was found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LeastReactionError {
    /// b has no corridor.
    #[error(transparent)]
    Corridor(#[from] CorridorError),
    /// The machine has no b.
    #[error(transparent)]
    Price(#[from] PriceError),
    /// The end effector is not at rest at the start or the end.
    #[error("the end effector moves at u = {u}: want a motion from rest to rest, dp/du = 0 at both ends")]
    NotAtRest {
        /// t/T, 0 or 1.
        u: f64,
    },
    /// The wanted b at the end is outside its corridor.
    #[error("b = {b:.3} rad at the end is outside of its corridor there: want b {} rad", describe_interval(*.low, *.high))]
    EndOutside {
        /// The wanted b, rad.
        b: f64,
        /// Lower bound of the corridor, rad.
        low: f64,
        /// Upper bound of the corridor, rad.
        high: f64,
    },
    /// The convex program has no solution.
    #[error("no smooth course of b stays within its corridor ({solver}): want a shorter motion, or wider joint limits")]
    NoCourse {
        /// The solver's reason.
        solver: String,
    },
    /// The drives cannot follow the course of b.
    #[error("the drives cannot follow the course of b at u = {u:.3}: it comes too near a fold")]
    NotFollowed {
        /// t/T.
        u: f64,
    },
}

impl LeastReaction {
    /// Plans b along a motion of the end effector p(u), u = t/T, that starts from a pose and rests at both ends. `end`
    /// is b at the end, rad, if it is not free.
    ///
    /// # Errors
    /// If the machine has no b, the motion leaves the sheet of the pose or is not at rest at an end, or no course fits.
    pub fn plan(
        map: &PlaneMap,
        model: &Inertia,
        curve: impl Fn(f64) -> CurvePoint,
        start: PlanePoint,
        end: Option<f64>,
        goal: ReactionNorm,
    ) -> Result<Self, LeastReactionError> {
        Self::plan_in(map, model, curve, start, end, goal, DEFAULT_PIECES)
    }

    /// Plans as [`plan`](Self::plan), with a given number of pieces of b″, 2 to [`MAX_PIECES`]. The error falls with
    /// the square of this number.
    ///
    /// # Errors
    /// As [`plan`](Self::plan).
    pub fn plan_in(
        map: &PlaneMap,
        model: &Inertia,
        curve: impl Fn(f64) -> CurvePoint,
        start: PlanePoint,
        end: Option<f64>,
        goal: ReactionNorm,
        spaces: usize,
    ) -> Result<Self, LeastReactionError> {
        let inertia = Price::of(model, 0.0)?.inertia();
        let spaces = spaces.clamp(2, MAX_PIECES);
        let mut corridor = Corridor::along(map, &curve, start, spaces * PIECE_STATIONS)?;
        let stations = corridor.stations();
        let size: f64 = map.c().iter().map(|c| c.abs()).sum();
        for station in [&stations[0], &stations[stations.len() - 1]] {
            if station.point.first.norm() > 1e-9 * size {
                return Err(LeastReactionError::NotAtRest { u: station.u });
            }
            let given = end.filter(|_| station.u == 1.0);
            if let Some(b) = given.filter(|b| !(station.low - LIMIT_SLACK <= *b && *b <= station.high + LIMIT_SLACK)) {
                return Err(LeastReactionError::EndOutside { b, low: station.low, high: station.high });
            }
        }
        let stays = end.is_none_or(|end| end == start.b) && corridor.first_station_outside(start.b).is_none();
        if stays {
            let course = BCourse::constant(start.b);
            if let Ok(path) = followed(&corridor, &curve, &course) {
                return Ok(Self { corridor, course, path, inertia });
            }
        }
        let mut refused = None;
        // If the drives cannot follow close to a fold, increase the margin, which increases the base moment.
        for ease in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, f64::INFINITY] {
            for _ in 0..MAX_CORRIDOR_REFINEMENTS {
                let course = least_course(&corridor, end, goal == ReactionNorm::Peak, spaces, ease)
                    .map_err(|solver| LeastReactionError::NoCourse { solver })?;
                let why = match followed(&corridor, &curve, &course) {
                    Ok(path) => return Ok(Self { corridor, course, path, inertia }),
                    Err(why) => why,
                };
                // If b leaves the corridor between two stations, for example where a fold begins, add a station
                // there.
                let place = match &why {
                    LeastReactionError::NotFollowed { u } => corridor.at(&curve, *u),
                    _ => None,
                };
                refused = Some(why);
                match place.filter(|s| !(s.low..=s.high).contains(&course.at(s.u)[0])) {
                    Some(station) => corridor.add_station(station),
                    None => break,
                }
            }
        }
        Err(refused.unwrap_or(LeastReactionError::NotFollowed { u: 0.0 }))
    }

    /// Returns b over u.
    pub fn course(&self) -> &BCourse {
        &self.course
    }

    /// Returns the path of the drives over u = t/T; rates are q′/T, accelerations q″/T².
    pub fn path(&self) -> &PathTable {
        &self.path
    }

    /// Returns the corridor of b.
    pub fn corridor(&self) -> &Corridor {
        &self.corridor
    }

    /// Returns the base moment for a motion of `duration`, s.
    pub fn reaction(&self, duration: f64) -> BaseReaction {
        self.course.reaction(self.inertia, duration)
    }

    /// Compares the base moments of three ways to make the same motion of the end effector in `duration`, s. `tip` is
    /// the `end_effector` of the planned machine, `curve` the planned curve.
    pub fn compare(&self, tip: &Chain, curve: impl Fn(f64) -> CurvePoint, duration: f64) -> Verdicts {
        let start = self.corridor.start();
        let fixed = match self.corridor.first_station_outside(start.b) {
            None => FixedB::Serves,
            Some(station) => FixedB::Leaves { u: station.u, low: station.low, high: station.high },
        };
        let from = DriveAngles::from(self.corridor.map().lift(start));
        let minimum_norm = minimum_norm_path(tip, from, curve).map(|path| self.assess(&path, duration));
        Verdicts { fixed, minimum_norm, least: self.reaction(duration) }
    }

    /// Returns the base moment of a path in `duration`, s, its final b, and whether it keeps the joint limits.
    fn assess(&self, path: &PathTable, duration: f64) -> MinimumNorm {
        let map = self.corridor.map();
        let scale = self.inertia / (duration * duration);
        let n_b = |u: f64| scale * map.project_rates(&path.at(u).second).1.abs();
        let n = 2048;
        let (mut peak, mut squares) = (0.0_f64, 0.0);
        // Simpson's rule.
        for i in 0..=n {
            let x = n_b(f64::from(i) / f64::from(n));
            let weight = [1.0, 2.0, 4.0][if i == 0 || i == n { 0 } else { 1 + (i % 2) as usize }];
            peak = peak.max(x);
            squares += weight * x * x / (3.0 * f64::from(n));
        }
        let kept = path.nodes().iter().all(|node| {
            let a = map.project(&node.q).a;
            map.limits().iter().zip(a).all(|(limit, a)| limit.contains(a, LIMIT_SLACK))
        });
        let end_b = path.nodes().last().map_or(f64::NAN, |node| map.project(&node.q).b);
        MinimumNorm { reaction: BaseReaction { peak, rms: squares.sqrt() }, end_b, keeps_limits: kept }
    }
}

/// Comparison of three ways to make one motion of the end effector from one pose.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "StatedVerdicts")]
pub struct Verdicts {
    /// Constant b: no reaction, if feasible.
    pub fixed: FixedB,
    /// Minimum-norm rates, q′ = J⁺ p′, as in case 1.
    pub minimum_norm: Result<MinimumNorm, PathError>,
    /// Base moment of the least reaction.
    pub least: BaseReaction,
}

/// Serialised as the feasibility of constant b, the other base moments, and whether minimum norm keeps the limits.
#[derive(JsonSchema, Serialize)]
struct StatedVerdicts {
    fixed_b_serves: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    fixed_b_until: Option<f64>,
    least_peak: f64,
    least_rms: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    minimum_norm_peak: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    minimum_norm_rms: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    minimum_norm_keeps_limits: Option<bool>,
}

impl From<Verdicts> for StatedVerdicts {
    fn from(of: Verdicts) -> Self {
        let norm = of.minimum_norm.ok();
        Self {
            fixed_b_serves: of.fixed == FixedB::Serves,
            fixed_b_until: match of.fixed {
                FixedB::Leaves { u, .. } => Some(u),
                FixedB::Serves => None,
            },
            least_peak: of.least.peak,
            least_rms: of.least.rms,
            minimum_norm_peak: norm.as_ref().map(|norm| norm.reaction.peak),
            minimum_norm_rms: norm.as_ref().map(|norm| norm.reaction.rms),
            minimum_norm_keeps_limits: norm.as_ref().map(|norm| norm.keeps_limits),
        }
    }
}

impl JsonSchema for Verdicts {
    fn schema_name() -> Cow<'static, str> {
        StatedVerdicts::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        StatedVerdicts::json_schema(generator)
    }
}

/// Feasibility of the b of the start pose for the whole motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FixedB {
    /// It is feasible, and n_B = 0.
    Serves,
    /// It is infeasible at some u; the first is given.
    Leaves {
        /// t/T.
        u: f64,
        /// Lower bound of the corridor there, rad.
        low: f64,
        /// Upper bound of the corridor there, rad.
        high: f64,
    },
}

/// The motion with minimum-norm rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MinimumNorm {
    /// Base moment.
    pub reaction: BaseReaction,
    /// b at its end, rad.
    pub end_b: f64,
    /// Whether the joint limits are kept all the way. Where a session holds b, change points to be avoided count too.
    pub keeps_limits: bool,
}

/// Returns the path of the drives along a course of b. Few nodes are used if they keep the end effector on its curve
/// at all stations, because rounding errors of q″ grow with their number. Near a fold the path has nodes at all
/// stations and more between them.
fn followed(
    corridor: &Corridor,
    curve: impl Fn(f64) -> CurvePoint,
    course: &BCourse,
) -> Result<PathTable, LeastReactionError> {
    let (map, stations) = (corridor.map(), corridor.stations());
    let mut from = corridor.start().a;
    let mut nodes = Vec::with_capacity(stations.len());
    for station in stations {
        let b = course.at(station.u);
        let missing = LeastReactionError::NotFollowed { u: station.u };
        let on = pose_along(map, &station.point, b, from)
            .or_else(|| pose_along(map, &station.point, b, station.pose(map, b[0])?.a));
        let (at, node) = on.ok_or(missing)?;
        from = at.a;
        nodes.push(node);
    }
    let invalid = LeastReactionError::NotFollowed { u: 0.0 };
    let reach = map.c().iter().map(|c| c.abs()).sum::<f64>();
    let off = |table: &PathTable, u: f64, p: Vector| {
        let at = map.project(&table.at(u).q);
        (map.forward(at.a, at.b) - p).norm()
    };
    for step in [PIECE_STATIONS / 2, PIECE_STATIONS / 4] {
        let table = PathTable::even(nodes.iter().step_by(step).copied().collect()).ok_or(invalid.clone())?;
        if stations.iter().all(|station| off(&table, station.u, station.point.p) <= CURVE_TOLERANCE * reach) {
            return Ok(table);
        }
    }
    let mut table = PathTable::even(nodes.clone()).ok_or(invalid.clone())?;
    let mut u: Vec<f64> = stations.iter().map(|station| station.u).collect();
    for round in 0..=MAX_HALVINGS {
        let mut worst = (0.0, 0.0);
        let (mut finer, mut finer_nodes) = (Vec::with_capacity(u.len()), Vec::with_capacity(u.len()));
        for (i, w) in u.windows(2).enumerate() {
            finer.push(w[0]);
            finer_nodes.push(nodes[i]);
            let middle = 0.5 * (w[0] + w[1]);
            let point = curve(middle);
            let gap = off(&table, middle, point.p);
            if gap <= CURVE_TOLERANCE_NEAR_FOLD * reach {
                continue;
            }
            if gap > worst.0 {
                worst = (gap, middle);
            }
            let b = course.at(middle);
            let missing = LeastReactionError::NotFollowed { u: middle };
            let from = [i, i + 1].map(|i| map.project(&nodes[i].q).a);
            let on = from.into_iter().find_map(|from| pose_along(map, &point, b, from)).or_else(|| {
                // Near a fold, start from the corridor's own pose.
                pose_along(map, &point, b, corridor.at(&curve, middle)?.pose(map, b[0])?.a)
            });
            finer.push(middle);
            finer_nodes.push(on.ok_or(missing)?.1);
        }
        if worst.0 == 0.0 {
            break;
        }
        if round == MAX_HALVINGS || finer.len() > MAX_NODES_PER_STATION * stations.len() {
            return if worst.0 > MAX_DEVIATION * reach {
                Err(LeastReactionError::NotFollowed { u: worst.1 })
            } else {
                Ok(table)
            };
        }
        finer.push(1.0);
        finer_nodes.push(nodes[nodes.len() - 1]);
        (u, nodes) = (finer, finer_nodes);
        table = PathTable::new(u.clone(), nodes.clone()).ok_or(invalid.clone())?;
    }
    Ok(table)
}
