//! The ring about the base whose knob sets b and thereby rotates the workspace, for any number of drives.

use std::f64::consts::TAU;

use crate::scene::exaggeration::DrawnFrame;
use crate::scene::options::{Handle, ViewOptions};
use crate::scene::palette::{Palette, faded};
use crate::scene::{Anchor, Label, Marker, Polyline, Scene, Strips, point, posed};
use stillbase_mechanics::kinematics::closest_turn;
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_planning::pose_space::PoseSpace;

/// Number of vertices of the circle.
const CIRCLE_VERTICES: u32 = 96;
/// Distance of the name from the knob, px.
const NAME_DISTANCE_PX: f64 = 18.0;

/// The ring in the frame of the base.
#[derive(Clone, Debug)]
pub struct BaseRing {
    circle: Strips,
    /// Radius, m.
    radius: f64,
    /// Σλ; the knob is at the angle b/Σλ, rad.
    lambda_sum: f64,
}

impl BaseRing {
    /// Returns the ring of a machine that has a pose constant b; `radius` in m.
    pub fn of(space: &PoseSpace, radius: f64) -> Self {
        let corner = |i: u32| point(unit(TAU * f64::from(i) / f64::from(CIRCLE_VERTICES)) * radius, 0.0);
        let circle = vec![(0..=CIRCLE_VERTICES).map(corner).collect::<Vec<_>>()];
        Self { circle: circle.into(), radius, lambda_sum: space.period() / TAU }
    }

    /// Direction of the knob at the present b, rad.
    fn turn(&self, shown: &DrawnFrame<'_>) -> f64 {
        shown.frame.b_reference / self.lambda_sum + shown.base.angle
    }

    /// Returns the position of the knob, m.
    pub fn knob(&self, shown: &DrawnFrame<'_>) -> Vector {
        shown.base.at + unit(self.turn(shown)) * self.radius
    }

    /// Returns the b of a position of the knob, rad; of all b that differ by full turns, the nearest to `near`.
    pub fn b(&self, at: Vector, near: f64, shown: &DrawnFrame<'_>) -> f64 {
        closest_turn(shown.in_base(at).arg(), near / self.lambda_sum) * self.lambda_sum
    }

    /// Draws the ring at height `z`, m.
    pub fn draw(&self, scene: &mut Scene, palette: &Palette, shown: &DrawnFrame<'_>, options: &ViewOptions, z: f64) {
        let (at, base, turn) = (shown.base.at, shown.base.angle, self.turn(shown));
        let pose = posed(at, unit(base), z);
        let ring = Polyline::new("b_ring", self.circle.clone(), 3.0, faded(palette.line, 0.9)).on_top();
        scene.lines.push(ring.moving(pose));
        let swept = (turn - base).rem_euclid(TAU);
        let n = ((swept / TAU * 48.0).ceil() as usize).max(2);
        let along = |i: usize| point(at + unit(base + swept * i as f64 / n as f64) * self.radius, z);
        let arc = (0..=n).map(along).collect();
        scene.lines.push(Polyline::new("b_ring/b", [arc], 3.5, palette.amber).on_top());
        let hot = options.highlighted == Some(Handle::Ring);
        let disc = Marker::disc("b_ring/knob", point(self.knob(shown), z), if hot { 9.0 } else { 7.0 }, palette.amber);
        scene.markers.push(disc.edged(palette.background, 2.0));
        // Beyond the knob, as seen from the base.
        let out = unit(turn) * NAME_DISTANCE_PX;
        let (at, offset) = (point(self.knob(shown), z), [out.re as f32, -out.im as f32]);
        let name = Label::new("b_ring/name", at, offset, "b", palette.amber, 14.0, Anchor::Centre);
        scene.labels.push(name.of_handle(Handle::Ring));
    }
}
