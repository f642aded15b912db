//! Speed of the core: medians, and in the same run a generic recursive Newton–Euler to compare with.
//!
//! `cargo bench` runs them; the table in `src/guide/speed.md` is made from its output.

#[path = "../mechanics/nine_body.rs"]
#[allow(dead_code, unused_imports, reason = "the bench uses one function of the twin")]
mod nine_body;

use divan::{Bencher, black_box};
use stillbase::mechanics::arm_on_base::ArmOnBase;
use stillbase::mechanics::balance::{
    Body, BodyQuantity, Breakdown, Parameter, ParameterBounds, Preset, RebalanceRequest, rebalance,
};
use stillbase::mechanics::counterweights::{
    CounterweightSite, CounterweightSpec, CounterweightStock, Objective, front, place_weights,
};
use stillbase::mechanics::dynamics::{ExternalLoads, base_wrench, inverse_with_wrench};
use stillbase::mechanics::joint_forces::Joints;
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Inertia, Machine, builtin, parse};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::views::{ViewKind, Views};
use stillbase::planning::curves::path::minimum_norm_path;
use stillbase::planning::curves::{Curve, CurvePoint, Path, Samples};
use stillbase::planning::following::{Rule, trace};
use stillbase::planning::off_plane::LeastReaction;
use stillbase::planning::off_plane::least_reaction::ReactionNorm;
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::pose_space::plane_map;
use stillbase::planning::reactionless::{AngleDefinition, AngleLimit, Boundary, PlaneMap};
use stillbase::planning::timing::{DriveLimits, Profile, TimeLaw, fastest};
use stillbase::session::scenario::{Scenario, default_spreads};
use stillbase::session::{Edit, Run, Session, replay};
use stillbase::study::tolerance::{CHUNK, Ensemble};

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
    let around = ExternalLoads { gravity: Vector::new(0.0, -9.81), force: Vector::default() };
    let (q, qd, qdd) = (DriveAngles::from(Q), PerDrive::from(QD), PerDrive::from(QDD));
    bencher.bench_local(|| {
        let e = black_box(&q).units();
        inverse_with_wrench(&inertia, &e, black_box(&qd), black_box(&qdd), &around)
    });
}

/// A motion of 20,000 samples of three drives: its spline, solved.
#[divan::bench]
fn spline_through_samples(bencher: Bencher) {
    let samples = swinging();
    bencher.bench_local(|| black_box(&samples).path(0.0).expect("a path"));
}

/// The same samples smoothed at 20 Hz.
#[divan::bench]
fn smoothing_of_samples(bencher: Bencher) {
    let samples = swinging();
    bencher.bench_local(|| black_box(&samples).smoothed(20.0).expect("below half of the rate"));
}

/// The reference at an instant of them.
#[divan::bench]
fn reference_of_samples(bencher: Bencher) {
    let samples = swinging();
    let path = Path::Table(samples.path(0.0).expect("a path"));
    let motion = stillbase::planning::Motion { path, profile: Profile::running(samples.duration()) };
    let mut t = 0.0;
    bencher.bench_local(|| {
        t = (t + 0.731) % 20.0;
        motion.at(black_box(t))
    });
}

fn swinging() -> Samples {
    let row = |i: i32| {
        let t = 0.001 * f64::from(i);
        vec![t, 1.7 + 0.2 * (3.0 * t).sin(), 3.7 + 0.2 * (2.0 * t).cos(), 2.2 + 0.2 * (2.0 * t + 1.0).sin()]
    };
    Samples::new(&(0..20_000).map(row).collect::<Vec<_>>()).expect("sound")
}

/// The nine-link machine as nine rigid bodies, in gravity.
fn twin() -> nine_body::NineBody {
    let machine = builtin("nine-link").expect("built in");
    let each = |f: fn(&stillbase::mechanics::machine::Link) -> f64| std::array::from_fn(|j| f(&machine.links()[j]));
    nine_body::NineBody {
        length: std::array::from_fn(|j| machine.resolved_links()[j].length),
        mass: each(|l| l.mass),
        inertia: each(|l| l.inertia),
        com: each(|l| l.com),
        gravity: [0.0, -9.81],
        payload: 0.0,
    }
}

/// The same by a generic recursion over nine bodies.
#[divan::bench]
fn dynamics_by_recursive_newton_euler(bencher: Bencher) {
    let twin = twin();
    bencher.bench_local(|| twin.recursive(black_box(Q), black_box(QD), black_box(QDD)));
}

/// Force of every pin of the nine-link machine, and its torques.
#[divan::bench]
fn pin_forces(bencher: Bencher) {
    let joints = Joints::of(builtin("nine-link").expect("built in")).expect("determinate");
    let around = ExternalLoads { gravity: Vector::new(0.0, -9.81), force: Vector::default() };
    let (q, qd, qdd) = (DriveAngles::from(Q), PerDrive::from(QD), PerDrive::from(QDD));
    bencher.bench_local(|| {
        let e = black_box(&q).units();
        joints.forces(&e, black_box(&qd), black_box(&qdd), &around)
    });
}

/// The same by 27 equations in 27 numbers.
#[divan::bench]
fn pin_forces_by_27_equations(bencher: Bencher) {
    let twin = twin();
    bencher.bench_local(|| twin.solve(black_box(Q), black_box(QD), black_box(QDD)));
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
    let scenario = Scenario { duration: Some(60.0), ..Scenario::builtin("case-3").expect("built in") };
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

/// The boundary of the workspace of four drives.
#[divan::bench]
fn four_drives_boundary(bencher: Bencher) {
    let space = four_drives();
    bencher.bench_local(|| space.outline(black_box(2.4)).area);
}

/// Which b of four drives reach a point.
#[divan::bench]
fn four_drives_range_of_b(bencher: Bencher) {
    let space = four_drives();
    bencher.bench_local(|| space.reach(black_box(Vector::new(0.050, -0.539))));
}

/// A step of four drives that are led to a target out of reach while b is slid.
#[divan::bench]
fn four_drives_led_beside_a_target(bencher: Bencher) {
    let mut run = Run::new(&Scenario::builtin("four-drive").expect("built in")).expect("it starts");
    run.apply(&Edit::DragTarget { x: -0.9, y: -0.9 }).expect("it is led");
    run.apply(&Edit::SlideB { b: 900.0 }).expect("it is slid");
    bencher.bench_local(|| run.advance());
}

fn four_drives() -> PoseSpace {
    PoseSpace::of(builtin("four-drive").expect("built in")).expect("it is balanced")
}

/// The three cases in one recording, without pictures, file closed.
#[cfg(feature = "record")]
#[divan::bench]
fn record_three_cases(bencher: Bencher) {
    let scenarios: Vec<_> = Scenario::cases().filter_map(Scenario::builtin).collect();
    let file = std::env::temp_dir().join(format!("stillbase-bench-{}.rrd", std::process::id()));
    let options = stillbase::recording::Options { force: true, ..Default::default() };
    bencher
        .bench_local(|| stillbase::recording::record(&scenarios, &file, &options, &mut |_| true).expect("it records"));
    std::fs::remove_file(&file).expect("the recording is there");
}

/// The nine-link machine within other limits.
fn folded(limits: [[f64; 2]; 2]) -> PlaneMap {
    let map = plane_map(builtin("nine-link").expect("built in")).expect("three drives");
    map.with_limits(limits.map(|[min, max]| AngleLimit { min, max })).expect("limits")
}

/// The boundary where the map folds: up to six poses a point.
#[divan::bench(args = [0.0, -std::f64::consts::PI])]
fn folded_boundary_of_a_turn(bencher: Bencher, from: f64) {
    let map = folded([[from, from + std::f64::consts::TAU]; 2]);
    bencher.bench_local(|| Boundary::of(black_box(&map)));
}

/// The boundary within limits as a person may set them, from a sequence that fills their range.
#[divan::bench]
fn folded_boundary_of_any_limits(bencher: Bencher) {
    let share = |i: usize, g: f64| (i as f64 * g).fract();
    let limit = |i: usize, g: f64, h: f64| {
        let least = 8.0 * share(i, g) - 4.0;
        [least, least + 0.3 + 5.9 * share(i, h)]
    };
    let maps: Vec<PlaneMap> = (1..200).map(|i| folded([limit(i, 0.8191, 0.6710), limit(i, 0.5497, 0.4503)])).collect();
    let mut next = 0;
    bencher.bench_local(|| {
        next = (next + 1) % maps.len();
        Boundary::of(black_box(&maps[next]))
    });
}

/// The boundary of a machine with three equal arms: its folds cross each other.
#[divan::bench]
fn folded_boundary_of_equal_arms(bencher: Bencher) {
    let angles = [(1, 0, 0.0), (2, 1, std::f64::consts::PI)];
    let angles = angles.map(|(to, from, offset)| AngleDefinition { to, from, offset });
    let turn = AngleLimit { min: 0.0, max: std::f64::consts::TAU };
    let map = PlaneMap::new([0.5, -0.5, -0.5], [1.0, 0.117, 0.128], angles, [turn; 2]).expect("a map");
    bencher.bench_local(|| Boundary::of(black_box(&map)));
}

/// How many poses reach a point, by winding number.
#[divan::bench]
fn folded_pose_count(bencher: Bencher) {
    let boundary = Boundary::of(&folded([[0.0, std::f64::consts::TAU]; 2]));
    bencher.bench_local(|| boundary.pose_count(black_box(Vector::new(0.2, 0.4)), black_box(2.4)));
}

/// The distance of a point from the boundary, along the true curves.
#[divan::bench]
fn folded_distance(bencher: Bencher) {
    let boundary = Boundary::of(&folded([[0.0, std::f64::consts::TAU]; 2]));
    bencher.bench_local(|| boundary.distance(black_box(Vector::new(0.2, 0.4)), black_box(2.4)));
}

/// The line of the end effector in case 1.
fn tip_path() -> Path {
    let start = DriveAngles::from([1.6875182179, 3.7146223682, 2.1801769897]);
    let tip = builtin("nine-link").expect("built in").end_effector();
    let from = end_effector(tip, &start.units());
    let way = Vector::new(0.55, 0.90) - from;
    let line = |s| CurvePoint { p: from + s * way, first: way, second: Vector::default() };
    Path::Table(minimum_norm_path(tip, start, line).expect("regular"))
}

/// A machine on a fixed base, without gravity.
fn fixed(machine: &Machine) -> ArmOnBase {
    ArmOnBase::fixed(Inertia::of(machine), &ExternalLoads::default())
}

/// The fastest motion along a curve under limits on torque, on a grid of 1000 spaces.
#[divan::bench]
fn fastest_of_1000_points(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in");
    let (arm, limits, path) = (fixed(machine), DriveLimits::of(machine), tip_path());
    bencher.bench_local(|| fastest(black_box(&path), &arm, &limits, false));
}

/// The same with limits on jerk, searched for and checked.
#[divan::bench]
fn fastest_smooth_of_1000_points(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in");
    let limits = DriveLimits { jerk: PerDrive::from([2000.0; 3]), ..DriveLimits::of(machine) };
    let (arm, path) = (fixed(machine), tip_path());
    bencher.bench_local(|| fastest(black_box(&path), &arm, &limits, true));
}

/// Looking up such a motion at an instant.
#[divan::bench]
fn profile_at(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in");
    let (arm, limits) = (fixed(machine), DriveLimits::of(machine));
    let found = fastest(&tip_path(), &arm, &limits, false).expect("limits");
    let (profile, mut t) = (found.profile, 0.0);
    bencher.bench_local(|| {
        t = (t + 0.377 * profile.duration()) % profile.duration();
        black_box(&profile).at(black_box(t))
    });
}

/// A path of least reaction where no b serves the whole of it, corridor, program and nodes.
#[divan::bench]
fn least_reaction_path(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in");
    let (map, model) = (plane_map(machine).expect("three drives"), Inertia::of(machine));
    let [from, to] = [Vector::new(0.50, 0.50), Vector::new(0.55, 0.90)];
    let curve = |u: f64| {
        let (law, way) = (TimeLaw::Quintic.at(u, 1.0), to - from);
        CurvePoint { p: from + law.s * way, first: law.rate * way, second: law.acceleration * way }
    };
    let start = map.poses(from, 1.75)[0];
    bencher.bench_local(|| {
        LeastReaction::plan(&map, &model, curve, black_box(start), None, ReactionNorm::Rms).expect("it can")
    });
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

/// Whether a curve can be followed on a plane, at 1000 points one after another.
#[divan::bench]
fn feasibility_of_a_path_of_1000_points(bencher: Bencher) {
    let map = plane_map(builtin("nine-link").expect("built in")).expect("three drives");
    let points = [Vector::new(0.50, 0.50), Vector::new(0.60, 0.70), Vector::new(0.5, 0.8), Vector::new(0.55, 0.90)];
    let curve = Curve::spline(&points, false).expect("apart");
    let start = map.poses(points[0], 2.4)[0].a;
    bencher.bench_local(|| trace::walk(&map, black_box(&curve), 2.4, start, Rule::default(), 1000).expect("inside"));
}

/// A million machines, or so: 200 instants of case 3, every number that varies by default.
const MACHINES: u64 = 1_000_000 / CHUNK as u64 * CHUNK as u64;

fn ensemble() -> Ensemble {
    let run = Run::new(&Scenario::builtin("case-3").expect("built in")).expect("it starts");
    let machine = builtin("nine-link").expect("built in");
    Ensemble::new(machine, &run.plan().motion, 200, &default_spreads(machine), 1).expect("it varies")
}

/// Peaks and root mean squares of a million varied machines on two threads.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn tolerance_of_a_million_machines(bencher: Bencher) {
    let ensemble = ensemble();
    let chunks = MACHINES / CHUNK as u64;
    bencher.bench_local(|| {
        let worst = |from: u64, to: u64| {
            let mut sampler = ensemble.sampler();
            (from..to).fold(0.0_f64, |m, c| sampler.outcomes(c).iter().fold(m, |m, o| m.max(o.peak_moment)))
        };
        std::thread::scope(|scope| {
            let other = scope.spawn(|| worst(0, chunks / 2));
            worst(chunks / 2, chunks).max(other.join().expect("no panic"))
        })
    });
}

/// The same the straightforward way, for a thousandth of the machines and on one thread: each machine built and
/// checked, its constants summed, the dynamics at every instant. What is drawn is the same.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn tolerance_of_1024_machines_one_by_one(bencher: Bencher) {
    let ensemble = ensemble();
    let mut sampler = ensemble.sampler();
    let count = ensemble.parameters().len();
    bencher.bench_local(|| {
        let mut worst = 0.0_f64;
        for chunk in 0..1024 / CHUNK as u64 {
            sampler.draw(chunk);
            for machine in 0..CHUNK {
                let deviations: Vec<f64> = (0..count).map(|p| sampler.deviations()[p][machine]).collect();
                let machine = ensemble.machine_of(&deviations).expect("possible");
                let inertia = Inertia::of(&machine);
                let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
                let (mut squares, mut peak) = (0.0, [0.0_f64; 2]);
                for r in ensemble.references() {
                    let wrench = base_wrench(&inertia, &r.q.units(), &r.qd, &r.qdd, &around);
                    let (n, f) = (wrench.total().moment, wrench.dynamic.force.norm());
                    squares += n * n + f * f;
                    peak = [peak[0].max(n.abs()), peak[1].max(f)];
                }
                worst = worst.max(black_box(peak)[0] + black_box(squares) * 0.0);
            }
        }
        worst
    });
}

/// Torques of a million steps, as the window has them.
#[cfg(feature = "ui")]
fn million() -> stillbase::study::samples::SignalSamples {
    let count = 1_000_000;
    let times = (0..count).map(|i| 1e-3 * f64::from(i)).collect();
    let wave =
        |k: i32| (0..count).map(move |i| f64::from(k) + (1e-4 * f64::from(i * k)).sin() + 0.1 * f64::from(i % 7));
    stillbase::study::samples::SignalSamples::of(times, (1..=3).map(|k| (format!("torque/{k}"), wave(k).collect())))
}

/// What a frame takes to draw a plot of three signals of a million samples each, 1000 pixels wide, while its range moves:
/// lines, bounds, statistics and all that is painted.
#[cfg(feature = "ui")]
#[divan::bench]
fn plot_of_three_million_samples(bencher: Bencher) {
    use stillbase::picture::charts::choice::PlotChoice;
    use stillbase::picture::charts::drawn::PlotLines;
    use stillbase::picture::charts::figure::{Figure, PlotContext};
    use stillbase::picture::notation::Notation;
    use stillbase::picture::scene::palette::{Theme, palette};
    let (samples, p) = (million(), palette(Theme::Dark));
    let session = Session::open(Scenario::builtin("case-3").expect("built in")).expect("it can start");
    let table = stillbase::simulation::signals::signals(&session.scenario().machine);
    let plots = PlotChoice::default().plots(session.scenario(), &table, false, Notation::default());
    let (now, mut from) = (session.frame(), 0.0);
    let look = PlotContext { palette: &p, peaks: &now.peaks, now, mark: None, hover: None };
    bencher.bench_local(|| {
        from = (from + 0.37) % 100.0;
        let drawn = PlotLines::of(&plots[0], black_box(&samples), &[], [from, from + 900.0], 1000, true);
        Figure::of(&plots[0], &drawn, [1060.0, 300.0], &look, &[])
    });
}

/// Making a million samples ready to be drawn, once.
#[divan::bench(sample_count = 10, sample_size = 1)]
fn pyramid_of_a_million_samples(bencher: Bencher) {
    let values: Vec<f64> = (0..1_000_000).map(|i| (1e-4 * f64::from(i)).sin()).collect();
    bencher.bench_local(|| black_box(&values).iter().copied().collect::<stillbase::study::series::Series>());
}

/// The nine-link machine as bare bars, with discs of steel allowed on each link.
fn bare() -> (Machine, CounterweightSpec) {
    let machine = parse(include_str!("../reference/family/nine-link-bare.toml"), "bare").expect("a machine");
    let parts = machine.resolved_links().iter().enumerate();
    let sites = parts.map(|(link, part)| CounterweightSite::on_axis(link, -0.3, part.length)).collect();
    let disc = CounterweightStock::discs(7850.0, 0.03);
    (machine, CounterweightSpec::least(Objective::inertia(), sites, disc))
}

/// Who brings what to (7) and (8).
#[divan::bench]
fn breakdown_of_nine_links(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in");
    bencher.bench_local(|| Breakdown::of(black_box(machine)));
}

/// A link has been dragged, and one that would follow may not: the least change of all others.
#[divan::bench]
fn nine_links_kept_balanced(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in").set("link.5.com", "-0.05").expect("in range");
    let mut asked = RebalanceRequest::coms(&machine, &Preset::Table1.penalty(9).expect("nine links"));
    asked.set_bounds(&machine, Parameter::com(4), ParameterBounds::Fixed);
    let at = machine.links()[1].com;
    asked.set_bounds(&machine, Parameter::com(1), ParameterBounds::Within([at - 1e-4, at + 1e-4]));
    bencher.bench_local(|| rebalance(black_box(&machine), &asked).expect("it can be balanced"));
}

/// The same with all masses free, too.
#[divan::bench]
fn nine_links_and_masses_kept_balanced(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in").set("link.5.com", "-0.05").expect("in range");
    let mut asked = RebalanceRequest::coms(&machine, &Preset::Table1.penalty(9).expect("nine links"));
    for (j, link) in machine.links().iter().enumerate() {
        let mass = Parameter::new(Body::Link(j), BodyQuantity::Mass);
        asked.set_bounds(&machine, mass, ParameterBounds::Within([0.9 * link.mass, 1.1 * link.mass]));
        asked.set_bounds(&machine, Parameter::com(j), ParameterBounds::Within([link.com - 0.01, link.com + 0.01]));
    }
    asked.set_bounds(&machine, Parameter::com(4), ParameterBounds::Fixed);
    bencher.bench_local(|| rebalance(black_box(&machine), &asked).expect("it can be balanced"));
}

/// Bounds that leave no way, named with what would do.
#[divan::bench]
fn conflict_of_nine_links(bencher: Bencher) {
    let machine = builtin("nine-link").expect("built in").set("payload.mass", "0.3").expect("in range");
    let mut asked = RebalanceRequest::coms(&machine, &[1.0; 9]);
    for (j, link) in machine.links().iter().enumerate() {
        asked.set_bounds(&machine, Parameter::com(j), ParameterBounds::Within([link.com - 0.01, link.com + 0.01]));
    }
    bencher.bench_local(|| rebalance(black_box(&machine), &asked).expect_err("they are tight"));
}

/// The counterweights of least inertia.
#[divan::bench(sample_count = 20, sample_size = 1)]
fn counterweights_of_least_inertia(bencher: Bencher) {
    let (machine, asked) = bare();
    bencher.bench_local(|| place_weights(black_box(&machine), &asked).expect("it can be balanced"));
}

/// From the least mass to the least inertia in 25 steps.
#[divan::bench(sample_count = 20, sample_size = 1)]
fn front_of_25_counterweights(bencher: Bencher) {
    let (machine, asked) = bare();
    bencher.bench_local(|| front(black_box(&machine), &asked, 25).expect("it can be balanced"));
}
