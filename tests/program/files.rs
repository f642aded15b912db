//! Files: what is written is whole or not there, whoever comes between; what is read is bounded and looked at.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use stillbase::files::new_folder::NewFolder;
use stillbase::files::text::read;
use stillbase::files::{NewFile, WriteError, finish_all, write_new, write_temporary};
use stillbase::settings::text::{MAX_TEXT_BYTES, plain, shorten_message};

use crate::folder::Folder;

impl Folder {
    /// Every file, also hidden ones, with what it holds.
    fn all(&self) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(&self.0).expect("the folder").map(|entry| entry.expect("an entry").path());
        entries.map(|p| (p.file_name().expect("a name").to_string_lossy().into_owned(), bytes(&p))).collect()
    }
    /// What a run says that ends with a status.
    fn said(&self, args: &[&str], status: i32) -> String {
        let out = self.run(args);
        let said = String::from_utf8(out.stderr).expect("UTF-8");
        assert_eq!(out.status.code(), Some(status), "{args:?}: {said}");
        said
    }
}

fn bytes(file: &Path) -> Vec<u8> {
    fs::read(file).expect("a file")
}

#[test]
fn nothing_steers_a_terminal_and_long_messages_keep_both_ends() {
    assert_eq!(plain("a\u{1b}[2Jb\n\u{9b}31m\u{202e}c\r"), "a\\u{1b}[2Jb\n\\u{9b}31m\\u{202e}c\\r");
    assert_eq!(plain("τ₁ N m − 2\n"), "τ₁ N m − 2\n");
    let long = format!("begin {} end", "é".repeat(5000));
    let kept = shorten_message(&long);
    assert!(kept.starts_with("begin é") && kept.ends_with("é end") && kept.chars().count() < 1700, "{kept}");
    assert!(kept.contains("(3410 characters left out)"), "{kept}");
    assert_eq!(shorten_message("short"), "short");
}

/// Of many who write under one name, one has it; what it wrote stands there, and the others are told.
#[test]
fn of_many_who_take_a_name_one_has_it() {
    let folder = Folder::new("files-race");
    for round in 0..64 {
        let file = folder.path(&format!("{round}.csv"));
        let start = std::sync::Barrier::new(16);
        let done: Vec<_> = std::thread::scope(|scope| {
            let one = |i: u8| {
                let (file, start) = (&file, &start);
                scope.spawn(move || {
                    let mut out = NewFile::create(file, false).expect("the name is free");
                    out.write_all(&vec![i; 10_000 + usize::from(i)]).expect("there is room");
                    // All have begun while the name was free.
                    start.wait();
                    (i, out.finish())
                })
            };
            let all: Vec<_> = (0..16).map(one).collect();
            all.into_iter().map(|thread| thread.join().expect("no panic")).collect()
        });
        let winners: Vec<u8> = done.iter().filter(|(_, done)| done.is_ok()).map(|(i, _)| *i).collect();
        let [winner] = winners[..] else { panic!("{winners:?} have the name") };
        assert_eq!(bytes(&file), vec![winner; 10_000 + usize::from(winner)]);
        for (i, done) in done {
            assert!(i == winner || matches!(&done, Err(WriteError::Exists(named)) if *named == file), "{i}: {done:?}");
        }
        assert_eq!(folder.names().len(), round + 1, "nothing is left beside");
    }
}

#[test]
fn files_that_belong_together_appear_together() {
    let folder = Folder::new("files-pair");
    let [a, b] = ["a", "b"].map(|name| folder.path(name));
    let pair =
        |force| [write_temporary(&a, b"new a", force).expect("a"), write_temporary(&b, b"new b", force).expect("b")];
    // Somebody takes the second name in the meantime.
    let both = pair(false);
    fs::write(&b, "theirs").expect("written");
    assert!(matches!(finish_all(both), Err(WriteError::Exists(file)) if file == b));
    assert_eq!(folder.all(), BTreeMap::from([("b".into(), b"theirs".to_vec())]));
    // What may be replaced is back if the second cannot be.
    fs::write(&a, "old a").expect("written");
    let both = pair(true);
    fs::remove_file(&b).expect("removed");
    fs::create_dir(&b).expect("a folder in its place");
    assert!(matches!(finish_all(both), Err(WriteError::IsFolder(file)) if file == b));
    fs::remove_dir(&b).expect("empty");
    assert_eq!(folder.all(), BTreeMap::from([("a".into(), b"old a".to_vec())]));
    finish_all(pair(true)).expect("both may be written");
    assert_eq!(folder.all(), BTreeMap::from([("a".into(), b"new a".to_vec()), ("b".into(), b"new b".to_vec())]));
}

#[test]
fn what_was_left_over_is_swept_and_what_is_being_made_is_not() {
    let folder = Folder::new("files-sweep");
    let stale = [".x.rrd.1-0.stillbase.part", ".ünlauter name.csv.4000000000-12.stillbase.part"];
    let others = [".x.rrd.1-0.part", "x.1-0.stillbase.part", ".x.rrd.a-0.stillbase.part", ".1-.stillbase.part"];
    for name in stale.iter().chain(&others) {
        fs::write(folder.path(name), "left").expect("written");
    }
    fs::create_dir(folder.path(".d.1-0.stillbase.part")).expect("a folder is no file");
    let mut being_made = NewFile::create(&folder.path("being-made"), false).expect("free");
    being_made.write_all(b"half").expect("there is room");
    write_new(&folder.path("new"), b"whole", false).expect("free");
    fs::remove_dir(folder.path(".d.1-0.stillbase.part")).expect("still there, empty");
    being_made.write_all(b" and half").expect("there is room");
    being_made.finish().expect("it was not swept");
    let mut names: Vec<String> =
        others.iter().map(ToString::to_string).chain(["being-made".into(), "new".into()]).collect();
    names.sort();
    assert_eq!(folder.names(), names);
    assert_eq!(bytes(&folder.path("being-made")), b"half and half");
    // As long a name as there may be.
    write_new(&folder.path(&"n".repeat(255)), b"whole", false).expect("a long name");
    assert_eq!(folder.names().len(), names.len() + 1);
}

/// A folder of pictures, too: whole or not at all, swept if its program was killed, and never over other files.
#[test]
fn a_folder_of_pictures_appears_whole() {
    let folder = Folder::new("files-folder");
    let film = folder.path("film");
    let left = folder.path(".film.1-0.stillbase.parts");
    fs::create_dir(&left).expect("a folder");
    fs::write(left.join("frame-00001.png"), "left").expect("written");
    let mut being_made = NewFolder::create(&film, false).expect("free");
    being_made.push(b"one").expect("there is room");
    let names = folder.names();
    assert!(names.len() == 1 && names[0].ends_with(".stillbase.parts") && !left.exists(), "{names:?}");
    let mut beside = NewFolder::create(&film, false).expect("still free");
    beside.push(b"two").expect("there is room");
    drop(being_made);
    assert_eq!(folder.names().len(), 1, "nothing is left of it, and what another makes is not swept");
    beside.finish().expect("the name is free");
    assert_eq!(fs::read(film.join("frame-00001.png")).expect("a picture"), b"two");
    assert!(matches!(NewFolder::create(&film, false), Err(WriteError::Exists(_))));
    // Its name is taken while the next is being made.
    let other = folder.path("other");
    let late = NewFolder::create(&other, false).expect("free");
    fs::create_dir(&other).expect("a folder");
    assert!(matches!(late.finish(), Err(WriteError::Exists(_))));
    fs::write(other.join("notes.txt"), "mine").expect("written");
    assert!(matches!(NewFolder::create(&other, true), Err(WriteError::HoldsOthers(_))));
    let file = folder.file("file", "mine");
    assert!(matches!(NewFolder::create(&file, true), Err(WriteError::NotAFolder(_))));
    assert!(matches!(NewFolder::create(&folder.path("no/film"), true), Err(WriteError::NoFolder { .. })));
    assert_eq!(folder.names(), ["file", "film", "other"]);
}

/// Something that takes long and writes.
const LONG: [&str; 6] = ["tolerance", "case-1", "--simulate", "--samples=100000", "-o", "x.csv"];

#[cfg(unix)]
fn started(command: &mut Command, folder: &Folder) -> std::process::Child {
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    let since = Instant::now();
    while !folder.names().iter().any(|name| name.ends_with(".part")) {
        assert!(child.try_wait().expect("a child").is_none(), "it ended at once");
        assert!(since.elapsed() < Duration::from_secs(60), "no file in the making");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

#[cfg(unix)]
fn send(signal: &str, child: &std::process::Child) {
    let sent = Command::new("sh").args(["-c", &format!("kill -{signal} {}", child.id())]).status().expect("sh");
    assert!(sent.success());
}

#[cfg(target_os = "linux")]
#[test]
fn whatever_ends_the_program_leaves_nothing() {
    use std::os::unix::process::ExitStatusExt;
    let status = fs::read_to_string("/proc/self/status").expect("Linux");
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).expect("a mask");
    let ignored = u64::from_str_radix(mask.trim(), 16).expect("bits");
    for (signal, number) in
        [("INT", 2), ("HUP", 1), ("TERM", 15), ("QUIT", 3), ("XCPU", 24), ("ALRM", 14), ("USR1", 10), ("USR2", 12)]
    {
        // A test that was started to ignore it cannot have its children hear it.
        if ignored >> (number - 1) & 1 == 1 {
            continue;
        }
        let folder = Folder::new(signal);
        let mut child = started(&mut folder.command(&LONG), &folder);
        send(signal, &child);
        assert_eq!(child.wait().expect("it ends").signal(), Some(number), "it ends as if it had not listened");
        assert_eq!(folder.names(), [""; 0], "after {signal}");
    }
    // What is to be ignored is: nohup.
    let folder = Folder::new("files-nohup");
    let mut shell = Command::new("sh");
    shell.args(["-c", "trap '' HUP; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_stillbase")]).args(LONG);
    let mut child = started(shell.current_dir(&folder.0), &folder);
    send("HUP", &child);
    std::thread::sleep(Duration::from_millis(300));
    assert!(child.try_wait().expect("a child").is_none(), "a hang-up is nothing to it");
    send("TERM", &child);
    assert_eq!(child.wait().expect("it ends").signal(), Some(15));
    assert_eq!(folder.names(), [""; 0]);
    // Killed, it cannot tidy up; whoever writes there next does.
    let mut children: Vec<_> = (0..3).map(|_| started(&mut folder.command(&LONG), &folder)).collect();
    for child in &mut children {
        child.kill().expect("it runs");
        child.wait().expect("it ends");
    }
    assert!(!folder.names().is_empty());
    folder.said(&["design", "nine-link", "-o", "new.toml"], 0);
    assert_eq!(folder.names(), ["new.toml"]);
}

/// What is replaced keeps who may read it and all its names.
#[cfg(unix)]
#[test]
fn replacing_keeps_permissions_and_hard_links() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    let folder = Folder::new("files-mode");
    for mode in [0o600, 0o640, 0o755] {
        let (file, other) = (folder.file("a.toml", "old"), folder.path("other"));
        fs::set_permissions(&file, fs::Permissions::from_mode(mode)).expect("own file");
        write_new(&file, b"new", true).expect("may be replaced");
        assert_eq!(fs::metadata(&file).expect("there").permissions().mode() & 0o7777, mode);
        fs::hard_link(&file, &other).expect("a second name");
        write_new(&file, b"newer", true).expect("may be replaced");
        assert_eq!((bytes(&file), bytes(&other)), (b"newer".to_vec(), b"newer".to_vec()));
        let both = [&file, &other].map(|name| fs::metadata(name).expect("there"));
        assert_eq!((both[0].ino(), both[0].nlink(), both[0].mode() & 0o7777), (both[1].ino(), 2, mode));
        // Of two that belong together neither changes where one cannot.
        let pair = || {
            [
                write_temporary(&file, b"newest", true).expect("begun"),
                write_temporary(&folder.path("b"), b"b", false).expect("begun"),
            ]
        };
        let begun = pair();
        fs::write(folder.path("b"), "in the way").expect("written");
        finish_all(begun).expect_err("b is taken");
        assert_eq!((bytes(&file), bytes(&other)), (b"newer".to_vec(), b"newer".to_vec()));
        assert_eq!(fs::metadata(&other).expect("there").nlink(), 2);
        fs::remove_file(folder.path("b")).expect("removed");
        finish_all(pair()).expect("both are free");
        assert_eq!((bytes(&other), bytes(&folder.path("b"))), (b"newest".to_vec(), b"b".to_vec()));
        let mut names = folder.names();
        names.retain(|name| !["a.toml", "b", "other"].contains(&name.as_str()));
        assert_eq!(names, [""; 0]);
        ["a.toml", "b", "other"].iter().for_each(|name| fs::remove_file(folder.path(name)).expect("removed"));
    }
    let status = folder.command(&["design", "nine-link", "-o", "x.toml"]).status().expect("it starts");
    assert!(status.success());
    fs::set_permissions(folder.path("x.toml"), fs::Permissions::from_mode(0o600)).expect("own file");
    folder.said(&["design", "nine-link", "-o", "x.toml", "--force"], 0);
    assert_eq!(fs::metadata(folder.path("x.toml")).expect("there").permissions().mode() & 0o7777, 0o600);
}

/// Every command that writes, what it writes and what it reads.
#[cfg(debug_assertions)]
const WRITERS: [(&[&str], &[&str]); 13] = [
    (&["design", "nine-link", "-o", "x.toml"], &["x.toml"]),
    (&["export", "case-3", "--rate", "20", "-o", "x.csv"], &["x.csv"]),
    (&["export", "case-3", "--what", "simulated", "--rate", "20", "-o", "x.csv"], &["x.csv"]),
    (&["simulate", "case-3", "--every", "100", "-o", "x.csv"], &["x.csv"]),
    (&["joints", "case-3", "-o", "x.csv"], &["x.csv"]),
    (&["spectrum", "case-1", "-o", "x.csv"], &["x.csv"]),
    (&["compare", "case-1", "case-3", "-o", "x.csv"], &["x.csv"]),
    (&["plan", "nine-link", "0.5,0.5", "0.55,0.9", "--b", "2.4", "-o", "x.toml"], &["x.toml"]),
    (&["tolerance", "case-3", "--samples", "50", "--instants", "10", "-o", "x.csv"], &["x.csv"]),
    (&["tolerance", "case-3", "--samples", "50", "--instants", "10", "-o", "x.parquet"], &["x.parquet"]),
    (&["tolerance", "--merge", "a.csv", "b.parquet", "-o", "x.parquet"], &["x.parquet"]),
    (&["import", "motion.csv", "-o", "x.toml"], &["x-given.toml", "x.toml"]),
    (&["headless", "case-3", "--set", "task.time=0.02", "-o", "x.rrd"], &["x.rrd"]),
];

/// A folder with what the writers read.
fn stocked(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.said(&["export", "case-3", "--rate", "20", "-o", "motion.csv"], 0);
    let study = ["tolerance", "case-3", "--samples", "60", "--instants", "10"];
    folder.said(&[&study[..], &["--shard", "1/2", "-o", "a.csv"]].concat(), 0);
    folder.said(&[&study[..], &["--shard", "2/2", "-o", "b.parquet"]].concat(), 0);
    folder
}

/// Messages of a whole recording; the order of columns within them may differ from one to the next.
#[cfg(all(debug_assertions, feature = "record"))]
fn recorded(bytes: &[u8]) -> Option<usize> {
    let messages = re_log_encoding::DecoderApp::decode_lazy(std::io::BufReader::new(bytes));
    messages.map(|message| message.ok()).try_fold(0, |count, message| message.map(|_| count + 1))
}

#[cfg(all(debug_assertions, not(feature = "record")))]
fn recorded(bytes: &[u8]) -> Option<usize> {
    Some(bytes.len())
}

/// The n-th step of writing fails, or the program ends there: what was there is there, what is new is whole, and nothing
/// else is left.
#[cfg(debug_assertions)]
fn faults(writers: std::ops::Range<usize>) {
    let folder = stocked(&format!("faults-{}", writers.start));
    let stock = folder.all();
    for (args, results) in &WRITERS[writers] {
        if args[0] == "headless" && !cfg!(feature = "record") {
            continue;
        }
        folder.said(args, 0);
        let with_results = folder.all();
        let same = |name: &str, bytes: Option<&Vec<u8>>| match (bytes, with_results.get(name)) {
            (Some(a), Some(b)) => a == b || (name.ends_with(".rrd") && recorded(a) == recorded(b)),
            (a, b) => a == b,
        };
        let reset = |old: bool| {
            for name in folder.names().iter().filter(|name| !stock.contains_key(*name)) {
                fs::remove_file(folder.path(name)).expect("removed");
            }
            results.iter().filter(|_| old).for_each(|name| fs::write(folder.path(name), "old").expect("written"));
        };
        // What replaces a file does so by the same steps whoever writes: those that run long need not show it again.
        let replaces = ["design", "tolerance", "import", "headless"].contains(&args[0]);
        let all = [("fail", false), ("end", false), ("fail", true), ("end", true)];
        for (how, old) in all.into_iter().filter(|(_, old)| replaces || !old) {
            let args: &[&str] = &[*args, if old { &["--force"][..] } else { &[] }].concat();
            let mut steps = 0;
            // A recording has hundreds of writes: all at first, then fewer and fewer.
            let mut n = 1;
            loop {
                reset(old);
                let out = folder.command(args).env("STILLBASE_FAULT", format!("{how}:{n}")).output().expect("starts");
                let (code, said) = (out.status.code(), String::from_utf8(out.stderr).expect("UTF-8"));
                let what = format!("{args:?}, {how} at {n}: {said}");
                if how == "end" && code == Some(137) {
                    folder.said(&["design", "nine-link", "-o", "sweeper.toml"], 0);
                    fs::remove_file(folder.path("sweeper.toml")).expect("it swept");
                }
                let after = folder.all();
                let whole = |name: &str| same(name, after.get(name));
                let before = |name: &str| after.get(name).map(Vec::as_slice) == old.then_some(&b"old"[..]);
                assert!(results.iter().all(|name| whole(name) || before(name)), "{what} torn");
                assert!(after.keys().all(|name| with_results.contains_key(name)), "{what} left {:?}", after.keys());
                assert!(stock.iter().all(|(name, bytes)| after.get(name) == Some(bytes)), "{what} lost");
                // They are put there in their order: where the last one is new, all are.
                let news: Vec<bool> = results.iter().map(|name| whole(name)).collect();
                assert!(news.windows(2).all(|pair| pair[0] || !pair[1]), "{what} alone");
                match code {
                    Some(0) => {
                        assert!(news.iter().all(|whole| *whole), "{what}");
                        break;
                    }
                    Some(2) => {
                        assert_eq!(how, "fail", "{what}");
                        let stands = said.contains("is written whole");
                        assert!(news.iter().all(|whole| *whole == stands), "{what}");
                        assert!(said.contains("on purpose") && said.trim_end().lines().count() == 1, "{what}");
                    }
                    Some(137) => {}
                    _ => panic!("{what} ended with {code:?}"),
                }
                steps += 1;
                n += 1 + n / 12;
            }
            assert!(steps >= 4, "{args:?}: begin, write, sync, name: {steps}");
        }
        reset(false);
    }
}

#[cfg(debug_assertions)]
#[test]
fn faults_in_machines_and_motions() {
    faults(0..4);
}

#[cfg(debug_assertions)]
#[test]
fn faults_in_tables() {
    faults(4..8);
}

#[cfg(debug_assertions)]
#[test]
fn faults_in_samples() {
    faults(8..11);
}

#[cfg(debug_assertions)]
#[test]
fn faults_in_pairs() {
    faults(11..12);
}

#[cfg(debug_assertions)]
#[test]
fn faults_in_recordings() {
    faults(12..13);
}

/// A file with two names is overwritten in place. When the disk fails for good midway, its content is still somewhere,
/// and the message says where; the next file that is written leaves it there.
#[cfg(all(debug_assertions, unix))]
#[test]
fn what_cannot_be_restored_is_kept_beside() {
    let folder = Folder::new("damaged");
    let (file, twin, before) = (folder.path("x.toml"), folder.path("y.toml"), folder.path("x.toml.before"));
    let mut damaged = 0;
    for n in 1..40 {
        for old in [&file, &twin, &before] {
            let _ = fs::remove_file(old);
        }
        fs::write(&file, "old").expect("written");
        fs::hard_link(&file, &twin).expect("two names");
        let args = ["design", "nine-link", "-o", "x.toml", "--force"];
        let out = folder.command(&args).env("STILLBASE_FAULT", format!("from:{n}")).output().expect("starts");
        let said = String::from_utf8(out.stderr).expect("UTF-8");
        if out.status.code() == Some(0) {
            assert!(damaged > 0, "the fault never struck while the file was overwritten");
            return;
        }
        let kept = [&file, &before].into_iter().filter(|file| file.exists()).any(|file| bytes(file) == b"old");
        assert!(kept || said.contains("is written whole"), "from {n}: the content is lost: {said}");
        if before.exists() {
            damaged += 1;
            assert!(said.contains("x.toml.before"), "from {n}: {said}");
            folder.said(&["design", "nine-link", "-o", "next.toml", "--force"], 0);
            assert_eq!(bytes(&before), b"old");
        }
    }
    panic!("it is never written");
}

/// The checksum of a file's bytes, zeros in place of its seal, put there.
fn sealed(mut file: Vec<u8>, tail: bool) -> Vec<u8> {
    let mark = b" check ";
    let places = file.windows(mark.len()).enumerate().filter(|(_, w)| *w == mark).map(|(i, _)| i + mark.len());
    let all: Vec<usize> = places.collect();
    let Some(at) = (if tail { all.last() } else { all.first() }).copied().filter(|at| at + 16 <= file.len()) else {
        return file;
    };
    file[at..at + 16].fill(b'0');
    let ended = [&file[..], &[1]].concat();
    let sum = ended.chunks(8).fold(0xcbf2_9ce4_8422_2325_u64, |sum, word| {
        let mut whole = [0; 8];
        whole[..word.len()].copy_from_slice(word);
        (sum ^ u64::from_le_bytes(whole)).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
    });
    file[at..at + 16].copy_from_slice(format!("{sum:016x}").as_bytes());
    file
}

/// No part merges of which a single bit has changed.
#[test]
fn a_changed_part_is_refused() {
    let folder = stocked("flips");
    folder.said(&["tolerance", "--merge", "a.csv", "b.parquet", "-o", "whole.csv"], 0);
    let mut state = 7_u64;
    for name in ["a.csv", "b.parquet"] {
        let good = bytes(&folder.path(name));
        assert_eq!(sealed(good.clone(), name == "b.parquet"), good, "the seal is what this test takes it for");
        for _ in 0..100 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let bit = (state >> 20) as usize % (8 * good.len());
            let mut bad = good.clone();
            bad[bit / 8] ^= 1 << (bit % 8);
            fs::write(folder.path(name), bad).expect("written");
            let said = folder.said(&["tolerance", "--merge", "a.csv", "b.parquet", "-o", "no.csv"], 2);
            assert!(said.contains(name) && said.trim_end().lines().count() == 1, "bit {bit}: {said}");
            assert!(!folder.path("no.csv").exists());
        }
        fs::write(folder.path(name), &good).expect("written");
    }
}

/// Where somebody has put the right checksum under a wrong file, it still ends in an answer or a refusal, soon.
#[test]
fn a_forged_part_is_bounded() {
    let folder = stocked("forged");
    let merge = || folder.run(&["tolerance", "--merge", "a.csv", "b.parquet", "-o", "no.csv", "--force"]);
    let good = bytes(&folder.path("b.parquet"));
    let mut state = 11_u64;
    for _ in 0..200 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // Most of the table of contents, where the lengths are.
        let byte = good.len() - 9 - (state >> 20) as usize % (good.len() / 2);
        let mut bad = good.clone();
        bad[byte] ^= 1 << ((state >> 60) & 7);
        fs::write(folder.path("b.parquet"), sealed(bad, true)).expect("written");
        let since = Instant::now();
        let out = merge();
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert!(matches!(out.status.code(), Some(0 | 2)), "byte {byte}: {:?} {said}", out.status);
        assert!(since.elapsed() < Duration::from_secs(20), "byte {byte}");
    }
    // Pages that claim a dictionary where there is none, at which the reader of Parquet panics: 30 values, PLAIN.
    let mut bad = good.clone();
    let header = [0x2c, 0x15, 0x3c, 0x15, 0x00];
    let pages: Vec<usize> = (0..bad.len() - 5).filter(|i| bad[*i..].starts_with(&header)).collect();
    assert!(pages.len() > 4, "a page a column");
    pages.iter().for_each(|i| bad[i + 4] = 0x10);
    fs::write(folder.path("b.parquet"), sealed(bad, true)).expect("written");
    let said = folder.said(&["tolerance", "--merge", "a.csv", "b.parquet", "-o", "no.csv", "--force"], 2);
    assert!(said.contains("b.parquet: ") && said.trim_end().lines().count() == 1, "{said}");
    fs::write(folder.path("b.parquet"), good).expect("written");
    let csv = String::from_utf8(bytes(&folder.path("a.csv"))).expect("text");
    let mut lines: Vec<String> = csv.lines().map(str::to_owned).collect();
    let cells: Vec<String> = lines[6].split(',').map(str::to_owned).collect();
    let last = cells.len() - 1;
    let long = "1".repeat(400_000);
    for (cell, value, words) in [
        (last - 3, "-0.5", "sample 5: peak moment N m is -0.5"),
        (last, "-1e-9", "sample 5: rms force N is"),
        (1, "NaN", "want a finite number"),
        (last, "inf", "want a finite number"),
        (0, "6", "sample 6 where 5 should follow"),
        (0, "-5", "a.csv:7: want the number of a sample"),
        (0, "61", "sample 61: want sample numbers below 60"),
        (3, "x", "a.csv:7: want the number of a sample"),
        (3, "1,1", "a.csv:7: want the number of a sample"),
        (3, &long, "a.csv:7: want the number of a sample"),
    ] {
        let mut changed = cells.clone();
        changed[cell] = value.into();
        lines[6] = changed.join(",");
        fs::write(folder.path("a.csv"), sealed((lines.join("\n") + "\n").into_bytes(), false)).expect("written");
        let out = merge();
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert!(out.status.code() == Some(2) && said.contains(words) && said.len() < 3000, "{value:.20}: {said}");
    }
}

/// What is no plain file, or a very large one, is refused before it is read.
#[cfg(unix)]
#[test]
fn only_plain_files_of_a_bounded_size_are_read() {
    let folder = Folder::new("files-plain");
    let made = Command::new("mkfifo").arg(folder.path("pipe")).status().expect("mkfifo");
    assert!(made.success());
    let large = fs::File::create(folder.path("large")).expect("a file");
    large.set_len(MAX_TEXT_BYTES + 1).expect("a file with a hole");
    let scenario = |machine: &str| {
        format!(
            "machine = {machine:?}\n[task]\nkind = \"reactionless\"\nfrom = [0.5, 0.5]\nto = [0.55, 0.9]\nb = 2.4\n"
        )
    };
    for (name, why) in [
        ("/dev/zero", "a device or a pipe"),
        ("pipe", "a device or a pipe"),
        (".", "a folder"),
        ("large", "16777217 bytes or more"),
    ] {
        fs::write(folder.path("s.toml"), scenario(name)).expect("written");
        for args in [
            &["check", name][..],
            &["simulate", "s.toml"],
            &["simulate", name],
            &["import", name],
            &["dynamics", "nine-link", "--states", name],
        ] {
            let since = Instant::now();
            let said = folder.said(args, 2);
            assert!(said.contains(why) && said.contains("16777216 bytes"), "{args:?}: {said}");
            assert!(since.elapsed() < Duration::from_secs(10), "{args:?}");
        }
        for ending in ["csv", "parquet"] {
            let link = folder.path(&format!("link.{ending}"));
            let _ = fs::remove_file(&link);
            std::os::unix::fs::symlink(name, &link).expect("a link");
            let link = format!("link.{ending}");
            let said = folder.said(&["tolerance", "--merge", &link, "-o", "no.csv"], 2);
            assert!(said.contains(&link), "{said}");
        }
    }
    assert!(read(&folder.path("large")).is_err() && read(&folder.path("s.toml")).is_ok());
}

/// Names in files that would steer a terminal are refused, those of a command line are spelled out, long ones are cut.
#[test]
fn names_from_outside_do_nothing_to_a_terminal() {
    let folder = Folder::new("files-names");
    let evil = "\\u001B]0;title\\u0007\\u009B2J\\u202Eevil\\r";
    let machine = include_str!("../../assets/machines/nine-link.toml");
    let named = |text: String| text.replace("name = \"nine-link\"", &format!("name = \"{evil}\""));
    let link = |text: &str, name: &str| text.replace(&format!("\"{name}\""), &format!("\"{evil}\""));
    let renamed = link(&named(machine.to_owned()), "9");
    fs::write(folder.path("m.toml"), &renamed).expect("written");
    fs::write(folder.path("broken.toml"), link(&renamed, "8")).expect("written");
    let scenario = include_str!("../../assets/scenarios/case-3.toml").replace("\"nine-link\"", "\"m.toml\"");
    fs::write(folder.path("s.toml"), link(&scenario, "case-3")).expect("written");
    let clean = |out: &[u8]| {
        let text = String::from_utf8(out.to_vec()).expect("UTF-8");
        let bad = text.chars().find(|c| (c.is_control() && *c != '\n') || *c == '\u{202e}');
        assert!(bad.is_none(), "{bad:?} in {text}");
        text
    };
    fs::write(
        folder.path("title.toml"),
        scenario.replace("\"m.toml\"", "\"nine-link\"").replace("title = \"", "title = \"\\u202E"),
    )
    .expect("written");
    fs::write(folder.path("name.toml"), link(&scenario.replace("\"m.toml\"", "\"nine-link\""), "case-3"))
        .expect("written");
    for (args, said) in [
        (&["check", "m.toml"][..], "U+001B"),
        (&["check", "m.toml", "--json"], "U+001B"),
        (&["check", "broken.toml"], "U+001B"),
        (&["simulate", "s.toml", "--every", "500"], "U+001B"),
        (&["simulate", "title.toml", "--every", "500"], "title.toml:"),
        (&["simulate", "title.toml", "--every", "500"], "U+202E"),
        (&["simulate", "name.toml", "--every", "500", "--json"], "U+001B"),
        (&["joints", "s.toml", "--json"], "U+001B"),
        (&["compare", "title.toml", "case-1"], "U+202E"),
        (&["headless", "name.toml", "-o", "x.rrd"], "U+001B"),
        (&["check", "no\u{1b}[2Jsuch"], "no such machine"),
        (&["design", "nine-link", "-o", "no/\u{1b}[2J.toml"], "u{1b}"),
    ] {
        if args[0] == "headless" && !cfg!(feature = "record") {
            continue;
        }
        let out = folder.run(args);
        let [printed, told] = [&out.stdout, &out.stderr].map(|bytes| clean(bytes));
        // With --json the reason stands on standard output, too.
        let is_told = if args.contains(&"--json") { printed.contains("reason") } else { printed.is_empty() };
        assert!(out.status.code() == Some(2) && is_told, "{args:?}: {printed} {told}");
        assert!(told.contains(said) && told.contains("want"), "{args:?}: {told}");
    }
    // A value of megabytes is not repeated.
    fs::write(folder.path("long.toml"), scenario.replace("b = 2.4", &format!("b = \"{}\"", "9".repeat(4_000_000))))
        .expect("written");
    fs::write(folder.path("long.csv"), format!("t,q1,q2,q3\n0,1,2,{}\n", "x".repeat(4_000_000))).expect("written");
    for args in [&["simulate", "long.toml"][..], &["import", "long.csv"]] {
        let said = folder.said(args, 2);
        assert!(said.len() < 5000 && said.contains('…'), "{}", said.len());
    }
}
