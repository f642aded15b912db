//! State of the pointer: the object under it, the drag under way, and the tool.

use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::pick::Pick;
use stillbase_session::scenario::SnapPoint;

/// Objects under the pointer or with the keyboard focus.
#[derive(Clone, Debug, Default)]
pub struct HoverTarget {
    /// Object of the scene under the pointer.
    pub object: Option<Handle>,
    /// Object whose rows in the panel are under the pointer or have the keyboard focus, or that a panel mentions.
    pub panel_object: Option<Handle>,
    /// Indices of the links that contribute to the term under the pointer.
    pub lit_links: Vec<usize>,
    /// b under the pointer in the chart *Which b?*, rad.
    pub preview: Option<f64>,
    /// Point to which the pointer snaps while it measures.
    pub snap: Option<SnapPoint>,
    /// Index of the measurement under the pointer.
    pub measurement: Option<usize>,
}

/// A drag, from the press of the button to its release.
#[derive(Clone, Debug, Default)]
pub struct DragGesture {
    /// Object under the pointer when the button was pressed; object or pointer may move until the drag is recognised.
    pub pressed: Option<Pick>,
    /// The dragged object.
    pub grabbed: Option<Pick>,
    /// Last position of the pointer in this drag, points of the screen.
    pub last_pointer: egui::Vec2,
    /// Displacement from the dragged position to the pointer, points of the screen. It grows while Shift slows the
    /// drag.
    pub pointer_offset: egui::Vec2,
    /// Position to which the pointer drags the target or a point of the path, m.
    pub position: Option<[f64; 2]>,
    /// The force at the end effector before the push, N.
    pub force: [f64; 2],
    /// Whether the drag has changed something.
    pub dragged: bool,
    /// Number of undo entries at the start of the drag.
    pub undo_entries: usize,
}

/// Effect of a drag in the scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Tool {
    /// Drags objects.
    #[default]
    Hold,
    /// Draws a path; contains the points drawn so far, m.
    Draw(Vec<[f64; 2]>),
    /// Pushes the end effector.
    Push,
    /// Measures; contains the points chosen so far.
    Measure(Vec<SnapPoint>),
}
