//! `stillbase pose`

use clap::Args;
use serde::Serialize;
use stillbase::planar::Vector;
use stillbase::pose_constant::{Unreachable, in_words};
use stillbase::reactionless::{PlaneMap, PlanePoint};

use super::failure::Failure;
use super::input::{MachineArgument, planes_of, point, pose_constant};
use super::output::{Format, Table, fixed};

/// The poses that put the end effector on a point without leaving the plane b = const
///
/// Drive angles q are absolute and unwrapped: Σ λ_k q_k is b exactly as given.
#[derive(Args)]
#[command(after_help = "\
Example:
  stillbase pose nine-link 0.5,0.5 --b 2.4")]
pub struct Pose {
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
    poses: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    q: [f64; 3],
    a: [f64; 2],
}

impl Pose {
    /// Prints every pose; none is no answer.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let map = planes_of(&machine)?;
        let row = |p: &PlanePoint| Row { q: map.lift(*p), a: p.a };
        let poses: Vec<Row> = map.poses(self.point, self.b).iter().map(row).collect();
        if poses.is_empty() {
            return Err(self.why_not(&map).into());
        }
        self.format.print(&Answer { poses }, |answer| {
            let names = machine.angles().iter().map(|a| format!("{} rad", a.name));
            let head = ["pose", "q_1 rad", "q_2 rad", "q_3 rad"].map(String::from);
            let mut table = Table::new(head.into_iter().chain(names));
            for (i, pose) in answer.poses.iter().enumerate() {
                let numbers = pose.q.iter().chain(&pose.a).map(|x| fixed(*x, 9));
                table.row([(i + 1).to_string()].into_iter().chain(numbers));
            }
            table.to_string()
        })
    }

    fn why_not(&self, map: &PlaneMap) -> Unreachable {
        let (x, y, b) = (self.point.re, self.point.im, self.b);
        match map.reach(self.point) {
            Err(reason) => Unreachable::Anywhere { x, y, reason },
            Ok(set) => Unreachable::OnThisPlane { x, y, b, would_do: in_words(&set) },
        }
    }
}
