//! A picture of the window or its scene.

use std::path::Path;

use super::ExportError;
use crate::AppState;
use crate::shot::PictureOrder;

/// Draws the instant that `app_state` shows and writes it as PNG, unless `goes_on` stops it before.
///
/// # Errors
/// If the picture cannot be drawn or written, or is stopped.
pub fn write_picture(
    app_state: &mut AppState,
    order: &PictureOrder,
    file: &Path,
    force: bool,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<(), ExportError> {
    stillbase_files::check_new(file, force)?;
    let picture = order.draw(&mut order.canvas()?, app_state)?;
    let png = picture.to_png().map_err(|source| ExportError::Encoding { file: file.into(), source })?;
    if !goes_on(1.0) {
        return Err(ExportError::Stopped);
    }
    Ok(stillbase_files::write_new(file, &png, force)?)
}
