//! One space of a recording, drawn from its [`Scene`]s: each item of a scene is an entity; items with the same name
//! share one entity. Parts of an item marked as constant are written once, other parts when they change.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use crate::rerun::EntityPath;

use super::entity::{Dot, Entity, EntityKind, EntityShape, Rigid, StaticShape, Strokes};
use super::eye::Eye;
use super::store::{Instant, Store, StoreError};
use super::style::under;
use stillbase_picture::scene::palette::mix;
use stillbase_picture::scene::{
    Anchor, Area, IN_PLACE, ItemChanges, Label, Marker, MeshSet, Polyline, Rgba, Scene, Solid,
};

/// Difference in height between consecutive lines that are drawn over everything, px.
const LINE_SPACING_PX: f32 = 0.1;
/// Factor from the row spacing of labels in the window to that in the viewer, which draws labels in boxes.
const ROW_SPACING: f32 = 1.4;
/// Mean width of a letter, as a fraction of the font size.
const LETTER_WIDTH: f32 = 0.5;

/// A space of a recording.
#[derive(Debug)]
pub struct RecordingSpace {
    root: EntityPath,
    eye: Eye,
    background: Rgba,
    /// Prefixes of item names, and the prefixes of entity paths that replace them.
    renamed: Vec<(&'static str, String)>,
    entities: Vec<Entity>,
    /// Indices of the entities by name, for each kind.
    known: [HashMap<String, usize>; 5],
    /// Indices of the entities that can have a pose, by name.
    posed: HashMap<String, usize>,
}

impl RecordingSpace {
    /// Returns an empty space under a root, seen from an eye.
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

    /// Sets replacements of paths, as pairs of old and new prefix. If the name of an item is the old prefix or lies
    /// below it, the path of its entity has the new prefix instead. Of several matching pairs, the first applies.
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

    fn entity(&mut self, kind: EntityKind, name: &str) -> &mut Entity {
        let name = self.renamed(name);
        let i = match self.known[kind as usize].get(name.as_ref()) {
            Some(i) => *i,
            None => {
                let (i, name) = (self.entities.len(), name.into_owned());
                self.entities.push(Entity::new(kind, under(&self.root, &name), &name));
                if matches!(kind, EntityKind::Solid | EntityKind::Area | EntityKind::Line) {
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

    /// Writes the constant shapes of a scene that are not yet in the recording, for all times or from the instant
    /// `since` on. Rows of poses and shapes that can change are buffered until [`RecordingSpace::write`].
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
            let flat = Area { turn: 0.0, at: [0.0; 2], z: 0.0, world_from_plane: IN_PLACE, ..area.clone() };
            let entity = self.entity(EntityKind::Area, &area.name);
            (entity.constant, entity.pose) =
                (Some(StaticShape::Sheet(flat)), Some((Rigid::of(&pose), ItemChanges::Pose)));
        });
        let mut lift = 0.0;
        for line in &scene.lines {
            // The viewer orders by depth only, so later lines are placed nearer to the eye.
            lift += if line.on_top { LINE_SPACING_PX * self.eye.pixel() } else { 0.0 };
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
            self.entities[i].record(store, at, since, &outer.unwrap_or(Rigid::IDENTITY), &eye)?;
        }
        Ok(())
    }

    fn solid(&mut self, solid: &Solid, model: &Arc<MeshSet>) {
        let entity = self.entity(EntityKind::Solid, &solid.name);
        if solid.changes == ItemChanges::Shape {
            (entity.constant, entity.shape) =
                (Some(StaticShape::Tint(solid.colour)), Some(EntityShape::Mesh(model.clone(), solid.mesh)));
            return;
        }
        entity.placed.push((Rigid::of(&solid.world_from_item), solid.world_from_item[2][2]));
        if entity.constant.is_none() {
            entity.constant = Some(StaticShape::Mesh(model.clone(), solid.mesh, solid.colour));
            entity.pose = Some((Rigid::of(&solid.world_from_item), solid.changes));
        }
    }

    fn line(&mut self, line: &Polyline, lift: f32) {
        let (strips, rgba) = (line.strips.clone(), over(self.background, line.colour));
        let strokes = Strokes { strips, width: line.width, rgba, dash: line.dash };
        let entity = self.entity(EntityKind::Line, &line.name);
        let mut pose = Rigid::of(&line.world_from_item);
        pose.at[2] += lift;
        entity.pose = Some((pose, line.changes));
        match line.changes {
            ItemChanges::Shape => entity.strokes(strokes),
            _ => entity.constant = Some(StaticShape::Strokes(strokes)),
        }
    }

    fn marker(&mut self, marker: &Marker) {
        let ([.., alpha], edged) = (marker.fill, marker.stroke_width > 0.0 && marker.stroke != marker.fill);
        let dot = |at, radius, rgba| Dot { at, radius, rgba, text: String::new() };
        let (background, px) = (self.background, self.eye.pixel());
        if alpha == 0.0 {
            let entity = self.entity(EntityKind::Line, &marker.name);
            let radius = px * (marker.radius - 0.5 * marker.stroke_width);
            let rgba = over(background, marker.stroke);
            entity.constant = Some(StaticShape::Ring { radius, width: marker.stroke_width, rgba });
            entity.rings.0.push(marker.at);
            entity.rings.1 = radius;
            entity.pose = Some((Rigid::shifted(marker.at), ItemChanges::Pose));
            return;
        }
        let rgba = over(background, if edged { marker.stroke } else { marker.fill });
        self.entity(EntityKind::Marker, &marker.name).dot(dot(marker.at, marker.radius, rgba));
        if edged {
            let [x, y, z] = marker.at;
            let inside = marker.radius - marker.stroke_width;
            // Nearer to the eye than the outer disc.
            let inner = dot([x, y, z + px], inside, over(background, marker.fill));
            self.entity(EntityKind::Marker, &format!("{}/inside", marker.name)).dot(inner);
        }
    }

    fn label(&mut self, label: &Label) {
        let letters = label.text.lines().map(|line| line.chars().count()).max().unwrap_or_default();
        let width = LETTER_WIDTH * label.size * letters as f32;
        let [right, down] = label.offset;
        let aside = match label.anchor {
            Anchor::Left => 0.5 * width,
            Anchor::Centre => 0.0,
            Anchor::Right => -0.5 * width,
        };
        let shift = self.eye.shift([right + aside, ROW_SPACING * down]);
        let at = [0, 1, 2].map(|i| label.at[i] + shift[i]);
        let rgba = over(self.background, label.colour);
        let dot = Dot { at, radius: 0.0, rgba, text: label.text.clone() };
        self.entity(EntityKind::Label, &label.name).dot(dot);
    }

    /// Writes the buffered rows.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        let eye = self.eye;
        self.entities.iter_mut().try_for_each(|entity| entity.write(store, &eye))
    }
}

/// Blends a colour over the background, because lines and points of the viewer are opaque.
fn over(background: Rgba, [r, g, b, a]: Rgba) -> Rgba {
    mix(background, [r, g, b, 1.0], a)
}
