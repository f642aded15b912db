//! Paths of four drives and more against the least costs that SciPy finds over all poses of their stations.

use serde_json::{Value, json};
use stillbase::mechanics::machine::to_toml;
use stillbase::planning::curves::Curve;
use stillbase::planning::curves::Path;
use stillbase::planning::posture::{Posture, PostureRequest};
use stillbase::planning::timing::TimeLaw;

use super::python::answers;
use crate::random::{Case, a_case};
use crate::{Noise, Test, count};

pub const TESTS: &[Test] = tests![scipy_finds_no_path_of_less_cost];

const SCRIPT: &str = concat!(include_str!("machine.py"), include_str!("postures.py"));
/// Intervals between the stations of a path.
const INTERVALS: usize = 16;
/// Even times at which the path of least torque is sampled.
const TIMES: usize = 1000;
const KINDS: [(&str, Posture); 4] = [
    ("rates", Posture::LeastRates),
    ("torque", Posture::LeastTorque),
    ("middle", Posture::MidRange),
    ("orientation", Posture::Orientation),
];

impl Case {
    fn path(&self, posture: Posture) -> Option<Path> {
        let curve = Curve::line(self.ends[0], self.ends[1]);
        let asked = PostureRequest {
            machine: &self.machine,
            space: &self.space,
            b: self.b,
            curves: std::slice::from_ref(&curve),
            law: Some(TimeLaw::Quintic),
            closed: false,
            hand: (self.machine.resolved_links()[self.machine.end_link()].drive, None),
        };
        Some(Path::Table(asked.path(posture).ok()?.tables.remove(0)))
    }

    fn asked(&self, seed: usize) -> Value {
        let at = |i: usize| i as f64 / INTERVALS as f64;
        let points = (0..=INTERVALS).map(|i| self.ends[0] + at(i) * (self.ends[1] - self.ends[0]));
        let points: Vec<[f64; 2]> = points.map(|p| [p.re, p.im]).collect();
        let poses = |path: &Path| (0..=INTERVALS).map(|i| path.at(at(i)).q.0.to_vec()).collect::<Vec<_>>();
        let found = KINDS.iter().filter_map(|(kind, posture)| Some(((*kind).to_owned(), self.path(*posture)?)));
        let found: Vec<(String, Path)> = found.collect();
        // Torques are large where the path is passed slowly: they are measured at even times.
        let timed = |path: &Path| {
            let s = |t: f64| t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
            let pose = |i: usize| path.at(s(i as f64 / TIMES as f64)).q.0.to_vec();
            (0..=TIMES).map(pose).collect::<Vec<_>>()
        };
        let timed = found.iter().find(|(kind, _)| kind == "torque").map(|(_, path)| timed(path));
        let paths: serde_json::Map<String, Value> =
            found.iter().map(|(kind, path)| (kind.clone(), json!(poses(path)))).collect();
        json!({
            "machine": to_toml(&self.machine),
            "b": self.b,
            "points": points,
            "paths": paths,
            "timed": timed,
            "seed": seed,
            "poses": 120,
        })
    }
}

/// Every path stays on its line, at its b and within limits; dynamic programming over random poses and SLSQP from its
/// result and from all paths of the program find none of less rates or nearer to the middle, none beside it of less
/// torques, and none where the program finds none.
fn scipy_finds_no_path_of_less_cost() {
    let mut noise = Noise::of(count("SEED", 61));
    let all = [4, 5, 4, 6, 4, 5, 7, 8];
    let lines: Vec<String> = (0..count("POSTURES", 3) as usize)
        .map(|i| a_case(&mut noise, all[i % all.len()]).asked(i).to_string())
        .collect();
    let found = answers(SCRIPT, &lines);
    assert_eq!(found.len(), lines.len());
    let mut wrong = Vec::new();
    for (i, found) in found.iter().enumerate() {
        println!("{i}: {found}");
    }
    for (i, found) in found.iter().enumerate() {
        let number = |value: &Value| value.as_f64().expect("a number");
        for (what, most) in [("off", 1e-9), ("past", 1e-6), ("b", 1e-9)] {
            if number(&found[what]) > most {
                wrong.push(format!("{i}: {what} {}", found[what]));
            }
        }
        // SciPy's stations are few: the torques between them are known to some thousandths only.
        for (kind, most) in [("rates", 1e-2), ("torque", 1e-2), ("middle", 1e-3)] {
            let (own, least) = (&found["own"][kind], &found["least"][kind]);
            match (own.as_f64(), least.as_f64()) {
                (Some(own), Some(least)) if own > least * (1.0 + most) => {
                    wrong.push(format!("{i}: {kind} {own}, SciPy {least}"))
                }
                (None, Some(least)) => wrong.push(format!("{i}: {kind} refused, SciPy {least}")),
                _ => {}
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
