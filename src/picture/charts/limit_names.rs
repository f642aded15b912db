//! The names of limit lines in a plot, where no curve is.

use super::choice::Plot;
use super::drawn::PlotLines;
use super::figure::{Axes, FigureItem, FigureText, PlotContext, TICK_SIZE_PT, pen};
use super::legend::LETTER_SHARE;
use crate::scene::palette::faded;
use crate::scene::segment::crosses;

/// Height of a name, its distance from its line, and from the sides of the axes, points.
const HEIGHT_PT: f32 = 12.0;
const GAP_PT: f32 = 2.0;
const SIDE_PT: f32 = 4.0;
/// Steps by which a name moves along its line, points, and what it costs to take another side or line.
const STEP_PT: f32 = 14.0;
const OTHER_SIDE_COST: f32 = 30.0;
const OTHER_LINE_COST: f32 = 60.0;
/// Opacity of a name and of its line.
pub const OPACITY: f32 = 0.7;

/// Returns the names of the limits, each beside one of its two lines where it covers least: no curve, no other name and
/// no other limit, as far as there is such a place. `curves` are the vertices of all curves on the screen, points.
pub fn items(
    plot: &Plot<'_>,
    drawn: &PlotLines,
    axes: &Axes,
    look: &PlotContext<'_>,
    curves: &[Vec<[f32; 2]>],
) -> Vec<FigureItem> {
    let [left, _, right, _] = axes.sides;
    let heights = |limit: f64| [limit, -limit].map(|y| axes.place([axes.x[0], y])[1]);
    let mut taken: Vec<[f32; 4]> = Vec::new();
    let mut items = Vec::new();
    for (i, (curve, limit)) in drawn.limits.iter().enumerate() {
        // Equal limits share one name, in the colour of the first.
        let is_equal = |other: &&(usize, f64)| other.1 == *limit;
        if drawn.limits[..i].iter().any(|other| is_equal(&other)) {
            continue;
        }
        let symbols = drawn.limits.iter().filter(is_equal).map(|(of, _)| plot.curves[*of].signal.symbol.as_str());
        let text = format!("limit of {}", symbols.collect::<Vec<_>>().join(", "));
        let width = LETTER_SHARE * TICK_SIZE_PT * text.chars().count() as f32;
        let others = drawn.limits.iter().filter(|other| !is_equal(other)).flat_map(|(_, other)| heights(*other));
        let lines = others.map(|y| vec![[left, y], [right, y]]);
        let obstacles: Vec<Vec<[f32; 2]>> = lines.chain(curves.iter().cloned()).collect();
        let place = place(axes, heights(*limit), width, &obstacles, &taken);
        let colour = faded(pen(plot, *curve, look).0, OPACITY);
        let words = vec![FigureText { text, size: TICK_SIZE_PT, bold: false, colour }];
        items.push(FigureItem::Text { at: [place[0], place[1]], anchor: [0.0, 0.0], words });
        taken.push(place);
    }
    items
}

/// Returns the place of a name beside its two lines: left, top, right and bottom. It begins at the right end of the
/// upper line, below it.
fn place(axes: &Axes, lines: [f32; 2], width: f32, curves: &[Vec<[f32; 2]>], taken: &[[f32; 4]]) -> [f32; 4] {
    let [left, top, right, bottom] = axes.sides;
    let room = (right - left - 2.0 * SIDE_PT - width).max(0.0);
    let steps = (room / STEP_PT).floor() as usize;
    let mut all: Vec<(f32, [f32; 4])> = Vec::new();
    for (line, line_cost) in lines.into_iter().zip([0.0, OTHER_LINE_COST]) {
        // Inside of both lines is the nearer side.
        let inside = if line_cost == 0.0 { line + GAP_PT } else { line - GAP_PT - HEIGHT_PT };
        let outside = if line_cost == 0.0 { line - GAP_PT - HEIGHT_PT } else { line + GAP_PT };
        for (y, side_cost) in [(inside, 0.0), (outside, OTHER_SIDE_COST)] {
            if y < top || y + HEIGHT_PT > bottom {
                continue;
            }
            all.extend((0..=steps).map(|i| {
                let along = i as f32 * STEP_PT;
                let x = right - SIDE_PT - width - along;
                (line_cost + side_cost + 0.5 * along, [x, y, x + width, y + HEIGHT_PT])
            }));
        }
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let covers = |place: [f32; 4]| {
        let names = taken.iter().filter(|other| overlap(**other, place)).count();
        let pieces = curves.iter().flat_map(|curve| curve.windows(2));
        names * NAME_WEIGHT + pieces.filter(|ends| crosses([ends[0], ends[1]], place)).count()
    };
    let mut best = None;
    for (_, place) in all {
        let covered = covers(place);
        if covered == 0 {
            return place;
        }
        if best.is_none_or(|(least, _)| covered < least) {
            best = Some((covered, place));
        }
    }
    let x = right - SIDE_PT - width;
    best.map_or([x, lines[0] + GAP_PT, right - SIDE_PT, lines[0] + GAP_PT + HEIGHT_PT], |(_, place)| place)
}

/// Number of pieces of curves that a name would rather cover than another name.
const NAME_WEIGHT: usize = 1000;

fn overlap(a: [f32; 4], b: [f32; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}
