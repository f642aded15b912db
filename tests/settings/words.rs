//! Choices and parts: what files have of them is what their rows say.

use serde::Serialize;
use stillbase::mechanics::balance::Preset;
use stillbase::mechanics::counterweights::CounterweightStock;
use stillbase::planning::posture::Posture;
use stillbase::planning::timing::TimeLaw;
use stillbase::session::scenario::{Corners, DesignBrief, PathShape, ReactionObjective, Task, TaskKind};
use stillbase::settings::key::Key;
use stillbase::settings::word::Choice;
use stillbase::simulation::control::{Control, ControlLaw};
use stillbase::simulation::plant::{Base, BaseKind, Friction, LinkDifference, Load, PlantDifferences, Wheel};
use toml::{Table, Value};

fn words_are_those_of_files<T: Choice + std::fmt::Debug + Serialize + serde::de::DeserializeOwned>() {
    assert_eq!(T::ALL.len(), T::FILE.len());
    for (choice, word) in T::ALL.iter().zip(T::FILE) {
        assert_eq!(Value::try_from(choice).expect("a word"), Value::from(*word));
        assert_eq!(Value::from(*word).try_into::<T>().expect("a word"), *choice);
        assert_eq!((T::of_word(word), choice.words().file), (Some(*choice), *word));
        let (screen, meaning) = (choice.words().screen, choice.words().meaning);
        assert!(!screen.is_empty() && !meaning.is_empty() && !meaning.ends_with('.'), "{choice:?}");
    }
    assert_eq!(T::of_word("nonsense"), None);
}

#[test]
fn files_have_the_words_of_the_rows() {
    words_are_those_of_files::<TaskKind>();
    words_are_those_of_files::<PathShape>();
    words_are_those_of_files::<Corners>();
    words_are_those_of_files::<ReactionObjective>();
    words_are_those_of_files::<Posture>();
    words_are_those_of_files::<TimeLaw>();
    words_are_those_of_files::<ControlLaw>();
    words_are_those_of_files::<BaseKind>();
    words_are_those_of_files::<Preset>();
    // What files of earlier versions call the minimum norm.
    assert_eq!(Value::from("tip-line").try_into(), Ok(TaskKind::MinimumNorm));
}

/// A part that states nothing is written as what it always states, and reads as its defaults.
fn states_little<T: Default + PartialEq + std::fmt::Debug + Serialize + serde::de::DeserializeOwned>(
    keys: &[Key],
    always: &[&str],
) {
    let written = Table::try_from(T::default()).expect("plain data");
    assert_eq!(written.keys().map(String::as_str).collect::<Vec<_>>(), always);
    assert_eq!(Table::new().try_into::<T>().expect("all may be left out"), T::default());
    assert_eq!(written.try_into::<T>().expect("as written"), T::default());
    assert!(always.iter().all(|name| keys.iter().any(|key| key.path.ends_with(&format!(".{name}")))));
}

#[test]
fn parts_are_written_as_their_rows_say() {
    states_little::<Task>(Task::KEYS, &["b", "from", "kind", "law", "time", "to"]);
    states_little::<Control>(Control::KEYS, &["kd", "kp"]);
    states_little::<Base>(Base::KEYS, &["kind"]);
    states_little::<Wheel>(Wheel::KEYS, &["inertia"]);
    states_little::<Load>(Load::KEYS, &["mass"]);
    states_little::<Friction>(Friction::KEYS, &[]);
    states_little::<PlantDifferences>(PlantDifferences::KEYS, &[]);
    states_little::<LinkDifference>(LinkDifference::KEYS, &[]);
    states_little::<DesignBrief>(DesignBrief::KEYS, &[]);
    assert_eq!(DesignBrief::default().plate(), CounterweightStock::STEEL);
    assert_eq!(Wheel::default().inertia, 0.02);
    assert_eq!(Base::default().stiffness, [2e4, 2e4, 2e3]);
}
