//! A picture of the window or its scene.

use std::path::Path;

use super::ExportError;
use crate::AppState;
use crate::shot::PictureOrder;

/// Draws the instant that `app_state` shows and writes it as PNG.
///
/// # Errors
/// If the picture cannot be drawn or written.
pub fn write_picture(
    app_state: &mut AppState,
    order: &PictureOrder,
    file: &Path,
    force: bool,
) -> Result<(), ExportError> {
    let picture = order.draw(&mut order.canvas()?, app_state)?;
    let png = picture.to_png().map_err(|source| ExportError::Encoding { file: file.into(), source })?;
    Ok(stillbase_files::write_new(file, &png, force)?)
}
