//! [`JointSpace`]: joint space of any machine that has a b. Its axes are drive angles. A surface of constant b is a
//! plane, or with two axes a line.
//!
//! | subject | file |
//! |---|---|
//! | machines with planes: the joint limits bound a prism | `prism` |
//! | other machines: section at the present angles of the drives without an axis | `section` |
//! | the interval of b that is shown | `range` |

mod items;
mod prism;
mod range;
mod section;

pub use items::SYMBOLS;

use prism::Prism;
use section::JointSection;

use super::Scene;
use super::camera::Camera;
use super::options::ViewOptions;
use super::pick::{DragAction, Pick};
use super::pointer::Pointer;
use stillbase_session::Run;
use stillbase_simulation::frame::Frame;

/// Joint space of a run. The unit of the scene is the radian.
#[derive(Clone, Debug)]
pub struct JointSpace(Kind);

#[derive(Clone, Debug)]
enum Kind {
    Prism(Box<Prism>),
    Section(Box<JointSection>),
}

impl JointSpace {
    /// Prepares a run for drawing; to be repeated when its machine or plan changes. `None` without a b, or with a
    /// single drive.
    pub fn of(run: &Run) -> Option<Self> {
        Self::showing(run, None)
    }

    /// Prepares a whole run with all b in the interval `b`, rad. The shown interval is constant and contains `b`; the
    /// coordinates of the scene are q itself.
    pub fn over(run: &Run, b: [f64; 2]) -> Option<Self> {
        Self::showing(run, Some(b))
    }

    fn showing(run: &Run, all: Option<[f64; 2]>) -> Option<Self> {
        let space = run.pose_space().ok()?;
        match Prism::of(run, all) {
            Some(prism) => Some(Self(Kind::Prism(Box::new(prism)))),
            None => JointSection::of(run, space, all).map(|section| Self(Kind::Section(Box::new(section)))),
        }
    }

    /// Indices of the drives along the axes, from 0.
    pub fn drives(&self) -> &[usize] {
        match &self.0 {
            Kind::Prism(prism) => prism.drives(),
            Kind::Section(section) => section.drives(),
        }
    }

    /// Returns the index of the drive along each axis of the scene for a machine with planes; for other machines 0,
    /// 1, 2.
    pub fn axes(&self) -> [usize; 3] {
        match &self.0 {
            Kind::Prism(prism) => *prism.drives(),
            Kind::Section(_) => [0, 1, 2],
        }
    }

    /// Whether there are more drives than axes, so that the drives along the axes can be chosen.
    pub fn has_choice(&self) -> bool {
        match &self.0 {
            Kind::Prism(_) => false,
            Kind::Section(section) => section.has_choice(),
        }
    }

    /// Sets the drives along the axes, indices from 0, if there is a choice.
    pub fn show(&mut self, drives: [usize; 3]) {
        if let Kind::Section(section) = &mut self.0 {
            section.show(drives);
        }
    }

    /// Hint at what can be dragged.
    pub fn invitation(&self) -> &'static str {
        match self.drives().len() {
            2 => "drag the dot along its line  ·  drag the line to change b",
            _ => "drag the dot in its plane  ·  drag the plane to change b",
        }
    }

    /// Converts q, rad, to a point of the scene; `b` is the present pose constant, rad.
    pub fn point(&self, q: &[f64], b: f64) -> [f64; 3] {
        match &self.0 {
            Kind::Prism(prism) => prism.point(q, b),
            Kind::Section(section) => section.point(q, b),
        }
    }

    /// Converts a point of the scene to q, rad; drives without an axis have the angles given by the frame.
    pub fn angles(&self, point: [f64; 3], frame: &Frame) -> Vec<f64> {
        match &self.0 {
            Kind::Prism(prism) => prism.angles(point, frame.b_reference).to_vec(),
            Kind::Section(section) => section.angles(point, frame),
        }
    }

    /// Returns the ends or corners, in order, of the surface of constant b, rad, within the joint limits. Drives
    /// without an axis have the angles given by the frame.
    pub fn surface(&self, b: f64, frame: &Frame) -> Vec<[f64; 3]> {
        match &self.0 {
            Kind::Prism(prism) => prism.surface(b, frame.b_reference).to_vec(),
            Kind::Section(section) => section.surface(b, frame),
        }
    }

    /// Returns a camera that shows everything.
    pub fn camera(&self) -> Camera {
        match &self.0 {
            Kind::Prism(prism) => prism.camera(),
            Kind::Section(section) => section.camera(),
        }
    }

    /// Corners of the bounding box.
    pub fn corners(&self) -> Vec<[f64; 3]> {
        let ends = match &self.0 {
            Kind::Prism(prism) => prism.bounds_at_home(),
            Kind::Section(section) => section.bounds(),
        };
        (0..8).map(|i| [0, 1, 2].map(|k| ends[k][(i >> k) & 1])).collect()
    }

    /// Returns the scene of a frame.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        match &self.0 {
            Kind::Prism(prism) => prism.scene(frame, options, camera),
            Kind::Section(section) => section.scene(frame, options, camera),
        }
    }

    /// Returns the item under the pointer that can be dragged.
    pub fn pick(&self, frame: &Frame, pointer: &Pointer) -> Option<Pick> {
        match &self.0 {
            Kind::Prism(prism) => prism.pick(frame, pointer),
            Kind::Section(section) => section.pick(frame, pointer),
        }
    }

    /// Returns the change that dragging an item to the pointer requests.
    pub fn aim(&self, pick: &Pick, frame: &Frame, pointer: &Pointer) -> Option<DragAction> {
        match &self.0 {
            Kind::Prism(prism) => prism.aim(pick, frame, pointer),
            Kind::Section(section) => section.aim(pick, frame, pointer),
        }
    }
}
