//! Plans, workspaces, joint space and the tower.

use super::*;

#[test]
fn the_plan_is_drawn_from_point_to_point() {
    let folder = Folder::new("plan");
    let scenario = folded();
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let (steps, places) = contents.vectors("/case-3/plan/waypoints", "Points3D:positions");
    assert_eq!(steps, [0], "once");
    let points = scenario.task.points();
    let height = f64::from(places[0][2]);
    assert_eq!(places.len(), points.len());
    assert!(places.iter().zip(&points).all(|(at, p)| near(*at, [p.re, p.im, height])), "{places:?}");
    assert_eq!(contents.texts("/case-3/plan/names", "Points3D:labels"), ["A", "1", "2", "B"]);
    let dashes = contents.strips("/case-3/plan/path");
    let (first, last) = (dashes[0][0], *dashes.last().and_then(|d| d.last()).expect("a dash"));
    assert!(near(first, [points[0].re, points[0].im, height]) && near(last, [points[3].re, points[3].im, height]));
    // Dashes and gaps are as long as each other, so that half of the way is drawn.
    let length = |line: &[[f32; 3]]| -> f64 {
        line.windows(2).map(|w| f64::from((w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]))).sum()
    };
    let run = stillbase::session::Run::new(&scenario).expect("it runs");
    let motion = run.motion().expect("a plan");
    let curve: Vec<_> = (0..=4096).map(|i| run.end_effector_at(&motion.path.at(f64::from(i) / 4096.0).q)).collect();
    let whole: f64 = curve.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
    let drawn: f64 = dashes.iter().map(|d| length(d)).sum();
    let n = dashes.len() as f64;
    assert!(n > 8.0 && (drawn - whole * n / (2.0 * n - 1.0)).abs() < 1e-3 * whole, "{drawn} of {whole} in {n}");
}

#[test]
fn what_runs_inside_a_workspace_turns_with_it() {
    let folder = Folder::new("inside");
    let (plain, scenario) = (short("case-2"), folded());
    record_in(&folder, "two.rrd", &[plain, scenario.clone()]).expect("two cases");
    let contents = Contents::of(&folder.path("two.rrd"));
    let planes = crate::support::planes(&scenario.machine);
    let boundary = planes.boundary();
    let height = 0.0;
    // Before they are turned and shifted: their transform is the workspace's.
    let flat = |line: &stillbase::planning::reactionless::BoundaryLine| -> Vec<[f64; 3]> {
        line.turned(0.0).iter().map(|[x, y]| [*x, *y, height]).collect()
    };
    for (name, curves) in [("folds", boundary.fold_curves()), ("inner_limits", boundary.inner_limits())] {
        let strips = contents.strips(&format!("/case-3/workspace/2.400/{name}"));
        assert!(!curves.is_empty() && strips.len() == curves.len(), "{name}");
        for (strip, curve) in strips.iter().zip(curves.iter().map(flat)) {
            assert!(strip.len() == curve.len() && strip.iter().zip(curve).all(|(p, q)| near(*p, q)), "{name}");
        }
    }
    let (_, cusps) = contents.vectors("/case-3/workspace/2.400/cusps", "Points3D:positions");
    assert_eq!(cusps.len(), boundary.cusps().len());
    assert!(cusps.iter().zip(boundary.cusps()).all(|(p, v)| near(*p, [v.at.re, v.at.im, height])));
    let dashes = contents.strips("/case-3/workspace/2.400/change_points");
    let first = &boundary.change_curves()[0].line;
    assert!(near(dashes[0][0], flat(first)[0]));
    // A workspace that folds nowhere has change points alone.
    for (name, there) in [("folds", false), ("inner_limits", false), ("cusps", false), ("change_points", true)] {
        assert_eq!(contents.holds(&format!("/case-2/workspace/2.400/{name}")), there, "{name}");
    }
}

#[test]
fn joint_space_has_the_drive_angles_as_coordinates() {
    let folder = Folder::new("joints");
    let mut scenario = Scenario::builtin("change-b").expect("built in");
    scenario.duration = Some(0.5);
    record_in(&folder, "one.rrd", std::slice::from_ref(&scenario)).expect("a case");
    let contents = Contents::of(&folder.path("one.rrd"));
    let mut frames = Vec::new();
    let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
    let root = "/change-b/joint_space";
    let (steps, poses) = contents.vectors(&format!("{root}/pose"), "Points3D:positions");
    assert_eq!(steps.len(), 101);
    for (step, pose) in steps.iter().zip(&poses) {
        let q = frames[*step as usize].q;
        assert!(near(*pose, [q[0], q[1], q[2]]), "step {step}");
    }
    // The plane where it was drawn, moved to where it is: its corners have the b of that instant.
    let lambda = run.planes().expect("planes").map().lambda();
    let (_, corners) = contents.vectors(&format!("{root}/plane"), "Mesh3D:vertex_positions");
    let (steps, shifts) = contents.vectors(&format!("{root}/plane"), "Transform3D:translation");
    assert_eq!((corners.len(), shifts.len()), (6, steps.len()), "two triangles");
    assert!(steps.len() > 50, "it moves with b");
    for (step, shift) in steps.iter().zip(&shifts) {
        for corner in &corners {
            let b: f64 = (0..3).map(|k| lambda[k] * f64::from(corner[k] + shift[k])).sum();
            assert!((b - frames[*step as usize].b_reference).abs() < 1e-5, "step {step}: {b}");
        }
    }
    let path = contents.strips(&format!("{root}/path"));
    let start = frames[0].q;
    assert!(near(path[0][0], [start[0], start[1], start[2]]), "the path begins at A");
    let words = contents.texts(&format!("{root}/axes/titles"), "Points3D:labels");
    assert!(["q₁, rad", "q₂, rad", "q₃, rad"].iter().all(|title| words.iter().any(|w| w == title)), "{words:?}");
}

#[test]
fn the_slice_of_the_tower_lies_at_the_height_of_b() {
    let folder = Folder::new("tower");
    let mut scenario = Scenario::builtin("change-b").expect("built in");
    scenario.duration = Some(0.5);
    record_in(&folder, "two.rrd", &[scenario.clone(), short("case-3")]).expect("two cases");
    let contents = Contents::of(&folder.path("two.rrd"));
    let mut frames = Vec::new();
    let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
    let root = "/change-b/tower";
    let (steps, heights) = contents.vectors(&format!("{root}/slice"), "Transform3D:translation");
    assert!(steps.len() > 50);
    let b = |i: usize| frames[steps[i] as usize].b_reference;
    let last = steps.len() - 1;
    assert!((b(last) - b(0)).abs() > 0.05, "b changes");
    let rise = f64::from(heights[last][2] - heights[0][2]) / (b(last) - b(0));
    assert!(rise > 0.0);
    for (i, height) in heights.iter().enumerate() {
        assert!(near(*height, [0.0, 0.0, f64::from(heights[0][2]) + rise * (b(i) - b(0))]), "row {i}");
    }
    let contours = contents.strips(&format!("{root}/contours"));
    assert!(contours.len() > 10);
    let levels = contours.iter().flatten().map(|p| p[2]);
    let window = [levels.clone().fold(f32::INFINITY, f32::min), levels.fold(0.0, f32::max)];
    // Every bar ends at b that just reach its point, or where the tower ends, and contours lie where the workspace of their b ends.
    let planes = run.planes().expect("planes");
    let floor = b(0) - f64::from(heights[0][2]) / rise;
    for (name, p) in [("A", scenario.task.from), ("B", scenario.task.to)] {
        let bars = contents.strips(&format!("{root}/reach/{name}"));
        let set = planes.map().reach(Vector::new(p[0], p[1])).expect("b that reach it");
        assert!(!bars.is_empty());
        for end in bars.iter().flatten().filter(|end| window.iter().all(|z| (end[2] - z).abs() > 1e-6)) {
            assert!((f64::from(end[0]) - p[0]).hypot(f64::from(end[1]) - p[1]) < 1e-6, "over {name}");
            let b = floor + f64::from(end[2]) / rise;
            let whole = |x: f64| (x / set.period - (x / set.period).round()).abs() * set.period;
            let ends = set.intervals.iter().flatten().map(|x| whole(x - b)).fold(f64::INFINITY, f64::min);
            assert!(ends < 1e-4, "b = {b} is no end of what reaches {name}");
        }
    }
    let outline = planes.boundary().turned(0.0).concat();
    for p in contours.iter().flatten().step_by(7) {
        let b = floor + f64::from(p[2]) / rise;
        let at = Vector::new(f64::from(p[0]), f64::from(p[1])) * unit(-planes.map().turn(b));
        let off = outline.iter().map(|[x, y]| (at - Vector::new(*x, *y)).norm()).fold(f64::INFINITY, f64::min);
        assert!(off < 1e-5, "{p:?}");
    }
    let (_, wall) = contents.vectors(&format!("{root}/wall"), "Mesh3D:vertex_positions");
    assert!((500..6000).contains(&wall.len()), "{} vertices", wall.len());
    // A b that is kept has the slice where it is.
    let (steps, _) = contents.vectors("/case-3/tower/slice", "Transform3D:translation");
    assert_eq!(steps, [0]);
}
