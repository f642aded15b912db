//! The rate at which errors fall, and that every path's derivatives are its own.

use proptest::prelude::*;
use stillbase::mechanics::kinematics::{end_effector, minimum_norm};
use stillbase::mechanics::machine::{Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::Motion;
use stillbase::planning::curves::path::SameTip;
use stillbase::planning::curves::{Path, PathError, PathPoint};
use stillbase::planning::timing::TimeLaw;
use stillbase::simulation::control::Control;
use stillbase::simulation::plant::{Base, PlantDifferences};
use stillbase::simulation::{Guide, Setup, Simulation};

use crate::support::{close, tip_line};

/// q_A and q_B of Case 3, rad.
const Q_A: [f64; 3] = [1.6875182179, 3.7146223682, 2.1801769897];
const Q_B: [f64; 3] = [1.5074743692, 4.2177092073, 3.1287473760];

fn nine_link() -> &'static Machine {
    builtin("nine-link").expect("built in")
}

fn tip() -> &'static stillbase::mechanics::machine::Chain {
    nine_link().end_effector()
}

fn line() -> Path {
    Path::JointLine { from: Q_A.into(), to: Q_B.into() }
}

/// Every kind of path, from q_A.
fn paths() -> [(&'static str, Path); 4] {
    let way = tip_line(tip(), Q_A.into(), Vector::new(0.55, 0.90)).expect("regular");
    let same = SameTip::new(tip(), Q_A.into(), Q_B.into(), 1.45).expect("in reach");
    [
        ("rest", Path::Rest(Q_A.into())),
        ("joint line", line()),
        ("tip line", Path::Table(way)),
        ("same tip", Path::SameTip(same)),
    ]
}

/// Least-squares slope of log error over log step.
fn order(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs = || points.iter().map(|(h, e)| (h.ln(), e.ln()));
    let (x, y) = logs().fold((0.0, 0.0), |(x, y), (a, b)| (x + a / n, y + b / n));
    let (xy, xx) = logs().fold((0.0, 0.0), |(p, q), (a, b)| (p + (a - x) * (b - y), q + (a - x) * (a - x)));
    xy / xx
}

#[test]
fn order_is_the_slope() {
    let points = [0.1, 0.05, 0.02].map(|h: f64| (h, 3.0 * h.powi(4)));
    assert!((order(&points) - 4.0).abs() < 1e-12);
}

fn simulated(model: &Machine, plant: &PlantDifferences, step: f64, guide: Guide) -> Simulation {
    let (base, control) = (Base::default(), Control::default());
    Simulation::new(&Setup { model, plant, base: &base, control: &control, step }, guide).expect("valid")
}

/// State of an unbalanced plant with a payload, in gravity, at 0.6 s of a motion planned for another machine.
fn state_after(dt: f64) -> [f64; 6] {
    let settings = [("link.1.com", "0.1"), ("link.9.mass", "0.9"), ("gravity", "1,-9.81")];
    let model = builtin("nine-link-table-1").expect("built in").set_all(settings).expect("valid");
    let plant: PlantDifferences = toml::from_str("payload.mass = 0.4\nlink.2.com = 0.05").expect("valid");
    assert!(!stillbase::mechanics::machine::Inertia::of(&model).is_invariant());
    let motion = Motion::new(line(), TimeLaw::Quintic, 1.0);
    let guide = Guide::Motion { motion: motion.into(), start: 0.0, base_end: Default::default() };
    let mut simulation = simulated(&model, &plant, dt, guide);
    for _ in 0..(0.6 / dt).round() as u64 {
        simulation.advance();
    }
    let f = simulation.frame();
    [f.q[0], f.q[1], f.q[2], f.qd[0], f.qd[1], f.qd[2]]
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Steps so short that none is taken in parts.
const SHORT: [f64; 3] = [0.00125, 0.000625, 0.0003125];

/// Between events the integrator is of order 4: halving the step leaves a sixteenth of the error, twice over. Longer
/// steps are taken in parts, and are as exact as short ones.
#[test]
fn integrator_is_of_order_four() {
    let exact = state_after(0.00005);
    let errors = SHORT.map(|h| (h, distance(&state_after(h), &exact)));
    let order = order(&errors);
    assert!((3.8..=4.2).contains(&order), "order {order}: {errors:?}");
    assert!(errors[0].1 > 3e-10, "large enough to tell: {errors:?}");
    for h in [0.01, 0.005, 0.0025] {
        let off = distance(&state_after(h), &exact);
        assert!(off < 1e-7, "by steps of {h} s: {off:e}");
    }
}

/// Work done by the motors is integrated to the same order as the state.
#[test]
fn energy_balance_is_of_order_four() {
    let off = |dt: f64| {
        let model = nine_link().set("gravity", "0,-9.81").expect("valid");
        let plant: PlantDifferences = toml::from_str("payload.mass = 0.5").expect("valid");
        let motion = Motion::new(line(), TimeLaw::Quintic, 1.0);
        let mut simulation = simulated(
            &model,
            &plant,
            dt,
            Guide::Motion { motion: motion.into(), start: 0.0, base_end: Default::default() },
        );
        for _ in 0..(0.6 / dt).round() as u64 {
            simulation.advance();
        }
        simulation.frame().audit.energy.abs()
    };
    let errors = SHORT.map(|h| (h, off(h)));
    let order = order(&errors);
    assert!((3.8..=4.3).contains(&order), "order {order}: {errors:?}");
}

/// The minimum-norm line from q_A to B, integrated here by the classical rule in n steps up to s.
fn by_steps(n: usize, s: f64) -> PerDrive {
    let way = Vector::new(0.55, 0.90) - end_effector(tip(), &DriveAngles::from(Q_A).units());
    let slope =
        |q: PerDrive| minimum_norm(tip(), &DriveAngles(q).units(), 3, way, Vector::default()).expect("regular").0;
    let h = s / n as f64;
    (0..n).fold(PerDrive::from(Q_A), |q, _| {
        let k1 = slope(q);
        let k2 = slope(q.plus(h / 2.0, &k1));
        let k3 = slope(q.plus(h / 2.0, &k2));
        let k4 = slope(q.plus(h, &k3));
        q.plus(h / 6.0, &k1).plus(h / 3.0, &k2).plus(h / 3.0, &k3).plus(h / 6.0, &k4)
    })
}

/// Coarse integrations converge to the planned line with order 4, at its end and between its nodes.
#[test]
fn tip_line_is_where_order_four_leads() {
    let (_, path) = &paths()[2];
    for s in [1.0, 0.5, 0.3219] {
        let goal = path.at(s).q;
        let errors = [8, 16, 32, 64].map(|n| (s / n as f64, distance(&by_steps(n, s), &goal)));
        let order = order(&errors);
        assert!((3.8..=4.2).contains(&order), "s = {s}, order {order}: {errors:?}");
        assert!(distance(&by_steps(2000, s), &goal) < 1e-12, "s = {s}");
    }
}

/// At a quarter of the spacing of the nodes the end effector is still on the line: the quintics cost nothing.
#[test]
fn tip_line_stays_on_its_line_between_nodes() {
    let (_, path) = &paths()[2];
    let [a, b] = [path.at(0.0), path.at(1.0)].map(|p| end_effector(tip(), &p.q.units()));
    assert!((b - Vector::new(0.55, 0.90)).norm() < 1e-12);
    for i in 0..=1024 {
        let s = f64::from(i) / 1024.0;
        let off = end_effector(tip(), &path.at(s).q.units()) - (a + s * (b - a));
        assert!(off.norm() < 1e-12, "s = {s}: {:e} m", off.norm());
    }
}

/// d/ds by central differences of fourth order.
fn slope(f: impl Fn(f64) -> PerDrive, s: f64, h: f64) -> PerDrive {
    let [far_back, back, on, far_on] = [-2.0, -1.0, 1.0, 2.0].map(|n| f(s + n * h));
    PerDrive::from_fn(3, |k| (8.0 * (on[k] - back[k]) - (far_on[k] - far_back[k])) / (12.0 * h))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn derivatives_of_paths_are_their_own(s in 0.005..0.995) {
        for (name, path) in paths() {
            let p = path.at(s);
            close(name, &p.first, &slope(|s| path.at(s).q.0, s, 5e-4), 1e-8);
            close(name, &p.second, &slope(|s| path.at(s).first, s, 5e-4), 1e-6);
        }
    }

    #[test]
    fn derivatives_of_motions_are_their_own(u in 0.005..0.995, duration in 0.2..5.0) {
        for (name, path) in paths() {
            let motion = Motion::new(path, TimeLaw::Quintic, duration);
            let (t, h) = (u * duration, 5e-4 * duration);
            let r = motion.at(t);
            close(name, &r.qd, &slope(|t| motion.at(t).q.0, t, h), 1e-7);
            close(name, &r.qdd, &slope(|t| motion.at(t).qd, t, h), 1e-6);
        }
    }

    /// Nothing jumps anywhere, at nodes, at the ends and beyond: what lies a hair to either side is the same.
    #[test]
    fn both_sides_agree(i in -20i32..276) {
        let (s, hair) = (f64::from(i) / 256.0, 1e-9);
        let parts = |p: PathPoint| [p.q.0, p.first, p.second];
        for (name, path) in paths() {
            let (before, after) = (parts(path.at(s - hair)), parts(path.at(s + hair)));
            for (x, y) in before.iter().zip(&after) {
                prop_assert!(x.plus(-1.0, y).max_abs() < 1e-6, "{name} at {s}: {x:?} and {y:?}");
            }
            let motion = Motion::new(path, TimeLaw::Quintic, 1.0);
            let (before, after) = (motion.at(s - hair), motion.at(s + hair));
            for (x, y) in [(before.q.0, after.q.0), (before.qd, after.qd), (before.qdd, after.qdd)] {
                prop_assert!(x.plus(-1.0, &y).max_abs() < 1e-6, "{name} at {s} s: {x:?} and {y:?}");
            }
        }
    }
}

#[test]
fn motions_begin_and_end_at_rest() {
    for (name, path) in paths() {
        let motion = Motion::new(path.clone(), TimeLaw::Quintic, 2.0);
        for (t, s) in [(-1.0, 0.0), (0.0, 0.0), (2.0, 1.0), (7.0, 1.0)] {
            let r = motion.at(t);
            assert_eq!(r.q, path.at(s).q, "{name} at {t} s");
            assert_eq!((r.qd.max_abs(), r.qdd.max_abs()), (0.0, 0.0), "{name} at {t} s");
        }
        assert_eq!(path.at(-1.0), path.at(0.0));
        assert_eq!(path.at(2.0), path.at(1.0));
    }
}

/// Peak acceleration 10/√3 /T², peak rate 15/8 /T, and the whole way.
#[test]
fn quintic_law() {
    let law = TimeLaw::Quintic;
    let grid = || (0..=10_000).map(|i| law.at(f64::from(i) * 3e-4, 3.0));
    let peak =
        |f: fn(&stillbase::planning::timing::law::PathProgress) -> f64| grid().map(|p| f(&p).abs()).fold(0.0, f64::max);
    assert!((peak(|p| p.acceleration) * 9.0 - 10.0 / 3f64.sqrt()).abs() < 1e-6);
    assert!((peak(|p| p.rate) * 3.0 - 1.875).abs() < 1e-9);
    assert!(grid().zip(grid().skip(1)).all(|(a, b)| a.s <= b.s));
    assert_eq!(law.at(1.5, 3.0).s, 0.5);
    assert_eq!((law.at(0.0, 3.0).s, law.at(3.0, 3.0).s), (0.0, 1.0));
}

/// A path that cannot be is refused, and says where.
#[test]
fn impossible_paths_are_refused() {
    // The arm reaches 1.26 m; on the way to 2 m it is stretched where the line leaves that circle.
    for to in [Vector::new(1.4, 1.4), Vector::new(-2.0, 0.1), Vector::new(0.0, 2.0)] {
        let from = end_effector(tip(), &DriveAngles::from(Q_A).units());
        let Err(PathError::Singular { s }) = tip_line(tip(), Q_A.into(), to) else { panic!("{to} is too far") };
        let radius = (from + s * (to - from)).norm();
        assert!((radius - 1.26).abs() < 0.03, "to {to}: stretched at {radius} m, s = {s}");
    }
    // A line of no length, or of next to none, is a line.
    for way in [0.0, 1e-15] {
        let from = end_effector(tip(), &DriveAngles::from(Q_A).units());
        let line = tip_line(tip(), Q_A.into(), from + way).expect("regular");
        assert!(distance(&Path::Table(line).at(1.0).q, &Q_A) < 1e-14);
    }
    let error = SameTip::new(tip(), Q_A.into(), Q_B.into(), 5.0).expect_err("too far round").to_string();
    assert!(error.contains("drives 2 and 3 cannot keep the end effector on its path at s = 0."), "{error}");
}
