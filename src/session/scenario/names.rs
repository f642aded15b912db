//! Plain names of settings.

use super::keys::key_of;
use stillbase_mechanics::machine::pattern_of;
use stillbase_settings::key::names;
use stillbase_settings::mending::with_key;

/// Keys with their names, in which `*` stands for the name of a link, a drive or a length. Those of the machine are named
/// with it; all other keys are called as the last word of their path.
const NAMES: &[(&str, &str)] = &[
    ("compare_b", "pose constant to compare with"),
    ("pose_acceleration", "greatest acceleration of b"),
    ("task.kind", "kind of motion"),
    ("task.shape", "shape of the path"),
    ("task.turn", "turn of the samples"),
    ("task.from", "point A"),
    ("task.via", "points between"),
    ("task.to", "point B"),
    ("task.closed", "back to A"),
    ("task.blend", "distance of blends"),
    ("task.b", "pose constant at A"),
    ("task.b_to", "pose constant at B"),
    ("task.moment_limit", "limit of the moment on the base"),
    ("task.least", "what is least"),
    ("task.first_drive_to", "final angle of drive 1"),
    ("task.orientation", "angle of the last link"),
    ("task.time", "duration from A to B"),
    ("task.law", "time law"),
    ("control.law", "control law"),
    ("control.kp", "position gain"),
    ("control.kd", "velocity gain"),
    ("control.knows_base", "knows that the base moves"),
    ("control.rate", "rate of control"),
    ("control.encoder", "encoder counts"),
    ("plant.torque_limits", "motors keep their limits"),
    ("plant.force", "force at the end effector"),
    ("plant.payload.from", "payload is picked up at"),
    ("plant.payload.until", "payload is released at"),
    ("plant.friction.viscous", "viscous friction of drives"),
    ("plant.friction.coulomb", "Coulomb friction of drives"),
    ("plant.friction.pin_viscous", "viscous friction of pins"),
    ("plant.friction.pin_coulomb", "Coulomb friction of pins"),
    ("base.kind", "how the base is held"),
    ("base.mass", "mass of the base"),
    ("base.inertia", "inertia of the base"),
    ("base.com", "centre of mass of the base"),
    ("base.wheel.inertia", "inertia of the wheel"),
    ("base.wheel.torque_limit", "torque limit of the wheel"),
    ("base.wheel.speed_limit", "rate limit of the wheel"),
    ("base.wheel.kp", "attitude gain of the wheel"),
    ("base.wheel.kd", "rate gain of the wheel"),
    ("base.wheel.dead_band", "dead band of the attitude"),
    ("base.wheel.rate", "sampling rate of the wheel"),
    ("tolerance.seed", "which random machines"),
    ("tolerance.samples", "how many machines"),
    ("tolerance.moment_limit", "moment on the base that will do"),
    ("tolerance.force_limit", "force on the base that will do"),
    ("design.density", "density of the plate"),
    ("design.thickness", "thickness of the plate"),
    ("design.behind_root", "greatest distance behind a root"),
    ("design.across", "greatest distance off a link"),
    ("design.heaviest", "heaviest counterweight"),
    ("design.as_cut", "links are flat bars, as they are cut"),
    ("design.bar_width", "width of the bars that are cut"),
    ("design.bar_thickness", "thickness of the bars that are cut"),
    ("design.bar_density", "density of the bars that are cut"),
    ("design.shape", "shape of counterweights"),
    ("design.inner_radius", "inner radius of rings"),
    ("design.box_width", "width of boxes"),
    ("design.clearance", "distance of counterweights from pins"),
    ("design.payload", "range of the payload"),
    ("design.reach", "least reach"),
    ("design.workspace", "least workspace"),
    ("design.ratio.*", "gear ratio of drive *"),
    ("design.fixed.*", "link * stays"),
];

/// Further words by which people look for a setting, by the beginning of its path.
const SEARCH_WORDS: &[(&str, &str)] = &[
    ("compare_b", "second workspace dashed"),
    ("design.shape", "disc ring half ring box"),
    ("design.as_cut", "flat bars tails links are cut"),
    ("task.kind", "mode motion reactionless minimum norm"),
    ("task.shape", "curve line arc spline circle straight"),
    ("task.from", "start begin"),
    ("task.via", "waypoint corner"),
    ("task.to", "end goal finish"),
    ("task.time", "motion time T length how long seconds slow fast quick"),
    ("task.law", "profile quintic trapezoidal velocity timing"),
    ("task.moment_limit", "maximum allowed torque base"),
    ("control.law", "controller feedback computed torque PD"),
    ("control.kp", "proportional stiffness"),
    ("control.kd", "derivative damping"),
    ("control.rate", "sampling frequency Hz"),
    ("control.encoder", "resolution quantisation sensor"),
    ("plant.torque_limits", "motor saturation"),
    ("plant.friction", "damping drag loss"),
    ("plant.payload", "load weight hang carry tool gripper"),
    ("base.kind", "fixed free floating compliant spacecraft satellite vehicle mount"),
    ("base.mass", "spacecraft satellite weight"),
    ("base.wheel", "reaction wheel momentum"),
    ("payload", "load weight tool gripper"),
    ("limits", "joint range stop minimum maximum"),
    ("drive", "motor actuator"),
    ("gravity", "weight g acceleration earth"),
    ("tolerance", "monte carlo manufacturing spread"),
    ("design.density", "material steel lead tungsten aluminium"),
    ("design", "counterweight balance"),
    ("counterweight", "balance disc"),
    ("part", "bar plate tube profile section"),
    ("lump", "motor bearing screw sensor weight"),
    ("material", "steel aluminium plastic"),
];

/// Parts of a scenario whose keys are called as those of the machine.
const PARTS_OF_MACHINES: [&str; 4] = ["design.hold.", "design.", "plant.", "tolerance."];

/// Returns the plain name of a setting by its path, with what it belongs to: `mass of link 5`. The path may hold `*` for
/// every link or length: `mass of every link`.
pub fn name_of(path: &str) -> String {
    let of_part = PARTS_OF_MACHINES.iter().find_map(|part| path.strip_prefix(part));
    let found = [Some(path), of_part].into_iter().flatten().find_map(|path| {
        let own = NAMES.iter().find(|(pattern, _)| names(pattern, path));
        let (pattern, name) = own.copied().or_else(|| pattern_of(path))?;
        Some((pattern, name, path))
    });
    let Some((pattern, name, path)) = found else {
        return path.rsplit('.').next().unwrap_or(path).replace('_', " ");
    };
    let place = pattern.split('.').position(|word| word == "*");
    match place.and_then(|place| path.split('.').nth(place)) {
        Some("*") => every(name),
        Some(which) => name.replace('*', which),
        None => name.to_owned(),
    }
}

/// Returns a setting with its plain name first: `mass of link 5 (link.5.mass)`; what is no setting stays as it is.
pub(crate) fn with_name(key: &str) -> String {
    let bare = key.split('[').next().unwrap_or(key);
    if key_of(bare).is_some() { with_key(&name_of(bare), key) } else { key.to_owned() }
}

/// Returns further words by which people look for a setting.
pub fn search_words(path: &str) -> &'static str {
    let found = SEARCH_WORDS.iter().find(|(beginning, _)| path.starts_with(beginning));
    found.map_or("", |(_, words)| words)
}

/// Returns the name of a setting of every link or length.
fn every(name: &str) -> String {
    let words: Vec<&str> = name.split(' ').collect();
    let place = words.iter().position(|word| *word == "*").unwrap_or(words.len());
    let (before, after) = words.split_at(place);
    let Some((thing, before)) = before.split_last() else { return name.to_owned() };
    [before, &["every", thing], after.get(1..).unwrap_or_default()].concat().join(" ")
}
