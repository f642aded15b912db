//! Totals of the machine: mass, λ, workspace, and cost of its task.

use egui::{Align, Layout, RichText, Ui};

use super::facts::DesignFacts;
use crate::notation;
use crate::theme::{colour, plain};
use crate::widgets::{heading, reason};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Session;

const BETA: &str = "Ratio of root mean squares to those of the machine without counterweights, in the same motion of \
                    its drives: 0 is no reaction, 1 the same";

/// Draws the totals.
pub fn show(ui: &mut Ui, session: &Session, facts: &DesignFacts, p: &Palette) {
    ui.add_space(8.0);
    heading(ui, p, "What it comes to", "");
    let (machine, run) = (&facts.machine, session.run());
    let lambda: Vec<String> = facts.lambda().iter().map(|lambda| signed(*lambda, 3)).collect();
    let is_balanced = facts.terms.iter().all(|term| term.is_balanced);
    let notation = notation::of(ui.ctx());
    let ratios = if is_balanced { "inertia ratios" } else { "inertia ratios less coupling" };
    let mut rows = vec![
        ("mass of all".into(), format!("{} kg", signed(machine.mass(), 2))),
        (notation.name("effective inertia of all drives", "Σ D"), format!("{} kg m²", signed(facts.now()[1], 3))),
        (notation.name(ratios, "λ"), lambda.join("  ")),
    ];
    if let Some(workspace) = facts.workspace {
        let noun = if workspace.is_reactionless { "reactionless workspace" } else { "nearly reactionless workspace" };
        rows.push((noun.into(), notation.write(workspace.area, 3, "m²")));
    }
    if let Some(measures) = &facts.measures
        && measures.added_mass > 1e-9
    {
        let of = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), |x| signed(x, 3));
        rows.push(("mass–inertia factor, 2 without counterweights".into(), of(measures.mass_inertia_factor)));
        if let Some(beta) = &measures.beta {
            rows.push((
                "β of force · moment · torque".into(),
                [beta.force, beta.moment, beta.torque].map(of).join(" · "),
            ));
        }
    }
    let forecast = &run.plan().forecast;
    if run.waiting().is_none() && !facts.is_preview {
        rows.extend([
            (
                notation.name("the plan: greatest torque foreseen", "τ"),
                format!("{} N m", signed(forecast.torque.max_abs(), 3)),
            ),
            (notation.name("turning moment on the base", "n_B"), format!("{} N m", signed(forecast.moment, 3))),
            (notation.name("force on the base", "f_B"), format!("{} N", signed(forecast.force, 3))),
        ]);
    }
    for (words, value) in rows {
        ui.horizontal(|ui| {
            let label = ui.label(RichText::new(&words).font(plain(12.0)).color(colour(p.dim)));
            if words.starts_with('β') {
                label.on_hover_text(BETA);
            }
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(RichText::new(value).font(plain(12.5)).color(colour(p.ink)));
            });
        });
    }
    if let Some(waiting) = run.waiting() {
        reason(ui, p, &waiting.why.to_string());
    }
}
