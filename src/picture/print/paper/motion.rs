//! Fig. 5: what a run needs and what reaches its base, and its poses along the way.

use crate::charts::Chart;
use crate::print::plot::{PrintCurve, PrintPlot, PrintWords, pen};
use crate::scene::linkage::LinkageModel;
use crate::scene::palette::{Theme, mix, palette};
use stillbase_query::{Sequence, answer_sequence};
use stillbase_session::Run;
use stillbase_settings::number::fixed;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::signals::{Signal, group_of};
use stillbase_study::samples::SignalSamples;

/// Number of poses along a run.
const POSES: usize = 9;

/// Returns the signals of a chart over the time of a run, in SI units.
pub fn chart_plot(theme: Theme, chart: &Chart, signals: &[Signal], frames: &Sequence<Frame>) -> PrintPlot {
    let own: Vec<Signal> = signals.iter().filter(|signal| chart.contains(signal)).cloned().collect();
    let name = chart.signals.first().map_or("", |path| group_of(path));
    let unit = chart.si_unit();
    let axis = if unit.is_empty() { chart.title.to_owned() } else { format!("{} ({unit})", chart.title) };
    over_time(theme, name, axis, chart.min_range / chart.scale, &own, frames)
}

/// Returns torques and base moment over the time of a run.
pub fn torque_plot(theme: Theme, signals: &[Signal], frames: &Sequence<Frame>) -> PrintPlot {
    let is_shown = |signal: &&Signal| signal.group() == "torque" || signal.path == "moment/total";
    let own: Vec<Signal> = signals.iter().filter(is_shown).cloned().collect();
    over_time(theme, "torques", "torques and base moment (N m)".into(), 0.1, &own, frames)
}

fn over_time(
    theme: Theme,
    name: &str,
    axis: String,
    least: f64,
    signals: &[Signal],
    frames: &Sequence<Frame>,
) -> PrintPlot {
    let p = palette(theme);
    let samples: SignalSamples = answer_sequence(&signals.to_vec(), frames);
    let mut others = 0;
    let curve = |(i, signal): (usize, &Signal)| {
        let values = samples.series(&signal.path).map_or(&[][..], |series| series.values());
        let points = samples.times().iter().zip(values).map(|(t, x)| [*t, *x]).collect();
        // Each drive has its own dashes; what is not of a drive is drawn wide.
        let ((width, dash), colour) = match signal.drive {
            Some(k) => (pen(k), p.drive(k)),
            None => {
                others += 1;
                let (_, dash) = pen(others - 1);
                ((if i > 0 || signals.len() == 1 { 1.8 } else { 1.0 }, dash), p.ink)
            }
        };
        PrintCurve { name: signal.symbol.clone(), points, colour, width, dash, fill: None, in_legend: true }
    };
    PrintPlot {
        theme,
        name: name.into(),
        head: String::new(),
        axes: ["time (s)".into(), axis],
        curves: signals.iter().enumerate().map(curve).collect(),
        words: Vec::new(),
        bands: Vec::new(),
        is_equal: false,
        least_range: least,
        covers: Vec::new(),
    }
}

/// Returns poses of the links up to the end effector at equal intervals of a run, from light to dark, and its path.
pub fn snapshots_plot(theme: Theme, run: &Run, linkage: &LinkageModel, frames: &Sequence<Frame>) -> PrintPlot {
    let p = palette(theme);
    let last = frames.len().saturating_sub(1);
    let mut curves = Vec::new();
    let mut previous = None;
    for i in 0..POSES {
        let place = (i * last).div_ceil(POSES - 1).min(last);
        let Some(frame) = frames.get(place).filter(|_| previous != Some(place)) else { continue };
        previous = Some(place);
        let chain = linkage.skeleton(&frame.q.units());
        let base = frame.base.at;
        let first = chain.first().map(|(_, [root, _])| *root);
        let points = first.into_iter().chain(chain.iter().map(|(_, [_, tip])| *tip));
        let share = i as f32 / (POSES - 1) as f32;
        curves.push(PrintCurve {
            name: format!("links at {} s", fixed(frame.time, 3)),
            points: points.map(|at| [base.re + at.re, base.im + at.im]).collect(),
            colour: mix(p.line, p.ink, 0.25 + 0.75 * share),
            width: 0.6 + 0.6 * share,
            dash: None,
            fill: None,
            in_legend: false,
        });
    }
    curves.push(PrintCurve {
        name: "path of the end effector".into(),
        points: frames.iter().map(|frame| [frame.end_effector.re, frame.end_effector.im]).collect(),
        colour: p.drive(1),
        width: 1.2,
        dash: Some([3.0, 1.5]),
        fill: None,
        in_legend: true,
    });
    let task = &run.scenario().task;
    let named = task.points().into_iter().enumerate().map(|(i, at)| PrintWords {
        at: [at.re, at.im],
        text: task.name_of(i),
        dot: true,
    });
    PrintPlot {
        theme,
        name: "snapshots".into(),
        head: String::new(),
        axes: ["x (m)", "y (m)"].map(String::from),
        curves,
        words: named.collect(),
        bands: Vec::new(),
        is_equal: true,
        least_range: 0.0,
        covers: Vec::new(),
    }
}
