//! Tables of signals over time: CSV and Parquet, as this program and as others write them.

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;

use stillbase::files::row_file::RowFile;
use stillbase::files::table::signals;
use stillbase::simulation::signal_table::SignalTable;

use crate::folder::Folder;

/// Values of a column: those of each row, and for each row whether there is one.
enum Values {
    Double(Vec<f64>, Option<Vec<i16>>),
    Float(Vec<f32>),
    Int(Vec<i32>),
    Long(Vec<i64>),
    Bool(Vec<bool>),
    Text(Vec<&'static str>),
}

/// Writes a Parquet file of one row group a part.
fn write(file: &Path, schema: &str, compression: Compression, parts: &[Vec<Values>]) {
    let schema = Arc::new(parse_message_type(schema).expect("a schema"));
    let properties = Arc::new(WriterProperties::builder().set_compression(compression).build());
    let mut writer = SerializedFileWriter::new(File::create(file).expect("a file"), schema, properties).expect("begun");
    for part in parts {
        let mut group = writer.next_row_group().expect("a group");
        for values in part {
            let mut column = group.next_column().expect("a column").expect("one more");
            match (column.untyped(), values) {
                (ColumnWriter::DoubleColumnWriter(to), Values::Double(x, levels)) => {
                    to.write_batch(x, levels.as_deref(), None)
                }
                (ColumnWriter::FloatColumnWriter(to), Values::Float(x)) => to.write_batch(x, None, None),
                (ColumnWriter::Int32ColumnWriter(to), Values::Int(x)) => to.write_batch(x, None, None),
                (ColumnWriter::Int64ColumnWriter(to), Values::Long(x)) => to.write_batch(x, None, None),
                (ColumnWriter::BoolColumnWriter(to), Values::Bool(x)) => to.write_batch(x, None, None),
                (ColumnWriter::ByteArrayColumnWriter(to), Values::Text(x)) => {
                    to.write_batch(&x.iter().map(|x| ByteArray::from(*x)).collect::<Vec<_>>(), None, None)
                }
                _ => panic!("another type"),
            }
            .expect("written");
            column.close().expect("closed");
        }
        group.close().expect("closed");
    }
    writer.close().expect("closed");
}

/// Tables are the same, where no number equals no number.
fn assert_same(a: &SignalTable, b: &SignalTable) {
    let bits = |table: &SignalTable| {
        let columns = table.columns.iter().map(|c| {
            let values = c.values.iter().map(|x| if x.is_nan() { None } else { Some(x.to_bits()) });
            (c.path.clone(), c.unit.clone(), values.collect::<Vec<_>>())
        });
        (table.time.iter().map(|t| t.to_bits()).collect::<Vec<_>>(), columns.collect::<Vec<_>>())
    };
    assert_eq!(bits(a), bits(b));
}

#[test]
fn parquet_is_read_as_csv_is() {
    let folder = Folder::new("signals");
    let heads = ["time s", "torque/1 N m", "pose/b rad", "reactionless/now 1"].map(String::from);
    let files = ["a.csv", "a.parquet"].map(|name| folder.path(name));
    for file in &files {
        let mut rows = RowFile::create(file, false, "instant", &heads).expect("begun");
        for i in 0..70_000 {
            let t = f64::from(i) * 1e-3;
            let gap = (i % 7 != 0).then(|| (t * 3.0).sin());
            rows.row(&[Some(t), gap, Some(-t), Some(f64::from(i % 2))]).expect("a row");
        }
        rows.finish().expect("whole");
    }
    let [csv, parquet] = files.map(|file| signals(&file).expect("a table"));
    assert_eq!((csv.time.len(), csv.columns.len(), csv.columns[0].unit.as_str()), (70_000, 3, "N m"));
    assert_same(&csv, &parquet);
}

#[test]
fn parquet_of_others_is_read() {
    let folder = Folder::new("signals-others");
    let file = folder.path("others.parquet");
    // As pandas writes it: all columns optional, an index without a name, the time last, Snappy.
    let schema = "message schema {
        optional double torque; required float moment; required int32 count; required int64 big (INTEGER(64, false));
        required boolean held; required int64 __index_level_0__; required double time; }";
    let part = |from: i32| {
        vec![
            Values::Double(vec![1.5, 2.5], Some(vec![1, 0, 1])),
            Values::Float(vec![0.25, 0.5, 0.75]),
            Values::Int(vec![from, from + 1, -3]),
            Values::Long(vec![i64::MAX, -1, 0]),
            Values::Bool(vec![true, false, true]),
            Values::Long(vec![7, 8, 9]),
            Values::Double((0..3).map(|i| f64::from(from + i)).collect(), None),
        ]
    };
    // Polars and DataFusion compress with Zstandard.
    for compression in [
        Compression::UNCOMPRESSED,
        Compression::SNAPPY,
        Compression::ZSTD(Default::default()),
        Compression::GZIP(Default::default()),
        Compression::LZ4_RAW,
    ] {
        write(&file, schema, compression, &[part(0), part(3)]);
        let table = signals(&file).expect("a table");
        assert_eq!(table.time, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let paths: Vec<&str> = table.columns.iter().map(|column| column.path.as_str()).collect();
        assert_eq!(paths, ["torque", "moment", "count", "big", "held"]);
        let values = |path: &str| table.column(path).expect("a signal").values.clone();
        let torque = values("torque");
        assert_eq!((torque[0], torque[1].is_nan(), torque[2], torque[5]), (1.5, true, 2.5, 2.5));
        assert_eq!(values("moment")[..3], [0.25, 0.5, 0.75]);
        assert_eq!((values("count")[2], values("count")[3]), (-3.0, 3.0));
        assert_eq!(values("big")[..3], [i64::MAX as f64, u64::MAX as f64, 0.0], "without a sign");
        assert_eq!(values("held")[..3], [1.0, 0.0, 1.0]);
    }
}

#[test]
fn what_is_no_table_of_signals_is_refused_with_what_would_be_right() {
    let folder = Folder::new("signals-refused");
    let file = folder.path("wrong.parquet");
    let double = |x: &[f64]| Values::Double(x.to_vec(), None);
    let cases: [(&str, Vec<Values>, &str); 9] = [
        (
            "required double x; required double y;",
            vec![double(&[1.0]), double(&[1.0])],
            "no column for the time among x, y: want a column for the time",
        ),
        ("required double time;", vec![double(&[1.0])], "nothing but the time"),
        (
            "required double time; required binary name (UTF8);",
            vec![double(&[1.0]), Values::Text(vec!["a"])],
            "column name: text: want numbers",
        ),
        (
            "required int64 time (TIMESTAMP(MICROS, true)); required double x;",
            vec![Values::Long(vec![1]), double(&[1.0])],
            "column time: dates or times of day: want numbers",
        ),
        (
            "required double t; required int32 x (DECIMAL(5, 2));",
            vec![double(&[1.0]), Values::Int(vec![1])],
            "column x: decimal fractions: want numbers",
        ),
        (
            "required double time; required double x;",
            vec![double(&[0.0, 1.0, 1.0]), double(&[1.0; 3])],
            "row 3: column time: 1 s after 1 s: want times that increase",
        ),
        (
            "optional double time; required double x;",
            vec![Values::Double(vec![0.0], Some(vec![1, 0])), double(&[1.0; 2])],
            "row 2: column time: no number",
        ),
        ("required double time; required double x;", vec![double(&[]), double(&[])], "no row: want at least one"),
        (
            "required double t_ms; required double x; required double X;",
            vec![double(&[0.0]), double(&[0.0]), double(&[0.0])],
            "no column for the time",
        ),
    ];
    for (fields, values, words) in cases {
        write(&file, &format!("message m {{ {fields} }}"), Compression::UNCOMPRESSED, &[values]);
        let why = signals(&file).expect_err(words).to_string();
        assert!(why.contains("wrong.parquet: ") && why.contains(words), "{why}");
    }
    let packed = "message m { required double time; required double x; }";
    write(&file, packed, Compression::UNCOMPRESSED, &[vec![double(&[0.0, 1.0]), double(&[1.0, 2.0])]]);
    let whole = std::fs::read(&file).expect("a file");
    for text in ["", "PAR1", "time s,x m\n0,1\n"] {
        std::fs::write(&file, text).expect("a file");
        assert!(signals(&file).expect_err("no Parquet").to_string().contains("want a whole Parquet file"));
    }
    // Damaged at any place, it is read or refused.
    for i in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[i] ^= 0xff;
        std::fs::write(&file, &damaged).expect("a file");
        let _ = signals(&file);
        std::fs::write(&file, &whole[..i]).expect("a file");
        assert!(signals(&file).is_err(), "the first {i} bytes");
    }
    assert!(signals(&folder.path("none.parquet")).expect_err("no file").to_string().contains("none.parquet"));
}

/// A name of an earlier version counts, unless the newer one stands beside it.
#[test]
fn older_names_of_columns_are_read() {
    let folder = Folder::new("signals-older");
    let paths = |text: &str| {
        let table = signals(&folder.file("older.csv", text)).expect("a table");
        let columns =
            table.columns.iter().map(|column| format!("{} {} {}", column.path, column.unit, column.values[0]));
        columns.collect::<Vec<_>>().join(", ")
    };
    assert_eq!(paths("time s,tilt x N m,B1 x N\n0,1,2\n"), "tilt/x N m 1, B1 x N 2");
    assert_eq!(paths("time s,tilt/x N m,tilt x N m\n0,1,3\n"), "tilt/x N m 1");
    assert_eq!(paths("torque/1 N m,t\n5,0\n"), "torque/1 N m 5", "the time stands anywhere");
}
