//! What bars have beyond their pins: tails, and counterweights as hatched outlines in grey.

use super::Drawing;
use super::lumps::radius;
use crate::scene::mesh::SEGMENTS;
use crate::scene::palette::{Palette, faded, mix};
use crate::scene::{Anchor, Body, Label, Marker, Polyline, Scene, point};
use stillbase_mechanics::machine::Counterweight;
use stillbase_mechanics::planar::{Vector, dot};
use stillbase_mechanics::sketch::{Bar, Sketch};
use stillbase_settings::number::fixed;

/// Width of a tail, px.
const TAIL_PX: f32 = 5.0;
/// Share of the background in a tail.
const DIMMING: f32 = 0.5;
/// Number of gaps between the hatches of a counterweight.
const GAPS: u32 = 9;
/// Corners that stand for a counterweight when the view is framed.
const CORNERS: usize = 8;
/// Least tail that is drawn, m.
const LEAST_M: f64 = 1e-6;

/// Returns the points beside its pins that the view of a drawing has to show, m.
pub(super) fn corners(sketch: &Sketch) -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for (bar, body) in sketch.bars.iter().zip(sketch.bodies()) {
        let [_, ends] = sketch.reach_of(bar, &body);
        let weights = sketch.weights_of(bar).flat_map(|weight| weight.polygon(CORNERS));
        let places = ends.map(|along| Vector::new(along, 0.0)).into_iter().chain(weights);
        all.extend(places.map(|place| sketch.on_bar(bar, place)).map(|at| [at.re, at.im, 0.0]));
    }
    all
}

/// Draws tails and counterweights, below the bars.
pub(super) fn draw(scene: &mut Scene, drawing: &Drawing<'_>) {
    let Drawing { sketch, palette, .. } = *drawing;
    for (bar, body) in sketch.bars.iter().zip(sketch.bodies()) {
        let [pins, mass] = sketch.reach_of(bar, &body);
        let on = |along: f64, across: f64| point(sketch.on_bar(bar, Vector::new(along, across)), 0.0);
        let tone = mix(drawing.tone(bar), palette.background, DIMMING);
        for (pin, end) in pins.into_iter().zip(mass) {
            if (pin - end).abs() > LEAST_M {
                let ends = [on(pin, 0.0), on(end, 0.0)];
                scene.lines.push(Polyline::new("sketch/tails", [ends.to_vec()], TAIL_PX, tone));
                scene.markers.push(Marker::disc("sketch/tails/ends", ends[1], 0.5 * TAIL_PX, tone));
                scene.bodies.push(Body { ends, radius: 0.0, height: 0.0 });
            }
        }
        let mut has_weights = false;
        for weight in sketch.weights_of(bar) {
            has_weights = true;
            counterweight(scene, (sketch, bar), weight, palette);
            if weight.across != 0.0 {
                let arm = vec![on(weight.at, 0.0), on(weight.at, weight.across)];
                scene.lines.push(Polyline::new("sketch/tails", [arm], 0.5 * TAIL_PX, tone));
            }
        }
        // As in the other views, a centre of mass beyond the pins suggests a weight there.
        let is_beyond = body.at < pins[0] - LEAST_M || body.at > pins[1] + LEAST_M;
        if !has_weights && is_beyond {
            let at = on(body.at, body.across);
            scene.markers.push(disc("sketch/tails/masses", at, body.mass, palette));
        }
    }
}

/// Returns a grey disc whose area grows with a mass, kg.
fn disc(name: &'static str, at: [f32; 3], kilograms: f64, palette: &Palette) -> Marker {
    let fill = mix(palette.dim, palette.background, 0.7);
    Marker::disc(name, at, radius(kilograms) as f32, fill).edged(palette.dim, 1.4)
}

/// Draws a counterweight in its size, with its mass beside it; a point as a disc.
fn counterweight(scene: &mut Scene, (sketch, bar): (&Sketch, &Bar), weight: &Counterweight, palette: &Palette) {
    let placed = |p: Vector| sketch.on_bar(bar, p);
    let outlines: Vec<Vec<Vector>> =
        weight.outlines(SEGMENTS).into_iter().map(|p| p.into_iter().map(placed).collect()).collect();
    let at = point(placed(Vector::new(weight.at, weight.across)), 0.0);
    if outlines.is_empty() {
        scene.markers.push(disc("sketch/weights", at, weight.mass, palette));
    } else {
        let closed = |p: &Vec<Vector>| p.iter().chain(p.first()).map(|at| point(*at, 0.0)).collect::<Vec<_>>();
        let edges: Vec<_> = outlines.iter().map(closed).collect();
        scene.lines.push(Polyline::new("sketch/weights/hatches", hatches(&outlines), 1.0, faded(palette.dim, 0.35)));
        scene.lines.push(Polyline::new("sketch/weights", edges, 1.6, palette.dim));
    }
    let words = format!("{} kg", fixed(weight.mass, 3));
    let label = Label::new("sketch/weights/masses", at, [0.0, 0.0], words, palette.dim, 11.0, Anchor::Centre);
    scene.labels.push(label);
}

/// Returns lines at 45° within closed outlines, m.
fn hatches(outlines: &[Vec<Vector>]) -> Vec<Vec<[f32; 3]>> {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (along, aside) = (Vector::new(half, half), Vector::new(-half, half));
    let all = || outlines.iter().flatten().map(|p| dot(*p, aside));
    let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let line = |i: u32| {
        let off = low + (high - low) * f64::from(i) / f64::from(GAPS);
        let edges = outlines.iter().flat_map(|p| p.iter().zip(p.iter().cycle().skip(1)));
        let crossed = |(from, to): (&Vector, &Vector)| {
            let [a, b] = [from, to].map(|p| dot(*p, aside) - off);
            ((a < 0.0) != (b < 0.0)).then(|| dot(*from + (*to - *from) * (a / (a - b)), along))
        };
        let mut crossings: Vec<f64> = edges.filter_map(crossed).collect();
        crossings.sort_by(f64::total_cmp);
        let spot = move |s: f64| point(along * s + aside * off, 0.0);
        crossings.chunks_exact(2).map(|pair| vec![spot(pair[0]), spot(pair[1])]).collect::<Vec<_>>()
    };
    (1..GAPS).flat_map(line).collect()
}
