//! A block of an assembly that is led: the others move with it, and all share one base.

use stillbase::mechanics::assembly::{Assembly, parse};
use stillbase::mechanics::machine::named;
use stillbase::session::assembly::{AssemblyBase, AssemblyFrame, AssemblyScenario};
use stillbase::session::scenario::ScenarioError;
use stillbase::session::{Edit, Refusal, Session, replay};
use stillbase::simulation::frame::Frame;

use crate::folder::Folder;
use crate::support::close;

fn builtin(name: &str) -> AssemblyScenario {
    let keep = |assembly: Assembly| Ok::<_, ScenarioError>(assembly);
    let found = stillbase::files::assembly_scenario(name, &toml::Table::new(), keep).expect("valid");
    found.expect("an assembly")
}

const NAMES: [&str; 5] = ["four-freedoms", "wrist-across", "arm-against-arm", "hand-over", "off-its-pin"];

/// Two blocks on one base: one in the plane, one across; the second reacts, as it is off balance.
fn reacting() -> AssemblyScenario {
    let two = "kind = \"assembly\"\nname = \"two\"\n[[block]]\nname = \"a\"\nmachine = \"nine-link\"\n\
               [[block]]\nname = \"b\"\nmachine = \"two-drive\"\nat = [0.1, -0.3, 0.2]\nx = [0, 0, 1]\ny = [1, 0, 0]\n\
               set = [\"link.1.mass=3.1\", \"payload.mass=0.4\"]\n";
    let text = "machine = \"two\"\n[task.a]\nkind = \"minimum-norm\"\nb = 2.2\nfrom = [0.5, 0.5]\nto = [0.4, 0.6]\ntime = 0.5\n\
                [task.b]\nkind = \"given\"\nsamples = [[0, 0.3, 1.6], [0.1, 0.32, 1.65], [0.2, 0.4, 1.7], [0.3, 0.5, 1.9], \
                [0.4, 0.6, 2.0], [0.5, 0.62, 2.05], [0.6, 0.65, 2.1]]\n\
                [base]\nkind = \"free\"\nmass = 9\ninertia = [1.1, 1.3, 0.9]\ncom = [0.1, 0.2, -0.1]\n";
    AssemblyScenario::parse(text, "two.toml", parse(two, "two", &named).expect("an assembly")).expect("a scenario")
}

/// Whichever block is led, the base feels and does what the run of the whole says, at every step.
#[test]
fn all_blocks_share_one_base_whichever_is_led() {
    for whole in NAMES.map(builtin).into_iter().chain([reacting()]) {
        let mut wanted = Vec::new();
        let see = |frame: &AssemblyFrame| {
            wanted.push(frame.clone());
            true
        };
        let verdict = whole.run(see).expect("a run");
        for block in 0..whole.assembly.blocks().len() {
            let name = format!("{}, block {block} led", whole.name);
            let mut seen: Vec<Frame> = Vec::new();
            replay(&whole.leading(block), |_, frame| seen.push(*frame)).expect("a run");
            assert_eq!(seen.len(), wanted.len(), "{name}");
            for (frame, wanted) in seen.iter().zip(&wanted) {
                let shared = frame.shared.expect("a shared base");
                let scale = verdict.scale[0].max(verdict.scale[1]);
                close(&name, &shared.loads.motion.components(), &wanted.loads.motion.components(), 1e-7 * scale);
                close(&name, &shared.attitude.components(), &wanted.attitude.components(), 1e-8);
                close(&name, shared.origin.as_slice(), wanted.origin.as_slice(), 1e-8);
            }
            let last = seen[seen.len() - 1].shared.expect("a shared base");
            assert_eq!(last.silent(), verdict.silent(), "{name}");
            assert!((last.turn[0] - verdict.turn[0]).abs() < 1e-8, "{name}");
        }
    }
}

/// The base turns in the example of the tests above, so the comparison is not one of zeros.
#[test]
fn the_example_turns_its_base() {
    let verdict = reacting().run(|_| true).expect("a run");
    assert!(verdict.turn[0] > 1e-3 && verdict.peaks.iter().any(|peak| *peak > 0.1), "{verdict:?}");
}

/// A session that was led by hand is saved, read and replayed to equal frames; so is one whose blocks were led in turn.
#[test]
fn a_session_of_blocks_is_saved_and_opened_again() {
    let folder = Folder::new("led-blocks");
    for (number, whole) in NAMES.map(builtin).into_iter().chain([reacting()]).enumerate() {
        let mut session = Session::open(whole.leading(0)).expect("it opens");
        session.seek(0.2);
        let at = session.frame().end_effector;
        session.apply(Edit::DragTarget { x: at.re + 0.01, y: at.im - 0.005 }).expect("led by hand");
        session.play();
        session.tick(300);
        // Once more after all planned motions.
        session.seek(session.length());
        session.play();
        session.tick(5000);
        session.apply(Edit::DragTarget { x: at.re, y: at.im }).expect("led by hand");
        session.play();
        session.tick(200);
        let led = AssemblyScenario::of(&session.to_scenario()).expect("an assembly").leading(1);
        // Of the other block the session is longer: it goes on to the end of the first.
        let mut other = Session::open(led).expect("it opens");
        other.seek(session.frame().time);
        let (one, two) = (session.frame().shared.expect("shared"), other.frame().shared.expect("shared"));
        close("attitude", &one.attitude.components(), &two.attitude.components(), 1e-7);
        close("loads", &one.loads.motion.components(), &two.loads.motion.components(), 1e-6);
        let file = folder.path(&format!("{number}.toml"));
        std::fs::write(&file, session.to_scenario().to_toml()).expect("written");
        let found = stillbase::files::any_scenario(&file.display().to_string()).expect("it is read");
        assert_eq!(found.scenario.machine, session.scenario().machine);
        let mut again = Session::open(found.scenario).expect("it opens again");
        again.seek(session.frame().time);
        assert_eq!(again.frame(), session.frame(), "{}", whole.name);
        // The command line takes the saved session, too.
        let keep = |assembly: Assembly| Ok::<_, ScenarioError>(assembly);
        let saved = stillbase::files::assembly_scenario(&file.display().to_string(), &toml::Table::new(), keep);
        let saved = saved.expect("valid").expect("an assembly");
        let mut last = None;
        let see = |frame: &AssemblyFrame| {
            last = Some(frame.clone());
            true
        };
        saved.run(see).expect("a run");
        let last = last.expect("a frame");
        assert!((last.time - session.frame().time).abs() < 1e-9, "{}", whole.name);
        close("attitude", &last.attitude.components(), &one.attitude.components(), 1e-12);
    }
}

/// Machine and base of a block belong to its assembly.
#[test]
fn a_block_keeps_its_machine_and_its_base() {
    let mut session = Session::open(builtin("wrist-across").leading(1)).expect("it opens");
    let before = session.frame().to_owned();
    for edit in [
        Edit::set("link.1.mass", 2.0),
        Edit::set("base.kind", "free"),
        Edit::set("plant.payload.mass", 0.2),
        Edit::set("gravity", vec![0.0, -9.81]),
        Edit::Push { x: 1.0, y: 0.0 },
    ] {
        let why = session.apply(edit).expect_err("it belongs to the assembly");
        let Refusal::Task(said) = &why else { panic!("{why}") };
        assert!(said.contains("wrist is a block of the assembly carrier-and-wrist"), "{said}");
        assert!(said.contains("task, control"), "{said}");
    }
    assert_eq!(*session.frame(), before);
    session.apply(Edit::set("task.time", 1.5)).expect("what it does is its own");
    assert_eq!(session.length(), 2.0, "the carrier still takes two seconds");
}

/// An assembly by itself opens with a motion for each block.
#[test]
fn an_assembly_opens_with_motions_of_its_blocks() {
    for name in ["two-arms", "carrier-and-wrist"] {
        let found = stillbase::files::any_scenario(name).expect("it opens");
        assert!(found.note.is_some_and(|note| note.contains("each block")));
        let mut session = Session::open(found.scenario).expect("it starts");
        session.seek(10.0);
        let whole = AssemblyScenario::of(&session.to_scenario()).expect("an assembly");
        assert_eq!((whole.base, session.others().count()), (AssemblyBase::Fixed, 1));
        assert!(session.frame().shared.expect("shared").silent() == [true; 6], "{name}");
    }
}

/// Two machines of different inertia face each other, in parallel planes.
fn facing() -> AssemblyScenario {
    let two = "kind = \"assembly\"\nname = \"two\"\n[[block]]\nname = \"a\"\nmachine = \"nine-link\"\n\
               [[block]]\nname = \"b\"\nmachine = \"serial-3r\"\nat = [1.4, 0.2, 0.1]\nx = [-1, 0, 0]\ny = [0, 1, 0]\n";
    AssemblyScenario::for_assembly(parse(two, "two", &named).expect("an assembly")).expect("motions")
}

/// The b of one block slid by hand, that of another bound to it: the base feels nothing; without the bond it does.
#[test]
fn one_b_is_slid_against_another() {
    for led in [0, 1] {
        for is_bound in [true, false] {
            let mut whole = facing();
            let factor = whole.factor(led, 1 - led).expect("parallel");
            if is_bound {
                whole.bind([led, 1 - led]).expect("parallel");
            }
            let mut session = Session::open(whole.leading(led)).expect("it opens");
            session.seek(session.length());
            let b_of = |session: &Session| {
                let (_, other) = session.others().next().expect("another block");
                [session.frame().b, other.b]
            };
            let before = b_of(&session);
            session.play();
            session.apply(Edit::SlideB { b: before[0] + 0.3 }).expect("it slides");
            session.play();
            session.tick(3000);
            let moved = [0, 1].map(|i| b_of(&session)[i] - before[i]);
            close("own b", &[moved[0]], &[0.3], 1e-6);
            close("other b", &[moved[1]], &[if is_bound { 0.3 * factor } else { 0.0 }], 1e-6);
            let shared = session.frame().shared.expect("shared");
            assert_eq!(shared.silent() == [true; 6], is_bound, "block {led}: {:?}", shared.peaks);
            // Saved and led from the other side, nothing changes.
            let saved = AssemblyScenario::of(&session.to_scenario()).expect("an assembly");
            let mut other = Session::open(saved.leading(1 - led)).expect("it opens");
            other.seek(session.frame().time);
            let [own, bs] = [other.frame(), session.frame()].map(|frame| (frame.time, frame.b));
            let wanted = b_of(&session)[1];
            assert!((own.1 - wanted).abs() < 1e-9, "block {led}, bound {is_bound}: {own:?} {bs:?} {wanted}");
            assert_eq!(other.frame().shared.expect("shared").silent() == [true; 6], is_bound, "block {led}");
        }
    }
}

/// A planned change of b is followed by the bound block, also when its aim is set later; what cannot be bound is refused.
#[test]
fn a_planned_change_of_b_is_followed() {
    let mut whole = builtin("arm-against-arm");
    assert!((whole.factor(0, 1).expect("parallel") - 1.0).abs() < 1e-12, "mirrored twins");
    whole.bind([0, 1]).expect("parallel");
    let mut session = Session::open(whole.leading(0)).expect("it opens");
    for (b_to, time) in [(2.3, 3.0), (2.1, 2.0)] {
        session.apply(Edit::set("task.b_to", b_to)).expect("it plans");
        session.apply(Edit::set("task.time", time)).expect("it plans");
        session.seek(10.0);
        let shared = session.frame().shared.expect("shared");
        assert!(shared.turn[0] < 1e-9 && shared.silent() == [true; 6], "{shared:?}");
        let (_, other) = session.others().next().expect("another block");
        close("b", &[session.frame().b, other.b], &[b_to, b_to], 1e-6);
    }
    let text = AssemblyScenario::of(&session.to_scenario()).expect("an assembly").to_toml();
    assert!(text.contains("against = [\"left\", \"right\"]"), "{text}");
    let why = builtin("wrist-across").bind([0, 1]).expect_err("planes that cross");
    assert!(why.contains("at 90.00°: want parallel planes"), "{why}");
}
