//! Attitude of a free base: what turns it, what a wheel keeps of it, and what a plan foretells.

use proptest::prelude::*;
use stillbase::planning::timing::TimeLaw;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Run, base_forecast, replay};
use stillbase::simulation::frame::{Frame, Phase};
use stillbase::simulation::plant::{BaseKind, DriveValues, Wheel};

fn scenario(name: &str) -> Scenario {
    Scenario::builtin(name).expect("built in")
}

/// The swing of a real arm beside a wheel of 0.01 kg m².
fn swing(wheel: Wheel) -> Scenario {
    let mut swing = scenario("spot-swing");
    swing.base.wheel = Some(Wheel { inertia: 0.01, ..wheel });
    swing
}

fn frames(scenario: &Scenario) -> Vec<Frame> {
    let mut all = Vec::new();
    replay(scenario, |_, frame| all.push(*frame)).expect("runs");
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn the_felt_moment_turns_the_base(
        com in [-0.4..0.4f64, -0.4..0.4f64], mass in 1.0..60.0f64, inertia in 0.05..5.0f64, wheel in any::<bool>(),
        limit in 0.002..0.02f64, name in prop::sample::select(vec!["spot-swing", "case-1", "case-2"]),
    ) {
        let mut free = scenario(name);
        free.base.kind = BaseKind::Free;
        (free.base.com, free.base.mass, free.base.inertia) = (com, mass, inertia);
        free.base.wheel = wheel.then(|| Wheel { inertia: 0.01, torque_limit: Some(limit), ..Wheel::default() });
        free.duration = Some(3.0);
        for frame in frames(&free).iter().step_by(97) {
            // Euler: I_b θ̈ is the moment about the base's own centre of mass.
            let turning = inertia * frame.base_angular_acceleration;
            let scale = 1e-11 * (1.0 + frame.peaks.torque_sum + frame.peaks.force);
            prop_assert!((frame.felt_moment - turning).abs() < scale, "{} {turning}", frame.felt_moment);
        }
    }
}

/// Plans on free bases have the torques and reactions that their runs come to, with gears in joints and without.
#[test]
fn plans_have_the_torques_of_a_base_that_floats() {
    for name in ["spot-swing", "spot-turn", "spacecraft", "space-arm", "nine-link-geared", "counter-rotating", "wheel"]
    {
        for wheel in [None, Some(Wheel { inertia: 0.01, ..Wheel::default() })] {
            if name == "spot-turn" && wheel.is_some() {
                continue; // a task that turns the base
            }
            let mut free = scenario(name);
            free.base.kind = BaseKind::Free;
            if free.base.com == [0.0; 2] {
                (free.base.mass, free.base.inertia, free.base.com) = (30.0, 1.5, [0.2, -0.1]);
            }
            free.base.wheel = wheel;
            free.edits.clear();
            free.plant = Default::default();
            let run = Run::new(&free).unwrap_or_else(|why| panic!("{name}: {why}"));
            let forecast = run.plan().forecast;
            let end = *frames(&free).last().expect("frames");
            let scale = forecast.torque.max_abs();
            for (got, want) in forecast.torque.iter().zip(end.peaks.torque.iter()) {
                assert!((got - want).abs() < 2e-4 * scale, "{name}: {got} and {want} of {scale} N m");
            }
            let force = forecast.force;
            assert!((force - end.peaks.force).abs() < 2e-4 * force + 1e-9, "{name}: {force} and {} N", end.peaks.force);
            let moment = forecast.moment;
            assert!(
                (moment - end.peaks.arm_moment).abs() < 2e-4 * scale,
                "{name}: {moment} and {}",
                end.peaks.arm_moment
            );
        }
    }
}

/// A base that floats gives way: limits kept with the torques of a fixed one were passed by 12 % here.
#[test]
fn the_fastest_motion_on_a_free_base_keeps_its_limits() {
    for (law, limit) in [(TimeLaw::Fastest, "0.02"), (TimeLaw::Fastest, "0.5"), (TimeLaw::FastestSmooth, "0.05")] {
        for wheel in [None, Some(Wheel { inertia: 0.01, ..Wheel::default() })] {
            let mut swift = scenario(if wheel.is_some() { "spot-swing" } else { "spot-turn" });
            (swift.task.law, swift.base.wheel) = (law, wheel);
            if wheel.is_some() {
                // From point to point, as samples say when to be where.
                swift.task = scenario("spot").task;
                (swift.task.law, swift.duration) = (law, None);
            }
            let limits = ["shoulder", "elbow", "wrist"]
                .iter()
                .flat_map(|d| [(format!("drive.{d}.torque_limit"), limit), (format!("drive.{d}.jerk_limit"), "20")]);
            let limits: Vec<_> = limits.collect();
            swift.machine = swift.machine.set_all(limits.iter().map(|(k, v)| (k.as_str(), *v))).expect("limits");
            let end = *frames(&swift).last().expect("frames");
            let most = end.peaks.torque.max_abs() / limit.parse::<f64>().expect("a number");
            assert!(most < 1.0 + 1e-3 && most > 0.5, "{law:?}: {most} of its limit of {limit} N m");
            assert!(law == TimeLaw::FastestSmooth || most > 0.999, "{law:?}: {most} of its limit of {limit} N m");
        }
    }
}

/// The moment about the pin was cancelled once: the base of this arm turned by 1.2e-2 rad beside a silent wheel.
#[test]
fn a_wheel_keeps_the_attitude_of_a_base_whose_centre_is_off_the_pin() {
    for name in ["spot", "spot-swing"] {
        let mut beside = scenario(name);
        beside.base.wheel = Some(Wheel { inertia: 0.01, ..Wheel::default() });
        let all = frames(&beside);
        let end = all.last().expect("frames");
        // The samples of the swing begin with rates of some 1e-9 rad/s, and so does the base.
        let tolerance = if name == "spot" { 1e-12 } else { 2e-9 };
        let (angle, moment) = (end.totals.base_angle, end.peaks.moment);
        assert!(angle < tolerance && moment < tolerance, "{name}: {angle} rad, {moment} N m");
        let whole = |f: &Frame| f.angular_momentum + 0.01 * f.wheel.rate;
        assert!(all.iter().all(|f| (whole(f) - whole(&all[0])).abs() < 1e-12), "{name}");
        assert!(end.first_violation().is_none(), "{name}");
    }
    // What the arm has of momentum, the wheel takes up: without one the base turns by 34.92°.
    let taken = frames(&swing(Wheel::default())).last().expect("frames").totals.wheel_rate * 0.01;
    assert!((taken - 0.0554).abs() < 1e-4, "{taken}");
}

/// At rest and within its limits, feedback is all that acts: θ̈ = −K_p θ − K_d θ̇.
#[test]
fn attitude_feedback_is_that_of_an_oscillator() {
    for (kp, kd) in [(1.0, 2.0), (4.0, 1.0)] {
        let mut weak = swing(Wheel { torque_limit: Some(0.018), kp, kd, ..Wheel::default() });
        weak.duration = Some(16.0);
        let all = frames(&weak);
        let at = |time: f64| &all[(time / weak.step).round() as usize];
        let (from, to) = (at(12.0), at(14.5));
        assert!(from.phase == Phase::Rest && !from.wheel.saturated && from.base.angle.abs() > 1e-9, "{from:?}");
        // The solution of the oscillator, with complex eigenvalues of −K_d/2 ± i w.
        let (decay, time) = (0.5 * kd, 2.5);
        let square = kp - decay * decay;
        let (x, v) = (from.base.angle, from.base_rate);
        let want = match square > 1e-9 {
            true => {
                let w = square.sqrt();
                (-decay * time).exp() * (x * (w * time).cos() + (v + decay * x) / w * (w * time).sin())
            }
            false => (-decay * time).exp() * (x + (v + decay * x) * time),
        };
        assert!((to.base.angle - want).abs() < 1e-6 * x.abs().max(v.abs()), "{} {want}", to.base.angle);
    }
}

#[test]
fn a_dead_band_leaves_small_angles_alone() {
    let wheel = Wheel { kp: 4.0, kd: 1.0, dead_band: 0.1, ..Wheel::default() };
    assert_eq!([wheel.attitude_feedback(0.1, 0.0), wheel.attitude_feedback(-0.05, 0.2)], [0.0, 0.0]);
    assert!((wheel.attitude_feedback(0.3, 0.0) + 0.8).abs() < 1e-15);
    assert!((wheel.attitude_feedback(-0.3, -0.5) - 1.3).abs() < 1e-15);
    // A base that is turned away stays away by up to the band, and comes closer without one.
    let left = |dead_band| {
        let mut weak = swing(Wheel { torque_limit: Some(0.01), dead_band, ..Wheel::default() });
        weak.duration = Some(40.0);
        frames(&weak).last().expect("frames").base.angle.abs()
    };
    let (with, without) = (left(0.01), left(0.0));
    assert!(without < 1e-6 && (0.009..0.0101).contains(&with), "{with} {without}");
}

/// Between samples the torque is constant, so the error falls with the square of the interval.
#[test]
fn a_sampled_wheel_errs_less_the_faster_it_is() {
    let peak = |rate| frames(&swing(Wheel { rate, ..Wheel::default() })).last().expect("frames").totals.base_angle;
    let peaks = [10.0, 20.0, 40.0].map(peak);
    for pair in peaks.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((1.7..4.5).contains(&ratio), "{peaks:?}");
    }
    let mut motors = swing(Wheel::default());
    (motors.control.rate, motors.control.kp) = (100.0, DriveValues::All(100.0));
    let end = frames(&motors).last().map(|f| f.totals.base_angle).expect("frames");
    assert!(end > 1e-7 && end < 1e-3, "{end}");
}

/// The forecast is a quadrature over the planned path; the run integrates all equations of motion.
#[test]
fn a_plan_foretells_how_its_base_turns() {
    for (name, com) in
        [("spot-swing", None), ("spot", None), ("case-1", Some([0.1, -0.2])), ("case-2", Some([0.0, 0.3]))]
    {
        let mut free = scenario(name);
        free.base.kind = BaseKind::Free;
        free.base.com = com.unwrap_or(free.base.com);
        if name == "spot" {
            free.task.kind = stillbase::session::scenario::TaskKind::MinimumNorm;
        }
        let run = Run::new(&free).expect("plans");
        let forecast = base_forecast(&run).expect("a free base");
        let end = *frames(&free).last().expect("frames");
        let close = |what: &str, got: f64, want: f64, tolerance: f64| {
            assert!((got - want).abs() < tolerance, "{name}: {what} {got} {want}");
        };
        close("end", forecast.angle_end, end.base.angle, 1e-7);
        close("peak", forecast.angle, end.totals.base_angle, 1e-6);
        close("shift", forecast.shift, end.totals.shift, 1e-5);
        let mut held = free.clone();
        held.base.wheel = Some(Wheel { inertia: 0.01, ..Wheel::default() });
        let end = *frames(&held).last().expect("frames");
        close(
            "momentum",
            forecast.wheel_momentum,
            0.01 * end.totals.wheel_rate,
            1e-5 * (1.0 + forecast.wheel_momentum),
        );
        close("torque", forecast.wheel_torque, end.totals.wheel_torque, 1e-4 * (1.0 + forecast.wheel_torque));
    }
    assert!(base_forecast(&Run::new(&scenario("case-1")).expect("plans")).is_none());
}
