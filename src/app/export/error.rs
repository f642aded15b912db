//! [`ExportError`]: why a result was not written.

use std::io;
use std::path::PathBuf;

use stillbase_files::WriteError;
use stillbase_files::row_file::RowError;
use stillbase_files::video::VideoError;
use stillbase_picture::render::offscreen::{NoAdapter, NoPicture};

/// Why a result was not written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Rows cannot be written.
    #[error(transparent)]
    Rows(#[from] RowError),
    /// The film cannot be encoded by the system's encoder.
    #[error(transparent)]
    Video(#[from] VideoError),
    /// No GPU adapter can be used.
    #[error(transparent)]
    Adapter(#[from] NoAdapter),
    /// A picture cannot be drawn or read back.
    #[error(transparent)]
    Picture(#[from] NoPicture),
    /// A picture cannot be encoded or written.
    #[error("{}: {source}: want a place that can be written", file.display())]
    Encoding {
        /// The file.
        file: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// No picture has this ending.
    #[error("{}: want a name that ends in .png, .webp, .svg or .pdf", .0.display())]
    PictureEnding(PathBuf),
    /// The picture cannot be drawn as outlines.
    #[error("{}: {why}", file.display())]
    NoOutlines {
        /// The file.
        file: PathBuf,
        /// The reason, and what would be right.
        why: &'static str,
    },
    /// No film has this ending.
    #[error(
        "{}: want a name that ends in .gif, .png, .webp or .mp4, or without an ending a folder of pictures",
        .0.display()
    )]
    FilmEnding(PathBuf),
    /// The film cannot be transparent.
    #[error("{}: a film in MP4 has no transparency: want .gif, .png, .webp, or a folder of pictures", .0.display())]
    NoTransparency(PathBuf),
    /// The film would be too long.
    #[error("a film of {count} pictures: want at most {most}, by fewer pictures per second or a shorter time")]
    TooMany {
        /// Number of pictures requested.
        count: f64,
        /// Largest number of pictures.
        most: f64,
    },
    /// The user has stopped it.
    #[error("stopped: no file is left")]
    Stopped,
}
