//! Names the commit that is built, for `stillbase --version`: that of the variable `STILLBASE_COMMIT`, or else the one that
//! this checkout is at. It runs again only when that changes. Where there is neither, it names none.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// Number of shown digits of a commit.
const DIGITS: usize = 12;

fn main() {
    println!("cargo::rerun-if-changed=src/build.rs");
    println!("cargo::rerun-if-env-changed=STILLBASE_COMMIT");
    let given = env::var("STILLBASE_COMMIT").ok().filter(|commit| !commit.is_empty());
    if let Some(commit) = given.or_else(checked_out) {
        println!("cargo::rustc-env=STILLBASE_COMMIT={commit}");
    }
}

/// Returns the commit of the checkout; `None` if this is none.
fn checked_out() -> Option<String> {
    let own = git_folder(&Path::new(&env::var_os("CARGO_MANIFEST_DIR")?).join(".git"))?;
    // A worktree has its own head; branches belong to all worktrees.
    let common = fs::read_to_string(own.join("commondir")).map_or_else(|_| own.clone(), |at| own.join(at.trim()));
    let head = watched(&own.join("HEAD"))?;
    // Each commit adds a line here, also the first one of a branch whose file is not there yet.
    let _ = watched(&own.join("logs/HEAD"));
    let commit = match head.trim().strip_prefix("ref: ") {
        None => head.trim().to_owned(),
        Some(branch) => watched(&common.join(branch)).or_else(|| packed(&common, branch))?,
    };
    let commit = commit.trim().get(..DIGITS)?;
    commit.bytes().all(|digit| digit.is_ascii_hexdigit()).then(|| commit.to_owned())
}

/// Returns the folder of git: that of this name, or that which the file of this name states, in a worktree.
fn git_folder(place: &Path) -> Option<PathBuf> {
    if place.is_dir() {
        return Some(place.to_owned());
    }
    let stated = fs::read_to_string(place).ok()?;
    Some(place.parent()?.join(stated.strip_prefix("gitdir: ")?.trim()))
}

/// Returns the commit of a branch that has no file of its own.
fn packed(common: &Path, branch: &str) -> Option<String> {
    let all = watched(&common.join("packed-refs"))?;
    all.lines()
        .find_map(|line| line.split_once(' ').filter(|(_, name)| *name == branch).map(|(commit, _)| commit.into()))
}

/// Returns the text of a file, and has this script run again when it changes. Cargo runs it each time for a file that is
/// not there.
fn watched(file: &Path) -> Option<String> {
    let text = fs::read_to_string(file).ok()?;
    println!("cargo::rerun-if-changed={}", file.display());
    Some(text)
}
