//! The convex program of the least reaction: the course of b within a corridor with the least ∫ b″² or the least
//! maximum of |b″|.
//!
//! b″ is linear between evenly spaced nodes. b and b′ of the nodes are unknowns too; exact integration gives equality
//! constraints.

use crate::off_plane::b_course::BCourse;
use crate::off_plane::corridor::{Corridor, Station};
use crate::reactionless::LIMIT_SLACK;
use stillbase_convex::{LinearRow, Program};

/// Number of stations of the corridor in each piece.
pub(super) const PIECE_STATIONS: usize = 8;
/// Stride of the stations in programs of which only the minimum is needed, not the course.
const STRIDE_FOR_VALUE: usize = 2;
/// Margin between b and the corridor's bounds, rad; at most a tenth of its width. It avoids folds, where joint rates
/// are infinite.
const MARGIN_RAD: f64 = 1e-3;
/// The margin is reduced until it raises the objective by at most this fraction.
const MARGIN_COST: f64 = 4e-3;
/// Margin that is always kept, against rounding, rad.
const MIN_MARGIN_RAD: f64 = 1e-8;
/// If the start or the end lies within the margin, the margin is reduced there and grows over this fraction of the
/// motion.
const GROWTH_SHARE: f64 = 0.1;
/// Maximum number of times that the bounds are tightened because the course leaves the corridor between stations.
const MAX_TIGHTENINGS: usize = 4;
/// Fraction of the least peak by which the smoothest course may exceed it.
const SMOOTHING_COST: f64 = 1e-7;

/// Lower and upper bound of b − b_0 at each station, rad, with b_0 at the start. Additional stations come last.
type Bounds = Vec<[f64; 2]>;

/// Finds the course of least ∫ b″² du, or of least peak |b″| if `peak`. It stays within the corridor at every station
/// and, to second order, between stations. Each of the `spaces` pieces has [`PIECE_STATIONS`] stations. The margin
/// may cost `ease` times [`MARGIN_COST`]. An error gives the reason in words.
pub(super) fn least_course(
    corridor: &Corridor,
    end: Option<f64>,
    peak: bool,
    spaces: usize,
    ease: f64,
) -> Result<BCourse, String> {
    let value = |share: f64| value(corridor, &bounds(corridor, end, share, 0.0), end, peak, spaces);
    // The minimum is convex in the fraction of the margin, so a chord bounds the cost of a fraction from above.
    let free = value(0.0)?;
    let mut shares = match value(1.0) {
        Ok(wide) if wide - free <= ease * MARGIN_COST * free => vec![1.0],
        Ok(wide) => vec![ease * MARGIN_COST * free / (wide - free)],
        Err(_) => vec![0.3, 0.1, 0.03, 0.01],
    };
    shares.push(0.0);
    let mut why = String::new();
    for share in shares {
        match kept_within(corridor, end, peak, spaces, share) {
            Ok(course) => return Ok(course),
            Err(word) => why = word,
        }
    }
    Err(why)
}

fn kept_within(
    corridor: &Corridor,
    end: Option<f64>,
    peak: bool,
    spaces: usize,
    share: f64,
) -> Result<BCourse, String> {
    let mut extra = 0.0;
    let mut rounds = 0;
    loop {
        let course = solved(corridor, &bounds(corridor, end, share, extra), end, peak, spaces)?;
        let past = excess(corridor, &course);
        if past <= LIMIT_SLACK {
            return Ok(course);
        }
        rounds += 1;
        if rounds > MAX_TIGHTENINGS {
            return Err(format!("{past:.1e} rad outside its bounds"));
        }
        extra += 2.0 * past;
    }
}

/// Returns the maximum distance of a course beyond the bounds of its corridor, at stations and halfway between them,
/// rad.
fn excess(corridor: &Corridor, course: &BCourse) -> f64 {
    let stations = corridor.stations();
    let at = stations.iter().chain(corridor.extra_stations()).map(|s| {
        let b = course.at(s.u)[0];
        (s.low - b).max(b - s.high)
    });
    let between = stations.windows(2).enumerate().map(|(k, w)| {
        let b = course.at(0.5 * (w[0].u + w[1].u))[0];
        let side = |side: usize, ends: [f64; 2]| {
            let bulges = [k, k + 1].map(|k| bulge(corridor, k, side));
            // Interpolation across a jump of the corridor is meaningless.
            let [Some(i), Some(j)] = bulges else { return f64::NEG_INFINITY };
            let sense = [1.0, -1.0][side];
            sense * (0.5 * (ends[0] + ends[1]) - b) + i.min(j)
        };
        side(0, [w[0].low, w[1].low]).max(side(1, [w[0].high, w[1].high]))
    });
    at.chain(between).fold(0.0, f64::max)
}

/// Estimates from second differences how far, rad, a bound of the corridor lies inside its linear interpolation
/// halfway to the next station. Returns `None` at a jump, such as where another limit becomes active.
fn bulge(corridor: &Corridor, k: usize, side: usize) -> Option<f64> {
    let stations = corridor.stations();
    let bound = |k: usize| [stations[k].low, stations[k].high][side];
    let second = |k: usize| {
        let k = k.clamp(1, stations.len().max(3) - 2);
        let bend = (2.0 * bound(k) - bound(k - 1) - bound((k + 1).min(stations.len() - 1))) / 8.0;
        if bend.is_finite() { bend } else { 0.0 }
    };
    let (here, beside) = (second(k), second(k.saturating_sub(2)).abs().max(second(k + 2).abs()));
    let smooth = here.abs() <= 8.0 * beside + MIN_MARGIN_RAD;
    smooth.then(|| ([1.0, -1.0][side] * here).max(0.0))
}

/// Solves for the course. The unknowns b − b_0, b′, b″ of each node are adjacent, so that the matrix is banded.
fn solved(
    corridor: &Corridor,
    bounds: &Bounds,
    end: Option<f64>,
    peak: bool,
    spaces: usize,
) -> Result<BCourse, String> {
    let mut least = program(corridor, bounds, end, spaces, 1, 0);
    if peak {
        // First minimise the peak alone, then ∫ b″² at that peak.
        let bound = least_peak(corridor, bounds, end, spaces, 1)? * (1.0 + SMOOTHING_COST);
        for i in 0..=spaces {
            least.at_most.push(LinearRow::new([(3 * i + 2, 1.0)], bound));
            least.at_most.push(LinearRow::new([(3 * i + 2, -1.0)], bound));
        }
    }
    let x = solution(&squared(least, spaces))?;
    let second = (0..=spaces).map(|i| x[3 * i + 2]).collect();
    Ok(BCourse::integrated(corridor.start().b, second, end))
}

/// Returns the least value of the objective, rad: the root of ∫ b″² du, or the peak of |b″|.
fn value(corridor: &Corridor, bounds: &Bounds, end: Option<f64>, peak: bool, spaces: usize) -> Result<f64, String> {
    if peak {
        return least_peak(corridor, bounds, end, spaces, STRIDE_FOR_VALUE);
    }
    let x = solution(&squared(program(corridor, bounds, end, spaces, STRIDE_FOR_VALUE, 0), spaces))?;
    let square = |i: usize| {
        let (x, y) = (x[3 * i + 2], x[3 * i + 5]);
        (x * x + x * y + y * y) / (3.0 * spaces as f64)
    };
    Ok((0..spaces).map(square).sum::<f64>().sqrt())
}

/// Returns the least peak of |b″|, rad, from a linear program with the peak as an additional unknown.
fn least_peak(
    corridor: &Corridor,
    bounds: &Bounds,
    end: Option<f64>,
    spaces: usize,
    every: usize,
) -> Result<f64, String> {
    let top = 3 * (spaces + 1);
    let mut linear = program(corridor, bounds, end, spaces, every, 1);
    linear.linear[top] = 1.0;
    for i in 0..=spaces {
        linear.at_most.push(LinearRow::new([(3 * i + 2, 1.0), (top, -1.0)], 0.0));
        linear.at_most.push(LinearRow::new([(3 * i + 2, -1.0), (top, -1.0)], 0.0));
    }
    Ok(solution(&linear)?[top].max(0.0))
}

fn solution(program: &Program) -> Result<Vec<f64>, String> {
    program.solve().map(|least| least.x).map_err(|why| why.to_string())
}

/// Adds the objective ∫ b″² du to a program.
fn squared(mut program: Program, spaces: usize) -> Program {
    let third = 1.0 / (3.0 * spaces as f64);
    for i in 0..spaces {
        let (x, y) = (3 * i + 2, 3 * i + 5);
        program.add_product(x, x, third);
        program.add_product(x, y, third);
        program.add_product(y, y, third);
    }
    program
}

/// Builds the constraints of a course, with `more` additional unknowns at the end. Bounds apply at every `every`th
/// evenly spaced station and at all additional stations.
fn program(
    corridor: &Corridor,
    bounds: &Bounds,
    end: Option<f64>,
    spaces: usize,
    every: usize,
    more: usize,
) -> Program {
    let start = corridor.start().b;
    let h = 1.0 / spaces as f64;
    let mut program = Program::over(3 * (spaces + 1) + more);
    program.equal.push(LinearRow::new([(0, 1.0)], 0.0));
    program.equal.push(LinearRow::new([(1, 1.0)], 0.0));
    program.equal.push(LinearRow::new([(3 * spaces + 1, 1.0)], 0.0));
    if let Some(end) = end {
        program.equal.push(LinearRow::new([(3 * spaces, 1.0)], end - start));
    }
    for i in 0..spaces {
        let [b, v, w] = [3 * i, 3 * i + 1, 3 * i + 2];
        program.equal.push(LinearRow::new([(v + 3, 1.0), (v, -1.0), (w, -h / 2.0), (w + 3, -h / 2.0)], 0.0));
        program
            .equal
            .push(LinearRow::new([(b + 3, 1.0), (b, -1.0), (v, -h), (w, -h * h / 3.0), (w + 3, -h * h / 6.0)], 0.0));
    }
    let even = corridor.stations().len();
    let besides = corridor.extra_stations().iter().map(|s| s.u * (even - 1) as f64).zip(&bounds[even..]);
    let stations = bounds[..even].iter().enumerate().skip(every).step_by(every).map(|(k, pair)| (k as f64, pair));
    for (k, [low, high]) in stations.chain(besides) {
        let place = k / PIECE_STATIONS as f64;
        let i = (place as usize).min(spaces - 1);
        let d = (place - i as f64) * h;
        let cubic = d * d * d / (6.0 * h);
        let [b, v, w] = [3 * i, 3 * i + 1, 3 * i + 2];
        let row = |s: f64| [(b, s), (v, s * d), (w, s * (d * d / 2.0 - cubic)), (w + 3, s * cubic)];
        if k + 1.0 < even as f64 || end.is_none() {
            let bounds = [(1.0, *high), (-1.0, -low)].into_iter().filter(|(_, right)| right.is_finite());
            program.at_most.extend(bounds.map(|(s, right)| LinearRow::new(row(s), right)));
        }
    }
    program
}

/// Returns the bounds of b − b_0, rad: the corridor reduced by `share` of the margin, by `extra`, rad, and by its
/// bulge between stations. If the start or a given end of the course lies within the margin, the margin is reduced
/// there.
fn bounds(corridor: &Corridor, end: Option<f64>, share: f64, extra: f64) -> Bounds {
    let stations = corridor.stations();
    let (first, last) = (&stations[0], &stations[stations.len() - 1]);
    let (b_0, b_1) = (corridor.start().b, end.unwrap_or(0.0));
    let bounds_at = |station: &Station, bulges: [f64; 2]| {
        let tenth = 0.1 * (station.high - station.low);
        let inset = |side: usize, gap: [f64; 2]| {
            let whole = share * MARGIN_RAD.min(tenth) + (bulges[side] + MIN_MARGIN_RAD + extra).min(tenth);
            let from = |gap: f64, u: f64| whole.min(gap.max(0.0) + whole * (u / GROWTH_SHARE).powi(3));
            from(gap[0], station.u).min(if end.is_some() { from(gap[1], 1.0 - station.u) } else { whole })
        };
        [
            station.low + inset(0, [b_0 - first.low, b_1 - last.low]) - b_0,
            station.high - inset(1, [first.high - b_0, last.high - b_1]) - b_0,
        ]
    };
    let even = stations.iter().enumerate().map(|(k, station)| {
        let bulges = [0, 1].map(|side| bulge(corridor, k, side).unwrap_or(0.0));
        bounds_at(station, bulges)
    });
    even.chain(corridor.extra_stations().iter().map(|station| bounds_at(station, [0.0; 2]))).collect()
}
