//! Labels of the scene in the window: nothing overlaps, in any machine, size, theme, view and layout, and nothing jumps.

use egui::{Pos2, Rect, Vec2, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{AppState, Layout, PictureOrder, Preferences, SessionCommand, Shot, Switch, ViewChange};
use stillbase::mechanics::machine;
use stillbase::picture::charts::choice::PlotChange;
use stillbase::picture::notation::{NameOrder, Notation};
use stillbase::picture::paint::SceneViewport;
use stillbase::picture::paint::labels::{Placement, forget, last};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::place;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::scenario::Scenario;

use super::{Window, drag, pull, seen, session, window_liked};
use crate::Test;

pub const TESTS: &[Test] = tests![
    nothing_overlaps_in_any_machine,
    nothing_overlaps_beside_another_run,
    labels_do_not_jump,
    every_area_of_turns_is_named_and_whole,
    the_table_of_runs_fits,
    no_card_of_the_scene_shows_under_a_window,
    what_is_dragged_stays_in_the_scene,
];

/// In a picture every boundary of the areas of turns has a label of its own, on it, and all areas lie within the frame.
fn every_area_of_turns_is_named_and_whole() {
    let order = PictureOrder::new(Shot::View(ViewKind::Flat), Theme::Dark, [1280, 800]);
    for name in ["spot", "ets-vii-silent"] {
        let scenario = Scenario::builtin(name).expect("built in");
        let mut app_state = AppState::new(scenario, Theme::Dark).expect("it runs");
        let (scene, camera) = order.scene(&mut app_state);
        let reach = app_state.stage().linkage().reach() as f32;
        let mut places: Vec<[f32; 3]> = Vec::new();
        for i in 0..5 {
            let label = scene.labels.iter().find(|label| label.name == format!("turns/{i}/label"));
            let label = label.unwrap_or_else(|| panic!("{name}: area {i} has no label"));
            let line = scene.lines.iter().find(|line| line.name == format!("turns/{i}/boundary")).expect("a boundary");
            let far = |a: [f32; 3], b: [f32; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
            let m = &line.world_from_item;
            let world = |p: &[f32; 3]| [0, 1, 2].map(|k| m[0][k] * p[0] + m[1][k] * p[1] + m[2][k] * p[2] + m[3][k]);
            let points: Vec<[f32; 3]> = line.strips.iter().flatten().map(world).collect();
            let nearest = points.iter().map(|p| far(*p, label.at)).fold(f32::INFINITY, f32::min);
            assert!(nearest < 1e-4 * reach, "{name}: label {i} is {nearest} m off its boundary");
            assert!(places.iter().all(|other| far(*other, label.at) > 0.1 * reach), "{name}: labels of {i} are near");
            places.push(label.at);
            for p in &points {
                let seen = camera.project(p.map(f64::from), 1.6).expect("before the camera");
                assert!(
                    seen.iter().all(|x| (0.0..=1.0).contains(x)),
                    "{name}: {p:?} of area {i} is out of the picture"
                );
            }
        }
    }
}

const SIZES: [[f32; 2]; 4] = [[960.0, 600.0], [1280.0, 800.0], [1440.0, 900.0], [1920.0, 1200.0]];

/// The built-in scenarios, and each machine that none of them has.
fn gallery() -> Vec<Scenario> {
    let case = Scenario::builtin("case-3").expect("built in");
    let mut all: Vec<Scenario> = Scenario::builtins().cloned().collect();
    for machine in machine::builtins() {
        if !all.iter().any(|scenario| scenario.machine.name() == machine.name()) {
            all.push(Scenario { name: machine.name().to_owned(), machine: machine.clone(), ..case.clone() });
        }
    }
    all
}

fn carry_out(h: &mut Window, change: ViewChange) {
    h.state_mut().app_state_mut().carry_out(change);
}

/// Texts on the screen with their rectangles, but for labels of a scene.
fn texts(h: &Window) -> Vec<(Rect, String)> {
    fn of(shape: &egui::Shape, clip: Rect, all: &mut Vec<(Rect, String)>) {
        match shape {
            egui::Shape::Text(text) => {
                let rect = text.galley.rect.translate(text.pos.to_vec2()).intersect(clip);
                if rect.is_positive() {
                    all.push((rect, text.galley.text().to_owned()));
                }
            }
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| of(shape, clip, all)),
            _ => {}
        }
    }
    let mut all = Vec::new();
    h.output().shapes.iter().for_each(|clipped| of(&clipped.shape, clipped.clip_rect, &mut all));
    all
}

/// Triangles of the opaque solids of a scene on the screen.
fn triangles(placement: &Placement) -> Vec<[Pos2; 3]> {
    let spot = SceneViewport { rect: placement.view(), camera: placement.camera };
    let solids =
        placement.scene.solids.iter().filter(|solid| solid.name.starts_with("machine") && solid.colour[3] > 0.9);
    let mut all = Vec::new();
    for solid in solids {
        let mesh = &placement.scene.model.meshes[solid.mesh];
        let seen = |p: &[f32; 3]| spot.screen(place(&solid.world_from_item, *p).map(f64::from));
        let points: Vec<Option<Pos2>> = mesh.positions.iter().map(seen).collect();
        all.extend(mesh.triangles.iter().filter_map(|corners| {
            let [a, b, c] = corners.map(|i| points[i as usize]);
            Some([a?, b?, c?])
        }));
    }
    all
}

/// Whether a triangle and a rectangle meet: no line along a side of either lies between them.
fn meet(triangle: &[Pos2; 3], rect: Rect) -> bool {
    if !Rect::from_points(triangle).intersects(rect) {
        return false;
    }
    let corners = [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()];
    let sides = (0..3).map(|i| (triangle[(i + 1) % 3] - triangle[i]).rot90());
    let mut normals = sides.chain([vec2(1.0, 0.0), vec2(0.0, 1.0)]).filter(|n| n.length_sq() > 1e-9);
    let range = |points: &[Pos2], n: Vec2| {
        points.iter().map(|p| p.to_vec2().dot(n)).fold([f32::MAX, f32::MIN], |[a, b], x| [a.min(x), b.max(x)])
    };
    !normals.any(|n| {
        let ([a, b], [c, d]) = (range(triangle, n), range(&corners, n));
        b <= c || d <= a
    })
}

/// What is wrong with the labels of a scene.
fn faults(h: &Window, number: usize, found: &mut Vec<String>, at: &str) -> usize {
    let Some(placement) = last(&h.ctx, number) else { return 0 };
    let triangles = triangles(&placement);
    let discs = placement.scene.markers.iter().filter(|marker| marker.radius >= 3.0);
    let spot = SceneViewport { rect: placement.view(), camera: placement.camera };
    let discs: Vec<(Pos2, f32)> =
        discs.filter_map(|marker| Some((spot.screen(marker.at.map(f64::from))?, marker.radius))).collect();
    let texts = texts(h);
    for (i, own) in placement.all.iter().enumerate() {
        let (rect, words) = (own.place, own.label.text.as_str());
        let mut wrong = |what: &str| found.push(format!("{at}, scene {number}: \"{words}\" {what}, {rect:?}"));
        if !placement.view().contains_rect(rect) {
            wrong("is cut off");
        }
        for other in &placement.all[..i] {
            if other.place.shrink(1.0).intersects(rect.shrink(1.0)) {
                wrong(&format!("lies over \"{}\"", other.label.text));
            }
        }
        if triangles.iter().any(|triangle| meet(triangle, rect)) {
            wrong("lies across the machine");
        }
        if let Some((at, _)) = discs.iter().find(|(at, radius)| rect.distance_to_pos(*at) < *radius) {
            wrong(&format!("lies over a disc at {at:?}"));
        }
        for (place, text) in &texts {
            if place.shrink(1.0).intersects(rect.shrink(1.0)) && (place.min - rect.min).length() > 0.5 {
                wrong(&format!("lies under the text \"{text}\""));
            }
        }
    }
    placement.all.len()
}

fn picture(h: &mut Window, name: &str) {
    let Some(folder) = std::env::var_os("STILLBASE_LOOK") else { return };
    let only = std::env::var("STILLBASE_LOOK_AT").unwrap_or_default();
    if only.split(',').any(|word| name.contains(word)) {
        h.render().expect("drawn").save(std::path::Path::new(&folder).join(format!("{name}.png"))).expect("saved");
    }
}

/// A view of a window, and whether another run stands beside it.
type Look = (ViewKind, Layout, bool, Theme);

/// What is wrong in every machine of the gallery, in every size and look.
fn look_at_all(looks: impl Fn(usize) -> Vec<Look>) {
    let mut h = window_liked(SIZES[0], &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(2);
    let (mut found, mut placed, mut all) = (Vec::new(), 0, 0);
    for scenario in gallery() {
        h.state_mut().app_state_mut().carry_out(SessionCommand::Open(Box::new(scenario.clone())));
        h.run_steps(2);
        for (k, size) in SIZES.into_iter().enumerate() {
            h.set_size(Vec2::from(size));
            let mut before = None;
            for (view, layout, pair, theme) in looks(k) {
                carry_out(&mut h, ViewChange::Theme(theme));
                carry_out(&mut h, ViewChange::Layout(layout));
                carry_out(&mut h, ViewChange::Kind(view));
                carry_out(&mut h, ViewChange::Switch(Switch::Pair, pair));
                (0..2).for_each(|number| forget(&h.ctx, number));
                let recoloured = Some((view, layout, pair)) == before;
                before = Some((view, layout, pair));
                h.run_steps(if pair { 4 } else { 2 - usize::from(recoloured) });
                let shown = if pair { "pair" } else { "alone" };
                let at = format!("{}-{}-{}-{view:?}-{layout:?}-{shown}-{theme:?}", scenario.name, size[0], size[1]);
                for number in 0..2 {
                    placed += faults(&h, number, &mut found, &at);
                    all += last(&h.ctx, number).map_or(0, |placement| placement.scene.labels.len());
                }
                picture(&mut h, &at);
            }
            carry_out(&mut h, ViewChange::Switch(Switch::Pair, false));
            carry_out(&mut h, ViewChange::Layout(Layout::Explore));
        }
    }
    println!("{placed} labels of {all}");
    assert!(placed > 1000 && 10 * placed > 9 * all, "{placed} labels of {all} have a place");
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
}

fn nothing_overlaps_in_any_machine() {
    look_at_all(|k| {
        let mut looks = vec![
            (ViewKind::Flat, Layout::Explore, false, Theme::Dark),
            (ViewKind::Flat, Layout::Explore, false, Theme::Light),
            (ViewKind::Space, Layout::Explore, false, [Theme::Light, Theme::Dark][k % 2]),
            (ViewKind::Flat, Layout::Present, false, [Theme::Dark, Theme::Light][k % 2]),
        ];
        // The table of runs takes long to make.
        if k == 0 {
            looks.push((ViewKind::Flat, Layout::Compare, false, Theme::Light));
        }
        looks
    });
}

fn nothing_overlaps_beside_another_run() {
    look_at_all(|k| match k {
        0 | 2 => vec![
            (ViewKind::Flat, Layout::Present, true, Theme::Light),
            (ViewKind::Flat, Layout::Explore, true, Theme::Dark),
        ],
        _ => vec![(ViewKind::Space, Layout::Explore, true, Theme::Dark)],
    });
}

/// Most changes of place in one run, and in all runs of the gallery: what is measured, so that it gets no worse. Most
/// are in `two-drive`, where the arm sweeps the only room beside its curve.
const MOST_JUMPS: usize = 10;
const MOST_JUMPS_IN_ALL: usize = 92;

/// Over a run, groups of labels change their places relative to their points no more often than is known.
fn labels_do_not_jump() {
    let mut h = window_liked(SIZES[1], &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(2);
    let (mut found, mut total) = (Vec::new(), 0);
    for scenario in gallery() {
        h.state_mut().app_state_mut().carry_out(SessionCommand::Open(Box::new(scenario.clone())));
        h.run_steps(3);
        if !session(&h).is_playing() {
            h.state_mut().app_state_mut().carry_out(SessionCommand::TogglePlay);
        }
        let start = session(&h).frame().time;
        let (mut jumps, mut frames, mut which) = (0, 0, Vec::new());
        let mut before: Vec<(String, Vec2)> = Vec::new();
        while frames < 50 {
            h.step();
            if frames % 10 == 5 {
                faults(&h, 0, &mut found, &format!("{} moving", scenario.name));
            }
            let placement = last(&h.ctx, 0).expect("drawn");
            let spot = SceneViewport { rect: placement.view(), camera: placement.camera };
            let now: Vec<(String, Vec2)> = placement
                .all
                .iter()
                .filter_map(|own| {
                    let at = spot.screen(own.label.at.map(f64::from))?;
                    Some((own.label.name.to_string(), own.place.center() - at))
                })
                .collect();
            // The rows of a group move as one.
            let mut moved: Vec<&str> = Vec::new();
            for (name, by) in &now {
                let same: Vec<_> = before.iter().filter(|(other, _)| other == name).collect();
                let far = !same.is_empty() && same.iter().all(|(_, old)| (*old - *by).length() > 24.0);
                if far && !moved.contains(&name.as_str()) {
                    moved.push(name);
                }
            }
            jumps += moved.len();
            which.extend(moved.iter().map(|name| format!("{name}@{frames}")));
            before = now;
            frames += 1;
        }
        let moved = session(&h).frame().time - start;
        println!("{}: {jumps} jumps in {frames} frames, {moved:.2} s: {}", scenario.name, which.join(" "));
        assert!(moved > 0.4, "{} moves: {moved} s", scenario.name);
        total += jumps;
        if jumps > MOST_JUMPS {
            found.push(format!("{}: {jumps} jumps in {frames} frames", scenario.name));
        }
    }
    assert!(total <= MOST_JUMPS_IN_ALL, "{total} jumps in all");
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
}

/// The table of runs has no column that is cut off, and in a usual window every column, with its symbols as with words.
fn the_table_of_runs_fits() {
    for (size, least) in [([960.0, 600.0], 6), ([1440.0, 900.0], 12)] {
        for names in [NameOrder::Terms, NameOrder::Symbols] {
            let mut h = window_liked(size, &Preferences { hints: false, ..Preferences::default() });
            let notation = Notation { names, ..Notation::default() };
            carry_out(&mut h, ViewChange::Notation(notation));
            h.key_press(egui::Key::C);
            h.run_steps(6);
            let rects: Vec<Rect> = h.query_all_by_label_contains("Sort by").map(|head| head.rect()).collect();
            assert!(rects.len() >= least, "{} columns at {size:?}", rects.len());
            let right = rects.iter().map(|rect| rect.right()).fold(0.0, f32::max);
            assert!(right <= size[0] - 16.0, "{right} of {size:?}");
        }
    }
}

const CARD: &str = "drag: the machine follows, b stays";

/// Where the ring of the target is on the screen.
fn target(h: &Window) -> Pos2 {
    let placement = last(&h.ctx, 0).expect("drawn");
    let ring = placement.scene.markers.iter().find(|marker| marker.name == "target").expect("a target");
    seen(h, ring.at.map(f64::from))
}

/// A card of the scene shows where the scene is on top: not through a plot in a window, nor behind a dialog.
fn no_card_of_the_scene_shows_under_a_window() {
    let hovered = || {
        let mut h = window_liked(SIZES[2], &Preferences { hints: false, ..Preferences::default() });
        h.run_steps(3);
        let at = target(&h);
        h.hover_at(at);
        h.run_steps(40);
        assert!(h.query_by_label_contains(CARD).is_some(), "over the target");
        (h, at)
    };
    let (mut h, at) = hovered();
    let window = [at.x - 150.0, at.y - 80.0, 320.0, 200.0];
    let name = "Torque".to_owned();
    carry_out(&mut h, ViewChange::Charts(PlotChange::Window(name, Some(window))));
    h.run_steps(4);
    h.hover_at(at + vec2(0.0, 1.0));
    h.run_steps(30);
    assert!(h.query_by_label_contains(CARD).is_none(), "a plot lies over the target");
    let before = session(&h).frame().target.at;
    drag(&mut h, at, at + vec2(0.0, 60.0));
    h.run_steps(4);
    assert_eq!(session(&h).frame().target.at, before, "the plot was dragged, not the target");
    let (mut h, _) = hovered();
    h.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::K);
    h.run_steps(30);
    assert!(h.query_by_label_contains(CARD).is_none(), "a dialog is open");
}

/// A target dragged over the plots stops at the edge of the scene.
fn what_is_dragged_stays_in_the_scene() {
    let mut h = window_liked(SIZES[2], &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(3);
    let from = target(&h);
    let scene = h.get_by_label_contains("Scene:").rect();
    pull(&mut h, from, pos2(scene.right() + 200.0, from.y));
    h.run_steps(3);
    let at = target(&h);
    assert!(scene.expand(1.0).contains(at) && at.x > scene.right() - 4.0, "{at} in {scene}");
}
