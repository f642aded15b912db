//! The target, and what is said of it.

use crate::mechanics::planar::Vector;
use crate::picture::numbers::signed;
use crate::picture::scene::course::target_handle;
use crate::picture::scene::options::{Handle, ViewOptions};
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::{Anchor, Label, Line, Marker, Rgba, Scene, point};
use crate::simulation::frame::{Frame, Reach};

/// What the target's label says while it can be dragged.
const INVITATION: &str = "drag me";

/// The end effector's distance from its target that is spoken of, m.
const SEEN_MISS: f64 = 5e-4;

fn place(p: Vector) -> String {
    format!("{}, {}", signed(p.re, 3), signed(p.im, 3))
}

/// The end effector and its target at a height, m; the end effector truly is at `true_tip`, whatever is exaggerated.
pub fn draw(scene: &mut Scene, palette: &Palette, frame: &Frame, options: &ViewOptions, true_tip: Vector, z: f64) {
    let tip = frame.end_effector;
    let hot = options.hot == Some(Handle::Target);
    let outside = matches!(frame.target.reach, Reach::Outside { .. });
    let held = options.held.filter(|_| outside).map(|[x, y]| Vector::new(x, y));
    let at = held.unwrap_or_else(|| target_handle(frame));
    let (ink, dim) = (palette.ink, palette.dim);
    scene.markers.push(Marker::disc("end_effector", point(tip, z), 4.0, ink));
    let inside = faded(ink, if hot && !outside { 0.12 } else { 0.0 });
    let ring = Marker::disc("target", point(at, z), if hot { 15.0 } else { 12.5 }, inside);
    scene.markers.push(ring.edged(ink, 2.2));
    let between = |name: &'static str, from: Vector| {
        Line::new(name, [vec![point(from, z), point(at, z)]], 1.4, dim).dashed(4.0, 4.0).on_top()
    };
    let mut rows: Vec<(String, Rgba, f32)> = Vec::new();
    let (first, anchor) = match frame.target.reach {
        Reach::Outside { nearest, shown_b, other_sheet, .. } => {
            scene.lines.push(between("target/gap", nearest));
            let disc = Marker::disc("target/nearest", point(nearest, z), 4.5, palette.background);
            scene.markers.push(disc.edged(palette.amber, 2.0));
            let would = match shown_b {
                Some(b) => format!("b = {b} rad would reach it"),
                None if other_sheet => "drag it round, or change b".into(),
                None => "no b reaches it".into(),
            };
            let title = match (other_sheet, frame.q.len()) {
                (true, _) => "beyond a fold or a change point",
                (_, 2) => "beside the reactionless curve",
                _ => "outside the reactionless workspace",
            };
            rows.push((title.into(), ink, 13.0));
            rows.push((format!("nearest point {} m", place(nearest)), dim, 11.5));
            rows.push((would, dim, 11.5));
            ([0.0, 26.0], Anchor::Centre)
        }
        reach => {
            // Where things are, whatever the picture exaggerates.
            let miss = (true_tip - at).norm();
            rows.push((format!("{} m", place(at)), ink, 13.0));
            if miss > SEEN_MISS {
                scene.lines.push(between("target/miss", tip));
                // Two rows: beside the target there is little room.
                rows.push((format!("end effector {} m", place(true_tip)), dim, 11.5));
                rows.push((format!("{} mm off", signed(1e3 * miss, 1)), dim, 11.5));
            }
            match reach {
                Reach::Carried => rows.push(("turns with its workspace".into(), dim, 11.5)),
                _ if options.invites => rows.push((INVITATION.into(), dim, 11.5)),
                _ => {}
            }
            ([20.0, -7.0], Anchor::Left)
        }
    };
    for (i, (text, colour, size)) in rows.into_iter().enumerate() {
        let offset = [first[0], first[1] + 16.0 * i as f32];
        scene.labels.push(Label::new("target/words", point(at, z), offset, text, colour, size, anchor));
    }
}
