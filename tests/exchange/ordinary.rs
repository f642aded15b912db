//! MJCF as others write it: classes, shapes that are weighed, actuators without names, hinges kept parallel. What MuJoCo
//! itself makes of such files is in `tests/outside/planar.rs`.

use std::f64::consts::PI;

use stillbase::exchange::import::{Imported, import};
use stillbase::mechanics::dynamics::mass_matrix;
use stillbase::mechanics::machine::Inertia;
use stillbase::mechanics::planar::{DriveAngles, PerDrive};

#[track_caller]
fn read(text: &str) -> Imported {
    import(text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

#[track_caller]
fn near(what: &str, got: f64, want: f64, part: f64) {
    assert!((got - want).abs() <= part * want.abs().max(1e-6), "{what}: {got}, want {want}");
}

/// An arm of one link that is a shape.
fn of_shape(shape: &str) -> Imported {
    read(&format!(
        "<mujoco><option gravity=\"0 -9.81 0\"/><worldbody><body name=\"arm\"><joint name=\"hinge\"/>{shape}\
         <site name=\"tool\" pos=\"0.5 0 0\"/></body></worldbody><actuator><motor joint=\"hinge\"/></actuator></mujoco>"
    ))
}

/// Volume, and the integral of x² + y² about the centre, of a body of revolution or with rectangular slices: added up
/// slice by slice along x. `across` gives half of the extents along y and z, and whether the slice is an ellipse.
fn sliced(half: f64, across: impl Fn(f64) -> ([f64; 2], bool)) -> [f64; 2] {
    const SLICES: u32 = 20_000;
    let step = 2.0 * half / f64::from(SLICES);
    let mut sums = [0.0; 2];
    for i in 0..SLICES {
        let x = -half + (f64::from(i) + 0.5) * step;
        let ([b, c], is_ellipse) = across(x);
        // Area, and the mean of y² over the slice.
        let (area, mean) = if is_ellipse { (PI * b * c, b * b / 4.0) } else { (4.0 * b * c, b * b / 3.0) };
        sums[0] += area * step;
        sums[1] += area * (x * x + mean) * step;
    }
    sums
}

/// Each kind of shape lies along x in turn; slices know nothing of closed forms.
#[test]
fn shapes_weigh_what_their_slices_add_up_to() {
    let round = |r: f64| ([r, r], true);
    let ball = |r: f64, x: f64| round((r * r - x * x).max(0.0).sqrt());
    let cases: [(&str, [f64; 2]); 8] = [
        ("<geom size=\"0.07\" pos=\"0.2 0.1 0.03\"/>", sliced(0.07, |x| ball(0.07, x))),
        ("<geom type=\"cylinder\" size=\"0.03\" fromto=\"0.05 0.1 0 0.35 0.1 0\"/>", sliced(0.15, |_| round(0.03))),
        (
            "<geom type=\"capsule\" size=\"0.05\" fromto=\"0.05 0.1 0 0.35 0.1 0\"/>",
            sliced(0.2, |x: f64| ball(0.05, (x.abs() - 0.15).max(0.0))),
        ),
        ("<geom type=\"box\" size=\"0.15 0.04 0.02\" pos=\"0.2 0.1 0\"/>", sliced(0.15, |_| ([0.04, 0.02], false))),
        (
            "<geom type=\"ellipsoid\" size=\"0.15 0.04 0.02\" pos=\"0.2 0.1 0\"/>",
            sliced(0.15, |x: f64| {
                let part = (1.0 - (x / 0.15).powi(2)).max(0.0).sqrt();
                ([0.04 * part, 0.02 * part], true)
            }),
        ),
        (
            "<geom type=\"box\" size=\"0.02\" fromto=\"0.05 0.1 0 0.35 0.1 0\"/>",
            sliced(0.15, |_| ([0.02, 0.02], false)),
        ),
        (
            "<geom type=\"cylinder\" size=\"0.03 0.15\" pos=\"0.2 0.1 0\" euler=\"0 90 0\"/>",
            sliced(0.15, |_| round(0.03)),
        ),
        (
            "<geom type=\"capsule\" size=\"0.05 0.15\" pos=\"0.2 0.1 0\" zaxis=\"-3 0 0\"/>",
            sliced(0.2, |x: f64| ball(0.05, (x.abs() - 0.15).max(0.0))),
        ),
    ];
    for (shape, [volume, second]) in cases {
        for (density, text) in [(1000.0, shape.to_owned()), (2700.0, shape.replace("<geom", "<geom density=\"2700\""))]
        {
            let link = of_shape(&text).machine.links()[0].clone();
            near(shape, link.mass, density * volume, 1e-6);
            near(shape, link.inertia, density * second, 1e-6);
            near(shape, link.com, 0.2, 1e-12);
            near(shape, link.com_normal, 0.1, 1e-12);
        }
        // A mass of its own counts instead, with the same inertia of a kilogram.
        let link = of_shape(&shape.replace("<geom", "<geom mass=\"3\"")).machine.links()[0].clone();
        near(shape, link.mass, 3.0, 1e-12);
        near(shape, link.inertia, 3.0 * second / volume, 1e-6);
    }
    for (shape, words) in [
        ("<geom type=\"mesh\" mesh=\"x\"/>", "a shape of type \"mesh\", which is not weighed: want <inertial>"),
        ("<geom type=\"box\" size=\"0.1 0.1\"/>", "box with 2 sizes: want 3"),
        ("<geom size=\"-0.1\"/>", "a size of -0.1 m: want sizes above 0"),
        ("<geom size=\"0.1\" mass=\"-1\"/>", "a mass of -1 kg: want one that is not below 0"),
        ("<geom size=\"0.1\" shellinertia=\"true\"/>", "a hollow shape"),
        ("<geom size=\"0.1\" mass=\"0\"/>", "it turns and nothing gives it a mass"),
        ("<geom size=\"0.1\" group=\"6\"/>", "it turns and nothing gives it a mass"),
    ] {
        let text = format!(
            "<mujoco><worldbody><body name=\"arm\"><joint name=\"hinge\"/>{shape}<site name=\"tool\" pos=\"1 0 0\"/></body>\
             </worldbody></mujoco>"
        );
        let why = import(&text).map(|_| ()).expect_err(shape).to_string();
        assert!(why.contains(words), "{why}");
    }
}

/// Two links as others write them.
pub const ARM: &str = r#"<mujoco model="arm">
  <compiler angle="radian"/>
  <option gravity="0 -9.81 0"/>
  <default>
    <geom density="2000"/>
    <joint axis="0 0 -1" damping="0.5"/>
    <default class="bar">
      <geom type="capsule" size="0.02 0.1"/>
      <joint axis="0 0 1" range="-1.5 2"/>
      <motor ctrlrange="-20 30" gear="3"/>
      <default class="thin"><geom size="0.01"/></default>
    </default>
  </default>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="upper" childclass="bar">
      <joint name="shoulder" range="-9 9"/>
      <geom fromto="0 0 0 0.4 0 0"/>
      <body pos="0.4 0 0">
        <joint name="elbow"/>
        <geom class="thin" pos="0.15 0 0" euler="0 1.5707963267948966 0"/>
        <site name="ee_site" pos="0.3 0 0"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor joint="shoulder"/>
    <motor class="bar" joint="elbow"/>
    <velocity joint="elbow" kv="3" forcerange="-5 5"/>
  </actuator>
</mujoco>"#;

/// What an element does not say its class does, or that around it.
#[test]
fn classes_say_what_elements_do_not() {
    let found = read(ARM);
    let (spec, links) = (found.machine.spec(), found.machine.links());
    let capsule = |r: f64, l: f64| 2000.0 * PI * r * r * (l + 4.0 / 3.0 * r);
    near("upper", links[0].mass, capsule(0.02, 0.4), 1e-12);
    // The thin one has its radius from its class, and its length from the class of that.
    near("lower", links[1].mass, capsule(0.01, 0.2), 1e-12);
    let names: Vec<&str> = spec.drives.iter().map(|drive| drive.name.as_str()).collect();
    assert_eq!(names, ["shoulder", "elbow"], "actuators without names have those of their hinges");
    assert_eq!(spec.drives[0].torque_limit, None);
    near("both that turn the elbow", spec.drives[1].torque_limit.expect("a limit"), 3.0 * 30.0 + 5.0, 1e-12);
    assert_eq!(spec.angles.len(), 1);
    assert_eq!((spec.angles[0].min, spec.angles[0].max), (Some(-1.5), Some(2.0)));
    assert!(found.notes.iter().any(|note| note.contains("damping")), "{:?}", found.notes);
    assert_eq!(spec.gravity, [0.0, -9.81]);
    // A site elsewhere in the family of names; or none, and then the end of the last shape.
    let bare = ARM.replace("<site name=\"ee_site\" pos=\"0.3 0 0\"/>", "<geom fromto=\"0 0 0 0.25 0 0\" mass=\"0\"/>");
    let found = read(&bare);
    assert!(
        found.notes.iter().any(|note| note.contains("where the last shape of \"body 2\" ends")),
        "{:?}",
        found.notes
    );
    let tip = found.machine.end_effector();
    assert!((tip[0] - 0.4).abs() < 1e-12 && (tip[1] - 0.25).abs() < 1e-12, "{tip:?}");
}

/// A bar that hangs beside a driven one, or on its tip, with its hinge coupled to that of the other.
#[test]
fn couplings_of_hinges_keep_links_parallel() {
    let bar = |name: &str, at: f64, inner: &str| {
        format!(
            "<body name=\"{name}\" pos=\"{at} 0 0\"><joint name=\"{name}\"/><inertial pos=\"0.1 0 0\" mass=\"1\" \
             diaginertia=\"0.01 0.01 0.01\"/>{inner}</body>"
        )
    };
    let tip = "<site name=\"ee\" pos=\"0.3 0 0\"/>";
    let model = |equality: &str| {
        let inner = bar("first", 0.2, &bar("back", 0.3, "")) + &bar("second", 0.5, tip);
        format!(
            "<mujoco><worldbody>{}</worldbody><equality>{equality}</equality><actuator><motor joint=\"upper\"/>\
             <motor joint=\"first\"/></actuator></mujoco>",
            bar("upper", 0.0, &inner)
        )
    };
    let back = "<joint joint1=\"back\" joint2=\"first\" polycoef=\"0 -1 0 0 0\"/>";
    let second = "<joint joint1=\"second\" joint2=\"first\"/>";
    for equality in [
        back.to_owned() + second,
        second.to_owned() + back,
        back.replace("joint1", "x").replace("joint2", "joint1").replace('x', "joint2") + second,
        back.to_owned() + second + "<joint active=\"false\" joint1=\"upper\"/>",
    ] {
        let found = read(&model(&equality));
        let (machine, of) = (&found.machine, |name: &str| {
            let j = found.machine.links().iter().position(|link| link.name == name).expect(name);
            found.machine.resolved_links()[j].drive
        });
        assert_eq!([of("upper"), of("first"), of("back"), of("second")], [0, 1, 0, 1], "{equality}");
        // By hand: H_12 = Σ m a_1 a_2 cos(q_1 − q_2); "back" hangs on the tip of "first", which it does not turn with.
        let q = PerDrive::from_slice(&[0.4, 1.3]).expect("two");
        let still = PerDrive::from_fn(2, |_| 0.0);
        let (h, _) = mass_matrix(&Inertia::of(machine), &DriveAngles(q).units(), &still);
        let coupling: f64 = 0.2 * 0.1 + (0.2 + 0.1) * 0.3 + 0.5 * 0.1;
        near("H12", h.get(0, 1), coupling * (q[0] - q[1]).cos(), 1e-12);
        near("H11", h.get(0, 0), 0.02 + 0.01 + 0.2 * 0.2 + 0.3 * 0.3 + 0.5 * 0.5, 1e-12);
        near("H22", h.get(1, 1), 0.02 + 0.01 + 0.3 * 0.3 + 0.01, 1e-12);
    }
    for (equality, words) in [
        (second.to_owned(), "body \"back\": no motor turns it"),
        (back.replace("-1", "-2") + second, "it couples what is no rotor and motor"),
        (back.replace("0 -1 0", "0 -1 1") + second, "a coupling that is not linear"),
    ] {
        let why = import(&model(&equality)).map(|_| ()).expect_err(words).to_string();
        assert!(why.contains(words), "{why}");
    }
}

/// An armature adds to the inertia of its hinge; a gear that makes as much of a rotor adds next to no momentum.
#[test]
fn an_armature_becomes_a_rotor_that_adds_no_momentum() {
    let [bare, with] = ["", " armature=\"0.2\""]
        .map(|armature| read(&ARM.replace("<joint name=\"elbow\"/>", &format!("<joint name=\"elbow\"{armature}/>"))));
    let [own, other] = [&bare, &with].map(|found| Inertia::of(&found.machine));
    near("H", other.diagonal(1) - own.diagonal(1), 0.2, 1e-3);
    near("D", other.momentum(1), own.momentum(1), 1e-2);
    assert!(with.notes.iter().any(|note| note.contains("the armature of \"elbow\", 0.2 kg m²")), "{:?}", with.notes);
}

/// Hinges stand where the keyframe has them, else where equalities put them.
#[test]
fn hinges_stand_where_the_file_puts_them() {
    let with_ref = ARM.replace("<joint name=\"elbow\"/>", "<joint name=\"elbow\" ref=\"0.5\"/>");
    let found = read(&with_ref);
    assert!((found.pose[1] - found.pose[0]).abs() < 1e-12, "as drawn: {:?}", found.pose);
    let angle = found.machine.spec().angles[0].clone();
    // There its angle is 0.5.
    assert!((angle.offset - 0.5).abs() < 1e-12, "{angle:?}");
    let key = "<keyframe><key qpos=\"0.3 1.1\"/></keyframe></mujoco>";
    let found = read(&with_ref.replace("</mujoco>", key));
    assert!((found.pose[0] - 0.3).abs() < 1e-12 && (found.pose[1] - 0.9).abs() < 1e-12, "{:?}", found.pose);
    let why =
        import(&ARM.replace("</mujoco>", &key.replace("1.1", "1.1 2"))).map(|_| ()).expect_err("three").to_string();
    assert!(why.contains("qpos has 3 numbers: want 2, one for each hinge"), "{why}");
    let held = "<equality><joint joint1=\"elbow\" polycoef=\"0.7 0 0 0 0\"/></equality></mujoco>";
    let found =
        import(&ARM.replace("</mujoco>", held)).map(|_| ()).expect_err("a motor that turns nothing").to_string();
    assert!(found.contains("\"elbow\""), "{found}");
}
