//! [`BlockStages`]: the blocks of an assembly in space, each in its plane, around the one that is led.

use std::sync::Arc;

use nalgebra::{Matrix4, Point3, Vector3};

use super::framing::ViewContent;
use super::mesh::closed;
use super::options::ViewOptions;
use super::palette::{Palette, faded, palette};
use super::platform_reach::PlatformReach;
use super::stage::Stage;
use super::{Anchor, ItemChanges, Label, Mesh, MeshSet, Polyline, Rgba, Scene, Solid, Transform, place};
use stillbase_mechanics::assembly::{BlockState, MAX_BLOCKS, SpatialBase};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_session::Run;
use stillbase_session::assembly::AssemblyBlock;
use stillbase_settings::number::fixed_or_finer;
use stillbase_simulation::frame::{Frame, SharedBase};

/// The stages of the blocks that are not led, and the meshes of all.
#[derive(Clone, Debug)]
pub struct BlockStages {
    block: Arc<AssemblyBlock>,
    /// Place in the assembly, index of its first mesh, and stage of each block that is not led.
    others: Vec<(usize, usize, Stage)>,
    /// Meshes of the block that is led.
    led: Arc<MeshSet>,
    /// Meshes of all blocks, those of the led one first.
    model: Arc<MeshSet>,
    /// Largest reach of a block, m.
    reach: f64,
    /// Where the last platform can be, and index of its mesh.
    platform: Option<(PlatformReach, usize)>,
    /// Mesh of that.
    reached: Mesh,
    /// Body of a base that floats, and its pose in the axes of the base.
    body: Option<(Mesh, Matrix4<f64>)>,
    /// Index of its mesh.
    body_mesh: usize,
}

/// Places of the blocks of an assembly, m.
pub type Mounts = [Vector3<f64>; MAX_BLOCKS];

/// Parts of names of items that are drawn of a block that is not led.
const SHOWN: [&str; 4] = ["machine", "workspace", "plan/path", "payload"];
/// Parts of names of items of the led block that state what it alone does to its base.
const OF_ONE: [&str; 3] = ["reaction", "grid", "com"];
/// Length of the longest arrow of force or moment, as a share of the reach.
const ARROW_SHARE: f64 = 0.5;
/// Length and half width of the head of an arrow, as shares of its length.
const HEAD: [f64; 2] = [0.16, 0.06];
/// The camera is set by one of so many points of where the last platform can be.
const CONTENT_STEP: usize = 16;
/// Opacity of the body of a base that floats.
const BODY_OPACITY: f32 = 0.14;

fn is_part(name: &str, of: &str) -> bool {
    name.strip_prefix(of).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}

fn transform(matrix: &Matrix4<f64>) -> Transform {
    matrix.map(|x| x as f32).into()
}

fn times(a: &Transform, b: &Transform) -> Transform {
    (nalgebra::Matrix4::from(*a) * nalgebra::Matrix4::from(*b)).into()
}

impl Scene {
    /// Returns the scene with everything in it moved. Shadows stay behind: they lie on the plane of the machine.
    #[must_use]
    pub fn moved(mut self, world_from_scene: &Matrix4<f64>) -> Self {
        let by = transform(world_from_scene);
        self.shadows.clear();
        self.solids.iter_mut().for_each(|solid| solid.world_from_item = times(&by, &solid.world_from_item));
        self.lines.iter_mut().for_each(|line| line.world_from_item = times(&by, &line.world_from_item));
        self.areas.iter_mut().for_each(|area| area.world_from_plane = times(&by, &area.world_from_plane));
        self.markers.iter_mut().for_each(|marker| marker.at = place(&by, marker.at));
        self.labels.iter_mut().for_each(|label| label.at = place(&by, label.at));
        self.bodies.iter_mut().flat_map(|body| &mut body.ends).for_each(|end| *end = place(&by, *end));
        self
    }

    fn retain(&mut self, keeps: impl Fn(&str) -> bool) {
        self.solids.retain(|item| keeps(&item.name));
        self.lines.retain(|item| keeps(&item.name));
        self.areas.retain(|item| keeps(&item.name));
        self.markers.retain(|item| keeps(&item.name));
        self.labels.retain(|item| keeps(&item.name));
    }

    /// Adds the items of another scene, whose meshes begin at `first` in the model of this one.
    fn add(&mut self, other: Self, of: &str, first: usize) {
        let named = |name: &str| format!("{of}/{name}").into();
        self.solids.extend(other.solids.into_iter().map(|mut item| {
            item.name = named(&item.name);
            item.mesh += first;
            item
        }));
        self.lines.extend(other.lines.into_iter().map(|mut item| {
            item.name = named(&item.name);
            item
        }));
        self.areas.extend(other.areas.into_iter().map(|mut item| {
            item.name = named(&item.name);
            item
        }));
        self.markers.extend(other.markers.into_iter().map(|mut item| {
            item.name = named(&item.name);
            item
        }));
        self.bodies.extend(other.bodies);
        self.labels.extend(other.labels);
    }
}

impl BlockStages {
    /// Prepares the blocks of a run that are not led; `None` if its machine is no block of an assembly. `led` is the
    /// stage of the block that is led.
    pub fn of(run: &Run, led: &Stage) -> Option<Self> {
        let shared = run.shared()?;
        let stages = shared.others().map(|(i, run)| (i, 0, Stage::of(run)));
        let others: Vec<(usize, usize, Stage)> = stages.collect();
        let reach = others.iter().map(|(.., stage)| stage.linkage().reach()).fold(led.linkage().reach(), f64::max);
        let none = Arc::new(MeshSet::default());
        let block = shared.block().clone();
        let body = block.scenario.base.body().map(body_of);
        let mut all = Self {
            block,
            others,
            led: none.clone(),
            model: none,
            reach,
            platform: None,
            reached: Mesh::default(),
            body,
            body_mesh: 0,
        };
        let frames: Vec<(usize, Frame)> = shared.frames().collect();
        all.refresh(led, &run.frame(), frames.iter().map(|(i, frame)| (*i, frame)));
        Some(all)
    }

    /// Returns whether these are the blocks of a run.
    pub fn is_of(&self, run: &Run) -> bool {
        run.shared().is_some_and(|shared| Arc::ptr_eq(shared.block(), &self.block) || **shared.block() == *self.block)
    }

    /// Joins the meshes of all blocks with those of the led one, if these have changed, or the reach of the last
    /// platform has with a b of the frames.
    pub fn refresh<'a>(
        &mut self,
        led: &Stage,
        frame: &Frame,
        others: impl Iterator<Item = (usize, &'a Frame)> + Clone,
    ) {
        let own = &led.linkage().model;
        if self.platform.is_none() {
            let stage = |i: usize| if i == self.block.block { Some(led) } else { self.stage(i) };
            self.platform = PlatformReach::of(&self.block.scenario.assembly, stage).map(|platform| (platform, 0));
        }
        let b = |i: usize| match i == self.block.block {
            true => Some(frame.b_reference),
            false => others.clone().find(|(other, _)| *other == i).map(|(_, frame)| frame.b_reference),
        };
        let remade = self.platform.as_mut().and_then(|(platform, _)| platform.remade(b));
        if remade.is_none() && Arc::ptr_eq(own, &self.led) {
            return;
        }
        self.reached = remade.unwrap_or_else(|| std::mem::take(&mut self.reached));
        self.led = own.clone();
        let mut meshes = own.meshes.clone();
        for (_, first, stage) in &mut self.others {
            *first = meshes.len();
            meshes.extend(stage.linkage().model.meshes.iter().cloned());
        }
        self.body_mesh = meshes.len();
        meshes.extend(self.body.iter().map(|(mesh, _)| mesh.clone()));
        if let Some((_, mesh)) = &mut self.platform {
            *mesh = meshes.len();
            meshes.push(self.reached.clone());
        }
        self.model = Arc::new(MeshSet { meshes });
    }

    /// Returns where the blocks are mounted, m, in axes of the base.
    pub fn mounts<'a>(&self, led: &Frame, others: impl Iterator<Item = (usize, &'a Frame)>) -> Mounts {
        let none = PerDrive::zeros(0);
        let state = |frame: &Frame| BlockState { q: frame.q, qd: frame.qd, qdd: frame.qdd };
        let mut states = [BlockState { q: DriveAngles(none), qd: none, qdd: none }; MAX_BLOCKS];
        states[self.block.block] = state(led);
        others.for_each(|(i, frame)| states[i] = state(frame));
        self.block.scenario.assembly.mounts(&states)
    }

    /// Returns where a block is: the transformation from the axes of its plane to the world.
    fn placed(&self, block: usize, base: &Matrix4<f64>, mounts: &Mounts) -> Matrix4<f64> {
        let axes = self.block.scenario.assembly.blocks()[block].mount.axes.to_homogeneous();
        base * Matrix4::new_translation(&mounts[block]) * axes
    }

    /// Returns where the led block is: the transformation from the axes of its plane to the world.
    pub fn place<'a>(&self, led: &Frame, others: impl Iterator<Item = (usize, &'a Frame)>) -> Matrix4<f64> {
        self.placed(self.block.block, &base_of(led), &self.mounts(led, others))
    }

    /// Returns the scene of all blocks; `own` is that of the led block by itself.
    pub fn scene<'a>(
        &self,
        mut own: Scene,
        led: &Frame,
        others: impl Iterator<Item = (usize, &'a Frame)> + Clone,
        options: &ViewOptions,
    ) -> Scene {
        let (base, mounts) = (base_of(led), self.mounts(led, others.clone()));
        let place = |i: usize| self.placed(i, &base, &mounts);
        let palette = palette(options.theme);
        let blocks = self.block.scenario.assembly.blocks();
        let is_carried = |i: usize| blocks[i].mount.on.is_some();
        let plain = ViewOptions { theme: options.theme, show_hints: false, ..ViewOptions::default() };
        let keeps = |i: usize, name: &str| !(is_carried(i) && is_part(name, "machine/base"));
        own.retain(|name| keeps(self.block.block, name) && !OF_ONE.iter().any(|of| is_part(name, of)));
        let mut scene = own.moved(&place(self.block.block));
        scene.model = self.model.clone();
        for (i, frame) in others {
            let Some((_, first, stage)) = self.others.iter().find(|(of, ..)| *of == i) else { continue };
            let mut other = stage.scene(frame, &plain);
            other.retain(|name| keeps(i, name) && SHOWN.iter().any(|of| is_part(name, of)));
            // Of workspaces that are not at hand, the boundary is enough.
            other.areas.clear();
            other.solids.retain(|solid| !is_part(&solid.name, "workspace"));
            // Words of several planes would cover each other, but for what an arm holds.
            other.labels.retain(|label| is_part(&label.name, "payload"));
            scene.add(other.moved(&place(i)), &blocks[i].name, *first);
        }
        if let (Some((_, pose)), Some(_)) = (&self.body, &led.shared) {
            scene.solids.push(Solid {
                name: "base".into(),
                mesh: self.body_mesh,
                world_from_item: transform(&(base * pose)),
                colour: faded(palette.dim, BODY_OPACITY),
                changes: ItemChanges::Pose,
            });
        }
        for (block, mount) in blocks.iter().zip(&mounts) {
            let at = base.transform_point(&Point3::from(*mount)).map(|x| x as f32).into();
            let is_led = block.name == self.block.name();
            let tone = if is_led { palette.ink } else { palette.dim };
            let label = Label::new("blocks", at, [0.0, 22.0], &block.name, tone, 12.5, Anchor::Centre);
            scene.labels.push(label);
        }
        self.reached(&mut scene, (&base, &mounts), &palette);
        self.in_space(&mut scene, led, &palette);
        scene
    }

    /// Adds where the last platform can be; `base` takes axes of the base to those of the scene, whose model is
    /// [`model`](Self::model).
    pub fn reached(&self, scene: &mut Scene, (base, mounts): (&Matrix4<f64>, &Mounts), palette: &Palette) {
        if let Some((platform, mesh)) = &self.platform {
            let place = base * Matrix4::new_translation(&mounts[platform.carrier()]);
            platform.draw(scene, palette, *mesh, transform(&place));
        }
    }

    /// Returns the meshes of all blocks.
    pub fn model(&self) -> &Arc<MeshSet> {
        &self.model
    }

    /// Adds the path in space, and what reaches the base.
    pub fn in_space(&self, scene: &mut Scene, led: &Frame, palette: &Palette) {
        if let Some(tip) = &self.block.scenario.tip {
            let base = base_of(led);
            let place = |p: &[f64; 3]| base.transform_point(&Point3::from(*p)).map(|x| x as f32).into();
            let strip: Vec<[f32; 3]> = tip.points.iter().map(place).collect();
            scene.lines.push(Polyline::new("tip", vec![strip], 1.6, palette.ink).dashed(5.0, 4.0));
        }
        if let Some(shared) = &led.shared {
            self.reactions(scene, shared, palette);
        }
    }

    /// Returns the stage of a block that is not led.
    pub fn stage(&self, block: usize) -> Option<&Stage> {
        self.others.iter().find(|(of, ..)| *of == block).map(|(.., stage)| stage)
    }

    /// Returns the body of a base that floats, and its pose in the axes of the base.
    pub fn body(&self) -> Option<&(Mesh, Matrix4<f64>)> {
        self.body.as_ref()
    }

    /// Draws force and moment on the base at its origin, from motion, if they do not count as zero.
    fn reactions(&self, scene: &mut Scene, shared: &SharedBase, palette: &Palette) {
        let (six, silent) = (shared.loads.motion.components(), shared.silent());
        for (name, unit, first) in [("force", "N", 0), ("moment", "N m", 3)] {
            let parts = first..first + 3;
            let peak = parts.clone().map(|i| shared.peaks[i]).fold(0.0, f64::max);
            let vector = Vector3::new(six[first], six[first + 1], six[first + 2]);
            if parts.clone().all(|i| silent[i]) || peak == 0.0 {
                continue;
            }
            let length = ARROW_SHARE * self.reach * vector.norm() / peak;
            let along = shared.attitude.0 * vector;
            let Some(along) = along.try_normalize(1e-300).filter(|_| length > 1e-3 * self.reach) else { continue };
            let heads = if first == 0 { 1 } else { 2 };
            let strips = arrow(shared.origin, along, length, heads);
            let line = Polyline::new(format!("reaction/{name}"), strips, 3.0, palette.reaction).on_top();
            scene.lines.push(line);
            let end = (shared.origin + length * along).map(|x| x as f32).into();
            let text = format!("{name} {} {unit}", fixed_or_finer(vector.norm(), 3));
            scene.labels.push(words("reaction/words", end, text, palette.reaction));
        }
    }

    /// Returns the points that the camera has to show; `own` are those of the led block by itself, with the
    /// height of its floor, m.
    pub fn content<'a>(
        &self,
        (own, floor): (ViewContent, f64),
        led: &Frame,
        others: impl Iterator<Item = (usize, &'a Frame)> + Clone,
    ) -> ViewContent {
        let (base, mounts) = (base_of(led), self.mounts(led, others.clone()));
        // What lies below a point is seen, too: bodies have heights.
        let moved = |points: Vec<[f64; 3]>, i: usize, floor: f64| {
            let place = self.placed(i, &base, &mounts);
            let both = points.into_iter().flat_map(move |[x, y, z]| [[x, y, z], [x, y, floor]]);
            both.map(move |point| place.transform_point(&point.into()).into())
        };
        let own_place = self.block.block;
        let mut first: Vec<[f64; 3]> = moved(own.first, own_place, floor).collect();
        for (i, frame) in others {
            let Some(stage) = self.stage(i) else { continue };
            first.extend(moved(stage.content(frame, &[]).first, i, stage.linkage().floor()));
        }
        if let Some((mesh, pose)) = &self.body {
            let base = base * pose;
            let corners = mesh.positions.iter().map(|p| base.transform_point(&Point3::from(p.map(f64::from))));
            first.extend(corners.map(<[f64; 3]>::from));
        }
        let mut then: Vec<[f64; 3]> = moved(own.then, own_place, floor).collect();
        if let Some((platform, _)) = &self.platform {
            let place = base * Matrix4::new_translation(&mounts[platform.carrier()]);
            let seen = self.reached.positions.iter().step_by(CONTENT_STEP);
            then.extend(seen.map(|p| <[f64; 3]>::from(place.transform_point(&Point3::from(p.map(f64::from))))));
        }
        ViewContent { first, then }
    }
}

/// Returns where the base of a frame is: the transformation from its axes to the world.
fn base_of(frame: &Frame) -> Matrix4<f64> {
    let place = |shared: &SharedBase| Matrix4::new_translation(&shared.origin) * shared.attitude.0.to_homogeneous();
    frame.shared.as_ref().map_or_else(Matrix4::identity, place)
}

/// Returns the box of even density with the mass and the inertia of a base, and its pose in the axes of the base.
fn body_of(base: &SpatialBase) -> (Mesh, Matrix4<f64>) {
    let principal = base.inertia.symmetric_eigen();
    let sum = principal.eigenvalues.sum();
    // Of a box of sides a, b, c the moment about the first is m (b² + c²) / 12.
    let half =
        principal.eigenvalues.map(|moment| (0.5 * (6.0 * (sum - 2.0 * moment) / base.mass).max(0.0).sqrt()).max(1e-3));
    let corner = |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -half[axis] } else { half[axis] });
    let face = |[a, b, c, d]: [usize; 4]| [[corner(a), corner(b), corner(c)], [corner(a), corner(c), corner(d)]];
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = faces.into_iter().flat_map(face).collect();
    let mut axes = principal.eigenvectors;
    if axes.determinant() < 0.0 {
        axes.column_mut(2).neg_mut();
    }
    (closed(&triangles), Matrix4::new_translation(&base.com) * axes.to_homogeneous())
}

fn words(name: &'static str, at: [f32; 3], text: String, colour: Rgba) -> Label {
    Label::new(name, at, [10.0, 0.0], text, colour, 12.5, Anchor::Left)
}

/// Returns the strips of an arrow with one head or, for a moment, two.
fn arrow(from: Vector3<f64>, along: Vector3<f64>, length: f64, heads: usize) -> Vec<Vec<[f32; 3]>> {
    let point = |p: Vector3<f64>| -> [f32; 3] { p.map(|x| x as f32).into() };
    let end = from + length * along;
    let aside = if along.z.abs() < 0.9 { Vector3::z() } else { Vector3::x() };
    let aside = along.cross(&aside).normalize();
    let mut strips = vec![vec![point(from), point(end)]];
    for head in 0..heads {
        let tip = end - head as f64 * 0.6 * HEAD[0] * length * along;
        let barb = |sign: f64| point(tip - HEAD[0] * length * along + sign * HEAD[1] * length * aside);
        strips.push(vec![barb(1.0), point(tip), barb(-1.0)]);
    }
    strips
}
