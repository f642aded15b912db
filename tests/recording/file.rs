//! The file: the same each time, whole or not there at all, and refused with a reason.

use super::*;
use arrow::array::UInt64Array;
use re_log_encoding::{Decodable as _, Encoder, MessageHeader, MessageKind, RawRrdManifest};

/// Chunks without their identifiers.
fn data(file: &std::path::Path) -> Vec<(String, Vec<String>)> {
    let contents = Contents::of(file);
    contents
        .stores
        .iter()
        .map(|(id, chunks)| {
            let rows = chunks.iter().map(|c| {
                let mut columns: Vec<String> =
                    c.components().values().map(|x| format!("{} {:?}", x.descriptor, x.list_array)).collect();
                columns.sort();
                format!("{} {:?} {columns:?}", c.entity_path(), c.row_ids().collect::<Vec<_>>())
            });
            (id.to_string(), rows.collect())
        })
        .collect()
}

#[test]
fn recording_again_gives_the_same_recording() {
    let folder = Folder::new("again");
    let scenarios = [short("case-1"), short("case-2")];
    for name in ["a.rrd", "b.rrd"] {
        record_in(&folder, name, &scenarios).expect("two cases");
    }
    assert_eq!(data(&folder.path("a.rrd")), data(&folder.path("b.rrd")));
    let mut other = short("case-2");
    other.control.kp = stillbase::simulation::plant::DriveValues::All(100.0);
    record_in(&folder, "c.rrd", &[short("case-1"), other]).expect("two cases");
    let ids = |name: &str| Contents::of(&folder.path(name)).stores.into_keys().collect::<Vec<_>>();
    assert_ne!(ids("a.rrd"), ids("c.rrd"), "another recording has another name");
}

/// The table of contents at the end: what the encoder of the SDK writes for the same chunks, and each where it says.
#[test]
fn the_table_of_contents_is_that_of_the_sdk() {
    let folder = Folder::new("contents");
    record_in(&folder, "two.rrd", &[short("case-1"), short("spacecraft")]).expect("two cases");
    let bytes = std::fs::read(folder.path("two.rrd")).expect("the recording");
    let own = RawRrdManifest::from_rrd_bytes(&bytes).expect("a table of contents");
    let messages =
        DecoderApp::decode_lazy(std::io::Cursor::new(bytes.clone())).map(|message| Ok(message.expect("one")));
    let again = Encoder::encode(messages).expect("the same messages");
    let of_sdk = RawRrdManifest::from_rrd_bytes(&again).expect("a table of contents");
    assert_eq!((own.len(), of_sdk.len()), (2, 2), "recording and layout");
    let mut chunks = 0;
    for own in own {
        own.sanity_check_heavy().expect("what Rerun wants of it");
        let of_sdk = of_sdk.iter().find(|of| of.store_id == own.store_id).expect("the same stores");
        assert_eq!(own.sorbet_schema_sha256, of_sdk.sorbet_schema_sha256);
        assert_eq!(own.data.schema(), of_sdk.data.schema());
        for (i, field) in own.data.schema().fields().iter().enumerate() {
            // Equal data need not be packed equally.
            if !field.name().starts_with("chunk_byte") {
                assert_eq!(own.data.column(i), of_sdk.data.column(i), "{}", field.name());
            }
        }
        let numbers = |name: &str| {
            let column = own.data.column_by_name(name).expect("a column");
            column.as_any().downcast_ref::<UInt64Array>().expect("numbers").values().to_vec()
        };
        let places = numbers(RawRrdManifest::FIELD_CHUNK_BYTE_OFFSET);
        for (place, size) in places.into_iter().zip(numbers(RawRrdManifest::FIELD_CHUNK_BYTE_SIZE)) {
            let place = place as usize;
            let header = &bytes[place - MessageHeader::ENCODED_SIZE_BYTES..place];
            let header = MessageHeader::from_rrd_bytes(header).expect("a header");
            assert_eq!((header.kind, header.len), (MessageKind::ArrowMsg, size));
            chunks += 1;
        }
    }
    let contents = Contents::of(&folder.path("two.rrd"));
    assert_eq!(chunks, contents.stores.values().map(Vec::len).sum::<usize>(), "all chunks");
}

#[test]
fn a_file_is_never_replaced_unasked_and_never_left_half() {
    let folder = Folder::new("refused");
    let file = folder.path("there.rrd");
    std::fs::write(&file, "mine").expect("a file");
    let refused = record_in(&folder, "there.rrd", &[short("case-3")]);
    assert!(matches!(refused, Err(RecordError::Write(WriteError::Exists(f))) if f == file));
    assert_eq!(std::fs::read(&file).expect("the file"), b"mine");

    let unplannable =
        Scenario { task: stillbase::session::scenario::Task { b: 9.0, ..short("case-3").task }, ..short("case-3") };
    let force = Options { force: true, ..Options::default() };
    let refused = record(&[short("case-1"), unplannable], &file, &force, &mut quietly);
    assert!(matches!(&refused, Err(RecordError::Refused { scenario, .. }) if scenario == "case-3"), "{refused:?}");
    assert_eq!(std::fs::read(&file).expect("the file"), b"mine", "what was there is there still");
    assert_eq!(folder.names(), ["there.rrd"], "nothing half written beside");

    record(&[short("case-3")], &file, &force, &mut quietly).expect("it may replace it");
    assert!(!Contents::of(&file).recording().is_empty());
    assert_eq!(folder.names(), ["there.rrd"]);
}

#[test]
fn a_recording_that_is_stopped_leaves_no_file() {
    let folder = Folder::new("stopped");
    let (fresh, there) = (folder.path("fresh.rrd"), folder.path("there.rrd"));
    std::fs::write(&there, "mine").expect("a file");
    let force = Options { force: true, ..Options::default() };
    // How often it asks, if it is never stopped.
    let mut asked = 0;
    record(&[short("case-3"), short("case-1")], &folder.path("whole.rrd"), &force, &mut |_| {
        asked += 1;
        true
    })
    .expect("it is not stopped");
    std::fs::remove_file(folder.path("whole.rrd")).expect("it was written");
    assert!(asked >= 8, "asked {asked} times");
    for file in [&fresh, &there] {
        for last in 0..asked {
            let mut left = last;
            let stopped = record(&[short("case-3"), short("case-1")], file, &force, &mut |_| {
                assert!(left >= 0, "nobody is asked again who has said no");
                left -= 1;
                left >= 0
            });
            assert!(matches!(stopped, Err(RecordError::Stopped)), "{last}: {stopped:?}");
            assert_eq!(folder.names(), ["there.rrd"], "{last}: nothing half written");
        }
    }
    assert_eq!(std::fs::read(&there).expect("the file"), b"mine", "what was there is there still");
}

#[test]
fn a_folder_that_cannot_be_written_is_named() {
    let folder = Folder::new("unwritable");
    std::fs::write(folder.path("plain"), "").expect("a file");
    for name in ["no/such/folder.rrd", "plain/inside.rrd"] {
        let error = record_in(&folder, name, &[short("case-3")]).expect_err("nowhere to write");
        assert!(matches!(&error, RecordError::Write(WriteError::NoFolder { file, .. }) if *file == folder.path(name)));
        assert!(error.to_string().contains(name), "{error}");
    }
    let error = record(&[short("case-3")], &folder.0, &Options { force: true, ..Options::default() }, &mut quietly);
    assert!(matches!(error, Err(RecordError::Write(WriteError::IsFolder(_)))), "a folder is no file");
    assert_eq!(folder.names(), ["plain"]);
    // Where not even root can write.
    #[cfg(target_os = "linux")]
    {
        let file = PathBuf::from("/proc/case.rrd");
        let error = record(&[short("case-3")], &file, &Options::default(), &mut quietly).expect_err("nowhere to write");
        assert!(matches!(&error, RecordError::Write(WriteError::Failed { file: named, .. }) if *named == file));
    }
}

#[test]
fn what_cannot_be_recorded_is_said() {
    let folder = Folder::new("said");
    assert!(matches!(record_in(&folder, "x.rrd", &[]), Err(RecordError::Nothing)));
    let twice = record_in(&folder, "x.rrd", &[short("case-1"), short("case-1")]);
    assert!(matches!(twice, Err(RecordError::SameName(name)) if name == "case-1"));
    for pictures in [
        Pictures { fps: 0.0, width: 10, height: 10, pin_forces: false },
        Pictures { fps: f64::NAN, width: 10, height: 10, pin_forces: false },
        Pictures { fps: 30.0, width: 0, height: 10, pin_forces: false },
    ] {
        let options = Options { pictures: Some(pictures), ..Options::default() };
        let refused = record(&[short("case-1")], &folder.path("x.rrd"), &options, &mut quietly);
        assert!(matches!(refused, Err(RecordError::Pictures(_))), "{pictures:?}");
    }
    assert!(folder.names().is_empty());
}

#[test]
fn names_with_slashes_and_blanks_stay_one_case() {
    let folder = Folder::new("names");
    let scenario = Scenario { name: "a/b c".into(), ..short("case-3") };
    record_in(&folder, "x.rrd", &[scenario]).expect("a case");
    let contents = Contents::of(&folder.path("x.rrd"));
    let of_case = contents.recording().iter().filter(|c| !c.entity_path().is_property());
    assert!(of_case.into_iter().all(|c| c.entity_path().iter().next().is_some_and(|p| p.unescaped_str() == "a/b c")));
}
