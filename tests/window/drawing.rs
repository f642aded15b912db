//! The machine of the paper drawn by hand, from nothing: clicks on pins, typed lengths and angles, motors, joined bars.

use stillbase::mechanics::machine::{Machine, builtin};
use stillbase::mechanics::planar::{Vector, unit};
use stillbase::mechanics::sketch::{BarEnd, SketchStep};
use stillbase::session::{Edit, Session};

use super::display::{CTRL, ENTER, TAB};
use super::program::Desk;
use super::tasks::desk;
use super::wait::{pause, wait_for};
use crate::Test;

pub const TESTS: &[Test] = super::tests![the_nine_links_are_drawn_by_hand];

/// The wheel turned towards the person.
const WHEEL_DOWN: u8 = 5;

/// A drawing on the screen: where it has its base, and pixels of a metre.
struct Paper<'a> {
    desk: &'a Desk,
    base: [f64; 2],
    scale: f64,
}

/// The steps of drawing that the journal holds.
fn steps(desk: &Desk) -> Vec<SketchStep> {
    let edits = desk.journal().map(|kept| kept.edits).unwrap_or_default();
    let step = |edit: Edit| match edit {
        Edit::Sketch(step) => Some(step),
        _ => None,
    };
    edits.into_iter().filter_map(|timed| step(timed.edit)).collect()
}

/// Where bars begin that are drawn at places of the screen, m: without a corner of the grid near, right at the pointer.
fn place(desk: &Desk, at: [i16; 2]) -> Option<[f64; 2]> {
    let before = steps(desk).len();
    desk.display.drag(at, [at[0] + 47, at[1] - 61]);
    let drawn = wait_for("a bar in the journal", 20, || steps(desk).get(before).cloned());
    let SketchStep::Bar { from: BarEnd::At(place), .. } = drawn else { panic!("{drawn:?}") };
    desk.display.keys(&[CTRL], u32::from('z'));
    wait_for("the bar undone", 20, || (steps(desk).len() == before).then_some(()));
    let is_round = place.iter().all(|x| (20.0 * x - (20.0 * x).round()).abs() < 1e-9);
    (!is_round).then_some(place)
}

impl<'a> Paper<'a> {
    /// Finds out where things are, by two bars that are taken back.
    fn of(desk: &'a Desk) -> Self {
        let [left, top, width, height] = desk.scene();
        let corners = [[23, 31], [74, 73]].map(|[x, y]| [left + width * x / 100, top + height * y / 100]);
        let [low, high] = corners.map(|[x, y]| {
            let tried = (0..8).map(|i| [(x + 11 * i) as i16, (y + 5 * i) as i16]);
            let mut found = tried.filter_map(|at| Some((at.map(f64::from), place(desk, at)?)));
            found.next().expect("a place without the grid near")
        });
        let scale = (high.0[0] - low.0[0]) / (high.1[0] - low.1[0]);
        let across = (high.0[1] - low.0[1]) / (low.1[1] - high.1[1]);
        assert!((scale - across).abs() < 0.02 * scale, "{scale} and {across}");
        Self { desk, base: [low.0[0] - scale * low.1[0], low.0[1] + scale * low.1[1]], scale }
    }

    fn at(&self, place: Vector) -> [i16; 2] {
        [self.base[0] + self.scale * place.re, self.base[1] - self.scale * place.im].map(|x| x.round() as i16)
    }

    /// Clicks on a pin and types a bar from there: mm and °. Returns its other end.
    fn bar(&self, from: Vector, length: i32, angle: i32) -> Vector {
        self.desk.display.click(self.at(from));
        pause(150);
        self.desk.display.type_in(&length.to_string());
        self.desk.display.tap(TAB);
        self.desk.display.type_in(&angle.to_string());
        self.desk.display.tap(ENTER);
        pause(150);
        from + unit(f64::from(angle).to_radians()) * (1e-3 * f64::from(length))
    }

    /// Drags a bar from pin to pin.
    fn close(&self, from: Vector, to: Vector) {
        self.desk.display.drag(self.at(from), self.at(to));
        pause(150);
    }

    /// Clicks on the middle of a bar, and makes one of it and another.
    fn join(&self, ends: [Vector; 2], other: &str) {
        self.desk.click("draw: move");
        self.desk.display.click(self.at(0.5 * (ends[0] + ends[1])));
        self.desk.click(&format!("one with bar {other}"));
        self.desk.click("draw: bar");
    }
}

/// The end effector in a pose, and the pins that close loops, as the machine has them.
fn same_places(drawn: &Machine, paper: &Machine) {
    let pairs = drawn.end_effector().iter().zip(paper.end_effector());
    let off = pairs.fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
    assert!(off < 1e-9, "{:?} and {:?}", drawn.end_effector(), paper.end_effector());
    assert_eq!((drawn.drives(), drawn.links().len(), drawn.loops().len()), (3, 9, 3));
    assert!(drawn.closure_gaps().iter().flatten().all(|gap| gap.abs() < 1e-9));
    for (own, of) in drawn.resolved_links().iter().zip(paper.resolved_links()) {
        assert_eq!(own.drive, of.drive);
        // A bar of two pieces is measured from its outermost pin: 5 and 9 reach beyond their roots in the file.
        let whole = [of.length, of.length + 0.18, of.length + 0.2];
        assert!(whole.iter().any(|length| (own.length - length).abs() < 1e-9), "{} m", own.length);
        let tips = own.point(own.length).iter().zip(&of.point(of.length)).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(tips, "the tip of a link is elsewhere");
    }
}

fn the_nine_links_are_drawn_by_hand() {
    let desk = desk("drawing", [1440, 900]);
    desk.click("Machine");
    let card = desk.reads("new machine: blank").name;
    desk.click(&card);
    desk.reads("no bar yet");
    let [left, top, width, height] = desk.scene();
    desk.display.move_to([(left + width / 2) as i16, (top + height / 2) as i16]);
    for _ in 0..2 {
        desk.display.press(WHEEL_DOWN);
        desk.display.let_go(WHEEL_DOWN);
        pause(200);
    }
    let paper = Paper::of(&desk);
    let base = Vector::new(0.0, 0.0);
    let (one, two, three) = (paper.bar(base, 500, 108), paper.bar(base, 180, 215), paper.bar(base, 200, 145));
    let four = paper.bar(two, 500, 108);
    let five = paper.bar(one, 460, 35);
    paper.close(four, one);
    paper.join([one, five], "6");
    let six = paper.bar(three, 500, 108);
    paper.close(one, six);
    let eight = paper.bar(six, 460, 35);
    let nine = paper.bar(five, 300, -35);
    paper.close(eight, five);
    paper.join([five, nine], "10");
    desk.click("draw: motor");
    for drive in 1..=3 {
        desk.display.click(paper.at(base));
        desk.reads(&format!("remove motor of drive {drive}"));
    }
    desk.click("draw: end effector");
    desk.display.click(paper.at(nine));
    desk.reads("nothing: this is a machine");
    let kept = wait_for("the end effector in the journal", 20, || {
        desk.journal().filter(|_| steps(&desk).iter().any(|step| matches!(step, SketchStep::EndEffector { .. })))
    });
    let session = Session::open_waiting(kept).expect("it opens again");
    same_places(&session.scenario().machine, builtin("nine-link").expect("built in"));
}
