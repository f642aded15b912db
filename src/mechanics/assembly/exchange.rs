//! Blocks whose end effectors meet pass each other what they hold.

use nalgebra::Vector3;

use super::block::Block;
use super::model::Assembly;
use super::motion::BlockState;
use crate::machine::{Machine, MachineError, Payload};
use crate::planar::Vector;
use stillbase_settings::number::{ShortNumber, significant};

/// Largest sine of the angle between axes that count as parallel.
const PARALLEL_SINE: f64 = 1e-6;

/// Largest distance of end effectors that meet, m, the largest speed of one seen from the other, m/s, and the largest
/// rate of what holds the payload on one side seen from the other, rad/s.
const MEETING: [f64; 3] = [1e-3, 1e-3, 1e-3];

impl Assembly {
    /// Returns the product of the unit vectors along the axes of two blocks with parallel planes: 1, or −1 if one is seen
    /// from the other side.
    ///
    /// # Errors
    /// If their planes are not parallel, or they are one block.
    pub fn parallel(&self, [one, other]: [usize; 2]) -> Result<f64, String> {
        let [name, other_name] = [one, other].map(|i| &self.blocks()[i].name);
        if one == other {
            return Err(format!("{name} stands there twice: want two blocks"));
        }
        let [z, z_other] = [one, other].map(|i| self.blocks()[i].mount.axes.column(2).into_owned());
        if z.cross(&z_other).norm() > PARALLEL_SINE {
            let angle = z.angle(&z_other).to_degrees();
            return Err(format!("the planes of {name} and {other_name} are at {angle:.2}°: want parallel planes"));
        }
        Ok(z.dot(&z_other))
    }

    /// Returns the assembly after two blocks have passed each other what their end effectors hold. Both payloads stay where
    /// they are in space, so momentum is kept. Inertia out of the plane is counted along the link that then holds it.
    ///
    /// # Errors
    /// If their planes are not parallel, neither holds anything, or their end effectors do not meet at equal rates.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn exchanged(&self, pair: [usize; 2], states: &[BlockState]) -> Result<Self, String> {
        let along = self.parallel(pair)?;
        let blocks = pair.map(|i| &self.blocks()[i]);
        let [one, other] = blocks.map(|block| &block.name);
        let held = blocks.map(|block| block.machine.spec().payload);
        if held.iter().all(|payload| payload.mass == 0.0 && payload.inertia == 0.0) {
            return Err(format!("neither {one} nor {other} holds anything: want payload.mass above 0 for one of them"));
        }
        let moving = self.moving(states);
        let [near, far] = pair.map(|i| moving[i].platform);
        let [grip, other_grip] = [0, 1].map(|i| Grip::of(blocks[i], &states[pair[i]]));
        let apart = [(near[0] - far[0]).norm(), (near[1] - far[1]).norm(), (grip.rate - along * other_grip.rate).abs()];
        let said = [("are apart by", "m"), ("move apart at", "m/s"), ("turn what they hold apart at", "rad/s")];
        let too_far = apart.iter().zip(MEETING).zip(said).find(|((x, most), _)| x > &most);
        if let Some(((x, most), (verb, unit))) = too_far {
            let (x, most) = (significant(*x), ShortNumber(most));
            return Err(format!(
                "the end effectors of {one} and {other} {verb} {x} {unit}: want at most {most} {unit}"
            ));
        }
        let places = [0, 1].map(|i| grip_place(blocks[i], [near, far][i][0], held[i], [&grip, &other_grip][i]));
        let taken = [
            taken_over(blocks[0], near[0], held[1], places[1], &grip),
            taken_over(blocks[1], far[0], held[0], places[0], &other_grip),
        ];
        let (one, other) = (one.clone(), other.clone());
        let change = |name: &str, machine: Machine| {
            let taken = if *name == one {
                taken[0]
            } else if *name == other {
                taken[1]
            } else {
                return Ok(machine);
            };
            let mut spec = machine.spec().clone();
            spec.payload = taken;
            Machine::new(spec)
        };
        self.clone().with_machines(change).map_err(|why: MachineError| why.to_string())
    }
}

/// The link that holds the payload of a block.
struct Grip {
    /// Direction along it in the plane, a unit vector.
    along: Vector,
    /// Its rate, rad/s.
    rate: f64,
}

impl Grip {
    fn of(block: &Block, state: &BlockState) -> Self {
        let link = &block.machine.resolved_links()[block.machine.end_link()];
        Self { along: state.q.units()[link.drive] * link.sign, rate: state.qd[link.drive] }
    }
}

/// Returns where the centre of mass of a payload is, m, in axes of the base; its height is that of the end effector.
fn grip_place(block: &Block, tip: Vector3<f64>, payload: Payload, grip: &Grip) -> Vector3<f64> {
    let [along, left] = payload.offset;
    tip + block.mount.in_space(grip.along * Vector::new(along, left), 0.0)
}

/// Returns a payload as a block holds it whose end effector is at `tip`, m; its centre of mass stays at `place`.
fn taken_over(block: &Block, tip: Vector3<f64>, payload: Payload, place: Vector3<f64>, grip: &Grip) -> Payload {
    let off = block.mount.in_plane(&(place - tip)) * grip.along.conj();
    let offset = if payload.mass > 0.0 { [off.re, off.im] } else { [0.0; 2] };
    Payload { offset, axial: block.platform_height(), ..payload }
}
