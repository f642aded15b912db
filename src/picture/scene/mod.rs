//! The picture between physics and GPU: plain data that a test can print.
//!
//! A [`Scene`] holds solids, lines, areas, markers and labels in world coordinates (metres; x and y in the plane of
//! motion, z along the drive axis, towards the viewer of the flat view). Numbers turn from `f64` into `f32` here and
//! nowhere else. Every item has a name, which is also its path in a recording, a pose `world_from_item`, and says what
//! of it [may change](Changes): geometry is made once, afterwards only poses change. Colours are sRGB with straight
//! alpha, as in the palette, and sizes called `px` are logical pixels.

pub mod arrow;
pub mod axes;
pub mod camera;
pub mod course;
pub mod dexterity;
pub mod draft;
pub mod exaggeration;
pub mod fill;
pub mod framing;
pub mod grid;
pub mod joints;
pub mod linkage;
pub mod mesh;
pub mod options;
pub mod palette;
pub mod pick;
pub mod pointer;
pub mod reaction;
pub mod stage;
pub mod tower;
pub mod views;
pub mod wall;

use std::borrow::Cow;
use std::sync::Arc;

use crate::mechanics::planar::Vector;

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

/// A name in parts, `machine/link/5`: of an item in its picture, and of its entity in a recording.
pub type Name = Cow<'static, str>;

/// world_from_item, column-major.
pub type Pose = [[f32; 4]; 4];

/// An item whose own coordinates are the world's.
pub const IN_PLACE: Pose = posed_at([1.0, 0.0], [0.0; 3]);

const fn posed_at([c, s]: [f32; 2], [x, y, z]: [f32; 3]) -> Pose {
    [[c, s, 0.0, 0.0], [-s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [x, y, z, 1.0]]
}

/// The pose of an item whose origin is at a point, m, and whose x axis lies along a unit vector.
pub fn posed(at: Vector, along: Vector, z: f64) -> Pose {
    posed_at([along.re as f32, along.im as f32], point(at, z))
}

/// A point of an item in the world.
pub fn place(pose: &Pose, p: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|r| pose[0][r] * p[0] + pose[1][r] * p[1] + pose[2][r] * p[2] + pose[3][r])
}

/// A point of the plane of motion at a height, m.
pub fn point(p: Vector, z: f64) -> [f32; 3] {
    [p.re as f32, p.im as f32, z as f32]
}

/// What of an item may change before the picture is prepared anew.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Changes {
    /// It stays as and where it is.
    Nothing,
    /// It moves: its geometry, colour and size stay.
    Pose,
    /// Anything, and it may be gone.
    #[default]
    Shape,
}

/// One mesh, placed and coloured. Several of one name share a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// What it is: `machine/link/5`.
    pub name: Name,
    /// Which mesh of the [`Model`].
    pub mesh: usize,
    /// world_from_item, column-major.
    pub world_from_item: Pose,
    /// Colour under full light; alpha below 1 blends (ghosts).
    pub colour: Rgba,
    /// What may change of it.
    pub changes: Changes,
}

/// Polylines that never change once made.
pub type Strips = Arc<[Vec<[f32; 3]>]>;

/// Polylines of constant width on the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it is.
    pub name: Name,
    /// Vertices of each, m. A closed one repeats its first point; none at all is a line that is not to be seen now.
    pub strips: Strips,
    /// world_from_item, column-major.
    pub world_from_item: Pose,
    /// Width, px.
    pub width: f32,
    /// Colour.
    pub colour: Rgba,
    /// Lengths of dash and gap, px; `None` is a solid line.
    pub dash: Option<[f32; 2]>,
    /// Drawn over everything, or hidden by solids in front of it.
    pub on_top: bool,
    /// What may change of it.
    pub changes: Changes,
}

impl Line {
    /// A solid line that is drawn anew whenever it changes, hidden by what is in front of it.
    pub fn new(name: impl Into<Name>, strips: impl Into<Strips>, width: f32, colour: Rgba) -> Self {
        Self {
            name: name.into(),
            strips: strips.into(),
            world_from_item: IN_PLACE,
            width,
            colour,
            dash: None,
            on_top: false,
            changes: Changes::Shape,
        }
    }

    /// In dashes and gaps, px.
    #[must_use]
    pub fn dashed(self, dash: f32, gap: f32) -> Self {
        Self { dash: Some([dash, gap]), ..self }
    }

    /// The same line, drawn over everything.
    #[must_use]
    pub fn on_top(self) -> Self {
        Self { on_top: true, ..self }
    }

    /// It stays as and where it is.
    #[must_use]
    pub fn still(self) -> Self {
        Self { changes: Changes::Nothing, ..self }
    }

    /// It keeps its shape and stands in a pose.
    #[must_use]
    pub fn moving(self, world_from_item: Pose) -> Self {
        Self { changes: Changes::Pose, world_from_item, ..self }
    }

    /// Its vertices in the world, strip by strip.
    pub fn points(&self) -> Vec<[f32; 3]> {
        self.strips.iter().flatten().map(|p| place(&self.world_from_item, *p)).collect()
    }
}

/// A reactionless workspace as Eq. (16) states it: for `(a_1, a_2)` in the rectangle,
/// `x + iy = B + e^{i turn} Σ_k c_k e^{i (u_k · a + v_k)}`. The renderer evaluates it per vertex and knows nothing
/// more.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// What it is.
    pub name: Name,
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

impl Area {
    /// Where its plane stands before Eq. (16) is turned.
    pub fn world_from_item(&self) -> Pose {
        let [x, y] = self.at;
        posed_at([self.turn.cos(), self.turn.sin()], [x, y, self.z])
    }
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

/// A disc or ring of constant size on the screen: a joint dot, a handle, the end effector. Several may have one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// What it is.
    pub name: Name,
    /// Centre, m: all of its pose.
    pub at: [f32; 3],
    /// Outer radius, px.
    pub radius: f32,
    /// Inside; alpha 0 leaves it hollow.
    pub fill: Rgba,
    /// Colour of the edge.
    pub stroke: Rgba,
    /// Width of the edge, px.
    pub stroke_width: f32,
}

impl Marker {
    /// A disc without an edge.
    pub fn disc(name: impl Into<Name>, at: [f32; 3], radius: f32, fill: Rgba) -> Self {
        Self { name: name.into(), at, radius, fill, stroke: fill, stroke_width: 0.0 }
    }

    /// With an edge.
    #[must_use]
    pub fn edged(self, stroke: Rgba, stroke_width: f32) -> Self {
        Self { stroke, stroke_width, ..self }
    }
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

/// Text beside a point. Several may have one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Of what: `plan/names`.
    pub name: Name,
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

impl Label {
    /// Text of a colour and size beside a point.
    pub fn new(
        name: impl Into<Name>,
        at: [f32; 3],
        offset: [f32; 2],
        text: impl Into<String>,
        colour: Rgba,
        size: f32,
        anchor: Anchor,
    ) -> Self {
        Self { name: name.into(), at, offset, text: text.into(), colour, size, anchor }
    }
}

/// The soft shadow of a bar on a plane below it, seen in space; no thing of its own, so it has no name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadow {
    /// The ends of its middle line, m.
    pub ends: [[f32; 2]; 2],
    /// Height of the plane, m.
    pub z: f32,
    /// Half the width of what is fully dark, m.
    pub core: f32,
    /// From the middle to where it ends, m.
    pub reach: f32,
    /// How dark, from 0 to 1.
    pub strength: f32,
}

/// Everything there is to draw at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Colour behind everything.
    pub background: Rgba,
    /// Meshes that the solids refer to.
    pub model: Arc<Model>,
    /// Fills, under all lines; solids in front of them hide them. Later ones blend over earlier ones.
    pub areas: Vec<Area>,
    /// Of bars, over the fills.
    pub shadows: Vec<Shadow>,
    /// Bars, joints, base.
    pub solids: Vec<Solid>,
    /// Grid, boundaries, paths, arrows.
    pub lines: Vec<Line>,
    /// Handles and dots, over everything.
    pub markers: Vec<Marker>,
    /// Words, over everything; drawn by egui, which has the fonts.
    pub labels: Vec<Label>,
    /// The middle lines of the machine's bars, which words keep off.
    pub bars: Vec<[[f32; 3]; 2]>,
}

impl Scene {
    /// Nothing yet, in front of a background.
    pub fn new(background: Rgba, model: Arc<Model>) -> Self {
        Self {
            background,
            model,
            areas: Vec::new(),
            shadows: Vec::new(),
            solids: Vec::new(),
            lines: Vec::new(),
            markers: Vec::new(),
            labels: Vec::new(),
            bars: Vec::new(),
        }
    }

    /// Whether another one looks the same but for its words.
    pub fn looks_like(&self, other: &Self) -> bool {
        let Self { background, model, areas, shadows, solids, lines, markers, labels: _, bars: _ } = self;
        Arc::ptr_eq(model, &other.model)
            && (background, areas, solids, markers) == (&other.background, &other.areas, &other.solids, &other.markers)
            && (shadows, lines) == (&other.shadows, &other.lines)
    }
}
