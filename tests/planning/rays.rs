//! Rays of the end effector at zero momentum, and beyond with least momentum. The distances are those of an integration
//! in SciPy, with momenta and Jacobians as sums over the bodies of base and arm.

use stillbase::mechanics::machine::{Inertia, Machine, builtin, parse};
use stillbase::mechanics::planar::{DriveAngles, Vector, unit};
use stillbase::planning::off_plane::drift::Singularity;
use stillbase::planning::off_plane::momentum::{MomentumModel, TipFrame};
use stillbase::planning::off_plane::rays::{RayEnd, RayStop, Rays};
use stillbase::session::scenario::{Scenario, TaskChange};
use stillbase::session::verdict::{Statements, StatusLight, Verdict};
use stillbase::session::{Refusal, Run, proposals, replay};
use stillbase::study::turn_map::{TurnMap, turn_limits};

const START: [f64; 3] = [1.9, 2.6, 3.4];

/// Distances at zero momentum in steps of 30 degrees: free base, in space and seen from the base, and fixed base, m.
const SILENT: [[f64; 12]; 3] = [
    [
        0.149716361,
        0.240109685,
        0.191855020,
        0.061681984,
        0.011079107,
        0.006520974,
        0.005663218,
        0.006527567,
        0.011120721,
        0.073582476,
        0.583496866,
        0.180472134,
    ],
    [
        0.149700129,
        0.237336585,
        0.192871281,
        0.064587343,
        0.010668407,
        0.006189655,
        0.005338646,
        0.006114012,
        0.010301597,
        0.066968492,
        0.598407351,
        0.181800469,
    ],
    [
        0.336866697,
        0.230875531,
        0.179834079,
        0.093623557,
        0.005208719,
        0.002265857,
        0.001738624,
        0.001799144,
        0.002573424,
        0.008201289,
        0.466454596,
        0.231567695,
    ],
];

/// Distances at which the base has turned by 0.5, 1, 2 and 5 degrees, in space, m; NaN where it never does.
const TURNED: [[f64; 4]; 12] = [
    [0.153193072, 0.156872481, 0.164657192, 0.190142985],
    [0.247655256, 0.255089882, 0.269653400, 0.311045517],
    [0.197353683, 0.202654799, 0.212624858, 0.236378144],
    [0.074315435, 0.082281184, 0.090764705, f64::NAN],
    [0.018595095, 0.025490571, 0.037365354, 0.057136344],
    [0.011212532, 0.015750854, 0.024298342, 0.044261171],
    [0.009808329, 0.013882992, 0.021784707, 0.042756574],
    [0.011345824, 0.016118816, 0.025511194, 0.052191388],
    [0.019275515, 0.027307542, 0.043026519, 0.087937941],
    [0.102158248, 0.125809328, 0.165510859, 0.257822511],
    [0.591296087, 0.599230817, 0.615642388, 0.672410773],
    [0.187175384, 0.193984892, 0.207839100, 0.250542586],
];

fn direction(k: usize) -> Vector {
    unit(k as f64 * std::f64::consts::PI / 6.0)
}

fn spot(frame: Option<TipFrame>) -> MomentumModel {
    let arm = Inertia::of(builtin("spot").expect("built in"));
    let base = Scenario::builtin("spot").expect("built in").base.body();
    match frame {
        Some(frame) => MomentumModel::floating(&arm, &base, frame, &DriveAngles::from(START)),
        None => MomentumModel::from(&arm),
    }
}

fn ends(model: &MomentumModel, machine: &Machine, k: usize, turns: &[f64]) -> Vec<RayEnd> {
    let rays = Rays::new(model.clone(), machine.angles(), DriveAngles::from(START)).expect("three drives");
    rays.ends(direction(k), turns)
}

#[test]
fn silent_rays_end_at_dynamic_singularities() {
    let machine = builtin("spot").expect("built in");
    for (frame, distances) in [Some(TipFrame::Space), Some(TipFrame::Base), None].into_iter().zip(SILENT) {
        let model = spot(frame);
        for (k, want) in distances.into_iter().enumerate() {
            let end = ends(&model, machine, k, &[0.0])[0];
            assert!((end.distance - want).abs() < 1e-8, "{frame:?} {k}: {end:?}");
            assert_eq!(end.stop, RayStop::Singular(Singularity::Dynamic));
            let there = model.place(&DriveAngles::from(START)) + want * direction(k);
            assert!((model.place(&end.pose) - there).norm() < 1e-8);
        }
    }
}

#[test]
fn a_base_that_may_turn_lets_rays_go_on() {
    let (machine, model) = (builtin("spot").expect("built in"), spot(Some(TipFrame::Space)));
    let turns = [0.0, 0.5, 1.0, 2.0, 5.0].map(f64::to_radians);
    for (k, wants) in TURNED.into_iter().enumerate() {
        let ends = ends(&model, machine, k, &turns);
        assert!((ends[0].distance - SILENT[0][k]).abs() < 1e-8);
        for ((end, want), turn) in ends[1..].iter().zip(wants).zip(&turns[1..]) {
            if want.is_nan() {
                // The Jacobian of base and arm loses rank there; the integration in SciPy ends at the same place.
                assert!((end.distance - 0.093327464).abs() < 1e-7, "{end:?}");
                assert_eq!(end.stop, RayStop::Singular(Singularity::Joint));
            } else {
                assert!((end.distance - want).abs() < 1e-7, "{k}: {end:?}, want {want}");
                assert_eq!(end.stop, RayStop::Turn);
                let start = model.place(&DriveAngles::from(START));
                let miss = |turn: f64| (model.place_turned(&end.pose, turn) - start - want * direction(k)).norm();
                assert!(miss(*turn).min(miss(-turn)) < 1e-7);
            }
        }
    }
}

#[test]
fn joint_limits_end_rays_before_singularities_do() {
    let angle = |name: &str, to: &str, from: &str, min: f64, max: f64| {
        format!("[[angle]]\nname = \"{name}\"\nto = \"{to}\"\nfrom = \"{from}\"\nmin = {min}\nmax = {max}\n")
    };
    let text = include_str!("../../assets/machines/spot.toml").to_owned()
        + &angle("a1", "elbow", "shoulder", 0.2, 1.2)
        + &angle("a2", "wrist", "elbow", -0.5, 1.4);
    let (machine, model) = (parse(&text, "spot").expect("valid"), spot(Some(TipFrame::Space)));
    let limit = |angle, upper| Some(RayStop::Limit { angle, upper });
    let wants = [
        (0, 0.023461613, limit(1, true)),
        (2, 0.044947564, limit(0, false)),
        (3, SILENT[0][3], None),
        (9, 0.073555812, limit(0, true)),
        (11, 0.027494343, limit(1, true)),
    ];
    for (k, want, stop) in wants {
        let end = ends(&model, &machine, k, &[0.0])[0];
        assert!((end.distance - want).abs() < 1e-7, "{k}: {end:?}");
        assert_eq!(end.stop, stop.unwrap_or(RayStop::Singular(Singularity::Dynamic)));
    }
}

/// Returns the scenario with B elsewhere and a turn limit, degrees.
fn bound_for(to: [f64; 2], frame: &str, turn_limit: f64) -> Scenario {
    let scenario = Scenario::builtin("spot").expect("built in");
    let to = vec![to[0].into(), to[1].into()];
    let change: TaskChange = [
        ("to".to_owned(), stillbase::session::scenario::Value::Array(to)),
        ("frame".to_owned(), frame.into()),
        ("turn_limit".to_owned(), turn_limit.into()),
    ]
    .into_iter()
    .collect();
    let task = scenario.task.with_change(&change, &scenario.machine).expect("valid");
    Scenario { task, ..scenario }
}

/// The simulation conserves momentum on its own: its base turns as planned, and the end effector arrives.
#[test]
fn a_crossing_turns_the_simulated_base_as_planned() {
    for (to, frame, limit) in
        [([-0.47, 0.4228], "space", 3.0), ([-0.4, 0.15], "space", 2.0), ([-0.47, 0.4228], "base", 1.5)]
    {
        let scenario = bound_for(to, frame, limit);
        let (mut most, mut end) = (0.0_f64, None);
        let run = replay(&scenario, |_, frame| {
            most = most.max(frame.base.angle.abs());
            end = Some((frame.base, frame.end_effector, frame.target.at));
        });
        let run = run.expect("it can be planned");
        // A turn that the task permits is a turn nevertheless.
        let verdict = Verdict::of(run.scenario(), &run.frame());
        let statement = Statements::of(&run, &run.frame()).run;
        assert!(verdict.attitude.is_some_and(|attitude| !attitude.is_kept()) && !verdict.spares_base());
        assert!(
            statement.outcome == StatusLight::Bad && statement.words.ends_with("within its limit"),
            "{statement:?}"
        );
        let turn = run.plan().base_turn.as_ref().expect("the base turns");
        let (base, tip, target) = end.expect("frames");
        assert!((base.angle - turn.angle_end).abs() < 1e-9, "{} is not {}", base.angle, turn.angle_end);
        assert!((most - turn.angle).abs() < 1e-7 && turn.angle <= limit.to_radians() && turn.angle > 0.01);
        assert!((tip - target).norm() < 1e-9, "{tip} is not {target}");
        let there = Vector::new(to[0], to[1]);
        let reached = if frame == "space" { tip } else { base.seen(tip) };
        assert!((reached - there).norm() < 1e-9, "{reached} is not {there}");
    }
}

#[test]
fn a_turn_that_is_too_large_is_refused_with_one_that_will_do() {
    let Err(Refusal::Turns { turn_limit, .. }) = Run::new(&bound_for([-0.47, 0.4228], "space", 2.0)) else {
        panic!("the base turns by 2.59 degrees");
    };
    assert!((turn_limit - 2.6).abs() < 1e-12, "{turn_limit}");
    Run::new(&bound_for([-0.47, 0.4228], "space", turn_limit)).expect("it will do");
    // Within reach of zero momentum, a limit changes nothing.
    let near = [-0.2937, 0.4728];
    let [with, without] = [5.0, 0.0].map(|limit| Run::new(&bound_for(near, "space", limit)).expect("within reach"));
    assert_eq!(with.plan().motion, without.plan().motion);
    assert!(with.plan().base_turn.is_none());
}

/// The area at zero momentum is that of 1440 rays in SciPy.
#[test]
fn areas_are_nested() {
    let run = Run::new(&Scenario::builtin("spot").expect("built in")).expect("it can be planned");
    let rays = run.rays().expect("three drives");
    let map = TurnMap::of(&rays, turn_limits(true), &mut |_| true).expect("not stopped");
    assert!((map.areas[0] - 0.125067).abs() < 0.002 * 0.125067, "{:?}", map.areas);
    assert!(map.areas.is_sorted() && map.rays.len() > 180);
    assert!(map.rays.iter().all(|ray| ray.reaches.is_sorted()));
    assert!(map.rays.is_sorted_by(|a, b| a.direction < b.direction));
    assert!((map.rays[0].reaches[0] - SILENT[0][0]).abs() < 1e-8);
    assert!(TurnMap::of(&rays, turn_limits(true), &mut |_| false).is_none());
    // All of its boundary is singular, but for where the arm is outstretched or folded.
    let singular = map.singular_curves();
    let other = map.rays_of(0).filter(|ray| ray.stops[0] != "dynamic singularity").count();
    let points: usize = singular.iter().map(Vec::len).sum();
    assert!(points > 150 && points <= map.rays_of(0).count() - other + 1, "{points}, {other}");
    let outline = map.outline(0);
    assert!(singular.iter().flatten().all(|p| outline.contains(p)));
}

/// Each area is the same whichever others are asked for.
#[test]
fn areas_do_not_depend_on_the_others_listed() {
    let rays =
        Run::new(&Scenario::builtin("spot").expect("built in")).expect("it can be planned").rays().expect("three");
    let map = |limits: &[f64]| TurnMap::of(&rays, limits, &mut |_| true).expect("not stopped");
    let (all, one, two) = (map(turn_limits(true)), map(&[1.0]), map(&[0.0, 1.0]));
    assert_eq!([all.areas[0], all.areas[2]], [two.areas[0], two.areas[1]]);
    assert_eq!(all.areas[2], one.areas[0]);
    assert_eq!(all.outline(2), one.outline(0));
}

/// A point beyond the outstretched arm is refused for that, not for a singularity on the way to it.
#[test]
fn too_far_is_too_far() {
    let far = |frame: &str, limit: f64| Run::new(&bound_for([-3.0, 0.3], frame, limit)).expect_err("beyond reach");
    for limit in [0.0, 5.0] {
        let why = far("space", limit).to_string();
        assert!(why.contains("common centre of mass") && why.contains("reaches only"), "{why}");
        let why = far("base", limit).to_string();
        // 0.3045 + 0.3045 + the rest of the links, from the base pin.
        assert!(why.contains("from the base") && why.contains("reach only"), "{why}");
    }
    // What is said to be the reach is so: outstretched towards B the tip is there, and no farther.
    let (spot, start) = (Scenario::builtin("spot").expect("built in"), DriveAngles::from(START));
    let (arm, base) = (Inertia::of(&spot.machine), spot.base.body());
    let model = MomentumModel::floating(&arm, &base, TipFrame::Space, &start);
    let (centre, farthest) = model.range();
    let mut most: f64 = 0.0;
    for turn in (0..3600).map(|i| f64::from(i) * 0.1) {
        for (a, b) in [(0.0, 0.0), (0.3, 0.1), (-0.2, 0.4)] {
            let angle = turn.to_radians();
            let tip = model.place(&DriveAngles::from([angle, angle + a, angle + b]));
            most = most.max((tip - centre).norm());
        }
    }
    assert!(most <= farthest + 1e-12 && most > 0.999 * farthest, "{most} of {farthest} m");
}

/// What is proposed for an arm whose base floats leaves the base as it is.
#[test]
fn a_task_made_for_a_free_base_keeps_its_attitude() {
    let refused = bound_for([-3.0, 0.3], "space", 0.0);
    let why = Run::new(&refused).expect_err("beyond reach");
    let all = proposals(&refused, &why);
    let made = all.iter().find(|found| found.text.contains("made for this machine")).expect("a task");
    let changed = refused.with_settings(made.change().expect("of the task")).expect("settings");
    let run = replay(&changed, |_, _| {}).expect("it runs");
    assert!(Verdict::of(run.scenario(), &run.frame()).attitude.is_some_and(|attitude| attitude.is_kept()), "{made:?}");
}

#[test]
fn gains_that_hardly_damp_are_named() {
    let wheel = |text: &str| {
        let start = "machine = 'spot'\n[task]\nkind = 'zero-momentum'\nstart = [1.9, 2.6, 3.4]\nto = [-0.3, 0.47]";
        let text = format!("{start}\n[base]\nkind = 'free'\n[base.wheel]\ninertia = 0.01\n{text}");
        Scenario::parse(&text, "wheel", None).expect("valid").base.wheel.expect("a wheel").poor_gains()
    };
    assert_eq!(wheel(""), None);
    let poor = wheel("kp = 4.0\nkd = 0.4").expect("a damping ratio of 0.1");
    assert!(poor.contains("damping ratio of 0.1 only") && poor.contains("kd of about 4 s"), "{poor}");
    let fast = wheel("kp = 100.0\nkd = 20.0\nrate = 5").expect("beyond what sampling holds");
    assert!(fast.contains("20 Hz and more"), "{fast}");
}
