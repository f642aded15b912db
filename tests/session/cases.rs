//! The paper's three cases, run as a recording runs them: peaks, ends, and a zero that is found and not assumed.

use std::sync::LazyLock;

use stillbase::mechanics::kinematics::{acceleration, end_effector, velocity};
use stillbase::mechanics::machine::{Inertia, builtin};
use stillbase::mechanics::planar::{PerDrive, Vector, cross};
use stillbase::planning::Motion;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Run, TimedEdit, replay};
use stillbase::simulation::frame::{Frame, Phase};

use crate::support::{angles, array, body_of, close, numbers, planning, three, xy};

/// A finished run and every frame of it.
struct Performed {
    scenario: Scenario,
    run: Run,
    frames: Vec<Frame>,
}

impl Performed {
    fn of(scenario: Scenario) -> Self {
        let mut frames = Vec::new();
        let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it can start");
        Self { scenario, run, frames }
    }

    fn last(&self) -> &Frame {
        self.frames.last().expect("the start at least")
    }

    fn motion(&self) -> &Motion {
        self.run.motion().expect("nobody leads it off")
    }

    fn inertia(&self) -> Inertia {
        Inertia::of(&self.scenario.machine)
    }

    fn peak(&self, f: impl Fn(&Frame) -> f64) -> f64 {
        self.frames.iter().map(|x| f(x).abs()).fold(0.0, f64::max)
    }
}

fn scenario(case: u8) -> Scenario {
    Scenario::builtin(&format!("case-{case}")).expect("built in")
}

fn on_table_1(case: u8) -> Scenario {
    let machine = builtin("nine-link-table-1").expect("built in").clone();
    Scenario { machine, ..scenario(case) }
}

static CASES: LazyLock<[Performed; 3]> = LazyLock::new(|| [1, 2, 3].map(|i| Performed::of(scenario(i))));
static TABLE_1: LazyLock<[Performed; 3]> = LazyLock::new(|| [1, 2, 3].map(|i| Performed::of(on_table_1(i))));

#[test]
fn frames_are_a_millisecond_apart_and_end_at_rest() {
    for case in CASES.iter() {
        assert_eq!(case.frames.len(), 1001);
        for (i, frame) in case.frames.iter().enumerate() {
            assert_eq!((frame.step, frame.time), (i as u64, i as f64 * 0.001));
        }
        assert_eq!(case.frames[500].phase, Phase::Motion);
        let last = case.last();
        assert_eq!(last.phase, Phase::Rest);
        assert!(last.qd.max_abs() < 1e-9 && last.qdd.max_abs() < 1e-7, "{}: {last:?}", case.scenario.name);
    }
}

/// `planning.json`, on the re-solved machine and on Table I as printed.
#[test]
fn peaks_and_ends_of_the_reference() {
    for (name, cases) in [("nine-link", &CASES), ("nine-link-table-1", &TABLE_1)] {
        let [first, _, third] = &**cases;
        assert_eq!(first.scenario.machine.name(), name);
        let want = &planning()["motion"][name];
        close("case 1 end q", &first.last().q, &numbers(&want["case_1_end_q"]), 1e-9);
        close("case 1 end b", &[first.last().b], &[want["case_1_end_b"].as_f64().expect("b")], 1e-9);
        let moment = want["case_1_peak_base_moment"].as_f64().expect("a moment");
        close("case 1 peak moment", &[first.peak(Frame::base_moment)], &[moment], 1e-5);
        assert_eq!(first.last().peaks.moment, first.peak(Frame::base_moment));
        // The peak lies between two frames; the reference sits on it, and knows nothing of Table I's couplings.
        let tolerance = if name == "nine-link" { 3e-6 } else { 1e-4 };
        close("case 3 peak torque", &third.last().peaks.torque, &numbers(&want["case_3_peak_torque"]), tolerance);
    }
}

/// τ_k = D_k Δq_k s̈, whose peak is 10/√3 D_k |Δq_k| / T².
#[test]
fn case_3_torque_is_one_line() {
    let case = &CASES[2];
    let (from, to) = (case.frames[0].q, case.motion().path.at(1.0).q);
    let d = case.inertia().diagonals();
    for frame in &case.frames {
        let s = case.motion().profile.at(frame.time);
        let want = PerDrive::from_fn(3, |k| d[k] * (to[k] - from[k]) * s.acceleration);
        let off = frame.torque.plus(-1.0, &want).max_abs();
        // Feedback turns the integrator's error of 1e-11 rad into torque.
        assert!(off < 1e-8, "at {} s: {off:e} N m", frame.time);
    }
    let peak = PerDrive::from_fn(3, |k| 10.0 / 3f64.sqrt() * d[k] * (to[k] - from[k]).abs());
    close("peak", &peak, &numbers(&planning()["motion"]["nine-link"]["case_3_peak_torque"]), 1e-9);
    // Ends of the motion as `physics` states them.
    close("q_A", &from, &[1.6875182179, 3.7146223682, 2.1801769897], 1e-9);
    close("q_B", &case.last().q, &[1.5074743692, 4.2177092073, 3.1287473760], 1e-9);
}

#[test]
fn case_1_keeps_to_its_line_with_least_rates() {
    let case = &CASES[0];
    let tip = case.scenario.machine.end_effector();
    let [a, b] = [Vector::new(0.50, 0.50), Vector::new(0.55, 0.90)];
    for frame in &case.frames {
        let s = case.motion().profile.at(frame.time).s;
        assert!((frame.end_effector - (a + s * (b - a))).norm() < 1e-10, "at {} s: {}", frame.time, frame.end_effector);
        // The null vector of J: rates along it move no end effector. Least rates have none of it.
        let e = frame.q.units();
        let c = |k: usize, l: usize| tip[k] * tip[l] * cross(e[k], e[l]);
        let null = PerDrive::from([c(1, 2), c(2, 0), c(0, 1)]);
        assert!(velocity(tip, &e, &null).norm() < 1e-15);
        let along = frame.qd.dot(&null) / null.dot(&null).sqrt();
        assert!(along.abs() < 1e-9, "at {} s: {along:e}", frame.time);
    }
    assert!(!case.last().peaks.is_reactionless());
}

#[test]
fn case_2_takes_the_end_effector_of_case_3_another_way() {
    let [_, second, third] = &*CASES;
    for (x, y) in second.frames.iter().zip(&third.frames) {
        assert!((x.end_effector - y.end_effector).norm() < 1e-10, "at {} s", x.time);
    }
    close("drive 1", &[second.last().q[0]], &[1.45], 1e-10);
    assert!((second.last().peaks.moment - 0.4853).abs() < 5e-5, "{}", second.last().peaks.moment);
    assert!((second.last().b - 2.3457).abs() < 5e-5, "{}", second.last().b);
    assert!(!second.last().peaks.is_reactionless());
}

/// Nine rigid bodies, driven by the plant's own q, q̇ and q̈: what the base of Case 3 feels is zero, and in the other
/// cases it is what the Frame says. The recursion is finite at change points, so no state is left out.
#[test]
fn nine_bodies_feel_what_the_frames_say() {
    for case in CASES.iter().chain(TABLE_1.iter()) {
        let body = body_of(&case.scenario.machine);
        let still = case.scenario.machine.name() == "nine-link";
        for frame in &case.frames {
            let (torque, [fx, fy, n]) = body.recursive(angles(&frame.q), three(&frame.qd), three(&frame.qdd));
            let total = frame.wrench.total();
            let at = format!("{} at {} s", case.scenario.name, frame.time);
            assert!((total.force - Vector::new(fx, fy)).norm() < 1e-9, "{at}: force");
            assert!((total.moment - n).abs() < 1e-9, "{at}: moment {} and {n}", total.moment);
            close(&at, &frame.torque, &torque, 1e-9);
            if still {
                assert!(fx.hypot(fy) < 1e-9, "{at}: force ({fx:e}, {fy:e})");
            }
            if still && case.scenario.name == "case-3" {
                assert!(n.abs() < 1e-9, "{at}: moment {n:e}");
            }
        }
    }
}

/// All 27 equations at once, pins included, wherever min |sin(q_k − q_l)| is above 0.02; nearer to a change point the
/// pin forces grow without bound and take the digits.
#[test]
fn pin_by_pin_the_base_feels_nothing() {
    let case = &CASES[2];
    let body = body_of(&case.scenario.machine);
    let away: Vec<_> = case.frames.iter().filter(|f| f.transmission > 0.02).collect();
    assert!(away.len() > 900, "{} frames", away.len());
    for frame in away.iter().step_by(7) {
        let answer = body.solve(angles(&frame.q), three(&frame.qd), three(&frame.qdd));
        let [fx, fy] = answer.base_force;
        assert!(fx.hypot(fy) < 1e-9 && answer.base_moment.abs() < 1e-9, "at {} s: {answer:?}", frame.time);
        assert!(frame.com.norm() < 1e-15 && answer.com[0].hypot(answer.com[1]) < 1e-14);
    }
}

#[test]
fn case_3_is_reactionless_and_its_b_stands() {
    let case = &CASES[2];
    assert!(case.last().peaks.is_reactionless());
    for frame in &case.frames {
        assert!((frame.b - 2.4).abs() < 1e-12, "at {} s: b = {}", frame.time, frame.b);
        assert!((frame.b_reference - 2.4).abs() < 1e-12);
        assert!(frame.is_base_unloaded() && frame.angular_momentum.abs() < 1e-12);
    }
    // The links alone pull hard; they cancel each other.
    assert!(case.last().peaks.inertial_pull > 5.0 && case.last().peaks.force < 1e-12);
}

/// Table I is rounded: about 10⁻³ N and 7·10⁻⁵ N m remain, which is small and not zero.
#[test]
fn table_1_as_printed_is_nearly_reactionless_and_not_called_so() {
    let peaks = TABLE_1[2].last().peaks;
    assert!(!peaks.is_reactionless());
    assert!(peaks.force > 3e-4 && peaks.force < 3e-3, "{}", peaks.force);
    assert!(peaks.moment > 2e-5 && peaks.moment < 2e-4, "{}", peaks.moment);
}

/// A scenario in which b is slid there and back while the machine is on its way and afterwards.
fn slid() -> Scenario {
    let at = |step, b| TimedEdit { step, edit: Edit::SlideB { b } };
    Scenario { edits: vec![at(200, 2.45), at(1100, 2.38)], duration: Some(2.5), ..scenario(3) }
}

/// n_B = −D_1 b̈ in any motion, and it is never more than the bound on b̈ makes it.
#[test]
fn moment_is_minus_d1_times_the_acceleration_of_b() {
    let slid = Performed::of(slid());
    let d1 = slid.inertia().diagonal(0);
    for case in CASES.iter().chain([&slid]) {
        let lambda = case.inertia().lambda();
        for f in &case.frames {
            assert!((f.base_moment() + d1 * lambda.dot(&f.qdd)).abs() < 1e-9, "{} at {} s", case.scenario.name, f.time);
        }
    }
    // b itself, by differences of fourth order, where nothing switches.
    let h = 0.001;
    for case in CASES.iter() {
        for w in case.frames.windows(5) {
            let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|i| w[i].b);
            let acceleration = (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / (12.0 * h * h);
            let want = -d1 * acceleration;
            assert!((w[2].base_moment() - want).abs() < 2e-8, "{} at {} s", case.scenario.name, w[2].time);
        }
    }
    let peak = slid.last().peaks.moment;
    assert!(peak > 0.5 * d1 * slid.scenario.pose_acceleration, "sliding has its price: {peak}");
    // The reference keeps the bound; the machine follows it exactly.
    assert!(peak <= d1 * slid.scenario.pose_acceleration * (1.0 + 1e-6), "{peak}");
    assert!(!slid.last().peaks.is_reactionless());
    assert!((slid.last().b - 2.38).abs() < 1e-9, "{}", slid.last().b);
}

/// Kinetic and potential energy gained are the motors' work, on every machine and with gravity.
#[test]
fn energy_balances() {
    let mut falling = on_table_1(1);
    falling.machine = falling.machine.set_all([("gravity", "1,-9.81"), ("payload.mass", "0.4")]).expect("valid");
    falling.task.b = 2.6;
    let mut wrong = scenario(3);
    wrong.plant.payload.mass = 0.3;
    let others = [Performed::of(falling), Performed::of(wrong), Performed::of(slid())];
    for case in CASES.iter().chain(&others) {
        assert!(case.peak(|f| f.kinetic) > 0.02);
        let off = case.peak(|f| f.audit.energy);
        assert!(off < 1e-8, "{}: {off:e} J", case.scenario.name);
    }
}

/// p = 0 and L = 0 throughout Case 3; in the others L is what n_B has taken away.
#[test]
fn angular_momentum_is_what_the_base_has_given() {
    for case in CASES.iter() {
        // Simpson's rule over pairs of steps.
        let mut impulse = 0.0;
        for w in case.frames.windows(3).step_by(2) {
            let [a, b, c] = [0, 1, 2].map(|i| w[i].base_moment());
            impulse -= 0.002 / 6.0 * (a + 4.0 * b + c);
            let off = w[2].angular_momentum - impulse;
            assert!(off.abs() < 1e-8, "{} at {} s: {off:e}", case.scenario.name, w[2].time);
            assert!(w[2].momentum.norm() < 1e-12);
        }
    }
}

#[test]
fn peaks_fall_with_the_square_of_the_time() {
    for (i, quick) in CASES.iter().enumerate() {
        let mut slow = scenario(i as u8 + 1);
        slow.task.time = 2.0;
        let slow = Performed::of(slow);
        let quarter = quick.last().peaks.torque.map_by(|t| t / 4.0);
        close("torque", &slow.last().peaks.torque, &quarter, 1e-5);
        if i < 2 {
            close("moment", &[slow.last().peaks.moment], &[quick.last().peaks.moment / 4.0], 1e-5);
        }
    }
}

trait MapBy {
    fn map_by(&self, f: impl Fn(f64) -> f64) -> Self;
}

impl MapBy for PerDrive {
    fn map_by(&self, f: impl Fn(f64) -> f64) -> Self {
        Self::from_fn(self.len(), |k| f(self[k]))
    }
}

/// A balanced machine needs no torque against gravity, and its base feels the weight and no moment.
#[test]
fn gravity_known_to_control_changes_no_torque() {
    for (i, free) in CASES.iter().enumerate() {
        let mut heavy = scenario(i as u8 + 1);
        heavy.machine = heavy.machine.set("gravity", "2.5,-9.81").expect("valid");
        let heavy = Performed::of(heavy);
        for (x, y) in free.frames.iter().zip(&heavy.frames) {
            close("torque", &y.torque, &x.torque, 1e-11);
            close("weight", &xy(y.wrench.static_part.force), &[16.05 * 2.5, -16.05 * 9.81], 1e-14);
            assert!(y.wrench.static_part.moment.abs() < 1e-12);
            // What counts as reaction is what motion makes.
            assert!((y.wrench.dynamic.moment - x.wrench.dynamic.moment).abs() < 1e-10);
        }
        assert_eq!(heavy.last().peaks.is_reactionless(), i == 2);
    }
}

/// Case 3 with a payload m in the plant that control does not know of, to first order in m.
///
/// With E = Σ D_k e_k the errors of the balanced model obey Ë + K_d Ė + K_p E = d/dt L, L = m p × ṗ of the planned
/// motion, and n_B = −d/dt(D q̇ + L) = −(K_d Ė + K_p E); f_B = −m p̈.
struct FirstOrder {
    /// n_B / m at every step.
    moment: Vec<f64>,
    /// f_B / m at every step.
    force: Vec<Vector>,
}

impl FirstOrder {
    fn of(case: &Performed) -> Self {
        let tip = case.scenario.machine.end_effector();
        let control = case.scenario.control;
        let (kp, kd) = (control.kp.of(1)[0], control.kd.of(1)[0]);
        let planned = |t: f64| {
            let r = case.motion().at(t);
            let e = r.q.units();
            (end_effector(tip, &e), acceleration(tip, &e, &r.qd, &r.qdd))
        };
        let rate = |t: f64| {
            let (p, a) = planned(t);
            cross(p, a)
        };
        let slope = |t: f64, [x, v]: [f64; 2]| [v, rate(t) - kd * v - kp * x];
        let h = case.scenario.step;
        let step = |[x, v]: [f64; 2], h: f64, [dx, dv]: [f64; 2]| [x + h * dx, v + h * dv];
        let mut state = [0.0; 2];
        let (mut moment, mut force) = (Vec::new(), Vec::new());
        for i in 0..case.frames.len() {
            let t = i as f64 * h;
            moment.push(-(kd * state[1] + kp * state[0]));
            force.push(-planned(t).1);
            let k1 = slope(t, state);
            let k2 = slope(t + h / 2.0, step(state, h / 2.0, k1));
            let k3 = slope(t + h / 2.0, step(state, h / 2.0, k2));
            let k4 = slope(t + h, step(state, h, k3));
            state = [0, 1].map(|j| state[j] + h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]));
        }
        Self { moment, force }
    }
}

#[test]
fn a_payload_unknown_to_control_reacts_by_its_size() {
    let first = FirstOrder::of(&CASES[2]);
    // What the first order leaves, for falling payloads.
    let left = [0.2, 0.1, 0.05].map(|mass| {
        let mut loaded = scenario(3);
        loaded.plant.payload.mass = mass;
        let loaded = Performed::of(loaded);
        assert!(!loaded.last().peaks.is_reactionless());
        let (mut moment, mut force) = (0.0_f64, 0.0_f64);
        for (i, f) in loaded.frames.iter().enumerate() {
            moment = moment.max((f.base_moment() - mass * first.moment[i]).abs());
            force = force.max((f.wrench.total().force - mass * first.force[i]).norm());
        }
        let peak = first.moment.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(moment < 0.6 * mass * mass * peak / 0.2, "{moment} of {}", mass * peak);
        [moment, force]
    });
    for i in 0..2 {
        // Second order: half the payload leaves a quarter.
        for ratio in [left[0][i] / left[1][i], left[1][i] / left[2][i]] {
            assert!((ratio - 4.0).abs() < 0.4, "{ratio} in {left:?}");
        }
    }
}

/// The wrench that two masses give, from the payload's own constants: nothing of the machine is left in it.
#[test]
fn a_known_payload_reacts_as_its_own_momentum() {
    let mut loaded = scenario(1);
    loaded.machine = loaded.machine.set("payload.mass", "0.4").expect("valid");
    // With its payload the machine reaches A and B on other planes.
    loaded.task.b = 2.6;
    let loaded = Performed::of(loaded);
    let tip = loaded.scenario.machine.end_effector();
    let (bare, lambda) = (Inertia::of(builtin("nine-link").expect("built in")), &CASES[0].inertia().lambda());
    for f in &loaded.frames {
        let a = acceleration(tip, &f.q.units(), &f.qd, &f.qdd);
        close("force", &xy(f.wrench.dynamic.force), &xy(-0.4 * a), 1e-11);
        let want = -bare.diagonal(0) * lambda.dot(&f.qdd) - 0.4 * cross(f.end_effector, a);
        close("moment", &[f.wrench.dynamic.moment], &[want], 1e-11);
    }
}

/// q_A and q_B of Case 3 are those of the reference's plane inverse.
#[test]
fn ends_are_the_reference_poses() {
    let file = planning();
    let poses: Vec<(String, [f64; 2], [f64; 5])> = file["plane_ik"]
        .as_array()
        .expect("poses")
        .iter()
        .filter(|p| p["b"].as_f64() == Some(2.4) && numbers(&p["solutions_q1_q2_q3_a1_a2"]).len() == 5)
        .filter(|p| array::<4>(&p["limits_a1_a2"])[1] < 3.2)
        .map(|p| {
            let name = p["machine"].as_str().expect("a name").into();
            (name, array(&p["point"]), array(&p["solutions_q1_q2_q3_a1_a2"]))
        })
        .collect();
    let mut compared = 0;
    for cases in [&CASES, &TABLE_1] {
        let case = &cases[2];
        for (frame, point) in [(&case.frames[0], [0.50, 0.50]), (case.last(), [0.55, 0.90])] {
            for (_, _, want) in poses.iter().filter(|(n, p, _)| n == case.scenario.machine.name() && *p == point) {
                close("q", &frame.q, &want[..3], 1e-9);
                close("a", &frame.a, &want[3..], 1e-9);
                close("reference", &frame.q_reference, &want[..3], 1e-9);
                compared += 1;
            }
        }
    }
    assert!(compared >= 2, "{compared} poses");
}
