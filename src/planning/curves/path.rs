//! Paths: poses q(s) for s from 0 to 1, with exact derivatives.

use thiserror::Error;

use crate::curves::curve::{Curve, CurvePoint};
use crate::curves::point::PathPoint;
use crate::curves::table::PathTable;
use crate::reactionless::{PlaneMap, PlanePoint};
use stillbase_mechanics::kinematics::{
    acceleration, closest_turn, end_effector, minimum_norm, minimum_norm_with, two_link_rates, velocity,
};
use stillbase_mechanics::machine::Chain;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, unit};

/// A path of the drives.
#[derive(Clone, Debug, PartialEq)]
pub enum Path {
    /// A fixed pose.
    Rest(DriveAngles),
    /// A straight line in joint space; from a pose to another of the same b it is reactionless (case 3).
    JointLine {
        /// At s = 0.
        from: DriveAngles,
        /// At s = 1.
        to: DriveAngles,
    },
    /// Nodes joined by quintics, such as those of an integrated path.
    Table(PathTable),
    /// A curve of (a_1, a_2) on the plane of a pose constant: reactionless.
    OnPlane {
        /// Converts (a_1, a_2) and b to drive angles.
        map: PlaneMap,
        /// Pose constant, rad.
        b: f64,
        /// a_1 + i a_2, rad.
        curve: Curve,
    },
    /// Consecutive paths; the motion must be at rest where two meet.
    Chain(PathChain),
    /// The end effector follows that of a joint line while drive 1 turns linearly to a different angle (case 2).
    SameTip(SameTip),
}

/// Why a path does not exist.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PathError {
    /// The Jacobian loses rank on the way.
    #[error("the arm is stretched or folded at s = {s:.3} of the line, where the end effector cannot follow it")]
    Singular {
        /// s at which it happens, 0 to 1.
        s: f64,
    },
    /// Drives 2 and 3 cannot place the end effector for the angle of drive 1.
    #[error("with drive 1 on that course, drives 2 and 3 cannot keep the end effector on its path at s = {s:.3}")]
    Unreachable {
        /// s at which it happens, 0 to 1.
        s: f64,
    },
}

impl Path {
    /// Returns the pose at s, clamped to 0..1, and its derivatives.
    #[inline]
    pub fn at(&self, s: f64) -> PathPoint {
        let s = s.clamp(0.0, 1.0);
        match self {
            Self::Rest(q) => {
                let still = PerDrive::zeros(q.len());
                PathPoint { q: *q, first: still, second: still }
            }
            Self::JointLine { from, to } => joint_line(from, to, s),
            Self::Table(table) => table.at(s),
            Self::OnPlane { map, b, curve } => on_plane(map, *b, curve, s),
            Self::Chain(chain) => chain.at(s),
            Self::SameTip(path) => path.at(s),
        }
    }

    /// Returns the s at which q′ or q″ jumps: at joints of curves, where paths meet, and where a table jumps.
    pub fn kinks(&self) -> Vec<f64> {
        const COINCIDENT_BELOW: f64 = 1e-9;
        let joints: Vec<f64> = match self {
            Self::Chain(chain) => {
                let inner = |(path, [from, to]): (&Self, [f64; 2])| {
                    path.kinks().into_iter().map(move |s| from + s * (to - from)).chain([to])
                };
                return chain.parts().flat_map(inner).filter(|s| *s < 1.0).collect();
            }
            Self::OnPlane { curve, .. } => curve.joints().collect(),
            // Where a table jumps, two of its nodes have almost the same s.
            Self::Table(table) => {
                table.stations().windows(2).filter(|w| w[1] - w[0] < COINCIDENT_BELOW).map(|w| w[0]).collect()
            }
            _ => Vec::new(),
        };
        let jumps = |s: &f64| {
            let (a, b) = (self.at(s - COINCIDENT_BELOW), self.at(s + COINCIDENT_BELOW));
            let jump = |a: &PerDrive, b: &PerDrive| b.minus(a).max_abs();
            jump(&a.first, &b.first) + jump(&a.second, &b.second)
                > 1e-5 * (a.first.max_abs() + a.second.max_abs() + b.second.max_abs())
        };
        joints.into_iter().filter(|s| *s > 0.0 && *s < 1.0).filter(jumps).collect()
    }

    /// Returns the number of paths in a chain, else 1; a table counts as one path for each 1024 nodes, rounded up.
    pub fn parts(&self) -> usize {
        match self {
            Self::Chain(chain) => chain.paths.iter().map(Self::parts).sum(),
            Self::Table(table) => table.nodes().len().div_ceil(NODES_PER_PATH),
            _ => 1,
        }
    }

    /// Returns d³q/ds³ at s, rad. It is exact except for case 2, where it is a difference quotient of q″. At a jump it
    /// is the value after s; for a curve on a plane or a chain of paths, the value before s.
    pub fn third(&self, s: f64) -> PerDrive {
        let s = s.clamp(0.0, 1.0);
        match self {
            Self::Rest(q) | Self::JointLine { from: q, .. } => PerDrive::zeros(q.len()),
            Self::Table(table) => table.third(s),
            Self::OnPlane { map, curve, .. } => {
                let third = curve.third(s);
                PerDrive::from(map.lift_rates([third.re, third.im], 0.0))
            }
            Self::Chain(chain) => chain.third(s),
            Self::SameTip(_) => {
                let (before, after) = ((s - DIFFERENCE_STEP).max(0.0), (s + DIFFERENCE_STEP).min(1.0));
                self.at(after).second.minus(&self.at(before).second).scaled(1.0 / (after - before))
            }
        }
    }

    /// Returns the s at which q‴ jumps, and both ends 0 and 1. Between these a path is smooth.
    pub fn joints(&self) -> Vec<f64> {
        match self {
            Self::Rest(_) | Self::JointLine { .. } | Self::SameTip(_) => vec![0.0, 1.0],
            Self::Table(table) => table.joints(),
            Self::OnPlane { curve, .. } => curve.joints().collect(),
            Self::Chain(chain) => chain.joined(Self::joints),
        }
    }

    /// Returns samples of s from 0 to 1. In tables and curves on a plane the path changes little between neighbours;
    /// other paths give their joints.
    pub fn sample_parameters(&self) -> Vec<f64> {
        match self {
            Self::Table(table) => table.stations().to_vec(),
            Self::OnPlane { curve, .. } => curve.sample_parameters().collect(),
            Self::Chain(chain) => chain.joined(Self::sample_parameters),
            _ => self.joints(),
        }
    }
}

fn on_plane(map: &PlaneMap, b: f64, curve: &Curve, s: f64) -> PathPoint {
    let CurvePoint { p, first, second } = curve.at(s);
    PathPoint {
        q: DriveAngles::from(map.lift(PlanePoint { a: [p.re, p.im], b })),
        first: PerDrive::from(map.lift_rates([first.re, first.im], 0.0)),
        second: PerDrive::from(map.lift_rates([second.re, second.im], 0.0)),
    }
}

/// Paths end to end.
#[derive(Clone, Debug, PartialEq)]
pub struct PathChain {
    paths: Vec<Path>,
    /// s at which each path ends; the last is 1.
    ends: Vec<f64>,
}

impl PathChain {
    /// Chains paths; s is divided among them in proportion to the given shares. Returns `None` if there are none, or a
    /// share is not above 0.
    pub fn new(parts: Vec<(Path, f64)>) -> Option<Self> {
        let total: f64 = parts.iter().map(|(_, share)| share).sum();
        let sound = total.is_finite() && parts.iter().all(|(_, share)| *share > 0.0);
        if parts.is_empty() || !sound {
            return None;
        }
        let mut sum = 0.0;
        let mut ends: Vec<f64> = Vec::with_capacity(parts.len());
        for (_, share) in &parts {
            sum += share;
            ends.push(sum / total);
        }
        if let Some(last) = ends.last_mut() {
            *last = 1.0;
        }
        Some(Self { paths: parts.into_iter().map(|(path, _)| path).collect(), ends })
    }

    /// Returns the paths, each with its interval of s.
    pub fn parts(&self) -> impl Iterator<Item = (&Path, [f64; 2])> {
        let begins = std::iter::once(0.0).chain(self.ends.iter().copied());
        self.paths.iter().zip(begins.zip(&self.ends).map(|(from, to)| [from, *to]))
    }

    /// Returns the path at s, the local s on it, and its share of the whole s.
    fn part(&self, s: f64) -> (&Path, f64, f64) {
        let i = self.ends.partition_point(|end| *end < s).min(self.paths.len() - 1);
        let from = if i == 0 { 0.0 } else { self.ends[i - 1] };
        let run = self.ends[i] - from;
        (&self.paths[i], (s - from) / run, run)
    }

    fn at(&self, s: f64) -> PathPoint {
        let (path, s, run) = self.part(s);
        let point = path.at(s);
        PathPoint { q: point.q, first: point.first.scaled(1.0 / run), second: point.second.scaled(1.0 / (run * run)) }
    }

    fn third(&self, s: f64) -> PerDrive {
        let (path, s, run) = self.part(s);
        path.third(s).scaled(1.0 / (run * run * run))
    }

    /// Concatenates values of s of the paths, converted to s of the chain.
    fn joined(&self, places: impl Fn(&Path) -> Vec<f64>) -> Vec<f64> {
        let own = self.parts().flat_map(|(path, [from, to])| {
            let inner: Vec<f64> = places(path).into_iter().filter(|s| *s < 1.0).collect();
            inner.into_iter().map(move |s| from + s * (to - from))
        });
        own.chain([1.0]).collect()
    }
}

/// Number of nodes of a table that count as one path.
const NODES_PER_PATH: usize = 1024;
/// Half step in s of the difference quotient for q‴, at which rounding and truncation errors are about equal.
const DIFFERENCE_STEP: f64 = 1e-5;

#[inline]
fn joint_line(from: &DriveAngles, to: &DriveAngles, s: f64) -> PathPoint {
    let n = from.len();
    let step = to.0.minus(&from.0);
    PathPoint { q: DriveAngles(from.0.plus(s, &step)), first: step, second: PerDrive::zeros(n) }
}

/// Number of intervals between the nodes of an integrated path; the quintic's error is below 1e-13 rad on a straight
/// line.
const NODE_INTERVALS: usize = 256;
/// Maximum drift of the integration off its curve within one interval, as a fraction of the arm length; a larger drift
/// counts as a singularity. The drift is far smaller where the Jacobian is regular.
const MAX_DRIFT: f64 = 1e-6;

/// Follows a curve of the end effector with minimum-norm rates, q′ = J⁺ p′, from a pose at its start. Integrates by the
/// classical fourth-order Runge–Kutta method.
///
/// # Errors
/// If the Jacobian loses rank on the way.
pub fn minimum_norm_path(
    tip: &Chain,
    start: DriveAngles,
    curve: impl Fn(f64) -> CurvePoint,
) -> Result<PathTable, PathError> {
    let nodes = least_rate_nodes(tip, None, start, &curve, NODE_INTERVALS)?;
    PathTable::even(nodes).ok_or(PathError::Singular { s: 0.0 })
}

/// Follows a curve with minimum-norm rates piece by piece. Each piece has its own intervals, because integration
/// across a join of two pieces would lose accuracy.
///
/// # Errors
/// If the Jacobian loses rank on the way.
pub fn minimum_norm_curve(tip: &Chain, start: DriveAngles, curve: &Curve) -> Result<PathTable, PathError> {
    least_rate_curve(tip, None, start, curve)
}

/// Follows a curve piece by piece with the rates of minimum norm. If λ is given as `held`, these also keep b = Σ λ_k
/// q_k constant.
///
/// # Errors
/// If the Jacobian, with λ, loses rank on the way.
pub fn least_rate_curve(
    tip: &Chain,
    held: Option<&PerDrive>,
    start: DriveAngles,
    curve: &Curve,
) -> Result<PathTable, PathError> {
    let piece = |q: DriveAngles, [from, to]: [f64; 2], at: &dyn Fn(f64) -> CurvePoint, spaces: usize| {
        least_rate_nodes(tip, held.map(|row| (row, 0.0)), q, &at, spaces).map_err(|error| match error {
            PathError::Singular { s } => PathError::Singular { s: from + s * (to - from) },
            other => other,
        })
    };
    by_pieces(curve, start, NODE_INTERVALS, piece)?.ok_or(PathError::Singular { s: 0.0 })
}

/// Builds the path along a curve from the nodes of its pieces. `follow` takes the start pose, the interval of s, the
/// piece over u from 0 to 1, and the number of intervals.
pub(crate) fn by_pieces<E>(
    curve: &Curve,
    start: DriveAngles,
    spaces: usize,
    follow: impl Fn(DriveAngles, [f64; 2], &dyn Fn(f64) -> CurvePoint, usize) -> Result<Vec<PathPoint>, E>,
) -> Result<Option<PathTable>, E> {
    let joints: Vec<f64> = curve.joints().collect();
    // Curves with very many pieces, such as those through samples, have short pieces.
    let min_intervals = if joints.len() > 200 { 1 } else { 16 };
    let (mut stations, mut nodes, mut q) = (Vec::new(), Vec::new(), start);
    for ends in joints.windows(2) {
        let (from, run) = (ends[0], ends[1] - ends[0]);
        let own = ((spaces as f64 * run).ceil() as usize).max(min_intervals);
        let at = |u: f64| {
            let point = curve.at(if u >= 1.0 { ends[1] } else { from + u * run });
            CurvePoint { p: point.p, first: point.first * run, second: point.second * (run * run) }
        };
        let piece = follow(q, [ends[0], ends[1]], &at, own)?;
        q = piece.last().map_or(q, |last| last.q);
        let first = usize::from(!nodes.is_empty());
        for (i, node) in piece.into_iter().enumerate().skip(first) {
            stations.push(if i == own { ends[1] } else { from + run * i as f64 / own as f64 });
            nodes.push(PathPoint {
                q: node.q,
                first: node.first.scaled(1.0 / run),
                second: node.second.scaled(1.0 / (run * run)),
            });
        }
    }
    Ok(PathTable::new(stations, nodes))
}

/// Integrates the rates of minimum norm along a curve and returns the nodes. `held` is an additional row of the
/// Jacobian with the constant that its product with the rates must equal.
fn least_rate_nodes(
    tip: &Chain,
    held: Option<(&PerDrive, f64)>,
    start: DriveAngles,
    curve: &impl Fn(f64) -> CurvePoint,
    spaces: usize,
) -> Result<Vec<PathPoint>, PathError> {
    let max_drift = MAX_DRIFT * tip.iter().map(|c| c.abs()).sum::<f64>();
    let n = start.len();
    let rates = |q: &DriveAngles, v: Vector, vd: Vector, share: f64| match held {
        Some((row, rate)) => minimum_norm_with(tip, row, share * rate, |_| PerDrive::zeros(n), &q.units(), v, vd),
        None => minimum_norm(tip, &q.units(), n, v, vd),
    };
    let slope = |q: &DriveAngles, s: f64| {
        let way = curve(s);
        rates(q, way.first, way.second, 1.0).ok_or(PathError::Singular { s })
    };
    // Each interval takes several steps, so that the integration is as accurate as the quintics.
    const STEPS_PER_INTERVAL: usize = 4;
    let h = 1.0 / (spaces * STEPS_PER_INTERVAL) as f64;
    let mut q = start;
    let mut nodes = Vec::with_capacity(spaces + 1);
    for i in 0..=spaces {
        let s = i as f64 / spaces as f64;
        // A step may cross a singularity unnoticed, but then the end effector leaves the curve.
        let gap = curve(s).p - end_effector(tip, &q.units());
        if gap.is_nan() || gap.norm() > max_drift {
            return Err(PathError::Singular { s });
        }
        let (back, _) = rates(&q, gap, Vector::default(), 0.0).ok_or(PathError::Singular { s })?;
        q = DriveAngles(q.0.plus(1.0, &back));
        let (first, second) = slope(&q, s)?;
        nodes.push(PathPoint { q, first, second });
        if i == spaces {
            break;
        }
        for j in 0..STEPS_PER_INTERVAL {
            let s = (i * STEPS_PER_INTERVAL + j) as f64 * h;
            let (k1, _) = slope(&q, s)?;
            let (k2, _) = slope(&DriveAngles(q.0.plus(h / 2.0, &k1)), s + h / 2.0)?;
            let (k3, _) = slope(&DriveAngles(q.0.plus(h / 2.0, &k2)), s + h / 2.0)?;
            let (k4, _) = slope(&DriveAngles(q.0.plus(h, &k3)), s + h)?;
            q = DriveAngles(q.0.plus(h / 6.0, &k1).plus(h / 3.0, &k2).plus(h / 3.0, &k3).plus(h / 6.0, &k4));
        }
    }
    Ok(nodes)
}

/// Follows the end effector of the joint line `from`–`to` with four drives or more. Drive 1 turns linearly to
/// `first_to`, rad; the others move with the rates of minimum norm.
///
/// # Errors
/// If the Jacobian loses rank on the way.
pub fn same_tip_path(tip: &Chain, from: DriveAngles, to: DriveAngles, first_to: f64) -> Result<PathTable, PathError> {
    let curve = |s: f64| {
        let line = joint_line(&from, &to, s);
        let e = line.q.units();
        let (first, second) = (velocity(tip, &e, &line.first), acceleration(tip, &e, &line.first, &line.second));
        CurvePoint { p: end_effector(tip, &e), first, second }
    };
    let own = PerDrive::from_fn(from.len(), |k| f64::from(u8::from(k == 0)));
    let nodes = least_rate_nodes(tip, Some((&own, first_to - from[0])), from, &curve, NODE_INTERVALS)?;
    PathTable::even(nodes).ok_or(PathError::Singular { s: 0.0 })
}

/// Path on which the end effector follows that of a joint line while drive 1 turns linearly to a different angle.
/// Drives 2 and 3 keep the sign of the elbow angle.
#[derive(Clone, Debug, PartialEq)]
pub struct SameTip {
    tip: Chain,
    from: DriveAngles,
    to: DriveAngles,
    first_to: f64,
    elbow: f64,
}

impl SameTip {
    /// Follows the end effector of the joint line `from`–`to` while drive 1 turns linearly to `first_to`, rad.
    ///
    /// # Errors
    /// If drives 2 and 3 cannot place the end effector at one of the sampled s.
    pub fn new(tip: &Chain, from: DriveAngles, to: DriveAngles, first_to: f64) -> Result<Self, PathError> {
        let elbow = (from[2] - from[1]).sin();
        let path = Self { tip: *tip, from, to, first_to, elbow };
        let steps = 256;
        match (0..=steps).map(|i| f64::from(i) / f64::from(steps)).find(|s| path.solve(*s).is_none()) {
            Some(s) => Err(PathError::Unreachable { s }),
            None => Ok(path),
        }
    }

    fn at(&self, s: f64) -> PathPoint {
        // `new` has checked samples of the path; a failure between them falls back to the joint line.
        self.solve(s).unwrap_or_else(|| joint_line(&self.from, &self.to, s))
    }

    fn solve(&self, s: f64) -> Option<PathPoint> {
        let tip = &self.tip;
        let line = joint_line(&self.from, &self.to, s);
        let e = line.q.units();
        let (v, a) = (velocity(tip, &e, &line.first), acceleration(tip, &e, &line.first, &line.second));
        let q1 = self.from[0] + s * (self.first_to - self.from[0]);
        let q1_rate = self.first_to - self.from[0];
        let (c2, c3) = (tip[1], tip[2]);
        let r = end_effector(tip, &e) - tip[0] * unit(q1);
        let cos = (r.norm_sqr() - c2 * c2 - c3 * c3) / (2.0 * c2 * c3);
        if !(-1.0..=1.0).contains(&cos) {
            return None;
        }
        let bend = cos.acos().copysign(self.elbow);
        let q2 = closest_turn((r * (c2 + c3 * unit(bend)).conj()).arg(), line.q[1]);
        let q3 = closest_turn(q2 + bend, line.q[2]);
        let q = DriveAngles::from([q1, q2, q3]);
        let e = q.units();
        let zero = PerDrive::zeros(3);
        let own = velocity(tip, &e, &PerDrive::from([q1_rate, 0.0, 0.0]));
        let (d2, d3) = two_link_rates(c2, c3, e[1], e[2], v - own)?;
        let first = PerDrive::from([q1_rate, d2, d3]);
        // p″ = J q″ + J′ q′, with q″_1 = 0.
        let (dd2, dd3) = two_link_rates(c2, c3, e[1], e[2], a - acceleration(tip, &e, &first, &zero))?;
        Some(PathPoint { q, first, second: PerDrive::from([0.0, dd2, dd3]) })
    }
}
