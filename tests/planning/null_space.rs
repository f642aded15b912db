//! Motions of zero momentum: laws of Frobenius and Stokes, closed forms against brute force.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use stillbase::mechanics::dynamics::{ExternalLoads, angular_momentum, base_wrench, mass_matrix};
use stillbase::mechanics::kinematics::{end_effector, velocity};
use stillbase::mechanics::machine::{Inertia, Machine, builtin, parse};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::off_plane::b_integral::BIntegral;
use stillbase::planning::off_plane::drift::{DriftError, circle, drift, drift_in, zero_momentum_path};
use stillbase::planning::off_plane::momentum::MomentumModel;
use stillbase::planning::off_plane::null_space::{
    NullSpace, integrability_violation, is_integrable, motion, projected, rates,
};

/// A pose in the middle of the joint limits.
const Q: [f64; 3] = [1.6875182179, 3.7146223682, 2.1801769897];

fn nine_link() -> &'static Machine {
    builtin("nine-link").expect("built in")
}

/// The momentum of an arm on a base that stands still.
fn still(arm: &Inertia) -> MomentumModel {
    MomentumModel::from(arm)
}

/// The nine-link machine with two bars out of balance.
fn unbalanced(com: f64, mass: f64) -> Inertia {
    let (com, mass) = (com.to_string(), mass.to_string());
    let settings = [("link.5.com", com.as_str()), ("link.9.mass", mass.as_str())];
    Inertia::of(&nine_link().set_all(settings).expect("valid"))
}

/// A serial arm in absolute angles; the CM of its last link may lie off its axis.
fn serial(links: usize, off: f64) -> Inertia {
    let mut text = String::from("name = \"serial\"\n");
    for k in 1..=links {
        let attach = match k {
            1 => "\"base\"".into(),
            k => format!("{{ link = \"{}\", at = \"tip\" }}", k - 1),
        };
        let normal = if k == links { off } else { 0.0 };
        text += &format!(
            "[[drive]]\nname = \"{k}\"\n[[link]]\nname = \"{k}\"\ndrive = \"{k}\"\nattach = {attach}\n\
             length = 0.{k}\nmass = {k}.5\ninertia = 0.01\ncom = 0.1\ncom_normal = {normal}\n"
        );
    }
    text += &format!("[end_effector]\nlink = \"{links}\"\n");
    Inertia::of(&parse(&text, "serial").expect("valid"))
}

fn angles(q: &[f64]) -> DriveAngles {
    DriveAngles(PerDrive::from_slice(q).expect("few"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn null_space_is_orthonormal_and_transmits_nothing(
        drives in 2usize..=8, q in prop::collection::vec(-7.0..7.0f64, 8), off in -0.1..0.1f64,
    ) {
        let (model, q) = (serial(drives, off), angles(&q[..drives]));
        let space = NullSpace::of(&still(&model), &q);
        prop_assert_eq!(space.basis().len(), drives - 1);
        for (i, x) in space.basis().iter().enumerate() {
            prop_assert!(angular_momentum(&model, &q.units(), x).abs() < 1e-13);
            for (j, y) in space.basis().iter().enumerate() {
                prop_assert!((x.dot(y) - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
    }

    /// D against the mass matrix, and its rate against differences along the motion.
    #[test]
    fn momentum_row_changes_as_said(
        drives in 2usize..=8, q in prop::collection::vec(-7.0..7.0f64, 8), qd in prop::collection::vec(-2.0..2.0f64, 8),
    ) {
        let model = serial(drives, 0.03);
        let (q, qd) = (angles(&q[..drives]), PerDrive::from_slice(&qd[..drives]).expect("few"));
        let (h, _) = mass_matrix(&model, &q.units(), &qd);
        let d = |s: f64| still(&model).coefficients(&DriveAngles(q.0.plus(s, &qd)).units());
        for k in 0..drives {
            let sum: f64 = (0..drives).map(|l| h.get(l, k)).sum();
            prop_assert!((sum - d(0.0)[k]).abs() < 1e-13);
            let slope = (d(1e-5)[k] - d(-1e-5)[k]) / 2e-5;
            prop_assert!((slope - still(&model).coefficient_rates(&q.units(), &qd)[k]).abs() < 1e-7);
        }
    }

    /// D ∧ dD of three drives is D · curl D, here by differences.
    #[test]
    fn twist_is_d_dot_curl_d(q in [-4.0..4.0f64, -4.0..4.0, -4.0..4.0], com in -0.2..0.2f64, mass in 0.1..1.5f64, off in -0.1..0.1f64) {
        for model in [unbalanced(com, mass), serial(3, off)] {
            let d = |k: usize, h: f64, i: usize| {
                let mut q = q;
                q[k] += h;
                still(&model).coefficients(&angles(&q).units())[i]
            };
            let slope = |k: usize, i: usize| (d(k, 1e-5, i) - d(k, -1e-5, i)) / 2e-5;
            let curl: f64 = [(0, 1, 2), (1, 2, 0), (2, 0, 1)]
                .map(|(i, j, k)| d(0, 0.0, i) * (slope(j, k) - slope(k, j)))
                .iter()
                .sum();
            let got = integrability_violation(&still(&model), &q.into());
            prop_assert!((got - curl.abs()).abs() < 1e-8 * (1.0 + got), "{got} and {curl}");
        }
    }

    /// The three conditions of the source: twist vanishes everywhere exactly with the couplings.
    #[test]
    fn twist_is_the_stated_sum_of_three_sines(q in [-4.0..4.0f64, -4.0..4.0, -4.0..4.0], com in -0.2..0.2f64, mass in 0.1..1.5f64) {
        let model = unbalanced(com, mass);
        let (h, c) = (|k| Vector::new(model.diagonal(k), 0.0), |k, l| model.coupling(k, l));
        let turn = |k: usize, l: usize| stillbase::mechanics::planar::unit(q[l] - q[k]);
        let sum = (h(0) * c(1, 2) - c(1, 0) * c(0, 2)) * turn(1, 2)
            + (h(1) * c(2, 0) - c(2, 1) * c(1, 0)) * turn(2, 0)
            + (h(2) * c(0, 1) - c(0, 2) * c(2, 1)) * turn(0, 1);
        prop_assert!((integrability_violation(&still(&model), &q.into()) - 2.0 * sum.im.abs()).abs() < 1e-12);
    }

    /// Rates of three drives against the solution of the equations they are to solve.
    #[test]
    fn rates_follow_the_tip(a in [0.4..2.7f64, 0.4..2.7], v in [-1.0..1.0f64, -1.0..1.0], momentum in -1.0..1.0f64) {
        let model = unbalanced(0.1, 0.6);
        let q = angles(&[0.4, 0.4 + a[0], 0.4 + a[0] + a[1] - std::f64::consts::PI]);
        let Some(qd) = rates(&still(&model), &q, Vector::new(v[0], v[1]), momentum) else { return Ok(()) };
        let e = q.units();
        prop_assert!((velocity(nine_link().end_effector(), &e, &qd) - Vector::new(v[0], v[1])).norm() < 1e-10);
        prop_assert!((angular_momentum(&model, &e, &qd) - momentum).abs() < 1e-10);
    }

    /// b of two drives stays along motions of zero momentum, however far round, and momentum is (D_1 + D_2) ḃ.
    #[test]
    fn two_drives_have_a_pose_constant(q in [-4.0..4.0f64, -4.0..4.0], way in -9.0..9.0f64, off in -0.15..0.15f64) {
        let model = serial(2, off);
        let integral = BIntegral::of(&model).expect("two drives");
        let slope = |q: [f64; 2]| {
            let d = still(&model).coefficients(&angles(&q).units());
            [-d[1] / (d[0] + d[1]), d[0] / (d[0] + d[1])]
        };
        let n = 2000;
        let h = way / f64::from(n);
        let step = |q: [f64; 2], s: f64, k: [f64; 2]| [q[0] + s * k[0], q[1] + s * k[1]];
        let end = (0..n).fold(q, |q, _| {
            let k1 = slope(q);
            let k2 = slope(step(q, h / 2.0, k1));
            let k3 = slope(step(q, h / 2.0, k2));
            let k4 = slope(step(q, h, k3));
            let k = [0, 1].map(|i| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0);
            step(q, h, k)
        });
        prop_assert!((end[1] - end[0] - (q[1] - q[0]) - way).abs() < 1e-9, "δ went all the way");
        prop_assert!((integral.b(end) - integral.b(q)).abs() < 1e-9, "{} {}", integral.b(end), integral.b(q));

        let qd = [0.7, -1.3];
        let rate = (integral.b(step(q, 1e-5, qd)) - integral.b(step(q, -1e-5, qd))) / 2e-5;
        let momentum = angular_momentum(&model, &angles(&q).units(), &qd.into());
        prop_assert!((momentum - integral.inertia(q) * rate).abs() < 1e-8);
    }
}

/// The closed form against the quadrature that defines it.
#[test]
fn pose_integral_is_its_quadrature() {
    for off in [-0.1, 0.0, 0.08] {
        let model = serial(2, off);
        let integral = BIntegral::of(&model).expect("two drives");
        for delta in [-11.0, -3.2, 0.4, 3.1, 3.2, 7.0] {
            let n = 4000;
            let share = |i: i32| {
                let d =
                    still(&model).coefficients(&angles(&[0.0, delta * (f64::from(i) + 0.5) / f64::from(n)]).units());
                d[1] / (d[0] + d[1])
            };
            let want = 0.3 + delta * (0..n).map(share).sum::<f64>() / f64::from(n);
            assert!((integral.b([0.3, 0.3 + delta]) - want).abs() < 1e-5, "{off}, {delta}");
        }
    }
    // Where the links do not couple it is the linear one.
    let machine = parse(
        "name = \"pair\"\nend_effector = { link = \"2\" }\n[[drive]]\nname = \"1\"\n[[drive]]\nname = \"2\"\n\
         [[link]]\nname = \"1\"\ndrive = \"1\"\nattach = \"base\"\nlength = 0.4\nmass = 2.0\ninertia = 0.03\ncom = 0.1\n\
         [[link]]\nname = \"2\"\ndrive = \"2\"\nattach = \"base\"\nlength = 0.3\nmass = 1.0\ninertia = 0.05\ncom = 0.1\n",
        "pair",
    )
    .expect("valid");
    let model = Inertia::of(&machine);
    let (d, b) = (model.diagonals(), BIntegral::of(&model).expect("two drives"));
    assert!((b.b([1.0, 9.0]) - (d[0] + 9.0 * d[1]) / (d[0] + d[1])).abs() < 1e-14);
    assert_eq!(BIntegral::of(&Inertia::of(nine_link())), None);
}

/// An invariant machine has a b, and so has any with two drives; another has none, and says so in nearly every pose.
#[test]
fn only_invariant_machines_have_a_pose_constant() {
    let poses = || (0..40).map(|i| [0.37, 1.91, 4.23].map(|x| (x * f64::from(i)) % 6.0));
    let most = |model: &Inertia| poses().map(|q| integrability_violation(&still(model), &q.into())).fold(0.0, f64::max);
    let exact = Inertia::of(nine_link());
    assert!(is_integrable(&exact) && most(&exact) < 1e-14);
    assert!(is_integrable(&serial(2, 0.1)));
    assert_eq!(integrability_violation(&still(&serial(2, 0.1)), &[1.0, 2.5].into()), 0.0);
    for model in [unbalanced(0.05, 0.25), unbalanced(-0.011, 0.9), serial(3, 0.0), serial(3, 0.05)] {
        assert!(!is_integrable(&model));
        assert!(most(&model) > 1e-3 * model.invariance_residual(), "{}", most(&model));
    }
    // Four drives: every three of them count.
    let four = serial(4, 0.0);
    assert!(!is_integrable(&four) && integrability_violation(&still(&four), &[0.1, 1.4, 2.9, 4.0].into()) > 1e-3);
}

/// A point mass on a chain without mass: its angular momentum is m r² θ̇, so that its bearing θ is a pose constant.
#[test]
fn a_point_mass_has_its_bearing() {
    let bar = |k: usize, attach: &str, mass: f64| {
        format!(
            "[[link]]\nname = \"{k}\"\ndrive = \"{k}\"\nattach = {attach}\nlength = 0.{k}\nmass = {mass}\n\
             inertia = 0\ncom = 0.{k}\n"
        )
    };
    let text = [
        "name = \"chain\"\nend_effector = { link = \"3\" }\n".into(),
        (1..=3).map(|k| format!("[[drive]]\nname = \"{k}\"\n")).collect(),
        bar(1, "\"base\"", 1e-13),
        bar(2, "{ link = \"1\" }", 1e-13),
        bar(3, "{ link = \"2\" }", 2.0),
    ]
    .concat();
    let machine = parse(&text, "chain").expect("valid");
    let model = Inertia::of(&machine);
    assert!(is_integrable(&model) && !model.is_invariant());
    assert!(integrability_violation(&still(&model), &[0.3, 1.9, 3.1].into()) < 1e-12);
    let mut q = angles(&[0.3, 1.2, 1.9]);
    let bearing = |q: &DriveAngles| end_effector(machine.end_effector(), &q.units()).arg();
    let from = bearing(&q);
    let mut last = NullSpace::of(&still(&model), &q).basis()[0];
    for _ in 0..1000 {
        // The basis may turn round from pose to pose.
        let mut way = |q: &DriveAngles| {
            let way = NullSpace::of(&still(&model), q).basis()[0];
            last = way.scaled(way.dot(&last).signum());
            last
        };
        let first = way(&q);
        let middle = DriveAngles(q.0.plus(5e-4, &first));
        q.0 = q.0.plus(1e-3, &way(&middle));
    }
    let moved = q.0.minus(&[0.3, 1.2, 1.9].into()).max_abs();
    assert!(moved > 0.1 && (bearing(&q) - from).abs() < 2e-5, "{moved} {:e}", bearing(&q) - from);
}

fn round(radius: f64) -> impl Fn(f64) -> stillbase::planning::curves::CurvePoint + Clone {
    let at = end_effector(nine_link().end_effector(), &DriveAngles::from(Q).units());
    circle(at + Vector::new(radius, 0.0), at)
}

#[test]
fn an_invariant_machine_comes_back() {
    let drift = drift(&still(&Inertia::of(nine_link())), Q.into(), round(0.08), 10).expect("regular");
    assert_eq!(drift.ends.len(), 11);
    for end in &drift.ends {
        assert!(end.0.minus(&PerDrive::from(Q)).max_abs() < 1e-9, "{end:?}");
    }
}

/// Ten times round, and the joints have moved on by about as much each time.
#[test]
fn another_machine_drifts() {
    let model = unbalanced(0.1, 0.6);
    let drift = drift(&still(&model), Q.into(), round(0.08), 10).expect("regular");
    let steps: Vec<f64> = drift.ends.windows(2).map(|w| w[1].0.minus(&w[0].0).max_abs()).collect();
    assert!(steps.iter().all(|step| *step > 1e-3), "{steps:?}");
    assert!(drift.total().max_abs() > 5.0 * steps[0], "{steps:?}: it adds up");
    let tip = nine_link().end_effector();
    let at = end_effector(tip, &drift.ends[0].units());
    assert!(drift.ends.iter().all(|q| (end_effector(tip, &q.units()) - at).norm() < 1e-12));

    // Halving the step leaves a sixteenth of the error or less: on a closed path much of it cancels.
    let end = |spaces| drift_in(&still(&model), Q.into(), round(0.08), 2, spaces).expect("regular").total();
    let exact = end(256);
    let errors = [8, 16, 32].map(|spaces| end(spaces).minus(&exact).max_abs());
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 3.6, "{order}: {errors:?}");
    }
    assert!(end(128).minus(&exact).max_abs() < 1e-10);
}

/// By Stokes' theorem what a small loop leaves behind goes with its area.
#[test]
fn drift_goes_with_the_area() {
    let model = unbalanced(0.1, 0.6);
    let left = |radius: f64| drift(&still(&model), Q.into(), round(radius), 1).expect("regular").total().max_abs();
    let (large, small) = (left(4e-3), left(2e-3));
    assert!((large / small - 4.0).abs() < 0.1, "{large:e} {small:e}");
    // The other way round it comes back to where it was.
    let there = drift(&still(&model), Q.into(), round(0.05), 1).expect("regular").ends[1];
    let curve = round(0.05);
    let back = move |s: f64| {
        let at = curve(1.0 - s);
        stillbase::planning::curves::CurvePoint { first: -at.first, ..at }
    };
    let home = drift(&still(&model), there, back, 1).expect("regular").ends[1];
    assert!(home.0.minus(&PerDrive::from(Q)).max_abs() < 1e-10);
}

/// A simulation can run the table by any law: the tip is on the circle, momentum and moment are zero.
#[test]
fn a_cycle_is_a_path_of_zero_moment() {
    let model = unbalanced(0.1, 0.6);
    let table = zero_momentum_path(&still(&model), Q.into(), round(0.08)).expect("regular");
    let curve = round(0.08);
    for i in 0..=1000 {
        let s = f64::from(i) / 1000.0;
        let at = table.at(s);
        let e = at.q.units();
        assert!((end_effector(nine_link().end_effector(), &e) - curve(s).p).norm() < 1e-10, "s = {s}");
        assert!(angular_momentum(&model, &e, &at.first).abs() < 1e-8, "s = {s}");
        let (rate, acceleration) = (1.7, -2.3);
        let qdd = at.second.scaled(rate * rate).plus(acceleration, &at.first);
        let wrench = base_wrench(&model, &e, &at.first.scaled(rate), &qdd, &ExternalLoads::default());
        assert!(wrench.total().moment.abs() < 1e-6, "s = {s}: {:e}", wrench.total().moment);
    }
    for node in table.nodes() {
        let wrench = base_wrench(&model, &node.q.units(), &node.first, &node.second, &ExternalLoads::default());
        assert!(wrench.total().moment.abs() < 1e-12, "{:e}", wrench.total().moment);
    }
}

/// Along the null space, with any number of drives: no momentum, no moment, and as near to the wanted way as can be.
#[test]
fn motions_along_the_null_space_transmit_nothing() {
    for drives in [2, 3, 5] {
        let (model, start) = (serial(drives, 0.04), angles(&[0.1, 1.4, 2.9, 4.0, 0.7][..drives]));
        let w = PerDrive::from_slice(&[1.1, -0.7, 1.9, 0.4, -1.3][..drives]).expect("few");
        let table = motion(&still(&model), start, &w).expect("of this machine");
        assert!(table.at(1.0).q.0.minus(&start.0).max_abs() > 0.5, "it goes somewhere");
        for node in table.nodes() {
            let e = node.q.units();
            assert!(angular_momentum(&model, &e, &node.first).abs() < 1e-13);
            let wrench = base_wrench(&model, &e, &node.first, &node.second, &ExternalLoads::default());
            assert!(wrench.total().moment.abs() < 1e-12, "{:e}", wrench.total().moment);
            // What was taken away is at right angles to every other direction of the null space.
            let gone = w.minus(&projected(&still(&model), &node.q, &w));
            assert!(NullSpace::of(&still(&model), &node.q).basis().iter().all(|x| x.dot(&gone).abs() < 1e-13));
        }
        for i in 1..50 {
            let (s, h) = (f64::from(i) / 50.0, 1e-4);
            let [back, on, ahead] = [s - h, s, s + h].map(|s| table.at(s));
            let rate = ahead.q.0.minus(&back.q.0).scaled(0.5 / h);
            assert!(rate.minus(&on.first).max_abs() < 1e-5, "{drives} drives, s = {s}");
            assert!(projected(&still(&model), &on.q, &w).minus(&on.first).max_abs() < 1e-8, "{drives} drives, s = {s}");
        }
        if let Some(integral) = BIntegral::of(&model) {
            let b = table.nodes().iter().map(|node| integral.b([node.q[0], node.q[1]]));
            assert!(b.clone().all(|b| (b - integral.b([start[0], start[1]])).abs() < 1e-10));
        }
    }
    let straight =
        motion(&still(&Inertia::of(nine_link())), Q.into(), &[0.3, -0.4, 1.0].into()).expect("of this machine");
    let way = straight.at(1.0).q.0.minus(&PerDrive::from(Q));
    assert!(straight.at(0.3).q.0.minus(&PerDrive::from(Q).plus(0.3, &way)).max_abs() < 1e-12);
    assert_eq!(motion(&still(&serial(2, 0.0)), Q.into(), &[0.0; 3].into()), None);
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let model = unbalanced(0.1, 0.6);
    assert_eq!(drift(&still(&serial(2, 0.0)), [0.0; 2].into(), round(0.1), 1), Err(DriftError::Drives { drives: 2 }));
    let away = circle(Vector::new(0.5, 0.5), Vector::new(0.7, 0.5));
    assert!(matches!(drift(&still(&model), Q.into(), away, 1), Err(DriftError::Start { miss }) if miss > 0.1));
    let half = |s: f64| round(0.08)(0.5 * s);
    assert!(
        matches!(drift(&still(&model), Q.into(), half, 1), Err(DriftError::Open { gap }) if (gap - 0.16).abs() < 1e-9)
    );
    // A circle that leaves the arm's reach.
    let error = drift(&still(&model), Q.into(), round(1.0), 1).expect_err("too large").to_string();
    assert!(
        error.contains("no rates of zero momentum follow it: a dynamic singularity") && error.contains("% along"),
        "{error}"
    );
    // Of more drives than three, the basis still spans all that D leaves, and the rates are the least of those.
    let (four, q) = (serial(4, 0.02), angles(&[0.1, 1.4, 2.9, 4.0]));
    let own = rates(&still(&four), &q, Vector::new(0.3, -0.1), 0.0).expect("four drives can");
    let (e, lengths) = (q.units(), [0.1, 0.2, 0.3, 0.4]);
    let moved: Vector = (0..4).map(|k| Vector::new(0.0, lengths[k] * own[k]) * e[k]).sum();
    assert!((moved - Vector::new(0.3, -0.1)).norm() < 1e-12);
    assert!(still(&four).coefficients(&q.units()).dot(&own).abs() < 1e-12);
    assert_eq!(rates(&still(&serial(2, 0.0)), &angles(&[0.1, 1.4]), Vector::default(), 0.0), None);
    let space = NullSpace::of(&still(&four), &q);
    let columns: Vec<DVector<f64>> = space.basis().iter().map(|x| DVector::from_row_slice(x)).collect();
    assert_eq!(DMatrix::from_columns(&columns).rank(1e-9), 3);
}
