//! [`Flat`]: a linkage in the plane of its motion.

use nalgebra::{Matrix3, Vector3};

use crate::exchange::import::linkage::{Linkage, Part, common_axis, owners, plane};
use crate::exchange::import::refusal::ImportError;
use crate::mechanics::machine::MAX_LINKS;
use crate::mechanics::planar::Vector;
use crate::settings::number::Short;
use crate::settings::range::clipped;

/// A mass below this share of all is none.
pub const NOTHING: f64 = 1e-9;
/// Lengths below this share of the machine's are none.
pub(super) const NO_LENGTH: f64 = 1e-9;

/// A base with all that is fixed to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BaseBody {
    /// kg.
    pub mass: f64,
    /// About its centre of mass, around the axis of the drives, kg m².
    pub inertia: f64,
    /// Its centre of mass as seen from the axis of the drives, m.
    pub com: Vector,
}

/// A part with all that is fixed to it, in the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    pub(super) mass: f64,
    /// m.
    pub(super) com: Vector,
    /// Along n, m.
    pub(super) height: f64,
    /// About n through the centre of mass, kg m².
    pub(super) inertia: f64,
}

impl Body {
    const NONE: Self = Self { mass: 0.0, com: Vector::new(0.0, 0.0), height: 0.0, inertia: 0.0 };

    fn and(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        if mass <= 0.0 {
            return Self { inertia: self.inertia + other.inertia, ..self };
        }
        let share = other.mass / mass;
        let com = self.com + share * (other.com - self.com);
        let away = self.mass * (self.com - com).norm_sqr() + other.mass * (other.com - com).norm_sqr();
        let height = self.height + share * (other.height - self.height);
        Self { mass, com, height, inertia: self.inertia + other.inertia + away }
    }
}

/// The linkage in its plane, in the reference pose.
pub(super) struct Flat {
    pub(super) axes: [Vector3<f64>; 3],
    /// Of each part that turns, with what is fixed to it.
    pub(super) bodies: Vec<Body>,
    /// Where each part turns.
    pub(super) roots: Vec<Vector>,
    pub(super) owners: Vec<Option<usize>>,
    /// Parts that are links.
    pub(super) links: Vec<usize>,
    /// How large the machine is, m.
    pub(super) size: f64,
}

impl Flat {
    pub(super) fn of(linkage: &Linkage) -> Result<Self, ImportError> {
        let parts = &linkage.parts;
        let (normal, _) = common_axis(parts)?;
        let axes = plane(&normal);
        let flat = |p: &Vector3<f64>| Vector::new(axes[0].dot(p), axes[1].dot(p));
        let owners = owners(parts);
        let roots: Vec<Vector> =
            parts.iter().map(|part| part.hinge.map_or(Vector::default(), |(_, on)| flat(&on))).collect();
        let own = |part: &Part| Body {
            mass: part.mass,
            com: flat(&part.com),
            height: axes[2].dot(&part.com),
            inertia: axes[2].dot(&(part.inertia * axes[2])),
        };
        let mut bodies = vec![Body::NONE; parts.len()];
        let total: f64 = parts.iter().map(|part| part.mass).sum();
        for (i, part) in parts.iter().enumerate() {
            let body = own(part);
            if body.inertia < 0.0 {
                return Err(
                    part.wrong(format!("an inertia of {} kg m²", Short(body.inertia)), "one that is not below 0")
                );
            }
            let rotor = linkage.rotors.iter().find(|(rotor, ..)| *rotor == i);
            let to = if rotor.is_some() { part.parent.and_then(|parent| owners[parent]) } else { owners[i] };
            if let Some(to) = to {
                // Of a rotor only its mass belongs to what carries it.
                match rotor {
                    Some(_) if body.mass <= NOTHING * total => {}
                    Some(_) => bodies[to] = bodies[to].and(Body { inertia: 0.0, ..body }),
                    None => bodies[to] = bodies[to].and(body),
                }
            }
        }
        check_rotors(linkage, &roots, &flat)?;
        let places = roots.iter().chain(bodies.iter().map(|body| &body.com));
        let ends = linkage.end.iter().map(|(_, at)| flat(at));
        let size = places.copied().chain(ends).fold(0.0_f64, |most, at| most.max((at - roots[0]).norm()));
        let inertia: f64 =
            bodies.iter().map(|body| body.inertia + body.mass * (body.com - roots[0]).norm_sqr()).sum::<f64>();
        let is_link = |i: &usize| {
            let is_rotor = linkage.rotors.iter().any(|(rotor, ..)| rotor == i);
            let counts = bodies[*i].mass > NOTHING * total || bodies[*i].inertia > NOTHING * inertia;
            parts[*i].hinge.is_some() && !is_rotor && counts
        };
        let links: Vec<usize> = (0..parts.len()).filter(is_link).collect();
        if links.len() > MAX_LINKS {
            let what = format!("{} links that turn and have mass", links.len());
            return Err(ImportError::whole(what, format!("at most {MAX_LINKS}")));
        }
        Ok(Self { axes, bodies, roots, owners, links, size: size.max(f64::MIN_POSITIVE) })
    }

    pub(super) fn flat(&self, p: &Vector3<f64>) -> Vector {
        Vector::new(self.axes[0].dot(p), self.axes[1].dot(p))
    }

    /// Where the drives are: where the first link turns on the base.
    pub(super) fn base(&self, parts: &[Part]) -> Result<Vector, ImportError> {
        for i in &self.links {
            if self.carrier(parts, *i)?.is_none() {
                return Ok(self.roots[*i]);
            }
        }
        Err(ImportError::whole("no link with mass turns on the base", "at least one"))
    }

    /// The base with all that is fixed to it, if it weighs anything.
    pub(super) fn ground(&self, linkage: &Linkage) -> Result<Option<BaseBody>, ImportError> {
        let Some(ground) = &linkage.ground else { return Ok(None) };
        let normal = self.axes[2];
        let own = |mass: f64, com: &Vector3<f64>, inertia: &Matrix3<f64>| Body {
            mass,
            com: self.flat(com),
            height: 0.0,
            inertia: normal.dot(&(inertia * normal)),
        };
        let total: f64 = linkage.parts.iter().map(|part| part.mass).sum();
        let is_still = |part: &Part| part.parent.is_none_or(|parent| self.owners[parent].is_none());
        let parts = linkage.parts.iter().enumerate().filter_map(|(i, part)| {
            // Of a rotor in the base only its mass belongs to it.
            let is_rotor = linkage.rotors.iter().any(|(rotor, ..)| *rotor == i) && is_still(part);
            let inertia = if is_rotor { Matrix3::zeros() } else { part.inertia };
            let counts = self.owners[i].is_none() || (is_rotor && part.mass > NOTHING * total);
            counts.then(|| own(part.mass, &part.com, &inertia))
        });
        let all = parts.fold(own(ground.mass, &ground.com, &ground.inertia), Body::and);
        let com = all.com - self.base(&linkage.parts)?;
        let is_any = all.mass > 0.0 && all.inertia > 0.0;
        Ok(is_any.then_some(BaseBody { mass: all.mass, inertia: all.inertia, com }))
    }

    pub(super) fn is_none(&self, v: Vector) -> bool {
        v.norm() <= NO_LENGTH * self.size
    }

    /// The link that holds a part that turns, and whether what is between them reaches anywhere.
    pub(super) fn carrier(&self, parts: &[Part], i: usize) -> Result<Option<usize>, ImportError> {
        let mut at = i;
        loop {
            let Some(next) = parts[at].parent.and_then(|parent| self.owners[parent]) else { return Ok(None) };
            if self.links.contains(&next) {
                return Ok(Some(next));
            }
            if !self.is_none(self.roots[i] - self.roots[next]) {
                return Err(parts[next].wrong("it has length and no mass", "a mass, and an inertia"));
            }
            at = next;
        }
    }
}

/// One rotor for a motor, and its mass on its axis.
fn check_rotors(
    linkage: &Linkage,
    roots: &[Vector],
    flat: &impl Fn(&Vector3<f64>) -> Vector,
) -> Result<(), ImportError> {
    let total: f64 = linkage.parts.iter().map(|part| part.mass).sum();
    for (number, (i, k, _)) in linkage.rotors.iter().enumerate() {
        let part = &linkage.parts[*i];
        if linkage.rotors[..number].iter().any(|(_, other, _)| other == k) {
            let name = clipped(&linkage.motors[*k].name);
            return Err(part.wrong(format!("a second rotor of \"{name}\""), "one rotor for a motor"));
        }
        let off = (flat(&part.com) - roots[*i]).norm();
        if part.mass > NOTHING * total && off > NO_LENGTH * (1.0 + roots[*i].norm()) {
            return Err(
                part.wrong(format!("a rotor with its mass {} m off its axis", Short(off)), "a rotor that is balanced")
            );
        }
    }
    Ok(())
}
