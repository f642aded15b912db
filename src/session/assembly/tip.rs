//! [`TipPath`]: a path of the last platform of blocks that carry each other, with a choice for the freedoms that it leaves.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::file::holding;
use crate::gentle_motion::gentle_motion;
use crate::scenario::{POINT_RANGE, POSE_CONSTANT_RANGE};
use nalgebra::{DVector, Vector3};
use stillbase_mechanics::assembly::{Assembly, BlockState, MAX_BLOCKS};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::curves::given::MAX_SAMPLES;
use stillbase_planning::curves::{Path, Samples};
use stillbase_planning::platform::{ChainBlock, FreedomChoice, PlatformChain, StopReason, Stopped, follow, pose_at};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::timing::{Profile, TimeLaw};
use stillbase_planning::{Motion, Reference};
use stillbase_settings::key::Key;
use stillbase_settings::keyed::keyed;
use stillbase_settings::number::significant;
use stillbase_settings::range::{Range, quote_clipped};
use stillbase_settings::word::{Choice, words};

/// Number of instants of each leg: the first try, and the most.
const INSTANTS: [usize; 2] = [120, 1920];

/// Least number of instants of each leg of a long path.
const LEAST_INSTANTS: usize = 30;

/// Largest distance of the end effector from its path between two instants, m.
const PATH_TOLERANCE: f64 = 1e-7;

/// Number of instants in each interval at which limits are checked.
const CHECKS: usize = 8;

/// Factor on the least time, for what torques do between these instants.
const TIME_MARGIN: f64 = 1.0005;

/// Range of the time.
const TIME: Range = Range::new(1e-3, 3600.0, "s");

words! {
    /// Time law of each leg of a path in space.
    pub enum TipLaw {
        Quintic = "quintic", "Quintic", "A polynomial of the fifth degree";
        Septic = "septic", "Septic", "A polynomial of the seventh degree, without jerk at its ends";
    }
}

impl TipLaw {
    fn law(self) -> TimeLaw {
        match self {
            Self::Quintic => TimeLaw::Quintic,
            Self::Septic => TimeLaw::Septic,
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
        time: Option<f64> = Key::NONE, range: TIME, instead: "the least that keeps all limits of the drives";
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

fn wrong<T>(key: &'static str, said: impl Into<String>) -> Result<T, TipError> {
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
    /// Returns the chain of blocks that carry each other, the one on the base first; each holds the b that is stated or, without one, that of its pose.
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
            let axis = |column: usize| own.mount.axes.column(column).into_owned();
            let offset = own.mount.at + axis(2) * own.platform_height();
            parts.push(ChainBlock::new(Arc::new(space), b, offset, [axis(0), axis(1)]));
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
            None => {
                let depth = |i: usize| {
                    let mut at = assembly.blocks()[i].mount.on;
                    let mut depth = 0;
                    while let Some(on) = at {
                        (at, depth) = (assembly.blocks()[on].mount.on, depth + 1);
                    }
                    depth
                };
                let ends = (0..assembly.blocks().len()).filter(|i| assembly.carried_by(Some(*i)).next().is_none());
                // The first of the longest chains.
                ends.max_by_key(|i| (depth(*i), std::cmp::Reverse(*i))).map_or_else(|| wrong("block", "no block"), Ok)
            }
        }
    }

    /// Returns the places of the blocks that it leads, the one on the base first.
    ///
    /// # Errors
    /// If there is no such block.
    pub(super) fn chain(&self, assembly: &Assembly) -> Result<Vec<usize>, TipError> {
        let mut blocks = vec![self.block(assembly)?];
        while let Some(on) = assembly.blocks()[blocks[blocks.len() - 1]].mount.on {
            blocks.push(on);
        }
        blocks.reverse();
        Ok(blocks)
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
        let of = TipChain::of(assembly, &self.chain(assembly)?, &self.b)?;
        let choice = self.choice;
        let near = |choice| if choice == FreedomChoice::MidRange { of.chain.middles().0 } else { of.near.clone() };
        let points = self.points(&of, &near(choice))?;
        let start = |choice| of.pose("from", &points[0].1, &near(choice), |_| true);
        let from = start(choice)?;
        // Each place by itself, so that the message names the one that is out of reach. A place that is proposed has a
        // way to it.
        for (i, (key, p)) in points.iter().enumerate().skip(1) {
            of.pose(key, p, &of.near, |proposed| {
                let mut points = points[..=i].to_vec();
                points[i].1 = *proposed;
                let (_, places) = self.instants(&points, law, INSTANTS[0]);
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
            let (u, places) = self.instants(&points, law, instants);
            let all = follow(&of.chain, choice, from.clone(), &places).or_else(|stopped| {
                let reached = &places[stopped.point - 1];
                let others = <FreedomChoice as Choice>::ALL.iter().copied().filter(|other| *other != choice);
                let mut others = others
                    .filter(|other| start(*other).is_ok_and(|from| follow(&of.chain, *other, from, &places).is_ok()));
                let mend = match others.next() {
                    Some(other) => format!("choice = \"{}\"", other.words().file),
                    None => "other points or another b".to_owned(),
                };
                let why = of.why(assembly, &stopped);
                wrong(
                    "to",
                    format!(
                        "is not reached with choice = \"{}\": at {} {why}; want {mend}",
                        choice.words().file,
                        typed(reached)
                    ),
                )
            })?;
            let angles: Vec<Vec<DriveAngles>> = all.iter().map(|a| of.chain.lift(a.as_slice())).collect();
            let samples = |whole: f64| -> Option<Vec<Samples>> {
                let of_block = |block: usize| {
                    let row = |(u, q): (&f64, &Vec<DriveAngles>)| [&[whole * u][..], &q[block]].concat();
                    Samples::new(&u.iter().zip(&angles).map(row).collect::<Vec<_>>()).ok()
                };
                (0..of.blocks.len()).map(of_block).collect()
            };
            let Some(unit) = samples(1.0) else { return wrong("to", "gives no motion: want other points") };
            let Some(motions) = unit
                .iter()
                .map(|own| Some(Motion { path: Path::Table(own.path(0.0)?), profile: Profile::running(1.0) }))
                .collect::<Option<Vec<_>>>()
            else {
                return wrong("to", "gives no motion: want other points");
            };
            if 2 * instants <= INSTANTS[1].min(most) && self.strays(&of, &points, law, &motions) > PATH_TOLERANCE {
                instants *= 2;
                continue;
            }
            let time = match self.time {
                Some(time) => time,
                None => least_time(assembly, &of.blocks, &motions, rest, u.len())?,
            };
            return match samples(time) {
                Some(samples) => Ok(TipPlan {
                    blocks: of.blocks,
                    samples,
                    points: points.iter().map(|(_, p)| (*p).into()).collect(),
                }),
                None => wrong("time", "is too short for its points: want a longer one"),
            };
        }
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

    /// Returns instants as shares of the time, and the place at each, m.
    fn instants(
        &self,
        points: &[(&'static str, Vector3<f64>)],
        law: TimeLaw,
        count: usize,
    ) -> (Vec<f64>, Vec<Vector3<f64>>) {
        let shares = Self::shares(points);
        let (mut times, mut places) = (vec![0.0], vec![points[0].1]);
        for (leg, pair) in points.windows(2).enumerate() {
            let (begin, run) = (shares[leg], shares[leg + 1] - shares[leg]);
            for i in 1..=count {
                let u = i as f64 / count as f64;
                times.push(begin + run * u);
                places.push(pair[0].1 + law.at(u, 1.0).s * (pair[1].1 - pair[0].1));
            }
        }
        (times, places)
    }

    /// Returns the largest distance of the end effector from its path midway between instants, m.
    fn strays(&self, of: &TipChain, points: &[(&'static str, Vector3<f64>)], law: TimeLaw, motions: &[Motion]) -> f64 {
        let (times, places) = self.instants(points, law, 2 * INSTANTS[0] + 1);
        let off = |(u, p): (&f64, &Vector3<f64>)| {
            let q: Vec<DriveAngles> = motions.iter().map(|motion| motion.at(*u).q).collect();
            (of.chain.place(&of.chain.angles(&q)) - p).norm()
        };
        times.iter().zip(&places).map(off).fold(0.0, f64::max)
    }
}

/// Returns the least time, s, in which motions over a unit of time keep all limits of their drives. Torques from motion and
/// accelerations fall with the square of the time, rates with the time, and torques from weight stay.
///
/// # Errors
/// If no drive has a limit, or weight alone passes one.
fn least_time(
    assembly: &Assembly,
    blocks: &[usize],
    motions: &[Motion],
    rest: &[DriveAngles],
    count: usize,
) -> Result<f64, TipError> {
    let none = PerDrive::zeros(0);
    let at_rest = |q: &DriveAngles| BlockState { q: *q, qd: PerDrive::zeros(q.len()), qdd: PerDrive::zeros(q.len()) };
    let mut states = [BlockState { q: DriveAngles(none), qd: none, qdd: none }; MAX_BLOCKS];
    states.iter_mut().zip(rest).for_each(|(state, q)| *state = at_rest(q));
    let (mut squared, mut is_limited) = (0.0_f64, false);
    for i in 0..=CHECKS * (count - 1) {
        let t = i as f64 / (CHECKS * (count - 1)) as f64;
        let (mut torques, mut weights) = ([none; MAX_BLOCKS], [none; MAX_BLOCKS]);
        for (place, motion) in blocks.iter().zip(motions) {
            states[*place] = at_rest(&motion.at(t).q);
        }
        assembly.loads(&states, |i, of| weights[i] = of.torque);
        for (place, motion) in blocks.iter().zip(motions) {
            let Reference { q, qd, qdd } = motion.at(t);
            states[*place] = BlockState { q, qd, qdd };
        }
        assembly.loads(&states, |i, of| torques[i] = of.torque);
        for place in blocks {
            let (block, state) = (&assembly.blocks()[*place], &states[*place]);
            let motors = block.inertia.motors();
            let [rates, accelerations] = [&state.qd, &state.qdd].map(|of| motors.to_motors(of));
            for (k, drive) in block.machine.spec().drives.iter().enumerate() {
                if let Some(limit) = drive.torque_limit {
                    let (weight, motion) = (weights[*place][k], torques[*place][k] - weights[*place][k]);
                    let room = limit - weight * motion.signum();
                    if limit <= weight.abs() {
                        let said = format!(
                            "weight alone asks {:.4} N m of drive {} of {}: want other points",
                            weight.abs(),
                            drive.name,
                            block.name
                        );
                        return wrong("time", said);
                    }
                    squared = squared.max(motion.abs() / room);
                    is_limited = true;
                }
                if let Some(limit) = drive.speed_limit {
                    squared = squared.max((rates[k].abs() / limit).powi(2));
                    is_limited = true;
                }
                if let Some(limit) = drive.acceleration_limit {
                    squared = squared.max(accelerations[k].abs() / limit);
                    is_limited = true;
                }
            }
        }
    }
    if !is_limited || squared == 0.0 {
        return wrong("time", "is not stated, and no drive of these blocks has a limit: want time, s");
    }
    Ok((TIME_MARGIN * squared.sqrt()).clamp(TIME.low(), TIME.high()))
}
