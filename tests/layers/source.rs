//! The sources as text.

use std::path::{Path, PathBuf};

/// A source file.
pub struct Source {
    /// Path from `src/`, with `/`.
    pub name: String,
    /// Its lines without comments.
    pub code: String,
}

impl Source {
    /// Returns all sources, by name.
    pub fn all() -> Vec<Self> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut paths = Vec::new();
        collect(&root, &mut paths);
        paths.sort();
        let read = |path: &PathBuf| {
            let name = path.strip_prefix(&root).expect("under src").to_string_lossy().replace('\\', "/");
            let text = std::fs::read_to_string(path).expect("readable");
            let code = text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join("\n");
            Self { name, code }
        };
        paths.iter().map(read).collect()
    }

    /// Whether a word stands in its code.
    pub fn says(&self, word: &str) -> bool {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        self.code.match_indices(word).any(|(at, _)| {
            let (before, after) = (&self.code[..at], &self.code[at + word.len()..]);
            !before.ends_with(is_part) && !after.starts_with(is_part)
        })
    }

    /// Whether it stands in a crate, or in a folder or file of one.
    pub fn is_in(&self, place: &str) -> bool {
        self.name.strip_prefix(place).is_some_and(|rest| rest.starts_with(['/', '.']))
    }
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
