//! `stillbase pose`

use clap::Args;
use serde::Serialize;
use stillbase::mechanics::kinematics::least_transmission;
use stillbase::mechanics::machine::Machine;
use stillbase::mechanics::planar::{DriveAngles, Vector};
use stillbase::planning::pose_constant::Unreachable;
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::reactionless::{BSet, NoReach, PlaneMap, PlanePoint};

use super::failure::Failure;
use super::input::{MachineArgument, point, pose_constant, pose_space};
use super::output::{Format, Table};
use stillbase::settings::number::fixed;

/// The poses that put the end effector on a point without leaving the plane b = const, and what each is good for
///
/// Drive angles q are absolute and unwrapped: Σ λ_k q_k is b exactly as given. With --json each pose also has
/// det = |det ∂(x, y)/∂(a_1, a_2)| (m²), 0 on a fold; manipulability = √det(J Jᵀ) of the Jacobian in absolute drive
/// angles (m²); worst_torque_per_force, the largest singular value of J (N m/N); transmission = min |sin(q_k − q_l)|,
/// 0 at a change point; and side, the signs of sin(q_2 − q_1), sin(q_3 − q_2) and sin(q_3 − q_1). det and side are of three
/// drives. Four and more can take a point in many ways: of these it is the pose with the least Σ (a_i − middle_i)², the
/// relative angles' distances from the middle of their limits, rad.
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

/// A pose and its measures; some of them planes alone have.
#[derive(Serialize)]
pub struct Row {
    q: Vec<f64>,
    pub a: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub det: Option<f64>,
    pub manipulability: f64,
    pub worst_torque_per_force: f64,
    pub transmission: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<[i8; 3]>,
}

/// Sines below this are a change point's.
const AT_CHANGE: f64 = 1e-9;

impl Row {
    /// The poses of a point, with their measures: where a point leaves freedoms the one nearest to the middle of the
    /// limits, else all.
    pub fn all(machine: &Machine, space: &PoseSpace, p: Vector, b: f64) -> Vec<Self> {
        match space.planes() {
            Ok(planes) => {
                let map = planes.map();
                map.poses(p, b).iter().map(|pose| Self::on_plane(map, *pose)).collect()
            }
            Err(_) => space.poses(p, b, &space.middle()).iter().map(|q| Self::of(machine, space, q)).collect(),
        }
    }

    fn on_plane(map: &PlaneMap, pose: PlanePoint) -> Self {
        let dexterity = map.dexterity(pose.a);
        let sign = |sine: f64| if sine.abs() < AT_CHANGE { 0 } else { sine.signum() as i8 };
        Self {
            q: map.lift(pose).to_vec(),
            a: pose.a.to_vec(),
            det: Some(dexterity.det),
            manipulability: dexterity.manipulability,
            worst_torque_per_force: dexterity.worst_torque_per_force,
            transmission: map.least_transmission(pose.a),
            side: Some(map.sines(pose.a).map(sign)),
        }
    }

    fn of(machine: &Machine, space: &PoseSpace, q: &DriveAngles) -> Self {
        let arms: Vec<Vector> = q.units().iter().zip(space.tip().iter()).map(|(e, c)| e * *c).collect();
        let squares: Vector = arms.iter().map(|j| j * j).sum();
        let lengths: f64 = arms.iter().map(|j| j.norm_sqr()).sum();
        // The two eigenvalues of J Jᵀ: half of (lengths ± |squares|).
        Self {
            q: q.to_vec(),
            a: machine.angles().iter().map(|a| q[a.to] - q[a.from] + a.offset).collect(),
            det: None,
            manipulability: 0.5 * (lengths * lengths - squares.norm_sqr()).max(0.0).sqrt(),
            worst_torque_per_force: (0.5 * (lengths + squares.norm())).sqrt(),
            transmission: least_transmission(&q.units(), q.len()),
            side: None,
        }
    }
}

impl Pose {
    /// Prints every pose; none is no answer.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let space = pose_space(&machine)?;
        let poses = Row::all(&machine, &space, self.point, self.b);
        if poses.is_empty() {
            return Err(self.no_pose(space.reach(self.point)).into());
        }
        self.format.print(&Answer { poses }, |answer| {
            let drives = (1..=space.drives()).map(|k| format!("q_{k} rad"));
            let names = machine.angles().iter().map(|a| format!("{} rad", a.name));
            let mut table = Table::new(["pose".to_owned()].into_iter().chain(drives).chain(names));
            for (i, pose) in answer.poses.iter().enumerate() {
                let numbers = pose.q.iter().chain(&pose.a).map(|x| fixed(*x, 9));
                table.row([(i + 1).to_string()].into_iter().chain(numbers));
            }
            table.to_string()
        })
    }

    fn no_pose(&self, set: Result<BSet, NoReach>) -> Unreachable {
        let (x, y, b) = (self.point.re, self.point.im, self.b);
        match set {
            Err(reason) => Unreachable::Anywhere { x, y, reason },
            Ok(set) => {
                let nearest_b = set.nearest(self.b);
                let shown_b = nearest_b.and_then(|b| set.decimal(b, 4));
                Unreachable::OnThisPlane { x, y, b, would_do: set.in_words(), nearest_b, shown_b }
            }
        }
    }
}
