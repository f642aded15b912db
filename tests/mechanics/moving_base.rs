//! Blocks on a base that moves: against point masses in space, and against the laws.

use nalgebra::{Matrix3, Matrix6, UnitQuaternion, Vector3, Vector6};
use stillbase::mechanics::assembly::{
    Assembly, Attitude, BaseState, BlockState, Compliance, MAX_BLOCKS, Momentum, MovingBase, SpatialBase,
};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};

use super::assembly::{Piece, after, pieces, random_states};
use crate::support::Noise;
use crate::support::random::an_assembly;

fn any(noise: &mut Noise, most: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| noise.between(-most, most))
}

fn a_base(noise: &mut Noise) -> SpatialBase {
    let root = Matrix3::from_fn(|_, _| noise.between(-1.0, 1.0));
    let inertia = root * root.transpose() + Matrix3::identity();
    SpatialBase { mass: noise.between(1.0, 30.0), com: any(noise, 0.4), inertia }
}

fn a_motion(noise: &mut Noise) -> MovingBase {
    MovingBase {
        velocity: any(noise, 2.0),
        rate: any(noise, 2.0),
        acceleration: any(noise, 5.0),
        angular_acceleration: any(noise, 5.0),
    }
}

/// Torques that turn each drive against the base, as the motors of joints act on two.
fn against_base(assembly: &Assembly, torques: &[PerDrive]) -> Vec<Vec<f64>> {
    let of = |(block, torque): (&stillbase::mechanics::assembly::Block, &PerDrive)| {
        let on = |l: usize| block.machine.motors().on(l);
        let back = |k: usize| (0..torque.len()).filter(|l| on(*l) == Some(k)).map(|l| torque[l]).sum::<f64>();
        (0..torque.len()).map(|k| torque[k] - back(k)).collect()
    };
    assembly.blocks().iter().zip(torques).map(of).collect()
}

/// The power of all motors, W.
fn power(assembly: &Assembly, states: &[BlockState], torques: &[PerDrive]) -> f64 {
    let all = against_base(assembly, torques);
    all.iter()
        .zip(states)
        .map(|(torque, state)| torque.iter().zip(state.qd.iter()).map(|(t, w)| t * w).sum::<f64>())
        .sum()
}

fn torques_on(base: &MovingBase, gravity: &Vector3<f64>, assembly: &Assembly, states: &[BlockState]) -> Vec<PerDrive> {
    let mut torques = vec![PerDrive::zeros(0); assembly.blocks().len()];
    assembly.loads_on(base, gravity, states, |i, loads| torques[i] = loads.torque);
    torques
}

#[track_caller]
fn near(what: &str, got: &Vector3<f64>, want: &Vector3<f64>, scale: f64) {
    assert!((got - want).norm() <= scale, "{what}: {got:?} {want:?} ({scale:e})");
}

/// How a base is turned some time later, whose rate changes evenly: exact in all even orders that count here.
fn turn(base: &MovingBase, t: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(t * base.rate + 0.5 * t * t * base.angular_acceleration)
}

/// Loads are what accelerates point masses in space; torques are its power in the motion of one drive.
#[test]
fn loads_on_a_moving_base_are_those_of_points() {
    let mut noise = Noise::of(411);
    let mut rotors = 0;
    for round in 0..40 {
        let (assembly, base) = (an_assembly(&mut noise), a_motion(&mut noise));
        let (states, gravity) = (random_states(&mut noise, &assembly), any(&mut noise, 9.0));
        let h = 1e-3;
        let times = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|n| n * h);
        let at = times.map(|t| pieces(&assembly, &after(&states, t)));
        let turns = times.map(|t| turn(&base, t));
        let way = |t: f64| t * base.velocity + 0.5 * t * t * base.acceleration;
        let second = |x: [Vector3<f64>; 5]| (16.0 * (x[1] + x[3]) - x[0] - x[4] - 30.0 * x[2]) / (12.0 * h * h);
        let first = |x: [f64; 5]| (x[0] - x[4] + 8.0 * (x[3] - x[1])) / (12.0 * h);
        // What accelerates every piece: a force or a moment.
        let pulls: Vec<Vector3<f64>> = (0..at[2].len())
            .map(|p| match &at[2][p] {
                Piece::Mass(mass, _) => {
                    let place = std::array::from_fn(|i| {
                        let Piece::Mass(_, seen) = &at[i][p] else { unreachable!("a mass") };
                        turns[i] * seen + way(times[i])
                    });
                    *mass * second(place)
                }
                Piece::Rotor(inertia, axis, _) => {
                    rotors += 1;
                    let angle = std::array::from_fn(|i| {
                        let Piece::Rotor(.., angle) = &at[i][p] else { unreachable!("a rotor") };
                        *angle
                    });
                    let turned: f64 =
                        (16.0 * (angle[1] + angle[3]) - angle[0] - angle[4] - 30.0 * angle[2]) / (12.0 * h * h);
                    let spin = *inertia * (axis.dot(&base.rate) + first(angle));
                    spin * base.rate.cross(axis) + *inertia * *axis * (axis.dot(&base.angular_acceleration) + turned)
                }
            })
            .collect();
        let (mut force, mut moment, mut weight) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
        let mut scale = 1.0;
        for (piece, pull) in at[2].iter().zip(&pulls) {
            match piece {
                Piece::Mass(mass, seen) => {
                    force -= pull;
                    moment -= seen.cross(pull);
                    weight += seen.cross(&(*mass * gravity));
                }
                Piece::Rotor(..) => moment -= pull,
            }
            scale += pull.norm();
        }
        let mut torques = vec![PerDrive::zeros(0); states.len()];
        let mut sum = Vector3::zeros();
        let loads = assembly.loads_on(&base, &gravity, &states, |i, loads| {
            torques[i] = loads.torque;
            sum += loads.on_base.total().moment;
        });
        near(&format!("{round}: force"), &loads.motion.force, &force, 3e-8 * scale);
        near(&format!("{round}: moment"), &loads.motion.moment, &moment, 3e-8 * scale);
        near(&format!("{round}: weight"), &loads.weight.moment, &weight, 1e-11 * (scale + weight.norm()));
        near(&format!("{round}: blocks"), &sum, &loads.total().moment, 1e-11 * (scale + weight.norm()));
        let torques = against_base(&assembly, &torques);
        for (i, torques) in torques.iter().enumerate() {
            for (k, got) in torques.iter().enumerate() {
                let moved = [-1e-5, 1e-5].map(|by| {
                    let mut other = states.clone();
                    other[i].q.0[k] += by;
                    pieces(&assembly, &other)
                });
                let mut want = 0.0;
                for ((a, b), pull) in moved[0].iter().zip(&moved[1]).zip(&pulls) {
                    want += match (a, b) {
                        (Piece::Mass(m, a), Piece::Mass(_, b)) => ((b - a) / 2e-5).dot(&(pull - *m * gravity)),
                        (Piece::Rotor(_, axis, a), Piece::Rotor(_, _, b)) => (b - a) / 2e-5 * axis.dot(pull),
                        _ => unreachable!("the same pieces"),
                    };
                }
                assert!(
                    (got - want).abs() <= 1e-7 * (scale + weight.norm()),
                    "{round}: {i} {k}: {got} {want} ({scale})"
                );
            }
        }
    }
    assert!(rotors > 20, "{rotors}");
}

/// A base at rest feels what it feels anyway, and motors too.
#[test]
fn a_base_at_rest_is_one_that_moves_by_nothing() {
    let mut noise = Noise::of(412);
    for _ in 0..20 {
        let assembly = an_assembly(&mut noise);
        let states = random_states(&mut noise, &assembly);
        let mut torques = Vec::new();
        let want = assembly.loads(&states, |i, loads| torques.push((i, loads.torque)));
        let mut others = Vec::new();
        let got = assembly
            .loads_on(&MovingBase::default(), &assembly.gravity, &states, |i, loads| others.push((i, loads.torque)));
        near("moment", &got.total().moment, &want.total().moment, 1e-12 * (1.0 + want.total().moment.norm()));
        near("force", &got.total().force, &want.total().force, 1e-12 * (1.0 + want.total().force.norm()));
        for ((i, a), (j, b)) in torques.iter().zip(&others) {
            assert!(i == j && a.minus(b).max_abs() <= 1e-12 * (1.0 + a.max_abs()), "{a:?} {b:?}");
        }
    }
}

/// What a rigid body needs to move so about its origin: force, and moment.
fn needed(base: &SpatialBase, moving: &MovingBase) -> [Vector3<f64>; 2] {
    let MovingBase { rate, acceleration, angular_acceleration, .. } = moving;
    let force = base.mass * (acceleration + angular_acceleration.cross(&base.com) + rate.cross(&rate.cross(&base.com)));
    let about_com = base.inertia * angular_acceleration + rate.cross(&(base.inertia * rate));
    [force, about_com + base.com.cross(&force)]
}

/// A base that floats is moved by its blocks alone, keeps its momenta, and turns as [`Assembly::base_motion`] says.
#[test]
fn a_floating_base_moves_by_what_its_blocks_put_on_it() {
    let mut noise = Noise::of(413);
    for _ in 0..40 {
        let (assembly, base) = (an_assembly(&mut noise), a_base(&mut noise));
        let states = random_states(&mut noise, &assembly);
        let kept = Momentum { linear: any(&mut noise, 30.0), angular: any(&mut noise, 8.0) };
        let moving = assembly.floating_motion(&base, &states, &kept);
        let loads = assembly.loads_on(&moving, &Vector3::zeros(), &states, |_, _| {}).total();
        let [force, moment] = needed(&base, &moving);
        let scale = 1.0 + force.norm() + moment.norm() + loads.moment.norm();
        near("force", &loads.force, &force, 1e-10 * scale);
        near("moment", &loads.moment, &moment, 1e-10 * scale);
        let found = assembly.momentum_in_space(&base, &moving, &states);
        near("p", &found.linear, &kept.linear, 1e-10 * scale);
        near("L", &found.angular, &kept.angular, 1e-10 * scale);
        near("ω", &moving.rate, &assembly.base_motion(&base, &states, &kept.angular).rate, 1e-11 * scale);
        // A little later the momenta have turned in axes of the base.
        let h = 1e-4;
        let [before, behind] = [-h, h].map(|t| {
            let back = turn(&moving, t).inverse();
            let seen = Momentum { linear: back * kept.linear, angular: back * kept.angular };
            (assembly.floating_motion(&base, &after(&states, t), &seen), back.inverse())
        });
        let rate = (behind.0.rate - before.0.rate) / (2.0 * h);
        near("α", &moving.angular_acceleration, &rate, 1e-5 * (1.0 + rate.norm()));
        let pull = (behind.1 * behind.0.velocity - before.1 * before.0.velocity) / (2.0 * h);
        near("A", &moving.acceleration, &pull, 1e-5 * (1.0 + pull.norm()));
        // No torque but those of the motors changes the energy.
        let energy = |(moving, _): &(MovingBase, UnitQuaternion<f64>), t: f64| {
            assembly.kinetic_energy(&base, moving, &after(&states, t))
        };
        let change = (energy(&behind, h) - energy(&before, -h)) / (2.0 * h);
        let motors = power(&assembly, &states, &torques_on(&moving, &Vector3::zeros(), &assembly, &states));
        assert!((change - motors).abs() <= 1e-5 * (scale + motors.abs()), "{change} {motors}");
    }
}

/// A symmetric matrix without negative eigenvalues.
fn a_matrix(noise: &mut Noise, scale: f64) -> Matrix6<f64> {
    let root = Matrix6::from_fn(|_, _| noise.between(-1.0, 1.0));
    scale * (root * root.transpose())
}

fn a_state(noise: &mut Noise) -> BaseState {
    BaseState {
        place: any(noise, 0.3),
        attitude: Attitude(UnitQuaternion::from_scaled_axis(any(noise, 1.5))),
        velocity: any(noise, 1.0),
        rate: any(noise, 1.0),
    }
}

fn padded(states: &[BlockState]) -> [BlockState; MAX_BLOCKS] {
    let none = PerDrive::zeros(0);
    let mut all = [BlockState { q: DriveAngles(none), qd: none, qdd: none }; MAX_BLOCKS];
    all[..states.len()].copy_from_slice(states);
    all
}

/// The work of motors and dampers is all that changes the energy of base, blocks and springs, however far it turns.
#[test]
fn a_compliant_base_balances_its_energy() {
    let mut noise = Noise::of(414);
    for round in 0..40 {
        let (assembly, base) = (an_assembly(&mut noise), a_base(&mut noise));
        let states = random_states(&mut noise, &assembly);
        let [stiffness, damping] = [300.0, 10.0].map(|scale| a_matrix(&mut noise, scale));
        let mut held = Compliance::new(&stiffness, &damping).expect("springs");
        held.preload = Vector6::from_fn(|_, _| noise.between(-50.0, 50.0));
        let at = a_state(&mut noise);
        let h = 1e-4;
        let energy = |t: f64| {
            let state = assembly.compliant_after(&base, &held, &at, t, |part| padded(&after(&states, part * t)));
            let now = after(&states, t);
            let masses = pieces(&assembly, &now);
            let weighed = masses.iter().fold(base.mass * base.com, |sum, piece| match piece {
                Piece::Mass(mass, seen) => sum + *mass * seen,
                Piece::Rotor(..) => sum,
            });
            let mass = base.mass + assembly.mass();
            let height = assembly.gravity.dot(&(mass * state.place + state.attitude.0 * weighed));
            assembly.kinetic_energy(&base, &state.moving(), &now) + held.energy(&state) - height
        };
        let change = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
        let moving = assembly.compliant_motion(&base, &held, &at, &states);
        let gravity = at.attitude.0.inverse() * assembly.gravity;
        let motors = power(&assembly, &states, &torques_on(&moving, &gravity, &assembly, &states));
        let lost = held.dissipation(&at);
        assert!(lost > 0.0);
        let scale = 1.0 + motors.abs() + lost + held.energy(&at).abs();
        assert!((change - motors + lost).abs() <= 1e-7 * scale, "{round}: {change} {motors} {lost}");
        // Springs and dampers, weight and blocks together are what the base itself needs.
        let loads = assembly.loads_on(&moving, &gravity, &states, |_, _| {}).total();
        let (mount, back) = (held.wrench(&at), at.attitude.0.inverse());
        let [force, moment] = needed(&base, &moving);
        let weight = base.mass * gravity;
        let scale = 1.0 + force.norm() + moment.norm() + loads.moment.norm() + mount.moment.norm();
        near("force", &(loads.force + back * mount.force + weight), &force, 1e-10 * scale);
        near("moment", &(loads.moment + back * mount.moment + base.com.cross(&weight)), &moment, 1e-10 * scale);
    }
}

/// Blocks that swing about a pose.
fn swinging(states: &[BlockState], t: f64) -> [BlockState; MAX_BLOCKS] {
    let swing = |state: &BlockState| {
        let (sin, cos) = (3.0 * t).sin_cos();
        let by = |factor: f64| state.qd.scaled(factor);
        BlockState { q: DriveAngles(state.q.0.plus((1.0 - cos) / 3.0, &state.qd)), qd: by(sin), qdd: by(3.0 * cos) }
    };
    padded(&states.iter().map(swing).collect::<Vec<_>>())
}

fn run(
    assembly: &Assembly,
    (base, held): (&SpatialBase, &Compliance),
    states: &[BlockState],
    (time, steps): (f64, usize),
) -> BaseState {
    let h = time / steps as f64;
    (0..steps).fold(BaseState::at_rest(), |at, i| {
        assembly.compliant_after(base, held, &at, h, |part| swinging(states, (i as f64 + part) * h))
    })
}

/// How far apart two states are.
fn apart(a: &BaseState, b: &BaseState) -> f64 {
    a.attitude.0.angle_to(&b.attitude.0)
        + (a.place - b.place).norm()
        + (a.velocity - b.velocity).norm()
        + (a.rate - b.rate).norm()
}

#[test]
fn a_step_on_springs_is_of_fourth_order() {
    let mut noise = Noise::of(415);
    for _ in 0..6 {
        let (assembly, base) = (an_assembly(&mut noise), a_base(&mut noise));
        let states = random_states(&mut noise, &assembly);
        let held = Compliance::new(&a_matrix(&mut noise, 200.0), &a_matrix(&mut noise, 5.0)).expect("springs");
        let fine = run(&assembly, (&base, &held), &states, (0.4, 800));
        let errors = [25, 50].map(|steps| apart(&run(&assembly, (&base, &held), &states, (0.4, steps)), &fine));
        assert!((10.0..24.0).contains(&(errors[0] / errors[1])), "{errors:?}");
    }
}

/// Without springs a base floats; on stiff ones it holds still, and the ground feels what a fixed base does.
#[test]
fn springs_from_none_to_stiff_lead_from_a_free_base_to_a_fixed_one() {
    let mut noise = Noise::of(416);
    for _ in 0..6 {
        let (mut assembly, base) = (an_assembly(&mut noise), a_base(&mut noise));
        let states = random_states(&mut noise, &assembly);
        let stiff = {
            let mut held = Compliance::diagonal([1e9; 6], [3e5; 6]).expect("springs");
            held.preload = assembly.preload(&base, &swinging(&states, 0.0));
            held
        };
        let fastest = assembly.fastest(&base, &stiff, &states);
        let steps = (0.3 * fastest / 1.5).ceil() as usize;
        let end = run(&assembly, (&base, &stiff), &states, (0.3, steps));
        let loads = assembly.loads(&swinging(&states, 0.3), |_, _| {}).total();
        let (mount, weight) = (stiff.wrench(&end), base.mass * assembly.gravity);
        let scale = 1.0 + loads.force.norm() + loads.moment.norm() + weight.norm();
        near("held force", &-mount.force, &(loads.force + weight), 1e-3 * scale);
        near("held moment", &-mount.moment, &(loads.moment + base.com.cross(&weight)), 1e-3 * scale);
        assert!(end.place.norm() < 1e-5 && end.attitude.0.angle() < 1e-5, "{end:?}");
        // Free of springs and gravity.
        assembly.set_gravity([0.0; 3]).expect("none");
        let free = Compliance::diagonal([0.0; 6], [0.0; 6]).expect("none");
        let (time, steps) = (0.8, 400);
        let end = run(&assembly, (&base, &free), &states, (time, steps));
        let h = time / steps as f64;
        // At rest at the start, so that both momenta are zero.
        let still = Momentum::default();
        let moving = |t: f64| assembly.floating_motion(&base, &swinging(&states, t), &still);
        let (mut attitude, first) =
            (Attitude::level(), assembly.base_motion(&base, &swinging(&states, 0.0), &still.angular));
        for i in 0..steps {
            attitude = attitude.after(h, |part, _| moving((i as f64 + part) * h).rate);
        }
        let last = assembly.base_motion(&base, &swinging(&states, time), &still.angular);
        assert!(attitude.0.angle_to(&end.attitude.0) < 1e-7, "{attitude:?} {end:?}");
        near("place", &end.place, &(first.com - attitude.0 * last.com), 1e-7);
        near("velocity", &end.velocity, &(attitude.0 * moving(time).velocity), 1e-6);
        near("rate", &end.rate, &last.rate, 1e-6);
    }
}

/// The bound on rates is that of a mass on springs, and a step below it is stable, above it not.
#[test]
fn the_fastest_rate_bounds_the_step() {
    let mut noise = Noise::of(417);
    let assembly = an_assembly(&mut noise);
    let mut states = random_states(&mut noise, &assembly);
    states.iter_mut().for_each(|state| (state.qd, state.qdd) = (state.qd.scaled(0.0), state.qdd.scaled(0.0)));
    let base = a_base(&mut noise);
    let held = Compliance::new(&a_matrix(&mut noise, 1e6), &Matrix6::zeros()).expect("springs");
    let fastest = assembly.fastest(&base, &held, &states);
    let peak = |factor: f64| {
        let (h, mut at) = (factor / fastest, BaseState::at_rest());
        at.place = Vector3::new(1e-5, -2e-5, 1e-5);
        at.rate = Vector3::new(1e-3, 0.0, 2e-3);
        let mut most = 0.0_f64;
        for _ in 0..400 {
            at = assembly.compliant_after(&base, &held, &at, h, |_| padded(&states));
            most = most.max(at.place.norm());
        }
        most
    };
    assert!(peak(2.6) < 1e-2, "{}", peak(2.6));
    assert!(peak(3.2) > 1.0 || peak(3.2).is_nan(), "{}", peak(3.2));
}

#[test]
fn what_is_no_stiffness_is_refused() {
    let said = |at: &[(usize, usize, f64)]| {
        let mut of = Matrix6::identity();
        at.iter().for_each(|(i, j, x)| of[(*i, *j)] = *x);
        [(of, Matrix6::identity()), (Matrix6::identity(), of)]
            .map(|(stiffness, damping)| Compliance::new(&stiffness, &damping).expect_err("refused").to_string())
    };
    let [stiffness, damping] = said(&[(2, 2, f64::NAN)]);
    assert_eq!(stiffness, "stiffness holds not a number: want finite numbers");
    assert_eq!(damping, "damping holds not a number: want finite numbers");
    let [stiffness, _] = said(&[(3, 1, 0.5)]);
    let want = "stiffness has 0.5 in row 4, column 2, but 0 the other way round: want a symmetric matrix";
    assert_eq!(stiffness, want);
    let [stiffness, _] = said(&[(4, 4, -2.0)]);
    assert_eq!(stiffness, "stiffness has the eigenvalue -2: want none below 0");
}
