//! Steps of drawing: corners, moving, snapping, and random drawings.

use std::f64::consts::PI;

use stillbase::mechanics::machine::place_of;
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use stillbase::mechanics::sketch::{
    BarEnd, BarId, LoopShape, Onto, PinId, Place, Sketch, SketchStep, SnapOptions, Template, resolve, snap,
};

use super::sketch::{at, bar, complete, draw, motor, pin};
use super::sketch_parts::reaches_over_its_pins;
use crate::support::Noise;

fn follow(bar: u32, drive: &str) -> SketchStep {
    SketchStep::Follow { bar: BarId(bar), drive: Some(drive.into()) }
}

#[test]
fn corners_are_refused_with_what_would_do() {
    let one = draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0))]);
    let refused = |step: SketchStep| one.with(&step).expect_err("refused");
    // Two pins at one place, no length, a bar on itself, a bar over another.
    assert_eq!(refused(bar(pin(0), at(0.3, 0.0))).place, Place::Pin(PinId(1)));
    assert!(refused(bar(pin(0), pin(0))).to_string().contains("0 mm long"));
    assert!(refused(bar(BarEnd::on(BarId(2), 0.1), BarEnd::on(BarId(2), 0.2))).to_string().contains("bar 1 joins"));
    assert!(refused(bar(pin(0), pin(1))).to_string().contains("bar 1 joins these two pins already"));
    assert!(refused(bar(pin(0), at(f64::NAN, 0.0))).to_string().contains("want"));
    assert!(refused(bar(pin(0), at(1e9, 0.0))).to_string().contains("within"));
    assert!(refused(bar(pin(9), at(0.1, 0.1))).to_string().contains("no pin with the number 9"));
    assert!(refused(SketchStep::DeletePin { pin: PinId(0) }).to_string().contains("want"));
    assert!(refused(SketchStep::MovePin { pin: PinId(0), to: [0.1, 0.1] }).to_string().contains("want"));
    assert!(refused(SketchStep::MovePin { pin: PinId(1), to: [0.0, 0.0] }).to_string().contains("one place"));
    assert!(refused(SketchStep::Weld { pin: PinId(1), onto: PinId(1) }).to_string().contains("itself"));
    assert!(refused(SketchStep::Weld { pin: PinId(1), onto: PinId(0) }).to_string().contains("both pins are on"));
    assert!(refused(SketchStep::Split { bar: BarId(2), along: 0.3 }).to_string().contains("between 0 and 300 mm"));
    assert!(refused(SketchStep::NameBar { bar: BarId(2), name: " ".into() }).to_string().contains("cannot name"));
    assert!(refused(SketchStep::Length { bar: BarId(2), metres: 0.0 }).to_string().contains("0 mm"));
    let why = refused(SketchStep::Length { bar: BarId(9), metres: 0.2 }).to_string();
    assert_eq!(why, "there is no bar with the number 9: want one of 2 (bar 1)");
    assert!(refused(follow(2, "1")).to_string().contains("no drive"));
    let elsewhere = SketchStep::Motor { pin: PinId(1), stator: None, drive: None, rotor: None, turns: None };
    let refusal = refused(elsewhere);
    assert!(refusal.to_string().contains("share one axis at B"), "{refusal}");
    draw(&one, [refusal.proposals[0].clone()]);
    // A name that is taken, a motor that sits on itself.
    let two = draw(&one, [bar(pin(1), at(0.5, 0.2))]);
    assert!(two.with(&SketchStep::NameBar { bar: BarId(4), name: "1".into() }).is_err());
    let own =
        draw(&two, [motor(0, None, 2), motor(1, Some(4), 4), SketchStep::EndEffector { pin: PinId(3), bar: None }]);
    let resolved = resolve(&own);
    assert!(
        resolved.machine.is_none() && resolved.missing[0].text.contains("carry each other"),
        "{:?}",
        resolved.missing
    );
}

/// A chain of bars, each with a motor in its joint.
fn chain(count: u32) -> Sketch {
    let mut sketch = Sketch::blank();
    let (mut last, mut carrier) = (0, None);
    for k in 0..count {
        let to = sketch.at(PinId(last)) + unit(0.3 * f64::from(k)).scale(0.2);
        sketch = draw(&sketch, [bar(pin(last), at(to.re, to.im))]);
        let own = sketch.bars.last().expect("drawn").clone();
        sketch = draw(&sketch, [motor(last, carrier, own.id.0)]);
        (last, carrier) = (own.tip.0, Some(own.id.0));
    }
    draw(&sketch, [SketchStep::EndEffector { pin: PinId(last), bar: None }])
}

#[test]
fn eight_drives_are_a_machine_and_nine_are_refused() {
    let eight = chain(8);
    let machine = complete(&resolve(&eight)).clone();
    assert_eq!((machine.drives(), machine.angles().len()), (8, 7));
    assert_eq!(machine.spec().drives[5].on.as_deref(), Some("5"));
    let last = eight.bars.last().expect("eight").clone();
    let longer = draw(&eight, [bar(BarEnd::pin(last.tip), at(2.0, 2.0))]);
    let id = longer.bars.last().expect("nine").id.0;
    let refusal = longer.with(&motor(last.tip.0, Some(last.id.0), id)).expect_err("nine drives");
    assert!(refusal.to_string().contains("at most 8"), "{refusal}");
    draw(&longer, [refusal.proposals[0].clone()]);
}

/// Another bar of a class may state the drive; angles and limits stay what they are.
#[test]
fn a_bar_says_the_drive_for_all_that_must_follow_it() {
    let machine = stillbase::mechanics::machine::builtin("four-drive").expect("built in");
    let sketch = Sketch::of(machine, None);
    for own in &sketch.bars {
        let drive = own.drive.clone();
        let said = draw(&sketch, [SketchStep::Follow { bar: own.id, drive }]);
        let again = complete(&resolve(&said)).clone();
        assert_eq!(again.end_effector(), machine.end_effector(), "bar {}", own.name);
        assert_eq!(again.resolved_links()[4].sign, -1.0);
        let other = if own.drive.as_deref() == Some("1") { "2" } else { "1" };
        let other = draw(&sketch, [follow(own.id.0, other)]);
        assert!(resolve(&other).machine.is_none(), "bar {} is not parallel to that arm", own.name);
    }
}

#[test]
fn moving_a_pin_takes_along_what_hangs_on_it() {
    let sketch = Template::NineLinks.sketch();
    let mut noise = Noise::of(9);
    for name in ["1", "2", "3", "5", "9"] {
        for _ in 0..20 {
            let own = sketch.bars.iter().find(|bar| bar.name == name).expect("it has").clone();
            let to = sketch.at(own.tip) + unit(noise.between(-3.0, 3.0)).scale(noise.between(0.0, 0.1));
            let moved = draw(&sketch, [SketchStep::MovePin { pin: own.tip, to: [to.re, to.im] }]);
            assert!((moved.at(own.tip) - to).norm() < 1e-15);
            let resolved = resolve(&moved);
            assert!(resolved.loops.iter().all(|of| of.shape == LoopShape::Closed), "{name}: {:?}", resolved.missing);
            complete(&resolved);
        }
    }
    // Lengths and angles are typed.
    let one = sketch.bars.iter().find(|bar| bar.name == "1").expect("it has").id;
    let long = draw(&sketch, [SketchStep::Length { bar: one, metres: 0.55 }]);
    let machine = complete(&resolve(&long)).clone();
    assert_eq!(machine.spec().lengths["l1"], 0.55);
    assert_eq!((machine.resolved_links()[3].length, machine.resolved_links()[5].length), (0.55, 0.55));
    let turned = draw(&long, [SketchStep::Angle { bar: one, radians: 1.2 }]);
    let bar = turned.bar(one).expect("it has");
    assert!((turned.span(bar).arg() - 1.2).abs() < 1e-12);
    assert_eq!(complete(&resolve(&turned)).resolved_links(), machine.resolved_links());
}

#[test]
fn bars_are_split_joined_and_deleted() {
    let arm = Template::SerialOfTwo.sketch();
    let first = arm.bars[0].clone();
    let split = draw(&arm, [SketchStep::Split { bar: first.id, along: 0.15 }]);
    let machine = complete(&resolve(&split)).clone();
    assert_eq!(machine.links().len(), 3);
    let reach = |sketch: &Sketch| complete(&resolve(sketch)).reach();
    assert!((reach(&split) - reach(&arm)).abs() < 1e-12);
    let second = split.bars.last().expect("split").id;
    let whole = draw(&split, [SketchStep::Join { bar: first.id, with: second }]);
    assert_eq!((whole.bars.len(), whole.bars[0].tip), (2, first.tip));
    assert!((reach(&whole) - reach(&arm)).abs() < 1e-12);
    // Without the pin in the middle nothing is left of the split.
    let middle = whole.bars[0].pins[0];
    let again = draw(&whole, [SketchStep::DeletePin { pin: middle }]);
    assert_eq!((again.bars[0].pins.len(), again.pins.len()), (0, arm.pins.len()));
    // A carrier takes its motor with it.
    let bare = draw(&arm, [SketchStep::DeleteBar { bar: first.id }]);
    assert_eq!((bare.bars.len(), bare.motors.len(), bare.angles.len()), (1, 1, 0));
    assert!(bare.bars[0].drive.is_none());
    // Names follow.
    let named = draw(&arm, [SketchStep::NameDrive { drive: "2".into(), name: "elbow".into() }]);
    let machine = complete(&resolve(&named)).clone();
    assert_eq!((machine.spec().links[1].drive.as_str(), machine.angles()[0].to), ("elbow", 1));
}

/// A bar that was drawn towards the base, or meets it in its middle, is measured from there.
#[test]
fn bars_may_be_drawn_from_either_end() {
    let towards = draw(&Sketch::blank(), [bar(at(0.0, 0.4), pin(0)), motor(0, None, 2)]);
    assert_eq!(towards.bars[0].root, towards.base);
    let loose = [bar(at(-0.1, 0.4), at(0.3, 0.4)), bar(pin(0), BarEnd::on(BarId(3), 0.1))];
    let middle = draw(&Sketch::blank(), loose.into_iter().chain([motor(0, None, 5)]));
    let cross = middle.bars[0].clone();
    let carried = middle.bars[1].tip;
    let middle = draw(&middle, [motor(carried.0, Some(middle.bars[1].id.0), cross.id.0)]);
    let middle = draw(&middle, [SketchStep::EndEffector { pin: cross.tip, bar: None }]);
    let machine = complete(&resolve(&middle)).clone();
    assert_eq!(machine.resolved_links()[0].length, 0.3);
    // Its bar reaches over the pin behind its root, and has a hole for each of the three.
    let (part, ends) = (&machine.spec().parts[0], machine.part_ends(0).expect("a bar"));
    assert_eq!((part.link.as_str(), ends, part.holes.len()), ("1", [-0.1, 0.3], 3));
    let area = 0.4 * 0.03 + PI * (0.015 * 0.015 - 3.0 * 0.004 * 0.004);
    assert!((machine.links()[0].mass - area * 0.006 * 2700.0).abs() < 1e-12);
}

#[test]
fn a_pointer_snaps_to_pins_bars_angles_and_the_grid() {
    let sketch = draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0))]);
    let options = SnapOptions { grid: 0.05, angle: 15_f64.to_radians(), radius: 0.01 };
    let from = Some([0.0, 0.0]);
    let to = |from, x: f64, y: f64| snap(&sketch, from, [x, y], &options);
    assert_eq!(to(None, 0.304, 0.003).onto, Onto::Pin(PinId(1)));
    let on = to(None, 0.1502, 0.004);
    let Onto::Bar { bar, along } = on.onto else { panic!("{on:?}") };
    assert_eq!((bar, on.point[1]), (BarId(2), 0.0));
    assert!((along - 0.15).abs() < 1e-12);
    let angle = to(from, 0.203 * 30_f64.to_radians().cos(), 0.203 * 30_f64.to_radians().sin() + 0.004);
    assert_eq!(angle.onto, Onto::Angle);
    assert!((angle.angle - 30_f64.to_radians()).abs() < 1e-12 && (angle.length - 0.2).abs() < 1e-12);
    assert_eq!(to(None, 0.204, 0.206).onto, Onto::Grid);
    assert_eq!(to(None, 0.225, 0.225).onto, Onto::Free);
    // As long as a parallel bar.
    let parallel = snap(&sketch, Some([0.1, 0.2]), [0.404, 0.203], &options);
    assert_eq!((parallel.onto, parallel.point), (Onto::Angle, [0.4, 0.2]));
    // Where the start is, nothing is; without a radius nothing snaps; numbers stay finite.
    assert_ne!(to(from, 0.001, 0.001).onto, Onto::Pin(PinId(0)));
    let none = SnapOptions { grid: 0.0, angle: 0.0, radius: 0.0 };
    let free = snap(&sketch, from, [0.1234567, 0.2], &none);
    assert_eq!(free.onto, Onto::Free);
    assert!((free.length * 1e4 - (free.length * 1e4).round()).abs() < 1e-6);
    for x in [0.0, 1e6, 1e-12] {
        assert!(snap(&sketch, from, [x, x], &options).point.iter().all(|x| x.is_finite()));
        assert!(snap(&sketch, from, [x, x], &none).point.iter().all(|x| x.is_finite()));
    }
}

/// A random bar: from a pin or a bar, free or to close a parallelogram.
fn grown(noise: &mut Noise, sketch: &Sketch) -> Option<Vec<SketchStep>> {
    let pick = |noise: &mut Noise, n: usize| (noise.between(0.0, n as f64) as usize).min(n.saturating_sub(1));
    let start = sketch.pins[pick(noise, sketch.pins.len())].id;
    if noise.between(0.0, 1.0) < 0.35 && sketch.bars.len() > 1 {
        // Two bars that meet at a pin: the other two sides.
        let (a, b) = (&sketch.bars[pick(noise, sketch.bars.len())], &sketch.bars[pick(noise, sketch.bars.len())]);
        let shared = a.all_pins().find(|pin| b.has(*pin) && a.id != b.id)?;
        let end = |of: &stillbase::mechanics::sketch::Bar| if of.tip == shared { of.root } else { of.tip };
        let corner = sketch.at(end(a)) + sketch.at(end(b)) - sketch.at(shared);
        let first = bar(BarEnd::pin(end(a)), at(corner.re, corner.im));
        let next = sketch.with(&first).ok()?;
        return Some(vec![first, bar(BarEnd::pin(end(b)), BarEnd::pin(next.bars.last()?.tip))]);
    }
    let to = sketch.at(start) + unit(noise.between(-3.1, 3.1)).scale(noise.between(0.1, 0.5));
    Some(vec![bar(BarEnd::pin(start), at(to.re, to.im))])
}

#[test]
fn random_drawings_become_the_machines_that_are_drawn() {
    let (mut noise, mut loops, mut drawn) = (Noise::of(21), 0, 0);
    for _ in 0..150 {
        let mut sketch = Sketch::blank();
        for _ in 0..6 {
            let Some(steps) = grown(&mut noise, &sketch) else { continue };
            let grown = steps.iter().try_fold(sketch.clone(), |sketch, step| sketch.with(step));
            sketch = grown.unwrap_or(sketch);
            reaches_over_its_pins(&sketch);
        }
        for _ in 0..40 {
            let resolved = resolve(&sketch);
            let Some(step) = resolved.missing.first().and_then(|one| one.mends.first()) else { break };
            sketch = draw(&sketch, [step.step.clone()]);
        }
        let resolved = resolve(&sketch);
        let machine = complete(&resolved);
        loops += machine.loops().len();
        drawn += 1;
        // In the pose of the drawing every pin is where it was drawn.
        let arm = |k: usize| {
            let i = machine.resolved_links().iter().position(|link| link.drive == k).expect("it turns a bar");
            let (own, follow) = (&sketch.bars[i], &resolved.drives[&sketch.bars[i].id]);
            let span = sketch.span(own);
            (if follow.against { -span } else { span }).arg()
        };
        let e = DriveAngles(PerDrive::from_fn(machine.drives(), arm)).units();
        for (own, link) in sketch.bars.iter().zip(machine.resolved_links()) {
            let root = place_of(&link.root, &e);
            let tip = place_of(&link.point(link.length), &e);
            let ends = [sketch.at(own.root), sketch.at(own.tip)];
            let off = |a: Vector, b: Vector| (root - a).norm() + (tip - b).norm();
            assert!(off(ends[0], ends[1]).min(off(ends[1], ends[0])) < 1e-9, "{own:?}\n{sketch:?}");
        }
        let end = sketch.end_effector.expect("placed").pin;
        assert!((place_of(machine.end_effector(), &e) - sketch.at(end)).norm() < 1e-9);
        // A drawing is plain data.
        let text = toml::to_string(&sketch).expect("plain data");
        assert_eq!(toml::from_str::<Sketch>(&text).expect("read again"), sketch, "{text}");
    }
    assert!(loops > 40 && drawn == 150, "{loops}");
}

/// A pin that a bar runs over without joining it is told, with the step that joins both; no mend makes motors carry each
/// other.
#[test]
fn a_bar_over_a_pin_is_told_and_joined() {
    let bar = |from: BarEnd, to: [f64; 2]| SketchStep::Bar { from, to: BarEnd::At(to), name: None };
    let mut sketch = Sketch::blank();
    for step in [bar(BarEnd::pin(sketch.base), [0.0, 0.3]), bar(BarEnd::pin(sketch.base), [0.2, 0.0])] {
        sketch = sketch.with(&step).expect("a bar");
    }
    let end = sketch.bars[1].tip;
    sketch = sketch.with(&bar(BarEnd::pin(end), [0.2, 0.3])).expect("a bar");
    let corner = sketch.bars[2].tip;
    // Over the end of bar 1 and beyond.
    sketch = sketch.with(&bar(BarEnd::pin(corner), [-0.2, 0.3])).expect("a bar");
    let crossings = resolve(&sketch).crossings;
    let [crossing] = crossings.as_slice() else { panic!("{crossings:?}") };
    assert_eq!(crossing.text, "bar 4 runs over the pin of bar 1, and is not joined to it");
    let joined = sketch.with(&crossing.mends[0].step).expect("joined");
    let over = &joined.bars[3];
    assert!(over.has(joined.bars[0].tip) && resolve(&joined).crossings.is_empty());
    assert!(resolve(&joined).loops.iter().any(|state| state.bars.len() == 4), "a parallelogram");
    let step = SketchStep::Attach { pin: joined.bars[0].tip, bar: over.id };
    let again = joined.with(&step).expect_err("joined already");
    assert!(again.to_string().contains("on bar 4 already"), "{again}");
}

/// A motor at the pin between two bars turns the outer one, and sits on the inner one.
#[test]
fn a_motor_between_two_bars_turns_the_outer_one() {
    let bar = |from: BarEnd, to: [f64; 2]| SketchStep::Bar { from, to: BarEnd::At(to), name: None };
    let mut sketch = Sketch::blank();
    sketch = sketch.with(&bar(BarEnd::pin(sketch.base), [0.3, 0.0])).expect("a bar");
    let elbow = sketch.bars[0].tip;
    sketch = sketch.with(&bar(BarEnd::pin(elbow), [0.5, 0.2])).expect("a bar");
    let [inner, outer] = [0, 1].map(|i| sketch.bars[i].id);
    let step = sketch.motor_at(elbow, |_| true);
    assert!(matches!(step, SketchStep::Motor { stator: Some(on), turns: Some(of), .. } if on == inner && of == outer));
    let hung = sketch.with(&step).expect("a motor");
    for missing in resolve(&hung).missing {
        for mend in missing.mends {
            let next = hung.with(&mend.step).expect("tried");
            assert!(resolve(&next).missing.iter().all(|one| !one.text.contains("carry each other")), "{mend:?}");
        }
    }
}
