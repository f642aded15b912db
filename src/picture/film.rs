//! A [`Film`]: pictures in a row as one file, an animated GIF or PNG that plays over and over.

use std::io::{self, Write};

use gif::{Encoder, Frame, Repeat};

use crate::render::offscreen::{Picture, png_encoder};

/// Format of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFormat {
    /// GIF: 256 colours a picture; every browser and slide program plays it.
    Gif,
    /// Animated PNG: all colours; browsers play it.
    Png,
}

/// Speed of the choice of colours, 1 (best) to 30.
const QUANTISATION_SPEED: i32 = 10;
/// Number of units in which a GIF counts the delays between pictures, per second.
const GIF_DELAYS_PER_SECOND: f64 = 100.0;

/// A film that is being written.
pub struct Film<W: Write> {
    encoder: FilmEncoder<W>,
    /// Pictures per second.
    fps: f64,
    /// Pictures so far.
    count: u32,
}

enum FilmEncoder<W: Write> {
    Gif(Encoder<W>),
    Png(png::Writer<W>),
}

impl<W: Write> Film<W> {
    /// Begins a film of `count` pictures of a size in pixels, shown at `fps` pictures per second.
    ///
    /// # Errors
    /// If the head cannot be written, a side of a GIF is longer than 65,535 pixels, or `count` is 0 for a PNG.
    pub fn begin(to: W, format: FilmFormat, [width, height]: [u32; 2], count: u32, fps: f64) -> io::Result<Self> {
        let encoder = match format {
            FilmFormat::Gif => {
                let side = |side: u32| u16::try_from(side).map_err(io::Error::other);
                let mut encoder = Encoder::new(to, side(width)?, side(height)?, &[]).map_err(io::Error::other)?;
                encoder.set_repeat(Repeat::Infinite).map_err(io::Error::other)?;
                FilmEncoder::Gif(encoder)
            }
            FilmFormat::Png => {
                let mut encoder = png_encoder(to, [width, height]);
                encoder.set_animated(count, 0)?;
                encoder.set_frame_delay(1000, (1000.0 * fps).round().clamp(1.0, 65_535.0) as u16)?;
                FilmEncoder::Png(encoder.write_header()?)
            }
        };
        Ok(Self { encoder, fps, count: 0 })
    }

    /// Adds a picture.
    ///
    /// # Errors
    /// If it cannot be written, or if a PNG gets a picture with another number of pixels.
    pub fn push(&mut self, picture: Picture) -> io::Result<()> {
        match &mut self.encoder {
            FilmEncoder::Gif(encoder) => {
                let side = |side: u32| u16::try_from(side).map_err(io::Error::other);
                let (width, height, mut rgba) = (side(picture.width)?, side(picture.height)?, picture.rgba);
                let mut frame = Frame::from_rgba_speed(width, height, &mut rgba, QUANTISATION_SPEED);
                // Differences of rounded sums, so that rounding errors do not add up in films of up to 655 s.
                let until = |count: u32| (f64::from(count) * GIF_DELAYS_PER_SECOND / self.fps).round() as u16;
                frame.delay = until(self.count + 1) - until(self.count);
                encoder.write_frame(&frame).map_err(io::Error::other)?;
            }
            FilmEncoder::Png(writer) => writer.write_image_data(&picture.rgba)?,
        }
        self.count += 1;
        Ok(())
    }

    /// Finishes the file.
    ///
    /// # Errors
    /// If its end cannot be written.
    pub fn finish(self) -> io::Result<()> {
        match self.encoder {
            // The end of a GIF is written when its encoder gives the file back.
            FilmEncoder::Gif(encoder) => encoder.into_inner().map(drop).map_err(io::Error::other),
            FilmEncoder::Png(writer) => Ok(writer.finish()?),
        }
    }
}
