//! Bases that move: reference answers, conservation laws, and the closed forms that they obey.

use proptest::prelude::*;
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector, cross};
use stillbase::planning::Motion;
use stillbase::planning::curves::Path;
use stillbase::planning::timing::TimeLaw;
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;
use stillbase::simulation::control::Control;
use stillbase::simulation::frame::Frame;
use stillbase::simulation::plant::{Base, BaseKind, PlantDifferences, Wheel};
use stillbase::simulation::{Guide, Setup, Simulation};

use crate::support::{array, planning};

fn free() -> Base {
    Base { kind: BaseKind::Free, ..Base::default() }
}

fn line(from: [f64; 3], to: [f64; 3], time: f64) -> Guide {
    let path = Path::JointLine { from: from.into(), to: to.into() };
    Guide::Motion { motion: Motion::new(path, TimeLaw::Quintic, time).into(), start: 0.0, base_end: Default::default() }
}

fn begun(model: &Machine, plant: &PlantDifferences, base: &Base, control: &Control, guide: Guide) -> Simulation {
    Simulation::new(&Setup { model, plant, base, control, step: 0.001 }, guide).expect("valid")
}

fn run(model: &Machine, base: &Base, guide: Guide, steps: u64, mut see: impl FnMut(&Frame)) -> Frame {
    let mut simulation = begun(model, &PlantDifferences::default(), base, &Control::default(), guide);
    see(&simulation.frame());
    for _ in 0..steps {
        simulation.advance();
        see(&simulation.frame());
    }
    simulation.frame()
}

/// Samples that begin in motion: a free base moves from the start so that all momentum is zero, as the plan has it. A wheel
/// and gears change nothing of that.
#[test]
fn a_free_base_begins_without_momentum() {
    let spot = Scenario::builtin("spot").expect("built in");
    let begins = |kind: &str, more: &str, row: &dyn Fn(f64) -> Vec<f64>, machine: &str| {
        let row = |i: u32| {
            let t = 0.05 * f64::from(i);
            let values: Vec<String> = row(t).iter().map(f64::to_string).collect();
            format!("[{t}, {}]", values.join(", "))
        };
        let rows: Vec<String> = (0..=80).map(row).collect();
        let Base { mass, inertia, com, .. } = spot.base;
        let text = format!(
            "machine = '{machine}'\n[task]\nkind = '{kind}'\n{more}\nsamples = [{}]\n[base]\nkind = 'free'\nmass = {mass}\n\
             inertia = {inertia}\ncom = {com:?}\n",
            rows.join(", ")
        );
        Scenario::parse(&text, "moving", None).expect("valid")
    };
    // From full speed to rest.
    let eased = |t: f64| t / 4.0 - (t / 4.0).powi(3) / 3.0;
    let [x, y] = spot.task.from;
    let line =
        begins("zero-momentum", "start = [1.9, 2.6, 3.4]", &|t| vec![x + 0.1 * eased(t), y - 0.07 * eased(t)], "spot");
    let drives = |t: f64| [1.0, 1.7, 0.2].iter().enumerate().map(|(k, q)| q + (0.5 + k as f64) * eased(t)).collect();
    let given = begins("given", "", &drives, "spot");
    let geared = |t: f64| [1.6, 3.5, 2.0].iter().enumerate().map(|(k, q)| q + 0.2 * k as f64 * eased(t)).collect();
    let wheel = Wheel { inertia: 0.01, ..Wheel::default() };
    let mut wheeled = given.clone();
    wheeled.base.wheel = Some(wheel);
    for scenario in [line.clone(), given.clone(), wheeled, begins("given", "", &geared, "nine-link-geared")] {
        let mut momentum = 0.0_f64;
        let mut first = None;
        let run = replay(&scenario, |_, frame| {
            first.get_or_insert(*frame);
            let wheel = scenario.base.wheel.map_or(0.0, |wheel| wheel.inertia * frame.wheel.rate);
            assert!(frame.first_violation().is_none());
            momentum = momentum.max(frame.momentum.norm()).max((frame.angular_momentum + wheel).abs());
        })
        .expect("it runs");
        assert!(momentum < 1e-9, "{}: {momentum}", scenario.machine.name());
        let first = first.expect("a frame");
        assert!(first.base_velocity.norm() > 1e-4 && first.qd.max_abs() > 0.01, "{first:?}");
        let last = run.frame();
        if scenario.task.kind == line.task.kind {
            let [x, y] = scenario.task.to;
            assert!((last.end_effector - Vector::new(x, y)).norm() < 1e-6 && last.base.angle.abs() < 1e-9, "{last:?}");
        }
        if let Some(turn) = run.plan().base_turn.as_ref().filter(|_| scenario.base.floats()) {
            assert!((turn.angle_end - last.base.angle).abs() < 1e-6, "{} {}", turn.angle_end, last.base.angle);
        }
    }
}

/// The free-floating cases computed by other software.
#[test]
fn free_bases_end_where_the_reference_says() {
    let reference = planning();
    for case in reference["free_floating_base"].as_array().expect("cases") {
        let com: [f64; 9] = array(&case["com"]);
        let settings: Vec<(String, String)> =
            com.iter().enumerate().map(|(j, x)| (format!("link.{}.com", j + 1), x.to_string())).collect();
        let table_1 = builtin("nine-link-table-1").expect("built in");
        let pairs = settings.iter().map(|(key, value)| (key.as_str(), value.as_str()));
        let machine = table_1.set_all(pairs).expect("valid");
        let number = |key: &str| case["base"][key].as_f64().expect("a number");
        let base =
            Base { mass: number("mass"), inertia: number("inertia"), com: array(&case["base"]["com"]), ..free() };
        let guide = line(array(&case["q_start"]), array(&case["q_end"]), 1.0);
        let mut peak = [0.0_f64; 3];
        let end = run(&machine, &base, guide, 1000, |f| {
            peak = [peak[0].max(f.base.at.re.abs()), peak[1].max(f.base.at.im.abs()), peak[2].max(f.base.angle.abs())];
        });
        let want: [f64; 3] = array(&case["final_base_x_y_theta"]);
        let want_peak: [f64; 3] = array(&case["peak_abs_x_y_theta"]);
        let got = [end.base.at.re, end.base.at.im, end.base.angle];
        for i in 0..3 {
            assert!((got[i] - want[i]).abs() < 1e-8, "{}: {got:?}, want {want:?}", case["name"]);
            assert!((peak[i] - want_peak[i]).abs() < 1e-8, "{}: {peak:?}, want {want_peak:?}", case["name"]);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Δθ = −D_1 Δb / (I_b + μ|ρ|² + Σ D_k), whatever the path, with a controller that need not know the base.
    #[test]
    fn a_free_base_turns_by_the_change_of_b(
        from in prop::array::uniform3(-1.0..1.0_f64),
        by in prop::array::uniform3(-1.5..1.5_f64),
        rho in prop::array::uniform2(-0.3..0.3_f64),
        mass in 5.0..200.0_f64,
        inertia in 0.5..20.0_f64,
        knows_base: bool,
    ) {
        let model = builtin("nine-link").expect("built in");
        let base = Base { mass, inertia, com: rho, ..free() };
        let control = Control { knows_base, ..Control::default() };
        let from = [1.7 + from[0], 3.7 + from[1], 2.2 + from[2]];
        let to = [from[0] + by[0], from[1] + by[1], from[2] + by[2]];
        let mut simulation = begun(model, &PlantDifferences::default(), &base, &control, line(from, to, 1.0));
        let start = simulation.frame();
        let (body, d) = (Inertia::of(model), Inertia::of(model).diagonals());
        let reduced = mass * body.mass() / (mass + body.mass());
        let whole = inertia + reduced * (rho[0].powi(2) + rho[1].powi(2)) + d.iter().sum::<f64>();
        for _ in 0..1000 {
            simulation.advance();
            let f = simulation.frame();
            let want = -d[0] * (f.b - start.b) / whole;
            prop_assert!((f.base.angle - want).abs() < 1e-8, "{} for {want}", f.base.angle);
            // Nothing from outside: no momentum, and everything stays about its centre of mass.
            prop_assert!(f.momentum.norm() < 1e-13, "{}", f.momentum);
            prop_assert!(f.angular_momentum.abs() < 1e-12, "{}", f.angular_momentum);
        }
    }

    /// What the manipulator transmits is what moves the base, on machines that are not balanced, in gravity and pushed:
    /// m_b r̈ = f_B + m_b g + support, and the same for moments; all by differences of the base's own motion.
    #[test]
    fn the_wrench_moves_the_base(
        rho in prop::array::uniform2(-0.3..0.3_f64),
        gravity in prop::array::uniform2(-9.0..9.0_f64),
        force in prop::array::uniform2(-5.0..5.0_f64),
        com in -0.2..0.2_f64,
        compliant: bool,
    ) {
        let pull = format!("{},{}", gravity[0], gravity[1]);
        let off = com.to_string();
        let settings = [("gravity", pull.as_str()), ("link.1.com", off.as_str()), ("link.9.com_normal", "0.03")];
        let model = builtin("nine-link-table-1").expect("built in").set_all(settings).expect("valid");
        let kind = if compliant { BaseKind::Compliant } else { BaseKind::Free };
        let base = Base { kind, com: rho, ..Base::default() };
        let plant = PlantDifferences { force, ..toml::from_str("payload.mass = 0.3\npayload.offset = [0.05, -0.02]").expect("plant") };
        let guide = line([1.7, 3.7, 2.2], [1.4, 4.2, 3.0], 0.5);
        let (control, step) = (Control::default(), 1e-4);
        let setup = Setup { model: &model, plant: &plant, base: &base, control: &control, step };
        let mut simulation = Simulation::new(&setup, guide).expect("valid");
        let mut frames = vec![simulation.frame()];
        for _ in 0..2000 {
            simulation.advance();
            frames.push(simulation.frame());
        }
        let rho = Vector::new(rho[0], rho[1]);
        let gravity = Vector::new(gravity[0], gravity[1]);
        let momentum = |f: &Frame| {
            let arm = rho * Vector::from_polar(1.0, f.base.angle);
            let v = f.base_velocity + Vector::new(0.0, f.base_rate) * arm;
            (base.mass * v, base.mass * cross(f.base.at + arm, v) + base.inertia * f.base_rate)
        };
        let start = &frames[0];
        // The support at the start holds everything up.
        let lever = (start.com) * (simulation_mass(&model) + 0.3) + base.mass * rho;
        let total = simulation_mass(&model) + 0.3 + base.mass;
        for w in frames.windows(3).skip(1).step_by(50) {
            let (f, h) = (&w[1], 2.0 * step);
            let ((p0, h0), (p1, h1)) = (momentum(&w[0]), momentum(&w[2]));
            let wrench = f.wrench.total();
            let (mut support, mut moment) = (Vector::default(), 0.0);
            if compliant {
                let (k, c) = (base.stiffness, base.damping);
                let (p, v) = (f.base.at, f.base_velocity);
                support = -total * gravity - Vector::new(k[0] * p.re + c[0] * v.re, k[1] * p.im + c[1] * v.im);
                moment = -cross(lever, gravity) - k[2] * f.base.angle - c[2] * f.base_rate;
            }
            let arm = rho * Vector::from_polar(1.0, f.base.angle);
            let want_force = wrench.force + support + base.mass * gravity;
            let want_moment = wrench.moment + moment
                + cross(f.base.at, wrench.force + support)
                + cross(f.base.at + arm, base.mass * gravity);
            let scale = 1.0 + wrench.force.norm();
            prop_assert!(((p1 - p0) / h - want_force).norm() < 2e-4 * scale, "{} {want_force}", (p1 - p0) / h);
            prop_assert!(((h1 - h0) / h - want_moment).abs() < 2e-4 * scale, "{} {want_moment}", (h1 - h0) / h);
            prop_assert!((wrench.moment + f.torque.iter().sum::<f64>()).abs() < 1e-9 * scale);
        }
        let last = &frames[frames.len() - 1];
        prop_assert!(last.audit.energy.abs() < 1e-8, "{}", last.audit.energy);
        prop_assert!(last.audit.momentum < 1e-8 && last.audit.angular.abs() < 1e-8, "{:?}", last.audit);
    }
}

fn simulation_mass(machine: &Machine) -> f64 {
    machine.mass()
}

/// An hour of tumbling without a motor: momenta stay to the last digits, because they are the state. Arm and base turn
/// against each other, for a free base begins without momentum.
#[test]
fn momentum_is_kept_for_an_hour() {
    let model = builtin("nine-link-table-1").expect("built in").set("link.1.com", "0.1").expect("valid");
    let base = Base { com: [0.15, -0.1], ..free() };
    let zero = Control {
        kp: stillbase::simulation::plant::DriveValues::All(0.0),
        kd: stillbase::simulation::plant::DriveValues::All(0.0),
        ..Control::default()
    };
    let control = Control { law: stillbase::simulation::control::ControlLaw::Pd, ..zero };
    // Turning at the start: a guide that is in full motion when it begins.
    let path = Path::JointLine { from: [1.6, 3.5, 2.0].into(), to: [2.1, 4.4, 3.2].into() };
    let guide = Guide::Motion {
        motion: Motion::new(path, TimeLaw::Quintic, 2.0).into(),
        start: -1.0,
        base_end: Default::default(),
    };
    let (plant, step) = (PlantDifferences::default(), 0.01);
    let setup = Setup { model: &model, plant: &plant, base: &base, control: &control, step };
    let mut simulation = Simulation::new(&setup, guide).expect("valid");
    let start = simulation.frame();
    assert!(start.base_velocity.norm() > 0.01 && start.base_rate.abs() > 0.1 && start.qd.max_abs() > 0.1, "it turns");
    assert!(start.momentum.norm() < 1e-13 && start.angular_momentum.abs() < 1e-13, "{start:?}");
    let mut worst = [0.0_f64; 2];
    for i in 1..=360_000 {
        simulation.advance();
        if i % 1000 == 0 {
            let f = simulation.frame();
            // About the centre of mass: the base drifts for metres, and a lever that long has digits of its own.
            worst[0] = worst[0].max((f.momentum - start.momentum).norm());
            let about = |f: &Frame| f.angular_momentum - cross(centre(&model, &base, f), f.momentum);
            worst[1] = worst[1].max((about(&f) - about(&start)).abs() / (1.0 + f.base.at.norm()));
        }
    }
    assert!(worst[0] < 1e-13 && worst[1] < 1e-13, "{worst:?}");
}

fn centre(model: &Machine, base: &Base, f: &Frame) -> Vector {
    let arm = Vector::new(base.com[0], base.com[1]) * Vector::from_polar(1.0, f.base.angle);
    (model.mass() * f.com + base.mass * (f.base.at + arm)) / (model.mass() + base.mass)
}

/// A compliant base is preloaded: at rest in gravity it stays where it is.
#[test]
fn a_compliant_base_rests_at_its_start() {
    let settings = [("gravity", "2,-9.81"), ("link.1.com", "0.2"), ("payload.mass", "1")];
    let model = builtin("nine-link").expect("built in").set_all(settings).expect("valid");
    let base = Base { kind: BaseKind::Compliant, com: [0.1, 0.2], ..Base::default() };
    let q = [1.7, 3.7, 2.2];
    let end = run(&model, &base, line(q, q, 1.0), 2000, |_| {});
    assert!(end.base.at.norm() < 1e-12 && end.base.angle.abs() < 1e-12, "{:?}", end.base);
    // And it rings at the frequency of its springs when the machine is one with it.
    assert!(end.qd.max_abs() < 1e-10);
}

/// On a stiff base everything is as on a fixed one, the more so the stiffer: the difference falls with the stiffness.
#[test]
fn a_stiff_base_is_a_fixed_one() {
    let case_1 = Scenario::builtin("case-1").expect("built in");
    let fixed = replay(&case_1, |_, _| {}).expect("runs").frame().peaks.moment;
    let off = [2e3, 2e4, 2e5].map(|k| {
        let mut scenario = case_1.clone();
        scenario.base = Base {
            kind: BaseKind::Compliant,
            stiffness: [k * 10.0, k * 10.0, k],
            damping: [0.0; 3],
            ..Base::default()
        };
        scenario.step = 2e-4;
        let tilt = replay(&scenario, |_, _| {}).expect("runs").frame().totals.base_angle;
        // Quasi-static: n_B / k.
        tilt * k / fixed - 1.0
    });
    assert!(off[1].abs() < 0.5 * off[0].abs() && off[2].abs() < 0.3 * off[1].abs(), "{off:?}");
}

/// Reactionless means: the spacecraft does not move at all; the paper's other cases move it.
#[test]
fn only_case_3_leaves_a_spacecraft_alone() {
    let moved = ["case-1", "case-2", "case-3"].map(|name| {
        let mut scenario = Scenario::builtin(name).expect("built in");
        scenario.base = Base { com: [0.15, -0.1], ..free() };
        let end = replay(&scenario, |_, f| assert!(f.first_violation().is_none(), "{:?}", f.audit));
        let totals = end.expect("runs").frame().totals;
        (totals.shift, totals.base_angle)
    });
    assert!(moved[0].0 > 1e-3 && moved[0].1 > 1e-2 && moved[1].1 > 1e-2, "{moved:?}");
    assert!(moved[2].0 < 1e-12 && moved[2].1 < 1e-12, "{moved:?}");
}

/// A wheel takes up the whole moment, until it saturates; then the base feels the rest.
#[test]
fn a_wheel_cancels_until_it_saturates() {
    let with = |wheel: Wheel| {
        let mut scenario = Scenario::builtin("case-1").expect("built in");
        scenario.base.wheel = Some(wheel);
        let mut wheel_momentum = 0.0_f64;
        let run = replay(&scenario, |_, f| {
            // What the wheel holds is what the manipulator has.
            let off = f.wheel.rate * wheel.inertia + f.angular_momentum;
            if f.totals.saturated.is_none() {
                wheel_momentum = wheel_momentum.max(off.abs());
            }
            assert!(f.first_violation().is_none(), "{:?}", f.audit);
        });
        let f = run.expect("runs").frame();
        assert!(wheel_momentum < 1e-9, "{wheel_momentum}");
        f
    };
    let ample = with(Wheel { inertia: 0.002, ..Wheel::default() });
    assert!(ample.peaks.is_base_unloaded() && !ample.peaks.is_reactionless() && ample.totals.saturated.is_none());
    assert!(ample.peaks.moment < 1e-9 && ample.totals.wheel_rate > 50.0, "{}", ample.totals.wheel_rate);
    let weak = with(Wheel { inertia: 0.002, torque_limit: Some(0.5), ..Wheel::default() });
    assert!((weak.peaks.moment - (1.0891 - 0.5)).abs() < 1e-3, "{}", weak.peaks.moment);
    let slow = with(Wheel { inertia: 0.002, speed_limit: Some(20.0), ..Wheel::default() });
    assert!(slow.totals.saturated.is_some_and(|t| t > 0.05 && t < 0.5), "{:?}", slow.totals.saturated);
    assert!(slow.totals.wheel_rate <= 20.0 * (1.0 + 1e-14), "{}", slow.totals.wheel_rate);
}

/// A light wheel whose torque would carry it past its limit within a step, on any base.
#[derive(Clone, Debug)]
struct Spun {
    case: &'static str,
    base: BaseKind,
    inertia: f64,
    top: f64,
    torque: Option<f64>,
    step: f64,
}

fn any_spun() -> impl Strategy<Value = Spun> {
    let cases = prop_oneof![Just("case-1"), Just("case-2")];
    let bases = prop_oneof![Just(BaseKind::Fixed), Just(BaseKind::Free), Just(BaseKind::Compliant)];
    let torque = prop_oneof![Just(None), (0.05..1.0_f64).prop_map(Some)];
    let step = prop_oneof![Just(1e-3), Just(5e-4), Just(2.5e-4)];
    (cases, bases, -4.0..-1.5_f64, 1.0..60.0_f64, torque, step).prop_map(|(case, base, digits, top, torque, step)| {
        Spun { case, base, inertia: 10.0_f64.powf(digits), top, torque, step }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The rate of a wheel never passes its limit by more than rounding, whatever it weighs; momenta and energy stay
    /// audited, and what the wheel has taken up is what it holds.
    #[test]
    fn a_wheel_keeps_to_its_top_rate(given in any_spun()) {
        let Spun { case, base, inertia, top, torque, step } = given;
        let mut scenario = Scenario::builtin(case).expect("built in");
        scenario.base.kind = base;
        scenario.step = step;
        scenario.duration = Some(0.5);
        scenario.base.wheel = Some(Wheel { inertia, torque_limit: torque, speed_limit: Some(top), ..Wheel::default() });
        let (mut stayed, mut before) = (0_u32, 0.0);
        let run = replay(&scenario, |_, f| {
            assert!(f.wheel.rate.abs() <= top * (1.0 + 1e-13), "{} of {top} at {} s", f.wheel.rate, f.time);
            assert!(f.wheel.torque.abs() <= torque.unwrap_or(f64::INFINITY));
            let at_top = f.wheel.rate.abs() >= top * (1.0 - 1e-13);
            // At its top rate it gives nothing outwards, and stays there to rounding.
            assert!(!at_top || f.wheel.torque * f.wheel.rate <= 1e-9, "{} N m at the limit", f.wheel.torque);
            stayed += u32::from(at_top && f.wheel.rate == before);
            before = f.wheel.rate;
            if base == BaseKind::Free {
                let whole = f.angular_momentum + inertia * f.wheel.rate;
                assert!(whole.abs() < 1e-10, "nothing comes from outside: {whole}");
            }
        });
        let end = run.expect("runs").frame();
        let fault = end.first_violation();
        prop_assert!(fault.is_none(), "{fault:?}");
        prop_assert!(end.totals.wheel_rate <= top * (1.0 + 1e-13));
        // One that has reached it without a weak motor stays there for a while.
        prop_assert!(stayed > 0 || end.totals.wheel_rate < top * (1.0 - 1e-13) || torque.is_some(), "{end:?}");
    }
}

/// The figure that was wrong: a light wheel flew past a limit of 5 rad/s within one step.
#[test]
fn a_light_wheel_stops_at_its_limit() {
    let ends = [1e-3, 2e-4, 5e-5].map(|step| {
        let mut scenario = Scenario::builtin("case-1").expect("built in");
        scenario.step = step;
        scenario.base.wheel =
            Some(Wheel { inertia: 1e-4, torque_limit: None, speed_limit: Some(5.0), ..Wheel::default() });
        let end = replay(&scenario, |_, _| {}).expect("runs").frame();
        assert!(end.totals.wheel_rate <= 5.0 * (1.0 + 1e-14), "{}", end.totals.wheel_rate);
        // It saturates in the step in which it reaches the limit.
        (end.totals.saturated.expect("it saturates"), end.peaks.moment, step)
    });
    for (time, moment, step) in &ends[..2] {
        assert!((time - ends[2].0).abs() < 1.5 * step, "{ends:?}");
        assert!((moment - ends[2].1).abs() < 1e-5, "{ends:?}");
    }
}

/// Control reads angles relative to the base, and b is that of relative angles.
#[test]
fn b_is_relative_to_the_base() {
    let mut scenario = Scenario::builtin("case-2").expect("built in");
    scenario.base = free();
    let model = Inertia::of(&scenario.machine);
    replay(&scenario, |_, f| {
        let relative = PerDrive::from_fn(3, |k| f.relative(k));
        assert!((f.b - model.lambda().dot(&relative)).abs() < 1e-12);
        let e = DriveAngles(f.q.0).units();
        let tip = f.base.at + stillbase::mechanics::kinematics::end_effector(scenario.machine.end_effector(), &e);
        assert!((f.end_effector - tip).norm() < 1e-14);
    })
    .expect("runs");
}
