//! Drawings of machines that are made of parts: nothing is lost on the way to a drawing and back, and bars that are
//! split, joined, turned and lengthened keep what they weigh.

use std::f64::consts::PI;

use stillbase::mechanics::machine::{
    Counterweight, CounterweightShape, Ends, Hole, LinkNumber, Lump, MATERIALS, Machine, Material, Part, PlaceOnLink,
    PlaneBody, Shape, parse, to_toml,
};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::mechanics::sketch::{Bar, BarEnd, BarId, Body, PinId, Sketch, SketchStep, Template, resolve};

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

/// A place along a bar, m from its root; a drawing names no lengths.
fn metres(sketch: &Sketch, own: &Bar, place: &PlaceOnLink) -> f64 {
    match place {
        PlaceOnLink::Metres(x) => *x,
        PlaceOnLink::Named(word) if word == "tip" => sketch.length(own),
        PlaceOnLink::Named(_) => 0.0,
    }
}

/// The discs that a cut adds: each half of a flat bar with round ends has an end of its own there.
fn round_ends(sketch: &Sketch, own: &Bar, along: f64) -> Vec<PlaneBody> {
    let metres = |place: &PlaceOnLink| metres(sketch, own, place);
    let is_cut = |part: &&Part| {
        let is_round = part.shape == Shape::Flat && part.ends != Some(Ends::Square);
        part.link == own.name && is_round && metres(&part.from) < along && metres(&part.to) > along
    };
    let density = |name: &str| {
        let own = sketch.materials.iter().map(|material| (material.name.as_str(), material.density));
        own.chain(MATERIALS).find(|(known, _)| *known == name).expect("known").1
    };
    let disc = |part: &Part| {
        let [width, thickness] = [part.width, part.thickness].map(|length| length.expect("a flat bar"));
        PlaneBody::disc(0.5 * width).times(thickness * density(&part.material)).moved(along, part.across)
    };
    let follows = own.body.is_none_or(|body| body.follows());
    sketch.parts.iter().filter(|_| follows).filter(is_cut).map(disc).collect()
}

#[test]
fn split_and_joined_bars_keep_what_they_weigh() {
    let (mut noise, mut splits, mut joins, mut rounds) = (Noise::of(41), 0, 0, 0);
    for i in 0..300 {
        let machine = made_of_parts(&mut noise);
        let sketch = Sketch::of(&machine, None);
        let own =
            sketch.bars[(noise.between(0.0, sketch.bars.len() as f64) as usize).min(sketch.bars.len() - 1)].clone();
        let along = noise.between(0.05, 0.95) * sketch.length(&own);
        let Ok(split) = sketch.with(&SketchStep::Split { bar: own.id, along }) else { continue };
        splits += 1;
        let (first, second) = (split.bar(own.id).expect("kept"), split.bars.last().expect("cut off"));
        let follows = [first, second].iter().all(|bar| bar.body.is_none_or(|body| body.follows()));
        let ends = if follows { round_ends(&sketch, &own, along) } else { Vec::new() };
        rounds += ends.len();
        let whole = ends.into_iter().fold(all(&sketch, &[&own]), PlaneBody::and);
        alike(&format!("split {i}"), &all(&split, &[first, second]), &whole);
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
    assert!(splits > 150 && joins > 150 && rounds > 5, "{splits}, {joins} and {rounds}");
}

/// Half a ring keeps its round side where it is when its bar is divided, and when it is joined again.
#[test]
fn half_rings_keep_their_round_side() {
    let mut arm = Template::SerialOfTwo.sketch();
    let own = arm.bars[0].clone();
    let half = |at: f64, turned: bool| {
        let shape = CounterweightShape::HalfRing { radius: 0.04, inner_radius: 0.01 };
        Counterweight { turned, ..Counterweight::new(&own.name, 0.5, [at, 0.01], shape) }
    };
    arm.counterweights = vec![half(0.05, false), half(0.3, true), half(0.35, false), half(-0.05, false)];
    let corners = |sketch: &Sketch| -> Vec<Vec<Vector>> {
        let placed = |weight: &Counterweight| {
            let bar = sketch.bars.iter().find(|bar| bar.name == weight.link).expect("its bar");
            let way = sketch.span(bar) / sketch.length(bar);
            weight.polygon(32).into_iter().map(|corner| sketch.at(bar.root) + way * corner).collect()
        };
        sketch.counterweights.iter().map(placed).collect()
    };
    let same = |sketch: &Sketch| {
        for (was, is) in corners(&arm).iter().zip(&corners(sketch)) {
            // The corners may be listed in another order.
            let near = |p: &Vector| was.iter().any(|q| (p - q).norm() < 1e-9);
            assert!(was.len() == is.len() && is.iter().all(near), "{was:?} {is:?}");
        }
    };
    let split = draw(&arm, [SketchStep::Split { bar: own.id, along: 0.2 }]);
    assert!(split.counterweights.iter().any(|weight| weight.link != own.name), "some lie beyond the cut");
    same(&split);
    let cut_off = split.bars.last().expect("cut off").id;
    same(&draw(&split, [SketchStep::Join { bar: own.id, with: cut_off }]));
    same(&draw(&split, [SketchStep::Join { bar: cut_off, with: own.id }]));
}

/// A part over the cut becomes two; of a flat bar, each has a round end of its own at the cut.
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
        let links: Vec<&str> = split.parts.iter().map(|part| part.link.as_str()).collect();
        assert_eq!(links, ["1", cut.name.as_str(), "2"]);
        assert!(split.parts.iter().all(|part| part.to == PlaceOnLink::default()), "{:?}", split.parts);
        assert!(split.bars[0].body.is_none() && cut.body.is_none(), "both follow from their parts");
        let both = split.body(&split.bars[0]).mass + split.body(&cut).mass;
        let ends = if shape == Shape::Flat { PI * 0.015 * 0.015 * 0.006 * 2700.0 } else { 0.0 };
        assert!((both - whole.mass - ends).abs() < 1e-12 * whole.mass);
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
    assert!(named.parts[0].link == "arm" && named.lumps.iter().all(|lump| lump.link == "arm"));
    let gone = draw(&named, [SketchStep::DeleteBar { bar: BarId(2) }]);
    assert!(gone.parts.iter().all(|part| part.link != "arm") && gone.lumps.is_empty());
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
    assert_eq!(limits([0.1 + 0.2, 1.2]).plainly(), limits([0.3, 1.2]));
}

/// Every bar of a drawing has one drawn part, from its first pin to its last, with a hole for each pin that has room.
#[track_caller]
pub fn reaches_over_its_pins(sketch: &Sketch) {
    for own in &sketch.bars {
        let metres = |place: &PlaceOnLink| metres(sketch, own, place);
        let parts: Vec<&Part> = sketch.parts.iter().filter(|part| part.link == own.name).collect();
        let [part] = parts.as_slice() else { panic!("bar {} of {parts:?}", own.name) };
        let pins: Vec<f64> = own.all_pins().map(|pin| sketch.along(own, pin)).collect();
        let [low, high] = [f64::min, f64::max].map(|of| pins.iter().copied().fold(0.0, of));
        let ends = [metres(&part.from), metres(&part.to)];
        assert!((ends[0] - low).abs() < 1e-9 && (ends[1] - high).abs() < 1e-9, "bar {}: {ends:?}, {pins:?}", own.name);
        for hole in &part.holes {
            assert!(pins.iter().any(|pin| (pin - metres(&hole.at)).abs() < 1e-9), "{part:?} and {pins:?}");
        }
        let is_near = |a: f64, b: f64| (a - b).abs() < 0.008;
        for (i, pin) in pins.iter().enumerate() {
            let is_close = pins.iter().enumerate().any(|(k, other)| k != i && is_near(*pin, *other));
            let has = part.holes.iter().any(|hole| (pin - metres(&hole.at)).abs() < 1e-9);
            assert!(has || is_close, "no hole at {pin} in {part:?}");
        }
        let body = sketch.body(own);
        assert!(own.body.is_none() && body.mass > 0.0);
    }
}

/// Bars that are drawn, cut, joined, moved and shortened at random reach over their pins all the time.
#[test]
fn drawn_bars_follow_their_pins_through_all_steps() {
    let (mut noise, mut done) = (Noise::of(51), [0; 8]);
    for _ in 0..120 {
        let mut sketch = Sketch::blank();
        for _ in 0..14 {
            let pick = |noise: &mut Noise, n: usize| (noise.between(0.0, n as f64) as usize).min(n.saturating_sub(1));
            let any_pin = |noise: &mut Noise| sketch.pins[pick(noise, sketch.pins.len())].id;
            let to = [noise.between(-0.6, 0.6), noise.between(-0.2, 0.8)];
            let kind = if sketch.bars.is_empty() { 0 } else { pick(&mut noise, 8) };
            let own = sketch.bars.get(pick(&mut noise, sketch.bars.len())).map(|bar| (bar.id, sketch.length(bar)));
            let (id, length) = own.unwrap_or((BarId(0), 0.0));
            let step = match kind {
                0 => bar(BarEnd::pin(any_pin(&mut noise)), at(to[0], to[1])),
                1 => bar(BarEnd::on(id, noise.between(-0.3, 1.3) * length), at(to[0], to[1])),
                2 => SketchStep::MovePin { pin: any_pin(&mut noise), to },
                3 => SketchStep::Split { bar: id, along: noise.between(0.1, 0.9) * length },
                4 => SketchStep::Join { bar: id, with: sketch.bars[pick(&mut noise, sketch.bars.len())].id },
                5 => SketchStep::DeletePin { pin: any_pin(&mut noise) },
                6 => SketchStep::Attach { pin: any_pin(&mut noise), bar: id },
                _ => SketchStep::Weld { pin: any_pin(&mut noise), onto: any_pin(&mut noise) },
            };
            let Ok(next) = sketch.with(&step) else { continue };
            done[kind] += 1;
            sketch = next;
            reaches_over_its_pins(&sketch);
        }
    }
    assert!(done.iter().all(|count| *count > 4), "{done:?}");
}

/// What is cut in two and joined again is as it was, as one bar; a hole of its own stays where it is, and so does a tail.
#[test]
fn a_drawn_bar_keeps_its_section_its_own_holes_and_its_tail() {
    let arm = draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0)), motor(0, None, 2)]);
    let split = draw(&arm, [SketchStep::Split { bar: BarId(2), along: 0.1 }]);
    let second = split.bars[1].id;
    let joined = draw(&split, [SketchStep::Join { bar: BarId(2), with: second }]);
    assert_eq!(joined.parts.len(), 1);
    let middle = joined.bars[0].pins[0];
    let again = draw(&joined, [SketchStep::DeletePin { pin: middle }]);
    assert_eq!(again.parts, arm.parts);
    let mut own = arm.parts[0].clone();
    own.width = Some(0.05);
    own.material = "steel".into();
    own.from = PlaceOnLink::Metres(-0.08);
    own.holes.push(Hole { at: PlaceOnLink::Metres(0.12), across: 0.0, diameter: 0.008 });
    let own = draw(&arm, [SketchStep::Parts { bar: BarId(2), parts: vec![own], lumps: vec![] }]);
    let longer = draw(&own, [SketchStep::Length { bar: BarId(2), metres: 0.5 }]);
    assert_eq!(longer.parts, own.parts, "its tip is a word");
    let wider = draw(&longer, [bar(BarEnd::on(BarId(2), 0.2), at(0.2, 0.3))]);
    let part = &wider.parts[0];
    assert_eq!((part.width, part.from.clone(), part.holes.len()), (Some(0.05), PlaceOnLink::Metres(-0.08), 4));
    assert!(part.holes.contains(&Hole { at: PlaceOnLink::Metres(0.12), across: 0.0, diameter: 0.008 }));
}

#[test]
fn lumps_are_put_moved_and_taken_away_and_count_at_once() {
    let arm = draw(&Sketch::blank(), [bar(pin(0), at(0.3, 0.0)), motor(0, None, 2)]);
    let put = |number, lump| SketchStep::Lump { bar: BarId(2), number, lump };
    let mass = |sketch: &Sketch| sketch.body(&sketch.bars[0]).mass;
    let one = draw(&arm, [put(None, Some(lump("1", 0.5, PlaceOnLink::default())))]);
    assert!((mass(&one) - mass(&arm) - 0.5).abs() < 1e-12);
    let two = draw(&one, [put(None, Some(lump("1", 0.2, PlaceOnLink::Metres(0.1))))]);
    let moved = draw(&two, [put(Some(2), Some(lump("1", 0.3, PlaceOnLink::Metres(0.2))))]);
    assert_eq!((moved.lumps[0].mass, moved.lumps[1].mass), (0.5, 0.3));
    assert_eq!(draw(&moved, [put(Some(1), None), put(Some(1), None)]).lumps, []);
    // The place of a lump at a pin is a word or follows it.
    let own = &two.bars[0];
    assert_eq!(two.place_along(own, 0.3), PlaceOnLink::default());
    let longer = draw(&two, [SketchStep::Length { bar: BarId(2), metres: 0.4 }]);
    assert!((longer.lump_at(&longer.bars[0], &longer.lumps[0]).0 - 0.4).abs() < 1e-12);
    for (step, words) in [
        (put(Some(3), None), "has 2 lumps, and no number 3"),
        (put(Some(0), None), "no number 0"),
        (put(None, None), "no lump is named"),
        (put(None, Some(lump("7", 0.1, PlaceOnLink::default()))), "parts of bar 1"),
        (put(None, Some(lump("1", -0.1, PlaceOnLink::default()))), "mass"),
    ] {
        let why = two.with(&step).expect_err("refused").to_string();
        assert!(why.contains(words), "{why}");
    }
    // A typed mass overrules it, until the numbers are freed; the height stays.
    let body = Body { mass: Some(1.0), axial: 0.02, ..Body::default() };
    let typed = draw(&two, [SketchStep::Mass { bar: BarId(2), body: Some(body), per_metre: 1.0 }]);
    assert_eq!(mass(&draw(&typed, [put(None, Some(lump("1", 5.0, PlaceOnLink::default())))])), 1.0);
    let freed = typed.bars[0].body.and_then(|body| body.freed());
    let freed = draw(&typed, [SketchStep::Mass { bar: BarId(2), body: freed, per_metre: 1.0 }]);
    assert_eq!((mass(&freed), freed.bars[0].body.map(|body| body.axial)), (mass(&two), Some(0.02)));
}

/// A drawing whose machine is drawn anew keeps its pose.
#[test]
fn a_drawing_that_follows_its_machine_keeps_its_pose() {
    for template in Template::ALL.into_iter().filter(|template| *template != Template::Blank) {
        let sketch = template.sketch();
        let machine = sketch.machine().expect("a machine");
        let pose = sketch.pose().expect("drives");
        let turned = DriveAngles(PerDrive::from_fn(pose.len(), |k| pose[k] + 0.3 * (k as f64 + 1.0)));
        let drawn = Sketch::of(&machine, Some(&turned));
        let mut spec = machine.spec().clone();
        spec.payload.mass = 0.1;
        let next = drawn.following_machine(&machine, &Machine::new(spec).expect("a payload"));
        for (a, b) in next.pins.iter().zip(&drawn.pins) {
            assert!((next.at(a.id) - drawn.at(b.id)).norm() < 1e-9, "{template:?}");
        }
        // So does one that is read from the file of its machine.
        let text = to_toml(&drawn.machine().expect("a machine"));
        let read = Sketch::of(&parse(&text, "drawn.toml").expect("a machine file"), None);
        for (a, b) in read.bars.iter().zip(&drawn.bars) {
            assert!((read.span(a) - drawn.span(b)).norm() < 1e-9, "{template:?}: {text}");
        }
        let wrong = text.replace("pose = [", "pose = [0.0, ");
        let why = parse(&wrong, "drawn.toml").expect_err("one too many").to_string();
        assert!(why.contains("angles in the pose of the drawing"), "{why}");
    }
}
