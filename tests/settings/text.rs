//! Text that is too long for its place.

use proptest::prelude::*;
use stillbase::settings::text::{cut_at_word, cut_path};

fn cut(text: &str, most: usize) -> String {
    cut_at_word(text, |part| part.chars().count() <= most).into_owned()
}

#[test]
fn a_text_ends_with_a_word_that_can_stand_there() {
    let title = "Turning moment on the base";
    assert_eq!(cut(title, 26), title);
    for (most, shown) in
        [(25, "Turning moment…"), (15, "Turning moment…"), (14, "Turning…"), (6, "Turni…"), (4, "Tur…")]
    {
        assert_eq!(cut(title, most), shown);
    }
    // Three letters at least, or nothing.
    assert_eq!(cut(title, 3), "");
    assert_eq!(cut("moment on the base, n_B", 20), "moment on the base…");
    assert_eq!(cut("case 3 · b of A", 13), "case…", "no single letter or sign at the end");
    assert_eq!(cut("A and B: b from 2.2", 18), "", "nothing of it can stand alone");
}

#[test]
fn a_path_keeps_its_last_folders() {
    let short = |most: usize| cut_path("/home/me/arms/old", |part| part.chars().count() <= most).into_owned();
    assert_eq!(short(17), "/home/me/arms/old");
    assert_eq!(short(16), "…/me/arms/old");
    assert_eq!(short(10), "…/arms/old");
    assert_eq!(short(6), "…/old");
    assert_eq!(short(4), "old");
}

proptest! {
    #[test]
    fn what_is_shown_fits_and_ends_well(text in "[a-zA-Zäß0-9 ,.·/_-]{0,40}", most in 0..30_usize) {
        let shown = cut(&text, most);
        if shown != text {
            prop_assert!(shown.chars().count() <= most);
            let kept = shown.strip_suffix('…').unwrap_or_default();
            prop_assert!(text.trim_start().starts_with(kept.trim_start()), "{shown:?} of {text:?}");
            let last = kept.rsplit(' ').next().unwrap_or_default();
            prop_assert!(shown.is_empty() || last.chars().count() > 1, "{shown:?} of {text:?}");
        }
    }
}
