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
//! Out of its plane a link is a thin bar: its inertia counts about both axes across it, and not about the axis along it. A
//! rotor spins about the axis of its block alone.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::block::Block;
use super::model::Assembly;
use super::motion::{BlockState, Momentum, MovingBlock};
use crate::planar::{MAX_DRIVES, Vector};

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
    drives: usize,
    /// Σ m a_k a_l, kg m².
    square: [[Vector; MAX_DRIVES]; MAX_DRIVES],
    /// Σ m h², kg m².
    heights: f64,
    /// Inertia of the links of each drive about the axis across them, kg m².
    bars: [f64; MAX_DRIVES],
    /// Inertia of all rotors, kg m².
    rotors: f64,
}

impl OutOfPlane {
    pub(super) fn of(machine: &crate::machine::Machine) -> Self {
        let payload = machine.spec().payload;
        let links = machine.links().iter().enumerate().map(|(j, link)| {
            let drive = machine.resolved_links()[j].drive;
            (link.mass, link.inertia, link.axial, drive, machine.com_chain(j))
        });
        let held_by = machine.resolved_links()[machine.end_link()].drive;
        let held = (payload.mass, payload.inertia, payload.axial, held_by, machine.payload_chain());
        let rotors = machine.spec().drives.iter().filter_map(|drive| drive.rotor).map(|rotor| rotor.inertia).sum();
        let mut sum = Self {
            drives: machine.drives(),
            square: [[Vector::default(); MAX_DRIVES]; MAX_DRIVES],
            heights: 0.0,
            bars: [0.0; MAX_DRIVES],
            rotors,
        };
        for (mass, inertia, height, drive, a) in links.chain([held]) {
            sum.heights += mass * height * height;
            sum.bars[drive] += inertia;
            for k in 0..sum.drives {
                for l in 0..sum.drives {
                    sum.square[k][l] += mass * a[k] * a[l];
                }
            }
        }
        sum
    }

    /// Returns the inertia of a block about its mount, kg m², in axes of the base.
    fn about_mount(&self, block: &Block, moving: &MovingBlock) -> Matrix3<f64> {
        let (e, mut polar, mut square) = (&moving.e, 0.0, Vector::default());
        for k in 0..self.drives {
            for l in 0..self.drives {
                polar += (block.inertia.c[k][l] * (e[k].conj() * e[l])).re;
                square += self.square[k][l] * (e[k] * e[l]);
            }
        }
        // Of a bar along e the projector to the direction across is ½ (1 − Re e²) and its like.
        let (mut bars, mut leaning) = (0.0, Vector::default());
        for (e, bar) in e.iter().zip(&self.bars).take(self.drives) {
            bars += bar;
            leaning += *bar * (e * e);
        }
        let [xx, yy] = [0.5 * (polar + square.re), 0.5 * (polar - square.re)];
        let xy = 0.5 * square.im;
        let weighted = moving.weighted[0];
        let own = Matrix3::new(
            yy + self.heights + 0.5 * (bars - leaning.re),
            -xy - 0.5 * leaning.im,
            -weighted.re,
            -xy - 0.5 * leaning.im,
            xx + self.heights + 0.5 * (bars + leaning.re),
            -weighted.im,
            -weighted.re,
            -weighted.im,
            polar + bars + self.rotors,
        );
        block.mount.axes * own * block.mount.axes.transpose()
    }
}

/// Returns the inertia of a mass at a place about the origin, kg m².
fn of_mass(mass: f64, at: &Vector3<f64>) -> Matrix3<f64> {
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
            let between =
                2.0 * at.dot(&moment) * Matrix3::identity() - at * moment.transpose() - moment * at.transpose();
            inertia += block.out_of_plane.about_mount(block, moving) + of_mass(own, &at) + between;
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
    /// The commutator-free method of fourth order of E. Celledoni, A. Marthinsen and B. Owren, *Commutator-free Lie group
    /// methods*, 2003: the quaternion stays a unit quaternion.
    #[must_use]
    pub fn after(&self, h: f64, mut rate: impl FnMut(f64, &Self) -> Vector3<f64>) -> Self {
        let turned = |from: &Self, by: Vector3<f64>| Self(from.0 * UnitQuaternion::from_scaled_axis(by));
        let first = h * rate(0.0, self);
        let half = turned(self, 0.5 * first);
        let second = h * rate(0.5, &half);
        let third = h * rate(0.5, &turned(self, 0.5 * second));
        let fourth = h * rate(1.0, &turned(&half, third - 0.5 * first));
        let both = 2.0 * (second + third);
        let mut end = turned(&turned(self, (3.0 * first + both - fourth) / 12.0), (3.0 * fourth + both - first) / 12.0);
        end.0.renormalize_fast();
        end
    }
}
