//! The price of b: stated before a motion, found again by the dynamics of it.

use proptest::prelude::*;
use stillbase::mechanics::arm_on_base::FloatingBase;
use stillbase::mechanics::dynamics::{ExternalLoads, base_wrench};
use stillbase::mechanics::machine::{Inertia, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use stillbase::planning::Motion;
use stillbase::planning::off_plane::Price;
use stillbase::planning::off_plane::price::{PoseLaw, PriceError, bang_bang_in_b, joint_line, nearest_planes};
use stillbase::planning::pose_space::{PoseSpace, plane_map};
use stillbase::planning::posed::PoseAngles;
use stillbase::planning::reactionless::{BSet, PlaneMap};
use stillbase::planning::timing::TimeLaw;

use crate::support::{array, close, machine_of, planning};

fn nine_link() -> (PlaneMap, Inertia) {
    let machine = builtin("nine-link").expect("built in");
    (plane_map(machine).expect("three drives"), Inertia::of(machine))
}

fn space() -> PoseSpace {
    PoseSpace::of(builtin("nine-link").expect("built in")).expect("a b")
}

fn lifted(space: &PoseSpace, a: [f64; 2], b: f64) -> PoseAngles {
    PoseAngles::lifted(space, PerDrive::from(a), b)
}

/// n_B of the dynamics, N m, without gravity.
fn moment(model: &Inertia, q: &DriveAngles, qd: &PerDrive, qdd: &PerDrive) -> f64 {
    base_wrench(model, &q.units(), qd, qdd, &ExternalLoads::default()).total().moment
}

const LAWS: [PoseLaw; 3] = [PoseLaw::BangBang, PoseLaw::Cubic, PoseLaw::Quintic];

/// Second derivative by u of each law, written out here.
fn second(law: PoseLaw, u: f64) -> f64 {
    match law {
        PoseLaw::BangBang => 4.0 * (0.5 - u).signum(),
        PoseLaw::Cubic => 6.0 - 12.0 * u,
        PoseLaw::Quintic => 60.0 * u - 180.0 * u * u + 120.0 * u * u * u,
    }
}

#[test]
fn figures_of_the_laws() {
    let n = 200_000;
    let mid = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
    for law in LAWS {
        let (mut peak, mut impulse, mut square, mut way) = (0.0_f64, 0.0, 0.0, 0.0);
        for x in (0..n).map(|i| (mid(i), second(law, mid(i)))) {
            peak = peak.max(x.1.abs());
            impulse += x.1.abs() / f64::from(n);
            square += x.1 * x.1 / f64::from(n);
            way += (1.0 - x.0) * x.1 / f64::from(n);
        }
        let got = [law.peak(), law.impulse(), law.rms(), 1.0];
        close("figures", &got, &[peak, impulse, square.sqrt(), way], 1e-4);
    }
    assert!((PoseLaw::Quintic.peak() - 5.7735).abs() < 1e-4);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Whatever else moves, the base feels −D_1 b̈ of a straight joint line, and its peak is as priced.
    #[test]
    fn joint_lines_cost_what_was_said(
        a in [0.3..2.8f64, 0.3..2.8], to in [0.3..2.8f64, 0.3..2.8], b in -4.0..4.0f64, delta in -2.0..2.0f64, duration in 0.3..4.0f64,
    ) {
        let (space, model) = (space(), nine_link().1);
        let path = joint_line(&[lifted(&space, a, b), lifted(&space, to, b + delta)]);
        let (from, end) = (path.at(0.0).q, path.at(1.0).q);
        let price = Price::between(&model, &from, &end).expect("invariant");
        prop_assert!((price.delta_b() - delta).abs() < 1e-13 && (price.inertia() - model.diagonal(0)).abs() < 1e-15);
        let motion = Motion::new(path, TimeLaw::Quintic, duration);
        let scale = price.peak(PoseLaw::Quintic, duration).max(1e-3);
        let (mut peak, mut impulse) = (0.0_f64, 0.0);
        let n = 2000;
        for i in 0..n {
            let u = (f64::from(i) + 0.5) / f64::from(n);
            let r = motion.at(u * duration);
            let n_b = moment(&model, &r.q, &r.qd, &r.qdd);
            let want = -price.inertia() * delta * second(PoseLaw::Quintic, u) / (duration * duration);
            prop_assert!((n_b - want).abs() < 1e-9 * scale.max(1.0), "{n_b} and {want} at {u}");
            peak = peak.max(n_b.abs());
            impulse += n_b.abs() * duration / f64::from(n);
        }
        prop_assert!((peak - price.peak(PoseLaw::Quintic, duration)).abs() < 1e-4 * scale);
        prop_assert!((impulse - price.impulse(PoseLaw::Quintic, duration)).abs() < 1e-4 * scale * duration);
    }

    /// Only b is bang-bang: 4 D_1 Δb/T² at every instant, while the joints go by the quintic, to rounding.
    #[test]
    fn bang_bang_in_b_is_exact(
        a in [0.3..2.8f64, 0.3..2.8], to in [0.3..2.8f64, 0.3..2.8], b in -4.0..4.0f64, delta in -2.0..2.0f64, u in 0.0..1.0f64,
    ) {
        let (map, model) = nine_link();
        let space = space();
        let ends = [lifted(&space, a, b), lifted(&space, to, b + delta)];
        let table = bang_bang_in_b(&space, &ends).expect("nodes");
        let at = table.at(u);
        let n_b = moment(&model, &at.q, &at.first, &at.second);
        let price = Price::of(&model, delta).expect("invariant");
        prop_assert!((n_b.abs() - price.least_peak(1.0)).abs() < 1e-9, "{n_b} at {u}");
        prop_assert_eq!(n_b * delta < 0.0, u <= 0.5);
        let law = TimeLaw::Quintic.at(u, 1.0);
        let on = map.project(&at.q);
        let (ad, bd) = map.project_rates(&at.first);
        let (add, _) = map.project_rates(&at.second);
        for i in 0..2 {
            let step = to[i] - a[i];
            let got = [on.a[i], ad[i], add[i]];
            close("joints", &got, &[a[i] + law.s * step, law.rate * step, law.acceleration * step], 1e-12);
        }
        let s = if u < 0.5 { 2.0 * u * u } else { 1.0 - 2.0 * (1.0 - u) * (1.0 - u) };
        close("b", &[on.b, bd], &[b + s * delta, delta * if u < 0.5 { 4.0 * u } else { 4.0 - 4.0 * u }], 1e-12);
    }

    /// No b̈ of a smaller peak covers Δb from rest to rest: pushes of any sizes, evened out to end at rest.
    #[test]
    fn nothing_is_below_the_least_peak(pushes in prop::collection::vec(-1.0..1.0f64, 2..40)) {
        let (_, model) = nine_link();
        let n = pushes.len() as f64;
        let mean = pushes.iter().sum::<f64>() / n;
        let (mut rate, mut way, mut peak) = (0.0, 0.0, 0.0_f64);
        for x in pushes.iter().map(|x| x - mean) {
            way += rate / n + x / (2.0 * n * n);
            rate += x / n;
            peak = peak.max(x.abs());
        }
        let price = Price::of(&model, way).expect("invariant");
        prop_assert!(price.least_peak(1.0) <= model.diagonal(0) * peak * (1.0 + 1e-12));
    }

    #[test]
    fn times_are_inverse_to_peaks(delta in -3.0..3.0f64, limit in 0.01..10.0f64) {
        let (_, model) = nine_link();
        let price = Price::of(&model, delta).expect("invariant");
        for law in LAWS {
            let t = price.time(law, limit);
            prop_assert!((price.peak(law, t) - limit).abs() < 1e-12 * limit);
            prop_assert!(t >= price.time(PoseLaw::BangBang, limit));
            prop_assert!((price.rms(law, t) / limit - law.rms() / law.peak()).abs() < 1e-12);
        }
        let want = 2.0 * (model.diagonal(0) * delta.abs() / limit).sqrt();
        prop_assert!((price.time(PoseLaw::BangBang, limit) - want).abs() < 1e-12);
    }

    /// Against every pair of ends and of points in between, lifted by hand.
    #[test]
    fn nearest_planes_are_nearest(
        from in [0.0..7.0f64, 0.0..2.0], to in [0.0..7.0f64, 0.0..2.0], more in [0.0..7.0f64, 0.0..1.0], near in -20.0..20.0f64,
    ) {
        let set = |parts: &[[f64; 2]]| BSet {
            intervals: parts.iter().map(|[low, width]| [*low, low + width]).collect(),
            period: 7.8,
        };
        let (x, y) = (set(&[from]), set(&[to, more]));
        let [first, second] = nearest_planes(&x, &y, near).expect("not empty");
        prop_assert!(x.contains(first) && y.contains(second));
        let mut least = f64::INFINITY;
        for [low, high] in &y.intervals {
            for turn in -3..=3 {
                let turn = f64::from(turn) * 7.8;
                let ([a, b], [c, d]) = (x.intervals[0], [low + turn, high + turn]);
                least = least.min((c - b).max(a - d).max(0.0));
            }
        }
        prop_assert!(((second - first).abs() - least).abs() < 1e-9, "{first} {second} {least}");
        prop_assert!((first - near).abs() < 7.8 + 2.0);
    }
}

/// Turned about the base a point takes its b along: far enough round, it shares none with A.
#[test]
fn points_without_a_common_plane_have_a_least_price() {
    let ((map, _), space) = (nine_link(), space());
    let a = Vector::new(0.5, 0.5);
    for turn in [-2.6, -1.5, -1.2, 0.1, 1.2, 1.5, 2.0, 3.0] {
        let points = [a, Vector::new(0.55, 0.9) * unit(turn)];
        let sets = points.map(|p| map.reach(p).expect("reached"));
        let [first, second] = nearest_planes(&sets[0], &sets[1], 2.4).expect("reached");
        let delta = second - first;
        // Every pair of poses that the two self-motions show costs as much or more.
        let lines = points.map(|p| map.self_motion(p, 400).concat());
        let period = map.period();
        let mut least = f64::INFINITY;
        for x in &lines[0] {
            for y in &lines[1] {
                let gap = y.b - x.b;
                least = least.min((gap - period * (gap / period).round()).abs());
            }
        }
        assert!(delta.abs() <= least + 1e-6, "{turn}: {delta} above {least}");
        assert!((delta == 0.0) == (turn.abs() < 1.0), "{turn}: {delta}");
        // On a shared plane the line between them is reactionless.
        if delta == 0.0 {
            let pair = points.map(|p| map.poses(p, first).iter().next().copied().expect("a pose"));
            let path = joint_line(&pair.map(|x| lifted(&space, x.a, x.b)));
            assert!((0..=10).all(|i| (map.project(&path.at(f64::from(i) / 10.0).q).b - first).abs() < 1e-13));
        }
    }
}

/// Independent software integrated these bases from rest.
#[test]
fn a_floating_base_turns_as_priced() {
    let mut seen = 0;
    for case in planning()["free_floating_base"].as_array().expect("cases") {
        let mut body = crate::support::body_of(builtin("nine-link").expect("built in"));
        body.com = array(&case["com"]);
        let machine = machine_of(&body);
        let model = Inertia::of(&machine);
        let [from, to] = ["q_start", "q_end"].map(|key| DriveAngles::from(array::<3>(&case[key])));
        let [x, y] = array(&case["base"]["com"]);
        let number = |key: &str| case["base"][key].as_f64().expect("a number");
        let base = FloatingBase { mass: number("mass"), inertia: number("inertia"), com: Vector::new(x, y) };
        let price = Price::between(&model, &from, &to).expect("invariant");
        let turn = price.base_turn(&model, &base).expect("balanced");
        let want = array::<3>(&case["final_base_x_y_theta"])[2];
        assert!((turn - want).abs() < 2e-9, "{}: {turn} and {want}", case["name"]);
        seen += usize::from(want.abs() > 1e-3);
    }
    assert_eq!(seen, 2, "two of them turn");
}

#[test]
fn what_has_no_price_is_refused() {
    let machine = builtin("nine-link").expect("built in");
    let model = Inertia::of(machine);
    let loose = Inertia::of(&machine.set("link.9.mass", "0.9").expect("valid"));
    let error = Price::of(&loose, 0.1).expect_err("no b").to_string();
    assert!(error.contains("depends on the pose") && error.contains("want C_kl = 0"), "{error}");
    let error = Price::between(&model, &[0.0; 2].into(), &[0.0; 3].into()).expect_err("two angles");
    assert_eq!(error, PriceError::Drives { from: 2, to: 3, drives: 3 });
    let price = Price::of(&model, 0.1).expect("invariant");
    let base = FloatingBase { mass: 40.0, inertia: f64::NAN, com: Vector::default() };
    assert_eq!(price.base_turn(&model, &base), Err(PriceError::Base));
    let sound = FloatingBase { inertia: 3.0, ..base };
    // The serial pendulum on drive 1: no couplings, but its weight is off B.
    let heavy = Inertia::of(&machine.set("link.1.com", "0.1").expect("valid"));
    assert!(heavy.is_invariant() && !heavy.is_force_balanced());
    assert!(matches!(price.base_turn(&heavy, &sound), Err(PriceError::NotBalanced { .. })));
}
