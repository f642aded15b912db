//! A [`Film`]: pictures in a row as one file, an animated GIF, PNG or WebP that plays over and over.

use std::io::{self, Write};

use gif::{DisposalMethod, Encoder, Frame, Repeat};

use crate::render::offscreen::{Picture, png_encoder};
use crate::webp::WebpFilm;

/// Format of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmFormat {
    /// GIF: 256 colours a picture; every browser and slide program plays it.
    Gif,
    /// Animated PNG: all colours; browsers play it.
    Png,
    /// Animated WebP: all colours without loss, smaller than PNG; browsers play it.
    Webp,
}

/// Speed of the choice of colours, 1 (best) to 30.
const QUANTISATION_SPEED: i32 = 10;
/// Number of units in which a GIF counts the delays between pictures, per second.
const GIF_DELAYS_PER_SECOND: f64 = 100.0;
/// Number of units in which a WebP counts them, and the largest such count.
const WEBP_DELAYS_PER_SECOND: f64 = 1000.0;
const MAX_WEBP_DELAY: f64 = 16_777_215.0;
/// Longest time that a picture may stay, s: an animated PNG cannot say a longer one.
const MAX_DELAY_S: f64 = 65_535.0;

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
    Webp(W, WebpFilm),
}

impl<W: Write> Film<W> {
    /// Begins a film of `count` pictures of a size in pixels, shown at `fps` pictures per second.
    ///
    /// # Errors
    /// If the head cannot be written, a side of a GIF is longer than 65,535 pixels, `count` is 0 for a PNG, or a picture
    /// would stay longer than 65,535 s.
    pub fn begin(to: W, format: FilmFormat, [width, height]: [u32; 2], count: u32, fps: f64) -> io::Result<Self> {
        let is_shown = (0.0..=MAX_DELAY_S).contains(&(1.0 / fps));
        if !is_shown {
            let why = format!("{fps} pictures per second: want at least one in {MAX_DELAY_S} s");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
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
                let [numerator, denominator] = png_delay(1.0 / fps);
                encoder.set_frame_delay(numerator, denominator)?;
                FilmEncoder::Png(encoder.write_header()?)
            }
            FilmFormat::Webp => FilmEncoder::Webp(to, WebpFilm::new([width, height])),
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
                whole_or_none(&mut rgba);
                let mut frame = Frame::from_rgba_speed(width, height, &mut rgba, QUANTISATION_SPEED);
                // Nothing of a picture shows through the transparent parts of the next.
                frame.dispose = if frame.transparent.is_some() { DisposalMethod::Background } else { frame.dispose };
                // Rounded sums, not the rounded delay, so that the film is as long as the run.
                let until = |count: u32| (f64::from(count) * GIF_DELAYS_PER_SECOND / self.fps).round() as u64;
                let mut delay = until(self.count + 1) - until(self.count);
                frame.delay = first_part(&mut delay);
                encoder.write_frame(&frame).map_err(io::Error::other)?;
                // A picture that stays longer than a GIF can say stays under pictures of its first pixel.
                let mut pixel = rgba.get(..4).map(<[u8]>::to_vec).unwrap_or_default();
                while delay > 0 && pixel.len() == 4 {
                    let mut frame = Frame::from_rgba_speed(1, 1, &mut pixel, QUANTISATION_SPEED);
                    frame.delay = first_part(&mut delay);
                    encoder.write_frame(&frame).map_err(io::Error::other)?;
                }
            }
            FilmEncoder::Png(writer) => writer.write_image_data(&picture.rgba)?,
            FilmEncoder::Webp(_, film) => {
                // As for a GIF: rounded sums.
                let until = |count: u32| (f64::from(count) * WEBP_DELAYS_PER_SECOND / self.fps).round();
                film.push(&picture, (until(self.count + 1) - until(self.count)).min(MAX_WEBP_DELAY) as u32)?;
            }
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
            FilmEncoder::Webp(to, film) => film.write(to),
        }
    }
}

/// Makes each pixel opaque or transparent, whichever it is more nearly: a GIF knows nothing between.
fn whole_or_none(rgba: &mut [u8]) {
    for pixel in rgba.chunks_exact_mut(4) {
        pixel[3] = if pixel[3] < 128 { 0 } else { 255 };
    }
}

/// Takes as much of a delay as a picture of a GIF can say.
fn first_part(delay: &mut u64) -> u16 {
    let part = u16::try_from(*delay).unwrap_or(u16::MAX);
    *delay -= u64::from(part);
    part
}

/// Returns numerator and denominator of a delay, s: one is a power of ten up to 1000, the other rounded to 16 bits.
fn png_delay(delay: f64) -> [u16; 2] {
    let most = f64::from(u16::MAX);
    // The smaller of the two numbers is the power of ten.
    let (longer, round) = (delay.max(1.0 / delay), [1000.0, 100.0, 10.0, 1.0]);
    let round = round.into_iter().find(|round| (round * longer).round() <= most).unwrap_or(1.0);
    let other = (round * longer).round().min(most);
    if delay < 1.0 { [round as u16, other as u16] } else { [other as u16, round as u16] }
}
