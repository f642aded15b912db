//! The reaction on the base: an arrow of the force and an arc of the moment at B, with labels of their scale.

use std::f64::consts::FRAC_PI_2;

use crate::numbers::round_number;
use crate::scene::arrow::head;
use crate::scene::exaggeration::{DrawnFrame, Exaggeration};
use crate::scene::linkage::LinkageModel;
use crate::scene::options::{Handle, ViewOptions};
use crate::scene::palette::Palette;
use crate::scene::reaction::{ARC_RADIUS, FULL_ARROW, ReactionGlyph, Scale};
use crate::scene::{Anchor, Label, Polyline, Scene, Strips, point, posed};
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_settings::number::ShortNumber;
use stillbase_simulation::frame::Frame;

/// Draws the reaction on the base and the centre of mass. The words name the constant force, and the moment by whether
/// the base has a reaction wheel.
pub fn draw(
    scene: &mut Scene,
    linkage: &LinkageModel,
    palette: &Palette,
    shown: &DrawnFrame<'_>,
    options: &ViewOptions,
    (static_force_name, feels_more): (&str, bool),
) {
    let (z, reach, frame) = (linkage.top(), linkage.reach(), shown.frame);
    let (b, felt) = (shown.base.at, ReactionGlyph::of(frame));
    let so_far = || Scale::of(frame.peaks.force.max(felt.force.norm()), frame.peaks.moment);
    let Scale { newtons, newton_metres } = options.scale.unwrap_or_else(so_far);
    let at_b = posed(b, Vector::new(1.0, 0.0), z);
    // An invisible arrow or arc is a line without points.
    let mut line = |name: &'static str, own: Handle, strips: Vec<Vec<[f32; 3]>>| {
        let width = if options.highlighted == Some(own) { 5.0 } else { 3.0 };
        let line = Polyline::new(name, Strips::from(strips), width, palette.reaction).on_top();
        scene.lines.push(Polyline { world_from_item: at_b, ..line });
    };
    let arrow = felt.arrow(newtons).map(|parts| parts * reach);
    line(
        "reaction/force",
        Handle::Force,
        arrow.map_or_else(Vec::new, |arrow| {
            let shaft = vec![[0.0; 3], point(arrow, 0.0)];
            vec![shaft, head(arrow, arrow / arrow.norm(), 0.025 * reach, 0.0)]
        }),
    );
    let (sweep, radius) = (felt.sweep(newton_metres), ARC_RADIUS * reach);
    line(
        "reaction/moment",
        Handle::Moment,
        sweep.map_or_else(Vec::new, |sweep| {
            let n = ((sweep.abs() * 24.0).ceil() as usize).max(2);
            let on = |share: f64| unit(-FRAC_PI_2 + sweep * share) * radius;
            let arc = (0..=n).map(|i| point(on(i as f64 / n as f64), 0.0)).collect();
            let along = on(1.0) / radius * Vector::new(0.0, sweep.signum());
            vec![arc, head(on(1.0), along, 0.025 * reach, 0.0)]
        }),
    );
    let arm = (0.014 * reach) as f32;
    let cross = [vec![[-arm, 0.0, 0.0], [arm, 0.0, 0.0]], vec![[0.0, -arm, 0.0], [0.0, arm, 0.0]]];
    let at_com = posed(shown.com, Vector::new(1.0, 0.0), z);
    scene.lines.push(Polyline::new("com", cross, 1.8, palette.ink).on_top().moving(at_com));
    let scale: Vec<String> = [
        arrow.map(|_| format!("arrow: {:.3} m = {} N", FULL_ARROW * reach, round_number(newtons))),
        sweep.map(|_| format!("arc: 135° = {} N m", round_number(newton_metres))),
    ]
    .into_iter()
    .flatten()
    .collect();
    let [force, moment] = felt.readings(palette, feels_more).map(|(text, tone)| (text, tone, 13.0));
    let rows = [
        force,
        moment,
        (felt.static_force_text(static_force_name).unwrap_or_default(), palette.dim, 11.5),
        (centre_of_mass(frame, reach), palette.dim, 11.5),
        (scale.join(" · "), palette.dim, 11.5),
        (mount(options.exaggeration), palette.dim, 11.5),
    ];
    let at = point(Vector::new(0.2 * reach, -0.11 * reach), z);
    let mut down = 0.0;
    for (text, colour, size) in rows.into_iter().filter(|(t, ..)| !t.is_empty()) {
        scene.labels.push(Label::new("reaction/words", at, [0.0, down], text, colour, size, Anchor::Left));
        down += 17.0;
    }
}

/// Returns how far the base is drawn turned on a soft mount; empty without one.
fn mount(exaggeration: Exaggeration) -> String {
    match exaggeration {
        Exaggeration::Mount(compliance) => {
            format!("drawn on a soft mount: 1 N m turns it {}°", ShortNumber(compliance.to_degrees()))
        }
        Exaggeration::Times(_) => String::new(),
    }
}

/// Returns the text of the position of the centre of mass; `reach` is the reach of the machine, m.
fn centre_of_mass(frame: &Frame, reach: f64) -> String {
    let off = (frame.com - frame.base.at).norm();
    match off < 1e-6 * reach {
        true => "centre of mass at rest on the base pin".into(),
        false => format!("centre of mass {:.2} mm off the base pin", 1e3 * off),
    }
}
