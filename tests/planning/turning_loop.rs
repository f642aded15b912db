//! Closed motions of an arm that turn its free base. The lengths are those of a search in SciPy (SLSQP from 40 random
//! loops, sines up to order 16), with the turn as a sum over the bodies of base and arm.

use std::f64::consts::PI;

use proptest::prelude::*;
use stillbase::mechanics::arm_on_base::{ArmOnBase, FloatingBase};
use stillbase::mechanics::machine::{Inertia, Machine, builtin, builtins, parse};
use stillbase::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector};
use stillbase::planning::Motion;
use stillbase::planning::curves::Path;
use stillbase::planning::off_plane::base_forecast::BaseForecast;
use stillbase::planning::off_plane::momentum::{MomentumModel, TipFrame};
use stillbase::planning::off_plane::turning_loop::{NoLoop, TurningLoop};
use stillbase::planning::timing::TimeLaw;
use stillbase::session::scenario::{Scenario, TaskChange, Value};
use stillbase::session::verdict::{Statements, StatusLight, Verdict};
use stillbase::session::{Run, replay};
use stillbase::simulation::plant::{BaseKind, Wheel};

const START: [f64; 3] = [1.9, 2.6, 3.4];

/// Turn, degrees, and length of the shortest loop of `spot`, rad.
const LENGTHS: [[f64; 2]; 5] = [[1.0, 1.9003], [5.0, 3.8226], [20.0, 6.8338], [40.0, 9.15467], [80.0, 14.8261]];

fn spot_base() -> FloatingBase {
    Scenario::builtin("spot").expect("built in").base.body()
}

fn spot() -> Machine {
    builtin("spot").expect("built in").clone()
}

fn beside(machine: &Machine, base: &FloatingBase, start: &DriveAngles) -> MomentumModel {
    MomentumModel::floating(&Inertia::of(machine), base, TipFrame::Space, start)
}

fn of_spot(text: &str, degrees: f64) -> Result<(MomentumModel, TurningLoop), NoLoop> {
    let text = include_str!("../../assets/machines/spot.toml").to_owned() + text;
    let (machine, start) = (parse(&text, "spot").expect("valid"), DriveAngles::from(START));
    let model = beside(&machine, &spot_base(), &start);
    TurningLoop::shortest(&model, machine.angles(), &start, degrees.to_radians()).map(|found| (model, found))
}

/// Returns by how much a loop turns the base, by the quadrature of any motion.
fn turned(machine: &Machine, base: &FloatingBase, found: &TurningLoop) -> f64 {
    let arm = ArmOnBase::floating(Inertia::of(machine), base).expect("few drives");
    let motion = Motion::new(Path::Table(found.path.clone()), TimeLaw::Quintic, 1.0);
    BaseForecast::of(&arm, &motion).expect("the base is free").angle_end
}

fn ends(found: &TurningLoop) -> [DriveAngles; 2] {
    [0.0, 1.0].map(|s| found.path.at(s).q)
}

/// No loop that a search outside found is shorter, and none is needed.
#[test]
fn loops_are_as_short_as_those_found_elsewhere() {
    for [degrees, length] in LENGTHS {
        let (_, found) = of_spot("", degrees).expect("there is one");
        assert!((turned(&spot(), &spot_base(), &found) - degrees.to_radians()).abs() < 1e-9, "{degrees}°");
        assert_eq!(ends(&found).map(|q| q.to_vec()), [START, START].map(Vec::from));
        // The sines of the other search end at order 16.
        assert!(found.length < length + 1e-6 && found.length > length * (1.0 - 1e-3), "{degrees}°: {}", found.length);
    }
}

/// A loop of least length is run through like a charge through a magnetic field: q″ = μ/2 · curl A · q′, at constant speed.
#[test]
fn loops_obey_the_law_of_a_charge_in_a_field() {
    for degrees in [0.1, 1.0, -5.0, 20.0] {
        let (model, found) = of_spot("", degrees).expect("there is one");
        let push = |s: f64| {
            let (at, form) = (found.path.at(s), model.turn_form(&found.path.at(s).q).expect("free"));
            PerDrive::from_fn(3, |m| (0..3).map(|l| form.curl(m, l) * at.first[l]).sum())
        };
        let along: Vec<f64> = (0..=40).map(|i| 0.05 + 0.9 * f64::from(i) / 40.0).collect();
        let (mut products, mut squares) = (0.0, 0.0);
        for s in &along {
            products += push(*s).dot(&found.path.at(*s).second);
            squares += push(*s).dot(&push(*s));
        }
        for s in &along {
            let at = found.path.at(*s);
            let off = at.second.plus(-products / squares, &push(*s));
            let size = at.second.dot(&at.second).sqrt();
            let tolerance = if degrees > 10.0 { 0.05 } else { 0.02 };
            assert!(off.dot(&off).sqrt() < tolerance * size, "{degrees}°, {s}: {off:?} of {size}");
            assert!((at.first.dot(&at.first).sqrt() / found.length - 1.0).abs() < 5e-3, "{degrees}°, {s}");
        }
    }
}

/// Small loops are circles: length² = 4π θ/β, with β the largest curl in a plane.
#[test]
fn small_loops_are_circles() {
    let lengths = [1e-6, 1e-5].map(|degrees| {
        let (model, found) = of_spot("", degrees).expect("there is one");
        let form = model.turn_form(&DriveAngles::from(START)).expect("free");
        let curl = [[0, 1], [1, 2], [2, 0]].map(|[m, l]| form.curl(m, l));
        let beta = curl.iter().map(|c| c * c).sum::<f64>().sqrt();
        found.length.powi(2) / (4.0 * PI * degrees.to_radians() / beta) - 1.0
    });
    // The difference falls with the size of the loop, as the curl changes across it.
    assert!(lengths[0].abs() < 2e-3 && lengths[0].abs() < 0.5 * lengths[1].abs(), "{lengths:?}");
}

/// The derivatives by which loops are found are those of the turn.
#[test]
fn the_turn_has_the_slopes_it_states() {
    let start = DriveAngles::from(START);
    let model = beside(builtin("spot").expect("built in"), &spot_base(), &start);
    for seed in 0..50 {
        let q = DriveAngles(PerDrive::from_fn(3, |k| (f64::from(seed) * (1.3 + k as f64)).sin() * 3.0));
        let form = model.turn_form(&q).expect("free");
        for m in 0..3 {
            let side = |by: f64| {
                let moved = DriveAngles(q.0.plus(by, &PerDrive::from_fn(3, |k| f64::from(k == m))));
                model.turn_form(&moved).expect("free").coefficients
            };
            let slope = side(1e-5).minus(&side(-1e-5)).scaled(0.5e5);
            assert!(slope.minus(&form.slopes[m]).max_abs() < 1e-9, "{q:?}");
        }
    }
}

/// Loops keep the limits of the relative angles, also where these touch the start, and are hardly longer than they must be:
/// the other search keeps the limits at 95 places.
#[test]
fn loops_keep_the_limits_of_the_joints() {
    for [width, degrees, length] in [[0.6, 5.0, 5.26061], [0.5, 5.0, 5.51572], [0.5, 3.0, 4.23486]] {
        // The relative angles at the start are 0.7 and 0.8 rad.
        let text = format!(
            "[[angle]]\nname = \"elbow\"\nfrom = \"shoulder\"\nto = \"elbow\"\nmin = {}\nmax = {}\n\
             [[angle]]\nname = \"wrist\"\nfrom = \"elbow\"\nto = \"wrist\"\nmin = 0.8\nmax = {}\n",
            0.7 - width,
            0.7 + width,
            0.8 + 2.0 * width
        );
        let (_, found) = of_spot(&text, degrees).expect("there is one");
        assert!((turned(&spot(), &spot_base(), &found) - degrees.to_radians()).abs() < 1e-9);
        for i in 0..=1000 {
            let q = found.path.at(f64::from(i) / 1000.0).q;
            let (elbow, wrist) = (q[1] - q[0] - 0.7, q[2] - q[1] - 0.8);
            assert!(elbow.abs() <= width + 1e-7 && (-1e-7..=2.0 * width + 1e-7).contains(&wrist), "{width}: {q:?}");
        }
        assert!((-1e-4..1e-3).contains(&(found.length / length - 1.0)), "{width}, {degrees}°: {}", found.length);
    }
}

/// Returns a serial arm of bars, each with its length, m, mass, kg, and inertia, kg m².
fn serial(bars: &[(f64, f64, f64)]) -> Machine {
    let mut text = "name = \"serial\"\n".to_owned();
    for (k, (length, mass, inertia)) in bars.iter().enumerate() {
        let attach = if k == 0 { "\"base\"".into() } else { format!("{{ link = \"{k}\", at = \"tip\" }}") };
        let k = k + 1;
        text += &format!(
            "[[drive]]\nname = \"{k}\"\n[[link]]\nname = \"{k}\"\ndrive = \"{k}\"\nattach = {attach}\n\
             length = {length}\nmass = {mass}\ninertia = {inertia}\ncom = {}\n",
            0.5 * length
        );
    }
    text += &format!("[end_effector]\nlink = \"{}\"\n", bars.len());
    parse(&text, "serial").expect("valid")
}

/// An arm of as many drives as a free base may carry.
#[test]
fn loops_of_the_most_drives_are_found() {
    let machine = serial(&[(0.4, 1.0, 0.02); MAX_DRIVES - 1]);
    let start = DriveAngles(PerDrive::from_fn(MAX_DRIVES - 1, |k| 0.3 * k as f64));
    let base = FloatingBase { mass: 20.0, inertia: 2.0, com: Vector::new(0.1, -0.2) };
    let model = beside(&machine, &base, &start);
    let found = TurningLoop::shortest(&model, machine.angles(), &start, 0.01).expect("there is one");
    assert!((turned(&machine, &base, &found) - 0.01).abs() < 1e-9);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Arms of two to five drives on any base turn it by what is wanted, and return.
    #[test]
    fn loops_turn_any_base_by_the_wanted_angle(
        bars in proptest::collection::vec((0.2..1.0f64, 0.5..5.0f64, 0.01..0.3f64), 2..=5),
        q in proptest::collection::vec(-3.0..3.0f64, 5),
        (mass, inertia, x, y) in (2.0..30.0f64, 0.5..10.0f64, -0.5..0.5f64, -0.5..0.5f64),
        degrees in prop_oneof![-1.0..-0.01f64, 0.01..1.0f64],
    ) {
        let machine = serial(&bars);
        let start = DriveAngles(PerDrive::from_fn(bars.len(), |k| q[k]));
        let base = FloatingBase { mass, inertia, com: Vector::new(x, y) };
        let model = beside(&machine, &base, &start);
        let shortest = |wanted: f64| TurningLoop::shortest(&model, machine.angles(), &start, wanted);
        let mut wanted = degrees.to_radians();
        let mut found = shortest(wanted);
        if let Err(NoLoop::Short { turn }) = found {
            // A heavy base turns by so much in several loops, each of less than the largest turn found.
            prop_assert!(turn < wanted.abs());
            wanted = (0.5 * turn).copysign(wanted);
            found = shortest(wanted);
        }
        let found = found.expect("there is one");
        prop_assert!((turned(&machine, &base, &found) - wanted).abs() < 1e-9);
        prop_assert!(ends(&found)[1].0.minus(&ends(&found)[0].0).max_abs() < 1e-13);
    }
}

fn set(scenario: &Scenario, changes: &[(&str, Value)]) -> Scenario {
    let change: TaskChange = changes.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
    let task = scenario.task.with_change(&change, &scenario.machine).expect("valid");
    Scenario { task, ..scenario.clone() }
}

/// The scenario does what it says, in the simulation, and says so.
#[test]
fn a_run_ends_with_the_base_turned_as_wanted() {
    let scenario = Scenario::builtin("spot-turn").expect("built in");
    for cycles in [1, 3] {
        let run = replay(&set(&scenario, &[("cycles", cycles.into())]), |_, _| {}).expect("it runs");
        let (last, wanted) = (run.frame(), 5.0_f64.to_radians());
        let verdict = Verdict::of(run.scenario(), &last);
        assert_eq!(verdict.word(), "turns its base as wanted");
        assert!(verdict.spares_base() && verdict.remarks().is_empty(), "{}", verdict.sentence());
        assert!((last.base.angle - wanted).abs() < 1e-7, "{}", last.base.angle);
        let statements = Statements::of(&run, &last);
        assert_eq!(statements.run.words, "turned its base by 0.0873 rad, as wanted");
        assert_eq!((statements.plan.outcome, statements.run.outcome), (StatusLight::Good, StatusLight::Good));
    }
}

/// Where an arm cannot turn its base, the reason is told.
#[test]
fn what_cannot_be_turned_is_refused_with_the_reason() {
    let own = Scenario::builtin("spot-turn").expect("built in");
    let refusal = |scenario: &Scenario| Run::new(scenario).expect_err("no loop").to_string();
    assert!(refusal(&set(&own, &[("base_turn", 0.0.into())])).contains("want task.base_turn other than 0"));
    let mut held = own.clone();
    held.base.kind = BaseKind::Fixed;
    assert!(refusal(&held).contains("want base.kind = free"));
    let mut wheeled = own.clone();
    wheeled.base.wheel = Some(Wheel::default());
    assert!(refusal(&wheeled).contains("no wheel that holds it"));
    // The mass matrix of this machine is constant: the turn of its base depends on b alone.
    let space = Scenario::builtin("spacecraft").expect("built in");
    let still = set(&space, &[("kind", "turn-base".into()), ("via", "default".into())]);
    let why = refusal(&still);
    assert!(why.starts_with("no closed motion turns the base of a balanced arm: its mass matrix is constant"), "{why}");
    // This start is past a limit of the machine, but no other start would help.
    assert_eq!(refusal(&own.on_machine(&space.machine)), why);
}

/// Exactly the balanced ones of the machines turn no base: for the others, the turn around small loops differs from zero.
#[test]
fn machines_that_are_balanced_turn_no_base() {
    let (mut balanced, mut others) = (0, 0);
    for machine in builtins().iter().filter(|machine| machine.drives() > 1) {
        let inertia = Inertia::of(machine);
        let n = machine.drives();
        let start = DriveAngles(PerDrive::from_fn(n, |k| 0.3 + 0.7 * k as f64));
        let model = beside(machine, &spot_base(), &start);
        let curl = |pose: usize| {
            let q = DriveAngles(PerDrive::from_fn(n, |k| 0.4 * pose as f64 * (1.0 + k as f64)));
            let form = model.turn_form(&q).expect("the base is free");
            Inertia::pairs(n).map(|(k, l)| form.curl(k, l).abs()).fold(0.0, f64::max)
        };
        let most = (0..20).map(curl).fold(0.0, f64::max);
        match NoLoop::of(&inertia) {
            Some(why) => {
                assert_eq!(why, NoLoop::Balanced, "{}", machine.name());
                assert!(inertia.is_balanced() && most < 1e-9, "{}: {most}", machine.name());
                let found = TurningLoop::shortest(&model, machine.angles(), &start, 0.01);
                assert_eq!(found, Err(NoLoop::Balanced), "{}", machine.name());
                balanced += 1;
            }
            None => {
                assert!(!inertia.is_balanced() && most > 1e-6, "{}: {most}", machine.name());
                others += 1;
            }
        }
    }
    assert!(balanced > 2 && others > 4, "{balanced} balanced, {others} others");
}
