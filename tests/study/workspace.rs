//! The reactionless workspace of a b, points in it, and the poses that reach them.

use stillbase::mechanics::machine::{Inertia, builtin};
use stillbase::mechanics::planar::Vector;
use stillbase::planning::pose_space::PoseSpace;
use stillbase::study::pose_measures::PoseMeasures;
use stillbase::study::workspace::WorkspaceReport;

#[test]
fn three_drives_have_an_area_with_an_inside() {
    let machine = builtin("nine-link").expect("built in");
    let space = PoseSpace::of(machine).expect("it has a b");
    let p = Vector::new(0.5, 0.5);
    let report = WorkspaceReport::of(machine, &space, 2.4, &[p, Vector::new(9.0, 0.0)]).expect("it has poses");
    assert!((report.area - 0.8451448471).abs() < 1e-9 && report.length.is_none() && report.curve.is_none());
    let inside = report.inside.as_ref().expect("three drives");
    assert!(report.sheet_area.is_some_and(|sheets| sheets >= report.area - 1e-12) && inside.sheets >= 1);
    let [at, far] = &report.points[..] else { panic!("two points") };
    assert!(at.distance > 0.0 && far.distance < 0.0 && far.poses.is_empty());
    assert_eq!(at.poses, PoseMeasures::all(machine, &space, p, 2.4));
    let lambda = Inertia::of(machine).lambda();
    for pose in &at.poses {
        assert!((lambda.dot(&pose.q) - 2.4).abs() < 1e-12);
        assert!(pose.det.is_some_and(|det| det > 0.0) && pose.side.is_some());
    }
}

/// With two drives it is a curve, on which the poses lie; both forms have one answer with the keys of the command line.
#[test]
fn two_drives_have_a_curve() {
    let machine = builtin("two-drive").expect("built in");
    let space = PoseSpace::of(machine).expect("it has a b");
    let report = WorkspaceReport::of(machine, &space, 1.2, &[]).expect("it has poses");
    let curve = report.curve.as_ref().expect("a curve");
    let [x, y] = curve[curve.len() / 2];
    let poses = PoseMeasures::all(machine, &space, Vector::new(x, y), 1.2);
    let on = WorkspaceReport::of(machine, &space, 1.2, &[Vector::new(x, y)]).expect("it has poses");
    assert!(on.points[0].distance.abs() < 1e-9 && on.points[0].poses == poses);
    assert!(report.area == 0.0 && report.inside.is_none() && report.sheet_area.is_none());
    assert!(poses.iter().all(|pose| pose.det.is_none() && pose.side.is_none()));
    let json = serde_json::to_value(&report).expect("plain data");
    let keys: Vec<&String> = json.as_object().expect("an object").keys().collect();
    assert_eq!(keys.len(), 8, "{keys:?}");
}
