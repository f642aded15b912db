//! Kept balanced: against `design`, against other machines that are balanced too, and what stands in the way.

use stillbase::mechanics::balance::{
    BodyQuantity, LimitSide, ListedParameter, Parameter, ParameterBounds, Preset, RebalanceError, RebalanceRequest,
    RebalancedMachine, design, rebalance,
};
use stillbase::mechanics::machine::{Inertia, Machine, builtin, parse, to_toml};
use stillbase::settings::word::Choice;

use crate::support::random::with_counterweights;
use crate::support::{Noise, family_machine};

fn nine_link() -> &'static Machine {
    builtin("nine-link").expect("built in")
}

fn balanced(machine: &Machine) -> bool {
    let inertia = Inertia::of(machine);
    inertia.is_force_balanced() && inertia.is_invariant()
}

fn find(machine: &Machine, key: &str) -> Parameter {
    Parameter::all(machine).into_iter().find(|p| p.key(machine) == key).unwrap_or_else(|| panic!("no {key}"))
}

/// Measured from zero it is what `design` finds, for any penalties and masses.
#[test]
fn from_zero_it_is_the_design() {
    let mut noise = Noise::of(21);
    let table_1 = builtin("nine-link-table-1").expect("built in");
    for i in 0..60 {
        let masses: Vec<(String, String)> =
            (1..10).map(|j| (format!("link.{j}.mass"), noise.between(0.2, 6.0).to_string())).collect();
        let machine = table_1.set_all(masses.iter().map(|(k, v)| (k.as_str(), v.as_str()))).expect("valid");
        let penalty = match Preset::ALL.get(i) {
            Some(preset) => preset.penalty(9).expect("nine links"),
            None => (0..9).map(|_| noise.between(0.2, 5.0)).collect(),
        };
        let mut asked = RebalanceRequest::coms(&machine, &penalty);
        asked.parameters.iter_mut().for_each(|one| one.from = 0.0);
        let designed = design(&machine, &penalty).expect("it can be balanced");
        let kept = rebalance(&machine, &asked).expect("it can be balanced");
        let mut cost = 0.0;
        for (j, link) in designed.links().iter().enumerate() {
            assert!((link.com - kept.values[j]).abs() < 1e-13, "{} and {}", link.com, kept.values[j]);
            cost += (penalty[j] * link.com).powi(2);
        }
        assert!((cost - kept.cost).abs() < 1e-12 * cost);
    }
}

/// What is balanced stays as it is, to the last digits.
#[test]
fn nothing_changes_where_nothing_has_to() {
    for name in ["two-drive-balanced", "four-drive-balanced", "nine-link-geared-balanced", "serial-3r-balanced"] {
        let machine = family_machine(name);
        let mut asked = RebalanceRequest::coms(&machine, &vec![1.0; machine.links().len()]);
        for parameter in Parameter::all(&machine) {
            asked.set_bounds(&machine, parameter, ParameterBounds::Free);
        }
        let kept = rebalance(&machine, &asked).expect("it is balanced");
        assert!(kept.cost < 1e-16, "{name}: {}", kept.cost);
        let again = rebalance(&kept.machine, &asked.clone().measured_from(&kept.machine)).expect("it is balanced");
        for (a, b) in kept.values.iter().zip(&again.values) {
            assert!((a - b).abs() < 1e-14, "{name}");
        }
    }
}

/// Some parameters of a machine, each held somehow.
fn anything(noise: &mut Noise, machine: &Machine, reach: f64) -> RebalanceRequest {
    let mut asked = RebalanceRequest::default();
    for parameter in Parameter::all(machine) {
        let value = parameter.value(machine.spec()).expect("one of its own");
        let (low, high) = (reach * noise.between(0.0, 1.0), reach * noise.between(0.0, 1.0));
        let (least, most) = match parameter.quantity {
            BodyQuantity::Mass => (value * (1.0 - low.min(0.99)), value * (1.0 + 4.0 * high)),
            BodyQuantity::Along | BodyQuantity::Across => (value - low, value + high),
        };
        let bounds = match noise.between(0.0, 10.0) as usize {
            0 => continue,
            1 => ParameterBounds::Fixed,
            2..6 => ParameterBounds::Within([least, most]),
            _ => ParameterBounds::Free,
        };
        let from = value + if noise.between(0.0, 1.0) < 0.3 { noise.between(0.0, 0.05) } else { 0.0 };
        asked.parameters.push(ListedParameter { parameter, bounds, penalty: noise.between(0.3, 3.0), from });
    }
    asked
}

/// Σ (p Δ)² of values.
fn cost(asked: &RebalanceRequest, values: &[f64]) -> f64 {
    assert_eq!(asked.parameters.len(), values.len());
    let all = asked.parameters.iter().zip(values).filter(|(one, _)| one.bounds != ParameterBounds::Fixed);
    all.map(|(one, value)| (one.penalty * (value - one.from)).powi(2)).sum()
}

#[track_caller]
fn within_what_is_asked(machine: &Machine, asked: &RebalanceRequest, kept: &RebalancedMachine) {
    assert!(balanced(&kept.machine), "{:?}", Inertia::of(&kept.machine).force_residual());
    let mut same = machine.spec().clone();
    for (one, value) in asked.parameters.iter().zip(&kept.values) {
        let now = one.parameter.value(kept.machine.spec()).expect("still there");
        assert_eq!(now, *value);
        match one.bounds {
            ParameterBounds::Fixed => assert_eq!(one.parameter.value(machine.spec()), Some(now)),
            ParameterBounds::Within([low, high]) => assert!((low..=high).contains(&now), "{low} {now} {high}"),
            ParameterBounds::Free => {
                let (is, was) = (one.from, one.parameter.value(machine.spec()).expect("one of its own"));
                let usual = match one.parameter.quantity {
                    BodyQuantity::Mass => [was.min(is / 10.0), was.max(is * 10.0)],
                    _ => {
                        let way = 10.0 * machine.reach().max(1.0);
                        [was.min(is - way), was.max(is + way)]
                    }
                };
                assert!((usual[0]..=usual[1]).contains(&now), "{usual:?} {now}");
            }
        }
        // What may change as it has, all else must be as it was.
        match (one.parameter.body, one.parameter.quantity) {
            (stillbase::mechanics::balance::Body::Link(j), BodyQuantity::Mass) => same.links[j].mass = now,
            (stillbase::mechanics::balance::Body::Link(j), BodyQuantity::Along) => same.links[j].com = now,
            (stillbase::mechanics::balance::Body::Link(j), BodyQuantity::Across) => same.links[j].com_normal = now,
            (stillbase::mechanics::balance::Body::Counterweight(i), BodyQuantity::Mass) => {
                let (disc, was) = (kept.machine.spec().counterweights[i].radius, same.counterweights[i].radius);
                let grown = (now / same.counterweights[i].mass).sqrt();
                assert!((disc - was * grown).abs() < 1e-12, "the plate keeps its thickness");
                same.counterweights[i].mass = now;
                same.counterweights[i].radius = disc;
            }
            (stillbase::mechanics::balance::Body::Counterweight(i), BodyQuantity::Along) => {
                same.counterweights[i].at = now;
            }
            (stillbase::mechanics::balance::Body::Counterweight(i), BodyQuantity::Across) => {
                same.counterweights[i].across = now;
            }
            _ => panic!("a payload is given"),
        }
    }
    assert_eq!(kept.machine, Machine::new(same).expect("a machine"));
    // What it takes by key makes the same machine.
    let settings = kept.settings(machine);
    let typed: Vec<(String, String)> = settings.iter().map(|(key, value)| (key.clone(), value.to_string())).collect();
    let again = machine.set_all(typed.iter().map(|(key, value)| (key.as_str(), value.as_str()))).expect("valid");
    assert_eq!(again, kept.machine);
}

/// Random machines, parameters, bounds: balanced, within bounds, and dearer wherever else it is balanced.
#[test]
fn nothing_else_that_is_asked_for_is_cheaper() {
    let mut noise = Noise::of(22);
    let (mut found, mut refused, mut others) = (0, 0, 0);
    for _ in 0..30 {
        let machine = with_counterweights(&mut noise);
        let asked = anything(&mut noise, &machine, 1.5);
        let kept = match rebalance(&machine, &asked) {
            Ok(kept) => kept,
            Err(RebalanceError::Conflict { .. } | RebalanceError::Inconsistent { .. } | RebalanceError::NoMass) => {
                refused += 1;
                continue;
            }
            Err(why) => panic!("{why}\n{}\n{asked:?}", to_toml(&machine)),
        };
        found += 1;
        within_what_is_asked(&machine, &asked, &kept);
        assert!((cost(&asked, &kept.values) - kept.cost).abs() < 1e-9 * (1e-3 + kept.cost));
        for _ in 0..4 {
            // The answer to another question is balanced within the same bounds.
            let mut other = asked.clone();
            for one in &mut other.parameters {
                one.penalty = noise.between(0.1, 10.0);
                if one.parameter.quantity != BodyQuantity::Mass {
                    one.from += noise.between(-0.1, 0.1);
                }
            }
            let Ok(elsewhere) = rebalance(&machine, &other) else { continue };
            others += 1;
            let dearer = cost(&asked, &elsewhere.values);
            assert!(dearer > kept.cost - 1e-9 * (1e-3 + kept.cost), "{dearer} and {}", kept.cost);
        }
    }
    assert!(found > 6 && refused > 3 && others > 20, "{found} {refused} {others}");
}

/// To change more is never dearer, with masses and places of the same bodies, on any machine.
#[test]
fn a_mass_that_may_change_makes_nothing_worse() {
    let [tried, cheaper] = masses_that_may_change(24, 24);
    assert!(tried > 6 && cheaper > 4, "{tried} {cheaper}");
}

#[test]
fn a_mass_that_may_change_makes_nothing_worse_of_many_machines() {
    let [tried, cheaper] = masses_that_may_change(600, 25);
    assert!(tried > 200 && cheaper > 160, "{tried} {cheaper}");
}

/// How many machines are balanced with their masses as they are, and how often one that may change makes it cheaper.
fn masses_that_may_change(count: usize, seed: u64) -> [usize; 2] {
    let mut noise = Noise::of(seed);
    let (mut tried, mut cheaper) = (0, 0);
    for i in 0..count {
        let machine = if i % 3 == 0 { family_machine("nine-link-bare") } else { with_counterweights(&mut noise) };
        let penalty: Vec<f64> = machine.links().iter().map(|_| noise.between(0.3, 3.0)).collect();
        let asked = RebalanceRequest::coms(&machine, &penalty);
        let Ok(none) = rebalance(&machine, &asked) else { continue };
        tried += 1;
        let mut more = asked.clone();
        for _ in 0..2 {
            let j = noise.between(0.0, machine.links().len() as f64 - 1e-9) as usize;
            more.set_bounds(
                &machine,
                Parameter::new(stillbase::mechanics::balance::Body::Link(j), BodyQuantity::Mass),
                ParameterBounds::Free,
            );
            let kept = rebalance(&machine, &more).expect("nothing has to change");
            within_what_is_asked(&machine, &more, &kept);
            assert!(kept.cost <= none.cost * (1.0 + 1e-9) + 1e-15, "{} and {}", kept.cost, none.cost);
            assert!((cost(&more, &kept.values) - kept.cost).abs() <= 1e-12 * kept.cost);
            assert!(!kept.certified && none.certified);
            cheaper += usize::from(kept.cost < 0.99 * none.cost);
        }
    }
    [tried, cheaper]
}

/// A question with only these limits left; every other parameter that is listed goes anywhere.
fn only(asked: &RebalanceRequest, limits: &[(Parameter, LimitSide, f64)]) -> RebalanceRequest {
    let mut only = asked.clone();
    for one in &mut only.parameters {
        let end = |side| limits.iter().find(|l| l.0 == one.parameter && l.1 == side).map(|l| l.2);
        let least = if one.parameter.quantity == BodyQuantity::Mass { 0.0 } else { -1e3 };
        one.bounds =
            ParameterBounds::Within([end(LimitSide::Least).unwrap_or(least), end(LimitSide::Most).unwrap_or(1e3)]);
    }
    only
}

/// What is named as in the way contradicts itself, without any one of it does not, and what would do does.
#[track_caller]
fn check_conflict(machine: &Machine, asked: &RebalanceRequest) -> Option<(usize, usize)> {
    let RebalanceError::Conflict { limits, relief } = rebalance(machine, asked).expect_err("a conflict") else {
        return None;
    };
    let named: Vec<_> = limits.iter().map(|limit| (limit.parameter, limit.side, limit.value)).collect();
    assert!(!named.is_empty());
    let why = rebalance(machine, &only(asked, &named)).expect_err("they contradict each other");
    assert!(matches!(why, RebalanceError::Conflict { .. }), "{why}");
    for i in 0..named.len() {
        let mut rest = named.clone();
        rest.remove(i);
        if let Err(why) = rebalance(machine, &only(asked, &rest)) {
            panic!("{why}\nwithout {} of {limits:?}", limits[i]);
        }
    }
    assert!(!relief.is_empty(), "{limits:?}");
    let mut relieved = asked.clone();
    for one in &mut relieved.parameters {
        let to = |side| relief.iter().find(|r| r.limit.parameter == one.parameter && r.limit.side == side);
        let [low, high] = match one.bounds {
            ParameterBounds::Within(ends) => ends,
            ParameterBounds::Fixed => [one.parameter.value(machine.spec()).expect("one of its own"); 2],
            ParameterBounds::Free if relief.iter().all(|r| r.limit.parameter != one.parameter) => continue,
            ParameterBounds::Free => [f64::MAX, f64::MIN],
        };
        let ends = [to(LimitSide::Least).map_or(low, |r| r.to), to(LimitSide::Most).map_or(high, |r| r.to)];
        if one.bounds == ParameterBounds::Free {
            let unbounded = if one.parameter.quantity == BodyQuantity::Mass { [0.0, 1e3] } else { [-1e3, 1e3] };
            one.bounds = ParameterBounds::Within([ends[0].min(unbounded[0]), ends[1].max(unbounded[1])]);
        } else if ends != [low, high] {
            assert!(ends[0] <= low && ends[1] >= high);
            one.bounds = ParameterBounds::Within(ends);
        }
    }
    let kept = rebalance(machine, &relieved).unwrap_or_else(|why| panic!("{why}\n{relief:?}"));
    assert!(balanced(&kept.machine));
    Some((limits.len(), relief.len()))
}

#[test]
fn limits_that_leave_no_way_are_named_and_how_far_they_would_have_to_give() {
    let mut noise = Noise::of(23);
    let (mut conflicts, mut of_several) = (0, 0);
    for i in 0..30 {
        let machine = if i % 2 == 0 { with_counterweights(&mut noise) } else { nine_link().clone() };
        let mut asked = anything(&mut noise, &machine, 0.2);
        if i % 2 == 1 {
            asked.parameters.retain(|one| one.parameter.quantity != BodyQuantity::Across);
            let drop = noise.between(0.0, asked.parameters.len() as f64 - 1e-9) as usize;
            let off = noise.between(-0.6, 0.6);
            let one = &mut asked.parameters[drop];
            let value = one.parameter.value(machine.spec()).expect("one of its own");
            if one.parameter.quantity == BodyQuantity::Along {
                one.bounds = ParameterBounds::Within([value + off, value + off + 0.02]);
            }
        }
        if !matches!(rebalance(&machine, &asked), Err(RebalanceError::Conflict { .. })) {
            continue;
        }
        let Some((limits, _)) = check_conflict(&machine, &asked) else { continue };
        conflicts += 1;
        of_several += usize::from(limits > 1);
    }
    assert!(conflicts > 4 && of_several > 1, "{conflicts} {of_several}");
}

/// A drag of one link: the others follow, within bounds, and the file that is written is balanced.
#[test]
fn a_dragged_link_is_followed_by_the_others() {
    let dragged = nine_link().set("link.5.com", "-0.05").expect("in range");
    assert!(!balanced(&dragged));
    let mut asked = RebalanceRequest::coms(&dragged, &Preset::Table1.penalty(9).expect("nine links"));
    asked.set_bounds(&dragged, find(&dragged, "link.5.com"), ParameterBounds::Fixed);
    let free = rebalance(&dragged, &asked).expect("it can be balanced");
    within_what_is_asked(&dragged, &asked, &free);
    let com = find(&dragged, "link.2.com");
    let [was, moved] = [&dragged, &free.machine].map(|machine| com.value(machine.spec()).expect("a link"));
    assert!((moved - was).abs() > 1e-3, "{was} {moved}");
    asked.set_bounds(&dragged, com, ParameterBounds::Within([was - 1e-4, was + 1e-4]));
    let bounded = rebalance(&dragged, &asked).expect("it can be balanced");
    within_what_is_asked(&dragged, &asked, &bounded);
    assert!(bounded.cost > free.cost);
    let again = parse(&to_toml(&bounded.machine), "again").expect("a machine");
    assert!(balanced(&again) && again == bounded.machine);
}

#[test]
fn what_cannot_be_is_refused() {
    let machine = nine_link();
    let words = |change: &dyn Fn(&mut RebalanceRequest)| {
        let mut asked = RebalanceRequest::coms(machine, &[1.0; 9]);
        change(&mut asked);
        rebalance(machine, &asked).expect_err("it cannot be").to_string()
    };
    let heavy = machine.set("payload.mass", "0.3").expect("in range");
    assert!(matches!(rebalance(&heavy, &RebalanceRequest::default()), Err(RebalanceError::Inconsistent { .. })));
    assert!(words(&|a| a.parameters[3].penalty = 0.0).starts_with("link.4.com: a penalty of 0: want"));
    assert!(words(&|a| a.parameters[3].from = f64::NAN).contains("link.4.com: a change measured from NaN"));
    assert!(words(&|a| a.parameters[3].bounds = ParameterBounds::Within([0.2, 0.1])).contains("no less than 0.2"));
    assert!(words(&|a| a.parameters[3].bounds = ParameterBounds::Within([f64::NAN, 0.1])).contains("bounds from NaN"));
    assert!(words(&|a| a.parameters.push(a.parameters[3])).contains("link.4.com is listed twice"));
    let payload = Parameter::new(stillbase::mechanics::balance::Body::Payload, BodyQuantity::Mass);
    assert!(words(&|a| a.parameters[0].parameter = payload).contains("payload.mass cannot be changed"));
    assert!(words(&|a| a.parameters[0].parameter = Parameter::com(9)).contains("link 9 (counted from 0)"));
}

/// Conditions that repeat each other, and one body with mass and place free: no rank is lost to rounding.
#[test]
fn conditions_that_repeat_each_other_are_met() {
    let machine = family_machine("serial-3r");
    let mut asked =
        RebalanceRequest::coms(&machine, &[2.671_951_150_901_641_4, 1.790_993_585_894_174_1, 1.911_344_430_482_619_3]);
    for (key, ends) in [
        ("link.2.com", [-0.516_924_654_921_075_6, 0.793_733_761_095_477_1]),
        ("link.2.mass", [1.101_810_977_846_388, 2.748_076_038_392_712_3]),
        ("link.3.com", [-0.096_612_439_897_767_63, 0.764_257_831_020_413_7]),
    ] {
        asked.set_bounds(&machine, find(&machine, key), ParameterBounds::Within(ends));
    }
    asked.set_bounds(&machine, find(&machine, "link.3.mass"), ParameterBounds::Free);
    let kept = rebalance(&machine, &asked).expect("it can be balanced");
    within_what_is_asked(&machine, &asked, &kept);
}

/// With a free mass the answer is the best along a line, too: with the mass held at any value near by it is dearer, and by
/// so little that a parabola through three neighbours has its bottom where the answer is.
#[test]
fn a_free_mass_comes_to_rest_at_the_bottom() {
    let bare = family_machine("nine-link-bare");
    let mut bottoms = 0;
    for j in 0..9 {
        let mut asked = RebalanceRequest::coms(&bare, &[1.0; 9]);
        let mass = Parameter::new(stillbase::mechanics::balance::Body::Link(j), BodyQuantity::Mass);
        asked.set_bounds(&bare, mass, ParameterBounds::Free);
        let kept = rebalance(&bare, &asked).expect("it can be balanced");
        let (place, was) =
            (asked.parameters.iter().position(|one| one.parameter == mass).expect("listed"), bare.links()[j].mass);
        let found = kept.values[place];
        let at = |mass_of: f64| {
            let mut fixed = asked.clone();
            fixed.set_bounds(&bare, mass, ParameterBounds::Within([mass_of, mass_of * (1.0 + 1e-12)]));
            rebalance(&bare, &fixed).expect("it can be balanced").cost
        };
        // At a tenth or ten times what it was there is no bottom.
        if !(0.11 * was..9.0 * was).contains(&found) {
            continue;
        }
        bottoms += 1;
        let step = 0.02 * found;
        let [below, here, above] = [found - step, found, found + step].map(at);
        assert!((here - kept.cost).abs() < 1e-9 * here, "link {}: {} and {here}", j + 1, kept.cost);
        assert!(below > here && above > here, "link {}: {below} {here} {above}", j + 1);
        let off = 0.5 * (below - above) / (below - 2.0 * here + above);
        assert!(off.abs() < 0.05, "link {}: its bottom is {off} steps away", j + 1);
    }
    assert!(bottoms > 3, "{bottoms}");
}

/// A mass that is bounded from below by less than a thousandth of what it is still stays one.
#[test]
fn no_mass_becomes_nothing() {
    for name in ["nine-link-bare", "serial-3r", "two-drive"] {
        let machine = family_machine(name);
        for j in 0..machine.links().len() {
            let mut asked = RebalanceRequest::coms(&machine, &vec![1.0; machine.links().len()]);
            let mass = Parameter::new(stillbase::mechanics::balance::Body::Link(j), BodyQuantity::Mass);
            let was = machine.links()[j].mass;
            asked.set_bounds(&machine, mass, ParameterBounds::Within([0.0, 1e3 * was]));
            // Dear places and cheap masses.
            asked.parameters.iter_mut().for_each(|one| one.penalty = if one.parameter == mass { 1e-3 } else { 10.0 });
            let Ok(kept) = rebalance(&machine, &asked) else { continue };
            let now = kept.machine.links()[j].mass;
            assert!(now >= 0.99e-3 * was, "{name} {j}: {now} of {was}");
        }
    }
}

/// What holds of kilograms holds of grams: a balanced machine of a thousandth of the mass stays as it is, too.
#[test]
fn light_machines_are_kept_as_heavy_ones_are() {
    for name in ["two-drive-balanced", "four-drive-balanced", "serial-3r-balanced"] {
        for scale in [1e-3, 1e-2, 10.0] {
            let machine = family_machine(name);
            let mut spec = machine.spec().clone();
            for link in &mut spec.links {
                (link.mass, link.inertia) = (scale * link.mass, scale * link.inertia);
            }
            spec.counterweights.iter_mut().for_each(|weight| weight.mass *= scale);
            spec.drives.iter_mut().filter_map(|drive| drive.rotor.as_mut()).for_each(|rotor| rotor.inertia *= scale);
            spec.payload.mass *= scale;
            spec.payload.inertia *= scale;
            let machine = Machine::new(spec).expect("a machine");
            let mut asked = RebalanceRequest::coms(&machine, &vec![1.0; machine.links().len()]);
            for parameter in Parameter::all(&machine).into_iter().filter(|one| one.quantity == BodyQuantity::Mass) {
                asked.set_bounds(&machine, parameter, ParameterBounds::Free);
            }
            let kept = rebalance(&machine, &asked).unwrap_or_else(|why| panic!("{name}, {scale}: {why}"));
            assert!(kept.cost < 1e-16, "{name}, {scale}: {}", kept.cost);
        }
    }
}
