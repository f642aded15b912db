//! The pose constants b at which several points can all be reached. If there is none, the shortest move of one point
//! that creates one. One method serves any number of drives.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | p = r e^{iθ} | a point, at distance r from the base pin | m |
//! | B(r) | the set of b at which (r, 0) can be reached | rad |
//! | S | the set of b at which all other points can be reached | rad |
//!
//! # Method
//! Turning the machine as a whole by θ adds θ Σλ to b: p can be reached at the b of B(r) + θ Σλ. The shortest move of p
//! to a place that can be reached at some b of S is therefore a one-dimensional search over the new distance r'. At
//! each r' the smallest turn |Δθ| is the distance between B(r') + θ Σλ and S on the circle of b, divided by Σλ. The
//! length of the move is √(r² + r'² − 2 r r' cos Δθ).

use crate::golden::golden;
use crate::pose_space::PoseSpace;
use crate::reactionless::{BSet, Decimal, NoReach};
use crate::unreachable::{NoCommonB, PointCorrection, RoundedCorrection, Unreachable};
use stillbase_mechanics::planar::{Vector, unit};

/// Number of equal steps from the least to the greatest distance r' in the coarse search.
const RADIAL_STEPS: usize = 96;
/// Number of best coarse distances that are refined, and golden sections of each refinement.
const MAX_REFINED: usize = 3;
const GOLDEN_SECTIONS: usize = 40;

/// Fractions by which the shortest move is lengthened, tried in turn until rounding no longer makes it infeasible.
const EXTENSIONS: [f64; 10] = [0.0, 1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4, 1e-2, 0.05];

/// Returns the b at which a point, m, can be reached, each interval widened by [`PoseSpace::b_slack`].
fn set_of(space: &PoseSpace, p: Vector) -> Result<BSet, NoReach> {
    Ok(widened(space, space.reach(p)?))
}

fn widened(space: &PoseSpace, mut set: BSet) -> BSet {
    let slack = space.b_slack();
    set.intervals.iter_mut().for_each(|[low, high]| (*low, *high) = (*low - slack, *high + slack));
    set
}

/// Returns the b at which all points, m, can be reached; for several, widened by `b_slack`. `None` if there are none.
pub fn common_b_set(space: &PoseSpace, points: &[Vector]) -> Option<BSet> {
    if let [point] = points {
        return space.reach(*point).ok();
    }
    let sets: Option<Vec<BSet>> = points.iter().map(|p| set_of(space, *p).ok()).collect();
    Some(BSet::overlap(&sets?)).filter(|common| !common.is_empty())
}

/// Returns the midpoint of the widest interval of b at which all points, m, can be reached, rad.
pub fn middle_b(space: &PoseSpace, points: &[Vector]) -> Option<f64> {
    let ranges = common_b_set(space, points)?.intervals.into_iter();
    let widest = ranges.max_by(|x, y| (x[1] - x[0]).total_cmp(&(y[1] - y[0])))?;
    Some(0.5 * (widest[0] + widest[1]))
}

/// Returns the b, rad, at which to start a motion through points, m: the [midpoint](middle_b) for all of them, or else
/// for the first point alone.
pub fn starting_b(space: &PoseSpace, points: &[Vector]) -> Option<f64> {
    middle_b(space, points).or_else(|| middle_b(space, points.get(..1)?))
}

/// Returns why points, m, have no b in common; `None` if they share one, or if some point cannot be reached at any b.
pub fn no_common(space: &PoseSpace, points: &[Vector]) -> Option<NoCommonB> {
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
    Some(NoCommonB { pair, correction: least.and_then(|mend| made_robust(space, points, &others(mend.point), mend)) })
}

/// Returns the index of a point that cannot be reached at b, and why; `None` if all can. A point that cannot be reached
/// at any b takes precedence over one that only needs another b.
pub fn unreached(space: &PoseSpace, points: &[Vector], b: f64) -> Option<(usize, Unreachable)> {
    let i = points.iter().position(|p| !space.reaches(*p, b))?;
    let i = points.iter().position(|p| space.reach(*p).is_err()).unwrap_or(i);
    Some((i, unreachable_reason(space, points, i, b)))
}

/// Explains why point `i` is out of reach at b, and which b serve all points, or point `i` alone if another has none.
pub fn unreachable_reason(space: &PoseSpace, points: &[Vector], i: usize, b: f64) -> Unreachable {
    let (x, y) = (points[i].re, points[i].im);
    let own = match set_of(space, points[i]) {
        Ok(own) => own,
        Err(reason) => return Unreachable::Anywhere { x, y, reason },
    };
    match (common_b_set(space, points), no_common(space, points)) {
        (Some(common), _) => {
            let serves = |b: f64| points.iter().all(|p| space.reaches(*p, b));
            let nearest = common.nearest(b);
            let inner = [1e-6, 1e-3, 0.5].map(|share| nearest.map(|b| common.moved_inside(b, share)));
            let nearest_b = inner.into_iter().flatten().find(|b| serves(*b));
            let displayed_b = nearest_b.and_then(|b| Decimal::shortest_passing(b, 4, serves));
            Unreachable::OnThisPlane { x, y, b, feasible: common.in_words(), nearest_b, displayed_b }
        }
        (None, Some(why)) => Unreachable::NoCommonPlane(why),
        // Another point cannot be reached at any b.
        (None, None) => {
            Unreachable::OnThisPlane { x, y, b, feasible: own.in_words(), nearest_b: None, displayed_b: None }
        }
    }
}

/// Returns the smallest signed shift of a set along the circle of b after which it touches another set, rad.
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

/// Finds the place nearest to p, m, that can be reached at some b of a set.
fn least_move(space: &PoseSpace, p: Vector, point: usize, others: &BSet) -> Option<PointCorrection> {
    if others.is_empty() {
        return None;
    }
    let (r, theta, sum) = (p.norm(), p.arg(), space.lambda_sum());
    let (near, far) = (space.nearest(), space.farthest());
    // Length, m, and turn, rad, of the shortest move to a point at `distance`; `set` is B(distance).
    let by = |distance: f64, set: Result<BSet, NoReach>| -> (f64, f64) {
        let turned = |set: BSet| BSet {
            intervals: set.intervals.iter().map(|[low, high]| [low + theta * sum, high + theta * sum]).collect(),
            ..set
        };
        let set = set.ok().map(|set| turned(widened(space, set)));
        match set.and_then(|set| shift(&set, others)) {
            Some(shift) => {
                let half = (0.5 * shift / sum).sin();
                (((distance - r).powi(2) + 4.0 * r * distance * half * half).sqrt(), shift / sum)
            }
            None => (f64::INFINITY, 0.0),
        }
    };
    let to = |distance: f64| by(distance, space.reach(Vector::new(distance, 0.0)));
    let step = (far - near) / RADIAL_STEPS as f64;
    let mut tries: Vec<f64> = (0..=RADIAL_STEPS).map(|i| near + step * i as f64).chain([r.clamp(near, far)]).collect();
    tries.sort_by(|x, y| (x - r).abs().total_cmp(&(y - r).abs()));
    // The move is at least as long as the difference of the distances, so the search may stop early.
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
        if kept.len() < MAX_REFINED && kept.iter().all(|(_, known)| (known - distance).abs() > 1.5 * step) {
            kept.push((gap, distance));
        }
    }
    let refined = kept.into_iter().map(|(gap, distance)| {
        let (better, least) =
            golden([(distance - step).max(near), (distance + step).min(far)], GOLDEN_SECTIONS, |x| to(x).0);
        if least < gap { (least, better) } else { (gap, distance) }
    });
    let (_, distance) = refined.min_by(|x, y| x.0.total_cmp(&y.0))?;
    // Rounding may separate sets that just touch, such as at an endpoint of the curve of two drives. So slightly
    // different distances are tried too.
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
    Some(PointCorrection { point, to: at, distance: (at - p).norm(), b, shown: None })
}

/// Makes a move robust against rounding: lengthens it slightly if its end is infeasible, and finds decimals to print.
/// Returns `None` if no pose was found there.
fn made_robust(space: &PoseSpace, points: &[Vector], others: &BSet, mend: PointCorrection) -> Option<PointCorrection> {
    let from = points[mend.point];
    let shared = |to: Vector| {
        let set = BSet::overlap(&[others.clone(), set_of(space, to).ok()?]).shifted_near(mend.b);
        let gap = |[low, high]: &[f64; 2]| (mend.b - 0.5 * (low + high)).abs();
        set.intervals.into_iter().min_by(|x, y| gap(x).total_cmp(&gap(y)))
    };
    let serves = |to: Vector, b: f64| {
        let at = |(i, p): (usize, &Vector)| if i == mend.point { to } else { *p };
        points.iter().enumerate().map(at).all(|p| space.reaches(p, b))
    };
    let exact = EXTENSIONS.into_iter().find_map(|share| {
        let to = from + (1.0 + share) * (mend.to - from);
        let [low, high] = shared(to)?;
        [mend.b, 0.5 * (low + high)].into_iter().find(|b| serves(to, *b)).map(|b| (to, b))
    });
    let shown = first_decimals(from, &mend, |to, length| {
        let at = Vector::new(to[0].value(), to[1].value());
        let [low, high] = shared(at)?;
        let b = mend.b.clamp(low, high);
        let inside = |x: f64| low <= x && x <= high && serves(at, x);
        // If the common interval of b is short, its midpoint allows fewer decimals than its bounds.
        let b = [b, 0.5 * (low + high)].into_iter().filter_map(|b| Decimal::shortest_passing(b, 4, inside));
        let b = b.min_by_key(Decimal::decimals).filter(|b| b.decimals() <= to[0].decimals() + 4)?;
        Some(RoundedCorrection { to, b, length, path_feasible: true })
    });
    match (exact, shown) {
        (Some((to, b)), shown) => Some(PointCorrection { to, distance: (to - from).norm(), b, shown, ..mend }),
        (None, Some(own)) => {
            Some(PointCorrection { to: own.point(), distance: own.length, b: own.b.value(), shown, ..mend })
        }
        (None, None) => None,
    }
}

/// Returns the first answer of a test of rounded places near the end of a move, with few decimals and a short move
/// first. The test gets the place and the length of the move to it, m.
fn first_decimals<T>(from: Vector, mend: &PointCorrection, test: impl Fn([Decimal; 2], f64) -> Option<T>) -> Option<T> {
    // If no decimal near the shortest move is feasible, a longer move may be.
    let all = [1.02, 1.1].into_iter().flat_map(|longest| (3..=12).map(move |decimals| (longest, decimals)));
    all.into_iter().find_map(|(longest, decimals)| {
        // All decimals near the end of the move, the shortest move first.
        let [x, y] = [mend.to.re, mend.to.im].map(|x| Decimal::nearest(x, decimals));
        let mut around: Vec<([Decimal; 2], f64)> = (-2..=2)
            .flat_map(|i| (-2..=2).map(move |j| [x.stepped(i), y.stepped(j)]))
            .map(|to| (to, (Vector::new(to[0].value(), to[1].value()) - from).norm()))
            .collect();
        around.retain(|(_, far)| *far <= longest * mend.distance || decimals > 8);
        around.sort_by(|a, b| a.1.total_cmp(&b.1));
        around.into_iter().find_map(|(to, length)| test(to, length))
    })
}

/// Returns the place nearest to a point, m, that can be reached: at b, rad, or at any b if none is given. The place is
/// rounded so that it can be reached as printed. `None` if none was found.
pub fn nearest_place(space: &PoseSpace, p: Vector, b: Option<f64>) -> Option<[Decimal; 2]> {
    let serves = |to: Vector| match b {
        Some(b) => space.reaches(to, b),
        None => space.reach(to).is_ok(),
    };
    let wanted = match b {
        Some(b) => BSet::union(vec![[b, b]], space.period()),
        None => BSet { intervals: vec![[0.0, space.period()]], period: space.period() },
    };
    let mend = least_move(space, p, 0, &wanted)?;
    first_decimals(p, &mend, |to, _| serves(Vector::new(to[0].value(), to[1].value())).then_some(to))
}

/// Returns the shortest move of point `i`, m, after which it shares a b with all other points; `None` if none was
/// found, or if the others share none.
pub fn nearest_common_place(space: &PoseSpace, points: &[Vector], i: usize) -> Option<PointCorrection> {
    let rest: Vec<BSet> = points
        .iter()
        .enumerate()
        .filter(|(j, _)| *j != i)
        .map(|(_, p)| set_of(space, *p).ok())
        .collect::<Option<_>>()?;
    let others = BSet::overlap(&rest);
    let mend = least_move(space, *points.get(i)?, i, &others)?;
    made_robust(space, points, &others, mend)
}
