//! Shapes of counterweights: rings, half rings and boxes.

use stillbase::mechanics::counterweights::{
    CounterweightError, CounterweightForm, CounterweightSite, CounterweightSpec, CounterweightStock, Objective,
    place_weights,
};
use stillbase::mechanics::machine::{Counterweight, CounterweightShape, Inertia, Machine, parse, to_toml};
use stillbase::mechanics::planar::{Vector, cross};

use crate::support::{Noise, family_machine};

const STEEL: CounterweightStock = CounterweightStock::STEEL;

fn a_shape(noise: &mut Noise, kind: usize) -> CounterweightShape {
    let inner_radius = noise.between(0.0, 0.05);
    let radius = inner_radius + noise.between(0.001, 0.2);
    match kind % 5 {
        0 => CounterweightShape::Disc { radius },
        1 => CounterweightShape::Ring { radius, inner_radius },
        2 => CounterweightShape::HalfRing { radius, inner_radius },
        3 => CounterweightShape::HalfRing { radius, inner_radius: 0.0 },
        _ => CounterweightShape::Box { length: noise.between(0.001, 0.5), width: noise.between(0.001, 0.2) },
    }
}

/// Area, first moments and polar second moment of a polygon about the origin, by the theorem of Green.
fn moments(polygon: &[Vector]) -> (f64, Vector, f64) {
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    sides.fold((0.0, Vector::default(), 0.0), |(area, first, second), (a, b)| {
        let twice = cross(*a, *b);
        let squares = (a.norm_sqr() + b.norm_sqr() + a.re * b.re + a.im * b.im) / 12.0;
        (area + 0.5 * twice, first + (a + b) * (twice / 6.0), second + twice * squares)
    })
}

/// The outline of each shape has the area, the centre of mass and the inertia that are used in the design.
#[test]
fn outlines_have_the_moments_of_their_shapes() {
    let mut noise = Noise::of(2901);
    for kind in 0..200 {
        let shape = a_shape(&mut noise, kind);
        let place = [noise.between(-0.5, 0.5), noise.between(-0.1, 0.1)];
        let weight = Counterweight::new("1", noise.between(0.1, 10.0), place, shape);
        assert_eq!(weight.shape(), shape);
        let (mut area, mut first, mut second) = moments(&weight.polygon(4096));
        if let CounterweightShape::Ring { inner_radius, .. } = shape {
            let bore = Counterweight::new("1", 1.0, place, CounterweightShape::Disc { radius: inner_radius });
            let (less, moment, inertia) = moments(&bore.polygon(4096));
            (area, first, second) = (area - less, first - moment, second - inertia);
        }
        let centre = first / area;
        let gyration = second / area - centre.norm_sqr();
        let size = weight.around().1.max(weight.length);
        assert!((area - shape.body().mass).abs() < 1e-6 * size * size, "{shape:?}: {area}");
        assert!((centre - Vector::new(place[0], place[1])).norm() < 1e-6 * size, "{shape:?}: {centre}");
        assert!((gyration - shape.gyration_squared()).abs() < 1e-6 * size * size, "{shape:?}: {gyration}");
        let (ends, within) = weight.around();
        for corner in weight.polygon(64) {
            let along = ends[1] - ends[0];
            let share = if along.norm_sqr() > 0.0 {
                (((corner - ends[0]) * along.conj()).re / along.norm_sqr()).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let away = (corner - ends[0] - along * share).norm();
            assert!(away < 1.001 * within + 1e-12, "{shape:?}: {away} beyond {within}");
        }
    }
}

/// Another mass of the same plate: the thickness stays, and so does the inner radius or the width.
#[test]
fn a_counterweight_of_another_mass_keeps_its_thickness() {
    let mut noise = Noise::of(2902);
    for kind in 0..100 {
        let weight = Counterweight::new("1", noise.between(0.1, 5.0), [0.1, 0.0], a_shape(&mut noise, kind));
        let changed = weight.with_mass(noise.between(0.1, 5.0));
        let [before, after] = [&weight, &changed].map(|one| one.thickness(7850.0).expect("a plate"));
        assert!((after - before).abs() < 1e-12 * before, "{:?}: {before} m, then {after} m", weight.shape());
        assert_eq!(
            (weight.inner_radius, weight.width, weight.half),
            (changed.inner_radius, changed.width, changed.half)
        );
    }
}

/// Returns the distance of a point from the material of a counterweight on its axis, by a fine outline.
fn distance(weight: &Counterweight, pin: f64) -> f64 {
    let p = Vector::new(pin, 0.0);
    let to = |polygon: &[Vector]| {
        let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
        let each = sides.map(|(a, b)| {
            let share = ((p - a) * (b - a).conj()).re / (b - a).norm_sqr();
            (p - a - (b - a) * share.clamp(0.0, 1.0)).norm()
        });
        each.fold(f64::INFINITY, f64::min)
    };
    let edge = to(&weight.polygon(4096));
    match weight.shape() {
        CounterweightShape::Ring { inner_radius, .. } => {
            let away = (p - Vector::new(weight.at, weight.across)).norm();
            if away < weight.radius { inner_radius - away } else { edge }
        }
        _ => {
            let sides: f64 = {
                let polygon = weight.polygon(4096);
                let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
                sides.map(|(a, b)| cross(a - p, b - p).atan2(((a - p) * (b - p).conj()).re)).sum()
            };
            if sides > 3.0 { -edge } else { edge }
        }
    }
}

/// The distances that keep a counterweight clear along its link, and how far a pin lies within the clearance, are one
/// rule.
#[test]
fn the_distances_from_pins_are_where_the_overlap_ends() {
    let mut noise = Noise::of(2904);
    for kind in 0..500 {
        let across = if kind % 3 == 0 { 0.0 } else { noise.between(-0.3, 0.3) };
        let place = [noise.between(-0.5, 0.5), across];
        let weight = Counterweight::new("1", 1.0, place, a_shape(&mut noise, kind));
        let clearance = noise.between(0.0, 0.03);
        let [to_root, to_tip] = weight.clear_along(clearance);
        for (pin, beyond) in [(weight.at - to_root, -1e-6), (weight.at + to_tip, 1e-6)] {
            let [here, farther] = [pin, pin + beyond].map(|pin| weight.overlap(pin, clearance));
            assert!(here < 1e-12 && farther <= here.max(0.0), "{weight:?}: {here}, {farther}");
            // Only where nothing is in the way, or the pin is in the bore, the distance is no edge.
            let is_free = to_root == 0.0 && to_tip == 0.0;
            assert!(is_free || here > -1e-12, "{weight:?}: {here}");
        }
        let nearer = weight.overlap(weight.at + 0.5 * (to_tip - to_root), clearance);
        let is_bored = weight.inner_radius > 0.0;
        assert!(is_bored || nearer > 0.0 || (to_root, to_tip) == (0.0, 0.0), "{weight:?}: {nearer}");
    }
}

/// Counterweights of every form balance a machine; clear of pins, no pin is nearer to their material than the clearance.
#[test]
fn every_form_balances_and_is_clear_of_pins() {
    let bare = family_machine("nine-link-bare");
    let forms = [
        CounterweightForm::Ring(0.03),
        CounterweightForm::Ring(0.004),
        CounterweightForm::HalfRing(0.025),
        CounterweightForm::HalfRing(0.0),
        CounterweightForm::Box(0.05),
    ];
    // A clearance beyond the bore of half a ring, whose corners are then nearest to the pin.
    let wide = [0.03, 0.012].map(|bore| (CounterweightForm::HalfRing(bore), Some(0.05)));
    for (form, clearance) in forms.into_iter().flat_map(|form| [(form, None), (form, Some(0.006))]).chain(wide) {
        let stock = CounterweightStock { form, ..STEEL };
        let anywhere = CounterweightSite::anywhere(&bare);
        let request =
            CounterweightSpec { clearance, ..CounterweightSpec::least(Objective::inertia(), anywhere, stock) };
        let placed = place_weights(&bare, &request).expect("an answer");
        assert!(placed.is_certified(), "{form:?}: {}", placed.gap);
        let inertia = Inertia::of(&placed.machine);
        assert!(inertia.force_residual() < 1e-12 && inertia.invariance_residual() < 1e-12, "{form:?}");
        assert!((placed.value - inertia.momenta().iter().sum::<f64>()).abs() < 1e-9, "{form:?}");
        let back = parse(&to_toml(&placed.machine), "written").expect("read again");
        assert_eq!(back.spec(), placed.machine.spec());
        for weight in &placed.machine.spec().counterweights {
            assert!((weight.thickness(stock.density).expect("a plate") - stock.thickness).abs() < 1e-12);
            let link = placed.machine.links().iter().position(|link| link.name == weight.link).expect("its link");
            for pin in &placed.machine.resolved_links()[link].pins {
                let away = distance(weight, *pin);
                assert!(
                    clearance.is_none_or(|clearance| away > clearance - 1e-6),
                    "{form:?}: pin at {pin} m is {away} m from {weight:?}"
                );
            }
        }
    }
}

/// Half a ring wraps around the pin at its link's root: with a bore it comes nearer than a disc of its mass.
#[test]
fn half_rings_reach_around_the_root() {
    let bare = family_machine("two-drive");
    let with = |form| {
        let stock = CounterweightStock { form, ..STEEL };
        let anywhere = CounterweightSite::anywhere(&bare);
        let mut request = CounterweightSpec::least(Objective::inertia(), anywhere, stock);
        request.clearance = Some(0.005);
        place_weights(&bare, &request).expect("an answer")
    };
    let wrapped = with(CounterweightForm::HalfRing(0.02));
    let around = wrapped.machine.spec().counterweights.iter().any(|weight| {
        let to_tip = weight.circle_at() + weight.inner_radius;
        weight.at < 0.0 && to_tip > 0.0 && weight.half
    });
    assert!(around, "{:?}", wrapped.machine.spec().counterweights);
}

/// A ring whose bore is nothing is a disc, and so is its answer.
#[test]
fn a_ring_without_a_bore_is_a_disc() {
    let bare = family_machine("nine-link-bare");
    let least = |form| {
        let stock = CounterweightStock { form, ..STEEL };
        let request = CounterweightSpec::least(Objective::inertia(), CounterweightSite::anywhere(&bare), stock);
        place_weights(&bare, &request).expect("an answer").value
    };
    let disc = least(CounterweightForm::Disc);
    assert!((least(CounterweightForm::Ring(0.0)) - disc).abs() < 1e-9);
    // A bore spreads the mass: more inertia, and the more the wider.
    let [narrow, wide] = [0.01, 0.05].map(|inner| least(CounterweightForm::Ring(inner)));
    assert!(disc < narrow && narrow < wide, "{disc} {narrow} {wide}");
}

#[test]
fn sizes_that_give_no_shape_are_refused() {
    let machine = family_machine("two-drive");
    let refusal = |change: &dyn Fn(&mut Counterweight)| {
        let mut spec = machine.spec().clone();
        let link = spec.links[0].name.clone();
        let mut weight = Counterweight::new(link, 1.0, [0.1, 0.0], CounterweightShape::Disc { radius: 0.05 });
        change(&mut weight);
        spec.counterweights = vec![weight];
        Machine::new(spec).expect_err("no shape").to_string()
    };
    assert!(refusal(&|weight| weight.inner_radius = 0.06).contains("inner_radius"));
    assert!(refusal(&|weight| weight.length = 0.1).contains("not both"));
    assert!(refusal(&|weight| (weight.radius, weight.half) = (0.0, true)).contains("radius"));
    assert!(refusal(&|weight| (weight.radius, weight.width) = (0.0, 0.1)).contains("length above 0"));
    assert!(refusal(&|weight| (weight.radius, weight.length) = (0.0, 0.1)).contains("width above 0"));
    let bare = family_machine("nine-link-bare");
    for form in [CounterweightForm::Ring(-0.01), CounterweightForm::Box(0.0), CounterweightForm::HalfRing(f64::NAN)] {
        let stock = CounterweightStock { form, ..STEEL };
        let request = CounterweightSpec::least(Objective::mass(), CounterweightSite::anywhere(&bare), stock);
        assert!(matches!(place_weights(&bare, &request), Err(CounterweightError::OutOfRange { .. })), "{form:?}");
    }
}
