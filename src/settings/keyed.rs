//! `keyed!`: a struct whose fields are settings, declared together with their [keys](super::key::Key) in one place.

use std::collections::BTreeMap;

use super::key::KeyType;
use super::range::Range;

/// A type that the field of a key may have.
pub trait HasKeyType {
    /// Type of the value of the key. If the value contains numbers, the row of the key states their range.
    const HOLDS: KeyType;
}

/// A type whose default can be given as text.
pub trait DefaultFromText: HasKeyType {
    /// Returns the value that the text of a default states; zero, `false` or the first choice if the text states none.
    fn typed(default: &str) -> Self;
}

/// Range of the numbers of a row that states no range.
pub const ANY_NUMBER: Range = Range::either_way(f64::MAX, "");

/// Implements [`HasKeyType`] for types. The range is a placeholder for that of a key's row.
macro_rules! holds {
    ($($type:ty: $holds:expr;)+) => {
        $(impl HasKeyType for $type {
            const HOLDS: KeyType = $holds;
        })+
    };
}

holds! {
    f64: KeyType::Number(ANY_NUMBER);
    u32: KeyType::Whole(ANY_NUMBER);
    bool: KeyType::Switch;
    String: KeyType::Names(1);
}

impl<const N: usize> HasKeyType for Vec<[f64; N]> {
    const HOLDS: KeyType = KeyType::Points(N, ANY_NUMBER);
}

impl<const N: usize> HasKeyType for [f64; N] {
    const HOLDS: KeyType = KeyType::List(N, ANY_NUMBER);
}

impl<T: HasKeyType> HasKeyType for Option<T> {
    const HOLDS: KeyType = T::HOLDS;
}

/// A value under each of several names.
impl<T: HasKeyType> HasKeyType for BTreeMap<String, T> {
    const HOLDS: KeyType = T::HOLDS;
}

impl DefaultFromText for f64 {
    fn typed(default: &str) -> Self {
        default.parse().unwrap_or_default()
    }
}

impl DefaultFromText for u32 {
    fn typed(default: &str) -> Self {
        default.parse().unwrap_or_default()
    }
}

impl DefaultFromText for bool {
    fn typed(default: &str) -> Self {
        default == "true"
    }
}

impl<const N: usize> DefaultFromText for [f64; N] {
    fn typed(default: &str) -> Self {
        let mut numbers = default.split(',').map(f64::typed);
        [(); N].map(|()| numbers.next().unwrap_or_default())
    }
}

/// `None`, the only default that such a key has.
impl<T: HasKeyType> DefaultFromText for Option<T> {
    fn typed(_: &str) -> Self {
        None
    }
}

/// An empty list, the only default that such a key has.
impl<const N: usize> DefaultFromText for Vec<[f64; N]> {
    fn typed(_: &str) -> Self {
        Self::new()
    }
}

/// Returns a doc comment without its first space; each line of it begins with a space.
pub const fn sentence(doc: &'static str) -> &'static str {
    match doc.as_bytes() {
        [b' ', ..] => doc.split_at(1).1,
        _ => doc,
    }
}

/// Declares a struct whose fields are settings. A row of it is
///
/// ```text
/// /// What the key means, in a sentence.
/// field: Type = "as typed", range: …, instead: "…", when: "…" => |part| …, usual: …, reaching: …, saved: always;
/// ```
///
/// * `range` for a type that holds numbers;
/// * `instead`: what applies if the default is no value ([`Key::NONE`](super::key::Key::NONE));
/// * `when`: the condition under which the key has an effect, in words, and a function that evaluates it if the part
///   alone suffices;
/// * `usual`: the value of a field that a file omits, if the default of its key is no value;
/// * `reaching`: what a change of the key affects, if that is not the motion;
/// * `saved: always` if a file states the key even at its default.
///
/// A struct without `at` is for keys without a common prefix.
///
/// Rows after `named:` contain a value for each of several names, which replace the `*` in the key. The default of such
/// a row applies to one value; initially there are no names. Fields after `tables:` are nested parts with separate
/// keys.
///
/// The macro generates the struct with its documentation, `KEYS`, `Default`, and reading and writing of files. A field
/// that is omitted has its default; an unknown one is an error. It also generates `uses`, which returns whether a key
/// has an effect in the present state.
#[macro_export]
#[doc(hidden)]
macro_rules! keyed {
    ($(#[$outer:meta])* pub struct $name:ident at $path:literal { $($rows:tt)* }) => {
        $crate::keyed::keyed!(@below concat!($path, "."); $(#[$outer])* pub struct $name { $($rows)* });
    };
    ($(#[$outer:meta])* pub struct $name:ident { $($rows:tt)* }) => {
        $crate::keyed::keyed!(@below ""; $(#[$outer])* pub struct $name { $($rows)* });
    };
    (
        @below $path:expr;
        $(#[$outer:meta])*
        pub struct $name:ident {
            $(
                $(#[doc = $words:literal])+
                $field:ident: $type:ty = $default:expr
                    $(, range: $range:expr)?
                    $(, instead: $instead:expr)?
                    $(, when: $when:expr $(=> $uses:expr)?)?
                    $(, usual: $usual:expr)?
                    $(, reaching: $effect:expr)?
                    $(, saved: $saved:ident)?;
            )*
            $(named:
                $(
                    $(#[doc = $said:literal])+
                    $names:ident: $each:ty = $one:expr
                        $(, range: $within:expr)?
                        $(, instead: $else:expr)?
                        $(, when: $where:expr)?;
                )+
            )?
            $(tables:
                $(
                    $(#[$inner:meta])+
                    $table:ident: $of:ty;
                )+
            )?
        }
    ) => {
        $(#[$outer])*
        #[derive(serde::Deserialize)]
        #[serde(default, deny_unknown_fields)]
        pub struct $name {
            $(
                $(#[doc = $words])+
                #[doc = concat!("\n\nSetting `", $path, stringify!($field), "`.")]
                $(#[doc = concat!("Range `", stringify!($range), "`.")])?
                pub $field: $type,
            )*
            $($(
                $(#[doc = $said])+
                #[doc = concat!("\n\nSettings `", $path, stringify!($names), ".*`.")]
                $(#[doc = concat!("Range `", stringify!($within), "`.")])?
                pub $names: $each,
            )+)?
            $($(
                $(#[$inner])+
                pub $table: $of,
            )+)?
        }

        impl $name {
            #[doc = concat!("The keys `", $path, "*`, but for those of tables in it.")]
            pub const KEYS: &'static [$crate::key::Key] = &[$(
                $crate::key::Key::new(
                    concat!($path, stringify!($field)),
                    <$type as $crate::keyed::HasKeyType>::HOLDS$(.within($range))?,
                    $default,
                    $crate::keyed::sentence(concat!($($words),+)),
                )
                $(.instead($instead))?
                $(.when($when))?
                $(.reaching($effect))?,
            )* $($(
                $crate::key::Key::new(
                    concat!($path, stringify!($names), ".*"),
                    <$each as $crate::keyed::HasKeyType>::HOLDS$(.within($within))?,
                    $one,
                    $crate::keyed::sentence(concat!($($said),+)),
                )
                $(.instead($else))?
                $(.when($where))?,
            )+)?];

            /// Returns whether a key, given without the path of the part, has an effect now, as far as the part alone
            /// determines it.
            #[allow(dead_code, reason = "many parts have no key that waits for another")]
            pub fn uses(&self, key: &str) -> bool {
                $($($(
                    if key == stringify!($field) {
                        let uses: fn(&Self) -> bool = $uses;
                        return uses(self);
                    }
                )?)?)*
                let _ = key;
                true
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self {
                    $($field: $crate::keyed::keyed!(@usual $type, $default $(, $usual)?),)*
                    $($($names: Default::default(),)+)?
                    $($($table: Default::default(),)+)?
                }
            }
        }

        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                use serde::ser::SerializeStruct;
                let usual = Self::default();
                let mut part = serializer.serialize_struct(stringify!($name), Self::KEYS.len())?;
                $(
                    let always = false $(|| stringify!($saved) == "always")?;
                    if always || self.$field != usual.$field {
                        part.serialize_field(stringify!($field), &self.$field)?;
                    }
                )*
                $($(
                    if self.$names != usual.$names {
                        part.serialize_field(stringify!($names), &self.$names)?;
                    }
                )+)?
                $($(
                    if self.$table != usual.$table {
                        part.serialize_field(stringify!($table), &self.$table)?;
                    }
                )+)?
                part.end()
            }
        }
    };
    (@usual $type:ty, $default:expr) => {
        <$type as $crate::keyed::DefaultFromText>::typed($default)
    };
    (@usual $type:ty, $default:expr, $usual:expr) => {
        $usual
    };
}

pub use keyed;
