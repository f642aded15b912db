//! What pages are made of: escaped text, pictures as text.

use stillbase::picture::report::markup::{base64, escaped};

/// The vectors of RFC 4648, and all bytes.
#[test]
fn bytes_are_written_in_base64() {
    let vectors = ["", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"];
    for (length, wanted) in vectors.into_iter().enumerate() {
        assert_eq!(base64(&b"foobar"[..length]), wanted);
    }
    assert_eq!(base64(&[0xff, 0xef, 0xfe, 0, 0x10]), "/+/+ABA=");
}

#[test]
fn text_stays_text() {
    assert_eq!(escaped("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;");
    assert_eq!(escaped("τ₁, n_B in N m"), "τ₁, n_B in N m");
    // What no XML may hold, and what turns the writing, is spelled out: the page is well-formed whatever a name holds.
    for bad in ["\0", "\u{1b}[31m", "\u{202e}", "\u{fffe}", "\u{ffff}", "\u{85}", "]]>", "<!--", "&#0;"] {
        let page = format!("<p title=\"{0}\">{0}</p>", escaped(bad));
        let tree = roxmltree::Document::parse(&page).unwrap_or_else(|why| panic!("{bad:?}: {why}"));
        assert_eq!(tree.root_element().children().filter(|node| node.is_element()).count(), 0);
    }
}
