//! Projects a linkage onto the plane of motion and makes a machine whose links each follow one drive.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | n | common direction of all hinge axes; x and y of the plane derive from the axes of the file's base | |
//! | ψ_k | q_k of drive k in the reference pose, from the axis of its first link with length: see `direction` | rad |
//! | s | position on a link's axis, from its root | m |

use nalgebra::{Matrix3, Vector3};

use super::linkage::{ImportedLinkage, ImportedMotor, ImportedPart, JointLimit, common_axis, owners, plane};
use super::refusal::ImportError;
use crate::base_body::BaseBody;
use stillbase_mechanics::machine::{
    Angle, Attach, Closure, DerivedNumbers, Drive, Length, Link, LinkPoint, MAX_LINKS, Machine, MachineSpec,
    PlaceOnLink, Rotor,
};
use stillbase_mechanics::planar::{MAX_DRIVES, Vector};
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::quote_clipped;

/// Masses and inertias up to this fraction of the total are treated as zero.
pub const NEGLIGIBLE_MASS: f64 = 1e-9;
/// Lengths up to this fraction of the machine's size are treated as zero.
const ZERO_LENGTH_FRACTION: f64 = 1e-9;
/// Two directions are parallel up to this sine of the angle between them.
const PARALLEL_UP_TO_SINE: f64 = 1e-9;
/// Gear ratio of a rotor that replaces an armature. An armature adds nothing to the momentum, but the rotor adds
/// armature/ratio to D_k; the largest allowed ratio makes this smallest.
const ARMATURE_RATIO: f64 = 1e4;
/// Shortest length of a link without pins beyond its root, m.
const MIN_LENGTH_M: f64 = 0.01;

/// A machine from another program.
#[derive(Clone, Debug)]
pub struct ImportedMachine {
    /// The machine.
    pub machine: Machine,
    /// Angles of its drives in the pose of the file, rad: with all joints of URDF at 0, or in the keyframe of MJCF.
    pub pose: Vec<f64>,
    /// The base of the file, if it has mass and inertia; a scenario may use it for a moving base.
    pub base: Option<BaseBody>,
    /// Whether the file lets the base float.
    pub floats: bool,
    /// Notes on omissions and assumptions.
    pub notes: Vec<String>,
}

/// Makes a machine of a linkage.
///
/// # Errors
/// If the linkage is not that of a machine whose links each follow one drive.
pub fn imported(linkage: &ImportedLinkage) -> Result<ImportedMachine, ImportError> {
    let flat = Flat::of(linkage)?;
    let mut notes = linkage.notes.clone();
    let (spec, pose) = Builder { linkage, flat: &flat, notes: &mut notes }.spec()?;
    let base = flat.ground(linkage)?;
    let machine = Machine::new(spec).map_err(|why| ImportError::of_file(why.to_string(), "a machine of the family"))?;
    let floats = linkage.ground.is_some_and(|ground| ground.floats);
    if floats && base.is_none() {
        return Err(ImportError::of_file("the base floats and has no mass or inertia", "both above 0"));
    }
    Ok(ImportedMachine { machine, pose, base, floats, notes })
}

/// A part with all parts that are fixed to it, projected onto the plane.
#[derive(Clone, Copy, Debug)]
struct Body {
    mass: f64,
    /// Centre of mass in the plane, m.
    com: Vector,
    /// Height of the centre of mass along n, m.
    height: f64,
    /// Inertia about n through the centre of mass, kg m².
    inertia: f64,
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

/// The linkage projected onto its plane, in the reference pose.
struct Flat {
    axes: [Vector3<f64>; 3],
    /// Body of each part that turns, with all parts that are fixed to it.
    bodies: Vec<Body>,
    /// Position of each part's hinge, m.
    roots: Vec<Vector>,
    owners: Vec<Option<usize>>,
    /// Parts that are links.
    links: Vec<usize>,
    /// Size of the machine, m: largest distance of a point from the first hinge.
    size: f64,
}

impl Flat {
    fn of(linkage: &ImportedLinkage) -> Result<Self, ImportError> {
        let parts = &linkage.parts;
        let (normal, _) = common_axis(parts)?;
        let axes = plane(&normal);
        let flat = |p: &Vector3<f64>| Vector::new(axes[0].dot(p), axes[1].dot(p));
        let owners = owners(parts);
        let roots: Vec<Vector> =
            parts.iter().map(|part| part.hinge.map_or(Vector::default(), |(_, on)| flat(&on))).collect();
        let own = |part: &ImportedPart| Body {
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
                    part.wrong(format!("an inertia of {} kg m²", ShortNumber(body.inertia)), "one that is not below 0")
                );
            }
            let rotor = linkage.rotors.iter().find(|(rotor, ..)| *rotor == i);
            let to = if rotor.is_some() { part.parent.and_then(|parent| owners[parent]) } else { owners[i] };
            if let Some(to) = to {
                // Only the mass of a rotor belongs to the part that carries it.
                match rotor {
                    Some(_) if body.mass <= NEGLIGIBLE_MASS * total => {}
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
            let counts = bodies[*i].mass > NEGLIGIBLE_MASS * total || bodies[*i].inertia > NEGLIGIBLE_MASS * inertia;
            parts[*i].hinge.is_some() && !is_rotor && counts
        };
        let links: Vec<usize> = (0..parts.len()).filter(is_link).collect();
        if links.len() > MAX_LINKS {
            let what = format!("{} links that turn and have mass", links.len());
            return Err(ImportError::of_file(what, format!("at most {MAX_LINKS}")));
        }
        Ok(Self { axes, bodies, roots, owners, links, size: size.max(f64::MIN_POSITIVE) })
    }

    fn flat(&self, p: &Vector3<f64>) -> Vector {
        Vector::new(self.axes[0].dot(p), self.axes[1].dot(p))
    }

    /// Returns the position of the drives' axis in the plane, m: the hinge of the first link on the base.
    fn base(&self, parts: &[ImportedPart]) -> Result<Vector, ImportError> {
        for i in &self.links {
            if self.carrier(parts, *i)?.is_none() {
                return Ok(self.roots[*i]);
            }
        }
        Err(ImportError::of_file("no link with mass turns on the base", "at least one"))
    }

    /// Returns the base with all parts that are fixed to it, if it has mass and inertia.
    fn ground(&self, linkage: &ImportedLinkage) -> Result<Option<BaseBody>, ImportError> {
        let Some(ground) = &linkage.ground else { return Ok(None) };
        let normal = self.axes[2];
        let own = |mass: f64, com: &Vector3<f64>, inertia: &Matrix3<f64>| Body {
            mass,
            com: self.flat(com),
            height: 0.0,
            inertia: normal.dot(&(inertia * normal)),
        };
        let total: f64 = linkage.parts.iter().map(|part| part.mass).sum();
        let is_still = |part: &ImportedPart| part.parent.is_none_or(|parent| self.owners[parent].is_none());
        let parts = linkage.parts.iter().enumerate().filter_map(|(i, part)| {
            // Only the mass of a rotor in the base belongs to the base.
            let is_rotor = linkage.rotors.iter().any(|(rotor, ..)| *rotor == i) && is_still(part);
            let inertia = if is_rotor { Matrix3::zeros() } else { part.inertia };
            let counts = self.owners[i].is_none() || (is_rotor && part.mass > NEGLIGIBLE_MASS * total);
            counts.then(|| own(part.mass, &part.com, &inertia))
        });
        let all = parts.fold(own(ground.mass, &ground.com, &ground.inertia), Body::and);
        let com = all.com - self.base(&linkage.parts)?;
        let is_any = all.mass > 0.0 && all.inertia > 0.0;
        Ok(is_any.then_some(BaseBody { mass: all.mass, inertia: all.inertia, com }))
    }

    /// Returns whether a length is treated as zero.
    fn is_zero(&self, v: Vector) -> bool {
        v.norm() <= ZERO_LENGTH_FRACTION * self.size
    }

    /// Returns the link that carries a turning part; `None` for the base.
    ///
    /// # Errors
    /// If a massless part between the two has length.
    fn carrier(&self, parts: &[ImportedPart], i: usize) -> Result<Option<usize>, ImportError> {
        let mut at = i;
        loop {
            let Some(next) = parts[at].parent.and_then(|parent| self.owners[parent]) else { return Ok(None) };
            if self.links.contains(&next) {
                return Ok(Some(next));
            }
            if !self.is_zero(self.roots[i] - self.roots[next]) {
                return Err(parts[next].wrong("it has length and no mass", "a mass, and an inertia"));
            }
            at = next;
        }
    }
}

/// Checks that each motor has at most one rotor, and that the rotor's centre of mass is on its axis.
fn check_rotors(
    linkage: &ImportedLinkage,
    roots: &[Vector],
    flat: &impl Fn(&Vector3<f64>) -> Vector,
) -> Result<(), ImportError> {
    let total: f64 = linkage.parts.iter().map(|part| part.mass).sum();
    for (number, (i, k, _)) in linkage.rotors.iter().enumerate() {
        let part = &linkage.parts[*i];
        if linkage.rotors[..number].iter().any(|(_, other, _)| other == k) {
            let name = quote_clipped(&linkage.motors[*k].name);
            return Err(part.wrong(format!("a second rotor of \"{name}\""), "one rotor for a motor"));
        }
        let off = (flat(&part.com) - roots[*i]).norm();
        if part.mass > NEGLIGIBLE_MASS * total && off > ZERO_LENGTH_FRACTION * (1.0 + roots[*i].norm()) {
            return Err(part.wrong(
                format!("a rotor with its mass {} m off its axis", ShortNumber(off)),
                "a rotor that is balanced",
            ));
        }
    }
    Ok(())
}

struct Builder<'a> {
    linkage: &'a ImportedLinkage,
    flat: &'a Flat,
    notes: &'a mut Vec<String>,
}

/// A link's axis: its direction, 1 along its drive or −1 against it, and the positions of pins on it, m.
struct Axis {
    sign: f64,
    places: Vec<f64>,
}

impl Builder<'_> {
    fn spec(&mut self) -> Result<(MachineSpec, Vec<f64>), ImportError> {
        let (linkage, flat) = (self.linkage, self.flat);
        let motors = &linkage.motors;
        if motors.len() > MAX_DRIVES {
            let what = format!("{} motors", motors.len());
            return Err(ImportError::of_file(what, format!("at most {MAX_DRIVES}")));
        }
        let end = linkage.end.filter(|(end, _)| flat.links.contains(end)).ok_or_else(|| {
            let want = "a link end_effector fixed where the machine works, or in MJCF a site of that name";
            ImportError::of_file("nothing says where the end effector is", want)
        })?;
        let mut points = vec![Vec::new(); linkage.parts.len()];
        let mut carriers = vec![None; linkage.parts.len()];
        let base = flat.base(&linkage.parts)?;
        for i in &flat.links {
            carriers[*i] = flat.carrier(&linkage.parts, *i)?;
            match carriers[*i] {
                Some(carrier) => points[carrier].push(flat.roots[*i]),
                None if flat.is_zero(flat.roots[*i] - base) => {}
                None => {
                    let want = "all links on the base on one axis, that of the drives";
                    return Err(linkage.parts[*i].wrong("it turns elsewhere on the base than others", want));
                }
            }
        }
        let ends: Vec<[(usize, Vector); 2]> =
            linkage.loops.iter().map(|ends| ends.map(|(i, at)| (i, flat.flat(&at)))).collect();
        for (i, at) in ends.iter().flatten().copied().chain([(end.0, flat.flat(&end.1))]) {
            match flat.links.contains(&i) {
                true => points[i].push(at),
                false => return Err(linkage.parts[i].wrong("a pin on what has no mass", "pins on links")),
            }
        }
        let psi = (0..motors.len()).map(|k| self.direction(k, &points)).collect::<Result<Vec<f64>, _>>()?;
        let names = self.names();
        let mut axes: Vec<Option<Axis>> = (0..linkage.parts.len()).map(|_| None).collect();
        for i in &flat.links {
            axes[*i] = Some(self.axis(*i, &points[*i], &psi)?);
        }
        let place = |i: usize, at: Vector| {
            let set = linkage.sets[i].unwrap_or(0);
            let sign = axes[i].as_ref().map_or(1.0, |axis| axis.sign);
            let s = sign * ((at - flat.roots[i]) * Vector::from_polar(1.0, -psi[set])).re;
            LinkPoint { link: names[i].clone(), at: PlaceOnLink::Metres(s) }
        };
        let links = flat.links.iter().map(|i| {
            let attach = match carriers[*i] {
                Some(carrier) => Attach::On(place(carrier, flat.roots[*i])),
                None => Attach::Base("base".into()),
            };
            self.link(*i, axes[*i].as_ref(), &psi, attach, &names)
        });
        let links = links.collect::<Result<_, _>>()?;
        let closures = ends.iter().map(|[a, b]| Closure { a: place(a.0, a.1), b: place(b.0, b.1) }).collect();
        let gravity = flat.flat(&linkage.gravity);
        let end_effector = Some(place(end.0, flat.flat(&end.1)));
        let (drives, angles) = (self.drives(), self.angles(&psi));
        let spec = MachineSpec {
            name: linkage.name.clone(),
            summary: String::new(),
            gravity: [gravity.re, gravity.im],
            pose: None,
            lengths: std::collections::BTreeMap::new(),
            payload: stillbase_mechanics::machine::Payload::default(),
            drives,
            links,
            materials: Vec::new(),
            parts: Vec::new(),
            lumps: Vec::new(),
            counterweights: Vec::new(),
            closures,
            end_effector,
            angles,
        };
        Ok((spec, psi))
    }

    /// Returns ψ of a drive, rad.
    fn direction(&self, k: usize, points: &[Vec<Vector>]) -> Result<f64, ImportError> {
        let flat = self.flat;
        let own: Vec<usize> = flat.links.iter().copied().filter(|i| self.linkage.sets[*i] == Some(k)).collect();
        let Some(first) = own.first() else {
            let what = format!("\"{}\" turns no link that has mass", quote_clipped(&self.linkage.motors[k].name));
            return Err(ImportError::of_file(what, "a link for every motor"));
        };
        let farthest = |i: &usize| {
            let all = points[*i].iter().map(|at| at - flat.roots[*i]);
            all.reduce(|a, b| if b.norm() > a.norm() * (1.0 + 1e-9) { b } else { a }).filter(|v| !flat.is_zero(*v))
        };
        // If a link lies along the x axis of its frame in the file, or has no length, this axis is the drive's
        // direction.
        let x = |i: usize| flat.flat(&(self.linkage.parts[i].frame.rotation * Vector3::x()));
        let is_along = |x: Vector, v: Vector| (v * x.conj()).im.abs() <= PARALLEL_UP_TO_SINE * v.norm();
        let far = own.iter().find_map(|i| Some((*i, farthest(i)?)));
        let com = flat.bodies[*first].com - flat.roots[*first];
        Ok(match far {
            _ if x(*first).norm() < 1.0 - PARALLEL_UP_TO_SINE => far.map_or(com, |(_, v)| v).arg(),
            Some((i, v)) if !is_along(x(i), v) => v.arg(),
            Some((i, _)) => x(i).arg(),
            None => x(*first).arg(),
        })
    }

    fn axis(&self, i: usize, points: &[Vector], psi: &[f64]) -> Result<Axis, ImportError> {
        let (flat, part) = (self.flat, &self.linkage.parts[i]);
        let Some(k) = self.linkage.sets[i] else {
            return Err(part.wrong("it does not turn with any drive", "links that each follow one drive"));
        };
        let mut places = Vec::new();
        for at in points {
            let local = (at - flat.roots[i]) * Vector::from_polar(1.0, -psi[k]);
            if local.im.abs() > ZERO_LENGTH_FRACTION * flat.size {
                let off = ShortNumber(local.im);
                let what = format!("a pin {off} m beside the line that links of its drive run along");
                return Err(part.wrong(what, "bars whose pins lie on one line, parallel for links of one drive"));
            }
            places.push(local.re);
        }
        let (least, most) = places.iter().fold((0.0_f64, 0.0_f64), |(a, b), s| (a.min(*s), b.max(*s)));
        let sign = if -least > most * (1.0 + 1e-9) { -1.0 } else { 1.0 };
        places.iter_mut().for_each(|s| *s *= sign);
        Ok(Axis { sign, places })
    }

    fn link(
        &self,
        i: usize,
        axis: Option<&Axis>,
        psi: &[f64],
        attach: Attach,
        names: &[String],
    ) -> Result<Link, ImportError> {
        let (flat, part) = (self.flat, &self.linkage.parts[i]);
        let (Some(axis), Some(k)) = (axis, self.linkage.sets[i]) else {
            return Err(part.wrong("it follows no drive", "links that each follow one"));
        };
        let body = flat.bodies[i];
        let com = axis.sign * (body.com - flat.roots[i]) * Vector::from_polar(1.0, -psi[k]);
        let reach = axis.places.iter().fold(0.0_f64, |most, s| most.max(*s));
        // The length of a link without pins beyond its root is unknown; its centre of mass gives an estimate.
        let length =
            if reach > ZERO_LENGTH_FRACTION * flat.size { reach } else { (2.0 * com.re.abs()).max(MIN_LENGTH_M) };
        let rounded = |x: f64| if x.abs() <= 1e-15 * flat.size { 0.0 } else { x };
        Ok(Link {
            name: names[i].clone(),
            drive: self.drive_name(k),
            attach,
            direction: if axis.sign < 0.0 { -1 } else { 1 },
            length: Length::Metres(length),
            mass: body.mass,
            inertia: body.inertia,
            inertia_along: 0.0,
            inertia_across: None,
            com: rounded(com.re),
            com_normal: rounded(com.im),
            axial: rounded(body.height),
            derived: DerivedNumbers::default(),
        })
    }

    /// Returns the names of the parts, without this program's prefix if they stay unique.
    fn names(&self) -> Vec<String> {
        let parts = &self.linkage.parts;
        let short = |name: &str| name.strip_prefix("link_").or(name.strip_prefix("link ")).unwrap_or(name).to_owned();
        let all: Vec<String> = parts.iter().map(|part| short(&part.name)).collect();
        let links: std::collections::BTreeSet<&String> = self.flat.links.iter().map(|i| &all[*i]).collect();
        match links.len() == self.flat.links.len() {
            true => all,
            false => made_unique(parts.iter().map(|part| part.name.clone()).collect()),
        }
    }

    fn drive_name(&self, k: usize) -> String {
        let motors = &self.linkage.motors;
        let short = |motor: &ImportedMotor| {
            let name = motor.name.as_str();
            name.strip_prefix("drive_").or(name.strip_prefix("drive ")).unwrap_or(name).to_owned()
        };
        let all: Vec<String> = motors.iter().map(short).collect();
        match all.iter().filter(|own| **own == all[k]).count() {
            1 => all[k].clone(),
            _ => made_unique(motors.iter().map(|motor| motor.name.clone()).collect())[k].clone(),
        }
    }

    fn drives(&mut self) -> Vec<Drive> {
        let motors = self.linkage.motors.iter().enumerate();
        for (k, motor) in motors.clone().filter(|(_, motor)| motor.armature > 0.0) {
            let name = self.drive_name(k);
            let (armature, inertia) =
                (ShortNumber(motor.armature), ShortNumber(motor.armature / ARMATURE_RATIO.powi(2)));
            self.notes.push(format!(
                "the armature of \"{0}\", {armature} kg m², became a rotor of {inertia} kg m² behind a gear of \
                 {ARMATURE_RATIO}, which adds next to nothing to the momentum: --set drive.{0}.rotor.inertia and .ratio \
                 set the real values",
                quote_clipped(&name)
            ));
        }
        let drive = |(k, motor): (usize, &ImportedMotor)| {
            let own = self.linkage.rotors.iter().find(|(_, of, _)| *of == k);
            let of_armature = Rotor { inertia: motor.armature / ARMATURE_RATIO.powi(2), ratio: ARMATURE_RATIO };
            let of_armature = (motor.armature > 0.0).then_some(of_armature);
            let rotor = own.map(|(i, _, ratio)| {
                let part = &self.linkage.parts[*i];
                let normal = self.flat.axes[2];
                Rotor { inertia: normal.dot(&(part.inertia * normal)), ratio: *ratio }
            });
            Drive {
                name: self.drive_name(k),
                on: motor.from.map(|from| self.drive_name(from)),
                rotor: rotor.or(of_armature),
                torque_limit: motor.torque_limit,
                speed_limit: motor.speed_limit,
                acceleration_limit: motor.acceleration_limit,
                jerk_limit: motor.jerk_limit,
            }
        };
        motors.map(drive).collect()
    }

    /// Converts the joint limits to limits of angles between drives.
    fn angles(&mut self, psi: &[f64]) -> Vec<Angle> {
        let mut angles: Vec<Angle> = Vec::new();
        for JointLimit { name, to, from, now, range } in &self.linkage.limits {
            let Some(from) = from else {
                self.notes.push(format!(
                    "limits of \"{}\" are left out: here only angles between two drives have limits",
                    quote_clipped(&self.linkage.motors[*to].name)
                ));
                continue;
            };
            let taken = |name: &String| angles.iter().any(|angle: &Angle| angle.name == *name);
            let own = name.clone().filter(|name| !taken(name));
            let name = own.or_else(|| (1..).map(|i| format!("a{i}")).find(|name| !taken(name)));
            angles.push(Angle {
                name: name.unwrap_or_default(),
                to: self.drive_name(*to),
                from: self.drive_name(*from),
                offset: now - (psi[*to] - psi[*from]),
                min: range.map(|[least, _]| least),
                max: range.map(|[_, most]| most),
            });
        }
        angles
    }
}

/// Makes names unique by adding numbers to repeated ones.
fn made_unique(names: Vec<String>) -> Vec<String> {
    let mut taken: std::collections::BTreeSet<String> = names.iter().cloned().collect();
    let mut seen = std::collections::BTreeSet::new();
    let mut unique = Vec::with_capacity(names.len());
    for name in names {
        let mut own = name.clone();
        if !seen.insert(name.clone()) {
            own = (2..).map(|n| format!("{name} {n}")).find(|own| !taken.contains(own)).unwrap_or(own);
            taken.insert(own.clone());
        }
        unique.push(own);
    }
    unique
}
