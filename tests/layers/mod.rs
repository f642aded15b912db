//! What cargo does not hold: the crates stand in order, the core stays free of windows, clocks, files and chance, and
//! what is derived is kept by queries alone. Errors are what the ecosystem takes for one.

mod errors;
mod source;

use std::collections::BTreeSet;
use std::path::Path;

use source::Source;

/// Crates that neither draw, nor talk to a person, nor keep files.
const CORE: &[&str] = &[
    "settings",
    "query",
    "convex",
    "mechanics",
    "exchange",
    "planning",
    "simulation",
    "session",
    "study",
    "picture/scene",
];

/// What the core may be built on.
const FOUNDATIONS: &[&str] =
    &["clarabel", "libm", "nalgebra", "rand_chacha", "realfft", "roxmltree", "schemars", "serde", "thiserror", "toml"];

/// Parts of the standard library that reach outside, and the files that are edges.
const EDGES: &[(&str, &[&str])] = &[
    (
        "std::time",
        &[
            "picture/render/shader.rs",
            "app/jobs.rs",
            "app/window/chooser/portal.rs",
            "app/window/app.rs",
            "app/window/keeper.rs",
            "app/window/pane.rs",
            "app/window/shell.rs",
            "app/window/times.rs",
            "app/window/waker.rs",
            "app/window/windows.rs",
            "commands/design/weighed.rs",
            "files/journal.rs",
            "files/stamp.rs",
            "python/watched.rs",
            "recording/viewer.rs",
        ],
    ),
    (
        "std::env",
        &[
            "build.rs",
            "python/build.rs",
            "main.rs",
            "app/window.rs",
            "app/window/error.rs",
            "app/window/chooser/portal.rs",
            // The folder of temporary files.
            "files/new_file.rs",
        ],
    ),
    (
        "std::thread",
        &[
            "app/jobs.rs",
            "app/window/keeper.rs",
            "app/window/waker.rs",
            "commands/interrupt.rs",
            "commands/tolerance/parallel.rs",
            "files/video.rs",
            "python/arrays.rs",
            "python/watched.rs",
        ],
    ),
    ("std::net", &[]),
    (
        "std::process",
        &[
            "files/draft.rs",
            "files/fault.rs",
            "files/new_file.rs",
            "files/video.rs",
            "main.rs",
            "python/build.rs",
            "recording/viewer.rs",
        ],
    ),
    // Text comes in at one place; everything else of the core takes it from there.
    (
        "std::fs",
        &[
            "build.rs",
            "python/build.rs",
            "files/draft.rs",
            "files/shards/rows.rs",
            "files/table/parquet_table.rs",
            "files/shards/checksum.rs",
            "files/new_file.rs",
            "files/new_folder.rs",
            "files/journal.rs",
            "files/stamp.rs",
            "files/preferences.rs",
            "picture/render/shader.rs",
            "files/text.rs",
        ],
    ),
];

/// The manifest of a crate, or of the workspace.
fn manifest(folder: &str) -> toml::Table {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder).join("Cargo.toml");
    std::fs::read_to_string(file).expect("readable").parse().expect("TOML")
}

/// The crates in the order of the workspace.
fn crates() -> Vec<String> {
    let workspace = manifest(".");
    let members = workspace["workspace"]["members"].as_array().expect("a list");
    members.iter().map(|m| m.as_str().expect("a path").trim_start_matches("src/").to_owned()).collect()
}

fn dependencies(name: &str) -> Vec<String> {
    let manifest = manifest(&format!("src/{name}"));
    manifest.get("dependencies").and_then(toml::Value::as_table).into_iter().flat_map(|t| t.keys().cloned()).collect()
}

#[test]
fn crates_stand_in_order() {
    let crates = crates();
    for (i, name) in crates.iter().enumerate() {
        for dependency in dependencies(name) {
            let Some(own) = dependency.strip_prefix("stillbase-") else { continue };
            assert!(crates[..i].iter().any(|below| below == own), "{name} uses {own}, which does not stand before it");
        }
    }
    for name in CORE.iter().filter(|name| !name.contains('/')) {
        for dependency in dependencies(name).iter().filter(|d| !d.starts_with("stillbase-")) {
            assert!(FOUNDATIONS.contains(&dependency.as_str()), "{name} is built on {dependency}");
        }
    }
}

#[test]
fn every_crate_is_on_the_map() {
    let map = include_str!("../../src/lib.rs");
    let place = |name: &String| {
        map.find(&format!("//! | [`{name}`]"))
            .or(map.find(&format!("//! | `{name}`")))
            .unwrap_or_else(|| panic!("{name} is not on the map"))
    };
    let places: Vec<usize> = crates().iter().map(place).collect();
    assert!(places.is_sorted(), "{places:?}");
    // What it says of files is there.
    for word in
        map.split('`').filter(|word| word.contains('/') && *word != "src/" && !word.contains([' ', '*', '=', '{']))
    {
        assert!(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).join(word).exists(), "no {word}");
    }
}

#[test]
fn every_feature_is_in_the_table() {
    let front = include_str!("../../src/lib.rs");
    let (_, table) = front.split_once("//! # Features\n").expect("a heading");
    let rows =
        table.lines().take_while(|line| !line.starts_with("//! # ")).filter_map(|line| line.strip_prefix("//! | `"));
    let listed: BTreeSet<&str> = rows.filter_map(|row| row.split('`').next()).collect();
    let manifest = manifest(".");
    let features = manifest["features"].as_table().expect("a table");
    assert_eq!(listed, features.keys().map(String::as_str).filter(|name| *name != "default").collect());
}

/// A crate that others reach says how; none is published, for each reads files outside of its folder or builds on one
/// that does.
#[test]
fn every_crate_says_whom_it_serves() {
    let facade = include_str!("../../src/lib.rs");
    for name in crates() {
        let root = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("src/{name}/lib.rs")));
        let root = root.expect("readable");
        let shown = facade.contains(&format!("#[doc(inline)]\npub use stillbase_{name} as {name};"));
        let says = match shown {
            true => format!(
                "Others reach this crate as `stillbase::{name}`; `stillbase` alone follows semantic versioning."
            ),
            false => "This crate serves the workspace alone, and may change in any version.".to_owned(),
        };
        assert!(root.contains(&says), "{name}: {says}");
        let manifest = manifest(&format!("src/{name}"));
        assert_eq!(manifest["lib"].get("doc").and_then(toml::Value::as_bool), (!shown).then_some(false), "{name}");
        assert_eq!(manifest["package"]["publish"].as_bool(), Some(false), "{name}");
    }
}

fn core(sources: &[Source]) -> impl Iterator<Item = &Source> {
    sources.iter().filter(|source| CORE.iter().any(|place| source.is_in(place)))
}

#[test]
fn the_renderer_knows_scenes_and_no_mechanics() {
    let sources = Source::all();
    let render: Vec<&Source> = sources.iter().filter(|source| source.is_in("picture/render")).collect();
    assert!(render.len() > 5);
    for source in render {
        assert!(!source.code.contains("stillbase_"), "{}", source.name);
        let other = source
            .code
            .split("crate::")
            .skip(1)
            .find(|rest| !rest.starts_with("render") && !rest.starts_with("scene::"));
        assert!(other.is_none(), "{}: {:?}", source.name, other.map(|rest| &rest[..rest.len().min(40)]));
    }
}

#[test]
fn clocks_files_and_environment_stay_at_the_edges() {
    let sources = Source::all();
    assert!(sources.len() > 600 && sources.iter().all(|source| !source.code.contains("std::{")));
    for (part, edges) in EDGES {
        let found: BTreeSet<&str> = sources.iter().filter(|s| s.says(part)).map(|s| s.name.as_str()).collect();
        assert_eq!(found, edges.iter().copied().collect(), "{part}");
    }
    // Nor does the core speak or draw lots; chance has no place in it at all.
    for source in core(&sources) {
        for word in
            ["println!", "eprintln!", "print!", "eprint!", "dbg!", "rand::", "thread_rng", "Instant", "SystemTime"]
        {
            assert!(
                !source.says(word.trim_end_matches('!')) || !source.code.contains(word),
                "{} says {word}",
                source.name
            );
        }
    }
}

/// What is derived is a query: nothing else keeps what it has made. What is made once for good is named here, with its
/// reason, and so is what compares identities, as private memos do.
#[test]
fn what_is_derived_is_kept_by_queries_alone() {
    const ONCE: &[(&str, &str)] = &[
        ("app/gallery.rs", "pictures of the machines that come along"),
        ("files/text.rs", "what was read from standard input, which can be read once"),
        ("mechanics/machine/catalog.rs", "the machines that come along"),
        ("mechanics/assembly/catalog.rs", "the assemblies that come along"),
        ("session/scenario/catalog.rs", "the scenarios that come along"),
        ("picture/scene/stage/workspace.rs", "bounds that follow from the planes it holds"),
        ("planning/pose_space/pattern.rs", "patterns that follow from the space they are of"),
        ("commands/in_process.rs", "what a command says to the program that carries it out"),
        ("commands/program.rs", "the commit that was built, which the program names once"),
        ("files/parquet_guard.rs", "whether a thread reads a file whose panics are errors of the file"),
    ];
    const SAME: &[(&str, &str)] = &[
        ("mechanics/machine/model.rs", "what copies of a machine share needs no comparison"),
        ("session/assembly/block.rs", "what scenarios of one assembly share needs no comparison"),
        ("session/machines.rs", "what copies share needs no comparison"),
        ("session/script.rs", "what versions share needs no comparison"),
        ("app/state.rs", "framing follows where other views take their place"),
        ("picture/paint.rs", "what the graphics card has drawn already"),
        ("picture/render/solids.rs", "what the graphics card holds already"),
        ("picture/scene/blocks.rs", "meshes are joined where others take their place"),
        ("picture/scene/mod.rs", "what scenes share needs no comparison"),
        ("picture/scene/views.rs", "what is known is compared without a copy of the run"),
        ("recording/entity.rs", "what a recording has written already"),
        ("recording/recorder.rs", "names change where other views take their place"),
        ("study/comparison/entries.rs", "rows change where other ways take their place"),
    ];
    let sources = Source::all();
    let found = |words: &[&str]| -> BTreeSet<String> {
        let says = |source: &&Source| !source.is_in("query") && words.iter().any(|word| source.says(word));
        sources.iter().filter(says).map(|source| source.name.clone()).collect()
    };
    let once = found(&["OnceLock", "OnceCell", "LazyLock", "LazyCell", "RefCell", "thread_local"]);
    assert_eq!(once, ONCE.iter().map(|(file, _)| (*file).to_owned()).collect());
    assert_eq!(found(&["ptr_eq"]), SAME.iter().map(|(file, _)| (*file).to_owned()).collect());
}

/// Whatever comes from outside ends in an error. What may still panic is named here, with its reason.
#[test]
fn the_library_does_not_panic() {
    let allowed = [
        // Files that are compiled in; a test reads each.
        ("mechanics/machine/catalog.rs", "the machines that come along are valid"),
        ("mechanics/assembly/catalog.rs", "the assemblies that come along are valid"),
        ("session/scenario/catalog.rs", "the scenarios that come along are valid"),
        // Plain data is always TOML.
        ("mechanics/machine/file.rs", "a machine is plain data"),
        ("session/scenario/file.rs", "a scenario is plain data"),
        ("session/scenario/machine_file.rs", "a brief is plain data"),
        ("session/edit.rs", "an edit is plain data"),
        ("mechanics/assembly/model.rs", "a machine is plain data"),
        ("mechanics/assembly/file.rs", "an assembly is plain data"),
        ("session/assembly/file.rs", "is plain data"),
        ("session/assembly/file.rs", "a scenario is written as TOML"),
    ];
    for source in core(&Source::all()) {
        for line in source.code.lines() {
            let named = allowed.iter().any(|(file, words)| *file == source.name && line.contains(words));
            for word in [".unwrap()", ".expect(", "panic!", "todo!", "unimplemented!", "unreachable!"] {
                assert!(named || !line.contains(word), "{}: {}", source.name, line.trim());
            }
        }
    }
}
