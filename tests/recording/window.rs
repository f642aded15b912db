//! What the window shows is in the recording: the same items, charts, words and colours.

use super::*;

/// What reaches the base is one thing in the window and in the recording, under gravity, with a load and with both: the
/// same numbers in the same words, each in its own colour.
#[test]
fn the_reaction_is_the_same_in_the_window() {
    use arrow::array::UInt32Array;
    use stillbase::picture::scene::options::ViewOptions;
    use stillbase::picture::scene::palette::{Theme, palette};
    use stillbase::picture::scene::stage::Stage;
    let folder = Folder::new("reaction");
    let p = palette(Theme::Dark);
    let packed = |c: [f32; 4]| c.iter().fold(0u32, |all, x| all << 8 | (x * 255.0).round() as u32);
    let mut kinds = std::collections::BTreeSet::new();
    for (name, gravity, mass) in
        [("case-1", -9.81, 0.0), ("case-1", -9.81, 0.4), ("case-3", -9.81, 0.0), ("case-3", 0.0, 0.3)]
    {
        let mut scenario = short(name);
        scenario.machine = scenario.machine.set("gravity", &format!("0,{gravity}")).expect("a machine");
        scenario.plant.payload.mass = mass;
        let file = format!("{name}-{gravity}-{mass}.rrd");
        record_in(&folder, &file, std::slice::from_ref(&scenario)).expect("recorded");
        let contents = Contents::of(&folder.path(&file));
        let mut frames: Vec<Frame> = Vec::new();
        let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
        let stage = Stage::of(&run);
        let mut rows = 0;
        for chunk in contents.at(&format!("/{name}/reaction/words")).into_iter().filter(|c| !c.is_static()) {
            let steps = chunk.timelines()[&TimelineName::from("step")].times_raw();
            let column = |component: &'static str| chunk.components().get_array(component.into()).expect("a column");
            let (labels, colours) = (column("Points3D:labels"), column("Points3D:colors"));
            for (i, step) in steps.iter().enumerate() {
                let (labels, colours) = (labels.value(i), colours.value(i));
                let labels = labels.as_any().downcast_ref::<StringArray>().expect("words");
                let colours = colours.as_any().downcast_ref::<UInt32Array>().expect("colours");
                let options = ViewOptions { show_hints: false, ..ViewOptions::default() };
                let scene = stage.scene(&frames[*step as usize], &options);
                for k in 0..2 {
                    let seen = scene.labels.iter().find(|l| l.text.starts_with(["f_B", "n_B"][k])).expect("a label");
                    assert_eq!(labels.value(k), seen.text, "{file} at {step}");
                    assert_eq!(colours.value(k), packed(seen.colour), "{file} at {step}: {}", seen.text);
                    kinds.insert((k, seen.colour == p.reaction));
                }
                let weight = (gravity != 0.0).then(|| frames[*step as usize].wrench.static_part.force.norm());
                let words = weight.map(|w| format!("and its weight, {w:.1} N"));
                assert_eq!(
                    words.as_deref(),
                    labels.iter().flatten().find(|t| t.starts_with("and ")),
                    "{file} at {step}"
                );
                rows += 1;
            }
        }
        assert!(rows > 0, "{file}: {rows}");
        // Arrows lie along the force of motion; the static part has none.
        let arrows = contents.strips(&format!("/{name}/reaction/force"));
        assert_eq!(mass > 0.0, !arrows.is_empty(), "{file}");
    }
    assert_eq!(kinds.len(), 4, "each of the two was green and red: {kinds:?}");
}

/// A colour as the viewer has it: of lines, points and words over the background, because they hide what is behind them.
fn seen(rgba: [f32; 4], background: [f32; 4]) -> u32 {
    let [.., alpha] = rgba;
    let over = |i: usize| if i == 3 { 1.0 } else { background[i] * (1.0 - alpha) + rgba[i] * alpha };
    packed([0, 1, 2, 3].map(over))
}

/// Whatever the window draws of a run is an entity of its recording, by its name, in its colour; in every view, of
/// machines that stand and float, with a wheel, a payload and friction, and with a target out of reach.
#[test]
fn all_that_the_window_draws_is_recorded_in_its_colour() {
    use stillbase::picture::scene::options::ViewOptions;
    use stillbase::picture::scene::palette::{Theme, palette};
    use stillbase::picture::scene::views::{ViewKind, Views};
    use stillbase::simulation::plant::{BaseKind, Load, Wheel};
    let folder = Folder::new("everything");
    let p = palette(Theme::Dark);
    let mut floating = short("case-1");
    floating.base.kind = BaseKind::Free;
    floating.duration = Some(0.4);
    floating.base.wheel = Some(Wheel { torque_limit: Some(0.02), ..Default::default() });
    floating.plant.payload = Load { mass: 0.3, from: 0.02, offset: [0.05, 0.0], ..Default::default() };
    let mut sprung = short("case-1");
    sprung.base.kind = BaseKind::Compliant;
    let mut outside = short("case-3");
    outside.edits = vec![TimedEdit { step: 10, edit: Edit::DragTarget { x: 0.2, y: 1.15 } }];
    let mut drawn = std::collections::BTreeSet::new();
    for (i, scenario) in [short("case-1"), folded(), floating, sprung, outside].into_iter().enumerate() {
        let file = format!("{i}.rrd");
        record_in(&folder, &file, std::slice::from_ref(&scenario)).expect("recorded");
        let contents = Contents::of(&folder.path(&file));
        let mut frames: Vec<Frame> = Vec::new();
        let run = replay(&scenario, |_, frame| frames.push(*frame)).expect("it runs");
        let views = Views::of(&run);
        let options = ViewOptions { show_hints: false, ..ViewOptions::default() };
        let root = format!("/{}", scenario.name);
        let spaces = [
            (ViewKind::Flat, ""),
            (ViewKind::Joints, "/joint_space"),
            (ViewKind::Tower, "/tower"),
            (ViewKind::Design, "/design"),
        ];
        for (kind, space) in spaces {
            for frame in [frames.len() / 2, frames.len() - 1].map(|i| &frames[i / 5 * 5]) {
                let scene = views.scene(kind, frame, &options, &views.camera(kind));
                let path = |name: &str| {
                    let name = name.replacen("design/", "marks/", 1);
                    let name = match name.strip_prefix("workspace") {
                        Some(rest) => match rest.strip_prefix("/compared") {
                            Some(rest) => format!("workspace/{:.3}{rest}", scenario.compare_b.expect("compared")),
                            None => format!("workspace/{:.3}{rest}", frames[0].b_reference),
                        },
                        None => name,
                    };
                    format!("{root}{space}/{name}")
                };
                let mut check = |name: &str, component: &'static str, want: u32| {
                    let colours = contents.colours(&path(name), component);
                    assert!(colours.contains(&want), "{file} {kind:?} {name}: {want:08x} in {colours:08x?}");
                    drawn.insert(name.split('/').next().unwrap_or_default().to_owned());
                };
                for solid in &scene.solids {
                    check(&solid.name, "Mesh3D:albedo_factor", packed(solid.colour));
                }
                for area in &scene.areas {
                    check(&area.name, "Mesh3D:albedo_factor", packed(area.colour));
                }
                // What the wall hides is told apart for one eye; a recording has as many as look at it.
                let lines = scene.lines.iter().filter(|l| !l.strips.is_empty() && l.name != "contours/hidden");
                for line in lines {
                    check(&line.name, "LineStrips3D:colors", seen(line.colour, p.background));
                }
                for marker in &scene.markers {
                    let edged = marker.stroke_width > 0.0 && marker.stroke != marker.fill;
                    let (component, tone) = match marker.fill[3] == 0.0 {
                        true => ("LineStrips3D:colors", marker.stroke),
                        false if edged => ("Points3D:colors", marker.stroke),
                        false => ("Points3D:colors", marker.fill),
                    };
                    check(&marker.name, component, seen(tone, p.background));
                    if edged && marker.fill[3] > 0.0 {
                        check(&format!("{}/inside", marker.name), component, seen(marker.fill, p.background));
                    }
                }
                for label in &scene.labels {
                    check(&label.name, "Points3D:colors", seen(label.colour, p.background));
                    let told = contents.texts(&path(&label.name), "Points3D:labels");
                    // The marks of a window that slides are others, and so are scales that go by the peaks so far.
                    let same = label.name.starts_with("axes") || label.text.starts_with("arc");
                    assert!(same || told.contains(&label.text), "{file} {kind:?}: {:?} in {told:?}", label.text);
                }
            }
        }
    }
    for name in ["machine", "workspace", "b_ring", "plan", "target", "wheel", "payload", "springs", "unmoved", "slice"]
    {
        assert!(drawn.contains(name), "{name} in {drawn:?}");
    }
}

/// Every plot of the window is a plot of the recording, of the same signals in the same colours.
#[test]
fn all_that_the_window_plots_is_in_the_layout() {
    use stillbase::picture::charts::{charts, colour};
    use stillbase::picture::scene::palette::{Theme, palette};
    use stillbase::simulation::plant::{BaseKind, Wheel};
    let folder = Folder::new("charts");
    let p = palette(Theme::Dark);
    let mut floating = short("case-1");
    floating.base.kind = BaseKind::Free;
    floating.base.wheel = Some(Wheel::default());
    for (i, scenario) in [short("case-1"), short("case-3"), floating].into_iter().enumerate() {
        let file = format!("{i}.rrd");
        record_in(&folder, &file, std::slice::from_ref(&scenario)).expect("recorded");
        let contents = Contents::of(&folder.path(&file));
        let layouts = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint);
        let chunks: Vec<&Chunk> = layouts.flat_map(|(_, chunks)| chunks).collect();
        let text = |chunk: &Chunk, component: &'static str| -> Vec<String> {
            let column = chunk.components().get_array(component.into());
            let flat = column.and_then(|c| c.values().as_any().downcast_ref::<StringArray>().cloned());
            flat.iter().flat_map(|words| words.iter().flatten().map(str::to_owned)).collect()
        };
        let run = replay(&scenario, |_, _| {}).expect("it runs");
        let table = signals(&scenario.machine);
        for chart in charts(&scenario, false).iter().filter(|chart| chart.in_window(true)) {
            let view = chunks.iter().find(|chunk| {
                let name = text(chunk, "ViewBlueprint:display_name");
                name.iter().any(|name| *name == chart.title || name.starts_with(&format!("{}  ", chart.title)))
            });
            let view = view.unwrap_or_else(|| panic!("{file}: {}", chart.title)).entity_path().to_string();
            let queries = chunks.iter().find(|c| c.entity_path().to_string() == format!("{view}/ViewContents"));
            let shown = text(queries.expect("contents"), "ViewContents:query");
            let held: Vec<_> = table.iter().filter(|signal| chart.contains(signal)).collect();
            assert!(!held.is_empty(), "{file}: {}", chart.title);
            let series: Vec<_> = held.iter().map(|signal| contents.series(&scenario.name, signal)).collect();
            let entities: BTreeSet<String> = series.iter().map(|(path, _)| path.clone()).collect();
            let within = format!("/{}/signals/", scenario.name);
            let want = entities.iter().map(|path| path.replacen(&within, "$origin/", 1)).collect::<BTreeSet<_>>();
            assert_eq!(shown.into_iter().collect::<BTreeSet<_>>(), want, "{file}: {}", chart.title);
            for path in entities {
                // What the layout shows of an entity is what the chart holds of it.
                let all: Vec<usize> = (0..contents.texts(&path, "SeriesLines:names").len()).collect();
                let overrides = format!("{view}/ViewContents/overrides{path}/visualizers/");
                let of_view = chunks.iter().filter(|chunk| chunk.entity_path().to_string().starts_with(&overrides));
                let mut masks = of_view.filter_map(|c| c.components().get_array("SeriesLines:visible_series".into()));
                let visible = masks.next_back().map_or(all.clone(), |mask| {
                    let mask = mask.values().as_any().downcast_ref::<BooleanArray>().expect("flags").clone();
                    assert_eq!(mask.len(), all.len(), "{file}: {}: {path}", chart.title);
                    all.into_iter().filter(|k| mask.value(*k)).collect()
                });
                let want: Vec<usize> = series.iter().filter(|(of, _)| *of == path).map(|(_, k)| *k).collect();
                assert_eq!(visible, want, "{file}: {}: {path}", chart.title);
            }
            for (signal, (path, k)) in held.iter().zip(&series) {
                let want = packed(colour(signal, &p, &run.frame().peaks));
                assert_eq!(contents.colours(path, "SeriesLines:colors")[*k], want, "{path}: {}", signal.path);
            }
        }
    }
}
