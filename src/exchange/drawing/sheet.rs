//! [`Sheet`]: every link of a machine laid out flat, in rows, without overlap.
//!
//! Lengths are mm, x to the right and y up from the lower left corner of the sheet. A link lies with its axis along x,
//! its root to the left of its tip.

use std::f64::consts::PI;

use super::outline::{Corner, PieceOutline, pieces_of, weight_corners};
use crate::cut::{Cut, CutError, SAME_PIN_DISTANCE, bar_extent};
use stillbase_mechanics::machine::{Counterweight, CounterweightShape, Machine, PartSource, Shape};
use stillbase_settings::number::{counted, fixed};

/// A drawing as plain shapes.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Its title.
    pub title: String,
    /// Width and height, mm.
    pub size: [f64; 2],
    /// Its shapes, in the order in which they are painted.
    pub shapes: Vec<SheetShape>,
}

/// A shape on the sheet, mm.
#[derive(Clone, Debug, PartialEq)]
pub enum SheetShape {
    /// The outline of a link: a horizontal bar with round ends.
    Bar {
        /// Centre of its left end.
        from: [f64; 2],
        /// Distance to the centre of its right end.
        length: f64,
        /// Radius of its ends, half its width.
        radius: f64,
        /// The drive that it follows, counted from 0.
        drive: usize,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// The outline of a part.
    Outline {
        /// Its corners, counter-clockwise.
        corners: Vec<Corner>,
        /// The drive that it follows, counted from 0.
        drive: usize,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// A hole.
    Hole {
        /// Its centre.
        at: [f64; 2],
        /// Its radius.
        radius: f64,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// The outline of a counterweight that is half a ring or a box.
    Weight {
        /// Its corners, counter-clockwise.
        corners: Vec<Corner>,
        /// The drive that it follows, counted from 0.
        drive: usize,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// The outline of a counterweight that is a disc or a ring.
    Disc {
        /// Its centre.
        at: [f64; 2],
        /// Its radius.
        radius: f64,
        /// Its inner radius; 0 for a disc.
        inner_radius: f64,
        /// The drive that it follows, counted from 0.
        drive: usize,
        /// The layer of its link; `None` if links lie in no layers.
        layer: Option<usize>,
    },
    /// A thin line.
    Line([[f64; 2]; 2]),
    /// A centre of mass.
    Mark {
        /// Its centre.
        at: [f64; 2],
        /// Radius of its symbol.
        radius: f64,
    },
    /// A line of text.
    Words {
        /// Position of its anchor on the baseline.
        at: [f64; 2],
        /// Approximate height of its capitals.
        height: f64,
        /// The point of the text that lies at this position.
        anchor: TextAlign,
        /// Its emphasis.
        paint: TextEmphasis,
        /// Its content.
        text: String,
    },
}

/// The point of a text that is at its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextAlign {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
}

/// Emphasis of a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TextEmphasis {
    /// For a name.
    Strong,
    /// For all other text.
    Plain,
}

/// Estimated width of a letter, as a fraction of its height.
const LETTER_WIDTH: f64 = 0.78;
/// Distance between lines of text, as a multiple of their height.
const LINE_SPACING: f64 = 1.7;

impl Sheet {
    /// Draws all links of a machine.
    ///
    /// # Errors
    /// If the links cannot be cut with these dimensions.
    pub fn of(machine: &Machine, cut: &Cut) -> Result<Self, CutError> {
        cut.check(machine)?;
        let longest = machine.resolved_links().iter().map(|part| part.length).fold(0.0, f64::max);
        let height = (1e3 * longest / 140.0).clamp(3.5, 10.0);
        let layers = cut.layers_of(machine);
        let links = 0..machine.links().len();
        let pieces = links.flat_map(|j| {
            let layer = layers.as_ref().map(|layers| layers[j]);
            match pieces_of(machine, j) {
                outlines if outlines.is_empty() => vec![Piece::of(machine, cut, (j, layer), height)],
                outlines => {
                    let of = |(k, outline): (usize, &PieceOutline)| {
                        Piece::of_part(machine, cut, (j, layer), outline, k == 0, height)
                    };
                    outlines.iter().enumerate().map(of).collect()
                }
            }
        });
        let pieces = pieces.collect();
        Ok(laid_out(machine, cut, pieces, height))
    }
}

fn mm(metres: f64) -> String {
    fixed(1e3 * metres, 1)
}

/// Formats a length, m, in mm with the minus sign U+2212, which is as wide as a plus.
fn signed(metres: f64) -> String {
    mm(metres).replace('-', "\u{2212}")
}

fn width_of(text: &str, height: f64) -> f64 {
    text.chars().count() as f64 * LETTER_WIDTH * height
}

/// The drawing of a link with its annotations, with the link's root as origin.
struct Piece {
    shapes: Vec<SheetShape>,
    /// Its extent: left, bottom, right and top, mm.
    reach: [f64; 4],
    /// The layer of its link.
    layer: Option<usize>,
}

impl Piece {
    fn of(machine: &Machine, cut: &Cut, (j, layer): (usize, Option<usize>), height: f64) -> Self {
        let mut piece = Self { shapes: Vec::new(), reach: [0.0; 4], layer };
        let part = &machine.resolved_links()[j];
        let holes = machine.pin_places(j);
        piece.bar(cut, part.drive, bar_extent(machine, j));
        piece.discs(machine, j);
        for at in &holes {
            piece.shapes.push(SheetShape::Hole { at: [1e3 * at, 0.0], radius: 500.0 * cut.pin_diameter, layer });
        }
        piece.centre_of_mass(machine, j, height);
        piece.stations(&holes, part.length, height);
        piece.annotate(machine, j, "", below(machine, cut, j), height);
        piece
    }

    /// Draws one part of a link; the first one shows what belongs to the whole link.
    fn of_part(
        machine: &Machine,
        cut: &Cut,
        (j, layer): (usize, Option<usize>),
        outline: &PieceOutline,
        first: bool,
        height: f64,
    ) -> Self {
        let mut piece = Self { shapes: Vec::new(), reach: [0.0; 4], layer };
        let link = &machine.resolved_links()[j];
        let in_mm = |at: [f64; 2]| at.map(|x| 1e3 * x);
        let corners: Vec<Corner> =
            outline.corners.iter().map(|corner| Corner { at: in_mm(corner.at), ..*corner }).collect();
        for (corner, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let [x, y] = corner.at;
            // A half circle reaches as far beyond its ends as its radius.
            let round = 0.5 * corner.bulge.abs() * (next.at[0] - x).hypot(next.at[1] - y);
            piece.include([x - round, y, x + round, y]);
        }
        piece.shapes.push(SheetShape::Outline { corners, drive: link.drive, layer });
        if first {
            piece.discs(machine, j);
        }
        for (at, diameter) in &outline.holes {
            piece.shapes.push(SheetShape::Hole { at: in_mm(*at), radius: 500.0 * diameter, layer });
        }
        if first {
            piece.centre_of_mass(machine, j, height);
        }
        let places: Vec<f64> = outline.holes.iter().map(|([at, _], _)| *at).collect();
        piece.stations(&sorted(places), link.length, height);
        let part = &machine.spec().parts[outline.part];
        let mut lines = below_part(machine, outline);
        if first {
            lines.extend(below_link(machine, cut, j));
        }
        piece.annotate(machine, j, &format!(" · {}", part.title()), lines, height);
        piece
    }

    fn discs(&mut self, machine: &Machine, j: usize) {
        let drive = machine.resolved_links()[j].drive;
        let layer = self.layer;
        for weight in weights_of(machine, j) {
            let ([from, to], radius) = weight.around();
            let [x, y] = [[from.re, to.re], [from.im, to.im]].map(|ends| ends.map(|x| 1e3 * x));
            let radius = 1e3 * radius;
            self.include([x[0] - radius, y[0] - radius, x[1] + radius, y[1] + radius]);
            let corners = weight_corners(weight);
            if !corners.is_empty() {
                let corners = corners.into_iter().map(|Corner { at, bulge }| Corner { at: at.map(|x| 1e3 * x), bulge });
                self.shapes.push(SheetShape::Weight { corners: corners.collect(), drive, layer });
            } else if radius > 0.0 {
                let inner_radius = 1e3 * weight.inner_radius;
                self.shapes.push(SheetShape::Disc { at: [x[0], y[0]], radius, inner_radius, drive, layer });
            }
        }
    }

    fn centre_of_mass(&mut self, machine: &Machine, j: usize, height: f64) {
        let link = &machine.links()[j];
        let com = [1e3 * link.com, 1e3 * link.com_normal];
        let radius = 0.55 * height;
        self.include([com[0] - radius, com[1] - radius, com[0] + radius, com[1] + radius]);
        if self.shapes.first().is_some_and(|bar| !bar.is_around(com)) {
            // A line shows to which link the mark belongs.
            self.shapes.push(SheetShape::Line([[0.0, 0.0], com]));
        }
        self.shapes.push(SheetShape::Mark { at: com, radius });
    }

    fn include(&mut self, [left, down, right, up]: [f64; 4]) {
        let [l, d, r, u] = self.reach;
        self.reach = [l.min(left), d.min(down), r.max(right), u.max(up)];
    }

    fn bar(&mut self, cut: &Cut, drive: usize, [from, to]: [f64; 2]) {
        let (radius, layer) = (500.0 * cut.bar_width, self.layer);
        self.include([1e3 * from - radius, -radius, 1e3 * to + radius, radius]);
        self.shapes.push(SheetShape::Bar { from: [1e3 * from, 0.0], length: 1e3 * (to - from), radius, drive, layer });
    }

    /// Draws the dimension line with the distances between neighbouring holes, and to the tip.
    fn stations(&mut self, holes: &[f64], tip: f64, height: f64) {
        let mut stations = holes.to_vec();
        if stations.iter().all(|at| (at - tip).abs() > SAME_PIN_DISTANCE) {
            stations.push(tip);
            stations.sort_by(f64::total_cmp);
        }
        let line = self.reach[1] - 2.6 * height;
        for at in &stations {
            let x = 1e3 * at;
            self.shapes.push(SheetShape::Line([[x, line - 0.5 * height], [x, line + 0.5 * height]]));
        }
        for pair in stations.windows(2) {
            let [from, to] = [1e3 * pair[0], 1e3 * pair[1]];
            self.shapes.push(SheetShape::Line([[from, line], [to, line]]));
            let text = mm(pair[1] - pair[0]);
            if width_of(&text, height) < to - from {
                self.words(
                    [0.5 * (from + to), line + 0.45 * height],
                    height,
                    TextAlign::Middle,
                    TextEmphasis::Plain,
                    text,
                );
            }
        }
        self.include([0.0, line - 0.5 * height, 0.0, 0.0]);
    }

    fn words(&mut self, at: [f64; 2], height: f64, anchor: TextAlign, paint: TextEmphasis, text: String) {
        self.shapes.push(SheetShape::Words { at, height, anchor, paint, text });
    }

    /// Writes the link's name above the piece, with `what` it is, and lines of data below.
    fn annotate(&mut self, machine: &Machine, j: usize, what: &str, lines: Vec<String>, height: f64) {
        let (link, part) = (&machine.spec().links[j], &machine.resolved_links()[j]);
        let drive = &machine.spec().drives[part.drive].name;
        let (left, top) = (self.reach[0], self.reach[3] + 1.1 * height);
        let name = format!("link {}{what}", link.name);
        let about = format!("follows drive {drive} · {} kg · {} kg m²", fixed(link.mass, 3), fixed(link.inertia, 6));
        let shift = width_of(&name, 1.3 * height) + height;
        self.words([left, top], 1.3 * height, TextAlign::Start, TextEmphasis::Strong, name);
        self.words([left + shift, top], height, TextAlign::Start, TextEmphasis::Plain, about.clone());
        self.include([left, 0.0, left + shift + width_of(&about, height), top + 1.3 * height]);
        let stacked = self.layer.map(|layer| format!("layer {layer}, {} mm high", signed(link.axial)));
        for line in stacked.into_iter().chain(lines) {
            let at = [left, self.reach[1] - LINE_SPACING * height];
            self.include([left, at[1] - 0.3 * height, left + width_of(&line, height), 0.0]);
            self.words(at, height, TextAlign::Start, TextEmphasis::Plain, line);
        }
    }
}

fn sorted(mut places: Vec<f64>) -> Vec<f64> {
    places.sort_by(f64::total_cmp);
    places.dedup_by(|b, a| *b - *a <= SAME_PIN_DISTANCE);
    places
}

fn weights_of(machine: &Machine, j: usize) -> impl Iterator<Item = &Counterweight> {
    let name = &machine.links()[j].name;
    machine.spec().counterweights.iter().filter(move |weight| weight.link == *name)
}

/// Returns the line of text about holes, m from the root.
fn hole_line(holes: &[f64]) -> String {
    let places: Vec<String> =
        holes.iter().map(|at| if at.abs() <= SAME_PIN_DISTANCE { "0 (root)".into() } else { signed(*at) }).collect();
    if places.is_empty() { "no holes".into() } else { format!("holes at {} mm", places.join(", ")) }
}

/// Returns the lines of text below a link without parts.
fn below(machine: &Machine, cut: &Cut, j: usize) -> Vec<String> {
    let mut lines = vec![hole_line(&machine.pin_places(j))];
    let mut link = below_link(machine, cut, j);
    let discs = link.split_off(link.len() - weights_of(machine, j).count());
    let area = outline_area(machine, cut, j);
    lines.extend(link);
    lines.push(format!("area {} cm²", fixed(1e4 * area, 2)));
    lines.extend(discs);
    lines
}

/// Returns the lines of text about one part of a link.
fn below_part(machine: &Machine, outline: &PieceOutline) -> Vec<String> {
    let spec = machine.spec();
    let mass_of = |part: usize| {
        let body = machine.part_bodies().iter().find(|body| body.source == PartSource::Part(part));
        body.map_or(0.0, |body| body.body.mass)
    };
    let mass: f64 = mass_of(outline.part) + outline.arms.iter().map(|arm| mass_of(*arm)).sum::<f64>();
    let part = &spec.parts[outline.part];
    let along: Vec<f64> = outline.holes.iter().map(|([at, _], _)| *at).collect();
    let mut about = format!("{} kg", fixed(mass, 3));
    if matches!(part.shape, Shape::Tube | Shape::Profile)
        && let Some([from, to]) = machine.part_ends(outline.part)
    {
        about.push_str(&format!(", {} mm long", mm(to - from)));
    }
    let arms: Vec<&str> = outline.arms.iter().map(|arm| spec.parts[*arm].name.as_str()).collect();
    if !arms.is_empty() {
        about.push_str(&format!(", with its {}", arms.join(", ")));
    }
    let widths: Vec<f64> = sorted(outline.holes.iter().map(|(_, diameter)| *diameter).collect());
    let across = match widths[..] {
        [] => String::new(),
        [one] => format!(", Ø {}", mm(one)),
        [first, .., last] => format!(", Ø {} to {}", mm(first), mm(last)),
    };
    let ends = match (part.shape, machine.part_ends(outline.part)) {
        (Shape::Flat, Some([from, to])) => format!("from {} to {} mm along the link · ", signed(from), signed(to)),
        _ => String::new(),
    };
    vec![format!("{about} · {ends}{}{across}", hole_line(&sorted(along)))]
}

/// Returns the lines of text about a whole link: end effector, centre of mass, lumps and counterweights; these last.
fn below_link(machine: &Machine, cut: &Cut, j: usize) -> Vec<String> {
    let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
    let mut lines = Vec::new();
    if machine.end_link() == j {
        let at = part.sign * (machine.end_effector()[part.drive] - part.root[part.drive]);
        lines.push(format!("end effector at {} mm", signed(at)));
    }
    let off = match link.com_normal {
        0.0 => String::new(),
        y => format!(", {} mm to the left of the axis", signed(y)),
    };
    let with = if weights_of(machine, j).next().is_none() { "" } else { " with its counterweights" };
    lines.push(format!("centre of mass{with} at {} mm{off}", signed(link.com)));
    for body in machine.part_bodies().iter().filter(|body| body.link == j) {
        if let PartSource::Lump(_) = body.source {
            let (name, at) = (body.title(machine.spec()), signed(body.body.at));
            lines.push(format!("carries {name}, {} kg at {at} mm", fixed(body.body.mass, 3)));
        }
    }
    lines.extend(weights_of(machine, j).map(|weight| disc(cut, weight)));
    lines
}

/// Returns the area of a bar without its holes, m².
fn outline_area(machine: &Machine, cut: &Cut, j: usize) -> f64 {
    let (holes, [from, to]) = (machine.pin_places(j), bar_extent(machine, j));
    let round = |diameter: f64| 0.25 * PI * diameter * diameter;
    (to - from) * cut.bar_width + round(cut.bar_width) - holes.len() as f64 * round(cut.pin_diameter)
}

/// Returns the line of text about a counterweight.
fn disc(cut: &Cut, weight: &Counterweight) -> String {
    let mass = fixed(weight.mass, 3);
    let beside = match weight.across {
        0.0 => String::new(),
        across => format!(", {} mm left of the axis", signed(across)),
    };
    let at = format!("{} mm{beside}", signed(weight.at));
    let Some(thickness) = cut.thickness_of(weight) else {
        return format!("counterweight at {at}: a point of {mass} kg");
    };
    let own = cut.mass_of(weight, thickness);
    let wanted = match (own - weight.mass).abs() <= 5e-4 {
        true => String::new(),
        false => format!(", not {mass} kg"),
    };
    let size = match weight.shape() {
        CounterweightShape::Box { length, width } => format!("box {} × {} mm", mm(length), mm(width)),
        CounterweightShape::Ring { radius, inner_radius } => {
            format!("ring Ø {} mm, bore Ø {} mm", mm(2.0 * radius), mm(2.0 * inner_radius))
        }
        CounterweightShape::HalfRing { radius, inner_radius } => {
            let (away, circle) = (mm(2.0 * radius), signed(weight.circle_at()));
            let bore =
                if inner_radius > 0.0 { format!(", bore Ø {} mm", mm(2.0 * inner_radius)) } else { String::new() };
            format!("{} Ø {away} mm{bore} about {circle} mm", weight.shape().name())
        }
        CounterweightShape::Point | CounterweightShape::Disc { .. } => format!("Ø {} mm", mm(2.0 * weight.radius)),
    };
    format!("counterweight {size} at {at}: {} mm thick {} kg{wanted}", mm(thickness), fixed(own, 3))
}

/// Arranges the pieces in rows from the top down, with a width that makes the sheet a little wider than high.
fn laid_out(machine: &Machine, cut: &Cut, pieces: Vec<Piece>, height: f64) -> Sheet {
    let margin = 3.0 * height;
    let extent = |piece: &Piece| [piece.reach[2] - piece.reach[0], piece.reach[3] - piece.reach[1]];
    let gap = 2.5 * height;
    let area: f64 = pieces.iter().map(extent).map(|[across, up]| (across + gap) * (up + gap)).sum();
    let widest = pieces.iter().map(|piece| extent(piece)[0]).fold(0.0, f64::max);
    let title = title(machine, cut);
    let titled = title.iter().enumerate().map(|(i, line)| width_of(line, title_height(i, height))).fold(0.0, f64::max);
    let room = widest.max((1.5 * area).sqrt()).max(titled);
    let (mut shapes, mut y) = (Vec::new(), 0.0);
    for (i, text) in title.iter().enumerate() {
        let height = title_height(i, height);
        y -= if i == 0 { height } else { 1.9 * height };
        let paint = if i == 0 { TextEmphasis::Strong } else { TextEmphasis::Plain };
        shapes.push(SheetShape::Words { at: [0.0, y], height, anchor: TextAlign::Start, paint, text: text.clone() });
    }
    y -= height;
    let (mut across, mut row) = (0.0_f64, Vec::new());
    let mut right = titled;
    for piece in pieces {
        let width = extent(&piece)[0];
        if !row.is_empty() && across + width > room {
            y = put(&mut shapes, std::mem::take(&mut row), y - gap);
            across = 0.0;
        }
        row.push((across, piece));
        right = right.max(across + width);
        across += width + gap;
    }
    y = put(&mut shapes, row, y - gap);
    let size = [right + 2.0 * margin, 2.0 * margin - y];
    for shape in &mut shapes {
        shape.shift([margin, size[1] - margin]);
    }
    Sheet { title: machine.name().into(), size, shapes }
}

fn title_height(line: usize, height: f64) -> f64 {
    if line == 0 { 2.2 * height } else { height }
}

/// Returns the lines of the title.
fn title(machine: &Machine, cut: &Cut) -> [String; 3] {
    let links = counted(machine.links().len(), "link");
    let discs = match machine.spec().counterweights.len() {
        0 => String::new(),
        count => {
            let material = format!("{} kg/m³", fixed(cut.density, 0));
            format!(" · {} of {material}", counted(count, "counterweight"))
        }
    };
    let (bars, pins) = (mm(cut.bar_width), mm(cut.pin_diameter));
    let is_of_parts = |j: usize| !pieces_of(machine, j).is_empty();
    let outlines = match (0..machine.links().len()).all(is_of_parts) {
        true => "outlines and holes as they are weighed".into(),
        false => format!("bars {bars} wide with round ends · holes Ø {pins}"),
    };
    [
        machine.name().into(),
        format!("{links}{discs} · scale 1 : 1 · all lengths in mm"),
        format!("{outlines} · places along a link from its root towards its tip"),
    ]
}

/// Places pieces side by side below the height `top`, and returns the height of their lower edge.
fn put(shapes: &mut Vec<SheetShape>, row: Vec<(f64, Piece)>, top: f64) -> f64 {
    // The axes of all links in a row are at the same height.
    let up = row.iter().map(|(_, piece)| piece.reach[3]).fold(0.0, f64::max);
    let down = row.iter().map(|(_, piece)| piece.reach[1]).fold(0.0, f64::min);
    for (x, piece) in row {
        let by = [x - piece.reach[0], top - up];
        shapes.extend(piece.shapes.into_iter().map(|mut shape| {
            shape.shift(by);
            shape
        }));
    }
    top - up + down
}

impl SheetShape {
    /// Returns whether the shape is a bar or an outline that contains a point, apart from its round ends.
    fn is_around(&self, [x, y]: [f64; 2]) -> bool {
        match self {
            Self::Bar { from, length, radius, .. } => {
                (from[0]..=from[0] + length).contains(&x) && (y - from[1]).abs() <= *radius
            }
            Self::Outline { corners, .. } => {
                let sides = corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| (a.at, b.at));
                // Even and odd numbers of sides to the right of the point.
                let crossed = sides
                    .filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
                crossed.count() % 2 == 1
            }
            _ => false,
        }
    }

    fn shift(&mut self, [x, y]: [f64; 2]) {
        let move_it = |p: &mut [f64; 2]| *p = [p[0] + x, p[1] + y];
        match self {
            Self::Bar { from, .. } => move_it(from),
            Self::Outline { corners, .. } | Self::Weight { corners, .. } => {
                corners.iter_mut().for_each(|corner| move_it(&mut corner.at))
            }
            Self::Hole { at, .. } | Self::Disc { at, .. } | Self::Mark { at, .. } | Self::Words { at, .. } => {
                move_it(at)
            }
            Self::Line(ends) => ends.iter_mut().for_each(move_it),
        }
    }
}
