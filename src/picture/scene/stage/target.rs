//! The target, and what is said of it.

use super::{Handle, INVITATION, Stage, ViewOptions, label, point, signed};
use crate::mechanics::planar::Vector;
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::{Anchor, Line, Marker, Scene};
use crate::simulation::frame::{Frame, Reach};

/// Where the target's handle is: out of reach it stays where it was sent, else it goes with the end effector. It is in
/// the axes of the base at the start, as if the base had not moved.
pub(in crate::picture::scene) fn target_handle(frame: &Frame) -> Vector {
    match frame.target.reach {
        Reach::Outside { .. } => frame.target.at,
        Reach::Inside | Reach::Carried => frame.in_base(frame.tip),
    }
}

/// The end effector's distance from its target that is spoken of, m.
const SEEN_MISS: f64 = 5e-4;

pub(super) fn brief_point(p: Vector) -> String {
    format!("{}, {}", signed(p.re, 3), signed(p.im, 3))
}

impl Stage {
    pub(super) fn target(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        frame: &Frame,
        options: &ViewOptions,
        true_tip: Vector,
    ) {
        let z = self.handle_height();
        let tip = frame.tip;
        let hot = options.hot == Some(Handle::Target);
        let outside = matches!(frame.target.reach, Reach::Outside { .. });
        let held = options.held.filter(|_| outside).map(|[x, y]| Vector::new(x, y));
        let at = held.unwrap_or_else(|| target_handle(frame));
        scene.markers.push(Marker {
            name: "end-effector".into(),
            at: point(tip, z),
            radius: 4.0,
            fill: palette.ink,
            stroke: palette.ink,
            stroke_width: 0.0,
        });
        scene.markers.push(Marker {
            name: "target".into(),
            at: point(at, z),
            radius: if hot { 15.0 } else { 12.5 },
            fill: faded(palette.ink, if hot && !outside { 0.12 } else { 0.0 }),
            stroke: palette.ink,
            stroke_width: 2.2,
        });
        let ink = palette.ink;
        match frame.target.reach {
            Reach::Outside { nearest, shown_b, other_sheet, .. } => {
                scene.lines.push(Line {
                    name: "target/gap".into(),
                    points: vec![point(nearest, z), point(at, z)],
                    width: 1.4,
                    colour: palette.dim,
                    dash: Some([4.0, 4.0]),
                    on_top: true,
                });
                scene.markers.push(Marker {
                    name: "target/nearest".into(),
                    at: point(nearest, z),
                    radius: 4.5,
                    fill: palette.background,
                    stroke: palette.amber,
                    stroke_width: 2.0,
                });
                let would = match shown_b {
                    Some(b) => format!("b = {b} rad would reach it"),
                    None if other_sheet => "drag it round, or change b".into(),
                    None => "no b reaches it".into(),
                };
                let title = match other_sheet {
                    true => "beyond a fold or a change point",
                    false => "outside the reactionless workspace",
                };
                let rows = [
                    (title.into(), ink, 13.0),
                    (format!("nearest point {} m", brief_point(nearest)), palette.dim, 11.5),
                    (would, palette.dim, 11.5),
                ];
                for (i, (text, colour, size)) in rows.into_iter().enumerate() {
                    let down = 26.0 + 16.0 * i as f32;
                    scene.labels.push(label(at, z, [0.0, down], &text, colour, size, Anchor::Centre));
                }
            }
            reach => {
                let words = if reach == Reach::Carried { "turns with its workspace" } else { INVITATION };
                // Where things are, whatever the picture exaggerates.
                let miss = (true_tip - at).norm();
                let mut rows = vec![(format!("{} m", brief_point(at)), ink, 13.0)];
                if miss > SEEN_MISS {
                    scene.lines.push(Line {
                        name: "target/miss".into(),
                        points: vec![point(tip, z), point(at, z)],
                        width: 1.4,
                        colour: palette.dim,
                        dash: Some([4.0, 4.0]),
                        on_top: true,
                    });
                    // Two rows: beside the target there is little room.
                    rows.push((format!("end effector {} m", brief_point(true_tip)), palette.dim, 11.5));
                    rows.push((format!("{} mm off", signed(1e3 * miss, 1)), palette.dim, 11.5));
                }
                rows.push((words.into(), palette.dim, 11.5));
                for (i, (text, colour, size)) in rows.into_iter().enumerate() {
                    let down = -7.0 + 16.0 * i as f32;
                    scene.labels.push(label(at, z, [20.0, down], &text, colour, size, Anchor::Left));
                }
            }
        }
    }
}
