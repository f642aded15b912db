//! `words!`: an enum whose variants are chosen by words, declared together with the words in one place.

/// Words of a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChoiceWords {
    /// Word in files, in edits and on the command line.
    pub file: &'static str,
    /// Words on the screen.
    pub screen: &'static str,
    /// Meaning, without a full stop.
    pub meaning: &'static str,
}

/// An enum whose variants are chosen by words.
pub trait Choice: Copy + PartialEq + Send + Sync + 'static {
    /// All variants.
    const ALL: &'static [Self];
    /// Words of the variants in files, in the same order.
    const FILE: &'static [&'static str];

    /// Returns the words of this variant.
    fn words(self) -> ChoiceWords;

    /// Returns the variant that a word in files denotes.
    fn of_word(word: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|choice| choice.words().file == word)
    }
}

/// Declares an enum whose variants are chosen by words. A row of it has the form
///
/// ```text
/// Variant = "word-in-files", "Words on the screen", "What it means";
/// ```
///
/// Further documentation may precede a row. Files, the choices of a key, those of the command line and the menus of the
/// window use the words. If each variant has further data, their type follows the enum's name, and the data follow the
/// words: `Variant = …, …, … => data;`. The method `data` returns them.
#[macro_export]
#[doc(hidden)]
macro_rules! words {
    (
        $(#[$outer:meta])*
        pub enum $name:ident {
            $(
                $(#[$inner:meta])*
                $variant:ident = $file:literal, $screen:literal, $meaning:literal;
            )+
        }
    ) => {
        $(#[$outer])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            $(
                #[doc = concat!($meaning, ".")]
                $(#[$inner])*
                #[serde(rename = $file)]
                $variant,
            )+
        }

        impl $crate::word::Choice for $name {
            const ALL: &'static [Self] = &[$(Self::$variant),+];
            const FILE: &'static [&'static str] = &[$($file),+];

            fn words(self) -> $crate::word::ChoiceWords {
                match self {
                    $(Self::$variant => $crate::word::ChoiceWords {
                        file: $file,
                        screen: $screen,
                        meaning: $meaning,
                    },)+
                }
            }
        }

        impl $crate::keyed::HasKeyType for $name {
            const HOLDS: $crate::key::KeyType =
                $crate::key::KeyType::Choice(<Self as $crate::word::Choice>::FILE);
        }

        impl $crate::keyed::DefaultFromText for $name {
            fn typed(default: &str) -> Self {
                use $crate::word::Choice;
                Self::of_word(default).unwrap_or(Self::ALL[0])
            }
        }
    };
    (
        $(#[$outer:meta])*
        pub enum $name:ident: $data:ty {
            $(
                $(#[$inner:meta])*
                $variant:ident = $file:literal, $screen:literal, $meaning:literal => $of:expr;
            )+
        }
    ) => {
        $crate::word::words! {
            $(#[$outer])*
            pub enum $name {
                $(
                    $(#[$inner])*
                    $variant = $file, $screen, $meaning;
                )+
            }
        }

        impl $name {
            /// Returns the data of this variant's row.
            #[inline]
            const fn data(self) -> &'static $data {
                match self {
                    $(Self::$variant => const { &$of },)+
                }
            }
        }
    };
}

pub use words;
