//! Counterweights: against a conic solver of others, against the laws, and what is refused.

use stillbase::mechanics::counterweights::{
    Bound, BoundRelaxation, CounterweightError, CounterweightSite, CounterweightSpec, CounterweightStock,
    END_TOLERANCE, FreeRotor, Objective, PlacementTolerance, RotorFreedom, front, over_payloads, place_weights,
    worst_residual,
};
use stillbase::mechanics::dynamics::mass_matrix;
use stillbase::mechanics::machine::{CounterweightShape, Inertia, Length, Machine, builtin, parse, to_toml};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};

use crate::support::{Noise, family_machine};

/// Steel, 30 mm.
const STEEL: CounterweightStock = CounterweightStock::discs(7850.0, 0.03);

/// Every link from 0.30 m behind its root to its tip.
fn anywhere(machine: &Machine) -> Vec<CounterweightSite> {
    let parts = machine.resolved_links().iter().enumerate();
    parts.map(|(link, part)| CounterweightSite::on_axis(link, -0.3, part.length)).collect()
}

fn weighing(machine: &Machine, objective: Objective) -> CounterweightSpec {
    CounterweightSpec::least(objective, anywhere(machine), STEEL)
}

fn momenta(machine: &Machine) -> f64 {
    Inertia::of(machine).momenta().iter().sum()
}

/// Answers of CVXPY with two conic solvers.
#[test]
fn the_known_answers_are_found() {
    let bare = family_machine("nine-link-bare");
    let light = place_weights(&bare, &weighing(&bare, Objective::mass())).expect("it can be balanced");
    assert!((light.added_mass - 9.572_666_7).abs() < 1e-6, "{}", light.added_mass);
    let quick = place_weights(&bare, &weighing(&bare, Objective::inertia())).expect("it can be balanced");
    assert!((momenta(&quick.machine) - 1.798_401_1).abs() < 1e-6, "{}", momenta(&quick.machine));
    assert!((quick.added_mass - 21.9756).abs() < 1e-2, "{}", quick.added_mass);
    for (most, mass) in [(2.0, 10.743_685), (1.9, 12.996_808), (1.85, 14.975_873)] {
        let asked = CounterweightSpec { max_inertia: Some(most), ..weighing(&bare, Objective::mass()) };
        let found = place_weights(&bare, &asked).expect("it can be balanced");
        assert!((found.added_mass - mass).abs() < 2e-6, "Σ D ≤ {most}: {}", found.added_mass);
        assert!((momenta(&found.machine) - most).abs() < 1e-6);
    }
    let mut near = weighing(&bare, Objective::mass());
    near.sites[0].from = -0.15;
    let found = place_weights(&bare, &near).expect("it can be balanced");
    assert!((found.added_mass - 14.526).abs() < 1e-6, "{}", found.added_mass);
}

/// The same request with every counterweight up to a distance, m, off the axis of its link.
fn off_axis(asked: CounterweightSpec, across: f64) -> CounterweightSpec {
    let sites = asked.sites.iter().map(|site| CounterweightSite { across, ..*site }).collect();
    CounterweightSpec { sites, ..asked }
}

/// Answers of CVXPY with centres of mass off the links' axes.
#[test]
fn centres_of_mass_off_the_axes_are_balanced_at_the_known_inertia() {
    let bare = family_machine("nine-link-bare");
    for (settings, inertia) in [
        (vec![("link.9.com_normal", "0.012")], 1.800_001_7),
        (vec![("link.9.com_normal", "0.012"), ("link.5.com_normal", "-0.008")], 1.800_194_0),
    ] {
        let slanted = bare.set_all(settings).expect("in range");
        let on_axis = place_weights(&slanted, &weighing(&slanted, Objective::inertia()));
        assert!(matches!(on_axis, Err(CounterweightError::OffAxis { .. })), "{on_axis:?}");
        let asked = off_axis(weighing(&slanted, Objective::inertia()), 0.1);
        let found = place_weights(&slanted, &asked).expect("it can be balanced");
        assert!((momenta(&found.machine) - inertia).abs() < 1e-6, "{}", momenta(&found.machine));
        let of = Inertia::of(&found.machine);
        assert!(of.force_residual() < 1e-14 && of.invariance_residual() < 1e-14 && found.is_certified());
        let light = place_weights(&slanted, &off_axis(weighing(&slanted, Objective::mass()), 0.1));
        assert!((light.expect("it can be balanced").added_mass - 9.572_666_7).abs() < 1e-6);
    }
    // Where all masses lie on the axes, so do the counterweights.
    let found = place_weights(&bare, &off_axis(weighing(&bare, Objective::inertia()), 0.1)).expect("it can be");
    assert!((momenta(&found.machine) - 1.798_401_1).abs() < 1e-6, "{}", momenta(&found.machine));
    assert!(found.machine.spec().counterweights.iter().all(|weight| weight.across.abs() < 1e-6));
}

/// A machine and its mirror image have counterweights that are mirror images.
#[test]
fn mirrored_masses_have_mirrored_counterweights() {
    let bare = family_machine("nine-link-bare");
    let [left, right] = ["0.012", "-0.012"].map(|normal| {
        let slanted = bare.set_all([("link.9.com_normal", normal), ("link.4.com_normal", normal)]).expect("in range");
        let asked = off_axis(weighing(&slanted, Objective { mass: 0.1, ..Objective::inertia() }), 0.05);
        place_weights(&slanted, &asked).expect("it can be balanced").machine
    });
    let pairs: Vec<_> = left.spec().counterweights.iter().zip(&right.spec().counterweights).collect();
    assert!(pairs.iter().any(|(left, _)| left.across.abs() > 1e-3));
    for (left, right) in pairs {
        assert!(
            (left.mass - right.mass).abs() < 1e-4 && (left.across + right.across).abs() < 1e-4,
            "{left:?} {right:?}"
        );
    }
}

/// A refusal of masses beside the axes says how far off the axes counterweights may be: as far as the masses are, or, where
/// a distance was given, the least that serves.
#[test]
fn the_least_distance_off_the_axes_is_proposed() {
    let slanted = family_machine("nine-link-bare").set("link.9.com_normal", "0.012").expect("in range");
    for asked in [weighing(&slanted, Objective::mass()), off_axis(weighing(&slanted, Objective::mass()), 1e-4)] {
        let asked = CounterweightSpec { max_added_mass: Some(12.0), ..asked };
        let why = place_weights(&slanted, &asked).expect_err("too near the axes");
        let (CounterweightError::OffAxis { reliefs, .. } | CounterweightError::Conflict { reliefs, .. }) = &why else {
            panic!("{why}")
        };
        let across = reliefs.iter().find_map(|together| match together[..] {
            [BoundRelaxation::Across(across)] => Some(across),
            _ => None,
        });
        let across = across.unwrap_or_else(|| panic!("{why}"));
        assert!(why.to_string().contains(&format!("up to {across:.4} m off the axis")), "{why}");
        assert!(place_weights(&slanted, &off_axis(asked.clone(), across)).is_ok());
        match why {
            CounterweightError::OffAxis { .. } => assert!(across >= 0.012, "{across}"),
            _ => assert!(place_weights(&slanted, &off_axis(asked, across - 2e-4)).is_err()),
        }
    }
}

/// Beside the axes, discs pass pins at any direction, so that room between pins is no bound.
#[test]
fn discs_beside_the_axes_stay_clear_of_pins() {
    let bare = family_machine("two-drive");
    let slanted = bare.set_all([("link.1.com_normal", "0.01"), ("link.2.com_normal", "-0.02")]).expect("in range");
    for clearance in [0.0, 0.01, 0.04] {
        let asked = off_axis(weighing(&slanted, Objective::mass()), 0.2);
        let free = place_weights(&slanted, &asked).expect("it can be balanced");
        let asked = CounterweightSpec { clearance: Some(clearance), ..asked };
        let found = place_weights(&slanted, &asked).expect("it can be balanced");
        assert!(found.is_certified() && found.added_mass > free.added_mass - 1e-6);
        let of = Inertia::of(&found.machine);
        assert!(of.force_residual() < 1e-13 && of.invariance_residual() < 1e-13);
        for weight in &found.machine.spec().counterweights {
            let link = found.machine.links().iter().position(|link| link.name == weight.link).expect("a link");
            for pin in &found.machine.resolved_links()[link].pins {
                let away = (weight.at - pin).hypot(weight.across) - weight.radius;
                assert!(away > clearance - 1e-6, "{clearance}: {away}, {weight:?}");
            }
        }
    }
}

/// What is found is balanced to rounding, within its bounds, and certified.
#[test]
fn what_is_found_is_balanced_within_bounds_and_certified() {
    let bare = family_machine("nine-link-bare");
    for objective in [Objective::mass(), Objective::inertia(), Objective { mass: 0.1, ..Objective::inertia() }] {
        let asked = weighing(&bare, objective);
        let found = place_weights(&bare, &asked).expect("it can be balanced");
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
        assert_eq!(
            place_weights(&again, &asked).expect("it can be balanced"),
            found,
            "those it has are taken off first"
        );
    }
}

/// Nothing feasible is better: many balanced machines within the bounds, made at random by moving along what balance
/// leaves free, weigh no less and turn no easier.
#[test]
fn nothing_else_within_the_bounds_is_better() {
    let bare = family_machine("nine-link-bare");
    let light = place_weights(&bare, &weighing(&bare, Objective::mass())).expect("it can be balanced");
    let quick = place_weights(&bare, &weighing(&bare, Objective::inertia())).expect("it can be balanced");
    let mut noise = Noise::of(7);
    let (mut tried, least) = (0, momenta(&quick.machine));
    for _ in 0..60 {
        // Random prices give other corners of what is possible.
        let mut asked = weighing(&bare, Objective { mass: noise.between(0.0, 1.0), ..Objective::inertia() });
        for site in &mut asked.sites {
            site.from = noise.between(-0.3, -0.12);
            site.most = noise.between(6.0, 30.0);
        }
        let Ok(found) = place_weights(&bare, &asked) else { continue };
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
    assert!((points[0][0] - 9.572_666_7).abs() < 1e-4 && (points[24][1] - 1.798_401_1).abs() < 4e-6);
    for pair in points.windows(2) {
        assert!(pair[1][0] > pair[0][0] && pair[1][1] < pair[0][1], "{pair:?}");
    }
    // It bends inwards: each further kilogram buys less.
    for three in points.windows(3) {
        let slope = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) / (b[1] - a[1]);
        assert!(slope(three[1], three[2]) < slope(three[0], three[1]) + 1e-3, "{three:?}");
    }
}

/// Nothing is better than an end in one measure and, by more than the tolerance, in the other: masses and Σ D_k just below
/// those of an end have no answer, or one that is no better.
#[test]
fn ends_of_a_front_have_the_least_of_both_measures() {
    let mut noise = Noise::of(17);
    for round in 0..12 {
        let name = ["nine-link-bare", "nine-link-bare", "serial-3r"][round % 3];
        let mut machine = family_machine(name);
        for link in 0..machine.links().len() {
            let of = &machine.links()[link];
            let key = format!("link.{}.mass", of.name);
            machine = machine.set(&key, &(of.mass * noise.between(0.5, 2.0)).to_string()).expect("in range");
        }
        let asked = weighing(&machine, Objective::mass());
        let Ok(found) = front(&machine, &asked, 2) else { continue };
        let measures = found.measures();
        let (Some([mass, _]), Some([_, inertia])) = (measures.first(), measures.last()) else { panic!("ends") };
        let least = |objective: Objective, max_added_mass, max_inertia| {
            let asked = CounterweightSpec { max_added_mass, max_inertia, ..weighing(&machine, objective) };
            place_weights(&machine, &asked).map(|placed| [placed.added_mass, momenta(&placed.machine)])
        };
        let [lightest, _] = least(Objective::mass(), None, None).expect("as before");
        let [_, quickest] = least(Objective::inertia(), None, None).expect("as before");
        assert!(*mass <= lightest * (1.0 + 2e-6) && *inertia <= quickest * (1.0 + 2e-6), "{name}: {measures:?}");
        // The other measure, at this end, against a search within the same tolerance.
        let tolerance = 1.0 + END_TOLERANCE;
        let other = [
            least(Objective::inertia(), Some(lightest * tolerance), None).map(|found| found[1] / measures[0][1]),
            least(Objective::mass(), None, Some(quickest * tolerance))
                .map(|found| found[0] / measures[measures.len() - 1][0]),
        ];
        for ratio in other.into_iter().flatten() {
            assert!(ratio > 1.0 - 1e-4, "{name}: the other measure may be {ratio} times as large");
        }
    }
}

#[test]
fn bounds_that_leave_no_way_are_named() {
    let bare = family_machine("nine-link-bare");
    let mut asked = weighing(&bare, Objective::mass());
    asked.sites.iter_mut().for_each(|site| site.most = 1.0);
    let why = place_weights(&bare, &asked).expect_err("too little");
    let CounterweightError::Conflict { bounds, reliefs: would } = why else { panic!("{why:?}") };
    let [BoundRelaxation::Most(relief)] = would.concat()[..] else { panic!("{would:?}") };
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
        place_weights(&bare, &asked)
    };
    for bound in &bounds {
        assert!(without(bound).is_ok(), "{bound}");
    }
    asked.sites.iter_mut().for_each(|site| site.most = relief);
    assert!(place_weights(&bare, &asked).is_ok(), "up to {relief} kg");
    asked.sites.iter_mut().for_each(|site| site.most = relief * (1.0 - 1e-3));
    assert!(place_weights(&bare, &asked).is_err());
}

#[test]
fn what_cannot_be_is_refused() {
    let bare = family_machine("nine-link-bare");
    let asked = weighing(&bare, Objective::mass());
    let words = |asked: &CounterweightSpec| place_weights(&bare, asked).expect_err("it cannot be").to_string();
    let mut twice = asked.clone();
    twice.sites.push(twice.sites[0]);
    assert!(words(&twice).contains("one a link"));
    let with = |change: &dyn Fn(&mut CounterweightSpec)| {
        let mut asked = asked.clone();
        change(&mut asked);
        words(&asked)
    };
    assert!(with(&|a| a.stock.density = 0.0).contains("density"));
    assert!(with(&|a| a.stock.thickness = f64::NAN).contains("thickness"));
    assert!(with(&|a| a.sites[2].to = -1.0).contains("link 3"));
    for most in [-1.0, 0.0, f64::NAN] {
        assert!(with(&|a| a.sites[2].most = most).contains("link 3: at most"), "{most}");
    }
    assert!(with(&|a| a.sites[2].link = 20).contains("link number 20"));
    let why = with(&|a| a.sites.retain(|site| site.link != 1));
    assert!(why.contains("within these bounds: link 4: no further out"), "{why}");
    let why = with(&|a| a.sites.retain(|site| [0, 1, 2, 7].contains(&site.link)));
    assert!(why.contains("more links"), "{why}");
    assert!(with(&|a| a.sites.truncate(1)).contains("drive 2"));
    let slanted = bare.set("link.4.com_normal", "0.02").expect("in range");
    let why = place_weights(&slanted, &weighing(&slanted, Objective::mass())).expect_err("it cannot be");
    assert!(matches!(why, CounterweightError::OffAxis { .. }), "{why}");
    let geared = family_machine("serial-3r");
    let torque = Objective { torque: 1.0, accelerations: vec![1.0; 3], ..Objective::mass() };
    let why = place_weights(&geared, &weighing(&geared, torque)).expect_err("it cannot be");
    assert_eq!(why, CounterweightError::Coupled);
}

/// What no counterweight changes is told of machines of every size: a residual is large or small beside its own machine.
#[test]
fn what_nothing_changes_is_told_of_machines_of_every_size() {
    let slanted = family_machine("nine-link-bare").set("link.4.com_normal", "0.02").expect("in range");
    for size in [1e-3, 1.0, 10.0] {
        let mut spec = slanted.spec().clone();
        let mass = size * size * size;
        spec.lengths.values_mut().for_each(|length| *length *= size);
        for link in &mut spec.links {
            if let Length::Metres(length) = &mut link.length {
                *length *= size;
            }
            (link.mass, link.inertia) = (link.mass * mass, link.inertia * mass * size * size);
            (link.com, link.com_normal) = (link.com * size, link.com_normal * size);
        }
        let machine = Machine::new(spec).expect("a machine");
        let sites = CounterweightSite::anywhere(&machine);
        let why = place_weights(&machine, &CounterweightSpec::least(Objective::mass(), sites, STEEL));
        assert!(matches!(why, Err(CounterweightError::OffAxis { .. })), "{size}: {why:?}");
    }
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
    let objective = Objective { torque: 1.0, mass: 0.0, accelerations: accelerations.clone(), ..Objective::mass() };
    let least = place_weights(&bare, &weighing(&bare, objective)).expect("it can be balanced");
    assert!(
        (torque(&least.machine) - least.value).abs() < 1e-6 * least.value,
        "{} {}",
        torque(&least.machine),
        least.value
    );
    for other in [Objective::mass(), Objective::inertia()] {
        let other = place_weights(&bare, &weighing(&bare, other)).expect("it can be balanced");
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
    let fixed = machine.set("counterweight.2.fixed", "true").expect("a switch");
    assert!(fixed.spec().counterweights[1].fixed && !machine.spec().counterweights[1].fixed);
    assert_eq!(fixed.without_counterweights().expect("a machine").spec().counterweights.len(), 1);
    assert_eq!(parse(&to_toml(&fixed), "fixed.toml").expect("a machine"), fixed);
    let words = |key: &str, value: &str| machine.set(key, value).expect_err("no such setting").to_string();
    for number in ["0", "3", "01", "x"] {
        assert!(words(&format!("counterweight.{number}.mass"), "1").contains("want one of \"1\", \"2\""), "{number}");
        assert_eq!(machine.value(&format!("counterweight.{number}.mass")), None);
    }
    assert!(words("counterweight.1.fixed", "2").contains("true or false"));
    assert!(words("counterweight.1.mass", "0").contains("1e-15"), "{}", words("counterweight.1.mass", "0"));
    let keys = "counterweight.NUMBER.(mass|at|across|radius|inner_radius|half|turned|length|width|fixed)";
    assert!(words("counterweight.1.colour", "1").contains(keys), "{}", words("counterweight.1.colour", "1"));
}

/// What balances itself is given nothing.
#[test]
fn a_balanced_machine_is_left_alone() {
    let machine = builtin("nine-link").expect("built in");
    for objective in [Objective::mass(), Objective::inertia()] {
        let placed = place_weights(machine, &weighing(machine, objective)).expect("nothing to do");
        assert!(placed.added_mass < 1e-6 && placed.machine.spec().counterweights.is_empty(), "{}", placed.added_mass);
    }
    let points = front(machine, &weighing(machine, Objective::mass()), 5).expect("one point").points;
    let two = front(machine, &weighing(machine, Objective::mass()), 2).expect("one point").points;
    assert_eq!((points.len(), two.len()), (1, 1));
    assert!(points.iter().all(|placed| placed.added_mass < 1e-6));
}

/// How near the edge of a disc is to the middle of a pin of its link, m.
fn clear_of_pins(machine: &Machine) -> f64 {
    let of = |weight: &stillbase::mechanics::machine::Counterweight| {
        let j = machine.links().iter().position(|link| link.name == weight.link).expect("a link");
        let pins = machine.resolved_links()[j].pins.iter();
        pins.map(|pin| (pin - weight.at).abs() - weight.radius).fold(f64::INFINITY, f64::min)
    };
    machine.spec().counterweights.iter().map(of).fold(f64::INFINITY, f64::min)
}

/// Discs keep clear of pins; nearer pins never cost more, and of all choices between pins none is better.
#[test]
fn discs_keep_clear_of_pins_at_the_least_cost() {
    let bare = family_machine("nine-link-bare");
    for objective in [Objective::mass(), Objective::inertia(), Objective { mass: 0.05, ..Objective::inertia() }] {
        let free = place_weights(&bare, &weighing(&bare, objective.clone())).expect("it can be balanced");
        let mut last = free.value;
        for clearance in [0.0, 0.01, 0.03] {
            let asked = CounterweightSpec { clearance: Some(clearance), ..weighing(&bare, objective.clone()) };
            let found = place_weights(&bare, &asked).expect("it can be balanced");
            assert!(clear_of_pins(&found.machine) > clearance - 1e-6, "{}", clear_of_pins(&found.machine));
            assert!(Inertia::of(&found.machine).is_balanced() && found.gap < 1e-6, "{}", found.gap);
            assert!(found.value > last - 1e-7, "{} after {last}", found.value);
            last = found.value;
        }
        // Where no disc of the free answer covers a pin, nothing changes.
        let clear = clear_of_pins(&free.machine);
        if clear > 0.0 {
            let asked = CounterweightSpec { clearance: Some(0.99 * clear), ..weighing(&bare, objective) };
            assert!((place_weights(&bare, &asked).expect("the same").value - free.value).abs() < 1e-7);
        }
    }
}

/// All ways round the pins, one by one as bounds on the places, against those that the search looks at. A disc of a
/// known mass has a known radius, so masses are bounded by what their radius may be at most.
#[test]
fn a_search_round_the_pins_finds_what_trying_all_ways_finds() {
    let bare = family_machine("two-drive");
    let links = bare.links().len();
    let objective = Objective { mass: 0.1, ..Objective::inertia() };
    let mut noise = Noise::of(11);
    let mut compared = 0;
    for _ in 0..12 {
        let clearance = noise.between(0.0, 0.03);
        let asked = CounterweightSpec { clearance: Some(clearance), ..weighing(&bare, objective.clone()) };
        let found = place_weights(&bare, &asked).ok();
        // In every room of every link the widest disc that fits in with its centre on a grid of places.
        let rooms: Vec<Vec<[f64; 2]>> = (0..links)
            .map(|j| {
                let mut ends = vec![-10.0];
                ends.extend(&bare.resolved_links()[j].pins);
                ends.push(10.0);
                ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
            })
            .collect();
        let mut best = f64::INFINITY;
        let ways: usize = rooms.iter().map(Vec::len).product();
        for way in 0..ways {
            let mut rest = way;
            let room: Vec<[f64; 2]> = rooms
                .iter()
                .map(|of| {
                    let at = rest % of.len();
                    rest /= of.len();
                    of[at]
                })
                .collect();
            // Radii are not known before: they are found by going round, from none.
            let mut radii = vec![0.0; links];
            for _ in 0..60 {
                let mut tried = CounterweightSpec { clearance: None, ..asked.clone() };
                for (site, radius) in tried.sites.iter_mut().zip(&radii) {
                    let [from, to] = room[site.link];
                    site.from = site.from.max(from + clearance + radius);
                    site.to = site.to.min(to - clearance - radius);
                }
                tried.sites.retain(|site| site.from <= site.to);
                let Ok(placed) = place_weights(&bare, &tried) else { break };
                for radius in &mut radii {
                    *radius *= 0.5;
                }
                for weight in &placed.machine.spec().counterweights {
                    let j = bare.links().iter().position(|link| link.name == weight.link).expect("a link");
                    radii[j] += 0.5 * weight.radius;
                }
                if clear_of_pins(&placed.machine) > clearance - 1e-7 {
                    best = best.min(placed.value);
                }
            }
        }
        let Some(found) = found else {
            assert!(best.is_infinite(), "a way was missed: {best}");
            continue;
        };
        if best.is_finite() {
            compared += 1;
            assert!(found.value < best + 1e-6, "{} against {best}", found.value);
            assert!(found.value > best * (1.0 - 0.02), "{} against {best}", found.value);
        }
    }
    assert!(compared > 3, "{compared}");
}

/// One disc between two pins, as near to the one behind it as it may be: x = c + κ √(S/x), where S is what it has to
/// balance; and, with more to balance, as near to the pin before it: x = L − c − κ √(S/x).
#[test]
fn a_disc_between_two_pins_touches_where_the_closed_form_says() {
    let (length, clearance) = (0.5, 0.01);
    // Radius of 1 kg of the disc.
    let spread = (1.0 / (std::f64::consts::PI * 7850.0 * 0.03)).sqrt();
    for (com, from_behind) in [(-0.4, true), (-2.7, false)] {
        let text = format!(
            "name = \"two\"\n[[drive]]\nname = \"1\"\n[[drive]]\nname = \"2\"\n\
             [[link]]\nname = \"1\"\ndrive = \"1\"\nattach = \"base\"\nlength = {length}\nmass = 1.0\n\
             inertia = 0.01\ncom = {com}\n\
             [[link]]\nname = \"2\"\ndrive = \"2\"\nattach = {{ link = \"1\", at = \"tip\" }}\nlength = 0.3\n\
             mass = 0.2\ninertia = 0.01\ncom = 0.0\n[end_effector]\nlink = \"2\"\n"
        );
        let machine = parse(&text, "two").expect("a machine");
        let moment = -(com + 0.2 * length);
        let mut asked = weighing(&machine, if from_behind { Objective::inertia() } else { Objective::mass() });
        asked.sites.retain(|site| site.link == 0);
        // In the second case no further than the pin at the tip.
        asked.sites.iter_mut().for_each(|site| (site.from, site.to) = (-0.45, if from_behind { 1.0 } else { length }));
        asked.clearance = Some(clearance);
        let found = place_weights(&machine, &asked).expect("it can be balanced");
        let mut at = 0.25;
        for _ in 0..200 {
            let radius = spread * (moment / at).sqrt();
            let touches = if from_behind { clearance + radius } else { length - clearance - radius };
            at += 0.5 * (touches - at);
        }
        let weight = &found.machine.spec().counterweights[0];
        assert!((weight.at - at).abs() < 1e-5, "com {com}: at {} instead of {at}", weight.at);
        assert!((weight.mass - moment / at).abs() < 1e-4 * weight.mass, "com {com}: {} kg", weight.mass);
    }
}

#[test]
fn a_clearance_that_leaves_no_way_says_which_would_do() {
    let bare = family_machine("nine-link-bare");
    let asked = CounterweightSpec { clearance: Some(0.25), ..weighing(&bare, Objective::mass()) };
    let why = place_weights(&bare, &asked).expect_err("too far");
    let CounterweightError::Reaches { reliefs: would, .. } = why else { panic!("{why}") };
    let [BoundRelaxation::Clearance(would)] = would.concat()[..] else { panic!("{would:?}") };
    let with = |clearance| place_weights(&bare, &CounterweightSpec { clearance: Some(clearance), ..asked.clone() });
    assert!(with(would).is_ok() && with(would + 1e-4).is_err(), "{would}");
}

/// Over a range of payloads nothing within the bounds has a smaller worst residual, and nothing with the same is lighter.
#[test]
fn a_range_of_payloads_leaves_the_least_worst_residual() {
    let bare = family_machine("nine-link-bare");
    let range = [0.0, 0.3];
    let asked = CounterweightSpec { payload: Some(range), ..weighing(&bare, Objective::mass()) };
    let found = place_weights(&bare, &asked).expect("it can be balanced");
    let curve = over_payloads(&found.machine, range, 7).expect("it holds them");
    // A payload of half the range on links of lengths L_k: half the range times the longest, and the two longest.
    let lengths: Vec<f64> = bare.end_effector().iter().take(3).map(|length| length.abs()).collect();
    let longest = lengths.iter().fold(0.0_f64, |most, x| most.max(*x));
    for end in [curve[0], curve[6]] {
        assert!(end.force < 0.15 * longest + 1e-7, "{end:?}");
    }
    // Balance in the middle has the same worst residual, and is dearer.
    let alone =
        place_weights(&bare.set("payload.mass", "0.15").expect("in range"), &weighing(&bare, Objective::mass()));
    let alone = alone.expect("it can be balanced");
    assert!(found.added_mass < alone.added_mass - 0.1, "{} and {}", found.added_mass, alone.added_mass);
    let middle = over_payloads(&alone.machine, range, 7).expect("it holds them");
    assert!((middle[0].force - 0.15 * longest).abs() < 1e-7 && middle[3].force < 1e-12, "{middle:?}");

    // Too little mass to balance it: worse residuals with less mass, and exact again from what would do on.
    let mut last = f64::INFINITY;
    for most in [0.4, 0.8, 1.6, 3.2, 20.0] {
        let mut tight = asked.clone();
        tight.sites.iter_mut().for_each(|site| site.most = most);
        let found = place_weights(&bare, &tight).expect("as near as it can be");
        let reach: f64 = lengths.iter().sum();
        let worst = over_payloads(&found.machine, range, 2).expect("it holds them");
        let worst = worst.iter().map(|at| at.force.max(at.coupling / reach)).fold(0.0, f64::max);
        assert!(worst < last + 1e-9, "{most} kg: {worst} after {last}");
        last = worst;
        // Random changes within the bounds do no better.
        let mut noise = Noise::of(3);
        for _ in 0..200 {
            let mut spec = found.machine.spec().clone();
            for weight in &mut spec.counterweights {
                weight.mass = (weight.mass * noise.between(0.9, 1.1)).min(most);
                let j = bare.links().iter().position(|link| link.name == weight.link).expect("a link");
                weight.at = (weight.at + noise.between(-0.01, 0.01)).clamp(-0.3, bare.resolved_links()[j].length);
            }
            let changed = Machine::new(spec).expect("in range");
            let changed = over_payloads(&changed, range, 2).expect("it holds them");
            assert!(changed.iter().map(|at| at.force.max(at.coupling / reach)).fold(0.0, f64::max) > worst - 1e-6);
        }
    }
    assert!((last - 0.15 * longest).abs() < 1e-6, "{last}");
}

/// What is left over payloads does not depend on what is minimised after it, |D_k| neither.
#[test]
fn a_range_of_payloads_leaves_the_same_with_every_objective() {
    let bare = family_machine("nine-link-bare");
    let range = [0.0, 0.3];
    let worst = |objective: Objective| {
        let asked = CounterweightSpec { payload: Some(range), ..weighing(&bare, objective) };
        let found = place_weights(&bare, &asked).expect("it can be balanced");
        let curve = over_payloads(&found.machine, range, 2).expect("it holds them");
        curve.iter().map(|at| at.force.max(at.coupling / bare.reach())).fold(0.0, f64::max)
    };
    let least = worst(Objective::mass());
    for objective in [Objective::inertia(), Objective { momentum: 1.0, mass: 0.5, ..Objective::mass() }] {
        let other = worst(objective);
        assert!((other - least).abs() < 1e-6, "{other}, want {least}");
    }
}

/// A rotor that turns the other way takes what its drive gives to the base; a bound on it leaves the rest.
#[test]
fn rotors_that_turn_the_other_way_take_momentum_away() {
    let bare = family_machine("nine-link-bare");
    let with = bare.set("drive.1.rotor.inertia", "0.01").and_then(|m| m.set("drive.1.rotor.ratio", "-20"));
    let geared = with.expect("in range");
    let objective = || Objective { momentum: 1.0, mass: 1e-3, ..Objective::mass() };
    let free = |parameter| CounterweightSpec {
        rotors: vec![FreeRotor { drive: 0, parameter }],
        ..weighing(&geared, objective())
    };
    let alone = place_weights(&bare, &weighing(&bare, objective())).expect("it can be balanced");
    for freedom in [RotorFreedom::Inertia([0.0, 1.0]), RotorFreedom::Ratio([-1000.0, 0.0])] {
        let found = place_weights(&geared, &free(freedom)).expect("it can be balanced");
        let inertia = Inertia::of(&found.machine);
        assert!(inertia.is_balanced() && found.gap < 1e-6, "{}", found.gap);
        assert!(inertia.momentum(0).abs() < 1e-6, "{:?}: {}", freedom, inertia.momentum(0));
        let rotor = found.machine.spec().drives[0].rotor.expect("one");
        match freedom {
            RotorFreedom::Inertia(_) => assert!(rotor.ratio == -20.0),
            RotorFreedom::Ratio(_) => assert!(rotor.inertia == 0.01),
        }
        assert!(found.value < alone.value);
        let refused = front(&geared, &free(freedom), 4).expect_err("two measures");
        assert_eq!(refused, CounterweightError::FreeRotorOfFront("1".into()));
    }
    // At its bound, and no further.
    let found = place_weights(&geared, &free(RotorFreedom::Inertia([0.0, 0.004]))).expect("it can be balanced");
    assert!((found.machine.spec().drives[0].rotor.expect("one").inertia - 0.004).abs() < 1e-7);
    // What only its gear makes heavy is not wanted: the least that drives turn is none of it.
    let least = CounterweightSpec { objective: Objective::inertia(), ..free(RotorFreedom::Inertia([0.0, 1.0])) };
    let found = place_weights(&geared, &least).expect("it can be balanced");
    assert!(found.machine.spec().drives[0].rotor.is_none_or(|rotor| rotor.inertia < 1e-8));
    // One with its stator on another drive.
    let serial = family_machine("serial-3r");
    let asked = CounterweightSpec {
        rotors: vec![FreeRotor { drive: 1, parameter: RotorFreedom::Ratio([-300.0, 300.0]) }],
        ..weighing(&serial, objective())
    };
    let found = place_weights(&serial, &asked).expect("it can be balanced");
    assert!(Inertia::of(&found.machine).is_balanced() && found.gap < 1e-6, "{}", found.gap);
    for ratio in [-290.0, -50.0, -1.0, 50.0, 290.0] {
        let fixed = CounterweightSpec {
            rotors: vec![FreeRotor { drive: 1, parameter: RotorFreedom::Ratio([ratio, ratio]) }],
            ..weighing(&serial, objective())
        };
        assert!(place_weights(&serial, &fixed).expect("it can be balanced").value > found.value - 1e-6);
    }
    let none = CounterweightSpec {
        rotors: vec![FreeRotor { drive: 1, parameter: RotorFreedom::Ratio([-3.0, 3.0]) }],
        ..weighing(&bare, Objective::mass())
    };
    assert_eq!(place_weights(&bare, &none).expect_err("it has none"), CounterweightError::NoRotor("2".into()));
}

/// What is said to do does, and a little less does not: Σ D_k, and all masses together.
#[test]
fn what_would_do_does() {
    let bare = family_machine("nine-link-bare");
    let with = |max_added_mass, max_inertia| {
        place_weights(&bare, &CounterweightSpec { max_added_mass, max_inertia, ..weighing(&bare, Objective::mass()) })
    };
    let would = |why| match why {
        Err(CounterweightError::Conflict { reliefs, .. }) => reliefs.concat(),
        other => panic!("{other:?}"),
    };
    let [BoundRelaxation::Inertia(least)] = would(with(None, Some(1.5)))[..] else { panic!("not of inertia") };
    assert!((least - 1.798_401_1).abs() < 2e-6 && with(None, Some(least)).is_ok());
    let [BoundRelaxation::Mass(least)] = would(with(Some(5.0), None))[..] else { panic!("not of mass") };
    assert!((least - 9.572_666_7).abs() < 2e-6 && with(Some(least), None).is_ok());
    assert!(BoundRelaxation::Inertia(least).to_string().contains(&format!("{least:.6}")));
}

/// A question with what would do in the place of its own bounds, as it is printed.
fn relieved(asked: &CounterweightSpec, together: &[BoundRelaxation]) -> CounterweightSpec {
    let mut asked = asked.clone();
    for relief in together {
        let said = relief.to_string();
        let number = said.split(' ').find_map(|word| word.parse::<f64>().ok()).expect("a number");
        match relief {
            BoundRelaxation::Most(_) => {
                asked.sites.iter_mut().filter(|site| site.most.is_finite()).for_each(|site| site.most = number);
            }
            BoundRelaxation::Mass(_) => asked.max_added_mass = Some(number),
            BoundRelaxation::Inertia(_) => asked.max_inertia = Some(number),
            BoundRelaxation::Clearance(_) => asked.clearance = Some(number),
            BoundRelaxation::Across(_) => asked.sites.iter_mut().for_each(|site| site.across = number),
        }
    }
    asked
}

/// With bounds of several kinds each proposal holds with all others as they are; where none does alone, several are said
/// together, and do, and no single one would.
#[test]
fn what_would_do_does_with_bounds_of_several_kinds() {
    let [alone, several] = bounds_of_several_kinds(24, 31);
    assert!(alone > 2 && several > 1, "{alone} {several}");
}

#[test]
#[ignore = "takes a minute"]
fn what_would_do_does_with_many_bounds_of_several_kinds() {
    let [alone, several] = bounds_of_several_kinds(1300, 32);
    assert!(alone + several > 300 && several > 60, "{alone} {several}");
}

/// How often one bound alone could give way, and how often only several together.
fn bounds_of_several_kinds(count: usize, seed: u64) -> [usize; 2] {
    let mut noise = Noise::of(seed);
    let (mut alone, mut several) = (0, 0);
    for i in 0..count {
        let bare = family_machine(if i % 2 == 0 { "nine-link-bare" } else { "two-drive" });
        let mut asked = weighing(&bare, Objective::mass());
        let size = if i % 2 == 0 { 1.0 } else { 0.3 };
        let mut is_set = || noise.between(0.0, 1.0) < 0.5;
        let [most, mass, inertia, clearance, payload] = [(); 5].map(|()| is_set());
        if most {
            let to = size * noise.between(0.3, 4.0);
            asked.sites.iter_mut().for_each(|site| site.most = to);
        }
        asked.max_added_mass = mass.then(|| size * noise.between(2.0, 14.0));
        asked.max_inertia = inertia.then(|| size * noise.between(0.3, 2.5));
        asked.clearance = (clearance && i % 2 == 1).then(|| noise.between(0.0, 0.2));
        asked.payload = payload.then(|| [0.0, size * noise.between(0.1, 0.5)]);
        let would = match place_weights(&bare, &asked) {
            Ok(_) => continue,
            Err(CounterweightError::Conflict { reliefs, .. } | CounterweightError::Reaches { reliefs, .. }) => reliefs,
            Err(why) => panic!("{why}"),
        };
        assert!(!would.is_empty(), "{asked:?}");
        for together in &would {
            let with = relieved(&asked, together);
            if let Err(why) = place_weights(&bare, &with) {
                panic!("{together:?}: {why}");
            }
        }
        if would[0].len() > 1 {
            several += 1;
        } else {
            alone += 1;
        }
    }
    [alone, several]
}

/// A rotor that turns the other way may take more than there is: then more inertia brings D_k back to zero, and what is
/// found is certified. Random machines that are balanced, too, give no less to the base.
#[test]
fn momenta_below_zero_are_the_least_there_are() {
    let mut noise = Noise::of(33);
    for ratio in ["-60", "-150", "-400"] {
        let bare = family_machine("two-drive");
        let with = [("drive.1.rotor.inertia", "0.002"), ("drive.1.rotor.ratio", ratio)];
        let geared = bare.set_all(with).expect("in range");
        let objective = Objective { momentum: 1.0, mass: 1e-3, ..Objective::mass() };
        let found = place_weights(&geared, &weighing(&geared, objective)).expect("it can be balanced");
        assert!(found.is_certified(), "{}", found.gap);
        let worth = |machine: &Machine, added: f64| {
            Inertia::of(machine).momenta().iter().map(|d| d.abs()).sum::<f64>() + 1e-3 * added
        };
        assert!((worth(&found.machine, found.added_mass) - found.value).abs() < 1e-9);
        let mut tried = 0;
        for _ in 0..40 {
            let mut asked = weighing(&geared, Objective { mass: noise.between(0.0, 1.0), ..Objective::inertia() });
            for site in &mut asked.sites {
                site.from = noise.between(-0.3, 0.1);
                site.to = site.from + noise.between(0.0, site.to - site.from);
            }
            // More than is needed, as heavy as it comes.
            let Ok(other) = place_weights(&geared, &asked) else { continue };
            tried += 1;
            assert!(worth(&other.machine, other.added_mass) > found.value - 1e-6, "{ratio}");
        }
        assert!(tried > 3, "{tried}");
    }
}

/// Where more inertia brings a negative D_k back, discs grow, and still keep clear of pins.
#[test]
fn discs_that_bring_momenta_back_keep_clear_of_pins() {
    for ratio in ["-60", "-150", "-400"] {
        let with = [("drive.1.rotor.inertia", "0.002"), ("drive.1.rotor.ratio", ratio)];
        let geared = family_machine("two-drive").set_all(with).expect("in range");
        let objective = Objective { momentum: 1.0, mass: 1e-3, ..Objective::mass() };
        let free = place_weights(&geared, &weighing(&geared, objective.clone())).expect("it can be balanced");
        for clearance in [0.0, 0.01, 0.03] {
            let asked = CounterweightSpec { clearance: Some(clearance), ..weighing(&geared, objective.clone()) };
            let found = place_weights(&geared, &asked).expect("it can be balanced");
            let gap = clear_of_pins(&found.machine);
            assert!(gap > clearance - 1e-6, "{ratio}, {clearance} m: {gap} m");
            assert!(found.value > free.value - free.gap - 1e-6, "{} below {}", found.value, free.value);
        }
    }
}

/// To first order what is left at worst is what the worst of all corners leaves.
#[test]
fn counterweights_that_are_off_leave_at_worst_what_the_worst_corner_leaves() {
    let bare = family_machine("two-drive");
    let machine = place_weights(&bare, &weighing(&bare, Objective::inertia())).expect("it can be balanced").machine;
    let tolerance = PlacementTolerance { mass: 1e-5, place: 1e-7 };
    let said = worst_residual(&machine, &tolerance);
    let n = machine.spec().counterweights.len();
    let (mut force, mut coupling) = (0.0_f64, 0.0_f64);
    for corner in 0..1_usize << (2 * n) {
        let sign = |bit: usize| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let mut spec = machine.spec().clone();
        for (i, weight) in spec.counterweights.iter_mut().enumerate() {
            weight.mass *= 1.0 + sign(2 * i) * tolerance.mass;
            weight.at += sign(2 * i + 1) * tolerance.place;
        }
        let inertia = Inertia::of(&Machine::new(spec).expect("in range"));
        force = (0..2).map(|k| inertia.first_moment(k).norm()).fold(force, f64::max);
        coupling = coupling.max(inertia.coupling(0, 1).norm());
    }
    assert!((said.force / force - 1.0).abs() < 1e-4, "{} against {force}", said.force);
    assert!((said.coupling / coupling - 1.0).abs() < 1e-4, "{} against {coupling}", said.coupling);
}

/// Equal steps along the curve: no part of it is left out.
#[test]
fn the_points_of_a_front_are_spread() {
    let bare = family_machine("nine-link-bare");
    let points = front(&bare, &weighing(&bare, Objective::mass()), 25).expect("it can be balanced").measures();
    let size = [0, 1].map(|i| (points[24][i] - points[0][i]).abs());
    for pair in points.windows(2) {
        let apart = [0, 1].map(|i| (pair[1][i] - pair[0][i]) / size[i]);
        assert!(apart[0].hypot(apart[1]) < 2.5 / 24.0, "{pair:?}");
    }
}

/// A disc of a mass has a radius, one of that radius the mass: area by thickness by density.
#[test]
fn discs_weigh_what_their_volume_does() {
    let mut noise = Noise::of(91);
    for _ in 0..20 {
        let disc = CounterweightStock::discs(noise.between(1e3, 2e4), noise.between(1e-3, 0.1));
        let radius = noise.between(1e-3, 0.5);
        let mass = std::f64::consts::PI * radius * radius * disc.thickness * disc.density;
        let shape = CounterweightShape::Disc { radius };
        assert!((disc.mass(shape) - mass).abs() < 1e-12 * mass);
        assert!((disc.shape(mass).reach()[0] - radius).abs() < 1e-12);
    }
}

/// What an answer says it comes to is what its machine comes to: Σ H_kk from the mass matrix in a pose, |D_k|, the torques.
#[test]
fn the_value_is_that_of_the_machine() {
    let bare = family_machine("nine-link-bare");
    let accelerations = vec![12.0, 30.0, 45.0];
    for [mass, inertia, momentum, torque] in
        [[0.3, 0.0, 0.0, 0.0], [2.5, 0.7, 0.0, 0.0], [0.4, 0.0, 1.5, 0.0], [0.2, 0.3, 0.0, 0.05]]
    {
        let objective = Objective { mass, inertia, momentum, torque, accelerations: accelerations.clone() };
        let found = place_weights(&bare, &weighing(&bare, objective)).expect("it can be balanced");
        let (q, still) = (PerDrive::from_fn(3, |k| 0.4 + k as f64), PerDrive::from_fn(3, |_| 0.0));
        let (h, _) = mass_matrix(&Inertia::of(&found.machine), &DriveAngles(q).units(), &still);
        let added: f64 = found.machine.spec().counterweights.iter().map(|weight| weight.mass).sum();
        let turned: f64 = (0..3).map(|k| h.get(k, k)).sum();
        // Without rotors D_k is a row sum of H.
        let momenta: f64 = (0..3).map(|k| (0..3).map(|l| h.get(k, l)).sum::<f64>().abs()).sum();
        let torques = (0..3).map(|k| h.get(k, k) * accelerations[k]).fold(0.0, f64::max);
        let want = mass * added + inertia * turned + momentum * momenta + torque * torques;
        assert!((found.value - want).abs() < 1e-9 * want, "{}, want {want}", found.value);
        assert!((found.added_mass - added).abs() < 1e-12 * added);
    }
}

/// The best gear is no worse than any other one, where the turning of the drives counts: a rotor whose stator is on another drive makes H of
/// that drive heavier, too.
#[test]
fn no_other_gear_comes_to_less() {
    let serial = family_machine("serial-3r");
    let asked = |ratios: [f64; 2]| {
        let objective = Objective { momentum: 1.0, mass: 1e-2, inertia: 0.1, ..Objective::mass() };
        CounterweightSpec {
            rotors: vec![FreeRotor { drive: 1, parameter: RotorFreedom::Ratio(ratios) }],
            ..weighing(&serial, objective)
        }
    };
    let found = place_weights(&serial, &asked([-300.0, 300.0])).expect("it can be balanced");
    let inertia = Inertia::of(&found.machine);
    assert!(found.gap < 1e-4 && inertia.is_balanced(), "{}", found.gap);
    let added: f64 = found.machine.spec().counterweights.iter().map(|weight| weight.mass).sum();
    let momenta: f64 = inertia.momenta().iter().map(|d| d.abs()).sum();
    let (q, still) = (PerDrive::from_fn(3, |k| 0.4 + k as f64), PerDrive::from_fn(3, |_| 0.0));
    let (h, _) = mass_matrix(&inertia, &DriveAngles(q).units(), &still);
    let want = momenta + 1e-2 * added + 0.1 * (0..3).map(|k| h.get(k, k)).sum::<f64>();
    assert!((found.value - want).abs() < 1e-6 * want, "{}, want {want}", found.value);
    for ratio in [-200.0, 1.0, 100.0] {
        let other = place_weights(&serial, &asked([ratio; 2])).expect("it can be balanced");
        let least = found.value - found.gap - 1e-9;
        assert!(other.value > least, "{ratio}: {} below {}", other.value, found.value);
    }
}
