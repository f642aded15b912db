//! The README and the guide: short enough, every link leads somewhere, every file shown can be read. Their commands are
//! run in `program/guide.rs`.

pub mod markdown;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use markdown::{addresses, blocks, definitions, labels, prose};
use stillbase::mechanics::assembly::{self, Assembly, builtin_assemblies};
use stillbase::mechanics::machine;
use stillbase::session::assembly::AssemblyScenario;
use stillbase::session::scenario::Scenario;

/// Fences that may stand in a page. `sh` and `console` are run, what they print is compared where it is shown; `sh
/// window` opens a window, `sh long` takes minutes, and `sh elsewhere` runs other programs.
const KINDS: &[&str] =
    &["sh", "sh window", "sh long", "sh elsewhere", "console", "toml", "csv", "json", "text", "rust"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A page by its path from the root of the repository.
pub fn read(page: &str) -> String {
    std::fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// The files of the guide, the index among them.
pub fn pages() -> BTreeSet<String> {
    let entries = std::fs::read_dir(root().join("src/guide")).expect("the guide");
    let name = |entry: std::io::Result<std::fs::DirEntry>| entry.expect("an entry").file_name();
    let names = entries.map(|entry| name(entry).to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".md")).map(|name| format!("src/guide/{name}")).collect()
}

fn all() -> Vec<(String, String)> {
    pages().into_iter().chain(["README.md".into()]).map(|page| (read(&page), page)).map(|(t, p)| (p, t)).collect()
}

#[test]
fn the_readme_is_one_screen_and_a_half() {
    let words = read("README.md").split_whitespace().count();
    assert!((200..=900).contains(&words), "{words} words");
}

/// Whether an address leads somewhere from a folder; what lies on other hosts is not looked at.
fn leads(folder: &Path, address: &str) -> bool {
    let outside = address.starts_with("https://");
    let (file, heading) = address.split_once('#').unwrap_or((address, ""));
    outside || (heading.is_empty() && resolved(folder, file).exists())
}

/// A path without its `..`, for folders on the way need not exist.
fn resolved(folder: &Path, file: &str) -> PathBuf {
    let mut path = folder.to_owned();
    for part in file.split('/') {
        if part == ".." { _ = path.pop() } else { path.push(part) }
    }
    path
}

#[test]
fn every_link_goes_somewhere() {
    let mut links = 0;
    for (page, text) in all() {
        let (prose, folder) = (prose(&text), root().join(&page));
        let folder = folder.parent().expect("a folder");
        let known = definitions(&prose);
        for address in addresses(&prose).into_iter().chain(known.iter().map(|(_, address)| *address)) {
            assert!(leads(folder, address), "{page}: {address} is not there");
            links += 1;
        }
        for label in labels(&prose) {
            assert!(known.iter().any(|(name, _)| *name == label), "{page}: [{label}] is not defined");
        }
        for (name, _) in &known {
            assert!(labels(&prose).contains(name), "{page}: [{name}] is defined, but not used");
        }
    }
    assert!(links > 60, "only {links} links found");
}

/// In the documentation of the crate the same labels lead to the same places.
#[test]
fn labels_lead_to_the_same_place_in_the_docs() {
    let list = read("src/guide/links.txt");
    let docs = definitions(&list);
    let written = root().join("target/doc/stillbase/guide/page");
    let mut used = BTreeSet::new();
    for page in pages() {
        let text = read(&page);
        let text = prose(&text);
        let near = addresses(&text).into_iter().find(|address| !address.starts_with("https://"));
        assert_eq!(
            near, None,
            "{page}: a link within the repository wants a label, so that it leads somewhere in both"
        );
        for (label, address) in definitions(&text) {
            if address.starts_with("https://") {
                continue;
            }
            let in_docs = docs.iter().find(|(name, _)| *name == label);
            let (_, in_docs) = in_docs.unwrap_or_else(|| panic!("{page}: [{label}] is not in links.txt"));
            let here = resolved(&root().join("src/guide"), address);
            let there = match in_docs.strip_prefix("crate::guide") {
                Some("") => root().join("src/guide/README.md"),
                Some(module) => root().join(format!("src/guide/{}.md", module.trim_start_matches(':'))),
                None => resolved(&written, in_docs),
            };
            assert_eq!(here, there, "{page}: [{label}]");
            used.insert(label.to_owned());
        }
    }
    let listed: BTreeSet<String> = docs.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(used, listed, "links.txt lists what no page uses");
}

/// Every page is a module of the docs, in the order of the index.
#[test]
fn the_index_lists_every_page() {
    let modules = read("src/guide/mod.rs");
    let modules: Vec<&str> =
        modules.lines().filter_map(|line| line.trim().strip_suffix(".md\",")?.rsplit('"').next()).collect();
    let index = read("src/guide/README.md");
    let listed: Vec<&str> = index
        .lines()
        .filter(|line| line.starts_with("* ["))
        .map(|line| line.split("][").nth(1).and_then(|rest| rest.split(']').next()).expect("a label"))
        .collect();
    assert_eq!(modules, listed);
    let files: BTreeSet<String> = modules.iter().map(|name| format!("src/guide/{name}.md")).collect();
    assert_eq!(files, pages().into_iter().filter(|page| !page.ends_with("README.md")).collect());
}

/// What a picture shows is there in both themes, and every picture that is kept is shown.
#[test]
fn pictures_are_shown_in_both_themes() {
    let shown: BTreeSet<String> = all()
        .iter()
        .flat_map(|(_, text)| {
            let text = prose(text);
            let own: Vec<String> = addresses(&text).into_iter().map(String::from).collect();
            own.into_iter().chain(definitions(&text).into_iter().map(|(_, address)| address.into())).collect::<Vec<_>>()
        })
        .filter_map(|address| Some(address.split_once("assets/pictures/")?.1.to_owned()))
        .collect();
    let entries = std::fs::read_dir(root().join("assets/pictures")).expect("pictures");
    let kept: BTreeSet<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    assert_eq!(shown, kept);
    for name in &kept {
        let other = name.replace("-dark.", "-light.");
        let other = if other == *name { name.replace("-light.", "-dark.") } else { other };
        assert!(other != *name && kept.contains(&other), "{name} lacks its other theme");
    }
}

/// A machine or a scenario is read as it stands; what is a part of one goes into a scenario that is complete.
#[test]
fn toml_blocks_are_read() {
    let mut count = 0;
    for (page, text) in all() {
        // Those that a page has shown so far.
        let mut assemblies: Vec<(String, Assembly)> = Vec::new();
        for block in blocks(&text) {
            let place = format!("{page}:{}", block.line);
            let kind = block.kind.split(' ').next().expect("a word");
            assert!(
                KINDS.contains(&block.kind) || ["toml", "csv", "json", "python", "text"].contains(&kind),
                "{place}: {}",
                block.kind
            );
            if kind != "toml" {
                continue;
            }
            count += 1;
            if block.text.contains("[[drive]]") {
                machine::parse(&block.text, &place).unwrap_or_else(|error| panic!("{error}"));
                continue;
            }
            if block.text.contains("kind = \"assembly\"") {
                let read = assembly::parse(&block.text, &place, &machine::named);
                let (_, name) = block.kind.split_once(' ').expect("the name of a file");
                assemblies.push((name.to_owned(), read.unwrap_or_else(|error| panic!("{error}"))));
                continue;
            }
            let of = |name: &str| block.text.contains(&format!("machine = {name:?}"));
            let own = assemblies.iter().find(|(name, _)| of(name)).map(|(_, assembly)| assembly);
            let known = || builtin_assemblies().iter().find(|assembly| of(&assembly.name));
            if let Some(assembly) = own.or_else(known) {
                let read = AssemblyScenario::parse(&block.text, &place, assembly.clone());
                read.unwrap_or_else(|error| panic!("{error}"));
                continue;
            }
            let mut whole = block.text.clone();
            if block.kind == "toml" {
                if !whole.contains("machine = ") {
                    whole.insert_str(0, "machine = \"nine-link\"\n");
                }
                if !whole.contains("[task]") {
                    whole.push_str("[task]\nkind = \"reactionless\"\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\nb = 2.4\n");
                }
            }
            Scenario::parse(&whole, &place, None).unwrap_or_else(|error| panic!("{error}"));
        }
    }
    assert!(count > 5, "only {count} TOML blocks found");
}
