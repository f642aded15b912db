//! What a person has chosen to see, and what can be dragged.

use std::sync::Arc;

use super::Measure;
use super::exaggeration::Exaggeration;
use super::palette::Theme;
use super::reaction::Scale;
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::session::Refusal;
use crate::simulation::frame::Frame;

/// What a person has chosen to see.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewOptions {
    /// Light or dark.
    pub theme: Theme,
    /// The workspace is shaded by this measure.
    pub dexterity: Option<Measure>,
    /// The scene says what can be dragged.
    pub invites: bool,
    /// The second workspace, to compare with, is shown.
    pub compares: bool,
    /// The pointer is on this handle, or drags it.
    pub hot: Option<Handle>,
    /// Where the pointer holds what it drags, m.
    pub held: Option<[f64; 2]>,
    /// A pose constant to show A, or the target, on, rad.
    pub preview_b: Option<f64>,
    /// What the pointer has drawn so far, m.
    pub stroke: Vec<[f64; 2]>,
    /// What was asked for last and refused.
    pub refused: Option<Arc<Refused>>,
    /// Poses along the motion, in the order of time, as in Fig. 5.
    pub snapshots: Vec<DriveAngles>,
    /// Other runs at the same instant.
    pub others: Vec<Other>,
    /// Arrows show what the pins carry.
    pub pin_forces: bool,
    /// Arcs show the joint limits.
    pub limits: bool,
    /// Links throw shadows on the floor.
    pub shadows: bool,
    /// How the motion of the base is drawn.
    pub exaggeration: Exaggeration,
    /// A force at the end effector, N.
    pub push: Option<[f64; 2]>,
    /// Counterweights to choose from.
    pub weights: Vec<Offered>,
    /// Links that are spoken of, by number, where the machine is designed.
    pub links: Vec<usize>,
    /// What a full arrow and arc of a reaction stand for; none goes by the largest so far.
    pub scale: Option<Scale>,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self {
            theme: Theme::Dark,
            dexterity: None,
            invites: true,
            compares: true,
            hot: None,
            held: None,
            preview_b: None,
            stroke: Vec::new(),
            refused: None,
            snapshots: Vec::new(),
            others: Vec::new(),
            pin_forces: false,
            limits: false,
            shadows: false,
            exaggeration: Exaggeration::default(),
            push: None,
            weights: Vec::new(),
            links: Vec::new(),
            scale: None,
        }
    }
}

/// What in the scene the pointer can be on: to be dragged, to be clicked, or to be told of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// The end effector's target.
    Target,
    /// The end effector, to be pushed.
    EndEffector,
    /// The knob of the b ring.
    Ring,
    /// The plane b = const, in joint space or as a slice of the tower.
    Plane,
    /// A bar of the tower: the b that reach a point.
    Bar,
    /// A point of the planned path, counted from A.
    Waypoint(usize),
    /// A link, by its number in the machine.
    Link(usize),
    /// The centre of mass of a link, by its number, where the machine is designed.
    Mass(usize),
    /// A counterweight, by its number in the machine.
    Weight(usize),
    /// The end of a link, by its number.
    End(usize),
    /// A pin that joins links, by its number in the [`Linkage`](super::linkage::Linkage).
    Joint(usize),
    /// An end of the joint limits of a relative angle: both counted from 0.
    Limit(usize, usize),
    /// What the machine stands on, with its drives.
    Base,
    /// What the plant holds and the model does not know of.
    Payload,
    /// The boundary of the reactionless workspace.
    Boundary,
    /// The arrow of the force on the base.
    Force,
    /// The arc of the moment on the base.
    Moment,
}

impl Handle {
    /// Whether the pointer can pull at it.
    pub fn can_be_dragged(self) -> bool {
        match self {
            Self::Target
            | Self::EndEffector
            | Self::Ring
            | Self::Plane
            | Self::Bar
            | Self::Waypoint(_)
            | Self::Limit(..)
            | Self::Payload
            | Self::Mass(_)
            | Self::Weight(_)
            | Self::End(_)
            | Self::Link(_) => true,
            Self::Joint(_) | Self::Base | Self::Boundary | Self::Force | Self::Moment => false,
        }
    }
}

/// A counterweight to choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offered {
    /// Its link, counted from 0.
    pub link: usize,
    /// Where along that, m.
    pub at: f64,
    /// m.
    pub radius: f64,
}

/// Another run at the present instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Other {
    /// Its number in the table.
    pub name: String,
    /// What is true of it.
    pub frame: Frame,
}

/// A curve that was asked for and refused, and where it cannot be followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Refused {
    /// m.
    pub curve: Vec<Vector>,
    /// m.
    pub at: Vector,
    /// Why, in a few words.
    pub why: String,
}

impl Refused {
    /// The curve of a refusal, if it is of one.
    pub fn of(refusal: &Refusal) -> Option<Self> {
        let Refusal::Blocked(blocked) = refusal else { return None };
        Some(Self { curve: blocked.curve.clone(), at: blocked.at, why: blocked.stop.to_string() })
    }
}
