//! Curves: they go through their points, their derivatives are their own, and pieces join as they should.

use proptest::prelude::*;
use stillbase::mechanics::planar::Vector;
use stillbase::planning::curves::{Curve, CurveError};

fn v(x: f64, y: f64) -> Vector {
    Vector::new(x, y)
}

/// First and second derivative against central differences of the point, away from joints.
fn assert_derivatives(curve: &Curve) {
    let joints: Vec<f64> = curve.joints().collect();
    for i in 1..40 {
        let (s, h) = (f64::from(i) / 40.0, 1e-5);
        if joints.iter().any(|j| (j - s).abs() < 2.0 * h) {
            continue;
        }
        let [before, at, after] = [s - h, s, s + h].map(|s| curve.at(s));
        let first = (after.p - before.p) / (2.0 * h);
        let second = (after.first - before.first) / (2.0 * h);
        assert!((first - at.first).norm() < 1e-6 * (1.0 + at.second.norm()), "s {s}: {first} {}", at.first);
        assert!((second - at.second).norm() < 1e-5 * (1.0 + at.second.norm()) / 1e-1, "s {s}: {second} {}", at.second);
    }
}

/// Place, slope and curvature agree from both sides of each joint.
fn assert_joins(curve: &Curve) {
    for s in curve.joints().filter(|s| *s > 0.0 && *s < 1.0) {
        let [before, after] = [s - 1e-10, s + 1e-10].map(|s| curve.at(s));
        assert!((before.p - after.p).norm() < 1e-7);
        assert!((before.first - after.first).norm() < 1e-5, "{} {}", before.first, after.first);
        let scale = 1.0 + before.second.norm();
        assert!((before.second - after.second).norm() < 1e-4 * scale, "{} {}", before.second, after.second);
    }
}

#[test]
fn an_arc_is_a_part_of_a_circle_through_its_points() {
    // On the circle about (0.2, −0.1) with radius 0.5.
    let on = |angle: f64| v(0.2, -0.1) + 0.5 * v(angle.cos(), angle.sin());
    for (angles, closed) in [([0.3, 1.0, 2.5], false), ([2.5, 1.0, 0.3], false), ([0.3, 1.0, -2.0], true)] {
        let points = angles.map(on);
        let arc = Curve::arc(points, closed).expect("a circle");
        let length = if closed { std::f64::consts::TAU * 0.5 } else { 0.5 * 2.2 };
        assert!((arc.length() - length).abs() < 1e-12, "{}", arc.length());
        assert!((arc.at(0.0).p - points[0]).norm() < 1e-12);
        assert!((arc.at(1.0).p - points[if closed { 0 } else { 2 }]).norm() < 1e-12);
        let passes = (0..=2000).map(|i| (arc.at(f64::from(i) / 2000.0).p - points[1]).norm()).fold(1.0, f64::min);
        assert!(passes < 1e-3);
        for i in 0..=20 {
            let at = arc.at(f64::from(i) / 20.0);
            assert!(((at.p - v(0.2, -0.1)).norm() - 0.5).abs() < 1e-12);
        }
        assert_derivatives(&arc);
    }
    let line = [v(0.0, 0.0), v(0.5, 0.5), v(1.0, 1.0)];
    assert_eq!(Curve::arc(line, false), Err(CurveError::Collinear));
}

#[test]
fn a_closed_spline_has_no_seam() {
    let points: Vec<Vector> = (0..7).map(|i| f64::from(i) * 0.9).map(|t| v(t.cos(), 0.6 * t.sin())).collect();
    let spline = Curve::spline(&points, true).expect("points apart");
    let [start, end] = [spline.at(0.0), spline.at(1.0)];
    assert!((start.p - end.p).norm() < 1e-12);
    assert!((start.first - end.first).norm() < 1e-10);
    assert!((start.second - end.second).norm() < 1e-8, "{} {}", start.second, end.second);
    assert_joins(&spline);
    for (joint, p) in spline.joints().zip(&points) {
        assert!((spline.at(joint).p - p).norm() < 1e-12);
    }
}

#[test]
fn natural_splines_end_without_curvature_and_reproduce_lines() {
    let bent = Curve::spline(&[v(0.0, 0.0), v(0.4, 0.3), v(0.9, 0.1), v(1.0, 0.8)], false).expect("apart");
    assert!(bent.at(0.0).second.norm() < 1e-12 && bent.at(1.0).second.norm() < 1e-9);
    assert_joins(&bent);
    assert_derivatives(&bent);
    let straight = Curve::spline(&[v(0.0, 0.0), v(0.1, 0.2), v(0.4, 0.8), v(0.5, 1.0)], false).expect("apart");
    for i in 0..=10 {
        let s = f64::from(i) / 10.0;
        assert!((straight.at(s).p - v(0.5, 1.0) * s).norm() < 1e-12);
    }
}

/// A spline through more and more points of a smooth closed curve nears it with the fourth power of their distance.
#[test]
fn splines_converge_with_the_fourth_power() {
    let on = |t: f64| v((std::f64::consts::TAU * t).cos(), 0.5 * (std::f64::consts::TAU * t).sin());
    let miss = |n: usize| {
        let points: Vec<Vector> = (0..n).map(|i| on(i as f64 / n as f64)).collect();
        let spline = Curve::spline(&points, true).expect("apart");
        let dense: Vec<Vector> = (0..20_000).map(|i| on(f64::from(i) / 20_000.0)).collect();
        (0..200)
            .map(|i| spline.at(f64::from(i) / 200.0).p)
            .map(|p| dense.iter().map(|q| (p - q).norm_sqr()).fold(f64::INFINITY, f64::min).sqrt())
            .fold(0.0, f64::max)
    };
    let [coarse, fine] = [12, 24].map(miss);
    let order = (coarse / fine).log2();
    assert!((3.5..5.0).contains(&order), "order {order}, {coarse} {fine}");
}

#[test]
fn corners_stop_or_blend() {
    let corners = [v(0.0, 0.0), v(0.4, 0.0), v(0.4, 0.3), v(0.0, 0.3)];
    let stopping = Curve::polyline(&corners, false, 0.0).expect("apart");
    assert_eq!(stopping.len(), 3);
    for (curve, w) in stopping.iter().zip(corners.windows(2)) {
        assert!((curve.at(0.0).p - w[0]).norm() < 1e-15 && (curve.at(1.0).p - w[1]).norm() < 1e-15);
    }
    let blended = Curve::polyline(&corners, false, 0.05).expect("apart");
    assert_eq!(blended.len(), 1);
    assert_joins(&blended[0]);
    assert_derivatives(&blended[0]);
    // Never farther from the lines than where the blend begins.
    let miss = (0..=1000).map(|i| blended[0].at(f64::from(i) / 1000.0).p).map(|p| {
        let to = |a: Vector, b: Vector| {
            let t = (((p - a) / (b - a)).re).clamp(0.0, 1.0);
            (p - a - (b - a) * t).norm()
        };
        corners.windows(2).map(|w| to(w[0], w[1])).fold(f64::INFINITY, f64::min)
    });
    let farthest = miss.fold(0.0, f64::max);
    assert!(farthest > 1e-3 && farthest < 0.05, "{farthest}");
    // A line that turns back must stop there, blend or not.
    let back = Curve::polyline(&[v(0.0, 0.0), v(0.4, 0.0), v(0.1, 0.0)], false, 0.05).expect("apart");
    assert_eq!(back.len(), 2);
    // A straight corner is none.
    let straight = Curve::polyline(&[v(0.0, 0.0), v(0.4, 0.0), v(0.9, 0.0)], false, 0.0).expect("apart");
    assert_eq!(straight.len(), 1);
    // Closed, it comes back.
    let closed = Curve::polyline(&corners, true, 0.0).expect("apart");
    assert_eq!(closed.len(), 4);
    assert!((closed[3].at(1.0).p - corners[0]).norm() < 1e-15);
}

/// A trembling hand: the curve keeps to what was meant, and bends less than the tremble did.
#[test]
fn freehand_takes_the_tremble_out() {
    let mut seed = 1_u64;
    let mut tremble = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((seed >> 33) as f64 / f64::from(u32::MAX) - 0.25) * 0.004
    };
    let meant = |t: f64| v(0.5 + 0.2 * (3.0 * t).cos(), 0.6 + 0.2 * (3.0 * t).sin());
    let drawn: Vec<Vector> = (0..=300).map(|i| meant(f64::from(i) / 300.0) + v(tremble(), tremble())).collect();
    let curve = Curve::freehand(&drawn, false).expect("long enough");
    assert!((curve.at(0.0).p - drawn[0]).norm() < 1e-12 && (curve.at(1.0).p - drawn[300]).norm() < 1e-9);
    for i in 0..=100 {
        let p = curve.at(f64::from(i) / 100.0).p;
        let miss = (0..=600).map(|j| (meant(f64::from(j) / 600.0) - p).norm()).fold(f64::INFINITY, f64::min);
        assert!(miss < 0.006, "{i}: {miss}");
    }
    // Total turning of the drawn line, and of the curve: three radians were meant.
    let turning = |points: &[Vector]| {
        let d: Vec<Vector> = points.windows(2).map(|w| w[1] - w[0]).filter(|d| d.norm() > 0.0).collect();
        d.windows(2).map(|w| (w[1] / w[0]).arg().abs()).sum::<f64>()
    };
    let smooth: Vec<Vector> = (0..=300).map(|i| curve.at(f64::from(i) / 300.0).p).collect();
    assert!(turning(&smooth) < 4.5, "{}", turning(&smooth));
    assert!(turning(&drawn) > 20.0);
}

#[test]
fn what_is_no_curve_is_said() {
    let nan = [v(0.0, 0.0), v(f64::NAN, 1.0)];
    assert_eq!(Curve::polyline(&nan, false, 0.0), Err(CurveError::NotFinite(1)));
    assert_eq!(Curve::spline(&[v(1.0, 0.0), v(1.0, 0.0)], false), Err(CurveError::Coincident(0, 1)));
    assert!(matches!(Curve::spline(&[v(1.0, 0.0)], false), Err(CurveError::Count { got: 1, .. })));
    assert!(matches!(Curve::freehand(&[v(1.0, 0.0); 9], false), Err(CurveError::Count { got: 1, .. })));
    let words = Curve::arc([v(0.0, 0.0), v(0.0, 0.0), v(1.0, 0.0)], false).expect_err("no").to_string();
    assert!(words.contains("points 1 and 2"), "{words}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Blended polylines through any points join smoothly and begin and end where they should.
    #[test]
    fn blends_are_smooth(
        way in prop::collection::vec((0.05..0.8_f64, 0.01..2.8_f64, any::<bool>()), 2..7), blend in 0.02..0.4,
    ) {
        let (mut points, mut heading) = (vec![v(0.3, -0.2)], 0.4_f64);
        for (step, turn, left) in way {
            heading += if left { turn } else { -turn };
            points.push(points[points.len() - 1] + step * v(heading.cos(), heading.sin()));
        }
        let curves = Curve::polyline(&points, false, blend).expect("apart");
        prop_assert_eq!(curves.len(), 1);
        assert_joins(&curves[0]);
        prop_assert!((curves[0].at(0.0).p - points[0]).norm() < 1e-12);
        prop_assert!((curves[0].at(1.0).p - points[points.len() - 1]).norm() < 1e-12);
    }

    /// The point of a curve found nearest to one of its own points is that point.
    #[test]
    fn nearest_finds_the_point(t in 0.0..1.0) {
        let curve = Curve::spline(&[v(0.0, 0.0), v(0.4, 0.3), v(0.9, 0.1), v(1.0, 0.8)], false).expect("apart");
        let s = curve.nearest(curve.at(t).p, 200);
        prop_assert!((curve.at(s).p - curve.at(t).p).norm() < 1e-4);
    }
}
