//! State of the pointer: the object under it, the drag under way, and the tool.

use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::pick::Pick;

/// What is under the pointer or has the keyboard focus.
#[derive(Clone, Debug, Default)]
pub struct HoverTarget {
    /// Object of the scene under the pointer.
    pub object: Option<Handle>,
    /// Object whose rows in the panel are under the pointer.
    pub panel_object: Option<Handle>,
    /// Links that contribute to the term under the pointer.
    pub lit_links: Vec<usize>,
    /// b under the pointer in the chart *Which b?*, rad.
    pub preview: Option<f64>,
}

/// A drag, from the press of the button to its release.
#[derive(Clone, Debug, Default)]
pub struct DragGesture {
    /// Object under the pointer at the press of the button: it may have moved before the drag is noticed.
    pub pressed: Option<Pick>,
    /// The dragged object.
    pub grabbed: Option<Pick>,
    /// Last position of the pointer in this drag, points of the screen.
    pub last_pointer: egui::Vec2,
    /// Offset of the dragged object behind the pointer since Shift was held, points of the screen.
    pub pointer_offset: egui::Vec2,
    /// Position to which the pointer drags the target or a point, m.
    pub position: Option<[f64; 2]>,
    /// The force at the end effector before the push, N.
    pub force: [f64; 2],
    /// The drag has changed something.
    pub dragged: bool,
    /// Number of undo entries at its start.
    pub undo_entries: usize,
}

/// Effect of a drag in the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Tool {
    /// Drags objects.
    #[default]
    Hold,
    /// Draws a path; holds the points drawn so far, m.
    Draw(Vec<[f64; 2]>),
    /// Pushes the end effector.
    Push,
}
