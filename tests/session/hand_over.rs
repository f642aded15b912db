//! Blocks whose end effectors meet pass each other what they hold.

use nalgebra::Complex;
use nalgebra::Vector3;
use stillbase::mechanics::assembly::{Assembly, parse};
use stillbase::mechanics::machine::named;
use stillbase::session::assembly::{AssemblyFrame, AssemblyScenario};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Refusal, Session};

use crate::support::close;

const BASE_MASS: f64 = 60.0;
// In the plane of the arms, so that the base does not tilt.
const BASE_COM: [f64; 3] = [0.0, -0.1, 0.0];
const BASE_INERTIA_Z: f64 = 6.0;

/// Loads of both arms: mass, kg, inertia, kg m², and offset, m.
type Load = (f64, f64, [f64; 2]);

fn arms(loads: [Load; 2]) -> Assembly {
    let block = |name: &str, (mass, inertia, [along, left]): Load, place: &str| {
        format!(
            "[[block]]\nname = {name:?}\nmachine = \"nine-link\"\nset = [\"payload.mass={mass}\", \
             \"payload.inertia={inertia}\", \"payload.offset={along},{left}\"]\n{place}\n"
        )
    };
    let [left, right] = loads;
    let text = format!(
        "kind = \"assembly\"\nname = \"arms\"\n{}{}",
        block("left", left, "at = [-0.7, 0, 0]"),
        block("right", right, "at = [0.7, 0, 0]\nx = [-1, 0, 0]\ny = [0, 1, 0]")
    );
    parse(&text, "arms", &named).expect("an assembly")
}

/// Each arm goes to the place between them, rests, and goes back; at 0.5 s a load changes hands.
fn scenario(assembly: Assembly, more: &str) -> AssemblyScenario {
    let task = |name: &str, to: [f64; 2]| {
        format!(
            "[task.{name}]\nkind = \"minimum-norm\"\nb = 2.0\nfrom = {to:?}\nvia = [[0.7, 0.45]]\nto = {to:?}\n\
             time = 1.0\n"
        )
    };
    let text = format!(
        "machine = \"arms\"\n[base]\nkind = \"free\"\nmass = {BASE_MASS}\ncom = {BASE_COM:?}\ninertia = [4, 5, 6]\n{}{}{more}",
        task("left", [0.55, 0.4]),
        task("right", [0.5, 0.5])
    );
    AssemblyScenario::parse(&text, "arms.toml", assembly).expect("a scenario")
}

const EDIT: &str = "[[scenario.left.edit]]\nstep = 500\ndo = \"hand-over\"\nfrom = \"left\"\nto = \"right\"\n";

fn frames(scenario: &AssemblyScenario) -> Vec<AssemblyFrame> {
    let mut all = Vec::new();
    let see = |frame: &AssemblyFrame| {
        all.push(frame.clone());
        true
    };
    scenario.run(see).expect("a run");
    all
}

/// A body: mass, kg, inertia about z, kg m², place, m, and angle about z of space, rad.
type Body = (f64, f64, Vector3<f64>, f64);

/// All bodies in space, from angles and lengths alone; `holds` says whose load is whose.
fn bodies(assembly: &Assembly, frame: &AssemblyFrame, loads: [Load; 2]) -> Vec<Body> {
    let turn = frame.attitude.0.angle() * frame.attitude.0.k.signum();
    let space = |p: Vector3<f64>| frame.origin + frame.attitude.0 * p;
    let mut all = vec![(BASE_MASS, BASE_INERTIA_Z, space(BASE_COM.into()), turn)];
    for ((block, state), (mass, inertia, [along, left])) in assembly.blocks().iter().zip(&frame.states).zip(loads) {
        let (machine, axes) = (&block.machine, &block.mount.axes);
        let place = |p: Complex<f64>| space(block.mount.at + axes * Vector3::new(p.re, p.im, 0.0));
        let unit = |k: usize| Complex::<f64>::from_polar(1.0, state.q[k]);
        let sum = |chain: &[Complex<f64>]| (0..3).map(|k| chain[k] * unit(k)).sum::<Complex<f64>>();
        let sense = axes[(2, 2)];
        for (j, link) in machine.links().iter().enumerate() {
            let drive = machine.resolved_links()[j].drive;
            all.push((link.mass, link.inertia, place(sum(&machine.com_chain(j))), turn + sense * state.q[drive]));
        }
        let held = &machine.resolved_links()[machine.end_link()];
        let tip: Complex<f64> = (0..3).map(|k| machine.end_effector()[k] * unit(k)).sum();
        let off = Complex::<f64>::new(along, left) * held.sign * unit(held.drive);
        all.push((mass, inertia, place(tip + off), turn + sense * state.q[held.drive]));
    }
    all
}

/// A load that goes over alone, with inertia and beside the end effector: the common centre of mass rests, and so does the
/// angular momentum, counted body by body; the load stays where it is, and the base turns.
#[test]
fn momentum_is_kept_through_a_hand_over() {
    for loads in
        [[(0.6, 0.0, [0.0; 2]), (0.0, 0.0, [0.0; 2])], [(0.5, 0.02, [0.04, -0.03]), (0.2, 0.01, [-0.02, 0.05])]]
    {
        let assembly = arms(loads);
        let all = frames(&scenario(assembly.clone(), EDIT));
        assert_eq!(all.len(), 1001);
        let [first, second] = loads;
        // The angle between the two links that hold, at the hand-over, turns the offset.
        let at = &all[500];
        let holder = |i: usize| {
            let machine = &assembly.blocks()[i].machine;
            let link = &machine.resolved_links()[machine.end_link()];
            let along = Complex::<f64>::from_polar(link.sign, at.states[i].q[link.drive]);
            // The right arm is seen from the other side.
            if i == 0 { along } else { -along.conj() }
        };
        let [one, two] = [0, 1].map(holder);
        let taken = |(mass, inertia, [x, y]): Load, from: usize| {
            let (own, other) = if from == 0 { (one, two) } else { (two, one) };
            let local = if from == 0 { Complex::<f64>::new(x, y) } else { Complex::<f64>::new(x, -y) };
            let off = own * local / other;
            (mass, inertia, if from == 0 { [off.re, -off.im] } else { [off.re, off.im] })
        };
        let after = [taken(second, 1), taken(first, 0)];
        let held = |i: usize| if i < 500 { loads } else { after };
        let (before, since) = (bodies(&assembly, at, loads), bodies(&assembly, at, after));
        let place = |bodies: &[Body], mass: f64| {
            let load = bodies.iter().filter(|(own, ..)| *own == mass).map(|(.., place, _)| *place);
            load.collect::<Vec<_>>()
        };
        close("place", place(&before, first.0)[0].as_slice(), place(&since, first.0)[0].as_slice(), 1e-9);
        let com = |bodies: &[Body]| {
            let mass: f64 = bodies.iter().map(|(m, ..)| m).sum();
            bodies.iter().map(|(m, _, place, _)| *m * place).sum::<Vector3<f64>>() / mass
        };
        let start = com(&bodies(&assembly, &all[0], loads));
        let mut turned: f64 = 0.0;
        for (i, frame) in all.iter().enumerate() {
            close("com", com(&bodies(&assembly, frame, held(i))).as_slice(), start.as_slice(), 1e-9);
            turned = turned.max(frame.attitude.0.angle());
            if i % 25 != 10 {
                continue;
            }
            let near = [-2_i64, -1, 1, 2].map(|d| bodies(&assembly, &all[(i as i64 + d) as usize], held(i)));
            let here = bodies(&assembly, frame, held(i));
            // Central differences of fourth order.
            let about: f64 = (0..here.len())
                .map(|k| {
                    let [p, q, r, s] = near.each_ref().map(|of| of[k].2);
                    let [a, b, c, d] = near.each_ref().map(|of| of[k].3);
                    let speed = (8.0 * (r - q) - (s - p)) / 12e-3;
                    let rate = (8.0 * (c - b) - (d - a)) / 12e-3;
                    here[k].0 * here[k].2.cross(&speed).z + here[k].1 * rate
                })
                .sum();
            assert!(about.abs() < 1e-7, "step {i}: {about} kg m²/s");
        }
        assert!(turned > 1e-3, "{turned}");
    }
}

/// Whichever block is led, and in whichever block's script the edit stands.
#[test]
fn a_hand_over_is_the_same_whichever_block_is_led() {
    let loads = [(0.6, 0.01, [0.02, 0.0]), (0.1, 0.0, [0.0; 2])];
    let ends = [("left", "left"), ("left", "right"), ("right", "left"), ("right", "right")].map(|(lead, script)| {
        let edit = EDIT.replace("scenario.left", &format!("scenario.{script}"));
        let own = scenario(arms(loads), &edit);
        let lead = usize::from(lead == "right");
        let last = frames(&AssemblyScenario { lead, ..own }).pop().expect("a frame");
        let six = last.loads.motion.components();
        last.attitude.components().into_iter().chain(six).chain([last.origin.x, last.origin.y]).collect::<Vec<f64>>()
    });
    for end in &ends[1..] {
        close("end", end, &ends[0], 1e-10);
    }
}

fn said(why: Refusal) -> String {
    why.to_string()
}

#[test]
fn what_cannot_be_handed_over_says_why() {
    let found = stillbase::files::any_scenario("hand-over").expect("built in");
    let mut session = Session::open(found.scenario).expect("it opens");
    let over = |from: &str, to: &str| Edit::HandOver { from: from.into(), to: to.into() };
    session.seek(1.5);
    let why = said(session.apply(over("left", "right")).expect_err("apart"));
    assert!(
        why.contains("the end effectors of left and right are apart by 0.") && why.contains("at most 0.001 m"),
        "{why}"
    );
    for (from, to, words) in [
        ("left", "left", "left stands there twice: want two blocks"),
        ("left", "third", "to names no block: \"third\"; want one of left, right"),
        ("", "left", "from names no block: \"\""),
    ] {
        let why = said(session.apply(over(from, to)).expect_err("wrong"));
        assert!(why.contains(words), "{why}");
    }
    // Planes that cross, arms that hold nothing, arms that fly past each other, and a machine by itself.
    let mut across =
        Session::open(stillbase::files::any_scenario("wrist-across").expect("built in").scenario).expect("open");
    let why = said(across.apply(over("carrier", "wrist")).expect_err("planes"));
    assert!(why.contains("are at 90.00°: want parallel planes"), "{why}");
    let none = scenario(arms([(0.0, 0.0, [0.0; 2]); 2]), "");
    let why =
        said(Session::open(none.leading(0)).expect("open").apply(over("left", "right")).expect_err("nothing held"));
    assert!(why.contains("neither left nor right holds anything: want payload.mass above 0"), "{why}");
    let mut alone = Session::open(Scenario::builtin("case-3").expect("built in")).expect("open");
    let why = said(alone.apply(over("a", "b")).expect_err("alone"));
    assert!(why.contains("blocks of an assembly"), "{why}");
}

/// By hand in the window: handed over where they meet, told as balanced or not, undone, saved and opened again.
#[test]
fn a_hand_over_is_undone_saved_and_judged() {
    let whole = scenario(arms([(0.4, 0.0, [0.0; 2]), (0.0, 0.0, [0.0; 2])]), "");
    let mut session = Session::open(whole.leading(0)).expect("it opens");
    session.seek(0.5);
    let masses = |session: &Session| {
        let shared = session.frame().shared.expect("shared");
        let other = session.others().next().and_then(|(_, frame)| frame.shared).expect("shared");
        [shared.held.mass, other.held.mass]
    };
    assert_eq!(masses(&session), [0.4, 0.0]);
    let before = *session.frame();
    session.apply(Edit::HandOver { from: "left".into(), to: "right".into() }).expect("they meet");
    assert_eq!(masses(&session), [0.0, 0.4]);
    let statement = stillbase::session::verdict::Statements::of(session.run(), session.frame());
    assert_eq!(statement.machine.words, "off balance by 0.2000 kg m");
    session.undo().expect("undone");
    session.seek(0.5);
    assert_eq!((masses(&session), session.frame().step), ([0.4, 0.0], before.step));
    session.redo().expect("done again");
    session.play();
    session.tick(300);
    let text = session.to_scenario().to_toml();
    assert!(text.contains("hand-over"), "{text}");
    let assembly = arms([(0.4, 0.0, [0.0; 2]), (0.0, 0.0, [0.0; 2])]);
    let again = AssemblyScenario::parse(&text, "again.toml", assembly).expect("a scenario");
    let mut again = Session::open(again.leading(0)).expect("it opens");
    again.seek(session.frame().time);
    assert_eq!(again.frame(), session.frame());
}
