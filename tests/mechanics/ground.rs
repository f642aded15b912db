//! Links that keep their orientation, on single machines.

use nalgebra::{Matrix3, Vector3};
use stillbase::mechanics::arm_on_base::{ArmOnBase, FloatingBase};
use stillbase::mechanics::assembly::{Assembly, BlockState, Momentum, SpatialBase, parse as parse_assembly};
use stillbase::mechanics::balance::design;
use stillbase::mechanics::counterweights::{
    CounterweightSite, CounterweightSpec, CounterweightStock, Objective, place_weights,
};
use stillbase::mechanics::dynamics::{ExternalLoads, forward, inverse, inverse_with_wrench};
use stillbase::mechanics::joint_forces::Joints;
use stillbase::mechanics::loads::Loads;
use stillbase::mechanics::machine::{Inertia, Machine, parse, to_toml};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::off_plane::momentum::{MomentumModel, TipFrame};

use stillbase::study::assembly_check::AssemblyReport;

use super::assembly::{Piece, after, pieces, random_states};
use crate::support::Noise;
use crate::support::random::{a_machine, add_ground};

/// A machine with links that keep their orientation.
fn grounded(noise: &mut Noise) -> Machine {
    loop {
        let mut spec = a_machine(noise).spec().clone();
        if spec.drives.len() < 8 {
            add_ground(noise, &mut spec);
            let machine = Machine::new(spec).expect("a machine");
            assert!(machine.ground().is_some());
            return machine;
        }
    }
}

/// An arm of two drives with a platform at its end that a parallelogram over both links keeps upright.
const PLATFORM: &str = "
name = \"platform\"
gravity = [0.7, -9.0]
[[drive]]
name = \"1\"
[[drive]]
name = \"2\"
on = \"1\"
[[link]]
name = \"frame\"
drive = \"ground\"
attach = \"base\"
length = 0.1
mass = 0.5
inertia = 0.01
com = 0.04
com_normal = 0.02
[[link]]
name = \"upper\"
drive = \"1\"
attach = \"base\"
length = 0.5
mass = 1.0
inertia = 0.02
com = 0.2
[[link]]
name = \"upper bar\"
drive = \"1\"
attach = { link = \"frame\" }
length = 0.5
mass = 0.3
inertia = 0.006
com = 0.25
[[link]]
name = \"elbow\"
drive = \"ground\"
attach = { link = \"upper\" }
length = 0.1
mass = 0.2
inertia = 0.001
com = 0.03
com_normal = 0.01
[[link]]
name = \"lower\"
drive = \"2\"
attach = { link = \"upper\" }
length = 0.4
mass = 0.8
inertia = 0.01
com = 0.15
[[link]]
name = \"lower bar\"
drive = \"2\"
attach = { link = \"elbow\" }
length = 0.4
mass = 0.2
inertia = 0.003
com = 0.2
[[link]]
name = \"hand\"
drive = \"ground\"
attach = { link = \"lower\" }
length = 0.1
mass = 0.4
inertia = 0.002
com = 0.06
com_normal = -0.03
[[closure]]
a = { link = \"upper bar\" }
b = { link = \"elbow\" }
[[closure]]
a = { link = \"lower bar\" }
b = { link = \"hand\" }
[end_effector]
link = \"lower\"
";

fn platform() -> Machine {
    parse(PLATFORM, "platform").unwrap_or_else(|why| panic!("{why}"))
}

fn motion(noise: &mut Noise, n: usize) -> (DriveAngles, PerDrive, PerDrive) {
    let mut any = |most: f64| PerDrive::from_fn(n, |_| noise.between(-most, most));
    (DriveAngles(any(3.0)), any(2.0), any(8.0))
}

/// Force and moment on the base, and centre of mass times mass, by differences of points.
fn by_points(assembly: &Assembly, state: &BlockState) -> [Vector3<f64>; 3] {
    let h = 1e-3;
    let at = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|n| pieces(assembly, &after(std::slice::from_ref(state), n * h)));
    let mut sums = [Vector3::zeros(); 3];
    for (p, piece) in at[2].iter().enumerate() {
        match piece {
            Piece::Mass(mass, place) => {
                let x: [Vector3<f64>; 5] = std::array::from_fn(|i| match &at[i][p] {
                    Piece::Mass(_, place) => *place,
                    Piece::Rotor(..) => unreachable!("a mass"),
                });
                let pull = *mass * (16.0 * (x[1] + x[3]) - x[0] - x[4] - 30.0 * x[2]) / (12.0 * h * h);
                sums[0] -= pull;
                sums[1] -= place.cross(&pull);
                sums[2] += *mass * place;
            }
            Piece::Rotor(inertia, axis, _) => {
                let x: [f64; 5] = std::array::from_fn(|i| match &at[i][p] {
                    Piece::Rotor(.., turn) => *turn,
                    Piece::Mass(..) => unreachable!("a rotor"),
                });
                let turning = (16.0 * (x[1] + x[3]) - x[0] - x[4] - 30.0 * x[2]) / (12.0 * h * h);
                sums[1] -= *inertia * turning * *axis;
            }
        }
    }
    sums
}

#[test]
fn forces_moments_and_momentum_are_those_of_points() {
    let mut noise = Noise::of(881);
    for round in 0..60 {
        let machine = if round == 0 { platform() } else { grounded(&mut noise) };
        let (inertia, assembly) = (Inertia::of(&machine), Assembly::from(machine.clone()));
        let (q, qd, qdd) = motion(&mut noise, machine.drives());
        let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
        let loads = Loads::of(&inertia, &around, &q.0, &qd, &qdd);
        let [force, moment, first] = by_points(&assembly, &BlockState { q, qd, qdd });
        let g = Vector3::new(around.gravity.re, around.gravity.im, 0.0);
        let [force, moment] = [force + machine.mass() * g, moment + first.cross(&g)];
        let scale = 1.0 + force.norm() + moment.norm();
        let off = (loads.base_force[0] - force.x).abs() + (loads.base_force[1] - force.y).abs();
        assert!(off < 1e-6 * scale, "{round}: {:?} {force:?}", loads.base_force);
        assert!((loads.base_moment - moment.z).abs() < 1e-6 * scale, "{round}: {} {moment:?}", loads.base_moment);
        let com = first / machine.mass();
        assert!((loads.com[0] - com.x).abs() + (loads.com[1] - com.y).abs() < 1e-12, "{round}");
        // The momentum is what the moment changes.
        let h = 1e-5;
        let angular = |t: f64| {
            let state = &after(&[BlockState { q, qd, qdd }], t)[0];
            Loads::of(&inertia, &ExternalLoads::default(), &state.q.0, &state.qd, &state.qdd)
                .angular_momentum_about_base
        };
        let change = (angular(h) - angular(-h)) / (2.0 * h);
        let moving = moment.z - first.cross(&g).z;
        assert!((change + moving).abs() < 1e-6 * scale, "{round}: {change} {moving}");
        let e = q.units();
        let torque = inverse(&inertia, &e, &qd, &qdd, &around);
        let back = forward(&inertia, &e, &qd, &torque, &around);
        assert!(back.minus(&qdd).max_abs() < 1e-8 * (1.0 + qdd.max_abs()), "{round}");
    }
}

/// Pin forces add up to what reaches the base, and the moments of driven links are the torques, whatever is kept upright.
#[test]
fn pins_of_a_platform_carry_what_reaches_the_base() {
    let (mut noise, machine) = (Noise::of(882), platform());
    let (inertia, joints) = (Inertia::of(&machine), Joints::of(&machine).expect("its pins"));
    let around = ExternalLoads { gravity: machine.gravity(), force: Vector::new(3.0, -2.0) };
    let mut seen = 0;
    for _ in 0..200 {
        let (q, qd, qdd) = motion(&mut noise, 2);
        let e = q.units();
        let forces = joints.forces(&e, &qd, &qdd, &around);
        // Where a parallelogram lies flat its forces grow beyond bounds.
        if e[0].im.abs() < 0.1 || e[1].im.abs() < 0.1 {
            continue;
        }
        seen += 1;
        let (torque, wrench) = inverse_with_wrench(&inertia, &e, &qd, &qdd, &around);
        let torque = inertia.motors().motor_torques(&torque);
        let scale = 1.0 + torque.max_abs() + wrench.total().force.norm();
        let by_pins = forces.torque().expect("not flat");
        assert!(by_pins.minus(&torque).max_abs() < 1e-9 * scale, "{by_pins:?} {torque:?}");
        assert!((joints.on_base(&forces) - wrench.total().force).norm() < 1e-9 * scale);
    }
    assert!(seen > 100);
}

/// What the arm of a free base has as angular momentum beside a base that does not turn, and how it moves one that floats.
#[test]
fn a_free_base_is_moved_as_in_space() {
    let mut noise = Noise::of(883);
    for round in 0..40 {
        let mut spec = grounded(&mut noise).spec().clone();
        if spec.drives.len() > 6 {
            continue;
        }
        spec.gravity = [0.0; 2];
        // In the plane heights do not count.
        spec.links.iter_mut().for_each(|link| link.axial = 0.0);
        let machine = Machine::new(spec).expect("flat");
        let (inertia, assembly) = (Inertia::of(&machine), Assembly::from(machine.clone()));
        let states = random_states(&mut noise, &assembly);
        let (state, e) = (states[0], states[0].q.units());
        let com = Vector::new(noise.between(-0.3, 0.3), noise.between(-0.3, 0.3));
        let base = FloatingBase { mass: noise.between(5.0, 30.0), inertia: noise.between(1.0, 5.0), com };
        let seen = assembly.momentum(&states);
        let scale = 1.0 + seen.angular.norm() + seen.linear.norm();
        let fixed = MomentumModel::from(&inertia).coefficients(&e).dot(&state.qd);
        assert!((fixed - seen.angular.z).abs() < 1e-10 * scale, "{round}: {fixed} {seen:?}");
        let first: Vector3<f64> = pieces(&assembly, &states).iter().fold(Vector3::zeros(), |sum, piece| match piece {
            Piece::Mass(mass, place) => sum + *mass * place,
            Piece::Rotor(..) => sum,
        });
        let middle = (first + base.mass * Vector3::new(com.re, com.im, 0.0)) / (base.mass + machine.mass());
        let model = MomentumModel::floating(&inertia, &base, TipFrame::Base, &state.q);
        let held = model.coefficients(&e).dot(&state.qd);
        let want = seen.angular.z - middle.cross(&seen.linear).z;
        assert!((held - want).abs() < 1e-10 * scale, "{round}: {held} {want}");
        // In space the same base turns about the axis of the plane alone.
        let spatial = SpatialBase {
            mass: base.mass,
            com: Vector3::new(com.re, com.im, 0.0),
            inertia: base.inertia * Matrix3::identity(),
        };
        let moving = assembly.floating_motion(&spatial, &states, &Momentum::default());
        let rate = model.turn_form(&state.q).expect("a base that floats").coefficients.dot(&state.qd);
        assert!((rate - moving.rate.z).abs() < 1e-10 * (1.0 + rate.abs()), "{round}: {rate} {moving:?}");
        let mut torque = PerDrive::zeros(0);
        let loads = assembly.loads_on(&moving, &Vector3::zeros(), &states, |_, of| torque = of.torque).total();
        let arm = ArmOnBase::floating(inertia.clone(), &base).expect("few drives");
        let (own, wrench) = arm.dynamics(&e, &state.qd, &state.qdd);
        let own = inertia.motors().motor_torques(&own);
        let scale = 1.0 + own.max_abs() + loads.force.norm() + loads.moment.norm();
        assert!(own.minus(&torque).max_abs() < 1e-9 * scale, "{round}: {own:?} {torque:?}");
        let total = wrench.total();
        assert!((total.force - Vector::new(loads.force.x, loads.force.y)).norm() < 1e-9 * scale, "{round}");
        assert!((total.moment - loads.moment.z).abs() < 1e-9 * scale, "{round}: {total:?} {loads:?}");
    }
}

/// Counterweights and centres of mass are found for which the moment is D q̈ with constant D.
#[test]
fn links_that_keep_their_orientation_are_balanced_too() {
    let mut noise = Noise::of(884);
    let bare = platform().set("gravity", "0,0").expect("weightless");
    assert!(Inertia::of(&bare).ground_residual() > 0.01);
    let site = |link| CounterweightSite { link, from: -0.3, to: 0.3, across: 0.2, most: f64::INFINITY };
    let sites = (0..bare.links().len()).map(site).collect();
    let request = CounterweightSpec::least(Objective::mass(), sites, CounterweightStock::discs(7850.0, 0.03));
    let placed = place_weights(&bare, &request).expect("counterweights").machine;
    // Without centres of mass off the axes these can be moved alone.
    let straight = ["frame", "elbow", "hand"]
        .iter()
        .fold(bare, |machine, name| machine.set(&format!("link.{name}.com_normal"), "0").expect("on the axis"));
    let moved = design(&straight, &vec![1.0; straight.links().len()]).expect("centres of mass");
    for machine in [placed, moved] {
        let inertia = Inertia::of(&machine);
        assert!(inertia.is_balanced() && inertia.ground_residual() < 1e-8, "{}", inertia.ground_residual());
        let assembly = Assembly::from(machine.clone());
        for _ in 0..20 {
            let (q, qd, qdd) = motion(&mut noise, 2);
            let [force, moment, _] = by_points(&assembly, &BlockState { q, qd, qdd });
            let want = -inertia.momenta().dot(&qdd);
            assert!(force.norm() < 1e-5 && (moment.z - want).abs() < 1e-5, "{force:?} {moment:?} {want}");
        }
    }
}

/// A block reacts by its own platform, and is silent when its coupling is undone by what it carries beside its pin.
#[test]
fn a_block_says_what_its_platform_does() {
    let report = |hand: &str, carried: &str| {
        let mut machine = platform().set("gravity", "0,0").expect("weightless");
        for name in ["frame", "elbow", "hand"] {
            machine = machine.set(&format!("link.{name}.com_normal"), "0").expect("on the axis");
        }
        machine = machine.set("payload.mass", "1").expect("a payload");
        machine = design(&machine, &vec![1.0; machine.links().len()]).expect("centres of mass");
        machine =
            machine.set("payload.mass", "0").expect("what is carried").set("link.hand.com_normal", hand).expect("off");
        let ball = "name = 'ball'\n[[drive]]\nname = '1'\n[[link]]\nname = '1'\ndrive = '1'\nattach = 'base'\n\
                    length = 0.1\nmass = 1.0\ninertia = 0.01\ncom = 0.0\n[end_effector]\nlink = '1'\n";
        let text = format!(
            "kind = \"assembly\"\nname = \"two\"\n[[block]]\nname = \"arm\"\nmachine = \"\"\"\n{}\"\"\"\n[[block]]\n\
             name = \"ball\"\non = \"arm\"\nat = {carried}\nmachine = \"\"\"\n{ball}\"\"\"\n",
            to_toml(&machine)
        );
        let assembly = parse_assembly(&text, "two", &|text| parse(text, "own")).expect("an assembly");
        let states = random_states(&mut Noise::of(885), &assembly);
        // The arm holds its b, and so does what it carries.
        let lambda = AssemblyReport::of(&assembly).blocks[0].lambda.clone();
        let along = |x: &PerDrive| PerDrive::from_fn(2, |k| if k == 0 { -lambda[1] * x[1] } else { x[1] });
        let still = PerDrive::zeros(1);
        let states: Vec<BlockState> = vec![
            BlockState { qd: along(&states[0].qd), qdd: along(&states[0].qdd), ..states[0] },
            BlockState { qd: still, qdd: still, ..states[1] },
        ];
        let felt = assembly.loads(&states, |_, _| {}).total();
        (AssemblyReport::of(&assembly).blocks[0].clone(), felt.force.norm() + felt.moment.norm())
    };
    let (silent, felt) = report("0", "[0, 0, 0]");
    assert!(silent.silent && felt < 1e-9, "{silent:?} {felt}");
    let (own, felt) = report("0.05", "[0, 0, 0]");
    assert!(own.reasons.iter().any(|why| why.starts_with("its links that keep their orientation")), "{own:?}");
    assert!(felt > 1e-3 && !own.silent, "{felt}");
    let (carried, felt) = report("0", "[0, 0.02, 0]");
    assert!(carried.reasons[0].starts_with("what it carries (ball)") && felt > 1e-3, "{carried:?} {felt}");
    // 0.4 kg at 50 mm to the left are undone by 1 kg at 20 mm to the right.
    let (undone, felt) = report("0.05", "[0, -0.02, 0]");
    assert!(undone.silent && felt < 1e-9, "{undone:?} {felt}");
}

#[test]
fn what_a_link_that_keeps_its_orientation_cannot_be_is_said() {
    let said = |from: &str, to: &str| parse(&PLATFORM.replace(from, to), "p").expect_err("refused").to_string();
    let end = said("[end_effector]\nlink = \"lower\"", "[end_effector]\nlink = \"hand\"");
    assert!(end.contains("link hand keeps its orientation: want the point of the link that carries it"), "{end}");
    let beside = said("[end_effector]\nlink = \"lower\"", "[end_effector]\nlink = \"lower bar\"");
    assert!(beside.contains("it is 0.1 m along x beside"), "{beside}");
    let open = said("a = { link = \"upper bar\" }", "a = { link = \"upper bar\", at = 0.4 }");
    assert!(open.contains("along drive 1"), "{open}");
    let short = said("attach = { link = \"lower\" }\nlength = 0.1", "attach = { link = \"lower\" }\nlength = 0.2");
    assert!(short.contains("along x of the base"), "{short}");
    let drives = |n: usize| (3..=n).map(|k| format!("[[drive]]\nname = \"{k}\"\n")).collect::<String>();
    let many =
        parse(&(PLATFORM.replace("[end_effector]", &(drives(8) + "[end_effector]"))), "p").expect_err("too many");
    assert!(many.to_string().contains("at most 7 beside links with drive = \"ground\""), "{many}");
    let refused = platform().check_all_turn("tolerances").expect_err("refused").to_string();
    assert!(refused.contains("link \"frame\" keeps its orientation"), "{refused}");
}
