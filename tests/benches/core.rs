//! Speed of the core: medians, and in the same run a generic recursive Newton–Euler to compare with.
//!
//! `cargo bench` runs them; the table in README.md is made from its output.

#[path = "../suite/nine_body.rs"]
#[allow(dead_code, unused_imports, reason = "the bench uses one function of the twin")]
mod nine_body;

use divan::{Bencher, black_box};
use stillbase::dynamics::{Surroundings, inverse_with_wrench};
use stillbase::machine::{Inertia, builtin};
use stillbase::planar::{DriveAngles, PerDrive, Vector};
use stillbase::pose_constant::plane_map;
use stillbase::reactionless::Boundary;
use stillbase::scenario::Scenario;
use stillbase::scene::stage::ViewOptions;
use stillbase::scene::views::{ViewKind, Views};
use stillbase::session::{Run, Session, replay};

fn main() {
    divan::main();
}

const Q: [f64; 3] = [1.6, 3.9, 2.5];
const QD: [f64; 3] = [-0.3, 0.9, 1.7];
const QDD: [f64; 3] = [-1.0, 2.0, 4.0];

/// Torques and base wrench of the nine-link machine from g, C, J.
#[divan::bench]
fn dynamics_with_base_wrench(bencher: Bencher) {
    let inertia = Inertia::of(builtin("nine-link").expect("built in"));
    let around = Surroundings { gravity: Vector::new(0.0, -9.81), force: Vector::default() };
    let (q, qd, qdd) = (DriveAngles::from(Q), PerDrive::from(QD), PerDrive::from(QDD));
    bencher.bench_local(|| {
        let e = black_box(&q).units();
        inverse_with_wrench(&inertia, &e, black_box(&qd), black_box(&qdd), &around)
    });
}

/// The same by a generic recursion over nine bodies.
#[divan::bench]
fn dynamics_by_recursive_newton_euler(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in");
    let each = |f: fn(&stillbase::machine::Link) -> f64| std::array::from_fn(|j| f(&machine.links()[j]));
    let twin = nine_body::NineBody {
        length: std::array::from_fn(|j| machine.parts()[j].length),
        mass: each(|l| l.mass),
        inertia: each(|l| l.inertia),
        com: each(|l| l.com),
        gravity: [0.0, -9.81],
        payload: 0.0,
    };
    bencher.bench_local(|| twin.recursive(black_box(Q), black_box(QD), black_box(QDD)));
}

/// One step of case 3: order 4, control in every stage, peaks included.
#[divan::bench]
fn simulation_step(bencher: Bencher) {
    let run = Run::new(&Scenario::builtin("case-3").expect("built in")).expect("it starts");
    let mut moving = run.clone();
    bencher.bench_local(|| {
        if moving.simulation().step_count() >= 1000 {
            moving = run.clone();
        }
        moving.advance();
    });
}

/// A frame of case 3.
#[divan::bench]
fn frame(bencher: Bencher) {
    let mut run = Run::new(&Scenario::builtin("case-3").expect("built in")).expect("it starts");
    (0..400).for_each(|_| run.advance());
    bencher.bench_local(|| black_box(&run).frame());
}

/// A minute at 1 kHz, every frame looked at.
#[divan::bench]
fn a_minute_at_1_khz() -> f64 {
    let scenario = Scenario { duration: 60.0, ..Scenario::builtin("case-3").expect("built in") };
    let mut sum = 0.0;
    replay(&scenario, |_, frame| sum += frame.base_moment()).expect("it runs");
    sum
}

/// The pose at a point of a plane, from a pose 0.1 rad away.
#[divan::bench]
fn plane_inverse(bencher: Bencher) {
    let map = plane_map(builtin("nine-link").expect("built in")).expect("three drives");
    let (p, from) = (Vector::new(0.5, 0.5), [1.95, 1.55]);
    bencher.bench_local(|| map.follow(black_box(p), black_box(2.4), black_box(from)));
}

/// All poses at a point of a plane.
#[divan::bench]
fn all_poses(bencher: Bencher) {
    let map = plane_map(builtin("nine-link").expect("built in")).expect("three drives");
    bencher.bench_local(|| map.poses(black_box(Vector::new(0.5, 0.5)), black_box(2.4)));
}

/// The b that reach a point.
#[divan::bench]
fn range_of_b(bencher: Bencher) {
    let map = plane_map(builtin("nine-link").expect("built in")).expect("three drives");
    bencher.bench_local(|| map.reach(black_box(Vector::new(0.5, 0.5))));
}

/// The boundary of the workspace within [0, π]².
#[divan::bench]
fn workspace_boundary(bencher: Bencher) {
    let map = plane_map(builtin("nine-link").expect("built in")).expect("three drives");
    bencher.bench_local(|| Boundary::of(black_box(&map)));
}

/// The three cases in one recording, without pictures, file closed.
#[cfg(feature = "record")]
#[divan::bench]
fn record_three_cases(bencher: Bencher) {
    let scenarios: Vec<_> = Scenario::builtin_names().into_iter().filter_map(Scenario::builtin).collect();
    let file = std::env::temp_dir().join(format!("stillbase-bench-{}.rrd", std::process::id()));
    let options = stillbase::headless::Options { pictures: None, force: true };
    bencher.bench_local(|| stillbase::headless::record(&scenarios, &file, &options, &mut |_| {}).expect("it records"));
    std::fs::remove_file(&file).expect("the recording is there");
}

/// Everything that the linked views keep from frame to frame.
#[divan::bench]
fn views_of_a_run(bencher: Bencher) {
    let session = Session::open(Scenario::builtin("case-3").expect("built in")).expect("it can start");
    bencher.bench_local(|| Views::of(black_box(session.run())));
}

/// One scene of each view.
#[divan::bench(args = ViewKind::ALL.map(ViewKind::name))]
fn scene_of_a_view(bencher: Bencher, name: &str) {
    let kind = ViewKind::ALL.into_iter().find(|k| k.name() == name).expect("a view");
    let session = Session::open(Scenario::builtin("case-3").expect("built in")).expect("it can start");
    let views = Views::of(session.run());
    let (camera, options) = (views.camera(kind), ViewOptions::default());
    bencher.bench_local(|| views.scene(kind, black_box(session.frame()), &options, &camera));
}
