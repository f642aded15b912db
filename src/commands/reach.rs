//! `stillbase reach`

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::planar::Vector;
use stillbase_planning::common::{common_b_set, no_common};
use stillbase_planning::pose_constant::{PointCorrection, Unreachable};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::BSet;
use stillbase_session::{Proposal, ReachablePoints};

use super::failure::Failure;
use super::input::{MachineArgument, point, pose_space, typed_points};
use super::output::{Format, TextTable};
use stillbase_settings::number::fixed;

/// Find the pose constants b whose reactionless workspace contains each point, and those common to all points
///
/// A reactionless path joins two points if and only if the workspace of some b contains both. b lies on a circle:
/// turning every drive once adds the period. b_min lies in [0, period), and b_max may exceed the period; [0, period] is
/// the whole circle.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase reach nine-link 0.5,0.5 0.55,0.9
  stillbase reach nine-link -0.6,-0.2 --set limits.a1=0.4,2.7")]
pub struct ReachArguments {
    #[command(flatten)]
    machine: MachineArgument,
    /// Points of the end effector in base axes, m
    #[arg(value_name = "X,Y", required = true, value_parser = point)]
    points: Vec<Vector>,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    points: Vec<OfPoint>,
    overlap: Vec<[f64; 2]>,
    period: f64,
    /// The smallest move of one point that gives all points a common b, if they have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    mend: Option<PointCorrection>,
    /// Command lines whose points have a common b, if these have none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    proposals: Vec<Proposal>,
}

#[derive(JsonSchema, Serialize)]
struct OfPoint {
    point: [f64; 2],
    intervals: Vec<[f64; 2]>,
}

impl ReachArguments {
    /// Prints the intervals of b of each point and of all points. Fails if the points have no b in common.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let space = pose_space(&machine)?;
        let mut sets = Vec::with_capacity(self.points.len());
        for p in &self.points {
            let none = |reason| {
                let failure = Failure::from(Unreachable::Anywhere { x: p.re, y: p.im, reason });
                failure.with_proposals(self.mended(&space).into_iter().collect())
            };
            sets.push(space.reach(*p).map_err(none)?);
        }
        let overlap = common_b_set(&space, &self.points).map_or_else(Vec::new, |set| set.intervals);
        let apart = overlap.is_empty();
        let why = if apart { no_common(&space, &self.points) } else { None };
        let of_point = |(p, set): (&Vector, BSet)| OfPoint { point: [p.re, p.im], intervals: set.intervals };
        let answer = Answer {
            points: self.points.iter().zip(sets).map(of_point).collect(),
            overlap,
            period: space.period(),
            mend: why.and_then(|why| why.correction),
            proposals: why.and_then(|_| self.mended(&space)).into_iter().collect(),
        };
        self.format.print(&answer, table)?;
        let said = || why.map_or("no b serves all points".into(), |w| w.in_words(&point_name));
        match apart {
            true => Err(Failure::no_answer(said()).with_proposals(answer.proposals)),
            false => Ok(()),
        }
    }

    /// Returns the command line with points moved so that all have a common b.
    fn mended(&self, space: &PoseSpace) -> Option<Proposal> {
        let way = ReachablePoints::with_common_b(space, &self.points)?;
        let json = if self.format.json { " --json" } else { "" };
        let (machine, points) = (self.machine.as_typed(), typed_points(&self.points, &way));
        let text = way.moves_in_words(&point_name);
        Some(Proposal::of_command(text, format!("stillbase reach {machine} {points}{json}")))
    }
}

/// Returns the name of a point by its index, counted from 0.
fn point_name(i: usize) -> String {
    format!("point {}", i + 1)
}

/// Rounds the bounds of an interval of b, rad, inwards to a number of decimals, so that both stay feasible. The bounds
/// of a single b, or of a whole period, are rounded to the nearest decimal.
fn inward([from, to]: [f64; 2], decimals: usize, period: f64) -> [String; 2] {
    let last = 10f64.powi(-(decimals as i32));
    let printed = |x: f64| fixed(x, decimals);
    let is_one_or_all = to - from < 2.0 * last || to - from > period - last;
    let beyond = |x: f64, inwards: f64| {
        let rounded = printed(x).parse().unwrap_or(x);
        let leaves = !is_one_or_all && inwards * (rounded - x) < 0.0;
        printed(if leaves { x + inwards * last } else { x })
    };
    [beyond(from, 1.0), beyond(to, -1.0)]
}

fn table(answer: &Answer) -> String {
    let mut table = TextTable::new(["point m", "b_min rad", "b_max rad"]);
    let mut rows = |name: String, intervals: &[[f64; 2]]| {
        let first = [name].into_iter().chain(std::iter::repeat(String::new()));
        for (name, [from, to]) in first.zip(intervals) {
            let [from, to] = inward([*from, *to], 9, answer.period);
            table.row([name, from, to]);
        }
    };
    for p in &answer.points {
        rows(format!("{}, {}", p.point[0], p.point[1]), &p.intervals);
    }
    rows("all".into(), &answer.overlap);
    format!("{table}\nperiod {} rad\n", fixed(answer.period, 9))
}
