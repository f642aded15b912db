//! Imports go one way: a module uses those below it only, outside crates stay in their layer, and clocks, files and
//! the environment at the edges.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// From the words at the bottom to the edges; modules of one row may use each other.
const LAYERS: &[&[&str]] = &[
    &["planar", "keys", "range", "text"],
    &["machine"],
    &["kinematics"],
    &["dynamics"],
    &["joint_forces"],
    &["balance"],
    &["reactionless"],
    &["pose_constant"],
    &["plan"],
    &["plant"],
    &["control"],
    &["spectrum"],
    &["frame", "tally", "audit"],
    &["simulation"],
    &["signals"],
    // A scenario holds the edits of a saved session, and its tolerances; a session starts from a scenario, and so does
    // the simulation of a varied machine.
    &["scenario", "session", "tolerance"],
    &["verdict"],
    &["compare"],
    &["scene"],
    &["render"],
    &["files"],
    // The desk records, and the pictures of a recording are drawn as the desk draws.
    &["headless", "ui"],
    &["window"],
    // The program around the library.
    &["commands", "main"],
];

/// Modules that neither draw, nor talk to a person, nor keep files: what `--no-default-features` builds, less `files`.
const CORE: &[&str] = &[
    "planar",
    "machine",
    "kinematics",
    "dynamics",
    "joint_forces",
    "balance",
    "reactionless",
    "pose_constant",
    "plan",
    "plant",
    "control",
    "spectrum",
    "frame",
    "tally",
    "audit",
    "keys",
    "text",
    "range",
    "simulation",
    "signals",
    "scenario",
    "session",
    "verdict",
    "compare",
    "tolerance",
    "scene",
];

/// Outside crates and the modules that may know them.
const CRATES: &[(&str, &[&str])] = &[
    ("wgpu", &["render", "ui"]),
    ("bytemuck", &["render"]),
    ("pollster", &["render"]),
    ("png", &["render"]),
    ("egui", &["ui", "window"]),
    ("egui_wgpu", &["ui"]),
    ("egui_plot", &["ui"]),
    ("eframe", &["window"]),
    ("winit", &["window"]),
    ("libloading", &["window"]),
    ("rerun", &["headless"]),
    ("clap", &["commands", "main"]),
    ("indicatif", &["commands"]),
    ("csv", &["commands"]),
    ("serde_json", &["commands"]),
    ("parquet", &["commands"]),
    ("signal_hook", &["commands"]),
    ("toml", &["keys", "machine", "plant", "scenario", "session", "tolerance", "commands"]),
    ("rand_chacha", &["tolerance"]),
    ("libm", &["tolerance"]),
    ("realfft", &["spectrum"]),
    ("clarabel", &["plan"]),
];

/// Parts of the standard library that reach outside, and the files that are edges.
const EDGES: &[(&str, &[&str])] = &[
    ("std::time", &["render/shader.rs", "window.rs"]),
    ("std::env", &["main.rs", "window.rs"]),
    ("std::thread", &["commands/interrupt.rs", "commands/tolerance/parallel.rs", "headless/store.rs"]),
    ("std::net", &[]),
    ("std::process", &["commands/failure.rs", "files.rs", "files/fault.rs", "main.rs"]),
    // Text comes in at one place; everything else of the core takes it from there.
    (
        "std::fs",
        &[
            "commands/tolerance/rows.rs",
            "commands/tolerance/seal.rs",
            "files.rs",
            "render/offscreen.rs",
            "render/shader.rs",
            "text.rs",
        ],
    ),
];

struct Source {
    /// From `src/`, with `/`.
    name: String,
    /// Its top-level module.
    module: String,
    /// Without comments.
    code: String,
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&root, &mut files);
    files.sort();
    let read = |file: &PathBuf| {
        let name = file.strip_prefix(&root).expect("under src").to_string_lossy().replace('\\', "/");
        let module = name.split('/').next().expect("a name").trim_end_matches(".rs").to_owned();
        let text = std::fs::read_to_string(file).expect("readable");
        let code = text.lines().map(without_comment).collect::<Vec<_>>().join("\n");
        Source { name, module, code }
    };
    files.iter().map(read).collect()
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
}

/// A line up to `//` outside of a string.
fn without_comment(line: &str) -> &str {
    let (mut quoted, mut before) = (false, ' ');
    for (i, c) in line.char_indices() {
        match c {
            '"' if before != '\\' => quoted = !quoted,
            '/' if before == '/' && !quoted => return &line[..i - 1],
            _ => {}
        }
        before = c;
    }
    line
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Where a path such as `std::fs` begins in code, as a whole word.
fn places<'a>(code: &'a str, path: &'a str) -> impl Iterator<Item = usize> + 'a {
    code.match_indices(path).map(|(i, _)| i).filter(|&i| {
        let before = code[..i].chars().next_back().is_none_or(|c| !is_word(c));
        before && code[i + path.len()..].chars().next().is_none_or(|c| !is_word(c))
    })
}

/// Names that follow `prefix::`, also in braces: `crate::{a, b::c}` names a and b.
fn named_after(code: &str, prefix: &str) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let word = |s: &str| s.trim_start().chars().take_while(|c| is_word(*c)).collect::<String>();
    for at in places(code, prefix) {
        let Some(rest) = code[at + prefix.len()..].strip_prefix("::") else { continue };
        let Some(group) = rest.strip_prefix('{') else {
            names.insert(word(rest));
            continue;
        };
        let mut depth = 0;
        let mut item = String::new();
        for c in group.chars() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    names.insert(word(&std::mem::take(&mut item)));
                }
                c => item.push(c),
            }
        }
        names.insert(word(&item));
    }
    names.remove("");
    names
}

fn rank(module: &str) -> usize {
    LAYERS.iter().position(|row| row.contains(&module)).unwrap_or_else(|| panic!("{module} stands in no layer"))
}

#[test]
fn the_reader_reads() {
    let names = |code| named_after(code, "crate").into_iter().collect::<Vec<_>>();
    assert_eq!(names("use crate::a::B; crate::c::d(); mycrate::e; pub(crate) fn f()"), ["a", "c"]);
    assert_eq!(names("use crate::{a, b::{c, d}, e::f};"), ["a", "b", "e"]);
    assert_eq!(without_comment("let x = \"http://\"; // std::fs"), "let x = \"http://\"; ");
    assert_eq!(places("std::fs std::fsx my_std::fs", "std::fs").count(), 1);
}

#[test]
fn every_module_has_its_layer() {
    let modules: BTreeSet<String> = sources().into_iter().map(|s| s.module).filter(|m| m != "lib").collect();
    let listed: BTreeSet<String> = LAYERS.iter().flat_map(|r| r.iter().map(|m| m.to_string())).collect();
    assert_eq!(modules, listed);
}

#[test]
fn imports_go_down() {
    let mut used: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for source in sources().iter().filter(|s| s.module != "lib") {
        let library = if ["main", "commands"].contains(&source.module.as_str()) { "stillbase" } else { "crate" };
        for name in named_after(&source.code, library) {
            // Items of the crate itself, such as its version, begin with a capital or are macros.
            if name.chars().all(|c| c.is_lowercase() || c == '_') {
                used.entry(source.name.clone()).or_default().insert(name);
            }
        }
        // Other ways up would not be seen here.
        let top = !source.name.contains('/') || source.name.ends_with("/mod.rs");
        let up = if top { "super" } else { "super::super" };
        assert_eq!(
            places(&source.code, up).filter(|i| !source.code[..*i].ends_with("pub(")).count(),
            0,
            "{}",
            source.name
        );
    }
    let count: usize = used.values().map(BTreeSet::len).sum();
    assert!(count > 60, "only {count} imports found");
    for (file, names) in &used {
        let module = file.split('/').next().expect("a name").trim_end_matches(".rs");
        for name in names.iter().filter(|n| *n != module) {
            let together = LAYERS[rank(module)].contains(&name.as_str());
            assert!(rank(name) < rank(module) || together, "{file} uses {name}, which stands above it");
        }
    }
    // The renderer knows pictures, no mechanics.
    let render = used.iter().filter(|(f, _)| f.starts_with("render/")).flat_map(|(_, n)| n);
    assert_eq!(render.collect::<BTreeSet<_>>(), BTreeSet::from([&"render".to_string(), &"scene".to_string()]));
}

#[test]
fn outside_crates_stay_in_their_layer() {
    let mut seen = BTreeSet::new();
    for source in sources() {
        for (name, allowed) in CRATES {
            let uses = !named_after(&source.code, name).is_empty()
                || places(&source.code, name).any(|i| source.code[..i].ends_with("use "));
            if uses {
                seen.insert(*name);
                assert!(allowed.contains(&source.module.as_str()), "{} uses {name}", source.name);
            }
        }
    }
    // A name that nothing uses would allow anything.
    let listed: BTreeSet<_> = CRATES.iter().map(|(name, _)| *name).collect();
    assert_eq!(seen, listed);
}

#[test]
fn clocks_files_and_environment_stay_at_the_edges() {
    let sources = sources();
    for (part, edges) in EDGES {
        let (root, leaf) = part.split_once("::").expect("a path");
        let uses = sources.iter().filter(|s| named_after(&s.code, root).contains(leaf));
        let found: BTreeSet<&str> = uses.map(|s| s.name.as_str()).collect();
        assert_eq!(found, edges.iter().copied().collect(), "{part}");
    }
    // Nor does the core speak or draw lots; chance has no place in it at all.
    for source in sources.iter().filter(|s| CORE.contains(&s.module.as_str())) {
        for word in ["println", "eprintln", "print", "eprint", "dbg", "rand", "thread_rng", "Instant", "SystemTime"] {
            assert_eq!(places(&source.code, word).count(), 0, "{} says {word}", source.name);
        }
    }
}

/// Whatever comes from outside ends in an error. What may still panic is named here, with its reason.
#[test]
fn the_library_does_not_panic() {
    let allowed = [
        // Files that are compiled in; a test reads each.
        ("machine/catalog.rs", "the machines that come along are valid"),
        ("scenario/mod.rs", "the scenarios that come along are valid"),
        // Plain data is always TOML.
        ("machine/file.rs", "a machine is plain data"),
        ("scenario/mod.rs", "a scenario is plain data"),
        ("session/edit.rs", "an edit is plain data"),
    ];
    for source in sources().iter().filter(|s| CORE.contains(&s.module.as_str())) {
        for line in source.code.lines() {
            let named = allowed.iter().any(|(file, words)| *file == source.name && line.contains(words));
            for word in [".unwrap()", ".expect(", "panic!", "todo!", "unimplemented!", "unreachable!"] {
                assert!(named || !line.contains(word), "{}: {}", source.name, line.trim());
            }
        }
    }
}
