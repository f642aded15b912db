//! The keyboard, and the card that lists keys and gestures.

use egui::{Context, Grid, Key, KeyboardShortcut, Modifiers, RichText, ScrollArea, TextEdit, Ui};

use super::actions::{ACTIONS, Action, ActionGroup, FINE_ACTIONS, GESTURES, shortcut_label};
use super::guide::GuideStep;
use super::notation;
use super::status::news::News;
use super::theme::{bold, colour, plain};
use super::widgets::name;
use super::{
    Command, Layout, OpenDialogs, Pen, PenChange, SessionCommand, Switch, Tool, ViewChange, ViewState, WindowCommand,
    search,
};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Session;

/// Turns pressed keys into commands. While a text field has the focus, only the keys of `works_while_typing` and
/// Esc count.
pub fn read(ctx: &Context, session: &Session, view_state: &ViewState, commands: &mut Vec<Command>) {
    // The card of a note has fields and lists, which take the keys.
    let typing = ctx.egui_wants_keyboard_input()
        || view_state.open.note.is_some()
        || view_state.open.dialog.is_some()
        || view_state.open.export.is_some()
        || view_state.open.finder.is_some();
    let pressed = |key: &KeyboardShortcut| ctx.input_mut(|i| i.consume_shortcut(key));
    // During a drag or with a list open, Esc only ends the drag or closes the list.
    let busy = view_state.gesture.grabbed.is_some()
        || view_state.open.history
        || view_state.open.naming.is_some()
        || view_state.open.note.is_some()
        || ctx.input(|i| i.pointer.any_down())
        || (view_state.open.finder.is_none() && egui::Popup::is_any_open(ctx))
        || super::plots::is_looking(ctx);
    if !busy && pressed(&KeyboardShortcut::new(Modifiers::NONE, Key::Escape)) {
        commands.push(escape(session, view_state));
    }
    // The field of the guide's search has no use for these keys either.
    if view_state.open.guide.is_some() {
        for (key, step) in [(Key::ArrowLeft, GuideStep::Back), (Key::ArrowRight, GuideStep::Forward)] {
            if pressed(&KeyboardShortcut::new(Modifiers::ALT, key)) {
                commands.push(ViewChange::Guide(step).into());
            }
        }
    }
    let allowed = |key: &KeyboardShortcut| !typing || works_while_typing(key);
    // Shortcuts with Shift or Alt come first, because a shortcut without them would match the same key.
    let mut all: Vec<(&Action, &KeyboardShortcut)> = ACTIONS
        .iter()
        .chain(FINE_ACTIONS)
        .flat_map(|action| action.keys.iter().map(move |key| (action, key)))
        .collect();
    all.sort_by_key(|(_, key)| !(key.modifiers.shift || key.modifiers.alt));
    // After a key that opens a text field, no other key of this pass is a shortcut, as the user may already be typing
    // text.
    if let Some((action, _)) = all.iter().find(|(_, key)| asks_for_text(key) && pressed(key)) {
        commands.extend(action.command(session, view_state));
        return;
    }
    for (action, key) in all.into_iter().filter(|(_, key)| allowed(key)) {
        if pressed(key) {
            commands.extend(action.command(session, view_state));
        }
    }
    // While one of these keys is held, its changes form one undo entry.
    let moves = [Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown, Key::OpenBracket, Key::CloseBracket];
    if !typing && view_state.gesture.grabbed.is_none() && ctx.input(|i| moves.iter().any(|key| i.key_released(*key))) {
        commands.push(SessionCommand::EndGesture.into());
    }
}

/// Whether no text field uses the key.
fn works_while_typing(key: &KeyboardShortcut) -> bool {
    asks_for_text(key) || matches!(key.logical_key, Key::F1 | Key::F2)
}

/// Whether the key may open a text field: the list of commands, or a file name.
fn asks_for_text(key: &KeyboardShortcut) -> bool {
    key.modifiers.command && [Key::S, Key::O, Key::K, Key::P].contains(&key.logical_key)
}

/// Returns the command of Esc.
fn escape(session: &Session, view_state: &ViewState) -> Command {
    let ViewState { open, tool, arrangement, pair, .. } = view_state;
    match open {
        OpenDialogs { report: Some(_), .. } => ViewChange::Report(None).into(),
        OpenDialogs { dialog: Some(_), .. } => ViewChange::Dialog(None).into(),
        OpenDialogs { export: Some(_), .. } => ViewChange::Export(None).into(),
        OpenDialogs { finder: Some(_), .. } => ViewChange::Switch(Switch::Finder, false).into(),
        OpenDialogs { settings: true, .. } => ViewChange::Switch(Switch::Settings, false).into(),
        OpenDialogs { help: true, .. } => ViewChange::Switch(Switch::Help, false).into(),
        OpenDialogs { guide: Some(_), .. } => ViewChange::Switch(Switch::Guide, false).into(),
        _ if view_state.drawing_pen().is_some_and(Pen::is_busy) => ViewChange::Pen(PenChange::GiveUp).into(),
        _ if let Some(news) = News::of(session, view_state) => news.put_away().into(),
        _ if matches!(tool, Tool::Draw(_)) => ViewChange::Switch(Switch::Drawing, false).into(),
        _ if view_state.mark.is_some() => ViewChange::Mark(None).into(),
        _ if matches!(tool, Tool::Measure(_)) => ViewChange::Switch(Switch::Measuring, false).into(),
        _ if *tool == Tool::Push => ViewChange::Switch(Switch::Pushing, false).into(),
        _ if pair.as_ref().is_some_and(|pair| !pair.demonstrates) => ViewChange::Switch(Switch::Pair, false).into(),
        _ if arrangement.layout == Layout::Present => ViewChange::Layout(Layout::Explore).into(),
        OpenDialogs { tour: Some(_), .. } => WindowCommand::Tour(false).into(),
        _ => WindowCommand::SkipHints.into(),
    }
}

/// Draws the card of keys and gestures, in groups, with a search field.
pub fn help(ctx: &Context, view_state: &ViewState, commands: &mut Vec<Command>) {
    if !view_state.open.help {
        return;
    }
    let p = view_state.palette();
    let mut open = true;
    let window = egui::Window::new("Keys and gestures").open(&mut open).collapsible(false).resizable(false);
    window.anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]).show(ctx, |ui| {
        ui.horizontal(|ui| {
            if ui.button("Take the tour").clicked() {
                commands.push(WindowCommand::Tour(true).into());
            }
            ui.label(RichText::new("what this is about, in seven steps on the machine itself").color(colour(p.dim)));
            if ui.button("Open the guide").on_hover_text("F2").clicked() {
                commands.push(ViewChange::Switch(Switch::Guide, true).into());
            }
        });
        ui.add_space(4.0);
        let id = egui::Id::unique("keys sought");
        let mut sought = ui.data(|d| d.get_temp::<String>(id)).unwrap_or_default();
        let field = ui.add(TextEdit::singleline(&mut sought).hint_text("search the keys").desired_width(f32::INFINITY));
        name(&field, "Search the keys");
        // Letters typed here are no shortcuts.
        if ctx.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        ui.data_mut(|d| d.insert_temp(id, sought.clone()));
        ui.add_space(6.0);
        let [width, height] = [ctx.content_rect().width(), ctx.content_rect().height()];
        let room = (height - 190.0).max(160.0);
        ScrollArea::vertical().max_height(room).min_scrolled_height(room).show(ui, |ui| {
            let lines = sheet(&sought);
            if lines.is_empty() {
                ui.label(RichText::new("no key answers this").color(colour(p.dim)));
            }
            // Two columns where there is room for both.
            if width >= 1000.0 {
                let half = lines.iter().map(|(_, lines)| lines.len() + 2).sum::<usize>().div_ceil(2);
                let mut before = 0;
                let (left, right): (Vec<_>, Vec<_>) = lines.into_iter().partition(|(_, lines)| {
                    before += lines.len() + 2;
                    before <= half + 2
                });
                ui.horizontal_top(|ui| {
                    for (i, column) in [left, right].into_iter().enumerate() {
                        ui.vertical(|ui| groups(ui, &p, i, &column));
                        ui.add_space(12.0);
                    }
                });
            } else {
                groups(ui, &p, 0, &lines);
            }
        });
    });
    if !open {
        commands.push(ViewChange::Switch(Switch::Help, false).into());
    }
}

type Lines = Vec<(String, &'static str)>;

/// Returns the groups of lines that match the search text: the title of each group, then keys and their effects.
fn sheet(sought: &str) -> Vec<(&'static str, Lines)> {
    let matches = |keys: &str, does: &str| search::score(sought, &format!("{does} {keys}")).is_some();
    let of = |group: ActionGroup| -> Lines {
        let keyed = ACTIONS.iter().filter(|action| action.group == group && !action.keys.is_empty());
        let lines = keyed.map(|action| (all_keys(action), action.name));
        lines.filter(|(keys, does)| matches(keys, does)).collect()
    };
    let pointer = GESTURES.iter().filter(|(keys, does)| matches(keys, does));
    let pointer = ("Pointer", pointer.map(|(keys, does)| ((*keys).to_owned(), *does)).collect::<Lines>());
    let mut all: Vec<(&'static str, Lines)> = Vec::new();
    for group in ActionGroup::ALL {
        match all.last_mut().filter(|(title, _)| *title == group.title()) {
            Some((_, lines)) => lines.extend(of(group)),
            None => all.push((group.title(), of(group))),
        }
    }
    all.into_iter().chain([pointer]).filter(|(_, lines)| !lines.is_empty()).collect()
}

/// Returns the keys of an action, without repetitions.
fn all_keys(action: &Action) -> String {
    let mut keys: Vec<String> = action.keys.iter().map(shortcut_label).collect();
    keys.dedup();
    keys.join("  ")
}

fn groups(ui: &mut Ui, p: &Palette, column: usize, groups: &[(&str, Lines)]) {
    for (title, lines) in groups {
        ui.label(RichText::new(title.to_uppercase()).font(bold(11.0)).color(colour(p.dim)));
        Grid::new((column, *title)).num_columns(2).spacing([18.0, 5.0]).show(ui, |ui| {
            for (keys, does) in lines {
                ui.label(RichText::new(keys).font(bold(12.5)));
                let does = notation::sentence(ui.ctx(), does);
                ui.label(RichText::new(does).font(plain(12.5)).color(colour(p.dim)));
                ui.end_row();
            }
        });
        ui.add_space(8.0);
    }
}
