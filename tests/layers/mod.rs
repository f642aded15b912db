//! Imports go one way: a wing uses those below it only, no files use each other, outside crates stay in their place,
//! and clocks, files and the environment at the edges.

mod source;

use std::collections::{BTreeMap, BTreeSet};

use source::{Source, Tree};

/// From the bottom to the edges: a wing uses those before it only.
const WINGS: &[&str] = &[
    // Pages for people; no code.
    "guide",
    "settings",
    "query",
    "convex",
    "mechanics",
    "exchange",
    "planning",
    "simulation",
    "session",
    "study",
    "picture",
    "files",
    "recording",
    "app",
    // The program around the library.
    "commands",
    "main",
];

/// Wings that neither draw, nor talk to a person, nor keep files.
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

/// Outside crates and the modules that may know them.
const CRATES: &[(&str, &[&str])] = &[
    ("wgpu", &["picture/render", "picture/canvas", "picture/gui", "picture/paint", "app/window"]),
    ("bytemuck", &["picture/render", "picture/gui"]),
    ("pollster", &["picture/render", "app/window"]),
    ("png", &["picture/render"]),
    ("egui", &["picture/canvas", "picture/gui", "picture/paint", "app"]),
    ("egui_winit", &["app/window"]),
    ("winit", &["app/window"]),
    ("egui_plot", &["app"]),
    ("rfd", &["app/window"]),
    ("zbus", &["app/window"]),
    ("directories", &["files/journal", "files/preferences"]),
    ("sha2", &["recording/hash"]),
    ("libloading", &["app/window"]),
    ("rustix", &["app/jobs"]),
    ("rerun", &["recording"]),
    ("clap", &["commands", "main"]),
    ("indicatif", &["commands"]),
    ("csv", &["files/shards", "files/table", "commands"]),
    ("serde_json", &["commands"]),
    ("parquet", &["files/shards"]),
    ("signal_hook", &["commands"]),
    (
        "toml",
        &[
            "settings",
            "mechanics/machine",
            "simulation/plant",
            "session",
            "files/heading",
            "files/preferences",
            "commands",
        ],
    ),
    ("rand_chacha", &["study/lengths", "study/tolerance"]),
    ("libm", &["study/tolerance"]),
    ("realfft", &["study/spectrum"]),
    ("roxmltree", &["exchange/import"]),
    ("clarabel", &["convex"]),
];

/// Parts of the standard library that reach outside, and the files that are edges.
const EDGES: &[(&str, &[&str])] = &[
    (
        "std::time",
        &[
            "picture/render/shader.rs",
            "app/jobs.rs",
            "app/window/chooser/portal.rs",
            "app/window/guest.rs",
            "app/window/keeper.rs",
            "app/window/shell.rs",
            "app/window/times.rs",
            "commands/design/weighed.rs",
            "files/journal.rs",
        ],
    ),
    ("std::env", &["main.rs", "app/window.rs", "app/window/error.rs", "app/window/chooser/portal.rs"]),
    (
        "std::thread",
        &[
            "app/jobs.rs",
            "app/window/keeper.rs",
            "commands/interrupt.rs",
            "commands/tolerance/parallel.rs",
            "recording/store.rs",
        ],
    ),
    ("std::net", &[]),
    ("std::process", &["commands/exit.rs", "files/draft.rs", "files/fault.rs", "files/new_file.rs", "main.rs"]),
    // Text comes in at one place; everything else of the core takes it from there.
    (
        "std::fs",
        &[
            "files/draft.rs",
            "files/shards/rows.rs",
            "files/shards/checksum.rs",
            "files/new_file.rs",
            "files/journal.rs",
            "files/preferences.rs",
            "picture/render/shader.rs",
            "files/text.rs",
        ],
    ),
];

/// Whether a file stands in a wing, or in a folder or file of one.
fn stands_in(file: &str, place: &str) -> bool {
    file.strip_prefix(place).is_some_and(|rest| rest.starts_with(['/', '.']))
}

fn wing(file: &str) -> &str {
    file.split('/').next().expect("a name").trim_end_matches(".rs")
}

fn rank(file: &str) -> usize {
    WINGS.iter().position(|w| *w == wing(file)).unwrap_or_else(|| panic!("{file} stands in no wing"))
}

#[test]
fn the_reader_reads() {
    let tree = Tree::of([
        ("a/mod.rs".into(), "mod b;\nmod c;\npub use b::B; // use c::C;\nfn f() { c::g(\"d::h\") }".into()),
        ("a/b.rs".into(), "use crate::d::{self, e::{E, F as G}};\npub struct B;".into()),
        ("a/c.rs".into(), "use super::B;\npub fn g(_: &'static str) { let _ = r#\"crate::d\"#; }".into()),
        ("d.rs".into(), "fn h() -> char { '\"' }".into()),
        ("d/e.rs".into(), "pub struct E; pub struct F; fn i() { crate::a::f(); }".into()),
        ("f.rs".into(), "pub(in crate::d) fn j() {}".into()),
    ]);
    let imports = tree.imports();
    let of = |file| imports.get(file).into_iter().flatten().map(|(to, _)| *to).collect::<Vec<_>>();
    assert_eq!(of("a/mod.rs"), ["a/c.rs"], "what is only handed on is not used");
    assert_eq!(of("a/b.rs"), ["d.rs", "d/e.rs"]);
    assert_eq!(of("a/c.rs"), ["a/b.rs"], "seen through the file that hands it on");
    assert_eq!(of("d/e.rs"), ["a/mod.rs"]);
    assert_eq!(of("f.rs"), [""; 0], "who may see it is no use");
    assert_eq!(circle(&imports), ["a/b.rs", "a/c.rs", "a/mod.rs", "d/e.rs"]);
}

/// The first files that use each other, directly or through others; empty where there are none.
fn circle<'a>(imports: &BTreeMap<&'a str, BTreeMap<&'a str, BTreeSet<String>>>) -> Vec<&'a str> {
    let mut left: BTreeSet<&str> = imports.iter().flat_map(|(a, to)| to.keys().chain([a])).copied().collect();
    // Files that use none of the rest, or that none of the rest uses, are in no circle.
    loop {
        let uses = |a: &str| imports.get(a).is_some_and(|to| to.keys().any(|b| left.contains(b)));
        let used = |b: &str| left.iter().any(|a| imports.get(a).is_some_and(|to| to.contains_key(b)));
        let next: BTreeSet<&str> = left.iter().copied().filter(|f| uses(f) && used(f)).collect();
        if next.len() == left.len() {
            return left.into_iter().collect();
        }
        left = next;
    }
}

#[test]
fn every_wing_is_listed() {
    let tree = Tree::read();
    let found: BTreeSet<&str> = tree.files.values().map(|s| wing(&s.name)).filter(|w| *w != "lib").collect();
    assert_eq!(found, WINGS.iter().copied().collect());
    // The map of the source has a row for each but the program's first file, in this order.
    let map = include_str!("../../src/lib.rs");
    let places: Vec<usize> = WINGS[..WINGS.len() - 1]
        .iter()
        .map(|wing| {
            map.find(&format!("//! | [`{wing}`]"))
                .or(map.find(&format!("//! | `{wing}`")))
                .unwrap_or_else(|| panic!("{wing} is not on the map"))
        })
        .collect();
    assert!(places.is_sorted(), "{places:?}");
    // What it says of files is there.
    for word in
        map.split('`').filter(|word| word.contains('/') && *word != "src/" && !word.contains([' ', '*', '=', '{']))
    {
        assert!(std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src")).join(word).exists(), "no {word}");
    }
}

#[test]
fn no_files_use_each_other() {
    let tree = Tree::read();
    let imports = tree.imports();
    let tied = circle(&imports);
    let names = |file: &&str| {
        imports[file]
            .iter()
            .filter(|(to, _)| tied.contains(to))
            .map(|(to, n)| format!("{to}: {n:?}"))
            .collect::<Vec<_>>()
    };
    let told: Vec<_> = tied.iter().map(|file| (*file, names(file))).collect();
    assert!(tied.is_empty(), "{told:#?}");
}

#[test]
fn imports_go_down() {
    let tree = Tree::read();
    let imports = tree.imports();
    let count: usize = imports.values().map(BTreeMap::len).sum();
    assert!(count > 600, "only {count} imports found");
    for (from, to) in imports.iter().filter(|(from, _)| **from != "lib.rs") {
        for (to, names) in to {
            assert!(rank(to) <= rank(from), "{from} uses {to}, which stands above it: {names:?}");
        }
    }
    // The renderer knows pictures, no mechanics.
    let render = imports.iter().filter(|(f, _)| stands_in(f, "picture/render")).flat_map(|(_, to)| to.keys());
    for to in render {
        assert!(stands_in(to, "picture/render") || **to == *"picture/scene/mod.rs", "the renderer uses {to}");
    }
}

fn core(tree: &Tree) -> impl Iterator<Item = &Source> {
    tree.files.values().filter(|s| CORE.iter().any(|place| stands_in(&s.name, place)))
}

#[test]
fn outside_crates_stay_in_their_layer() {
    let mut seen = BTreeSet::new();
    for source in Tree::read().files.values() {
        for (name, allowed) in CRATES {
            if source.starts_from(name) {
                seen.insert(*name);
                assert!(allowed.iter().any(|place| stands_in(&source.name, place)), "{} uses {name}", source.name);
            }
        }
    }
    // A name that nothing uses would allow anything.
    let listed: BTreeSet<_> = CRATES.iter().map(|(name, _)| *name).collect();
    assert_eq!(seen, listed);
}

#[test]
fn clocks_files_and_environment_stay_at_the_edges() {
    let tree = Tree::read();
    for (part, edges) in EDGES {
        let (root, leaf) = part.split_once("::").expect("a path");
        let uses = tree.files.values().filter(|s| s.takes(root, leaf));
        let found: BTreeSet<&str> = uses.map(|s| s.name.as_str()).collect();
        assert_eq!(found, edges.iter().copied().collect(), "{part}");
    }
    // Nor does the core speak or draw lots; chance has no place in it at all.
    for source in core(&tree) {
        for word in ["println", "eprintln", "print", "eprint", "dbg", "rand", "thread_rng", "Instant", "SystemTime"] {
            assert!(!source.tokens.iter().any(|t| t == word), "{} says {word}", source.name);
        }
    }
}

/// What is derived is a query: nothing else keeps what it has made. What is made once for good is named here, with its
/// reason, and so is what compares identities, as private memos do.
#[test]
fn what_is_derived_is_kept_by_queries_alone() {
    const ONCE: &[(&str, &str)] = &[
        ("app/gallery.rs", "pictures of the machines that come along"),
        ("mechanics/machine/catalog.rs", "the machines that come along"),
        ("session/scenario/catalog.rs", "the scenarios that come along"),
        ("picture/scene/stage/workspace.rs", "bounds that follow from the planes it holds"),
        ("planning/pose_space/pattern.rs", "patterns that follow from the space they are of"),
    ];
    const SAME: &[(&str, &str)] = &[
        ("mechanics/machine/model.rs", "what copies of a machine share needs no comparison"),
        ("session/machines.rs", "what copies share needs no comparison"),
        ("session/script.rs", "what versions share needs no comparison"),
        ("app/state.rs", "framing follows where other views take their place"),
        ("picture/paint.rs", "what the graphics card has drawn already"),
        ("picture/render/solids.rs", "what the graphics card holds already"),
        ("picture/scene/mod.rs", "what scenes share needs no comparison"),
        ("picture/scene/views.rs", "what is known is compared without a copy of the run"),
        ("recording/entity.rs", "what a recording has written already"),
        ("recording/recorder.rs", "names change where other views take their place"),
        ("study/comparison/entries.rs", "rows change where other ways take their place"),
    ];
    let tree = Tree::read();
    let found = |words: &[&str]| -> BTreeSet<String> {
        let says = |source: &&Source| source.tokens.iter().any(|token| words.contains(&token.as_str()));
        let files = tree.files.values().filter(says).map(|source| source.name.clone());
        files.filter(|file| !stands_in(file, "query")).collect()
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
        ("session/scenario/catalog.rs", "the scenarios that come along are valid"),
        // Plain data is always TOML.
        ("mechanics/machine/file.rs", "a machine is plain data"),
        ("session/scenario/file.rs", "a scenario is plain data"),
        ("session/edit.rs", "an edit is plain data"),
    ];
    for source in core(&Tree::read()) {
        for line in source.code.lines() {
            let named = allowed.iter().any(|(file, words)| *file == source.name && line.contains(words));
            for word in [".unwrap()", ".expect(", "panic!", "todo!", "unimplemented!", "unreachable!"] {
                assert!(named || !line.contains(word), "{}: {}", source.name, line.trim());
            }
        }
    }
}
