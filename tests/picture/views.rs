//! Joint space and the tower of workspaces as plain data: what is drawn is where the mechanics has it, and what is
//! pulled at is what is meant.

use stillbase::mechanics::planar::Vector;
use stillbase::picture::scene::axes::{Axis, sliding_range};
use stillbase::picture::scene::camera::Camera;
use stillbase::picture::scene::joints::JointSpace;
use stillbase::picture::scene::options::{Handle, ViewOptions};
use stillbase::picture::scene::palette::{Theme, palette};
use stillbase::picture::scene::pick::{DragAction, Pick};
use stillbase::picture::scene::pointer::Pointer;
use stillbase::picture::scene::stage::Stage;
use stillbase::picture::scene::tower::Tower;
use stillbase::picture::scene::views::{ViewKind, Views};
use stillbase::picture::scene::wall::Wall;
use stillbase::picture::scene::{Measure, Polyline, Scene, place};
use stillbase::planning::reactionless::AngleLimit;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Run, Session};
use stillbase::simulation::frame::Frame;

fn open(case: &str) -> Session {
    Session::open(Scenario::builtin(case).expect("built in")).expect("it can start")
}

fn lines<'a>(scene: &'a Scene, name: &'a str) -> impl Iterator<Item = &'a Polyline> {
    scene.lines.iter().filter(move |l| l.name == name)
}

/// At rest on another plane.
fn posed(case: &str, b: f64) -> Session {
    let mut session = open(case);
    session.apply(Edit::PoseB { b }).expect("any b");
    session
}

/// Sessions of many kinds: at a start, in motion, far off, wound up, and with a target out of reach.
fn sessions() -> Vec<Session> {
    let mut moving = open("case-1");
    moving.play();
    moving.tick(300);
    let mut outside = open("case-3");
    outside.apply(Edit::DragTarget { x: 0.2, y: 1.15 }).expect("any place");
    outside.tick(60_000);
    vec![open("case-3"), moving, posed("case-3", 4.9), posed("case-3", -11.3), posed("case-3", 31.0), outside]
}

fn raised(run: &Run) -> Tower {
    Tower::of(run, Stage::of(run).outlined().expect("it has a workspace")).expect("three drives")
}

fn tower_of(session: &Session) -> (Tower, Scene) {
    let tower = raised(session.run());
    let scene = tower.scene(session.frame(), &ViewOptions::default(), &tower.camera());
    (tower, scene)
}

fn joints_of(session: &Session) -> (JointSpace, Scene) {
    let space = JointSpace::of(session.run()).expect("three drives");
    let scene = space.scene(session.frame(), &ViewOptions::default(), &space.camera());
    (space, scene)
}

/// b at a height of the tower.
fn b_at(tower: &Tower, frame: &Frame, z: f32) -> f64 {
    tower.window(frame.b_reference)[0] + f64::from(z) / tower.rise()
}

#[test]
fn the_slice_is_the_workspace_at_its_height() {
    for session in sessions() {
        let (tower, scene) = tower_of(&session);
        let (frame, planes) = (session.frame(), session.run().planes().expect("three drives"));
        let loops = planes.boundary().turned(frame.b_reference);
        let outline = lines(&scene, "slice/boundary").next().expect("an outline");
        assert_eq!(outline.strips.len(), loops.len());
        for (strip, want) in outline.strips.iter().zip(&loops) {
            assert_eq!(strip.len(), want.len() + 1, "closed");
            assert_eq!(strip.first(), strip.last());
            let there: Vec<_> = strip.iter().map(|p| place(&outline.world_from_item, *p)).collect();
            for (got, want) in there.iter().zip(want) {
                let miss = (f64::from(got[0]) - want[0]).hypot(f64::from(got[1]) - want[1]);
                assert!(miss < 1e-6, "{got:?} and {want:?}");
                assert!((b_at(&tower, frame, got[2]) - frame.b_reference).abs() < 1e-6);
            }
        }
        // Its fill is that workspace too, vertex by vertex.
        let fill = scene.solids.iter().find(|s| s.name == "slice").expect("a fill");
        let m = fill.world_from_item;
        assert!((b_at(&tower, frame, m[3][2]) - frame.b_reference).abs() < 1e-6);
        for p in scene.model.meshes[fill.mesh].positions.iter().step_by(101) {
            let at: [f32; 2] = std::array::from_fn(|r| (0..3).map(|c| m[c][r] * p[c]).sum::<f32>());
            let at = Vector::new(f64::from(at[0]), f64::from(at[1]));
            // Rounded to f32, a vertex on the boundary may lie a hair outside.
            let inside = at * (1.0 - 1e-6) + planes.map().forward([1.0, 1.0], frame.b_reference) * 1e-6;
            let boundary = planes.boundary();
            let near = (boundary.nearest(at, frame.b_reference, at).at - at).norm();
            assert!(boundary.contains(inside, frame.b_reference) || near < 1e-6, "{at}: {near}");
        }
    }
}

/// Every vertex of the wall, turned into place, lies on the boundary of the workspace of its height.
#[test]
fn the_wall_stands_on_the_boundary_at_every_height() {
    for session in [open("case-3"), posed("case-3", -3.3)] {
        let (tower, scene) = tower_of(&session);
        let (frame, boundary) = (session.frame(), session.run().planes().expect("three drives").boundary());
        let solid = scene.solids.iter().find(|s| s.name == "wall").expect("the wall");
        let (mesh, m) = (&scene.model.meshes[solid.mesh], solid.world_from_item);
        assert!(mesh.shell && mesh.positions.len() > 5_000);
        assert_eq!(mesh.positions.len(), mesh.normals.len());
        let mut heights = [f64::INFINITY, f64::NEG_INFINITY];
        for (p, n) in mesh.positions.iter().zip(&mesh.normals).step_by(37) {
            let at: [f32; 3] = std::array::from_fn(|r| (0..3).map(|c| m[c][r] * p[c]).sum::<f32>() + m[3][r]);
            let b = b_at(&tower, frame, at[2]);
            heights = [heights[0].min(b), heights[1].max(b)];
            let q = Vector::new(f64::from(at[0]), f64::from(at[1]));
            // A hair to either side of the boundary.
            let out: [f32; 2] = std::array::from_fn(|r| (0..3).map(|c| m[c][r] * n[c]).sum());
            let off = Vector::new(f64::from(out[0]), f64::from(out[1])) * 3e-3;
            assert!(boundary.contains(q - off, b) || !boundary.contains(q + off, b), "{q} at b = {b}: inside out");
            let near = boundary.nearest(q + off, b, q);
            assert!((near.at - q).norm() < 4e-3, "{q} is {} m off the boundary", (near.at - q).norm());
        }
        let [low, high] = tower.window(frame.b_reference);
        assert!((heights[0] - low).abs() < 0.2 && (heights[1] - high).abs() < 0.2, "{heights:?}");
    }
}

#[test]
fn normals_of_a_wall_are_square_to_it() {
    // A twisting square prism and a circle, against differences along both directions of the wall.
    let corners = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[x, y]| Vector::new(x, y));
    let square: Vec<Vector> = (0..80)
        .map(|i| corners[i / 20] + (corners[(i / 20 + 1) % 4] - corners[i / 20]) * ((i % 20) as f64 / 20.0))
        .collect();
    let circle: Vec<Vector> =
        (0..4000).map(|i| Vector::from_polar(0.7, f64::from(i) * std::f64::consts::TAU / 4e3)).collect();
    for (outline, twist) in [(square, 0.4), (circle, -1.3)] {
        let mesh = Wall::of(std::slice::from_ref(&outline), twist).mesh(2.0);
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize].map(f64::from));
            let (u, v): ([f64; 3], [f64; 3]) =
                (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
            let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
            let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
            let mean: [f64; 3] =
                std::array::from_fn(|i| t.iter().map(|k| f64::from(mesh.normals[*k as usize][i])).sum::<f64>() / 3.0);
            let along: f64 = n.iter().zip(mean).map(|(n, m)| n * m / length).sum();
            assert!(along > 0.97, "{along}");
        }
        let low = mesh.positions.iter().filter(|p| p[2] == 0.0).count();
        assert!(low >= 8, "corners have two normals");
    }
}

/// Contours are closed where the wall is, and seen from above or below they change sides as they should.
#[test]
fn contours_tell_near_sides_from_far_ones() {
    let circle: Vec<Vector> =
        (0..720).map(|i| Vector::from_polar(1.0, f64::from(i) * std::f64::consts::TAU / 720.0)).collect();
    let wall = Wall::of(&[circle], 0.8);
    let pieces = wall.contour(1.1, [1.0, 0.0, 0.0]);
    let length = |points: &[Vector]| points.windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>();
    let (near, far): (Vec<_>, Vec<_>) = pieces.iter().partition(|(_, near)| *near);
    for (side, sign) in [(near, 1.0), (far, -1.0)] {
        let total: f64 = side.iter().map(|(points, _)| length(points)).sum();
        assert!((total - std::f64::consts::PI).abs() < 0.1, "{total}");
        assert!(side.iter().flat_map(|(points, _)| points).all(|p| sign * p.re > -0.07));
    }
}

#[test]
fn bars_end_where_b_stops_reaching_the_point() {
    let session = open("case-3");
    let (tower, scene) = tower_of(&session);
    let frame = session.frame();
    // From the paper's machine: A by 1.6495… to 2.9012…, B by 2.2157… to 2.6610…
    for (name, x, y, want) in
        [("reach/A", 0.5, 0.5, [1.6495370969, 2.9012991061]), ("reach/B", 0.55, 0.9, [2.2157496582, 2.6610727211])]
    {
        let bars: Vec<_> = lines(&scene, name).collect();
        let [bar] = bars[..] else { panic!("{name}: {} lines", bars.len()) };
        assert_eq!(bar.strips.len(), 1, "{name}: one bar");
        for (p, b) in bar.points().iter().zip(want) {
            assert!((b_at(&tower, frame, p[2]) - b).abs() < 1e-6);
            assert!((f64::from(p[0]) - x).hypot(f64::from(p[1]) - y) < 1e-6);
        }
    }
    // Anywhere: within the window, whole turns apart, and never where the point cannot be reached.
    for session in sessions() {
        let (tower, frame) = (raised(session.run()), session.frame());
        let [low, high] = tower.window(frame.b_reference);
        for (post, bars) in tower.posts(frame) {
            let set = session.run().planes().expect("three drives").map().reach(post.at).expect("within reach");
            for i in 0..=500 {
                let b = low + (high - low) * f64::from(i) / 500.0;
                let shown = bars.iter().any(|[from, to]| *from <= b && b <= *to);
                let end = bars.iter().flatten().any(|e| (e - b).abs() < 1e-6);
                assert!(end || shown == set.contains(b), "{}: {b}", post.name);
            }
        }
    }
}

/// The window of b holds the present one, never jumps, and is where the paper's b are.
#[test]
fn the_window_of_b_slides() {
    let tower = raised(open("case-3").run());
    assert_eq!(tower.window(2.4), [0.0, 5.0]);
    let mut last = sliding_range(-20.0, 2.5, 5.0, 0.4);
    for i in -2000..2000 {
        let b = f64::from(i) * 0.01;
        let [low, high] = sliding_range(b, 2.5, 5.0, 0.4);
        assert!(b >= low + 0.4 - 1e-12 && b <= high - 0.4 + 1e-12);
        assert!((high - low - 5.0).abs() < 1e-12 && (low - last[0]).abs() < 0.0100001);
        last = [low, high];
    }
}

#[test]
fn the_planes_polygon_keeps_b_and_the_limits() {
    for session in sessions() {
        let (space, scene) = joints_of(&session);
        let (frame, map) = (session.frame(), *session.run().planes().expect("three drives").map());
        let outlines: Vec<_> = lines(&scene, "plane/boundary").collect();
        let [outline] = outlines[..] else { panic!("one plane") };
        let outline = outline.points();
        assert_eq!(outline.len(), 5);
        assert_eq!(outline[0], outline[4]);
        let mut corners = 0;
        for p in &outline[..4] {
            let at = map.project(&space.angles(p.map(f64::from), frame));
            assert!((at.b - frame.b_reference).abs() < 1e-6, "{} and {}", at.b, frame.b_reference);
            let limits = map.limits();
            assert!((0..2).all(|i| limits[i].contains(at.a[i], 2e-6)), "{at:?}");
            let at_limit = |i: usize| (at.a[i] - limits[i].min).abs().min((at.a[i] - limits[i].max).abs()) < 2e-6;
            corners += usize::from(at_limit(0) && at_limit(1));
        }
        assert_eq!(corners, 4, "the plane reaches as far as the limits");
        // The fill is that polygon.
        let plane = scene.solids.iter().find(|s| s.name == "plane").expect("a fill");
        let shift = plane.world_from_item[3];
        for p in &scene.model.meshes[plane.mesh].positions {
            let p: [f32; 3] = std::array::from_fn(|i| p[i] + shift[i]);
            let near = |q: &[f32; 3]| q.iter().zip(p).all(|(q, p)| (q - p).abs() < 2e-6);
            assert!(outline.iter().any(near), "{p:?}");
        }
        // Turning all drives alike keeps the limits: the prism's edges run along (1, 1, 1).
        let edges = lines(&scene, "limits").next().expect("edges");
        assert_eq!(edges.strips.len(), 4);
        for edge in edges.strips.iter() {
            let d: [f32; 3] = std::array::from_fn(|i| edge[1][i] - edge[0][i]);
            assert!((d[0] - d[1]).abs() < 1e-5 && (d[0] - d[2]).abs() < 1e-5 && d[0] > 1.0);
        }
    }
}

/// Joint space and back, and the pose where the drives have it.
#[test]
fn the_pose_is_where_the_drives_are() {
    for session in sessions() {
        let (space, scene) = joints_of(&session);
        let frame = session.frame();
        let marker = scene.markers.iter().find(|m| m.name == "pose").expect("a dot");
        let q = space.angles(marker.at.map(f64::from), frame);
        for (k, q) in q.iter().enumerate() {
            assert!((q - frame.q[k]).abs() < 1e-6);
        }
        let back = space.angles(space.point(&[0.1, -7.0, 3.0], frame.b_reference), frame);
        assert!(back.iter().zip([0.1, -7.0, 3.0]).all(|(x, y)| (x - y).abs() < 1e-12));
    }
    // Case 3 stays on its plane, case 1 leaves it.
    for (case, flat) in [("case-3", true), ("case-1", false)] {
        let session = open(case);
        let (space, scene) = joints_of(&session);
        let (b, map) = (session.frame().b_reference, *session.run().planes().expect("three drives").map());
        let path = lines(&scene, "path").next().expect("a path");
        let off = |p: &[f32; 3]| (map.project(&space.angles(p.map(f64::from), session.frame())).b - b).abs();
        let farthest = path.points().iter().map(off).fold(0.0, f64::max);
        assert_eq!(farthest < 1e-6, flat, "{case}: {farthest}");
    }
}

fn cameras(first: Camera) -> Vec<Camera> {
    [[0.0, 0.0], [0.7, 0.2], [2.1, -0.1], [-1.4, 0.3]]
        .map(|[yaw, pitch]| {
            let mut camera = first;
            camera.turn(yaw, pitch);
            camera
        })
        .to_vec()
}

fn pointer(camera: Camera, at: [f64; 3]) -> Pointer {
    let over = Pointer { camera, size: [900.0, 700.0], at: [0.0; 2] };
    Pointer { at: over.project(at).expect("in front of the eye"), ..over }
}

/// Taking hold of the slice and pulling it to where another b would have it asks for that b.
#[test]
fn pulling_the_slice_asks_for_the_b_under_the_pointer() {
    let session = open("case-3");
    let (frame, tower) = (session.frame(), raised(session.run()));
    let planes = session.run().planes().expect("three drives");
    let inside = planes.map().forward([2.2, 0.8], frame.b_reference);
    for camera in cameras(tower.camera()) {
        let at = |b: f64| [inside.re, inside.im, b * tower.rise()];
        let grip = tower.pick(frame, &pointer(camera, at(frame.b_reference))).expect("the slice");
        assert_eq!(grip.handle, Handle::Plane);
        for b in [0.3, 1.7, 2.4, 3.9, 4.8] {
            let Some(DragAction::B(asked)) = tower.aim(&grip, frame, &pointer(camera, at(b))) else { panic!("b") };
            assert!((asked - b).abs() < 1e-6, "{asked} for {b}");
        }
        // Far above, no farther than a little past the top.
        let Some(DragAction::B(asked)) = tower.aim(&grip, frame, &pointer(camera, at(9.0))) else { panic!("b") };
        assert!(asked > 5.0 && asked < 5.5, "{asked}");
        // Beside the tower there is nothing.
        let out = planes.map().forward([2.2, 0.8], frame.b_reference) * -3.0;
        assert_eq!(tower.pick(frame, &pointer(camera, [out.re, out.im, at(frame.b_reference)[2]])), None);
    }
}

#[test]
fn a_bar_gives_the_b_at_the_pointer_within_reach() {
    let session = open("case-3");
    let (frame, tower) = (session.frame(), raised(session.run()));
    let camera = tower.camera();
    let over = |b: f64| pointer(camera, [0.5, 0.5, b * tower.rise()]);
    let grip = tower.pick(frame, &over(1.9)).expect("the bar of A");
    assert_eq!(grip.handle, Handle::Bar);
    for (b, want) in [(1.9, 1.9), (2.8, 2.8), (0.4, 1.6495370969), (4.4, 2.9012991061)] {
        let Some(DragAction::B(asked)) = tower.aim(&grip, frame, &over(b)) else { panic!("b") };
        assert!((asked - want).abs() < 1e-6, "{asked} for {b}");
    }
    // On the slice the dot comes first.
    let dot = pointer(camera, [0.5, 0.5, 2.4 * tower.rise()]);
    let grip = tower.pick(frame, &dot).expect("the dot");
    assert_eq!(grip.handle, Handle::Target);
    let to = [0.62, 0.55, 2.4 * tower.rise()];
    let Some(DragAction::Target([x, y])) = tower.aim(&grip, frame, &pointer(camera, to)) else { panic!("a place") };
    assert!((x - 0.62).hypot(y - 0.55) < 1e-6);
}

/// In joint space the dot asks for the end effector's place of the pose under the pointer, the plane for its b.
#[test]
fn pulling_in_joint_space_asks_for_what_is_seen() {
    let session = open("case-3");
    let (frame, space) = (session.frame(), JointSpace::of(session.run()).expect("three drives"));
    let map = *session.run().planes().expect("three drives").map();
    let b = frame.b_reference;
    let seen = |a: [f64; 2], b_of: f64| {
        space.point(&map.lift(stillbase::planning::reactionless::PlanePoint { a, b: b_of }), b)
    };
    for camera in cameras(space.camera()) {
        let pose = space.point(&[frame.q[0], frame.q[1], frame.q[2]], b);
        let grip = space.pick(frame, &pointer(camera, pose)).expect("the dot");
        assert_eq!(grip.handle, Handle::Target);
        for a in [[0.4, 0.6], [1.0, 2.9], [2.7, 1.4]] {
            let Some(DragAction::Target([x, y])) = space.aim(&grip, frame, &pointer(camera, seen(a, b))) else {
                panic!("p")
            };
            assert!((map.forward(a, b) - Vector::new(x, y)).norm() < 1e-6);
        }
        let start = seen([2.4, 0.5], b);
        let grip = space.pick(frame, &pointer(camera, start)).expect("the plane");
        assert_eq!(grip.handle, Handle::Plane);
        let lambda = map.lambda();
        for want in [1.5, 2.4, 3.1] {
            // Along the normal, in the order of the scene's axes.
            let way = (want - b) / lambda.iter().map(|l| l * l).sum::<f64>();
            let at: [f64; 3] = std::array::from_fn(|i| start[i] + way * lambda[(i + 1) % 3]);
            let Some(DragAction::B(asked)) = space.aim(&grip, frame, &pointer(camera, at)) else { panic!("b") };
            assert!((asked - want).abs() < 1e-6, "{asked} for {want}");
        }
        assert_eq!(space.pick(frame, &pointer(camera, seen([-0.3, 1.0], b))), None, "outside the limits");
    }
}

/// The views of the machine answer as their handles lie.
#[test]
fn the_machines_handles_are_found_in_both_views() {
    let session = open("case-3");
    let (frame, views) = (session.frame(), Views::of(session.run()));
    for kind in [ViewKind::Flat, ViewKind::Space] {
        let camera = views.camera(kind);
        for handle in [Handle::Target, Handle::Ring] {
            let at = views.stage().handle(handle, &frame.into()).expect("three drives");
            let here = pointer(camera, at);
            assert_eq!(views.pick(kind, &frame.into(), &here), Some(Pick::of(handle, at)));
            match views.aim(kind, &Pick::of(handle, at), &frame.into(), &here, 2.4) {
                Some(DragAction::Target([x, y])) => assert!((x - 0.5).hypot(y - 0.5) < 1e-6),
                Some(DragAction::B(b)) => assert!((b - 2.4).abs() < 1e-6),
                other => panic!("{handle:?} asks for {other:?}"),
            }
        }
        // The ends of the joint limits stand where they are.
        let ends: Vec<Pick> = views.stage().limits(&frame.into()).collect();
        assert_eq!(ends.len(), 4, "two angles with two ends each");
        for pick in ends {
            let here = pointer(camera, pick.at);
            let Some(DragAction::Limit { angle, end, ends }) = views.aim(kind, &pick, &frame.into(), &here, 2.4) else {
                panic!("{pick:?} is pulled")
            };
            assert_eq!(pick.handle, Handle::Limit(angle, end));
            let limits = &session.scenario().machine.angles()[angle].limits;
            assert!((ends[0] - limits.start()).abs() + (ends[1] - limits.end()).abs() < 1e-5, "{ends:?} {limits:?}");
        }
    }
    // Around, all views come by.
    let mut kind = ViewKind::default();
    for want in [ViewKind::Space, ViewKind::Joints, ViewKind::Tower, ViewKind::Design, ViewKind::Flat] {
        kind = kind.next();
        assert_eq!(kind, want);
    }
}

/// Everything drawn is finite, in both themes, in every view, whatever the state and wherever the eye.
#[test]
fn nothing_drawn_is_lost() {
    for session in sessions() {
        let views = Views::of(session.run());
        for kind in [ViewKind::Joints, ViewKind::Tower] {
            for (theme, camera) in [Theme::Dark, Theme::Light].into_iter().zip(cameras(views.camera(kind))) {
                let options = ViewOptions { theme, ..ViewOptions::default() };
                let scene = views.scene(kind, session.frame(), &options, &camera);
                let points = scene.lines.iter().flat_map(Polyline::points).chain(scene.markers.iter().map(|m| m.at));
                let points = points.chain(scene.labels.iter().map(|l| l.at));
                assert!(points.flatten().all(f32::is_finite));
                assert!(scene.solids.iter().all(|s| s.mesh < scene.model.meshes.len()));
                assert!(scene.lines.iter().flat_map(|l| l.strips.iter()).all(|s| s.len() > 1), "a line has two ends");
                assert!(scene.lines.len() < 1_000 && scene.labels.len() < 60);
                assert!(scene.labels.iter().all(|l| !l.text.is_empty()));
            }
        }
    }
}

/// Marks are at round values inside the box, where they belong.
#[test]
fn axes_mark_their_values() {
    let axis = Axis {
        symbol: "b",
        unit: "rad",
        colour: palette(Theme::Dark).amber,
        ends: [0.0, 2.0],
        values: [-0.3, 4.7],
        step: 1.0,
        decimals: 0,
        now: None,
        now_decimals: 3,
    };
    assert_eq!(axis.marks().collect::<Vec<_>>(), [0.0, 1.0, 2.0, 3.0, 4.0]);
    assert!((axis.place(-0.3) - 0.0).abs() < 1e-12 && (axis.place(4.7) - 2.0).abs() < 1e-12);
    assert!((axis.place(2.2) - 1.0).abs() < 1e-12);
    // A step of nothing does not go on for ever.
    assert!(Axis { step: 1e-12, ..axis }.marks().count() <= 40);
}

/// The walls with the grid are behind, wherever the eye is: nothing of the grid is nearer to it than the box's middle
/// on every one of its walls.
#[test]
fn the_grid_is_behind() {
    let session = open("case-3");
    let tower = raised(session.run());
    for camera in cameras(tower.camera()) {
        let scene = tower.scene(session.frame(), &ViewOptions::default(), &camera);
        let eye = camera.eye_direction();
        let walls: Vec<_> = ["axes/grid", "axes/edges"].iter().flat_map(|name| lines(&scene, name)).collect();
        assert_eq!(walls.len(), 2);
        for strip in walls.iter().flat_map(|line| line.strips.iter()) {
            let on_wall = (0..2).any(|i| {
                let side = if eye[i] >= 0.0 { -1.0 } else { 1.0 };
                strip.iter().all(|p| p[i] * side > 0.0 && p[i] == strip[0][i])
            });
            assert!(on_wall || strip.iter().all(|p| p[2] == 0.0), "{strip:?}");
        }
    }
}

/// Least and greatest of each measure against a fine grid.
#[test]
fn the_key_to_dexterity_is_its_range() {
    let session = open("case-3");
    let map = *session.run().planes().expect("three drives").map();
    let [l1, l2] = map.limits();
    let at = |l: AngleLimit, i: u32| l.min + (l.max - l.min) * f64::from(i) / 300.0;
    let poses = || (0..=300).flat_map(|i| (0..=300).map(move |j| [at(l1, i), at(l2, j)]));
    for measure in Measure::ALL {
        let [least, most] = measure.range(&map);
        let values = || poses().map(|a| measure.of(&map, a));
        let found = values().fold(0.0, f64::max);
        assert!(most >= found * (1.0 - 1e-6) && most < found * (1.0 + 1e-4), "{measure:?}: {most} and {found}");
        let found = if measure == Measure::Det { 0.0 } else { values().fold(f64::INFINITY, f64::min) };
        assert!((least - found).abs() < 1e-4 * most, "{measure:?}: {least} and {found}");
    }
    // Shading is asked for in the area, and only there.
    let views = Views::of(session.run());
    let camera = views.camera(ViewKind::Flat);
    for dexterity in [None, Some(Measure::Det), Some(Measure::TorquePerForce)] {
        let options = ViewOptions { dexterity, ..ViewOptions::default() };
        let scene = views.scene(ViewKind::Flat, session.frame(), &options, &camera);
        let shades: Vec<_> =
            scene.areas.iter().map(|a| (a.name.as_ref(), a.shade.map(|s| [s.empty, s.full]))).collect();
        let range = dexterity.map(|measure| measure.range(&map).map(|x| x as f32));
        assert_eq!(shades, [("workspace/compared", None), ("workspace", range)]);
    }
}
