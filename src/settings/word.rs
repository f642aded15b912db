//! `words!`: an enum whose variants are chosen by words, declared together with them: each stands once.

/// What a choice is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    /// In files, edits and on the command line.
    pub file: &'static str,
    /// On the screen.
    pub screen: &'static str,
    /// What it means, without a full stop.
    pub meaning: &'static str,
}

/// One of several, chosen by a word.
pub trait Choice: Copy + PartialEq + Send + Sync + 'static {
    /// All of them.
    const ALL: &'static [Self];
    /// Their words in files, in the same order.
    const FILE: &'static [&'static str];

    /// What it is called.
    fn words(self) -> Words;

    /// The one of a word in files.
    fn of_word(word: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|choice| choice.words().file == word)
    }
}

/// Declares an enum whose variants are chosen by words. A row of it is
///
/// ```text
/// Variant = "word-in-files", "Words on the screen", "What it means";
/// ```
///
/// with further documentation above it, if there is any. Files, the choices of a key, those of the command line and the
/// menus of the window follow. Where each variant has further data, the type of these stands behind the enum's name, and
/// they behind the words: `Variant = …, …, … => data;`. They are what `data` gives.
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

        impl $crate::settings::word::Choice for $name {
            const ALL: &'static [Self] = &[$(Self::$variant),+];
            const FILE: &'static [&'static str] = &[$($file),+];

            fn words(self) -> $crate::settings::word::Words {
                match self {
                    $(Self::$variant => $crate::settings::word::Words {
                        file: $file,
                        screen: $screen,
                        meaning: $meaning,
                    },)+
                }
            }
        }

        impl $crate::settings::keyed::Holding for $name {
            const HOLDS: $crate::settings::key::Holds =
                $crate::settings::key::Holds::Choice(<Self as $crate::settings::word::Choice>::FILE);
        }

        impl $crate::settings::keyed::Held for $name {
            fn typed(default: &str) -> Self {
                use $crate::settings::word::Choice;
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
        $crate::settings::word::words! {
            $(#[$outer])*
            pub enum $name {
                $(
                    $(#[$inner])*
                    $variant = $file, $screen, $meaning;
                )+
            }
        }

        impl $name {
            /// What its row says of it beside its words.
            #[inline]
            const fn data(self) -> &'static $data {
                match self {
                    $(Self::$variant => const { &$of },)+
                }
            }
        }
    };
}

pub(crate) use words;
