//! A film of a run, picture by picture.

use std::io;
use std::path::Path;

use super::{ExportError, FilmForm};
use crate::shot::PictureOrder;
use crate::{AppState, SessionCommand};
use stillbase_files::NewFile;
use stillbase_files::new_folder::{NewFolder, check_new_folder};
use stillbase_files::video::{Mp4File, VideoError, has_encoder};
use stillbase_picture::film::{Film, FilmFormat};
use stillbase_picture::render::offscreen::Picture;

/// Maximum number of pictures of a film.
const MAX_PICTURES: f64 = 5000.0;

/// A film to be written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmOrder {
    /// Its pictures.
    pub picture: PictureOrder,
    /// First and last instant, s.
    pub times: [f64; 2],
    /// Pictures per second.
    pub fps: f64,
    /// Factor by which the film plays slower than the run.
    pub slow: f64,
}

/// A film that was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmDone {
    /// Number of pictures.
    pub pictures: u32,
    /// First and last instant, s.
    pub times: [f64; 2],
}

impl FilmOrder {
    /// Returns the number of pictures.
    ///
    /// # Errors
    /// If there would be too many.
    pub fn count(&self) -> Result<u32, ExportError> {
        let [from, to] = self.times;
        let count = ((to - from) * self.slow * self.fps).round() + 1.0;
        if count <= MAX_PICTURES { Ok(count as u32) } else { Err(ExportError::TooMany { count, most: MAX_PICTURES }) }
    }

    /// Returns the instant of a picture, s.
    fn time(&self, picture: u32) -> f64 {
        let [from, to] = self.times;
        (from + f64::from(picture) / (self.slow * self.fps)).min(to)
    }
}

/// Draws a film of the session in `app_state` and writes it in a format; the file `-` is standard output.
/// `goes_on` gets the fraction done and says whether to continue.
///
/// # Errors
/// If the film cannot be drawn or written, or `goes_on` stops it; no file is left then.
pub fn write_film(
    app_state: &mut AppState,
    order: &FilmOrder,
    (file, form): (&Path, FilmForm),
    force: bool,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<FilmDone, ExportError> {
    check_film((file, form), &order.picture, force)?;
    let count = order.count()?;
    let mut canvas = order.picture.canvas()?;
    let mut each = |push: &mut dyn FnMut(Picture) -> Result<(), ExportError>| {
        for i in 0..count {
            app_state.carry_out(SessionCommand::Seek(order.time(i)));
            push(order.picture.draw(&mut canvas, app_state)?)?;
            if !goes_on(f64::from(i + 1) / f64::from(count)) {
                return Err(ExportError::Stopped);
            }
        }
        Ok(())
    };
    let failed = |source: io::Error| ExportError::Encoding { file: file.into(), source };
    match form {
        FilmForm::Gif | FilmForm::Png | FilmForm::Webp => {
            let format = match form {
                FilmForm::Gif => FilmFormat::Gif,
                FilmForm::Webp => FilmFormat::Webp,
                _ => FilmFormat::Png,
            };
            let mut out = NewFile::create(file, force)?;
            let begun = Film::begin(&mut out, format, order.picture.size_px, count, order.fps);
            let mut film = begun.map_err(failed)?;
            each(&mut |picture| film.push(picture).map_err(failed))?;
            film.finish().map_err(failed)?;
            out.finish()?;
        }
        FilmForm::Mp4 => {
            let mut film = Mp4File::create(file, force, order.picture.size_px, order.fps)?;
            each(&mut |picture| Ok(film.push(&picture.rgba)?))?;
            film.finish()?;
        }
        FilmForm::Frames => {
            let mut folder = NewFolder::create(file, force)?;
            each(&mut |picture| Ok(folder.push(&picture.to_png().map_err(failed)?)?))?;
            folder.finish()?;
        }
    }
    Ok(FilmDone { pictures: count, times: order.times })
}

/// Checks that a film of such pictures can be written: its place, and its encoder.
///
/// # Errors
/// If one of these does not hold.
pub fn check_film((file, form): (&Path, FilmForm), picture: &PictureOrder, force: bool) -> Result<(), ExportError> {
    if picture.transparent && !form.can_be_transparent() {
        return Err(ExportError::NoTransparency(file.into()));
    }
    match form {
        FilmForm::Frames => check_new_folder(file, force)?,
        FilmForm::Mp4 if !has_encoder() => return Err(VideoError::NoEncoder.into()),
        _ => stillbase_files::check_new(file, force)?,
    }
    Ok(())
}
