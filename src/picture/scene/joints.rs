//! Joint space of any machine that has a b: planes in closed form where there are some, else a [`Section`].

use super::Scene;
use super::camera::Camera;
use super::joint_space::JointSpace;
use super::options::ViewOptions;
use super::pick::{Aim, Pick};
use super::pointer::Pointer;
use super::section::Section;
use crate::session::Run;
use crate::simulation::frame::Frame;

/// Joint space as a run has it.
#[derive(Clone, Debug)]
pub enum Joints {
    /// Three drives with planes.
    Planes(Box<JointSpace>),
    /// Any other machine with a b and at least two drives.
    Section(Box<Section>),
}

impl Joints {
    /// Prepares a run for drawing; to be made again when its machine or plan changes. `None` without a b, or with one
    /// drive alone.
    pub fn of(run: &Run) -> Option<Self> {
        let space = run.pose_space().ok()?;
        match JointSpace::of(run) {
            Some(planes) => Some(Self::Planes(Box::new(planes))),
            None => Section::of(run, space).map(|section| Self::Section(Box::new(section))),
        }
    }

    /// For a whole run, whose b lie in a range, rad: it shows all of them and stands still, with q itself as
    /// coordinates.
    pub fn over(run: &Run, b: [f64; 2]) -> Option<Self> {
        let space = run.pose_space().ok()?;
        match JointSpace::over(run, b) {
            Some(planes) => Some(Self::Planes(Box::new(planes))),
            None => Section::over(run, space, b).map(|section| Self::Section(Box::new(section))),
        }
    }

    /// Which axis of (q_1, q_2, q_3) each axis of the scene stands for; a section shows its drives in their order.
    pub fn axes(&self) -> [usize; 3] {
        match self {
            Self::Planes(space) => space.drives(),
            Self::Section(_) => [0, 1, 2],
        }
    }

    /// The planes, if the machine has some.
    pub fn planes(&self) -> Option<&JointSpace> {
        match self {
            Self::Planes(space) => Some(space),
            Self::Section(_) => None,
        }
    }

    /// The section, of a machine without planes.
    pub fn section(&self) -> Option<&Section> {
        match self {
            Self::Planes(_) => None,
            Self::Section(section) => Some(section),
        }
    }

    /// Puts drives along the axes, counted from 0, where more than three can be chosen from.
    pub fn show(&mut self, drives: [usize; 3]) {
        if let Self::Section(section) = self {
            section.show(drives);
        }
    }

    /// A view of all of it.
    pub fn camera(&self) -> Camera {
        match self {
            Self::Planes(space) => space.camera(),
            Self::Section(section) => section.camera(),
        }
    }

    /// Corners of the box that holds it.
    pub fn corners(&self) -> Vec<[f64; 3]> {
        match self {
            Self::Planes(space) => space.box_corners(),
            Self::Section(section) => section.corners(),
        }
    }

    /// Everything there is to draw.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        match self {
            Self::Planes(space) => space.scene(frame, options, camera),
            Self::Section(section) => section.scene(frame, options, camera),
        }
    }

    /// What the pointer can take hold of.
    pub fn pick(&self, frame: &Frame, pointer: &Pointer) -> Option<Pick> {
        match self {
            Self::Planes(space) => space.pick(frame, pointer),
            Self::Section(section) => section.pick(frame, pointer),
        }
    }

    /// What pulling at something asks for.
    pub fn aim(&self, pick: &Pick, frame: &Frame, pointer: &Pointer) -> Option<Aim> {
        match self {
            Self::Planes(space) => space.aim(pick, frame, pointer),
            Self::Section(section) => section.aim(pick, frame, pointer),
        }
    }
}
