//! Whether any pose is at a distance from B between two critical values of b: a quick look over the last joints, with the
//! three arms that are left in closed form.

use super::space::PoseSpace;
use crate::mechanics::planar::{MAX_DRIVES, PerDrive, Vector, unit};
use crate::planning::reactionless::{AngleDefinition, AngleLimit, PlaneMap};

/// Looks over the range of the joints that are left free, for one, two, three and more of them.
const LOOKS: [usize; 5] = [33, 13, 7, 5, 3];
/// From how many of these the nearest place is gone to where none will do, how often in each direction.
const STARTS: usize = 4;
const SWEEPS: usize = 3;
/// How fast b's ends go with an angle at most, for a look to be worth it.
const FAR: f64 = 4.0;

/// What reaches a point with the last joints held at each place of a grid: the same for every b, so it is looked up once.
#[derive(Default)]
pub(super) struct Looks {
    /// Spans of b, rad, and where those of each look end.
    spans: Vec<[f64; 2]>,
    ends: Vec<usize>,
    /// Of the b that are asked for: how far each look is off them, rad, and which lead anywhere.
    offs: Vec<f64>,
    order: Vec<usize>,
}

impl Looks {
    /// For another point.
    pub fn clear(&mut self) {
        self.spans.clear();
        self.ends.clear();
    }
}

impl PoseSpace {
    /// Whether some pose is on the x axis at a distance from B, m, at one of these b.
    pub(super) fn has_pose(&self, distance: f64, b: &[f64], looks: &mut Looks) -> bool {
        let p = Vector::new(distance, 0.0);
        if self.drives() > 3 {
            return self.held_for(p, b, looks).is_some();
        }
        let mut any = false;
        for b in b {
            self.each_pose(p, *b, &mut |_| {
                any = true;
                false
            });
        }
        any
    }

    /// Angles of the joints that are held, more than three drives, with which the three arms that are left reach p at b:
    /// where no look finds any, by going to where they come nearest. What lies at the first two joints is not used.
    fn held_for(&self, p: Vector, b: &[f64], looks: &mut Looks) -> Option<PerDrive> {
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
        let count = each.pow((n - first) as u32);
        looks.offs.clear();
        for code in 0..count {
            if code == looks.ends.len() {
                self.spans(p, &look(code), |span| looks.spans.push(span));
                looks.ends.push(looks.spans.len());
            }
            let from = if code > 0 { looks.ends[code - 1] } else { 0 };
            let of = &looks.spans[from..looks.ends[code]];
            let off = of.iter().fold(f64::INFINITY, |off, span| off.min(self.gap(*span, b)));
            if off == 0.0 {
                return Some(look(code));
            }
            looks.offs.push(off);
        }
        // Where it is much farther than the looks are apart, it does not come near between them. Along a single joint
        // only looks that are nearer than those beside them lead anywhere.
        let apart = (first..n).map(|i| at(i, 1) - at(i, 0)).fold(0.0, f64::max);
        let Looks { offs, order, .. } = looks;
        let beside = |i: usize, j: Option<usize>| j.and_then(|j| offs.get(j)).is_none_or(|other| offs[i] <= *other);
        let leads = |i: usize| n - first > 1 || (beside(i, i.checked_sub(1)) && beside(i, Some(i + 1)));
        order.clear();
        order.extend((0..count).filter(|i| offs[*i] <= FAR * apart && leads(*i)));
        order.sort_unstable_by(|x, y| offs[*x].total_cmp(&offs[*y]).then(x.cmp(y)));
        for code in order.iter().take(STARTS) {
            let (mut best, mut held) = (offs[*code], look(*code));
            for _ in 0..if n - first > 1 { SWEEPS } else { 1 } {
                let before = best;
                for i in first..n {
                    let [low, high] = self.joints[i].limits;
                    let step = (high - low) / each as f64;
                    let on = |x: f64| {
                        let mut there = held;
                        there[i] = x;
                        (self.off(p, b, &there), there)
                    };
                    let found = lowest(on, [(held[i] - step).max(low), (held[i] + step).min(high)]);
                    if found.0 < best {
                        (best, held) = found;
                    }
                    if best == 0.0 {
                        return Some(held);
                    }
                }
                if best >= before {
                    break;
                }
            }
        }
        None
    }

    /// How far the nearest b is from what reaches p with these joints held, rad; infinite where nothing does.
    fn off(&self, p: Vector, b: &[f64], held: &PerDrive) -> f64 {
        let mut off = f64::INFINITY;
        self.spans(p, held, |span| off = off.min(self.gap(span, b)));
        off
    }

    /// How far the nearest b is from a span, by the shorter way round, rad.
    fn gap(&self, [low, high]: [f64; 2], b: &[f64]) -> f64 {
        let period = self.period();
        let gap = |b: &f64| {
            let past = (b - low) - period * ((b - low) / period).floor();
            (past - (high - low)).max(0.0).min(period - past)
        };
        b.iter().map(gap).fold(f64::INFINITY, f64::min)
    }

    /// The spans of b that reach p with these joints held.
    fn spans(&self, p: Vector, held: &PerDrive, mut take: impl FnMut([f64; 2])) {
        if let Some((map, shift)) = self.three(held) {
            map.spans(p, |[low, high]| take([low + shift, high + shift]));
        }
    }

    /// Whether any pose is at a distance from B, m.
    pub(super) fn any_pose(&self, distance: f64) -> bool {
        self.has_pose(distance, &[0.0], &mut Looks::default())
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

/// The least of a function between two places by golden sections, or the first place at which it is 0; only as near as
/// it takes to know that it does not come to 0.
fn lowest<T: Copy>(f: impl Fn(f64) -> (f64, T), [mut low, mut high]: [f64; 2]) -> (f64, T) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut x, mut y) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut fx, mut fy) = (f(x), f(y));
    for _ in 0..16 {
        // Nor does it come to 0 from farther than this.
        if fx.0 == 0.0 || fy.0 == 0.0 || fx.0.min(fy.0) > FAR * (high - low) {
            break;
        }
        if fx.0 < fy.0 {
            (high, y, fy) = (y, x, fx);
            x = high - GOLDEN * (high - low);
            fx = f(x);
        } else {
            (low, x, fx) = (x, y, fy);
            y = low + GOLDEN * (high - low);
            fy = f(y);
        }
    }
    if fx.0 < fy.0 { fx } else { fy }
}
