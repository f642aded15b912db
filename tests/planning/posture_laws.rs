//! What postures promise, on random machines: each has the least of what it is named for, and a line is refused only
//! where no way along it exists.

use stillbase::mechanics::dynamics::{ExternalLoads, inverse};
use stillbase::mechanics::machine::Inertia;
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::Motion;
use stillbase::planning::common::common_b_set;
use stillbase::planning::curves::path::least_rate_curve;
use stillbase::planning::curves::{Curve, Path};
use stillbase::planning::posture::{NoPosturePath, Posture, PostureRequest, PostureWeights};
use stillbase::planning::timing::TimeLaw;

use crate::support::Noise;
use crate::support::random::{Case, a_case};

const ALL: [Posture; 4] = [Posture::LeastRates, Posture::Orientation, Posture::LeastTorque, Posture::MidRange];

impl Case {
    fn path(&self, posture: Posture) -> Result<Path, NoPosturePath> {
        let hand = self.machine.resolved_links()[self.machine.end_link()].drive;
        let curve = Curve::line(self.ends[0], self.ends[1]);
        let asked = PostureRequest {
            machine: &self.machine,
            space: &self.space,
            b: self.b,
            curves: std::slice::from_ref(&curve),
            law: Some(TimeLaw::Quintic),
            closed: false,
            hand: (hand, None),
        };
        asked.path(posture).map(|mut found| Path::Table(found.tables.remove(0)))
    }

    /// ∫ |q′|² ds, ∫ τ² dt, and ∫ ½ Σ x² ds, by sampling.
    fn costs(&self, path: &Path) -> [f64; 3] {
        const SAMPLES: usize = 4000;
        let (inertia, around) = (Inertia::of(&self.machine), ExternalLoads::default());
        let postures = PostureWeights::of(&self.machine, &self.space);
        let motion = Motion::new(path.clone(), TimeLaw::Quintic, 1.0);
        let mut sums = [0.0; 3];
        for i in 0..SAMPLES {
            let at = (i as f64 + 0.5) / SAMPLES as f64;
            let point = path.at(at);
            let now = motion.at(at);
            let torques =
                inertia.motors().motor_torques(&inverse(&inertia, &now.q.units(), &now.qd, &now.qdd, &around));
            sums[0] += point.first.dot(&point.first) / SAMPLES as f64;
            sums[1] += torques.dot(&torques) / SAMPLES as f64;
            sums[2] += postures.off_middle(&point.q) / SAMPLES as f64;
        }
        sums
    }

    /// By how much a path misses its line, m, passes limits, rad, and leaves b, rad.
    fn misses(&self, path: &Path) -> [f64; 3] {
        let mut most = [0.0_f64; 3];
        for i in 0..=2000 {
            let s = f64::from(i) / 2000.0;
            let q = path.at(s).q;
            let on = self.ends[0] + s * (self.ends[1] - self.ends[0]);
            let past = self.space.joints().iter().map(|joint| {
                let ([low, high], a) = (joint.bounds(), joint.of(&q));
                (low - a).max(a - high)
            });
            let past = past.fold(0.0, f64::max);
            let off = [(self.space.end_effector(&q) - on).norm(), past, (self.space.b(&q) - self.b).abs()];
            (0..3).for_each(|j| most[j] = most[j].max(off[j]));
        }
        most
    }

    /// Whether least rates from the pose nearest to the middle keep the limits all along.
    fn goes_locally(&self) -> bool {
        let curve = Curve::line(self.ends[0], self.ends[1]);
        let Some(start) = self.space.poses(self.ends[0], self.b, &self.space.middle()).first().copied() else {
            return false;
        };
        let table = least_rate_curve(self.machine.end_effector(), Some(self.space.lambda()), start, &curve);
        table.is_ok_and(|table| self.misses(&Path::Table(table))[1] < 1e-6)
    }

    /// Whether a graph over closed-form poses of four drives, with the last drive on a fine grid, leads along the line.
    fn goes_densely(&self, stations: usize, grid: usize, near: f64) -> bool {
        let [low, high] = (0..=200).fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], i| {
            // All angles that the last drive can have at this b, generously.
            let mut noise = Noise::of(i);
            let corner = PerDrive::from_fn(3, |j| {
                let limits = self.space.joints()[j].limits();
                limits[usize::from(noise.between(0.0, 1.0) > 0.5)]
            });
            let q = self.space.lift(&corner, self.b)[3];
            [low.min(q), high.max(q)]
        });
        let mut reached: Vec<DriveAngles> = Vec::new();
        for i in 0..=stations {
            let p = self.ends[0] + i as f64 / stations as f64 * (self.ends[1] - self.ends[0]);
            let mut here: Vec<DriveAngles> = Vec::new();
            for k in 0..=grid {
                let angle = low + k as f64 / grid as f64 * (high - low);
                for q in self.space.poses_with_drive_angle(p, self.b, 3, angle, &self.space.middle()) {
                    if (q[3] - angle).abs() < 1e-9 {
                        here.push(q);
                    }
                }
            }
            let beside = |q: &DriveAngles, all: &[DriveAngles]| all.iter().any(|r| r.0.minus(&q.0).max_abs() < near);
            let mut now: Vec<bool> = here.iter().map(|q| i == 0 || beside(q, &reached)).collect();
            // Along the poses of one point, too.
            loop {
                let known: Vec<DriveAngles> = here.iter().zip(&now).filter(|(_, now)| **now).map(|(q, _)| *q).collect();
                let mut grown = false;
                for (q, now) in here.iter().zip(&mut now) {
                    if !*now && beside(q, &known) {
                        (*now, grown) = (true, true);
                    }
                }
                if !grown {
                    reached = known;
                    break;
                }
            }
            if reached.is_empty() {
                return false;
            }
        }
        true
    }
}

/// What became of random lines of so many drives: how often each posture was beaten, lines that went locally and were
/// refused, the reverse, and times of plans, s.
#[derive(Debug, Default)]
struct Tally {
    lines: usize,
    refused: usize,
    abrupt: usize,
    beaten: [usize; 3],
    worst: f64,
    only_locally: usize,
    only_here: usize,
    off: [f64; 3],
    times: Vec<f64>,
}

fn tally(n: usize, lines: usize, seed: u64) -> Tally {
    let mut noise = Noise::of(seed);
    let mut tally = Tally::default();
    for line in 0..lines {
        let case = a_case(&mut noise, n);
        tally.lines += 1;
        let mut found: Vec<(Posture, [f64; 3])> = Vec::new();
        let locally = case.goes_locally();
        for posture in ALL {
            let start = std::time::Instant::now();
            let path = case.path(posture);
            tally.times.push(start.elapsed().as_secs_f64());
            match &path {
                Ok(path) => {
                    let off = case.misses(path);
                    (0..3).for_each(|j| tally.off[j] = tally.off[j].max(off[j]));
                    found.push((posture, case.costs(path)));
                }
                Err(why) if posture == Posture::LeastRates => {
                    tally.refused += 1;
                    tally.abrupt += usize::from(*why == NoPosturePath::Abrupt);
                    if locally || *why == NoPosturePath::Abrupt {
                        println!("line {line}: {why}, locally {locally}");
                    }
                }
                Err(_) => {}
            }
        }
        let here = found.iter().any(|(posture, _)| *posture == Posture::LeastRates);
        tally.only_locally += usize::from(locally && !here);
        tally.only_here += usize::from(here && !locally);
        for (j, own) in [Posture::LeastRates, Posture::LeastTorque, Posture::MidRange].into_iter().enumerate() {
            let Some((_, costs)) = found.iter().find(|(posture, _)| *posture == own) else { continue };
            for (other, others) in &found {
                let over = costs[j] / others[j] - 1.0;
                tally.worst = tally.worst.max(over);
                if over > 1e-3 {
                    println!("line {line}: {own:?} {} beaten by {other:?} {}", costs[j], others[j]);
                    tally.beaten[j] += 1;
                }
            }
        }
    }
    tally.times.sort_by(f64::total_cmp);
    let at = |share: f64| tally.times[((tally.times.len() - 1) as f64 * share) as usize];
    println!(
        "n = {n}: {} lines, refused {} ({} abrupt), beaten {:?}, worst {:.1e}, only locally {}, only here {}, off {:?}, \
         {:.1} ms, 95 % {:.1} ms, most {:.1} ms",
        tally.lines,
        tally.refused,
        tally.abrupt,
        tally.beaten,
        tally.worst,
        tally.only_locally,
        tally.only_here,
        tally.off,
        1e3 * at(0.5),
        1e3 * at(0.95),
        1e3 * at(1.0)
    );
    tally
}

fn holds(tally: &Tally) {
    assert_eq!(tally.beaten, [0; 3]);
    assert_eq!(tally.only_locally, 0);
    assert!(tally.off[0] < 1e-8 && tally.off[1] < 1e-6 && tally.off[2] < 1e-9, "{:?}", tally.off);
}

#[test]
fn each_posture_has_the_least_of_its_own() {
    for (n, lines) in [(4, 4), (5, 1)] {
        holds(&tally(n, lines, 7 + n as u64));
    }
}

#[test]
#[ignore = "minutes: 500 lines of four drives, 100 each of five and six, 20 each of seven and eight"]
fn each_posture_has_the_least_of_its_own_over_many() {
    let ask = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<usize>().ok());
    let all = [(4, 500), (5, 100), (6, 100), (7, 20), (8, 20)];
    for (n, lines) in all.into_iter().filter(|(n, _)| ask("DRIVES").is_none_or(|own| own == *n)) {
        holds(&tally(n, ask("LINES").unwrap_or(lines), 100 + n as u64));
    }
}

/// Lines that are refused, against a graph over a fine grid of poses, and how many there were.
fn refused_rightly(lines: usize, seed: u64) -> usize {
    let mut noise = Noise::of(seed);
    let mut refused = 0;
    for line in 0..lines {
        let case = a_case(&mut noise, 4);
        if let Err(why) = case.path(Posture::LeastRates) {
            refused += 1;
            assert!(!case.goes_densely(80, 600, 0.06), "line {line}: {why}, but a way exists");
        }
    }
    refused
}

#[test]
fn lines_are_refused_only_where_no_way_exists() {
    refused_rightly(8, 3);
}

#[test]
#[ignore = "minutes: 300 lines"]
fn lines_are_refused_only_where_no_way_exists_over_many() {
    println!("{} of 300 refused", refused_rightly(300, 4));
}

/// Lines at a b just inside an end of what serves all their points, against the same graph: how many there were.
fn goes_near_the_ends(lines: usize, share: f64, seed: u64) -> [usize; 2] {
    let mut noise = Noise::of(seed);
    let (mut count, mut refused) = (0, 0);
    while count < lines {
        let mut case = a_case(&mut noise, 4);
        let way = case.ends[1] - case.ends[0];
        let points: Vec<Vector> = (0..=400).map(|i| case.ends[0] + f64::from(i) / 400.0 * way).collect();
        let Some(serving) = common_b_set(&case.space, &points) else { continue };
        let Some([low, high]) = serving.intervals.first().copied() else { continue };
        if high - low > 0.999 * case.space.period() {
            continue;
        }
        count += 1;
        let inside = share * (high - low);
        case.b = if noise.between(0.0, 1.0) > 0.5 { low + inside } else { high - inside };
        if let Err(why) = case.path(Posture::LeastRates) {
            refused += 1;
            println!("line {count}, b {}: {why}", case.b);
            assert!(!case.goes_densely(80, 600, 0.06), "line {count}: {why}, but a way exists");
        }
    }
    [count, refused]
}

#[test]
fn lines_near_the_ends_of_b_are_refused_only_where_no_way_exists() {
    goes_near_the_ends(4, 1e-3, 5);
}

#[test]
#[ignore = "minutes: 400 lines"]
fn lines_near_the_ends_of_b_are_refused_rightly_over_many() {
    for share in [1e-1, 1e-2, 1e-3, 1e-4] {
        println!("{share}: {:?} refused", goes_near_the_ends(100, share, 6));
    }
}
