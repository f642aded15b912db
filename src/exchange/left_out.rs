//! What a model for another program leaves out of a machine, in sentences.

use super::cut::unweighed_tail;
use super::mjcf::{MIN_MASS_OR_INERTIA, parallel};
use super::placed::lighter;
use stillbase_mechanics::assembly::{Assembly, SpatialBase};
use stillbase_mechanics::machine::{Counterweight, CounterweightShape, Length, Link, LinkNumber, Machine, MachineSpec};
use stillbase_mechanics::planar::Vector;
use stillbase_settings::number::{counted, fixed};

/// Returns what both formats leave out.
fn of_both(machine: &Machine) -> Vec<String> {
    let spec = machine.spec();
    let mut list = Vec::new();
    if !spec.summary.is_empty() {
        list.push("summary: a model has none".to_owned());
    }
    if spec.links.iter().any(|link| matches!(link.length, Length::Named(_))) {
        list.push(format!(
            "named lengths: {}; each link has its own length there",
            spec.lengths.keys().cloned().collect::<Vec<_>>().join(", ")
        ));
    }
    if !spec.parts.is_empty() || !spec.lumps.is_empty() {
        let (parts, lumps) = (counted(spec.parts.len(), "part"), counted(spec.lumps.len(), "lump"));
        list.push(format!("{parts} and {lumps}: their mass and inertia became those of their links"));
    }
    if !spec.counterweights.is_empty() {
        let count = counted(spec.counterweights.len(), "counterweight");
        list.push(format!(
            "{count}: mass and inertia became those of the links that carry them; shapes are drawn only"
        ));
        if spec.counterweights.iter().any(|weight| weight.inner_radius > 0.0 || weight.half) {
            list.push("rings and half rings: drawn as discs, and as the boxes around them".to_owned());
        }
    }
    if spec.payload.mass > 0.0 || spec.payload.inertia > 0.0 {
        let link = &spec.links[machine.end_link()].name;
        list.push(format!("payload as such: read again, it is part of link {link}"));
    }
    let bare: Vec<&str> =
        (0..spec.links.len()).filter(|j| is_unbounded(machine, *j)).map(|j| spec.links[j].name.as_str()).collect();
    if !bare.is_empty() {
        list.push(format!("length of link {}: a model has lengths only where pins are", bare.join(", ")));
    }
    list
}

/// Returns whether no pin or end effector sits at the tip of a link, so that its length is only drawn.
fn is_unbounded(machine: &Machine, j: usize) -> bool {
    let part = &machine.resolved_links()[j];
    let end = machine.end_effector()[part.drive] - part.root[part.drive];
    let reach = part.pins.iter().copied().chain((machine.end_link() == j).then_some(part.sign * end));
    (reach.fold(0.0, f64::max) - part.length).abs() > 1e-9 * part.length
}

/// Returns the names of drives of which something holds.
fn drives(spec: &MachineSpec, of: impl Fn(usize) -> bool) -> Option<String> {
    let names: Vec<&str> = (0..spec.drives.len()).filter(|k| of(*k)).map(|k| spec.drives[k].name.as_str()).collect();
    (!names.is_empty()).then(|| format!("drive {}", names.join(", ")))
}

/// Returns what URDF leaves out.
pub fn of_urdf(machine: &Machine) -> Vec<String> {
    let spec = machine.spec();
    let mut list = of_both(machine);
    let parts = machine.resolved_links();
    let fixed = |j: &usize| parts[*j].parent.is_some_and(|parent| parts[parent].drive == parts[*j].drive);
    let merged: Vec<&str> = (0..parts.len()).filter(fixed).map(|j| spec.links[j].name.as_str()).collect();
    if !merged.is_empty() {
        list.push(format!(
            "pin of link {}: read again, such a link is one with the link that carries it",
            merged.join(", ")
        ));
    }
    let mut own = Vec::new();
    let limited = |k: usize| spec.drives[k].acceleration_limit.is_some() || spec.drives[k].jerk_limit.is_some();
    own.extend((spec.gravity != [0.0; 2]).then_some("gravity"));
    own.extend((!spec.closures.is_empty()).then_some("pins that close loops"));
    own.extend((!spec.angles.is_empty()).then_some("names and offsets of angles"));
    own.extend((0..spec.drives.len()).any(limited).then_some("limits of acceleration and jerk"));
    if !own.is_empty() {
        list.push(format!("for other programs {}: only the element <stillbase> has them", own.join(", ")));
    }
    list
}

/// Returns what MJCF leaves out.
pub fn of_mjcf(machine: &Machine) -> Vec<String> {
    let spec = machine.spec();
    let mut list = of_both(machine);
    let moves = |k: usize| {
        let drive = &spec.drives[k];
        drive.speed_limit.is_some() || drive.acceleration_limit.is_some() || drive.jerk_limit.is_some()
    };
    if let Some(drives) = drives(spec, moves) {
        list.push(format!("limits of rate, acceleration and jerk of {drives}: MJCF has none"));
    }
    let is_light = |k: usize| spec.drives[k].rotor.is_some_and(|rotor| rotor.inertia < MIN_MASS_OR_INERTIA);
    if let Some(drives) = drives(spec, is_light) {
        list.push(format!("rotor and gear of {drives}: MuJoCo moves only what has inertia"));
    }
    if !spec.closures.is_empty() && !parallel(machine).is_empty() {
        list.push(
            "pins that close loops, and lengths up to them: equalities keep the links parallel instead".to_owned(),
        );
    }
    if !spec.angles.is_empty() {
        list.push("names and offsets of angles: MJCF limits the angles of pins and sums of them".to_owned());
    }
    list
}

/// Returns what a model leaves out of an assembly as a whole.
pub fn of_assembly(assembly: &Assembly, base: Option<&SpatialBase>) -> Vec<String> {
    let mut list = Vec::new();
    if !assembly.summary.is_empty() {
        list.push("summary: a model has none".to_owned());
    }
    list.push("what makes it an assembly again: import-model reads models of one machine".to_owned());
    if base.is_some_and(|base| lighter(assembly, base).is_none()) {
        list.push(
            "rotors that spin about one axis only: theirs have half their inertia about the others too, and the base is \
             too slender to have it taken off"
                .to_owned(),
        );
    }
    list
}

/// Returns what solids show otherwise than it is weighed.
pub fn of_solids(machine: &Machine) -> Vec<String> {
    let (spec, mut list) = (machine.spec(), of_drawing(machine));
    let covers_pin = |weight: &&Counterweight| {
        let link = spec.link_index(&weight.link);
        let pins = link.map_or_else(Vec::new, |link| machine.pin_places(link));
        pins.iter().any(|pin| weight.covers(Vector::new(*pin, 0.0)))
    };
    if spec.counterweights.iter().any(|weight| covers_pin(&weight)) {
        list.push("the mass of holes in counterweights: those over a pin are drilled, but weighed whole".to_owned());
    }
    if spec.counterweights.iter().any(|weight| weight.shape() != CounterweightShape::Point) {
        list.push(
            "slots: a counterweight is one solid centred on its bar, which runs through it; build it as two halves, one \
             on each side of the bar"
                .to_owned(),
        );
    }
    if spec.lumps.iter().any(|lump| lump.inertia == 0.0) {
        list.push("points: a lump without inertia is shown as a cylinder of its mass, as high as wide".to_owned());
    }
    list
}

/// Returns what a drawing shows otherwise than it is weighed: bars of links whose numbers are typed, and tails that only
/// the drawing adds.
pub fn of_drawing(machine: &Machine) -> Vec<String> {
    let is_typed = |link: &&Link| LinkNumber::ALL.iter().any(|number| !link.follows(*number));
    let typed: Vec<&str> = machine.spec().links.iter().filter(is_typed).map(|link| link.name.as_str()).collect();
    let mut list = Vec::new();
    if !typed.is_empty() {
        list.push(format!(
            "what drawn bars weigh: mass, centre of mass or inertia of link {} is typed; design --counterweights --bars \
             weighs what is cut",
            typed.join(", ")
        ));
    }
    let floats = |weight: &Counterweight| {
        let link = machine.spec().links.iter().position(|link| link.name == weight.link);
        link.is_some_and(|link| machine.parts_of_link(link).is_some() && !machine.is_carried(link, weight))
    };
    let weights = machine.spec().counterweights.iter().enumerate();
    let floating: Vec<String> =
        weights.filter(|(_, weight)| floats(weight)).map(|(i, _)| (i + 1).to_string()).collect();
    if !floating.is_empty() {
        list.push(format!(
            "what carries counterweight {}: no part of the link lies under its centre; design --counterweights --bars \
             extends bars to it",
            floating.join(", ")
        ));
    }
    let tail = unweighed_tail(machine);
    if tail <= 0.0 {
        return list;
    }
    list.push(format!(
        "the mass of tails: bars are drawn up to {} mm beyond their pins, to carry counterweights, and no link counts \
         that; design --counterweights --bars weighs what is cut",
        fixed(1e3 * tail, 1)
    ));
    list
}
