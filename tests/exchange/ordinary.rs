//! MJCF as others write it: classes, shapes that are weighed, actuators without names, hinges kept parallel. What MuJoCo
//! itself makes of such files is in `tests/outside/planar.rs`.

use std::f64::consts::PI;

use stillbase::exchange::import::{ImportedMachine, import};
use stillbase::mechanics::dynamics::mass_matrix;
use stillbase::mechanics::machine::Inertia;
use stillbase::mechanics::planar::{DriveAngles, PerDrive};

#[track_caller]
fn read(text: &str) -> ImportedMachine {
    import(text).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

#[track_caller]
fn near(what: &str, got: f64, want: f64, part: f64) {
    assert!((got - want).abs() <= part * want.abs().max(1e-6), "{what}: {got}, want {want}");
}

/// An arm of one link that is a shape.
fn of_shape(shape: &str) -> ImportedMachine {
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
    // Standing upright, along the axis of the hinge: a slice of radius r adds its area and π r⁴/2, one of b by c
    // 4/3 b c (b² + c²).
    let upright = |half: f64, across: &dyn Fn(f64) -> ([f64; 2], bool)| {
        const SLICES: u32 = 20_000;
        let step = 2.0 * half / f64::from(SLICES);
        let mut sums = [0.0; 2];
        for i in 0..SLICES {
            let ([b, c], is_ellipse) = across(-half + (f64::from(i) + 0.5) * step);
            let (area, squares) = if is_ellipse { (PI * b * c, 0.25) } else { (4.0 * b * c, 1.0 / 3.0) };
            sums[0] += area * step;
            sums[1] += area * squares * (b * b + c * c) * step;
        }
        sums
    };
    let cap = |z: f64| ball(0.05, (z.abs() - 0.15).max(0.0));
    let egg = |z: f64| {
        let part = (1.0 - (z / 0.02).powi(2)).max(0.0).sqrt();
        ([0.15 * part, 0.04 * part], true)
    };
    let standing: [(&str, [f64; 2]); 4] = [
        ("<geom type=\"capsule\" size=\"0.05 0.15\" pos=\"0.2 0.1 0\"/>", upright(0.2, &cap)),
        ("<geom type=\"cylinder\" size=\"0.03 0.15\" pos=\"0.2 0.1 0\"/>", upright(0.15, &|_| round(0.03))),
        ("<geom type=\"box\" size=\"0.15 0.04 0.02\" pos=\"0.2 0.1 0\"/>", upright(0.02, &|_| ([0.15, 0.04], false))),
        ("<geom type=\"ellipsoid\" size=\"0.15 0.04 0.02\" pos=\"0.2 0.1 0\"/>", upright(0.02, &egg)),
    ];
    for (shape, [volume, second]) in standing {
        let link = of_shape(shape).machine.links()[0].clone();
        near(shape, link.mass, 1000.0 * volume, 1e-6);
        near(shape, link.inertia, 1000.0 * second, 1e-6);
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
        // Bent by a keyframe, which leaves "back" where no equality has it, the machine is the same.
        let bent = model(&equality).replace("</mujoco>", "<keyframe><key qpos=\"0.2 0.7 0 0.7\"/></keyframe></mujoco>");
        let other = read(&bent);
        let (g, _) = mass_matrix(&Inertia::of(&other.machine), &DriveAngles(q).units(), &still);
        for (k, l) in [(0, 0), (0, 1), (1, 1)] {
            near("H, bent", g.get(k, l), h.get(k, l), 1e-12);
        }
        // Where "first" is held to "back" instead, that says where it stands.
        let bend = if equality.contains("joint1=\"first\"") { 0.0 } else { 0.7 };
        assert!((other.pose[1] - other.pose[0] - bend).abs() < 1e-12, "{equality}: {:?}", other.pose);
    }
    for (equality, words) in [
        (second.to_owned(), "body \"back\": no motor turns it"),
        (back.replace("-1", "-2") + second, "it does not couple a rotor to its motor"),
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
    let note = with.notes.iter().find(|note| note.contains("the armature of \"elbow\", 0.2 kg m²"));
    let note = note.unwrap_or_else(|| panic!("{:?}", with.notes));
    // J N² of the rotor that the note tells of is the armature, and it is the rotor of the machine.
    let said = |before: &str| -> f64 {
        let rest = note.split(before).nth(1).expect(before);
        rest.split([' ', ',']).next().and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{note}"))
    };
    let (inertia, ratio) = (said("became a rotor of "), said("behind a gear of "));
    near("J N²", inertia * ratio * ratio, 0.2, 1e-4);
    let rotor = with.machine.spec().drives[1].rotor.expect("a rotor");
    near("J", rotor.inertia, inertia, 1e-4);
    near("N", rotor.ratio, ratio, 1e-12);
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

/// Angles of a file are in degrees unless it says otherwise: what an angle is where it is drawn, and its limits.
#[test]
fn angles_are_in_degrees_unless_the_file_says_otherwise() {
    let elbow = |of: &str| ARM.replace("<joint name=\"elbow\"/>", &format!("<joint name=\"elbow\" {of}/>"));
    let plain = read(&elbow("ref=\"0.5235987755982988\" range=\"-1.0471975511965976 1.5707963267948966\""));
    let text =
        elbow("ref=\"30\" range=\"-60 90\"").replace("<compiler angle=\"radian\"/>", "<compiler angle=\"degree\"/>");
    let text = text.replace("euler=\"0 1.5707963267948966 0\"", "euler=\"0 90 0\"");
    let degrees = read(&text.replace("range=\"-1.5 2\"", "").replace("range=\"-9 9\"", ""));
    let [own, other] = [&plain, &degrees].map(|found| found.machine.spec().angles[0].clone());
    assert!((other.offset - PI / 6.0).abs() < 1e-12, "{other:?}");
    for (got, want) in [(other.min, -PI / 3.0), (other.max, PI / 2.0), (own.min, -PI / 3.0), (own.max, PI / 2.0)] {
        assert!((got.expect("a limit") - want).abs() < 1e-12, "{own:?} {other:?}");
    }
}

/// What the file says all weigh together counts: every mass and every inertia by the same factor.
#[test]
fn a_total_mass_scales_masses_and_inertias() {
    let bare = read(ARM);
    let scaled = read(&ARM.replace("<compiler angle=\"radian\"/>", "<compiler angle=\"radian\" settotalmass=\"7\"/>"));
    near("mass", scaled.machine.mass(), 7.0, 1e-12);
    let factor = 7.0 / bare.machine.mass();
    assert!((factor - 1.0).abs() > 0.1);
    for (own, other) in bare.machine.links().iter().zip(scaled.machine.links()) {
        near("mass of a link", other.mass, factor * own.mass, 1e-12);
        near("inertia of a link", other.inertia, factor * own.inertia, 1e-12);
        near("its place", other.com, own.com, 1e-12);
    }
}

/// An arm whose elbow is turned by a motor with a rotor of its own, somewhere along the axis of the hinge.
fn with_a_rotor(height: f64, ratio: f64, com: [f64; 2]) -> String {
    let rotor = format!(
        "<body name=\"rotor\" pos=\"0.4 0 {height}\"><joint name=\"rotor\" axis=\"0 0 1\" range=\"-9 9\"/>\
         <inertial pos=\"{} {} {height}\" mass=\"0.5\" diaginertia=\"0.002 0.002 0.003\"/></body>",
        com[0], com[1]
    );
    let equality =
        format!("<equality><joint joint1=\"rotor\" joint2=\"elbow\" polycoef=\"0 {ratio} 0 0 0\"/></equality>");
    ARM.replace("<body pos=\"0.4 0 0\">", &format!("{rotor}<body pos=\"0.4 0 0\">"))
        .replace("</worldbody>", &format!("</worldbody>{equality}"))
}

/// Wherever along its axis a rotor sits, and whether it turns once or many times, it is one: a link is not.
#[test]
fn a_rotor_may_sit_anywhere_along_its_axis() {
    for ratio in [1.0, -1.0, 30.0] {
        for height in [0.0, 0.3, -0.2] {
            let found = read(&with_a_rotor(height, ratio, [0.0; 2]));
            assert_eq!(found.machine.links().len(), 2, "{ratio}, {height}");
            let rotor = found.machine.spec().drives[1].rotor.expect("a rotor");
            near("inertia", rotor.inertia, 0.003, 1e-12);
            near("ratio", rotor.ratio, ratio, 1e-12);
            // Its mass hangs on what carries it, at the elbow.
            let upper = &found.machine.links()[0];
            let bare = read(ARM).machine.links()[0].clone();
            near("mass", upper.mass, bare.mass + 0.5, 1e-12);
            near("moment", upper.mass * upper.com, bare.mass * bare.com + 0.5 * 0.4, 1e-12);
        }
    }
    let why = import(&with_a_rotor(0.0, 30.0, [0.01, 0.02])).map(|_| ()).expect_err("it shakes").to_string();
    assert!(why.contains("a rotor with its mass 0.02236") && why.contains("balanced"), "{why}");
    // Off its axis by less than a part in a million million of where the axis is, it is balanced but for rounding.
    read(&with_a_rotor(0.0, 30.0, [1e-12, 0.0]));
}

/// Hinges that no actuator turns get a motor each; what is geared to another hinge is its rotor, and gets none.
#[test]
fn without_actuators_every_hinge_has_a_motor_and_rotors_have_none() {
    let text = with_a_rotor(0.0, 30.0, [0.0; 2]);
    let (from, to) = (text.find("<actuator>").expect("one"), text.find("</actuator>").expect("one") + 11);
    let found = read(&(text[..from].to_owned() + &text[to..]));
    let names: Vec<&str> = found.machine.spec().drives.iter().map(|drive| drive.name.as_str()).collect();
    assert_eq!(names, ["shoulder", "elbow"]);
    let rotor = found.machine.spec().drives[1].rotor.expect("a rotor");
    near("ratio", rotor.ratio, 30.0, 1e-12);
}

/// How exact a file has to be goes with its size: what is rounding of an arm of 50 m is not of one of half a metre.
#[test]
fn exactness_goes_with_the_size() {
    let bar = |name: &str, x: f64, y: f64, inner: &str| {
        format!(
            "<body name=\"{name}\" pos=\"{x} {y} 0\"><joint name=\"{name}\"/><inertial pos=\"0.1 0 0\" mass=\"1\" \
             diaginertia=\"0.01 0.01 0.01\"/>{inner}</body>"
        )
    };
    let model = |size: f64, off: f64| {
        let tip = format!("<site name=\"ee\" pos=\"{} 0 0\"/>", 0.3 * size);
        let inner = bar("first", 0.2 * size, off, "") + &bar("second", 0.5 * size, 0.0, &tip);
        format!(
            "<mujoco><worldbody>{}</worldbody><actuator><motor joint=\"upper\"/><motor joint=\"first\"/>\
             <motor joint=\"second\"/></actuator></mujoco>",
            bar("upper", 0.0, 0.0, &inner)
        )
    };
    let is_read = |size: f64, off: f64| import(&model(size, off)).is_ok();
    assert!(is_read(1.0, 1e-10) && is_read(100.0, 1e-8));
    assert!(!is_read(1.0, 1e-8) && !is_read(100.0, 1e-6));
    // The same for a rotor that is not quite balanced.
    let near = |off: f64| with_a_rotor(0.0, 30.0, [off, 0.0]);
    let far = |off: f64| near(off).replace("0.4 0", "40 0");
    assert!(import(&near(1e-10)).is_ok() && import(&far(2e-8)).is_ok());
    assert!(import(&near(2e-8)).is_err() && import(&far(1e-6)).is_err());
}
