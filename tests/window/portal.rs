//! Files are asked for by the desktop's own dialog where there is one. Here a stand-in answers in its place.

use std::collections::HashMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};

use pollster::block_on;
use stillbase::session::scenario::Scenario;
use zbus::message::Header;
use zbus::object_server::SignalEmitter;
use zbus::zvariant::{OwnedObjectPath, OwnedValue, Value};
use zbus::{Connection, interface};

use super::display::{CTRL, ESC};
use super::hands::hold;
use super::program::Desk;
use super::reader::connect;
use super::wait::{pause, wait_for};
use crate::Test;

pub const TESTS: &[Test] = super::tests![files_are_asked_for_by_the_desktop];

type Options = HashMap<String, OwnedValue>;

/// A question for a file: what it is about, the name that is proposed, and the folder it begins in.
#[derive(Debug, PartialEq)]
struct Question {
    method: &'static str,
    title: String,
    name: Option<String>,
    folder: Option<String>,
}

/// What stands in for the desktop.
struct Portal {
    asked: Sender<Question>,
    /// What is chosen next; nothing is a dialog that is closed.
    chosen: Mutex<Receiver<Option<PathBuf>>>,
}

struct Request;

#[interface(name = "org.freedesktop.portal.Request")]
impl Request {
    #[zbus(signal)]
    async fn response(of: &SignalEmitter<'_>, code: u32, results: HashMap<&str, Value<'_>>) -> zbus::Result<()>;
}

impl Portal {
    async fn answer(
        &self,
        (method, title): (&'static str, String),
        options: Options,
        (connection, header): (&Connection, Header<'_>),
    ) -> OwnedObjectPath {
        let text = |key: &str| options.get(key).and_then(|value| String::try_from(value.clone()).ok());
        let bytes = |key: &str| options.get(key).and_then(|value| Vec::<u8>::try_from(value.clone()).ok());
        let folder = bytes("current_folder").and_then(|bytes| String::from_utf8(bytes).ok());
        let folder = folder.map(|folder| folder.trim_end_matches('\0').to_owned());
        let _ = self.asked.send(Question { method, title, name: text("current_name"), folder });
        let chosen = self.chosen.lock().expect("one at a time").recv().expect("the test goes on");
        let sender = header.sender().expect("somebody asks").trim_start_matches(':').replace('.', "_");
        let token = text("handle_token").expect("its own name for it");
        let path = format!("/org/freedesktop/portal/desktop/request/{sender}/{token}");
        let path = OwnedObjectPath::try_from(path).expect("a path");
        connection.object_server().at(&path, Request).await.expect("a place for it");
        let (connection, to) = (connection.clone(), path.clone());
        std::thread::spawn(move || {
            // A person takes longer than a dialog that cannot open.
            pause(600);
            let emitter = SignalEmitter::new(&connection, to).expect("a path");
            let uris: Vec<String> = chosen.iter().map(|file| format!("file://{}", file.display())).collect();
            let code = u32::from(uris.is_empty());
            let results = HashMap::from([("uris", Value::from(uris))]);
            block_on(Request::response(&emitter, code, results)).expect("said");
        });
        path
    }
}

#[interface(name = "org.freedesktop.portal.FileChooser")]
impl Portal {
    #[zbus(property, name = "version")]
    async fn version(&self) -> u32 {
        3
    }

    async fn open_file(
        &self,
        #[zbus(connection)] connection: &Connection,
        #[zbus(header)] header: Header<'_>,
        _window: String,
        title: String,
        options: Options,
    ) -> OwnedObjectPath {
        self.answer(("open", title), options, (connection, header)).await
    }

    async fn save_file(
        &self,
        #[zbus(connection)] connection: &Connection,
        #[zbus(header)] header: Header<'_>,
        _window: String,
        title: String,
        options: Options,
    ) -> OwnedObjectPath {
        self.answer(("save", title), options, (connection, header)).await
    }
}

fn files_are_asked_for_by_the_desktop() {
    let mut desk = Desk::new("portal", [1280, 800]);
    let (asked, questions) = channel();
    let (answers, chosen) = channel();
    let connection = connect(&desk.bus.address).expect("the bus of the session");
    let portal = Portal { asked, chosen: Mutex::new(chosen) };
    block_on(connection.object_server().at("/org/freedesktop/portal/desktop", portal)).expect("a place for it");
    block_on(connection.request_name("org.freedesktop.portal.Desktop")).expect("the name is free");
    let question = |method, title: &str, name: Option<&str>, folder: Option<&std::path::Path>| {
        let next = questions.recv_timeout(std::time::Duration::from_secs(20)).expect("a question");
        let (title, name) = (title.to_owned(), name.map(String::from));
        let folder = folder.map(|folder| folder.to_string_lossy().into_owned());
        assert_eq!(next, Question { method, title, name, folder });
    };
    desk.open(&[]);
    hold(&desk, |desk| desk.click("Pause"));
    desk.display.tap(ESC);
    desk.display.tap(u32::from(']'));
    desk.titled("*");

    // Saved where the dialog says, with the usual ending; a file of that name was not spoken of and stays.
    let folder = desk.home.path("mine");
    fs::create_dir(&folder).expect("a folder");
    let file = folder.join("turned.toml");
    fs::write(&file, "an older one").expect("a file");
    answers.send(Some(folder.join("turned"))).expect("taken");
    desk.display.keys(&[CTRL], u32::from('s'));
    question("save", "Save the session", Some("case-3.toml"), None);
    desk.reads("turned.toml exists: want another name");
    assert_eq!(fs::read_to_string(&file).expect("readable"), "an older one");
    // The next dialog begins there, and has asked whether to replace what it names.
    answers.send(Some(file.clone())).expect("taken");
    desk.display.keys(&[CTRL], u32::from('s'));
    question("save", "Save the session", Some("case-3.toml"), Some(&folder));
    wait_for("no mark in the title", 20, || (!desk.display.title().contains('*')).then_some(()));
    assert!(desk.bus.tree().expect("it answers").containing("File name").is_none(), "nothing else asks");
    let saved = Scenario::parse(&fs::read_to_string(&file).expect("readable"), "turned", None).expect("a session");
    assert_eq!(saved.edits.len(), 1);

    // A dialog that is closed changes nothing; after a restart it begins in the same folder.
    answers.send(None).expect("taken");
    desk.display.keys(&[CTRL], u32::from('o'));
    question("open", "Open a file", None, Some(&folder));
    pause(1500);
    assert!(desk.bus.tree().expect("it answers").containing("File name").is_none(), "closed is closed");
    desk.display.close();
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());
    desk.open(&[]);
    answers.send(Some(file)).expect("taken");
    desk.display.keys(&[CTRL], u32::from('o'));
    question("open", "Open a file", None, Some(&folder));
    desk.reads("opened ");
    assert!(!desk.log().contains("panicked"), "{}", desk.log());
}
