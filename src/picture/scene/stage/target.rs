//! The target and its labels.

use crate::numbers::signed;
use crate::scene::course::target_handle;
use crate::scene::exaggeration::DrawnFrame;
use crate::scene::options::{Handle, ViewOptions};
use crate::scene::palette::{Palette, faded};
use crate::scene::{Anchor, Label, Marker, Polyline, Scene, point};
use stillbase_mechanics::planar::Vector;
use stillbase_simulation::frame::{Frame, Reach};

/// Text at the target while it can be dragged.
const INVITATION: &str = "drag me";

/// Minimum distance of the end effector from its target that is labelled, m.
const MIN_MISS_M: f64 = 5e-4;

fn place(p: Vector) -> String {
    format!("{}, {}", signed(p.re, 3), signed(p.im, 3))
}

/// Draws the end effector and its target at height `z`, m.
pub fn draw(scene: &mut Scene, palette: &Palette, shown: &DrawnFrame<'_>, options: &ViewOptions, z: f64) {
    let frame = shown.frame;
    let hot = options.highlighted == Some(Handle::Target);
    let waits = frame.target.reach.waits_at();
    let outside = waits.is_some();
    let held = options.drag_position.filter(|_| outside).map(|[x, y]| Vector::new(x, y));
    let at = held.unwrap_or(shown.target);
    let (ink, dim) = (palette.ink, palette.dim);
    scene.markers.push(Marker::disc("end_effector", point(shown.end_effector, z), 4.0, ink));
    let inside = faded(ink, if hot && !outside { 0.12 } else { 0.0 });
    let ring = Marker::disc("target", point(at, z), if hot { 15.0 } else { 12.5 }, inside);
    scene.markers.push(ring.edged(ink, 2.2));
    let between = |name: &'static str, from: Vector| {
        Polyline::new(name, [vec![point(from, z), point(at, z)]], 1.4, dim).dashed(4.0, 4.0).on_top()
    };
    let (first, anchor) = match waits {
        Some(nearest) => {
            let nearest = shown.near_target(nearest);
            scene.lines.push(between("target/gap", nearest));
            let disc = Marker::disc("target/nearest", point(nearest, z), 4.5, palette.background);
            scene.markers.push(disc.edged(palette.amber, 2.0));
            ([0.0, 26.0], Anchor::Centre)
        }
        None => {
            if miss(frame).is_some() {
                scene.lines.push(between("target/miss", shown.end_effector));
            }
            ([20.0, -7.0], Anchor::Left)
        }
    };
    for (i, (text, leads)) in rows(frame, options).into_iter().enumerate() {
        let offset = [first[0], first[1] + 16.0 * i as f32];
        let (colour, size) = if leads { (ink, 13.0) } else { (dim, 11.5) };
        scene.labels.push(Label::new("target/words", point(at, z), offset, text, colour, size, anchor));
    }
}

/// Returns the distance of the end effector from its target, m, if it is large enough to be labelled.
fn miss(frame: &Frame) -> Option<f64> {
    Some((frame.end_effector - target_handle(frame)).norm()).filter(|miss| *miss > MIN_MISS_M)
}

/// Returns the rows of text at the target, each with a flag for a title. They give true positions, without
/// exaggeration.
fn rows(frame: &Frame, options: &ViewOptions) -> Vec<(String, bool)> {
    let mut rows: Vec<(String, bool)> = Vec::new();
    match frame.target.reach {
        Reach::Outside { nearest, displayed_b, other_sheet, .. } => {
            let would = match displayed_b {
                Some(b) if frame.floats => format!("b = {b} rad if the base is held"),
                Some(b) => format!("b = {b} rad would reach it"),
                None if other_sheet => "drag it round, or change b".into(),
                None => "no b reaches it".into(),
            };
            let title = match (other_sheet, frame.q.len()) {
                (true, _) => "beyond a fold or a change point",
                (_, 2) => "beside the reactionless curve",
                _ => "outside the reactionless workspace",
            };
            rows.push((title.into(), true));
            rows.push((format!("nearest point {} m", place(nearest)), false));
            rows.push((would, false));
        }
        Reach::Stopped { nearest, why } => {
            rows.push(("no way there at zero momentum".into(), true));
            rows.push((format!("stops at {} m", place(nearest)), false));
            rows.push((why.to_string(), false));
        }
        reach => {
            rows.push((format!("{} m", place(target_handle(frame))), true));
            if let Some(miss) = miss(frame) {
                // Two short rows, because there is little space beside the target.
                rows.push((format!("end effector {} m", place(frame.end_effector)), false));
                rows.push((format!("{} mm off", signed(1e3 * miss, 1)), false));
            }
            match reach {
                Reach::Carried => rows.push(("turns with its workspace".into(), false)),
                _ if options.show_hints => rows.push((INVITATION.into(), false)),
                _ => {}
            }
        }
    }
    rows
}
