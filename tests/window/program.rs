//! The running program, as a person has it: a window, a pointer, keys, and what it says of itself.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use stillbase::session::scenario::Scenario;

use super::display::{Display, ENTER};
use super::process::Owned;
use super::reader::{Bus, Node, Tree};
use super::wait::{pause, wait_for};
use crate::folder::Folder;

/// A place to work at: screen, bus and a home of its own, which outlast the program.
pub struct Desk {
    of: &'static str,
    pub display: Display,
    pub bus: Bus,
    pub home: Folder,
    program: Option<Owned>,
}

impl Desk {
    pub fn new(of: &'static str, size: [u16; 2]) -> Self {
        let home = Folder::new(of);
        let display = Display::start(size);
        let bus = Bus::start(&home);
        Self { of, display, bus, home, program: None }
    }

    /// Starts the program and waits until it can be read; how long that took.
    pub fn open(&mut self, arguments: &[&str]) -> Duration {
        self.open_with(arguments, |command| command)
    }

    /// The same with something of its own.
    pub fn open_with(&mut self, arguments: &[&str], change: fn(&mut Command) -> &mut Command) -> Duration {
        let log = File::options().create(true).append(true).open(self.home.path("log")).expect("a file");
        let mut command = Command::new(env!("CARGO_BIN_EXE_stillbase"));
        command.args(arguments).current_dir(&self.home.0).stdin(Stdio::null());
        command.stdout(log.try_clone().expect("a file")).stderr(log);
        command.env("DISPLAY", &self.display.name).env_remove("WAYLAND_DISPLAY");
        command.env("DBUS_SESSION_BUS_ADDRESS", &self.bus.address);
        // No dialog of this machine opens beside the window.
        command.env("HOME", &self.home.0).env("RUST_BACKTRACE", "1").env("PATH", "/nonexistent");
        for folder in ["XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME", "XDG_RUNTIME_DIR"] {
            command.env(folder, &self.home.0);
        }
        let begun = Instant::now();
        self.program = Some(Owned::start(change(&mut command)));
        self.seen();
        begun.elapsed()
    }

    /// Waits until there is a window that can be read, and gives it the keys.
    pub fn seen(&mut self) {
        wait_for("a window", 60, || {
            assert!(self.is_running(), "the program has ended: {}", self.log());
            self.display.window()
        });
        self.bus.wait_for("the name of the scene", 60, |tree| tree.containing("Scene:").cloned());
        self.display.focus();
    }

    pub fn id(&self) -> u32 {
        self.program.as_ref().expect("it runs").0.id()
    }

    pub fn is_running(&mut self) -> bool {
        self.program.as_mut().is_some_and(|program| matches!(program.0.try_wait(), Ok(None)))
    }

    /// What it wrote for whoever started it.
    pub fn log(&self) -> String {
        fs::read_to_string(self.home.path("log")).unwrap_or_default()
    }

    /// Ends it as a power cut would.
    pub fn kill(&mut self) {
        self.program.take().expect("it runs").kill();
    }

    /// Waits until it has ended by itself; with which status.
    pub fn ended(&mut self) -> Option<i32> {
        let program = self.program.as_mut().expect("it ran");
        let status = wait_for("its end", 30, || program.0.try_wait().ok().flatten());
        self.program = None;
        status.code()
    }

    /// Clicks on what has a name.
    #[track_caller]
    pub fn click(&self, name: &str) {
        let at = self.bus.wait_for(&format!("\"{name}\" to click on"), 20, |tree| tree.middle(tree.find(name)?));
        self.display.click(at);
    }

    /// The same on what has a role, too.
    #[track_caller]
    pub fn click_as(&self, role: u32, name: &str) {
        let look = |tree: &Tree| tree.middle(tree.find_as(role, name)?);
        let at = self.bus.wait_for(&format!("\"{name}\" to click on"), 20, look);
        self.display.click(at);
    }

    /// Waits until something says so.
    #[track_caller]
    pub fn reads(&self, part: &str) -> Node {
        self.bus.wait_for(&format!("\"{part}\""), 30, |tree| tree.containing(part).cloned())
    }

    /// Waits until nothing says so any more.
    #[track_caller]
    pub fn reads_no(&self, part: &str) {
        self.bus.wait_for(&format!("no \"{part}\""), 30, |tree| tree.containing(part).is_none().then_some(()));
    }

    /// The number of a field or slider.
    #[track_caller]
    pub fn value(&self, role: u32, name: &str) -> f64 {
        self.bus.wait_for(&format!("the value of \"{name}\""), 20, |tree| tree.value(tree.find_as(role, name)?))
    }

    /// Waits for a title above the window.
    #[track_caller]
    pub fn titled(&self, part: &str) {
        wait_for(&format!("the title \"{part}\""), 30, || self.display.title().contains(part).then_some(()));
    }

    /// Where the scene is: left, top, width and height.
    pub fn scene(&self) -> [i32; 4] {
        self.bus.wait_for("the scene", 20, |tree| tree.place(tree.containing("Scene:")?))
    }

    /// Where the white ring of the target is on the screen.
    pub fn ring(&self) -> [i16; 2] {
        let scene = self.scene();
        wait_for("the white ring", 20, || self.display.picture().ring(scene))
    }

    /// Where the target is, m, as the card beside the pointer says it.
    pub fn target(&self, ring: [i16; 2]) -> [f64; 2] {
        self.display.move_to([ring[0] - 3, ring[1]]);
        pause(80);
        self.display.move_to(ring);
        let words = self.reads("target at ").name;
        numbers(&words).try_into().unwrap_or_else(|_| panic!("two numbers in {words}"))
    }

    /// The files in which the program keeps what was done.
    pub fn journals(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(self.home.path("stillbase/sessions")).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "toml")).collect()
    }

    /// What it remembers of how it is liked.
    pub fn preferences(&self) -> String {
        fs::read_to_string(self.home.path("stillbase/preferences.toml")).unwrap_or_default()
    }

    /// What it keeps of a session, if that is in one file.
    pub fn journal(&self) -> Option<Scenario> {
        let [file] = self.journals().try_into().ok()?;
        Scenario::parse(&fs::read_to_string(file).ok()?, "journal", None).ok()
    }

    /// Fills in the name of a file.
    pub fn name_file(&self, name: &str) -> PathBuf {
        self.reads("File name");
        self.bus.wait_for("the keys to go to the file name", 10, |tree| {
            tree.focused().filter(|node| node.name == "File name").cloned()
        });
        self.display.keys(&[super::display::CTRL], u32::from('a'));
        self.display.type_in(name);
        self.display.tap(ENTER);
        self.home.path(name)
    }
}

impl Drop for Desk {
    /// What was seen when a test failed stands beside its files.
    fn drop(&mut self) {
        if std::thread::panicking() {
            let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("window-{}.png", self.of));
            self.display.picture().save(&file);
            eprintln!("what was seen is in {}; the program said:\n{}", file.display(), self.log());
        }
    }
}

/// The numbers in a text; a typographic minus is one.
pub fn numbers(text: &str) -> Vec<f64> {
    let plain = text.replace('−', "-");
    plain.split(|c: char| !c.is_ascii_digit() && c != '.' && c != '-').filter_map(|word| word.parse().ok()).collect()
}
