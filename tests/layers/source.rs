//! The sources as a graph: which file takes a name from which.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// One source file, as far as its imports go.
pub struct Source {
    /// From `src/`, with `/`.
    pub name: String,
    /// Words and marks, without comments; a string is one token `"`.
    pub tokens: Vec<String>,
    /// The same as text, with its strings, line by line.
    pub code: String,
    /// Names that it defines.
    defined: BTreeSet<String>,
    /// What it uses, and whether it hands that on.
    uses: Vec<Use>,
}

struct Use {
    public: bool,
    path: Vec<String>,
    name: String,
}

type Module = Vec<String>;

/// All sources by their module paths.
pub struct Tree {
    pub files: BTreeMap<Module, Source>,
}

impl Tree {
    pub fn read() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let mut paths = Vec::new();
        collect(&root, &mut paths);
        let named = |path: PathBuf| {
            let name = path.strip_prefix(&root).expect("under src").to_string_lossy().replace('\\', "/");
            (name, std::fs::read_to_string(&path).expect("readable"))
        };
        Self::of(paths.into_iter().map(named))
    }

    /// Of file names and their text.
    pub fn of(files: impl IntoIterator<Item = (String, String)>) -> Self {
        let file = |(name, text): (String, String)| (module_of(&name), Source::of(name, &text));
        Self { files: files.into_iter().map(file).collect() }
    }

    /// For each file the files that it takes something from, and what.
    pub fn imports(&self) -> BTreeMap<&str, BTreeMap<&str, BTreeSet<String>>> {
        let mut all: BTreeMap<&str, BTreeMap<&str, BTreeSet<String>>> = BTreeMap::new();
        for (module, source) in &self.files {
            let mut note = |path: &[String]| {
                let Some(target) = self.absolute(module, path).and_then(|path| self.home(&path, 0)) else { return };
                if target != *module {
                    let to = self.files[&target].name.as_str();
                    all.entry(&source.name).or_default().entry(to).or_default().insert(path.join("::"));
                }
            };
            for one in &source.uses {
                // What a file only hands on from its own folder it does not use itself.
                let own = self.absolute(module, &one.path).is_some_and(|path| path.starts_with(module));
                if !(one.public && own && !source.names(&one.name)) {
                    note(&one.path);
                }
            }
            for path in source.paths() {
                let local = source.uses.iter().find(|u| u.name == path[0]);
                match local {
                    Some(known) => note(&[&known.path[..], &path[1..]].concat()),
                    None => note(&path),
                }
            }
        }
        all
    }

    fn absolute(&self, module: &Module, path: &[String]) -> Option<Module> {
        let first = path.first()?.as_str();
        match first {
            "crate" | "stillbase" => Some(path[1..].to_vec()),
            "self" => Some([&module[..], &path[1..]].concat()),
            "super" => {
                let up = path.iter().take_while(|p| *p == "super").count();
                Some([&module[..module.len().checked_sub(up)?], &path[up..]].concat())
            }
            _ => {
                let child = [&module[..], &path[..1]].concat();
                self.files.contains_key(&child).then(|| [&module[..], path].concat())
            }
        }
    }

    /// The file that defines what a path names, seen through files that only hand it on.
    fn home(&self, path: &[String], depth: usize) -> Option<Module> {
        let known = (0..=path.len()).rev().find(|&k| self.files.contains_key(&path[..k]))?;
        let (module, rest) = (path[..known].to_vec(), &path[known..]);
        let Some(name) = rest.first() else { return Some(module) };
        let source = &self.files[&module];
        if depth > 12 || source.defined.contains(name) {
            return Some(module);
        }
        let handed = source.uses.iter().find(|u| u.name == *name);
        match handed.and_then(|u| self.absolute(&module, &u.path)) {
            Some(from) => self.home(&from, depth + 1),
            None if handed.is_some() => None,
            None => Some(module),
        }
    }
}

impl Source {
    fn of(name: String, text: &str) -> Self {
        let (tokens, code) = read(text);
        let mut defined = BTreeSet::new();
        let mut uses = Vec::new();
        for (i, token) in tokens.iter().enumerate() {
            match token.as_str() {
                "fn" | "struct" | "enum" | "trait" | "const" | "static" | "type" | "union" if i + 1 < tokens.len() => {
                    defined.insert(tokens[i + 1].clone());
                }
                "use" => {
                    let mut leaves = Vec::new();
                    tree(&tokens, i + 1, &[], &mut leaves);
                    let public = i > 0 && (tokens[i - 1] == "pub" || tokens[i - 1] == ")");
                    uses.extend(leaves.into_iter().map(|(path, name)| Use { public, path, name }));
                }
                _ => {}
            }
        }
        Self { name, tokens, code, defined, uses }
    }

    /// Whether a path of it begins with an outside crate.
    pub fn starts_from(&self, name: &str) -> bool {
        self.uses.iter().any(|u| u.path[0] == name) || self.paths().iter().any(|path| path[0] == name)
    }

    /// Whether it names `root::leaf`.
    pub fn takes(&self, root: &str, leaf: &str) -> bool {
        let is = |path: &[String]| path.len() > 1 && path[0] == root && path[1] == leaf;
        self.uses.iter().any(|u| is(&u.path)) || self.paths().iter().any(|path| is(path))
    }

    /// Whether a name stands anywhere but where it is imported.
    fn names(&self, name: &str) -> bool {
        let mut inside = false;
        self.tokens.iter().any(|t| {
            inside = (inside || t == "use") && t != ";";
            !inside && t == name
        })
    }

    /// Paths `a::b::…` outside of imports.
    fn paths(&self) -> Vec<Vec<String>> {
        let (mut all, mut inside, mut path): (Vec<Vec<String>>, _, Vec<String>) = (Vec::new(), false, Vec::new());
        let mut joined = false;
        // Who may see a name is no use of anything: `pub(in a::b)`.
        let mut sees = false;
        for (i, token) in self.tokens.iter().enumerate() {
            inside = (inside || token == "use") && token != ";";
            sees = (sees || self.tokens[..i].ends_with(&["pub", "(", "in"].map(String::from))) && token != ")";
            let word = !inside && !sees && token.chars().all(|c| c.is_alphanumeric() || c == '_');
            if word && (joined || path.is_empty()) {
                path.push(token.clone());
                joined = false;
            } else if token == "::" && !path.is_empty() && !joined && !inside && !sees {
                joined = true;
            } else {
                if path.len() > 1 {
                    all.push(std::mem::take(&mut path));
                }
                path = if word { vec![token.clone()] } else { Vec::new() };
                joined = false;
            }
        }
        all
    }
}

/// The leaves of one import, each with the name that it goes by.
fn tree(tokens: &[String], mut i: usize, before: &[String], leaves: &mut Vec<(Vec<String>, String)>) -> usize {
    let mut path = before.to_vec();
    loop {
        match tokens[i].as_str() {
            "::" => i += 1,
            "{" => {
                i += 1;
                while tokens[i] != "}" {
                    i = tree(tokens, i, &path, leaves);
                    i += usize::from(tokens[i] == ",");
                }
                return i + 1;
            }
            "as" => {
                leaves.push((path, tokens[i + 1].clone()));
                return i + 2;
            }
            "," | "}" | ";" => {
                let name = path.last().cloned().unwrap_or_default();
                leaves.push((path, name));
                return i;
            }
            "self" if !path.is_empty() => i += 1,
            // Everything of a module: its file is what is named.
            "*" => {
                leaves.push((path, "*".into()));
                return i + 1;
            }
            word => {
                path.push(word.to_owned());
                i += 1;
            }
        }
    }
}

/// Tokens of a source, and its text without comments.
fn read(text: &str) -> (Vec<String>, String) {
    let c: Vec<char> = text.chars().collect();
    let (mut tokens, mut code, mut i) = (Vec::new(), String::new(), 0);
    let at = |i: usize| c.get(i).copied().unwrap_or(' ');
    while i < c.len() {
        let start = i;
        match c[i] {
            '/' if at(i + 1) == '/' => {
                while i < c.len() && c[i] != '\n' {
                    i += 1;
                }
                continue;
            }
            'r' if (at(i + 1) == '"' || at(i + 1) == '#') && !(i > 0 && is_word(at(i - 1))) => {
                let marks = c[i + 1..].iter().take_while(|c| **c == '#').count();
                if at(i + 1 + marks) != '"' {
                    i += 1;
                    continue;
                }
                let end: String = std::iter::once('"').chain(std::iter::repeat_n('#', marks)).collect();
                let rest: String = c[i + 2 + marks..].iter().collect();
                let long = rest.find(&end).map_or(rest.len(), |at| at + end.len());
                i += 2 + marks + rest[..long].chars().count();
                tokens.push("\"".into());
            }
            '"' => {
                i += 1;
                while i < c.len() && c[i] != '"' {
                    i += 1 + usize::from(c[i] == '\\');
                }
                i += 1;
                tokens.push("\"".into());
            }
            // A letter in quotes, and not a lifetime.
            '\'' if at(i + 1) == '\\' || at(i + 2) == '\'' => {
                i += 2 + usize::from(at(i + 1) == '\\');
                while at(i) != '\'' && i < c.len() {
                    i += 1;
                }
                i += 1;
            }
            w if is_word(w) => {
                while i < c.len() && is_word(c[i]) {
                    i += 1;
                }
                // `impl Trait + use<'a>` imports nothing.
                let word: String = c[start..i].iter().collect();
                tokens.push(if word == "use" && at(i) == '<' { "captures".into() } else { word });
            }
            ':' if at(i + 1) == ':' => {
                i += 2;
                tokens.push("::".into());
            }
            other => {
                i += 1;
                if !other.is_whitespace() {
                    tokens.push(other.to_string());
                }
            }
        }
        code.extend(&c[start..i.min(c.len())]);
    }
    (tokens, code)
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn module_of(name: &str) -> Module {
    let mut parts: Module = name.trim_end_matches(".rs").split('/').map(String::from).collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib")) {
        parts.pop();
    }
    parts
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
