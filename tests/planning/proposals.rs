//! What a refusal proposes works as printed: typed back, it is accepted.

use stillbase::planning::pose_space::Planes;
use stillbase::session::scenario::{Scenario, TaskChange};
use stillbase::session::{Refusal, Run};

use crate::support::Noise;
use crate::support::random::{a_pose, a_space};

/// The number that stands behind some words.
fn number(text: &str, before: &str) -> Option<f64> {
    let rest = &text[text.find(before)? + before.len()..];
    let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')).unwrap_or(rest.len());
    rest[..end].parse().ok()
}

fn with(scenario: &Scenario, change: &str) -> Scenario {
    let change: TaskChange = toml::from_str(change).expect("keys");
    Scenario { task: scenario.task.with_change(&change, &scenario.machine).expect("a task"), ..scenario.clone() }
}

/// The task as a refusal proposes it: its kind of proposal and every way to type it back; none if it proposes nothing.
fn proposals(task: &Scenario, words: &str, is_joint_line: bool) -> (Option<usize>, Vec<Scenario>) {
    if let Some(b) = number(words, " m would do, at b = ") {
        let name = if words.contains("moving A by") { "from" } else { "to" };
        let x = number(words, " m to (").expect("x");
        let y = number(&words[words.find(" m to (").expect("a point")..], ", ").expect("y");
        return (Some(0), vec![with(task, &format!("{name} = [{x:?}, {y:?}]\nb = {b:?}"))]);
    }
    if let Some(b) = number(words, "; b = ").or_else(|| number(words, "want b = ")) {
        return (Some(1), vec![with(task, &format!("b = {b:?}"))]);
    }
    if let Some((name, rest)) = words.split_once("want limits.").and_then(|(_, rest)| rest.split_once(" = ")) {
        let value = rest.trim_end_matches(" rad at this b");
        let machine = task.machine.set(&format!("limits.{name}"), value).expect("limits");
        let b = words.rfind("at b = ").and_then(|at| number(&words[at..], "at b = ")).expect("b");
        return (Some(1), vec![Scenario { machine, ..with(task, &format!("b = {b:?}")) }]);
    }
    if words.contains("want b ") && is_joint_line {
        let mut tries = Vec::new();
        for range in words[words.find("want b ").expect("a range")..].split("from ").skip(1) {
            let mut ends = range.split(' ');
            let ends = [ends.next(), ends.nth(1)].map(|end| end.expect("an end").parse::<f64>().expect("a number"));
            tries.extend(ends.map(|b| with(task, &format!("b = {b:?}"))));
        }
        return (Some(1), tries);
    }
    (None, Vec::new())
}

/// Refused tasks between random points, and what became of what was proposed: points, b, and how often nothing was.
fn typed_back(shapes: &[&str], cases: usize, seed: u64) -> [usize; 3] {
    let base = Scenario { compare_b: None, ..Scenario::builtin("case-3").expect("built in") };
    let mut noise = Noise::of(seed);
    let mut totals = [0; 3];
    let mut refused = 0;
    while refused < cases {
        let mut coordinate = || (100.0 * noise.between(-1.0, 1.0)).round() / 100.0;
        let ends = [[coordinate(), coordinate()], [coordinate(), coordinate()]];
        let b = (100.0 * noise.between(-3.0, 9.0)).round() / 100.0;
        let shape = shapes[refused % shapes.len()];
        refused += usize::from(refused_and_typed(&base, shape, ends, b, &mut totals));
    }
    totals
}

/// Whether a task is refused; what is proposed then is typed back.
fn refused_and_typed(base: &Scenario, shape: &str, [from, to]: [[f64; 2]; 2], b: f64, totals: &mut [usize; 3]) -> bool {
    let task = with(base, &format!("from = {from:?}\nto = {to:?}\nb = {b}\nshape = '{shape}'"));
    let Err(refusal) = Run::new(&task) else { return false };
    let words = refusal.to_string();
    let (kind, tries) = proposals(&task, &words, shape == "joint-line");
    totals[kind.unwrap_or(2)] += 1;
    for proposed in tries {
        if let Err(again) = Run::new(&proposed) {
            let n = base.machine.drives();
            panic!("{n} drives, {shape} from {from:?} to {to:?} at b = {b}: {words}; typed back: {again}");
        }
    }
    // The window's button takes the exact one.
    if let Some(b) = refusal.feasible_b() {
        let exact = Run::new(&with(&task, &format!("b = {b:?}")));
        assert!(exact.is_ok(), "{shape} from {from:?} to {to:?}: {words}; {b:?}");
    }
    if let Refusal::NoCommonPlane { why, .. } = &refusal
        && let (Some(mend), "joint-line") = (why.correction, shape)
    {
        let name = if mend.point == 0 { "from" } else { "to" };
        let exact = with(&task, &format!("{name} = [{:?}, {:?}]\nb = {:?}", mend.to.re, mend.to.im, mend.b));
        assert!(Run::new(&exact).is_ok(), "from {from:?} to {to:?}: {mend:?}");
    }
    true
}

/// The same for machines of so many drives each, two points of each that some pose reaches.
fn typed_back_on(drives: &[usize], shape: &str, tasks: usize, seed: u64) -> [usize; 3] {
    let mut noise = Noise::of(seed);
    let mut totals = [0; 3];
    for n in drives {
        let (machine, space) = a_space(&mut noise, *n);
        let plain = Scenario::builtin("two-drive").expect("built in");
        let base = Scenario { machine, compare_b: None, ..plain };
        let base = with(&base, "kind = 'reactionless'\nvia = []");
        for _ in 0..tasks {
            let mut end = || {
                let a = a_pose(&mut noise, &space);
                let p = space.end_effector(&space.lift(&a, noise.between(0.0, space.period())));
                [p.re, p.im].map(|x| (1e3 * x).round() / 1e3)
            };
            let ends = [end(), end()];
            let b = (100.0 * noise.between(-3.0, 9.0)).round() / 100.0;
            refused_and_typed(&base, shape, ends, b, &mut totals);
        }
    }
    totals
}

#[test]
fn what_is_proposed_for_any_number_of_drives_works_as_printed() {
    let [points, b, nothing] = typed_back_on(&[2, 2, 2, 3, 3, 4], "joint-line", 3, 61);
    assert!(points > 8 && b > 0, "{points} points, {b} b, {nothing} without");
}

#[test]
fn what_is_proposed_for_lines_of_four_drives_works_as_printed() {
    let [points, b, nothing] = typed_back_on(&[4], "line", 2, 73);
    assert!(points + b > 0, "{points} points, {b} b, {nothing} without");
}

#[test]
#[ignore = "long: hundreds of joint lines and three hundred lines of two to six drives"]
fn what_is_proposed_for_any_number_of_drives_works_often() {
    let of = |name: &str, or: u64| std::env::var(name).ok().and_then(|x| x.parse().ok()).unwrap_or(or);
    let all: Vec<usize> = (0..of("MACHINES", 100)).map(|i| 2 + i as usize % 5).collect();
    println!("{:?}", typed_back_on(&all, "joint-line", 8, of("SEED", 67)));
    let more: Vec<usize> = (0..60).map(|i| 3 + i % 3).collect();
    println!("{:?}", typed_back_on(&more, "line", 5, 71));
}

#[test]
fn what_is_proposed_for_joint_lines_works_as_printed() {
    let [points, b, nothing] = typed_back(&["joint-line"], 1000, 41);
    assert!(points > 250 && b > 150, "{points} points, {b} b, {nothing} without");
}

#[test]
fn what_is_proposed_for_lines_works_as_printed() {
    let [points, b, nothing] = typed_back(&["line"], 40, 43);
    assert!(points + b > 20, "{points} points, {b} b, {nothing} without");
}

#[test]
#[ignore = "long: a hundred thousand joint lines and a thousand lines and splines"]
fn what_is_proposed_works_as_printed_often() {
    println!("{:?}", typed_back(&["joint-line"], 100_000, 47));
    println!("{:?}", typed_back(&["line", "spline"], 1000, 53));
}

/// b that are shown for a target, and the ranges that are said, lie where they should.
#[test]
fn shown_b_reach_their_point() {
    let run = Run::new(&Scenario::builtin("case-3").expect("built in")).expect("it starts");
    let planes: &Planes = run.planes().expect("three drives");
    let mut noise = Noise::of(59);
    let mut tried = 0;
    while tried < 500 {
        let p = stillbase::mechanics::planar::Vector::new(noise.between(-1.26, 1.26), noise.between(-1.26, 1.26));
        let Ok(set) = planes.map().reach(p) else { continue };
        tried += 1;
        let nearest = set.nearest(noise.between(-9.0, 9.0)).expect("some b");
        let shown: f64 = set.decimal(nearest, 3).expect("enough digits").to_string().parse().expect("a number");
        assert!(!planes.map().poses(p, shown).is_empty(), "{p}: {shown} for {nearest}");
        let words = set.in_words();
        for end in words.split(' ').filter_map(|w| w.parse::<f64>().ok()) {
            assert!(!planes.map().poses(p, end).is_empty(), "{p}: {words}");
        }
    }
}

/// The widening of a limit names the angle as the machine does, whatever its angles are called.
#[test]
#[ignore = "long: machines of four drives are refused lines until a wider limit is proposed"]
fn a_widened_limit_has_the_name_of_its_angle() {
    let mut noise = Noise::of(83);
    let plain = Scenario::builtin("two-drive").expect("built in");
    let widened = (0..200).find_map(|_| {
        let (machine, space) = a_space(&mut noise, 4);
        let base = Scenario { machine, compare_b: None, ..plain.clone() };
        let base = with(&base, "kind = 'reactionless'\nvia = []");
        let mut end = || {
            let a = a_pose(&mut noise, &space);
            let p = space.end_effector(&space.lift(&a, noise.between(0.0, space.period())));
            [p.re, p.im].map(|x| (1e3 * x).round() / 1e3)
        };
        let ends = format!("from = {:?}\nto = {:?}", end(), end());
        let b = (100.0 * noise.between(-3.0, 9.0)).round() / 100.0;
        let task = with(&base, &format!("{ends}\nb = {b}\nshape = 'line'"));
        let words = Run::new(&task).err()?.to_string();
        words.contains("want limits.").then_some((task, words))
    });
    let (task, words) = widened.expect("a task that a wider limit makes feasible");
    // The same machine with the names of its angles exchanged.
    let mut spec = task.machine.spec().clone();
    let names: Vec<String> = spec.angles.iter().rev().map(|angle| angle.name.clone()).collect();
    spec.angles.iter_mut().zip(&names).for_each(|(angle, name)| angle.name.clone_from(name));
    let machine = stillbase::mechanics::machine::Machine::new(spec).expect("names may be any");
    let exchanged = Scenario { machine, ..task.clone() };
    let again = Run::new(&exchanged).expect_err("refused as well").to_string();
    let name = |words: &str| {
        words.split_once("want limits.").and_then(|(_, rest)| rest.split_once(" = ")).map(|(name, _)| name.to_owned())
    };
    let (old, new) = (name(&words).expect("a name"), name(&again).expect("a name"));
    let place = task.machine.spec().angles.iter().position(|angle| angle.name == old).expect("known");
    assert_eq!(new, names[place], "{words}\n{again}");
    let (_, tries) = proposals(&exchanged, &again, false);
    assert!(tries.iter().all(|proposed| Run::new(proposed).is_ok()), "{again}");
    assert!(!tries.is_empty());
}
