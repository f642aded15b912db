//! The planned path with its points, what is drawn by hand, and what was refused.

use super::{Handle, Stage, ViewOptions, label, point};
use crate::mechanics::planar::{Units, Vector};
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::{Anchor, Line, Marker, Scene};
use crate::planning::Motion;
use crate::session::Run;
use crate::session::scenario::Shape;

/// Parts of a path that is drawn.
const LOOKS: usize = 256;

/// Parts that each of many paths end to end is drawn in.
const A_PART: usize = 48;

/// The most points of a task that are drawn one by one; more are a curve drawn by hand.
pub(super) const NAMED: usize = 24;

/// A planned motion as seen.
#[derive(Clone, Debug)]
pub(super) struct Course {
    pub points: Vec<Vector>,
    pub start: Units,
    /// Points of the task: their numbers, names and places, m.
    pub waypoints: Vec<(usize, String, Vector)>,
}

/// Numbers, names and places of the points that are drawn, m.
pub(crate) fn waypoints(run: &Run) -> Vec<(usize, String, Vector)> {
    let task = &run.scenario().task;
    if task.samples.is_some() {
        // They may have been turned since the file was written.
        return [(0, 0.0), (1, 1.0)].map(|(i, share)| (i, task.name_of(i), run.on_path(share))).to_vec();
    }
    let named = |(i, p)| (i, task.name_of(i), p);
    let all: Vec<_> = task.points().into_iter().enumerate().map(named).collect();
    if all.len() <= NAMED && task.shape() != Shape::Freehand {
        all
    } else {
        [&all[..1], &all[all.len() - 1..]].concat()
    }
}

/// Where a path is looked at to be drawn.
pub(in crate::picture::scene) fn looks(motion: &Motion) -> impl Iterator<Item = f64> {
    let n = (A_PART * motion.path.parts()).clamp(LOOKS, 4096);
    (0..=n).map(move |i| i as f64 / n as f64)
}

impl Stage {
    pub(super) fn course(&self, scene: &mut Scene, palette: &Palette, options: &ViewOptions) {
        let Some(course) = &self.motion else { return };
        let z = self.handle_height();
        scene.lines.push(Line {
            name: "path".into(),
            points: course.points.iter().map(|p| point(*p, z)).collect(),
            width: 1.6,
            colour: faded(palette.ink, 0.75),
            dash: Some([2.0, 4.0]),
            on_top: true,
        });
        for (i, name, at) in &course.waypoints {
            let hot = options.hot == Some(Handle::Waypoint(*i));
            let at = match (hot, options.held) {
                (true, Some([x, y])) => Vector::new(x, y),
                _ => *at,
            };
            let unserved = self.waiting.iter().flat_map(|(waiting, _)| &waiting.points).find(|(n, _)| n == i);
            let ink = if unserved.is_some() { palette.reaction } else { palette.ink };
            scene.markers.push(Marker {
                name: format!("waypoint/{name}"),
                at: point(at, z),
                radius: if hot { 6.5 } else { 4.5 },
                fill: palette.background,
                stroke: ink,
                stroke_width: if hot { 2.2 } else { 1.6 },
            });
            scene.labels.push(label(at, z, [-12.0, 0.0], name, ink, 13.0, Anchor::Right));
            if let Some((_, would_do)) = unserved {
                let text = match would_do {
                    Some(b) => format!("b = {b} rad would reach it"),
                    None => "no b reaches it".into(),
                };
                scene.labels.push(label(at, z, [-12.0, 15.0], &text, palette.reaction, 11.5, Anchor::Right));
            }
        }
    }

    /// What is being drawn by hand, and what was refused.
    pub(super) fn wishes(&self, scene: &mut Scene, palette: &Palette, options: &ViewOptions) {
        let z = self.handle_height();
        let line = |name: &str, points: &[Vector], colour, dash| Line {
            name: name.into(),
            points: points.iter().map(|p| point(*p, z)).collect(),
            width: 1.8,
            colour,
            dash,
            on_top: true,
        };
        if options.stroke.len() > 1 {
            let drawn: Vec<Vector> = options.stroke.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
            scene.lines.push(line("stroke", &drawn, palette.ink, None));
        }
        let refused = self.waiting.as_ref().and_then(|(_, curve)| curve.as_ref());
        if let Some(refused) = options.refused.as_deref().or(refused) {
            scene.lines.push(line("refused", &refused.curve, palette.reaction, Some([4.0, 4.0])));
            scene.markers.push(Marker {
                name: "refused/at".into(),
                at: point(refused.at, z),
                radius: 5.5,
                fill: palette.background,
                stroke: palette.reaction,
                stroke_width: 2.2,
            });
            scene.labels.push(label(
                refused.at,
                z,
                [12.0, 0.0],
                &format!("stops here: {}", refused.why),
                palette.reaction,
                12.0,
                Anchor::Left,
            ));
        }
    }

    /// Points of the planned path that can be dragged: their numbers, A first.
    pub fn waypoints(&self) -> impl Iterator<Item = usize> + '_ {
        self.motion.iter().flat_map(|course| course.waypoints.iter().map(|(i, ..)| *i))
    }
}
