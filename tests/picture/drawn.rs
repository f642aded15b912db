//! The linked views, measured in pixels.

use stillbase::mechanics::planar::Vector;
use stillbase::picture::render::View;
use stillbase::picture::render::offscreen::Picture;
use stillbase::picture::scene::Measure;
use stillbase::picture::scene::camera::Camera;
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::palette::{Theme, palette};
use stillbase::picture::scene::views::{ViewKind, Views};
use stillbase::picture::scene::wall::Wall;
use stillbase::session::Session;
use stillbase::session::scenario::Scenario;

use crate::Test;
use crate::gpu::gpu;

pub const TESTS: &[Test] =
    tests![tower_and_joint_space_are_drawn, dexterity_shades_as_the_measure_says, every_layer_of_a_shell_counts,];

fn open(case: &str) -> Session {
    Session::open(Scenario::builtin(case).expect("built in")).expect("it can start")
}

fn view(camera: &Camera, size_px: [u32; 2]) -> View {
    View {
        clip_from_world: camera.clip_from_world(f64::from(size_px[0]) / f64::from(size_px[1])),
        eye_direction: camera.eye_direction(),
        size_px,
        pixels_per_point: 1.0,
    }
}

/// Pixels near a colour.
fn count(picture: &Picture, colour: [f32; 4], within: f32) -> usize {
    let near = |p: &[u8]| (0..3).all(|i| (f32::from(p[i]) / 255.0 - colour[i]).abs() < within);
    picture.rgba.chunks_exact(4).filter(|p| near(p)).count()
}

fn tower_and_joint_space_are_drawn() {
    let mut gpu = gpu();
    let session = open("case-3");
    let views = Views::of(session.run());
    for theme in [Theme::Dark, Theme::Light] {
        let p = palette(theme);
        for (kind, green) in [(ViewKind::Tower, true), (ViewKind::Joints, false)] {
            let camera = views.camera(kind);
            let options = ViewOptions { theme, ..ViewOptions::default() };
            let scene = views.scene(kind, session.frame(), &options, &camera);
            let picture = gpu.picture(&scene, &view(&camera, [600, 600])).expect("a picture");
            let (amber, edge) = (count(&picture, p.amber, 0.06), p.background);
            assert!(amber > 300, "{kind:?}: {amber} pixels of amber");
            assert!(!green || count(&picture, p.zero, 0.12) > 150, "bars");
            // The whole box is in the picture, and does not touch its edge.
            for i in 0..600 {
                for (x, y) in [(i, 0), (i, 599), (0, i), (599, i)] {
                    let pixel = picture.pixel(x, y).expect("inside").map(|b| f32::from(b) / 255.0);
                    assert!((0..3).all(|c| (pixel[c] - edge[c]).abs() < 0.01), "{kind:?} is cut off at {x}, {y}");
                }
            }
        }
    }
}

/// The shade at the end effector is the mixture that the measure says.
fn dexterity_shades_as_the_measure_says() {
    for measure in Measure::ALL {
        shades(measure);
    }
}

fn shades(measure: Measure) {
    let mut gpu = gpu();
    let session = open("case-3");
    let (frame, views) = (session.frame(), Views::of(session.run()));
    let map = *session.run().planes().expect("three drives").map();
    let camera = views.camera(ViewKind::Flat);
    let options = ViewOptions { dexterity: Some(measure), ..ViewOptions::default() };
    let mut scene = views.scene(ViewKind::Flat, frame, &options, &camera);
    (scene.solids, scene.lines, scene.markers) = Default::default();
    scene.areas.remove(0);
    let area = &scene.areas[0];
    let shade = area.shade.expect("shaded");
    let size = [800, 800];
    let picture = gpu.picture(&scene, &view(&camera, size)).expect("a picture");
    for a in [[0.3, 0.5], [1.5, 1.5], [2.6, 2.2], [0.8, 2.9], [1.2, 0.1]] {
        let p = map.forward(a, frame.b_reference);
        let [u, v] = camera.project([p.re, p.im, f64::from(area.z)], 1.0).expect("in sight");
        let pixel = picture.pixel((u * 800.0) as u32, (v * 800.0) as u32).expect("in the picture");
        let (empty, full) = (f64::from(shade.empty), f64::from(shade.full));
        let share = ((measure.of(&map, a) - empty) / (full - empty)) as f32;
        let mixed: [f32; 4] = std::array::from_fn(|i| area.colour[i] + share * (shade.colour[i] - area.colour[i]));
        for (i, got) in pixel[..3].iter().enumerate() {
            let want = scene.background[i] + mixed[3] * (mixed[i] - scene.background[i]);
            assert!((f32::from(*got) / 255.0 - want).abs() < 0.015, "{a:?}: {got} for {want}");
        }
    }
}

fn every_layer_of_a_shell_counts() {
    let mut gpu = gpu();
    let circle: Vec<Vector> =
        (0..720).map(|i| Vector::from_polar(0.8, f64::from(i) * std::f64::consts::TAU / 720.0)).collect();
    let session = open("case-3");
    let views = Views::of(session.run());
    let mut scene =
        views.scene(ViewKind::Tower, session.frame(), &ViewOptions::default(), &views.camera(ViewKind::Tower));
    (scene.areas, scene.lines, scene.markers) = Default::default();
    scene.background = [0.0, 0.0, 0.0, 1.0];
    scene.solids.retain(|s| s.name == "wall");
    scene.solids[0].mesh = 0;
    scene.solids[0].colour = [1.0, 1.0, 1.0, 0.2];
    scene.model =
        std::sync::Arc::new(stillbase::picture::scene::MeshSet { meshes: vec![Wall::of(&[circle], 0.0).mesh(2.0)] });
    use stillbase::picture::scene::camera::Orbit;
    let camera = Camera::Orbit(Orbit { centre: [0.0, 0.0, 1.0], distance: 12.0, yaw: 0.0, pitch: 0.0 });
    let mut levels = Vec::new();
    for mirrored in [false, true] {
        // Looked at through a mirror, every face turns its other side; what is seen does not change.
        if mirrored {
            scene.solids[0].world_from_item[0].iter_mut().for_each(|x| *x = -*x);
        }
        let picture = gpu.picture(&scene, &view(&camera, [201, 201])).expect("a picture");
        levels.push(picture.pixel(100, 100).expect("the middle")[0]);
    }
    // Two layers of 0.2 leave 0.64 of the black: at most 0.36, and more than one layer could give.
    assert!(levels.iter().all(|l| (55..=92).contains(l)), "{levels:?}");
}
