//! The reach of a last platform, against poses, a search for poses, and lines across fine outlines.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::{DVector, Matrix3, Vector3};
use stillbase::mechanics::assembly::{Block, Mount};
use stillbase::mechanics::planar::{Vector, unit};
use stillbase::picture::scene::Mesh;
use stillbase::picture::scene::platform_reach::{BlockReach, PlatformReach};
use stillbase::picture::scene::stage::{OutlineQuery, OutlineSubject, Outlined, Workspace};
use stillbase::planning::platform::{ChainBlock, PlatformChain, pose_at};
use stillbase::planning::pose_space::PoseSpace;
use stillbase::query::{Queries, Shared};

use crate::support::random::{a_pose, a_space};
use crate::support::{Noise, family_machine};

/// Largest deviation of fine outlines, m.
const FINE: f64 = 2e-5;

/// Two blocks, one on the other, each at a b.
struct Carried {
    spaces: [Arc<PoseSpace>; 2],
    blocks: [Block; 2],
    b: [f64; 2],
    chain: PlatformChain,
    reach: PlatformReach,
}

fn direction(noise: &mut Noise) -> Vector3<f64> {
    Vector3::from_fn(|_, _| noise.between(-1.0, 1.0)).normalize()
}

fn axes(noise: &mut Noise) -> Matrix3<f64> {
    let x = direction(noise);
    let y = x.cross(&direction(noise)).normalize();
    Matrix3::from_columns(&[x, y, x.cross(&y)])
}

fn workspace(space: &Arc<PoseSpace>) -> Arc<Workspace> {
    let known = Workspace::known(space).map(Arc::new);
    known.unwrap_or_else(|| {
        let subject = OutlineSubject::Held(Shared(space.clone()));
        match Option::clone(&Queries::default().ask::<OutlineQuery>(&subject)) {
            Some(Outlined::Held(workspace)) => workspace,
            _ => panic!("no workspace"),
        }
    })
}

impl Carried {
    /// Returns random machines in planes that cross at any angle, or in parallel ones; `of` makes their pose spaces.
    fn new(noise: &mut Noise, parallel: bool, of: &mut dyn FnMut(&mut Noise, usize) -> PoseSpace) -> Self {
        let below = axes(noise);
        let turn = nalgebra::Rotation3::from_axis_angle(
            &nalgebra::Unit::new_normalize(below.column(2).into_owned()),
            noise.between(0.0, TAU),
        );
        let above = if parallel { turn * below } else { axes(noise) };
        let spaces = [0, 1].map(|i| Arc::new(of(noise, i)));
        let at = [0, 1].map(|_| Vector3::from_fn(|_, _| noise.between(-0.2, 0.2)));
        let heights = [0, 1].map(|_| noise.between(-0.2, 0.2));
        let blocks = [0, 1].map(|i| {
            // Where it reaches is stated by its pose space alone; the machine has the height of the end effector.
            let mut spec = family_machine("two-drive-balanced").spec().clone();
            spec.payload.axial = heights[i];
            let machine = stillbase::mechanics::machine::Machine::new(spec).expect("a machine");
            let mount = Mount { on: (i == 1).then_some(0), at: at[i], axes: [below, above][i] };
            Block::new(["below", "above"][i], machine, mount)
        });
        let b = [0, 1].map(|i| noise.between(0.0, spaces[i].period()));
        let chain = (0..2).map(|i| ChainBlock::of(&blocks[i], spaces[i].clone(), b[i])).collect();
        let reach = |i: usize| BlockReach {
            set: workspace(&spaces[i]).lines(),
            lambda_sum: spaces[i].lambda_sum(),
            axes: blocks[i].mount.axes,
            height: heights[i],
        };
        let reach = PlatformReach::new([0, 1], [reach(0), reach(1)], at[1]);
        Self { b, chain: PlatformChain::new(chain), reach, spaces, blocks }
    }

    /// Place of the platform from the mount of the carrier, m, for random angles within all limits.
    fn place(&self, noise: &mut Noise) -> Vector3<f64> {
        let ends = [0, 1].map(|i| self.spaces[i].forward(&a_pose(noise, &self.spaces[i]), self.b[i]));
        let [p, q] = [0, 1].map(|i| self.blocks[i].mount.in_space(ends[i], self.blocks[i].platform_height()));
        p + self.blocks[1].mount.at + q
    }

    /// Returns whether a search from many starts finds a pose at a place.
    fn is_found(&self, p: &Vector3<f64>) -> Result<(), f64> {
        let (middle, _) = self.chain.middles();
        let near = DVector::from_column_slice(middle.as_slice());
        pose_at(&self.chain, &(p + self.blocks[0].mount.at), &near).map(|_| ()).map_err(|nearest| nearest.distance)
    }

    fn reaches_area(&self) -> [bool; 2] {
        [0, 1].map(|i| self.spaces[i].reaches_area())
    }
}

/// A mesh with which places are compared.
struct Solid(Vec<[Vector3<f64>; 3]>);

impl Solid {
    fn of(mesh: &Mesh) -> Self {
        let place = |i: u32| Vector3::from(mesh.positions[i as usize].map(f64::from));
        Self(mesh.triangles.iter().map(|t| t.map(place)).collect())
    }

    fn distance(&self, p: &Vector3<f64>) -> f64 {
        self.0.iter().map(|t| from_triangle(p, t)).fold(f64::INFINITY, f64::min)
    }

    /// Number of triangles that a ray crosses.
    fn crossings(&self, p: &Vector3<f64>, way: &Vector3<f64>) -> usize {
        let crosses = |[a, b, c]: &[Vector3<f64>; 3]| {
            let (e, f, t) = (b - a, c - a, p - a);
            let h = way.cross(&f);
            let scale = 1.0 / e.dot(&h);
            let (x, g) = (scale * t.dot(&h), t.cross(&e));
            let y = scale * way.dot(&g);
            x >= 0.0 && y >= 0.0 && x + y <= 1.0 && scale * f.dot(&g) > 0.0
        };
        self.0.iter().filter(|t| crosses(t)).count()
    }

    /// Whether a ray leaves it.
    fn holds(&self, noise: &mut Noise, p: &Vector3<f64>) -> bool {
        self.crossings(p, &direction(noise)) % 2 == 1
    }

    fn volume(&self) -> f64 {
        self.0.iter().map(|[a, b, c]| a.dot(&b.cross(c)) / 6.0).sum()
    }

    fn area(&self) -> f64 {
        self.0.iter().map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm()).sum()
    }

    /// Sum of all faces as vectors, m²: zero if it is closed.
    fn open_area(&self) -> f64 {
        self.0.iter().map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a))).sum::<Vector3<f64>>().norm()
    }

    fn extent(&self) -> [Vector3<f64>; 2] {
        let all = self.0.iter().flatten();
        let none = [f64::INFINITY, f64::NEG_INFINITY].map(Vector3::repeat);
        all.fold(none, |[low, high], p| [low.inf(p), high.sup(p)])
    }

    fn around(&self, noise: &mut Noise) -> Vector3<f64> {
        let [low, high] = self.extent();
        Vector3::from_fn(|i, _| {
            let wider = 0.05 * (high[i] - low[i]) + 0.01;
            noise.between(low[i] - wider, high[i] + wider)
        })
    }
}

fn from_triangle(p: &Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> f64 {
    let from_side = |a: &Vector3<f64>, b: &Vector3<f64>| {
        let way = b - a;
        let share = ((p - a).dot(&way) / way.norm_squared().max(1e-300)).clamp(0.0, 1.0);
        (p - a - share * way).norm()
    };
    let normal = (b - a).cross(&(c - a));
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(a, b)| (*b - *a).cross(&(p - *a)).dot(&normal) >= 0.0);
    let sides = from_side(a, b).min(from_side(b, c)).min(from_side(c, a));
    match inside && normal.norm() > 0.0 {
        true => ((p - a).dot(&normal) / normal.norm()).abs().min(sides),
        false => sides,
    }
}

/// Two planes that cross, seen along their common direction: fine outlines in (s, across).
struct Crossed {
    /// Vectors by which a place gives s, v and w.
    dual: Matrix3<f64>,
    origin: Vector3<f64>,
    outlines: [Vec<Vec<Vector>>; 2],
    areas: [bool; 2],
}

impl Crossed {
    fn of(two: &Carried) -> Self {
        let normals = [0, 1].map(|i| two.blocks[i].mount.axes.column(2).into_owned());
        let u = normals[0].cross(&normals[1]).normalize();
        let across = normals.map(|normal| normal.cross(&u));
        let dual = Matrix3::from_columns(&[u, across[0], across[1]]).try_inverse().expect("they cross");
        let outlines = [0, 1].map(|i| {
            let outline = two.spaces[i].outline_within(two.b[i], FINE, &mut |_| true).expect("an outline");
            let of = if outline.loops.is_empty() { vec![outline.curve] } else { outline.loops };
            let closed = two.spaces[i].reaches_area();
            let place = |[x, y]: [f64; 2]| {
                let p = two.blocks[i].mount.in_space(Vector::new(x, y), 0.0);
                Vector::new(p.dot(&u), p.dot(&across[i]))
            };
            of.into_iter()
                .map(|mut line| {
                    line.extend(line.first().copied().filter(|_| closed));
                    line.into_iter().map(place).collect()
                })
                .collect()
        });
        let high = |i: usize| two.blocks[i].platform_height() * normals[i];
        Self { dual, origin: two.blocks[1].mount.at + high(0) + high(1), outlines, areas: two.reaches_area() }
    }

    /// Where a line across meets an outline.
    fn met(&self, i: usize, level: f64) -> Vec<f64> {
        let pairs = self.outlines[i].iter().flat_map(|line| line.windows(2));
        let met = pairs.filter(|pair| (pair[0].im > level) != (pair[1].im > level));
        let at =
            |pair: &[Vector]| pair[0].re + (level - pair[0].im) / (pair[1].im - pair[0].im) * (pair[1].re - pair[0].re);
        let mut met: Vec<f64> = met.map(at).collect();
        met.sort_by(f64::total_cmp);
        if self.areas[i] { met } else { met.into_iter().flat_map(|s| [s, s]).collect() }
    }

    /// Returns whether a place is in the sum, and whether it is beside all parts of its line, not between them.
    fn holds(&self, p: &Vector3<f64>) -> (bool, bool) {
        let at = self.dual * (p - self.origin);
        let [first, second] = [self.met(0, at[1]), self.met(1, at[2])];
        let pairs = first.chunks(2).flat_map(|a| second.chunks(2).map(move |b| [a[0] + b[0], a[1] + b[1]]));
        let pairs: Vec<[f64; 2]> = pairs.collect();
        let holds = pairs.iter().any(|[low, high]| *low <= at[0] && at[0] <= *high);
        let is_beside = pairs.iter().all(|[low, _]| at[0] < *low) || pairs.iter().all(|[_, high]| at[0] > *high);
        (holds, is_beside)
    }
}

/// Pose spaces of random chains of the given numbers of drives, by the way of any number of drives if it is marked with
/// `GENERAL`; `FAMILY` is a machine of the family.
fn spaces(noise: &mut Noise, drives: [usize; 2], i: usize) -> PoseSpace {
    match drives[i] {
        FAMILY => PoseSpace::of(&family_machine("nine-link-geared-balanced")).expect("it has a b"),
        GENERAL => a_space(noise, 3).1,
        n => PoseSpace::of(&a_space(noise, n).0).expect("it has a b"),
    }
}

const FAMILY: usize = 0;
const GENERAL: usize = 9;
const SOLIDS: [[usize; 2]; 6] = [[3, 3], [3, 2], [2, 3], [FAMILY, 2], [GENERAL, 3], [FAMILY, 3]];

#[test]
fn every_pose_is_in_the_surface_and_nothing_beside_it_is_reached() {
    let noise = &mut Noise::of(51);
    let (mut beside, mut between) = (0, 0);
    for round in 0..12 {
        let drives = SOLIDS[round % SOLIDS.len()];
        let two = Carried::new(noise, false, &mut |noise, i| spaces(noise, drives, i));
        let (mesh, _) = two.reach.at(two.b);
        let (solid, error) = (Solid::of(&mesh), 2.0 * two.reach.chord());
        for _ in 0..250 {
            let p = two.place(noise);
            assert!(solid.holds(noise, &p) || solid.distance(&p) < error, "{drives:?} {round}: {p:?} is left out");
        }
        let crossed = Crossed::of(&two);
        for k in 0..200 {
            // Some anywhere, some near.
            let near = two.place(noise) + noise.between(0.0, 0.1) * direction(noise);
            let p = if k % 2 == 0 { solid.around(noise) } else { near };
            let (holds, (reached, is_beside)) = (solid.holds(noise, &p), crossed.holds(&p));
            // A ray may meet an edge.
            let differs = holds != reached && solid.holds(noise, &p) != reached;
            assert!(!differs || solid.distance(&p) < error, "{drives:?} {round}: {p:?} reached: {reached}");
            beside += usize::from(!holds);
            between += usize::from(!holds && !is_beside);
            // A descent may miss a pose, but finds none where there is none.
            if k < 5 && !holds && solid.distance(&p) > error {
                let found = two.is_found(&p);
                assert!(found.is_err_and(|far| far > 0.25 * error), "{drives:?} {round}: {p:?} {found:?}");
            }
        }
    }
    assert!(beside > 300 && between > 8, "{beside} {between}");
}

#[test]
fn the_surface_is_closed_and_has_the_volume_of_what_is_reached() {
    let noise = &mut Noise::of(52);
    for round in 0..12 {
        let drives = SOLIDS[round % SOLIDS.len()];
        let two = Carried::new(noise, false, &mut |noise, i| spaces(noise, drives, i));
        let (mesh, lines) = two.reach.at(two.b);
        let solid = Solid::of(&mesh);
        assert!(solid.open_area() < 1e-5 * solid.area(), "{drives:?} {round}: {} m² open", solid.open_area());
        let crossed = Crossed::of(&two);
        let [low, high] = solid.extent();
        let (count, size) = (3_000, high - low);
        let within =
            (0..count).filter(|_| crossed.holds(&(low + Vector3::from_fn(|i, _| noise.between(0.0, size[i])))).0);
        let (share, box_volume) = (within.count() as f64 / f64::from(count), size.product());
        let (want, sigma) = (share * box_volume, box_volume * (share * (1.0 - share) / f64::from(count)).sqrt());
        let slack = 4.0 * sigma + two.reach.chord() * solid.area();
        assert!((solid.volume() - want).abs() < slack, "{drives:?} {round}: {} for {want} m³", solid.volume());
        for (normal, at) in mesh.normals.iter().zip(&mesh.positions) {
            let length: f32 = normal.iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 1e-5 && at.iter().all(|x| x.is_finite()));
        }
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| Vector3::from(mesh.positions[i as usize].map(f64::from)));
            let face = (b - a).cross(&(c - a));
            let turned = t.iter().any(|i| face.dot(&Vector3::from(mesh.normals[*i as usize].map(f64::from))) < 0.0);
            assert!(!turned || face.norm() < 1e-7, "{drives:?} {round}: a normal points inside");
        }
        // Lines lie on the surface.
        for p in lines.iter().flatten().step_by(41) {
            let off = solid.distance(&Vector3::from(p.map(f64::from)));
            assert!(off < 1e-5, "{drives:?} {round}: a line is {off} m off");
        }
        assert!(lines.len() < 400 && lines.len() > 3, "{drives:?} {round}: {} lines", lines.len());
    }
}

/// Two curves span a sheet; in parallel planes the sum is flat.
#[test]
fn sheets_and_flat_sums_hold_what_is_reached_and_no_more() {
    let noise = &mut Noise::of(53);
    let cases = [
        (false, [2, 2]),
        (true, [3, 3]),
        (true, [3, 2]),
        (true, [2, 2]),
        (true, [2, 3]),
        (true, [FAMILY, 2]),
        (true, [FAMILY; 2]),
    ];
    for (parallel, drives) in cases {
        for round in 0..2 {
            let two = Carried::new(noise, parallel, &mut |noise, i| spaces(noise, drives, i));
            let (mesh, lines) = two.reach.at(two.b);
            let (solid, error) = (Solid::of(&mesh), 2.5 * two.reach.chord());
            assert!(!lines.is_empty() && !solid.0.is_empty());
            for _ in 0..200 {
                let p = two.place(noise);
                assert!(solid.distance(&p) < error, "{parallel} {drives:?} {round}: {} m off", solid.distance(&p));
            }
            // Just beside the outline of a flat sum nothing is reached.
            let normal = two.blocks[0].mount.axes.column(2).into_owned();
            let pairs: Vec<_> = lines.iter().flat_map(|line| line.windows(2)).filter(|_| parallel).collect();
            for pair in pairs.iter().step_by(pairs.len() / 12 + 1) {
                let [a, b] = [pair[0], pair[1]].map(|p| Vector3::from(p.map(f64::from)));
                for side in [-3.0, 3.0] {
                    let p = 0.5 * (a + b) + side * error * (b - a).cross(&normal).normalize();
                    if solid.distance(&p) > error {
                        let found = two.is_found(&p);
                        assert!(found.is_err_and(|far| far > 0.2 * error), "{drives:?} {round}: {p:?} {found:?}");
                    }
                }
            }
            for k in 0..24 {
                let mut p = solid.around(noise);
                if parallel {
                    p -= normal * normal.dot(&(p - solid.0[0][0]));
                } else if k % 2 == 0 {
                    p = two.place(noise) + noise.between(0.0, 0.1) * direction(noise);
                }
                if solid.distance(&p) > error {
                    let found = two.is_found(&p);
                    assert!(
                        found.is_err_and(|far| far > 0.2 * error),
                        "{parallel} {drives:?} {round}: {p:?} {found:?}"
                    );
                } else if parallel && !lines_are_near(&lines, &p, error) {
                    // The mesh has single precision.
                    let found = two.is_found(&p).map_or_else(|far| far, |()| 0.0);
                    assert!(found < 1e-6, "{drives:?} {round}: {p:?} is {found} m from what is reached");
                    assert_eq!(solid.crossings(&(p - normal), &normal), 1, "{drives:?} {round}: {p:?}");
                }
            }
        }
    }
}

fn lines_are_near(lines: &[Vec<[f32; 3]>], p: &Vector3<f64>, error: f64) -> bool {
    let place = |p: &[f32; 3]| Vector3::from(p.map(f64::from));
    let pairs = lines.iter().flat_map(|line| line.windows(2));
    pairs.map(|pair| [place(&pair[0]), place(&pair[1]), place(&pair[1])]).any(|t| from_triangle(p, &t) < error)
}

/// The surface is made again for another b only, and each b turns its own set about its pin.
#[test]
fn it_is_made_again_for_another_b_only() {
    let noise = &mut Noise::of(54);
    let mut two = Carried::new(noise, false, &mut |noise, i| spaces(noise, [FAMILY, 3], i));
    let mut b = two.b;
    let made = two.reach.remade(|i| Some(b[i])).expect("a surface");
    assert!(two.reach.remade(|i| Some(b[i])).is_none());
    assert!(two.reach.remade(|i| (i == 0).then_some(1.0)).is_none());
    // A whole turn of one set is nothing.
    b[1] += two.spaces[1].period();
    let again = two.reach.remade(|i| Some(b[i])).expect("another b");
    assert!((Solid::of(&made).volume() - Solid::of(&again).volume()).abs() < 1e-6);
    b[1] += 0.3;
    let turned = two.reach.remade(|i| Some(b[i])).expect("another b");
    assert!((Solid::of(&made).volume() - Solid::of(&turned).volume()).abs() > 1e-6);
    assert!((unit(two.spaces[1].turn(two.spaces[1].period())) - unit(0.0)).norm() < 1e-9);
}
