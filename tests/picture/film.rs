//! Films: what is written is read back by decoders of others, picture by picture.

use std::io::Cursor;

use stillbase::picture::film::{Film, FilmFormat};
use stillbase::picture::render::offscreen::Picture;

const SIZE: [u32; 2] = [24, 16];
const COUNT: u32 = 8;
const FPS: f64 = 30.0;

/// A picture with a bright square that moves to the right.
fn picture(i: u32) -> Picture {
    let [width, height] = SIZE;
    let is_square = |x: u32, y: u32| (2 * i..2 * i + 4).contains(&x) && (4..8).contains(&y);
    let pixel = |at: u32| if is_square(at % width, at / width) { [240, 184, 74, 255] } else { [17, 19, 23, 255] };
    Picture { width, height, rgba: (0..width * height).flat_map(pixel).collect() }
}

fn film(format: FilmFormat) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut film = Film::begin(&mut bytes, format, SIZE, COUNT, FPS).expect("a head");
    (0..COUNT).for_each(|i| film.push(picture(i)).expect("a picture"));
    film.finish().expect("an end");
    bytes
}

#[test]
fn an_animated_png_holds_every_picture_and_its_time() {
    let bytes = film(FilmFormat::Png);
    let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG");
    let animation = *reader.info().animation_control().expect("animated");
    assert_eq!((animation.num_frames, animation.num_plays), (COUNT, 0), "it plays over and over");
    for i in 0..COUNT {
        let mut rgba = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut rgba).expect("a picture");
        assert_eq!(rgba, picture(i).rgba, "picture {i}");
        let control = reader.info().frame_control().expect("a time");
        let delay = f64::from(control.delay_num) / f64::from(control.delay_den);
        assert!((delay - 1.0 / FPS).abs() < 1e-4, "{delay} s");
    }
}

#[test]
fn a_gif_holds_every_picture_and_is_as_long_as_the_run() {
    let bytes = film(FilmFormat::Gif);
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(Cursor::new(&bytes)).expect("a GIF");
    let (mut count, mut delay) = (0, 0);
    while let Some(frame) = decoder.read_next_frame().expect("a picture") {
        let wanted = picture(count).rgba;
        let far = frame.buffer.iter().zip(&wanted).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(frame.buffer.len() == wanted.len() && far <= Some(8), "picture {count} is off by {far:?}");
        (count, delay) = (count + 1, delay + u32::from(frame.delay));
    }
    assert_eq!(count, COUNT);
    assert!((f64::from(delay) / 100.0 - f64::from(COUNT) / FPS).abs() <= 0.005, "{delay} hundredths of a second");
}

/// The delay of each picture, s, as a decoder of others reads it; pictures of a GIF that show the same are added up.
fn delays(format: FilmFormat, count: u32, fps: f64) -> Vec<f64> {
    let mut bytes = Vec::new();
    let mut film = Film::begin(&mut bytes, format, SIZE, count, fps).expect("a head");
    (0..count).for_each(|i| film.push(picture(i)).expect("a picture"));
    film.finish().expect("an end");
    let mut delays = Vec::new();
    if format == FilmFormat::Gif {
        let mut decoder = gif::DecodeOptions::new().read_info(Cursor::new(&bytes)).expect("a GIF");
        while let Some(frame) = decoder.read_next_frame().expect("a picture") {
            let delay = f64::from(frame.delay) / 100.0;
            match [u32::from(frame.width), u32::from(frame.height)] == SIZE {
                true => delays.push(delay),
                false => *delays.last_mut().expect("one before") += delay,
            }
        }
        return delays;
    }
    let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG");
    for _ in 0..count {
        let mut rgba = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut rgba).expect("a picture");
        let control = reader.info().frame_control().expect("a time");
        delays.push(f64::from(control.delay_num) / f64::from(control.delay_den));
    }
    delays
}

/// Neither many pictures nor long ones make a film shorter than the run.
#[test]
fn a_long_film_is_as_long_as_the_run() {
    for (count, fps) in [(800, 1.0), (3, 0.001), (2, 0.000_4), (5, 0.3), (4, 29.97), (4, 240.0)] {
        for format in [FilmFormat::Gif, FilmFormat::Png] {
            let (delays, wanted) = (delays(format, count, fps), 1.0 / fps);
            assert_eq!(delays.len(), count as usize, "{format:?} at {fps}");
            // A GIF counts in hundredths of a second, an animated PNG by fractions of 16 bits.
            let off = if format == FilmFormat::Gif { 0.01 } else { 5e-4 * wanted };
            assert!(delays.iter().all(|delay| (delay - wanted).abs() <= off), "{format:?} at {fps}: {delays:?}");
            let all: f64 = delays.iter().sum();
            assert!((all - f64::from(count) * wanted).abs() <= 0.005 + 5e-4 * all, "{format:?} at {fps}: {all} s");
        }
    }
}

#[test]
fn a_picture_that_would_stay_for_days_is_refused() {
    for (format, fps) in [(FilmFormat::Gif, 1e-5), (FilmFormat::Png, 1e-5), (FilmFormat::Gif, 0.0)] {
        let begun = Film::begin(Vec::new(), format, SIZE, COUNT, fps).map(|_| ());
        let why = begun.expect_err("too slow").to_string();
        assert!(why.contains("pictures per second: want at least one in 65535 s"), "{why}");
    }
}

#[test]
fn an_animated_webp_holds_every_picture_and_is_as_long_as_the_run() {
    let bytes = film(FilmFormat::Webp);
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(&bytes)).expect("a WebP");
    assert!(decoder.is_animated());
    assert_eq!(decoder.dimensions(), (SIZE[0], SIZE[1]));
    assert_eq!((decoder.num_frames(), decoder.loop_count()), (COUNT, image_webp::LoopCount::Forever));
    let (mut rgba, mut length) = (vec![0; decoder.output_buffer_size().expect("a size")], 0);
    for i in 0..COUNT {
        length += decoder.read_frame(&mut rgba).expect("a picture");
        assert_eq!(rgba, picture(i).rgba, "picture {i}");
    }
    assert!((f64::from(length) - 1000.0 * f64::from(COUNT) / FPS).abs() <= 0.5, "{length} ms");
}

#[test]
fn a_still_webp_holds_every_pixel() {
    let mut clear = picture(3);
    clear.rgba.iter_mut().skip(3).step_by(8).for_each(|alpha| *alpha = 0);
    let bytes = stillbase::picture::webp::still(&clear).expect("a file");
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(&bytes)).expect("a WebP");
    let mut rgba = vec![0; decoder.output_buffer_size().expect("a size")];
    decoder.read_image(&mut rgba).expect("a picture");
    assert_eq!(rgba, clear.rgba);
    let none = stillbase::picture::render::offscreen::Picture { width: 0, height: 4, rgba: Vec::new() };
    assert!(stillbase::picture::webp::still(&none).is_err(), "no pixels");
}

/// A picture with a square that moves to the right over nothing.
fn clear_picture(i: u32) -> Picture {
    let mut own = picture(i);
    for pixel in own.rgba.chunks_exact_mut(4) {
        pixel[3] = if pixel[0] == 240 { 255 } else { 0 };
    }
    own
}

/// What is transparent stays so in every format, and nothing of a picture stands in the next.
#[test]
fn a_film_may_be_transparent() {
    let written = |format: FilmFormat| {
        let mut bytes = Vec::new();
        let mut film = Film::begin(&mut bytes, format, SIZE, COUNT, FPS).expect("a head");
        (0..COUNT).for_each(|i| film.push(clear_picture(i)).expect("a picture"));
        film.finish().expect("an end");
        bytes
    };
    let alpha = |rgba: &[u8]| rgba.chunks_exact(4).map(|pixel| pixel[3]).collect::<Vec<_>>();
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let bytes = written(FilmFormat::Gif);
    let mut decoder = options.read_info(Cursor::new(&bytes)).expect("a GIF");
    for i in 0..COUNT {
        let frame = decoder.read_next_frame().expect("a GIF").expect("a picture");
        assert_eq!(alpha(&frame.buffer), alpha(&clear_picture(i).rgba), "picture {i} of the GIF");
        assert_eq!(frame.dispose, gif::DisposalMethod::Background, "it goes before the next comes");
    }
    let bytes = written(FilmFormat::Png);
    let mut reader = png::Decoder::new(Cursor::new(&bytes)).read_info().expect("a PNG");
    for i in 0..COUNT {
        let mut rgba = vec![0; reader.output_buffer_size().expect("a size")];
        reader.next_frame(&mut rgba).expect("a picture");
        assert_eq!(rgba, clear_picture(i).rgba, "picture {i} of the PNG");
        let control = reader.info().frame_control().expect("its control");
        assert_eq!(control.blend_op, png::BlendOp::Source, "it replaces what was there");
    }
    let bytes = written(FilmFormat::Webp);
    let mut decoder = image_webp::WebPDecoder::new(Cursor::new(&bytes)).expect("a WebP");
    for i in 0..COUNT {
        let mut rgba = vec![0; decoder.output_buffer_size().expect("a size")];
        decoder.read_frame(&mut rgba).expect("a picture");
        assert_eq!(alpha(&rgba), alpha(&clear_picture(i).rgba), "picture {i} of the WebP");
    }
}
