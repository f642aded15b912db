//! The collapsed constants g, C, J against independent software, against nine rigid bodies, and against the laws.

use proptest::prelude::*;
use stillbase::mechanics::dynamics::{
    ExternalLoads, angular_momentum, base_wrench, centre_of_mass, energy, first_moment, forward, inverse,
    inverse_with_wrench, linear_momentum, mass_matrix,
};
use stillbase::mechanics::kinematics::{end_effector, least_transmission, velocity};
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, UnitVectors, Vector, cross, dot};

use crate::mechanics::nine_body::NineBody;
use crate::support::{State, angles, any_body, array, body_of, close, dynamics, machine_of, numbers, three, xy};

impl State {
    fn e(&self) -> UnitVectors {
        self.q.units()
    }

    /// `t` seconds on at constant acceleration.
    fn after(&self, t: f64) -> Self {
        let q = self.q.0.plus(t, &self.qd).plus(0.5 * t * t, &self.qdd);
        Self { q: DriveAngles(q), qd: self.qd.plus(t, &self.qdd), qdd: self.qdd }
    }

    /// d/dt along the motion by central differences of fourth order.
    fn rate<const N: usize>(&self, f: impl Fn(&Self) -> [f64; N]) -> [f64; N] {
        let h = 2e-4;
        let [far_back, back, on, far_on] = [-2.0, -1.0, 1.0, 2.0].map(|n| f(&self.after(n * h)));
        std::array::from_fn(|i| (8.0 * (on[i] - back[i]) - (far_on[i] - far_back[i])) / (12.0 * h))
    }
}

fn around(machine: &Machine) -> ExternalLoads {
    ExternalLoads { gravity: machine.gravity(), force: Vector::default() }
}

fn matrix(inertia: &Inertia, s: &State) -> Vec<f64> {
    let (h, _) = mass_matrix(inertia, &s.e(), &s.qd);
    (0..9).map(|i| h.get(i / 3, i % 3)).collect()
}

/// The 36 reference states, each with its machine made by keys from Table I.
#[test]
fn reference_states_to_nine_digits() {
    let file = dynamics();
    let mut states = 0;
    for case in file["cases"].as_array().expect("cases") {
        let machine = machine_of(&NineBody {
            length: array(&case["length"]),
            mass: array(&case["mass"]),
            inertia: array(&case["inertia"]),
            com: array(&case["com"]),
            gravity: array(&case["gravity"]),
            payload: case["payload"].as_f64().expect("a payload"),
        });
        let inertia = Inertia::of(&machine);
        for (i, want) in case["samples"].as_array().expect("samples").iter().enumerate() {
            let s = State::new(array(&want["q"]), array(&want["qd"]), array(&want["qdd"]));
            let (torque, wrench) = inverse_with_wrench(&inertia, &s.e(), &s.qd, &s.qdd, &around(&machine));
            let check = |field: &str, got: &[f64]| {
                close(&format!("{}, state {i}, {field}", case["name"]), got, &numbers(&want[field]), 1e-9);
            };
            check("torque", &torque);
            check("base_force", &xy(wrench.total().force));
            check("base_moment", &[wrench.total().moment]);
            check("mass_matrix", &matrix(&inertia, &s));
            check("com", &xy(centre_of_mass(&inertia, &s.e())));
            check("angular_momentum_about_base", &[angular_momentum(&inertia, &s.e(), &s.qd)]);
            states += 1;
        }
    }
    assert_eq!(states, 36);
}

/// Any state with min |sin(q_k − q_l)| above 0.05: nearer to a change point it is the twin that is ill-conditioned.
fn any_state() -> impl Strategy<Value = State> {
    let three = |x: f64| prop::array::uniform3(-x..x);
    (three(6.0), three(4.0), three(12.0))
        .prop_map(|(q, qd, qdd)| State::new(q, qd, qdd))
        .prop_filter("near a change point", |s| least_transmission(&s.e(), 3) > 0.05)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Torque, wrench, centre of mass, momenta, energy, mass matrix and forward dynamics of nine rigid bodies.
    #[test]
    fn constants_equal_nine_bodies(body in any_body(), s in any_state()) {
        let machine = machine_of(&body);
        let (inertia, around, e) = (Inertia::of(&machine), around(&machine), s.e());
        let (q, qd, qdd) = (angles(&s.q), three(&s.qd), three(&s.qdd));
        let twin = body.solve(q, qd, qdd);
        let (torque, wrench) = inverse_with_wrench(&inertia, &e, &s.qd, &s.qdd, &around);
        close("torque", &torque, &twin.torque, 1e-9);
        close("torque alone", &inverse(&inertia, &e, &s.qd, &s.qdd, &around), &torque, 1e-14);
        close("base force", &xy(wrench.total().force), &twin.base_force, 1e-9);
        close("base moment", &[wrench.total().moment], &[twin.base_moment], 1e-9);
        prop_assert_eq!(base_wrench(&inertia, &e, &s.qd, &s.qdd, &around), wrench);
        close("centre of mass", &xy(centre_of_mass(&inertia, &e)), &twin.com, 1e-11);
        close("momentum", &xy(linear_momentum(&inertia, &e, &s.qd)), &twin.linear_momentum, 1e-11);
        close("angular momentum", &[angular_momentum(&inertia, &e, &s.qd)], &[twin.angular_momentum], 1e-11);
        close("end effector", &xy(end_effector(machine.end_effector(), &e)), &twin.end_effector, 1e-13);
        let (kinetic, potential) = energy(&inertia, &e, &s.qd, machine.gravity());
        close("energy", &[kinetic + potential], &[body.energy(q, qd)], 1e-11);
        close("mass matrix", &matrix(&inertia, &s), body.mass_matrix(q).as_slice(), 1e-11);
        let accelerations = forward(&inertia, &e, &s.qd, &torque, &around);
        close("forward of inverse", &accelerations, &s.qdd, 1e-8);
        close("forward of the twin", &accelerations, &body.forward(q, qd, three(&torque)), 1e-8);
    }

    /// (A1) and (A3) written out.
    #[test]
    fn closed_forms_of_the_appendix(body in any_body(), s in any_state()) {
        let body = NineBody { payload: 0.0, ..body };
        let inertia = Inertia::of(&machine_of(&body));
        let NineBody { length: l, mass: m, inertia: i, com: c, .. } = body;
        let [l1, l2, l3, _, l5, _, l7, _, _] = l;
        let [m1, m2, m3, m4, m5, m6, m7, m8, m9] = m;
        let [i1, i2, i3, i4, i5, i6, i7, i8, i9] = i;
        let [c1, c2, c3, c4, c5, c6, c7, c8, c9] = c;
        let gamma = [
            m1 * c1 + m4 * c4 + m6 * c6 + (m5 + m7 + m8 + m9) * l1,
            m2 * c2 + m4 * l2 - m5 * c5 - m8 * c8 - m9 * l5,
            m3 * c3 + m6 * l3 + m7 * c7 + m8 * l3 - m9 * c9,
        ];
        // The terms may cancel, so rounding is measured against them.
        let size: f64 = m.iter().zip(&l).map(|(m, l)| m * l).sum();
        for (k, gamma) in gamma.into_iter().enumerate() {
            let off = inertia.first_moment(k) - Vector::new(gamma, 0.0);
            prop_assert!(off.norm() <= 1e-15 * size, "(A1): {off} of {size}");
        }
        let [q1, q2, q3] = angles(&s.q);
        let c12 = (m4 * l2 * c4 - m5 * l1 * c5 - m8 * l1 * c8 - m9 * l1 * l5) * (q1 - q2).cos();
        let c13 = (m6 * l3 * c6 + m7 * l1 * c7 + m8 * l1 * l7 - m9 * l1 * c9) * (q1 - q3).cos();
        let c23 = (m9 * l5 * c9 - m8 * l7 * c8) * (q2 - q3).cos();
        let d = [
            i1 + i4 + i6 + m1 * c1 * c1 + m4 * c4 * c4 + m6 * c6 * c6 + (m5 + m7 + m8 + m9) * l1 * l1 + c12 + c13,
            i2 + i5 + i8 + m2 * c2 * c2 + m5 * c5 * c5 + m8 * c8 * c8 + m4 * l2 * l2 + m9 * l5 * l5 + c12 + c23,
            i3 + i7 + i9 + m3 * c3 * c3 + m7 * c7 * c7 + m9 * c9 * c9 + m6 * l3 * l3 + m8 * l7 * l7 + c13 + c23,
        ];
        let (h, _) = mass_matrix(&inertia, &s.e(), &s.qd);
        close("(A3)", &[0, 1, 2].map(|k| h.momentum_coefficient(k)), &d, 1e-12);
        // Without its cosines, d_k is H_kk.
        close("(11)", &inertia.diagonals(), &[d[0] - c12 - c13, d[1] - c12 - c23, d[2] - c13 - c23], 1e-12);
    }

    #[test]
    fn mass_matrix_is_symmetric_and_positive_definite(body in any_body(), s in any_state()) {
        let inertia = Inertia::of(&machine_of(&body));
        let h = nalgebra::Matrix3::from_row_slice(&matrix(&inertia, &s));
        prop_assert_eq!(h, h.transpose());
        let least = h.symmetric_eigenvalues().min();
        prop_assert!(least > 0.0, "least eigenvalue {}", least);
        // Solving is the inverse of multiplying.
        let (mass, _) = mass_matrix(&inertia, &s.e(), &s.qd);
        close("solve", &mass.solve(&mass.times(&s.qdd)), &s.qdd, 1e-9);
    }

    /// f_B = M g − dp/dt, n_B = r_CM × M g − dL/dt = −Στ, power is the rate of energy, p = M ṙ_CM.
    #[test]
    fn laws_along_a_motion(body in any_body(), s in any_state()) {
        let machine = machine_of(&body);
        let (inertia, around, e) = (Inertia::of(&machine), around(&machine), s.e());
        let (torque, wrench) = inverse_with_wrench(&inertia, &e, &s.qd, &s.qdd, &around);
        let [px, py, l, work, rx, ry] = s.rate(|s| {
            let p = linear_momentum(&inertia, &s.e(), &s.qd);
            let (kinetic, potential) = energy(&inertia, &s.e(), &s.qd, machine.gravity());
            let r = first_moment(&inertia, &s.e());
            [p.re, p.im, angular_momentum(&inertia, &s.e(), &s.qd), kinetic + potential, r.re, r.im]
        });
        let weight = inertia.mass() * machine.gravity();
        close("static force", &xy(wrench.static_part.force), &xy(weight), 1e-14);
        let moment = cross(centre_of_mass(&inertia, &e), weight);
        close("static moment", &[wrench.static_part.moment], &[moment], 1e-12);
        // Differences carry rounding of 1e-16/h, and of the fourth order in h.
        close("force", &xy(wrench.dynamic.force), &[-px, -py], 1e-7);
        close("moment", &[wrench.dynamic.moment], &[-l], 1e-7);
        close("power", &[torque.dot(&s.qd)], &[work], 1e-7);
        close("momentum", &xy(linear_momentum(&inertia, &e, &s.qd)), &[rx, ry], 1e-7);
        let sum: f64 = torque.iter().sum();
        close("moment is minus the torques' sum", &[wrench.total().moment], &[-sum], 1e-11);
    }

    /// A force held at the end effector: virtual work, and its share of the base wrench.
    #[test]
    fn a_force_at_the_end_effector(body in any_body(), s in any_state(), fx in -50.0..50.0, fy in -50.0..50.0) {
        let machine = machine_of(&body);
        let (inertia, e) = (Inertia::of(&machine), s.e());
        let free = around(&machine);
        let force = Vector::new(fx, fy);
        let held = ExternalLoads { force, ..free };
        let (without, loose) = inverse_with_wrench(&inertia, &e, &s.qd, &s.qdd, &free);
        let (with, wrench) = inverse_with_wrench(&inertia, &e, &s.qd, &s.qdd, &held);
        let work = with.plus(-1.0, &without).dot(&s.qd);
        close("virtual work", &[work], &[-dot(force, velocity(machine.end_effector(), &e, &s.qd))], 1e-9);
        close("force", &xy(wrench.total().force - loose.total().force), &[fx, fy], 1e-9);
        let moment = cross(end_effector(machine.end_effector(), &e), force);
        close("moment", &[wrench.total().moment - loose.total().moment], &[moment], 1e-9);
        close("forward", &forward(&inertia, &e, &s.qd, &with, &held), &s.qdd, 1e-8);
    }

    /// On the balanced machine H is constant and diagonal, no force reaches the base, and n_B = −D_1 b̈.
    #[test]
    fn balanced_machine_obeys_one_line(s in any_state()) {
        let machine = builtin("nine-link").expect("built in");
        let inertia = Inertia::of(machine);
        let (torque, wrench) = inverse_with_wrench(&inertia, &s.e(), &s.qd, &s.qdd, &around(machine));
        let d = inertia.diagonals();
        close("torque", &torque, &PerDrive::from_fn(3, |k| d[k] * s.qdd[k]), 1e-13);
        let pull = s.qd.max_abs().powi(2) + s.qdd.max_abs();
        prop_assert!(wrench.total().force.norm() <= 1e-14 * pull, "{:?}", wrench);
        let b_acceleration = inertia.lambda().dot(&s.qdd);
        close("n_B", &[wrench.total().moment], &[-inertia.diagonal(0) * b_acceleration], 1e-12);
        let twin = body_of(machine).recursive(angles(&s.q), three(&s.qd), three(&s.qdd));
        close("twin", &torque, &twin.0, 1e-11);
    }
}

/// Change points are no trouble to the closed forms: torques are continuous through one.
#[test]
fn torque_is_finite_at_a_change_point() {
    let body = body_of(&builtin("nine-link-table-1").expect("built in").set("payload.mass", "0.4").expect("valid"));
    let machine = machine_of(&body);
    let inertia = Inertia::of(&machine);
    for gap in [0.0, 1e-9, -1e-9] {
        let s = State::new([1.0, 2.2, 1.0 + gap], [1.0, -2.0, 0.5], [3.0, 1.0, -4.0]);
        let (torque, wrench) = inverse_with_wrench(&inertia, &s.e(), &s.qd, &s.qdd, &around(&machine));
        let (twin, reaction) = body.recursive(angles(&s.q), three(&s.qd), three(&s.qdd));
        close("torque", &torque, &twin, 1e-12);
        let total = wrench.total();
        close("wrench", &[total.force.re, total.force.im, total.moment], &reaction, 1e-12);
    }
}
