//! [`PoseMap`]: coordinates (a, b) of the poses of a machine whose b can be held, for any number of drives, and where a
//! hand can lead it in them.

use std::f64::consts::PI;
use std::sync::Arc;

use super::common::{Reaching, common};
use super::pose_constant::{Planes, Reach};
use super::pose_space::{Lead, NoPoseSpace, PoseSpace};
use super::posture::{Posture, Postures};
use super::reactionless::{BSet, Decimal, PlanePoint};
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::{DriveAngles, PerDrive, Vector};
use crate::query::{Quick, Same};

/// A point that a pose misses by less than this share of the reach is reached.
const REACHED: f64 = 1e-9;
/// From how many poses the nearest one is sought, and by how much of the reach another has to be nearer.
const STARTS: usize = 24;
const CLEARLY: f64 = 1e-4;
/// Looks along the curve of two drives, and halvings between two of them.
const LOOKS: usize = 240;
const HALVINGS: usize = 60;

/// Coordinates of the poses of a machine: relative angles a, one fewer than drives, and b.
#[derive(Clone, Debug)]
pub enum PoseMap {
    /// Three drives and two angles: planes, with everything in closed form.
    Planes(Arc<Planes>),
    /// Any other number.
    Space(Arc<PoseSpace>),
}

/// The pose map of a machine with its planes, if it has some, led as a posture has it; or why its b cannot be held.
pub struct MapOf;

impl Quick for MapOf {
    type Input = (Machine, Option<Same<Planes>>, Posture);
    type Answer = Result<PoseMap, NoPoseSpace>;

    fn answer((machine, planes, posture): &Self::Input) -> Self::Answer {
        PoseMap::of(machine, planes.as_ref().map(|planes| &planes.0), *posture)
    }
}

/// The b that serve all of several points, m, and those of each; none where there are none.
pub struct BOfPoints;

/// What [`BOfPoints`] answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Serving {
    /// Of each point.
    pub each: Vec<Option<BSet>>,
    /// Of all of them.
    pub all: Option<BSet>,
}

impl Quick for BOfPoints {
    /// A pose map, and the points.
    type Input = (Same<Result<PoseMap, NoPoseSpace>>, Vec<Vector>);
    type Answer = Serving;

    fn answer((Same(map), points): &Self::Input) -> Serving {
        match &**map {
            Ok(map) => Serving { each: points.iter().map(|p| map.b_of(*p)).collect(), all: map.common(points) },
            Err(_) => Serving { each: vec![None; points.len()], all: None },
        }
    }
}

impl PoseMap {
    /// Of a machine, with its planes if it has some; with four drives and more it is led as a posture has it.
    ///
    /// # Errors
    /// Why its b cannot be held.
    pub fn of(machine: &Machine, planes: Option<&Arc<Planes>>, posture: Posture) -> Result<Self, NoPoseSpace> {
        if let Some(planes) = planes {
            return Ok(Self::Planes(planes.clone()));
        }
        let space = PoseSpace::of(machine)?;
        let lead = match posture {
            _ if machine.drives() < 4 => Lead::LeastEnergy,
            Posture::LeastRates => Lead::LeastEnergy,
            Posture::Orientation => Lead::Keep(machine.resolved_links()[machine.end_link()].drive),
            Posture::LeastTorque => Postures::of(machine, &space)
                .least_torque()
                .map_or(Lead::LeastEnergy, |inverse| Lead::Weighed(Box::new(inverse))),
            Posture::MidRange => Lead::Middle,
        };
        Ok(Self::Space(Arc::new(space.led(lead))))
    }

    /// How many relative angles there are.
    pub fn angles(&self) -> usize {
        match self {
            Self::Planes(_) => 2,
            Self::Space(space) => space.joints().len(),
        }
    }

    /// Whether a point and a b leave freedoms, so that a link can be pulled while the end effector stays.
    pub fn holds(&self) -> bool {
        matches!(self, Self::Space(space) if space.drives() > 3)
    }

    /// Whether holding b keeps every moment from the base; where not, it keeps most of it.
    pub fn is_reactionless(&self) -> bool {
        match self {
            Self::Planes(planes) => planes.is_reactionless(),
            Self::Space(space) => space.is_reactionless(),
        }
    }

    /// λ of the drives.
    pub fn lambda(&self) -> PerDrive {
        match self {
            Self::Planes(planes) => PerDrive::from(planes.map().lambda()),
            Self::Space(space) => *space.lambda(),
        }
    }

    /// Turning all drives once adds this to b and changes nothing else, rad.
    pub fn period(&self) -> f64 {
        match self {
            Self::Planes(planes) => planes.map().period(),
            Self::Space(space) => space.period(),
        }
    }

    /// How far b turns what can be reached, rad.
    pub fn turn(&self, b: f64) -> f64 {
        match self {
            Self::Planes(planes) => planes.map().turn(b),
            Self::Space(space) => space.turn(b),
        }
    }

    /// All b at which the end effector can be on a point, m, within the limits; none if there is none.
    pub fn b_of(&self, p: Vector) -> Option<BSet> {
        match self {
            Self::Planes(planes) => planes.map().reach(p).ok(),
            Self::Space(space) => space.reach(p).ok(),
        }
    }

    /// What reaches points by its b.
    pub fn reaching(&self) -> &dyn Reaching {
        match self {
            Self::Planes(planes) => planes.map(),
            Self::Space(space) => &**space,
        }
    }

    /// The b that serve all of several points, m; none if there is none.
    pub fn common(&self, points: &[Vector]) -> Option<BSet> {
        common(self.reaching(), points)
    }

    /// Relative angles and b of a pose, rad.
    pub fn project(&self, q: &DriveAngles) -> (PerDrive, f64) {
        match self {
            Self::Planes(planes) => {
                let at = planes.map().project(q);
                (PerDrive::from(at.a), at.b)
            }
            Self::Space(space) => (space.angles(q), space.b(q)),
        }
    }

    /// Rates of the relative angles and ḃ for rates of the drives.
    pub fn project_rates(&self, qd: &PerDrive) -> (PerDrive, f64) {
        match self {
            Self::Planes(planes) => {
                let (ad, bd) = planes.map().project_rates(qd);
                (PerDrive::from(ad), bd)
            }
            Self::Space(space) => (space.angle_rates(qd), space.b(qd)),
        }
    }

    /// Drive angles, never wrapped.
    pub fn lift(&self, a: &PerDrive, b: f64) -> DriveAngles {
        match self {
            Self::Planes(planes) => DriveAngles::from(planes.map().lift(PlanePoint { a: [a[0], a[1]], b })),
            Self::Space(space) => space.lift(a, b),
        }
    }

    /// Rates of the drives.
    pub fn lift_rates(&self, ad: &PerDrive, bd: f64) -> PerDrive {
        match self {
            Self::Planes(planes) => PerDrive::from(planes.map().lift_rates([ad[0], ad[1]], bd)),
            Self::Space(space) => space.lift_rates(ad, bd),
        }
    }

    /// The end effector, m.
    pub fn forward(&self, a: &PerDrive, b: f64) -> Vector {
        match self {
            Self::Planes(planes) => planes.map().forward([a[0], a[1]], b),
            Self::Space(space) => space.place(&space.lift(a, b)),
        }
    }

    /// Least and greatest value of a relative angle, rad; infinite where it turns freely.
    pub fn limits(&self, i: usize) -> [f64; 2] {
        match self {
            Self::Planes(planes) => {
                let limit = planes.map().limits()[i];
                [limit.min, limit.max]
            }
            Self::Space(space) => space.joints()[i].bounds(),
        }
    }

    /// Relative angles within their limits.
    pub fn clamped(&self, a: &PerDrive) -> PerDrive {
        match self {
            Self::Planes(planes) => PerDrive::from(planes.map().clamp([a[0], a[1]])),
            Self::Space(space) => space.clamped(a),
        }
    }

    /// Whether something inside the limits can bar a straight way of joint space.
    pub fn has_bars(&self) -> bool {
        matches!(self, Self::Planes(planes) if planes.has_bars())
    }

    /// Whether nothing bars the straight way of joint space between two poses of one b.
    pub fn is_open_way(&self, from: &PerDrive, to: &PerDrive) -> bool {
        match self {
            Self::Planes(planes) => planes.is_open_way([from[0], from[1]], [to[0], to[1]]),
            Self::Space(_) => true,
        }
    }

    /// The pose that puts the end effector on p, m, at b, continuously from another.
    pub fn follow(&self, p: Vector, b: f64, from: &PerDrive) -> Option<PerDrive> {
        match self {
            Self::Planes(planes) => planes.follow(p, b, [from[0], from[1]]).map(PerDrive::from),
            Self::Space(space) => {
                let keeping = space.toward_led(p, b, from).filter(|(_, off)| is_at(space, *off));
                let (a, off) = keeping.unwrap_or_else(|| space.toward(p, b, from));
                is_at(space, off).then_some(a)
            }
        }
    }

    /// Where to go for a target, m, at b: its pose, or the nearest that can be reached from another; sought all over the
    /// limits.
    pub fn reach(&self, p: Vector, b: f64, from: &PerDrive) -> (PerDrive, Reach) {
        match self {
            Self::Planes(planes) => {
                let (a, reach) = planes.reach(p, b, [from[0], from[1]]);
                (PerDrive::from(a), reach)
            }
            Self::Space(space) => reach(space, p, b, from),
        }
    }

    /// The same beside another pose, for a target out of reach from which b moves on: which b would do is as it was.
    pub fn reach_beside(&self, p: Vector, b: f64, from: &PerDrive, known: Reach) -> (PerDrive, Reach) {
        match self {
            Self::Planes(_) => self.reach(p, b, from),
            Self::Space(space) => {
                let (a, off) = match space.drives() {
                    2 => along_curve(space, p, b, from[0]),
                    _ => space.toward_beside(p, b, from),
                };
                let reach = match known {
                    _ if is_at(space, off) => Reach::Inside,
                    Reach::Outside { mending_b, shown_b, other_sheet, .. } => {
                        let nearest = space.place(&space.lift(&a, b));
                        Reach::Outside { nearest, mending_b, shown_b, other_sheet }
                    }
                    known => known,
                };
                (a, reach)
            }
        }
    }
}

fn is_at(space: &PoseSpace, off: f64) -> bool {
    off <= REACHED * space.farthest()
}

fn reach(space: &PoseSpace, p: Vector, b: f64, from: &PerDrive) -> (PerDrive, Reach) {
    if let Some((a, _)) = space.toward_led(p, b, from).filter(|(_, off)| is_at(space, *off)) {
        return (a, Reach::Inside);
    }
    let (mut a, mut off) = match space.drives() {
        2 => along_curve(space, p, b, from[0]),
        _ => space.toward(p, b, from),
    };
    if !is_at(space, off) && space.drives() > 3 {
        // Another elbow may reach it; nothing bars the way there.
        let poses = space.poses(p, b, from);
        match poses.first() {
            Some(q) => (a, off) = (space.angles(q), 0.0),
            None => (a, off) = nearest_of_all(space, p, b, (a, off)),
        }
    }
    if is_at(space, off) {
        return (a, Reach::Inside);
    }
    let set = space.reach(p).ok();
    let mending_b = set.as_ref().and_then(|set| set.nearest(b));
    // One b alone is printed with as many figures as it takes.
    let serves = |b: f64| space.reaches(p, b);
    let printed = |set: &BSet, b: f64| set.decimal(b, 3).or_else(|| Decimal::that(b, 3, serves));
    let shown_b = set.as_ref().zip(mending_b).and_then(|(set, b)| printed(set, b));
    let nearest = space.place(&space.lift(&a, b));
    (a, Reach::Outside { nearest, mending_b, shown_b, other_sheet: false })
}

/// The pose that is nearest to p, m, of those gone to from all over the limits; the one there is, unless another is clearly
/// nearer.
fn nearest_of_all(space: &PoseSpace, p: Vector, b: f64, (a, off): (PerDrive, f64)) -> (PerDrive, f64) {
    let others = (0..STARTS).map(|i| space.toward(p, b, &space.spread(i)));
    let best = others.min_by(|x, y| x.1.total_cmp(&y.1));
    best.filter(|(_, other)| *other < off - CLEARLY * space.farthest()).unwrap_or((a, off))
}

/// Two drives: the point of their curve that is nearest to p, and how far that is, m; where it turns
/// freely, within half a turn of an angle.
fn along_curve(space: &PoseSpace, p: Vector, b: f64, turn: f64) -> (PerDrive, f64) {
    // Where it turns freely, within half a turn: the curve goes on from there.
    let is_free = space.joints()[0].bounds()[0].is_infinite();
    let [low, high] = if is_free { [turn - PI, turn + PI] } else { space.joints()[0].limits() };
    let off = |a: f64| (space.place(&space.lift(&[a], b)) - p).norm();
    let step = (high - low) / LOOKS as f64;
    let looks = (0..=LOOKS).map(|i| low + step * i as f64);
    let near = looks.min_by(|x, y| off(*x).total_cmp(&off(*y))).unwrap_or(low);
    let [mut from, mut to] = [(near - step).max(low), (near + step).min(high)];
    for _ in 0..HALVINGS {
        let thirds = [(2.0 * from + to) / 3.0, (from + 2.0 * to) / 3.0];
        if off(thirds[0]) < off(thirds[1]) { to = thirds[1] } else { from = thirds[0] }
    }
    let a = 0.5 * (from + to);
    (PerDrive::from([a]), off(a))
}
