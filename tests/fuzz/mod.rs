//! Files and arguments changed at random: each ends in an answer or a short error, without panic, endless loop or
//! gigabytes.
//!
//! Inputs are good ones with numbers, keys, lines and bytes changed, as a seed decides: a failure prints its seed and
//! number, and is made again by them. What has failed once stays in `tests/corpus` and is tried first.
//! `STILLBASE_FUZZ_SECONDS` bounds how long each target goes on, `STILLBASE_FUZZ_INPUTS` how many inputs it takes (a
//! small number without either), `STILLBASE_FUZZ_SEED` and `STILLBASE_FUZZ_FIRST` say where it begins.

#[cfg(feature = "cli")]
mod commands;
mod mutation;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use stillbase::exchange::cut::Cut;
use stillbase::exchange::import::import;
use stillbase::exchange::mjcf::{middle, mjcf};
use stillbase::exchange::urdf::urdf;
use stillbase::mechanics::machine::{self, Inertia};
use stillbase::mechanics::planar::Vector;
use stillbase::planning::pose_space::{PoseSpace, plane_map};
use stillbase::session::scenario::{MachineFile, Scenario};
use stillbase::session::{Session, replay};

use crate::exchange::arms::{THREE, TWO};
use crate::exchange::ordinary::ARM;
use mutation::{Dice, mutated};

const MACHINES: [&str; 3] = [
    include_str!("../../assets/machines/nine-link.toml"),
    include_str!("../../assets/machines/nine-link-table-1.toml"),
    concat!(
        include_str!("../../assets/machines/two-drive.toml"),
        "\n[design]\nshape = \"half-ring\"\ninner_radius = 0.012\nclearance = 0.006\npayload = [0.0, 0.2]\n\
         fixed = { 2 = true }\nlength.l1 = [0.3, 0.6]\nhold.link.1 = { mass = [0.4, 0.8], com = \"fixed\" }\n"
    ),
];

const SCENARIOS: [&str; 12] = [
    include_str!("../../assets/scenarios/case-1.toml"),
    include_str!("../../assets/scenarios/case-2.toml"),
    include_str!("../../assets/scenarios/case-3.toml"),
    include_str!("../../assets/scenarios/circle.toml"),
    include_str!("../../assets/scenarios/change-b.toml"),
    include_str!("../../assets/scenarios/least-reaction.toml"),
    include_str!("../../assets/scenarios/drift.toml"),
    include_str!("../../assets/scenarios/spacecraft.toml"),
    include_str!("../../assets/scenarios/bench-top.toml"),
    include_str!("../../assets/scenarios/pick-up.toml"),
    include_str!("../../assets/scenarios/friction.toml"),
    include_str!("../../assets/scenarios/wheel.toml"),
];

const SESSION: &str = r#"
machine = "nine-link"
step = 0.01
duration = 0.3
[task]
kind = "reactionless"
from = [0.5, 0.5]
to = [0.55, 0.9]
b = 2.4
time = 0.3
[[edit]]
step = 0
do = "set-plant"
change = { payload = { mass = 0.1, offset = [0.01, 0.0] }, friction = { coulomb = 0.01 } }
[[edit]]
step = 0
do = "set-task"
change = { shape = "spline", via = [[0.6, 0.7]] }
[[edit]]
step = 3
do = "drag-target"
x = 0.6
y = 0.7
[[edit]]
step = 4
do = "drag-angles"
a1 = 1.2
a2 = 2.0
[[edit]]
step = 5
do = "slide-b"
b = 2.45
[[edit]]
step = 7
do = "push"
x = 1.5
y = -2.0
[[edit]]
step = 9
do = "set-control"
change = { kp = 300.0, kd = 35.0 }
[[edit]]
step = 11
do = "set-machine"
key = "limits.a1"
value = "0.1,3.0"
[[edit]]
step = 12
do = "pose-b"
b = 2.5
[[edit]]
step = 13
do = "compare-b"
b = 2.0
[[edit]]
step = 14
do = "set-tolerance"
change = { moment_limit = 0.01, "link.*.com" = { normal = 0.0005 } }
[[bookmark]]
time = 0.1
name = "here"
[[note]]
text = "look"
pin = ["1", "5"]
time = 0.1
until = 0.2
[[note]]
text = "there"
on = "end effector"
[[branch]]
duration = 0.2
[[branch.edit]]
step = 4
do = "slide-b"
b = 2.5
"#;

/// Four drives: what only they have, by every edit that three do not take.
const SESSION_OF_FOUR: &str = r#"
machine = "four-drive"
step = 0.01
duration = 0.3
[task]
kind = "reactionless"
shape = "line"
from = [0.6, 0.5]
to = [0.55, 0.55]
b = 2.9
time = 0.3
posture = "mid-range"
[[edit]]
step = 2
do = "pull-link"
link = "2"
along = 0.2
x = 0.1
y = 0.3
[[edit]]
step = 4
do = "drag-target"
x = 0.5
y = 0.6
[[edit]]
step = 6
do = "slide-b"
b = 3.0
[[edit]]
step = 8
do = "set"
change = { task = { posture = "orientation" }, base = { kind = "free" } }
[[edit]]
step = 9
do = "set"
change = { link = { 2 = { mass = 1.5 } }, limits = { a3 = [0.2, 2.9] } }
[[bookmark]]
time = 0.05
name = "pulled"
[[branch]]
duration = 0.2
[[branch.edit]]
step = 1
do = "pull-link"
link = "3"
along = 0.1
x = 0.2
y = 0.2
"#;

/// How long one input may take.
const PATIENCE: Duration = Duration::from_secs(if cfg!(debug_assertions) { 60 } else { 10 });
/// How much one input may add to what the process holds, bytes.
const MEMORY: u64 = 2 << 30;

/// A message is short, and its numbers are.
pub fn is_short(said: &str) -> Result<(), String> {
    let digits = said.split(|c: char| !c.is_ascii_digit()).map(str::len).max().unwrap_or(0);
    // What somebody wrote may be quoted.
    let own: String = said.split(['"', '`']).step_by(2).collect();
    // A key holds names that somebody wrote, `link.NaN.mass`.
    let nan = own.split_whitespace().any(|word| word.trim_matches(|c: char| !c.is_alphanumeric()) == "NaN");
    match said.chars().count() > 1500 || digits > 30 || nan || said.trim().is_empty() {
        true => Err(format!(
            "a message of {} characters: {}",
            said.chars().count(),
            said.chars().take(600).collect::<String>()
        )),
        false => Ok(()),
    }
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

fn held() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok()).map_or(0, |kb| kb << 10)
}

/// Processor time of this process, s; endless where nobody tells.
fn spent() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // After the name, which may hold anything; times are the 14th and 15th word, in hundredths.
    let words = stat.rsplit(')').next().unwrap_or_default().split_whitespace().skip(11).take(2);
    let ticks: Vec<f64> = words.filter_map(|w| w.parse().ok()).collect();
    if ticks.len() == 2 { 0.01 * (ticks[0] + ticks[1]) } else { f64::INFINITY }
}

/// Tries a check on what has failed before, and on inputs made of good ones.
pub fn fuzz(target: &str, good: &[Vec<u8>], few: u64, check: impl Fn(&[u8], &mut Dice) -> Result<(), String>) {
    let seconds = variable("STILLBASE_FUZZ_SECONDS");
    let inputs = variable("STILLBASE_FUZZ_INPUTS").unwrap_or(if seconds.is_some() { u64::MAX } else { few });
    let (seed, first) = (variable("STILLBASE_FUZZ_SEED").unwrap_or(1), variable("STILLBASE_FUZZ_FIRST").unwrap_or(0));
    let now = Arc::new(Mutex::new((String::new(), Vec::new())));
    let (beat, beats) = channel::<()>();
    // An input that never ends is written down, and ends the process.
    let watched = now.clone();
    let watch = std::thread::spawn(move || {
        let mut begun = spent();
        loop {
            match beats.recv_timeout(PATIENCE) {
                Ok(()) => begun = spent(),
                Err(RecvTimeoutError::Disconnected) => return,
                // A machine that is busy with other things is not to blame.
                Err(RecvTimeoutError::Timeout) if spent() - begun < 0.5 * PATIENCE.as_secs_f64() => continue,
                Err(RecvTimeoutError::Timeout) => {
                    let (what, bytes) = &*watched.lock().expect("not poisoned");
                    eprintln!("{what}: no end after {PATIENCE:?}; see {}", keep(what, bytes).display());
                    std::process::abort();
                }
            }
        }
    });
    let mut before = held();
    let mut run = |what: String, bytes: Vec<u8>, dice: &mut Dice| {
        *now.lock().expect("not poisoned") = (what.clone(), bytes.clone());
        let _ = beat.send(());
        let done = catch_unwind(AssertUnwindSafe(|| check(&bytes, dice)));
        let fail = |why: String| panic!("{what}: {why}; see {}", keep(&what, &bytes).display());
        match done {
            Ok(Ok(())) => {}
            Ok(Err(why)) => fail(why),
            Err(panic) => {
                let words = panic.downcast_ref::<String>().cloned();
                fail(format!(
                    "panic: {}",
                    words.or(panic.downcast_ref::<&str>().map(|s| (*s).into())).unwrap_or_default()
                ));
            }
        }
        let after = held();
        if after > before + MEMORY {
            fail(format!("{} MB more than before", (after - before) >> 20));
        }
        before = after;
    };
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(target);
    let mut known: Vec<PathBuf> = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).collect();
    known.sort();
    for file in &known {
        run(
            format!("{target} {}", file.display()),
            std::fs::read(file).expect("readable"),
            &mut Dice::new(seed, target, 0),
        );
    }
    let began = Instant::now();
    let mut count = 0;
    while count < inputs && seconds.is_none_or(|s| began.elapsed() < Duration::from_secs(s)) {
        let mut dice = Dice::new(seed, target, first + count);
        let start = &good[dice.below(good.len())];
        let other = &good[dice.below(good.len())];
        let bytes = mutated(start, other, &mut dice);
        let what = format!("STILLBASE_FUZZ_SEED={seed} STILLBASE_FUZZ_FIRST={} {target}", first + count);
        run(what, bytes, &mut dice);
        count += 1;
    }
    drop(beat);
    watch.join().expect("it watches");
    println!(
        "{target}: {count} inputs and {} kept ones from seed {seed} in {:.1} s",
        known.len(),
        began.elapsed().as_secs_f64()
    );
}

/// Writes an input down.
fn keep(what: &str, bytes: &[u8]) -> PathBuf {
    let name: String = what.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    let tail: String = name.chars().rev().take(80).collect::<Vec<_>>().into_iter().rev().collect();
    let file = PathBuf::from(option_env!("CARGO_TARGET_TMPDIR").unwrap_or("/tmp")).join(format!("fuzz{tail}"));
    let _ = std::fs::write(&file, bytes);
    file
}

pub fn bytes(texts: &[&str]) -> Vec<Vec<u8>> {
    texts.iter().map(|text| text.as_bytes().to_vec()).collect()
}

#[test]
fn machines() {
    fuzz("machine", &bytes(&MACHINES), 300, |bytes, dice| {
        let text = String::from_utf8_lossy(bytes);
        let file = match MachineFile::parse(&text, "in.toml") {
            Ok(file) => file,
            Err(error) => return is_short(&error.to_string()),
        };
        let again = MachineFile::parse(&file.to_toml(), "again.toml").map_err(|e| format!("not read back: {e}"))?;
        if again != file {
            return Err("read back as another".into());
        }
        let machine = file.machine;
        let inertia = Inertia::of(&machine);
        if !(0..machine.drives()).all(|k| inertia.diagonal(k) > 0.0 && inertia.diagonal(k).is_finite()) {
            return Err("a mass matrix that is none".into());
        }
        match plane_map(&machine) {
            Err(error) => is_short(&error.to_string())?,
            Ok(map) if dice.one_in(4) => {
                let p = Vector::new(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0));
                let _ = map.poses(p, dice.between(-1e3, 1e3)).iter().count();
                if let Err(why) = map.reach(p) {
                    is_short(&why.to_string())?;
                }
                if dice.one_in(16)
                    && let Err(why) = PoseSpace::of(&machine)
                {
                    is_short(&why.to_string())?;
                }
            }
            Ok(_) => {}
        }
        Ok(())
    });
}

/// Models of other programs.
#[test]
fn models() {
    let machines = ["nine-link-geared", "serial-3r", "two-drive"].map(|name| machine::builtin(name).expect("built in"));
    let good: Vec<Vec<u8>> = machines
        .iter()
        .flat_map(|machine| {
            [
                urdf(machine, None, &Cut::default()),
                mjcf(machine, None, &middle(machine), &Cut::default()).expect("a model"),
            ]
        })
        .chain([TWO.to_owned(), THREE.to_owned(), ARM.to_owned()])
        .map(String::into_bytes)
        .collect();
    fuzz("model", &good, 300, |bytes, _| match import(&String::from_utf8_lossy(bytes)) {
        Err(error) => is_short(&error.to_string()),
        Ok(found) => {
            let machine = found.machine;
            let again =
                machine::parse(&machine::to_toml(&machine), "again.toml").map_err(|e| format!("not read back: {e}"))?;
            match again == machine && found.pose.iter().all(|q| q.is_finite()) {
                true => found.notes.iter().try_for_each(|note| is_short(note)),
                false => Err("read back as another".into()),
            }
        }
    });
}

/// What is made to hurt: it ends at once, in a short error.
#[test]
fn hostile_models() {
    let deep = |element: &str| element.repeat(200_000);
    let many = |text: &dyn Fn(usize) -> String| (0..60_000).map(text).collect::<String>();
    let bomb = "<!DOCTYPE r [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\"><!ENTITY c \
                \"&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;\">]><robot name=\"&c;\"/>";
    let link = |i: usize| format!("<link name=\"l{i}\"/>");
    let joint = |i: usize| {
        let next = i + 1;
        format!("<joint name=\"j{i}\" type=\"continuous\"><parent link=\"l{i}\"/><child link=\"l{next}\"/></joint>")
    };
    let body = "<body><joint/><inertial mass=\"1\" diaginertia=\"1 1 1\"/>";
    let connect = |i: usize| format!("<connect site1=\"a{i}\" site2=\"b\"/>");
    let motor = |_: usize| "<motor joint=\"a\"/>".to_owned();
    let space = |i: usize| format!("<a xmlns:n{i}=\"u\">");
    let attribute = |i: usize| format!(" a{i}=\"1\"");
    let class = |i: usize| format!("<default class=\"c{i}\"><geom a{i}=\"1\"/></default>");
    let value = |i: usize| format!("<geom a{i}=\"1\"/>");
    let keeps = |_: usize| "<joint joint1=\"a\" joint2=\"a\"/>".to_owned();
    let tendon = |i: usize| format!("<fixed name=\"t{i}\"><joint joint=\"a\" coef=\"1\"/></fixed>");
    let one = "<worldbody><body><joint name=\"a\"/><inertial mass=\"1\" diaginertia=\"1 1 1\"/></body></worldbody>";
    for text in [
        deep("<robot>"),
        format!("<robot>{}", deep("<link>")),
        format!("<robot>{}{}</robot>", deep("<a>"), deep("</a>")),
        bomb.to_owned(),
        format!("<robot>{}{}</robot>", many(&link), many(&joint)),
        format!("<mujoco><worldbody>{}{}</worldbody></mujoco>", body.repeat(30_000), "</body>".repeat(30_000)),
        format!("<mujoco>{one}<equality>{}</equality></mujoco>", many(&connect)),
        format!("<mujoco>{one}<actuator>{}</actuator></mujoco>", many(&motor)),
        format!("<mujoco>{one}<keyframe><key qpos=\"{}\"/></keyframe></mujoco>", "1 ".repeat(1_000_000)),
        format!("<robot name=\"{}\"/>", "x".repeat(1_000_000)),
        format!("<robot>{}", many(&space)),
        format!("<robot><link{}/></robot>", many(&attribute)),
        format!("<mujoco><default>{}</default>{one}</mujoco>", many(&class)),
        format!("<mujoco><default>{}</default>{one}</mujoco>", many(&value)),
        format!("<mujoco>{one}<equality>{}</equality></mujoco>", many(&keeps)),
        format!("<mujoco>{one}<tendon>{}</tendon></mujoco>", many(&tendon)),
        format!(
            "<mujoco>{one}<tendon><fixed name=\"t\">{}</fixed></tendon></mujoco>",
            "<joint joint=\"a\"/>".repeat(60_000)
        ),
        "\u{feff}<robot/>".to_owned(),
        String::new(),
    ] {
        let begun = Instant::now();
        let why = import(&text).map(|_| ()).expect_err("no machine").to_string();
        is_short(&why).unwrap_or_else(|why| panic!("{why}"));
        assert!(begun.elapsed() < PATIENCE, "{}", &text[..60.min(text.len())]);
    }
}

#[test]
fn scenarios() {
    fuzz("scenario", &bytes(&SCENARIOS), 150, |bytes, dice| {
        let text = String::from_utf8_lossy(bytes);
        let scenario = match Scenario::parse(&text, "in.toml", None) {
            Ok(scenario) => scenario,
            Err(error) => return is_short(&error.to_string()),
        };
        let again =
            Scenario::parse(&scenario.to_toml(), "again.toml", None).map_err(|e| format!("not read back: {e}"))?;
        if again != scenario {
            return Err("read back as another".into());
        }
        if dice.one_in(4) {
            let short = Scenario { duration: Some(3.0 * scenario.step), edits: Vec::new(), ..scenario };
            let mut sound = true;
            match replay(&short, |_, frame| sound &= frame.is_finite()) {
                Ok(_) if !sound => return Err("a frame that is not finite".into()),
                Ok(_) => {}
                Err(refusal) => is_short(&refusal.to_string())?,
            }
        }
        Ok(())
    });
}

#[test]
fn sessions() {
    fuzz("session", &bytes(&[SESSION, SESSION_OF_FOUR]), 60, |bytes, dice| {
        let text = String::from_utf8_lossy(bytes);
        let scenario = match Scenario::parse(&text, "in.toml", None) {
            Ok(scenario) => scenario,
            Err(error) => return is_short(&error.to_string()),
        };
        // A long run says nothing that a short one does not.
        let duration = scenario.duration.map(|d| d.min(60.0 * scenario.step));
        if dice.one_in(2) {
            let saved = Scenario { duration, ..scenario.clone() };
            if let Err(refusal) = replay(&saved, |_, _| {}) {
                is_short(&refusal.to_string())?;
            }
        }
        let edits = scenario.edits.clone();
        let mut session = match Session::open(Scenario { edits: Vec::new(), duration, ..scenario }) {
            Ok(session) => session,
            Err(refusal) => return is_short(&refusal.to_string()),
        };
        for timed in edits {
            if let Err(refusal) = session.apply(timed.edit) {
                is_short(&refusal.to_string())?;
            }
            if dice.one_in(3) {
                session.end_gesture();
            }
            session.tick(dice.below(4) as u64);
            if dice.one_in(6)
                && let Err(refusal) = session.undo()
            {
                is_short(&refusal.to_string())?;
            }
            if dice.one_in(6)
                && let Err(refusal) = session.switch_branch_while(dice.below(3), &mut |_| true)
            {
                is_short(&refusal.to_string())?;
            }
        }
        let saved = session.to_scenario();
        let read = Scenario::parse(&saved.to_toml(), "saved.toml", None).map_err(|e| format!("not read back: {e}"))?;
        if read != saved {
            return Err("read back as another".into());
        }
        // What was done by hand is replayed to the same frames, unless the numbers blow up.
        let mut frames = Vec::new();
        match replay(&read, |_, frame| frames.push(*frame)) {
            Ok(_) if session.frames().len() > 1 && *session.frames() != frames => {
                Err("replayed to other frames".into())
            }
            Ok(_) => Ok(()),
            Err(refusal) => is_short(&refusal.to_string()),
        }
    });
}

/// What a program that was killed has left behind, whatever became of its bytes.
#[cfg(feature = "window")]
#[test]
fn journals() {
    use stillbase::app::ResumePoint;
    use stillbase::files::{journal, scenario};
    const LEFT: &str = "#| time = 0.3\n#| [plots]\n#| statistics = true\n#| own = [\"plot 1\"]\n\
                        #| [plots.changes.\"plot 1\"]\n#| added = [\"torque/1\"]\n#| values = [0.0, 1.0]\n";
    let folder = crate::folder::Folder::new("fuzz-journals");
    let file = folder.path("session-0.toml");
    let headed = format!("{LEFT}{SESSION}");
    fuzz("journal", &bytes(&[SESSION, SESSION_OF_FOUR, &headed]), 40, |bytes, dice| {
        let text = String::from_utf8_lossy(bytes);
        if ResumePoint::of(&text).is_some_and(|left| !(left.time >= 0.0 && left.time.is_finite())) {
            return Err("left off at no instant".into());
        }
        let cut = if dice.one_in(2) { dice.below(bytes.len() + 1) } else { bytes.len() };
        std::fs::write(&file, &bytes[..cut]).map_err(|e| e.to_string())?;
        let left = journal::leftover_journals(&folder.0);
        let [found] = &left[..] else { return Err(format!("{} sessions were left behind", left.len())) };
        match scenario(&found.file.to_string_lossy()) {
            Err(error) => is_short(&error.to_string()),
            Ok(found) => {
                let duration = found.scenario.duration.map(|d| d.min(20.0 * found.scenario.step));
                match Session::open(Scenario { duration, ..found.scenario }) {
                    Ok(_) => Ok(()),
                    Err(refusal) => is_short(&refusal.to_string()),
                }
            }
        }
    });
}

/// How a person likes the window, as any program or hand may have changed it.
#[cfg(feature = "ui")]
#[test]
fn preferences() {
    use stillbase::app::Preferences;
    const CHANGED: &str = "theme = \"light\"\nsize = [1300.0, 820.0]\nhints = false\nlayout = \"compare\"\nswapped = true\n\
                           side_width = 300.0\nplots = false\nplots_width = 500.5\nrecent = [\"a.toml\", \"b/c.toml\"]\n";
    let usual = toml::to_string(&Preferences::default()).expect("plain data");
    fuzz("preferences", &bytes(&[&usual, CHANGED]), 300, |bytes, _| {
        let Ok(read) = toml::from_str::<Preferences>(&String::from_utf8_lossy(bytes)) else { return Ok(()) };
        let sound = read.sound();
        let widths = [sound.side_width, sound.plots_width, sound.compare_side_width, sound.compare_plots_width];
        let is_sane = |x: f32| (100.0..=16_000.0).contains(&x);
        if !sound.size.into_iter().chain(widths.into_iter().flatten()).all(is_sane) || sound.recent.len() > 32 {
            return Err(format!("a window that cannot be: {sound:?}"));
        }
        let text = toml::to_string(&sound).map_err(|e| e.to_string())?;
        match toml::from_str::<Preferences>(&text) {
            Ok(again) if again == sound => Ok(()),
            _ => Err("read back as other preferences".into()),
        }
    });
}
