//! The planned path with its points, curves drawn with the pointer, and refused curves.

use crate::scene::course::{stations, waypoints};
use crate::scene::options::{Handle, RefusedCurve, ViewOptions};
use crate::scene::palette::{Palette, faded};
use crate::scene::{Anchor, Label, Marker, Polyline, Scene, Strips, point};
use stillbase_mechanics::planar::{UnitVectors, Vector};
use stillbase_session::{Run, WaitReason};

/// A planned motion for drawing.
#[derive(Clone, Debug)]
pub struct PlannedPath {
    /// Height of the handles, m.
    z: f64,
    /// Start of the path, m.
    pub start_point: Option<Vector>,
    path: Strips,
    /// Pose at the start.
    pub start: UnitVectors,
    /// Points of the task: index, name and position, m.
    pub waypoints: Vec<(usize, String, Vector)>,
    /// Reason why the run waits, and the curve that cannot be followed, if that is the reason.
    waiting: Option<(WaitReason, Option<RefusedCurve>)>,
}

impl PlannedPath {
    /// Returns the planned motion of a run, if it has a plan; it is drawn at height `z`, m.
    pub fn of(run: &Run, z: f64) -> Option<Self> {
        let (machine, motion) = (&run.scenario().machine, run.motion()?);
        let place = |s: f64| run.plan().place(machine, s);
        // A waiting run has points, but no path.
        let points: Vec<Vector> = match run.waiting() {
            Some(_) => Vec::new(),
            None => stations(motion).map(place).collect(),
        };
        Some(Self {
            z,
            start_point: points.first().copied(),
            path: [points.into_iter().map(|p| point(p, z)).collect()].into(),
            start: motion.path.at(0.0).q.units(),
            waypoints: waypoints(run),
            waiting: run.waiting().map(|waiting| (waiting.clone(), RefusedCurve::of(&waiting.why))),
        })
    }

    /// Whether the run waits because its task is infeasible.
    pub fn waits(&self) -> bool {
        self.waiting.is_some()
    }

    /// Draws the path and its points.
    pub fn draw(&self, scene: &mut Scene, palette: &Palette, options: &ViewOptions) {
        let path = Polyline::new("plan/path", self.path.clone(), 1.6, faded(palette.ink, 0.75));
        scene.lines.push(path.dashed(2.0, 4.0).on_top().constant());
        for (i, name, at) in &self.waypoints {
            let hot = options.highlighted == Some(Handle::Waypoint(*i));
            let at = match (hot, options.drag_position) {
                (true, Some([x, y])) => Vector::new(x, y),
                _ => *at,
            };
            let at = point(at, self.z);
            let unserved = self.waiting.iter().flat_map(|(waiting, _)| &waiting.points).find(|(n, _)| n == i);
            let ink = if unserved.is_some() { palette.reaction } else { palette.ink };
            let disc = Marker::disc("plan/waypoints", at, if hot { 6.5 } else { 4.5 }, palette.background);
            scene.markers.push(disc.edged(ink, if hot { 2.2 } else { 1.6 }));
            let mut words = |own: &'static str, text: &str, down: f32, colour, size| {
                let label = Label::new(own, at, [-12.0, down], text, colour, size, Anchor::Right);
                scene.labels.push(label.of_handle(Handle::Waypoint(*i)));
            };
            words("plan/names", name, 0.0, ink, 13.0);
            let mut remedy = |text: &str| words("plan/unserved", text, 15.0, palette.reaction, 11.5);
            match unserved {
                Some((_, Some(b))) => remedy(&format!("b = {b} rad would reach it")),
                Some((_, None)) => remedy("no b reaches it"),
                None => {}
            }
        }
    }

    /// Returns the curve that cannot be followed, if that is why the run waits.
    pub fn blocked(&self) -> Option<&RefusedCurve> {
        self.waiting.as_ref().and_then(|(_, curve)| curve.as_ref())
    }
}

/// Draws the curve that the user is drawing, and a refused curve, at height `z`, m.
pub fn draw_user_curves(
    scene: &mut Scene,
    palette: &Palette,
    options: &ViewOptions,
    blocked: Option<&RefusedCurve>,
    z: f64,
) {
    let drawn = |points: &[Vector]| [points.iter().map(|p| point(*p, z)).collect()];
    if options.stroke.len() > 1 {
        let stroke: Vec<Vector> = options.stroke.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
        scene.lines.push(Polyline::new("stroke", drawn(&stroke), 1.8, palette.ink).on_top());
    }
    if let Some(refused) = options.refused.as_deref().or(blocked) {
        let curve = Polyline::new("refused", drawn(&refused.curve), 1.8, palette.reaction);
        scene.lines.push(curve.dashed(4.0, 4.0).on_top());
        let at = point(refused.at, z);
        scene.markers.push(Marker::disc("refused/at", at, 5.5, palette.background).edged(palette.reaction, 2.2));
        let words = format!("stops here: {}", refused.why);
        let label = Label::new("refused/why", at, [12.0, 0.0], words, palette.reaction, 12.0, Anchor::Left);
        scene.labels.push(label);
    }
}
