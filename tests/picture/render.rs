//! Pictures hold what the scene says, measured in pixels.

use std::f32::consts::PI;
use std::sync::Arc;
use stillbase::picture::render::offscreen::{NoPicture, Picture, surface};
use stillbase::picture::render::{Quality, Renderer, View};
use stillbase::picture::scene::palette::{Theme, faded, palette};
use stillbase::picture::scene::{
    Area, IN_PLACE, ItemChanges, Marker, Mesh, MeshSet, Polyline, Rgba, Scene, Solid, mesh,
};

use crate::Test;
use crate::gpu::{fresh, gpu};

pub const TESTS: &[Test] = tests![
    an_empty_scene_is_its_background,
    a_draft_differs_at_edges_only,
    a_solid_from_above_keeps_its_colour,
    bevels_are_darker_than_tops_but_keep_their_hue,
    the_nearer_solid_hides_the_other_whatever_the_order,
    a_hairline_of_background_sets_solids_off,
    an_area_lies_over_what_is_behind_it,
    a_ghost_shows_what_lies_behind_it_through_one_layer,
    a_model_is_uploaded_when_it_changes,
    a_line_is_as_wide_as_it_says,
    a_slanted_line_is_as_wide_too,
    joins_have_neither_gaps_nor_knots,
    dashes_take_their_share_and_go_round_corners,
    dashes_as_long_as_wide_are_dots,
    solids_hide_lines_below_and_not_those_on_top,
    a_line_through_the_eye_is_cut_in_front_of_it,
    the_workspace_of_the_nine_link_machine_has_its_area,
    turning_rotates_the_workspace,
    overlapping_sheets_gather,
    markers_are_round_and_may_be_hollow,
    a_clear_background_stays_clear_and_colours_straight,
    the_same_scene_is_the_same_picture_to_the_byte,
    a_steady_state_allocates_nothing_on_the_gpu,
    the_picture_reaches_any_target_unchanged,
    a_renderer_may_live_in_a_windows_callbacks,
    nonsense_is_survived,
    a_png_holds_the_picture,
    demonstration_pictures_are_not_empty,
];

const WHITE: Rgba = [1.0; 4];
const BLACK: Rgba = [0.0, 0.0, 0.0, 1.0];
const RED: Rgba = [0.8, 0.2, 0.1, 1.0];

fn empty(background: Rgba) -> Scene {
    Scene::new(background, Default::default())
}

/// From above: a square of half a side `half` metres around `centre`, x right and y up, depth over z from 10 to -10.
fn flat([x, y]: [f32; 2], half: f32, side_px: u32) -> View {
    let s = 1.0 / half;
    View {
        clip_from_world: [[s, 0.0, 0.0, 0.0], [0.0, s, 0.0, 0.0], [0.0, 0.0, -0.05, 0.0], [-x * s, -y * s, 0.5, 1.0]],
        eye_direction: [0.0, 0.0, 1.0],
        size_px: [side_px, side_px],
        pixels_per_point: 1.0,
    }
}

fn perspective(eye: [f32; 3], at: [f32; 3], size_px: [u32; 2], pixels_per_point: f32) -> View {
    use nalgebra::{Matrix4, Point3, Vector3};
    let (eye, at) = (Point3::from(eye), Point3::from(at));
    let depth = Matrix4::new(
        1.0, 0.0, 0.0, 0.0, //
        0.0, 1.0, 0.0, 0.0, //
        0.0, 0.0, 0.5, 0.5, //
        0.0, 0.0, 0.0, 1.0,
    );
    let aspect = size_px[0] as f32 / size_px[1] as f32;
    let clip_from_eye = depth * Matrix4::new_perspective(aspect, 0.6, 0.1, 20.0);
    let clip_from_world = clip_from_eye * Matrix4::look_at_rh(&eye, &at, &Vector3::z());
    let eye_direction = (eye - at).normalize();
    View { clip_from_world: clip_from_world.into(), eye_direction: eye_direction.into(), size_px, pixels_per_point }
}

/// Turned by `angle` about z and moved to (x, y, z).
fn placed(angle: f32, [x, y, z]: [f32; 3]) -> [[f32; 4]; 4] {
    let (s, c) = angle.sin_cos();
    [[c, s, 0.0, 0.0], [-s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [x, y, z, 1.0]]
}

fn solid(mesh: usize, world_from_mesh: [[f32; 4]; 4], colour: Rgba) -> Solid {
    let name = format!("solid/{mesh}").into();
    Solid { name, mesh, world_from_item: world_from_mesh, colour, changes: ItemChanges::Nothing }
}

fn line(points: &[[f32; 3]], width: f32, colour: Rgba) -> Polyline {
    Polyline::new("line", [points.to_vec()], width, colour)
}

fn disc(at: [f32; 3], radius: f32, fill: Rgba, stroke: Rgba, stroke_width: f32) -> Marker {
    Marker::disc("marker", at, radius, fill).edged(stroke, stroke_width)
}

/// Eq. (16) with Table I's lengths and λ: the end effector is c_1 e(q_1) + c_2 e(q_2) + c_3 e(q_3) at b* + the rest.
fn nine_link(b: f32) -> Area {
    let (l2, l3) = (0.116746264f64 as f32, 0.127920111f64 as f32);
    let sum = 1.0 + l2 + l3;
    // q_1 = b* + (λ_3 (π - a_2) - a_1 (λ_2 + λ_3)) / Σλ, q_2 = q_1 + a_1, q_3 = q_2 + a_2 - π.
    let (q1_a1, q1_a2, q1_0) = (-(l2 + l3) / sum, -l3 / sum, l3 * PI / sum);
    Area {
        name: "workspace".into(),
        c: [0.5, -0.46, -0.3],
        u: [[q1_a1, q1_a2], [q1_a1 + 1.0, q1_a2], [q1_a1 + 1.0, q1_a2 + 1.0]],
        v: [q1_0, q1_0, q1_0 - PI],
        a_min: [0.0; 2],
        a_max: [PI; 2],
        turn: b / sum,
        at: [0.0; 2],
        z: 0.0,
        world_from_plane: IN_PLACE,
        colour: WHITE,
        shade: None,
    }
}

fn bytes(colour: Rgba) -> [u8; 4] {
    colour.map(|x| (x * 255.0).round() as u8)
}

fn assert_close(got: [u8; 4], colour: Rgba, within: u8) {
    let expected = bytes(colour);
    assert!(got.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= within), "{got:?} is not {expected:?}");
}

/// Sum of white on black over the pixels, in pixels.
fn coverage(pixels: impl IntoIterator<Item = [u8; 4]>) -> f64 {
    pixels.into_iter().map(|pixel| f64::from(pixel[0]) / 255.0).sum()
}

fn all(picture: &Picture) -> impl Iterator<Item = [u8; 4]> {
    picture.rgba.chunks_exact(4).map(|pixel| pixel.try_into().unwrap())
}

fn column(picture: &Picture, x: u32) -> impl Iterator<Item = [u8; 4]> {
    (0..picture.height).map(move |y| picture.pixel(x, y).unwrap())
}

fn an_empty_scene_is_its_background() {
    let mut gpu = gpu();
    for theme in [Theme::Dark, Theme::Light] {
        let background = palette(theme).background;
        let picture = gpu.picture(&empty(background), &flat([0.0; 2], 1.0, 16)).unwrap();
        assert!(all(&picture).all(|pixel| pixel == bytes(background)));
    }
}

fn a_solid_from_above_keeps_its_colour() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.model = Arc::new(MeshSet { meshes: vec![mesh::bar(-0.5, 0.5, 0.2, 0.1, 0.02)] });
    for theme in [Theme::Dark, Theme::Light] {
        for colour in palette(theme).drives.into_iter().chain([RED]) {
            scene.solids = vec![solid(0, placed(0.4, [0.0; 3]), colour)];
            let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 65)).unwrap();
            assert_close(picture.pixel(32, 32).unwrap(), colour, 1);
            assert_eq!(picture.pixel(2, 60).unwrap(), bytes(BLACK));
        }
    }
}

fn bevels_are_darker_than_tops_but_keep_their_hue() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.model = Arc::new(MeshSet { meshes: vec![mesh::cylinder(0.8, 0.6, 0.2)] });
    scene.solids = vec![solid(0, placed(0.0, [0.0; 3]), RED)];
    let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 100)).unwrap();
    let red = |x, y| picture.pixel(x, y).unwrap()[0];
    let (top, lit, shaded) = (red(50, 50), red(25, 25), red(75, 75));
    assert!(shaded < lit && lit <= top, "{shaded} {lit} {top}");
    assert!(f32::from(shaded) > 0.6 * f32::from(top));
}

fn the_nearer_solid_hides_the_other_whatever_the_order() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.model =
        Arc::new(MeshSet { meshes: vec![mesh::cylinder(0.8, 0.1, 0.0), mesh::bar(-0.5, 0.5, 0.2, 0.1, 0.0)] });
    let (low, high) = (solid(0, placed(0.0, [0.0; 3]), RED), solid(1, placed(0.0, [0.0, 0.0, 0.2]), WHITE));
    for solids in [[low.clone(), high.clone()], [high, low]] {
        scene.solids = solids.to_vec();
        let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 65)).unwrap();
        assert_close(picture.pixel(32, 32).unwrap(), WHITE, 1);
        assert_close(picture.pixel(32, 50).unwrap(), RED, 1);
    }
}

fn a_hairline_of_background_sets_solids_off() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.model = Arc::new(MeshSet { meshes: vec![mesh::cylinder(0.9, 0.1, 0.0), mesh::cylinder(0.4, 0.1, 0.02)] });
    scene.solids = vec![solid(0, placed(0.0, [0.0; 3]), WHITE), solid(1, placed(0.0, [0.0, 0.0, 0.2]), WHITE)];
    let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 200)).unwrap();
    // Leaving the upper disc of 40 px to the right: 1.25 px of background, then the lower disc.
    let row: Vec<_> = (100..200).map(|x| picture.pixel(x, 100).unwrap()[0]).collect();
    assert!(row[..36].iter().all(|&level| level > 250));
    let dark: f64 = row[40..60].iter().map(|&level| 1.0 - f64::from(level) / 255.0).sum();
    assert!((dark - 1.25).abs() < 0.3, "{dark} px");
    assert!(row[44..85].iter().all(|&level| level > 250));
}

fn an_area_lies_over_what_is_behind_it() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.model = Arc::new(MeshSet { meshes: vec![mesh::cylinder(2.0, 0.1, 0.0)] });
    scene.solids = vec![solid(0, placed(0.0, [0.0; 3]), RED)];
    for (z, seen) in [(-0.5, RED), (0.5, [0.9, 0.6, 0.55, 1.0])] {
        scene.areas = vec![Area { z, colour: faded(WHITE, 0.5), ..nine_link(2.4) }];
        let picture = gpu.picture(&scene, &flat([0.6, 0.6], 0.05, 20)).unwrap();
        assert_close(picture.pixel(10, 10).unwrap(), seen, 2);
    }
}

fn a_ghost_shows_what_lies_behind_it_through_one_layer() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.model = Arc::new(MeshSet { meshes: vec![mesh::cylinder(0.8, 0.1, 0.0)] });
    let ghost = solid(0, placed(0.0, [0.0, 0.0, 0.2]), faded(WHITE, 0.5));
    scene.solids = vec![ghost.clone(), solid(0, placed(0.0, [0.0; 3]), RED)];
    let view = flat([0.0; 2], 1.0, 65);
    let once = gpu.picture(&scene, &view).unwrap();
    assert_close(once.pixel(32, 32).unwrap(), [0.9, 0.6, 0.55, 1.0], 2);
    scene.solids.push(Solid { world_from_item: placed(0.0, [0.0, 0.0, 0.4]), ..ghost });
    let twice = gpu.picture(&scene, &view).unwrap();
    assert_close(twice.pixel(32, 32).unwrap(), [0.9, 0.6, 0.55, 1.0], 2);
}

fn a_model_is_uploaded_when_it_changes() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.solids = vec![solid(0, placed(0.0, [0.0; 3]), WHITE)];
    for radius in [0.5, 0.25, 0.75] {
        scene.model = Arc::new(MeshSet { meshes: vec![mesh::cylinder(radius, 0.1, 0.0)] });
        let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 200)).unwrap();
        let area = coverage(all(&picture)) / 100.0f64.powi(2);
        // A polygon of so many chords.
        let n = f64::from(mesh::SEGMENTS as u32);
        let expected = n / 2.0 * (std::f64::consts::TAU / n).sin() * radius * radius;
        assert!((area / expected - 1.0).abs() < 0.005, "{area} {expected}");
    }
}

fn a_line_is_as_wide_as_it_says() {
    let mut gpu = gpu();
    for (width, scale) in [(3.0, 1.0), (1.0, 1.0), (0.5, 1.0), (1.5, 2.0), (7.3, 1.0)] {
        for shift in [0.0, 0.003, 0.007] {
            let mut scene = empty(BLACK);
            scene.lines = vec![line(&[[-0.9, shift, 0.0], [0.9, shift, 0.0]], width, WHITE)];
            let view = View { pixels_per_point: scale, ..flat([0.0; 2], 1.0, 100) };
            let picture = gpu.picture(&scene, &view).unwrap();
            let got = coverage(column(&picture, 50));
            assert!((got - f64::from(width * scale)).abs() < 0.1, "{width} px: {got}");
        }
    }
}

fn a_slanted_line_is_as_wide_too() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    for angle in [0.3f32, 0.7, 1.2, 2.0] {
        let (s, c) = angle.sin_cos();
        scene.lines = vec![line(&[[-0.7 * c, -0.7 * s, 0.0], [0.7 * c, 0.7 * s, 0.0]], 3.0, WHITE)];
        let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 200)).unwrap();
        // A capsule 140 px long.
        let expected = 3.0 * 140.0 + f64::from(PI) * 1.5 * 1.5;
        let got = coverage(all(&picture));
        assert!((got / expected - 1.0).abs() < 0.01, "{got} {expected}");
    }
}

fn joins_have_neither_gaps_nor_knots() {
    let mut gpu = gpu();
    // Half opaque, many vertices, sharp and blunt corners: a pixel drawn twice would be brighter than 0.5.
    let mut scene = empty(BLACK);
    let circle = (0..=200).map(|k| ((k % 200) as f32 / 100.0 * PI).sin_cos()).map(|(s, c)| [0.6 * c, 0.6 * s, 0.0]);
    let corners = [[-0.8, -0.8, 0.0], [0.8, -0.8, 0.0], [-0.2, -0.3, 0.0], [0.0, 0.2, 0.0]];
    for (points, length) in [(circle.collect::<Vec<_>>(), 60.0 * f64::from(2.0 * PI)), (corners.to_vec(), 0.0)] {
        scene.lines = vec![line(&points, 6.0, faded(WHITE, 0.5))];
        let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 200)).unwrap();
        assert!(all(&picture).all(|pixel| pixel[0] <= 129), "a knot");
        for p in &points {
            let [x, y] = flat([0.0; 2], 1.0, 200).project(*p).unwrap();
            assert!(picture.pixel(x as u32, y as u32).unwrap()[0] >= 126, "a gap at {p:?}");
        }
        if length > 0.0 {
            let got = coverage(all(&picture)) / 0.5;
            assert!((got / (6.0 * length) - 1.0).abs() < 0.01, "{got}");
        }
    }
}

fn dashes_take_their_share_and_go_round_corners() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    let straight = [[-0.8f32, 0.0, 0.0], [0.8, 0.0, 0.0]];
    let cut: Vec<_> = (0..=40).map(|k| [-0.8 + 0.04 * k as f32, 0.0, 0.0]).collect();
    let mut pictures = Vec::new();
    for points in [&straight[..], &cut] {
        scene.lines = vec![Polyline { dash: Some([10.0, 6.0]), ..line(points, 1.0, WHITE) }];
        pictures.push(gpu.picture(&scene, &flat([0.0; 2], 1.0, 200)).unwrap());
    }
    // 160 px hold ten periods of sixteen.
    let row: Vec<_> = (0..200).map(|x| coverage(column(&pictures[0], x))).collect();
    let lit = row.iter().sum::<f64>();
    assert!((lit - 100.0).abs() < 4.0, "{lit}");
    let starts = row.windows(2).filter(|w| w[0] < 0.5 && w[1] >= 0.5).count();
    assert_eq!(starts, 10);
    // The same line in forty pieces is dashed alike.
    let worst = pictures[0].rgba.iter().zip(&pictures[1].rgba).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(3), "{worst:?}");
}

fn dashes_as_long_as_wide_are_dots() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.lines =
        vec![Polyline { dash: Some([10.0, 30.0]), ..line(&[[-0.8, 0.0, 0.0], [0.8, 0.0, 0.0]], 10.0, WHITE) }];
    let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 200)).unwrap();
    let got = coverage(all(&picture)) / (4.0 * 25.0 * f64::from(PI));
    assert!((got - 1.0).abs() < 0.02, "{got}");
}

fn solids_hide_lines_below_and_not_those_on_top() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.model = Arc::new(MeshSet { meshes: vec![mesh::cylinder(0.5, 0.1, 0.0)] });
    scene.solids = vec![solid(0, placed(0.0, [0.0; 3]), RED)];
    let below = line(&[[-0.9, 0.0, 0.0], [0.9, 0.0, 0.0]], 5.0, WHITE);
    for (line, seen) in [
        (below.clone(), RED),
        (Polyline { on_top: true, ..below.clone() }, WHITE),
        // On the very face of the solid: the bias decides for the line.
        (Polyline { strips: [vec![[-0.9, 0.0, 0.1], [0.9, 0.0, 0.1]]].into(), ..below }, WHITE),
    ] {
        scene.lines = vec![line];
        let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 65)).unwrap();
        assert_close(picture.pixel(32, 32).unwrap(), seen, 1);
        assert_close(picture.pixel(6, 32).unwrap(), WHITE, 1);
    }
}

fn a_line_through_the_eye_is_cut_in_front_of_it() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    // From in front of the eye to far behind it, and one wholly behind.
    scene.lines = vec![
        line(&[[0.0, 2.0, 0.0], [0.3, -9.0, 0.0]], 4.0, WHITE),
        line(&[[0.0, -4.0, 0.0], [1.0, -9.0, 0.0]], 4.0, RED),
    ];
    let view = perspective([0.0, -2.0, 0.5], [0.0, 0.0, 0.0], [200, 200], 1.0);
    let picture = gpu.picture(&scene, &view).unwrap();
    let got = coverage(all(&picture));
    assert!(got > 200.0 && got < 1200.0, "{got}");
    assert!(all(&picture).all(|[r, g, b, _]| r == g && g == b), "what is behind the eye shows");
    assert!((0..100).all(|x| coverage(column(&picture, x)) < 5.0 || x > 90), "the line folded over");
}

fn the_workspace_of_the_nine_link_machine_has_its_area() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    let (half, side) = (1.3, 1000);
    for b in [2.4, 0.3] {
        scene.areas = vec![nine_link(b)];
        let picture = gpu.picture(&scene, &flat([0.0; 2], half, side)).unwrap();
        let metres = f64::from(2.0 * half) / f64::from(side);
        let area = coverage(all(&picture)) * metres * metres;
        assert!((area / 0.8451 - 1.0).abs() < 0.005, "{area} m²");
    }
}

fn turning_rotates_the_workspace() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    let view = flat([0.0; 2], 1.3, 300);
    let area = nine_link(2.4);
    scene.areas = vec![area.clone()];
    let before = gpu.picture(&scene, &view).unwrap();
    scene.areas = vec![Area { turn: area.turn + 0.5 * PI, ..area }];
    let after = gpu.picture(&scene, &view).unwrap();
    // A quarter turn to the left takes (x, y) to (-y, x): the pixel in column x, row y to column y, row 299 - x.
    let differing = (0..300)
        .flat_map(|y| (0..300).map(move |x| (x, y)))
        .filter(|&(x, y)| before.pixel(x, y).unwrap()[0].abs_diff(after.pixel(y, 299 - x).unwrap()[0]) > 64)
        .count();
    assert!(differing < 10, "{differing} pixels differ");
    assert_ne!(before, after);
}

fn overlapping_sheets_gather() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    let area = Area { colour: faded(WHITE, 0.25), ..nine_link(2.4) };
    let view = flat([0.6, 0.6], 0.05, 20);
    for (sheets, level) in [(1, 0.25), (2, 0.4375), (3, 0.578)] {
        scene.areas = vec![area.clone(); sheets];
        let picture = gpu.picture(&scene, &view).unwrap();
        assert_close(picture.pixel(10, 10).unwrap(), [level, level, level, 1.0], 2);
    }
}

fn markers_are_round_and_may_be_hollow() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    scene.model = Arc::new(MeshSet { meshes: vec![mesh::cylinder(0.9, 0.5, 0.0)] });
    scene.solids = vec![solid(0, placed(0.0, [0.0; 3]), BLACK)];
    for (fill, area) in [([0.0; 4], 20.0f64.powi(2) - 16.0f64.powi(2)), (WHITE, 20.0f64.powi(2))] {
        scene.markers = vec![disc([0.0, 0.0, -1.0], 20.0, fill, WHITE, 4.0)];
        let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 101)).unwrap();
        let centre = if fill[3] > 0.0 { WHITE } else { BLACK };
        assert_close(picture.pixel(50, 50).unwrap(), centre, 0);
        assert_close(picture.pixel(50 + 18, 50).unwrap(), WHITE, 0);
        let got = coverage(all(&picture));
        assert!((got / (area * f64::from(PI)) - 1.0).abs() < 0.01, "{got}");
    }
}

fn a_clear_background_stays_clear_and_colours_straight() {
    let mut gpu = gpu();
    let mut scene = empty([0.0; 4]);
    scene.markers = vec![disc([0.0; 3], 8.0, faded(RED, 0.5), [0.0; 4], 0.0)];
    let picture = gpu.picture(&scene, &flat([0.0; 2], 1.0, 33)).unwrap();
    assert_eq!(picture.pixel(0, 0).unwrap(), [0; 4]);
    assert_close(picture.pixel(16, 16).unwrap(), faded(RED, 0.5), 2);
}

fn the_same_scene_is_the_same_picture_to_the_byte() {
    let (mut gpu, mut other) = (gpu(), fresh());
    for (scene, view) in demo() {
        let picture = gpu.picture(&scene, &view).unwrap();
        assert!(picture == gpu.picture(&scene, &view).unwrap());
        assert!(picture == other.picture(&scene, &view).unwrap());
    }
}

fn a_steady_state_allocates_nothing_on_the_gpu() {
    let mut gpu = fresh();
    let (scene, view) = demo().remove(0);
    let mut allocated = || {
        gpu.picture(&scene, &view).unwrap();
        gpu.device().generate_allocator_report().map(|report| (report.allocations.len(), report.total_allocated_bytes))
    };
    for _ in 0..5 {
        allocated();
    }
    let before = allocated();
    assert!(before.is_some_and(|(count, bytes)| count > 0 && bytes > 0), "the driver keeps no books: {before:?}");
    for _ in 0..20 {
        assert_eq!(allocated(), before);
    }
}

fn the_picture_reaches_any_target_unchanged() {
    let mut gpu = gpu();
    let (scene, view) = demo().remove(2);
    let expected = gpu.picture(&scene, &view).unwrap();
    use wgpu::TextureFormat::{Bgra8Unorm, Bgra8UnormSrgb, Rgba8Unorm, Rgba8UnormSrgb};
    for format in [Rgba8Unorm, Bgra8Unorm, Rgba8UnormSrgb, Bgra8UnormSrgb] {
        let (device, queue) = (gpu.device().clone(), gpu.queue().clone());
        let mut renderer = Renderer::new(&device, format);
        let texture = surface(&device, view.size_px, format);
        let mut encoder = device.create_command_encoder(&Default::default());
        renderer.prepare(&device, &queue, &mut encoder, &scene, &view);
        let mut pass = encoder
            .begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &texture.create_view(&Default::default()),
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::RED), store: wgpu::StoreOp::Store },
                })],
                ..Default::default()
            })
            .forget_lifetime();
        renderer.paint(&mut pass);
        drop(pass);
        queue.submit([encoder.finish()]);
        let got = gpu.readback(&texture).unwrap();
        let worst = got.rgba.iter().zip(&expected.rgba).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(u8::from(format.is_srgb())), "{format:?}: {worst:?}");
    }
}

fn a_renderer_may_live_in_a_windows_callbacks() {
    fn shared<T: Send + Sync + 'static>() {}
    shared::<Renderer>();
}

fn nonsense_is_survived() {
    let mut gpu = gpu();
    let mut scene = empty(BLACK);
    let nan = [f32::NAN; 3];
    let bad = Mesh {
        positions: vec![nan; 3],
        normals: vec![[0.0; 3]; 2],
        triangles: vec![[0, 1, 2], [7, 8, 9]],
        coarse: None,
        shell: false,
    };
    scene.model = Arc::new(MeshSet { meshes: vec![bad, Mesh::default()] });
    scene.solids = (0..4).map(|k| solid(k, [[f32::NAN; 4]; 4], RED)).collect();
    scene.lines = vec![
        line(&[], 1.0, WHITE),
        line(&[[0.0; 3]], 1.0, WHITE),
        line(&[[0.0; 3], [0.0; 3]], 1.0, WHITE),
        line(&[nan, [f32::INFINITY; 3], nan], 1.0, WHITE),
        line(&[[0.0; 3], [1.0; 3]], f32::NAN, WHITE),
        Polyline { dash: Some([0.0, 0.0]), ..line(&[[0.0; 3], [0.0, 0.0, 1.0]], -1.0, WHITE) },
        Polyline { dash: Some([f32::NAN, -1.0]), ..line(&[[0.0; 3], [0.0, 0.0, 1.0]], 2.0, RED) },
    ];
    scene.areas = vec![Area { a_max: [f32::NAN; 2], ..nine_link(2.4) }];
    scene.markers = vec![disc(nan, -1.0, WHITE, WHITE, f32::NAN)];
    gpu.picture(&scene, &flat([0.0; 2], 1.0, 33)).unwrap();
    gpu.picture(&scene, &View { clip_from_world: [[0.0; 4]; 4], ..flat([0.0; 2], 1.0, 33) }).unwrap();
    for size_px in [[0, 10], [10, 0], [u32::MAX, 10]] {
        let error = gpu.picture(&scene, &View { size_px, ..flat([0.0; 2], 1.0, 33) }).unwrap_err();
        assert!(matches!(error, NoPicture::Size { .. }), "{error}");
    }
}

fn a_png_holds_the_picture() {
    let picture = Picture { width: 2, height: 1, rgba: vec![1, 2, 3, 255, 4, 5, 6, 128] };
    let bytes = picture.to_png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let mut rgba = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rgba).unwrap();
    assert_eq!((info.width, info.height, rgba), (2, 1, picture.rgba.clone()));
    assert!(Picture { width: 3, ..picture }.to_png().is_err());
}

/// A machine-like scene, flat and in perspective.
fn demo() -> Vec<(Scene, View)> {
    let meshes = vec![
        mesh::bar(0.0, 0.5, 0.018, 0.02, 0.005),
        mesh::bar(-0.115, 0.46, 0.018, 0.02, 0.005),
        mesh::bar(-0.19, 0.3, 0.015, 0.02, 0.005),
        mesh::bar(0.0, 0.5, 0.01, 0.02, 0.003),
        mesh::bar(0.0, 0.19, 0.01, 0.02, 0.003),
        mesh::bar(0.0, 0.46, 0.01, 0.02, 0.003),
        mesh::cylinder(0.055, 0.02, 0.006),
        mesh::ring(0.15, 0.14, 0.004),
        mesh::bar(-0.3, 0.5, 0.02, 0.02, 0.005),
    ];
    let model = Arc::new(MeshSet { meshes });
    let scene = |theme| {
        let colours = palette(theme);
        let [q1, q2, q3] = [1.5727f32, 4.045, 2.77];
        let e = |q: f32, l: f32| [l * q.cos(), l * q.sin()];
        let add = |a: [f32; 2], b: [f32; 2]| [a[0] + b[0], a[1] + b[1]];
        let at = |[x, y]: [f32; 2], z: f32| [x, y, z];
        let p1 = e(q1, 0.5);
        let elbow = add(p1, e(q2, -0.46));
        let tip = add(elbow, e(q3, -0.3));
        let p2 = e(q2, 0.115);
        let p3 = e(q3, 0.19);
        let p7 = add(p1, p3);
        let p8 = add(p7, e(q2, -0.46));
        let [blue, orange, green, ..] = colours.drives;
        let mut scene = empty(colours.background);
        scene.model = model.clone();
        let ghost =
            |q: f32, at: [f32; 2], z, mesh, colour| solid(mesh, placed(q, [at[0], at[1], z]), faded(colour, 0.22));
        scene.solids = vec![
            solid(6, placed(0.0, [0.0, 0.0, 0.0]), colours.line),
            solid(7, placed(0.0, [0.0, 0.0, 0.0]), colours.line),
            solid(8, placed(q1, at([0.0; 2], 0.06)), blue),
            solid(4, placed(q2, at([0.0; 2], 0.03)), orange),
            solid(4, placed(q3, at([0.0; 2], 0.02)), green),
            solid(3, placed(q1, at(p2, 0.06)), blue),
            solid(1, placed(q2 + PI, at(p1, 0.09)), orange),
            solid(3, placed(q1, at(p3, 0.05)), blue),
            solid(4, placed(q3, at(p1, 0.03)), green),
            solid(5, placed(q2 + PI, at(p7, 0.09)), orange),
            solid(2, placed(q3 + PI, at(elbow, 0.12)), green),
            ghost(1.62, [0.0; 2], 0.01, 0, blue),
            ghost(0.6, e(1.62, 0.5), 0.012, 1, orange),
            ghost(-0.95, add(e(1.62, 0.5), e(0.6, 0.46)), 0.014, 2, green),
        ];
        let area = nine_link(2.4);
        let image = |a: [f32; 2]| {
            let (x, y) = (0..3).fold((0.0, 0.0), |(x, y), k| {
                let angle = area.turn + area.u[k][0] * a[0] + area.u[k][1] * a[1] + area.v[k];
                (x + area.c[k] * angle.cos(), y + area.c[k] * angle.sin())
            });
            [x, y, 0.0]
        };
        let edge = |k: usize, t: f32| [[t, 0.0], [PI, t], [PI - t, PI], [0.0, PI - t]][k];
        let boundary: Vec<_> = (0..4)
            .flat_map(|k| (0..=200).map(move |i| (k, i as f32 / 200.0 * PI)))
            .map(|(k, t)| image(edge(k, t)))
            .collect();
        for k in -12..=12 {
            let x = 0.1 * k as f32;
            scene.lines.push(line(&[[x, -1.2, 0.0], [x, 1.2, 0.0]], 1.0, colours.line));
            scene.lines.push(line(&[[-1.2, x, 0.0], [1.2, x, 0.0]], 1.0, colours.line));
        }
        let turned: Vec<_> = boundary.iter().map(|p| [-0.9 * p[0], -p[1] * 0.6, 0.0]).collect();
        scene.lines.push(Polyline { dash: Some([5.0, 4.0]), ..line(&turned, 1.0, faded(colours.dim, 0.6)) });
        scene.lines.push(line(&boundary, 2.0, colours.amber));
        let path: Vec<_> =
            (0..=60).map(|k| k as f32 / 60.0).map(|t| [0.5 + 0.06 * (3.1 * t).sin(), 0.5 + 0.4 * t, 0.0]).collect();
        scene.lines.push(Polyline { dash: Some([2.0, 4.0]), on_top: true, ..line(&path, 2.0, colours.ink) });
        let arc: Vec<_> =
            (0..=64).map(|k| k as f32 / 64.0 * 1.93).map(|t| [0.15 * t.cos(), 0.15 * t.sin(), 0.0]).collect();
        scene.lines.push(Polyline { on_top: true, ..line(&arc, 5.0, colours.amber) });
        scene.areas = vec![Area { colour: faded(colours.amber, 0.12), ..area }];
        for (p, z) in [(p1, 0.11), (elbow, 0.14), (p2, 0.08), (p3, 0.07), (p7, 0.11), (p8, 0.14), (add(p1, p2), 0.11)] {
            scene.markers.push(disc(at(p, z), 5.0, colours.background, colours.ink, 1.6));
        }
        scene.markers.push(disc(at(tip, 0.14), 13.0, [0.0; 4], colours.ink, 2.0));
        scene.markers.push(disc(at(tip, 0.14), 4.0, colours.ink, colours.ink, 0.0));
        scene.markers.push(disc(arc[64], 9.0, colours.amber, colours.background, 2.0));
        scene
    };
    let above = |scale: f32| View {
        size_px: [900, 900].map(|n: u32| (n as f32 * scale) as u32),
        pixels_per_point: scale,
        ..flat([0.2, 0.35], 0.95, 0)
    };
    let round = perspective([1.5, -1.9, 1.9], [0.2, 0.35, 0.0], [1000, 800], 1.0);
    vec![
        (scene(Theme::Dark), above(1.0)),
        (scene(Theme::Light), above(1.0)),
        (scene(Theme::Dark), round),
        (scene(Theme::Light), round),
    ]
}

/// One sample a pixel: edges are rougher, and all else is the same.
fn a_draft_differs_at_edges_only() {
    let mut gpu = gpu();
    let (device, queue) = (gpu.device().clone(), gpu.queue().clone());
    let mut draft = Renderer::drawing(&device, wgpu::TextureFormat::Rgba8Unorm, Quality::Draft);
    for (scene, view) in demo() {
        let fine = gpu.picture(&scene, &view).unwrap();
        let mut encoder = device.create_command_encoder(&Default::default());
        draft.prepare(&device, &queue, &mut encoder, &scene, &view);
        queue.submit([encoder.finish()]);
        let texture = draft.picture().cloned().unwrap();
        let rough = gpu.readback(&texture).unwrap();
        assert_eq!((rough.width, rough.height), (fine.width, fine.height));
        let gap = |(a, b): ([u8; 4], [u8; 4])| (0..4).map(|k| a[k].abs_diff(b[k])).max().unwrap_or(0);
        let gaps: Vec<u8> = all(&fine).zip(all(&rough)).map(gap).collect();
        let share = |least: u8| gaps.iter().filter(|gap| **gap >= least).count() as f64 / gaps.len() as f64;
        // Edges are a hundredth of the picture; one sample is off by less than half of what lies on either side.
        assert!(share(8) > 0.001 && share(8) < 0.04 && share(64) < 0.012, "{} {}", share(8), share(64));
    }
}

/// Leaves the demonstration pictures where `STILLBASE_PICTURES` names a folder, for eyes to judge.
fn demonstration_pictures_are_not_empty() {
    let mut gpu = gpu();
    for (k, (scene, view)) in demo().iter().enumerate() {
        let picture = gpu.picture(scene, view).unwrap();
        let drawn = all(&picture).filter(|pixel| *pixel != bytes(scene.background)).count();
        assert!(drawn > 50_000, "{drawn}");
        if let Some(folder) = std::env::var_os("STILLBASE_PICTURES") {
            let to = std::path::Path::new(&folder).join(format!("demo-{k}.png"));
            std::fs::write(to, picture.to_png().unwrap()).unwrap();
        }
    }
}
