//! Files of summaries: merged they are the whole, byte for byte, and what is damaged, doubled or foreign is refused.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::{Field, Row};
use parquet::schema::types::SchemaDescriptor;
use stillbase::files::shards::{StudyId, is_summary, merge_summaries, read_summary, write_summary};
use stillbase::study::tolerance::{Limits, Octave, SampleOutcome, Summary, lower_edge};

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

/// Writes the rows of a table as another program does: without a checksum.
fn write_foreign(file: &Path, rows: &[Row], schema: &SchemaDescriptor) {
    let out = std::fs::File::create(file).expect("created");
    let mut writer = SerializedFileWriter::new(out, schema.root_schema_ptr(), Arc::default()).expect("a head");
    let mut group = writer.next_row_group().expect("a group");
    let mut at = 0;
    while let Some(mut column) = group.next_column().expect("a column") {
        let cells = rows.iter().map(|row| row.get_column_iter().nth(at).expect("a cell").1);
        match column.untyped() {
            ColumnWriter::Int64ColumnWriter(out) => {
                let all: Vec<i64> = cells.map(|cell| if let Field::Long(x) = cell { *x } else { panic!() }).collect();
                out.write_batch(&all, None, None).expect("written")
            }
            ColumnWriter::DoubleColumnWriter(out) => {
                let all: Vec<f64> = cells.map(|cell| if let Field::Double(x) = cell { *x } else { panic!() }).collect();
                out.write_batch(&all, None, None).expect("written")
            }
            ColumnWriter::ByteArrayColumnWriter(out) => {
                let text = |cell: &Field| if let Field::Str(x) = cell { x.as_str().into() } else { panic!() };
                out.write_batch(&cells.map(text).collect::<Vec<ByteArray>>(), None, None).expect("written")
            }
            _ => panic!("another column"),
        };
        column.close().expect("written");
        at += 1;
    }
    group.close().expect("written");
    writer.close().expect("written");
}

/// A table of another program has no checksum. A single count or digit that was changed on its way is noticed all the same,
/// by however little, and so is a row that was lost.
#[test]
fn a_changed_count_of_a_foreign_table_is_noticed() {
    let folder = Folder::new("summaries");
    let file = write(folder.path("a.parquet"), &STUDY, 0..300);
    let reader = SerializedFileReader::new(std::fs::File::open(&file).expect("there")).expect("Parquet");
    let schema = reader.metadata().file_metadata().schema_descr();
    let rows: Vec<Row> = reader.get_row_iter(None).expect("rows").map(|row| row.expect("a row")).collect();
    let foreign = folder.path("foreign.parquet");
    write_foreign(&foreign, &rows, schema);
    assert!(read_summary(&foreign).expect("a summary") == (STUDY, summary(0..300, LIMITS)));
    let changed = |at: usize, column: usize, by: i64| {
        let mut rows = rows.clone();
        let cells = rows[at].clone().into_columns().into_iter().enumerate().map(|(i, (name, cell))| match cell {
            Field::Long(x) if i == column => (name, Field::Long(x + by)),
            cell => (name, cell),
        });
        rows[at] = Row::new(cells.collect());
        rows
    };
    let names: Vec<&str> = schema.columns().iter().map(|column| column.name()).collect();
    let counted = |name: &&str| ["count", "control"].contains(name) || name.ends_with(char::is_numeric);
    let mut noticed = 0;
    for (column, _) in names.iter().enumerate().filter(|(_, name)| counted(name)) {
        for at in (0..rows.len()).step_by(3) {
            let outcome = match rows[at].get_column_iter().nth(1) {
                Some((_, Field::Str(outcome))) => outcome.as_str(),
                _ => panic!("an outcome"),
            };
            // Others have no digits, so these are not read.
            let is_read = match names[column] {
                "count" => true,
                "control" => !SampleOutcome::NAMES.contains(&outcome),
                _ => outcome.ends_with("_sums"),
            };
            if !is_read {
                continue;
            }
            for by in [1, -1, 1 << 20] {
                write_foreign(&foreign, &changed(at, column, by), schema);
                let why = read_summary(&foreign).expect_err(names[column]).to_string();
                assert!(why.contains("want"), "{why}");
                noticed += 1;
            }
        }
    }
    assert!(noticed > 1000, "{noticed}");
    // A limit with another value is another limit.
    let is_limit =
        |row: &Row| matches!(row.get_column_iter().nth(1), Some((_, Field::Str(of))) if of.starts_with("within"));
    let moved = |row: &Row| {
        let cells = row.clone().into_columns().into_iter().map(|(name, cell)| match cell {
            Field::Double(x) if is_limit(row) => (name, Field::Double(x * 1.0001)),
            cell => (name, cell),
        });
        Row::new(cells.collect())
    };
    write_foreign(&foreign, &rows.iter().map(moved).collect::<Vec<_>>(), schema);
    let why = read_summary(&foreign).expect_err("another limit").to_string();
    assert!(why.contains("control differ"), "{why}");
    for at in 0..rows.len() {
        let mut rows = rows.clone();
        let lost = rows.remove(at);
        write_foreign(&foreign, &rows, schema);
        let is_limit = matches!(lost.get_column_iter().nth(1), Some((_, Field::Str(of))) if of.starts_with("within"));
        match read_summary(&foreign) {
            // Without its row a limit was not counted.
            Ok((_, sum)) => assert!(is_limit && sum.limits() == Limits::default(), "row {at}"),
            Err(_) => assert!(!is_limit, "row {at}"),
        }
    }
}

/// However many machines there are, and however small their results: a summary takes at most 1 MB.
#[test]
fn a_summary_of_a_million_million_machines_is_small() {
    let folder = Folder::new("summaries");
    let mut sum = Summary::new(LIMITS);
    let samples = 1_000_000_000_000;
    // Numbers next to zero, as those of a half-normal distribution, fill every octave until one machine is left.
    for number in 0..SampleOutcome::NUMBERS {
        for octave in 0_u64..=40 {
            let count = if octave == 40 { 1 } else { samples >> (octave + 1) };
            let mut whole = Octave { count: 0, ..Octave::EMPTY };
            let exponent = 1023 - octave;
            for i in 0..1024.min(count) {
                let noise = (i + 1024 * octave).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32;
                let machines = count / 1024.min(count) + ((noise * (count >> 14)) >> 32);
                let x = lower_edge(exponent * 1024 + i);
                whole.add(x, i * 982_451_653 % samples);
                whole.sum += u128::from(machines - 1) * u128::from(x.to_bits() << 12 >> 12);
                sum.add_bin(number, exponent * 1024 + i, machines);
            }
            sum.add_octave(number, exponent, &whole);
        }
    }
    sum.hold(0..samples);
    let file = folder.path("whole.parquet");
    write_summary(&file, true, &StudyId { samples, ..STUDY }, &sum).expect("written");
    let length = std::fs::metadata(&file).expect("there").len();
    assert!((100_000..1_000_000).contains(&length), "{length} bytes");
}
