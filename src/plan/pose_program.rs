//! The program behind the least reaction: which course of b within a corridor has the least ∫ b″² or the least peak of b″.
//!
//! b″ is linear between even nodes; b and b′ of the nodes are unknowns too, bound together by exact integration.

use super::convex::Program;
use super::corridor::Corridor;
use super::pose_course::PoseCourse;
use crate::reactionless::SLACK;

/// Stations of the corridor in each piece; the program keeps every second one, and all are checked.
pub(super) const STATIONS: usize = 8;
/// Between two stations that the program keeps.
const KEPT: usize = 2;
/// b keeps this far from the corridor's ends, rad, or a tenth of its width: at a fold the joints would be infinitely fast.
const MARGIN: f64 = 1e-3;
/// Where the start pose is nearer to an end than that, the margin grows over this part of the motion.
const GROWING: f64 = 0.1;
/// How often the margin is widened where the course passes the corridor's end between kept stations.
const ROUNDS: usize = 4;
/// What a smooth course may add to the least peak, as a part of it.
const SPARE: f64 = 1e-7;

/// The course of least ∫ b″² du, or of least peak of |b″|, that stays within the corridor at every station; or a word on
/// why there is none. The corridor has [`STATIONS`] stations for each of the spaces.
pub(super) fn least_course(
    corridor: &Corridor,
    end: Option<f64>,
    peak: bool,
    spaces: usize,
) -> Result<PoseCourse, String> {
    let mut margin = MARGIN;
    let mut rounds = 0;
    loop {
        let course = solved(corridor, end, peak, spaces, margin)?;
        let past = corridor.stations().iter().fold(0.0_f64, |most, station| {
            let b = course.at(station.u)[0];
            most.max(station.low - b).max(b - station.high)
        });
        if past <= SLACK {
            return Ok(course);
        }
        rounds += 1;
        if rounds > ROUNDS {
            return Err(format!("{past:.1e} rad past its end between nodes"));
        }
        margin += 2.0 * past;
    }
}

/// Unknowns b − b_0, b′, b″ of each node, side by side, so that every row has few of them.
fn solved(corridor: &Corridor, end: Option<f64>, peak: bool, spaces: usize, margin: f64) -> Result<PoseCourse, String> {
    let mut least = program(corridor, end, spaces, margin, 0);
    if peak {
        // First the peak alone, one unknown more; then of all courses with that peak the smoothest.
        let top = 3 * (spaces + 1);
        let mut linear = program(corridor, end, spaces, margin, 1);
        linear.add_linear(top, 1.0);
        for i in 0..=spaces {
            linear.at_most([(3 * i + 2, 1.0), (top, -1.0)], 0.0);
            linear.at_most([(3 * i + 2, -1.0), (top, -1.0)], 0.0);
        }
        let bound = linear.solve()?[top] * (1.0 + SPARE);
        for i in 0..=spaces {
            least.at_most([(3 * i + 2, 1.0)], bound);
            least.at_most([(3 * i + 2, -1.0)], bound);
        }
    }
    let x = squared(least, spaces).solve()?;
    let second = (0..=spaces).map(|i| x[3 * i + 2]).collect();
    Ok(PoseCourse::integrated(corridor.start().b, second, end))
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

/// What holds of every course, with room for more unknowns behind.
fn program(corridor: &Corridor, end: Option<f64>, spaces: usize, margin: f64, more: usize) -> Program {
    let start = corridor.start().b;
    let h = 1.0 / spaces as f64;
    let mut program = Program::over(3 * (spaces + 1) + more);
    program.equal([(0, 1.0)], 0.0);
    program.equal([(1, 1.0)], 0.0);
    program.equal([(3 * spaces + 1, 1.0)], 0.0);
    if let Some(end) = end {
        program.equal([(3 * spaces, 1.0)], end - start);
    }
    for i in 0..spaces {
        let [b, v, w] = [3 * i, 3 * i + 1, 3 * i + 2];
        program.equal([(v + 3, 1.0), (v, -1.0), (w, -h / 2.0), (w + 3, -h / 2.0)], 0.0);
        program.equal([(b + 3, 1.0), (b, -1.0), (v, -h), (w, -h * h / 3.0), (w + 3, -h * h / 6.0)], 0.0);
    }
    for (k, station) in corridor.stations().iter().enumerate().skip(KEPT).step_by(KEPT) {
        let i = (k / STATIONS).min(spaces - 1);
        let d = (k - i * STATIONS) as f64 / STATIONS as f64 * h;
        let cubic = d * d * d / (6.0 * h);
        let [b, v, w] = [3 * i, 3 * i + 1, 3 * i + 2];
        let row = |s: f64| [(b, s), (v, s * d), (w, s * (d * d / 2.0 - cubic)), (w + 3, s * cubic)];
        let [low, high] = narrowed(corridor, k, end, margin);
        if station.u < 1.0 || end.is_none() {
            program.at_most(row(1.0), high - start);
            program.at_most(row(-1.0), start - low);
        }
    }
    program
}

/// The corridor at a station less the margin. Where a given end of the course lies within the margin, it grows from there.
fn narrowed(corridor: &Corridor, k: usize, end: Option<f64>, margin: f64) -> [f64; 2] {
    let stations = corridor.stations();
    let (station, last) = (&stations[k], &stations[stations.len() - 1]);
    let from = |gap: f64, u: f64| margin.min(gap.max(0.0) + margin * (u / GROWING).powi(3));
    let inner = |gap: [f64; 2]| {
        let tail = if end.is_some() { from(gap[1], 1.0 - station.u) } else { margin };
        from(gap[0], station.u).min(tail).min(0.1 * (station.high - station.low))
    };
    let (b_0, b_1) = (corridor.start().b, end.unwrap_or(0.0));
    [
        station.low + inner([b_0 - stations[0].low, b_1 - last.low]),
        station.high - inner([stations[0].high - b_0, last.high - b_1]),
    ]
}
