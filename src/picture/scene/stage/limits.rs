//! Joint limits as arcs at the pin between the links of two drives: the directions that the outer link can have.

use std::f64::consts::{PI, TAU};

use crate::scene::exaggeration::DrawnFrame;
use crate::scene::linkage::LinkageModel;
use crate::scene::options::Handle;
use crate::scene::palette::{Palette, faded};
use crate::scene::pick::{Grip, Pick, Pivot};
use crate::scene::pointer::Pointer;
use crate::scene::{Marker, Name, Polyline, Scene, Strips, Transform, place, point, posed};
use stillbase_mechanics::kinematics::closest_turn;
use stillbase_mechanics::machine::{MAX_ANGLE, Machine, RelativeAngle};
use stillbase_mechanics::planar::{MAX_DRIVES, Vector, unit};

/// Radius of the innermost arc, as a fraction of the reach.
const ARC_RADIUS: f64 = 0.062;
/// Radial distance between arcs at one pin, as a fraction of the reach.
const ARC_SPACING: f64 = 0.016;

/// Minimum span between lower and upper limit, and minimum difference of this span from a full turn, rad.
const MIN_SPAN_RAD: f64 = PI / 180.0;

/// A limit is marked if the present angle is nearer than this, rad.
const MARK_WITHIN_RAD: f64 = 5.0 * PI / 180.0;

/// The arcs of the joint limits of a machine.
#[derive(Clone, Debug)]
pub struct LimitArcs {
    arcs: Vec<LimitArc>,
}

#[derive(Clone, Debug)]
struct LimitArc {
    name: Name,
    /// Index of the relative angle, from 0.
    k: usize,
    angle: RelativeAngle,
    /// Index of the pin in the linkage.
    pin: usize,
    /// 1 if the outer link points in the direction of its drive, −1 if opposite.
    sign: f64,
    radius: f64,
    strips: Strips,
}

impl LimitArcs {
    /// Returns the arcs of a machine. An angle has no arc if it allows a full turn, or no pin connects its links.
    pub fn of(machine: &Machine, linkage: &LinkageModel) -> Self {
        let e = [Vector::new(1.0, 0.0); MAX_DRIVES];
        let pins: Vec<Vec<usize>> = linkage.joints(&e).map(|(_, links)| links.to_vec()).collect();
        let mut arcs: Vec<LimitArc> = Vec::new();
        for (k, angle) in machine.angles().iter().enumerate() {
            let span = angle.limits.end() - angle.limits.start();
            if !span.is_finite() || span >= TAU {
                continue;
            }
            // The link of a drive at a pin, preferably one between base and end effector.
            let arm = |links: &[usize], drive: usize| {
                let all = links.iter().filter(|j| linkage.bars()[**j].drive == drive);
                all.copied().max_by_key(|j| linkage.bars()[*j].carries_tip)
            };
            let meets = pins.iter().enumerate().filter_map(|(pin, links)| {
                let (outer, inner) = (arm(links, angle.to)?, arm(links, angle.from)?);
                let carries = [outer, inner].iter().filter(|j| linkage.bars()[**j].carries_tip).count();
                Some((pin, outer, carries))
            });
            let Some((pin, outer, _)) = meets.max_by_key(|(pin, _, carries)| (*carries, std::cmp::Reverse(*pin)))
            else {
                continue;
            };
            let others = arcs.iter().filter(|arc| arc.pin == pin).count();
            let sign = linkage.bars()[outer].sign();
            let radius = (ARC_RADIUS + ARC_SPACING * others as f64) * linkage.reach();
            let mut arc = LimitArc {
                name: format!("machine/limits/{}", angle.name).into(),
                k,
                angle: angle.clone(),
                pin,
                sign,
                radius,
                strips: [].into(),
            };
            let n = (span / 0.05).ceil().max(1.0) as usize;
            let on = |a: f64, times: f64| point(arc.direction(a) * (times * arc.radius), 0.0);
            let [low, high] = [*angle.limits.start(), *angle.limits.end()];
            let bow = (0..=n).map(|i| on(low + span * i as f64 / n as f64, 1.0)).collect();
            let ends = [low, high].map(|a| vec![on(a, 0.8), on(a, 1.2)]);
            arc.strips = [vec![bow], ends.to_vec()].concat().into();
            arcs.push(arc);
        }
        Self { arcs }
    }

    /// Draws the arcs; arcs under the pointer are highlighted, and limits near the present angle are marked.
    pub fn draw(
        &self,
        scene: &mut Scene,
        linkage: &LinkageModel,
        palette: &Palette,
        shown: &DrawnFrame<'_>,
        hot: Option<Handle>,
    ) {
        for arc in &self.arcs {
            let Some(pose) = arc.pose(linkage, shown) else { continue };
            let lit = matches!(hot, Some(Handle::Limit(k, _)) if k == arc.k)
                || matches!(hot, Some(Handle::Joint(pin)) if pin == arc.pin);
            let colour = if lit { palette.ink } else { faded(palette.dim, 0.55) };
            let line = Polyline::new(arc.name.clone(), arc.strips.clone(), if lit { 1.8 } else { 1.2 }, colour);
            scene.lines.push(Polyline { world_from_item: pose, ..line });
            for end in 0..2 {
                let limit = arc.limit(end);
                let held = hot == Some(Handle::Limit(arc.k, end));
                let now = shown.frame.a[arc.k];
                if held || (now - limit).abs() < MARK_WITHIN_RAD {
                    let at = place(&pose, point(arc.direction(limit) * arc.radius, 0.0));
                    let size = if held { 5.5 } else { 3.5 };
                    let disc = Marker::disc(format!("{}/end", arc.name), at, size, palette.background);
                    scene.markers.push(disc.edged(palette.ink, 1.8));
                }
            }
        }
    }

    /// Returns the picks of the ends of all arcs at their drawn positions.
    pub fn ends<'a>(&'a self, linkage: &'a LinkageModel, shown: &'a DrawnFrame<'a>) -> impl Iterator<Item = Pick> + 'a {
        self.arcs.iter().flat_map(move |arc| {
            let pivot = arc.pivot(linkage, shown);
            (0..2).filter_map(move |end| {
                let (pivot, z) = pivot?;
                let off = arc.direction(arc.limit(end)) * unit(pivot.inner) * arc.radius;
                let at = [pivot.at[0] + off.re, pivot.at[1] + off.im, z];
                Some(Pick { handle: Handle::Limit(arc.k, end), at, grip: Some(Grip::Limit(pivot)) })
            })
        })
    }

    /// Returns both limits of an angle, rad, with one limit dragged to the pointer; `z` is the height of the plane of
    /// handles, m.
    pub fn pulled(&self, (k, end): (usize, usize), pivot: &Pivot, z: f64, pointer: &Pointer) -> Option<[f64; 2]> {
        let arc = self.arcs.iter().find(|arc| arc.k == k)?;
        let [x, y] = pointer.ray()?.at_height(z)?;
        let off = Vector::new(x - pivot.at[0], y - pivot.at[1]) * arc.sign;
        let wanted = off.arg() - pivot.inner + arc.angle.offset;
        let mut ends = [arc.limit(0), arc.limit(1)];
        let wanted = closest_turn(wanted, ends[end]);
        ends[end] = match end {
            0 => wanted.max(ends[1] - TAU + MIN_SPAN_RAD).max(-MAX_ANGLE).min(ends[1] - MIN_SPAN_RAD),
            _ => wanted.min(ends[0] + TAU - MIN_SPAN_RAD).min(MAX_ANGLE).max(ends[0] + MIN_SPAN_RAD),
        };
        Some(ends)
    }
}

impl LimitArc {
    fn limit(&self, end: usize) -> f64 {
        if end == 0 { *self.angle.limits.start() } else { *self.angle.limits.end() }
    }

    /// Returns the direction of the outer link at a relative angle, relative to the direction of the inner drive.
    fn direction(&self, a: f64) -> Vector {
        unit(a - self.angle.offset) * self.sign
    }

    /// Returns the centre of the arc with the angle of the inner drive, and the height, m.
    fn pivot(&self, linkage: &LinkageModel, shown: &DrawnFrame<'_>) -> Option<(Pivot, f64)> {
        let ([x, y, _], _) = linkage.joints(&shown.q.units()).nth(self.pin)?;
        let at = shown.base.at + Vector::new(x, y);
        Some((Pivot { at: [at.re, at.im], inner: shown.q[self.angle.from] }, linkage.top()))
    }

    fn pose(&self, linkage: &LinkageModel, shown: &DrawnFrame<'_>) -> Option<Transform> {
        let (Pivot { at: [x, y], inner }, z) = self.pivot(linkage, shown)?;
        Some(posed(Vector::new(x, y), unit(inner), z))
    }
}
