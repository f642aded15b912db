//! Time laws, and the fastest motions that limits allow: closed forms, an independent phase-plane integration, and the
//! limits themselves, kept and used.

use proptest::prelude::*;
use stillbase::mechanics::arm_on_base::ArmOnBase;
use stillbase::mechanics::dynamics::{ExternalLoads, holding_torque, inverse, mass_matrix};
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::Motion;
use stillbase::planning::curves::path::SameTip;

use stillbase::planning::curves::{Curve, Path, PathPoint, PathTable};
use stillbase::planning::following::{Rule, trace};
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::posed::poses_of_points;
use stillbase::planning::timing::fastest::{fastest_at, stations};
use stillbase::planning::timing::limits::{DriveLimit, LimitedQuantity};
use stillbase::planning::timing::profile::JerkPhase;
use stillbase::planning::timing::usage::ACTIVE_SHARE;
use stillbase::planning::timing::{
    DriveLimits, FastestMotion, PathProgress, Profile, TimeError, TimeLaw, Usage, fastest, s_curve,
};
use stillbase::session::scenario::{Scenario, Task, Value};
use stillbase::session::{Run, replay};
use stillbase::settings::word::Choice;

use crate::support::tip_line;

/// q_A and q_B of Case 3, rad.
const Q_A: [f64; 3] = [1.6875182179, 3.7146223682, 2.1801769897];
const Q_B: [f64; 3] = [1.5074743692, 4.2177092073, 3.1287473760];

fn nine_link() -> &'static Machine {
    builtin("nine-link").expect("built in")
}

fn line() -> Path {
    Path::JointLine { from: Q_A.into(), to: Q_B.into() }
}

/// Case 1: the straight line of the end effector.
fn tip_path() -> Path {
    Path::Table(tip_line(nine_link().end_effector(), Q_A.into(), Vector::new(0.55, 0.90)).expect("regular"))
}

/// Case 2.
fn same_tip() -> Path {
    Path::SameTip(SameTip::new(nine_link().end_effector(), Q_A.into(), Q_B.into(), 1.45).expect("in reach"))
}

/// q_k = c_k + r_k sin(w_k s + p_k), by its nodes.
fn waves(r: [f64; 3], w: [f64; 3], p: [f64; 3]) -> Path {
    let node = |i: u32| {
        let s = f64::from(i) / 200.0;
        let by = |f: &dyn Fn(usize) -> f64| PerDrive::from_fn(3, f);
        let angle = |k: usize| w[k] * s + p[k];
        PathPoint {
            q: DriveAngles(by(&|k| Q_A[k] + r[k] * angle(k).sin())),
            first: by(&|k| r[k] * w[k] * angle(k).cos()),
            second: by(&|k| -r[k] * w[k] * w[k] * angle(k).sin()),
        }
    };
    Path::Table(PathTable::even((0..=200).map(node).collect()).expect("nodes"))
}

/// Curved paths: gentle ones, one on which every drive turns back, which makes zero-inertia points, and one whose q′
/// vanishes at its ends.
fn curves() -> Vec<(&'static str, Path)> {
    vec![
        ("tip line", tip_path()),
        ("same tip", same_tip()),
        ("gentle waves", waves([0.3, 0.4, 0.5], [2.0, 1.5, 2.5], [0.2, 1.0, -0.7])),
        ("waves", waves([0.2, 0.5, 0.6], [7.0, 5.0, 6.0], [0.3, 1.1, 2.0])),
        ("ends at a turn", waves([0.3, 0.3, 0.3], [std::f64::consts::PI; 3], [std::f64::consts::FRAC_PI_2; 3])),
    ]
}

fn limits(torque: [f64; 3], speed: [f64; 3], acceleration: [f64; 3], jerk: [f64; 3]) -> DriveLimits {
    DriveLimits { torque: torque.into(), speed: speed.into(), acceleration: acceleration.into(), jerk: jerk.into() }
}

const FREE: [f64; 3] = [f64::INFINITY; 3];

/// 20, 5 and 5 N m.
fn by_torque() -> DriveLimits {
    limits([20.0, 5.0, 5.0], FREE, FREE, FREE)
}

/// A machine out of balance, in gravity.
fn unbalanced() -> Machine {
    let settings = [("link.5.com", "0.05"), ("link.9.mass", "0.9"), ("gravity", "1,-9.81")];
    nine_link().set_all(settings).expect("valid")
}

/// A machine's constants and gravity.
fn of(machine: &Machine) -> (Inertia, ExternalLoads) {
    (Inertia::of(machine), ExternalLoads { gravity: machine.gravity(), force: Vector::default() })
}

/// A machine on a fixed base.
fn fixed(machine: &Machine) -> ArmOnBase {
    let (model, around) = of(machine);
    ArmOnBase::fixed(model, &around)
}

fn even(n: usize) -> Vec<f64> {
    (0..=n).map(|i| i as f64 / n as f64).collect()
}

fn timed(path: &Path, machine: &Machine, limits: &DriveLimits, n: usize) -> FastestMotion {
    let arm = fixed(machine);
    fastest_at(path, &arm, limits, false, &stations(n)).expect("a motion")
}

fn usage(path: &Path, found: &FastestMotion, machine: &Machine, limits: &DriveLimits, samples: usize) -> Usage {
    let arm = fixed(machine);
    let motion = Motion { path: path.clone(), profile: found.profile.clone() };
    Usage::of(&motion, &arm, limits, samples)
}

/// d/dt by central differences of fourth order.
fn slope(f: impl Fn(f64) -> f64, t: f64, h: f64) -> f64 {
    (8.0 * (f(t + h) - f(t - h)) - (f(t + 2.0 * h) - f(t - 2.0 * h))) / (12.0 * h)
}

/// That each derivative of a timing is that of what stands before it.
#[track_caller]
fn derivatives_agree(what: &str, at: impl Fn(f64) -> PathProgress, t: f64, h: f64, tolerance: f64) {
    let (p, scale) = (at(t), 1.0 / (h * 1e4));
    for (i, (got, want)) in [
        (p.rate, slope(|t| at(t).s, t, h)),
        (p.acceleration, slope(|t| at(t).rate, t, h)),
        (p.jerk, slope(|t| at(t).acceleration, t, h)),
    ]
    .into_iter()
    .enumerate()
    {
        let off = (got - want).abs() / scale.powi(i as i32 + 1).max(1.0);
        assert!(off < tolerance, "{what} at {t}: derivative {}: {got}, by differences {want}", i + 1);
    }
}

/// Where laws step in s̈ or s⃛, as parts of T.
const KINKS: [f64; 5] = [0.25, 1.0 / 3.0, 0.5, 2.0 / 3.0, 0.75];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn derivatives_of_laws_are_their_own(u in 0.002..0.998, duration in 0.2..5.0) {
        prop_assume!(KINKS.iter().all(|kink| f64::abs(u - kink) > 1e-3));
        for &law in TimeLaw::ALL {
            derivatives_agree(&format!("{law:?}"), |t| law.at(t, duration), u * duration, 1e-4 * duration, 1e-6);
            // The second half is the first, backwards.
            let (p, back) = (law.at(u * duration, duration), law.at((1.0 - u) * duration, duration));
            prop_assert!((p.s + back.s - 1.0).abs() < 1e-12 && (p.rate - back.rate).abs() * duration < 1e-12);
        }
    }
}

/// Peaks of s̈ T² and s⃛ T³, as the docs state them.
#[test]
fn laws_have_their_peaks() {
    let peaks = |law: TimeLaw| {
        let n = 120_000;
        let all = (0..n).map(|i| law.at(3.0 * (f64::from(i) + 0.5) / f64::from(n), 3.0));
        all.fold([0.0_f64; 3], |m, p| {
            [m[0].max(3.0 * p.rate), m[1].max(9.0 * p.acceleration.abs()), m[2].max(27.0 * p.jerk.abs())]
        })
    };
    for (law, want) in [
        (TimeLaw::Quintic, [1.875, 10.0 / 3f64.sqrt(), 60.0]),
        (TimeLaw::Septic, [35.0 / 16.0, 84.0 * 5f64.sqrt() / 25.0, 52.5]),
        (TimeLaw::Trapezoidal, [1.5, 4.5, 0.0]),
        (TimeLaw::Fastest, [2.0, 4.0, 0.0]),
        (TimeLaw::FastestSmooth, [2.0, 8.0, 32.0]),
    ] {
        let got = peaks(law);
        let off = [0, 1, 2].map(|i| (got[i] - want[i]).abs());
        assert!(off[0] < 3e-5 && off[1] < 1e-3 && off[2] < 2e-3, "{law:?}: {got:?}, want {want:?}");
    }
    assert!((10.0 / 3f64.sqrt() - 5.7735).abs() < 1e-4);
}

#[test]
fn laws_begin_and_end_at_rest() {
    for &law in TimeLaw::ALL {
        for t in [-1.0, -1e-300] {
            assert_eq!(law.at(t, 2.0), PathProgress::at_rest(0.0), "{law:?}");
        }
        for t in [2.0, 2.1, f64::INFINITY] {
            assert_eq!(law.at(t, 2.0), PathProgress::at_rest(1.0), "{law:?}");
        }
        let (first, last) = (law.at(0.0, 2.0), law.at(2.0 - 1e-9, 2.0));
        assert_eq!((first.s, first.rate), (0.0, 0.0), "{law:?}");
        assert!((last.s - 1.0).abs() < 1e-12 && last.rate.abs() < 1e-8, "{law:?}: {last:?}");
        // Which are continuous in s̈, and which in s⃛.
        let steps = [TimeLaw::Trapezoidal, TimeLaw::Fastest].contains(&law);
        assert_eq!(first.acceleration == 0.0 && last.acceleration.abs() < 1e-6, !steps, "{law:?}");
        assert_eq!(first.jerk == 0.0 && last.jerk.abs() < 1e-6, steps || law == TimeLaw::Septic, "{law:?}");
        // No time at all is at the end.
        assert_eq!(law.at(0.0, 0.0), PathProgress::at_rest(1.0));
    }
}

/// The laws made of phases, from spans.
#[test]
fn spans_make_the_laws() {
    let third = 2.0 / 3.0;
    let span = |time, acceleration, jerk| JerkPhase { time, acceleration, jerk };
    for (law, spans) in [
        (
            TimeLaw::Trapezoidal,
            vec![span(third, 1.125, 0.0), span(third, 0.0, 0.0), span(0.0, 9.0, 9.0), span(third, -1.125, 0.0)],
        ),
        (TimeLaw::Fastest, vec![span(1.0, 1.0, 0.0), span(1.0, -1.0, 0.0)]),
        (TimeLaw::FastestSmooth, vec![span(0.5, 0.0, 4.0), span(1.0, 2.0, -4.0), span(0.5, -2.0, 4.0)]),
    ] {
        let made = Profile::of_spans(&spans);
        assert!((made.duration() - 2.0).abs() < 1e-15);
        let slower = made.stretched(1.5);
        for i in -50..2100 {
            let t = (f64::from(i) + 0.5) * 1e-3;
            for (got, want) in [(made.at(t), law.at(t, 2.0)), (slower.at(1.5 * t), law.at(1.5 * t, 3.0))] {
                let off = [got.s - want.s, got.rate - want.rate, got.acceleration - want.acceleration];
                assert!(off.iter().all(|x| x.abs() < 1e-12), "{law:?} at {t}: {got:?} and {want:?}");
            }
        }
    }
    // A path that holds its timing itself.
    let even = Profile::even(4.0);
    assert_eq!((even.at(1.0).s, even.at(1.0).rate, even.duration()), (0.25, 0.25, 4.0));
    assert_eq!((Profile::none().duration(), Profile::none().at(0.0).s), (0.0, 1.0));
}

/// Through given rates: exact at every station, with derivatives of its own, wherever it is looked up.
#[test]
fn a_profile_goes_through_its_stations() {
    let s = even(40);
    // ṡ² of a law at these s, so that phases differ widely in time.
    let x: Vec<f64> = s.iter().map(|s| 16.0 * s.min(1.0 - s)).collect();
    let made = Profile::through(&s, &x, &[]).expect("it moves");
    assert!((made.duration() - 2.0 / 8f64.sqrt()).abs() < 1e-12, "{}", made.duration());
    for (s, x) in s.iter().zip(&x) {
        let t = if *s <= 0.5 { (s / 4.0).sqrt() } else { made.duration() - ((1.0 - s) / 4.0).sqrt() };
        let p = made.at(t);
        assert!((p.s - s).abs() < 1e-12 && (p.rate * p.rate - x).abs() < 1e-7, "{p:?} at s = {s}");
    }
    let rise: Vec<f64> = (0..40).map(|i| 0.05 * f64::from(i % 3)).collect();
    let risen = Profile::through(&s, &x, &rise).expect("it moves");
    for i in 0..1000 {
        let t = (f64::from(i) + 0.37) / 1000.0 * risen.duration();
        let (h, p) = (1e-7, risen.at(t));
        let [a, b] = [risen.at(t - h), risen.at(t + h)];
        assert!((p.rate - (b.s - a.s) / (2.0 * h)).abs() < 1e-6 && a.s < b.s, "at {t}");
    }
    assert_eq!(Profile::through(&s, &vec![0.0; 41], &[]), None);
    assert_eq!(Profile::through(&s, &x[1..], &[]), None);
    assert_eq!(Profile::through(&[0.0], &[0.0], &[]), None);
}

/// The straight line from q_A to q_B as a table, which nobody can take for a straight line.
fn line_as_table() -> Path {
    let path = line();
    Path::Table(PathTable::even([0.0, 0.5, 1.0].map(|s| path.at(s)).to_vec()).expect("nodes"))
}

/// 2/√s̈ with s̈ = min τ_max,k / (H_kk |Δq_k|), and what other limits make of it.
#[test]
fn a_straight_line_is_in_closed_form() {
    let model = Inertia::of(nine_link());
    let arm = fixed(nine_link());
    let step = [0, 1, 2].map(|k| (Q_B[k] - Q_A[k]).abs());
    let torque = (0..3).map(|k| [20.0, 5.0, 5.0][k] / (model.diagonal(k) * step[k])).fold(f64::INFINITY, f64::min);
    let best = 2.0 / torque.sqrt();
    let third = DriveLimit { quantity: LimitedQuantity::Torque, drive: 2 };
    let found = fastest(&line(), &arm, &by_torque(), false).expect("limits");
    assert!((found.profile.duration() - best).abs() < 1e-14, "{found:?}");
    assert_eq!((found.active_limits, found.gap), (vec![(third, 1.0)], None));
    // A speed limit cuts it: T = 1/v + v/a.
    let v = 2.0;
    let cut = limits([20.0, 5.0, 5.0], [f64::INFINITY, f64::INFINITY, v * step[2]], FREE, FREE);
    let found = fastest(&line(), &arm, &cut, false).expect("limits");
    assert!((found.profile.duration() - (1.0 / v + v / torque)).abs() < 1e-14);
    assert_eq!(found.active_limits.len(), 2);
    // As does one on acceleration, below what the torque gives.
    let slow = limits([20.0, 5.0, 5.0], FREE, [f64::INFINITY, 3.0, f64::INFINITY], FREE);
    let found = fastest(&line(), &arm, &slow, false).expect("limits");
    assert!((found.profile.duration() - 2.0 / (3.0 / step[1]).sqrt()).abs() < 1e-14);
    assert_eq!(found.active_limits, vec![(DriveLimit { quantity: LimitedQuantity::Acceleration, drive: 1 }, 1.0)]);
    // Parameterisation by reachability finds the same.
    for limits in [by_torque(), cut, slow] {
        let want = fastest(&line(), &arm, &limits, false).expect("limits").profile.duration();
        let got = fastest(&line_as_table(), &arm, &limits, false).expect("limits").profile.duration();
        assert!((got / want - 1.0).abs() < 1e-4, "{got} and {want}");
        let coarse = fastest_at(&line_as_table(), &arm, &limits, false, &even(100)).expect("limits");
        assert!((coarse.profile.duration() / want - 1.0).abs() < 1e-3, "{coarse:?} and {want}");
    }
}

/// The constraints of a path at many s, from the dynamics: (a u + c x + g) within ±1 for every torque.
struct PhasePlane {
    s: Vec<f64>,
    rows: Vec<[[f64; 3]; 3]>,
}

impl PhasePlane {
    fn new(path: &Path, machine: &Machine, torque: [f64; 3], n: usize) -> Self {
        let (model, around) = of(machine);
        let s: Vec<f64> = (0..=n).map(|i| 0.5 * (1.0 - (std::f64::consts::PI * i as f64 / n as f64).cos())).collect();
        let at = |i: usize| {
            // In the middle of the space that follows.
            let p = path.at(0.5 * (s[i] + s[(i + 1).min(n)]));
            let e = p.q.units();
            let (h, v) = mass_matrix(&model, &e, &p.first);
            let (a, b) = (h.times(&p.first), h.times(&p.second));
            let g = holding_torque(&model, &e, &around);
            [0, 1, 2].map(|k| [a[k], b[k] + v[k], g[k]].map(|x| x / torque[k]))
        };
        Self { rows: (0..=n).map(at).collect(), s }
    }

    /// Least and greatest s̈ at ṡ² = x.
    fn range(&self, i: usize, x: f64) -> (f64, f64) {
        self.rows[i].iter().fold((f64::NEG_INFINITY, f64::INFINITY), |(low, high), [a, c, g]| {
            let (p, q) = ((-1.0 - c * x - g) / a, (1.0 - c * x - g) / a);
            (low.max(p.min(q)), high.min(p.max(q)))
        })
    }

    /// Whether braking from here as hard as can be stops it before the end, without ever asking for too much.
    fn stops(&self, mut i: usize, mut x: f64) -> bool {
        while i + 1 < self.s.len() {
            let (low, high) = self.range(i, x);
            if low > high {
                return false;
            }
            x += 2.0 * (self.s[i + 1] - self.s[i]) * low;
            if x <= 0.0 {
                return true;
            }
            i += 1;
        }
        false
    }

    /// Least time: always the greatest s̈ from which it can still be stopped, found by bisection.
    fn least_time(&self) -> f64 {
        let (mut x, mut t) = (0.0_f64, 0.0);
        for i in 0..self.s.len() - 1 {
            let way = self.s[i + 1] - self.s[i];
            let (low, high) = self.range(i, x);
            let last = i + 2 == self.s.len();
            let fits = |u: f64| {
                let next = x + 2.0 * way * u;
                next > 0.0 && !last && self.stops(i + 1, next)
            };
            let u = if fits(high) {
                high
            } else {
                let (mut good, mut bad) = (low, high.max(low));
                for _ in 0..24 {
                    let middle = 0.5 * (good + bad);
                    if fits(middle) { good = middle } else { bad = middle }
                }
                good
            };
            let next = if last { 0.0 } else { (x + 2.0 * way * u).max(0.0) };
            t += 2.0 * way / (x.sqrt() + next.sqrt());
            x = next;
        }
        t
    }
}

/// Every curve with a machine in balance and with one that is not, in gravity.
fn tasks() -> impl Iterator<Item = (String, Path, Machine)> {
    let machines = [("balanced", nine_link().clone()), ("unbalanced", unbalanced())];
    machines.into_iter().flat_map(|(what, machine)| {
        curves().into_iter().map(move |(name, path)| (format!("{name}, {what}"), path, machine.clone()))
    })
}

#[test]
fn reachability_agrees_with_the_phase_plane() {
    for (name, path, machine) in tasks() {
        let want = PhasePlane::new(&path, &machine, [20.0, 5.0, 5.0], 400).least_time();
        let got = timed(&path, &machine, &by_torque(), 1000).profile.duration();
        assert!((got / want - 1.0).abs() < 6e-4, "{name}: {got} s, by the phase plane {want} s");
    }
}

/// T falls to its limit with the square of the spacing.
#[test]
fn time_converges_with_the_grid() {
    for (name, path, machine) in tasks() {
        let [a, b, c, d] = [125, 250, 500, 2000].map(|n| timed(&path, &machine, &by_torque(), n).profile.duration());
        let off = [a - d, b - d, c - d];
        assert!(off[0] > 2.5 * off[1] && off[1] > 2.5 * off[2], "{name}: {off:?} over {d}");
        assert!(off[2] / d < 1.5e-4, "{name}: {off:?} over {d}");
        // And not only on the grid that is finest at the ends.
        let arm = fixed(&machine);
        let plain = fastest_at(&path, &arm, &by_torque(), false, &even(1000)).expect("a motion");
        assert!((plain.profile.duration() / d - 1.0).abs() < 5e-3, "{name}: {} over {d}", plain.profile.duration());
    }
}

/// The optimum is at some limit almost always, and beyond none: 0.05 % at worst, where q′ vanishes at rest, 0.005 %
/// elsewhere.
#[test]
fn some_limit_is_active_and_none_is_passed() {
    let all = limits([20.0, 5.0, 5.0], [2.0, 2.5, 3.0], [20.0, 30.0, 35.0], FREE);
    for (name, path, machine) in tasks() {
        for limits in [by_torque(), all] {
            let found = timed(&path, &machine, &limits, 1000);
            let usage = usage(&path, &found, &machine, &limits, 10_000);
            assert!(usage.active > 0.98, "{name}: {usage:?}");
            let most = if name.starts_with("ends") { 5e-4 } else { 5e-5 };
            assert!((usage.max_utilisation - 1.0) < most, "{name}: {usage:?}");
            // What the sweep says leads is what the dynamics finds.
            for (limit, share) in &found.active_limits {
                let seen = usage.active_limits.iter().find(|l| l.0 == *limit).map_or(0.0, |l| l.1);
                assert!((seen - share).abs() < 0.02, "{name}, {limit}: {share} and {seen}");
            }
        }
    }
}

/// A straight way there and back, q = q_A + r sin π s: at the turn q′ vanishes and only ṡ² is bounded. There and back
/// at the greatest |q̈| of the drive that limits take 4 √(r/q̈).
#[test]
fn a_path_may_turn_back() {
    let machine = nine_link();
    let model = Inertia::of(machine);
    let arm = fixed(machine);
    let r = [0.3, 0.2, 0.3];
    let path = waves(r, [std::f64::consts::PI; 3], [0.0; 3]);
    let best = (0..3).map(|k| 4.0 * (r[k] * model.diagonal(k) / by_torque().torque[k]).sqrt()).fold(0.0, f64::max);
    for n in [500, 501, 1000] {
        let found = timed(&path, machine, &by_torque(), n);
        assert!((found.profile.duration() / best - 1.0).abs() < 2e-3, "{} and {best}", found.profile.duration());
        let usage = usage(&path, &found, machine, &by_torque(), 10_000);
        assert!(usage.active > 0.97 && (usage.max_utilisation - 1.0) < 1e-3, "{usage:?}");
    }
    let limits = DriveLimits { jerk: [3000.0; 3].into(), ..by_torque() };
    let smooth = fastest(&path, &arm, &limits, true).expect("limits");
    let motion = Motion { path, profile: smooth.profile };
    let usage = Usage::of(&motion, &arm, &limits, 10_000);
    assert!((usage.max_utilisation - 1.0) < 1e-4 && smooth.gap.expect("a bound") < 0.5, "{usage:?}");
}

/// The account itself: half and twice a limit, and what it names.
#[test]
fn usage_tells_violations() {
    let arm = fixed(nine_link());
    let limits = by_torque();
    let best = fastest(&line(), &arm, &limits, false).expect("limits").profile;
    for (factor, most, active) in [(1.0, 1.0, 1.0), (2.0, 0.25, 0.0), (0.5, 4.0, 1.0)] {
        let motion = Motion { path: line(), profile: best.stretched(factor) };
        let usage = Usage::of(&motion, &arm, &limits, 1000);
        assert!((usage.max_utilisation - most).abs() < 1e-9 && (usage.active - active).abs() < 1e-9, "{usage:?}");
        assert_eq!(usage.limit, Some(DriveLimit { quantity: LimitedQuantity::Torque, drive: 2 }));
    }
    // A quintic of the same peak takes √(5.7735/4) of the time.
    let quintic = Profile::of(TimeLaw::Quintic, best.duration() * (10.0 / 3f64.sqrt() / 4.0).sqrt());
    let usage = Usage::of(&Motion { path: line(), profile: quintic }, &arm, &limits, 10_000);
    assert!((usage.max_utilisation - 1.0).abs() < 1e-6 && usage.active < 0.1, "{usage:?}");
    let free = Usage::of(&Motion { path: line(), profile: best }, &arm, &DriveLimits::none(3), 100);
    assert_eq!((free.active, free.max_utilisation, free.limit), (0.0, 0.0, None));
    const { assert!(ACTIVE_SHARE < 1.0 && ACTIVE_SHARE >= 0.999) }
}

/// T of the fastest way from 0 to 1 over all phase durations, by search: up, constant, down to a rate; the same or
/// other phases down from it.
fn searched(v: f64, a: f64, j: f64) -> f64 {
    let (n, rates) = (40, 400);
    // Ways to the rate j up (up + constant): how long each takes.
    let ways = |rate: f64| {
        let most = (rate / j).sqrt().min(a / j);
        (1..=n).map(move |i| {
            let up = most * f64::from(i) / f64::from(n);
            let constant = rate / (j * up) - up;
            2.0 * up + constant
        })
    };
    let top = v.min(2.0 * (0.25 * j).cbrt());
    (0..=rates)
        .map(|i| {
            let rate = top * 1e-4_f64.powf(f64::from(i) / f64::from(rates));
            let best = ways(rate).fold(f64::INFINITY, f64::min);
            // Half the rate times both times is the way without a cruise.
            let cruise = (1.0 - rate * best) / rate;
            if cruise < 0.0 { f64::INFINITY } else { 2.0 * best + cruise }
        })
        .fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The seven-phase curve keeps its limits exactly, is at one of them all the time, and no search beats it.
    #[test]
    fn s_curves_are_exact_and_best(v in -1.5..1.5_f64, a in -1.5..2.0_f64, j in -1.0..3.0_f64) {
        let [v, a, j] = [v, a, j].map(|x| 10f64.powf(x));
        for (v, a, j) in [(v, a, j), (f64::INFINITY, a, j), (v, f64::INFINITY, j), (f64::INFINITY, f64::INFINITY, j)] {
            let profile = Profile::of_spans(&s_curve(v, a, j).expect("jerk is limited"));
            let whole = profile.duration();
            let n = 2000;
            for i in 0..n {
                let p = profile.at((f64::from(i) + 0.5) / f64::from(n) * whole);
                let parts = [p.rate / v, p.acceleration.abs() / a, p.jerk.abs() / j];
                let most = parts.iter().fold(0.0_f64, |m, x| m.max(*x));
                prop_assert!((most - 1.0).abs() < 1e-9, "{p:?}: {parts:?}");
            }
            let end = profile.at(whole * (1.0 - 1e-12));
            prop_assert!((end.s - 1.0).abs() < 1e-9 && end.rate < 1e-8 / whole, "{end:?}");
            let found = searched(v, a, j);
            prop_assert!(whole <= found * (1.0 + 1e-12) && whole >= found * 0.98, "{whole} s, by search {found} s");
        }
    }

    /// Without jerk: 2/√a, or 1/v + v/a where v cuts it; it is what jerk without end comes to.
    #[test]
    fn s_curves_of_endless_jerk(v in -1.0..1.5_f64, a in -1.0..2.0_f64) {
        let [v, a] = [v, a].map(|x| 10f64.powf(x));
        let time = |j: f64| Profile::of_spans(&s_curve(v, a, j).expect("limited")).duration();
        let want = if v * v < a { 1.0 / v + v / a } else { 2.0 / a.sqrt() };
        prop_assert!((time(f64::INFINITY) / want - 1.0).abs() < 1e-14);
        prop_assert!((time(1e9 * a) / want - 1.0).abs() < 1e-6);
        prop_assert_eq!(s_curve(v, f64::INFINITY, f64::INFINITY), None);
    }
}

/// On a straight line with limits on jerk: the S-curve, with the gap that they cost.
#[test]
fn a_straight_line_with_limits_on_jerk() {
    let arm = fixed(nine_link());
    let limits = limits([20.0, 5.0, 5.0], [2.0; 3], FREE, [900.0, 400.0, 300.0]);
    let found = fastest(&line(), &arm, &limits, true).expect("limits");
    let without = fastest(&line(), &arm, &limits, false).expect("limits").profile.duration();
    let gap = found.gap.expect("torque is limited too");
    assert!((found.profile.duration() / without - 1.0 - gap).abs() < 1e-12 && gap > 0.01, "{gap}");
    let motion = Motion { path: line(), profile: found.profile };
    let usage = Usage::of(&motion, &arm, &limits, 4000);
    assert!(usage.active > 0.999 && (usage.max_utilisation - 1.0) < 1e-9, "{usage:?}");
    assert!(found.active_limits.iter().any(|(l, _)| l.quantity == LimitedQuantity::Jerk), "{:?}", found.active_limits);
}

/// On curves every limit is kept, jerk found by differences of q̈ included, and the gap is the one stated.
#[test]
fn limits_on_jerk_are_kept_on_curves() {
    for (name, path, machine) in tasks() {
        let (model, around) = of(&machine);
        let arm = fixed(&machine);
        let mut times = Vec::new();
        for jerk in [100.0, 3000.0] {
            let limits = limits([20.0, 5.0, 5.0], [3.0; 3], FREE, [jerk, jerk, 2.0 * jerk]);
            let grid = stations(120);
            let found = fastest_at(&path, &arm, &limits, true, &grid).expect("a motion");
            let bound = fastest_at(&path, &arm, &limits, false, &grid).expect("a motion").profile;
            let whole = found.profile.duration();
            assert!((whole / bound.duration() - 1.0 - found.gap.expect("a bound")).abs() < 1e-12);
            let motion = Motion { path: path.clone(), profile: found.profile };
            let (n, h) = (3000, whole * 1e-6);
            for i in 0..n {
                let t = (f64::from(i) + 0.5) / f64::from(n) * whole;
                let (r, a, b) = (motion.at(t), motion.at(t - h), motion.at(t + h));
                let torque = inverse(&model, &r.q.units(), &r.qd, &r.qdd, &around);
                let third = b.qdd.minus(&a.qdd).scaled(0.5 / h);
                for k in 0..3 {
                    let parts = [
                        torque[k].abs() / limits.torque[k],
                        r.qd[k].abs() / limits.speed[k],
                        third[k].abs() / limits.jerk[k],
                    ];
                    assert!(parts.iter().all(|p| *p < 1.002), "{name}, {jerk} at {t} of {whole}: {parts:?}");
                }
            }
            times.push((whole, bound.duration()));
        }
        assert!(times[0].0 > times[1].0 && times[1].0 > times[1].1, "{name}: {times:?}");
    }
}

/// Where the optimum is known, the way of curves comes within 0.4 % of it, whatever the jerk, and never below.
#[test]
fn limits_on_jerk_cost_little_more_than_they_must() {
    let arm = fixed(nine_link());
    for jerk in [30.0, 300.0, 1000.0, 10_000.0] {
        let limits = limits([20.0, 5.0, 5.0], FREE, FREE, [jerk; 3]);
        let best = fastest(&line(), &arm, &limits, true).expect("limits").profile.duration();
        let found = fastest_at(&line_as_table(), &arm, &limits, true, &stations(300)).expect("limits");
        let ratio = found.profile.duration() / best;
        assert!(ratio > 1.0 - 1e-6 && ratio < 1.004, "{jerk}: {ratio}");
    }
}

/// Jerk alone, or with speed: no bound to compare with, but a motion.
#[test]
fn jerk_alone_is_enough() {
    let arm = fixed(nine_link());
    let only = limits(FREE, FREE, FREE, [300.0; 3]);
    for path in [line(), tip_path()] {
        let found = fastest(&path, &arm, &only, true).expect("jerk is limited");
        assert_eq!(found.gap, None);
        let motion = Motion { path, profile: found.profile };
        let usage = Usage::of(&motion, &arm, &only, 4000);
        assert!(usage.max_utilisation > 0.99 && (usage.max_utilisation - 1.0) < 1e-5, "{usage:?}");
    }
}

#[test]
fn what_cannot_be_timed_is_refused() {
    let arm = fixed(nine_link());
    let refused =
        |path: &Path, limits: DriveLimits, smooth| fastest(path, &arm, &limits, smooth).expect_err("nothing to go by");
    let speed = limits(FREE, [2.0; 3], FREE, FREE);
    for path in [line(), tip_path()] {
        assert!(matches!(refused(&path, DriveLimits::none(3), false), TimeError::Unlimited { .. }));
        assert_eq!(refused(&path, speed, false), TimeError::SpeedOnly);
        assert_eq!(refused(&path, by_torque(), true), TimeError::NoJerkLimit);
        let two = DriveLimits::none(2);
        assert_eq!(refused(&path, two, false), TimeError::Drives { path: 3, model: 3, limits: 2 });
    }
    // Only a drive that stands still is limited.
    let still = Path::JointLine { from: Q_A.into(), to: [Q_A[0], Q_B[1], Q_B[2]].into() };
    let first = limits([20.0, f64::INFINITY, f64::INFINITY], FREE, FREE, FREE);
    assert!(matches!(refused(&still, first, false), TimeError::Unlimited { .. }));
    for bad in [vec![], vec![0.0], vec![0.0, 0.5], vec![0.1, 1.0], vec![0.0, 0.6, 0.5, 1.0], vec![0.0, f64::NAN, 1.0]] {
        let error = fastest_at(&line(), &arm, &by_torque(), false, &bad).expect_err("no grid");
        assert_eq!(error, TimeError::Stations);
    }
    // Drive 2 of the machine out of balance cannot hold its links up.
    let machine = unbalanced();
    let (model, around) = of(&machine);
    let arm = fixed(&machine);
    let weak = limits([20.0, 0.5, 5.0], FREE, FREE, FREE);
    for smooth in [false, true] {
        let weak = DriveLimits { jerk: [300.0; 3].into(), ..weak };
        let error = fastest(&tip_path(), &arm, &weak, smooth).expect_err("too heavy");
        let TimeError::Static { drive, s, torque, limit } = error.clone() else { panic!("{error}") };
        assert!((drive, limit) == (2, 0.5) && torque.abs() > 0.5, "{error}");
        let want = holding_torque(&model, &tip_path().at(s).q.units(), &around)[1];
        assert!((torque - want).abs() < 1e-9 && error.to_string().contains("want a higher torque limit"), "{error}");
    }
}

/// A scenario asks for the fastest law and its run takes the time that the drives allow, at their limits.
#[test]
fn a_run_is_as_fast_as_its_drives() {
    for case in ["case-1", "case-2", "case-3"] {
        let mut scenario = Scenario::builtin(case).expect("built in");
        scenario.task.law = TimeLaw::Fastest;
        let run = replay(&scenario, |_, _| ()).expect("it can start");
        let whole = run.motion().expect("nobody leads it off").duration();
        assert!(whole > 0.2 && whole < 0.6, "{case}: {whole} s");
        let peaks = run.frame().peaks.torque;
        let part = (0..3).map(|k| peaks[k] / by_torque().torque[k]).fold(0.0, f64::max);
        assert!((part - 1.0).abs() < 0.01, "{case}: {part} of a limit");
        let left = run.frame().q.0.minus(&run.motion().expect("still").path.at(1.0).q.0).max_abs();
        assert!(left < 1e-3 && run.frame().qd.max_abs() < 1e-2, "{case}: {left} rad from its end");
    }
    let mut scenario = Scenario::builtin("case-1").expect("built in");
    scenario.task.law = TimeLaw::FastestSmooth;
    let error = Run::new(&scenario).expect_err("no limit on jerk");
    assert!(error.to_string().contains("want jerk_limit"), "{error}");
    let text = scenario.to_toml();
    assert!(text.contains("law = \"fastest-smooth\""), "{text}");
    assert_eq!(Scenario::parse(&text, "again", None).expect("its own file"), scenario);
}

/// A path that goes nowhere takes no time.
#[test]
fn nowhere_takes_no_time() {
    let arm = fixed(nine_link());
    let nodes = [0.0, 1.0].map(|s| Path::Rest(Q_A.into()).at(s)).to_vec();
    let table = Path::Table(PathTable::even(nodes).expect("nodes"));
    for path in [Path::Rest(Q_A.into()), Path::JointLine { from: Q_A.into(), to: Q_A.into() }, table] {
        let limits = DriveLimits { jerk: [300.0; 3].into(), ..by_torque() };
        for smooth in [false, true] {
            let found = fastest(&path, &arm, &limits, smooth).expect("it is there");
            assert_eq!((found.profile.duration(), found.profile.at(0.0).s), (0.0, 1.0));
            assert_eq!(Motion { path: path.clone(), profile: found.profile }.at(0.0).qd.max_abs(), 0.0);
        }
    }
}

/// A wave is followed from rest to rest within all limits, and one of them active.
fn random_curve(
    [r, w, p]: [[f64; 3]; 3],
    [torque, speed, acceleration]: [[f64; 3]; 3],
    heavy: bool,
) -> Result<(), TestCaseError> {
    let machine = if heavy { unbalanced() } else { nine_link().clone() };
    let limits = limits(torque, speed, acceleration, FREE);
    let path = waves(r, w, p);
    let arm = fixed(&machine);
    let found = match fastest(&path, &arm, &limits, false) {
        Ok(found) => found,
        Err(error) => {
            prop_assert!(heavy && matches!(error, TimeError::Static { .. }), "{}", error);
            return Ok(());
        }
    };
    let usage = usage(&path, &found, &machine, &limits, 4000);
    prop_assert!((usage.max_utilisation - 1.0) < 1e-6, "{:?}", usage);
    // It is slowed down as a whole by what is passed at one place: no more than 0.5 % is lost to a converged grid.
    let best = fastest_at(&path, &arm, &limits, false, &converged(&path, 8)).expect("a motion");
    let ratio = found.profile.duration() / best.profile.duration();
    prop_assert!((0.998..1.005).contains(&ratio), "{}: {:?}", ratio, usage);
    let end = found.profile.at(found.profile.duration() * (1.0 - 1e-9));
    prop_assert!((end.s - 1.0).abs() < 1e-6 && end.rate < 1e-3);
    prop_assert!((found.active_limits.iter().map(|l| l.1).sum::<f64>() - 1.0).abs() < 1e-9);
    Ok(())
}

/// Within one part of the motion another limit takes over: the first was once passed there by 4e-6.
#[test]
fn limits_are_kept_where_another_takes_over() {
    let wave = [
        [0.6850625895780134, 0.790873248354265, 0.05],
        [3.093632024014194, 5.213793319870364, 0.5],
        [1.818239669253805, 2.884697650870489, 0.0],
    ];
    let limits = [
        [25.137111087319425, 12.28709002972716, 6.0],
        [5.9554939263741185, 1.4142585434628014, 0.5],
        [67.66995747238546, 52.77802581064345, 5.0],
    ];
    random_curve(wave, limits, true).expect("within its limits");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Any waves, any limits, with and without balance: rest to rest within all limits, and one of them active. Two
    /// hundred of them: each is judged by a grid eight times as dense, and a thousand are in the long test.
    #[test]
    fn random_curves_keep_random_limits(
        r in prop::array::uniform3(0.05..0.8_f64),
        w in prop::array::uniform3(0.5..9.0_f64),
        p in prop::array::uniform3(0.0..6.3_f64),
        torque in prop::array::uniform3(6.0..40.0_f64),
        speed in prop::array::uniform3(0.5..20.0_f64),
        acceleration in prop::array::uniform3(5.0..80.0_f64),
        heavy in any::<bool>(),
    ) {
        random_curve([r, w, p], [torque, speed, acceleration], heavy)?;
    }
}

/// A path through random points on the plane b = 2.4: straight lines with rounded or sharp corners, an arc, a spline.
fn drawn(points: &[Vector], shape: usize, blend: f64) -> Option<Vec<Path>> {
    let space = PoseSpace::of(nine_link()).expect("three drives");
    let start = poses_of_points(&space, points, 2.4).ok()?[0].a;
    let curves = match shape {
        0 => Curve::polyline(points, false, blend).ok()?,
        1 => vec![Curve::arc([points[0], points[1], points[2]], false).ok()?],
        _ => vec![Curve::spline(points, false).ok()?],
    };
    let tables =
        trace::follow(space.planes().ok()?.map(), &curves, 2.4, Some([start[0], start[1]]), Rule::default()).ok()?;
    Some(tables.into_iter().map(Path::Table).collect())
}

/// Every place of a path and many stations, each space cut into as many parts: far denser than is ever planned with.
fn converged(path: &Path, parts: usize) -> Vec<f64> {
    let mut all = path.sample_parameters();
    all.extend(stations(300));
    all.sort_by(f64::total_cmp);
    all.dedup_by(|b, a| *b - *a < 1e-9);
    let mut fine: Vec<f64> =
        all.windows(2).flat_map(|w| (0..parts).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / parts as f64)).collect();
    fine.push(1.0);
    fine
}

/// Random limits of the nine-link machine's drives, those on torque as they are.
fn drives(speed: Option<f64>, jerk: f64) -> DriveLimits {
    let speed = speed.map_or(FREE, |v| [v, 2.0 * v, 2.0 * v]);
    limits([20.0, 5.0, 5.0], speed, FREE, [jerk, 2.0 * jerk, 3.0 * jerk])
}

fn anywhere(count: usize) -> impl Strategy<Value = Vec<Vector>> {
    prop::collection::vec((-0.1..0.7_f64, 0.1..0.8_f64).prop_map(|(x, y)| Vector::new(x, y)), 3..=count)
}

/// What must be true of every fastest motion along lines with rounded corners, arcs and splines.
fn judge(points: &[Vector], shape: usize, blend: f64, limits: &DriveLimits, smooth: bool) -> Result<(), TestCaseError> {
    let Some(paths) = drawn(points, shape, blend) else { return Ok(()) };
    let arm = fixed(nine_link());
    let without = DriveLimits { jerk: FREE.into(), ..*limits };
    let asked = if smooth { limits } else { &without };
    for path in &paths {
        let found = fastest(path, &arm, limits, smooth).expect("a motion");
        let motion = Motion { path: path.clone(), profile: found.profile };
        let usage = Usage::of(&motion, &arm, asked, 20_000);
        prop_assert!(
            (usage.max_utilisation - 1.0) < 1e-6,
            "{:?} of {:?}, shape {}, blend {}",
            usage,
            points,
            shape,
            blend
        );
        let end = motion.profile.at(motion.duration() * (1.0 - 1e-12));
        prop_assert!((end.s - 1.0).abs() < 1e-9, "{:?}", end);
        if !smooth {
            let grid = converged(path, 12);
            let best = fastest_at(path, &arm, &without, false, &grid).expect("a motion").profile.duration();
            let ratio = motion.duration() / best;
            prop_assert!(
                (0.999..1.005).contains(&ratio),
                "{} of {:?}, shape {}, blend {}",
                ratio,
                points,
                shape,
                blend
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Limits are kept to 1e-6 between the stations too, and no more than 0.5 % is lost to a converged grid, however
    /// tightly corners are rounded off. Four hundred of them; a thousand of either law are in the long test.
    #[test]
    fn fastest_motions_keep_their_limits_and_are_the_best(
        points in anywhere(4), shape in 0..3_usize, blend in -4.0..-1.0_f64, speed in prop::option::of(1.0..6.0_f64),
    ) {
        judge(&points, shape, 10f64.powf(blend), &drives(speed, f64::INFINITY), false)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// And those on jerk too: sixty, as each takes a third of a second in a debug build.
    #[test]
    fn smooth_motions_keep_their_limits(
        points in anywhere(4), shape in 0..3_usize, blend in -4.0..-1.0_f64, jerk in 2.5..4.0_f64,
        speed in prop::option::of(1.0..6.0_f64),
    ) {
        judge(&points, shape, 10f64.powf(blend), &drives(speed, 10f64.powf(jerk)), true)?;
    }
}

/// The same on a rounded corner, found at random.
#[test]
fn limits_are_kept_where_another_takes_over_on_a_corner() {
    let points = [
        Vector::new(0.69325473983, 0.59504065298),
        Vector::new(0.62290694010, 0.33853777108),
        Vector::new(0.50570575564, 0.16979811276),
    ];
    judge(&points, 0, 10f64.powf(-1.4709914710159915), &drives(None, f64::INFINITY), false).expect("sound");
}

/// A scenario through points with straight lines of the end effector, rounded off or not.
fn through(points: &[Vector], blend: Option<f64>, law: &str) -> Option<Scenario> {
    let mut scenario = Scenario::builtin("case-3").expect("built in");
    for k in 0..3 {
        let jerk = format!("drive.{}.jerk_limit=900", k + 1);
        let (key, value) = jerk.split_once('=').expect("both");
        scenario.machine = scenario.machine.set(key, value).expect("a limit");
    }
    let mut change = Task::visiting(points)?;
    let words = [("shape", "line"), ("law", law), ("corners", if blend.is_some() { "blend" } else { "stop" })];
    change.extend(words.map(|(key, word)| (key.to_owned(), word.into())));
    change.extend(blend.map(|blend| ("blend".to_owned(), blend.into())));
    scenario.task = scenario.task.with_change(&change, &scenario.machine).ok()?;
    Some(scenario)
}

/// A plan with rounded corners takes no longer than one that rests at them; at first one took three times as long.
fn never_slower(points: &[Vector], blend: f64, law: &str) -> Option<(f64, f64)> {
    let time = |blend| Some(Run::new(&through(points, blend, law)?).ok()?.planned_time());
    Some((time(Some(blend))?, time(None)?))
}

#[test]
fn rounded_corners_are_never_slower_than_rests() {
    let points = [(0.018, 0.363), (0.255, 0.196), (-0.091, 0.123), (0.273, 0.269), (0.086, 0.422)];
    let points = points.map(|(x, y)| Vector::new(x, y));
    for (law, at_most) in [("fastest", 1.3455), ("fastest-smooth", f64::INFINITY)] {
        for blend in [1e-4, 1e-3, 0.02] {
            let (rounded, resting) = never_slower(&points, blend, law).expect("it can be followed");
            assert!(rounded <= resting && rounded <= at_most, "{law}, {blend}: {rounded} s, resting {resting} s");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    #[ignore = "long: a thousand plans of either law, some minutes in a release build"]
    fn rounded_corners_are_never_slower_than_rests_anywhere(points in anywhere(5), blend in -4.0..-1.0_f64) {
        for law in ["fastest", "fastest-smooth"] {
            if let Some((rounded, resting)) = never_slower(&points, 10f64.powf(blend), law) {
                prop_assert!(rounded <= resting, "{}: {} s, resting {} s", law, rounded, resting);
            }
        }
    }

    #[test]
    #[ignore = "long: a thousand motions of either law, some minutes in a release build"]
    fn fastest_motions_keep_their_limits_anywhere(
        points in anywhere(5), shape in 0..3_usize, blend in -4.0..-1.0_f64, jerk in 2.5..4.0_f64,
        speed in prop::option::of(1.0..6.0_f64), smooth in any::<bool>(),
    ) {
        judge(&points, shape, 10f64.powf(blend), &drives(speed, 10f64.powf(jerk)), smooth)?;
    }

    #[test]
    #[ignore = "long: a thousand waves, two minutes in a debug build"]
    fn random_curves_keep_random_limits_anywhere(
        r in prop::array::uniform3(0.05..0.8_f64),
        w in prop::array::uniform3(0.5..9.0_f64),
        p in prop::array::uniform3(0.0..6.3_f64),
        torque in prop::array::uniform3(6.0..40.0_f64),
        speed in prop::array::uniform3(0.5..20.0_f64),
        acceleration in prop::array::uniform3(5.0..80.0_f64),
        heavy in any::<bool>(),
    ) {
        random_curve([r, w, p], [torque, speed, acceleration], heavy)?;
    }
}

/// A time that a law finds is bound as one that is given is; and one without limits on jerk has no gap to them.
#[test]
fn times_that_are_found_have_a_range() {
    let with = |limit: &str| {
        let mut scenario = Scenario::builtin("case-3").expect("built in");
        scenario.task.law = TimeLaw::Fastest;
        for k in 1..4 {
            scenario.machine = scenario.machine.set(&format!("drive.{k}.torque_limit"), limit).expect("a limit");
        }
        Run::new(&scenario)
    };
    for (limit, want) in [("1e-9", "want at most 3600 s"), ("1e6", "want at least")] {
        let error = with(limit).expect_err("no time for a motion").to_string();
        assert!(error.contains(want) && error.len() < 200, "{limit}: {error}");
    }
    // What would take longer than anything is no limit at all.
    let machine = Scenario::builtin("case-3").expect("built in").machine;
    machine.set("drive.1.torque_limit", "1e-300").expect_err("out of range");
    let run = with("3").expect("it can");
    assert_eq!(run.plan().pace.expect("fastest").gap(), None);
}

/// Two poses that are one are named as they were given, on a closed path with rounded corners too.
#[test]
fn closed_joint_lines_name_given_points() {
    let points = [(0.5, 0.5), (0.55, 0.9), (0.5, 0.5)].map(|(x, y)| Vector::new(x, y));
    let mut scenario = through(&points, Some(0.05), "quintic").expect("a task");
    let change =
        [("shape", "joint-line".into()), ("closed", true.into())].map(|(k, v): (&str, Value)| (k.to_owned(), v));
    scenario.task = scenario.task.with_change(&change.into_iter().collect(), &scenario.machine).expect("a task");
    let error = Run::new(&scenario).expect_err("no way from a point to itself").to_string();
    assert!(error.contains("points 3 and 1 are the same"), "{error}");
}
