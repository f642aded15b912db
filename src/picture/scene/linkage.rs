//! The body of a machine: bars, pins, counterweights and drives, as meshes that do not change while it moves.
//!
//! Links that share a pin follow different drives, so each drive has its own layer and links do not intersect. A machine
//! with heights shows its links at these.

mod bodies;
mod heights;

use std::sync::Arc;

use heights::Heights;

use super::mesh::{SEGMENTS, bar, cylinder, ribbon, ring};
use super::palette::{Palette, faded, mix};
use super::{ItemChanges, Mesh, MeshSet, Name, Rgba, Shadow, Solid, posed};
use stillbase_mechanics::machine::{Chain, Counterweight, Cylinder, Machine, PartSource, ResolvedLink, place_of};
use stillbase_mechanics::planar::{Pose2, UnitVectors, Vector, unit};

/// The meshes of a machine, and their placement in a pose.
#[derive(Clone, Debug)]
pub struct LinkageModel {
    /// Meshes that the solids refer to.
    pub model: Arc<MeshSet>,
    bars: Vec<Bar>,
    pins: Vec<Pin>,
    /// Mesh of all pins; each is stretched to the length between its layers.
    pin: usize,
    /// Mesh of all spacers; each is stretched to the gap between two links.
    spacer: usize,
    hole: usize,
    motors: Vec<Motor>,
    plate: Disc,
    /// Plate of a moving base.
    body: Slab,
    cap: Disc,
    reach: f64,
}

/// A link with its counterweight.
#[derive(Clone, Debug)]
pub struct Bar {
    /// Name of the link.
    pub name: String,
    item: Name,
    /// Index of the mesh, which extends along x over the drawn interval; the root of the link is at x = 0.
    pub mesh: usize,
    /// Index of the drive that it follows, from 0.
    pub drive: usize,
    /// Whether it lies on the chain from the base to the end effector.
    pub carries_tip: bool,
    root: Chain,
    sign: f64,
    /// Length from root to tip, m.
    length: f64,
    /// Interval along the link in which it is drawn, m.
    span: [f64; 2],
    /// Half its width, m.
    radius: f64,
    /// Its height from its lower to its upper face, m.
    height: f64,
    weights: Vec<Weight>,
    z: f64,
}

/// A counterweight of a link, in the mesh of the link.
#[derive(Clone, Debug)]
struct Weight {
    /// Position of its centre of mass along the link, and to the left of its axis, m.
    at: Vector,
    /// Ends of a segment about which it lies, m; equal for a round one.
    ends: [Vector; 2],
    /// Distance from the segment within which it lies, m: the radius of a round one.
    radius: f64,
    /// Pairs of opposite points of its long sides, m; empty for a round one.
    rails: Vec<[Vector; 2]>,
    /// Radius of its bore, m.
    inner_radius: f64,
    /// Height of its lower face above that of the link, m; negative, because it is thicker.
    z: f64,
    /// Height from its lower to its upper face, m.
    height: f64,
}

/// A mesh around a vertical axis.
#[derive(Clone, Copy, Debug)]
struct Disc {
    mesh: usize,
    /// Radius, m.
    radius: f64,
    /// Height, m.
    height: f64,
}

impl Disc {
    fn of(meshes: &mut Vec<Mesh>, radius: f64, height: f64, bevel: f64) -> Self {
        Self { mesh: added(meshes, cylinder(radius, height, bevel)), radius, height }
    }
}

/// A plate with round ends.
#[derive(Clone, Copy, Debug)]
struct Slab {
    mesh: usize,
    /// Distance of the centres of its ends from its own, m.
    half_length: f64,
    /// Half its width, m.
    radius: f64,
    /// Height, m.
    height: f64,
}

/// A link seen from straight above.
pub struct FlatLink {
    /// Its drawn ends, m.
    pub ends: [Vector; 2],
    /// Half its width, m.
    pub radius: f64,
    /// Its counterweights.
    pub weights: Vec<FlatWeight>,
    /// Index of the drive that it follows, from 0.
    pub drive: usize,
}

/// A counterweight seen from straight above.
pub struct FlatWeight {
    /// Ends of a segment about which it lies, m; equal for a round one.
    pub ends: [Vector; 2],
    /// Distance from the segment within which it lies, m: the radius of a round one.
    pub radius: f64,
    /// Pairs of opposite points of its long sides, m; empty for a round one.
    pub rails: Vec<[Vector; 2]>,
}

#[derive(Clone, Debug)]
struct Pin {
    at: Chain,
    /// Indices of the links that it connects.
    links: Vec<usize>,
    /// Heights of its lower and upper end, m.
    z: [f64; 2],
    /// Ratio of its length to that of the mesh.
    stretch: f64,
    /// Heights of the lower end of each spacer around it, m, and the ratio of its length to that of the mesh.
    spacers: Vec<[f64; 2]>,
}

#[derive(Clone, Debug)]
struct Motor {
    name: Name,
    disc: Disc,
    drive: usize,
    /// The pin about which it turns its link; `None` if it is mounted on the base.
    at: Option<Chain>,
    z: f64,
}

/// Half length and half width of the plate of a moving base, as fractions of the reach.
pub const PLATE_HALF_SIZE: [f64; 2] = [0.2, 0.105];

/// Dimensions as fractions of the reach of the machine.
const BAR_RADIUS: f64 = 0.0135;
const THIN_BAR_RADIUS: f64 = 0.0085;
const WEIGHT_RADIUS: f64 = 0.05;
const DRIVE_RADIUS: f64 = 0.042;

/// Density with which a lump is drawn, kg/m³: that of steel.
const LUMP_DENSITY: f64 = 7850.0;

/// Horizontal shift of a shadow per height of the bar above the floor, and opacity of the shadow of a bar on the floor.
const SHADOW_SHIFT: Vector = Vector::new(0.45, -0.6);
const SHADOW_OPACITY: f64 = 0.5;

impl LinkageModel {
    /// Builds the body of a machine.
    pub fn of(machine: &Machine) -> Self {
        let reach = reach_of(machine);
        let heights = Heights::of(machine, reach);
        let Heights { height, gap, .. } = heights;
        let carries = carriers(machine);
        let heaviest = machine.links().iter().fold(0.0_f64, |m, l| m.max(l.mass));
        let mut meshes = Vec::new();
        let mut bars = Vec::new();
        for (j, (link, part)) in machine.links().iter().zip(machine.resolved_links()).enumerate() {
            let radius = reach * if carries[j] { BAR_RADIUS } else { THIN_BAR_RADIUS };
            let ends = part.pins.iter().copied().chain([part.length]);
            let (from, to) = ends.fold((0.0_f64, 0.0_f64), |(a, b), s| (a.min(s), b.max(s)));
            let weights = machine.spec().counterweights.iter().filter(|weight| weight.link == link.name);
            let disc = |at: Vector, size: f64, thickness: f64| Weight {
                at,
                ends: [at; 2],
                radius: size.max(1.5 * radius),
                rails: Vec::new(),
                inner_radius: 0.0,
                z: 0.5 * (height - thickness),
                height: thickness,
            };
            let usual = 1.6 * height;
            let shaped = |weight: &Counterweight| {
                let (ends, size) = weight.around();
                let at = Vector::new(weight.at, weight.across);
                let of = disc(at, size, heights.thickness(weight).unwrap_or(usual));
                match weight.rails(SEGMENTS) {
                    rails if rails.is_empty() => Weight { inner_radius: weight.inner_radius, ..of },
                    rails => Weight { ends, radius: size, rails, ..of },
                }
            };
            let mut discs: Vec<Weight> = weights.map(shaped).collect();
            if discs.is_empty() && (link.com < from || link.com > to) {
                // If the centre of mass is beyond the ends, a disc there suggests a counterweight; area ∝ mass of the
                // link.
                discs.push(disc(
                    Vector::new(link.com, link.com_normal),
                    reach * WEIGHT_RADIUS * (link.mass / heaviest).sqrt(),
                    usual,
                ));
            }
            // A lump lies on its link.
            for lump in machine.part_bodies().iter().filter(|part| part.link == j) {
                let PartSource::Lump(_) = lump.source else { continue };
                let own = Cylinder::of(lump.body.mass, lump.body.inertia, LUMP_DENSITY);
                let at = Vector::new(lump.body.at, lump.body.across);
                let solid = |own: Cylinder| Weight { radius: own.radius, z: height, ..disc(at, 0.0, own.height) };
                discs.extend(own.map(solid));
            }
            let span = discs.iter().fold([from, to], |[from, to], disc| [from.min(disc.at.re), to.max(disc.at.re)]);
            let mut mesh = bar(span[0], span[1], radius, height, 0.2 * height);
            for disc in &discs {
                let at = [disc.at.re, disc.at.im, disc.z];
                match disc.rails.is_empty() {
                    true if disc.inner_radius > 0.0 => {
                        append(&mut mesh, &ring(disc.radius, disc.inner_radius, disc.height), at);
                    }
                    true => append(&mut mesh, &cylinder(disc.radius, disc.height, 0.2 * height), at),
                    false => {
                        let rails = disc.rails.iter().map(|pair| pair.map(|p| [p.re, p.im]));
                        append(&mut mesh, &ribbon(&rails.collect::<Vec<_>>(), disc.height), [0.0, 0.0, disc.z]);
                    }
                }
                if disc.at.im.abs() > disc.radius {
                    // An arm across joins a disc beside the bar to it.
                    let arm = bar(disc.at.im.min(0.0), disc.at.im.max(0.0), radius, height, 0.2 * height);
                    append(&mut mesh, &quarter_turned(arm), [disc.at.re, 0.0, 0.0]);
                }
            }
            bars.push(Bar {
                name: link.name.clone(),
                item: format!("machine/link/{}", link.name).into(),
                mesh: added(&mut meshes, mesh),
                drive: part.drive,
                carries_tip: carries[j],
                root: part.root,
                sign: part.sign,
                length: part.length,
                span,
                radius,
                height,
                weights: discs,
                z: heights.z[j],
            });
        }
        let mut pins = Vec::new();
        let radius = 0.62 * THIN_BAR_RADIUS * reach;
        let shortest = height + 2.0 * gap;
        let pin = added(&mut meshes, cylinder(1.25 * radius, shortest, 0.15 * radius));
        let spacer = added(&mut meshes, ring(1.9 * radius, 1.25 * radius, shortest));
        let hole = added(&mut meshes, cylinder(0.7 * radius, 0.2 * gap, 0.0));
        for (at, links) in joints(machine) {
            let faces = links.iter().map(|j| heights.z[*j]);
            let (low, high) = faces.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
            let z = [low - gap, high + height + gap];
            let spacers = heights.spacers(&links).map(|[low, high]| [low, (high - low) / shortest]).collect();
            pins.push(Pin { at, links, z, stretch: (z[1] - z[0]) / shortest, spacers });
        }
        let n = machine.drives();
        let (drive_height, drive_radius) = (0.05 * reach, DRIVE_RADIUS * reach);
        let mut on_base = 0;
        let motor = |k: usize| {
            let at = joint_of(machine, k);
            let size = match at {
                Some(_) => 0.75,
                None => 1.0 + 0.12 * f64::from(on_base),
            };
            let below = match at {
                // The motor is below the link that carries it.
                Some(_) => heights.carrier(machine, k) - 0.92 * drive_height,
                None => {
                    on_base += 1;
                    -f64::from(on_base) * drive_height
                }
            };
            let disc = Disc::of(&mut meshes, size * drive_radius, 0.92 * drive_height, 0.1 * drive_height);
            let on = if at.is_some() { "machine" } else { "machine/base" };
            Motor { name: format!("{on}/drive/{}", k + 1).into(), disc, drive: k, at, z: below - gap }
        };
        let motors: Vec<Motor> = (0..n).map(motor).collect();
        let (plate_height, plate_bevel) = (0.3 * drive_height, 0.05 * drive_height);
        let plate = Disc::of(&mut meshes, 2.0 * drive_radius, plate_height, plate_bevel);
        let [length, width] = PLATE_HALF_SIZE.map(|part| part * reach);
        let half_length = length - width;
        let mesh = added(&mut meshes, bar(-half_length, half_length, width, plate_height, plate_bevel));
        let body = Slab { mesh, half_length, radius: width, height: plate_height };
        let top = heights.top;
        let cap = Disc::of(&mut meshes, 0.6 * drive_radius, top + 2.0 * gap, 0.2 * gap);
        Self { model: Arc::new(MeshSet { meshes }), bars, pins, pin, spacer, hole, motors, plate, body, cap, reach }
    }

    /// Upper bound of the end effector's distance from B, m.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Height of the plane just below the lowest links, m.
    pub fn floor(&self) -> f64 {
        -heights::GAP * self.reach
    }

    /// Height above every link, m.
    pub fn top(&self) -> f64 {
        self.cap.height
    }

    /// Height of the plate under the drives, m; negative, because it lies below the links.
    pub fn bottom(&self) -> f64 {
        let on_base = self.motors.iter().filter(|motor| motor.at.is_none());
        on_base.fold(0.0_f64, |m, motor| m.min(motor.z)) - self.plate.height
    }

    /// Radius of the plate under the drives, m.
    pub fn foot(&self) -> f64 {
        self.plate.radius
    }

    /// Adds a mesh and returns its index.
    pub fn add(&mut self, mesh: Mesh) -> usize {
        added(&mut Arc::make_mut(&mut self.model).meshes, mesh)
    }

    /// The links.
    pub fn bars(&self) -> &[Bar] {
        &self.bars
    }

    /// Returns the position of each pin for a fixed base, m, and the links that it connects.
    pub fn joints(&self, e: &UnitVectors) -> impl Iterator<Item = ([f64; 3], &[usize])> {
        let e = *e;
        self.pins.iter().map(move |pin| {
            let at = place_of(&pin.at, &e);
            ([at.re, at.im, pin.z[1]], pin.links.as_slice())
        })
    }

    /// Returns the indices of the links that each pin joins, in the order of [`joints`](Self::joints).
    pub fn pins(&self) -> impl Iterator<Item = &[usize]> {
        self.pins.iter().map(|pin| pin.links.as_slice())
    }

    /// Returns the links seen from above for a fixed base, the lowest first.
    pub fn flat(&self, e: &UnitVectors) -> Vec<FlatLink> {
        let mut bars: Vec<&Bar> = self.bars.iter().collect();
        bars.sort_by(|a, b| a.z.total_cmp(&b.z));
        let flat = |bar: &Bar| {
            let (root, along, _) = bar.pose(e);
            FlatLink {
                ends: bar.span.map(|s| root + along * s),
                radius: bar.radius,
                weights: bar.weights.iter().map(|weight| weight.flat(root, along)).collect(),
                drive: bar.drive,
            }
        };
        bars.into_iter().map(flat).collect()
    }

    /// Returns all solids of the machine on a base in the given pose; `moves` says whether the base can move.
    pub fn solids(&self, e: &UnitVectors, base: Pose2, moves: bool, palette: &Palette) -> Vec<Solid> {
        let mut solids = Vec::with_capacity(self.bars.len() + 3 * self.pins.len() + self.motors.len() + 2);
        let upright = |name: Name, mesh, at: Vector, z, colour, changes| {
            let world_from_item = posed(base.at + at, Vector::new(1.0, 0.0), z);
            Solid { name, mesh, world_from_item, colour, changes }
        };
        let grey = mix(palette.dim, palette.line, 0.65);
        let under = self.bottom();
        let with_base = if moves { ItemChanges::Pose } else { ItemChanges::Nothing };
        let turned = |name: Name, mesh, z, colour| Solid {
            name,
            mesh,
            world_from_item: posed(base.at, unit(base.angle), z),
            colour,
            changes: with_base,
        };
        solids.push(turned("machine/base".into(), self.plate.mesh, under, grey));
        if moves {
            let colour = mix(grey, palette.line, 0.5);
            solids.push(turned("machine/base/body".into(), self.body.mesh, under - 0.002 * self.reach, colour));
        }
        for motor in &self.motors {
            let colour = mix(palette.drive(motor.drive), grey, 0.45);
            let name = motor.name.clone();
            solids.push(match &motor.at {
                Some(at) => upright(name, motor.disc.mesh, place_of(at, e), motor.z, colour, ItemChanges::Pose),
                None => turned(name, motor.disc.mesh, motor.z, colour),
            });
        }
        solids.extend(self.bars.iter().map(|bar| bar.solid(e, base.at, palette.drive(bar.drive))));
        for pin in &self.pins {
            let at = place_of(&pin.at, e);
            let mut solid = upright("machine/joints".into(), self.pin, at, pin.z[0], palette.ink, ItemChanges::Pose);
            solid.world_from_item[2][2] = pin.stretch as f32;
            solids.push(solid);
            for [low, stretch] in &pin.spacers {
                let name = "machine/joints/spacers".into();
                let mut solid = upright(name, self.spacer, at, *low, grey, ItemChanges::Pose);
                solid.world_from_item[2][2] = *stretch as f32;
                solids.push(solid);
            }
            let colour = palette.background;
            solids.push(upright("machine/joints/holes".into(), self.hole, at, pin.z[1], colour, ItemChanges::Pose));
        }
        solids.push(turned("machine/base/cap".into(), self.cap.mesh, 0.0, grey));
        solids
    }

    /// Returns the shadows of the links on the floor, in light from the upper left; `base` is the position of the base,
    /// m.
    pub fn shadows(&self, e: &UnitVectors, base: Vector) -> impl Iterator<Item = Shadow> {
        let (e, floor) = (*e, self.floor());
        self.bars.iter().map(move |bar| {
            let (width, height) = (bar.radius, bar.height);
            let ends = bar.ends(&e).map(|[x, y, z]| {
                let away = base + Vector::new(x, y) + SHADOW_SHIFT * (z + 0.5 * height - floor);
                [away.re as f32, away.im as f32]
            });
            // Shadows of higher bars are softer and paler.
            let above = bar.z - floor;
            let soft = width + 0.8 * above;
            Shadow {
                ends,
                z: floor as f32,
                core: (0.5 * width) as f32,
                reach: (width + soft) as f32,
                strength: (SHADOW_OPACITY * width / (width + 0.5 * above)) as f32,
            }
        })
    }

    /// Returns drive and end points, m, for a fixed base, of the links up to the end effector, in the file's order.
    pub fn skeleton(&self, e: &UnitVectors) -> Vec<(usize, [Vector; 2])> {
        let carriers = self.bars.iter().filter(|b| b.carries_tip);
        carriers
            .map(|bar| {
                let (root, along, _) = bar.pose(e);
                (bar.drive, [root, root + along * bar.length])
            })
            .collect()
    }

    /// Returns the links between base and end effector in another pose, as translucent solids named `name/…`.
    pub fn ghost(&self, name: &str, e: &UnitVectors, palette: &Palette, alpha: f32) -> Vec<Solid> {
        let carriers = self.bars.iter().filter(|b| b.carries_tip);
        carriers
            .map(|bar| Solid {
                name: format!("{name}/{}", bar.name).into(),
                changes: ItemChanges::Nothing,
                ..bar.solid(e, Vector::default(), faded(palette.drive(bar.drive), alpha))
            })
            .collect()
    }
}

impl LinkageModel {
    /// Returns the end points, m, of the links between base and end effector, for a fixed base.
    pub fn outlines(&self, e: &UnitVectors) -> impl Iterator<Item = [Vector; 2]> {
        let e = *e;
        self.bars.iter().filter(|b| b.carries_tip).map(move |bar| {
            let (at, along, _) = bar.pose(&e);
            [at, at + along * bar.length]
        })
    }
}

impl Bar {
    /// Name of its item in a scene.
    pub fn item(&self) -> &Name {
        &self.item
    }

    /// 1 if it points in the direction of its drive, −1 if opposite.
    pub fn sign(&self) -> f64 {
        self.sign
    }

    /// Returns its drawn end points for a fixed base, m.
    pub fn ends(&self, e: &UnitVectors) -> [[f64; 3]; 2] {
        let (root, along, z) = self.pose(e);
        self.span.map(|s| {
            let p = root + along * s;
            [p.re, p.im, z]
        })
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Returns the position of its root, m, its direction, a unit vector, and its height, m.
    pub fn pose(&self, e: &UnitVectors) -> (Vector, Vector, f64) {
        (place_of(&self.root, e), e[self.drive] * self.sign, self.z)
    }

    fn solid(&self, e: &UnitVectors, base: Vector, colour: Rgba) -> Solid {
        let (at, along, z) = self.pose(e);
        Solid {
            name: self.item.clone(),
            mesh: self.mesh,
            world_from_item: posed(base + at, along, z),
            colour,
            changes: ItemChanges::Pose,
        }
    }
}

/// Returns for each link whether it lies between base and end effector.
fn carriers(machine: &Machine) -> Vec<bool> {
    let mut carries = vec![false; machine.links().len()];
    let mut at = Some(machine.end_link());
    while let Some(j) = at {
        carries[j] = true;
        at = machine.resolved_links()[j].parent;
    }
    carries
}

/// Returns the pin of motor k, if the motor is mounted on a link of another drive.
fn joint_of(machine: &Machine, k: usize) -> Option<Chain> {
    let (parts, on) = (machine.resolved_links(), machine.motors().on(k)?);
    let on_its_drive = |part: &&ResolvedLink| part.parent.is_some_and(|parent| parts[parent].drive == on);
    parts.iter().filter(|part| part.drive == k).find(on_its_drive).map(|part| part.root)
}

/// Returns the distinct pins away from B: their positions, and the links that they connect.
fn joints(machine: &Machine) -> Vec<(Chain, Vec<usize>)> {
    let mut joints: Vec<(Chain, Vec<usize>)> = Vec::new();
    for (j, part) in machine.resolved_links().iter().enumerate() {
        for &s in &part.pins {
            let at = part.point(s);
            if at.iter().all(|w| *w == 0.0) {
                continue;
            }
            let same = |a: &Chain| a.iter().zip(&at).all(|(a, b)| (a - b).abs() < 1e-9);
            match joints.iter_mut().find(|(a, _)| same(a)) {
                Some((_, links)) => links.push(j),
                None => joints.push((at, vec![j])),
            }
        }
    }
    joints
}

/// Adds a mesh and returns its index.
fn added(meshes: &mut Vec<Mesh>, mesh: Mesh) -> usize {
    meshes.push(mesh);
    meshes.len() - 1
}

fn reach_of(machine: &Machine) -> f64 {
    machine.reach().max(1e-6)
}

/// Turns a mesh by a quarter turn counter-clockwise about z, x to y.
fn quarter_turned(mut mesh: Mesh) -> Mesh {
    for [x, y, _] in mesh.positions.iter_mut().chain(&mut mesh.normals) {
        (*x, *y) = (-*y, *x);
    }
    mesh.coarse = mesh.coarse.map(|coarse| Box::new(quarter_turned(*coarse)));
    mesh
}

impl Weight {
    /// Returns it seen from above, on a link with its root at a point, m, in a direction.
    fn flat(&self, root: Vector, along: Vector) -> FlatWeight {
        let placed = |p: Vector| root + along * p;
        FlatWeight {
            ends: self.ends.map(placed),
            radius: self.radius,
            rails: self.rails.iter().map(|pair| pair.map(placed)).collect(),
        }
    }
}

/// Adds the mesh `other`, shifted by `shift`, m, to the mesh `to`. A coarse mesh of `to` receives that of `other`.
fn append(to: &mut Mesh, other: &Mesh, shift: [f64; 3]) {
    if let Some(coarse) = &mut to.coarse {
        append(coarse, other.coarse.as_deref().unwrap_or(other), shift);
    }
    let first = to.positions.len() as u32;
    to.positions.extend(other.positions.iter().map(|p| [0, 1, 2].map(|i| p[i] + shift[i] as f32)));
    to.normals.extend(&other.normals);
    to.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + first)));
}
