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
        let hands @ [own, far] = pair.map(|i| Hand::of(&self.blocks()[i], moving[i].platform, &states[i]));
        let apart = [(own.tip - far.tip).norm(), (own.speed - far.speed).norm(), (own.rate - along * far.rate).abs()];
        let said = [("are apart by", "m"), ("move apart at", "m/s"), ("turn what they hold apart at", "rad/s")];
        let too_far = apart.into_iter().zip(MEETING).zip(said).find(|((x, most), _)| x > most);
        if let Some(((x, most), (verb, unit))) = too_far {
            let (x, most) = (significant(x), ShortNumber(most));
            return Err(format!(
                "the end effectors of {one} and {other} {verb} {x} {unit}: want at most {most} {unit}"
            ));
        }
        let [first, second] = hands.map(|hand| hand.place());
        let taken = [own.taking(held[1], second), far.taking(held[0], first)];
        let (one, other) = (one.clone(), other.clone());
        let change = |name: &str, machine: Machine| {
            let Some(i) = [&one, &other].iter().position(|own| *own == name) else { return Ok(machine) };
            let mut spec = machine.spec().clone();
            spec.payload = taken[i];
            Machine::new(spec)
        };
        self.clone().with_machines(change).map_err(|why: MachineError| why.to_string())
    }
}

/// The end effector of a block, with the link that holds its payload.
#[derive(Clone, Copy)]
struct Hand<'a> {
    block: &'a Block,
    /// Place, m, and velocity, m/s, of the end effector, in axes of the base.
    tip: Vector3<f64>,
    speed: Vector3<f64>,
    /// Direction along the link in the plane, a unit vector.
    along: Vector,
    /// Rate of the link, rad/s.
    rate: f64,
}

impl<'a> Hand<'a> {
    fn of(block: &'a Block, [tip, speed, _]: [Vector3<f64>; 3], state: &BlockState) -> Self {
        let link = &block.machine.resolved_links()[block.machine.end_link()];
        let along = state.q.units()[link.drive] * link.sign;
        Self { block, tip, speed, along, rate: state.qd[link.drive] }
    }

    /// Returns where the centre of mass of its payload is, m, in axes of the base, at the height of the end effector.
    fn place(&self) -> Vector3<f64> {
        let [along, left] = self.block.machine.spec().payload.offset;
        self.tip + self.block.mount.in_space(self.along * Vector::new(along, left), 0.0)
    }

    /// Returns a payload as it is held here, with its centre of mass at a place, m.
    fn taking(&self, payload: Payload, place: Vector3<f64>) -> Payload {
        let off = self.block.mount.in_plane(&(place - self.tip)) * self.along.conj();
        let offset = if payload.mass > 0.0 { [off.re, off.im] } else { [0.0; 2] };
        Payload { offset, axial: self.block.platform_height(), ..payload }
    }
}
