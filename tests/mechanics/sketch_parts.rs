//! Drawings of machines that are made of parts: nothing is lost on the way to a drawing and back, and bars that are
//! split, joined, turned and lengthened keep what they weigh.

use stillbase::mechanics::machine::{
    Hole, LinkNumber, Lump, Machine, Material, Part, PlaceOnLink, PlaneBody, Shape, parse, to_toml,
};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};
use stillbase::mechanics::sketch::{Bar, BarId, Body, PinId, Sketch, SketchStep, Template, resolve};

use super::sketch::{at, bar, complete, draw, motor, pin};
use crate::support::Noise;
use crate::support::random::with_counterweights;

fn part(link: &str, shape: Shape) -> Part {
    let is = |of: &[Shape], x: f64| of.contains(&shape).then_some(x);
    Part {
        link: link.into(),
        name: String::new(),
        shape,
        from: PlaceOnLink::Named("root".into()),
        to: PlaceOnLink::default(),
        across: 0.0,
        material: "aluminium".into(),
        width: is(&[Shape::Flat, Shape::Profile], 0.03),
        thickness: is(&[Shape::Flat, Shape::Plate], 0.006),
        diameter: is(&[Shape::Tube], 0.02),
        height: is(&[Shape::Profile], 0.02),
        wall: is(&[Shape::Tube, Shape::Profile], 0.002),
        ends: None,
        polygon: Vec::new(),
        holes: Vec::new(),
    }
}

fn lump(link: &str, mass: f64, at: PlaceOnLink) -> Lump {
    Lump { link: link.into(), name: "motor".into(), mass, at, across: 0.01, inertia: 1e-4 }
}

/// A random machine of which some links are made of parts; some of their numbers are typed.
fn made_of_parts(noise: &mut Noise) -> Machine {
    let machine = with_counterweights(noise);
    let mut spec = machine.spec().clone();
    spec.materials.push(Material { name: "pom".into(), density: 1410.0 });
    spec.lengths.insert("l-hole".into(), 0.031);
    let mut chance = |p: f64| noise.between(0.0, 1.0) < p;
    for i in 0..spec.links.len() {
        let name = spec.links[i].name.clone();
        if chance(0.3) {
            continue;
        }
        for shape in [Shape::Flat, Shape::Tube, Shape::Profile, Shape::Plate] {
            if chance(0.4) {
                let mut own = part(&name, shape);
                if shape == Shape::Plate {
                    own.polygon = vec![[-0.02, -0.02], [0.06, -0.03], [0.1, 0.04], [0.0, 0.03]];
                } else if chance(0.5) {
                    (own.from, own.to) = (PlaceOnLink::Metres(-0.02), PlaceOnLink::Metres(0.07));
                }
                if matches!(shape, Shape::Flat | Shape::Plate) {
                    let at = PlaceOnLink::Named("l-hole".into());
                    own.holes.push(Hole { at, across: 0.001, diameter: 0.008 });
                }
                own.across = if chance(0.5) { 0.013 } else { 0.0 };
                own.material = if chance(0.5) { "pom".into() } else { "steel".into() };
                own.name = if chance(0.3) { format!("{name} {shape:?}") } else { String::new() };
                spec.parts.push(own);
            }
        }
        if chance(0.4) {
            spec.lumps.push(lump(&name, 0.2, PlaceOnLink::default()));
        }
        if spec.has_parts(&name) {
            for number in LinkNumber::ALL {
                if chance(0.7) {
                    spec.links[i].type_number(number, None);
                }
            }
        }
    }
    Machine::new(spec).expect("a machine of parts")
}

#[track_caller]
fn alike(what: &str, a: &PlaneBody, b: &PlaneBody) {
    let size = a.inertia / a.mass;
    let off = [
        (a.mass - b.mass).abs() / a.mass,
        (a.at - b.at).abs() / size.sqrt(),
        (a.across - b.across).abs() / size.sqrt(),
        (a.inertia - b.inertia).abs() / a.inertia,
    ];
    assert!(off.iter().all(|off| *off < 1e-7), "{what}: {a:?} and {b:?}");
}

#[test]
fn a_machine_of_parts_is_drawn_and_made_again() {
    let (mut noise, mut parts) = (Noise::of(31), 0);
    for i in 0..200 {
        let machine = made_of_parts(&mut noise);
        let q = DriveAngles(PerDrive::from_fn(machine.drives(), |_| noise.between(-3.1, 3.1)));
        let sketch = Sketch::of(&machine, Some(&q));
        sketch.check().unwrap_or_else(|why| panic!("random {i}: {why}"));
        let again = complete(&resolve(&sketch)).clone();
        let (got, want) = (again.spec(), machine.spec());
        assert_eq!((&got.counterweights, &got.materials), (&want.counterweights, &want.materials));
        assert_eq!((got.parts.len(), got.lumps.len()), (want.parts.len(), want.lumps.len()));
        for (a, b) in again.part_bodies().iter().zip(machine.part_bodies()) {
            assert_eq!((a.link, a.source, a.title(got)), (b.link, b.source, b.title(want)));
            alike(&format!("random {i}"), &a.body, &b.body);
        }
        for (a, b) in got.links.iter().zip(&want.links) {
            for number in LinkNumber::ALL {
                let what = format!("random {i}: {} of link {}", number.key(), a.name);
                assert_eq!(a.follows(number), b.follows(number), "{what}");
                assert!((a.number(number) - b.number(number)).abs() < 1e-11, "{what}");
            }
            assert_eq!(a.axial, b.axial);
        }
        parts += machine.part_bodies().len();
        // And once more: to the last letter.
        let twice = complete(&resolve(&Sketch::of(&again, None))).clone();
        assert_eq!(to_toml(&twice), to_toml(&again), "random {i}");
    }
    assert!(parts > 500, "{parts}");
    let arm = parse(include_str!("parts.toml"), "parts.toml").expect("an arm");
    let again = complete(&resolve(&Sketch::of(&arm, None))).clone();
    let list = |machine: &Machine| (machine.spec().parts.clone(), machine.spec().lumps.clone());
    assert_eq!(list(&again), list(&arm), "places and all");
}

/// All that a bar has, about the root of the bar as it was drawn: mass, centre, inertia.
fn all(sketch: &Sketch, bars: &[&Bar]) -> PlaneBody {
    let first = bars[0];
    let along = sketch.span(first) / sketch.length(first);
    let of = |own: &&Bar| {
        let sense = if (sketch.span(own) * along.conj()).re < 0.0 { -1.0 } else { 1.0 };
        let from = sketch.along(first, own.root);
        let discs = sketch.counterweights.iter().filter(|weight| weight.link == own.name);
        let disc = |weight: &stillbase::mechanics::machine::Counterweight| PlaneBody {
            mass: weight.mass,
            at: weight.at,
            across: weight.across,
            inertia: weight.inertia(),
        };
        let body = discs.map(disc).fold(sketch.body(own), PlaneBody::and);
        PlaneBody { at: from + sense * body.at, across: sense * body.across, ..body }
    };
    bars.iter().map(of).reduce(PlaneBody::and).expect("a bar")
}

#[test]
fn split_and_joined_bars_keep_what_they_weigh() {
    let (mut noise, mut splits, mut joins) = (Noise::of(41), 0, 0);
    for i in 0..300 {
        let machine = made_of_parts(&mut noise);
        let sketch = Sketch::of(&machine, None);
        let own =
            sketch.bars[(noise.between(0.0, sketch.bars.len() as f64) as usize).min(sketch.bars.len() - 1)].clone();
        let along = noise.between(0.05, 0.95) * sketch.length(&own);
        let Ok(split) = sketch.with(&SketchStep::Split { bar: own.id, along }) else { continue };
        splits += 1;
        let (first, second) = (split.bar(own.id).expect("kept"), split.bars.last().expect("cut off"));
        alike(&format!("split {i}"), &all(&split, &[first, second]), &all(&sketch, &[&own]));
        let what = (split.lumps.len(), split.counterweights.len());
        assert_eq!(what, (sketch.lumps.len(), sketch.counterweights.len()));
        let before = all(&split, &[first, second]);
        let root = split.at(first.root);
        let Ok(whole) = split.with(&SketchStep::Join { bar: first.id, with: second.id }) else { continue };
        joins += 1;
        let joined = whole.bar(first.id).expect("kept");
        let after = all(&whole, &[joined]);
        // A bar may be measured from another pin afterwards.
        let shift = (whole.at(joined.root) - root) * (whole.span(joined) / whole.length(joined)).conj();
        alike(&format!("join {i}"), &PlaneBody { at: after.at + shift.re, ..after }, &before);
    }
    assert!(splits > 150 && joins > 150, "{splits} and {joins}");
}

/// A tube is cut in two tubes, which add up; round ends at the cut do not, so that numbers are typed.
#[test]
fn a_part_over_the_cut_becomes_two() {
    let arm = Template::SerialOfTwo.sketch();
    let own = arm.bars[0].clone();
    for shape in [Shape::Tube, Shape::Flat] {
        let made = |parts| SketchStep::Parts { bar: own.id, parts, lumps: vec![] };
        let tube = draw(&arm, [made(vec![part(&own.name, shape)])]);
        let whole = tube.body(&tube.bars[0]);
        let split = draw(&tube, [SketchStep::Split { bar: own.id, along: 0.15 }]);
        let cut = split.bars.last().expect("cut off").clone();
        assert_eq!(split.parts.iter().map(|part| part.link.as_str()).collect::<Vec<_>>(), ["1", cut.name.as_str()]);
        assert!(split.parts.iter().all(|part| part.to == PlaceOnLink::default()), "{:?}", split.parts);
        assert_eq!(split.bars[0].body.is_none(), shape == Shape::Tube);
        let both = split.body(&split.bars[0]).mass + split.body(&cut).mass;
        assert!((both - whole.mass).abs() < 1e-12 * whole.mass);
        complete(&resolve(&split));
    }
}

#[test]
fn what_spans_a_bar_grows_with_it_and_what_lies_at_a_pin_follows_it() {
    let arm = draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0)), motor(0, None, 2)]);
    let arm = draw(&arm, [bar(stillbase::mechanics::sketch::BarEnd::on(BarId(2), 0.2), at(0.2, 0.2))]);
    let middle = arm.bars[0].pins[0];
    let hole = |x: f64| Hole { at: PlaceOnLink::Metres(x), across: 0.0, diameter: 0.006 };
    let flat = Part { holes: vec![hole(0.2), hole(0.05)], ..part("1", Shape::Flat) };
    let step = SketchStep::Parts {
        bar: BarId(2),
        parts: vec![flat],
        lumps: vec![lump("1", 0.1, PlaceOnLink::default()), lump("1", 0.1, PlaceOnLink::Metres(0.1))],
    };
    let arm = draw(&arm, [step]);
    let mass = arm.body(&arm.bars[0]).mass;
    let longer = draw(&arm, [SketchStep::Length { bar: BarId(2), metres: 0.4 }]);
    let more = longer.body(&longer.bars[0]).mass - mass;
    assert!((more - 0.1 * 0.03 * 0.006 * 2700.0).abs() < 1e-12, "{more}");
    assert_eq!(longer.parts[0].holes, arm.parts[0].holes, "its pins between the ends keep their places");
    let moved = draw(&arm, [SketchStep::MovePin { pin: middle, to: [0.23, 0.0] }]);
    let x = moved.along(&moved.bars[0], middle);
    assert!((x - 0.23).abs() < 1e-9, "{x}");
    let [PlaceOnLink::Metres(at_pin), PlaceOnLink::Metres(other)] = [0, 1].map(|i| moved.parts[0].holes[i].at.clone())
    else {
        panic!("{:?}", moved.parts)
    };
    assert!((at_pin - x).abs() < 1e-12 && other == 0.05);
    // Renamed, its parts go along; deleted, they go.
    let named = draw(&moved, [SketchStep::NameBar { bar: BarId(2), name: "arm".into() }]);
    assert!(named.parts.iter().all(|part| part.link == "arm") && named.lumps.iter().all(|lump| lump.link == "arm"));
    let gone = draw(&named, [SketchStep::DeleteBar { bar: BarId(2) }]);
    assert!(gone.parts.is_empty() && gone.lumps.is_empty());
    // The end pin deleted: the bar ends at the next, and so does what spanned it.
    let short = draw(&arm, [SketchStep::DeletePin { pin: PinId(1) }]);
    assert_eq!(short.bars[0].tip, middle);
    assert_eq!(short.parts[0].to, PlaceOnLink::default());
    assert_eq!(short.lumps[0].at, PlaceOnLink::Metres(0.3), "a lump stays where it was");
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let arm = draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0)), motor(0, None, 2)]);
    let refused = |part: Part| {
        let step = SketchStep::Parts { bar: BarId(2), parts: vec![part], lumps: vec![] };
        arm.with(&step).expect_err("refused").to_string()
    };
    assert!(refused(part("7", Shape::Flat)).contains("parts of bar 1"));
    assert!(refused(Part { wall: Some(0.02), ..part("1", Shape::Tube) }).contains("more than half of the diameter"));
    assert!(refused(Part { width: None, ..part("1", Shape::Flat) }).contains("has a width"));
    assert!(refused(Part { material: "cheese".into(), ..part("1", Shape::Flat) }).contains("cheese"));
    assert!(refused(part("1", Shape::Plate)).contains("three corners"));
    let hole = |at: PlaceOnLink| vec![Hole { at, across: 0.0, diameter: 0.006 }];
    let far = Part { holes: hole(PlaceOnLink::Metres(0.4)), ..part("1", Shape::Flat) };
    assert!(refused(far).contains("beyond the part"));
    assert!(refused(Part { to: PlaceOnLink::Named("l9".into()), ..part("1", Shape::Flat) }).contains("l9"));
    let corners = Part { polygon: vec![[0.0, 0.0]; 5000], ..part("1", Shape::Plate) };
    assert!(refused(corners).contains("at most 100"));
    // A typed number overrules, and lets go again.
    let made = SketchStep::Parts { bar: BarId(2), parts: vec![part("1", Shape::Flat)], lumps: vec![] };
    let own = Body { mass: Some(0.7), ..Body::default() };
    let mass = |body| SketchStep::Mass { bar: BarId(2), body, per_metre: 1.0 };
    let typed = draw(&arm, [made.clone(), mass(Some(own))]);
    assert_eq!(typed.body(&typed.bars[0]).mass, 0.7);
    let free = draw(&typed, [mass(None)]);
    assert_eq!(free.body(&free.bars[0]), draw(&arm, [made]).body(&arm.bars[0]));
}

/// What drawing adds and subtracts is written as a person would write it, and weighs the same.
#[test]
fn computed_numbers_are_written_as_a_person_would() {
    let drawn = draw(&Template::Blank.sketch(), [bar(pin(0), at(1.8e-17, 0.8))]);
    let own = drawn.bars[0].clone();
    assert_eq!(drawn.at(own.tip).re, 0.0);
    let lumps = [0.7, 0.65, 0.3].map(|x| lump(&own.name, 0.1, PlaceOnLink::Metres(x)));
    let holes = [0.6, 0.75].map(|x| Hole { at: PlaceOnLink::Metres(x), across: 0.0, diameter: 0.004 });
    let parts = vec![Part { holes: holes.to_vec(), ..part(&own.name, Shape::Flat) }];
    let step = SketchStep::Parts { bar: own.id, parts, lumps: lumps.to_vec() };
    let split = draw(&drawn, [step, SketchStep::Split { bar: own.id, along: 0.5 }]);
    let all = split.lumps.iter().map(|lump| &lump.at);
    let all = all.chain(split.parts.iter().flat_map(|part| part.holes.iter().map(|hole| &hole.at)));
    let places: Vec<f64> =
        all.filter_map(|place| if let PlaceOnLink::Metres(x) = place { Some(*x) } else { None }).collect();
    assert!(0.7 - 0.5 != 0.2 && places.contains(&0.2) && places.contains(&0.15) && places.contains(&0.1), "{places:?}");
    assert!(places.iter().all(|x| x.to_string().len() < 8), "{places:?}");
    // Joined again, everything is where it was.
    let other = split.bars.last().expect("cut off").id;
    let joined = draw(&split, [SketchStep::Join { bar: own.id, with: other }]);
    assert_eq!(
        joined.lumps,
        draw(&drawn, [SketchStep::Parts { bar: own.id, parts: vec![], lumps: lumps.to_vec() }]).lumps
    );
    // A step that a person has not typed is written plainly, too.
    let turned = [1.8e-17, 0.7 - 0.5];
    let step = SketchStep::MovePin { pin: own.tip, to: turned }.plainly();
    assert_eq!(step, SketchStep::MovePin { pin: own.tip, to: [0.0, 0.2] });
    let limits = |range| SketchStep::Limits { to: "2".into(), from: "1".into(), offset: 0.0, range: Some(range) };
    assert_eq!(limits([30_f64.to_radians(), 1.2]).plainly(), limits([0.523598775598, 1.2]));
}
