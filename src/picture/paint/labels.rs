//! Placement of the labels of a scene: beside their points, in view, and without overlaps.

use std::sync::Arc;

use egui::{Align2, CentralPanel, Frame, Galley, Painter, Pos2, Rect, Stroke, Ui, Vec2, vec2};

use super::{SceneViewport, colour, paint, plain};
use crate::scene::camera::Camera;
use crate::scene::overlay::PLATE_OPACITY;
use crate::scene::palette::faded;
use crate::scene::{Anchor, Label, NOTES, Scene};

/// Maximum vertical shift to avoid an overlap, points.
const MAX_SHIFT_PT: f32 = 36.0;
/// Labels that exceed the right edge by at most this much are shifted left only, not down as well, points.
const MAX_OVERHANG_PT: f32 = 4.0;
/// Minimum distance of centred labels from the left and right edges of the view, points.
const EDGE_DISTANCE_PT: f32 = 8.0;

/// Horizontal shifts that are tried if no vertical shift suffices, points.
const SIDEWAYS_SHIFTS_PT: [f32; 7] = [0.0, -30.0, 30.0, -60.0, 60.0, -100.0, 100.0];
/// Spacing of the vertical shifts that are combined with the horizontal ones, points.
const SHIFT_STEP_PT: f32 = 7.0;
/// Number of these vertical shifts in each direction.
const SHIFT_STEPS: i32 = 12;
/// Minimum distance of labels from the centre line of a bar, points.
const BAR_DISTANCE_PT: f32 = 7.0;
/// Half the side of the square about the target's ring that labels avoid, points.
const RING_DISTANCE_PT: f32 = 15.0;
/// Costs of overlapping another label, leaving the view, and covering a bar, in points of shift.
const OVERLAP_COST: f32 = 1e4;
const OUT_OF_VIEW_COST: f32 = 1e3;
const BAR_COST: f32 = 60.0;

/// Labels with the same point and the same name; they are shifted together.
struct Group<'a> {
    /// Labels of higher rank avoid those of lower rank.
    rank: u8,
    words: Vec<(&'a Label, Arc<Galley>, Rect)>,
}

/// Returns the rank of a label. Labels of higher rank avoid those of lower rank, and those of [`OPTIONAL_RANK`] are
/// omitted if there is no space.
fn rank(name: &str) -> u8 {
    match name {
        // The user drags these points by their labels.
        "plan/names" | "b_ring/name" | "payload/mass" => 0,
        "target/words" => 1,
        "reaction/words" => 2,
        "axes/titles" | "axes/now/words" => 4,
        "axes/words" => OPTIONAL_RANK,
        _ => 3,
    }
}

const OPTIONAL_RANK: u8 = 5;

/// Paints a scene with its labels over the whole surface, without input.
pub fn paint_still(ui: &mut Ui, scene: &Arc<Scene>, camera: &Camera) {
    CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        let rect = ui.max_rect();
        paint(ui, 0, rect, scene, camera);
        draw_labels(ui, &SceneViewport { rect, camera: *camera }, scene, &[]);
    });
}

/// Paints the labels of the scene, in its units, outside the rectangles `taken`. Returns those that have space,
/// with their rectangles.
pub fn draw_labels<'a>(ui: &Ui, spot: &SceneViewport, scene: &'a Scene, taken: &[Rect]) -> Vec<(&'a Label, Rect)> {
    let painter = ui.painter().with_clip_rect(spot.rect);
    let all = placed(&painter, spot, scene, taken);
    for (label, _, place) in &all {
        lead(&painter, spot, scene, (label, *place));
    }
    let draw = |(label, galley, place): (&'a Label, Arc<Galley>, Rect)| {
        write(&painter, scene, label, galley, place);
        (label, place)
    };
    all.into_iter().map(draw).collect()
}

/// Returns the rectangles of those labels of the scene that have space outside the rectangles `taken`.
pub fn placed<'a>(
    painter: &Painter,
    spot: &SceneViewport,
    scene: &'a Scene,
    taken: &[Rect],
) -> Vec<(&'a Label, Arc<Galley>, Rect)> {
    let mut groups: Vec<(Pos2, Group<'_>)> = Vec::new();
    for label in &scene.labels {
        let Some(at) = spot.screen(label.at.map(f64::from)) else { continue };
        // The words of a note are the user's own.
        let text = match label.name.starts_with(NOTES) {
            true => label.text.clone(),
            false => scene.notation.sentence(&label.text).into_owned(),
        };
        let galley = painter.layout_no_wrap(text, plain(label.size), colour(label.colour));
        let word = (label, galley, Rect::NOTHING);
        let of = |(l, ..): &(&Label, Arc<Galley>, Rect)| l.at == label.at && l.name == label.name;
        let same = groups.iter_mut().find(|(_, group)| group.words.first().is_some_and(of));
        match same {
            Some((_, group)) => group.words.push(word),
            None => groups.push((at, Group { rank: rank(&label.name), words: vec![word] })),
        }
    }
    groups.sort_by_key(|(_, group)| group.rank);
    let covered = taken;
    let mut taken = taken.to_vec();
    let mut ring = scene.markers.iter().find(|marker| marker.name == "target").and_then(|ring| {
        let at = spot.screen(ring.at.map(f64::from))?;
        Some(Rect::from_center_size(at, Vec2::splat(2.0 * RING_DISTANCE_PT)))
    });
    let end = |at: [f32; 3]| spot.screen(at.map(f64::from));
    let bars: Vec<[Pos2; 2]> = scene.bars.iter().filter_map(|[a, b]| Some([end(*a)?, end(*b)?])).collect();
    let mut all = Vec::with_capacity(scene.labels.len());
    for (at, mut group) in groups {
        group.place(at, spot.rect);
        let boxes: Vec<Rect> = group.words.iter().map(|(.., place)| *place).collect();
        // Labels of points out of view are omitted unless they are fully visible.
        if !spot.rect.contains(at) && !boxes.iter().all(|place| spot.rect.contains_rect(*place)) {
            continue;
        }
        // Labels by which points are dragged may cover the ring of the target; all others avoid it.
        if group.rank > 0 {
            taken.extend(ring.take());
        }
        let is_good = |shift: f32| {
            let mut moved = boxes.iter().map(|place| place.translate(vec2(0.0, shift)));
            moved.all(|place| spot.rect.contains_rect(place) && !on_bars(place, &bars))
        };
        let shift = match clearing_shift(&boxes, &taken, spot.rect) {
            Some(shift) if group.rank == 0 || is_good(shift) => vec2(0.0, shift),
            None if group.rank == 0 => Vec2::ZERO,
            None if group.rank == OPTIONAL_RANK => continue,
            Some(shift) if group.rank == OPTIONAL_RANK => vec2(0.0, shift),
            _ => cheapest_shift(&boxes, &taken, &bars, spot.rect),
        };
        // Labels that would be partly covered are omitted.
        let hidden = |place: &Rect| covered.iter().any(|cover| cover.intersects(place.translate(shift)));
        if group.rank > 1 && boxes.iter().any(hidden) {
            continue;
        }
        for (label, galley, place) in group.words {
            let place = place.translate(shift);
            taken.push(place);
            all.push((label, galley, place));
        }
    }
    all
}

/// Lengthens the line from a point to its note, if the note is shifted.
fn lead(painter: &Painter, spot: &SceneViewport, scene: &Scene, (label, place): (&Label, Rect)) {
    let is_own = |name: &str| name.strip_prefix(&*label.name) == Some("/leader");
    let own = label.name.starts_with(NOTES).then(|| scene.lines.iter().find(|line| is_own(&line.name))).flatten();
    let Some((line, end)) = own.and_then(|line| Some((line, spot.screen(label.at.map(f64::from))?))) else { return };
    let near = end.clamp(place.min, place.max);
    painter.line_segment([end, near], Stroke::new(line.width, colour(line.colour)));
}

fn write(painter: &Painter, scene: &Scene, label: &Label, galley: Arc<Galley>, place: Rect) {
    // A translucent background keeps the text legible over bars and curves, and over whatever lies behind the scene.
    let [r, g, b, opacity] = scene.background;
    let plate = if opacity > 0.0 { faded(scene.background, 0.55) } else { [r, g, b, PLATE_OPACITY] };
    painter.rect_filled(place.expand2(vec2(3.0, 0.0)), 3.0, colour(plate));
    painter.galley(place.min, galley, colour(label.colour));
}

impl Group<'_> {
    /// Places the labels beside their point `at`, moved into the view if they would be clipped.
    fn place(&mut self, at: Pos2, view: Rect) {
        let widest = self.words.iter().map(|(_, galley, _)| galley.size().x).fold(0.0, f32::max);
        for (label, galley, place) in &mut self.words {
            let [x, y] = label.offset;
            let over = at.x + x + widest - (view.right() - 10.0);
            let (align, shift) = match label.anchor {
                // The label is lowered, so that it does not cover the point.
                Anchor::Left if over > 0.0 && view.contains(at) => {
                    (Align2::LEFT_CENTER, vec2(x - over, if over > MAX_OVERHANG_PT { y + 30.0 } else { y }))
                }
                Anchor::Left => (Align2::LEFT_CENTER, vec2(x, y)),
                Anchor::Centre => (Align2::CENTER_CENTER, vec2(x, y)),
                Anchor::Right => (Align2::RIGHT_CENTER, vec2(x, y)),
            };
            *place = align.anchor_size(at + shift, galley.size());
            if label.anchor == Anchor::Centre && view.contains(at) {
                let over = (place.right() - view.right() + EDGE_DISTANCE_PT).max(0.0)
                    - (view.left() + EDGE_DISTANCE_PT - place.left()).max(0.0);
                *place = place.translate(vec2(-over, 0.0));
            }
        }
    }
}

/// Whether a rectangle touches a bar.
fn on_bars(place: Rect, bars: &[[Pos2; 2]]) -> bool {
    let place = place.expand(BAR_DISTANCE_PT);
    bars.iter().any(|[a, b]| {
        // Interval of the segment, from 0 to 1, that lies between both pairs of sides.
        let along = *b - *a;
        let mut within = [0.0_f32, 1.0];
        for (from, by, low, high) in
            [(a.x, along.x, place.left(), place.right()), (a.y, along.y, place.top(), place.bottom())]
        {
            let ends = [(low - from) / by, (high - from) / by];
            if by.abs() < 1e-6 {
                if from < low || from > high {
                    return false;
                }
                continue;
            }
            within = [within[0].max(ends[0].min(ends[1])), within[1].min(ends[0].max(ends[1]))];
        }
        within[0] <= within[1]
    })
}

/// Returns the shift of lowest cost, points: overlaps, parts out of view and covered bars cost more than distance.
fn cheapest_shift(boxes: &[Rect], taken: &[Rect], bars: &[[Pos2; 2]], view: Rect) -> Vec2 {
    let cost = |shift: Vec2| {
        let each = boxes.iter().map(|place| {
            let place = place.translate(shift);
            let words = taken.iter().filter(|other| place.intersects(**other)).count() as f32;
            let out = if view.contains_rect(place) { 0.0 } else { OUT_OF_VIEW_COST };
            words * OVERLAP_COST + out + if on_bars(place, bars) { BAR_COST } else { 0.0 }
        });
        each.sum::<f32>() + shift.y.abs() + 0.6 * shift.x.abs()
    };
    let shifts = SIDEWAYS_SHIFTS_PT
        .iter()
        .flat_map(|x| (-SHIFT_STEPS..=SHIFT_STEPS).map(move |i| vec2(*x, i as f32 * SHIFT_STEP_PT)));
    let cheapest = shifts.map(|shift| (cost(shift), shift)).min_by(|a, b| a.0.total_cmp(&b.0));
    cheapest.map_or(Vec2::ZERO, |(_, shift)| shift)
}

/// Returns the smallest vertical shift, points, for which the boxes overlap no rectangle in `taken`. A shift other
/// than 0 also keeps them between the upper and the lower edge of the view.
/// `None` if there is none within [`MAX_SHIFT_PT`].
fn clearing_shift(boxes: &[Rect], taken: &[Rect], view: Rect) -> Option<f32> {
    let moved = |shift: f32| boxes.iter().map(move |place| place.translate(vec2(0.0, shift)));
    let is_free = |shift: f32| {
        let in_view = |place: Rect| place.top() >= view.top() && place.bottom() <= view.bottom();
        moved(shift).all(|place| taken.iter().all(|other| !place.intersects(*other)))
            && (shift == 0.0 || moved(shift).all(in_view))
    };
    if is_free(0.0) {
        return Some(0.0);
    }
    let pairs = boxes.iter().flat_map(|place| taken.iter().map(move |other| (place, other)));
    let beside = pairs.filter(|(place, other)| place.x_range().intersects(other.x_range()));
    let shifts =
        beside.flat_map(|(place, other)| [other.bottom() - place.top() + 1.0, other.top() - place.bottom() - 1.0]);
    let mut shifts: Vec<f32> = shifts.filter(|shift| shift.abs() <= MAX_SHIFT_PT).collect();
    shifts.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    shifts.into_iter().find(|shift| is_free(*shift))
}
