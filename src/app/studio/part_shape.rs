//! The name of a part, the ends of a flat bar, holes, and the corners of a plate.

use egui::{Button, ComboBox, RichText, Ui};

use crate::Command;
use crate::sketching::{NumberField, renamed};
use crate::theme::{colour, plain};
use crate::widgets::{name, undoable_edit};
use stillbase_mechanics::machine::{Ends, Hole, Machine, Part, PartSource, PlaceOnLink, Shape};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Edit;
use stillbase_session::parts::{change_part, hole_of, name_lump};

/// Greatest distance from the root, and greatest diameter, m.
const FARTHEST_M: f64 = 100.0;

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
        for (k, hole) in self.part.holes.iter().enumerate() {
            let at = self.machine.place_on(&self.part.link, &hole.at).unwrap_or_default();
            let numbers = [("at", at), ("across", hole.across), ("diameter", hole.diameter)];
            let title = format!("hole {} of part {}", k + 1, self.i + 1);
            if self.title(ui, &title) {
                undoable_edit(commands, self.edit(|part| _ = part.holes.remove(k)));
            }
            for (word, value) in numbers {
                let range = if word == "diameter" { 1e-4..=FARTHEST_M } else { -FARTHEST_M..=FARTHEST_M };
                let label = format!("{word} of {title}");
                let field = NumberField { label: &label, words: word, unit: "m", decimals: 4, speed: 5e-4 };
                let Some(new) = field.show(ui, self.p, value, range) else { continue };
                let edit = self.edit(|part| {
                    let Hole { at, across, diameter } = &mut part.holes[k];
                    match word {
                        "at" => *at = PlaceOnLink::Metres(new),
                        "across" => *across = new,
                        _ => *diameter = new,
                    }
                });
                undoable_edit(commands, edit);
            }
        }
        if self.add(ui, "+ hole", &format!("add a hole to part {}", self.i + 1)) {
            let hole = hole_of(self.machine, self.i);
            undoable_edit(commands, self.edit(|part| part.holes.extend(hole)));
        }
    }

    fn corners(&self, ui: &mut Ui, commands: &mut Vec<Command>) {
        for (k, corner) in self.part.polygon.iter().enumerate() {
            let title = format!("corner {} of part {}", k + 1, self.i + 1);
            if self.title(ui, &title) {
                undoable_edit(commands, self.edit(|part| _ = part.polygon.remove(k)));
            }
            for (axis, word) in ["along", "across"].into_iter().enumerate() {
                let label = format!("{word} of {title}");
                let field = NumberField { label: &label, words: word, unit: "m", decimals: 4, speed: 5e-4 };
                if let Some(new) = field.show(ui, self.p, corner[axis], -FARTHEST_M..=FARTHEST_M) {
                    undoable_edit(commands, self.edit(|part| part.polygon[k][axis] = new));
                }
            }
        }
        if self.add(ui, "+ corner", &format!("add a corner to part {}", self.i + 1)) {
            undoable_edit(commands, self.edit(add_corner));
        }
    }

    /// Draws a title with a button behind it; returns whether the button is pressed.
    fn title(&self, ui: &mut Ui, title: &str) -> bool {
        ui.horizontal(|ui| {
            ui.label(RichText::new(title).font(plain(11.5)).color(colour(self.p.dim)));
            self.add(ui, "×", &format!("remove {title}"))
        })
        .inner
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
