//! Files of summaries: merged they are the whole, byte for byte, and what is damaged, doubled or foreign is refused.

use std::ops::Range;
use std::path::{Path, PathBuf};

use stillbase::files::shards::{StudyId, is_summary, merge_summaries, read_summary, write_summary};
use stillbase::study::tolerance::{Limits, SampleOutcome, Summary};

use crate::folder::Folder;

const STUDY: StudyId = StudyId { samples: 3000, seed: 1, problem: 7 };

const LIMITS: Limits = Limits { moment: Some(0.5), force: None };

fn machine(i: u64) -> SampleOutcome {
    let x = 0.01 + 1.1_f64.powi((i * 7919 % 97) as i32) * 1e-3 * (1.0 + 1e-5 * i as f64);
    SampleOutcome { peak_moment: x, peak_force: 2.0 * x, rms_moment: 0.5 * x, rms_force: x }
}

fn summary(machines: Range<u64>, limits: Limits) -> Summary {
    let mut sum = Summary::new(limits);
    sum.add(machines.start, &machines.clone().map(machine).collect::<Vec<_>>());
    sum.hold(machines);
    sum
}

fn write(file: PathBuf, study: &StudyId, machines: Range<u64>) -> PathBuf {
    write_summary(&file, true, study, &summary(machines, LIMITS)).expect("written");
    file
}

fn bytes(file: &Path) -> Vec<u8> {
    std::fs::read(file).expect("readable")
}

#[test]
fn summaries_put_together_are_the_whole() {
    let folder = Folder::new("summaries");
    let named = |name: &str| folder.path(&format!("{name}.parquet"));
    let whole = write(named("whole"), &STUDY, 0..3000);
    assert!(is_summary(&whole).expect("readable"));
    let (study, sum) = read_summary(&whole).expect("a summary");
    assert!(study == STUDY && sum == summary(0..3000, LIMITS));
    let [a, b, c] = [("a", 0..700), ("b", 700..701), ("c", 701..3000)].map(|(name, of)| write(named(name), &STUDY, of));
    // Some of them first, in any order.
    let (_, some) = merge_summaries(&[c, a]).expect("parts");
    assert_eq!(some.missing(3000), std::slice::from_ref(&(700..701)));
    write_summary(&named("some"), false, &STUDY, &some).expect("written");
    let (study, all) = merge_summaries(&[named("some"), b]).expect("parts");
    write_summary(&named("all"), false, &study, &all).expect("written");
    assert!(bytes(&named("all")) == bytes(&whole));
}

#[test]
fn what_is_no_part_of_the_study_is_refused() {
    let folder = Folder::new("summaries");
    let named = |name: &str| folder.path(&format!("{name}.parquet"));
    let a = write(named("a"), &STUDY, 0..1200);
    let late = write(named("late"), &STUDY, 1199..3000);
    let other = write(named("other"), &StudyId { problem: 8, ..STUDY }, 1200..3000);
    let limited = named("limited");
    let limits = Limits { moment: Some(0.4), force: None };
    write_summary(&limited, true, &STUDY, &summary(1200..3000, limits)).expect("written");
    std::fs::write(named("text"), "no table").expect("written");
    for (parts, want) in [
        (vec![], "want parts"),
        (vec![a.clone(), a.clone()], "machines 0 to 1199 are counted twice"),
        (vec![a.clone(), late], "machines 1199 to 1199 are counted twice"),
        (vec![a.clone(), other], "different studies"),
        (vec![a.clone(), limited], "--limit-moment"),
        (vec![a, named("text")], "text.parquet"),
        (vec![named("nowhere")], "want a plain file that can be read"),
    ] {
        let why = merge_summaries(&parts).expect_err(want).to_string();
        assert!(why.contains(want), "{why}");
    }
    let why = write_summary(&folder.path("a.csv"), true, &STUDY, &summary(0..3, LIMITS)).expect_err("CSV");
    assert!(why.to_string().contains("ends in .parquet"), "{why}");
}

/// Any byte that is changed, and any end that is cut off, is noticed. One of the checksum, or of the name of the program,
/// may hide it: then all numbers are as they were.
#[test]
fn damage_is_noticed() {
    let folder = Folder::new("summaries");
    let file = write(folder.path("a.parquet"), &STUDY, 0..40);
    let whole = bytes(&file);
    let damaged = folder.path("damaged.parquet");
    let last = |word: &[u8]| whole.windows(word.len()).rposition(|bytes| bytes == word).expect("it is there");
    let words = [(last(b" check "), 7 + 16), (last(b"stillbase 0"), 9)];
    let is_word = |at: usize| words.iter().any(|(from, count)| (*from..from + count).contains(&at));
    let mut noticed = 0;
    for at in (0..whole.len()).step_by(7) {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        std::fs::write(&damaged, &bytes).expect("written");
        match read_summary(&damaged) {
            Ok(read) => assert!(is_word(at) && read == (STUDY, summary(0..40, LIMITS)), "byte {at}"),
            Err(_) => noticed += 1,
        }
    }
    assert!(noticed > whole.len() / 7 - 8, "{noticed}");
    for length in (0..whole.len()).step_by(101) {
        std::fs::write(&damaged, &whole[..length]).expect("written");
        assert!(read_summary(&damaged).is_err(), "{length} bytes");
    }
}
