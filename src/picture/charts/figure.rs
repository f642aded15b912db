//! A plot as plain graphic items (lines, text and dots, coordinates in points). The window paints them, and picture
//! files are written from them.

use super::choice::{Plot, PlotCurve};
use super::colour;
use super::drawn::{PlotLine, PlotLines};
use super::legend::{self, RunName};
use super::limit_names;
use crate::numbers::{at_step, round_ticks, ticks};
use crate::print::glyphs;
use crate::scene::Rgba;
use crate::scene::palette::{Palette, faded};
use crate::scene::thin::simplify_line;
use stillbase_simulation::frame::{Frame, Peaks};

/// A graphic item; coordinates and lengths in points.
#[derive(Clone, Debug, PartialEq)]
pub enum FigureItem {
    /// A line through points.
    Line {
        /// Vertices.
        points: Vec<[f32; 2]>,
        /// Width.
        width: f32,
        /// Colour.
        colour: Rgba,
        /// Lengths of dashes and gaps; `None` for a solid line.
        dash: Option<[f32; 2]>,
        /// Whether the line is clipped to the axes.
        inside: bool,
    },
    /// A line of text.
    Text {
        /// Anchor point.
        at: [f32; 2],
        /// Position of the anchor point within the text: 0 is its left and top, 1 its right and bottom.
        anchor: [f32; 2],
        /// Pieces of text, from left to right.
        words: Vec<FigureText>,
    },
    /// A filled disc.
    Dot {
        /// Centre.
        at: [f32; 2],
        /// Radius.
        radius: f32,
        /// Colour.
        colour: Rgba,
    },
    /// A filled area inside closed lines, by the even-odd rule.
    Area {
        /// The lines; the last point of each connects to its first.
        loops: Vec<Vec<[f32; 2]>>,
        /// Colour.
        colour: Rgba,
        /// Whether the area is clipped to the axes.
        inside: bool,
    },
    /// A filled rectangle.
    Rectangle {
        /// Left, top, right and bottom.
        sides: [f32; 4],
        /// Colour.
        colour: Rgba,
    },
}

/// A piece of text of one size, weight and colour.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureText {
    /// The text.
    pub text: String,
    /// Font size.
    pub size: f32,
    /// Whether the font is bold.
    pub bold: bool,
    /// Colour of the text.
    pub colour: Rgba,
}

/// The axes of a plot: a rectangle, and the intervals of values along its sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// Left, top, right and bottom.
    pub sides: [f32; 4],
    /// Interval from left to right.
    pub x: [f64; 2],
    /// Interval from bottom to top.
    pub y: [f64; 2],
}

/// Width of the margin for the tick labels of the vertical axis, points.
pub const LEFT_MARGIN: f32 = 42.0;
/// Width of the margin for the numbers of overlaid runs, points.
const RUN_MARGIN: f32 = 14.0;
/// Length of the ticks below the axes, with a little more, points.
const TICK_ROOM: f32 = 4.0;
/// Height of the margin for the tick labels of the horizontal axis, points.
pub const BOTTOM_MARGIN: f32 = 15.0;

impl Axes {
    /// Returns axes inside a rectangle (left, top, right, bottom) that also holds the tick labels, and the numbers of
    /// overlaid runs.
    pub fn within([left, top, right, bottom]: [f32; 4], drawn: &PlotLines) -> Self {
        let has_runs = drawn.lines.iter().any(|line| line.run.is_some());
        let right = right - if has_runs { RUN_MARGIN } else { 2.0 };
        Self { sides: [left + LEFT_MARGIN, top, right, bottom - BOTTOM_MARGIN], x: drawn.x, y: drawn.y }
    }

    /// Returns left, top, right and bottom of the rectangle that clips lines; ticks end below the axes.
    pub fn clip(&self) -> [f32; 4] {
        let [left, top, right, bottom] = self.sides;
        [left, top, right, bottom + TICK_ROOM]
    }

    /// Maps a point (x, y) of values to the screen, points.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        let [left, top, right, bottom] = self.sides.map(f64::from);
        let across = (x - self.x[0]) / (self.x[1] - self.x[0]);
        let up = (y - self.y[0]) / (self.y[1] - self.y[0]);
        // Coordinates are clamped far outside the axes, so that they fit an f32.
        [left + across * (right - left), bottom + up * (top - bottom)].map(|p| p.clamp(-1e5, 1e5) as f32)
    }

    /// Returns the value of y at a vertical coordinate, points.
    pub fn y_at(&self, place: f32) -> f64 {
        let [_, top, _, bottom] = self.sides;
        self.y[0] + f64::from((place - bottom) / (top - bottom)) * (self.y[1] - self.y[0])
    }

    /// Returns the value of x at a horizontal coordinate, points.
    pub fn x_at(&self, place: f32) -> f64 {
        let [left, _, right, _] = self.sides;
        self.x[0] + f64::from((place - left) / (right - left)) * (self.x[1] - self.x[0])
    }
}

/// Colours and instants with which a plot is drawn.
#[derive(Clone, Copy, Debug)]
pub struct PlotContext<'a> {
    /// Colours.
    pub palette: &'a Palette,
    /// Largest values of the run, which decide whether reactions are red or green.
    pub peaks: &'a Peaks,
    /// Frame on display.
    pub now: &'a Frame,
    /// Frame at the second cursor.
    pub mark: Option<&'a Frame>,
    /// Frame under the pointer.
    pub hover: Option<&'a Frame>,
}

/// Returns the colour and the dash of a curve; curves are dashed if an earlier curve of the plot has the same colour.
pub fn pen(plot: &Plot<'_>, curve: usize, look: &PlotContext<'_>) -> (Rgba, Option<[f32; 2]>) {
    let tone = |i: usize| colour(plot.curves[i].signal, look.palette, look.peaks);
    let same = (0..curve).filter(|i| tone(*i) == tone(curve)).count();
    (tone(curve), [None, Some([6.0, 3.0]), Some([1.5, 2.5]), Some([10.0, 3.0])][same % 4])
}

/// Returns the dash and the opacity of the lines of an overlaid run.
pub fn dashes(run: usize) -> (Option<[f32; 2]>, f32) {
    let styles = [[7.0, 4.2], [1.2, 4.0], [3.5, 2.1], [14.0, 8.4], [1.2, 7.0]];
    (styles.get(run % 6).copied(), if run >= 6 { 0.45 } else { 0.7 })
}

/// Font size of tick labels, points.
pub(super) const TICK_SIZE_PT: f32 = 10.0;
/// Tolerance of the simplification of curves, points.
const THINNING_TOLERANCE_PT: f32 = 0.1;

/// Returns the items of axes, curves and cursors.
pub fn body(plot: &Plot<'_>, drawn: &PlotLines, axes: &Axes, look: &PlotContext<'_>) -> Vec<FigureItem> {
    let p = look.palette;
    let [left, top, right, bottom] = axes.sides;
    // Text comes last, so that all clipped items are consecutive.
    let (mut items, mut words) = (Vec::new(), Vec::new());
    let small = |text: String| vec![FigureText { text, size: TICK_SIZE_PT, bold: false, colour: p.dim }];
    let line =
        |points: Vec<[f32; 2]>, width, colour, dash| FigureItem::Line { points, width, colour, dash, inside: true };
    // As many tick values as fit the height, and at least two.
    let room = ((bottom - top) / 24.0).clamp(2.0, 9.0).floor() as u8;
    let round = |count: u8| round_ticks(axes.y[0], axes.y[1], f64::from(count));
    let (values, step) =
        (room..room + 4).map(round).find(|(values, _)| values.len() >= 2).unwrap_or_else(|| round(room));
    for (value, text) in values.iter().zip(ticks(&values, step)) {
        let y = axes.place([axes.x[0], *value])[1];
        items.push(line(vec![[left, y], [right, y]], 1.0, faded(p.line, 0.9), None));
        words.push(FigureItem::Text { at: [left - 6.0, y], anchor: [1.0, 0.5], words: small(text) });
    }
    let (values, step) = round_ticks(axes.x[0], axes.x[1], f64::from(((right - left) / 52.0).clamp(2.0, 12.0)));
    let last = values.len().saturating_sub(1);
    for (i, value) in values.iter().enumerate() {
        let x = axes.place([*value, axes.y[0]])[0];
        let unit = match plot.against {
            _ if i < last => "",
            None => "s",
            Some(against) => against.unit,
        };
        let text = at_step(*value, step);
        let text = if unit.is_empty() { text } else { format!("{text} {unit}") };
        items.push(line(vec![[x, bottom], [x, bottom + 3.0]], 1.0, p.line, None));
        // The last label is right-aligned, to stay inside the rectangle.
        let anchor = if x > right - 14.0 { 1.0 } else { 0.5 };
        let at = [if anchor == 1.0 { right + 2.0 } else { x }, bottom + 3.0];
        words.push(FigureItem::Text { at, anchor: [anchor, 0.0], words: small(text) });
    }
    for (curve, limit) in &drawn.limits {
        let tone = faded(pen(plot, *curve, look).0, limit_names::OPACITY);
        for y in [-limit, *limit].map(|y| axes.place([axes.x[0], y])[1]) {
            items.push(line(vec![[left, y], [right, y]], 1.0, tone, Some([2.0, 3.0])));
        }
    }
    let on_screen = |run: &PlotLine| {
        let points: Vec<[f32; 2]> = run.points.iter().map(|point| axes.place(*point)).collect();
        simplify_line(&points, THINNING_TOLERANCE_PT)
    };
    let curves: Vec<Vec<[f32; 2]>> = drawn.lines.iter().map(on_screen).collect();
    words.extend(limit_names::items(plot, drawn, axes, look, &curves));
    for (run, points) in drawn.lines.iter().zip(curves) {
        let (tone, dash) = pen(plot, run.curve, look);
        items.push(match run.run {
            None => line(points, 1.8, tone, dash),
            Some(i) => line(points, 1.4, colour_in_run(plot, run.curve, i, p), dashes(i).0),
        });
    }
    words.extend(run_numbers(plot, drawn, axes, p));
    items.extend(cursors(plot, axes, look));
    items.extend(words);
    items
}

/// Returns the colour of an overlaid run where colours do not distinguish drives.
pub fn run_colour(run: usize, p: &Palette) -> Rgba {
    faded(p.run(run), (dashes(run).1 / dashes(0).1).min(1.0))
}

/// Returns the colour of a curve of an overlaid run. Where colours distinguish drives, they do so in all runs.
fn colour_in_run(plot: &Plot<'_>, curve: usize, run: usize, p: &Palette) -> Rgba {
    plot.curves[curve].signal.drive.map_or_else(|| run_colour(run, p), |k| faded(p.drive(k), dashes(run).1))
}

/// Least distance between the numbers of runs, points.
const NUMBER_DISTANCE_PT: f32 = 10.0;

/// Returns the numbers of overlaid runs, counted from 1 as in the table of runs, beside the ends of their lines.
fn run_numbers(plot: &Plot<'_>, drawn: &PlotLines, axes: &Axes, p: &Palette) -> Vec<FigureItem> {
    let [_, top, right, bottom] = axes.sides;
    let end = |line: &PlotLine| {
        let (run, last) = (line.run?, line.points.last()?);
        let y = axes.place(*last)[1].clamp(top, bottom);
        Some((y, run, colour_in_run(plot, line.curve, run, p)))
    };
    let mut ends: Vec<(f32, usize, Rgba)> = drawn.lines.iter().filter_map(end).collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    // One number serves several curves of a run that end beside each other.
    let mut kept: Vec<(f32, usize, Rgba)> = Vec::new();
    for (y, run, tone) in ends {
        if kept.iter().any(|(other, of, _)| *of == run && y - other < NUMBER_DISTANCE_PT) {
            continue;
        }
        let y = kept.last().map_or(y, |(other, ..)| y.max(other + NUMBER_DISTANCE_PT));
        kept.push((y, run, tone));
    }
    // Numbers that were pushed below the axes move back up.
    let mut lowest = bottom;
    for (y, ..) in kept.iter_mut().rev() {
        *y = y.min(lowest);
        lowest = *y - NUMBER_DISTANCE_PT;
    }
    let number = |(y, run, colour): (f32, usize, Rgba)| FigureItem::Text {
        at: [right + 3.0, y],
        anchor: [0.0, 0.5],
        words: vec![FigureText { text: (run + 1).to_string(), size: TICK_SIZE_PT, bold: true, colour }],
    };
    kept.into_iter().map(number).collect()
}

/// Returns the marks of the displayed instant, the second cursor and the pointer: vertical lines if the horizontal axis
/// is time, otherwise dots.
fn cursors(plot: &Plot<'_>, axes: &Axes, look: &PlotContext<'_>) -> Vec<FigureItem> {
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
                items.push(FigureItem::Line { points, width: 1.0, colour: tone, dash, inside: true });
            }
            Some(against) => items.extend(plot.shown().filter_map(|curve| {
                let at = [against.value(frame), curve.value(frame)];
                // Values outside the vertical axis have no dot.
                let seen = at.iter().all(|x| x.is_finite()) && (axes.y[0]..=axes.y[1]).contains(&at[1]);
                seen.then(|| FigureItem::Dot { at: axes.place(at), radius: 3.5, colour: tone })
            })),
        }
    }
    items
}

/// A picture of a plot, with its title.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What it shows.
    pub title: String,
    /// Width and height, points.
    pub size: [f32; 2],
    /// Background colour.
    pub background: Rgba,
    /// Axes of the plot.
    pub axes: Axes,
    /// Items in order of painting.
    pub items: Vec<FigureItem>,
}

impl Figure {
    /// Returns the picture with all lengths multiplied by a factor, type included.
    #[must_use]
    pub fn scaled(mut self, by: f32) -> Self {
        let place = |p: &mut [f32; 2]| *p = p.map(|x| x * by);
        for item in &mut self.items {
            match item {
                FigureItem::Line { points, width, dash, .. } => {
                    points.iter_mut().for_each(place);
                    (*width, *dash) = (*width * by, dash.map(|lengths| lengths.map(|x| x * by)));
                }
                FigureItem::Area { loops, .. } => loops.iter_mut().flatten().for_each(place),
                FigureItem::Text { at, words, .. } => {
                    place(at);
                    words.iter_mut().for_each(|words| words.size *= by);
                }
                FigureItem::Dot { at, radius, .. } => {
                    place(at);
                    *radius *= by;
                }
                FigureItem::Rectangle { sides, .. } => *sides = sides.map(|x| x * by),
            }
        }
        let axes = Axes { sides: self.axes.sides.map(|x| x * by), ..self.axes };
        Self { size: self.size.map(|x| x * by), axes, ..self }
    }

    /// Returns the background as an item, unless it is transparent.
    pub fn behind(&self) -> Option<FigureItem> {
        let [width, height] = self.size;
        let sides = [0.0, 0.0, width, height];
        (self.background[3] > 0.0).then_some(FigureItem::Rectangle { sides, colour: self.background })
    }

    /// Returns the picture of a plot, with its title, its units and the symbols of its curves. The names of the overlaid
    /// `runs` make it higher; `size`, points, is without these names.
    pub fn of(plot: &Plot<'_>, drawn: &PlotLines, size: [f32; 2], look: &PlotContext<'_>, runs: &[RunName]) -> Self {
        let p = look.palette;
        let width = size[0];
        let named = legend::height(runs, width - 32.0);
        let height = size[1] + named;
        let axes = Axes::within([12.0, 40.0 + named, width - 16.0, height - 12.0], drawn);
        let words = |text: String, bold, colour| FigureText { text, size: 13.0, bold, colour };
        let mut head = vec![words(plot.heading(), true, p.ink), words(format!("  {}", plot.unit()), false, p.dim)];
        let curves = plot.curves.iter().enumerate().filter(|(_, curve)| curve.on);
        let name = |(i, curve): (usize, &PlotCurve<'_>)| {
            words(format!("  {}", curve.signal.symbol), false, pen(plot, i, look).0)
        };
        let mut names: Vec<FigureText> = curves.map(name).collect();
        // In a narrow plot the type is smaller, so that title and symbols do not meet.
        let wide = head.iter().chain(&names).map(|own| glyphs::width(&own.text, own.size, own.bold)).sum::<f32>();
        let by = ((width - 32.0) / wide.max(1.0)).min(1.0);
        head.iter_mut().chain(&mut names).for_each(|own| own.size *= by);
        let mut items = vec![FigureItem::Text { at: [16.0, 12.0], anchor: [0.0, 0.0], words: head }];
        items.push(FigureItem::Text { at: [width - 16.0, 12.0], anchor: [1.0, 0.0], words: names });
        items.extend(legend::items(runs, [16.0, 34.0], width - 32.0, p));
        items.extend(body(plot, drawn, &axes, look));
        Self { title: plot.heading(), size: [width, height], background: p.panel, axes, items }
    }
}
