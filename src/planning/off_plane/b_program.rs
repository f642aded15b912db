//! The program behind the least reaction: which course of b within a corridor has the least ∫ b″² or the least peak of
//! b″.
//!
//! b″ is linear between even nodes; b and b′ of the nodes are unknowns too, bound together by exact integration.

use crate::convex::{Program, Row};
use crate::planning::off_plane::b_course::BCourse;
use crate::planning::off_plane::corridor::{Corridor, Station};
use crate::planning::reactionless::SLACK;

/// Stations of the corridor in each piece.
pub(super) const STATIONS: usize = 8;
/// Stations are thinned by this where only the value of a program is wanted.
const EVERY_SECOND: usize = 2;
/// b would keep this far from the corridor's ends, rad, or a tenth of its width: at a fold the joints would be
/// infinitely fast.
const MARGIN: f64 = 1e-3;
/// Of that margin no more is kept than raises what is to be least by this part.
const MARGIN_COST: f64 = 4e-3;
/// Kept in any case, rad: rounding.
const MIN_MARGIN: f64 = 1e-8;
/// Where the start pose is nearer to an end than that, the margin grows over this part of the motion.
const GROWTH_SHARE: f64 = 0.1;
/// How often the walls are drawn in where the course passes the corridor's end between stations.
const ROUNDS: usize = 4;
/// What a smooth course may add to the least peak, as a part of it.
const SMOOTHING_COST: f64 = 1e-7;

/// Between which b − b_0 the course must stay at each station, the even ones first.
type Walls = Vec<[f64; 2]>;

/// The course of least ∫ b″² du, or of least peak of |b″|, that stays within the corridor at every station and, to
/// second order, between them; or a word on why there is none. The corridor has [`STATIONS`] stations for each of the
/// spaces. `ease` is how many times [`MARGIN_COST`] the distance from the corridor's ends may cost.
pub(super) fn least_course(
    corridor: &Corridor,
    end: Option<f64>,
    peak: bool,
    spaces: usize,
    ease: f64,
) -> Result<BCourse, String> {
    let value = |share: f64| value(corridor, &walls(corridor, end, share, 0.0), end, peak, spaces);
    // What is to be least is convex in the share of the margin, so that a chord bounds what a share of it costs.
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
        let course = solved(corridor, &walls(corridor, end, share, extra), end, peak, spaces)?;
        let past = past(corridor, &course);
        if past <= SLACK {
            return Ok(course);
        }
        rounds += 1;
        if rounds > ROUNDS {
            return Err(format!("{past:.1e} rad past its end between nodes"));
        }
        extra += 2.0 * past;
    }
}

/// How far a course passes the ends of its corridor, at stations and halfway between them, rad.
fn past(corridor: &Corridor, course: &BCourse) -> f64 {
    let stations = corridor.stations();
    let at = stations.iter().chain(corridor.between()).map(|s| {
        let b = course.at(s.u)[0];
        (s.low - b).max(b - s.high)
    });
    let between = stations.windows(2).enumerate().map(|(k, w)| {
        let b = course.at(0.5 * (w[0].u + w[1].u))[0];
        let side = |side: usize, ends: [f64; 2]| {
            let bulges = [k, k + 1].map(|k| bulge(corridor, k, side));
            // Across a jump of the corridor there is nothing to interpolate.
            let [Some(i), Some(j)] = bulges else { return f64::NEG_INFINITY };
            let sense = [1.0, -1.0][side];
            sense * (0.5 * (ends[0] + ends[1]) - b) + i.min(j)
        };
        side(0, [w[0].low, w[1].low]).max(side(1, [w[0].high, w[1].high]))
    });
    at.chain(between).fold(0.0, f64::max)
}

/// How far the corridor may be narrower halfway to the next station than its ends there say, by second differences;
/// `None` where they say that it jumps, as where another limit takes over.
fn bulge(corridor: &Corridor, k: usize, side: usize) -> Option<f64> {
    let stations = corridor.stations();
    let ends = |k: usize| [stations[k].low, stations[k].high][side];
    let second = |k: usize| {
        let k = k.clamp(1, stations.len().max(3) - 2);
        let bend = (2.0 * ends(k) - ends(k - 1) - ends((k + 1).min(stations.len() - 1))) / 8.0;
        if bend.is_finite() { bend } else { 0.0 }
    };
    let (here, beside) = (second(k), second(k.saturating_sub(2)).abs().max(second(k + 2).abs()));
    let smooth = here.abs() <= 8.0 * beside + MIN_MARGIN;
    smooth.then(|| ([1.0, -1.0][side] * here).max(0.0))
}

/// Unknowns b − b_0, b′, b″ of each node, side by side, so that every row has few of them.
fn solved(corridor: &Corridor, walls: &Walls, end: Option<f64>, peak: bool, spaces: usize) -> Result<BCourse, String> {
    let mut least = program(corridor, walls, end, spaces, 1, 0);
    if peak {
        // First the peak alone; then of all courses with that peak the smoothest.
        let bound = least_peak(corridor, walls, end, spaces, 1)? * (1.0 + SMOOTHING_COST);
        for i in 0..=spaces {
            least.at_most.push(Row::new([(3 * i + 2, 1.0)], bound));
            least.at_most.push(Row::new([(3 * i + 2, -1.0)], bound));
        }
    }
    let x = solution(&squared(least, spaces))?;
    let second = (0..=spaces).map(|i| x[3 * i + 2]).collect();
    Ok(BCourse::integrated(corridor.start().b, second, end))
}

/// What is least: the root of ∫ b″² du, or the peak of |b″|.
fn value(corridor: &Corridor, walls: &Walls, end: Option<f64>, peak: bool, spaces: usize) -> Result<f64, String> {
    if peak {
        return least_peak(corridor, walls, end, spaces, EVERY_SECOND);
    }
    let x = solution(&squared(program(corridor, walls, end, spaces, EVERY_SECOND, 0), spaces))?;
    let square = |i: usize| {
        let (x, y) = (x[3 * i + 2], x[3 * i + 5]);
        (x * x + x * y + y * y) / (3.0 * spaces as f64)
    };
    Ok((0..spaces).map(square).sum::<f64>().sqrt())
}

/// The least peak of |b″|: one unknown more.
fn least_peak(
    corridor: &Corridor,
    walls: &Walls,
    end: Option<f64>,
    spaces: usize,
    every: usize,
) -> Result<f64, String> {
    let top = 3 * (spaces + 1);
    let mut linear = program(corridor, walls, end, spaces, every, 1);
    linear.linear[top] = 1.0;
    for i in 0..=spaces {
        linear.at_most.push(Row::new([(3 * i + 2, 1.0), (top, -1.0)], 0.0));
        linear.at_most.push(Row::new([(3 * i + 2, -1.0), (top, -1.0)], 0.0));
    }
    Ok(solution(&linear)?[top].max(0.0))
}

fn solution(program: &Program) -> Result<Vec<f64>, String> {
    program.solve().map(|least| least.x).map_err(|why| why.to_string())
}

/// ∫ b″² du.
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

/// What holds of every course, with room for more unknowns behind; walls at every so-manyth even station, and at those
/// between.
fn program(corridor: &Corridor, walls: &Walls, end: Option<f64>, spaces: usize, every: usize, more: usize) -> Program {
    let start = corridor.start().b;
    let h = 1.0 / spaces as f64;
    let mut program = Program::over(3 * (spaces + 1) + more);
    program.equal.push(Row::new([(0, 1.0)], 0.0));
    program.equal.push(Row::new([(1, 1.0)], 0.0));
    program.equal.push(Row::new([(3 * spaces + 1, 1.0)], 0.0));
    if let Some(end) = end {
        program.equal.push(Row::new([(3 * spaces, 1.0)], end - start));
    }
    for i in 0..spaces {
        let [b, v, w] = [3 * i, 3 * i + 1, 3 * i + 2];
        program.equal.push(Row::new([(v + 3, 1.0), (v, -1.0), (w, -h / 2.0), (w + 3, -h / 2.0)], 0.0));
        program.equal.push(Row::new([(b + 3, 1.0), (b, -1.0), (v, -h), (w, -h * h / 3.0), (w + 3, -h * h / 6.0)], 0.0));
    }
    let even = corridor.stations().len();
    let besides = corridor.between().iter().map(|s| s.u * (even - 1) as f64).zip(&walls[even..]);
    let stations = walls[..even].iter().enumerate().skip(every).step_by(every).map(|(k, wall)| (k as f64, wall));
    for (k, [low, high]) in stations.chain(besides) {
        let place = k / STATIONS as f64;
        let i = (place as usize).min(spaces - 1);
        let d = (place - i as f64) * h;
        let cubic = d * d * d / (6.0 * h);
        let [b, v, w] = [3 * i, 3 * i + 1, 3 * i + 2];
        let row = |s: f64| [(b, s), (v, s * d), (w, s * (d * d / 2.0 - cubic)), (w + 3, s * cubic)];
        if k + 1.0 < even as f64 || end.is_none() {
            let walls = [(1.0, *high), (-1.0, -low)].into_iter().filter(|(_, right)| right.is_finite());
            program.at_most.extend(walls.map(|(s, right)| Row::new(row(s), right)));
        }
    }
    program
}

/// The corridor less a share of the margin, and what it may be narrower between stations. Where a given end of the
/// course lies within that, it grows from there.
fn walls(corridor: &Corridor, end: Option<f64>, share: f64, extra: f64) -> Walls {
    let stations = corridor.stations();
    let (first, last) = (&stations[0], &stations[stations.len() - 1]);
    let (b_0, b_1) = (corridor.start().b, end.unwrap_or(0.0));
    let wall = |station: &Station, bulges: [f64; 2]| {
        let tenth = 0.1 * (station.high - station.low);
        let inset = |side: usize, gap: [f64; 2]| {
            let whole = share * MARGIN.min(tenth) + (bulges[side] + MIN_MARGIN + extra).min(tenth);
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
        wall(station, bulges)
    });
    even.chain(corridor.between().iter().map(|station| wall(station, [0.0; 2]))).collect()
}
