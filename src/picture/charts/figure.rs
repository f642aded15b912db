//! A plot as plain data to be painted: lines, words and dots at places in points. The window paints it, and files of
//! pictures are written from it.

use super::choice::Plot;
use super::colour;
use super::drawn::Drawn;
use super::thin::thinned;
use crate::picture::numbers::{at_step, spaced, ticks};
use crate::picture::scene::Rgba;
use crate::picture::scene::palette::{Palette, faded};
use crate::simulation::frame::{Frame, Peaks};

/// Something to paint.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A line through points.
    Line {
        /// Where it goes.
        points: Vec<[f32; 2]>,
        /// How thick it is.
        width: f32,
        /// Its colour.
        colour: Rgba,
        /// Lengths of its dashes and of the gaps between them; none where it has no gaps.
        dash: Option<[f32; 2]>,
        /// Nothing of it is seen outside the axes.
        inside: bool,
    },
    /// Words on one line.
    Text {
        /// Where they stand.
        at: [f32; 2],
        /// How they stand there: from 0, on the right of and below it, to 1, on its left and above.
        anchor: [f32; 2],
        /// The words.
        words: Vec<Words>,
    },
    /// A dot.
    Dot {
        /// Where it is.
        at: [f32; 2],
        /// Its radius.
        radius: f32,
        /// Its colour.
        colour: Rgba,
    },
    /// A rectangle.
    Area {
        /// Its left, top, right and bottom.
        sides: [f32; 4],
        /// Its colour.
        colour: Rgba,
    },
}

/// Words of one look.
#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    /// The text.
    pub text: String,
    /// Size of the type.
    pub size: f32,
    /// Bold type.
    pub bold: bool,
    /// Colour of the type.
    pub colour: Rgba,
}

/// Where values stand: a rectangle, and what it spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// Left, top, right and bottom.
    pub sides: [f32; 4],
    /// From left to right.
    pub x: [f64; 2],
    /// From bottom to top.
    pub y: [f64; 2],
}

/// Room on the left for the numbers of the axis.
pub const LEFT: f32 = 42.0;
/// Room below for those of time.
pub const BELOW: f32 = 15.0;

impl Axes {
    /// In a rectangle that also holds the numbers.
    pub fn within([left, top, right, bottom]: [f32; 4], drawn: &Drawn) -> Self {
        Self { sides: [left + LEFT, top, right - 2.0, bottom - BELOW], x: drawn.x, y: drawn.y }
    }

    /// Where a point stands.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        let [left, top, right, bottom] = self.sides.map(f64::from);
        let across = (x - self.x[0]) / (self.x[1] - self.x[0]);
        let up = (y - self.y[0]) / (self.y[1] - self.y[0]);
        // What is far outside stays outside.
        [left + across * (right - left), bottom + up * (top - bottom)].map(|p| p.clamp(-1e5, 1e5) as f32)
    }

    /// The value of y at a place.
    pub fn y_at(&self, place: f32) -> f64 {
        let [_, top, _, bottom] = self.sides;
        self.y[0] + f64::from((place - bottom) / (top - bottom)) * (self.y[1] - self.y[0])
    }

    /// The value of x at a place.
    pub fn x_at(&self, place: f32) -> f64 {
        let [left, _, right, _] = self.sides;
        self.x[0] + f64::from((place - left) / (right - left)) * (self.x[1] - self.x[0])
    }
}

/// What a plot is drawn with.
#[derive(Clone, Copy, Debug)]
pub struct Look<'a> {
    /// Its colours.
    pub palette: &'a Palette,
    /// The largest values of the run, by which reactions are red or green.
    pub peaks: &'a Peaks,
    /// The instant on display.
    pub now: &'a Frame,
    /// The one at the second cursor.
    pub mark: Option<&'a Frame>,
    /// The one under the pointer.
    pub hover: Option<&'a Frame>,
}

/// How a curve is drawn: its colour, and dashes where another of the plot has that colour already.
pub fn pen(plot: &Plot<'_>, curve: usize, look: &Look<'_>) -> (Rgba, Option<[f32; 2]>) {
    let tone = |i: usize| colour(plot.curves[i].signal, look.palette, look.peaks);
    let same = (0..curve).filter(|i| tone(*i) == tone(curve)).count();
    (tone(curve), [None, Some([6.0, 3.0]), Some([1.5, 2.5]), Some([10.0, 3.0])][same % 4])
}

/// Dashes and opacity of the lines of a run that is laid over. Runs differ by these, because colour says what is drawn.
pub fn dashes(run: usize) -> (Option<[f32; 2]>, f32) {
    let styles = [[7.0, 4.2], [1.2, 4.0], [3.5, 2.1], [14.0, 8.4], [1.2, 7.0]];
    (styles.get(run % 6).copied(), if run >= 6 { 0.45 } else { 0.7 })
}

const SMALL: f32 = 10.0;
/// So far off a curve nobody sees, points.
const UNSEEN: f32 = 0.1;

/// Axes, curves and cursors.
pub fn body(plot: &Plot<'_>, drawn: &Drawn, axes: &Axes, look: &Look<'_>) -> Vec<Item> {
    let p = look.palette;
    let [left, top, right, bottom] = axes.sides;
    // Words last: what is inside the axes is painted in one go.
    let (mut items, mut words) = (Vec::new(), Vec::new());
    let small = |text: String| vec![Words { text, size: SMALL, bold: false, colour: p.dim }];
    let line = |points: Vec<[f32; 2]>, width, colour, dash| Item::Line { points, width, colour, dash, inside: true };
    // As many values as have room, and two at least.
    let room = ((bottom - top) / 24.0).clamp(2.0, 9.0).floor() as u8;
    let round = |count: u8| spaced(axes.y[0], axes.y[1], f64::from(count));
    let (values, step) =
        (room..room + 4).map(round).find(|(values, _)| values.len() >= 2).unwrap_or_else(|| round(room));
    for (value, text) in values.iter().zip(ticks(&values, step)) {
        let y = axes.place([axes.x[0], *value])[1];
        items.push(line(vec![[left, y], [right, y]], 1.0, faded(p.line, 0.9), None));
        words.push(Item::Text { at: [left - 6.0, y], anchor: [1.0, 0.5], words: small(text) });
    }
    let (values, step) = spaced(axes.x[0], axes.x[1], f64::from(((right - left) / 52.0).clamp(2.0, 12.0)));
    let last = values.len().saturating_sub(1);
    for (i, value) in values.iter().enumerate() {
        let x = axes.place([*value, axes.y[0]])[0];
        let unit = match plot.against {
            _ if i < last => "",
            None => "s",
            Some(against) if against.unit == "1" => "",
            Some(against) => against.unit,
        };
        let text = at_step(*value, step);
        let text = if unit.is_empty() { text } else { format!("{text} {unit}") };
        items.push(line(vec![[x, bottom], [x, bottom + 3.0]], 1.0, p.line, None));
        // The outermost stay inside.
        let anchor = if x > right - 14.0 { 1.0 } else { 0.5 };
        let at = [if anchor == 1.0 { right + 2.0 } else { x }, bottom + 3.0];
        words.push(Item::Text { at, anchor: [anchor, 0.0], words: small(text) });
    }
    for run in &drawn.lines {
        let points: Vec<[f32; 2]> = run.points.iter().map(|point| axes.place(*point)).collect();
        let points = thinned(&points, UNSEEN);
        let (tone, dash) = pen(plot, run.curve, look);
        items.push(match run.run {
            None => line(points, 1.8, tone, dash),
            Some(i) => {
                let tone = plot.curves[run.curve].signal.drive.map_or(p.ink, |k| p.drive(k));
                let (dash, strength) = dashes(i);
                line(points, 1.2, faded(tone, strength), dash)
            }
        });
    }
    items.extend(cursors(plot, axes, look));
    items.extend(words);
    items
}

/// The present instant, the second cursor and the pointer: upright lines over time, dots over another signal.
fn cursors(plot: &Plot<'_>, axes: &Axes, look: &Look<'_>) -> Vec<Item> {
    let p = look.palette;
    let [_, top, _, bottom] = axes.sides;
    let all = [
        (look.hover, faded(p.dim, 0.7), None),
        (look.mark, p.amber, Some([4.0, 3.0])),
        (Some(look.now), p.amber, None),
    ];
    let mut items = Vec::new();
    for (frame, tone, dash) in all.into_iter().filter_map(|(frame, tone, dash)| Some((frame?, tone, dash))) {
        match plot.against {
            None => {
                let x = axes.place([frame.time, axes.y[0]])[0];
                let points = vec![[x, top], [x, bottom]];
                items.push(Item::Line { points, width: 1.0, colour: tone, dash, inside: true });
            }
            Some(against) => items.extend(plot.shown().filter_map(|curve| {
                let at = [against.value(frame), curve.times * curve.signal.value(frame)];
                // Of values that are not shown there is no dot.
                let seen = at.iter().all(|x| x.is_finite()) && (axes.y[0]..=axes.y[1]).contains(&at[1]);
                seen.then(|| Item::Dot { at: axes.place(at), radius: 3.5, colour: tone })
            })),
        }
    }
    items
}

/// A picture of a plot, with its title.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Width and height.
    pub size: [f32; 2],
    /// Behind everything.
    pub background: Rgba,
    /// Where its values stand.
    pub axes: Axes,
    /// What to paint, in this order.
    pub items: Vec<Item>,
}

impl Figure {
    /// Of a plot, with its title, units, and its curves by symbol.
    pub fn of(plot: &Plot<'_>, drawn: &Drawn, size: [f32; 2], look: &Look<'_>) -> Self {
        let p = look.palette;
        let [width, height] = size;
        let axes = Axes::within([12.0, 40.0, width - 16.0, height - 12.0], drawn);
        let words = |text: String, bold, colour| Words { text, size: 13.0, bold, colour };
        let head = vec![words(plot.heading(), true, p.ink), words(format!("  {}", plot.unit()), false, p.dim)];
        let mut items = vec![Item::Text { at: [16.0, 12.0], anchor: [0.0, 0.0], words: head }];
        let curves = plot.curves.iter().enumerate().filter(|(_, curve)| curve.on);
        let names = curves.map(|(i, c)| words(format!("  {}", c.signal.symbol), false, pen(plot, i, look).0)).collect();
        items.push(Item::Text { at: [width - 16.0, 12.0], anchor: [1.0, 0.0], words: names });
        items.extend(body(plot, drawn, &axes, look));
        Self { size, background: p.panel, axes, items }
    }
}
