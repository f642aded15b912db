//! The layout that the viewer opens with, with pictures and without.

use super::*;

#[test]
fn the_layout_comes_along_and_is_activated() {
    let folder = Folder::new("layout");
    record_in(&folder, "two.rrd", &[short("case-1"), short("case-3")]).expect("two cases");
    let contents = Contents::of(&folder.path("two.rrd"));
    assert_eq!(contents.activated, 1);
    let layouts: Vec<_> = contents.stores.iter().filter(|(id, _)| id.kind() == StoreKind::Blueprint).collect();
    let [(_, chunks)] = layouts[..] else { panic!("one layout") };
    let views = chunks.iter().filter(|c| c.components().contains_component("ViewBlueprint:class_identifier".into()));
    // Side by side: two scenes, two plots, events; each case: scene, joint space, tower, five plots, five of
    // the inside, events, phase; of the design the machine, three tables, two kinds of bars.
    assert_eq!(views.count(), 5 + 2 * 21);
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
        [("TimeSeries", "/case-3/signals", 3), ("3D", "/case-3/tower", 3), ("StateTimeline", "/spacecraft/phase", 2)]
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
