//! What the pointer does: what it is over, what it holds, and what it is for.

use crate::picture::scene::options::Handle;
use crate::picture::scene::pick::Pick;

/// What the pointer, or the keyboard in its place, is over.
#[derive(Clone, Debug, Default)]
pub struct Pointed {
    /// In the scene.
    pub hot: Option<Handle>,
    /// What has its place in the panel under it.
    pub lit: Option<Handle>,
    /// The links that a term under it comes from.
    pub lit_links: Vec<usize>,
    /// The b under it in the chart of which b, rad.
    pub preview: Option<f64>,
}

/// A drag from the press of the button to its release; nothing of it outlives that.
#[derive(Clone, Debug, Default)]
pub struct Gesture {
    /// What was under the pointer when its button went down: it may have moved on before the drag is noticed.
    pub pressed: Option<Pick>,
    /// What is being dragged.
    pub grabbed: Option<Pick>,
    /// Where the pointer was last in this drag, and by how much what is dragged stays behind it since Shift was held,
    /// points of the screen.
    pub fine: [egui::Vec2; 2],
    /// Where the pointer holds the target, m.
    pub held: Option<[f64; 2]>,
    /// The force at the end effector before a hand pushes, N.
    pub force: [f64; 2],
    /// The drag has changed something.
    pub dragged: bool,
    /// How many changes there were to undo when it began.
    pub undone_to: usize,
}

/// What dragging in the scene does.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Tool {
    /// It takes hold of things.
    #[default]
    Hold,
    /// It draws a path: what has been drawn so far, m.
    Draw(Vec<[f64; 2]>),
    /// It pushes the end effector.
    Push,
}
