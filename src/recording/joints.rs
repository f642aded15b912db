//! Joint space with q itself as coordinates, rad: the plane of b within the limits, the planned path, and the pose.

use rerun::{Clear, EntityPath, Mesh3D, Points3D, Transform3D};

use super::axes;
use super::dashes::dashed;
use super::eye::Eye;
use super::rows::Track;
use super::store::{Clock, Instant, Store, StoreError};
use super::style::{colour, dots, lines, under};
use crate::picture::scene::camera::{Camera, Orbit};
use crate::picture::scene::joint_space::JointSpace;
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::{Palette, faded};
use crate::session::Run;
use crate::simulation::frame::Frame;

/// Changes of b from which on they are what there is to see, rad.
const BESIDE: f64 = 0.3;

/// From where it is seen at first, of a run whose b lie in a range, rad.
pub fn eye(run: &Run, b: [f64; 2], palette: &Palette) -> Option<Eye> {
    let space = JointSpace::of(run)?;
    let Camera::Orbit(orbit) = space.camera() else { return None };
    let ends = space.frame_box(palette, space.window_over(b)).map(|axis| axis.ends);
    let size = ends.iter().map(|[from, to]| (to - from) * (to - from)).sum::<f64>().sqrt();
    let middle = ends.map(|[from, to]| 0.5 * (from + to));
    let centre = [middle[0], middle[1], middle[2] - 0.05 * size];
    // Where b changes the path runs along (1, 1, 1), which is seen from its side.
    let (yaw, distance) = if b[1] - b[0] > BESIDE { (-0.45, 1.2 * size) } else { (orbit.yaw, 1.05 * size) };
    Some(Eye { orbit: Orbit { centre, distance, yaw, ..orbit }, axes: space.drives() })
}

/// Rows of joint space.
#[derive(Debug)]
pub struct Joints {
    path: EntityPath,
    /// b of the plane that was drawn, and Σλ.
    home: [f64; 2],
    plane: Track<[f32; 3]>,
    words: Track<String>,
    clock: Clock,
    poses: Vec<[f32; 3]>,
}

impl Joints {
    /// Writes joint space of a run at its present b, for good or from an instant on; b will lie in a range.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn show(
        store: &mut Store,
        root: &EntityPath,
        since: Option<Instant>,
        (run, b, range): (&Run, f64, [f64; 2]),
        eye: &Eye,
        palette: &Palette,
    ) -> Result<Option<Self>, StoreError> {
        let (Some(space), Some(planes)) = (JointSpace::of(run), run.planes()) else { return Ok(None) };
        let path = under(root, "joint_space");
        let window = space.window_over(range);
        let [low, high] = window.map(|edge| space.corners(edge).map(narrow));
        axes::show(store, &under(&path, "axes"), since, &space.frame_box(palette, window), eye, palette)?;
        let on = |rgba, share| mix(palette.background, rgba, share);
        let edges = low.into_iter().zip(high).map(|(from, to)| vec![from, to]);
        store.shape(since, &under(&path, "limits"), &lines(edges, 1.0, on(palette.dim, 0.6)))?;
        let others = space.neighbours_in(window).map(|other| ring(space.corners(other).map(narrow)));
        store.shape(since, &under(&path, "planes"), &lines(others, 1.0, on(palette.amber, 0.3)))?;
        let corners = space.corners(b).map(narrow);
        let plane = Mesh3D::new(corners)
            .with_triangle_indices([[0, 1, 2], [0, 2, 3]])
            .with_albedo_factor(colour(faded(palette.amber, 0.3)).0);
        store.shape(since, &under(&path, "plane"), &plane)?;
        let outline = lines([ring(corners)], 2.0, palette.amber);
        store.shape(since, &under(&path, "plane/boundary"), &outline)?;
        let label = dots(0.5, palette.amber).with_positions([corners[2]]).with_show_labels(true);
        store.shape(since, &under(&path, "plane/label"), &label)?;
        store.shape(since, &under(&path, "pose"), &dots(4.5, palette.ink))?;
        let course: Vec<_> = space.planned().iter().map(|q| narrow(*q)).collect();
        if let (Some(first), Some(last)) = (course.first(), course.last()) {
            let dashes = lines(dashed(&course, 0.06), 2.0, palette.ink);
            store.shape(since, &under(&path, "path"), &dashes)?;
            let ends =
                dots(3.5, palette.ink).with_positions([*first, *last]).with_labels(["A", "B"]).with_show_labels(true);
            store.shape(since, &under(&path, "path/ends"), &ends)?;
        } else if since.is_some() {
            store.shape(since, &under(&path, "path"), &Clear::recursive())?;
        }
        let home = [b, planes.map().lambda_sum()];
        Ok(Some(Self {
            path,
            home,
            plane: Track::new(),
            words: Track::new(),
            clock: Clock::default(),
            poses: Vec::new(),
        }))
    }

    /// Where the plane and the pose are at an instant.
    pub fn place(&mut self, at: Instant, frame: &Frame) {
        let [b, sum] = self.home;
        // Turning all drives alike leads from plane to plane.
        self.plane.push(at, [((frame.b_reference - b) / sum) as f32; 3]);
        self.words.push(at, format!("b = {:.3} rad", frame.b_reference));
        self.clock.push(at);
        self.poses.push(narrow([0, 1, 2].map(|k| frame.relative(k))));
    }

    /// Writes the rows since the last time.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        let (clock, shifts) = self.plane.take();
        let shifts = Transform3D::update_fields().with_many_translation(shifts);
        store.columns(&clock.columns(), &under(&self.path, "plane"), shifts.columns_of_unit_batches()?)?;
        let (clock, words) = self.words.take();
        let words = Points3D::update_fields().with_labels(words.iter().map(String::as_str));
        store.columns(&clock.columns(), &under(&self.path, "plane/label"), words.columns_of_unit_batches()?)?;
        let (clock, poses) = (self.clock.columns(), std::mem::take(&mut self.poses));
        self.clock.clear();
        let poses = Points3D::update_fields().with_positions(poses).columns_of_unit_batches()?;
        store.columns(&clock, &under(&self.path, "pose"), poses)
    }
}

fn narrow(q: [f64; 3]) -> [f32; 3] {
    q.map(|x| x as f32)
}

/// Corners as a closed line.
fn ring([a, b, c, d]: [[f32; 3]; 4]) -> Vec<[f32; 3]> {
    vec![a, b, c, d, a]
}
