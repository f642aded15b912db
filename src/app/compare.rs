//! The table of runs at the bottom: the same task done in several ways, and kept runs.

mod columns;

use super::theme::{bold, colour, plain};
use super::widgets::name;
use super::{
    Command, ComparisonCommand, GuidePage, GuidePlace, SessionCommand, Switch, ViewChange, ViewState, WindowCommand,
    fit, focus, guide, notation,
};
use egui::{Align, Button, CursorIcon, Frame, Grid, Label, Layout, Margin, Panel, RichText, ScrollArea, Sense, Ui};
use stillbase_picture::charts::figure::{dashes, run_colour};
use stillbase_picture::columns::RunColumn;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::scenario::Scenario;
use stillbase_study::comparison::{Comparison, ComparisonEntry};

use columns::{COLUMN_GAP_PT, HEAD_SIZE_PT};

/// Width of the mark of columns that are left out, points.
const MARK_WIDTH_PT: f32 = 30.0;
/// Height of the row of a refused run, points.
const ROW_HEIGHT_PT: f32 = 20.0;

/// Draws this panel.
pub fn show(ui: &mut Ui, comparison: &Comparison, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = view_state.palette();
    let frame = Frame::new().inner_margin(Margin { left: 16, right: 16, top: 8, bottom: 8 });
    let rows = comparison.entries().len() as f32;
    let most = (0.42 * ui.available_height()).max(120.0);
    let height = (90.0 + 27.5 * rows).min(most);
    Panel::bottom("compare").exact_size(height).resizable(false).frame(frame).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.label(RichText::new("Side by side").font(bold(13.5)));
            let place = GuidePlace::under(GuidePage::Plants, "Runs side by side");
            guide::button(ui, &p, "runs side by side", place, commands);
            let words = "the same task done in several ways: tick a row to draw it in plots and scene, click a column title to sort";
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                buttons(ui, comparison, commands);
                // The explanation fills the space between title and buttons.
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    fit::label(ui, words, plain(11.5), colour(p.dim));
                });
            });
        });
        ui.add_space(2.0);
        ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
            table(ui, &p, comparison, commands);
            focus::keep_in_view(ui);
        });
    });
}

fn buttons(ui: &mut Ui, comparison: &Comparison, commands: &mut Vec<Command>) {
    let close = ui.button("Close").on_hover_text("C");
    if close.clicked() {
        commands.push(ViewChange::Switch(Switch::Compare, false).into());
    }
    if ui.button("Copy").on_hover_text("Copies the table as text, for a spreadsheet").clicked() {
        ui.ctx().copy_text(comparison.to_text());
    }
    if ui
        .button("Keep this run")
        .on_hover_text("Adds the session's run, also if you led it by hand; the row stays when the task changes")
        .clicked()
    {
        commands.push(SessionCommand::KeepRun.into());
    }
    let add = egui::ComboBox::from_id_salt("add run").selected_text("Add…").width(84.0).show_ui(ui, |ui| {
        for scenario in Scenario::builtins() {
            if ui.selectable_label(false, &scenario.title).clicked() {
                commands.push(WindowCommand::Comparison(ComparisonCommand::Add(Box::new(scenario.clone()))).into());
            }
        }
    });
    name(&add.response.on_hover_text("Another scenario to compare with"), "Add a run");
}

fn table(ui: &mut Ui, p: &Palette, comparison: &Comparison, commands: &mut Vec<Command>) {
    let room = ui.available_width() - MARK_WIDTH_PT;
    let layout = columns::laid_out(ui, comparison, notation::of(ui.ctx()), room);
    let (columns, left_out) = (&layout.columns, &layout.left_out);
    ui.spacing_mut().button_padding = egui::vec2(0.0, 0.0);
    let grid = Grid::new("runs").num_columns(columns.len() + 3).spacing([COLUMN_GAP_PT, 5.0]).min_col_width(0.0);
    grid.show(ui, |ui| {
        ui.label("");
        ui.label(RichText::new("run").font(plain(11.5)).color(colour(p.dim)));
        for column in columns {
            head(ui, p, comparison, column, commands);
        }
        if !left_out.is_empty() {
            let mark = RichText::new(format!("+{}", left_out.len())).font(plain(11.5)).color(colour(p.dim));
            let words = format!("Left out here: {}. Copy has all columns; so has a wider window.", left_out.join(", "));
            ui.label(mark).on_hover_text(words);
        }
        ui.end_row();
        for i in comparison.order() {
            row(ui, p, i, &comparison.entries()[i], columns, commands);
            ui.end_row();
        }
    });
}

/// Draws the title of a column in two lines; a click sorts by it.
fn head(
    ui: &mut Ui,
    p: &Palette,
    comparison: &Comparison,
    (column, [first, second]): &(RunColumn, [String; 2]),
    commands: &mut Vec<Command>,
) {
    let i = column.at;
    let arrow = match comparison.sorted() {
        Some((sorted, down)) if sorted == i => [" ↑", " ↓"][usize::from(down)],
        _ => "",
    };
    let strong = if arrow.is_empty() { p.dim } else { p.ink };
    let lines = [first.clone(), format!("{second}{arrow}")]
        .map(|line| ui.painter().layout_no_wrap(line, plain(HEAD_SIZE_PT), colour(strong)));
    let size = egui::vec2(lines[0].size().x.max(lines[1].size().x), lines[0].size().y + lines[1].size().y);
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let (rect, head) = ui.allocate_exact_size(size, Sense::click());
        let mut top = rect.top();
        for line in lines {
            let at = egui::pos2(rect.right() - line.size().x, top);
            top += line.size().y;
            ui.painter().galley(at, line, colour(strong));
        }
        if head.has_focus() {
            let stroke = ui.visuals().selection.stroke;
            ui.painter().rect_stroke(rect.expand(2.0), 2.0, stroke, egui::StrokeKind::Outside);
        }
        name(&head, &format!("Sort by {}", column.meaning));
        let head = head.on_hover_cursor(CursorIcon::PointingHand);
        if head.on_hover_text(format!("{}, {}; click to sort", column.meaning, column.format.unit)).clicked() {
            commands.push(WindowCommand::Comparison(ComparisonCommand::Sort(i)).into());
        }
    });
}

fn row(
    ui: &mut Ui,
    p: &Palette,
    i: usize,
    entry: &ComparisonEntry,
    columns: &[(RunColumn, [String; 2])],
    commands: &mut Vec<Command>,
) {
    let mut shown = entry.shown;
    ui.horizontal(|ui| {
        let tick = ui.add_enabled(entry.outcome.is_ok(), egui::Checkbox::without_text(&mut shown));
        name(&tick, &format!("Lay over: {}", entry.title));
        if tick.on_hover_text("Draw this run in plots and scene").changed() {
            commands.push(WindowCommand::Comparison(ComparisonCommand::Show(i, shown)).into());
        }
        let (rect, _) = ui.allocate_exact_size(egui::vec2(30.0, 12.0), Sense::hover());
        if shown {
            sample(ui, rect, dashes(i).0, colour(run_colour(i, p)));
        }
    });
    ui.horizontal(|ui| {
        let number = RichText::new(format!("{}", i + 1)).font(plain(11.5)).color(colour(p.dim));
        ui.label(number);
        let title = RichText::new(&entry.title).font(plain(12.5));
        let clean = entry.outcome.as_ref().is_ok_and(|run| run.summary.reactionless);
        let title = if clean { title.color(colour(p.zero)) } else { title };
        let label = ui.add(Button::new(title).frame(false));
        name(&label, &format!("Open {}", entry.title));
        let label = label.on_hover_cursor(CursorIcon::PointingHand);
        let apart = entry.design.as_ref().and_then(|design| design.why_not.as_ref());
        let apart = apart.map_or_else(String::new, |why| format!(". Its machine: {why}"));
        if label.on_hover_text(format!("Open this run in place of the present one{apart}")).clicked() {
            commands.push(SessionCommand::OpenRun(i).into());
        }
        if entry.added_by_user {
            let remove = ui.small_button("×");
            name(&remove, &format!("Remove {}", entry.title));
            if remove.on_hover_text("Remove this row").clicked() {
                commands.push(WindowCommand::Comparison(ComparisonCommand::Remove(i)).into());
            }
        }
    });
    match &entry.outcome {
        Ok(_) => {
            for (column, _) in columns {
                let text = columns::written(column, entry);
                let zero = text.chars().all(|c| matches!(c, '0' | '.' | '–'));
                let tone = if zero { p.dim } else { p.ink };
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    ui.add(Label::new(RichText::new(text).font(plain(12.5)).color(colour(tone))).extend());
                });
            }
        }
        Err(refused) => {
            // The reason runs across the columns without widening them; the button before it is never cut.
            let least = refused.proposals.first();
            ui.horizontal(|ui| {
                let from = ui.cursor().left();
                let why = notation::sentence(ui.ctx(), &refused.why).into_owned();
                let shown = ui.clip_rect().right();
                let mut area = ui.new_child(
                    egui::UiBuilder::new()
                        .max_rect(egui::Rect::from_min_max(
                            ui.cursor().min,
                            egui::pos2(shown.max(from), ui.cursor().min.y + ROW_HEIGHT_PT),
                        ))
                        .layout(Layout::left_to_right(Align::Center)),
                );
                area.spacing_mut().button_padding = egui::vec2(6.0, 1.0);
                // Scenario and explanation are made for the click and the hover only.
                if let Some(way) = least.filter(|way| way.change().is_some()) {
                    let text = notation::sentence(ui.ctx(), &way.text).into_owned();
                    let button = area.add(Button::new(RichText::new(text).font(plain(11.5))).small());
                    name(&button, &format!("{}: {}", entry.title, way.text));
                    let button = button.on_hover_ui(|ui| {
                        ui.set_max_width(ui.spacing().tooltip_width);
                        ui.label(format!("Runs it so, and keeps the run as a row\n{}", refused.ways_in_words()));
                    });
                    if button.clicked() {
                        let add = |scenario| WindowCommand::Comparison(ComparisonCommand::Add(Box::new(scenario)));
                        commands.extend(refused.with(way).map(add).map(Command::from));
                    }
                }
                let label = Label::new(RichText::new(&why).font(plain(11.5)).color(colour(p.dim)));
                area.add(label.truncate()).on_hover_text(&why);
            });
        }
    }
}

/// Draws a short sample of a line in the style of the plots.
pub(super) fn sample(ui: &Ui, rect: egui::Rect, dash: Option<[f32; 2]>, tone: egui::Color32) {
    let ends = [rect.left_center(), rect.right_center()];
    let stroke = egui::Stroke::new(1.6, tone);
    let shapes = match dash {
        Some([on, off]) => egui::Shape::dashed_line(&ends, stroke, on, off),
        None => vec![egui::Shape::line_segment(ends, stroke)],
    };
    ui.painter().extend(shapes);
}
