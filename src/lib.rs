//! Zero reaction manipulators, after Papadopoulos & Abu-Abed, *On the Design of Zero Reaction Manipulators*. Design
//! robot arms, plan and simulate their motions, and see and record the reactions on their bases.
//!
//! An arm exerts no force on its base if it is balanced, so that its centre of mass never moves. It exerts no moment
//! either if its mass matrix is constant and its motion stays on a plane q₁ + λ₂ q₂ + λ₃ q₃ = b of joint space. Each
//! *pose constant* b has a *reactionless workspace*; changing b only turns this workspace.
//!
//! The [`guide`] describes how to use the program, its window and its commands.
//!
//! # A tour
//! A [`Machine`](mechanics::machine::Machine) is a checked specification. Its [`Inertia`](mechanics::machine::Inertia)
//! reduces it to a few constants, which show whether it is balanced:
//! ```
//! use stillbase::mechanics::machine::{self, Inertia};
//! let machine = machine::builtin("nine-link").expect("built in");
//! let inertia = Inertia::of(machine);
//! assert!(inertia.is_force_balanced() && inertia.is_invariant());
//! ```
//! [`design`](mechanics::balance::design) finds centres of mass with which a machine is balanced, Eqs (7)–(10):
//! ```
//! # use stillbase::mechanics::balance::{design, Preset};
//! # use stillbase::mechanics::machine;
//! let rounded = machine::builtin("nine-link-table-1").expect("built in");
//! let exact = design(rounded, &Preset::Table1.penalty(9)?)?;
//! assert!((exact.links()[0].com - -0.2214384).abs() < 1e-7);
//! # Ok::<(), stillbase::mechanics::balance::DesignError>(())
//! ```
//! The pose space of a machine is a [`PoseSpace`](planning::pose_space::PoseSpace), for any number of drives. It
//! returns the intervals of b that reach a point, and the outline of the workspace of a given b:
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
//! Some of its methods apply only to some machines; on others, they return an error with the reason. On planes, a curve
//! of the end effector is followed exactly. If that is impossible, the error says where and why, and names a feasible
//! b:
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
//! A [`Scenario`](session::scenario::Scenario) describes a task. A [`Run`](session::Run) simulates it step by step; a
//! [`Frame`](simulation::frame::Frame) holds all results at one instant:
//! ```
//! # use stillbase::session::scenario::Scenario;
//! # use stillbase::session::replay;
//! let case_3 = Scenario::builtin("case-3").expect("built in");
//! let run = replay(&case_3, |_run, frame| assert!(frame.base_moment().abs() < 1e-9))?;
//! assert!(run.frame().peaks.is_reactionless());
//! # Ok::<(), stillbase::session::Refusal>(())
//! ```
//! A [`Session`](session::Session) is a run that a user changes while it is in progress. Every change is an
//! [`Edit`](session::Edit), so a session can be saved, undone, and replayed to identical frames. Bookmarks,
//! notes and abandoned branches are stored with the edits; they are saved and undone together.
//!
//! # From a program of your own
//! [`files::machine`] reads a machine from a TOML file; `parse` reads one from text. An error names the line, the key
//! and the allowed values:
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
//! assert_eq!(
//!     error.to_string(),
//!     "bar.toml:10: mass of link bar (link.bar.mass) is -2: want 1e-15 to 1000000 kg"
//! );
//! # Ok::<(), stillbase::mechanics::machine::FileError>(())
//! ```
//! [`place_weights`](mechanics::counterweights::place_weights) finds counterweights and proves that they are optimal:
//! the duality gap bounds the distance of their objective from the optimum. Here m l_c = 2 kg · 0.2 m, so a
//! counterweight of 1 kg balances the bar from 0.4 m behind the pin:
//! ```
//! # use stillbase::mechanics::machine::{Inertia, parse};
//! use stillbase::mechanics::counterweights::{CounterweightSpec, CounterweightStock, Objective, CounterweightSite, place_weights};
//! # let text = "name = 'bar'\ndrive = [{ name = '1' }]\nend_effector = { link = 'bar' }\n[[link]]\nname = 'bar'\n\
//! # drive = '1'\nattach = 'base'\nlength = 0.4\nmass = 2.0\ninertia = 0.05\ncom = 0.2";
//! # let machine = parse(text, "bar.toml")?;
//! let spec = CounterweightSpec::least(Objective::mass(), CounterweightSite::anywhere(&machine), CounterweightStock::STEEL);
//! let placed = place_weights(&machine, &spec)?;
//! assert!((placed.added_mass - 1.0).abs() < 1e-6 && Inertia::of(&placed.machine).is_force_balanced());
//! assert!(placed.is_certified() && placed.gap < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//! The [`signals`](simulation::signals::signals) of a run form a table. It has a column for each signal, with name and
//! unit, and a row for each step. In case 1 of the paper, the end effector moves along a straight line, from rest to
//! rest. A moment reaches the base, but its total impulse is zero:
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
//! [`Run::new`](session::Run::new) plans the task. If that is impossible, it returns a refusal that names feasible
//! values. Here the point B of the task can be reached from b = 2.216 rad to b = 2.661 rad:
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
//! # Use as a dependency
//! Programs depend on `stillbase` alone, by path or git: `stillbase = { git = "…", default-features = false }`. The
//! crates below it are not published (`publish = false`): they read `assets` and `shaders` of this repository, and may
//! change in any version.
//!
//! The interface consists of the items that this documentation shows, and follows semantic versioning. Until version
//! 1.0, a minor version, such as 0.2.0, may break the interface and says so; a patch, such as 0.1.1, does not. Hidden
//! public items serve other crates of the workspace, and may change in any version. `app` and the subcommands are
//! hidden entirely.
//! * For computing: [`mechanics`], [`planning`], [`simulation`] and [`session`]. These crates change least.
//! * For reading and writing: [`settings`], [`files`], [`exchange`], and `recording` with feature `record`.
//! * For reports: [`study`]. Its result types gain fields, so programs should read but not construct them. A long
//!   computation is a [`query::Query`], which [`query::answer_now`] runs.
//! * For drawing: [`picture`]. Its scenes are plain data; feature `render` draws pictures of them.
//!
//! **Errors** implement [`std::error::Error`], `Send` and `Sync`. The message of an error includes the message of its
//! cause. `source` returns the cause itself, so that a program can examine its type. Enums are not `#[non_exhaustive]`:
//! crates of the workspace match them, and the compiler must find each match that a new variant affects. A new variant
//! therefore requires a minor version.
//!
//! **Rust**: 1.95 or newer, the `rust-version` of `Cargo.toml`. It is raised with a minor version only, and the commit
//! names the language feature or the dependency that requires it.
//!
//! # Features
//! The core builds without any feature: it needs no GPU, no window and no Rerun, and reads no clock. The last column
//! counts all crates that are then built, including those of Stillbase. `cargo tree -e normal --no-default-features
//! --features …` lists them; the numbers are those on Linux in version 0.2.0.
//!
//! | feature | what it adds | crates |
//! |---|---|---|
//! | none | machines, plans, simulations, sessions, studies, models for other programs, scenes as data | 77 |
//! | `tables` | motions from tables of numbers (CSV) | 80 |
//! | `cli` | the program and its subcommands; tables as Parquet | 122 |
//! | `render` | pictures of scenes, drawn on the GPU by wgpu; films | 135 |
//! | `ui` | panels, plots and figures for print, without a window | 183 |
//! | `window` | the window around them | 290 |
//! | `record` | recordings for the Rerun viewer | 314 |
//!
//! `window`, `record` and `cli` are enabled by default, 493 crates together. `tables`, `render` and `ui` are enabled by
//! the features that need them.
//!
//! # Checking the interface
//! `cargo semver-checks` (`cargo install cargo-semver-checks --locked`) compares the interface with that of an earlier
//! commit, and lists breaking changes. It checks re-exported and unpublished crates only if each is named:
//! ```sh
//! cargo semver-checks --baseline-rev COMMIT -p stillbase-settings -p stillbase-query -p stillbase-mechanics \
//!     -p stillbase-exchange -p stillbase-planning -p stillbase-simulation -p stillbase-session -p stillbase-study \
//!     -p stillbase-picture -p stillbase-files -p stillbase-recording
//! ```
//! It ignores hidden items. If it lists a breaking change, the version of `[workspace.package]` becomes the next minor
//! version.
//!
//! # Data flow
//! ```text
//! assets/*.toml ─→ Machine ─→ Inertia (g, C, J) ─┐
//! slider · drag · key · script ─→ Edit ─→ Session ┴─→ Motion ─→ Simulation ─→ Frame
//! Frame ─→ signals ─→ plots │ Rerun scalars │ CSV, Parquet
//! signals ─→ charts ─→ plots │ layout and series of a recording
//! Frame + Machine ─→ Stage ─→ Scene ─→ render ─→ window │ picture      Scene ─→ Rerun entities
//! pointer ─→ camera ray ─→ Handle ─→ Edit
//! ```
//!
//! # Source map
//! The table lists the folders of `src/` from the bottom up. Each except the guide is a crate, `stillbase-…`, which
//! uses only crates listed before it. Its `Cargo.toml` names the crates that it uses, and a test checks the order.
//!
//! | folder | content |
//! |---|---|
//! | [`guide`] | how to use the program, page by page; no code |
//! | [`settings`] | names, bounds and display of values: keys, changes by key, ranges, text from outside |
//! | [`query`] | derived data: computed when its input changes, cached until then; background work |
//! | `convex` | convex programs, with bounds of the distance to the optimum |
//! | [`mechanics`] | machines: planar algebra, links and drives, kinematics, dynamics, pin forces, balance |
//! | [`exchange`] | export for other programs and workshops: models, drawings, lists of parts; import of machines |
//! | [`planning`] | motions: reactionless planes and workspaces, curves, timing, motions off the planes |
//! | [`simulation`] | simulation of motions: plant, control, time steps, frames, audit, signals |
//! | [`session`] | work of a user: scenarios, edits, runs, undo, replay, verdict |
//! | [`study`] | comparisons of runs, tolerance studies; reports on plans, designs, imports and measurements |
//! | [`picture`] | scenes as plain data, the table of charts, and the code that draws both (features `render`, `ui`) |
//! | [`files`] | atomic writing of files; tables of numbers from other programs; shards of a study |
//! | `recording` | recordings for the Rerun viewer (feature `record`) |
//! | `app` | the window (features `ui`, `window`) |
//! | `commands` | the program's subcommands, one file each |
//! | `python` | the package for Python: dynamics of whole arrays, and every answer of the command line; a plain build leaves it out |
//!
//! # Where to add something
//! * **A signal**: a row of the table in `simulation/signals.rs`. A new quantity also needs a field in
//!   `simulation/frame.rs`, which `simulation/simulator/simulation.rs` fills. Recordings and CSV then contain the
//!   signal; a chart for it is a row of `picture/charts.rs`. Name it in the table of `guide/command_line.md`.
//! * **A setting**: a row in a struct that `keyed!` declares (`settings/keyed.rs`). These structs are in
//!   `simulation/control.rs`, `simulation/plant/`, `session/scenario/task.rs`, for a design
//!   `session/scenario/design.rs`, and for a scenario itself `session/scenario/own.rs`. The row is the field, with its
//!   type, default, range, meaning, the condition for its effect, and the results that it affects. For a setting of a
//!   machine, the field is in `mechanics/machine/spec.rs`, and its row in `mechanics/machine/keys.rs`. If the effect of
//!   a key depends on the machine, add its condition to `Scenario::condition_for_effect`. If a key contains `*`, add
//!   its names to `Scenario::settings`. Files, `--set`, edits, *All settings* in the window and `stillbase keys` then
//!   know the setting; `stillbase keys --markdown` writes the page of the guide. Rows in panels of the window are in
//!   `app/side/`, those of the design view in `app/studio/`.
//! * **A choice**: a row in its enum, which `words!` declares (`settings/word.rs`), with its word in files, its words
//!   on the screen and its meaning. Files, keys, the command line and the menus of the window then include it. Write
//!   the page of keys again.
//! * **An item of the scene**: a function in `picture/scene/stage/`, called by `Stage::scene` (joint space and tower
//!   are separate scenes). The window, figures and recordings then show the item. If it can be switched off, it needs
//!   an option in `picture/scene/options.rs`, a field in `app/view_state.rs`, a `Switch`, and a line in
//!   `app/viewport.rs`.
//! * **A question about the poses of a machine**: a method of [`PoseSpace`](planning::pose_space::PoseSpace), for any
//!   number of drives. If it applies only to some machines, it returns a `Result` with the reason in words. If three
//!   drives have a closed form, the method uses it, and a test compares it with
//!   [`general`](planning::pose_space::PoseSpace::general).
//! * **A kind of task**: a row of `TaskKind` in `session/scenario/choices.rs`, and its function in `session/planner/`,
//!   listed in the file `choose.rs` of that folder.
//! * **A time law**: a row of the enum in `planning/timing/law.rs`: its words, its formula, and the times at which s̈
//!   or its derivative jumps. Nothing else needs a change; add a line to `guide/planning.md`.
//! * **An export format**: a row in `exchange/form.rs`. `export-model`, the window's dialog and all messages then name
//!   its file extension; add a section to `guide/elsewhere.md`.
//! * **A subcommand**: a file in `commands/`, its `mod` and a line of the list in `commands/lib.rs`. Help and exit
//!   status need no further code; add a line to `guide/command_line.md`. Its help has an example, `--set` and `--json`,
//!   which a test checks. The command only reads arguments, calls the library (mostly `study/`) and prints. The library
//!   returns the answer as data, which the command serialises and the window can show.
//! * **An edit**: a variant in `session/edit.rs`, with its check and its title; its effect and its inverse are in
//!   `session/run.rs`. Review all `matches!` on edits. Saving and replay need no further code; a row in
//!   `../tests/session/sitting.rs` includes the edit in random tests.
//! * **A command of the window**: a variant in `app/command.rs`. Changes of the session are a `SessionCommand`, changes
//!   of the view a `ViewChange` (`app/view_change.rs` applies it), and things that are on or off a `Switch`. Its words
//!   and its keys are one row of `app/actions.rs`, which the keyboard, the list of commands, the card of keys and the
//!   menus use.
//! * **A result that becomes a file**: a variant of `Export` (`app/export/`) with its choices on the card and its
//!   function that writes it, which the command line calls too; `app/state/exporting.rs` runs it beside the window.
//! * **A panel**: a file in `app/` that shows an answer and pushes commands, called in `app/state/pass.rs`. A panel
//!   below the scene is also a variant of `BottomPanel` (`app/layout.rs`) and of `Switch`. Its button is a row of
//!   `app/rail.rs`, its icon is in `app/icon.rs`, and its words and its key are a row of `app/actions.rs`.
//! * **Background work**: a row of `app/activity.rs` with its words. Work that derives data is a query and a row of
//!   `REPORTED_QUERIES` in `app/background.rs`. `AppState::refresh` calls a function `refresh_…`, which requests the
//!   query while its result is visible and stops it otherwise. Work that changes the display is passed to
//!   `Background::run`, with a function that receives its result.
//! * **A query**: a type that implements [`query::QuickQuery`], or [`query::Query`] if it takes longer than a few
//!   milliseconds, or [`query::IncrementalQuery`] if its answer grows with a run. Code that shows the answer requests
//!   it from [`query::Queries`]. This is the only cache of derived data, which a test checks.
//! * **An error**: a variant of the nearest error type that says what is wrong, where, and which values are allowed. A
//!   new type needs a row in `../tests/layers/errors.rs`; a field that holds another error is marked `#[source]`.
//! * **A crate**: a folder with a `Cargo.toml` and a `lib.rs`, a row of `members` and one of `[workspace.dependencies]`
//!   in `../Cargo.toml`, and a row of the map above. A crate that other programs may use also needs a line at the end
//!   of `lib.rs`.
//! * **A dependency**: its version and features in `[workspace.dependencies]`, and its name in the `Cargo.toml` of the
//!   crate that uses it. The dependencies that the core may have are listed in `../tests/layers/mod.rs`.
//! * **A public item** appears in the documentation and is kept stable. If an item serves only other crates of the
//!   workspace, the item or its module is `#[doc(hidden)]`.
//! * **The output of a command** is stored in `../tests/net/answers.json`; `STILLBASE_NET=keep` writes this file again.
//!   All checks that must pass are in `../.ci/run`.
//! * **A long test** takes more than three seconds: it is `#[ignore]`d, with the reason, and a shorter variant always
//!   runs. `../.ci/run` runs those long tests that end within seconds each; `STILLBASE_LONG=1 ../.ci/run` runs all, and
//!   `cargo test --test suite -- --ignored NAME` runs one.
//! * **A comparison with another program**: a script in `../tests/outside/`, and a row of `../tests/outside.rs` for the
//!   test that calls it. `STILLBASE_OUTSIDE_SEED`, `_MODELS`, `_WEIGHTS`, `_DRAGS` and `_POSTURES` select other
//!   cases, and more of them.
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
