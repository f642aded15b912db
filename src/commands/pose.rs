//! `stillbase pose`

use clap::Args;
use serde::Serialize;
use stillbase_mechanics::planar::Vector;
use stillbase_planning::common::nearest_place;
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::{BSet, Decimal, NoReach};
use stillbase_session::Proposal;
use stillbase_session::scenario::POSE_CONSTANT_RANGE;
use stillbase_study::pose_measures::PoseMeasures;

use super::failure::Failure;
use super::input::{MachineArgument, point, pose_constant, pose_space};
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

#[derive(Serialize)]
struct Answer {
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
        let command = |at: String, b: String| format!("stillbase pose {machine} {at} --b {b}{json}");
        let of = |p: Vector| {
            let set = space.reach(p).ok()?;
            let inner =
                [0.0, 1e-9, 1e-6, 1e-3, 0.5].map(|share| set.nearest(self.b).map(|b| set.moved_inside(b, share)));
            // At the ends of the range of b, the nearest one may lie a period inside.
            let turns = [0.0, -space.period(), space.period()];
            let all = turns.into_iter().flat_map(|turn| inner.into_iter().flatten().map(move |b| b + turn));
            let serves = |b: f64| POSE_CONSTANT_RANGE.contains(b) && space.reaches(p, b);
            all.into_iter().find_map(|b| Decimal::shortest_passing(b, 4, serves))
        };
        let at = |[x, y]: &[Decimal; 2]| (format!("{x},{y}"), Vector::new(x.value(), y.value()));
        let another_b = of(p).map(|b| {
            Proposal::of_command(format!("take b = {b} rad"), command(format!("{},{}", p.re, p.im), b.to_string()))
        });
        let at_b = nearest_place(space, p, Some(self.b)).map(|to| {
            let text = format!("take the nearest point of b = {} rad, ({}, {}) m", self.b, to[0], to[1]);
            Proposal::of_command(text, command(at(&to).0, self.b.to_string()))
        });
        let anywhere = || {
            let to = nearest_place(space, p, None)?;
            let (typed, place) = at(&to);
            let b = of(place)?;
            let text = format!("take the nearest point of all, ({}, {}) m, at b = {b} rad", to[0], to[1]);
            Some(Proposal::of_command(text, command(typed, b.to_string())))
        };
        let nearer = if another_b.is_some() { None } else { anywhere() };
        another_b.into_iter().chain(nearer).chain(at_b).collect()
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
