//! A setting that is looked up while the machine is designed: its row in the table of links gets the keyboard's focus.

use egui::{Align, Context, Id, Response, Ui};

use stillbase_mechanics::machine::MachineSpec;

/// Whether the table holds the row of a setting, by its path.
pub fn holds(path: &str) -> bool {
    let mut words = path.split('.');
    let (kind, key) = (words.next(), words.next_back());
    match kind {
        Some("link") => matches!(key, Some("mass" | "com" | "com_normal" | "inertia")),
        Some("counterweight") => matches!(key, Some("mass" | "at" | "across")),
        _ => false,
    }
}

/// Key under which egui stores the path of the setting.
fn id() -> Id {
    Id::unique("design setting sought")
}

/// Shows the row of a setting in the next pass: its link in detail, and its number with the keyboard's focus.
pub fn look_up(ctx: &Context, path: &str) {
    ctx.data_mut(|data| data.insert_temp(id(), path.to_owned()));
}

/// Returns the link of the setting that is looked up, counted from 0.
pub(super) fn link(ui: &Ui, spec: &MachineSpec) -> Option<usize> {
    let path = ui.data(|data| data.get_temp::<String>(id()))?;
    let of = path.split('.').nth(1)?;
    let link = match path.starts_with("counterweight.") {
        true => spec.counterweights.get(of.parse::<usize>().ok()?.checked_sub(1)?)?.link.as_str(),
        false => of,
    };
    spec.link_index(link)
}

/// Focuses a number if it is that of the setting that is looked up.
pub(super) fn found(ui: &Ui, response: &Response, path: &str) {
    if ui.data(|data| data.get_temp::<String>(id())).as_deref() == Some(path) {
        give_up(ui);
        response.request_focus();
        response.scroll_to_me(Some(Align::Center));
    }
}

/// Looks for nothing any more.
pub(super) fn give_up(ui: &Ui) {
    ui.data_mut(|data| data.remove_temp::<String>(id()));
}
