//! One space of a recording, drawn from its [`Scene`]s: each item of a scene is an entity; items of one name share it.
//! What an item says never changes is written once, the rest when it changes.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use rerun::EntityPath;

use super::entity::{Dot, Entity, Kind, Lasting, Rigid, Shape, Strokes};
use super::eye::Eye;
use super::store::{Instant, Store, StoreError};
use super::style::under;
use crate::picture::scene::palette::mix;
use crate::picture::scene::{Anchor, Area, Changes, Label, Line, Marker, Model, Rgba, Scene, Solid};

/// How far each line that is over everything lies above the one before it, px.
const STEP: f32 = 0.1;
/// The viewer's words stand in boxes: rows of them are so many times as far apart as in the window, and letters are so
/// wide, parts of their height.
const ROWS: f32 = 1.4;
const LETTER: f32 = 0.5;

/// A space of a recording.
#[derive(Debug)]
pub struct Space {
    root: EntityPath,
    eye: Eye,
    background: Rgba,
    /// How names of items begin, and how the paths of their entities begin instead.
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

    /// Puts items under other paths from now on: an item whose name is the first of a pair, or lies under it, becomes the
    /// entity with the second of the pair in its place. Of several pairs that fit, the first counts.
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

    /// Writes the shapes of a scene that are not in the recording yet: for all times, or from the instant `since` on. Poses
    /// and shapes that can change gather as rows until [`Space::write`].
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
        if solid.changes == Changes::Shape {
            (entity.lasting, entity.shape) =
                (Some(Lasting::Tint(solid.colour)), Some(Shape::Mesh(model.clone(), solid.mesh)));
            return;
        }
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
            Changes::Shape => entity.strokes(strokes),
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
            entity.rings.0.push(marker.at);
            entity.rings.1 = radius;
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

/// A colour over another: the viewer's lines and points hide what is behind them.
fn over(background: Rgba, [r, g, b, a]: Rgba) -> Rgba {
    mix(background, [r, g, b, 1.0], a)
}
