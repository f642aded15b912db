//! What joints carry over a run is what its frames have.

use stillbase::mechanics::machine::builtin;
use stillbase::session::replay;
use stillbase::session::scenario::Scenario;
use stillbase::study::joint_extremes::JointExtremes;

#[test]
fn the_extremes_are_those_of_the_frames() {
    let scenario = Scenario::builtin("case-3").expect("built in");
    let machine = scenario.plant.machine(&scenario.machine).expect("a machine");
    let mut extremes = JointExtremes::of(machine).expect("its forces can be told");
    let count = extremes.pins().len();
    let mut peaks = vec![0.0f64; count];
    let run = replay(&scenario, |_, frame| {
        extremes.include(frame);
        for (i, peak) in peaks.iter_mut().enumerate() {
            *peak = peak.max(frame.inside.pin(i).map_or(0.0, |force| force.norm()));
        }
    })
    .expect("it runs");
    let report = extremes.report(&scenario.name, &run.frame());
    assert_eq!(report.pins.iter().map(|pin| pin.peak).collect::<Vec<_>>(), peaks);
    let worst = peaks.iter().copied().fold(0.0, f64::max);
    assert!(report.pins.iter().any(|pin| pin.name == report.worst && pin.peak == worst));
    assert!(report.steps == run.frame().step && report.audit_failed.is_none() && report.tilt.flat);
    // Parallelograms close by each pair of drives that they join; a serial arm has none.
    assert!(report.transmission.iter().all(|pair| !pair.closures.is_empty() && (0.0..=1.0).contains(&pair.least)));
    let serial = JointExtremes::of(builtin("serial-3r").expect("built in").clone()).expect("its forces can be told");
    assert!(serial.report("serial", &run.frame()).transmission.is_empty() && serial.left_out() == 0);
}
