//! Drawings of machines: what they are, what they lack, and machines drawn.

use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Chain, Machine, builtin, builtins, place_of, to_toml};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use stillbase::mechanics::sketch::{
    BarEnd, BarId, Lack, LoopShape, Missing, PinId, Resolved, Sketch, SketchStep, Template, resolve,
};

use crate::support::Noise;
use crate::support::random::a_machine;

pub fn draw(sketch: &Sketch, steps: impl IntoIterator<Item = SketchStep>) -> Sketch {
    steps.into_iter().fold(sketch.clone(), |sketch, step| {
        sketch.with(&step).unwrap_or_else(|refusal| panic!("{step:?}: {refusal}\n{sketch:?}"))
    })
}

pub fn bar(from: BarEnd, to: BarEnd) -> SketchStep {
    SketchStep::Bar { from, to, name: None }
}

pub fn at(x: f64, y: f64) -> BarEnd {
    BarEnd::At([x, y])
}

pub fn pin(id: u32) -> BarEnd {
    BarEnd::pin(PinId(id))
}

pub fn motor(id: u32, stator: Option<u32>, turns: u32) -> SketchStep {
    let (stator, turns) = (stator.map(BarId), Some(BarId(turns)));
    SketchStep::Motor { pin: PinId(id), stator, drive: None, rotor: None, turns }
}

#[track_caller]
pub fn complete(resolved: &Resolved) -> &Machine {
    let texts: Vec<&str> = resolved.missing.iter().map(|one| one.text.as_str()).collect();
    resolved.machine.as_ref().unwrap_or_else(|| panic!("missing: {texts:?}"))
}

#[track_caller]
fn near(what: &str, a: &Chain, b: &Chain) {
    let off = a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(off < 1e-11, "{what}: {a:?} and {b:?}");
}

/// The same links in the same places, with the same masses, drives, angles and end effector.
#[track_caller]
fn same_machine(name: &str, got: &Machine, want: &Machine, masses: bool) {
    assert_eq!(got.links().len(), want.links().len(), "{name}");
    let pairs = got.resolved_links().iter().zip(want.resolved_links());
    for (i, (a, b)) in pairs.enumerate() {
        let what = format!("{name}, link {}", want.links()[i].name);
        assert_eq!((a.drive, a.sign), (b.drive, b.sign), "{what}");
        near(&what, &a.root, &b.root);
        near(&what, &a.point(a.length), &b.point(b.length));
        let (l, m) = (&got.links()[i], &want.links()[i]);
        assert_eq!((&l.name, &l.drive), (&m.name, &m.drive), "{name}");
        if masses {
            assert_eq!(
                (l.mass, l.inertia, l.com, l.com_normal, l.axial),
                (m.mass, m.inertia, m.com, m.com_normal, m.axial)
            );
        }
    }
    near(name, got.end_effector(), want.end_effector());
    assert_eq!(got.loops().len(), want.loops().len(), "{name}: closures");
    assert!(got.closure_gaps().iter().flatten().all(|gap| gap.abs() < 1e-12), "{name}");
    let (got, want) = (got.spec(), want.spec());
    assert_eq!((&got.drives, &got.angles, got.gravity), (&want.drives, &want.angles, want.gravity), "{name}");
    assert_eq!((&got.payload, &got.counterweights), (&want.payload, &want.counterweights), "{name}");
}

#[test]
fn a_machine_is_drawn_and_made_again() {
    for machine in builtins() {
        let sketch = Sketch::of(machine, None);
        sketch.check().expect("a drawing");
        let again = complete(&resolve(&sketch)).clone();
        same_machine(machine.name(), &again, machine, true);
        // And once more: a drawing of what was drawn is the same.
        let twice = complete(&resolve(&Sketch::of(&again, None))).clone();
        assert_eq!(to_toml(&twice), to_toml(&again));
    }
}

#[test]
fn random_machines_are_drawn_and_made_again() {
    let mut noise = Noise::of(7);
    let mut loops = 0;
    for i in 0..200 {
        let machine = a_machine(&mut noise);
        let q = DriveAngles(PerDrive::from_fn(machine.drives(), |_| noise.between(-3.1, 3.1)));
        let sketch = Sketch::of(&machine, Some(&q));
        let again = complete(&resolve(&sketch)).clone();
        same_machine(&format!("random {i}"), &again, &machine, true);
        loops += machine.loops().len();
        // The drawing has every link where the machine has it in this pose.
        let e = q.units();
        for (bar, link) in sketch.bars.iter().zip(machine.resolved_links()) {
            for (pin, s) in [(bar.root, 0.0), (bar.tip, link.length)] {
                assert!((sketch.at(pin) - place_of(&link.point(s), &e)).norm() < 1e-9);
            }
        }
    }
    assert!(loops > 50, "{loops}");
}

#[test]
fn every_template_is_a_machine() {
    for template in Template::ALL {
        let sketch = template.sketch();
        sketch.check().expect("a drawing");
        if template == Template::Blank {
            let lacks: Vec<Lack> = resolve(&sketch).missing.into_iter().map(|one| one.lack).collect();
            assert_eq!(lacks, [Lack::NoBar, Lack::NoMotor, Lack::NoEndEffector]);
            continue;
        }
        let machine = complete(&resolve(&sketch)).clone();
        assert_eq!(machine.name(), template.title());
        let wanted = match template {
            Template::SerialOfTwo | Template::ScaraWithBelts => (2, 2, 0),
            Template::SerialOfThree => (3, 3, 0),
            Template::ParallelogramArm | Template::Pantograph => (2, 4, 1),
            _ => (3, 9, 3),
        };
        assert_eq!((machine.drives(), machine.links().len(), machine.loops().len()), wanted, "{template:?}");
        assert!(machine.angles().iter().all(|angle| angle.limits.start().is_finite()), "{template:?}");
    }
    // The pantograph: its end effector is twice as far from B as the pin inside.
    let machine = complete(&resolve(&Template::Pantograph.sketch())).clone();
    let inside = machine.resolved_links()[2].point(machine.resolved_links()[2].length);
    near("pantograph", &inside.map(|w| 2.0 * w), machine.end_effector());
}

#[test]
fn the_nine_links_of_the_template_are_those_of_the_paper() {
    let paper = builtin("nine-link").expect("built in");
    let sketch = Template::NineLinks.sketch();
    assert_eq!(sketch.bars.iter().filter(|bar| bar.drive.is_some()).count(), 3, "the rest follows from loops");
    let resolved = resolve(&sketch);
    assert!(resolved.loops.len() == 3 && resolved.loops.iter().all(|of| of.shape == LoopShape::Closed));
    let machine = complete(&resolved);
    same_machine("nine links", machine, paper, true);
    let text = to_toml(machine);
    for line in ["l1 = 0.5\n", "l2 = 0.18\n", "l3 = 0.2\n", "l5 = 0.46\n", "at = \"-l2\"", "at = \"-l3\"", "l9 = 0.3\n"]
    {
        assert!(text.contains(line), "{line} in\n{text}");
    }
    let mut noise = Noise::of(3);
    for _ in 0..100 {
        let e =
            DriveAngles::from([noise.between(-3.0, 3.0), noise.between(-3.0, 3.0), noise.between(-3.0, 3.0)]).units();
        let places = |machine: &Machine| end_effector(machine.end_effector(), &e);
        assert!((places(machine) - places(paper)).norm() < 1e-12);
    }
}

/// A parallelogram of two drives, of which one corner is off by a vector, m.
fn nearly(off: Vector) -> Result<Sketch, stillbase::mechanics::sketch::SketchRefusal> {
    let blank = Sketch::blank();
    let (a, b) = (unit(1.9).scale(0.4), unit(0.4).scale(0.3));
    let corner = a + b + off;
    let steps = [bar(pin(0), at(a.re, a.im)), bar(pin(0), at(b.re, b.im)), bar(pin(1), at(corner.re, corner.im))];
    let sketch = draw(&blank, steps);
    sketch.with(&bar(pin(3), pin(5)))
}

#[test]
fn parallelograms_that_nearly_close_are_mended() {
    let mut noise = Noise::of(11);
    for _ in 0..300 {
        let off = unit(noise.between(-3.1, 3.1)).scale(noise.between(0.0, 0.02));
        let sketch = nearly(off).expect("nearly a parallelogram");
        let resolved = resolve(&sketch);
        let [found] = &resolved.loops[..] else { panic!("one loop") };
        let LoopShape::Nearly { off: said } = found.shape else { panic!("{off}: {:?}", found.shape) };
        assert!((said - off.norm()).abs() < 1e-9);
        let missing = resolved.missing.iter().find(|one| matches!(one.lack, Lack::LoopOff { .. })).expect("said");
        assert!(
            missing.text.starts_with("loop ") && missing.text.ends_with(" mm off a parallelogram"),
            "{}",
            missing.text
        );
        let mend = missing.mends.first().expect("a step");
        assert!(mend.label.contains("becomes") || off.norm() < 1e-3, "{}", mend.label);
        let mended = draw(&sketch, [mend.step.clone()]);
        assert!(resolve(&mended).loops.iter().all(|of| of.shape == LoopShape::Closed));
    }
    let closed = nearly(Vector::default()).expect("a parallelogram");
    assert_eq!(resolve(&closed).loops[0].shape, LoopShape::Closed);
    // Far off, it is refused, and a step is named that would do.
    let refusal = nearly(Vector::new(0.15, 0.1)).expect_err("no parallelogram");
    assert!(refusal.to_string().contains("no parallelogram"), "{refusal}");
    assert!(!refusal.proposals.is_empty());
}

/// Every step that is proposed can be done, and what it mends is mended.
#[track_caller]
fn mends_mend(sketch: &Sketch, resolved: &Resolved) {
    for one in &resolved.missing {
        for mend in &one.mends {
            let next = draw(sketch, [mend.step.clone()]);
            let after = resolve(&next);
            let is_same = |other: &Missing| other.text == one.text;
            assert!(!after.missing.iter().any(is_same), "{}: {mend:?}", one.text);
        }
    }
}

/// Follows the first step that is proposed until nothing is missing.
#[track_caller]
fn mended(sketch: &Sketch) -> Sketch {
    let mut sketch = sketch.clone();
    for _ in 0..60 {
        let resolved = resolve(&sketch);
        mends_mend(&sketch, &resolved);
        let Some(one) = resolved.missing.first() else { return sketch };
        let mend = one.mends.first().unwrap_or_else(|| panic!("no step for {}: {sketch:?}", one.text));
        sketch = draw(&sketch, [mend.step.clone()]);
    }
    panic!("never complete: {:?}", resolve(&sketch).missing);
}

#[test]
fn what_is_missing_can_be_mended_to_a_machine() {
    complete(&resolve(&mended(&Sketch::blank())));
    let mut noise = Noise::of(5);
    for _ in 0..60 {
        let off = unit(noise.between(-3.1, 3.1)).scale(noise.between(0.0, 0.015));
        let machine = complete(&resolve(&mended(&nearly(off).expect("near")))).clone();
        assert_eq!((machine.drives(), machine.loops().len()), (2, 1));
    }
    // A bar that is not connected, a drive that turns nothing, bars that are said to follow another drive.
    let loose = draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0)), bar(at(0.5, 0.1), at(0.6, 0.4)), motor(0, None, 2)]);
    assert!(resolve(&loose).missing.iter().any(|one| one.lack == Lack::Loose));
    complete(&resolve(&mended(&loose)));
    let two = draw(&loose, [SketchStep::Motor { pin: PinId(0), stator: None, drive: None, rotor: None, turns: None }]);
    assert!(resolve(&two).missing.iter().any(|one| one.lack == Lack::NoBarOfDrive));
    complete(&resolve(&mended(&two)));
    let closed = nearly(Vector::default()).expect("a parallelogram");
    let mut torn = draw(&closed, [motor(0, None, 2), motor(0, None, 4)]);
    torn.bars[2].drive = Some("1".into());
    torn.bars[2].against = false;
    let lacks: Vec<Lack> = resolve(&torn).missing.into_iter().map(|one| one.lack).collect();
    assert!(lacks.iter().any(|lack| matches!(lack, Lack::DrivesDiffer { .. })), "{lacks:?}");
    complete(&resolve(&mended(&torn)));
    // Two bars of one drive that are not parallel.
    let steps = [bar(pin(0), at(0.3, 0.0)), motor(0, None, 2), bar(pin(1), at(0.5, 0.02))];
    let follow = SketchStep::Follow { bar: BarId(4), drive: Some("1".into()) };
    let bent = draw(&Sketch::blank(), steps.into_iter().chain([follow]));
    let lacks: Vec<Lack> = resolve(&bent).missing.into_iter().map(|one| one.lack).collect();
    assert!(lacks.iter().any(|lack| matches!(lack, Lack::NotParallel { .. })), "{lacks:?}");
    complete(&resolve(&mended(&bent)));
}

#[test]
fn loops_outside_the_family_are_refused_with_the_reason() {
    let arms = draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0)), bar(pin(0), at(0.0, 0.3))]);
    let triangle = arms.with(&bar(pin(1), pin(3))).expect_err("a triangle");
    assert_eq!(
        triangle.to_string(),
        "bars 1, 3 and 2 are a triangle, in which no bar can turn: want every bar parallel to the arm of one drive, \
         so that loops are parallelograms; a bar that ends free would do"
    );
    assert!(!triangle.proposals.is_empty());
    draw(&arms, [triangle.proposals[0].clone()]);
    let arms = draw(&arms, [bar(pin(1), at(0.5, 0.3)), bar(pin(3), at(0.2, 0.6))]);
    let five = arms.with(&bar(pin(5), pin(7))).expect_err("a five-bar");
    assert!(five.to_string().contains("a loop of 5"), "{five}");
    assert_eq!(five.place, stillbase::mechanics::sketch::Place::Pin(PinId(7)));
    // The same in a drawing from a file is listed, not refused.
    let square =
        draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0)), bar(pin(0), at(0.0, 0.3)), bar(pin(1), at(0.3, 0.3))]);
    let mut square = draw(&square, [bar(pin(3), pin(5))]);
    square.pins.iter_mut().filter(|pin| pin.id == PinId(5)).for_each(|pin| pin.at = [0.5, 0.6]);
    let resolved = resolve(&square);
    let outside = resolved.missing.iter().find(|one| matches!(one.lack, Lack::LoopOutside { .. })).expect("said");
    assert!(!outside.mends.is_empty() && outside.text.contains("no parallelogram"), "{}", outside.text);
    mends_mend(&square, &resolved);
}
