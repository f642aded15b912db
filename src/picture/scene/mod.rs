//! The picture between physics and GPU: plain data that a test can print.
//!
//! A [`Scene`] holds solids, lines, areas, markers and labels in world coordinates (metres; x and y in the plane of
//! motion, z along the drive axis, towards the viewer of the flat view). Numbers turn from `f64` into `f32` here and
//! nowhere else. Colours are sRGB with straight alpha, as in the palette, and sizes called `px` are logical pixels.

pub mod axes;
pub mod camera;
pub mod dexterity;
pub mod joint_space;
pub mod linkage;
pub mod mesh;
pub mod palette;
pub mod pointer;
pub mod reaction;
pub mod stage;
pub mod sway;
pub mod tower;
pub mod views;
pub mod wall;

use std::sync::Arc;

/// sRGB red, green, blue and straight alpha, each 0..1.
pub type Rgba = [f32; 4];

/// A triangle mesh with one normal a vertex; counter-clockwise triangles face outwards. Closed, unless it is a shell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one a vertex.
    pub normals: Vec<[f32; 3]>,
    /// Triangles, as vertex numbers.
    pub triangles: Vec<[u32; 3]>,
    /// An open surface that is seen from both sides; being translucent, it hides nothing and every layer of it counts.
    pub shell: bool,
}

/// The meshes of one machine. They never change while it moves, so they are uploaded once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Meshes in their own frames; [`Solid::mesh`] counts in this list.
    pub meshes: Vec<Mesh>,
}

/// One mesh, placed and coloured.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// What it is, for tests and recordings: `link/5`, `joint/3`, `base/1`.
    pub name: String,
    /// Which mesh of the [`Model`].
    pub mesh: usize,
    /// world_from_mesh, column-major.
    pub world_from_mesh: [[f32; 4]; 4],
    /// Colour under full light; alpha below 1 blends (ghosts).
    pub colour: Rgba,
}

/// A polyline of constant width on the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it is.
    pub name: String,
    /// Vertices, m. A closed line repeats its first point.
    pub points: Vec<[f32; 3]>,
    /// Width, px.
    pub width: f32,
    /// Colour.
    pub colour: Rgba,
    /// Lengths of dash and gap, px; `None` is a solid line.
    pub dash: Option<[f32; 2]>,
    /// Drawn over everything, or hidden by solids in front of it.
    pub on_top: bool,
}

/// A reactionless workspace as Eq. (16) states it: for `(a_1, a_2)` in the rectangle,
/// `x + iy = B + e^{i turn} Σ_k c_k e^{i (u_k · a + v_k)}`. The renderer evaluates it per vertex and knows nothing more.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// What it is.
    pub name: String,
    /// `c_k`, m.
    pub c: [f32; 3],
    /// `u_k`, rad per rad.
    pub u: [[f32; 2]; 3],
    /// `v_k`, rad.
    pub v: [f32; 3],
    /// Least `(a_1, a_2)`, rad.
    pub a_min: [f32; 2],
    /// Greatest `(a_1, a_2)`, rad.
    pub a_max: [f32; 2],
    /// b*, rad: turns the whole area about B.
    pub turn: f32,
    /// B, m.
    pub at: [f32; 2],
    /// Height of its plane, m.
    pub z: f32,
    /// Fill of one sheet; where sheets overlap, the colour gathers.
    pub colour: Rgba,
    /// Shades the fill by a measure of dexterity.
    pub shade: Option<Shade>,
}

/// A colour that a fill turns into as a measure of dexterity grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shade {
    /// Of what: the arms as vectors tell it at each vertex.
    pub measure: Measure,
    /// The fill where the measure is [`full`](Self::full) or more.
    pub colour: Rgba,
    /// Where it still has the area's own colour, 0 for det.
    pub empty: f32,
    /// Where it has this colour.
    pub full: f32,
}

/// A measure of dexterity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Measure {
    /// |det ∂(x, y)/∂(a_1, a_2)|, m².
    Det = 0,
    /// √det(J Jᵀ), m².
    Manipulability = 1,
    /// The greatest |τ| of a unit force at the end effector, N m/N.
    TorquePerForce = 2,
}

/// A disc or ring of constant size on the screen: a joint dot, a handle, the end effector.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// What it is; handles that can be dragged are found by [`name`](Self::name) in the pick.
    pub name: String,
    /// Centre, m.
    pub at: [f32; 3],
    /// Outer radius, px.
    pub radius: f32,
    /// Inside; alpha 0 leaves it hollow.
    pub fill: Rgba,
    /// Edge.
    pub stroke: Rgba,
    /// Width of the edge, px.
    pub stroke_width: f32,
}

/// Where a label's anchor lies on its box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text runs to the right of the anchor.
    Left,
    /// The text is centred on the anchor.
    Centre,
    /// The text ends at the anchor.
    Right,
}

/// Text beside a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Point it belongs to, m.
    pub at: [f32; 3],
    /// Shift on the screen, px; y down.
    pub offset: [f32; 2],
    /// The words.
    pub text: String,
    /// Colour.
    pub colour: Rgba,
    /// Height of the type, px.
    pub size: f32,
    /// Which side of the text holds the anchor.
    pub anchor: Anchor,
}

/// Everything there is to draw at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Behind everything.
    pub background: Rgba,
    /// Meshes that the solids refer to.
    pub model: Arc<Model>,
    /// Fills, under all lines; solids in front of them hide them. Later ones blend over earlier ones.
    pub areas: Vec<Area>,
    /// Bars, joints, base.
    pub solids: Vec<Solid>,
    /// Grid, boundaries, paths, arrows.
    pub lines: Vec<Line>,
    /// Handles and dots, over everything.
    pub markers: Vec<Marker>,
    /// Words, over everything; drawn by whoever owns a font.
    pub labels: Vec<Label>,
}
