//! Tables of numbers: columns by name and unit, turns taken out, and what is wrong by line and column.

use std::f64::consts::{PI, TAU};

use stillbase::files::table::{SampleTable, Table, TableData, TableError, motions, samples};
use stillbase::mechanics::machine::builtin;
use stillbase::planning::curves::Coordinates;
use stillbase::study::advice::Remedy;

/// Twenty rows of a motion over a second, written by `row` of time, s.
fn table(head: &str, row: impl Fn(f64) -> String) -> String {
    let rows: Vec<String> = (0..20).map(|i| row(f64::from(i) / 19.0)).collect();
    format!("{head}\n{}\n", rows.join("\n"))
}

fn read(text: &str) -> Result<SampleTable, TableError> {
    samples(&Table::of_csv(text, "in.csv"), builtin("nine-link").expect("built in"), None, false)
}

#[test]
fn units_separators_and_order_make_no_difference() {
    let degrees = |x: f64| x * 180.0 / PI;
    let q = |t: f64| [1.7 - 0.2 * t * t, 3.7 + 0.5 * t * t, 2.2 + 0.9 * t * t];
    let plain = table("t,q1,q2,q3", |t| format!("{t},{},{},{}", q(t)[0], q(t)[1], q(t)[2]));
    let other = table("# a remark\nq3 (deg);time [ms];noise;q_1 rad;q2_deg", |t| {
        format!("{};{};x;{};{}", degrees(q(t)[2]), 1e3 * t, q(t)[0], degrees(q(t)[1]))
    });
    let [plain, other] = [plain, other].map(|text| read(&text).expect("samples"));
    assert_eq!((plain.coordinates, &plain.names[..]), (Coordinates::Drives, &["q1", "q2", "q3"].map(String::from)[..]));
    let pairs = plain.samples.rows().flatten().zip(other.samples.rows().flatten());
    assert!(pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) < 1e-12);
    let tip = read(&table("x (mm),y,t", |t| format!("{},{},{t}", 500.0 + 50.0 * t, 0.5))).expect("samples");
    assert_eq!((tip.coordinates, tip.samples.point(0).re), (Coordinates::EndEffector, 0.5));
}

#[test]
fn whole_turns_are_taken_out() {
    let q1 = |t: f64| 2.8 + 0.8 * t;
    let wrapped = |t: f64| if q1(t) > PI { q1(t) - TAU } else { q1(t) };
    let found = read(&table("t,q1,q2,q3", |t| format!("{t},{},3.7,2.2", wrapped(t)))).expect("samples");
    assert_eq!(found.unwrapped, [1, 0, 0]);
    let last = found.samples.count() - 1;
    assert!((found.samples.values(last)[0] - 3.6).abs() < 1e-12);
}

#[test]
fn what_is_wrong_is_said_by_line_and_column() {
    let good = |t: f64| format!("{t},1.7,3.7,2.2");
    let worse = |line: usize, row: &str| {
        let text = table("t,q1,q2,q3", good);
        text.lines().enumerate().map(|(i, own)| if i + 1 == line { row } else { own }).collect::<Vec<_>>().join("\n")
    };
    for (text, line, want) in [
        (String::new(), Some(1), "nothing here: want a header t,q1,q2,q3"),
        ("1,2,3,4\n".into(), Some(1), "no header"),
        (worse(1, "t,q1,q2"), Some(1), "no column q3"),
        (worse(1, "t,q1,q2"), Some(1), "these are angles of 2 drives, and nine-link has 3"),
        (worse(1, "t,q1,q1,q3"), Some(1), "columns 2 and 3 are both q1"),
        (worse(1, "t,q1 (ft),q2,q3"), Some(1), "unit \"ft\""),
        (worse(5, "0.16,1.7,,2.2"), Some(5), "column q2: nothing there"),
        (worse(5, "0.16,1.7,1e300,2.2"), Some(5), "column q2: \"1e300\""),
        (worse(5, "0.01,1.7,3.7,2.2"), Some(5), "column t: 0.01 s after"),
        (worse(5, "0.16,1.7,2.1,2.2"), Some(5), "column q2: a jump of -1.600 rad from line 4"),
        ("t,q1,q2,q3\n0,1,2,3\n".into(), None, "1 row of numbers"),
    ] {
        let why = read(&text).expect_err(want);
        assert_eq!((&*why.file, why.line), ("in.csv", line), "{why}");
        assert!(why.why.to_string().contains(want), "{why}");
        let place = line.map_or("in.csv: ".to_owned(), |line| format!("in.csv:{line}: "));
        assert!(why.to_string().starts_with(&place), "{why}");
    }
}

#[test]
fn motions_part_where_time_leaps_or_begins_anew() {
    let machine = builtin("two-drive").expect("built in");
    let at = |time: f64, t: f64| format!("{time},{},1,0.1,0.2,0.3", 0.5 * t);
    let row = |t: f64| at(t, t);
    let one = table("t,q1,q2,fx (mN),fy,nz", row);
    let rows = one.split_once('\n').expect("a head").1;
    let later = table("", |t| at(t + 30.0, t));
    let text = format!("{one}{rows}{}", later.trim_start());
    let found = motions(&Table::of_csv(text, "in.csv"), machine).expect("motions");
    assert_eq!(found.iter().map(|motion| motion.t.len()).collect::<Vec<_>>(), [20, 20, 20]);
    assert!((found[2].force[0].re - 1e-4).abs() < 1e-15 && found[0].qd.is_empty());
    let moving = table("t,q1,q2,fx,fy,nz,base_x", |t| format!("{},{}", row(t), 1e-3 * t));
    let why = motions(&Table::of_csv(moving, "in.csv"), machine).expect_err("the base moves");
    assert!(why.line == Some(3) && why.why.to_string().starts_with("column base_x: the base moves"), "{why}");
}

/// A motion and a measurement are told apart by their columns, whatever stands between these.
#[test]
fn what_a_table_is_of_is_told_by_its_columns() {
    let machine = builtin("nine-link").expect("built in");
    let on = |head: &str, row: &str, floats: bool| {
        let text = table(head, |t| format!("{t}{row}"));
        TableData::of(&Table::of_csv(text, "in.csv"), machine, floats, false)
    };
    let of = |head: &str, row: &str| on(head, row, false);
    for (head, row, coordinates) in [
        ("t,q1,q2,q3", ",1.7,3.7,2.2", Coordinates::Drives),
        ("\u{feff}t;q1 (rad);q2;q3", ";1.7;3.7;2.2", Coordinates::Drives),
        ("t,x (mm),y", ",500,0.5", Coordinates::EndEffector),
        // Of a motion the angles come first, and what else is there is left alone.
        ("t,q1,q2,q3,x,y,tau1", ",1.7,3.7,2.2,0.5,0.5,0", Coordinates::Drives),
    ] {
        let found = of(head, row).expect(head);
        assert!(
            matches!(found, TableData::Motion(ref motion) if motion.coordinates == coordinates),
            "{head}: {found:?}"
        );
    }
    for (head, row) in [
        ("t,q1,q2,q3,fx,fy,nz", ",1.7,3.7,2.2,1,2,3"),
        ("t;q1;q2;q3;fx (mN);f_y;moment/total N m", ";1.7;3.7;2.2;1;2;3"),
        ("t,q1,q2,q3,x,y,fx,fy,nz", ",1.7,3.7,2.2,0.5,0.5,1,2,3"),
    ] {
        let found = of(head, row).expect(head);
        assert!(matches!(found, TableData::Measurement(ref motions) if motions[0].t.len() == 20), "{head}: {found:?}");
    }
    // Rates of a base are a measurement if it floats; forces beside them are left alone.
    let drives = "angle/1 rad,angle/2 rad,angle/3 rad,rate/1 rad/s,rate/2 rad/s,rate/3 rad/s";
    let head =
        format!("time s,{drives},force/x N,force/y N,moment/total N m,attitude/base rad,attitude_rate/base rad/s");
    let row = ",1.7,3.7,2.2,1,2,3,0,0,0,0.1,0.5";
    let found = on(&head, row, true).expect("a motion in orbit");
    assert!(
        matches!(found, TableData::Orbit(ref motion) if motion.base_rate == [0.5; 20] && motion.rates[0][2] == 2.5
            && (motion.angles[0][1] - 3.6).abs() < 1e-12),
        "{found:?}"
    );
    assert!(matches!(on(&head, row, false), Ok(TableData::Measurement(_))), "a base that stands still");
    let turned = on(&head.replace("base rad,", "base (deg),"), row, true).expect("degrees");
    let turn = 0.1_f64.to_radians();
    assert!(
        matches!(turned, TableData::Orbit(ref motion) if (motion.attitude[0] - turn).abs() < 1e-15
            && (motion.angles[0][1] - 3.7 + turn).abs() < 1e-12),
        "{turned:?}"
    );
    let why = on(&head.replace("base rad,", "base (turns),"), row, true).expect_err("turns").to_string();
    assert_eq!(why, "in.csv: attitude/base: unit \"turns\": want rad, or degrees for radians");
}

/// A table that is neither is refused, with the columns of both.
#[test]
fn a_table_that_is_neither_is_refused() {
    let machine = builtin("nine-link").expect("built in");
    let refused = |text: &str| {
        TableData::of(&Table::of_csv(text, "in.csv"), machine, false, false).expect_err("neither").to_string()
    };
    let both = "want a header t,q1,q2,q3 (rad) or t,x,y (m) of a motion, or t,q1,q2,q3,fx,fy,nz (s, rad, N, N m) of a \
                measurement";
    for (text, what) in [
        ("", "in.csv:1: nothing here"),
        ("\u{feff}", "in.csv:1: nothing here"),
        ("1,2,3,4\n", "in.csv:1: no header"),
        ("t,a,b\n0,1,2\n", "in.csv:1: no column q1 among \"t\", \"a\", \"b\""),
        ("t,q1,q2\n0,1,2\n", "in.csv:1: no column q3 among"),
        ("t,x\n0,1\n", "in.csv:1: no column y among"),
        ("q1,q2,q3\n0,1,2\n", "in.csv:1: no column t among"),
        ("t,q1,q2,q3,fx,fy\n0,1,2,3,4,5\n", "in.csv:1: no column nz among"),
        ("t,q1,q2,fx,fy,nz\n0,1,2,3,4,5\n", "in.csv:1: no column q3 among"),
    ] {
        let why = refused(text);
        assert!(why.starts_with(what) && why.ends_with(both), "{why}");
    }
    for (head, row, what) in [
        ("t,q1,q2,q3", ",NaN,3.7,2.2", "in.csv:2: column q1: \"NaN\": want a finite number"),
        ("t,q1,q2,q3,fx,fy,nz", ",1.7,3.7,2.2,1,inf,3", "in.csv:2: column fy: \"inf\": want a finite number"),
        ("t,q1,q2,q3,fx,fy,nz", ",1.7,3.7,2.2,1,2", "in.csv:2: column nz: nothing there"),
    ] {
        let why = refused(&table(head, |t| format!("{t}{row}")));
        assert!(why.starts_with(what), "{why}");
    }
    let why = Table::open("no/such/file.csv".as_ref()).expect_err("not there").to_string();
    assert!(why.starts_with("no/such/file.csv: ") && why.contains("want a plain file"), "{why}");
}

/// What would help is named by whoever shows the message.
#[test]
fn a_way_out_has_the_name_of_who_shows_it() {
    let gap = table("t,q1,q2,q3", |t| format!("{},1.7,3.7,2.2", if t > 0.5 { t + 9.0 } else { t }));
    let why = read(&gap).expect_err("a gap");
    assert_eq!(why.why.remedies().collect::<Vec<_>>(), [Remedy::Gaps]);
    let plain = why.to_string();
    assert!(!plain.contains("--") && plain.ends_with("to have it bridged by the spline"), "{plain}");
    let worded = why.worded(|_| "a tick at Gaps").to_string();
    assert!(worded.ends_with("want it filled, or a tick at Gaps to have it bridged by the spline"), "{worded}");
}

/// Parquet is the same table: words name motions, numbers may be words, and other columns count for nothing.
#[cfg(feature = "cli")]
#[test]
fn columns_of_parquet_are_those_of_csv() {
    use stillbase::files::row_file::{RowFile, RowForm};
    let folder = crate::folder::Folder::new("table");
    let machine = builtin("two-drive").expect("built in");
    let (texts, numbers) = (["motion", "fx (mN)"], ["t", "q1", "q2", "fy", "nz"].map(String::from));
    for form in RowForm::ALL {
        let file = folder.path(&format!("plate.{}", form.ending()));
        let mut rows = RowFile::with_texts((&file, form), false, "instant", (&texts, &numbers)).expect("begun");
        for i in 0..40 {
            let t = f64::from(i) / 39.0;
            let (motion, force) = (if i < 15 { "slow" } else { "fast" }, (100.0 * t).to_string());
            let numbers = [t, 0.5 * t, 1.0 - t, 0.2, 0.3].map(Some);
            rows.named_row(&[motion, &force], &numbers).expect("a row");
        }
        rows.finish().expect("written");
    }
    let [csv, parquet] = ["plate.csv", "plate.parquet"].map(|name| {
        let table = Table::open(&folder.path(name)).expect(name);
        motions(&table, machine).expect(name)
    });
    assert_eq!(parquet, csv);
    assert_eq!(parquet.iter().map(|motion| motion.t.len()).collect::<Vec<_>>(), [15, 25]);
    assert!((parquet[1].force[24].re - 0.1).abs() < 1e-15);
    let table = Table::open(&folder.path("plate.parquet")).expect("a table");
    assert_eq!(samples(&table, machine, None, false).expect("the angles are there").samples.count(), 40);
}
