//! The machine of Fig. 2 as nine rigid bodies: the twin that the closed forms are compared with.
//!
//! Knows Newton, Euler and the drawing, none of the constants g, C, J into which the machine collapses.
//! [`NineBody::solve`] cuts every pin and solves for all pin forces and motor torques at once;
//! [`NineBody::recursive`] runs the generic recursion over the tree that is left when the three loops are cut.
//!
//! Symbols: `q` absolute drive angles (rad), `l_j` length, `l_cj` position of the CM along the link (m), B base point.
//! Arrays run over links 1..9. Link j lies along `±e(q_k)` from its attachment, k its drive, − for links 5, 8, 9.
//! All vectors are in the base frame.

use nalgebra::{Matrix3, SMatrix, SVector, Vector2, Vector3};

/// Link lengths, masses, inertias about each CM, CM positions; gravity; a payload.
#[derive(Clone, Copy, Debug)]
pub struct NineBody {
    /// m; l_4 = l_6 = l_1, l_7 = l_3, l_8 = l_5, or the parallelograms do not close
    pub length: [f64; 9],
    /// kg
    pub mass: [f64; 9],
    /// kg m², each about the link's own CM
    pub inertia: [f64; 9],
    /// m, signed, along the link from its attachment
    pub com: [f64; 9],
    /// m/s²
    pub gravity: [f64; 2],
    /// kg, a point at the end effector, rigid on link 9
    pub payload: f64,
}

/// What one state of motion asks of motors, pins and base.
#[derive(Clone, Debug)]
pub struct Answer {
    /// N m, motor k on link k
    pub torque: [f64; 3],
    /// N, transmitted to the base, gravity included
    pub base_force: [f64; 2],
    /// N m about B, transmitted to the base
    pub base_moment: f64,
    /// N, in the order of [`NineBody::pins`]: what `from` exerts on `to`
    pub pins: Vec<[f64; 2]>,
    /// m, of links and payload
    pub com: [f64; 2],
    /// kg m²/s about B
    pub angular_momentum: f64,
    /// kg m/s
    pub linear_momentum: [f64; 2],
    /// m
    pub end_effector: [f64; 2],
}

/// A revolute joint: point `at.0` along `from` (`None`: B) is point `at.1` along `to`.
#[derive(Clone, Copy, Debug)]
pub struct Pin {
    pub from: Option<usize>,
    pub to: usize,
    /// m along each link from its attachment
    pub at: (f64, f64),
}

/// The drive whose orientation each link has, and the sense along it.
pub const DRIVE: [usize; 9] = [0, 1, 2, 0, 1, 0, 2, 1, 2];
const SENSE: [f64; 9] = [1.0, 1.0, 1.0, 1.0, -1.0, 1.0, 1.0, -1.0, -1.0];
/// The link at whose tip each link is attached. Parents come first.
const PARENT: [Option<usize>; 9] = [None, None, None, Some(1), Some(0), Some(2), Some(0), Some(6), Some(4)];

/// Position, velocity and acceleration of a point.
#[derive(Clone, Copy, Debug)]
struct Point {
    r: Vector2<f64>,
    v: Vector2<f64>,
    a: Vector2<f64>,
}

/// Motion of a link: its attachment, its direction, its rates.
#[derive(Clone, Copy, Debug)]
struct Link {
    attachment: Point,
    along: Vector2<f64>,
    omega: f64,
    alpha: f64,
}

impl Link {
    /// The point `s` metres along the link, with its derivatives.
    fn point(&self, s: f64) -> Point {
        let (u, across) = (self.along, Vector2::new(-self.along.y, self.along.x));
        Point {
            r: self.attachment.r + s * u,
            v: self.attachment.v + s * self.omega * across,
            a: self.attachment.a + s * (self.alpha * across - self.omega * self.omega * u),
        }
    }
}

/// A lump of mass: the links' own, and the payload with no inertia of its own.
#[derive(Clone, Copy, Debug)]
struct Lump {
    link: usize,
    mass: f64,
    inertia: f64,
    point: Point,
}

impl NineBody {
    /// All 12 pins: the base's, the tree's, then the three that close the parallelograms.
    ///
    /// Where three links share an axle, two pins stand for it (1-5 and 1-7; 6-7 and 7-8).
    /// 9 bodies x 3 equations = 12 pins x 2 + 3 motors.
    pub fn pins(&self) -> [Pin; 12] {
        let l = &self.length;
        let pin = |from, to, s, t| Pin { from, to, at: (s, t) };
        [
            pin(None, 0, 0.0, 0.0),
            pin(None, 1, 0.0, 0.0),
            pin(None, 2, 0.0, 0.0),
            pin(Some(1), 3, l[1], 0.0),
            pin(Some(0), 4, l[0], 0.0),
            pin(Some(2), 5, l[2], 0.0),
            pin(Some(0), 6, l[0], 0.0),
            pin(Some(6), 7, l[6], 0.0),
            pin(Some(4), 8, l[4], 0.0),
            pin(Some(3), 4, l[3], -l[1]),
            pin(Some(5), 6, l[5], l[6]),
            pin(Some(7), 8, l[7], -l[2]),
        ]
    }

    /// Positions, velocities, accelerations, each link's from its parent's.
    fn links(&self, q: [f64; 3], qd: [f64; 3], qdd: [f64; 3]) -> [Link; 9] {
        let zero = Vector2::zeros();
        let base = Link { attachment: Point { r: zero, v: zero, a: zero }, along: zero, omega: 0.0, alpha: 0.0 };
        let mut links = [base; 9];
        for j in 0..9 {
            let k = DRIVE[j];
            let attachment = PARENT[j].map_or(base.attachment, |p| links[p].point(self.length[p]));
            let along = SENSE[j] * Vector2::new(q[k].cos(), q[k].sin());
            links[j] = Link { attachment, along, omega: qd[k], alpha: qdd[k] };
        }
        links
    }

    fn lumps(&self, links: &[Link; 9]) -> [Lump; 10] {
        std::array::from_fn(|i| match links.get(i) {
            Some(link) => {
                Lump { link: i, mass: self.mass[i], inertia: self.inertia[i], point: link.point(self.com[i]) }
            }
            None => Lump { link: 8, mass: self.payload, inertia: 0.0, point: links[8].point(self.length[8]) },
        })
    }

    /// Motor torques, all pin forces, base wrench and momenta of a state of motion.
    ///
    /// Panics at a change point (sin(q_k − q_l) = 0), where the pin forces are not finite.
    pub fn solve(&self, q: [f64; 3], qd: [f64; 3], qdd: [f64; 3]) -> Answer {
        self.solve_rubbing(q, qd, qdd, [0.0; 12])
    }

    /// The same with a couple in each pin, N m: −couple on `to`, +couple on `from`, which may be the base.
    pub fn solve_rubbing(&self, q: [f64; 3], qd: [f64; 3], qdd: [f64; 3], couples: [f64; 12]) -> Answer {
        let gravity = Vector2::from(self.gravity);
        let links = self.links(q, qd, qdd);
        let lumps = self.lumps(&links);
        let pins = self.pins();

        // Rows 3j..3j+3: force and moment about the CM of link j. Columns: pin forces, then motor torques.
        let mut a = SMatrix::<f64, 27, 27>::zeros();
        let mut b = SVector::<f64, 27>::zeros();
        let cm: [Vector2<f64>; 9] = std::array::from_fn(|j| lumps[j].point.r);
        for (i, pin) in pins.iter().enumerate() {
            let mut act = |j: usize, at: f64, sign: f64| {
                let arm = links[j].point(at).r - cm[j];
                a[(3 * j, 2 * i)] = sign;
                a[(3 * j + 1, 2 * i + 1)] = sign;
                a[(3 * j + 2, 2 * i)] = -sign * arm.y;
                a[(3 * j + 2, 2 * i + 1)] = sign * arm.x;
            };
            act(pin.to, pin.at.1, 1.0);
            if let Some(from) = pin.from {
                act(from, pin.at.0, -1.0);
            }
        }
        for k in 0..3 {
            a[(3 * k + 2, 24 + k)] = 1.0;
        }
        for lump in &lumps {
            let j = lump.link;
            let force = lump.mass * (lump.point.a - gravity);
            b[3 * j] += force.x;
            b[3 * j + 1] += force.y;
            b[3 * j + 2] += lump.inertia * links[j].alpha + (lump.point.r - cm[j]).perp(&force);
        }
        for (pin, couple) in pins.iter().zip(couples) {
            b[3 * pin.to + 2] += couple;
            if let Some(from) = pin.from {
                b[3 * from + 2] -= couple;
            }
        }
        let x = a.lu().solve(&b).expect("the linkage is off its change points");

        let force = |i: usize| Vector2::new(x[2 * i], x[2 * i + 1]);
        let torque = [x[24], x[25], x[26]];
        // Reactions on the base: of its three pins, and of the motors.
        let (mut base_force, mut base_moment) = (Vector2::zeros(), 0.0);
        for (i, pin) in pins.iter().enumerate().filter(|(_, pin)| pin.from.is_none()) {
            base_force -= force(i);
            base_moment -= links[pin.to].point(pin.at.1).r.perp(&force(i)) + torque[pin.to] - couples[i];
        }
        let total: f64 = lumps.iter().map(|p| p.mass).sum();
        let moment: Vector2<f64> = lumps.iter().map(|p| p.mass * p.point.r).sum();
        let momentum: Vector2<f64> = lumps.iter().map(|p| p.mass * p.point.v).sum();
        let spin = |p: &Lump| p.inertia * links[p.link].omega + p.mass * p.point.r.perp(&p.point.v);
        Answer {
            torque,
            base_force: base_force.into(),
            base_moment,
            pins: (0..12).map(|i| force(i).into()).collect(),
            com: (moment / total).into(),
            angular_momentum: lumps.iter().map(spin).sum(),
            linear_momentum: momentum.into(),
            end_effector: lumps[9].point.r.into(),
        }
    }

    /// End effector and centre of mass, m, from B.
    pub fn places(&self, q: [f64; 3]) -> [[f64; 2]; 2] {
        let lumps = self.lumps(&self.links(q, [0.0; 3], [0.0; 3]));
        let total: f64 = lumps.iter().map(|p| p.mass).sum();
        let com: Vector2<f64> = lumps.iter().map(|p| p.mass / total * p.point.r).sum();
        [lumps[9].point.r.into(), com.into()]
    }

    /// m (g − a) of every link and of the payload, N: what each does to all that holds it.
    pub fn pulls(&self, q: [f64; 3], qd: [f64; 3], qdd: [f64; 3]) -> [[f64; 2]; 10] {
        let gravity = Vector2::from(self.gravity);
        self.lumps(&self.links(q, qd, qdd)).map(|lump| (lump.mass * (gravity - lump.point.a)).into())
    }

    /// Generic recursive Newton–Euler: `(torque, [f_x, f_y, n_B])`, the wrench transmitted to the base.
    ///
    /// The closing pins are cut; their forces do no work, so projecting the tree's joint torques on the three
    /// drives is exact. Finite at change points too. Allocates nothing.
    pub fn recursive(&self, q: [f64; 3], qd: [f64; 3], qdd: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let gravity = Vector2::from(self.gravity);
        let links = self.links(q, qd, qdd);
        // What each link asks of its attachment: force, and moment about it.
        let mut force = [Vector2::zeros(); 9];
        let mut moment = [0.0; 9];
        for lump in &self.lumps(&links) {
            let (j, f) = (lump.link, lump.mass * (lump.point.a - gravity));
            force[j] += f;
            moment[j] += lump.inertia * links[j].alpha + (lump.point.r - links[j].attachment.r).perp(&f);
        }
        let mut torque = [0.0; 3];
        let mut wrench = [0.0; 3];
        for j in (0..9).rev() {
            let (f, n) = (force[j], moment[j]);
            torque[DRIVE[j]] += n;
            if let Some(p) = PARENT[j] {
                // A joint torque works on the relative rate ω_j − ω_p.
                torque[DRIVE[p]] -= n;
                force[p] += f;
                moment[p] += n + (links[j].attachment.r - links[p].attachment.r).perp(&f);
            } else {
                wrench[0] -= f.x;
                wrench[1] -= f.y;
                wrench[2] -= n;
            }
        }
        (torque, wrench)
    }

    /// Mass matrix H (3x3, kg m²), column k from unit acceleration of drive k at rest without gravity.
    pub fn mass_matrix(&self, q: [f64; 3]) -> Matrix3<f64> {
        let weightless = Self { gravity: [0.0; 2], ..*self };
        let column = |k: usize| {
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            Vector3::from(weightless.recursive(q, [0.0; 3], unit).0)
        };
        Matrix3::from_columns(&[column(0), column(1), column(2)])
    }

    /// Accelerations (rad/s²) that motor torques (N m) cause: H q̈ = τ − bias.
    pub fn forward(&self, q: [f64; 3], qd: [f64; 3], torque: [f64; 3]) -> [f64; 3] {
        let bias = Vector3::from(self.recursive(q, qd, [0.0; 3]).0);
        let lu = self.mass_matrix(q).lu();
        lu.solve(&(Vector3::from(torque) - bias)).expect("H is positive definite").into()
    }

    /// Kinetic plus potential energy (J); potential zero at B.
    pub fn energy(&self, q: [f64; 3], qd: [f64; 3]) -> f64 {
        let links = self.links(q, qd, [0.0; 3]);
        let gravity = Vector2::from(self.gravity);
        let of = |p: &Lump| {
            let omega = links[p.link].omega;
            0.5 * (p.mass * p.point.v.norm_squared() + p.inertia * omega * omega) - p.mass * gravity.dot(&p.point.r)
        };
        self.lumps(&links).iter().map(of).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// A state of motion of a machine, and its reference answers.
    struct Sample {
        name: String,
        machine: NineBody,
        q: [f64; 3],
        qd: [f64; 3],
        qdd: [f64; 3],
        want: Value,
    }

    fn numbers(v: &Value) -> Vec<f64> {
        match v {
            Value::Array(items) => items.iter().flat_map(numbers).collect(),
            v => vec![v.as_f64().expect("a number")],
        }
    }

    fn array<const N: usize>(v: &Value) -> [f64; N] {
        numbers(v).try_into().expect("the length of the array")
    }

    fn samples() -> Vec<Sample> {
        let file: Value = serde_json::from_str(include_str!("../reference/dynamics.json")).expect("valid JSON");
        let mut samples = Vec::new();
        for case in file["cases"].as_array().expect("cases") {
            let machine = NineBody {
                length: array(&case["length"]),
                mass: array(&case["mass"]),
                inertia: array(&case["inertia"]),
                com: array(&case["com"]),
                gravity: array(&case["gravity"]),
                payload: case["payload"].as_f64().expect("a payload"),
            };
            for (i, want) in case["samples"].as_array().expect("samples").iter().enumerate() {
                samples.push(Sample {
                    name: format!("{}, state {i}", case["name"]),
                    machine,
                    q: array(&want["q"]),
                    qd: array(&want["qd"]),
                    qdd: array(&want["qdd"]),
                    want: want.clone(),
                });
            }
        }
        assert_eq!(samples.len(), 36);
        samples
    }

    /// Largest error over max(1e-3, largest wanted) stays below `tolerance`.
    fn close(what: &str, got: &[f64], want: &[f64], tolerance: f64) {
        assert_eq!(got.len(), want.len(), "{what}");
        let scale = want.iter().fold(1e-3_f64, |m, w| m.max(w.abs()));
        for (g, w) in got.iter().zip(want) {
            let error = (g - w).abs() / scale;
            // Written so that NaN fails.
            assert!(error <= tolerance, "{what}: got {got:?}, want {want:?}, error {error:e}");
        }
    }

    /// The sample's motion, `t` seconds on at constant acceleration.
    fn at(s: &Sample, t: f64) -> ([f64; 3], [f64; 3]) {
        let q = std::array::from_fn(|k| s.q[k] + s.qd[k] * t + 0.5 * s.qdd[k] * t * t);
        (q, std::array::from_fn(|k| s.qd[k] + s.qdd[k] * t))
    }

    /// d/dt at the sample by central differences of fourth order, step 2e-4 s.
    fn rate<const N: usize>(s: &Sample, f: impl Fn([f64; 3], [f64; 3]) -> [f64; N]) -> [f64; N] {
        let h = 2e-4;
        let [far_back, back, on, far_on] = [-2.0, -1.0, 1.0, 2.0].map(|n| {
            let (q, qd) = at(s, n * h);
            f(q, qd)
        });
        std::array::from_fn(|i| (8.0 * (on[i] - back[i]) - (far_on[i] - far_back[i])) / (12.0 * h))
    }

    #[test]
    fn pins_hold_in_position_velocity_and_acceleration() {
        for s in samples() {
            let links = s.machine.links(s.q, s.qd, s.qdd);
            for pin in s.machine.pins() {
                let to = links[pin.to].point(pin.at.1);
                let zero = Vector2::zeros();
                let from = pin.from.map_or(Point { r: zero, v: zero, a: zero }, |j| links[j].point(pin.at.0));
                let gap = (to.r - from.r).norm() + (to.v - from.v).norm() + (to.a - from.a).norm();
                assert!(gap < 1e-13 * (1.0 + to.a.norm()), "{}: {pin:?} opens by {gap:e}", s.name);
            }
        }
    }

    /// The state nearest a change point has min |sin(q_k − q_l)| = 0.011; none needs a looser tolerance.
    #[test]
    fn solve_matches_reference() {
        for s in samples() {
            let got = s.machine.solve(s.q, s.qd, s.qdd);
            let check = |field: &str, got: &[f64]| {
                close(&format!("{}, {field}", s.name), got, &numbers(&s.want[field]), 1e-9);
            };
            check("torque", &got.torque);
            check("base_force", &got.base_force);
            check("base_moment", &[got.base_moment]);
            check("com", &got.com);
            check("angular_momentum_about_base", &[got.angular_momentum]);
            let weightless = NineBody { gravity: [0.0; 2], ..s.machine };
            let column = |k: usize| weightless.solve(s.q, [0.0; 3], std::array::from_fn(|i| f64::from(i == k))).torque;
            check("mass_matrix", &[0, 1, 2].map(column).concat());
        }
    }

    #[test]
    fn recursive_matches_reference() {
        for s in samples() {
            let (torque, wrench) = s.machine.recursive(s.q, s.qd, s.qdd);
            let check = |field: &str, got: &[f64]| {
                close(&format!("{}, {field}", s.name), got, &numbers(&s.want[field]), 1e-9);
            };
            check("torque", &torque);
            check("base_force", &wrench[..2]);
            check("base_moment", &wrench[2..]);
            check("mass_matrix", s.machine.mass_matrix(s.q).as_slice());
        }
    }

    /// n_B = −Στ. `solve` sums it from the motors' reactions, so only the recursion's moment can break it.
    #[test]
    fn base_moment_is_minus_the_sum_of_torques() {
        for s in samples() {
            let (torque, wrench) = s.machine.recursive(s.q, s.qd, s.qdd);
            let explicit: f64 = s.machine.solve(s.q, s.qd, s.qdd).torque.iter().sum();
            let scale = 1.0 + torque.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
            for sum in [torque.iter().sum(), explicit] {
                assert!((wrench[2] + sum).abs() <= 1e-11 * scale, "{}: {} and {sum}", s.name, wrench[2]);
            }
        }
    }

    /// f_B = M g − dp/dt and n_B = r_CM × M g − dL/dt.
    #[test]
    fn base_wrench_is_weight_less_rate_of_momentum() {
        for s in samples() {
            let got = s.machine.solve(s.q, s.qd, s.qdd);
            let [px, py, l] = rate(&s, |q, qd| {
                let there = s.machine.solve(q, qd, [0.0; 3]);
                let [px, py] = there.linear_momentum;
                [px, py, there.angular_momentum]
            });
            let weight = (s.machine.mass.iter().sum::<f64>() + s.machine.payload) * Vector2::from(s.machine.gravity);
            let weight_moment = Vector2::from(got.com).perp(&weight);
            // Differences carry rounding of 1e-16/h, and of the fourth order in h.
            let force = [weight.x - px, weight.y - py];
            close(&format!("{}, base force", s.name), &got.base_force, &force, 2e-8);
            close(&format!("{}, base moment", s.name), &[got.base_moment], &[weight_moment - l], 2e-8);
        }
    }

    /// Linear momentum is M times the rate of the CM.
    #[test]
    fn momentum_is_mass_times_rate_of_com() {
        for s in samples() {
            let mass = s.machine.mass.iter().sum::<f64>() + s.machine.payload;
            let want = rate(&s, |q, qd| s.machine.solve(q, qd, [0.0; 3]).com).map(|v| mass * v);
            let got = s.machine.solve(s.q, s.qd, s.qdd).linear_momentum;
            close(&s.name, &got, &want, 2e-8);
        }
    }

    /// The motors' power is the rate of energy: the pins do no work.
    #[test]
    fn power_is_rate_of_energy() {
        for s in samples() {
            let torque = s.machine.solve(s.q, s.qd, s.qdd).torque;
            let power: f64 = (0..3).map(|k| torque[k] * s.qd[k]).sum();
            let [want] = rate(&s, |q, qd| [s.machine.energy(q, qd)]);
            close(&s.name, &[power], &[want], 2e-8);
        }
    }

    #[test]
    fn forward_undoes_solve() {
        for s in samples() {
            let torque = s.machine.solve(s.q, s.qd, s.qdd).torque;
            close(&s.name, &s.machine.forward(s.q, s.qd, torque), &s.qdd, 1e-9);
        }
    }

    /// End effector of (14).
    #[test]
    fn end_effector_is_three_links_away() {
        for s in samples() {
            let l = &s.machine.length;
            let e = |k: usize| Vector2::new(s.q[k].cos(), s.q[k].sin());
            let want = l[0] * e(0) - l[4] * e(1) - l[8] * e(2);
            close(&s.name, &s.machine.solve(s.q, s.qd, s.qdd).end_effector, want.as_slice(), 1e-14);
        }
    }

    /// Near the change point q_3 = q_1 pin forces grow like 1/|q_3 − q_1|; torques stay those of the recursion.
    #[test]
    fn pin_forces_grow_towards_a_change_point() {
        let s = &samples()[6];
        let state = |gap: f64| [s.q[0], s.q[1], s.q[0] + gap];
        let peak = |gap: f64| {
            let answer = s.machine.solve(state(gap), s.qd, s.qdd);
            // The conditioning grows like 1/gap, and so may the error.
            let torque = s.machine.recursive(state(gap), s.qd, s.qdd).0;
            close("torque", &answer.torque, &torque, 1e-12 / gap);
            answer.pins.iter().map(|f| f[0].hypot(f[1])).fold(0.0, f64::max)
        };
        for gap in [1e-3, 1e-4, 1e-5] {
            let ratio = peak(0.1 * gap) / peak(gap);
            assert!((ratio - 10.0).abs() < 0.5, "peak pin force grew {ratio} times, not 10, at {gap}");
        }
    }
}
