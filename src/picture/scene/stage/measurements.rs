//! Distances and angles that the user measures.

use super::{Stage, under};
use crate::numbers::signed;
use crate::scene::exaggeration::DrawnFrame;
use crate::scene::measurement::{ANGLE_POINTS, Measurement, angle};
use crate::scene::options::ViewOptions;
use crate::scene::palette::{Palette, Theme, palette};
use crate::scene::pointer::Pointer;
use crate::scene::{Anchor, Label, Marker, Polyline, Scene, point};
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_session::scenario::SnapPoint;

/// Largest radius of an arc, as a fraction of the reach, and of the shorter line.
const ARC_OF_REACH: f64 = 0.1;
const ARC_OF_LINE: f64 = 0.4;
/// Number of segments of an arc.
const ARC_SEGMENTS: usize = 32;
/// Distance of the angle's label from the corner, as a multiple of the radius.
const LABEL_DISTANCE: f64 = 1.5;

impl Stage {
    /// Draws all measurements, and the point to which the pointer snaps. The texts give true values, without
    /// exaggeration.
    pub(super) fn draw_measurements(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        options: &ViewOptions,
    ) {
        let z = self.handle_height();
        for (i, measurement) in options.measurements.iter().enumerate() {
            self.draw_measurement(scene, palette, shown, (i + 1, measurement));
        }
        if let Some((snap, at)) = options.snap.as_ref().and_then(|snap| Some((snap, self.position(snap, shown)?))) {
            let free = matches!(snap, SnapPoint::Place(_));
            let ring = Marker::disc("measures/snap", point(at, z), if free { 3.5 } else { 8.0 }, [0.0; 4]);
            scene.markers.push(ring.edged(palette.amber, 1.6));
            if !free {
                let text = snap.title();
                let label =
                    Label::new("measures/point", point(at, z), [12.0, 14.0], text, palette.amber, 11.5, Anchor::Left);
                scene.labels.push(label);
            }
        }
    }

    fn draw_measurement(
        &self,
        scene: &mut Scene,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        (number, measurement): (usize, &Measurement),
    ) {
        let z = self.handle_height();
        let Some(drawn) = self.positions(measurement, shown) else { return };
        let Some(own) = self.positions(measurement, &shown.frame.into()) else { return };
        let name = |part: &str| format!("measures/{number}/{part}");
        let (ink, width) = if measurement.highlighted { (palette.amber, 2.2) } else { (palette.ink, 1.2) };
        let strips: Vec<Vec<[f32; 3]>> = self.strips(&drawn).collect();
        scene.lines.push(Polyline::new(name("line"), strips, width, ink).on_top());
        for at in &drawn {
            scene.markers.push(Marker::disc(name("ends"), point(*at, z), 2.6, ink));
        }
        let mut words = |own: String, at: Vector, offset: [f32; 2], text: String| {
            scene.labels.push(Label::new(own, point(at, z), offset, text, ink, 12.0, Anchor::Centre));
        };
        for (k, (ends, true_ends)) in drawn.windows(2).zip(own.windows(2)).enumerate() {
            let text = format!("{} m", signed((true_ends[1] - true_ends[0]).norm(), 3));
            words(name(&format!("distance/{}", k + 1)), 0.5 * (ends[0] + ends[1]), [0.0, -11.0], text);
        }
        let corner = |all: &[Vector]| <[Vector; ANGLE_POINTS]>::try_from(all).ok();
        if let (Some(drawn), Some(own)) = (corner(&drawn), corner(&own))
            && let (Some(turn), Some(value)) = (angle(drawn), angle(own))
        {
            let bisector = (drawn[0] - drawn[1]) / (drawn[0] - drawn[1]).norm() * unit(0.5 * turn);
            let at = drawn[1] + bisector * (LABEL_DISTANCE * self.arc_radius(drawn));
            words(name("angle"), at, [0.0; 2], format!("{} rad", signed(value.abs(), 3)));
        }
    }

    /// Returns the positions of the points of a measurement, m; `None` for fewer than two, or if one does not exist.
    fn positions(&self, measurement: &Measurement, shown: &DrawnFrame<'_>) -> Option<Vec<Vector>> {
        let all: Option<Vec<Vector>> = measurement.points.iter().map(|point| self.position(point, shown)).collect();
        all.filter(|all| measurement.is_whole() && all.iter().all(|p| p.re.is_finite() && p.im.is_finite()))
    }

    /// Returns the lines of a measurement: those between its points, and the arc of an angle.
    fn strips<'a>(&'a self, drawn: &'a [Vector]) -> impl Iterator<Item = Vec<[f32; 3]>> + 'a {
        let z = self.handle_height();
        let lines = drawn.windows(2).map(move |ends| ends.iter().map(|p| point(*p, z)).collect());
        let corner = <[Vector; ANGLE_POINTS]>::try_from(drawn).ok();
        let arc = corner.and_then(|corner| Some((corner, angle(corner)?))).map(move |(corner, turn)| {
            let first = (corner[0] - corner[1]) / (corner[0] - corner[1]).norm();
            let radius = self.arc_radius(corner);
            let at = |i: usize| corner[1] + first * unit(turn * i as f64 / ARC_SEGMENTS as f64) * radius;
            (0..=ARC_SEGMENTS).map(|i| point(at(i), z)).collect()
        });
        lines.chain(arc)
    }

    fn arc_radius(&self, [from, corner, to]: [Vector; ANGLE_POINTS]) -> f64 {
        let shorter = (from - corner).norm().min((to - corner).norm());
        (ARC_OF_REACH * self.linkage.reach()).min(ARC_OF_LINE * shorter)
    }

    /// Returns the index of the measurement under the pointer; the newest of several.
    pub fn measurement_at(&self, all: &[Measurement], shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<usize> {
        let ink = palette(Theme::Dark).ink;
        let hit = |measurement: &Measurement| {
            let drawn = self.positions(measurement, shown)?;
            let strips: Vec<Vec<[f32; 3]>> = self.strips(&drawn).collect();
            under::line(&Polyline::new("measures", strips, 1.0, ink), pointer).then_some(())
        };
        all.iter().rposition(|measurement| hit(measurement).is_some())
    }
}
