//! The layers of the links: the machine from the side, whether bars meet, and the button that uses the heights.

use egui::{Align, Align2, CornerRadius, Layout, Rect, RichText, Sense, Stroke, Ui, pos2, vec2};

use crate::theme::{colour, plain};
use crate::widgets::{name, note, section, undoable_edit};
use crate::{Command, notation, place};
use stillbase_exchange::cut::Cut;
use stillbase_exchange::thin::too_thin;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::{Palette, mix};
use stillbase_query::{QueryResult, QueryStatus};
use stillbase_session::{Session, parts};
use stillbase_settings::number::counted;
use stillbase_study::layers::{Clash, LayersAnswer, LayersReport, NoLayers, SideRow, SideView};
use stillbase_study::workshop::cut_of;

/// Heights of a row and of a bar, and widths on the left for the name and on the right for the layer, points.
const ROW_HEIGHT_PT: f32 = 17.0;
const BAR_HEIGHT_PT: f32 = 9.0;
const NAME_WIDTH_PT: f32 = 58.0;
const LAYER_WIDTH_PT: f32 = 20.0;
/// Height of the base plate below the rows, points.
const PLATE_HEIGHT_PT: f32 = 5.0;

/// Returns the dimensions of bars, pins and discs as the parts have them, or else as the design view states them.
pub fn cut(session: &Session) -> Cut {
    cut_of(&session.scenario().design, &session.scenario().machine)
}

/// Draws the section.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    layers: &QueryResult<LayersAnswer>,
    p: &Palette,
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        ui.vertical(|ui| section(ui, p, "layers"));
        ui.with_layout(Layout::right_to_left(Align::Max), |ui| verdict(ui, layers, p));
    });
    let Some(answer) = layers.last.as_deref() else { return };
    if let Err(why) = &answer.within_limits {
        note(ui, p, &format!("Elsewhere within the joint limits: {}", words_of(why)));
    }
    if let Some(Err(why)) = &answer.along_task {
        note(ui, p, &format!("Along the task: {}", words_of(why)));
    }
    let machine = &session.scenario().machine;
    let fits = |report: &&LayersReport| report.layers.len() == machine.links().len();
    let Some(report) = answer.report().filter(fits) else { return };
    if !report.clashes.is_empty() {
        clashes(ui, report, p);
    }
    stack(ui, session, report, p);
    for line in totals(ui, report) {
        ui.label(RichText::new(line).font(plain(12.0)).color(colour(p.dim)));
    }
    for remark in too_thin(&machine.spec().counterweights, &cut(session)) {
        note(ui, p, &format!("Note: {remark}."));
    }
    if report.is_used_by(machine) {
        ui.label(RichText::new("The machine has these heights.").font(plain(12.0)).color(colour(p.dim)));
        return;
    }
    let button = ui.button(RichText::new("use these heights").font(plain(12.0)));
    name(&button, "Use the heights of the layers");
    if button.on_hover_text("Each link at the height of its layer: the tilting moment counts them").clicked() {
        undoable_edit(commands, parts::set_heights(machine, &report.machine));
    }
}

/// Draws whether bars meet, in few words.
fn verdict(ui: &mut Ui, layers: &QueryResult<LayersAnswer>, p: &Palette) {
    let answer = layers.last.as_deref();
    let (words, tone) = match answer.map(|answer| (&answer.within_limits, &answer.along_task)) {
        _ if matches!(layers.state, QueryStatus::UnderWay(_)) && answer.is_none() => ("…", p.dim),
        _ if answer.and_then(LayersAnswer::report).is_some_and(|report| !report.clashes.is_empty()) => {
            ("parts meet at its heights", p.reaction)
        }
        Some((Ok(report), _)) if report.is_decided() => ("no bar meets another", p.zero),
        Some((Ok(_), _)) => ("no bar meets another, not all decided", p.zero),
        Some((Err(_), Some(Ok(_)))) => ("no bar meets another along the task", p.amber),
        Some((Err(NoLayers::NoOrder(_)), _)) => ("bars meet in every order", p.reaction),
        Some((Err(_), _)) => ("no order found", p.reaction),
        None => ("", p.dim),
    };
    ui.label(RichText::new(words).font(plain(12.0)).color(colour(tone)));
}

/// Tells which parts meet at the heights that the machine has.
fn clashes(ui: &mut Ui, report: &LayersReport, p: &Palette) {
    let notation = notation::of(ui.ctx());
    let line = |text: String| RichText::new(text).font(plain(12.0)).color(colour(p.reaction));
    ui.label(line("The heights of the machine do not fit any more; those below do.".into()));
    for words in Clash::lines(&report.clashes, |metres| notation.write(metres, 4, "m")) {
        ui.label(line(words));
    }
}

/// Returns a reason in a sentence or two.
fn words_of(why: &NoLayers) -> String {
    let NoLayers::NoOrder(conflict) = why else { return why.to_string() };
    let met: Vec<String> = conflict.contacts.iter().map(|met| format!("{} meets {}", met.a, met.b)).collect();
    format!("no order of links {} keeps bars apart: {}.", conflict.links.join(", "), met.join("; "))
}

/// Returns lines on height, tilt and clearance.
fn totals(ui: &Ui, report: &LayersReport) -> Vec<String> {
    let notation = notation::of(ui.ctx());
    let height = notation.write(report.height, 3, "m");
    let mut lines = vec![match &report.tilt {
        Some(tilt) => format!("height {height} · tilting moment at most {} N m", signed(tilt.after, 4)),
        None => format!("{} · height {height}", counted(report.count, "layer")),
    }];
    if let Some(near) = &report.clearance {
        let distance = notation.write(near.distance, 4, "m");
        lines.push(format!("least clearance {distance} at {} s: {}, {}", signed(near.time, 2), near.a, near.b));
    }
    lines
}

/// Draws the machine from the side in its present pose, the uppermost link first.
fn stack(ui: &mut Ui, session: &Session, report: &LayersReport, p: &Palette) {
    let machine = &session.scenario().machine;
    let layers: Vec<usize> = report.layers.iter().map(|own| own.layer).collect();
    let view = SideView::of(machine, &cut(session), &layers, &session.frame().q.units());
    let height = ROW_HEIGHT_PT * view.rows.len() as f32 + PLATE_HEIGHT_PT;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let field = Rect::from_min_max(
        pos2(rect.left() + NAME_WIDTH_PT, rect.top()),
        pos2(rect.right() - LAYER_WIDTH_PT, rect.bottom() - PLATE_HEIGHT_PT),
    );
    let [from, to] = view.extent;
    let scale = f64::from(field.width()) / (to - from).max(1e-9);
    let across = |x: f64| field.left() + ((x - from) * scale) as f32;
    let middle = |row: usize| field.top() + ROW_HEIGHT_PT * (row as f32 + 0.5);
    let painter = ui.painter();
    let grey = colour(mix(p.dim, p.panel, 0.45));
    for pin in &view.pins {
        let top = pin.rows[0].map_or(field.bottom(), |row| middle(row) - 0.5 * BAR_HEIGHT_PT);
        let bottom = pin.rows[1].map_or(field.bottom(), |row| middle(row) + 0.5 * BAR_HEIGHT_PT);
        let width = if pin.rows[1].is_none() { 5.0 } else { 2.0 };
        painter.line_segment([pos2(across(pin.x), top), pos2(across(pin.x), bottom)], Stroke::new(width, grey));
    }
    let plate = Rect::from_x_y_ranges(across(0.0) - 16.0..=across(0.0) + 16.0, field.bottom()..=rect.bottom());
    painter.rect_filled(plate.intersect(rect), 1.0, grey);
    for (i, row) in view.rows.iter().enumerate() {
        let line =
            Rect::from_x_y_ranges(rect.x_range(), middle(i) - 0.5 * ROW_HEIGHT_PT..=middle(i) + 0.5 * ROW_HEIGHT_PT);
        let is_hot = ui.rect_contains_pointer(line);
        if is_hot {
            place::highlight(ui.ctx(), Handle::Link(row.link));
        }
        let words = format!("link {}", machine.links()[row.link].name);
        let tone = colour(if is_hot { p.ink } else { p.dim });
        let clip = painter.with_clip_rect(Rect::from_x_y_ranges(rect.left()..=field.left() - 4.0, rect.y_range()));
        clip.text(pos2(rect.left(), middle(i)), Align2::LEFT_CENTER, words, plain(11.5), tone);
        let layer = row.layer.to_string();
        painter.text(pos2(rect.right(), middle(i)), Align2::RIGHT_CENTER, layer, plain(11.5), tone);
        let bar = |[from, to]: [f64; 2], height: f32| {
            let y = middle(i) - 0.5 * height..=middle(i) + 0.5 * height;
            Rect::from_x_y_ranges(across(from)..=across(to).max(across(from) + 1.0), y)
        };
        let own = p.drive(row.drive);
        let own = if is_hot { own } else { mix(own, p.panel, 0.15) };
        painter.rect_filled(bar(row.bar, BAR_HEIGHT_PT), CornerRadius::same(2), colour(own));
        for disc in &row.discs {
            painter.rect_filled(bar(*disc, 1.5 * BAR_HEIGHT_PT), CornerRadius::same(2), colour(mix(own, p.ink, 0.25)));
        }
    }
    let read = |row: &SideRow| format!("link {} in layer {}", machine.links()[row.link].name, row.layer);
    let words = view.rows.iter().map(read).collect::<Vec<_>>().join(", ");
    response
        .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, format!("Layers from the top: {words}")));
}
