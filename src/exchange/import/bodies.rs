//! [`MjcfBodies`]: the bodies of MJCF, with at most one hinge each, in the pose of the file.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use roxmltree::Node;

use super::compiler::{Compiler, MassSource};
use super::defaults::{Class, Defaults, Element};
use super::floating::{BodyJoints, FloatingBase, axis};
use super::linkage::{ImportedPart, MAX_PARTS, end_rank};
use super::read::{AttributeSource, child, each, inertia, mass, number, numbers, several, vector, word};
use super::refusal::{ImportError, element_error, element_name};
use super::shapes::{MassProperties, solid};
use stillbase_settings::range::quote_clipped;

/// A point: its part, `None` for the base, and its position in the axes of the base, m.
pub type AttachmentPoint = (Option<usize>, Vector3<f64>);
/// The bases that float and are supported, for messages.
const FLOATING_WANTED: &str = "one base that floats in the world, with all of the arm on it";
/// Relative tolerance within which angles, rad, are equal.
const ANGLE_TOLERANCE: f64 = 1e-9;

/// Bodies, hinges and sites of a model.
pub struct MjcfBodies<'a> {
    /// The root.
    pub model: Node<'a, 'a>,
    pub defaults: Defaults<'a>,
    compiler: Compiler,
    /// The parts, depth first.
    pub parts: Vec<ImportedPart>,
    bodies: Vec<Node<'a, 'a>>,
    hinges: Hinges<'a>,
    /// Frames of the parts as drawn, that is, as their elements state them, before the keyframe turns their hinges.
    drawn: Vec<Isometry3<f64>>,
    /// Sites: name and point.
    pub sites: Vec<(&'a str, AttachmentPoint)>,
    /// Second end point of the last shape with `fromto`.
    pub last_end: Option<AttachmentPoint>,
    pub notes: Vec<String>,
}

/// The hinges of a model, in the order in which a pose lists them, and the base that floats, if one does.
struct Hinges<'a> {
    /// The part of each hinge, by name.
    named: BTreeMap<&'a str, usize>,
    /// The hinge of each part, if it has one.
    of: Vec<Option<Hinge<'a>>>,
    floating: Option<FloatingBase<'a>>,
}

/// A hinge: its angle as drawn and in the pose of the file, rad, and its limits, rad.
#[derive(Clone)]
struct Hinge<'a> {
    element: Element<'a>,
    drawn: f64,
    now: f64,
    limits: Option<[f64; 2]>,
}

/// A body, with the part that carries it and the default class of elements in it.
struct ListedBody<'a> {
    body: Node<'a, 'a>,
    parent: Option<usize>,
    class: Class<'a>,
}

impl<'a> MjcfBodies<'a> {
    /// Reads the bodies of a `<mujoco>`.
    ///
    /// # Errors
    /// If a body is neither fixed nor on a single hinge, or if something is missing, malformed or not supported.
    pub fn of(model: Node<'a, 'a>) -> Result<Self, ImportError> {
        let other = |node: &Node| ["include", "replicate", "attach", "frame"].contains(&node.tag_name().name());
        if let Some(node) = model.descendants().find(other) {
            return Err(element_error(node, "what it brings is not read", "one file, with all bodies in it"));
        }
        let (compiler, defaults) = (Compiler::of(model)?, Defaults::of(model)?);
        let open = listed(model, &defaults)?;
        let hinges = Hinges::of(model, &open, &compiler, &defaults)?;
        let mut bodies = Self {
            model,
            defaults,
            compiler,
            parts: Vec::new(),
            bodies: open.iter().map(|open| open.body).collect(),
            hinges,
            drawn: Vec::new(),
            sites: Vec::new(),
            last_end: None,
            notes: Vec::new(),
        };
        open.iter().enumerate().try_for_each(|(i, open)| bodies.body(i, open))?;
        bodies.scale();
        Ok(bodies)
    }

    fn body(&mut self, own: usize, open: &ListedBody<'a>) -> Result<(), ImportError> {
        let (body, parent) = (open.body, open.parent);
        let floats = self.floating().is_some_and(|base| base.body == own);
        // A base that floats has the axes in which the machine is read.
        let own_place = if floats { Isometry3::identity() } else { self.compiler.place(&body)? };
        let on = |frames: &dyn Fn(usize) -> Isometry3<f64>| parent.map_or(Isometry3::identity(), frames) * own_place;
        let drawn = on(&|parent| self.drawn[parent]);
        let mut frame = on(&|parent| self.parts[parent].frame);
        let mut axis_and_place = None;
        if let Some(Hinge { element, drawn, now, .. }) = &self.hinges.of[own] {
            let axis = axis(element)?;
            let at = vector(element, "pos")?.unwrap_or_default();
            let about = Translation3::from(at);
            let turn = UnitQuaternion::from_axis_angle(&axis, now - drawn);
            frame = frame * about * turn * about.inverse();
            axis_and_place = Some((frame.rotation * axis, (frame * Point3::from(at)).coords));
        }
        for site in each(body, "site") {
            let element = self.defaults.element(site, &open.class)?;
            let at = frame * Point3::from(vector(&element, "pos")?.unwrap_or_default());
            self.sites.push((site.attribute("name").unwrap_or_default(), (Some(own), at.coords)));
        }
        let root = parent.map_or(own, |parent| self.root(parent));
        if axis_and_place.is_some()
            && let Some(base) = self.floating().filter(|base| base.body != root)
        {
            return Err(base.wrong("it floats, and what turns stands beside it", FLOATING_WANTED));
        }
        let mut carriers = std::iter::successors(parent, |i| self.parts[*i].parent);
        let moves = axis_and_place.is_some()
            || self.floating().is_some_and(|base| base.body == root)
            || carriers.any(|i| self.parts[i].hinge.is_some());
        let MassProperties { mass, com, inertia } =
            if moves { self.weight(open, &frame, &own_place)? } else { MassProperties::none(frame.translation.vector) };
        let name = body.attribute("name").map_or_else(|| format!("body {}", own + 1), Into::into);
        let at = body.range().start;
        let hinge = axis_and_place;
        self.parts.push(ImportedPart {
            name,
            called: element_name(body),
            at,
            parent,
            frame,
            hinge,
            mass,
            com,
            inertia,
        });
        self.drawn.push(drawn);
        Ok(())
    }

    /// Returns mass, centre of mass and inertia of a body in the axes of the base. The centre of mass of a body without
    /// mass is that of MuJoCo: the position of the body, applied once more in the frame of the body.
    fn weight(
        &mut self,
        open: &ListedBody<'a>,
        frame: &Isometry3<f64>,
        own_place: &Isometry3<f64>,
    ) -> Result<MassProperties, ImportError> {
        let (body, none) = (open.body, MassProperties::none((frame * own_place).translation.vector));
        let inertial = child(body, "inertial");
        let mut shapes = none;
        let is_weighed = match self.compiler.weighing {
            MassSource::Auto => inertial.is_none(),
            MassSource::Shapes => true,
            MassSource::Written => false,
        };
        for shape in each(body, "geom") {
            let element = self.defaults.element(shape, &open.class)?;
            if let Some(ends) = several::<6>(&element, "fromto")? {
                let at = frame * Point3::new(ends[3], ends[4], ends[5]);
                self.last_end = Some((Some(self.parts.len()), at.coords));
            }
            if is_weighed && let Some(one) = solid(&element, &self.compiler, frame)? {
                shapes = shapes.and(one);
            }
        }
        // If no shape has a mass, `<inertial>` is used in any case.
        let written = inertial.filter(|_| shapes.mass <= 0.0);
        let mut all = shapes;
        if let Some(node) = written {
            let place = frame * self.compiler.place(&node)?;
            let principal = match (several::<3>(node, "diaginertia")?, several::<6>(node, "fullinertia")?) {
                (Some([xx, yy, zz]), _) => [xx, yy, zz, 0.0, 0.0, 0.0],
                (None, Some(all)) => all,
                (None, None) => return Err(element_error(node, "it has no inertia", "diaginertia or fullinertia")),
            };
            let inertia = inertia(principal, &Rotation3::from(place.rotation));
            all = MassProperties { mass: mass(node, "mass")?, com: place.translation.vector, inertia };
        }
        (all.mass, all.inertia) = self.compiler.bounded(all.mass, all.inertia);
        let turns = self.hinges.of[self.parts.len()].is_some();
        if written.is_none() && all.mass <= 0.0 && turns && child(body, "body").is_none() {
            let want = "<inertial> with its mass and inertia, or shapes that have mass";
            return Err(element_error(body, "it turns and nothing gives it a mass", want));
        }
        Ok(all)
    }

    /// Scales masses and inertias to the total mass that the file prescribes.
    fn scale(&mut self) {
        let now: f64 = self.parts.iter().map(|part| part.mass).sum();
        let Some(total) = self.compiler.total.filter(|_| now > 0.0) else { return };
        for part in &mut self.parts {
            part.mass *= total / now;
            part.inertia *= total / now;
        }
    }

    /// Returns an element outside of all bodies with its class.
    ///
    /// # Errors
    /// If its class does not exist.
    pub fn element(&self, node: Node<'a, 'a>) -> Result<Element<'a>, ImportError> {
        self.defaults.element(node, &self.defaults.main())
    }

    /// Returns whether the range of an element is a limit.
    pub fn is_limit(&self, element: &Element<'a>, attribute: &str) -> bool {
        self.compiler.is_limit(element, attribute)
    }

    /// Returns the base, if it floats.
    pub fn floating(&self) -> Option<&FloatingBase<'a>> {
        self.hinges.floating.as_ref()
    }

    /// Returns the body that is fixed to the world and carries the arm, if it has a mass or shapes.
    pub fn fixed_base(&self) -> Option<&ImportedPart> {
        let carriers = |i: usize| std::iter::successors(self.parts[i].parent, |i| self.parts[*i].parent);
        let turns = |i: usize| self.parts[i].hinge.is_some();
        let stands = |i: &usize| turns(*i) && !carriers(*i).any(turns);
        let has_body = |i: &usize| ["inertial", "geom"].iter().any(|name| child(self.bodies[*i], name).is_some());
        let arms = (0..self.parts.len()).filter(stands);
        arms.flat_map(carriers).find(has_body).filter(|_| self.floating().is_none()).map(|i| &self.parts[i])
    }

    /// Returns the part in the world that carries a part, or is it.
    fn root(&self, part: usize) -> usize {
        std::iter::successors(Some(part), |i| self.parts[*i].parent).last().unwrap_or(part)
    }

    /// Returns the hinge of a part.
    pub fn hinge(&self, i: usize) -> Option<&Element<'a>> {
        self.hinges.of.get(i).and_then(Option::as_ref).map(|hinge| &hinge.element)
    }

    /// Returns the part of the hinge that an attribute names.
    ///
    /// # Errors
    /// If the attribute is missing, or names no hinge.
    pub fn part_of(&self, node: impl AttributeSource<'a>, attribute: &'static str) -> Result<usize, ImportError> {
        self.hinges.part_of(node, attribute)
    }

    /// Returns the angle of a part's hinge in the pose of the file, rad.
    pub fn angle(&self, i: usize) -> f64 {
        self.hinges.of.get(i).and_then(Option::as_ref).map_or(0.0, |hinge| hinge.now)
    }

    /// Returns the angle of a part's hinge as drawn, rad.
    pub fn drawn_angle(&self, i: usize) -> f64 {
        self.hinges.of.get(i).and_then(Option::as_ref).map_or(0.0, |hinge| hinge.drawn)
    }

    /// Returns the limits of a part's hinge, rad.
    pub fn range(&self, i: usize) -> Option<[f64; 2]> {
        self.hinges.of.get(i)?.as_ref()?.limits
    }

    /// Finds the end effector. It is a site or body with a usual name, or else the only site that is not a pin, or else
    /// the end of the last shape.
    pub fn end(&mut self) -> Option<AttachmentPoint> {
        let sites = self.sites.iter().filter_map(|(name, end)| Some((end_rank(name)?, *end)));
        let bodies = self.parts.iter().enumerate();
        let bodies =
            bodies.filter_map(|(i, part)| Some((end_rank(&part.name)?, (Some(i), part.frame.translation.vector))));
        if let Some((_, end)) = sites.chain(bodies).min_by_key(|(rank, _)| *rank) {
            return Some(end);
        }
        let pins: Vec<&str> = each(self.model, "equality")
            .flat_map(|node| each(node, "connect"))
            .flat_map(|node| ["site1", "site2"].map(|name| node.attribute(name).unwrap_or_default()))
            .collect();
        let mut others = self.sites.iter().filter(|(name, _)| name.is_empty() || !pins.contains(name));
        if let (Some((_, end)), None) = (others.next(), others.next()) {
            return Some(*end);
        }
        let end = self.last_end?;
        let name = end.0.map_or("the base", |i| self.parts[i].name.as_str());
        self.notes.push(format!(
            "no site says where the end effector is: it was put where the last shape of \"{}\" ends; a site end_effector \
             says otherwise",
            quote_clipped(name)
        ));
        Some(end)
    }

    /// Returns both points of a `<connect>`.
    ///
    /// # Errors
    /// If a site or body does not exist, an attribute is missing, or the anchor is malformed.
    pub fn ends(&self, node: Node<'a, 'a>) -> Result<[AttachmentPoint; 2], ImportError> {
        if node.has_attribute("site1") {
            let end = |attribute: &'static str| {
                let name = word(node, attribute)?;
                let known = self.sites.iter().find(|(own, _)| *own == name).map(|(_, end)| *end);
                known.ok_or_else(|| {
                    element_error(node, format!("no site \"{}\"", quote_clipped(name)), "the name of one in a body")
                })
            };
            return self.afloat(node, [end("site1")?, end("site2")?]);
        }
        let body = |attribute: &'static str| -> Result<Option<usize>, ImportError> {
            let Some(name) = node.attribute(attribute).filter(|name| *name != "world") else { return Ok(None) };
            let known = self.bodies.iter().position(|body| body.attribute("name") == Some(name));
            known
                .map(Some)
                .ok_or_else(|| element_error(node, format!("no body \"{}\"", quote_clipped(name)), "the name of one"))
        };
        let (a, b) = (body("body1")?, body("body2")?);
        let anchor = Point3::from(vector(node, "anchor")?.unwrap_or_default());
        // The anchor is given in the frame of the first body; the other body's point coincides with it as drawn.
        let drawn = |part: Option<usize>| part.map_or(Isometry3::identity(), |i| self.drawn[i]);
        let now = |part: Option<usize>| part.map_or(Isometry3::identity(), |i| self.parts[i].frame);
        let in_b = drawn(b).inverse() * drawn(a) * anchor;
        self.afloat(node, [(a, (now(a) * anchor).coords), (b, (now(b) * in_b).coords)])
    }

    /// Returns both points of a `<connect>`, unless they tie a base that floats to the world.
    fn afloat(&self, node: Node<'a, 'a>, ends: [AttachmentPoint; 2]) -> Result<[AttachmentPoint; 2], ImportError> {
        let is_aside = |part: Option<usize>| {
            self.floating().is_some_and(|base| part.is_none_or(|part| self.root(part) != base.body))
        };
        match ends.iter().any(|(part, _)| is_aside(*part)) {
            true => Err(element_error(node, "it ties to the world what floats", "points of the base or of the arm")),
            false => Ok(ends),
        }
    }
}

/// Lists the bodies depth first, which is the order of the angles of a pose.
fn listed<'a>(model: Node<'a, 'a>, defaults: &Defaults<'a>) -> Result<Vec<ListedBody<'a>>, ImportError> {
    if child(model, "worldbody").is_none() {
        return Err(element_error(model, "it has no <worldbody>", "one, with the machine in it"));
    }
    let below = |node: Node<'a, 'a>, parent: Option<usize>, class: &Class<'a>| {
        let open = |body| {
            let class = defaults.class(body, "childclass", class)?;
            Ok::<_, ImportError>(ListedBody { body, parent, class })
        };
        each(node, "body").map(open).collect::<Result<Vec<_>, _>>()
    };
    let mut all = Vec::new();
    let mut open = Vec::new();
    for world in each(model, "worldbody") {
        open.extend(below(world, None, &defaults.main())?);
    }
    open.reverse();
    while let Some(next) = open.pop() {
        if all.len() == MAX_PARTS {
            return Err(element_error(next.body, "too many bodies", format!("at most {MAX_PARTS}")));
        }
        let children = below(next.body, Some(all.len()), &next.class)?;
        open.extend(children.into_iter().rev());
        all.push(next);
    }
    Ok(all)
}

impl<'a> Hinges<'a> {
    fn of(
        model: Node<'a, 'a>,
        bodies: &[ListedBody<'a>],
        compiler: &Compiler,
        defaults: &Defaults<'a>,
    ) -> Result<Self, ImportError> {
        let mut hinges = Self { named: BTreeMap::new(), of: Vec::with_capacity(bodies.len()), floating: None };
        let key = each(model, "keyframe").flat_map(|node| each(node, "key")).find(|key| key.has_attribute("qpos"));
        let pose = key.map(|key| numbers(key, "qpos")).transpose()?.flatten();
        let mut count = 0;
        for (i, open) in bodies.iter().enumerate() {
            let element = match BodyJoints::of(open.body, &open.class, defaults)? {
                BodyJoints::Hinge(element) => element,
                BodyJoints::None => {
                    hinges.of.push(None);
                    continue;
                }
                BodyJoints::Floating(joints) => {
                    let what = match (&hinges.floating, open.parent) {
                        (Some(_), _) => "a second body that floats",
                        (None, Some(_)) => "a body that floats on a body",
                        (None, None) => "",
                    };
                    if !what.is_empty() {
                        return Err(element_error(joints.node(), what, FLOATING_WANTED));
                    }
                    let drawn = compiler.place(&open.body)?.rotation;
                    let own = pose.as_ref().and_then(|pose| pose.get(count..count + joints.coordinates()));
                    count += joints.coordinates();
                    hinges.floating = Some(joints.base(i, drawn, own, compiler.unit)?);
                    hinges.of.push(None);
                    continue;
                }
            };
            let drawn = number(&element, "ref")?.unwrap_or(0.0) * compiler.unit;
            let now = pose.as_ref().and_then(|pose| pose.get(count)).copied().unwrap_or(drawn);
            count += 1;
            let range = several::<2>(&element, "range")?.filter(|_| compiler.is_limit(&element, "limited"));
            let limits = range.map(|range| range.map(|x| compiler.unit * x));
            if let Some(name) = element.node().attribute("name") {
                hinges.named.insert(name, i);
            }
            hinges.of.push(Some(Hinge { element, drawn, now, limits }));
        }
        match (key, pose) {
            (Some(key), Some(pose)) if pose.len() != count => Err(element_error(
                key,
                format!("qpos has {} numbers", pose.len()),
                match &hinges.floating {
                    None => format!("{count}, one for each hinge"),
                    Some(_) => format!("{count}, those of the joints of the base and one for each hinge"),
                },
            )),
            _ => hinges.coupled(model, defaults).map(|()| hinges),
        }
    }

    fn part_of(&self, node: impl AttributeSource<'a>, attribute: &'static str) -> Result<usize, ImportError> {
        let name = word(&node, attribute)?;
        let known = self.named.get(name).copied();
        known.ok_or_else(|| {
            element_error(
                node.node(),
                format!("{attribute} \"{}\" is no hinge", quote_clipped(name)),
                "the name of one",
            )
        })
    }

    /// Sets hinge angles so that the joint equalities hold, as MuJoCo does in simulation.
    fn coupled(&mut self, model: Node<'a, 'a>, defaults: &Defaults<'a>) -> Result<(), ImportError> {
        let all = each(model, "equality").flat_map(|node| each(node, "joint"));
        let mut couplings = Vec::new();
        for node in all.take(MAX_PARTS) {
            let element = defaults.element(node, &defaults.main())?;
            if is_active(&element) {
                let other = node.has_attribute("joint2").then(|| self.part_of(node, "joint2")).transpose()?;
                couplings.push((self.part_of(node, "joint1")?, other, polynomial(&element)?));
            }
        }
        let off = |hinge: &Option<Hinge>| hinge.as_ref().map_or(0.0, |hinge| hinge.now - hinge.drawn);
        // Equalities may depend on each other in any order, so they are applied repeatedly.
        for _ in 0..couplings.len() {
            let mut is_done = true;
            for (part, other, factors) in &couplings {
                let x = other.map_or(0.0, |other| off(&self.of[other]));
                let want = factors.iter().rev().fold(0.0, |sum, factor| sum * x + factor);
                if let Some(hinge) = self.of[*part].as_mut().filter(|hinge| {
                    let size = 1.0 + want.abs();
                    (hinge.now - hinge.drawn - want).abs() > ANGLE_TOLERANCE * size && want.is_finite()
                }) {
                    hinge.now = hinge.drawn + want;
                    is_done = false;
                }
            }
            if is_done {
                break;
            }
        }
        Ok(())
    }
}

/// Returns whether an equality is active.
pub fn is_active<'a>(element: &Element<'a>) -> bool {
    element.get("active") != Some("false")
}

/// Returns the polynomial coefficients of a coupling, by ascending power.
pub fn polynomial<'a>(element: &Element<'a>) -> Result<Vec<f64>, ImportError> {
    Ok(numbers(element, "polycoef")?.unwrap_or_else(|| vec![0.0, 1.0]))
}
