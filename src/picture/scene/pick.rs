//! What the pointer has taken hold of, and what pulling at it asks for.

use super::options::Handle;

/// How near to a handle the pointer takes hold of it, px.
pub const NEAR: f64 = 20.0;

/// What the pointer has taken hold of, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// What is held.
    pub handle: Handle,
    /// In the scene.
    pub at: [f64; 3],
    /// How a link or a joint limit is held.
    pub grip: Option<Grip>,
}

/// How something that turns is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Grip {
    /// A link.
    Link(Hold),
    /// A link that is pulled while the end effector stays.
    Pull(Hook),
    /// A joint limit.
    Limit(Pivot),
}

impl Grip {
    /// The same, with a link that stops at round angles of its drive only, or does not.
    #[must_use]
    pub fn snapping(self, snaps: bool) -> Self {
        match self {
            Self::Link(hold) => Self::Link(Hold { snaps, ..hold }),
            other => other,
        }
    }
}

/// What a joint limit turned about when it was taken hold of; the machine may move under the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pivot {
    /// The pin, m.
    pub at: [f64; 2],
    /// Angle of the inner drive, rad.
    pub inner: f64,
}

/// Where on a link it is pulled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hook {
    /// m from its root.
    pub along: f64,
    /// From the pointer to there, m.
    pub off: [f64; 2],
}

/// How a link is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// From the link's direction to the pointer about its root, rad.
    pub angle: f64,
    /// (a_1, a_2) when it was taken hold of, rad.
    pub from: [f64; 2],
    /// Whether its drive stops at round angles only.
    pub snaps: bool,
}

/// Round places, m, pose constants, rad, forces, N, and angles of drives, rad.
const ROUND_PLACE: f64 = 0.01;
const ROUND_B: f64 = 0.05;
const ROUND_FORCE: f64 = 0.5;
/// Of drives that a hand turns.
pub const ROUND_ANGLE: f64 = 5.0 * std::f64::consts::PI / 180.0;

impl Aim {
    /// The same at the nearest round numbers.
    #[must_use]
    pub fn snapped(self) -> Self {
        let round = |x: f64, step: f64| (x / step).round() * step;
        let both = |at: [f64; 2], step| at.map(|x| round(x, step));
        match self {
            Self::Target(at) => Self::Target(both(at, ROUND_PLACE)),
            Self::Waypoint(i, at) => Self::Waypoint(i, both(at, ROUND_PLACE)),
            Self::Payload(offset) => Self::Payload(both(offset, ROUND_PLACE)),
            Self::Limit { angle, end, mut ends } => {
                // Round, unless that is beyond the other end.
                let rounded = round(ends[end], ROUND_ANGLE);
                let fits = if end == 0 { rounded < ends[1] } else { rounded > ends[0] };
                ends[end] = if fits { rounded } else { ends[end] };
                Self::Limit { angle, end, ends }
            }
            Self::Push(force) => Self::Push(both(force, ROUND_FORCE)),
            Self::B(b) => Self::B(round(b, ROUND_B)),
            Self::Pull { link, along, at } => Self::Pull { link, along, at: both(at, ROUND_PLACE) },
            Self::Mass { link, to } => Self::Mass { link, to: round(to, ROUND_PLACE) },
            Self::Weight { weight, to } => Self::Weight { weight, to: round(to, ROUND_PLACE) },
            Self::Length { link, to } => Self::Length { link, to: round(to, ROUND_PLACE).max(ROUND_PLACE) },
            // Where its drive is at a round angle: its grip says so.
            Self::Angles(a) => Self::Angles(a),
        }
    }
}

impl Pick {
    /// What does not turn.
    pub fn of(handle: Handle, at: [f64; 3]) -> Self {
        Self { handle, at, grip: None }
    }
}

/// What pulling at it asks of the session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// The end effector at a point, m.
    Target([f64; 2]),
    /// The pose constant, rad.
    B(f64),
    /// A point of the path, counted from A, at a place, m.
    Waypoint(usize, [f64; 2]),
    /// The relative joint angles (a_1, a_2), rad.
    Angles([f64; 2]),
    /// A point of a link, while the end effector stays.
    Pull {
        /// Counted from 0.
        link: usize,
        /// m from its root.
        along: f64,
        /// m.
        at: [f64; 2],
    },
    /// Least and greatest value of a relative angle.
    Limit {
        /// Counted from 0.
        angle: usize,
        /// Which of the two is pulled.
        end: usize,
        /// rad.
        ends: [f64; 2],
    },
    /// The payload's centre of mass, along and across the link that holds it, m.
    Payload([f64; 2]),
    /// A force at the end effector, N.
    Push([f64; 2]),
    /// The centre of mass of a link.
    Mass {
        /// Counted from 0.
        link: usize,
        /// m from its root.
        to: f64,
    },
    /// A counterweight.
    Weight {
        /// Counted from 0.
        weight: usize,
        /// m from the root of its link.
        to: f64,
    },
    /// The length of a link.
    Length {
        /// Counted from 0.
        link: usize,
        /// m.
        to: f64,
    },
}
