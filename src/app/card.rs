//! The card beside the pointer: name, values and units of the object under the pointer, and how to edit the object.

use egui::{RichText, Ui};

use super::notation;
use super::theme::{bold, colour, plain};
use stillbase_mechanics::machine::CounterweightShape;
use stillbase_picture::notation::Notation;
use stillbase_picture::numbers::{degrees, signed, three_digits};
use stillbase_picture::scene::course::target_handle;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::views::Views;
use stillbase_session::Session;
use stillbase_settings::number::subscript;
use stillbase_simulation::plant::BaseKind;

/// Information on an object of the scene.
pub struct Card {
    /// Its name.
    pub title: String,
    /// Its values with their units.
    pub rows: Vec<String>,
    /// Actions of the pointer on the object.
    pub hint: String,
}

/// Hint on the target while the run waits.
const RUN_WAITS: &str = "the run waits: nothing follows until its task can be done";

/// Tolerance within which an angle is reported to be at its limit, rad.
const AT_LIMIT_RAD: f64 = 1e-3;

impl Card {
    fn new(title: impl Into<String>, rows: impl Into<Vec<String>>, hint: impl Into<String>) -> Self {
        Self { title: title.into(), rows: rows.into(), hint: hint.into() }
    }

    /// Returns the card of an object at the instant on display; `None` for objects without a card.
    pub fn of(thing: Handle, session: &Session, views: &Views, notation: Notation) -> Option<Self> {
        let (scenario, frame) = (session.scenario(), session.frame());
        let place = |x: f64, y: f64| format!("{}, {} m", signed(x, 3), signed(y, 3));
        Some(match thing {
            Handle::Link(i) => link(i, session)?,
            Handle::Joint(i) => joint(i, session, views)?,
            Handle::Limit(k, end) => limit(k, end, session)?,
            Handle::Base => base(session),
            Handle::Target => {
                let at = target_handle(frame);
                let waits = frame.target.reach.waits_at();
                let rows: Vec<String> = waits.iter().map(|at| format!("waits at {}", place(at.re, at.im))).collect();
                let hint = match session.run().pose_space() {
                    _ if session.run().waiting().is_some() => RUN_WAITS,
                    Ok(_) => "drag: the machine follows, b stays",
                    Err(_) if session.can_be_dragged() => "drag: the machine follows at zero momentum",
                    Err(_) => "",
                };
                Self::new(format!("target at {}", place(at.re, at.im)), rows, hint)
            }
            Handle::Waypoint(i) => {
                let at = *scenario.task.points().get(i)?;
                let name = scenario.task.name_of(i);
                let role = match i {
                    0 => "start",
                    i if i > scenario.task.via.len() => "end",
                    _ => "",
                };
                let title = format!("{role} point {name} of the path, {}", place(at.re, at.im));
                let title = title.trim_start().to_owned();
                Self::new(title, [], "drag to move it; Delete leaves it out\nclick: its row in the panel")
            }
            Handle::Payload => {
                let load = scenario.plant.payload;
                let mut rows = vec![format!("inertia {} kg m², unknown to control", three_digits(load.inertia))];
                let [along, across] = load.offset;
                if along.hypot(across) > 0.0 {
                    rows.push(format!("{} m along, {} m across the last link", signed(along, 3), signed(across, 3)));
                }
                let title = format!("payload, {} kg", three_digits(load.mass));
                Self::new(title, rows, "drag: moves its centre of mass\nclick: its rows in the panel")
            }
            Handle::Ring => {
                let rows = vec![format!("moment on the base while it changes: {} N m", signed(frame.felt_moment, 3))];
                let title = format!("pose constant, b = {} rad", signed(frame.b_reference, 3));
                Self::new(title, rows, "drag: turns the reactionless workspace\nclick: its row in the panel")
            }
            Handle::Boundary => {
                let planes = session.run().planes()?;
                let b = frame.b_reference;
                let rows =
                    vec![format!("encloses {} m² at b = {} rad", signed(planes.boundary().area(), 3), signed(b, 3))];
                Self::new("boundary of the reactionless workspace", rows, "click: b in the panel")
            }
            Handle::Force => {
                let (now, peak) = (frame.wrench.dynamic.force.norm(), frame.peaks.force);
                let rows = vec![format!("largest so far {} N", signed(peak, 3))];
                Self::new(format!("{} = {} N", notation.name("force on the base", "f_B"), signed(now, 3)), rows, "")
            }
            Handle::Moment => {
                let rows = vec![format!("largest so far {} N m", signed(frame.peaks.moment, 3))];
                let name = notation.base_moment(scenario.base.feels_more_than_n_b());
                let title = format!("{name} = {} N m", signed(frame.felt_moment, 3));
                Self::new(title, rows, "")
            }
            Handle::Mass(i) => {
                let link = scenario.machine.spec().links.get(i)?;
                let rows = vec![format!("{} kg, {} m from its root", three_digits(link.mass), signed(link.com, 4))];
                Self::new(format!("centre of mass of link {}", link.name), rows, "drag: along its link")
            }
            Handle::Weight(i) => {
                let weight = scenario.machine.spec().counterweights.get(i)?;
                let mut rows = vec![
                    format!("{} kg, {} m from its root", three_digits(weight.mass), signed(weight.at, 4)),
                    match weight.across {
                        0.0 => "on its link's axis".into(),
                        across if across > 0.0 => format!("{} m left of its link's axis", signed(across, 4)),
                        across => format!("{} m right of its link's axis", signed(-across, 4)),
                    },
                ];
                rows.extend(weight.sizes().map(|(name, size)| format!("{name} {} m", signed(size, 4))));
                let way = if scenario.design.across > 0.0 || weight.across != 0.0 {
                    "drag: along and across its link"
                } else {
                    "drag: along its link"
                };
                let shape = match weight.shape() {
                    CounterweightShape::Disc { .. } => String::new(),
                    shape => format!(", a {}", shape.name()),
                };
                Self::new(format!("counterweight of link {}{shape}", weight.link), rows, way)
            }
            Handle::Lump(i) => {
                let (lump, part) = scenario.machine.lump_body(i)?;
                let rows = vec![format!("{} kg, {} m from its root", three_digits(lump.mass), signed(part.body.at, 4))];
                let title = format!("{} of link {}", lump.title(), lump.link);
                Self::new(title, rows, "drag: along and across its link")
            }
            Handle::End(i) => {
                let part = scenario.machine.resolved_links().get(i)?;
                let name = &scenario.machine.links().get(i)?.name;
                let rows = vec![format!("{} m long", signed(part.length, 4))];
                Self::new(format!("end of link {name}"), rows, "drag: its length, with those that share it")
            }
            Handle::EndEffector | Handle::Plane | Handle::Bar => return None,
        })
    }

    /// Returns the card of a link that is being dragged.
    pub fn turned(i: usize, session: &Session) -> Option<Self> {
        let (machine, frame) = (&session.scenario().machine, session.frame());
        let drive = machine.drive_of_link(i)?;
        let title = format!("drive {}, q{} = {}°", drive + 1, subscript(drive + 1), degrees(frame.q[drive]));
        let held = session.run().pose_space().is_ok_and(|map| map.leaves_freedoms());
        let others = if held { "the tip stays, and" } else { "the others follow:" };
        let mut rows = vec![format!("{others} b stays {} rad", signed(frame.b_reference, 3))];
        for (k, angle) in machine.angles().iter().enumerate() {
            let ends = [*angle.limits.start(), *angle.limits.end()];
            if let Some(end) = ends.into_iter().find(|end| (frame.a[k] - end).abs() < AT_LIMIT_RAD) {
                rows.push(format!("a{} stands at its limit, {}°", subscript(k + 1), degrees(end)));
            }
        }
        let hint = if frame.peaks.is_reactionless() { "the base feels nothing" } else { "" };
        Some(Self::new(title, rows, hint))
    }

    /// Draws its content.
    pub fn show(&self, ui: &mut Ui, p: &Palette) {
        ui.spacing_mut().item_spacing.y = 3.0;
        let title = notation::sentence(ui.ctx(), &self.title);
        ui.label(RichText::new(title).font(bold(12.5)).color(colour(p.ink)));
        for row in &self.rows {
            let row = notation::sentence(ui.ctx(), row);
            ui.label(RichText::new(row).font(plain(12.0)).color(colour(p.ink)));
        }
        if !self.hint.is_empty() {
            ui.label(RichText::new(&self.hint).font(plain(11.5)).color(colour(p.dim)));
        }
    }
}

fn link(i: usize, session: &Session) -> Option<Card> {
    let (scenario, frame) = (session.scenario(), session.frame());
    let machine = &scenario.machine;
    let (link, part) = (machine.links().get(i)?, machine.resolved_links().get(i)?);
    let drive = part.drive;
    let title = format!("link {}, turned by drive {}, {} kg", link.name, drive + 1, signed(link.mass, 2));
    let mut rows = vec![
        format!("{} m long, centre of mass at {} m", signed(part.length, 3), signed(link.com, 3)),
        format!("q{} = {}°", subscript(drive + 1), degrees(frame.q[drive])),
    ];
    if scenario.plant.link.contains_key(&link.name) {
        rows.push("the plant differs from this".into());
    }
    let map = session.run().pose_space().ok().filter(|_| session.can_be_dragged());
    let hint = match map {
        Some(map) if map.planes().is_ok() => {
            format!("drag: turns drive {}, the others follow so that b stays\nclick: its rows in the panel", drive + 1)
        }
        Some(map) if map.leaves_freedoms() => {
            "drag: it follows the pointer, the tip and b stay\nclick: its rows in the panel".to_owned()
        }
        _ => "click: its rows in the panel".to_owned(),
    };
    Some(Card::new(title, rows, hint))
}

fn joint(i: usize, session: &Session, views: &Views) -> Option<Card> {
    let (machine, frame) = (&session.scenario().machine, session.frame());
    let (_, joined) = views.stage().linkage().joints(&frame.q.units()).nth(i)?;
    let names: Vec<&str> = joined.iter().filter_map(|j| Some(machine.links().get(*j)?.name.as_str())).collect();
    let (last, before) = names.split_last()?;
    let title = match before {
        [] => format!("pin of link {last}"),
        before => format!("pin of links {} and {last}", before.join(", ")),
    };
    // The relative angles between drives whose links meet in this pin.
    let drives: Vec<usize> = joined.iter().map(|j| machine.resolved_links()[*j].drive).collect();
    let angles = machine.angles().iter().enumerate();
    let meets = angles.filter(|(_, angle)| drives.contains(&angle.to) && drives.contains(&angle.from));
    let row = |(k, angle): (usize, &stillbase_mechanics::machine::RelativeAngle)| {
        let now = degrees(frame.a[k]);
        let [low, high] = [*angle.limits.start(), *angle.limits.end()];
        match low.is_finite() && high.is_finite() {
            true => format!("a{} = {now}°, may be {}° to {}°", subscript(k + 1), degrees(low), degrees(high)),
            false => format!("a{} = {now}°, turns freely", subscript(k + 1)),
        }
    };
    let rows: Vec<String> = meets.map(row).collect();
    Some(Card::new(title, rows, "click: joint limits in the panel"))
}

fn limit(k: usize, end: usize, session: &Session) -> Option<Card> {
    let angle = session.scenario().machine.angles().get(k)?;
    let (word, value) = match end {
        0 => ("least", *angle.limits.start()),
        _ => ("greatest", *angle.limits.end()),
    };
    let title = format!("joint limit: {word} a{}, {}°", subscript(k + 1), degrees(value));
    let rows = [format!("a{} = {}° now", subscript(k + 1), degrees(session.frame().a[k]))];
    Some(Card::new(title, rows, "drag: the workspace changes with it\nclick: joint limits in the panel"))
}

fn base(session: &Session) -> Card {
    let (base, frame) = (&session.scenario().base, session.frame());
    let moved = |rows: &mut Vec<String>| {
        let at = frame.base.at;
        rows.push(format!(
            "moved by {} mm, turned by {} mrad",
            signed(1e3 * at.norm(), 2),
            signed(1e3 * frame.base.angle, 2)
        ));
    };
    let mut rows = Vec::new();
    let title = match base.kind {
        BaseKind::Fixed => "base, fixed".to_owned(),
        BaseKind::Compliant => format!("base on springs, {} kg", three_digits(base.mass)),
        BaseKind::Free => format!("base that floats, {} kg", three_digits(base.mass)),
    };
    if base.moves() {
        moved(&mut rows);
    }
    rows.push(format!("it feels a moment of {} N m", signed(frame.felt_moment, 3)));
    Card::new(title, rows, "click: its section in the panel")
}
