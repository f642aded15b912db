//! [`TipPath`]: a path of the last platform of blocks that carry each other, with a choice for the freedoms that it leaves.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::file::holding;
use super::tip_time::{EASED_INSTANTS, TIME, fastest_leg, least_time};
use crate::gentle_motion::gentle_motion;
use crate::scenario::{POINT_RANGE, POSE_CONSTANT_RANGE};
use nalgebra::{DVector, Vector3};
use stillbase_mechanics::assembly::Assembly;
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::Motion;
use stillbase_planning::curves::given::MAX_SAMPLES;
use stillbase_planning::curves::{Path, Samples};
use stillbase_planning::platform::{ChainBlock, FreedomChoice, PlatformChain, StopReason, Stopped, follow, pose_at};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::timing::{Profile, TimeLaw};
use stillbase_settings::key::Key;
use stillbase_settings::keyed::keyed;
use stillbase_settings::number::significant;
use stillbase_settings::range::quote_clipped;
use stillbase_settings::word::{Choice, words};

/// Number of instants of each leg: the first try, and the most.
const INSTANTS: [usize; 2] = [120, 1920];

/// Least number of instants of each leg of a long path.
const LEAST_INSTANTS: usize = 30;

/// Largest distance of the end effector from its path between two instants, m.
const PATH_TOLERANCE: f64 = 1e-7;

words! {
    /// Time law of each leg of a path in space.
    pub enum TipLaw {
        Quintic = "quintic", "Quintic", "A polynomial of the fifth degree";
        Septic = "septic", "Septic", "A polynomial of the seventh degree, without jerk at its ends";
        Fastest = "fastest", "Fastest", "As fast as torque, speed and acceleration limits allow";
    }
}

impl TipLaw {
    fn law(self) -> TimeLaw {
        match self {
            Self::Quintic => TimeLaw::Quintic,
            Self::Septic => TimeLaw::Septic,
            Self::Fastest => TimeLaw::Fastest,
        }
    }
}

keyed! {
    /// A path of the end effector of a block in axes of the base, while each block of its chain holds its b.
    #[derive(Clone, Debug, PartialEq)]
    pub struct TipPath at "tip" {
        /// Block whose end effector goes along the path; all blocks that carry it go along.
        block: Option<String> = Key::NONE, instead: "the last block that nothing sits on";
        /// Where the path begins, in axes of the base.
        from: Option<[f64; 3]> = Key::NONE, range: POINT_RANGE,
            instead: "where the blocks are in their poses, or in the middle of their ranges";
        /// Points between at which the end effector rests, in order.
        via: Vec<[f64; 3]> = "[]", range: POINT_RANGE;
        /// Where the path ends, in axes of the base.
        to: Option<[f64; 3]> = Key::REQUIRED, range: POINT_RANGE;
        /// Whether the path returns to its begin.
        closed: bool = "false";
        /// Duration of the whole path.
        time: Option<f64> = Key::NONE, range: TIME, instead: "the least that keeps limits on torque, speed and acceleration",
            when: "another law: the fastest one finds the time" => |tip| tip.law != TipLaw::Fastest;
        /// Time law of each leg.
        law: TipLaw = "quintic";
        /// What the blocks do with freedoms that are left.
        choice: FreedomChoice = "least-rates";
        named:
        /// Pose constant that a block holds on the way.
        b: BTreeMap<String, f64> = Key::NONE, range: POSE_CONSTANT_RANGE, instead: "that of its pose";
    }
}

/// Why a path of the end effector is no task: the key, and what would be right.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct TipError {
    /// Key in the table of the path.
    pub key: &'static str,
    /// What is wrong.
    pub said: String,
}

pub(super) fn wrong<T>(key: &'static str, said: impl Into<String>) -> Result<T, TipError> {
    Err(TipError { key, said: said.into() })
}

/// Returns a list of three numbers as it is typed.
fn typed(p: &Vector3<f64>) -> String {
    let [x, y, z] = rounded(p).into();
    format!("[{x}, {y}, {z}]")
}

/// Returns a place to a tenth of a millimetre.
fn rounded(p: &Vector3<f64>) -> Vector3<f64> {
    p.map(|x| (x * 1e4).round() / 1e4 + 0.0)
}

/// What a path asks of the blocks of its chain.
#[derive(Clone, Debug)]
pub(super) struct TipPlan {
    /// Places of the blocks of the chain in the assembly, the one on the base first.
    pub blocks: Vec<usize>,
    /// Drive angles of each over time.
    pub samples: Vec<Samples>,
    /// The points of the path in order, m, in axes of the base.
    pub points: Vec<[f64; 3]>,
}

/// The chain that carries a block.
pub(super) struct TipChain {
    blocks: Vec<usize>,
    chain: PlatformChain,
    /// Angles near which the first pose is sought, rad.
    near: DVector<f64>,
}

impl TipChain {
    /// Returns the chain of blocks that carry each other, the one on the base first; each holds the b that is stated or,
    /// without one, that of its pose.
    ///
    /// # Errors
    /// If a block has no b.
    pub fn of(assembly: &Assembly, blocks: &[usize], b: &BTreeMap<String, f64>) -> Result<Self, TipError> {
        let (mut parts, mut near) = (Vec::new(), Vec::new());
        for i in blocks {
            let own = &assembly.blocks()[*i];
            let machine = holding(assembly, *i).or_else(|why| wrong("block", why))?;
            let space = PoseSpace::of(&machine);
            let space = space.or_else(|why| wrong("block", format!("block {} cannot hold a b: {why}", own.name)))?;
            let pose = own.machine.spec().pose.as_ref();
            let pose = pose
                .filter(|pose| pose.len() == machine.drives())
                .map(|pose| PerDrive::from_fn(pose.len(), |k| pose[k]));
            let b = match (b.get(&own.name), &pose) {
                (Some(b), _) => *b,
                (None, Some(pose)) => space.b(pose),
                (None, None) => match gentle_motion(&machine) {
                    Ok(made) => made.task.b,
                    Err(_) => return wrong("b", format!("want b of {}, rad", own.name)),
                },
            };
            let near_own = pose.map_or_else(|| space.middle(), |pose| space.angles(&pose));
            near.extend(near_own.iter().copied());
            parts.push(ChainBlock::of(own, Arc::new(space), b));
        }
        Ok(Self { blocks: blocks.to_vec(), chain: PlatformChain::new(parts), near: DVector::from_vec(near) })
    }

    /// Returns the angles at a place near some; of a place that is not reached, says which one is.
    fn pose(
        &self,
        key: &'static str,
        p: &Vector3<f64>,
        near: &DVector<f64>,
        serves: impl Fn(&Vector3<f64>) -> bool,
    ) -> Result<DVector<f64>, TipError> {
        pose_at(&self.chain, p, near).or_else(|nearest| {
            let (middle, _) = self.chain.middles();
            // A place beside the nearest one, away from limits and stretched arms.
            let inner = nearest.angles;
            let shares = [0.0, 0.01, 0.03, 0.1, 0.3, 0.6];
            let reached = shares
                .iter()
                .map(|share| rounded(&self.chain.place((&inner + *share * (&middle - &inner)).as_slice())));
            let reached = reached.into_iter().find(|p| pose_at(&self.chain, p, near).is_ok() && serves(p));
            let mend = reached.map_or_else(String::new, |p| format!(", as {}", typed(&p)));
            let said = format!(
                "is not reached at these b: the nearest place that was found is {} m away; want a place in reach{mend}",
                significant(nearest.distance)
            );
            wrong(key, said)
        })
    }

    /// Says why a path stops.
    fn why(&self, assembly: &Assembly, stopped: &Stopped) -> String {
        match stopped.why {
            StopReason::Limit { block, angle } => {
                let own = &assembly.blocks()[self.blocks[block]];
                let joint = self.chain.blocks()[block].space().joints()[angle].angle();
                let name = joint.map_or_else(|| (angle + 1).to_string(), |i| own.machine.angles()[i].name.clone());
                format!("angle {name} of {} comes to its limit", own.name)
            }
            StopReason::Singular => "no rates of the drives lead on".to_owned(),
        }
    }
}

impl TipPath {
    /// Returns the block whose end effector it leads.
    ///
    /// # Errors
    /// If there is no such block.
    fn block(&self, assembly: &Assembly) -> Result<usize, TipError> {
        match &self.block {
            Some(name) => match assembly.blocks().iter().position(|block| block.name == *name) {
                Some(found) => Ok(found),
                None => {
                    let names: Vec<&str> = assembly.blocks().iter().map(|block| block.name.as_str()).collect();
                    let name = quote_clipped(name);
                    wrong("block", format!("names no block {name:?}: want one of {}", names.join(", ")))
                }
            },
            None => assembly.longest_chain().last().copied().map_or_else(|| wrong("block", "no block"), Ok),
        }
    }

    /// Returns the places of the blocks that it leads, the one on the base first.
    ///
    /// # Errors
    /// If there is no such block.
    pub(super) fn chain(&self, assembly: &Assembly) -> Result<Vec<usize>, TipError> {
        Ok(assembly.chain(self.block(assembly)?))
    }

    fn points(&self, of: &TipChain, near: &DVector<f64>) -> Result<Vec<(&'static str, Vector3<f64>)>, TipError> {
        let via = self.via.iter().map(|p| ("via", *p));
        let own = of.chain.place(near.as_slice());
        let from = self.from.unwrap_or(own.into());
        let Some(to) = self.to else {
            return wrong("to", format!("want a place, m; in its pose the end effector is at {}", typed(&own)));
        };
        let mut all: Vec<_> = [("from", from)].into_iter().chain(via).chain([("to", to)]).collect();
        all.extend(self.closed.then_some(("from", from)));
        if let Some(pair) = all.windows(2).find(|pair| pair[0].1 == pair[1].1) {
            return wrong(pair[1].0, format!("is {:?}, as the point before: want another place", pair[1].1));
        }
        Ok(all.into_iter().map(|(key, p)| (key, Vector3::from(p))).collect())
    }

    /// Plans the motion of all blocks of the chain; `rest` are the drive angles at which other blocks are, rad.
    ///
    /// # Errors
    /// If a place is not reached, or the way to it; the error says what would be.
    pub(super) fn plan(&self, assembly: &Assembly, rest: &[DriveAngles]) -> Result<TipPlan, TipError> {
        let law = self.law.law();
        let progress = |u: f64| if law.is_fastest() { u } else { law.at(u, 1.0).s };
        let of = TipChain::of(assembly, &self.chain(assembly)?, &self.b)?;
        let choice = self.choice;
        let near = |choice| if choice == FreedomChoice::MidRange { of.chain.middles().0 } else { of.near.clone() };
        let points = self.points(&of, &near(choice))?;
        let from = of.pose("from", &points[0].1, &near(choice), |_| true)?;
        // Each place by itself, so that the message names the one that is out of reach. A place that is proposed has a
        // way to it.
        for (i, (key, p)) in points.iter().enumerate().skip(1) {
            of.pose(key, p, &of.near, |proposed| {
                let mut points = points[..=i].to_vec();
                points[i].1 = *proposed;
                let (_, places) = Self::instants(&points, progress, INSTANTS[0]);
                points[i - 1].1 != *proposed && follow(&of.chain, choice, from.clone(), &places).is_ok()
            })?;
        }
        let legs = points.len() - 1;
        let most = (MAX_SAMPLES - 1) / legs;
        if most < LEAST_INSTANTS {
            let count = (MAX_SAMPLES - 1) / LEAST_INSTANTS - 1;
            return wrong("via", format!("{} points: want at most {count}", self.via.len()));
        }
        let mut instants = INSTANTS[0].min(most);
        loop {
            let (u, places) = Self::instants(&points, progress, instants);
            let all = self.followed(&of, assembly, (choice, &from), &places)?;
            let mut even = Instants { u, angles: all.iter().map(|a| of.chain.lift(a.as_slice())).collect() };
            let legs: Vec<Instants> = match law.is_fastest() {
                true => (0..legs).map(|leg| even.leg(leg * instants..(leg + 1) * instants + 1)).collect(),
                false => vec![even.clone()],
            };
            let motions: Option<Vec<Vec<Motion>>> = legs.iter().map(Instants::motions).collect();
            let nowhere = || wrong("to", "gives no motion: want other points");
            let Some(motions) = motions else { return nowhere() };
            let strays = motions.iter().enumerate().map(|(leg, motions)| {
                let points = if law.is_fastest() { &points[leg..leg + 2] } else { &points[..] };
                strays(&of, points, progress, motions)
            });
            if 2 * instants <= INSTANTS[1].min(most) && strays.fold(0.0, f64::max) > PATH_TOLERANCE {
                instants *= 2;
                continue;
            }
            if law.is_fastest() {
                let count = EASED_INSTANTS.min(most);
                let timed = motions.iter().map(|motions| fastest_leg(assembly, &of.blocks, motions, rest, count));
                even = Instants::timed(&motions, &timed.collect::<Result<Vec<_>, _>>()?);
            }
            let time = match self.time.filter(|_| !law.is_fastest()) {
                Some(time) => time,
                None => {
                    let Some(motions) = even.motions() else { return nowhere() };
                    least_time(assembly, &of.blocks, &motions, rest, even.u.len())?
                }
            };
            return match even.samples(time) {
                Some(samples) => Ok(TipPlan {
                    blocks: of.blocks,
                    samples,
                    points: points.iter().map(|(_, p)| (*p).into()).collect(),
                }),
                None => wrong("time", "is too short for its points: want a longer one"),
            };
        }
    }

    /// Returns the angles of the chain at places along the path.
    ///
    /// # Errors
    /// If the path is not followed to its end; the error says with which choice it is.
    fn followed(
        &self,
        of: &TipChain,
        assembly: &Assembly,
        (choice, from): (FreedomChoice, &DVector<f64>),
        places: &[Vector3<f64>],
    ) -> Result<Vec<DVector<f64>>, TipError> {
        follow(&of.chain, choice, from.clone(), places).or_else(|stopped| {
            let start = |choice| {
                let near = if choice == FreedomChoice::MidRange { of.chain.middles().0 } else { of.near.clone() };
                of.pose("from", &places[0], &near, |_| true)
            };
            let reached = &places[stopped.point - 1];
            let others = <FreedomChoice as Choice>::ALL.iter().copied().filter(|other| *other != choice);
            let mut others =
                others.filter(|other| start(*other).is_ok_and(|from| follow(&of.chain, *other, from, places).is_ok()));
            let mend = match others.next() {
                Some(other) => format!("choice = \"{}\"", other.words().file),
                None => "other points or another b".to_owned(),
            };
            let why = of.why(assembly, &stopped);
            let said = format!(
                "is not reached with choice = \"{}\": at {} {why}; want {mend}",
                choice.words().file,
                typed(reached)
            );
            wrong("to", said)
        })
    }

    /// Returns the shares of the time at which each leg begins, and at which the last ends.
    fn shares(points: &[(&'static str, Vector3<f64>)]) -> Vec<f64> {
        let lengths = points.windows(2).map(|pair| (pair[1].1 - pair[0].1).norm());
        let mut all = vec![0.0];
        all.extend(lengths.scan(0.0, |sum, length| {
            *sum += length;
            Some(*sum)
        }));
        let whole = all[all.len() - 1];
        all.into_iter().map(|x| x / whole).collect()
    }

    /// Returns instants as shares of the time, and the place at each, m; `progress` is that along a leg over its time.
    fn instants(
        points: &[(&'static str, Vector3<f64>)],
        progress: impl Fn(f64) -> f64,
        count: usize,
    ) -> (Vec<f64>, Vec<Vector3<f64>>) {
        let shares = Self::shares(points);
        let (mut times, mut places) = (vec![0.0], vec![points[0].1]);
        for (leg, pair) in points.windows(2).enumerate() {
            let (begin, run) = (shares[leg], shares[leg + 1] - shares[leg]);
            for i in 1..=count {
                let u = i as f64 / count as f64;
                times.push(begin + run * u);
                places.push(pair[0].1 + progress(u) * (pair[1].1 - pair[0].1));
            }
        }
        (times, places)
    }
}

/// Returns the largest distance of the end effector from its path midway between instants, m.
fn strays(
    of: &TipChain,
    points: &[(&'static str, Vector3<f64>)],
    progress: impl Fn(f64) -> f64,
    motions: &[Motion],
) -> f64 {
    let (times, places) = TipPath::instants(points, progress, 2 * INSTANTS[0] + 1);
    let off = |(u, p): (&f64, &Vector3<f64>)| {
        let q: Vec<DriveAngles> = motions.iter().map(|motion| motion.at(*u).q).collect();
        (of.chain.place(&of.chain.angles(&q)) - p).norm()
    };
    times.iter().zip(&places).map(off).fold(0.0, f64::max)
}

/// Drive angles of the blocks of a chain at instants.
#[derive(Clone, Debug)]
struct Instants {
    /// Shares of the time, from 0 to 1.
    u: Vec<f64>,
    /// Angles of each block, at each instant, rad.
    angles: Vec<Vec<DriveAngles>>,
}

impl Instants {
    /// Returns some of the instants, as a motion of their own.
    fn leg(&self, range: std::ops::Range<usize>) -> Self {
        let (u, angles) = (&self.u[range.clone()], self.angles[range].to_vec());
        let (begin, end) = (u[0], u[u.len() - 1]);
        Self { u: u.iter().map(|u| (u - begin) / (end - begin)).collect(), angles }
    }

    /// Returns instants of legs one after the other; `times` are those of each leg, s, with shares of it.
    fn timed(legs: &[Vec<Motion>], times: &[Vec<[f64; 2]>]) -> Self {
        let (mut all, mut begin) = (Self { u: Vec::new(), angles: Vec::new() }, 0.0);
        for (motions, times) in legs.iter().zip(times) {
            // A leg begins where the one before has ended.
            let first = usize::from(!all.u.is_empty());
            for [t, s] in &times[first..] {
                all.u.push(begin + t);
                all.angles.push(motions.iter().map(|motion| motion.at(s.clamp(0.0, 1.0)).q).collect());
            }
            begin = all.u[all.u.len() - 1];
        }
        all.u.iter_mut().for_each(|u| *u /= begin);
        all
    }

    /// Returns the samples of each block over a time, s; `None` if they are no motion.
    fn samples(&self, whole: f64) -> Option<Vec<Samples>> {
        let of_block = |block: usize| {
            let row = |(u, q): (&f64, &Vec<DriveAngles>)| [&[whole * u][..], &q[block]].concat();
            Samples::new(&self.u.iter().zip(&self.angles).map(row).collect::<Vec<_>>()).ok()
        };
        (0..self.angles.first()?.len()).map(of_block).collect()
    }

    /// Returns the motion of each block over a unit of time.
    fn motions(&self) -> Option<Vec<Motion>> {
        let motion = |own: &Samples| Some(Motion { path: Path::Table(own.path(0.0)?), profile: Profile::running(1.0) });
        self.samples(1.0)?.iter().map(motion).collect()
    }
}
