//! Areas that straight rays reach as a base turns a little.

use super::super::plot::{PrintCurve, PrintPlot, PrintWords, pen};
use crate::scene::palette::{Theme, faded, mix, palette};
use crate::scene::stage::limit_words;
use stillbase_mechanics::planar::Vector;
use stillbase_study::turn_map::TurnMap;

/// Opacity of the fill of each area; inner areas lie on outer ones and so are darker.
const FILL_OPACITY: f32 = 0.12;
/// Width of curves of dynamic singularities, points.
const SINGULAR_WIDTH: f32 = 1.8;

/// Returns the nested areas of a map, the outermost below, with the curves of dynamic singularities.
pub fn turn_areas(theme: Theme, map: &TurnMap) -> PrintPlot {
    let p = palette(theme);
    let pairs = |points: &[Vector]| points.iter().map(|p| [p.re, p.im]).collect::<Vec<_>>();
    let area = |i: usize| {
        let (width, dash) = pen(i);
        let mut points = pairs(&map.outline(i));
        points.extend(points.first().copied());
        let share = i as f32 / map.turn_limits.len() as f32;
        PrintCurve {
            name: match map.turn_limits[i] {
                0.0 => limit_words(0.0),
                turn => format!("base turns by at most {}", limit_words(turn)),
            },
            points,
            colour: mix(p.ink, p.dim, share),
            width,
            dash,
            fill: Some(faded(p.dim, FILL_OPACITY)),
            in_legend: true,
        }
    };
    let singular = map.singular_curves().into_iter().enumerate().map(|(nth, curve)| PrintCurve {
        name: match nth {
            0 => "dynamic singularity".into(),
            nth => format!("dynamic singularity, line {}", nth + 1),
        },
        points: pairs(&curve),
        colour: p.reaction,
        width: SINGULAR_WIDTH,
        dash: None,
        fill: None,
        in_legend: nth == 0,
    });
    let dot = |at: [f64; 2], text: &str| PrintWords { at, text: text.into(), dot: true };
    PrintPlot {
        theme,
        name: "turn map".into(),
        head: String::new(),
        axes: ["x (m)", "y (m)"].map(String::from),
        curves: (0..map.turn_limits.len()).rev().map(area).chain(singular).collect(),
        words: vec![dot([0.0; 2], "base"), dot(map.tip_start, "from here")],
        bands: Vec::new(),
        is_equal: true,
        least_range: 0.0,
        covers: Vec::new(),
    }
}
