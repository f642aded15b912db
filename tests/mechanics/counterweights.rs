//! Counterweights: against a conic solver of others, against the laws, and what is refused.

use stillbase::mechanics::counterweights::{Bound, Disc, NoWeights, Objective, Sites, Weighing, front, place};
use stillbase::mechanics::dynamics::mass_matrix;
use stillbase::mechanics::machine::{Inertia, Machine, builtin, parse, to_toml};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};

use crate::support::{Noise, family_machine};

/// Steel, 30 mm.
const STEEL: Disc = Disc { density: 7850.0, thickness: 0.03 };

/// Every link from 0.30 m behind its root to its tip.
fn anywhere(machine: &Machine) -> Vec<Sites> {
    let parts = machine.resolved_links().iter().enumerate();
    parts.map(|(link, part)| Sites { link, from: -0.3, to: part.length, most: f64::INFINITY }).collect()
}

fn weighing(machine: &Machine, objective: Objective) -> Weighing {
    Weighing { sites: anywhere(machine), disc: STEEL, objective, most_inertia: None }
}

fn momenta(machine: &Machine) -> f64 {
    Inertia::of(machine).momenta().iter().sum()
}

/// Answers of CVXPY with two conic solvers.
#[test]
fn the_known_answers_are_found() {
    let bare = family_machine("nine-link-bare");
    let light = place(&bare, &weighing(&bare, Objective::mass())).expect("it can be balanced");
    assert!((light.added_mass - 9.572_666_7).abs() < 1e-6, "{}", light.added_mass);
    let quick = place(&bare, &weighing(&bare, Objective::inertia())).expect("it can be balanced");
    assert!((momenta(&quick.machine) - 1.798_401_1).abs() < 1e-6, "{}", momenta(&quick.machine));
    assert!((quick.added_mass - 21.9756).abs() < 1e-2, "{}", quick.added_mass);
    for (most, mass) in [(2.0, 10.743_685), (1.9, 12.996_808), (1.85, 14.975_873)] {
        let asked = Weighing { most_inertia: Some(most), ..weighing(&bare, Objective::mass()) };
        let found = place(&bare, &asked).expect("it can be balanced");
        assert!((found.added_mass - mass).abs() < 2e-6, "Σ D ≤ {most}: {}", found.added_mass);
        assert!((momenta(&found.machine) - most).abs() < 1e-6);
    }
    let mut near = weighing(&bare, Objective::mass());
    near.sites[0].from = -0.15;
    let found = place(&bare, &near).expect("it can be balanced");
    assert!((found.added_mass - 14.526).abs() < 1e-6, "{}", found.added_mass);
}

/// What is found is balanced to rounding, within its bounds, and certified.
#[test]
fn what_is_found_is_balanced_within_bounds_and_certified() {
    let bare = family_machine("nine-link-bare");
    for objective in [Objective::mass(), Objective::inertia(), Objective { mass: 0.1, ..Objective::inertia() }] {
        let asked = weighing(&bare, objective);
        let found = place(&bare, &asked).expect("it can be balanced");
        let inertia = Inertia::of(&found.machine);
        assert!(inertia.force_residual() < 1e-14 && inertia.invariance_residual() < 1e-14);
        assert!(found.gap < 1e-6, "{}", found.gap);
        for weight in &found.machine.spec().counterweights {
            let j = bare.links().iter().position(|link| link.name == weight.link).expect("a link");
            assert!(weight.mass > 0.0 && (asked.sites[j].from - 1e-7..=asked.sites[j].to + 1e-7).contains(&weight.at));
            let volume = std::f64::consts::PI * weight.radius.powi(2) * STEEL.thickness;
            assert!((volume * STEEL.density - weight.mass).abs() < 1e-12 * weight.mass);
        }
        // Again the same, from the file that it is written to.
        let again = parse(&to_toml(&found.machine), "again.toml").expect("a machine");
        assert_eq!(again, found.machine);
        assert_eq!(place(&again, &asked).expect("it can be balanced"), found, "those it has are taken off first");
    }
}

/// Nothing feasible is better: many balanced machines within the bounds, made at random by moving along what balance
/// leaves free, weigh no less and turn no easier.
#[test]
fn nothing_else_within_the_bounds_is_better() {
    let bare = family_machine("nine-link-bare");
    let light = place(&bare, &weighing(&bare, Objective::mass())).expect("it can be balanced");
    let quick = place(&bare, &weighing(&bare, Objective::inertia())).expect("it can be balanced");
    let mut noise = Noise::of(7);
    let (mut tried, least) = (0, momenta(&quick.machine));
    for _ in 0..60 {
        // Random prices give other corners of what is possible.
        let mut asked = weighing(&bare, Objective { mass: noise.between(0.0, 1.0), ..Objective::inertia() });
        for site in &mut asked.sites {
            site.from = noise.between(-0.3, -0.12);
            site.most = noise.between(6.0, 30.0);
        }
        let Ok(found) = place(&bare, &asked) else { continue };
        tried += 1;
        assert!(found.added_mass >= light.added_mass - 1e-6);
        assert!(momenta(&found.machine) >= least - 1e-6);
    }
    assert!(tried > 20, "{tried}");
}

/// A counterweight in a file is a body like any other: link and disc, held against a link that has both in it.
#[test]
fn a_counterweight_is_a_body_of_its_own() {
    let bare = builtin("nine-link").expect("built in");
    let text = to_toml(bare) + "\n[[counterweight]]\nlink = \"5\"\nmass = 1.5\nat = -0.12\nradius = 0.05\n";
    let with = parse(&text, "with.toml").expect("a machine");
    let (link, own) = (&bare.links()[4], 0.5 * 1.5 * 0.05 * 0.05);
    let mass = link.mass + 1.5;
    let com = (link.mass * link.com - 1.5 * 0.12) / mass;
    let about = link.inertia + own + link.mass * (link.com - com).powi(2) + 1.5 * (0.12 + com).powi(2);
    let one = bare
        .set_all([
            ("link.5.mass", mass.to_string().as_str()),
            ("link.5.com", com.to_string().as_str()),
            ("link.5.inertia", about.to_string().as_str()),
        ])
        .expect("in range");
    assert!((with.mass() - one.mass()).abs() < 1e-15);
    let e = DriveAngles(PerDrive::from_slice(&[0.4, 1.9, -1.1]).expect("three")).units();
    let rates = PerDrive::from_slice(&[1.0, -2.0, 0.7]).expect("three");
    let of = |machine: &Machine| mass_matrix(&Inertia::of(machine), &e, &rates);
    let ((h, v), (h_one, v_one)) = (of(&with), of(&one));
    for k in 0..3 {
        assert!((v[k] - v_one[k]).abs() < 1e-14);
        (0..3).for_each(|l| assert!((h.get(k, l) - h_one.get(k, l)).abs() < 1e-14));
    }
    // The link stays what it is, and can be changed under its counterweight.
    assert_eq!(with.spec().links, bare.spec().links);
    let heavier = with.set("link.5.mass", "0.9").expect("in range");
    assert!((heavier.mass() - with.mass() - 0.2).abs() < 1e-14);
    assert!(parse(&text.replace("link = \"5\"\nmass", "link = \"50\"\nmass"), "x.toml").is_err());
    for bad in ["mass = 0.0", "mass = -1", "mass = nan"] {
        assert!(parse(&text.replace("mass = 1.5\nat", &format!("{bad}\nat")), "x.toml").is_err(), "{bad}");
    }
}

/// Centres of mass of links are solved under the counterweights that they carry, too.
#[test]
fn links_are_balanced_under_their_counterweights() {
    use stillbase::mechanics::balance::design;
    let text = to_toml(builtin("nine-link").expect("built in"))
        + "\n[[counterweight]]\nlink = \"2\"\nmass = 0.8\nat = -0.1\nradius = 0.04\n";
    let with = parse(&text, "with.toml").expect("a machine");
    assert!(!Inertia::of(&with).is_force_balanced());
    let designed = design(&with, &[1.0; 9]).expect("it can be balanced");
    assert!(Inertia::of(&designed).is_force_balanced() && Inertia::of(&designed).is_invariant());
    assert_eq!(designed.spec().counterweights, with.spec().counterweights);
}

#[test]
fn a_front_runs_from_light_to_quick() {
    let bare = family_machine("nine-link-bare");
    let points = front(&bare, &weighing(&bare, Objective::mass()), 25).expect("it can be balanced").measures();
    assert_eq!(points.len(), 25);
    assert!((points[0][0] - 9.572_666_7).abs() < 1e-4 && (points[24][1] - 1.798_401_1).abs() < 1e-6);
    for pair in points.windows(2) {
        assert!(pair[1][0] > pair[0][0] && pair[1][1] < pair[0][1], "{pair:?}");
    }
    // It bends inwards: each further kilogram buys less.
    for three in points.windows(3) {
        let slope = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) / (b[1] - a[1]);
        assert!(slope(three[1], three[2]) < slope(three[0], three[1]) + 1e-3, "{three:?}");
    }
}

#[test]
fn bounds_that_leave_no_way_are_named() {
    let bare = family_machine("nine-link-bare");
    let mut asked = weighing(&bare, Objective::mass());
    asked.sites.iter_mut().for_each(|site| site.most = 1.0);
    let why = place(&bare, &asked).expect_err("too little");
    let NoWeights::Conflict { bounds, relief: Some(relief) } = why else { panic!("{why:?}") };
    assert!(!bounds.is_empty() && bounds.iter().any(|bound| matches!(bound, Bound::Most(_))), "{bounds:?}");
    // With any of them away there is a way, and so there is with the masses that are proposed.
    let without = |bound: &Bound| {
        let mut asked = asked.clone();
        for site in &mut asked.sites {
            let name = &bare.links()[site.link].name;
            match bound {
                Bound::Most(link) if link == name => site.most = f64::INFINITY,
                Bound::From(link) if link == name => site.from = -1e3,
                Bound::To(link) if link == name => site.to = 1e3,
                _ => {}
            }
        }
        // Only the bounds of the conflict stay.
        for site in &mut asked.sites {
            let name = bare.links()[site.link].name.clone();
            let kept = |bound: Bound| bounds.contains(&bound);
            site.most = if kept(Bound::Most(name.clone())) { site.most } else { f64::INFINITY };
            site.from = if kept(Bound::From(name.clone())) { site.from } else { -1e3 };
            site.to = if kept(Bound::To(name)) { site.to } else { 1e3 };
        }
        place(&bare, &asked)
    };
    for bound in &bounds {
        assert!(without(bound).is_ok(), "{bound}");
    }
    asked.sites.iter_mut().for_each(|site| site.most = relief * (1.0 + 1e-6));
    assert!(place(&bare, &asked).is_ok(), "up to {relief} kg");
    asked.sites.iter_mut().for_each(|site| site.most = relief * (1.0 - 1e-3));
    assert!(place(&bare, &asked).is_err());
}

#[test]
fn what_cannot_be_is_refused() {
    let bare = family_machine("nine-link-bare");
    let asked = weighing(&bare, Objective::mass());
    let words = |asked: &Weighing| place(&bare, asked).expect_err("it cannot be").to_string();
    let mut twice = asked.clone();
    twice.sites.push(twice.sites[0]);
    assert!(words(&twice).contains("one a link"));
    let with = |change: &dyn Fn(&mut Weighing)| {
        let mut asked = asked.clone();
        change(&mut asked);
        words(&asked)
    };
    assert!(with(&|a| a.disc.density = 0.0).contains("density"));
    assert!(with(&|a| a.disc.thickness = f64::NAN).contains("thickness"));
    assert!(with(&|a| a.sites[2].to = -1.0).contains("link 3"));
    assert!(with(&|a| a.sites[2].most = -1.0).contains("link 3"));
    assert!(with(&|a| a.sites[2].link = 20).contains("link number 20"));
    let why = with(&|a| a.sites.retain(|site| site.link != 1));
    assert!(why.contains("within these bounds: link 4: no further out"), "{why}");
    let why = with(&|a| a.sites.retain(|site| [0, 1, 2, 7].contains(&site.link)));
    assert!(why.contains("more links"), "{why}");
    assert!(with(&|a| a.sites.truncate(1)).contains("drive 2"));
    let slanted = bare.set("link.4.com_normal", "0.02").expect("in range");
    let why = place(&slanted, &weighing(&slanted, Objective::mass())).expect_err("it cannot be");
    assert!(matches!(why, NoWeights::OffAxis { .. }), "{why}");
    let geared = family_machine("serial-3r");
    let torque = Objective { torque: 1.0, accelerations: vec![1.0; 3], ..Objective::mass() };
    let why = place(&geared, &weighing(&geared, torque)).expect_err("it cannot be");
    assert_eq!(why, NoWeights::Coupled);
}

/// The torque of a motion whose accelerations are known.
#[test]
fn the_greatest_torque_is_least() {
    let bare = family_machine("nine-link-bare");
    let accelerations = vec![12.0, 30.0, 45.0];
    let torque = |machine: &Machine| {
        let inertia = Inertia::of(machine);
        (0..3).map(|k| inertia.diagonal(k) * accelerations[k]).fold(0.0_f64, f64::max)
    };
    let objective = Objective { torque: 1.0, mass: 0.0, inertia: 0.0, accelerations: accelerations.clone() };
    let least = place(&bare, &weighing(&bare, objective)).expect("it can be balanced");
    assert!(
        (torque(&least.machine) - least.value).abs() < 1e-6 * least.value,
        "{} {}",
        torque(&least.machine),
        least.value
    );
    for other in [Objective::mass(), Objective::inertia()] {
        let other = place(&bare, &weighing(&bare, other)).expect("it can be balanced");
        assert!(torque(&other.machine) >= torque(&least.machine) - 1e-9);
    }
}

/// Each is set by its number, as links are by their names.
#[test]
fn counterweights_are_set_by_key() {
    let text = to_toml(builtin("nine-link").expect("built in"))
        + "\n[[counterweight]]\nlink = \"2\"\nmass = 0.8\nat = -0.1\n[[counterweight]]\nlink = \"5\"\nmass = 1.5\nat = -0.12\nradius = 0.05\n";
    let machine = parse(&text, "with.toml").expect("a machine");
    let changed =
        machine.set_all([("counterweight.2.mass", "1.25"), ("counterweight.2.at", "-0.2")]).expect("in range");
    let changed = changed.set("counterweight.1.radius", "0.04").expect("in range");
    let mut spec = machine.spec().clone();
    (spec.counterweights[1].mass, spec.counterweights[1].at, spec.counterweights[0].radius) = (1.25, -0.2, 0.04);
    assert_eq!(changed.spec(), &spec);
    assert!((changed.mass() - machine.mass() + 0.25).abs() < 1e-14);
    assert_eq!(changed.value("counterweight.2.at").and_then(|at| at.as_float()), Some(-0.2));
    let point = changed.set("counterweight.2.radius", "default").expect("it may be left out");
    assert_eq!(point.spec().counterweights[1].radius, 0.0);
    let words = |key: &str, value: &str| machine.set(key, value).expect_err("no such setting").to_string();
    for number in ["0", "3", "01", "x"] {
        assert!(words(&format!("counterweight.{number}.mass"), "1").contains("want one of \"1\", \"2\""), "{number}");
        assert_eq!(machine.value(&format!("counterweight.{number}.mass")), None);
    }
    assert!(words("counterweight.1.mass", "0").contains("1e-15"), "{}", words("counterweight.1.mass", "0"));
    assert!(words("counterweight.1.colour", "1").contains("counterweight.NUMBER.(mass|at|radius)"));
}

/// What balances itself is given nothing.
#[test]
fn a_balanced_machine_is_left_alone() {
    let machine = builtin("nine-link").expect("built in");
    for objective in [Objective::mass(), Objective::inertia()] {
        let placed = place(machine, &weighing(machine, objective)).expect("nothing to do");
        assert!(placed.added_mass < 1e-6 && placed.machine.spec().counterweights.is_empty(), "{}", placed.added_mass);
    }
    let points = front(machine, &weighing(machine, Objective::mass()), 5).expect("one point").points;
    assert!(points.iter().all(|placed| placed.added_mass < 1e-6));
}
