//! Texts about a state of a design, as Markdown.

use super::state::DesignState;
use crate::markdown::{cell, table};
use stillbase_mechanics::balance::{BalanceTerm, Breakdown};
use stillbase_mechanics::machine::{Counterweight, Inertia, LinkNumber, Machine, PartBody, PartSource};
use stillbase_mechanics::planar::Vector;
use stillbase_picture::numbers::signed;
use stillbase_settings::number::counted;
use stillbase_study::comparison::{DESIGN_COLUMNS, DesignMeasures};

/// Maximum number of conditions as columns of a table; with more conditions, the table is transposed.
const MAX_COLUMNS: usize = 10;

/// Maximum number of characters of a name.
const MAX_NAME_CHARS: usize = 24;
/// Maximum number of characters of the description of an edit.
const MAX_TEXT_CHARS: usize = 300;

/// Returns the table of the measures of a machine; `count` is the total number of changes.
pub(super) fn state(state: &DesignState, count: usize) -> String {
    let machine = &state.of.machine;
    let inertia = Inertia::of(machine);
    let mut text = String::new();
    match state.of.changes {
        0 if count == 0 => {}
        0 => {
            text += &format!("Before {}, to be stepped through on the time line *edit*.\n\n", counted(count, "change"))
        }
        changes => text += &format!("Change {changes} of {count}: {}\n\n", cell(&state.of.words, MAX_TEXT_CHARS)),
    }
    let all = |values: &mut dyn Iterator<Item = f64>| values.map(|x| signed(x, 3)).collect::<Vec<_>>().join(" · ");
    let [force, coupling] = [inertia.force_residual(), inertia.invariance_residual()];
    let mut rows = vec![
        ["mass of all, kg".to_owned(), signed(machine.mass(), 3)],
        ["Dₖ, kg m²".into(), all(&mut inertia.momenta().iter().copied())],
        ["Σ D, kg m²".into(), signed(inertia.total_momentum(), 4)],
        ["λₖ = Dₖ / D₁".into(), all(&mut inertia.lambda().iter().copied())],
        ["worst of (7), kg m".into(), residual(force, inertia.is_force_balanced())],
        ["worst of (8), kg m²".into(), residual(coupling, inertia.is_invariant())],
    ];
    if let Some((beside, measures)) = &state.measures {
        let ratio = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), |x| signed(x, 3));
        rows.extend([
            [format!("**{beside}**"), String::new()],
            ["added mass, kg".into(), signed(measures.added_mass, 3)],
            ["added Σ D, kg m²".into(), signed(measures.added_inertia, 4)],
            ["mass–inertia factor".into(), ratio(measures.mass_inertia_factor)],
        ]);
        if let Some(beta) = &measures.beta {
            let beta = [beta.force, beta.moment, beta.torque].map(ratio).join(" · ");
            rows.push(["β: force · moment · torque".into(), beta]);
        }
    }
    text + &table(
        &[format!("machine {}", cell(machine.name(), MAX_NAME_CHARS)), String::new()],
        &rows.into_iter().map(Vec::from).collect::<Vec<_>>(),
    )
}

/// Returns the text of the largest residual of one kind of conditions.
fn residual(largest: f64, is_zero: bool) -> String {
    if is_zero { "0".into() } else { signed(largest, 4) }
}

/// Returns the table of the links, their masses and their counterweights.
pub(super) fn links(machine: &Machine) -> String {
    let spec = machine.spec();
    let has_weights = !spec.counterweights.is_empty();
    let off_axis = spec.counterweights.iter().any(|weight| weight.across != 0.0);
    let size_names = Counterweight::sizes_of(&spec.counterweights);
    let sizes: Vec<String> = size_names.iter().map(|name| format!("{name} m")).collect();
    let mut heads = vec!["link", "drive", "mass kg", "CM m"];
    if spec.links.iter().any(|link| link.com_normal != 0.0) {
        heads.push("across m");
    }
    if has_weights {
        heads.extend(["weight kg", "at m"]);
        if off_axis {
            heads.push("left of axis m");
        }
        heads.extend(sizes.iter().map(String::as_str));
    }
    let mut rows = Vec::new();
    for link in &spec.links {
        let mut own = vec![
            cell(&link.name, MAX_NAME_CHARS),
            cell(&link.drive, MAX_NAME_CHARS),
            signed(link.mass, 3),
            signed(link.com, 4),
        ];
        if heads.contains(&"across m") {
            own.push(signed(link.com_normal, 4));
        }
        let mut weights = spec.counterweights.iter().filter(|weight| weight.link == link.name).peekable();
        if weights.peek().is_none() {
            own.resize(heads.len(), "–".into());
            rows.push(own);
            continue;
        }
        for (i, weight) in weights.enumerate() {
            // The row of a second counterweight on the same link has empty cells for the link.
            let mut row = if i == 0 { own.clone() } else { vec![String::new(); own.len()] };
            row.extend([signed(weight.mass, 3), signed(weight.at, 4)]);
            if off_axis {
                row.push(signed(weight.across, 4));
            }
            let size = |name: &&str| weight.sizes().find(|(own, _)| own == name).map(|(_, size)| signed(size, 4));
            row.extend(size_names.iter().map(|name| size(name).unwrap_or_else(|| "–".into())));
            rows.push(row);
        }
    }
    let heads: Vec<String> = heads.into_iter().map(String::from).collect();
    let added: f64 = spec.counterweights.iter().map(|weight| weight.mass).sum();
    let sum = match has_weights {
        true => format!("\n{} of {} kg in all", counted(spec.counterweights.len(), "counterweight"), signed(added, 3)),
        false => "\nNo counterweights.".into(),
    };
    table(&heads, &rows) + &sum
}

/// Returns the table of the conditions (7) and (8): contribution of each link with its discs and payload, what of it is
/// that of a lump, and the residual.
pub(super) fn balance(machine: &Machine, breakdown: &Breakdown) -> String {
    let terms = &breakdown.terms;
    let heads =
        terms.iter().map(|term| format!("{} {}", term.condition.symbol(machine.drives()), term.condition.unit()));
    let heads: Vec<String> = ["link".to_owned()].into_iter().chain(heads).collect();
    let line = |name: String, of: &dyn Fn(&BalanceTerm) -> Vector| {
        let parts = terms.iter().map(|term| match complex(of(term)) {
            none if none == "0.0000" => "·".to_owned(),
            part => part,
        });
        [name].into_iter().chain(parts).collect::<Vec<_>>()
    };
    let row = |(link, own): (usize, &stillbase_mechanics::machine::Link)| {
        let whole = line(cell(&own.name, MAX_NAME_CHARS), &|term| breakdown.of_link(term, link));
        // Typed numbers of the link overrule its lumps.
        let counts = own.follows(LinkNumber::Mass) && own.follows(LinkNumber::Along);
        let is_lump = |part: &&PartBody| counts && part.link == link && matches!(part.source, PartSource::Lump(_));
        let lumps = machine.part_bodies().iter().filter(is_lump).map(|part| {
            let name = format!("of it {}", part.title(machine.spec()));
            line(cell(&name, MAX_NAME_CHARS), &|term| term.of_part(machine, part))
        });
        std::iter::once(whole).chain(lumps).collect::<Vec<_>>()
    };
    let of_term = terms.iter().map(|term| match term.balanced {
        true => "**0**".to_owned(),
        false => format!("**{}**", complex(term.residual)),
    });
    let residuals = ["**residual**".to_owned()].into_iter().chain(of_term).collect::<Vec<_>>();
    let rows = [residuals].into_iter().chain(machine.links().iter().enumerate().flat_map(row)).collect::<Vec<_>>();
    if terms.len() <= MAX_COLUMNS {
        return table(&heads, &rows);
    }
    let across: Vec<Vec<String>> = [heads].into_iter().chain(rows).collect();
    let turned = (0..across[0].len()).map(|i| across.iter().map(|row| row[i].clone()).collect::<Vec<_>>());
    let turned: Vec<Vec<String>> = turned.collect();
    table(&turned[0], &turned[1..])
}

/// Returns the table that compares the machines of several cases, by name, with the first.
pub fn comparison_table(cases: &[(&str, DesignMeasures)]) -> String {
    let heads = cases.iter().map(|(name, _)| cell(name, MAX_NAME_CHARS));
    let heads: Vec<String> = [String::new()].into_iter().chain(heads).collect();
    let rows = DESIGN_COLUMNS.iter().map(|column| {
        let cells = cases.iter().map(|(_, design)| match (column.value)(design) {
            Some(x) => signed(x, column.decimals),
            None => "–".into(),
        });
        let head =
            if column.unit == "1" { column.head.to_owned() } else { format!("{}, {}", column.head, column.unit) };
        [head].into_iter().chain(cells).collect::<Vec<_>>()
    });
    let apart = cases.iter().filter_map(|(name, design)| Some((name, design.why_not.as_ref()?)));
    let apart = apart.map(|(name, why)| format!("\n{}: {}\n", cell(name, MAX_NAME_CHARS), cell(why, MAX_TEXT_CHARS)));
    table(&heads, &rows.collect::<Vec<_>>()) + &apart.collect::<String>()
}

/// Formats a complex number: real part along the axes of links, imaginary part across them unless zero.
fn complex(x: Vector) -> String {
    match signed(x.im, 4) {
        none if none == "0.0000" => signed(x.re, 4),
        across if x.im > 0.0 => format!("{} + {across} i", signed(x.re, 4)),
        _ => format!("{} − {} i", signed(x.re, 4), signed(-x.im, 4)),
    }
}
