//! The panel on the left: pose constant, limits, motion, plant, base, control, balance, and all settings.

mod all;
mod base;
mod control;
mod fold;
mod plant;
pub mod setting;

pub use all::{look_up, window};

use egui::{Align, Frame, Layout, Margin, Panel, RichText, ScrollArea, Ui};

use super::facts::ScenarioFacts;
use super::notation;
use super::scene_pointer::leads_in_space;
use super::sketching::waits;
use super::theme::{bold, colour, plain};
use super::widgets::{NumberRow, name, note, section, send, unit};
use super::{
    Command, GuidePage, SessionCommand, Switch, ViewChange, ViewState, WindowCommand, fit, focus, guide, path, place,
    set_b,
};
use stillbase_mechanics::machine::MAX_ANGLE;
use stillbase_picture::scene::course::target_handle;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Palette;
use stillbase_planning::pose_space::NoPoseSpace;
use stillbase_session::scenario::{POINT_RANGE, POSE_CONSTANT_RANGE, Value};
use stillbase_session::{Edit, Session};
use stillbase_settings::change::DEFAULT_WORD;
use stillbase_settings::number::{significant, subscript};

/// Default width of the panel: a fraction of the window width, within bounds, points.
const WIDTH_FRACTION: f32 = 0.17;
const MIN_WIDTH_PT: f32 = 262.0;
const MAX_WIDTH_PT: f32 = 320.0;
/// Minimum of the default width in a window that is narrow, points, so that the scene keeps room.
const NARROW_WIDTH_PT: f32 = 252.0;

/// Space for the scroll bar, which grows when the pointer is near, points.
pub(super) const SCROLL_BAR_WIDTH: f32 = 14.0;

/// Whether the window is so narrow that both panels are narrower than usual.
pub(super) fn is_narrow(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() < 1100.0
}

/// Draws this panel; returns the width set by the user, points, if any.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    facts: &ScenarioFacts<'_>,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) -> Option<f32> {
    let p = view_state.palette();
    let frame = Frame::new().inner_margin(Margin { left: 16, right: 2, top: 12, bottom: 8 });
    let least = if is_narrow(ui) { NARROW_WIDTH_PT } else { MIN_WIDTH_PT };
    let usual = (WIDTH_FRACTION * ui.ctx().content_rect().width()).clamp(least, MAX_WIDTH_PT).round();
    let salt = ("side", usual as u32, view_state.arrangement.swapped);
    let panel = if view_state.arrangement.swapped { Panel::right(salt) } else { Panel::left(salt) };
    let panel = panel
        .default_size(view_state.arrangement.now().side.width.unwrap_or(usual))
        .size_range(220.0..=480.0)
        .resizable(true);
    let shown = panel.frame(frame).show(ui, |ui| {
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_width(ui.available_width() - SCROLL_BAR_WIDTH);
            if session.run().unfinished().is_some() {
                waits::panel(ui, "Its pose constant, limits and path stand", &p);
            } else {
                of_machine(ui, session, facts, view_state, &p, commands);
            }
            // The machine of a block, and its base, belong to the assembly.
            if session.scenario().assembly.is_none() {
                plant::show(ui, session, &p, commands);
                base::show(ui, session, view_state, commands);
            }
            control::show(ui, session, &p, commands);
            // While a drawing is unfinished, the balance would be that of the machine before.
            if session.run().unfinished().is_none() {
                balance(ui, session, facts, &p, commands);
            }
            all::show(ui, facts, &p, view_state.open.settings, commands);
            focus::keep_in_view(ui);
        });
    });
    view_state.arrangement.now().side.stored_width(shown.response.rect.width(), usual)
}

/// Draws the settings that only a machine has: of a drawing that is none, they would be those of the machine before.
fn of_machine(
    ui: &mut Ui,
    session: &Session,
    facts: &ScenarioFacts<'_>,
    view_state: &ViewState,
    p: &Palette,
    commands: &mut Vec<Command>,
) {
    place::place_of_thing(ui, Handle::Ring, p, |ui| pose_constant(ui, session, facts, view_state, commands));
    if session.run().pose_space().is_ok() {
        place::place_of_thing(ui, Handle::Target, p, |ui| {
            target(ui, session, p, commands);
            in_space(ui, session, view_state, p, commands);
            hand_over(ui, session, commands);
        });
    }
    if session.scenario().assembly.is_none() {
        place::place_of_thing(ui, Handle::Joint(0), p, |ui| limits(ui, session, p, commands));
        gravity(ui, session, p, commands);
    }
    path::show(ui, session, p, commands);
}

/// Draws a box for each other block of the assembly whose b can change against that of the block that is led.
fn against(ui: &mut Ui, session: &Session, commands: &mut Vec<Command>) {
    let Some(own) = &session.scenario().assembly else { return };
    let bound = own.scenario.follower_of(own.block).map(|(other, _)| other);
    for (i, block) in own.scenario.assembly.blocks().iter().enumerate() {
        let Ok(factor) = own.scenario.factor(own.block, i) else { continue };
        let mut is_bound = bound == Some(i);
        let tip = format!(
            "While b changes by 1 rad, that of {} changes by {factor:.3} rad: their planes are parallel, and the moments \
             cancel. It follows the slider, and a planned change of b.",
            block.name
        );
        if ui.checkbox(&mut is_bound, format!("against {}", block.name)).on_hover_text(tip).changed() {
            commands.push(SessionCommand::Against(is_bound.then_some(i)).into());
        }
    }
}

/// Draws a button for each other block that can pass its payload to the block that is led, or take that of it.
fn hand_over(ui: &mut Ui, session: &Session, commands: &mut Vec<Command>) {
    let Some(shared) = session.run().shared() else { return };
    let assembly = shared.assembly_at(session.frame().step);
    let (own, blocks) = (shared.block().block, assembly.blocks());
    let holds = |i: usize| blocks[i].machine.spec().payload.mass > 0.0;
    for (i, block) in blocks.iter().enumerate() {
        if assembly.parallel([own, i]).is_err() || !(holds(own) || holds(i)) {
            continue;
        }
        let ([from, to], words) = match (holds(own), holds(i)) {
            (true, true) => ([own, i], format!("exchange payloads with {}", block.name)),
            (true, false) => ([own, i], format!("hand payload to {}", block.name)),
            _ => ([i, own], format!("take payload of {}", block.name)),
        };
        let [from, to] = [from, to].map(|i| blocks[i].name.clone());
        let tip = "Where both end effectors meet at equal rates, at the present step. An arm stays balanced only if it \
                   gets as much as it gives.";
        if ui.button(words).on_hover_text(tip).clicked() {
            commands.push(Command::Session(SessionCommand::Edit(Edit::HandOver { from, to })));
            commands.push(SessionCommand::EndGesture.into());
        }
    }
}

fn pose_constant(
    ui: &mut Ui,
    session: &Session,
    facts: &ScenarioFacts<'_>,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let (scenario, p) = (session.scenario(), &view_state.palette());
    ui.label(RichText::new("POSE CONSTANT").font(bold(11.0)).color(colour(p.dim)));
    let map = match session.run().pose_space() {
        Ok(map) => map,
        Err(why) => {
            note(ui, p, &why.to_string());
            if *why == NoPoseSpace::Free {
                note(ui, p, "any path will do: drag A or B and the arm follows, or draw a path (P)");
            } else if session.can_be_dragged() {
                note(ui, p, "drag its end effector: the arm follows at zero angular momentum");
            }
            return;
        }
    };
    if !map.is_reactionless() {
        note(ui, p, "its drives are coupled, so that holding b does not quite keep the moment from the base");
    }
    let period = map.period();
    // b is the same number everywhere, never wrapped; the slider covers the period that contains it.
    let b = session.b_aim();
    let mut shown = b;
    let turns = kept_while_pressed(ui, (b / period).floor() * period);
    let tip = format!(
        "b = Σ λ q, Eq. (13). Changing it turns what can be reached without a reaction; every {period:.3} rad, a whole \
         turn of all drives, it is the same."
    );
    let row = NumberRow {
        label: "b",
        unit: "rad",
        tip: &tip,
        decimals: 3,
        speed: 0.005,
        range: POSE_CONSTANT_RANGE.low()..=POSE_CONSTANT_RANGE.high(),
        slide: turns..=turns + period,
    };
    // The slider stops at the nearest feasible b of the period, so that it does not jump to the other end of its
    // range.
    let allowed = |asked: f64| match set_b(session, view_state, asked) {
        Edit::PoseB { b } if b != asked => {
            session.nearest_feasible_b_within(asked, [turns, turns + period]).unwrap_or(b)
        }
        _ => asked,
    };
    let responses = row.with_stopped_slider(ui, p, &mut shown, allowed);
    let asked = shown;
    let edit = set_b(session, view_state, asked);
    let typed = responses[0].changed() && !responses[0].dragged();
    let stops = matches!(edit, Edit::PoseB { b } if b != asked);
    let feasible = session.run().feasible_b();
    let turns = matches!(edit, Edit::SlideB { .. }).then(|| session.question_of_turns(asked)).flatten();
    if let (true, Some((why, answers))) = (typed, turns) {
        commands.push(WindowCommand::Refuse(why, answers).into());
    } else if typed && stops {
        let band =
            feasible.map_or_else(String::new, |common| common.shifted_near(session.in_this_period(shown)).in_words());
        let who = all_points(session);
        let why = format!("b = {shown:.3} rad does not serve {who}, so nothing has changed: want {band}");
        commands.push(WindowCommand::Refuse(why, session.proposals_for_b(asked)).into());
    } else {
        send(commands, &responses, || edit);
    }
    against(ui, session, commands);
    if session.is_dragged() {
        ui.horizontal(|ui| {
            ui.label(RichText::new("led by hand").font(plain(11.0)).color(colour(p.amber)));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let words = RichText::new("back to the path").font(plain(11.0));
                let tip = "Puts the machine back at the start of its planned path (B)";
                if ui.add(egui::Button::new(words)).on_hover_text(tip).clicked() {
                    commands.push(SessionCommand::BackToPath.into());
                }
            });
        });
    } else {
        let who = all_points(session);
        let text = match session.run().feasible_b() {
            // With two drives, the machine reaches a point only at single values of b.
            Some(common) if !map.reaches_area() => {
                let all: Vec<String> =
                    common.intervals.iter().map(|[low, high]| format!("{:.3}", 0.5 * (low + high))).collect();
                format!("{who}: b {} rad alone", all.join(" or "))
            }
            Some(common) => format!("{who}: {}", common.shifted_near(shown).in_words()),
            None => format!("{who} share no b"),
        };
        note(ui, p, &text);
    }
    if !session.is_dragged() && map.reaches_area() {
        let who = all_points(session);
        let mut turn = view_state.turn_task;
        let words = RichText::new("turn the task too").font(plain(11.0)).color(colour(p.dim));
        let tip = format!("Beyond the b that serve {who}: turn the points with the workspace instead of stopping b");
        if ui.checkbox(&mut turn, words).on_hover_text(tip).changed() {
            commands.push(ViewChange::Switch(Switch::TurnTask, turn).into());
        }
    }
    // Always one line, so that nothing below moves.
    let words = format!("in motion it costs up to {:.2} N m", facts.price);
    let tip = "The moment of D₁ b̈ on a fixed base; one that moves gives way";
    fit::label(ui, &words, plain(11.0), colour(p.dim)).on_hover_text(tip);
    let mut shown = scenario.compare_b.is_some();
    let mut other = scenario.compare_b.unwrap_or(b + 0.5 * period);
    ui.horizontal(|ui| {
        let tick = ui.checkbox(&mut shown, "compare").on_hover_text("A second workspace, as in Fig. 4");
        if tick.changed() {
            commands.push(Command::Session(SessionCommand::Edit(Edit::set(
                "compare_b",
                if shown { Value::from(other) } else { DEFAULT_WORD.into() },
            ))));
            commands.push(SessionCommand::EndGesture.into());
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if shown {
                unit(ui, p, "rad");
                let row = NumberRow::of("compare b", "compare_b").with(3, 0.005);
                let response = row.number(ui, &mut other);
                send(commands, &[response], || Edit::set("compare_b", other));
            }
        });
    });
}

/// Returns the start of the period that the slider covers, which stays while the pointer is pressed: a slider at its end
/// would otherwise run through period after period.
fn kept_while_pressed(ui: &Ui, turns: f64) -> f64 {
    let id = egui::Id::unique("period of b");
    let known = ui.data(|data| data.get_temp::<f64>(id)).filter(|_| ui.input(|i| i.pointer.any_down()));
    let kept = known.unwrap_or(turns);
    ui.data_mut(|data| data.insert_temp(id, kept));
    kept
}

/// Draws the target of the end effector: two numbers to type or drag.
fn target(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    let frame = session.frame();
    // After a drag of the machine, the row shows the requested target, so that a coordinate that is not typed keeps
    // its value.
    let at = if session.is_dragged() { frame.target.at } else { target_handle(frame) };
    let mut place = [at.re, at.im];
    ui.horizontal(|ui| {
        let tip = "Where the end effector is sent; typed or dragged, here or in the scene, the machine follows with b as \
                   it is";
        ui.label("target").on_hover_text(tip);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            unit(ui, p, "m");
            let mut changed = Vec::new();
            for (i, label) in [(1, "target y"), (0, "target x")] {
                let range = POINT_RANGE.low()..=POINT_RANGE.high();
                let row = NumberRow { label, unit: "m", tip, decimals: 3, speed: 0.002, slide: range.clone(), range };
                changed.push(row.number(ui, &mut place[i]));
            }
            let [x, y] = place;
            send(commands, &changed, || Edit::DragTarget { x, y });
        });
    });
}

/// Draws, for a block that another one carries, whether its target is dragged in space, and its place there.
fn in_space(ui: &mut Ui, session: &Session, view_state: &ViewState, p: &Palette, commands: &mut Vec<Command>) {
    if !leads_in_space(session) {
        return;
    }
    let mut is_on = view_state.in_space;
    let tip = "Dragging the target in 3D moves it in the plane of the screen, and the blocks that carry this one go along, \
               each with its b as it is; the sum of the squared rates of all drives is least";
    if ui.checkbox(&mut is_on, "in space, with what carries it").on_hover_text(tip).changed() {
        commands.push(ViewChange::Switch(Switch::InSpace, is_on).into());
    }
    let Some(mut place) = session.tip_on_base().filter(|_| is_on) else { return };
    let tip = "Where the end effector is in axes of the base; typed or dragged, all blocks that carry it move";
    ui.label("end effector from the base: x, y, z").on_hover_text(tip);
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            unit(ui, p, "m");
            let mut changed = Vec::new();
            for (i, label) in [(2, "tip z"), (1, "tip y"), (0, "tip x")] {
                let range = POINT_RANGE.low()..=POINT_RANGE.high();
                let row = NumberRow { label, unit: "m", tip, decimals: 3, speed: 0.002, slide: range.clone(), range };
                changed.push(row.number(ui, &mut place[i]));
            }
            let edit = changed.iter().any(egui::Response::changed).then(|| session.edit_on_base(place)).flatten();
            // Of a place to which no way leads there is no edit, but the gesture ends all the same.
            match edit {
                Some(edit) => send(commands, &changed, || edit),
                None if changed.iter().any(|r| r.drag_stopped() || r.lost_focus()) => {
                    commands.push(SessionCommand::EndGesture.into());
                }
                None => {}
            }
        });
    });
}

/// Returns the points of the task in words.
fn all_points(session: &Session) -> String {
    match session.scenario().task.points().len() {
        1 => "A".into(),
        2 => "A and B".into(),
        n => format!("all {n} points"),
    }
}

fn limits(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    section(ui, p, "Limits and gravity");
    for (i, angle) in session.scenario().machine.angles().iter().enumerate() {
        let mut ends = [*angle.limits.start(), *angle.limits.end()];
        ui.horizontal(|ui| {
            let symbol = format!("a{}", subscript(i + 1));
            let [to, from] = [angle.to, angle.from].map(|k| subscript(k + 1));
            let by = if angle.offset == 0.0 { String::new() } else { format!(" {} rad", signed_by(angle.offset)) };
            ui.label(&symbol).on_hover_text(format!("Relative joint angle: {symbol} = q{to} − q{from}{by}"));
            if !ends.iter().all(|end| end.is_finite()) {
                ui.label(RichText::new("turns freely").color(colour(p.dim)));
                return;
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                unit(ui, p, "rad");
                let mut changed = Vec::new();
                for (end, word) in [(1, "greatest"), (0, "least")] {
                    let range = if end == 1 { ends[0]..=MAX_ANGLE } else { -MAX_ANGLE..=ends[1] };
                    let row = NumberRow {
                        label: &format!("{symbol} {word}"),
                        unit: "rad",
                        tip: "Joint limit; the workspace is what (a₁, a₂) within them reach",
                        decimals: 3,
                        speed: 0.01,
                        slide: range.clone(),
                        range,
                    };
                    changed.push(row.number(ui, &mut ends[end]));
                    if end == 1 {
                        ui.label(RichText::new("…").color(colour(p.dim)));
                    }
                }
                send(commands, &changed, || Edit::at(&["limits", &angle.name], ends.to_vec()));
            });
        });
    }
}

/// Returns a number with its sign as a separate operator, such as `− 0.500`.
fn signed_by(x: f64) -> String {
    format!("{} {:.3}", if x < 0.0 { '−' } else { '+' }, x.abs())
}

fn gravity(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    let gravity = session.scenario().machine.gravity();
    // Subtracted from zero, so that zero gravity reads 0.00 and not −0.00.
    let mut down = 0.0 - gravity.im;
    let tip = "Acceleration of gravity along −y; known to control";
    let row = NumberRow { tip, slide: 0.0..=20.0, ..NumberRow::of("gravity", "gravity").with(2, 0.05) };
    let responses = row.with_slider(ui, p, &mut down);
    send(commands, &responses, || Edit::set("gravity", vec![gravity.re, 0.0 - down]));
}

fn balance(ui: &mut Ui, session: &Session, facts: &ScenarioFacts<'_>, p: &Palette, commands: &mut Vec<Command>) {
    guide::section(ui, p, "Balance", GuidePage::Design, commands);
    let (balance, notation) = (&facts.balance, notation::of(ui.ctx()));
    let rows = [
        (
            notation.name("leftover imbalance", "γ"),
            "kg m",
            balance.force,
            "Force balance, Eq. (7): largest |g_k|; zero means the centre of mass never moves",
        ),
        (
            notation.name("coupling of drives", "C"),
            "kg m²",
            balance.coupling,
            "Invariance, Eq. (8): largest |C_kl|; zero means a constant mass matrix",
        ),
    ];
    for (label, in_unit, (value, good), tip) in rows {
        let tone = if good { p.zero } else { p.reaction };
        fact(ui, p, &label, &significant(value), in_unit, tone, tip);
    }
    for (k, inertia) in balance.inertia.iter().enumerate() {
        let tip = "Coefficient of q̇ in the angular momentum: D in Eq. (11), without what gears only add to H";
        let label = notation.name("effective inertia", &format!("D{}", subscript(k + 1)));
        fact(ui, p, &label, &format!("{inertia:.4}"), "kg m²", p.drive(k), tip);
    }
    fact(
        ui,
        p,
        "mass",
        &format!("{:.2}", session.scenario().machine.mass()),
        "kg",
        p.ink,
        "All links, without the unknown payload",
    );
}

fn fact(
    ui: &mut Ui,
    p: &Palette,
    label: &str,
    value: &str,
    in_unit: &str,
    tone: stillbase_picture::scene::Rgba,
    tip: &str,
) {
    let size = egui::vec2(ui.available_width(), 20.0);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.label(RichText::new(in_unit).font(plain(11.5)).color(colour(p.dim)));
        ui.label(RichText::new(value).color(colour(tone))).on_hover_text(tip);
        // The name gets the space that is left, and is shortened if it is too long.
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            fit::label(ui, label, plain(12.5), colour(p.ink)).on_hover_text(tip);
        });
    });
}
