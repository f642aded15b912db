//! The end effector: where it is, where it has been, and where it is sent.

use rerun::{EntityPath, LineStrips3D, Points3D, Transform3D};
use std::f64::consts::TAU;

use super::rows::{Thinned, Track};
use super::store::{Clock, Instant, Store, StoreError};
use super::style::{dots, lines, point, under};
use crate::mechanics::planar::unit;
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::Palette;
use crate::simulation::frame::{Frame, Reach};

/// Points of a trail, at most.
const TRAIL: usize = 16_384;

/// Rows of the end effector and its target.
#[derive(Debug)]
pub struct Tip {
    clock: Clock,
    places: Vec<[f32; 3]>,
    trail: Thinned<[f32; 3]>,
    target: Track<[f32; 3]>,
    gap: Track<Option<[f32; 3]>>,
}

impl Tip {
    /// Nothing yet, but how it looks.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn show(store: &mut Store, root: &EntityPath, reach: f64, palette: &Palette) -> Result<Self, StoreError> {
        store.fixed(&under(root, "end_effector"), &dots(4.5, palette.ink))?;
        let ring = (0..=48).map(|i| point(unit(TAU * f64::from(i) / 48.0) * (0.019 * reach), 0.0)).collect();
        store.fixed(&under(root, "target"), &lines([ring], 2.2, palette.ink))?;
        Ok(Self {
            clock: Clock::default(),
            places: Vec::new(),
            trail: Thinned::new(1, TRAIL),
            target: Track::new(),
            gap: Track::new(),
        })
    }

    /// Where everything is at an instant, at a height, m; `last` of the run.
    pub fn place(&mut self, at: Instant, frame: &Frame, z: f64, last: bool) {
        let tip = point(frame.tip, z);
        self.clock.push(at);
        self.places.push(tip);
        self.trail.push(|| tip, last);
        self.target.push(at, point(frame.target.at, z));
        let gap = match frame.target.reach {
            Reach::Outside { nearest, .. } => Some(point(nearest - frame.target.at, 0.0)),
            Reach::Inside | Reach::Carried => None,
        };
        self.gap.push(at, gap);
    }

    /// Writes the rows since the last time.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn write(&mut self, store: &mut Store, root: &EntityPath) -> Result<(), StoreError> {
        let (clock, places) = (self.clock.columns(), std::mem::take(&mut self.places));
        self.clock.clear();
        let places = Points3D::update_fields().with_positions(places).columns_of_unit_batches()?;
        store.columns(&clock, &under(root, "end_effector"), places)?;
        let (clock, targets) = self.target.take();
        let pose = Transform3D::update_fields().with_many_translation(targets);
        store.columns(&clock.columns(), &under(root, "target"), pose.columns_of_unit_batches()?)?;
        let (clock, gaps) = self.gap.take();
        let lengths: Vec<_> = gaps.iter().map(|gap| usize::from(gap.is_some())).collect();
        let gaps = LineStrips3D::new(gaps.into_iter().flatten().map(|to| [[0.0; 3], to]));
        store.columns(&clock.columns(), &under(root, "target/gap"), gaps.columns(lengths)?)
    }

    /// Writes the whole trail.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write_trail(&mut self, store: &mut Store, root: &EntityPath, palette: &Palette) -> Result<(), StoreError> {
        let trail = lines([self.trail.take()], 1.8, mix(palette.ink, palette.dim, 0.5));
        store.fixed(&under(root, "end_effector/path"), &trail)
    }
}
