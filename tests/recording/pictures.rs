//! Offscreen pictures: when they are taken, and what is said where there are none.

use super::*;

#[cfg(feature = "render")]
#[test]
fn pictures_come_at_their_times_or_it_is_said_why_not() {
    let folder = Folder::new("pictures");
    let options = Options {
        pictures: Some(Pictures { fps: 30.0, width: 64, height: 40, pin_forces: false }),
        ..Options::default()
    };
    let recordings = record(&[short("case-3")], &folder.path("x.rrd"), &options, &mut quietly).expect("a case");
    let contents = Contents::of(&folder.path("x.rrd"));
    let chunks = contents.at("/case-3/view");
    if stillbase::picture::render::offscreen::Gpu::new().is_err() {
        assert!(chunks.is_empty() && recordings[0].notes[0].starts_with("recorded without pictures"));
        return;
    }
    assert!(recordings[0].notes.is_empty());
    let steps: Vec<i64> =
        chunks.iter().flat_map(|c| c.timelines()[&TimelineName::from("step")].times_raw().to_vec()).collect();
    assert_eq!(steps, [0, 33, 67, 100]);
    assert_eq!(contents.texts("/case-3/view", "EncodedImage:media_type"), vec!["image/png"; 4]);
    let huge = Options {
        pictures: Some(Pictures { fps: 30.0, width: u32::MAX, height: 1, pin_forces: false }),
        ..Options::default()
    };
    let refused = record(&[short("case-3")], &folder.path("y.rrd"), &huge, &mut quietly);
    assert!(matches!(refused, Err(RecordError::Pictures(_))));
    assert_eq!(folder.names(), ["x.rrd"]);
}
