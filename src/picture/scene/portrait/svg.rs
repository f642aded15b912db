//! [`portrait_svg`]: a machine as a small SVG, for pages of any background.

use std::fmt::Write as _;

use super::Portrait;
use crate::scene::Rgba;
use crate::scene::linkage::{FlatCover, FlatLink};
use crate::scene::palette::{Palette, Theme, mix, palette};
use stillbase_exchange::xml::{XmlWriter, quoted};
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;
use stillbase_settings::number::{counted, fixed};

/// Greatest width and height of the machine, px.
const SIZE_PX: [f64; 2] = [400.0, 250.0];
/// Space around it, px.
const MARGIN_PX: f64 = 14.0;
/// Height of the line below it, with scale and drives, px.
const LINE_PX: f64 = 24.0;
/// Half the width of a bar is this or more, px.
const MIN_RADIUS_PX: f64 = 2.2;
/// Half the width and the height of the symbol of the ground, and the length of its hatching, px.
const GROUND_PX: [f64; 3] = [18.0, 20.0, 6.0];
/// Greatest part of the width that the scale takes.
const SCALE_FRACTION: f64 = 0.25;
/// Names of the drives are left out if they have more characters than this.
const MAX_CHARACTERS: usize = 36;

/// Colours between those of the two themes, which stand out on a light and on a dark background.
struct Tones {
    dark: Palette,
    light: Palette,
}

impl Tones {
    fn new() -> Self {
        Self { dark: palette(Theme::Dark), light: palette(Theme::Light) }
    }

    fn drive(&self, drive: usize) -> Rgba {
        mix(self.dark.drive(drive), self.light.drive(drive), 0.5)
    }

    /// Colour of the edge of a body, which separates it from others of its colour.
    fn edge(tone: Rgba) -> Rgba {
        mix(tone, [0.0, 0.0, 0.0, 1.0], 0.5)
    }

    fn grey(&self) -> Rgba {
        mix(self.dark.dim, self.light.dim, 0.5)
    }

    fn tip(&self) -> Rgba {
        mix(self.dark.amber, self.light.amber, 0.5)
    }
}

/// Returns a machine as an SVG element without a background: links in the colours of their drives, with what they
/// carry, pins, the base as hatched ground, the end effector as a ring, and a scale.
pub fn portrait_svg(machine: &Machine) -> String {
    let portrait = Portrait::of(machine);
    let frame = Frame::of(&portrait);
    let tones = Tones::new();
    let [width, height] = frame.size.map(|x| fixed(x.ceil(), 0));
    let title = format!("{}: {}, {} kg", machine.name(), counted(machine.drives(), "drive"), fixed(machine.mass(), 3));
    let title = quoted(&title);
    let mut lines = XmlWriter::default();
    lines.add(
        0,
        format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{title}\" \
             style=\"max-width:100%;height:auto\" stroke-linecap=\"round\" stroke-linejoin=\"round\">"
        ),
    );
    lines.add(1, format_args!("<title>{title}</title>"));
    ground(&mut lines, &frame, &tones);
    let drives = &machine.spec().drives;
    for link in &portrait.links {
        let drive = drives.get(link.drive).map_or("", |drive| drive.name.as_str());
        lines.add(1, format_args!("<g>"));
        lines.add(2, format_args!("<title>link {}, drive {}</title>", quoted(&link.name), quoted(drive)));
        body(&mut lines, &frame, link, tones.drive(link.drive));
        lines.add(1, format_args!("</g>"));
    }
    for pin in &portrait.pins {
        disc(&mut lines, frame.place(*pin), 2.4, &format!("fill=\"#ffffff\" {}", stroke([0.1, 0.1, 0.1, 1.0], 1.0)));
    }
    disc(
        &mut lines,
        frame.place(Vector::default()),
        3.6,
        &format!("fill=\"#ffffff\" {}", stroke([0.1, 0.1, 0.1, 1.0], 1.6)),
    );
    let tip = frame.place(portrait.tip);
    // An edge keeps the ring apart from links of any colour.
    for (tone, width) in [([0.1, 0.1, 0.1, 1.0], 4.4), ([1.0; 4], 3.4), (tones.tip(), 2.0)] {
        disc(&mut lines, tip, 6.0, &format!("fill=\"none\" {}", stroke(tone, width)));
    }
    scale(&mut lines, &frame, &tones);
    names(&mut lines, &frame, &tones, machine);
    lines.add(0, format_args!("</svg>"));
    lines.into_text()
}

/// Where places lie in the picture.
struct Frame {
    /// Pixels a metre.
    scale: f64,
    /// Place of the origin, px from the left and from the top.
    origin: [f64; 2],
    /// Width and height, px.
    size: [f64; 2],
    /// Direction of the ground from the base, in pixels.
    down: [f64; 2],
}

impl Frame {
    fn of(portrait: &Portrait) -> Self {
        let [low, high] = portrait.bounds;
        let extent = high - low;
        let scale = (SIZE_PX[0] / extent.re).min(SIZE_PX[1] / extent.im);
        // The ground lies below, unless less of the machine is on another side.
        let sides = [[0.0, 1.0], [-1.0, 0.0], [1.0, 0.0], [0.0, -1.0]];
        let hidden = |side: &[f64; 2]| covered(portrait, scale, *side);
        let down = sides.into_iter().min_by(|a, b| hidden(a).total_cmp(&hidden(b))).unwrap_or(sides[0]);
        // What the ground takes beyond the machine, px.
        let [half, high_px, hatch] = GROUND_PX;
        let corner = |across: f64, along: f64| {
            let [x, y] = down;
            [along * x + across * y, along * y + across * x]
        };
        let mut box_px = [scale * low.re, -scale * high.im, scale * high.re, -scale * low.im];
        for [x, y] in [corner(half, high_px + hatch), corner(-half, high_px + hatch)] {
            box_px = [box_px[0].min(x), box_px[1].min(y), box_px[2].max(x), box_px[3].max(y)];
        }
        let [left, top, right, bottom] = box_px;
        Self {
            scale,
            origin: [MARGIN_PX - left, MARGIN_PX - top],
            size: [right - left + 2.0 * MARGIN_PX, bottom - top + 2.0 * MARGIN_PX + LINE_PX],
            down,
        }
    }

    /// Returns where a place of the machine lies, px.
    fn place(&self, at: Vector) -> [f64; 2] {
        [self.origin[0] + self.scale * at.re, self.origin[1] - self.scale * at.im]
    }

    /// Returns a length, px.
    fn length(&self, metres: f64) -> f64 {
        self.scale * metres
    }
}

/// Returns how much of the machine lies where the ground would, in a direction from the base: the number of points along
/// its bars and counterweights, px. The picture has a scale in px/m.
fn covered(portrait: &Portrait, scale: f64, [x, y]: [f64; 2]) -> f64 {
    const POINTS: usize = 9;
    let [half, height, hatch] = GROUND_PX;
    let is_covered = |at: Vector, radius: f64| {
        let (right, up) = (scale * at.re, scale * at.im);
        let (along, across) = (right * x - up * y, right * y + up * x);
        let radius = scale * radius;
        along + radius > 0.5 * height && along - radius < height + hatch && across.abs() < half + radius
    };
    let bars = portrait.links.iter().map(|link| (link.ends, link.radius));
    let weights = portrait.links.iter().flat_map(|link| link.covers.iter().map(|cover| (cover.ends, cover.radius)));
    let points = bars.chain(weights).flat_map(|([from, to], radius)| {
        let share = |i: usize| i as f64 / (POINTS - 1) as f64;
        (0..POINTS).map(move |i| (from + (to - from) * share(i), radius))
    });
    points.filter(|(at, radius)| is_covered(*at, *radius)).count() as f64
}

/// Draws a link with what it carries: all edges first, so that none crosses the body.
fn body(lines: &mut XmlWriter, frame: &Frame, link: &FlatLink, tone: Rgba) {
    let edge = Tones::edge(tone);
    for is_edge in [true, false] {
        let (colour, beyond) = if is_edge { (edge, 1.0) } else { (tone, 0.0) };
        if link.radius > 0.0 {
            let radius = frame.length(link.radius).max(MIN_RADIUS_PX);
            capsule(lines, link.ends.map(|at| frame.place(at)), radius + beyond, colour);
        }
        for cover in &link.covers {
            draw_cover(lines, frame, cover, colour, beyond);
        }
    }
}

fn draw_cover(lines: &mut XmlWriter, frame: &Frame, cover: &FlatCover, colour: Rgba, beyond: f64) {
    if cover.areas.is_empty() {
        capsule(lines, cover.ends.map(|at| frame.place(at)), frame.length(cover.radius) + beyond, colour);
        return;
    }
    let mut path = String::new();
    for area in &cover.areas {
        for (i, corner) in area.iter().enumerate() {
            // Writing to a `String` never fails.
            let _ = write!(path, "{}{}", if i == 0 { 'M' } else { 'L' }, point(frame.place(*corner)));
        }
        path.push('Z');
    }
    // A stroke of the same colour closes the seams between the pieces of an area.
    lines.add(
        2,
        format_args!("<path d=\"{path}\" fill=\"{}\" {}/>", colour_word(colour), stroke(colour, 0.4 + 2.0 * beyond)),
    );
}

/// Draws all that lies within a distance from a segment.
fn capsule(lines: &mut XmlWriter, [from, to]: [[f64; 2]; 2], radius: f64, colour: Rgba) {
    let apart = (to[0] - from[0]).hypot(to[1] - from[1]);
    if apart < 0.05 {
        return lines.add(2, format_args!("<circle {} fill=\"{}\"/>", round(from, radius), colour_word(colour)));
    }
    let path = format!("M{}L{}", point(from), point(to));
    lines.add(2, format_args!("<path d=\"{path}\" fill=\"none\" {}/>", stroke(colour, 2.0 * radius)));
}

fn disc(lines: &mut XmlWriter, at: [f64; 2], radius: f64, paint: &str) {
    lines.add(1, format_args!("<circle {} {paint}/>", round(at, radius)));
}

/// Draws the symbol of the ground: a support with a hatched line.
fn ground(lines: &mut XmlWriter, frame: &Frame, tones: &Tones) {
    let [half, height, hatch] = GROUND_PX;
    let [x, y] = frame.down;
    let at = |across: f64, along: f64| {
        point([frame.origin[0] + along * x + across * y, frame.origin[1] + along * y - across * x])
    };
    let mut path = format!("M{}L{}L{}Z", at(0.0, 0.0), at(-0.6 * half, height), at(0.6 * half, height));
    let _ = write!(path, "M{}L{}", at(-half, height), at(half, height));
    for i in 0..6 {
        let across = half * (f64::from(i) / 2.5 - 1.0);
        let _ = write!(path, "M{}L{}", at(across, height), at(across - 0.8 * hatch, height + hatch));
    }
    lines.add(1, format_args!("<path d=\"{path}\" fill=\"none\" {}/>", stroke(tones.grey(), 1.6)));
}

/// Draws a scale: a line with its length.
fn scale(lines: &mut XmlWriter, frame: &Frame, tones: &Tones) {
    let most = SCALE_FRACTION * (frame.size[0] - 2.0 * MARGIN_PX) / frame.scale;
    let decade = 10.0_f64.powf(most.log10().floor());
    let metres = decade * [5.0, 2.0].into_iter().find(|step| step * decade <= most).unwrap_or(1.0);
    let words = match metres {
        short if short < 0.0995 => format!("{} mm", fixed(1e3 * short, 6).trim_end_matches('0').trim_end_matches('.')),
        long => format!("{} m", fixed(long, 1).trim_end_matches('0').trim_end_matches('.')),
    };
    let (left, y) = (MARGIN_PX, frame.size[1] - MARGIN_PX);
    let right = left + frame.length(metres);
    let path =
        format!("M{}L{}L{}L{}", point([left, y - 4.0]), point([left, y]), point([right, y]), point([right, y - 4.0]));
    lines.add(1, format_args!("<path d=\"{path}\" fill=\"none\" {}/>", stroke(tones.grey(), 1.2)));
    text(lines, [right + 6.0, y], "start", &format!("<tspan {}>{words}</tspan>", fill(tones.grey())));
}

/// Writes the names of the drives, each with its colour.
fn names(lines: &mut XmlWriter, frame: &Frame, tones: &Tones, machine: &Machine) {
    let drives = &machine.spec().drives;
    let characters: usize = drives.iter().map(|drive| drive.name.chars().count() + 3).sum();
    if characters > MAX_CHARACTERS {
        return;
    }
    let mut words = format!("<tspan {}>drive</tspan>", fill(tones.grey()));
    for (i, drive) in drives.iter().enumerate() {
        let gap = if i == 0 { 6 } else { 12 };
        let (dot, name) = (fill(tones.drive(i)), fill(tones.grey()));
        let _ =
            write!(words, "<tspan dx=\"{gap}\" {dot}>●</tspan><tspan dx=\"4\" {name}>{}</tspan>", quoted(&drive.name));
    }
    text(lines, [frame.size[0] - MARGIN_PX, frame.size[1] - MARGIN_PX], "end", &words);
}

fn text(lines: &mut XmlWriter, [x, y]: [f64; 2], anchor: &str, words: &str) {
    let (x, y) = (fixed(x, 1), fixed(y, 1));
    lines.add(
        1,
        format_args!(
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" font-family=\"sans-serif\" \
             font-size=\"11\">{words}</text>"
        ),
    );
}

fn round(at: [f64; 2], radius: f64) -> String {
    let [x, y, r] = [at[0], at[1], radius].map(|x| fixed(x, 1));
    format!("cx=\"{x}\" cy=\"{y}\" r=\"{r}\"")
}

/// Writes a place, to a tenth of a pixel.
fn point(at: [f64; 2]) -> String {
    let [x, y] = at.map(|x| fixed(x, 1));
    format!("{x} {y}")
}

fn fill(colour: Rgba) -> String {
    format!("fill=\"{}\"", colour_word(colour))
}

fn stroke(colour: Rgba, width: f64) -> String {
    format!("stroke=\"{}\" stroke-width=\"{}\"", colour_word(colour), fixed(width, 1))
}

fn colour_word([r, g, b, _]: Rgba) -> String {
    let [r, g, b] = [r, g, b].map(|x| (255.0 * x).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
