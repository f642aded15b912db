//! Pictures as WebP without loss, and films of them.

use std::io::{self, Write};

use image_webp::{ColorType, WebPEncoder};

use crate::render::offscreen::Picture;

/// Largest side of a picture, pixels.
const MAX_SIDE: u32 = 16_384;
/// Length of the head of a file before the picture, bytes, and of that of each part.
const FILE_HEAD: usize = 12;
const PART_HEAD: usize = 8;
/// Bits of the head of a film: it moves, and it has transparent parts.
const IS_FILM: u8 = 0x02;
const HAS_ALPHA: u8 = 0x10;
/// Bit of a picture of a film: it replaces what is under it.
const REPLACES: u8 = 0x02;

/// Returns a picture as a file.
///
/// # Errors
/// If a side is longer than 16,384 pixels, or 0.
pub fn still(picture: &Picture) -> io::Result<Vec<u8>> {
    let Picture { width, height, rgba } = picture;
    let fits = |side: &u32| (1..=MAX_SIDE).contains(side);
    if !(fits(width) && fits(height) && rgba.len() as u64 == 4 * u64::from(*width) * u64::from(*height)) {
        let why = format!("{width} x {height} pixels: want sides of 1 to {MAX_SIDE} for .webp");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
    }
    let mut bytes = Vec::new();
    WebPEncoder::new(&mut bytes).encode(rgba, *width, *height, ColorType::Rgba8).map_err(io::Error::other)?;
    Ok(bytes)
}

/// A film that is being put together.
#[derive(Debug)]
pub struct WebpFilm {
    size: [u32; 2],
    /// The pictures so far, as parts of the file.
    parts: Vec<u8>,
}

impl WebpFilm {
    /// Begins a film of a size in pixels.
    pub fn new(size: [u32; 2]) -> Self {
        Self { size, parts: Vec::new() }
    }

    /// Adds a picture, shown for a time, ms.
    ///
    /// # Errors
    /// As [`still`], or if its size is not that of the film.
    pub fn push(&mut self, picture: &Picture, milliseconds: u32) -> io::Result<()> {
        if [picture.width, picture.height] != self.size {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the pictures differ in size"));
        }
        let file = still(picture)?;
        // What follows the head of the file is the picture itself, as one part.
        let own = file.get(FILE_HEAD..).unwrap_or_default();
        let mut head = Vec::with_capacity(16);
        for number in [0, 0, self.size[0] - 1, self.size[1] - 1, milliseconds] {
            head.extend(three_bytes(number));
        }
        head.push(REPLACES);
        part(&mut self.parts, b"ANMF", &[&head, own]);
        Ok(())
    }

    /// Writes the file, which plays over and over.
    ///
    /// # Errors
    /// If it cannot be written, or is longer than 4 GiB.
    pub fn write(self, mut to: impl Write) -> io::Result<()> {
        let [width, height] = self.size.map(|side| three_bytes(side.saturating_sub(1)));
        let mut content = b"WEBP".to_vec();
        part(&mut content, b"VP8X", &[&[IS_FILM | HAS_ALPHA, 0, 0, 0], &width, &height]);
        // No colour behind it, and no end.
        part(&mut content, b"ANIM", &[&[0; 4], &[0; 2]]);
        let length = u32::try_from(content.len() + self.parts.len()).map_err(io::Error::other)?;
        to.write_all(b"RIFF")?;
        to.write_all(&length.to_le_bytes())?;
        to.write_all(&content)?;
        to.write_all(&self.parts)
    }
}

fn three_bytes(number: u32) -> [u8; 3] {
    let [a, b, c, _] = number.to_le_bytes();
    [a, b, c]
}

/// Appends a part of a file: its name, its length, its content, and a byte that makes its length even.
fn part(to: &mut Vec<u8>, name: &[u8; 4], content: &[&[u8]]) {
    let length: usize = content.iter().map(|bytes| bytes.len()).sum();
    to.reserve(PART_HEAD + length + 1);
    to.extend(name);
    to.extend((length as u32).to_le_bytes());
    content.iter().for_each(|bytes| to.extend(*bytes));
    to.extend((!length.is_multiple_of(2)).then_some(0));
}
