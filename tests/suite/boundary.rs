//! The boundary of a reactionless workspace against closed forms, rasters and many starts.

use std::f64::consts::{PI, TAU};

use stillbase::machine::{Inertia, builtin};
use stillbase::reactionless::{AngleDefinition, Boundary, Limit, PlaneMap};

fn map(name: &str) -> PlaneMap {
    let machine = builtin(name).unwrap();
    let lambda = Inertia::of(machine).lambda();
    let angle = |i: usize| &machine.angles()[i];
    PlaneMap::new(
        [0, 1, 2].map(|k| machine.tip()[k]),
        [0, 1, 2].map(|k| lambda[k]),
        [0, 1].map(|i| AngleDefinition { to: angle(i).to, from: angle(i).from, offset: angle(i).offset }),
        [0, 1].map(|i| Limit { min: *angle(i).limits.start(), max: *angle(i).limits.end() }),
    )
    .unwrap()
}

#[test]
fn looks() {
    for limits in [[0.0, PI, 0.0, PI], [-PI, PI, -PI, PI], [0.0, TAU, 0.0, TAU], [-1.0, 4.0, -2.0, 5.0]] {
        let map = map("nine-link-table-1")
            .with_limits([Limit { min: limits[0], max: limits[1] }, Limit { min: limits[2], max: limits[3] }]);
        let clock = std::time::Instant::now();
        let boundary = Boundary::of(&map);
        println!("{limits:?} {:?}", clock.elapsed());
        println!("area {} sheet {} {:?}", boundary.area(), boundary.sheet_area(), boundary.extent(2.4));
        for l in boundary.loops() {
            println!("  {} vertices, {}", l.vertices().len(), l.area());
        }
    }
}
