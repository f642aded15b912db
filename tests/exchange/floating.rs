//! Bases that float: what goes out comes back with the machine on it, and those of others come in.

use stillbase::exchange::base_body::BaseBody;
use stillbase::exchange::cut::Cut;
use stillbase::exchange::import::{ImportedMachine, import};
use stillbase::exchange::mjcf::{middle, mjcf, qpos};
use stillbase::exchange::urdf::urdf;
use stillbase::files::scenario;
use stillbase::mechanics::machine::builtin;
use stillbase::mechanics::planar::{DriveAngles, Vector};
use stillbase::session::replay;
use stillbase::session::scenario::{Scenario, TaskKind};
use stillbase::simulation::plant::BaseKind;

use super::arms::TWO;
use super::import::{machines, same};
use crate::folder::Folder;
use crate::support::Noise;

#[track_caller]
fn equal(what: &str, found: &ImportedMachine, want: &BaseBody) {
    let got = found.base.unwrap_or_else(|| panic!("{what}: no base"));
    let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * (1.0 + b.abs());
    assert!(found.floats, "{what}");
    assert!(is_near(got.mass, want.mass) && is_near(got.inertia, want.inertia), "{what}: {got:?}, want {want:?}");
    assert!((got.com - want.com).norm() <= 1e-12 * (1.0 + want.com.norm()), "{what}: {got:?}, want {want:?}");
}

#[test]
fn what_floats_goes_out_and_comes_back() {
    let mut noise = Noise::of(31);
    for machine in machines() {
        let com = Vector::new(noise.between(-1.0, 1.0), noise.between(-1.0, 1.0));
        let base = BaseBody { mass: noise.between(0.5, 3000.0), inertia: noise.between(0.01, 4000.0), com };
        let (at, name) = (middle(&machine), machine.name());
        let texts = [
            (urdf(&machine, Some(&base), &Cut::default()), vec![0.0; machine.drives()]),
            (mjcf(&machine, Some(&base), &at, &Cut::default()).expect("a model"), at.clone()),
        ];
        for (text, at) in texts {
            let found = import(&text).unwrap_or_else(|why| panic!("{name}: {why}\n{text}"));
            equal(name, &found, &base);
            same(&machine, &found, &at, &mut noise, text.contains("<robot"));
        }
        let (free, still) = (qpos(&machine, Some(&base), &at), qpos(&machine, None, &at));
        assert_eq!(free.expect("a pose")[3..], still.expect("a pose"), "{name}");
    }
}

/// The base and the arm of a scenario, written as models and opened as scenarios.
#[test]
fn a_spacecraft_comes_back_as_a_scenario() {
    let (own, folder) = (Scenario::builtin("spot").expect("built in"), Folder::new("afloat"));
    let body =
        BaseBody { mass: own.base.mass, inertia: own.base.inertia, com: Vector::new(own.base.com[0], own.base.com[1]) };
    let texts = [
        ("spot.urdf", urdf(&own.machine, Some(&body), &Cut::default())),
        ("spot.xml", mjcf(&own.machine, Some(&body), &[1.9, 2.6, 3.4], &Cut::default()).expect("a model")),
    ];
    for (name, text) in texts {
        let found = scenario(&folder.file(name, text).display().to_string()).expect("a scenario").scenario;
        assert_eq!(found.base, own.base, "{name}");
        for (got, want) in found.machine.links().iter().zip(own.machine.links()) {
            let all = [(got.mass, want.mass), (got.inertia, want.inertia), (got.com, want.com)];
            assert!(all.iter().all(|(got, want)| (got - want).abs() < 1e-12), "{name}: {got:?}, was {want:?}");
        }
        assert_eq!(found.task.kind, TaskKind::ZeroMomentum, "{name}: nothing balances the arm");
        let (mut turned, mut moved) = (0.0_f64, 0.0_f64);
        replay(&found, |_, frame| {
            turned = turned.max(frame.base.angle.abs());
            moved = moved.max(frame.qd.iter().fold(0.0, |most, x| x.abs().max(most)));
        })
        .expect("it runs");
        assert!(turned < 1e-9 && moved > 0.01, "{name}: the base turns by {turned} rad, the arm at {moved} rad/s");
    }
    // The same base, held: a model that does not say that it floats stands.
    let held = urdf(&own.machine, Some(&body), &Cut::default()).replace("\"floating\"", "\"fixed\"");
    let found = scenario(&folder.file("held.urdf", held).display().to_string()).expect("a scenario").scenario;
    assert_eq!(found.base.kind, BaseKind::Fixed);
}

/// A spacecraft with a panel and one link, with other joints of its base.
fn craft(joints: &str, more: &str) -> String {
    format!(
        "<mujoco model=\"craft\"><option gravity=\"0 -9.81 0\"/><compiler angle=\"radian\"/><worldbody>
        <geom type=\"plane\" size=\"5 5 1\"/><body name=\"bench\"><geom type=\"box\" size=\"1 1 0.1\" mass=\"90\"/></body>
        <body name=\"bus\" pos=\"1 2 3\" euler=\"0 0 0.5\">{joints}
          <inertial pos=\"0.1 -0.2 0.05\" mass=\"30\" diaginertia=\"1 1 2\"/>
          <body name=\"panel\" pos=\"1 0 0\"><geom type=\"box\" size=\"0.5 0.1 0.01\" mass=\"4\"/></body>
          <body name=\"arm\" pos=\"0.3 0.4 0\"><joint name=\"shoulder\"/>
            <inertial pos=\"0.2 0 0\" mass=\"1.5\" diaginertia=\"0.02 0.02 0.03\"/>
            <site name=\"end_effector\" pos=\"0.5 0 0\"/></body>
        </body></worldbody>{more}</mujoco>"
    )
}

const PLANAR: &str =
    "<joint type=\"slide\" axis=\"1 0 0\"/><joint type=\"slide\" axis=\"0 1 0\"/><joint name=\"turn\"/>";

#[test]
fn a_base_of_another_program_floats() {
    let com = (30.0 * Vector::new(0.1, -0.2) + 4.0 * Vector::new(1.0, 0.0)) / 34.0;
    let away = 30.0 * (Vector::new(0.1, -0.2) - com).norm_sqr() + 4.0 * (Vector::new(1.0, 0.0) - com).norm_sqr();
    let panel = 4.0 * (1.0 + 0.04) / 12.0;
    let base = BaseBody { mass: 34.0, inertia: 2.0 + panel + away, com: com - Vector::new(0.3, 0.4) };
    let key = |qpos: &str| format!("<keyframe><key qpos=\"{qpos}\"/></keyframe>");
    let half = 0.5_f64.sqrt();
    let quarter = [0.0, -9.81];
    // Without a keyframe the base stands as it is drawn.
    let drawn = [-9.81 * 0.5_f64.sin(), -9.81 * 0.5_f64.cos()];
    for (joints, more, gravity, angle) in [
        ("<freejoint/>", String::new(), drawn, 0.0),
        ("<joint type=\"free\"/>", key(&format!("0 0 0 {half} 0 0 {half} 0.7")), [-9.81, 0.0], 0.7),
        (PLANAR, String::new(), drawn, 0.0),
        (PLANAR, key("0.1 0.2 -0.5 0.7"), quarter, 0.7),
        (
            "<joint name=\"turn\" ref=\"0.2\"/><joint type=\"slide\" axis=\"1 1 0\"/><joint type=\"slide\" axis=\"0 -1 0\"/>",
            key("-0.3 1 2 0.7"),
            quarter,
            0.7,
        ),
    ] {
        let found = import(&craft(joints, &more)).unwrap_or_else(|why| panic!("{joints}: {why}"));
        equal(joints, &found, &base);
        let got = found.machine.spec().gravity;
        assert!((0..2).all(|i| (got[i] - gravity[i]).abs() < 1e-9), "{joints}, {more}: {got:?}, want {gravity:?}");
        assert!((found.pose[0] - angle).abs() < 1e-12 && found.machine.links().len() == 1, "{joints}");
    }
    let held = import(&craft("", "")).expect("an arm");
    assert!(!held.floats && held.base.is_none() && held.machine.spec().gravity == [0.0, -9.81]);
    let is_fixed = |notes: &[String]| {
        let found =
            notes.iter().find(|note| note.starts_with("the body \"bus\" has no joint, so the base is fixed there"));
        found.is_some_and(|note| note.contains("want a free joint in it, or two joints of type slide and a hinge"))
    };
    assert!(is_fixed(&held.notes), "{:?}", held.notes);
    assert!(!import(&craft(PLANAR, "")).expect("an arm").notes.iter().any(|note| note.contains("fixed")));
    // What this program writes for a base that stands weighs nothing, so nothing is left out.
    let stands = mjcf(builtin("spot").expect("built in"), None, &DriveAngles::from([0.0; 3]), &Cut::default());
    assert!(import(&stands.expect("a model")).expect("an arm").notes.is_empty());
    let inertial = "<inertial><origin xyz=\"0.2 -0.1 0\"/><mass value=\"50\"/>\
                    <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"6\"/></inertial>";
    let floats = "<joint name=\"free\" type=\"floating\"><parent link=\"space\"/><child link=\"world\"/>\
                  <origin xyz=\"7 8 9\" rpy=\"0 0 1\"/></joint>";
    let text = format!("<link name=\"space\"/><link name=\"world\">{inertial}</link>{floats}");
    let found = import(&TWO.replacen("<link name=\"world\"/>", &text, 1)).expect("an arm");
    equal("URDF", &found, &BaseBody { mass: 50.0, inertia: 6.0, com: Vector::new(0.2, -0.1) });
    assert_eq!(found.machine.spec().links, import(TWO).expect("an arm").machine.spec().links);
}

#[test]
fn what_floats_otherwise_is_refused_by_name() {
    let second = "<worldbody><body name=\"cube\"><freejoint/><geom size=\"0.1\"/></body></worldbody>";
    let aside = "<worldbody><body name=\"post\"><joint/><geom size=\"0.1\"/></body></worldbody>";
    let tied = "<equality><connect body1=\"arm\" anchor=\"0.5 0 0\"/></equality>";
    let key = "<keyframe><key qpos=\"0 0 0 0\"/></keyframe>";
    let slides = |a: &str, b: &str, turn: &str| {
        format!("<joint type=\"slide\" axis=\"{a}\"/><joint type=\"slide\" axis=\"{b}\"/><joint axis=\"{turn}\"/>")
    };
    for (text, words) in [
        (craft("<joint type=\"ball\"/>", ""), ["a joint of type \"ball\"", "a base that floats has a free joint"]),
        (craft("<joint type=\"slide\"/>", ""), ["type \"slide\"", "two joints of type slide and a hinge"]),
        (craft(&slides("1 0 0", "-2 0 0", "0 0 1"), ""), ["along the same line", "two slides in the plane"]),
        (craft(&slides("1 0 0", "0 1 1", "0 0 1"), ""), ["out of the plane", "two slides in the plane"]),
        (craft(&slides("1 0 0", "0 1 0", "1 0 0"), ""), ["another axis than the arm", "parallel to those of the arm"]),
        (craft("<freejoint/>", second), ["a second body that floats", "one base that floats in the world"]),
        (craft("<freejoint/>", aside), ["what turns stands beside it", "with all of the arm on it"]),
        (craft("<freejoint/>", tied), ["it ties to the world what floats", "points of the base"]),
        (craft("<freejoint/>", key), ["qpos has 4 numbers", "want 8, those of the joints of the base"]),
        (
            craft("", "").replace("<joint name=\"shoulder\"/>", "<freejoint name=\"shoulder\"/>"),
            ["a body that floats on a body", "one base that floats in the world"],
        ),
        (
            craft("<freejoint/>", "").replace("mass=\"30\"", "mass=\"0\"").replace("mass=\"4\"", "mass=\"0\""),
            ["the base floats and has no mass", "both above 0"],
        ),
    ] {
        let why = import(&text).expect_err(words[0]).to_string();
        assert!(words.iter().all(|word| why.contains(word)), "{why}");
    }
}
