//! Any machine of the family in motion: motors in joints, rotors behind gears, on every kind of base.

use stillbase::mechanics::arm_on_base::FloatingBase;
use stillbase::mechanics::balance::design;
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::Motion;
use stillbase::planning::curves::Path;
use stillbase::planning::off_plane::price::Price;
use stillbase::planning::timing::TimeLaw;
use stillbase::simulation::control::Control;
use stillbase::simulation::frame::Frame;
use stillbase::simulation::plant::{Base, BaseKind, DriveValues, Friction, PlantDifferences};
use stillbase::simulation::{Guide, Setup, Simulation};

use crate::support::random::{a_chain, a_machine};
use crate::support::{Noise, close, family_machine};

fn way(noise: &mut Noise, n: usize, far: f64) -> [DriveAngles; 2] {
    let from = PerDrive::from_fn(n, |_| noise.between(-3.0, 3.0));
    let to = PerDrive::from_fn(n, |k| from[k] + noise.between(-far, far));
    [from, to].map(DriveAngles)
}

fn run(model: &Machine, plant: &PlantDifferences, base: &Base, control: &Control, ways: [DriveAngles; 2]) -> Frame {
    const STEPS: u32 = 200;
    let path = Path::JointLine { from: ways[0], to: ways[1] };
    let guide = Guide::Motion {
        motion: Motion::new(path, TimeLaw::Quintic, 0.2).into(),
        start: 0.0,
        base_end: Default::default(),
    };
    let mut simulation = Simulation::new(&Setup { model, plant, base, control, step: 0.001 }, guide).expect("valid");
    for _ in 0..STEPS {
        simulation.advance();
    }
    simulation.frame()
}

/// What the motors bring, friction takes and the base feels accounts for all energy and momentum, with whatever motors,
/// rotors, friction and base: audits tell of any that is missing.
#[test]
fn energy_and_momentum_are_kept() {
    let mut in_joints = 0;
    for seed in 0..60 {
        let mut noise = Noise::of(900 + seed);
        let machine = a_machine(&mut noise);
        let n = machine.drives();
        let kinds = [BaseKind::Fixed, BaseKind::Free, BaseKind::Compliant];
        let kind = kinds[seed as usize % 3];
        if n == 8 && kind != BaseKind::Fixed {
            continue;
        }
        let base = Base { kind, com: [0.1, -0.05], ..Base::default() };
        let friction =
            Friction { viscous: DriveValues::All(0.05), coulomb: DriveValues::All(0.02), ..Friction::default() };
        let friction = if seed % 2 == 0 { friction } else { Friction::default() };
        let plant = PlantDifferences { friction, ..PlantDifferences::default() };
        let end = run(&machine, &plant, &base, &Control::default(), way(&mut noise, n, 0.3));
        assert!(end.first_violation().is_none(), "machine {seed}: {:?}", end.first_violation());
        in_joints += usize::from(machine.motors().in_joints());
    }
    assert!(in_joints > 15, "{in_joints}");
}

/// A balanced chain on a floating base turns it by −D_1 Δb/(I_b + μ|ρ|² + Σ(C_kk + J_k) + ΣJ_rotor), whatever gears and
/// motors do; where b is held it does not move.
#[test]
fn a_floating_base_turns_by_the_change_of_b() {
    let mut geared = 0;
    for seed in 0..40 {
        let mut noise = Noise::of(seed);
        let n = 1 + seed as usize % 6;
        let chain = a_chain(&mut noise, n);
        let machine = design(&chain, &vec![1.0; n]).expect("a chain can be balanced");
        let model = Inertia::of(&machine);
        let com = [noise.between(-0.2, 0.2), noise.between(-0.2, 0.2)];
        let (mass, inertia) = (noise.between(5.0, 50.0), noise.between(0.5, 5.0));
        let base = Base { kind: BaseKind::Free, mass, inertia, com, ..Base::default() };
        let ways = way(&mut noise, n, 0.8);
        let end = run(&machine, &PlantDifferences::default(), &base, &Control::default(), ways);
        let delta = model.lambda().dot(&ways[1].0.minus(&ways[0].0));
        let floating = FloatingBase { mass, inertia, com: Vector::new(com[0], com[1]) };
        let price = Price::of(&model, delta).expect("it is invariant");
        let want = price.base_turn(&model, &floating).expect("it is balanced");
        let size = (0..n).map(|k| (model.momentum(k) * (ways[1][k] - ways[0][k])).abs()).sum::<f64>() / inertia;
        close(&format!("{seed}"), &[end.base.angle, size], &[want, size], 1e-6);
        geared += usize::from(!model.is_decoupled());
        // The same way less what it changes of b: nothing moves the base.
        let sum: f64 = model.momenta().iter().map(|d| d * d).sum();
        let back = model.pose_inertia() * delta / sum;
        let to = DriveAngles(ways[1].0.plus(-back, &model.momenta()));
        let end = run(&machine, &PlantDifferences::default(), &base, &Control::default(), [ways[0], to]);
        assert!(end.base.angle.abs() < 1e-9 * size.max(1e-3), "{seed}: {:e}", end.base.angle);
        // One drive alone stays where it is then.
        assert!(end.peaks.is_reactionless() || n == 1, "{seed}: {:?}", end.peaks.moment);
    }
    assert!(geared > 25, "{geared}");
}

/// Encoders sit on the motors, and torque limits are theirs: with neither coarse nor low they change nothing.
#[test]
fn sampled_control_reads_the_motors() {
    let machine = family_machine("serial-3r-balanced");
    let mut noise = Noise::of(4);
    let ways = way(&mut noise, 3, 0.3);
    let (plant, base) = (PlantDifferences::default(), Base::default());
    let exact = run(&machine, &plant, &base, &Control::default(), ways);
    let sampled = Control { rate: 1000.0, encoder: 1e9, ..Control::default() };
    let read = run(&machine, &plant, &base, &sampled, ways);
    close("q", &read.q, &exact.q, 1e-3);
    // The torque of motor 1 is the moment on the base; with gears it is what they make of it that differs.
    let path = Path::JointLine { from: ways[0], to: ways[1] };
    let motion = Motion::new(path, TimeLaw::Quintic, 0.2);
    let low = machine.set("drive.3.torque_limit", "0.05").expect("in range");
    let limited = PlantDifferences { torque_limits: true, ..PlantDifferences::default() };
    let end = run(&low, &limited, &base, &Control::default(), ways);
    assert!((end.peaks.torque[2] - 0.05).abs() < 1e-12, "{:?}", end.peaks.torque);
    assert!(motion.duration() > 0.0 && exact.peaks.torque[2] > 0.05, "{:?}", exact.peaks.torque);
}
