//! [`PoseMeasures`]: the poses that reach a point at a given b, with their kinematic measures.

use schemars::JsonSchema;
use serde::Serialize;

use stillbase_mechanics::kinematics::least_transmission;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::{PlaneMap, PlanePoint};

/// A pose and its kinematic measures.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PoseMeasures {
    /// Absolute drive angles, unwrapped, rad.
    pub q: Vec<f64>,
    /// Relative angles, rad.
    pub a: Vec<f64>,
    /// |det ∂(x, y)/∂(a_1, a_2)|, m²: 0 on a fold. Only for three drives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub det: Option<f64>,
    /// √det(J Jᵀ) of the Jacobian in absolute drive angles, m².
    pub manipulability: f64,
    /// Largest singular value of J: drive torque per force at the end effector, N m/N.
    pub worst_torque_per_force: f64,
    /// min |sin(q_k − q_l)|; 0 at a change point.
    pub transmission: f64,
    /// Signs of sin(q_2 − q_1), sin(q_3 − q_2) and sin(q_3 − q_1). Only for three drives.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<[i8; 3]>,
}

/// A sine with absolute value below this is treated as zero: a change point.
const ZERO_SINE_BELOW: f64 = 1e-9;

impl PoseMeasures {
    /// Returns all poses that reach a point, m, at b, rad. With four drives or more, returns the pose nearest to the
    /// middle of the joint limits.
    pub fn all(machine: &Machine, space: &PoseSpace, p: Vector, b: f64) -> Vec<Self> {
        match space.planes() {
            Ok(planes) => planes.map().poses(p, b).iter().map(|pose| Self::on_plane(planes.map(), *pose)).collect(),
            Err(_) => space.poses(p, b, &space.middle()).iter().map(|q| Self::of(machine, space, q)).collect(),
        }
    }

    fn on_plane(map: &PlaneMap, pose: PlanePoint) -> Self {
        let dexterity = map.dexterity(pose.a);
        let sign = |sine: f64| if sine.abs() < ZERO_SINE_BELOW { 0 } else { sine.signum() as i8 };
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
        let arms: Vec<Vector> = q.units().iter().zip(space.arms().iter()).map(|(e, c)| e * *c).collect();
        let squares: Vector = arms.iter().map(|j| j * j).sum();
        let lengths: f64 = arms.iter().map(|j| j.norm_sqr()).sum();
        // The eigenvalues of J Jᵀ are ½ (lengths ± |squares|).
        Self {
            q: q.to_vec(),
            a: machine.angles().iter().map(|angle| angle.value(q)).collect(),
            det: None,
            manipulability: 0.5 * (lengths * lengths - squares.norm_sqr()).max(0.0).sqrt(),
            worst_torque_per_force: (0.5 * (lengths + squares.norm())).sqrt(),
            transmission: least_transmission(&q.units(), q.len()),
            side: None,
        }
    }
}
