//! One entity of a recording: its constant shape, and the rows of its changing components until they are written.

use std::f32::consts::TAU;
use std::sync::Arc;

use crate::rerun::{
    AsComponents, Clear, EntityPath, InstancePoses3D, LineStrips3D, Mesh3D, Points3D, Quaternion, Radius, Transform3D,
};

use super::dashes::dashed;
use super::eye::Eye;
use super::rows::SparseRows;
use super::store::{Instant, RowTimes, Store, StoreError};
use super::style::{CombinedArchetypes, colour, solid};
use stillbase_picture::scene::{Area, ItemChanges, Mesh, MeshSet, Rgba, Strips, Transform};

/// Number of grid cells of a workspace along each angle.
const CELLS: u32 = 40;
/// Maximum number of dashes and gaps of a constant line.
const MAX_DASHES_CONSTANT: f32 = 400.0;
/// Maximum number of dashes and gaps of a line that changes.
const MAX_DASHES_CHANGING: f32 = 13.0;
/// Tolerance for equality of poses: m for translations, and components of the unit vector for rotations.
const POSE_TOLERANCE: f32 = 2e-6;

/// A rotation about z, as cosine and sine, and a translation, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    pub along: [f32; 2],
    pub at: [f32; 3],
}

impl Rigid {
    pub const IDENTITY: Self = Self { along: [1.0, 0.0], at: [0.0; 3] };

    pub fn of(pose: &Transform) -> Self {
        Self { along: [pose[0][0], pose[0][1]], at: [pose[3][0], pose[3][1], pose[3][2]] }
    }

    pub fn shifted(at: [f32; 3]) -> Self {
        Self { at, ..Self::IDENTITY }
    }

    /// Transforms a point of the world to the coordinates of this pose.
    pub fn inside(&self, p: [f32; 3]) -> [f32; 3] {
        let [c, s] = self.along;
        let d = [0, 1, 2].map(|i| p[i] - self.at[i]);
        [c * d[0] + s * d[1], c * d[1] - s * d[0], d[2]]
    }

    /// Returns this pose relative to another.
    pub fn within(&self, outer: &Self) -> Self {
        let ([c, s], [x, y]) = (outer.along, self.along);
        Self { along: [c * x + s * y, c * y - s * x], at: outer.inside(self.at) }
    }

    pub fn is_near(&self, other: &Self) -> bool {
        let near = |a: f32, b: f32| (a - b).abs() < POSE_TOLERANCE;
        self.at.into_iter().zip(other.at).chain(self.along.into_iter().zip(other.along)).all(|(a, b)| near(a, b))
    }

    pub fn turn(&self) -> Quaternion {
        let half = 0.5 * f64::from(self.along[1]).atan2(f64::from(self.along[0]));
        Quaternion::from_xyzw([0.0, 0.0, half.sin() as f32, half.cos() as f32])
    }
}

/// Kinds of items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntityKind {
    Solid,
    Area,
    Line,
    Marker,
    Label,
}

/// A point with a radius on the screen, px, a colour and a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Dot {
    pub at: [f32; 3],
    pub radius: f32,
    pub rgba: Rgba,
    pub text: String,
}

/// Lines with a width, px, a colour and dashes.
#[derive(Clone, Debug)]
pub struct Strokes {
    pub strips: Strips,
    pub width: f32,
    pub rgba: Rgba,
    pub dash: Option<[f32; 2]>,
}

impl PartialEq for Strokes {
    fn eq(&self, other: &Self) -> bool {
        (self.width, self.rgba, self.dash) == (other.width, other.rgba, other.dash)
            && (Arc::ptr_eq(&self.strips, &other.strips) || self.strips == other.strips)
    }
}

/// Components of an entity that can change at any instant.
#[derive(Clone, Debug)]
pub enum EntityShape {
    Strokes(Strokes),
    Dots(Vec<Dot>),
    Instances(Vec<[f32; 3]>),
    Mesh(Arc<MeshSet>, usize),
}

impl PartialEq for EntityShape {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Strokes(a), Self::Strokes(b)) => a == b,
            (Self::Dots(a), Self::Dots(b)) => a == b,
            (Self::Instances(a), Self::Instances(b)) => a == b,
            (Self::Mesh(a, i), Self::Mesh(b, k)) => i == k && Arc::ptr_eq(a, b) || a.meshes[*i] == b.meshes[*k],
            _ => false,
        }
    }
}

/// Components of an entity that are constant until they are written again.
#[derive(Clone, Debug)]
pub enum StaticShape {
    Mesh(Arc<MeshSet>, usize, Rgba),
    Sheet(Area),
    Strokes(Strokes),
    Ring {
        radius: f32,
        width: f32,
        rgba: Rgba,
    },
    /// Colour of meshes that change.
    Tint(Rgba),
}

impl PartialEq for StaticShape {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Mesh(a, i, rgba), Self::Mesh(b, k, other)) => {
                rgba == other && (i == k && Arc::ptr_eq(a, b) || a.meshes[*i] == b.meshes[*k])
            }
            (Self::Sheet(a), Self::Sheet(b)) => a == b,
            (Self::Strokes(a), Self::Strokes(b)) => a == b,
            (Self::Ring { radius: a, .. }, Self::Ring { radius: b, .. }) => a == b,
            (Self::Tint(a), Self::Tint(b)) => a == b,
            _ => false,
        }
    }
}

/// One entity.
#[derive(Debug)]
pub struct Entity {
    pub kind: EntityKind,
    pub path: EntityPath,
    /// Names of its ancestors, nearest first, which may have poses.
    pub ancestors: Vec<String>,
    /// Constant components in the current scene.
    pub constant: Option<StaticShape>,
    /// Changing components in the current scene.
    pub shape: Option<EntityShape>,
    /// Pose in the current scene.
    pub pose: Option<(Rigid, ItemChanges)>,
    /// Pose and vertical scale factor of each solid with the name of this entity.
    pub placed: Vec<(Rigid, f32)>,
    /// Centres of the rings with the name of this entity, and their common radius, m.
    pub rings: (Vec<[f32; 3]>, f32),
    /// Whether the current scene contains the entity.
    pub is_there: bool,
    /// Constant components that have been written.
    pub written: Option<StaticShape>,
    /// Whether a constant pose has been written.
    pub pose_is_static: bool,
    pub shapes: SparseRows<Option<EntityShape>>,
    pub poses: SparseRows<Rigid>,
}

impl Entity {
    pub fn new(kind: EntityKind, path: EntityPath, name: &str) -> Self {
        let cuts = name.match_indices('/').map(|(i, _)| i).collect::<Vec<_>>();
        Self {
            kind,
            path,
            ancestors: cuts.into_iter().rev().map(|i| name[..i].to_owned()).collect(),
            constant: None,
            shape: None,
            pose: None,
            placed: Vec::new(),
            rings: (Vec::new(), 0.0),
            is_there: false,
            written: None,
            pose_is_static: false,
            shapes: SparseRows::new(),
            poses: SparseRows::new(),
        }
    }

    pub fn begin(&mut self) {
        (self.constant, self.shape, self.pose, self.is_there) = (None, None, None, false);
        self.placed.clear();
        self.rings.0.clear();
    }

    /// Adds lines; lines of one name and style form one shape.
    pub fn strokes(&mut self, strokes: Strokes) {
        match &mut self.shape {
            Some(EntityShape::Strokes(all)) if all.is_alike(&strokes) => {
                all.strips = all.strips.iter().chain(strokes.strips.iter()).cloned().collect();
            }
            _ => self.shape = Some(EntityShape::Strokes(strokes)),
        }
    }

    pub fn dot(&mut self, dot: Dot) {
        match &mut self.shape {
            Some(EntityShape::Dots(dots)) => dots.push(dot),
            _ => self.shape = Some(EntityShape::Dots(vec![dot])),
        }
    }

    /// Converts several solids of one name, or one that is stretched, to instances of one mesh, and several rings
    /// to one shape; the entity then has no pose.
    pub fn share(&mut self) {
        if let (Some(StaticShape::Ring { width, rgba, .. }), (middles, radius)) = (&self.constant, &self.rings)
            && middles.len() > 1
        {
            let ring = |[x, y, z]: &[f32; 3]| circle(*radius).map(|[u, v, _]| [x + u, y + v, *z]).collect();
            let strips = middles.iter().map(ring).collect();
            self.shape = Some(EntityShape::Strokes(Strokes { strips, width: *width, rgba: *rgba, dash: None }));
            (self.constant, self.pose) = (None, None);
        }
        if self.placed.len() > 1 || self.placed.iter().any(|(_, stretch)| *stretch != 1.0) {
            self.shape = Some(EntityShape::Instances(self.placed.iter().map(|(pose, _)| pose.at).collect()));
            self.pose = None;
        }
    }

    /// Writes new constant components of the current scene, from `since` on or for all times, and buffers rows of
    /// changing ones. `outer` is the pose of the nearest ancestor that has a pose.
    pub fn record(
        &mut self,
        store: &mut Store,
        at: Instant,
        since: Option<Instant>,
        outer: &Rigid,
        eye: &Eye,
    ) -> Result<(), StoreError> {
        if !self.is_there {
            if self.written.take().is_some() {
                store.shape(Some(at), &self.path, &Clear::flat())?;
                self.write_poses(store, eye)?;
                (self.poses, self.pose_is_static) = (SparseRows::new(), false);
            }
            if matches!(self.shapes.last(), Some(Some(_))) {
                self.shapes.push(at, None);
            }
            return Ok(());
        }
        let lasting = self.constant.take().filter(|lasting| self.written.as_ref() != Some(lasting));
        let mut stands = None;
        if let Some((pose, changes)) = self.pose {
            let pose = pose.within(outer);
            // Relative to an ancestor, equal poses may differ by rounding errors.
            let is_part = *outer != Rigid::IDENTITY;
            let same = |last: &Rigid| if is_part { last.is_near(&pose) } else { *last == pose };
            let known = self.poses.last().is_some_and(same);
            let never = self.poses.last().is_none() && !self.pose_is_static;
            let at_home = never && pose.is_near(&Rigid::IDENTITY);
            match (changes, since) {
                _ if known || at_home => {}
                (ItemChanges::Nothing, None) if never => {
                    stands = Some(transform(&[pose], eye));
                    self.pose_is_static = true;
                }
                (ItemChanges::Nothing, None) => {}
                _ => self.poses.push(at, pose),
            }
        }
        match (lasting, stands) {
            (Some(lasting), stands) => {
                self.write_lasting(store, since, &lasting, stands.as_ref(), eye)?;
                self.written = Some(lasting);
            }
            (None, Some(stands)) => store.fixed(&self.path, &stands)?,
            (None, None) => {}
        }
        if let Some(mut shape) = self.shape.take() {
            match &mut shape {
                EntityShape::Dots(dots) => dots.iter_mut().for_each(|dot| dot.at = eye.place(outer.inside(dot.at))),
                EntityShape::Instances(places) => places.iter_mut().for_each(|p| *p = eye.place(outer.inside(*p))),
                EntityShape::Strokes(_) | EntityShape::Mesh(..) => {}
            }
            self.shapes.push(at, Some(shape));
        }
        Ok(())
    }

    /// Writes constant components, with the constant pose `stands` if there is one.
    fn write_lasting(
        &self,
        store: &mut Store,
        since: Option<Instant>,
        lasting: &StaticShape,
        stands: Option<&Transform3D>,
        eye: &Eye,
    ) -> Result<(), StoreError> {
        let scales = self.pose.is_none().then(|| {
            let scales = self.placed.iter().map(|(_, stretch)| [1.0, 1.0, *stretch]);
            InstancePoses3D::update_fields().with_scales(scales)
        });
        let looks: Box<dyn AsComponents> = match lasting {
            StaticShape::Mesh(model, mesh, rgba) => Box::new(solid(&model.meshes[*mesh], *rgba, eye)),
            StaticShape::Sheet(area) => Box::new(sheet(area)),
            StaticShape::Tint(rgba) => Box::new(Mesh3D::update_fields().with_albedo_factor(colour(*rgba).0)),
            StaticShape::Strokes(strokes) => Box::new(
                LineStrips3D::new(strokes.drawn(eye, MAX_DASHES_CONSTANT))
                    .with_radii([Radius::new_ui_points(0.5 * strokes.width)])
                    .with_colors([colour(strokes.rgba)]),
            ),
            StaticShape::Ring { radius, width, rgba } => Box::new(
                LineStrips3D::new([circle(*radius).map(|p| eye.place(p)).collect::<Vec<_>>()])
                    .with_radii([Radius::new_ui_points(0.5 * width)])
                    .with_colors([colour(*rgba)]),
            ),
        };
        let mut all = vec![&*looks];
        all.extend(stands.map(|stands| stands as &dyn AsComponents));
        all.extend(
            scales.as_ref().filter(|_| matches!(lasting, StaticShape::Mesh(..))).map(|s| s as &dyn AsComponents),
        );
        store.shape(since, &self.path, &CombinedArchetypes(&all))
    }

    /// Writes the buffered poses.
    pub fn write_poses(&mut self, store: &mut Store, eye: &Eye) -> Result<(), StoreError> {
        let (clock, poses) = self.poses.take();
        if !poses.is_empty() {
            let columns = transform_rows(&poses, eye).columns_of_unit_batches()?;
            store.columns(&clock.columns(), &self.path, columns)?;
        }
        Ok(())
    }

    pub fn write(&mut self, store: &mut Store, eye: &Eye) -> Result<(), StoreError> {
        self.write_poses(store, eye)?;
        let (clock, rows) = self.shapes.take();
        if rows.is_empty() {
            return Ok(());
        }
        let (mut strokes, mut dots, mut places) = (Vec::new(), Vec::new(), Vec::<[f32; 3]>::new());
        if rows.iter().flatten().any(|row| matches!(row, EntityShape::Mesh(..))) {
            return self.write_meshes(store, &clock, &rows, eye);
        }
        let mut lengths = Vec::with_capacity(rows.len());
        for row in &rows {
            lengths.push(match row {
                Some(EntityShape::Strokes(row)) => {
                    let drawn = row.drawn(eye, MAX_DASHES_CHANGING);
                    let n = drawn.len();
                    strokes.extend(drawn.into_iter().map(|strip| (strip, row.width, row.rgba)));
                    n
                }
                Some(EntityShape::Dots(row)) => {
                    dots.extend(row);
                    row.len()
                }
                Some(EntityShape::Instances(row)) => {
                    places.extend(row);
                    row.len()
                }
                Some(EntityShape::Mesh(..)) | None => 0,
            });
        }
        let clock = clock.columns();
        match self.kind {
            EntityKind::Line => {
                let radii = strokes.iter().map(|(_, width, _)| Radius::new_ui_points(0.5 * width)).collect::<Vec<_>>();
                let colours = strokes.iter().map(|(.., rgba)| colour(*rgba)).collect::<Vec<_>>();
                let lines = LineStrips3D::update_fields()
                    .with_strips(strokes.into_iter().map(|(strip, ..)| strip))
                    .with_radii(radii)
                    .with_colors(colours);
                store.columns(&clock, &self.path, lines.columns(lengths)?)
            }
            EntityKind::Solid | EntityKind::Area => {
                let instances = InstancePoses3D::update_fields().with_translations(places);
                store.columns(&clock, &self.path, instances.columns(lengths)?)
            }
            EntityKind::Label => {
                let words = Points3D::update_fields()
                    .with_positions(dots.iter().map(|dot| dot.at))
                    .with_labels(dots.iter().map(|dot| dot.text.as_str()))
                    .with_colors(dots.iter().map(|dot| colour(dot.rgba)));
                // A single radius of zero for each row hides the dots.
                let dotless = Points3D::update_fields().with_radii(rows.iter().map(|_| Radius::ZERO));
                let columns = words.columns(lengths)?.chain(dotless.columns_of_unit_batches()?);
                store.columns(&clock, &self.path, columns)
            }
            EntityKind::Marker => {
                let points = Points3D::update_fields()
                    .with_positions(dots.iter().map(|dot| dot.at))
                    .with_radii(dots.iter().map(|dot| Radius::new_ui_points(dot.radius)))
                    .with_colors(dots.iter().map(|dot| colour(dot.rgba)));
                store.columns(&clock, &self.path, points.columns(lengths)?)
            }
        }
    }
}

impl Entity {
    /// Writes changing meshes, one row each; a missing mesh has no triangles.
    fn write_meshes(
        &self,
        store: &mut Store,
        clock: &RowTimes,
        rows: &[Option<EntityShape>],
        eye: &Eye,
    ) -> Result<(), StoreError> {
        let none = Mesh::default();
        let mesh = |row: &Option<EntityShape>| match row {
            Some(EntityShape::Mesh(model, i)) => model.meshes[*i].clone(),
            _ => none.clone(),
        };
        let all: Vec<Mesh> = rows.iter().map(mesh).collect();
        let vertices = Mesh3D::update_fields()
            .with_vertex_positions(all.iter().flat_map(|mesh| mesh.positions.iter().map(|p| eye.place(*p))))
            .with_vertex_normals(all.iter().flat_map(|mesh| mesh.normals.iter().map(|n| eye.turn(*n))));
        let triangles =
            Mesh3D::update_fields().with_triangle_indices(all.iter().flat_map(|mesh| mesh.triangles.iter().copied()));
        let columns = vertices.columns(all.iter().map(|mesh| mesh.positions.len()))?;
        let columns = columns.chain(triangles.columns(all.iter().map(|mesh| mesh.triangles.len()))?);
        store.columns(&clock.columns(), &self.path, columns)
    }
}

/// Returns a circle around the origin, as a closed polyline.
fn circle(radius: f32) -> impl Iterator<Item = [f32; 3]> {
    let on = |i: u8| TAU * f32::from(i) / 48.0;
    (0..=48).map(on).map(move |a| [radius * a.cos(), radius * a.sin(), 0.0])
}

impl Strokes {
    /// Returns whether two sets of lines have the same style.
    fn is_alike(&self, other: &Self) -> bool {
        (self.width, self.rgba, self.dash) == (other.width, other.rgba, other.dash)
    }

    /// Returns the strips in coordinates of the recording; if dashed, each has at most about `most` dashes and gaps.
    pub fn drawn(&self, eye: &Eye, most: f32) -> Vec<Vec<[f32; 3]>> {
        let strips = self.strips.iter().filter(|strip| strip.len() > 1);
        let placed = |strip: &Vec<[f32; 3]>| strip.iter().map(|p| eye.place(*p)).collect::<Vec<_>>();
        match self.dash {
            None => strips.map(placed).collect(),
            Some([dash, gap]) => {
                let length = 0.5 * (dash + gap) * eye.pixel();
                strips.flat_map(|strip| dashed(&placed(strip), length, most)).collect()
            }
        }
    }
}

pub fn transform(poses: &[Rigid], eye: &Eye) -> Transform3D {
    let mut transform = Transform3D::update_fields();
    if let Some(pose) = poses.first() {
        transform = transform.with_translation(eye.place(pose.at));
        if pose.along != Rigid::IDENTITY.along {
            transform = transform.with_quaternion(pose.turn());
        }
    }
    transform
}

/// Returns one row for each pose; rotations are included if any pose is rotated.
pub fn transform_rows(poses: &[Rigid], eye: &Eye) -> Transform3D {
    let rows = Transform3D::update_fields().with_many_translation(poses.iter().map(|pose| eye.place(pose.at)));
    match poses.iter().any(|pose| pose.along != Rigid::IDENTITY.along) {
        true => rows.with_many_quaternion(poses.iter().map(Rigid::turn)),
        false => rows,
    }
}

/// Returns the mesh of a workspace without rotation and translation.
fn sheet(area: &Area) -> Mesh3D {
    let share = |i: u32| i as f32 / CELLS as f32;
    let at = |i: u32, j: u32| {
        let a = [0, 1].map(|k| area.a_min[k] + (area.a_max[k] - area.a_min[k]) * share([i, j][k]));
        let angle = |k: usize| area.u[k][0] * a[0] + area.u[k][1] * a[1] + area.v[k];
        let sum = |of: fn(f32) -> f32| (0..3).map(|k| area.c[k] * of(angle(k))).sum::<f32>();
        [sum(f32::cos), sum(f32::sin), 0.0]
    };
    let corners = (0..=CELLS).flat_map(|i| (0..=CELLS).map(move |j| at(i, j)));
    let cells = (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| i * (CELLS + 1) + j));
    let triangles = cells.flat_map(|c| [[c, c + CELLS + 1, c + 1], [c + 1, c + CELLS + 1, c + CELLS + 2]]);
    Mesh3D::new(corners).with_triangle_indices(triangles).with_albedo_factor(colour(area.colour).0)
}
