//! Machines as a person draws them: each template, and bars at random, made of bars, plates and lumps by steps of the
//! drawing.

use stillbase::mechanics::machine::{Hole, Lump, Machine, Part, PlaceOnLink, Shape};
use stillbase::mechanics::sketch::{Bar, BarEnd, Sketch, SketchStep, Template, resolve};

use crate::noise::Noise;

/// The least distance of two holes, m.
const APART: f64 = 0.012;

fn is_so(noise: &mut Noise, share: f64) -> bool {
    noise.between(0.0, 1.0) < share
}

fn drawn(sketch: &Sketch, step: &SketchStep) -> Sketch {
    sketch.with(step).unwrap_or_else(|refusal| panic!("{step:?}: {refusal}"))
}

/// The drawing of each template; on the blank one, three bars are drawn first.
pub fn of_templates() -> Vec<Sketch> {
    let mut noise = Noise::of(11);
    let sketch = |template: Template| match template {
        Template::Blank => tree(&mut noise, 3),
        template => template.sketch(),
    };
    Template::ALL.into_iter().map(sketch).collect()
}

/// Bars at random, each with a motor where it begins: at B, at the tip of another, or on another.
pub fn tree(noise: &mut Noise, bars: usize) -> Sketch {
    let mut sketch = Sketch { name: format!("{bars} bars at random"), ..Sketch::blank() };
    for n in 0..bars {
        let on: Option<Bar> = (n > 0).then(|| sketch.bars[(noise.between(0.0, n as f64) as usize).min(n - 1)].clone());
        let (from, start) = match &on {
            None => (BarEnd::pin(sketch.base), sketch.at(sketch.base)),
            Some(bar) if is_so(noise, 0.6) => (BarEnd::pin(bar.tip), sketch.at(bar.tip)),
            Some(bar) => {
                // Two bars on one never begin in neighbouring holes.
                let share = 0.3 + 0.4 * (n as f64 / bars as f64);
                let (root, tip) = (sketch.at(bar.root), sketch.at(bar.tip));
                let start = root + (tip - root) * share;
                (BarEnd::on(bar.id, (start - root).norm()), start)
            }
        };
        let (length, angle) = (noise.between(0.2, 0.5), noise.between(-3.1, 3.1));
        let to = BarEnd::At([start.re + length * angle.cos(), start.im + length * angle.sin()]);
        sketch = drawn(&sketch, &SketchStep::Bar { from, to, name: None });
        let own = sketch.bars.last().expect("a bar").clone();
        let (stator, turns) = (on.map(|bar| bar.id), Some(own.id));
        sketch = drawn(&sketch, &SketchStep::Motor { pin: own.root, stator, drive: None, rotor: None, turns });
        sketch = drawn(&sketch, &SketchStep::EndEffector { pin: own.tip, bar: None });
    }
    sketch
}

/// The machine of a drawing.
pub fn machine(sketch: &Sketch) -> Machine {
    let found = resolve(sketch);
    let missing: Vec<&str> = found.missing.iter().map(|one| one.text.as_str()).collect();
    found.machine.unwrap_or_else(|| panic!("{}: {missing:?}", sketch.name))
}

/// The drawing with bars of flat stock over all their pins, plates beside them and lumps on them, from which all numbers
/// follow.
pub fn made(sketch: &Sketch, noise: &mut Noise) -> Sketch {
    let bare = machine(sketch);
    let mut made = sketch.clone();
    for bar in &sketch.bars {
        let j = bare.links().iter().position(|link| link.name == bar.name).expect("a link for each bar");
        let pins = bare.pin_places(j);
        assert!(pins.windows(2).all(|two| two[1] - two[0] > APART), "{}: {pins:?}", sketch.name);
        let [from, to] = bare.least_extent(j).map(PlaceOnLink::Metres);
        let hole = |at: f64| Hole { at: PlaceOnLink::Metres(at), across: 0.0, diameter: 0.008 };
        let thickness = noise.between(0.003, 0.01);
        let mut parts = vec![Part {
            from,
            to,
            width: Some(noise.between(0.02, 0.05)),
            material: ["aluminium", "steel"][usize::from(is_so(noise, 0.3))].into(),
            holes: pins.into_iter().map(hole).collect(),
            ..Part::flat(&bar.name, thickness)
        }];
        if is_so(noise, 0.5) {
            let (left, wide, high) = (noise.between(-0.1, 0.1), noise.between(0.05, 0.1), noise.between(0.03, 0.12));
            let hole = Hole { at: PlaceOnLink::Metres(left + 0.4 * wide), across: 0.0, diameter: 0.005 };
            parts.push(Part {
                shape: Shape::Plate,
                name: "plate".into(),
                across: noise.between(-0.02, 0.02),
                polygon: vec![[left, -0.02], [left + wide, -0.01], [left + 0.5 * wide, 0.5 * high], [left, high]],
                holes: if is_so(noise, 0.5) { vec![hole] } else { Vec::new() },
                ..Part::flat(&bar.name, thickness)
            });
        }
        let lumps = (0..noise.between(0.0, 2.5) as usize).map(|n| Lump {
            link: bar.name.clone(),
            name: format!("motor {} of {}", n + 1, bar.name),
            mass: noise.between(0.05, 0.6),
            at: PlaceOnLink::Metres(noise.between(-0.1, 0.3)),
            across: if is_so(noise, 0.5) { noise.between(-0.05, 0.05) } else { 0.0 },
            inertia: if is_so(noise, 0.5) { noise.between(1e-5, 1e-3) } else { 0.0 },
        });
        let lumps = lumps.collect();
        made = drawn(&made, &SketchStep::Parts { bar: bar.id, parts, lumps });
        made = drawn(&made, &SketchStep::Mass { bar: bar.id, body: None, per_metre: 1.0 });
    }
    made
}
