//! [`FileReport`]: the list about a file that was read or written: its faults, or what was left out of it.

use std::path::Path;

use egui::{RichText, ScrollArea, TextStyle, Ui};

use super::theme::{bold, colour, plain};
use super::widgets::name;
use super::{Command, ViewChange, ViewState, WindowCommand};
use stillbase_picture::scene::palette::Palette;
use stillbase_settings::fault::{Fault, Faults};
use stillbase_settings::number::counted;

/// A list about a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileReport {
    /// The file, as the user knows it.
    file: String,
    content: ReportContent,
}

/// Content of a list about a file.
#[derive(Clone, Debug, PartialEq, Eq)]
enum ReportContent {
    /// What is wrong in a file that was not taken.
    Faults(Faults),
    /// What was left out when a file was read.
    NotRead(Vec<String>),
    /// What was left out when a file was written.
    NotWritten(Vec<String>),
}

/// Width of the list, and its maximum height, points.
const WIDTH_PT: f32 = 560.0;
const HEIGHT_PT: f32 = 360.0;

impl FileReport {
    /// Returns the list of a file with faults.
    pub fn of_faults(file: &str, faults: &Faults) -> Self {
        Self { file: file.into(), content: ReportContent::Faults(faults.clone()) }
    }

    /// Returns the list of what was left out of a file that was read; `None` if nothing was.
    pub fn not_read(file: &Path, left_out: Vec<String>) -> Option<Self> {
        Self::unless_empty(file, ReportContent::NotRead(left_out))
    }

    /// Returns the list of what was left out of a file that was written; `None` if nothing was.
    pub fn not_written(file: &Path, left_out: Vec<String>) -> Option<Self> {
        Self::unless_empty(file, ReportContent::NotWritten(left_out))
    }

    fn unless_empty(file: &Path, content: ReportContent) -> Option<Self> {
        let (ReportContent::NotRead(list) | ReportContent::NotWritten(list)) = &content else { return None };
        (!list.is_empty()).then(|| Self { file: file.display().to_string(), content })
    }

    /// Returns its title.
    pub fn title(&self) -> String {
        let file = Path::new(&self.file).file_name().map_or_else(|| self.file.clone(), |n| n.display().to_string());
        match &self.content {
            ReportContent::Faults(faults) => format!("{file}: {}", faults.counted()),
            ReportContent::NotRead(list) => {
                format!("{file}: {} left out when it was read", counted(list.len(), "thing"))
            }
            ReportContent::NotWritten(list) => {
                format!("{file}: {} left out when it was written", counted(list.len(), "thing"))
            }
        }
    }

    /// Returns the list as text.
    pub fn text(&self) -> String {
        match &self.content {
            ReportContent::Faults(faults) => {
                let one = |fault: &Fault| format!("{}\n{}", fault.in_file(&self.file), indented(&fault.example));
                let all: String = faults.list.iter().map(one).collect();
                all + &faults.rest().map(|rest| rest + "\n").unwrap_or_default()
            }
            ReportContent::NotRead(list) | ReportContent::NotWritten(list) => {
                list.iter().map(|what| format!("{}: {what}\n", self.file)).collect()
            }
        }
    }
}

/// Returns an example with its lines indented.
fn indented(example: &str) -> String {
    example.lines().map(|line| format!("    {line}\n")).collect()
}

/// Draws the list, if there is one.
pub fn show(ctx: &egui::Context, view_state: &ViewState, commands: &mut Vec<Command>) {
    let Some(report) = &view_state.open.report else { return };
    let p = view_state.palette();
    let mut open = true;
    let room = ctx.content_rect().size();
    let window = egui::Window::new(report.title()).id(egui::Id::unique("file report")).open(&mut open);
    let window = window.collapsible(false).resizable(false).anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]);
    window.show(ctx, |ui| {
        ui.set_width(WIDTH_PT.min(room.x - 60.0));
        let height = HEIGHT_PT.min(0.6 * room.y);
        ScrollArea::vertical()
            .max_height(height)
            .auto_shrink([false, true])
            .show(ui, |ui| list(ui, &p, report, commands));
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            let copy = ui.button("Copy the list").on_hover_text("for a text editor, with lines and examples");
            if copy.clicked() {
                commands.push(WindowCommand::Copy(report.text()).into());
            }
            let close = ui.button("Close").on_hover_text("Esc");
            if close.clicked() {
                commands.push(ViewChange::Report(None).into());
            }
        });
    });
    if !open {
        commands.push(ViewChange::Report(None).into());
    }
}

fn list(ui: &mut Ui, p: &Palette, report: &FileReport, commands: &mut Vec<Command>) {
    let text = |ui: &mut Ui, words: &str| {
        let words = RichText::new(words).font(plain(12.5)).color(colour(p.ink));
        ui.add(egui::Label::new(words).wrap().selectable(true));
    };
    match &report.content {
        ReportContent::Faults(faults) => {
            for (i, fault) in faults.list.iter().enumerate() {
                let place = match (fault.line, fault.column) {
                    (Some(line), Some(column)) => format!("line {line}, column {column}"),
                    (Some(line), None) => format!("line {line}"),
                    _ => "the whole file".to_owned(),
                };
                ui.label(RichText::new(place).font(bold(11.5)).color(colour(p.dim)));
                text(ui, &fault.text);
                if !fault.example.is_empty() {
                    example(ui, p, i, &fault.example, commands);
                }
                ui.add_space(8.0);
            }
            if let Some(rest) = faults.rest() {
                ui.label(RichText::new(rest).font(plain(12.5)).color(colour(p.dim)));
            }
        }
        ReportContent::NotRead(list) | ReportContent::NotWritten(list) => {
            for what in list {
                text(ui, what);
                ui.add_space(6.0);
            }
        }
    }
}

/// Draws an example as it may be pasted, with a button that copies it.
fn example(ui: &mut Ui, p: &Palette, number: usize, lines: &str, commands: &mut Vec<Command>) {
    ui.horizontal_top(|ui| {
        ui.label(RichText::new("for example").font(plain(11.5)).color(colour(p.dim)));
        let words = RichText::new(lines).text_style(TextStyle::Monospace).color(colour(p.ink));
        ui.add(egui::Label::new(words).selectable(true));
        let copy = ui.small_button("Copy");
        name(&copy, &format!("Copy example {}", number + 1));
        if copy.clicked() {
            commands.push(WindowCommand::Copy(lines.into()).into());
        }
    });
}
