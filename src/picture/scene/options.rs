//! Options of the view, and the handles that the pointer can pick.

use std::sync::Arc;

use super::Measure;
use super::exaggeration::Exaggeration;
use super::measurement::Measurement;
use super::palette::Theme;
use super::reaction::Scale;
use crate::notation::Notation;
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_session::Refusal;
use stillbase_session::scenario::{Note, SnapPoint};
use stillbase_simulation::frame::Frame;

/// Options of the view.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewOptions {
    /// Light or dark theme.
    pub theme: Theme,
    /// Measure of dexterity that colours the workspace.
    pub dexterity: Option<Measure>,
    /// Whether labels say what can be dragged.
    pub show_hints: bool,
    /// Whether the workspace of a second b is shown for comparison.
    pub compares: bool,
    /// Handle that is under the pointer or dragged.
    pub highlighted: Option<Handle>,
    /// Position of the pointer during a drag, m.
    pub drag_position: Option<[f64; 2]>,
    /// Pose constant for which the poses at A, or at the target, are previewed, rad.
    pub preview_b: Option<f64>,
    /// Curve that the pointer has drawn so far, m.
    pub stroke: Vec<[f64; 2]>,
    /// Curve that was requested last and refused.
    pub refused: Option<Arc<RefusedCurve>>,
    /// Poses along the motion, in order of time, as in Fig. 5 of the paper.
    pub snapshots: Vec<DriveAngles>,
    /// Other runs at the same instant.
    pub others: Vec<OtherRun>,
    /// Whether arrows show the pin forces.
    pub pin_forces: bool,
    /// Whether arcs show the joint limits.
    pub limits: bool,
    /// Whether links cast shadows on the floor.
    pub shadows: bool,
    /// Exaggeration of the motion of the base.
    pub exaggeration: Exaggeration,
    /// External force at the end effector, N.
    pub external_force: Option<[f64; 2]>,
    /// Counterweights to choose from, in the design view.
    pub weights: Vec<WeightOption>,
    /// Indices of highlighted links, in the design view.
    pub links: Vec<usize>,
    /// Scale of the arrow and arc of the reaction; `None` uses the largest values so far.
    pub scale: Option<Scale>,
    /// Units and names.
    pub notation: Notation,
    /// Notes; those of the instant are drawn.
    pub notes: Vec<Note>,
    /// Distances and angles.
    pub measurements: Vec<Measurement>,
    /// Point to which the pointer snaps while it measures.
    pub snap: Option<SnapPoint>,
}

impl Default for ViewOptions {
    fn default() -> Self {
        Self {
            theme: Theme::Dark,
            dexterity: None,
            show_hints: true,
            compares: true,
            highlighted: None,
            drag_position: None,
            preview_b: None,
            stroke: Vec::new(),
            refused: None,
            snapshots: Vec::new(),
            others: Vec::new(),
            pin_forces: false,
            limits: false,
            shadows: false,
            exaggeration: Exaggeration::default(),
            external_force: None,
            weights: Vec::new(),
            links: Vec::new(),
            scale: None,
            notation: Notation::default(),
            notes: Vec::new(),
            measurements: Vec::new(),
            snap: None,
        }
    }
}

/// The items of a scene that the pointer can pick: to be dragged, clicked or described.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Handle {
    /// The end effector's target.
    Target,
    /// The end effector; dragging it applies a force to it.
    EndEffector,
    /// The knob of the b ring.
    Ring,
    /// The plane b = const, in joint space or as a slice of the tower.
    Plane,
    /// A bar of the tower: an interval of b that reaches a point.
    Bar,
    /// A point of the planned path; its index from A.
    Waypoint(usize),
    /// A link; its index in the machine.
    Link(usize),
    /// The centre of mass of a link in the design view; index of the link.
    Mass(usize),
    /// A counterweight; its index in the machine.
    Weight(usize),
    /// A lump in the design view; its index in the machine.
    Lump(usize),
    /// The end of a link in the design view; index of the link.
    End(usize),
    /// A pin between links; its index in the [`LinkageModel`](super::linkage::LinkageModel).
    Joint(usize),
    /// A joint limit: index of the relative angle, and 0 for its lower or 1 for its upper limit.
    Limit(usize, usize),
    /// The base with its drives.
    Base,
    /// The payload of the plant, which the model of the controller does not contain.
    Payload,
    /// The boundary of the reactionless workspace.
    Boundary,
    /// The arrow of the force on the base.
    Force,
    /// The arc of the moment on the base.
    Moment,
}

impl Handle {
    /// Whether the pointer can drag it.
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
            | Self::Lump(_)
            | Self::End(_)
            | Self::Link(_) => true,
            Self::Joint(_) | Self::Base | Self::Boundary | Self::Force | Self::Moment => false,
        }
    }
}

/// A counterweight to choose from.
#[derive(Clone, Debug, PartialEq)]
pub struct WeightOption {
    /// Index of its link, from 0.
    pub link: usize,
    /// Its outline in the axes of its link, m.
    pub outline: Vec<Vector>,
}

/// Another run at the displayed instant.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherRun {
    /// Its number in the table of runs.
    pub name: String,
    /// Its frame.
    pub frame: Frame,
}

/// A requested curve that was refused, and the point from which it cannot be followed.
#[derive(Clone, Debug, PartialEq)]
pub struct RefusedCurve {
    /// Points of the curve, m.
    pub curve: Vec<Vector>,
    /// Point from which the curve cannot be followed, m.
    pub at: Vector,
    /// Reason, in a few words.
    pub why: String,
}

impl RefusedCurve {
    /// Returns the refused curve, if the refusal is about a curve.
    pub fn of(refusal: &Refusal) -> Option<Self> {
        let Refusal::Blocked(blocked) = refusal else { return None };
        Some(Self { curve: blocked.curve.clone(), at: blocked.at, why: blocked.stop.to_string() })
    }
}
