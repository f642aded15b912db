//! Picked items, and the changes that dragging them requests.

use super::options::Handle;
use stillbase_mechanics::planar::Vector;
use stillbase_simulation::frame::Frame;

/// Distance within which the pointer picks a handle, px.
pub const PICK_RADIUS: f64 = 20.0;

/// A picked item, and the point at which it was picked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// Picked handle.
    pub handle: Handle,
    /// Picked point in the coordinates of the scene.
    pub at: [f64; 3],
    /// State at the start of the drag, for links and joint limits.
    pub grip: Option<Grip>,
}

/// State at the start of the drag of a link or a joint limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// A link that is rotated.
    Link(LinkHold),
    /// A link that is dragged while the end effector stays.
    Pull(GrabPoint),
    /// A joint limit.
    Limit(Pivot),
}

impl Grip {
    /// Returns the grip with snapping of the link to round drive angles switched on or off.
    #[must_use]
    pub fn snapping(self, snaps: bool) -> Self {
        match self {
            Self::Link(hold) => Self::Link(LinkHold { snaps, ..hold }),
            other => other,
        }
    }
}

/// Centre of a joint limit at the start of the drag; the machine may move meanwhile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivot {
    /// Position of the pin, m.
    pub at: [f64; 2],
    /// Angle of the inner drive, rad.
    pub inner: f64,
}

/// Point at which a link is dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrabPoint {
    /// Distance from the root of the link, m.
    pub along: f64,
    /// Vector from the pointer to this point, m.
    pub offset: [f64; 2],
}

/// State of a link at the start of its rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkHold {
    /// Angle from the direction of the link to the pointer, about the root of the link, rad.
    pub angle: f64,
    /// (a_1, a_2) at the start of the drag, rad.
    pub from: [f64; 2],
    /// Whether the angle of its drive snaps to round angles.
    pub snaps: bool,
}

/// Grid of positions for snapping, m.
const POSITION_GRID_M: f64 = 0.01;
/// Grid of pose constants for snapping, rad.
const B_GRID_RAD: f64 = 0.05;
/// Grid of force components for snapping, N.
const FORCE_GRID_N: f64 = 0.5;
/// Grid of angles for snapping, rad.
pub const ANGLE_SNAP: f64 = 5.0 * std::f64::consts::PI / 180.0;

impl DragAction {
    /// Converts a target in the axes of the base, in which joint space and tower show it, to one in space.
    #[must_use]
    pub fn in_space(self, frame: &Frame) -> Self {
        match self {
            Self::Target([x, y]) if frame.floats => {
                let at = frame.in_space(Vector::new(x, y));
                Self::Target([at.re, at.im])
            }
            aim => aim,
        }
    }

    /// Returns the change rounded to the grids for snapping.
    #[must_use]
    pub fn snapped(self) -> Self {
        let round = |x: f64, step: f64| (x / step).round() * step;
        let both = |at: [f64; 2], step| at.map(|x| round(x, step));
        match self {
            Self::Target(at) => Self::Target(both(at, POSITION_GRID_M)),
            Self::InSpace(at) => Self::InSpace(at.map(|x| round(x, POSITION_GRID_M))),
            Self::Waypoint(i, at) => Self::Waypoint(i, both(at, POSITION_GRID_M)),
            Self::Payload(offset) => Self::Payload(both(offset, POSITION_GRID_M)),
            Self::Limit { angle, end, mut ends } => {
                // The limit is rounded, unless that puts it beyond the other limit.
                let rounded = round(ends[end], ANGLE_SNAP);
                let fits = if end == 0 { rounded < ends[1] } else { rounded > ends[0] };
                ends[end] = if fits { rounded } else { ends[end] };
                Self::Limit { angle, end, ends }
            }
            Self::Push(force) => Self::Push(both(force, FORCE_GRID_N)),
            Self::B(b) => Self::B(round(b, B_GRID_RAD)),
            Self::Pull { link, along, at } => Self::Pull { link, along, at: both(at, POSITION_GRID_M) },
            Self::Mass { link, to } => Self::Mass { link, to: round(to, POSITION_GRID_M) },
            Self::Weight { weight, to } => Self::Weight { weight, to: both(to, POSITION_GRID_M) },
            Self::Lump { lump, to } => Self::Lump { lump, to: both(to, POSITION_GRID_M) },
            Self::Length { link, to } => Self::Length { link, to: round(to, POSITION_GRID_M).max(POSITION_GRID_M) },
            // Already snapped, if `LinkHold::snaps` is set.
            Self::Angles(a) => Self::Angles(a),
        }
    }
}

impl Pick {
    /// Returns the pick of a handle that needs no state from the start of the drag.
    pub fn of(handle: Handle, at: [f64; 3]) -> Self {
        Self { handle, at, grip: None }
    }
}

/// A change that a drag requests from the session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DragAction {
    /// Target position of the end effector, m.
    Target([f64; 2]),
    /// Target position of the end effector of a block in space, m, in the axes of the block.
    InSpace([f64; 3]),
    /// Pose constant, rad.
    B(f64),
    /// Position, m, of a point of the path; its index from A.
    Waypoint(usize, [f64; 2]),
    /// Relative joint angles (a_1, a_2), rad.
    Angles([f64; 2]),
    /// Position of a point of a link, while the end effector stays.
    Pull {
        /// Index of the link, from 0.
        link: usize,
        /// Distance of the point from the root of the link, m.
        along: f64,
        /// Requested position, m.
        at: [f64; 2],
    },
    /// Limits of a relative angle.
    Limit {
        /// Index of the angle, from 0.
        angle: usize,
        /// The dragged limit: 0 for the lower, 1 for the upper one.
        end: usize,
        /// Lower and upper limit, rad.
        ends: [f64; 2],
    },
    /// Centre of mass of the payload, along and across the link that holds it, m.
    Payload([f64; 2]),
    /// Force at the end effector, N.
    Push([f64; 2]),
    /// Centre of mass of a link.
    Mass {
        /// Index of the link, from 0.
        link: usize,
        /// Distance from the root of the link, m.
        to: f64,
    },
    /// Position of a lump.
    Lump {
        /// Index of the lump, from 0.
        lump: usize,
        /// Position along its link, and to the left of the link's axis, m.
        to: [f64; 2],
    },
    /// Position of a counterweight.
    Weight {
        /// Index of the counterweight, from 0.
        weight: usize,
        /// Position along its link from the root, and to the left of the link's axis, m.
        to: [f64; 2],
    },
    /// Length of a link.
    Length {
        /// Index of the link, from 0.
        link: usize,
        /// Requested length, m.
        to: f64,
    },
}
