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
