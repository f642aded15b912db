//! Lines of text on a sheet: what is cut, and where.

use std::f64::consts::PI;

use super::outline::PieceOutline;
use crate::cut::{Cut, SAME_PIN_DISTANCE, bar_extent};
use stillbase_mechanics::machine::{Counterweight, CounterweightShape, Machine, PartSource, Shape};
use stillbase_settings::number::fixed;

/// Estimated width of a letter, as a fraction of its height.
const LETTER_WIDTH: f64 = 0.78;
pub(super) fn mm(metres: f64) -> String {
    fixed(1e3 * metres, 1)
}

/// Formats a length, m, in mm with the minus sign U+2212, which is as wide as a plus.
pub(super) fn signed(metres: f64) -> String {
    mm(metres).replace('-', "\u{2212}")
}

pub(super) fn width_of(text: &str, height: f64) -> f64 {
    text.chars().count() as f64 * LETTER_WIDTH * height
}

pub(super) fn sorted(mut places: Vec<f64>) -> Vec<f64> {
    places.sort_by(f64::total_cmp);
    places.dedup_by(|b, a| *b - *a <= SAME_PIN_DISTANCE);
    places
}

pub(super) fn weights_of(machine: &Machine, j: usize) -> impl Iterator<Item = &Counterweight> {
    let name = &machine.links()[j].name;
    machine.spec().counterweights.iter().filter(move |weight| weight.link == *name)
}

/// Returns the line of text about holes, m from the root.
pub(super) fn hole_line(holes: &[f64]) -> String {
    let places: Vec<String> =
        holes.iter().map(|at| if at.abs() <= SAME_PIN_DISTANCE { "0 (root)".into() } else { signed(*at) }).collect();
    if places.is_empty() { "no holes".into() } else { format!("holes at {} mm", places.join(", ")) }
}

/// Returns the lines of text below a link without parts.
pub(super) fn below(machine: &Machine, cut: &Cut, j: usize) -> Vec<String> {
    let mut lines = vec![hole_line(&machine.pin_places(j))];
    let mut link = below_link(machine, cut, j);
    let discs = link.split_off(link.len() - weights_of(machine, j).count());
    let area = outline_area(machine, cut, j);
    lines.extend(link);
    lines.push(format!("area {} cm²", fixed(1e4 * area, 2)));
    lines.extend(discs);
    lines
}

/// Returns the lines of text about one part of a link.
pub(super) fn below_part(machine: &Machine, outline: &PieceOutline) -> Vec<String> {
    let spec = machine.spec();
    let mass_of = |part: usize| {
        let body = machine.part_bodies().iter().find(|body| body.source == PartSource::Part(part));
        body.map_or(0.0, |body| body.body.mass)
    };
    let mass: f64 = mass_of(outline.part) + outline.arms.iter().map(|arm| mass_of(*arm)).sum::<f64>();
    let part = &spec.parts[outline.part];
    let along: Vec<f64> = outline.holes.iter().map(|([at, _], _)| *at).collect();
    let mut about = format!("{} kg", fixed(mass, 3));
    if matches!(part.shape, Shape::Tube | Shape::Profile)
        && let Some([from, to]) = machine.part_ends(outline.part)
    {
        about.push_str(&format!(", {} mm long", mm(to - from)));
    }
    let arms: Vec<&str> = outline.arms.iter().map(|arm| spec.parts[*arm].name.as_str()).collect();
    if !arms.is_empty() {
        about.push_str(&format!(", with its {}", arms.join(", ")));
    }
    let widths: Vec<f64> = sorted(outline.holes.iter().map(|(_, diameter)| *diameter).collect());
    let across = match widths[..] {
        [] => String::new(),
        [one] => format!(", Ø {}", mm(one)),
        [first, .., last] => format!(", Ø {} to {}", mm(first), mm(last)),
    };
    let ends = match (part.shape, machine.part_ends(outline.part)) {
        (Shape::Flat, Some([from, to])) => format!("from {} to {} mm along the link · ", signed(from), signed(to)),
        _ => String::new(),
    };
    vec![format!("{about} · {ends}{}{across}", hole_line(&sorted(along)))]
}

/// Returns the lines of text about a whole link: end effector, centre of mass, lumps and counterweights; these last.
pub(super) fn below_link(machine: &Machine, cut: &Cut, j: usize) -> Vec<String> {
    let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
    let mut lines = Vec::new();
    if machine.end_link() == j {
        let at = part.sign * (machine.end_effector()[part.drive] - part.root[part.drive]);
        lines.push(format!("end effector at {} mm", signed(at)));
    }
    let off = match link.com_normal {
        0.0 => String::new(),
        y => format!(", {} mm to the left of the axis", signed(y)),
    };
    let with = if weights_of(machine, j).next().is_none() { "" } else { " with its counterweights" };
    lines.push(format!("centre of mass{with} at {} mm{off}", signed(link.com)));
    for body in machine.part_bodies().iter().filter(|body| body.link == j) {
        if let PartSource::Lump(_) = body.source {
            let (name, at) = (body.title(machine.spec()), signed(body.body.at));
            lines.push(format!("carries {name}, {} kg at {at} mm", fixed(body.body.mass, 3)));
        }
    }
    lines.extend(weights_of(machine, j).map(|weight| disc(cut, weight)));
    lines
}

/// Returns the area of a bar without its holes, m².
pub(super) fn outline_area(machine: &Machine, cut: &Cut, j: usize) -> f64 {
    let (holes, [from, to]) = (machine.pin_places(j), bar_extent(machine, j));
    let round = |diameter: f64| 0.25 * PI * diameter * diameter;
    (to - from) * cut.bar_width + round(cut.bar_width) - holes.len() as f64 * round(cut.pin_diameter)
}

/// Returns the line of text about a counterweight.
pub(super) fn disc(cut: &Cut, weight: &Counterweight) -> String {
    let mass = fixed(weight.mass, 3);
    let beside = match weight.across {
        0.0 => String::new(),
        across => format!(", {} mm left of the axis", signed(across)),
    };
    let at = format!("{} mm{beside}", signed(weight.at));
    let Some(thickness) = cut.thickness_of(weight) else {
        return format!("counterweight at {at}: a point of {mass} kg");
    };
    let own = cut.mass_of(weight, thickness);
    let wanted = match (own - weight.mass).abs() <= 5e-4 {
        true => String::new(),
        false => format!(", not {mass} kg"),
    };
    let size = match weight.shape() {
        CounterweightShape::Box { length, width } => format!("box {} × {} mm", mm(length), mm(width)),
        CounterweightShape::Ring { radius, inner_radius } => {
            format!("ring Ø {} mm, bore Ø {} mm", mm(2.0 * radius), mm(2.0 * inner_radius))
        }
        CounterweightShape::HalfRing { radius, inner_radius } => {
            let (away, circle) = (mm(2.0 * radius), signed(weight.circle_at()));
            let bore =
                if inner_radius > 0.0 { format!(", bore Ø {} mm", mm(2.0 * inner_radius)) } else { String::new() };
            format!("{} Ø {away} mm{bore} about {circle} mm", weight.shape().name())
        }
        CounterweightShape::Point | CounterweightShape::Disc { .. } => format!("Ø {} mm", mm(2.0 * weight.radius)),
    };
    format!("counterweight {size} at {at}: {} mm thick {} kg{wanted}", mm(thickness), fixed(own, 3))
}
