//! Joint limits as arcs: at the pin where the arms of two drives meet, where the outer one may point.

use std::f64::consts::{PI, TAU};

use crate::mechanics::kinematics::closest_turn;
use crate::mechanics::machine::{MAX_ANGLE, Machine, RelativeAngle};
use crate::mechanics::planar::{MAX_DRIVES, Vector, unit};
use crate::picture::scene::exaggeration::Shown;
use crate::picture::scene::linkage::Linkage;
use crate::picture::scene::options::Handle;
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::pick::{Grip, Pick, Pivot};
use crate::picture::scene::pointer::Pointer;
use crate::picture::scene::{Line, Marker, Name, Pose, Scene, Strips, place, point, posed};

/// Radius of the innermost arc and the step to the next, parts of the reach.
const RADIUS: f64 = 0.062;
const STEP: f64 = 0.016;

/// Ends of an arc stay apart by this at least, rad.
const LEAST: f64 = PI / 180.0;

/// An end this near to the present angle is shown, rad.
const NEAR_END: f64 = 5.0 * PI / 180.0;

/// The arcs of a machine.
#[derive(Clone, Debug)]
pub struct Limits {
    arcs: Vec<Arc>,
}

#[derive(Clone, Debug)]
struct Arc {
    name: Name,
    /// Which relative angle, counted from 0.
    k: usize,
    angle: RelativeAngle,
    /// Which pin of the linkage.
    pin: usize,
    /// Which way the outer arm points along its drive's direction.
    sign: f64,
    radius: f64,
    strips: Strips,
}

impl Limits {
    /// Of a machine that is drawn like this; an angle without limits, or whose arms meet at no pin, has no arc.
    pub fn of(machine: &Machine, linkage: &Linkage) -> Self {
        let e = [Vector::new(1.0, 0.0); MAX_DRIVES];
        let pins: Vec<Vec<usize>> = linkage.joints(&e).map(|(_, links)| links.to_vec()).collect();
        let mut arcs: Vec<Arc> = Vec::new();
        for (k, angle) in machine.angles().iter().enumerate() {
            let span = angle.limits.end() - angle.limits.start();
            if !span.is_finite() || span >= TAU {
                continue;
            }
            // The arm of a drive among the links at a pin: rather one that carries the end effector.
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
            let radius = (RADIUS + STEP * others as f64) * linkage.reach();
            let mut arc = Arc {
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

    /// Draws them quietly; more clearly what the pointer is on, and an end that the machine is near to.
    pub fn draw(
        &self,
        scene: &mut Scene,
        linkage: &Linkage,
        palette: &Palette,
        shown: &Shown<'_>,
        hot: Option<Handle>,
    ) {
        for arc in &self.arcs {
            let Some(pose) = arc.pose(linkage, shown) else { continue };
            let lit = matches!(hot, Some(Handle::Limit(k, _)) if k == arc.k)
                || matches!(hot, Some(Handle::Joint(pin)) if pin == arc.pin);
            let colour = if lit { palette.ink } else { faded(palette.dim, 0.55) };
            let line = Line::new(arc.name.clone(), arc.strips.clone(), if lit { 1.8 } else { 1.2 }, colour);
            scene.lines.push(Line { world_from_item: pose, ..line });
            for end in 0..2 {
                let limit = arc.limit(end);
                let held = hot == Some(Handle::Limit(arc.k, end));
                let now = shown.frame.a[arc.k];
                if held || (now - limit).abs() < NEAR_END {
                    let at = place(&pose, point(arc.direction(limit) * arc.radius, 0.0));
                    let size = if held { 5.5 } else { 3.5 };
                    let disc = Marker::disc(format!("{}/end", arc.name), at, size, palette.background);
                    scene.markers.push(disc.edged(palette.ink, 1.8));
                }
            }
        }
    }

    /// The ends of all arcs in a frame as shown, to be taken hold of.
    pub fn ends<'a>(&'a self, linkage: &'a Linkage, shown: &'a Shown<'a>) -> impl Iterator<Item = Pick> + 'a {
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

    /// What both limits of an angle are with one end pulled to the pointer in the plane of handles at a height, m; rad.
    pub fn pulled(&self, (k, end): (usize, usize), pivot: &Pivot, z: f64, pointer: &Pointer) -> Option<[f64; 2]> {
        let arc = self.arcs.iter().find(|arc| arc.k == k)?;
        let [x, y] = pointer.ray()?.at_height(z)?;
        let off = Vector::new(x - pivot.at[0], y - pivot.at[1]) * arc.sign;
        let asked = off.arg() - pivot.inner + arc.angle.offset;
        let mut ends = [arc.limit(0), arc.limit(1)];
        let asked = closest_turn(asked, ends[end]);
        ends[end] = match end {
            0 => asked.max(ends[1] - TAU + LEAST).max(-MAX_ANGLE).min(ends[1] - LEAST),
            _ => asked.min(ends[0] + TAU - LEAST).min(MAX_ANGLE).max(ends[0] + LEAST),
        };
        Some(ends)
    }
}

impl Arc {
    fn limit(&self, end: usize) -> f64 {
        if end == 0 { *self.angle.limits.start() } else { *self.angle.limits.end() }
    }

    /// Where the outer arm points at a relative angle, seen from the direction of the inner drive.
    fn direction(&self, a: f64) -> Vector {
        unit(a - self.angle.offset) * self.sign
    }

    /// Where it turns about, and at which height.
    fn pivot(&self, linkage: &Linkage, shown: &Shown<'_>) -> Option<(Pivot, f64)> {
        let ([x, y, _], _) = linkage.joints(&shown.q.units()).nth(self.pin)?;
        let at = shown.base.at + Vector::new(x, y);
        Some((Pivot { at: [at.re, at.im], inner: shown.q[self.angle.from] }, linkage.top()))
    }

    fn pose(&self, linkage: &Linkage, shown: &Shown<'_>) -> Option<Pose> {
        let (Pivot { at: [x, y], inner }, z) = self.pivot(linkage, shown)?;
        Some(posed(Vector::new(x, y), unit(inner), z))
    }
}
