//! A scene seen from straight above, as a figure of outlines.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::charts::figure::{Axes, Figure, FigureItem, FigureText};
use crate::paint::install_fonts;
use crate::paint::labels::{self, Placement};
use crate::scene::camera::Camera;
use crate::scene::palette::{faded, mix};
use crate::scene::{Polyline, Rgba, Scene, Solid, place};

/// Width of the edge of a solid, points, and how much darker or lighter than its face it is.
const EDGE_WIDTH: f32 = 0.6;
const EDGE_SHARE: f32 = 0.35;
/// Opacity of the plate behind a label.
const PLATE_OPACITY: f32 = 0.75;

/// Returns a figure of a scene for a flat camera; `size` is its width and height, points. Faces have their colour
/// without shading, and areas are filled up to their boundary.
pub fn scene_figure(scene: &Arc<Scene>, camera: &Camera, size: [f32; 2]) -> Figure {
    let sheet = Sheet { camera, size };
    // What is higher lies over what is lower; of equal heights, in the order of the scene.
    let mut layers: Vec<(f32, Vec<FigureItem>)> = Vec::new();
    let edges = |name: &str| scene.lines.iter().find(|line| line.name.strip_suffix("/boundary") == Some(name));
    for area in &scene.areas {
        if let Some(line) = edges(&area.name) {
            layers.push((area.z, vec![sheet.filled(line, area.colour)]));
        }
    }
    for solid in &scene.solids {
        let Some(mesh) = scene.model.meshes.get(solid.mesh) else { continue };
        let height = |p: &[f32; 3]| place(&solid.world_from_item, *p)[2];
        let top = mesh.positions.iter().map(height).fold(f32::NEG_INFINITY, f32::max);
        let items = match (mesh.shell, edges(&solid.name)) {
            (true, Some(line)) => vec![sheet.filled(line, solid.colour)],
            (true, None) => Vec::new(),
            (false, _) => sheet.solid(solid, &silhouettes(&mesh.positions, &mesh.triangles), scene.background),
        };
        layers.push((top, items));
    }
    for line in &scene.lines {
        let top = line.points().iter().map(|p| p[2]).fold(f32::NEG_INFINITY, f32::max);
        layers.push((if line.on_top { f32::INFINITY } else { top }, sheet.line(line)));
    }
    layers.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut items: Vec<FigureItem> = layers.into_iter().flat_map(|(_, items)| items).collect();
    for marker in &scene.markers {
        let Some(at) = sheet.at(marker.at) else { continue };
        items.extend((marker.fill[3] > 0.0).then_some(FigureItem::Dot {
            at,
            radius: marker.radius,
            colour: marker.fill,
        }));
        if marker.stroke_width > 0.0 {
            let points = ring(at, marker.radius - 0.5 * marker.stroke_width);
            let (width, colour) = (marker.stroke_width, marker.stroke);
            items.push(FigureItem::Line { points, width, colour, dash: None, inside: true });
        }
    }
    if let Some(placed) = placed(scene, camera, size) {
        items.extend(lettering(&placed, scene.background));
    }
    let [width, height] = size;
    let axes = Axes { sides: [0.0, 0.0, width, height], x: [0.0, 1.0], y: [0.0, 1.0] };
    Figure { title: "View from above".into(), size, background: scene.background, axes, items }
}

/// Where points of a scene lie in the figure.
struct Sheet<'a> {
    camera: &'a Camera,
    size: [f32; 2],
}

impl Sheet<'_> {
    fn at(&self, point: [f32; 3]) -> Option<[f32; 2]> {
        let [width, height] = self.size;
        let [x, y] = self.camera.project(point.map(f64::from), f64::from(width / height))?;
        Some([x as f32 * width, y as f32 * height])
    }

    fn strip(&self, line: &Polyline, strip: &[[f32; 3]]) -> Vec<[f32; 2]> {
        strip.iter().filter_map(|p| self.at(place(&line.world_from_item, *p))).collect()
    }

    fn line(&self, line: &Polyline) -> Vec<FigureItem> {
        let Polyline { width, colour, dash, .. } = *line;
        let drawn = |strip: &Vec<[f32; 3]>| {
            let points = self.strip(line, strip);
            (points.len() > 1).then_some(FigureItem::Line { points, width, colour, dash, inside: true })
        };
        line.strips.iter().filter_map(drawn).collect()
    }

    /// Returns the area inside a line.
    fn filled(&self, line: &Polyline, colour: Rgba) -> FigureItem {
        FigureItem::Area {
            loops: line.strips.iter().map(|strip| self.strip(line, strip)).collect(),
            colour,
            inside: true,
        }
    }

    fn solid(&self, solid: &Solid, silhouettes: &[Vec<Vec<[f32; 3]>>], background: Rgba) -> Vec<FigureItem> {
        let placed = |line: &Vec<[f32; 3]>| -> Vec<[f32; 2]> {
            line.iter().filter_map(|p| self.at(place(&solid.world_from_item, *p))).collect()
        };
        let light = background[..3].iter().sum::<f32>() > 1.5;
        let other = if light { [0.0, 0.0, 0.0, 1.0] } else { [1.0; 4] };
        let colour = mix(solid.colour, [other[0], other[1], other[2], solid.colour[3]], EDGE_SHARE);
        silhouettes
            .iter()
            .flat_map(|loops| {
                let loops: Vec<Vec<[f32; 2]>> = loops.iter().map(placed).collect();
                let edge = |points: &Vec<[f32; 2]>| {
                    let points = points.iter().chain(points.first()).copied().collect();
                    FigureItem::Line { points, width: EDGE_WIDTH, colour, dash: None, inside: true }
                };
                let edges: Vec<FigureItem> = loops.iter().map(edge).collect();
                [FigureItem::Area { loops, colour: solid.colour, inside: true }].into_iter().chain(edges)
            })
            .collect()
    }
}

type Vertex = [u32; 3];

/// Returns the outlines of what faces upwards in a mesh, for each connected part: its outer line, and its holes.
fn silhouettes(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<Vec<Vec<[f32; 3]>>> {
    // Vertices with several normals are one here.
    let key = |i: u32| positions.get(i as usize).map(|p| p.map(|x| (x + 0.0).to_bits()));
    let mut edges: BTreeSet<(Vertex, Vertex)> = BTreeSet::new();
    let mut parts: BTreeMap<Vertex, Vertex> = BTreeMap::new();
    for corners in triangles {
        let [Some(a), Some(b), Some(c)] = corners.map(key) else { continue };
        let [p, q, r] = [a, b, c].map(point);
        if (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) <= 0.0 {
            continue;
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            // An edge between two such triangles lies inside.
            if !edges.remove(&(to, from)) {
                edges.insert((from, to));
            }
            let (one, other) = (root(&parts, from), root(&parts, to));
            parts.insert(one, other);
        }
    }
    let mut found: BTreeMap<Vertex, Vec<Vec<[f32; 3]>>> = BTreeMap::new();
    while let Some((start, mut at)) = edges.pop_first() {
        let mut line = vec![point(start)];
        while at != start {
            line.push(point(at));
            let next = edges.range((at, [0; 3])..).next().copied().filter(|(from, _)| *from == at);
            let Some(edge) = next else { break };
            edges.remove(&edge);
            at = edge.1;
        }
        if line.len() > 2 {
            found.entry(root(&parts, start)).or_default().push(line);
        }
    }
    found.into_values().collect()
}

fn point(key: Vertex) -> [f32; 3] {
    key.map(f32::from_bits)
}

/// Returns the vertex that stands for the part to which one belongs.
fn root(parts: &BTreeMap<Vertex, Vertex>, mut of: Vertex) -> Vertex {
    while let Some(next) = parts.get(&of).filter(|next| **next != of) {
        of = *next;
    }
    of
}

/// Number of corners of a ring.
const RING_CORNERS: u8 = 48;

fn ring([x, y]: [f32; 2], radius: f32) -> Vec<[f32; 2]> {
    let corner = |i: u8| {
        let angle = std::f32::consts::TAU * f32::from(i % RING_CORNERS) / f32::from(RING_CORNERS);
        [x + radius * angle.cos(), y + radius * angle.sin()]
    };
    (0..=RING_CORNERS).map(corner).collect()
}

/// Places the labels as a picture of this size has them.
fn placed(scene: &Arc<Scene>, camera: &Camera, [width, height]: [f32; 2]) -> Option<Arc<Placement>> {
    let ctx = egui::Context::default();
    install_fonts(&ctx);
    let size = egui::vec2(width, height);
    let input =
        egui::RawInput { screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size)), ..Default::default() };
    // The first pass loads the fonts.
    for _ in 0..2 {
        labels::forget(&ctx, 0);
        let _ = ctx.run_ui(input.clone(), |ui| labels::paint_still(ui, scene, camera, None));
    }
    labels::last(&ctx, 0)
}

/// Returns the labels at their places, with the lines that lead to them.
fn lettering(placed: &Placement, background: Rgba) -> Vec<FigureItem> {
    let mut items = Vec::new();
    for (i, ends) in placed.leads() {
        let points = ends.map(|p| [p.x, p.y]).to_vec();
        let colour = faded(placed.all[*i].label.colour, 0.6);
        items.push(FigureItem::Line { points, width: 1.0, colour, dash: None, inside: true });
    }
    for own in &placed.all {
        let sides = [own.place.left() - 2.0, own.place.top(), own.place.right() + 2.0, own.place.bottom()];
        if background[3] > 0.0 {
            items.push(FigureItem::Rectangle { sides, colour: faded(background, PLATE_OPACITY) });
        }
        let words = FigureText { text: own.text.clone(), size: own.label.size, bold: false, colour: own.label.colour };
        let at = [own.place.left(), own.place.top()];
        items.push(FigureItem::Text { at, anchor: [0.0, 0.0], words: vec![words] });
    }
    items
}
