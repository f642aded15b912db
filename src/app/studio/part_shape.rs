//! The name of a part, the ends of a flat bar, holes, and the corners of a plate.

use egui::{Align, Button, ComboBox, RichText, Ui};

use super::table::{NUMBER_WIDTH_PT, cell, head};
use crate::Command;
use crate::sketching::{NumberField, renamed};
use crate::theme::{colour, plain};
use crate::widgets::{name, undoable_edit};
use stillbase_mechanics::machine::{Ends, Machine, Part, PartSource, PlaceOnLink, Shape};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Edit;
use stillbase_session::parts::{change_part, hole_of, name_lump};

/// Greatest distance from the root, and least diameter of a hole, m.
const FARTHEST_M: f64 = 100.0;
const THINNEST_M: f64 = 1e-4;
/// Width of the title of a hole or a corner, points.
const TITLE_WIDTH_PT: f32 = 62.0;

/// Draws what a part has beside the numbers with keys.
pub fn show(ui: &mut Ui, machine: &Machine, source: PartSource, p: &Palette, commands: &mut Vec<Command>) {
    let (i, kind) = match source {
        PartSource::Part(i) => (i, "part"),
        PartSource::Lump(i) => (i, "lump"),
    };
    let label = format!("name of {kind} {}", i + 1);
    let spec = machine.spec();
    let PartSource::Part(i) = source else {
        let rename = |name: String| undoable_edit(commands, name_lump(machine, i, name));
        return renamed(ui, &label, &spec.lumps[i].name, p, rename);
    };
    let part = &spec.parts[i];
    renamed(ui, &label, &part.name, p, |name| {
        undoable_edit(commands, change_part(machine, i, |part| part.name = name));
    });
    let shown = Shown { machine, i, part, p };
    if part.shape == Shape::Flat {
        shown.ends(ui, commands);
    }
    if part.shape == Shape::Plate {
        shown.corners(ui, commands);
    }
    if matches!(part.shape, Shape::Flat | Shape::Plate) {
        shown.holes(ui, commands);
    }
}

/// What is done to a hole or a corner.
enum Change {
    /// It is removed.
    Gone,
    /// A number of it, by its word, becomes another, m.
    To(&'static str, f64),
}

/// A part with its number, from 0.
#[derive(Clone, Copy)]
struct Shown<'a> {
    machine: &'a Machine,
    i: usize,
    part: &'a Part,
    p: &'a Palette,
}

impl Shown<'_> {
    fn edit(&self, change: impl FnOnce(&mut Part)) -> Edit {
        change_part(self.machine, self.i, change)
    }

    fn ends(&self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let now = self.part.ends.unwrap_or_default();
        let word = |ends: Ends| if ends == Ends::Round { "round ends" } else { "square ends" };
        let list = ComboBox::from_id_salt(("ends", self.i)).selected_text(word(now)).width(96.0);
        let list = list.show_ui(ui, |ui| {
            for ends in [Ends::Round, Ends::Square] {
                if ui.selectable_label(ends == now, word(ends)).clicked() && ends != now {
                    let stated = Some(ends).filter(|ends| *ends != Ends::Round);
                    undoable_edit(commands, self.edit(|part| part.ends = stated));
                }
            }
        });
        name(&list.response, &format!("ends of part {}", self.i + 1));
    }

    fn holes(&self, ui: &mut Ui, commands: &mut Vec<Command>) {
        if !self.part.holes.is_empty() {
            self.heads(ui, ["at m", "across m", "Ø m"]);
        }
        for (k, hole) in self.part.holes.iter().enumerate() {
            let at = self.machine.place_on(&self.part.link, &hole.at).unwrap_or_default();
            let numbers = [("at", at), ("across", hole.across), ("diameter", hole.diameter)];
            match self.row(ui, ("hole", k), &numbers) {
                Some(Change::Gone) => undoable_edit(commands, self.edit(|part| _ = part.holes.remove(k))),
                Some(Change::To("at", new)) => {
                    undoable_edit(commands, self.edit(|part| part.holes[k].at = PlaceOnLink::Metres(new)));
                }
                Some(Change::To("across", new)) => {
                    undoable_edit(commands, self.edit(|part| part.holes[k].across = new));
                }
                Some(Change::To(_, new)) => {
                    undoable_edit(commands, self.edit(|part| part.holes[k].diameter = new));
                }
                None => {}
            }
        }
        if self.add(ui, "+ hole", &format!("add a hole to part {}", self.i + 1)) {
            let hole = hole_of(self.machine, self.i);
            undoable_edit(commands, self.edit(|part| part.holes.extend(hole)));
        }
    }

    fn corners(&self, ui: &mut Ui, commands: &mut Vec<Command>) {
        self.heads(ui, ["along m", "across m", ""]);
        for (k, [along, across]) in self.part.polygon.iter().enumerate() {
            match self.row(ui, ("corner", k), &[("along", *along), ("across", *across)]) {
                Some(Change::Gone) => undoable_edit(commands, self.edit(|part| _ = part.polygon.remove(k))),
                Some(Change::To(word, new)) => {
                    let axis = usize::from(word == "across");
                    undoable_edit(commands, self.edit(|part| part.polygon[k][axis] = new));
                }
                None => {}
            }
        }
        if self.add(ui, "+ corner", &format!("add a corner to part {}", self.i + 1)) {
            undoable_edit(commands, self.edit(add_corner));
        }
    }

    fn heads(&self, ui: &mut Ui, words: [&str; 3]) {
        ui.horizontal(|ui| {
            cell(ui, TITLE_WIDTH_PT, Align::Min, |_| ());
            for words in words {
                cell(ui, NUMBER_WIDTH_PT, Align::Max, |ui| head(ui, self.p, words));
            }
        });
    }

    /// Draws a hole or a corner in a line; returns its change.
    fn row(&self, ui: &mut Ui, (kind, k): (&str, usize), numbers: &[(&'static str, f64)]) -> Option<Change> {
        let title = format!("{kind} {} of part {}", k + 1, self.i + 1);
        let mut change = None;
        ui.horizontal(|ui| {
            cell(ui, TITLE_WIDTH_PT, Align::Min, |ui| head(ui, self.p, &format!("{kind} {}", k + 1)));
            for &(word, value) in numbers {
                let label = format!("{word} of {title}");
                let field = NumberField { label: &label, words: word, unit: "m", decimals: 4, speed: 5e-4 };
                let id = ui.scope_id().with(&label);
                let least = if word == "diameter" { THINNEST_M } else { -FARTHEST_M };
                let range = least..=FARTHEST_M;
                let new = cell(ui, NUMBER_WIDTH_PT, Align::Max, |ui| field.number(ui, id, value, range));
                change = new.map(|new| Change::To(word, new)).or(change.take());
            }
            if self.add(ui, "×", &format!("remove {title}")) {
                change = Some(Change::Gone);
            }
        });
        change
    }

    fn add(&self, ui: &mut Ui, words: &str, label: &str) -> bool {
        let button = ui.add(Button::new(RichText::new(words).font(plain(12.0)).color(colour(self.p.amber))).small());
        name(&button, label);
        button.clicked()
    }
}

/// Adds a corner to a plate: in the middle of its last side, a little outside.
fn add_corner(part: &mut Part) {
    let (Some(last), Some(first)) = (part.polygon.last().copied(), part.polygon.first().copied()) else { return };
    let way = [first[0] - last[0], first[1] - last[1]];
    let middle = [0, 1].map(|i| last[i] + 0.5 * way[i]);
    let centre = [0, 1].map(|i| part.polygon.iter().map(|corner| corner[i]).sum::<f64>() / part.polygon.len() as f64);
    part.polygon.push([0, 1].map(|i| middle[i] + 0.2 * (middle[i] - centre[i])));
}
