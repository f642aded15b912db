//! Placement of the labels of a scene: beside their points, in view, clear of the machine and of one another.
//!
//! Labels of one point form a `Group`. The groups are placed one after the other, the most important first, each at
//! the cheapest place that is free: its preferred place, mirrored, or shifted. A group stays where it was while
//! that place is free and no other is clearly better, so labels do not jump while the machine moves. If a group has
//! no place for all its rows, its last rows are left out.

mod group;
mod room;

use std::collections::HashMap;
use std::sync::Arc;

use egui::{CentralPanel, Frame, Galley, Id, Painter, Pos2, Rect, Stroke, Ui};

use super::{SceneViewport, colour, paint, plain};
use crate::scene::camera::Camera;
use crate::scene::options::Handle;
use crate::scene::overlay::PLATE_OPACITY;
use crate::scene::palette::faded;
use crate::scene::{Label, NOTES, Name, Scene};
use group::{Choice, Group, Kind, boxed, choices};
use room::{Room, nearest};

/// A label that has a place.
#[derive(Clone, Debug)]
pub struct PlacedLabel {
    /// The label.
    pub label: Label,
    /// Its text in the units on display.
    pub text: String,
    /// Rectangle of its text, points.
    pub place: Rect,
    /// Number of its group; labels of one group stand in rows.
    pub group: usize,
}

/// The labels of a scene at their places, and what they depend on.
#[derive(Clone, Debug)]
pub struct Placement {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The camera.
    pub camera: Camera,
    /// The labels that have a place.
    pub all: Vec<PlacedLabel>,
    /// Lines from points to labels that stand far from them, with the label's index in `all`.
    leads: Vec<(usize, [Pos2; 2])>,
    /// What the labels found free: without the labels themselves.
    room: Room,
    pixels_per_point: f32,
    choices: HashMap<(Name, usize), Choice>,
    /// All ways and shifts from which each group chooses its place, the cheapest first; they never change.
    all_choices: Arc<[Choice]>,
}

/// Paints a scene with its labels over the whole surface, or up to a distance from its left, points, without input.
pub fn paint_still(ui: &mut Ui, scene: &Arc<Scene>, camera: &Camera, right: Option<f32>) {
    CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        let mut rect = ui.max_rect();
        rect.max.x = right.unwrap_or(rect.max.x);
        paint(ui, 0, rect, scene, camera);
        draw_labels(ui, 0, &SceneViewport { rect, camera: *camera }, scene, &[]);
    });
}

/// Paints the labels of a scene, in its units, outside the rectangles `taken`; scenes of one window are numbered from 0.
/// Returns those that have space.
pub fn draw_labels(ui: &Ui, number: usize, spot: &SceneViewport, scene: &Arc<Scene>, taken: &[Rect]) -> Arc<Placement> {
    let painter = ui.painter().with_clip_rect(spot.rect);
    let before = last(ui.ctx(), number);
    let current = placed(&painter, spot, scene, taken, before.as_ref());
    for (i, ends) in &current.leads {
        let label = &current.all[*i].label;
        painter.line_segment(*ends, Stroke::new(1.0, colour(faded(label.colour, 0.6))));
    }
    for own in &current.all {
        lead_note(&painter, spot, scene, own);
        let PlacedLabel { label, text, place, .. } = own;
        // The laid-out text is not kept: it refers to egui's font atlas, which may be rebuilt.
        let galley = laid_out(&painter, label, text.clone());
        // A translucent background keeps the text legible over curves.
        let [r, g, b, opacity] = scene.background;
        let plate = if opacity > 0.0 { faded(scene.background, 0.75) } else { [r, g, b, PLATE_OPACITY] };
        painter.rect_filled(boxed(*place), 3.0, colour(plate));
        painter.galley(place.min, galley, colour(label.colour));
    }
    ui.ctx().data_mut(|data| data.insert_temp(id(number), current.clone()));
    current
}

fn id(number: usize) -> Id {
    Id::unique("labels of a scene").with(number)
}

/// Returns the labels of a scene as they were drawn last.
pub fn last(ctx: &egui::Context, number: usize) -> Option<Arc<Placement>> {
    ctx.data(|data| data.get_temp(id(number)))
}

/// Forgets where the labels of a scene stood.
pub fn forget(ctx: &egui::Context, number: usize) {
    ctx.data_mut(|data| data.remove::<Arc<Placement>>(id(number)));
}

impl Placement {
    /// Returns the view, points.
    pub fn view(&self) -> Rect {
        self.room.view
    }

    /// Returns the lines to labels that stand far from their points, each with the index of the label.
    pub fn leads(&self) -> &[(usize, [Pos2; 2])] {
        &self.leads
    }

    /// Returns the handle that the label at a position is a part of.
    pub fn handle_at(&self, at: Pos2) -> Option<Handle> {
        self.all.iter().filter(|own| boxed(own.place).contains(at)).find_map(|own| own.label.handle)
    }
}

/// Places the labels of a scene outside the rectangles `taken`, near where they were `before`.
pub fn placed(
    painter: &Painter,
    spot: &SceneViewport,
    scene: &Arc<Scene>,
    taken: &[Rect],
    before: Option<&Arc<Placement>>,
) -> Arc<Placement> {
    let SceneViewport { rect: view, camera } = *spot;
    let before = before.filter(|before| before.room.view == view);
    let room = Room::of(scene, spot, taken);
    let pixels_per_point = painter.pixels_per_point();
    if let Some(before) = before
        && before.scene.labels == scene.labels
        && before.scene.notation == scene.notation
        && (before.camera, before.pixels_per_point) == (camera, pixels_per_point)
        && before.room == room
    {
        return before.clone();
    }
    let mut current = Placement {
        scene: scene.clone(),
        camera,
        all: Vec::with_capacity(scene.labels.len()),
        leads: Vec::new(),
        room: room.clone(),
        pixels_per_point,
        choices: HashMap::new(),
        all_choices: before.map_or_else(choices, |before| before.all_choices.clone()),
    };
    // Something that covered the scene has gone: labels that gave way to it go back.
    let released = before.is_some_and(|before| before.room.taken.len() > room.taken.len());
    let mut room = room;
    for (number, group) in groups(painter, spot, scene).into_iter().enumerate() {
        // Labels of points out of view are omitted unless they are fully visible.
        if !view.contains(group.at) && !group.rows.iter().all(|(.., place)| view.contains_rect(*place)) {
            continue;
        }
        let own = before.and_then(|before| before.choices.get(&group.key)).copied();
        let Some(choice) = group.choose(&room, &current.all_choices, own, released) else { continue };
        let places: Vec<Rect> = group.places(&choice, view).collect();
        let block = places.iter().fold(Rect::NOTHING, |block, place| block.union(boxed(*place)));
        if let Some(ends) = group.lead(block) {
            room.take_line(ends);
            current.leads.push((current.all.len(), ends));
        }
        room.taken.extend(places.iter().map(|place| boxed(*place)));
        for ((label, text, _), place) in group.rows.into_iter().zip(places) {
            current.all.push(PlacedLabel { label: label.clone(), text, place, group: number });
        }
        current.choices.insert(group.key, choice);
    }
    Arc::new(current)
}

/// Returns the labels of a scene in groups, the most important first.
fn groups<'a>(painter: &Painter, spot: &SceneViewport, scene: &'a Scene) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'_>> = Vec::new();
    for label in &scene.labels {
        let Some(at) = spot.screen(label.at.map(f64::from)) else { continue };
        // The words of a note are the user's own.
        let text = match label.name.starts_with(NOTES) {
            true => label.text.clone(),
            false => scene.notation.sentence(&label.text).into_owned(),
        };
        let size = laid_out(painter, label, text.clone()).size();
        match groups.iter_mut().find(|group| group.takes(label)) {
            Some(group) => group.push(label, text, size),
            None => {
                let nth = groups.iter().filter(|group| group.key.0 == label.name).count();
                let key = (label.name.clone(), nth);
                let mut group = Group { key, kind: Kind::of(&label.name), at, rows: Vec::new() };
                group.push(label, text, size);
                groups.push(group);
            }
        }
    }
    groups.sort_by_key(|group| group.kind.rank);
    groups
}

fn laid_out(painter: &Painter, label: &Label, text: String) -> Arc<Galley> {
    painter.layout_no_wrap(text, plain(label.size), colour(label.colour))
}

/// Lengthens the line from a point to its note, if the note is shifted.
fn lead_note(painter: &Painter, spot: &SceneViewport, scene: &Scene, own: &PlacedLabel) {
    let label = &own.label;
    let is_own = |name: &str| name.strip_prefix(&*label.name) == Some("/leader");
    let line = label.name.starts_with(NOTES).then(|| scene.lines.iter().find(|line| is_own(&line.name))).flatten();
    let Some((line, end)) = line.and_then(|line| Some((line, spot.screen(label.at.map(f64::from))?))) else { return };
    painter.line_segment([end, nearest(own.place, end)], Stroke::new(line.width, colour(line.colour)));
}
