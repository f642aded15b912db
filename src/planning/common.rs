//! Which b serve several points at once, and where none does, the point that has to move least: one way for any number
//! of drives.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | p = r e^{iθ} | a point, r from the base pin | m |
//! | B(r) | the b that reach (r, 0) | rad |
//! | S | the b that serve all other points | rad |
//!
//! # Method
//! Turning the machine as a whole turns b along: p is reached at the b of B(r) + θ Σλ. The least move of p to a place
//! that some b of S reaches is therefore a search over the distance r' alone. At each r' the least turn Δθ is the
//! distance of B(r') + θ Σλ from S on the circle of b, divided by Σλ, and the move is r² + r'² − 2 r r' cos Δθ, squared.

use crate::mechanics::planar::{Vector, unit};
use crate::planning::golden::golden;
use crate::planning::pose_space::PoseSpace;
use crate::planning::reactionless::{BSet, Decimal, NoReach};
use crate::planning::unreachable::{Mend, NoCommon, ShownMend, Unreachable};

/// Distances that are tried between the least and the greatest one.
const TRIES: usize = 96;
/// Of the distances that were tried, how many are refined, and by how many golden sections.
const REFINED: usize = 3;
const SECTIONS: usize = 40;

/// By how much longer moves are tried than the least one, shares of it.
const LONGER_BY: [f64; 10] = [0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4, 1e-2, 0.05];

/// The b that reach a point, single ones with their slack.
fn set_of(space: &PoseSpace, p: Vector) -> Result<BSet, NoReach> {
    Ok(slackened(space, space.reach(p)?))
}

fn slackened(space: &PoseSpace, mut set: BSet) -> BSet {
    let slack = space.b_slack();
    set.intervals.iter_mut().for_each(|[low, high]| (*low, *high) = (*low - slack, *high + slack));
    set
}

/// The b that serve all points, m; `None` if none does.
pub fn common(space: &PoseSpace, points: &[Vector]) -> Option<BSet> {
    if let [point] = points {
        return space.reach(*point).ok();
    }
    let sets: Option<Vec<BSet>> = points.iter().map(|p| set_of(space, *p).ok()).collect();
    Some(BSet::overlap(&sets?)).filter(|common| !common.is_empty())
}

/// The middle of the widest range of b that serve all points, rad: as far from every end as it gets.
pub fn middle(space: &PoseSpace, points: &[Vector]) -> Option<f64> {
    let ranges = common(space, points)?.intervals.into_iter();
    let widest = ranges.max_by(|x, y| (x[1] - x[0]).total_cmp(&(y[1] - y[0])))?;
    Some(0.5 * (widest[0] + widest[1]))
}

/// The b, rad, from which to start a motion through points: the middle of what serves all, or else the first.
pub fn starting_b(space: &PoseSpace, points: &[Vector]) -> Option<f64> {
    middle(space, points).or_else(|| middle(space, points.get(..1)?))
}

/// Why points have no b in common; `None` if some b serves all, or a point is out of every reach.
pub fn no_common(space: &PoseSpace, points: &[Vector]) -> Option<NoCommon> {
    let sets: Vec<BSet> = points.iter().map(|p| set_of(space, *p).ok()).collect::<Option<_>>()?;
    if !BSet::overlap(&sets).is_empty() {
        return None;
    }
    let apart = |&[i, j]: &[usize; 2]| BSet::overlap(&[sets[i].clone(), sets[j].clone()]).is_empty();
    let pair = (0..points.len()).flat_map(|i| (i + 1..points.len()).map(move |j| [i, j])).find(apart);
    let others = |i: usize| {
        let rest: Vec<BSet> = sets.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, s)| s.clone()).collect();
        BSet::overlap(&rest)
    };
    let mends = (0..points.len()).filter_map(|i| least_move(space, points[i], i, &others(i)));
    let least = mends.min_by(|x, y| x.distance.total_cmp(&y.distance));
    Some(NoCommon { pair, mend: least.and_then(|mend| proved(space, points, &others(mend.point), mend)) })
}

/// Which of some points that are to share a b cannot be reached at it, and why; `None` if all can. A point that no b
/// reaches comes first, as it says more than one that wants another b.
pub fn unreached(space: &PoseSpace, points: &[Vector], b: f64) -> Option<(usize, Unreachable)> {
    let i = points.iter().position(|p| !space.reaches(*p, b))?;
    let i = points.iter().position(|p| space.reach(*p).is_err()).unwrap_or(i);
    Some((i, why_not(space, points, i, b)))
}

/// Why a point of some that are to share a b cannot be reached at it, and what would do for all of them.
pub fn why_not(space: &PoseSpace, points: &[Vector], i: usize, b: f64) -> Unreachable {
    let (x, y) = (points[i].re, points[i].im);
    let own = match set_of(space, points[i]) {
        Ok(own) => own,
        Err(reason) => return Unreachable::Anywhere { x, y, reason },
    };
    match (common(space, points), no_common(space, points)) {
        (Some(common), _) => {
            let serves = |b: f64| points.iter().all(|p| space.reaches(*p, b));
            let nearest = common.nearest(b);
            let inner = [1e-6, 1e-3, 0.5].map(|share| nearest.map(|b| common.inwards(b, share)));
            let nearest_b = inner.into_iter().flatten().find(|b| serves(*b));
            let shown_b = nearest_b.and_then(|b| Decimal::that(b, 4, serves));
            Unreachable::OnThisPlane { x, y, b, would_do: common.in_words(), nearest_b, shown_b }
        }
        (None, Some(why)) => Unreachable::NoCommonPlane(why),
        // Another point is out of every reach.
        (None, None) => Unreachable::OnThisPlane { x, y, b, would_do: own.in_words(), nearest_b: None, shown_b: None },
    }
}

/// The shift of a set along the circle, by the shorter way, after which it touches another one, rad.
fn shift(set: &BSet, onto: &BSet) -> Option<f64> {
    let period = set.period;
    let each = |[low, high]: &[f64; 2], [from, to]: &[f64; 2]| {
        let past = (from - low).rem_euclid(period);
        let (up, down) = ((past - (high - low)).max(0.0), (period - past - (to - from)).max(0.0));
        if up <= down { up } else { -down }
    };
    let all = set.intervals.iter().flat_map(|own| onto.intervals.iter().map(move |other| each(own, other)));
    all.min_by(|x, y| x.abs().total_cmp(&y.abs()))
}

/// The nearest place to p that some b of a set reaches, m.
fn least_move(space: &PoseSpace, p: Vector, point: usize, others: &BSet) -> Option<Mend> {
    if others.is_empty() {
        return None;
    }
    let (r, theta, sum) = (p.norm(), p.arg(), space.lambda_sum());
    let (near, far) = (space.nearest(), space.farthest());
    // How far the move to a distance goes, m, and by what angle, for the b that reach (distance, 0).
    let by = |distance: f64, set: Result<BSet, NoReach>| -> (f64, f64) {
        let turned = |set: BSet| BSet {
            intervals: set.intervals.iter().map(|[low, high]| [low + theta * sum, high + theta * sum]).collect(),
            ..set
        };
        let set = set.ok().map(|set| turned(slackened(space, set)));
        match set.and_then(|set| shift(&set, others)) {
            Some(shift) => {
                let half = (0.5 * shift / sum).sin();
                (((distance - r).powi(2) + 4.0 * r * distance * half * half).sqrt(), shift / sum)
            }
            None => (f64::INFINITY, 0.0),
        }
    };
    let to = |distance: f64| by(distance, space.reach(Vector::new(distance, 0.0)));
    let step = (far - near) / TRIES as f64;
    let mut tries: Vec<f64> = (0..=TRIES).map(|i| near + step * i as f64).chain([r.clamp(near, far)]).collect();
    tries.sort_by(|x, y| (x - r).abs().total_cmp(&(y - r).abs()));
    // No move is shorter than the difference of the distances.
    let mut tried: Vec<(f64, f64)> = Vec::with_capacity(tries.len());
    let mut best = f64::INFINITY;
    for distance in tries {
        if (distance - r).abs() > best + step {
            break;
        }
        let (gap, _) = by(distance, space.reach_with(Vector::new(distance, 0.0), false));
        tried.push((gap, distance));
        best = best.min(gap);
    }
    tried.retain(|(gap, _)| gap.is_finite());
    tried.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for (gap, distance) in tried {
        if kept.len() < REFINED && kept.iter().all(|(_, known)| (known - distance).abs() > 1.5 * step) {
            kept.push((gap, distance));
        }
    }
    let refined = kept.into_iter().map(|(gap, distance)| {
        let (better, least) = golden([(distance - step).max(near), (distance + step).min(far)], SECTIONS, |x| to(x).0);
        if least < gap { (least, better) } else { (gap, distance) }
    });
    let (_, distance) = refined.min_by(|x, y| x.0.total_cmp(&y.0))?;
    // Rounding may part what just touches, as where the curve of two drives ends: then a little beside it.
    let beside = [0.0, 1e-12, 1e-10, 1e-8, 1e-6].into_iter().flat_map(|share| [share * far, -share * far]);
    let mut touching = beside.filter_map(|beside| {
        let distance = (distance + beside).clamp(near, far);
        let (_, turn) = to(distance);
        let at = unit(theta + turn + turn.signum() * 0.25 * space.b_slack() / sum) * distance;
        let shared = BSet::overlap(&[others.clone(), set_of(space, at).ok()?]);
        let [low, high] = shared.intervals.first()?;
        Some((at, 0.5 * (low + high)))
    });
    let (at, b) = match touching.next() {
        Some(found) => found,
        None => {
            let at = unit(theta + to(distance).1) * distance;
            (at, others.nearest(set_of(space, at).ok()?.intervals.first()?[0])?)
        }
    };
    Some(Mend { point, to: at, distance: (at - p).norm(), b, shown: None })
}

/// A move that rounding does not take away: a hair further where the end of it misses, and the same to be printed; `None`
/// if no pose was found there.
fn proved(space: &PoseSpace, points: &[Vector], others: &BSet, mend: Mend) -> Option<Mend> {
    let from = points[mend.point];
    let shared = |to: Vector| {
        let set = BSet::overlap(&[others.clone(), set_of(space, to).ok()?]).near(mend.b);
        let gap = |[low, high]: &[f64; 2]| (mend.b - 0.5 * (low + high)).abs();
        set.intervals.into_iter().min_by(|x, y| gap(x).total_cmp(&gap(y)))
    };
    let serves = |to: Vector, b: f64| {
        let at = |(i, p): (usize, &Vector)| if i == mend.point { to } else { *p };
        points.iter().enumerate().map(at).all(|p| space.reaches(p, b))
    };
    let exact = LONGER_BY.into_iter().find_map(|share| {
        let to = from + (1.0 + share) * (mend.to - from);
        let [low, high] = shared(to)?;
        [mend.b, 0.5 * (low + high)].into_iter().find(|b| serves(to, *b)).map(|b| (to, b))
    });
    // Where no number beside the least move serves, a longer one may.
    let all = [1.02, 1.1].into_iter().flat_map(|longest| (3..=12).map(move |decimals| (longest, decimals)));
    let shown = all.into_iter().find_map(|(longest, decimals)| {
        // All numbers near by with so many decimals, the least move first.
        let [x, y] = [mend.to.re, mend.to.im].map(|x| Decimal::nearest(x, decimals));
        let mut around: Vec<([Decimal; 2], f64)> = (-2..=2)
            .flat_map(|i| (-2..=2).map(move |j| [x.stepped(i), y.stepped(j)]))
            .map(|to| (to, (Vector::new(to[0].value(), to[1].value()) - from).norm()))
            .collect();
        around.retain(|(_, far)| *far <= longest * mend.distance || decimals > 8);
        around.sort_by(|a, b| a.1.total_cmp(&b.1));
        around.into_iter().find_map(|(to, far)| {
            let at = Vector::new(to[0].value(), to[1].value());
            let [low, high] = shared(at)?;
            let b = mend.b.clamp(low, high);
            let inside = |x: f64| low <= x && x <= high && serves(at, x);
            // Where the common b are few, the middle of them has more room than their end.
            let b = [b, 0.5 * (low + high)].into_iter().filter_map(|b| Decimal::that(b, 4, inside));
            let b = b.min_by_key(Decimal::decimals).filter(|b| b.decimals() <= decimals + 4)?;
            Some(ShownMend { to, b, far, does: true })
        })
    });
    match (exact, shown) {
        (Some((to, b)), shown) => Some(Mend { to, distance: (to - from).norm(), b, shown, ..mend }),
        (None, Some(own)) => Some(Mend { to: own.point(), distance: own.far, b: own.b.value(), shown, ..mend }),
        (None, None) => None,
    }
}
