//! Places on the monitors of the desktop.

/// Left, top, width and height of a monitor on the desktop, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MonitorArea {
    /// Left and top.
    pub at: [i32; 2],
    /// Width and height.
    pub size: [u32; 2],
}

/// Part of a window's upper edge that must be on a monitor, so that the window can be taken there, pixels.
const HANDLE_PX: [i64; 2] = [96, 32];

/// Returns a place, pixels, at which a window of this size, pixels, can be seen and taken: the place that is asked for
/// if it is one, else the nearest on the monitor that is nearest. A monitor may have gone since the place was kept.
/// Without any monitor, the place stays.
pub fn visible_place(asked: [i32; 2], size: [u32; 2], monitors: &[MonitorArea]) -> [i32; 2] {
    let (at, size) = (asked.map(i64::from), size.map(i64::from));
    // From where to where the window may begin along an axis if only its handle is on the monitor, and if all of it is.
    let bounds = |monitor: &MonitorArea, k: usize| {
        let (begin, end) = (i64::from(monitor.at[k]), i64::from(monitor.at[k]) + i64::from(monitor.size[k]));
        let handle = HANDLE_PX[k].min(size[k]);
        // The upper edge itself must be there; to the left, a window may stand out.
        let first = if k == 0 { begin + handle - size[k] } else { begin };
        ([first, end - handle], [begin, (end - size[k]).max(begin)])
    };
    let is_seen = |monitor: &MonitorArea| {
        (0..2).all(|k| {
            let ([first, last], _) = bounds(monitor, k);
            (first..=last).contains(&at[k])
        })
    };
    if monitors.iter().any(is_seen) {
        return asked;
    }
    let within = |monitor: &MonitorArea| {
        [0, 1].map(|k| {
            let (_, [first, last]) = bounds(monitor, k);
            at[k].clamp(first, last)
        })
    };
    let far = |place: &[i64; 2]| (0..2).map(|k| (place[k] - at[k]).pow(2)).sum::<i64>();
    let nearest = monitors.iter().map(within).min_by_key(far);
    nearest.map_or(asked, |place| place.map(|x| x.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32))
}
