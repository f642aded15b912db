//! Equations with numbers in them: both sides of every law agree for machines and states at random, and what the paper
//! gives of its own machine stands where the paper has it.

use stillbase::mechanics::balance::{Condition, Preset};
use stillbase::mechanics::dynamics::mass_matrix;
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};
use stillbase::planning::Reference;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Session, replay};
use stillbase::study::equations::{
    DriveState, EQUATION_NUMBERS, Equality, Equation, InstantKind, NoInstant, StatedEquations, Term, cells, equations,
    plain,
};

use crate::support::random::{self, with_counterweights};
use crate::support::{Noise, close};

fn a_state(noise: &mut Noise, n: usize) -> DriveState {
    let mut some = |size: f64| PerDrive::from_fn(n, |_| noise.between(-size, size));
    let (q, qd, qdd) = (DriveAngles(some(6.0)), some(3.0), some(20.0));
    DriveState::of_reference(Reference { q, qd, qdd })
}

fn of(machine: &Machine, state: &DriveState) -> Vec<Equation> {
    equations(machine, state, Preset::Table1)
}

fn numbered<'a>(all: &'a [Equation], number: &str) -> &'a Equation {
    all.iter().find(|equation| equation.number == number).expect("a number of the paper")
}

fn lines<'a>(all: &'a [Equation], number: &str) -> &'a [Equality] {
    numbered(all, number).lines.as_ref().unwrap_or_else(|why| panic!("({number}): {why}"))
}

fn table_1() -> Machine {
    builtin("nine-link-table-1").expect("built in").clone()
}

/// A side as the paper writes it.
fn written(terms: &[Term]) -> String {
    let sign = |(i, term): (usize, &Term)| match (i, term.is_negative) {
        (0, false) => "",
        (0, true) => "−",
        (_, false) => " + ",
        (_, true) => " − ",
    };
    terms.iter().enumerate().map(|one| format!("{}{}", sign(one), plain(&one.1.symbol))).collect()
}

#[test]
fn both_sides_of_every_law_agree() {
    let mut noise = Noise::of(71);
    let (mut lines, mut worst) = (0, 0.0_f64);
    for _ in 0..200 {
        let machine = with_counterweights(&mut noise);
        let state = a_state(&mut noise, machine.drives());
        let all = of(&machine, &state);
        let numbers: Vec<&str> = all.iter().map(|equation| equation.number).collect();
        assert_eq!(numbers, EQUATION_NUMBERS);
        for number in ["1", "2", "3", "4", "5", "6", "14", "A1", "A2", "A3"] {
            for line in self::lines(&all, number) {
                assert!(line.tolerance > 0.0 && line.sides().iter().all(|side| side.is_finite()));
                assert!(line.holds(), "({number}) {}: off by {:e}, {:?}", line.name, line.residual(), line.sides());
                worst = worst.max(line.residual().abs() / line.tolerance);
                lines += 1;
            }
        }
    }
    assert!(lines > 5000, "{lines} lines");
    // Not so wide that anything would pass.
    assert!(worst > 1e-4, "{worst}");
}

#[test]
fn a_term_is_the_sum_of_what_bodies_bring() {
    let mut noise = Noise::of(72);
    let mut found = 0;
    for _ in 0..100 {
        let machine = with_counterweights(&mut noise);
        let state = a_state(&mut noise, machine.drives());
        for equation in of(&machine, &state) {
            for line in equation.lines.iter().flatten() {
                for term in line.left.iter().chain(&line.right).filter(|term| !term.parts.is_empty()) {
                    let sum: f64 = term.parts.iter().map(|(_, part)| part).sum();
                    let size: f64 = term.parts.iter().map(|(_, part)| part.abs()).sum();
                    let words =
                        format!("({}) {}: {} is {} and {sum}", equation.number, line.name, term.symbol, term.value);
                    assert!((sum - term.value).abs() <= 1e-10 * size.max(1e-3), "{words}");
                    assert!(term.links().iter().all(|link| *link < machine.links().len()));
                    found += 1;
                }
            }
        }
    }
    assert!(found > 10_000, "{found}");
}

#[test]
fn what_is_left_of_balance_is_what_the_constants_have() {
    let mut noise = Noise::of(73);
    for _ in 0..100 {
        let machine = with_counterweights(&mut noise);
        let inertia = Inertia::of(&machine);
        let all = of(&machine, &a_state(&mut noise, machine.drives()));
        let eighth = numbered(&all, "8").lines.as_ref().map_or(&[][..], |lines| lines);
        let both: Vec<&Equality> = lines(&all, "7").iter().chain(eighth).collect();
        let conditions: Vec<Condition> = Condition::all(machine.drives()).collect();
        assert_eq!(both.len(), conditions.len());
        for (i, (line, condition)) in both.into_iter().zip(conditions).enumerate() {
            let size: f64 = line.left.iter().map(|term| term.value.abs()).sum();
            let left = condition.residual(&inertia).re;
            assert!(
                (line.residual() - left).abs() <= 1e-13 * size.max(1e-3),
                "{condition:?}: {} and {left}",
                line.residual()
            );
            // (9) is the same in two heaps.
            let ninth = &lines(&all, "9")[i];
            assert!(
                (ninth.residual() - left).abs() <= 1e-12 * size.max(1e-3),
                "{condition:?}: {} and {left}",
                ninth.residual()
            );
        }
    }
}

#[test]
fn on_a_plane_of_any_number_of_drives() {
    let mut noise = Noise::of(74);
    for i in 0..60 {
        let (machine, space) = random::a_space(&mut noise, 1 + i % 6);
        let state = a_state(&mut noise, machine.drives());
        let all = of(&machine, &state);
        let b: f64 = space.lambda().iter().zip(state.q.iter()).map(|(lambda, q)| lambda * q).sum();
        assert!((lines(&all, "13")[0].sides()[0] - b).abs() < 1e-9 * (1.0 + b.abs()));
        for number in ["13", "15", "16"] {
            for line in lines(&all, number) {
                assert!(line.holds(), "({number}) off by {:e}", line.residual());
            }
        }
        let [zero, ratios @ ..] = lines(&all, "12") else { panic!("no line") };
        assert!(ratios.iter().all(Equality::holds));
        // What is left of (12) is what the angular momentum of (6) has of D_1.
        let momentum = lines(&all, "6")[0].sides()[0];
        let inertia = Inertia::of(&machine);
        let size: f64 = inertia.diagonals().iter().sum();
        assert!((zero.residual() * inertia.pose_inertia() - momentum).abs() < 1e-9 * size * 10.0);
        // Another b than that of the pose is found out.
        let other = of(&machine, &DriveState { b: Some(b + 0.1), ..state });
        assert!(!lines(&other, "13")[0].holds());
    }
}

/// As they stand in the paper, but that masses of one length are taken together in all three.
#[test]
fn the_paper_s_machine_is_written_as_in_the_paper() {
    let all = of(&table_1(), &DriveState::at_rest(DriveAngles::from([1.7, 3.7, 2.2])));
    let sides = |number| lines(&all, number).iter().map(|line| written(&line.left)).collect::<Vec<_>>();
    assert_eq!(
        sides("7"),
        [
            "m₁ l_c1 + m₄ l_c4 + m₆ l_c6 + (m₅ + m₇ + m₈ + m₉) l₁",
            "m₂ l_c2 + m₄ l₂ − m₅ l_c5 − m₈ l_c8 − m₉ l₅",
            "m₃ l_c3 + (m₆ + m₈) l₃ + m₇ l_c7 − m₉ l_c9",
        ]
    );
    assert_eq!(
        sides("8"),
        [
            "m₄ l₂ l_c4 − m₅ l₁ l_c5 − m₈ l₁ l_c8 − m₉ l₁ l₅",
            "m₆ l₃ l_c6 + m₇ l₁ l_c7 + m₈ l₁ l₃ − m₉ l₁ l_c9",
            "−m₈ l₃ l_c8 + m₉ l₅ l_c9",
        ]
    );
    let right = |number| lines(&all, number).iter().map(|line| written(&line.right)).collect::<Vec<_>>();
    assert_eq!(right("14"), ["l₁ cos q₁ − l₅ cos q₂ − l₉ cos q₃", "l₁ sin q₁ − l₅ sin q₂ − l₉ sin q₃"]);
    assert_eq!(right("15"), ["b/Σλ − a₁ (λ₂ + λ₃)/Σλ + (π − a₂) λ₃/Σλ"]);
    assert_eq!(right("16")[..2], ["l₁ − l₅ cos(a₁) + l₉ cos(a₁ + a₂)", "−l₅ sin(a₁) + l₉ sin(a₁ + a₂)"]);
    assert_eq!(sides("12")[0], "q\u{307}₁ + λ₂ q\u{307}₂ + λ₃ q\u{307}₃");
    assert_eq!(sides("13"), ["q₁ + λ₂ q₂ + λ₃ q₃"]);
    assert_eq!(
        right("A3")[0],
        "(I₁ + I₄ + I₆) + m₁ l_c1² + m₄ l_c4² + m₆ l_c6² + (m₅ + m₇ + m₈ + m₉) l₁² + C₁₂ cos(q₁ − q₂) + C₁₃ cos(q₁ − q₃)"
    );
}

#[test]
fn the_paper_s_numbers_stand_in_them() {
    let machine = table_1();
    // Where both cosines of (A3) vanish with what couples drives 1 and 2, and 1 and 3.
    let quarter = std::f64::consts::FRAC_PI_2;
    let all = of(&machine, &DriveState::at_rest(DriveAngles::from([0.0, quarter, quarter])));
    let left = |number: &str| lines(&all, number).iter().map(|line| line.sides()[0]).collect::<Vec<_>>();
    let first = lines(&all, "A3")[0].sides();
    close("d_1", &[first[0]], &[1.367816575], 1e-9);
    let seventh: Vec<f64> = lines(&all, "7")[0].left.iter().map(|term| term.value).collect();
    close("(7)", &seventh, &[7.0 * -0.2214, 1.5 * 0.2016, 1.5 * -0.0349, 2.6 * 0.5], 1e-12);
    // Table I is rounded: 2.5e-4 kg m and 2.3e-5 kg m² are left.
    let most = |number| left(number).into_iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!((most("7") - 2.5e-4).abs() < 0.06e-4, "{}", most("7"));
    assert!((most("8") - 2.3e-5).abs() < 0.06e-5, "{}", most("8"));
    assert_eq!((numbered(&all, "7").holds(), numbered(&all, "8").holds()), (Some(false), Some(false)));
    close("λ", &left("12")[1..], &[0.116746264, 0.127920111], 1e-8);
    // (10) gives Table I to its last digit, and (9) holds for it.
    let least = lines(&all, "10");
    for line in &least[1..] {
        assert!(line.residual().abs() < 5e-5, "{:?}", line.sides());
    }
    let [now, best] = least[0].sides();
    assert!((now - best).abs() < 1e-3 * best, "{now} and {best}");
    let solved = of(builtin("nine-link").expect("built in"), &DriveState::at_rest(DriveAngles::from([1.7, 3.7, 2.2])));
    for number in ["7", "8", "9", "10"] {
        assert_eq!(numbered(&solved, number).holds(), Some(true), "({number})");
    }
}

/// Case 3 halfway: no force, no moment, b = 2.4, A and B of (14).
#[test]
fn case_3_has_its_numbers() {
    let session = Session::open(Scenario::builtin("case-3").expect("built in")).expect("it opens");
    let (run, motion) = (session.run(), session.run().motion().expect("a motion"));
    let of_case = |at: f64| {
        let state = DriveState { b: Some(2.4), ..DriveState::of_reference(motion.at(at)) };
        of(&run.scenario().machine, &state)
    };
    for (at, place) in [(0.0, [0.5, 0.5]), (1.0, [0.55, 0.9])] {
        let all = of_case(at);
        let tip: Vec<f64> = lines(&all, "14").iter().map(|line| line.sides()[0]).collect();
        close("(14)", &tip, &place, 1e-9);
    }
    let all = of_case(0.3);
    for number in EQUATION_NUMBERS {
        assert_eq!(
            numbered(&all, number).holds(),
            Some(true),
            "({number}): {:?}",
            numbered(&all, number).least_accurate()
        );
    }
    assert!((lines(&all, "13")[0].sides()[0] - 2.4).abs() < 1e-9);
    assert!(lines(&all, "5")[0].sides()[0].abs() < 1e-9, "no moment");
    assert!(lines(&all, "1").iter().all(|line| line.sides()[0].abs() < 1e-9), "no force");
    let torque = lines(&all, "11").iter().map(|line| line.sides()[0].abs()).fold(0.0, f64::max);
    assert!(torque > 0.5, "{torque} N m");
    // At rest the window shows the plan instead, because a pose at rest has nothing to show.
    let state = DriveState::of(run, session.frame());
    assert_eq!(state.when, InstantKind::Plan(0.25));
    assert_eq!(DriveState::now(session.frame()).when, InstantKind::Run(0.0));
    let case_1 = Session::open(Scenario::builtin("case-1").expect("built in")).expect("it opens");
    let all = of(&case_1.scenario().machine, &DriveState::of(case_1.run(), case_1.frame()));
    assert_eq!((numbered(&all, "12").holds(), numbered(&all, "5").holds()), (Some(false), Some(true)));
}

#[test]
fn what_has_no_meaning_says_why() {
    let bare = builtin("nine-link-bare").expect("built in");
    let all = of(bare, &DriveState::at_rest(DriveAngles::from([1.7, 3.7, 2.2])));
    for number in ["11", "12", "13", "15", "16"] {
        let why = numbered(&all, number).lines.as_ref().expect_err("not balanced");
        assert!(why.contains("kg m²"), "({number}) {why}");
    }
    let mut noise = Noise::of(75);
    let (one, _) = random::a_space(&mut noise, 1);
    let all = of(&one, &a_state(&mut noise, 1));
    assert!(numbered(&all, "8").lines.as_ref().expect_err("one drive").contains("one drive"));
}

#[test]
fn numbers_stand_below_their_symbols() {
    let all = of(&table_1(), &DriveState::at_rest(DriveAngles::from([1.7, 3.7, 2.2])));
    let line = &lines(&all, "8")[2];
    let cells = cells(line, 4);
    let symbols: Vec<String> = cells.iter().map(|cell| format!("{}{}", cell.sign, plain(cell.symbol))).collect();
    assert_eq!(symbols, ["−m₈ l₃ l_c8", "+m₉ l₅ l_c9", "=", "0"]);
    let numbers: Vec<String> = cells.iter().map(|cell| format!("{}{}", cell.number_sign, cell.number)).collect();
    assert_eq!(numbers, ["−0.0003", "+0.0003", "=", "0.0000"]);
}

/// Sides that are all 0 agree, and no side may be off by more than rounding.
#[test]
fn tolerances_are_those_of_rounding() {
    let mut noise = Noise::of(76);
    for i in 0..40 {
        let (machine, _) = random::a_space(&mut noise, 2 + i % 5);
        // All drives at 0, and every relative angle there, too.
        let mut spec = machine.spec().clone();
        spec.angles.iter_mut().for_each(|angle| angle.offset = 0.0);
        let machine = Machine::new(spec).expect("still a machine");
        let zero = DriveState::at_rest(DriveAngles(PerDrive::from_fn(machine.drives(), |_| 0.0)));
        for line in lines(&of(&machine, &zero), "15") {
            assert!(line.holds() && line.tolerance > 0.0 && line.tolerance < 1e-5, "{line:?}");
        }
    }
    for _ in 0..100 {
        let machine = with_counterweights(&mut noise);
        // No mass is further from the base pin than all links end to end, their own centres of mass and what they hold.
        let far: f64 = machine.resolved_links().iter().map(|part| part.length.abs()).sum::<f64>() + 1.0;
        for line in lines(&of(&machine, &a_state(&mut noise, machine.drives())), "2") {
            assert!(line.tolerance <= 4e-12 * machine.mass() * far, "{}: {:e}", line.name, line.tolerance);
        }
    }
}

/// Each term names the drives and the axis that it is of.
#[test]
fn terms_name_their_drives_and_axes() {
    let all = of(&table_1(), &a_state(&mut Noise::of(77), 3));
    let right = |number| lines(&all, number).iter().map(|line| written(&line.right)).collect::<Vec<_>>();
    assert_eq!(right("1"), ["−Σ m_j x\u{308}_cj + M g_x", "−Σ m_j y\u{308}_cj + M g_y"].map(composed));
    let fourth = right("4");
    for (k, line) in ["1", "2", "3"].iter().zip(fourth) {
        let wanted = ["1", "2", "3"].map(|l| plain(&format!("H_{{{k}{l}}} q\u{308}_{{{l}}}")));
        assert!(wanted.iter().all(|term| line.contains(term.as_str())), "{line}");
    }
    let left = |number| lines(&all, number).iter().map(|line| written(&line.left)).collect::<Vec<_>>();
    assert_eq!(left("3"), ["M x\u{307}_CM", "M y\u{307}_CM"].map(composed));
    for (line, axis) in right("3").into_iter().zip(["x", "y"]) {
        assert!(["1", "2", "3"].iter().all(|k| line.contains(&format!("γ_{k}{axis} q\u{307}"))), "{line}");
    }
}

/// The letters of the program are of one piece each.
fn composed(text: &str) -> String {
    [("x\u{308}", "ẍ"), ("y\u{308}", "ÿ"), ("x\u{307}", "ẋ"), ("y\u{307}", "ẏ")]
        .iter()
        .fold(text.to_owned(), |text, (two, one)| text.replace(two, one))
}

/// Lengths stand before the place of a centre of mass, whatever they are called.
#[test]
fn lengths_stand_before_centres_of_mass() {
    let text = "name = \"named\"\n[lengths]\nupper = 0.4\n[[drive]]\nname = \"1\"\n[[drive]]\nname = \"2\"\n\
                [[link]]\nname = \"1\"\ndrive = \"1\"\nattach = \"base\"\nlength = \"upper\"\nmass = 1.0\n\
                inertia = 0.1\ncom = 0.1\n[[link]]\nname = \"2\"\ndrive = \"2\"\n\
                attach = { link = \"1\", at = \"tip\" }\nlength = 0.3\nmass = 1.0\ninertia = 0.1\ncom = 0.1\n\
                [end_effector]\nlink = \"2\"\n";
    let machine = stillbase::mechanics::machine::parse(text, "named").expect("a machine");
    let all = of(&machine, &DriveState::at_rest(DriveAngles(PerDrive::from_fn(2, |_| 0.3))));
    assert_eq!(written(&lines(&all, "8")[0].left), "m₂ upper l_c2");
}

/// What (8) leaves is the greatest coupling there is, as the mass matrix shows it over all poses.
#[test]
fn what_the_mass_matrix_changes_by_is_said() {
    let mut noise = Noise::of(78);
    for _ in 0..20 {
        let machine = random::a_chain(&mut noise, 3);
        let all = of(&machine, &a_state(&mut noise, 3));
        let why = numbered(&all, "11").lines.as_ref().expect_err("not balanced");
        let said = why.split("up to ").nth(1).and_then(|rest| rest.split(" kg m²").next()).expect("a number");
        let said: f64 = said.replace('\u{2212}', "-").parse().expect("a number");
        let inertia = Inertia::of(&machine);
        let entries = |q: f64, k: usize, l: usize| {
            let q = PerDrive::from_fn(3, |i| if i == k { q } else { 0.0 });
            mass_matrix(&inertia, &DriveAngles(q).units(), &PerDrive::from_fn(3, |_| 0.0)).0.get(k, l)
        };
        // Half of how far each entry swings as one drive turns.
        let swing = |(k, l): (usize, usize)| {
            let all = (0..720).map(|i| entries(std::f64::consts::TAU * f64::from(i) / 720.0, k, l));
            let [low, high] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b]: [f64; 2], x| [a.min(x), b.max(x)]);
            0.5 * (high - low)
        };
        let most = [(0, 1), (0, 2), (1, 2)].map(swing).into_iter().fold(0.0, f64::max);
        assert!((said - most).abs() < 0.6e-4 + 1e-4 * most, "{why}: {most}");
    }
}

/// A first drive with a counter-rotating rotor that takes all of its momentum away: λ is by the next one.
#[test]
fn momenta_are_counted_by_the_first_drive_that_has_one() {
    let link = |k: u32, inertia: f64| {
        format!(
            "[[link]]\nname = \"{k}\"\ndrive = \"{k}\"\nattach = \"base\"\nlength = 0.5\nmass = 1.0\n\
             inertia = {inertia}\ncom = 0.0\n"
        )
    };
    let text = "name = \"two\"\n[[drive]]\nname = \"1\"\nrotor = { inertia = 0.25, ratio = -2.0 }\n[[drive]]\n\
                name = \"2\"\n"
        .to_owned()
        + &link(1, 0.5)
        + &link(2, 0.3)
        + "[end_effector]\nlink = \"2\"\n";
    let machine = stillbase::mechanics::machine::parse(&text, "two").expect("a machine");
    let all = of(&machine, &a_state(&mut Noise::of(79), 2));
    let [_, ratios @ ..] = lines(&all, "12") else { panic!("no line") };
    assert_eq!(ratios.len(), 1);
    assert_eq!(written(&ratios[0].left), "λ₁");
    assert!(ratios[0].holds() && ratios[0].sides() == [0.0, 0.0], "{:?}", ratios[0]);
    assert!(written(&ratios[0].right).ends_with("/D₂"), "{}", written(&ratios[0].right));
}

/// On a base that turns, accelerations are relative to it, as angles and rates are: they are the slopes of its rates.
#[test]
fn on_a_turning_base_accelerations_are_relative_to_it() {
    let mut scenario = Scenario::builtin("spacecraft").expect("built in");
    scenario.step = 1e-4;
    let at = |time: f64| DriveState::at(&scenario, time, || true).expect("within the run");
    let mut most = 0.0_f64;
    replay(&scenario, |_, frame| most = most.max(frame.base_angular_acceleration.abs())).expect("it runs");
    assert!(most > 0.05, "the base turns with {most} rad/s² at most: too little to tell");
    for time in [0.1, 0.25, 0.4] {
        let h = 2e-4;
        let (before, now, after) = (at(time - h), at(time), at(time + h));
        for k in 0..now.q.len() {
            let slope = (after.qd[k] - before.qd[k]) / (2.0 * h);
            assert!((slope - now.qdd[k]).abs() < 1e-4, "drive {}: {slope} and {}", k + 1, now.qdd[k]);
        }
    }
}

/// The b that is aimed at, where there is one.
#[test]
fn the_b_of_now_is_the_one_aimed_at() {
    let session = Session::open(Scenario::builtin("case-3").expect("built in")).expect("it opens");
    assert!((DriveState::now(session.frame()).b.expect("held") - 2.4).abs() < 1e-12);
    let all = of(&session.scenario().machine, &DriveState::now(session.frame()));
    assert_eq!(numbered(&all, "13").holds(), Some(true));
}

/// A machine of one drive has nothing to be decoupled from.
#[test]
fn one_drive_is_written_of_alone() {
    let (one, _) = random::a_space(&mut Noise::of(75), 1);
    let all = of(&one, &a_state(&mut Noise::of(80), 1));
    assert!(numbered(&all, "11").says.starts_with("With (7) met, the drive turns"));
    let all = of(&table_1(), &a_state(&mut Noise::of(80), 3));
    assert!(numbered(&all, "11").says.starts_with("With (7) and (8) met, every drive turns"));
}

/// The state at a time is that of the run then; past its end there is none.
#[test]
fn a_time_of_a_run_has_a_state() {
    let scenario = Scenario::builtin("case-1").expect("built in");
    let state = DriveState::at(&scenario, 0.3, || true).expect("it runs so far");
    assert!(matches!(state.when, InstantKind::Run(time) if (time - 0.3).abs() < 1e-9));
    let later = DriveState::at(&scenario, 1e3, || true).expect_err("it is over then");
    assert!(matches!(later, NoInstant::Later { end } if end > 0.9), "{later}");
    let stated = StatedEquations::of(&scenario.machine, &state, &of(&scenario.machine, &state));
    assert_eq!(stated.equations.len(), EQUATION_NUMBERS.len());
    assert!(stated.time.is_some_and(|time| (time - 0.3).abs() < 1e-9) && stated.planned_time.is_none());
    let force = &stated.equations[0].lines[0];
    let sum: f64 = force.left_terms.iter().map(|term| term.value).sum();
    assert!((sum - force.left).abs() < 1e-12 && force.holds);
}
