//! A base that floats in space: how it turns while its blocks move.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m_b, ρ, I_b | mass of the base, its centre of mass from its origin, its inertia about that | kg, m, kg m² |
//! | c, I_c | centre of mass of base and blocks from the origin, their inertia about it as one body | m, kg m² |
//! | p, ℓ | momenta of the blocks as seen from the base, ℓ about c | kg m/s, kg m²/s |
//! | L | angular momentum about c in space, kept | kg m²/s |
//! | ω | rate of the base, in its axes | rad/s |
//!
//! # Closed form
//! I_c ω + ℓ = L in axes of the base. Nothing acts from outside, so c moves straight on; where the base is follows from it.
//!
//! # Assumptions
//! Out of its plane a link has the inertia that its file states, or else that of a thin bar: `inertia` about both axes
//! across it, and none along it. Counterweights are flat. A rotor spins about the axis of its block alone.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::block::Block;
use super::model::Assembly;
use super::motion::{BlockState, Momentum, MovingBlock};
use super::stepping;
use crate::machine::TransverseInertia;
use crate::planar::{MAX_DRIVES, PerDrive, UnitVectors, Vector};

/// Mass properties of a base in space.
#[derive(Clone, Debug, PartialEq)]
pub struct SpatialBase {
    /// m_b, kg.
    pub mass: f64,
    /// ρ, m, in axes of the base.
    pub com: Vector3<f64>,
    /// I_b, kg m², in axes of the base.
    pub inertia: Matrix3<f64>,
}

/// How a base moves, and what base and blocks are as one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseMotion {
    /// ω, rad/s, in axes of the base.
    pub rate: Vector3<f64>,
    /// c, m, in axes of the base.
    pub com: Vector3<f64>,
    /// I_c, kg m², in axes of the base.
    pub inertia: Matrix3<f64>,
}

/// Constants of a machine's inertia out of its plane.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct OutOfPlane {
    /// Number of drives, and of the ground if links keep their orientation.
    indices: usize,
    /// Σ m a_k a_l, kg m².
    square: [[Vector; MAX_DRIVES]; MAX_DRIVES],
    /// Σ m h², kg m².
    heights: f64,
    /// Σ (I_a + I_c) of all links, kg m²: twice the mean of their inertia about axes in the plane.
    mean: f64,
    /// Σ (I_c − I_a + 2 i I_xy) of the links of each drive, kg m².
    leaning: [Vector; MAX_DRIVES],
    /// Inertia of all links about the axis of the block, kg m².
    spin: f64,
    /// Inertia of all rotors, kg m².
    rotors: f64,
}

impl OutOfPlane {
    pub(super) fn of(machine: &crate::machine::Machine) -> Self {
        let payload = machine.spec().payload;
        let links = machine.links().iter().enumerate().map(|(j, link)| {
            let drive = machine.resolved_links()[j].drive;
            (link.mass, link.inertia, link.axial, drive, machine.com_chain(j), machine.link_transverse(j))
        });
        let held_by = machine.resolved_links()[machine.end_link()].drive;
        let held =
            (payload.mass, payload.inertia, payload.axial, held_by, machine.payload_chain(), payload.transverse());
        let rotors = machine.spec().drives.iter().filter_map(|drive| drive.rotor).map(|rotor| rotor.inertia).sum();
        let mut sum = Self {
            indices: machine.drives() + usize::from(machine.ground().is_some()),
            square: [[Vector::default(); MAX_DRIVES]; MAX_DRIVES],
            heights: 0.0,
            mean: 0.0,
            leaning: [Vector::default(); MAX_DRIVES],
            spin: 0.0,
            rotors,
        };
        for (mass, inertia, height, drive, a, TransverseInertia { along, across, product }) in links.chain([held]) {
            sum.heights += mass * height * height;
            sum.mean += along + across;
            sum.leaning[drive] += Vector::new(across - along, 2.0 * product);
            sum.spin += inertia;
            for k in 0..sum.indices {
                for l in 0..sum.indices {
                    sum.square[k][l] += mass * a[k] * a[l];
                }
            }
        }
        sum
    }

    /// Returns Σ_l Σ m a_k a_l e_k e_l of each drive, and with it what the tensors of its bodies have beside their mean,
    /// kg m².
    pub(super) fn leaning(&self, e: &UnitVectors) -> [Vector; MAX_DRIVES] {
        std::array::from_fn(|k| {
            let points = (0..self.indices).map(|l| self.square[k][l] * (e[k] * e[l])).sum::<Vector>();
            points + self.leaning[k] * (e[k] * e[k])
        })
    }

    /// Returns the inertia of a block about its mount, kg m², in axes of the base.
    fn about_mount(&self, block: &Block, moving: &MovingBlock) -> Matrix3<f64> {
        let (e, mut polar, mut square) = (&moving.e, 0.0, Vector::default());
        for k in 0..self.indices {
            for l in 0..self.indices {
                polar += (block.inertia.c[k][l] * (e[k].conj() * e[l])).re;
                square += self.square[k][l] * (e[k] * e[l]);
            }
        }
        // The tensor of a body that turns by e keeps its mean, and the rest turns by e².
        let mut leaning = Vector::default();
        for (e, body) in e.iter().zip(&self.leaning).take(self.indices) {
            leaning += body * (e * e);
        }
        let mean = 0.5 * (polar + self.mean) + self.heights;
        in_space(block, mean, square + leaning, moving.weighted[0], polar + self.spin + self.rotors)
    }

    /// Returns the rate of change of [`about_mount`](Self::about_mount), kg m²/s, with the rates of a state.
    fn change_about_mount(&self, block: &Block, moving: &MovingBlock, qd: &PerDrive) -> Matrix3<f64> {
        let (e, qd, mut polar, mut leaning) = (&moving.e, qd.padded(), 0.0, Vector::default());
        for k in 0..self.indices {
            leaning += 2.0 * qd[k] * self.leaning[k] * (e[k] * e[k]);
            for l in 0..self.indices {
                polar -= (qd[l] - qd[k]) * (block.inertia.c[k][l] * (e[k].conj() * e[l])).im;
                leaning += (qd[k] + qd[l]) * self.square[k][l] * (e[k] * e[l]);
            }
        }
        in_space(block, 0.5 * polar, Vector::i() * leaning, moving.weighted[1], polar)
    }
}

/// Returns a tensor in axes of the base: in the plane of a block its mean and what it has beside that, the negative of its
/// products with the axis, and the number about the axis.
fn in_space(block: &Block, mean: f64, leaning: Vector, weighted: Vector, about: f64) -> Matrix3<f64> {
    let [re, im] = [0.5 * leaning.re, 0.5 * leaning.im];
    let [x, y] = [-weighted.re, -weighted.im];
    let own = Matrix3::new(mean - re, -im, x, -im, mean + re, y, x, y, about);
    block.mount.axes * own * block.mount.axes.transpose()
}

impl MovingBlock {
    /// Returns the inertia of the block about the origin of the base, kg m², and its rate of change, kg m²/s.
    pub(super) fn inertia(&self, block: &Block, state: &BlockState) -> [Matrix3<f64>; 2] {
        let (mass, [place, velocity, _]) = (block.inertia.mass(), &self.mount);
        let (moment, change) = (self.first_moment(block), block.mount.in_space(self.first[1], 0.0));
        [
            block.out_of_plane.about_mount(block, self) + of_mass(mass, place) + between(place, &moment),
            block.out_of_plane.change_about_mount(block, self, &state.qd)
                + mass * between(place, velocity)
                + between(velocity, &moment)
                + between(place, &change),
        ]
    }
}

/// Returns what a first moment, kg m, adds to the inertia about a point as far away as `place`, kg m².
fn between(place: &Vector3<f64>, moment: &Vector3<f64>) -> Matrix3<f64> {
    2.0 * place.dot(moment) * Matrix3::identity() - place * moment.transpose() - moment * place.transpose()
}

/// Returns the inertia of a mass at a place about the origin, kg m².
pub(super) fn of_mass(mass: f64, at: &Vector3<f64>) -> Matrix3<f64> {
    mass * (Matrix3::identity() * at.norm_squared() - at * at.transpose())
}

impl Assembly {
    /// Returns how a free base moves while its blocks do; `angular` is the angular momentum about the common centre of
    /// mass, kg m²/s, in axes of the base.
    ///
    /// # Panics
    /// If there are fewer states than blocks.
    pub fn base_motion(&self, base: &SpatialBase, states: &[BlockState], angular: &Vector3<f64>) -> BaseMotion {
        let moving = self.moving(states);
        let (mut mass, mut first) = (base.mass, base.mass * base.com);
        let mut inertia = base.inertia + of_mass(base.mass, &base.com);
        for (block, moving) in self.blocks().iter().zip(&moving) {
            let (own, at, moment) = (block.inertia.mass(), moving.mount[0], moving.first_moment(block));
            mass += own;
            first += own * at + moment;
            inertia += block.out_of_plane.about_mount(block, moving) + of_mass(own, &at) + between(&at, &moment);
        }
        let com = first / mass;
        inertia -= of_mass(mass, &com);
        let Momentum { linear, angular: about_origin } = self.momentum(states);
        let own = about_origin - com.cross(&linear);
        // The inertia of bodies with mass is positive definite.
        let rate = inertia.cholesky().map_or_else(Vector3::zeros, |factors| factors.solve(&(angular - own)));
        BaseMotion { rate, com, inertia }
    }
}

/// Orientation of a base: turns its axes into those of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude(pub UnitQuaternion<f64>);

impl Attitude {
    /// Base axes along those of space.
    pub fn level() -> Self {
        Self(UnitQuaternion::identity())
    }

    /// Returns the components w, x, y, z.
    pub fn components(&self) -> [f64; 4] {
        let q = self.0.quaternion();
        [q.w, q.i, q.j, q.k]
    }

    /// Returns the attitude after a step of h seconds. `rate` returns the rate in axes of the base, rad/s, at a fraction of
    /// the step and an attitude.
    ///
    /// # Source
    /// The commutator-free method of fourth order of Celledoni, Marthinsen and Owren, 2003: the quaternion stays a unit
    /// quaternion.
    #[must_use]
    pub fn after(&self, h: f64, rate: impl FnMut(f64, &Self) -> Vector3<f64>) -> Self {
        let mut end = stepping::after(self, h, rate, |from, by| from.turned(by));
        end.0.renormalize_fast();
        end
    }

    /// Returns the attitude turned by a rotation vector in axes of the base, rad.
    pub(super) fn turned(&self, by: &Vector3<f64>) -> Self {
        Self(self.0 * UnitQuaternion::from_scaled_axis(*by))
    }
}
