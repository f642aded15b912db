//! The option `--size`.

/// Reads the width and height of a picture, pixels.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |s: &str| s.parse().ok().filter(|n| (16..=8192).contains(n));
    let both = text.split_once('x').and_then(|(w, h)| Some([side(w)?, side(h)?]));
    both.ok_or_else(|| "want WIDTHxHEIGHT in pixels, 16 to 8192, such as 1280x800".into())
}
