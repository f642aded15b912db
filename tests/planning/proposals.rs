//! What a refusal proposes works as printed: typed back, it is accepted.

use stillbase::planning::pose_constant::Planes;
use stillbase::session::scenario::{Change, Scenario};
use stillbase::session::{Refusal, Run};

use crate::support::Noise;

/// The number that stands behind some words.
fn number(text: &str, before: &str) -> Option<f64> {
    let rest = &text[text.find(before)? + before.len()..];
    let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')).unwrap_or(rest.len());
    rest[..end].parse().ok()
}

fn with(scenario: &Scenario, change: &str) -> Scenario {
    let change: Change = toml::from_str(change).expect("keys");
    Scenario { task: scenario.task.with(&change, &scenario.machine).expect("a task"), ..scenario.clone() }
}

/// Refused tasks between random points, and what became of what was proposed: points, b, and how often nothing was.
fn typed_back(shapes: &[&str], cases: usize, seed: u64) -> [usize; 3] {
    let base = Scenario { compare_b: None, ..Scenario::builtin("case-3").expect("built in") };
    let mut noise = Noise::of(seed);
    let mut totals = [0; 3];
    let mut refused = 0;
    while refused < cases {
        let mut coordinate = || (100.0 * noise.between(-1.0, 1.0)).round() / 100.0;
        let [from, to] = [[coordinate(), coordinate()], [coordinate(), coordinate()]];
        let b = (100.0 * noise.between(-3.0, 9.0)).round() / 100.0;
        let shape = shapes[refused % shapes.len()];
        let task = with(&base, &format!("from = {from:?}\nto = {to:?}\nb = {b}\nshape = '{shape}'"));
        let Err(refusal) = Run::new(&task) else { continue };
        refused += 1;
        let words = refusal.to_string();
        let mut tries: Vec<Scenario> = Vec::new();
        if let Some(b) = number(&words, " m would do, at b = ") {
            let name = if words.contains("moving A by") { "from" } else { "to" };
            let x = number(&words, " m to (").expect("x");
            let y = number(&words[words.find(" m to (").expect("a point")..], ", ").expect("y");
            tries.push(with(&task, &format!("{name} = [{x:?}, {y:?}]\nb = {b:?}")));
            totals[0] += 1;
        } else if let Some(b) = number(&words, "; b = ").or_else(|| number(&words, "want b = ")) {
            tries.push(with(&task, &format!("b = {b:?}")));
            totals[1] += 1;
        } else if words.contains("want b from ") && shape == "joint-line" {
            for range in words[words.find("want b ").expect("a range")..].split("from ").skip(1) {
                let low = range.split(' ').next().expect("an end");
                let high = range.split(' ').nth(2).expect("an end");
                tries.extend([low, high].map(|b| {
                    with(&task, &format!("b = {}", b.parse::<f64>().map(|b| format!("{b:?}")).expect("a number")))
                }));
            }
            totals[1] += 1;
        } else {
            totals[2] += 1;
        }
        for proposed in tries {
            if let Err(again) = Run::new(&proposed) {
                panic!("{shape} from {from:?} to {to:?} at b = {b}: {words}; typed back: {again}");
            }
        }
        // The window's button takes the exact one.
        if let Some(b) = refusal.mending_b() {
            let exact = Run::new(&with(&task, &format!("b = {b:?}")));
            assert!(exact.is_ok(), "{shape} from {from:?} to {to:?}: {words}; {b:?}");
        }
        if let Refusal::NoCommonPlane { why, .. } = &refusal
            && let (Some(mend), "joint-line") = (why.mend, shape)
        {
            let name = if mend.point == 0 { "from" } else { "to" };
            let exact = with(&task, &format!("{name} = [{:?}, {:?}]\nb = {:?}", mend.to.re, mend.to.im, mend.b));
            assert!(Run::new(&exact).is_ok(), "from {from:?} to {to:?}: {mend:?}");
        }
    }
    totals
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
