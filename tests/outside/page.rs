//! The scripts of the pages *From Python* and *A billion machines* of the guide run as they stand there, and print what the
//! page shows.

use std::process::Stdio;

use super::folder::Folder;
use super::markdown::blocks;
use super::python::python;
use crate::Test;

pub const DASK: &[Test] = tests![summaries_by_dask];
pub const RAY: &[Test] = tests![summaries_by_ray];
pub const DATABASES: &[Test] = tests![summaries_by_databases];
pub const TABLES: &[Test] = tests![a_run_is_a_table, a_recording_is_a_table];
pub const PACKAGE: &[Test] = tests![the_package_runs_as_shown];
pub const PARQUET: &[Test] = tests![what_pandas_writes_is_read];
pub const IN_MUJOCO: &[Test] = tests![the_same_motion_in_mujoco];
pub const IN_PINOCCHIO: &[Test] = tests![the_mass_matrix_by_pinocchio];

const PAGES: [&str; 2] = [include_str!("../../src/guide/python.md"), include_str!("../../src/guide/many_machines.md")];

fn the_package_runs_as_shown() {
    runs("package.py");
}

/// Text of the block of a kind: `python table.py`, or `text table.py` for what it prints.
fn block(kind: &str) -> String {
    let mut found = PAGES.into_iter().flat_map(blocks).filter(|block| block.kind == kind);
    let one = found.next().unwrap_or_else(|| panic!("the pages have no block {kind:?}"));
    assert!(found.next().is_none(), "the pages have one block {kind:?}");
    one.text
}

/// Runs a script of the page in a folder of its own, with the program on its path. In what the page shows, `…` stands for
/// the rest of a line.
fn runs(script: &str) {
    let (folder, shown) = (Folder::new("python"), block(&format!("text {script}")));
    folder.file(script, block(&format!("python {script}")));
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_stillbase")).parent().expect("a folder");
    let path = std::env::var("PATH").unwrap_or_default();
    let run = python()
        .arg(script)
        .current_dir(&folder.0)
        .env("PATH", format!("{}:{path}", program.display()))
        .stdin(Stdio::null())
        .output()
        .expect("it was there a moment ago");
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{script}: {said}");
    let printed = String::from_utf8(run.stdout).expect("UTF-8");
    let (shown, printed): (Vec<&str>, Vec<&str>) = (shown.lines().collect(), printed.lines().collect());
    assert_eq!(shown.len(), printed.len(), "{script} prints\n{}", printed.join("\n"));
    for (shown, printed) in shown.iter().zip(&printed) {
        let is_same = shown.strip_suffix('…').map_or(shown == printed, |start| printed.starts_with(start));
        assert!(is_same, "{script}: {printed}, the page shows {shown}");
    }
}

fn a_run_is_a_table() {
    runs("table.py");
}

/// Holds a Parquet file against the CSV of the same name, cell by cell.
const SAME_CELLS: &str = "import pandas as pd\n\
                          def same(name):\n    \
                              b = pd.read_parquet(name + '.parquet')\n    \
                              words = {c: '' for c in b if b[c].dtype.kind != 'f'}\n    \
                              a = pd.read_csv(name + '.csv', comment='#', dtype=dict(b.dtypes)).fillna(words)\n    \
                              assert len(b) > 9\n    \
                              pd.testing.assert_frame_equal(a, b, rtol=1e-14, atol=0)\n";

/// What pandas makes of a run, with gaps, its index and its own compression, is the same table.
fn what_pandas_writes_is_read() {
    let folder = Folder::new("pandas");
    let script = "import sys, pandas as pd\n\
                  table = pd.read_csv('run.csv', index_col='time s')\n\
                  table['torque/1 N m'] = table['torque/1 N m'].where(table.index > 0.1)\n\
                  table['payload/held 1'] = table['payload/held 1'].astype('int32')\n\
                  table.to_parquet('run.parquet')\n\
                  table.to_csv('gaps.csv')\n\
                  table.reset_index().iloc[::2].query('`time s` > 0.05').to_parquet('part.parquet')\n\
                  [table.to_parquet(how + '.parquet', compression=how) for how in ('zstd', 'gzip', 'lz4', 'brotli')]\n\
                  table.assign(word='a').to_parquet('text.parquet')\n\
                  pd.DataFrame({'t': pd.to_timedelta(range(9), unit='s'), 'x': 0.5, 'y': 0.6}).to_parquet('times.parquet')\n";
    let program = |args: &[&str]| {
        let run =
            std::process::Command::new(env!("CARGO_BIN_EXE_stillbase")).args(args).current_dir(&folder.0).output();
        let run = run.expect("the program starts");
        let said = String::from_utf8_lossy(&run.stdout).into_owned() + &String::from_utf8_lossy(&run.stderr);
        (run.status.code(), said)
    };
    assert_eq!(program(&["simulate", "case-3", "--set", "task.time=0.3", "-o", "run.csv"]).0, Some(0));
    let run = python().args(["-c", script]).current_dir(&folder.0).stdin(Stdio::null()).output().expect("it was there");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    for line in [
        "diff gaps.csv run.parquet",
        "diff case-3 part.parquet --set task.time=0.3 --from 0.052 --signals angle,moment",
    ] {
        let (status, said) = program(&line.split(' ').collect::<Vec<_>>());
        assert_eq!(status, Some(0), "{line}: {said}");
    }
    let (status, said) = program(&["diff", "run.csv", "run.parquet"]);
    assert!(status == Some(1) && said.contains("1 of ") && said.contains("torque/1"), "{said}");
    for (line, script) in [
        ("export-model nine-link -o parts.csv", ""),
        ("export-model nine-link -o parts.parquet", "same('parts')"),
        ("figures case-1 --what moment -o m.svg", ""),
        ("figures case-1 --what moment -o m.svg --numbers parquet --force", "same('m')"),
        ("export case-1 --rate 250 -o motion.csv", "pd.read_csv('motion.csv').to_parquet('motion.parquet')"),
        ("import motion.parquet -o quiet.toml", ""),
    ] {
        let (status, said) = program(&line.split(' ').collect::<Vec<_>>());
        assert_eq!(status, Some(0), "{line}: {said}");
        let script = format!("{SAME_CELLS}\n{script}\n");
        let run = python().args(["-c", &script]).current_dir(&folder.0).stdin(Stdio::null()).output().expect("there");
        assert!(run.status.success(), "{line}: {}", String::from_utf8_lossy(&run.stderr));
    }
    for how in ["zstd", "gzip", "lz4"] {
        let (status, said) = program(&["diff", "run.parquet", &format!("{how}.parquet")]);
        assert_eq!(status, Some(0), "{how}: {said}");
    }
    let (status, said) = program(&["table", "brotli.parquet"]);
    assert!(status == Some(2) && said.contains("without compression, or with Snappy, gzip, LZ4"), "{said}");
    let (status, said) = program(&["table", "text.parquet"]);
    assert!(status == Some(2) && said.contains("column word: text: want numbers"), "{said}");
    let (status, said) = program(&["import", "times.parquet", "-o", "times.toml"]);
    assert!(status == Some(2) && said.contains("durations"), "{said}");
}

fn summaries_by_dask() {
    runs("with_dask.py");
}

fn summaries_by_ray() {
    runs("with_ray.py");
}

fn summaries_by_databases() {
    runs("merged.py");
}

fn a_recording_is_a_table() {
    runs("recorded.py");
}

fn the_same_motion_in_mujoco() {
    runs("in_mujoco.py");
}

fn the_mass_matrix_by_pinocchio() {
    runs("in_pinocchio.py");
}
