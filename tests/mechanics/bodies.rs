//! A twin of any machine of the family: its bodies one by one, rotors as bodies of their own, and Lagrange's equations by
//! numeric differentiation. It reads the description alone and shares no formula with the library.

use stillbase::mechanics::machine::{Attach, Length, LinkPoint, MachineSpec, PlaceOnLink};
use stillbase::mechanics::planar::{Vector, cross, dot, unit};

/// A rigid body: its centre is Σ w e(q_k), it turns at Σ r q̇_k.
struct Body {
    mass: f64,
    inertia: f64,
    centre: Vec<Vector>,
    turns: Vec<f64>,
}

pub struct Bodies {
    n: usize,
    all: Vec<Body>,
    tip: Vec<Vector>,
    gravity: Vector,
    /// What the stator of each motor sits on.
    on: Vec<Option<usize>>,
}

impl Bodies {
    pub fn of(spec: &MachineSpec) -> Self {
        let n = spec.drives.len();
        let drive = |name: &str| spec.drives.iter().position(|d| d.name == name).expect("a drive");
        let mut all = Vec::new();
        for link in &spec.links {
            let k = drive(&link.drive);
            let mut centre = root(spec, &link.name);
            centre[k] += f64::from(link.direction) * Vector::new(link.com, link.com_normal);
            let mut turns = vec![0.0; n];
            turns[k] = 1.0;
            all.push(Body { mass: link.mass, inertia: link.inertia, centre, turns });
        }
        for weight in &spec.counterweights {
            let link = spec.links.iter().find(|l| l.name == weight.link).expect("a link");
            let k = drive(&link.drive);
            let mut centre = root(spec, &link.name);
            centre[k] += f64::from(link.direction) * Vector::new(weight.at, 0.0);
            let mut turns = vec![0.0; n];
            turns[k] = 1.0;
            let inertia = 0.5 * weight.mass * weight.radius * weight.radius;
            all.push(Body { mass: weight.mass, inertia, centre, turns });
        }
        let end = spec.end_effector.as_ref().expect("an end effector");
        let tip = point(spec, end);
        if spec.payload.mass > 0.0 {
            let link = spec.links.iter().find(|l| l.name == end.link).expect("a link");
            let k = drive(&link.drive);
            let mut centre = tip.clone();
            centre[k] += f64::from(link.direction) * Vector::new(spec.payload.offset[0], spec.payload.offset[1]);
            let mut turns = vec![0.0; n];
            turns[k] = 1.0;
            all.push(Body { mass: spec.payload.mass, inertia: spec.payload.inertia, centre, turns });
        }
        let on: Vec<Option<usize>> = spec.drives.iter().map(|d| d.on.as_deref().map(drive)).collect();
        for (k, d) in spec.drives.iter().enumerate() {
            let Some(rotor) = d.rotor else { continue };
            // Its stator turns with what carries it, the rotor `ratio` times as fast as the drive does against that.
            let mut turns = vec![0.0; n];
            turns[k] = rotor.ratio;
            if let Some(on) = on[k] {
                turns[on] = turns[on] - rotor.ratio + 1.0;
            }
            all.push(Body { mass: 0.0, inertia: rotor.inertia, centre: vec![Vector::default(); n], turns });
        }
        Self { n, all, tip, gravity: Vector::new(spec.gravity[0], spec.gravity[1]), on }
    }

    pub fn tip(&self, q: &[f64]) -> Vector {
        sum(&self.tip, q)
    }

    pub fn com(&self, q: &[f64]) -> Vector {
        let mass: f64 = self.all.iter().map(|b| b.mass).sum();
        self.all.iter().map(|b| b.mass * sum(&b.centre, q)).sum::<Vector>() / mass
    }

    fn kinetic(&self, q: &[f64], qd: &[f64]) -> f64 {
        let of = |b: &Body| {
            let v = rate(&b.centre, q, qd);
            0.5 * b.mass * dot(v, v) + 0.5 * b.inertia * turning(b, qd).powi(2)
        };
        self.all.iter().map(of).sum()
    }

    fn potential(&self, q: &[f64]) -> f64 {
        -self.all.iter().map(|b| b.mass * dot(self.gravity, sum(&b.centre, q))).sum::<f64>()
    }

    pub fn linear(&self, q: &[f64], qd: &[f64]) -> Vector {
        self.all.iter().map(|b| b.mass * rate(&b.centre, q, qd)).sum()
    }

    /// About B.
    pub fn angular(&self, q: &[f64], qd: &[f64]) -> f64 {
        let of = |b: &Body| cross(sum(&b.centre, q), b.mass * rate(&b.centre, q, qd)) + b.inertia * turning(b, qd);
        self.all.iter().map(of).sum()
    }

    /// ∂T/∂q̇: T is of second degree, so this difference is exact.
    pub fn momenta(&self, q: &[f64], qd: &[f64]) -> Vec<f64> {
        let with = |k: usize, by: f64| {
            let mut qd = qd.to_vec();
            qd[k] += by;
            self.kinetic(q, &qd)
        };
        (0..self.n).map(|k| 0.5 * (with(k, 1.0) - with(k, -1.0))).collect()
    }

    /// Row by row.
    pub fn mass_matrix(&self, q: &[f64]) -> Vec<f64> {
        let unit = |k: usize| (0..self.n).map(|l| if l == k { 1.0 } else { 0.0 }).collect::<Vec<_>>();
        (0..self.n).flat_map(|k| self.momenta(q, &unit(k))).collect()
    }

    /// What the motors give, by d/dt ∂T/∂q̇ − ∂(T − U)/∂q = Aᵀ m: each turns its drive against what carries it.
    pub fn torques(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> Vec<f64> {
        let momenta = |t: f64| {
            let (q, qd) = after(q, qd, qdd, t);
            self.momenta(&q, &qd)
        };
        let rates = difference(momenta);
        let mut wanted: Vec<f64> = (0..self.n)
            .map(|k| {
                let l = |by: f64| {
                    let mut q = q.to_vec();
                    q[k] += by;
                    vec![self.kinetic(&q, qd) - self.potential(&q)]
                };
                rates[k] - difference(l)[0]
            })
            .collect();
        // m_k = τ_k + Σ m_l over all that k carries: from the outermost inwards.
        let depth = |k: usize| std::iter::successors(Some(k), |k| self.on[*k]).count();
        let mut order: Vec<usize> = (0..self.n).collect();
        order.sort_by_key(|k| std::cmp::Reverse(depth(*k)));
        for k in order {
            if let Some(on) = self.on[k] {
                wanted[on] += wanted[k];
            }
        }
        wanted
    }

    /// f_B and n_B: weight less the rates of momentum.
    pub fn wrench(&self, q: &[f64], qd: &[f64], qdd: &[f64]) -> (Vector, f64) {
        let momenta = |t: f64| {
            let (q, qd) = after(q, qd, qdd, t);
            let p = self.linear(&q, &qd);
            vec![p.re, p.im, self.angular(&q, &qd)]
        };
        let rates = difference(momenta);
        let weight: Vector = self.all.iter().map(|b| b.mass * self.gravity).sum();
        let moment: f64 = self.all.iter().map(|b| cross(sum(&b.centre, q), b.mass * self.gravity)).sum();
        (weight - Vector::new(rates[0], rates[1]), moment - rates[2])
    }
}

fn after(q: &[f64], qd: &[f64], qdd: &[f64], t: f64) -> (Vec<f64>, Vec<f64>) {
    let n = q.len();
    ((0..n).map(|k| q[k] + t * qd[k] + 0.5 * t * t * qdd[k]).collect(), (0..n).map(|k| qd[k] + t * qdd[k]).collect())
}

/// A derivative at 0, of sixth order.
fn difference(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let h = 2e-3;
    let [a, b, c] = [1.0, 2.0, 3.0].map(|i| {
        let (on, back) = (f(i * h), f(-i * h));
        on.iter().zip(&back).map(|(x, y)| x - y).collect::<Vec<f64>>()
    });
    (0..a.len()).map(|i| (45.0 * a[i] - 9.0 * b[i] + c[i]) / (60.0 * h)).collect()
}

fn sum(weights: &[Vector], q: &[f64]) -> Vector {
    weights.iter().zip(q).map(|(w, q)| w * unit(*q)).sum()
}

fn rate(weights: &[Vector], q: &[f64], qd: &[f64]) -> Vector {
    let i = Vector::new(0.0, 1.0);
    weights.iter().zip(q.iter().zip(qd)).map(|(w, (q, qd))| i * w * unit(*q) * *qd).sum()
}

fn turning(body: &Body, qd: &[f64]) -> f64 {
    body.turns.iter().zip(qd).map(|(r, qd)| r * qd).sum()
}

/// Where a link begins, by walking down to the base.
fn root(spec: &MachineSpec, name: &str) -> Vec<Vector> {
    let link = spec.links.iter().find(|l| l.name == name).expect("a link");
    match &link.attach {
        Attach::Base(_) => vec![Vector::default(); spec.drives.len()],
        Attach::On(at) => point(spec, at),
    }
}

pub fn point(spec: &MachineSpec, at: &LinkPoint) -> Vec<Vector> {
    let link = spec.links.iter().find(|l| l.name == at.link).expect("a link");
    let length = |l: &Length| match l {
        Length::Metres(m) => *m,
        Length::Named(name) => spec.lengths[name],
    };
    let along = match &at.at {
        PlaceOnLink::Metres(s) => *s,
        PlaceOnLink::Named(word) => match word.as_str() {
            "tip" => length(&link.length),
            "root" => 0.0,
            word => word.strip_prefix('-').map_or_else(|| spec.lengths[word], |name| -spec.lengths[name]),
        },
    };
    let mut place = root(spec, &link.name);
    let k = spec.drives.iter().position(|d| d.name == link.drive).expect("a drive");
    place[k] += Vector::new(f64::from(link.direction) * along, 0.0);
    place
}
