//! Colours are told apart by everybody, and read on what lies behind them.

use stillbase::picture::scene::Rgba;
use stillbase::picture::scene::palette::{Palette, Theme, palette};

/// What the cones of eyes make of linear sRGB: all three kinds, and one kind missing (Machado, Oliveira and Fernandes,
/// 2009, severity 1).
const EYES: [[[f64; 3]; 3]; 4] = [
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
];
/// From linear sRGB to CIE XYZ, of which white is all 1.
const XYZ: [[f64; 3]; 3] = [[0.4339, 0.3763, 0.1899], [0.2126, 0.7152, 0.0722], [0.0177, 0.1095, 0.8728]];

fn times(m: [[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    m.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
}

fn linear([r, g, b, _]: Rgba) -> [f64; 3] {
    [r, g, b].map(f64::from).map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}

fn contrast(a: Rgba, b: Rgba) -> f64 {
    let [a, b] = [a, b].map(|c| times(XYZ, linear(c))[1] + 0.05);
    a.max(b) / a.min(b)
}

/// CIE L*a*b* as an eye sees it.
fn seen(colour: Rgba, eye: [[f64; 3]; 3]) -> [f64; 3] {
    let f = times(XYZ, times(eye, linear(colour)).map(|c| c.clamp(0.0, 1.0)));
    let [x, y, z] = f.map(|t| if t > 0.008856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 });
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn apart(a: Rgba, b: Rgba, eye: [[f64; 3]; 3]) -> f64 {
    let (a, b) = (seen(a, eye), seen(b, eye));
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn every_eye_tells_runs_apart_from_each_other_and_from_reactions() {
    for theme in [Theme::Dark, Theme::Light] {
        let p = palette(theme);
        for i in 0..5 {
            assert!(contrast(p.run(i), p.panel) >= 3.0, "{theme:?}: run {i} is too pale");
            for eye in EYES {
                for other in (0..i).map(|k| p.run(k)).chain([p.zero]) {
                    let apart = apart(p.run(i), other, eye);
                    assert!(apart > 10.0, "{theme:?}: run {i} is {apart:.1} from another meaning");
                }
            }
            assert!([p.reaction, p.amber, p.ink].iter().all(|other| apart(p.run(i), *other, EYES[0]) > 15.0));
        }
    }
}

#[test]
fn every_eye_tells_the_drives_apart_and_reads_their_names() {
    for theme in [Theme::Dark, Theme::Light] {
        let Palette { panel, drives, amber, reaction, ink, .. } = palette(theme);
        for (k, a) in drives.iter().enumerate() {
            assert!(contrast(*a, panel) >= 4.5, "{theme:?}: drive {} is too pale on a panel", k + 1);
            for eye in EYES {
                for (l, b) in drives.iter().enumerate().take(k) {
                    let apart = apart(*a, *b, eye);
                    assert!(apart > 10.0, "{theme:?}: drives {} and {} are {apart:.1} apart", k + 1, l + 1);
                }
            }
            for other in [amber, reaction, ink] {
                let apart = apart(*a, other, EYES[0]);
                assert!(apart > 15.0, "{theme:?}: drive {} is {apart:.1} from what has a meaning of its own", k + 1);
            }
        }
    }
}
