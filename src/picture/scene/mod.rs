//! Scenes as plain data between simulation and renderer.
//!
//! A [`Scene`] holds solids, lines, areas, markers and labels in world coordinates, in metres. x and y lie in the
//! plane of motion; z points along the drive axis, towards the viewer of the flat view. Numbers are converted from
//! `f64` to `f32` here and nowhere else. Every item has a name, which is also its path in a recording. Solids and
//! lines also have a pose `world_from_item` and a statement of which parts [may change](ItemChanges). Most geometry
//! is built once;
//! afterwards only poses change. Colours are sRGB with straight alpha, as in the [`palette`]. Sizes in `px` are
//! logical pixels.

#[doc(hidden)]
pub mod arrow;
#[doc(hidden)]
pub mod axes;
pub mod beside;
#[doc(hidden)]
pub mod blocks;
pub mod camera;
#[doc(hidden)]
pub mod course;
#[doc(hidden)]
pub mod dexterity;
#[doc(hidden)]
pub mod draft;
pub mod exaggeration;
#[doc(hidden)]
pub mod fill;
#[doc(hidden)]
pub mod framing;
#[doc(hidden)]
pub mod grid;
#[doc(hidden)]
pub mod joints;
#[doc(hidden)]
pub mod linkage;
pub mod measurement;
#[doc(hidden)]
pub mod mesh;
pub mod options;
pub mod overlay;
pub mod palette;
#[doc(hidden)]
pub mod pick;
#[doc(hidden)]
pub mod platform_reach;
#[doc(hidden)]
pub mod pointer;
#[doc(hidden)]
pub mod portrait;
pub mod reaction;
#[cfg(feature = "ui")]
pub(crate) mod segment;
#[doc(hidden)]
pub mod sketching;
#[doc(hidden)]
pub mod stage;
#[doc(hidden)]
pub mod thin;
pub mod tower;
pub mod views;
#[doc(hidden)]
pub mod wall;

use crate::notation::Notation;
use options::Handle;
use std::borrow::Cow;
use std::sync::Arc;

use stillbase_mechanics::planar::Vector;

/// sRGB red, green, blue and straight alpha, each 0..1.
pub type Rgba = [f32; 4];

/// A triangle mesh with one normal per vertex; counter-clockwise triangles face outwards. Closed, unless it is a shell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Vertices, m.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, one per vertex.
    pub normals: Vec<[f32; 3]>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The same body with fewer triangles, for drawing in draft quality.
    pub coarse: Option<Box<Mesh>>,
    /// Whether the mesh is an open translucent surface: visible from both sides, all layers are drawn, and it hides
    /// nothing.
    pub shell: bool,
}

/// The meshes of one machine. They do not change while it moves, so they are uploaded once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshSet {
    /// Meshes in their own frames; [`Solid::mesh`] is an index into this list.
    pub meshes: Vec<Mesh>,
}

/// First part of the names of user notes; the number of the note follows, from 1.
pub const NOTES: &str = "notes";

/// Hierarchical name of an item of a scene and of its entity in a recording, like `machine/link/5`.
pub type Name = Cow<'static, str>;

/// Homogeneous transformation world_from_item, column-major.
pub type Transform = [[f32; 4]; 4];

/// The identity: coordinates of the item are world coordinates.
pub const IN_PLACE: Transform = posed_at([1.0, 0.0], [0.0; 3]);

const fn posed_at([c, s]: [f32; 2], [x, y, z]: [f32; 3]) -> Transform {
    [[c, s, 0.0, 0.0], [-s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [x, y, z, 1.0]]
}

/// Returns the pose of an item with its origin at the point `at` and height `z`, m, and its x axis along a unit vector.
pub fn posed(at: Vector, along: Vector, z: f64) -> Transform {
    posed_at([along.re as f32, along.im as f32], point(at, z))
}

/// Transforms a point of an item to world coordinates.
pub fn place(pose: &Transform, p: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|r| pose[0][r] * p[0] + pose[1][r] * p[1] + pose[2][r] * p[2] + pose[3][r])
}

/// Returns the world coordinates of a point of the plane of motion at height `z`, m.
pub fn point(p: Vector, z: f64) -> [f32; 3] {
    [p.re as f32, p.im as f32, z as f32]
}

/// The parts of an item that may change until the scene is prepared again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ItemChanges {
    /// Nothing changes.
    Nothing,
    /// Only the pose changes; geometry, colour and size are constant.
    Pose,
    /// Everything may change, and the item may disappear.
    #[default]
    Shape,
}

/// A mesh with pose and colour. Solids with the same name share a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Name, like `machine/link/5`.
    pub name: Name,
    /// Index of the mesh in the [`MeshSet`].
    pub mesh: usize,
    /// world_from_item, column-major.
    pub world_from_item: Transform,
    /// Colour under full light; translucent if alpha is below 1.
    pub colour: Rgba,
    /// Parts that may change.
    pub changes: ItemChanges,
}

/// Immutable polylines.
pub type Strips = Arc<[Vec<[f32; 3]>]>;

/// Polylines of constant width on the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    /// Name.
    pub name: Name,
    /// Vertices of each polyline, m. A closed one repeats its first point; an empty list is a line that is currently
    /// hidden.
    pub strips: Strips,
    /// world_from_item, column-major.
    pub world_from_item: Transform,
    /// Width, px.
    pub width: f32,
    /// Colour.
    pub colour: Rgba,
    /// Lengths of dash and gap, px; `None` is a solid line.
    pub dash: Option<[f32; 2]>,
    /// Whether it is drawn over everything; otherwise solids in front of it hide it.
    pub on_top: bool,
    /// Parts that may change.
    pub changes: ItemChanges,
}

impl Polyline {
    /// Returns a solid line in world coordinates that may change and that solids in front of it hide.
    pub fn new(name: impl Into<Name>, strips: impl Into<Strips>, width: f32, colour: Rgba) -> Self {
        Self {
            name: name.into(),
            strips: strips.into(),
            world_from_item: IN_PLACE,
            width,
            colour,
            dash: None,
            on_top: false,
            changes: ItemChanges::Shape,
        }
    }

    /// Returns the line with dashes and gaps, px.
    #[must_use]
    pub fn dashed(self, dash: f32, gap: f32) -> Self {
        Self { dash: Some([dash, gap]), ..self }
    }

    /// Returns the line drawn over everything.
    #[must_use]
    pub fn on_top(self) -> Self {
        Self { on_top: true, ..self }
    }

    /// Returns the line marked as constant.
    #[must_use]
    pub fn constant(self) -> Self {
        Self { changes: ItemChanges::Nothing, ..self }
    }

    /// Returns the line in a pose, marked as constant except for its pose.
    #[must_use]
    pub fn moving(self, world_from_item: Transform) -> Self {
        Self { changes: ItemChanges::Pose, world_from_item, ..self }
    }

    /// Returns all vertices in world coordinates, strip by strip.
    pub fn points(&self) -> Vec<[f32; 3]> {
        self.strips.iter().flatten().map(|p| place(&self.world_from_item, *p)).collect()
    }
}

/// A reactionless workspace, Eq. (16): for `(a_1, a_2)` in the rectangle,
/// `x + iy = B + e^{i turn} Σ_k c_k e^{i (u_k · a + v_k)}`. The renderer evaluates this formula at each vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// Name.
    pub name: Name,
    /// `c_k`, m.
    pub c: [f32; 3],
    /// `u_k`, rad per rad.
    pub u: [[f32; 2]; 3],
    /// `v_k`, rad.
    pub v: [f32; 3],
    /// Lower bounds of `(a_1, a_2)`, rad.
    pub a_min: [f32; 2],
    /// Upper bounds of `(a_1, a_2)`, rad.
    pub a_max: [f32; 2],
    /// Rotation b* of the whole area about B, rad.
    pub turn: f32,
    /// Position of B, m.
    pub at: [f32; 2],
    /// Height of its plane, m.
    pub z: f32,
    /// World_from_plane, column-major: the plane of the machine is that of the world unless it is a block in space.
    pub world_from_plane: Transform,
    /// Colour of one sheet; overlapping sheets blend to a stronger colour.
    pub colour: Rgba,
    /// Colour scale for a measure of dexterity.
    pub shade: Option<Shade>,
}

impl Area {
    /// Returns the pose in which Eq. (16) with `turn` = 0 and B = 0 gives the area.
    pub fn world_from_item(&self) -> Transform {
        let [x, y] = self.at;
        let in_plane = posed_at([self.turn.cos(), self.turn.sin()], [x, y, self.z]);
        (nalgebra::Matrix4::from(self.world_from_plane) * nalgebra::Matrix4::from(in_plane)).into()
    }
}

/// Colour scale from the colour of an area to a second colour, by a measure of dexterity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shade {
    /// Measure of dexterity, evaluated at each vertex.
    pub measure: Measure,
    /// Colour where the measure is [`full`](Self::full) or more.
    pub colour: Rgba,
    /// Value of the measure with the area's own colour; 0 for det.
    pub empty: f32,
    /// Value of the measure with the second colour.
    pub full: f32,
}

/// A measure of dexterity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
#[repr(u32)]
pub enum Measure {
    /// |det ∂(x, y)/∂(a_1, a_2)|, m².
    Det = 0,
    /// √det(J Jᵀ), m².
    Manipulability = 1,
    /// Maximum |τ| over all unit forces at the end effector, N m/N.
    TorquePerForce = 2,
}

/// A disc or ring of constant size on the screen, for joints, handles and the end effector. Several may have one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Name.
    pub name: Name,
    /// Centre, m.
    pub at: [f32; 3],
    /// Outer radius, px.
    pub radius: f32,
    /// Colour of the inside; hollow if alpha is 0.
    pub fill: Rgba,
    /// Colour of the edge.
    pub stroke: Rgba,
    /// Width of the edge, px.
    pub stroke_width: f32,
}

impl Marker {
    /// Returns a disc without an edge.
    pub fn disc(name: impl Into<Name>, at: [f32; 3], radius: f32, fill: Rgba) -> Self {
        Self { name: name.into(), at, radius, fill, stroke: fill, stroke_width: 0.0 }
    }

    /// Returns the marker with an edge of the given colour and width, px.
    #[must_use]
    pub fn edged(self, stroke: Rgba, stroke_width: f32) -> Self {
        Self { stroke, stroke_width, ..self }
    }
}

/// Position of the anchor point on the rectangle of a label.
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
    /// Name, like `plan/names`.
    pub name: Name,
    /// Point that it belongs to, m.
    pub at: [f32; 3],
    /// Shift on the screen, px; y down.
    pub offset: [f32; 2],
    /// Text.
    pub text: String,
    /// Colour.
    pub colour: Rgba,
    /// Font size, px.
    pub size: f32,
    /// Position of the anchor point.
    pub anchor: Anchor,
    /// Handle that the pointer takes by the label, too.
    pub handle: Option<Handle>,
}

/// A part of the machine seen from above: a strip with round ends, or a disc if both ends are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Ends of the centre line of its lower face, m.
    pub ends: [[f32; 3]; 2],
    /// Half its width, m.
    pub radius: f32,
    /// Height, m.
    pub height: f32,
}

impl Label {
    /// Returns the label as a part of a handle.
    #[must_use]
    pub fn of_handle(self, handle: Handle) -> Self {
        Self { handle: Some(handle), ..self }
    }

    /// Returns a label of the given text, colour and size beside a point.
    pub fn new(
        name: impl Into<Name>,
        at: [f32; 3],
        offset: [f32; 2],
        text: impl Into<String>,
        colour: Rgba,
        size: f32,
        anchor: Anchor,
    ) -> Self {
        Self { name: name.into(), at, offset, text: text.into(), colour, size, anchor, handle: None }
    }
}

/// The soft shadow of a bar on a plane below it, in the perspective view. It is not an item, so it has no name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadow {
    /// End points of its centre line, m.
    pub ends: [[f32; 2]; 2],
    /// Height of the plane, m.
    pub z: f32,
    /// Half width of the fully dark part, m.
    pub core: f32,
    /// Half width of the whole shadow, m.
    pub reach: f32,
    /// Opacity, from 0 to 1.
    pub strength: f32,
}

/// All items to be drawn at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Background colour.
    pub background: Rgba,
    /// Meshes that the solids refer to.
    pub model: Arc<MeshSet>,
    /// Filled areas, under all lines; solids in front of them hide them. Later ones blend over earlier ones.
    pub areas: Vec<Area>,
    /// Shadows of bars, over the areas.
    pub shadows: Vec<Shadow>,
    /// Bars, joints, base.
    pub solids: Vec<Solid>,
    /// Grid, boundaries, paths, arrows.
    pub lines: Vec<Polyline>,
    /// Handles and dots, over everything.
    pub markers: Vec<Marker>,
    /// Labels, over everything; drawn by egui, which has the fonts.
    pub labels: Vec<Label>,
    /// Parts of the machine, which labels avoid.
    pub bodies: Vec<Body>,
    /// Notation of the user: quantities with SI units in label texts are converted to it when the labels are painted.
    pub notation: Notation,
}

impl Scene {
    /// Returns an empty scene with a background colour.
    pub fn new(background: Rgba, model: Arc<MeshSet>) -> Self {
        Self {
            background,
            model,
            areas: Vec::new(),
            shadows: Vec::new(),
            solids: Vec::new(),
            lines: Vec::new(),
            markers: Vec::new(),
            labels: Vec::new(),
            bodies: Vec::new(),
            notation: Notation::default(),
        }
    }

    /// Whether another scene looks the same except for its labels.
    pub fn looks_like(&self, other: &Self) -> bool {
        let Self { background, model, areas, shadows, solids, lines, markers, labels: _, bodies: _, notation: _ } =
            self;
        Arc::ptr_eq(model, &other.model)
            && (background, areas, solids, markers) == (&other.background, &other.areas, &other.solids, &other.markers)
            && (shadows, lines) == (&other.shadows, &other.lines)
    }
}
