//! Shards of a study of tolerances: put together they are the whole, and what is missing, doubled or foreign is refused.

use std::panic;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use stillbase::files::row_file::RowForm;
use stillbase::files::shards::{ShardError, ShardHeader, StudyId, StudyPart, Writer, merge};
use stillbase::study::tolerance::SampleOutcome;

use crate::folder::Folder;

const STUDY: StudyId = StudyId { samples: 30, seed: 1, problem: 7 };

fn machine(i: u64) -> SampleOutcome {
    let x = 0.1 + 1e-3 * i as f64;
    SampleOutcome { peak_moment: x, peak_force: 2.0 * x, rms_moment: 0.5 * x, rms_force: x }
}

fn write(file: PathBuf, study: StudyId, samples: std::ops::Range<u64>) -> PathBuf {
    let head = ShardHeader::new(study, ["link.5.com m".to_owned()]);
    let mut writer = Writer::create((&file, RowForm::of(&file).expect("an ending")), true, &head).expect("begun");
    for i in samples {
        writer.machine(i, &[-0.02 + 1e-4 * i as f64], &machine(i)).expect("written");
    }
    writer.finish().expect("written");
    file
}

#[test]
fn shards_put_together_are_the_whole() {
    let folder = Folder::new("shards");
    for form in RowForm::ALL {
        let ending = form.ending();
        let named = |name: &str| folder.path(&format!("{name}.{ending}"));
        let whole = write(named("whole"), STUDY, 0..30);
        // A shard may hold no machine.
        let parts = [("b", 12..30), ("none", 12..12), ("a", 0..12)].map(|(name, of)| write(named(name), STUDY, of));
        let merged = named("merged");
        let (study, outcomes) = merge(&parts, (&merged, form), false, &|| true).expect("all of it").expect("goes on");
        assert_eq!((study, outcomes), (STUDY, (0..30).map(machine).collect()));
        let bytes = |file: &PathBuf| std::fs::read(file).expect("readable");
        assert!(bytes(&merged) == bytes(&whole), "{ending}");
        let part = StudyPart::open(&parts[0]).expect("a shard");
        assert_eq!((part.first_sample().expect("readable"), part.head.columns.len()), (Some(12), 5));
    }
}

#[test]
fn a_stopped_merge_leaves_no_file() {
    let folder = Folder::new("shards");
    let parts = [write(folder.path("a.csv"), STUDY, 0..12), write(folder.path("b.csv"), STUDY, 12..30)];
    let merged = folder.path("merged.csv");
    let stopped = merge(&parts, (&merged, RowForm::Csv), false, &|| false).expect("no error");
    assert_eq!((stopped, merged.exists()), (None, false));
    assert_eq!(std::fs::read_dir(folder.path(".")).expect("the folder").count(), 2);
}

#[test]
fn what_is_no_whole_study_is_refused() {
    let folder = Folder::new("shards");
    let named = |name: &str| folder.path(&format!("{name}.csv"));
    let a = write(named("a"), STUDY, 0..12);
    let b = write(named("b"), STUDY, 12..30);
    let late = write(named("late"), STUDY, 13..30);
    let other = write(named("other"), StudyId { seed: 2, ..STUDY }, 12..30);
    for (parts, want) in [
        (vec![], "want parts"),
        (vec![a.clone()], "samples 12 to 29 are in no part"),
        (vec![a.clone(), late], "samples 12 to 12 are in no part"),
        (vec![a.clone(), a.clone(), b.clone()], "sample 0 stands in"),
        (vec![a.clone(), other], "seeds 2 and 1"),
        (vec![named("nowhere")], "want a plain file that can be read"),
        (vec![folder.path("a.txt")], "want a name that ends in .csv or .parquet"),
    ] {
        let why = merge(&parts, (&named("merged"), RowForm::Csv), true, &|| true).expect_err(want);
        assert!(matches!(&why, ShardError::Wrong(said) if said.contains(want)), "{why}");
    }
    // A single digit that differs is noticed.
    let text = std::fs::read_to_string(&b).expect("readable").replacen("0.112", "0.113", 1);
    std::fs::write(&b, text).expect("written");
    let why = merge(&[a, b], (&named("merged"), RowForm::Csv), true, &|| true).expect_err("changed");
    assert!(why.to_string().contains("its checksum does not fit"), "{why}");
}

/// Files that are read on several threads at once leave the panics of others as they are.
#[test]
fn reading_leaves_the_panics_of_others_alone() {
    static SEEN: AtomicUsize = AtomicUsize::new(0);
    let folder = Folder::new("panics");
    let file = write(folder.path("whole.parquet"), STUDY, 0..30);
    let former = panic::take_hook();
    panic::set_hook(Box::new(move |of| match of.payload().downcast_ref::<&str>() {
        Some(&"meant") => drop(SEEN.fetch_add(1, Ordering::Relaxed)),
        _ => former(of),
    }));
    std::thread::scope(|scope| {
        for _ in 0..4 {
            let read = || (0..50).all(|_| StudyPart::open(&file).is_ok_and(|part| part.first_sample().is_ok()));
            scope.spawn(move || assert!(read()));
        }
        for _ in 0..50 {
            assert!(panic::catch_unwind(|| panic!("meant")).is_err());
        }
    });
    assert!(panic::catch_unwind(|| panic!("meant")).is_err());
    assert_eq!(SEEN.load(Ordering::Relaxed), 51);
}
