//! Curves followed on a plane: exactly, on one sheet, and refused with the truth about where and why.

use std::sync::Arc;

use proptest::prelude::*;
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Machine, builtin};
use stillbase::mechanics::planar::{PerDrive, Vector};
use stillbase::planning::curves::{Curve, PathTable};
use stillbase::planning::following::{Blocked, Rule, SheetEnd, trace};
use stillbase::planning::pose_space::Planes;

const B: f64 = 2.4;

fn machine() -> &'static Machine {
    builtin("nine-link").expect("built in")
}

fn planes() -> Arc<Planes> {
    crate::support::planes(machine())
}

fn wide() -> Arc<Planes> {
    let settings = [("limits.a1", "-3.1,3.1"), ("limits.a2", "-3.1,3.1")];
    crate::support::planes(&machine().set_all(settings).expect("valid"))
}

fn v(x: f64, y: f64) -> Vector {
    Vector::new(x, y)
}

fn follow(planes: &Planes, curves: &[Curve], b: f64) -> Result<Vec<PathTable>, Box<Blocked>> {
    trace::follow(planes.map(), curves, b, None, Rule::default())
}

/// The end effector is on the curve, b is kept, and derivatives are those of q(s).
fn assert_follows(table: &PathTable, curve: &Curve, b: f64) {
    let lambda = planes().map().lambda();
    for i in 0..=400 {
        let s = f64::from(i) / 400.0;
        let at = table.at(s);
        let miss = (end_effector(machine().end_effector(), &at.q.units()) - curve.at(s).p).norm();
        assert!(miss < 1e-10, "s {s}: {miss}");
        let kept = |x: &PerDrive| x.iter().zip(lambda).map(|(x, l)| l * x).sum::<f64>();
        assert!((kept(&at.q.0) - b).abs() < 1e-12, "s {s}");
        assert!(kept(&at.first).abs() < 1e-11 && kept(&at.second).abs() < 1e-8);
        let h = 1e-5;
        if s > h && s < 1.0 - h {
            let first = table.at(s + h).q.0.minus(&table.at(s - h).q.0).scaled(0.5 / h);
            assert!(first.minus(&at.first).max_abs() < 1e-5 * (1.0 + at.second.max_abs()), "s {s}");
        }
    }
}

#[test]
fn lines_arcs_and_splines_are_followed_exactly() {
    let shapes = [
        Curve::line(v(0.50, 0.50), v(0.55, 0.90)),
        Curve::arc([v(0.50, 0.50), v(0.60, 0.70), v(0.55, 0.90)], false).expect("a circle"),
        Curve::spline(&[v(0.50, 0.50), v(0.58, 0.66), v(0.5, 0.8), v(0.55, 0.90)], false).expect("apart"),
    ];
    for curve in shapes {
        let tables = follow(&planes(), std::slice::from_ref(&curve), B).expect("inside the workspace");
        assert_follows(&tables[0], &curve, B);
    }
}

/// A closed curve on a plane brings the joints back to where they were.
#[test]
fn a_closed_curve_closes_in_joint_space() {
    let circle = Curve::arc([v(0.60, 0.60), v(0.52, 0.68), v(0.44, 0.60)], true).expect("a circle");
    let tables = follow(&planes(), std::slice::from_ref(&circle), B).expect("inside");
    assert_follows(&tables[0], &circle, B);
    assert!(tables[0].at(1.0).q.0.minus(&tables[0].at(0.0).q.0).max_abs() < 1e-10);
}

/// Corners that stop make one table each, end to end.
#[test]
fn polylines_join() {
    let corners = [v(0.50, 0.50), v(0.60, 0.70), v(0.50, 0.80), v(0.55, 0.90)];
    let curves = Curve::polyline(&corners, false, 0.0).expect("apart");
    let tables = follow(&planes(), &curves, B).expect("inside");
    assert_eq!(tables.len(), 3);
    for w in tables.windows(2) {
        assert!(w[0].at(1.0).q.0.minus(&w[1].at(0.0).q.0).max_abs() < 1e-12);
    }
}

/// A line out of the workspace is stopped where it crosses the boundary, for the reason that the boundary there has.
#[test]
fn a_line_out_of_the_workspace_stops_at_the_boundary() {
    let planes = planes();
    let line = Curve::line(v(0.50, 0.50), v(1.2, 0.9));
    let blocked = follow(&planes, std::slice::from_ref(&line), B).expect_err("too far");
    assert!(blocked.leaves_workspace);
    let inside = |s: f64| planes.boundary().contains(line.at(s).p, B);
    assert!(inside(blocked.s - 1e-6) && !inside(blocked.s + 1e-6), "{}", blocked.s);
    let at = planes.boundary().nearest(line.at(blocked.s + 1e-4).p, B, line.at(blocked.s).p);
    let stillbase::planning::reactionless::BoundaryCurve::Limit { angle, upper } = at.curve else {
        panic!("no folds here")
    };
    assert_eq!(blocked.stop, SheetEnd::Limit { angle, upper });
    let longest = blocked.longest.expect("a part is inside");
    assert!(longest[0] == 0.0 && (longest[1] - blocked.s).abs() < 1e-6, "{longest:?}");
    // (1.2, 0.9) is 1.5 m away; the arms are 1.2 m long.
    assert_eq!(blocked.nearest_b, None);
    assert!(!blocked.some_b_reaches_all);
    assert!(blocked.to_string().contains("boundary of the reactionless workspace"), "{blocked}");
}

/// Where another b would do, it is named, it does, and none nearer does.
#[test]
fn the_nearest_b_that_would_do_is_found() {
    let planes = planes();
    let line = [Curve::line(v(0.50, 0.50), v(0.55, 0.90))];
    for b in [1.9, 2.9] {
        let blocked = follow(&planes, &line, b).expect_err("not this b");
        let nearest = blocked.nearest_b.expect("2.4 does");
        assert!(follow(&planes, &line, nearest).is_ok());
        let back = nearest + 2e-4 * (b - nearest).signum();
        assert!(follow(&planes, &line, back).is_err(), "{nearest}");
    }
}

/// Through a fold a line cannot be followed, though poses wait on the other side; a joint line could.
#[test]
fn folds_stop_a_curve_inside_the_workspace() {
    let planes = wide();
    let map = planes.map();
    let mut folds = 0;
    for i in 0..100 {
        let angle = f64::from(i) * 0.0628;
        let curve = Curve::line(v(0.50, 0.50), v(0.50, 0.50) + 0.9 * v(angle.cos(), angle.sin()));
        let Err(blocked) = follow(&planes, std::slice::from_ref(&curve), B) else { continue };
        if blocked.stop != SheetEnd::Fold {
            continue;
        }
        folds += 1;
        // The sheet that got farthest ends where det = 0: some pose there has almost none.
        let least = map.poses(curve.at(blocked.s - 1e-9).p, B).iter().map(|x| map.det(x.a).abs()).fold(1.0, f64::min);
        assert!(least < 1e-3, "{least}");
    }
    assert!(folds >= 5, "{folds}");
}

#[test]
fn change_points_stop_only_who_keeps_off_them() {
    let planes = planes();
    let map = planes.map();
    // Across a_1 + a_2 = π: q_3 passes q_1.
    let [from, to] = [[1.0, 1.6], [1.6, 2.0]].map(|a| map.forward(a, B));
    let line = [Curve::line(from, to)];
    assert!(trace::follow(map, &line, B, None, Rule::default()).is_ok());
    let rule = Rule { keep_off_change_points: true };
    let blocked = trace::follow(map, &line, B, None, rule).expect_err("crosses it");
    assert_eq!(blocked.stop, SheetEnd::ChangePoint { drives: [0, 2] });
    let a = map.poses(line[0].at(blocked.s).p, B)[0].a;
    assert!((a[0] + a[1] - std::f64::consts::PI).abs() < 1e-7, "{a:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A random segment can be followed if and only if all its points lie in the workspace, which has one sheet here.
    #[test]
    fn on_one_sheet_a_line_is_feasible_iff_it_stays_inside(
        x in prop::array::uniform2(-0.3..0.8), y in prop::array::uniform2(-0.3..1.2),
    ) {
        let planes = planes();
        let line = Curve::line(v(x[0], y[0]), v(x[1], y[1]));
        let inside = |s: f64| planes.boundary().contains(line.at(s).p, B);
        let all = (0..=600).all(|i| inside(f64::from(i) / 600.0));
        let feasible = trace::is_feasible(planes.map(), std::slice::from_ref(&line), B, Rule::default());
        if feasible != all {
            // Only a graze of the boundary between two of the points may be missed by them.
            let blocked = follow(&planes, std::slice::from_ref(&line), B);
            let s = blocked.err().map_or(0.5, |x| x.s);
            prop_assert!(!feasible && inside(s - 1e-9), "feasible {} all {}", feasible, all);
            prop_assert!(!inside(s + 2e-4) || !inside(s + 1e-4) || !inside(s + 1e-6), "stops inside at {}", s);
        }
    }

    /// What is said of the longest part holds: it can be followed, and a bit more cannot.
    #[test]
    fn the_longest_part_is_the_longest(
        x in prop::array::uniform2(-0.3..0.9), y in prop::array::uniform2(-0.4..1.3),
    ) {
        let planes = planes();
        let (from, to) = (v(x[0], y[0]), v(x[1], y[1]));
        prop_assume!((to - from).norm() > 0.2);
        let part = |s: f64, t: f64| [Curve::line(from + (to - from) * s, from + (to - from) * t)];
        if let Err(blocked) = follow(&planes, &part(0.0, 1.0), B) {
            let inside = |i: i32| planes.boundary().contains(from + (to - from) * (f64::from(i) / 2000.0), B);
            // The longest stretch of points inside, by counting.
            let (mut best, mut run) = (0, 0);
            for i in 0..=2000 {
                run = if inside(i) { run + 1 } else { 0 };
                best = best.max(run);
            }
            let counted = f64::from(best) / 2000.0;
            let found = blocked.longest.map_or(0.0, |[s, t]| t - s);
            // A part shorter than the stations are apart may lie between two of them.
            let missed = found < counted && counted < 1.0 / 192.0 + 1e-3;
            prop_assert!((found - counted).abs() < 2.5e-3 || missed, "{} {}", found, counted);
            if let Some([s, t]) = blocked.longest.filter(|[s, t]| t - s > 1e-2) {
                // Where it ends on det = 0, the rates there have no bound: a little off.
                let again = follow(&planes, &part(s + 1e-3, t - 1e-3), B);
                prop_assert!(again.is_ok(), "{s} {t} {again:?}");
            }
        }
    }
}

/// A line that touches a limit between stations is stopped where it passes it, however little.
#[test]
fn a_graze_of_a_limit_is_noticed() {
    let planes = planes();
    let map = planes.map();
    // The line of joint space from which the tip line bends away: its own extreme of a_1, then a limit just below it.
    let (from, to) = (map.forward([1.2, 1.0], B), map.forward([1.2, 2.2], B));
    let line = [Curve::line(from, to)];
    let table = &follow(&planes, &line, B).expect("inside")[0];
    let a = |s: f64| map.project(&table.at(s).q).a;
    let extreme = (0..=4000).map(|i| a(f64::from(i) / 4000.0)[0]).fold(0.0, f64::max);
    assert!(extreme > a(0.0)[0] + 0.01 && extreme > a(1.0)[0] + 0.01, "{extreme} turns back");
    for below in [1e-2, 1e-4, 1e-6] {
        let mut limits = map.limits();
        limits[0].max = extreme - below;
        let narrow = map.with_limits(limits).expect("limits");
        let blocked = trace::follow(&narrow, &line, B, None, Rule::default()).expect_err("it passes the limit");
        assert_eq!(blocked.stop, SheetEnd::Limit { angle: 0, upper: true });
        assert!((a(blocked.s)[0] - limits[0].max).abs() < 1e-6, "{below}: {}", blocked.s);
    }
    let mut limits = map.limits();
    limits[0].max = extreme + 1e-6;
    assert!(trace::follow(&map.with_limits(limits).expect("limits"), &line, B, None, Rule::default()).is_ok());
}
