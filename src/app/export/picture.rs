//! A picture of the window or its scene.

use std::path::Path;

use super::{ExportError, PictureForm};
use crate::AppState;
use crate::shot::PictureOrder;

/// Draws the instant that `app_state` shows and writes it in a format, unless `goes_on` stops it before; the file
/// `-` is standard output. Returns what to say of letters that the font lacks.
///
/// # Errors
/// If the picture cannot be drawn or written, or is stopped.
pub fn write_picture(
    app_state: &mut AppState,
    order: &PictureOrder,
    (file, form): (&Path, PictureForm),
    force: bool,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<Option<String>, ExportError> {
    stillbase_files::check_new(file, force)?;
    let failed = |source| ExportError::Encoding { file: file.into(), source };
    let mut note = None;
    let bytes = if form.has_outlines() {
        let page = order.page(app_state);
        let page = page.map_err(|why| ExportError::NoOutlines { file: file.into(), why })?;
        note = page.note();
        form.of_page(&page)
    } else {
        form.of_pixels(&order.draw(&mut order.canvas()?, app_state)?).map_err(failed)?
    };
    if !goes_on(1.0) {
        return Err(ExportError::Stopped);
    }
    stillbase_files::write_new(file, &bytes, force)?;
    Ok(note)
}
