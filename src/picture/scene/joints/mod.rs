//! [`Joints`]: joint space of any machine that has a b. Its axes are drive angles, and a b is a surface in it: a plane, or a
//! line where there are two axes.
//!
//! | what | file |
//! |---|---|
//! | a machine with planes: all within the limits are a prism | `prism` |
//! | any other: cut where the drives stand that have no axis | `section` |
//! | the b that are shown | `range` |

mod items;
mod prism;
mod range;
mod section;

pub use items::SYMBOLS;

use prism::Prism;
use section::Section;

use super::Scene;
use super::camera::Camera;
use super::options::ViewOptions;
use super::pick::{Aim, Pick};
use super::pointer::Pointer;
use crate::session::Run;
use crate::simulation::frame::Frame;

/// Joint space as a run has it. In the scene a unit is a radian.
#[derive(Clone, Debug)]
pub struct Joints(Kind);

#[derive(Clone, Debug)]
enum Kind {
    Prism(Box<Prism>),
    Section(Box<Section>),
}

impl Joints {
    /// Prepares a run for drawing; to be made again when its machine or plan changes. `None` without a b, or with one
    /// drive alone.
    pub fn of(run: &Run) -> Option<Self> {
        Self::showing(run, None)
    }

    /// For a whole run, whose b lie in a range, rad: it shows all of them and stands still, with q itself as
    /// coordinates.
    pub fn over(run: &Run, b: [f64; 2]) -> Option<Self> {
        Self::showing(run, Some(b))
    }

    fn showing(run: &Run, all: Option<[f64; 2]>) -> Option<Self> {
        let space = run.pose_space().ok()?;
        match Prism::of(run, all) {
            Some(prism) => Some(Self(Kind::Prism(Box::new(prism)))),
            None => Section::of(run, space, all).map(|section| Self(Kind::Section(Box::new(section)))),
        }
    }

    /// The drives along the axes, counted from 0.
    pub fn drives(&self) -> &[usize] {
        match &self.0 {
            Kind::Prism(prism) => prism.drives(),
            Kind::Section(section) => section.drives(),
        }
    }

    /// Which axis of (q_1, q_2, q_3) each axis of the scene stands for; drives that were chosen keep their order.
    pub fn axes(&self) -> [usize; 3] {
        match &self.0 {
            Kind::Prism(prism) => *prism.drives(),
            Kind::Section(_) => [0, 1, 2],
        }
    }

    /// Whether there are drives without an axis, so that others can be put along these.
    pub fn has_choice(&self) -> bool {
        match &self.0 {
            Kind::Prism(_) => false,
            Kind::Section(section) => section.has_choice(),
        }
    }

    /// Puts drives along the axes, counted from 0, where there is a choice.
    pub fn show(&mut self, drives: [usize; 3]) {
        if let Kind::Section(section) = &mut self.0 {
            section.show(drives);
        }
    }

    /// What can be done in it with the pointer.
    pub fn invitation(&self) -> &'static str {
        match self.drives().len() {
            2 => "drag the dot along its line  ·  drag the line to change b",
            _ => "drag the dot in its plane  ·  drag the plane to change b",
        }
    }

    /// Where q, rad, lies in the scene while the present pose constant is b, rad.
    pub fn point(&self, q: &[f64], b: f64) -> [f64; 3] {
        match &self.0 {
            Kind::Prism(prism) => prism.point(q, b),
            Kind::Section(section) => section.point(q, b),
        }
    }

    /// q of a point of the scene, rad; drives without an axis stand as in a frame.
    pub fn angles(&self, point: [f64; 3], frame: &Frame) -> Vec<f64> {
        match &self.0 {
            Kind::Prism(prism) => prism.angles(point, frame.b_reference).to_vec(),
            Kind::Section(section) => section.angles(point, frame),
        }
    }

    /// The surface of a b, rad, within the limits, drives without an axis as in a frame: its ends or corners, in order.
    pub fn surface(&self, b: f64, frame: &Frame) -> Vec<[f64; 3]> {
        match &self.0 {
            Kind::Prism(prism) => prism.surface(b, frame.b_reference).to_vec(),
            Kind::Section(section) => section.surface(b, frame),
        }
    }

    /// A view of all of it.
    pub fn camera(&self) -> Camera {
        match &self.0 {
            Kind::Prism(prism) => prism.camera(),
            Kind::Section(section) => section.camera(),
        }
    }

    /// Corners of the box that holds it.
    pub fn corners(&self) -> Vec<[f64; 3]> {
        let ends = match &self.0 {
            Kind::Prism(prism) => prism.bounds_at_home(),
            Kind::Section(section) => section.bounds(),
        };
        (0..8).map(|i| [0, 1, 2].map(|k| ends[k][(i >> k) & 1])).collect()
    }

    /// Everything there is to draw.
    pub fn scene(&self, frame: &Frame, options: &ViewOptions, camera: &Camera) -> Scene {
        match &self.0 {
            Kind::Prism(prism) => prism.scene(frame, options, camera),
            Kind::Section(section) => section.scene(frame, options, camera),
        }
    }

    /// What the pointer can take hold of.
    pub fn pick(&self, frame: &Frame, pointer: &Pointer) -> Option<Pick> {
        match &self.0 {
            Kind::Prism(prism) => prism.pick(frame, pointer),
            Kind::Section(section) => section.pick(frame, pointer),
        }
    }

    /// What pulling at something asks for.
    pub fn aim(&self, pick: &Pick, frame: &Frame, pointer: &Pointer) -> Option<Aim> {
        match &self.0 {
            Kind::Prism(prism) => prism.aim(pick, frame, pointer),
            Kind::Section(section) => section.aim(pick, frame, pointer),
        }
    }
}
