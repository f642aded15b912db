//! What Rerun's own program does with recordings: its server takes one that is streamed, and keeps what it took; its
//! program finds written and optimised ones whole.

use std::collections::BTreeMap;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use re_log_encoding::DecoderApp;
use re_log_types::LogMsg;
use stillbase::files::recorded::cases;
use stillbase::recording::{Options, Viewer, record, stream};
use stillbase::session::scenario::Scenario;

use super::folder::Folder;
use super::python::python;
use crate::Test;

pub const TESTS: &[Test] = tests![what_is_streamed_is_what_is_written, what_is_optimized_is_replayed];

/// How many rows each entity has.
fn rows(file: &Path) -> BTreeMap<String, usize> {
    let Ok(open) = std::fs::File::open(file) else { return BTreeMap::new() };
    let mut rows = BTreeMap::new();
    for message in DecoderApp::decode_lazy(std::io::BufReader::new(open)) {
        // The end may still be under way.
        let Ok(message) = message else { break };
        if let LogMsg::ArrowMsg(store, message) = message {
            let chunk = re_chunk::Chunk::from_arrow_msg(&message).expect("a chunk");
            *rows.entry(format!("{:?} {}", store.kind(), chunk.entity_path())).or_insert(0) += chunk.num_rows();
        }
    }
    rows
}

/// Returns Rerun's program, which the package brings; by itself, so that it ends when it is told to.
fn program() -> PathBuf {
    let asked = python().args(["-c", "import rerun_cli; print(rerun_cli.__path__[0])"]).output().expect("it was there");
    Path::new(String::from_utf8(asked.stdout).expect("UTF-8").trim_end()).join("rerun")
}

/// Rerun finds a recording whole as it is written and as it is optimised, with the session and signals it had before.
fn what_is_optimized_is_replayed() {
    let folder = Folder::new("optimized");
    let (written, optimized) = (folder.path("written.rrd"), folder.path("optimized.rrd"));
    let scenario = [Scenario::builtin("case-3").expect("built in")];
    record(&scenario, &written, &Options::default(), &mut |_| true).expect("a file");
    let rerun = |args: &[&str]| Command::new(program()).args(["rrd"]).args(args).output().expect("it was there");
    let path = |file: &Path| file.to_str().expect("UTF-8").to_owned();
    let done = rerun(&["optimize", &path(&written), "-o", &path(&optimized)]);
    assert!(done.status.success(), "{done:?}");
    for file in [&written, &optimized] {
        let checked = rerun(&["verify", &path(file)]);
        assert!(checked.status.success(), "{checked:?}");
    }
    let [before, after] = [&written, &optimized].map(|file| cases(file).expect("a whole recording"));
    assert_eq!(before[0].table, after[0].table);
    assert_eq!(before[0].session, after[0].session);
    assert!(before.len() == 1 && after.len() == 1 && before[0].table.columns.len() > 50);
}

fn what_is_streamed_is_what_is_written() {
    let folder = Folder::new("viewer");
    let port = TcpListener::bind("127.0.0.1:0").and_then(|free| free.local_addr()).expect("a port").port();
    let scenario = [Scenario::builtin("case-3").expect("built in")];
    let (written, taken) = (folder.path("written.rrd"), folder.path("taken.rrd"));
    let mut server = Command::new(program())
        .args(["--bind", "127.0.0.1", "--port", &port.to_string(), "--save"])
        .arg(&taken)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("it was there a moment ago");
    let done = std::panic::catch_unwind(|| {
        let viewer = Viewer::at(&format!("rerun+http://127.0.0.1:{port}/proxy")).expect("an address");
        let until = Instant::now() + Duration::from_secs(60);
        // It takes a while to start.
        let streamed = loop {
            match stream(&scenario, &viewer, &Options::default(), &mut |_| true) {
                Ok(streamed) => break streamed,
                Err(why) => assert!(Instant::now() < until, "{why}"),
            }
        };
        assert!(streamed.len() == 1 && streamed[0].reactionless && streamed[0].file.is_none());
        record(&scenario, &written, &Options::default(), &mut |_| true).expect("a file");
        let expected = rows(&written);
        assert!(expected.len() > 100, "{} entities", expected.len());
        while rows(&taken) != expected {
            assert!(Instant::now() < until, "{:?}\nis not\n{expected:?}", rows(&taken));
            std::thread::sleep(Duration::from_millis(200));
        }
    });
    server.kill().and_then(|()| server.wait()).expect("it was there a moment ago");
    done.unwrap_or_else(|why| std::panic::resume_unwind(why));
}
