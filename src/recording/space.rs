//! One space of a recording, drawn from its [`Scene`]s: each item of a scene is an entity, or a row of one with others of
//! its name. What an item says stays is written once, the rest when it changes.

use std::borrow::Cow;
use std::collections::HashMap;
use std::f32::consts::TAU;
use std::sync::Arc;

use rerun::{Clear, EntityPath, InstancePoses3D, LineStrips3D, Mesh3D, Points3D, Quaternion, Radius, Transform3D};

use super::dashes::dashed;
use super::eye::Eye;
use super::rows::Track;
use super::store::{Instant, Store, StoreError};
use super::style::{colour, solid, under};
use crate::picture::scene::palette::mix;
use crate::picture::scene::{Anchor, Area, Changes, Label, Line, Marker, Model, Pose, Rgba, Scene, Solid, Strips};

/// Cells of a workspace along each angle.
const CELLS: u32 = 40;
/// The most dashes and gaps of a line that lasts, and of one that is drawn anew again and again.
const LASTING: f32 = 400.0;
const PASSING: f32 = 13.0;
/// How far each line that is over everything lies above the one before it, px.
const STEP: f32 = 0.1;
/// Poses nearer to each other than this are one, m and parts of a turn.
const SAME: f32 = 2e-6;
/// The viewer's words stand in boxes: rows of them are so many times as far apart as in the window, and letters are so
/// wide, parts of their height.
const ROWS: f32 = 1.4;
const LETTER: f32 = 0.5;

/// A pose about z: cosine and sine, and a shift, m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rigid {
    along: [f32; 2],
    at: [f32; 3],
}

impl Rigid {
    const HOME: Self = Self { along: [1.0, 0.0], at: [0.0; 3] };

    fn of(pose: &Pose) -> Self {
        Self { along: [pose[0][0], pose[0][1]], at: [pose[3][0], pose[3][1], pose[3][2]] }
    }

    fn shifted(at: [f32; 3]) -> Self {
        Self { at, ..Self::HOME }
    }

    /// A point of the world in this pose's own coordinates.
    fn inside(&self, p: [f32; 3]) -> [f32; 3] {
        let [c, s] = self.along;
        let d = [0, 1, 2].map(|i| p[i] - self.at[i]);
        [c * d[0] + s * d[1], c * d[1] - s * d[0], d[2]]
    }

    /// This pose seen from another.
    fn within(&self, outer: &Self) -> Self {
        let ([c, s], [x, y]) = (outer.along, self.along);
        Self { along: [c * x + s * y, c * y - s * x], at: outer.inside(self.at) }
    }

    fn is_near(&self, other: &Self) -> bool {
        let near = |a: f32, b: f32| (a - b).abs() < SAME;
        self.at.into_iter().zip(other.at).chain(self.along.into_iter().zip(other.along)).all(|(a, b)| near(a, b))
    }

    fn turn(&self) -> Quaternion {
        let half = 0.5 * f64::from(self.along[1]).atan2(f64::from(self.along[0]));
        Quaternion::from_xyzw([0.0, 0.0, half.sin() as f32, half.cos() as f32])
    }
}

/// What items are drawn as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Solid,
    Area,
    Line,
    Marker,
    Label,
}

/// A point on the screen: where, its radius, px, its colour, and its words.
#[derive(Clone, Debug, PartialEq)]
struct Dot {
    at: [f32; 3],
    radius: f32,
    rgba: Rgba,
    text: String,
}

/// Lines with their width, px, colour and dashes.
#[derive(Clone, Debug)]
struct Strokes {
    strips: Strips,
    width: f32,
    rgba: Rgba,
    dash: Option<[f32; 2]>,
}

impl PartialEq for Strokes {
    fn eq(&self, other: &Self) -> bool {
        (self.width, self.rgba, self.dash) == (other.width, other.rgba, other.dash)
            && (Arc::ptr_eq(&self.strips, &other.strips) || self.strips == other.strips)
    }
}

/// What an entity shows that can change at any instant.
#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Strokes(Strokes),
    Dots(Vec<Dot>),
    Instances(Vec<[f32; 3]>),
}

/// What an entity shows until somebody says otherwise.
#[derive(Clone, Debug)]
enum Lasting {
    Mesh(Arc<Model>, usize, Rgba),
    Sheet(Area),
    Strokes(Strokes),
    Ring { radius: f32, width: f32, rgba: Rgba },
}

impl PartialEq for Lasting {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Mesh(a, i, rgba), Self::Mesh(b, k, other)) => {
                rgba == other && (i == k && Arc::ptr_eq(a, b) || a.meshes[*i] == b.meshes[*k])
            }
            (Self::Sheet(a), Self::Sheet(b)) => a == b,
            (Self::Strokes(a), Self::Strokes(b)) => a == b,
            (Self::Ring { radius: a, .. }, Self::Ring { radius: b, .. }) => a == b,
            _ => false,
        }
    }
}

/// One entity.
#[derive(Debug)]
struct Entity {
    kind: Kind,
    path: EntityPath,
    /// Its ancestors, nearest first, that may stand in a pose.
    ancestors: Vec<String>,
    /// In the scene at hand: what it shows, and where it stands.
    lasting: Option<Lasting>,
    shape: Option<Shape>,
    pose: Option<(Rigid, Changes)>,
    /// Where each of several of one name is, and how many times as high as its mesh.
    placed: Vec<(Rigid, f32)>,
    is_there: bool,
    /// What has been written, and the rows that gather.
    written: Option<Lasting>,
    stands: bool,
    shapes: Track<Option<Shape>>,
    poses: Track<Rigid>,
}

/// A space of a recording.
#[derive(Debug)]
pub struct Space {
    root: EntityPath,
    eye: Eye,
    background: Rgba,
    /// Names of items, and what entities have in their place.
    renamed: Vec<(&'static str, String)>,
    entities: Vec<Entity>,
    /// Their places by name, for each kind.
    known: [HashMap<String, usize>; 5],
    /// Entities that stand in a pose, by their names.
    posed: HashMap<String, usize>,
}

impl Space {
    /// Under a root, seen from an eye.
    pub fn new(root: EntityPath, eye: Eye, background: Rgba) -> Self {
        Self {
            root,
            eye,
            background,
            renamed: Vec::new(),
            entities: Vec::new(),
            known: Default::default(),
            posed: HashMap::new(),
        }
    }

    /// From now on items whose names begin so are entities whose paths begin otherwise; the first that fits counts.
    pub fn rename(&mut self, renamed: Vec<(&'static str, String)>) {
        self.renamed = renamed;
    }

    fn renamed<'a>(&self, name: &'a str) -> Cow<'a, str> {
        let rest = |(from, to): &(&'static str, String)| {
            let rest = name.strip_prefix(from).filter(|rest| rest.is_empty() || rest.starts_with('/'))?;
            Some(format!("{to}{rest}"))
        };
        self.renamed.iter().find_map(rest).map_or(Cow::Borrowed(name), Cow::Owned)
    }

    fn entity(&mut self, kind: Kind, name: &str) -> &mut Entity {
        let name = self.renamed(name);
        let i = match self.known[kind as usize].get(name.as_ref()) {
            Some(i) => *i,
            None => {
                let (i, name) = (self.entities.len(), name.into_owned());
                self.entities.push(Entity::new(kind, under(&self.root, &name), &name));
                if matches!(kind, Kind::Solid | Kind::Area | Kind::Line) {
                    self.posed.entry(name.clone()).or_insert(i);
                }
                self.known[kind as usize].insert(name, i);
                i
            }
        };
        let entity = &mut self.entities[i];
        entity.is_there = true;
        entity
    }

    /// Writes what is new of a scene: what stays for good, or from an instant on if it may not stay; and notes the rest.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn draw(
        &mut self,
        store: &mut Store,
        (at, since): (Instant, Option<Instant>),
        scene: &Scene,
    ) -> Result<(), StoreError> {
        self.entities.iter_mut().for_each(Entity::begin);
        scene.solids.iter().for_each(|solid| self.solid(solid, &scene.model));
        scene.areas.iter().for_each(|area| {
            let pose = area.world_from_item();
            let flat = Area { turn: 0.0, at: [0.0; 2], z: 0.0, ..area.clone() };
            let entity = self.entity(Kind::Area, &area.name);
            (entity.lasting, entity.pose) = (Some(Lasting::Sheet(flat)), Some((Rigid::of(&pose), Changes::Pose)));
        });
        let mut lift = 0.0;
        for line in &scene.lines {
            // The viewer knows only depth: what is drawn later lies nearer to the eye.
            lift += if line.on_top { STEP * self.eye.pixel() } else { 0.0 };
            self.line(line, if line.on_top { lift } else { 0.0 });
        }
        scene.markers.iter().for_each(|marker| self.marker(marker));
        scene.labels.iter().for_each(|label| self.label(label));
        self.entities.iter_mut().for_each(Entity::share);
        for i in 0..self.entities.len() {
            let outer = self.entities[i].ancestors.iter().find_map(|name| {
                let (pose, _) = self.entities[*self.posed.get(name)?].pose?;
                Some(pose)
            });
            let eye = self.eye;
            self.entities[i].note(store, (at, since), &outer.unwrap_or(Rigid::HOME), &eye)?;
        }
        Ok(())
    }

    fn solid(&mut self, solid: &Solid, model: &Arc<Model>) {
        let entity = self.entity(Kind::Solid, &solid.name);
        entity.placed.push((Rigid::of(&solid.world_from_item), solid.world_from_item[2][2]));
        if entity.lasting.is_none() {
            entity.lasting = Some(Lasting::Mesh(model.clone(), solid.mesh, solid.colour));
            entity.pose = Some((Rigid::of(&solid.world_from_item), solid.changes));
        }
    }

    fn line(&mut self, line: &Line, lift: f32) {
        let (strips, rgba) = (line.strips.clone(), over(self.background, line.colour));
        let strokes = Strokes { strips, width: line.width, rgba, dash: line.dash };
        let entity = self.entity(Kind::Line, &line.name);
        let mut pose = Rigid::of(&line.world_from_item);
        pose.at[2] += lift;
        entity.pose = Some((pose, line.changes));
        match line.changes {
            Changes::Shape => entity.shape = Some(Shape::Strokes(strokes)),
            _ => entity.lasting = Some(Lasting::Strokes(strokes)),
        }
    }

    fn marker(&mut self, marker: &Marker) {
        let ([.., alpha], edged) = (marker.fill, marker.stroke_width > 0.0 && marker.stroke != marker.fill);
        let dot = |at, radius, rgba| Dot { at, radius, rgba, text: String::new() };
        let (background, px) = (self.background, self.eye.pixel());
        if alpha == 0.0 {
            let entity = self.entity(Kind::Line, &marker.name);
            let radius = px * (marker.radius - 0.5 * marker.stroke_width);
            let rgba = over(background, marker.stroke);
            entity.lasting = Some(Lasting::Ring { radius, width: marker.stroke_width, rgba });
            entity.pose = Some((Rigid::shifted(marker.at), Changes::Pose));
            return;
        }
        let rgba = over(background, if edged { marker.stroke } else { marker.fill });
        self.entity(Kind::Marker, &marker.name).dot(dot(marker.at, marker.radius, rgba));
        if edged {
            let [x, y, z] = marker.at;
            let inside = marker.radius - marker.stroke_width;
            // Nearer to the eye than what it lies on.
            let inner = dot([x, y, z + px], inside, over(background, marker.fill));
            self.entity(Kind::Marker, &format!("{}/inside", marker.name)).dot(inner);
        }
    }

    fn label(&mut self, label: &Label) {
        let width = LETTER * label.size * label.text.chars().count() as f32;
        let [right, down] = label.offset;
        let aside = match label.anchor {
            Anchor::Left => 0.5 * width,
            Anchor::Centre => 0.0,
            Anchor::Right => -0.5 * width,
        };
        let shift = self.eye.shift([right + aside, ROWS * down]);
        let at = [0, 1, 2].map(|i| label.at[i] + shift[i]);
        let rgba = over(self.background, label.colour);
        let dot = Dot { at, radius: 0.0, rgba, text: label.text.clone() };
        self.entity(Kind::Label, &label.name).dot(dot);
    }

    /// Writes the rows since the last time.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        let eye = self.eye;
        self.entities.iter_mut().try_for_each(|entity| entity.write(store, &eye))
    }
}

impl Entity {
    fn new(kind: Kind, path: EntityPath, name: &str) -> Self {
        let cuts = name.match_indices('/').map(|(i, _)| i).collect::<Vec<_>>();
        Self {
            kind,
            path,
            ancestors: cuts.into_iter().rev().map(|i| name[..i].to_owned()).collect(),
            lasting: None,
            shape: None,
            pose: None,
            placed: Vec::new(),
            is_there: false,
            written: None,
            stands: false,
            shapes: Track::new(),
            poses: Track::new(),
        }
    }

    fn begin(&mut self) {
        (self.lasting, self.shape, self.pose, self.is_there) = (None, None, None, false);
        self.placed.clear();
    }

    fn dot(&mut self, dot: Dot) {
        match &mut self.shape {
            Some(Shape::Dots(dots)) => dots.push(dot),
            _ => self.shape = Some(Shape::Dots(vec![dot])),
        }
    }

    /// Several of one name share a mesh, and none of their poses is the entity's.
    fn share(&mut self) {
        if self.placed.len() > 1 || self.placed.iter().any(|(_, stretch)| *stretch != 1.0) {
            self.shape = Some(Shape::Instances(self.placed.iter().map(|(pose, _)| pose.at).collect()));
            self.pose = None;
        }
    }

    /// Writes what is new of it in the scene at hand, within the pose of what it is part of.
    fn note(
        &mut self,
        store: &mut Store,
        (at, since): (Instant, Option<Instant>),
        outer: &Rigid,
        eye: &Eye,
    ) -> Result<(), StoreError> {
        if !self.is_there {
            if self.written.take().is_some() {
                store.shape(Some(at), &self.path, &Clear::flat())?;
                self.write_poses(store, eye)?;
                (self.poses, self.stands) = (Track::new(), false);
            }
            if matches!(self.shapes.last(), Some(Some(_))) {
                self.shapes.push(at, None);
            }
            return Ok(());
        }
        if let Some(lasting) = self.lasting.take()
            && self.written.as_ref() != Some(&lasting)
        {
            self.write_lasting(store, since, &lasting, eye)?;
            self.written = Some(lasting);
        }
        if let Some((pose, changes)) = self.pose {
            let pose = pose.within(outer);
            // What is part of something else stays where it is within it, but for rounding.
            let is_part = *outer != Rigid::HOME;
            let same = |last: &Rigid| if is_part { last.is_near(&pose) } else { *last == pose };
            let known = self.poses.last().is_some_and(same);
            let never = self.poses.last().is_none() && !self.stands;
            let at_home = never && pose.is_near(&Rigid::HOME);
            match (changes, since) {
                _ if known || at_home => {}
                (Changes::Nothing, None) if never => {
                    store.fixed(&self.path, &transform(&[pose], eye))?;
                    self.stands = true;
                }
                (Changes::Nothing, None) => {}
                _ => self.poses.push(at, pose),
            }
        }
        if let Some(mut shape) = self.shape.take() {
            match &mut shape {
                Shape::Dots(dots) => dots.iter_mut().for_each(|dot| dot.at = eye.place(outer.inside(dot.at))),
                Shape::Instances(places) => places.iter_mut().for_each(|p| *p = eye.place(outer.inside(*p))),
                Shape::Strokes(_) => {}
            }
            if self.shapes.is_new() && self.kind == Kind::Label {
                let style = Points3D::update_fields().with_radii([Radius::ZERO]).with_show_labels(true);
                store.fixed(&self.path, &style)?;
            }
            self.shapes.push(at, Some(shape));
        }
        Ok(())
    }

    fn write_lasting(
        &self,
        store: &mut Store,
        since: Option<Instant>,
        lasting: &Lasting,
        eye: &Eye,
    ) -> Result<(), StoreError> {
        match lasting {
            Lasting::Mesh(model, mesh, rgba) => {
                store.shape(since, &self.path, &solid(&model.meshes[*mesh], *rgba, eye))?;
                if self.pose.is_none() {
                    let scales = self.placed.iter().map(|(_, stretch)| [1.0, 1.0, *stretch]);
                    let scales = InstancePoses3D::update_fields().with_scales(scales);
                    store.shape(since, &self.path, &scales)?;
                }
                Ok(())
            }
            Lasting::Sheet(area) => store.shape(since, &self.path, &sheet(area)),
            Lasting::Strokes(strokes) => {
                let lines = LineStrips3D::new(strokes.drawn(eye, LASTING))
                    .with_radii([Radius::new_ui_points(0.5 * strokes.width)])
                    .with_colors([colour(strokes.rgba)]);
                store.shape(since, &self.path, &lines)
            }
            Lasting::Ring { radius, width, rgba } => {
                let on = |i: u8| TAU * f32::from(i) / 48.0;
                let ring = (0..=48).map(on).map(|a| [radius * a.cos(), radius * a.sin(), 0.0]);
                let lines = LineStrips3D::new([ring.map(|p| eye.place(p)).collect::<Vec<_>>()])
                    .with_radii([Radius::new_ui_points(0.5 * width)])
                    .with_colors([colour(*rgba)]);
                store.shape(since, &self.path, &lines)
            }
        }
    }

    /// Writes the poses that have gathered.
    fn write_poses(&mut self, store: &mut Store, eye: &Eye) -> Result<(), StoreError> {
        let (clock, poses) = self.poses.take();
        if !poses.is_empty() {
            let columns = transform_rows(&poses, eye).columns_of_unit_batches()?;
            store.columns(&clock.columns(), &self.path, columns)?;
        }
        Ok(())
    }

    fn write(&mut self, store: &mut Store, eye: &Eye) -> Result<(), StoreError> {
        self.write_poses(store, eye)?;
        let (clock, rows) = self.shapes.take();
        if rows.is_empty() {
            return Ok(());
        }
        let (mut strokes, mut dots, mut places) = (Vec::new(), Vec::new(), Vec::<[f32; 3]>::new());
        let mut lengths = Vec::with_capacity(rows.len());
        for row in &rows {
            lengths.push(match row {
                Some(Shape::Strokes(row)) => {
                    let drawn = row.drawn(eye, PASSING);
                    let n = drawn.len();
                    strokes.extend(drawn.into_iter().map(|strip| (strip, row.width, row.rgba)));
                    n
                }
                Some(Shape::Dots(row)) => {
                    dots.extend(row);
                    row.len()
                }
                Some(Shape::Instances(row)) => {
                    places.extend(row);
                    row.len()
                }
                None => 0,
            });
        }
        let clock = clock.columns();
        match self.kind {
            Kind::Line => {
                let radii = strokes.iter().map(|(_, width, _)| Radius::new_ui_points(0.5 * width)).collect::<Vec<_>>();
                let colours = strokes.iter().map(|(.., rgba)| colour(*rgba)).collect::<Vec<_>>();
                let lines = LineStrips3D::update_fields()
                    .with_strips(strokes.into_iter().map(|(strip, ..)| strip))
                    .with_radii(radii)
                    .with_colors(colours);
                store.columns(&clock, &self.path, lines.columns(lengths)?)
            }
            Kind::Solid | Kind::Area => {
                let instances = InstancePoses3D::update_fields().with_translations(places);
                store.columns(&clock, &self.path, instances.columns(lengths)?)
            }
            Kind::Label => {
                let words = Points3D::update_fields()
                    .with_positions(dots.iter().map(|dot| dot.at))
                    .with_labels(dots.iter().map(|dot| dot.text.as_str()))
                    .with_colors(dots.iter().map(|dot| colour(dot.rgba)));
                store.columns(&clock, &self.path, words.columns(lengths)?)
            }
            Kind::Marker => {
                let points = Points3D::update_fields()
                    .with_positions(dots.iter().map(|dot| dot.at))
                    .with_radii(dots.iter().map(|dot| Radius::new_ui_points(dot.radius)))
                    .with_colors(dots.iter().map(|dot| colour(dot.rgba)));
                store.columns(&clock, &self.path, points.columns(lengths)?)
            }
        }
    }
}

impl Strokes {
    /// In dashes where it has some: the viewer knows none.
    fn drawn(&self, eye: &Eye, most: f32) -> Vec<Vec<[f32; 3]>> {
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

fn transform(poses: &[Rigid], eye: &Eye) -> Transform3D {
    let mut transform = Transform3D::update_fields();
    if let Some(pose) = poses.first() {
        transform = transform.with_translation(eye.place(pose.at));
        if pose.along != Rigid::HOME.along {
            transform = transform.with_quaternion(pose.turn());
        }
    }
    transform
}

/// One row for each pose; their turns where any of them turns.
fn transform_rows(poses: &[Rigid], eye: &Eye) -> Transform3D {
    let rows = Transform3D::update_fields().with_many_translation(poses.iter().map(|pose| eye.place(pose.at)));
    match poses.iter().any(|pose| pose.along != Rigid::HOME.along) {
        true => rows.with_many_quaternion(poses.iter().map(Rigid::turn)),
        false => rows,
    }
}

/// A colour over another: the viewer's lines and points hide what is behind them.
fn over(background: Rgba, [r, g, b, a]: Rgba) -> Rgba {
    mix(background, [r, g, b, 1.0], a)
}

/// A workspace that is neither turned nor shifted.
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
