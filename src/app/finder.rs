//! The list of commands: every action, note, scenario, machine, signal, setting, recent file and heading of the guide,
//! searched by a few letters. A setting followed by a value, such as `payload 0.4`, is set from here.

use std::path::PathBuf;
use std::sync::Arc;

use egui::{Align2, Area, Frame, Id, Key, Modifiers, Order, RichText, ScrollArea, TextEdit, Ui, vec2};

use super::actions::{ACTIONS, shortcut_label};
use super::facts::{ScenarioFacts, Setting};
use super::guide::{self, GuideStep, Section};
use super::path::chosen;
use super::side::setting;
use super::theme::{bold, colour, plain};
use super::top::with_machine;
use super::widgets::name;
use super::{Command, NoteDraft, SessionCommand, Switch, ViewChange, ViewState, search};
use stillbase_mechanics::machine;
use stillbase_picture::charts::choice::PlotChange;
use stillbase_picture::notation::Notation;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::scenario::{Scenario, TaskKind, Value};
use stillbase_session::{Edit, Proposal, Session};
use stillbase_settings::word::{Choice as _, ChoiceWords};
use stillbase_simulation::signals::Signal;

/// A line of the list.
struct Entry<'a> {
    title: String,
    place: &'static str,
    /// Further search words.
    also: &'a str,
    /// Shown only if there is a search text.
    hides: bool,
    /// Whether it is a heading of the guide. Its score is halved, so that commands come before explanations.
    tells: bool,
    keys: String,
    /// Makes the command; called only for the line that the user picks.
    command: Box<dyn FnOnce() -> Command + 'a>,
}

/// Place of the signals, and the reduction of their scores: many have the same name, one for each drive.
const SIGNALS_PLACE: &str = "plots";
const SIGNALS_STEP_BACK: i32 = 24;

/// Place of the proposals that improve the plan, and the increase of their scores.
const WAYS_PLACE: &str = "status line";
const WAYS_BONUS: i32 = 40;

/// Maximum number of lines.
const MAX_ENTRIES: usize = 60;

/// Number of lines visible at once, and height of a line with the gap below, points.
const VISIBLE_ROWS: f32 = 10.0;
const ROW_HEIGHT_PT: f32 = 27.0;

/// What there is to be found, beside the actions.
#[derive(Clone, Copy)]
struct Known<'a> {
    session: &'a Session,
    signals: &'a [Signal],
    settings: &'a [Setting],
    recent: &'a [PathBuf],
    sections: &'a [Section],
    /// Proposals that improve the plan on display.
    improvements: &'a [Proposal],
}

/// Returns the entries available now: actions, notes, recent files, scenarios, machines, signals, settings, and
/// headings of the guide.
fn entries<'a>(known: Known<'a>, view_state: &ViewState) -> Vec<Entry<'a>> {
    let Known { session, signals, settings, recent, sections, improvements } = known;
    let actions = ACTIONS.iter().filter_map(|action| {
        let command = action.command(session, view_state)?;
        let keys = action.keys.first().map(shortcut_label).unwrap_or_default();
        let (title, place, also) = (action.name.into(), action.place, action.also);
        Some(Entry { title, place, also, hides: false, tells: false, keys, command: Box::new(|| command) })
    });
    let entry = |title: String, place, also, command: Box<dyn FnOnce() -> Command + 'a>| Entry {
        title,
        place,
        also,
        hides: false,
        tells: false,
        keys: String::new(),
        command,
    };
    let open = |title: String, place, scenario: Box<dyn FnOnce() -> Scenario + 'a>| {
        entry(
            title,
            place,
            "open example demo",
            Box::new(|| Command::Session(SessionCommand::Open(Box::new(scenario())))),
        )
    };
    let scenarios = Scenario::builtins().map(|scenario| {
        let key = Scenario::cases().position(|case| case == scenario.name).map(|i| (i + 1).to_string());
        let entry = open(format!("Scenario: {}", scenario.title), "top bar, scenario", Box::new(|| scenario.clone()));
        Entry { keys: key.unwrap_or_default(), ..entry }
    });
    let present = &session.scenario().machine;
    let machines = machine::builtins().iter().filter(move |machine| *machine != present).map(|machine| {
        open(format!("Machine: {}", machine.name()), "top bar, machine", Box::new(|| with_machine(session, machine)))
    });
    let recent = recent.iter().map(|file| {
        let title = format!("Recent: {}", file.file_name().unwrap_or(file.as_os_str()).to_string_lossy());
        entry(
            title,
            "top bar, scenario",
            "open file last",
            Box::new(|| Command::Session(SessionCommand::OpenFile(file.clone()))),
        )
    });
    // A note with a start time leads to that time; a note for all times is opened.
    let notes = session.notes().iter().enumerate().map(|(i, note)| {
        let go = move || match note.time.start() {
            Some(time) => Command::Session(SessionCommand::Seek(time)),
            None => Command::View(ViewChange::WriteNote(NoteDraft::of(session, i, None))),
        };
        entry(format!("Note: {}", note.in_one_line()), "time line, scene", "comment text remark", Box::new(go))
    });
    let signals = signals.iter().map(|signal| {
        let plot = || Command::View(ViewChange::Charts(PlotChange::Plot(signal.path.clone())));
        let title = format!("Plot: {} {}, {}", signal.label, signal.symbol, signal.unit);
        Entry { hides: true, ..entry(title, SIGNALS_PLACE, "signal curve graph csv column", Box::new(plot)) }
    });
    // The links and parts that a scenario holds are those of the machine before, while a drawing is not complete.
    let is_drawn = session.run().unfinished().is_none();
    let is_of_parts = |path: &str| OF_PARTS.iter().any(|list| path.starts_with(list));
    let known = settings.iter().filter(move |setting| is_drawn || !is_of_parts(&setting.path));
    let settings = known.map(|setting| {
        let title = format!("Setting: {}", setting.name_and_path());
        let look_up = || Command::View(ViewChange::LookUp(setting.path.clone()));
        Entry { hides: true, ..entry(title, "left panel, all settings", setting.also.as_str(), Box::new(look_up)) }
    });
    let pages = guide::entries(sections).map(|(title, place)| {
        let also = guide::search_words(&place);
        let read = || Command::View(ViewChange::Guide(GuideStep::Go(place)));
        Entry { hides: true, tells: true, ..entry(title, "guide", also, Box::new(read)) }
    });
    let ways = improvements.iter().filter_map(|proposal| {
        let [edit] = <[_; 1]>::try_from(proposal.edits()).ok()?;
        let take = move || Command::Session(SessionCommand::Edit(edit));
        Some(entry(format!("Way out: {}", proposal.text), WAYS_PLACE, "improve fix mend why", Box::new(take)))
    });
    let present_kind = session.scenario().task.kind;
    let kinds = TaskKind::ALL.iter().filter(move |kind| ![present_kind, TaskKind::Given].contains(kind)).map(|kind| {
        let ChoiceWords { file: word, screen, meaning } = kind.words();
        let choose = || Command::Session(SessionCommand::Edit(chosen(session, "kind", word)));
        Entry { hides: true, ..entry(format!("Path: {screen}"), "left panel, path", meaning, Box::new(choose)) }
    });
    ways.chain(actions)
        .chain(kinds)
        .chain(notes)
        .chain(recent)
        .chain(scenarios)
        .chain(machines)
        .chain(signals)
        .chain(settings)
        .chain(pages)
        .collect()
}

/// Beginnings of the keys of links and of what is on them.
const OF_PARTS: [&str; 6] = ["link.", "part.", "lump.", "counterweight.", "length.", "drive."];

/// Maximum number of settings that are offered for one typed value.
const MAX_TYPED_ENTRIES: usize = 3;

/// Returns the ways to split a search text into the words for a setting and its value, the likeliest first: at `=`, else
/// before each number, else at the last space.
fn splits(sought: &str) -> Vec<(&str, &str)> {
    if let Some(parts) = sought.split_once('=') {
        return vec![parts];
    }
    let begins = |text: &str| text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '−' | '.' | '['));
    let numbers = sought.match_indices(' ').filter(|(i, _)| begins(&sought[i + 1..]));
    let mut splits: Vec<(&str, &str)> = numbers.map(|(i, _)| sought.split_at(i)).collect();
    if splits.is_empty() {
        splits.extend(sought.rsplit_once(' '));
    }
    splits
}

/// Returns entries that set what is typed: a setting by a few letters, and its value after a space or `=`, in the user's
/// unit or with a unit of its own.
fn typed<'a>(settings: &'a [Setting], sought: &str, notation: Notation) -> Vec<Entry<'a>> {
    let is_stated = sought.contains('=');
    let splits = splits(sought.trim()).into_iter().map(|(words, text)| (words.trim(), text.trim()));
    let mut found = splits.filter(|(words, text)| !words.is_empty() && !text.is_empty());
    let found =
        found.find_map(|split| Some(typed_as(settings, split, is_stated, notation)).filter(|found| !found.is_empty()));
    found.unwrap_or_default()
}

/// Returns entries for words and a value; `is_stated` says that the value stands behind `=`.
fn typed_as<'a>(
    settings: &'a [Setting],
    (words, text): (&str, &str),
    is_stated: bool,
    notation: Notation,
) -> Vec<Entry<'a>> {
    // A path that is typed in full comes first.
    let score = |(setting, _): &(&Setting, Value)| match setting.path == words {
        true => Some(i32::MAX),
        // Of several settings with one name, that of the machine comes first: its path is the shortest.
        false => {
            let steps = setting.path.split('.').count() as i32;
            search::score_with(words, &setting.name_and_path(), &setting.also).map(|score| score - steps)
        }
    };
    let fit = settings.iter().filter_map(|setting| {
        let value = setting::typed(text, setting.key, setting::shown_unit(setting.key, notation)).ok()?;
        setting.key.value_type.accepts(&value).then_some((setting, value))
    });
    let entry = |(setting, value): (&'a Setting, Value)| {
        let unit = setting::shown_unit(setting.key, notation);
        let name = unit.map_or(setting.key.unit(), |unit| unit.name);
        let with_unit = |number: &str| match name {
            "" | "1" => number.to_owned(),
            _ if number.ends_with(|c: char| !c.is_ascii_digit()) => number.to_owned(),
            _ => format!("{number} {name}"),
        };
        let path = setting.path.clone();
        let now = match setting.typed.as_str() {
            "" => "none".to_owned(),
            typed => with_unit(&setting::in_unit(typed, unit)),
        };
        Entry {
            title: format!("Set {} to {}, now {now}", setting.name_and_path(), with_unit(text)),
            place: "left panel, all settings",
            also: "",
            hides: false,
            tells: false,
            keys: String::new(),
            command: Box::new(move || Command::Session(SessionCommand::Edit(Edit::set(&path, value)))),
        }
    };
    let best = search::best_first(fit, score, MAX_TYPED_ENTRIES);
    // After a space, a number may also be a name: "mass of link 3" does not set the mass of link 1 to 3.
    let names = |setting: &Setting| {
        let parts = setting.key.path.split('.').zip(setting.path.split('.'));
        let mut own = parts.filter(|(pattern, _)| *pattern == "*").map(|(_, own)| own);
        own.all(|own| words.split([' ', '.']).any(|word| word == own))
    };
    let means_one = |one: &(&Setting, Value)| is_stated || one.0.path == words || names(one.0);
    best.into_iter().filter(means_one).map(entry).collect()
}

/// Returns the entries that match the search text, best first.
fn found<'a>(entries: Vec<Entry<'a>>, sought: &str) -> Vec<Entry<'a>> {
    let score = |entry: &Entry<'_>| {
        let place = || search::score(sought, &format!("{} {}", entry.place, entry.keys)).map(|s| s / 4);
        let score = match entry.tells {
            // Headings of the guide explain; commands come first.
            true => search::score_of_prose(sought, entry.also, &entry.title)? / 2,
            false => search::score_with(sought, &entry.title, entry.also).or_else(place)?,
        };
        // What improves the motion on display comes before another scenario of the same words.
        let bonus = if entry.place == WAYS_PLACE { WAYS_BONUS } else { 0 };
        Some(score + bonus - if entry.place == SIGNALS_PLACE { SIGNALS_STEP_BACK } else { i32::from(entry.hides) })
    };
    let offered = entries.into_iter().filter(|entry| !(entry.hides && sought.trim().is_empty()));
    search::best_first(offered, score, MAX_ENTRIES)
}

/// What the list offers beside actions and settings.
pub struct FinderContent<'a> {
    /// All signals of the machine.
    pub signals: &'a [Signal],
    /// Recent files, newest first.
    pub recent: &'a [PathBuf],
    /// Proposals that improve the plan on display, once they are known.
    pub improvements: Option<Arc<Vec<Proposal>>>,
}

/// Draws the list and handles its keys.
pub fn show(
    ctx: &egui::Context,
    session: &Session,
    facts: &ScenarioFacts<'_>,
    FinderContent { signals, recent, improvements }: &FinderContent<'_>,
    view_state: &mut ViewState,
    commands: &mut Vec<Command>,
) {
    let p = view_state.palette();
    let Some(mut finder) = view_state.open.finder.clone() else { return };
    let settings = facts.settings();
    let sections = facts.guide();
    let improvements: &[Proposal] = improvements.as_ref().map_or(&[], |all| all);
    let known = Known { session, signals, settings: &settings, recent, sections: &sections, improvements };
    let found = found(entries(known, view_state), &finder.search_text);
    let list: Vec<Entry<'_>> =
        typed(&settings, &finder.search_text, view_state.notation()).into_iter().chain(found).collect();
    finder.chosen = finder.chosen.min(list.len().saturating_sub(1));
    let pressed = |key| ctx.input_mut(|i| i.consume_key(Modifiers::NONE, key));
    let (up, down, enter) = (pressed(Key::ArrowUp), pressed(Key::ArrowDown), pressed(Key::Enter));
    match (up, down, list.len()) {
        (true, _, n) if n > 0 => finder.chosen = (finder.chosen + n - 1) % n,
        (_, true, n) if n > 0 => finder.chosen = (finder.chosen + 1) % n,
        _ => {}
    }
    let mut picked = enter.then_some(finder.chosen);
    let width = (ctx.content_rect().width() - 80.0).clamp(280.0, 560.0);
    let area = Area::new(Id::unique("finder")).order(Order::Foreground).anchor(Align2::CENTER_TOP, [0.0, 72.0]);
    let frame = Frame::popup(&ctx.global_style()).fill(colour(p.panel)).inner_margin(10);
    let shown = area.show(ctx, |ui| {
        frame.show(ui, |ui| {
            ui.set_width(width);
            let field = TextEdit::singleline(&mut finder.search_text).hint_text("What would you like to do?");
            let field = ui.add(field.desired_width(f32::INFINITY).font(plain(15.0)).margin(vec2(8.0, 7.0)));
            name(&field, "Find a command");
            field.request_focus();
            if field.changed() {
                finder.chosen = 0;
            }
            ui.add_space(4.0);
            let room = (ctx.content_rect().height() - 180.0).clamp(4.0 * ROW_HEIGHT_PT, VISIBLE_ROWS * ROW_HEIGHT_PT);
            // Without a minimum height, the list would keep the height that it had with fewer lines.
            let list_area = ScrollArea::vertical().max_height(room).min_scrolled_height(room);
            list_area.auto_shrink([false, true]).show(ui, |ui| {
                ui.spacing_mut().item_spacing.y = 1.0;
                for (i, entry) in list.iter().enumerate() {
                    let chosen = i == finder.chosen;
                    let response = line(ui, &p, entry, chosen);
                    if chosen && (up || down) {
                        response.scroll_to_me(None);
                    }
                    if response.clicked() {
                        picked = Some(i);
                    }
                }
                if list.is_empty() {
                    ui.label(RichText::new("no command answers this").color(colour(p.dim)));
                }
            });
        });
    });
    let elsewhere = shown.response.clicked_elsewhere();
    match picked.and_then(|i| list.into_iter().nth(i)) {
        Some(entry) => commands.extend([
            Command::View(ViewChange::Switch(Switch::Finder, false)),
            (entry.command)(),
            Command::Session(SessionCommand::EndGesture),
        ]),
        None if elsewhere => commands.push(ViewChange::Switch(Switch::Finder, false).into()),
        None => view_state.open.finder = Some(finder),
    }
}

fn line(ui: &mut Ui, p: &Palette, entry: &Entry<'_>, chosen: bool) -> egui::Response {
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT_PT - 1.0), egui::Sense::click());
    if chosen || response.hovered() {
        ui.painter().rect_filled(rect, 6.0, colour(p.line));
    }
    // The texts are painted instead of added as widgets, so that a screen reader announces the line as one item.
    let middle = rect.center().y;
    let write = |ui: &Ui, right: f32, text: &str, font, ink| {
        ui.painter().text(egui::pos2(right, middle), Align2::RIGHT_CENTER, text, font, colour(ink)).left()
    };
    let left = write(ui, rect.right() - 8.0, &entry.keys, bold(12.0), p.ink);
    let left = write(ui, left - 10.0, entry.place, plain(11.5), p.dim);
    let title = RichText::new(&entry.title).font(plain(13.0)).color(colour(p.ink));
    let room = left - rect.left() - 20.0;
    let title =
        egui::WidgetText::from(title).into_galley(ui, Some(egui::TextWrapMode::Truncate), room, egui::TextStyle::Body);
    ui.painter().galley(egui::pos2(rect.left() + 8.0, middle - 0.5 * title.size().y), title, colour(p.ink));
    name(&response, &entry.title);
    response
}
