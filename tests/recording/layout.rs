//! The layout that the viewer opens with, with pictures and without.

use super::design::tensor_values;
use super::*;
use stillbase::picture::charts::{ChartPlace, charts};
use stillbase::picture::scene::palette::{Theme, palette};

#[test]
fn the_layout_comes_along_and_is_activated() {
    let folder = Folder::new("layout");
    record_in(&folder, "two.rrd", &[short("case-1"), short("case-3")]).expect("two cases");
    let contents = Contents::of(&folder.path("two.rrd"));
    assert_eq!(contents.activated, 1);
    let layouts: Vec<_> = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint).collect();
    let [(_, chunks)] = layouts[..] else { panic!("one layout") };
    let views = chunks.iter().filter(|c| c.components().contains_component("ViewBlueprint:class_identifier".into()));
    // Side by side: two scenes, two plots, events, lanes; each case: scene, joint space, tower, five plots, five of
    // the inside, events, notes, lanes; of the design the machine, three tables, two kinds of bars.
    assert_eq!(views.count(), 6 + 2 * 22);
    assert!(chunks.iter().any(|c| *c.entity_path() == EntityPath::from("/viewport")));
}

/// Views and containers of a layout: identifier, class or kind, and origin.
fn parts(contents: &Contents) -> Vec<(String, String, String)> {
    let layouts = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint);
    let chunks = layouts.flat_map(|(_, chunks)| chunks);
    let text = |chunk: &Chunk, component: &'static str| {
        let column = chunk.components().get_array(component.into())?;
        let flat = column.values().as_any().downcast_ref::<StringArray>()?;
        Some(flat.value(0).to_owned())
    };
    chunks
        .filter_map(|chunk| {
            let id = chunk.entity_path().to_string();
            if id.starts_with("/container/") && id.matches('/').count() == 2 {
                return Some((id, "container".into(), String::new()));
            }
            let class = text(chunk, "ViewBlueprint:class_identifier")?;
            Some((id, class, text(chunk, "ViewBlueprint:space_origin")?))
        })
        .collect()
}

/// A viewer keeps what it knows of a view under its identifier, from recording to recording.
#[test]
fn a_view_has_its_identifier_for_good_and_shares_it_with_nothing() {
    let folder = Folder::new("identifiers");
    let sets: [&[&str]; 5] = [
        &["case-1", "case-2", "case-3"],
        &["case-3"],
        &["spacecraft"],
        &["pick-up", "case-3", "case-1"],
        &["wheel", "spacecraft"],
    ];
    let mut known: BTreeMap<String, (String, String)> = BTreeMap::new();
    let mut tabs: BTreeMap<(String, String), Vec<std::collections::BTreeSet<String>>> = BTreeMap::new();
    for (i, names) in sets.iter().enumerate() {
        let scenarios: Vec<_> = names.iter().map(|name| short(name)).collect();
        record_in(&folder, &format!("{i}.rrd"), &scenarios).expect("cases");
        let parts = parts(&Contents::of(&folder.path(&format!("{i}.rrd"))));
        let ids: std::collections::BTreeSet<_> = parts.iter().map(|(id, ..)| id).collect();
        assert_eq!(ids.len(), parts.len(), "no two parts of a layout share an identifier");
        let mut views: BTreeMap<(String, String), std::collections::BTreeSet<String>> = BTreeMap::new();
        for (id, class, origin) in parts {
            let before = known.insert(id.clone(), (class.clone(), origin.clone()));
            assert!(before.is_none_or(|before| before == (class.clone(), origin.clone())), "{id} was another view");
            views.entry((class, origin)).or_default().insert(id);
        }
        views.into_iter().for_each(|(key, ids)| tabs.entry(key).or_default().push(ids));
    }
    // What a case shows in a tab of its own is the same view in every recording that has it.
    for (class, origin, recordings) in
        [("TimeSeries", "/case-3/signals", 3), ("3D", "/case-3/tower", 3), ("TextDocument", "/spacecraft/notes", 2)]
    {
        let seen = &tabs[&(class.to_owned(), origin.to_owned())];
        assert!(seen.len() == recordings && seen.iter().all(|ids| *ids == seen[0]), "{class} of {origin}: {seen:?}");
    }
}

#[cfg(feature = "render")]
#[test]
fn pictures_stand_beside_each_other_and_in_their_case() {
    if stillbase::picture::render::offscreen::Gpu::new().is_err() {
        return;
    }
    let folder = Folder::new("pictured");
    let options = Options {
        pictures: Some(Pictures { fps: 10.0, width: 64, height: 40, pin_forces: false }),
        ..Options::default()
    };
    let cases = [short("case-1"), short("case-3")];
    record(&cases, &folder.path("two.rrd"), &options, &mut quietly).expect("two cases");
    let parts = parts(&Contents::of(&folder.path("two.rrd")));
    for case in cases {
        let origin = format!("/{}/view", case.name);
        assert_eq!(parts.iter().filter(|(_, class, from)| class == "2D" && *from == origin).count(), 2, "{origin}");
    }
}

/// Strings of a component in the layout, by entity.
fn layout_texts(contents: &Contents, component: &'static str) -> BTreeMap<String, Vec<String>> {
    let layouts = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint);
    let found = layouts.flat_map(|(_, chunks)| chunks).filter_map(|chunk| {
        let column = chunk.components().get_array(component.into())?;
        let flat = column.values().as_any().downcast_ref::<StringArray>()?;
        Some((chunk.entity_path().to_string(), flat.iter().flatten().map(str::to_owned).collect()))
    });
    found.collect()
}

/// The viewer writes numbers at multiples of a power of ten, where they stand far enough apart.
#[test]
fn every_plot_has_room_for_two_numbers() {
    let folder = Folder::new("numbers");
    let mut plots = 0;
    for (name, settings) in [
        ("case-1", ""),
        ("case-3", ""),
        ("spacecraft", ""),
        ("wheel", ""),
        ("pick-up", ""),
        // Torques of about 5 N m: from −5 to 5 there would be a 0 and nothing else in a low plot.
        ("case-1", "task.time = 0.75"),
        ("case-1", "task.time = 0.7"),
        ("case-1", "task.time = 7"),
    ] {
        let change = toml::from_str(settings).expect("keys");
        let scenario = Scenario::builtin(name).expect("built in").with_settings(&change).expect("a time");
        let file = folder.path(&format!("{name} {settings}.rrd"));
        record(std::slice::from_ref(&scenario), &file, &Options::default(), &mut quietly).expect("a case");
        let contents = Contents::of(&file);
        let classes = layout_texts(&contents, "ViewBlueprint:class_identifier");
        for (page, views) in layout_texts(&contents, "ContainerBlueprint:contents") {
            let is_plot = |view: &String| {
                classes.get(&format!("/{}", view.trim_start_matches('/'))).is_some_and(|class| class[0] == "TimeSeries")
            };
            if !views.iter().all(is_plot) {
                continue;
            }
            for view in &views {
                let path = format!("/{}/ScalarAxis", view.trim_start_matches('/'));
                let [low, high] = range(&contents, &path);
                // A window of usual size has room for 28 numbers from top to bottom.
                let step = 10f64.powf(((high - low) * views.len() as f64 / 28.0).log10().ceil());
                let numbers = (high / step).floor() - (low / step).ceil() + 1.0;
                assert!(numbers >= 2.0, "{name} {settings}, {page}: {low} to {high}, one of {}", views.len());
                plots += 1;
            }
        }
    }
    assert!(plots > 60, "only {plots} plots");
}

/// Ends of the vertical axis of a plot.
fn range(contents: &Contents, path: &str) -> [f64; 2] {
    let layouts = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint);
    let mut chunks = layouts.flat_map(|(_, chunks)| chunks).filter(|c| *c.entity_path() == EntityPath::from(path));
    let chunk = chunks.next().unwrap_or_else(|| panic!("{path}"));
    let column = chunk.components().get_array("ScalarAxis:range".into()).expect("a range");
    let list = column.values().as_any().downcast_ref::<FixedSizeListArray>().expect("two numbers").clone();
    let numbers = list.values().as_any().downcast_ref::<Float64Array>().expect("numbers").values().clone();
    [numbers[0], numbers[1]]
}

/// Colours of the series of each case in the plots that compare them.
fn compared_colours(folder: &Folder, names: &[&'static str]) -> BTreeMap<&'static str, BTreeSet<u32>> {
    let file = format!("{}.rrd", names.len());
    record_in(folder, &file, &names.iter().map(|name| short(name)).collect::<Vec<_>>()).expect("cases");
    let contents = Contents::of(&folder.path(&file));
    let layouts = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint);
    let mut colours: BTreeMap<&'static str, BTreeSet<u32>> = BTreeMap::new();
    for chunk in layouts.flat_map(|(_, chunks)| chunks) {
        let path = chunk.entity_path().to_string();
        let Some(column) = chunk.components().get_array("SeriesLines:colors".into()) else { continue };
        let flat = column.values().as_any().downcast_ref::<UInt32Array>().expect("colours");
        let case = names.iter().find(|name| path.contains(&format!("/{name}/"))).expect("a case");
        colours.entry(case).or_default().extend(flat.values());
    }
    colours
}

/// Cases that are compared have the colours that the window gives to runs beside each other.
#[test]
fn compared_cases_have_colours_of_their_own() {
    let folder = Folder::new("colours");
    let palette = palette(Theme::Dark);
    let names = ["case-1", "case-2", "case-3", "spacecraft", "wheel"];
    for count in 2..=names.len() {
        let colours = compared_colours(&folder, &names[..count]);
        for (i, name) in names[..count].iter().enumerate() {
            let want = BTreeSet::from([packed(palette.run(i))]);
            assert_eq!(colours[name], want, "{name}, one of {count}: one colour in every plot");
        }
        let all: BTreeSet<&u32> = colours.values().flatten().collect();
        assert_eq!(all.len(), count, "{colours:?}");
    }
}

/// Values below this are rounding in every scenario, in SI units.
const ROUNDING: f64 = 1e-9;

/// Rounding is a straight line in its plot, and fills no plot of bars.
#[test]
fn rounding_does_not_fill_a_plot() {
    let folder = Folder::new("rounding");
    let (mut flat, mut still, mut bar_plots) = (0, 0, 0);
    for scenario in Scenario::builtins() {
        let name = &scenario.name;
        let file = folder.path(&format!("{name}.rrd"));
        record(std::slice::from_ref(scenario), &file, &Options::default(), &mut quietly).expect("a case");
        let contents = Contents::of(&file);
        let titles = layout_texts(&contents, "ViewBlueprint:display_name");
        let classes = layout_texts(&contents, "ViewBlueprint:class_identifier");
        let known = signals(&scenario.machine);
        let mut plots = charts(scenario, false);
        // Those that compare cases are not of one case alone.
        plots.retain(|chart| chart.place != ChartPlace::Compared && known.iter().any(|signal| chart.contains(signal)));
        let views: Vec<&String> =
            classes.iter().filter(|(_, class)| class[0] == "TimeSeries").map(|(view, _)| view).collect();
        assert_eq!(views.len(), plots.len(), "{name}");
        for chart in plots {
            let title = |view: &&&String| {
                let rest = titles[**view][0].strip_prefix(chart.title);
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with("  "))
            };
            let view = views.iter().find(title).unwrap_or_else(|| panic!("{name}: {}", chart.title));
            let [low, high] = range(&contents, &format!("{view}/ScalarAxis"));
            for signal in known.iter().filter(|signal| chart.contains(signal)) {
                let (_, _, values) = contents.signal(name, signal);
                let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let least = values.iter().copied().fold(f64::INFINITY, f64::min);
                assert!(low <= least && most <= high, "{name}, {}: {least} to {most}", signal.path);
                if most - least < ROUNDING {
                    let share = (most - least) / (high - low);
                    assert!(share < 1e-3, "{name}, {}: rounding fills {share} of {low} to {high}", signal.path);
                    flat += 1;
                    still += usize::from(most != least);
                }
            }
        }
        // Bars of all drives share a plot, which is as high as the highest of them.
        for plot in ["force", "coupling"] {
            let under = EntityPath::from(format!("/{name}/design/bars/{plot}"));
            let of_plot = contents.recording().iter().filter(|chunk| chunk.entity_path().starts_with(&under));
            let columns = of_plot.filter_map(|chunk| chunk.components().get_array("BarChart:values".into()));
            let highest = columns.flat_map(|bars| tensor_values(bars.values())).map(f64::abs).fold(0.0, f64::max);
            assert!(highest == 0.0 || highest > ROUNDING, "{name}, {plot}: rounding fills {highest}");
            bar_plots += usize::from(highest > 0.0);
        }
    }
    assert!(flat > 50 && still > 10, "{flat} signals stand still, {still} but for rounding");
    assert!(bar_plots > 10, "only {bar_plots} plots of bars");
}

/// Where a base floats, the cases of a recording are compared by its turn, too: it is what a silent arm keeps.
#[test]
fn the_turn_of_the_base_is_compared() {
    let folder = Folder::new("turn");
    let titles = |names: &[&str], file: &str| {
        record_in(&folder, file, &names.iter().map(|name| short(name)).collect::<Vec<_>>()).expect("cases");
        let contents = Contents::of(&folder.path(file));
        layout_texts(&contents, "ViewBlueprint:display_name").into_values().map(|title| title[0].clone()).collect()
    };
    let both: Vec<String> = titles(&["ets-vii", "ets-vii-silent"], "both.rrd");
    assert!(both.iter().any(|title| title.starts_with("Turn of the base")), "{both:?}");
    let held: Vec<String> = titles(&["case-1", "case-2"], "held.rrd");
    assert!(!held.iter().any(|title| title.starts_with("Turn of the base")), "{held:?}");
}
