//! What signals mean: each obeys a law that is written down here anew, from nine rigid bodies, from differences and
//! sums over time, from geometry and from what the scenarios say. The table of signals is not asked which field it
//! reads.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use stillbase::mechanics::joint_forces::Joints;
use stillbase::mechanics::planar::PerDrive;
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;
use stillbase::simulation::frame::Frame;
use stillbase::simulation::plant::{BaseKind, DriveValues};
use stillbase::simulation::signals::signals;

use crate::mechanics::nine_body::NineBody;
use crate::support::{body_of, error};

/// All values of a run by their paths, as the table tells them.
type Series = BTreeMap<String, Vec<f64>>;

/// A run, and the same motion's nine bodies: what control believes, and what moves.
struct Told {
    scenario: Scenario,
    frames: Vec<Frame>,
    model: NineBody,
    plant: NineBody,
    series: Series,
    /// Names of the pins, in the order of the nine bodies.
    pins: Vec<String>,
    /// Paths that a law has asked for.
    asked: RefCell<BTreeSet<String>>,
}

fn told(name: &str, change: impl Fn(&mut Scenario)) -> Told {
    let mut scenario = Scenario::builtin(name).expect("built in");
    change(&mut scenario);
    let mut frames = Vec::new();
    replay(&scenario, |_, f| frames.push(*f)).expect("it can start");
    let model = body_of(&scenario.machine);
    let plant = NineBody { payload: model.payload + scenario.plant.payload.mass, ..model };
    let table = signals(&scenario.machine);
    let values = |i: usize| frames.iter().map(|f| table[i].value(f)).collect();
    let series = (0..table.len()).map(|i| (table[i].path.clone(), values(i))).collect();
    let joints = Joints::of(&scenario.machine).expect("determinate");
    let pins = joints.pins().iter().map(|pin| pin.name.clone()).collect();
    Told { scenario, frames, model, plant, series, pins, asked: RefCell::default() }
}

/// Case 1 with a payload that control does not know, friction and gravity: nothing is zero by accident. Then the same
/// straight line on a base that floats, with a wheel that saturates, without a reaction, and with a payload picked up.
fn runs() -> [Told; 5] {
    let heavy = told("case-1", |scenario| {
        scenario.plant.payload.mass = 0.1;
        scenario.plant.payload.axial = 0.03;
        scenario.plant.friction.viscous = DriveValues::Own(PerDrive::from_fn(3, |k| 0.1 * (k + 1) as f64));
        let settings = [("gravity", "1,-9.81"), ("link.5.axial", "0.02")];
        scenario.machine = scenario.machine.set_all(settings).expect("valid");
    });
    [heavy, told("spacecraft", |_| {}), told("wheel", |_| {}), told("case-3", |_| {}), told("pick-up", |_| {})]
}

type Verdict = Result<(), String>;

fn near(what: &str, got: &[f64], want: &[f64], tolerance: f64) -> Verdict {
    let off = error(got, want);
    if off <= tolerance { Ok(()) } else { Err(format!("{what}: got {got:?}, want {want:?}, {off:e} off")) }
}

/// A vector turned a quarter to the left.
fn left([x, y]: [f64; 2]) -> [f64; 2] {
    [-y, x]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn sum(a: [f64; 2], b: [f64; 2], by: f64) -> [f64; 2] {
    [a[0] + by * b[0], a[1] + by * b[1]]
}

impl Told {
    fn of(&self, path: &str) -> &[f64] {
        self.asked.borrow_mut().insert(path.to_owned());
        self.series.get(path).unwrap_or_else(|| panic!("no signal {path}"))
    }

    fn at(&self, path: &str, i: usize) -> f64 {
        self.of(path)[i]
    }

    fn three(&self, group: &str, i: usize) -> [f64; 3] {
        [1, 2, 3].map(|k| self.at(&format!("{group}/{k}"), i))
    }

    fn xy(&self, group: &str, i: usize) -> [f64; 2] {
        ["x", "y"].map(|axis| self.at(&format!("{group}/{axis}"), i))
    }

    /// The rate of anything at an instant, by differences of fourth order.
    fn rate(&self, value: impl Fn(usize) -> f64, i: usize) -> f64 {
        (value(i - 2) - 8.0 * value(i - 1) + 8.0 * value(i + 1) - value(i + 2)) / (12.0 * self.scenario.step)
    }

    /// The integral of anything from the start, by Simpson's rule.
    fn integral(&self, value: impl Fn(usize) -> f64, to: usize) -> f64 {
        assert!(to.is_multiple_of(2));
        let weight = |i: usize| if i == 0 || i == to { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        (0..=to).map(|i| weight(i) * value(i)).sum::<f64>() * self.scenario.step / 3.0
    }

    fn instants(&self) -> impl Iterator<Item = usize> + use<> {
        (104..900).step_by(197)
    }

    /// r × m (g − a) of the links and the payload, of which each has its height: what
    /// tilts the base.
    fn tilt(&self, i: usize) -> [f64; 2] {
        let (q, qd, qdd) = (self.three("angle", i), self.three("rate", i), self.three("acceleration", i));
        let forces = self.plant.pulls(q, qd, qdd);
        let links = self.scenario.machine.links().iter().map(|l| l.axial);
        let heights = links.chain([self.scenario.plant.payload.axial]);
        forces.iter().zip(heights).fold([0.0; 2], |t, (f, z)| sum(t, left(*f), z))
    }

    /// What holds of any run.
    fn kinematics(&self) -> Verdict {
        let body = &self.plant;
        let inertia = self.model.mass_matrix([0.0; 3]);
        let weights = [0, 1, 2].map(|k| inertia[(k, k)] / inertia[(0, 0)]);
        for i in self.instants() {
            let (q, qd) = (self.three("angle", i), self.three("rate", i));
            let near = |what: &str, got: &[f64], want: &[f64], tolerance| {
                near(&format!("{} at {i}: {what}", self.scenario.name), got, want, tolerance)
            };
            // Rates and accelerations by differences.
            let change = |group: &str| [0, 1, 2].map(|k| self.rate(|j| self.three(group, j)[k], i));
            near("rate", &qd, &change("angle"), 1e-6)?;
            near("acceleration", &self.three("acceleration", i), &change("rate"), 1e-5)?;
            for axis in ["x", "y"] {
                let place = self.of(&format!("base/{axis}"));
                near("base", &[self.at(&format!("base_velocity/{axis}"), i)], &[self.rate(|j| place[j], i)], 1e-7)?;
            }
            let attitude = self.of("attitude/base");
            near("attitude", &[self.at("attitude_rate/base", i)], &[self.rate(|j| attitude[j], i)], 1e-7)?;
            // Places, by nine bodies on a base that may have moved.
            let ([tip, com], base) = (body.places(q), self.xy("base", i));
            near("tip", &self.xy("tip", i), &sum(base, tip, 1.0), 1e-12)?;
            near("com", &self.xy("com", i), &sum(base, com, 1.0), 1e-12)?;
            near("target", &self.xy("target", i), &[0.55, 0.90], 1e-9)?;
            // Angles between drives, of drives on the base, and what control aims at.
            let own = q.map(|q| q - attitude[i]);
            let (reference, off) = (self.three("reference", i), self.three("error", i));
            near("error", &off, &[0, 1, 2].map(|k| reference[k] - own[k]), 1e-12)?;
            near("a1", &[self.at("joint/a1", i)], &[q[1] - q[0]], 1e-12)?;
            near("a2", &[self.at("joint/a2", i)], &[q[2] - q[1] + std::f64::consts::PI], 1e-12)?;
            let b = |q: [f64; 3]| (0..3).map(|k| weights[k] * q[k]).sum::<f64>();
            let (now, aim) = (self.at("pose/b", i), self.at("pose/b_reference", i));
            near("b", &[now, aim], &[b(own), b(reference)], 1e-9)?;
            near("plane", &[self.at("audit_plane/b", i)], &[now - aim], 1e-12)?;
            self.pairs(q, i)?;
            // Of both parts of force and moment.
            let (x, y) = (self.at("force/dynamic_x", i), self.at("force/dynamic_y", i));
            near("|f|", &[self.at("force/dynamic", i)], &[x.hypot(y)], 1e-12)?;
            let total = self.at("moment/total", i);
            near("n", &[total], &[self.at("moment/dynamic", i) + self.at("moment/static", i)], 1e-12)?;
            // A free base turns about its own centre of mass, see `floating`.
            if self.scenario.base.kind != BaseKind::Free {
                near("felt", &[self.at("moment/felt", i)], &[total - self.at("moment/wheel", i)], 1e-12)?;
            }
        }
        // Not the same pin carries most all the time.
        let pins: Vec<&[f64]> = self.pins.iter().map(|pin| self.of(&format!("pin/{pin}"))).collect();
        for i in (0..1000).step_by(10) {
            let most = pins.iter().map(|pin| pin[i]).fold(0.0, f64::max);
            near("worst pin", &[self.at("pin/worst", i)], &[most], 1e-12)?;
        }
        // A path to be followed ends where it should.
        let end = [1, 2, 3].map(|k| self.at(&format!("reference/{k}"), 1000));
        near("the end", &body.places(end)[0], &[0.55, 0.90], 1e-6)
    }

    /// Change points, and how well the end effector moves.
    fn pairs(&self, q: [f64; 3], i: usize) -> Verdict {
        let sines = [(0, 1), (0, 2), (1, 2)].map(|(k, l)| (q[k] - q[l]).sin().abs());
        let got = ["12", "13", "23"].map(|pair| self.at(&format!("transmission/{pair}"), i));
        near("transmission", &got, &sines, 1e-12)?;
        let least = sines.into_iter().fold(f64::INFINITY, f64::min);
        near("least", &[self.at("transmission/least", i)], &[least], 1e-12)?;
        near("change point", &[self.at("change_point/distance", i)], &[least.asin()], 1e-9)?;
        // Columns of the Jacobian by differences, and a step along the plane in either angle.
        let tip = |q: [f64; 3]| self.plant.places(q)[0];
        let slope = |along: [f64; 3]| {
            let at = |h: f64| tip([0, 1, 2].map(|k| q[k] + h * along[k]));
            sum(at(1e-5), at(-1e-5), -1.0).map(|d| d / 2e-5)
        };
        let j = [slope([1.0, 0.0, 0.0]), slope([0.0, 1.0, 0.0]), slope([0.0, 0.0, 1.0])];
        let minors = [cross(j[0], j[1]), cross(j[0], j[2]), cross(j[1], j[2])];
        let w = minors.iter().map(|m| m * m).sum::<f64>().sqrt();
        near("manipulability", &[self.at("dexterity/manipulability", i)], &[w], 1e-8)?;
        // Its largest singular value: the root of the larger eigenvalue of J J*.
        let of = |a: usize, b: usize| j.iter().map(|c| c[a] * c[b]).sum::<f64>();
        let (mean, half) = (0.5 * (of(0, 0) + of(1, 1)), 0.5 * (of(0, 0) - of(1, 1)));
        let most = (mean + half.hypot(of(0, 1))).sqrt();
        near("torque for a force", &[self.at("torque_per_force/worst", i)], &[most], 1e-8)?;
        let inertia = self.model.mass_matrix([0.0; 3]);
        let d = [0, 1, 2].map(|k| inertia[(k, k)] / inertia.trace());
        // On the plane Σ D_k q_k stays; a_1 turns drives 2 and 3 against drive 1, a_2 drive 3 against both.
        let (one, two) = ([-d[1] - d[2], d[0], d[0]], [-d[2], -d[2], d[0] + d[1]]);
        near("det", &[self.at("dexterity/det", i)], &[cross(slope(one), slope(two)).abs()], 1e-8)
    }

    /// On a fixed base with a payload: Newton and Euler for nine bodies.
    fn dynamics(&self) -> Verdict {
        for i in self.instants() {
            let (q, qd, qdd) = (self.three("angle", i), self.three("rate", i), self.three("acceleration", i));
            let (all, still) = (self.plant.solve(q, qd, qdd), self.plant.solve(q, [0.0; 3], [0.0; 3]));
            let friction = self.three("friction", i);
            let torque = self.three("torque", i);
            near("torque", &[0, 1, 2].map(|k| torque[k] - friction[k]), &all.torque, 1e-9)?;
            near("friction", &friction, &[0.1 * qd[0], 0.2 * qd[1], 0.3 * qd[2]], 1e-12)?;
            let moving = sum(all.base_force, still.base_force, -1.0);
            let force =
                ["dynamic", "static"].map(|part| ["x", "y"].map(|axis| self.at(&format!("force/{part}_{axis}"), i)));
            near("force", &force.concat(), &[moving, still.base_force].concat(), 1e-9)?;
            let moment = ["dynamic", "static"].map(|part| self.at(&format!("moment/{part}"), i));
            near("moment", &moment, &[all.base_moment - still.base_moment, still.base_moment], 1e-9)?;
            near("momentum", &self.xy("momentum", i), &all.linear_momentum, 1e-9)?;
            near("h", &[self.at("angular_momentum/about_b", i)], &[all.angular_momentum], 1e-9)?;
            let kinetic = self.plant.energy(q, qd) - self.plant.energy(q, [0.0; 3]);
            near("kinetic", &[self.at("energy/kinetic", i)], &[kinetic], 1e-9)?;
            let sizes = all.pins.iter().map(|f| f[0].hypot(f[1])).collect::<Vec<_>>();
            for (pin, size) in self.pins.iter().zip(&sizes) {
                near(pin, &[self.at(&format!("pin/{pin}"), i)], &[*size], 1e-9)?;
            }
            near("tilt", &self.xy("tilt", i), &self.tilt(i), 1e-9)?;
            // Computed torque: the model's answer to the reference's acceleration and to the errors.
            let follow = |k: usize| {
                let name = format!("reference/{}", k + 1);
                let reference = self.of(&name);
                let rate = |j: usize| self.rate(|j| reference[j], j);
                self.rate(rate, i) + 40.0 * (rate(i) - qd[k]) + 400.0 * self.at(&format!("error/{}", k + 1), i)
            };
            near("control", &torque, &self.model.recursive(q, qd, [0, 1, 2].map(follow)).0, 1e-5)?;
            for (path, held) in [("payload/held", 1.0), ("reactionless/now", 0.0), ("wheel_saturated/now", 0.0)] {
                near(path, &[self.at(path, i)], &[held], 0.0)?;
            }
        }
        self.sums()
    }

    /// Sums over time.
    fn sums(&self) -> Verdict {
        let powers = |i: usize| {
            let (torque, qd) = (self.three("torque", i), self.three("rate", i));
            let wheel = self.at("moment/wheel", i) * self.at("wheel/rate", i);
            (0..3).map(|k| (torque[k] * qd[k]).abs()).sum::<f64>() + wheel.abs()
        };
        let (n, f) = (self.of("moment/felt"), self.of("force/dynamic"));
        let (to, time) = (800, 0.8);
        let rms = |x: &[f64]| (self.integral(|i| x[i] * x[i], to) / time).sqrt();
        near("n rms", &[self.at("moment/rms", to)], &[rms(n)], 1e-4)?;
        near("f rms", &[self.at("force/rms", to)], &[rms(f)], 1e-4)?;
        near("∫|n|", &[self.at("angular_impulse/moment", to)], &[self.integral(|i| n[i].abs(), to)], 1e-4)?;
        near("∫|f|", &[self.at("impulse/force", to)], &[self.integral(|i| f[i], to)], 1e-4)?;
        near("motors", &[self.at("energy/motors", to)], &[self.integral(powers, to)], 1e-4)
    }

    /// A base that floats is a rigid body that the arm pushes, and the whole has no momentum.
    fn floating(&self) -> Verdict {
        let base = &self.scenario.base;
        let angle = self.of("attitude/base");
        let place = ["base/x", "base/y"].map(|path| self.of(path));
        let com = |i: usize| {
            let (s, c) = angle[i].sin_cos();
            [place[0][i] + c * base.com[0] - s * base.com[1], place[1][i] + s * base.com[0] + c * base.com[1]]
        };
        for i in self.instants() {
            let second = |value: &dyn Fn(usize) -> f64| self.rate(|j| self.rate(value, j), i);
            let force = [0, 1].map(|axis| base.mass * second(&|j| com(j)[axis]));
            near("f on the base", &["x", "y"].map(|a| self.at(&format!("force/dynamic_{a}"), i)), &force, 1e-4)?;
            let about = sum(com(i), [place[0][i], place[1][i]], -1.0);
            let turn = base.inertia * second(&|j| angle[j]);
            near("felt", &[self.at("moment/felt", i)], &[turn], 1e-4)?;
            near("n on the base", &[self.at("moment/total", i)], &[turn + cross(about, force)], 1e-4)?;
            near("nothing is gained", &self.xy("momentum", i), &[0.0; 2], 1e-9)?;
            near("nothing turns", &[self.at("angular_momentum/about_b", i)], &[0.0], 1e-9)?;
        }
        Ok(())
    }

    /// A wheel turns by its torque until its motor has no more to give.
    fn wheel(&self) -> Verdict {
        let wheel = self.scenario.base.wheel.expect("one");
        let (rate, most) = (self.of("wheel/rate"), wheel.torque_limit.expect("one"));
        let torque = self.of("moment/wheel");
        near("Ω", &[rate[800]], &[self.integral(|i| torque[i], 800) / wheel.inertia], 1e-3)?;
        let flag = |is: bool| f64::from(u8::from(is));
        for (i, torque) in torque.iter().enumerate().take(1000).skip(1) {
            let saturated = self.at("wheel_saturated/now", i);
            near("saturated", &[saturated], &[flag(torque.abs() >= most)], 0.0)?;
            near("felt", &[flag(self.at("moment/felt", i).abs() > 1e-9)], &[saturated], 0.0)?;
        }
        self.sums()
    }

    /// Figures that should be zero are, as the audit has them; there is no second way to such a remainder.
    fn audits(&self) -> Verdict {
        for i in 0..self.frames.len() {
            let audit = self.frames[i].audit;
            for (path, value, most) in [
                ("audit_energy/balance", audit.energy, 1e-6),
                ("audit_momentum/linear", audit.momentum, 1e-6),
                ("audit_angular/about_o", audit.angular, 1e-6),
                ("audit_closure/worst", audit.closure, 1e-6),
                ("audit_step/worst", audit.step, 1e-4),
            ] {
                let got = self.at(path, i);
                if got != value || got.abs() > most {
                    return Err(format!("{path}: {got}, audited {value}"));
                }
            }
        }
        Ok(())
    }
}

/// Every law, over all runs.
fn laws(runs: &[Told; 5]) -> Verdict {
    let [heavy, spacecraft, wheel, quiet, pick_up] = runs;
    // What is picked up is there from one step to the next: no law of differences holds across that.
    [heavy, spacecraft, wheel, quiet].into_iter().try_for_each(Told::kinematics)?;
    [heavy, spacecraft].into_iter().try_for_each(Told::audits)?;
    heavy.dynamics()?;
    spacecraft.floating()?;
    wheel.wheel()?;
    let load = &pick_up.scenario.plant.payload;
    for i in (50..1000).step_by(100) {
        near("reactionless", &[quiet.at("reactionless/now", i)], &[1.0], 0.0)?;
        let time = i as f64 * pick_up.scenario.step;
        let held = f64::from(u8::from(load.from < time && load.until.is_some_and(|until| time < until)));
        near("held", &[pick_up.at("payload/held", i)], &[held], 0.0)?;
        near("reactionless until then", &[pick_up.at("reactionless/now", i)], &[1.0 - held], 0.0).or_else(|why| {
            // What control does about the errors of that time outlasts it.
            if time > load.from { Ok(()) } else { Err(why) }
        })?;
    }
    Ok(())
}

#[test]
fn every_signal_obeys_its_laws() {
    let runs = runs();
    laws(&runs).unwrap_or_else(|why| panic!("{why}"));
    // No row is left that no law asks for.
    let asked: BTreeSet<String> = runs.iter().flat_map(|run| run.asked.take()).collect();
    assert_eq!(asked, runs[0].series.keys().cloned().collect());
    for run in &runs {
        assert!(run.series.values().flatten().all(|x| x.is_finite()));
    }
    // The loops of this machine close to the last digit, so that their gap is made up.
    let mut frame = runs[0].frames[500];
    frame.audit.closure = 0.25;
    let table = signals(&runs[0].scenario.machine);
    let gap = table.iter().find(|s| s.path == "audit_closure/worst").expect("a row");
    assert_eq!(gap.value(&frame), 0.25);
}

/// The laws tell signals apart: with any two of one unit exchanged, one turned around, or one in other units, some law
/// is broken.
#[test]
fn a_signal_in_the_place_of_another_breaks_a_law() {
    let mut runs = runs();
    let table = signals(&runs[0].scenario.machine);
    let (mut tried, mut unseen) = (0, Vec::new());
    let mut tell = |runs: &[Told; 5], what: String| {
        tried += 1;
        if laws(runs).is_ok() {
            unseen.push(what);
        }
    };
    for (i, a) in table.iter().enumerate() {
        for b in table[i + 1..].iter().filter(|b| b.unit == a.unit) {
            let swap = |run: &mut Told| {
                let taken = std::mem::take(run.series.get_mut(&a.path).expect("a row"));
                let other = std::mem::replace(run.series.get_mut(&b.path).expect("a row"), taken);
                run.series.insert(a.path.clone(), other);
            };
            runs.iter_mut().for_each(swap);
            tell(&runs, format!("{} for {}", a.path, b.path));
            runs.iter_mut().for_each(swap);
        }
        for factor in [-1.0, 0.5, 180.0 / std::f64::consts::PI] {
            let mut before = Vec::new();
            for run in &mut runs {
                let row = run.series.get_mut(&a.path).expect("a row");
                before.push(row.clone());
                row.iter_mut().for_each(|x| *x *= factor);
            }
            // What is zero throughout stays so.
            if runs.iter().zip(&before).any(|(run, row)| run.series[&a.path] != *row) {
                tell(&runs, format!("{factor} times {}", a.path));
            }
            for (run, row) in runs.iter_mut().zip(before) {
                run.series.insert(a.path.clone(), row);
            }
        }
    }
    assert!(laws(&runs).is_ok() && tried > 500, "{tried}");
    assert!(unseen.is_empty(), "{} of {tried} go unseen: {unseen:#?}", unseen.len());
}
