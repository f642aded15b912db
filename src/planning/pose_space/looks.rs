//! Whether any pose is at a distance from B between two critical values of b.
//!
//! # Method
//! What lies between two critical values goes on to both of them, and ends or joins another piece at critical poses
//! beyond. So it is found by climbing from the nearest critical poses below and by descending from the nearest ones
//! above. Only pieces on which b goes round without an end come from none: for these, a look over the last joints, with
//! the three arms that are left in closed form.

use std::f64::consts::{PI, TAU};

use super::continuation::{Climb, GLANCE};
use super::critical::Critical;
use super::space::{AT_BASE, PoseSpace};
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};
use crate::planning::reactionless::{AngleDefinition, AngleLimit, PlaneMap};

/// Looks over the range of the joints that are left free, for one, two, three and more of them.
const LOOKS: [usize; 5] = [33, 13, 7, 5, 3];
/// Of how many critical poses on either side of a gap, the nearest ones, ways lead into it: at first, and with all care.
const NEAREST: [usize; 2] = [3, 24];
/// How far into it, as a share of it.
const GAP_DEPTH_SHARE: f64 = 0.3;
/// And at most, as a share of b's period.
const MAX_GAP_DEPTH_SHARE: f64 = 0.02;
/// How often all joints turn at most to come to a distance.
const MAX_SWEEPS: usize = 200;
/// Turns that bring less than this share of the reach are nothing.
const NO_TURN_SHARE: f64 = 1e-12;
/// Places all over the ranges from which poses at a distance are come to, at first and with all care.
const SAMPLES: [usize; 2] = [32, 512];
/// How far inside a gap one of them is, as a share of it.
const INSIDE_GAP_SHARE: f64 = 1e-3;
/// From how near B poses lead onto it, as a share of the reach.
const NEAR_BASE: f64 = 1e-2;
/// Critical values that are one, to rounding, rad.
const SAME_CRITICAL: f64 = 1e-9;

/// What lies between two critical values of b, rad.
pub(super) struct Gap {
    pub from: f64,
    pub to: f64,
    /// How far below and above poses in it may come from, rad.
    pub free: [f64; 2],
}

impl Gap {
    /// Some of its b, as where a set is about to part few poses are left.
    fn places(&self) -> [f64; 5] {
        [0.5, 0.2, 0.8, 0.05, 0.95].map(|part| self.from + part * (self.to - self.from))
    }
}

/// What reaches a point with the last joints held at each place of a grid: the same for every b, so it is looked up once.
#[derive(Default)]
pub(super) struct Looks {
    /// Spans of b, rad, and where those of each look end.
    spans: Vec<[f64; 2]>,
    ends: Vec<usize>,
    /// The b of some poses at the distance, rad, wherever they are.
    samples: Vec<f64>,
    /// Whether to look with all care.
    pub careful: bool,
}

impl Looks {
    /// For another point.
    pub fn clear(&mut self) {
        self.spans.clear();
        self.ends.clear();
        self.samples.clear();
    }
}

impl PoseSpace {
    /// Whether some pose is on the x axis at a distance from B, m, in a gap between its critical poses, which are sorted
    /// by b.
    pub(super) fn has_pose(&self, distance: f64, gap: &Gap, criticals: &[Critical], looks: &mut Looks) -> bool {
        let p = Vector::new(distance, 0.0);
        if self.drives() > 3 {
            return self.is_climbed_into(p, gap, (criticals, NEAREST[usize::from(looks.careful)]))
                || self.is_seen(p, &gap.places(), looks)
                || self.is_sampled(distance, gap, looks)
                || (looks.careful && self.is_solved(p, 0.5 * (gap.from + gap.to)));
        }
        gap.places().iter().any(|b| self.is_there(p, *b))
    }

    /// Whether a way from a critical pose near a gap leads into it.
    fn is_climbed_into(&self, p: Vector, gap: &Gap, (criticals, nearest): (&[Critical], usize)) -> bool {
        let (period, n) = (self.period(), criticals.len());
        let into = (GAP_DEPTH_SHARE * (gap.to - gap.from)).min(MAX_GAP_DEPTH_SHARE * period);
        let past = |by: f64| (by + SAME_CRITICAL).rem_euclid(period) - SAME_CRITICAL;
        let at_most = |by: &f64, free: f64| *by <= free + SAME_CRITICAL;
        let first = criticals.partition_point(|c| c.b <= gap.from + SAME_CRITICAL);
        let mut below = (1..=n)
            .map(|k| &criticals[(first + n - k) % n])
            .map(|c| (c, past(gap.from - c.b)))
            .take_while(|(_, by)| at_most(by, gap.free[0]))
            .filter(|(c, _)| c.up);
        let last = criticals.partition_point(|c| c.b < gap.to - SAME_CRITICAL);
        let mut above = (0..n)
            .map(|k| &criticals[(last + k) % n])
            .map(|c| (c, past(c.b - gap.to)))
            .take_while(|(_, by)| at_most(by, gap.free[1]))
            .filter(|(c, _)| c.down);
        (0..nearest).any(|_| {
            let rise = below.next().map(|(from, by)| Climb { from, rise: by + into });
            let fall = above.next().map(|(from, by)| Climb { from, rise: -(by + into) });
            rise.iter().chain(&fall).any(|climb| self.left(p, climb, GLANCE).is_some())
        })
    }

    /// Whether a pose at one of these b is seen with the last joints held at places of a grid.
    fn is_seen(&self, p: Vector, b: &[f64], looks: &mut Looks) -> bool {
        let (n, first) = (self.joints.len(), 2);
        let each = LOOKS[(self.drives() - 4).min(LOOKS.len() - 1)];
        let at = |i: usize, j: usize| {
            let [low, high] = self.joints[i].limits;
            low + (high - low) * (j as f64 + 0.5) / each as f64
        };
        let middle = self.middle();
        let look = |code: usize| {
            let (mut held, mut rest) = (middle, code);
            for i in first..n {
                held[i] = at(i, rest % each);
                rest /= each;
            }
            held
        };
        (0..each.pow((n - first) as u32)).any(|code| {
            if code == looks.ends.len() {
                self.spans(p, &look(code), |span| looks.spans.push(span));
                looks.ends.push(looks.spans.len());
            }
            let from = if code > 0 { looks.ends[code - 1] } else { 0 };
            looks.spans[from..looks.ends[code]].iter().any(|span| b.iter().any(|b| self.holds(*span, *b)))
        })
    }

    /// Whether one of some poses at the distance has a b in the gap.
    fn is_sampled(&self, distance: f64, gap: &Gap, looks: &mut Looks) -> bool {
        if looks.samples.is_empty() {
            let b = |a: PerDrive| {
                let q = self.unturned(&a);
                let turn = self.place(&DriveAngles(q)).arg();
                self.lambda.dot(&q) - turn * self.sum
            };
            let found =
                (0..SAMPLES[usize::from(looks.careful)]).filter_map(|i| self.comes_to(distance, self.spread(i))).map(b);
            looks.samples.extend(found.chain([f64::NAN]));
        }
        let inside = INSIDE_GAP_SHARE * (gap.to - gap.from);
        looks.samples.iter().any(|b| self.holds([gap.from + inside, gap.to - inside], *b))
    }

    /// Whether a span holds a b, whole turns aside.
    fn holds(&self, [low, high]: [f64; 2], b: f64) -> bool {
        (b - low).rem_euclid(self.period()) <= high - low
    }

    /// The spans of b that reach p with these joints held.
    fn spans(&self, p: Vector, held: &PerDrive, mut take: impl FnMut([f64; 2])) {
        if let Some((map, shift)) = self.three(held) {
            map.spans(p, |[low, high]| take([low + shift, high + shift]));
        }
    }

    /// Whether any pose is at a distance from B, m, where b goes round without an end: at one b as at any.
    pub(super) fn any_pose(&self, distance: f64, looks: &Looks) -> bool {
        let starts = SAMPLES[usize::from(looks.careful)];
        match self.drives() {
            ..4 => self.is_there(Vector::new(distance, 0.0), 0.0),
            _ if distance <= AT_BASE * self.farthest() => self.is_at_base(starts),
            _ if (0..starts).any(|i| self.comes_to(distance, self.spread(i)).is_some()) => true,
            // On the way from a pose that is farther off to one on B.
            _ => {
                let distance_of = |i: usize| self.place(&DriveAngles(self.unturned(&self.spread(i)))).norm();
                (0..starts).any(|i| distance_of(i) >= distance) && self.is_at_base(starts)
            }
        }
    }

    /// Whether a pose on B is come to from one of so many places: at one b as at any.
    fn is_at_base(&self, starts: usize) -> bool {
        let windows = self.windows();
        let leads = |a: &PerDrive| self.solved(Vector::default(), 0.0, a, &windows).is_some();
        (0..starts)
            .map(|i| self.spread(i))
            .any(|a| leads(&a) || self.comes_to(NEAR_BASE * self.farthest(), a).is_some_and(|near| leads(&near)))
    }

    /// Whether a pose at a point and b is come to from somewhere.
    fn is_solved(&self, p: Vector, b: f64) -> bool {
        let mut any = false;
        self.each_spread(p, b, &mut |_| {
            any = true;
            false
        });
        any
    }

    /// A pose at a distance from B, m, if joints that turn one after another, each as far as brings the end effector nearest
    /// to it, come to one.
    fn comes_to(&self, distance: f64, mut a: PerDrive) -> Option<PerDrive> {
        let far = self.farthest();
        let at = |a: &PerDrive| self.place(&DriveAngles(self.unturned(a)));
        let mut missing = f64::INFINITY;
        for _ in 0..MAX_SWEEPS {
            let before = missing;
            for i in 0..a.len() {
                let own = a[i];
                let here = at(&a);
                a[i] = own + PI;
                let there = at(&a);
                // It turns one part about the other.
                let (still, turning) = (0.5 * (here + there), 0.5 * (here - there));
                let [low, high] = self.joints[i].limits;
                let apart = (turning * still.conj()).arg();
                let sense = self.joints[i].sense;
                let [from, to] = [low, high].map(|end| apart + sense * (end - own));
                let (from, to) = (from.min(to), from.max(to));
                // Angles between the two parts: where they are in line, or at the ends.
                let inside = |line: f64| Some(line + ((from - line) / TAU).ceil() * TAU).filter(|x| *x <= to);
                let length = |angle: f64| (still + turning * unit(angle - apart)).norm();
                let ends = if length(from) < length(to) { [from, to] } else { [to, from] };
                let [least, most] = [inside(PI).unwrap_or(ends[0]), inside(0.0).unwrap_or(ends[1])];
                let lengths = [length(least), length(most)];
                if lengths[0] <= distance && distance <= lengths[1] {
                    let sizes = [still.norm(), turning.norm()];
                    let square = distance * distance - sizes[0] * sizes[0] - sizes[1] * sizes[1];
                    let bend = (square / (2.0 * sizes[0] * sizes[1])).clamp(-1.0, 1.0).acos();
                    // The nearest one in the range; rounding may leave none.
                    let both = [bend, -bend].map(|line| line + ((from - line) / TAU).ceil() * TAU);
                    let there = both
                        .into_iter()
                        .filter(|x| *x <= to)
                        .min_by(|x, y| (x - apart).abs().total_cmp(&(y - apart).abs()))?;
                    a[i] = (own + sense * (there - apart)).clamp(low, high);
                    return Some(a);
                }
                let best = if distance < lengths[0] { least } else { most };
                a[i] = (own + sense * (best - apart)).clamp(low, high);
                missing = (length(best) - distance).abs();
            }
            if before - missing <= NO_TURN_SHARE * far {
                break;
            }
        }
        None
    }

    /// Up to three drives.
    fn is_there(&self, p: Vector, b: f64) -> bool {
        let mut any = false;
        self.each_pose(p, b, &mut |_| {
            any = true;
            false
        });
        any
    }

    /// The plane of the first two joints, with all others held, and what its b lacks.
    pub(super) fn three(&self, held: &PerDrive) -> Option<(PlaneMap, f64)> {
        let n = self.drives();
        let (mut of, mut delta, mut count) = ([0; MAX_DRIVES], [0.0; MAX_DRIVES], 1);
        for (i, joint) in self.joints.iter().enumerate() {
            let [near, far] = joint.ends;
            if i < 2 {
                of[far] = count;
                count += 1;
            } else {
                of[far] = of[near];
                delta[far] = delta[near] + joint.sense * (held[i] - joint.offset);
            }
        }
        let (mut arm, mut lambda) = ([Vector::default(); 3], [0.0; 3]);
        for k in 0..n {
            arm[of[k]] += self.tip[k] * unit(delta[k]);
            lambda[of[k]] += self.lambda[k];
        }
        let lean = arm.map(|l| l.arg());
        let angle = |i: usize| {
            let joint = &self.joints[i];
            let [near, far] = joint.ends;
            let (to, from) = if joint.sense > 0.0 { (far, near) } else { (near, far) };
            let at = |k: usize| delta[k] - lean[of[k]];
            AngleDefinition { to: of[to], from: of[from], offset: joint.offset + at(to) - at(from) }
        };
        let limit = |i: usize| AngleLimit { min: self.joints[i].limits[0], max: self.joints[i].limits[1] };
        let map = PlaneMap::new(arm.map(|l| l.norm()), lambda, [angle(0), angle(1)], [limit(0), limit(1)]).ok()?;
        // b = Σ Λ (Q' − lean) + Σ λ δ.
        let shift =
            (0..n).map(|k| self.lambda[k] * delta[k]).sum::<f64>() - (0..3).map(|i| lambda[i] * lean[i]).sum::<f64>();
        Some((map, shift))
    }
}
