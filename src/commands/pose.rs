//! `stillbase pose`

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::planar::Vector;
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::{BSet, NoReach};
use stillbase_session::{Proposal, ReachablePoints};
use stillbase_study::pose_measures::PoseMeasures;

use super::failure::Failure;
use super::input::{MachineArgument, point, pose_constant, pose_space, typed_points};
use super::output::{Format, TextTable};
use stillbase_settings::number::fixed;

/// List the poses on the plane b = const that put the end effector on a point, with measures of each
///
/// Drive angles q are absolute and unwrapped: Σ λ_k q_k is b exactly as given. With --json each pose also has measures.
/// det is |det ∂(x, y)/∂(a_1, a_2)| (m²), 0 on a fold. manipulability is √det(J Jᵀ) of the Jacobian in absolute drive
/// angles (m²). worst_torque_per_force is the largest singular value of J (N m/N). transmission is
/// min |sin(q_k − q_l)|, 0 at a change point. side is the signs of sin(q_2 − q_1), sin(q_3 − q_2) and sin(q_3 − q_1).
/// det and side exist for three drives only. With four or more drives, many poses reach a point; the answer is the one
/// with minimum Σ (a_i − middle_i)². There middle_i is the middle of the limits of the relative angle a_i, rad.
#[derive(Args)]
#[command(after_help = "\
Example:
  stillbase pose nine-link 0.5,0.5 --b 2.4")]
pub struct PoseArguments {
    #[command(flatten)]
    machine: MachineArgument,
    /// Point of the end effector in base axes, m
    #[arg(value_name = "X,Y", value_parser = point)]
    point: Vector,
    /// Pose constant b, rad
    #[arg(long, value_name = "B", value_parser = pose_constant)]
    b: f64,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    poses: Vec<PoseMeasures>,
}

impl PoseArguments {
    /// Prints every pose. Fails if there is none.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let space = pose_space(&machine)?;
        let poses = PoseMeasures::all(&machine, &space, self.point, self.b);
        if poses.is_empty() {
            let failure = Failure::from(self.no_pose(space.reach(self.point)));
            return Err(failure.with_proposals(self.ways_out(&space)));
        }
        self.format.print(&Answer { poses }, |answer| {
            let drives = (1..=space.drives()).map(|k| format!("q_{k} rad"));
            let names = machine.angles().iter().map(|a| format!("{} rad", a.name));
            let mut table = TextTable::new(["pose".to_owned()].into_iter().chain(drives).chain(names));
            for (i, pose) in answer.poses.iter().enumerate() {
                let numbers = pose.q.iter().chain(&pose.a).map(|x| fixed(*x, 9));
                table.row([(i + 1).to_string()].into_iter().chain(numbers));
            }
            table.to_string()
        })
    }

    /// Returns command lines that have an answer: at the nearest b, and for the nearest point.
    fn ways_out(&self, space: &PoseSpace) -> Vec<Proposal> {
        let (p, machine) = (self.point, self.machine.as_typed());
        let json = if self.format.json { " --json" } else { "" };
        let another_b = ReachablePoints::at_nearest_b(space, p, self.b);
        let anywhere = || ReachablePoints::at_any_b(space, p, self.b);
        let nearer = if another_b.is_empty() { anywhere() } else { None };
        let at_b = ReachablePoints::at_b(space, &[p], 0, self.b);
        let rendered = |way: ReachablePoints| {
            let b = way.b.map_or_else(|| self.b.to_string(), |b| b.to_string());
            let text = match (way.place_of(0), way.b) {
                (None, _) => format!("take b = {b} rad"),
                (Some([x, y]), None) => format!("take the nearest point of b = {b} rad, ({x}, {y}) m"),
                (Some([x, y]), Some(_)) => format!("take the nearest point of all, ({x}, {y}) m, at b = {b} rad"),
            };
            let at = typed_points(&[p], &way);
            Proposal::of_command(text, format!("stillbase pose {machine} {at} --b {b}{json}"))
        };
        another_b.into_iter().chain(nearer).chain(at_b).map(rendered).collect()
    }

    fn no_pose(&self, set: Result<BSet, NoReach>) -> Unreachable {
        let (x, y, b) = (self.point.re, self.point.im, self.b);
        match set {
            Err(reason) => Unreachable::Anywhere { x, y, reason },
            Ok(set) => {
                let nearest_b = set.nearest(self.b);
                let displayed_b = nearest_b.and_then(|b| set.decimal(b, 4));
                Unreachable::OnThisPlane { x, y, b, feasible: set.in_words(), nearest_b, displayed_b }
            }
        }
    }
}
