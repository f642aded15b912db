//! The picture as text, and that what is drawn is where the mechanics has it.

use std::fmt::Write;

use proptest::prelude::*;
use stillbase::mechanics::joint_forces::Joints;
use stillbase::mechanics::machine::{Machine, builtin, builtins, parse, place_of, to_toml};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector, unit};
use stillbase::picture::numbers::round_up;
use stillbase::picture::scene::camera::{Camera, FlatCamera, Orbit};
use stillbase::picture::scene::exaggeration::{DrawnFrame, Exaggeration, exaggeration};
use stillbase::picture::scene::linkage::LinkageModel;
use stillbase::picture::scene::measurement::Measurement;
use stillbase::picture::scene::options::{Handle, OtherRun, ViewOptions};
use stillbase::picture::scene::palette::{Theme, palette};
use stillbase::picture::scene::stage::Stage;
use stillbase::picture::scene::{Label, Polyline, Scene, Solid, place};
use stillbase::session::scenario::{Note, NoteTime, Scenario, SnapPoint};
use stillbase::session::{Edit, Session};
use stillbase::simulation::frame::Reach;
use stillbase::simulation::plant::{Base, BaseKind, Load};

fn open(case: &str) -> Session {
    Session::open(Scenario::builtin(case).expect("built in")).expect("it can start")
}

/// Case 3 after its target was dragged out of the workspace and the machine has come to rest.
fn dragged_outside() -> Session {
    let mut session = open("case-3");
    session.apply(Edit::DragTarget { x: 0.2, y: 1.15 }).expect("any place");
    session.tick(60_000);
    assert!(!session.is_moving());
    session
}

/// Millimetres, with no minus on zero.
fn mm(p: [f32; 3]) -> String {
    let [x, y] = [p[0], p[1]].map(|x| format!("{:.3}", (f64::from(x) * 1e3).round() / 1e3 + 0.0));
    format!("({x}, {y})")
}

/// One line a thing: what it is and where, without grid, holes of pins, colours and sizes.
fn as_text(scene: &Scene) -> String {
    let mut text = String::new();
    for s in scene.solids.iter().filter(|s| !s.name.ends_with("/holes")) {
        let [along, .., at] = s.world_from_item;
        let angle = f64::from(along[1].atan2(along[0])).to_degrees();
        let _ = writeln!(text, "solid {} at {} turned {:.1}°", s.name, mm([at[0], at[1], at[2]]), angle + 0.0);
    }
    for a in &scene.areas {
        let _ = writeln!(text, "area {} turned {:.3}", a.name, a.turn);
    }
    for l in scene.lines.iter().filter(|l| !l.name.starts_with("grid")) {
        for strip in l.strips.iter() {
            let [first, last] = [strip[0], strip[strip.len() - 1]].map(|p| place(&l.world_from_item, p));
            let ends = if strip[0] == strip[strip.len() - 1] {
                "closed".into()
            } else {
                format!("{} to {}", mm(first), mm(last))
            };
            let _ = writeln!(text, "line {} {ends}", l.name);
        }
    }
    for m in &scene.markers {
        let _ = writeln!(text, "marker {} at {}", m.name, mm(m.at));
    }
    for l in &scene.labels {
        let _ = writeln!(text, "label {:?} at {}", l.text, mm(l.at));
    }
    text
}

fn scene_of(session: &Session) -> Scene {
    Stage::of(session.run()).scene(session.frame(), &ViewOptions::default())
}

/// Two pictures in words.
#[test]
fn case_3_at_its_start() {
    let want = r#"solid plan/start/1 at (0.000, 0.000) turned 96.7°
solid plan/start/5 at (-0.058, 0.497) turned 32.8°
solid plan/start/9 at (0.328, 0.746) turned -55.1°
solid machine/base at (0.000, 0.000) turned 0.0°
solid machine/base/drive/1 at (0.000, 0.000) turned 0.0°
solid machine/base/drive/2 at (0.000, 0.000) turned 0.0°
solid machine/base/drive/3 at (0.000, 0.000) turned 0.0°
solid machine/link/1 at (0.000, 0.000) turned 96.7°
solid machine/link/2 at (0.000, 0.000) turned -147.2°
solid machine/link/3 at (0.000, 0.000) turned 124.9°
solid machine/link/4 at (-0.151, -0.098) turned 96.7°
solid machine/link/5 at (-0.058, 0.497) turned 32.8°
solid machine/link/6 at (-0.114, 0.164) turned 96.7°
solid machine/link/7 at (-0.058, 0.497) turned 124.9°
solid machine/link/8 at (-0.173, 0.661) turned 32.8°
solid machine/link/9 at (0.328, 0.746) turned -55.1°
solid machine/joints at (-0.058, 0.497) turned 0.0°
solid machine/joints at (-0.151, -0.098) turned 0.0°
solid machine/joints at (-0.114, 0.164) turned 0.0°
solid machine/joints at (-0.209, 0.399) turned 0.0°
solid machine/joints at (0.328, 0.746) turned 0.0°
solid machine/joints at (-0.173, 0.661) turned 0.0°
solid machine/joints at (0.214, 0.910) turned 0.0°
solid machine/base/cap at (0.000, 0.000) turned 0.0°
area workspace/compared turned 4.017
area workspace turned 1.928
line workspace/compared/boundary closed
line workspace/boundary closed
line workspace/change_points (0.091, -0.244) to (-0.041, 0.659)
line b_ring (0.149, 0.000) to (0.149, 0.000)
line b_ring/b (0.149, 0.000) to (-0.052, 0.139)
line plan/path (0.500, 0.500) to (0.550, 0.900)
line com (-0.018, 0.000) to (0.018, 0.000)
line com (0.000, -0.018) to (0.000, 0.018)
marker b_ring/knob at (-0.052, 0.139)
marker plan/waypoints at (0.500, 0.500)
marker plan/waypoints at (0.550, 0.900)
marker end_effector at (0.500, 0.500)
marker target at (0.500, 0.500)
label "b = 5.000 rad" at (-0.498, 0.095)
label "reactionless workspace" at (0.329, 0.386)
label "b = 2.400 rad · 0.845 m²" at (0.329, 0.386)
label "b" at (-0.052, 0.139)
label "A" at (0.500, 0.500)
label "B" at (0.550, 0.900)
label "f_B 0.000 N" at (0.252, -0.139)
label "n_B 0.000 N m" at (0.252, -0.139)
label "centre of mass at rest on the base pin" at (0.252, -0.139)
label "0.500, 0.500 m" at (0.500, 0.500)
label "drag me" at (0.500, 0.500)
"#;
    assert_eq!(as_text(&scene_of(&open("case-3"))), want);
}

#[test]
fn a_target_outside() {
    let want = r#"line target/gap (0.324, 1.218) to (0.200, 1.150)
marker b_ring/knob at (-0.052, 0.139)
marker end_effector at (0.324, 1.218)
marker target at (0.200, 1.150)
marker target/nearest at (0.324, 1.218)
label "b = 5.000 rad" at (-0.498, 0.095)
label "reactionless workspace" at (0.329, 0.386)
label "b = 2.400 rad · 0.845 m²" at (0.329, 0.386)
label "b" at (-0.052, 0.139)
label "f_B 0.000 N" at (0.252, -0.139)
label "n_B 0.000 N m" at (0.252, -0.139)
label "centre of mass at rest on the base pin" at (0.252, -0.139)
label "outside the reactionless workspace" at (0.200, 1.150)
label "nearest point 0.324, 1.218 m" at (0.200, 1.150)
label "b = 2.648 rad would reach it" at (0.200, 1.150)
"#;
    let text: String = as_text(&scene_of(&dragged_outside()))
        .lines()
        .filter(|l| {
            ["line target", "marker", "label", "line plan/path", "line reaction"].iter().any(|w| l.starts_with(w))
        })
        .map(|l| format!("{l}\n"))
        .collect();
    assert_eq!(text, want);
}

fn count(scene: &Scene, what: impl Fn(&Solid) -> bool) -> usize {
    scene.solids.iter().filter(|s| what(s)).count()
}

#[test]
fn a_picture_has_every_part_of_the_machine() {
    let scene = scene_of(&open("case-3"));
    assert_eq!(count(&scene, |s| s.name.starts_with("machine/link/")), 9);
    // 1-5-7, 2-4, 3-6, 4-5, 6-7-8, 5-9 and 8-9; the three drives share B.
    assert_eq!(count(&scene, |s| s.name == "machine/joints"), 7);
    assert_eq!(count(&scene, |s| s.name.starts_with("machine/base/drive/")), 3);
    assert_eq!(count(&scene, |s| s.name.starts_with("plan/start/")), 3, "the arms at the start of the motion");
    assert!(scene.solids.iter().all(|s| s.mesh < scene.model.meshes.len()));
    assert!(scene.model.meshes.iter().all(|m| !m.triangles.is_empty()));
    // The workspace of the task and the one to compare with.
    let turns: Vec<_> = scene.areas.iter().map(|a| (a.name.as_ref(), a.turn)).collect();
    let session = open("case-3");
    let map = *session.run().planes().expect("three drives").map();
    let turn = |b: f64| map.turn(b) as f32;
    assert_eq!(turns, [("workspace/compared", turn(5.0)), ("workspace", turn(2.4))]);
    // Led by hand, there is no ghost and no path of a plan.
    let led = scene_of(&dragged_outside());
    assert_eq!(count(&led, |s| s.name.starts_with("plan/start/")), 0);
    assert!(led.lines.iter().all(|l| l.name != "plan/path"));
}

/// Handles are where their markers are, in every state of the target.
/// A counterweight is drawn where it sits, as large as it is, in place of the disc that stands for one.
#[test]
fn counterweights_are_drawn_to_scale() {
    let bare = builtin("nine-link").expect("built in");
    let [at, radius] = [-0.35, 0.08];
    let weight = format!("\n[[counterweight]]\nlink = \"1\"\nmass = 4.0\nat = {at}\nradius = {radius}\n");
    let with = parse(&(to_toml(bare) + &weight), "with.toml").expect("a machine");
    // How far the mesh of link 1 goes, along its axis and beside it, m.
    let extent = |machine: &Machine| {
        let case_1 = Scenario::builtin("case-1").expect("built in");
        let session = Session::open(Scenario { machine: machine.clone(), ..case_1 }).expect("it runs");
        let scene = scene_of(&session);
        let mesh = &scene.model.meshes[LinkageModel::of(machine).bars()[0].mesh];
        let least = mesh.positions.iter().map(|p| f64::from(p[0])).fold(f64::MAX, f64::min);
        [least, mesh.positions.iter().map(|p| f64::from(p[1])).fold(0.0, f64::max)]
    };
    let [least, wide] = extent(&with);
    assert!((least - (at - radius)).abs() < 1e-6 && (wide - radius).abs() < 1e-6, "{least} {wide}");
    assert!((extent(bare)[0] - least).abs() > 0.01);
}

#[test]
fn handles_are_under_their_markers() {
    let mut moving = open("case-3");
    moving.play();
    moving.tick(400);
    let mut following = open("case-3");
    following.apply(Edit::DragTarget { x: 0.3, y: 0.8 }).expect("any place");
    following.tick(50);
    let mut carried = open("case-3");
    carried.apply(Edit::SlideB { b: 3.4 }).expect("any b");
    carried.tick(60_000);
    assert_eq!(carried.frame().target.reach, Reach::Carried);
    for session in [open("case-1"), open("case-3"), moving, following, carried, dragged_outside()] {
        check_handles(&session);
    }
}

#[test]
fn handles_go_with_their_base() {
    check_handles(&floating());
}

fn check_handles(session: &Session) {
    let (stage, frame) = (Stage::of(session.run()), session.frame());
    let scene = stage.scene(frame, &ViewOptions::default());
    for (handle, name) in [(Handle::Target, "target"), (Handle::Ring, "b_ring/knob")] {
        let marker = scene.markers.iter().find(|m| m.name == name).expect("a marker");
        let at = stage.handle(handle, &frame.into()).expect("three drives");
        assert_eq!(at.map(|x| x as f32), marker.at, "{name} at {} s", frame.time);
    }
    // The knob stands for b, and for one turn of everything more or less.
    let [x, y, _] = stage.handle(Handle::Ring, &frame.into()).expect("three drives");
    let b = stage.ring_b([x, y], frame.b_reference, &frame.into()).expect("three drives");
    assert!((b - frame.b_reference).abs() < 1e-12);
    let period = session.run().planes().expect("three drives").map().period();
    let next = stage.ring_b([x, y], frame.b_reference + 1.1 * period, &frame.into()).expect("three drives");
    assert!((next - b - period).abs() < 1e-12);
    // The end effector is marked where it is.
    let marker = scene.markers.iter().find(|m| m.name == "end_effector").expect("a marker");
    assert_eq!([marker.at[0], marker.at[1]], [frame.end_effector.re as f32, frame.end_effector.im as f32]);
}

/// While the pointer holds the target, the handle is under it, even if the frame lags behind.
#[test]
fn a_held_target_is_drawn_under_the_pointer() {
    let session = dragged_outside();
    let stage = Stage::of(session.run());
    let options =
        ViewOptions { drag_position: Some([0.1, 1.2]), highlighted: Some(Handle::Target), ..ViewOptions::default() };
    let scene = stage.scene(session.frame(), &options);
    let target = scene.markers.iter().find(|m| m.name == "target").expect("a marker");
    assert_eq!([target.at[0], target.at[1]], [0.1, 1.2]);
    let gap = scene.lines.iter().find(|l| l.name == "target/gap").expect("a line");
    assert_eq!(gap.points()[1], target.at);
}

/// The words about the reaction: green and zero on the reactionless path, red with its number off it.
#[test]
fn reactions_are_said() {
    let p = palette(Theme::Dark);
    for (case, still) in [("case-3", true), ("case-1", false)] {
        let mut session = open(case);
        session.play();
        session.tick(250);
        let scene = scene_of(&session);
        let said = scene.labels.iter().find(|l| l.text.starts_with("n_B")).expect("the moment");
        assert_eq!(said.colour, if still { p.zero } else { p.reaction });
        let moment = session.frame().base_moment();
        let sign = if moment < 0.0 { "−" } else { "" };
        assert_eq!(said.text == "n_B 0.000 N m", still);
        assert!(still || said.text == format!("n_B {sign}{:.3} N m", moment.abs()), "{}", said.text);
        let drawn = |name: &str| scene.lines.iter().any(|l| l.name == name && !l.strips.is_empty());
        assert_eq!(drawn("reaction/moment"), !still);
        assert!(!drawn("reaction/force"), "balanced: no force");
        assert!(scene.labels.iter().any(|l| l.text == "centre of mass at rest on the base pin"));
    }
}

/// Arrows at the pins, where asked for: along the forces, in one proportion, the largest named.
#[test]
fn pins_show_what_they_carry() {
    let mut session = open("case-1");
    session.play();
    session.tick(250);
    let (run, frame) = (session.run(), session.frame());
    let stage = Stage::of(run);
    let joints = Joints::of(&run.scenario().machine).expect("determinate");
    assert!(scene_of(&session).lines.iter().all(|l| !l.name.starts_with("pin_forces/")));
    let scene = stage.scene(frame, &ViewOptions { pin_forces: true, ..ViewOptions::default() });
    let worst = frame.inside.worst_pin().expect("one");
    let per_newton = 0.25 * stage.linkage().reach() / round_up(frame.inside.largest_force);
    for (i, pin) in joints.pins().iter().enumerate() {
        let force = frame.inside.pin(i).expect("defined");
        let Some(shaft) = scene.lines.iter().find(|l| l.name == format!("pin_forces/{}", pin.name)) else {
            assert!(force.norm() * per_newton <= 0.004 * stage.linkage().reach(), "{}", pin.name);
            continue;
        };
        let at = place_of(&pin.at, &frame.q.units());
        let want = [at, at + force * per_newton];
        for (got, want) in shaft.strips[0].iter().zip(want) {
            assert!((f64::from(got[0]) - want.re).hypot(f64::from(got[1]) - want.im) < 1e-6, "{}", pin.name);
        }
        let p = palette(Theme::Dark);
        assert_eq!(shaft.colour, if i == worst { p.reaction } else { p.ink });
    }
    let said = format!("{} {:.1} N", joints.pins()[worst].name, frame.inside.largest_force);
    assert!(scene.labels.iter().any(|l| l.text == said), "{said}");
    assert!(scene.labels.iter().any(|l| l.text.starts_with("pins: ") && l.text.ends_with(" N")));
}

/// Everything drawn is finite, on both themes and in both views, whatever the state.
#[test]
fn nothing_drawn_is_lost() {
    for session in [open("case-1"), open("case-2"), dragged_outside()] {
        for theme in [Theme::Dark, Theme::Light] {
            for dexterity in [Some(stillbase::picture::scene::Measure::Det), None] {
                let options = ViewOptions { theme, dexterity, ..ViewOptions::default() };
                let scene = Stage::of(session.run()).scene(session.frame(), &options);
                let points = scene.lines.iter().flat_map(Polyline::points).chain(scene.markers.iter().map(|m| m.at));
                let points = points.chain(scene.labels.iter().map(|l| l.at));
                assert!(points.flatten().all(f32::is_finite));
                assert!(scene.solids.iter().all(|s| s.world_from_item.iter().flatten().all(|x| x.is_finite())));
                assert!(scene.lines.iter().flat_map(|l| l.strips.iter()).all(|s| s.len() > 1), "a line has two ends");
                assert!(scene.labels.iter().all(|l| !l.text.is_empty()));
            }
        }
    }
}

fn placed(solid: &Solid, s: f64) -> Vector {
    let [x, _, _, at] = solid.world_from_item.map(|c| [f64::from(c[0]), f64::from(c[1])]);
    Vector::new(at[0] + s * x[0], at[1] + s * x[1])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Every bar's root, tip and pins lie where the machine has them, and its mesh is long enough for all of them.
    #[test]
    fn bars_are_where_the_machine_has_them(q in prop::array::uniform4(-7.0..7.0), which in 0..builtins().len()) {
        let machine = &builtins()[which];
        let linkage = LinkageModel::of(machine);
        let e = DriveAngles(PerDrive::from_fn(machine.drives(), |k| q[k])).units();
        let solids = linkage.solids(&e, Pose2::default(), false, &palette(Theme::Dark));
        for (part, link) in machine.resolved_links().iter().zip(machine.links()) {
            let solid = solids.iter().find(|s| s.name == format!("machine/link/{}", link.name)).expect("every link");
            let mesh = &linkage.model.meshes[solid.mesh];
            let xs = || mesh.positions.iter().map(|p| f64::from(p[0]));
            let (from, to) = (xs().fold(f64::INFINITY, f64::min), xs().fold(f64::NEG_INFINITY, f64::max));
            for s in part.pins.iter().copied().chain([0.0, part.length, link.com]) {
                let gap = placed(solid, s) - place_of(&part.point(s), &e);
                prop_assert!(gap.norm() < 1e-6, "link {}: {:e} m off at {}", link.name, gap.norm(), s);
                prop_assert!(from <= s && s <= to, "link {}: {} outside {}..{}", link.name, s, from, to);
            }
        }
        // The arm that carries the end effector ends in it.
        let last = &machine.links()[machine.end_link()].name;
        let solid = solids.iter().find(|s| s.name == format!("machine/link/{last}")).expect("the last arm");
        let tip = placed(solid, machine.resolved_links()[machine.end_link()].length);
        prop_assert!((tip - place_of(machine.end_effector(), &e)).norm() < 1e-6);
        // A joint is drawn on every pin off B: each lies on a joint, and each joint on a pin.
        let pins: Vec<Vector> = machine.resolved_links().iter()
            .flat_map(|p| p.pins.iter().map(|s| place_of(&p.point(*s), &e)))
            .filter(|p| p.norm() > 1e-9)
            .collect();
        let joints: Vec<Vector> = solids.iter()
            .filter(|s| s.name == "machine/joints")
            .map(|s| placed(s, 0.0))
            .collect();
        for (some, others) in [(&pins, &joints), (&joints, &pins)] {
            for p in some {
                prop_assert!(others.iter().any(|o| (o - p).norm() < 1e-6), "{} has no counterpart", p);
            }
        }
    }

    /// What is seen at a place of the picture is what lies there.
    #[test]
    fn a_ray_meets_the_point_that_is_seen(
        camera in any_camera(),
        place in prop::array::uniform2(0.02..0.98),
        aspect in 0.4..3.0,
        height in -0.1..0.3,
    ) {
        let ray = camera.ray(place, aspect).expect("a regular view");
        let length: f64 = ray.along.iter().map(|x| x * x).sum();
        prop_assert!((length - 1.0).abs() < 1e-9);
        if let Some([x, y]) = ray.at_height(height) {
            let seen = camera.project([x, y, height], aspect).expect("in front of the eye");
            prop_assert!((seen[0] - place[0]).abs() + (seen[1] - place[1]).abs() < 1e-6, "{:?} and {:?}", seen, place);
        } else {
            // Only above the horizon is there nothing to meet.
            prop_assert!(!camera.is_flat() && ray.along[2] * (height - ray.from[2]) <= 0.0);
        }
    }

    /// The other way round: from a point of the plane to the picture and back.
    #[test]
    fn a_point_is_found_where_it_is_seen(camera in any_camera(), x in -0.8..0.8, y in -0.8..0.8, aspect in 0.4..3.0) {
        let seen = camera.project([x, y, 0.05], aspect).expect("in front of the eye");
        let [u, v] = camera.ray(seen, aspect).and_then(|r| r.at_height(0.05)).expect("the plane is in sight");
        prop_assert!((u - x).abs() + (v - y).abs() < 1e-6, "({}, {}) came back as ({}, {})", x, y, u, v);
    }

    /// The matrix for the GPU and the projection for the pointer are one.
    #[test]
    fn clip_space_is_the_projection(camera in any_camera(), p in prop::array::uniform3(-0.5..0.5), aspect in 0.4..3.0) {
        let m = camera.clip_from_world(aspect).map(|c| c.map(f64::from));
        let clip: [f64; 4] = std::array::from_fn(|r| m[0][r] * p[0] + m[1][r] * p[1] + m[2][r] * p[2] + m[3][r]);
        let [u, v] = camera.project(p, aspect).expect("in front of the eye");
        prop_assert!((0.5 + 0.5 * clip[0] / clip[3] - u).abs() < 1e-4);
        prop_assert!((0.5 - 0.5 * clip[1] / clip[3] - v).abs() < 1e-4);
        prop_assert!((0.0..=1.0).contains(&(clip[2] / clip[3])), "depth {}", clip[2] / clip[3]);
    }

    /// Zooming keeps the place under the pointer; panning moves the picture with it.
    #[test]
    fn the_place_under_the_pointer_stays(
        centre in prop::array::uniform2(-0.5..0.5),
        half_height in 0.2..3.0,
        place in prop::array::uniform2(0.0..1.0),
        factor in 0.5..2.0,
        aspect in 0.4..3.0,
    ) {
        let before = Camera::Flat(FlatCamera { centre, half_height });
        let world = |c: &Camera, place| c.ray(place, aspect).and_then(|r| r.at_height(0.0)).expect("flat");
        let mut zoomed = before;
        zoomed.zoom(factor, place, aspect);
        let ([x, y], [u, v]) = (world(&before, place), world(&zoomed, place));
        prop_assert!((x - u).abs() + (y - v).abs() < 1e-9, "({}, {}) and ({}, {})", x, y, u, v);
        prop_assert!((zoomed.scale(aspect) / before.scale(aspect) - factor).abs() < 1e-9);
        let mut panned = before;
        panned.pan(0.1, 0.2, aspect);
        let to = [place[0] + 0.1 / aspect, place[1] + 0.2];
        let ([x, y], [u, v]) = (world(&before, place), world(&panned, to));
        prop_assert!((x - u).abs() + (y - v).abs() < 1e-9, "({}, {}) and ({}, {})", x, y, u, v);
    }
}

fn any_camera() -> impl Strategy<Value = Camera> {
    let flat = (prop::array::uniform2(-0.5..0.5), 0.2..3.0)
        .prop_map(|(centre, half_height)| Camera::Flat(FlatCamera { centre, half_height }));
    // The eye stays above the plane and outside the machine.
    let orbit = (prop::array::uniform2(-0.3..0.3), 2.5..6.0, -3.0..6.0, 0.3..1.55)
        .prop_map(|([x, y], distance, yaw, pitch)| Camera::Orbit(Orbit { centre: [x, y, 0.0], distance, yaw, pitch }));
    prop_oneof![flat, orbit]
}

#[test]
fn views_look_where_they_say() {
    let flat = Camera::flat(1.26);
    assert_eq!(flat.eye_direction(), [0.0, 0.0, 1.0]);
    // From the front: x to the right, y away, so that it is farther up.
    let mut orbit = Camera::orbit(1.26);
    orbit.turn(-0.45, 0.0);
    let [a, b] = [[0.0, 0.0, 0.0], [0.3, 0.2, 0.0]].map(|p| orbit.project(p, 1.5).expect("in sight"));
    assert!(b[0] > a[0] && b[1] < a[1], "{a:?} {b:?}");
    // Straight above and edge on are views too.
    for pitch in [-10.0, 10.0] {
        orbit.turn(0.3, pitch);
        assert!(orbit.project([0.1, 0.1, 0.0], 1.5).is_some_and(|p| p.iter().all(|x| x.is_finite())));
    }
    // A picture without width does not break it.
    for aspect in [0.0, f64::NAN, f64::INFINITY, -1.0] {
        assert!(flat.clip_from_world(aspect).iter().flatten().all(|x| x.is_finite()));
    }
    assert!(unit(0.0).re == 1.0);
}

/// Case 1 on a base that floats, at its end, with a payload in hand.
fn floating() -> Session {
    let mut scenario = Scenario::builtin("case-1").expect("built in");
    scenario.base.kind = stillbase::simulation::plant::BaseKind::Free;
    scenario.plant.payload.mass = 0.3;
    scenario.plant.payload.offset = [0.05, -0.02];
    let mut session = Session::open(scenario).expect("it can start");
    session.seek(1.0);
    session
}

/// The machine is drawn where its base is; its workspace goes along, and the target does not.
#[test]
fn all_of_the_machine_goes_with_its_base() {
    let session = floating();
    let f = session.frame();
    assert!(f.base.angle.abs() > 1e-3 && f.base.at.norm() > 1e-4, "{:?}", f.base);
    let still = {
        let mut still = *f;
        still.q.0.iter_mut().for_each(|q| *q -= f.base.angle);
        (still.end_effector, still.com, still.base) = (f.in_base(f.end_effector), f.in_base(f.com), Pose2::default());
        still
    };
    let stage = Stage::of(session.run());
    for times in [1.0, 20.0] {
        let options = ViewOptions { exaggeration: Exaggeration::Times(times), ..Default::default() };
        let (moved, unmoved) = (stage.scene(f, &options), stage.scene(&still, &options));
        let (at, turn) = (f.base.at * times, unit(f.base.angle * times));
        let seen = |scene: &Scene, name: &str| {
            let solid = scene.solids.iter().find(|s| s.name == name).expect("a solid").world_from_item[3];
            Vector::new(f64::from(solid[0]), f64::from(solid[1]))
        };
        for name in [
            "machine/link/1",
            "machine/link/5",
            "machine/link/9",
            "machine/joints",
            "machine/base",
            "machine/base/body",
        ] {
            let want = at + seen(&unmoved, name) * turn;
            assert!((seen(&moved, name) - want).norm() < 1e-6, "{name} at {times} times");
        }
        let area = |scene: &Scene| scene.areas.last().expect("a workspace").clone();
        let [x, y] = area(&moved).at;
        assert!((Vector::new(f64::from(x), f64::from(y)) - at).norm() < 1e-6);
        let more = f64::from(area(&moved).turn - area(&unmoved).turn);
        assert!((unit(more) - turn).norm() < 1e-6);
        let mark = |scene: &Scene, name: &str| scene.markers.iter().find(|m| m.name == name).expect("a marker").at;
        assert_eq!(mark(&moved, "target"), mark(&unmoved, "target"), "it stays where it was set");
        assert!(mark(&moved, "payload") != mark(&moved, "end_effector"));
        let ghost = |scene: &Scene| scene.lines.iter().any(|l| l.name == "unmoved");
        assert!(ghost(&moved) && !ghost(&unmoved), "a ghost where there is a difference");
        assert!(moved.labels.iter().any(|l| l.text.ends_with("shown ×20")) == (times == 20.0));
    }
    // The disc of the payload is where the plant has its centre of mass.
    let scene = stage.scene(f, &ViewOptions::default());
    let marker = scene.markers.iter().find(|m| m.name == "payload").expect("held");
    let scenario = session.scenario();
    let chain = scenario.plant.payload.held_by(&scenario.machine).expect("valid").payload_chain();
    let want = f.base.at + f.q.units().iter().zip(chain).map(|(e, a)| e * a).sum::<Vector>();
    assert!((Vector::new(f64::from(marker.at[0]), f64::from(marker.at[1])) - want).norm() < 1e-6);
}

proptest! {
    /// Motion is shown by the least round number of times with which it is seen, and noise never.
    #[test]
    fn motion_is_exaggerated_no_more_than_needed(size in -9.0..1.0f64, tilts: bool) {
        let motion = 10f64.powf(size);
        let times = exaggeration(if tilts { [0.0, motion] } else { [motion, 0.0] }, 1.0);
        prop_assert!(times >= 1.0);
        if times > 1.0 && times < 1e6 {
            prop_assert!((0.041 - 1e-9..0.041 * 2.5).contains(&(times * motion)), "{times} times {motion}");
            let mantissa = times / 10f64.powf(times.log10().floor() + 1e-12).round();
            prop_assert!([1.0, 2.0, 5.0, 10.0].iter().any(|m| (m - mantissa).abs() < 1e-9), "{times}");
        }
        prop_assert_eq!(exaggeration([1e-14, 0.0], 1.0), 1.0);
        prop_assert_eq!(exaggeration([f64::NAN, 0.0], 1.0), 1.0);
    }

    /// Seen from the base nothing changes, and once is as it is.
    #[test]
    fn exaggeration_moves_all_alike(times in 1.0..100.0f64) {
        let session = floating();
        let frame = session.frame();
        let once = DrawnFrame::from(frame);
        prop_assert_eq!((once.base, once.q, once.end_effector, once.com), (frame.base, frame.q, frame.end_effector, frame.com));
        let more = DrawnFrame::of(frame, Exaggeration::Times(times));
        prop_assert!((more.in_base(more.end_effector) - frame.in_base(frame.end_effector)).norm() < 1e-12);
        prop_assert!((more.in_base(more.com) - frame.in_base(frame.com)).norm() < 1e-12);
        for k in 0..3 {
            prop_assert!((more.q[k] - more.base.angle - frame.relative(k)).abs() < 1e-12);
        }
        let tip = more.base.at + stillbase::mechanics::kinematics::end_effector(session.scenario().machine.end_effector(), &more.q.units());
        prop_assert!((more.end_effector - tip).norm() < 1e-12);
    }
}

/// On a base that gives way the ring stays where the target is, and how far the end effector is from it is said.
#[test]
fn a_miss_is_shown_and_said() {
    let session = floating();
    let f = session.frame();
    let (goal, tip) = (f.in_base(f.end_effector), f.end_effector);
    let miss = 1e3 * (tip - goal).norm();
    assert!(miss > 1.0, "{miss} mm");
    let stage = Stage::of(session.run());
    for times in [1.0, 20.0] {
        let scene = stage.scene(f, &ViewOptions { exaggeration: Exaggeration::Times(times), ..Default::default() });
        let said = |words: &str| scene.labels.iter().any(|l| l.text == words);
        assert!(said(&format!("{:.3}, {:.3} m", goal.re, goal.im)), "the ring's own place");
        for words in [format!("end effector {:.3}, {:.3} m", tip.re, tip.im), format!("{miss:.1} mm off")] {
            assert!(said(&words), "{words}: {:?}", scene.labels);
        }
        let line = scene.lines.iter().find(|l| l.name == "target/miss").expect("a line between");
        let at = |name: &str| scene.markers.iter().find(|m| m.name == name).expect("a marker").at;
        assert_eq!(line.points(), [at("end_effector"), at("target")]);
    }
    let still = scene_of(&open("case-3"));
    assert!(still.lines.iter().all(|l| l.name != "target/miss"));
}

/// A distance and an angle.
fn measured() -> Vec<Measurement> {
    let pin = SnapPoint::Pin(vec!["1".into(), "5".into()]);
    let points = vec![SnapPoint::EndEffector, pin, SnapPoint::BasePin];
    vec![Measurement::of(vec![SnapPoint::Place([0.1, -0.3]), SnapPoint::CentreOfMass]), Measurement::of(points)]
}

/// Measures end where their points are drawn, and say what is true of them.
#[test]
fn a_measure_is_drawn_with_its_points_and_says_what_is_true() {
    let session = floating();
    let frame = session.frame();
    let stage = Stage::of(session.run());
    let point = SnapPoint::Pin(vec!["1".into(), "5".into()]);
    let length = session.scenario().machine.resolved_links()[0].length;
    let pin = frame.base.at + unit(frame.q[0]) * length;
    let [u, v] = [frame.end_effector - pin, frame.base.at - pin];
    let angle = (u.re * v.re + u.im * v.im) / (u.norm() * v.norm());
    for exaggeration in [Exaggeration::default(), Exaggeration::Times(20.0), Exaggeration::Mount(0.03)] {
        let shown = DrawnFrame::of(frame, exaggeration);
        let drawn = shown.base.at + unit(shown.q[0]) * length;
        assert!((stage.position(&point, &shown).expect("a pin") - drawn).norm() < 1e-12);
        let options = ViewOptions { exaggeration, measurements: measured(), ..Default::default() };
        let scene = stage.scene(frame, &options);
        let line = scene.lines.iter().find(|line| line.name == "measures/2/line").expect("drawn");
        for (end, want) in line.strips.iter().flatten().zip([shown.end_effector, drawn, drawn, shown.base.at]) {
            assert!((Vector::new(f64::from(end[0]), f64::from(end[1])) - want).norm() < 1e-6, "{end:?} for {want}");
        }
        let said = |name: &str| scene.labels.iter().find(|label| label.name == name).expect("said").text.clone();
        assert_eq!(said("measures/2/distance/1"), format!("{:.3} m", u.norm()));
        assert_eq!(said("measures/2/distance/2"), format!("{length:.3} m"));
        assert_eq!(said("measures/2/angle"), format!("{:.3} rad", angle.acos()));
        assert_eq!(said("measures/1/distance/1"), format!("{:.3} m", (frame.com - Vector::new(0.1, -0.3)).norm()));
    }
    // What the machine does not have is not drawn.
    let none = SnapPoint::Pin(vec!["1".into(), "99".into()]);
    let options = ViewOptions {
        measurements: vec![
            Measurement::of(vec![none, SnapPoint::BasePin]),
            Measurement::of(vec![SnapPoint::BasePin; 2]),
        ],
        ..Default::default()
    };
    let labels = stage.scene(frame, &options).labels;
    let said: Vec<&str> = labels.iter().filter(|l| l.name.starts_with("measures")).map(|l| l.text.as_str()).collect();
    assert_eq!(said, ["0.000 m"]);
}

/// What is exaggerated so that it can be seen enters no number: a scene says the same words however it is drawn, and
/// what is pulled at as it is drawn asks for the same.
#[test]
fn words_are_of_the_frame_however_it_is_drawn() {
    let bases = [None, Some(BaseKind::Free), Some(BaseKind::Compliant)];
    let mut said = 0;
    for case in ["case-1", "case-2", "case-3"] {
        for base in bases {
            let mut scenario = Scenario::builtin(case).expect("built in");
            if let Some(kind) = base {
                scenario.base = Base { kind, mass: 40.0, inertia: 2.0, ..scenario.base };
                scenario.plant.payload = Load { mass: 0.3, offset: [0.05, 0.02], ..Load::default() };
                scenario.plant.force = [0.4, -0.2];
            }
            let mut session = Session::open(scenario).expect("it starts");
            session.play();
            for step in [0, 137, 263, 400, 600] {
                session.tick(step);
                let (stage, frame) = (Stage::of(session.run()), session.frame());
                let others = vec![OtherRun { name: "1".into(), frame: *frame }];
                let options = ViewOptions {
                    pin_forces: true,
                    limits: true,
                    external_force: Some([0.4, -0.2]),
                    others,
                    measurements: measured(),
                    notes: vec![Note {
                        text: "a note".into(),
                        point: Some(SnapPoint::CentreOfMass),
                        time: NoteTime::Always,
                    }],
                    ..Default::default()
                };
                let texts = |exaggeration| -> Vec<String> {
                    let scene = stage.scene(frame, &ViewOptions { exaggeration, ..options.clone() });
                    let text = |label: &Label| label.text.split(" · shown ×").next().unwrap_or_default().to_owned();
                    // The scale of the drawing is said, too.
                    let is_scale = |text: &String| text.starts_with("drawn on a soft mount");
                    scene.labels.iter().map(text).filter(|text| !is_scale(text)).collect()
                };
                let plain = texts(Exaggeration::default());
                said += plain.len();
                for exaggeration in [
                    Exaggeration::Times(20.0),
                    Exaggeration::Times(500.0),
                    Exaggeration::Mount(0.03),
                    Exaggeration::Mount(-0.4),
                ] {
                    assert_eq!(texts(exaggeration), plain, "{case}, {base:?}, {} s, {exaggeration:?}", frame.time);
                    let shown = DrawnFrame::of(frame, exaggeration);
                    let [x, y, _] = stage.handle(Handle::Ring, &shown).expect("three drives");
                    let b = stage.ring_b([x, y], frame.b_reference, &shown).expect("three drives");
                    assert!((b - frame.b_reference).abs() < 1e-11, "{b} {exaggeration:?}");
                    if let Some(at) = stage.payload(&shown) {
                        let [along, across] = stage.load_offset(&shown, [at.re, at.im]);
                        assert!((along - 0.05).abs() + (across - 0.02).abs() < 1e-12, "{along} {across}");
                    }
                }
            }
        }
    }
    assert!(said > 400, "{said} texts");
}
