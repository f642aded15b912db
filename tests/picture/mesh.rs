//! Meshes are closed, oriented outwards and of the right volume.

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use stillbase::mechanics::machine::builtin;
use stillbase::picture::scene::Mesh;
use stillbase::picture::scene::fill;
use stillbase::picture::scene::mesh::{SEGMENTS, bar, cylinder, ring};
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::stage::Stage;
use stillbase::planning::pose_space::PoseSpace;
use stillbase::session::Run;
use stillbase::session::scenario::Scenario;

/// Area of a regular polygon of [`SEGMENTS`] chords over that of its circle, N/(2π) sin(2π/N).
pub fn polygon_factor() -> f64 {
    (TAU / SEGMENTS as f64).sin() * SEGMENTS as f64 / TAU
}

fn vector(p: [f32; 3]) -> nalgebra::Vector3<f64> {
    nalgebra::Vector3::from(p.map(f64::from))
}

/// Volume by the divergence theorem.
fn volume(mesh: &Mesh) -> f64 {
    let corner = |k: u32| vector(mesh.positions[k as usize]);
    mesh.triangles.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c))) / 6.0).sum()
}

/// Every directed edge between places occurs once, and so does its opposite.
fn assert_closed(mesh: &Mesh) {
    let place = |k: u32| mesh.positions[k as usize].map(|x| (x + 0.0).to_bits());
    let mut edges = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            assert_ne!(place(from), place(to), "an edge without length");
            *edges.entry((place(from), place(to))).or_insert(0) += 1;
        }
    }
    for (&(from, to), &count) in &edges {
        assert_eq!((count, edges.get(&(to, from))), (1, Some(&1)), "edge {from:?} {to:?}");
    }
}

/// Normals are of unit length and lean to the side their triangles face.
fn assert_normals(mesh: &Mesh) {
    assert_eq!(mesh.positions.len(), mesh.normals.len());
    for &normal in &mesh.normals {
        assert!((vector(normal).norm() - 1.0).abs() < 1e-6);
    }
    for &triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| vector(mesh.positions[k as usize]));
        let face = (b - a).cross(&(c - a));
        assert!(face.norm() > 0.0, "a triangle without area");
        for k in triangle {
            // Smooth along the outline only: half a chord's angle away at most.
            assert!(vector(mesh.normals[k as usize]).dot(&face.normalize()) > 0.99);
        }
    }
}

/// Volume of a bevelled bar: the area of the outline at offset r is 2 r L + π r², the circle taken as its polygon.
fn bar_volume(length: f64, radius: f64, height: f64, bevel: f64) -> f64 {
    let area_integral = |r: f64| length * r * r + polygon_factor() * PI * r.powi(3) / 3.0;
    let area = 2.0 * radius * length + polygon_factor() * PI * radius * radius;
    area * (height - 2.0 * bevel) + 2.0 * (area_integral(radius) - area_integral(radius - bevel))
}

#[test]
fn bars_are_closed_solids() {
    for (from, to, radius, height, bevel) in [
        (0.0, 0.5, 0.02, 0.015, 0.003),
        (-0.3, 0.46, 0.012, 0.02, 0.0),
        (0.2, -0.2, 0.05, 0.01, 0.002),
        (1.0, 1.0, 0.1, 0.1, 0.01),
    ] {
        let mesh = bar(from, to, radius, height, bevel);
        assert_closed(&mesh);
        assert_normals(&mesh);
        let expected = bar_volume(f64::abs(to - from), radius, height, bevel);
        assert!((volume(&mesh) / expected - 1.0).abs() < 1e-5, "{} {expected}", volume(&mesh));
    }
}

#[test]
fn a_bar_reaches_exactly_its_ends() {
    let mesh = bar(-0.2, 0.5, 0.03, 0.02, 0.004);
    let range = |axis: usize| {
        let of = mesh.positions.iter().map(|p| p[axis]);
        [of.clone().fold(f32::INFINITY, f32::min), of.fold(f32::NEG_INFINITY, f32::max)]
    };
    assert_eq!(range(0), [-0.23, 0.53]);
    assert_eq!(range(1), [-0.03, 0.03]);
    assert_eq!(range(2), [0.0, 0.02]);
}

#[test]
fn cylinders_and_rings_are_closed_solids() {
    let disc = cylinder(0.06, 0.03, 0.005);
    assert_closed(&disc);
    assert_normals(&disc);
    assert!((volume(&disc) / bar_volume(0.0, 0.06, 0.03, 0.005) - 1.0).abs() < 1e-5);

    let hoop = ring(0.08, 0.05, 0.01);
    assert_closed(&hoop);
    assert_normals(&hoop);
    let expected = polygon_factor() * PI * (0.08f64.powi(2) - 0.05f64.powi(2)) * 0.01;
    assert!((volume(&hoop) / expected - 1.0).abs() < 1e-5);
}

#[test]
fn tessellation_takes_less_than_two_permille() {
    assert!(polygon_factor() < 1.0 && polygon_factor() > 0.998);
}

#[test]
fn too_large_a_bevel_leaves_a_solid() {
    let mesh = bar(0.0, 0.1, 0.01, 0.01, 5.0);
    assert_closed(&mesh);
    assert_normals(&mesh);
    let bevel = 0.01 / 3.0;
    assert!((volume(&mesh) / bar_volume(0.1, 0.01, 0.01, bevel) - 1.0).abs() < 1e-5);
}

#[test]
fn no_size_no_solid() {
    for mesh in [
        bar(0.0, 1.0, 0.0, 0.1, 0.0),
        bar(0.0, 1.0, f64::NAN, 0.1, 0.0),
        cylinder(0.1, -1.0, 0.0),
        ring(0.1, 0.1, 0.1),
        ring(0.1, 0.05, f64::INFINITY),
    ] {
        assert_eq!(mesh, Mesh::default());
    }
    assert_closed(&bar(f64::NAN, 1.0, 0.1, 0.1, f64::NAN));
    assert_closed(&ring(0.1, 0.0, 0.1));
}

/// Area of a filled outline, m², whose triangles all face upwards.
fn filled(loops: &[Vec<[f64; 2]>]) -> f64 {
    let mesh = fill::mesh(loops);
    let corner = |i: u32| mesh.positions[i as usize].map(f64::from);
    let of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(corner);
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    };
    let all: Vec<f64> = mesh.triangles.iter().map(of).collect();
    assert!(all.iter().all(|area| *area > -1e-9), "counter-clockwise");
    all.iter().sum()
}

#[test]
fn holes_of_a_fill_are_left_out() {
    let circle = |x: f64, r: f64, way: f64| -> Vec<[f64; 2]> {
        let at = |i: u32| way * std::f64::consts::TAU * (f64::from(i) + 0.3) / 200.0;
        (0..200).map(|i| [x + r * at(i).cos(), r * at(i).sin()]).collect()
    };
    let polygon = |r: f64| 100.0 * r * r * (std::f64::consts::TAU / 200.0).sin();
    let square = vec![vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]];
    assert!((filled(&square) - 1.0).abs() < 1e-6);
    let ring = [circle(0.0, 1.0, 1.0), circle(0.2, 0.5, -1.0)];
    assert!((filled(&ring) - polygon(1.0) + polygon(0.5)).abs() < 1e-5);
    let apart = [circle(0.0, 1.0, 1.0), circle(3.0, 0.5, 1.0)];
    assert!((filled(&apart) - polygon(1.0) - polygon(0.5)).abs() < 1e-5);
    assert_eq!(filled(&[]), 0.0);
}

/// Where four drives reach while b is held is filled by its area, as where three do.
#[test]
fn the_workspace_of_four_drives_is_filled() {
    let machine = builtin("four-drive").expect("built in");
    let space = PoseSpace::of(machine).expect("it is balanced");
    let outline = space.outline(0.0);
    let area = filled(&outline.loops);
    assert!((area - outline.area).abs() < 2e-3 * outline.area, "{area} of {}", outline.area);
    let run = Run::new(&Scenario::builtin("four-drive").expect("built in")).expect("it runs");
    let scene = Stage::of(&run).scene(&run.frame(), &ViewOptions::default());
    let fill = scene.solids.iter().find(|solid| solid.name == "workspace").expect("it is filled");
    assert!(scene.model.meshes[fill.mesh].triangles.len() > 100);
}

/// In draft quality a body has the same place and nearly the same volume: nothing that belongs to it is missing.
#[test]
fn coarse_bodies_are_those_of_the_machine() {
    for machine in stillbase::mechanics::machine::builtins() {
        let scenario = stillbase::session::for_machine(&Scenario::builtin("case-3").expect("built in"), machine);
        let run = Run::new(&scenario).unwrap_or_else(|why| panic!("{}: {why}", machine.name()));
        let scene = Stage::of(&run).scene(&run.frame(), &ViewOptions::default());
        let mut count = 0;
        for mesh in &scene.model.meshes {
            let Some(coarse) = &mesh.coarse else { continue };
            count += 1;
            let (fine, rough) = (volume(mesh), volume(coarse));
            assert!(rough > 0.95 * fine && rough <= fine * (1.0 + 1e-6), "{}: {rough} of {fine}", machine.name());
            assert!(2 * coarse.triangles.len() < mesh.triangles.len());
            for axis in 0..3 {
                let ends = |mesh: &Mesh| {
                    let all = mesh.positions.iter().map(|p| p[axis]);
                    all.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
                };
                let ([a, b], [c, d]) = (ends(mesh), ends(coarse));
                assert!((a - c).abs().max((b - d).abs()) < 1e-6, "{}: axis {axis}", machine.name());
            }
        }
        assert!(count >= machine.links().len(), "{}: {count} bodies", machine.name());
    }
}
