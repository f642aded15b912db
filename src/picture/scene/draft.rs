//! The design view of a machine: links with draggable centres of mass and ends, and counterweights with their masses.

use super::grid::Grid;
use super::linkage::LinkageModel;
use super::options::{Handle, ViewOptions, WeightOption};
use super::palette::{Palette, faded, mix, palette};
use super::pick::{DragAction, PICK_RADIUS, Pick};
use super::pointer::Pointer;
use super::sketching::lump_marker;
use super::{Anchor, Label, Marker, Polyline, Scene, point};
use stillbase_mechanics::machine::{Length, Machine, PartSource};
use stillbase_mechanics::planar::{UnitVectors, Vector};
use stillbase_simulation::frame::Frame;

/// Half the size of the cross at a centre of mass, as a fraction of the reach.
const CROSS_HALF_SIZE: f64 = 0.0105;
/// Fraction of the background colour in links that are neither under the pointer nor in [`ViewOptions::links`].
const DIMMING: f32 = 0.42;
/// Distance within which the pointer picks the end of a link, px.
const END_PICK_PX: f64 = 11.0;
/// Distance of the label of the length from the end of a link, px.
const LENGTH_LABEL_PX: f32 = 14.0;

/// The parts of the design view that do not change from frame to frame.
#[derive(Clone, Debug)]
pub struct DesignDrawing {
    /// All links, in the order of the machine.
    links: Vec<Link>,
    weights: Vec<Weight>,
    lumps: Vec<Weight>,
}

#[derive(Clone, Debug)]
struct Link {
    /// Centre of mass, along and across the link, m.
    com: Vector,
    /// Length, m.
    length: f64,
    /// Name of its length, if that is a named length that several links may share.
    shared: Option<String>,
}

/// A counterweight or a lump.
#[derive(Clone, Debug)]
struct Weight {
    /// Index of its link, from 0.
    link: usize,
    /// Position along the link, and to the left of its axis, m.
    at: Vector,
    /// Mass, kg.
    mass: f64,
}

impl DesignDrawing {
    /// Prepares a machine for drawing.
    pub fn of(machine: &Machine) -> Self {
        let spec = machine.spec();
        let links = spec.links.iter().zip(machine.resolved_links()).map(|(link, part)| Link {
            com: Vector::new(link.com, link.com_normal),
            length: part.length,
            shared: match &link.length {
                Length::Named(name) => Some(name.clone()),
                Length::Metres(_) => None,
            },
        });
        let weights = spec.counterweights.iter().filter_map(|weight| {
            let link = spec.link_index(&weight.link)?;
            Some(Weight { link, at: Vector::new(weight.at, weight.across), mass: weight.mass })
        });
        let lumps = machine.part_bodies().iter().filter_map(|part| match part.source {
            PartSource::Lump(_) => {
                let at = Vector::new(part.body.at, part.body.across);
                Some(Weight { link: part.link, at, mass: part.body.mass })
            }
            PartSource::Part(_) => None,
        });
        Self { links: links.collect(), weights: weights.collect(), lumps: lumps.collect() }
    }

    /// Returns the scene of the design view.
    pub fn scene(&self, (linkage, grid): (&LinkageModel, &Grid), frame: &Frame, options: &ViewOptions) -> Scene {
        let palette = palette(options.theme);
        let mut scene = Scene::new(palette.background, linkage.model.clone());
        grid.draw(&mut scene, &palette);
        self.draw(&mut scene, linkage, frame, options);
        scene
    }

    /// Draws everything except the grid.
    fn draw(&self, scene: &mut Scene, linkage: &LinkageModel, frame: &Frame, options: &ViewOptions) {
        let palette = palette(options.theme);
        let e = frame.q.units();
        let hot = options.highlighted.and_then(|handle| self.link_of(handle));
        let is_lit = |i: usize| hot == Some(i) || options.links.contains(&i);
        let mut solids = linkage.solids(&e, frame.base, false, &palette);
        for (i, bar) in linkage.bars().iter().enumerate() {
            for solid in solids.iter_mut().filter(|solid| solid.name == *bar.item() && !is_lit(i)) {
                solid.colour = mix(solid.colour, palette.background, DIMMING);
            }
        }
        scene.solids.extend(solids);
        scene.lines.extend(linkage.threads(&e, frame.base.at, &palette));
        for handle in self.handles() {
            let Some(at) = self.place(handle, linkage, frame) else { continue };
            let arm = (CROSS_HALF_SIZE * linkage.reach()) as f32;
            draw_handle(scene, &palette, handle, self.kilograms(handle), at, arm, options.highlighted == Some(handle));
        }
        // Labels leave the pins free.
        scene.bodies.extend(linkage.pin_discs(&e, frame.base.at));
        self.draw_choice(scene, linkage, &palette, frame, &options.weights);
        if let Some(i) = hot {
            self.draw_length(scene, linkage, &palette, i, &e, frame);
        }
    }

    /// Mass of a counterweight or a lump, kg; 0 for other handles.
    fn kilograms(&self, handle: Handle) -> f64 {
        match handle {
            Handle::Lump(i) => self.lumps.get(i).map_or(0.0, |lump| lump.mass),
            Handle::Weight(i) => self.weights.get(i).map_or(0.0, |weight| weight.mass),
            _ => 0.0,
        }
    }

    /// Draws the counterweights to choose from, as outlines.
    fn draw_choice(
        &self,
        scene: &mut Scene,
        linkage: &LinkageModel,
        palette: &Palette,
        frame: &Frame,
        weights: &[WeightOption],
    ) {
        let e = frame.q.units();
        let outline = |WeightOption { link, outline }: &WeightOption| {
            let (root, along, _) = linkage.bars().get(*link)?.pose(&e);
            let placed = |p: &Vector| point(frame.base.at + root + along * *p, linkage.top());
            Some(outline.iter().chain(outline.first()).map(placed).collect::<Vec<_>>())
        };
        let circles: Vec<_> = weights.iter().filter_map(outline).collect();
        if !circles.is_empty() {
            scene.lines.push(Polyline::new("design/choice", circles, 2.2, palette.amber).on_top());
        }
    }

    /// Draws a line along a link, and the text of its length beyond its end.
    fn draw_length(
        &self,
        scene: &mut Scene,
        linkage: &LinkageModel,
        palette: &Palette,
        i: usize,
        e: &UnitVectors,
        frame: &Frame,
    ) {
        let link = &self.links[i];
        let (root, along, _) = linkage.bars()[i].pose(e);
        let z = linkage.top();
        let [from, to] = [root, root + along * link.length].map(|p| point(frame.base.at + p, z));
        scene.lines.push(Polyline::new("design/length", [vec![from, to]], 1.2, palette.ink).dashed(2.0, 3.0).on_top());
        let name = link.shared.as_deref().map_or(String::new(), |name| format!("{name} "));
        let text = format!("{name}{:.3} m", link.length);
        let way = [along.re as f32, -along.im as f32].map(|x| x * LENGTH_LABEL_PX);
        let anchor = if way[0] >= 0.0 { Anchor::Left } else { Anchor::Right };
        scene.labels.push(Label::new("design/length/m", to, way, text, palette.ink, 12.0, anchor));
    }

    /// Returns the index of the link that a handle belongs to.
    pub fn link_of(&self, handle: Handle) -> Option<usize> {
        match handle {
            Handle::Link(i) | Handle::Mass(i) | Handle::End(i) => (i < self.links.len()).then_some(i),
            Handle::Weight(i) => self.weights.get(i).map(|weight| weight.link),
            Handle::Lump(i) => self.lumps.get(i).map(|lump| lump.link),
            _ => None,
        }
    }

    fn handles(&self) -> impl Iterator<Item = Handle> + use<> {
        let (links, weights, lumps) = (self.links.len(), self.weights.len(), self.lumps.len());
        let ends = (0..links).map(Handle::End).chain((0..lumps).map(Handle::Lump));
        ends.chain((0..links).map(Handle::Mass)).chain((0..weights).map(Handle::Weight))
    }

    /// Returns the position of a handle in the scene, m.
    fn place(&self, handle: Handle, linkage: &LinkageModel, frame: &Frame) -> Option<[f64; 3]> {
        let on = match handle {
            Handle::Mass(i) => self.links.get(i)?.com,
            Handle::End(i) => Vector::new(self.links.get(i)?.length, 0.0),
            Handle::Weight(i) => self.weights.get(i)?.at,
            Handle::Lump(i) => self.lumps.get(i)?.at,
            _ => return None,
        };
        let (root, along, _) = linkage.bars().get(self.link_of(handle)?)?.pose(&frame.q.units());
        let at = frame.base.at + root + along * on;
        Some([at.re, at.im, linkage.top()])
    }

    /// Returns the handle under the pointer: the nearest centre of mass or counterweight, otherwise the nearest end of
    /// a link.
    pub fn pick(&self, linkage: &LinkageModel, frame: &Frame, pointer: &Pointer) -> Option<Pick> {
        let near = |handle: Handle| {
            let at = self.place(handle, linkage, frame)?;
            let most = if matches!(handle, Handle::End(_)) { END_PICK_PX } else { 0.6 * PICK_RADIUS };
            // Handles that coincide with an end take precedence over it.
            let behind = if matches!(handle, Handle::End(_)) { PICK_RADIUS } else { 0.0 };
            pointer.distance(at).filter(|d| *d < most).map(|d| (Pick::of(handle, at), d + behind))
        };
        self.handles().filter_map(near).min_by(|s, t| s.1.total_cmp(&t.1)).map(|(pick, _)| pick)
    }

    /// Returns the change that dragging a handle to the pointer requests. Only counterweights and lumps may leave the axis
    /// of their link.
    pub fn aim(&self, pick: &Pick, linkage: &LinkageModel, frame: &Frame, pointer: &Pointer) -> Option<DragAction> {
        let link = self.link_of(pick.handle)?;
        let [x, y] = pointer.ray()?.at_height(linkage.top())?;
        let (root, along, _) = linkage.bars().get(link)?.pose(&frame.q.units());
        let place = (Vector::new(x, y) - frame.base.at - root) * along.conj();
        let to = place.re;
        match pick.handle {
            Handle::Mass(_) => Some(DragAction::Mass { link, to }),
            Handle::Weight(weight) => Some(DragAction::Weight { weight, to: [place.re, place.im] }),
            Handle::Lump(lump) => Some(DragAction::Lump { lump, to: [place.re, place.im] }),
            Handle::End(_) => Some(DragAction::Length { link, to: to.max(MIN_LENGTH_M) }),
            _ => None,
        }
    }
}

/// Minimum length to which a link can be dragged, m.
const MIN_LENGTH_M: f64 = 1e-3;

fn draw_handle(
    scene: &mut Scene,
    palette: &Palette,
    handle: Handle,
    kilograms: f64,
    at: [f64; 3],
    arm: f32,
    hot: bool,
) {
    let at = at.map(|x| x as f32);
    let edge = if hot { palette.amber } else { palette.ink };
    match handle {
        Handle::Mass(_) => {
            // A cross in a ring, the usual symbol of a centre of mass.
            let (size, arm) = if hot { (9.0, 1.4 * arm) } else { (7.0, arm) };
            let ring = Marker::disc("design/masses", at, size, faded(edge, 0.0)).edged(edge, 1.8);
            scene.markers.push(ring);
            let [x, y, z] = at;
            let cross = [[[x - arm, y, z], [x + arm, y, z]], [[x, y - arm, z], [x, y + arm, z]]];
            scene.lines.push(Polyline::new("design/masses/crosses", cross.map(Vec::from), 1.4, edge).on_top());
        }
        Handle::Weight(_) => {
            let text = format!("{:.2}", kilograms);
            let size = if hot { 9.0 } else { 4.0 };
            scene.markers.push(Marker::disc("design/weights", at, size, palette.background).edged(edge, 1.6));
            let label = Label::new("design/weights/kg", at, [0.0, -13.0], text, palette.ink, 11.5, Anchor::Centre);
            scene.labels.push(label);
        }
        Handle::Lump(_) => {
            let lump = lump_marker("design/lumps", at, kilograms, palette);
            scene.markers.push(if hot { lump.edged(palette.amber, 2.0) } else { lump });
        }
        Handle::End(_) if hot => {
            scene.markers.push(Marker::disc("design/ends", at, 7.0, palette.background).edged(edge, 2.0));
        }
        _ => {}
    }
}
