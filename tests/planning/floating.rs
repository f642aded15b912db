//! The momentum of an arm on a free base that keeps its orientation, against sums over its bodies.

use proptest::prelude::*;
use stillbase::mechanics::arm_on_base::FloatingBase;
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use stillbase::planning::curves::Curve;
use stillbase::planning::off_plane::drift::zero_momentum_curve;
use stillbase::planning::off_plane::momentum::{MomentumModel, TipFrame};
use stillbase::planning::off_plane::null_space::rates;

use crate::mechanics::arm_on_base::{Bar, arm, bar};

/// Returns sums over the bodies for rates q̇, with linear momentum 0 and a base that does not turn: the angular momentum
/// about the common centre of mass, kg m²/s, and the velocities of base pin and end effector in space, m/s.
fn by_bodies(bars: &[Bar], base: &FloatingBase, q: &[f64], qd: &[f64]) -> (f64, Vector, Vector) {
    let i = Vector::new(0.0, 1.0);
    let (mut root, mut root_rate) = (Vector::default(), Vector::default());
    let mut bodies = vec![(base.mass, base.com, Vector::default())];
    let mut spin = 0.0;
    for ([length, mass, inertia, com, normal], (q, qd)) in bars.iter().zip(q.iter().zip(qd)) {
        let e = unit(*q);
        let centre = Vector::new(*com, *normal) * e;
        bodies.push((*mass, root + centre, root_rate + i * centre * *qd));
        root += *length * e;
        root_rate += i * e * (length * qd);
        spin += inertia * qd;
    }
    let whole: f64 = bodies.iter().map(|(m, ..)| m).sum();
    let centre = bodies.iter().map(|(m, r, _)| *m * *r).sum::<Vector>() / whole;
    let shift = -bodies.iter().map(|(m, _, v)| *m * *v).sum::<Vector>() / whole;
    let orbit: f64 = bodies.iter().map(|(m, r, v)| m * ((r - centre).conj() * (v + shift)).im).sum();
    (orbit + spin, shift, root_rate + shift)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn momentum_is_that_of_the_bodies(
        bars in prop::collection::vec(bar(), 1..=8), mass in 0.5..200.0f64, com in [-0.5..0.5f64, -0.5..0.5f64],
        q in prop::collection::vec(-7.0..7.0f64, 8), qd in prop::collection::vec(-2.0..2.0f64, 8),
    ) {
        let n = bars.len();
        let (base, model) = (FloatingBase { mass, inertia: 1.0, com: Vector::new(com[0], com[1]) }, arm(&bars));
        let (pose, rate) = (angles(&q[..n]), PerDrive::from_slice(&qd[..n]).expect("few"));
        let floating = MomentumModel::floating(&model, &base, TipFrame::Space, &pose);
        let e = pose.units();
        let (momentum, shift, tip_rate) = by_bodies(&bars, &base, &q[..n], &qd[..n]);
        prop_assert!((floating.coefficients(&e).dot(&rate) - momentum).abs() < 1e-10, "{momentum}");
        let at = |s: f64| DriveAngles(pose.0.plus(s, &rate));
        let along = |of: &dyn Fn(f64) -> Vector| (of(1e-5) - of(-1e-5)) / 2e-5;
        prop_assert!((along(&|s| floating.place(&at(s))) - tip_rate).norm() < 1e-7);
        let seen = MomentumModel::floating(&model, &base, TipFrame::Base, &pose);
        prop_assert!((along(&|s| floating.place(&at(s)) - seen.place(&at(s))) - shift).norm() < 1e-7);
        prop_assert!((floating.place(&pose) - seen.place(&pose)).norm() < 1e-12);
        let ahead = |s: f64| floating.coefficients(&at(s).units());
        for k in 0..n {
            let slope = (ahead(1e-5)[k] - ahead(-1e-5)[k]) / 2e-5;
            prop_assert!((slope - floating.coefficient_rates(&e, &rate)[k]).abs() < 1e-6);
        }
        if n >= 3 && let Some(rates) = rates(&floating, &pose, Vector::new(0.3, -0.2), 0.0) {
            let (momentum, _, tip_rate) = by_bodies(&bars, &base, &q[..n], &rates);
            let most = 1.0 + rates.max_abs();
            prop_assert!(momentum.abs() < 1e-9 * most * most && (tip_rate - Vector::new(0.3, -0.2)).norm() < 1e-9 * most);
        }
    }

    /// A base that weighs without bound stands still.
    #[test]
    fn a_heavy_base_is_a_fixed_one(bars in prop::collection::vec(bar(), 3..=5), q in prop::collection::vec(-7.0..7.0f64, 5)) {
        let (n, model) = (bars.len(), arm(&bars));
        let base = FloatingBase { mass: 1e12, inertia: 1e12, com: Vector::default() };
        let (pose, still) = (angles(&q[..n]), MomentumModel::from(&model));
        let heavy = MomentumModel::floating(&model, &base, TipFrame::Space, &pose);
        let e = pose.units();
        prop_assert!(heavy.coefficients(&e).minus(&still.coefficients(&e)).max_abs() < 1e-9);
        prop_assert!((heavy.place(&pose) - still.place(&pose)).norm() < 1e-9);
    }
}

fn angles(q: &[f64]) -> DriveAngles {
    DriveAngles(PerDrive::from_slice(q).expect("few"))
}

/// Carleton's planar arm on an air bearing: straight lines at zero momentum, with the end angles of an independent
/// integration to 1e-12, the end effector as seen from the base pin.
#[test]
fn lines_of_the_arm_on_an_air_bearing_end_where_they_should() {
    let bars = [
        [0.3045, 0.345, 0.003704, 0.196822],
        [0.3045, 0.335, 0.003506, 0.198152],
        [0.08725, 0.111, 0.000106, 0.062097],
    ]
    .map(|[length, mass, inertia, com]| [length, mass, inertia, com, 0.0]);
    let model = arm(&bars);
    let com = -Vector::new(0.0680112181717378, 0.24212956077851439);
    let base = FloatingBase { mass: 11.211, inertia: 0.20215, com };
    let lines = [
        (
            [1.9, 2.6, 3.4],
            [0.15, 0.05],
            [2.6958044856371743, 1.3816740424231353, 2.633332376333862],
            [2.665687445028911, 1.381832906737599, 2.7383367573718824],
        ),
        (
            [1.2, 0.4, -0.6],
            [-0.12, 0.1],
            [0.478718085768398, 1.6176929806971474, 0.09974239107843176],
            [0.42067173585810647, 1.6325017796863623, 0.2887936233632532],
        ),
    ];
    for (start, by, free, fixed) in lines {
        let start = DriveAngles::from(start);
        let floating = MomentumModel::floating(&model, &base, TipFrame::Base, &start);
        for (model, end) in [(floating, free), (MomentumModel::from(&model), fixed)] {
            let from = model.place(&start);
            let line =
                Curve::polyline(&[from, from + Vector::new(by[0], by[1])], false, 0.0).expect("a line").remove(0);
            let table = zero_momentum_curve(&model, start, &line, 1).expect("regular");
            let q = table.nodes().last().expect("it has nodes").q;
            assert!(q.0.minus(&PerDrive::from(end)).max_abs() < 1e-9, "{q:?} for {end:?}");
        }
    }
}
