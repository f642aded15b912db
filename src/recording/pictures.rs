//! Offscreen pictures during a recording, as PNG.

use crate::rerun::{EncodedImage, EntityPath};

use super::options::Pictures;
use super::stop::CaseError;
use super::store::{Instant, RowTimes, Store};
#[cfg(feature = "render")]
use stillbase_picture::render::offscreen::{NoAdapter, NoPicture, Picture, legible_scale};
#[cfg(all(feature = "render", not(feature = "ui")))]
use stillbase_picture::render::{View, offscreen::Gpu};
use stillbase_picture::scene::{Scene, camera::Camera, options::ViewOptions};
use stillbase_simulation::frame::Frame;

/// Size of buffered pictures above which they are written, bytes.
const MAX_BUFFERED_BYTES: usize = 4 << 20;

/// Draws scenes; with labels, if fonts are compiled in.
#[cfg(feature = "ui")]
struct Painter(stillbase_picture::canvas::Canvas);

#[cfg(all(feature = "render", not(feature = "ui")))]
struct Painter(Gpu, View);

#[cfg(feature = "render")]
impl Painter {
    fn new(wanted: Pictures) -> Result<Self, NoAdapter> {
        let size = [wanted.width, wanted.height];
        let scale = legible_scale(wanted.height);
        #[cfg(feature = "ui")]
        return Ok(Self(stillbase_picture::canvas::Canvas::new(size, scale)?));
        #[cfg(not(feature = "ui"))]
        Ok(Self(
            Gpu::new()?,
            View {
                clip_from_world: Default::default(),
                eye_direction: Default::default(),
                size_px: size,
                pixels_per_point: scale,
            },
        ))
    }

    fn draw(&mut self, scene: Scene, camera: &Camera) -> Result<Picture, NoPicture> {
        #[cfg(feature = "ui")]
        return self.0.scene(&std::sync::Arc::new(scene), camera);
        #[cfg(not(feature = "ui"))]
        {
            let Self(gpu, view) = self;
            let [width, height] = view.size_px.map(f64::from);
            view.clip_from_world = camera.clip_from_world(width / height);
            view.eye_direction = camera.eye_direction();
            gpu.picture(&scene, view)
        }
    }
}

/// Takes pictures, if they are requested and there is a usable adapter.
pub struct PictureSeries {
    wanted: Option<Pictures>,
    note: Option<String>,
    #[cfg(feature = "render")]
    painter: Option<Painter>,
    /// Index of the next picture of the current case: it is due at this number divided by the frame rate.
    count: u64,
    clock: RowTimes,
    pictures: Vec<Vec<u8>>,
}

impl PictureSeries {
    /// Opens an adapter if pictures are requested.
    pub fn of(wanted: Option<Pictures>) -> Self {
        let mut series = Self {
            wanted,
            note: None,
            #[cfg(feature = "render")]
            painter: None,
            count: 0,
            clock: RowTimes::default(),
            pictures: Vec::new(),
        };
        if let Some(wanted) = wanted {
            series.prepare(wanted);
        }
        series
    }

    #[cfg(feature = "render")]
    fn prepare(&mut self, wanted: Pictures) {
        match Painter::new(wanted) {
            Ok(painter) => self.painter = Some(painter),
            Err(why) => self.go_without(&why.to_string()),
        }
    }

    #[cfg(not(feature = "render"))]
    fn prepare(&mut self, _: Pictures) {
        self.go_without("built without the feature `render`");
    }

    fn go_without(&mut self, why: &str) {
        self.wanted = None;
        self.note = Some(format!("recorded without pictures: {why}"));
    }

    /// Returns whether there will be pictures.
    pub fn is_wanted(&self) -> bool {
        self.wanted.is_some()
    }

    /// Returns the reason why there are no pictures, if they were requested.
    pub fn notes(&self) -> Vec<String> {
        self.note.iter().cloned().collect()
    }

    /// Returns whether a picture is due at this instant: the step is nearest to the time of the next picture.
    pub fn is_due(&mut self, frame: &Frame, step: f64) -> bool {
        if frame.step == 0 {
            self.count = 0;
        }
        self.wanted.is_some_and(|p| frame.time + 0.5 * step >= self.count as f64 / p.fps)
    }

    /// Returns the options of pictures, from those of the scene.
    pub fn options(&self, of_scene: &ViewOptions) -> ViewOptions {
        ViewOptions { pin_forces: self.wanted.is_some_and(|wanted| wanted.pin_forces), ..of_scene.clone() }
    }

    /// Takes a picture of a scene at an instant, at a time, s.
    #[cfg(feature = "render")]
    pub fn take(&mut self, (at, time): (Instant, f64), scene: Scene, camera: &Camera) -> Result<(), CaseError> {
        let (Some(wanted), Some(painter)) = (self.wanted, &mut self.painter) else { return Ok(()) };
        let failed = |why: &dyn std::fmt::Display| CaseError::Pictures(why.to_string());
        let picture = painter.draw(scene, camera).map_err(|why| failed(&why))?;
        if [picture.width, picture.height] != [wanted.width, wanted.height] {
            let most = picture.width.max(picture.height);
            return Err(failed(&NoPicture::Size { width: wanted.width, height: wanted.height, most }));
        }
        self.pictures.push(picture.to_png().map_err(|why| failed(&why))?);
        self.clock.push(at);
        // If steps are longer than the time between pictures, there is one picture per step.
        self.count = self.count.max((time * wanted.fps).floor() as u64) + 1;
        Ok(())
    }

    #[cfg(not(feature = "render"))]
    pub fn take(&mut self, _: (Instant, f64), _: Scene, _: &Camera) -> Result<(), CaseError> {
        Ok(())
    }

    /// Returns whether the buffered pictures should be written.
    pub fn is_full(&self) -> bool {
        self.pictures.iter().map(Vec::len).sum::<usize>() > MAX_BUFFERED_BYTES
    }

    /// Writes the buffered pictures.
    pub fn write(&mut self, store: &mut Store, path: &EntityPath) -> Result<(), CaseError> {
        if self.pictures.is_empty() {
            return Ok(());
        }
        let columns = EncodedImage::update_fields()
            .with_many_media_type(self.pictures.iter().map(|_| crate::rerun::MediaType::png()))
            .with_many_blob(self.pictures.drain(..).map(crate::rerun::components::Blob::from));
        store.columns(&self.clock.columns(), path, columns.columns_of_unit_batches()?)?;
        self.clock.clear();
        Ok(())
    }
}
