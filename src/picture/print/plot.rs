//! [`PrintPlot`]: curves in axes as journals print them: a frame, ticks inside, small type, and lines that differ by
//! their dashes, so that they can be told apart in grey.

use super::glyphs;
use crate::charts::figure::{Axes, Figure, FigureItem, FigureText};
use crate::numbers::{round_ticks, ticks};
use crate::scene::Rgba;
use crate::scene::palette::{Theme, faded, palette};
use crate::scene::thin::simplify_line;

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintCurve {
    /// Name, for the legend and the table of numbers.
    pub name: String,
    /// Its points, in the units of the axes.
    pub points: Vec<[f64; 2]>,
    /// Colour.
    pub colour: Rgba,
    /// Width, points.
    pub width: f32,
    /// Lengths of dash and gap, points; `None` for a solid line.
    pub dash: Option<[f32; 2]>,
    /// Colour that fills the closed curve.
    pub fill: Option<Rgba>,
    /// Whether the legend names it.
    pub in_legend: bool,
}

/// Words beside a point of the plot.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintWords {
    /// The point, in the units of the axes.
    pub at: [f64; 2],
    /// The words.
    pub text: String,
    /// Whether a dot marks the point; the words then stand beside it.
    pub dot: bool,
}

/// Curves in axes.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintPlot {
    /// Colours of axes and words.
    pub theme: Theme,
    /// Name in the table of numbers.
    pub name: String,
    /// What it shows, above the axes.
    pub head: String,
    /// What the axes show, with units: from left to right, and upwards.
    pub axes: [String; 2],
    /// Curves; later ones lie over earlier ones.
    pub curves: Vec<PrintCurve>,
    /// Words in the plot.
    pub words: Vec<PrintWords>,
    /// An interval of the horizontal axis that is shaded.
    pub bands: Vec<[f64; 2]>,
    /// Whether both axes have the same scale, as in a drawing.
    pub is_equal: bool,
    /// Smallest range of the vertical axis, so that rounding does not look like a signal.
    pub least_range: f64,
    /// Values that the vertical axis covers too, such as those of figures that stand beside this one.
    pub covers: Vec<f64>,
}

/// Sizes, points.
const TYPE: f32 = 7.5;
const SMALL: f32 = 7.0;
const LEFT: f32 = 34.0;
const RIGHT: f32 = 9.0;
const LINE: f32 = 11.0;
const TICK: f32 = 2.6;
const SAMPLE: f32 = 18.0;
/// Largest distance of a drawn curve from its points, points.
const THINNING: f32 = 0.01;
/// Radius of a dot, and how far from its centre its words stand, points.
const DOT: f32 = 1.8;
const DOT_GAP: f32 = 3.0;
/// Distance from which on words are clear of what is drawn, points.
const CLEAR: f32 = 4.0;
/// Free space around the curves, as a fraction of their range.
const MARGIN: f64 = 0.06;

/// Returns width and dash of the i-th curve of a plot.
pub fn pen(i: usize) -> (f32, Option<[f32; 2]>) {
    [(1.0, None), (1.0, Some([5.0, 2.0])), (1.0, Some([1.2, 1.8])), (1.0, Some([8.0, 2.0])), (0.6, None)][i % 5]
}

impl PrintPlot {
    /// Returns the figure; `size` is its width and the height of its axes, points. With equal scales the axes are as
    /// high as the curves need, at most that height.
    pub fn figure(&self, [width, height]: [f32; 2]) -> Figure {
        let p = palette(self.theme);
        let legend = self.legend(width - LEFT - RIGHT);
        let rows = legend.last().map_or(0, |(row, ..)| row + 1) as f32;
        let heads = if self.head.is_empty() { 0.0 } else { LINE };
        // The name of the vertical axis stands in a row of its own above it.
        let top = 5.0 + heads + LINE * rows + LINE;
        let ([x, y], inner) = (self.ranges(), [width - LEFT - RIGHT, height]);
        let (x, y, inner) = if self.is_equal { equal_scales(x, y, inner) } else { (x, y, inner) };
        let sides = [LEFT, top, LEFT + inner[0], top + inner[1]];
        let axes = Axes { sides, x, y };
        let mut items =
            vec![fitted(width, text([LEFT - 26.0, top - LINE - 1.0], [0.0, 0.0], &self.axes[1], p.ink, false))];
        if !self.head.is_empty() {
            items.push(fitted(width, text([LEFT - 26.0, 2.0], [0.0, 0.0], &self.head, p.ink, true)));
        }
        for (row, from, curve) in &legend {
            let at = [LEFT - 26.0 + from, 4.0 + heads + LINE * (*row as f32 + 0.5)];
            let points = vec![at, [at[0] + SAMPLE, at[1]]];
            items.push(FigureItem::Line {
                points,
                width: curve.width,
                colour: curve.colour,
                dash: curve.dash,
                inside: false,
            });
            items.push(text([at[0] + SAMPLE + 3.0, at[1]], [0.0, 0.5], &curve.name, p.ink, false));
        }
        for band in &self.bands {
            let [from, to] = band.map(|x| axes.place([x, axes.y[0]])[0].clamp(sides[0], sides[2]));
            items.push(FigureItem::Rectangle { sides: [from, sides[1], to, sides[3]], colour: faded(p.dim, 0.18) });
        }
        self.frame(&axes, &mut items);
        for curve in &self.curves {
            let points: Vec<[f32; 2]> = curve.points.iter().map(|point| axes.place(*point)).collect();
            let points = simplify_line(&points, THINNING);
            if let Some(colour) = curve.fill {
                items.push(FigureItem::Area { loops: vec![points.clone()], colour, inside: true });
            }
            let PrintCurve { width, colour, dash, .. } = *curve;
            items.push(FigureItem::Line { points, width, colour, dash, inside: true });
        }
        let dots: Vec<[f32; 2]> =
            self.words.iter().filter(|words| words.dot).map(|words| axes.place(words.at)).collect();
        let lines: Vec<&[[f32; 2]]> = items.iter().filter_map(line_inside).collect();
        let beside = |words: &PrintWords| clearest_place(axes.place(words.at), &words.text, &axes, (&lines, &dots));
        let beside: Vec<Option<Place>> = self.words.iter().map(|words| words.dot.then(|| beside(words))).collect();
        for (words, beside) in self.words.iter().zip(beside) {
            let at = axes.place(words.at);
            match beside {
                Some(Place { at: place, anchor }) => {
                    items.push(FigureItem::Dot { at, radius: DOT, colour: p.ink });
                    items.push(text(place, anchor, &words.text, p.ink, true));
                }
                None => items.push(text(at, [0.5, 0.5], &words.text, p.ink, false)),
            }
        }
        let bottom = sides[3] + LINE + LINE + 4.0;
        Figure { title: self.name.clone(), size: [width, bottom], background: p.background, axes, items }
    }

    /// Draws the frame with its ticks and their numbers, and the name of the horizontal axis.
    fn frame(&self, axes: &Axes, items: &mut Vec<FigureItem>) {
        let p = palette(self.theme);
        let [left, top, right, bottom] = axes.sides;
        let mut line = |points: Vec<[f32; 2]>, width| {
            items.push(FigureItem::Line { points, width, colour: p.ink, dash: None, inside: false });
        };
        let mut words = Vec::new();
        let (values, step) = round_ticks(axes.x[0], axes.x[1], f64::from((right - left) / 34.0).clamp(2.0, 8.0));
        for (value, label) in values.iter().zip(ticks(&values, step)) {
            let x = axes.place([*value, axes.y[0]])[0];
            line(vec![[x, bottom], [x, bottom - TICK]], 0.5);
            words.push(text([x, bottom + 2.0], [0.5, 0.0], &label, p.ink, false));
        }
        let (values, step) = round_ticks(axes.y[0], axes.y[1], f64::from((bottom - top) / 18.0).clamp(2.0, 8.0));
        for (value, label) in values.iter().zip(ticks(&values, step)) {
            let y = axes.place([axes.x[0], *value])[1];
            line(vec![[left, y], [left + TICK, y]], 0.5);
            words.push(text([left - 3.0, y], [1.0, 0.5], &label, p.ink, false));
        }
        if !self.is_equal && axes.y[0] < 0.0 && axes.y[1] > 0.0 {
            let y = axes.place([axes.x[0], 0.0])[1];
            line(vec![[left, y], [right, y]], 0.25);
        }
        line(vec![[left, top], [right, top], [right, bottom], [left, bottom], [left, top]], 0.5);
        words.push(text([0.5 * (left + right), bottom + 2.0 + LINE], [0.5, 0.0], &self.axes[0], p.ink, false));
        items.extend(words);
    }

    /// Returns the ranges of the axes.
    fn ranges(&self) -> [[f64; 2]; 2] {
        let dots = || self.words.iter().filter(|words| words.dot).map(|words| &words.at);
        let curves = || self.curves.iter().flat_map(|curve| &curve.points);
        let all = || curves().chain(dots()).filter(|p| p.iter().all(|x| x.is_finite()));
        let range = |i: usize, margin: f64| {
            let covers = self.covers.iter().filter(|x| i == 1 && x.is_finite());
            let values = all().map(|p| p[i]).chain(covers.copied());
            let [low, high] =
                values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
            if low > high {
                return [-1.0, 1.0];
            }
            let lacking = if i == 1 { (0.5 * (self.least_range - (high - low))).max(0.0) } else { 0.0 };
            let room = (margin * (high - low + 2.0 * lacking)).max(1e-9 * (1.0 + high.abs()));
            // Small magnitudes stand on zero; other small ranges lie in the middle of the axis.
            let is_magnitude = (0.0..lacking).contains(&low) && high > 0.0;
            let [below, above] = if is_magnitude { [0.0, 2.0 * lacking] } else { [lacking; 2] };
            [low - below - room, high + above + room]
        };
        // Over time, the curves fill the axes from left to right.
        [range(0, if self.is_equal || !self.bands.is_empty() { MARGIN } else { 0.0 }), range(1, MARGIN)]
    }

    /// Returns row, distance from the left and curve of each entry of the legend.
    fn legend(&self, width: f32) -> Vec<(usize, f32, &PrintCurve)> {
        let (mut row, mut x, mut all) = (0, 0.0, Vec::new());
        let named = self.curves.iter().filter(|curve| curve.in_legend);
        for curve in named {
            let own = SAMPLE + 3.0 + glyphs::width(&curve.name, TYPE, false) + 10.0;
            if x > 0.0 && x + own > width + 26.0 {
                (row, x) = (row + 1, 0.0);
            }
            all.push((row, x, curve));
            x += own;
        }
        all
    }
}

/// Returns the points of a line within the axes.
fn line_inside(item: &FigureItem) -> Option<&[[f32; 2]]> {
    match item {
        FigureItem::Line { points, inside: true, .. } => Some(points),
        _ => None,
    }
}

/// Where words stand: a point, and its position within them.
struct Place {
    at: [f32; 2],
    anchor: [f32; 2],
}

/// Returns the place of words beside a dot that is farthest from lines and other dots; of equal ones the first.
fn clearest_place([x, y]: [f32; 2], words: &str, axes: &Axes, (lines, dots): (&[&[[f32; 2]]], &[[f32; 2]])) -> Place {
    let [left, top, right, bottom] = axes.sides;
    let (wide, high) = (glyphs::width(words, TYPE, true), TYPE);
    let room = |[across, down]: [f32; 2]| {
        let corner =
            [x + across * DOT_GAP - 0.5 * (1.0 - across) * wide, y + down * DOT_GAP - 0.5 * (1.0 - down) * high];
        let sides = [corner[0], corner[1], corner[0] + wide, corner[1] + high];
        let is_inside = sides[0] > left && sides[1] > top && sides[2] < right && sides[3] < bottom;
        let to_lines = lines.iter().flat_map(|points| points.windows(2)).map(|ends| distance(sides, ends[0], ends[1]));
        let to_dots = dots.iter().filter(|dot| **dot != [x, y]).map(|dot| distance(sides, *dot, *dot) - DOT);
        let nearest = to_lines.chain(to_dots).fold(CLEAR, f32::min);
        if is_inside { nearest } else { nearest - CLEAR }
    };
    let sides = [[1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [-1.0, 1.0], [1.0, 0.0], [-1.0, 0.0], [0.0, -1.0], [0.0, 1.0]];
    let best = sides.into_iter().rev().max_by(|a, b| room(*a).total_cmp(&room(*b))).unwrap_or([1.0, -1.0]);
    let [across, down] = best;
    Place { at: [x + across * DOT_GAP, y + down * DOT_GAP], anchor: best.map(|side| 0.5 * (1.0 - side)) }
}

/// Returns the distance of a straight line from a rectangle, nearly: that of points along the line.
fn distance([left, top, right, bottom]: [f32; 4], from: [f32; 2], to: [f32; 2]) -> f32 {
    let count = ((to[0] - from[0]).hypot(to[1] - from[1])).ceil().clamp(1.0, 400.0) as u16;
    let of = |i: u16| {
        let share = f32::from(i) / f32::from(count);
        let [x, y] = [0, 1].map(|k| from[k] + share * (to[k] - from[k]));
        (left - x).max(x - right).max(0.0).hypot((top - y).max(y - bottom).max(0.0))
    };
    (0..=count).map(of).fold(f32::INFINITY, f32::min)
}

/// Returns the ranges and the size of axes, points, in which both have the same scale.
fn equal_scales(x: [f64; 2], y: [f64; 2], [width, height]: [f32; 2]) -> ([f64; 2], [f64; 2], [f32; 2]) {
    let [across, up] = [x[1] - x[0], y[1] - y[0]];
    let scale = (f64::from(width) / across).min(f64::from(height) / up);
    let height = (up * scale) as f32;
    let middle = 0.5 * (x[0] + x[1]);
    let half = 0.5 * f64::from(width) / scale;
    ([middle - half, middle + half], y, [width, height])
}

/// Returns text with smaller letters, if it would pass the right side of a page of this width.
fn fitted(width: f32, mut item: FigureItem) -> FigureItem {
    if let FigureItem::Text { at, words, .. } = &mut item {
        let own = words.iter().map(|own| glyphs::width(&own.text, own.size, own.bold)).sum::<f32>();
        let by = ((width - at[0] - 2.0) / own.max(1.0)).min(1.0);
        words.iter_mut().for_each(|own| own.size *= by);
    }
    item
}

fn text(at: [f32; 2], anchor: [f32; 2], words: &str, colour: Rgba, bold: bool) -> FigureItem {
    let size = if bold { TYPE } else { SMALL };
    FigureItem::Text { at, anchor, words: vec![FigureText { text: words.into(), size, bold, colour }] }
}
