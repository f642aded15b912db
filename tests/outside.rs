//! Held against programs of others. They are Python packages; where one is missing, its tests count as ignored, with the
//! reason, or fail where `STILLBASE_REQUIRE_PYTHON` is 1. `STILLBASE_PYTHON` names the Python to ask, `python3` if it is
//! not set.

use std::process::ExitCode;

use libtest_mimic::{Arguments, Completion, Trial, run};

/// A test: its name with its module, and what it does. It passes unless it panics.
pub type Test = (&'static str, fn());

/// Lists the tests of a module.
macro_rules! tests {
    ($($name:ident),+ $(,)?) => {
        &[$((concat!(module_path!(), "::", stringify!($name)), $name)),+]
    };
}

#[path = "outside/afloat.rs"]
mod afloat;
#[path = "exchange/arms.rs"]
mod arms;
#[path = "outside/assembly_weights.rs"]
mod assembly_weights;
#[path = "outside/drags.rs"]
mod drags;
#[path = "outside/drawings.rs"]
mod drawings;
#[path = "outside/ezdxf.rs"]
mod ezdxf;
#[cfg(feature = "cli")]
#[allow(dead_code, reason = "the tests use a few of them")]
mod folder;
#[cfg(feature = "cli")]
#[allow(dead_code, reason = "the tests use a few of them")]
#[path = "guide/markdown.rs"]
mod markdown;
#[path = "outside/mesh.rs"]
mod mesh;
#[path = "outside/mujoco.rs"]
mod mujoco;
#[path = "outside/mujoco_assembly.rs"]
mod mujoco_assembly;
#[path = "support/noise.rs"]
mod noise;
#[path = "outside/package.rs"]
mod package;
#[cfg(feature = "cli")]
#[path = "outside/page.rs"]
mod page;
#[path = "outside/pinocchio.rs"]
mod pinocchio;
#[path = "outside/pinocchio_assembly.rs"]
mod pinocchio_assembly;
#[path = "outside/planar.rs"]
mod planar;
#[path = "outside/postures.rs"]
mod postures;
#[path = "outside/python.rs"]
mod python;
#[allow(dead_code, reason = "the tests use a few of them")]
#[path = "support/random.rs"]
mod random;

#[path = "outside/trim.rs"]
mod trim;
#[cfg(feature = "record")]
#[path = "outside/viewer.rs"]
mod viewer;
#[path = "outside/weights.rs"]
mod weights;
#[path = "outside/workshop.rs"]
mod workshop;

use noise::Noise;

/// How many there are to be, or which seed: `STILLBASE_OUTSIDE_` and a word ask for another number.
fn count(word: &str, usual: u64) -> u64 {
    let asked = std::env::var(format!("STILLBASE_OUTSIDE_{word}")).ok();
    asked.map_or(usual, |number| number.parse().expect("a whole number"))
}

fn main() -> ExitCode {
    let packages: &[(&str, &[Test])] = &[
        ("ezdxf", ezdxf::TESTS),
        ("numpy", mesh::TESTS),
        ("mujoco", afloat::TESTS),
        ("mujoco", mujoco::TESTS),
        ("mujoco", mujoco_assembly::TESTS),
        ("mujoco", planar::TESTS),
        ("pinocchio", pinocchio::TESTS),
        ("pinocchio", pinocchio_assembly::TESTS),
        ("stillbase, pandas", package::TESTS),
        #[cfg(feature = "cli")]
        ("stillbase, pandas, matplotlib, mujoco, pinocchio", package::NOTEBOOKS),
        #[cfg(feature = "cli")]
        ("stillbase", page::PACKAGE),
        ("scipy", assembly_weights::TESTS),
        ("scipy", drags::TESTS),
        ("scipy", postures::TESTS),
        ("scipy", trim::TESTS),
        ("scipy", weights::TESTS),
        ("ezdxf", workshop::TESTS),
        #[cfg(feature = "cli")]
        ("pandas, rerun.experimental", page::TABLES),
        #[cfg(feature = "cli")]
        ("pandas, pyarrow", page::PARQUET),
        #[cfg(feature = "cli")]
        ("pandas, mujoco", page::IN_MUJOCO),
        #[cfg(feature = "cli")]
        ("pinocchio", page::IN_PINOCCHIO),
        #[cfg(feature = "cli")]
        ("stillbase, dask.distributed", page::DASK),
        #[cfg(feature = "cli")]
        ("stillbase, ray", page::RAY),
        #[cfg(feature = "cli")]
        ("duckdb, datafusion", page::DATABASES),
        #[cfg(feature = "record")]
        ("rerun_cli", viewer::TESTS),
    ];
    let trials = packages.iter().flat_map(|(package, tests)| {
        let missing = python::missing(package);
        tests.iter().map(move |(name, test)| {
            let (missing, name, test) = (missing.clone(), name.split_once("::").map_or(*name, |(_, rest)| rest), *test);
            Trial::ignorable_test(name, move || match missing {
                Some(why) if python::is_required() => Err(format!("a package is required: {why}").into()),
                Some(why) => Ok(Completion::ignored_with(why)),
                None => {
                    test();
                    Ok(Completion::Completed)
                }
            })
        })
    });
    run(&Arguments::from_args(), trials.collect()).exit_code()
}
