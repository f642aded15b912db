//! A motion given by samples: the spline and its orders, smoothing, the nearest reactionless motion, and a round trip.

use proptest::prelude::*;
use stillbase::mechanics::arm_on_base::ArmOnBase;
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{PerDrive, Vector, unit};
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::views::Views;
use stillbase::planning::curves::given::SamplesError;
use stillbase::planning::curves::low_pass::LowPass;
use stillbase::planning::curves::spline::{Knots, NOISE_GAIN};
use stillbase::planning::curves::{Path, Samples};
use stillbase::planning::following::Rule;
use stillbase::planning::following::nearest::{Deviation, nearest_b, same_tip, turned_to_plane};
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::timing::Profile;
use stillbase::planning::{Motion, Reference};
use stillbase::session::scenario::{Scenario, Task, TaskKind};
use stillbase::session::{Edit, Refusal, Run, Session, replay};
use stillbase::simulation::frame::Frame;

/// Uneven times from 0 to 1 that a smooth map makes of even ones.
fn uneven(n: usize) -> Vec<f64> {
    let map = |u: f64| u + 0.08 * (std::f64::consts::TAU * u).sin() / std::f64::consts::TAU * 4.0;
    (0..=n).map(|i| map(i as f64 / n as f64)).collect()
}

/// A reproducible tremble of variance 1.
fn noise(n: usize) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..n).map(|_| (0..12).map(|_| next()).sum::<f64>() - 6.0).collect()
}

fn rows(t: &[f64], of: impl Fn(f64) -> Vec<f64>) -> Vec<Vec<f64>> {
    t.iter().map(|t| [&[*t][..], &of(*t)].concat()).collect()
}

fn samples(t: &[f64], of: impl Fn(f64) -> Vec<f64>) -> Samples {
    Samples::new(&rows(t, of)).expect("sound")
}

fn motion(samples: &Samples) -> Motion {
    let path = samples.path(0.0).expect("a path");
    Motion { path: Path::Table(path), profile: Profile::running(samples.duration()) }
}

proptest! {
    /// A quintic of time is met at every instant, however uneven the samples.
    #[test]
    fn quintics_are_exact(
        c in prop::array::uniform6(-1.0..1.0_f64),
        steps in prop::collection::vec(0.3..1.7_f64, 6..40),
    ) {
        let mut t = vec![0.0];
        steps.iter().for_each(|step| t.push(t[t.len() - 1] + step));
        let whole = t[t.len() - 1];
        t.iter_mut().for_each(|t| *t /= whole);
        let at = |t: f64| c.iter().rev().fold([0.0; 3], |[p, d, h], c| [p * t + c, d * t + p, h * t + d]);
        let given = motion(&samples(&t, |t| vec![at(t)[0]]));
        for i in 0..=200 {
            let t = f64::from(i) / 200.0;
            let (r, [q, qd, half]) = (given.at(t), at(t));
            prop_assert!((r.q[0] - q).abs() < 1e-12, "q {} {q}", r.q[0]);
            prop_assert!((r.qd[0] - qd).abs() < 1e-9, "q̇ {} {qd}", r.qd[0]);
            prop_assert!((r.qdd[0] - 2.0 * half).abs() < 1e-6, "q̈ {} {}", r.qdd[0], 2.0 * half);
        }
    }

    /// Angles whose samples lie on a plane lie on it between them, at rest or not.
    #[test]
    fn a_plane_is_kept(l2 in 0.05..1.5_f64, l3 in 0.05..1.5_f64, w in 1.0..6.0_f64) {
        let of = |t: f64| {
            let (q2, q3) = ((w * t).sin(), (2.0 * t).cos());
            vec![2.0 - l2 * q2 - l3 * q3, q2, q3]
        };
        let given = motion(&samples(&uneven(60), of));
        for i in 0..=500 {
            let r = given.at(f64::from(i) / 500.0);
            prop_assert!((r.q.0.dot(&[1.0, l2, l3]) - 2.0).abs() < 1e-13);
            prop_assert!(r.qd.dot(&[1.0, l2, l3]).abs() < 1e-11);
            prop_assert!(r.qdd.dot(&[1.0, l2, l3]).abs() < 1e-8);
        }
    }

    /// Parabolas pass the smoothing unchanged, at uneven times too.
    #[test]
    fn parabolas_pass(c in prop::array::uniform3(-2.0..2.0_f64), cut_off in 0.5..20.0_f64) {
        let t = uneven(80);
        let y: Vec<f64> = t.iter().map(|t| c[0] + t * (c[1] + t * c[2])).collect();
        let smooth = LowPass::new(&t, cut_off).expect("below half of the rate").smooth(&y);
        for (y, f) in y.iter().zip(&smooth) {
            prop_assert!((y - f).abs() < 1e-9, "{y} {f}");
        }
    }
}

#[test]
fn errors_fall_with_the_sixth_fifth_and_fourth_power() {
    let exact = |t: f64| [(7.0 * t + 0.3).sin(), 7.0 * (7.0 * t + 0.3).cos(), -49.0 * (7.0 * t + 0.3).sin()];
    let worst = |n: usize| {
        let given = motion(&samples(&uneven(n), |t| vec![exact(t)[0]]));
        let mut worst = [0.0_f64; 3];
        for i in 0..=3000 {
            let t = f64::from(i) / 3000.0;
            let (r, want) = (given.at(t), exact(t));
            let got = [r.q[0], r.qd[0], r.qdd[0]];
            (0..3).for_each(|k| worst[k] = worst[k].max((got[k] - want[k]).abs()));
        }
        worst
    };
    let errors: Vec<[f64; 3]> = [20, 40, 80].map(worst).to_vec();
    for pair in errors.windows(2) {
        for (k, order) in [6.0, 5.0, 4.0].into_iter().enumerate() {
            let rate = (pair[0][k] / pair[1][k]).log2();
            assert!((rate - order).abs() < 0.7, "derivative {k}: order {rate:.2} of {errors:?}");
        }
    }
}

#[test]
fn noise_comes_out_as_stated() {
    let (n, h, sigma) = (4001, 0.001, 1e-6);
    let t: Vec<f64> = (0..n).map(|i| i as f64 * h).collect();
    let tremble = noise(n);
    let rates = Knots::new(&t).expect("rising").rates(|i| sigma * tremble[i]);
    let inside = &rates[20..n - 20];
    let rms = (inside.iter().map(|r| r[1] * r[1]).sum::<f64>() / inside.len() as f64).sqrt();
    let want = NOISE_GAIN * sigma / (h * h);
    assert!((rms / want - 1.0).abs() < 0.1, "{rms} for {want}");
    let given = samples(&t, |t| vec![t.sin() + sigma * tremble[(t / h).round() as usize]]);
    assert!((given.uncertainty(0) / want - 1.0).abs() < 0.2, "{} for {want}", given.uncertainty(0));
    // What is smooth is not called noise: here rounding is all there is.
    let smooth = samples(&t, |t| vec![t.sin()]);
    assert!(smooth.uncertainty(0) < 1e-3 * want, "{}", smooth.uncertainty(0));
}

#[test]
fn half_of_the_amplitude_is_left_at_the_cut_off_and_no_phase() {
    let (n, h) = (4001, 0.001);
    let t: Vec<f64> = (0..n).map(|i| f64::from(i) * h).collect();
    for cut_off in [5.0, 60.0, 400.0] {
        let pass = LowPass::new(&t, cut_off).expect("below half of the rate");
        for ratio in [0.25, 0.5, 1.0, 1.2] {
            let f = ratio * cut_off;
            let s = |f: f64| (std::f64::consts::PI * f * h).sin();
            let want = 1.0 / (1.0 + (s(f) / s(cut_off)).powi(6));
            let wave = |t: f64| (std::f64::consts::TAU * f * t).sin();
            let smooth = pass.smooth(&t.iter().map(|t| wave(*t)).collect::<Vec<_>>());
            for i in 1500..2500 {
                let got = smooth[i] - want * wave(t[i]);
                assert!(got.abs() < 2e-5, "{f} Hz of {cut_off}: {got:e} at {i}");
            }
        }
    }
    assert!(
        LowPass::new(&t, 500.0).is_none() && LowPass::new(&t, 0.0).is_none() && LowPass::new(&t, f64::NAN).is_none()
    );
}

#[test]
fn rows_that_are_no_samples_are_refused() {
    let t: Vec<f64> = (0..10).map(f64::from).collect();
    let good = rows(&t, |t| vec![t, t]);
    let with = |change: &dyn Fn(&mut Vec<Vec<f64>>)| {
        let mut rows = good.clone();
        change(&mut rows);
        Samples::new(&rows).expect_err("refused")
    };
    assert_eq!(with(&|r| r.truncate(5)), SamplesError::TooFew { got: 5 });
    assert_eq!(with(&|r| r[3][2] = f64::NAN), SamplesError::NotFinite { row: 3, column: 2 });
    assert_eq!(with(&|r| r[4][0] = 3.0), SamplesError::NotRising { row: 4, time: 3.0, before: 3.0 });
    assert_eq!(with(&|r| r[7].push(1.0)), SamplesError::Ragged { row: 7, got: 4, want: 3 });
    assert_eq!(with(&|r| r.iter_mut().for_each(|r| r.truncate(1))), SamplesError::Ragged { row: 0, got: 1, want: 2 });
    let many: Vec<Vec<f64>> = (0..20_001).map(|i| vec![f64::from(i), 0.0]).collect();
    assert_eq!(Samples::new(&many), Err(SamplesError::TooMany { got: 20_001 }));
    assert!(matches!(samples(&t, |t| vec![t]).smoothed(0.5), Err(SamplesError::CutOff { nyquist: 0.5, .. })));
}

fn machine() -> &'static Machine {
    builtin("nine-link").expect("built in")
}

/// Drives that swing, in motion at both ends, within the joint limits.
fn swing(t: f64) -> Vec<f64> {
    vec![1.7 + 0.2 * (3.0 * t).sin(), 3.7 + 0.2 * (2.0 * t).cos(), 2.2 + 0.2 * (2.0 * t + 1.0).sin()]
}

fn swinging(n: usize) -> Samples {
    samples(&(0..=n).map(|i| 5.0 + 1.5 * i as f64 / n as f64).collect::<Vec<_>>(), |t| swing(t - 5.0))
}

/// An ellipse of the end effector from rest to rest.
fn ellipse(t: f64) -> Vec<f64> {
    let u = t / 2.0;
    let turn = unit(std::f64::consts::TAU * u * u * u * (10.0 + u * (-15.0 + 6.0 * u)));
    vec![0.52 + 0.08 * turn.re, 0.7 + 0.1 * turn.im]
}

fn elliptic(n: usize) -> Samples {
    samples(&(0..=n).map(|i| 2.0 * i as f64 / n as f64).collect::<Vec<_>>(), ellipse)
}

fn scenario(kind: TaskKind, samples: &Samples, b: Option<f64>) -> Scenario {
    let task = Task::sampled(kind, samples.clone(), b, machine()).expect("whole");
    Scenario { name: "given".into(), task, compare_b: None, ..Scenario::builtin("case-3").expect("built in") }
}

fn tip(r: &Reference) -> Vector {
    end_effector(machine().end_effector(), &r.q.units())
}

/// As a person writes it: nothing but the kind and the rows.
fn written(samples: &Samples, more: &str) -> String {
    let rows: Vec<String> = samples.rows().map(|row| format!("{row:?}")).collect();
    format!("machine = \"nine-link\"\n[task]\nkind = \"given\"\n{more}\nsamples = [{}]\n", rows.join(", "))
}

#[test]
fn a_scenario_needs_no_more_than_the_samples() {
    let samples = swinging(60);
    let read = Scenario::parse(&written(&samples, ""), "own.toml", None).expect("a scenario");
    assert_eq!(read.task, scenario(TaskKind::Given, &samples, None).task);
    assert_eq!(read.task.time, 1.5);
    let b = Inertia::of(machine()).lambda().dot(samples.values(0));
    assert!((read.task.b - b).abs() < 1e-14);
    let again = Scenario::parse(&read.to_toml(), "own.toml", None).expect("a scenario");
    assert_eq!(again, read);

    // It begins in motion, as given, and is tracked from the first instant on.
    let mut first: Option<Frame> = None;
    let run = replay(&read, |_, frame| {
        first.get_or_insert(*frame);
        let given = swing(frame.time.min(1.5));
        for (k, q) in given.iter().enumerate() {
            assert!((frame.q[k] - q).abs() < 1e-6, "drive {} at {} s: {} for {q}", k + 1, frame.time, frame.q[k]);
        }
    })
    .expect("it runs");
    let first = first.expect("a frame");
    assert!((first.qd[0] - 0.6).abs() < 1e-5 && first.angular_momentum.abs() > 0.1, "{:?}", first.qd);
    // The last instant still belongs to the motion: no brake of one step is in the peaks.
    let last = run.frame();
    assert!((last.qd[0] - 0.6 * 4.5f64.cos()).abs() < 1e-4, "{:?}", last.qd);
    let planned = run.plan().forecast;
    assert!((last.peaks.moment / planned.moment - 1.0).abs() < 1e-3, "{} {}", last.peaks.moment, planned.moment);

    for (text, words) in [
        (written(&elliptic(50), ""), "own.toml:2: pose constant at A (task.b) is missing"),
        (written(&samples, "").replace("[[", "[[nan, 1, 1, 1], ["), "sample 1, number 1: want a finite number"),
        (
            "machine = \"nine-link\"\n[task]\nkind = \"reactionless\"\nb = 2.4\nto = [0.5, 0.5]\n".into(),
            "point A (task.from) is missing",
        ),
    ] {
        let said = Scenario::parse(&text, "own.toml", None).expect_err("refused").to_string();
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn samples_that_do_not_fit_the_task_are_refused_with_the_way_out() {
    let drives = scenario(TaskKind::Given, &swinging(60), None);
    let tip = scenario(TaskKind::Given, &elliptic(60), Some(2.4));
    let with = |scenario: &Scenario, change: &dyn Fn(&mut Task)| {
        let mut scenario = scenario.clone();
        change(&mut scenario.task);
        Run::new(&scenario).expect_err("refused").to_string()
    };
    for (said, words) in [
        (with(&drives, &|t| t.samples = None), "wants samples"),
        (with(&drives, &|t| t.kind = TaskKind::MinimumNorm), "want the kind given"),
        (with(&drives, &|t| t.closed = true), "open path"),
        (with(&drives, &|t| t.law = stillbase::planning::timing::TimeLaw::Fastest), "law quintic"),
        (with(&tip, &|t| t.kind = TaskKind::ChangeB), "given, reactionless, minimum-norm or zero-momentum"),
        (with(&tip, &|t| t.b = 5.0), "would do"),
        (
            with(&drives, &|t| t.samples = Some(samples(&uneven(20), |t| vec![t; 4]))),
            "angles of 4 drives, and the machine has 3: want rows of t, q1 … q3",
        ),
        // Past a joint limit.
        (with(&drives, &|t| t.samples = Some(samples(&uneven(20), |t| vec![0.0, t - 0.5, 0.0]))), "limit"),
    ] {
        assert!(said.contains(words), "{said:?} lacks {words:?}");
    }
}

#[test]
fn a_given_end_effector_is_followed_on_the_plane_or_with_minimum_norm() {
    let samples = elliptic(120);
    for kind in [TaskKind::Given, TaskKind::Reactionless, TaskKind::MinimumNorm] {
        let run = Run::new(&scenario(kind, &samples, Some(2.4))).expect("it can start");
        let motion = &run.plan().motion;
        for i in 0..samples.count() {
            let miss = (tip(&motion.at(samples.time(i))) - samples.point(i)).norm();
            assert!(miss < 1e-9, "{kind:?}: {miss:e} m at sample {i}");
        }
        // Between the samples it is as good as the spline.
        for i in 0..1000 {
            let t = f64::from(i) * 0.002;
            let want = ellipse(t);
            assert!((tip(&motion.at(t)) - Vector::new(want[0], want[1])).norm() < 1e-6);
        }
        let end = replay(run.scenario(), |_, _| {}).expect("it runs").frame();
        assert_eq!(end.peaks.is_reactionless(), kind != TaskKind::MinimumNorm, "{kind:?}: {:?}", end.peaks);
    }
}

/// The frames of a saved session, by way of its file.
fn replayed(session: &Session) -> Vec<Frame> {
    let saved = session.to_scenario();
    let read = Scenario::parse(&saved.to_toml(), "saved.toml", None).expect("a scenario");
    assert_eq!(read, saved);
    let mut frames = Vec::new();
    replay(&read, |_, frame| frames.push(*frame)).expect("it runs");
    frames
}

#[test]
fn a_given_motion_lives_in_a_session() {
    let mut session = Session::open(scenario(TaskKind::Given, &swinging(60), None)).expect("it can start");
    let see = |session: &Session| {
        let views = Views::of(session.run());
        let scene = views.stage().scene(session.frame(), &ViewOptions::default());
        assert!(scene.lines.iter().any(|line| line.name == "plan/path"));
        let places: Vec<_> = scene.markers.iter().filter(|m| m.name == "plan/waypoints").map(|m| m.at).collect();
        assert_eq!(places.len(), 2);
        for (at, share) in places.into_iter().zip([0.0, 1.0]) {
            let want = session.run().end_effector_on_path(share);
            assert!((f64::from(at[0]) - want.re).hypot(f64::from(at[1]) - want.im) < 1e-6);
        }
    };
    see(&session);
    // Handles that samples leave no say.
    let task = session.scenario().task.clone();
    let at = Vector::new(0.5, 0.6);
    assert!(task.moving(0, at).is_none() && task.adding(at).is_none() && task.removing(0).is_none());
    let drawn = Task::drawing(&[at, 2.0 * at]).expect("two points");
    let before = session.run().plan().clone();
    assert!(matches!(session.apply(Edit::of("task", drawn)), Err(Refusal::Task(_))));
    assert_eq!(session.run().plan(), &before);

    // Posed on another plane it turns as a whole; stretched in time its peaks go with 1/T².
    let b = session.frame().b + 0.5;
    session.apply(Edit::PoseB { b }).expect("it turns");
    session.end_gesture();
    assert!((session.frame().b - b).abs() < 1e-12);
    let (turned, peak) = (session.run().plan().clone(), session.run().plan().forecast.moment);
    assert!((peak / before.forecast.moment - 1.0).abs() < 1e-9);
    for t in [0.0, 0.4, 1.5] {
        let [x, y] = [&before, &turned].map(|plan| plan.motion.at(t));
        assert!((y.q.0.minus(&x.q.0).minus(&PerDrive::from([y.q[0] - x.q[0]; 3]))).max_abs() < 1e-12);
        assert!((x.q[1] - x.q[0] - y.q[1] + y.q[0]).abs() < 1e-12);
    }
    see(&session);
    session.apply(Edit::set("task.time", 3.0)).expect("slower");
    session.end_gesture();
    assert!((4.0 * session.run().plan().forecast.moment / peak - 1.0).abs() < 1e-6);
    session.undo().expect("back");
    assert_eq!(session.run().plan(), &turned);
    // What the machine weighs does not turn it.
    session.apply(Edit::set("payload.mass", stillbase::settings::change::value("0.3"))).expect("heavier");
    session.end_gesture();
    assert_eq!(session.run().plan().motion, turned.motion);
    session.undo().expect("back");
    session.undo().expect("back");
    assert_eq!(session.run().plan(), &before);

    session.play();
    session.tick(700);
    session.apply(Edit::DragTarget { x: 0.5, y: 0.7 }).expect("led away in motion");
    session.tick(400);
    let frames = session.frames().to_vec();
    assert_eq!(replayed(&session), frames);
    // Another kind takes the machine back; the samples go with their kind.
    let change = [("kind", "reactionless"), ("samples", "default"), ("turn", "default")];
    let change = change.into_iter().map(|(key, value)| (key.to_owned(), value.into())).collect();
    session.apply(Edit::of("task", change)).expect("from its first to its last point");
    assert!(session.scenario().task.samples.is_none() && session.run().plan().forecast.moment < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    /// Turned as a whole onto a plane: relative angles stay, b stands still, and no other constant b is nearer than the
    /// mean. The distance has a closed form, |b − b(t)|/Σλ.
    #[test]
    fn the_mean_b_is_the_nearest(amplitude in 0.05..0.4_f64, w in 1.0..5.0_f64, off in 0.01..0.5_f64) {
        let model = Inertia::of(machine());
        let lambda = model.lambda();
        let of = |t: f64| vec![1.7 + amplitude * (w * t).sin(), 3.7 + 0.3 * t, 2.2 - amplitude * (w * t).cos()];
        let given = samples(&uneven(100), of);
        let mean = {
            let f = stillbase::planning::forecast::Forecast::at(&motion(&given), &ArmOnBase::fixed(model.clone(), &Default::default()),
                &stillbase::planning::timing::DriveLimits::of(machine()), 20_000);
            f.b_mean
        };
        let distance = |b: f64| {
            let moved = turned_to_plane(&lambda, &given, b).expect("finite");
            Deviation::between(machine().end_effector(), &model, &motion(&given), &motion(&moved), 20_000)
        };
        let best = distance(mean);
        for b in [mean - off, mean + off] {
            let other = distance(b);
            prop_assert!(other.rms > best.rms);
            // Pythagoras in the metric of kinetic energy.
            let want = (best.rms.powi(2) + (off / lambda.iter().sum::<f64>()).powi(2)).sqrt();
            prop_assert!((other.rms - want).abs() < 1e-6, "{} {want}", other.rms);
        }
        let quiet = motion(&turned_to_plane(&lambda, &given, mean).expect("finite"));
        for i in 0..=100 {
            let t = f64::from(i) / 100.0;
            let (r, g) = (quiet.at(t), of(t));
            prop_assert!((lambda.dot(&r.q) - mean).abs() < 1e-12 && lambda.dot(&r.qdd).abs() < 1e-8);
            prop_assert!((r.q[1] - r.q[0] - g[1] + g[0]).abs() < 1e-5);
        }
    }
}

#[test]
fn the_end_effector_is_kept_on_the_nearest_plane_that_reaches_it() {
    let (machine, model) = (machine(), Inertia::of(machine()));
    let space = PoseSpace::of(machine).expect("it has a b");
    let (map, given) = (space.planes().expect("three drives").map(), swinging(150));
    let as_given = motion(&given);
    let moved = |b: f64| same_tip(&space, &model, &given, b, Rule::default()).ok().flatten();
    let far =
        |b: f64| moved(b).map(|m| Deviation::between(machine.end_effector(), &model, &as_given, &motion(&m), 3000));
    let (b, rms) = nearest_b(&space, &model, &given, Rule::default(), &mut |_| true).expect("some plane does");
    let best = far(b).expect("it does");
    assert!((best.rms / rms - 1.0).abs() < 1e-3, "{} {rms}", best.rms);
    assert!(best.end_effector < 1e-6 && best.rms > 1e-3, "{best:?}");
    for i in 0..given.count() {
        let q = moved(b).expect("it does");
        let [was, is] = [given.values(i), q.values(i)].map(|q| (0..3).map(|k| map.c()[k] * unit(q[k])).sum::<Vector>());
        assert!((was - is).norm() < 1e-10 && (map.project(q.values(i)).b - b).abs() < 1e-12);
    }
    // Brute force finds none that is nearer.
    for i in -40..=40 {
        let other = b + 0.01 * f64::from(i);
        if let Some(other) = far(other) {
            assert!(other.rms >= best.rms * (1.0 - 1e-4), "{} {}", other.rms, best.rms);
        }
    }
    // A motion that is on a plane already is its own nearest.
    let on = moved(b).expect("it does");
    let (same, rms) = nearest_b(&space, &model, &on, Rule::default(), &mut |_| true).expect("its own");
    assert!((same - b).abs() < 1e-6 && rms < 1e-6, "{same} {b} {rms}");
}

/// The commands, as scripts see them.
#[cfg(feature = "cli")]
mod commands {

    use serde_json::Value;

    use super::*;
    use crate::folder::Folder;

    impl Folder {
        /// What is printed, and what is said, by a command that ends with a status.
        #[track_caller]
        fn ends(&self, status: i32, args: &[&str]) -> (String, String) {
            let out = self.run(args);
            let [printed, said] = [out.stdout, out.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
            assert_eq!(out.status.code(), Some(status), "{args:?}: {said}");
            (printed, said)
        }
        #[track_caller]
        fn object(&self, args: &[&str]) -> Value {
            let (printed, _) = self.ends(0, &[args, &["--json"]].concat());
            serde_json::from_str(&printed).expect("one object")
        }
    }

    fn csv(head: &str, rows: impl Iterator<Item = Vec<f64>>) -> String {
        let line = |row: Vec<f64>| row.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(",");
        let rows: Vec<String> = rows.map(line).collect();
        format!("{head}\n{}\n", rows.join("\n"))
    }

    fn of(samples: &Samples, head: &str, scale: &[f64]) -> String {
        csv(head, samples.rows().map(|row| row.iter().zip(scale).map(|(x, scale)| x * scale).collect()))
    }

    fn number(value: &Value) -> f64 {
        value.as_f64().expect("a number")
    }

    /// Rows of an exported file, by column.
    fn exported(folder: &Folder, args: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
        let answer = folder.object(&[&["export"], args].concat());
        let columns = answer["columns"].as_array().expect("names").iter().map(|c| c.as_str().expect("a name").into());
        let row = |row: &Value| row.as_array().expect("a row").iter().map(number).collect();
        (columns.collect(), answer["rows"].as_array().expect("rows").iter().map(row).collect())
    }

    #[test]
    fn a_file_comes_in_and_goes_out_as_it_was() {
        // Smooth all along: case 1 at ever higher rates, read again, against case 1 itself.
        let folder = Folder::new("given");
        let run = Run::new(&Scenario::builtin("case-1").expect("built in")).expect("it can start");
        let exact = &run.plan().motion;
        let worst = |rate: &str| {
            folder.ends(0, &["export", "case-1", "--rate", rate, "-o", "out.csv", "--force"]);
            folder.ends(0, &["import", "out.csv", "-o", "in.toml", "--force"]);
            let read =
                stillbase::files::scenario(&folder.0.join("in-given.toml").display().to_string()).expect("a scenario");
            let again = Run::new(&read.scenario).expect("it can start").plan().motion.clone();
            let mut worst = [0.0_f64; 3];
            for i in 0..=2000 {
                let [x, y] = [exact, &again].map(|m| m.at(f64::from(i) / 2000.0 * m.duration().min(1.0 - 1e-12)));
                let off = [x.q.0.minus(&y.q.0), x.qd.minus(&y.qd), x.qdd.minus(&y.qdd)].map(|off| off.max_abs());
                (0..3).for_each(|k| worst[k] = worst[k].max(off[k]));
            }
            worst
        };
        // Over three octaves: at the ends the error may change its sign on the way.
        let [coarse, fine] = ["16", "128"].map(worst);
        for (k, order) in [6.0, 5.0, 4.0].into_iter().enumerate() {
            let rate = (coarse[k] / fine[k]).log2() / 3.0;
            assert!((rate - order).abs() < 0.6, "derivative {k}: order {rate:.2} of {coarse:?}, {fine:?}");
        }
        folder.ends(0, &["export", "case-1", "--rate", "64", "-o", "out.csv", "--force"]);
        folder.ends(0, &["import", "out.csv", "-o", "in.toml", "--force"]);
        // Every digit: what is exported again at the same rate are the same angles.
        let [first, second] = [["out.csv", "a.csv"], ["in-given.toml", "b.csv"]];
        folder.ends(0, &["export", second[0], "--rate", "64", "-o", second[1]]);
        let read = |name: &str| std::fs::read_to_string(folder.0.join(name)).expect("a file");
        let angles = |text: &str| -> Vec<String> {
            text.lines().map(|line| line.split(',').take(4).collect::<Vec<_>>().join(",")).collect()
        };
        assert_eq!(angles(&read(first[0])), angles(&read(second[1])));
    }

    #[test]
    fn an_export_is_the_motion_with_the_torques_it_needs() {
        let folder = Folder::new("given");
        let (columns, rows) = exported(&folder, &["case-3", "--rate", "300"]);
        let head = "t,q1,q2,q3,qd1,qd2,qd3,qdd1,qdd2,qdd3,tau_ff1,tau_ff2,tau_ff3,x,y,b";
        assert_eq!(columns.join(","), head);
        assert_eq!((rows.len(), rows[300][0]), (301, 1.0));
        let model = Inertia::of(machine());
        for row in &rows {
            for k in 0..3 {
                // The machine obeys τ = H q̈ with a constant diagonal H.
                assert!((row[10 + k] - model.diagonal(k) * row[7 + k]).abs() < 1e-12);
            }
            assert!((row[15] - 2.4).abs() < 1e-12);
        }
        // A rate that does not divide: the end is there all the same, and said.
        let (printed, said) = folder.ends(0, &["export", "case-3", "--rate", "7"]);
        let times: Vec<f64> =
            printed.lines().skip(1).map(|l| l.split(',').next().expect("t").parse().expect("s")).collect();
        assert_eq!((times.len(), times[7]), (8, 1.0));
        let (printed, said_too) = folder.ends(0, &["export", "case-3", "--rate", "7.5"]);
        assert_eq!(printed.lines().count(), 1 + 9);
        assert!(
            said.is_empty() && said_too.contains("does not divide") && said_too.contains("66.666667 ms"),
            "{said_too}"
        );
        // What the simulated machine does, under a load that control does not know of, differs.
        let simulated = ["case-1", "--what", "simulated", "--rate", "100", "--set", "plant.payload.mass=0.5"];
        let (columns, loaded) = exported(&folder, &simulated);
        assert!(columns[10] == "tau1" && loaded.len() == 101);
        let (_, planned) = exported(&folder, &["case-1", "--rate", "100"]);
        assert!((loaded[50][1] - planned[50][1]).abs() > 1e-5);
        for (args, words) in [
            (["--rate", "300", "--what", "simulated"], "does not divide"),
            (["--rate", "1e6", "--set", "task.time=100"], "rows"),
            (["--rate", "0", "--what", "reference"], "1000000 Hz"),
        ] {
            let (_, said) = folder.ends(2, &[&["export", "case-3"][..], &args].concat());
            assert!(said.contains(words), "{said}");
        }
    }

    #[test]
    fn an_import_reports_and_proposes() {
        let folder = Folder::new("given");
        let (given, model) = (swinging(150), Inertia::of(machine()));
        folder.file("own.csv", of(&given, "t,q1,q2,q3", &[1.0; 4]));
        let answer = folder.object(&["import", "own.csv", "-o", "quiet.toml"]);
        let own = &answer["given"];
        // n_B = −D_1 b̈, in closed form.
        let lambda = model.lambda();
        let mut want = [0.0_f64; 2];
        for i in 0..=20_000 {
            let t = 1.5 * f64::from(i) / 20_000.0;
            let bdd =
                -1.8 * (3.0 * t).sin() - lambda[1] * 0.8 * (2.0 * t).cos() - lambda[2] * 0.8 * (2.0 * t + 1.0).sin();
            let n_b = model.diagonal(0) * bdd.abs();
            want = [want[0].max(n_b), want[1] + n_b * 1.5 / 20_000.0];
        }
        assert!((number(&own["peak_base_moment"]) / want[0] - 1.0).abs() < 1e-3, "{own} {want:?}");
        assert!((number(&own["moment_impulse"]) / want[1] - 1.0).abs() < 1e-3, "{own} {want:?}");
        let bd = 0.6 * 4.5f64.cos() - lambda[1] * 0.4 * 3f64.sin() + lambda[2] * 0.4 * 4f64.cos();
        assert!((number(&own["angular_momentum_end"]) - model.diagonal(0) * bd).abs() < 1e-5, "{own}");
        let proposal = &answer["proposal"];
        assert_eq!((&answer["feasible"], &proposal["way"]), (&Value::Bool(true), &Value::from("same-tip")));
        assert!(number(&proposal["tip_deviation"]) < 1e-6 && number(&proposal["simulated_peak_base_moment"]) < 1e-6);

        // What was written runs: the proposal without a reaction, the given one with its own.
        for (file, quiet) in [("quiet.toml", true), ("quiet-given.toml", false)] {
            let run = folder.object(&["simulate", file, "--every", "1000"]);
            assert_eq!(run["verdict"]["reactionless"], Value::Bool(quiet), "{file}");
        }
        let (_, said) = folder.ends(2, &["import", "own.csv", "-o", "quiet.toml"]);
        assert!(said.contains("--force"), "{said}");

        // The same motion in other units, wrapped, with other columns about it, is the same motion.
        let degrees = 180.0 / std::f64::consts::PI;
        folder.file("units.csv", of(&given, "Time (ms),q1 (deg),q2 [deg],q3_deg", &[1e3, degrees, degrees, degrees]));
        let wrap = |q: f64| q - std::f64::consts::TAU * (q / std::f64::consts::TAU).round();
        let row = |row: &[f64]| vec![9.0, wrap(row[3]), wrap(row[2]), row[0], wrap(row[1])];
        folder.file("wrapped.csv", csv("note,q3,q2,t,q1", given.rows().map(row)).replace(',', ";"));
        for file in ["units.csv", "wrapped.csv"] {
            let again = folder.object(&["import", file]);
            for key in ["peak_base_moment", "rms_base_moment", "b_mean"] {
                let [x, y] = [&own[key], &again["given"][key]].map(number);
                assert!((x / y - 1.0).abs() < 1e-6, "{file} {key}: {x} {y}");
            }
        }

        // Turned as a whole, if asked to or if no plane reaches all of its path.
        let answer = folder.object(&["import", "own.csv", "--keep", "joints"]);
        assert_eq!(answer["proposal"]["way"], "turned");
        assert!(
            number(&answer["proposal"]["tip_deviation"]) > 0.01
                && number(&answer["proposal"]["peak_base_moment"]) < 1e-6
        );
        let ramp = |t: f64| t * t * t * (10.0 + t * (-15.0 + 6.0 * t));
        let spun = samples(&uneven(100), |t| {
            [0.9, 1.0, 1.1].iter().zip([1.7, 3.7, 2.2]).map(|(w, q)| q + 2.5 * w * ramp(t)).collect()
        });
        folder.file("spun.csv", of(&spun, "t,q1,q2,q3", &[1.0; 4]));
        let answer = folder.object(&["import", "spun.csv"]);
        assert_eq!(answer["proposal"]["way"], "turned");
        assert!(answer["proposal"]["why"].as_str().expect("words").contains("no b reaches all of it"), "{answer}");
        let (_, said) = folder.ends(1, &["import", "spun.csv", "--keep", "tip"]);
        assert!(said.contains("no b reaches all of it"), "{said}");
        // Where the arm only turns as a whole, nothing is left.
        let stiff = samples(&uneven(100), |t| [1.7, 3.7, 2.2].map(|q| q + 2.5 * ramp(t)).to_vec());
        folder.file("stiff.csv", of(&stiff, "t,q1,q2,q3", &[1.0; 4]));
        let (_, said) = folder.ends(1, &["import", "stiff.csv"]);
        assert!(said.contains("only turns the arm as a whole"), "{said}");
        let (_, said) = folder.ends(1, &["import", "spun.csv", "--keep", "tip"]);
        assert!(said.contains("no b reaches all of it"), "{said}");
    }

    #[test]
    fn x_and_y_are_resolved_on_a_plane_or_refused() {
        let folder = Folder::new("given");
        folder.file("own.csv", of(&elliptic(200), "t,x (mm),y (mm)", &[1.0, 1e3, 1e3]));
        let answer = folder.object(&["import", "own.csv", "-o", "own.toml"]);
        assert_eq!((&answer["content"], &answer["proposal"]["way"]), (&Value::from("tip"), &Value::from("on-plane")));
        assert!(
            number(&answer["given"]["peak_base_moment"]) > 0.5
                && number(&answer["proposal"]["peak_base_moment"]) < 1e-6
        );
        assert!(number(&answer["proposal"]["tip_deviation"]) < 1e-7);
        let at = folder.object(&["import", "own.csv", "--b", "2.5"]);
        assert!((number(&at["proposal"]["b"]) - 2.5).abs() < 1e-12);
        folder.ends(2, &["import", "own.csv", "--keep", "joints"]);
        let (_, said) = folder.ends(1, &["import", "own.csv", "--b", "5"]);
        assert!(said.contains("rad would do"), "{said}");
        let far = samples(&uneven(60), |t| vec![0.5 - 1.1 * t, 0.5 - 0.7 * t]);
        folder.file("far.csv", of(&far, "t,x,y", &[1.0; 3]));
        let out = folder.run(&["import", "far.csv", "--json", "-o", "far.toml"]);
        let answer: Value = serde_json::from_slice(&out.stdout).expect("an object all the same");
        assert_eq!((out.status.code(), &answer["feasible"]), (Some(1), &Value::Bool(false)));
        assert!(
            answer["reason"].as_str().expect("words").contains("no b reaches all of it")
                && !folder.0.join("far.toml").exists()
        );
        // A machine that is not balanced transmits all the same, and is told so.
        folder.file("own-q.csv", of(&swinging(150), "t,q1,q2,q3", &[1.0; 4]));
        let (_, said) = folder.ends(1, &["import", "own-q.csv", "--set", "link.5.com=0"]);
        assert!(said.contains("not balanced"), "{said}");
    }

    #[test]
    fn noise_is_noticed_and_smoothed_away() {
        let folder = Folder::new("given");
        let tremble = noise(4500);
        let rough = csv(
            "t,q1,q2,q3",
            (0..1500).map(|i| {
                let t = f64::from(i) * 0.001;
                let q = swing(t).into_iter().enumerate().map(|(k, q)| q + 1e-5 * tremble[3 * i as usize + k]);
                std::iter::once(t).chain(q).collect()
            }),
        );
        folder.file("rough.csv", &rough);
        let (printed, said) = folder.ends(0, &["import", "rough.csv", "--json"]);
        assert!(said.contains("uncertain") && said.contains("--smooth"), "{said}");
        let answer: Value = serde_json::from_str(&printed).expect("an object");
        let smooth = folder.object(&["import", "rough.csv", "--smooth", "15"]);
        let peak = |answer: &Value| number(&answer["given"]["peak_base_moment"]);
        let clean = motion(&swinging(150));
        let want = stillbase::planning::forecast::Forecast::at(
            &clean,
            &ArmOnBase::fixed(Inertia::of(machine()), &Default::default()),
            &stillbase::planning::timing::DriveLimits::of(machine()),
            4000,
        );
        assert!(
            peak(&answer) > 10.0 * want.moment && (peak(&smooth) / want.moment - 1.0).abs() < 0.1,
            "{}",
            peak(&smooth)
        );
        assert!(number(&smooth["smoothed_by"]) < 1e-4);
        let (_, said) = folder.ends(2, &["import", "rough.csv", "--smooth", "500"]);
        assert!(said.contains("half of the mean rate"), "{said}");
    }

    /// Where nothing can be proposed, the motion as given is written all the same.
    #[test]
    fn a_motion_without_proposal_is_written_as_given() {
        let folder = Folder::new("given");
        let eased = |s: f64| s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        let row = |i: i32| {
            let e = eased(f64::from(i) / 40.0);
            vec![0.05 * f64::from(i), 0.2 + 0.8 * e, 0.9 + 0.3 * e, 1.6 - 0.6 * e]
        };
        folder.file("own.csv", csv("t,q1,q2,q3", (0..=40).map(row)));
        let on_spot = ["import", "own.csv", "--machine", "spot", "--base", "spot", "-o", "quiet.toml"];
        let (printed, said) = folder.ends(1, &on_spot);
        assert!(printed.contains("peak turn of the base") && said.contains("dynamic singularity"), "{printed}{said}");
        assert!(said.contains("wrote quiet-given.toml"), "{said}");
        folder.ends(0, &["plan", "quiet-given.toml"]);
        assert!(!folder.path("quiet.toml").exists());
    }

    #[test]
    fn what_is_wrong_is_said_with_file_line_and_column() {
        let folder = Folder::new("given");
        let good = of(&swinging(40), "t,q1,q2,q3", &[1.0; 4]);
        let lines: Vec<&str> = good.lines().collect();
        let with = |line: usize, text: &str| {
            let mut lines = lines.clone();
            lines[line - 1] = text;
            lines.join("\n")
        };
        let without = |cut: std::ops::Range<usize>| [&lines[..cut.start], &lines[cut.end..]].concat().join("\n");
        let degrees = 180.0 / std::f64::consts::PI;
        for (text, words) in [
            (String::new(), vec!["own.csv:1: nothing here: want a header t,q1,q2,q3"]),
            (lines[1..].join("\n"), vec!["own.csv:1: no header"]),
            (with(1, "t,q1,q3"), vec!["own.csv:1: no column q2 among \"t\", \"q1\", \"q3\""]),
            (with(1, "q0,q1,q2,q3"), vec!["own.csv:1: no column t"]),
            (with(1, "t,q1,q2,q2"), vec!["own.csv:1: columns 3 and 4 are both q2"]),
            (with(1, "t,q1 (turns),q2,q3"), vec!["own.csv:1: column q1: unit \"turns\": want one of rad"]),
            (with(7, "5.3,nan,3.7,2.2"), vec!["own.csv:7: column q1: \"nan\": want a finite number"]),
            (with(7, "5.3,1.7,,2.2"), vec!["own.csv:7: column q2: nothing there"]),
            (with(7, "5.3,1.7"), vec!["own.csv:7: column q2: nothing there"]),
            (with(7, "5.3,1.7,3.7 rad,2.2"), vec!["own.csv:7: column q2: \"3.7 rad\""]),
            (with(7, "5,1.7,3.7,2.2"), vec!["own.csv:7: column t: 5 s after 5.15", "want times that rise"]),
            (lines[..5].join("\n"), vec!["own.csv: 4 rows of numbers: want at least 6"]),
            (without(10..30), vec!["own.csv:11: column t: 0.787500 s after line 10, where 0.0375", "--gaps"]),
            (
                with(42, "6.5,1.504,5.9,2.049"),
                vec!["own.csv:42: column q2: a jump of", "from line 41", "no whole turn"],
            ),
            (
                of(&swinging(40), "t,q1,q2,q3", &[1.0, degrees, degrees, degrees]),
                vec!["own.csv:2: column q1: 97.4", "(deg)"],
            ),
            (with(1, "t,u,v,w"), vec!["own.csv:1: no column q1"]),
        ] {
            folder.file("own.csv", &text);
            let (printed, said) = folder.ends(2, &["import", "own.csv"]);
            assert!(printed.is_empty());
            assert_eq!(said.trim_end().lines().count(), 1, "{said}");
            for word in words {
                assert!(said.contains(word), "{said:?} lacks {word:?}");
            }
        }
        folder.file("own.csv", without(10..12));
        folder.ends(0, &["import", "own.csv", "--gaps"]);
        let (_, said) = folder.ends(2, &["import", "none.csv"]);
        assert!(said.contains("none.csv"), "{said}");
    }
}
