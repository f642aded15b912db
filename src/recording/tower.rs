//! The tower of reactionless workspaces, b as height: its wall, the present slice, and the b that reach the points of
//! the task.

use std::sync::Arc;

use rerun::{Clear, EntityPath, Points3D, Quaternion, Transform3D};

use super::areas::{outlines, sheet};
use super::axes;
use super::dashes::dashed;
use super::eye::Eye;
use super::rows::Track;
use super::store::{Clock, Instant, Store, StoreError};
use super::style::{Both, dots, lines, point, solid, turned, under};
use crate::mechanics::planar::unit;
use crate::picture::scene::camera::{Camera, Orbit};
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::{Palette, faded};
use crate::picture::scene::tower;
use crate::planning::pose_constant::Planes;
use crate::session::Run;
use crate::simulation::frame::Frame;

/// From where it is seen at first, of a run whose b lie in a range, rad.
pub fn eye(run: &Run, b: [f64; 2]) -> Option<Eye> {
    let (tower, _) = tower::Tower::over(run, b)?;
    let Camera::Orbit(orbit) = tower.camera() else { return None };
    let [x, y, z] = orbit.centre;
    Some(Eye::upright(Orbit { centre: [x, y, 0.93 * z], distance: 0.66 * orbit.distance, ..orbit }))
}

/// Rows of the tower.
#[derive(Debug)]
pub struct Tower {
    path: EntityPath,
    planes: Arc<Planes>,
    /// The lowest b that is shown, rad, and the height of a radian, m.
    low: f64,
    rise: f64,
    slice: Track<([f32; 3], Quaternion)>,
    words: Track<String>,
    clock: Clock,
    tips: Vec<[f32; 3]>,
}

impl Tower {
    /// Writes the tower of a run, for good or from an instant on; b will lie in a range.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn show(
        store: &mut Store,
        root: &EntityPath,
        since: Option<Instant>,
        (run, range): (&Run, [f64; 2]),
        eye: &Eye,
        palette: &Palette,
    ) -> Result<Option<Self>, StoreError> {
        let (Some((tower, window)), Some(planes)) = (tower::Tower::over(run, range), run.planes()) else {
            return Ok(None);
        };
        let path = under(root, "tower");
        let ([low, high], rise) = (window, tower.rise());
        let z = |b: f64| (b - low) * rise;
        let on = |rgba, share| mix(palette.background, rgba, share);
        axes::show(store, &under(&path, "axes"), since, &tower.frame_box(palette, window), eye, palette)?;
        // The slice first: what is translucent keeps this order.
        let slice = sheet(planes.map(), 0.0, faded(palette.amber, 0.4));
        store.shape(since, &under(&path, "slice"), &slice)?;
        let edge = lines(outlines(planes, 0.0), 2.2, palette.amber);
        store.shape(since, &under(&path, "slice/boundary"), &edge)?;
        let label = dots(0.5, palette.amber).with_positions([[0.0; 3]]).with_show_labels(true);
        store.shape(since, &under(&path, "slice/label"), &label)?;
        let place = Transform3D::update_fields().with_quaternion(turned(unit(planes.map().turn(low))));
        let wall = solid(&tower.coarse_wall(), faded(palette.amber, 0.1));
        store.shape(since, &under(&path, "wall"), &Both(&wall, &place))?;
        let contours = tower.levels(window).flat_map(|(b, pieces)| pieces.into_iter().map(move |piece| (b, piece)));
        let contours = contours.map(|(b, piece)| piece.into_iter().map(|p| point(p, z(b))).collect());
        store.shape(since, &under(&path, "contours"), &lines(contours, 1.0, on(palette.amber, 0.4)))?;
        store.shape(since, &under(&path, "end_effector"), &dots(4.0, palette.ink))?;

        let posts = tower.planned_posts(window);
        if posts.is_empty() {
            if since.is_some() {
                store.shape(since, &under(&path, "points"), &Clear::recursive())?;
                store.shape(since, &under(&path, "reach"), &Clear::recursive())?;
                store.shape(since, &under(&path, "path"), &Clear::recursive())?;
            }
        } else {
            let dash = (0.03 * tower.radius()) as f32;
            // Names step up, or those of neighbours would hide each other.
            let head = |i: usize| z(high) + (0.08 + 0.13 * i as f64) * tower.radius();
            let feet = posts.iter().enumerate().map(|(i, (post, _))| (post, head(i)));
            let uprights = feet.clone().flat_map(|(post, top)| dashed(&[0.0, top].map(|z| point(post.at, z)), dash));
            store.shape(since, &under(&path, "points"), &lines(uprights, 1.2, on(palette.ink, 0.6)))?;
            let names = dots(0.5, palette.ink)
                .with_positions(feet.map(|(post, top)| point(post.at, top)))
                .with_labels(posts.iter().map(|(post, _)| post.name.as_str()))
                .with_show_labels(true);
            store.shape(since, &under(&path, "points/names"), &names)?;
            for (post, bars) in &posts {
                let bars = bars.iter().map(|ends| ends.map(|b| point(post.at, z(b))).to_vec());
                store.shape(since, &under(&path, &format!("reach/{}", post.name)), &lines(bars, 5.0, palette.zero))?;
            }
            let course: Vec<_> = tower.planned().iter().map(|(p, b)| point(*p, z(*b))).collect();
            let dashes = lines(dashed(&course, 0.5 * dash), 2.0, palette.ink);
            store.shape(since, &under(&path, "path"), &dashes)?;
        }
        Ok(Some(Self {
            path,
            planes: planes.clone(),
            low,
            rise,
            slice: Track::new(),
            words: Track::new(),
            clock: Clock::default(),
            tips: Vec::new(),
        }))
    }

    /// How high the slice lies at an instant, how it is turned, and where the end effector is on it.
    pub fn place(&mut self, at: Instant, frame: &Frame) {
        let b = frame.b_reference;
        let height = (b - self.low) * self.rise;
        self.slice.push(at, ([0.0, 0.0, height as f32], turned(unit(self.planes.map().turn(b)))));
        self.words.push(at, format!("b = {b:.3} rad"));
        self.clock.push(at);
        self.tips.push(point(frame.in_base(frame.tip), height));
    }

    /// Writes the rows since the last time.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, store: &mut Store) -> Result<(), StoreError> {
        let (clock, poses) = self.slice.take();
        let (heights, turns): (Vec<_>, Vec<_>) = poses.into_iter().unzip();
        let pose = Transform3D::update_fields().with_many_translation(heights).with_many_quaternion(turns);
        store.columns(&clock.columns(), &under(&self.path, "slice"), pose.columns_of_unit_batches()?)?;
        let (clock, words) = self.words.take();
        let words = Points3D::update_fields().with_labels(words.iter().map(String::as_str));
        store.columns(&clock.columns(), &under(&self.path, "slice/label"), words.columns_of_unit_batches()?)?;
        let (clock, tips) = (self.clock.columns(), std::mem::take(&mut self.tips));
        self.clock.clear();
        let tips = Points3D::update_fields().with_positions(tips).columns_of_unit_batches()?;
        store.columns(&clock, &under(&self.path, "end_effector"), tips)
    }
}
