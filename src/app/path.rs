//! The section *Path* of the panel on the left: kind of task, shape, time law, points and corners.

use std::f64::consts::{PI, TAU};

use egui::{Align, Button, ComboBox, Layout, RichText, Ui};

use super::theme::{colour, plain};
use super::widgets::{NumberRow, name, note, send, unit};
use super::{Command, GuidePage, SessionCommand, fit, guide, place};
use stillbase_mechanics::planar::Vector;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Palette;
use stillbase_planning::off_plane::least_reaction::FixedB;
use stillbase_planning::off_plane::momentum::TipFrame;
use stillbase_planning::posture::Posture;
use stillbase_planning::timing::TimeLaw;
use stillbase_session::scenario::{Corners, PathShape, ReactionObjective, Task, TaskChange, TaskKind, Value};
use stillbase_session::{Edit, Session, base_forecast};
use stillbase_settings::number::counted;
use stillbase_settings::word::{Choice, ChoiceWords};
use stillbase_simulation::plant::BaseKind;

/// Maximum number of points that are listed.
const MAX_LISTED_POINTS: usize = 8;

/// Draws this panel.
pub fn show(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    guide::section(ui, p, "Path", GuidePage::Planning, commands);
    let task = &session.scenario().task;
    let half = 0.5 * (ui.available_width() - ui.spacing().item_spacing.x);
    let mut kinds = TaskKind::ALL.to_vec();
    // Kinds that need more than points come last.
    kinds.sort_by_key(|kind| matches!(kind, TaskKind::SameTip | TaskKind::Given));
    choose(ui, session, ChoiceRow { label: "Redundancy", key: "kind", width: 2.0 * half }, &kinds, task.kind, commands);
    ui.horizontal(|ui| {
        // A loop that turns the base has its own shape.
        if task.kind != TaskKind::TurnBase {
            choose(
                ui,
                session,
                ChoiceRow { label: "Shape", key: "shape", width: half - 16.0 },
                PathShape::ALL,
                task.shape(),
                commands,
            );
        }
        choose(
            ui,
            session,
            ChoiceRow { label: "Time law", key: "law", width: half - 16.0 },
            TimeLaw::ALL,
            task.law,
            commands,
        );
    });
    time(ui, session, p, commands);
    points(ui, session, task, p, commands);
    corners(ui, task, p, commands);
    kind_settings(ui, session, task, p, commands);
    costs(ui, session, p);
}

/// A row of the panel with a list of choices.
struct ChoiceRow<'a> {
    label: &'a str,
    /// Key of the task.
    key: &'a str,
    /// Width of the list, points.
    width: f32,
}

/// Returns the edit that chooses a word for a key of the task, with what must change besides.
pub fn chosen(session: &Session, key: &str, word: &str) -> Edit {
    let mut change = TaskChange::from_iter([(key.to_owned(), Value::String(word.into()))]);
    if word == "arc" && session.scenario().task.via.is_empty() {
        // The via point of the new arc is the middle of the present path.
        let p = session.run().end_effector_on_path(0.5);
        change.insert("via".into(), vec![vec![p.re, p.im]].into());
    }
    if key == "kind" {
        // Keys that the new kind may lack return to their defaults.
        change.extend(["b_to", "moment_limit"].map(|key| (key.into(), "default".into())));
        let takes = ["given", "reactionless", "minimum-norm", "zero-momentum"].contains(&word);
        if session.scenario().task.samples.as_ref().is_some_and(|s| s.columns() != 2 || !takes) {
            change.extend(["samples", "turn"].map(|key| (key.into(), "default".into())));
        }
    }
    Edit::of("task", change)
}

/// Draws the choices of a key of the task.
fn choose<T: Choice>(
    ui: &mut Ui,
    session: &Session,
    row: ChoiceRow<'_>,
    choices: &[T],
    now: T,
    commands: &mut Vec<Command>,
) {
    let ChoiceRow { label, key, width } = row;
    let combo = ComboBox::from_id_salt(key).selected_text(now.words().screen).width(width);
    let response = combo.show_ui(ui, |ui| {
        for choice in choices {
            let ChoiceWords { file: word, screen, meaning } = choice.words();
            if ui.selectable_label(*choice == now, screen).on_hover_text(meaning).clicked() && *choice != now {
                commands.extend([
                    Command::Session(SessionCommand::Edit(chosen(session, key, word))),
                    Command::Session(SessionCommand::EndGesture),
                ]);
            }
        }
    });
    name(&response.response.on_hover_text(now.words().meaning), label);
}

/// Sets one key of the task, and ends the gesture, so that the edit is a separate undo entry.
fn set(commands: &mut Vec<Command>, key: &str, value: impl Into<Value>) {
    commands.extend([
        Command::Session(SessionCommand::Edit(Edit::at(&["task", key], value))),
        Command::Session(SessionCommand::EndGesture),
    ]);
}

fn time(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    if session.scenario().task.law.is_fastest() {
        let pace = session.run().plan().pace;
        let held_back =
            pace.and_then(|p| p.leading).map_or(String::new(), |limit| format!(", held back by the {limit}"));
        let gap = pace.and_then(|p| p.gap()).filter(|gap| *gap > 5e-4);
        let gap = gap.map_or(String::new(), |gap| format!(", {:.1} % longer than with unlimited jerk", 100.0 * gap));
        note(ui, p, &format!("T = {} s{held_back}{gap}", signed(session.run().planned_time(), 3)));
        if let Some(blended) = session.run().plan().blended {
            note(ui, p, &format!("rests at its corners: rounded off it would take {} s", signed(blended, 3)));
        }
        return;
    }
    let mut time = session.scenario().task.time;
    let tip = "Duration T from A to B: peaks of torque go with 1/T²";
    let row = NumberRow::of("time T", "task.time").sliding(0.1..=10.0);
    // A motion takes one step at least.
    let range = row.range.start().max(session.scenario().step)..=*row.range.end();
    let row = NumberRow { tip, range, ..row };
    let responses = row.with_slider(ui, p, &mut time);
    send(commands, &responses, || Edit::set("task.time", time));
}

/// Draws the points of the path, to edit, reorder and remove.
fn points(ui: &mut Ui, session: &Session, task: &Task, p: &Palette, commands: &mut Vec<Command>) {
    if let Some(samples) = &task.samples {
        note(ui, p, &format!("the motion over time is given by {}", counted(samples.count(), "sample")));
        return;
    }
    let all = task.points();
    if all.len() > MAX_LISTED_POINTS || task.shape() == PathShape::Freehand {
        note(ui, p, &format!("{} points from A to B", all.len()));
        return;
    }
    let change = |commands: &mut Vec<Command>, change: Option<TaskChange>, lasts: bool| {
        if let Some(change) = change {
            commands.push(SessionCommand::Edit(Edit::of("task", change)).into());
        }
        if !lasts {
            commands.push(SessionCommand::EndGesture.into());
        }
    };
    for (i, at) in all.iter().enumerate() {
        let row = |ui: &mut Ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let label = task.name_of(i);
            let unserved = session.run().waiting().is_some_and(|w| w.points.iter().any(|(n, _)| *n == i));
            let ink = colour(if unserved { p.reaction } else { p.ink });
            let words = RichText::new(&label).color(ink);
            ui.add_sized([14.0, 18.0], egui::Label::new(words).halign(Align::LEFT));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                unit(ui, p, "m");
                let small = |ui: &mut Ui, enabled: bool, text: &str, label: &str, tip: &str| {
                    let text = RichText::new(text).font(plain(11.0)).color(colour(p.dim));
                    let button = Button::new(text).frame(false).min_size(egui::vec2(14.0, 18.0));
                    let response = ui.add_enabled(enabled, button).on_hover_text(tip);
                    name(&response, label);
                    response.clicked()
                };
                if small(ui, all.len() > 2, "×", &format!("Leave out {label}"), "Leave this point out (Delete)") {
                    change(commands, task.removing(i), false);
                }
                if small(ui, i > 0, "↑", &format!("{label} earlier"), "Visit this point one place earlier") {
                    change(commands, task.advancing(i), false);
                }
                let mut xy = [at.re, at.im];
                let mut responses = Vec::new();
                for (axis, word) in [(1, "y"), (0, "x")] {
                    let label = format!("{label} {word}");
                    let tip = "A point of the path; drag it in the scene, or type";
                    let row = NumberRow { tip, ..NumberRow::of(&label, "task.from").with(3, 0.002) };
                    responses.push(row.number(ui, &mut xy[axis]));
                }
                if responses.iter().any(|r| r.changed()) {
                    change(commands, task.moving(i, Vector::new(xy[0], xy[1])), true);
                }
                if responses.iter().any(|r| r.drag_stopped() || r.lost_focus()) {
                    commands.push(SessionCommand::EndGesture.into());
                }
            });
        };
        place::place_of_thing(ui, Handle::Waypoint(i), p, |ui| ui.horizontal(row));
    }
    if all.len() < 2 {
        return;
    }
    let plus = RichText::new("+ point").font(plain(11.5)).color(colour(p.dim));
    let response =
        ui.add(Button::new(plus).frame(false)).on_hover_text("One more point before B; or double-click in the scene");
    name(&response, "Add a point");
    if response.clicked() {
        let last = all.len() - 1;
        let middle = 0.5 * (all[last - 1] + all[last]);
        // Between A and B alone, the new point lies on the path, so that the machine can reach it.
        let at = if all.len() == 2 { session.run().end_effector_on_path(0.5) } else { middle };
        change(commands, task.adding(at), false);
    }
}

fn corners(ui: &mut Ui, task: &Task, p: &Palette, commands: &mut Vec<Command>) {
    let straight = matches!(task.shape(), PathShape::JointLine | PathShape::Line);
    ui.horizontal_wrapped(|ui| {
        let mut closed = task.closed;
        let tip = "Return from B to A";
        if ui
            .add_enabled(
                !matches!(task.kind, TaskKind::SameTip | TaskKind::TurnBase),
                egui::Checkbox::new(&mut closed, "closed"),
            )
            .on_hover_text(tip)
            .changed()
        {
            set(commands, "closed", closed);
        }
        let mut off = task.keep_off_change_points;
        let tip =
            "Keep to one side of every change point, where two drives are parallel and pin forces grow without bound";
        if ui.checkbox(&mut off, "off change points").on_hover_text(tip).changed() {
            set(commands, "keep_off_change_points", off);
        }
    });
    if straight && (task.via.len() + usize::from(task.closed)) > 0 {
        ui.horizontal(|ui| {
            let mut blend = task.corners == Corners::Blend;
            let tip = "Round corners off instead of coming to rest there";
            if ui.checkbox(&mut blend, "blend corners").on_hover_text(tip).changed() {
                set(commands, "corners", if blend { Corners::Blend } else { Corners::Stop }.words().file);
            }
            if blend {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let measure = if task.shape() == PathShape::JointLine { "rad" } else { "m" };
                    unit(ui, p, measure);
                    let mut distance = task.blend;
                    let row = NumberRow { unit: measure, ..NumberRow::of("blend", "task.blend").with(3, 0.002) };
                    let response = row.number(ui, &mut distance);
                    send(commands, &[response], || Edit::set("task.blend", distance));
                });
            }
        });
    }
}

/// Draws the settings that only some kinds of task have.
fn kind_settings(ui: &mut Ui, session: &Session, task: &Task, p: &Palette, commands: &mut Vec<Command>) {
    let plan = session.run().plan();
    match task.kind {
        TaskKind::Reactionless | TaskKind::Given
            if session.scenario().condition_for_effect("task.posture").is_none() =>
        {
            let width = ui.available_width() - 10.0;
            choose(
                ui,
                session,
                ChoiceRow { label: "Freedoms left", key: "posture", width },
                Posture::ALL,
                task.posture,
                commands,
            );
            if let Some(drift) = plan.drift().next() {
                note(ui, p, &format!("the drives end up to {} rad from where they began", signed(drift, 3)));
            }
            if session.scenario().condition_for_effect("task.orientation").is_none() {
                let machine = &session.scenario().machine;
                let link = &machine.resolved_links()[machine.end_link()];
                let turned = plan.motion.path.at(0.0).q[link.drive] + if link.sign < 0.0 { PI } else { 0.0 };
                let mut angle = task.orientation.unwrap_or(turned - TAU * (turned / TAU).round());
                let tip = "Which way the last link points, counted from the x axis; the path keeps it";
                let row = NumberRow { tip, ..NumberRow::of("hand points to", "task.orientation").with(3, 0.005) };
                let response = row.show(ui, p, &mut angle);
                send(commands, &[response], || Edit::set("task.orientation", angle));
            }
        }
        TaskKind::ChangeB => {
            let mut b_to = plan.forecast.b_end;
            let row = NumberRow::of("b at B", "task.b_to").with(3, 0.005);
            let response = row.show(ui, p, &mut b_to);
            send(commands, &[response], || Edit::set("task.b_to", b_to));
            let mut limited = task.moment_limit.is_some();
            let mut limit = task.moment_limit.unwrap_or((0.5 * plan.forecast.moment).max(0.1));
            ui.horizontal(|ui| {
                let tip = "A bound on |n_B| while b changes: it sets the time";
                if ui.checkbox(&mut limited, "n_B at most").on_hover_text(tip).changed() {
                    let value = if limited { Value::Float(limit) } else { Value::String("default".into()) };
                    set(commands, "moment_limit", value);
                }
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    unit(ui, p, "N m");
                    if limited {
                        let row = NumberRow::of("n_B at most", "task.moment_limit").with(2, 0.02);
                        let response = row.number(ui, &mut limit);
                        send(commands, &[response], || Edit::set("task.moment_limit", limit));
                    }
                });
            });
            if let Some(price) = plan.price.filter(|price| price.delta_b().abs() > 1e-9) {
                let words = format!(
                    "Δb {} rad; no motion of this time gets below {} N m",
                    signed(price.delta_b(), 3),
                    signed(price.least_peak(plan.forecast.time), 3)
                );
                note(ui, p, &words);
            }
        }
        TaskKind::LeastReaction => {
            let width = ui.available_width() - 10.0;
            choose(
                ui,
                session,
                ChoiceRow { label: "What to keep small", key: "least", width },
                ReactionObjective::ALL,
                task.least,
                commands,
            );
            if let Some(verdicts) = &plan.verdicts {
                let fixed = match verdicts.fixed {
                    FixedB::Serves => "b can stay: no reaction at all".into(),
                    FixedB::Leaves { u, .. } => format!("b could stay until {:.0} % of T", 100.0 * u),
                };
                let norm = verdicts.minimum_norm.as_ref().ok();
                let norm =
                    norm.map_or(String::new(), |n| format!("; minimum-norm rates: {} N m", signed(n.reaction.peak, 3)));
                note(ui, p, &format!("{fixed}{norm}"));
            }
        }
        TaskKind::ZeroMomentum => {
            if session.scenario().base.kind == BaseKind::Free {
                let width = ui.available_width() - 10.0;
                let row = ChoiceRow { label: "Where points are meant", key: "frame", width };
                choose(ui, session, row, TipFrame::ALL, task.frame(), commands);
            }
            if session.scenario().condition_for_effect("task.turn_limit").is_none() {
                let mut limit = task.turn_limit;
                let row = NumberRow::of("base may turn by", "task.turn_limit").with(2, 0.1);
                let response = row.show(ui, p, &mut limit);
                send(commands, &[response], || Edit::set("task.turn_limit", limit));
                if let Some(turn) = &plan.base_turn {
                    let is_crossed = session.scenario().machine.is_redundant();
                    let why = if is_crossed { "across a singularity" } else { "as two drives go in one way" };
                    note(ui, p, &format!("the base turns by {:.2}°, {why}", turn.angle.to_degrees()));
                }
            }
            cycles(ui, task, p, commands);
            if task.closed {
                let every = (task.cycles as usize).div_ceil(10).max(1);
                let rounds: Vec<String> = plan.drift().skip(every - 1).step_by(every).map(|d| signed(d, 3)).collect();
                let each = if every == 1 { "each cycle".into() } else { format!("every {every} cycles") };
                note(ui, p, &format!("drift of the joints after {each}: {} rad", rounds.join("  ")));
            }
        }
        TaskKind::TurnBase => {
            let mut turn = task.base_turn;
            let tip = "By how much the closed motion turns the base, counterclockwise";
            let row = NumberRow { tip, ..NumberRow::of("turn the base by", "task.base_turn").with(2, 0.05) };
            let response = row.show(ui, p, &mut turn);
            send(commands, &[response], || Edit::set("task.base_turn", turn));
            cycles(ui, task, p, commands);
            if let Some(length) = plan.loop_length {
                note(ui, p, &format!("shortest loop found: {} rad in drive angles", signed(length, 3)));
            }
        }
        TaskKind::Reactionless | TaskKind::MinimumNorm | TaskKind::SameTip | TaskKind::Given => {}
    }
}

/// Draws the number of times that a closed path is followed.
fn cycles(ui: &mut Ui, task: &Task, p: &Palette, commands: &mut Vec<Command>) {
    let mut cycles = f64::from(task.cycles);
    let row = NumberRow::of("cycles", "task.cycles").with(0, 0.05);
    let response = row.show(ui, p, &mut cycles);
    send(commands, &[response], || Edit::set("task.cycles", cycles.round() as i64));
}

/// Draws the forecast of the planned motion: always two lines, so that nothing below moves. A limit that the motion
/// exceeds is named in place of the first line.
fn costs(ui: &mut Ui, session: &Session, p: &Palette) {
    let forecast = &session.run().plan().forecast;
    let torque = forecast.torque.max_abs();
    // The plan is computed for the model, and a compliant base is taken to stand still; the status line shows the effects
    // of plant and base.
    let scenario = session.scenario();
    let (is_model, is_compliant) = (scenario.plant == Default::default(), scenario.base.kind == BaseKind::Compliant);
    let waits = session.run().waiting().is_some();
    let turn = base_forecast(session.run());
    let of = match session.is_dragged() {
        _ if waits => "the run waits, nothing is planned",
        true => "led by hand; the plan was",
        false if is_compliant => "planned, for the model on a fixed base",
        false if is_model => "planned",
        false => "planned, for the model",
    };
    let [time, torque, moment] = [forecast.time, torque, forecast.moment].map(|x| signed(x, 3));
    let figures = match waits {
        true => "change limits, points or b".into(),
        false => {
            // A limit that is named in place of the first line leaves no other word that these are planned.
            let planned = if forecast.exceeded_limit.is_some() { "planned: " } else { "" };
            match turn {
                Some(base) => format!("{planned}{time} s  ·  τ {torque} N m  ·  θ {} rad", signed(base.angle_end, 4)),
                None => format!("{planned}{time} s  ·  τ {torque}  ·  n_B {moment} N m"),
            }
        }
    };
    let (first, ink) = match forecast.exceeded_limit {
        Some((limit, factor)) => (format!("{limit} is {} times its limit", signed(factor, 2)), p.reaction),
        None => (of.to_owned(), p.dim),
    };
    for (words, ink, tip) in [
        (first, ink, "The line at the bottom says what the run comes to"),
        (
            figures,
            p.dim,
            if waits {
                "It goes on once the limits, the points or b let it"
            } else {
                "What the plan foresees: its duration, its largest |τ| and its largest |n_B|, or how far a free base turns; \
                 the report has those of the run"
            },
        ),
    ] {
        let words = crate::notation::sentence(ui.ctx(), &words);
        fit::label(ui, &words, plain(11.0), colour(ink)).on_hover_text(tip);
    }
}
