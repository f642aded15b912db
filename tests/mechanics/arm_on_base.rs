//! Torques and reactions of arms on free bases, against energy and momentum summed over their bodies.

use proptest::prelude::*;
use stillbase::mechanics::arm_on_base::{ArmOnBase, FloatingBase};
use stillbase::mechanics::dynamics::ExternalLoads;
use stillbase::mechanics::machine::{Inertia, parse};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector, cross, unit};

/// A link of a serial arm: length, m, mass, kg, inertia, kg m², and centre of mass along and across it, m.
pub type Bar = [f64; 5];

/// Bars of random arms.
pub fn bar() -> impl Strategy<Value = Bar> {
    (0.1..1.0f64, 0.1..5.0f64, 0.001..0.5f64, -0.3..0.8f64, -0.2..0.2f64).prop_map(|(l, m, i, x, y)| [l, m, i, x, y])
}

/// The serial arm of some bars, each driven from the base.
pub fn arm(bars: &[Bar]) -> Inertia {
    let mut text = "name = \"serial\"\n".to_owned();
    for (k, [length, mass, inertia, com, normal]) in bars.iter().enumerate() {
        let attach = if k == 0 { "\"base\"".into() } else { format!("{{ link = \"{k}\", at = \"tip\" }}") };
        let k = k + 1;
        text += &format!(
            "[[drive]]\nname = \"{k}\"\n[[link]]\nname = \"{k}\"\ndrive = \"{k}\"\nattach = {attach}\nlength = {length}\n\
             mass = {mass}\ninertia = {inertia}\ncom = {com}\ncom_normal = {normal}\n"
        );
    }
    text += &format!("[end_effector]\nlink = \"{}\"\n", bars.len());
    Inertia::of(&parse(&text, "serial").expect("valid"))
}

/// Sums over base and links at zero linear momentum, in the axes of the base: kinetic energy, J, angular momentum about
/// the common centre of mass, kg m²/s, and the velocity of the centre of mass of the base, m/s.
fn by_bodies(bars: &[Bar], base: &FloatingBase, q: &[f64], qd: &[f64], turning: f64) -> (f64, f64, Vector) {
    let i = Vector::new(0.0, 1.0);
    let (mut root, mut root_rate) = (Vector::default(), Vector::default());
    let mut bodies = vec![(base.mass, base.inertia, base.com, i * base.com * turning, turning)];
    for ([length, mass, inertia, com, normal], (q, qd)) in bars.iter().zip(q.iter().zip(qd)) {
        let (e, rate) = (unit(*q), qd + turning);
        let centre = Vector::new(*com, *normal) * e;
        bodies.push((*mass, *inertia, root + centre, root_rate + i * centre * rate, rate));
        root += *length * e;
        root_rate += i * e * (length * rate);
    }
    let whole: f64 = bodies.iter().map(|b| b.0).sum();
    let centre = bodies.iter().map(|b| b.0 * b.2).sum::<Vector>() / whole;
    let drift = bodies.iter().map(|b| b.0 * b.3).sum::<Vector>() / whole;
    let (mut energy, mut momentum) = (0.0, 0.0);
    for (mass, inertia, place, velocity, rate) in &bodies {
        let velocity = *velocity - drift;
        energy += 0.5 * (mass * velocity.norm_sqr() + inertia * rate * rate);
        momentum += mass * cross(*place - centre, velocity) + inertia * rate;
    }
    (energy, momentum, bodies[0].3 - drift)
}

/// Central difference of fourth order.
fn slope(f: impl Fn(f64) -> f64, h: f64) -> f64 {
    (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Lagrange's equations of the kinetic energy, with θ̇ from the angular momentum, which is zero, or with θ̇ = 0.
    #[test]
    fn torques_and_reactions_are_those_of_the_bodies(
        bars in prop::collection::vec(bar(), 1..=7), mass in 0.5..50.0f64, inertia in 0.05..5.0f64,
        com in [-0.5..0.5f64, -0.5..0.5f64], floats in any::<bool>(),
        q in prop::collection::vec(-7.0..7.0f64, 7), qd in prop::collection::vec(-2.0..2.0f64, 7),
        qdd in prop::collection::vec(-3.0..3.0f64, 7),
    ) {
        let n = bars.len();
        let base = FloatingBase { mass, inertia, com: Vector::new(com[0], com[1]) };
        let (q, qd, qdd) = (&q[..n], &qd[..n], &qdd[..n]);
        let sums = |q: &[f64], qd: &[f64], turning: f64| by_bodies(&bars, &base, q, qd, turning);
        let turning = |q: &[f64], qd: &[f64]| {
            let [own, with] = [0.0, 1.0].map(|turning| sums(q, qd, turning).1);
            if floats { -own / (with - own) } else { 0.0 }
        };
        let energy = |q: &[f64], qd: &[f64]| sums(q, qd, turning(q, qd)).0;
        let moved = |x: &[f64], k: usize, by: f64| -> Vec<f64> {
            x.iter().enumerate().map(|(l, x)| if l == k { x + by } else { *x }).collect()
        };
        let at = |t: f64| -> (Vec<f64>, Vec<f64>) {
            (0..n).map(|k| (q[k] + t * (qd[k] + 0.5 * t * qdd[k]), qd[k] + t * qdd[k])).unzip()
        };
        let model = arm(&bars);
        let body = if floats { ArmOnBase::floating(model, &base) } else { ArmOnBase::held(model, &base) }.expect("few");
        let given = |x: &[f64]| PerDrive::from_slice(x).expect("few");
        let e = DriveAngles(given(q)).units();
        let (torque, wrench) = body.dynamics(&e, &given(qd), &given(qdd));
        let scale = 1.0 + torque.max_abs() + wrench.dynamic.force.norm();
        for k in 0..n {
            let impulse = |t: f64| {
                let (q, qd) = at(t);
                slope(|by| energy(&q, &moved(&qd, k, by)), 1e-2)
            };
            let want = slope(impulse, 2e-3) - slope(|by| energy(&moved(q, k, by), qd), 2e-3);
            prop_assert!((torque[k] - want).abs() < 1e-6 * scale, "drive {k}: {} and {want}", torque[k]);
        }
        // In space the velocities turn with the base.
        let turn = turning(q, qd);
        let rate = |t: f64| { let (q, qd) = at(t); turning(&q, &qd) };
        let spin = slope(rate, 2e-3);
        let velocity = |t: f64| {
            let (q, qd) = at(t);
            sums(&q, &qd, rate(t)).2 * unit(t * (turn + 0.5 * t * spin))
        };
        let force = mass * Vector::new(slope(|t| velocity(t).re, 2e-3), slope(|t| velocity(t).im, 2e-3));
        prop_assert!((wrench.dynamic.force - force).norm() < 1e-6 * scale, "{:?} and {force}", wrench.dynamic.force);
        // About its own centre of mass, the base feels the arm and a wheel that holds it.
        let wheel = slope(|t| { let (q, qd) = at(t); sums(&q, &qd, rate(t)).1 }, 2e-3);
        let moment = inertia * spin + cross(base.com, force) - wheel;
        prop_assert!((wrench.dynamic.moment - moment).abs() < 1e-6 * scale, "{} and {moment}", wrench.dynamic.moment);
        let moving = body.moving_torque(&e, &given(qd), &given(qdd));
        let (without, _) = body.dynamics(&e, &given(qd), &given(qdd));
        prop_assert!(moving == without && body.holding_torque(&e).max_abs() == 0.0);
    }

    /// A base that weighs without bound stands still.
    #[test]
    fn a_heavy_base_is_a_fixed_one(
        bars in prop::collection::vec(bar(), 1..=7), floats in any::<bool>(),
        x in prop::collection::vec([-7.0..7.0f64, -2.0..2.0f64, -3.0..3.0f64], 7),
    ) {
        let model = arm(&bars);
        let base = FloatingBase { mass: 1e12, inertia: 1e12, com: Vector::default() };
        let heavy =
            if floats { ArmOnBase::floating(model.clone(), &base) } else { ArmOnBase::held(model.clone(), &base) };
        let fixed = ArmOnBase::fixed(model, &ExternalLoads::default());
        let of = |i: usize| PerDrive::from_fn(bars.len(), |k| x[k][i]);
        let (e, qd, qdd) = (DriveAngles(of(0)).units(), of(1), of(2));
        let (torque, wrench) = heavy.expect("few").dynamics(&e, &qd, &qdd);
        let (want, reaction) = fixed.dynamics(&e, &qd, &qdd);
        let scale = 1.0 + want.max_abs() + reaction.dynamic.force.norm();
        prop_assert!(torque.minus(&want).max_abs() < 1e-8 * scale);
        prop_assert!((wrench.dynamic.force - reaction.dynamic.force).norm() < 1e-8 * scale);
        prop_assert!((wrench.dynamic.moment - reaction.dynamic.moment).abs() < 1e-3 * scale);
    }
}

#[test]
fn eight_drives_on_a_free_base_are_refused() {
    let base = FloatingBase { mass: 10.0, inertia: 1.0, com: Vector::default() };
    let why = ArmOnBase::floating(arm(&[[0.3, 1.0, 0.1, 0.1, 0.0]; 8]), &base).expect_err("too many").to_string();
    assert!(why.contains("8 drives") && why.contains("at most 7"), "{why}");
}
