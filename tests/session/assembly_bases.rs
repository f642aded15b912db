//! Bases of assemblies: momenta are kept, springs take what reaches the base, and faults are told.

use nalgebra::Vector3;
use stillbase::mechanics::assembly::{Assembly, builtin_assemblies};
use stillbase::session::assembly::{AssemblyBase, AssemblyFrame, AssemblyScenario, AssemblyVerdict};

use crate::support::close;

const TASKS: &str = "[task.carrier]\nkind = \"reactionless\"\nb = 3.279\nfrom = [0.476, 0.472]\nto = [0.349, 0.682]\n\
                     time = 1.0\n[task.wrist]\nkind = \"reactionless\"\nshape = \"joint-line\"\nb = 1.2\n\
                     from = [0.07398742964537879, -0.02601609376714779]\nto = [0.21307475131459737, -0.014593446615601108]\n\
                     time = 1.0\n";
const BODY: &str = "mass = 20.0\ninertia = [1.0, 1.2, 1.5]\ncom = [0.02, -0.05, -0.2]\n";

fn builtin(name: &str) -> Assembly {
    builtin_assemblies().iter().find(|own| own.name == name).expect("built in").clone()
}

fn scenario(assembly: &Assembly, base: &str) -> Result<AssemblyScenario, String> {
    let text = format!("machine = \"{}\"\n[base]\n{base}\n{TASKS}", assembly.name);
    AssemblyScenario::parse(&text, "base.toml", assembly.clone()).map_err(|why| why.to_string())
}

fn run(scenario: &AssemblyScenario) -> (AssemblyVerdict, Vec<AssemblyFrame>) {
    let mut all = Vec::new();
    let see = |frame: &AssemblyFrame| {
        all.push(frame.clone());
        true
    };
    (scenario.run(see).expect("a run"), all)
}

/// A base that spins at first keeps the momenta of the whole, whose sum is that of bodies one by one.
#[test]
fn momenta_are_kept_in_space() {
    let assembly = builtin("wrist-off-its-pin");
    let (linear, angular) = (Vector3::new(1.0, -2.0, 0.5), Vector3::new(0.3, -0.2, 0.4));
    let base = format!("kind = \"free\"\n{BODY}momentum = [1.0, -2.0, 0.5]\nangular_momentum = [0.3, -0.2, 0.4]");
    let scenario = scenario(&assembly, &base).expect("valid");
    let body = scenario.base.body().expect("a body").clone();
    let (verdict, all) = run(&scenario);
    assert!(verdict.turn[0] > 0.1, "{verdict:?}");
    // The centre of mass of everything moves on evenly.
    let mass = body.mass + assembly.mass();
    let com = |frame: &AssemblyFrame| {
        let still = Vector3::zeros();
        let own = assembly.base_motion(&body, &frame.states, &still).com;
        frame.origin + frame.attitude.0 * own
    };
    let first = com(&all[0]);
    for frame in all.iter().step_by(50) {
        let want = first + frame.time / mass * linear;
        close("centre of mass", com(frame).as_slice(), want.as_slice(), 1e-12);
        // L about it, from the rate and the momenta as seen from the base.
        let (own, seen) =
            (assembly.base_motion(&body, &frame.states, &Vector3::zeros()), assembly.momentum(&frame.states));
        let about = seen.angular - own.com.cross(&seen.linear);
        let kept = frame.attitude.0 * (own.inertia * frame.rate + about);
        close("angular momentum", kept.as_slice(), angular.as_slice(), 1e-9);
    }
    // The force on the base changes its momentum, and nothing else does.
    let place = |frame: &AssemblyFrame| frame.origin + frame.attitude.0 * body.com;
    for i in (10..all.len() - 10).step_by(97) {
        let h = all[i + 1].time - all[i].time;
        let pull = (place(&all[i + 4]) - 2.0 * place(&all[i]) + place(&all[i - 4])) / (16.0 * h * h);
        let force = all[i].attitude.0 * all[i].loads.motion.force;
        close("force", force.as_slice(), (body.mass * pull).as_slice(), 1e-3);
    }
}

/// Stiff springs leave the loads of a fixed base; soft ones let it move, and at rest it comes back.
#[test]
fn springs_hold_a_base() {
    let mut assembly = builtin("wrist-off-its-pin");
    let springs = |k: f64, d: f64| {
        let six = |x: f64| format!("[{x}, {x}, {x}, {0}, {0}, {0}]", 0.1 * x);
        format!("kind = \"compliant\"\n{BODY}stiffness = {}\ndamping = {}", six(k), six(d))
    };
    let (_, fixed) = run(&scenario(&assembly, "kind = \"fixed\"").expect("valid"));
    let (_, stiff) = run(&scenario(&assembly, &springs(2e6, 3e3)).expect("valid"));
    let most = fixed.iter().map(|frame| frame.loads.motion.moment.norm()).fold(0.0, f64::max);
    for (one, two) in fixed.iter().zip(&stiff).skip(200).step_by(50) {
        let off = (two.loads.motion.moment - one.loads.motion.moment).norm();
        assert!(off < 0.02 * most, "{off} of {most} at {} s", one.time);
    }
    assembly.set_gravity([0.0, 0.0, -9.81]).expect("in range");
    let soft = AssemblyScenario { duration: Some(4.0), ..scenario(&assembly, &springs(2e3, 2e2)).expect("valid") };
    let (verdict, all) = run(&soft);
    assert!(verdict.turn[0] > 1e-5 && verdict.shift > 1e-6, "{verdict:?}");
    // Preloaded it begins at rest, and the weight of the arms that has moved leaves it a little turned.
    assert!(all[0].rate.norm() < 1e-12 && all[5].origin.norm() < 1e-6);
    assert!(all[all.len() - 1].rate.norm() < 1e-5, "{:?}", all[all.len() - 1].rate);
    assert!(all.iter().all(|frame| frame.origin.norm() < 0.05));
    // It is written as it is read.
    let again = AssemblyScenario::parse(&soft.to_toml(), "again.toml", assembly.clone()).expect("valid");
    assert_eq!(again, soft);
    assert!(matches!(again.base, AssemblyBase::Compliant(_)));
}

#[test]
fn faults_of_bases_are_told() {
    let assembly = builtin("wrist-off-its-pin");
    let springs = "kind = \"compliant\"\nmass = 20\ninertia = [1, 1.2, 1.5]\n";
    for (base, words) in [
        (springs.to_owned(), "(base.stiffness) is missing: want six numbers"),
        (format!("{springs}stiffness = [1, 2, 3]"), "(base.stiffness) has 3 numbers: want six numbers"),
        (format!("{springs}stiffness = [1, 2, 3, 4, 5, -6]"), "stiffness has the eigenvalue -6: want none below 0"),
        (format!("{springs}stiffness = [1, 2, 3, 4, 5, nan]"), "(base.stiffness) is not a number: want -1e9 to 1e9"),
        (
            format!("{springs}stiffness = [1, 2, 3, 4, 5, 6]\ndamping = [1]"),
            "(base.damping) has 1 number: want six numbers",
        ),
        (
            format!("kind = \"free\"\n{BODY}momentum = [1, nan, 3]"),
            "momentum (base.momentum) is not a number: want -1e9 to 1e9",
        ),
        (format!("kind = \"free\"\n{BODY}stiffness = [1]"), "(base.stiffness) has 1 number: want six numbers"),
    ] {
        let why = scenario(&assembly, &base).expect_err(&base);
        assert!(why.contains(words), "{base}: {why}");
    }
    // What is sound and has no use is told apart, and kept when the scenario is written.
    for (base, want) in [
        (format!("{springs}stiffness = [1, 2, 3, 4, 5, 6]\nmomentum = [1, 2, 3]"), &["base.momentum"][..]),
        (format!("{BODY}damping = [1, 1, 1, 1, 1, 1]"), &["base.com", "base.damping", "base.inertia", "base.mass"]),
        (format!("kind = \"free\"\n{BODY}momentum = [1, 2, 3]"), &[]),
    ] {
        let found = scenario(&assembly, &base).expect(&base);
        let idle: Vec<(String, &str)> = found.ineffective_keys();
        assert_eq!(idle.iter().map(|(path, _)| path.as_str()).collect::<Vec<_>>(), want, "{base}");
        assert!(idle.iter().all(|(_, when)| when.starts_with("base.kind = ")), "{idle:?}");
        let again = AssemblyScenario::parse(&found.to_toml(), "again.toml", assembly.clone()).expect("valid");
        assert_eq!(again, found);
    }
    // A step too long for the springs is refused with one that does.
    let hard = format!("{springs}stiffness = [1e9, 1e9, 1e9, 1e8, 1e8, 1e8]");
    let hard = scenario(&assembly, &hard).expect("valid");
    let why = hard.run(|_| true).expect_err("too stiff").to_string();
    let step: f64 = why.rsplit_once("at most ").expect(&why).1.trim_end_matches(" s").parse().expect(&why);
    let shorter = AssemblyScenario { step, ..hard };
    let shorter = AssemblyScenario::parse(&shorter.to_toml(), "shorter.toml", assembly.clone()).expect("valid");
    shorter.run(|_| true).expect("as proposed");
}
