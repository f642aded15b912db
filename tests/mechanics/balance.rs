//! Balance as a linear problem: (7) and (8) by hand, presets, inconsistent machines, least norm.

use nalgebra::DVector;
use proptest::prelude::*;
use stillbase::mechanics::balance::{DesignError, Preset, conditions, design};
use stillbase::mechanics::machine::{Inertia, Machine, builtin, parse};
use stillbase::settings::word::Choice;

use crate::mechanics::nine_body::NineBody;
use crate::support::{Noise, array, close, family_machine, machine_of, numbers, planning};

fn table_1() -> &'static Machine {
    builtin("nine-link-table-1").expect("built in")
}

/// (7) and (8) term by term, with a payload m_p at the end effector: their left sides at given l_c.
fn left_sides(body: &NineBody, c: &[f64]) -> [f64; 6] {
    let [l1, l2, l3, _, l5, _, l7, _, l9] = body.length;
    let [m1, m2, m3, m4, m5, m6, m7, m8, m9] = body.mass;
    let [c1, c2, c3, c4, c5, c6, c7, c8, c9] = std::array::from_fn(|j| c[j]);
    let mp = body.payload;
    [
        m1 * c1 + m4 * c4 + m6 * c6 + (m5 + m7 + m8 + m9) * l1 + mp * l1,
        m2 * c2 + m4 * l2 - m5 * c5 - m8 * c8 - m9 * l5 - mp * l5,
        m3 * c3 + m6 * l3 + m7 * c7 + m8 * l3 - m9 * c9 - mp * l9,
        m4 * l2 * c4 - m5 * l1 * c5 - m8 * l1 * c8 - m9 * l1 * l5 - mp * l1 * l5,
        m6 * l3 * c6 + m7 * l1 * c7 + m8 * l1 * l7 - m9 * l1 * c9 - mp * l1 * l9,
        m9 * l5 * c9 - m8 * l7 * c8 + mp * l5 * l9,
    ]
}

fn any_body() -> impl Strategy<Value = NineBody> {
    let nine = |range: std::ops::Range<f64>| prop::collection::vec(range, 9);
    (prop::collection::vec(0.1..0.7, 5), nine(0.1..8.0), nine(-0.4..0.4), 0.0..1.0).prop_map(|(l, m, c, payload)| {
        NineBody {
            length: [l[0], l[1], l[2], l[0], l[3], l[0], l[2], l[3], l[4]],
            mass: std::array::from_fn(|j| m[j]),
            inertia: [0.02; 9],
            com: std::array::from_fn(|j| c[j]),
            gravity: [0.0; 2],
            payload,
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn conditions_are_seven_and_eight(body in any_body(), other in prop::collection::vec(-1.0..1.0, 9)) {
        let machine = machine_of(&body);
        let (a, k) = conditions(&machine);
        prop_assert_eq!((a.nrows(), a.ncols()), (6, 9));
        // Two points fix an affine map along the line between them; all l_c are free, so this pins A and k.
        for c in [&other, &vec![0.0; 9], &body.com.to_vec()] {
            let rest = &a * DVector::from_column_slice(c) - &k;
            close("A l_c − k", rest.as_slice(), &left_sides(&body, c), 1e-12);
        }
        for j in 0..9 {
            let mut step = other.clone();
            step[j] += 1.0;
            let rest = &a * DVector::from_vec(step.clone()) - &k;
            close("A l_c − k", rest.as_slice(), &left_sides(&body, &step), 1e-12);
        }
    }

    /// Designed machines meet every condition to rounding, and anything else that meets them is penalised more.
    #[test]
    fn designs_balance_with_the_least_penalty(
        body in any_body(),
        penalty in prop::collection::vec(0.2..5.0, 9),
        direction in prop::collection::vec(-1.0..1.0, 9),
    ) {
        let machine = machine_of(&body);
        let best = design(&machine, &penalty).expect("any masses of this linkage can be balanced");
        let inertia = Inertia::of(&best);
        let size = body.mass.iter().sum::<f64>();
        prop_assert!(inertia.force_residual() < 1e-13 * size, "{:e}", inertia.force_residual());
        prop_assert!(inertia.invariance_residual() < 1e-13 * size, "{:e}", inertia.invariance_residual());
        prop_assert!(inertia.is_force_balanced() && inertia.is_invariant());
        let com: Vec<f64> = best.links().iter().map(|l| l.com).collect();
        let cost = |c: &[f64]| c.iter().zip(&penalty).map(|(c, p)| (c * p).powi(2)).sum::<f64>();
        // The direction less its part outside the null space of A.
        let (a, _) = conditions(&machine);
        let d = DVector::from_vec(direction);
        let gram = (&a * a.transpose()).lu();
        let null = &d - a.transpose() * gram.solve(&(&a * &d)).expect("full rank");
        prop_assume!(null.norm() > 1e-3);
        let least = cost(&com);
        for step in [1e-2, -1e-2, 0.3, -0.3] {
            let moved: Vec<f64> = com.iter().zip(null.iter()).map(|(c, n)| c + step * n).collect();
            let rest = left_sides(&body, &moved).iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            prop_assert!(rest < 1e-9 * size, "the moved design is still one: {:e}", rest);
            // At the least penalty the first order vanishes and the second remains.
            let second: f64 = null.iter().zip(&penalty).map(|(n, p)| (step * n * p).powi(2)).sum();
            let rise = cost(&moved) - least;
            prop_assert!((rise - second).abs() <= 1e-9 * (least + second), "{:e} and {:e}", rise, second);
        }
    }
}

#[test]
fn presets_give_the_reference_designs() {
    for want in planning()["design"].as_array().expect("designs") {
        let penalty: [f64; 9] = array(&want["penalty"]);
        let preset = Preset::ALL
            .iter()
            .find(|p| {
                let ours = p.penalty(9).expect("nine links");
                ours.iter().zip(&penalty).all(|(a, b)| (a - b).abs() < 1e-8)
            })
            .unwrap_or_else(|| panic!("no preset for {}", want["name"]));
        let designed = design(table_1(), &preset.penalty(9).expect("nine links")).expect("can be balanced");
        let com: Vec<f64> = designed.links().iter().map(|l| l.com).collect();
        let name = preset.name();
        close(name, &com, &numbers(&want["com"]), 2e-8);
        let inertia = Inertia::of(&designed);
        assert!(inertia.force_residual() < 1e-14, "{name}: {:e}", inertia.force_residual());
        assert!(inertia.invariance_residual() < 1e-15, "{name}: {:e}", inertia.invariance_residual());
        if want["h"].is_array() {
            close(name, &inertia.diagonals(), &numbers(&want["h"]), 1e-8);
            close(name, &inertia.lambda(), &numbers(&want["lambda_"]), 1e-8);
        }
    }
}

#[test]
fn table_1_to_its_last_digit_and_what_it_leaves() {
    let designed = design(table_1(), &Preset::Table1.penalty(9).expect("nine links")).expect("can be balanced");
    for (printed, solved) in table_1().links().iter().zip(designed.links()) {
        assert!((printed.com - solved.com).abs() < 5e-5, "link {}: {} and {}", printed.name, printed.com, solved.com);
    }
    let inertia = Inertia::of(table_1());
    let want = &planning()["table_1"];
    let got: Vec<f64> = (0..3).map(|k| inertia.first_moment(k).re).collect();
    // Residuals of a rounded table: small differences of numbers of order 1.
    assert!(got.iter().zip(numbers(&want["gamma_coefficients"])).all(|(g, w)| (g - w).abs() < 1e-12), "{got:?}");
    let got: Vec<f64> = Inertia::pairs(3).map(|(k, l)| inertia.coupling(k, l).re).collect();
    assert!(got.iter().zip(numbers(&want["coupling_coefficients"])).all(|(g, w)| (g - w).abs() < 1e-12), "{got:?}");
    close("h", &inertia.diagonals(), &numbers(&want["h"]), 1e-8);
    close("lambda", &inertia.lambda(), &numbers(&want["lambda_"]), 1e-8);
    assert!(!inertia.is_force_balanced() && !inertia.is_invariant());
    close("mass", &[inertia.mass()], &[16.05], 1e-15);
}

/// The default machine is what `design nine-link-table-1 --preset table-1` gives.
#[test]
fn shipped_machine_is_the_design() {
    let designed = design(table_1(), &Preset::Table1.penalty(9).expect("nine links")).expect("can be balanced");
    let shipped = builtin("nine-link").expect("built in");
    for (a, b) in shipped.links().iter().zip(designed.links()) {
        assert!((a.com - b.com).abs() < 1e-14, "link {}: {} and {}", a.name, a.com, b.com);
        assert_eq!((a.mass, a.inertia, &a.length), (b.mass, b.inertia, &b.length));
    }
    assert_eq!(shipped.spec().lengths, designed.spec().lengths);
}

/// A serial arm in absolute angles, every drive at the base: `links` hang each on the tip of the one before.
fn serial(links: usize) -> Machine {
    let mut text = String::from("name = \"serial\"\n");
    for k in 1..=links {
        let attach = match k {
            1 => "\"base\"".into(),
            k => format!("{{ link = \"{}\", at = \"tip\" }}", k - 1),
        };
        text += &format!(
            "[[drive]]\nname = \"{k}\"\n[[link]]\nname = \"{k}\"\ndrive = \"{k}\"\nattach = {attach}\n\
             length = 0.{k}\nmass = {k}.5\ninertia = 0.01\ncom = 0.1\n"
        );
    }
    text += &format!("[end_effector]\nlink = \"{links}\"\n");
    parse(&text, "serial").expect("valid")
}

/// In a serial arm the outer CMs must lie in their pins and the inner ones behind B: force balance implies invariance,
/// so the conditions have lost rank and must still be solved.
#[test]
fn serial_arm_is_balanced_although_its_conditions_lose_rank() {
    for links in 2..=4 {
        let machine = serial(links);
        let (a, _) = conditions(&machine);
        assert_eq!(a.nrows(), links + links * (links - 1) / 2);
        assert_eq!(a.rank(1e-12), links);
        let designed = design(&machine, &vec![1.0; links]).expect("can be balanced");
        // m_j l_cj = −l_j Σ of the masses further out.
        for j in 0..links {
            let outer: f64 = (j + 1..links).map(|i| machine.links()[i].mass).sum();
            let want = -machine.resolved_links()[j].length * outer / machine.links()[j].mass;
            assert!((designed.links()[j].com - want).abs() < 1e-14, "{links} links, link {}", j + 1);
        }
    }
}

#[test]
fn a_machine_that_cannot_be_balanced_says_where() {
    // A CM off its link's axis cannot be moved back by moving it along the axis.
    let mut spec = serial(2).spec().clone();
    spec.links[1].com_normal = 0.03;
    let off_axis = Machine::new(spec).expect("valid");
    let error = design(&off_axis, &[1.0, 1.0]).expect_err("inconsistent");
    let DesignError::Inconsistent { condition, residual } = &error else { panic!("{error}") };
    assert_eq!(condition, "the force balance of drive 2, (7)");
    // m_2 · com_normal = 2.5 · 0.03 kg m
    assert_eq!(residual, "7.500e-2 kg m");
    assert!(error.to_string().contains("no centres of mass along the links balance this machine"), "{error}");

    // A crank on the base evens out the force of the same offset, but not its coupling with the arm that carries it.
    let bar = |name: &str, drive: u8, attach: &str, length: f64, mass: f64, off: f64| {
        format!(
            "[[link]]\nname = \"{name}\"\ndrive = \"{drive}\"\nattach = {attach}\nlength = {length}\nmass = {mass}\n\
             inertia = 0.1\ncom = 0.1\ncom_normal = {off}\n"
        )
    };
    let text = [
        "name = \"coupled\"\nend_effector = { link = \"fore\" }\n[[drive]]\nname = \"1\"\n[[drive]]\nname = \"2\"\n"
            .into(),
        bar("arm", 1, "\"base\"", 0.5, 4.0, 0.0),
        bar("crank", 2, "\"base\"", 0.2, 2.0, -0.01),
        bar("fore", 2, "{ link = \"arm\" }", 0.4, 1.0, 0.02),
    ]
    .concat();
    let machine = parse(&text, "coupled").expect("valid");
    let error = design(&machine, &[1.0; 3]).expect_err("inconsistent");
    let DesignError::Inconsistent { condition, residual } = &error else { panic!("{error}") };
    assert_eq!(condition, "the coupling of drives 1 and 2, (8)");
    // m · l_arm · com_normal = 1 · 0.5 · 0.02 kg m²
    assert_eq!(residual, "1.000e-2 kg m²");
    // Straightened, it can be balanced.
    let straight = machine.set_all([("link.crank.com_normal", "0"), ("link.fore.com_normal", "0")]).expect("valid");
    assert!(design(&straight, &[1.0; 3]).is_ok());
}

/// Point masses whose CMs lie in their pins have no inertia at all about them: the conditions do not need any.
#[test]
fn point_masses_have_the_same_conditions() {
    let mut spec = table_1().spec().clone();
    for link in &mut spec.links {
        link.inertia = 0.0;
    }
    let points = Machine::new(spec).expect("valid");
    assert_eq!(conditions(&points), conditions(table_1()));
    let mut spec = serial(1).spec().clone();
    spec.links[0].inertia = 0.0;
    let (a, k) = conditions(&Machine::new(spec).expect("valid"));
    assert_eq!((a[(0, 0)], k[0]), (1.5, 0.0));
}

#[test]
fn wrong_penalties_are_refused_by_name() {
    let words = |penalty: &[f64]| design(table_1(), penalty).expect_err("refused").to_string();
    assert_eq!(words(&[1.0; 8]), "8 penalties for 9 links: want one a link");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut penalty = [1.0; 9];
        penalty[4] = bad;
        assert_eq!(words(&penalty), format!("penalty {bad} of link 5: want a number above 0"));
    }
    let error = Preset::Table1.penalty(2).expect_err("nine links only").to_string();
    assert_eq!(error, "9 penalties for 2 links: want one a link");
    assert_eq!(Preset::MinimumNorm.penalty(2).expect("any number of links"), [1.0, 1.0]);
}

/// Repeated conditions and links of any mass: four drives and two, of which no penalties leave any without a design.
#[test]
fn no_masses_or_penalties_leave_a_machine_without_a_design() {
    let mut noise = Noise::of(31);
    for name in ["serial-3r", "four-drive", "two-drive", "nine-link-geared"] {
        for _ in 0..60 {
            let mut spec = family_machine(name).spec().clone();
            spec.links.iter_mut().for_each(|link| link.mass = noise.between(0.1, 4.0));
            let machine = Machine::new(spec).expect("valid");
            let penalty: Vec<f64> = machine.links().iter().map(|_| noise.between(0.1, 8.0)).collect();
            let designed = design(&machine, &penalty).unwrap_or_else(|why| panic!("{name}: {why}"));
            let inertia = Inertia::of(&designed);
            assert!(inertia.is_force_balanced() && inertia.is_invariant(), "{name}");
        }
    }
}
