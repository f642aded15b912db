//! [`RecordedBlocks`]: the blocks of an assembly, each a space of its own, as that of a machine by itself, whose entity turns
//! and shifts it to where the block is. Beside them are the paths of the end effectors, a base that floats, and force and
//! moment on the base.

use std::sync::Arc;

use nalgebra::{Matrix3, Matrix4, Rotation3, UnitQuaternion, Vector3};

use crate::rerun::{EntityPath, Quaternion, Transform3D};

use super::eye::Eye;
use super::rows::{SparseRows, Thinned};
use super::space::RecordingSpace;
use super::store::{Instant, Store, StoreError};
use super::style::{lines, solid, under};
use stillbase_picture::scene::blocks::BlockStages;
use stillbase_picture::scene::camera::Orbit;
use stillbase_picture::scene::options::ViewOptions;
use stillbase_picture::scene::palette::{Palette, mix};
use stillbase_picture::scene::stage::Stage;
use stillbase_picture::scene::{Rgba, Scene};
use stillbase_session::assembly::{AssemblyBlock, AssemblyFrame};
use stillbase_session::{Run, WholeFrame};
use stillbase_simulation::frame::Frame;

/// Part of the reach of a machine around its base that the eye sees.
const SEEN_REACH: f64 = 0.5;

/// Maximum number of points of a trail.
const MAX_TRAIL_POINTS: usize = 16_384;

/// Opacity of surfaces as a share of that in the window: the viewer blends light, not sRGB values, so on a dark ground
/// the same opacity looks stronger.
const OPACITY_SHARE: f32 = 0.5;

/// Name of the entity of a base that floats.
const BASE: &str = "base";

/// A rotation and a place in space, m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    turn: [f32; 4],
    at: [f32; 3],
}

impl Placed {
    fn of(at: &Vector3<f64>, turn: &Matrix3<f64>) -> Self {
        let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*turn));
        Self { turn: [q.i, q.j, q.k, q.w].map(|x| x as f32), at: at.map(|x| x as f32).into() }
    }
}

/// Rows of the places of an entity.
#[derive(Debug)]
struct Places {
    path: EntityPath,
    rows: SparseRows<Placed>,
}

impl Places {
    fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        let (clock, rows) = self.rows.take();
        if rows.is_empty() {
            return Ok(());
        }
        let rows = Transform3D::update_fields()
            .with_many_translation(rows.iter().map(|row| row.at).collect::<Vec<_>>())
            .with_many_quaternion(rows.iter().map(|row| Quaternion::from_xyzw(row.turn)).collect::<Vec<_>>());
        store.columns(&clock.columns(), &self.path, rows.columns_of_unit_batches()?)
    }
}

/// A block.
#[derive(Debug)]
struct RecordedBlock {
    name: String,
    space: RecordingSpace,
    places: Places,
    trail: Thinned<[f32; 3]>,
}

/// The blocks of an assembly.
#[derive(Debug)]
pub struct RecordedBlocks {
    of: Arc<AssemblyBlock>,
    root: EntityPath,
    palette: Palette,
    blocks: Vec<RecordedBlock>,
    /// The path in space, force and moment on the base.
    loads: RecordingSpace,
    /// What moves with the base: where the last platform can be.
    on_base: RecordingSpace,
    base: Places,
    /// The stages of the blocks that are not led.
    stages: Option<BlockStages>,
}

impl RecordedBlocks {
    /// Returns the blocks of an assembly, seen from an eye, without rows.
    pub fn of(of: &Arc<AssemblyBlock>, root: &EntityPath, eye: Eye, palette: Palette) -> Self {
        let places = |path: EntityPath| Places { path, rows: SparseRows::new() };
        let block = |name: &String| RecordedBlock {
            name: name.clone(),
            space: RecordingSpace::new(under(root, name), eye, palette.background),
            places: places(under(root, name)),
            trail: Thinned::new(1, MAX_TRAIL_POINTS),
        };
        Self {
            blocks: of.scenario.assembly.blocks().iter().map(|own| block(&own.name)).collect(),
            loads: RecordingSpace::new(root.clone(), eye, palette.background),
            on_base: RecordingSpace::new(under(root, BASE), eye, palette.background),
            base: places(under(root, BASE)),
            of: of.clone(),
            root: root.clone(),
            palette,
            stages: None,
        }
    }

    /// Returns the scene of all blocks in space at an instant of a run, for a picture; `led` is the stage of the block that
    /// is led.
    pub fn scene(&self, (run, frame, led): (&Run, &Frame, &Stage), options: &ViewOptions) -> Scene {
        let own = led.scene(frame, options);
        let Some((stages, shared)) = self.stages.as_ref().zip(run.shared()) else { return own };
        let others: Vec<(usize, Frame)> = shared.frames().collect();
        stages.scene(own, frame, others.iter().map(|(i, frame)| (*i, frame)), options)
    }

    /// Draws an instant of a run; `led` is the stage of the block that is led, and `when` the instant, with that from which
    /// its constant parts are valid.
    ///
    /// # Errors
    /// If the store cannot be written.
    pub fn draw(
        &mut self,
        store: &mut Store,
        (at, since): (Instant, Option<Instant>),
        (run, frame, led): (&Run, &Frame, &Stage),
        options: &ViewOptions,
        is_last: bool,
    ) -> Result<(), StoreError> {
        let Some(shared_run) = run.shared() else { return Ok(()) };
        let (now, whole) = (shared_run.now(), WholeFrame::of(run, frame));
        if self.stages.is_none() {
            self.stages = BlockStages::of(run, led);
            self.draw_body(store)?;
        }
        let others: Vec<(usize, Frame)> = shared_run.frames().collect();
        let others = others.iter().map(|(i, frame)| (*i, frame));
        if let Some(stages) = &mut self.stages {
            stages.refresh(led, frame, others.clone());
        }
        let plain = ViewOptions { notes: Vec::new(), ..options.clone() };
        for (i, block) in self.blocks.iter_mut().enumerate() {
            let (place, turn) = now.place(&self.of.scenario.assembly, i);
            block.places.rows.push(at, Placed::of(&place, &turn));
            let tip = now.in_space(&now.tips[i]);
            block.trail.push(|| tip.map(|x| x as f32).into(), is_last);
            let (mut scene, since) = match i == self.of.block {
                true => (led.scene(frame, options), since),
                false => match self.stages.as_ref().and_then(|stages| stages.stage(i)) {
                    Some(stage) => (stage.scene(whole.frame(i), &plain), None),
                    None => continue,
                },
            };
            // Labels and grids of several planes would cover each other.
            scene.labels.clear();
            scene.lines.retain(|line| !line.name.starts_with("grid") && !line.name.starts_with("reaction"));
            block.space.draw(store, (at, since), &scene)?;
        }
        if let (Some(stages), Some(shared)) = (&self.stages, &frame.shared) {
            self.base.rows.push(at, Placed::of(&shared.origin, &shared.attitude.0.to_rotation_matrix().into_inner()));
            let mut scene = Scene::new(self.palette.background, Arc::default());
            stages.in_space(&mut scene, frame, &self.palette);
            self.loads.draw(store, (at, Some(at)), &scene)?;
            let mut scene = Scene::new(self.palette.background, stages.model().clone());
            let mounts = stages.mounts(frame, others);
            stages.reached(&mut scene, (&Matrix4::identity(), &mounts), &self.palette);
            scene.solids.iter_mut().for_each(|solid| solid.colour[3] *= OPACITY_SHARE);
            self.on_base.draw(store, (at, Some(at)), &scene)?;
        }
        Ok(())
    }

    /// Draws the body of a base that floats, in its axes.
    fn draw_body(&self, store: &mut Store) -> Result<(), StoreError> {
        let Some((mesh, pose)) = self.stages.as_ref().and_then(BlockStages::body) else { return Ok(()) };
        let eye = Eye::upright(Orbit { centre: [0.0; 3], distance: 1.0, yaw: 0.0, pitch: 0.0 });
        let colour: Rgba = mix(self.palette.dim, self.palette.background, 0.6);
        let body = under(&self.base.path, "body");
        store.fixed(&body, &solid(mesh, colour, &eye))?;
        let place = Matrix4::fixed_view::<3, 1>(pose, 0, 3).into_owned();
        let Placed { turn, at } = Placed::of(&place, &pose.fixed_view::<3, 3>(0, 0).into_owned());
        let place = Transform3D::update_fields().with_translation(at).with_quaternion(Quaternion::from_xyzw(turn));
        store.fixed(&body, &place)
    }

    /// Writes all buffered rows.
    ///
    /// # Errors
    /// If the store cannot be written.
    pub fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        for block in &mut self.blocks {
            block.places.write(store)?;
            block.space.write(store)?;
        }
        self.base.write(store)?;
        self.on_base.write(store)?;
        self.loads.write(store)
    }

    /// Writes the paths of the end effectors.
    ///
    /// # Errors
    /// If the store cannot be written.
    pub fn finish(&mut self, store: &mut Store) -> Result<(), StoreError> {
        for block in &mut self.blocks {
            let trail = lines([block.trail.take()], 1.8, mix(self.palette.ink, self.palette.dim, 0.5));
            store.fixed(&under(&self.root, &format!("trail/{}", block.name)), &trail)?;
        }
        Ok(())
    }
}

/// Returns points of an instant by which the eye is placed, m: the end effectors, and where the arms reach.
pub fn seen_points(of: &AssemblyBlock, now: &AssemblyFrame) -> Vec<[f64; 3]> {
    let assembly = &of.scenario.assembly;
    let mut points = Vec::with_capacity(5 * assembly.blocks().len());
    for (i, block) in assembly.blocks().iter().enumerate() {
        let (place, turn) = now.place(assembly, i);
        points.push(now.in_space(&now.tips[i]).into());
        // An arm reaches about as far to every side.
        let reach = SEEN_REACH * block.machine.reach();
        for [x, y] in [[reach, 0.0], [-reach, 0.0], [0.0, reach], [0.0, -reach]] {
            points.push((place + turn * Vector3::new(x, y, 0.0)).into());
        }
    }
    points
}
