//! [`Shape`]: what SVG and PDF are written from.

use crate::charts::figure::FigureItem;
use crate::scene::Rgba;

/// A part of a path; points in points of 1/72 inch from the upper left corner of the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathStep {
    /// Begins a line.
    Move([f32; 2]),
    /// Goes straight.
    Line([f32; 2]),
    /// Goes along a cubic curve with two control points.
    Cubic([f32; 2], [f32; 2], [f32; 2]),
    /// Returns to where the line began.
    Close,
}

/// How a path is painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Paint {
    /// The inside is filled; overlapping lines add up.
    Fill(Rgba),
    /// The inside is filled by the even-odd rule.
    FillEvenOdd(Rgba),
    /// The line is drawn.
    Stroke {
        /// Colour.
        colour: Rgba,
        /// Width, points.
        width: f32,
        /// Lengths of dash and gap, points; `None` for a solid line.
        dash: Option<[f32; 2]>,
    },
}

/// A painted path.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The path.
    pub steps: Vec<PathStep>,
    /// How it is painted.
    pub paint: Paint,
    /// Left, top, right and bottom of the rectangle that clips it, points.
    pub clip: Option<[f32; 4]>,
    /// The words of which it is the outline.
    pub words: Option<ShapeWords>,
}

/// Words in a line.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeWords {
    /// The words.
    pub text: String,
    /// Left end of their baseline, points.
    pub at: [f32; 2],
    /// Font size, points.
    pub size: f32,
    /// Width, points.
    pub width: f32,
}

/// Distance of the control points of a quarter circle from its ends, as a fraction of the radius.
const QUARTER: f32 = 0.552_284_8;

impl Shape {
    /// Returns the shapes of an item of a figure at a place of the page; `clip` is the rectangle of the axes.
    pub fn of(item: &FigureItem, origin: [f32; 2], clip: [f32; 4]) -> Vec<Self> {
        let [ox, oy] = origin;
        let at = |[x, y]: [f32; 2]| [ox + x, oy + y];
        match item {
            FigureItem::Line { points, width, colour, dash, inside } => {
                let closed = points.len() > 2 && points.first() == points.last();
                let open = &points[..points.len() - usize::from(closed)];
                let mut steps = line(open.iter().map(|p| at(*p)));
                steps.extend(closed.then_some(PathStep::Close));
                let paint = Paint::Stroke { colour: *colour, width: *width, dash: *dash };
                vec![Self { steps, paint, clip: inside.then_some(clip), words: None }]
            }
            FigureItem::Area { loops, colour, inside } => {
                let closed = |points: &Vec<[f32; 2]>| {
                    line(points.iter().map(|p| at(*p))).into_iter().chain([PathStep::Close]).collect::<Vec<_>>()
                };
                let steps = loops.iter().filter(|points| points.len() > 2).flat_map(closed).collect();
                vec![Self { steps, paint: Paint::FillEvenOdd(*colour), clip: inside.then_some(clip), words: None }]
            }
            FigureItem::Rectangle { sides: [left, top, right, bottom], colour } => {
                let corners = [[*left, *top], [*right, *top], [*right, *bottom], [*left, *bottom]];
                let steps = line(corners.map(at)).into_iter().chain([PathStep::Close]).collect();
                vec![Self { steps, paint: Paint::Fill(*colour), clip: None, words: None }]
            }
            FigureItem::Dot { at: centre, radius, colour } => {
                vec![Self { steps: circle(at(*centre), *radius), paint: Paint::Fill(*colour), clip: None, words: None }]
            }
            FigureItem::Text { at: place, anchor, words } => super::glyphs::text(words, at(*place), *anchor),
        }
    }
}

fn line(points: impl IntoIterator<Item = [f32; 2]>) -> Vec<PathStep> {
    let step = |(i, p)| if i == 0 { PathStep::Move(p) } else { PathStep::Line(p) };
    points.into_iter().enumerate().map(step).collect()
}

fn circle([x, y]: [f32; 2], r: f32) -> Vec<PathStep> {
    let k = QUARTER * r;
    let quarter = |[ax, ay]: [f32; 2], [bx, by]: [f32; 2]| {
        // Both ends are at unit distance from the centre, a quarter turn apart.
        let end = |c: f32, s: f32| [x + c, y + s];
        PathStep::Cubic(
            end(r * ax + k * bx, r * ay + k * by),
            end(r * bx + k * ax, r * by + k * ay),
            end(r * bx, r * by),
        )
    };
    let ends = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let quarters = (0..4).map(|i| quarter(ends[i], ends[(i + 1) % 4]));
    [PathStep::Move([x + r, y])].into_iter().chain(quarters).chain([PathStep::Close]).collect()
}
