//! Offscreen pictures on the way, as PNG.

use std::io::Write;

use rerun::{EncodedImage, EntityPath};

use super::Pictures;
use super::recorder::Stop;
use super::store::{Clock, Instant, Store};
use crate::frame::Frame;
#[cfg(feature = "render")]
use crate::render::{View, offscreen::Gpu};
use crate::scene::stage::Stage;

/// Bytes that are gathered before they are written.
const ROLL: usize = 4 << 20;

/// Takes pictures, if any are wanted and there is something to draw with.
pub struct Film {
    wanted: Option<Pictures>,
    note: Option<String>,
    #[cfg(feature = "render")]
    gpu: Option<Gpu>,
    /// Pictures of the case at hand.
    taken: u64,
    clock: Clock,
    pictures: Vec<Vec<u8>>,
}

impl Film {
    /// Looks for something to draw with.
    pub fn of(wanted: Option<Pictures>) -> Self {
        let mut film = Self {
            wanted,
            note: None,
            #[cfg(feature = "render")]
            gpu: None,
            taken: 0,
            clock: Clock::default(),
            pictures: Vec::new(),
        };
        if film.wanted.is_some() {
            film.load();
        }
        film
    }

    #[cfg(feature = "render")]
    fn load(&mut self) {
        match Gpu::new() {
            Ok(gpu) => self.gpu = Some(gpu),
            Err(why) => self.go_without(&why.to_string()),
        }
    }

    #[cfg(not(feature = "render"))]
    fn load(&mut self) {
        self.go_without("built without the feature `render`");
    }

    fn go_without(&mut self, why: &str) {
        self.wanted = None;
        self.note = Some(format!("recorded without pictures: {why}"));
    }

    /// Whether there will be pictures.
    pub fn is_loaded(&self) -> bool {
        self.wanted.is_some()
    }

    /// Why there are no pictures, if some were wanted.
    pub fn notes(&self) -> Vec<String> {
        self.note.iter().cloned().collect()
    }

    /// Whether a picture is due at this instant, on the step nearest to its time.
    pub fn is_due(&mut self, frame: &Frame, step: f64) -> bool {
        if frame.step == 0 {
            self.taken = 0;
        }
        self.wanted.is_some_and(|p| frame.time + 0.5 * step >= self.taken as f64 / p.fps)
    }

    /// Takes one.
    #[cfg(feature = "render")]
    pub fn take(&mut self, at: Instant, stage: &Stage, frame: &Frame) -> Result<(), Stop> {
        use crate::scene::camera::Camera;
        use crate::scene::stage::ViewOptions;

        let (Some(wanted), Some(gpu)) = (self.wanted, &mut self.gpu) else { return Ok(()) };
        let camera = Camera::flat(stage.linkage().reach());
        let view = View {
            clip_from_world: camera.clip_from_world(f64::from(wanted.width) / f64::from(wanted.height)),
            eye_direction: camera.eye_direction(),
            size_px: [wanted.width, wanted.height],
            pixels_per_point: (wanted.height as f32 / 800.0).max(0.5),
        };
        let scene = stage.scene(frame, &ViewOptions::default());
        let picture = gpu.picture(&scene, &view).map_err(|why| Stop::Pictures(why.to_string()))?;
        let png = picture.to_png().map_err(|why| Stop::Pictures(why.to_string()))?;
        self.clock.push(at);
        self.pictures.push(png);
        // Where steps are longer than the time between pictures, one a step.
        self.taken = self.taken.max((frame.time * wanted.fps).floor() as u64) + 1;
        Ok(())
    }

    #[cfg(not(feature = "render"))]
    pub fn take(&mut self, _: Instant, _: &Stage, _: &Frame) -> Result<(), Stop> {
        Ok(())
    }

    /// Whether it is time to write.
    pub fn is_full(&self) -> bool {
        self.pictures.iter().map(Vec::len).sum::<usize>() > ROLL
    }

    /// Writes what was taken.
    pub fn write<W: Write>(&mut self, store: &mut Store<W>, path: &EntityPath) -> Result<(), Stop> {
        if self.pictures.is_empty() {
            return Ok(());
        }
        let columns = EncodedImage::update_fields()
            .with_many_media_type(self.pictures.iter().map(|_| rerun::MediaType::png()))
            .with_many_blob(self.pictures.drain(..).map(rerun::components::Blob::from));
        store.columns(&self.clock.columns(), path, columns.columns_of_unit_batches()?)?;
        self.clock.clear();
        Ok(())
    }
}
