//! Positions of the points to which notes and measures stick, and the point nearest to the pointer.

use super::Stage;
use crate::scene::exaggeration::DrawnFrame;
use crate::scene::pointer::Pointer;
use stillbase_mechanics::planar::Vector;
use stillbase_session::scenario::{PathPoint, SnapPoint};

/// Distance within which the pointer snaps to a point, px.
const SNAP_PX: f64 = 11.0;

impl Stage {
    /// Returns the points of the machine and of its task; the first of several at one place is preferred.
    pub fn snap_points(&self) -> Vec<SnapPoint> {
        let bars = self.linkage.bars();
        let pin = |links: &[usize]| SnapPoint::Pin(links.iter().map(|j| bars[*j].name.clone()).collect());
        let pins = self.linkage.pins().map(pin);
        let waypoints =
            self.plan.iter().flat_map(|plan| plan.waypoints.iter().map(|(i, name, _)| path_point(*i, name)));
        let first = [SnapPoint::EndEffector, SnapPoint::BasePin].into_iter();
        let last = [SnapPoint::CentreOfMass, SnapPoint::Target];
        first.chain(pins).chain(waypoints.map(SnapPoint::PathPoint)).chain(last).collect()
    }

    /// Returns the position of a point, m; `None` if there is no such point, or for a target that cannot be dragged.
    pub fn position(&self, point: &SnapPoint, shown: &DrawnFrame<'_>) -> Option<Vector> {
        match point {
            SnapPoint::EndEffector => Some(shown.end_effector),
            SnapPoint::Target => self.target_draggable.then_some(shown.target),
            SnapPoint::CentreOfMass => Some(shown.com),
            SnapPoint::BasePin => Some(shown.base.at),
            SnapPoint::Pin(names) => self.pin(names, shown),
            SnapPoint::PathPoint(wanted) => {
                let mut waypoints = self.plan.as_ref()?.waypoints.iter();
                waypoints.find(|(i, name, _)| path_point(*i, name) == *wanted).map(|(.., at)| *at)
            }
            SnapPoint::Place([x, y]) => Some(Vector::new(*x, *y)),
        }
    }

    /// Returns the position of the pin that joins exactly these links, or else of the first one that joins them and
    /// others, m.
    fn pin(&self, names: &[String], shown: &DrawnFrame<'_>) -> Option<Vector> {
        let bars = self.linkage.bars();
        let joins = |links: &[usize]| names.iter().all(|name| links.iter().any(|j| bars[*j].name == *name));
        let mut all = self.linkage.pins().enumerate().filter(|(_, links)| joins(links));
        let first = all.next()?;
        let exact = std::iter::once(first).chain(all).find(|(_, links)| links.len() == names.len());
        let (i, _) = exact.unwrap_or(first);
        let ([x, y, _], _) = self.linkage.joints(&shown.q.units()).nth(i)?;
        Some(shown.base.at + Vector::new(x, y))
    }

    /// Returns the point under the pointer, or else the place there in the plane of handles; `None` if the line of
    /// sight does not meet that plane.
    pub fn snap(&self, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<SnapPoint> {
        let z = self.handle_height();
        let near = self.snap_points().into_iter().filter_map(|point| {
            let at = self.position(&point, shown)?;
            Some((pointer.distance([at.re, at.im, z]).filter(|d| *d < SNAP_PX)?, point))
        });
        // Distances are rounded to whole pixels, so that of points at one place the first one is taken.
        let nearest = near.min_by(|s, t| s.0.round().total_cmp(&t.0.round())).map(|(_, point)| point);
        nearest.or_else(|| pointer.ray()?.at_height(z).map(SnapPoint::Place))
    }
}

fn path_point(index: usize, name: &str) -> PathPoint {
    match (index, name) {
        (0, _) => PathPoint::Start,
        (_, "B") => PathPoint::End,
        (i, _) => PathPoint::Via(i),
    }
}
