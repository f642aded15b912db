//! The user's own machines and scenarios: the recent files, and those beside the machine that was saved last.

use std::path::{Path, PathBuf};

use super::gallery::portrait_of;
use stillbase_files::stamp::FileStamp;
use stillbase_files::text::{names_in, read};
use stillbase_picture::scene::portrait::Portrait;
use stillbase_query::{Queries, QuickQuery, QuickWork};
use stillbase_session::scenario::{FileContent, Scenario, content};
use stillbase_settings::text::shorten_message;

/// Largest number of files beside the machine that was saved last.
const MOST_BESIDE: usize = 24;

/// A file of the user.
pub struct OwnFile {
    /// Its path.
    pub path: PathBuf,
    /// Whether it is a recent file; else it lies beside one.
    pub is_recent: bool,
    /// What it holds, or why it cannot be opened.
    pub content: Result<OwnContent, String>,
}

/// What a file of the user holds.
pub struct OwnContent {
    /// Its picture.
    pub portrait: Portrait,
    /// Number of drives of its machine.
    pub drives: usize,
    /// Whether it is a machine; else it is a scenario or a session.
    pub is_machine: bool,
    /// Its title and its summary.
    pub title: String,
    pub summary: String,
}

impl OwnFile {
    fn of(path: &Path, is_recent: bool) -> Self {
        let content = match path.exists() {
            true => OwnContent::of(path),
            false => Err("the file is not there any more".to_owned()),
        };
        Self { path: path.to_owned(), is_recent, content }
    }

    /// Returns the name of the file.
    pub fn name(&self) -> String {
        self.path.file_name().unwrap_or(self.path.as_os_str()).to_string_lossy().into_owned()
    }
}

impl OwnContent {
    fn of(path: &Path) -> Result<Self, String> {
        let found = stillbase_files::any_scenario(&path.display().to_string());
        let scenario = found.map_err(|why| shorten_message(&why.to_string()).into_owned())?.scenario;
        let is_machine = read(path).is_ok_and(|text| content(&text) == Some(FileContent::Machine));
        let Scenario { machine, title, summary, name, .. } = &scenario;
        let title = match (is_machine, title.is_empty()) {
            (true, _) => machine.name(),
            (false, true) => name,
            (false, false) => title,
        };
        let summary = if is_machine { &machine.spec().summary } else { summary };
        Ok(Self {
            portrait: portrait_of(&scenario),
            drives: machine.drives(),
            is_machine,
            title: title.to_owned(),
            summary: summary.clone(),
        })
    }
}

/// Query for the user's files: recent ones, with the time of change and size of each and of its folder.
struct OwnFiles;

impl QuickQuery for OwnFiles {
    type Input = (Vec<(PathBuf, [Option<FileStamp>; 2])>, bool);
    type Answer = Vec<OwnFile>;

    fn answer((recent, with_beside): &Self::Input) -> Self::Answer {
        let mut files: Vec<OwnFile> = recent.iter().map(|(path, _)| OwnFile::of(path, true)).collect();
        let is_machine = |file: &&OwnFile| file.content.as_ref().is_ok_and(|content| content.is_machine);
        let folder = files.iter().find(is_machine).and_then(|file| file.path.parent()).filter(|_| *with_beside);
        let beside = folder.map_or_else(Vec::new, |folder| {
            let paths = names_in(folder).into_iter().map(|name| folder.join(name));
            let others = paths.filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
            let new = others.filter(|path| !recent.iter().any(|(own, _)| own == path)).take(MOST_BESIDE);
            new.map(|path| OwnFile::of(&path, false)).filter(|file| file.content.is_ok()).collect()
        });
        files.extend(beside);
        files
    }
}

/// Returns the recent files, with those beside the machine that was saved last if `with_beside`; `None` before they
/// are read.
pub fn own_files(queries: &Queries, recent: &[PathBuf], with_beside: bool) -> Option<std::sync::Arc<Vec<OwnFile>>> {
    let stamps = |path: &PathBuf| [Some(path.as_path()), path.parent()].map(|path| FileStamp::of(path?));
    let files = recent.iter().map(|path| (path.clone(), stamps(path))).collect();
    queries.ask_in_background::<QuickWork<OwnFiles>>(&(files, with_beside)).last
}
