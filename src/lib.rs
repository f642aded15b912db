//! Zero reaction manipulators, from Papadopoulos & Abu-Abed, *On the Design of Zero Reaction Manipulators*: design,
//! plan, simulate, see and record what a robot arm does to the base it stands on.
//!
//! Balance the arm so that its centre of mass never moves, and no force reaches the base. Make its mass matrix
//! constant, and move only on the planes q₁ + λ₂ q₂ + λ₃ q₃ = b of joint space, and no moment does either. Each *pose
//! constant* b has its *reactionless workspace*; changing b only turns it.
//!
//! How the program is used, its window and its commands, stands in the [`guide`].
//!
//! # A tour
//! A [`Machine`](mechanics::machine::Machine) is data, checked. It collapses into a few constants, its
//! [`Inertia`](mechanics::machine::Inertia), and these say whether it is balanced:
//! ```
//! use stillbase::mechanics::machine::{self, Inertia};
//! let machine = machine::builtin("nine-link").expect("built in");
//! let inertia = Inertia::of(machine);
//! assert!(inertia.is_force_balanced() && inertia.is_invariant());
//! ```
//! [`design`](mechanics::balance::design) finds the centres of mass that make a machine so, Eqs (7)–(10):
//! ```
//! # use stillbase::mechanics::balance::{design, Preset};
//! # use stillbase::mechanics::machine;
//! let rounded = machine::builtin("nine-link-table-1").expect("built in");
//! let exact = design(rounded, &Preset::Table1.penalty(9)?)?;
//! assert!((exact.links()[0].com - -0.2214384).abs() < 1e-7);
//! # Ok::<(), stillbase::mechanics::balance::DesignError>(())
//! ```
//! Its pose space ([`PoseSpace`](planning::pose_space::PoseSpace)) knows which b reach a point, where, and how far the
//! workspace goes, for any number of drives:
//! ```
//! # use stillbase::mechanics::machine;
//! # use stillbase::mechanics::planar::Vector;
//! use stillbase::planning::pose_space::PoseSpace;
//! # let machine = machine::builtin("nine-link").expect("built in");
//! let space = PoseSpace::of(machine).expect("it has a b");
//! let a = space.reach(Vector::new(0.50, 0.50)).expect("within reach");
//! assert!((a.intervals[0][0] - 1.6495370969).abs() < 1e-9);
//! assert!((space.outline(2.4).area - 0.8451448471).abs() < 1e-9);
//! ```
//! What only some machines have it gives out by name, or says why not. On planes a curve of the end effector is followed
//! exactly, or refused with where, why, and which b would do:
//! ```
//! # use stillbase::mechanics::machine;
//! # use stillbase::mechanics::planar::Vector;
//! # use stillbase::planning::pose_space::PoseSpace;
//! # let machine = machine::builtin("nine-link").expect("built in");
//! # let space = PoseSpace::of(machine).expect("it has a b");
//! let planes = space.planes().expect("three drives, limits of both angles");
//! use stillbase::planning::curves::Curve;
//! use stillbase::planning::following::{Rule, trace};
//! let line = [Curve::line(Vector::new(0.50, 0.50), Vector::new(0.55, 0.90))];
//! assert!(trace::follow(planes.map(), &line, 2.4, None, Rule::default()).is_ok());
//! let blocked = trace::follow(planes.map(), &line, 2.9, None, Rule::default()).expect_err("B is on other planes");
//! assert!((blocked.nearest_b.expect("2.4 and others") - 2.6610727).abs() < 1e-4);
//! ```
//! A [`Scenario`](session::scenario::Scenario) sets a task; a [`Run`](session::Run) carries it out step by step and
//! gives a [`Frame`](simulation::frame::Frame) of everything true at each instant:
//! ```
//! # use stillbase::session::scenario::Scenario;
//! # use stillbase::session::replay;
//! let case_3 = Scenario::builtin("case-3").expect("built in");
//! let run = replay(&case_3, |_run, frame| assert!(frame.base_moment().abs() < 1e-9))?;
//! assert!(run.frame().peaks.is_reactionless());
//! # Ok::<(), stillbase::session::Refusal>(())
//! ```
//! A [`Session`](session::Session) is a run that a person changes while it goes on: every change is an
//! [`Edit`](session::Edit), so it can be saved, undone and replayed to the very same frames. Bookmarks, and branches that it
//! left, are kept beside the edits, saved and undone with them.
//!
//! # From a program of your own
//! A machine comes from a TOML file, by [`files::machine`], or from text. An error says which line and which key is
//! wrong, and what would be right:
//! ```
//! use stillbase::mechanics::machine::{Inertia, parse};
//! let text = r#"
//! name = "bar"
//! [[drive]]
//! name = "1"
//! [[link]]
//! name = "bar"
//! drive = "1"
//! attach = "base"
//! length = 0.4     # m
//! mass = 2.0       # kg
//! inertia = 0.05   # kg m²
//! com = 0.2        # m
//! [end_effector]
//! link = "bar"
//! "#;
//! let inertia = Inertia::of(&parse(text, "bar.toml")?);
//! assert!((inertia.momenta()[0] - (0.05 + 2.0 * 0.2 * 0.2)).abs() < 1e-15);
//! let error = parse(&text.replace("2.0", "-2.0"), "bar.toml").expect_err("no mass");
//! assert_eq!(error.to_string(), "bar.toml:10: link.bar.mass is -2: want 1e-15 to 1000000 kg");
//! # Ok::<(), stillbase::mechanics::machine::FileError>(())
//! ```
//! [`place_weights`](mechanics::counterweights::place_weights) finds counterweights, and proves that they are the best:
//! the duality gap bounds how far they are from the optimum. Here m l_c = 2 kg · 0.2 m, and a weight 0.4 m behind the
//! pin balances that with 1 kg:
//! ```
//! # use stillbase::mechanics::machine::{Inertia, parse};
//! use stillbase::mechanics::counterweights::{CounterweightSpec, Disc, Objective, Sites, place_weights};
//! # let text = "name = 'bar'\ndrive = [{ name = '1' }]\nend_effector = { link = 'bar' }\n[[link]]\nname = 'bar'\n\
//! # drive = '1'\nattach = 'base'\nlength = 0.4\nmass = 2.0\ninertia = 0.05\ncom = 0.2";
//! # let machine = parse(text, "bar.toml")?;
//! let asked = CounterweightSpec::least(Objective::mass(), Sites::anywhere(&machine), Disc::STEEL);
//! let placed = place_weights(&machine, &asked)?;
//! assert!((placed.added_mass - 1.0).abs() < 1e-6 && Inertia::of(&placed.machine).is_force_balanced());
//! assert!(placed.is_certified() && placed.gap < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! The [`signals`](simulation::signals::signals) of a run are a table: a column for each, with name and unit, and a row
//! for each step. Case 1 of the paper moves along a straight line, from rest to rest. A moment reaches the base, and its
//! impulse is zero in the end:
//! ```
//! # use stillbase::session::{replay, scenario::Scenario};
//! # use stillbase::simulation::signals::signals;
//! let case_1 = Scenario::builtin("case-1").expect("built in");
//! let columns = signals(&case_1.machine);
//! let mut rows: Vec<Vec<f64>> = Vec::new();
//! replay(&case_1, |_run, frame| rows.push(columns.iter().map(|column| column.value(frame)).collect()))?;
//! let moment = columns.iter().position(|column| column.path == "moment/total").expect("a row of the table");
//! assert_eq!((columns[moment].unit, rows.len()), ("N m", 1001));
//! let impulse: f64 = rows.iter().map(|row| row[moment] * case_1.step).sum();
//! let peak = rows.iter().map(|row| row[moment].abs()).fold(0.0, f64::max);
//! assert!((peak - 1.089).abs() < 1e-3 && impulse.abs() < 1e-5);
//! # Ok::<(), stillbase::session::Refusal>(())
//! ```
//! A [`Run`](session::Run) has planned its task, or is refused; the refusal names the way out. Point B is reached on the
//! planes from b = 2.216 rad to b = 2.661 rad:
//! ```
//! # use stillbase::mechanics::machine::Inertia;
//! # use stillbase::session::{Run, scenario::Scenario};
//! let mut case_3 = Scenario::builtin("case-3").expect("built in");
//! let run = Run::new(&case_3)?;
//! let halfway = run.plan().motion.at(0.5).q;
//! assert!((Inertia::of(&case_3.machine).lambda().dot(&halfway) - 2.4).abs() < 1e-9);
//! case_3.task.b = 2.9;
//! let refusal = Run::new(&case_3).expect_err("no pose of these planes is at B");
//! assert!(refusal.to_string().ends_with("want b from 2.2158 to 2.6610 rad"), "{refusal}");
//! case_3.task.b = refusal.feasible_b().expect("another b would do");
//! assert!((case_3.task.b - 2.66107).abs() < 1e-5 && Run::new(&case_3).is_ok());
//! # Ok::<(), stillbase::session::Refusal>(())
//! ```
//!
//! # What others may build on
//! Others depend on `stillbase` alone, by path or by git: `stillbase = { git = "…", default-features = false }`. The
//! crates under it are not published (`publish = false`): they read `assets` and `shaders` of this repository, and may
//! change in any version.
//!
//! What the documentation of `stillbase` shows is its interface, and follows semantic versioning. Until version 1.0 a
//! minor version, such as 0.2.0, may break it and says so; a patch, such as 0.1.1, does not. What is public but not shown
//! serves other crates of the workspace, and may change in any version. `app` and the subcommands are not shown at all.
//! * To compute with: [`mechanics`], [`planning`], [`simulation`] and [`session`]. They change least.
//! * To read and write: [`settings`], [`files`], [`exchange`], and `recording` with feature `record`.
//! * To report: [`study`]. Its answers gain fields, so take them as they come and do not build them. Work that takes long
//!   is a [`query::Query`]; [`query::answer_now`] does it.
//! * To draw: [`picture`], of which scenes are plain data, and feature `render` makes pictures.
//!
//! **Errors** implement [`std::error::Error`], `Send` and `Sync`. The message of one is whole: it holds that of the error
//! which caused it. `source` gives that error itself, to a program that asks for its type. Enums are not
//! `#[non_exhaustive]`: the workspace matches them across crates, and the compiler is to name each place that a new
//! variant concerns. A new variant therefore comes with a minor version.
//!
//! **Rust**: 1.95 or newer, the `rust-version` of `Cargo.toml`. It is raised with a minor version only, and the commit
//! says which feature of the language or which dependency asks for it.
//!
//! # Features
//! The core builds without any feature: no GPU, no window, no Rerun, and it reads no clock. The last column counts all
//! crates that are built then, `stillbase` and its own among them, as `cargo tree -e normal --no-default-features
//! --features …` lists them on Linux in version 0.1.0.
//!
//! | feature | what it adds | crates |
//! |---|---|---|
//! | none | machines, plans, simulations, sessions, studies, models for other programs, scenes as data | 78 |
//! | `tables` | motions from tables of numbers (CSV) | 81 |
//! | `cli` | the program and its subcommands; parquet files of a study | 122 |
//! | `render` | pictures of scenes, drawn on the GPU by wgpu | 130 |
//! | `ui` | panels, plots and figures, without a window | 162 |
//! | `window` | the window around them | 271 |
//! | `record` | recordings for the Rerun viewer | 296 |
//!
//! `window`, `record` and `cli` are on by default, 468 crates together. `tables`, `render` and `ui` come with what needs
//! them.
//!
//! # How the interface is watched
//! `cargo semver-checks` (`cargo install cargo-semver-checks --locked`) compares the interface with that of an earlier
//! commit, and names what broke. It does not look behind a re-export, nor at crates that are not published, unless each
//! is named:
//! ```sh
//! cargo semver-checks --baseline-rev COMMIT -p stillbase-settings -p stillbase-query -p stillbase-mechanics \
//!     -p stillbase-exchange -p stillbase-planning -p stillbase-simulation -p stillbase-session -p stillbase-study \
//!     -p stillbase-picture -p stillbase-files -p stillbase-recording
//! ```
//! It passes over what is not shown. Where it names a break, the version of `[workspace.package]` becomes the next minor
//! one.
//!
//! # What flows
//! ```text
//! assets/*.toml ─→ Machine ─→ Inertia (g, C, J) ─┐
//! slider · drag · key · script ─→ Edit ─→ Session ┴─→ Motion ─→ Simulation ─→ Frame
//! Frame ─→ signals ─→ plots │ Rerun scalars │ CSV
//! signals ─→ charts ─→ plots │ layout and series of a recording
//! Frame + Machine ─→ Stage ─→ Scene ─→ render ─→ window │ picture      Scene ─→ Rerun entities
//! pointer ─→ camera ray ─→ Handle ─→ Edit
//! ```
//!
//! # Source map
//! The folders of `src/` from the bottom up. Each but the guide is a crate, `stillbase-…`, and uses those before it only:
//! what its `Cargo.toml` does not name it cannot reach, and a test holds the order.
//!
//! | folder | what stands there |
//! |---|---|
//! | [`guide`] | how the program is used, page by page; no code |
//! | [`settings`] | how a value is named, bounded and shown: keys, changes by key, ranges, text from outside |
//! | [`query`] | what is derived: made when its input changes, kept until then, worked on beside the window |
//! | `convex` | convex programs, and how far from the best an answer may be |
//! | [`mechanics`] | what a machine is: planar algebra, links and drives, kinematics, dynamics, pin forces, balance |
//! | [`exchange`] | machines for other programs and for who builds them: models, drawings, lists of parts; and from them |
//! | [`planning`] | where it may go, and when: reactionless planes and workspaces, curves, timing, ways off the plane |
//! | [`simulation`] | what then happens: plant, control, the step, frames, the audit, signals |
//! | [`session`] | what a person did: scenarios, edits, runs, undo, replay, the verdict |
//! | [`study`] | many runs side by side and around a nominal machine; what plans, designs, imports and measurements say |
//! | [`picture`] | scenes as plain data, the table of charts, and what paints them (features `render`, `ui`) |
//! | [`files`] | files that appear whole or not at all; tables of numbers from others; shards of a study |
//! | `recording` | the same picture for Rerun (feature `record`) |
//! | `app` | the window (features `ui`, `window`) |
//! | `commands` | the program's subcommands, one file each |
//!
//! # Where to add something
//! * **A signal**: a field of `simulation/frame.rs` if it is new, filled in `simulation/simulator/simulation.rs`, and a row
//!   of the table in `simulation/signals.rs`. Recordings and CSV have it then; a chart of its own is a row of
//!   `picture/charts.rs`. Name it in the table of `guide/command_line.md`.
//! * **A setting**: a row in the struct of the part that it sets, which `keyed!` declares (`settings/keyed.rs`):
//!   `simulation/control.rs`, `simulation/plant/`, `session/scenario/task.rs`, of a design `session/scenario/design.rs`, of
//!   a scenario itself `session/scenario/own.rs`. The row is the field, with type, default, range, meaning, when it has an
//!   effect, and what frames depend on it. Of a machine the field stands in `mechanics/machine/spec.rs`, its row in
//!   `mechanics/machine/keys.rs`. Where the machine decides whether a key has an effect,
//!   `Scenario::condition_for_effect` says so; a key with `*` wants its names in `Scenario::settings`. Files, `--set`, edits, *All settings* in the window and
//!   `stillbase keys` follow; `stillbase keys --markdown` writes the page of the guide. A row in a panel of the window
//!   stands in `app/side/`, of the design view in `app/studio/`.
//! * **A choice**: a row in its enum, which `words!` declares (`settings/word.rs`), with its word in files, its words on the
//!   screen and what it means. Files, keys, the command line and the menus of the window follow, and the page of keys when
//!   it is written again.
//! * **Something to see**: an item of the scene, in `picture/scene/stage/`, drawn by `Stage::scene` (joint space and tower
//!   are scenes of their own). Window, figures and recordings show it then. What can be switched on is an option in
//!   `picture/scene/options.rs`, a field of `app/view_state.rs`, a `Switch`, and a line of `app/viewport.rs`.
//! * **What is asked of a machine's poses**: a method of [`PoseSpace`](planning::pose_space::PoseSpace), for any number of
//!   drives. If only some machines have it, it gives a `Result` with the reason in words; if three drives have a closed
//!   form, the method takes it, and a test lays it beside [`general`](planning::pose_space::PoseSpace::general).
//! * **A kind of task**: a row of `TaskKind` in `session/scenario/choices.rs`, and its function in `session/planner/`, listed
//!   in `choose.rs` there.
//! * **A time law**: a row of the enum in `planning/timing/law.rs`: its words, its formula, and where s̈ jumps or bends.
//!   All else follows; write a line of `guide/planning.md`.
//! * **An export format**: a row in `exchange/form.rs`. `export-model`, the window's dialog and all messages name its ending
//!   then; write a section of `guide/elsewhere.md`.
//! * **A subcommand**: a file in `commands/`, its `mod` and a line of the list in `commands/lib.rs`. Help and exit status
//!   follow; write a line of `guide/command_line.md`. Its help has an example, `--set` and `--json`, which a test reads. It
//!   reads arguments, asks and prints: what is computed is a query or an answer of the library (most in `study/`), which
//!   the command serialises and the window can show.
//! * **An edit**: a variant in `session/edit.rs`, with its check and its title, and what it does and what undoes it in
//!   `session/run.rs`. Look at all `matches!` on edits. Saving and replay follow; a row in `../tests/session/sitting.rs` has it
//!   drawn at random.
//! * **Something that the window can be asked for**: of the session a variant of `SessionCommand`, of how it is shown one
//!   of `ViewChange`, of what is on or off one of `Switch` (`app/command.rs`; `app/view_change.rs` says what it does). Its
//!   words and its keys are one row of `app/actions.rs`: keyboard, list of commands, card of keys and menus follow.
//! * **A panel**: a file in `app/` that shows an answer and pushes commands, called in `app/state/pass.rs`. One below the
//!   scene is a variant of `BottomPanel` (`app/layout.rs`) and of `Switch`, with its button a row of `app/rail.rs`, its
//!   icon in `app/icon.rs`, its words and its key a row of `app/actions.rs`.
//! * **Work beside the window**: a row of `app/activity.rs` with its words. A query is asked for in a `refresh_…` that
//!   `AppState::refresh` calls, and stopped there once it is out of sight. If it derives something it is a query and a row
//!   of `REPORTED_QUERIES` in `app/background.rs`; if it changes what is on display, `Background::run` takes it with what is done then.
//! * **A query**: a type that implements [`query::QuickQuery`], or [`query::Query`] if it takes longer than a few milliseconds,
//!   or [`query::IncrementalQuery`] if it takes up what is new in a run, beside what it is about. Whoever shows it asks
//!   [`query::Queries`] for it; nothing else keeps what is derived, and a test holds that.
//! * **An error**: a variant of the nearest error type that says what is wrong, where, and what would be right. A new type
//!   is a row in `../tests/layers/errors.rs`; a field that holds another error is marked `#[source]`.
//! * **A crate**: a folder with a `Cargo.toml` and a `lib.rs`, a row of `members` and one of `[workspace.dependencies]` in
//!   `../Cargo.toml`, a row of the map above, and a line at the end of `lib.rs` if others may use it.
//! * **A dependency**: its version and features in `[workspace.dependencies]`, and its name in the `Cargo.toml` of the crate
//!   that uses it. What the core may be built on is a list in `../tests/layers/mod.rs`.
//! * **What others may use**: a public item is shown and kept stable. One that serves other crates of the workspace only
//!   is `#[doc(hidden)]`, or its module is.
//! * **What a command prints** is kept in `../tests/net/answers.json`: `STILLBASE_NET=keep` writes it anew. `../.ci/run` is what
//!   has to pass.
//! * **A long test** takes more than three seconds: it is `#[ignore]`d, with the reason, and a short one beside it runs
//!   always. `../.ci/run` names those that end within seconds; `STILLBASE_LONG=1 ../.ci/run` runs all of them, and
//!   `cargo test --test suite -- --ignored NAME` one.
//! * **A reference from outside**: a script of `../tests/outside/` and what asks it, a row of `../tests/outside.rs`.
//!   `STILLBASE_OUTSIDE_SEED`, `_WEIGHTS`, `_DRAGS` and `_POSTURES` ask for other cases, and more of them.
//! * **A page of the guide**: a file in `guide/`, its name in `guide/mod.rs`, and a line of `guide/README.md`. Its
//!   commands are run as tests.
#[cfg(feature = "ui")]
#[doc(hidden)]
pub use stillbase_app as app;
#[doc(inline)]
pub use stillbase_exchange as exchange;
#[doc(inline)]
pub use stillbase_files as files;
#[doc(inline)]
pub use stillbase_mechanics as mechanics;
#[doc(inline)]
pub use stillbase_picture as picture;
#[doc(inline)]
pub use stillbase_planning as planning;
#[doc(inline)]
pub use stillbase_query as query;
#[cfg(feature = "record")]
#[doc(inline)]
pub use stillbase_recording as recording;
#[doc(inline)]
pub use stillbase_session as session;
#[doc(inline)]
pub use stillbase_settings as settings;
#[doc(inline)]
pub use stillbase_simulation as simulation;
#[doc(inline)]
pub use stillbase_study as study;

pub mod guide;
