//! [`FilmForm`]: the formats of a film.

use std::path::Path;

use super::ExportError;

/// Format of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmForm {
    /// GIF, with 256 colours a picture.
    Gif,
    /// Animated PNG.
    Png,
    /// Animated WebP.
    Webp,
    /// MP4, which the system's encoder writes.
    Mp4,
    /// A folder of numbered pictures, PNG.
    Frames,
}

impl FilmForm {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Gif, Self::Png, Self::Webp, Self::Mp4, Self::Frames];

    /// Returns the file name extension; empty for a folder.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Gif => "gif",
            Self::Png => "png",
            Self::Webp => "webp",
            Self::Mp4 => "mp4",
            Self::Frames => "",
        }
    }

    /// Returns the name, and what it is good for.
    pub fn words(self) -> [&'static str; 2] {
        match self {
            Self::Gif => ["GIF", "plays everywhere: slides, mail, browsers; 256 colours a picture"],
            Self::Png => ["Animated PNG", "plays in browsers; all colours"],
            Self::Webp => ["Animated WebP", "plays in browsers; all colours, smaller than PNG"],
            Self::Mp4 => ["MP4", "small, for video players; the program ffmpeg writes it and has to be installed"],
            Self::Frames => ["Numbered PNG pictures", "a folder for a video program: frame-00001.png and so on"],
        }
    }

    /// Whether its pictures can be transparent.
    pub fn can_be_transparent(self) -> bool {
        self != Self::Mp4
    }

    /// Returns the format of an extension, in upper or lower case; `None` if there is none.
    pub fn of_ending(ending: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.ending().eq_ignore_ascii_case(ending))
    }

    /// Returns the format of a file by its extension; a name without one is a folder of pictures.
    ///
    /// # Errors
    /// If no film has this extension.
    pub fn of(file: &Path) -> Result<Self, ExportError> {
        let own = file.extension().unwrap_or_default();
        own.to_str().and_then(Self::of_ending).ok_or_else(|| ExportError::FilmEnding(file.into()))
    }
}
